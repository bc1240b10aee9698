//! How a number that is to be best is shown: a gain as itself, a level by its scale, a decay or a radius as the settling time that it gives.

use crate::asked::{Asked, Objective};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use jurist_engine::response::Level;
use jurist_show::real::{enclosed, rounded};

/// The name of the settling time, as that of the requirement.
pub(crate) const SETTLING_TIME: &str = "settling_time";

/// All modes have decayed by the exponential of this over a settling time.
const DECADES: i64 = 4;

/// What the numbers of an answer are.
#[derive(Clone, Debug)]
pub(crate) enum Reading {
    /// Of a gain, or of an expression.
    Plain,
    /// Of a level, in its scale.
    Level(Level),
    /// Of a decay, or of a radius over a sample time: shown as a settling time.
    Settling { sample_time: Option<Rational> },
}

impl Reading {
    pub fn of(asked: &Asked) -> Reading {
        match &asked.objective {
            Objective::Level(level) => Reading::Level(*level),
            Objective::Norm(_) => Reading::Level(Level::Norm),
            Objective::SettlingTime(_) => Reading::Settling { sample_time: asked.sample_time.clone() },
            Objective::Greatest(_)
            | Objective::Least(_)
            | Objective::Formula { .. }
            | Objective::Tolerance(_)
            | Objective::Anything => Reading::Plain,
        }
    }

    /// The name of the level.
    pub fn name(&self) -> &'static str {
        match self {
            Reading::Plain => "",
            Reading::Level(level) => level.name(),
            Reading::Settling { .. } => SETTLING_TIME,
        }
    }

    /// Whether more of it is better; of gains it is not known here.
    pub fn is_greatest_best(&self) -> bool {
        match self {
            Reading::Level(level) => level.is_greatest_best(),
            Reading::Settling { .. } => false,
            Reading::Plain => true,
        }
    }

    pub fn unit(&self) -> &'static str {
        if matches!(self, Reading::Level(Level::PhaseMargin)) { " degrees" } else { "" }
    }

    /// Whether what is shown is the number itself.
    pub fn is_its_own_scale(&self) -> bool {
        match self {
            Reading::Plain => true,
            Reading::Level(level) => {
                !matches!(level, Level::PhaseMargin | Level::ComplementaryPeak | Level::DiskMargin | Level::Norm)
            }
            Reading::Settling { .. } => false,
        }
    }

    /// What is shown, enclosed; `None` where it is not finite.
    pub fn enclosure(&self, scale: &Enclosure, bits: u64) -> Option<Enclosure> {
        let number = |n: Rational| Enclosure::from_rational(n);
        match self {
            Reading::Plain => Some(scale.clone()),
            Reading::Level(level) => level.enclosure(scale, bits),
            Reading::Settling { sample_time: None } => number(DECADES.into()).div(scale, bits),
            // No mode is left after a sample.
            Reading::Settling { .. } if scale.upper().is_zero() => Some(number(Rational::ZERO)),
            Reading::Settling { sample_time: Some(step) } => {
                number(Rational::from(-DECADES) * step).div(&scale.ln(bits + 8)?, bits)
            }
        }
    }

    /// A number of the answer as a decimal.
    pub fn shown(&self, value: &Real, digits: usize) -> String {
        if self.is_its_own_scale() {
            return rounded(value, digits).decimal;
        }
        let enclose = |bits: u64| {
            let (low, high) = value.refined_to_digits(bits as usize * 3 / 10 + 8).enclosure();
            self.enclosure(&Enclosure::new(low, high), bits)
        };
        enclosed(digits, enclose).unwrap_or_else(|| "without end".to_owned())
    }
}
