//! Real algebraic numbers: a polynomial and an enclosure that holds one of its roots.

use super::modular::gcd::coprime_modulo_some_prime;
use super::real_roots::{Bracket, linear};
use super::{Domain, UniPoly};
use crate::number::{Integer, Rational, Sign, enclosed_decimal};
use std::cmp::Ordering;
use std::sync::Arc;

/// A real algebraic number.
///
/// It is the only root of [`polynomial`](RealAlgebraic::polynomial) in the closed
/// [`enclosure`](RealAlgebraic::enclosure), whose ends are equal exactly when the number is
/// rational. Comparisons are exact and decide equality; the order is that of the real line.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::{RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
/// let p = SquareFree::new(UniPoly::from_i64(&[-2, 0, 1])).unwrap(); // x^2 - 2
/// let root = isolate_real_roots(&p, &Budget::unlimited()).unwrap().pop().unwrap();
/// assert!(root.compare_rational(&Rational::ONE).is_gt());
/// assert!(root.sign_of(&UniPoly::from_i64(&[-4, 0, 0, 0, 1])).is_eq()); // x^4 - 4
/// assert!(root.compare(&RealAlgebraic::from_rational(2.into())).is_lt());
/// ```
#[derive(Clone, Debug)]
pub struct RealAlgebraic {
    poly: Arc<UniPoly>,
    place: Place,
}

#[derive(Clone, Debug)]
enum Place {
    Exact(Rational),
    Within(Bracket),
}

impl RealAlgebraic {
    /// A rational number, with the polynomial `q x - p`.
    pub fn from_rational(value: Rational) -> RealAlgebraic {
        RealAlgebraic { poly: Arc::new(linear(&value)), place: Place::Exact(value) }
    }

    pub(super) fn from_bracket(poly: Arc<UniPoly>, bracket: Bracket) -> RealAlgebraic {
        debug_assert_eq!(poly.sign_at(&bracket.hi()).is_gt(), bracket.rising, "the sign at the upper end");
        debug_assert_eq!(poly.sign_at(&bracket.lo()).is_lt(), bracket.rising, "the sign at the lower end");
        RealAlgebraic { poly, place: Place::Within(bracket) }
    }

    /// A square-free primitive polynomial with this number as a root; `q x - p` if it is rational.
    pub fn polynomial(&self) -> &UniPoly {
        &self.poly
    }

    /// Lower and upper end: equal for a rational number, otherwise strictly around the number and
    /// around no other root of the polynomial.
    pub fn enclosure(&self) -> (Rational, Rational) {
        match &self.place {
            Place::Exact(x) => (x.clone(), x.clone()),
            Place::Within(b) => (b.lo(), b.hi()),
        }
    }

    /// The value, if it is rational.
    pub fn exact(&self) -> Option<Rational> {
        match &self.place {
            Place::Exact(x) => Some(x.clone()),
            Place::Within(_) => None,
        }
    }

    /// Halves the enclosure.
    pub(super) fn halve(&mut self) {
        if let Place::Within(b) = &mut self.place {
            b.halve(&self.poly);
        }
    }

    /// Narrows the enclosure to a width of at most `2^-bits`.
    fn narrow(&mut self, bits: i64) {
        if let Place::Within(b) = &mut self.place {
            b.refine(&self.poly, bits);
        }
    }

    /// The same number with an enclosure of at most the given positive width (of any width, if
    /// `width` is not positive).
    ///
    /// Cost: secant steps ([Abbott2014](crate::bibliography#abbott2014)), each of which about doubles the bits, so
    /// that the last ones count: `O(n)` products of numbers as long as the enclosure in fixed point, up to `n`
    /// times as long where the enclosure touches zero.
    pub fn refined(&self, width: &Rational) -> RealAlgebraic {
        let mut out = self.clone();
        if width.sign().is_gt() {
            out.narrow(bits_below(width));
        }
        out
    }

    /// The same number with an enclosure of relative width at most `10^-(digits + 2)`.
    pub fn refined_to_digits(&self, digits: usize) -> RealAlgebraic {
        let mut out = self.clone();
        out.narrow_to_digits(digits);
        out
    }

