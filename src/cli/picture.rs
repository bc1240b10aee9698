//! Pictures to files and to the terminal.

use super::output::{ending, unknown_ending};
use super::status::Failure;
use crate::error::Diagnostic;
use crate::report::figures::Figure;
use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::Path;

/// Pixels per unit of a PNG.
const PNG_SCALE: f32 = 2.0;

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
    Csv,
    /// A drawing in characters on a terminal, a table into a pipe.
    Standard,
}

/// A picture and its data.
pub(super) struct Picture<'a> {
    pub figure: &'a Figure,
    pub csv: &'a dyn Fn() -> String,
    /// Whether the data are also written beside the picture.
    pub csv_beside: bool,
}

/// What the output option asks for, before any work is done.
pub(super) fn wanted(file: Option<&OsString>) -> Result<Kind, Failure> {
    let Some(file) = file.filter(|f| *f != "-") else { return Ok(Kind::Standard) };
    match ending(file).as_deref() {
        Some("svg") => Ok(Kind::Svg),
        Some("png") => Ok(Kind::Png),
        Some("csv") => Ok(Kind::Csv),
        _ => Err(unknown_ending(file, &["svg", "png", "csv"]).into()),
    }
}

/// Writes the picture.
pub(super) fn deliver(
    picture: &Picture<'_>,
    kind: Kind,
    file: Option<&OsString>,
    print: impl Fn(&str) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let Some(file) = file.filter(|_| kind != Kind::Standard) else {
        if !std::io::stdout().is_terminal() {
            return print(&(picture.csv)());
        }
        return print(&picture.figure.terminal(terminal_columns(), 40));
    };
    let path = Path::new(file);
    match kind {
        Kind::Svg => write(path, picture.figure.svg().as_bytes())?,
        Kind::Png => write(path, &png(picture.figure)?)?,
        Kind::Csv | Kind::Standard => write(path, (picture.csv)().as_bytes())?,
    }
    if picture.csv_beside && kind != Kind::Csv {
        write(&path.with_extension("csv"), (picture.csv)().as_bytes())?;
    }
    Ok(())
}

/// Columns of the terminal as the shell tells them, else 100.
fn terminal_columns() -> usize {
    let told = std::env::var("COLUMNS").ok().and_then(|c| c.parse::<usize>().ok());
    told.unwrap_or(100).clamp(40, 220)
}

/// The PNG's bytes.
pub(super) fn png(figure: &Figure) -> Result<Vec<u8>, Failure> {
    figure.png(PNG_SCALE).map_err(|e| Diagnostic::error("E-write", format!("cannot draw the picture: {e}")).into())
}

/// Writes bytes to a file.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    std::fs::write(path, bytes).map_err(|e| {
        let message = format!("cannot write {}: {}", path.display(), super::output::plain(&e));
        Diagnostic::error("E-write", message).into()
    })
}
