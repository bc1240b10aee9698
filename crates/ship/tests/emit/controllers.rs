//! Controllers of all realisations with all kinds of numbers.

use crate::cases::{Case, Numbers};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{BinaryFormat, Enclosure, Integer, Rational, parse_number};
use jurist_ship::format::{Fixed, Rounding};
use jurist_ship::program::{Coefficient, Node, Operand, Program, Term};
use jurist_ship::realise::{Realisation, Realised, delta, direct, parallel, sections, state};
use jurist_ship::run::Overflow;

pub fn exactly(texts: &[&str]) -> Vec<Enclosure> {
    texts.iter().map(|text| Enclosure::from_rational(parse_number(text).unwrap())).collect()
}

/// A controller of order three, in each realisation; the matrices have two inputs and two outputs.
pub fn realisations() -> Vec<Realised> {
    let (b, a) = (exactly(&["0.7", "-1.1", "0.45", "0.2"]), exactly(&["1", "-1.6", "0.95", "-0.2"]));
    let rows = |rows: &[&[&str]]| rows.iter().map(|row| exactly(row)).collect::<Vec<_>>();
    let of = |realisation| match realisation {
        Realisation::Sos => sections(&b, &a, &Budget::unlimited()).unwrap().expect("roots are told apart"),
        Realisation::Parallel => parallel(&b, &a, &Budget::unlimited()).unwrap().expect("poles are apart"),
        Realisation::Delta => delta(&b, &a, 3),
        Realisation::State => state(
            &rows(&[&["0.9", "-0.3", "0"], &["0.3", "0.9", "1"], &["0", "0.125", "-0.4"]]),
            &rows(&[&["1", "0"], &["0", "0.55"], &["-1", "0.3"]]),
            &rows(&[&["1.5", "0", "-0.7"], &["0", "-1", "0.1"]]),
            &rows(&[&["0.25", "0"], &["0", "-0.3"]]),
        ),
        _ => direct(realisation, &b, &a),
    };
    Realisation::ALL.into_iter().map(of).collect()
}

pub fn fixed(bits: u32, fraction: i32, rounding: Rounding) -> Fixed {
    Fixed { bits, fraction, scale: 0, rounding }
}

pub fn in_fixed(name: String, realised: &Realised, coefficient: Fixed, signal: Fixed, overflow: Overflow) -> Case {
    let stored = realised.program.coefficients.iter().map(|c| coefficient.rounded(c.exact.lower())).collect();
    let numbers = Numbers::Fixed { stored, coefficient, signal, overflow };
    Case { name, realisation: realised.realisation, program: realised.program.clone(), numbers }
}

pub fn in_floats(name: String, realised: &Realised, format: BinaryFormat) -> Case {
    let nearest = |c: &Coefficient| format.nearest(c.exact.lower()).expect("in range");
    let stored = realised.program.coefficients.iter().map(nearest).collect();
    Case {
        name,
        realisation: realised.realisation,
        program: realised.program.clone(),
        numbers: Numbers::Float { stored, format },
    }
}

/// Every realisation with every mode of rounding and both kinds of overflow, of one mode after the other: pairs that differ in overflow only.
pub fn in_fixed_point() -> Vec<[Case; 2]> {
    let mut out = Vec::new();
    for (r, realised) in realisations().iter().enumerate() {
        for (m, mode) in Rounding::ALL.into_iter().enumerate() {
            // Widths of types, and others.
            let bits = [16, 12, 32, 8, 24, 40][(r + m) % 6];
            let coefficient = Fixed { scale: m as i32 - 2, ..fixed(20, 13, Rounding::Nearest) };
            let signal = Fixed { scale: r as i32 - 1, ..fixed(bits, bits as i32 / 2, mode) };
            out.push([Overflow::Saturate, Overflow::Wrap].map(|overflow| {
                let name = format!("{}_{}_{overflow:?}", realised.realisation.name(), mode.name());
                in_fixed(name, realised, coefficient, signal, overflow)
            }));
        }
    }
    out
}

pub fn in_floating_point() -> Vec<Case> {
    let of = |realised: &Realised| {
        [BinaryFormat::Single, BinaryFormat::Double]
            .map(|format| in_floats(format!("{}_{format:?}", realised.realisation.name()), realised, format))
    };
    realisations().iter().flat_map(of).collect()
}

fn term(is_negative: bool, coefficient: Option<usize>, operand: Operand) -> Term {
    Term { is_negative, shift: 0, coefficient, operand }
}

/// A program without names of its own: one node for each list of terms.
pub fn program(inputs: usize, states: usize, coefficients: usize, nodes: Vec<Vec<Term>>) -> Program {
    let one = Enclosure::from_rational(Rational::ONE);
    Program {
        inputs,
        coefficients: (0..coefficients).map(|k| Coefficient { name: format!("b{k}"), exact: one.clone() }).collect(),
        states: (1..=states).map(|k| format!("x_{k}")).collect(),
        nodes: nodes.into_iter().enumerate().map(|(k, terms)| Node { name: format!("n_{k}"), terms }).collect(),
        updates: (0..states).map(Operand::State).collect(),
        outputs: vec![],
    }
}

