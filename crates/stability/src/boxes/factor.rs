//! The largest factor by which all tolerances can be scaled, between a proof and a point.

use super::bracketing::{Bracketing, Gap, Open};
use super::family::{Family, Path};
use super::largest::{LargestFactor, Witness};
use super::polynomial::BoxPolynomial;
use super::prove::{BoxProof, MOST_COEFFICIENTS, Outcome};
use super::reason::OpenReason;
use super::search::{Crossing, Search};
use super::sides::{Side, at_factor};
use crate::AtPoint;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};

/// A proof that needs more cells than this is first tried at a smaller factor.
const CELLS: usize = 4000;

/// The same where signs may tell.
const FEW_CELLS: usize = 400;

/// The same of signs alone, whose cells are small.
const CELLS_OF_SIGNS: usize = 1 << 14;

/// A box that needs more cells than this is not decided.
const MOST_CELLS: usize = 1 << 18;

/// A point just beyond the worst one is so many binary digits away.
const BEYOND: u64 = 40;

/// A loop whose parameters have tolerances, ready to be decided.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// use jurist_stability::boxes::{BoxPolynomial, Side, ToleranceProblem};
/// let (model, _) = Model::builder(Time::Continuous)
///     .parameter(ParameterBuilder::new("a").nominal("2"))
///     .parameter(ParameterBuilder::new("b").nominal("3"))
///     .characteristic("s^2 + a*s + b")
///     .build()?;
/// let problem = model.ask().free("a").free("b").problem()?;
/// let budget = Budget::unlimited();
/// let p = BoxPolynomial::new(problem.algebra(&budget)?.polynomial().unwrap(), problem.shape());
/// let sides = vec![Side::scaled(2.into(), [1.into(), 1.into()]), Side::scaled(3.into(), [2.into(), 2.into()])];
/// let boxes = ToleranceProblem::new(&p, sides).unwrap();
/// assert!(boxes.decide(&1.into(), &budget)?.is_stable());
/// let factor = boxes.largest_factor(&"1/1000".parse().unwrap(), None, &budget)?;
/// assert!(factor.lower <= "3/2".parse().unwrap() && factor.upper.unwrap() >= "3/2".parse().unwrap());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub struct ToleranceProblem<'a, F = BoxPolynomial> {
    pub(super) p: &'a F,
    pub(super) sides: Vec<Side>,
    pub(super) reference: Vec<Sign>,
    pub(super) scale: i64,
}

/// What is known of one box.
#[derive(Clone, Debug)]
pub enum BoxDecision {
    /// Every point is stable.
    Stable(BoxProof),
    /// Not every point is stable.
    NotStable {
        /// A rational point that is not stable, with its root count; none where only points with irrational parameters
        /// are known.
        witness: Option<Witness>,
    },
    /// Neither was proved.
    Undecided {
        /// What ran out.
        why: OpenReason,
        /// The part of the box that was looked at last.
        cell: Vec<[Rational; 2]>,
    },
}

impl BoxDecision {
    /// That of a box with a point that is not stable.
    pub fn not_stable_at(point: Vec<Rational>, at: AtPoint) -> BoxDecision {
        BoxDecision::NotStable { witness: Some(Witness::new(point, at)) }
    }

    /// Whether every point is stable.
    pub fn is_stable(&self) -> bool {
        matches!(self, BoxDecision::Stable(_))
    }
}

impl ToleranceProblem<'_> {
    /// The number of Bernstein coefficients of the pair; `None` where it, or of what must not vanish, has more than are worked with.
    pub fn coefficients(&self) -> Option<usize> {
        let fits = |degrees: &[usize], frequencies: usize| {
            let product = degrees.iter().try_fold(frequencies, |product, degree| product.checked_mul(degree + 1));
            product.filter(|&n| n <= MOST_COEFFICIENTS)
        };
        // A divisor that cancels is not in the pair.
        for (_, f) in &self.p.certain {
            fits(&f.degrees().into_iter().map(|degree| degree as usize).collect::<Vec<_>>(), 1)?;
        }
        let pair = self.p.excluded().pair;
        fits(&pair.degrees, pair.width / 2)
    }
}

impl<'a, F: Family> ToleranceProblem<'a, F> {
    /// A loop and its tolerances; `None` unless the nominal point is stable.
    ///
    /// # Panics
    /// When the numbers of parameters differ.
    pub fn new(p: &'a F, sides: Vec<Side>) -> Option<Self> {
        assert_eq!(p.parameters(), sides.len(), "each parameter has its side");
        let nominal: Vec<Rational> = sides.iter().map(|s| s.nominal().clone()).collect();
        if !p.is_stable_at(&nominal) {
            return None;
        }
        let (reference, scale) = p.signs_at(&nominal)?;
        Some(ToleranceProblem { p, sides, reference, scale })
    }

    /// The number of parameters.
    pub fn parameters(&self) -> usize {
        self.sides.len()
    }

