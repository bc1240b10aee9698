//! Requirements on margins in one parameter where the loop contains functions that are not rational, such as a plant behind a hold.

use super::any_quotient::AnyQuotient;
use super::boundaries::Elimination;
use super::candidates::Candidates;
use super::cells::{beyond, edge, outward, parts_beside};
use super::family::{plus_multiple, plus_multiple_of};
use super::loop_functions::number_asked;
use super::met::AtPoint;
use super::open_loop::OpenLoop;
use super::opened::OpenedLoop;
use super::over_boxes::{OverBoxes, certain, segments};
use super::requirement::Requirement;
use super::{RequiredEnd, RequiredInterval, RequiredSet};
use crate::error::{Code, Diagnostic, Error};
use crate::model::Cut;
use crate::problem::{Problem, moving_symbols};
use crate::stability::{Range, StableInterval, StableSet, UndecidedBracket, zeros_of_functions};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, Function, MovingSymbols};
use std::sync::Arc;

/// The open loop over the parameter (variable 0) and the symbols (symbol `i` is variable `i + 1`).
pub(super) struct SymbolicFamily<'a> {
    /// With the whole region of stability, whatever smaller one is asked for.
    problem: &'a Problem,
    cut: Cut,
    quotient: AnyQuotient<MultiPoly>,
    undefined: MultiPoly,
    symbols: MovingSymbols,
}

/// By resultants that are not expanded; a required number that is not rational is a symbol more.
struct Unexpanded {
    variable: usize,
}

impl Elimination<MultiPoly> for Unexpanded {
    type Left = Function;

    fn function(&self, f: MultiPoly) -> Function {
        f.into()
    }

    fn common_root(
        &self,
        p: &Poly<MultiPoly>,
        a: &Poly<MultiPoly>,
        b: &Poly<MultiPoly>,
        alpha: &RealAlgebraic,
        _: &Budget,
    ) -> Result<Function, Exhausted> {
        let with = match alpha.exact() {
            Some(alpha) => plus_multiple(a, b, &alpha),
            None => a.plus(&b.scaled(&MultiPoly::variable(self.variable))),
        };
        if with.is_zero() {
            return Ok(MultiPoly::zero().into());
        }
        Ok(Function::resultant(p.coeffs().to_vec(), with.into_coeffs()))
    }

    fn sum(&self, a: &MultiPoly, b: &MultiPoly, alpha: &RealAlgebraic, _: &Budget) -> Result<Function, Exhausted> {
        Ok(Function::from(match alpha.exact() {
            Some(alpha) => plus_multiple_of(a, b, &alpha),
            None => a.plus(&b.times(&MultiPoly::variable(self.variable))),
        }))
    }

    fn discriminant(&self, p: &Poly<MultiPoly>, _: &Budget) -> Result<Function, Exhausted> {
        // Up to the leading coefficient, which is a boundary itself.
        Ok(Function::resultant(p.coeffs().to_vec(), p.derivative().into_coeffs()))
    }
}

/// What is asked of all parts of a set.
struct Wanted<'w> {
    requirements: &'w [Requirement],
    /// Of each requirement what is known of short intervals; none where intervals are not asked.
    boxes: Vec<OverBoxes>,
    budget: &'w Budget,
}

impl<'a> SymbolicFamily<'a> {
    /// Of a loop without dead time; `None` of one in which everything is rational.
    pub fn of(problem: &'a Problem, cut: Cut, budget: &Budget) -> Result<Option<Self>, Error> {
        let opened = OpenedLoop::of(problem, cut.clone(), budget)?;
        if opened.symbols.is_empty() {
            return Ok(None);
        }
        let (quotient, undefined) = opened.any_quotient(MultiPoly::clone, budget)?;
        let symbols = moving_symbols(&opened.symbols)?;
        Ok(Some(SymbolicFamily { problem, cut, quotient, undefined, symbols }))
    }

    /// The parts of the stable set in which all requirements are met, and where that is not told.
    pub fn required_set(
        &self,
        requirements: &[Requirement],
        stable: &StableSet,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        let of = |requirement: &Requirement| {
            let symbols = self.symbols_of(requirement);
            // Of complex loops intervals are not asked as a whole.
            let AnyQuotient::Real(quotient) = &self.quotient else { return None };
            OverBoxes::new(quotient, &self.undefined, requirement.rule(), symbols)
        };
        let boxes: Option<Vec<OverBoxes>> = budget.enter(|| requirements.iter().map(of).collect())?;
        let wanted = Wanted { requirements, boxes: boxes.unwrap_or_default(), budget };
        for interval in stable.intervals() {
            self.in_segments(interval, &wanted, &mut found)?;
        }
        found.sort();
        Ok(found)
    }

