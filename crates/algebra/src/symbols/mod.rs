//! Constants such as `exp(-1/2)` as variables of polynomials.
//!
//! A sampled loop with a held plant has entries of `exp(A T)` in its characteristic polynomial. Each transcendental constant
//! that occurs becomes a [`Definition`] in a table of [`Symbols`] and, in polynomials and rational functions, the variable of
//! the same index. A polynomial in symbols is a number: [`Symbols::enclose`] encloses it to any width, [`Symbols::sign`]
//! decides its sign, zero included.
//!
//! In polynomials with other variables, such as parameters, symbol `i` is variable `first + i`;
//! [`MultiPoly::map_variables`] renames.

mod beyond;
mod common;
mod definition;
mod dominated;
mod duty;
mod family;
mod forms;
mod function;
mod horner;
mod moving;
mod moving_root;
mod norm;
mod normal_form;
mod pieces;
mod rational_series;
mod root;
mod roots;
mod scales;
mod sign;
mod specialise;
mod taylor;
mod tiles;
mod values;
mod zero_at_end;

pub use definition::{Definition, EnclosedNumber};
pub use duty::DutyRatio;
pub use family::{FamilyValue, FamilyVariables, MatrixFamily, Step};
pub use function::{Function, common_scale};
pub use horner::value_at_balls;
pub use moving::{DefinedParts, MovingSymbols, SignUnderRoot, Zeros};
pub use normal_form::is_identity;
pub use root::EnclosedPoly;
pub use roots::{SymbolicPoly, common_factor, enclosed_roots, merged};
pub use specialise::resultants_seem_simple_in;
pub use values::ParametricSymbols;

use self::horner::Horner;
use crate::ball::{Ball, BallMatrix, Series, exp, exponential, exponential_of_rationals, fundamental_solutions};
use crate::limits::until_shown;
use crate::matrix::Matrix;
use crate::number::{Enclosure, Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// A table of symbols.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_algebra::symbols::{Definition, Symbols};
/// let mut symbols = Symbols::new();
/// let x = symbols.insert("X", Definition::exponential(-1));
/// assert_eq!(symbols.definition_text(x), "exp(-1)");
/// // 10 X - 3 > 0
/// let p = MultiPoly::variable(x).scaled_by(&10.into()).minus(&MultiPoly::constant(3.into()));
/// assert!(symbols.sign(&p, &Budget::unlimited()).unwrap().is_gt());
/// ```
#[derive(Default)]
pub struct Symbols {
    table: Vec<(String, Definition)>,
    /// All values, by the bits after the point.
    values: Mutex<BTreeMap<u64, Arc<Vec<Ball>>>>,
}

impl Clone for Symbols {
    fn clone(&self) -> Self {
        Symbols { table: self.table.clone(), values: Mutex::default() }
    }
}

impl PartialEq for Symbols {
    fn eq(&self, other: &Self) -> bool {
        self.table == other.table
    }
}

impl fmt::Debug for Symbols {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.table).finish()
    }
}

impl Symbols {
    /// No symbols.
    pub fn new() -> Self {
        Symbols::default()
    }

    /// The number of symbols.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// Adds a symbol with its name and returns its index; the index of the symbol that has the same definition, if there is one.
    pub fn insert(&mut self, name: impl Into<String>, definition: Definition) -> usize {
        if let Some(known) = self.table.iter().position(|(_, d)| *d == definition) {
            return known;
        }
        self.table.push((name.into(), definition));
        self.values = Mutex::default();
        self.table.len() - 1
    }

    /// Adds a symbol, also one that has the same definition as another.
    pub fn push(&mut self, name: &str, definition: Definition) {
        self.table.push((name.to_owned(), definition));
        self.values = Mutex::default();
    }

    /// What a symbol stands for.
    pub fn definition(&self, i: usize) -> &Definition {
        &self.table[i].1
    }

    /// All names.
    pub fn names(&self) -> Vec<String> {
        self.table.iter().map(|(name, _)| name.clone()).collect()
    }

    /// What a symbol stands for, as text: `exp(-1/2)`.
    pub fn definition_text(&self, i: usize) -> String {
        self.table[i].1.text(&self.names())
    }

