//! For which values of one parameter a loop bears a dead time.
//!
//! A stable loop has a delay margin of a time at least where it is stable with all less dead time at the cut. With a parameter that begins or ceases to be so
//! where a root is on the axis with the whole time, or where a crossing of the open loop appears at once: its modulus touches one at some frequency, or in
//! the limit of high ones.

use super::RequiredSet;
use super::cells::{Unmet, beyond, inside_of, parts_beside, required_parts};
use super::loop_functions::dead_time;
use super::opened::OpenedLoop;
use super::place::modulus_squared;
use super::requirement::{Requirement, Rule};
use crate::answer::stable_set_with_dead_time;
use crate::coverage::refusals::DELAY_BESIDE;
use crate::error::Error;
use crate::problem::{Ask, DelayedLoop, Free, Problem, symbols_without};
use crate::stability::{Range, Shape, StableInterval, StableSet, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, SquareFree, UniPoly, discriminant, isolate_real_roots,
};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{SymbolicPoly, Symbols};
use std::cmp::Ordering;
use std::slice::from_ref;
use std::sync::Arc;

/// Next to an end is two to minus this of a range.
const NEXT_TO_LIMIT: u64 = 6;

/// Digits of the numbers around an end up to which the loop is asked.
const DIGITS: usize = 9;

/// A least delay margin of loops in one parameter, in continuous time.
struct BorneSet<'a> {
    problem: &'a Arc<Problem>,
    requirement: &'a Requirement,
    at: Option<&'a str>,
    /// The loop with the whole time; `None` where it is known by boxes alone.
    with_all: Option<DelayedLoop>,
    /// Where a crossing may appear at once.
    touches: Vec<Real>,
    /// Of these where the modulus of the open loop is one in the limit of high frequencies, and what is positive where it is more.
    limits: Vec<Real>,
    above: MultiPoly,
    /// What follows the parameter.
    constants: Arc<Symbols>,
    /// Where the open loop is undefined.
    undefined: Vec<Real>,
    budget: &'a Budget,
}

impl Problem {
    /// The parts of the stable set in which a delay margin is what is required.
    ///
    /// # Errors
    /// `E-dead-time` where several factors of the open loop have dead time; `E-require` beside functions of the parameter.
    pub(super) fn bearing_set(
        self: &Arc<Self>,
        requirement: &Requirement,
        stable: &StableSet,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        budget.step("boundaries of the requirements");
        if self.shape() == Shape::UnitDisc {
            return self.bearing_samples(requirement, stable, at, budget);
        }
        let set = BorneSet::of(self, requirement, at, budget)?;
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        for interval in stable.intervals() {
            set.within(interval, &mut found)?;
        }
        found.sort();
        Ok(found)
    }
}

