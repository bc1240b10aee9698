//! From a model's text to its characteristic polynomial in one parameter.

use super::blocks::{Values, system_matrix};
use super::characteristic::{Characteristic, Form, specialised};
use super::clock::Clock;
use super::complex::{doubled, has_unit, real_divisors};
use super::declarations::{Declarations, Meaning};
use super::expression::{Base, DeadTime, Names, Scope, number};
use super::factor::{Cut, Factor, PutIn};
use super::keys;
use super::moving::Moving;
use super::multivariate::{Fraction, Multi};
use super::number::{Q, shorten};
use super::symbols::Table;
use super::toml::{self, Toml};
use super::univariate::Uni;
use num_traits::Signed;
use std::collections::{BTreeMap, BTreeSet};

/// Reads the model; `values` are the values of all parameters but `kept`. `kept` may be none of the
/// model's, then all are in `values`.
pub(super) fn read(
    text: &str,
    kept: Option<&str>,
    values: &[(String, Q)],
    clock: &Clock,
) -> Result<Characteristic, String> {
    let read = asked(text, kept, values, &Table::empty(), None, clock)?;
    let mut found = specialised(&read.form, &read.divisors, read.discrete, &read.values, clock)?;
    found.is_doubled = read.is_doubled;
    if found.poles.iter().any(Uni::is_zero) {
        // Undefined everywhere: there is no polynomial.
        found.coefficients.clear();
    }
    Ok(found)
}

/// A loop as a question sees it.
pub(super) struct Asked {
    pub discrete: bool,
    pub form: Form,
    /// Everything that the model divides by.
    pub divisors: BTreeSet<Multi>,
    /// The values of the variables from 2 on; symbols follow.
    pub values: Vec<Q>,
    /// What the variables behind the parameters of a box are, where functions of them are read.
    pub moving: Option<Moving>,
    /// Whether the loop is complex, so that it is doubled.
    pub is_doubled: bool,
    /// The variable that is the imaginary unit in a loop that is not doubled: one with a complex factor.
    pub unit: Option<usize>,
    /// Whether such a loop is complex without its factor.
    pub is_complex: bool,
}

/// Reads the model for a question, exponentials over the symbols of a table, dead times as multiples of `base`.
pub(super) fn asked(
    text: &str,
    kept: Option<&str>,
    values: &[(String, Q)],
    table: &Table,
    base: Option<Base<'_>>,
    clock: &Clock,
) -> Result<Asked, String> {
    let boxed = Boxed { names: &[], set: values, factor: None };
    read_for((kept, boxed, false), text, table, base, clock)
}

/// What the functions of a loop with a box of parameters are.
#[derive(Clone, Copy)]
pub(super) enum Functions<'t> {
    /// Of numbers: over the symbols of a table, which follow the parameters of the box.
    OfNumbers(&'t Table),
    /// Of parameters: further variables.
    Moving,
}

/// A box of parameters, which are the variables behind those with a value, the values of all others, and a factor at a cut of the loop. The own
/// names of the factor are the variables behind the parameters.
#[derive(Clone, Copy)]
pub(super) struct Boxed<'q> {
    pub names: &'q [String],
    pub set: &'q [(String, Q)],
    pub factor: Option<&'q Factor>,
}

/// Reads the model for a question about a box of parameters.
pub(super) fn asked_over_box(
    text: &str,
    boxed: Boxed<'_>,
    functions: Functions<'_>,
    clock: &Clock,
) -> Result<Asked, String> {
    match functions {
        Functions::OfNumbers(table) => read_for((None, boxed, false), text, table, None, clock),
        Functions::Moving => read_for((None, boxed, true), text, &Table::empty(), None, clock),
    }
}

