//! Numbers of floating point as texts that compilers read back exactly.

use crate::format::power_of_two;
use jurist_algebra::number::{
    BinaryFormat, Enclosure, Integer, Rational, enclosed_decimal, parse_number, to_decimal, to_scientific,
};

/// A number of a format in powers of two: `magnitude = mantissa * 2^exponent`, where the mantissa is odd or zero.
fn binary(value: &Rational) -> (Integer, i64) {
    let up = value.numerator().abs();
    let zeros = up.trailing_zeros().unwrap_or(0);
    (up >> zeros, zeros as i64 - (value.denominator().bit_length() as i64 - 1))
}

/// The number in hexadecimal, as C writes it: `0x1.8p-3`.
///
/// Cost: linear in the digits.
pub(super) fn hexadecimal(value: &Rational) -> String {
    let sign = if value.is_negative() { "-" } else { "" };
    let (mantissa, exponent) = binary(value);
    if mantissa.is_zero() {
        return "0x0p+0".into();
    }
    let behind = mantissa.bit_length() - 1;
    let digits = behind.div_ceil(4);
    // As many bits behind the point as whole digits have; the bit before it is dropped.
    let fraction = (mantissa << (4 * digits - behind)) - (Integer::ONE << (4 * digits));
    let fraction = fraction.to_i64().expect("at most 52 bits are behind the point");
    let point = if digits == 0 { String::new() } else { format!(".{fraction:0width$x}", width = digits as usize) };
    format!("{sign}0x1{point}p{:+}", exponent + behind as i64)
}

/// The bits of a number of the format.
///
/// Cost: linear in the digits.
pub(super) fn bits(format: BinaryFormat, value: &Rational) -> u64 {
    let (precision, least, width) = match format {
        BinaryFormat::Single => (24i64, -149i64, 32),
        BinaryFormat::Double => (53, -1074, 64),
    };
    let sign = u64::from(value.is_negative()) << (width - 1);
    let (mantissa, exponent) = binary(value);
    if mantissa.is_zero() {
        return 0;
    }
    let top = exponent + mantissa.bit_length() as i64 - 1;
    // The last place of numbers of this size; normal numbers have a bit before their fraction that is not stored.
    let last = (top - (precision - 1)).max(least);
    let places = mantissa << (exponent - last).unsigned_abs();
    let places = places.to_i64().expect("at most 53 bits").unsigned_abs();
    let hidden = 1u64 << (precision - 1);
    let biased = if places >= hidden { (last - least + 1).unsigned_abs() } else { 0 };
    sign | biased << (precision - 1) | (places & (hidden - 1))
}

/// The shortest decimal that is rounded to the number: `1.0E-1`.
///
/// Cost: a conversion for each digit.
pub(super) fn decimal(format: BinaryFormat, value: &Rational) -> String {
    let reads_back = |text: &String| parse_number(text).is_ok_and(|read| format.nearest(&read).as_ref() == Some(value));
    let text =
        (1..=17).map(|digits| to_scientific(value, digits)).find(reads_back).expect("17 digits tell numbers apart");
    let (mantissa, exponent) = text.split_once('e').expect("scientific notation has an exponent");
    let point = if mantissa.contains('.') { "" } else { ".0" };
    let exponent = if exponent == "0" { String::new() } else { format!("E{exponent}") };
    format!("{mantissa}{point}{exponent}")
}

/// A number before it is rounded, for people.
///
/// Cost: a conversion to 20 digits, or some where an enclosure is wide.
pub(super) fn exact(value: &Enclosure) -> String {
    let (low, high) = (value.lower(), value.upper());
    if low == high {
        let text = to_decimal(low, 20);
        let fraction = low.to_string();
        return match parse_number(&text) {
            Ok(read) if read == *low => text,
            _ if fraction.len() <= 40 => fraction,
            _ => format!("{text}.. (rounded)"),
        };
    }
    let known = (1..=20).rev().find_map(|digits| enclosed_decimal(low, high, digits));
    known.map_or_else(
        || format!("between {} and {}", to_decimal(low, 3), to_decimal(high, 3)),
        |text| format!("{text}.. (rounded)"),
    )
}

/// A power of two for people: `2^-10`, or the number where it is short.
pub(super) fn power(exponent: i64) -> String {
    if (0..=20).contains(&exponent) { power_of_two(exponent).to_string() } else { format!("2^{exponent}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(value: f64, format: BinaryFormat, expected: u64) {
        let exact = Rational::from_f64(value).unwrap();
        assert_eq!(bits(format, &exact), expected, "{value:e}");
        let read = parse_number(&decimal(format, &exact)).unwrap();
        assert_eq!(format.nearest(&read), Some(exact.clone()), "{value:e}");
        assert_eq!(of_hexadecimal(&hexadecimal(&exact)), exact, "{value:e}");
    }

    /// Reads `-0x1.8p-3`.
    fn of_hexadecimal(text: &str) -> Rational {
        let (is_negative, text) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
        let (digits, exponent) = text.strip_prefix("0x").unwrap().split_once('p').unwrap();
        let (before, behind) = digits.split_once('.').unwrap_or((digits, ""));
        let whole = i64::from_str_radix(&format!("{before}{behind}"), 16).unwrap();
        let exponent: i64 = exponent.parse().unwrap();
        let size = Rational::from(whole) * power_of_two(exponent - 4 * behind.len() as i64);
        if is_negative { -size } else { size }
    }

    #[test]
    fn numbers_at_the_ends_of_formats_are_read_back() {
        for value in [0.0f32, 1.0, -1.0, 0.1, 1e-45, 1.1754942e-38, 1.1754944e-38, f32::MAX, f32::MIN, 1.5, 16777215.0]
        {
            check(f64::from(value), BinaryFormat::Single, u64::from(value.to_bits()));
        }
        for value in [0.0f64, 0.1, -0.1, 5e-324, f64::MIN_POSITIVE, f64::MAX, 2.225073858507201e-308, 1e22] {
            check(value, BinaryFormat::Double, value.to_bits());
        }
        assert_eq!(hexadecimal(&parse_number("0.1875").unwrap()), "0x1.8p-3");
        assert_eq!(decimal(BinaryFormat::Single, &parse_number("0.1875").unwrap()), "1.875E-1");
    }

    #[test]
    fn people_are_told_what_is_exact() {
        let told = |text: &str| exact(&Enclosure::from_rational(parse_number(text).unwrap()));
        assert_eq!(told("0.4999"), "0.4999");
        assert_eq!(told("1/3"), "1/3");
        let between =
            |low: &str, high: &str| exact(&Enclosure::new(parse_number(low).unwrap(), parse_number(high).unwrap()));
        assert_eq!(between("0.33333", "0.33334"), "0.3333.. (rounded)");
        assert_eq!(between("-1", "1"), "between -1 and 1");
    }

    proptest! {
        #[test]
        fn every_number_is_read_back(single in any::<u32>(), double in any::<u64>()) {
            let (single, double) = (f32::from_bits(single), f64::from_bits(double));
            if single.is_finite() && single.to_bits() != 1 << 31 {
                check(f64::from(single), BinaryFormat::Single, u64::from(single.to_bits()));
            }
            if double.is_finite() && double.to_bits() != 1 << 63 {
                check(double, BinaryFormat::Double, double.to_bits());
            }
        }
    }
}
