//! Figs. 7-14: the linear model, and beside it the circuit with its switches.

use super::facts::{SPEED_REFERENCE, TEST_POINTS, TestPoint, constant};
use super::report::NamedFigure;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_draw::figures::{ResponseCurve, response_panel};
use jurist_draw::page::{figure, math, paragraph};
use jurist_draw::simulate::{
    Excitation, Pulse, Record, SampledModel, Step, SwitchedModel, SwitchedRun, SwitchedState, Trace, eigenvalues,
};
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::problem::{Ask, Problem};
use nalgebra::DVector;
use std::sync::Arc;

/// Current in A that disturbs the steady state.
const DISTURBANCE: f64 = 0.01;

/// The point that both parameters are set to.
pub(super) fn at(model: &Model, amplitude: &Rational, period: &Rational) -> Result<Arc<Problem>, Error> {
    model.ask().set("K_pwm", amplitude.clone()).set("T", period.clone()).problem()
}

/// The reference steps to 80 rad/s at the beginning.
fn reference() -> Excitation {
    Excitation { initial: vec![], steps: vec![Step { sample: 0, input: 0, value: SPEED_REFERENCE }] }
}

/// Where a growing signal leaves three times the range of its first tenth of a second; else the end.
fn window(trace: &Trace, signal: &str, settled: f64) -> f64 {
    let early = trace.between(0.0, 0.1).peak(signal).max(settled);
    let outside = |p: &(f64, f64)| p.1.abs() > 3.0 * early;
    let end = trace.time.last().copied().unwrap_or(1.0);
    trace.points(signal).iter().find(|p| outside(p)).map_or(end, |p| p.0)
}

/// The HTML of the section; the figures are appended to `figures`.
pub(super) fn section(
    model: &Model,
    blocks: &Model,
    figures: &mut Vec<NamedFigure>,
    budget: &Budget,
) -> Result<String, Error> {
    let mut html = paragraph(
        "The paper's figures are runs of the linear model, which no voltage limits. Beside each: the circuit with its \
         switches, its duty ratio clamped to 0 .. 1, once from rest and once from its periodic steady state, disturbed by \
         0.01 A (drawn is the deviation at the periods' beginnings). All of this section is floating point.",
    );
    budget.step("simulating");
    for (k, case) in TEST_POINTS.iter().enumerate() {
        budget.advance(k as u64, TEST_POINTS.len() as u64);
        budget.check()?;
        let period = Rational::new(1.into(), case.frequency.into());
        let amplitude = Rational::from(case.amplitude);
        let problems = [at(model, &amplitude, &period)?, at(blocks, &amplitude, &period)?];
        html.push_str(&one_case(case, &problems, figures, budget)?);
    }
    Ok(html)
}

