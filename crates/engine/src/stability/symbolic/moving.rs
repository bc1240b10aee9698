//! The stable set where the parameter is inside of exponentials, such as the sample time of a held plant.

use super::count::certain_count;
use super::pair::{Common, FirstSubresultant, Values};
use super::set::{Place, coprime, intervals, named_end};
use super::{SymbolicPolynomial, Table};
use crate::stability::{Cause, Causes, End, Range, Shape, StableSet, UndecidedBracket};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{MovingSymbols, common_factor, is_square_free_in, merged};
use std::sync::Arc;

impl Values for MovingSymbols {
    fn at(&self, p: &MultiPoly, parameter: &Ball) -> Option<Ball> {
        self.enclose(p, parameter)
    }
}

/// A boundary condition: its function, the factor of it without symbols, and the functions of the basis that divide it.
struct Boundary {
    cause: Cause,
    function: MultiPoly,
    algebraic: UniPoly,
    parts: Vec<usize>,
}

/// A zero of the boundary functions, and from which of the basis it comes.
struct Zero {
    value: Real,
    parts: Vec<usize>,
}

/// As [`symbolic_stable_set`](super::symbolic_stable_set) for symbols that depend on the parameter.
pub(super) fn moving_stable_set(
    p: &SymbolicPolynomial,
    symbols: &Arc<MovingSymbols>,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let Some(lower) = &range.lower else { panic!("the range is bounded below") };
    let tail;
    let upper = match &range.upper {
        Some(upper) => upper,
        None => {
            tail = p.tail_start(lower, region, budget)?.expect("a tail that is decided");
            &tail
        }
    };
    let nowhere = || StableSet::from_intervals(Vec::new(), Vec::new());
    let Some(conditions) = p.conditions(region, budget)? else { return Ok(nowhere()) };
    let mut split = Vec::with_capacity(conditions.len());
    for (cause, function) in conditions {
        split.push(budget.enter(|| {
            let unknowns = function.variables();
            let square_free = if unknowns.iter().all(|&j| is_square_free_in(&function, j)) {
                function.clone()
            } else if function.terms().len() > MOST_TERMS {
                return (cause, function.clone(), UniPoly::one(), without_exponentials(function, symbols));
            } else {
                function.square_free_part()
            };
            let algebraic = common_factor(&square_free);
            let divisor = MultiPoly::from_univariate(&algebraic, 0);
            let rest = without_exponentials(square_free.div_exact(&divisor).expect("a common factor divides"), symbols);
            (cause, function, algebraic, rest)
        })?);
    }
    let rests: Vec<MultiPoly> = split.iter().map(|(_, _, _, rest)| rest.clone()).collect();
    let (short, long): (Vec<MultiPoly>, Vec<MultiPoly>) =
        rests.into_iter().partition(|rest| rest.terms().len() <= MOST_TERMS);
    let mut basis = budget.enter(|| coprime(&short, &all_variables(&short)))?;
    basis.extend(long);
    let boundaries: Vec<Boundary> = budget.enter(|| {
        let divides = |part: &MultiPoly, rest: &MultiPoly| {
            part == rest || (rest.terms().len() <= MOST_TERMS && rest.div_exact(part).is_some())
        };
        let parts = |rest: &MultiPoly| (0..basis.len()).filter(|&k| divides(&basis[k], rest)).collect();
        let boundary =
            |(cause, function, algebraic, rest)| Boundary { cause, function, algebraic, parts: parts(&rest) };
        split.into_iter().map(boundary).collect()
    })?;
    budget.step("isolating the boundaries' zeros");
    let mut all: Vec<Real> = Vec::new();
    for boundary in &boundaries {
        let Some(algebraic) = SquareFree::part_of(&boundary.algebraic) else { continue };
        let roots = isolate_real_roots_in(&algebraic, Some(lower), Some(upper), budget)?;
        all = merged(all, roots.into_iter().map(Real::from).collect(), budget)?;
    }
    let mut from: Vec<(usize, Real)> = Vec::new();
    let mut undecided: Vec<(Rational, Rational, usize)> = Vec::new();
    for (k, part) in basis.iter().enumerate() {
        let found = symbols.zeros_in(part, lower, upper, budget)?;
        from.extend(found.zeros.iter().map(|zero| (k, zero.clone())));
        undecided.extend(found.undecided.into_iter().map(|(lo, hi)| (lo, hi, k)));
        all = merged(all, found.zeros, budget)?;
    }
    let zeros: Vec<Zero> = all
        .into_iter()
        .map(|value| {
            let parts = from.iter().filter(|(_, root)| root.is_same(&value)).map(|(k, _)| *k).collect();
            Zero { value, parts }
        })
        .collect();
    let undecided = disjoint(undecided);
    let first = FirstSubresultant::new(&p.pair(region), Arc::clone(symbols) as Arc<dyn Values>, budget)?;
    let bounded = Range::between(Some(lower.clone()), Some(upper.clone()));
    let examiner = Examiner { symbols, range: &bounded, boundaries: &boundaries, first, budget };
    let mut stable = Vec::new();
    let mut from = lower.clone();
    for k in 0..=undecided.len() {
        let to = undecided.get(k).map_or_else(|| upper.clone(), |b| b.0.clone());
        if from < to {
            let piece = Range::between(Some(from), Some(to.clone()));
            let inside = |z: &&Zero| {
                z.value.compare_rational(piece.lower.as_ref().expect("bounded")).is_gt()
                    && z.value.compare_rational(&to).is_lt()
            };
            let zeros: Vec<&Zero> = zeros.iter().filter(inside).collect();
            let values = zeros.iter().map(|z| z.value.clone()).collect();
            let at = |sample: &Rational| p.at(sample, region, budget);
            let end = |place: Place<'_>, is_between: bool| match place {
                Place::Domain(value) => {
                    match undecided.iter().find(|b| value.exact().is_some_and(|x| x == b.0 || x == b.1)) {
                        Some(bracket) => Ok(Some(examiner.beside(value, bracket.2))),
                        None => examiner.at_domain(value).map(Some),
                    }
                }
                Place::Zero(k) => examiner.at_zero(zeros[k], is_between),
            };
            stable.extend(intervals(&piece, values, p.formal_degree(), at, end, budget)?);
        }
        from = undecided.get(k).map_or_else(|| upper.clone(), |b| b.1.clone());
    }
    if range.upper.is_none()
        && let Some(last) = stable.last_mut()
        && last.upper.as_ref().is_some_and(|end| end.value.exact().as_ref() == Some(upper))
    {
        // The tail has the verdict of the last cell.
        last.upper = None;
    }
    let brackets = undecided.into_iter().map(|(lo, hi, _)| UndecidedBracket::new(lo, hi, "touching or crossing"));
    Ok(StableSet::from_intervals(stable, brackets.collect()))
}

