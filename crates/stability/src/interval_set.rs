//! Open intervals, and finite unions of those with algebraic ends.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in, rational_between};
use jurist_algebra::real::{self, Real};
use std::cmp::Ordering;

/// An open interval with rational ends, either of which may be infinite (`None`).
///
/// ```
/// use jurist_stability::Range;
/// let range = Range::between(Some(0.into()), None);
/// assert!(range.contains(&1.into()) && !range.contains(&0.into()));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Range {
    /// The lower end, excluded.
    pub lower: Option<Rational>,
    /// The upper end, excluded.
    pub upper: Option<Rational>,
}

impl Range {
    /// All real numbers.
    pub fn all() -> Self {
        Range::default()
    }

    /// The numbers strictly between two ends.
    pub fn between(lower: Option<Rational>, upper: Option<Rational>) -> Self {
        Range { lower, upper }
    }

    /// Whether the value is strictly inside.
    pub fn contains(&self, value: &Rational) -> bool {
        self.lower.as_ref().is_none_or(|l| l < value) && self.upper.as_ref().is_none_or(|u| value < u)
    }

    /// Whether no number is inside.
    pub fn is_empty(&self) -> bool {
        matches!((&self.lower, &self.upper), (Some(l), Some(u)) if l >= u)
    }
}

/// An open interval with algebraic ends; `None` is an infinite end.
///
/// ```
/// use jurist_algebra::poly::RealAlgebraic;
/// use jurist_stability::AlgebraicInterval;
/// let positive = AlgebraicInterval { lower: Some(RealAlgebraic::from_rational(0.into())), upper: None };
/// assert!(positive.contains(&positive.sample()) && !positive.contains(&0.into()));
/// ```
#[derive(Clone, Debug)]
pub struct AlgebraicInterval {
    /// The lower end, excluded.
    pub lower: Option<RealAlgebraic>,
    /// The upper end, excluded.
    pub upper: Option<RealAlgebraic>,
}

/// An open interval whose ends are real numbers of any kind; `None` is an infinite end.
///
/// ```
/// use jurist_stability::RealInterval;
/// let positive = RealInterval { lower: Some(jurist_algebra::number::Rational::ZERO.into()), upper: None };
/// assert!(positive.contains(&1.into()) && !positive.contains(&0.into()));
/// ```
#[derive(Clone, Debug)]
pub struct RealInterval {
    /// The lower end, excluded.
    pub lower: Option<Real>,
    /// The upper end, excluded.
    pub upper: Option<Real>,
}

/// A union of disjoint open intervals, in ascending order. Two may share an end, which is then not
/// in the set.
///
/// ```
/// use jurist_algebra::poly::RealAlgebraic;
/// use jurist_stability::{AlgebraicInterval, IntervalSet};
/// let interval = |lower: i32, upper: i32| AlgebraicInterval {
///     lower: Some(RealAlgebraic::from_rational(lower.into())),
///     upper: Some(RealAlgebraic::from_rational(upper.into())),
/// };
/// let set: IntervalSet = [interval(0, 2), interval(3, 5)].into_iter().collect();
/// let common = set.intersection(&[interval(1, 4)].into_iter().collect());
/// assert_eq!(common.intervals().len(), 2);
/// assert!(common.contains(&"7/2".parse().unwrap()) && !common.contains(&2.into()));
/// ```
#[derive(Clone, Debug, Default)]
pub struct IntervalSet {
    intervals: Vec<AlgebraicInterval>,
}

impl IntervalSet {
    /// The intervals in ascending order.
    pub fn intervals(&self) -> &[AlgebraicInterval] {
        &self.intervals
    }

    /// The cells of `range` between the given points in which `holds` is true of a rational sample.
    ///
    /// Cost: a rational number between any two neighbouring points, and what `holds` takes.
    ///
    /// # Errors
    /// What `holds` returns, or the budget.
    pub fn from_cells(
        range: &Range,
        points: &[RealAlgebraic],
        budget: &Budget,
        mut holds: impl FnMut(&Rational) -> bool,
    ) -> Result<Self, Exhausted> {
        let mut intervals = Vec::new();
        for cell in cells(range, points) {
            budget.check()?;
            if holds(&cell.sample()) {
                intervals.push(cell);
            }
        }
        Ok(IntervalSet { intervals })
    }

