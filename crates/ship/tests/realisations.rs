//! Realisations are what they realise: read as linear systems, written as blocks, run in exact arithmetic.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational, parse_number};
use jurist_ship::format::{Fixed, Rounding};
use jurist_ship::program::Operand;
use jurist_ship::realise::{Realisation, Realised, delta, direct, parallel, sections, state};
use jurist_ship::run::{FixedProgram, Overflow};
use proptest::prelude::*;

fn exactly(values: &[Rational]) -> Vec<Enclosure> {
    values.iter().cloned().map(Enclosure::from_rational).collect()
}

fn numbers(texts: &[&str]) -> Vec<Rational> {
    texts.iter().map(|text| parse_number(text).unwrap()).collect()
}

/// The first samples of the impulse response of a fraction, highest power first.
fn impulse_response(numerator: &[Rational], denominator: &[Rational], samples: usize) -> Vec<Rational> {
    let mut out: Vec<Rational> = Vec::new();
    for k in 0..samples {
        let mut value = numerator.get(k).cloned().unwrap_or(Rational::ZERO);
        for (i, a) in denominator.iter().enumerate().skip(1).filter(|(i, _)| *i <= k) {
            value -= a * &out[k - i];
        }
        out.push(value);
    }
    out
}

/// That of a program with exact coefficients, by its linear system.
fn response_of(realised: &Realised, samples: usize) -> Vec<Rational> {
    let values: Vec<Rational> =
        realised.program.coefficients.iter().map(|c| c.exact.lower().midpoint(c.exact.upper())).collect();
    let system = realised.program.system(&values);
    let Operand::Node(node) = realised.program.outputs[0] else { panic!("the output is a node") };
    let dot = |row: &[Rational], x: &[Rational]| row.iter().zip(x).fold(Rational::ZERO, |sum, (a, b)| sum + a * b);
    let mut x = vec![Rational::ZERO; system.a.len()];
    let mut out = Vec::new();
    for k in 0..samples {
        let u = if k == 0 { Rational::ONE } else { Rational::ZERO };
        out.push(dot(&system.c[node], &x) + &system.d[node][0] * &u);
        x = system.a.iter().zip(&system.b).map(|(a, b)| dot(a, &x) + &b[0] * &u).collect();
    }
    out
}

fn all(numerator: &[Rational], denominator: &[Rational]) -> Vec<Realised> {
    let (b, a) = (exactly(numerator), exactly(denominator));
    let mut out: Vec<Realised> =
        [Realisation::Df1, Realisation::Df2, Realisation::Df2t].into_iter().map(|r| direct(r, &b, &a)).collect();
    out.push(delta(&b, &a, 3));
    out.push(sections(&b, &a, &Budget::unlimited()).unwrap().expect("roots of numbers are told apart"));
    out.extend(parallel(&b, &a, &Budget::unlimited()).unwrap());
    out
}

#[test]
fn singular_controllers_have_their_response() {
    let cases: [(&[&str], &[&str]); 9] = [
        (&["2"], &["1"]),
        (&["0"], &["1"]),
        (&["0", "1"], &["1", "0"]),
        (&["1", "-1"], &["1", "-1"]),
        (&["0", "0", "0"], &["1", "-2", "1"]),
        (&["1", "0", "0"], &["1", "0", "0"]),
        (&["3", "-6", "3"], &["1", "2", "1"]),
        (&["0", "0", "1", "-1/5"], &["1", "-3/2", "6/5", "-7/20"]),
        (&["1/3", "-2/3", "1/3", "0", "0"], &["1", "-4", "6", "-4", "1"]),
    ];
    for (numerator, denominator) in cases {
        let (b, a) = (numbers(numerator), numbers(denominator));
        for realised in all(&b, &a) {
            let expected = impulse_response(&b, &a, 12);
            assert_eq!(
                response_of(&realised, 12),
                expected,
                "{numerator:?}/{denominator:?} {:?}",
                realised.realisation
            );
        }
    }
}

#[test]
fn state_space_has_its_response() {
    let rows = |texts: &[&[&str]]| -> Vec<Vec<Enclosure>> { texts.iter().map(|row| exactly(&numbers(row))).collect() };
    let (a, b) = (rows(&[&["0", "1"], &["-7/10", "3/2"]]), rows(&[&["0"], &["1"]]));
    let (c, d) = (rows(&[&["2", "1/3"]]), rows(&[&["5"]]));
    let expected = impulse_response(&numbers(&["5", "-43/6", "11/2"]), &numbers(&["1", "-3/2", "7/10"]), 12);
    assert_eq!(response_of(&state(&a, &b, &c, &d), 12), expected);
}

