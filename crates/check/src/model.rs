//! From a model's text to its characteristic polynomial in one parameter.

use super::blocks::{Ordered, system_matrix};
use super::determinant::{Entry, determinant};
use super::expression::{Constant, Names, Scope};
use super::multivariate::{Fraction, Multi};
use super::number::{Clock, Q, Z, shorten};
use super::toml::{self, Toml};
use super::univariate::{Uni, common_denominator};
use num_traits::{One, Signed, Zero};
use std::collections::{HashMap, HashSet};

/// A polynomial in `z` or `s` whose coefficients are polynomials in the parameter.
pub(super) struct Characteristic {
    /// Whether time is discrete.
    pub discrete: bool,
    /// The degree with all parameters symbolic.
    pub degree: usize,
    /// `degree + 1` coefficients from the constant term up: up to a factor that does not vanish where
    /// the loop is defined, the characteristic polynomial.
    pub coefficients: Vec<Uni>,
    /// The loop is undefined at the zeros of these; everywhere if one of them is zero.
    pub poles: Vec<Uni>,
}

/// A loop whose entries are evaluated.
struct Evaluated {
    /// `det` of this matrix of fractions, or a single polynomial as it is written.
    form: Form,
    divisors: Vec<Multi>,
}

enum Form {
    /// A characteristic polynomial as written, over a denominator.
    Written(Fraction),
    /// `zI - M`: the entries of `M`.
    Matrix(Vec<Vec<Fraction>>),
    /// `A - B K C`.
    Feedback([Vec<Vec<Fraction>>; 4]),
    /// A polynomial system matrix and the degree of its determinant.
    System(Ordered, Vec<Ordered>),
}

/// Reads the model; `values` are the values of all parameters but `kept`. `kept` may be none of the
/// model's, then all are in `values`.
pub(super) fn read(
    text: &str,
    kept: Option<&str>,
    values: &[(String, Q)],
    clock: &Clock,
) -> Result<Characteristic, String> {
    let root = toml::read(text)?;
    super::keys::known(&root)?;
    let discrete = match root.get("time").ok_or("the model has no 'time'")?.text()? {
        "discrete" => true,
        "continuous" => false,
        other => return Err(format!("unknown time '{}'", shorten(other))),
    };
    let variable = if discrete { "z" } else { "s" };
    let mut constants = HashMap::new();
    let mut texts = Vec::new();
    for (name, value) in root.get("constants").map(Toml::entries).unwrap_or_default() {
        texts.push((name.clone(), value.expression()?));
    }
    for (name, text) in &texts {
        constants.insert(name.clone(), Constant::Text(text.clone()));
    }
    let declared: Vec<&String> =
        root.get("parameters").map(Toml::entries).unwrap_or_default().iter().map(|(name, _)| name).collect();
    if let Some(name) = declared.iter().find(|n| constants.contains_key(n.as_str())) {
        return Err(format!("'{}' is both a constant and a parameter", shorten(name)));
    }
    // Variable 0 is z or s, then the kept parameter, then the others.
    let mut parameters = HashMap::new();
    let mut numbers = vec![Q::zero(), Q::zero()];
    let mut scope = Scope::new(constants, HashMap::new(), clock);
    let mut replaced = HashSet::new();
    for (name, value) in kept.map(|k| (k, None)).into_iter().chain(values.iter().map(|(n, v)| (n.as_str(), Some(v)))) {
        if !declared.iter().any(|d| *d == name) {
            let text = texts.iter().find(|(n, _)| n == name).map(|(_, text)| text);
            if !text.is_some_and(|text| scope.is_number(text)) {
                return Err(format!("the model has no parameter '{}'", shorten(name)));
            }
            if let Some(value) = value {
                // A constant that is set has another number; nothing else changes.
                if parameters.contains_key(name) || !replaced.insert(name) {
                    return Err(format!("'{}' has two values", shorten(name)));
                }
                scope.constants.insert(name.to_owned(), Constant::Text(value.to_string()));
                continue;
            }
            scope.constants.remove(name);
        }
        let number = match value {
            None => 1,
            Some(value) => {
                numbers.push(value.clone());
                numbers.len() - 1
            }
        };
        if parameters.insert(name.to_owned(), number).is_some() {
            return Err(format!("'{}' has two values", shorten(name)));
        }
    }
    if let Some(name) = declared.iter().find(|d| !parameters.contains_key(d.as_str())) {
        return Err(format!("the parameter '{}' has no value", shorten(name)));
    }
    for name in ["z", "s"] {
        if name == variable && (parameters.contains_key(name) || scope.constants.contains_key(name)) {
            return Err(format!("'{name}' is the loop's variable and also something else"));
        }
    }
    scope.parameters = parameters;
    let evaluated = evaluate(&root, variable, &mut scope)?;
    let mut found = specialise(evaluated, discrete, &numbers, clock)?;
    if found.poles.iter().any(Uni::is_zero) {
        // Undefined everywhere: there is no polynomial.
        found.coefficients.clear();
    }
    Ok(found)
}

