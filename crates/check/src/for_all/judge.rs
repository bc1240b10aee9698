//! Who decides the boxes of a certificate for all values.

use super::{Beyond, Loops, Requirement, SHARE, read};
use crate::clock::Clock;
use crate::format::Json;
use crate::map_boxes::{JudgedBox, OneLoop, Parts, on_a_large_stack};
use crate::number::{Q, Z, rational};
use crate::{Limits, Rejection, Step};

/// Decides boxes as the check of a certificate for all values does. Who writes a certificate asks it what a checker can see.
///
/// There is one loop for each requirement, with the factor of it at its cut, or one without requirements. A box of a loop has a side for each of the names: the
/// axes, those for all, and the own ones of the requirement.
///
/// What is shown of a box depends on the way to it: for a leaf `+` of the tree the checker takes the boxes that [`proofs`](ForAllJudge::proofs) makes of its
/// axes, and halves each along its proof by [`halves`](ForAllJudge::halves); for a leaf `-` it takes parts by [`part`](ForAllJudge::part) of the one that
/// [`over`](ForAllJudge::over) makes. In between a box may be asked about.
///
/// ```
/// use jurist_check::{ForAllJudge, Limits, Part};
/// let model = "time = 'continuous'\nparameters = { a = {}, b = {} }\nloop.characteristic = 's^2 + a*s + b'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/10",
///     "statement": {"kind": "for_all", "time": "continuous", "axes": [{"name": "a", "between": ["-1", "3"]}],
///         "for_all": [{"name": "b", "between": ["1", "2"]}], "set": {}, "region": {"decay": "0"}, "require": [], "tree": "?", "beyond": null},
///     "order": 2, "bits": 64
/// }"#;
/// let judge = ForAllJudge::new(model, certificate, &Limits::default()).unwrap();
/// let whole = judge.whole(0);
/// let [lower, upper] = [Part::Lower, Part::Upper].map(|half| judge.part(&whole, half, 0));
/// assert_eq!(judge.sides(&upper)[0], ["1", "3"]);
/// assert!(judge.proofs(&upper, 0).iter_mut().all(|part| judge.shows(0, part, true)));
/// let lower = judge.part(&judge.part(&lower, Part::Lower, 0), Part::Low, 0);
/// assert!(judge.shows(0, &mut judge.part(&judge.over(&lower, 0), Part::Middle, 1), false), "a = -1, b = 3/2");
/// ```
pub struct ForAllJudge {
    asked: Loops,
    clock: Clock,
    loops: Vec<OneLoop>,
}

/// A part of a side of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The lower half.
    Lower,
    /// The upper half.
    Upper,
    /// The point in the middle.
    Middle,
    /// The lower end.
    Low,
    /// The upper end.
    High,
}

impl Part {
    /// All of them.
    pub const ALL: [Part; 5] = [Part::Lower, Part::Upper, Part::Middle, Part::Low, Part::High];

    /// Its letter in a certificate.
    pub fn letter(self) -> char {
        match self {
            Part::Lower => 'l',
            Part::Upper => 'u',
            Part::Middle => 'm',
            Part::Low => '<',
            Part::High => '>',
        }
    }

    pub(super) fn named(letter: char) -> Option<Part> {
        Part::ALL.into_iter().find(|part| part.letter() == letter)
    }

    fn of([low, high]: &[Q; 2]) -> impl Fn(Part) -> [Q; 2] {
        let middle = (low + high) / Q::from(Z::from(2));
        let (low, high) = (low.clone(), high.clone());
        move |part| {
            let [a, b] = match part {
                Part::Lower => [&low, &middle],
                Part::Upper => [&middle, &high],
                Part::Middle => [&middle, &middle],
                Part::Low => [&low, &low],
                Part::High => [&high, &high],
            };
            [a.clone(), b.clone()]
        }
    }
}

