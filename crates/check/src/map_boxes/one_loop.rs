//! Who decides single boxes of one loop.

use super::delayed::{self, Delayed};
use super::polynomial::{self, Polynomial};
use super::{Parts, Question, Sides, share_of_window};
use crate::blocks::has_several_rates;
use crate::clock::Clock;
use crate::model::{Boxed, Functions};
use crate::number::{Q, Z};
use crate::over_box::{By, FIRST, with_sources};
use crate::{Rejection, Step, is_same_time, toml};
use std::fmt;

/// A loop over a window.
pub(crate) struct OneLoop {
    window: Vec<[Q; 2]>,
    /// Whether it is complex without its factor.
    pub is_complex: bool,
    /// Whether it is known over its window alone.
    pub is_enclosed: bool,
    of: Kind,
}

/// By what the loop is judged.
enum Kind {
    Polynomial(Polynomial),
    Delayed(Delayed),
}

/// A box of the window, and what is known of the loop over it.
#[derive(Clone, Debug)]
pub struct JudgedBox {
    sides: Vec<[Q; 2]>,
    known: Known,
}

#[derive(Clone, Debug)]
enum Known {
    Polynomial(polynomial::Known),
    Delayed(delayed::Known),
}

impl JudgedBox {
    pub(crate) fn sides(&self) -> &Sides {
        &self.sides
    }

    /// With another side along an axis; nothing is known of it yet.
    pub(crate) fn with_side(&self, axis: usize, side: [Q; 2]) -> JudgedBox {
        let mut sides = self.sides.clone();
        sides[axis] = side;
        let known = match self.known {
            Known::Polynomial(_) => Known::Polynomial(polynomial::Known::default()),
            Known::Delayed(_) => Known::Delayed(delayed::Known::default()),
        };
        JudgedBox { sides, known }
    }
}

impl fmt::Display for JudgedBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, [low, high]) in self.sides.iter().enumerate() {
            write!(f, "{}[{low}, {high}]", if i == 0 { "" } else { " x " })?;
        }
        Ok(())
    }
}

impl OneLoop {
    pub fn new(model: &str, of: &Question, parts: &Parts, clock: &Clock) -> Result<Self, Rejection> {
        // Over a hyperperiod polynomials are long.
        let by = match toml::read(model).is_ok_and(|model| has_several_rates(&model)) {
            true => By::Enclosures { window: &of.window, bits: parts.bits },
            false => By::Expansion,
        };
        if of.factor.as_ref().is_some_and(|f| f.family.is_complex()) && matches!(by, By::Enclosures { .. }) {
            let reason = "a requirement of a loop with several rates has no certificate, but for a gain margin";
            return Step::Model.fails(reason);
        }
        let asked = Boxed { names: &of.names, set: &of.set, factor: of.factor.as_ref() };
        let (own, sources) = Step::Model.of(with_sources(model, asked, Functions::Moving, by, clock))?;
        Step::Model.of(is_same_time(own.discrete, of.discrete))?;
        let below = if sources.have_dead_time() { FIRST + of.window.len() } else { usize::MAX };
        let own = match by {
            By::Expansion => Step::Model.of(clock.reading(|| own.without_common(below, clock)))?,
            // Coefficients that are numbers of their own have nothing in common.
            By::Enclosures { .. } => own,
        };
        let is_complex = own.is_complex;
        let kind = if sources.have_dead_time() {
            Delayed::new(own, sources, of, parts, clock).map(Kind::Delayed)
        } else {
            Polynomial::new(own, sources, of, parts, clock).map(Kind::Polynomial)
        };
        let is_enclosed = matches!(by, By::Enclosures { .. });
        Ok(OneLoop { window: of.window.clone(), is_complex, is_enclosed, of: Step::Model.of(kind)? })
    }

    /// Whether a divisor depends on the factor.
    pub fn divides_by_factor(&self) -> bool {
        match &self.of {
            Kind::Polynomial(judge) => judge.divides_by_factor,
            Kind::Delayed(judge) => judge.divides_by_factor,
        }
    }

