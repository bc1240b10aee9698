//! All values of a parameter that enters anywhere in a loop with dead time: polynomially in the coefficients, linearly in the
//! dead time, or as the decay rate that is asked for.

use super::count::{DelayCount, count_from_line};
use super::enclosed::{Enclosed, enclosed_gains};
use super::family_function::{Line, upper_exponential};
use super::family_zeros::{Coordinate, CoordinateOf, FamilyZero, zeros};
use super::gain::{GainCells, NotSolved, cells_between, difference_points};
use super::gain_points::{Beyond, GainPoint, Happening};
use super::mikhailov::NotCounted;
use super::quasi_polynomial::{QuasiPolynomial, even_odd};
use super::strip::frequency_bound_over;
use super::windows::Never;
use crate::interval_set::zeros_in;
use crate::precisions::{CONSTANTS_BESIDE_DEAD_TIME, ZERO_AT_EDGE};
use crate::{Range, RootCount, Shape, count_roots};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, RealAlgebraic, UniPoly};
use jurist_algebra::real::{Real, Transcendental};
use std::sync::Arc;

/// `sum P_k(s; p) z^k` with `z = exp(-tau(p) (s - decay(p)))`: a loop with one parameter `p`, `s` being counted from the line
/// `Re s = -decay`.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::dead_time::{FamilyLoop, Line};
/// // s + p + p^2 exp(-p s)
/// let c = |c: &[i64]| UniPoly::from_i64(c);
/// let parts = vec![vec![c(&[0, 1]), c(&[1])], vec![c(&[0, 0, 1])]];
/// let tau = Line { slope: 1.into(), offset: 0.into() };
/// let family = FamilyLoop::new(parts, tau, Line::constant(0.into()));
/// assert_eq!(family.at(&3.into()).unwrap().parts()[1], UniPoly::from_i64(&[9]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FamilyLoop {
    /// The coefficient of `z^k s^j` at `[k][j]`, polynomials in the parameter.
    pub(super) parts: Vec<Vec<UniPoly>>,
    /// Where they are enclosed, how far they may be off.
    pub(super) enclosed: Option<Enclosed>,
    pub(super) tau: Line,
    pub(super) decay: Line,
    /// `s` is in units of the parameter.
    pub(super) is_stretched: bool,
}

impl FamilyLoop {
    /// The loop of the coefficients of `z^k s^j` at `[k][j]`.
    ///
    /// # Panics
    /// When all of them are zero.
    pub fn new(parts: Vec<Vec<UniPoly>>, tau: Line, decay: Line) -> FamilyLoop {
        FamilyLoop { parts: trimmed(parts), enclosed: None, tau, decay, is_stretched: false }
    }

    /// The quasi-polynomial at one value, from the line; `None` where it vanishes identically.
    pub fn at(&self, value: &Rational) -> Option<QuasiPolynomial> {
        let degree = self.degree();
        let (n, d) = (value.numerator(), value.denominator());
        let number = |c: &UniPoly| {
            c.coeffs()
                .iter()
                .enumerate()
                .fold(Integer::ZERO, |sum, (i, c)| sum + &(c * &n.pow(i as u64)) * &d.pow((degree - i) as u64))
        };
        let part = |list: &Vec<UniPoly>| UniPoly::new(list.iter().map(number).collect());
        QuasiPolynomial::new(self.parts.iter().map(part).collect())
    }

    /// The dead time at one value.
    pub fn dead_time(&self, value: &Rational) -> Rational {
        self.tau.at(value)
    }

    /// True if roots are counted from the imaginary axis.
    pub(super) fn is_from_axis(&self) -> bool {
        self.decay.is_zero()
    }

    /// The highest power of `s`.
    pub fn order(&self) -> usize {
        self.parts[0].len() - 1
    }

    /// The degree in the parameter.
    pub(super) fn degree(&self) -> usize {
        self.parts.iter().chain(self.errors()).flatten().filter_map(UniPoly::degree).max().unwrap_or(0)
    }

    /// `tau decay` at one value: `z = exp(-tau s) exp(tau decay)`.
    pub(super) fn growth(&self, value: &Rational) -> Rational {
        self.tau.at(value) * self.decay.at(value)
    }

