//! The largest factor as an algebraic number: that nothing in the box is worse than its corner.
//!
//! Let `r*` be the first zero on the line to a corner, `r1 < r*` proved, `r2 > r*` (below `2 r1`) with no other critical zero of
//! the line between, and let all zeros `(v, p)` of the pair with `p` in the box of `r2` lie in a cell `C` at the corner. Of each
//! zero let `rho` be the least factor whose box holds `p`, and `tau_i >= 0` the distance of `p_i` from that box's corner. Let the
//! determinants `det(P_v, P_(p_i))`, times the corner's signs, have one sign on `C` (zero is allowed), and one of them, of a
//! parameter whose corner moves with the factor, a strict one. Then the Jacobian by `(v, rho)`, their weighted sum, has no zero
//! on `C`, and by the implicit function theorem zeros go along as a `tau_i` shrinks, with `rho` not growing; they stay in `C`. So a
//! zero of least `rho` can be taken on the line, and its factor is `r*`. Of a real root, and of what signs tell, see
//! [`super::exact_signs`].
//!
//! One parameter may be inside of its side: it stays where it is along these paths, and at the zero of least `rho` its
//! determinant vanishes too, which [`super::tangent`] turns into a polynomial in the factor.

use super::critical::{CELLS, CriticalCell, around, cover};
use super::determinants::{derivatives, product};
use super::factor::ToleranceProblem;
use super::family::Path;
use super::largest::LargestFactor;
use super::polynomial::Bundle;
use super::prove::{closed_by_constant, closed_by_vector, keeps_sign};
use super::search::ray;
use super::sides::{Side, at_factor};
use super::tangent::touching;
use super::tensor::{FrequencyScale, Tensor, expand};
use super::tree::Tree;
use crate::{Cause, End};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::RealAlgebraic;
use jurist_algebra::real::Real;

/// Halvings of the parameters' sides at the corner, tried one after the other.
pub(super) const DEPTHS: [u32; 7] = [2, 4, 6, 9, 13, 18, 24];

/// How much beyond the end the box is taken: this share of it.
const BEYOND: u64 = 52;

/// Why the end of the worst line is the largest factor.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ExactProof {
    /// The box of this factor was proved to be stable.
    pub from: Rational,
    /// Up to the box of this factor there is nothing worse than the corner.
    pub to: Rational,
    /// The largest factor.
    pub value: Real,
    /// Where each parameter is at the worst point.
    pub place: Vec<Place>,
    /// Of the pair, or of each polynomial in the parameters that vanishes then: where all of its zeros are.
    pub covers: Vec<Cover>,
}

impl ExactProof {
    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.covers.iter().map(|cover| cover.tree.leaves()).sum()
    }
}

/// Where the zeros of the pair, or of a polynomial in the parameters, are in a box.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Cover {
    /// All of them are in this cell, which [`Tree`] marks `c`.
    pub cell: CriticalCell,
    /// Cells of frequency and parameters (of parameters alone for a polynomial in these) without a zero, but for those in the critical one.
    pub tree: Tree,
}

/// Where a parameter is at the worst point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// At the lower end of its side.
    Low,
    /// At the upper end of its side.
    High,
    /// Between.
    Inside,
}