    fn narrow_to_digits(&mut self, digits: usize) {
        let least = loop {
            let (lo, hi) = self.enclosure();
            if lo == hi {
                return;
            }
            // An irrational number is not 0, so that its sign shows in the end.
            if lo.sign() == hi.sign() {
                let least = lo.abs().min(hi.abs());
                if lo.abs().max(hi.abs()) <= &least + &least {
                    break least;
                }
            }
            self.halve();
        };
        let tolerance = Rational::new(Integer::ONE, Integer::from(10).pow(digits as u64 + 2));
        self.narrow(bits_below(&(least * tolerance)));
    }

    /// The sign.
    pub fn sign(&self) -> Sign {
        self.compare_rational(&Rational::ZERO)
    }

    /// Exact comparison with a rational number.
    pub fn compare_rational(&self, x: &Rational) -> Ordering {
        match &self.place {
            Place::Exact(value) => value.cmp(x),
            Place::Within(b) => {
                if *x <= b.lo() {
                    Ordering::Greater
                } else if *x >= b.hi() {
                    Ordering::Less
                } else if (self.poly.sign_at(x) == Ordering::Greater) == b.rising {
                    // The sign at x is that beyond the root.
                    Ordering::Less
                } else {
                    Ordering::Greater
                }
            }
        }
    }

    /// Exact comparison: equality is decided by a common divisor, never by refinement alone.
    ///
    /// Cost: a few halvings where the numbers differ; else a greatest common divisor of the polynomials, or a check
    /// modulo a prime that there is none, and refinement until the enclosures part.
    pub fn compare(&self, other: &RealAlgebraic) -> Ordering {
        let (a, b) = match (&self.place, &other.place) {
            (_, Place::Exact(y)) => return self.compare_rational(y),
            (Place::Exact(x), _) => return other.compare_rational(x).reverse(),
            (Place::Within(a), Place::Within(b)) => (a, b),
        };
        if let Some(order) = order_of_disjoint(a, b) {
            return order;
        }
        let same = Arc::ptr_eq(&self.poly, &other.poly) || self.poly == other.poly;
        // Unequal numbers mostly part after a few bits; a common divisor costs more.
        let (mut x, mut y) = (self.clone(), other.clone());
        if !same {
            for _ in 0..8 {
                x.halve();
                y.halve();
                if let Some(order) = x.disjoint_order(&y) {
                    return order;
                }
            }
        }
        let common = if same {
            Some(Arc::clone(&self.poly))
        } else if coprime_modulo_some_prime(&self.poly, &other.poly) {
            None
        } else {
            Some(Arc::new(self.poly.gcd(&other.poly)))
        };
        if common.is_some_and(|g| x.shares_root_of(&y, &g)) {
            return Ordering::Equal;
        }
        loop {
            if let Some(order) = x.disjoint_order(&y) {
                return order;
            }
            x.narrow_further();
            y.narrow_further();
        }
    }

    /// For overlapping enclosures and a common divisor of both polynomials: whether the divisor
    /// has a root in both, which then is either number.
    fn shares_root_of(&self, other: &RealAlgebraic, common: &UniPoly) -> bool {
        let ((a, b), (c, d)) = (self.enclosure(), other.enclosure());
        // Ends of enclosures are no roots, and what is left of the enclosures has one root at most.
        common.sign_at(&a.max(c)) != common.sign_at(&b.min(d))
    }

    fn disjoint_order(&self, other: &RealAlgebraic) -> Option<Ordering> {
        match (&self.place, &other.place) {
            (Place::Within(a), Place::Within(b)) => order_of_disjoint(a, b),
            _ => None,
        }
    }

    /// About twice as many bits of the enclosure.
    pub(super) fn narrow_further(&mut self) {
        if let Place::Within(b) = &mut self.place {
            b.refine_further(&self.poly);
        }
    }

