//! The stable set where the parameter is inside of exponentials, such as the sample time of a held plant.

use super::count::certain_count;
use super::pair::{Common, CommonRoots, Pair, Values};
use super::set::{Place, coprime, intervals, named_end};
use super::{Condition, MOST_EXPANDED, SymbolicPolynomial};
use crate::stability::{Cause, Causes, End, Range, Shape, StableSet, UndecidedBracket};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::multivariate::is_square_free_in;
use jurist_algebra::poly::{Domain, MultiPoly, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Function, MovingSymbols, common_factor, merged};
use std::cmp::Ordering;
use std::sync::Arc;

impl Values for MovingSymbols {
    fn at(&self, list: &[MultiPoly], parameter: &Ball) -> Option<Vec<Ball>> {
        self.enclose(list, parameter)
    }
}

/// A boundary condition: its function, the factor of it without symbols, and the functions of the basis that divide it.
struct Boundary {
    cause: Cause,
    function: Function,
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
    let Some(conditions) = p.conditions(region, MOST_EXPANDED, budget)? else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    let reach = reach(p, symbols, &conditions, range, region, budget)?;
    let (boundaries, basis) = split(conditions, symbols, budget)?;
    budget.step("isolating the boundaries' zeros");
    let mut all: Vec<Real> = Vec::new();
    for boundary in &boundaries {
        let Some(algebraic) = SquareFree::part_of(&boundary.algebraic) else { continue };
        let (lower, upper) = (reach.lower.as_ref(), reach.upper.as_ref());
        let roots = isolate_real_roots_in(&algebraic, lower, upper, budget)?;
        all = merged(all, roots.into_iter().map(Real::from).collect(), budget)?;
    }
    let mut from: Vec<(usize, Real)> = Vec::new();
    let mut undecided: Vec<Bracket> = reach.undecided.clone();
    let found: Vec<Result<Zeros, Exhausted>> =
        parallel_map(basis.iter().collect::<Vec<_>>(), |part| zeros_of(part, symbols, &reach, &p.usual, budget));
    for (k, found) in found.into_iter().enumerate() {
        let (zeros, brackets) = found?;
        undecided.extend(brackets);
        from.extend(zeros.iter().map(|zero| (k, zero.clone())));
        all = told_apart(all, zeros, &mut undecided, budget)?;
    }
    let zeros: Vec<Zero> = all
        .into_iter()
        .map(|value| {
            let parts = from.iter().filter(|(_, root)| root.is_same(&value)).map(|(k, _)| *k).collect();
            Zero { value, parts }
        })
        .collect();
    let undecided = disjoint(undecided);
    let common = (p.formal_degree > 1).then(|| {
        let pair = Arc::new(Pair::of(&p.pair(region)));
        CommonRoots::new(pair, Arc::clone(symbols) as Arc<dyn Values>)
    });
    let examiner = Examiner { symbols, range, boundaries: &boundaries, common, budget };
    let mut stable = Vec::new();
    let mut lower = reach.lower.clone();
    for k in 0..=undecided.len() {
        let bracket = undecided.get(k);
        let upper = bracket.map_or_else(|| reach.upper.clone(), |b| b.0.clone());
        let is_piece = match (&lower, &upper) {
            (Some(lower), Some(upper)) => lower < upper,
            // A bracket without a lower end begins before everything.
            (None, None) => bracket.is_none(),
            _ => bracket.is_none_or(|b| b.0.is_some()),
        };
        if is_piece {
            let piece = Range::between(lower.clone(), upper);
            let inside = |z: &&Zero| {
                piece.lower.as_ref().is_none_or(|x| z.value.compare_rational(x).is_gt())
                    && piece.upper.as_ref().is_none_or(|x| z.value.compare_rational(x).is_lt())
            };
            let zeros: Vec<&Zero> = zeros.iter().filter(inside).collect();
            let values = zeros.iter().map(|z| z.value.clone()).collect();
            let at = |sample: &Rational| p.at(sample, region, budget);
            let end = |place: Place<'_>, is_between: bool| match place {
                Place::Domain(value) => {
                    let exact = value.exact();
                    let is_beside = undecided.iter().any(|b| exact.is_some() && (exact == b.0 || exact == b.1));
                    match is_beside {
                        true => Ok(Some(End::new(value.clone(), Causes::default(), None))),
                        false => examiner.at_domain(value).map(Some),
                    }
                }
                Place::Zero(k) => examiner.at_zero(zeros[k], is_between),
            };
            stable.extend(intervals(&piece, values, p.formal_degree(), at, end, budget)?);
        }
        let Some(bracket) = bracket else { break };
        lower = bracket.1.clone();
        if lower.is_none() {
            break;
        }
    }
    let brackets = undecided.into_iter().map(|(lo, hi)| {
        let why = match (&lo, &hi) {
            (Some(lo), Some(_)) if lo.is_zero() && range.lower.as_ref().is_some_and(Rational::is_zero) => {
                "not resolved so near to 0"
            }
            (Some(_), Some(_)) => "touching or crossing",
            _ => "not resolved so far out: give bounds of the domain",
        };
        UndecidedBracket::new(lo, hi, why)
    });
    Ok(StableSet::from_intervals(stable, brackets.collect()))
}

