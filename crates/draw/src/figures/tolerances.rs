//! Tolerances: which of them use the margin, where the roots go on the way to the worst point, and the response there.

use super::facts::heading;
use super::locus::locus_of;
use super::responses::{ResponseCurve, axis_label, response_panel, stairs};
use super::{COLOURS, FAINT, Figure, INK};
use crate::scene::{Anchor, Colour, Rectangle, Scene, Stroke, Words};
use crate::simulate::{SampledModel, Trace, excitation, natural_duration, signal_unit};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer};
use jurist_engine::error::Error;
use jurist_engine::model::Time;
use jurist_engine::problem::{Ask, Problem};
use jurist_engine::stability::Range;
use jurist_show::layout::percent;
use std::sync::Arc;

/// More bars are drawn as one.
const MOST_BARS: usize = 14;

/// Width of the bars' picture and of a response.
const WIDTH: f64 = 860.0;

/// Height of a bar with the space below it.
const BAR: f64 = 22.0;

/// Samples of a response of a loop in continuous time.
const SAMPLES: f64 = 800.0;

/// Most samples of a response.
const MOST_SAMPLES: usize = 20_000;

/// One figure: bars of the shares, the locus along the line from the nominal point to the worst one, and, where the model has
/// inputs and outputs, the response at the nominal point beside that at the worst point of the largest box that is proved
/// within the tolerances.
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out.
pub fn tolerance_figure(answer: &Answer<ToleranceAnswer>, budget: &Budget) -> Result<Figure, Error> {
    let mut parts: Vec<Figure> = bars(answer).into_iter().collect();
    // Of a loop with dead time there is no locus.
    let has_dead_time = !answer.problem().algebra_over_symbols(budget)?.symbols().delays().is_empty();
    if let Some(worst) = answer.value().worst.as_ref().filter(|_| !has_dead_time) {
        let end = worst.end.value.refined_to_digits(6).enclosure().1;
        let is_rational = worst.problem.algebra_over_symbols(budget)?.symbols().is_empty();
        let beyond = if is_rational { Rational::new(6.into(), 5.into()) } else { Rational::new(17.into(), 16.into()) };
        let last = &end * &beyond;
        let set = match is_rational {
            true => worst.problem.stable_set(budget)?,
            // The end is known of a short stretch of the line alone; the picture is of all of it.
            false => {
                let whole = Range::between(Some(Rational::ZERO), Some(last.clone()));
                Arc::new(worst.problem.over_domain(whole)).stable_set(budget)?
            }
        };
        let range = (Rational::ZERO, last);
        parts.push(locus_of(&set, &range, None, budget)?.figure);
    }
    parts.extend(responses(answer, budget)?);
    let width = parts.iter().map(|part| part.size().0).fold(WIDTH, f64::max);
    let mut whole = Scene::new(width, parts.iter().map(|part| part.size().1).sum());
    let mut top = 0.0;
    for part in parts {
        let height = part.size().1;
        whole.place((0.0, top), part.scene().clone());
        top += height;
    }
    Ok(Figure::from(whole).headed(&heading("Tolerances: what uses the margin, and the worst point", answer.problem())))
}

/// The shares as bars, the largest first; each name with its sign at the worst point.
fn bars(answer: &Answer<ToleranceAnswer>) -> Option<Figure> {
    let factor = answer.value().factor.as_ref()?;
    let (mut shares, direction) = (answer.value().shares()?, factor.direction.as_ref()?);
    shares.sort_by(|(_, a), (_, b)| b.cmp(a));
    let names: Vec<String> = answer.problem().free().iter().map(|free| free.name.clone()).collect();
    let mut rows: Vec<(String, Rational)> = Vec::new();
    for (row, (i, share)) in shares.iter().enumerate() {
        let i = *i;
        if row + 1 >= MOST_BARS && shares.len() > MOST_BARS {
            let rest = shares[row..].iter().fold(Rational::ZERO, |sum, (_, share)| sum + share);
            rows.push((format!("the other {}", shares.len() - row), rest));
            break;
        }
        let place = match direction[i].abs() == Rational::ONE {
            true if direction[i].is_negative() => "\u{2212}",
            true => "+",
            false => "inside",
        };
        rows.push((format!("{} {place}", names[i]), share.clone()));
    }
    let left = 20.0 + rows.iter().map(|(name, _)| crate::scene::width(name, 12.0)).fold(60.0, f64::max);
    let room = WIDTH - left - 90.0;
    let mut scene = Scene::new(WIDTH, BAR * rows.len() as f64 + 34.0);
    scene.words(Words::new("share of the margin that each tolerance uses", (left, 14.0), 12.0, INK));
    for (k, (name, share)) in rows.iter().enumerate() {
        let top = 24.0 + BAR * k as f64;
        let length = room * share.to_f64_approximate().clamp(0.0, 1.0);
        scene.words(Words::new(name.clone(), (left - 8.0, top + 12.0), 12.0, INK).anchored(Anchor::End));
        let bar = Rectangle { left, top: top + 1.0, width: length.max(0.75), height: BAR - 7.0 };
        scene.rectangle(&bar, Some(Colour::css(COLOURS[0])), None);
        scene.words(Words::new(percent(share, 3), (left + length + 6.0, top + 12.0), 12.0, INK));
    }
    let bottom = 24.0 + BAR * rows.len() as f64;
    scene.line((left, 22.0), (left, bottom), Stroke::new(FAINT, 0.9));
    Some(scene.into())
}

