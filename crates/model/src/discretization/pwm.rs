//! A pulse-width modulator before the plant: one pulse in each period, as long as the controller says.
//!
//! With the state `x' = A x + B v`, a pulse whose edges stand at `t_e(d)` in a period `T`, and `w_e` for how far an edge moves
//! when the pulse becomes longer, a small change of what is commanded changes the next state by
//! `T sum w_e exp(A (T - t_e(D))) B` times that change. `D` is the duty ratio of the periodic orbit; nothing else of the orbit, and
//! nothing of the pulse's height, is left in it [MaksimovicZane2007].

use super::{Inputs, Kind, Method};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

pub(super) const METHOD: Method = Method {
    name: "pwm",
    words: "pulse-width modulator",
    about: "exact for small deviations from a periodic orbit, with one pulse in each sample time",
    spellings: &["chopper", "pulse-width modulation", "pulse"],
    advice: "",
    keys: &["edge", "duty", "delay", "frame", "advance"],
    keeps_states: true,
    kind: Kind::Hold {
        inputs: Inputs::Pulses,
        exact: "exact for small deviations from the periodic orbit with this duty ratio; its ripple, and large steps, are not looked at.",
    },
};

/// Which edges of the pulse move when the duty ratio changes. Places and duty ratios are shares of the sample time, from 0 to 1.
///
/// ```
/// use jurist_model::Edges;
/// assert_eq!(Edges::named("double").unwrap().words, "both edges");
/// assert!(Edges::named("both").is_none());
/// ```
#[derive(Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Edges {
    /// The word of model files.
    pub name: &'static str,
    /// What it is called.
    pub words: &'static str,
    /// When the pulse is on, in a period of 1.
    pub on: &'static str,
    /// Where the pulse is on: twice the beginning and twice the end of each part, `begin + slope D`.
    parts: &'static [[(i64, i64); 2]],
    /// Twice the place of each edge that a command at an even sample moves: `2 t_e/T = begin + slope D`. All move by equal shares.
    places: &'static [(i64, i64)],
    /// The same of commands at odd samples.
    places_of_odd: &'static [(i64, i64)],
}

/// All of them, in the order of the documentation.
pub(crate) const EDGES: &[Edges] = &[
    Edges::steady("trailing", "trailing edge", "`[0, D]`", &[[(0, 0), (0, 2)]], &[(0, 2)]),
    Edges::steady("leading", "leading edge", "`[1 - D, 1]`", &[[(2, -2), (2, 0)]], &[(2, -2)]),
    Edges::steady("double", "both edges", "`[(1 - D)/2, (1 + D)/2]`", &[[(1, -1), (1, 1)]], &[(1, -1), (1, 1)]),
    Edges::steady(
        "double-ends",
        "both edges, on at the ends of the period",
        "`[0, D/2]` and `[1 - D/2, 1]`",
        &[[(0, 0), (0, 1)], [(2, -1), (2, 0)]],
        &[(0, 1), (2, -1)],
    ),
    Edges {
        name: "alternating",
        words: "alternating edges",
        on: "`[0, D]` in even samples, `[1 - D, 1]` in odd ones",
        parts: &[],
        places: &[(0, 2)],
        places_of_odd: &[(2, -2)],
    },
];

impl Edges {
    /// The same in all periods.
    const fn steady(
        name: &'static str,
        words: &'static str,
        on: &'static str,
        parts: &'static [[(i64, i64); 2]],
        places: &'static [(i64, i64)],
    ) -> Edges {
        Edges { name, words, on, parts, places, places_of_odd: places }
    }

    /// Where the pulse is on, in a period that is the same as all others: twice the beginning and twice the end of each part of it, each as
    /// `[begin, slope]` of `begin + slope D`, in sample times. Empty where edges alternate.
    pub(crate) fn parts(&self) -> impl Iterator<Item = [[i64; 2]; 2]> {
        self.parts.iter().map(|ends| ends.map(|(begin, slope)| [begin, slope]))
    }

    /// True if samples with odd numbers move other edges than samples with even numbers.
    ///
    /// ```
    /// use jurist_model::Edges;
    /// assert!(Edges::named("alternating").unwrap().alternate());
    /// assert!(!Edges::named("double").unwrap().alternate());
    /// ```
    pub fn alternate(&self) -> bool {
        self.places != self.places_of_odd
    }

    /// The edges of a word of model files.
    pub fn named(word: &str) -> Option<&'static Edges> {
        EDGES.iter().find(|edges| edges.name == word)
    }

    /// Where the edges stand in the period that commands at even and at odd samples begin, as shares of it; each moves by the same share of
    /// a change of the duty ratio.
    pub(crate) fn places(&self, duty: &RationalFunction) -> [Vec<RationalFunction>; 2] {
        let half = |k: i64| RationalFunction::from(Rational::new(k.into(), 2.into()));
        let at = |(begin, slope): &(i64, i64)| &half(*begin) + &(&half(*slope) * duty);
        [self.places, self.places_of_odd].map(|places| places.iter().map(at).collect())
    }
}
