//! How a box was cut and why each part is proved: a tree as text.

use super::multiplier::Multiplier;
use crate::subdivision::Step;
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
    /// Of the steps of a subdivision depth first, in a tensor with so many parameters.
    pub(super) fn of(steps: Vec<Step<Node>>, parameters: usize) -> Tree {
        let node = |step| match step {
            Step::Decided(node) => node,
            Step::Halved(axis) => Node::Halved(Axis::new(axis, parameters)),
        };
        Tree(steps.into_iter().map(node).collect())
    }

    /// The tree in so many parameters, where all others are in the middle of what is left of their sides: as coefficients over a cell there are means
    /// of those beside it, its leaves show the same of these.
    pub fn of_first(&self, parameters: usize) -> Tree {
        let mut nodes = Vec::with_capacity(self.0.len());
        self.copied(0, parameters, Some(&mut nodes));
        Tree(nodes)
    }

    /// Copies the part that begins at a node, if it is wanted; the place behind it.
    fn copied(&self, at: usize, parameters: usize, mut out: Option<&mut Vec<Node>>) -> usize {
        let is_kept = |axis: &Axis| !matches!(axis, Axis::Parameter(i) if *i >= parameters);
        let node = &self.0[at];
        let Node::Halved(axis) = node else {
            if let Some(out) = out {
                out.push(node.along(is_kept));
            }
            return at + 1;
        };
        if let Some(out) = out.as_mut().filter(|_| is_kept(axis)) {
            out.push(node.clone());
        }
        let middle = self.copied(at + 1, parameters, out.as_deref_mut());
        self.copied(middle, parameters, out.filter(|_| is_kept(axis)))
    }

    /// The number of cells that were not cut further.
    pub fn leaves(&self) -> usize {
        self.0.iter().filter(|node| !matches!(node, Node::Halved(_))).count()
    }
}

impl Axis {
    /// An axis of a tensor with so many parameters, behind which the frequency stands.
    fn new(axis: usize, parameters: usize) -> Axis {
        if axis == parameters { Axis::Frequency } else { Axis::Parameter(axis) }
    }
}

impl Node {
    /// A leaf whose vector is affine along some of its axes only.
    fn along(&self, is_kept: impl Fn(&Axis) -> bool) -> Node {
        let Node::Affine(slopes, constant) = self else { return self.clone() };
        let slopes: Vec<_> = slopes.iter().filter(|(axis, _)| is_kept(axis)).copied().collect();
        if slopes.is_empty() { Node::Separated(constant.0, constant.1) } else { Node::Affine(slopes, *constant) }
    }

    /// Proved by a vector that is affine along some axes of a tensor with so many parameters.
    pub(super) fn affine(found: Multiplier, parameters: usize) -> Node {
        let slopes = found.slopes.into_iter().map(|(i, v)| (Axis::new(i, parameters), v));
        Node::Affine(slopes.collect(), found.constant)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_of_the_first_parameters_has_no_other_axes() {
        let slopes = |axes: &[Axis]| axes.iter().map(|axis| (*axis, (1, 2))).collect();
        let tree = Tree(vec![
            Node::Halved(Axis::Frequency),
            Node::Halved(Axis::Parameter(2)),
            Node::Halved(Axis::Parameter(0)),
            Node::Affine(slopes(&[Axis::Parameter(2)]), (3, 4)),
            Node::Affine(slopes(&[Axis::Parameter(1), Axis::Parameter(2), Axis::Frequency]), (5, 6)),
            Node::Halved(Axis::Parameter(1)),
            Node::Separated(7, 8),
            Node::Separated(9, 10),
            Node::Separated(11, 12),
        ]);
        assert_eq!(tree.of_first(2).to_string(), "xs0,l3,4;a1,x:5,6,1,2,1,2;l11,12;");
        assert_eq!(tree.of_first(3), tree);
    }
}