    /// The numbers in both sets. `O(n m)` comparisons.
    pub fn intersection(&self, other: &IntervalSet) -> IntervalSet {
        let mut intervals = Vec::new();
        for a in &self.intervals {
            for b in &other.intervals {
                let lower = greater_lower(&a.lower, &b.lower).clone();
                let upper = lesser_upper(&a.upper, &b.upper).clone();
                let empty = matches!((&lower, &upper), (Some(l), Some(u)) if l.compare(u) != Ordering::Less);
                if !empty {
                    intervals.push(AlgebraicInterval { lower, upper });
                }
            }
        }
        IntervalSet { intervals }
    }

    /// Whether both are the same union of intervals, end by end.
    pub fn same_as(&self, other: &IntervalSet) -> bool {
        let same_end = |a: &Option<RealAlgebraic>, b: &Option<RealAlgebraic>| match (a, b) {
            (None, None) => true,
            (Some(a), Some(b)) => a.compare(b) == Ordering::Equal,
            _ => false,
        };
        self.intervals.len() == other.intervals.len()
            && self
                .intervals
                .iter()
                .zip(&other.intervals)
                .all(|(a, b)| same_end(&a.lower, &b.lower) && same_end(&a.upper, &b.upper))
    }

    /// Whether the value lies in the set.
    pub fn contains(&self, value: &Rational) -> bool {
        self.intervals.iter().any(|i| i.contains(value))
    }
}

impl FromIterator<AlgebraicInterval> for IntervalSet {
    /// The intervals have to be disjoint and ascending.
    fn from_iter<I: IntoIterator<Item = AlgebraicInterval>>(intervals: I) -> Self {
        IntervalSet { intervals: intervals.into_iter().collect() }
    }
}

impl AlgebraicInterval {
    /// Whether the value lies strictly between the ends.
    pub fn contains(&self, value: &Rational) -> bool {
        self.lower.as_ref().is_none_or(|l| l.compare_rational(value) == Ordering::Less)
            && self.upper.as_ref().is_none_or(|u| u.compare_rational(value) == Ordering::Greater)
    }

    /// A rational number inside.
    ///
    /// Cost: halvings of the enclosures of both ends until the simplest rational number between them shows.
    pub fn sample(&self) -> Rational {
        match (&self.lower, &self.upper) {
            (Some(l), Some(u)) => rational_between(l, u).expect("the ends differ"),
            (Some(l), None) => Rational::from(l.floor()) + Rational::ONE,
            (None, Some(u)) => Rational::from(u.floor()) - Rational::ONE,
            (None, None) => Rational::ZERO,
        }
    }
}

impl From<Range> for RealInterval {
    fn from(range: Range) -> Self {
        RealInterval { lower: range.lower.map(Real::from), upper: range.upper.map(Real::from) }
    }
}

impl RealInterval {
    /// The open cells that points (ascending, distinct, inside) cut the interval into.
    ///
    /// ```
    /// use jurist_stability::{Range, RealInterval};
    /// let cells = RealInterval::from(Range::all()).cut(&[jurist_algebra::number::Rational::ZERO.into()]);
    /// assert!(cells[0].contains(&(-1).into()) && cells[1].contains(&1.into()));
    /// ```
    pub fn cut(&self, points: &[Real]) -> Vec<RealInterval> {
        let (lower, upper) = (self.lower.clone(), self.upper.clone());
        neighbours(lower, points, upper).map(|[lower, upper]| RealInterval { lower, upper }).collect()
    }

