//! What is seen of all points of a box where parameters are inside of functions.

use super::look::{BoxLook, MOST_CORNERS};
use super::moving::{MovingPolynomial, POINT_BITS};
use super::moving_prove::MODEL_TERMS;
use super::parts::{corners, middle};
use super::prove::{closed_by_vector, scale_of};
use crate::symbolic::certain_count;
use crate::{RootCount, Shape};
use jurist_algebra::ball::{Ball, MultiTaylorModel, Series};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Deref;
use std::sync::{Arc, Mutex, PoisonError};

/// Cells of frequency and parameters after which a box is rather halved.
pub(super) const CELLS: usize = 96;

/// So many more for each binary digit by which a side is shorter than it is far from zero, up to so many digits.
const CELLS_PER_BIT: usize = 6;
const MOST_BITS: u64 = 64;

/// No more is remembered of points and of sides.
const MOST_KNOWN: usize = 1 << 16;

/// So many coefficients of models are remembered: some hundred megabytes.
const MOST_COEFFICIENTS: usize = 1 << 22;

/// What was found for a key; `None` where there is nothing.
struct Memory<K, V> {
    known: Mutex<HashMap<K, Option<Arc<V>>>>,
    most: usize,
}

impl<K, V> Memory<K, V> {
    fn of(most: usize) -> Self {
        Memory { known: Mutex::default(), most }
    }
}

impl<K: Eq + Hash, V> Memory<K, V> {
    fn get(&self, key: K, find: impl FnOnce() -> Option<V>) -> Option<Arc<V>> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&key) {
            return found.clone();
        }
        let found = find().map(Arc::new);
        let mut known = known();
        if known.len() >= self.most {
            known.clear();
        }
        known.insert(key, found.clone());
        found
    }
}

/// The number of roots outside that all points of a box have, or that no point is stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Everywhere {
    /// So many roots are outside.
    Outside(usize),
    /// The loop has no meaning.
    Meaningless,
}

/// A loop with what is known of its functions on sides and at points: one is looked up for many boxes.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::matrix::CharacteristicPolynomial;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::RationalFunction;
/// use jurist_algebra::symbols::{Definition, ParametricSymbols};
/// use jurist_stability::Shape;
/// use jurist_stability::boxes::{MovingLooks, MovingPolynomial};
/// // z - X + K (1 - X) with X = exp(-a): stable while K < (1 + X)/(1 - X), which is 2.16395... for a = 1
/// let [k, a, x] = [0, 1, 2].map(RationalFunction::variable);
/// let d = CharacteristicPolynomial {
///     variables: ["K", "a", "X"].map(String::from).to_vec(),
///     coefficients: vec![&k - &(&x + &(&k * &x)), RationalFunction::one()],
///     formal_degree: 1,
///     poles: Vec::new(),
///     monic: true,
/// };
/// let symbols = ParametricSymbols::new(vec![("X".into(), Definition::Exponential(-&a))]);
/// let p = MovingPolynomial::new(&d, 2, symbols, Shape::UnitDisc);
/// let (looks, budget) = (MovingLooks::of(&p), Budget::unlimited());
/// let box_of = |k: [&str; 2]| [k.map(|x| x.parse::<Rational>().unwrap()), [1, 1].map(Rational::from)];
/// assert_eq!(looks.same_stability(&box_of(["1", "2.16"]), &budget)?, Some(true));
/// assert_eq!(looks.same_stability(&box_of(["2.17", "3"]), &budget)?, Some(false));
/// assert_eq!(looks.same_stability(&box_of(["2", "3"]), &budget)?, None);
/// # Ok::<(), jurist_algebra::limits::Exhausted>(())
/// ```
pub struct MovingLooks<P> {
    p: P,
    models: Memory<Vec<[Rational; 2]>, Vec<Vec<MultiTaylorModel>>>,
    points: Memory<Vec<Rational>, Vec<Vec<Series>>>,
}

