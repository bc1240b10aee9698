//! Who decides the boxes of a map.

use super::one_loop::{JudgedBox, OneLoop};
use super::{Parts, Statement, read};
use crate::clock::Clock;
use crate::format::Json;
use crate::{Limits, Rejection, STACK, Step};

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
    of: OneLoop,
}

impl BoxJudge {
    /// Of a certificate, whose tree is not looked at.
    ///
    /// Cost: the characteristic polynomial in all parameters and functions of them, expanded.
    ///
    /// # Errors
    /// [`Rejection`] where the certificate has not the form of one of boxes, or the model cannot be read.
    pub fn new(model: &str, certificate: &str, limits: &Limits) -> Result<Self, Rejection> {
        on_a_large_stack(|| {
            let (statement, parts) = read(&Step::Format.of(Json::parse(certificate))?)?;
            BoxJudge::of(model, statement, &parts, Clock::new(limits.timeout))
        })
    }

    pub(super) fn of(model: &str, statement: Statement, parts: &Parts, clock: Clock) -> Result<Self, Rejection> {
        let of = OneLoop::new(model, &statement.question, parts, &clock)?;
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
        self.of.over(self.statement.question.window.clone())
    }

    /// The lower and the upper half of a box in `x` (axis 0) or `y` (axis 1).
    ///
    /// Cost: that of computing the functions over the box, unless those of a larger one are precise enough for it; with dead time that of
    /// [`shows`](BoxJudge::shows).
    pub fn halves(&self, of: &mut JudgedBox, axis: usize) -> [JudgedBox; 2] {
        // Where time is over, all that follows is not shown.
        self.halved(of, axis).unwrap_or_else(|_| self.of.cut(of, axis))
    }

    pub(super) fn halved(&self, of: &mut JudgedBox, axis: usize) -> Result<[JudgedBox; 2], String> {
        self.of.halved(of, axis, &self.clock)
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
        self.of.shown(of, stable, &self.clock)
    }

    /// The axis along which the functions change most in a box, 0 or 1; of one that is not known, 0 where it is the wider one in shares of
    /// the window.
    pub fn axis(&self, of: &JudgedBox) -> usize {
        self.of.axis(of)
    }
}

/// As a check: expressions may nest deeper than a default stack allows.
pub(crate) fn on_a_large_stack<T: Send>(read: impl Fn() -> T + Send + Sync) -> T {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, &read);
        thread.map_or_else(|_| read(), |thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}