    /// The roots on the line and to the right of it at one value; `None` where the function vanishes.
    ///
    /// # Errors
    /// [`NotCounted`].
    pub fn count(&self, value: &Rational, budget: &Budget) -> Result<Option<DelayCount>, NotCounted> {
        let seen = |bits| {
            let family = self.with_bits(bits);
            Ok::<_, NotCounted>(family.keeps_clear_at(value, budget)?.then_some(family))
        };
        let p = match self.enclosed {
            Some(_) => CONSTANTS_BESIDE_DEAD_TIME.decide("roots beside constants", seen)?.at(value),
            None => self.at(value),
        };
        let Some(p) = p else { return Ok(None) };
        let DelayCount { on, right } = count_from_line(&p, &self.tau.at(value), &self.growth(value), budget)?;
        let fixed = self.enclosed.as_ref().map_or(RootCount::default(), |enclosed| enclosed.known.fixed);
        Ok(Some(DelayCount { on: on + fixed.on, right: right.map(|right| right + fixed.outside) }))
    }

    /// The roots to the right where none is on the line; `None` where there are infinitely many, or the function vanishes.
    fn right(&self, value: &Rational, budget: &Budget) -> Result<Option<usize>, NotSolved> {
        match self.count(value, budget) {
            Ok(count) => Ok(count.filter(|count| count.on == 0).and_then(|count| count.right)),
            Err(NotCounted::Neutral) => Err(NotSolved::Neutral),
            Err(reason) => Err(reason.into()),
        }
    }

    /// The loop in the reciprocal of the parameter.
    pub(super) fn reversed(&self) -> FamilyLoop {
        let degree = self.degree();
        let reversed = move |_: usize, c: &UniPoly| c.reversed(degree);
        self.mapped(reversed, self.tau.clone())
    }
}

/// Parts of one length, without powers of `z` before the first part and after the last one.
///
/// # Panics
/// When all coefficients are zero.
pub(super) fn trimmed<R: Domain>(mut parts: Vec<Vec<R>>) -> Vec<Vec<R>> {
    let order = parts.iter().filter_map(|part| part.iter().rposition(|c| !c.is_zero())).max();
    let order = order.expect("the function is not zero");
    parts.iter_mut().for_each(|part| part.resize(order + 1, R::zero()));
    while parts.last().is_some_and(|part| part.iter().all(R::is_zero)) {
        parts.pop();
    }
    let first = parts.iter().position(|part| part.iter().any(|c| !c.is_zero())).expect("the function is not zero");
    parts.drain(..first);
    parts
}

/// The cells of a range of the parameter, or why there is none in which the loop is stable.
///
/// Roots on the line are the zeros of one complex function of two real variables, the frequency and the parameter; they are
/// isolated in boxes with proof, and as all of them are regular, roots cross there, one by one and in a known direction. One
/// count in each of the gaps between the other boundaries gives all counts.
///
/// Cost: that of the boxes, a few hundred evaluations for a loop of order 3.
///
/// # Errors
/// [`NotSolved`]: among others [`NotSolved::Unbounded`] where roots are on the line at frequencies without bound,
/// [`NotSolved::Coincidence`] where they meet there or touch it.
pub fn family_cells(
    family: &FamilyLoop,
    range: &Range,
    budget: &Budget,
) -> Result<Result<GainCells, Never>, NotSolved> {
    budget.step("quasi-polynomial");
    let zero = Rational::ZERO;
    let mut range = range.clone();
    if !family.decay.slope.is_zero() && range.upper.is_none() {
        // More and more roots are to the right while the line moves left. Roots that are cancelled lie at round numbers.
        let step = Rational::new(33.into(), 32.into());
        let mut upper = range.lower.clone().unwrap_or(zero.clone()).max(zero.clone()) + step;
        loop {
            budget.check()?;
            if family.right(&upper, budget)? != Some(0) {
                break;
            }
            upper = &upper + &upper;
        }
        range.upper = Some(upper);
    }
    let Some(enclosed) = &family.enclosed else { return cells_of(family, &range, budget) };
    if let Some(never) = enclosed.known.never(family.is_from_axis()) {
        return Ok(Err(never));
    }
    let found = CONSTANTS_BESIDE_DEAD_TIME.find(|bits| match cells_of(&family.with_bits(bits), &range, budget) {
        Err(NotSolved::Coincidence) => Ok(None),
        found => found.map(Some),
    });
    // Next to a lost power of s, or far away, roots meet on the line at frequencies without end.
    found?.ok_or(match (&range.lower, &range.upper) {
        (Some(_), Some(_)) => NotSolved::Coincidence,
        _ => NotSolved::Unbounded,
    })
}

