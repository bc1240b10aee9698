//! Continuous loops with dead time: quasi-polynomials in `s` and `z = exp(-tau s)`.
//!
//! | file | what it decides |
//! |---|---|
//! | [`QuasiPolynomial`] | kind, difference operator, common factors |
//! | `crossing` | where roots can be on the imaginary axis, for any dead time: algebraic numbers |
//! | [`delay_cells`] | all dead times at which a loop is stable |
//! | [`family_cells`] | all values of a parameter that enters anywhere, or of the decay rate, also beside constants that are not rational |
//! | [`gain_cells`] | all values of a parameter at a fixed dead time |
//! | [`PlaneLoop::boxes`] | two parameters, by boxes |
//! | [`count_delayed_roots`] | the roots at one rational dead time, by a certified count of the argument's turns |
//! | [`rightmost_roots`] | the rightmost roots at one rational dead time, and that no other lies right of a line |

mod count;
mod crossing;
mod dyadic;
mod enclosed;
mod family;
mod family_function;
mod family_zeros;
mod fixed_factor;
mod gain;
mod gain_axis;
mod gain_bounds;
mod gain_inverse;
mod gain_points;
mod headings;
mod mikhailov;
mod moving;
mod multiple_zero;
mod over_root;
mod plane;
mod plane_function;
mod plane_walk;
mod quasi_polynomial;
mod rightmost;
mod rightmost_cut;
mod rightmost_disc;
mod rightmost_search;
mod share;
mod stable_set;
mod strip;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_cells;
#[cfg(test)]
mod tests_enclosed;
#[cfg(test)]
mod tests_family;
#[cfg(test)]
mod tests_gain;
#[cfg(test)]
mod tests_plane;
#[cfg(test)]
mod tests_plane_bounds;
#[cfg(test)]
mod tests_rightmost;
mod trigonometric;
mod turn;
mod windows;

pub use count::{DelayCount, count_delayed_roots};
pub use crossing::Crossing;
pub use enclosed::ConstantParts;
pub use family::{FamilyLoop, family_cells};
pub use family_function::Line;
pub use gain::{GainCells, GainLoop, NotSolved, gain_cells};
pub use gain_points::{GainPoint, Happening};
pub use mikhailov::NotCounted;
pub use moving::MovingLoop;
pub use plane::in_shares_of;
pub use plane::{DeadTime, PlaneLoop};
pub use plane_function::{PlaneFunction, Shares};
pub use plane_walk::Known;
pub use quasi_polynomial::{Kind, QuasiPolynomial};
pub use rightmost::{RightmostRoots, rightmost_roots, rightmost_roots_over};
pub use windows::{DelayCells, Never, Switch, delay_cells};
