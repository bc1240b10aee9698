//! Lists of roots that a checker reads forward.

use crate::line::{split, variations};
use crate::statement::number;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{RealAlgebraic, UniPoly};
use serde_json::Value;

/// The place of a root: two ends around it, or the rational root itself twice.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    pub left: Rational,
    pub right: Rational,
}

impl Place {
    pub fn is_rational(&self) -> bool {
        self.left == self.right
    }

    fn of(root: &RealAlgebraic) -> Place {
        let (left, right) = match root.exact() {
            Some(q) => (q.clone(), q),
            None => root.enclosure(),
        };
        Place { left, right }
    }

    /// Whether Descartes' rule sees one root of a polynomial between the ends and none at them.
    fn shows_one(&self, f: &UniPoly) -> bool {
        let is_root = |q: &Rational| f.sign_at(q).is_eq();
        match self.is_rational() {
            true => is_root(&self.left),
            false => {
                let count = || variations(f, &Some(self.left.clone()), &Some(self.right.clone()));
                !is_root(&self.left) && !is_root(&self.right) && count() == Some(1)
            }
        }
    }
}

/// A root that is enclosed ever closer.
pub(super) struct Enclosed {
    root: RealAlgebraic,
    pub place: Place,
}

impl Enclosed {
    /// In its own enclosure, or in a wider one that is given.
    pub fn new(root: RealAlgebraic, wide: Option<Place>) -> Enclosed {
        let place = wide.unwrap_or_else(|| Place::of(&root));
        Enclosed { root, place }
    }

    /// Encloses the root closer.
    pub fn narrow(&mut self) {
        let own = Place::of(&self.root);
        let is_wide = self.place.left < own.left || own.right < self.place.right;
        if is_wide {
            self.place =
                Place { left: own.left.max(self.place.left.clone()), right: own.right.min(self.place.right.clone()) };
            return;
        }
        let quarter = Rational::new(Integer::ONE, Integer::from(4));
        self.root = self.root.refined(&(&(&own.right - &own.left) * &quarter));
        self.place = Place::of(&self.root);
    }

    /// Narrower until Descartes' rule sees one root of its polynomial.
    pub fn alone(&mut self, f: &UniPoly, budget: &Budget) -> Result<(), Exhausted> {
        while !self.place.shows_one(f) {
            budget.check()?;
            self.narrow();
        }
        Ok(())
    }

    /// Narrower until a number is not strictly between the ends, or, for a rational root, just another number.
    pub fn away_from(&mut self, q: &Rational, budget: &Budget) -> Result<(), Exhausted> {
        while self.place.left < *q && *q < self.place.right {
            budget.check()?;
            self.narrow();
        }
        Ok(())
    }
}

/// Narrower until each root's place is behind that of the one before it.
pub(super) fn separate(roots: &mut [Enclosed], budget: &Budget) -> Result<(), Exhausted> {
    for i in 1..roots.len() {
        loop {
            budget.check()?;
            let (a, b) = (&roots[i - 1].place, &roots[i].place);
            if a.right < b.left || (a.right == b.left && !(a.is_rational() && b.is_rational())) {
                break;
            }
            roots[i - 1].narrow();
            roots[i].narrow();
        }
    }
    Ok(())
}

/// The list of the roots of one polynomial in an interval, with splits of the gaps between them.
pub(super) fn list(
    f: &UniPoly,
    lower: &Option<Rational>,
    upper: &Option<Rational>,
    places: &[Place],
    budget: &Budget,
) -> Result<Value, Exhausted> {
    let mut items = Vec::new();
    let mut before = lower.clone();
    for place in places.iter().map(Some).chain([None]) {
        let after = place.map_or(upper.clone(), |place| Some(place.left.clone()));
        if after.is_none() || before != after {
            let mut splits = Vec::new();
            split(&before, &after, std::slice::from_ref(f), &mut splits, budget)?;
            items.extend(splits.iter().map(number));
        }
        if let Some(place) = place {
            let ends = if place.is_rational() { vec![&place.left] } else { vec![&place.left, &place.right] };
            items.push(ends.into_iter().map(number).collect());
            before = Some(place.right.clone());
        }
    }
    Ok(Value::Array(items))
}