    /// The symbols, and the number that a requirement asks for as the last one.
    fn symbols_of(&self, requirement: &Requirement) -> MovingSymbols {
        self.symbols.with("alpha", Definition::Algebraic(number_asked(requirement.rule())))
    }

    /// The parts of a stable interval: most of it is decided for short intervals as a whole, and only what is left is looked at for single
    /// values at which something changes.
    fn in_segments(
        &self,
        interval: &StableInterval,
        wanted: &Wanted<'_>,
        found: &mut RequiredSet,
    ) -> Result<(), Error> {
        let [Some(lower), Some(upper)] = [outward(&interval.lower, true), outward(&interval.upper, false)] else {
            return self.within(interval, wanted, found);
        };
        if wanted.boxes.is_empty() {
            return self.within(interval, wanted, found);
        }
        let segments = segments(&wanted.boxes, &lower, &upper, MOST_PIECES, wanted.budget)?;
        let begun = found.intervals.len();
        // Rational numbers beyond the ends of the interval are not in it.
        let is_above = |x: &Rational| interval.upper.as_ref().is_some_and(|end| end.value.compare_rational(x).is_le());
        let is_below = |x: &Rational| interval.lower.as_ref().is_some_and(|end| end.value.compare_rational(x).is_ge());
        let mut joints: Vec<Rational> = Vec::new();
        for (lo, hi, is_met) in segments.iter().filter(|(lo, hi, _)| !is_above(lo) && !is_below(hi)) {
            let lower = if is_below(lo) { interval.lower.clone() } else { Some(edge(lo)) };
            let upper = if is_above(hi) { interval.upper.clone() } else { Some(edge(hi)) };
            match is_met {
                Some(false) => {}
                Some(true) => {
                    joints.extend([lo.clone(), hi.clone()]);
                    let [lower, upper] = [lower, upper].map(|end| end.map(RequiredEnd::Stability));
                    found.intervals.push(RequiredInterval { lower, upper });
                }
                None => {
                    self.within(&StableInterval::new(lower, upper), wanted, found)?;
                }
            }
        }
        let parts = found.intervals.split_off(begun);
        for part in parts {
            let exact = |end: &Option<RequiredEnd>| end.as_ref().and_then(|end| end.value().exact());
            match found.intervals[begun..].last_mut() {
                Some(before)
                    if exact(&before.upper).is_some_and(|x| joints.contains(&x))
                        && exact(&before.upper) == exact(&part.lower) =>
                {
                    before.upper = part.upper;
                }
                _ => found.intervals.push(part),
            }
        }
        Ok(())
    }

    /// The same of a part that is decided at single values.
    fn within(&self, interval: &StableInterval, wanted: &Wanted<'_>, found: &mut RequiredSet) -> Result<(), Error> {
        let &Wanted { requirements, ref boxes, budget } = wanted;
        let part = budget.clone().within_work(WORK);
        let (candidates, all) = match self.candidates(interval, requirements, boxes, &part) {
            Err(Error::Stopped(_)) if budget.check().is_ok() && !boxes.is_empty() => match self.beyond(interval) {
                None => (Candidates::default(), vec![left_open(interval, requirements)]),
                Some(beyond) => return self.up_to(&beyond, interval, wanted, found),
            },
            found => {
                let found = found?;
                let brackets = found.brackets();
                (found, brackets)
            }
        };
        let mut brackets = Vec::with_capacity(all.len());
        for bracket in all {
            // Where functions vanish that mean nothing, nothing changes.
            let is_settled = match (&bracket.lower, &bracket.upper) {
                (Some(lo), Some(hi)) => budget.enter(|| certain(boxes, lo, hi))?.is_some(),
                _ => false,
            };
            if !is_settled {
                brackets.push(bracket);
            }
        }
        let unmet = |value: &Rational| self.unmet(value, requirements, budget);
        parts_beside(interval, brackets, found, |part| candidates.cells(part, requirements, unmet, budget))
    }

    /// An interval without an upper end in pieces up to a value; what is beyond stays open.
    fn up_to(
        &self,
        beyond: &Rational,
        interval: &StableInterval,
        wanted: &Wanted<'_>,
        found: &mut RequiredSet,
    ) -> Result<(), Error> {
        let below = StableInterval::new(interval.lower.clone(), Some(edge(beyond)));
        self.in_segments(&below, wanted, found)?;
        let above = StableInterval::new(Some(edge(beyond)), interval.upper.clone());
        found.undecided.push(left_open(&above, wanted.requirements));
        Ok(())
    }

