//! Where coefficients stand in a controller, and the block that says so.

use super::Realisation;
use super::entry::{Entry, product, sum};
use crate::program::{Coefficient, Operand, Program, Term};
use jurist_algebra::number::{Enclosure, Rational};

/// A place of a coefficient: a number by the structure, or what is stored.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Slot {
    /// Zero, one or minus one.
    Fixed(Rational),
    /// The position of a coefficient.
    Stored(usize),
}

/// A numerator and a denominator, highest power first, of equal length; the denominator begins with 1.
pub(super) type Fraction = (Vec<Slot>, Vec<Slot>);

/// Where the coefficients of a realisation stand.
#[derive(Clone, Debug)]
pub struct Structure(pub(super) Form);

#[derive(Clone, Debug)]
pub(super) enum Form {
    /// Factors in z, one for a direct form.
    Chain(Vec<Fraction>),
    /// Summands in z and a direct path.
    Sum { fractions: Vec<Fraction>, direct: Slot },
    /// A fraction in `(z - 1)/delta`.
    Delta { fraction: Fraction, delta: Rational },
    /// The matrices A, B, C, D by rows.
    State([Vec<Vec<Slot>>; 4]),
}

/// A name, and for each place the number that stands there by the structure, or the position of a coefficient.
pub type Places = (String, Vec<Result<Rational, usize>>);

impl Structure {
    /// The lists in which coefficients stand: `b` and `a` of a fraction, `b_1`, `a_1` and so on of several; `A`, `B`, `C` and `D` row by row.
    pub fn lists(&self) -> Vec<Places> {
        let place = |slot: &Slot| match slot {
            Slot::Fixed(value) => Ok(value.clone()),
            Slot::Stored(at) => Err(*at),
        };
        let list = |name: String, slots: &[Slot]| (name, slots.iter().map(place).collect());
        let both = |(b, a): &Fraction, suffix: String| [list(format!("b{suffix}"), b), list(format!("a{suffix}"), a)];
        match &self.0 {
            Form::Chain(factors) if factors.len() == 1 => both(&factors[0], String::new()).into(),
            Form::Chain(factors) => {
                factors.iter().enumerate().flat_map(|(k, fraction)| both(fraction, format!("_{}", k + 1))).collect()
            }
            Form::Sum { fractions, direct } => {
                let path = list("d".to_owned(), std::slice::from_ref(direct));
                let of = |(k, fraction)| both(fraction, format!("_{}", k + 1));
                std::iter::once(path).chain(fractions.iter().enumerate().flat_map(of)).collect()
            }
            Form::Delta { fraction, .. } => both(fraction, String::new()).into(),
            Form::State(matrices) => {
                let names = ["A", "B", "C", "D"].map(str::to_owned);
                names.into_iter().zip(matrices).map(|(name, rows)| list(name, &rows.concat())).collect()
            }
        }
    }
}

/// A controller with its order of operations.
#[derive(Clone, Debug)]
pub struct Realised {
    /// Which realisation it is.
    pub realisation: Realisation,
    /// The operations.
    pub program: Program,
    /// Where the coefficients stand.
    pub structure: Structure,
}