/// The worst point within the tolerances and within the box that is proved.
fn worst_point(answer: &ToleranceAnswer) -> Option<Vec<Rational>> {
    let factor = answer.factor.as_ref()?;
    let share = factor.lower.clone().min(Rational::ONE);
    let place = |(side, c): (&jurist_engine::stability::boxes::Side, &Rational)| {
        let [low, high] = side.at(&share);
        let end = if c.is_negative() { low } else { high };
        side.nominal() + &(&(&end - side.nominal()) * &c.abs())
    };
    Some(answer.sides.iter().zip(factor.direction.as_ref()?).map(place).collect())
}

/// One panel for each output; none for a model that is only a polynomial.
fn responses(answer: &Answer<ToleranceAnswer>, budget: &Budget) -> Result<Vec<Figure>, Error> {
    let Some(worst) = worst_point(answer.value()) else { return Ok(Vec::new()) };
    let problem = answer.problem();
    let model = problem.model();
    let at = |point: &[Rational]| {
        let names = problem.free().iter().map(|free| free.name.clone());
        model.ask().set_all(problem.set().to_vec()).set_all(names.zip(point.iter().cloned())).problem()
    };
    let nominal: Vec<Rational> = answer.value().sides.iter().map(|side| side.nominal().clone()).collect();
    let (nominal, worst) = (at(&nominal)?, at(&worst)?);
    let duration = match &model.simulation().duration {
        Some(duration) => duration.to_f64_approximate(),
        None => match natural_duration(&nominal, budget) {
            Ok(found) => found.unwrap_or(1.0),
            Err(Error::Stopped(stopped)) => return Err(Error::Stopped(stopped)),
            Err(_) => return Ok(Vec::new()),
        },
    };
    let runs = [("nominal", &nominal), ("worst point", &worst)];
    let mut traces = Vec::new();
    for (label, problem) in runs {
        match run(problem, duration, budget) {
            Ok(Some(trace)) => traces.push((label, trace)),
            Err(Error::Stopped(stopped)) => return Err(Error::Stopped(stopped)),
            Ok(None) | Err(_) => return Ok(Vec::new()),
        }
    }
    let outputs: Vec<String> = model.outputs().iter().map(|o| o.name.name.clone()).collect();
    let unit = if model.time() == Time::Discrete && problem.model().sample_time_expression().is_none() {
        "samples"
    } else {
        "s"
    };
    let panel = |name: &String| {
        let curves: Vec<ResponseCurve<'_>> =
            traces.iter().map(|(label, trace)| ResponseCurve { trace, signal: name, label }).collect();
        let label = axis_label(name, signal_unit(model, name).as_deref().unwrap_or(""));
        response_panel("", unit, &label, &curves).figure(WIDTH, 230.0)
    };
    Ok(outputs.iter().map(panel).collect())
}

/// The response to the model's own inputs, or to a unit step of the first; `None` where there are neither inputs nor outputs.
fn run(problem: &Arc<Problem>, duration: f64, budget: &Budget) -> Result<Option<Trace>, Error> {
    let model = problem.model();
    let system = SampledModel::from_loop(problem, duration / SAMPLES, budget)?;
    if system.inputs.is_empty() || system.outputs.is_empty() {
        return Ok(None);
    }
    let defaults = model.simulation();
    let mut steps: Vec<(String, usize, f64)> =
        defaults.inputs.iter().map(|(name, value)| (name.name.clone(), 0, value.to_f64_approximate())).collect();
    let initial: Vec<(String, f64)> =
        defaults.initial.iter().map(|(name, value)| (name.name.clone(), value.to_f64_approximate())).collect();
    if steps.is_empty() && initial.is_empty() {
        steps.push((system.inputs[0].clone(), 0, 1.0));
    }
    let drive = excitation(|name| system.state_named(name), system.states.len(), &system.inputs, &initial, &steps)?;
    let samples = ((duration / system.sample_time).round() as usize).clamp(50, MOST_SAMPLES);
    let trace = system.simulate_within(&drive, samples, budget)?;
    Ok(Some(if problem.time() == Time::Discrete { stairs(&trace) } else { trace }))
}