fn one_case(
    case: &TestPoint,
    [sampled, blocks]: &[Arc<Problem>; 2],
    figures: &mut Vec<NamedFigure>,
    budget: &Budget,
) -> Result<String, Error> {
    let linear = SampledModel::from_loop(sampled, 1.0, budget)?;
    let model = sampled.model();
    let circuit = SwitchedModel::from_loop(blocks, Some(Pulse::Beginning), budget)?;
    let period = linear.sample_time;
    let growth = eigenvalues(&linear.transition).and_then(|v| v.first().map(|z| z.norm())).unwrap_or(f64::NAN);
    let trace = linear.simulate(&reference(), (2.0f64.max(case.duration) / period).round() as usize);
    let periods = (case.duration / period).round() as usize;
    let rest = circuit.simulate(&circuit.rest(), &reference(), periods, Record::Samples);
    let inputs = DVector::from_vec(vec![SPEED_REFERENCE, 0.0]);
    let steady = circuit.periodic_steady_state(&inputs);
    let multiplier = circuit.small_signal_eigenvalues(&inputs).and_then(|v| v.first().map(|z| z.norm()));
    let disturbed = steady.map(|operating| deviation(&circuit, &operating.state, periods));
    let mut html = format!("<h3>{}</h3>\n", math(case.heading));
    let word = if growth < 1.0 { "settles" } else { "grows without bound" };
    html.push_str(&paragraph(&format!(
        "The linear model {word}: its dominant pair changes by a factor of {growth:.7} per period. {} From rest the \
         linear model's current controller asks for up to {:.0} V against a carrier of {} V; the circuit is at a limit of \
         its modulator in {} of {periods} periods.",
        multiplier.map_or_else(String::new, small_signal),
        largest_control(model, &trace),
        constant(model, "E_sw"),
        rest.clamped,
    )));
    for (number, signal, label, settled) in
        [(case.speed, "omega", "ω (rad/s)", SPEED_REFERENCE), (case.current, "i_a", "current (A)", 1.0)]
    {
        let end = window(&trace, signal, settled);
        let shown = trace.between(0.0, end);
        let mut panels =
            vec![(format!("fig-{number:02}-linear"), format!("Fig. {number}: linear model"), &shown, label.to_owned())];
        panels.push((
            format!("fig-{number:02}-from-rest"),
            "circuit, from rest".to_owned(),
            &rest.trace,
            label.to_owned(),
        ));
        if let Some(run) = &disturbed {
            let label = format!("deviation of {label}");
            panels.push((format!("fig-{number:02}-disturbed"), "circuit, disturbed".to_owned(), &run.trace, label));
        }
        html.push_str("<div class=\"grid\">\n");
        for (file, title, trace, label) in panels {
            let curve = ResponseCurve { trace, signal, label: "" };
            let drawn = response_panel(&title, "s", &label, &[curve]).figure(350.0, 240.0);
            html.push_str(&figure(&file, &drawn, &format!("{title}, {}", case.heading)));
            figures.push(NamedFigure { name: file, figure: drawn });
        }
        html.push_str("</div>\n");
    }
    Ok(html)
}

/// How the circuit moves against its steady state when that is disturbed.
fn deviation(circuit: &SwitchedModel, steady: &SwitchedState, periods: usize) -> SwitchedRun {
    let mut start = steady.clone();
    start.plant[0] += DISTURBANCE;
    let mut run = circuit.simulate(&start, &reference(), periods, Record::Samples);
    for (k, signal) in run.trace.signals.iter_mut().take(steady.plant.len()).enumerate() {
        for value in &mut signal.values {
            *value -= steady.plant[k];
        }
    }
    run
}

/// What a factor per period says.
fn small_signal(factor: f64) -> String {
    let word = if factor < 1.0 { "stable" } else { "unstable" };
    format!("The circuit's small deviations change by a factor of {factor:.7} per period: it is small-signal {word}.")
}

/// The largest output of the current controller in the linear model's first tenth of a second, V:
/// Eq. 9 with the gains of the model.
fn largest_control(model: &Model, trace: &Trace) -> f64 {
    let early = trace.between(0.0, 0.1);
    let (Some(a), Some(b)) = (early.signal("eps_1i"), early.signal("eps_2i")) else { return f64::NAN };
    let (proportional, integral) = (constant(model, "K_pi"), constant(model, "K_ii"));
    a.values.iter().zip(&b.values).map(|(a, b)| (proportional * a + integral * b).abs()).fold(0.0, f64::max)
}

/// The ripple of the current over four periods of the nominal steady state.
pub(super) fn ripple(blocks: &Model, budget: &Budget) -> Result<Option<NamedFigure>, Error> {
    let circuit = SwitchedModel::from_loop(&*blocks.ask().problem()?, Some(Pulse::Beginning), budget)?;
    let inputs = DVector::from_vec(vec![SPEED_REFERENCE, 0.0]);
    Ok(circuit.periodic_steady_state(&inputs).map(|operating| {
        let run = circuit.simulate(&operating.state, &reference(), 4, Record::Waveform(3));
        let curve = ResponseCurve { trace: &run.trace, signal: "i_a", label: "" };
        let panel = response_panel("Steady state at 80 rad/s, four periods", "s", "current (A)", &[curve]);
        NamedFigure { name: "ripple".into(), figure: panel.figure(760.0, 260.0) }
    }))
}