fn read_for(
    (kept, boxed, is_moving): (Option<&str>, Boxed<'_>, bool),
    text: &str,
    table: &Table,
    base: Option<Base<'_>>,
    clock: &Clock,
) -> Result<Asked, String> {
    let root = toml::read(text)?;
    keys::known(&root)?;
    clock.reading(|| {
        let declared = Declarations::read(&root, clock)?;
        let mut meaning = declared.asked(kept, boxed.names, boxed.set, clock)?;
        if meaning.changes_constants {
            // The model must be right as it is; dead times are read without their values.
            let is_moving = is_moving || base.is_some();
            evaluated(&root, &declared, (&declared.as_written(), is_moving), None, clock)?;
        }
        let mut first = meaning.values.len() + boxed.names.len();
        let (mut unit, mut is_complex) = (None, false);
        if let Some(factor) = boxed.factor {
            // Without the factor it must be right as well.
            let of = Values { numbers: &meaning.values, first, table, base };
            let plain = evaluated(&root, &declared, (&meaning, is_moving), Some(of), clock)?;
            match &factor.cut {
                Cut::Parameter(name) if !declared.is_parameter(name, clock) => {
                    return Err(format!("the loop has no parameter '{}' to be cut at", shorten(name)));
                }
                Cut::Signal(_) | Cut::Input(_) if !matches!(plain.form, Form::System(..)) => {
                    return Err("a loop without blocks is cut at a parameter alone".into());
                }
                _ => {}
            }
            // Conjugated factors make conjugated loops of real ones.
            is_complex = plain.divisors.iter().any(|divisor| has_unit(divisor, meaning.unit));
            is_complex |= doubled(plain.form, &plain.divisors, meaning.unit, clock)?.2;
            if factor.family.is_complex() {
                // No parameter is in question beside those of a box.
                meaning.unit = KEPT;
                unit = Some(KEPT);
            }
            meaning.factor = Some(PutIn::new(factor, first, meaning.unit, clock)?);
            first += factor.family.names();
        }
        let of = Values { numbers: &meaning.values, first, table, base };
        let found = evaluated(&root, &declared, (&meaning, is_moving), Some(of), clock)?;
        let (discrete, moving) = (declared.discrete, found.moving);
        let (form, divisors, is_doubled) = match unit {
            Some(unit) => (found.form, real_divisors(&found.divisors, unit, clock)?, false),
            None => doubled(found.form, &found.divisors, meaning.unit, clock)?,
        };
        Ok(Asked { discrete, form, divisors, values: meaning.values, moving, is_doubled, unit, is_complex })
    })
}

/// The variable of the parameter in question.
const KEPT: usize = 1;

/// A loop as it is read.
struct Evaluated {
    form: Form,
    /// Everything that the model divides by.
    divisors: BTreeSet<Multi>,
    /// The functions in it, if they are read.
    moving: Option<Moving>,
}

fn evaluated(
    root: &Toml,
    declared: &Declarations<'_>,
    (meaning, is_moving): (&Meaning<'_>, bool),
    values: Option<Values<'_>>,
    clock: &Clock,
) -> Result<Evaluated, String> {
    let mut scope = declared.scope(meaning, is_moving, clock)?;
    if let Some(Values { numbers, base: Some(base), .. }) = values.filter(|_| !declared.discrete) {
        let (base, power) = match base {
            Base::OfParameter(base) => (base.clone(), 1),
            Base::Number(base) => (base.clone(), 0),
        };
        scope.dead_time = Some(DeadTime { base, power, values: numbers.to_vec() });
    }
    if let Some(value) = root.get("sample_time") {
        let time = scope.scalar(value).and_then(|time| scope.real(time))?;
        if time.as_number().is_some_and(|time| !time.is_positive()) {
            return Err("the sample time is not positive".into());
        }
    }
    let table = root.get("loop").ok_or("the model has no [loop]")?;
    let forms = ["characteristic", "matrix"].into_iter().filter(|k| table.get(k).is_some()).count()
        + usize::from(["A", "B", "C", "K"].iter().any(|k| table.get(k).is_some()))
        + usize::from(root.get("block").is_some());
    if forms != 1 {
        return Err("the model has not exactly one form of loop".into());
    }
    let (form, ports) = if let Some(text) = table.get("characteristic") {
        (Form::Written(scope.value(text, Names::Polynomial(declared.variable()))?), Ports::default())
    } else if let Some(rows) = table.get("matrix") {
        let m = square(rows, &mut scope)?;
        let ports = ports(table, m.len(), declared, &mut scope)?;
        (Form::Matrix(m), ports)
    } else if let Some(blocks) = root.get("block") {
        system_matrix(table, blocks.list()?, declared, &mut scope, root.get("sample_time"), values)?
    } else {
        let get = |key: &str| table.get(key).ok_or_else(|| format!("[loop] has no '{key}'"));
        let (a, b) = (square(get("A")?, &mut scope)?, matrix(get("B")?, &mut scope)?);
        let (c, k) = (matrix(get("C")?, &mut scope)?, matrix(get("K")?, &mut scope)?);
        let (n, p) = (a.len(), c.len());
        let m = b.first().map_or(0, Vec::len);
        sized(&b, n, m)?;
        sized(&c, p, n)?;
        sized(&k, m, p)?;
        let ports = ports(table, n, declared, &mut scope)?;
        (Form::Feedback([a, b, c, k]), ports)
    };
    simulation(root, &ports, clock)?;
    Ok(Evaluated { form, divisors: scope.divisors, moving: scope.moving })
}

/// What a loop calls what enters it, what it remembers, and what is seen of it.
#[derive(Default)]
pub(super) struct Ports<'t> {
    pub inputs: Vec<&'t str>,
    pub states: Vec<&'t str>,
    pub signals: Vec<&'t str>,
    pub outputs: Vec<String>,
}

/// The names of a list or of a single one.
pub(super) fn names<'t>(table: &'t Toml, key: &str) -> Result<Vec<&'t str>, String> {
    table.get(key).map(Toml::one_or_more).unwrap_or_default().into_iter().map(Toml::text).collect()
}