/// Functions with more terms that may have repeated factors are not divided into them: a zero of even order then stays an
/// undecided bracket.
const MOST_TERMS: usize = 120;

/// The values that are tried for the beginning of the tail: powers of two from this one on.
const FIRST_POWER: i64 = -40;

/// The last of them.
const LAST_POWER: i64 = 60;

impl SymbolicPolynomial {
    /// A number above `lower` from which on no root comes to the boundary, as all symbols have died away; `None` where none is
    /// found because a symbol does not, or the parameter itself occurs in the coefficients.
    ///
    /// Cost: exponentials of small matrices and a root count for each of up to a hundred powers of two.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn tail_start(&self, lower: &Rational, region: Shape, budget: &Budget) -> Result<Option<Rational>, Exhausted> {
        let Table::Moving(symbols) = &self.symbols else { return Ok(None) };
        if self.polynomial.coeffs().iter().chain(&self.poles).any(|c| c.degree_in(0) > 0) {
            return Ok(None);
        }
        budget.step("bounding what dies away");
        for power in FIRST_POWER..=LAST_POWER {
            budget.check()?;
            let start = Rational::from(2).pow(power).expect("two is not zero");
            if start <= *lower {
                continue;
            }
            let bound = |f: &MultiPoly| symbols.beyond(f, &start);
            let certain = budget.enter(|| {
                let poles = self.poles.iter().all(|pole| bound(pole).is_some_and(|b| !b.contains_zero()));
                let coefficients: Option<Vec<Ball>> = self.polynomial.coeffs().iter().map(bound).collect();
                poles && coefficients.is_some_and(|c| certain_count(&c, region).is_some())
            })?;
            if certain {
                return Ok(Some(start));
            }
        }
        Ok(None)
    }
}

