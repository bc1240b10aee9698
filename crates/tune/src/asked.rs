//! What is asked: which gains are free, within which bounds, and what is to be best.

use crate::centre::Measure;
use crate::reading::SETTLING_TIME;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Source, Span};
use jurist_engine::model::{Between, Expression, Model, Time, nearest_name};
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
        check_gains(&gains)?;
        let objective = self::objective(model, &gains, objective)?;
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

fn check_gains(gains: &[Gain]) -> Result<(), Error> {
    let refused = |message: String, help: &str| Err(Diagnostic::error(Code::TuneFree, message).help(help).into());
    if gains.is_empty() {
        return refused("no gain is free".into(), "name the gains: --free K");
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

fn objective(model: &Model, gains: &[Gain], text: &str) -> Result<Objective, Error> {
    let refused =
        |message: String, help: String| -> Error { Diagnostic::error(Code::TuneObjective, message).help(help).into() };
    let (word, name) = text.trim().split_once(char::is_whitespace).unwrap_or((text.trim(), ""));
    let name = name.trim();
    let is_greatest = match (word, name) {
        ("none", "") => return Ok(Objective::Anything),
        ("max" | "min", name) if !name.is_empty() => word == "max",
        _ => {
            return Err(refused(
                format!("the objective '{text}' is not understood"),
                "write 'max NAME' or 'min NAME', NAME a free gain, an expression of free gains or one of decay, radius, damping, settling_time, \
                 gain_margin, phase_margin, modulus_margin, complementary_peak, disk_margin, delay_margin; 'min norm INPUT OUTPUT'; 'max tolerance'; or 'none'"
                    .into(),
            ));
        }
    };
    if let Some(i) = gains.iter().position(|gain| gain.name == name) {
        return Ok(if is_greatest { Objective::Greatest(i) } else { Objective::Least(i) });
    }
    if let Some(between) = norm(model, name)? {
        return match is_greatest {
            false => Ok(Objective::Norm(between)),
            true => Err(refused(format!("'{text}' asks for the worst norm"), format!("write 'min {name}'"))),
        };
    }
    if let Some(measure) = tolerance(name)? {
        return match is_greatest {
            true => Ok(Objective::Tolerance(measure)),
            false => Err(refused(format!("'{text}' asks for the worst {name}"), format!("write 'max {name}'"))),
        };
    }
    if name == SETTLING_TIME && !is_greatest {
        return Ok(Objective::SettlingTime(match model.time() {
            Time::Continuous => Level::Decay,
            Time::Discrete => Level::Radius,
        }));
    }
    if let Some(level) = Level::named(name) {
        return level_of(model.time(), level, (text, is_greatest));
    }
    if !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
        check_names(model, gains, name)?;
        return Ok(Objective::Formula { text: name.to_owned(), is_greatest });
    }
    if name == SETTLING_TIME {
        return Err(refused(format!("'{text}' asks for the worst {name}"), format!("write 'min {name}'")));
    }
    let levels = Level::ALL.map(Level::name).into_iter().chain([SETTLING_TIME, TOLERANCE]);
    let known = gains.iter().map(|gain| gain.name.as_str()).chain(levels);
    let known: Vec<&str> = known.collect();
    let help = match nearest_name(name, known.iter().copied()) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("known here: {}", known.join(", ")),
    };
    Err(refused(format!("'{name}' is no free gain and no number of a loop that can be made best"), help))
}

/// A number of the loop, if a loop of this kind of time has it and it is not the worst one that is asked for.
fn level_of(time: Time, level: Level, (text, is_greatest): (&str, bool)) -> Result<Objective, Error> {
    let refused =
        |message: String, help: String| -> Error { Diagnostic::error(Code::TuneObjective, message).help(help).into() };
    let name = level.name();
    if !level.fits(time) {
        let (kind, help) = match (time, level) {
            (Time::Discrete, Level::Damping) => ("discrete", "require it: --damping, and make another number best"),
            (Time::Discrete, Level::DelayMargin) => (
                "discrete",
                "make the phase margin best: 'max phase_margin'; 'jurist margins' says the delay margin of gains",
            ),
            (Time::Discrete, _) => ("discrete", "did you mean 'radius'?"),
            (Time::Continuous, _) => ("continuous", "did you mean 'decay'?"),
        };
        return Err(refused(format!("the best {name} is not asked of a {kind} loop"), help.to_owned()));
    }
    if level.is_greatest_best() != is_greatest {
        let word = if is_greatest { "min" } else { "max" };
        return Err(refused(format!("'{text}' asks for the worst {name}"), format!("write '{word} {name}'")));
    }
    Ok(Objective::Level(level))
}

