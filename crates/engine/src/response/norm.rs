//! The peak gain of a closed-loop transfer function.

use super::Extreme;
use super::open_loop::integral;
use super::place::modulus_squared;
use super::value::square_root;
use crate::answer::{Answer, Frequency, PointVerdict, Verdict};
use crate::error::Error;
use crate::problem::{Problem, Question};
use crate::stability::Shape;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, RationalFunction, RealAlgebraic};
use std::sync::Arc;

/// The H-infinity norm of a closed-loop transfer function.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
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
    /// The sample time.
    pub sample_time: Option<Rational>,
}

/// The peak of the modulus of a transfer function, and where it is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PeakGain {
    /// The peak.
    pub value: RealAlgebraic,
    /// The extreme of its square: where it is, and whether it is attained.
    pub extreme: Extreme,
}

impl Norm {
    /// Where the peak is; `None` without one, in the limit of high frequencies, and where it is everywhere.
    pub fn frequency(&self, shape: Shape, bits: u64) -> Option<Frequency> {
        self.peak.as_ref()?.extreme.place()?.frequency(shape, self.sample_time.as_ref(), bits)
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
        budget.enter(|| {
            let verdict = self.verdict(budget)?.into_value();
            let transfer = self.closed_loop(budget)?.transfer_function(input, output, budget)?;
            let constant = |f: &RationalFunction| f.as_constant().expect("every parameter has a value");
            let above = transfer.numerator.iter().map(constant).collect();
            let below = transfer.denominator.coefficients.iter().map(constant).collect();
            let (above, below) = integral(above, below);
            let n = below.coeffs().len().saturating_sub(1);
            let shape = self.shape();
            let peak = if verdict.verdict == Verdict::Stable {
                budget.step("peak gain");
                let common = above.gcd(&below);
                let squared = |p: &jurist_algebra::poly::UniPoly| {
                    let p = p.div_exact(&common).expect("a gcd divides");
                    modulus_squared(&p, n, shape)
                };
                let extreme = Extreme::greatest(&squared(&above), &squared(&below), shape, budget)?;
                let square = extreme.value().expect("no pole of a stable loop is on the boundary").number(budget)?;
                Some(PeakGain { value: square_root(&square, budget)?, extreme })
            } else {
                None
            };
            let sample_time = self.algebra(budget)?.sample_time().and_then(RationalFunction::as_constant);
            let (input, output) = (input.to_owned(), output.to_owned());
            Ok(Answer::new(Arc::clone(self), Norm { input, output, verdict, peak, sample_time }))
        })?
    }
}
