//! `jurist verdict`: one point.

use super::{Context, Runs, decided};
use crate::certified::{certify_requirements, certify_verdict};
use crate::cli::arguments::DecisionOptions;
use crate::cli::destinations::Files;
use crate::cli::input::decision;
use crate::cli::output::write_answer;
use crate::cli::picture::WRITES;
use crate::cli::requirements::{RequirementOptions, refuse_theorems};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::certify;
use clap::Args;
use jurist_algebra::limits::Exhausted;
use jurist_engine::answer::Verdict;
use jurist_engine::coverage::Asked;
use jurist_prove::Theorem;
use jurist_show::documents;
use jurist_show::{Document, Text};
use std::ffi::OsString;

/// Options of `jurist verdict`.
#[derive(Args, Debug, Default)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub decision: DecisionOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
    /// Writes a certificate that 'jurist verify' re-checks
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    /// Writes the verdict as a theorem for Coq, proved with the library in proofs/
    #[arg(long, value_name = "FILE")]
    pub coq: Option<OsString>,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.decision.output;
        let (model, question) = decision(&self.decision, context)?;
        let (asked, question) = self.require.asked(&model, question, &self.decision.region, context)?;
        refuse_theorems(&asked, self.coq.is_some())?;
        let problem = question.problem()?;
        let question = asked.list.iter().fold(Asked::Verdict, |asked, r| asked.with_requirement(r, problem.time()));
        context.explain(&self.decision.explain, output, &problem, question)?;
        let open = |stopped: &Exhausted| {
            context.undecided(output, stopped, || None, || documents::Verdict::new(&problem, Err(stopped)))
        };
        let found = match decided(problem.requirements_met(&asked.list, asked.at.as_deref(), &context.budget))? {
            Ok(found) => found,
            Err(stopped) => return open(&stopped),
        };
        let answer = match decided(problem.verdict(&context.budget))? {
            Ok(answer) => answer,
            Err(stopped) => return open(&stopped),
        };
        context.warn(None, problem.warnings());
        if let Some(file) = self.coq.as_ref().filter(|_| WRITES) {
            write_answer(&answer.coq(&context.budget)?, Some(file))?;
        }
        let digits = output.digits() as usize;
        let in_region = answer.value().verdict == Verdict::Stable;
        let text = || {
            let list = found.iter().map(|r| r.text(digits));
            let regional = asked
                .regional
                .iter()
                .map(|(name, text)| format!("{name} {text}: {}", if in_region { "met" } else { "not met" }));
            list.chain(regional).fold(answer.text(digits), |text, line| format!("{text}{line}\n"))
        };
        let document = || {
            let list = found.iter().map(|r| documents::RequirementFound::new(r, digits));
            let regional =
                |(name, text): &(String, String)| documents::RequirementFound::of_region(name, text, in_region);
            let requirements = list.chain(asked.regional.iter().map(regional)).collect();
            documents::Verdict { requirements, ..answer.json(digits) }
        };
        context.answer(output, text, document)?;
        let model = &problem.model().source().text;
        let good = found.iter().all(|r| r.met) && answer.value().verdict == Verdict::Stable;
        certify(context, &output.run, model, &self.certificate, || match asked.list.as_slice() {
            [] => certify_verdict(&answer, &context.budget),
            list => certify_requirements(&problem, list, asked.at.as_deref(), good, &context.budget),
        })?;
        Ok(if good { Status::Holds } else { Status::DoesNotHold })
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.decision.model.model, &self.decision.output.output);
        files.outputs.extend(self.certificate.iter().map(|file| ("the certificate", file.clone())));
        files.outputs.extend(self.coq.iter().map(|file| ("the file for Coq", file.clone())));
        Ok(())
    }
}
