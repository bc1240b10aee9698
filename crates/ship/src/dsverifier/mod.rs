//! Loops in the C files of DSVerifier, as models.
//!
//! A file names a controller and a plant by lists of coefficients, and a fixed-point format. How DSVerifier reads such a file was taken from its
//! source, <https://github.com/ssvlab/dsverifier> at commit 1daca47:
//!
//! | in the file | what it means |
//! |---|---|
//! | `.b`, `.a` | numerator and denominator; filled with zeros at the end, or cut, to `.b_size` and `.a_size` |
//! | a list | falling powers of z in the check of closed loops, powers of z^-1 in simulations: [`Reading`] |
//! | `controller`, `plant` | a loop with negative feedback; `SERIES` and `FEEDBACK` have the same denominator |
//! | `ds` | a controller alone |
//! | `.int_bits`, `.frac_bits` | bits before the point, the sign among them, and behind it |
//! | `.min`, `.max`, `.scale` | bounds of the input, each divided by the scale |
//! | `.b_uncertainty`, `.a_uncertainty` | of the plant: per cent of each coefficient, positive ones only; those of a controller in a loop are not used |
//!
//! Numbers are the decimals that are written, exactly, with or without `f` behind them. DSVerifier's compiler keeps them as binary numbers of 64 bits,
//! which differ from them by less than one part in 10^15.

mod conditions;
mod fields;
mod number;
mod stored;
mod system;
mod token;
mod verdicts;
mod written;

pub use conditions::Define;
pub use number::Number;
pub use system::{Implementation, List, System};
pub use written::Writing;

use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source};
use std::sync::Arc;

/// The most coefficients of a list: DSVerifier's arrays have so many places.
pub const MAX_COEFFICIENTS: usize = 50;

/// What the entries of a list stand at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reading {
    /// Falling powers of z, the last entry is the constant: lists are aligned at their ends. So DSVerifier checks the stability of closed loops.
    #[default]
    Z,
    /// Powers of z^-1, the first entry is the constant: lists are aligned at their beginnings. So DSVerifier simulates.
    Delays,
}

impl Reading {
    /// Both readings.
    pub const ALL: [Reading; 2] = [Reading::Z, Reading::Delays];

    /// The word of the command line.
    pub fn name(self) -> &'static str {
        match self {
            Reading::Z => "z",
            Reading::Delays => "z^-1",
        }
    }

    /// The reading of a word.
    ///
    /// ```
    /// use jurist_ship::dsverifier::Reading;
    /// assert_eq!(Reading::named("z^-1"), Some(Reading::Delays));
    /// ```
    pub fn named(name: &str) -> Option<Reading> {
        Reading::ALL.into_iter().find(|reading| reading.name() == name)
    }
}

/// What a file of DSVerifier says of a loop.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DsFile {
    /// The text, into which errors point.
    pub source: Arc<Source>,
    /// The controller: `controller` or `control`, else `ds`.
    pub controller: System,
    /// The plant; `None` where the file has `ds` alone.
    pub plant: Option<System>,
    /// The number format and the bounds of the input.
    pub implementation: Option<Implementation>,
    /// Whether the controller's coefficients are those that DSVerifier stores.
    pub is_stored: bool,
}

impl DsFile {
    /// Reads a file; `defines` stand for what DSVerifier's command line passes on to the compiler as `-D NAME=NUMBER`.
    ///
    /// Cost: linear in the text.
    ///
    /// ```
    /// use jurist_engine::error::Source;
    /// use jurist_ship::dsverifier::{DsFile, Writing};
    /// let text = "digital_system controller = { .b = { 0.2 }, .b_size = 1, .a = { 1.0f }, .a_size = 1 };
    ///     implementation impl = { .int_bits = 3, .frac_bits = 13 };
    ///     digital_system plant = { .b = { 1 }, .b_size = 1, .a = { 1, -0.5 }, .a_size = 2 };";
    /// let file = DsFile::read(&Source::new("input.c", text), &[])?;
    /// let model = file.model("input.c", &Writing::default())?;
    /// assert!(model.contains("num = [0.2]") && model.contains("format = { bits = 16, fraction = 13, round = \"floor\" }"));
    /// # Ok::<(), jurist_engine::error::Diagnostics>(())
    /// ```
    ///
    /// # Errors
    /// `E-import` with the place in the text: what is no list of numbers, lists of more than [`MAX_COEFFICIENTS`], a size or a struct that is missing
    /// or given twice, a controller that is zero.
    pub fn read(source: &Arc<Source>, defines: &[Define]) -> Result<DsFile, Diagnostics> {
        let read = || {
            let tokens = token::tokens(&source.text)?;
            let selected = conditions::selected(&tokens, defines)?;
            let structs = fields::structs(&selected.tokens)?;
            system::file(source, &structs, &selected.missing)
        };
        read().map_err(|error: Diagnostic| Diagnostics::from(error).in_source(source))
    }

    /// An error about the text.
    fn refuse(&self, error: Diagnostic) -> Diagnostics {
        Diagnostics::from(error).in_source(&self.source)
    }
}

/// An error about a file of DSVerifier.
fn refused(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(Code::Import, message)
}
