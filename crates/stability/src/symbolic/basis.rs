//! What cuts the range of a parameter: polynomials whose coefficients are numbers over symbols, and their zeros.

use crate::{Cause, Range};
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::multivariate::are_coprime_in;
use jurist_algebra::poly::{Domain, MultiPoly, SquareFree, isolate_real_roots_in};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{EnclosedPoly, SymbolicPoly, Symbols, enclosed_roots, merged};
use std::sync::Arc;

/// A polynomial in the parameter that is not expanded in the symbols. It may be zero where the parameter is, but is asked for
/// without the powers of it that divide it.
pub(super) trait Unexpanded: EnclosedPoly {
    /// Whether it is zero where the parameter is.
    fn vanishes_at_zero(&self) -> bool;
}

/// A polynomial in the parameter whose coefficients are numbers.
pub(super) enum Condition {
    /// A polynomial over symbols.
    Symbolic(SymbolicPoly),
    /// A polynomial whose coefficients are known by enclosures.
    Enclosed(Arc<dyn Unexpanded>),
}

impl Condition {
    pub fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        match self {
            Condition::Symbolic(p) => p.vanishes_at(x, budget),
            Condition::Enclosed(p) if x.is_zero() => Ok(p.vanishes_at_zero()),
            Condition::Enclosed(p) => p.vanishes_at(x, budget),
        }
    }

    /// The zeros in a range, ascending.
    pub fn roots(&self, range: &Range, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        let (lower, upper) = (range.lower.as_ref(), range.upper.as_ref());
        let p = match self {
            Condition::Symbolic(p) => return p.real_roots_in(lower, upper, budget),
            Condition::Enclosed(p) => p,
        };
        let mut found = enclosed_roots(&(Arc::clone(p) as Arc<dyn EnclosedPoly>), lower, upper, budget)?;
        if p.vanishes_at_zero() && range.contains(&Rational::ZERO) {
            found = merged(found, vec![Real::from(Rational::ZERO)], budget)?;
        }
        Ok(found)
    }
}

/// A boundary condition and the polynomials it is made of.
pub(super) struct Boundary {
    pub cause: Cause,
    pub condition: Condition,
    /// Which polynomials of the basis divide it.
    pub parts: Vec<usize>,
}

impl Boundary {
    /// Whether this is one of its zeros.
    pub fn has(&self, zero: &Zero, budget: &Budget) -> Result<bool, Exhausted> {
        if self.parts.iter().any(|k| zero.parts.contains(k)) {
            return Ok(true);
        }
        let by_root = match (&self.condition, zero.value.algebraic()) {
            (Condition::Symbolic(p), Some(x)) => x.sign_of(p.algebraic().poly()).is_eq(),
            _ => false,
        };
        match zero.value.exact() {
            Some(exact) if !by_root => self.condition.vanishes_at(&exact, budget),
            _ => Ok(by_root),
        }
    }
}

/// How common and repeated zeros of conditions are found.
#[derive(Clone, Copy, Debug)]
pub(super) enum Way {
    /// By factors over the symbols as variables; resultants with more terms are not expanded, and have simple zeros.
    Expanding(u64),
    /// By Euclid's algorithm over the numbers that the symbols stand for: zeros may coincide because of what these numbers are.
    OverNumbers,
}

impl Way {
    /// Asks in one way after the other, as long as zeros are not told apart: resultants with more than `most` terms are first not expanded.
    pub fn in_order<R>(
        symbols: &Symbols,
        most: u64,
        ask: impl Fn(Way) -> Result<R, Exhausted>,
    ) -> Result<R, Exhausted> {
        let ways = [Way::Expanding(most), Way::Expanding(u64::MAX), Way::OverNumbers];
        // Zeros are algebraic numbers where all constants are, which only an expanded polynomial tells.
        let first = usize::from(symbols.are_algebraic());
        let mut stopped = None;
        for &way in &ways[first..] {
            match ask(way) {
                Err(precision) if precision.stop.is_precision() => stopped = stopped.or(Some(precision)),
                found => return found,
            }
        }
        Err(stopped.expect("each way has ended"))
    }

