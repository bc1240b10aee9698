//! `jurist intervals`: the exact stable set of one parameter.

use super::Context;
use crate::cli::arguments::DecisionOptions;
use crate::cli::input::{decision, known_names};
use crate::cli::output::write_answer;
use crate::cli::status::{Outcome, Status};
use crate::cli::written::check_certificate;
use clap::Args;
use jurist_engine::analysis::{DECAY, Decision, Intervals, RADIUS, asked, intervals};
use jurist_engine::prove::emit::intervals_certificate;
use jurist_engine::prove::smt2::intervals_smt2;
use jurist_engine::show::json::to_text;
use jurist_engine::show::{intervals_json, intervals_text};
use std::ffi::OsString;
use std::slice::from_ref;

/// Options of `jurist intervals`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The parameter in question: a parameter, a constant given as a number, 'radius' or 'decay'
    #[arg(long, value_name = "NAME")]
    pub param: String,
    #[command(flatten)]
    pub decision: DecisionOptions,
    /// Writes a certificate that 'jurist verify' re-checks
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    /// Writes the statement as SMT-LIB 2; a solver answers 'unsat' if it is true
    #[arg(long, value_name = "FILE")]
    pub smt2: Option<OsString>,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let output = &options.decision.output;
    let (model, settings) = decision(&options.decision, context)?;
    if options.param != RADIUS && options.param != DECAY {
        known_names(context, &model, "--param", from_ref(&options.param))?;
    }
    let digits = output.digits() as usize;
    let question = asked(&model, &settings, &options.param)?;
    context.know(output, move |wants_json, budget, reached| {
        let answer = Intervals { question, stable: Decision::Undecided { budget, reached } };
        Some(if wants_json { to_text(&intervals_json(&answer, digits)) } else { intervals_text(&answer, digits) })
    })?;
    let answer = intervals(&model, &settings, &options.param, &context.budget)?;
    context.warn(None, &answer.question.warnings);
    let mut written = None;
    if let Decision::Decided(set) = &answer.stable {
        if let Some(file) = &options.certificate {
            let certificate = intervals_certificate(&model.source().text, &answer.question, &context.budget)?;
            write_answer(&certificate, Some(file))?;
            written = Some((certificate, file));
        }
        if let Some(file) = &options.smt2 {
            write_answer(&intervals_smt2(&answer.question, set), Some(file))?;
        }
    }
    context.answer(output, || intervals_text(&answer, digits), || intervals_json(&answer, digits))?;
    if let Some((text, file)) = written {
        check_certificate(context, &output.run, &model.source().text, &text, file);
    }
    Ok(match &answer.stable {
        Decision::Decided(_) => Status::Holds,
        Decision::Undecided { budget, reached } => context.say_undecided(budget, reached),
    })
}
