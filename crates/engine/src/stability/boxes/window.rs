//! Boxes of a window of two parameters of which at least one is inside of functions.

use super::family::Family;
use super::moving::MovingPolynomial;
use super::prove::closed_by_vector;
use crate::stability::plane::boxes::{BoxMap, BoxVerdict, Place, Seen, Window, subdivided};
use crate::stability::symbolic::certain_count;
use crate::stability::{AtPoint, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// Cells of frequency and parameters after which a box is rather halved.
const CELLS: usize = 64;

impl MovingPolynomial {
    /// Cuts a window of its two parameters into boxes until the share of the undecided area is at most `goal` (0 to 1).
    ///
    /// A box is decided where Taylor models show that no root comes to the boundary and nothing that must not vanish changes its sign:
    /// then the number of roots outside is that in the middle, of which enclosed coefficients are certain. Of a box of which that
    /// is not seen, `otherwise` may know more.
    ///
    /// Cost: for each box a Taylor model of every function, in up to two variables, and up to some ten cells of tensors.
    ///
    /// # Panics
    /// Unless there are two parameters.
    pub(crate) fn boxes(
        &self,
        window: &Window,
        goal: &Rational,
        budget: &Budget,
        otherwise: impl Fn(&Place) -> Option<Seen> + Sync,
    ) -> BoxMap {
        assert_eq!(self.parameters(), 2, "a window has two sides");
        subdivided(window, goal, budget, |place| {
            let Window { x, y } = place.window(window);
            Ok(match self.verdict_in(&[x, y], budget)? {
                Some(verdict) => Seen::Decided(verdict),
                None => otherwise(place).unwrap_or(Seen::Cut(place.wider())),
            })
        })
    }

    /// Whether both parameters are inside of functions.
    pub(crate) fn is_inside_of_both(&self) -> bool {
        self.inside.len() == 2
    }

    /// What is the same at all points of a box; `None` where that is not seen.
    fn verdict_in(&self, sides: &[[Rational; 2]; 2], budget: &Budget) -> Result<Option<BoxVerdict>, Exhausted> {
        let [x, y] = sides;
        let middle = [x, y].map(|[low, high]| low.midpoint(high));
        // Rounded counts that differ tell at once that a boundary is here.
        let rounded = |point: &[Rational]| match self.at(point) {
            AtPoint::Defined { count, infinite: 0 } => Some(count.inside),
            _ => None,
        };
        let Some(inside) = rounded(&middle) else { return Ok(None) };
        let corners = [(0, 0), (1, 1), (0, 1), (1, 0)].map(|(i, j)| [x[i].clone(), y[j].clone()]);
        if corners.iter().any(|corner| rounded(corner).is_some_and(|n| n != inside)) {
            return Ok(None);
        }
        let Some((signs, scale)) = self.signs_at(&middle) else { return Ok(None) };
        let counted = self.enclosed(&middle).and_then(|balls| certain_count(&balls, Shape::LeftHalfPlane));
        let Some(count) = counted else { return Ok(None) };
        if !self.keeps_count(sides, (&signs, scale), (closed_by_vector, CELLS), budget)? {
            return Ok(None);
        }
        Ok(Some(match count.outside {
            0 => BoxVerdict::Stable,
            outside => BoxVerdict::Unstable { outside: Some(outside) },
        }))
    }
}
