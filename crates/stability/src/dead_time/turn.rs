//! Cosine and sine of rational angles in fixed point, with a proved error.

use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use std::cell::RefCell;

/// A complex number `(re + i im) 2^-scale`, either part known to within `error` units.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    pub re: Integer,
    pub im: Integer,
    pub error: Integer,
}

impl Fixed {
    pub fn one(scale: u64) -> Fixed {
        Fixed { re: &Integer::ONE << scale, im: Integer::ZERO, error: Integer::ZERO }
    }

    /// The product of two numbers of the same scale.
    pub fn times(&self, other: &Fixed, scale: u64) -> Fixed {
        let re = (&self.re * &other.re - &self.im * &other.im) >> scale;
        let im = (&self.re * &other.im + &self.im * &other.re) >> scale;
        // (a + e)(b + f) = ab + af + eb + ef, in each part twice, and the rounding.
        let size = |x: &Fixed| x.re.abs() + x.im.abs();
        let cross = &(size(self) * &other.error) + &(size(other) * &self.error);
        let both = &(&self.error * &other.error) << 1;
        Fixed { re, im, error: ((cross + both) >> scale) + Integer::from(2) }
    }

    pub fn plus(&self, other: &Fixed) -> Fixed {
        Fixed { re: &self.re + &other.re, im: &self.im + &other.im, error: &self.error + &other.error }
    }

    /// A lower bound of the modulus, not negative.
    pub fn at_least(&self) -> Integer {
        let square = &self.re * &self.re + &self.im * &self.im;
        let bound = square.sqrt_floor() - (&self.error << 1);
        if bound.is_negative() { Integer::ZERO } else { bound }
    }

    /// An upper bound of the modulus.
    pub fn at_most(&self) -> Integer {
        let square = &self.re * &self.re + &self.im * &self.im;
        square.sqrt_floor() + Integer::ONE + (&self.error << 1)
    }
}

thread_local! {
    /// `pi` at the last scale it was needed at: one count asks for the same one many times.
    static PI: RefCell<Option<(u64, Integer)>> = const { RefCell::new(None) };
}

/// `floor(pi 2^scale)`, to within two units.
fn pi(scale: u64) -> Integer {
    PI.with(|known| {
        if let Some((bits, value)) = known.borrow().as_ref()
            && *bits >= scale
            && *bits <= 2 * scale + 256
        {
            return value >> (bits - scale);
        }
        let bits = scale + 64;
        let value = (Enclosure::pi(bits + 8).lower() * &Rational::from(&Integer::ONE << bits)).floor();
        *known.borrow_mut() = Some((bits, value.clone()));
        value >> 64
    })
}

/// `exp(-i x)` of a rational angle, at a scale.
///
/// Reduced by quarter turns to at most `pi/4`, then the series of cosine and sine together.
///
/// Cost: `O(scale/log scale)` products of `scale` bits.
pub(super) fn turned(x: &Rational, scale: u64) -> Fixed {
    // Six guard bits for the terms, of which there are fewer than the scale has bits.
    let guard = 8 + (64 - scale.leading_zeros() as u64);
    let working = scale + guard;
    let whole = x.abs().floor().bit_length();
    let fine = working + whole + 2;
    let full = pi(fine);
    // Quarter turns: the nearest integer to 2 x / pi.
    let (n, d) = (x.numerator(), x.denominator());
    let units = (&n << fine).div_mod_floor(&d).0;
    let half = &full >> 1;
    let (turns, _) = (&units + &(&half >> 1)).div_mod_floor(&half);
    // The angle left: off by a unit of x and by two and a half for each of at most 2^(whole + 1) quarter turns.
    let rest = (units - &turns * &half) >> (fine - working);
    let (mut cos, mut sin) = (&Integer::ONE << working, rest.clone());
    let mut term = rest.clone();
    let mut k = 1u64;
    loop {
        checkpoint(24);
        k += 1;
        term = ((&term * &rest) >> working).div_mod_floor(&Integer::from(k as i64)).0;
        // One below zero is what rounding down leaves of nothing.
        if term.is_zero() || (term.is_negative() && (&term + &Integer::ONE).is_zero()) {
            break;
        }
        let part = if k.is_multiple_of(2) { &mut cos } else { &mut sin };
        *part = if k % 4 == 2 || k % 4 == 3 { &*part - &term } else { &*part + &term };
    }
    // A term is off by at most three units, as |x| < 1 and k >= 2 shrink the error before the roundings; the angle by at
    // most eight; what is left out is below the last term.
    let error = (Integer::from(3 * k as i64 + 16) >> guard) + Integer::from(2);
    let (cos, sin) = (cos >> guard, sin >> guard);
    // exp(-i x) = exp(-i rest) (-i)^turns.
    let quarter = turns.div_mod_floor(&Integer::from(4)).1.to_i64().expect("below four");
    let (re, im) = match quarter {
        0 => (cos, -sin),
        1 => (-sin, -cos),
        2 => (-cos, sin),
        _ => (sin, cos),
    };
    Fixed { re, im, error }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;

    fn agrees(value: &Integer, error: &Integer, scale: u64, digits: &str) {
        let exact = parse_number(digits).unwrap();
        let unit = Rational::dyadic(&Integer::ONE, scale);
        let difference = (Rational::from(value) * &unit - exact).abs();
        assert!(difference <= Rational::from(error) * unit + parse_number("1e-38").unwrap(), "{digits}");
    }

    #[test]
    fn turns_have_the_digits_of_the_literature() {
        for (x, cos, minus_sin) in [
            ("1", "0.54030230586813971740093660744297660373", "-0.84147098480789650665250232163029899962"),
            ("-3", "-0.98999249660044545727157279473126130239", "0.14112000805986722210074480280811027985"),
            ("100", "0.86231887228768393410193851395084253551", "0.50636564110975879365655761045978543207"),
            ("22/7", "-0.99999920053355290326833573965657495158", "0.0012644889303773534003603504756459324918"),
            ("123456789.125", "0.015723036122574079691746843753231923853", "-0.99987638542726281882690012204927508878"),
        ] {
            for scale in [20, 40, 90, 120] {
                let (whole, part) = x.split_once('/').unwrap_or((x, "1"));
                let x = parse_number(whole).unwrap() / parse_number(part).unwrap();
                let turn = turned(&x, scale);
                agrees(&turn.re, &turn.error, scale, cos);
                agrees(&turn.im, &turn.error, scale, minus_sin);
                assert!(turn.error < Integer::from(8), "{:?}", turn.error);
            }
        }
    }

    #[test]
    fn products_of_turns_are_turns_of_sums() {
        let scale = 100;
        for (a, b) in [(1i64, 2i64), (-7, 3), (40, 41)] {
            let product = turned(&a.into(), scale).times(&turned(&b.into(), scale), scale);
            let sum = turned(&(a + b).into(), scale);
            let bound = &product.error + &sum.error;
            assert!((&product.re - &sum.re).abs() <= bound && (&product.im - &sum.im).abs() <= bound);
        }
    }
}
