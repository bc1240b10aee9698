//! The limits of stability by several ways: printed, proved, and seen in runs.

use super::facts::{AMPLITUDE, PERIOD, PUBLISHED_LIMITS, SPEED_REFERENCE};
use super::runs::at;
use jurist_algebra::limits::{Budget, Exhausted, join, until_shown};
use jurist_algebra::number::{Rational, enclosed_decimal};
use jurist_algebra::real::Real;
use jurist_draw::page::Table;
use jurist_draw::report::{around_nominal, limit_text};
use jurist_draw::simulate::{Pulse, SampledModel, SwitchedModel, growth_limit};
use jurist_engine::answer::Answer;
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;
use jurist_engine::stability::StableSet;
use nalgebra::DVector;

/// The ends of the stable interval around the nominal value (or of the first).
pub(super) fn ends(answer: &Answer<StableSet>) -> (Option<&Real>, Option<&Real>) {
    match around_nominal(answer).or(answer.value().intervals().first()) {
        Some(i) => (i.lower.as_ref().map(|e| &e.value), i.upper.as_ref().map(|e| &e.value)),
        None => (None, None),
    }
}

/// `1/x` of a positive number, correctly rounded.
pub(super) fn reciprocal(x: Option<&Real>, digits: usize) -> String {
    let Some(x) = x.filter(|x| x.sign().is_gt()) else { return "none".into() };
    until_shown(digits as u64 + 2, |accuracy| {
        let (lo, hi) = x.refined_to_digits(accuracy as usize).enclosure();
        enclosed_decimal(&hi.recip()?, &lo.recip()?, digits)
    })
}

/// A way to see whether the loop is stable at an amplitude and a period: a factor per step, below 1
/// where it is.
type Seen<'a> = dyn Fn(f64, f64) -> Option<f64> + Sync + 'a;

/// The limits by several ways.
pub(super) fn limits(model: &Model, blocks: &Model, printed: [&Model; 2], budget: &Budget) -> Result<Table, Error> {
    let head = ["way", "K_pwm (V), lower", "K_pwm (V), upper", "f (Hz), lower", "kind"];
    let mut table = Table::new("Limits of stability at the nominal values of the other parameter", &head);
    let mut row = |cells: [&str; 5]| table.rows.push(cells.iter().map(|c| (*c).to_owned()).collect());
    for (way, [lower, upper, frequency]) in PUBLISHED_LIMITS {
        row([way, lower, upper, frequency, "published"]);
    }
    let exact = |lp: &Model, name: &str| lp.ask().free(name).stable_set(budget);
    for (way, in_amplitude, in_period) in
        [("exact", model, model), ("printed coefficients, exact", printed[0], printed[1])]
    {
        let (k, t) = (exact(in_amplitude, "K_pwm")?, exact(in_period, "T")?);
        let ((lower, upper), (shortest, longest)) = (ends(&k), ends(&t));
        let mut f = reciprocal(longest, 16);
        if shortest.is_some_and(|s| s.sign().is_gt()) {
            f.push_str(&format!(" (and f < {})", reciprocal(shortest, 8)));
        }
        row([way, &limit_text(lower, 16), &limit_text(upper, 16), &f, "proved"]);
    }
    let growth = |k: f64, t: f64| {
        let problem = at(model, &Rational::from_f64(k)?, &Rational::from_f64(t)?).ok()?;
        let mut m = SampledModel::from_loop(&problem, 1.0, budget).ok()?;
        // Seen every 1024 samples: the same run, and the slow mode has time to show itself.
        for _ in 0..10 {
            m.transition = &m.transition * &m.transition;
        }
        m.observed_growth(600, 3000)
    };
    budget.step("limits by runs of the linear model");
    let lower = bisected((0.06, 0.02), 2e-5, budget, |k| growth(k, PERIOD))?;
    let [upper, f] = both(&growth, (545.0, 555.0), (2020.0, 2010.0), [0.002, 0.002], budget)?;
    row(["linear model, runs", &shown(lower, 4), &shown(upper, 2), &shown(f, 2), "drawn"]);
    let inputs = DVector::from_vec(vec![SPEED_REFERENCE, 0.0]);
    let circuit = |k: f64, t: f64, pulse| {
        let problem = at(blocks, &Rational::from_f64(k)?, &Rational::from_f64(t)?).ok()?;
        SwitchedModel::from_loop(&problem, Some(pulse), budget).ok()
    };
    for (pulse, word) in [(Pulse::Beginning, "beginning"), (Pulse::End, "end")] {
        let eigenvalue =
            |k: f64, t: f64| circuit(k, t, pulse)?.small_signal_eigenvalues(&inputs)?.first().map(|z| z.norm());
        let run = |k: f64, t: f64| circuit(k, t, pulse)?.perturbed_growth(&inputs, 2_000, 8_000).map(|g| g.factor);
        let ways: [(&str, &Seen<'_>, [f64; 2], usize); 2] =
            [("eigenvalues", &eigenvalue, [1e-6, 1e-6], 3), ("disturbed runs", &run, [0.005, 0.02], 2)];
        for (how, seen, width, digits) in ways {
            budget.step(&format!("limits of the circuit by {how}, pulse at the {word}"));
            let [upper, f] = both(seen, (550.0, 553.0), (2010.0, 2000.0), width, budget)?;
            let way = format!("circuit, pulse at the {word}: {how}");
            row([&way, "", &shown(upper, digits), &shown(f, digits - 1), "drawn"]);
        }
    }
    Ok(table)
}

/// The upper limit of the amplitude at the paper's period, and the lower limit of the frequency at its amplitude,
/// between a stable and an unstable value each.
fn both(
    seen: &Seen<'_>,
    amplitude: (f64, f64),
    frequency: (f64, f64),
    width: [f64; 2],
    budget: &Budget,
) -> Result<[Option<f64>; 2], Exhausted> {
    let (k, f) = join(
        || bisected(amplitude, width[0], budget, |k| seen(k, PERIOD)),
        || bisected(frequency, width[1], budget, |f| seen(AMPLITUDE, 1.0 / f)),
    );
    Ok([k?, f?])
}

/// Where what is seen passes from stable to unstable, to `width`.
fn bisected(
    (stable, unstable): (f64, f64),
    width: f64,
    budget: &Budget,
    seen: impl Fn(f64) -> Option<f64>,
) -> Result<Option<f64>, Exhausted> {
    let limit = growth_limit(stable, unstable, width, |x| if budget.check().is_ok() { seen(x) } else { None });
    budget.check()?;
    Ok(limit)
}

fn shown(x: Option<f64>, digits: usize) -> String {
    x.map_or_else(|| "none found".into(), |x| format!("{x:.digits$}"))
}
