//! The text of a file: header, model, limits, check, theorem.

use super::formula::{Names, rational};
use super::pieces::{Kind, Limit, Piece, Way};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use jurist_engine::problem::{Bound, Problem, Region};
use std::fmt::Write;

/// What the theorem is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Subject {
    Matrix,
    Feedback { inputs: usize, outputs: usize },
    Coefficients { blocks: bool },
}

impl Subject {
    /// The beginning of the names of the library's theorems.
    pub(super) fn theorem(self) -> &'static str {
        match self {
            Subject::Matrix => "matrix",
            Subject::Feedback { .. } => "feedback",
            Subject::Coefficients { .. } => "poly",
        }
    }

    /// The closed loop as the checker takes it.
    pub(super) fn checked(self, n: usize) -> String {
        match self {
            Subject::Matrix => format!("{n} Model.A"),
            Subject::Feedback { inputs: m, outputs: q } => {
                format!("{n} (feedback {n} {m} {q} Model.A Model.B Model.K Model.C)")
            }
            Subject::Coefficients { .. } => "Model.coefficients".to_owned(),
        }
    }

    /// That `z` is an eigenvalue of the closed loop at `k`, or a root of `p`; with the space or line break before it.
    pub(super) fn is_root(self, n: usize, k: &str) -> String {
        let eigenvalue = "eigenvalue (map_mx (real_complex R)";
        match self {
            Subject::Matrix => format!(" {eigenvalue} (mx {n} {n} Model.A {k})) z"),
            Subject::Feedback { inputs: m, outputs: q } => format!(
                "\n      {eigenvalue} (mx {n} {n} Model.A {k}\n        \
                 - mx {n} {m} Model.B {k} *m mx {m} {q} Model.K {k} *m mx {q} {n} Model.C {k})) z"
            ),
            Subject::Coefficients { .. } => " root (map_poly (real_complex R) p) z".to_owned(),
        }
    }
}

/// That `z` lies in the region.
pub(super) fn inside(region: &Region) -> String {
    match region {
        Region::Disc(Bound::Number(q)) if q.is_one() => "`|z| < 1".to_owned(),
        Region::Disc(Bound::Number(q)) => format!("`|z| < (qr R {})%:C%C", rational(q)),
        Region::HalfPlane(Bound::Number(q)) if q.is_zero() => "complex.Re z < 0".to_owned(),
        Region::HalfPlane(Bound::Number(q)) => format!("complex.Re z < - qr R {}", rational(q)),
        _ => unreachable!("refused before"),
    }
}

/// The region as the checker takes it.
pub(super) fn checked_region(region: &Region) -> String {
    match region {
        Region::Disc(Bound::Number(q)) => format!("(Disc {})", rational(q)),
        Region::HalfPlane(Bound::Number(q)) => format!("(Left {})", rational(q)),
        _ => unreachable!("refused before"),
    }
}

/// The comment at the beginning and the model.
pub(super) fn model(problem: &Problem, what: &str, subject: Subject, definitions: &str) -> String {
    let plain =
        |text: &str| text.replace(['\n', '\r'], " ").replace("(*", "( *").replace("*)", "* )").replace('"', "'");
    let title = plain(problem.title().unwrap_or("A loop"));
    let mut out = format!("(** {title}: {}.\n\n", plain(what));
    let set: Vec<String> = problem.set().iter().map(|(n, v)| format!("{} = {}", plain(n), rational(v))).collect();
    if !set.is_empty() {
        let _ = writeln!(out, "    With {}.", set.join(", "));
    }
    out.push_str(match subject {
        Subject::Matrix => "    The entries are those of the model, as typed; the statement is about the eigenvalues.",
        Subject::Feedback { .. } => {
            "    The entries are those of the model, as typed; the statement is about the eigenvalues of A - B K C."
        }
        Subject::Coefficients { blocks: true } => {
            "    The loop is a block diagram. The statement is about its characteristic polynomial, whose coefficients\n    \
             were computed from the blocks: that they belong to the diagram is not part of the theorem."
        }
        Subject::Coefficients { blocks: false } => {
            "    The statement is about the characteristic polynomial of the model, ordered by powers."
        }
    });
    out.push_str(" *)\n\nFrom Coq Require Import ZArith QArith List.\nFrom Jurist Require Import Compute Entries.\n");
    out.push_str("Import ListNotations.\n\n(** ** The model *)\nModule Model.\nLocal Open Scope expr_scope.\n\n");
    let _ = writeln!(out, "{definitions}End Model.\n");
    out
}