    /// The exact sign of `q` at this number; a zero is recognised by a common divisor.
    ///
    /// Cost: a check modulo a prime that `q` and the polynomial are coprime, a greatest common divisor where they
    /// are not, and values of `q` on an enclosure that is refined until its sign shows.
    pub fn sign_of(&self, q: &UniPoly) -> Sign {
        let bracket = match &self.place {
            Place::Exact(x) => return q.sign_at(x),
            Place::Within(b) => b,
        };
        if q.is_constant() {
            return q.leading().map_or(Sign::Equal, Integer::sign);
        }
        if !coprime_modulo_some_prime(&self.poly, q) {
            let g = self.poly.gcd(q);
            if g.sign_at(&bracket.lo()) != g.sign_at(&bracket.hi()) {
                return Sign::Equal;
            }
        }
        let mut x = bracket.clone();
        loop {
            if let Some(sign) = sign_on(q, &x) {
                return sign;
            }
            x.refine_further(&self.poly);
        }
    }

    /// Rounded to so many significant digits, correctly: ties to even for rational numbers, and an
    /// irrational one is refined until both ends of its enclosure round alike (it is no tie).
    ///
    /// Cost: that of [`RealAlgebraic::refined`] to about `3.4 digits` bits, and the conversion to decimal.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::{SquareFree, UniPoly, isolate_real_roots};
    /// let p = SquareFree::new(UniPoly::from_i64(&[-2, 0, 1])).unwrap();
    /// let roots = isolate_real_roots(&p, &Budget::unlimited()).unwrap();
    /// assert_eq!(roots[1].decimal(12), "1.41421356237");
    /// ```
    pub fn decimal(&self, digits: usize) -> String {
        let mut x = self.refined_to_digits(digits);
        loop {
            let (lo, hi) = x.enclosure();
            if let Some(text) = enclosed_decimal(&lo, &hi, digits) {
                return text;
            }
            x.narrow_further();
        }
    }

    /// The greatest integer that is not above this number.
    pub fn floor(&self) -> Integer {
        let mut x = self.clone();
        loop {
            let (lo, hi) = x.enclosure();
            let floor = lo.floor();
            // For lo < x < hi; an integer in between is not x, as x is irrational or lo = hi.
            if lo == hi || hi <= Rational::from(&floor + &Integer::ONE) {
                return floor;
            }
            x.halve();
        }
    }

    /// A rational number below this one: the greatest such integer.
    pub fn rational_below(&self) -> Rational {
        let floor = Rational::from(self.floor());
        if self.compare_rational(&floor).is_eq() { floor - Rational::ONE } else { floor }
    }

    /// A rational number above this one: the least such integer.
    pub fn rational_above(&self) -> Rational {
        Rational::from(self.floor()) + Rational::ONE
    }

    /// The number with the opposite sign.
    pub fn negated(&self) -> RealAlgebraic {
        let place = match &self.place {
            Place::Exact(x) => return RealAlgebraic::from_rational(-x),
            Place::Within(b) => b,
        };
        let mirrored = self.poly.negated_argument();
        let flipped = mirrored.needs_negation();
        let poly = Arc::new(if flipped { mirrored.negated() } else { mirrored });
        let rising = place.rising == flipped;
        let bracket = Bracket { lo: -&place.hi, hi: -&place.lo, bits: place.bits, rising };
        RealAlgebraic::from_bracket(poly, bracket)
    }
}

/// The rational with the smallest denominator strictly between two numbers (of those, the one of
/// smallest magnitude); `None` when they are equal.
pub fn rational_between(a: &RealAlgebraic, b: &RealAlgebraic) -> Option<Rational> {
    let (mut a, mut b) = match a.compare(b) {
        Ordering::Less => (a.clone(), b.clone()),
        Ordering::Greater => (b.clone(), a.clone()),
        Ordering::Equal => return None,
    };
    loop {
        // The simplest of a slightly longer interval is the simplest of this one if it is in it.
        let candidate = simplest_between(&a.enclosure().0, &b.enclosure().1)?;
        if a.compare_rational(&candidate).is_lt() && b.compare_rational(&candidate).is_gt() {
            return Some(candidate);
        }
        a.halve();
        b.halve();
    }
}

