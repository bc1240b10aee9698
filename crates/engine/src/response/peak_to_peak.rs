//! The peak-to-peak gain of a closed-loop transfer function.

use super::norm::of_one_rate;
use super::parts::integral;
use crate::answer::{Answer, PointVerdict, Verdict};
use crate::coverage::CoefficientRing;
use crate::error::Error;
use crate::model::{ClosedLoop, Symbols, Time, quotient_at};
use crate::problem::{Problem, Question, Region};
use crate::stability::{AbsoluteSum, ImpulseResponse};
use jurist_algebra::ball::{Ball, BallMatrix};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use std::sync::Arc;

/// The peak-to-peak gain of a closed-loop transfer function, its l1 norm: the sum of the `|h_k|` of `H = sum h_k z^-k`, and in continuous time
/// the integral of the modulus of the impulse response.
///
/// From rest `max |y| <= gain max |u|`, and no smaller number does.
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
/// let budget = Budget::unlimited();
/// let answer = model.ask().peak_to_peak("r", "y", 20, &budget)?; // (1/2)/(z + 1/2): 1/2, -1/4, 1/8 ..
/// assert_eq!(answer.value().gain.as_ref().unwrap().exact, Some(1.into()));
/// assert_eq!(answer.value().signs(4, &budget)?, [0, 1, -1, 1]);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PeakToPeak {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
    /// The closed loop's verdict: only a stable one has a gain, its hidden modes included.
    pub verdict: PointVerdict,
    /// The gain of a stable loop, between two numbers or exactly.
    pub gain: Option<AbsoluteSum>,
    time: Time,
    response: Option<ImpulseResponse>,
}

impl PeakToPeak {
    /// The signs of the first samples of the impulse response, 1, -1 or 0: an input of `u_(k-i) = sign h_i` gives from rest the greatest `y_k`
    /// that inputs of modulus 1 can. Nothing of a loop that is not stable, and of one in continuous time.
    ///
    /// Cost: that of [`ImpulseResponse::signs`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn signs(&self, count: usize, budget: &Budget) -> Result<Vec<i8>, Exhausted> {
        let sampled = self.response.as_ref().filter(|_| self.time == Time::Discrete);
        sampled.map_or(Ok(Vec::new()), |response| response.signs(count, budget))
    }
}

