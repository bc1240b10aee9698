//! The best gains of a loop: which values meet all requirements and make one number as good as it can be.
//!
//! | module | what it is |
//! |---|---|
//! | [`asked`] | which gains are free, within which bounds, and what is to be best |
//! | [`objective`] | the text that says what is to be best |
//! | [`answer`] | the answer: no gains at all, or the optimum and the gains that are typed in |
//! | [`plants`] | for which plants the gains are to be good |
//! | [`document`] | the answer as JSON |
//! | [`decimals`] | the shortest decimal between two numbers |
//!
//! The engine says exactly which values of one or two parameters meet requirements. What is best is an end of such a set, or a *critical value*: between
//! neighbouring critical values of a height, the points of the set above it change by continuity only, so whether there are any does not change.
//! Critical values are roots of leading coefficients, discriminants and resultants of the boundary's polynomials
//! ([Collins1975](jurist_algebra::bibliography#collins1975), [McCallum1998](jurist_algebra::bibliography#mccallum1998)). Where the boundary is not
//! algebraic, and over many gains, the optimum is enclosed between a value that some gains have and one that none have: boxes of gains are cut until no
//! point of any of them can be better (branch and bound).

#![warn(missing_docs)]

pub mod answer;
mod around;
pub mod asked;
pub mod centre;
mod centre_of_one;
mod climb;
mod conflict;
mod critical;
pub mod decimals;
pub mod document;
mod for_all;
mod formula;
mod formula_of_one;
mod level_of_one;
mod lines;
mod many_gains;
mod near;
pub mod objective;
mod one_gain;
mod parts;
pub mod plants;
mod reading;
mod search;
mod seed;
mod sets;
mod target;
mod text;
mod two_gains;
mod typed;
