//! The tree of a certificate by boxes: what an answer says of boxes, as far as a judge shows it.

use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::Rational;
use jurist_check::BoxJudge;
use jurist_stability::plane::boxes::{BoxVerdict, PlaneBox, Window};
use std::collections::VecDeque;

/// No box is halved more often.
const MOST_HALVINGS: usize = 60;

/// So many of the judge's units are a unit of a budget.
const UNITS_OF_JUDGE: u64 = 32;

/// Who decides what a check of the tree sees of a box.
pub(crate) trait Judge {
    /// A box, and what is known of it.
    type Box;

    /// How it is written that a box is halved along either axis.
    const AXES: [char; 2];

    /// The whole window.
    fn whole(&self) -> Self::Box;

    fn halves(&self, of: &mut Self::Box, axis: usize) -> [Self::Box; 2];

    /// The axis along which a box is to be halved, if nothing is shown of it.
    fn axis(&self, of: &Self::Box) -> usize;

    /// A leaf that says of a box that all of its points are good, or none; `None` where the check does not see that.
    fn leaf(&self, of: &mut Self::Box, good: bool, budget: &Budget) -> Option<String>;

    /// The work so far, in the units of a check.
    fn work(&self) -> u64;
}

/// What the tree is to say of a box.
enum Wanted {
    /// That it is stable everywhere, or nowhere.
    All(bool),
    /// What these boxes of the answer say, by their numbers.
    Each(Vec<usize>),
}

/// A box whose turn comes.
struct Open<B> {
    node: usize,
    halvings: usize,
    window: Window,
    judged: B,
    wanted: Wanted,
}

enum Node {
    Leaf(String),
    Halved(usize, [usize; 2]),
}

pub(crate) struct Search<'a, J: Judge> {
    boxes: &'a [PlaneBox],
    judge: &'a J,
    /// The share of the window that is decided, and may yet be left unknown.
    goal: Rational,
    nodes: Vec<Node>,
    /// By the number of halvings.
    open: VecDeque<Open<J::Box>>,
}

impl<'a, J: Judge> Search<'a, J> {
    /// For what these boxes of the window, which come from halving it, say, but for a share of the window.
    pub fn new(boxes: &'a [PlaneBox], window: &Window, goal: Rational, judge: &'a J) -> Self {
        let (nodes, open) = (vec![unknown()], VecDeque::new());
        let mut search = Search { boxes, judge, goal, nodes, open };
        if let Some(wanted) = search.wanted((0..boxes.len()).collect()) {
            let (window, judged) = (window.clone(), judge.whole());
            search.open.push_back(Open { node: 0, halvings: 0, window, judged, wanted });
        }
        search
    }

    /// The tree as text, and the shares that are stable and not stable in it; the judge does no more work than that, nor than a check of this
    /// tree and a model of so many bytes may be.
    pub fn tree(mut self, model_bytes: usize, most_work: u64, budget: &Budget) -> (String, [Rational; 2]) {
        let mut shares = [Rational::ZERO, Rational::ZERO];
        let mut leaves = 0;
        // What is decided, and waits.
        let mut waiting = self.decided_share();
        // What a check of the tree does, of so long a text.
        let (mut of_check, mut written) = (self.judge.work(), 0);
        let allowed = |bytes: usize| BoxJudge::allowed(model_bytes + bytes);
        let mut counted = self.judge.work();
        while waiting > self.goal && self.judge.work() < most_work && of_check < allowed(written + self.nodes.len()) {
            let done = self.judge.work() - counted;
            counted += done;
            if budget.enter(|| checkpoint(1 + done / UNITS_OF_JUDGE)).is_err() {
                break;
            }
            let Some(mut open) = self.open.pop_front() else { break };
            let share = Rational::dyadic(&1.into(), open.halvings as u64);
            let axis = match &open.wanted {
                Wanted::All(good) => {
                    let before = self.judge.work();
                    let leaf = self.judge.leaf(&mut open.judged, *good, budget);
                    let worked = of_check + (self.judge.work() - before);
                    if let Some(leaf) = leaf {
                        if worked > allowed(written + leaf.len() + self.nodes.len()) {
                            continue;
                        }
                        of_check = worked;
                        written += leaf.len();
                        self.nodes[open.node] = Node::Leaf(leaf);
                        shares[usize::from(!good)] += &share;
                        waiting -= &share;
                        leaves += 1;
                        budget.advance(leaves as u64, (leaves + self.open.len()) as u64);
                        continue;
                    }
                    if open.halvings >= MOST_HALVINGS {
                        continue;
                    }
                    self.judge.axis(&open.judged)
                }
                Wanted::Each(boxes) => self.cut(&open.window, boxes),
            };
            self.halve(open, axis);
        }
        (self.text(), shares)
    }

