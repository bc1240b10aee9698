//! Numbers and units as engineers write them: `10 kHz`, `4.7 µH`, `2.5·10⁻⁷`.

/// Prefixes by the power of 1000, from pico to giga.
const PREFIXES: [(i32, &str); 7] = [(-4, "p"), (-3, "n"), (-2, "µ"), (-1, "m"), (1, "k"), (2, "M"), (3, "G")];

/// The units that are written with prefixes.
const PREFIXED: [&str; 14] = ["s", "Hz", "V", "A", "H", "F", "Ω", "W", "J", "N", "Pa", "C", "VA", "rad/s"];

/// A unit as it is printed: `kg m²`, `Ω`, `N·m`.
pub fn unit_text(unit: &str) -> String {
    let mut out = String::new();
    let mut rest = unit.trim();
    if ["ohm", "Ohm", "Ohms", "ohms"].contains(&rest) {
        return "Ω".into();
    }
    while let Some(at) = rest.find(['^', '*']) {
        let (before, mark) = rest.split_at(at);
        out.push_str(before);
        rest = &mark[1..];
        if mark.starts_with('*') && !rest.starts_with('*') {
            out.push('·');
            continue;
        }
        rest = rest.trim_start_matches('*');
        let length = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == '-').len();
        out.push_str(&raised(&rest[..length]));
        rest = &rest[length..];
    }
    out + rest
}

/// Digits and minus signs as superscripts.
fn raised(digits: &str) -> String {
    let raise = |c: char| match c.to_digit(10) {
        Some(d) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][d as usize],
        None => '⁻',
    };
    digits.chars().map(raise).collect()
}

/// Whether a unit is written with prefixes.
pub(super) fn takes_prefix(unit: &str) -> bool {
    PREFIXED.contains(&unit)
}

/// The power of 1000 for quantities up to this magnitude, 0 for units without prefixes.
///
/// Frequencies have none below 1: millihertz are read by nobody.
pub(super) fn thousands(magnitude: f64, unit: &str) -> i32 {
    if !takes_prefix(unit) || magnitude <= 0.0 || !magnitude.is_finite() {
        return 0;
    }
    let low = if ["Hz", "rad/s"].contains(&unit) { 0 } else { -4 };
    match magnitude {
        _ if (0.1..1e4).contains(&magnitude) => 0,
        _ => ((magnitude.log10() + 1e-9) / 3.0).floor().clamp(f64::from(low), 3.0) as i32,
    }
}

/// The prefix of a power of 1000, empty for 0.
pub(super) fn prefix(thousands: i32) -> &'static str {
    PREFIXES.iter().find(|p| p.0 == thousands).map_or("", |p| p.1)
}

