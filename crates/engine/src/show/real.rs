//! Real numbers and enclosures as correctly rounded decimals.

use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, to_decimal_refining};
use jurist_algebra::real::Real;

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
