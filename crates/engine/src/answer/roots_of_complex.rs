//! The roots of a loop with complex coefficients, with dead time or without. `D = g h` with the greatest factor `g` that has real coefficients. The roots of
//! `g` are real or conjugate pairs. No root of `h` is real, but with dead time `s = 0` may be one, and no two roots of `h` are conjugate. So each conjugate pair of
//! roots of `h conj(h)` contains exactly one root of `h`, and a real root of `D` is one of `D conj(D)` twice as often.

use super::roots::{Roots, discs};
use crate::error::Error;
use crate::model::{ComplexPolynomial, quotient_at};
use crate::precisions::ROOTS;
use crate::problem::{Algebra, Beside, ComplexFunction};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, RootDisc, UniPoly, complex_roots};

/// How often discs are made narrower, by the square of their radius each time, until it shows which of two conjugates is a root.
const MOST_ATTEMPTS: usize = 5;

/// The roots of a complex loop at a point, and how many there are; a disc below the real axis is one by itself.
pub(super) fn roots_of_complex(
    whole: &ComplexPolynomial,
    algebra: &Algebra,
    narrow: &Rational,
    budget: &Budget,
) -> Result<Vec<RootDisc>, Error> {
    let point = Point { algebra, budget };
    let is_undefined = |p: &MultiPoly| p.is_zero();
    if algebra.polynomial().is_some_and(|p| p.poles.iter().any(is_undefined)) {
        return Err(Error::Undefined("an expression divides by zero".into()));
    }
    let (real, others) = budget.enter(|| whole.real_factor())?;
    let mut found = point.roots(&real, narrow)?;
    let product = others.with_conjugate();
    let others = at_a_point(&others, algebra)?;
    found.extend(narrowed(narrow, |radius| {
        let pairs = point.roots(&product, radius)?;
        Ok(pairs.into_iter().map(|disc| Pair::of(disc, &others)?.one()).collect::<Option<Vec<_>>>())
    })?);
    Ok(found)
}

/// The rightmost roots of a complex loop with dead time, from those of `D conj(D)`: `with_conjugates` finds them in discs that are so narrow.
pub(super) fn rightmost_of_complex(
    whole: &ComplexPolynomial,
    algebra: &Algebra,
    narrow: &Rational,
    budget: &Budget,
    with_conjugates: impl Fn(&Rational) -> Result<Roots, Error>,
) -> Result<Roots, Error> {
    let (_, others) = budget.enter(|| whole.real_factor())?;
    let others = at_a_point(&others, algebra)?;
    narrowed(narrow, |radius| {
        let mut roots = with_conjugates(radius)?;
        for root in &mut roots.list {
            match budget.enter(|| Pair::of(root.disc.clone(), &others)?.of_product())? {
                Some(disc) => root.disc = disc,
                None => return Ok(None),
            }
        }
        Ok(Some(roots))
    })
}

fn at_a_point(whole: &ComplexPolynomial, algebra: &Algebra) -> Result<ComplexFunction, Error> {
    let beside = Beside::of(algebra.symbols(), 0)?;
    let whole = whole.try_map(|f| Some(beside.placed(f))).expect("every function has a place");
    ComplexFunction::new(&whole, &beside)
}

/// What is found with discs that are narrow enough.
fn narrowed<T>(narrow: &Rational, find: impl Fn(&Rational) -> Result<Option<T>, Error>) -> Result<T, Error> {
    let mut radius = narrow.clone();
    for _ in 0..MOST_ATTEMPTS {
        if let Some(found) = find(&radius)? {
            return Ok(found);
        }
        radius = &radius * &radius;
    }
    Err(ROOTS.exhausted("which of two conjugates is a root").into())
}

/// A disc, and whether roots of `h` may lie in it and in its mirror image.
struct Pair {
    disc: RootDisc,
    may_hold: [bool; 2],
}

impl Pair {
    fn of(disc: RootDisc, others: &ComplexFunction) -> Option<Pair> {
        let bits = 64 + disc.radius.denominator().bit_length();
        let around = |centre: &Rational| Ball::between(&(centre - &disc.radius), &(centre + &disc.radius), bits);
        let (x, y) = (around(&disc.re), around(&disc.im));
        let may_hold = |y: &Ball| others.may_vanish(&Ball::zero(bits), [&x, y]);
        let may_hold = [may_hold(&y)?, may_hold(&y.neg())?];
        Some(Pair { disc, may_hold })
    }

    /// The disc of those roots of `h` that lie in it or in its mirror image; `None` where it does not show in which.
    fn one(self) -> Option<RootDisc> {
        match self.may_hold {
            [true, false] => Some(RootDisc { is_pair: false, ..self.disc }),
            [false, true] => Some(RootDisc { is_pair: false, im: -self.disc.im, ..self.disc }),
            _ => None,
        }
    }

    /// The disc of those roots of `D` that are roots of `D conj(D)` in it; `None` where it does not show which.
    fn of_product(self) -> Option<RootDisc> {
        let is_real = !self.disc.is_pair && self.disc.im.is_zero();
        match (self.may_hold, self.disc.count) {
            (_, count) if is_real => (count % 2 == 0).then_some(RootDisc { count: count / 2, ..self.disc }),
            ([false, false], count) => (count % 2 == 0).then_some(RootDisc { count: count / 2, ..self.disc }),
            // No root of `g` is there, too: it would be counted twice.
            (_, 1) => self.one(),
            _ => None,
        }
    }
}

/// The values at a point.
struct Point<'a> {
    algebra: &'a Algebra,
    budget: &'a Budget,
}

impl Point<'_> {
    fn enclosed(&self, coefficients: &[RationalFunction], bits: u64) -> Option<Vec<Ball>> {
        let values = match self.algebra.symbols().is_empty() {
            true => Vec::new(),
            false => self.algebra.symbols().enclosed(bits)?,
        };
        coefficients.iter().map(|c| quotient_at(c, &values, bits)).collect()
    }

    /// The roots of a polynomial with real coefficients.
    fn roots(&self, coefficients: &[RationalFunction], narrow: &Rational) -> Result<Vec<RootDisc>, Error> {
        let numbers: Option<Vec<Rational>> = coefficients.iter().map(RationalFunction::as_constant).collect();
        if let Some(numbers) = numbers {
            let (_, integral) = UniPoly::from_rational_poly(&Poly::new(numbers));
            return Ok(complex_roots(&integral, narrow, self.budget)?);
        }
        let zeros = coefficients.iter().take_while(|c| c.is_zero()).count();
        discs(|bits| self.enclosed(coefficients, bits), zeros, narrow, self.budget)
    }
}