impl<P: Deref<Target = MovingPolynomial>> MovingLooks<P> {
    /// Nothing is known yet.
    pub fn of(p: P) -> Self {
        let coefficients = p.functions.iter().map(Vec::len).sum::<usize>().max(1) * MODEL_TERMS;
        let models = Memory::of((MOST_COEFFICIENTS / coefficients).clamp(1, MOST_KNOWN));
        MovingLooks { p, models, points: Memory::of(MOST_KNOWN) }
    }

    /// Whether all points of a box are stable, or none is; `None` where that is not seen. More cells are looked at in smaller boxes: next to a
    /// boundary frequencies are cut finer.
    ///
    /// Cost: Taylor models of the functions over the sides inside of them, unless these are known, and up to some hundred cells.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn same_stability(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<Option<bool>, Exhausted> {
        let bits = |[low, high]: &[Rational; 2]| {
            let (far, width) = (low.abs().max(high.abs()), high - low);
            let octaves = far.checked_div(&width).map(|ratio| ratio.ceil().bit_length());
            octaves.unwrap_or(0).min(MOST_BITS) as usize
        };
        let finest = sides.iter().map(bits).max().unwrap_or(0);
        let found = budget.enter(|| self.everywhere(sides, CELLS + CELLS_PER_BIT * finest, budget))??;
        Ok(found.map(|everywhere| everywhere == Everywhere::Outside(0)))
    }

    /// Whether a point is stable; `None` where enclosed coefficients do not tell.
    pub fn is_stable_at(&self, point: &[Rational]) -> Option<bool> {
        if !self.p.has_a_meaning_at(point) {
            return Some(false);
        }
        self.certain_at(point).map(|(count, ..)| count.outside == 0)
    }

    /// What is the same at all points of a box; `None` where that is not seen.
    ///
    /// A box is decided where Taylor models show that no root comes to the boundary and nothing that must not vanish changes its sign:
    /// then the number of roots outside is that in the middle, of which enclosed coefficients are certain.
    pub(super) fn everywhere(
        &self,
        sides: &[[Rational; 2]],
        cells: usize,
        budget: &Budget,
    ) -> Result<Option<Everywhere>, Exhausted> {
        if self.p.has_no_meaning_in(sides) {
            return Ok(Some(Everywhere::Meaningless));
        }
        // Values at points take as long as models where they are those of matrices, and models tell most of them.
        let models = || self.models.get(self.inside(sides), || self.p.models(sides));
        let first = if self.p.is_of_matrices { models() } else { None };
        let at = |point: &[Rational]| {
            let told = first.as_ref().and_then(|models| self.told(&self.parts_of(models, sides, point), point));
            told.or_else(|| self.certain_at(point))
        };
        let middle = middle(sides);
        let Some((count, signs, scale)) = at(&middle) else { return Ok(None) };
        // Another count or sign at a corner tells at once that a boundary is here.
        for corner in corners(sides).take(MOST_CORNERS) {
            let found = at(&corner);
            if found.is_some_and(|found| (found.0, &found.1) != (count, &signs)) {
                return Ok(None);
            }
        }
        checkpoint(200);
        let Some(models) = first.or_else(models) else { return Ok(None) };
        if !self.p.keeps_count(sides, &models, (&signs, scale), (&closed_by_vector, cells), budget)? {
            return Ok(None);
        }
        // What is presupposed is among what keeps its sign.
        let has_a_meaning = self.p.has_a_meaning_at(&middle);
        Ok(Some(if has_a_meaning { Everywhere::Outside(count.outside) } else { Everywhere::Meaningless }))
    }

    /// The same for a volume, with the side along which an open box is halved.
    pub(super) fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<BoxLook, Exhausted> {
        Ok(match self.everywhere(sides, CELLS, budget)? {
            Some(Everywhere::Outside(0)) => BoxLook::Stable,
            Some(_) => BoxLook::Unstable,
            None => BoxLook::Open(self.steepest_side(sides)),
        })
    }

    /// The side along which the coefficients change most, at the usual frequency of the middle; the first one where that is not known.
    fn steepest_side(&self, sides: &[[Rational; 2]]) -> usize {
        let middle = middle(sides);
        let at = |i: usize, value: &Rational| {
            let mut point = middle.clone();
            point[i] = value.clone();
            let mut values = self.values_at(&point)?;
            values.truncate(self.p.formal_degree() + 1);
            Some(values.iter().map(Ball::middle_units).collect::<Vec<Integer>>())
        };
        let scale = at(0, &middle[0]).map_or(0, |own| scale_of(&own));
        // c_k w^k, without the powers that all have in common.
        let weighted = |(k, c): (usize, Integer)| {
            let power = if scale < 0 { self.p.formal_degree() - k } else { k };
            c.abs() << (scale.unsigned_abs() * power as u64)
        };
        let change = |i: usize| {
            let [low, high] = &sides[i];
            let [one, other] = [at(i, low)?, at(i, high)?];
            let differences = one.iter().zip(&other).map(|(a, b)| a - b);
            Some(differences.enumerate().map(weighted).fold(Integer::ZERO, |sum, x| sum + x))
        };
        let is_wide = |i: &usize| sides[*i][0] < sides[*i][1];
        // Where a function is not defined, its side is cut first.
        let changes = (0..sides.len()).filter(is_wide).map(|i| (change(i), i));
        changes
            .min_by(|(a, i), (b, j)| a.is_some().cmp(&b.is_some()).then(b.cmp(a)).then(i.cmp(j)))
            .map_or(0, |(_, i)| i)
    }

    /// The sides of what is inside of functions.
    fn inside(&self, sides: &[[Rational; 2]]) -> Vec<[Rational; 2]> {
        self.p.inside.iter().map(|&i| sides[i].clone()).collect()
    }

    /// The parts of the functions in the middle of a box or at a corner, from their models in the box.
    fn parts_of(
        &self,
        models: &[Vec<MultiTaylorModel>],
        sides: &[[Rational; 2]],
        point: &[Rational],
    ) -> Vec<Vec<Series>> {
        let coordinate = |&i: &usize| i8::from(point[i] == sides[i][1]) - i8::from(point[i] == sides[i][0]);
        let coordinates: Vec<i8> = self.p.inside.iter().map(coordinate).collect();
        let value =
            |model: &MultiTaylorModel| Series::constant(&model.at_corner(&coordinates).with_bits(POINT_BITS), 1);
        models.iter().map(|parts| parts.iter().map(value).collect()).collect()
    }

    /// The root count at a point, the signs of what must not vanish, and the scale of frequencies; `None` where enclosed coefficients do
    /// not tell.
    fn certain_at(&self, point: &[Rational]) -> Option<(RootCount, Vec<Sign>, i64)> {
        self.told_by(&self.values_at(point)?)
    }

    /// The same from the parts of the functions there.
    fn told(&self, parts: &[Vec<Series>], point: &[Rational]) -> Option<(RootCount, Vec<Sign>, i64)> {
        self.told_by(&self.p.enclosed(point, parts))
    }

    fn told_by(&self, values: &[Ball]) -> Option<(RootCount, Vec<Sign>, i64)> {
        let (coefficients, beside) = values.split_at(self.p.formal_degree() + 1);
        let signs = beside.iter().map(|b| b.sign().filter(|s| s.is_ne())).collect::<Option<Vec<Sign>>>()?;
        let count = certain_count(coefficients, Shape::LeftHalfPlane)?;
        let middles: Vec<Integer> = coefficients.iter().map(Ball::middle_units).collect();
        Some((count, signs, scale_of(&middles)))
    }

    /// All functions at a point, enclosed.
    fn values_at(&self, point: &[Rational]) -> Option<Vec<Ball>> {
        let inside = self.p.inside.iter().map(|&i| point[i].clone()).collect();
        let parts = self.points.get(inside, || self.p.parts_at_point(point))?;
        Some(self.p.enclosed(point, &parts))
    }
}
