//! Exact stability limits of control loops.
//!
//! For which parameter values is this control loop stable? `jurist` answers with exact arithmetic from
//! the model's text to the verdict: no tolerance, no sampling and no rounding in between. An answer is a
//! finite union of open intervals whose ends are algebraic numbers, each with its cause.
//!
//! ```
//! use jurist::analysis::{Settings, intervals};
//! use jurist::error::Source;
//! use jurist::limits::Budget;
//! use jurist::model::Loop;
//!
//! let text = r#"
//!     time = "discrete"
//!     [parameters]
//!     K = { nominal = 1, min = 0 }
//!     [loop]
//!     characteristic = "z^2 - z + K/2"
//! "#;
//! let (lp, _warnings) = Loop::from_toml(&Source::new("model.toml", text)).unwrap();
//! let answer = intervals(&lp, &Settings::default(), "K", &Budget::unlimited()).unwrap();
//! let set = answer.stable.decided().unwrap();
//! let upper = set.intervals()[0].upper.as_ref().unwrap();
//! assert_eq!(upper.value.decimal(12), "2");
//! assert_eq!(upper.causes.to_string(), "complex pair");
//! ```
//!
//! # The way from text to answer
//!
//! | room | what it does |
//! |---|---|
//! | [`error`], [`limits`] | diagnostics with places and stable codes; budgets and progress |
//! | [`number`] | exact integers and rationals, parsing, correctly rounded printing, certified enclosures |
//! | [`poly`] | polynomials in one and many variables, gcd, resultants, real root isolation, real algebraic numbers |
//! | [`matrix`] | polynomial matrices, the Faddeev-LeVerrier recursion |
//! | [`stability`] | exact root count, tables of Jury and Routh, boundary polynomials, stable sets, two parameters |
//! | [`model`] | expressions, model files, block diagrams, discretisation |
//! | [`analysis`] | the questions asked of a loop, answered as plain values |
//! | [`simulate`] | responses and root loci in floating point: observations, never verdicts |
//! | [`report`], [`cli`] | text, JSON, code, figures; the command line |
//!
//! # Why an answer is right
//!
//! The number of stable roots changes only where a root crosses the boundary of the region: at the real
//! zeros of `D(1)`, `D(-1)` and the resultant of the half-size pair in discrete time; of `D(0)`, the
//! resultant and the leading coefficient in continuous time ([`stability::boundary_polynomials`]). These
//! zeros are isolated exactly, one rational number between two neighbours is tested exactly, and the whole
//! gap has its verdict. A second way, the conditions of the Jury or Routh table each solved for itself,
//! is compared with the first whenever a table is asked for.
//!
//! Cited works are listed in the [`bibliography`]; times beside another program in [`performance`].

#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[doc(inline)]
pub use jurist_algebra::{bibliography, limits, matrix, number, poly};
#[doc(inline)]
pub use jurist_check as check;
#[cfg(feature = "cli")]
#[doc(inline)]
pub use jurist_draw::{figures, page, simulate};
#[doc(inline)]
pub use jurist_engine::{answer, error, model, problem, prove, show, stability};

#[cfg(feature = "cli")]
pub mod cli;
#[doc = include_str!("performance.md")]
pub mod performance {}
