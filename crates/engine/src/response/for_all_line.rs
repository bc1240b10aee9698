//! One parameter for all values of other names in given ranges.

use super::for_all::{MapForAll, OpenPart};
use super::for_all_open::why_open;
use super::required_set::{RequiredEnd, RequiredInterval, RequiredSet};
use super::requirement_boxes::RequirementBoxes;
use super::spoiled::{Spoiled, parted};
use crate::answer::Answer;
use crate::coverage::refusals::COMPLEX_FOR_ALL;
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Free, Problem, Question};
use crate::stability::{Cause, End, StableSet, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;

/// A piece of the parameter is halved until it is so many times shorter than it is far from zero, or than the window, as powers of two.
const BITS: u64 = 30;
const BITS_OF_WINDOW: u64 = 34;

/// The window reaches so many times as far as the farthest end of stability at the middle of the ranges, or the nominal value.
const BEYOND: i64 = 2;

/// Why nothing is said of a short piece.
const AT_AN_END: &str = "where it begins or ceases to hold for all values";

/// Why nothing is said of many pieces.
const TOO_MANY: &str = "too many pieces are open: a shorter range of the other names, or of this one, may be decided";

/// Why nothing is said of a piece that the budget did not reach.
const UNFINISHED: &str = "not looked at to the end: the budget ran out";

/// So many open pieces of one length are more than the ends of a set make: one value of a range may leave all of them open.
const MANY_OPEN: usize = 1 << 6;

/// With more open pieces of one length the halving ends.
const MOST_OPEN: usize = 1 << 9;

/// The part of the budget that may be spent on the window.
const WINDOW: (u32, u32) = (1, 4);

/// The share of a window, as a power of two, by which it goes on into what is spoiled.
const LITTLE: u64 = 10;

/// Why nothing is said beyond the window.
const OUTSIDE: &str = "not looked at: the domain has no end there, and '--domain' gives one";

/// Beside what is spoiled a piece is cut so near to its end, as a power of two: coefficients are nearly straight, so one look proves most of it.
const NEAR: u32 = 4;

/// A piece of the parameter's range.
pub(super) struct Piece {
    pub(super) between: [Rational; 2],
    halvings: u32,
    /// Whether what lies beside its ends is known to be spoiled.
    beside_spoiled: [bool; 2],
    /// Stability is decided, and requirements are looked at.
    is_stable: bool,
    pub(super) open: Vec<OpenPart>,
}

impl Piece {
    /// Two parts: halves, or beside what is spoiled a short part and the rest.
    fn halves(self) -> [Piece; 2] {
        let [low, high] = self.between;
        let [at_low, at_high] = self.beside_spoiled;
        let short = &(&high - &low) * &Rational::dyadic(&1.into(), NEAR.into());
        let (at, halvings) = match (at_low, at_high) {
            (false, true) => (&high - &short, [1, NEAR]),
            (true, false) => (&low + &short, [NEAR, 1]),
            _ => (low.midpoint(&high), [1, 1]),
        };
        let part = |between, more: u32, beside_spoiled| Piece {
            between,
            halvings: self.halvings + more,
            beside_spoiled,
            is_stable: self.is_stable,
            open: self.open.clone(),
        };
        [part([low, at.clone()], halvings[0], [at_low, false]), part([at, high], halvings[1], [false, at_high])]
    }
}

/// What is known of a piece: that all is met for all values, what is not for some, or why nothing is.
#[derive(Clone, PartialEq)]
enum Known {
    Good,
    Spoiled(&'static str),
    Undecided(String),
}

/// The pieces of a window, ascending, and what ended their halving.
type Pieces = (Vec<([Rational; 2], Known)>, Option<Exhausted>);

impl MapForAll {
    /// The values of the one free name of a question for which the loop is stable, and meets what is required, for all values of the ranges.
    ///
    /// The ends are not numbers in a closed form: each is enclosed by a short bracket, in which nothing is said.
    ///
    /// Cost: that of a look at some dozen pieces beside each end, times the parts of the ranges that are not decided with longer pieces.
    ///
    /// # Errors
    /// As [`MapForAll::boxes`], but for the window.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::response::{AllOf, MapForAll};
    /// // s + K - 1 + 4 (c - 1/2)^2: the worst c is 1/2.
    /// let text = "time = 'continuous'\nparameters = { K = 2, c = 0 }\nloop.characteristic = 's + K - 1 + 4*(c - 1/2)^2'\n";
    /// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
    /// let for_all = MapForAll::new(vec![AllOf::new("c", 0.into(), 1.into()).unwrap()]);
    /// let set = for_all.intervals(model.ask().free("K"), &Budget::unlimited())?;
    /// let end = set.value().intervals[0].lower.as_ref().unwrap().value().exact().unwrap();
    /// assert!(end >= 1.into() && end < "1.00001".parse()?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn intervals(&self, question: Question, budget: &Budget) -> Result<Answer<RequiredSet>, Error> {
        let middle = |all: &super::AllOf| (all.name.clone(), all.range[0].midpoint(&all.range[1]));
        let line = question.clone().set_all(self.all.iter().map(middle)).problem()?;
        match line.refuse_complex(budget) {
            Err(Error::Refused(_)) => return Err(COMPLEX_FOR_ALL.diagnostic(&[]).into()),
            known => known?,
        }
        if line.region().is_free() {
            let message = "the bound of a region is not asked about for all values of other names";
            return Err(Diagnostic::error(Code::Usage, message).into());
        }
        let together = self.together(question.clone())?;
        let at_middle = line.stable_set(&budget.share(WINDOW.0, WINDOW.1));
        let at_middle = match at_middle {
            Ok(set) => Some(set),
            Err(failure) => failure.stopped().map(|_| None)?,
        };
        let window = window(line.parameter(), at_middle.as_ref().map(Answer::value));
        let middle = vec![window[0].midpoint(&window[1])];
        let tests = self.tests(&together, middle, budget).and_then(|tests| {
            let spoiled = self.spoiled_at_corners(&question, budget)?;
            Ok((tests, spoiled))
        });
        let (pieces, stopped, spoiled) = match tests {
            Ok(((stability, requirements), spoiled)) => {
                let window = up_to_spoiled(window, line.parameter(), &spoiled);
                let looked = (&window, spoiled.as_slice());
                let (pieces, stopped) = self.halved(looked, &line, (&stability, &requirements), budget)?;
                (pieces, stopped, spoiled)
            }
            Err(failure) => {
                let stopped = failure.stopped()?;
                (vec![(window, Known::Undecided(UNFINISHED.to_owned()))], Some(stopped), Vec::new())
            }
        };
        let found = RequiredSet { stopped, ..self.set(pieces, line.parameter(), &spoiled) };
        Ok(Answer::new(line.without_values_of(|name| self.all.iter().any(|all| all.name == name)), found))
    }

    /// Decides the values of a window that no corner spoils: open pieces are halved, the longest first, until they are short or the budget ends.
    fn halved(
        &self,
        (window, spoiled): (&[Rational; 2], &[Spoiled]),
        line: &Problem,
        (stability, requirements): (&[RequirementBoxes], &[RequirementBoxes]),
        budget: &Budget,
    ) -> Result<Pieces, Error> {
        budget.step("halving the range of the parameter");
        let (left, bad) = parted(window, spoiled);
        let whole = |between: [Rational; 2]| Piece {
            beside_spoiled: [0, 1].map(|side| bad.iter().any(|(piece, _)| piece[1 - side] == between[side])),
            between,
            halvings: 0,
            is_stable: false,
            open: self.parts(stability),
        };
        let mut level: Vec<Piece> = left.into_iter().map(whole).collect();
        let mut pieces: Vec<_> = bad.into_iter().map(|(piece, by)| (piece, Known::Spoiled(by))).collect();
        let mut stopped = None;
        while !level.is_empty() && stopped.is_none() {
            let (mut open, mut rest) = (Vec::new(), level.into_iter());
            for mut piece in rest.by_ref() {
                match self.known(&mut piece, (stability, requirements), budget) {
                    Ok(None) => open.push(piece),
                    Ok(Some(known)) => pieces.push((piece.between, known)),
                    Err(out) => {
                        let unseen = Known::Undecided(UNFINISHED.to_owned());
                        pieces.extend(
                            [piece].into_iter().chain(rest).chain(open.drain(..)).map(|p| (p.between, unseen.clone())),
                        );
                        stopped = Some(out);
                        break;
                    }
                }
            }
            level = Vec::new();
            let why = match open.len() {
                0..=MANY_OPEN => None,
                count => why_open(&self.all, &open, line, budget).or((count > MOST_OPEN).then(|| TOO_MANY.to_owned())),
            };
            for piece in open {
                match &why {
                    Some(why) => pieces.push((piece.between, Known::Undecided(why.clone()))),
                    None if is_short(&piece.between, window) => {
                        pieces.push((piece.between, Known::Undecided(AT_AN_END.to_owned())))
                    }
                    None => level.extend(piece.halves()),
                }
            }
        }
        pieces.sort_by(|a, b| a.0[0].cmp(&b.0[0]));
        Ok((pieces, stopped))
    }

    fn known(
        &self,
        piece: &mut Piece,
        (stability, requirements): (&[RequirementBoxes], &[RequirementBoxes]),
        budget: &Budget,
    ) -> Result<Option<Known>, Exhausted> {
        let place = (vec![piece.between.clone()], piece.halvings);
        if !piece.is_stable {
            match self.look(stability, &place, &mut piece.open, budget)? {
                Some(None) if requirements.is_empty() => return Ok(Some(Known::Good)),
                Some(None) => (piece.is_stable, piece.open) = (true, self.parts(requirements)),
                Some(Some(_)) => return Ok(Some(Known::Spoiled("stability"))),
                None => return Ok(None),
            }
        }
        let found = self.look(requirements, &place, &mut piece.open, budget)?;
        Ok(found.map(|test| test.map_or(Known::Good, |test| Known::Spoiled(self.requirements[test].name()))))
    }

    /// Pieces in ascending order as a set.
    fn set(&self, pieces: Vec<([Rational; 2], Known)>, parameter: &Free, spoiled: &[Spoiled]) -> RequiredSet {
        let mut runs: Vec<([Rational; 2], Known)> = Vec::new();
        for (between, known) in pieces {
            match runs.last_mut() {
                // What spoils a piece may be one thing or another.
                Some((last, own)) if *own == known => last[1] = between[1].clone(),
                _ => runs.push((between, known)),
            }
        }
        let mut set = RequiredSet { for_all: self.all.clone(), ..RequiredSet::default() };
        let ends = [&parameter.domain.lower, &parameter.domain.upper];
        let end = |x: &Rational, beside: Option<&Known>, side: usize| {
            let cause = match beside {
                Some(Known::Spoiled(name)) => {
                    let (value, names) = (Real::from(x.clone()), vec![*name]);
                    return Some(RequiredEnd::Requirement { value, names, closed: true });
                }
                None if ends[side].as_ref() == Some(x) => Cause::Domain,
                // The search ends here.
                Some(Known::Good | Known::Undecided(_)) | None => Cause::Undecided,
            };
            let closed = cause != Cause::Domain || parameter.closed[side];
            Some(RequiredEnd::Stability(End::new(x.clone(), cause.into(), None).closed_if(closed)))
        };
        for (i, ([low, high], known)) in runs.iter().enumerate() {
            // Behind a short undecided piece stands what spoils the others.
            let beyond = |mut at: isize, step: isize| loop {
                at += step;
                match usize::try_from(at).ok().and_then(|at| runs.get(at)) {
                    Some((_, Known::Undecided(why))) if why == AT_AN_END => {}
                    other => break other.map(|(_, known)| known),
                }
            };
            match known {
                Known::Good => set.intervals.push(RequiredInterval {
                    lower: end(low, beyond(i as isize, -1), 0),
                    upper: end(high, beyond(i as isize, 1), 1),
                }),
                Known::Undecided(why) => {
                    set.undecided.push(UndecidedBracket::new(Some(low.clone()), Some(high.clone()), why.as_str()))
                }
                Known::Spoiled(_) => {}
            }
        }
        let outside = |lower, upper| UndecidedBracket::new(lower, upper, OUTSIDE);
        let is_open = |end: &Rational, is_above: bool| !spoiled.iter().any(|one| one.is_all_beyond(end, is_above));
        if let (None, Some(([low, _], _))) = (&parameter.domain.lower, runs.first())
            && is_open(low, false)
        {
            set.undecided.insert(0, outside(None, Some(low.clone())));
        }
        if let (None, Some(([_, high], _))) = (&parameter.domain.upper, runs.last())
            && is_open(high, true)
        {
            set.undecided.push(outside(Some(high.clone()), None));
        }
        set
    }
}

/// A window that goes on a little beyond where all values are spoiled, unless that is farther away than the window is long.
fn up_to_spoiled([low, high]: [Rational; 2], parameter: &Free, spoiled: &[Spoiled]) -> [Rational; 2] {
    let length = &high - &low;
    let [lowest, highest] = [&low - &length, &high + &length];
    let below = spoiled.iter().filter(|one| one.lower.is_none()).filter_map(|one| one.upper.clone()).max();
    let above = spoiled.iter().filter(|one| one.upper.is_none()).filter_map(|one| one.lower.clone()).min();
    let below = below.filter(|end| parameter.domain.lower.is_none() && *end <= low && *end >= lowest);
    let above = above.filter(|end| parameter.domain.upper.is_none() && *end >= high && *end <= highest);
    let little = length * Rational::dyadic(&1.into(), LITTLE);
    [below.map_or(low, |end| end - &little), above.map_or(high, |end| end + &little)]
}

fn is_short([low, high]: &[Rational; 2], window: &[Rational; 2]) -> bool {
    let length = high - low;
    let far = low.abs().max(high.abs());
    length <= &far * &Rational::dyadic(&1.into(), BITS)
        || length <= &(&window[1] - &window[0]) * &Rational::dyadic(&1.into(), BITS_OF_WINDOW)
}

/// What is looked at: the domain, or as far as the loop at the middle of the ranges says anything.
fn window(parameter: &Free, at_middle: Option<&StableSet>) -> [Rational; 2] {
    let ends = at_middle.into_iter().flat_map(StableSet::intervals).flat_map(|i| [&i.lower, &i.upper]).flatten();
    let ends = ends.map(|end| end.value.refined_to_digits(4).enclosure().1.abs());
    let far = ends.chain(parameter.nominal.iter().map(Rational::abs)).max().filter(|far| !far.is_zero());
    let far = Rational::from((&far.unwrap_or(Rational::ONE) * &Rational::from(BEYOND)).ceil());
    let low = parameter.domain.lower.clone().unwrap_or_else(|| -&far);
    let high = parameter.domain.upper.clone().unwrap_or_else(|| far.clone().max(&low + &far));
    let low = if low < high { low } else { &high - &far };
    [low, high]
}
