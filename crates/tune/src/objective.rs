//! The text that says what is to be best: `max k*ki`, `min radius`, `none`. Errors point into it.

use crate::asked::{Gain, Objective};
use crate::centre::Measure;
use crate::reading::SETTLING_TIME;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Source, Span};
use jurist_engine::model::{Between, Expression, Model, Time, nearest_name};
use jurist_engine::response::Level;

/// The name of the text in errors.
pub const SOURCE: &str = "<objective>";

/// The name of a tolerance.
pub(crate) const TOLERANCE: &str = "tolerance";

/// The word before the signals of a peak gain.
const NORM: &str = "norm";

/// How a norm is written.
const NORM_FORM: &str = "norm INPUT OUTPUT";

/// An error about a part of the text.
pub(crate) fn refused(text: &str, error: Diagnostic) -> Error {
    Diagnostics::new(Some(Source::new(SOURCE, text)), vec![error]).into()
}

/// The expression behind 'max' or 'min', with the places that it has in the whole text.
///
/// # Errors
/// As [`Expression::parse`], about the text.
pub(crate) fn expression(text: &str) -> Result<Expression, Diagnostics> {
    let start = text.len() - text.trim_start().len();
    let blanked = format!("{}   {}", &text[..start], &text[start + "max".len()..]);
    Expression::parse(&blanked)
        .map_err(|error| Diagnostics::new(Some(Source::new(SOURCE, text)), error.diagnostics().to_vec()))
}

/// An objective as it is written.
pub(crate) struct Written<'a> {
    pub model: &'a Model,
    pub gains: &'a [Gain],
    pub text: &'a str,
}

