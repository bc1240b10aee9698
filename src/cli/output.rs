//! Where answers and remarks go: standard output or a file, and standard error.

use super::captured;
use super::replace::{Destination, replace};
use super::status::Error;
use jurist_engine::error::{Code, Diagnostic};
use std::ffi::{OsStr, OsString};
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Writes an answer to the file, or to standard output if there is none.
///
/// A reader that stops reading (`| head -1`) is no error.
pub(super) fn write_answer(answer: &str, file: Option<&OsString>) -> Result<(), Error> {
    let mut answer = answer.to_owned();
    if !answer.is_empty() && !answer.ends_with('\n') {
        answer.push('\n');
    }
    match file {
        Some(path) if path != OsStr::new("-") => write_file(Path::new(path), answer.as_bytes()),
        _ => write_standard(answer.as_bytes()).map_err(|e| write_error("standard output", &e)),
    }
}

/// Writes the answer itself, not a proof beside it: there is one from now on, whatever is done afterwards.
pub(super) fn finish_answer(answer: &str, file: Option<&OsString>) -> Result<(), Error> {
    write_answer(answer, file)?;
    note_answered();
    Ok(())
}

/// Writes to standard output how an answer begins that is still being worked on; whether that was possible.
pub(super) fn write_beginning(text: &str) -> bool {
    let _held = writing();
    let before = ANSWERED.load(Ordering::Relaxed);
    let written = write_to_standard(text.as_bytes()).is_ok();
    ANSWERED.store(before, Ordering::Relaxed);
    written
}

/// Notes that the answer has been written.
pub(super) fn note_answered() {
    ANSWERED.store(true, Ordering::Relaxed);
}

/// Held while something is being written.
static WRITING: Mutex<()> = Mutex::new(());

/// Whether there is an answer.
static ANSWERED: AtomicBool = AtomicBool::new(false);

fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps all others from writing; `None` where an answer has been written.
#[cfg(all(feature = "cli", not(target_family = "wasm")))]
pub(super) fn instead_of_an_answer() -> Option<impl Sized> {
    let held = writing();
    (!ANSWERED.load(Ordering::Relaxed)).then_some(held)
}

/// Makes the bytes the content of a file, as a whole or not at all.
pub(super) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let _held = writing();
    let failed = |e: std::io::Error| write_error(&path.to_string_lossy(), &e);
    let destination = Destination::of(path).map_err(failed)?;
    replace(&destination, bytes).map_err(failed)?;
    if matches!(destination, Destination::File(_)) && captured::budget().is_none() {
        FILES.lock().unwrap_or_else(PoisonError::into_inner).push(path.display().to_string());
    }
    Ok(())
}

/// The files that have been written and not been told of.
static FILES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Says on standard error which files have been written.
pub(super) fn tell_files() {
    let files = std::mem::take(&mut *FILES.lock().unwrap_or_else(PoisonError::into_inner));
    if let Some((last, others)) = files.split_last() {
        let and = if others.is_empty() { "" } else { " and " };
        note(&format!("wrote {}{and}{last}", others.join(", ")));
    }
}

/// Whether standard output was closed when the program began.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Notes whether standard output was closed when the program began.
pub(super) fn note_closed(closed: bool) {
    CLOSED.store(closed, Ordering::Relaxed);
}

/// Writes to standard output; a reader that stops reading is no error.
pub(super) fn write_standard(bytes: &[u8]) -> std::io::Result<()> {
    if captured::write(bytes) {
        return Ok(());
    }
    let _held = writing();
    write_to_standard(bytes)
}

/// Writes to standard output, where nobody else does.
pub(super) fn write_to_standard(bytes: &[u8]) -> std::io::Result<()> {
    if CLOSED.load(Ordering::Relaxed) {
        return Err(std::io::Error::other("it is closed"));
    }
    if !bytes.is_empty() {
        ANSWERED.store(true, Ordering::Relaxed);
    }
    let mut stdout = std::io::stdout().lock();
    // The library's own writer takes a descriptor that is not open for writing for one that swallows everything.
    #[cfg(unix)]
    let mut file = std::fs::File::from(std::os::fd::AsFd::as_fd(&stdout).try_clone_to_owned()?);
    #[cfg(unix)]
    // Nothing at all is written too: even that needs a descriptor that is open for writing.
    let written = stdout.flush().and_then(|()| file.write(&[])).and_then(|_| file.write_all(bytes));
    #[cfg(not(unix))]
    let written = stdout.write_all(bytes).and_then(|()| stdout.flush());
    match written {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(e),
        _ => Ok(()),
    }
}

/// Has something else print to standard output, with the same errors as an answer.
pub(super) fn print_with(print: impl FnOnce() -> std::io::Result<()>) -> Result<(), Error> {
    let printed = write_standard(&[]).and_then(|()| print()).and_then(|()| std::io::stdout().flush());
    match printed {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(write_error("standard output", &e)),
        _ => Ok(()),
    }
}

/// What is said where a write fails.
pub(super) fn write_error(what: &str, error: &std::io::Error) -> Error {
    Error::from(Diagnostic::error(Code::Write, format!("cannot write {what}: {}", plain(error))))
}

/// The system's message without its number.
pub(super) fn plain(error: &std::io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_lowercase(),
        None => text,
    }
}

/// Writes a line to standard error; nobody may be listening.
pub(super) fn note(line: &str) {
    if !captured::note(line) {
        let _ = writeln!(std::io::stderr().lock(), "{line}");
    }
}

/// The format a file's ending asks for, in lower case; `None` without an ending.
pub(super) fn ending(file: &OsStr) -> Option<String> {
    Path::new(file).extension().map(|e| e.to_string_lossy().to_lowercase())
}

/// Refuses a file ending that the command cannot write.
pub(super) fn unknown_ending(file: &OsStr, known: &[&str]) -> Diagnostic {
    let endings: Vec<String> = known.iter().map(|e| format!(".{e}")).collect();
    let message = match ending(file) {
        Some(e) => format!("this command does not write '.{e}' files"),
        None => "the file name's ending has to say the format".to_owned(),
    };
    Diagnostic::error(Code::OutputFormat, message).help(format!("it writes {}", endings.join(", ")))
}

/// Whether errors are drawn in colour: on a terminal, unless `NO_COLOR` is set or the terminal is dumb.
pub(super) fn colored_errors() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    std::io::stderr().is_terminal() && !set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
}
