//! The stable set of one parameter, whatever its coefficients are: the zeros of the boundary functions cut the line into cells, each
//! cell has one verdict, and the ends of stable cells are named.
//!
//! A [`Ring`] says what holds at a value and in a cell; [`Line::stable_set`] is written once for all of them.

mod end;
mod integers;
mod pieces;

pub(crate) use end::named_end;
pub use integers::{end_at, stable_set};
pub(crate) use pieces::{Decided, Pieces};

use super::interval_set::real_cells;
use super::{Cause, ComplexPair, End, Range, RealInterval, StableInterval, StableSet, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;

/// An interval in which boundary functions may have zeros that are not known; `None` where it has no end.
pub type Bracket = (Option<Rational>, Option<Rational>);

/// A value at which a stable cell ends.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub value: &'a Real,
    /// Which zero of the line it is; `None` for a rational end of the line.
    pub zero: Option<usize>,
}

/// The boundary conditions that hold at a value.
pub(crate) struct Held {
    /// Their causes, in any order.
    pub causes: Vec<Cause>,
    /// True if the polynomial has roots there: it is neither undefined nor zero.
    pub has_roots: bool,
}

/// Where the roots are that the half-size pair has in common.
pub(crate) enum Common {
    /// Strictly inside of the boundary's interval: a pair of roots is there.
    Pair(ComplexPair),
    /// Beyond the interval, or nowhere: no pair is on the boundary.
    Beyond,
    /// Several, or one at an end of the interval.
    Unknown,
}

/// What a ring of coefficients tells of a loop with one parameter.
pub(crate) trait Ring {
    /// True if the loop is stable in a cell, which has so many zeros below it; and the value that decided it, if one did.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    fn is_stable(&self, below: usize, cell: &RealInterval) -> Result<(Option<Rational>, bool), Exhausted>;

    /// The boundary conditions that hold at the end of a stable cell.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    fn held(&self, place: Place<'_>) -> Result<Held, Exhausted>;

    /// The complex pair at the end of a stable cell where the condition for complex pairs holds.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    fn common_roots(&self, place: Place<'_>) -> Result<Common, Exhausted>;
}

/// One parameter of a loop, with the zeros of its boundary functions.
pub(crate) struct Line<'a> {
    /// The range that is asked for: its ends have the cause `domain`.
    pub range: &'a Range,
    /// The range in which zeros were isolated.
    pub reach: Range,
    /// The zeros of all boundary functions in the reach, ascending, each once.
    pub zeros: Vec<Real>,
    /// Where boundary functions may have other zeros, ascending and disjoint; with what is decided of each bracket, ascending.
    pub brackets: Vec<(Bracket, Vec<Decided>)>,
    /// What was not looked at.
    pub beyond: Vec<UndecidedBracket>,
    pub ring: &'a dyn Ring,
    pub budget: &'a Budget,
}

impl<'a> Line<'a> {
    /// A range in which all zeros are known.
    pub fn new(range: &'a Range, zeros: Vec<Real>, ring: &'a dyn Ring, budget: &'a Budget) -> Self {
        Line { range, reach: range.clone(), zeros, brackets: Vec::new(), beyond: Vec::new(), ring, budget }
    }

