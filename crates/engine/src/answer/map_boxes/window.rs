//! What boxes are to cover.

use super::BoxRequest;
use crate::answer::Verdict;
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Ask, Problem};
use crate::stability::Range;
use crate::stability::plane::boxes::Window;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// A window that nobody asked for is doubled so often at most, to show where the loop becomes unstable.
const DOUBLINGS: u32 = 5;

/// [`window_of`], where there is nothing but boxes: a side without an end reaches as far from the nominal value as the other end, or 0, or
/// one, and upwards twice as far and so on until the loop is unstable there while all else is nominal, where it ever is.
///
/// Cost: a few verdicts.
///
/// # Errors
/// As [`window_of`], and [`Error::Stopped`] when the budget runs out.
pub(super) fn window_around(question: &Problem, request: &BoxRequest, budget: &Budget) -> Result<Window, Error> {
    let mut wanted = request.clone();
    for (k, (range, axis)) in wanted.windows.iter_mut().zip(question.free()).enumerate() {
        let lower = range.lower.clone().max(axis.domain.lower.clone());
        let upper = range.upper.iter().chain(&axis.domain.upper).min().cloned();
        let Some(nominal) = &axis.nominal else { continue };
        // Where an end leaves the nominal value outside, that end takes its place.
        let (above, below) = (lower.as_ref().filter(|end| *end > nominal), upper.as_ref().filter(|end| *end < nominal));
        let from = above.or(below).unwrap_or(nominal).clone();
        let reach = match (&lower, &upper) {
            (Some(lower), None) if *lower < from => &from - lower,
            (None, Some(upper)) if *upper > from => upper - &from,
            _ => from.abs(),
        };
        let reach = if reach.sign().is_gt() { reach } else { Rational::ONE };
        range.lower = Some(lower.unwrap_or_else(|| &from - &reach));
        range.upper = Some(match upper {
            Some(upper) => upper,
            None => &from + reach_of_stability(question, k, &from, reach, budget)?,
        });
    }
    window_of(question, &wanted)
}

/// How far a window is to reach from a value of an axis.
fn reach_of_stability(
    question: &Problem,
    axis: usize,
    from: &Rational,
    least: Rational,
    budget: &Budget,
) -> Result<Rational, Exhausted> {
    let Some(nominal) = question.free().iter().map(|free| free.nominal.clone()).collect::<Option<Vec<_>>>() else {
        return Ok(least);
    };
    let is_stable = |reach: &Rational| {
        let mut point = nominal.clone();
        point[axis] = from + reach;
        let names = question.free().iter().map(|free| free.name.clone());
        let asked = question.model().ask().within(question.region().clone()).set_all(question.set().to_vec());
        match asked.set_all(names.zip(point)).verdict(budget) {
            Ok(answer) => Ok(answer.value().verdict == Verdict::Stable),
            Err(Error::Stopped(_)) => budget.check().map(|()| false),
            Err(_) => Ok(false),
        }
    };
    if !is_stable(&Rational::ZERO)? {
        return Ok(least);
    }
    let mut reach = least.clone();
    for _ in 0..=DOUBLINGS {
        if !is_stable(&reach)? {
            return Ok(reach);
        }
        reach = &reach + &reach;
    }
    Ok(least)
}

