//! Programs that are drawn at random.

use crate::cases::{Case, Numbers};
use crate::controllers::program;
use jurist_algebra::number::{BinaryFormat, Integer, Rational};
use jurist_ship::format::{Fixed, Rounding};
use jurist_ship::program::{Operand, Program, Term};
use jurist_ship::realise::Realisation;
use jurist_ship::run::Overflow;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// A number below `end` that keeps its meaning when `end` shrinks.
type Pick = prop::sample::Index;

/// A term before it is known what there is to read.
type Drawn = (bool, i32, Option<Pick>, Pick);

fn operand(pick: Pick, inputs: usize, states: usize, nodes: usize) -> Option<Operand> {
    let all =
        (0..inputs).map(Operand::Input).chain((0..states).map(Operand::State)).chain((0..nodes).map(Operand::Node));
    let all: Vec<Operand> = all.collect();
    (!all.is_empty()).then(|| *pick.get(&all))
}

fn drawn_program() -> impl Strategy<Value = Program> {
    let drawn_term = (any::<bool>(), -5i32..6, any::<Option<Pick>>(), any::<Pick>());
    let nodes = vec(vec(drawn_term, 0..4), 1..5);
    let sizes = (0usize..3, 0usize..5, 0usize..4);
    (sizes, nodes, vec(any::<Pick>(), 5), vec(any::<Pick>(), 0..4)).prop_map(|(sizes, lists, updates, outputs)| {
        let (inputs, states, coefficients) = sizes;
        let list = |(at, terms): (usize, Vec<Drawn>)| -> Vec<Term> {
            let drawn = |(is_negative, shift, coefficient, pick): Drawn| {
                let coefficient = coefficient.filter(|_| coefficients > 0).map(|pick| pick.index(coefficients));
                Some(Term { is_negative, shift, coefficient, operand: operand(pick, inputs, states, at)? })
            };
            terms.into_iter().filter_map(drawn).collect()
        };
        let lists: Vec<Vec<Term>> = lists.into_iter().enumerate().map(list).collect();
        let nodes = lists.len();
        let mut program = program(inputs, states, coefficients, lists);
        program.updates = updates[..states].iter().filter_map(|pick| operand(*pick, inputs, states, nodes)).collect();
        program.outputs = outputs.iter().filter_map(|pick| operand(*pick, inputs, states, nodes)).collect();
        program
    })
}

fn drawn_numbers() -> impl Strategy<Value = Numbers> {
    let signal =
        (select(vec![1u32, 2, 7, 8, 15, 16, 17, 31, 32, 33, 40, 55]), -3i32..20, select(Rounding::ALL.to_vec()));
    let coefficient = (2u32..24, -4i32..24, -3i32..4);
    let fixed =
        (signal, coefficient, vec(any::<i64>(), 3), any::<bool>()).prop_map(|(signal, coefficient, words, wraps)| {
            let (bits, fraction, rounding) = signal;
            let signal = Fixed { bits, fraction, scale: 0, rounding };
            let (bits, fraction, scale) = coefficient;
            let coefficient = Fixed { bits, fraction, scale, rounding };
            let stored = words.iter().map(|word| Integer::from(word >> (64 - bits))).collect();
            Numbers::Fixed {
                stored,
                coefficient,
                signal,
                overflow: if wraps { Overflow::Wrap } else { Overflow::Saturate },
            }
        });
    let float = (any::<bool>(), vec((-(1i64 << 52)..1 << 52, -60i64..2), 3)).prop_map(|(is_single, drawn)| {
        let format = if is_single { BinaryFormat::Single } else { BinaryFormat::Double };
        let value = |(mantissa, exponent): &(i64, i64)| {
            let exact = Rational::from(*mantissa) * jurist_ship::format::power_of_two(exponent - 52);
            format.nearest(&exact).expect("in range")
        };
        Numbers::Float { stored: drawn.iter().map(value).collect(), format }
    });
    prop_oneof![2 => fixed, 1 => float]
}

pub fn case() -> impl Strategy<Value = Case> {
    (drawn_program(), drawn_numbers()).prop_map(|(program, mut numbers)| {
        match &mut numbers {
            Numbers::Fixed { stored, .. } => stored.truncate(program.coefficients.len()),
            Numbers::Float { stored, .. } => stored.truncate(program.coefficients.len()),
        }
        Case { name: "drawn".into(), realisation: Realisation::State, program, numbers }
    })
}

/// So many cases whose sums fit into 64 bits.
pub fn several(count: usize) -> Vec<Case> {
    let mut runner = TestRunner::default();
    let mut next = || case().new_tree(&mut runner).expect("a case").current();
    let all = std::iter::repeat_with(&mut next);
    let fits = all.filter(|case| case.text(jurist_ship::emit::Target::C, &[]).is_ok());
    fits.take(count).enumerate().map(|(at, case)| Case { name: format!("drawn_{at}"), ..case }).collect()
}