impl Question {
    /// The peak-to-peak gain from an input to an output with every parameter at its set or nominal value; see [`Problem::peak_to_peak`].
    ///
    /// Cost: that of [`Problem::peak_to_peak`].
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`], and as [`Problem::peak_to_peak`].
    ///
    /// # Panics
    /// When a name is free.
    pub fn peak_to_peak(
        self,
        input: &str,
        output: &str,
        digits: usize,
        budget: &Budget,
    ) -> Result<Answer<PeakToPeak>, Error> {
        self.problem()?.peak_to_peak(input, output, digits, budget)
    }
}

impl Problem {
    /// The peak-to-peak gain from an input to an output: exactly, or between two numbers that differ by at most `10^-(digits + 2)` of it.
    ///
    /// It is that of the closed loop whatever the region of the question. Further pairs of the same problem share its closed loop, its verdict's
    /// algebra and its characteristic polynomial.
    ///
    /// Cost: a verdict, and [`ImpulseResponse::absolute_sum`] or [`ImpulseResponse::absolute_integral`]. A rational loop takes one characteristic polynomial for the numerator, another
    /// one two enclosed ones for each number of bits, of which there are about three.
    ///
    /// # Errors
    /// [`Error::Refused`] with `E-dead-time` where the loop has one in continuous time, `E-rate-margin` where the loop has several rates, `E-unknown-signal`, and as
    /// [`Problem::closed_loop`]; [`Error::Undefined`]; [`Error::Stopped`] when the budget runs out, and where no number of bits tells a
    /// transfer function that is not rational from zero.
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn peak_to_peak(
        self: &Arc<Self>,
        input: &str,
        output: &str,
        digits: usize,
        budget: &Budget,
    ) -> Result<Answer<PeakToPeak>, Error> {
        of_one_rate(self)?;
        self.refuse_complex(budget)?;
        let plain = self.without_region();
        let verdict = plain.verdict(budget)?.into_value();
        let (mut gain, mut response) = (None, None);
        let (closed_loop, symbols, _) = plain.closed_loop_in_numbers(budget)?;
        if !symbols.delays().is_empty() {
            return Err(CoefficientRing::of(symbols).not_rational(symbols).into());
        }
        let ports = closed_loop.ports(input, output)?;
        if verdict.verdict == Verdict::Stable {
            let own = budget.enter(|| plain.impulse_response(ports, budget))??;
            gain = Some(match self.time() {
                Time::Discrete => own.absolute_sum(digits, budget),
                Time::Continuous => own.absolute_integral(digits, budget),
            }?);
            response = Some(own);
        }
        let (input, output) = (input.to_owned(), output.to_owned());
        Ok(Answer::new(Arc::clone(self), PeakToPeak { input, output, verdict, gain, time: self.time(), response }))
    }

    /// The impulse response from an input to an output of a stable loop without a smaller region.
    fn impulse_response(&self, (i, j): (usize, usize), budget: &Budget) -> Result<ImpulseResponse, Error> {
        debug_assert!(self.region() == &Region::of(self.time()), "the characteristic polynomial is that of the loop");
        let (closed_loop, symbols, _) = self.closed_loop_in_numbers(budget)?;
        if symbols.is_empty()
            && let Some(d) = self.algebra(budget)?.polynomial()
        {
            let numerator = closed_loop.numerator_at(i, j, &d.coefficients, budget)?;
            let numbers = |all: &[RationalFunction]| all.iter().map(RationalFunction::as_constant).collect();
            let both: [Option<Vec<Rational>>; 2] = [numbers(&numerator), numbers(&d.coefficients)];
            let [Some(above), Some(below)] = both else { panic!("every parameter has a value") };
            let [above, below] = integral([above, below]);
            return Ok(ImpulseResponse::of_integers(&above, &below));
        }
        let port = Port::of(closed_loop, symbols, i, j);
        if port.is_unreached() {
            return Ok(ImpulseResponse::zero());
        }
        Ok(ImpulseResponse::by_enclosures(move |bits| port.quotient(bits)))
    }
}

/// A closed loop from an input to an output, over symbols.
struct Port {
    order: usize,
    matrix: Vec<RationalFunction>,
    column: Vec<RationalFunction>,
    row: Vec<RationalFunction>,
    direct: RationalFunction,
    /// What the loop is undefined at the zeros of.
    poles: Vec<MultiPoly>,
    symbols: Symbols,
}

impl Port {
    fn of(closed_loop: &ClosedLoop, symbols: &Symbols, i: usize, j: usize) -> Port {
        let n = closed_loop.a.rows();
        Port {
            order: n,
            matrix: closed_loop.a.entries().to_vec(),
            column: (0..n).map(|k| closed_loop.e[(k, j)].clone()).collect(),
            row: (0..n).map(|k| closed_loop.c[(i, k)].clone()).collect(),
            direct: closed_loop.d[(i, j)].clone(),
            poles: closed_loop.poles.clone(),
            symbols: symbols.clone(),
        }
    }

    /// Whether no chain of entries leads from the input to the output: then the transfer function is 0.
    fn is_unreached(&self) -> bool {
        let n = self.order;
        let mut reached: Vec<bool> = self.column.iter().map(|e| !e.is_zero()).collect();
        // A chain has at most as many entries as there are states.
        for _ in 0..n {
            let step = |r: usize| reached[r] || (0..n).any(|k| reached[k] && !self.matrix[r * n + k].is_zero());
            reached = (0..n).map(step).collect();
        }
        self.direct.is_zero() && (0..n).all(|k| !reached[k] || self.row[k].is_zero())
    }

    /// Numerator and denominator from the constant term up, by the matrix determinant lemma: with feedback from the output to the input
    /// the characteristic polynomial is that of the loop and the numerator without what is direct.
    fn quotient(&self, bits: u64) -> Option<[Vec<Ball>; 2]> {
        let values = self.symbols.enclosed(bits)?;
        let is_apart =
            |p: &MultiPoly| quotient_at(&p.clone().into(), &values, bits).is_some_and(|v| !v.contains_zero());
        if !self.poles.iter().all(|p| p.is_one() || is_apart(p)) {
            return None;
        }
        let all = |list: &[RationalFunction]| {
            list.iter().map(|f| quotient_at(f, &values, bits)).collect::<Option<Vec<Ball>>>()
        };
        let (matrix, column, row) = (all(&self.matrix)?, all(&self.column)?, all(&self.row)?);
        let direct = quotient_at(&self.direct, &values, bits)?;
        let n = self.order;
        let own = BallMatrix::from_fn(n, |r, k| matrix[r * n + k].clone());
        let changed = BallMatrix::from_fn(n, |r, k| own.at(r, k).sub(&column[r].mul(&row[k])));
        let [denominator, other] = [own, changed].map(|m| m.characteristic_polynomial(bits));
        let pairs = other.iter().zip(&denominator);
        let numerator = pairs.map(|(b, a)| b.sub(a).add(&direct.mul(a))).collect();
        Some([numerator, denominator])
    }
}
