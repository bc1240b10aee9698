//! `jurist`: the main job on the built-in drive.

use super::Context;
use crate::cli::arguments::OutputOptions;
use crate::cli::status::{Failure, Outcome, Status};
use clap::Args;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_drive::{MainJob, main_job_json, main_job_text};
use jurist_engine::analysis::{Decision, Settings, intervals, parametric_table};
use jurist_engine::error::Source;
use jurist_engine::model::{Loop, Question};

/// Eq. 23 with the digits that the paper prints.
const PRINTED_EQUATION_23: &str = include_str!("../../../examples/equation-23-as-printed.toml");

/// The amplitude of the PWM wave, in which Eq. 23 is written.
const AMPLITUDE: &str = "K_pwm";
/// The chopping period, in which Eq. 37 is written.
const PERIOD: &str = "T";

/// Options of `jurist` without a command.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    context.check_output(&options.output)?;
    let model = Loop::drive();
    let job = match gather(&model, context) {
        Ok(job) => job,
        Err(failure) => return context.undecided(&options.output, "jurist/main/1", "jury", failure),
    };
    let digits = options.output.digits() as usize;
    context.answer(&options.output, || main_job_text(&job, digits), || main_job_json(&job, digits))?;
    for answer in [&job.amplitude, &job.period] {
        if let Decision::Undecided { budget, reached } = &answer.stable {
            return Ok(context.say_undecided(budget, reached));
        }
    }
    Ok(Status::Holds)
}

fn gather<'a>(model: &'a Loop, context: &Context) -> Result<MainJob<'a>, Failure> {
    let budget = &context.budget;
    let settings = Settings::default();
    let polynomial = |model: &Loop, name: &str| -> Result<CharacteristicPolynomial, Failure> {
        Ok(model.characteristic_polynomial(&Question::keeping([name]), budget)?)
    };
    let (printed, _) = Loop::from_toml(&Source::new("<Eq. 23 as printed>", PRINTED_EQUATION_23))?;
    Ok(MainJob {
        model,
        equation_23: polynomial(model, AMPLITUDE)?,
        equation_37: polynomial(model, PERIOD)?,
        amplitude: parametric_table(model, &settings, AMPLITUDE, budget)?,
        period: parametric_table(model, &settings, PERIOD, budget)?,
        printed_equation: polynomial(&printed, AMPLITUDE)?,
        printed: intervals(&printed, &settings, AMPLITUDE, budget)?,
    })
}