/// Zeros, ascending, and what may have others.
type Zeros = (Vec<Real>, Vec<Bracket>);

/// The zeros of a function as far as the reach goes.
fn zeros_of(
    part: &Function,
    symbols: &Arc<MovingSymbols>,
    reach: &Reach,
    usual: &Rational,
    budget: &Budget,
) -> Result<Zeros, Exhausted> {
    let found = symbols.zeros_in(part, &reach.from, &reach.to, usual, budget)?;
    let mut zeros = found.zeros;
    let mut undecided: Vec<Bracket> = found.undecided.into_iter().map(|(lo, hi)| (Some(lo), Some(hi))).collect();
    if let Some(inverted) = &reach.inverted {
        let one_over = reach.to.recip().expect("a positive number");
        let beyond = inverted.zeros_in(&part.inverted(), &Rational::ZERO, &one_over, &one_over, budget)?;
        zeros.extend(beyond.zeros.iter().rev().map(Real::recip));
        undecided.extend(beyond.undecided.into_iter().map(|(lo, hi)| (hi.recip(), lo.recip())));
        if symbols.may_vanish_at(part, &reach.to, budget)? {
            undecided.push((Some(reach.to.clone()), Some(reach.to.clone())));
        }
    }
    Ok((zeros, undecided))
}

/// Two ascending lists as one, each number once. Two that some thousand bits do not tell apart, and no identity shows to be the same,
/// leave a bracket.
fn told_apart(
    a: Vec<Real>,
    b: Vec<Real>,
    undecided: &mut Vec<Bracket>,
    budget: &Budget,
) -> Result<Vec<Real>, Exhausted> {
    let mut out = Vec::with_capacity(a.len() + b.len());
    let (mut a, mut b) = (a.into_iter().peekable(), b.into_iter().peekable());
    while let (Some(x), Some(y)) = (a.peek(), b.peek()) {
        match x.compare(y, budget) {
            Ok(Ordering::Less) => out.extend(a.next()),
            Ok(Ordering::Greater) => out.extend(b.next()),
            Ok(Ordering::Equal) => {
                out.extend(a.next());
                b.next();
            }
            Err(stopped) if stopped.budget.starts_with("precision") => {
                let width = Rational::dyadic(&Integer::ONE, BRACKET_BITS);
                let [(lo, hi), (least, most)] = [x, y].map(|x| x.refined(&width).enclosure());
                undecided.push((Some(lo.min(least)), Some(hi.max(most))));
                a.next();
                b.next();
            }
            Err(stopped) => return Err(stopped),
        }
    }
    out.extend(a);
    out.extend(b);
    Ok(out)
}

/// An interval in which nothing is known; none where it has no end.
type Bracket = (Option<Rational>, Option<Rational>);

/// Where zeros are looked for: between `from` and `to`, and beyond `to` by the reciprocal of the parameter.
struct Reach {
    from: Rational,
    to: Rational,
    inverted: Option<Arc<MovingSymbols>>,
    /// The ends of what is decided; none where that goes on for ever.
    lower: Option<Rational>,
    upper: Option<Rational>,
    /// What lies outside of them in the range.
    undecided: Vec<Bracket>,
}