/// The cells with the coefficients as they are.
fn cells_of(family: &FamilyLoop, range: &Range, budget: &Budget) -> Result<Result<GainCells, Never>, NotSolved> {
    let moves = !family.tau.slope.is_zero() || !family.decay.slope.is_zero();
    match (&range.lower, &range.upper) {
        (Some(_), Some(_)) => piece(family, range, budget),
        _ if moves => Err(NotSolved::Unbounded),
        _ if family.enclosed.is_some() => match enclosed_gains(family, range, budget) {
            Err(NotSolved::Unbounded) => unbounded(family, range, budget),
            found => found,
        },
        _ => unbounded(family, range, budget),
    }
}

impl FamilyLoop {
    /// The loop with `s` in units of the parameter, a number that is positive: roots that go to `s = 0` together with it stay.
    /// The line is the imaginary axis, and the dead time a number.
    fn stretched(&self) -> FamilyLoop {
        assert!(self.decay.is_zero() && self.tau.slope.is_zero(), "another line would not stay");
        let lowest = |(j, c): (usize, &UniPoly)| Some(j + c.coeffs().iter().position(|x| !x.is_zero())?);
        let all = self.parts.iter().chain(self.errors());
        let common = all.flat_map(|part| part.iter().enumerate().filter_map(lowest)).min().unwrap_or(0);
        let stretched =
            move |j: usize, c: &UniPoly| UniPoly::new(c.shifted_up(j).coeffs().iter().skip(common).cloned().collect());
        let tau = Line { slope: self.tau.offset.clone(), offset: Rational::ZERO };
        FamilyLoop { is_stretched: true, ..self.mapped(stretched, tau) }
    }
}

/// The cells of a range of the reciprocal of the parameter from zero on, or down to zero.
fn outer(reversed: &FamilyLoop, range: &Range, budget: &Budget) -> Result<Result<GainCells, Never>, NotSolved> {
    match piece(reversed, range, budget) {
        // Roots may go to s = 0 there, as those of a loop with a time constant that grows.
        Err(reason @ (NotSolved::Coincidence | NotSolved::Unbounded))
            if range.lower == Some(Rational::ZERO) && reversed.decay.is_zero() =>
        {
            match piece(&reversed.stretched(), range, budget) {
                Err(NotSolved::Coincidence | NotSolved::Unbounded) => Err(match reversed.enclosed {
                    // More bits of the coefficients tell no more at its end.
                    Some(_) => NotSolved::Unbounded,
                    None => reason,
                }),
                other => other,
            }
        }
        other => other,
    }
}

/// A range without an end by pieces: beyond a number the reciprocal of the parameter is in a range with ends.
fn unbounded(family: &FamilyLoop, range: &Range, budget: &Budget) -> Result<Result<GainCells, Never>, NotSolved> {
    let reversed = family.reversed();
    let end = |beyond: &Option<Rational>, sign: i64| -> Result<Option<Rational>, NotSolved> {
        if beyond.is_some() {
            return Ok(beyond.clone());
        }
        // A number at which nothing happens.
        let mut at =
            [&range.lower, &range.upper].into_iter().flatten().map(Rational::abs).max().unwrap_or(Rational::ZERO)
                + Rational::ONE;
        loop {
            budget.check()?;
            let value = &at * &Rational::from(sign);
            let quiet = family.at(&value).is_some_and(|p| {
                count_roots(&p.content(), Shape::LeftHalfPlane).on == 0 && !p.without_delay().coeff(0).is_zero()
            });
            if quiet {
                return Ok(Some(value));
            }
            at += Rational::new(1.into(), 32.into());
        }
    };
    let (low, high) = (end(&range.lower, -1)?, end(&range.upper, 1)?);
    let middle = Range { lower: low.clone(), upper: high.clone() };
    let mut whole = match piece(family, &middle, budget)? {
        Ok(cells) => cells,
        Err(never) => return Ok(Err(never)),
    };
    let recip = |x: &Option<Rational>| x.as_ref().and_then(Rational::recip);
    if range.upper.is_none() {
        let beyond = Range { lower: Some(Rational::ZERO), upper: recip(&high) };
        match outer(&reversed, &beyond, budget)? {
            Ok(cells) => {
                let mut cells = inverted(cells)?;
                whole.points.append(&mut cells.points);
                // The cell about the joint is one.
                whole.right.extend(cells.right.into_iter().skip(1));
            }
            Err(never) => return Ok(Err(never)),
        }
    }
    if range.lower.is_none() {
        let beyond = Range { lower: recip(&low), upper: Some(Rational::ZERO) };
        match outer(&reversed, &beyond, budget)? {
            Ok(cells) => {
                let mut cells = inverted(cells)?;
                cells.right.pop();
                cells.points.append(&mut whole.points);
                cells.right.append(&mut whole.right);
                whole = cells;
            }
            Err(never) => return Ok(Err(never)),
        }
    }
    Ok(Ok(whole))
}

