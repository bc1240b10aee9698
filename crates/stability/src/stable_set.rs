//! The exact set of stable parameter values.

use super::interval_set::{cells, merge_points};
use super::pair_location::complex_pair_at;
use super::{
    AlgebraicInterval, AtPoint, Boundary, Cause, Causes, ComplexPair, IntervalSet, ParametricPolynomial, Range,
    RootCount, Shape, boundary_polynomials,
};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, isolate_real_roots_in};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// One end of a stable interval.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, stable_set};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let set = stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let upper = set.intervals()[0].upper.as_ref().unwrap();
/// assert_eq!((upper.value.decimal(6).as_str(), upper.causes.to_string().as_str()), ("2", "z=-1"));
/// assert!(upper.pair.is_none());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct End {
    /// The exact value.
    pub value: Real,
    /// Why stability ends here: all that holds.
    pub causes: Causes,
    /// The complex pair on the boundary, if there is one; the lowest frequency of several.
    pub pair: Option<ComplexPair>,
    /// Whether the loop is stable at the value itself: only where a dead time is zero, inside of the domain.
    pub closed: bool,
}

impl End {
    /// An end with what happens there.
    pub fn new(value: impl Into<Real>, causes: Causes, pair: Option<ComplexPair>) -> End {
        End { value: value.into(), causes, pair, closed: false }
    }

    /// The end, stable itself or not.
    pub fn closed_if(self, closed: bool) -> End {
        End { closed, ..self }
    }
}

/// An interval of stable parameter values, open but for ends that are [closed](End::closed); `None` is an infinite end.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{End, ParametricPolynomial, Range, Shape, stable_set};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let set = stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let interval = &set.intervals()[0];
/// let value = |end: &Option<End>| end.as_ref().unwrap().value.decimal(6);
/// assert_eq!((value(&interval.lower), value(&interval.upper)), ("0".to_owned(), "2".to_owned()));
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StableInterval {
    /// The lower end, stable itself only where it is closed.
    pub lower: Option<End>,
    /// The upper end, stable itself only where it is closed.
    pub upper: Option<End>,
}

impl StableInterval {
    /// The interval between two ends.
    pub fn new(lower: Option<End>, upper: Option<End>) -> StableInterval {
        StableInterval { lower, upper }
    }

    /// Whether a value lies between the ends, or is a closed one.
    pub fn contains(&self, value: &Rational) -> bool {
        let beyond = |end: &Option<End>, outside: Ordering| {
            end.as_ref().is_some_and(|end| match end.value.compare_rational(value) {
                Ordering::Equal => !end.closed,
                order => order == outside,
            })
        };
        !beyond(&self.lower, Ordering::Greater) && !beyond(&self.upper, Ordering::Less)
    }
}

/// An interval about which nothing is known: a short one between neighbours that are decided, or what lies beyond all that
/// was looked at.
///
/// ```
/// use jurist_stability::UndecidedBracket;
/// let bracket = UndecidedBracket::new(Some(1.into()), Some(2.into()), "touching or crossing");
/// assert_eq!(bracket.why, "touching or crossing");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UndecidedBracket {
    /// The lower end; `None` where there is none.
    pub lower: Option<Rational>,
    /// The upper end; `None` where there is none.
    pub upper: Option<Rational>,
    /// What could not be told.
    pub why: String,
}

impl UndecidedBracket {
    /// The bracket between two numbers; `None` is infinite.
    pub fn new(lower: Option<Rational>, upper: Option<Rational>, why: impl Into<String>) -> Self {
        UndecidedBracket { lower, upper, why: why.into() }
    }
}

/// All parameter values of a range for which a loop is stable: a finite union of open intervals.
///
/// Two neighbouring intervals may share an end, where the loop is only marginally stable (the roots
/// touch the boundary) or undefined.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, stable_set};
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]); // z - 1 + K
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let set = stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// assert!(set.contains(&1.into()) && !set.contains(&2.into()));
/// let cells = set.cells().unwrap();
/// assert_eq!((cells.zeros.len(), cells.samples.len()), (2, 3));
/// ```
#[derive(Clone, Debug, Default)]
pub struct StableSet {
    intervals: Vec<StableInterval>,
    undecided: Vec<UndecidedBracket>,
    way: Way,
}

/// How a set was found.
#[derive(Clone, Debug, Default)]
enum Way {
    /// A boundary condition holds for every value, or the loop is undefined.
    #[default]
    Nowhere,
    /// By the zeros of boundary polynomials.
    Cells(Cells),
    /// By anything else.
    Other,
}

