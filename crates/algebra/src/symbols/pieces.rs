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

/// A place of a zero is halved so often at most: what is left out is mostly larger by then.
const MOST_NARROWINGS: u32 = 48;

/// The radius of the disc divided by the width of the interval.
pub(super) fn disc_radius() -> Rational {
    Rational::new(Integer::from(DISC.0), Integer::from(2 * DISC.1))
}

/// What a Taylor polynomial says of a function on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    None,
    /// One zero, which is not an end, with a derivative that is not zero on an interval that was halved so often since.
    One {
        halvings: u32,
    },
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
        let mut add = |lo: Rational, hi: Rational, look: Look| match found.last_mut() {
            Some((_, end, last)) if look == *last && !matches!(look, Look::One { .. }) => *end = hi,
            _ if lo == hi => {}
            _ => found.push((lo, hi, look)),
        };
        self.judge(MOST_HALVINGS, sign_at, &mut |piece, look| {
            let Look::One { .. } = look else { return add(piece.lo.clone(), piece.hi.clone(), look) };
            let (lo, hi, halvings) = piece.narrowed();
            add(piece.lo.clone(), lo.clone(), Look::None);
            add(lo, hi.clone(), Look::One { halvings });
            add(hi, piece.hi.clone(), Look::None);
        });
        found
    }

    /// The place of the one zero, halved as often as the polynomial tells the sign in the middle, and how often that was.
    fn narrowed(&self) -> (Rational, Rational, u32) {
        let is_rising = self.polynomial[1].sign() == Some(Sign::Greater);
        // From `from/2^halvings` to `(from + 2)/2^halvings`.
        let (mut from, mut halvings) = (-Integer::ONE, 0);
        while halvings < MOST_NARROWINGS {
            let middle = &from + Integer::ONE;
            let Some(sign) = self.sign_at(&middle, halvings) else { break };
            from = &from + &from;
            if sign.is_gt() != is_rising {
                from += Integer::from(2);
            }
            halvings += 1;
        }
        let width = (&self.hi - &self.lo) * Rational::dyadic(&Integer::ONE, halvings.into());
        let before = from + (Integer::ONE << u64::from(halvings));
        let lo = &self.lo + &(&width * &Rational::dyadic(&before, 1));
        let hi = &lo + &width;
        (lo, hi, halvings)
    }

    /// The sign at `y = n/2^exponent`, where the polynomial tells it.
    fn sign_at(&self, n: &Integer, exponent: u32) -> Option<Sign> {
        let zero = Ball::zero(self.polynomial[0].bits());
        let terms = self.polynomial.iter().rev();
        let sum = terms.fold(zero, |sum, c| sum.scaled(n).shifted(-i64::from(exponent)).add(c));
        sum.widened(&self.rest).sign().filter(|s| s.is_ne())
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
        let sign = |y: i64, x: &Rational| self.sign_at(&Integer::from(y), 0).or_else(|| sign_at(x));
        match (sign(-1, &self.lo), sign(1, &self.hi)) {
            (Some(a), Some(b)) if a != b => Look::One { halvings: 0 },
            (Some(_), Some(_)) => Look::None,
            _ => Look::Unknown,
        }
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

    /// `exp(p) (p - 150/101)`: what is left out over so short an interval tells many binary digits of the zero.
    #[test]
    fn the_polynomial_says_where_its_zero_is() {
        let (lo, hi, zero) = (number("1"), number("2"), number("150/101"));
        let p = parameter(&lo, &hi, 12);
        let piece = of_model(&p.exp().mul(&p.sub(&p.constant(&Ball::from_rational(&zero, BITS)))), &lo, &hi);
        let found = piece.judged(&|_| None);
        let [(_, below, Look::None), (a, b, Look::One { halvings }), (above, _, Look::None)] = &found[..] else {
            panic!("{found:?}")
        };
        assert!(below == a && b == above && *a < zero && zero < *b);
        assert!(*halvings > 20 && (b - a) * Rational::from(2).pow(i64::from(*halvings)).unwrap() <= &hi - &lo);
        // The zero is the middle: no more is known.
        let middle = number("3/2");
        let piece = of_model(&p.sub(&p.constant(&Ball::from_rational(&middle, BITS))), &lo, &hi);
        assert_eq!(piece.judged(&|_| None), [(lo, hi, Look::One { halvings: 0 })]);
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
                    Look::One { halvings } => {
                        prop_assert_eq!(inside, 1);
                        let wide = Rational::from(2).pow(i64::from(*halvings)).unwrap() * (hi - lo);
                        prop_assert!(wide <= Rational::from(width));
                    }
                    _ => {}
                }
            }
            // Zeros that are apart, and none an end of a piece, are found.
            let is_inside = [&a, &b].iter().all(|x| !x.is_integer());
            if is_inside && (&a - &b).abs() > number("1/2") && width < 4 {
                prop_assert!(found.iter().all(|(_, _, look)| *look != Look::Unknown), "{:?}", found);
            }
        }
    }
}