    /// How many terms of a resultant are expanded.
    pub fn most_expanded(self) -> u64 {
        if let Way::Expanding(most) = self { most } else { u64::MAX }
    }

    /// The conditions split in this way; those of [`Way::OverNumbers`] are square-free, and all expanded.
    pub fn split(
        self,
        expanded: Vec<(Cause, SymbolicPoly)>,
        enclosed: Vec<(Cause, Arc<dyn Unexpanded>)>,
        symbols: &Arc<Symbols>,
        budget: &Budget,
    ) -> Result<Split, Exhausted> {
        match self {
            Way::Expanding(_) => Split::new(expanded, enclosed, symbols, budget),
            Way::OverNumbers => Split::over_numbers(expanded, symbols, budget),
        }
    }
}

/// The boundary conditions, and the pairwise coprime polynomials they are made of.
pub(super) struct Split {
    pub boundaries: Vec<Boundary>,
    basis: Vec<Condition>,
    /// Whether the basis has the boundaries' factors without symbols too.
    is_whole: bool,
}

/// A zero of the boundary polynomials, and from which polynomial of the basis it comes.
pub(super) struct Zero {
    pub value: Real,
    parts: Vec<usize>,
}

impl Split {
    /// Conditions as products of pairwise coprime polynomials; those that are not expanded stand for themselves, as the last ones.
    fn new(
        expanded: Vec<(Cause, SymbolicPoly)>,
        enclosed: Vec<(Cause, Arc<dyn Unexpanded>)>,
        symbols: &Arc<Symbols>,
        budget: &Budget,
    ) -> Result<Split, Exhausted> {
        let rests: Vec<MultiPoly> = expanded.iter().map(|(_, b)| b.rest().clone()).collect();
        let parts = budget.enter(|| coprime(&rests, &[0]))?;
        let mut boundaries = Vec::with_capacity(expanded.len() + enclosed.len());
        for (cause, polynomial) in expanded {
            let divides = |part: &MultiPoly| {
                polynomial.rest() == part
                    || (!are_coprime_in(polynomial.rest(), part, 0) && polynomial.rest().gcd(part).degree_in(0) > 0)
            };
            let parts = budget.enter(|| (0..parts.len()).filter(|&k| divides(&parts[k])).collect())?;
            boundaries.push(Boundary { cause, condition: Condition::Symbolic(polynomial), parts });
        }
        let mut basis = Vec::with_capacity(parts.len() + enclosed.len());
        for part in &parts {
            // A factor of a polynomial whose content is not zero has none that is.
            let part = SymbolicPoly::new(part, symbols, budget)?.expect("a factor of what is not zero");
            basis.push(Condition::Symbolic(part));
        }
        for (cause, condition) in enclosed {
            boundaries.push(Boundary {
                cause,
                condition: Condition::Enclosed(Arc::clone(&condition)),
                parts: vec![basis.len()],
            });
            basis.push(Condition::Enclosed(condition));
        }
        Ok(Split { boundaries, basis, is_whole: false })
    }

    /// The same where two polynomials may have a zero in common without a common factor over the symbols as variables.
    fn over_numbers(
        expanded: Vec<(Cause, SymbolicPoly)>,
        symbols: &Arc<Symbols>,
        budget: &Budget,
    ) -> Result<Split, Exhausted> {
        let whole = |p: &SymbolicPoly| p.rest().times(&MultiPoly::from_univariate(p.algebraic().poly(), 0));
        let polynomials: Vec<MultiPoly> = expanded.iter().map(|(_, p)| whole(p)).collect();
        let parts = symbols.coprime_basis(&polynomials, budget)?;
        let mut boundaries = Vec::with_capacity(expanded.len());
        for ((cause, polynomial), own) in expanded.into_iter().zip(&polynomials) {
            let mut divisors = Vec::new();
            for (k, part) in parts.iter().enumerate() {
                if symbols.have_common_zero(own, part, budget)? {
                    divisors.push(k);
                }
            }
            boundaries.push(Boundary { cause, condition: Condition::Symbolic(polynomial), parts: divisors });
        }
        let of_part = |part: &MultiPoly| {
            let part = SymbolicPoly::new(part, symbols, budget)?.expect("a factor of what is not zero");
            Ok(Condition::Symbolic(part))
        };
        let basis = parts.iter().map(of_part).collect::<Result<_, Exhausted>>()?;
        Ok(Split { boundaries, basis, is_whole: true })
    }

