//! How a box was cut and why each part is proved: a tree as text.

use super::multiplier::Multiplier;
use std::fmt;

/// A node of the tree; the nodes stand in prefix order, the lower half of a cell first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Node {
    /// Halved along an axis: a parameter by its number, or the frequency.
    Halved(Axis),
    /// All coefficients of the pair are on the positive side of this vector.
    Separated(i128, i128),
    /// The same with a vector that is affine in the cell's coordinates.
    Affine(Vec<(Axis, (i128, i128))>, (i128, i128)),
    /// All coefficients have this sign.
    Signed(bool),
    /// Within the cell around the worst point.
    Critical,
}

/// What is halved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    Frequency,
    Parameter(usize),
}

/// A proof by halving: `x` halves the frequency and a number that parameter; the lower half comes first.
/// `l a,b;` is a cell whose Bernstein coefficients `(E, O)` satisfy `a E + b O > 0`; `a AXES:a,b,a1,b1,...;` one where those of
/// `(a + a1 (2 u_1 - 1) + ...) E + (b + b1 (2 u_1 - 1) + ...) O` do, with each `u_k` from 0 to 1 along an axis of the cell and
/// of one degree more along these axes; `+` and `-` are signs, `c` the cell around the worst point.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree(pub(super) Vec<Node>);

impl Tree {
    /// The number of cells that were not cut further.
    pub fn leaves(&self) -> usize {
        self.0.iter().filter(|node| !matches!(node, Node::Halved(_))).count()
    }
}

impl Node {
    /// Proved by a vector that is affine along some axes of a tensor with so many parameters.
    pub(super) fn affine(found: Multiplier, parameters: usize) -> Node {
        let axis = |i: usize| if i == parameters { Axis::Frequency } else { Axis::Parameter(i) };
        Node::Affine(found.slopes.into_iter().map(|(i, v)| (axis(i), v)).collect(), found.constant)
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Axis::Frequency => f.write_str("x"),
            Axis::Parameter(i) => write!(f, "{i}"),
        }
    }
}

impl fmt::Display for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|node| match node {
            Node::Halved(Axis::Frequency) => f.write_str("x"),
            Node::Halved(Axis::Parameter(i)) => write!(f, "s{i},"),
            Node::Separated(a, b) => write!(f, "l{a},{b};"),
            Node::Affine(slopes, (a, b)) => {
                let axes: Vec<String> = slopes.iter().map(|(axis, _)| axis.to_string()).collect();
                write!(f, "a{}:{a},{b}", axes.join(","))?;
                slopes.iter().try_for_each(|(_, (a, b))| write!(f, ",{a},{b}"))?;
                f.write_str(";")
            }
            Node::Signed(positive) => f.write_str(if *positive { "+" } else { "-" }),
            Node::Critical => f.write_str("c"),
        })
    }
}
