//! A simulation as a picture.

use super::axes::tick_step;
use super::panel::stacked;
use super::responses::response_panels;
use super::{Figure, heading};
use crate::document::{SimulationAnswer, TimeUnit};
use crate::simulate::{StepMeasures, Trace, is_sampled};
use jurist_engine::answer::Verdict;
use jurist_engine::problem::Problem;

/// Width of a panel and its height.
const PANEL: (f64, f64) = (760.0, 230.0);

/// The outputs over time, one panel each; of the circuit all but the duty ratios. Marked is how signals go to their final
/// values, where these are known and the loop is stable; of another loop it is said that it is not. Where nobody asked for a duration the
/// picture ends soon after all signals have settled.
pub fn response_figure(
    problem: &Problem,
    answer: &SimulationAnswer,
    finals: &[(String, f64)],
    verdict: Verdict,
    is_duration_asked: bool,
) -> Figure {
    let finals = if verdict == Verdict::Stable { finals } else { &[] };
    let model = problem.model();
    let all = || answer.trace.signals.iter().map(|s| s.name.clone());
    let outputs: Vec<String> = model.outputs().iter().map(|o| o.name.name.clone()).collect();
    let (shown, kind) = match &answer.circuit {
        Some(_) => (all().filter(|n| !n.ends_with(".duty")).collect(), "Response of the switched circuit"),
        None if outputs.is_empty() => (all().collect(), "Response"),
        None => (outputs, "Response"),
    };
    let unit = TimeUnit::of(model, answer.sample_time).name();
    let sampled = |name: &str| answer.circuit.is_none() && is_sampled(model, name);
    let whole = &answer.trace;
    let end = if is_duration_asked { None } else { settled_end(whole, &shown, finals) };
    let part = end.map(|end| whole.between(f64::NEG_INFINITY, end));
    let panels = response_panels(unit, part.as_ref().unwrap_or(whole), &shown, sampled);
    let measured = panels.into_iter().zip(&shown).map(|(panel, name)| {
        let last = finals.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
        let measures = last.and_then(|last| StepMeasures::of(&answer.trace, name, last));
        let signal_unit = answer.trace.signal(name).map_or("", |s| &s.unit);
        match measures {
            Some(measures) => panel.with_step_measures(&measures, unit, signal_unit),
            None => panel,
        }
    });
    let panels: Vec<_> = measured.collect();
    let mut heading = heading(kind, problem);
    if verdict != Verdict::Stable && answer.circuit.is_none() {
        heading.notes.push(format!("the loop is {}", verdict.name()));
    }
    stacked(&panels, PANEL.0, PANEL.1).headed(&heading)
}

/// A signal has settled where it stays within this share of its largest distance from its final value.
const BAND: f64 = 0.02;
/// What is shown, as a multiple of the time until the last signal has settled, and in samples at least.
const SHOWN: f64 = 1.6;
const LEAST_SAMPLES: usize = 12;

/// When a picture may end; `None` where not all final values are known, nothing moves, or a signal has not settled within the run.
fn settled_end(trace: &Trace, shown: &[String], finals: &[(String, f64)]) -> Option<f64> {
    let mut moves = false;
    let mut settled = trace.time.get(LEAST_SAMPLES).copied()? / SHOWN;
    for name in shown {
        let last = finals.iter().find(|(n, _)| n == name).map(|(_, v)| *v)?;
        let points = trace.points(name);
        let farthest = points.iter().map(|p| (p.1 - last).abs()).fold(0.0, f64::max);
        moves |= farthest > 0.0;
        let outside = points.iter().rposition(|p| (p.1 - last).abs() > BAND * farthest);
        let from = outside.map_or(0, |k| k + 1);
        settled = settled.max(points.get(from)?.0);
    }
    let end = SHOWN * settled;
    // At a tick.
    let step = tick_step((0.0, end), 10.0);
    let end = (end / step).ceil() * step * (1.0 + 1e-9);
    (moves && end < *trace.time.last()?).then_some(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_ends_soon_after_all_signals_have_settled() {
        let mut trace = Trace::with_names(&["y".into(), "u".into()]);
        for k in 0..=1000 {
            let t = 0.1 * f64::from(k);
            trace.push(t, [1.0 - (-t).exp(), (-2.0 * t).exp()]);
        }
        let names = ["y".to_owned(), "u".to_owned()];
        let finals = [("y".to_owned(), 1.0), ("u".to_owned(), 0.0)];
        // Within 2 % from 3.91 on.
        let end = settled_end(&trace, &names, &finals).unwrap();
        assert!((end - 7.0).abs() < 1e-6, "{end}");
        let end = settled_end(&trace, &names[1..], &finals).unwrap();
        assert!((end - 3.5).abs() < 1e-6, "{end}");
        assert_eq!(settled_end(&trace, &names, &finals[..1]), None, "where a signal goes is not known");
        assert_eq!(settled_end(&trace, &names, &[("y".to_owned(), 2.0), ("u".to_owned(), 0.0)]), None);
        assert_eq!(settled_end(&trace.between(0.0, 5.0), &names, &finals), None, "the run is shorter");
    }
}
