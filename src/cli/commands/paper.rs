//! `jurist paper`: the built-in drive's paper once more, as one HTML report.

use super::{Context, Runs};
use crate::cli::arguments::RunOptions;
use crate::cli::output::{note, plain};
use crate::cli::picture::write;
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_drive::paper_report;
use jurist_engine::error::{Code, Diagnostic};
use std::ffi::OsString;
use std::path::Path;

/// Options of `jurist paper`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The folder to write into; it is made if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "paper-report")]
    pub output: OsString,
    /// Also writes the tables as LaTeX
    #[arg(long)]
    pub latex: bool,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let folder = Path::new(&self.output);
        std::fs::create_dir_all(folder).map_err(|e| {
            Diagnostic::error(Code::Write, format!("cannot make the folder {}: {}", folder.display(), plain(&e)))
        })?;
        let report = context.budget.enter(|| paper_report(&context.budget))??;
        context.budget.step("writing");
        write(&folder.join("report.html"), report.html.as_bytes())?;
        for figure in &report.figures {
            write(&folder.join(format!("{}.svg", figure.name)), figure.figure.svg().as_bytes())?;
        }
        if self.latex {
            write(&folder.join("tables.tex"), report.latex.as_bytes())?;
        }
        context.reporter.finish();
        if !context.quiet {
            note(&format!("wrote {}", folder.join("report.html").display()));
        }
        Ok(Status::Holds)
    }

    fn writes_a_folder(&self) -> bool {
        true
    }
}
