//! The steps that narrow the bracket of the largest factor: the next factor to try, and what each outcome changes.

use super::factor::ToleranceProblem;
use super::family::Family;
use super::largest::lowered;
use super::prove::BoxProof;
use super::reason::OpenReason;
use super::search::Search;
use super::sides::at_factor;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};

/// How often a box that is not decided is made smaller.
const RETREATS: u32 = 6;

/// How often a box is made as small as leaves out the cell at which its proof ended, before it is made smaller by a share.
const WITHDRAWALS: u32 = 8;

/// How often the upper end moves to a point at which a proof failed.
const REFUTATIONS: u32 = 64;

/// After so many refutations that hardly moved the end, boxes halfway to it are tried.
const CRAWLS: u32 = 2;

/// After so many of any kind it is so, too.
const MANY: u32 = 8;

/// A refutation hardly moves the end if it moves it by less than this share of it.
const CRAWL: (i64, i64) = (1, 16);

/// All corners of so many parameters are tried where a proof does not come through.
const MOST_FOR_CORNERS: usize = 6;

/// Without any crossing the largest factor that is proved.
const FAR: i64 = 1 << 10;

/// Where a proof of a closer bracket ended.
pub(super) type Open = (OpenReason, Vec<[Rational; 2]>);

/// The relative width of a bracket, by its upper end.
pub(super) type Gap<'b> = &'b dyn Fn(&Rational) -> Rational;

/// The bracket of the largest factor so far, and how often each kind of step was taken.
pub(super) struct Bracketing<'b, 'a, F: Family> {
    of: &'b ToleranceProblem<'a, F>,
    gap: Gap<'b>,
    /// Where the domains end.
    most: Option<&'b Rational>,
    budget: &'b Budget,
    /// The upper end.
    pub search: Search<'b, F>,
    /// The lower end.
    pub proved: Option<(Rational, BoxProof)>,
    open: Option<Open>,
    /// The same before the end moved.
    earlier: Option<Open>,
    /// The gap is so many times as wide.
    coarser: Rational,
    /// The box does not reach the cell at which a proof ended: there stability may be touched and not lost.
    beneath: Option<Rational>,
    withdrawals: u32,
    retreats: u32,
    refutations: u32,
    /// True as long as boxes stay away from the end: where a nearer end exists, such a box is refuted rather than left open.
    is_rough: bool,
    /// How often a refutation hardly moved the end: then boxes halfway to it are tried.
    crawls: u32,
}

impl<'b, 'a, F: Family> Bracketing<'b, 'a, F> {
    pub fn new(
        of: &'b ToleranceProblem<'a, F>,
        search: Search<'b, F>,
        proved: Option<(Rational, BoxProof)>,
        (gap, most): (Gap<'b>, Option<&'b Rational>),
        budget: &'b Budget,
    ) -> Self {
        Bracketing {
            of,
            gap,
            most,
            budget,
            search,
            proved,
            open: None,
            earlier: None,
            coarser: Rational::ONE,
            beneath: None,
            withdrawals: 0,
            retreats: 0,
            refutations: 0,
            is_rough: true,
            crawls: 0,
        }
    }

    /// The factor whose box is tried next; `None` where a larger one is proved.
    pub fn target(&mut self) -> Option<Rational> {
        if let Some(hi) = self.search.best.as_ref().map(|best| best.hi.clone()) {
            let share = &(self.gap)(&hi) * &Rational::dyadic(&Integer::ONE, 3);
            // A budget that runs out is noticed by the proof.
            let _ = self.budget.enter(|| self.search.sharpen(&share));
        }
        let least = Rational::new(1.into(), 1000.into());
        let is_new = |target: &Rational| self.proved.as_ref().is_none_or(|(lower, _)| lower < target);
        let rough = Some(self.below_end(&least)).filter(|target| self.is_rough && is_new(target));
        let target = rough.or_else(|| Some(self.below_end(&Rational::ZERO)).filter(is_new))?;
        match (self.crawls(), self.end()) {
            (true, Some(end)) => Some(self.halfway_to(end).filter(is_new).unwrap_or(target)),
            _ => Some(target),
        }
    }

    /// The factor before which boxes are tried; `None` where nothing bounds it.
    fn end(&self) -> Option<&Rational> {
        self.search.best.as_ref().map(|b| &b.lo).into_iter().chain(self.most).chain(&self.beneath).min()
    }

    /// A factor before the end by the gap, or at least by so large a share of it.
    fn below_end(&self, least: &Rational) -> Rational {
        let Some(end) = self.end() else { return Rational::from(FAR) };
        let gap = (&(self.gap)(end) * &self.coarser).max(least.clone());
        lowered(end, &gap.min(Rational::new(7.into(), 8.into())))
    }