impl ToleranceProblem<'_> {
    /// Whether the end of the worst line is the largest factor; `None` where that is not proved.
    ///
    /// `zeros` are the critical factors of the line. Cost: that of a proof of one box for each depth that is tried, and
    /// Bernstein coefficients of the derivatives.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn exact(
        &self,
        factor: &LargestFactor,
        end: &End,
        zeros: &[RealAlgebraic],
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        budget.step("proving the exact factor");
        let from = factor.lower.clone();
        let Some(direction) = &factor.direction else { return Ok(None) };
        let narrow = end.value.refined_to_digits(30);
        let top = narrow.enclosure().1;
        let to = &top + &(&top * &Rational::dyadic(&Integer::ONE, BEYOND));
        let to = super::line::rounded(&to, BEYOND + 8);
        if to <= top || from >= narrow.enclosure().0 || &from + &from <= to || factor.proof.is_none() {
            return Ok(None);
        }
        let causes: Vec<Cause> = end.causes.iter().collect();
        let worst = WorstLine { direction, interval: [&from, &to], end, zeros };
        let by_signs = || self.by_signs(|told| told.exact_by_signs(&worst, budget), budget).map(Option::flatten);
        // A parameter that does not matter may be anywhere; that one that does is inside of its side takes an elimination to prove.
        let is_inside = worst.places().contains(&Place::Inside);
        if is_inside && let Some(found) = by_signs()? {
            return Ok(Some(found));
        }
        let found = budget.enter(|| match causes.as_slice() {
            [Cause::ComplexPair] => self.exact_pair_along(&worst, factor, budget),
            [_] => self.exact_real(&worst, budget),
            _ => Ok(None),
        })??;
        // Several things may happen at one corner, and one of them more than once.
        if found.is_some() || is_inside { Ok(found) } else { by_signs() }
    }

    fn exact_pair_along(
        &self,
        worst: &WorstLine<'_>,
        factor: &LargestFactor,
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        let direction = worst.direction;
        let Some(shares) = &factor.shares else { return Ok(None) };
        // A parameter that stays at its nominal value may be one on which the zero does not depend: any side will do then.
        let mut tried = None;
        for idle in [Place::High, Place::Inside] {
            let Some(place) = self.places(direction, idle).filter(|place| tried.as_ref() != Some(place)) else {
                continue;
            };
            let Some(value) = self.candidate(&place, worst, budget)? else { continue };
            let idle = direction.iter().map(Rational::is_zero).collect();
            let known = Known { worst, value, place: place.clone(), idle };
            let found = self.exact_pair(known, shares, factor, budget)?;
            if found.is_some() {
                return Ok(found);
            }
            tried = Some(place);
        }
        Ok(None)
    }

    /// A real root that reaches the boundary, while no pair does.
    fn exact_real(&self, worst: &WorstLine<'_>, budget: &Budget) -> Result<Option<ExactProof>, Exhausted> {
        let sides = at_factor(&self.sides, worst.interval[1]);
        let mut nowhere = vec![[Rational::ZERO, Rational::ONE]; sides.len()];
        nowhere.push([Rational::from(2), Rational::from(3)]);
        if self.cover(&sides, &CriticalCell { parts: nowhere }, false, budget)?.is_none() {
            return Ok(None);
        }
        self.exact_by_signs(worst, budget)
    }

    /// The only factor in an interval at which a zero can come first, by where the parameters are then.
    fn candidate(&self, place: &[Place], worst: &WorstLine<'_>, budget: &Budget) -> Result<Option<Real>, Exhausted> {
        let [from, to] = worst.interval;
        let Some(inside) = place.iter().position(|p| *p == Place::Inside) else {
            let between = |z: &&RealAlgebraic| z.compare_rational(from).is_gt() && z.compare_rational(to).is_le();
            return Ok((worst.zeros.iter().filter(between).count() == 1).then(|| worst.end.value.clone()));
        };
        let line = ray(&self.sides, worst.direction);
        Ok(touching(&self.p.pair(), &line, inside, worst.interval, budget)?.map(Real::from))
    }

    /// Where the parameters are in a direction, those at their nominal value `idle`; `None` where more than one is inside of its
    /// side.
    fn places(&self, direction: &[Rational], idle: Place) -> Option<Vec<Place>> {
        let pair = self.p.pair();
        let place = |((c, side), &degree): ((&Rational, &Side), &usize)| {
            let [low, high] = side.widths();
            if c.abs() == Rational::ONE {
                return if c.is_negative() { Place::Low } else { Place::High };
            }
            // The corner on a side without width is the nominal value; without influence any side will do.
            match () {
                () if low.is_zero() => Place::Low,
                () if high.is_zero() || degree == 0 => Place::High,
                () if c.is_zero() => idle,
                () => Place::Inside,
            }
        };
        let places: Vec<Place> = direction.iter().zip(&self.sides).zip(&pair.degrees).map(place).collect();
        (places.iter().filter(|p| **p == Place::Inside).count() <= 1).then_some(places)
    }

    /// The part of a side around where a parameter is, of so many halvings; `None` where a parameter that is inside comes
    /// too near to the ends.
    fn part(&self, known: &Known<'_>, i: usize, at: &Rational, halvings: u32) -> Option<[Rational; 2]> {
        let halvings = if known.idle[i] && known.place[i] != Place::Inside { 0 } else { halvings };
        let part = Rational::dyadic(&Integer::ONE, u64::from(halvings));
        match known.place[i] {
            Place::Low => Some([Rational::ZERO, part]),
            Place::High => Some([&Rational::ONE - &part, Rational::ONE]),
            Place::Inside => {
                let [low, high] = self.sides[i].at(known.worst.interval[1]);
                let [least, most] = self.sides[i].at(known.worst.interval[0]);
                let width = &high - &low;
                let share = (at - &low).checked_div(&width)?;
                let part = around(&share, u64::from(halvings));
                let [a, b] = part.each_ref().map(|share| &low + &(&width * share));
                (a > least && b < most).then_some(part)
            }
        }
    }

    fn exact_pair(
        &self,
        known: Known<'_>,
        shares: &[Rational],
        factor: &LargestFactor,
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        let sides = &at_factor(&self.sides, known.worst.interval[1]);
        for ((_, f), &sign) in self.p.certain.iter().zip(&self.reference) {
            if keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, CELLS, budget)?.is_err() {
                return Ok(None);
            }
        }
        let Some(crossing) = &factor.crossing else { return Ok(None) };
        let Some(v) = self.search().line(&crossing.direction).frequency(&crossing.lo) else { return Ok(None) };
        let v0 = Rational::from(4).pow(self.scale).expect("four is not zero");
        let Some(t) = v.checked_div(&(&v + &v0)) else { return Ok(None) };
        let point = self.search().line(&crossing.direction).point(&crossing.lo);
        for depth in DEPTHS {
            let halvings = |i: usize| {
                let matters =
                    known.place[i] == Place::Inside || shares[i] >= Rational::dyadic(&Integer::ONE, u64::from(depth));
                if matters { depth } else { 1 }
            };
            let parts: Option<Vec<[Rational; 2]>> =
                (0..sides.len()).map(|i| self.part(&known, i, &point[i], halvings(i))).collect();
            let Some(mut parts) = parts else { continue };
            parts.push(around(&t, u64::from(depth)));
            let cell = CriticalCell { parts };
            let [low, high] = &cell.parts[sides.len()];
            if low.is_zero() || high.is_one() || !self.turns_one_way(&known, sides, &cell, &v0) {
                continue;
            }
            if let Some(tree) = self.cover(sides, &cell, known.place.contains(&Place::Inside), budget)? {
                return Ok(Some(known.proved(cell, tree)));
            }
        }
        Ok(None)
    }

    /// Whether on the cell all determinants of the pair's derivatives by frequency and by a parameter, times the corner's
    /// signs, have the same strict sign.
    fn turns_one_way(&self, known: &Known<'_>, sides: &[[Rational; 2]], cell: &CriticalCell, v0: &Rational) -> bool {
        let mut inner: Vec<[Rational; 2]> = cell.sides(sides);
        let value = |t: &Rational| (v0 * t).checked_div(&(&Rational::ONE - t)).expect("below 1");
        inner.push(cell.parts[sides.len()].each_ref().map(value));
        let derivatives = derivatives(&self.p.pair());
        let mut ranges: Vec<(Integer, Integer)> = Vec::new();
        for values in expand(&derivatives, &inner).chunks(derivatives.width) {
            if ranges.is_empty() {
                ranges = values.iter().map(|v| (v.clone(), v.clone())).collect();
            }
            for ((low, high), v) in ranges.iter_mut().zip(values) {
                if v < low {
                    *low = v.clone();
                }
                if v > high {
                    *high = v.clone();
                }
            }
        }
        let (mut common, mut is_strict) = (None, false);
        for (i, &degree) in self.p.pair().degrees.iter().enumerate() {
            let is_high = match known.place[i] {
                Place::Inside => continue,
                place => place == Place::High,
            };
            if degree == 0 || sides[i][0] == sides[i][1] {
                continue;
            }
            let (x, y) = (&ranges[2 + 2 * i], &ranges[3 + 2 * i]);
            let (a, b) = (product(&ranges[0], y), product(x, &ranges[1]));
            let (low, high) = (&a.0 - &b.1, &a.1 - &b.0);
            let sign = match (low.sign(), high.sign()) {
                // Moving this parameter alone leaves the factor of a zero as it is.
                (Sign::Equal, Sign::Equal) => continue,
                (Sign::Greater | Sign::Equal, _) => Sign::Greater,
                (_, Sign::Less | Sign::Equal) => Sign::Less,
                _ => return false,
            };
            let sign = if is_high { sign } else { sign.reverse() };
            if *common.get_or_insert(sign) != sign {
                return false;
            }
            let moves = self.sides[i].grows() && !self.sides[i].widths()[usize::from(is_high)].is_zero();
            is_strict |= moves && !low.is_zero() && !high.is_zero();
        }
        is_strict
    }

    /// A tree of cells without a zero of the pair, but for those inside the critical cell.
    fn cover(
        &self,
        sides: &[[Rational; 2]],
        critical: &CriticalCell,
        bends: bool,
        budget: &Budget,
    ) -> Result<Option<Tree>, Exhausted> {
        let (tensor, _) = Tensor::of_pair(&self.p.pair(), sides, FrequencyScale(2 * self.scale));
        if let Some(tree) = cover(tensor.clone(), critical, &closed_by_constant, budget)? {
            return Ok(Some(tree));
        }
        // Zeros bend away from a point inside of a side only.
        if bends { cover(tensor, critical, &closed_by_vector, budget) } else { Ok(None) }
    }
}

