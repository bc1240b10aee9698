//! Real roots of polynomials whose coefficients are polynomials in symbols.

use super::Symbols;
use super::root::{Coefficients, EnclosedPoly, SymbolicRoot, derivative};
use crate::ball::Ball;
use crate::limits::{Budget, Exhausted};
use crate::number::{Enclosure, Integer, Rational, Sign};
use crate::poly::multivariate::is_square_free_in;
use crate::poly::real_roots::isolate_real_roots;
use crate::poly::{
    Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in, simplest_between,
};
use crate::precisions::ZEROS_OVER_SYMBOLS;
use crate::real::{Real, Transcendental};
use std::sync::Arc;

/// Bits with which most numbers that are not zero show it.
const FEW_BITS: u64 = 512;

/// A rational number of so few bits in an interval as narrow is hardly there by chance.
const CANDIDATE_BITS: u64 = 96;

/// A polynomial over symbols, split into what does not depend on them and the rest.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_algebra::symbols::{Definition, SymbolicPoly, Symbols};
/// use std::sync::Arc;
/// let mut symbols = Symbols::new();
/// symbols.insert("X", Definition::exponential(-1));
/// // (K - 3) (K - X) with K as variable 0 and X = exp(-1) as variable 1
/// let (k, x) = (MultiPoly::variable(0), MultiPoly::variable(1));
/// let p = k.minus(&MultiPoly::constant(3.into())).times(&k.minus(&x));
/// let p = SymbolicPoly::new(&p, &Arc::new(symbols), &Budget::unlimited()).unwrap().unwrap();
/// let roots = p.real_roots_in(None, None, &Budget::unlimited()).unwrap();
/// assert_eq!((roots[0].decimal(6), roots[1].decimal(6)), ("0.367879".into(), "3".into()));
/// assert!(roots[0].exact().is_none() && roots[1].exact().is_some());
/// ```
#[derive(Clone, Debug)]
pub struct SymbolicPoly {
    symbols: Arc<Symbols>,
    algebraic: SquareFree,
    rest: MultiPoly,
}

impl SymbolicPoly {
    /// The polynomial in an unknown (variable 0) and symbols (symbol `i` is variable `i + 1`), with factors in which the
    /// unknown occurs once only; `None` where it vanishes for every value of the unknown.
    ///
    /// Cost: the signs of coefficients until one is not zero, and a few checks of polynomials in one variable; greatest common
    /// divisors in several variables where a factor is repeated.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the sign of a constant is not found.
    pub fn new(p: &MultiPoly, symbols: &Arc<Symbols>, budget: &Budget) -> Result<Option<SymbolicPoly>, Exhausted> {
        if p.is_zero() {
            return Ok(None);
        }
        // A polynomial is zero where all its coefficients are. That one is not mostly shows with few bits.
        let in_unknown = p.as_poly_in(0);
        let shows = |c: &MultiPoly| !symbols.enclose(&of_symbols(c), FEW_BITS).contains_zero();
        let mut is_zero = !budget.enter(|| in_unknown.coeffs().iter().rev().any(shows))?;
        for coefficient in in_unknown.coeffs().iter().rev().filter(|_| is_zero) {
            if !symbols.is_zero(&of_symbols(coefficient), budget)? {
                is_zero = false;
                break;
            }
        }
        if is_zero {
            return Ok(None);
        }
        let primitive = budget.enter(|| {
            let monomial = p.monomial_content();
            let repeated = monomial.with_exponent(0, monomial.exponent(0).saturating_sub(1));
            // Symbols that are factors of all coefficients are not zero then; K^2 is K.
            let p = p.div_exact_monomial(&repeated).expect("the content divides").primitive_over_integers();
            if is_square_free_in(&p, 0) { p } else { p.square_free_part() }
        })?;
        let (algebraic, rest) = budget.enter(|| {
            let algebraic = common_factor(&primitive);
            let divisor = MultiPoly::from_univariate(&algebraic, 0);
            (algebraic, primitive.div_exact(&divisor).expect("a common factor divides"))
        })?;
        let algebraic = SquareFree::part_of(&algebraic).expect("not zero");
        Ok(Some(SymbolicPoly { symbols: Arc::clone(symbols), algebraic, rest }))
    }

