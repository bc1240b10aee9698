//! Certificates of what holds for all values of some names, and of requirements.

use super::search::{Judge, Search};
use crate::Certificate;
use crate::ForAllClaim;
use crate::for_all_certificate;
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::Rational;
use jurist_check::{ForAllJudge, JudgedBox, Limits, Part};
use jurist_engine::answer::{Answer, PointVerdict, Verdict};
use jurist_engine::problem::Problem;
use jurist_engine::response::Requirement;
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_stability::plane::boxes::{PlaneBox, Window};
use std::cell::RefCell;
use std::time::Duration;

/// Bits of the coefficients of Taylor models, and their degree by the number of names: there are about as many coefficients.
const BITS: usize = 256;
const ORDERS: [usize; 5] = [6, 6, 5, 4, 3];

/// The same of loops with dead time.
const BITS_WITH_DEAD_TIME: usize = 128;
const ORDER_WITH_DEAD_TIME: usize = 1;

/// So many parts of the ranges are looked at for one box of the axes, and for a statement without axes.
const MOST_PARTS: usize = 96;
const MOST_PARTS_OF_ONE: usize = 100_000;

/// The same at a point of the axes.
const MOST_PARTS_AT_POINT: usize = 1000;

/// No part is halved more often.
const MOST_HALVINGS: usize = 80;

/// So many points of the ranges are tried for one box that is to be refuted, the more the smaller it is, and for a statement without axes.
const MOST_POINTS: usize = 12;
const MOST_POINTS_OF_ONE: usize = 300;

/// Points that refuted other boxes and are tried first.
const MOST_RECENT: usize = 6;

/// So many of the judge's units are a unit of a budget.
pub(super) const UNITS_OF_JUDGE: u64 = 32;

/// What a check sees of a box of the axes, for all values of the other names.
pub(super) struct ForAll {
    judge: ForAllJudge,
    axes: usize,
    /// The number of axes and names for all; own ones of requirements follow.
    names: usize,
    /// How boxes were refuted, latest first.
    recent: RefCell<Vec<Refutation>>,
    counted: RefCell<u64>,
}

/// The number of a loop, and what of the ranges is taken.
type Refutation = (usize, Vec<(Part, usize)>);

/// A box of the axes, together with all values of the other names: for each loop the boxes that are to be proved, and that one of which a part is refuted.
pub(super) struct Cell {
    proofs: Vec<Vec<JudgedBox>>,
    refuted: Vec<JudgedBox>,
    halvings: [usize; 2],
}

/// Degree and bits of the Taylor models.
pub(super) fn precision(
    problem: &Problem,
    requirements: &[Requirement],
    names: usize,
    budget: &Budget,
) -> Result<(usize, usize), Error> {
    let has_dead_time = requirements.iter().any(Requirement::is_delay_margin)
        || problem.model().hyperperiod() == 1 && !problem.algebra_over_symbols(budget)?.symbols().delays().is_empty();
    Ok(match has_dead_time {
        true => (ORDER_WITH_DEAD_TIME, BITS_WITH_DEAD_TIME),
        false => (ORDERS[names.min(ORDERS.len()) - 1], BITS),
    })
}

impl ForAll {
    /// # Errors
    /// [`Error::Refused`] (`E-no-certificate`) where the checkers do not read the model or the claim.
    pub fn new(problem: &Problem, claim: &ForAllClaim, budget: &Budget) -> Result<(ForAll, (usize, usize)), Error> {
        let own = if claim.requirements.is_empty() { 0 } else { 2 };
        let precision =
            precision(problem, &claim.requirements, (claim.axes.len() + claim.all.len() + own).max(1), budget)?;
        let draft = for_all_certificate(problem, claim, "?", precision, budget)?;
        let judge = ForAllJudge::new(&problem.model().source().text, &draft, &Limits::within(Duration::MAX));
        let judge = judge.map_err(|rejection| {
            Diagnostic::error(Code::NoCertificate, format!("no certificate: {}", rejection.reason))
                .help("the checkers read the model themselves; the answer is printed without '--certificate'")
        })?;
        let (axes, names, recent) = (claim.axes.len(), claim.axes.len() + claim.all.len(), RefCell::default());
        let counted = RefCell::new(judge.work());
        Ok((ForAll { judge, axes, names, recent, counted }, precision))
    }

    /// Over axes that have the sides that they have in a box.
    fn cell(&self, axes: &JudgedBox, halvings: [usize; 2]) -> Cell {
        let loops = 0..self.judge.loops();
        let proofs = loops.clone().map(|k| self.judge.proofs(axes, k)).collect();
        Cell { proofs, refuted: loops.map(|k| self.judge.over(axes, k)).collect(), halvings }
    }