impl ForAllJudge {
    /// Of a certificate, whose tree is not looked at.
    ///
    /// Cost: for each requirement the characteristic polynomial in all names and functions of them, expanded.
    ///
    /// # Errors
    /// [`Rejection`] where the certificate has not the form of one for all values, or the model cannot be read.
    pub fn new(model: &str, certificate: &str, limits: &Limits) -> Result<Self, Rejection> {
        on_a_large_stack(|| {
            let ((asked, _), parts) = read(&Step::Format.of(Json::parse(certificate))?)?;
            ForAllJudge::of(model, asked, &parts, Clock::new(limits.timeout))
        })
    }

    pub(crate) fn of(model: &str, asked: Loops, parts: &Parts, clock: Clock) -> Result<Self, Rejection> {
        debug_assert_eq!(parts.share, SHARE);
        let one = |number| OneLoop::new(model, &asked.question(number, asked.window.clone()), parts, &clock);
        let loops = (0..asked.each.len()).map(one).collect::<Result<Vec<_>, _>>()?;
        Ok(ForAllJudge { asked, clock, loops })
    }

    /// A loop that is known at the point beyond.
    pub(super) fn beyond(
        &self,
        number: usize,
        beyond: &Beyond,
        model: &str,
        parts: &Parts,
    ) -> Result<Option<OneLoop>, Rejection> {
        if !self.loops[number].is_enclosed {
            return Ok(None);
        }
        let point = beyond.point.iter().map(|x| [x.clone(), x.clone()]).collect();
        OneLoop::new(model, &self.asked.question(number, point), parts, &self.clock).map(Some)
    }

    pub(crate) fn asked(&self) -> &Loops {
        &self.asked
    }

    fn requirement(&self, number: usize) -> Option<&Requirement> {
        self.asked.requirement(number)
    }

    pub(crate) fn clock(&self) -> &Clock {
        &self.clock
    }

    pub(crate) fn of_number(&self, number: usize) -> &OneLoop {
        &self.loops[number]
    }

    /// The number of loops: that of requirements, or 1 where there are none.
    pub fn loops(&self) -> usize {
        self.loops.len()
    }

    /// How many names the boxes of a loop have.
    pub fn names(&self, number: usize) -> usize {
        self.asked.names.len() + self.requirement(number).map_or(0, Requirement::names)
    }

    /// Everything that is asked of the loop with this number, as far as a leaf `-` may go, which is less of the angles of a phase margin.
    pub fn whole(&self, number: usize) -> JudgedBox {
        self.over_axes(&self.asked.window[..self.asked.axes], number)
    }

    /// The same where the axes have the sides that they have in another box, of any of the loops.
    pub fn over(&self, axes: &JudgedBox, number: usize) -> JudgedBox {
        self.over_axes(&axes.sides()[..self.asked.axes], number)
    }

    /// The boxes of a leaf `+` over these axes, in their order: the leaf says that the loop is stable in each of them. The factors of a disc have three, where there
    /// are axes or names for all: two for its edge, and one for its inside at a point of the axes. A sector has two where the loop is complex.
    ///
    /// Cost: that of copying the sides.
    pub fn proofs(&self, axes: &JudgedBox, number: usize) -> Vec<JudgedBox> {
        self.proofs_over(&axes.sides()[..self.asked.axes], number)
    }

    pub(crate) fn proofs_over(&self, axes: &[[Q; 2]], number: usize) -> Vec<JudgedBox> {
        let of = &self.loops[number];
        let sides: Vec<[Q; 2]> = axes.iter().chain(&self.asked.window[self.asked.axes..]).cloned().collect();
        let with = |sides: &[[Q; 2]], own: Vec<[Q; 2]>| of.over(sides.iter().cloned().chain(own).collect());
        let Some(requirement) = self.requirement(number) else { return vec![with(&sides, Vec::new())] };
        match requirement.parts_of_disc(of.is_complex) {
            Some([plus, minus, across]) if !sides.is_empty() && !of.divides_by_factor() => {
                let middle: Vec<_> = sides.iter().map(|side| Part::of(side)(Part::Middle)).collect();
                vec![with(&sides, plus), with(&sides, minus), with(&middle, across)]
            }
            _ => requirement.proofs(of.is_complex).into_iter().map(|own| with(&sides, own)).collect(),
        }
    }

