//! What a model presupposes of its parameters beside divisors that are not zero: sample times are positive, frequencies below
//! half the sampling rate, duty ratios between 0 and 1.

use super::definition::{Form, Model};
use super::evaluate::walk::Failure;
use super::evaluated::substituted;
use super::steady::no_duty;
use super::symbols::Symbols;
use crate::error::{Code, Diagnostic, Span};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// What is presupposed of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presupposed {
    /// The sample time of a hold: positive.
    SampleTime,
    /// A frequency: positive.
    Frequency,
    /// The duty ratio of a modulator, and what is left to 1: positive.
    Duty,
    /// The angle `w T` by which a frequency turns in a sample: between 0 and pi.
    Angle,
}

/// A function of the kept names and of symbols, and what is presupposed of it.
#[derive(Clone, Debug)]
pub struct Presupposition {
    /// What is presupposed.
    pub of: Presupposed,
    /// The function.
    pub function: RationalFunction,
    /// Where it stands in the model.
    pub span: Span,
}

impl Presupposition {
    /// The refusal where the function is not positive.
    pub fn not_positive(&self) -> Diagnostic {
        match self.of {
            Presupposed::SampleTime => {
                Diagnostic::error(Code::Value, "the sample time of a hold must be positive").at(self.span, "this hold")
            }
            Presupposed::Duty => Diagnostic::error(Code::Duty, "the duty ratio of a modulator must be between 0 and 1")
                .at(self.span, "not between 0 and 1"),
            Presupposed::Frequency | Presupposed::Angle => {
                Diagnostic::error(Code::Discretize, "the frequency of 'prewarp' must be positive")
                    .at(self.span, "not positive")
            }
        }
    }

    /// The refusal where an angle is not below pi.
    pub fn too_fast(&self) -> Diagnostic {
        Diagnostic::error(Code::Discretize, "the frequency of 'prewarp' is not below half the sampling rate")
            .at(self.span, "an angle of pi or more in a sample")
            .help("'prewarp' is in radians per unit of time: 2*pi times the frequency")
    }

    /// The refusal where it is not known whether what is presupposed holds.
    pub fn not_known(&self) -> Diagnostic {
        let message = match self.of {
            Presupposed::SampleTime => "it is not known for which values the sample time of this hold is positive",
            Presupposed::Duty => "it is not known for which values the duty ratio of this modulator is between 0 and 1",
            Presupposed::Frequency | Presupposed::Angle => {
                "it is not known for which values the frequency of 'prewarp' is below half the sampling rate"
            }
        };
        Diagnostic::error(Code::Discretize, message)
            .at(self.span, "a function of what is asked for")
            .help("set the parameters that it depends on")
    }
}

impl Model {
    /// What the model presupposes, and the symbols that occur in it; `None` where an expression has no value, of which
    /// [`Model::evaluate`] tells.
    ///
    /// Cost: the expressions of sample times and frequencies are evaluated, and those of the constants.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn presuppositions(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<(Vec<Presupposition>, Symbols)>, Exhausted> {
        let mut exhausted = None;
        let found = self.presupposed(kept, given, budget, &mut |failure| {
            if let Failure::Exhausted(by) = failure {
                exhausted = Some(by);
            }
        });
        match exhausted {
            Some(exhausted) => Err(exhausted),
            None => Ok(found),
        }
    }

    fn presupposed(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
        report: &mut dyn FnMut(Failure),
    ) -> Option<(Vec<Presupposition>, Symbols)> {
        let Form::Blocks(diagram) = &self.form else { return Some(Default::default()) };
        let rules = || diagram.blocks.iter().filter_map(|b| b.discretization.as_ref());
        if !rules().any(|d| d.method.is_hold() || d.prewarp.is_some()) {
            return Some(Default::default());
        }
        let mut is_known = true;
        let mut scope = self.scope(kept, given, budget, &mut |failure| {
            is_known = false;
            report(failure);
        });
        let mut found: Vec<Presupposition> = Vec::new();
        for rule in rules() {
            let Some(time) = &rule.sample_time else { continue };
            let mut value = |e| scope.scalar(e).map_err(&mut *report).ok();
            let mut own = Vec::new();
            if rule.method.is_hold() {
                own.push((Presupposed::SampleTime, value(time)?, rule.span));
                for duty in rule.pulses.iter().filter(|pulses| !pulses.is_steady).flat_map(|pulses| &pulses.duties) {
                    let d = value(duty)?;
                    let rest = &RationalFunction::one() - &d;
                    own.extend([(Presupposed::Duty, d, duty.span), (Presupposed::Duty, rest, duty.span)]);
                }
            } else if let Some(frequency) = &rule.prewarp {
                let (w, time) = (value(frequency)?, value(time)?);
                let angle = &w * &time;
                own.extend([(Presupposed::Frequency, w, frequency.span), (Presupposed::Angle, angle, frequency.span)]);
            }
            for (of, function, span) in own {
                if found.iter().all(|p| (p.of, &p.function) != (of, &function)) {
                    found.push(Presupposition { of, function, span });
                }
            }
        }
        let (images, symbols) = Model::images(&scope.variables, kept, given, &no_duty).ok()?;
        for presupposition in &mut found {
            presupposition.function = substituted(&presupposition.function, &images)?;
        }
        if !kept.is_empty() && self.has_steady_duty() {
            // Else the loop is undefined at the one point that is asked for.
            if let Ok(Some(mean)) = self.mean_duty(kept, given, budget) {
                let span =
                    rules().find_map(|rule| rule.pulses.as_ref().filter(|p| p.is_steady).map(|p| p.duties[0].span));
                let rest = &RationalFunction::one() - &mean;
                let both = [mean, rest].into_iter();
                found.extend(both.map(|function| Presupposition {
                    of: Presupposed::Duty,
                    function,
                    span: span.unwrap_or_default(),
                }));
            }
        }
        is_known.then_some((found, symbols))
    }
}