    /// All zeros in the range, ascending.
    pub fn zeros(&self, range: &Range, budget: &Budget) -> Result<Vec<Zero>, Exhausted> {
        let (lower, upper) = (range.lower.as_ref(), range.upper.as_ref());
        let mut all: Vec<Real> = Vec::new();
        for boundary in self.boundaries.iter().filter(|_| !self.is_whole) {
            let Condition::Symbolic(polynomial) = &boundary.condition else { continue };
            let roots = isolate_real_roots_in(polynomial.algebraic(), lower, upper, budget)?;
            all = merged(all, roots.into_iter().map(Real::from).collect(), budget)?;
        }
        let mut from: Vec<(usize, Real)> = Vec::new();
        for (k, part) in self.basis.iter().enumerate() {
            let roots = part.roots(range, budget)?;
            from.extend(roots.iter().map(|root| (k, root.clone())));
            all = merged(all, roots, budget)?;
        }
        let part_of = |value: &Real| from.iter().filter(|(_, root)| root.is_same(value)).map(|(k, _)| *k).collect();
        Ok(all.into_iter().map(|value| Zero { parts: part_of(&value), value }).collect())
    }
}

/// The zeros of all these polynomials in a range, ascending, each once.
///
/// Cost: tests for common factors of each pair, greatest common divisors where there are some, and the zeros of the factors.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where some thousand bits do not tell zeros apart.
pub fn zeros_of_all(
    polynomials: Vec<SymbolicPoly>,
    symbols: &Arc<Symbols>,
    range: &Range,
    budget: &Budget,
) -> Result<Vec<Real>, Exhausted> {
    let (lower, upper) = (range.lower.as_ref(), range.upper.as_ref());
    let mut rests: Vec<MultiPoly> = Vec::with_capacity(polynomials.len());
    let mut algebraic: Vec<SquareFree> = Vec::new();
    for p in polynomials {
        if !algebraic.contains(p.algebraic()) {
            algebraic.push(p.algebraic().clone());
        }
        if !rests.contains(p.rest()) {
            rests.push(p.rest().clone());
        }
    }
    let basis = budget.enter(|| coprime(&rests, &[0]))?;
    let of_basis = |part: &MultiPoly| -> Result<Vec<Real>, Exhausted> {
        let part = SymbolicPoly::new(part, symbols, budget)?.expect("a factor of what is not zero");
        part.real_roots_in(lower, upper, budget)
    };
    let mut lists: Vec<Result<Vec<Real>, Exhausted>> = parallel_map(&basis, of_basis);
    for p in &algebraic {
        let roots = isolate_real_roots_in(p, lower, upper, budget)?;
        lists.push(Ok(roots.into_iter().map(Real::from).collect()));
    }
    let mut all = Vec::new();
    for list in lists {
        all = merged(all, list?, budget)?;
    }
    Ok(all)
}

/// Square-free, pairwise coprime polynomials of which all given ones, square-free themselves, are products, as far as factors
/// are concerned in which one of `unknowns` occurs.
pub(super) fn coprime(polynomials: &[MultiPoly], unknowns: &[usize]) -> Vec<MultiPoly> {
    let varies = |p: &MultiPoly| unknowns.iter().any(|&j| p.degree_in(j) > 0);
    let mut basis: Vec<MultiPoly> = Vec::new();
    for p in polynomials {
        let mut part = p.clone();
        let mut k = 0;
        while k < basis.len() && varies(&part) {
            if !unknowns.iter().all(|&j| are_coprime_in(&part, &basis[k], j)) {
                let common = part.gcd(&basis[k]).primitive_over_integers();
                if varies(&common) {
                    let rest = basis[k].div_exact(&common).expect("a gcd divides");
                    part = part.div_exact(&common).expect("a gcd divides");
                    basis[k] = common;
                    if varies(&rest) {
                        basis.push(rest);
                    }
                }
            }
            k += 1;
        }
        if varies(&part) {
            basis.push(part);
        }
    }
    basis
}
