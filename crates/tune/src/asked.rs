//! What is asked: which gains are free, within which bounds, and what is to be best.

use crate::centre::Measure;
use crate::objective::{TOLERANCE, Written};
use crate::reading::SETTLING_TIME;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::model::{Between, Model};
use jurist_engine::response::{AllOf, Level, Requirements};

/// A gain that is free.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Gain {
    /// Its name.
    pub name: String,
    /// The least and the greatest value, both included; `None` where the model's own domain counts.
    pub bounds: [Option<Rational>; 2],
}

impl Gain {
    /// A gain within the model's own domain.
    pub fn new(name: impl Into<String>) -> Gain {
        Gain { name: name.into(), bounds: [None, None] }
    }

    /// With bounds.
    #[must_use]
    pub fn within(self, bounds: [Option<Rational>; 2]) -> Gain {
        Gain { bounds, ..self }
    }
}

/// What is to be best.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Objective {
    /// A gain, by its number, as great as possible.
    Greatest(usize),
    /// A gain as small as possible.
    Least(usize),
    /// An expression of the gains.
    Formula {
        /// As it is written.
        text: String,
        /// Whether more of it is better.
        is_greatest: bool,
    },
    /// A number of the loop.
    Level(Level),
    /// The peak gain of the closed loop from an input to an output.
    Norm(Between),
    /// How far all gains may go while all is met.
    Tolerance(Measure),
    /// The settling time, by the decay in continuous time, by the radius in discrete time.
    SettlingTime(Level),
    /// Nothing: whether any gains meet the requirements.
    Anything,
}

/// A question.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Asked {
    /// The gains.
    pub gains: Vec<Gain>,
    /// What is to be best.
    pub objective: Objective,
    /// What has to be met; strict stability in any case.
    pub requirements: Requirements,
    /// A bracket is narrow enough where it is less than this, as a share.
    pub gap: Rational,
    /// How much of the best is given up for gains of few digits, as a share.
    pub loss: Option<Rational>,
    /// Whether boxes are searched where the answer of two gains would be exact.
    pub by_boxes: bool,
    /// Names of the plant with their ranges: gains have to be good for all values in them.
    pub for_all: Vec<AllOf>,
    /// The sample time, of a settling time in discrete time; it is found out when the question is answered.
    pub sample_time: Option<Rational>,
}

/// The most gains.
const MOST_GAINS: usize = 5;

/// The gap where none is given.
pub const GAP: (i64, i64) = (1, 1000);

impl Asked {
    /// The question of texts: `max ki`, `min radius`, `none`.
    ///
    /// ```
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::response::{Level, Requirements};
    /// use jurist_tune::asked::{Asked, Gain, Objective};
    /// let text = "time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's^3 + 3*s^2 + 2*s + K'\n";
    /// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
    /// let asked = Asked::of(&model, vec![Gain::new("K")], "max decay", Requirements::default())?;
    /// assert_eq!(asked.objective, Objective::Level(Level::Decay));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// `E-tune-free`, `E-tune-bounds`, `E-tune-objective`.
    pub fn of(model: &Model, gains: Vec<Gain>, objective: &str, requirements: Requirements) -> Result<Asked, Error> {
        check_gains(model, &gains)?;
        let objective = Written { model, gains: &gains, text: objective }.read()?;
        let gap = Rational::new(GAP.0.into(), GAP.1.into());
        let for_all = Vec::new();
        Ok(Asked { gains, objective, requirements, gap, loss: None, by_boxes: false, for_all, sample_time: None })
    }

    /// What the section `[tune]` of a model says of these gains: their bounds, the objective, the gap and the loss.
    ///
    /// # Errors
    /// As [`Asked::of`].
    pub fn of_model(model: &Model, gains: Vec<Gain>, requirements: Requirements) -> Result<Asked, Error> {
        let tuning = model.tuning();
        let objective = tuning.and_then(|tuning| tuning.objective.as_ref());
        let bounded = |gain: Gain| {
            let own = tuning.and_then(|tuning| tuning.bounds.iter().find(|(name, _)| name.name == gain.name));
            match own {
                Some((_, [low, high])) => gain.within([Some(low.clone()), Some(high.clone())]),
                None => gain,
            }
        };
        let gains = gains.into_iter().map(bounded).collect();
        let mut asked = Asked::of(model, gains, objective.map_or("none", |name| &name.name), requirements)?;
        asked.gap = tuning.and_then(|tuning| tuning.gap.clone()).filter(is_share).unwrap_or(asked.gap);
        asked.loss = tuning.and_then(|tuning| tuning.loss.as_ref()).and_then(|loss| share(&loss.name));
        Ok(asked)
    }

