//! The classical table at a point: its entries and conditions are numbers.

use super::documents::TableKind;
use super::layout::{Columns, called, named_values};
use super::region;
use super::table::{
    entries_text, entry_label, jury_scheme, meanings, order, relative, routh_scheme, scheme, table_name,
};
use crate::Text;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal, to_decimal};
use jurist_engine::answer::{Answer, PointTable, Verdict};
use jurist_engine::problem::Problem;
use jurist_engine::stability::{Comparison, Condition, EnclosedTable, Inequality, ScaledPoly};
use std::cmp::Ordering;

impl Text for Answer<PointTable> {
    /// The table at a point for people.
    fn text(&self, digits: usize) -> String {
        point_table_text(self.problem(), self.value(), digits)
    }
}

/// The table at a point for people.
fn point_table_text(problem: &Problem, answer: &PointTable, digits: usize) -> String {
    let title = called(problem.title());
    let region = region::goal(problem).map(|goal| relative(problem.time(), &goal)).unwrap_or_default();
    let kind = TableKind::from(problem);
    let mut out = format!("{} of {title}{}", table_name(kind), region.trim_end_matches(','));
    if !problem.set().is_empty() {
        out.push_str(&format!(", {}", named_values(problem.set())));
    }
    out.push('\n');
    if let Some(table) = &answer.enclosed {
        out.push_str(&enclosed_text(table, kind, digits));
        out.push_str(&decided_text(enclosed_conditions(table, digits), answer));
        return out;
    }
    let Some(test) = &answer.test else {
        out.push_str("the loop is undefined here\n");
        return out;
    };
    out.push_str(&scheme(test));
    if kind.has_rows() {
        out.push_str(&format!("\nEntries, rounded to {digits} digits (--json has them exactly)\n"));
        out.push_str(&entries_text(test, None, digits));
    }
    out.push_str(&format!("\nConditions\n{}", meanings(kind, order(test))));
    out.push_str(&decided_text(test.conditions.iter().map(|c| decided(c, digits)), answer));
    out
}

/// A condition at a point: its name, its values, and if it holds.
struct Decided<'a> {
    name: &'a str,
    values: String,
    holds: bool,
}

/// A condition between numbers.
fn decided(condition: &Condition, digits: usize) -> Decided<'_> {
    let number = |p: &ScaledPoly| &p.scale * &Rational::from(p.polynomial.coeff(0));
    let (left, right) = match &condition.inequality {
        Inequality::Positive(f) => (number(f), Rational::ZERO),
        // The name says which of them stands on the left.
        Inequality::Dominates { left, right } if condition.name.contains('<') => {
            (number(right).abs(), number(left).abs())
        }
        Inequality::Dominates { left, right } => (number(left).abs(), number(right).abs()),
    };
    let relation = match left.cmp(&right) {
        Ordering::Less => '<',
        Ordering::Equal => '=',
        Ordering::Greater => '>',
    };
    let values = format!("{} {relation} {}", to_decimal(&left, digits), to_decimal(&right, digits));
    Decided { name: &condition.name, values, holds: !condition.solution.intervals().is_empty() }
}

/// The conditions of a table whose entries are enclosed.
fn enclosed_conditions(table: &EnclosedTable, digits: usize) -> impl Iterator<Item = Decided<'_>> {
    table.conditions.iter().map(move |c| {
        let (left, right) = match c.comparison {
            Comparison::Greater => (c.left.clone(), c.right.clone()),
            Comparison::GreaterAbsolute | Comparison::SmallerAbsolute => (absolute(&c.left), absolute(&c.right)),
        };
        let relation = if left.lower() > right.upper() {
            '>'
        } else if left.upper() < right.lower() {
            '<'
        } else {
            '='
        };
        let values = format!("{} {relation} {}", enclosed_number(&left, digits), enclosed_number(&right, digits));
        Decided { name: &c.name, values, holds: c.holds }
    })
}

/// The absolute value of a number that is zero or whose enclosure leaves zero out.
fn absolute(e: &Enclosure) -> Enclosure {
    if e.upper().is_negative() { Enclosure::new(-e.upper(), -e.lower()) } else { e.clone() }
}

fn enclosed_number(e: &Enclosure, digits: usize) -> String {
    let (lo, hi) = (e.lower(), e.upper());
    enclosed_decimal(lo, hi, digits).unwrap_or_else(|| to_decimal(&lo.midpoint(hi), digits))
}

fn decided_text<'a>(conditions: impl Iterator<Item = Decided<'a>>, table: &PointTable) -> String {
    let mut columns = Columns::new("  ");
    for Decided { name, values, holds } in conditions {
        columns.row([name.to_owned(), values, if holds { "holds" } else { "does not hold" }.to_owned()]);
    }
    let verdict = table.verdict.map_or("not stable", Verdict::name);
    columns.row(["all together".to_owned(), String::new(), verdict.to_owned()]);
    columns.to_string()
}

/// A table whose entries are enclosed.
fn enclosed_text(table: &EnclosedTable, kind: TableKind, digits: usize) -> String {
    let lengths = || table.rows.iter().map(|row| row.entries.len());
    let (order, mut out) = match kind {
        TableKind::Jury => {
            let order = lengths().next().unwrap_or(0).saturating_sub(1);
            let rows = table.rows.iter().map(|r| (r.name.clone(), r.entries.len(), r.divided_by.clone()));
            (order, jury_scheme(order, rows))
        }
        TableKind::Routh => {
            let order = lengths().take(2).sum::<usize>().saturating_sub(1);
            (order, routh_scheme(order, lengths()))
        }
        TableKind::SchurCohn | TableKind::Hermite => (table.conditions.len(), String::new()),
    };
    if kind.has_rows() {
        out.push_str(&format!("\nEntries, rounded to {digits} digits (--json has enclosures)\n"));
    }
    for (i, row) in table.rows.iter().enumerate() {
        for (k, entry) in row.entries.iter().enumerate() {
            let decimal = enclosed_number(entry, digits);
            out.push_str(&format!("  {} = {decimal}\n", entry_label(kind, i, &row.name, k)));
        }
    }
    out.push_str(&format!("\nConditions\n{}", meanings(kind, order)));
    out
}
