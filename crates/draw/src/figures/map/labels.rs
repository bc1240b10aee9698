//! Where names and frequencies stand beside the walls.

use super::super::engineering::{frequency_text, quantity};
use super::lines::{Role, Wall, mechanism_words};
use super::trace::approximate_real;
use jurist_algebra::limits::{Budget, parallel_map};
use jurist_engine::answer::{Answer, Frequency, Map};
use jurist_engine::error::Error;
use jurist_engine::model::Time;
use jurist_engine::problem::Free;
use jurist_engine::stability::Cause;
use jurist_engine::stability::plane::StabilityMap;
use jurist_show::layout::visible;

/// Bits of a frequency in a picture.
const BITS: u64 = 30;

/// A point of a wall at which its frequency is known.
#[derive(Clone, Debug)]
pub struct FrequencyPoint {
    /// The number of the point of its wall.
    pub point: usize,
    /// The frequency, in hertz, radians or radians per second.
    pub value: f64,
}

/// The frequency in hertz; in radians per sample where a discrete loop names no sample time.
fn frequency_value(frequency: &Frequency) -> Option<f64> {
    let of = frequency.hertz.as_ref().or(frequency.angle.as_ref())?;
    Some(of.lower().midpoint(of.upper()).to_f64_approximate())
}

/// The unit of the frequencies of a map.
pub fn frequency_unit(answer: &Answer<Map>) -> &'static str {
    match (answer.problem().time(), answer.problem().evaluated().and_then(|a| a.sample_time())) {
        (Time::Discrete, None) => "rad",
        _ => "Hz",
    }
}

/// `K_pwm = 550.94 V, 1664 Hz`: a value of a parameter to five digits and the frequency there.
fn limit_text(answer: &Answer<Map>, free: &Free, decimal: &str, frequency: Option<&Frequency>) -> String {
    let frequency = frequency.and_then(frequency_value);
    let frequency = frequency.map(|f| format!(", {}", frequency_text(f, frequency_unit(answer)))).unwrap_or_default();
    let unit = visible(free.unit.as_deref().unwrap_or_default());
    format!("{} = {}{frequency}", free.name, quantity(decimal, &unit))
}

/// The extreme values of the regions that are taken at points, with what is written there.
pub(super) fn extreme_points(answer: &Answer<Map>) -> Vec<((f64, f64), String)> {
    let mut out = Vec::new();
    for (parameter, limit) in answer
        .value()
        .limits()
        .iter()
        .flat_map(|l| l.ends.iter().enumerate())
        .flat_map(|(k, ends)| ends.iter().flatten().map(move |end| (k, end)))
    {
        let free = &answer.problem().free()[parameter];
        let text = limit_text(answer, free, &limit.limit.value.decimal(5), limit.frequency.as_ref());
        for at in &limit.limit.at {
            let middle = |k: usize| at[k].lower().midpoint(at[k].upper()).to_f64_approximate();
            out.push(((middle(0), middle(1)), text.clone()));
        }
    }
    out
}

/// The exact limits on the two lines through the nominal point, in floating point, with what is written there; the
/// ends of the domain are no limits.
pub(super) fn limits_on_lines(answer: &Answer<Map>) -> Vec<((f64, f64), String)> {
    let mut out = Vec::new();
    for (line, set) in &answer.value().slices {
        let Some((fixed, at)) = line.set().last() else { continue };
        let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
        for end in ends.filter(|e| !e.causes.contains(Cause::Domain)) {
            let value = approximate_real(&end.value);
            let at = at.to_f64_approximate();
            let place = if *fixed == answer.problem().free()[0].name { (at, value) } else { (value, at) };
            let frequency = line.frequency(end, BITS);
            let text = limit_text(answer, line.parameter(), &end.value.decimal(5), frequency.as_ref());
            if out.iter().all(|(p, _)| *p != place) {
                out.push((place, text));
            }
        }
    }
    out
}

/// Points on the visible part of a wall, about `spacing` apart in a picture of that shape, and at both ends.
pub(super) fn spaced(wall: &Wall, shape: (f64, f64), spacing: f64) -> Vec<usize> {
    let visible = |p: &(f64, f64)| (0.0..=1.0).contains(&p.0) && (0.0..=1.0).contains(&p.1);
    let mut out = Vec::new();
    let mut since = spacing * 0.6;
    for (k, pair) in wall.points.windows(2).enumerate() {
        if !visible(&pair[0]) || !visible(&pair[1]) {
            continue;
        }
        since += ((pair[1].0 - pair[0].0) * shape.0).hypot((pair[1].1 - pair[0].1) * shape.1);
        if since >= spacing {
            out.push(k + 1);
            since = 0.0;
        }
    }
    out
}

/// The certified frequencies at some points of a wall of a stable cell.
pub(super) fn frequencies(
    answer: &Answer<Map>,
    map: &StabilityMap,
    wall: &Wall,
    points: &[usize],
    budget: &Budget,
) -> Result<Vec<FrequencyPoint>, Error> {
    let causes = &map.curves[wall.curve].causes;
    if wall.role != Role::Stable || !causes.iter().any(Cause::is_of_complex_roots) {
        return Ok(Vec::new());
    }
    let found: Vec<Result<Option<FrequencyPoint>, Error>> = parallel_map(points, |&point| {
        let Some((x, number)) = wall.lines.get(point) else { return Ok(None) };
        let end = answer.wall(x, *number, BITS, budget)?;
        let value = end.and_then(|e| e.1).and_then(|f| frequency_value(&f));
        Ok(value.map(|value| FrequencyPoint { point, value }))
    });
    found.into_iter().filter_map(Result::transpose).collect()
}

/// The mechanism of a wall in words.
pub(super) fn words(answer: &Answer<Map>, map: &StabilityMap, wall: &Wall) -> String {
    mechanism_words(&map.curves[wall.curve].causes, answer)
}
