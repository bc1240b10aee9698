//! A gain beside a fixed dead time: how many roots are to the right for all values of a parameter in an interval.

use super::clock::Clock;
use super::dead_time::characteristic_function;
use super::expression::Base;
use super::frequency::{Family, Frequencies, Label};
use super::multivariate::Multi;
use super::number::{Q, Z};
use super::over_symbols::primitive;
use super::statement::{Extent, count, extent, identifier, list, number, object, pair, text, values};
use super::univariate::Uni;
use super::words::{self, inward, with_values};
use super::{Proved, Rejection, Step, is_discrete};
use crate::format::Json;
use num_traits::{Signed, Zero};

/// Longer numerators and denominators of ends are refused.
const MAX_BITS: u64 = 4096;

/// An interval of the parameter, ends included, with the number of roots to the right that is claimed for all of it.
struct Cell {
    lower: Q,
    upper: Q,
    right: usize,
}

/// The bits and the base of all dead times.
fn fixed(json: &Json) -> Result<(usize, Q), String> {
    let keys = ["schema", "statement", "bits", "delay"];
    let [_, _, bits, base] = object(json, "the certificate", keys, &["model"])?;
    match count(bits, "'bits'")? {
        bits @ 64..=1024 => Ok((bits, number(base, "'delay'")?)),
        _ => Err("'bits' is not from 64 to 1024".into()),
    }
}

/// That the region is the left half plane, and the dead time positive.
fn usual(time: &Json, region: &Json, base: &Q) -> Result<(), String> {
    if is_discrete(time)? || extent(region, false)? != Extent::Number(Q::zero()) || !base.is_positive() {
        return Err("the boundary is not the imaginary axis, or the dead time is not positive".into());
    }
    Ok(())
}

pub(super) fn check(text_of_model: &str, json: &Json, statement: &Json, clock: &Clock) -> Result<Proved, Rejection> {
    let (bits, base) = Step::Format.of(fixed(json))?;
    let keys = ["kind", "time", "parameter", "set", "region", "cells"];
    let [_, time, parameter, set, region, cells] = Step::Statement.of(object(statement, "the statement", keys, &[]))?;
    let (parameter, set) = Step::Statement.of((|| {
        usual(time, region, &base)?;
        Ok((identifier(text(parameter, "'parameter'")?)?, values(set)?))
    })())?;
    let cells = Step::Statement.of(read_cells(cells))?;
    let given = (Some(parameter), set.as_slice());
    prove(text_of_model, given, base, bits, &cells, clock)?;
    Ok(Proved { statement: in_words(parameter, &set, &cells), kind: "cells" })
}

/// The roots to the right at the point that all parameters have.
pub(super) fn check_verdict(
    text_of_model: &str,
    json: &Json,
    statement: &Json,
    clock: &Clock,
) -> Result<Proved, Rejection> {
    let (bits, base) = Step::Format.of(fixed(json))?;
    let keys = ["kind", "time", "set", "region", "verdict", "right"];
    let [_, time, set, region, verdict, right] = Step::Statement.of(object(statement, "the statement", keys, &[]))?;
    let (set, verdict, right) = Step::Statement.of((|| {
        usual(time, region, &base)?;
        Ok((values(set)?, text(verdict, "'verdict'")?, count(right, "'right'")?))
    })())?;
    let name = if right == 0 { "stable" } else { "unstable" };
    if verdict != name {
        return Step::Stable.fails(format!("the verdict is '{name}' then"));
    }
    let cell = Cell { lower: Q::zero(), upper: Q::zero(), right };
    prove(text_of_model, (None, &set), base, bits, &[cell], clock)?;
    let at = words::values(set.iter().map(|(name, value)| (name, value)));
    let at = if at.is_empty() { "The".to_owned() } else { format!("At {at}, the") };
    let statement = format!("{at} loop is {name}: {right} roots to the right of the imaginary axis, none on it.");
    Ok(Proved { statement, kind: "verdict" })
}

/// That as many roots are to the right as the cells say.
fn prove(
    text_of_model: &str,
    (parameter, set): (Option<&str>, &[(String, Q)]),
    base: Q,
    bits: usize,
    cells: &[Cell],
    clock: &Clock,
) -> Result<(), Rejection> {
    let (family, divisors) = Step::Model.of(clock.reading(|| family(text_of_model, parameter, set, base, clock)))?;
    let mut frequencies = Frequencies::new(&family, bits, clock);
    for cell in cells {
        Step::Boundary.of(defined(cell, &divisors, clock))?;
        let axis = Step::Boundary.of(family.beyond(&cell.lower, &cell.upper, clock))?;
        Step::Boundary.of(clear(&mut frequencies, axis, cell))?;
        let middle = (&cell.lower + &cell.upper) / Q::from(Z::from(2));
        let right = Step::Line.of(counted(&family, &mut frequencies, axis, &middle))?;
        if right != cell.right {
            let reason = format!("{right} roots are to the right from {} to {}", cell.lower, cell.upper);
            return Step::Stable.fails(reason);
        }
    }
    Ok(())
}

fn read_cells(json: &Json) -> Result<Vec<Cell>, String> {
    let mut cells: Vec<Cell> = Vec::new();
    for cell in list(json, "'cells'")? {
        let [between, right] = object(cell, "a cell", ["between", "right"], &[])?;
        let (lower, upper) = pair(between, "'between'")?;
        if [&lower, &upper].iter().any(|x| x.numer().bits().max(x.denom().bits()) > MAX_BITS) {
            return Err("an end of a cell has too many digits".into());
        }
        if cells.last().is_some_and(|last| last.upper >= lower) {
            return Err("the cells are not in order".into());
        }
        cells.push(Cell { lower, upper, right: count(right, "'right'")? });
    }
    if cells.is_empty() { Err("there are no cells".into()) } else { Ok(cells) }
}

