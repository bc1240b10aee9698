//! A simulation as a picture.

use super::panel::stacked;
use super::responses::response_panels;
use super::{Figure, heading};
use crate::document::{SimulationAnswer, TimeUnit};
use crate::simulate::StepMeasures;
use jurist_engine::answer::Verdict;
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;

/// Width of a panel and its height.
const PANEL: (f64, f64) = (760.0, 230.0);

/// The outputs over time, one panel each; of the circuit all but the duty ratios. Marked is how signals go to their final
/// values, where these are known and the loop is stable; of another loop it is said that it is not.
pub fn response_figure(
    problem: &Problem,
    answer: &SimulationAnswer,
    finals: &[(String, f64)],
    verdict: Verdict,
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
    let held = model.time() == Time::Discrete && answer.circuit.is_none();
    let panels = response_panels(unit, &answer.trace, &shown, held);
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
