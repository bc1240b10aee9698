//! Certificates of the answer about one parameter: exact ones, and boxes where there are none.

use super::boxes::{Boxes, judge, precision};
use super::search::Search;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number, to_scientific};
use jurist_engine::answer::Answer;
use jurist_engine::error::{Code, Error};
use jurist_engine::problem::Problem;
use jurist_engine::stability::plane::boxes::{BoxVerdict, PlaneBox, Window};
use jurist_engine::stability::{StableInterval, StableSet};
use std::sync::Arc;

/// Pieces at an end of a stable interval are this power of two shorter than the end is far from zero.
const END_BITS: u64 = 24;

/// Pieces at zero are this power of two shorter than the window.
const ZERO_BITS: usize = 24;

/// So many other names are tried: one that is inside of a dead time, or of a frequency, will not do.
const MOST_OTHERS: usize = 12;

/// Pieces are not halved more often, whatever the ends are: the checkers read trees of some depth only.
const MOST_HALVINGS: usize = 100;

/// More work is not done, counted by the judge: of that the slower checker does most again.
const MOST_WORK: u64 = 15_000_000_000;

/// The window reaches so many times as far as the farthest end, or the nominal value.
const BEYOND: i64 = 2;

/// The share of the window that may stay unknown, as a power of two: what lies at the ends decides.
const LEFT_BITS: u64 = 48;

/// A certificate of the answer about one parameter, and how much it says.
///
/// ```
/// use jurist::{Budget, Model, certify_intervals};
/// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited())?;
/// assert!(certify_intervals(&answer, &Budget::unlimited())?.window.is_none(), "an exact one");
/// # Ok::<(), jurist::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CertifiedIntervals {
    /// The certificate.
    pub text: String,
    /// Where it speaks of a window of the parameter only, the ends of that; `None` where it says for all values whether the loop is stable.
    pub window: Option<[Rational; 2]>,
    /// The share of the window that is proved stable, or not: 1 without a window.
    pub proved: Rational,
}

/// A certificate of the set of values of one parameter for which the loop is stable.
///
/// Where there is no exact one, as where the parameter is inside of functions (a sample time, a constant of a plant behind a hold), a window that
/// contains the finite ends is cut into boxes as that of a map; the certificate then leaves short pieces at the ends unknown.
///
/// Cost: that of [`Answer::certificate`], else that of [`certify_boxes`](crate::certify_boxes) for some dozen boxes at each end.
///
/// ```standalone_crate
/// use jurist::{Budget, Limits, Model, Source, certify_intervals, check};
/// let text = std::fs::read_to_string("examples/dc-servo.toml").unwrap();
/// let (model, _) = Model::from_toml(&Source::new("dc-servo.toml", &text))?;
/// let answer = model.ask().free("T").stable_set(&Budget::unlimited())?;
/// let certified = certify_intervals(&answer, &Budget::unlimited())?;
/// assert!(certified.proved > "999/1000".parse().unwrap());
/// assert_eq!(check(&text, &certified.text, &Limits::default()).unwrap().kind, "boxes");
/// # Ok::<(), jurist::Error>(())
/// ```
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where there is neither.
pub fn certify_intervals(answer: &Answer<StableSet>, budget: &Budget) -> Result<CertifiedIntervals, Error> {
    match answer.certificate(budget) {
        Ok(text) => Ok(CertifiedIntervals { text, window: None, proved: Rational::ONE }),
        // Of an orbit's duty ratio the checkers read no boxes.
        Err(Error::Refused(why))
            if why.code() == Code::NoCertificate && answer.problem().model().is_read_by_boxes() =>
        {
            by_boxes(answer, budget)?.ok_or(Error::Refused(why))
        }
        Err(other) => Err(other),
    }
}

/// By boxes; `None` where the checkers do not read the model so either, or nothing is seen of it.
fn by_boxes(answer: &Answer<StableSet>, budget: &Budget) -> Result<Option<CertifiedIntervals>, Error> {
    budget.step("certificate");
    let problem = answer.problem();
    let ends = window(problem, answer.value());
    let beside = |(name, value): (String, Rational)| {
        let window = Window { x: ends.clone(), y: [value.clone(), value] };
        let judged = beside_another(problem, &name).and_then(|plane| {
            let judge = judge(&plane, &window, budget)?;
            Ok((plane, window, judge))
        });
        match judged {
            Ok(found) => Some(Ok(found)),
            Err(Error::Refused(_)) => None,
            Err(other) => Some(Err(other)),
        }
    };
    let Some((plane, window, judge)) = others(problem).into_iter().take(MOST_OTHERS).find_map(beside).transpose()?
    else {
        return Ok(None);
    };
    // The second side has a width here alone.
    let over = |x: [Rational; 2]| Window { x, y: [Rational::ZERO, Rational::ONE] };
    let mut pieces = Vec::new();
    cut(answer.value(), ends.clone(), 0, &mut |x, verdict| pieces.push(PlaneBox { window: over(x), verdict }));
    let goal = Rational::dyadic(&1.into(), LEFT_BITS);
    let (order, bits) = precision(&plane, budget)?;
    let judge = Boxes { judge: &judge, is_line: true };
    let search = Search::new(&pieces, &over(ends.clone()), goal, &judge);
    let (tree, [stable, unstable]) = search.tree(problem.model().source().text.len(), MOST_WORK, budget);
    let proved = &stable + &unstable;
    if proved.is_zero() {
        return Ok(None);
    }
    let text = plane.boxes_certificate(&window, &tree, order, bits)?;
    Ok(Some(CertifiedIntervals { text, window: Some(ends), proved }))
}