/// The characteristic function `A(s, z) + p B(s, z)`, and polynomials at whose zeros the loop is undefined.
fn family(
    text: &str,
    parameter: Option<&str>,
    set: &[(String, Q)],
    tau: Q,
    clock: &Clock,
) -> Result<(Family, Vec<Uni>), String> {
    let found = characteristic_function(text, parameter, set, Base::Number(&tau), clock)?;
    let in_parameter = |p: &Multi| {
        let numbers = p.coefficients(1);
        Uni::new(numbers.iter().map(|c| c.0.values().next().cloned().unwrap_or_default()).collect())
    };
    let common = |list: &[Uni]| list.iter().try_fold(Uni::default(), |g, c| g.gcd(c, clock));
    let of = |divisor: &Multi| common(&divisor.coefficients(0).iter().map(in_parameter).collect::<Vec<_>>());
    let mut divisors = found.divisors.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    let mut parts: Vec<Vec<Uni>> = primitive(found.function.coefficients(2), clock)?
        .iter()
        .map(|part| part.coefficients(0).iter().map(in_parameter).collect())
        .skip_while(|part: &Vec<Uni>| part.iter().all(Uni::is_zero))
        .collect();
    let content = common(&parts.iter().flatten().cloned().collect::<Vec<Uni>>())?;
    for c in parts.iter_mut().flatten().filter(|c| !c.is_zero()) {
        if content.degree() > 0 {
            // The quotient comes without the integers that all coefficients have in common.
            let quotient = c.divided(&content, clock)?.ok_or("internal: a common divisor does not divide")?;
            *c = quotient.scaled(&c.content(clock)?);
        }
        if c.degree() > 1 {
            return Err("the parameter does not enter as a factor".into());
        }
    }
    divisors.push(content);
    Ok((Family::new(&parts, tau)?, divisors))
}

/// That no divisor vanishes.
fn defined(cell: &Cell, divisors: &[Uni], clock: &Clock) -> Result<(), String> {
    for divisor in divisors {
        let inside = divisor.descartes(Some(&cell.lower), Some(&cell.upper), clock)?;
        if inside != Some(0) || divisor.vanishes_at(&cell.lower, clock)? || divisor.vanishes_at(&cell.upper, clock)? {
            return Err(format!("a divisor is not shown to be other than zero from {} to {}", cell.lower, cell.upper));
        }
    }
    Ok(())
}

/// That no root is on the axis for any value in the cell: `A + p B = 0` for a real `p` only where `A conj B` is real, and then
/// `p |B|^2 = -Re(A conj B)`.
fn clear(frequencies: &mut Frequencies<'_>, axis: i32, cell: &Cell) -> Result<(), String> {
    let (a, b) = (&cell.lower, &cell.upper);
    let largest = a.abs().max(b.abs());
    let squared = &largest * &largest;
    frequencies.walk(axis, |[x, y], bits| {
        let [re, im] = x.times(&y.conjugate(), bits).0;
        if !im.contains_zero() {
            return true;
        }
        let (of_x, of_y) = (x.square(bits), y.square(bits));
        // p < a, p > b, or A outweighs p B.
        let beside = |p: &Q| re.scaled(p.denom()).plus(&of_y.scaled(p.numer()));
        beside(a).lo.is_positive()
            || beside(b).hi.is_negative()
            || of_x.scaled(squared.denom()).lo > of_y.scaled(squared.numer()).hi
    })
}

/// The number of roots to the right at one value, at which none is on the axis.
fn counted(family: &Family, frequencies: &mut Frequencies<'_>, axis: i32, p: &Q) -> Result<usize, String> {
    let first = family.at_zero(p);
    let mut label = Label::of_sign(first.is_negative(), 0);
    if first.is_zero() {
        return Err("s = 0 is a root".into());
    }
    let mut turns = 0_i64;
    frequencies.walk(axis, |[x, y], _| {
        let value = x.scaled(p.denom()).plus(&y.scaled(p.numer()));
        match label.next(&value) {
            Some((next, step)) => {
                (label, turns) = (next, turns + step);
                true
            }
            None => false,
        }
    })?;
    // At the end the highest power of s dominates.
    let last = Label::of_sign(family.leading(p).is_negative(), family.order);
    let twice = label.step_to(last).map(|step| family.order as i64 - turns - step);
    let right = twice.filter(|twice| twice % 2 == 0).and_then(|twice| usize::try_from(twice / 2).ok());
    right.ok_or_else(|| "internal: the argument does not turn as it must".into())
}

fn in_words(parameter: &str, set: &[(String, Q)], cells: &[Cell]) -> String {
    let join = |of: &[String]| of.join(" or ");
    let within = |cell: &Cell| format!("[{}]", inward(&cell.lower, &cell.upper).join(", "));
    let all: Vec<String> = cells.iter().map(within).collect();
    let stable: Vec<String> = cells.iter().filter(|c| c.right == 0).map(within).collect();
    let given = with_values(set);
    let stable = if stable.is_empty() { "for none of them".to_owned() } else { format!("in {}", join(&stable)) };
    format!(
        "For {parameter} in {}{given}, the loop is stable exactly {stable}. Nothing is said of other values.",
        join(&all)
    )
}
