//! Loops of DSVerifier: a file in C.

use super::text_of;
use clap::ValueEnum;
use jurist_engine::error::Diagnostics;
use jurist_ship::dsverifier::{Loop, Reading, is_one, read as read_loop};
use std::path::Path;

/// How its lists are read.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(in crate::cli) enum ReadingWord {
    /// Falling powers of z, the last entry is the constant
    #[value(name = "z")]
    Z,
    /// Powers of 1/z, the first entry is the constant
    #[value(name = "z^-1")]
    InverseZ,
}

impl From<ReadingWord> for Reading {
    fn from(word: ReadingWord) -> Reading {
        match word {
            ReadingWord::Z => Reading::Z,
            ReadingWord::InverseZ => Reading::InverseZ,
        }
    }
}

/// Whether a file is one: by its ending, or of a file without one by what it defines.
pub(in crate::cli) fn is_named(name: &str, bytes: &[u8]) -> bool {
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("c" | "h") => true,
        Some(_) => false,
        None => std::str::from_utf8(bytes).is_ok_and(is_one),
    }
}

/// The loop of a file.
///
/// # Errors
/// `E-import` with the place in the text, `E-utf8`.
pub(in crate::cli) fn read(name: &str, bytes: &[u8], reading: Option<ReadingWord>) -> Result<Loop, Diagnostics> {
    read_loop(&text_of(name, bytes)?, reading.map_or(Reading::default(), Reading::from))
}