    /// A factor of few digits about in the middle between what is proved and the end.
    fn halfway_to(&self, end: &Rational) -> Option<Rational> {
        let proved = self.proved.as_ref().map_or(Rational::ZERO, |(lower, _)| lower.clone());
        let share = (end - &proved).checked_div(end)?;
        share.sign().is_gt().then(|| lowered(end, &(&share * &Rational::new(2.into(), 3.into()))))
    }

    /// An attempt was ended by the budget.
    pub fn exhausted(&mut self, exhausted: Exhausted) -> Result<bool, Exhausted> {
        if self.proved.is_none() {
            return Err(exhausted);
        }
        self.open.get_or_insert((OpenReason::Time, Vec::new()));
        Ok(false)
    }

    /// The box of a factor is stable.
    pub fn proved(&mut self, factor: Rational, proof: BoxProof) {
        self.proved = Some((factor, proof));
        self.is_rough = false;
    }

    /// A box was refuted by a point; whether there is more to try.
    pub fn refuted(&mut self, point: &[Rational]) -> Result<bool, Exhausted> {
        self.refutations += 1;
        if self.refutations > REFUTATIONS {
            self.open = Some((OpenReason::Refutations, Vec::new()));
            return Ok(false);
        }
        self.budget.step("looking for the worst point");
        let before = self.search.best.as_ref().map(|best| best.hi.clone());
        let nearer = self.budget.enter(|| self.search.run_from(point));
        self.budget.step("proving the largest box");
        let is_bounded = nearer.is_err() || self.of.reaches(&mut self.search, point);
        match nearer {
            Ok(false) if !is_bounded => {
                self.open = Some((OpenReason::Unreached, Vec::new()));
                Ok(false)
            }
            Err(exhausted) if self.proved.is_none() => Err(exhausted),
            Err(_) => {
                self.open = Some((OpenReason::Time, Vec::new()));
                Ok(false)
            }
            Ok(_) => {
                let kept = Rational::ONE - Rational::new(CRAWL.0.into(), CRAWL.1.into());
                let now = self.search.best.as_ref().map(|best| &best.hi);
                self.crawls += u32::from(before.zip(now).is_some_and(|(before, now)| *now > &before * &kept));
                self.begin_again();
                Ok(true)
            }
        }
    }

    /// A new end, a new attempt at the full precision.
    fn begin_again(&mut self) {
        (self.coarser, self.retreats) = (Rational::ONE, 0);
        self.earlier = self.open.take().or(self.earlier.take());
        self.is_rough = self.proved.is_none();
    }

    /// Whether refutations alone do not bring the ends together.
    fn crawls(&self) -> bool {
        self.crawls >= CRAWLS || self.refutations >= MANY
    }

    /// What the bracket is at the end, with why it is not narrower if it is wider than was asked for.
    pub fn into_parts(mut self) -> (Search<'b, F>, Option<(Rational, BoxProof)>, Option<Open>) {
        self.beneath = None;
        self.coarser = Rational::from(2);
        let nearest = self.below_end(&Rational::ZERO);
        let is_narrow = self.proved.as_ref().is_some_and(|(lower, _)| nearest <= *lower);
        let open = self.open.or(self.earlier).filter(|_| !is_narrow);
        (self.search, self.proved, open)
    }

    /// A box was not decided; whether there is more to try.
    pub fn left_open(&mut self, factor: &Rational, why: OpenReason, cell: Vec<[Rational; 2]>) -> bool {
        // Where the proof does not come through, a point may be that the search has missed.
        self.refutations += 1;
        if self.refutations <= REFUTATIONS && matches!(self.budget.enter(|| self.has_missed(factor, &cell)), Ok(true)) {
            self.begin_again();
            return true;
        }
        let nearest = self.of.nearest_factor(&cell);
        self.open.get_or_insert((why, cell));
        let is_progress = self.proved.as_ref().map_or(!nearest.is_zero(), |(lower, _)| *lower < nearest);
        if self.withdrawals < WITHDRAWALS && is_progress && nearest < *factor {
            self.withdrawals += 1;
            self.beneath = Some(nearest);
            return true;
        }
        if self.crawls() {
            self.beneath = Some(factor.clone());
        }
        self.retreats += 1;
        self.coarser = &self.coarser * &Rational::from(16);
        self.retreats <= RETREATS
    }

    /// Whether a search from the middle of a cell, or from one of the box's corners where these are few, finds a nearer end.
    fn has_missed(&mut self, factor: &Rational, cell: &[[Rational; 2]]) -> bool {
        let sides = at_factor(&self.of.sides, factor);
        let middle: Vec<Rational> = cell.iter().map(|[lo, hi]| lo.midpoint(hi)).collect();
        if middle.len() == sides.len() && self.search.run_from(&middle) {
            return true;
        }
        if sides.len() > MOST_FOR_CORNERS {
            return false;
        }
        (0..1usize << sides.len()).fold(false, |is_nearer, corner| {
            let point: Vec<Rational> =
                sides.iter().enumerate().map(|(i, side)| side[corner >> i & 1].clone()).collect();
            self.search.run_from(&point) || is_nearer
        })
    }
}
