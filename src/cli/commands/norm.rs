//! `jurist norm`: the peak gain of a closed-loop transfer function, over frequencies or of bounded signals.

use super::{Context, Runs, decided};
use crate::cli::arguments::{ExplainOptions, ModelOptions, OutputOptions, ReadingOptions, RegionOptions};
use crate::cli::destinations::Files;
use crate::cli::input::{load, question};
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::coverage::Asked;
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;
use jurist_show::documents::Norm;
use jurist_show::{Document, Text};
use std::ffi::OsString;
use std::sync::Arc;

/// Options of `jurist norm`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A model file, '-' for standard input, or a loop in one line (left out: the built-in drive); an input and an output of the loop
    #[arg(value_names = ["MODEL", "INPUT", "OUTPUT"], num_args = 2..=3, required = true)]
    pub names: Vec<OsString>,
    /// The peak-to-peak gain (l1 norm) instead: how far bounded inputs can drive the output from rest
    #[arg(long)]
    pub l1: bool,
    #[command(flatten)]
    pub line: ReadingOptions,
    /// Gives a parameter or constant another value, exactly: 545, 1e-4, 1/3 [repeatable]
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    #[command(flatten)]
    pub explain: ExplainOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        run(self, context)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        // The model is the first of three names.
        let model = self.names.first().filter(|_| self.names.len() == 3);
        files.inputs.extend(model.map(|model| ("the model", model.as_os_str())));
        files.answer(self.output.output.as_ref());
        Ok(())
    }
}

/// Answers on standard output or in a file; the status is 1 for a loop that is not stable.
fn run(options: &Options, context: &Context) -> Outcome {
    let output = &options.output;
    context.check_output(output)?;
    let (model, ports) = match options.names.as_slice() {
        [model, ports @ ..] if ports.len() == 2 => (Some(model.clone()), ports),
        ports => (None, ports),
    };
    let [from, to] = [&ports[0], &ports[1]].map(|name| name.to_string_lossy());
    let (explain, l1) = (&options.explain, options.l1);
    let options = ModelOptions { model, line: options.line.clone(), set: options.set.clone(), domain: Vec::new() };
    let model = load(options.model.as_ref(), &options.line, context)?;
    let digits = output.digits() as usize;
    let problem = question(context, &model, &options, &RegionOptions::default())?.problem()?;
    let asked = match (l1, problem.time()) {
        (false, _) => Asked::Norm,
        (true, Time::Discrete) => Asked::PeakToPeak,
        (true, Time::Continuous) => Asked::PeakToPeakContinuous,
    };
    context.explain(explain, output, &problem, asked)?;
    if l1 {
        return peak_to_peak(&problem, [&from, &to], output, context);
    }
    let answer = match decided(problem.norm(&from, &to, &context.budget))? {
        Ok(answer) => answer,
        Err(stopped) => {
            return context.undecided(output, &stopped, || None, || Norm::new(&problem, Err(&stopped), digits));
        }
    };
    context.warn(None, problem.warnings());
    context.answer(output, || answer.text(digits), || answer.json(digits))?;
    Ok(if answer.value().peak.is_some() { Status::Holds } else { Status::DoesNotHold })
}

/// The same of the peak-to-peak gain.
fn peak_to_peak(problem: &Arc<Problem>, [from, to]: [&str; 2], output: &OutputOptions, context: &Context) -> Outcome {
    let digits = output.digits() as usize;
    let answer = match decided(problem.peak_to_peak(from, to, digits, &context.budget))? {
        Ok(answer) => answer,
        Err(stopped) => {
            let document = || Norm::of_peak_to_peak(problem, Err(&stopped), digits);
            return context.undecided(output, &stopped, || None, document);
        }
    };
    context.warn(None, problem.warnings());
    context.answer(output, || answer.text(digits), || answer.json(digits))?;
    Ok(if answer.value().gain.is_some() { Status::Holds } else { Status::DoesNotHold })
}
