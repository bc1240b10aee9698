//! State space as it is given.

use super::Realisation;
use super::structure::{Form, Realised, Slot, Slots, Structure};
use crate::program::{Node, Operand, Program, Term};
use jurist_algebra::number::Enclosure;

/// `y = C x + D u`, `x' = A x + B u`: a sum for each output and each state. The matrices are given by their rows.
///
/// Cost: linear in the entries.
///
/// ```
/// use jurist_algebra::number::{Enclosure, parse_number};
/// use jurist_ship::realise::state;
/// let rows = |text: &str| vec![vec![Enclosure::from_rational(parse_number(text).unwrap())]];
/// let lag = state(&rows("0.9"), &rows("1"), &rows("0.1"), &rows("0"));
/// let names: Vec<&str> = lag.program.coefficients.iter().map(|c| c.name.as_str()).collect();
/// assert_eq!(names, ["A_1_1", "C_1_1"]);
/// ```
pub fn state(a: &[Vec<Enclosure>], b: &[Vec<Enclosure>], c: &[Vec<Enclosure>], d: &[Vec<Enclosure>]) -> Realised {
    let mut slots = Slots::default();
    let mut matrix = |letter: &str, rows: &[Vec<Enclosure>]| -> Vec<Vec<Slot>> {
        let mut row = |(i, row): (usize, &Vec<Enclosure>)| {
            row.iter().enumerate().map(|(j, x)| slots.slot(format!("{letter}_{}_{}", i + 1, j + 1), x)).collect()
        };
        rows.iter().enumerate().map(&mut row).collect()
    };
    let [a, b, c, d] = [("A", a), ("B", b), ("C", c), ("D", d)].map(|(letter, rows)| matrix(letter, rows));
    let sum = |states: &[Slot], inputs: &[Slot]| -> Vec<Term> {
        let of_states = states.iter().enumerate().map(|(k, slot)| slot.term(Operand::State(k), false, 0));
        let of_inputs = inputs.iter().enumerate().map(|(k, slot)| slot.term(Operand::Input(k), false, 0));
        of_states.chain(of_inputs).flatten().collect()
    };
    let outputs = c.iter().zip(&d).enumerate();
    let mut nodes: Vec<Node> =
        outputs.map(|(k, (c, d))| Node { name: format!("y_{}", k + 1), terms: sum(c, d) }).collect();
    let next = a.iter().zip(&b).enumerate();
    nodes.extend(next.map(|(k, (a, b))| Node { name: format!("next_{}", k + 1), terms: sum(a, b) }));
    let program = Program {
        inputs: b.first().or(d.first()).map_or(0, Vec::len),
        coefficients: slots.coefficients,
        states: (1..=a.len()).map(|k| format!("x_{k}")).collect(),
        nodes,
        updates: (0..a.len()).map(|k| Operand::Node(c.len() + k)).collect(),
        outputs: (0..c.len()).map(Operand::Node).collect(),
    };
    Realised { realisation: Realisation::State, program, structure: Structure(Form::State([a, b, c, d])) }
}
