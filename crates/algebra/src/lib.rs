//! Exact algebra: numbers of any size, polynomials, real roots, real algebraic numbers, matrices, budgets.
//!
//! Knows nothing of control. Everything is exact; the floating-point numbers that leave it are for pictures and are
//! named `*_approximate`.
//!
//! | room | what it does |
//! |---|---|
//! | [`limits`] | budgets, cancellation and progress |
//! | [`number`] | exact integers and rationals, parsing, correctly rounded printing, certified enclosures |
//! | [`ball`] | interval arithmetic in fixed point, exponentials of matrices |
//! | [`poly`] | polynomials in one and many variables, gcd, resultants, real root isolation, real algebraic numbers |
//! | [`real`] | real numbers of any kind: algebraic, or known by enclosures of any width |
//! | [`symbols`] | constants such as `exp(-1/2)` as variables of polynomials, with a test for zero |
//! | [`matrix`] | matrices over any domain, determinants, characteristic polynomials |
//!
//! # Budgets
//!
//! Algorithms that name steps take a [`Budget`](limits::Budget); all others ask the one that was entered on their thread:
//!
//! ```
//! use jurist_algebra::limits::Budget;
//! use jurist_algebra::poly::{Domain, UniPoly};
//! let (a, b) = (UniPoly::from_i64(&[-1, 0, 1]), UniPoly::from_i64(&[1, 1]));
//! assert_eq!(Budget::with_work(1_000_000).enter(|| a.gcd(&b)), Ok(b));
//! ```

#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[doc = include_str!("bibliography.md")]
pub mod bibliography {}
pub mod ball;
pub mod limits;
pub mod matrix;
pub mod number;
pub mod poly;
mod precisions;
pub mod real;
pub mod symbols;