/// How far a parameter goes that is not bounded: to where nothing happens any more, or, by its reciprocal, all the way, or
/// else to a large multiple of its usual value.
fn reach(
    p: &SymbolicPolynomial,
    symbols: &Arc<MovingSymbols>,
    conditions: &[Condition],
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<Reach, Exhausted> {
    let usual = p.usual.abs().max(Rational::dyadic(&Integer::ONE, 64));
    let large = |x: &Rational| (x.abs() + &usual) * Rational::from(MULTIPLE);
    let mut undecided = Vec::new();
    let from = match (&range.lower, &range.upper) {
        (Some(lower), _) => lower.clone(),
        (None, upper) => {
            let from = -large(upper.as_ref().unwrap_or(&Rational::ZERO));
            undecided.push((None, Some(from.clone())));
            from
        }
    };
    let lower = Some(from.clone());
    let from = if from.is_zero() { p.after_death(symbols, conditions, range.upper.as_ref(), budget)? } else { from };
    if let Some(to) = &range.upper {
        return Ok(Reach { from, to: to.clone(), inverted: None, lower, upper: Some(to.clone()), undecided });
    }
    if let Some(to) = p.tail_start(symbols, conditions, &from, region, budget)? {
        return Ok(Reach { from, to, inverted: None, lower, upper: None, undecided });
    }
    let to = large(&from);
    let inverted = symbols.inverted().filter(|s| s.at(&Rational::ZERO).is_some());
    if let Some(inverted) = inverted {
        return Ok(Reach { from, to, inverted: Some(Arc::new(inverted)), lower, upper: None, undecided });
    }
    undecided.push((Some(to.clone()), None));
    Ok(Reach { from, to: to.clone(), inverted: None, lower, upper: Some(to), undecided })
}

/// The boundary conditions and the functions they are made of.
fn split(
    conditions: Vec<Condition>,
    symbols: &MovingSymbols,
    budget: &Budget,
) -> Result<(Vec<Boundary>, Vec<Function>), Exhausted> {
    let mut split = Vec::with_capacity(conditions.len());
    for (cause, function) in conditions {
        split.push(budget.enter(|| {
            let Some(p) = function.polynomial() else { return (cause, function, UniPoly::one(), None) };
            let unknowns = p.variables();
            let square_free = if unknowns.iter().all(|&j| is_square_free_in(p, j)) {
                p.clone()
            } else if p.terms().len() > MOST_TERMS {
                return (cause, function.clone(), UniPoly::one(), Some(without_exponentials(p.clone(), symbols)));
            } else {
                p.square_free_part()
            };
            let algebraic = common_factor(&square_free);
            let divisor = MultiPoly::from_univariate(&algebraic, 0);
            let rest = without_exponentials(square_free.div_exact(&divisor).expect("a common factor divides"), symbols);
            (cause, function, algebraic, Some(rest))
        })?);
    }
    let rests = split.iter().filter_map(|(_, _, _, rest)| rest.clone());
    let (short, long): (Vec<MultiPoly>, Vec<MultiPoly>) = rests.partition(|rest| rest.terms().len() <= MOST_TERMS);
    let mut expanded = budget.enter(|| coprime(&short, &all_variables(&short)))?;
    expanded.extend(long);
    let mut basis: Vec<Function> = expanded.iter().cloned().map(Function::from).collect();
    let mut boundaries = Vec::with_capacity(split.len());
    for (cause, function, algebraic, rest) in split {
        let divides = |part: &MultiPoly, rest: &MultiPoly| {
            part == rest || (rest.terms().len() <= MOST_TERMS && rest.div_exact(part).is_some())
        };
        let parts = match rest {
            Some(rest) => budget.enter(|| (0..expanded.len()).filter(|&k| divides(&expanded[k], &rest)).collect())?,
            None => {
                basis.push(function.clone());
                vec![basis.len() - 1]
            }
        };
        boundaries.push(Boundary { cause, function, algebraic, parts });
    }
    Ok((boundaries, basis))
}

/// Bits of the ends of a bracket around two numbers that are not told apart.
const BRACKET_BITS: u64 = 256;

/// Where nothing bounds a parameter and nothing dies away, it is looked at up to this multiple of its usual value.
const MULTIPLE: i64 = 1024;

/// Functions with more terms that may have repeated factors are not divided into them: a zero of even order then stays an
/// undecided bracket.
const MOST_TERMS: usize = 120;

/// The values that are tried for the beginning of the tail: powers of two from this one on.
const FIRST_POWER: i64 = -40;

/// The last of them.
const LAST_POWER: i64 = 60;

impl SymbolicPolynomial {
    /// A number above `lower` from which on no root comes to the boundary, as all symbols have died away; `None` where none is
    /// found.
    ///
    /// Cost: exponentials of small matrices and a root count or a determinant for each of up to a hundred powers of two.
    fn tail_start(
        &self,
        symbols: &MovingSymbols,
        conditions: &[Condition],
        lower: &Rational,
        region: Shape,
        budget: &Budget,
    ) -> Result<Option<Rational>, Exhausted> {
        budget.step("bounding what dies away");
        let is_inside_only = self.polynomial.coeffs().iter().chain(&self.poles).all(|c| c.degree_in(0) == 0);
        for power in FIRST_POWER..=LAST_POWER {
            budget.check()?;
            let start = Rational::from(2).pow(power).expect("two is not zero");
            if start <= *lower {
                continue;
            }
            let bound = |f: &MultiPoly| symbols.beyond(f, &start);
            let certain = budget.enter(|| {
                if !is_inside_only {
                    return conditions.iter().all(|(_, f)| symbols.has_no_zero_beyond(f, &start));
                }
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

    /// The number between 0 and which nothing happens, where the symbols die away towards 0, as `exp(-T/T_m)` does with the time
    /// constant `T_m`; 0 where none is found.
    ///
    /// Cost: as of [`Self::tail_start`], in the reciprocal of the parameter.
    fn after_death(
        &self,
        symbols: &MovingSymbols,
        conditions: &[Condition],
        upper: Option<&Rational>,
        budget: &Budget,
    ) -> Result<Rational, Exhausted> {
        if symbols.at(&Rational::ZERO).is_some() {
            return Ok(Rational::ZERO);
        }
        let Some(inverted) = symbols.inverted() else { return Ok(Rational::ZERO) };
        budget.step("bounding what dies away");
        let functions: Vec<Function> = conditions.iter().map(|(_, f)| f.inverted()).collect();
        for power in 0..=LAST_POWER {
            budget.check()?;
            let start = Rational::from(2).pow(power).expect("two is not zero");
            let to = Rational::dyadic(&Integer::ONE, power.unsigned_abs());
            if upper.is_some_and(|upper| to >= *upper) {
                continue;
            }
            if budget.enter(|| functions.iter().all(|f| inverted.has_no_zero_beyond(f, &start)))? {
                return Ok(to);
            }
        }
        Ok(Rational::ZERO)
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
fn disjoint(mut brackets: Vec<Bracket>) -> Vec<Bracket> {
    brackets.sort();
    let mut out: Vec<Bracket> = Vec::new();
    for (lo, hi) in brackets {
        match out.last_mut() {
            Some(last) if last.1.is_none() || lo <= last.1 => {
                last.1 = if hi.is_none() || last.1.is_none() { None } else { hi.max(last.1.clone()) };
            }
            _ => out.push((lo, hi)),
        }
    }
    out
}

/// Finds out what happens at an end of a stable cell.
struct Examiner<'a> {
    symbols: &'a Arc<MovingSymbols>,
    range: &'a Range,
    boundaries: &'a [Boundary],
    common: Option<CommonRoots>,
    budget: &'a Budget,
}

impl Examiner<'_> {
    fn at_domain(&self, value: &Real) -> Result<End, Exhausted> {
        let exact = value.exact().expect("an end of the range is rational");
        let mut held = Vec::new();
        for boundary in self.boundaries {
            if self.symbols.may_vanish_at(&boundary.function, &exact, self.budget)? {
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
        match &self.common {
            Some(common) => common.at(value, self.budget),
            None => Ok(Common::Unknown),
        }
    }
}
