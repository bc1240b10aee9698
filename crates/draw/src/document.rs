//! Time responses and root loci as JSON. All numbers but those of the question are floating point,
//! and say so.

use crate::figures::DrawnLocus;
use crate::simulate::{Operating, SwitchedModel, Trace};
use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::model::{Loop, Time};
use jurist_engine::problem::Problem;
use jurist_engine::show::json;
use jurist_engine::stability::StableSet;
use nalgebra::Complex;
use serde_json::{Map, Value, json};

/// What a simulation found.
#[derive(Clone, Debug)]
pub struct SimulationAnswer {
    /// The signals.
    pub trace: Trace,
    /// Seconds between two samples; `None` for a continuous loop or without a sample time.
    pub sample_time: Option<f64>,
    /// What is known of the circuit, if that was simulated.
    pub circuit: Option<CircuitAnswer>,
}

/// What a simulation of the switched circuit found beside the signals.
#[derive(Clone, Debug)]
pub struct CircuitAnswer {
    /// Names of the plant's states.
    pub states: Vec<String>,
    /// The periodic steady state under the first inputs, if there is one without clamping.
    pub operating: Option<Operating>,
    /// Eigenvalues of the linearised period map there, largest first.
    pub multipliers: Vec<Complex<f64>>,
    /// In how many periods a modulator was at its limit.
    pub clamped: usize,
}

impl CircuitAnswer {
    /// The steady state and its multipliers under constant inputs; no run yet.
    pub fn around(circuit: &SwitchedModel, inputs: &nalgebra::DVector<f64>) -> CircuitAnswer {
        CircuitAnswer {
            states: circuit.plant_states().to_vec(),
            operating: circuit.periodic_steady_state(inputs),
            multipliers: circuit.small_signal_eigenvalues(inputs).unwrap_or_default(),
            clamped: 0,
        }
    }
}

/// The unit of a loop's time: seconds, or samples where a discrete loop names no sample time.
pub fn time_unit(model: &Loop, sample_time: Option<f64>) -> &'static str {
    if model.time() == Time::Continuous || sample_time.is_some() { "s" } else { "samples" }
}

/// `jurist/simulate/1`.
///
/// `time` are the instants in `time_unit`, `signals` have as many values; instants repeat where a
/// signal jumps. A unit that the model does not name is `null`.
pub fn simulation_json(problem: &Problem, answer: &SimulationAnswer) -> Value {
    let model = problem.model();
    let signal = |s: &crate::simulate::Signal| {
        let unit = if s.unit.is_empty() { Value::Null } else { s.unit.as_str().into() };
        json!({ "name": s.name, "unit": unit, "values": s.values })
    };
    let mut out = head("jurist/simulate/1", model.title(), problem.set());
    out.insert("kind".into(), if answer.circuit.is_some() { "switched" } else { "sampled" }.into());
    out.insert("sample_time".into(), answer.sample_time.map_or(Value::Null, Value::from));
    out.insert("time_unit".into(), time_unit(model, answer.sample_time).into());
    out.insert("time".into(), answer.trace.time.clone().into());
    out.insert("signals".into(), answer.trace.signals.iter().map(signal).collect::<Vec<_>>().into());
    if let Some(circuit) = &answer.circuit {
        let steady = circuit.operating.as_ref().map(|operating| {
            let state = circuit.states.iter().zip(operating.state.plant.iter());
            let state: Map<String, Value> = state.map(|(name, v)| (name.clone(), (*v).into())).collect();
            json!({ "duty": operating.duty, "state": state, "multipliers": complex(&circuit.multipliers) })
        });
        out.insert("steady_state".into(), steady.unwrap_or(Value::Null));
        out.insert("clamped_periods".into(), circuit.clamped.into());
    }
    Value::Object(out)
}

/// `jurist/locus/1`: the roots, branch by branch, and the certified crossings.
pub fn locus_json(answer: &Answer<StableSet>, drawn: &DrawnLocus) -> Value {
    let problem = answer.problem();
    let free = problem.parameter();
    let mut out = head("jurist/locus/1", problem.title(), problem.set());
    out.insert("time".into(), problem.time().name().into());
    out.insert("parameter".into(), free.name.as_str().into());
    out.insert("unit".into(), free.unit.as_deref().map_or(Value::Null, Value::from));
    let crossing =
        |c: &crate::simulate::Crossing| json!({ "value": c.parameter, "at": complex(&c.at), "label": c.label });
    out.insert("crossings".into(), drawn.crossings.iter().map(crossing).collect::<Vec<_>>().into());
    let branch = |b: &crate::simulate::Branch| {
        let (values, roots): (Vec<f64>, Vec<Complex<f64>>) = b.points.iter().copied().unzip();
        json!({ "values": values, "roots": complex(&roots) })
    };
    out.insert("branches".into(), drawn.locus.branches().iter().map(branch).collect::<Vec<_>>().into());
    Value::Object(out)
}

fn head(schema: &str, title: Option<&str>, set: &[(String, Rational)]) -> Map<String, Value> {
    let mut out = Map::new();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), title.unwrap_or_default().into());
    out.insert("floating_point".into(), true.into());
    out.insert("set".into(), json::set(set));
    out
}

/// Pairs of real and imaginary part.
fn complex(values: &[Complex<f64>]) -> Value {
    values.iter().map(|z| json!([z.re, z.im])).collect::<Vec<_>>().into()
}
