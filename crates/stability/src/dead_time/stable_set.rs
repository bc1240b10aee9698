//! The stable sets that cells of dead times, gains and other parameters make.

use super::crossing::Crossing;
use super::family::FamilyLoop;
use super::family_function::Line;
use super::gain::GainCells;
use super::gain_points::{GainPoint, Happening};
use super::quasi_polynomial::QuasiPolynomial;
use super::windows::{DelayCells, Switch};
use crate::line::{self, Common, Held, Place, Ring};
use crate::{Cause, Causes, ComplexPair, End, HalfSizePair, Range, RealInterval, Shape, StableSet, zeros_in};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, UniPoly};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};
use std::cmp::Ordering;
use std::sync::Arc;

impl DelayCells {
    /// The stable values of a parameter on which the dead time depends as a line says, of these cells of a range of dead times.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::UniPoly;
    /// use jurist_stability::dead_time::{Line, QuasiPolynomial, delay_cells};
    /// // s + exp(-tau s) is stable for tau < pi/2: with tau = 2 x for x < pi/4
    /// let p = QuasiPolynomial::new(vec![UniPoly::from_i64(&[0, 1]), UniPoly::from_i64(&[1])]).unwrap();
    /// let (budget, zero) = (Budget::unlimited(), 0.into());
    /// let cells = delay_cells(&p, &zero, None, &budget).unwrap().unwrap();
    /// let tau = Line { slope: 2.into(), offset: 0.into() };
    /// let set = cells.stable_set(&p, [Some(&zero), None], &tau, &budget).unwrap();
    /// assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.decimal(6), "0.785398");
    /// ```
    ///
    /// Cost: `O(n)`; digits of ends are computed when they are asked for.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn stable_set(
        &self,
        p: &QuasiPolynomial,
        [lower, upper]: [Option<&Rational>; 2],
        tau: &Line,
        budget: &Budget,
    ) -> Result<StableSet, Exhausted> {
        let to_parameter = |x: &Rational| (x - &tau.offset) / &tau.slope;
        let mut range = Range::between(lower.map(to_parameter), upper.map(to_parameter));
        let mut bounds = Vec::new();
        if let Some(zero) = lower.filter(|lower| lower.is_zero()) {
            let mut first = End::new(to_parameter(zero), Causes::default(), None);
            note_axis(&mut first, &p.without_delay(), budget)?;
            bounds.push(first);
        }
        let mut ends: Vec<End> = self.switches.iter().map(|switch| end_at_switch(switch, tau)).collect();
        let mut stable: Vec<bool> = self.right.iter().map(|&count| count == 0).collect();
        if tau.slope.is_negative() {
            ends.reverse();
            stable.reverse();
            std::mem::swap(&mut range.lower, &mut range.upper);
        }
        Counted { ends, stable, bounds }.stable_set(&range, budget)
    }
}

impl GainCells {
    /// The stable set of these cells of a range, cut at the zeros of polynomials where the loop is undefined as well.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::UniPoly;
    /// use jurist_stability::Range;
    /// use jurist_stability::dead_time::{GainLoop, gain_cells};
    /// // s + 1 + K exp(-s)
    /// let p = |c: &[i64]| UniPoly::from_i64(c);
    /// let gain = GainLoop::new(vec![p(&[1, 1]), p(&[])], vec![p(&[]), p(&[1])], 1.into());
    /// let (all, budget) = (Range::all(), Budget::unlimited());
    /// let cells = gain_cells(&gain, &all, &budget).unwrap().unwrap();
    /// let set = cells.stable_set(&gain.family(), &[], &all, &budget).unwrap();
    /// assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.decimal(6), "2.26183");
    /// ```
    ///
    /// Cost: comparisons of `O(n)` values for each zero.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn stable_set(
        mut self,
        family: &FamilyLoop,
        poles: &[UniPoly],
        range: &Range,
        budget: &Budget,
    ) -> Result<StableSet, Exhausted> {
        let mut bounds = Vec::new();
        for value in [&range.lower, &range.upper].into_iter().flatten() {
            let mut end = end_of_domain(family, value, budget)?;
            if poles.iter().any(|pole| pole.sign_at(value).is_eq()) {
                end.causes.insert(Cause::Pole);
            }
            bounds.push(end);
        }
        self.cut_at_poles(poles, range, budget)?;
        let ends = self.points.iter().map(|point| end_at_point(point, budget)).collect();
        let stable = self.right.iter().map(|count| *count == Some(0)).collect();
        Counted { ends, stable, bounds }.stable_set(range, budget)
    }
}

/// What cuts the line of a loop with dead time, where the roots in each cell are counted.
pub(super) struct Counted {
    /// What happens between the cells, ascending.
    pub ends: Vec<End>,
    /// True for each cell in which the loop is stable.
    pub stable: Vec<bool>,
    /// What happens at the ends of the domain.
    pub bounds: Vec<End>,
}

impl Counted {
    pub fn stable_set(&self, range: &Range, budget: &Budget) -> Result<StableSet, Exhausted> {
        let zeros = self.ends.iter().map(|end| end.value.clone()).collect();
        line::Line::new(range, zeros, self, budget).stable_set()
    }

    fn at(&self, place: Place<'_>) -> Option<&End> {
        match place.zero {
            Some(zero) => self.ends.get(zero),
            None => self.bounds.iter().find(|end| end.value.is_same(place.value)),
        }
    }
}

impl Ring for Counted {
    fn is_stable(&self, below: usize, _cell: &RealInterval) -> Result<(Option<Rational>, bool), Exhausted> {
        Ok((None, self.stable[below]))
    }