    /// Asks the budget for what was done since.
    fn may_go_on(&self, budget: &Budget) -> bool {
        let done = self.judge.work() - self.counted.replace(self.judge.work());
        budget.enter(|| checkpoint(1 + done / UNITS_OF_JUDGE)).is_ok()
    }

    /// How it is written that all loops are stable in all parts of a cell.
    fn proved(&self, of: &Cell, budget: &Budget) -> Option<String> {
        let mut out = String::new();
        let mut left = if self.axes == 0 { MOST_PARTS_OF_ONE } else { MOST_PARTS };
        for (k, boxes) in of.proofs.iter().enumerate() {
            // The last of several is a point of the axes, and costs little.
            let (over_axes, at_point) = boxes.split_at(boxes.len().min(2));
            for whole in over_axes {
                out += &self.proof(k, whole, &mut left, budget)?;
            }
            for whole in at_point {
                out += &self.proof(k, whole, &mut { MOST_PARTS_AT_POINT }, budget)?;
            }
        }
        Some(out)
    }

    /// How it is written that a loop is stable in all parts of a box.
    fn proof(&self, k: usize, whole: &JudgedBox, left: &mut usize, budget: &Budget) -> Option<String> {
        let mut may_go_on = || {
            let is_left = *left > 0 && self.may_go_on(budget);
            *left = left.saturating_sub(1);
            is_left
        };
        proof((&self.judge, k), whole, &mut may_go_on, &|part, halvings| self.axis_of_part(k, part, halvings))
    }

    /// The name whose side of a part is halved; `None` where the box of the axes is to be halved instead: there the middle of the ranges shows no more.
    fn axis_of_part(&self, k: usize, part: &JudgedBox, halvings: usize) -> Option<usize> {
        let axis = self.judge.axis(k, part);
        if axis >= self.axes && (halvings > 0 || self.axes == 0) {
            return Some(axis);
        }
        let names = self.axes..self.judge.names(k);
        let pinned = names.clone().fold(part.clone(), |part, name| self.judge.part(&part, Part::Middle, name));
        let sides = self.judge.sides(part);
        let wide: Vec<usize> = names.filter(|name| sides[*name][0] != sides[*name][1]).collect();
        if wide.is_empty() || !self.judge.shows(k, &mut { pinned }, true) {
            return None;
        }
        // What is even about the middle of a side has no slope there.
        Some(if wide.contains(&axis) { axis } else { wide[halvings % wide.len()] })
    }

    /// How it is written that a loop is not stable, for some values of the other names, at any point of a cell.
    fn refuted(&self, of: &Cell, budget: &Budget) -> Option<String> {
        let of_size = MOST_POINTS * (1 + (of.halvings[0] + of.halvings[1]) / 4);
        let most = if self.axes == 0 { MOST_POINTS_OF_ONE } else { of_size };
        let recent = self.recent.borrow().clone();
        let points = (0..=self.levels()).flat_map(|level| self.points(level));
        let found = recent.into_iter().chain(points).take(most).find(|(k, steps)| {
            self.may_go_on(budget) && {
                let part = steps
                    .iter()
                    .fold(of.refuted[*k].clone(), |part, (step, name)| self.judge.part(&part, *step, *name));
                self.judge.shows(*k, &mut { part }, false)
            }
        })?;
        let mut recent = self.recent.borrow_mut();
        recent.retain(|known| *known != found);
        recent.insert(0, found.clone());
        recent.truncate(MOST_RECENT);
        let steps: String = found.1.iter().flat_map(|(step, name)| [step.letter(), letter(*name)]).collect();
        Some(format!("{}{steps}.", found.0))
    }
}

impl ForAll {
    /// Sides are halved so often for the points that are tried: ends and middles of all sides come first, then points between them.
    fn levels(&self) -> usize {
        let sides = |k: usize| self.judge.names(k) - self.axes - usize::from(self.is_disc(k));
        let sides = (0..self.judge.loops()).map(sides).max().unwrap_or(0);
        match sides {
            0 => 0,
            1 => 8,
            2 => 4,
            3 => 2,
            _ => 1,
        }
    }

    /// Whether the factors of a loop are those of a disc.
    fn is_disc(&self, k: usize) -> bool {
        self.judge.names(k) == self.names + 2
    }

