//! `jurist new`: a commented model file to begin with.

use super::{Context, Runs};
use crate::cli::output::write_answer;
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::error::{Code, Diagnostic};
use std::ffi::OsString;

/// Options of `jurist new`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The template; 'gain-loop' if left out
    #[arg(value_name = "TEMPLATE")]
    pub template: Option<String>,
    /// Lists the templates
    #[arg(long, conflicts_with_all = ["template", "output"])]
    pub list: bool,
    /// Writes to a file that does not exist yet
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
}

/// A model file with comments, and what it is in a few words.
struct Template {
    name: &'static str,
    about: &'static str,
    text: &'static str,
}

macro_rules! templates {
    ($($name:literal: $about:literal),* $(,)?) => {
        [$(Template {
            name: $name,
            about: $about,
            text: include_str!(concat!("../templates/", $name, ".toml")),
        }),*]
    };
}

const TEMPLATES: [Template; 11] = templates![
    "gain-loop": "one loop with one gain, the shortest block diagram",
    "cascaded-drive": "cascaded PI control of a DC motor behind a hold",
    "held-plant": "a continuous plant behind a zero-order hold, with a fractional delay",
    "pid-dead-time": "a process with dead time and a PID controller, continuous",
    "matrix": "state space with output feedback",
    "polynomial": "a characteristic polynomial",
    "two-mass": "speed control of two masses with a notch filter",
    "digital-power": "a buck converter behind its pulse-width modulator, voltage mode",
    "cascade-two-rates": "a speed loop at a tenth of the current loop's rate",
    "dq-current": "current control in the dq frame, the voltage held in the frame of the stator",
    "lcl-filter": "grid current through an LCL filter, one sample of computation and the hold",
];

impl Runs for Options {
    fn run(&self, _: &Context) -> Outcome {
        run(self)
    }
}

/// Writes a template to standard output or to a new file.
fn run(options: &Options) -> Outcome {
    if options.list {
        let width = TEMPLATES.iter().map(|t| t.name.len()).max().unwrap_or(0);
        let lines: Vec<String> = TEMPLATES.iter().map(|t| format!("{:width$}  {}", t.name, t.about)).collect();
        write_answer(&lines.join("\n"), None)?;
        return Ok(Status::Holds);
    }
    let name = options.template.as_deref().unwrap_or(TEMPLATES[0].name);
    let template = TEMPLATES.iter().find(|t| t.name == name).ok_or_else(|| unknown(name))?;
    if let Some(file) = options.output.as_ref().filter(|file| *file != "-")
        && std::fs::symlink_metadata(file).is_ok()
    {
        let message = format!("{} exists already", file.to_string_lossy());
        let help = "name a new file, or remove this one first: a template replaces nothing";
        return Err(Diagnostic::error(Code::Write, message).help(help).into());
    }
    write_answer(template.text, options.output.as_ref())?;
    Ok(Status::Holds)
}

fn unknown(name: &str) -> Error {
    let shown: String = name.chars().take(60).collect();
    let names: Vec<&str> = TEMPLATES.iter().map(|t| t.name).collect();
    Diagnostic::error(Code::UnknownTemplate, format!("there is no template '{shown}'"))
        .help(format!("there are {}", names.join(", ")))
        .into()
}