impl Realised {
    /// The keys of a block with these coefficients, numbers or names, and their values in TOML.
    ///
    /// Cost: a product of polynomials for each section.
    ///
    /// # Panics
    /// When there are not as many values as coefficients.
    pub fn keys(&self, values: &[Entry]) -> Vec<(&'static str, String)> {
        assert_eq!(values.len(), self.program.coefficients.len(), "a value for each coefficient");
        let entry = |slot: &Slot| match slot {
            Slot::Fixed(value) => Entry::Number(value.clone()),
            Slot::Stored(at) => values[*at].clone(),
        };
        let polynomial = |slots: &[Slot]| -> Vec<Entry> { slots.iter().map(entry).collect() };
        let list = |entries: Vec<Entry>| {
            let texts: Vec<String> = entries.iter().map(Entry::toml).collect();
            format!("[{}]", texts.join(", "))
        };
        match &self.structure.0 {
            Form::Chain(factors) => {
                let one = || vec![Entry::Number(Rational::ONE)];
                let numerator = factors.iter().fold(one(), |p, (b, _)| product(&p, &polynomial(b)));
                let denominator = factors.iter().fold(one(), |p, (_, a)| product(&p, &polynomial(a)));
                vec![("num", list(numerator)), ("den", list(denominator))]
            }
            Form::Sum { fractions, direct } => {
                let below: Vec<Vec<Entry>> = fractions.iter().map(|(_, a)| polynomial(a)).collect();
                let without = |skipped: Option<usize>| {
                    let kept = below.iter().enumerate().filter(|(k, _)| Some(*k) != skipped);
                    kept.fold(vec![Entry::Number(Rational::ONE)], |p, (_, a)| product(&p, a))
                };
                let denominator = without(None);
                let path = product(&[entry(direct)], &denominator);
                let numerator = fractions
                    .iter()
                    .enumerate()
                    .fold(path, |total, (k, (b, _))| sum(&total, &product(&polynomial(b), &without(Some(k)))));
                vec![("num", list(numerator)), ("den", list(denominator))]
            }
            Form::Delta { fraction: (b, a), delta } => {
                let [numerator, denominator] = [b, a].map(|slots| in_z(&polynomial(slots), delta));
                vec![("num", list(numerator)), ("den", list(denominator))]
            }
            Form::State(matrices) => {
                let rows = |rows: &Vec<Vec<Slot>>| {
                    let rows: Vec<String> = rows.iter().map(|row| list(polynomial(row))).collect();
                    format!("[{}]", rows.join(", "))
                };
                ["A", "B", "C", "D"].into_iter().zip(matrices.iter().map(rows)).collect()
            }
        }
    }
}

/// A polynomial in `(z - 1)/delta` of this length, times `delta` to its degree, in z.
fn in_z(coefficients: &[Entry], delta: &Rational) -> Vec<Entry> {
    let step = [Entry::Number(Rational::ONE), Entry::Number(-&Rational::ONE)];
    let mut out: Vec<Entry> = Vec::new();
    let mut weight = Rational::ONE;
    for coefficient in coefficients {
        // Horner: each further coefficient comes with one more power of delta.
        out = sum(&product(&out, &step), &[coefficient.times(&Entry::Number(weight.clone()))]);
        weight = &weight * delta;
    }
    out
}

/// The coefficients of a realisation in the making.
#[derive(Default)]
pub(super) struct Slots {
    pub coefficients: Vec<Coefficient>,
}

impl Slots {
    /// The place of a number: zero and one are by the structure.
    pub fn slot(&mut self, name: String, exact: &Enclosure) -> Slot {
        let is_exact = exact.lower() == exact.upper();
        if is_exact && (exact.lower().is_zero() || exact.lower().abs().is_one()) {
            return Slot::Fixed(exact.lower().clone());
        }
        self.coefficients.push(Coefficient { name, exact: exact.clone() });
        Slot::Stored(self.coefficients.len() - 1)
    }
}

impl Slot {
    /// The slot times an operand and a power of two, added or subtracted; nothing for zero.
    pub fn term(&self, operand: Operand, is_subtracted: bool, shift: i32) -> Option<Term> {
        match self {
            Slot::Fixed(value) if value.is_zero() => None,
            Slot::Fixed(value) => {
                Some(Term { is_negative: is_subtracted != value.is_negative(), shift, coefficient: None, operand })
            }
            Slot::Stored(at) => Some(Term { is_negative: is_subtracted, shift, coefficient: Some(*at), operand }),
        }
    }

    /// Whether it is zero by the structure.
    pub fn is_zero(&self) -> bool {
        matches!(self, Slot::Fixed(value) if value.is_zero())
    }
}