/// The part of the domain that the boxes are to cover.
pub(super) fn window_of(question: &Problem, request: &BoxRequest) -> Result<Window, Error> {
    let side = |k: usize| {
        let (domain, wanted) = (&question.free()[k].domain, &request.windows[k]);
        let lower = wanted.lower.clone().max(domain.lower.clone());
        let upper = match (&wanted.upper, &domain.upper) {
            (Some(a), Some(b)) => Some(a.min(b).clone()),
            (a, b) => a.clone().or_else(|| b.clone()),
        };
        Range::between(lower, upper)
    };
    let sides = [side(0), side(1)];
    for (range, axis) in sides.iter().zip(question.free()) {
        if range.lower.is_none() || range.upper.is_none() {
            return Err(Diagnostic::error(
                Code::Usage,
                format!("boxes need a window of '{}' with two ends", axis.name),
            )
            .help(format!("say which values are to be covered, such as '-x {}=0..1'", axis.name))
            .into());
        }
        if range.is_empty() {
            return Err(Diagnostic::error(
                Code::EmptyDomain,
                format!("the window of '{}' is outside its domain", axis.name),
            )
            .help("boxes cover the part of the window that is in the domain")
            .into());
        }
    }
    Ok(Window::new(&sides[0], &sides[1]).expect("both sides are bounded and not empty"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, ParameterBuilder, Time};

    fn question(characteristic: &str, parameters: &[(&str, &str)]) -> std::sync::Arc<Problem> {
        let builder = parameters.iter().fold(Model::builder(Time::Continuous), |builder, (name, nominal)| {
            builder.parameter(ParameterBuilder::new(name).nominal(nominal))
        });
        let (model, _) = builder.characteristic(characteristic).build().unwrap();
        parameters.iter().fold(model.ask(), |ask, (name, _)| ask.free(*name)).plane_problem().unwrap()
    }

    fn window(question: &Problem, wanted: [Range; 2]) -> Window {
        window_around(question, &BoxRequest::new(wanted, Rational::ONE), &Budget::unlimited()).unwrap()
    }

    /// `s + K exp(-theta s)` is stable for `0 < K theta < pi/2`.
    #[test]
    fn windows_show_where_the_loop_becomes_unstable() {
        let n = |n: i64| Rational::from(n);
        let loop_with = |gain, delay| question("s + K*exp(-theta*s)", &[("K", gain), ("theta", delay)]);
        let slow = loop_with("1/2", "1/5");
        let Window { x, y } = window(&slow, [Range::all(), Range::all()]);
        // 0.5 + 8 is the first of 1, 1.5, 2.5, ... beyond 7.85, and 0.2 + 3.2 that of 0.4, 0.6, ... beyond 3.14.
        assert_eq!((x.as_slice(), &y[1]), ([n(0), "17/2".parse().unwrap()].as_slice(), &"17/5".parse().unwrap()));
        // What is asked for is kept, and so is what nothing is seen beyond.
        let asked = Range::between(Some(n(0)), Some(n(1)));
        let Window { x, y } = window(&slow, [asked, Range::between(None, Some(n(2)))]);
        assert_eq!((&x[1], &y[1]), (&n(1), &n(2)));
        let never = window(&loop_with("1/1000", "1/1000"), [Range::all(), Range::all()]);
        assert_eq!(never.x[1], "1/500".parse().unwrap());
        let unstable = window(&loop_with("2", "1"), [Range::all(), Range::all()]);
        assert_eq!((&unstable.x[1], &unstable.y[1]), (&n(4), &n(2)));
    }

    /// `s + c K exp(-theta s)`: with `theta = 1/5` and `c = 1` stable for `0 < K < 7.85...`.
    fn asked(parameters: &str, set: &[(&str, i64)], decay: i64, wanted: Range) -> Result<[Rational; 2], Error> {
        let text = format!(
            "time = 'continuous'\nparameters = {{ {parameters}, theta = {{ nominal = '1/5' }}, c = {{ nominal = 1 }} }}\n\
             loop.characteristic = 's + c*K*exp(-theta*s)'"
        );
        let (model, _) = Model::from_toml(&crate::error::Source::new("model.toml", &text)).unwrap();
        let set = set.iter().map(|(name, value)| ((*name).to_owned(), Rational::from(*value)));
        let asked = model.ask().set_all(set).within(crate::problem::Region::half_plane(decay.into()));
        let problem = asked.free("K").free("theta").plane_problem().unwrap();
        let request = BoxRequest::new([wanted, Range::between(None, Some(Rational::ONE))], Rational::ONE);
        window_around(&problem, &request, &Budget::unlimited()).map(|window| window.x)
    }

    #[test]
    fn windows_keep_to_the_domain_and_reach_as_far_up_as_down() {
        let n = |text: &str| text.parse::<Rational>().unwrap();
        let range = |low: Option<&str>, high: Option<&str>| Range::between(low.map(n), high.map(n));
        let bounded = "K = { nominal = 1, min = '1/2', max = 3 }";
        let free = "K = { nominal = 1 }";
        for (parameters, set, decay, wanted, x) in [
            (bounded, 1, 0, Range::all(), ["1/2", "3"]),
            (bounded, 1, 0, range(Some("-1"), Some("10")), ["1/2", "3"]),
            (bounded, 1, 0, range(Some("2/3"), Some("2")), ["2/3", "2"]),
            // Twice as far until 9 is beyond.
            (free, 1, 0, Range::all(), ["0", "9"]),
            ("K = { nominal = 1, min = -2 }", 1, 0, Range::all(), ["-2", "13"]),
            (free, 1, 0, range(None, Some("3")), ["-1", "3"]),
            // The nominal value is outside of what is asked for.
            (free, 1, 0, range(Some("3"), None), ["3", "9"]),
            (free, 1, 0, range(None, Some("-3")), ["-6", "-3"]),
            (free, 1, 0, range(None, Some("0")), ["-1", "0"]),
            (free, 1, 0, range(Some("-2"), None), ["-2", "13"]),
            (free, 1, 0, range(Some("2"), None), ["2", "10"]),
            // The values and the region that are asked for: limits at 3.9 and 4.4.
            (free, 2, 0, Range::all(), ["0", "5"]),
            ("K = { nominal = '3/2' }", 1, 0, Range::all(), ["0", "27/2"]),
            ("K = { nominal = '3/2' }", 1, 2, Range::all(), ["0", "9/2"]),
            // The last doubling finds it.
            ("K = { nominal = '1/4' }", 1, 0, Range::all(), ["0", "33/4"]),
            // A nominal point that is not stable is in the middle.
            ("K = { nominal = -1 }", 1, 0, Range::all(), ["-2", "0"]),
        ] {
            let found = asked(parameters, &[("c", set)], decay, wanted.clone()).unwrap();
            assert_eq!(found, x.map(n), "{parameters} {set} {decay} {wanted:?}");
        }
        for empty in [range(Some("5"), Some("6")), range(Some("0"), Some("1/4"))] {
            match asked(bounded, &[], 0, empty) {
                Err(Error::Refused(list)) => assert_eq!(list.diagnostics()[0].code, Code::EmptyDomain),
                other => panic!("{other:?}"),
            }
        }

        // The domain cuts what is asked for of any loop.
        let (model, _) = Model::from_toml(&crate::error::Source::new(
            "model.toml",
            "time = 'continuous'\nparameters = { a = { min = -1, max = 2 }, b = { min = 0 } }\nloop.characteristic = 's^2 + a*s + b'",
        ))
        .unwrap();
        let problem = model.ask().free("a").free("b").plane_problem().unwrap();
        let wanted = [range(Some("-5"), Some("5")), range(Some("-1"), Some("1"))];
        let Window { x, y } = window_of(&problem, &BoxRequest::new(wanted, Rational::ONE)).unwrap();
        assert_eq!((x, y), (["-1", "2"].map(n), ["0", "1"].map(n)));
    }
}
