//! The classical table: Jury's in discrete time, Routh's in continuous time.

use super::documents::TableKind;
use super::intervals::{domain_text, real_lines, set_lines, undecided_text};
use super::layout::{Columns, called, named_values, wrapped};
use super::notation::{Coefficient, coefficient_text};
use super::region;
use crate::Text;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, parse_number};
use jurist_algebra::poly::UniPoly;
use jurist_engine::answer::{Answer, ParametricTable};
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;
use jurist_engine::stability::{ClassicalTest, Inequality, ScaledPoly, SymbolicTest, Table, UNDIVIDED_ORDER, row_name};

/// Characters per line of a printed table.
const WIDTH: usize = 100;

/// One row of the table as it is written: its name, entries, and what it was divided by.
pub(super) struct Row {
    pub name: String,
    pub entries: Vec<ScaledPoly>,
    pub divided_by: Option<String>,
}

/// The rows with their scale factors applied.
pub(super) fn rows(test: &ClassicalTest) -> Vec<Row> {
    let scaled = |p: &UniPoly, i: usize| ScaledPoly {
        scale: test.scales.get(i).cloned().unwrap_or(Rational::ONE),
        polynomial: p.clone(),
    };
    match &test.table {
        Table::Jury(table) => {
            let row = |(i, row): (usize, &jurist_engine::stability::JuryRow<UniPoly>)| Row {
                name: row_name(i),
                entries: row.entries.iter().map(|p| scaled(p, i)).collect(),
                divided_by: row.divisor.as_ref().map(|_| format!("{}_0", row_name(i - 2))),
            };
            table.rows.iter().enumerate().map(row).collect()
        }
        Table::Routh(table) => {
            let n = order(test);
            let row = |(i, row): (usize, &Vec<UniPoly>)| Row {
                name: format!("s^{}", n.saturating_sub(i)),
                entries: row.iter().map(|p| scaled(p, i)).collect(),
                divided_by: None,
            };
            table.rows.iter().enumerate().map(row).collect()
        }
        Table::Hermitian(_) => Vec::new(),
    }
}

/// The degree the table was built for.
pub(super) fn order(test: &ClassicalTest) -> usize {
    match &test.table {
        Table::Jury(table) => table.rows.first().map_or(0, |r| r.entries.len().saturating_sub(1)),
        Table::Routh(table) => {
            let (first, second) = (table.rows.first().map_or(0, Vec::len), table.rows.get(1).map_or(0, Vec::len));
            (first + second).saturating_sub(1)
        }
        Table::Hermitian(order) => *order,
    }
}

/// Rational coefficients from the constant term up.
pub(super) fn coefficients(p: &ScaledPoly) -> Vec<Rational> {
    p.polynomial.coeffs().iter().map(|c| &p.scale * &Rational::from(c)).collect()
}

impl Text for Answer<ParametricTable> {
    /// The table, its conditions and their solutions for people.
    fn text(&self, digits: usize) -> String {
        table_text(self.problem(), Ok(self.value()), digits)
    }
}

/// `Jury table`, `Schur-Cohn conditions`.
pub(super) fn table_name(kind: TableKind) -> String {
    format!("{} {}", kind.name(), if kind.has_rows() { "table" } else { "conditions" })
}

/// The table, its conditions and their solutions for people, also of a table that the budget did not allow.
pub fn table_text(problem: &Problem, answer: Result<&ParametricTable, &Exhausted>, digits: usize) -> String {
    let name = &problem.parameter().name;
    let mut out = heading(problem);
    let table = match answer {
        Err(stopped) => {
            out.push_str(&format!("{}\n", undecided_text(stopped)));
            return out;
        }
        Ok(table) => table,
    };
    if let Some(test) = &table.enclosed {
        out.push_str(&symbolic_text(test, problem.into(), name, digits));
        return out;
    }
    let Some(test) = &table.test else {
        out.push_str(&format!("the loop is undefined for every {name}\n"));
        return out;
    };
    out.push_str(&scheme(test));
    if let Some(factor) = &test.cleared_by {
        let factor = ScaledPoly { scale: Rational::ONE, polynomial: factor.clone() };
        let text = entry_text(&factor, Some(name), digits);
        out.push_str(&format!("coefficients multiplied by {text}\n"));
    }
    let kind = TableKind::from(problem);
    if kind.has_rows() {
        out.push_str(&format!("\nEntries, rounded to {digits} digits (--json has them exactly)\n"));
        out.push_str(&entries_text(test, Some(name), digits));
    }
    out.push_str(&format!("\nConditions, each with its exact solution set\n{}", meanings(kind, order(test))));
    if !kind.has_rows() {
        let minors = test.conditions.iter().filter_map(|c| match &c.inequality {
            Inequality::Positive(minor) => Some(entry_text(minor, Some(name), digits)),
            Inequality::Dominates { .. } => None,
        });
        out.push_str(&minors_text(minors, digits, "them exactly"));
    }
    out.push_str(&conditions_text(test, name, digits));
    out
}