    /// The values of all symbols, with that many bits after the point.
    ///
    /// Cost: on the first call for these bits, an exponential of a matrix for each symbol.
    pub fn values(&self, bits: u64) -> Arc<Vec<Ball>> {
        let known = || self.values.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(values) = known().get(&bits) {
            return Arc::clone(values);
        }
        // Numbers that are known by enclosures alone take long, and are asked for with ever other bits.
        let step = (bits + GUARD).next_multiple_of(STEP) - GUARD;
        if step != bits && self.has_enclosed_numbers() {
            let values: Arc<Vec<Ball>> = Arc::new(self.values(step).iter().map(|v| v.with_bits(bits)).collect());
            known().insert(bits, Arc::clone(&values));
            return values;
        }
        let mut values = Vec::with_capacity(self.len());
        // All solutions of an equation at once.
        let mut rows: Vec<(&[RationalFunction], &RationalFunction, Vec<Ball>)> = Vec::new();
        let mut families: Vec<(&FamilyValue, Vec<Ball>)> = Vec::new();
        for (_, definition) in &self.table {
            if let Definition::Family(value) = definition {
                let is_same = |(of, _): &(&FamilyValue, _)| Arc::ptr_eq(&of.of, &value.of) && of.at == value.at;
                let row = families.iter().position(is_same).unwrap_or_else(|| {
                    let found = narrow(bits, value.of.values_count(), |bits| self.family_values(value, bits));
                    families.push((value, found));
                    families.len() - 1
                });
                values.push(families[row].1[value.index].clone());
                continue;
            }
            let Definition::Fundamental { polynomial, index, time } = definition else {
                values.push(self.value(definition, bits));
                continue;
            };
            let row = rows.iter().position(|(of, at, _)| *of == polynomial.as_slice() && *at == time);
            let row = row.unwrap_or_else(|| {
                let found = narrow(bits, polynomial.len() - 1, |bits| self.solutions(polynomial, time, bits));
                rows.push((polynomial, time, found));
                rows.len() - 1
            });
            values.push(rows[row].2[*index].clone());
        }
        let values = Arc::new(values);
        known().insert(bits, Arc::clone(&values));
        values
    }

    /// The value of a definition, narrow unless an argument is at a pole.
    fn value(&self, definition: &Definition, bits: u64) -> Ball {
        let at_rationals = at_rationals(definition, bits);
        at_rationals
            .unwrap_or_else(|| narrow(bits, 1, |bits| Some(vec![self.attempt(definition, bits)?])).swap_remove(0))
    }

    /// All fundamental solutions of an equation at a time; `None` where a divisor may vanish.
    /// All values of a family at arguments that are numbers.
    fn family_values(&self, value: &FamilyValue, bits: u64) -> Option<Vec<Ball>> {
        let like = Series::constant(&Ball::zero(bits), 1);
        let at = |f: &RationalFunction| Some(Series::constant(&self.quotient_at(f, bits)?, 1));
        let at = value.at.iter().map(at).collect::<Option<Vec<Series>>>()?;
        Some(value.of.values(&at, &like)?.iter().map(|s| s.coefficients()[0].clone()).collect())
    }

    fn solutions(&self, polynomial: &[RationalFunction], time: &RationalFunction, bits: u64) -> Option<Vec<Ball>> {
        let constant = |c: &RationalFunction| Some(Series::constant(&self.quotient_at(c, bits)?, 1));
        let (_, lower) = polynomial.split_last()?;
        let coefficients = lower.iter().map(constant).collect::<Option<Vec<Series>>>()?;
        let row = fundamental_solutions(&coefficients, &constant(time)?);
        Some(row.iter().map(|s| s.coefficients()[0].clone()).collect())
    }

    /// The value computed with that many bits; `None` where a divisor may vanish.
    fn attempt(&self, definition: &Definition, bits: u64) -> Option<Ball> {
        let at = |f: &RationalFunction| self.quotient_at(f, bits);
        match definition {
            Definition::Pi => Some(Ball::from_enclosure(&Enclosure::pi(bits + 8), bits)),
            Definition::Algebraic(x) => Some(Definition::enclosed(x, bits)),
            Definition::Enclosed(x) => Some(x.at(bits)),
            Definition::Root(x) => at(x)?.sqrt(),
            Definition::Exponential(x) => Some(exp(&at(x)?)),
            Definition::Tangent { square, time } => {
                let (w, t) = (at(square)?, at(time)?);
                let turn = BallMatrix::from_fn(2, |i, j| match (i, j) {
                    (0, 1) => t.clone(),
                    (1, 0) => w.mul(&t).neg(),
                    _ => Ball::zero(bits),
                });
                let e = exponential(&turn);
                e.at(0, 1).div(e.at(0, 0))
            }
            Definition::Fundamental { polynomial, index, time } => {
                Some(self.solutions(polynomial, time, bits)?.swap_remove(*index))
            }
            Definition::Family(value) => Some(self.family_values(value, bits)?.swap_remove(value.index)),
            Definition::Duty(duty) => {
                let value = duty.value(|f| Some(Series::constant(&at(f)?, 1)))?;
                Some(value.coefficients()[0].clone())
            }
        }
    }

