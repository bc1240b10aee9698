//! Certificates of maps by boxes, made with what the check sees as the judge of each box.

use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::Rational;
use jurist_check::{BoxJudge, JudgedBox, Limits};
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::problem::Problem;
use jurist_engine::stability::plane::boxes::{BoxVerdict, PlaneBox, Window};
use std::collections::VecDeque;
use std::time::Duration;

/// Degree of the Taylor models and bits of their coefficients. Of loops of order 6 behind a hold some degrees less need twice the boxes, some
/// more save none of them.
const ORDER: usize = 6;
const BITS: usize = 256;

/// The same of loops with dead time: what is not linear in a box is left out. As many bits more than the frequencies have.
const ORDER_WITH_DEAD_TIME: usize = 1;
const BITS_WITH_DEAD_TIME: usize = 128;

/// So much of what the answer decides may stay unknown: this power of two less than what may stay undecided in the answer.
const LEFT_BITS: u64 = 3;

/// More work is not done, counted by the judge: the slower checker takes half a minute at most for what comes out.
const MOST_WORK: u64 = 40_000_000_000;

/// So many of the judge's units are a unit of a budget.
const UNITS_OF_JUDGE: u64 = 32;

/// No box is halved more often.
const MOST_HALVINGS: usize = 60;

/// A certificate of a map by boxes, and how much of the window it speaks of.
///
/// The shares are of the window's area; what is neither is unknown in the certificate.
///
/// ```
/// use jurist::{BoxRequest, Budget, MapMethod, MapOrBoxes, Model, Range, certify_boxes};
/// let side = |low: &str, high: &str| Range::between(low.parse().ok(), high.parse().ok());
/// let request = BoxRequest::new([side("1/12000", "1/10000"), side("100", "110")], "1/10".parse().unwrap());
/// let problem = Model::drive().ask().free("T").free("K_pwm").plane_problem()?;
/// let MapOrBoxes::Boxes(boxes) = problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited())? else { panic!() };
/// let certified = certify_boxes(&boxes, &Budget::unlimited())?;
/// assert_eq!((certified.stable, certified.unstable), (1.into(), 0.into()));
/// # Ok::<(), jurist::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CertifiedBoxes {
    /// The certificate.
    pub text: String,
    /// The share that is proved stable, 0 to 1.
    pub stable: Rational,
    /// The share that is proved to hold no stable point, 0 to 1.
    pub unstable: Rational,
}

/// What the tree is to say of a box.
enum Wanted {
    /// That it is stable everywhere, or nowhere.
    All(bool),
    /// What these boxes of the answer say, by their numbers.
    Each(Vec<usize>),
}

/// A box whose turn comes.
struct Open {
    node: usize,
    halvings: usize,
    window: Window,
    judged: JudgedBox,
    wanted: Wanted,
}

#[derive(Clone, Copy)]
enum Node {
    Leaf(char),
    Halved(usize, [usize; 2]),
}

/// A certificate of a map by boxes.
///
/// Boxes of the answer are taken together where the check sees the whole of them, and halved where it does not see as much at once as the engine
/// does. It never says more than the answer. A budget that runs out leaves more unknown.
///
/// What is shown of a box is shown by Taylor models ([MakinoBerz2003](jurist_algebra::bibliography#makinoberz2003)), see
/// [`grammar`](jurist_check::grammar).
///
/// Cost: each box is tried, so for the tree twice what its check costs.
///
/// ```standalone_crate
/// use jurist::{BoxRequest, Budget, Limits, MapMethod, MapOrBoxes, Model, Range, Source, certify_boxes, check};
/// let text = std::fs::read_to_string("examples/dc-servo.toml").unwrap();
/// let (model, _) = Model::from_toml(&Source::new("dc-servo.toml", &text))?;
/// let side = |low: &str, high: &str| Range::between(low.parse().ok(), high.parse().ok());
/// let request = BoxRequest::new([side("1", "200"), side("1/2000", "1/100")], "1/10".parse().unwrap());
/// let problem = model.ask().free("K").free("T").plane_problem()?;
/// let MapOrBoxes::Boxes(boxes) = problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited())? else { panic!() };
/// let certified = certify_boxes(&boxes, &Budget::unlimited())?;
/// assert!(&certified.stable + &certified.unstable > "4/5".parse().unwrap());
/// assert_eq!(check(&text, &certified.text, &Limits::default()).unwrap().kind, "boxes");
/// # Ok::<(), jurist::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) for models with requirements, a region whose bound is free, and what else the check does
/// not read.
pub fn certify_boxes(answer: &Answer<MapBoxes>, budget: &Budget) -> Result<CertifiedBoxes, Error> {
    budget.step("certificate");
    let (problem, window) = (answer.problem(), &answer.value().boxes.window);
    let judge = judge(problem, window, budget)?;
    let map = &answer.value().boxes;
    let goal = &answer.value().goal * &Rational::dyadic(&1.into(), LEFT_BITS);
    let (order, bits) = precision(problem, budget)?;
    let search = Search::new(&map.boxes, &map.window, goal, &judge, false);
    let (tree, [stable, unstable]) = search.tree(problem.model().source().text.len(), MOST_WORK, budget);
    Ok(CertifiedBoxes { text: problem.boxes_certificate(window, &tree, order, bits)?, stable, unstable })
}

