//! What transcendental numbers are roots of.

use super::number::{Enclosure, Exact, Named, enclosure};
use jurist_algebra::real::{Origin, Real};
use serde::{Deserialize, Serialize};

/// What a transcendental number is a root of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Over {
    /// A polynomial over constants.
    Symbols {
        /// The constants and their definitions.
        symbols: Named<String>,
        /// The polynomial's coefficients, from the constant term up, as expressions in the constants.
        polynomial: Vec<String>,
    },
    /// A function.
    Function {
        /// Its name.
        function: String,
        /// What else there is to say.
        #[serde(flatten)]
        details: Named<String>,
    },
    /// A dead time `(theta + 2 pi k)/omega` at which a pair of roots is at `+-i omega`.
    Crossing {
        /// The square of the angular frequency.
        omega2: AlgebraicPlace,
        /// Bounds of the angle in `[0, 2 pi)`.
        theta: Enclosure,
        /// The number of turns.
        k: u64,
        /// `+` where the pair leaves the stable side, `-` where it comes back, `0` where it only touches.
        direction: String,
    },
}

/// An algebraic number by its polynomial and bounds between which it is the only root.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AlgebraicPlace {
    /// Coefficients from the constant term up.
    pub polynomial: Vec<Exact>,
    /// Lower and upper bound.
    pub enclosure: Enclosure,
}

impl Over {
    /// `None` for an algebraic number.
    pub(super) fn of(value: &Real) -> Option<Over> {
        let Real::Transcendental(x) = value else { return None };
        Some(match x.origin() {
            Origin::Symbols { symbols, polynomial } => {
                Over::Symbols { symbols: symbols.into_iter().collect(), polynomial }
            }
            Origin::Crossing { omega_squared, theta, turns, leaves } => {
                let (lo, hi) = omega_squared.enclosure();
                let omega2 = AlgebraicPlace {
                    polynomial: Exact::coefficients(omega_squared.polynomial()),
                    enclosure: enclosure(&lo, &hi),
                };
                let direction = match leaves {
                    Some(true) => "+",
                    Some(false) => "-",
                    None => "0",
                };
                let theta = enclosure(theta.lower(), theta.upper());
                Over::Crossing { omega2, theta, k: turns, direction: direction.to_owned() }
            }
            Origin::Function { function, details } => {
                Over::Function { function, details: details.into_iter().collect() }
            }
            _ => return None,
        })
    }
}
