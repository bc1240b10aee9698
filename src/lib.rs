//! Exact stability limits of control loops.
//!
//! For which parameter values is this control loop stable, and how far is it from not being so? `jurist` answers with
//! exact arithmetic from the model's text to the verdict: no tolerance, no sampling and no rounding in between. An answer is
//! a finite union of open intervals whose ends are algebraic numbers, each with its cause.
//!
//! ```
//! use jurist::{Ask, Budget, Model, Source};
//!
//! let text = r#"
//!     time = "discrete"
//!     [parameters]
//!     K = { nominal = 1, min = 0 }
//!     [loop]
//!     characteristic = "z^2 - z + K/2"
//! "#;
//! let (model, _warnings) = Model::from_toml(&Source::new("model.toml", text))?;
//! let answer = model.ask().free("K").stable_set(&Budget::unlimited())?;
//! let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
//! assert_eq!(upper.value.decimal(12), "2");
//! assert_eq!(upper.causes.to_string(), "complex pair");
//! # Ok::<(), jurist::Error>(())
//! ```
//!
//! # The way from text to answer
//!
//! A [`Model`] is what the loop is: read from a text ([`Model::from_toml`]) or built in code ([`Model::builder`]). A
//! [`Question`] begins with [`Ask::ask`]: values ([`Question::set`]), what is free ([`Question::free`]), the region in which
//! all roots have to lie ([`Question::within`]). Resolved it is a [`Problem`], whose algebra is computed once. Each way of
//! asking gives an [`Answer`]:
//!
//! | asked by | answer | what it is |
//! |---|---|---|
//! | [`Question::verdict`] | [`PointVerdict`] | one point: stable, marginal, unstable or undefined, roots counted exactly |
//! | [`Question::stable_set`] | [`StableSet`] | for which values of one parameter the loop is stable |
//! | [`Question::parametric_table`], [`Question::point_table`] | [`ParametricTable`], [`PointTable`] | the table of Jury or Routh, each condition solved for itself |
//! | [`Question::map`] | [`Map`] | the stable regions in the plane of two parameters |
//! | [`Question::margins`] | [`Margins`] | gain, phase, delay, modulus and disk margins of the loop cut at a signal |
//! | [`Question::norm`] | [`Norm`] | the peak gain of a closed-loop transfer function |
//! | [`Question::peak_to_peak`] | [`PeakToPeak`] | how far bounded inputs drive an output |
//! | [`Question::analyze`] | [`Analysis`] | the verdict, and the stable set of each parameter |
//!
//! An answer writes itself for people (trait [`Text`]), for programs (trait [`Document`]), for checkers (trait [`Certificate`]), for Coq (trait [`Theorem`]) and for SMT solvers ([`smt2()`]); [`check()`]
//! re-checks a certificate with code that shares nothing with the engine. Where a certificate is made of boxes, of requirements as of maps, it is written by [`certified`]. What stands in the JSON is said by
//! [`documents`], as types, and by [`schemas`](_documentation::schemas). Everything that takes long takes a [`Budget`].
//!
//! # Why an answer is right
//!
//! The number of stable roots changes only where a root crosses the boundary of the region: at the real zeros of `D(1)`,
//! `D(-1)` and the resultant of the half-size pair in discrete time; of `D(0)`, the resultant and the leading coefficient in
//! continuous time ([`boundary_polynomials`]). These zeros are isolated exactly, one rational number between two neighbours
//! is tested exactly, and the whole gap has its verdict. A second way, the conditions of the Jury or Routh table each
//! solved for itself, is compared with the first whenever a table is asked for.
//!
//! # Features
//!
//! `cli` (default): the program. `png` (default): figures as PNG. `strategies`: proptest generators of polynomials, matrices
//! and loops with exactly known verdicts, for your tests. Without default features the library pulls neither the command
//! line nor the figures.
//!
//! Cited works are listed in the [`bibliography`](_documentation::bibliography); times beside another program in
//! [`performance`](_documentation::performance).

#![forbid(unsafe_code)]
#![deny(missing_docs)]

// The model, the question, the answer.
pub use jurist_engine::answer::{
    Analysis, Answer, Body, BoxRequest, Frequency, Map, MapBoxes, MapLimit, MapMethod, MapOrBoxes, ParametricTable,
    PointTable, PointVerdict, RegionExtent, SliceValues, ToleranceAnswer, ToleranceRequest, Verdict,
};
pub use jurist_engine::problem::{Algebra, Ask, Bound, Free, Problem, Question, Region};
pub use jurist_engine::response::{Extreme, Margins, Norm, OpenLoop, PeakToPeak, Place, Requirement, Value};
pub use jurist_model::error::{Code, Diagnostic, Diagnostics, Error, Label, Severity, Source, Span};
pub use jurist_model::{
    BlockBuilder, ClosedLoop, Constant, Cut, Expression, LoopLine, Model, ModelBuilder, Parameter, ParameterBuilder,
    Time, Tolerance, TransferFunction,
};
pub use jurist_show::notation::Notation;
pub use jurist_show::{Document, Text, documents};
pub use jurist_stability::{
    AlgebraicInterval, Boundary, Cause, Causes, ClassicalTest, ComplexPair, Condition, End, HalfSizePair, IntervalSet,
    JuryTable, ParametricPolynomial, Range, RealInterval, RootCount, RouthTable, Shape, StableInterval, StableSet,
    UndecidedBracket, boundary_polynomials, classical_test, count_roots, is_hurwitz_routh, is_schur_jury, is_stable,
    jury_table, routh_table, stable_set,
};
// Budgets.
pub use jurist_algebra::limits::{Budget, Exhausted, Progress, Stop};
// Exact algebra, as far as questions and answers are made of it.
pub use jurist_algebra::matrix::{
    CharacteristicPolynomial, FaddeevLeVerrier, Matrix, RationalMatrix, faddeev_leverrier,
};
pub use jurist_algebra::number::{Enclosure, Integer, ParseNumberError, Rational, parse_number, to_decimal};
pub use jurist_algebra::poly::{
    Domain, Monomial, MultiPoly, Poly, RationalFunction, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots,
    isolate_real_roots_in,
};
pub use jurist_algebra::real::Real;
// Certificates, checked by code of their own.
pub use jurist_check::{Limits, Proved, Rejection, Step, check};
pub use jurist_prove::{Certificate, Theorem, certified, smt2};

#[cfg(feature = "commands")]
pub mod cli;
#[cfg(feature = "cli")]
mod references;

/// Pages of documentation.
pub mod _documentation {
    #[doc(inline)]
    pub use jurist_algebra::bibliography;
    #[doc(inline)]
    pub use jurist_check::{grammar, proved};
    #[doc(inline)]
    pub use jurist_model::error::code_list;
    #[doc(inline)]
    pub use jurist_model::examples;

    #[doc = include_str!("performance.md")]
    pub mod performance {}

    pub mod schemas;
}

/// Generators of polynomials, matrices and loops with exactly known verdicts, for property tests.
#[cfg(feature = "strategies")]
pub mod strategies {
    pub use jurist_algebra::{matrix::strategies as matrix, number::strategies as number, poly::strategies as poly};
    pub use jurist_stability::strategies as stability;
}
