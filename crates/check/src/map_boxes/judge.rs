//! Who decides single boxes.

use super::delayed::{self, Delayed};
use super::polynomial::{self, Polynomial};
use super::{Parts, Sides, Statement, read};
use crate::blocks::has_several_rates;
use crate::clock::Clock;
use crate::format::Json;
use crate::model::Functions;
use crate::number::{Q, Z};
use crate::over_box::{By, FIRST, with_sources};
use crate::taylor::Precision;
use crate::{Limits, Rejection, STACK, Step, toml};
use std::fmt;

/// Decides boxes of a window one by one, as the check of a map by boxes does. Who writes a certificate asks it what a checker can see.
///
/// How it decides is in [`grammar`](crate::grammar), *maps by boxes*: Taylor models of the coefficients \[MakinoBerz2003\], and the turns about zero along
/// the imaginary axis.
///
/// ```
/// use jurist_check::{BoxJudge, Limits};
/// let model = "time = 'continuous'\nparameters = { a = {}, b = {} }\nloop.characteristic = 's^2 + a*s + b'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/7",
///     "statement": {"kind": "boxes", "time": "continuous", "x": "a", "y": "b", "set": {}, "region": {"decay": "0"},
///         "window": {"x": ["-1", "3"], "y": ["1", "2"]}, "tree": "?"},
///     "order": 2, "bits": 64
/// }"#;
/// let judge = BoxJudge::new(model, certificate, &Limits::default()).unwrap();
/// let mut whole = judge.whole();
/// assert!(!judge.shows(&mut whole, true));
/// let [mut lower, upper] = judge.halves(&mut whole, 0);
/// assert!(!judge.shows(&mut lower, false), "a = 1 is stable, but a = 0 is its edge");
/// assert!(!judge.shows(&mut upper.clone(), false), "a from 1 to 3");
/// assert!(judge.shows(&mut upper.clone(), true));
/// ```
pub struct BoxJudge {
    statement: Statement,
    clock: Clock,
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
    sides: Sides,
    known: Known,
}

#[derive(Clone, Debug)]
enum Known {
    Polynomial(polynomial::Known),
    Delayed(delayed::Known),
}

impl JudgedBox {
    pub(super) fn sides(&self) -> &Sides {
        &self.sides
    }
}

impl fmt::Display for JudgedBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [[a, b], [c, d]] = &self.sides;
        write!(f, "[{a}, {b}] x [{c}, {d}]")
    }
}

