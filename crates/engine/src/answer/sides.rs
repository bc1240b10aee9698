//! On which side of the real axis a complex loop has the root that limits it. Its boundary functions are those of `D conj(D)`, whose roots are
//! those of `D` and their conjugates: so they tell the modulus of an angle, and `D` itself the sign.

use crate::error::Error;
use crate::model::ComplexPolynomial;
use crate::precisions::SIDE_OF_ROOT;
use crate::problem::{Beside, Bound, ComplexFunction, Problem, Region};
use crate::response::root_on_boundary;
use crate::stability::{Cause, ComplexPair, End, Shape, Side, StableSet};
use jurist_algebra::ball::{Ball, cos_sin};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::real::Real;

/// Work that the polynomial may be where the set has been found without it.
const WORK: u64 = 100_000_000;

impl Problem {
    /// Names the ends of a complex loop's set by its own roots: `complex root` with the side that it is on, and `complex pair` where there is
    /// one on either side. Where that is not told no frequency is left.
    ///
    /// Cost: enclosures of the polynomial's coefficients at each end, with more bits until one of two values is seen not to be zero.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub(super) fn with_sides(&self, mut set: StableSet, budget: &Budget) -> Result<StableSet, Error> {
        if !self.is_written_complex() {
            return Ok(set);
        }
        budget.step("the sides of the roots");
        if self.algebra_over_symbols(&budget.clone().within_work(WORK)).is_err() {
            budget.check()?;
            // Its set was found without the polynomial: by enclosures, or one order after another.
            for end in set.ends_mut().filter(|end| end.causes.contains(Cause::ComplexPair)) {
                end.causes.of_complex_loop();
                end.pair = None;
            }
            return Ok(set);
        }
        for end in set.ends_mut() {
            *end = self.with_side(end.clone(), budget)?;
        }
        Ok(set)
    }

    /// The same of one end.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub(super) fn with_side(&self, mut end: End, budget: &Budget) -> Result<End, Error> {
        let algebra = self.evaluated().filter(|_| end.causes.contains(Cause::ComplexPair));
        let Some((algebra, whole)) = algebra.and_then(|algebra| Some((algebra, algebra.complex()?))) else {
            return Ok(end);
        };
        let sides = Beside::of(algebra.symbols(), self.free().len()).and_then(|beside| {
            let whole = whole.try_map(|f| Some(beside.placed(f))).expect("every function has a place");
            Sides::new(whole, beside, self.region().clone())
        });
        match sides {
            Ok(sides) => budget.enter(|| sides.name(&mut end))?,
            Err(_) => {
                end.causes.of_complex_loop();
                end.pair = None;
            }
        }
        if end.pair.is_none() && end.causes.contains(Cause::ComplexRoot) {
            end.pair = self.exact_root(&end, budget)?;
            if end.pair.as_ref().is_some_and(|pair| pair.side() == Side::Both) {
                end.causes.remove(Cause::ComplexRoot);
                end.causes.insert(Cause::ComplexPair);
            }
        }
        Ok(end)
    }

    /// The root at an end that is a rational number, where several roots are on the boundary at once: enclosures do not tell them.
    fn exact_root(&self, end: &End, budget: &Budget) -> Result<Option<ComplexPair>, Error> {
        let Some(value) = end.value.exact() else { return Ok(None) };
        let symbols = self.algebra_over_symbols(budget)?.symbols();
        let whole = self.complex_in_region(budget)?.filter(|_| !symbols.is_moving());
        let at_value = |f: &RationalFunction| f.substitute(0, &value)?.map_variables(|i| i.saturating_sub(1));
        let Some(whole) = whole.and_then(|whole| whole.try_map(at_value)) else { return Ok(None) };
        match root_on_boundary(&whole, symbols, self.shape(), budget) {
            // The end stands without it.
            Err(Error::Stopped(stopped)) if stopped.stop.is_precision() => Ok(None),
            found => found,
        }
    }
}

/// A complex polynomial in one parameter, by which ends are named.
pub(crate) struct Sides {
    whole: ComplexPolynomial,
    function: ComplexFunction,
    beside: Beside,
    region: Region,
}

impl Sides {
    /// Of a polynomial over the parameter (variable 0) and what is beside it, whose roots are to lie in a region.
    ///
    /// # Errors
    /// As [`ComplexFunction::new`].
    pub fn new(whole: ComplexPolynomial, beside: Beside, region: Region) -> Result<Sides, Error> {
        let function = ComplexFunction::new(&whole, &beside)?;
        Ok(Sides { whole, function, beside, region })
    }

    /// Names an end that a complex pair of `D conj(D)` makes.
    pub fn name(&self, end: &mut End) {
        if !end.causes.contains(Cause::ComplexPair) {
            return;
        }
        let side = end.pair.as_ref().and_then(|pair| self.side(pair, &end.value));
        if side != Some(Side::Both) {
            end.causes.of_complex_loop();
        }
        end.pair = end.pair.take().zip(side).map(|(pair, side)| pair.on_side(side));
    }

    /// The side that the root at an end is on: where `D` may vanish on either side, both if it is a factor with real coefficients that does.
    fn side(&self, pair: &ComplexPair, value: &Real) -> Option<Side> {
        let vanishes_at = |whole: &ComplexFunction, bits: u64| {
            let place = match pair.region() {
                Shape::UnitDisc => pair.angle(bits),
                Shape::LeftHalfPlane => pair.angular_frequency(bits),
            };
            let place = place.map(|place| Ball::from_enclosure(&place, bits));
            let (lo, hi) = value.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
            let parameter = Ball::between(&lo, &hi, bits);
            let vanishes = |place: &Ball| self.may_vanish(place, &parameter, whole);
            place.and_then(|place| Some([vanishes(&place)?, vanishes(&place.neg())?]))
        };
        let side = SIDE_OF_ROOT.bits().find_map(|bits| match vanishes_at(&self.function, bits) {
            Some([true, false]) => Some(Side::Upper),
            Some([false, true]) => Some(Side::Lower),
            _ => None,
        });
        side.or_else(|| {
            let others = ComplexFunction::new(&self.whole.without_real_factor()?, &self.beside).ok()?;
            let is_elsewhere = |bits: u64| vanishes_at(&others, bits) == Some([false, false]);
            SIDE_OF_ROOT.bits().any(is_elsewhere).then_some(Side::Both)
        })
    }

    /// Whether a function may vanish at a point of the region's boundary, given by its angle or frequency; `None` where something may be divided by
    /// zero.
    fn may_vanish(&self, place: &Ball, parameter: &Ball, whole: &ComplexFunction) -> Option<bool> {
        let bits = place.bits();
        let number = |bound: &Bound| match bound {
            Bound::Number(value) => Ball::from_rational(value, bits),
            Bound::Free => parameter.clone(),
        };
        let [x, y] = match &self.region {
            Region::Disc(radius) => {
                let ((cosine, sine), radius) = (cos_sin(place), number(radius));
                [cosine.mul(&radius), sine.mul(&radius)]
            }
            Region::HalfPlane(decay) => [number(decay).neg(), place.clone()],
        };
        whole.may_vanish(parameter, [&x, &y])
    }
}