    /// The level that is to be best, if it is one.
    pub fn level(&self) -> Option<Level> {
        match self.objective {
            Objective::Level(level) | Objective::SettlingTime(level) => Some(level),
            Objective::Norm(_) => Some(Level::Norm),
            _ => None,
        }
    }

    /// The signals between which the level is, if it is a peak gain.
    pub fn between(&self) -> Option<&Between> {
        match &self.objective {
            Objective::Norm(between) => Some(between),
            _ => None,
        }
    }

    /// `largest ki`, `best phase_margin`, for people.
    pub fn wanted(&self) -> String {
        match &self.objective {
            Objective::Greatest(i) => format!("largest {}", self.gains[*i].name),
            Objective::Least(i) => format!("smallest {}", self.gains[*i].name),
            Objective::Formula { text, is_greatest: true } => format!("largest {text}"),
            Objective::Formula { text, is_greatest: false } => format!("smallest {text}"),
            Objective::Level(level) if level.is_greatest_best() => format!("largest {}", level.name()),
            Objective::Level(level) => format!("smallest {}", level.name()),
            Objective::SettlingTime(_) => format!("smallest {SETTLING_TIME}"),
            Objective::Norm(between) => format!("smallest norm {}", between.name()),
            Objective::Tolerance(measure) => format!("largest {} tolerance", measure.name()),
            Objective::Anything => "any gains".into(),
        }
    }

    /// `max ki`, as it is written.
    pub fn objective_text(&self) -> String {
        match &self.objective {
            Objective::Greatest(i) => format!("max {}", self.gains[*i].name),
            Objective::Least(i) => format!("min {}", self.gains[*i].name),
            Objective::Formula { text, is_greatest: true } => format!("max {text}"),
            Objective::Formula { text, is_greatest: false } => format!("min {text}"),
            Objective::Level(level) if level.is_greatest_best() => format!("max {}", level.name()),
            Objective::Level(level) => format!("min {}", level.name()),
            Objective::SettlingTime(_) => format!("min {SETTLING_TIME}"),
            Objective::Norm(between) => format!("min norm {}", between.name()),
            Objective::Tolerance(Measure::Relative) => format!("max {TOLERANCE}"),
            Objective::Tolerance(measure) => format!("max {TOLERANCE} {}", measure.name()),
            Objective::Anything => "none".into(),
        }
    }
}

/// A share above 0 and below 1: a number, or per cent; `None` of any other text.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_tune::asked::share;
/// assert_eq!(share("1%"), Some(Rational::new(1.into(), 100.into())));
/// assert_eq!((share("2"), share("x")), (None, None));
/// ```
pub fn share(text: &str) -> Option<Rational> {
    let text = text.trim();
    let value = match text.strip_suffix('%') {
        Some(number) => parse_number(number.trim()).ok()? * Rational::new(1.into(), 100.into()),
        None => parse_number(text).ok()?,
    };
    is_share(&value).then_some(value)
}

/// Whether a number is above 0 and below 1.
pub fn is_share(value: &Rational) -> bool {
    value.sign().is_gt() && *value < Rational::ONE
}

/// Refuses a list of gains that no search can be made of.
///
/// # Errors
/// `E-tune-free` where no gain is free, too many are, or one is twice; `E-tune-bounds` of bounds that are no interval.
pub fn check_gains(model: &Model, gains: &[Gain]) -> Result<(), Error> {
    let refused = |message: String, help: &str| Err(Diagnostic::error(Code::TuneFree, message).help(help).into());
    if gains.is_empty() {
        let own = model.parameters().first().map_or("NAME", |parameter| parameter.name.as_str());
        return refused("no gain is free".into(), &format!("name the gains: --free {own}"));
    }
    if gains.len() > MOST_GAINS {
        let names: Vec<&str> = gains.iter().map(|gain| gain.name.as_str()).collect();
        return refused(
            format!("the gains {} are more than {MOST_GAINS}", names.join(", ")),
            "free some of them, the others keep their values: --set NAME=VALUE",
        );
    }
    for (i, gain) in gains.iter().enumerate() {
        if gains[..i].iter().any(|other| other.name == gain.name) {
            return refused(format!("'{}' is free twice", gain.name), "name it once");
        }
        if let [Some(low), Some(high)] = &gain.bounds
            && low >= high
        {
            let message = format!("the bounds of '{}' are no interval: {low} is not below {high}", gain.name);
            let help = match low == high {
                true => format!("give it this value: --set {}={low}", gain.name),
                false => "write the lower one first".to_owned(),
            };
            return Err(Diagnostic::error(Code::TuneBounds, message).help(help).into());
        }
    }
    Ok(())
}