fn evaluate(root: &Toml, variable: &str, scope: &mut Scope<'_>) -> Result<Evaluated, String> {
    // An undefined constant makes the model undefined, used or not.
    let names: Vec<String> = scope.constants.keys().cloned().collect();
    for name in names {
        scope.constant(&name)?;
    }
    if let Some(value) = root.get("sample_time") {
        scope.scalar(&value.expression()?)?;
    }
    let table = root.get("loop").ok_or("the model has no [loop]")?;
    let forms = ["characteristic", "matrix"].into_iter().filter(|k| table.get(k).is_some()).count()
        + usize::from(["A", "B", "C", "K"].iter().any(|k| table.get(k).is_some()))
        + usize::from(root.get("block").is_some());
    if forms != 1 {
        return Err("the model has not exactly one form of loop".into());
    }
    let form = if let Some(text) = table.get("characteristic") {
        let names = Names { variable: Some(variable), ..Names::default() };
        let value = scope.linear(&text.expression()?, names)?.constant;
        if value.denominator.degree(0) > 0 || value.scalar.degree(0) > 0 {
            return Err("the characteristic polynomial divides by the variable".into());
        }
        Form::Written(value)
    } else if let Some(rows) = table.get("matrix") {
        let m = matrix(rows, scope)?;
        sized(&m, m.len(), m.len())?;
        ports(table, scope)?;
        Form::Matrix(m)
    } else if let Some(blocks) = root.get("block") {
        let (whole, alone) = system_matrix(table, blocks, variable, scope)?;
        Form::System(whole, alone)
    } else {
        let get = |key: &str| table.get(key).ok_or_else(|| format!("[loop] has no '{key}'"));
        let (a, b) = (matrix(get("A")?, scope)?, matrix(get("B")?, scope)?);
        let (c, k) = (matrix(get("C")?, scope)?, matrix(get("K")?, scope)?);
        let (n, m, p) = (a.len(), k.len(), c.len());
        sized(&a, n, n)?;
        sized(&b, n, m)?;
        sized(&c, p, n)?;
        sized(&k, m, p)?;
        ports(table, scope)?;
        Form::Feedback([a, b, c, k])
    };
    Ok(Evaluated { form, divisors: std::mem::take(&mut scope.divisors) })
}

/// The expressions of `E` and `outputs`, which count only where they divide.
fn ports(table: &Toml, scope: &mut Scope<'_>) -> Result<(), String> {
    if let Some(rows) = table.get("E") {
        matrix(rows, scope)?;
    }
    let states = table.get("states").map(Toml::one_or_more).unwrap_or_default();
    let names = states.iter().enumerate().map(|(i, t)| Ok((t.text()?.to_owned(), i)));
    let signals: HashMap<String, usize> = names.collect::<Result<_, String>>()?;
    for output in table.get("outputs").map(Toml::one_or_more).unwrap_or_default() {
        scope.linear(&output.expression()?, Names { signals: Some(&signals), ..Names::default() })?;
    }
    Ok(())
}

pub(super) fn matrix(value: &Toml, scope: &mut Scope<'_>) -> Result<Vec<Vec<Fraction>>, String> {
    let row = |row: &Toml, scope: &mut Scope<'_>| -> Result<Vec<Fraction>, String> {
        row.list()?.iter().map(|e| scope.scalar(&e.expression()?)).collect()
    };
    value.list()?.iter().map(|r| row(r, scope)).collect()
}

/// Whether a matrix has the wanted size; one without rows has every number of columns.
pub(super) fn sized(m: &[Vec<Fraction>], rows: usize, columns: usize) -> Result<(), String> {
    if m.len() == rows && m.iter().all(|row| row.len() == columns) {
        return Ok(());
    }
    Err("the sizes of the matrices do not fit".into())
}

/// Numerator and denominator, by powers of the parameter.
type Quotient = (Vec<Q>, Vec<Q>);

