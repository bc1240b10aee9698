//! The verdict at one point.

use super::intervals::heading;
use super::json;
use super::layout::short;
use crate::answer::{Answer, PointVerdict, Verdict};
use crate::model::Time;
use crate::problem::Problem;
use jurist_algebra::limits::Exhausted;
use serde_json::Value;

impl Answer<PointVerdict> {
    /// The document `jurist/verdict/1`.
    pub fn json(&self) -> Value {
        verdict_json(self.problem(), Ok(self.value()))
    }

    /// The verdict for people: two lines.
    pub fn text(&self) -> String {
        format!("{}\n{}\n", heading(self.problem()), verdict_line(self.problem(), self.value()))
    }
}

/// The document `jurist/verdict/1`, also of a verdict that the budget did not allow.
pub fn verdict_json(problem: &Problem, verdict: Result<&PointVerdict, &Exhausted>) -> Value {
    const SCHEMA: &str = "jurist/verdict/1";
    let answer = match verdict {
        Ok(answer) => answer,
        Err(stopped) => return json::undecided_point(SCHEMA, "verdict", problem, stopped),
    };
    let mut out = json::point(problem, SCHEMA);
    out.insert("verdict".into(), answer.verdict.name().into());
    out.insert("degree".into(), answer.degree.into());
    let count = answer.count;
    out.insert("inside".into(), count.map_or(Value::Null, |c| c.inside.into()));
    out.insert("on".into(), count.map_or(Value::Null, |c| c.on.into()));
    out.insert("outside".into(), count.map_or(Value::Null, |c| c.outside.into()));
    out.insert("infinite".into(), count.map_or(Value::Null, |_| answer.infinite.into()));
    Value::Object(out)
}

/// `unstable: 4 roots inside the unit circle, 0 on it, 2 outside`.
pub fn verdict_line(problem: &Problem, answer: &PointVerdict) -> String {
    let name = answer.verdict.name();
    let Some(count) = answer.count else {
        let unknown =
            "an expression of the model divides by zero, a block loses its order, or the loop is not well posed";
        return format!("{name}: {}", answer.undefined.as_deref().unwrap_or(unknown));
    };
    let boundary = match (problem.time(), problem.region().radius(), problem.region().decay()) {
        (Time::Discrete, Some(r), _) => format!("the circle |z| = {}", short(r)),
        (Time::Discrete, None, _) => "the unit circle".to_owned(),
        (Time::Continuous, _, Some(s)) => format!("the line Re s = {}", short(&-s)),
        (Time::Continuous, _, None) => "the imaginary axis".to_owned(),
    };
    let (inner, outer) = match problem.time() {
        Time::Discrete => ("inside", "outside"),
        Time::Continuous => ("left of", "right of it"),
    };
    let degree = answer.degree;
    if degree > 0 && count.total() == 0 && answer.infinite == degree {
        return format!("{name}: the characteristic polynomial loses all of its degree {degree} here");
    }
    let roots = |n: usize| if n == 1 { "root".to_owned() } else { "roots".to_owned() };
    if answer.verdict == Verdict::Stable {
        return match degree {
            0 => format!("{name}: the characteristic polynomial is a constant"),
            1 => format!("{name}: the root is {inner} {boundary}"),
            n => format!("{name}: all {n} roots are {inner} {boundary}"),
        };
    }
    let mut line = format!(
        "{name}: {} {} {inner} {boundary}, {} on it, {} {outer}",
        count.inside,
        roots(count.inside),
        count.on,
        count.outside
    );
    if answer.infinite > 0 {
        line.push_str(&format!(", {} at infinity (the degree drops from {degree})", answer.infinite));
    }
    line
}
