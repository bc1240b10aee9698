//! Shortest decimals, digits that are kept, and half units.

use super::{Number, Unread};
use jurist_algebra::number::{Rational, parse_number};

fn double(value: f64) -> Number {
    Number::double(value.to_bits()).unwrap()
}

#[test]
fn binary_numbers_are_written_by_their_shortest_decimal() {
    let cases = [
        (0.1, "0.1"),
        (-2.5, "-2.5"),
        (1.0 / 3.0, "0.3333333333333333"),
        (46e-3, "0.046"),
        (1e-7, "1e-7"),
        (-1.25e-7, "-1.25e-7"),
        (1e16, "1e16"),
        (123_456_789.0, "123456789"),
        (6.02e23, "6.02e23"),
        (5e-324, "5e-324"),
        (f64::MAX, "1.7976931348623157e308"),
        (-0.0, "0"),
        (100.0, "100"),
    ];
    for (value, text) in cases {
        assert_eq!(double(value).to_string(), text);
        assert_eq!(text.parse::<f64>().unwrap(), value);
    }
    assert_eq!(Number::single(0.1f32.to_bits()).unwrap().to_string(), "0.1");
    assert_eq!(Number::single(1e10f32.to_bits()).unwrap().to_string(), "10000000000");
    assert!([f64::NAN, f64::INFINITY].iter().all(|value| Number::double(value.to_bits()).is_none()));
    assert!(Number::single(f32::NEG_INFINITY.to_bits()).is_none());
    assert_eq!(Number::integer(i128::from(u64::MAX)).to_string(), "1.8446744073709551615e19");
}

#[test]
fn decimals_keep_their_digits() {
    let cases = [
        ("1.50", "1.50"),
        ("+.5", "0.5"),
        ("5.", "5"),
        ("-0.000", "0"),
        ("1.000000000000000000e+00", "1"),
        ("1.000000000000000056e-01", "0.1000000000000000056"),
        ("12.5E-3", "0.0125"),
        ("1d3", "1000"),
        ("007", "7"),
        ("123456789012345678901234567890", "1.23456789012345678901234567890e29"),
        ("0.00001", "0.00001"),
        ("0.0000012", "1.2e-6"),
    ];
    for (text, expected) in cases {
        assert_eq!(Number::decimal(text).unwrap().to_string(), expected);
        let number = parse_number(&text.replace('d', "e")).unwrap();
        assert_eq!(parse_number(expected).unwrap(), number, "{text}");
    }
    for text in ["", ".", "-", "1e", "1e+", "1,5", "0x1", "1 2", "1e3e3", "--1", "1+2i"] {
        assert_eq!(Number::decimal(text), Err(Unread::NotANumber), "{text}");
    }
    assert_eq!(Number::decimal("-Inf"), Err(Unread::NotFinite));
    for text in ["1e999999999999999999999", "1e1001", "1e-9223372036854775808"] {
        assert_eq!(Number::decimal(text), Err(Unread::TooLong), "{text}");
    }
}

#[test]
fn half_units_of_decimals_are_exact() {
    let cases = [("1.5", "0.05"), ("1.50", "0.005"), ("-0.1", "0.05"), ("2e3", "500"), ("1.2e-9", "5e-11")];
    for (text, half) in cases {
        assert_eq!(Number::decimal(text).unwrap().half_unit().as_deref(), Some(half), "{text}");
    }
    for text in ["2", "2.0", "0", "-17", "0.00"] {
        assert_eq!(Number::decimal(text).unwrap().half_unit(), None, "{text}");
    }
}

/// The neighbours' midpoints are the ends of what is rounded to a number.
#[test]
fn half_units_of_binary_numbers_reach_all_that_is_rounded_to_them() {
    let exact = |value: f64| Rational::from_f64(value).unwrap();
    for value in [0.1, -1.0 / 3.0, 1e-7, 5e-324, 2.5, 1e16, 1e300, 0.046, 1.0 + f64::EPSILON] {
        let number = double(value);
        let (shown, half) = (parse_number(&number.to_string()).unwrap(), number.half_unit().unwrap());
        let half = parse_number(&half).unwrap();
        let ends = [exact(value).midpoint(&exact(value.next_up())), exact(value).midpoint(&exact(value.next_down()))];
        assert!(ends.iter().all(|end| (end - &shown).abs() <= half), "{value}");
        let unit = exact(value.abs().next_up()) - exact(value.abs());
        assert!(half <= unit * Rational::from(2), "{value}");
    }
    assert!([0.0, 1.0, -3.0, 9_007_199_254_740_991.0].iter().all(|value| double(*value).half_unit().is_none()));
    assert!(Number::single(3.0f32.to_bits()).unwrap().half_unit().is_none());
    assert_eq!(Number::single(0.1f32.to_bits()).unwrap().half_unit().as_deref(), Some("5.27e-9"));
}