/// A decimal such as `0.0381` or `1.25e-7` with its unit: `38.1 mV`, `−1.25·10⁻⁷ N·m`.
///
/// No digit is changed: the point moves.
///
/// ```
/// use jurist_draw::figures::quantity;
/// assert_eq!(quantity("0.038101", "V"), "38.101 mV");
/// assert_eq!(quantity("-12000", "Hz"), "−12 kHz");
/// assert_eq!(quantity("1664", "Hz"), "1664 Hz");
/// assert_eq!(quantity("2.5e-7", ""), "2.5·10⁻⁷");
/// assert_eq!(quantity("550.94", "A/V"), "550.94 A/V");
/// ```
pub fn quantity(decimal: &str, unit: &str) -> String {
    let unit = unit_text(unit);
    let after = |number: String, prefix: &str| match unit.as_str() {
        "" => number,
        unit => format!("{number} {prefix}{unit}"),
    };
    let Ok(value) = decimal.parse::<f64>() else { return after(decimal.to_owned(), "") };
    let group = thousands(value.abs(), &unit);
    let magnitude = value.abs();
    if group == 0 && magnitude != 0.0 && !(1e-3..1e6).contains(&magnitude) {
        // That of the shortest decimal, which no logarithm rounds.
        let exponent = format!("{magnitude:e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
        let Some(mantissa) = shifted(decimal, -exponent) else { return after(decimal.to_owned(), "") };
        let power = format!("10{}", raised(&exponent.to_string()));
        return after(if mantissa == "1" { power } else { format!("{mantissa}·{power}") }, "");
    }
    match shifted(decimal, -3 * group) {
        Some(number) => after(number, prefix(group)),
        None => after(decimal.to_owned(), ""),
    }
}

/// The decimal times a power of ten, written without one; `None` for what is no decimal.
fn shifted(decimal: &str, places: i32) -> Option<String> {
    let (sign, bare) = decimal.strip_prefix('-').map_or(("", decimal), |b| ("\u{2212}", b));
    let (mantissa, exponent) = bare.split_once(['e', 'E']).unwrap_or((bare, "0"));
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{part}");
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let point = whole.len() as i32 + exponent.parse::<i32>().ok()? + places;
    if !(-30..=60).contains(&point) {
        return None;
    }
    let number = match point {
        ..=0 => format!("0.{}{digits}", "0".repeat(point.unsigned_abs() as usize)),
        _ if point as usize >= digits.len() => digits.clone() + &"0".repeat(point as usize - digits.len()),
        _ => format!("{}.{}", &digits[..point as usize], &digits[point as usize..]),
    };
    let number = number.trim_start_matches('0');
    let number = if number.starts_with('.') || number.is_empty() { format!("0{number}") } else { number.to_owned() };
    let number = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { &number };
    Some(format!("{sign}{number}"))
}

/// `5e33` as people write it: 5·10³³, with at most so many decimals.
pub(super) fn power_of_ten(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    let mantissa = mantissa.replace('-', "\u{2212}");
    let exponent = raised(exponent);
    match mantissa.as_str() {
        "1" => format!("10{exponent}"),
        "\u{2212}1" => format!("\u{2212}10{exponent}"),
        _ => format!("{mantissa}·10{exponent}"),
    }
}

/// A frequency with three digits or four: `506 mHz` is `0.506 Hz`, `12 kHz`, `1664 Hz`.
pub(super) fn frequency_text(value: f64, unit: &str) -> String {
    use jurist_algebra::number::{parse_number, to_decimal};
    let digits = if (1000.0..1e4).contains(&value) { 4 } else { 3 };
    let decimal = parse_number(&format!("{value:e}")).map(|v| to_decimal(&v, digits));
    quantity(&decimal.unwrap_or_default(), unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_written_as_engineers_write_them() {
        let cases = [
            ("4.7e-6", "H", "4.7 µH"),
            ("0.000047", "F", "47 µF"),
            ("100", "ohm", "100 Ω"),
            ("0.506", "Hz", "0.506 Hz"),
            ("1e-5", "Hz", "10⁻⁵ Hz"),
            ("20947", "rad/s", "20.947 krad/s"),
            ("0.0000023688", "kg m^2", "2.3688·10⁻⁶ kg m²"),
            ("2.7567e-7", "", "2.7567·10⁻⁷"),
            ("0", "V", "0 V"),
            ("-0.5", "", "\u{2212}0.5"),
            ("1000000", "", "10⁶"),
            ("1/3", "V", "1/3 V"),
        ];
        for (decimal, unit, text) in cases {
            assert_eq!(quantity(decimal, unit), text);
        }
        assert_eq!(unit_text("N*m*s/rad"), "N·m·s/rad");
        assert_eq!(unit_text("m/s**2"), "m/s²");
        assert_eq!(power_of_ten(5e33, 2), "5·10³³");
        assert_eq!(power_of_ten(-1e-4, 2), "\u{2212}10⁻⁴");
        assert_eq!(power_of_ten(2.5e6, 2), "2.5·10⁶");
        assert_eq!([frequency_text(1664.2, "Hz"), frequency_text(12_000.0, "Hz")], ["1664 Hz", "12 kHz"]);
    }

    proptest! {
        #[test]
        fn a_quantity_is_the_number_again(digits in 1i64..99_999, exponent in -20i32..20, negative: bool) {
            let decimal = format!("{}{digits}e{exponent}", if negative { "-" } else { "" });
            let text = quantity(&decimal, "V");
            let (number, unit) = text.split_once(' ').unwrap();
            let thousands = PREFIXES.iter().find(|p| format!("{}V", p.1) == unit).map_or(0, |p| p.0);
            let (mantissa, power) = number.split_once("·10").or(number.strip_prefix("10").map(|p| ("1", p)))
                .filter(|(_, p)| p.chars().all(|c| raised("0123456789-").contains(c)) && !p.is_empty())
                .unwrap_or((number, "⁰"));
            let plain: String = power.chars().map(|c| match raised("0123456789").chars().position(|r| r == c) {
                Some(d) => char::from(b'0' + d as u8),
                None => '-',
            }).collect();
            let mantissa: f64 = mantissa.replace('\u{2212}', "-").parse().unwrap();
            let value = mantissa * 10f64.powi(plain.parse::<i32>().unwrap() + 3 * thousands);
            let expected: f64 = decimal.parse().unwrap();
            prop_assert!((value / expected - 1.0).abs() < 1e-9, "{} {}", decimal, text);
        }
    }
}
