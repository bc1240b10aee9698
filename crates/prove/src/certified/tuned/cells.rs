//! The cells of a certificate of best gains.

use super::guess::{Guess, most_unstable};
use crate::certified::for_all::{UNITS_OF_JUDGE, letter, proof};
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_check::{ForAllJudge, JudgedBox, Part, TuneJudge};
use std::cell::{Cell, RefCell};

/// No cell is halved more often, of all gains together.
const MOST_HALVINGS: usize = 140;

/// Guesses that refuted other cells and are tried first.
const MOST_RECENT: usize = 3;

/// So many parts are looked at to see that gains are good.
const MOST_PARTS: usize = 500;

/// More work is not done: the slower checker takes half a minute at most for what comes out.
const MOST_WORK: u64 = 40_000_000_000;

/// Powers of two by which the boundary is moved, at least, and at most.
const EXPONENTS: std::ops::RangeInclusive<i64> = -60..=60;

/// Cells of gains, and what a check sees of them.
pub(super) struct Cells<'a> {
    judge: &'a TuneJudge,
    gains: usize,
    budget: &'a Budget,
    recent: RefCell<Vec<Guess>>,
    counted: Cell<u64>,
}

/// What came of a search.
pub(super) enum Written {
    Tree(String),
    /// The checkers do not see it.
    TooClose,
}

/// A cell whose turn comes.
struct Open {
    cell: JudgedBox,
    halvings: usize,
    /// What nearly refuted the cell that was halved.
    hint: Option<Guess>,
}

/// How a cell is seen.
enum Seen {
    Leaf(String),
    /// It is to be halved along a gain; with what nearly refutes it.
    Open(Option<usize>, Option<Guess>),
}

impl<'a> Cells<'a> {
    pub fn new(judge: &'a TuneJudge, budget: &'a Budget) -> Self {
        let gains = judge.loops().names(0);
        let counted = Cell::new(judge.loops().work());
        Cells { judge, gains, budget, recent: RefCell::default(), counted }
    }

    fn loops(&self) -> &ForAllJudge {
        self.judge.loops()
    }

    /// Asks the budget for what was done since.
    fn may_go_on(&self) -> bool {
        let work = self.loops().work();
        let done = work - self.counted.replace(work);
        self.budget.enter(|| checkpoint(1 + done / UNITS_OF_JUDGE)).is_ok()
    }

    /// How it is written that the gains that are found are good; `None` where the checkers do not see that.
    pub fn proof_of_found(&self) -> Option<String> {
        let mut out = String::new();
        let mut left = MOST_PARTS;
        for k in self.judge.of_found() {
            for whole in self.judge.proofs_of_found(k) {
                let mut may_go_on = || {
                    left = left.saturating_sub(1);
                    left > 0 && self.may_go_on()
                };
                let has_width = |part: &JudgedBox, axis: usize| {
                    let side = &self.loops().sides(part)[axis];
                    side[0] != side[1]
                };
                let axis = |part: &JudgedBox, halvings: usize| {
                    let axis = self.loops().axis(k, part);
                    let own: Vec<usize> =
                        (self.gains..self.loops().names(k)).filter(|&axis| has_width(part, axis)).collect();
                    if own.contains(&axis) { Some(axis) } else { own.get(halvings % own.len().max(1)).copied() }
                };
                out += &proof((self.loops(), k), &whole, &mut may_go_on, &axis)?;
            }
        }
        Some(out)
    }