    /// A large value in an interval without an upper end, up to which pieces are asked.
    fn beyond(&self, interval: &StableInterval) -> Option<Rational> {
        let lower = outward(&interval.lower, true).filter(|_| interval.upper.is_none())?;
        beyond(Some(&lower), self.problem.parameter().nominal.as_ref())
    }

    /// All values strictly inside of a stable interval at which a requirement may begin or cease to be met, and what may have
    /// others.
    fn candidates(
        &self,
        interval: &StableInterval,
        requirements: &[Requirement],
        boxes: &[OverBoxes],
        budget: &Budget,
    ) -> Result<Candidates, Error> {
        // An end that is not rational lies strictly inside.
        let range = Range::between(outward(&interval.lower, true), outward(&interval.upper, false));
        let nominal = self.problem.parameter().nominal.clone().filter(|x| !x.is_zero());
        let middle = range.lower.as_ref().zip(range.upper.as_ref()).map(|(lo, hi)| lo.midpoint(hi));
        let usual = nominal.or_else(|| middle.filter(|x| !x.is_zero())).unwrap_or(Rational::ONE);
        // Where functions vanish that mean nothing, nothing changes.
        let changes = |zero: &Real| {
            let (lo, hi) = zero.refined_to_digits(DIGITS).enclosure();
            certain(boxes, &lo, &hi).is_none()
        };
        let mut found = Candidates::default();
        for requirement in requirements {
            budget.check()?;
            let by = Unexpanded { variable: self.symbols.len() + 1 };
            let symbols = Arc::new(self.symbols_of(requirement));
            let boundaries = self.quotient.boundaries(&by, requirement, budget)?;
            // Those at which crossings appear come first.
            let mut functions = without_contents(boundaries.touches);
            let touches = functions.len();
            functions.extend(boundaries.zeros.into_iter().flat_map(without_contents));
            functions.push(self.undefined.clone().into());
            if functions.iter().any(|f| f.polynomial().is_some_and(MultiPoly::is_zero)) {
                let message = format!("the requirement {} is not decided for this loop", requirement.name());
                let help = "a polynomial of its boundary vanishes for every value";
                return Err(Diagnostic::error(Code::Require, message).help(help).into());
            }
            let (zeros, brackets) = zeros_of_functions(functions, &symbols, &range, &usual, &changes, budget)?;
            let values = zeros.into_iter().map(|(value, of)| (value, of.iter().any(|&k| k < touches))).collect();
            found.add(requirement, interval, (values, brackets), budget)?;
        }
        Ok(found)
    }

    /// The names of what is not met at a stable value.
    fn unmet(
        &self,
        value: &Rational,
        requirements: &[Requirement],
        budget: &Budget,
    ) -> Result<Vec<&'static str>, Error> {
        let problem = self.problem.with_value(value);
        let open_loop = OpenLoop::of_cut(&problem, self.cut.clone(), budget)?;
        Ok(AtPoint::unmet(&open_loop, requirements, budget)?)
    }
}

/// A part of an interval as a bracket that stays undecided.
pub(super) fn left_open(interval: &StableInterval, requirements: &[Requirement]) -> UndecidedBracket {
    let why = where_changed(requirements);
    UndecidedBracket::new(outward(&interval.lower, true), outward(&interval.upper, false), why)
}

/// What may happen in such a bracket.
pub(super) fn where_changed(requirements: &[Requirement]) -> String {
    let names: Vec<&str> = requirements.iter().map(Requirement::name).collect();
    format!("where {} begins or ceases to be met", names.join(" or "))
}

/// Resultants of long open loops take minutes and much memory: after so much work what pieces of the interval leave open stays a bracket.
/// Some seconds; the current loop of a motor over its inductance.
const WORK: u64 = 200_000_000;

/// So many intervals of the parameter are asked of all requirements at once. Over two decades of a sample time 240 decided nothing; an attempt at what is left
/// then took four times as long as these.
const MOST_PIECES: usize = 1000;

/// Digits of the interval around a zero in which nothing may change.
const DIGITS: usize = 24;

/// A resultant as that of the primitive parts, and the contents.
fn without_contents(f: Function) -> Vec<Function> {
    let Function::Resultant { a, b } = f else { return vec![f] };
    let mut out = Vec::new();
    let mut primitive = |list: Vec<MultiPoly>| {
        let content = list.iter().fold(MultiPoly::zero(), |g, c| g.gcd(c));
        if content.is_constant() {
            return list;
        }
        let divided = list.iter().map(|c| c.div_exact(&content).expect("the content divides")).collect();
        out.push(Function::from(content));
        divided
    };
    let (a, b) = (primitive(a), primitive(b));
    out.push(Function::resultant(a, b));
    out
}
