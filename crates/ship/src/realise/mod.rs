//! From a transfer function to programs.

mod delta;
mod direct;
mod entry;
mod parallel;
mod sections;
mod state;
mod structure;

pub use delta::delta;
pub use direct::direct;
pub use entry::Entry;
pub use parallel::parallel;
pub use sections::sections;
pub use state::state;
pub use structure::{Realised, Structure};

/// The order of operations that computes a controller.
///
/// ```
/// use jurist_ship::realise::Realisation;
/// assert_eq!(Realisation::named("df2t"), Some(Realisation::Df2t));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Realisation {
    /// One sum over past inputs and outputs.
    Df1,
    /// A sum over past inner values, then one for the output.
    Df2,
    /// The output first, then a sum for each state.
    Df2t,
    /// A chain of sections of order two, each in direct form 1.
    Sos,
    /// Sections of order two side by side, each in direct form 1: partial fractions.
    Parallel,
    /// Direct form 2 transposed in the delta operator `(z - 1)/delta`.
    Delta,
    /// The matrices as they are given.
    State,
}

impl Realisation {
    /// All realisations.
    pub const ALL: [Realisation; 7] = [
        Realisation::Df1,
        Realisation::Df2,
        Realisation::Df2t,
        Realisation::Sos,
        Realisation::Parallel,
        Realisation::Delta,
        Realisation::State,
    ];

    /// The word of model files.
    pub fn name(self) -> &'static str {
        match self {
            Realisation::Df1 => "df1",
            Realisation::Df2 => "df2",
            Realisation::Df2t => "df2t",
            Realisation::Sos => "sos",
            Realisation::Parallel => "parallel",
            Realisation::Delta => "delta",
            Realisation::State => "state",
        }
    }

    /// The realisation in words.
    pub fn words(self) -> &'static str {
        match self {
            Realisation::Df1 => "direct form 1",
            Realisation::Df2 => "direct form 2",
            Realisation::Df2t => "direct form 2 transposed",
            Realisation::Sos => "second-order sections",
            Realisation::Parallel => "parallel sections",
            Realisation::Delta => "delta operator",
            Realisation::State => "state space",
        }
    }

    /// The realisation of a word.
    pub fn named(name: &str) -> Option<Realisation> {
        Realisation::ALL.into_iter().find(|realisation| realisation.name() == name)
    }
}