    /// The stable set.
    ///
    /// Cost: a verdict for each cell, and for each end of a stable cell the conditions that hold there.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn stable_set(self) -> Result<StableSet, Exhausted> {
        let mut lower = self.reach.lower.clone();
        let mut pieces = Pieces::default();
        let mut samples = Vec::new();
        // After the last bracket there is one more piece.
        for bracket in self.brackets.iter().map(Some).chain([None]) {
            let upper = bracket.map_or(&self.reach.upper, |((lower, _), _)| lower);
            let piece = Range::between(lower, upper.clone());
            let is_below = bracket.is_none_or(|((lower, _), _)| lower.is_some());
            if is_below && !piece.is_empty() {
                let cells = self.cells(&piece)?;
                self.intervals(&piece, &cells)?.into_iter().for_each(|interval| pieces.push(interval));
                samples.extend(cells.verdicts);
            }
            let Some((bracket, parts)) = bracket else { break };
            pieces.bracket(bracket, parts);
            lower = bracket.1.clone();
            if lower.is_none() {
                break;
            }
        }
        let (intervals, undecided) = pieces.ended(&self.reach, self.beyond);
        let set = StableSet::from_intervals(intervals, undecided);
        let samples: Option<Vec<_>> = samples.into_iter().map(|(sample, stable)| Some((sample?, stable))).collect();
        Ok(match samples.filter(|samples| self.brackets.is_empty() && !samples.is_empty()) {
            Some(samples) => set.with_cells(self.zeros, samples),
            None => set,
        })
    }

    /// The cells of a piece in which all zeros are known.
    fn cells(&self, piece: &Range) -> Result<Cells, Exhausted> {
        self.budget.step("testing a sample of each cell");
        let is_below = |z: &&Real| piece.lower.as_ref().is_some_and(|x| z.compare_rational(x).is_le());
        let is_inside = |z: &&Real| piece.upper.as_ref().is_none_or(|x| z.compare_rational(x).is_lt());
        // Without brackets all zeros are inside.
        let (below, inside) = match self.brackets.is_empty() {
            true => (0, self.zeros.len()),
            false => {
                let below = self.zeros.iter().take_while(is_below).count();
                (below, self.zeros[below..].iter().take_while(is_inside).count())
            }
        };
        let cells = real_cells(piece, &self.zeros[below..below + inside]);
        let mut verdicts = Vec::with_capacity(cells.len());
        for (i, cell) in cells.iter().enumerate() {
            self.budget.check()?;
            self.budget.advance(i as u64, cells.len() as u64);
            verdicts.push(self.ring.is_stable(below + i, cell)?);
        }
        Ok(Cells { below, verdicts })
    }

    /// The stable cells of a piece with their ends; those between which nothing happens are one.
    fn intervals(&self, piece: &Range, cells: &Cells) -> Result<Vec<StableInterval>, Exhausted> {
        self.budget.step("what happens at each end");
        let mut intervals: Vec<StableInterval> = Vec::new();
        // Whether the interval before goes on in this cell, as nothing happens between them.
        let mut goes_on = false;
        for i in (0..cells.verdicts.len()).filter(|&i| cells.is_stable(i)) {
            let upper = self.end(piece, cells, i + 1)?;
            let is_joined = upper.is_none() && cells.is_stable(i + 1);
            match intervals.last_mut() {
                Some(last) if goes_on => last.upper = upper,
                // Two neighbours share their end.
                Some(last) if i > 0 && cells.is_stable(i - 1) => {
                    let lower = last.upper.clone();
                    intervals.push(StableInterval::new(lower, upper));
                }
                _ => intervals.push(StableInterval::new(self.end(piece, cells, i)?, upper)),
            }
            goes_on = is_joined;
        }
        Ok(intervals)
    }

    /// The end below the cell of this number; `None` where it is infinite, or where nothing happens between two stable cells.
    fn end(&self, piece: &Range, cells: &Cells, number: usize) -> Result<Option<End>, Exhausted> {
        let bound = match number {
            0 => &piece.lower,
            _ if number == cells.verdicts.len() => &piece.upper,
            _ => {
                let zero = cells.below + number - 1;
                let place = Place { value: &self.zeros[zero], zero: Some(zero) };
                let is_between = cells.is_stable(number - 1) && cells.is_stable(number);
                return named_end(self.ring, self.range, place, is_between);
            }
        };
        let Some(value) = bound.clone().map(Real::from) else { return Ok(None) };
        if self.brackets.iter().any(|((lower, upper), _)| [lower, upper].contains(&bound)) {
            // What happens at the end of a bracket is not told.
            return Ok(Some(End::new(value, Default::default(), None)));
        }
        named_end(self.ring, self.range, Place { value: &value, zero: None }, false)
    }
}

/// The cells of a piece.
struct Cells {
    /// How many zeros are below the piece.
    below: usize,
    /// The sample of each cell, and whether the loop is stable there.
    verdicts: Vec<(Option<Rational>, bool)>,
}

impl Cells {
    fn is_stable(&self, number: usize) -> bool {
        self.verdicts.get(number).is_some_and(|(_, stable)| *stable)
    }
}
