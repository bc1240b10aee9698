//! Why work stopped without an answer.

use std::borrow::Cow;
use std::fmt;
use std::time::Duration;

/// The limit that ended work before the exact answer was reached. `Display` writes it as every message does.
///
/// ```
/// use jurist_algebra::limits::{Budget, Stop};
/// let exhausted = Budget::with_work(0).check().unwrap_err();
/// assert_eq!(exhausted.stop, Stop::Work(0));
/// assert_eq!(exhausted.stop.to_string(), "work (0 units)");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stop {
    /// The time is up: the whole of it.
    Time(Duration),
    /// The work is done: the whole of it, in the units of [`checkpoint`](super::checkpoint).
    Work(u64),
    /// The memory is used: the most bytes that may be in use.
    Memory(u64),
    /// Another thread cancelled the work.
    Cancelled,
    /// So many bits do not decide a sign, an order or a count.
    Precision(u64),
    /// Numbers are so close that the bits which they are compared with do not separate them.
    Separation,
    /// An exact decision needs expressions with more than so many terms.
    Terms(u64),
    /// The subdivision of a window ended with many small boxes.
    Boxes {
        /// Boxes that are undecided.
        undecided: u64,
        /// How often each of them was halved.
        halvings: u32,
    },
    /// Boxes were halved so many times.
    Halvings(u32),
    /// The method does not go further: its limit in words, which are for people only.
    Method(Cow<'static, str>),
}

impl Stop {
    /// True if the caller's budget ended the work, or the caller did; false if the method itself goes no further.
    ///
    /// ```
    /// use jurist_algebra::limits::Stop;
    /// assert!(Stop::Work(1000).is_budget() && !Stop::Precision(8192).is_budget());
    /// ```
    pub fn is_budget(&self) -> bool {
        matches!(self, Stop::Time(_) | Stop::Work(_) | Stop::Memory(_) | Stop::Cancelled)
    }

    /// True if numbers could not be told apart, so that another method, or an answer that leaves a bracket open, may still
    /// decide; false if the caller's budget ran out or the method has no more to say.
    ///
    /// ```
    /// use jurist_algebra::limits::Stop;
    /// assert!(Stop::Precision(8192).is_precision());
    /// assert!(!Stop::Work(1000).is_precision());
    /// ```
    pub fn is_precision(&self) -> bool {
        matches!(self, Stop::Precision(_) | Stop::Separation | Stop::Terms(_))
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::Time(whole) => write!(f, "time ({} s)", whole.as_secs_f64()),
            Stop::Work(units) => write!(f, "work ({units} units)"),
            Stop::Memory(bytes) => write!(f, "memory ({} MB)", *bytes as f64 / 1e6),
            Stop::Cancelled => f.write_str("cancelled"),
            Stop::Precision(bits) => write!(f, "precision ({bits} bits)"),
            Stop::Separation => f.write_str("precision"),
            Stop::Terms(most) => write!(f, "precision ({most} terms)"),
            Stop::Boxes { undecided, halvings } => {
                write!(f, "boxes ({undecided} undecided, halved {halvings} times)")
            }
            Stop::Halvings(times) => write!(f, "boxes halved {times} times"),
            Stop::Method(limit) => f.write_str(limit),
        }
    }
}

/// A budget ran out before the exact answer was reached.
///
/// ```
/// use jurist_algebra::limits::{Budget, Stop};
/// let budget = Budget::with_work(0);
/// budget.step("isolating");
/// let exhausted = budget.check().unwrap_err();
/// assert_eq!((&exhausted.stop, exhausted.step.as_str()), (&Stop::Work(0), "isolating"));
/// assert_eq!(exhausted.to_string(), "the budget ran out: work (0 units); reached: isolating");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Exhausted {
    /// The limit that ended the work.
    pub stop: Stop,
    /// The last step that began and, where known, how much of it was done.
    pub step: String,
    /// The question that stayed open, where one is known, such as `whether D(1) is zero`.
    pub open: Option<String>,
}

impl Exhausted {
    /// A limit that ended work, and the step that was reached.
    pub fn new(stop: Stop, step: impl Into<String>) -> Self {
        Exhausted { stop, step: step.into(), open: None }
    }

    /// The method ended at a limit of its own, in words for people, at this step.
    pub fn by_method(limit: impl Into<Cow<'static, str>>, step: impl Into<String>) -> Self {
        Exhausted::new(Stop::Method(limit.into()), step)
    }

    /// The same with a question that stayed open.
    #[must_use]
    pub fn with_open(self, question: &str) -> Self {
        let open = match self.open {
            Some(first) => format!("{first}; open: {question}"),
            None => question.to_owned(),
        };
        Exhausted { open: Some(open), ..self }
    }

    /// How far the work came, for people: the step, and the question that stayed open.
    pub fn reached(&self) -> String {
        match &self.open {
            Some(question) => format!("{}; open: {question}", self.step),
            None => self.step.clone(),
        }
    }

    /// A limit that was reached at a step that is not known here.
    pub(super) fn of(stop: Stop) -> Self {
        Exhausted::new(stop, String::new())
    }
}

impl fmt::Display for Exhausted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.stop.is_budget() { "the budget ran out" } else { "the method ended" };
        write!(f, "{what}: {}; reached: {}", self.stop, self.reached())
    }
}

impl std::error::Error for Exhausted {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Programs read these words in documents: they stay as they are.
    #[test]
    fn each_stop_has_its_words() {
        let words = [
            (Stop::Time(Duration::from_millis(1500)), "time (1.5 s)"),
            (Stop::Work(100_000), "work (100000 units)"),
            (Stop::Memory(16_777_216), "memory (16.777216 MB)"),
            (Stop::Cancelled, "cancelled"),
            (Stop::Precision(8192), "precision (8192 bits)"),
            (Stop::Separation, "precision"),
            (Stop::Terms(500), "precision (500 terms)"),
            (Stop::Boxes { undecided: 7, halvings: 3 }, "boxes (7 undecided, halved 3 times)"),
            (Stop::Halvings(40), "boxes halved 40 times"),
            (Stop::Method("identities of constants".into()), "identities of constants"),
        ];
        for (stop, text) in words {
            assert_eq!(stop.to_string(), text);
            assert_eq!(stop.is_precision(), text.starts_with("precision"));
        }
    }

    #[test]
    fn what_was_reached_names_every_open_question() {
        let exhausted = Exhausted::new(Stop::Cancelled, "counting").with_open("whether a is zero");
        assert_eq!(exhausted.reached(), "counting; open: whether a is zero");
        let exhausted = exhausted.with_open("whether b is zero");
        assert_eq!(exhausted.reached(), "counting; open: whether a is zero; open: whether b is zero");
        assert_eq!(exhausted.to_string(), format!("the budget ran out: cancelled; reached: {}", exhausted.reached()));
    }
}