/// What the check sees of a window.
///
/// # Errors
/// Those of [`certify_boxes`], which are known before there is a map.
pub(crate) fn judge(problem: &Problem, window: &Window, budget: &Budget) -> Result<BoxJudge, Error> {
    let (order, bits) = precision(problem, budget)?;
    let draft = problem.boxes_certificate(window, "?", order, bits)?;
    // Reading a model is counted work; between boxes the budget is asked.
    let judge = BoxJudge::new(&problem.model().source().text, &draft, &Limits::within(Duration::MAX));
    judge.map_err(|rejection| {
        Diagnostic::error(Code::NoCertificate, format!("no certificate of this map by boxes: {}", rejection.reason))
            .help("the checkers read the model themselves; the answer is printed without '--certificate'")
            .into()
    })
}

pub(crate) fn precision(problem: &Problem, budget: &Budget) -> Result<(usize, usize), Error> {
    // Sampled loops have no such dead time, and polynomials over a hyperperiod are long.
    if problem.model().hyperperiod() > 1 {
        return Ok((ORDER, BITS));
    }
    Ok(match problem.algebra_over_symbols(budget)?.symbols().delays().is_empty() {
        true => (ORDER, BITS),
        false => (ORDER_WITH_DEAD_TIME, BITS_WITH_DEAD_TIME),
    })
}

pub(crate) struct Search<'a> {
    boxes: &'a [PlaneBox],
    judge: &'a BoxJudge,
    /// Whether boxes are never halved in the second parameter.
    is_line: bool,
    /// The share of the window that is decided, and may yet be left unknown.
    goal: Rational,
    nodes: Vec<Node>,
    /// By the number of halvings.
    open: VecDeque<Open>,
}

impl<'a> Search<'a> {
    /// For what these boxes of the window, which come from halving it, say, but for a share of the window.
    pub fn new(boxes: &'a [PlaneBox], window: &Window, goal: Rational, judge: &'a BoxJudge, is_line: bool) -> Self {
        let (nodes, open) = (vec![Node::Leaf('?')], VecDeque::new());
        let mut search = Search { boxes, judge, is_line, goal, nodes, open };
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
        // A node is a letter of the tree.
        let allowed = |nodes: usize| most_work.min(BoxJudge::allowed(model_bytes + nodes));
        let mut counted = self.judge.work();
        while waiting > self.goal && self.judge.work() < allowed(self.nodes.len()) {
            let done = self.judge.work() - counted;
            counted += done;
            if budget.enter(|| checkpoint(1 + done / UNITS_OF_JUDGE)).is_err() {
                break;
            }
            let Some(mut open) = self.open.pop_front() else { break };
            let share = Rational::dyadic(&1.into(), open.halvings as u64);
            let axis = match &open.wanted {
                Wanted::All(stable) if self.judge.shows(&mut open.judged, *stable) => {
                    self.nodes[open.node] = Node::Leaf(if *stable { '+' } else { '-' });
                    shares[usize::from(!stable)] += &share;
                    waiting -= &share;
                    leaves += 1;
                    budget.advance(leaves as u64, (leaves + self.open.len()) as u64);
                    continue;
                }
                Wanted::All(_) if open.halvings >= MOST_HALVINGS => continue,
                Wanted::All(_) if self.is_line => 0,
                Wanted::All(_) => self.judge.axis(&open.judged),
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

    fn halve(&mut self, mut open: Open, axis: usize) {
        let at = middle(&open.window, axis);
        let judged = self.judge.halves(&mut open.judged, axis);
        let first = self.nodes.len();
        self.nodes[open.node] = Node::Halved(axis, [first, first + 1]);
        for (k, judged) in judged.into_iter().enumerate() {
            self.nodes.push(Node::Leaf('?'));
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
                    match self.wanted(boxes.iter().filter(overlaps).copied().collect()) {
                        Some(wanted) => wanted,
                        None => continue,
                    }
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
                Node::Leaf(letter) => *letter != '?',
                Node::Halved(_, halves) => halves.iter().any(|&half| said[half]),
            };
        }
        let mut out = String::new();
        let mut stack = vec![0];
        while let Some(i) = stack.pop() {
            match self.nodes[i] {
                Node::Leaf(letter) => out.push(letter),
                Node::Halved(..) if !said[i] => out.push('?'),
                Node::Halved(axis, [low, high]) => {
                    out.push(if axis == 0 { 'x' } else { 'y' });
                    stack.extend([high, low]);
                }
            }
        }
        out
    }
}

fn side(window: &Window, axis: usize) -> &[Rational; 2] {
    if axis == 0 { &window.x } else { &window.y }
}

fn middle(window: &Window, axis: usize) -> Rational {
    let [low, high] = side(window, axis);
    low.midpoint(high)
}
