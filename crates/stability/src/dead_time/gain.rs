//! All values of a parameter for which a loop with a fixed dead time is stable, where the parameter enters affinely.

use super::family::FamilyLoop;
use super::family_function::Line;
use super::gain_inverse::inverse_cells;
use super::gain_points::{Beyond, GainPoint, Happening, crossings_of_gain};
use super::mikhailov::{NotCounted, roots_right};
use super::quasi_polynomial::QuasiPolynomial;
use super::windows::Never;
use crate::interval_set::{merge_points, real_cells, zeros_in};
use crate::{ParametricPolynomial, Range, Shape, boundary_polynomials, count_roots};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// `sum (A_k(s) + K B_k(s)) z^k` with `z = exp(-tau s)` at a rational dead time.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::dead_time::GainLoop;
/// // s + 1 + K exp(-s)
/// let p = |c: &[i64]| UniPoly::from_i64(c);
/// let gain = GainLoop::new(vec![p(&[1, 1]), p(&[])], vec![p(&[]), p(&[1])], 1.into());
/// assert_eq!(gain.at(&2.into()).unwrap().parts()[1], p(&[2]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GainLoop {
    pub(super) a: Vec<UniPoly>,
    pub(super) b: Vec<UniPoly>,
    pub(super) tau: Rational,
}

/// Why the values of a parameter are not told.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotSolved {
    /// The budget ran out, or a count was not possible.
    NotCounted(NotCounted),
    /// The domain has no end, and the parameter enters in more than one delayed term.
    Unbounded,
    /// A neutral loop whose difference operator depends on the parameter in more than one delayed term, or is large.
    Neutral,
    /// A root stays on the axis while something else changes, at an algebraic frequency.
    Coincidence,
}

impl From<NotCounted> for NotSolved {
    fn from(reason: NotCounted) -> Self {
        NotSolved::NotCounted(reason)
    }
}

impl From<Exhausted> for NotSolved {
    fn from(exhausted: Exhausted) -> Self {
        NotSolved::NotCounted(exhausted.into())
    }
}

/// How a range of the parameter falls into cells of constant root count.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GainCells {
    /// Where roots are on the axis, or the difference operator stops being stable; ascending.
    pub points: Vec<GainPoint>,
    /// The number of roots right of the axis in each cell, one more than points; `None` for infinitely many, or for at least
    /// two at which the cell need not be looked at any further.
    pub right: Vec<Option<usize>>,
}

impl GainCells {
    /// One cell of values that all have the same roots.
    pub fn constant(is_stable: bool) -> GainCells {
        GainCells { points: Vec::new(), right: vec![is_stable.then_some(0)] }
    }

    /// Cuts the cells where the loop is undefined as well: at the zeros of these polynomials in the range of the cells.
    ///
    /// ```
    /// use jurist_algebra::{limits::Budget, poly::UniPoly};
    /// use jurist_stability::{Range, dead_time::GainCells};
    /// let mut cells = GainCells::constant(true);
    /// let pole = UniPoly::from_i64(&[-1, 1]);
    /// cells.cut_at_poles(&[pole], &Range::all(), &Budget::unlimited()).unwrap();
    /// assert_eq!((cells.points.len(), cells.right), (1, vec![Some(0), Some(0)]));
    /// ```
    ///
    /// Cost: comparisons of `O(n)` values for each zero.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn cut_at_poles(&mut self, poles: &[UniPoly], range: &Range, budget: &Budget) -> Result<(), Exhausted> {
        for pole in poles {
            for zero in zeros_in(pole, range, budget)? {
                let pole = GainPoint { change: Some(0), ..GainPoint::counted(zero.into(), Happening::Pole) };
                match place_of(&self.points, &pole.value, budget)? {
                    Ok(known) if matches!(self.points[known].happening, Happening::Pole) => {}
                    Ok(known) => self.points[known].join(pole),
                    Err(at) => {
                        self.points.insert(at, pole);
                        self.right.insert(at, self.right[at]);
                    }
                }
            }
        }
        Ok(())
    }
}

impl GainLoop {
    /// The loop of the parts with and without the parameter, as many of each, at a positive dead time.
    ///
    /// # Panics
    /// When the dead time is not positive, the lists differ in length, or all parts are zero.
    pub fn new(mut a: Vec<UniPoly>, mut b: Vec<UniPoly>, tau: Rational) -> GainLoop {
        assert!(tau.sign().is_gt() && a.len() == b.len(), "a positive dead time and as many parts");
        while a.last().is_some_and(UniPoly::is_zero) && b.last().is_some_and(UniPoly::is_zero) {
            a.pop();
            b.pop();
        }
        let first = a.iter().zip(&b).position(|(a, b)| !a.is_zero() || !b.is_zero()).expect("the function is not zero");
        a.drain(..first);
        b.drain(..first);
        GainLoop { a, b, tau }
    }