/// Cells in the reciprocal of the parameter as cells in the parameter.
fn inverted(mut cells: GainCells) -> Result<GainCells, NotSolved> {
    cells.points.reverse();
    cells.right.reverse();
    for point in &mut cells.points {
        point.value = point.inverse.take().ok_or(NotSolved::Unbounded)?;
        point.change = point.change.map(|change| -change);
    }
    Ok(cells)
}

/// A range with both ends.
pub(super) fn piece(
    family: &FamilyLoop,
    range: &Range,
    budget: &Budget,
) -> Result<Result<GainCells, Never>, NotSolved> {
    let (Some(lower), Some(upper)) = (&range.lower, &range.upper) else { return Err(NotSolved::Unbounded) };
    if lower >= upper {
        return Ok(Ok(GainCells { points: Vec::new(), right: vec![None] }));
    }
    // Of the axis roots at s = 0 are algebraic points.
    let takes_real = !family.is_from_axis() || family.enclosed.is_some();
    let mut points = match algebraic_points(family, range, budget)? {
        Ok(points) => points,
        Err(never) => return Ok(Err(never)),
    };
    let weights = budget.enter(|| family.weights([lower, upper]))?;
    let frequency = family.beyond_crossings(&weights, range, budget)?;
    let Some(frequency) = frequency else { return Err(NotSolved::Unbounded) };
    let function = Arc::new(budget.enter(|| family.function())?);
    let Some(found) = zeros(&function, &frequency, lower, upper, budget)? else {
        return Err(NotSolved::Coincidence);
    };
    let plain = without_delayed_terms(family, range, budget)?;
    for zero in found {
        let is_real = budget.enter(|| zero.is_real())?;
        if is_real && !takes_real {
            continue;
        }
        if !is_real && budget.enter(|| is_below_zero(&zero))? {
            continue;
        }
        if !budget.enter(|| inside(family, &zero, lower, upper))?? {
            continue;
        }
        let step = match zero.motion {
            Sign::Greater => 1,
            Sign::Less => -1,
            Sign::Equal => unreachable!("a regular zero"),
        };
        let exact = budget.enter(|| match plain.is_empty() {
            true => None,
            false => {
                let [omega, p] = zero.enclosures(ZERO_AT_EDGE.last);
                plain.iter().find(|value| is_fixed_at(family, [&omega, &p], value))
            }
        })?;
        let zero = Arc::new(zero);
        let coordinate =
            |which: Coordinate| Real::from(Transcendental::new(CoordinateOf { zero: Arc::clone(&zero), which }));
        let frequency = if family.is_stretched { Coordinate::Product } else { Coordinate::Frequency };
        let (happening, change) =
            if is_real { (Happening::RootAtZero, step) } else { (Happening::Pair(coordinate(frequency)), 2 * step) };
        // The sign of a zero that is 0 never shows from enclosures.
        let (value, inverse) = match exact {
            Some(value) => (value.clone().into(), value.recip().map(Real::from)),
            None => (coordinate(Coordinate::Parameter), Some(coordinate(Coordinate::Reciprocal))),
        };
        points.push(GainPoint { value, happening, change: Some(change), inverse });
    }
    cells_between(range, points, &Beyond::default(), &|value| family.right(value, budget), budget).map(Ok)
}

impl FamilyLoop {
    /// A frequency beyond which no root is on the line for any value of a closed range; `None` where none is known.
    pub(super) fn beyond_crossings(
        &self,
        weights: &[Rational],
        range: &Range,
        budget: &Budget,
    ) -> Result<Option<Rational>, Exhausted> {
        if let (Some(_), Some(lower), Some(upper)) = (&self.enclosed, &range.lower, &range.upper) {
            let quick = budget.enter(|| self.frequency_bound(weights, [lower, upper]))?;
            if quick.is_some() {
                return Ok(quick);
            }
        }
        frequency_bound_over(&self.parts, self.errors(), weights, range, budget)
    }

    /// Bounds of the moduli of the powers of `z` on the line, for all values of a range.
    pub(super) fn weights(&self, ends: [&Rational; 2]) -> Vec<Rational> {
        let most = |line: &Line| line.at(ends[0]).abs().max(line.at(ends[1]).abs());
        let one = match self.is_from_axis() {
            true => Rational::ONE,
            false => upper_exponential(&(most(&self.tau) * most(&self.decay))),
        };
        (0..self.parts.len()).map(|k| one.pow(k as i64).expect("not zero")).collect()
    }
}

