//! Any number of parameters: boxes of tolerances, proved stable or refuted by a point.
//!
//! The polynomial on the imaginary axis is a pair `(E, O)` of polynomials in the square of the frequency and the parameters. One
//! tensor of Bernstein coefficients over all of them is halved, frequency first, until each cell has its coefficients on one
//! side of a line through zero: then no root crosses the axis anywhere in the box. A parameter is halved only as far as the
//! values are not affine in it ([ZettlerGarloff1998](jurist_algebra::bibliography#zettlergarloff1998),
//! [Farouki2012](jurist_algebra::bibliography#farouki2012)).

mod bracketing;
mod by_signs;
mod critical;
mod delayed;
mod delayed_look;
mod delayed_prove;
mod delayed_rounded;
mod determinants;
mod exact;
mod exact_signs;
mod factor;
mod families;
mod family;
mod intervals;
mod largest;
mod line;
mod look;
mod moving;
mod moving_look;
mod moving_prove;
mod multiplier;
mod parts;
mod polynomial;
mod prove;
mod range;
mod reason;
mod rough;
mod scores;
mod search;
mod separate;
mod sides;
mod tangent;
mod tensor;
mod tree;
mod volume;
mod window;

pub use critical::CriticalCell;
pub use delayed::DelayedFunction;
pub use exact::{Cover, ExactProof, Place};
pub use factor::{BoxDecision, ToleranceProblem};
pub use family::{Family, Gradient, Path};
pub use intervals::open_parts;
pub use largest::{LargestFactor, Witness};
pub use line::on_line;
pub use look::{BoxLook, same_count};
pub use moving::MovingPolynomial;
pub use moving_look::MovingLooks;
pub use parts::corners;
pub use polynomial::BoxPolynomial;
pub use prove::{BoxProof, MOST_COEFFICIENTS, Outcome};
pub use range::range_over;
pub use reason::OpenReason;
pub use search::{Search, ray};
pub use sides::Side;
pub use tree::Tree;
pub use volume::{BoxVolume, MOST_PARAMETERS};