/// How the range was cut: between two neighbouring zeros of the boundary polynomials lies a cell in which the number of
/// stable roots is constant.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Cells {
    /// All real zeros of the boundary polynomials in the range, ascending.
    pub zeros: Vec<RealAlgebraic>,
    /// A value inside of each cell, and whether the loop is stable there; one more than zeros.
    pub samples: Vec<(Rational, bool)>,
}

impl StableSet {
    /// A set that was found in another way than by boundary polynomials over the integers: its intervals, ascending and
    /// disjoint, and where nothing is known.
    ///
    /// What ends at an end of a bracket ends for want of knowledge: its cause is [`Cause::Undecided`].
    pub fn from_intervals(mut intervals: Vec<StableInterval>, undecided: Vec<UndecidedBracket>) -> StableSet {
        for end in intervals.iter_mut().flat_map(|i| [&mut i.lower, &mut i.upper]).flatten() {
            let exact = end.value.exact();
            if exact.is_some() && undecided.iter().any(|b| b.lower == exact || b.upper == exact) {
                let mut causes = Causes::default();
                causes.insert(Cause::Undecided);
                *end = End::new(end.value.clone(), causes, None);
            }
        }
        StableSet { intervals, undecided, way: Way::Other }
    }

    /// Whether the set was decided by boundary polynomials over the integers alone, which certificates are made of.
    pub fn is_algebraic(&self) -> bool {
        !matches!(self.way, Way::Other)
    }

    /// Where nothing is known, ascending; what lies between is decided.
    pub fn undecided(&self) -> &[UndecidedBracket] {
        &self.undecided
    }

    /// The intervals, ascending and disjoint.
    pub fn intervals(&self) -> &[StableInterval] {
        &self.intervals
    }

    /// How the range was cut; `None` when the loop is stable nowhere because a boundary condition holds for every value,
    /// and for a set that is not [algebraic](StableSet::is_algebraic).
    pub fn cells(&self) -> Option<&Cells> {
        match &self.way {
            Way::Cells(cells) => Some(cells),
            Way::Nowhere | Way::Other => None,
        }
    }

    /// The set with one value more, at which the loop is stable though it is not beside it on one side, or both.
    pub fn with_value(mut self, end: End) -> StableSet {
        let mut is_known = false;
        for known in self.ends_mut().filter(|other| other.value.is_same(&end.value)) {
            (known.closed, is_known) = (true, true);
        }
        if is_known {
            return self;
        }
        let end = End { closed: true, ..end };
        let value = end.value.exact();
        let is_before = |i: &StableInterval| {
            let upper = value.as_ref().zip(i.upper.as_ref());
            upper.is_some_and(|(x, upper)| upper.value.compare_rational(x).is_lt())
        };
        let at = self.intervals.iter().take_while(|i| is_before(i)).count();
        self.intervals.insert(at, StableInterval::new(Some(end.clone()), Some(end)));
        self
    }

    /// Every end, to take back a cause that belongs to the question's form and not to the loop.
    pub fn ends_mut(&mut self) -> impl Iterator<Item = &mut End> {
        self.intervals.iter_mut().flat_map(|i| [&mut i.lower, &mut i.upper]).flatten()
    }

    /// Whether no value is stable.
    pub fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }

    /// Whether a value is in the set.
    pub fn contains(&self, value: &Rational) -> bool {
        self.intervals.iter().any(|i| i.contains(value))
    }

    /// The intervals without their causes; `None` where an end is not algebraic.
    pub fn to_interval_set(&self) -> Option<IntervalSet> {
        let bare = |e: &Option<End>| match e {
            None => Some(None),
            Some(e) => e.value.algebraic().cloned().map(Some),
        };
        let interval = |i: &StableInterval| Some(AlgebraicInterval { lower: bare(&i.lower)?, upper: bare(&i.upper)? });
        self.intervals.iter().map(interval).collect()
    }
}