    /// The share of the window that the answer decides.
    fn decided_share(&self) -> Rational {
        let area = self.boxes.iter().fold(Rational::ZERO, |sum, b| sum + b.window.area());
        let decided = self.boxes.iter().filter(|b| b.verdict != BoxVerdict::Undecided);
        let sum = decided.fold(Rational::ZERO, |sum, b| sum + b.window.area());
        sum.checked_div(&area).expect("the window is not empty")
    }

    /// What these boxes of the answer say; `None` if they say nothing.
    fn wanted(&self, boxes: Vec<usize>) -> Option<Wanted> {
        let all = |verdict: fn(BoxVerdict) -> bool| boxes.iter().all(|&b| verdict(self.boxes[b].verdict));
        if all(|v| v == BoxVerdict::Undecided) {
            return None;
        }
        Some(match (all(|v| v == BoxVerdict::Stable), all(|v| matches!(v, BoxVerdict::Unstable { .. }))) {
            (true, _) => Wanted::All(true),
            (_, true) => Wanted::All(false),
            _ => Wanted::Each(boxes),
        })
    }

    /// An axis in whose middle no box is cut; there is one, since the boxes come from halving.
    fn cut(&self, window: &Window, boxes: &[usize]) -> usize {
        let is_cut = |axis: usize| {
            let middle = middle(window, axis);
            boxes.iter().any(|&b| {
                let [low, high] = side(&self.boxes[b].window, axis);
                *low < middle && middle < *high
            })
        };
        usize::from(is_cut(0))
    }

    fn halve(&mut self, mut open: Open<J::Box>, axis: usize) {
        let at = middle(&open.window, axis);
        let judged = self.judge.halves(&mut open.judged, axis);
        let first = self.nodes.len();
        self.nodes[open.node] = Node::Halved(axis, [first, first + 1]);
        for (k, judged) in judged.into_iter().enumerate() {
            self.nodes.push(unknown());
            let mut window = open.window.clone();
            match axis {
                0 => window.x[1 - k] = at.clone(),
                _ => window.y[1 - k] = at.clone(),
            }
            let wanted = match &open.wanted {
                Wanted::All(stable) => Wanted::All(*stable),
                Wanted::Each(boxes) => {
                    let overlaps = |b: &&usize| {
                        let [low, high] = side(&self.boxes[**b].window, axis);
                        if k == 0 { *low < at } else { *high > at }
                    };
                    let wanted = self.wanted(boxes.iter().filter(overlaps).copied().collect());
                    let Some(wanted) = wanted else { continue };
                    wanted
                }
            };
            self.open.push_back(Open { node: first + k, halvings: open.halvings + 1, window, judged, wanted });
        }
    }

    /// In prefix order; halves of which nothing is said are one box of which nothing is said.
    fn text(&self) -> String {
        let mut said = vec![false; self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate().rev() {
            // Halves come behind what was halved.
            said[i] = match node {
                Node::Leaf(leaf) => leaf != UNKNOWN,
                Node::Halved(_, halves) => halves.iter().any(|&half| said[half]),
            };
        }
        let mut out = String::new();
        let mut stack = vec![0];
        while let Some(i) = stack.pop() {
            match &self.nodes[i] {
                Node::Leaf(leaf) => out.push_str(leaf),
                Node::Halved(..) if !said[i] => out.push_str(UNKNOWN),
                Node::Halved(axis, [low, high]) => {
                    out.push(J::AXES[*axis]);
                    stack.extend([*high, *low]);
                }
            }
        }
        out
    }
}

/// A leaf that says nothing.
const UNKNOWN: &str = "?";

fn unknown() -> Node {
    Node::Leaf(UNKNOWN.to_owned())
}

fn side(window: &Window, axis: usize) -> &[Rational; 2] {
    if axis == 0 { &window.x } else { &window.y }
}

fn middle(window: &Window, axis: usize) -> Rational {
    let [low, high] = side(window, axis);
    low.midpoint(high)
}
