//! Who decides the cells of a certificate of best gains.

use super::{Level, Objective, Statement, read};
use crate::clock::Clock;
use crate::for_all::{ForAllJudge, Loops};
use crate::format::Json;
use crate::map_boxes::{JudgedBox, Parts, on_a_large_stack};
use crate::number::Q;
use crate::{Limits, Rejection, Step};

/// Decides cells of gains as the check of a certificate of best gains does. Who writes a certificate asks it what a checker can see.
///
/// The loops of its [`ForAllJudge`], whose axes are the gains, are: the one that is to be stable, then one for each requirement; where a level is to be best, the
/// level of which there is none, a region as the first loop and a requirement as a further one; and a last one of the level that is found.
///
/// ```
/// use jurist_check::{Limits, TuneJudge};
/// let model = "time = 'continuous'\nparameters.K = {}\nloop.characteristic = 's^2 + s + K'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/11",
///     "statement": {"kind": "tune", "time": "continuous", "gains": [{"name": "K", "between": ["0", "9"]}], "set": {}, "region": {"decay": "1"},
///         "require": [], "objective": null, "found": null, "tree": "-0."},
///     "order": 2, "bits": 64
/// }"#;
/// let judge = TuneJudge::new(model, certificate, &Limits::default()).unwrap();
/// let whole = judge.whole(0);
/// assert!(judge.loops().shows(0, &mut whole.clone(), false), "a root is right of -1 for all K");
/// assert!(!judge.is_worse(&whole));
/// ```
pub struct TuneJudge {
    statement: Statement,
    of: ForAllJudge,
}

impl TuneJudge {
    /// Of a certificate, whose tree and proof are not looked at.
    ///
    /// Cost: that of [`ForAllJudge::new`].
    ///
    /// # Errors
    /// [`Rejection`] where the certificate has not the form of one of best gains, or the model cannot be read.
    pub fn new(model: &str, certificate: &str, limits: &Limits) -> Result<Self, Rejection> {
        on_a_large_stack(|| {
            let (statement, parts) = read(&Step::Format.of(Json::parse(certificate))?)?;
            TuneJudge::of(model, statement, &parts, Clock::new(limits.timeout))
        })
    }

    pub(super) fn of(model: &str, statement: Statement, parts: &Parts, clock: Clock) -> Result<Self, Rejection> {
        let of = ForAllJudge::of(model, statement.asked.clone(), parts, clock)?;
        if of.of_number(0).is_enclosed && matches!(statement.objective, Objective::Level(Level::Region(_))) {
            return Step::Model.fails("the radius of a loop of several rates has no certificate");
        }
        Ok(TuneJudge { statement, of })
    }

    pub(super) fn statement(&self) -> &Statement {
        &self.statement
    }

    /// Who decides the loops.
    pub fn loops(&self) -> &ForAllJudge {
        &self.of
    }

    /// So many loops, from the first one on, may refute gains.
    pub fn refutable(&self) -> usize {
        self.statement.refutable()
    }

    /// The loops that are to be stable for the gains that are found.
    pub fn of_found(&self) -> Vec<usize> {
        self.statement.loops_of_found()
    }

    /// The cell with which the tree begins.
    pub fn whole(&self, number: usize) -> JudgedBox {
        self.of.over_axes(&self.statement.cells(), number)
    }

    /// The boxes of the proof that a loop is stable for the gains that are found; none where none are.
    pub fn proofs_of_found(&self, number: usize) -> Vec<JudgedBox> {
        let point = |point: &Vec<Q>| point.iter().map(|x| [x.clone(), x.clone()]).collect::<Vec<_>>();
        self.statement.found.as_ref().map(|found| self.of.proofs_over(&point(&found.point), number)).unwrap_or_default()
    }

    /// Whether what is to be best is shown to be worse, at all gains of a cell, than the value of which there is none.
    pub fn is_worse(&self, cell: &JudgedBox) -> bool {
        matches!(self.statement.objective, Objective::Formula { .. })
            && self.statement.objective.is_worse(&cell.sides()[..self.asked().axes], self.of.clock()).unwrap_or(false)
    }

    /// Whether a loop is shown to have a root beyond the boundary, moved outwards by a power of two.
    pub fn has_root_beyond(&self, number: usize, of: &mut JudgedBox, exponent: i64) -> bool {
        self.of.of_number(number).has_root_beyond(of, exponent, self.of.clock()).unwrap_or(false)
    }

    /// The coefficients of a loop in the middle of a box, in the half plane, times a positive number, for a choice and no proof; none with dead time.
    pub fn coefficients_approximate(&self, number: usize, of: &mut JudgedBox) -> Option<Vec<f64>> {
        self.of.of_number(number).coefficients_approximate(of, self.of.clock())
    }

    /// The gain along which a cell is to be halved, the widest in shares of the bounds; `None` where it is a point.
    pub fn widest(&self, cell: &JudgedBox) -> Option<usize> {
        self.of.widest(&cell.sides()[..self.asked().axes])
    }

    fn asked(&self) -> &Loops {
        self.of.asked()
    }
}