    /// The factor without symbols.
    pub fn algebraic(&self) -> &SquareFree {
        &self.algebraic
    }

    /// The factor with symbols; constant where there is none.
    pub fn rest(&self) -> &MultiPoly {
        &self.rest
    }

    /// Whether the polynomial is zero at a rational number.
    ///
    /// # Errors
    /// As [`Symbols::sign`].
    pub fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        if self.algebraic.poly().sign_at(x).is_eq() {
            return Ok(true);
        }
        let (value, _) = budget.enter(|| self.rest.substitute(0, x))?;
        self.symbols.is_zero(&of_symbols(&value), budget)
    }

    /// The real roots strictly between two numbers, ascending, each once.
    ///
    /// Cost: enclosures of the coefficients, and the real roots of the two polynomials with the lower and the upper ends of
    /// the coefficients, with more and more bits until they part.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where roots are not told apart with some thousand bits.
    pub fn real_roots_in(
        &self,
        lower: Option<&Rational>,
        upper: Option<&Rational>,
        budget: &Budget,
    ) -> Result<Vec<Real>, Exhausted> {
        let exact = isolate_real_roots_in(&self.algebraic, lower, upper, budget)?;
        let exact = exact.into_iter().map(Real::from).collect();
        let others = real_roots(&self.rest, &self.symbols, lower, upper, budget)?;
        merged(exact, self.algebraic_where_known(others, budget)?, budget)
    }

    /// Roots of the factor with symbols as algebraic numbers, where the symbols are.
    fn algebraic_where_known(&self, roots: Vec<Real>, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        if roots.iter().all(|root| root.exact().is_some()) {
            return Ok(roots);
        }
        let Some(norm) = self.symbols.norm_in_unknown(&self.rest, budget)? else { return Ok(roots) };
        let Some(norm) = budget.enter(|| SquareFree::part_of(&norm))? else { return Ok(roots) };
        let candidates: Vec<Real> = isolate_real_roots(&norm, budget)?.into_iter().map(Real::from).collect();
        let identified = |root: Real| {
            let mut at = root;
            loop {
                // Each root is one of the candidates.
                let (lo, hi) = at.enclosure();
                let inside = |x: &&Real| x.compare_rational(&lo).is_ge() && x.compare_rational(&hi).is_le();
                let mut near = candidates.iter().filter(inside);
                if let (Some(found), None) = (near.next(), near.next()) {
                    return Ok(found.clone());
                }
                budget.check()?;
                at = budget.enter(|| at.refined_further())?;
            }
        };
        roots.into_iter().map(identified).collect()
    }
}

/// A polynomial in symbols as the table numbers them, without the unknown.
pub(super) fn of_symbols(p: &MultiPoly) -> MultiPoly {
    p.map_variables(|i| i.saturating_sub(1))
}

/// The greatest divisor in the unknown (variable 0) alone.
pub fn common_factor(p: &MultiPoly) -> UniPoly {
    let mut parts: std::collections::BTreeMap<Vec<u32>, Vec<(Vec<u32>, Integer)>> = Default::default();
    for (monomial, c) in p.terms() {
        let symbols = monomial.with_exponent(0, 0).exponents().to_vec();
        parts.entry(symbols).or_default().push((vec![monomial.exponent(0)], c.clone()));
    }
    let mut common = UniPoly::zero();
    for terms in parts.into_values() {
        let part = MultiPoly::from_terms(terms).to_univariate(0).expect("one variable is left");
        common = common.gcd(&part);
        if common.is_constant() {
            break;
        }
    }
    common.primitive_part()
}

/// Two ascending lists as one, each number once.
pub fn merged(a: Vec<Real>, b: Vec<Real>, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
    let mut out = Vec::with_capacity(a.len() + b.len());
    let (mut a, mut b) = (a.into_iter().peekable(), b.into_iter().peekable());
    while let (Some(x), Some(y)) = (a.peek(), b.peek()) {
        let order = x.compare(y, budget)?;
        if order.is_le() {
            out.extend(a.next());
        }
        if order.is_eq() {
            b.next();
        }
        if order.is_gt() {
            out.extend(b.next());
        }
    }
    out.extend(a);
    out.extend(b);
    Ok(out)
}