/// The values in a range that are roots of polynomials: with a root at `s = 0`, for the imaginary axis, or a zero of the difference operator
/// on the unit circle.
fn algebraic_points(
    family: &FamilyLoop,
    range: &Range,
    budget: &Budget,
) -> Result<Result<Vec<GainPoint>, Never>, NotSolved> {
    let mut points = Vec::new();
    if family.enclosed.is_some() {
        // Where the highest power outweighs all else, which is asked next, nothing else is algebraic.
        return Ok(Ok(points));
    }
    if family.is_from_axis() {
        let at_zero = family.parts.iter().fold(UniPoly::zero(), |sum, part| sum.plus(&part[0]));
        if at_zero.is_zero() {
            return Ok(Err(Never::RootAtZero));
        }
        for value in zeros_in(&at_zero, range, budget)? {
            points.push(GainPoint::algebraic(value, Happening::RootAtZero, budget)?);
        }
    }
    let top: Vec<UniPoly> = family.parts.iter().map(|part| part[family.order()].clone()).collect();
    if !family.is_from_axis() && top.iter().skip(1).any(|c| !c.is_zero()) {
        return Err(NotSolved::Neutral);
    }
    let Some((values, happening)) = difference_points(top, range, budget)? else { return Ok(Err(Never::Neutral)) };
    for value in values {
        points.push(GainPoint::algebraic(value, happening.clone(), budget)?);
    }
    Ok(Ok(points))
}

/// Whether the frequency of a zero that is not real is negative.
fn is_below_zero(zero: &FamilyZero) -> bool {
    let sign = ZERO_AT_EDGE.bits().find_map(|bits| {
        let [omega, _] = zero.enclosures(bits);
        (!omega.contains(&Rational::ZERO)).then(|| omega.upper().is_negative())
    });
    sign.unwrap_or(false)
}

/// Whether a zero is strictly inside of the range. One on an end is a root of the loop there that depends on no dead time.
fn inside(family: &FamilyLoop, zero: &FamilyZero, lower: &Rational, upper: &Rational) -> Result<bool, NotSolved> {
    let found = ZERO_AT_EDGE.bits().find_map(|bits| {
        let [omega, p] = zero.enclosures(bits);
        if p.upper() < lower || p.lower() > upper {
            return Some(false);
        }
        if p.lower() > lower && p.upper() < upper {
            return Some(true);
        }
        [lower, upper].into_iter().any(|end| is_fixed_at(family, [&omega, &p], end)).then_some(false)
    });
    found.ok_or(NotSolved::Coincidence)
}

/// Whether the zero in an enclosure, which is the only one there, is at a value of the parameter at which a root lies on the line whatever the dead time is.
fn is_fixed_at(family: &FamilyLoop, [omega, p]: [&Enclosure; 2], value: &Rational) -> bool {
    if !p.contains(value) {
        return false;
    }
    let Some(at) = family.at(value) else { return false };
    let fixed = if family.tau.at(value).is_zero() { at.without_delay() } else { at.content() };
    if family.enclosed.is_some() {
        return omega.contains(&Rational::ZERO)
            && family.growth(value).is_zero()
            && family.is_exact_at_zero(value)
            && at.without_delay().coeff(0).is_zero();
    }
    // Without a delayed term the line does not matter.
    let is_plain = family.growth(value).is_zero() || at.delays() == 0;
    if omega.contains(&Rational::ZERO) && is_plain && at.without_delay().coeff(0).is_zero() {
        return true;
    }
    let (even, odd) = even_odd(&fixed);
    let common = even.gcd(&odd);
    let square = |x: &Rational| -(x * x);
    let (a, b) = (square(omega.upper()), square(omega.lower()));
    !common.is_constant() && common.sign_at(&a) != common.sign_at(&b)
}

/// The rational values in a range at which no delayed term is left.
fn without_delayed_terms(family: &FamilyLoop, range: &Range, budget: &Budget) -> Result<Vec<Rational>, NotSolved> {
    let delayed = family.parts[1..].iter().flatten();
    let common = budget.enter(|| delayed.fold(UniPoly::zero(), |common, c| common.gcd(c)))?;
    if common.degree().unwrap_or(0) == 0 {
        return Ok(Vec::new());
    }
    Ok(zeros_in(&common, range, budget)?.iter().filter_map(RealAlgebraic::exact).collect())
}
