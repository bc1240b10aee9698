//! The delta operator.

use super::Realisation;
use super::direct::two_transposed;
use super::structure::{Form, Realised, Slots, Structure};
use crate::format::power_of_two;
use crate::program::Program;
use jurist_algebra::number::{Enclosure, Rational};

/// Direct form 2 transposed in `d = (z - 1)/2^-step`, of a transfer function in z as [`direct`](super::direct()) takes it; `step` is at least 1.
///
/// Source: R. H. Middleton and G. C. Goodwin, "Digital Control and Estimation: A Unified Approach", Prentice Hall 1990.
///
/// Cost: quadratic in the order.
///
/// ```
/// use jurist_algebra::number::{Enclosure, parse_number};
/// use jurist_ship::realise::delta;
/// let exact = |texts: &[&str]| texts.iter().map(|t| Enclosure::from_rational(parse_number(t).unwrap())).collect::<Vec<_>>();
/// // 1/(z - 15/16) is 16/(d + 1) with d = 16 (z - 1)
/// let lag = delta(&exact(&["0", "1"]), &exact(&["1", "-15/16"]), 4);
/// assert_eq!(lag.program.coefficients.len(), 1);
/// assert_eq!(lag.program.coefficients[0].exact.lower(), &16.into());
/// ```
///
/// # Panics
/// When the lengths differ, or there is no coefficient.
pub fn delta(numerator: &[Enclosure], denominator: &[Enclosure], step: u32) -> Realised {
    assert!(!denominator.is_empty() && numerator.len() == denominator.len(), "a proper fraction");
    let mut slots = Slots::default();
    let mut row = |letter: &str, row: &[Enclosure]| {
        let row = in_delta(row, step);
        row.iter().enumerate().map(|(k, c)| slots.slot(format!("{letter}{k}"), c)).collect::<Vec<_>>()
    };
    let fraction = (row("b", numerator), row("a", denominator));
    let mut program = Program {
        inputs: 1,
        coefficients: slots.coefficients,
        states: Vec::new(),
        nodes: Vec::new(),
        updates: Vec::new(),
        outputs: Vec::new(),
    };
    program.outputs = vec![two_transposed(&fraction, &mut program, step as i32)];
    let structure = Structure(Form::Delta { fraction, delta: power_of_two(-i64::from(step)) });
    Realised { realisation: Realisation::Delta, program, structure }
}

/// `p(1 + delta d)/delta^n` for a polynomial of degree n, highest power first: its coefficients in d.
fn in_delta(p: &[Enclosure], step: u32) -> Vec<Enclosure> {
    // Taylor's shift by 1, of both ends: the weights are binomial coefficients, so the ends of sums are sums of ends.
    let shifted = |end: fn(&Enclosure) -> &Rational| -> Vec<Rational> {
        let mut c: Vec<Rational> = p.iter().map(|x| end(x).clone()).collect();
        let n = c.len();
        for last in (1..n).rev() {
            for k in 1..=last {
                c[k] = &c[k] + &c[k - 1].clone();
            }
        }
        c
    };
    let (low, high) = (shifted(Enclosure::lower), shifted(Enclosure::upper));
    let weight = |k: usize| power_of_two(i64::from(step) * k as i64);
    let ends = low.into_iter().zip(high).enumerate();
    ends.map(|(k, (low, high))| Enclosure::new(low * weight(k), high * weight(k))).collect()
}