#[test]
fn equal_poles_have_no_partial_fractions() {
    let of =
        |b: &[&str], a: &[&str]| parallel(&exactly(&numbers(b)), &exactly(&numbers(a)), &Budget::unlimited()).unwrap();
    assert!(of(&["1", "0", "0"], &["1", "-2", "1"]).is_some(), "two poles in one section need no fractions");
    assert!(of(&["0", "0", "0", "1"], &["1", "-3", "3", "-1"]).is_none());
    assert_eq!(of(&["2"], &["1"]).unwrap().program.coefficients.len(), 1);
}

#[test]
fn sections_of_irrational_roots_are_near() {
    let (b, a) = (numbers(&["1", "0", "0", "0"]), numbers(&["1", "-1", "1/7", "-1/50"]));
    let budget = Budget::unlimited();
    let tiny = parse_number("1e-60").unwrap();
    for realised in [sections(&exactly(&b), &exactly(&a), &budget), parallel(&exactly(&b), &exactly(&a), &budget)] {
        let realised = realised.unwrap().unwrap();
        for (found, expected) in response_of(&realised, 20).iter().zip(impulse_response(&b, &a, 20)) {
            assert!((found - &expected).abs() < tiny, "{found} {expected}");
        }
    }
}

fn small() -> impl Strategy<Value = Rational> {
    (-40i64..40, 1i64..9).prop_map(|(n, d)| Rational::new(n.into(), d.into()))
}

fn fraction() -> impl Strategy<Value = (Vec<Rational>, Vec<Rational>)> {
    (0usize..5).prop_flat_map(|n| {
        let monic = proptest::collection::vec(small(), n)
            .prop_map(|rest| std::iter::once(Rational::ONE).chain(rest).collect::<Vec<_>>());
        (proptest::collection::vec(small(), n + 1), monic)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_realisation_has_the_response_of_its_fraction((b, a) in fraction()) {
        let expected = impulse_response(&b, &a, 9);
        let tiny = parse_number("1e-50").unwrap();
        for realised in all(&b, &a) {
            for (found, expected) in response_of(&realised, 9).iter().zip(&expected) {
                prop_assert!((found - expected).abs() < tiny, "{:?}: {found} {expected}", realised.realisation);
            }
        }
    }

    /// A run in fixed point leaves the linear system by no more than its roundings can move it: for coefficients that are stored exactly each
    /// node is the sum of its terms within one unit.
    #[test]
    fn each_node_is_its_sum_within_its_rounding(
        (b, a) in fraction(),
        inputs in proptest::collection::vec(-300i64..300, 6),
        mode in 0usize..6,
    ) {
        let coefficient = Fixed { bits: 24, fraction: 6, scale: 0, rounding: Rounding::Nearest };
        let signal = Fixed { bits: 48, fraction: 5, scale: 0, rounding: Rounding::ALL[mode] };
        for realised in all(&b, &a) {
            let program = &realised.program;
            let stored: Vec<Integer> = program.coefficients.iter().map(|c| coefficient.rounded(c.exact.lower())).collect();
            let values: Vec<Rational> = stored.iter().map(|k| coefficient.value(k)).collect();
            let fixed = FixedProgram::new(program, stored, &coefficient, signal, Overflow::Saturate);
            let system = program.system(&values);
            let mut states = fixed.at_rest();
            for input in &inputs {
                let before: Vec<Rational> = states.iter().map(|k| signal.value(k)).collect();
                let outputs = fixed.step(&mut states, &[(*input).into()]);
                // The first node has no other node in its terms, so it is row C x + D u within one unit.
                let linear = system.c[0].iter().zip(&before).fold(
                    &system.d[0][0] * &signal.value(&(*input).into()), |sum, (c, x)| sum + c * x);
                if program.outputs[0] == jurist_ship::program::Operand::Node(0) {
                    let error = (signal.value(&outputs[0]) - linear).abs();
                    prop_assert!(error <= signal.unit(), "{:?}", realised.realisation);
                }
            }
        }
    }
}