/// The real roots between two numbers of a square-free polynomial without factors that are free of symbols.
fn real_roots(
    p: &MultiPoly,
    symbols: &Arc<Symbols>,
    lower: Option<&Rational>,
    upper: Option<&Rational>,
    budget: &Budget,
) -> Result<Vec<Real>, Exhausted> {
    if p.degree_in(0) == 0 {
        return Ok(Vec::new());
    }
    let in_unknown = p.as_poly_in(0);
    let mut list: Vec<MultiPoly> = in_unknown.coeffs().iter().map(of_symbols).collect();
    // Coefficients that vanish although they are no zero polynomials. Between two numbers a last one that may be zero does no harm.
    let may_stay = lower.is_some() && upper.is_some() && symbols.has_enclosed_numbers();
    while !may_stay && list.len() > 1 && symbols.is_zero(&list[list.len() - 1], budget)? {
        list.pop();
    }
    let mut zeros = 0;
    while zeros + 1 < list.len() && symbols.is_zero(&list[zeros], budget)? {
        zeros += 1;
    }
    list.drain(..zeros);
    let others = Arc::new(Coefficients::new(Arc::clone(symbols), list));
    let mut found = enclosed_roots(&(others as Arc<dyn EnclosedPoly>), lower, upper, budget)?;
    let inside = lower.is_none_or(Rational::is_negative) && upper.is_none_or(|u| u.sign().is_gt());
    if zeros > 0 && inside {
        let at = found.partition_point(|root| root.sign().is_lt());
        found.insert(at, Real::from(Rational::ZERO));
    }
    Ok(found)
}

/// The real roots strictly between two numbers of a polynomial with enclosed coefficients, ascending. Its first coefficient must not be
/// zero, nor its last one where one of the two numbers is missing, and its roots must be simple: else the search ends by itself, with an error. A root that is a rational
/// number of few digits is given as that.
///
/// Cost: enclosures of the coefficients, and the real roots of the two polynomials with their lower and their upper ends, with
/// more and more bits until they part.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where roots are not told apart with some thousand bits.
pub fn enclosed_roots(
    p: &Arc<dyn EnclosedPoly>,
    lower: Option<&Rational>,
    upper: Option<&Rational>,
    budget: &Budget,
) -> Result<Vec<Real>, Exhausted> {
    let real = |(lo, hi): (Rational, Rational), mirrored: bool| {
        let (lo, hi) = if mirrored { (-hi, -lo) } else { (lo, hi) };
        let place = Enclosure::new(lo, hi);
        let root = SymbolicRoot { of: Arc::clone(p), place: place.clone() };
        rational_or(Transcendental::within(root, place), &**p, budget)
    };
    let mut out = Vec::new();
    if lower.is_none_or(Rational::is_negative) {
        let near = upper.filter(|u| u.is_negative()).map(|u| -u);
        let far = lower.map(|l| -l);
        let found = positive_roots(&**p, true, near.as_ref(), far.as_ref(), budget)?;
        for bracket in found.into_iter().rev() {
            out.push(real(bracket, true)?);
        }
    }
    if upper.is_none_or(|u| u.sign().is_gt()) {
        let near = lower.filter(|l| l.sign().is_gt());
        for bracket in positive_roots(&**p, false, near, upper, budget)? {
            out.push(real(bracket, false)?);
        }
    }
    Ok(out)
}

/// The root as a rational number where it is one of few digits: polynomials over constants have such roots for reasons that only the
/// constants' values show, as `sqrt(2)^2 = 2`.
fn rational_or(root: Transcendental, p: &dyn EnclosedPoly, budget: &Budget) -> Result<Real, Exhausted> {
    let near = budget.enter(|| root.refined(&Rational::dyadic(&Integer::ONE, CANDIDATE_BITS)))?;
    let (lo, hi) = near.enclosure();
    let bits = |x: &Rational| x.numerator().bit_length() + x.denominator().bit_length();
    match simplest_between(&lo, &hi).filter(|x| bits(x) <= CANDIDATE_BITS) {
        Some(x) if p.vanishes_at(&x, budget)? => Ok(Real::from(x)),
        _ => Ok(Real::from(near)),
    }
}

