//! The zeros of boundary functions of a parameter and symbols that may depend on it.

use super::Condition;
use super::basis::coprime;
use crate::line::Bracket;
use crate::{Cause, Range};
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::multivariate::is_square_free_in;
use jurist_algebra::poly::{Domain, MultiPoly, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{DefinedParts, Function, MovingSymbols, common_factor, merged};
use std::cmp::Ordering;
use std::sync::Arc;

/// A boundary condition: its function, the factor of it without symbols, and the functions of the basis that divide it.
pub(super) struct Boundary {
    pub cause: Cause,
    pub function: Function,
    pub algebraic: UniPoly,
    pub parts: Vec<usize>,
}

impl Boundary {
    /// Whether a zero is one of this boundary.
    pub fn has(&self, zero: &Zero) -> bool {
        let by_part = self.parts.iter().any(|k| zero.parts.contains(k));
        by_part || zero.value.algebraic().is_some_and(|x| x.sign_of(&self.algebraic).is_eq())
    }
}

/// A zero of the boundary functions, and from which of the basis it comes.
pub(super) struct Zero {
    pub value: Real,
    pub parts: Vec<usize>,
}

/// A zero, and which of the functions have it.
pub type ZeroOf = (Real, Vec<usize>);

/// The zeros of functions in a range, ascending, each with which of the functions it is a zero of, and where there may be others.
///
/// `usual` is a value on whose scale zeros are looked for first; zeros that are not wanted are left out before they are compared.
///
/// Cost: as of [`MovingSymbols::zeros_in`] for each factor of the functions.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn zeros_of_functions(
    functions: Vec<Function>,
    symbols: &Arc<MovingSymbols>,
    range: &Range,
    usual: &Rational,
    is_wanted: &dyn Fn(&Real) -> bool,
    budget: &Budget,
) -> Result<(Vec<ZeroOf>, Vec<Bracket>), Exhausted> {
    let reach = Reach::without_tail(symbols, range, None, usual, MULTIPLE);
    let conditions = functions.into_iter().map(|f| (Cause::Undecided, f)).collect();
    let (boundaries, basis) = split(conditions, symbols, budget)?;
    let (zeros, undecided) = zeros_within((&boundaries, &basis), symbols, &reach, usual, is_wanted, budget)?;
    let which = |zero: &Zero| (0..boundaries.len()).filter(|&k| boundaries[k].has(zero)).collect();
    Ok((zeros.iter().map(|zero| (zero.value.clone(), which(zero))).collect(), undecided))
}

/// Where zeros are looked for: between `from` and `to`, and beyond `to` by the reciprocal of the parameter.
pub(super) struct Reach {
    pub from: Rational,
    pub to: Rational,
    pub inverted: Option<Arc<MovingSymbols>>,
    /// The ends of what is decided; none where that goes on for ever.
    pub lower: Option<Rational>,
    pub upper: Option<Rational>,
    /// What lies outside of them in the range.
    pub undecided: Vec<Bracket>,
    /// Zeros are looked for in these parts alone.
    pub only: Option<Arc<[(Rational, Rational)]>>,
}

impl Reach {
    /// As far as a range goes; where it has no end to a multiple of the usual value, and beyond by the reciprocal of the
    /// parameter if all symbols have values at its zero. Below `start` nothing happens.
    pub fn without_tail(
        symbols: &MovingSymbols,
        range: &Range,
        start: Option<Rational>,
        usual: &Rational,
        multiple: i64,
    ) -> Reach {
        let usual = usual.abs().max(Rational::dyadic(&Integer::ONE, 64));
        let large = |x: &Option<Rational>| {
            (x.as_ref().map_or(Rational::ZERO, Rational::abs) + &usual) * Rational::from(multiple)
        };
        let from = range.lower.clone().unwrap_or_else(|| -large(&range.upper));
        let mut reach = Reach {
            from: start.unwrap_or_else(|| from.clone()),
            to: range.upper.clone().unwrap_or_else(|| large(&range.lower)),
            inverted: None,
            lower: Some(from.clone()),
            upper: range.upper.clone(),
            undecided: Vec::new(),
            only: None,
        };
        if range.lower.is_none() {
            reach.undecided.push((None, Some(from)));
        }
        if range.upper.is_none() {
            let inverted = symbols.inverted().filter(|s| s.at(&Rational::ZERO).is_some());
            reach.inverted = inverted.map(Arc::new);
            if reach.inverted.is_none() {
                reach.upper = Some(reach.to.clone());
                reach.undecided.push((Some(reach.to.clone()), None));
            }
        }
        reach
    }

    /// Between two numbers, and nothing of what lies beyond.
    pub fn between(from: &Rational, to: &Rational) -> Reach {
        let end = |x: &Rational| Some(x.clone());
        Reach {
            from: from.clone(),
            to: to.clone(),
            inverted: None,
            lower: end(from),
            upper: end(to),
            undecided: Vec::new(),
            only: None,
        }
    }

    /// The parts of an interval that are looked at.
    fn parts_of(&self, (from, to): &(Rational, Rational)) -> Vec<(Rational, Rational)> {
        let Some(only) = &self.only else { return vec![(from.clone(), to.clone())] };
        let within = |(low, high): &(Rational, Rational)| (low.max(from).clone(), high.min(to).clone());
        only.iter().map(within).filter(|(low, high)| low < high).collect()
    }