/// Before the theorem.
pub(super) fn mathcomp(library: &str) -> String {
    format!(
        "(** ** The theorem *)\nFrom mathcomp Require Import all_ssreflect all_algebra.\n\
         From mathcomp.real_closed Require Import complex.\n\
         From Jurist Require Import {library}.\nLocal Open Scope ring_scope.\n\n"
    )
}

pub(super) struct File<'a> {
    pub(super) problem: &'a Problem,
    pub(super) order: usize,
    pub(super) subject: Subject,
    pub(super) definitions: String,
    pub(super) names: Names,
    pub(super) parameter: String,
    pub(super) way: &'a Way,
}

/// The columns of a line of a list.
const COLUMNS: usize = 108;

impl File<'_> {
    pub(super) fn text(mut self) -> String {
        let n = self.order;
        let limits: Vec<String> = self.limit_names();
        let what = format!("for which {} it is stable", self.problem.parameter().name);
        let mut out = model(self.problem, &what, self.subject, &self.definitions);
        out.push_str(
            "(** ** The limits: polynomials with integer coefficients, lowest power first, and the way along the\n",
        );
        out.push_str("    parameter's domain that is checked. *)\n");
        for (name, (_, limit)) in limits.iter().zip(&self.way.limits) {
            if let Limit::Root { factor, .. } = limit {
                let _ = writeln!(out, "Definition {name}_factor : poly := [\n{}]%Z.\n", list(&coefficients(factor)));
            }
        }
        let domain = &self.problem.parameter().domain;
        let bound = |q: &Option<Rational>| q.as_ref().map_or("None".to_owned(), |q| format!("Some {}", rational(q)));
        let _ = writeln!(
            out,
            "Definition limits : answer := {{|\n  lower := {}; upper := {}; starts := {};\n  pieces := [{}] |}}%Q.\n",
            bound(&domain.lower),
            bound(&domain.upper),
            self.way.starts,
            indented(&list(&self.pieces(&limits))),
        );
        let check = match self.subject {
            Subject::Coefficients { .. } => "check_coefs",
            Subject::Matrix | Subject::Feedback { .. } => "check_matrix",
        };
        let (region, closed) = (checked_region(self.problem.region()), self.subject.checked(n));
        let check = format!("{check} 8 {region} {closed} limits");
        let _ = writeln!(out, "Lemma checked : {check} = true.\nProof. vm_cast_no_check (eq_refl true). Qed.\n");
        out.push_str(&mathcomp("Real Sound Answer Region Eigenvalues"));
        if self.way.limits.iter().any(|(_, l)| matches!(l, Limit::Root { .. })) {
            out.push_str("(** [only_root F a b x]: F(x) = 0, a < x < b, and F has no other root there. *)\n");
        }
        let _ = writeln!(out, "Theorem stable_set (R : rcfType) :");
        for (name, (_, limit)) in limits.iter().zip(&self.way.limits) {
            if let Limit::Root { low, high, .. } = limit {
                let (low, high) = (rational(low), rational(high));
                let _ = writeln!(out, "  exists {name} : R, only_root {name}_factor {low} {high} {name} /\\");
            }
        }
        let k = &self.parameter;
        let _ = writeln!(out, "  forall {k} : R,{}", self.domain());
        out.push_str(&self.property());
        let _ = writeln!(
            out,
            "    <-> {}.\nProof. exact: ({}_answer R checked). Qed.\n",
            self.set(&limits),
            self.subject.theorem()
        );
        out.push_str("Print Assumptions stable_set.\n");
        out
    }

    /// Lower and upper limit, where there is one of each at most; else numbered.
    fn limit_names(&mut self) -> Vec<String> {
        let count = |kind| self.way.limits.iter().filter(|(k, _)| *k == kind).count();
        let few = count(Kind::Up) <= 1 && count(Kind::Down) <= 1 && count(Kind::Touch) == 0 && {
            let mut kinds = self.way.limits.iter().map(|(k, _)| *k);
            kinds.next() != Some(Kind::Down) || kinds.next().is_none()
        };
        let mut names = Vec::new();
        for (i, (kind, _)) in self.way.limits.iter().enumerate() {
            let name = match kind {
                Kind::Up if few => "lower_limit".to_owned(),
                Kind::Down if few => "upper_limit".to_owned(),
                _ => format!("limit_{}", i + 1),
            };
            names.push(self.names.fresh(&name));
        }
        names
    }

    fn pieces(&self, limits: &[String]) -> Vec<String> {
        let piece = |piece: &Piece| match piece {
            Piece::Along(q) => format!("Along {}", rational(q)),
            Piece::From => "From".to_owned(),
            Piece::Until(q) => format!("Until {}", rational(q)),
            Piece::Limit(kind, i, q) => format!("{kind:?} {}_factor {}", limits[*i], rational(q)),
        };
        self.way.pieces.iter().map(piece).collect()
    }

    fn domain(&self) -> String {
        let (k, domain) = (&self.parameter, &self.problem.parameter().domain);
        match (&domain.lower, &domain.upper) {
            (None, None) => String::new(),
            (Some(a), None) => format!(" {} < {k} ->", real(a)),
            (None, Some(b)) => format!(" {k} < {} ->", real(b)),
            (Some(a), Some(b)) => format!(" {} < {k} < {} ->", real(a), real(b)),
        }
    }

    /// What holds of a stable loop.
    fn property(&self) -> String {
        let (n, k) = (self.order, &self.parameter);
        let (inside, root) = (inside(self.problem.region()), self.subject.is_root(n, k));
        match self.subject {
            Subject::Matrix | Subject::Feedback { .. } => format!("    (forall z : R[i],{root} -> {inside})\n"),
            Subject::Coefficients { .. } => format!(
                "    let p := poly_of Model.coefficients {k} in\n    \
                 (p`_{n} != 0 /\\ forall z : R[i],{root} -> {inside})\n"
            ),
        }
    }

    /// The intervals.
    fn set(&self, names: &[String]) -> String {
        let k = &self.parameter;
        let mut open = self.way.starts.then_some(None);
        let mut out = Vec::new();
        for (name, (kind, limit)) in names.iter().zip(&self.way.limits) {
            let value = match limit {
                Limit::Root { .. } => name.clone(),
                Limit::Rational(q) => real(q),
            };
            if let (Kind::Down | Kind::Touch, Some(low)) = (kind, &open) {
                out.push(match low {
                    None => format!("{k} < {value}"),
                    Some(low) => format!("{low} < {k} < {value}"),
                });
            }
            open = (*kind != Kind::Down).then_some(Some(value));
        }
        match open {
            None => {}
            Some(None) => out.push("true".to_owned()),
            Some(Some(low)) => out.push(format!("{low} < {k}")),
        }
        if out.is_empty() { "False".to_owned() } else { out.join(" \\/ ") }
    }
}

fn real(q: &Rational) -> String {
    if q.is_zero() { "0".to_owned() } else { format!("qr R {}", rational(q)) }
}

fn coefficients(f: &UniPoly) -> Vec<String> {
    f.coeffs().iter().map(ToString::to_string).collect()
}

/// Items on lines of some columns.
fn list(items: &[String]) -> String {
    let mut out = String::new();
    let mut column = 0;
    for (i, item) in items.iter().enumerate() {
        let separator = if i + 1 < items.len() { ";" } else { "" };
        let length = item.len() + separator.len() + 1;
        if i == 0 || column + length > COLUMNS {
            let _ = write!(out, "{}  {item}{separator}", if i == 0 { "" } else { "\n" });
            column = 1 + length;
        } else {
            let _ = write!(out, " {item}{separator}");
            column += length;
        }
    }
    out
}

fn indented(lines: &str) -> String {
    if lines.is_empty() { String::new() } else { lines.lines().map(|line| format!("\n  {line}")).collect() }
}
