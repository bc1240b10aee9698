//! Certificates of the answer about one parameter: exact ones, and boxes where there are none.

use super::boxes::{Boxes, judge, precision};
use super::for_all::Asked;
use super::search::Search;
use crate::Certificate;
use crate::ForAllClaim;
use crate::boxes_certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number, to_scientific};
use jurist_algebra::real::Real;
use jurist_engine::answer::Answer;
use jurist_engine::problem::{Ask, Problem};
use jurist_engine::response::{AllOf, RequiredEnd, RequiredSet, Requirement};
use jurist_model::error::{Code, Error};
use jurist_stability::plane::boxes::{BoxVerdict, PlaneBox, Window};
use jurist_stability::{End, StableSet, UndecidedBracket};
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

/// The same where requirements are asked, which take a box of factors for each piece.
const LEFT_BITS_OF_REQUIREMENTS: u64 = 20;

/// Longer exact certificates are as boxes, where these prove nearly as much: polynomials over the constants of holds grow fast. The slower checker
/// takes two seconds for a megabyte, and two masses with a notch filter behind a hold have one of 4 MB.
const MOST_EXACT_BYTES: usize = 1 << 22;

/// Boxes take the place of an exact certificate where they leave no larger share of their window unknown, as a power of two.
const UNKNOWN_BITS: u64 = 10;

/// A certificate of the answer about one parameter, and how much it says.
///
/// ```
/// use jurist_prove::certified::certify_intervals;
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited())?;
/// assert!(certify_intervals(&answer, &Budget::unlimited())?.window.is_none(), "an exact one");
/// # Ok::<(), jurist_model::error::Error>(())
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
/// Cost: that of [`Certificate::certificate`](crate::Certificate::certificate), else that of [`certify_boxes`](crate::certified::certify_boxes) for some dozen boxes at each end.
///
/// ```
/// use jurist_prove::certified::certify_intervals;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// let text = std::fs::read_to_string("../../examples/dc-servo.toml").unwrap();
/// let (model, _) = Model::from_toml(&Source::new("dc-servo.toml", &text))?;
/// let answer = model.ask().free("T").stable_set(&Budget::unlimited())?;
/// let certified = certify_intervals(&answer, &Budget::unlimited())?;
/// assert!(certified.proved > "999/1000".parse().unwrap());
/// assert_eq!(check(&text, &certified.text, &Limits::default()).unwrap().kind, "boxes");
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where there is neither.
pub fn certify_intervals(answer: &Answer<StableSet>, budget: &Budget) -> Result<CertifiedIntervals, Error> {
    certified_within(answer, MOST_EXACT_BYTES, budget)
}

/// The same with an exact certificate of at most so many bytes, unless boxes leave much unknown.
fn certified_within(
    answer: &Answer<StableSet>,
    most_bytes: usize,
    budget: &Budget,
) -> Result<CertifiedIntervals, Error> {
    match answer.certificate(budget) {
        Ok(text) => {
            let is_long = text.len() > most_bytes && answer.problem().model().is_read_by_boxes();
            let boxes = if is_long { shorter(answer, text.len(), budget)? } else { None };
            Ok(boxes.unwrap_or(CertifiedIntervals { text, window: None, proved: Rational::ONE }))
        }
        // Of an orbit's duty ratio the checkers read no boxes.
        Err(Error::Refused(why))
            if why.code() == Code::NoCertificate && answer.problem().model().is_read_by_boxes() =>
        {
            by_boxes(answer, budget)?.ok_or(Error::Refused(why))
        }
        Err(other) => Err(other),
    }
}

/// The part of the budget that a shorter certificate may take where an exact one is there.
const SHORTER: (u32, u32) = (1, 2);

/// By boxes, where that is shorter than so many bytes and leaves little unknown; `None` also where the work of it ends, as the exact one is there.
fn shorter(answer: &Answer<StableSet>, bytes: usize, budget: &Budget) -> Result<Option<CertifiedIntervals>, Error> {
    let least = &Rational::ONE - &Rational::dyadic(&1.into(), UNKNOWN_BITS);
    let part = budget.share(SHORTER.0, SHORTER.1);
    match part.enter(|| by_boxes(answer, &part)).unwrap_or_else(|stopped| Err(stopped.into())) {
        Ok(found) => Ok(found.filter(|found| found.text.len() < bytes && found.proved >= least)),
        Err(Error::Refused(_) | Error::Stopped(_)) => Ok(None),
        Err(other) => Err(other),
    }
}