fn heading(problem: &Problem) -> String {
    let (title, free) = (called(problem.title()), problem.parameter());
    let region = region::goal(problem).map(|goal| relative(problem.time(), &goal)).unwrap_or_default();
    let mut line = format!("{} of {title}{region} in {}", table_name(problem.into()), free.name);
    if !problem.set().is_empty() {
        line.push_str(&format!(", {}", named_values(problem.set())));
    }
    let domain = domain_text(&free.name, &free.domain);
    if domain != "all" {
        line.push_str(&format!(", asked: {domain}"));
    }
    line.push('\n');
    line
}

/// What the table is of when a smaller region is asked for.
pub(super) fn relative(time: Time, goal: &str) -> String {
    match time {
        Time::Discrete => format!(" for {goal} (roots divided by the radius),"),
        Time::Continuous => format!(" for {goal} (roots shifted by the decay rate),"),
    }
}

/// The conditions with their solutions, and what they have in common.
fn conditions_text(test: &ClassicalTest, name: &str, digits: usize) -> String {
    let sets = test.conditions.iter().map(|c| (c.name.as_str(), &c.solution));
    let sets = sets.chain([("all together", &test.intersection)]);
    solutions_text(sets.map(|(label, set)| (label, set_lines(name, set, digits))))
}

fn solutions_text<'a>(solutions: impl Iterator<Item = (&'a str, Vec<String>)>) -> String {
    let mut columns = Columns::new("  ");
    for (label, mut lines) in solutions {
        if lines.is_empty() {
            lines.push("nowhere".to_owned());
        }
        for (i, line) in lines.into_iter().enumerate() {
            let (label, or) = if i == 0 { (label, "") } else { ("", "or") };
            columns.row([label.to_owned(), or.to_owned(), line]);
        }
    }
    columns.to_string()
}

/// A table in one parameter whose coefficients are enclosed.
fn symbolic_text(test: &SymbolicTest, kind: TableKind, name: &str, digits: usize) -> String {
    let mut out = match kind {
        TableKind::Jury => {
            jury_scheme(test.order, test.rows.iter().map(|r| (r.name.clone(), r.entries.len(), r.divided_by.clone())))
        }
        TableKind::Routh => routh_scheme(test.order, test.rows.iter().map(|r| r.entries.len())),
        TableKind::SchurCohn | TableKind::Hermite => String::new(),
    };
    if let Some(factor) = &test.cleared_by {
        out.push_str(&format!("coefficients multiplied by {}\n", enclosed_polynomial(factor, name, digits)));
    }
    if kind.has_rows() {
        out.push_str(&format!("\nEntries, rounded to {digits} digits (--json has enclosures)\n"));
    }
    let mut is_open = false;
    for (i, row) in test.rows.iter().enumerate() {
        for (k, entry) in row.entries.iter().enumerate() {
            let label = entry_label(kind, i, &row.name, k);
            let text = format!("{label} = {}", enclosed_polynomial(entry, name, digits));
            out.push_str(&format!("  {}\n", wrapped(&text, WIDTH - 2, "      ")));
            is_open |= entry.iter().any(is_not_told);
        }
    }
    if is_open {
        out.push_str("  (coefficients that are not told from zero are left out)\n");
    }
    out.push_str(&format!("\nConditions, each with its exact solution set\n{}", meanings(kind, test.order)));
    if !kind.has_rows() {
        let minors = test.conditions.iter().map(|c| enclosed_polynomial(&c.left, name, digits));
        out.push_str(&minors_text(minors, digits, "enclosures"));
    }
    let sets = test.conditions.iter().map(|c| (c.name.as_str(), &c.solution));
    let sets = sets.chain([("all together", &test.intersection)]);
    out.push_str(&solutions_text(sets.map(|(label, set)| (label, real_lines(name, set, digits)))));
    out
}

/// Whether zero is inside, and other numbers.
fn is_not_told(e: &Enclosure) -> bool {
    e.lower() != e.upper() && e.contains(&Rational::ZERO)
}

/// A polynomial in the parameter with enclosed coefficients, rounded.
fn enclosed_polynomial(p: &[Enclosure], name: &str, digits: usize) -> String {
    let rounded = |e: &Enclosure| {
        let (lo, hi) = (e.lower(), e.upper());
        let decimal = enclosed_decimal(lo, hi, digits).and_then(|text| parse_number(&text).ok());
        decimal.unwrap_or_else(|| lo.midpoint(hi))
    };
    let told = p.iter().enumerate().rev().filter(|(_, e)| !is_not_told(e));
    let terms = told.map(|(k, e)| (vec![k as u32], rounded(e))).filter(|(_, c)| !c.is_zero());
    let coefficient = Coefficient { numerator: terms.collect(), denominator: None };
    coefficient_text(&coefficient, &[name.to_owned()], Some(digits))
}

/// `b_1`, or in Routh's table `r_1,1`.
pub(super) fn entry_label(kind: TableKind, row: usize, name: &str, k: usize) -> String {
    match kind {
        TableKind::Routh => format!("r_{row},{k}"),
        _ => format!("{name}_{k}"),
    }
}