    /// A point of the names for all, where there are no axes, in their ranges or not: with `refute`, as a point beyond. With several rates its own
    /// judge has to be asked, of a certificate with these values for ranges.
    ///
    /// # Errors
    /// Where there is not one number, a quotient of two integers, for each of these names.
    pub fn at(&self, point: &[&str], number: usize) -> Result<JudgedBox, String> {
        if self.asked.axes > 0 || point.len() != self.asked.names.len() {
            return Err("there is not one number for each name".into());
        }
        let point = point.iter().map(|x| rational(x)).collect::<Result<Vec<_>, _>>()?;
        Ok(self.at_point(&point, number))
    }

    pub(super) fn at_point(&self, point: &[Q], number: usize) -> JudgedBox {
        let whole = self.over_axes(&[], number);
        point.iter().enumerate().fold(whole, |part, (axis, x)| part.with_side(axis, [x.clone(), x.clone()]))
    }

    /// Of a leaf `-`.
    pub(crate) fn over_axes(&self, axes: &[[Q; 2]], number: usize) -> JudgedBox {
        let of = &self.loops[number];
        let own = self.requirement(number).map(|own| own.ranges(of.is_complex, true));
        let for_all = &self.asked.window[self.asked.axes..];
        of.over(axes.iter().chain(for_all).cloned().chain(own.into_iter().flatten()).collect())
    }

    /// The lower and the upper half of a box of a loop along an axis, any of its names.
    ///
    /// Cost: that of computing the functions over the box, unless those of a larger one are precise enough for it; with dead time that of
    /// [`shows`](ForAllJudge::shows).
    pub fn halves(&self, number: usize, of: &mut JudgedBox, axis: usize) -> [JudgedBox; 2] {
        // Where time is over, all that follows is not shown.
        self.halved(number, of, axis).unwrap_or_else(|_| self.loops[number].cut(of, axis))
    }

    pub(super) fn halved(&self, number: usize, of: &mut JudgedBox, axis: usize) -> Result<[JudgedBox; 2], String> {
        self.loops[number].halved(of, axis, &self.clock)
    }

    /// A part of a box along an axis. Nothing is known of it yet.
    pub fn part(&self, of: &JudgedBox, part: Part, axis: usize) -> JudgedBox {
        of.with_side(axis, Part::of(&of.sides()[axis])(part))
    }

    /// Whether a loop is shown to be stable at every point of the closed box, or, with `stable` false, at none.
    ///
    /// Cost: that of [`BoxJudge::shows`](crate::BoxJudge::shows), where the loop has twice the order if a factor is complex.
    pub fn shows(&self, number: usize, of: &mut JudgedBox, stable: bool) -> bool {
        self.shown(number, of, stable).unwrap_or(false)
    }

    pub(super) fn shown(&self, number: usize, of: &mut JudgedBox, stable: bool) -> Result<bool, String> {
        self.loops[number].shown(of, stable, &self.clock)
    }

    /// The axis along which the functions of a loop change most in a box; of one that is not known, the widest in shares of everything that is asked.
    pub fn axis(&self, number: usize, of: &JudgedBox) -> usize {
        self.loops[number].axis(of)
    }

    /// The ends of the sides, as they are written in a certificate.
    pub fn sides(&self, of: &JudgedBox) -> Vec<[String; 2]> {
        of.sides().iter().map(|side| side.each_ref().map(ToString::to_string)).collect()
    }

    /// How much has been done, see [`BoxJudge::work`](crate::BoxJudge::work).
    pub fn work(&self) -> u64 {
        self.clock.work()
    }

    /// The work that a check may be, see [`BoxJudge::allowed`](crate::BoxJudge::allowed).
    pub fn allowed(bytes: usize) -> u64 {
        Clock::allowed(bytes)
    }
}
