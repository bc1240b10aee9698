//! One list of the ways to make a continuous block discrete. The words of model files, their schema, errors, the table of the documentation and
//! Python's type follow from this list.
//!
//! Each way is a file with a [`Method`]: its words, its keys, and what it does to a system.

mod backward;
mod foh;
mod forward;
#[cfg(test)]
mod lists;
mod pwm;
mod tustin;
mod zoh;

use crate::connect::state_space::{NotConnected, System};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::RationalFunction;
pub(crate) use pwm::EDGES;
pub use pwm::Edges;

/// All methods, in the order of model files.
pub(crate) const LIST: &[&Method] =
    &[&zoh::METHOD, &foh::METHOD, &pwm::METHOD, &tustin::METHOD, &forward::METHOD, &backward::METHOD];

/// A way to make a continuous block discrete: a rule that keeps rational functions rational, or what a block behind a hold does exactly.
///
/// ```
/// use jurist_model::Method;
/// assert_eq!(Method::named("forward").unwrap().words, "forward rule");
/// assert!(Method::named("foh").unwrap().is_hold());
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Method {
    /// The word of model files.
    pub name: &'static str,
    /// What it is called: `forward rule`, `zero-order hold`.
    pub words: &'static str,
    /// What it does, in a few words.
    pub about: &'static str,
    /// Other words for it. An error at such a word says what to write.
    spellings: &'static [&'static str],
    /// What such an error says beside that.
    advice: &'static str,
    /// The keys that it has in `discretize` beside `method` and `T`.
    keys: &'static [&'static str],
    /// True if the states of a block are its states in between, so that outputs that are states keep their names.
    pub(crate) keeps_states: bool,
    pub(crate) kind: Kind,
}

/// What a method is made of.
#[derive(Debug)]
pub(crate) enum Kind {
    /// The block is exact at the samples.
    Hold {
        /// What the inputs are between samples.
        inputs: Inputs,
        /// What is exact, in words.
        exact: &'static str,
    },
    /// `s` is replaced by a rational function of `z`.
    Rule(Rule),
}

/// What the inputs of a block are between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inputs {
    /// Constant.
    Constant,
    /// Straight.
    Straight,
    /// Pulses, one in each sample time.
    Pulses,
}

/// The inverse of a matrix, which the loop then divides by.
pub(crate) type Inverse<'a> = dyn FnMut(&RationalMatrix) -> Result<RationalMatrix, NotConnected> + 'a;

/// The discrete system of a continuous one: with the sample time, or the factor where the method has one.
pub(crate) type Rule = fn(System, &RationalFunction, &mut Inverse<'_>) -> Result<System, NotConnected>;

impl PartialEq for Method {
    fn eq(&self, other: &Method) -> bool {
        self.name == other.name
    }
}

impl Eq for Method {}

impl Method {
    /// The whole list, in the order of model files.
    pub fn all() -> &'static [&'static Method] {
        LIST
    }

    /// The method of a word of model files.
    pub fn named(word: &str) -> Option<&'static Method> {
        LIST.iter().find(|method| method.name == word).copied()
    }

    /// True if the block is behind a hold or a modulator, and exact.
    pub fn is_hold(&self) -> bool {
        matches!(self.kind, Kind::Hold { .. })
    }

    /// What an answer does not say of a block that is made discrete so.
    ///
    /// ```
    /// use jurist_model::Method;
    /// assert!(Method::named("tustin").unwrap().caveat().starts_with("made discrete by the Tustin's rule"));
    /// ```
    pub fn caveat(&self) -> String {
        match self.kind {
            Kind::Hold { exact, .. } => format!("behind a {}, {exact}", self.words),
            Kind::Rule(_) => format!(
                "made discrete by the {}. That is a rule, not what a block behind a converter does between two samples; \
                 its limits can differ from those behind a zero-order hold (discretize = \"zoh\").",
                self.words
            ),
        }
    }

    /// True if the block's inputs are the pulses of a pulse-width modulator.
    ///
    /// ```
    /// use jurist_model::Method;
    /// assert!(Method::named("pwm").unwrap().is_modulated());
    /// ```
    pub fn is_modulated(&self) -> bool {
        matches!(self.kind, Kind::Hold { inputs: Inputs::Pulses, .. })
    }

    /// True if `discretize` has this key with it.
    pub(crate) fn has_key(&self, key: &str) -> bool {
        self.keys.contains(&key)
    }

    /// How the methods are written that are also called so; `None` where none is.
    pub(crate) fn written(word: &str) -> Option<String> {
        let meant = || LIST.iter().filter(|method| method.spellings.contains(&word));
        let names: Vec<String> = meant().map(|method| format!("\"{}\"", method.name)).collect();
        let advice: String = meant().map(|method| method.advice).collect();
        (!names.is_empty()).then(|| format!("write {}{advice}", names.join(" or ")))
    }

    /// `the methods 'zoh' and 'foh'`: those that have a key.
    pub(crate) fn with_key(key: &str) -> String {
        let names: Vec<String> =
            LIST.iter().filter(|method| method.has_key(key)).map(|method| format!("'{}'", method.name)).collect();
        format!("the method{} {}", if names.len() > 1 { "s" } else { "" }, names.join(" and "))
    }
}