impl<'a> BorneSet<'a> {
    fn of(
        problem: &'a Arc<Problem>,
        requirement: &'a Requirement,
        at: Option<&'a str>,
        budget: &'a Budget,
    ) -> Result<BorneSet<'a>, Error> {
        let Rule::DeadTime(least) = requirement.rule() else { unreachable!("a delay margin") };
        let opened = OpenedLoop::of(problem, requirement.cut(problem, at)?, budget)?;
        let (mut quotient, undefined) = opened.quotient(MultiPoly::clone, budget)?;
        let own = budget.enter(|| dead_time(&mut quotient, &undefined, &opened.symbols))??;
        let delays: Vec<usize> = opened.symbols.delays().iter().map(|(variable, _)| *variable).collect();
        let constants = symbols_without(&opened.symbols, &delays).ok_or_else(|| DELAY_BESIDE.diagnostic(&[]))?;
        let constants = Arc::new(constants);
        let [d, n] = [&quotient.denominator, &quotient.numerator];
        let tau = &own.unwrap_or_else(RationalFunction::zero) + &RationalFunction::from(least.clone());
        let with_all = budget.enter(|| DelayedLoop::of_factor([d, n], &tau, &undefined, &constants))??;
        let in_one = |p: &Poly<MultiPoly>| {
            p.coeffs().iter().map(|c| c.to_univariate(0)).collect::<Option<Vec<UniPoly>>>().map(Poly::new)
        };
        let Touches { above, limits, elsewhere } = match (in_one(d), in_one(n)) {
            (Some(d), Some(n)) => touches([&d, &n], budget)?.lifted(),
            _ => touches([d, n], budget)?,
        };
        let limits = zeros(&limits, &constants, budget)?;
        let touches = limits.iter().cloned().chain(zeros(&elsewhere, &constants, budget)?).collect();
        Ok(BorneSet {
            problem,
            requirement,
            at,
            with_all,
            touches,
            limits: ascending(limits.into_iter().map(|value| (value, true)).collect(), budget)?
                .into_iter()
                .map(|(value, _)| value)
                .collect(),
            above,
            undefined: zeros(from_ref(&undefined), &constants, budget)?,
            constants,
            budget,
        })
    }

    /// The parts of a stable interval in which all less dead time is borne.
    fn within(&self, interval: &StableInterval, found: &mut RequiredSet) -> Result<(), Error> {
        let Some(set) = self.stable_with_all(interval)? else { return self.in_boxes(interval, found) };
        let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().map(|end| end.value.clone());
        let mut values: Vec<(Real, bool)> = ends.map(|value| (value, false)).collect();
        values.extend(self.touches.iter().map(|value| (value.clone(), true)));
        values.extend(self.undefined.iter().map(|value| (value.clone(), false)));
        let candidates = match ascending(values, self.budget) {
            // Two values that depend on constants may be equal, and no digits show that.
            Err(stopped) if stopped.stop.is_precision() => return self.in_boxes(interval, found),
            known => known?,
        };
        let values: Vec<Real> = candidates.iter().map(|(value, _)| value.clone()).collect();
        let why = format!("where {} begins or ceases to be met", self.requirement.name());
        let open = |b: &UndecidedBracket| UndecidedBracket::new(b.lower.clone(), b.upper.clone(), why.as_str());
        let brackets = set.undecided().iter().map(open).collect();
        parts_beside(interval, brackets, found, |part| {
            let inside = inside_of(part, &values, self.budget)?;
            let is_closed = |k: usize, _: &[&'static str]| {
                let own = candidates.iter().find(|(value, _)| value.is_same(&inside[k]));
                Ok(own.is_some_and(|(_, touches)| !touches))
            };
            required_parts(part, &inside, |value| self.unmet(value), is_closed, self.budget)
        })
    }

    /// The same by boxes alone.
    fn in_boxes(&self, interval: &StableInterval, found: &mut RequiredSet) -> Result<(), Error> {
        let alone = StableSet::from_intervals(vec![interval.clone()], Vec::new());
        let whole = self.problem.without_region();
        let known = whole.required_in_boxes(from_ref(self.requirement), &alone, self.at, self.budget)?;
        found.intervals.extend(known.intervals);
        found.undecided.extend(known.undecided);
        Ok(())
    }

    /// The values around an interval with which the loop is stable with the whole time, where any is borne; `None` where they are not found.
    fn stable_with_all(&self, interval: &StableInterval) -> Result<Option<StableSet>, Error> {
        let Some(with_all) = &self.with_all else { return Ok(None) };
        let (mut intervals, mut undecided) = (Vec::new(), Vec::new());
        for part in interval.bare().cut(&inside_of(interval, &self.limits, self.budget)?) {
            let (above, _) = self.above.substitute(0, &part.sample(self.budget)?);
            if self.constants.sign(&above.map_variables(|i| i.saturating_sub(1)), self.budget)?.is_ge() {
                continue;
            }
            let end = |value: &Option<Real>, is_lower: bool| {
                let (low, high) = value.as_ref()?.refined_to_digits(DIGITS).enclosure();
                Some(if is_lower { low } else { high })
            };
            let domain = Range::between(end(&part.lower, true), end(&part.upper, false));
            let mut set = self.stable_within(with_all, &domain)?;
            if set.is_none() {
                let is_limit = [&part.lower, &part.upper]
                    .map(|end| end.as_ref().is_some_and(|end| self.limits.iter().any(|limit| limit.is_same(end))));
                let Some(near) = self.nearer(&domain, is_limit) else { return Ok(None) };
                let why = "nothing is known of what is beyond";
                let is_cut = |old: &Option<Rational>, new: &Option<Rational>| old != new;
                if is_cut(&domain.lower, &near.lower) {
                    undecided.push(UndecidedBracket::new(domain.lower.clone(), near.lower.clone(), why));
                }
                if is_cut(&domain.upper, &near.upper) {
                    undecided.push(UndecidedBracket::new(near.upper.clone(), domain.upper.clone(), why));
                }
                set = self.stable_within(with_all, &near)?;
            }
            let Some(set) = set else { return Ok(None) };
            intervals.extend(set.intervals().iter().cloned());
            undecided.extend(set.undecided().iter().cloned());
        }
        Ok(Some(StableSet::from_intervals(intervals, undecided)))
    }

    /// The range without what is far away where it has no end, and without what is next to an end at which the modulus of the open loop is one in the limit of high
    /// frequencies; `None` where that is all of it.
    fn nearer(&self, domain: &Range, is_limit: [bool; 2]) -> Option<Range> {
        let nominal = self.problem.free()[0].nominal.as_ref();
        let [lower, upper] = [&domain.lower, &domain.upper].map(Option::as_ref);
        let far = [
            lower.cloned().or_else(|| beyond(upper, nominal).map(|x| -x))?,
            upper.cloned().or_else(|| beyond(lower, nominal))?,
        ];
        let step = (&far[1] - &far[0]) * Rational::dyadic(&Integer::ONE, NEXT_TO_LIMIT);
        let shift = |is_limit: bool| if is_limit { step.clone() } else { Rational::ZERO };
        let near = Range::between(Some(&far[0] + &shift(is_limit[0])), Some(&far[1] - &shift(is_limit[1])));
        Some(near).filter(|near| near != domain)
    }

    /// The values in a range with which the loop is stable with the whole time; `None` where they are not found.
    fn stable_within(&self, with_all: &DelayedLoop, domain: &Range) -> Result<Option<StableSet>, Error> {
        let parameter = Free { domain: domain.clone(), ..self.problem.free()[0].clone() };
        match stable_set_with_dead_time(&parameter, with_all, self.budget) {
            Ok(set) => Ok(Some(set)),
            Err(Error::Refused(_)) => Ok(None),
            Err(Error::Stopped(_)) if self.budget.check().is_ok() => Ok(None),
            Err(other) => Err(other),
        }
    }

    /// The name of the requirement, where a stable value does not meet it.
    fn unmet(&self, value: &Rational) -> Result<Unmet, Error> {
        let question = self.problem.model().ask().set_all(self.problem.set().to_vec());
        let problem = question.set(&self.problem.free()[0].name, value.clone()).problem()?;
        let is_met = match problem.meets(self.requirement, self.at, self.budget) {
            Err(Error::Undefined(_)) => false,
            told => told?,
        };
        Ok(if is_met { Vec::new() } else { vec![self.requirement.name()] })
    }
}

