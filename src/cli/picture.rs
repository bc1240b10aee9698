//! Pictures to files and to the terminal.

use super::arguments::PictureOptions;
pub(super) use super::output::write_file as write;
use super::output::{ending, note_answered, unknown_ending, write_answer};
use super::status::Error;
use jurist_draw::figures::Figure;
use jurist_engine::error::{Code, Diagnostic};
use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::Path;

/// Whether this build draws, and writes files at all; where it does not, every answer goes to standard output.
pub(super) const WRITES: bool = cfg!(feature = "cli");

/// Pixels per unit of a PNG.
const PNG_SCALE: f32 = 2.0;

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
    Pdf,
    Csv,
    Json,
    /// A drawing in characters on a terminal, a table into a pipe.
    Standard,
}

/// A picture and its data.
pub(super) struct Picture<'a> {
    pub figure: &'a Figure,
    pub csv: &'a dyn Fn() -> String,
    pub json: &'a dyn Fn() -> String,
    /// Whether the data are also written beside the picture.
    pub csv_beside: bool,
}

/// What the output option asks for, before any work is done.
pub(super) fn wanted(options: &PictureOptions) -> Result<Kind, Error> {
    if options.json {
        return Ok(Kind::Json);
    }
    let Some(file) = options.output.as_ref().filter(|f| *f != "-") else { return Ok(Kind::Standard) };
    match ending(file).as_deref() {
        Some("svg") if WRITES => Ok(Kind::Svg),
        Some("png") if WRITES => Ok(Kind::Png),
        Some("pdf") if WRITES => Ok(Kind::Pdf),
        Some("csv") => Ok(Kind::Csv),
        Some("json") => Ok(Kind::Json),
        _ => Err(unknown_ending(file, &["svg", "png", "pdf", "csv", "json"]).into()),
    }
}

/// Writes the picture.
pub(super) fn deliver(picture: &Picture<'_>, kind: Kind, file: Option<&OsString>) -> Result<(), Error> {
    if kind == Kind::Json {
        write_answer(&(picture.json)(), file)?;
    }
    let Some(file) = file.filter(|f| kind != Kind::Standard && *f != "-") else {
        if kind == Kind::Json {
            return Ok(());
        }
        let print = |text: &str| write_answer(text, None);
        if !WRITES || !std::io::stdout().is_terminal() {
            return print(&(picture.csv)());
        }
        let plain = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        return print(&picture.figure.terminal(terminal_columns(), !plain));
    };
    let path = Path::new(file);
    match kind {
        Kind::Svg if WRITES => write(path, picture.figure.svg().as_bytes())?,
        Kind::Png if WRITES => write(path, &png(picture.figure)?)?,
        Kind::Pdf if WRITES => write(path, &pdf(picture.figure)?)?,
        Kind::Json => {}
        _ => write(path, (picture.csv)().as_bytes())?,
    }
    if picture.csv_beside && kind != Kind::Csv {
        write(&path.with_extension("csv"), (picture.csv)().as_bytes())?;
    }
    note_answered();
    Ok(())
}

/// Columns of the terminal as the shell tells them, else 80, which every terminal has.
fn terminal_columns() -> usize {
    let told = std::env::var("COLUMNS").ok().and_then(|c| c.parse::<usize>().ok());
    told.unwrap_or(80).clamp(40, 220)
}

/// The PNG's bytes.
pub(super) fn png(figure: &Figure) -> Result<Vec<u8>, Error> {
    figure.png(PNG_SCALE).map_err(cannot_draw)
}

/// The PDF's bytes.
pub(super) fn pdf(figure: &Figure) -> Result<Vec<u8>, Error> {
    figure.pdf().map_err(cannot_draw)
}

fn cannot_draw(message: String) -> Error {
    Diagnostic::error(Code::Write, format!("cannot draw the picture: {message}")).into()
}
