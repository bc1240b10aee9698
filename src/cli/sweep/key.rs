//! What a question of a sweep is known by.

use jurist_algebra::number::Rational;
use jurist_check::sha256;

/// The kind of rows.
pub(in crate::cli) const SCHEMA: &str = "jurist/sweep/1";

/// What is asked where no parameter is named.
pub(in crate::cli) const VERDICT: &str = "verdict";

/// Values by name, sorted by name.
pub(in crate::cli) type Point = Vec<(String, Rational)>;

/// A question: what is asked, and where.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Question {
    pub ask: String,
    pub point: Point,
}

impl Question {
    /// A hash of the kind of rows, the engine's version, the model file and the question: the same as in the Python package.
    pub fn key(&self, model: &str) -> String {
        let mut lines = vec![SCHEMA.to_owned(), env!("CARGO_PKG_VERSION").to_owned()];
        lines.push(sha256(model));
        lines.push(self.ask.clone());
        lines.extend(self.point.iter().map(|(name, value)| format!("{name}={value}")));
        sha256(&lines.join("\n"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_of_the_model_and_the_question() {
        let question = |ask: &str, value: i64| Question { ask: ask.into(), point: vec![("T".into(), value.into())] };
        let key = question("K", 1).key("model");
        assert_eq!(key.len(), 64);
        assert_eq!(key, question("K", 1).key("model"));
        for other in [question("K", 2).key("model"), question("L", 1).key("model"), question("K", 1).key("model ")] {
            assert_ne!(key, other);
        }
    }
}
