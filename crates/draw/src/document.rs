//! Time responses, frequency responses and root loci as JSON. All numbers but those of the question are floating point,
//! and say so.

use crate::figures::{DrawnLocus, FrequencyResponse as Sampled, ResponsePoint};
use crate::simulate::{Operating, SwitchedModel, Trace, is_sampled};
use jurist_engine::answer::Answer;
use jurist_engine::model::{Model, Time};
use jurist_engine::problem::Problem;
use jurist_engine::response::Margins;
use jurist_engine::stability::StableSet;
use jurist_show::documents::{Exact, Named};
use nalgebra::Complex;
use serde::{Deserialize, Serialize};

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

/// A number in floating point; `null` where it is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Float(Option<f64>);

impl From<f64> for Float {
    fn from(value: f64) -> Self {
        Float(Some(value).filter(|v| v.is_finite()))
    }
}

/// Real and imaginary part.
pub type Point = [Float; 2];

/// `jurist/simulate/1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum SimulationName {
    /// The first version.
    #[default]
    #[serde(rename = "jurist/simulate/1")]
    V1,
}

/// `jurist/locus/1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum LocusName {
    /// The first version.
    #[default]
    #[serde(rename = "jurist/locus/1")]
    V1,
}

/// A time response, in floating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Simulation {
    /// The kind of document.
    pub schema: SimulationName,
    /// The model's title; empty where it has none.
    pub title: String,
    /// Always true: nothing here is exact but `set`.
    pub floating_point: bool,
    /// The values of the parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// What was simulated.
    pub kind: SimulationKind,
    /// Seconds between two samples; `null` for a continuous loop or without a sample time.
    pub sample_time: Option<Float>,
    /// The unit of `time`.
    pub time_unit: TimeUnit,
    /// The instants; they repeat where a signal jumps.
    pub time: Vec<Float>,
    /// The signals.
    pub signals: Vec<SignalValues>,
    /// What is known of a switched circuit.
    #[serde(flatten)]
    pub circuit: Option<CircuitValues>,
}

/// What was simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum SimulationKind {
    /// The circuit with its switches.
    Switched,
    /// The linear loop.
    Sampled,
}

/// The unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum TimeUnit {
    /// Seconds.
    #[serde(rename = "s")]
    Seconds,
    /// Samples: a discrete loop that names no sample time.
    #[serde(rename = "samples")]
    Samples,
}

impl TimeUnit {
    /// The unit of a loop's time.
    pub fn of(model: &Model, sample_time: Option<f64>) -> TimeUnit {
        if model.time() == Time::Continuous || sample_time.is_some() { TimeUnit::Seconds } else { TimeUnit::Samples }
    }

    /// The name used in all output.
    pub fn name(self) -> &'static str {
        match self {
            TimeUnit::Seconds => "s",
            TimeUnit::Samples => "samples",
        }
    }
}

/// A signal over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SignalValues {
    /// Its name.
    pub name: String,
    /// Its unit; `null` where the model names none.
    pub unit: Option<String>,
    /// Whether each value holds until the next instant; else the signal is continuous in between.
    pub sampled: bool,
    /// The values, one for each instant.
    pub values: Vec<Float>,
}

/// What is known of a switched circuit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CircuitValues {
    /// The periodic steady state under the first inputs; `null` where there is none without clamping.
    pub steady_state: Option<SteadyState>,
    /// In how many periods a modulator was at its limit.
    pub clamped_periods: usize,
}

/// A periodic steady state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SteadyState {
    /// The share of the period that each source is on, 0 to 1.
    pub duty: Vec<Float>,
    /// The plant's states at every period's beginning.
    pub state: Named<Float>,
    /// Eigenvalues of the linearised period map, largest first.
    pub multipliers: Vec<Point>,
}

/// A root locus, in floating point, with the exact crossings rounded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Locus {
    /// The kind of document.
    pub schema: LocusName,
    /// The model's title; empty where it has none.
    pub title: String,
    /// Always true: nothing here is exact but `set`.
    pub floating_point: bool,
    /// The values of all other parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// The kind of time.
    pub time: Time,
    /// The name of the parameter.
    pub parameter: String,
    /// Its unit; `null` where the model names none.
    pub unit: Option<String>,
    /// Where roots cross the boundary of stability.
    pub crossings: Vec<LocusCrossing>,
    /// The poles of the open loop, each once, where the parameter is a gain: the roots at 0. Else `null`.
    pub poles: Option<Vec<Point>>,
    /// The zeros of the open loop, each once, where the parameter is a gain: the roots without end. Else `null`.
    pub zeros: Option<Vec<Point>>,
    /// Pieces without gaps; a piece ends where the loop is undefined or loses degree.
    pub branches: Vec<LocusBranch>,
    /// The pieces outside of the range, of a gain: from the poles, and to the zeros.
    pub beyond: Vec<LocusBranch>,
}

/// A crossing of the boundary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LocusCrossing {
    /// The parameter, in its unit.
    pub value: Float,
    /// The roots on the boundary, of a pair the upper one.
    pub at: Vec<Point>,
    /// What a picture says there.
    pub label: String,
}

/// A piece of the locus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LocusBranch {
    /// Values of the parameter, in its unit.
    pub values: Vec<Float>,
    /// The root at each of them.
    pub roots: Vec<Point>,
}

/// `jurist/frequency-response/1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum FrequencyResponseName {
    /// The first version.
    #[default]
    #[serde(rename = "jurist/frequency-response/1")]
    V1,
}