/// A fraction with all parameters but the kept one replaced by their values: numerator and denominator as
/// polynomials in the kept parameter. The fraction does not contain variable 0.
fn in_parameter(f: &Fraction, numbers: &[Q], clock: &Clock) -> Result<Option<Quotient>, String> {
    let numerator = f.numerator.specialised(1, numbers).swap_remove(0);
    let denominator = f.whole_denominator(clock)?.specialised(1, numbers).swap_remove(0);
    Ok(if denominator.iter().all(Zero::is_zero) { None } else { Some((numerator, denominator)) })
}

/// Cleared of denominators; a positive factor does not matter.
fn cleared(rows: &[Vec<Q>]) -> Vec<Uni> {
    let d = common_denominator(rows.iter().flatten());
    rows.iter().map(|row| Uni::new(row.iter().map(|q| q.numer() * (&d / q.denom())).collect())).collect()
}

fn specialise(evaluated: Evaluated, discrete: bool, numbers: &[Q], clock: &Clock) -> Result<Characteristic, String> {
    let mut poles = Vec::new();
    for divisor in &evaluated.divisors {
        // Undefined where all coefficients in variable 0 vanish together.
        let mut common = Uni::default();
        for part in cleared(&divisor.specialised(1, numbers)) {
            common = common.gcd(&part, clock)?;
        }
        poles.push(common);
    }
    let nowhere = |degree: usize, poles: Vec<Uni>| Characteristic { discrete, degree, coefficients: Vec::new(), poles };
    // The coefficients, the denominator they stand over, and whether that is a new place of being undefined.
    let (mut coefficients, denominator, degree) = match &evaluated.form {
        Form::Written(f) => {
            let degree = f.numerator.degree(0);
            let below = f.whole_denominator(clock)?.specialised(1, numbers);
            let mut all = f.numerator.specialised(1, numbers);
            all.extend(below);
            let mut all = cleared(&all);
            let denominator = all.pop().unwrap_or_default();
            (all, denominator, degree)
        }
        Form::Matrix(m) => {
            let Some(entries) = matrix_entries(m, numbers, clock)? else {
                return Ok(undefined(nowhere, m.len(), poles));
            };
            monic(entries, m.len(), clock)?
        }
        Form::Feedback([a, b, c, k]) => {
            let minus_bk = |f: Fraction| f.negated();
            let bk = product(b, k, clock)?;
            let bkc = product(&bk, c, clock)?;
            let mut m = a.clone();
            for (row, other) in m.iter_mut().zip(bkc) {
                for (entry, f) in row.iter_mut().zip(other) {
                    *entry = entry.plus(&minus_bk(f), clock)?;
                }
            }
            let Some(entries) = matrix_entries(&m, numbers, clock)? else {
                return Ok(undefined(nowhere, m.len(), poles));
            };
            monic(entries, m.len(), clock)?
        }
        Form::System(whole, alone) => {
            let specialised = |(rows, degree): &Ordered| {
                let parts = |row: &Vec<Multi>| row.iter().map(|m| m.specialised(1, numbers)).collect();
                monic(rows.iter().map(|row| clear_row(parts(row))).collect(), *degree, clock)
            };
            // A block keeps its order, the connection is well posed, where its leading coefficient is not zero.
            for block in alone {
                poles.push(specialised(block)?.1);
            }
            let found = specialised(whole)?;
            poles.push(found.1.clone());
            found
        }
    };
    if denominator.is_zero() {
        return Ok(undefined(nowhere, degree, poles));
    }
    // Over the least common denominator of the coefficients in lowest terms.
    let mut common = denominator.clone();
    for c in &coefficients {
        common = common.gcd(c, clock)?;
    }
    let negative = denominator.leading().is_negative();
    for c in &mut coefficients {
        if !c.is_zero() {
            let scale = c.content();
            let quotient = c.divided(&common, clock)?.ok_or("internal: a gcd does not divide")?;
            *c = quotient.scaled(&if negative { -scale } else { scale });
        }
    }
    coefficients.resize(degree + 1, Uni::default());
    Ok(Characteristic { discrete, degree, coefficients: primitive(coefficients), poles })
}

/// Divided by the greatest common divisor of all integers in it.
pub(super) fn primitive(coefficients: Vec<Uni>) -> Vec<Uni> {
    let g = super::univariate::gcd_of(coefficients.iter().flat_map(|c| c.0.iter()));
    if g.is_zero() || g.is_one() {
        return coefficients;
    }
    coefficients.into_iter().map(|c| Uni(c.0.iter().map(|x| x / &g).collect())).collect()
}