    fn held(&self, place: Place<'_>) -> Result<Held, Exhausted> {
        let causes = self.at(place).map_or_else(Vec::new, |end| end.causes.iter().collect());
        Ok(Held { causes, has_roots: true })
    }

    fn common_roots(&self, place: Place<'_>) -> Result<Common, Exhausted> {
        Ok(self.at(place).and_then(|end| end.pair.clone()).map_or(Common::Beyond, Common::Pair))
    }
}

/// What happens at a switch; the pair of lowest frequency of several.
fn end_at_switch(switch: &Switch, tau: &Line) -> End {
    let (crossing, turns) = &switch.members[0];
    let time = SwitchTime { crossing: Arc::clone(crossing), turns: *turns, tau: tau.clone() };
    let lowest = switch.members.iter().map(|(c, _)| c).max_by(|a, b| a.half_size_root().cmp(b.half_size_root()));
    let pair =
        lowest.map(|c| ComplexPair::at_half_size_root(Shape::LeftHalfPlane, Real::from(c.half_size_root().clone())));
    End::new(Transcendental::new(time), Cause::ComplexPair.into(), pair)
}

/// What happens at a point.
pub(super) fn end_at_point(point: &GainPoint, budget: &Budget) -> End {
    let (mut causes, mut pair) = (Causes::default(), None);
    note(&point.happening, &mut causes, &mut pair, budget);
    End::new(point.value.clone(), causes, pair.map(ComplexPair::at_angular_frequency))
}

/// The dead time `(theta + 2 pi k)/omega` as a value of the parameter, `(tau - offset)/slope`.
#[derive(Debug)]
struct SwitchTime {
    crossing: Arc<Crossing>,
    turns: u64,
    tau: Line,
}

impl Enclosing for SwitchTime {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let goal = Rational::dyadic(&1.into(), bits);
        let mut working = bits + 32;
        loop {
            let tau = self.crossing.dead_time(self.turns, working);
            let at = |x: &Rational| (x - &self.tau.offset) / &self.tau.slope;
            let (mut lo, mut hi) = (at(tau.lower()), at(tau.upper()));
            if self.tau.slope.is_negative() {
                (lo, hi) = (hi, lo);
            }
            if &hi - &lo <= goal {
                return Enclosure::new(lo, hi);
            }
            working += working / 2;
        }
    }

    fn origin(&self) -> Origin {
        Origin::Crossing {
            omega_squared: self.crossing.omega_squared(),
            theta: self.crossing.theta(64),
            turns: self.turns,
            // As the parameter grows.
            leaves: match self.crossing.motion() {
                Ordering::Equal => None,
                motion => Some(motion.is_gt() != self.tau.slope.is_negative()),
            },
        }
    }
}

/// Adds the roots of a polynomial on the imaginary axis to what happens at an end: `s = 0`, and the pair of lowest
/// frequency.
fn note_axis(end: &mut End, p: &UniPoly, budget: &Budget) -> Result<(), Exhausted> {
    if p.is_constant() {
        return Ok(());
    }
    if p.coeff(0).is_zero() {
        end.causes.insert(Cause::RootAtZero);
    }
    let pair = HalfSizePair::new(p, p.degree().unwrap_or(1), Shape::LeftHalfPlane);
    let common = budget.enter(|| pair.a.gcd(&pair.b))?;
    let below_zero = Range { lower: None, upper: Some(Rational::ZERO) };
    if let Some(lowest) = zeros_in(&common, &below_zero, budget)?.pop() {
        end.causes.insert(Cause::ComplexPair);
        end.pair = Some(ComplexPair::at_half_size_root(Shape::LeftHalfPlane, Real::from(lowest)));
    }
    Ok(())
}

/// The end of the domain of a parameter, with the roots that are on the axis there.
pub(super) fn end_of_domain(family: &FamilyLoop, value: &Rational, budget: &Budget) -> Result<End, Exhausted> {
    let mut end = End::new(value.clone(), Causes::default(), None);
    let Some(p) = family.at(value).filter(|_| family.is_from_axis()) else { return Ok(end) };
    if family.dead_time(value).is_zero() {
        note_axis(&mut end, &p.without_delay(), budget)?;
        return Ok(end);
    }
    note_axis(&mut end, &p.content(), budget)?;
    if p.without_delay().coeff(0).is_zero() && family.is_exact_at_zero(value) {
        end.causes.insert(Cause::RootAtZero);
    }
    if p.order() < family.order() {
        end.causes.insert(Cause::DegreeLost);
    } else if !budget.enter(|| p.has_stable_difference())? {
        end.causes.insert(Cause::Neutral);
    }
    Ok(end)
}

/// The causes, and the lowest frequency of the pairs.
fn note(happening: &Happening, causes: &mut Causes, pair: &mut Option<Real>, budget: &Budget) {
    match happening {
        Happening::RootAtZero => causes.insert(Cause::RootAtZero),
        Happening::Neutral => causes.insert(Cause::Neutral),
        Happening::DegreeLost => causes.insert(Cause::DegreeLost),
        Happening::Pole => causes.insert(Cause::Pole),
        Happening::Pair(omega) => {
            causes.insert(Cause::ComplexPair);
            let lower = pair.as_ref().is_none_or(|known| omega.compare(known, budget).is_ok_and(Ordering::is_lt));
            if lower {
                *pair = Some(omega.clone());
            }
        }
        Happening::Several(all) => all.iter().for_each(|one| note(one, causes, pair, budget)),
    }
}
