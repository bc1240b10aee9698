//! State-space systems in files of other programs: one file for each format, and what is written of them.
//!
//! Crates for these formats were looked at: matfile reads no structs, matrw and npyz bring parsers and more with them. A system needs little
//! of a format: the readers here take that, and unpack with `miniz_oxide` up to a limit.

mod assemble;
mod csv;
pub(super) mod dsverifier;
mod json;
mod mat;
mod mat_element;
mod modelica;
mod modelica_token;
mod names;
mod npy;
mod number;
mod write;
mod zip;

pub(super) use assemble::assemble;
pub(super) use write::{Form, model};

use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source, Span};
use number::{Number, Unread};
use std::sync::Arc;

/// Longer text files are refused.
const MAX_TEXT_BYTES: usize = 8 << 20;

/// What a compressed file may unpack to.
const MAX_UNPACKED: usize = 64 << 20;

/// States, inputs and outputs of a system, each.
const MAX_SIDE: usize = 200;

/// What is known of time.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Time {
    Continuous,
    /// With the sample time as it is written in a model file, where it is known.
    Discrete(Option<String>),
}

/// A matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Matrix {
    rows: usize,
    columns: usize,
    entries: Vec<Number>,
}

/// Names that the file gives; empty where it gives none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Names {
    title: Option<String>,
    states: Vec<String>,
    inputs: Vec<String>,
    outputs: Vec<String>,
}

/// A system `x' = A x + B u`, `y = C x + D u`, or the next `x` in place of `x'`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StateSpace {
    a: Matrix,
    /// `B` and `D` of a system with inputs.
    inputs: Option<(Matrix, Matrix)>,
    c: Matrix,
    time: Time,
    names: Names,
    /// What is to be said of it.
    remarks: Vec<String>,
}

/// How an array stood in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Scalar,
    /// An array of one dimension: a row or a column.
    Vector(usize),
    Matrix(usize, usize),
}

/// A named array, row by row.
#[derive(Clone, Debug, PartialEq)]
struct Variable {
    name: String,
    shape: Shape,
    entries: Vec<Number>,
    /// Where it stands in a text.
    span: Option<Span>,
}

/// What a reader found.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Variables {
    list: Vec<Variable>,
    /// The names of all there is, for people.
    present: Vec<String>,
    names: Names,
}

#[cfg(test)]
impl Variables {
    /// `A Matrix(1, 2) 0 1.50`, one for each variable.
    fn shown(&self) -> Vec<String> {
        let numbers = |v: &Variable| v.entries.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        self.list.iter().map(|v| format!("{} {:?} {}", v.name, v.shape, numbers(v))).collect()
    }
}

/// Names that are read.
const WANTED: [&str; 6] = ["A", "B", "C", "D", "Ts", "dt"];

/// Names of what would make it another system.
const DELAYS: [&str; 4] = ["InputDelay", "OutputDelay", "IODelay", "InternalDelay"];

/// The matrix of a descriptor system, where it is of the size of A.
const DESCRIPTOR: &str = "E";

fn is_read(name: &str) -> bool {
    WANTED.contains(&name) || DELAYS.contains(&name)
}

/// An error of this command.
fn refused(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(Code::Import, message)
}

/// An error about a file that is no text, with its name.
pub(super) fn in_file(name: &str, mut error: Diagnostic) -> Diagnostic {
    error.message = format!("{name}: {}", error.message);
    error
}

/// An entry that is no number of a matrix.
fn bad_entry(name: &str, row: usize, column: usize, why: Unread, shown: &str) -> Diagnostic {
    let shown: String = shown.chars().take(40).collect();
    let what = match why {
        Unread::NotFinite => format!("{shown}: not a finite number"),
        Unread::TooLong => "a number with too many digits or too large an exponent".to_owned(),
        Unread::NotANumber if shown.is_empty() => "empty".to_owned(),
        Unread::NotANumber => format!("'{shown}', which is no real decimal number"),
    };
    refused(format!("row {}, column {} of {name} is {what}", row + 1, column + 1))
}

/// The text of a file that has to be one.
fn text_of(name: &str, bytes: &[u8]) -> Result<Arc<Source>, Diagnostics> {
    if bytes.len() > MAX_TEXT_BYTES {
        let message = format!("{name} is longer than {} megabytes", MAX_TEXT_BYTES >> 20);
        return Err(refused(message).into());
    }
    jurist_engine::model::source_from_bytes(name, bytes)
}

/// Reads the variables of a file whose name's ending, or else its first bytes, say what it is. Of a text file they come with the
/// text in which they have their places.
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<(Variables, Option<Arc<Source>>), Diagnostics> {
    let text = |read: fn(&str) -> Result<Variables, Diagnostic>| {
        let source = text_of(name, bytes)?;
        let variables = read(&source.text).map_err(|error| Diagnostics::from(error).in_source(&source))?;
        Ok((variables, Some(source)))
    };
    let binary = |read: fn(&[u8]) -> Result<Variables, Diagnostic>| {
        let variables = read(bytes).map_err(|error| in_file(name, error))?;
        Ok((variables, None))
    };
    match format(name, bytes) {
        Some(Format::Mat) => binary(mat::read),
        Some(Format::Npz) => binary(npy::read_archive),
        Some(Format::Json) => text(json::read),
        Some(Format::Csv) => text(csv::read),
        Some(Format::Modelica) => text(modelica::read),
        None => Err(refused(format!("{name} is of no format that can be imported"))
            .help("there are .mat (MATLAB, SciPy), .npz (NumPy), .json, .csv, .mo (OpenModelica's linearize), and .c (DSVerifier)")
            .into()),
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Mat,
    Npz,
    Json,
    Csv,
    Modelica,
}

fn format(name: &str, bytes: &[u8]) -> Option<Format> {
    let ending = std::path::Path::new(name).extension().map(|e| e.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("mat") => return Some(Format::Mat),
        Some("npz") => return Some(Format::Npz),
        Some("json") => return Some(Format::Json),
        Some("csv" | "txt") => return Some(Format::Csv),
        Some("mo") => return Some(Format::Modelica),
        _ => {}
    }
    if bytes.starts_with(b"MATLAB") || bytes.starts_with(b"\x89HDF") {
        return Some(Format::Mat);
    }
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\x93NUMPY") {
        return Some(Format::Npz);
    }
    let text = std::str::from_utf8(bytes).ok()?.trim_start_matches('\u{feff}').trim_start();
    match text {
        _ if text.starts_with('{') => Some(Format::Json),
        _ if text.starts_with("model ") => Some(Format::Modelica),
        _ if text.is_empty() || text.contains('\0') => None,
        _ => Some(Format::Csv),
    }
}