/// All variables that occur.
fn all_variables(polynomials: &[MultiPoly]) -> Vec<usize> {
    let all: std::collections::BTreeSet<usize> = polynomials.iter().flat_map(MultiPoly::variables).collect();
    all.into_iter().collect()
}

/// Without factors that are powers of exponentials, which are never zero.
fn without_exponentials(p: MultiPoly, symbols: &MovingSymbols) -> MultiPoly {
    let content = p.monomial_content();
    let kept = (0..content.exponents().len()).filter(|&i| i == 0 || !symbols.is_exponential(i - 1));
    let monomial = kept.fold(content.clone(), |m, i| m.with_exponent(i, 0));
    p.div_exact_monomial(&monomial).expect("the content divides")
}

/// Brackets in ascending order, those that overlap as one.
fn disjoint(mut brackets: Vec<(Rational, Rational, usize)>) -> Vec<(Rational, Rational, usize)> {
    brackets.sort();
    let mut out: Vec<(Rational, Rational, usize)> = Vec::new();
    for (lo, hi, k) in brackets {
        match out.last_mut() {
            Some(last) if last.1 >= lo => last.1 = hi.max(last.1.clone()),
            _ => out.push((lo, hi, k)),
        }
    }
    out
}

/// Finds out what happens at an end of a stable cell.
struct Examiner<'a> {
    symbols: &'a Arc<MovingSymbols>,
    range: &'a Range,
    boundaries: &'a [Boundary],
    first: Option<FirstSubresultant>,
    budget: &'a Budget,
}

impl Examiner<'_> {
    fn at_domain(&self, value: &Real) -> Result<End, Exhausted> {
        let exact = value.exact().expect("an end of the range is rational");
        let mut held = Vec::new();
        for boundary in self.boundaries {
            if self.symbols.vanishes_at(&boundary.function, &exact, self.budget)? {
                held.push(boundary.cause);
            }
        }
        // Several pairs may come together at the end of the range, such as at the sample time 0.
        let pair = || match held.as_slice() {
            [Cause::ComplexPair] => self.common_root(value),
            _ => Ok(Common::Beyond),
        };
        let end = named_end(value, &held, self.range, false, pair)?;
        Ok(end.unwrap_or_else(|| End::new(value.clone(), Causes::default(), None)))
    }

    /// Beside a bracket in which a function of the basis may have zeros.
    fn beside(&self, value: &Real, part: usize) -> End {
        let mut causes = Causes::default();
        self.boundaries.iter().filter(|b| b.parts.contains(&part)).for_each(|b| causes.insert(b.cause));
        End::new(value.clone(), causes, None)
    }

    fn at_zero(&self, zero: &Zero, is_between: bool) -> Result<Option<End>, Exhausted> {
        let mut held = Vec::new();
        for boundary in self.boundaries {
            let by_part = boundary.parts.iter().any(|k| zero.parts.contains(k));
            let by_root = zero.value.algebraic().is_some_and(|x| x.sign_of(&boundary.algebraic).is_eq());
            if by_part || by_root {
                held.push(boundary.cause);
            }
        }
        named_end(&zero.value, &held, self.range, is_between, || self.common_root(&zero.value))
    }

    fn common_root(&self, value: &Real) -> Result<Common, Exhausted> {
        match &self.first {
            Some(first) => first.at(value, self.budget),
            None => Ok(Common::Unknown),
        }
    }
}