/// The other parameters and constants that have values; none where the bound of the region is in question.
fn others(problem: &Problem) -> Vec<(String, Rational)> {
    let [free] = problem.free() else { return Vec::new() };
    if problem.region().is_free() {
        return Vec::new();
    }
    let model = problem.model();
    let set = |name: &str| problem.set().iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
    let parameters = model.parameters().iter().map(|p| (&p.name, set(&p.name)));
    let constants = model.constants().iter().map(|c| (&c.name, set(&c.name).or_else(|| c.number.clone())));
    let others = parameters.chain(constants).filter(|(name, _)| **name != free.name);
    others.filter_map(|(name, value)| Some((name.clone(), value?))).collect()
}

/// The problem with another name free as well.
fn beside_another(problem: &Problem, other: &str) -> Result<Arc<Problem>, Error> {
    let question = problem.model().ask().within(problem.region().clone()).free(&problem.parameter().name).free(other);
    let rest = problem.set().iter().filter(|(name, _)| name != other);
    rest.fold(question, |question, (name, value)| question.set(name, value.clone())).problem()
}

/// A window with all finite ends of the stable set inside, as far as the domain goes.
fn window(problem: &Problem, set: &StableSet) -> [Rational; 2] {
    let (domain, nominal) = (&problem.parameter().domain, &problem.parameter().nominal);
    // Where nothing is known any more there is no end.
    let is_end = |x: &Rational| {
        let near = |y: &Option<Rational>| y.as_ref().is_some_and(|y| (x - y).abs() <= &x.abs() * &number(1, 1 << 20));
        !set.undecided().iter().any(|b| b.lower.is_none() && near(&b.upper) || b.upper.is_none() && near(&b.lower))
    };
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    let ends = ends.map(|end| end.value.refined_to_digits(4).enclosure().1).filter(is_end).map(|x| x.abs());
    let far = ends.max().filter(|far| !far.is_zero()).map(|far| &far * &Rational::from(BEYOND));
    let around = nominal.iter().map(|x| &x.abs() * &Rational::from(BEYOND)).max().filter(|far| !far.is_zero());
    let far = round_up(&far.max(around).unwrap_or(Rational::ONE));
    let low = domain.lower.clone().map_or_else(|| -&far, |low| low.max(-&far));
    let high = domain.upper.clone().map_or_else(|| far.clone(), |high| high.min(far.clone()));
    match low < high {
        true => [low, high],
        // A domain that is farther away than everything known.
        false => match (&domain.lower, &domain.upper) {
            (Some(low), None) => [low.clone(), low + &(&low.abs() + &Rational::ONE)],
            (None, Some(high)) => [high - &(&high.abs() + &Rational::ONE), high.clone()],
            (Some(low), Some(high)) => [low.clone(), high.clone()],
            (None, None) => [-&far, far],
        },
    }
}

/// A number with two digits, not below this positive one: what is added is more than what rounding takes off.
fn round_up(x: &Rational) -> Rational {
    let rounded = to_scientific(&(x + &(x * &number(1, 10))), 2);
    parse_number(&rounded).expect("a number that was written")
}

fn number(n: i64, d: i64) -> Rational {
    Rational::new(n.into(), d.into())
}

/// Halves a range until each piece is in a stable interval, or beside all, or short and at an end.
fn cut(set: &StableSet, x: [Rational; 2], halvings: usize, put: &mut impl FnMut([Rational; 2], BoxVerdict)) {
    let [low, high] = &x;
    let is_before = |x: &Rational, end: &Option<jurist_engine::stability::End>| {
        end.as_ref().is_none_or(|end| end.value.compare_rational(x).is_gt())
    };
    let is_behind = |x: &Rational, end: &Option<jurist_engine::stability::End>| {
        end.as_ref().is_none_or(|end| end.value.compare_rational(x).is_lt())
    };
    let is_inside = |i: &StableInterval| is_behind(low, &i.lower) && is_before(high, &i.upper);
    let is_outside = |i: &StableInterval| {
        i.lower.is_some() && is_before(high, &i.lower) || i.upper.is_some() && is_behind(low, &i.upper)
    };
    let is_known = set.undecided().iter().all(|b| {
        b.lower.as_ref().is_some_and(|lower| high < lower) || b.upper.as_ref().is_some_and(|upper| low > upper)
    });
    if is_known && set.intervals().iter().any(is_inside) {
        return put(x, BoxVerdict::Stable);
    }
    if is_known && set.intervals().iter().all(is_outside) {
        return put(x, BoxVerdict::Unstable { outside: None });
    }
    let is_unknown = set.undecided().iter().any(|b| {
        b.lower.as_ref().is_none_or(|lower| lower <= low) && b.upper.as_ref().is_none_or(|upper| high <= upper)
    });
    let far = low.abs().max(high.abs());
    let is_short = high - low <= &far * &Rational::dyadic(&1.into(), END_BITS);
    let is_at_zero = halvings >= ZERO_BITS && !low.sign().is_gt() && !high.is_negative();
    if is_unknown || is_short || is_at_zero || halvings >= MOST_HALVINGS {
        return put(x, BoxVerdict::Undecided);
    }
    let middle = low.midpoint(high);
    cut(set, [low.clone(), middle.clone()], halvings + 1, put);
    cut(set, [middle, high.clone()], halvings + 1, put);
}