    /// The same as a family whose parameter may enter in any way.
    pub fn family(&self) -> FamilyLoop {
        let part = |(a, b): (&UniPoly, &UniPoly)| {
            let count = a.coeffs().len().max(b.coeffs().len());
            (0..count).map(|j| UniPoly::new(vec![a.coeff(j), b.coeff(j)])).collect()
        };
        let parts = self.a.iter().zip(&self.b).map(part).collect();
        FamilyLoop::new(parts, Line::constant(self.tau.clone()), Line::constant(Rational::ZERO))
    }

    /// The quasi-polynomial at one value; `None` where it vanishes identically.
    pub fn at(&self, value: &Rational) -> Option<QuasiPolynomial> {
        let (p, q) = (value.numerator(), value.denominator());
        let parts = self.a.iter().zip(&self.b).map(|(a, b)| a.scaled(&q).plus(&b.scaled(&p)));
        QuasiPolynomial::new(parts.collect())
    }

    /// The highest power of `s`, whatever the parameter is.
    pub fn order(&self) -> usize {
        self.a.iter().chain(&self.b).filter_map(UniPoly::degree).max().unwrap_or(0)
    }

    /// The coefficient of `z^k s^j` at `[k][j]`, a polynomial in the parameter.
    pub(super) fn coefficients(&self) -> Vec<Vec<UniPoly>> {
        let n = self.order();
        let both = self.a.iter().zip(&self.b);
        both.map(|(a, b)| (0..=n).map(|j| UniPoly::new(vec![a.coeff(j), b.coeff(j)])).collect()).collect()
    }

    /// The coefficients of the highest power of `s`, in `z` from `z^0` up, each `a + K b`.
    fn difference(&self) -> Vec<UniPoly> {
        let n = self.order();
        self.a.iter().zip(&self.b).map(|(a, b)| UniPoly::new(vec![a.coeff(n), b.coeff(n)])).collect()
    }

    /// The only delayed part with the parameter, if there is one only and none without delay.
    pub(super) fn single_delay(&self) -> Option<usize> {
        let mut with = (0..self.b.len()).filter(|&k| !self.b[k].is_zero());
        let k = with.next().filter(|&k| k > 0)?;
        with.next().is_none().then_some(k)
    }

    /// Without the roots that depend on neither the parameter nor the dead time; `None` when one of them is not stable.
    fn without_fixed_roots(&self) -> Option<GainLoop> {
        let content = self.a.iter().chain(&self.b).fold(UniPoly::zero(), |g, p| g.gcd(p));
        let count = count_roots(&content, Shape::LeftHalfPlane);
        if count.inside < count.total() {
            return None;
        }
        let divide = |list: &[UniPoly]| -> Vec<UniPoly> {
            list.iter().map(|p| p.div_exact(&content).expect("the content divides")).collect()
        };
        Some(GainLoop { a: divide(&self.a), b: divide(&self.b), tau: self.tau.clone() })
    }
}

/// The cells of a range of the parameter, or why there is none in which the loop is stable.
///
/// On the axis the parameter is `-A/B`, which is real where `Im(A conj B)` vanishes: a polynomial in `omega`,
/// `cos(omega tau)` and `sin(omega tau)`, whose zeros are isolated with proof. As the parameter grows through the value
/// there, a pair of roots goes right where `Im(A conj B)` falls as the frequency grows, left where it rises; where it only
/// touches zero, the roots only touch the axis. Other boundaries are `s = 0` and the values at which the difference operator
/// stops being stable. One count in each of the gaps that these leave gives all counts.
///
/// In a domain without end the parameter is to enter in one delayed term: `ds/d log K` then has a positive real part on the
/// axis beyond a frequency that is computed, so that of the infinitely many crossings only those up to the first one beyond
/// are needed.
///
/// Cost: a walk along the axis up to the frequency beyond which the highest power of `s` outweighs the rest.
///
/// # Errors
/// [`NotSolved`].
pub fn gain_cells(gain: &GainLoop, range: &Range, budget: &Budget) -> Result<Result<GainCells, Never>, NotSolved> {
    match direct_cells(gain, range, budget) {
        // A time constant in the highest power of s, say, whose reciprocal enters as a gain does.
        Err(reason @ (NotSolved::Unbounded | NotSolved::Neutral)) => match inverse_cells(gain, range, budget) {
            Err(NotSolved::Unbounded | NotSolved::Neutral) => Err(reason),
            other => other,
        },
        other => other,
    }
}