/// The exact stable set of a loop with one parameter over an open range.
///
/// The real zeros of the [`boundary_polynomials`] cut the range into open cells; in each the root
/// count is constant, so it is taken exactly at one rational sample. Ends of stable cells are then
/// examined for all that happens there.
///
/// With the critical constraint of [JuryPavlidis1963](jurist_algebra::bibliography#jurypavlidis1963) as the
/// boundary of complex pairs, and what lies between zeros decided as in
/// [Collins1975](jurist_algebra::bibliography#collins1975).
///
/// Cost: that of [`boundary_polynomials`], one resultant; isolation of the real zeros of each, of degree up to
/// `(n - 1) d` for order `n` and coefficients of degree `d`; one [`count_roots`](super::count_roots) in each cell
/// between them, `O(n^2)` operations on integers; and at each end of a stable interval the signs of all boundary
/// polynomials.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, stable_set};
/// // z - 1 + K: stable for 0 < K < 2
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]);
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let set = stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let ends = &set.intervals()[0];
/// assert_eq!(ends.lower.as_ref().unwrap().causes.to_string(), "z=1");
/// assert_eq!(ends.upper.as_ref().unwrap().causes.to_string(), "z=-1");
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn stable_set(
    p: &ParametricPolynomial,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let Some(boundaries) = boundary_polynomials(p, region, budget)? else { return Ok(StableSet::default()) };
    budget.step("isolating the boundaries' zeros");
    let mut lists = Vec::new();
    for boundary in &boundaries {
        lists.push(isolate_real_roots_in(&boundary.polynomial, range.lower.as_ref(), range.upper.as_ref(), budget)?);
    }
    let points = merge_points(lists, budget)?;
    budget.step("testing a sample of each cell");
    let all = cells(range, &points);
    let mut samples = Vec::with_capacity(all.len());
    for (i, cell) in all.iter().enumerate() {
        budget.check()?;
        budget.advance(i as u64, all.len() as u64);
        let sample = cell.sample();
        let at = budget.enter(|| p.at(&sample, region))?;
        let inside = |count: RootCount| count.inside == p.formal_degree();
        samples.push((sample, matches!(at, AtPoint::Defined { count, infinite: 0 } if inside(count))));
    }
    let examiner = EndExaminer { p, range, region, boundaries: &boundaries, budget };
    let mut intervals: Vec<StableInterval> = Vec::new();
    for (i, cell) in all.iter().enumerate().filter(|(i, _)| samples[*i].1) {
        let shared =
            (i > 0 && samples[i - 1].1).then(|| intervals.last().and_then(|last| last.upper.clone())).flatten();
        let lower = match (shared, &cell.lower) {
            (Some(end), _) => Some(end),
            (None, Some(value)) => Some(examiner.examine(value)?),
            (None, None) => None,
        };
        let upper = cell.upper.as_ref().map(|value| examiner.examine(value)).transpose()?;
        intervals.push(StableInterval { lower, upper });
    }
    Ok(StableSet { intervals, undecided: Vec::new(), way: Way::Cells(Cells { zeros: points, samples }) })
}

/// What happens at an end of a stable interval that was found elsewhere; `None` when the loop is stable
/// nowhere. For a value that is no limit of stable values the answer means nothing.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn end_at(
    p: &ParametricPolynomial,
    value: &RealAlgebraic,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<Option<End>, Exhausted> {
    let Some(boundaries) = boundary_polynomials(p, region, budget)? else { return Ok(None) };
    EndExaminer { p, range, region, boundaries: &boundaries, budget }.examine(value).map(Some)
}

/// Finds out what happens at an end of a stable cell.
struct EndExaminer<'a> {
    p: &'a ParametricPolynomial,
    range: &'a Range,
    region: Shape,
    boundaries: &'a [Boundary],
    budget: &'a Budget,
}

impl EndExaminer<'_> {
    fn examine(&self, value: &RealAlgebraic) -> Result<End, Exhausted> {
        let vanishes = |f: &jurist_algebra::poly::UniPoly| self.budget.enter(|| value.sign_of(f).is_eq());
        let coefficients_defined = !vanishes(self.p.denominator())?;
        // Where all coefficients vanish, or one is infinite, no root can be named.
        let has_roots = coefficients_defined && !vanishes(self.p.content())?;
        let mut causes = Causes::default();
        for boundary in self.boundaries {
            let counts = match boundary.cause {
                Cause::RootAtOne | Cause::RootAtMinusOne | Cause::RootAtZero => has_roots,
                Cause::ComplexPair => false,
                _ => true,
            };
            if counts && vanishes(boundary.polynomial.poly())? {
                causes.insert(boundary.cause);
            }
        }
        let mut critical = false;
        for boundary in self.boundaries.iter().filter(|b| b.cause == Cause::ComplexPair) {
            critical |= vanishes(boundary.polynomial.poly())?;
        }
        let pair = if has_roots && critical { complex_pair_at(self.p, value, self.region, self.budget)? } else { None };
        if pair.is_some() {
            causes.insert(Cause::ComplexPair);
        }
        let is_end = |end: &Option<Rational>| end.is_some() && *end == value.exact();
        if is_end(&self.range.lower) || is_end(&self.range.upper) {
            causes.insert(Cause::Domain);
        }
        Ok(End::new(value.clone(), causes, pair))
    }
}
