//! `jurist check`: only reads a model.

use super::Context;
use crate::cli::arguments::RunOptions;
use crate::cli::input::read_model;
use crate::cli::output::write_answer;
use crate::cli::show;
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_engine::error::Diagnostics;
use jurist_engine::model::Model;
use jurist_engine::show::documents::{Check, to_text};
use std::ffi::OsString;

/// Options of `jurist check`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A model file, '-' for standard input; left out: the built-in drive
    #[arg(value_name = "MODEL")]
    pub model: Option<OsString>,
    /// Writes JSON
    #[arg(long)]
    pub json: bool,
    /// Writes a SARIF log, which editors and code hosts show beside the text
    #[arg(long, conflicts_with = "json")]
    pub sarif: bool,
    /// Writes the JSON document or the log to a file
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

/// Every remark with its place; the status is 2 for a model that no question can be asked about.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let (name, bytes) = read_model(options.model.as_ref(), context)?;
    let (source, diagnostics) = match Model::from_bytes(&name, &bytes) {
        Ok((model, warnings)) => (Some(model.source().clone()), warnings),
        Err(errors) => (errors.source_text().cloned(), errors.diagnostics().to_vec()),
    };
    let check = Check::new(&name, source.as_deref(), &diagnostics);
    let status = if check.accepted { Status::Holds } else { Status::BadInput };
    context.reporter.finish();
    if options.json || options.sarif {
        let text = if options.sarif { to_text(&check.sarif()) } else { to_text(&check) };
        write_answer(&text, options.output.as_ref())?;
        return Ok(status);
    }
    let only_warnings = check.accepted;
    if !diagnostics.is_empty() && (!only_warnings || !context.quiet) {
        show(&Diagnostics::new(source, diagnostics.clone()));
    }
    if check.accepted {
        let remarks = match diagnostics.len() {
            0 => String::new(),
            1 => ", with one warning".to_owned(),
            n => format!(", with {n} warnings"),
        };
        write_answer(&format!("{name}: a model{remarks}"), options.output.as_ref())?;
    }
    Ok(status)
}
