//! Sections side by side.

use super::Realisation;
use super::direct::{Delays, one};
use super::sections::{Factor, exactly, factors, grouped, polynomial, product};
use super::structure::{Form, Fraction, Realised, Slot, Slots, Structure};
use crate::program::{Node, Operand, Program, Term};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};

/// Bits behind the point to which numbers are rounded outwards that are not exact.
const BITS: u64 = 512;

/// The sum of sections of order one and two, each in direct form 1, and of a direct path: the partial fractions of a transfer function in z as
/// [`direct`](super::direct()) takes it. `None` where a pole is multiple, or enclosed coefficients do not tell poles apart.
///
/// Cost: that of [`complex_roots`](jurist_algebra::poly::complex_roots) with 256 bits, and `O(n^3)` products.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::{Enclosure, parse_number};
/// use jurist_ship::realise::parallel;
/// let exact = |texts: &[&str]| texts.iter().map(|t| Enclosure::from_rational(parse_number(t).unwrap())).collect::<Vec<_>>();
/// // (z^2 - 2 z + 3)/(z^2 - 3/2 z + 1/2) = 1 + 4/(z - 1) - 9/2/(z - 1/2), both in one section
/// let sum = parallel(&exact(&["1", "-2", "3"]), &exact(&["1", "-1.5", "0.5"]), &Budget::unlimited())?.unwrap();
/// let numbers: Vec<String> = sum.program.coefficients.iter().map(|c| format!("{} {}", c.name, c.exact.lower())).collect();
/// assert_eq!(numbers, ["b1_1 -1/2", "b2_1 5/2", "a1_1 -3/2", "a2_1 1/2"]);
/// # Ok::<(), jurist_algebra::limits::Exhausted>(())
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When the lengths differ, or there is no coefficient.
pub fn parallel(
    numerator: &[Enclosure],
    denominator: &[Enclosure],
    budget: &Budget,
) -> Result<Option<Realised>, Exhausted> {
    assert!(!denominator.is_empty() && numerator.len() == denominator.len(), "a proper fraction");
    let Some((_, poles)) = factors(denominator, budget)? else { return Ok(None) };
    let groups: Vec<Vec<Factor>> = grouped(poles).into_iter().filter(|group| !group.is_empty()).collect();
    let below: Vec<Vec<Enclosure>> = groups.iter().map(|group| polynomial(group, 0)).collect();
    // What is left of the numerator without the direct path.
    let direct = numerator[0].clone();
    let rest: Vec<Enclosure> =
        numerator.iter().zip(denominator).skip(1).map(|(b, a)| minus(b, &product(a, &direct))).collect();
    let Some(above) = budget.enter(|| partial_fractions(&rest, &below))? else { return Ok(None) };
    let mut slots = Slots::default();
    let direct = slots.slot("d".into(), &direct);
    let mut fractions = Vec::new();
    for (at, (b, a)) in above.iter().zip(&below).enumerate() {
        let mut row = |letter: &str, row: &[Enclosure]| -> Vec<Slot> {
            row.iter().enumerate().map(|(k, c)| slots.slot(format!("{letter}{k}_{}", at + 1), c)).collect()
        };
        fractions.push((row("b", b), row("a", a)));
    }
    let program = summed(&fractions, &direct, slots);
    Ok(Some(Realised {
        realisation: Realisation::Parallel,
        program,
        structure: Structure(Form::Sum { fractions, direct }),
    }))
}

/// The sections, and the sum of their outputs and the direct path.
fn summed(fractions: &[Fraction], direct: &Slot, slots: Slots) -> Program {
    let mut program = Program {
        inputs: 1,
        coefficients: slots.coefficients,
        states: Vec::new(),
        nodes: Vec::new(),
        updates: Vec::new(),
        outputs: Vec::new(),
    };
    let mut delays = Delays::default();
    let mut terms: Vec<Term> = direct.term(Operand::Input(0), false, 0).into_iter().collect();
    for (at, fraction) in fractions.iter().enumerate() {
        let name = format!("y_{}", at + 1);
        let operand = one(fraction, (&name, Operand::Input(0), "u"), &mut delays, &mut program);
        terms.push(Term { is_negative: false, shift: 0, coefficient: None, operand });
    }
    program.outputs = vec![Operand::Node(program.nodes.len())];
    program.nodes.push(Node { name: "y".into(), terms });
    program
}

