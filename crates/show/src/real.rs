//! Real numbers and enclosures as correctly rounded decimals.

use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, to_decimal_refining};
use jurist_algebra::real::Real;
use jurist_engine::answer::Frequency;

/// A real number, refined as far as its decimal needs.
#[derive(Clone, Debug)]
pub struct Rounded {
    /// Correctly rounded, ties to even.
    pub decimal: String,
    /// The enclosure that proves it, of relative width at most `10^-(digits + 2)`.
    pub enclosure: (Rational, Rational),
}

/// The number to so many significant digits.
pub fn rounded(number: &Real, digits: usize) -> Rounded {
    let mut accuracy = digits;
    while number.algebraic().is_some() || accuracy < MOST_ACCURACY * (digits + 1) {
        let refined = number.refined_to_digits(accuracy);
        let (lo, hi) = refined.enclosure();
        // An irrational number is no tie, so that a narrow enclosure decides the last digit.
        if let Some(decimal) = enclosed_decimal(&lo, &hi, digits) {
            return Rounded { decimal, enclosure: (lo, hi) };
        }
        accuracy = accuracy + accuracy / 2 + 4;
    }
    // So near to a tie, either decimal is as good.
    let enclosure = number.refined_to_digits(digits).enclosure();
    Rounded { decimal: number.decimal(digits), enclosure }
}

/// How many times the digits asked for tell a number that is not algebraic from a tie.
const MOST_ACCURACY: usize = 64;

/// The decimal of a real number that is given by ever narrower enclosures.
pub fn enclosed(digits: usize, mut enclose: impl FnMut(u64) -> Option<Enclosure>) -> Option<String> {
    to_decimal_refining(digits, &mut enclose).or_else(|| {
        // A tie, or a number that has just these digits: any narrow enclosure shows them.
        let bits = 8 * digits as u64 + 64;
        enclose(bits).map(|e| jurist_algebra::number::to_decimal(&e.lower().midpoint(e.upper()), digits))
    })
}

/// The decimal of a number of which an enclosure is at hand; narrower ones are asked for only next to a tie.
pub fn enclosed_in(digits: usize, narrow: &Enclosure, enclose: impl FnMut(u64) -> Option<Enclosure>) -> Option<String> {
    enclosed_decimal(narrow.lower(), narrow.upper(), digits).or_else(|| enclosed(digits, enclose))
}

/// A frequency that is computed once for all that is shown of it.
pub struct ShownFrequency<F> {
    once: Frequency,
    at: F,
}

impl<F: Fn(u64) -> Option<Frequency>> ShownFrequency<F> {
    /// From enclosures as narrow as so many bits; `None` where there is no frequency.
    pub fn new(digits: usize, at: F) -> Option<Self> {
        Some(ShownFrequency { once: at(bits_for(digits))?, at })
    }

    /// The first enclosure.
    pub fn enclosed(&self) -> &Frequency {
        &self.once
    }

    /// The decimal of one of its parts.
    pub fn decimal(&self, places: usize, part: fn(&Frequency) -> Option<Enclosure>) -> Option<String> {
        enclosed_in(places, &part(&self.once)?, |bits| (self.at)(bits).as_ref().and_then(part))
    }

    /// `12.5 Hz` and `0.7853982 rad per sample`, the angle in words of the caller, the rate where there is no angle.
    pub fn words(&self, places: usize, angle_unit: &str) -> Vec<String> {
        let hertz = self.decimal(places, |f| f.hertz.clone()).map(|hertz| format!("{hertz} Hz"));
        let angle = self.decimal(places, |f| f.angle.clone()).map(|angle| format!("{angle} {angle_unit}"));
        let rate = || self.decimal(places, |f| f.radians_per_second.clone()).map(|rate| format!("{rate} rad/s"));
        hertz.into_iter().chain(angle.or_else(rate)).collect()
    }
}

/// A decimal as a JSON number; none for what is too large for one.
pub fn json_number(decimal: &str) -> Option<serde_json::Number> {
    serde_json::Number::from_f64(decimal.parse().ok()?)
}

/// Bits that make an enclosure about as narrow as so many digits and two more ask for.
pub fn bits_for(digits: usize) -> u64 {
    // log2(10) < 10/3
    (digits as u64 + 2) * 10 / 3 + 8
}

/// Digits beyond which a JSON number, read as binary floating point, gains nothing.
pub const JSON_NUMBER_DIGITS: usize = 17;

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::poly::{SquareFree, UniPoly, isolate_real_roots};

    #[test]
    fn decimals_of_algebraic_numbers() {
        let p = SquareFree::part_of(&UniPoly::from_i64(&[-2, 0, 1])).unwrap();
        let roots = isolate_real_roots(&p, &Budget::unlimited()).unwrap();
        assert_eq!(rounded(&roots[1].clone().into(), 40).decimal, "1.414213562373095048801688724209698078570");
        assert_eq!(rounded(&roots[0].clone().into(), 3).decimal, "-1.41");
        let (lo, hi) = rounded(&roots[1].clone().into(), 3).enclosure;
        assert!((&hi - &lo) * Rational::from(100_000) <= lo);
        assert_eq!(rounded(&Real::from(Rational::new(1.into(), 4.into())), 5).decimal, "0.25");
    }

    #[test]
    fn ties_have_a_decimal() {
        let eighth = Enclosure::from_rational(Rational::new(1.into(), 8.into()));
        let blurred = |bits| Some(eighth.add(&Enclosure::pi(bits), bits).sub(&Enclosure::pi(bits), bits));
        let text = enclosed(2, blurred).unwrap();
        assert!(text == "0.12" || text == "0.13", "{text}");
        assert_eq!(json_number(&text).unwrap().to_string(), text);
    }
}
