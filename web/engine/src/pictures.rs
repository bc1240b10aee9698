//! Numbers for the pictures of one point, in floating point: the roots, and the time response.

use crate::model::problem;
use crate::reply::Reply;
use crate::told::budget;
use jurist::{Budget, Error, Integer, Problem, Rational, Time, UniPoly};
use jurist_draw::figures::thinned_to;
use jurist_draw::simulate::{
    Course, DelayedModel, SampledModel, Trace, excitation, natural_duration, roots, signal_unit,
};
use jurist_engine::model::value_approximate;
use serde::Deserialize;
use serde_json::{Value, json};

/// Samples of a continuous loop over the duration.
const CONTINUOUS_SAMPLES: f64 = 600.0;
/// Samples at least and at most: a picture is not wider, and it moves while a parameter is dragged.
const SAMPLES: (f64, f64) = (50.0, 40_000.0);
/// Points of a response that are shown, about.
const SHOWN: usize = 800;

/// A point, and what is wanted of it.
#[derive(Deserialize)]
pub(crate) struct PointRequest {
    model: String,
    /// Names with their values as written.
    set: Vec<(String, String)>,
    /// Whether the time response is wanted.
    response: bool,
}

/// Roots and response; each may be missing for a reason.
pub(crate) fn point(request: &PointRequest) -> Result<Value, Error> {
    let budget = budget();
    let problem = problem(&request.model, &request.set, &[])?;
    let roots = reasoned(roots_at(&problem, &budget))?;
    let response = if request.response { reasoned(response(&problem, &budget))? } else { Value::Null };
    Ok(json!({ "roots": roots, "response": response, "floating_point": true }))
}

/// What there is, or why there is none.
fn reasoned(result: Result<Value, Error>) -> Result<Value, Error> {
    match result {
        Err(stopped @ Error::Stopped(_)) => Err(stopped),
        Err(error) => {
            serde_json::from_str(&Reply::no(&error).to_text()).or_else(|_| Ok(json!({ "defect": error.to_string() })))
        }
        known => known,
    }
}

/// Real part, imaginary part, multiplicity.
fn roots_at(problem: &Problem, budget: &Budget) -> Result<Value, Error> {
    // Of a complex loop the polynomial has the conjugate roots as well.
    problem.refuse_complex(budget)?;
    let algebra = problem.algebra_over_symbols(budget)?;
    if !algebra.symbols().delays().is_empty() {
        // Infinitely many: `jurist roots` says the rightmost.
        return Ok(json!({ "rightmost": true }));
    }
    let Some(polynomial) = algebra.polynomial() else {
        return Err(Error::Undefined(algebra.undefined().unwrap_or_default().to_owned()));
    };
    let symbols = algebra.symbols().values_approximate(&[]);
    let value =
        |c: &jurist::RationalFunction| c.as_constant().or_else(|| Rational::from_f64(value_approximate(c, &symbols)));
    let Some(coefficients) = polynomial.coefficients.iter().map(value).collect::<Option<Vec<_>>>() else {
        return Ok(json!({ "none": "the coefficients leave the range of floating point" }));
    };
    let cleared = cleared(&coefficients);
    let found: Vec<Value> = roots(&cleared).iter().map(|r| json!([r.value.re, r.value.im, r.multiplicity])).collect();
    Ok(json!({ "at": found }))
}

/// The integer polynomial with the same roots.
fn cleared(coefficients: &[Rational]) -> UniPoly {
    let common = coefficients.iter().fold(Integer::ONE, |all, c| all.lcm(&c.denominator()));
    UniPoly::new(coefficients.iter().map(|c| &c.numerator() * &common.div_exact(&c.denominator())).collect())
}