/// By boxes; `None` where the checkers do not read the model so either, or nothing is seen of it.
fn by_boxes(answer: &Answer<StableSet>, budget: &Budget) -> Result<Option<CertifiedIntervals>, Error> {
    budget.step("certificate");
    let problem = answer.problem();
    let set = LineSet::from(answer.value());
    let ends = window(problem, &set);
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
        // The parameter is the only name that has a value.
        return match by_pieces(problem, (&set, ends), ForAllClaim::new(Vec::new(), Vec::new()), LEFT_BITS, budget) {
            Ok(found) => Ok(Some(found).filter(|found| !found.proved.is_zero())),
            Err(Error::Refused(_)) => Ok(None),
            Err(other) => Err(other),
        };
    };
    let pieces = set.pieces(&ends);
    let goal = Rational::dyadic(&1.into(), LEFT_BITS);
    let (order, bits) = precision(&plane, budget)?;
    let judge = Boxes { judge: &judge, is_line: true };
    let search = Search::new(&pieces, &over(ends.clone()), goal, &judge);
    let (tree, [stable, unstable]) = search.tree(problem.model().source().text.len(), MOST_WORK, budget);
    let proved = &stable + &unstable;
    if proved.is_zero() {
        return Ok(None);
    }
    let text = boxes_certificate(&plane, &window, &tree, order, bits)?;
    Ok(Some(CertifiedIntervals { text, window: Some(ends), proved }))
}

/// A certificate of the set of values of one parameter for which the loop is stable and meets requirements: pieces of a window that contains the finite ends.
///
/// Cost: that of [`certify_requirements`](crate::certified::certify_requirements) for some dozen pieces at each end.
///
/// ```
/// use jurist_prove::certified::certify_required_intervals;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::Requirement;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// let text = "time = 'continuous'\nparameters.K = 1\nloop = { inputs = ['r'], outputs = ['y'] }\n\
///     [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(s + 1))'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let (requirement, budget) = ([Requirement::phase_margin(&45.into())?], Budget::unlimited());
/// let answer = model.ask().free("K").problem()?.required_set(&requirement, None, &budget)?;
/// let certified = certify_required_intervals(&answer, &requirement, None, &budget)?;
/// assert!(certified.proved > "99/100".parse().unwrap());
/// let proved = check(text, &certified.text, &Limits::default()).unwrap();
/// assert!(proved.statement.contains("45 degrees"));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) for what the checkers do not read; [`Error::Stopped`] when the budget runs out.
pub fn certify_required_intervals(
    answer: &Answer<RequiredSet>,
    requirements: &[Requirement],
    at: Option<&str>,
    budget: &Budget,
) -> Result<CertifiedIntervals, Error> {
    budget.step("certificate");
    let (problem, set) = (answer.problem(), LineSet::from(answer.value()));
    let domain = &problem.parameter().domain;
    let ends = match (&domain.lower, &domain.upper) {
        (Some(low), Some(high)) => [low.clone(), high.clone()],
        _ if answer.value().for_all.is_empty() => window(problem, &set),
        _ => looked_at(problem, &set),
    };
    let claim = ForAllClaim::new(Vec::new(), answer.value().for_all.clone())
        .with_requirements(requirements.to_vec(), at.map(str::to_owned));
    by_pieces(problem, (&set, ends), claim, LEFT_BITS_OF_REQUIREMENTS, budget)
}

/// That a claim holds, or does not, for the parameter in pieces of a window.
fn by_pieces(
    problem: &Problem,
    (set, ends): (&LineSet<'_>, [Rational; 2]),
    mut claim: ForAllClaim,
    left: u64,
    budget: &Budget,
) -> Result<CertifiedIntervals, Error> {
    let axis = AllOf::new(&problem.parameter().name, ends[0].clone(), ends[1].clone());
    claim.axes = vec![axis.expect("a window is not empty")];
    let (boxes, window) = (set.pieces(&ends), over(ends.clone()));
    let goal = Rational::dyadic(&1.into(), left);
    let asked = Asked { problem, claim: &claim, boxes: &boxes, window: &window, goal, most_work: MOST_WORK };
    let (text, [good, not]) = asked.certified(budget)?;
    Ok(CertifiedIntervals { text, window: Some(ends), proved: good + not })
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

/// A set of values as intervals between real numbers.
struct LineSet<'a> {
    intervals: Vec<[Option<Real>; 2]>,
    undecided: &'a [UndecidedBracket],
}

impl<'a> From<&'a StableSet> for LineSet<'a> {
    fn from(set: &'a StableSet) -> Self {
        let value = |end: &Option<End>| end.as_ref().map(|end| end.value.clone());
        let intervals = set.intervals().iter().map(|i| [value(&i.lower), value(&i.upper)]).collect();
        LineSet { intervals, undecided: set.undecided() }
    }
}

impl<'a> From<&'a RequiredSet> for LineSet<'a> {
    fn from(set: &'a RequiredSet) -> Self {
        let value = |end: &Option<RequiredEnd>| end.as_ref().map(RequiredEnd::value);
        let intervals = set.intervals.iter().map(|i| [value(&i.lower), value(&i.upper)]).collect();
        LineSet { intervals, undecided: &set.undecided }
    }
}

