//! Programs run as a processor runs them, in exact arithmetic.

use crate::format::{Fixed, power_of_two};
use crate::program::{Node, Operand, Program, Term};
use jurist_algebra::number::{BinaryFormat, Integer, Rational};

/// What happens to a number that does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overflow {
    /// It becomes the greatest or the least number.
    Saturate,
    /// The bits that do not fit are lost, as two's complement loses them.
    Wrap,
}

/// A sum in integers: the terms are `k << left` times the operand's integer, and the sum is rounded by `right` bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IntegerSum {
    /// For each term of the node its integer factor, sign and shift included.
    pub factors: Vec<Integer>,
    /// How many bits are rounded away at the end.
    pub right: u32,
}

/// A program in fixed point.
#[derive(Clone, Debug)]
pub struct FixedProgram<'p> {
    /// What is run.
    pub program: &'p Program,
    /// The stored integers of the coefficients.
    pub stored: Vec<Integer>,
    /// The format of signals.
    pub signal: Fixed,
    /// What happens to a signal that does not fit.
    pub overflow: Overflow,
    /// The nodes in integers.
    pub sums: Vec<IntegerSum>,
}

impl<'p> FixedProgram<'p> {
    /// A program with coefficients in one format and signals in another.
    ///
    /// Cost: a shift for each term.
    ///
    /// ```
    /// use jurist_algebra::number::{Enclosure, parse_number};
    /// use jurist_ship::format::{Fixed, Rounding};
    /// use jurist_ship::realise::{Realisation, direct};
    /// use jurist_ship::run::{FixedProgram, Overflow};
    /// let exact = |texts: &[&str]| texts.iter().map(|t| Enclosure::from_rational(parse_number(t).unwrap())).collect::<Vec<_>>();
    /// // 0.4/(z - 0.6)
    /// let controller = direct(Realisation::Df1, &exact(&["0", "0.4"]), &exact(&["1", "-0.6"]));
    /// let format = Fixed { bits: 16, fraction: 8, scale: 0, rounding: Rounding::Nearest };
    /// let stored = controller.program.coefficients.iter().map(|c| format.rounded(c.exact.lower())).collect();
    /// let fixed = FixedProgram::new(&controller.program, stored, &format, format, Overflow::Saturate);
    /// let mut states = fixed.at_rest();
    /// let outputs: Vec<String> = (0..4).map(|_| fixed.step(&mut states, &[256.into()])[0].to_string()).collect();
    /// assert_eq!(outputs, ["0", "102", "163", "200"]); // 0.4, 0.64, 0.784 times 256, nearly
    /// ```
    pub fn new(
        program: &'p Program,
        stored: Vec<Integer>,
        coefficient: &Fixed,
        signal: Fixed,
        overflow: Overflow,
    ) -> FixedProgram<'p> {
        let scale = i64::from(coefficient.scale) - i64::from(coefficient.fraction);
        let sums = program.nodes.iter().map(|node| integer_sum(node, &stored, scale)).collect();
        FixedProgram { program, stored, signal, overflow, sums }
    }

    /// The states of a controller at rest.
    pub fn at_rest(&self) -> Vec<Integer> {
        vec![Integer::ZERO; self.program.states.len()]
    }

    /// The outputs at a sample, and the states after it.
    ///
    /// Cost: a product of integers for each term.
    pub fn step(&self, states: &mut Vec<Integer>, inputs: &[Integer]) -> Vec<Integer> {
        let mut nodes: Vec<Integer> = Vec::with_capacity(self.sums.len());
        for (node, sum) in self.program.nodes.iter().zip(&self.sums) {
            let mut total = Integer::ZERO;
            for (term, factor) in node.terms.iter().zip(&sum.factors) {
                total.add_mul_assign(factor, read(term.operand, inputs, states, &nodes));
            }
            nodes.push(self.fitted(self.rounded(total, sum.right)));
        }
        let value = |operand: &Operand| read(*operand, inputs, states, &nodes).clone();
        let outputs = self.program.outputs.iter().map(value).collect();
        let next = self.program.updates.iter().map(value).collect();
        *states = next;
        outputs
    }

    /// The greatest magnitude that the sum of a node can have before it is rounded, for all signals of the format.
    pub fn greatest_sum(&self, node: usize) -> Integer {
        let (least, _) = self.signal.integers();
        let sum = &self.sums[node];
        let of_terms = sum.factors.iter().fold(Integer::ZERO, |total, factor| total + factor.abs() * least.abs());
        of_terms + (Integer::ONE << u64::from(sum.right))
    }

    fn rounded(&self, total: Integer, right: u32) -> Integer {
        if right == 0 {
            return total;
        }
        self.signal.rounding.integer(&(Rational::from(total) * power_of_two(-i64::from(right))))
    }

    fn fitted(&self, value: Integer) -> Integer {
        let (least, greatest) = self.signal.integers();
        match self.overflow {
            Overflow::Saturate => value.clamp(least, greatest),
            Overflow::Wrap => {
                let size = Integer::ONE << u64::from(self.signal.bits);
                let (_, rest) = (value - &least).div_mod_floor(&size);
                rest + least
            }
        }
    }
}