    /// Whether there is more below that is not looked at.
    pub fn is_open_below(&self) -> bool {
        self.undecided.iter().any(|(lo, _)| lo.is_none())
    }

    /// Whether there is more above that is not looked at.
    pub fn is_open_above(&self) -> bool {
        self.undecided.iter().any(|(_, hi)| hi.is_none())
    }

    /// Down to a number.
    pub fn widen_below(&mut self, from: Rational) {
        self.undecided.retain(|(lo, _)| lo.is_some());
        self.undecided.push((None, Some(from.clone())));
        (self.lower, self.from) = (Some(from.clone()), from);
    }

    /// Up to a number.
    pub fn widen_above(&mut self, to: Rational) {
        self.undecided.retain(|(_, hi)| hi.is_some());
        self.undecided.push((Some(to.clone()), None));
        (self.upper, self.to) = (Some(to.clone()), to);
    }
}

/// Where nothing bounds a parameter in a question of functions alone, they are looked at up to this multiple of its usual value.
const MULTIPLE: i64 = 1024;

/// Functions with more terms that may have repeated factors are not divided into them: a zero of even order then stays an
/// undecided bracket.
const MOST_TERMS: usize = 120;

/// Bits of the ends of a bracket around two numbers that are not told apart.
const BRACKET_BITS: u64 = 256;

/// The zeros of all boundaries as far as the reach goes, ascending, each once, and where there may be others.
pub(super) fn zeros_within(
    (boundaries, basis): (&[Boundary], &[Function]),
    symbols: &Arc<MovingSymbols>,
    reach: &Reach,
    usual: &Rational,
    is_wanted: &dyn Fn(&Real) -> bool,
    budget: &Budget,
) -> Result<(Vec<Zero>, Vec<Bracket>), Exhausted> {
    budget.step("isolating the boundaries' zeros");
    let mut all: Vec<Real> = Vec::new();
    for boundary in boundaries {
        let Some(algebraic) = SquareFree::part_of(&boundary.algebraic) else { continue };
        let (lower, upper) = (reach.lower.as_ref(), reach.upper.as_ref());
        let roots = isolate_real_roots_in(&algebraic, lower, upper, budget)?;
        all = merged(all, roots.into_iter().map(Real::from).collect(), budget)?;
    }
    let mut from: Vec<(usize, Real)> = Vec::new();
    let mut undecided: Vec<Bracket> = reach.undecided.clone();
    let found: Vec<Result<Zeros, Exhausted>> =
        parallel_map(basis.iter().collect::<Vec<_>>(), |part| zeros_of(part, symbols, reach, usual, budget));
    for (k, found) in found.into_iter().enumerate() {
        let (mut zeros, brackets) = found?;
        undecided.extend(brackets);
        zeros.retain(|zero| is_wanted(zero));
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
    Ok((zeros, disjoint(undecided)))
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
    let DefinedParts { parts, gaps } = symbols.defined_parts(&reach.from, &reach.to, budget)?;
    let (mut zeros, mut open) = (Vec::new(), gaps);
    let looked_at = parts.iter().flat_map(|part| reach.parts_of(part));
    for (from, to) in &looked_at.collect::<Vec<_>>() {
        let found = symbols.zeros_in(part, from, to, usual, budget)?;
        zeros.extend(found.zeros);
        open.extend(found.undecided);
    }
    let mut undecided: Vec<Bracket> = open.into_iter().map(|(lo, hi)| (Some(lo), Some(hi))).collect();
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
pub fn told_apart(
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
            Err(stopped) if stopped.stop.is_precision() => {
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

/// The boundary conditions and the functions they are made of.
pub(super) fn split(
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
            let rest = square_free.div_exact(&divisor).expect("a common factor divides");
            let (rest, under_roots) = without_roots(without_exponentials(rest, symbols), symbols);
            (cause, function, algebraic.times(&under_roots), Some(rest))
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
            // Zeros of the same function are not compared, as they are the same numbers.
            None => match basis.iter().position(|known| *known == function) {
                Some(known) => vec![known],
                None => {
                    basis.push(function.clone());
                    vec![basis.len() - 1]
                }
            },
        };
        boundaries.push(Boundary { cause, function, algebraic, parts });
    }
    Ok((boundaries, basis))
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

/// Divides a polynomial by the powers of square roots in it. The second result is the product of the numerators of their arguments: it
/// has the zeros of the divisor.
fn without_roots(p: MultiPoly, symbols: &MovingSymbols) -> (MultiPoly, UniPoly) {
    let content = p.monomial_content();
    let (mut monomial, mut under) = (content.clone(), UniPoly::one());
    for i in 0..content.exponents().len() {
        match i.checked_sub(1).and_then(|symbol| symbols.under_root(symbol)) {
            Some((numerator, _)) if content.exponent(i) > 0 => under = under.times(&numerator),
            _ => monomial = monomial.with_exponent(i, 0),
        }
    }
    (p.div_exact_monomial(&monomial).expect("the content divides"), under)
}

/// Brackets in ascending order, those that overlap as one.
pub(super) fn disjoint(mut brackets: Vec<Bracket>) -> Vec<Bracket> {
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