/// The response that `jurist simulate` draws: the model's inputs, else a unit step of its first.
fn response(problem: &Problem, budget: &Budget) -> Result<Value, Error> {
    let model = problem.model();
    let defaults = model.simulation();
    let asked = defaults.duration.as_ref().map(Rational::to_f64_approximate);
    let duration = match asked {
        Some(duration) => duration,
        None => natural_duration(problem, budget)?.unwrap_or(1.0),
    };
    let named =
        |(name, value): &(jurist_engine::model::Name, Rational)| (name.name.clone(), value.to_f64_approximate());
    let initial: Vec<(String, f64)> = defaults.initial.iter().map(named).collect();
    let mut inputs: Vec<(String, f64)> = defaults.inputs.iter().map(named).collect();
    let mut note = String::new();
    if inputs.is_empty() && initial.is_empty() {
        let Some(first) = model.inputs().first() else {
            return Ok(json!({ "none": "the loop has no inputs and begins at rest" }));
        };
        inputs.push((first.name.clone(), 1.0));
        note = format!("unit step of {}", first.name);
    }
    if DelayedModel::from_loop(problem, duration / CONTINUOUS_SAMPLES, budget)?.is_some() {
        let inputs = inputs.into_iter().map(|(name, value)| (name, 0.0, value)).collect();
        let course = Course { inputs, initial, duration, least_samples: 1.0 };
        let run = course.run(problem, budget)?;
        return Ok(shown(problem, &run.trace, &run.finals, "s", &note));
    }
    let system = SampledModel::from_loop(problem, duration / CONTINUOUS_SAMPLES, budget)?;
    let steps: Vec<(String, usize, f64)> = inputs.into_iter().map(|(name, value)| (name, 0, value)).collect();
    let drive = excitation(|name| system.state_named(name), system.states.len(), &system.inputs, &initial, &steps)?;
    let least = if asked.is_some() { 1.0 } else { SAMPLES.0 };
    let wanted = (duration / system.sample_time).round().max(least);
    let samples = wanted.min(SAMPLES.1);
    let trace = system.simulate_within(&drive, samples as usize, budget)?;
    let finals = system.final_values(&drive.inputs_at(0, system.inputs.len()));
    let sampled = problem.algebra_over_symbols(budget)?.sample_time().is_some();
    let unit = if sampled || model.time() == Time::Continuous { "s" } else { "samples" };
    if wanted > samples {
        note = [note, format!("the first {samples} of {wanted} samples")].join("; ");
    }
    Ok(shown(problem, &trace, &finals, unit, note.trim_start_matches("; ")))
}

/// The signals that the model names as its outputs, or all, with what they go to.
fn shown(problem: &Problem, trace: &Trace, finals: &[(String, f64)], unit: &str, note: &str) -> Value {
    let model = problem.model();
    let names: Vec<String> = match model.outputs() {
        [] => trace.signals.iter().map(|s| s.name.clone()).collect(),
        outputs => outputs.iter().map(|o| o.name.name.clone()).collect(),
    };
    let signal = |name: &String| {
        let points: Vec<(f64, f64)> = trace.points(name).into_iter().filter(|(_, v)| v.is_finite()).collect();
        let last = finals.iter().find(|(n, _)| n == name).map(|(_, value)| *value).filter(|v| v.is_finite());
        let shown: Vec<f64> = thinned_to(&points, SHOWN).into_iter().flat_map(|(t, v)| [short(t), short(v)]).collect();
        json!({ "name": name, "unit": signal_unit(model, name), "points": shown, "final": last })
    };
    json!({
        "signals": names.iter().map(signal).collect::<Vec<_>>(), "unit": unit,
        "held": model.time() == Time::Discrete, "note": note,
    })
}

/// To seven digits, more than a picture shows.
fn short(value: f64) -> f64 {
    let size = value.abs().log10().floor();
    if !(-290.0..290.0).contains(&size) {
        return value;
    }
    let unit = 10f64.powi((size as i32 - 6).abs());
    if size < 6.0 { (value * unit).round() / unit } else { (value / unit).round() * unit }
}
