//! Boxes of a window of two parameters of which at least one is inside of functions.

use super::family::Family;
use super::moving::{MovingPolynomial, POINT_BITS};
use super::prove::{closed_by_vector, scale_of};
use crate::plane::boxes::{BoxMap, BoxVerdict, Place, Seen, Window, subdivided};
use crate::symbolic::certain_count;
use crate::{RootCount, Shape};
use jurist_algebra::ball::{Ball, MultiTaylorModel, Series};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

/// Cells of frequency and parameters after which a box is rather halved.
const CELLS: usize = 96;

impl MovingPolynomial {
    /// Whether both of two parameters are inside of functions.
    pub fn is_inside_of_both(&self) -> bool {
        self.inside.len() == 2
    }

    /// Cuts a window of its two parameters into boxes until the share of the undecided area is at most `goal` (0 to 1).
    ///
    /// A box is decided where Taylor models show that no root comes to the boundary and nothing that must not vanish changes its sign:
    /// then the number of roots outside is that in the middle, of which enclosed coefficients are certain. Of a box of which that
    /// is not seen, `otherwise` may know more.
    ///
    /// Cost: Taylor models of every function for each side of boxes in a parameter that is inside of functions, and up to some hundred
    /// cells of tensors for each box.
    ///
    /// # Panics
    /// Unless there are two parameters.
    pub fn boxes(
        &self,
        window: &Window,
        goal: &Rational,
        budget: &Budget,
        otherwise: impl Fn(&Place) -> Option<Seen> + Sync,
    ) -> BoxMap {
        assert_eq!(self.parameters(), 2, "a window has two sides");
        if self.functions[self.formal_degree() + 1..].iter().any(Vec::is_empty) {
            // Undefined, a root on the boundary, or degree lost, for all values of both.
            return BoxMap::nowhere_stable(window);
        }
        let known = Known { p: self, models: Memory::default(), points: Memory::default() };
        subdivided(window, goal, budget, |place, _: Option<&()>| {
            let Window { x, y } = place.window(window);
            let seen = match known.verdict_in(&[x, y], budget)? {
                Some(verdict) => Seen::Decided(verdict),
                None => otherwise(place).unwrap_or(Seen::Cut(place.wider())),
            };
            Ok((seen, None))
        })
    }
}

/// What was found for a key; `None` where there is nothing.
struct Memory<K, V>(Mutex<HashMap<K, Option<Arc<V>>>>);

impl<K, V> Default for Memory<K, V> {
    fn default() -> Self {
        Memory(Mutex::default())
    }
}

impl<K: Eq + Hash, V> Memory<K, V> {
    fn get(&self, key: K, find: impl FnOnce() -> Option<V>) -> Option<Arc<V>> {
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&key) {
            return found.clone();
        }
        let found = find().map(Arc::new);
        known().insert(key, found.clone());
        found
    }
}

/// A loop with what is known of its functions on sides and at points: one is looked up for many boxes.
struct Known<'p> {
    p: &'p MovingPolynomial,
    models: Memory<Vec<[Rational; 2]>, Vec<Vec<MultiTaylorModel>>>,
    points: Memory<Vec<Rational>, Vec<Vec<Series>>>,
}

impl Known<'_> {
    /// What is the same at all points of a box; `None` where that is not seen.
    fn verdict_in(&self, sides: &[[Rational; 2]; 2], budget: &Budget) -> Result<Option<BoxVerdict>, Exhausted> {
        let [x, y] = sides;
        if self.p.has_no_meaning_in(sides) {
            return Ok(Some(BoxVerdict::Unstable { outside: None }));
        }
        // Values at points take as long as models where they are those of matrices, and models tell most of them.
        let models = || self.models.get(self.inside(sides), || self.p.models(sides));
        let first = if self.p.is_of_matrices { models() } else { None };
        let middle = [x, y].map(|[low, high]| low.midpoint(high));
        let at = |point: &[Rational; 2], corner: [i8; 2]| {
            let told = first.as_ref().and_then(|models| self.told(&self.at_corner(models, corner), point));
            told.or_else(|| self.certain_at(point))
        };
        let Some((count, signs, scale)) = at(&middle, [0, 0]) else { return Ok(None) };
        // Another count or sign at a corner tells at once that a boundary is here.
        for (i, j) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
            let corner = at(&[x[i].clone(), y[j].clone()], [i, j].map(|end| 2 * end as i8 - 1));
            if corner.is_some_and(|found| (found.0, &found.1) != (count, &signs)) {
                return Ok(None);
            }
        }
        checkpoint(200);
        let Some(models) = first.or_else(models) else { return Ok(None) };
        if !self.p.keeps_count(sides, &models, (&signs, scale), (&closed_by_vector, CELLS), budget)? {
            return Ok(None);
        }
        Ok(Some(match count.outside {
            // What is presupposed is among what keeps its sign.
            _ if !self.p.has_a_meaning_at(&middle) => BoxVerdict::Unstable { outside: None },
            0 => BoxVerdict::Stable,
            outside => BoxVerdict::Unstable { outside: Some(outside) },
        }))
    }

    /// The sides of what is inside of functions.
    fn inside(&self, sides: &[[Rational; 2]; 2]) -> Vec<[Rational; 2]> {
        self.p.inside.iter().map(|&i| sides[i].clone()).collect()
    }

    /// The parts of the functions in the middle of a box, or where the coordinates are at its ends.
    fn at_corner(&self, models: &[Vec<MultiTaylorModel>], corner: [i8; 2]) -> Vec<Vec<Series>> {
        let coordinates: Vec<i8> = self.p.inside.iter().map(|&i| corner[i]).collect();
        let value =
            |model: &MultiTaylorModel| Series::constant(&model.at_corner(&coordinates).with_bits(POINT_BITS), 1);
        models.iter().map(|parts| parts.iter().map(value).collect()).collect()
    }

    /// The root count at a point, the signs of what must not vanish, and the scale of frequencies; `None` where enclosed coefficients do
    /// not tell.
    fn certain_at(&self, point: &[Rational; 2]) -> Option<(RootCount, Vec<Sign>, i64)> {
        let inside = self.p.inside.iter().map(|&i| point[i].clone()).collect();
        let parts = self.points.get(inside, || self.p.parts_at_point(point))?;
        self.told(&parts, point)
    }

    /// The same from the parts of the functions there.
    fn told(&self, parts: &[Vec<Series>], point: &[Rational; 2]) -> Option<(RootCount, Vec<Sign>, i64)> {
        let values = self.p.enclosed(point, parts);
        let (coefficients, beside) = values.split_at(self.p.formal_degree() + 1);
        let signs = beside.iter().map(|b| b.sign().filter(|s| s.is_ne())).collect::<Option<Vec<Sign>>>()?;
        let count = certain_count(coefficients, Shape::LeftHalfPlane)?;
        let middles: Vec<Integer> = coefficients.iter().map(Ball::middle_units).collect();
        Some((count, signs, scale_of(&middles)))
    }
}