/// Numerators with `rest/product of all = sum of b/a`, each with as many coefficients as its denominator and a leading 0. `None` where a pivot may be
/// zero: then poles are equal.
fn partial_fractions(rest: &[Enclosure], below: &[Vec<Enclosure>]) -> Option<Vec<Vec<Enclosure>>> {
    let n = rest.len();
    // A column for each unknown: z^k times the product of the other denominators.
    let mut columns: Vec<Vec<Enclosure>> = Vec::with_capacity(n);
    for at in 0..below.len() {
        let others = below.iter().enumerate().filter(|(k, _)| *k != at);
        let others = others.fold(vec![exactly(Rational::ONE)], |p, (_, q)| times(&p, q));
        let degree = below[at].len() - 1;
        for power in (0..degree).rev() {
            let zeros = |count: usize| std::iter::repeat_n(exactly(Rational::ZERO), count);
            let front = n - others.len() - power;
            columns.push(zeros(front).chain(others.iter().cloned()).chain(zeros(power)).collect());
        }
    }
    let matrix: Vec<Vec<Enclosure>> = (0..n)
        .map(|row| columns.iter().map(|column| column[row].clone()).chain([rest[row].clone()]).collect())
        .collect();
    let mut solution = solved(matrix)?.into_iter();
    let numerator = |a: &Vec<Enclosure>| {
        std::iter::once(exactly(Rational::ZERO)).chain(solution.by_ref().take(a.len() - 1)).collect()
    };
    Some(below.iter().map(numerator).collect())
}

/// The solution of a linear system whose right side is the last column, by elimination with the largest pivots.
fn solved(mut rows: Vec<Vec<Enclosure>>) -> Option<Vec<Enclosure>> {
    let n = rows.len();
    let least = |x: &Enclosure| match x.contains(&Rational::ZERO) {
        true => Rational::ZERO,
        false => x.lower().abs().min(x.upper().abs()),
    };
    for k in 0..n {
        let pivot = (k..n).max_by_key(|&row| least(&rows[row][k]))?;
        if rows[pivot][k].contains(&Rational::ZERO) {
            return None;
        }
        rows.swap(k, pivot);
        let above = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(at, _)| *at != k) {
            let factor = quotient(&row[k], &above[k]);
            for (entry, from) in row.iter_mut().zip(&above).skip(k) {
                *entry = minus(entry, &product(&factor, from));
            }
        }
    }
    Some((0..n).map(|k| quotient(&rows[k][n], &rows[k][k])).collect())
}

/// Rounded outwards, if it is not exact.
fn short(x: Enclosure) -> Enclosure {
    if x.lower() == x.upper() { x } else { x.rounded(BITS) }
}

fn minus(a: &Enclosure, b: &Enclosure) -> Enclosure {
    short(Enclosure::new(a.lower() - b.upper(), a.upper() - b.lower()))
}

/// The quotient by a number that is not zero.
fn quotient(a: &Enclosure, b: &Enclosure) -> Enclosure {
    let inverse = |x: &Rational| x.recip().expect("no pivot is zero");
    short(product(a, &Enclosure::new(inverse(b.upper()), inverse(b.lower()))))
}

fn times(a: &[Enclosure], b: &[Enclosure]) -> Vec<Enclosure> {
    let mut out = vec![exactly(Rational::ZERO); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            let term = product(x, y);
            out[i + j] = short(Enclosure::new(out[i + j].lower() + term.lower(), out[i + j].upper() + term.upper()));
        }
    }
    out
}