/// Brackets of the positive roots between `near` (0 where missing) and `far` (unbounded where missing), of `p(x)` or
/// `p(-x)`: in each there is one root, the derivative keeps its sign, and brackets are disjoint.
fn positive_roots(
    p: &dyn EnclosedPoly,
    mirrored: bool,
    near: Option<&Rational>,
    far: Option<&Rational>,
    budget: &Budget,
) -> Result<Vec<(Rational, Rational)>, Exhausted> {
    // A root at an end of the range is none inside, and is told from one by its exact zero.
    let at_end = |x: Option<&Rational>| -> Result<bool, Exhausted> {
        let Some(x) = x.filter(|x| !x.is_zero()) else { return Ok(false) };
        p.vanishes_at(&if mirrored { -x } else { x.clone() }, budget)
    };
    let ends = [at_end(near)?, at_end(far)?];
    let zero = Rational::ZERO;
    ZEROS_OVER_SYMBOLS.decide("isolating real roots", |bits| {
        budget.check()?;
        let attempt = Attempt { bits, near: near.unwrap_or(&zero), far, ends, budget };
        let mut coefficients = budget.enter(|| p.enclose(bits))?;
        if coefficients.len() < 2 {
            return Ok(Some(Vec::new()));
        }
        if mirrored {
            coefficients.iter_mut().skip(1).step_by(2).for_each(|c| *c = c.neg());
        }
        attempt.isolate(&coefficients)
    })
}

/// A number with few bits between two numbers, the smaller one first; `None` where they are equal. The simplest fraction between
/// numbers that agree to hundreds of bits would take as many divisions.
fn short_between(a: &Real, b: &Real, budget: &Budget) -> Result<Option<Rational>, Exhausted> {
    if a.compare(b, budget)?.is_ge() {
        return Ok(None);
    }
    let (mut a, mut b) = (a.clone(), b.clone());
    loop {
        let (lo, hi) = (a.enclosure().1, b.enclosure().0);
        let gap = &hi - &lo;
        if gap.sign().is_gt() {
            let bits = (gap.denominator().bit_length() + 2).saturating_sub(gap.numerator().bit_length());
            let (unit, middle) = (Rational::dyadic(&Integer::ONE, bits), lo.midpoint(&hi));
            let scaled = &middle / &unit;
            return Ok(Some(Rational::from(scaled.floor()) * unit));
        }
        budget.check()?;
        (a, b) = budget.enter(|| (a.refined_further(), b.refined_further()))?;
    }
}

struct Attempt<'a> {
    bits: u64,
    near: &'a Rational,
    far: Option<&'a Rational>,
    /// Whether the ends are roots.
    ends: [bool; 2],
    budget: &'a Budget,
}

/// A function between two polynomials for positive arguments.
struct Band {
    lower: UniPoly,
    upper: UniPoly,
}

impl Band {
    fn new(coefficients: &[Ball]) -> Band {
        let unit = Rational::from(&(Integer::ONE << coefficients.first().map_or(0, Ball::bits)));
        let side = |end: fn(&Ball) -> Rational| {
            Poly::new(coefficients.iter().map(|c| (&end(c) * &unit).numerator()).collect())
        };
        Band { lower: side(Ball::lower), upper: side(Ball::upper) }
    }

    fn sign_at(&self, x: &Rational) -> Option<Sign> {
        if self.lower.sign_at(x).is_gt() {
            Some(Sign::Greater)
        } else if self.upper.sign_at(x).is_lt() {
            Some(Sign::Less)
        } else {
            None
        }
    }

    /// The zeros of either polynomial, ascending.
    fn zeros(&self, lo: &Rational, hi: Option<&Rational>, budget: &Budget) -> Result<Vec<RealAlgebraic>, Exhausted> {
        let mut out: Vec<RealAlgebraic> = Vec::new();
        for side in [&self.lower, &self.upper] {
            let Some(part) = budget.enter(|| SquareFree::part_of(side))? else { continue };
            out.extend(isolate_real_roots_in(&part, Some(lo), hi, budget)?);
        }
        budget.enter(|| out.sort_by(RealAlgebraic::compare))?;
        Ok(out)
    }
}

