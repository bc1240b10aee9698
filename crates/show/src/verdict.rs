//! The verdict at one point.

use super::intervals::heading;
use super::layout::short;
use crate::Text;
use jurist_engine::answer::{Answer, PointVerdict, Verdict};
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;

impl Text for Answer<PointVerdict> {
    /// The verdict for people: two lines.
    fn text(&self, _digits: usize) -> String {
        format!("{}\n{}\n", heading(self.problem()), verdict_line(self.problem(), self.value()))
    }
}

/// `unstable: 4 roots inside the unit circle, 0 on it, 2 outside`.
pub fn verdict_line(problem: &Problem, answer: &PointVerdict) -> String {
    let name = answer.verdict.name();
    let boundary = match (problem.time(), problem.region().radius(), problem.region().decay()) {
        (Time::Discrete, Some(r), _) => format!("the circle |z| = {}", short(r)),
        (Time::Discrete, None, _) => "the unit circle".to_owned(),
        (Time::Continuous, _, Some(s)) => format!("the line Re s = {}", short(&-s)),
        (Time::Continuous, _, None) => "the imaginary axis".to_owned(),
    };
    if let Some(delayed) = answer.delayed {
        let roots = |n: usize| if n == 1 { "1 root".to_owned() } else { format!("{n} roots") };
        return match (answer.verdict, delayed.right) {
            (Verdict::Stable, _) => format!("{name}: all roots, infinitely many, are left of {boundary}"),
            (_, Some(right)) => format!("{name}: {} on {boundary}, {right} right of it", roots(delayed.on)),
            (_, None) => {
                format!("{name}: a chain of infinitely many roots is right of {boundary} or comes up to it")
            }
        };
    }
    let Some(count) = answer.count else {
        let unknown =
            "an expression of the model divides by zero, a block loses its order, or the loop is not well posed";
        return format!("{name}: {}", answer.undefined.as_deref().unwrap_or(unknown));
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
    if degree == 0 && count.total() == 0 {
        return format!("{name}: the characteristic polynomial is zero, so that every number is a root");
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
    if answer.drifts && problem.region().radius().is_none() && problem.region().decay().is_none() {
        let end = if problem.time() == Time::Discrete { "z = 1" } else { "s = 0" };
        line.push_str(&format!("; a real root beyond {end}: is a sign of the feedback missing?"));
    }
    line
}
