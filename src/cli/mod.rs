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
mod sweep;
mod written;

pub use captured::{Captured, captured};

use arguments::Arguments;
use clap::Parser;
use command_line::CommandLine;
use commands::Context;
use jurist_engine::error::Diagnostic;
use jurist_engine::show::diagnostics::render_error;
use status::{Error, Status};
use std::ffi::OsString;
use std::process::ExitCode;

/// Runs the program on the process's arguments, given whether standard output was closed when it began: the
/// runtime has replaced it by then with one that loses everything.
pub fn main(output_closed: bool) -> ExitCode {
    ExitCode::from(program(std::env::args_os(), output_closed))
}

/// Runs the program on a list of arguments, its name first; gives the exit status.
pub fn program(arguments: impl IntoIterator<Item = OsString>, output_closed: bool) -> u8 {
    quiet_panics();
    output::note_closed(output_closed);
    let line = CommandLine::new(arguments);
    // A panic is a defect of this program; even then there is a message and no backtrace.
    let status = std::panic::catch_unwind(|| run(&line));
    status.unwrap_or(101)
}

fn run(line: &CommandLine) -> u8 {
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
    let outcome = destinations::check(&arguments, &context).and_then(|()| commands::run(&arguments, &context));
    context.reporter.finish();
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
                &Diagnostic::error("E-undefined", format!("the model is undefined for these values: {why}"))
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
