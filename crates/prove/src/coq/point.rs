//! The text of a file about one point.

use super::statement::{Subject, checked_region, inside, mathcomp, model};
use jurist_engine::problem::{Problem, Region};
use std::fmt::Write;

/// The theorem that the loop is stable, or that it is not.
pub(super) fn text(problem: &Problem, order: usize, subject: Subject, definitions: &str, stable: bool) -> String {
    let what = if stable { "it is stable" } else { "it is not stable" };
    let mut out = model(problem, what, subject, definitions);
    let check = match subject {
        Subject::Coefficients { .. } => "check_coefs_point",
        Subject::Matrix | Subject::Feedback { .. } => "check_matrix_point",
    };
    let (region, closed) = (checked_region(problem.region()), subject.checked(order));
    let _ = writeln!(
        out,
        "Lemma checked : {check} {region} {closed} {stable} = true.\nProof. vm_cast_no_check (eq_refl true). Qed.\n"
    );
    out.push_str(&mathcomp("Real Region Eigenvalues Point"));
    let name = if stable { "stable" } else { "not_stable" };
    out.push_str("(** No parameter is left: the formulas are numbers, read at 0. *)\n");
    let _ = writeln!(out, "Theorem {name} (R : rcfType) :");
    let root = subject.is_root(order, "0");
    let (inside, outside) = (inside(problem.region()), outside(problem.region()));
    let polynomial = matches!(subject, Subject::Coefficients { .. });
    if polynomial {
        out.push_str("  let p : {poly R} := poly_of Model.coefficients 0 in\n");
    }
    let _ = match (polynomial, stable) {
        (false, true) => writeln!(out, "  forall z : R[i],{root} -> {inside}."),
        (false, false) => writeln!(out, "  exists z : R[i],{root} /\\ {outside}."),
        (true, true) => writeln!(out, "  p`_{order} != 0 /\\ forall z : R[i],{root} -> {inside}."),
        (true, false) => writeln!(out, "  p`_{order} = 0 \\/ exists z : R[i],{root} /\\ {outside}."),
    };
    let _ = writeln!(out, "Proof. exact: ({}_{name} R checked). Qed.\n", subject.theorem());
    let _ = writeln!(out, "Print Assumptions {name}.");
    out
}

/// That `z` lies on the boundary of the region or beyond it.
fn outside(region: &Region) -> String {
    let inside = inside(region);
    let (value, bound) = inside.split_once(" < ").expect("inside the region something is smaller");
    format!("{bound} <= {value}")
}