/// The line on which stability is lost first.
pub(super) struct WorstLine<'w> {
    direction: &'w [Rational],
    /// The end is between these factors, and up to the second one nothing worse is to come.
    pub interval: [&'w Rational; 2],
    pub end: &'w End,
    /// The critical factors of the line.
    zeros: &'w [RealAlgebraic],
}

impl WorstLine<'_> {
    /// Where each parameter is at its end.
    pub fn places(&self) -> Vec<Place> {
        let place = |c: &Rational| match c.abs() == Rational::ONE {
            true if c.is_negative() => Place::Low,
            true => Place::High,
            false => Place::Inside,
        };
        self.direction.iter().map(place).collect()
    }

    /// The proof that a factor is the largest.
    pub fn proved(&self, value: Real, place: Vec<Place>, covers: Vec<Cover>) -> ExactProof {
        let [from, to] = self.interval.map(Rational::clone);
        ExactProof { from, to, value, place, covers }
    }
}

/// What the exact proof begins with.
struct Known<'w> {
    worst: &'w WorstLine<'w>,
    value: Real,
    place: Vec<Place>,
    /// Which parameters are at their nominal value, and may have no influence: the critical cell has all of their sides.
    idle: Vec<bool>,
}

impl Known<'_> {
    fn proved(self, cell: CriticalCell, tree: Tree) -> ExactProof {
        self.worst.proved(self.value, self.place, vec![Cover { cell, tree }])
    }
}
