//! `jurist-check`: the certificate checker as a program of its own.

#![forbid(unsafe_code)]

use jurist_check::format::MAX_TEXT;
use jurist_check::{Limits, Names, check, report};
use std::ffi::{OsStr, OsString};
use std::io::{Read, Write};
use std::process::ExitCode;
use std::time::Duration;

const HELP: &str = "\
Checks that a certificate proves its statement about a model.

Usage: jurist-check [OPTIONS] MODEL CERTIFICATE

Arguments:
  MODEL        The model that the statement is about, '-' for standard input
  CERTIFICATE  The certificate, '-' for standard input

Options:
      --timeout SECONDS  Give up after this time [default: 60]; 'inf' for never
  -h, --help             Print help
  -V, --version          Print version

Status: 0 the statement is proved, and printed; 4 the certificate is rejected; 2 wrong arguments, or a file that cannot be read.
";

/// The status of a certificate that proves nothing.
const REJECTED: u8 = 4;

/// The status of arguments and files that cannot be used.
const UNUSABLE: u8 = 2;

/// What the arguments ask for.
#[derive(Debug, PartialEq)]
enum Task {
    Help,
    Version,
    Check { model: OsString, certificate: OsString, limits: Limits },
}

/// Reads the arguments; those after `--` are no options.
fn task(arguments: impl Iterator<Item = OsString>) -> Result<Task, String> {
    let (mut files, mut limits, mut options) = (Vec::new(), Limits::default(), true);
    let mut arguments = arguments.fuse();
    while let Some(argument) = arguments.next() {
        match argument.to_str().filter(|text| options && text.len() > 1 && text.starts_with('-')) {
            None => files.push(argument),
            Some("--") => options = false,
            Some("-h" | "--help") => return Ok(Task::Help),
            Some("-V" | "--version") => return Ok(Task::Version),
            Some("--timeout") => {
                limits.timeout = seconds(&arguments.next().ok_or("--timeout needs a number of seconds")?)?
            }
            Some(other) => match other.strip_prefix("--timeout=") {
                Some(value) => limits.timeout = seconds(OsStr::new(value))?,
                None => return Err(format!("unknown option '{}'", other.escape_debug())),
            },
        }
    }
    let Ok([model, certificate]) = <[OsString; 2]>::try_from(files) else {
        return Err("a model and a certificate are expected".into());
    };
    if model == "-" && certificate == "-" {
        return Err("the model and the certificate cannot both be standard input".into());
    }
    Ok(Task::Check { model, certificate, limits })
}

fn seconds(text: &OsStr) -> Result<Duration, String> {
    let wrong = || "--timeout needs a number of seconds, such as 10 or 0.5".to_owned();
    let seconds: f64 = text.to_str().and_then(|text| text.parse().ok()).ok_or_else(wrong)?;
    if seconds.is_nan() || seconds < 0.0 {
        return Err(wrong());
    }
    // Longer than the clock can count is as good as for ever.
    Ok(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

/// The bytes of a file or of the standard input, of which there may be more than a check accepts.
fn bytes(name: &OsStr) -> Result<Vec<u8>, String> {
    let (mut bytes, most) = (Vec::new(), MAX_TEXT as u64 + 1);
    let read = if name == "-" {
        std::io::stdin().lock().take(most).read_to_end(&mut bytes)
    } else {
        std::fs::File::open(name).and_then(|file| file.take(most).read_to_end(&mut bytes))
    };
    match read {
        Ok(_) => Ok(bytes),
        Err(error) => Err(format!("cannot read '{}': {error}", name.to_string_lossy().escape_debug())),
    }
}

/// The proved statement, or why nothing is proved.
fn verdict(model: Vec<u8>, certificate: Vec<u8>, names: Names<'_>, limits: &Limits) -> Result<String, String> {
    let text = |bytes: Vec<u8>, what: &str| {
        String::from_utf8(bytes).map_err(|_| format!("the certificate is rejected: {what} is not UTF-8"))
    };
    let (model, certificate) = (text(model, "the model")?, text(certificate, "the certificate")?);
    let proved = check(&model, &certificate, limits).map_err(|rejection| rejection.to_string())?;
    Ok(report(&proved, &model, &certificate, names))
}

/// The name of a file for people.
fn shown(name: &OsStr) -> String {
    if name == "-" { "standard input".into() } else { name.to_string_lossy().into_owned() }
}

fn run() -> Result<ExitCode, String> {
    let answer = match task(std::env::args_os().skip(1)).map_err(|e| format!("{e}; see jurist-check --help"))? {
        Task::Help => HELP.to_owned(),
        Task::Version => concat!("jurist-check ", env!("CARGO_PKG_VERSION"), "\n").to_owned(),
        Task::Check { model, certificate, limits } => {
            let [of_model, of_certificate] = [&model, &certificate].map(|name| shown(name));
            let names = Names { model: &of_model, certificate: &of_certificate };
            match verdict(bytes(&model)?, bytes(&certificate)?, names, &limits) {
                Ok(said) => said,
                Err(reason) => {
                    complain(&reason);
                    return Ok(ExitCode::from(REJECTED));
                }
            }
        }
    };
    let mut output = std::io::stdout().lock();
    output.write_all(answer.as_bytes()).and_then(|()| output.flush()).map_err(|e| format!("cannot write: {e}"))?;
    Ok(ExitCode::SUCCESS)
}

/// A line for people; where nobody reads it, the status remains.
fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

fn main() -> ExitCode {
    run().unwrap_or_else(|reason| {
        complain(&format!("error: {reason}"));
        ExitCode::from(UNUSABLE)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(arguments: &[&str]) -> Result<Task, String> {
        task(arguments.iter().map(OsString::from))
    }

    #[test]
    fn arguments_are_two_files_and_options() {
        let check = |model: &str, certificate: &str, timeout| {
            Ok(Task::Check { model: model.into(), certificate: certificate.into(), limits: Limits::within(timeout) })
        };
        assert_eq!(of(&["m", "c"]), check("m", "c", Limits::default().timeout));
        assert_eq!(of(&["--timeout", "0.5", "-", "c"]), check("-", "c", Duration::from_millis(500)));
        assert_eq!(of(&["m", "--timeout=inf", "-"]), check("m", "-", Duration::MAX));
        assert_eq!(of(&["--", "-m", "--help"]), check("-m", "--help", Limits::default().timeout));
        assert_eq!((of(&["m", "--help"]), of(&["-V"])), (Ok(Task::Help), Ok(Task::Version)));
        for wrong in [
            vec![],
            vec!["m"],
            vec!["m", "c", "d"],
            vec!["-", "-"],
            vec!["m", "c", "--fast"],
            vec!["m", "c", "--timeout"],
            vec!["m", "c", "--timeout", "-1"],
            vec!["m", "c", "--timeout=nan"],
        ] {
            assert!(of(&wrong).is_err(), "{wrong:?}");
        }
    }
}