/// The minors of a loop with complex coefficients.
fn minors_text(minors: impl Iterator<Item = String>, digits: usize, in_json: &str) -> String {
    let mut out = format!("  rounded to {digits} digits (--json has {in_json})\n");
    for (k, minor) in minors.enumerate() {
        out.push_str(&format!("  {}\n", wrapped(&format!("H_{} = {minor}", k + 1), WIDTH - 2, "      ")));
    }
    out + "\n"
}

/// What the names in the conditions mean.
pub(super) fn meanings(kind: TableKind, order: usize) -> String {
    match (kind, order) {
        (TableKind::Routh, _) => {
            "  (H_k is the first entry r_k,0 of row k, the Hurwitz determinant of order k)\n".to_owned()
        }
        (TableKind::SchurCohn, _) => {
            "  (H_k is the leading principal minor of order k of the Hermitian matrix of Schur and Cohn)\n".to_owned()
        }
        (TableKind::Hermite, _) => {
            "  (H_k is the leading principal minor of order k of Hermite's matrix, the highest powers of s first)\n"
                .to_owned()
        }
        (TableKind::Jury, 0) => "  (Q = a_0 is the characteristic polynomial)\n".to_owned(),
        (TableKind::Jury, 1) => "  (Q(z) = a_1*z + a_0 is the characteristic polynomial)\n".to_owned(),
        (TableKind::Jury, n) => {
            let between = if n > 2 { "... + " } else { "" };
            format!("  (Q(z) = a_{n}*z^{n} + {between}a_1*z + a_0 is the characteristic polynomial)\n")
        }
    }
}

/// The arrangement of the rows by their names, as textbooks print it.
pub(super) fn scheme(test: &ClassicalTest) -> String {
    let n = order(test);
    match &test.table {
        Table::Jury(_) => jury_scheme(n, rows(test).into_iter().map(|r| (r.name, r.entries.len(), r.divided_by))),
        Table::Routh(table) => routh_scheme(n, table.rows.iter().map(Vec::len)),
        Table::Hermitian(_) => String::new(),
    }
}

/// Of Routh's rows by their lengths.
pub(super) fn routh_scheme(n: usize, lengths: impl Iterator<Item = usize>) -> String {
    let mut columns = Columns::new("  ");
    for (i, length) in lengths.enumerate() {
        let names = (0..length).map(|k| format!("r_{i},{k}"));
        columns.row([i.to_string(), format!("s^{}", n.saturating_sub(i))].into_iter().chain(names));
    }
    format!("\n{columns}")
}

/// Of Jury's rows: their names, lengths, and what they were divided by.
pub(super) fn jury_scheme(n: usize, rows: impl Iterator<Item = (String, usize, Option<String>)>) -> String {
    let mut columns = Columns::new("  ");
    let mut divided = Vec::new();
    columns.row(std::iter::once("row".to_owned()).chain((0..=n).map(|k| format!("z^{k}"))));
    let mut number = 0;
    let mut numbered = |names: Vec<String>| {
        number += 1;
        columns.row(std::iter::once(format!("{number}")).chain(names));
    };
    for (name, length, divided_by) in rows {
        let names: Vec<String> = (0..length).map(|k| format!("{name}_{k}")).collect();
        // The last row of the table stands alone.
        if length > 3 || n < 3 {
            numbered(names.clone());
            numbered(names.into_iter().rev().collect());
        } else {
            numbered(names);
        }
        divided.extend(divided_by.map(|by| format!("row {name} by {by}")));
    }
    let mut out = format!("\n{columns}");
    if !divided.is_empty() {
        let text =
            format!("above order {UNDIVIDED_ORDER} rows are divided by their known factors: {}", divided.join(", "));
        out.push_str(&format!("  {}\n", wrapped(&text, WIDTH - 2, "    ")));
    }
    out
}

pub(super) fn entries_text(test: &ClassicalTest, name: Option<&str>, digits: usize) -> String {
    let mut out = String::new();
    let is_routh = matches!(test.table, Table::Routh(_));
    for (i, row) in rows(test).into_iter().enumerate() {
        for (k, entry) in row.entries.iter().enumerate() {
            let label = if is_routh { format!("r_{i},{k}") } else { format!("{}_{k}", row.name) };
            let text = format!("{label} = {}", entry_text(entry, name, digits));
            out.push_str(&format!("  {}\n", wrapped(&text, WIDTH - 2, "      ")));
        }
    }
    out
}

/// A polynomial in the parameter with rounded coefficients.
fn entry_text(p: &ScaledPoly, name: Option<&str>, digits: usize) -> String {
    let list = coefficients(p);
    let terms = list.into_iter().enumerate().rev().filter(|(_, c)| !c.is_zero());
    let numerator = terms.map(|(k, c)| (vec![k as u32], c)).collect();
    let names = [name.unwrap_or("x").to_owned()];
    coefficient_text(&Coefficient { numerator, denominator: None }, &names, Some(digits))
}