/// The rational with the smallest denominator strictly between two rationals (of those, the one
/// of smallest magnitude): a walk down the Stern-Brocot tree by continued fractions
/// [GrahamKnuthPatashnik1994](crate::bibliography#grahamknuthpatashnik1994). `None` unless `lo < hi`.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::algebraic::simplest_between;
/// let r = |p: i64, q: i64| Rational::new(p.into(), q.into());
/// assert_eq!(simplest_between(&r(1, 3), &r(1, 2)), Some(r(2, 5)));
/// assert_eq!(simplest_between(&r(-7, 2), &r(-2, 1)), Some(r(-3, 1)));
/// ```
pub fn simplest_between(lo: &Rational, hi: &Rational) -> Option<Rational> {
    if lo >= hi {
        return None;
    }
    if lo.is_negative() && hi.sign().is_gt() {
        return Some(Rational::ZERO);
    }
    if hi.sign().is_le() {
        return simplest_between(&-hi, &-lo).map(|x| -x);
    }
    // Continued fraction of the answer: quotients while both ends agree. `hi` of `None` is infinity.
    let mut quotients = Vec::new();
    let (mut lo, mut hi) = (lo.clone(), Some(hi.clone()));
    loop {
        let floor = lo.floor();
        let above = &floor + &Integer::ONE;
        if hi.as_ref().is_none_or(|hi| Rational::from(&above) < *hi) {
            quotients.push(above);
            break;
        }
        let whole = Rational::from(&floor);
        let next_lo = hi.and_then(|hi| (hi - &whole).recip()).expect("hi is above the integer part of lo");
        hi = (lo - &whole).recip();
        lo = next_lo;
        quotients.push(floor);
    }
    let mut value = Rational::from(quotients.pop().expect("pushed before the loop ended"));
    for q in quotients.into_iter().rev() {
        value = Rational::from(q) + value.recip().expect("the inner value is above 1");
    }
    Some(value)
}

/// A `k` with `2^-k <= width`, `width` positive.
fn bits_below(width: &Rational) -> i64 {
    // width = n / d >= 2^(bits(n) - 1 - bits(d)).
    width.denominator().bit_length() as i64 - width.numerator().bit_length() as i64 + 1
}

fn order_of_disjoint(a: &Bracket, b: &Bracket) -> Option<Ordering> {
    let bits = a.bits.max(b.bits);
    let (up_a, up_b) = (bits - a.bits, bits - b.bits);
    if (&a.hi << up_a) <= (&b.lo << up_b) {
        Some(Ordering::Less)
    } else if (&b.hi << up_b) <= (&a.lo << up_a) {
        Some(Ordering::Greater)
    } else {
        None
    }
}

/// The sign of `q` on all of a bracket, if interval arithmetic shows it: Horner's rule in fixed
/// point, rounded outwards.
fn sign_on(q: &UniPoly, bracket: &Bracket) -> Option<Sign> {
    let bits = bracket.bits;
    let scale = 2 * bits + 64;
    let (lo, hi) = (&bracket.lo, &bracket.hi);
    let (mut least, mut greatest) = (Integer::ZERO, Integer::ZERO);
    for c in q.coeffs().iter().rev() {
        let products = [&least * lo, &least * hi, &greatest * lo, &greatest * hi];
        let floor = products.iter().min().expect("four products") >> bits;
        let below = products.iter().max().expect("four products") >> bits;
        let c = c << scale;
        least = floor + &c;
        greatest = below + Integer::ONE + c;
    }
    match (least.sign(), greatest.sign()) {
        (Sign::Greater, _) => Some(Sign::Greater),
        (_, Sign::Less) => Some(Sign::Less),
        _ => None,
    }
}

impl PartialEq for RealAlgebraic {
    fn eq(&self, other: &Self) -> bool {
        self.compare(other).is_eq()
    }
}
impl Eq for RealAlgebraic {}
impl PartialOrd for RealAlgebraic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for RealAlgebraic {
    fn cmp(&self, other: &Self) -> Ordering {
        self.compare(other)
    }
}
impl From<Rational> for RealAlgebraic {
    fn from(value: Rational) -> Self {
        RealAlgebraic::from_rational(value)
    }
}