fn undefined(
    nowhere: impl Fn(usize, Vec<Uni>) -> Characteristic,
    degree: usize,
    mut poles: Vec<Uni>,
) -> Characteristic {
    poles.push(Uni::default());
    nowhere(degree, poles)
}

/// The determinant's coefficients with the leading one as denominator.
fn monic(entries: Vec<Vec<Entry>>, degree: usize, clock: &Clock) -> Result<(Vec<Uni>, Uni, usize), String> {
    let coefficients = determinant(&entries, clock)?;
    if coefficients.len() > degree + 1 {
        return Err("a determinant has a higher degree than the model".into());
    }
    let lead = coefficients.get(degree).cloned().unwrap_or_default();
    Ok((coefficients, lead, degree))
}

/// `zQ - N`, where the row denominators `Q` are cleared; `None` when one vanishes identically.
fn matrix_entries(m: &[Vec<Fraction>], numbers: &[Q], clock: &Clock) -> Result<Option<Vec<Vec<Entry>>>, String> {
    let mut out = Vec::new();
    for (i, row) in m.iter().enumerate() {
        let mut parts = Vec::new();
        for f in row {
            let Some(part) = in_parameter(f, numbers, clock)? else { return Ok(None) };
            let common = common_denominator(part.0.iter().chain(&part.1));
            let side = |c: &[Q]| Uni::new(c.iter().map(|q| q.numer() * (&common / q.denom())).collect());
            let (mut n, mut d) = (side(&part.0), side(&part.1));
            if n.is_zero() {
                d = Uni::constant(Z::one());
            }
            // Lowest terms keep the row's denominator small; the places of division are noted already.
            let g = n.gcd(&d, clock)?;
            if g.degree() > 0 {
                let (cn, cd) = (n.content(), d.content());
                let reduced =
                    |p: &Uni| p.divided(&g, clock)?.ok_or_else(|| "internal: a gcd does not divide".to_owned());
                (n, d) = (reduced(&n)?.scaled(&cn), reduced(&d)?.scaled(&cd));
            }
            parts.push((n, d));
        }
        // Least common multiple of the denominators, up to integers.
        let mut common = Uni::constant(Z::one());
        for (_, d) in &parts {
            let g = common.gcd(d, clock)?;
            let rest = d.divided(&g, clock)?.ok_or("internal: a gcd does not divide")?;
            common = common.times(&rest);
        }
        let contents = parts.iter().fold(Z::one(), |l, (_, d)| {
            let c = d.content();
            &l / super::univariate::gcd(&l, &c) * c
        });
        let common = common.scaled(&contents);
        let mut entries = Vec::new();
        for (j, (n, d)) in parts.iter().enumerate() {
            let factor = common.divided(d, clock)?.ok_or("internal: a common multiple is none")?;
            // common = factor d times a rational number, fixed by the leading coefficients.
            let scale = Q::new(common.leading(), factor.leading() * d.leading());
            if !scale.is_integer() {
                return Err("internal: a common multiple is not integral".into());
            }
            let minus = n.times(&factor).scaled(&-scale.to_integer());
            entries.push(if i == j { Entry(vec![minus, common.clone()]) } else { Entry(vec![minus]) });
        }
        out.push(entries);
    }
    Ok(Some(out))
}

/// A row of polynomials in variable 0 and the parameter, cleared of denominators together.
fn clear_row(parts: Vec<Vec<Vec<Q>>>) -> Vec<Entry> {
    let d = common_denominator(parts.iter().flatten().flatten());
    let uni = |c: &Vec<Q>| Uni::new(c.iter().map(|q| q.numer() * (&d / q.denom())).collect());
    parts.iter().map(|entry| Entry(entry.iter().map(uni).collect())).collect()
}

fn product(a: &[Vec<Fraction>], b: &[Vec<Fraction>], clock: &Clock) -> Result<Vec<Vec<Fraction>>, String> {
    let mut out = Vec::new();
    for row in a {
        let mut sums = Vec::new();
        for j in 0..b.first().map_or(0, Vec::len) {
            let mut sum = Fraction::number(&Q::zero());
            for (x, r) in row.iter().zip(b).filter(|(x, r)| !x.numerator.is_zero() && !r[j].numerator.is_zero()) {
                sum = sum.plus(&x.times(&r[j], clock)?, clock)?;
            }
            sums.push(sum);
        }
        out.push(sums);
    }
    Ok(out)
}
