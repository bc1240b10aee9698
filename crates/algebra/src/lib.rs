//! Exact algebra: numbers of any size, polynomials, real roots, real algebraic numbers, matrices, budgets.
//!
//! Knows nothing of control. Everything is exact; the floating-point numbers that leave it are for pictures and are
//! named `*_approximate`.
//!
//! | room | what it does |
//! |---|---|
//! | [`limits`] | budgets, cancellation and progress |
//! | [`number`] | exact integers and rationals, parsing, correctly rounded printing, certified enclosures |
//! | [`poly`] | polynomials in one and many variables, gcd, resultants, real root isolation, real algebraic numbers |
//! | [`matrix`] | polynomial matrices, the Faddeev-LeVerrier recursion |

#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[doc = include_str!("bibliography.md")]
pub mod bibliography {}
pub mod limits;
pub mod matrix;
pub mod number;
pub mod poly;