    /// Points of the ranges of all loops that come up at one level: each side is taken at an end, at its middle, or in the middle of a part that was halved
    /// up to so many times.
    fn points(&self, level: usize) -> Vec<Refutation> {
        let of_loop = |k: usize| {
            let sides = self.axes..self.judge.names(k);
            let places: Vec<Vec<(Vec<Part>, usize)>> = sides.clone().map(|_| places(level)).collect();
            let all = places.iter().fold(vec![(Vec::new(), 0)], |all, own| {
                let with = |(known, highest): &(Vec<Vec<Part>>, usize)| {
                    let with = |(place, level): &(Vec<Part>, usize)| {
                        ([known.clone(), vec![place.clone()]].concat(), (*highest).max(*level))
                    };
                    own.iter().map(with).collect::<Vec<_>>()
                };
                all.iter().flat_map(with).collect::<Vec<_>>()
            });
            let steps = move |places: Vec<Vec<Part>>| {
                let named =
                    sides.clone().zip(places).flat_map(|(name, parts)| parts.into_iter().map(move |part| (part, name)));
                (k, named.collect())
            };
            // What some number inside of a disc shows one on its edge shows as well, or a real one.
            let is_disc = self.is_disc(k);
            let is_tried = move |places: &[Vec<Part>]| match places {
                [.., radius, turn] if is_disc => radius.len() == 1 || *turn == [Part::Low],
                _ => true,
            };
            all.into_iter()
                .filter(move |(places, highest)| *highest == level && is_tried(places))
                .map(move |(places, _)| steps(places))
                .collect::<Vec<_>>()
        };
        (0..self.judge.loops()).flat_map(of_loop).collect()
    }
}

/// The places of one side up to a level, each with its level: the ends, the middle, and the middles of parts.
fn places(level: usize) -> Vec<(Vec<Part>, usize)> {
    let mut out = vec![(vec![Part::High], 0), (vec![Part::Low], 0), (vec![Part::Middle], 0)];
    let mut parts = vec![Vec::new()];
    for level in 1..=level {
        parts = parts
            .iter()
            .flat_map(|part: &Vec<Part>| [Part::Lower, Part::Upper].map(|half| [part.clone(), vec![half]].concat()))
            .collect();
        out.extend(parts.iter().map(|part| ([part.clone(), vec![Part::Middle]].concat(), level)));
    }
    out
}

/// How it is written that a loop is stable in all parts of a box; `axis` says along which name a part is halved.
pub(super) fn proof(
    (judge, k): (&ForAllJudge, usize),
    whole: &JudgedBox,
    may_go_on: &mut dyn FnMut() -> bool,
    axis: &dyn Fn(&JudgedBox, usize) -> Option<usize>,
) -> Option<String> {
    let (mut out, mut open) = (String::new(), vec![(whole.clone(), 0)]);
    while let Some((mut part, halvings)) = open.pop() {
        if halvings > MOST_HALVINGS || !may_go_on() {
            return None;
        }
        if judge.shows(k, &mut part, true) {
            out.push('.');
            continue;
        }
        let axis = axis(&part, halvings)?;
        out.push(letter(axis));
        let [low, high] = judge.halves(k, &mut part, axis);
        open.extend([(high, halvings + 1), (low, halvings + 1)]);
    }
    Some(out)
}

/// `a`, `b`, ...: the name with this number.
pub(super) fn letter(name: usize) -> char {
    char::from(b'a' + u8::try_from(name).expect("there are few names"))
}

/// The tree of a claim without axes, of one leaf: that it holds, or that it does not.
pub(super) fn leaf(
    problem: &Problem,
    claim: &ForAllClaim,
    good: bool,
    budget: &Budget,
) -> Result<(String, (usize, usize)), Error> {
    let (judge, precision) = ForAll::new(problem, claim, budget)?;
    let leaf = judge.leaf(&mut judge.whole(), good, budget);
    budget.check()?;
    let close = || {
        let message = "no certificate: the checkers do not see it, the loop is too close to what is asked for";
        Diagnostic::error(Code::NoCertificate, message).help("the answer is printed without '--certificate'")
    };
    Ok((leaf.ok_or_else(close)?, precision))
}

