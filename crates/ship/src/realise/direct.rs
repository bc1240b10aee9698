//! Direct forms.

use super::Realisation;
use super::structure::{Form, Fraction, Realised, Slot, Slots, Structure};
use crate::program::{Node, Operand, Program, Term};
use jurist_algebra::number::Enclosure;

/// A direct form of a transfer function: numerator and denominator with the highest power first and equally many coefficients; the denominator
/// begins with 1.
///
/// Cost: linear in the order.
///
/// ```
/// use jurist_algebra::number::{Enclosure, parse_number};
/// use jurist_ship::realise::{Entry, Realisation, direct};
/// let exact = |texts: &[&str]| texts.iter().map(|t| Enclosure::from_rational(parse_number(t).unwrap())).collect::<Vec<_>>();
/// let pi = direct(Realisation::Df1, &exact(&["0.5", "-0.4999"]), &exact(&["1", "-1"]));
/// let names: Vec<&str> = pi.program.coefficients.iter().map(|c| c.name.as_str()).collect();
/// assert_eq!(names, ["b0", "b1"]); // 1 and -1 are not stored
/// let keys = pi.keys(&[Entry::Number(parse_number("1/2").unwrap()), Entry::Formula("b1".into())]);
/// assert_eq!(keys[0], ("num", "[\"1/2\", \"b1\"]".into()));
/// ```
///
/// # Panics
/// When the lengths differ, or there is no coefficient.
pub fn direct(realisation: Realisation, numerator: &[Enclosure], denominator: &[Enclosure]) -> Realised {
    assert!(!denominator.is_empty() && numerator.len() == denominator.len(), "a proper fraction");
    let mut slots = Slots::default();
    let mut row = |letter: &str, row: &[Enclosure]| -> Vec<Slot> {
        row.iter().enumerate().map(|(k, c)| slots.slot(format!("{letter}{k}"), c)).collect()
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
    let output = match realisation {
        Realisation::Df2 => two(&fraction, &mut program),
        Realisation::Df2t => two_transposed(&fraction, &mut program, 0),
        _ => {
            let mut delays = Delays::default();
            one(&fraction, ("y", Operand::Input(0), "u"), &mut delays, &mut program)
        }
    };
    program.outputs = vec![output];
    Realised { realisation, program, structure: Structure(Form::Chain(vec![fraction])) }
}

/// Delayed values that are there already: a value, and the states that hold its past.
#[derive(Default)]
pub(super) struct Delays {
    held: Vec<(Operand, Vec<usize>)>,
}

impl Delays {
    /// The value `k` samples ago.
    fn past(&mut self, of: Operand, name: &str, k: usize, program: &mut Program) -> Operand {
        if k == 0 {
            return of;
        }
        let at = self.held.iter().position(|(operand, _)| *operand == of).unwrap_or_else(|| {
            self.held.push((of, Vec::new()));
            self.held.len() - 1
        });
        let states = &mut self.held[at].1;
        while states.len() < k {
            let before = states.last().map_or(of, |state| Operand::State(*state));
            states.push(program.states.len());
            program.states.push(format!("{name}_{}", states.len()));
            program.updates.push(before);
        }
        Operand::State(states[k - 1])
    }
}

/// Direct form 1 from an operand to a node of this name: `y = sum b_i u_i - sum a_i y_i`.
pub(super) fn one(
    (b, a): &Fraction,
    (name, input, input_name): (&str, Operand, &str),
    delays: &mut Delays,
    program: &mut Program,
) -> Operand {
    let output = Operand::Node(program.nodes.len());
    let mut terms: Vec<Term> = Vec::new();
    for (k, slot) in b.iter().enumerate().filter(|(_, slot)| !slot.is_zero()) {
        terms.extend(slot.term(delays.past(input, input_name, k, program), false, 0));
    }
    for (k, slot) in a.iter().enumerate().skip(1).filter(|(_, slot)| !slot.is_zero()) {
        terms.extend(slot.term(delays.past(output, name, k, program), true, 0));
    }
    program.nodes.push(Node { name: name.into(), terms });
    output
}

/// Direct form 2: `w = u - sum a_i w_i`, `y = sum b_i w_i`.
fn two((b, a): &Fraction, program: &mut Program) -> Operand {
    let mut delays = Delays::default();
    let inner = Operand::Node(0);
    let mut terms = vec![Term { is_negative: false, shift: 0, coefficient: None, operand: Operand::Input(0) }];
    for (k, slot) in a.iter().enumerate().skip(1).filter(|(_, slot)| !slot.is_zero()) {
        terms.extend(slot.term(delays.past(inner, "w", k, program), true, 0));
    }
    program.nodes.push(Node { name: "w".into(), terms });
    let mut terms = Vec::new();
    for (k, slot) in b.iter().enumerate().filter(|(_, slot)| !slot.is_zero()) {
        terms.extend(slot.term(delays.past(inner, "w", k, program), false, 0));
    }
    program.nodes.push(Node { name: "y".into(), terms });
    Operand::Node(1)
}

/// Direct form 2 transposed: `y = b_0 u + s_1`, `s_i' = s_(i+1) + b_i u - a_i y`. With a step of 2 to the power `-step` of the delta operator
/// `s_i' = s_i + 2^-step (..)`, where `step` is not zero.
pub(super) fn two_transposed((b, a): &Fraction, program: &mut Program, step: i32) -> Operand {
    let order = a.len() - 1;
    program.states = (1..=order).map(|k| format!("s_{k}")).collect();
    let state = |k: usize| Term { is_negative: false, shift: 0, coefficient: None, operand: Operand::State(k - 1) };
    let output = Operand::Node(0);
    let mut terms: Vec<Term> = b[0].term(Operand::Input(0), false, 0).into_iter().collect();
    terms.extend((order > 0).then(|| state(1)));
    program.nodes.push(Node { name: "y".into(), terms });
    for k in 1..=order {
        let mut terms = Vec::new();
        if step != 0 {
            terms.push(state(k));
        }
        if k < order {
            terms.push(Term { shift: -step, ..state(k + 1) });
        }
        terms.extend(b[k].term(Operand::Input(0), false, -step));
        terms.extend(a[k].term(output, true, -step));
        program.updates.push(Operand::Node(program.nodes.len()));
        program.nodes.push(Node { name: format!("next_{k}"), terms });
    }
    output
}
