//! Certificates of maps by boxes, made with what the check sees as the judge of each box.

use super::for_all::Asked;
use super::for_all::ForAll;
use super::search::{Judge, Search};
use crate::ForAllClaim;
use crate::boxes_certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::{BoxJudge, JudgedBox, Limits};
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_engine::problem::Free;
use jurist_engine::problem::Problem;
use jurist_engine::response::Requirements;
use jurist_engine::response::{AllOf, RequiredBox, RequiredBoxes};
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_stability::plane::boxes::{BoxVerdict, PlaneBox, Window};
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

/// A certificate of a map by boxes, and how much of the window it speaks of.
///
/// The shares are of the window's area; what is neither is unknown in the certificate.
///
/// ```
/// use jurist_prove::certified::certify_boxes;
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_stability::Range;
/// let side = |low: &str, high: &str| Range::between(low.parse().ok(), high.parse().ok());
/// let request = BoxRequest::new([side("1/12000", "1/10000"), side("100", "110")], "1/10".parse().unwrap());
/// let problem = Model::drive().ask().free("T").free("K_pwm").plane_problem()?;
/// let MapOrBoxes::Boxes(boxes) = problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited())? else { panic!() };
/// let certified = certify_boxes(&boxes, &Budget::unlimited())?;
/// assert_eq!((certified.stable, certified.unstable), (1.into(), 0.into()));
/// # Ok::<(), jurist_model::error::Error>(())
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
/// ```
/// use jurist_prove::certified::certify_boxes;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// use jurist_stability::Range;
/// let text = std::fs::read_to_string("../../examples/dc-servo.toml").unwrap();
/// let (model, _) = Model::from_toml(&Source::new("dc-servo.toml", &text))?;
/// let side = |low: &str, high: &str| Range::between(low.parse().ok(), high.parse().ok());
/// let request = BoxRequest::new([side("1", "200"), side("1/2000", "1/100")], "1/10".parse().unwrap());
/// let problem = model.ask().free("K").free("T").plane_problem()?;
/// let MapOrBoxes::Boxes(boxes) = problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited())? else { panic!() };
/// let certified = certify_boxes(&boxes, &Budget::unlimited())?;
/// assert!(&certified.stable + &certified.unstable > "4/5".parse().unwrap());
/// assert_eq!(check(&text, &certified.text, &Limits::default()).unwrap().kind, "boxes");
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) for models with requirements, a region whose bound is free, and what else the check does
/// not read.
pub fn certify_boxes(answer: &Answer<MapBoxes>, budget: &Budget) -> Result<CertifiedBoxes, Error> {
    budget.step("certificate");
    let (problem, window) = (answer.problem(), &answer.value().boxes.window);
    let goal = &answer.value().goal * &Rational::dyadic(&1.into(), LEFT_BITS);
    if answer.value().required.is_some() || !answer.value().for_all.is_empty() {
        return of_all_values(answer, goal, budget);
    }
    let judge = judge(problem, window, budget)?;
    let map = &answer.value().boxes;
    let (order, bits) = precision(problem, budget)?;
    let judge = Boxes { judge: &judge, is_line: false };
    let search = Search::new(&map.boxes, &map.window, goal, &judge);
    let (tree, [stable, unstable]) = search.tree(problem.model().source().text.len(), MOST_WORK, budget);
    Ok(CertifiedBoxes { text: boxes_certificate(problem, window, &tree, order, bits)?, stable, unstable })
}

/// The same with requirements, or for all values of other names.
fn of_all_values(answer: &Answer<MapBoxes>, goal: Rational, budget: &Budget) -> Result<CertifiedBoxes, Error> {
    let (problem, MapBoxes { boxes, required, for_all, .. }) = (answer.problem(), answer.value());
    let claim = claim(problem, &boxes.window, for_all.clone(), required.as_ref());
    let met = |b: &RequiredBox| PlaneBox {
        window: b.window.clone(),
        verdict: match b.met {
            Some(true) => BoxVerdict::Stable,
            Some(false) => BoxVerdict::Unstable { outside: None },
            None => BoxVerdict::Undecided,
        },
    };
    let all: Vec<PlaneBox> = match required {
        None => boxes.boxes.clone(),
        Some(required) => {
            let beside = boxes.boxes.iter().filter(|b| b.verdict != BoxVerdict::Stable).cloned();
            beside.chain(required.boxes.iter().map(met)).collect()
        }
    };
    let window = &boxes.window;
    let asked = Asked { problem, claim: &claim, boxes: &all, window, goal, most_work: MOST_WORK };
    let (text, [stable, unstable]) = asked.certified(budget)?;
    Ok(CertifiedBoxes { text, stable, unstable })
}