    /// The tree of cells of which no gains are good, with a model of so many bytes.
    pub fn tree(&self, model_bytes: usize) -> Written {
        let mut out = String::new();
        let mut open = vec![Open { cell: self.judge.whole(0), halvings: 0, hint: None }];
        let (mut of_check, mut leaves) = (self.loops().work(), 0);
        while let Some(Open { cell, halvings, hint }) = open.pop() {
            let allowed = ForAllJudge::allowed(model_bytes + out.len() + open.len());
            if halvings > MOST_HALVINGS || of_check > allowed || self.loops().work() > MOST_WORK || !self.may_go_on() {
                return Written::TooClose;
            }
            let mut cost = 0;
            match self.look(&cell, hint, &mut cost) {
                Seen::Leaf(leaf) => {
                    out += &leaf;
                    of_check += cost;
                    leaves += 1;
                    self.budget.advance(leaves, leaves + open.len() as u64);
                }
                Seen::Open(axis, hint) => {
                    // Now and then the widest gain: what changes most here may change little further on.
                    let axis = axis.filter(|_| halvings % 3 != 2).or_else(|| self.judge.widest(&cell));
                    let Some(axis) = axis else { return Written::TooClose };
                    out.push(letter(axis));
                    for half in [Part::Upper, Part::Lower] {
                        let cell = self.loops().part(&cell, half, axis);
                        open.push(Open { cell, halvings: halvings + 1, hint: hint.clone() });
                    }
                }
            }
        }
        Written::Tree(out)
    }

    /// A leaf that refutes a cell, if the check sees one, with what its check costs.
    fn look(&self, cell: &JudgedBox, hint: Option<Guess>, cost: &mut u64) -> Seen {
        if self.judge.is_worse(cell) {
            return Seen::Leaf("o".to_owned());
        }
        let mut tried: Vec<Guess> = Vec::new();
        let recent = self.recent.borrow().clone();
        for guess in hint.into_iter().chain(recent) {
            if !tried.contains(&guess) {
                if let Some(leaf) = self.refuted(cell, &guess, cost) {
                    return Seen::Leaf(leaf);
                }
                tried.push(guess);
            }
        }
        let guesses = self.guesses(cell);
        for (guess, abscissa) in &guesses {
            let exponent = (abscissa / 2.0).log2().floor();
            let exponent = Some(exponent as i64).filter(|e| *abscissa > 0.0 && EXPONENTS.contains(e));
            for exponent in [None].into_iter().chain(exponent.map(Some)) {
                if let Some(leaf) = self.refuted(cell, &Guess { exponent, ..guess.clone() }, cost) {
                    return Seen::Leaf(leaf);
                }
            }
        }
        let likeliest = guesses.into_iter().next().map(|(guess, _)| guess);
        let axis = likeliest.as_ref().and_then(|guess| {
            let mut part = guess.part(self.judge, &self.loops().over(cell, guess.number));
            // What is known of it afterwards says what changes it most.
            self.loops().shows(guess.number, &mut part, false);
            Some(self.loops().axis(guess.number, &part)).filter(|axis| *axis < self.gains)
        });
        Seen::Open(axis, likeliest)
    }

    /// What is likely to refute the middle of a cell, the likeliest first, with how far beyond the boundary a root is there.
    fn guesses(&self, cell: &JudgedBox) -> Vec<(Guess, f64)> {
        let middle = |k: usize| {
            let whole = self.loops().over(cell, k);
            (0..self.gains).fold(whole, |part, axis| self.loops().part(&part, Part::Middle, axis))
        };
        let found = (0..self.judge.refutable()).filter_map(|k| most_unstable(self.judge, k, self.gains, &middle(k)));
        let mut found: Vec<(Guess, f64)> = found.collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        found
    }

    /// The leaf of a guess, if the check sees it.
    fn refuted(&self, cell: &JudgedBox, guess: &Guess, cost: &mut u64) -> Option<String> {
        let before = self.loops().work();
        let mut part = guess.part(self.judge, &self.loops().over(cell, guess.number));
        let is_seen = match guess.exponent {
            None => self.loops().shows(guess.number, &mut part, false),
            Some(exponent) => self.judge.has_root_beyond(guess.number, &mut part, exponent),
        };
        if !is_seen {
            return None;
        }
        *cost = self.loops().work() - before;
        let mut recent = self.recent.borrow_mut();
        recent.retain(|known| known != guess);
        recent.insert(0, guess.clone());
        recent.truncate(MOST_RECENT);
        let begin = guess.exponent.map_or_else(|| "-".to_owned(), |exponent| format!("s{exponent};"));
        let steps: String = guess.steps.iter().flat_map(|(step, name)| [step.letter(), letter(*name)]).collect();
        Some(format!("{begin}{}{steps}.", guess.number))
    }
}
