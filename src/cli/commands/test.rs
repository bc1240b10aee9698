//! `jurist test`: tries what models are expected to be.

use super::{Context, Runs};
use crate::cli::arguments::RunOptions;
use crate::cli::destinations::{Files, check_read};
use crate::cli::output::{finish_answer, note, write_answer};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::suite::collect::{Collector, text};
use crate::cli::suite::{junit, try_all};
use crate::cli::table::Table;
use clap::Args;
use jurist_show::documents::{Test, to_text};
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;

/// Options of `jurist test`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// Model files with [[expect]] or [require], files of expectations (jurist-tests.toml), or folders with such files
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<OsString>,
    /// Tries everything at each operating point of a table in CSV: names in its head, a row for each point
    #[arg(long, value_name = "FILE")]
    pub cases: Option<OsString>,
    /// Also writes a JUnit report
    #[arg(long, value_name = "FILE")]
    pub junit: Option<OsString>,
    /// Also writes what does not pass as a SARIF log, with places
    #[arg(long, value_name = "FILE")]
    pub sarif: Option<OsString>,
    /// Shows only what does not pass
    #[arg(long)]
    pub only_bad: bool,
    /// Writes JSON
    #[arg(long)]
    pub json: bool,
    /// Writes the text or the JSON document to a file
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let table = |file: &_| Ok::<_, Error>(Arc::new(Table::read(&text(Path::new(file))?)?));
        let cases = self.cases.as_ref().map(table).transpose()?;
        let mut collector = Collector::new(cases);
        let suites = collector.suites(&self.paths)?;
        let named = [("the JUnit report", &self.junit), ("the SARIF log", &self.sarif), ("the answer", &self.output)];
        let outputs = named.into_iter().filter_map(|(what, file)| Some((what, file.as_ref()?)));
        check_read(context, outputs, &collector.read)?;
        let outcomes = try_all(&suites, &context.budget);
        context.reporter.finish();
        if !context.quiet {
            collector.notes.iter().for_each(|said| note(&format!("note: {said}")));
        }
        let document = outcomes.document();
        if let Some(file) = &self.junit {
            write_answer(&junit::report(&document), Some(file))?;
        }
        if let Some(file) = &self.sarif {
            write_answer(&to_text(&outcomes.sarif()), Some(file))?;
        }
        let answer = if self.json { to_text(&document) } else { outcomes.text(self.only_bad) };
        finish_answer(&answer, self.output.as_ref())?;
        Ok(match document {
            Test { errors: 1.., .. } => Status::BadInput,
            Test { failed: 1.., .. } => Status::DoesNotHold,
            Test { undecided: 1.., .. } => Status::Undecided,
            _ => Status::Holds,
        })
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs.extend(self.paths.iter().map(|path| ("a file of the test", path.as_os_str())));
        files.inputs.extend(self.cases.iter().map(|path| ("the operating points", path.as_os_str())));
        files.outputs.extend(self.junit.iter().map(|file| ("the JUnit report", file.clone())));
        files.outputs.extend(self.sarif.iter().map(|file| ("the SARIF log", file.clone())));
        files.answer(self.output.as_ref());
        Ok(())
    }
}