/// Functions of the parameter at whose zeros a crossing of the open loop may appear at once.
struct Touches<R> {
    /// Positive where the modulus is above one in the limit of high frequencies.
    above: R,
    /// The modulus is one in that limit.
    limits: Vec<R>,
    /// It touches one.
    elsewhere: Vec<R>,
}

impl Touches<UniPoly> {
    fn lifted(&self) -> Touches<MultiPoly> {
        let all = |list: &[UniPoly]| list.iter().map(|p| MultiPoly::from_univariate(p, 0)).collect();
        Touches {
            above: MultiPoly::from_univariate(&self.above, 0),
            limits: all(&self.limits),
            elsewhere: all(&self.elsewhere),
        }
    }
}

fn touches<R: Domain>([d, n]: [&Poly<R>; 2], budget: &Budget) -> Result<Touches<R>, Exhausted> {
    let (above, excess) = budget.enter(|| {
        let common = d.gcd(n);
        let [d, n] = [d, n].map(|p| p.div_exact(&common).expect("a gcd divides"));
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let [below, above] = [&d, &n].map(|p| modulus_squared(p, degree, Shape::LeftHalfPlane));
        let excess = above.minus(&below);
        // The variable is the square of s, which is not positive.
        let highest = excess.coeff(degree);
        let highest = if degree % 2 == 1 { highest.negated() } else { highest };
        let excess = if excess.is_zero() { excess } else { excess.square_free_part() };
        (highest, excess)
    })?;
    let mut list: Vec<R> = vec![above.clone()];
    list.extend(excess.leading().cloned());
    if excess.degree().is_some_and(|degree| degree > 1) {
        list.push(discriminant(&excess, budget)?);
    }
    let mut list = budget.enter(|| without_common_factors(list))?;
    let limits = vec![list.remove(0)];
    Ok(Touches { above, limits, elsewhere: list })
}

/// Pairwise coprime polynomials with the same zeros. A common zero of two polynomials shows in their greatest common divisor; no digits show that two numbers
/// are equal.
fn without_common_factors<R: Domain>(list: Vec<R>) -> Vec<R> {
    let mut out: Vec<R> = Vec::with_capacity(list.len());
    for mut f in list {
        for known in out.iter().filter(|known| !known.is_zero()) {
            while let Some(rest) = f.div_exact(&f.gcd(known)).filter(|rest| *rest != f && *rest != f.negated()) {
                f = rest;
            }
        }
        out.push(f);
    }
    out
}

/// The real zeros of polynomials in the parameter (0) and in constants behind it.
fn zeros(list: &[MultiPoly], constants: &Arc<Symbols>, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
    let mut out = Vec::new();
    for f in list {
        if let Some(f) = f.to_univariate(0) {
            let Some(f) = budget.enter(|| SquareFree::part_of(&f))? else { continue };
            out.extend(isolate_real_roots(&f, budget)?.into_iter().map(Real::from));
        } else if let Some(f) = SymbolicPoly::new(f, constants, budget)? {
            out.extend(f.real_roots_in(None, None, budget)?);
        }
    }
    Ok(out)
}

/// Values in ascending order, each once; what is said of one is said of those that equal it.
pub(super) fn ascending(values: Vec<(Real, bool)>, budget: &Budget) -> Result<Vec<(Real, bool)>, Exhausted> {
    let mut out: Vec<(Real, bool)> = Vec::with_capacity(values.len());
    for (value, said) in values {
        let mut place = out.len();
        let mut known = false;
        while place > 0 {
            match out[place - 1].0.compare(&value, budget)? {
                Ordering::Greater => place -= 1,
                Ordering::Equal => {
                    out[place - 1].1 |= said;
                    known = true;
                    break;
                }
                Ordering::Less => break,
            }
        }
        if !known {
            out.insert(place, (value, said));
        }
    }
    Ok(out)
}
