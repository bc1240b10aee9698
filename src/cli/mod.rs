//! The command line: arguments, files, standard output, exit statuses.
//!
//! One file per command in `commands`; each returns a status or the reason why there is no answer. Without the feature `cli`
//! there is no program: no file is written, and commands that only draw, make pages or explain are left out.

mod arguments;
mod assignments;
mod captured;
mod command_line;
mod commands;
mod destinations;
#[cfg(feature = "cli")]
mod export;
#[cfg(feature = "cli")]
mod import;
mod input;
mod output;
mod picture;
mod plain;
#[cfg(all(feature = "cli", not(target_family = "wasm")))]
mod progress;
#[cfg(not(all(feature = "cli", not(target_family = "wasm"))))]
#[path = "progress_untold.rs"]
mod progress;
mod replace;
mod requirements;
mod status;
#[cfg(feature = "cli")]
mod suite;
#[cfg(feature = "cli")]
mod sweep;
#[cfg(feature = "cli")]
mod table;
#[cfg(all(feature = "cli", not(target_family = "wasm")))]
mod watch;
mod written;

#[cfg(feature = "cli")]
pub use crate::references::model_in_folder;
pub use captured::{Captured, captured};

use arguments::Arguments;
use clap::Parser;
use command_line::CommandLine;
use commands::Context;
use jurist_engine::error::{Code, Diagnostic};
use jurist_show::diagnostics::render_error;
use status::{Error, Outcome, Status};
use std::ffi::OsString;
use std::process::ExitCode;

/// The command line as data: commands and options with their help, of which manual pages are made.
pub fn command() -> clap::Command {
    <Arguments as clap::CommandFactory>::command()
}

/// Runs the program on the process's arguments, given whether standard output was closed when it began: the
/// runtime has replaced it by then with one that loses everything.
pub fn main(output_closed: bool) -> ExitCode {
    ExitCode::from(program_with(std::env::args_os(), output_closed, Host::Process))
}

/// Runs the program on a list of arguments, its name first; gives the exit status.
pub fn program(arguments: impl IntoIterator<Item = OsString>, output_closed: bool) -> u8 {
    program_with(arguments, output_closed, Host::Another)
}

/// Whose process it is that a command runs in.
#[derive(Clone, Copy, PartialEq)]
enum Host {
    /// The program's own, which may be ended.
    Process,
    /// One that goes on.
    Another,
}

fn program_with(arguments: impl IntoIterator<Item = OsString>, output_closed: bool, host: Host) -> u8 {
    quiet_panics();
    output::note_closed(output_closed);
    let line = CommandLine::new(arguments);
    // A panic is a defect of this program; even then there is a message and no backtrace.
    let status = std::panic::catch_unwind(|| run(&line, host));
    status.unwrap_or(101)
}

fn run(line: &CommandLine, #[cfg_attr(not(feature = "cli"), allow(unused_variables))] host: Host) -> u8 {
    let arguments = match Arguments::try_parse_from(line.arguments()) {
        Ok(arguments) => arguments,
        Err(answer) if !answer.use_stderr() => {
            // Help and version, in clap's colours on a terminal.
            if let Err(Error::Refused(error)) = output::print_with(|| answer.print()) {
                show(&error);
                return Status::BadInput as u8;
            }
            return Status::Holds as u8;
        }
        Err(error) => {
            show(&line.usage_error(&error));
            return Status::BadInput as u8;
        }
    };
    let context = Context::new(line, &arguments);
    #[cfg(all(feature = "cli", not(target_family = "wasm")))]
    if host == Host::Process {
        watch::begin(&context, arguments.run_options(), arguments.asked().without_answer());
    }
    let outcome = answered(&arguments, &context);
    context.reporter.finish();
    if !context.quiet && !arguments.asked().writes_a_folder() {
        output::tell_files();
    }
    context.reporter.tell_work(&context.budget);
    match outcome {
        Ok(status) => status as u8,
        Err(Error::Refused(error)) => {
            show(&error);
            Status::BadInput as u8
        }
        Err(Error::Stopped(stopped)) => {
            output::note(&format!("undecided: {stopped}"));
            Status::Undecided as u8
        }
        Err(Error::Undefined(why)) => {
            show(
                &Diagnostic::error(Code::Undefined, format!("the model is undefined for these values: {why}"))
                    .help("set the parameters to other values")
                    .into(),
            );
            Status::BadInput as u8
        }
        // A way to have no answer that is not known here yet.
        Err(failure) => {
            output::note(&failure.to_string());
            Status::BadInput as u8
        }
    }
}

/// What the command gives; where the budget runs out outside of all steps that answer that themselves, nothing is known.
fn answered(arguments: &Arguments, context: &Context) -> Outcome {
    let work = || destinations::check(arguments, context).and_then(|()| arguments.asked().run(context));
    context.budget.surround(work).unwrap_or_else(|stopped| Err(stopped.into()))
}

/// Draws an error or warnings on standard error, in colour if it is a terminal that wants it.
fn show(error: &jurist_engine::error::Diagnostics) {
    output::note(render_error(error, output::colored_errors()).trim_end());
}

/// Replaces Rust's message and backtrace by one line in the style of the other errors.
fn quiet_panics() {
    std::panic::set_hook(Box::new(|info| {
        let what = info.payload_as_str().unwrap_or("no message");
        let place = info.location().map(|l| format!(" ({}:{})", l.file(), l.line())).unwrap_or_default();
        output::note(&format!("error[E-internal]: this is a defect of jurist, please report it: {what}{place}"));
    }));
}
