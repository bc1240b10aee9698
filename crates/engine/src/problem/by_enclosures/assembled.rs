//! The polynomial of a part with a symbol for each coefficient that is not known exactly.

use super::part::Part;
use crate::stability::SymbolicPolynomial;
use jurist_algebra::limits::{checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::real::{Enclosing, Origin, Transcendental};
use jurist_algebra::symbols::{Definition, EnclosedNumber, Symbols as Values};
use std::sync::Arc;

impl Part {
    /// `D(r z; K)` with a symbol for each coefficient, without denominators.
    pub fn polynomial(self: Arc<Self>, radius: &Rational) -> SymbolicPolynomial {
        let n = self.constant.rows();
        let at_zero = self.at_zero_over_symbols();
        let at_one = if radius.is_one() { AtOne::of(&self, &at_zero) } else { None };
        let scale = at_one.as_ref().map_or(Integer::ONE, |known| known.scale.clone());
        let zeros = constants(&self.zeros);
        let beside = |power: usize| {
            let mut factor: Vec<MultiPoly> = self.beside_power(power).iter().map(|c| c.scaled_by(&scale)).collect();
            if let Some(whole) = at_one.as_ref().and_then(|known| known.at(power))
                && let Some((first, others)) = factor.split_first_mut()
            {
                // Chosen so that d(K) divides the value at z = 1.
                *first = whole.minus(&sum(others.iter().cloned()));
            }
            zeros.times(&Poly::new(factor))
        };
        let powers: Vec<Poly<MultiPoly>> =
            std::iter::once(at_zero.map(|c| c.scaled_by(&scale))).chain((1..=self.degree).map(beside)).collect();
        let in_powers = |(power, p): (usize, &Poly<MultiPoly>), k: usize| {
            (0..power).fold(p.coeff(k), |c, _| c.times(&MultiPoly::variable(0)))
        };
        let coefficient = |k: usize| {
            sum(powers.iter().enumerate().map(|p| in_powers(p, k)))
                .scaled_by(&(radius.numerator().pow(k as u64) * radius.denominator().pow((n - k) as u64)))
        };
        let polynomial = Poly::new((0..=n).map(coefficient).collect::<Vec<_>>());
        SymbolicPolynomial::from_parts(&Arc::new(self.table()), polynomial, MultiPoly::one(), n, vec![MultiPoly::one()])
    }

    /// A symbol for each coefficient of the enclosed factor of `D(z; 0)`, then of those of the coefficients of all powers of `K`.
    fn table(self: Arc<Self>) -> Values {
        let (others, m) = (self.others_degree(), self.beside());
        let mut table = Values::new();
        for index in 0..others + self.degree * m {
            let words = match index.checked_sub(others) {
                None => format!("coefficient {index} of the part of D(z; 0) that is no exact factor"),
                Some(beyond) => format!(
                    "coefficient {} of the factor of D(z; K) beside K^{} that is not exact",
                    beyond % m,
                    beyond / m + 1
                ),
            };
            let value = Transcendental::new(Coefficient { of: Arc::clone(&self), index });
            table.insert(format!("c{index}"), Definition::Enclosed(EnclosedNumber { words, value }));
        }
        table
    }

    /// `D(z; 0)`.
    fn at_zero_over_symbols(&self) -> Poly<MultiPoly> {
        let others = self.others_degree();
        let in_exact = self.exact.coeffs().iter().take_while(|c| c.is_zero()).count();
        let at_origin = self.at_origin.saturating_sub(in_exact).min(others);
        let zeros = std::iter::repeat_n(MultiPoly::zero(), at_origin);
        let other = zeros.chain((at_origin..others).map(symbol)).chain([MultiPoly::one()]);
        constants(&self.exact).times(&Poly::new(other.collect()))
    }

    /// The coefficients of the enclosed factor of the coefficient of a power of `K`.
    fn beside_power(&self, power: usize) -> Vec<MultiPoly> {
        let (first, m) = (self.others_degree(), self.beside());
        let lead = self.exact.leading().cloned().unwrap_or(Integer::ONE);
        (0..m).map(|k| symbol(first + (power - 1) * m + k).scaled_by(&lead)).collect()
    }
}

/// `K` is variable 0, a symbol's number one more than its place in the table.
fn symbol(index: usize) -> MultiPoly {
    MultiPoly::variable(index + 1)
}

fn constants(p: &UniPoly) -> Poly<MultiPoly> {
    Poly::new(p.coeffs().iter().map(|c| MultiPoly::constant(c.clone())).collect())
}

fn sum(list: impl Iterator<Item = MultiPoly>) -> MultiPoly {
    list.fold(MultiPoly::zero(), |sum, c| sum.plus(&c))
}

/// `D(1; K) = d(K) q(K)` with a polynomial `d` that is known. The coefficients of `q` follow from as many of `D(1; K)`, and give all others.
struct AtOne<'a> {
    d: &'a UniPoly,
    /// The least power of `K` in `d`, and its coefficient.
    lowest: usize,
    lead: Integer,
    /// The coefficient of `K^i` in `q`, times the power `i + 1` of that coefficient.
    quotient: Vec<MultiPoly>,
    /// What the whole polynomial is multiplied by, so that no divisor is left.
    scale: Integer,
}

impl AtOne<'_> {
    /// `None` where nothing is known, or where nothing depends on `K` at `z = 1`.
    fn of<'a>(part: &'a Part, at_zero: &Poly<MultiPoly>) -> Option<AtOne<'a>> {
        let (d, degree) = part.at_rest.as_ref()?;
        let zeros = part.zeros.eval(&Integer::ONE);
        if zeros.is_zero() {
            return None;
        }
        let (lowest, lead) = part.lowest_at_rest();
        let scale = &lead.pow(*degree as u64 + 1) * &zeros;
        let mut known = AtOne { d, lowest, lead, quotient: Vec::new(), scale };
        for i in 0..=*degree {
            let whole = match lowest + i {
                0 => sum(at_zero.coeffs().iter().cloned()),
                power => sum(part.beside_power(power).into_iter()).scaled_by(&zeros),
            };
            let before =
                |j: usize| known.quotient[i - j].scaled_by(&(&d.coeff(lowest + j) * &known.lead.pow(j as u64 - 1)));
            let next = whole.scaled_by(&known.lead.pow(i as u64)).minus(&sum((1..=i).map(before)));
            known.quotient.push(next);
        }
        Some(known)
    }

    /// The coefficient of a power of `K` in `D(1; K)` that follows from others, times the scale and over the exact factor's value; `None` where it is one
    /// of those that the others follow from.
    fn at(&self, power: usize) -> Option<MultiPoly> {
        let last = self.quotient.len() - 1;
        if (self.lowest..=self.lowest + last).contains(&power) {
            return None;
        }
        let term = |(i, q): (usize, &MultiPoly)| {
            Some(q.scaled_by(&(&self.d.coeff(power.checked_sub(i)?) * &self.lead.pow((last - i) as u64))))
        };
        Some(sum(self.quotient.iter().enumerate().filter_map(term)))
    }
}

/// A coefficient of a part's polynomial.
#[derive(Debug)]
struct Coefficient {
    of: Arc<Part>,
    index: usize,
}

impl Enclosing for Coefficient {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        until_shown((bits + 64).next_power_of_two(), |working| {
            checkpoint(working);
            let found = self.of.coefficients(working)?[self.index].to_enclosure();
            (found.upper() - found.lower() <= width).then_some(found)
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "coefficient of the characteristic polynomial".to_owned(), details: Vec::new() }
    }
}