impl Written<'_> {
    /// What is to be best.
    ///
    /// # Errors
    /// `E-tune-objective`, `E-syntax`.
    pub fn read(&self) -> Result<Objective, Error> {
        let text = self.text.trim();
        let (word, name) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let name = name.trim();
        let is_greatest = match (word, name) {
            ("none", "") => return Ok(Objective::Anything),
            ("max" | "min", _) => word == "max",
            _ => return Err(self.not_understood(word, name)),
        };
        if name.is_empty() {
            let message = format!("'{word}' of what is not said");
            return Err(self.wrong(message, word, "something is missing behind it", self.allowed(is_greatest)));
        }
        if let Some(i) = self.gains.iter().position(|gain| gain.name == name) {
            return Ok(if is_greatest { Objective::Greatest(i) } else { Objective::Least(i) });
        }
        if let Some(between) = self.norm(name)? {
            return if is_greatest { Err(self.worst(name, false)) } else { Ok(Objective::Norm(between)) };
        }
        if let Some(measure) = self.tolerance(name)? {
            return if is_greatest { Ok(Objective::Tolerance(measure)) } else { Err(self.worst(name, true)) };
        }
        if name == SETTLING_TIME {
            let level = match self.model.time() {
                Time::Continuous => Level::Decay,
                Time::Discrete => Level::Radius,
            };
            return if is_greatest { Err(self.worst(name, false)) } else { Ok(Objective::SettlingTime(level)) };
        }
        if let Some(level) = Level::named(name) {
            return self.level(level, name, is_greatest);
        }
        let joined = name.split_whitespace().collect::<Vec<_>>().join("_");
        if joined != name && (Level::named(&joined).is_some() || joined == SETTLING_TIME) {
            return Err(self.wrong(
                format!("'{name}' is one word"),
                name,
                "several words",
                format!("write '{joined}'"),
            ));
        }
        if name.chars().all(|c| c.is_alphanumeric() || c == '_') {
            return Err(self.unknown(name, is_greatest));
        }
        self.check_names(name, is_greatest)?;
        Ok(Objective::Formula { text: name.to_owned(), is_greatest })
    }

    fn wrong(&self, message: String, part: &str, label: &str, help: String) -> Error {
        let error = Diagnostic::error(Code::TuneObjective, message).at(self.place(part), label);
        refused(self.text, error.help(help))
    }

    /// Where a part of the text stands.
    fn place(&self, part: &str) -> Span {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize).min(self.text.len());
        Span::new(start, (start + part.len()).min(self.text.len()))
    }

    fn not_understood(&self, word: &str, name: &str) -> Error {
        let (message, part, label) = match (word, name) {
            ("", _) => ("the objective is empty".to_owned(), word, "empty"),
            ("none", _) => {
                let help = "write 'none' alone: are there any gains?".to_owned();
                return self.wrong("'none' stands alone".to_owned(), name, "one word too many", help);
            }
            _ => (format!("an objective begins with 'max', 'min' or 'none', not with '{word}'"), word, "unknown"),
        };
        self.wrong(message, part, label, format!("{}; {}", self.allowed(true), self.allowed(false)))
    }

    /// What may stand behind the first word.
    fn allowed(&self, is_greatest: bool) -> String {
        let gains: Vec<&str> = self.gains.iter().map(|gain| gain.name.as_str()).collect();
        let time = self.model.time();
        let is_good = |level: &Level| level.fits(time) && level.is_greatest_best() == is_greatest;
        let levels = Level::ALL.into_iter().filter(is_good).map(Level::name);
        let further: &[&str] = if is_greatest { &[TOLERANCE] } else { &[SETTLING_TIME, NORM_FORM] };
        let numbers: Vec<&str> = levels.chain(further.iter().copied()).collect();
        let word = if is_greatest { "max" } else { "min" };
        format!(
            "'{word}' may be followed by {}, by an expression such as 2*{}, or by one of {}",
            gains.join(", "),
            gains.first().copied().unwrap_or("K"),
            numbers.join(", ")
        )
    }

    fn worst(&self, name: &str, is_greatest_best: bool) -> Error {
        let (word, given) = if is_greatest_best { ("max", "min") } else { ("min", "max") };
        let short = name.split_whitespace().next().unwrap_or(name);
        let first = self.text.trim();
        let first = &first[..given.len().min(first.len())];
        let message = format!("'{given} {name}' asks for the worst {short}");
        self.wrong(message, first, "the other way round", format!("write '{word} {name}'"))
    }

    /// A number of the loop, if a loop of this kind of time has it and it is not the worst one that is asked for.
    fn level(&self, level: Level, name: &str, is_greatest: bool) -> Result<Objective, Error> {
        if level.fits(self.model.time()) {
            return match level.is_greatest_best() == is_greatest {
                true => Ok(Objective::Level(level)),
                false => Err(self.worst(name, level.is_greatest_best())),
            };
        }
        let (kind, help) = match (self.model.time(), level) {
            (Time::Discrete, Level::Damping) => ("discrete", "require it: --damping, and make another number best"),
            (Time::Discrete, Level::DelayMargin) => (
                "discrete",
                "make the phase margin best: 'max phase_margin'; 'jurist margins' says the delay margin of gains",
            ),
            (Time::Discrete, _) => ("discrete", "did you mean 'min radius'?"),
            (Time::Continuous, _) => ("continuous", "did you mean 'max decay'?"),
        };
        let message = format!("the best {name} is not asked of a {kind} loop");
        Err(self.wrong(message, name, &format!("not of a {kind} loop"), help.to_owned()))
    }

    /// A name that cannot be best.
    fn unknown(&self, name: &str, is_greatest: bool) -> Error {
        let allowed = self.allowed(is_greatest);
        if self.model.parameter(name).is_some() || self.model.constant(name).is_some() {
            let message = format!("'{name}' is not free");
            return self.wrong(message, name, "has a value", format!("free it too: --free {name}; {allowed}"));
        }
        let levels = Level::ALL.map(Level::name).into_iter().chain([SETTLING_TIME, TOLERANCE]);
        let known = self.gains.iter().map(|gain| gain.name.as_str()).chain(levels);
        let help = match nearest_name(name, known) {
            Some(near) => format!("did you mean '{near}'? {allowed}"),
            None => allowed,
        };
        let message = format!("'{name}' is no free gain and no number of a loop that can be made best");
        self.wrong(message, name, "unknown", help)
    }

    /// What `tolerance KIND` is counted in; `None` of another text.
    fn tolerance(&self, text: &str) -> Result<Option<Measure>, Error> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let help = || "write 'max tolerance', 'max tolerance absolute' or 'max tolerance ratio'".to_owned();
        match words[..] {
            [TOLERANCE] => Ok(Some(Measure::Relative)),
            [TOLERANCE, kind] => match Measure::ALL.into_iter().find(|measure| measure.name() == kind) {
                Some(measure) => Ok(Some(measure)),
                None => Err(self.wrong(format!("a tolerance is not counted in '{kind}'"), kind, "unknown", help())),
            },
            [TOLERANCE, _, third, ..] if Expression::parse(text).is_err() => {
                Err(self.wrong("a tolerance is counted in one way".to_owned(), third, "one word too many", help()))
            }
            _ => Ok(None),
        }
    }

    /// The signals of `norm INPUT OUTPUT`; `None` of another text.
    fn norm(&self, text: &str) -> Result<Option<Between>, Error> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let inputs: Vec<&str> = self.model.inputs().iter().map(|name| name.name.as_str()).collect();
        let outputs: Vec<&str> = self.model.outputs().iter().map(|output| output.name.name.as_str()).collect();
        let (input, output) = match words[..] {
            [NORM, input, output] => (input, output),
            [NORM, ..] => return Err(self.norm_of((&inputs, &outputs), &words[1..], text)),
            _ => return Ok(None),
        };
        for (known, name, what) in [(inputs, input, "input"), (outputs, output, "output")] {
            if !known.contains(&name) {
                let help = format!("known here: {}", known.join(", "));
                return Err(self.wrong(format!("the loop has no {what} '{name}'"), name, "unknown", help));
            }
        }
        Ok(Some(Between::new(input, output)))
    }

    /// That a norm is between two signals: with what is to be written.
    fn norm_of(&self, (inputs, outputs): (&[&str], &[&str]), written: &[&str], whole: &str) -> Error {
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
        self.wrong(message, whole, "two signals", format!("write 'min norm {input} {output}' ({known})"))
    }

    /// An error where an expression has a name that is no gain and none of the model's, or no gain at all.
    fn check_names(&self, name: &str, is_greatest: bool) -> Result<(), Error> {
        let expression = expression(self.text).map_err(|error| {
            let with_help = |mut one: Diagnostic| {
                let own = one.help.take().map(|own| format!("{own}; ")).unwrap_or_default();
                one.help(format!("{own}{}", self.allowed(is_greatest)))
            };
            let all = error.diagnostics().iter().cloned().map(with_help).collect();
            Diagnostics::new(error.source_text().cloned(), all)
        })?;
        let is_gain = |name: &str| self.gains.iter().any(|gain| gain.name == name);
        let mut unknown: Option<(&str, Span)> = None;
        expression.each_name(&mut |name, span| {
            let is_known = is_gain(name) || self.model.parameter(name).is_some() || self.model.constant(name).is_some();
            if !is_known && unknown.is_none() {
                unknown = Some((name, span));
            }
        });
        match unknown {
            Some((name, span)) => Err(self.unknown_in_expression(name, span)),
            None if !expression.names().iter().any(|name| is_gain(name)) => {
                let first = self.gains.first().map_or("K", |gain| gain.name.as_str());
                let help = format!("write an expression of the free gains, as in 'max 2*{first}'");
                Err(self.wrong("the objective has no free gain".to_owned(), name, "the same for all gains", help))
            }
            None => Ok(()),
        }
    }

    fn unknown_in_expression(&self, name: &str, span: Span) -> Error {
        let parameters = self.model.parameters().iter().map(|parameter| parameter.name.as_str());
        let constants = self.model.constants().iter().map(|constant| constant.name.as_str());
        let known: Vec<&str> = parameters.chain(constants).collect();
        let is_level = Level::named(name).is_some() || [SETTLING_TIME, TOLERANCE, NORM].contains(&name);
        let near = nearest_name(name, known.iter().copied());
        let (message, label, help) = match near {
            _ if is_level => {
                let message = format!("'{name}' is a number of the loop, which is no part of an expression");
                (
                    message,
                    "stands alone",
                    format!("write it alone, as in 'max decay'; known in expressions: {}", known.join(", ")),
                )
            }
            near => {
                let message = format!("'{name}' is no free gain, no parameter and no constant");
                let near = near.map(|near| format!("did you mean '{near}'? ")).unwrap_or_default();
                (message, "unknown", format!("{near}known here: {}", known.join(", ")))
            }
        };
        let error = Diagnostic::error(Code::TuneObjective, message).at(span, label).help(help);
        refused(self.text, error)
    }
}