/// The open loop over frequency, in floating point; the exact crossings and margins are in `jurist/margins/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrequencyResponse {
    /// The kind of document.
    pub schema: FrequencyResponseName,
    /// The model's title; empty where it has none.
    pub title: String,
    /// Always true: nothing here is exact but `set`.
    pub floating_point: bool,
    /// The kind of time.
    pub time: Time,
    /// The values of the parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// Where the loop is cut.
    pub at: String,
    /// Whether frequencies are in hertz; else in radians per sample.
    pub hertz: bool,
    /// The frequencies, ascending; of a loop with complex coefficients negative ones too.
    pub frequency: Vec<Float>,
    /// The open loop there.
    pub response: Vec<Point>,
    /// Its phase in degrees, continued from the lowest frequency on, or from 0 in both directions.
    pub phase_degrees: Vec<Float>,
}

/// The document of a frequency response.
pub fn frequency_response_json(answer: &Answer<Margins>, drawn: &Sampled) -> FrequencyResponse {
    let problem = answer.problem();
    let column = |of: fn(&ResponsePoint) -> f64| drawn.all().map(|p| Float::from(of(p))).collect();
    FrequencyResponse {
        schema: FrequencyResponseName::V1,
        title: problem.title().unwrap_or_default().to_owned(),
        floating_point: true,
        time: problem.time(),
        set: problem.set().into(),
        at: answer.value().open_loop.cut().name().to_owned(),
        hertz: drawn.hertz,
        frequency: column(|p| p.frequency),
        response: drawn.all().map(|p| [p.real.into(), p.imaginary.into()]).collect(),
        phase_degrees: column(|p| p.phase),
    }
}

/// The document of a time response.
pub fn simulation_json(problem: &Problem, answer: &SimulationAnswer) -> Simulation {
    let signal = |s: &crate::simulate::Signal| SignalValues {
        name: s.name.clone(),
        unit: Some(s.unit.clone()).filter(|unit| !unit.is_empty()),
        sampled: answer.circuit.is_none() && is_sampled(problem.model(), &s.name),
        values: floats(&s.values),
    };
    Simulation {
        schema: SimulationName::V1,
        title: problem.model().title().unwrap_or_default().to_owned(),
        floating_point: true,
        set: problem.set().into(),
        kind: if answer.circuit.is_some() { SimulationKind::Switched } else { SimulationKind::Sampled },
        sample_time: answer.sample_time.map(Float::from),
        time_unit: TimeUnit::of(problem.model(), answer.sample_time),
        time: floats(&answer.trace.time),
        signals: answer.trace.signals.iter().map(signal).collect(),
        circuit: answer.circuit.as_ref().map(CircuitAnswer::values),
    }
}

impl CircuitAnswer {
    fn values(&self) -> CircuitValues {
        let steady = |operating: &Operating| SteadyState {
            duty: floats(&operating.duty),
            state: self.states.iter().cloned().zip(operating.state.plant.iter().map(|v| Float::from(*v))).collect(),
            multipliers: points(&self.multipliers),
        };
        CircuitValues { steady_state: self.operating.as_ref().map(steady), clamped_periods: self.clamped }
    }
}

/// The document of a root locus: the roots, branch by branch, and the certified crossings.
pub fn locus_json(answer: &Answer<StableSet>, drawn: &DrawnLocus) -> Locus {
    let problem = answer.problem();
    let free = problem.parameter();
    let crossing = |c: &crate::simulate::Crossing| LocusCrossing {
        value: c.parameter.into(),
        at: points(&c.at),
        label: c.label.clone(),
    };
    let branch = |b: &crate::simulate::Branch| {
        let (values, roots): (Vec<f64>, Vec<Complex<f64>>) = b.points.iter().copied().unzip();
        LocusBranch { values: floats(&values), roots: points(&roots) }
    };
    Locus {
        schema: LocusName::V1,
        title: problem.title().unwrap_or_default().to_owned(),
        floating_point: true,
        set: problem.set().into(),
        time: problem.time(),
        parameter: free.name.clone(),
        unit: free.unit.clone(),
        crossings: drawn.crossings.iter().map(crossing).collect(),
        poles: drawn.open_loop.as_ref().map(|[poles, _]| points(poles)),
        zeros: drawn.open_loop.as_ref().map(|[_, zeros]| points(zeros)),
        branches: drawn.locus.branches().iter().map(branch).collect(),
        beyond: drawn.beyond.branches().iter().map(branch).collect(),
    }
}

fn floats(values: &[f64]) -> Vec<Float> {
    values.iter().map(|v| Float::from(*v)).collect()
}

fn points(values: &[Complex<f64>]) -> Vec<Point> {
    values.iter().map(|z| [z.re.into(), z.im.into()]).collect()
}

/// JSON Schemas of these documents: kind with version, and schema.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, serde_json::Value)> {
    use jurist_show::documents::schemas::schema_of;
    let names = ["jurist/frequency-response/1", "jurist/locus/1", "jurist/simulate/1"];
    vec![
        (names[0], schema_of::<FrequencyResponse>(names[0])),
        (names[1], schema_of::<Locus>(names[1])),
        (names[2], schema_of::<Simulation>(names[2])),
    ]
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    #[test]
    fn the_schemas_that_are_published_are_those_of_the_types() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema");
        jurist_show::documents::schemas::check_published(&folder, &super::schemas());
    }
}
