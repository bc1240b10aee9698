//! Where names and frequencies stand beside the walls.

use super::lines::{Role, Wall, mechanism_words};
use super::trace::approximate_real;
use jurist_algebra::limits::{Budget, parallel_map};
use jurist_algebra::number::{parse_number, to_decimal};
use jurist_engine::answer::{Answer, Frequency, Map};
use jurist_engine::error::Error;
use jurist_engine::model::Time;
use jurist_engine::stability::Cause;
use jurist_engine::stability::plane::StabilityMap;

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

/// The frequency in the unit that suits the loop: hertz in discrete time with a sample time, radians without,
/// radians per second in continuous time.
fn frequency_value(frequency: &Frequency, time: Time) -> Option<f64> {
    let of = match (time, &frequency.hertz) {
        (Time::Discrete, Some(hertz)) => hertz,
        (Time::Discrete, None) => frequency.angle.as_ref()?,
        (Time::Continuous, _) => frequency.radians_per_second.as_ref()?,
    };
    Some(of.lower().midpoint(of.upper()).to_f64_approximate())
}

/// The unit of the frequencies of a map.
pub fn frequency_unit(answer: &Answer<Map>) -> &'static str {
    match (answer.problem().time(), answer.problem().evaluated().and_then(|a| a.sample_time())) {
        (Time::Discrete, Some(_)) => "Hz",
        (Time::Discrete, None) => "rad",
        (Time::Continuous, _) => "rad/s",
    }
}

/// `1664 Hz`, `12.0 kHz`, `0.506 Hz`.
pub(super) fn frequency_text(value: f64, unit: &str) -> String {
    match value {
        _ if (1e4..1e6).contains(&value) && unit == "Hz" => format!("{:.1} kHz", value / 1000.0),
        _ if (1000.0..1e6).contains(&value) => format!("{value:.0} {unit}"),
        _ => {
            let exact = parse_number(&format!("{value:e}")).map(|v| to_decimal(&v, 3));
            format!("{} {unit}", exact.unwrap_or_default())
        }
    }
}

/// A decimal with the sign that print has for minus.
fn printed(decimal: &str) -> String {
    decimal.replace('-', "\u{2212}")
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
        let name = &answer.problem().free()[parameter].name;
        let frequency = limit.frequency.as_ref().and_then(|f| frequency_value(f, answer.problem().time()));
        let frequency =
            frequency.map(|f| format!(", {}", frequency_text(f, frequency_unit(answer)))).unwrap_or_default();
        let text = format!("{name} = {}{frequency}", printed(&limit.limit.value.decimal(5)));
        for at in &limit.limit.at {
            let middle = |k: usize| at[k].lower().midpoint(at[k].upper()).to_f64_approximate();
            out.push(((middle(0), middle(1)), text.clone()));
        }
    }
    out
}

/// The exact limits on the two lines through the nominal point, in floating point, with what is written there:
/// `K_pwm = 550.94, 1664 Hz`.
pub(super) fn limits_on_lines(answer: &Answer<Map>) -> Vec<((f64, f64), String)> {
    let mut out = Vec::new();
    for (line, set) in &answer.value().slices {
        let Some((fixed, at)) = line.set().last() else { continue };
        for end in set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            let value = approximate_real(&end.value);
            let at = at.to_f64_approximate();
            let place = if *fixed == answer.problem().free()[0].name { (at, value) } else { (value, at) };
            let decimal = printed(&end.value.decimal(5));
            let frequency = line.frequency(end, BITS).and_then(|f| frequency_value(&f, answer.problem().time()));
            let frequency =
                frequency.map(|f| format!(", {}", frequency_text(f, frequency_unit(answer)))).unwrap_or_default();
            let text = format!("{} = {decimal}{frequency}", line.parameter().name);
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
    if wall.role != Role::Stable || !causes.contains(Cause::ComplexPair) {
        return Ok(Vec::new());
    }
    let found: Vec<Result<Option<FrequencyPoint>, Error>> = parallel_map(points, |&point| {
        let Some((x, number)) = wall.lines.get(point) else { return Ok(None) };
        let end = answer.wall(x, *number, BITS, budget)?;
        let value = end.and_then(|e| e.1).and_then(|f| frequency_value(&f, answer.problem().time()));
        Ok(value.map(|value| FrequencyPoint { point, value }))
    });
    found.into_iter().filter_map(Result::transpose).collect()
}

/// The mechanism of a wall in words.
pub(super) fn words(answer: &Answer<Map>, map: &StabilityMap, wall: &Wall) -> String {
    mechanism_words(&map.curves[wall.curve].causes, answer)
}