    /// The value of a rational function of symbols; `None` where the denominator may vanish.
    pub fn quotient_at(&self, f: &RationalFunction, bits: u64) -> Option<Ball> {
        self.enclose(f.numerator(), bits).div(&self.enclose(f.denominator(), bits))
    }

    /// The value of a polynomial in symbols, computed with that many bits after the point.
    ///
    /// Cost: products of balls, as many as Horner's scheme in several variables takes: at most one for each term and symbol.
    pub fn enclose(&self, p: &MultiPoly, bits: u64) -> Ball {
        // The arguments of a symbol are asked for while the table of values is made: then only what they have is there.
        let needed = p.variables().last().map_or(0, |i| i + 1);
        Horner::of(p).at_balls(&self.first_values(needed, bits), bits)
    }

    fn has_no_arguments(&self) -> bool {
        self.table.iter().all(|(_, definition)| definition.arguments().is_empty())
    }

    fn first_values(&self, count: usize, bits: u64) -> Arc<Vec<Ball>> {
        let known = self.values.lock().unwrap_or_else(PoisonError::into_inner).get(&bits).cloned();
        match known {
            Some(values) => values,
            // Those without arguments are all there at once, and kept.
            None if count == self.len() || self.has_no_arguments() => self.values(bits),
            None => Arc::new(self.table[..count].iter().map(|(_, d)| self.value(d, bits)).collect()),
        }
    }
}

/// Numbers that are known by enclosures alone are computed with a multiple of so many bits, less those that their computation takes beside.
const STEP: u64 = 256;
const GUARD: u64 = 64;

/// The value of a definition with rational arguments.
fn at_rationals(definition: &Definition, bits: u64) -> Option<Ball> {
    match definition {
        Definition::Pi => Some(Ball::from_enclosure(&Enclosure::pi(bits + 8), bits)),
        Definition::Algebraic(x) => Some(Definition::enclosed(x, bits)),
        Definition::Enclosed(x) => Some(x.at(bits)),
        Definition::Root(x) => {
            let x = x.as_constant()?;
            Ball::from_rational(&x, 2 * bits + 2).sqrt().map(|root| root.with_bits(bits))
        }
        Definition::Exponential(x) => {
            let x = x.as_constant()?;
            Some(exponential_of_rationals(&Matrix::from_fn(1, 1, |_, _| x.clone()), bits).at(0, 0).clone())
        }
        Definition::Tangent { square, time } => Some(tangent(&square.as_constant()?, &time.as_constant()?, bits)),
        Definition::Fundamental { .. } | Definition::Duty(_) | Definition::Family(_) => None,
    }
}

/// The values that are found with more and more bits, until they are narrow; wide ones, `count` of them, where they never are.
fn narrow(bits: u64, count: usize, mut attempt: impl FnMut(u64) -> Option<Vec<Ball>>) -> Vec<Ball> {
    let most = Integer::from(1 << 8);
    let mut working = bits + 32;
    loop {
        let found: Option<Vec<Ball>> = attempt(working).map(|list| list.iter().map(|v| v.with_bits(bits)).collect());
        let is_last = working > 16 * (bits + 64);
        match found {
            Some(list) if is_last || list.iter().all(|v| v.width_units() <= most) => return list,
            None if is_last => {
                let wide = Integer::ONE << (2 * bits + 64);
                return vec![Ball::from_units(-&wide, wide, bits); count];
            }
            _ => working *= 2,
        }
    }
}

/// The companion matrix of a monic polynomial, times a number: the first row of its exponential are the fundamental
/// solutions.
fn companion(factor: &[Rational], time: &Rational) -> Matrix<Rational> {
    let n = factor.len();
    Matrix::from_fn(n, n, |i, j| {
        if i + 1 == n {
            -(&factor[j] * time)
        } else if j == i + 1 {
            time.clone()
        } else {
            Rational::ZERO
        }
    })
}

/// `sin(v)/(v cos(v)) t` with `v = sqrt(w) t`.
fn tangent(w: &Rational, time: &Rational, bits: u64) -> Ball {
    if time.is_zero() {
        return Ball::zero(bits);
    }
    until_shown(bits + 16, |working| {
        let e = exponential_of_rationals(&companion(&[w.clone(), Rational::ZERO], time), working);
        // The angle is algebraic and not 0, so that its cosine is not 0.
        let tangent = e.at(0, 1).div(e.at(0, 0))?.with_bits(bits);
        (tangent.width_units() <= Integer::from(4)).then_some(tangent)
    })
}

#[cfg(test)]
mod tests;