/// Cases that have broken something, or could.
pub fn singular() -> Vec<Case> {
    let mut out = Vec::new();
    let mut add = |program: Program, stored: Vec<Integer>, coefficient: Fixed, signal: Fixed, overflow: Overflow| {
        let numbers = Numbers::Fixed { stored, coefficient, signal, overflow };
        out.push(Case { name: format!("singular_{}", out.len()), realisation: Realisation::Df1, program, numbers });
    };
    for mode in Rounding::ALL {
        // Sums that take all of 64 bits: the coefficient has 33, signals 32, and 13 bits are rounded away.
        let mut wide = program(1, 0, 1, vec![vec![term(mode == Rounding::Ceil, Some(0), Operand::Input(0))]]);
        wide.outputs = vec![Operand::Node(0)];
        let greatest = (Integer::ONE << 32) - Integer::ONE;
        let stored = if mode == Rounding::Even { -greatest } else { greatest };
        add(wide, vec![stored], fixed(34, 13, mode), fixed(32, 0, mode), Overflow::Wrap);
    }
    for overflow in [Overflow::Saturate, Overflow::Wrap] {
        let plain = fixed(8, 0, Rounding::Even);
        // The least number of 63 bits has no opposite; a turn of 63 bits is no number of 64.
        let mut negative = program(1, 0, 0, vec![vec![term(true, None, Operand::Input(0))]]);
        negative.outputs = vec![Operand::Node(0)];
        add(negative.clone(), vec![], plain, fixed(63, 4, Rounding::Floor), overflow);
        // One bit: 0 and -1.
        add(negative, vec![], plain, fixed(1, 0, Rounding::Nearest), overflow);
        // States that turn in a circle and are outputs as they were; an output that is an input; a state that stays.
        let mut circle =
            program(2, 4, 0, vec![vec![term(false, None, Operand::Input(0)), term(false, None, Operand::State(2))]]);
        circle.updates = vec![Operand::State(1), Operand::State(2), Operand::State(0), Operand::State(3)];
        circle.outputs =
            vec![Operand::State(0), Operand::Input(1), Operand::Node(0), Operand::Node(0), Operand::State(3)];
        add(circle.clone(), vec![], plain, fixed(12, 4, Rounding::Floor), overflow);
        circle.updates = vec![Operand::State(1), Operand::Node(0), Operand::State(0), Operand::Input(1)];
        add(circle, vec![], plain, fixed(31, 4, Rounding::Floor), overflow);
        // No output, no state, no term; a coefficient that becomes zero before a shift that no number has.
        let mut nothing = program(1, 0, 1, vec![vec![], vec![term(false, Some(0), Operand::Input(0))]]);
        add(nothing.clone(), vec![0.into()], plain, fixed(16, 8, Rounding::Zero), overflow);
        nothing.nodes[1].terms[0].shift = 90;
        nothing.nodes[1].terms.push(term(true, None, Operand::Input(0)));
        nothing.outputs = vec![Operand::Node(1), Operand::Node(0)];
        add(nothing, vec![0.into()], plain, fixed(16, 8, Rounding::Zero), overflow);
        // The least integers of 32 and of 33 bits are stored.
        let both = [term(false, Some(0), Operand::Input(0)), term(true, Some(1), Operand::Input(0))];
        let mut least = program(1, 0, 2, vec![both.to_vec()]);
        least.outputs = vec![Operand::Node(0)];
        let stored = [31u64, 32].map(|bits| -(Integer::ONE << bits)).to_vec();
        add(least, stored, fixed(33, 20, Rounding::Zero), fixed(16, 8, Rounding::HalfUp), overflow);
    }
    out.push(misnamed());
    out
}

/// Names that are keywords, that differ in large letters only, that are those of other things.
fn misnamed() -> Case {
    let names = [
        "while",
        "u",
        "Y",
        "y",
        "fn",
        "fit",
        "π",
        "s",
        "",
        "singular_named_fit",
        "round4",
        "y_sum",
        "FIT",
        "*/",
        "_x__",
        "9",
    ];
    let mut program = program(1, 4, 4, vec![vec![]; 8]);
    let named = |k: usize, part: usize| names[(k * 3 + part) % names.len()].to_owned();
    for (k, node) in program.nodes.iter_mut().enumerate() {
        let before = if k == 0 { Operand::Input(0) } else { Operand::Node(k - 1) };
        node.terms = vec![term(k % 2 == 1, Some(k % 4), before), term(false, None, Operand::State(k % 4))];
        node.name = named(k, 0);
    }
    for k in 0..4 {
        program.states[k] = named(k, 1);
        program.updates[k] = Operand::Node(2 * k);
        program.coefficients[k].name = named(k, 2);
    }
    program.outputs = vec![Operand::Node(7)];
    let stored = [9, -7, 5, 12].map(Integer::from).to_vec();
    let numbers = Numbers::Fixed {
        stored,
        coefficient: fixed(8, 4, Rounding::Nearest),
        signal: fixed(12, 4, Rounding::Nearest),
        overflow: Overflow::Saturate,
    };
    Case { name: "singular named".into(), realisation: Realisation::State, program, numbers }
}
