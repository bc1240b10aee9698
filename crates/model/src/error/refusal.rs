//! Refusals as data: each has its code, its words, and what to ask instead.

use super::{Code, Diagnostic};

/// How a question is refused. A word in braces, such as `{name}`, stands for a text that the question supplies.
///
/// ```
/// use jurist_engine::coverage::{Asked, CoefficientRing};
/// let refusal = Asked::ExactMap.over(CoefficientRing::Functions).refusal().unwrap();
/// let error = refusal.diagnostic(&[("name", "T")]);
/// assert_eq!(error.message, "'T' is inside of functions, as behind a hold: there is no exact map");
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Refusal {
    /// The code.
    pub code: Code,
    /// What is wrong.
    pub message: &'static str,
    /// What to ask instead.
    pub help: &'static str,
}

impl Refusal {
    /// Of a code, a message and what to ask instead.
    pub const fn new(code: Code, message: &'static str, help: &'static str) -> Refusal {
        Refusal { code, message, help }
    }

    /// The diagnostic, with words in the places of their names in braces.
    pub fn diagnostic(&self, words: &[(&str, &str)]) -> Diagnostic {
        Diagnostic::error(self.code, filled(self.message, words)).help(filled(self.help, words))
    }

    /// The message where nothing supplies the words of their names in braces: `...` stands for each.
    ///
    /// ```
    /// use jurist_engine::coverage::{Asked, CoefficientRing};
    /// let refusal = Asked::ExactMap.over(CoefficientRing::Functions).refusal().unwrap();
    /// assert_eq!(refusal.in_general(), "'...' is inside of functions, as behind a hold: there is no exact map");
    /// ```
    pub fn in_general(&self) -> String {
        self.message.split(['{', '}']).enumerate().map(|(k, part)| if k % 2 == 0 { part } else { "..." }).collect()
    }

    /// True if the message and the help have no names in braces.
    pub fn is_complete(&self) -> bool {
        ![self.message, self.help].iter().any(|text| text.contains('{'))
    }
}

fn filled(text: &str, words: &[(&str, &str)]) -> String {
    words.iter().fold(text.to_owned(), |text, (name, word)| text.replace(&format!("{{{name}}}"), word))
}