    /// Whether a real number lies strictly between the ends.
    ///
    /// Cost: that of comparing it with both.
    ///
    /// ```
    /// use jurist_algebra::{limits::Budget, number::Rational};
    /// use jurist_stability::{Range, RealInterval};
    /// let positive = RealInterval::from(Range::between(Some(Rational::ZERO), None));
    /// assert!(!positive.has_inside(&Rational::ZERO.into(), &Budget::unlimited()).unwrap());
    /// ```
    ///
    /// # Errors
    /// As [`Real::compare`].
    pub fn has_inside(&self, x: &Real, budget: &Budget) -> Result<bool, Exhausted> {
        for (end, side) in [(&self.lower, Ordering::Greater), (&self.upper, Ordering::Less)] {
            if let Some(end) = end
                && x.compare(end, budget)? != side
            {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the value lies strictly between the ends.
    ///
    /// Cost: that of comparing it with both.
    pub fn contains(&self, value: &Rational) -> bool {
        self.lower.as_ref().is_none_or(|l| l.compare_rational(value).is_lt())
            && self.upper.as_ref().is_none_or(|u| u.compare_rational(value).is_gt())
    }

    /// A rational number inside.
    ///
    /// Cost: as of [`AlgebraicInterval::sample`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where some thousand bits do not tell the ends apart.
    ///
    /// # Panics
    /// When the ends are equal.
    pub fn sample(&self, budget: &Budget) -> Result<Rational, Exhausted> {
        match (&self.lower, &self.upper) {
            (Some(l), Some(u)) => Ok(real::rational_between(l, u, budget)?.expect("the ends differ")),
            (Some(l), None) => budget.enter(|| l.rational_above()),
            (None, Some(u)) => budget.enter(|| u.rational_below()),
            (None, None) => Ok(Rational::ZERO),
        }
    }
}

/// The open cells that points (ascending, distinct, inside the range) cut the range into.
pub(crate) fn real_cells(range: &Range, points: &[Real]) -> Vec<RealInterval> {
    if range.is_empty() { Vec::new() } else { RealInterval::from(range.clone()).cut(points) }
}

/// The same of algebraic points.
pub(super) fn cells(range: &Range, points: &[RealAlgebraic]) -> Vec<AlgebraicInterval> {
    if range.is_empty() {
        return Vec::new();
    }
    let [lower, upper] = [&range.lower, &range.upper].map(|end| end.clone().map(RealAlgebraic::from_rational));
    neighbours(lower, points, upper).map(|[lower, upper]| AlgebraicInterval { lower, upper }).collect()
}

/// The pairs of neighbours among two ends and points between.
fn neighbours<E: Clone>(lower: Option<E>, points: &[E], upper: Option<E>) -> impl Iterator<Item = [Option<E>; 2]> {
    let inner = points.iter().cloned().map(Some);
    let uppers = inner.clone().chain([upper]);
    std::iter::once(lower).chain(inner).zip(uppers).map(|(lower, upper)| [lower, upper])
}

/// The distinct zeros of a polynomial inside a range, ascending; none for the zero polynomial.
pub fn zeros_in(f: &UniPoly, range: &Range, budget: &Budget) -> Result<Vec<RealAlgebraic>, Exhausted> {
    let Some(f) = budget.enter(|| SquareFree::part_of(f))? else { return Ok(Vec::new()) };
    isolate_real_roots_in(&f, range.lower.as_ref(), range.upper.as_ref(), budget)
}

/// All points of several ascending lists, ascending, each once.
pub(super) fn merge_points(lists: Vec<Vec<RealAlgebraic>>, budget: &Budget) -> Result<Vec<RealAlgebraic>, Exhausted> {
    let mut all: Vec<RealAlgebraic> = Vec::new();
    for list in lists {
        let mut merged = Vec::with_capacity(all.len() + list.len());
        let (mut old, mut new) = (all.into_iter().peekable(), list.into_iter().peekable());
        while let (Some(a), Some(b)) = (old.peek(), new.peek()) {
            let order = budget.enter(|| a.compare(b))?;
            if order.is_le() {
                merged.extend(old.next());
            }
            if order.is_eq() {
                new.next();
            }
            if order.is_gt() {
                merged.extend(new.next());
            }
        }
        merged.extend(old);
        merged.extend(new);
        all = merged;
    }
    Ok(all)
}

fn greater_lower<'a>(a: &'a Option<RealAlgebraic>, b: &'a Option<RealAlgebraic>) -> &'a Option<RealAlgebraic> {
    match (a, b) {
        (None, _) => b,
        (_, None) => a,
        (Some(x), Some(y)) => {
            if x.compare(y) == Ordering::Less {
                b
            } else {
                a
            }
        }
    }
}

fn lesser_upper<'a>(a: &'a Option<RealAlgebraic>, b: &'a Option<RealAlgebraic>) -> &'a Option<RealAlgebraic> {
    match (a, b) {
        (None, _) => b,
        (_, None) => a,
        (Some(x), Some(y)) => {
            if x.compare(y) == Ordering::Greater {
                b
            } else {
                a
            }
        }
    }
}
