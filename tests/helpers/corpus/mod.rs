//! The corpus: models with their expected answers in words, the same for every engine. `tests/corpus/README.md` says how
//! a case is written.

use jurist::Ask;
mod answer;
mod expected;
mod read;

pub use answer::{Found, FoundEnd};
pub use expected::{Expected, ExpectedEnd, ExpectedValue};
pub use read::cases;

use super::number::number;
use crate::helpers::thorough::is_tried;
use jurist_engine::model::Model;
use jurist_engine::problem::{Question, Region};
use jurist_engine::stability::Range;

/// A model and what is known of it.
pub struct Case {
    /// The file's name without its ending.
    pub name: String,
    pub model: String,
    /// Whether there are certificates of the answers.
    pub is_proved: bool,
    pub expectations: Vec<Expectation>,
}

/// A question and its answer.
pub struct Expectation {
    /// The parameter of a question for its stable set; `None` asks for the verdict at a point.
    pub parameter: Option<String>,
    /// Name and exact value.
    pub set: Vec<(String, String)>,
    /// Name and `LO..HI`.
    pub domain: Vec<(String, String)>,
    pub radius: Option<String>,
    pub decay: Option<String>,
    pub answer: Expected,
}

impl Expectation {
    /// The question for the library.
    pub fn question(&self, model: &Model) -> Question {
        let mut question = model.ask().set_all(self.set.iter().map(|(name, value)| (name, number(value))));
        for (name, range) in &self.domain {
            let (lower, upper) = range.split_once("..").expect("LO..HI");
            let end = |text: &str| (!text.is_empty()).then(|| number(text));
            question = question.domain(name, Range::between(end(lower), end(upper)));
        }
        if let Some(radius) = &self.radius {
            question = question.within(Region::disc(number(radius)).expect("a radius"));
        }
        if let Some(decay) = &self.decay {
            question = question.within(Region::half_plane(number(decay)));
        }
        self.parameter.iter().fold(question, Question::free)
    }

    /// The question for the program, but for the model.
    pub fn arguments(&self) -> Vec<String> {
        let mut arguments = vec![if self.parameter.is_some() { "intervals" } else { "verdict" }.to_owned()];
        let mut option = |name: &str, value: String| arguments.extend([name.to_owned(), value]);
        if let Some(parameter) = &self.parameter {
            option("--param", parameter.clone());
        }
        self.set.iter().for_each(|(name, value)| option("--set", format!("{name}={value}")));
        self.domain.iter().for_each(|(name, range)| option("--domain", format!("{name}={range}")));
        self.radius.iter().for_each(|value| option("--radius", value.clone()));
        self.decay.iter().for_each(|value| option("--decay", value.clone()));
        arguments
    }
}

/// Asks every question of the corpus and reports all that is answered otherwise than expected.
pub fn ask_all(every: usize, engine: impl Fn(&Case, &Expectation) -> Result<(), String>) {
    let cases = cases();
    assert!(cases.len() >= 80, "{} cases", cases.len());
    let mut wrong = Vec::new();
    let all =
        cases.iter().flat_map(|case| case.expectations.iter().enumerate().map(move |(i, asked)| (case, i, asked)));
    for (number, (case, i, expectation)) in all.enumerate() {
        if is_tried(number, every)
            && let Err(difference) = engine(case, expectation)
        {
            wrong.push(format!("{}, expectation {}: {difference}", case.name, i + 1));
        }
    }
    assert!(wrong.is_empty(), "{} wrong answers:\n{}", wrong.len(), wrong.join("\n"));
}
