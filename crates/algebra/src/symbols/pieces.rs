//! What one Taylor polynomial says of a function on many pieces of an interval.
//!
//! To evaluate a function is dear, to halve the interval of a polynomial is cheap: what is left out of the polynomial is small on a wide interval
//! already, while the function varies there as a high power of the parameter and has to be looked at piece by piece.

use crate::ball::Ball;
use crate::number::{Integer, Rational, Sign};

/// The radius of the disc is this quotient of the interval's radius: what is left out is known of its derivative too on the interval.
const DISC: (u64, u64) = (5, 4);

/// Pieces are halved so often at most.
const MOST_HALVINGS: usize = 7;

/// The radius of the disc divided by the width of the interval.
pub(super) fn disc_radius() -> Rational {
    Rational::new(Integer::from(DISC.0), Integer::from(2 * DISC.1))
}

/// What a Taylor polynomial says of a function on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    None,
    /// One zero, with a derivative that is not zero on the interval.
    One,
    Unknown,
    /// Nothing, and no more of a shorter interval: the numbers would have too many bits.
    Hopeless,
}

/// The function of `y`, `|y| <= 1` on the piece.
#[derive(Clone)]
pub(super) struct Piece {
    lo: Rational,
    hi: Rational,
    polynomial: Vec<Ball>,
    /// Bounds of what the polynomial leaves out of the value and of the derivative, in units.
    rest: Integer,
    rest_of_slope: Integer,
}

impl Piece {
    /// The whole interval, from a polynomial on the disc and, in its units, a bound of the sum of the absolute values of all coefficients of
    /// what it is wrong by.
    ///
    /// With `|e_0| + |e_1| + ... <= e` on the disc the powers of `y = q x`, `q = 5/4`, have the coefficients `e_k q^-k`, and `k q^-k < 2`.
    pub fn new(polynomial: Vec<Ball>, rest: Integer, lo: &Rational, hi: &Rational) -> Piece {
        let scaled = |(k, c): (usize, &Ball)| {
            (0..k).fold(c.scaled(&Integer::from(DISC.1).pow(k as u64)), |c, _| c.divided_by(DISC.0))
        };
        let polynomial: Vec<Ball> = polynomial.iter().enumerate().map(scaled).collect();
        let rest_of_slope = &rest + &rest;
        Piece { lo: lo.clone(), hi: hi.clone(), polynomial, rest, rest_of_slope }
    }

    /// The greatest coefficient but the first, in units, the rest being one.
    pub fn variation(&self) -> Integer {
        self.polynomial[1..].iter().map(Ball::magnitude_units).chain([self.rest.clone()]).max().expect("a rest")
    }

    /// What is known of pieces from below, those next to each other of which nothing is known joined; the sign of the function at a
    /// rational number is asked for only where the polynomial does not tell it.
    ///
    /// Cost: `O(n^2)` sums of balls for each piece, `n` the number of terms.
    pub fn judged(&self, sign_at: &dyn Fn(&Rational) -> Option<Sign>) -> Vec<(Rational, Rational, Look)> {
        let mut found: Vec<(Rational, Rational, Look)> = Vec::new();
        self.judge(MOST_HALVINGS, sign_at, &mut |piece, look| match found.last_mut() {
            Some((_, hi, Look::Unknown)) if look == Look::Unknown => *hi = piece.hi.clone(),
            Some((_, hi, Look::None)) if look == Look::None => *hi = piece.hi.clone(),
            _ => found.push((piece.lo.clone(), piece.hi.clone(), look)),
        });
        found
    }

    fn judge(&self, halvings: usize, sign_at: &dyn Fn(&Rational) -> Option<Sign>, add: &mut dyn FnMut(&Piece, Look)) {
        let look = self.look(sign_at);
        let all = self.polynomial.iter().fold(Integer::ZERO, |sum, c| sum + c.magnitude_units());
        // Where as much is left out as there is, no piece tells more.
        if look != Look::Unknown || halvings == 0 || all <= self.rest {
            return add(self, look);
        }
        for half in self.halves() {
            half.judge(halvings - 1, sign_at, add);
        }
    }

    fn look(&self, sign_at: &dyn Fn(&Rational) -> Option<Sign>) -> Look {
        let weighted = |from: usize, weight: fn(usize) -> u64, rest: &Integer| {
            let terms = self.polynomial.iter().enumerate().skip(from);
            terms.fold(rest.clone(), |sum, (k, c)| sum + c.magnitude_units() * Integer::from(weight(k)))
        };
        if self.polynomial[0].least_magnitude_units() > weighted(1, |_| 1, &self.rest) {
            return Look::None;
        }
        if self.polynomial[1].least_magnitude_units() <= weighted(2, |k| k as u64, &self.rest_of_slope) {
            return Look::Unknown;
        }
        let sign = |is_upper: bool, x: &Rational| self.sign_at_end(is_upper).or_else(|| sign_at(x));
        match (sign(false, &self.lo), sign(true, &self.hi)) {
            (Some(a), Some(b)) if a != b => Look::One,
            (Some(_), Some(_)) => Look::None,
            _ => Look::Unknown,
        }
    }