/// The ports of a loop with `n` states.
fn ports<'t>(
    table: &'t Toml,
    n: usize,
    declared: &Declarations<'_>,
    scope: &mut Scope<'_>,
) -> Result<Ports<'t>, String> {
    let (states, inputs) = (names(table, "states")?, names(table, "inputs")?);
    declared.distinct(&states)?;
    declared.distinct(&inputs)?;
    if table.get("states").is_some() && states.len() != n {
        return Err("there are not as many states as rows".into());
    }
    match (table.get("inputs"), table.get("E")) {
        (Some(_), Some(rows)) => sized(&matrix(rows, scope)?, n, inputs.len())?,
        (None, None) => {}
        _ => return Err("'inputs' and 'E' go together".into()),
    }
    let signals = states.iter().enumerate().map(|(i, name)| ((*name).to_owned(), i)).collect();
    let outputs = outputs(table, &signals, scope)?;
    Ok(Ports { inputs, signals: states.clone(), states, outputs })
}

/// The texts of the outputs, by which they are called.
pub(super) fn outputs(
    table: &Toml,
    signals: &BTreeMap<String, usize>,
    scope: &mut Scope<'_>,
) -> Result<Vec<String>, String> {
    let mut texts = Vec::new();
    for output in table.get("outputs").map(Toml::one_or_more).unwrap_or_default() {
        // A name is one line, however the expression is broken.
        let text = output.text()?.trim().replace(char::is_control, " ");
        scope.linear(output, signals)?;
        if texts.contains(&text) {
            return Err(format!("the output '{}' stands there twice", shorten(&text)));
        }
        texts.push(text);
    }
    Ok(texts)
}

/// What `[simulation]` says has no influence, but must be right.
fn simulation(root: &Toml, ports: &Ports<'_>, clock: &Clock) -> Result<(), String> {
    let Some(table) = root.get("simulation") else { return Ok(()) };
    let known = |name: &str, lists: &[&[&str]]| match lists.iter().any(|list| list.contains(&name)) {
        true => Ok(()),
        false => Err(format!("unknown name '{}' in the simulation", shorten(&name.escape_debug().to_string()))),
    };
    for (name, value) in table.section("inputs")? {
        known(name, &[&ports.inputs])?;
        number(value, clock)?;
    }
    for (name, value) in table.section("initial")? {
        known(name, &[&ports.states])?;
        number(value, clock)?;
    }
    let outputs: Vec<&str> = ports.outputs.iter().map(String::as_str).collect();
    for (name, unit) in table.section("units")? {
        known(name, &[&ports.inputs, &ports.signals, &outputs])?;
        unit.text()?;
    }
    match table.get("duration").map(|value| number(value, clock)).transpose()? {
        Some(duration) if !duration.is_positive() => Err("the duration of a simulation is not positive".into()),
        _ => Ok(()),
    }
}

pub(super) fn matrix(value: &Toml, scope: &mut Scope<'_>) -> Result<Vec<Vec<Fraction>>, String> {
    let row = |row: &Toml, scope: &mut Scope<'_>| -> Result<Vec<Fraction>, String> {
        row.list()?.iter().map(|e| scope.scalar(e)).collect()
    };
    if let Toml::Text(name) = value {
        let found = scope.matrices.get(name.trim()).cloned();
        return found.ok_or_else(|| format!("no constant '{}' is a matrix", shorten(name)));
    }
    value.list()?.iter().map(|r| row(r, scope)).collect()
}

/// Whether a matrix has the wanted size; one without rows has every number of columns.
pub(super) fn sized(m: &[Vec<Fraction>], rows: usize, columns: usize) -> Result<(), String> {
    if m.len() == rows && m.iter().all(|row| row.len() == columns) {
        return Ok(());
    }
    Err("the sizes of the matrices do not fit".into())
}

/// A square matrix that is not empty.
fn square(value: &Toml, scope: &mut Scope<'_>) -> Result<Vec<Vec<Fraction>>, String> {
    let m = matrix(value, scope)?;
    if m.is_empty() {
        return Err("a matrix is empty".into());
    }
    sized(&m, m.len(), m.len())?;
    Ok(m)
}