/// The name of a tolerance.
const TOLERANCE: &str = "tolerance";

/// What `tolerance KIND` is counted in; `None` of another text.
fn tolerance(text: &str) -> Result<Option<Measure>, Error> {
    let words: Vec<&str> = text.split_whitespace().collect();
    match words[..] {
        [TOLERANCE] => Ok(Some(Measure::Relative)),
        [TOLERANCE, kind] => match Measure::ALL.into_iter().find(|measure| measure.name() == kind) {
            Some(measure) => Ok(Some(measure)),
            None => {
                let error = Diagnostic::error(Code::TuneObjective, format!("a tolerance is not counted in '{kind}'"));
                Err(error.help("write 'max tolerance', 'max tolerance absolute' or 'max tolerance ratio'").into())
            }
        },
        _ => Ok(None),
    }
}

/// The signals of `norm INPUT OUTPUT`; `None` of another text.
fn norm(model: &Model, text: &str) -> Result<Option<Between>, Error> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let inputs: Vec<&str> = model.inputs().iter().map(|name| name.name.as_str()).collect();
    let outputs: Vec<&str> = model.outputs().iter().map(|output| output.name.name.as_str()).collect();
    let (input, output) = match words[..] {
        ["norm", input, output] => (input, output),
        ["norm", ..] => return Err(norm_of(&inputs, &outputs, &words[1..])),
        _ => return Ok(None),
    };
    for (known, name, what) in [(inputs, input, "input"), (outputs, output, "output")] {
        if !known.contains(&name) {
            let error = Diagnostic::error(Code::TuneObjective, format!("the loop has no {what} '{name}'"));
            return Err(error.help(format!("known here: {}", known.join(", "))).into());
        }
    }
    Ok(Some(Between::new(input, output)))
}

/// That a norm is between two signals: with what is to be written.
fn norm_of(inputs: &[&str], outputs: &[&str], written: &[&str]) -> Error {
    let given = written.iter().map(|word| format!("'{word}'")).collect::<Vec<_>>().join(", ");
    let message = match written {
        [] => "a norm is from an input to an output".to_owned(),
        [_] => format!("a norm is from an input to an output, and {given} is one signal"),
        _ => format!("a norm is from one input to one output, not of {given}"),
    };
    // What is written already is kept where it is a signal of that kind.
    let kept = |known: &[&str]| written.iter().find(|word| known.contains(word)).map(|word| (*word).to_owned());
    let or_only = |known: &[&str], name: &str| match known {
        [only] => (*only).to_owned(),
        _ => name.to_owned(),
    };
    let input = kept(inputs).unwrap_or_else(|| or_only(inputs, "INPUT"));
    let output = kept(outputs).unwrap_or_else(|| or_only(outputs, "OUTPUT"));
    let known = format!("inputs: {}; outputs: {}", inputs.join(", "), outputs.join(", "));
    Diagnostic::error(Code::TuneObjective, message).help(format!("write 'min norm {input} {output}' ({known})")).into()
}

/// An error where an expression has a name that is no gain and none of the model's, or no gain at all.
fn check_names(model: &Model, gains: &[Gain], text: &str) -> Result<(), Error> {
    let expression = Expression::parse(text)?;
    let is_gain = |name: &str| gains.iter().any(|gain| gain.name == name);
    let mut unknown: Option<(&str, Span)> = None;
    expression.each_name(&mut |name, span| {
        let is_known = is_gain(name) || model.parameter(name).is_some() || model.constant(name).is_some();
        if !is_known && unknown.is_none() {
            unknown = Some((name, span));
        }
    });
    let error = match unknown {
        Some((name, span)) => {
            let parameters = model.parameters().iter().map(|parameter| parameter.name.as_str());
            let constants = model.constants().iter().map(|constant| constant.name.as_str());
            let known: Vec<&str> =
                gains.iter().map(|gain| gain.name.as_str()).chain(parameters).chain(constants).collect();
            let message = format!("'{name}' is no free gain, no parameter and no constant");
            let help = match nearest_name(name, known.iter().copied()) {
                Some(near) => format!("did you mean '{near}'?"),
                None => "a number of the loop stands alone: 'max decay'".to_owned(),
            };
            Diagnostic::error(Code::TuneObjective, message).at(span, "unknown").help(help)
        }
        None if !expression.names().iter().any(|name| is_gain(name)) => {
            let message = "the objective has no free gain";
            Diagnostic::error(Code::TuneObjective, message)
                .help("write an expression of the free gains, as in 'max k*ki'")
        }
        None => return Ok(()),
    };
    Err(Diagnostics::new(Some(Source::new("<objective>", text)), vec![error]).into())
}
