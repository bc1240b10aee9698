//! The peak gain of a closed-loop transfer function.

use super::delayed_transfer::DelayedTransfer;
use super::extreme::extreme_over;
use super::ground::Ground;
use super::met::AtPoint;
use super::open_loop::{OpenLoop, Over};
use super::parts::Parts;
use super::requirement::Requirement;
use super::value::square_root;
use super::{Extreme, Frequencies};
use crate::answer::{Answer, Frequency, PointVerdict, Verdict};
use crate::error::Error;
use crate::model::{Symbols, no_transfer_of_several_rates};
use crate::problem::{Problem, Question};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::real::Real;
use std::cmp::Ordering;
use std::sync::Arc;

/// The H-infinity norm of a closed-loop transfer function.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/z"))
///     .build()?;
/// let answer = model.ask().norm("r", "y", &Budget::unlimited())?; // (1/2)/(z + 1/2), at z = -1
/// assert_eq!(answer.value().peak.as_ref().unwrap().value.decimal(6), "1");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Norm {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
    /// The closed loop's verdict: only a stable one has a norm, its hidden modes included.
    pub verdict: PointVerdict,
    /// The peak of a stable loop.
    pub peak: Option<PeakGain>,
    /// The frequencies that were looked at.
    pub frequencies: Frequencies,
    /// The sample time.
    pub sample_time: Option<Rational>,
}

/// The peak of the modulus of a transfer function, and where it is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PeakGain {
    /// The peak.
    pub value: Real,
    /// The extreme of its square: where it is, and whether it is attained.
    pub extreme: Extreme,
}

impl Norm {
    /// Where the peak is; `None` without one, in the limit of high frequencies, and where it is everywhere.
    pub fn frequency(&self, bits: u64) -> Option<Frequency> {
        self.peak.as_ref()?.extreme.place()?.frequency(self.frequencies, self.sample_time.as_ref(), bits)
    }
}

impl PeakGain {
    /// Of a stable transfer function.
    fn over<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<PeakGain, Exhausted> {
        let r = &parts.reduced;
        let quotient = [&r.numerator_squared, &r.denominator_squared];
        let common = |a: &_, b: &_| r.common(a, b);
        let extreme = extreme_over(&parts.ground, quotient, &common, r.frequencies, Ordering::Greater, budget)?;
        let square = extreme.value().expect("no pole of a stable loop is on the boundary").number(budget)?;
        Ok(PeakGain { value: square_root(&square, budget)?, extreme })
    }
}

/// A transfer function, without or with dead time in more than a factor of the numerator.
enum Transfer {
    Of(Over),
    Delayed(DelayedTransfer),
}

impl Transfer {
    /// From the real and the imaginary parts of the coefficients, those of the denominator first.
    fn new(lists: [Vec<RationalFunction>; 4], symbols: &Symbols, shape: Shape) -> Result<Transfer, Error> {
        // Dead time alone does not change the modulus.
        match Over::of_complex(lists.clone(), Vec::new(), symbols, shape) {
            Err(_) if !symbols.delays().is_empty() => Ok(Transfer::Delayed(DelayedTransfer::new(lists, symbols)?)),
            over => Ok(Transfer::Of(over?.0)),
        }
    }

    fn peak(&self, budget: &Budget) -> Result<PeakGain, Exhausted> {
        match self {
            Transfer::Of(Over::Integers(parts)) => PeakGain::over(parts, budget),
            Transfer::Of(Over::Constants(parts)) => PeakGain::over(parts, budget),
            Transfer::Delayed(transfer) => {
                let extreme = transfer.peak(budget)?;
                Ok(PeakGain { value: extreme.root(budget)?, extreme })
            }
        }
    }

    fn frequencies(&self) -> Frequencies {
        match self {
            Transfer::Of(over) => over.frequencies(),
            Transfer::Delayed(transfer) => transfer.frequencies(),
        }
    }
}

/// Refuses a loop of several rates.
pub(super) fn of_one_rate(problem: &Problem) -> Result<(), Error> {
    match problem.model().hyperperiod() {
        1 => Ok(()),
        _ => Err(no_transfer_of_several_rates()),
    }
}

impl Question {
    /// The peak gain from an input to an output with every parameter at its set or nominal value.
    ///
    /// Cost: that of [`Problem::norm`].
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`] and [`ClosedLoop::transfer_function`](crate::model::ClosedLoop::transfer_function), undefined, or stopped.
    ///
    /// # Panics
    /// When a name is free.
    pub fn norm(self, input: &str, output: &str, budget: &Budget) -> Result<Answer<Norm>, Error> {
        Problem::norm(&self.problem()?, input, output, budget)
    }
}

impl Problem {
    /// The peak gain from an input to an output.
    ///
    /// Cost: two characteristic polynomials, isolation of the zeros of a polynomial of at most twice the order, and one resultant.
    ///
    /// # Errors
    /// As [`Question::norm`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn norm(self: &Arc<Self>, input: &str, output: &str, budget: &Budget) -> Result<Answer<Norm>, Error> {
        of_one_rate(self)?;
        budget.enter(|| {
            let verdict = self.verdict(budget)?.into_value();
            let (closed_loop, symbols) = self.closed_loop_over_symbols(budget)?;
            let lists = if closed_loop.is_complex {
                let (row, column) = closed_loop.complex_ports(input, output)?;
                let [below, above] = closed_loop.complex_transfer(row, column, budget)?;
                [below.re, below.im, above.re, above.im]
            } else {
                let transfer = closed_loop.transfer_function(input, output, budget)?;
                [transfer.denominator.coefficients, Vec::new(), transfer.numerator, Vec::new()]
            };
            let transfer = Transfer::new(lists, symbols, self.shape())?;
            let peak = match verdict.verdict {
                Verdict::Stable => {
                    budget.step("peak gain");
                    Some(transfer.peak(budget)?)
                }
                _ => None,
            };
            let sample_time = self.algebra_over_symbols(budget)?.sample_time().and_then(RationalFunction::as_constant);
            let (input, output) = (input.to_owned(), output.to_owned());
            let frequencies = transfer.frequencies();
            Ok(Answer::new(Arc::clone(self), Norm { input, output, verdict, peak, frequencies, sample_time }))
        })?
    }

    /// Whether the transfer function of a stable loop between two signals has at most a peak gain.
    pub(super) fn is_norm_met(self: &Arc<Self>, requirement: &Requirement, budget: &Budget) -> Result<bool, Error> {
        let open_loop = OpenLoop::of_cut(self, requirement.cut(self, None)?, budget)?;
        Ok(AtPoint::new(&open_loop).meets(requirement, budget)?)
    }
}
