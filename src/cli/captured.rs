//! Commands run for another program: what they would write is handed over.

use super::answered;
use super::arguments::Arguments;
use super::command_line::CommandLine;
use super::commands::Context;
use super::plain::plain;
use clap::Parser;
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Diagnostic, Diagnostics, Error, Source};
use jurist_engine::model::Model;
use jurist_show::diagnostics::render_error;
use std::cell::RefCell;
use std::ffi::OsString;
use std::sync::Arc;

/// What a command would have written, and how it would have ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Captured {
    /// The exit status.
    pub status: u8,
    /// Standard output.
    pub output: String,
    /// Remarks on standard error, one each.
    pub notes: Vec<String>,
    /// Warnings: their codes, and how they look without colours.
    pub warnings: Vec<(&'static str, String)>,
}

/// Where a command's output goes on this thread.
struct Sink {
    model: Model,
    budget: Budget,
    captured: Captured,
    bytes: Vec<u8>,
}

thread_local! {
    static SINK: RefCell<Option<Sink>> = const { RefCell::new(None) };
}

/// Puts back what held on the thread before.
struct Installed(Option<Sink>);

impl Drop for Installed {
    fn drop(&mut self) {
        SINK.set(self.0.take());
    }
}

/// Runs a command, its name and options as on the command line; `-` as MODEL is the given model. Files named by options
/// are written.
///
/// ```
/// use jurist::cli::captured;
/// use jurist::{Budget, Model};
/// let arguments = ["intervals", "-", "--param", "K_pwm", "--digits", "4"];
/// let captured = captured(arguments, &Model::drive(), &Budget::unlimited())?;
/// assert_eq!(captured.status, 0);
/// assert!(captured.output.contains("550.9"));
/// # Ok::<(), jurist::Error>(())
/// ```
///
/// # Errors
/// [`Error`] where the program would end with the status 2, or without having written anything with 3.
pub fn captured<S: Into<OsString>>(
    arguments: impl IntoIterator<Item = S>,
    model: &Model,
    budget: &Budget,
) -> Result<Captured, Error> {
    let arguments = arguments.into_iter().map(Into::into);
    let line = CommandLine::new(std::iter::once(OsString::from("jurist")).chain(arguments));
    let arguments = line.arguments();
    let parsed = match plain(&arguments).map_or_else(|| Arguments::try_parse_from(arguments), Ok) {
        Ok(parsed) => parsed,
        Err(answer) if !answer.use_stderr() => {
            return Ok(Captured { output: answer.to_string(), ..Captured::default() });
        }
        Err(error) => return Err(line.usage_error(&error).into()),
    };
    let sink = Sink { model: model.clone(), budget: budget.clone(), captured: Captured::default(), bytes: Vec::new() };
    let before = Installed(SINK.replace(Some(sink)));
    let context = Context::new(&line, &parsed);
    let outcome = answered(&parsed, &context);
    let Some(sink) = SINK.take() else { unreachable!("it was installed above") };
    drop(before);
    let output = String::from_utf8_lossy(&sink.bytes).into_owned();
    Ok(Captured { status: outcome? as u8, output, ..sink.captured })
}

/// Takes what is written to standard output, if this thread's output is captured.
pub(super) fn write(bytes: &[u8]) -> bool {
    with(|sink| sink.bytes.extend_from_slice(bytes)).is_some()
}

/// Takes a remark.
pub(super) fn note(line: &str) -> bool {
    with(|sink| sink.captured.notes.push(line.to_owned())).is_some()
}

/// Takes warnings.
pub(super) fn warn(source: Option<&Arc<Source>>, warnings: &[Diagnostic]) -> bool {
    let one = |warning: &Diagnostic| {
        let alone = Diagnostics::new(source.cloned(), vec![warning.clone()]);
        (warning.code.as_str(), render_error(&alone, false))
    };
    with(|sink| sink.captured.warnings.extend(warnings.iter().map(one))).is_some()
}

/// The model that stands for standard input.
pub(super) fn model() -> Option<Model> {
    with(|sink| sink.model.clone())
}

/// The budget, which replaces that of the options.
pub(super) fn budget() -> Option<Budget> {
    with(|sink| sink.budget.clone())
}

fn with<T>(f: impl FnOnce(&mut Sink) -> T) -> Option<T> {
    SINK.with_borrow_mut(|sink| sink.as_mut().map(f))
}
