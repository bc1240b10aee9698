//! Requirements on the command line.

use super::arguments::RegionOptions;
use super::commands::Context;
use clap::Args;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_engine::response::Requirements;

/// What is required beyond stability.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct RequirementOptions {
    /// Asks for a gain margin both ways: '6 dB' or a factor
    #[arg(long, value_name = "MARGIN")]
    pub gain_margin: Option<String>,
    /// Asks for a phase margin: '45 deg'
    #[arg(long, value_name = "ANGLE")]
    pub phase_margin: Option<String>,
    /// Asks for a modulus margin: the least |1 + L|
    #[arg(long, value_name = "NUMBER")]
    pub modulus_margin: Option<String>,
    /// Asks for a delay margin: dead time in units of time (points only)
    #[arg(long, value_name = "TIME")]
    pub delay_margin: Option<String>,
    /// Asks for a settling time: a decay of 4 over it, in discrete time a radius of exp(-4 T/time)
    #[arg(long, value_name = "TIME")]
    pub settling_time: Option<String>,
    /// Asks for a damping of all roots, in discrete time of the roots ln(z)/T
    #[arg(long, value_name = "NUMBER")]
    pub damping: Option<String>,
    /// Where the loop is cut for margins: a signal, or a block (at its input) [default: the error of a single loop]
    #[arg(long, value_name = "SIGNAL")]
    pub at: Option<String>,
}

impl RequirementOptions {
    /// The keys of `[require]` that the options stand for, with what is given.
    fn given(&self) -> [(&'static str, &Option<String>); 7] {
        [
            ("at", &self.at),
            ("gain_margin", &self.gain_margin),
            ("phase_margin", &self.phase_margin),
            ("modulus_margin", &self.modulus_margin),
            ("delay_margin", &self.delay_margin),
            ("damping", &self.damping),
            ("settling_time", &self.settling_time),
        ]
    }

    /// An option that requires something, if one does.
    pub fn first(&self) -> Option<String> {
        let mut given = self.given().into_iter().rev().filter(|(_, text)| text.is_some());
        given.next().map(|(key, _)| format!("--{}", key.replace('_', "-")))
    }

    /// What the model's `[require]` and the command line ask for together, and the question with the region that follows.
    pub fn asked(
        &self,
        model: &Model,
        question: Question,
        region: &RegionOptions,
        context: &Context,
    ) -> Result<(Requirements, Question), Error> {
        let own = [("decay", &region.decay), ("radius", &region.radius)];
        let further: Vec<(&str, &str)> =
            self.given().into_iter().chain(own).filter_map(|(name, text)| Some((name, text.as_deref()?))).collect();
        // A region alone is the question's own.
        let asks = further.iter().any(|(name, _)| !["decay", "radius"].contains(name));
        if !asks && model.require().is_empty() {
            return Ok((Requirements::default(), question));
        }
        let values = question.clone().problem()?.set().to_vec();
        let mut asked = model.requirements(&further, &values, &context.budget)?;
        // A region that the command line gives is the question's own.
        asked.regional.retain(|(name, _)| match name.as_str() {
            "decay" => region.decay.is_none(),
            "radius" => region.radius.is_none(),
            _ => true,
        });
        let question = match asked.region.clone() {
            Some(region) => question.within(region),
            None => question,
        };
        Ok((asked, question))
    }
}

/// Requirements of which a list asks for several at once, each for itself.
const LISTED: [&str; 4] = ["gain_margin", "phase_margin", "modulus_margin", "damping"];

impl RequirementOptions {
    /// As [`RequirementOptions::asked`], with lists such as `30 deg, 45 deg`: those with the same name stand together.
    pub fn asked_each(
        &self,
        model: &Model,
        question: Question,
        region: &RegionOptions,
        context: &Context,
    ) -> Result<(Requirements, Question), Error> {
        let mut first = self.clone();
        let mut further: Vec<(&str, String)> = Vec::new();
        let listed = [&mut first.gain_margin, &mut first.phase_margin, &mut first.modulus_margin, &mut first.damping];
        for (name, text) in LISTED.into_iter().zip(listed) {
            let Some(list) = text.take() else { continue };
            let mut parts = list.split(',').map(|part| part.trim().to_owned());
            *text = parts.next();
            further.extend(parts.map(|part| (name, part)));
        }
        let (mut asked, question) = first.asked(model, question, region, context)?;
        if !further.is_empty() {
            let values = question.clone().problem()?.set().to_vec();
            for (name, text) in further {
                let more = model.requirements(&[(name, &text)], &values, &context.budget)?;
                let place = asked.list.iter().rposition(|r| r.name() == name).map_or(asked.list.len(), |k| k + 1);
                asked.list.splice(place..place, more.list.into_iter().filter(|r| r.name() == name));
            }
        }
        Ok((asked, question))
    }
}

/// That nothing proves requirements yet.
pub(super) fn refuse_proofs(model: &Model, asked: &Requirements, any_proof: bool) -> Result<(), Error> {
    if !any_proof || (asked.list.is_empty() && model.require().is_empty()) {
        return Ok(());
    }
    let error = Diagnostic::error(Code::Require, "an answer with requirements has no certificate and no proof yet");
    Err(error.help("leave out the requirements, or the certificate").into())
}

/// Warns that a command does not look at the model's requirements.
pub(super) fn warn_of_ignored(model: &Model, context: &Context) {
    if !model.require().is_empty() {
        let warning =
            Diagnostic::warning(Code::RequireWarning, "[require] is not looked at here: stability alone is decided");
        context.warn(None, &[warning.help("requirements are decided by 'verdict', 'intervals' and 'map'")]);
    }
}
