//! What a step response shows: how long to look at it, where it ends, how far beyond that it goes.

use super::from_loop::rounded;
use super::{DelayedModel, Trace, eigenvalues};
use jurist_algebra::limits::Budget;
use jurist_engine::error::Error;
use jurist_engine::model::{Time, value_approximate};
use jurist_engine::problem::Problem;
use nalgebra::Complex;

/// Time constants of the slowest root that are looked at: the rest is below 1 %.
const TIME_CONSTANTS: f64 = 5.0;
/// Dead times that are looked at, at least.
const DEAD_TIMES: f64 = 10.0;
/// A root that grows is looked at until it is this many times as large.
const GROWTH: f64 = 20.0;
/// Rates below this share of the fastest are taken for roots on the boundary, which set no time.
const STILL: f64 = 1e-9;
/// The band around the final value in which a response counts as settled.
const BAND: f64 = 0.02;

/// How long the slowest root of a closed loop needs to die away, or the fastest that grows to grow: in seconds, or in
/// samples where the model names no sample time; rounded up to 1, 2 or 5 times a power of ten. `None` where nothing
/// sets a time. With dead time: what the loop without its dead times needs, and at least ten of them.
///
/// # Errors
/// [`Error`] as for the closed loop.
pub fn natural_duration(problem: &Problem, budget: &Budget) -> Result<Option<f64>, Error> {
    let (closed_loop, symbols, time) = problem.closed_loop_in_numbers(budget)?;
    if let Some(delayed) = DelayedModel::from_loop(problem, 1.0, budget)? {
        let roots = eigenvalues(&delayed.without_dead_time()).unwrap_or_default();
        let own = duration(&roots.iter().map(|z| z.re).collect::<Vec<_>>()).unwrap_or(0.0);
        let long = own.max(DEAD_TIMES * delayed.longest_dead_time());
        return Ok((long > 0.0).then(|| rounded_up(long)));
    }
    let symbols = symbols.values_approximate(&[]);
    let Some(roots) = eigenvalues(&rounded(&closed_loop.a, &symbols)?) else { return Ok(None) };
    let sample_time = match time {
        Some(time) if problem.time() == Time::Discrete => value_approximate(time, &symbols),
        // A step of a loop of several rates is that many samples.
        _ => problem.model().hyperperiod() as f64,
    };
    // How fast each root's share grows, per second.
    let rate = |z: &Complex<f64>| match problem.time() {
        Time::Discrete => z.norm().ln() / sample_time,
        Time::Continuous => z.re,
    };
    Ok(duration(&roots.iter().map(rate).collect::<Vec<_>>()))
}

fn duration(rates: &[f64]) -> Option<f64> {
    let rates: Vec<f64> = rates.iter().copied().filter(|r| r.is_finite()).collect();
    let fastest = rates.iter().fold(0.0f64, |m, r| m.max(r.abs()));
    let slowest = rates.iter().filter(|r| r.abs() > STILL * fastest).map(|r| r.abs()).fold(f64::INFINITY, f64::min);
    let growing = rates.iter().copied().filter(|r| *r > STILL * fastest).fold(0.0, f64::max);
    let long = if growing > 0.0 { GROWTH.ln() / growing } else { TIME_CONSTANTS / slowest };
    (long.is_finite() && long > 0.0).then(|| rounded_up(long))
}

/// The next number of 1, 2, 5 times a power of ten.
fn rounded_up(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * decade >= value * 0.999).unwrap_or(10.0);
    factor * decade
}

/// What is read from a step response, in floating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMeasures {
    /// Where it goes.
    pub last: f64,
    /// How far it goes beyond, as a share of the whole step.
    pub overshoot: f64,
    /// Time and value of the farthest point beyond.
    pub peak: Option<(f64, f64)>,
    /// From when on it stays within 2 % of the step; `None` where it does not within the run.
    pub settled: Option<f64>,
}

impl StepMeasures {
    /// The measures of a signal that goes to `last`; `None` where it is there from the beginning.
    ///
    /// ```
    /// use jurist_draw::simulate::{StepMeasures, Trace};
    /// let mut trace = Trace::with_names(&["y".into()]);
    /// [0.0, 1.5, 0.9, 1.01, 1.0].iter().enumerate().for_each(|(k, y)| trace.push(k as f64, [*y]));
    /// let measures = StepMeasures::of(&trace, "y", 1.0).unwrap();
    /// assert_eq!((measures.overshoot, measures.peak, measures.settled), (0.5, Some((1.0, 1.5)), Some(3.0)));
    /// ```
    pub fn of(trace: &Trace, signal: &str, last: f64) -> Option<StepMeasures> {
        let points = trace.points(signal);
        let step = last - points.first()?.1;
        let range = points.iter().fold(0.0f64, |m, p| m.max((p.1 - last).abs()));
        // A signal that returns to where it was has no step to measure by.
        if !step.is_finite() || step.abs() <= 0.05 * range {
            return None;
        }
        let beyond = |p: &(f64, f64)| (p.1 - last) / step;
        let peak = points.iter().copied().filter(|p| beyond(p) > 0.0).max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
        let outside = points.iter().rposition(|p| beyond(p).abs() > BAND);
        let settled = outside.map_or(0, |k| k + 1);
        Some(StepMeasures {
            last,
            overshoot: peak.as_ref().map_or(0.0, beyond),
            peak,
            settled: points.get(settled).map(|p| p.0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slowest_root_or_the_fastest_that_grows_sets_the_time() {
        assert_eq!(duration(&[-10.0, -0.5]), Some(10.0));
        assert_eq!(duration(&[-10.0, -0.5, 0.0]), Some(10.0));
        assert_eq!(duration(&[-10.0, 3.0]), Some(1.0));
        assert_eq!(duration(&[0.0]), None);
        assert_eq!(duration(&[f64::NEG_INFINITY, -1000.0]), Some(0.005));
        assert_eq!(duration(&[]), None);
    }

    #[test]
    fn a_signal_that_does_not_settle_or_does_not_move_says_so() {
        let mut trace = Trace::with_names(&["y".into(), "u".into()]);
        for (k, y) in [0.0, 0.5, 0.9].into_iter().enumerate() {
            trace.push(k as f64, [y, 3.0]);
        }
        let measures = StepMeasures::of(&trace, "y", 1.0).unwrap();
        assert_eq!((measures.overshoot, measures.peak, measures.settled), (0.0, None, None));
        assert!(StepMeasures::of(&trace, "u", 3.0).is_none());
        assert!(StepMeasures::of(&trace, "missing", 3.0).is_none());
    }
}