/// A node in integers where coefficients are multiples of 2 to the power `scale`.
fn integer_sum(node: &Node, stored: &[Integer], scale: i64) -> IntegerSum {
    let exponent = |term: &Term| i64::from(term.shift) + if term.coefficient.is_some() { scale } else { 0 };
    let right = node.terms.iter().map(|term| -exponent(term)).max().unwrap_or(0).max(0);
    let factor = |term: &Term| {
        let size = term.coefficient.map_or(Integer::ONE, |at| stored[at].clone());
        let shifted = size << (exponent(term) + right).unsigned_abs();
        if term.is_negative { -shifted } else { shifted }
    };
    IntegerSum { factors: node.terms.iter().map(factor).collect(), right: right as u32 }
}

/// A program in binary floating point: each product and each sum is rounded.
#[derive(Clone, Debug)]
pub struct FloatProgram<'p> {
    /// What is run.
    pub program: &'p Program,
    /// The format.
    pub format: BinaryFormat,
    /// For each node the factors of its terms, signs left out.
    pub factors: Vec<Vec<Rational>>,
}

impl<'p> FloatProgram<'p> {
    /// A program with these stored coefficients. `None` where a factor is out of range.
    ///
    /// Cost: one rounding for each term.
    pub fn new(program: &'p Program, stored: &[Rational], format: BinaryFormat) -> Option<FloatProgram<'p>> {
        let factor = |term: &Term| format.nearest(&term.size(stored));
        let factors = program.nodes.iter().map(|node| node.terms.iter().map(factor).collect::<Option<Vec<_>>>());
        Some(FloatProgram { program, format, factors: factors.collect::<Option<Vec<_>>>()? })
    }

    /// The states of a controller at rest.
    pub fn at_rest(&self) -> Vec<Rational> {
        vec![Rational::ZERO; self.program.states.len()]
    }

    /// The outputs at a sample, and the states after it; `None` where a number becomes infinite. Zeros have no sign here.
    ///
    /// Cost: two roundings for each term.
    pub fn step(&self, states: &mut Vec<Rational>, inputs: &[Rational]) -> Option<Vec<Rational>> {
        let mut nodes: Vec<Rational> = Vec::with_capacity(self.factors.len());
        for (node, factors) in self.program.nodes.iter().zip(&self.factors) {
            let mut total = Rational::ZERO;
            for (term, factor) in node.terms.iter().zip(factors) {
                let product = self.format.nearest(&(factor * read(term.operand, inputs, states, &nodes)))?;
                let sum = if term.is_negative { &total - &product } else { &total + &product };
                total = self.format.nearest(&sum)?;
            }
            nodes.push(total);
        }
        let value = |operand: &Operand| read(*operand, inputs, states, &nodes).clone();
        let outputs = self.program.outputs.iter().map(value).collect();
        let next = self.program.updates.iter().map(value).collect();
        *states = next;
        Some(outputs)
    }
}

fn read<'v, T>(operand: Operand, inputs: &'v [T], states: &'v [T], nodes: &'v [T]) -> &'v T {
    match operand {
        Operand::Input(at) => &inputs[at],
        Operand::State(at) => &states[at],
        Operand::Node(at) => &nodes[at],
    }
}