/// [`gain_cells`] by the parameter itself.
pub(super) fn direct_cells(
    gain: &GainLoop,
    range: &Range,
    budget: &Budget,
) -> Result<Result<GainCells, Never>, NotSolved> {
    budget.step("quasi-polynomial");
    let Some(gain) = budget.enter(|| gain.without_fixed_roots())? else { return Ok(Err(Never::FixedRoot)) };
    let sum = |list: &[UniPoly]| list.iter().fold(Integer::ZERO, |sum, p| sum + p.coeff(0));
    let (a0, b0) = (sum(&gain.a), sum(&gain.b));
    if a0.is_zero() && b0.is_zero() {
        return Ok(Err(Never::RootAtZero));
    }
    let Some((neutral, happening)) = difference_points(gain.difference(), range, budget)? else {
        return Ok(Err(Never::Neutral));
    };
    let counted_at = |value: RealAlgebraic| GainPoint::counted(value.into(), happening.clone());
    let mut points: Vec<GainPoint> = neutral.into_iter().map(counted_at).collect();
    if !b0.is_zero() {
        let at = -Rational::new(a0, b0);
        if range.contains(&at) {
            points.push(GainPoint::counted(at.into(), Happening::RootAtZero));
        }
    }
    let beyond = match crossings_of_gain(&gain, range, &points, budget)? {
        Ok((crossings, beyond)) => {
            points.extend(crossings);
            beyond
        }
        Err(never) => return Ok(Err(never)),
    };
    cells_between(range, points, &beyond, &|value| counted(&gain, value, budget), budget).map(Ok)
}

/// The cells between points: a count in each cell whose count does not follow from the one below.
pub(super) fn cells_between(
    range: &Range,
    points: Vec<GainPoint>,
    beyond: &Beyond,
    count: &dyn Fn(&Rational) -> Result<Option<usize>, NotSolved>,
    budget: &Budget,
) -> Result<GainCells, NotSolved> {
    let points = sorted(points, budget)?;
    budget.step("counting roots in the gaps");
    let values: Vec<Real> = points.iter().map(|p| p.value.clone()).collect();
    let mut right: Vec<Option<usize>> = Vec::with_capacity(points.len() + 1);
    for (i, cell) in real_cells(range, &values).iter().enumerate() {
        budget.check()?;
        let known = i.checked_sub(1).and_then(|j| usize::try_from(right[j]? as i64 + points[j].change?).ok());
        right.push(match known {
            _ if beyond.covers(cell.lower.as_ref(), cell.upper.as_ref(), budget)? => None,
            Some(count) => Some(count),
            None => count(&cell.sample(budget)?)?,
        });
    }
    Ok(GainCells { points, right })
}

/// The count at one value; `None` where the difference operator is not stable there.
fn counted(gain: &GainLoop, value: &Rational, budget: &Budget) -> Result<Option<usize>, NotSolved> {
    let Some(p) = gain.at(value) else { return Ok(None) };
    if !budget.enter(|| p.has_stable_difference())? {
        return Ok(None);
    }
    match roots_right(&p, &gain.tau, 0, budget) {
        Ok(count) => Ok(Some(count)),
        Err(NotCounted::Neutral) => Err(NotSolved::Neutral),
        Err(reason) => Err(reason.into()),
    }
}

/// The values in a range at which zeros of the difference operator meet the unit circle, and what happens there; `None` when one
/// is there for every value. The operator has the coefficients of the highest power of `s`, from `z^0` up.
pub(super) fn difference_points(
    mut top: Vec<UniPoly>,
    range: &Range,
    budget: &Budget,
) -> Result<Option<(Vec<RealAlgebraic>, Happening)>, NotSolved> {
    while top.last().is_some_and(UniPoly::is_zero) {
        top.pop();
    }
    let degree = top.len() - 1;
    // In 1/z: the stable zeros are inside, and its highest coefficient is the one without delay.
    top.reverse();
    let reversed = ParametricPolynomial::from_integral(&Poly::new(top), degree);
    let Some(boundaries) = boundary_polynomials(&reversed, Shape::UnitDisc, budget)? else { return Ok(None) };
    let zeros = boundaries.iter().map(|boundary| zeros_in(boundary.polynomial.poly(), range, budget));
    let zeros = merge_points(zeros.collect::<Result<_, _>>()?, budget)?;
    Ok(Some((zeros, if degree == 0 { Happening::DegreeLost } else { Happening::Neutral })))
}

/// Ascending; two points that are the same become one at which more happens, and whose change is counted.
fn sorted(points: Vec<GainPoint>, budget: &Budget) -> Result<Vec<GainPoint>, NotSolved> {
    let mut out: Vec<GainPoint> = Vec::with_capacity(points.len());
    for point in points {
        match place_of(&out, &point.value, budget)? {
            Ok(same) => out[same].join(point),
            Err(at) => out.insert(at, point),
        }
    }
    Ok(out)
}

/// Which of the ascending points has a value, or else the number of points below it.
fn place_of(points: &[GainPoint], value: &Real, budget: &Budget) -> Result<Result<usize, usize>, Exhausted> {
    let (mut low, mut high) = (0, points.len());
    while low < high {
        let middle = (low + high) / 2;
        match points[middle].value.compare(value, budget)? {
            Ordering::Less => low = middle + 1,
            Ordering::Greater => high = middle,
            Ordering::Equal => return Ok(Ok(middle)),
        }
    }
    Ok(Err(low))
}
