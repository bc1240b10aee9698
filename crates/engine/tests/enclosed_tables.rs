//! Jury's table over constants.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_engine::model::{Model, Time};
use jurist_engine::problem::Ask;
use jurist_engine::stability::EnclosedTable;

fn table(characteristic: &str) -> Option<EnclosedTable> {
    let (model, _) = Model::builder(Time::Discrete).characteristic(characteristic).build().unwrap();
    let budget = Budget::unlimited();
    let p = model.ask().problem().unwrap().symbolic(&budget).unwrap().unwrap();
    p.jury_table(12, &budget).unwrap()
}

#[test]
fn rows_are_those_of_the_textbook() {
    // a = [X, 0, 1/2, 1] with X = exp(-1): b_k = X a_k - a_(3 - k).
    let table = table("z^3 + z^2/2 + exp(-1)").unwrap();
    let x = (-1f64).exp();
    let value = |e: &Enclosure| e.lower().midpoint(e.upper()).to_f64_approximate();
    let b: Vec<f64> = table.rows[1].entries.iter().map(value).collect();
    for (found, exact) in b.iter().zip([x * x - 1.0, -0.5, 0.5 * x]) {
        assert!((found - exact).abs() < 1e-12, "{b:?}");
    }
    let names: Vec<&str> = table.conditions.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["Q(1) > 0", "(-1)^3*Q(-1) > 0", "|a_0| < a_3", "|b_0| > |b_2|"]);
    assert!(table.holds());
}

#[test]
fn a_root_at_one_is_seen_by_an_identity() {
    let table = table("z^2 - (1 + exp(-1))*z + exp(-1)").unwrap();
    let first = &table.conditions[0];
    assert!(!first.holds && first.left.lower().is_zero() && first.left.upper().is_zero());
    assert!(table.conditions[1..].iter().all(|c| c.holds) && !table.holds());
}

/// `b_1 = X/2 - X/2` is zero by an identity; it was taken for a number that more bits would tell from zero.
#[test]
fn a_zero_entry_of_a_row_does_not_hide_the_table() {
    let table = table("z^3 + exp(-1)/2*z^2 + z/2 + exp(-1)").unwrap();
    let entry = &table.rows[1].entries[1];
    assert!(entry.lower().is_zero() && entry.upper().is_zero());
    assert!(table.holds() && !table.rows[1].entries[0].contains(&Rational::ZERO));
}

#[test]
fn tables_agree_with_counts_also_above_the_order_where_rows_are_divided() {
    for (radius, order) in [("1/2", 3), ("9/10", 5), ("11/10", 5), ("4/5", 10), ("6/5", 10)] {
        // Roots on a circle around 0, and one at exp(-1).
        let text = format!("(z - exp(-1))*(z^{} + ({radius})^{})", order - 1, order - 1);
        let found = table(&text).unwrap();
        assert_eq!(found.holds(), !radius.starts_with("11") && !radius.starts_with('6'), "{text}");
        assert_eq!(found.rows.iter().any(|r| r.divided_by.is_some()), order > 8, "{text}");
    }
}