    /// A box of which nothing is known yet.
    pub fn over(&self, sides: Vec<[Q; 2]>) -> JudgedBox {
        let known = match self.of {
            Kind::Polynomial(_) => Known::Polynomial(polynomial::Known::default()),
            Kind::Delayed(_) => Known::Delayed(delayed::Known::default()),
        };
        JudgedBox { sides, known }
    }

    /// Refuses to keep what is known of so many boxes, where that is too much.
    pub fn keep(&self, boxes: usize, clock: &Clock) -> Result<(), String> {
        match &self.of {
            Kind::Polynomial(judge) => judge.keep(boxes, clock),
            Kind::Delayed(_) => Ok(()),
        }
    }

    /// The lower and the upper half along an axis.
    pub fn halved(&self, of: &mut JudgedBox, axis: usize, clock: &Clock) -> Result<[JudgedBox; 2], String> {
        match (&self.of, &mut of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.prepare(&of.sides, known, clock)?,
            (Kind::Delayed(judge), Known::Delayed(known)) => judge.look(&of.sides, known, clock)?,
            _ => return Err(of_another_judge()),
        }
        Ok(self.cut(of, axis))
    }

    /// The same with what is known of the box as it is.
    pub fn cut(&self, of: &JudgedBox, axis: usize) -> [JudgedBox; 2] {
        let [low, high] = &of.sides[axis];
        let middle = (low + high) / Q::from(Z::from(2));
        let known = match (&self.of, &of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.halves(known, axis).map(Known::Polynomial),
            (_, Known::Delayed(known)) => [0, 1].map(|_| Known::Delayed(known.of_a_half())),
            (_, known) => [known.clone(), known.clone()],
        };
        let sides = [[low.clone(), middle.clone()], [middle, high.clone()]];
        let mut halves = sides.into_iter().zip(known).map(|(side, known)| {
            let mut sides = of.sides.clone();
            sides[axis] = side;
            JudgedBox { sides, known }
        });
        [0, 1].map(|_| halves.next().unwrap_or_else(|| of.clone()))
    }

    /// Whether the loop is shown to be stable at every point of the closed box, or, with `stable` false, at none.
    pub fn shown(&self, of: &mut JudgedBox, stable: bool, clock: &Clock) -> Result<bool, String> {
        match (&self.of, &mut of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.shown(&of.sides, known, stable, clock),
            (Kind::Delayed(judge), Known::Delayed(known)) => {
                judge.look(&of.sides, known, clock)?;
                Ok(known.verdict() == Some(stable))
            }
            _ => Err(of_another_judge()),
        }
    }

    /// Whether a root is shown to be beyond the boundary, moved outwards by a power of two, at every point of the closed box. Of loops with dead time
    /// nothing is shown.
    pub fn has_root_beyond(&self, of: &mut JudgedBox, exponent: i64, clock: &Clock) -> Result<bool, String> {
        match (&self.of, &mut of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => {
                judge.has_root_beyond(&of.sides, known, exponent, clock)
            }
            _ => Ok(false),
        }
    }

    /// The coefficients in the middle of a box, in the half plane, times a positive number; none with dead time.
    pub fn coefficients_approximate(&self, of: &mut JudgedBox, clock: &Clock) -> Option<Vec<f64>> {
        match (&self.of, &mut of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => {
                judge.coefficients_approximate(&of.sides, known, clock)
            }
            _ => None,
        }
    }

    /// The axis along which the functions change most in a box; of one that is not known, the widest in shares of the window.
    pub fn axis(&self, of: &JudgedBox) -> usize {
        let found = match (&self.of, &of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.axis(&of.sides, &self.window, known),
            (_, Known::Delayed(known)) => known.axis(&of.sides, &self.window),
            _ => 0,
        };
        let [low, high] = &of.sides[found];
        if low < high { found } else { share_of_window(&of.sides, &self.window) }
    }
}

fn of_another_judge() -> String {
    "the box is one of another judge".into()
}
