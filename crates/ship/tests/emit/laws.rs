//! Laws of what is written.

use crate::cases::{Case, Dice, Numbers, inputs};
use crate::compiled::runs;
use crate::controllers::{exactly, fixed, in_fixed, program};
use crate::{drawn, interpreter};
use jurist_algebra::number::Integer;
use jurist_ship::emit::{Target, TooWide};
use jurist_ship::format::Rounding;
use jurist_ship::program::{Operand, Term};
use jurist_ship::realise::{Realisation, direct};
use jurist_ship::run::Overflow;
use proptest::prelude::*;

/// A sum of `count` times the input.
fn gain(count: i64, bits: u32, overflow: Overflow) -> Case {
    let term = Term { is_negative: false, shift: 0, coefficient: Some(0), operand: Operand::Input(0) };
    let mut program = program(1, 0, 1, vec![vec![term]]);
    program.outputs = vec![Operand::Node(0)];
    let format = fixed(bits, 0, Rounding::Floor);
    let numbers = Numbers::Fixed {
        stored: vec![count.into()],
        coefficient: fixed(64, 0, Rounding::Floor),
        signal: format,
        overflow,
    };
    Case { name: "gain".into(), realisation: Realisation::Df1, program, numbers }
}

#[test]
#[ignore = "long: CI runs it"]
fn pairs_of_controllers_differ_by_what_overflows() {
    let pairs: Vec<_> = runs().chunks(2).take_while(|pair| pair[0].case.name.ends_with("Saturate")).collect();
    assert_eq!(pairs.len(), Realisation::ALL.len() * Rounding::ALL.len());
    for pair in pairs {
        assert_eq!(pair[0].inputs, pair[1].inputs);
        assert_ne!(pair[0].rows, pair[1].rows, "{}: nothing overflows", pair[0].case.name);
    }
}

#[test]
fn a_sum_of_64_bits_is_written_and_one_of_65_is_refused() {
    // Factor times 2^31, and one unit of rounding.
    let greatest = (1i64 << 32) - 1;
    assert!(gain(greatest, 32, Overflow::Wrap).text(Target::C, &[]).is_ok());
    let refused = gain(greatest + 1, 32, Overflow::Wrap).text(Target::C, &[]).unwrap_err();
    assert_eq!(refused, TooWide { node: Some("n_0".into()), bits: 65 });
    assert_eq!(refused.to_string(), "the sum `n_0` takes 65 bits, and code computes in 64");
    let refused = gain(1, 64, Overflow::Wrap).text(Target::Rust, &[]).unwrap_err();
    assert_eq!(refused, TooWide { node: None, bits: 64 });
    assert_eq!(refused.to_string(), "signals have 64 bits, and code has at most 63 for them");
    assert!(gain(1, 63, Overflow::Wrap).text(Target::StructuredText, &[]).is_ok());
}

#[test]
fn remarks_end_no_comment_and_begin_no_line() {
    let controller = direct(Realisation::Df1, &exactly(&["0.5"]), &exactly(&["1"]));
    let format = fixed(16, 8, Rounding::Nearest);
    let case = in_fixed("p".into(), &controller, format, format, Overflow::Saturate);
    let remarks = ["*/ int x; /*", "*) x := 1; (*", "(*)/*/", "a\nb\rc\u{2028}d\u{202e}e", "what??/"].map(String::from);
    for target in Target::ALL {
        let text = case.text(target, &remarks).unwrap();
        let plain = case.text(target, &["x".into(), "x".into(), "x".into(), "x".into(), "x".into()]).unwrap();
        assert_eq!(text.lines().count(), plain.lines().count());
        for end in ["*/", "/*", "*)", "(*"] {
            let is_of_target = match target {
                Target::C => end.contains('/'),
                Target::StructuredText => !end.contains('/'),
                Target::Rust => false,
            };
            assert!(!is_of_target || text.matches(end).count() == plain.matches(end).count(), "{text}");
        }
        assert!(
            !text.contains(['\r', '\u{2028}', '\u{202e}']) && (target != Target::C || !text.contains("??/")),
            "{text}"
        );
    }
}

#[test]
fn an_input_that_does_not_fit_is_treated_as_any_signal() {
    for (overflow, expected) in [(Overflow::Saturate, [127, -128]), (Overflow::Wrap, [-56, 56])] {
        let case = gain(1, 8, overflow);
        let rows = expected.map(|value: i64| vec![value.into()]);
        assert_eq!(interpreter::compare(&case, &[vec![200], vec![-200]], &rows), 2);
        // In C and Rust as well, whose types have 16 bits.
        assert!(case.text(Target::C, &[]).unwrap().contains("u_fitted = (int16_t)gain_fit((int64_t)u);"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn wrapping_is_what_casts_do(count in -(1i64 << 31)..1 << 31, input in any::<i16>(), wide in any::<i32>()) {
        let rows = |case: &Case, input: i64| case.run(&[vec![input]]);
        let case = gain(count, 16, Overflow::Wrap);
        let cast = (count * i64::from(input)) as i16;
        prop_assert_eq!(rows(&case, input.into()), vec![vec![i64::from(cast).into()]]);
        interpreter::compare(&case, &[vec![input.into()]], &rows(&case, input.into()));
        let case = gain(count, 32, Overflow::Wrap);
        let cast = count.wrapping_mul(wide.into()) as i32;
        prop_assert_eq!(rows(&case, wide.into()), vec![vec![i64::from(cast).into()]]);
        interpreter::compare(&case, &[vec![wide.into()]], &rows(&case, wide.into()));
    }

    #[test]
    fn structured_text_of_any_program_computes_what_the_exact_run_computes(case in drawn::case(), seed in any::<u64>()) {
        match case.text(Target::StructuredText, &[]) {
            Ok(_) => {
                let inputs = inputs(&case, 60, &mut Dice(seed));
                interpreter::compare(&case, &inputs, &case.run(&inputs));
            }
            Err(TooWide { node, .. }) => {
                let fixed = case.fixed().expect("floats are never too wide");
                let at = case.program.nodes.iter().position(|n| Some(&n.name) == node.as_ref()).expect("it is named");
                prop_assert!(fixed.greatest_sum(at) >= Integer::ONE << 63);
            }
        }
    }
}