/// A certificate that a loop meets requirements beside stability, or that it does not.
///
/// A margin is stability for all factors of a set at the cut, so it is proved as a loop with further parameters is, by boxes of these.
///
/// Cost: some dozen boxes of the factor for each requirement, more as the margin gets closer to what is required.
///
/// ```
/// use jurist_prove::certified::certify_requirements;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::Requirement;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// let text = "time = 'continuous'\nparameters.K = 1\nloop = { inputs = ['r'], outputs = ['y'] }\n\
///     [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(s + 1))'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let half: jurist_algebra::number::Rational = "1/2".parse().unwrap();
/// let (problem, budget) = (model.ask().set("K", half).problem()?, Budget::unlimited());
/// let requirement = [Requirement::phase_margin(&60.into())?];
/// let certificate = certify_requirements(&problem, &requirement, None, true, &budget)?;
/// let proved = check(text, &certificate, &Limits::default()).unwrap();
/// assert!(proved.statement.contains("60 degrees"));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) where the checkers do not read the model or the requirements, or do not see what is said;
/// [`Error::Stopped`] when the budget runs out.
pub fn certify_requirements(
    problem: &Problem,
    requirements: &[Requirement],
    at: Option<&str>,
    met: bool,
    budget: &Budget,
) -> Result<String, Error> {
    budget.step("certificate");
    let claim =
        ForAllClaim::new(Vec::new(), Vec::new()).with_requirements(requirements.to_vec(), at.map(str::to_owned));
    let (tree, precision) = leaf(problem, &claim, met, budget)?;
    for_all_certificate(problem, &claim, &tree, precision, budget)
}

/// A certificate of a verdict: an exact one, or that of a box of one point.
///
/// Cost: that of [`Certificate::certificate`](crate::Certificate::certificate), else that of one box.
///
/// ```
/// use jurist_prove::certified::certify_verdict;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// let text = "time = 'continuous'\nloop.characteristic = 's + pi/4 + sqrt(2)*exp(-s)'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let certificate = certify_verdict(&model.ask().verdict(&Budget::unlimited())?, &Budget::unlimited())?;
/// assert_eq!(check(text, &certificate, &Limits::default()).unwrap().statement, "The loop is stable.");
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where there is neither.
pub fn certify_verdict(answer: &Answer<PointVerdict>, budget: &Budget) -> Result<String, Error> {
    let (problem, verdict) = (answer.problem(), answer.value().verdict);
    let is_told = matches!(verdict, Verdict::Stable | Verdict::Unstable) && problem.model().is_read_by_boxes();
    match answer.certificate(budget) {
        Err(Error::Refused(why)) if why.code() == Code::NoCertificate && is_told => {
            match certify_requirements(problem, &[], None, verdict == Verdict::Stable, budget) {
                Err(Error::Refused(_)) => Err(Error::Refused(why)),
                found => found,
            }
        }
        found => found,
    }
}

/// Boxes of one or two axes as an answer decides them.
pub(super) struct Asked<'a> {
    pub problem: &'a Problem,
    pub claim: &'a ForAllClaim,
    pub boxes: &'a [PlaneBox],
    pub window: &'a Window,
    /// The share that is decided, and may yet be left unknown.
    pub goal: Rational,
    pub most_work: u64,
}

impl Asked<'_> {
    /// The certificate, and the shares that are good and not.
    pub fn certified(&self, budget: &Budget) -> Result<(String, [Rational; 2]), Error> {
        let (judge, precision) = ForAll::new(self.problem, self.claim, budget)?;
        let search = Search::new(self.boxes, self.window, self.goal.clone(), &judge);
        let (tree, shares) = search.tree(self.problem.model().source().text.len(), self.most_work, budget);
        Ok((for_all_certificate(self.problem, self.claim, &tree, precision, budget)?, shares))
    }
}

impl Judge for ForAll {
    type Box = Cell;

    const AXES: [char; 2] = ['a', 'b'];

    fn whole(&self) -> Cell {
        self.cell(&self.judge.whole(0), [0; 2])
    }

    fn halves(&self, of: &mut Cell, axis: usize) -> [Cell; 2] {
        let mut halvings = of.halvings;
        halvings[axis] += 1;
        [Part::Lower, Part::Upper].map(|half| {
            let axes = self.judge.part(&of.refuted[0], half, axis);
            self.cell(&axes, halvings)
        })
    }

    fn axis(&self, of: &Cell) -> usize {
        // Where the ranges change it most, that tells nothing of the axes.
        let widest = usize::from(self.axes == 2 && of.halvings[1] < of.halvings[0]);
        Some(self.judge.axis(0, &of.proofs[0][0])).filter(|axis| *axis < self.axes).unwrap_or(widest)
    }

    fn leaf(&self, of: &mut Cell, good: bool, budget: &Budget) -> Option<String> {
        match good {
            true => self.proved(of, budget).map(|proof| format!("+{proof}")),
            false => self.refuted(of, budget).map(|steps| format!("-{steps}")),
        }
    }

    fn work(&self) -> u64 {
        self.judge.work()
    }
}
