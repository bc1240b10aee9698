//! Ticks of linear and logarithmic axes.

use super::super::panel::{power_of_ten, tick_step};
use super::window::AxisWindow;

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Where, from 0 to 1.
    pub place: f64,
    /// What is written there; small ticks have nothing.
    pub label: Option<String>,
}

/// About `count` labelled ticks.
pub(super) fn ticks(window: &AxisWindow, count: f64) -> Vec<Tick> {
    let found = if window.logarithmic { logarithmic(window, count) } else { Vec::new() };
    let labelled = found.iter().filter(|t| t.label.is_some()).count();
    if labelled >= 2 { found } else { linear(window, count) }
}

fn linear(window: &AxisWindow, count: f64) -> Vec<Tick> {
    let (lo, hi) = window.ends();
    let step = tick_step((lo, hi), count);
    let decimals = (-step.log10() - 1e-9).ceil().max(0.0) as usize;
    let largest = lo.abs().max(hi.abs());
    let mut out = Vec::new();
    let mut k = (lo / step - 1e-9).ceil();
    while k * step <= hi + 1e-9 * step && out.len() < 50 {
        let value = k * step;
        let label = if k == 0.0 {
            "0".to_owned()
        } else if !(1e-3..1e6).contains(&largest) {
            power_of_ten(value)
        } else {
            format!("{value:.decimals$}").replace('-', "\u{2212}")
        };
        out.push(Tick { place: window.place(value).clamp(0.0, 1.0), label: Some(label) });
        k += 1.0;
    }
    out
}

fn logarithmic(window: &AxisWindow, count: f64) -> Vec<Tick> {
    let (lo, hi) = window.ends();
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let decades = f64::from(last - first);
    let every = (decades / count).ceil().max(1.0) as i32;
    let within = (hi / lo).log10();
    let mut out = Vec::new();
    for exponent in first..=last {
        for digit in 1..10 {
            let value = f64::from(digit) * 10f64.powi(exponent);
            let place = window.place(value);
            if !(-1e-9..=1.0 + 1e-9).contains(&place) {
                continue;
            }
            let named = match digit {
                1 => exponent.rem_euclid(every) == 0,
                2 | 5 => within < 1.6 * count / 4.0 && within < 2.0,
                _ => false,
            };
            if named || (within < 9.0 || digit == 1) {
                let label = named.then(|| decade_label(value, exponent));
                out.push(Tick { place: place.clamp(0.0, 1.0), label });
            }
        }
    }
    out
}

fn decade_label(value: f64, exponent: i32) -> String {
    match exponent {
        -3..=-1 => format!("{value:.*}", exponent.unsigned_abs() as usize),
        0..=4 => format!("{value:.0}"),
        _ => power_of_ten(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;

    fn labels(lower: &str, upper: &str, logarithmic: bool) -> Vec<String> {
        let window =
            AxisWindow { lower: parse_number(lower).unwrap(), upper: parse_number(upper).unwrap(), logarithmic };
        ticks(&window, 6.0).into_iter().filter_map(|t| t.label).collect()
    }

    #[test]
    fn labels_are_round_numbers() {
        assert_eq!(labels("0", "1", false), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels("-2", "2", false), ["\u{2212}2", "\u{2212}1", "0", "1", "2"]);
        assert_eq!(labels("1e-5", "0.1", true), ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1"]);
        assert_eq!(labels("3", "7", true).len(), 5);
        assert_eq!(labels("1e-30", "1e30", true).len(), 7);
    }
}