    /// The sign at an end, where the polynomial tells it.
    fn sign_at_end(&self, is_upper: bool) -> Option<Sign> {
        let zero = Ball::zero(self.polynomial[0].bits());
        let terms = self.polynomial.iter().enumerate();
        let sum = terms.fold(zero, |sum, (k, c)| if is_upper || k % 2 == 0 { sum.add(c) } else { sum.sub(c) });
        sum.widened(&self.rest).sign().filter(|s| s.is_ne())
    }

    /// `y = (u - 1)/2` and `y = (u + 1)/2`.
    fn halves(&self) -> [Piece; 2] {
        let middle = self.lo.midpoint(&self.hi);
        let half = |is_upper: bool| {
            let mut c: Vec<Ball> = self.polynomial.iter().enumerate().map(|(k, c)| c.shifted(-(k as i64))).collect();
            // Now in 2 y, which is moved by one.
            for from in 0..c.len() {
                for k in (from..c.len() - 1).rev() {
                    c[k] = if is_upper { c[k].add(&c[k + 1]) } else { c[k].sub(&c[k + 1]) };
                }
            }
            c
        };
        let rest_of_slope = -(-&self.rest_of_slope >> 1);
        let of = |is_upper: bool, lo: &Rational, hi: &Rational| Piece {
            lo: lo.clone(),
            hi: hi.clone(),
            polynomial: half(is_upper),
            rest: self.rest.clone(),
            rest_of_slope: rest_of_slope.clone(),
        };
        [of(false, &self.lo, &middle), of(true, &middle, &self.hi)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::{Elementary, TaylorModel};
    use proptest::prelude::*;

    const BITS: u64 = 256;

    fn number(text: &str) -> Rational {
        text.parse().unwrap()
    }

    fn parameter(lo: &Rational, hi: &Rational, terms: usize) -> TaylorModel {
        let ball = |x: &Rational| Ball::from_rational(x, BITS);
        TaylorModel::linear(&ball(&lo.midpoint(hi)), &ball(&((hi - lo) * disc_radius())), terms)
    }

    fn of_model(model: &TaylorModel, lo: &Rational, hi: &Rational) -> Piece {
        let mut coefficients = model.coefficients();
        let rest = coefficients.pop().unwrap().magnitude_units();
        Piece::new(coefficients, rest, lo, hi)
    }

    /// `p^20 (p^2 + 1)`, over an octave: no coefficient dominates, but every piece of it is decided.
    #[test]
    fn a_high_power_has_no_zero_on_an_octave() {
        let (lo, hi) = (number("1"), number("2"));
        let p = parameter(&lo, &hi, 24);
        let piece = of_model(&p.power(20).mul(&p.mul(&p).add(&p.integer(&Integer::ONE))), &lo, &hi);
        assert_eq!(piece.look(&|_| None), Look::Unknown);
        assert_eq!(piece.judged(&|_| None), [(lo, hi, Look::None)]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        /// `exp(p) (p - a) (p - b)`: each zero is in one piece, and where none is said to be none is.
        #[test]
        fn pieces_have_the_zeros_they_are_said_to_have(a in 1i64..2000, b in 1i64..2000, lo in 1i64..9, width in 1i64..9) {
            let [a, b] = [a, b].map(|n| Rational::new(Integer::from(n), Integer::from(101)));
            let (lo, hi) = (Rational::from(lo), Rational::from(lo + width));
            let p = parameter(&lo, &hi, 12);
            let less = |x: &Rational| p.sub(&p.constant(&Ball::from_rational(x, BITS)));
            let piece = of_model(&p.exp().mul(&less(&a)).mul(&less(&b)), &lo, &hi);
            let exact = |x: &Rational| Some(((x - &a) * (x - &b)).sign()).filter(|s| s.is_ne());
            let found = piece.judged(&exact);
            prop_assert_eq!((&found[0].0, &found.last().unwrap().1), (&lo, &hi));
            for pair in found.windows(2) {
                prop_assert_eq!(&pair[0].1, &pair[1].0);
            }
            for (lo, hi, look) in &found {
                let inside = [&a, &b].into_iter().filter(|x| *lo < **x && **x < *hi).count();
                match look {
                    Look::None => prop_assert!(inside == 0 && *lo != a && *lo != b && *hi != a && *hi != b),
                    Look::One => prop_assert_eq!(inside, 1),
                    _ => {}
                }
            }
            // Zeros that are apart are found.
            if (&a - &b).abs() > number("1/2") && width < 4 {
                prop_assert!(found.iter().all(|(_, _, look)| *look != Look::Unknown), "{:?}", found);
            }
        }
    }
}