impl LineSet<'_> {
    /// The pieces of a window that are in the set, or beside it, or at an end.
    fn pieces(&self, window: &[Rational; 2]) -> Vec<PlaneBox> {
        let mut pieces = Vec::new();
        cut(self, window.clone(), 0, &mut |x, verdict| pieces.push(PlaneBox { window: over(x), verdict }));
        pieces
    }
}

/// Pieces of a line as boxes: the second side has a width here alone.
fn over(x: [Rational; 2]) -> Window {
    Window { x, y: [Rational::ZERO, Rational::ONE] }
}

/// A window with all finite ends of the set inside, as far as the domain goes.
fn window(problem: &Problem, set: &LineSet<'_>) -> [Rational; 2] {
    let (domain, nominal) = (&problem.parameter().domain, &problem.parameter().nominal);
    // Where nothing is known any more there is no end.
    let is_end = |x: &Rational| {
        let near = |y: &Option<Rational>| y.as_ref().is_some_and(|y| (x - y).abs() <= &x.abs() * &number(1, 1 << 20));
        !set.undecided.iter().any(|b| b.lower.is_none() && near(&b.upper) || b.upper.is_none() && near(&b.lower))
    };
    let ends = set.intervals.iter().flatten().flatten();
    let ends = ends.map(|end| end.refined_to_digits(4).enclosure().1).filter(is_end).map(|x| x.abs());
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

/// The window of a set that says how far it was looked for; where it says so of no end, one that contains the finite ends.
fn looked_at(problem: &Problem, set: &LineSet<'_>) -> [Rational; 2] {
    let domain = &problem.parameter().domain;
    let [low, high] = window(problem, set);
    let below = set.undecided.iter().find(|b| b.lower.is_none()).and_then(|b| b.upper.clone());
    let above = set.undecided.iter().find(|b| b.upper.is_none()).and_then(|b| b.lower.clone());
    let ends =
        [below.or_else(|| domain.lower.clone()).unwrap_or(low), above.or_else(|| domain.upper.clone()).unwrap_or(high)];
    if ends[0] < ends[1] { ends } else { window(problem, set) }
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
fn cut(set: &LineSet<'_>, x: [Rational; 2], halvings: usize, put: &mut impl FnMut([Rational; 2], BoxVerdict)) {
    let [low, high] = &x;
    let is_before = |x: &Rational, end: &Option<Real>| end.as_ref().is_none_or(|end| end.compare_rational(x).is_gt());
    let is_behind = |x: &Rational, end: &Option<Real>| end.as_ref().is_none_or(|end| end.compare_rational(x).is_lt());
    let is_inside = |[lower, upper]: &[Option<Real>; 2]| is_behind(low, lower) && is_before(high, upper);
    let is_outside = |[lower, upper]: &[Option<Real>; 2]| {
        lower.is_some() && is_before(high, lower) || upper.is_some() && is_behind(low, upper)
    };
    let is_known = set.undecided.iter().all(|b| {
        b.lower.as_ref().is_some_and(|lower| high < lower) || b.upper.as_ref().is_some_and(|upper| low > upper)
    });
    if is_known && set.intervals.iter().any(is_inside) {
        return put(x, BoxVerdict::Stable);
    }
    if is_known && set.intervals.iter().all(is_outside) {
        return put(x, BoxVerdict::Unstable { outside: None });
    }
    let is_unknown = set.undecided.iter().any(|b| {
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

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_check::{Limits, check};
    use jurist_model::Model;
    use jurist_model::error::Source;

    /// An exact certificate over the constants of a hold was written however long it was, and the slower checker did not take it.
    #[test]
    fn a_long_exact_certificate_is_one_by_boxes() {
        let text = "time = 'discrete'\nsample_time = '1/4'\nparameters = { K = { nominal = 1, min = 0 }, a = 1 }\n\
            loop = { inputs = ['r'], outputs = ['y'] }\n[[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n[[block]]\n\
            input = 'u'\noutput = 'y'\ntransfer = '1/(s + a)'\ndiscretize = 'zoh'\n";
        let (model, _) = Model::from_toml(&Source::new("loop.toml", text)).unwrap();
        let budget = Budget::unlimited();
        let answer = model.ask().free("K").stable_set(&budget).unwrap();
        for (most, kind) in [(MOST_EXACT_BYTES, "intervals"), (100, "boxes")] {
            let certified = certified_within(&answer, most, &budget).unwrap();
            let proved = check(text, &certified.text, &Limits::default()).unwrap();
            assert_eq!((proved.kind, certified.window.is_some()), (kind, kind == "boxes"));
            assert!(certified.proved > number(999, 1000), "{certified:?}");
        }
    }
}
