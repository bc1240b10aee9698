//! The exact set of stable parameter values.

use super::line::Pieces;
use super::{AlgebraicInterval, Cause, Causes, ComplexPair, IntervalSet, Range, RealInterval};
use jurist_algebra::number::Rational;
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
    /// Whether the loop is stable at the value itself: only where a dead time is zero, and at an end of a domain that is closed.
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

    /// The open interval, without what happens at its ends.
    ///
    /// ```
    /// let all = jurist_stability::StableInterval::new(None, None).bare();
    /// assert!(all.contains(&0.into()));
    /// ```
    pub fn bare(&self) -> RealInterval {
        let [lower, upper] = [&self.lower, &self.upper].map(|end| end.as_ref().map(|end| end.value.clone()));
        RealInterval { lower, upper }
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
/// let bracket = UndecidedBracket::new(Some(1.into()), Some(2.into()), "a root on the boundary, or close to it");
/// assert_eq!(bracket.why, "a root on the boundary, or close to it");
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
    cells: Option<Cells>,
    /// True if the set was found by more than boundary polynomials over the integers.
    is_transcendental: bool,
}

/// How the range was cut: between two neighbouring zeros of the boundary functions lies a cell in which the number of
/// stable roots is constant.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Cells {
    /// All real zeros of the boundary functions in the range, ascending.
    pub zeros: Vec<Real>,
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
        StableSet { intervals, undecided, cells: None, is_transcendental: true }
    }

    /// Whether the set was decided by boundary polynomials over the integers alone, which certificates are made of.
    pub fn is_algebraic(&self) -> bool {
        !self.is_transcendental
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
    /// where a part of the range is undecided, and for loops with dead time.
    pub fn cells(&self) -> Option<&Cells> {
        self.cells.as_ref()
    }

    /// The set with the cells that decided it.
    pub(super) fn with_cells(mut self, zeros: Vec<Real>, samples: Vec<(Rational, bool)>) -> StableSet {
        self.cells = Some(Cells { zeros, samples });
        self
    }

    /// The set as one that boundary polynomials over the integers alone have decided.
    pub(super) fn algebraic(mut self) -> StableSet {
        self.is_transcendental = false;
        self
    }

    /// The set with another one above it: an interval that ends at `joint`, where the loop is stable, goes on there.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// use jurist_stability::{Causes, End, StableInterval, StableSet};
    /// let end = |x: i64| Some(End::new(Rational::from(x), Causes::default(), None));
    /// let set = |a, b| StableSet::from_intervals(vec![StableInterval::new(end(a), end(b))], Vec::new());
    /// assert_eq!(set(0, 1).followed_by(set(1, 2), None).intervals().len(), 2);
    /// assert!(set(0, 1).followed_by(set(1, 2), Some(&1.into())).contains(&1.into()));
    /// ```
    pub fn followed_by(self, above: StableSet, joint: Option<&Rational>) -> StableSet {
        let mut pieces = Pieces::before(self.intervals, joint);
        above.intervals.into_iter().for_each(|interval| pieces.push(interval));
        let undecided = self.undecided.into_iter().chain(above.undecided).collect();
        let (intervals, undecided) = pieces.ended(&Range::all(), undecided);
        StableSet::from_intervals(intervals, undecided)
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
