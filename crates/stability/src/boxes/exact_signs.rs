//! The largest factor as an algebraic number, where polynomials in the parameters tell of it.
//!
//! Let `f` be one of them that vanishes in the box of `r2`, and let all of its zeros there lie in a cell at a corner, towards which `f` falls
//! in every parameter. A zero in the box of a smaller factor, moved to that box's corner, makes `f` no larger: so `f` vanishes on the line
//! of these corners at this factor or before. If it does so nowhere before the end of the worst line, that end is the largest factor.

use super::critical::{CELLS, CriticalCell, cover};
use super::exact::{Cover, DEPTHS, ExactProof, Place, WorstLine};
use super::factor::ToleranceProblem;
use super::line::along;
use super::polynomial::Bundle;
use super::prove::{Outcome, closed_by_sign, keeps_sign};
use super::search::ray;
use super::sides::at_factor;
use super::tensor::{Tensor, expand};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Rational, Sign};
use jurist_algebra::poly::{MultiPoly, SquareFree, isolate_real_roots};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

impl ToleranceProblem<'_> {
    /// Whether the end of the worst line is the largest factor, where no pair is on the axis before a certain polynomial vanishes.
    pub(super) fn exact_by_signs(
        &self,
        worst: &WorstLine<'_>,
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        let sides = at_factor(&self.sides, worst.interval[1]);
        let mut covers = Vec::new();
        for ((_, f), &sign) in self.p.certain.iter().zip(&self.reference) {
            let found = match keeps_sign(&Bundle::new(&[f], sides.len()), &sides, sign, CELLS, budget)? {
                Ok(_) => continue,
                Err(Outcome::Refuted(_)) => self.falls_last((f, sign), &sides, worst, budget)?,
                Err(_) => None,
            };
            match found {
                Some(cover) => covers.push(cover),
                None => return Ok(None),
            }
        }
        Ok((!covers.is_empty()).then(|| worst.proved(worst.end.value.clone(), worst.places(), covers)))
    }

    /// The cell at a corner that has all zeros of a polynomial of this sign, none of which comes before the end.
    fn falls_last(
        &self,
        (f, sign): (&MultiPoly, Sign),
        sides: &[[Rational; 2]],
        worst: &WorstLine<'_>,
        budget: &Budget,
    ) -> Result<Option<Cover>, Exhausted> {
        let Some(corner) = corner_of(f, sign, sides, &worst.places()) else { return Ok(None) };
        if self.vanishes_before(f, &corner, worst, budget)? {
            return Ok(None);
        }
        let bundle = Bundle::new(&[f], sides.len());
        for depth in DEPTHS {
            let share = Rational::dyadic(&1.into(), u64::from(depth));
            let part = |place: &Option<Place>| match place {
                None => [Rational::ZERO, Rational::ONE],
                Some(Place::High) => [&Rational::ONE - &share, Rational::ONE],
                Some(_) => [Rational::ZERO, share.clone()],
            };
            let mut parts: Vec<[Rational; 2]> = corner.iter().map(part).collect();
            parts.push([Rational::ZERO, Rational::ONE]);
            let cell = CriticalCell { parts };
            if !falls_to(f, sign, &corner, &cell.sides(sides)) {
                continue;
            }
            if let Some(tree) = cover(Tensor::of_one(&bundle, sides), &cell, &closed_by_sign(sign), budget)? {
                return Ok(Some(Cover { cell, tree }));
            }
        }
        Ok(None)
    }

    /// Whether a polynomial vanishes on the line of its corners after what is proved and before the end.
    fn vanishes_before(
        &self,
        f: &MultiPoly,
        corner: &[Option<Place>],
        worst: &WorstLine<'_>,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let direction: Vec<Rational> = corner
            .iter()
            .map(|place| match place {
                None => Rational::ZERO,
                Some(Place::High) => Rational::ONE,
                Some(_) => -Rational::ONE,
            })
            .collect();
        let (base, step) = ray(&self.sides, &direction);
        let on_line = along(&Bundle::new(&[f], base.len()), &base, &step).remove(0);
        let Some(on_line) = budget.enter(|| SquareFree::part_of(&on_line))? else { return Ok(true) };
        for zero in isolate_real_roots(&on_line, budget)? {
            let is_after = zero.compare_rational(worst.interval[0]).is_gt();
            if is_after && Real::from(zero).compare(&worst.end.value, budget)?.is_lt() {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// For each parameter the end of its side towards which a polynomial of this sign falls, by its derivatives in the box or else by where the parameter is at the worst
/// point; none of those on which it does not depend.
fn corner_of(f: &MultiPoly, sign: Sign, sides: &[[Rational; 2]], worst: &[Place]) -> Option<Vec<Option<Place>>> {
    let place = |i: usize| {
        let values = slopes(f, i, sides);
        let (rises, falls) = (values.contains(&sign), values.contains(&sign.reverse()));
        match (rises, falls) {
            (false, false) => Some(None),
            (true, false) => Some(Some(Place::Low)),
            (false, true) => Some(Some(Place::High)),
            (true, true) => (worst[i] != Place::Inside).then_some(Some(worst[i])),
        }
    };
    (0..sides.len()).map(place).collect()
}

/// Whether a polynomial of this sign nowhere rises towards a corner in a box, in any parameter.
fn falls_to(f: &MultiPoly, sign: Sign, corner: &[Option<Place>], inner: &[[Rational; 2]]) -> bool {
    let falls = |(i, place): (usize, &Option<Place>)| match place {
        None => true,
        Some(Place::High) => !slopes(f, i, inner).contains(&sign),
        Some(_) => !slopes(f, i, inner).contains(&sign.reverse()),
    };
    corner.iter().enumerate().all(falls)
}

/// The signs of the Bernstein coefficients of a derivative.
fn slopes(f: &MultiPoly, i: usize, sides: &[[Rational; 2]]) -> Vec<Ordering> {
    expand(&Bundle::new(&[&f.derivative(i)], sides.len()), sides).iter().map(|c| c.sign()).collect()
}