impl Attempt<'_> {
    /// The brackets; `None` where more bits are needed.
    fn isolate(&self, coefficients: &[Ball]) -> Result<Option<Vec<(Rational, Rational)>>, Exhausted> {
        let may_vanish = |at: usize| coefficients[at].contains_zero();
        if may_vanish(0) || (self.far.is_none() && may_vanish(coefficients.len() - 1)) {
            return Ok(None);
        }
        let (band, slope) = (Band::new(coefficients), Band::new(&derivative(coefficients)));
        let zeros = band.zeros(self.near, self.far, self.budget)?;
        if zeros.is_empty() {
            return Ok(self.sign_between(&band, None, None)?.map(|_| Vec::new()));
        }
        let mut out: Vec<(Rational, Rational)> = Vec::new();
        // From a stretch of certain sign to the next: the first and the last zero between them.
        let mut first = 0;
        // Where the range begins at a root, the sign beside it is not known before the first stretch.
        let mut sign = self.sign_between(&band, None, zeros.first())?;
        for i in 0..zeros.len() {
            let next = self.sign_between(&band, Some(&zeros[i]), zeros.get(i + 1))?;
            let is_last = i + 1 == zeros.len();
            if next.is_none() && !is_last {
                continue;
            }
            let touches = [first == 0 && sign.is_none(), next.is_none()];
            let clear = match touches {
                // A root at an end of the range disturbs its neighbourhood, in which there is no other where the slope
                // keeps its sign.
                [true, _] if self.ends[0] => self.around(&zeros[first], &zeros[i], &slope, Some(0))?.is_some(),
                [_, true] if self.ends[1] => self.around(&zeros[first], &zeros[i], &slope, Some(1))?.is_some(),
                [false, false] if sign != next => match self.around(&zeros[first], &zeros[i], &slope, None)? {
                    Some((lo, hi)) if band.sign_at(&lo) == sign && band.sign_at(&hi) == next => {
                        out.push((lo, hi));
                        true
                    }
                    _ => false,
                },
                _ => false,
            };
            if !clear {
                return Ok(None);
            }
            (first, sign) = (i + 1, next);
        }
        let disjoint = out.windows(2).all(|pair| pair[0].1 < pair[1].0);
        let inside = out.iter().all(|(lo, hi)| lo > self.near && self.far.is_none_or(|far| hi < far));
        Ok((disjoint && inside).then_some(out))
    }

    /// The certain sign between two neighbouring zeros, or beside the first or the last.
    fn sign_between(
        &self,
        band: &Band,
        after: Option<&RealAlgebraic>,
        before: Option<&RealAlgebraic>,
    ) -> Result<Option<Sign>, Exhausted> {
        let real = |x: &RealAlgebraic| Real::from(x.clone());
        let after = after.map_or_else(|| Real::from(self.near.clone()), real);
        let before = before.map(real).or_else(|| self.far.cloned().map(Real::from));
        let sample = match before {
            None => Some(after.rational_above()),
            Some(before) => short_between(&after, &before, self.budget)?,
        };
        Ok(sample.and_then(|x| band.sign_at(&x)))
    }

    /// A short interval around two zeros on which the slope keeps its sign; at an end of the range where there is one.
    fn around(
        &self,
        first: &RealAlgebraic,
        last: &RealAlgebraic,
        slope: &Band,
        end: Option<usize>,
    ) -> Result<Option<(Rational, Rational)>, Exhausted> {
        let width = Rational::dyadic(&Integer::ONE, self.bits);
        let (lo, _) = self.budget.enter(|| first.refined(&width))?.enclosure();
        let (_, hi) = self.budget.enter(|| last.refined(&width))?.enclosure();
        let room = (&hi - &lo).max(width);
        let (mut lo, mut hi) = (&lo - &room, &hi + &room);
        match (end, self.far) {
            (Some(0), _) => lo = self.near.clone(),
            (Some(_), Some(far)) => hi = far.clone(),
            _ => {}
        }
        if lo < *self.near {
            return Ok(None);
        }
        let keeps = |side: &UniPoly, sign: Sign| -> Result<bool, Exhausted> {
            if side.sign_at(&lo) != sign || side.sign_at(&hi) != sign {
                return Ok(false);
            }
            let Some(part) = self.budget.enter(|| SquareFree::part_of(side))? else { return Ok(false) };
            Ok(isolate_real_roots_in(&part, Some(&lo), Some(&hi), self.budget)?.is_empty())
        };
        let monotone = keeps(&slope.lower, Sign::Greater)? || keeps(&slope.upper, Sign::Less)?;
        Ok(monotone.then_some((lo, hi)))
    }
}