/// Refuses requirements that have no certificate, before there is a map.
///
/// # Errors
/// Those of [`certify_boxes`].
pub fn refuse_required(problem: &Problem, asked: &Requirements, budget: &Budget) -> Result<(), Error> {
    // Any window will do to see whether the checkers read them.
    let axis = |free: &Free| AllOf::new(&free.name, Rational::ZERO, Rational::ONE).expect("not empty");
    let axes = problem.free().iter().map(axis).collect();
    let claim = ForAllClaim::new(axes, Vec::new()).with_requirements(asked.list.clone(), asked.at.clone());
    ForAll::new(problem, &claim, budget).map(|_| ())
}

/// What is said of a window of two names.
fn claim(problem: &Problem, window: &Window, all: Vec<AllOf>, required: Option<&RequiredBoxes>) -> ForAllClaim {
    let sides = problem.axes().into_iter().zip([&window.x, &window.y]);
    let axes = sides.map(|(axis, [low, high])| AllOf::new(&axis.name, low.clone(), high.clone()));
    let axes = axes.map(|axis| axis.expect("a window is not empty")).collect();
    let claim = ForAllClaim::new(axes, all);
    match required {
        Some(required) => claim.with_requirements(required.requirements.clone(), required.at.clone()),
        None => claim,
    }
}

/// What the check sees of a window.
///
/// # Errors
/// Those of [`certify_boxes`], which are known before there is a map.
pub fn judge(problem: &Problem, window: &Window, budget: &Budget) -> Result<BoxJudge, Error> {
    let (order, bits) = precision(problem, budget)?;
    let draft = boxes_certificate(problem, window, "?", order, bits)?;
    // Reading a model is counted work; between boxes the budget is asked.
    let judge = BoxJudge::new(&problem.model().source().text, &draft, &Limits::within(Duration::MAX));
    judge.map_err(|rejection| {
        Diagnostic::error(Code::NoCertificate, format!("no certificate of this map by boxes: {}", rejection.reason))
            .help("the checkers read the model themselves; the answer is printed without '--certificate'")
            .into()
    })
}

pub(super) fn precision(problem: &Problem, budget: &Budget) -> Result<(usize, usize), Error> {
    // Sampled loops have no such dead time, and polynomials over a hyperperiod are long.
    if problem.model().hyperperiod() > 1 {
        return Ok((ORDER, BITS));
    }
    Ok(match problem.algebra_over_symbols(budget)?.symbols().delays().is_empty() {
        true => (ORDER, BITS),
        false => (ORDER_WITH_DEAD_TIME, BITS_WITH_DEAD_TIME),
    })
}

/// The judge of maps by boxes.
pub(crate) struct Boxes<'a> {
    pub judge: &'a BoxJudge,
    /// Whether boxes are never halved in the second parameter.
    pub is_line: bool,
}

impl Judge for Boxes<'_> {
    type Box = JudgedBox;

    const AXES: [char; 2] = ['x', 'y'];

    fn whole(&self) -> JudgedBox {
        self.judge.whole()
    }

    fn halves(&self, of: &mut JudgedBox, axis: usize) -> [JudgedBox; 2] {
        self.judge.halves(of, axis)
    }

    fn axis(&self, of: &JudgedBox) -> usize {
        if self.is_line { 0 } else { self.judge.axis(of) }
    }

    fn leaf(&self, of: &mut JudgedBox, good: bool, _: &Budget) -> Option<String> {
        self.judge.shows(of, good).then(|| if good { "+" } else { "-" }.to_owned())
    }

    fn work(&self) -> u64 {
        self.judge.work()
    }
}