    fn attempt(&self, factor: &Rational, cells: usize, budget: &Budget) -> Result<Outcome, Exhausted> {
        let sides = at_factor(&self.sides, factor);
        budget.enter(|| self.p.prove(&sides, (&self.reference, self.scale), cells, budget))?
    }

    /// Whether the box of a factor is stable.
    ///
    /// Cost: that of the Bernstein coefficients, `(n/2 + 1)` times the product of the degrees in the parameters plus one, for
    /// each cell.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn decide(&self, factor: &Rational, budget: &Budget) -> Result<BoxDecision, Exhausted> {
        budget.step("proving the box");
        let by_cells = |cells: usize| Ok(self.decided(self.attempt(factor, cells, budget)?));
        if !self.p.may_be_told_by_signs() {
            return by_cells(MOST_CELLS);
        }
        let is_open = |found: &BoxDecision| matches!(found, BoxDecision::Undecided { .. });
        let found = by_cells(CELLS)?;
        if !is_open(&found) {
            return Ok(found);
        }
        let by_signs =
            |told: &ToleranceProblem<'_, F>| Ok(told.decided(told.attempt(factor, CELLS_OF_SIGNS, budget)?));
        match self.by_signs(by_signs, budget)?.filter(|found| !is_open(found)) {
            Some(found) => Ok(found),
            None => by_cells(MOST_CELLS),
        }
    }

    /// The proof of the box of a factor by trees of cells; `None` where it is not stable, or that takes too many.
    ///
    /// Cost: that of [`ToleranceProblem::decide`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn proof_in_trees(&self, factor: &Rational, budget: &Budget) -> Result<Option<BoxProof>, Exhausted> {
        budget.step("proving the box");
        Ok(match self.attempt(factor, CELLS, budget)? {
            Outcome::Stable(proof) => Some(proof),
            _ => None,
        })
    }

    fn decided(&self, outcome: Outcome) -> BoxDecision {
        match outcome {
            Outcome::Stable(proof) => BoxDecision::Stable(proof),
            Outcome::Refuted(point) => BoxDecision::NotStable { witness: self.witness_near(&point) },
            Outcome::Open { why, cell } => BoxDecision::Undecided { why, cell },
        }
    }

    /// What is found of the same loop told by signs, where that is short.
    pub(super) fn by_signs<T>(
        &self,
        ask: impl FnOnce(&ToleranceProblem<'_, F>) -> Result<T, Exhausted>,
        budget: &Budget,
    ) -> Result<Option<T>, Exhausted> {
        let Some(p) = self.p.told_by_signs(budget)? else { return Ok(None) };
        ToleranceProblem::new(&p, self.sides.clone()).map(|told| ask(&told)).transpose()
    }

    /// A point that is not stable: this one, or one on the way to it.
    fn witness_near(&self, point: &[Rational]) -> Option<Witness> {
        if self.p.is_stable_at(point) {
            let search = self.search();
            let direction = search.towards(point)?;
            let line = search.line(&direction);
            let (lo, hi) = line.crossing(Some(&self.search().factor_of(point)), 40)?;
            return self.witness(line.witness(&lo, &hi)?);
        }
        self.witness(point.to_vec())
    }

    fn witness(&self, point: Vec<Rational>) -> Option<Witness> {
        let at = self.p.count(&point);
        Some(Witness { point, at })
    }

    pub(super) fn search(&self) -> Search<'_, F> {
        Search::new(self.p, &self.sides, &self.reference)
    }

    /// A bracket of the largest factor whose box is stable, of relative width `gap`, or as close as the proof comes.
    ///
    /// `most` bounds the factor where the parameters' domains end. The upper end is where stability is lost on one line from
    /// the nominal point; the lower end is proved. Where a proof fails at a point, the upper end moves there.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out before anything is proved.
    pub fn largest_factor(
        &self,
        gap: &Rational,
        most: Option<&Rational>,
        budget: &Budget,
    ) -> Result<LargestFactor, Exhausted> {
        self.bracket(self.searched(budget)?, None, &|_| gap.clone(), most, budget)
    }

    /// The nearest points that are not stable, as far as a search without proof finds them.
    pub fn searched(&self, budget: &Budget) -> Result<Search<'_, F>, Exhausted> {
        budget.step("looking for the worst point");
        let mut search = self.search();
        budget.enter(|| search.run(self.scale))?;
        Ok(search)
    }

    /// What a search found within the box of a factor.
    pub fn refuted(&self, search: &Search<F>, factor: &Rational) -> Option<Witness> {
        let best = search.best.as_ref().filter(|best| best.hi <= *factor)?;
        self.witness(search.line(&best.direction).witness(&best.lo, &best.hi)?)
    }

    /// [`ToleranceProblem::largest_factor`] from a search and the proof of the box of factor 1, if there is one, with a relative width
    /// that depends on the upper end.
    pub fn bracket(
        &self,
        search: Search<F>,
        known: Option<BoxProof>,
        gap: &dyn Fn(&Rational) -> Rational,
        most: Option<&Rational>,
        budget: &Budget,
    ) -> Result<LargestFactor, Exhausted> {
        self.bracket_from((search, CELLS), known.map(|proof| (Rational::ONE, proof)), (gap, most), budget)
    }

    fn bracket_from(
        &self,
        (search, cells): (Search<F>, usize),
        proved: Option<(Rational, BoxProof)>,
        (gap, most): (Gap<'_>, Option<&Rational>),
        budget: &Budget,
    ) -> Result<LargestFactor, Exhausted> {
        budget.step("proving the largest box");
        let mut bracketing = Bracketing::new(self, search, proved, (gap, most), budget);
        let mut may_be_told = self.p.may_be_told_by_signs();
        while let Some(target) = bracketing.target() {
            let outcome = self.attempt(&target, if may_be_told { FEW_CELLS } else { cells }, budget);
            let is_proved_or_ended = matches!(outcome, Ok(Outcome::Stable(_)) | Err(_));
            if !is_proved_or_ended && std::mem::take(&mut may_be_told) {
                let best = bracketing.search.best.clone();
                let closer =
                    |told: &ToleranceProblem<'_, F>| told.closer(best, bracketing.proved.clone(), (gap, most), budget);
                match self.by_signs(closer, budget) {
                    Ok(Some(found)) => return Ok(found),
                    Ok(None) => budget.step("proving the largest box"),
                    Err(exhausted) => {
                        bracketing.exhausted(exhausted)?;
                        break;
                    }
                }
            }
            let goes_on = match outcome {
                Err(exhausted) => bracketing.exhausted(exhausted)?,
                Ok(Outcome::Stable(proof)) => {
                    bracketing.proved(target, proof);
                    true
                }
                Ok(Outcome::Refuted(point)) => bracketing.refuted(&point)?,
                Ok(Outcome::Open { why, cell }) => bracketing.left_open(&target, why, cell),
            };
            if !goes_on {
                break;
            }
        }
        let (search, proved, open) = bracketing.into_parts();
        Ok(self.bracketed(search, proved, open))
    }

    /// The bracket from a crossing and a proof that are known.
    fn closer(
        &self,
        crossing: Option<Crossing>,
        proved: Option<(Rational, BoxProof)>,
        (gap, most): (Gap<'_>, Option<&Rational>),
        budget: &Budget,
    ) -> Result<LargestFactor, Exhausted> {
        let mut search = self.searched(budget)?;
        if let Some(crossing) = crossing {
            let point = search.line(&crossing.direction).point(&crossing.hi);
            budget.enter(|| search.run_from(&point))?;
            if search.best.as_ref().is_none_or(|best| crossing.hi < best.hi) {
                search.best = Some(crossing);
            }
        }
        self.bracket_from((search, CELLS_OF_SIGNS), proved, (gap, most), budget)
    }

    /// A factor a little larger than that of the worst point, and the point of the same line there.
    pub fn just_beyond(&self, found: &LargestFactor) -> Option<(Rational, Vec<Rational>)> {
        let crossing = found.crossing.as_ref()?;
        let factor = &crossing.hi * &(&Rational::ONE + &Rational::dyadic(&Integer::ONE, BEYOND));
        let point = self.search().line(&crossing.direction).point(&factor);
        Some((factor, point))
    }

    /// A point that is not stable bounds the factor, however the line to it runs.
    pub(super) fn reaches(&self, search: &mut Search<F>, point: &[Rational]) -> bool {
        let Some(direction) = search.towards(point) else { return false };
        let line = search.line(&direction);
        let factor = self.search().factor_of(point);
        let best = search.best.as_ref().map(|b| b.hi.clone());
        if best.is_some_and(|best| best <= factor) || line.is_good(&factor) {
            return false;
        }
        let Some((lo, hi)) = line.narrowed(Rational::ZERO, factor, 60) else { return false };
        search.best = Some(Crossing { direction, lo, hi });
        true
    }

    /// The least factor whose box holds a point of a cell.
    pub(super) fn nearest_factor(&self, cell: &[[Rational; 2]]) -> Rational {
        let sides = self.sides.iter().zip(cell);
        let nearest = |(side, [low, high]): (&Side, &[Rational; 2])| side.nominal().max(low).min(high).clone();
        self.search().factor_of(&sides.map(nearest).collect::<Vec<_>>())
    }

    fn bracketed(&self, search: Search<F>, proved: Option<(Rational, BoxProof)>, open: Option<Open>) -> LargestFactor {
        let (lower, proof) = match proved {
            Some((lower, proof)) => (lower, Some(proof)),
            None => (Rational::ZERO, None),
        };
        let crossing = search.best.clone();
        let witness = crossing.as_ref().and_then(|c| {
            let point = search.line(&c.direction).witness(&c.lo, &c.hi)?;
            self.witness(point)
        });
        LargestFactor {
            lower,
            proof,
            upper: crossing.as_ref().map(|c| c.hi.clone()),
            direction: crossing.as_ref().map(|c| c.direction.clone()),
            shares: crossing.as_ref().and_then(|c| search.shares(c)),
            witness,
            open,
            crossing,
        }
    }
}
