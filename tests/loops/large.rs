//! Loops of high order: they answer, or they stop when they are told to and say what they had reached.

use crate::helpers::budget::{cancelled_at, endless_model};
use crate::helpers::model::load;
use jurist::Ask;
use jurist_algebra::limits::{Budget, Stop};
use jurist_engine::error::{Error, Source};
use jurist_engine::model::Model;
use std::fmt::Write;

/// The drive with `filters` first-order filters in its current feedback, as one matrix: order `6 + filters`.
fn filtered_drive(filters: usize) -> Model {
    let n = 6 + filters;
    let mut m = vec![vec!["0".to_string(); n]; n];
    let feedback = if filters == 0 { 0 } else { n - 1 };
    for (i, j, entry) in [
        (0, 0, "1 - R_a*T/L_a"),
        (0, 1, "-K_a*T/L_a"),
        (0, 2, "10*K*T/(L_a*12)"),
        (0, 3, "500*K*T/(L_a*12)"),
        (1, 0, "K_a*T/J"),
        (1, 1, "1 - B_v*T/J"),
        (2, 4, "1"),
        (2, 5, "5"),
        (3, 2, "T/2"),
        (3, 3, "1"),
        (3, 4, "T/2"),
        (3, 5, "5*T/2"),
        (4, 1, "-1"),
        (5, 1, "-T/2"),
        (5, 4, "T/2"),
        (5, 5, "1"),
        (2, feedback, "-1"),
        (3, feedback, "-T/2"),
    ] {
        m[i][j] = entry.into();
    }
    for f in 0..filters {
        m[6 + f][if f == 0 { 0 } else { 5 + f }] = "3/10".into();
        m[6 + f][6 + f] = "7/10".into();
    }
    let mut text = String::from(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nR_a = 1\nL_a = 46e-3\nJ = 0.093\nB_v = 0.008\nK_a = 0.55\n\
         [parameters]\nK = { nominal = 110, min = 0 }\nT = { nominal = 1e-4, min = 0 }\n[loop]\nmatrix = [\n",
    );
    for row in m {
        let _ = writeln!(text, "  [{}],", row.iter().map(|e| format!("'{e}'")).collect::<Vec<_>>().join(", "));
    }
    text += "]\n";
    Model::from_toml(&Source::new("filters.toml", text)).unwrap_or_else(|e| panic!("{e}")).0
}

#[test]
fn without_filters_it_is_the_drive() {
    let answer = filtered_drive(0).ask().free("K").stable_set(&Budget::unlimited()).unwrap();
    let set = answer.value();
    assert_eq!(set.intervals()[0].lower.as_ref().unwrap().value.decimal(12), "0.0381005333483");
    assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.decimal(12), "550.941166687");
}

#[test]
fn order_twenty_with_two_parameters() {
    let lp = filtered_drive(14);
    for parameter in ["K", "T"] {
        let budget = Budget::unlimited();
        let answer = lp.ask().free(parameter).stable_set(&budget).unwrap();
        let (problem, set) = (answer.problem(), answer.value());
        assert_eq!(set.intervals().len(), 1, "{parameter}");
        // The sample in the middle is stable, the ends are not, by the exact count.
        let p = problem.parametric(&budget).unwrap().unwrap();
        let bare = set.to_interval_set().unwrap();
        let i = &bare.intervals()[0];
        assert!(p.is_stable_at(&i.sample(), problem.shape()));
    }
}

/// Stopped when a step begins: the answer says which.
#[test]
fn order_two_hundred_stops_where_it_is_cancelled() {
    let lp = filtered_drive(194);
    let step = "characteristic polynomial";
    let budget = cancelled_at(step);
    match lp.ask().free("K").stable_set(&budget) {
        Err(Error::Stopped(stopped)) => {
            assert_eq!((stopped.stop, stopped.step.as_str()), (Stop::Cancelled, step))
        }
        Err(refused) => panic!("{refused}"),
        Ok(answer) => panic!("{:?}", answer.value()),
    }
}

#[test]
fn work_without_end_stops_where_it_is_cancelled() {
    let lp = load(&endless_model());
    let step = "boundary polynomials";
    match lp.ask().free("K").stable_set(&cancelled_at(step)) {
        Err(Error::Stopped(stopped)) => {
            assert_eq!((stopped.stop, stopped.step.as_str()), (Stop::Cancelled, step));
        }
        other => panic!("{other:?}"),
    }
}