impl BoxJudge {
    /// Of a certificate, whose tree is not looked at.
    ///
    /// Cost: the characteristic polynomial in all parameters and functions of them, expanded.
    ///
    /// # Errors
    /// [`Rejection`] where the certificate has not the form of one of boxes, or the model cannot be read.
    pub fn new(model: &str, certificate: &str, limits: &Limits) -> Result<Self, Rejection> {
        let read = || {
            let (statement, parts) = read(&Step::Format.of(Json::parse(certificate))?)?;
            BoxJudge::of(model, statement, &parts, Clock::new(limits.timeout))
        };
        // As a check: expressions may nest deeper than a default stack allows.
        std::thread::scope(|scope| {
            let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, read);
            thread.map_or_else(
                |_| read(),
                |thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            )
        })
    }

    pub(super) fn of(model: &str, statement: Statement, parts: &Parts, clock: Clock) -> Result<Self, Rejection> {
        // Over a hyperperiod polynomials are long.
        let by = match toml::read(model).is_ok_and(|model| has_several_rates(&model)) {
            true => By::Enclosures { window: Some(&statement.window), bits: parts.bits },
            false => By::Expansion,
        };
        let asked = (statement.names.as_slice(), statement.set.as_slice());
        let (own, sources) = Step::Model.of(with_sources(model, asked, Functions::Moving, by, &clock))?;
        if own.discrete != statement.discrete {
            let reason = "the model's time is not that of the statement".into();
            return Err(Rejection { step: Step::Model, reason });
        }
        let below = if sources.have_dead_time() { FIRST + 2 } else { usize::MAX };
        let own = match by {
            By::Expansion => Step::Model.of(clock.reading(|| own.without_common(below, &clock)))?,
            // Coefficients that are numbers of their own have nothing in common.
            By::Enclosures { .. } => own,
        };
        let of = if sources.have_dead_time() {
            Step::Model.of(Delayed::new(own, &sources, &statement, parts, &clock)).map(Kind::Delayed)?
        } else {
            let precision = Precision::new(parts.order, parts.bits);
            Step::Model.of(Polynomial::new(own, sources, &statement.extent, precision, &clock)).map(Kind::Polynomial)?
        };
        Ok(BoxJudge { statement, clock, of })
    }

    pub(super) fn statement(&self) -> &Statement {
        &self.statement
    }

    pub(super) fn clock(&self) -> &Clock {
        &self.clock
    }

    /// The whole window.
    pub fn whole(&self) -> JudgedBox {
        let known = match self.of {
            Kind::Polynomial(_) => Known::Polynomial(polynomial::Known::default()),
            Kind::Delayed(_) => Known::Delayed(delayed::Known::default()),
        };
        JudgedBox { sides: self.statement.window.clone(), known }
    }

    /// The lower and the upper half of a box in `x` (axis 0) or `y` (axis 1).
    ///
    /// Cost: that of computing the functions over the box, unless those of a larger one are precise enough for it; with dead time that of
    /// [`shows`](BoxJudge::shows).
    pub fn halves(&self, of: &mut JudgedBox, axis: usize) -> [JudgedBox; 2] {
        // Where time is over, all that follows is not shown.
        self.halved(of, axis).unwrap_or_else(|_| self.cut(of, axis))
    }

    pub(super) fn halved(&self, of: &mut JudgedBox, axis: usize) -> Result<[JudgedBox; 2], String> {
        match (&self.of, &mut of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.prepare(&of.sides, known, &self.clock)?,
            (Kind::Delayed(judge), Known::Delayed(known)) => judge.look(&of.sides, known, &self.clock)?,
            _ => return Err(of_another_judge()),
        }
        Ok(self.cut(of, axis))
    }

    fn cut(&self, of: &JudgedBox, axis: usize) -> [JudgedBox; 2] {
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

    /// How much has been done, in units of about a nanosecond. It is counted, not timed: the same for the same boxes.
    pub fn work(&self) -> u64 {
        self.clock.work()
    }

    /// The work that a check may be, in the units of [`work`](BoxJudge::work), where the texts of model and certificate have so many bytes together:
    /// what takes more is refused.
    pub fn allowed(bytes: usize) -> u64 {
        Clock::allowed(bytes)
    }

    /// Whether the loop is shown to be stable at every point of the closed box, or, with `stable` false, at none.
    ///
    /// Cost: the functions over the box, where those of a larger box are not enough; for each part of the imaginary axis, halved until it
    /// is clear of roots, `O(n^2)` operations on their coefficients. With dead time only parts of the axis are looked at that were not
    /// clear in a larger box, `O(n)` operations for each dead time.
    pub fn shows(&self, of: &mut JudgedBox, stable: bool) -> bool {
        self.shown(of, stable).unwrap_or(false)
    }

    pub(super) fn shown(&self, of: &mut JudgedBox, stable: bool) -> Result<bool, String> {
        match (&self.of, &mut of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.shown(&of.sides, known, stable, &self.clock),
            (Kind::Delayed(judge), Known::Delayed(known)) => {
                judge.look(&of.sides, known, &self.clock)?;
                Ok(known.verdict() == Some(stable))
            }
            _ => Err(of_another_judge()),
        }
    }

    /// The axis along which the functions change most in a box, 0 or 1; of one that is not known, 0 where it is the wider one in shares of
    /// the window.
    pub fn axis(&self, of: &JudgedBox) -> usize {
        let window = &self.statement.window;
        match (&self.of, &of.known) {
            (Kind::Polynomial(judge), Known::Polynomial(known)) => judge.axis(&of.sides, window, known),
            (_, Known::Delayed(known)) => known.axis(&of.sides, window),
            _ => 0,
        }
    }
}

fn of_another_judge() -> String {
    "the box is one of another judge".into()
}
