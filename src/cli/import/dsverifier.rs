//! C files of DSVerifier, for `jurist import` and `jurist ship --from`.

use crate::cli::assignments::in_line;
use crate::cli::commands::Context;
use crate::cli::output::note;
use crate::cli::status::Error;
use clap::{Args, ValueEnum};
use jurist_engine::error::{Code, Diagnostic, Source};
use jurist_engine::model::source_from_bytes;
use jurist_ship::dsverifier::{Define, DsFile, Reading, Writing};
use jurist_ship::format::Rounding;
use jurist_ship::realise::Realisation;
use std::path::Path;
use std::sync::Arc;

/// How a file of DSVerifier is read.
#[derive(Args, Debug, Default)]
pub(in crate::cli) struct DsOptions {
    /// How the lists of a C file of DSVerifier are read: falling powers of z (the last entry is the constant), or powers of 1/z
    /// (the first entry is the constant) [default: z]
    #[arg(long, value_enum, value_name = "POWERS")]
    pub reading: Option<ReadingWord>,
    /// Defines a name for the conditions of a C file, as DSVerifier's -D does: DS_ID=1 [repeatable]
    #[arg(short = 'D', long, value_name = "NAME=NUMBER")]
    pub define: Vec<String>,
}

impl DsOptions {
    /// The first of these options that is given.
    pub fn given(&self) -> Option<&'static str> {
        match (&self.reading, self.define.is_empty()) {
            (Some(_), _) => Some("--reading"),
            (None, false) => Some("--define"),
            (None, true) => None,
        }
    }
}

/// How lists are read.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(in crate::cli) enum ReadingWord {
    /// Falling powers of z, the last entry is the constant
    #[value(name = "z")]
    Z,
    /// Powers of 1/z, the first entry is the constant
    #[value(name = "z^-1")]
    Delays,
}

impl From<ReadingWord> for Reading {
    fn from(word: ReadingWord) -> Reading {
        match word {
            ReadingWord::Z => Reading::Z,
            ReadingWord::Delays => Reading::Delays,
        }
    }
}

/// What stands in the place of DSVerifier's own command line, as words.
#[derive(Clone, Copy, Default)]
pub(in crate::cli) struct Words<'w> {
    pub round: Option<&'w str>,
    pub realisation: Option<&'w str>,
}

/// Whether a file is one of C.
pub(in crate::cli) fn is_c(name: &str, bytes: &[u8]) -> bool {
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("c" | "h" | "i") => true,
        Some(_) => false,
        None => bytes.windows(15).any(|part| part == b"digital_system "),
    }
}

/// The file, and how it is to be written. Where its two readings differ in their verdict, that is said.
pub(in crate::cli) fn read(
    (name, bytes): (&str, &[u8]),
    options: &DsOptions,
    words: Words<'_>,
    context: &Context,
) -> Result<(DsFile, Writing), Error> {
    let writing = writing(options, words, context)?;
    let defines = options.define.iter().map(|text| define(text, context)).collect::<Result<Vec<_>, Error>>()?;
    let source: Arc<Source> = source_from_bytes(name, bytes)?;
    let file = DsFile::read(&source, &defines)?;
    let warning = file.reading_warning(&writing, &context.budget)?;
    // What was said is not asked about.
    if options.reading.is_none() {
        context.warn(Some(&source), warning.as_slice());
    }
    if !context.quiet {
        file.remarks().iter().for_each(|remark| note(&format!("note: {}", decapitalised(remark))));
    }
    Ok((file, writing))
}

fn decapitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}

fn writing(options: &DsOptions, words: Words<'_>, context: &Context) -> Result<Writing, Error> {
    let unknown = |option: &str, word: &str, known: &[&str]| -> Error {
        let error = Diagnostic::error(Code::OptionValue, format!("'{word}' is nothing that {option} knows"));
        let place = context.line.option_value(option, word);
        in_line(context.line, vec![error.at(place.span, "").help(format!("one of {}", known.join(", ")))]).into()
    };
    let mut out = Writing::default();
    if let Some(word) = options.reading {
        out.reading = word.into();
    }
    if let Some(word) = words.round {
        let found = Rounding::ALL.into_iter().find(|mode| mode.name() == word);
        out.rounding = found.ok_or_else(|| unknown("--round", word, &Rounding::ALL.map(Rounding::name)))?;
    }
    if let Some(word) = words.realisation {
        let names = Realisation::ALL.map(Realisation::name);
        out.realisation = Realisation::named(word).ok_or_else(|| unknown("--realisation", word, &names))?;
    }
    Ok(out)
}

fn define(text: &str, context: &Context) -> Result<Define, Error> {
    let parts = text.split_once('=').and_then(|(name, value)| Some((name.trim(), value.trim().parse().ok()?)));
    match parts.filter(|(name, _)| !name.is_empty()) {
        Some((name, value)) => Ok((name.to_owned(), value)),
        None => {
            let error = Diagnostic::error(Code::OptionValue, "-D takes a name and a whole number");
            let place = context.line.option_value("--define", text);
            Err(in_line(context.line, vec![error.at(place.span, "").help("for example: -D DS_ID=1")]).into())
        }
    }
}
