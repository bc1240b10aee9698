//! Coefficient rings: what the coefficients of a characteristic function are made of.

use super::Asked;
use super::refusals::{DEAD_TIME, FUNCTIONS};
use crate::error::Diagnostic;
use crate::model::Symbols;

/// What the coefficients of the characteristic function are made of, seen from the names that a question leaves free.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::coverage::CoefficientRing;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let problem = Model::drive().ask().free("K_pwm").problem()?;
/// assert_eq!(problem.coefficient_ring(&Budget::unlimited())?, CoefficientRing::Rational);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CoefficientRing {
    /// Rational functions of the free names.
    Rational,
    /// Beside them transcendental or algebraic constants, such as `exp(-1/10)` behind a hold, or `sqrt(2)`.
    Constants,
    /// Functions of the free names, such as `exp(-T)` where the sample time is free.
    Functions,
    /// Dead time in continuous time: powers of `exp(-tau s)`.
    DeadTime,
    /// Dead time in continuous time, beside constants that are not rational.
    DeadTimeBesideConstants,
    /// Dead time in continuous time, beside functions of the free names.
    DeadTimeBesideFunctions,
    /// Behind a hold, a dead time of no fixed number of samples: the order of the loop depends on the free names.
    VaryingOrder,
}

impl CoefficientRing {
    /// All of them, in the order of the table's columns.
    pub const ALL: [CoefficientRing; 7] = [
        CoefficientRing::Rational,
        CoefficientRing::Constants,
        CoefficientRing::Functions,
        CoefficientRing::DeadTime,
        CoefficientRing::DeadTimeBesideConstants,
        CoefficientRing::DeadTimeBesideFunctions,
        CoefficientRing::VaryingOrder,
    ];

    /// Its name in documents and in the table's heads.
    pub fn name(self) -> &'static str {
        match self {
            CoefficientRing::Rational => "rational",
            CoefficientRing::Constants => "constants",
            CoefficientRing::Functions => "functions",
            CoefficientRing::DeadTime => "dead time",
            CoefficientRing::DeadTimeBesideConstants => "dead time beside constants",
            CoefficientRing::DeadTimeBesideFunctions => "dead time beside functions",
            CoefficientRing::VaryingOrder => "varying order",
        }
    }

    /// What it is, for people.
    pub fn words(self) -> &'static str {
        match self {
            CoefficientRing::Rational => "rational functions of the free names",
            CoefficientRing::Constants => {
                "constants that are not rational, such as exp(-1/10) behind a hold, or sqrt(2)"
            }
            CoefficientRing::Functions => "functions of a free name, such as exp(-T) where the sample time is free",
            CoefficientRing::DeadTime => "powers of exp(-tau s): dead time in continuous time",
            CoefficientRing::DeadTimeBesideConstants => {
                "powers of exp(-tau s), beside constants that are not rational, such as pi or sqrt(2)"
            }
            CoefficientRing::DeadTimeBesideFunctions => "powers of exp(-tau s), beside functions of a free name",
            CoefficientRing::VaryingOrder => {
                "behind a hold, a dead time of no fixed number of samples: the order depends on the free names"
            }
        }
    }

    /// The ring of a loop with these symbols.
    pub fn of(symbols: &Symbols) -> CoefficientRing {
        let (all, delays) = (symbols.iter().count(), symbols.delays().len());
        match (all, delays) {
            (0, _) => CoefficientRing::Rational,
            (_, 0) if symbols.is_moving() => CoefficientRing::Functions,
            (_, 0) => CoefficientRing::Constants,
            (all, delays) if all > delays => match symbols.iter().any(|s| s.is_moving && !s.is_delay()) {
                true => CoefficientRing::DeadTimeBesideFunctions,
                false => CoefficientRing::DeadTimeBesideConstants,
            },
            _ => CoefficientRing::DeadTime,
        }
    }

    /// The refusal of a question that is asked of rational loops only.
    pub(crate) fn not_rational(self, symbols: &Symbols) -> Diagnostic {
        let known = Asked::known_over(self);
        if !symbols.delays().is_empty() {
            return DEAD_TIME.diagnostic(&[("known", &known)]);
        }
        let list: Vec<String> =
            symbols.definitions().iter().take(4).map(|(name, text)| format!("{name} = {text}")).collect();
        FUNCTIONS.diagnostic(&[("known", &known), ("symbols", &list.join(", "))])
    }
}
