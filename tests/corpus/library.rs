//! The corpus asked of the library.

use crate::helpers::corpus::{
    Case, Expectation, Expected, ExpectedEnd, ExpectedValue, Found, FoundEnd, ask_all, cases,
};
use crate::helpers::model::read;
use crate::helpers::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::{Domain, UniPoly};
use jurist_engine::problem::Problem;
use jurist_engine::stability::End;

/// What the library answers.
fn found(case: &Case, expectation: &Expectation) -> Result<Found, String> {
    let (question, budget) = (expectation.question(&read(&case.model)), Budget::unlimited());
    if expectation.parameter.is_none() {
        let answer = question.verdict(&budget).map_err(|e| e.to_string())?.into_value();
        let count = answer.count.unwrap_or_default();
        let mut roots = [count.inside, count.on, count.outside, answer.infinite].map(|n| n as u64);
        if let Some(delayed) = answer.delayed {
            roots = [0, delayed.on as u64, delayed.right.unwrap_or_default() as u64, 0];
        }
        return Ok(Found::Verdict { verdict: answer.verdict.name().to_owned(), roots });
    }
    let answer = question.stable_set(&budget).map_err(|e| e.to_string())?;
    let end = |end: &Option<End>| end.as_ref().map(|end| found_end(end, answer.problem()));
    Ok(Found::Stable(answer.value().intervals().iter().map(|i| [end(&i.lower), end(&i.upper)]).collect()))
}

fn found_end(end: &End, problem: &Problem) -> FoundEnd {
    let (low, high) = end.value.refined(&number("1e-40")).enclosure();
    let frequencies = problem.frequency(end, 80).map_or_else(Vec::new, |f| {
        let named = [("Hz", f.hertz), ("rad/s", f.radians_per_second), ("rad", f.angle)];
        let bounds = |e: jurist_algebra::number::Enclosure| [e.lower().clone(), e.upper().clone()];
        named.into_iter().filter_map(|(unit, e)| Some((unit, bounds(e?)))).collect()
    });
    FoundEnd {
        exact: end.value.exact(),
        enclosure: [low, high],
        polynomial: end.value.algebraic().map_or_else(UniPoly::zero, |x| x.polynomial().clone()),
        causes: Some(end.causes.to_string()),
        frequencies: Some(frequencies),
    }
}

#[test]
fn the_library_answers_as_expected() {
    ask_all(4, |case, expectation| expectation.answer.compare(&found(case, expectation)?));
}

/// Everything that an expectation says counts: each changed in one place is no longer met.
#[test]
#[ignore = "long: CI runs it"]
fn broken_expectations_are_not_met() {
    let mut broken = 0;
    for case in cases() {
        for expectation in &case.expectations {
            let found = found(&case, expectation).unwrap();
            for (what, changed) in changes(&expectation.answer) {
                assert!(changed.compare(&found).is_err(), "{}: {what} of {changed:?}", case.name);
                broken += 1;
            }
        }
    }
    assert!(broken > 500, "{broken}");
}

/// The expectation, wrong in one place.
fn changes(answer: &Expected) -> Vec<(&'static str, Expected)> {
    let mut out = Vec::new();
    match answer {
        Expected::Verdict { verdict, roots } => {
            let other = if verdict == "stable" { "unstable" } else { "stable" };
            out.push(("verdict", Expected::Verdict { verdict: other.to_owned(), roots: roots.clone() }));
            if let Some(roots) = roots {
                let roots = if roots.is_empty() { "1 inside".to_owned() } else { format!("{roots}, 7 infinite") };
                out.push(("roots", Expected::Verdict { verdict: verdict.clone(), roots: Some(roots) }));
            }
        }
        Expected::Stable(intervals) => {
            let whole = [ExpectedEnd::Infinite, ExpectedEnd::Infinite];
            let more = [&intervals[..], &[whole]].concat();
            out.push(("an interval", Expected::Stable(more)));
            for (i, interval) in intervals.iter().enumerate() {
                let mut fewer = intervals.clone();
                fewer.remove(i);
                out.push(("no interval", Expected::Stable(fewer)));
                for (side, end) in interval.iter().enumerate() {
                    for (what, end) in changed_ends(end) {
                        let mut changed = intervals.clone();
                        changed[i][side] = end;
                        out.push((what, Expected::Stable(changed)));
                    }
                }
            }
        }
    }
    out
}

fn changed_ends(end: &ExpectedEnd) -> Vec<(&'static str, ExpectedEnd)> {
    let ExpectedEnd::Finite { value, causes, frequency } = end else {
        let value = ExpectedValue::Exact(number("0"));
        return vec![("an end", ExpectedEnd::Finite { value, causes: "domain".into(), frequency: None })];
    };
    let with = |value: &ExpectedValue, causes: &str, frequency: &Option<(String, String)>| ExpectedEnd::Finite {
        value: value.clone(),
        causes: causes.to_owned(),
        frequency: frequency.clone(),
    };
    let mut out =
        vec![("no end", ExpectedEnd::Infinite), ("causes", with(value, &format!("{causes}+domain"), frequency))];
    let wrong = match value {
        ExpectedValue::Exact(value) => ExpectedValue::Exact(value + &number("1e-600")),
        ExpectedValue::Root { digits, polynomial } => {
            ExpectedValue::Root { digits: with_other_last_digit(digits), polynomial: polynomial.clone() }
        }
    };
    out.push(("value", with(&wrong, causes, frequency)));
    if let ExpectedValue::Root { digits, polynomial: Some(p) } = value {
        let p = p - &jurist_algebra::poly::UniPoly::constant(1.into());
        let wrong = ExpectedValue::Root { digits: digits.clone(), polynomial: Some(p) };
        out.push(("polynomial", with(&wrong, causes, frequency)));
    }
    if let Some((digits, unit)) = frequency {
        out.push(("frequency", with(value, causes, &Some((with_other_last_digit(digits), unit.clone())))));
    }
    out
}

/// Two units further or nearer in the last place.
fn with_other_last_digit(digits: &str) -> String {
    let (rest, last) = digits.split_at(digits.len() - 1);
    let last: u8 = last.parse().expect("a digit");
    format!("{rest}{}", if last < 5 { last + 2 } else { last - 2 })
}
