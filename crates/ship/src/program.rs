//! A realisation as a list of sums, in the order of the processor.
//!
//! One list is all that a realisation is: run in exact arithmetic it is the reference, read as equations it is a linear system with its rounding
//! errors as inputs, printed it is code.

use crate::format::power_of_two;
use jurist_algebra::number::{Enclosure, Rational};

/// What a sum reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// An input of the controller at this sample.
    Input(usize),
    /// A state as the last sample left it.
    State(usize),
    /// A node that was computed before.
    Node(usize),
}

/// A term of a sum: `sign * 2^shift * coefficient * operand`, without a coefficient `sign * 2^shift * operand`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// Whether it is subtracted.
    pub is_negative: bool,
    /// The power of two.
    pub shift: i32,
    /// The position of the coefficient in [`Program::coefficients`].
    pub coefficient: Option<usize>,
    /// What is multiplied.
    pub operand: Operand,
}

/// A sum of terms, rounded once at its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// Its name, in the letters of programming languages.
    pub name: String,
    /// Its terms in the order in which they are added.
    pub terms: Vec<Term>,
}

/// A coefficient that is stored. Zeros and powers of two that a realisation has by its structure are none.
#[derive(Clone, Debug)]
pub struct Coefficient {
    /// Its name: `b0`, `a1`.
    pub name: String,
    /// Its value before it is rounded.
    pub exact: Enclosure,
}

/// A realisation of a controller.
///
/// A step computes the nodes in their order, then the outputs, and then replaces all states at once.
#[derive(Clone, Debug)]
pub struct Program {
    /// How many inputs there are.
    pub inputs: usize,
    /// What is stored.
    pub coefficients: Vec<Coefficient>,
    /// Names of the states.
    pub states: Vec<String>,
    /// The sums.
    pub nodes: Vec<Node>,
    /// What each state becomes.
    pub updates: Vec<Operand>,
    /// What each output is.
    pub outputs: Vec<Operand>,
}

/// A program as a linear system `x' = A x + B u + N e`, `v = C x + D u + M e`: `v` are the nodes, `e` the errors of their rounding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinearSystem {
    /// Rows of A.
    pub a: Vec<Vec<Rational>>,
    /// Rows of B, and behind them those of N: a column for each input and for each node.
    pub b: Vec<Vec<Rational>>,
    /// Rows of C: one for each node.
    pub c: Vec<Vec<Rational>>,
    /// Rows of D and M.
    pub d: Vec<Vec<Rational>>,
}

impl Program {
    /// The linear system with these values of the coefficients.
    ///
    /// Cost: a product for each term and each column.
    ///
    /// # Panics
    /// When there are not as many values as coefficients.
    pub fn system(&self, values: &[Rational]) -> LinearSystem {
        assert_eq!(values.len(), self.coefficients.len(), "a value for each coefficient");
        let (states, width) = (self.states.len(), self.states.len() + self.inputs + self.nodes.len());
        let unit = |at: usize| -> Vec<Rational> {
            (0..width).map(|k| if k == at { Rational::ONE } else { Rational::ZERO }).collect()
        };
        let mut nodes: Vec<Vec<Rational>> = Vec::new();
        let row = |operand: Operand, nodes: &[Vec<Rational>]| match operand {
            Operand::State(at) => unit(at),
            Operand::Input(at) => unit(states + at),
            Operand::Node(at) => nodes[at].clone(),
        };
        for (at, node) in self.nodes.iter().enumerate() {
            let mut sum = unit(states + self.inputs + at);
            for term in &node.terms {
                let factor = term.factor(values);
                for (entry, of) in sum.iter_mut().zip(row(term.operand, &nodes)) {
                    *entry = &*entry + &(&factor * &of);
                }
            }
            nodes.push(sum);
        }
        let next: Vec<Vec<Rational>> = self.updates.iter().map(|operand| row(*operand, &nodes)).collect();
        let split = |rows: &[Vec<Rational>]| -> (Vec<Vec<Rational>>, Vec<Vec<Rational>>) {
            rows.iter().map(|row| (row[..states].to_vec(), row[states..].to_vec())).unzip()
        };
        let ((a, b), (c, d)) = (split(&next), split(&nodes));
        LinearSystem { a, b, c, d }
    }
}

impl Term {
    /// The number that the operand is multiplied by.
    ///
    /// Cost: one product.
    pub fn factor(&self, values: &[Rational]) -> Rational {
        let size = self.size(values);
        if self.is_negative { -&size } else { size }
    }

    /// That number without the sign of the term.
    ///
    /// Cost: one product.
    pub fn size(&self, values: &[Rational]) -> Rational {
        let size = self.coefficient.map_or(Rational::ONE, |at| values[at].clone());
        size * power_of_two(i64::from(self.shift))
    }
}
