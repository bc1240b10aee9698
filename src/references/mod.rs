//! Numbers that a model takes from other files, `from = "params.h#PID_KP"`: constants of the firmware, where they are kept.

mod c_header;
mod c_source;
mod c_type;
mod data;
mod literal;

use jurist_algebra::number::{Rational, to_decimal};
use jurist_check::sha256;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source};
use jurist_engine::model::{Model, Reference, source_from_bytes};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// A model's text with the numbers of other files in it, and what came from where.
#[derive(Clone, Debug)]
pub(crate) struct Resolved {
    /// The text, that of the file where it refers to nothing.
    pub source: Arc<Source>,
    /// One for each reference.
    pub numbers: Vec<Number>,
}

/// A number of another file.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    /// The constant or parameter.
    name: String,
    /// The file and the name there.
    from: String,
    /// The value, and how it was read.
    found: Found,
    /// Of the file.
    sha256: String,
}

impl Number {
    /// The file, relative to the model's folder.
    pub fn file(&self) -> &str {
        self.from.split_once('#').map_or(&self.from, |(file, _)| file)
    }

    /// `K_p = 0.100000001490 (params.h#PID_KP, line 12: 0.1f as float32)`.
    pub fn text(&self) -> String {
        let Found { number, written, how, line } = &self.found;
        format!("{} = {} ({}, line {line}: {written} {how})", self.name, to_decimal(number, 12), self.from)
    }
}

/// A number in a file.
#[derive(Clone, Debug)]
struct Found {
    number: Rational,
    /// As it stands there.
    written: String,
    /// How it was read.
    how: String,
    /// On which line.
    line: usize,
}

/// Why a file has no such number.
#[derive(Debug)]
struct Refusal {
    line: Option<usize>,
    why: String,
}

impl Refusal {
    fn of(why: String) -> Refusal {
        Refusal { line: None, why }
    }

    fn at(text: &str, at: usize, why: String) -> Refusal {
        Refusal { line: Some(Self::line(text, at)), why }
    }

    /// The number of the line of a place.
    fn line(text: &str, at: usize) -> usize {
        text.as_bytes()[..at.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1
    }
}

/// Longer files are refused.
const MAX_BYTES: u64 = 16 << 20;

impl Resolved {
    /// The text of a model file with the numbers that it takes from files below its folder.
    ///
    /// # Errors
    /// `E-from` with the place of each reference whose number cannot be had, and what stands in the other file.
    pub fn of(source: &Arc<Source>, folder: &Path) -> Result<Resolved, Diagnostics> {
        let references = Reference::all(source)?;
        let (mut numbers, mut texts, mut errors) = (Vec::new(), Vec::new(), Vec::new());
        for reference in references {
            match number(&reference, folder) {
                Ok(number) => {
                    texts.push((reference, plain(&number.found.number)));
                    numbers.push(number);
                }
                Err(Refusal { line, why }) => {
                    let place = match line {
                        Some(line) => format!("{}, line {line}", reference.file),
                        None => reference.file.clone(),
                    };
                    let message = format!("'{}' has no number: {why}", reference.name);
                    errors.push(Diagnostic::error(Code::From, message).at(reference.span, place));
                }
            }
        }
        if !errors.is_empty() {
            return Err(Diagnostics::new(Some(Arc::clone(source)), errors));
        }
        if texts.is_empty() {
            return Ok(Resolved { source: Arc::clone(source), numbers });
        }
        // Comments behind it say that this is a copy, and where each number is from.
        let mut text = Reference::replaced(source, &texts).text.clone();
        if !text.ends_with('\n') {
            text.push('\n');
        }
        text.push_str(&format!("{COPY} of {}\n", source.name.rsplit(['/', '\\']).next().unwrap_or_default()));
        for number in &numbers {
            text.push_str(&format!("# {}; SHA-256 of the file {}\n", number.text(), number.sha256));
        }
        Ok(Resolved { source: Source::new(source.name.clone(), text), numbers })
    }
}

/// How the comment of a model begins that holds the numbers of other files.
pub(crate) const COPY: &str = "# Numbers of other files stand in this copy";

/// Reads a model file with the numbers that it takes from files below a folder (`from = "params.h#PID_KP"`), with its warnings.
///
/// The text of the model is that with these numbers.
///
/// Cost: that of reading both.
///
/// ```
/// let bytes = std::fs::read("examples/firmware/speed.toml").unwrap();
/// let (model, _) = jurist::cli::model_in_folder("speed.toml", &bytes, "examples/firmware".as_ref())?;
/// assert_eq!(model.constant("alpha").unwrap().number.as_ref().unwrap().to_string(), "1/4");
/// # Ok::<(), jurist::Diagnostics>(())
/// ```
///
/// # Errors
/// As [`Model::from_bytes`], and `E-from` for each number that cannot be had.
pub fn model_in_folder(name: &str, bytes: &[u8], folder: &Path) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
    Model::from_toml(&Resolved::of(&source_from_bytes(name, bytes)?, folder)?.source)
}

/// A number as it can stand in a model: a decimal where that is short, else a fraction.
fn plain(number: &Rational) -> String {
    /// Digits of a decimal.
    const SHORT: usize = 60;
    let decimal = to_decimal(number, SHORT);
    match jurist_algebra::number::parse_number(&decimal) {
        Ok(same) if same == *number => decimal,
        _ => number.to_string(),
    }
}

fn number(reference: &Reference, folder: &Path) -> Result<Number, Refusal> {
    let text = read_below(folder, &reference.file)?;
    let ending =
        Path::new(&reference.file).extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let found = match ending.as_str() {
        "h" | "hh" | "hpp" | "hxx" | "c" | "cc" | "cpp" | "cxx" | "inc" | "ino" => {
            c_header::number(&text, &reference.key, reference.as_decimal)?
        }
        "json" => data::number_of_json(&text, &reference.key)?,
        "yaml" | "yml" => data::number(&text, &reference.key)?,
        _ => {
            return Err(Refusal::of(
                "the file is no C header (.h, .hpp, .c, ..), YAML or JSON, by its ending".to_owned(),
            ));
        }
    };
    Ok(Number {
        name: reference.name.clone(),
        from: format!("{}#{}", reference.file, reference.key),
        found,
        sha256: sha256(&text),
    })
}

/// The text of a file below a folder, wherever links lead.
fn read_below(folder: &Path, file: &str) -> Result<String, Refusal> {
    let refuse = Refusal::of;
    let path = Path::new(file);
    let is_below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !is_below || file.contains('\\') {
        return Err(refuse("the path leads out of the model's folder".to_owned()));
    }
    let unreadable = |error: std::io::Error| refuse(format!("{file} cannot be read: {error}"));
    let root: PathBuf = folder.canonicalize().map_err(unreadable)?;
    let whole = root.join(path).canonicalize().map_err(unreadable)?;
    if !whole.starts_with(&root) {
        return Err(refuse("the path leads out of the model's folder, by a link".to_owned()));
    }
    if !whole.is_file() {
        return Err(refuse(format!("{file} is not a file")));
    }
    let mut bytes = Vec::new();
    File::open(&whole).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(format!("{file} is longer than {} MB", MAX_BYTES >> 20)));
    }
    // Comments of headers are in any encoding; numbers and names are not.
    Ok(String::from_utf8(bytes).unwrap_or_else(|error| error.into_bytes().iter().map(|b| char::from(*b)).collect()))
}
