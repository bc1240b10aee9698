//! In which boxes of a window a loop meets its requirements.

use super::requirement::Requirement;
use super::requirement_boxes::{OverPoints, RequirementBoxes};
use crate::answer::{Answer, MapBoxes};
use crate::coverage::refusals::NOT_IN_A_PLANE;
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::plane::boxes::{BoxMap, BoxVerdict, Refined, Window, refined};
use crate::stability::subdivision::Look;
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// The stable boxes of a window, cut further, by whether their points meet requirements.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequiredBoxes {
    /// What is required.
    pub requirements: Vec<Requirement>,
    /// Where margins are taken, as it was asked for.
    pub at: Option<String>,
    /// The boxes, which tile the stable ones; by lower `x`, then by lower `y`.
    pub boxes: Vec<RequiredBox>,
    /// Their areas.
    pub areas: RequiredAreas,
    /// Why the subdivision stopped before so little was undecided as was asked for: `None` when it did not.
    pub stopped: Option<Stop>,
}

/// An open box of stable points.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RequiredBox {
    /// The box.
    pub window: Window,
    /// Whether all requirements are met at all points, or not all at any; `None` where neither is proved.
    pub met: Option<bool>,
    /// The number of a requirement that is met at no point.
    pub unmet: Option<usize>,
}

/// Exact areas, in the product of the parameters' units: their sum is that of the stable boxes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RequiredAreas {
    /// Of the boxes in which all requirements are met.
    pub met: Rational,
    /// Of those in which one is met nowhere.
    pub unmet: Rational,
    /// Of the rest.
    pub undecided: Rational,
}

impl Answer<MapBoxes> {
    /// The boxes with those inside of the stable ones in which requirements are met, margins being taken at a cut.
    ///
    /// A box is decided where no crossing of the open loop comes to where the requirement forbids it, at any of its points, or where one
    /// is there at all of them. Requirements on roots are decided where no root comes to the edge of the required region, by one point.
    ///
    /// Cost: Taylor models of the open loop's coefficients and some hundred values along the circle for each of about `1/h` boxes of side `h`
    /// along each boundary.
    ///
    /// # Errors
    /// [`Error::Refused`] for a requirement that is not decided in boxes, and as [`OpenLoop::of`](super::OpenLoop::of);
    /// [`Error::Stopped`] when the budget runs out before anything was cut.
    ///
    /// ```
    /// use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes};
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::response::Requirement;
    /// use jurist_engine::stability::Range;
    /// // The loop a K/(z - 1): |1 + L| is least at z = -1, where it is 1 - a K/2.
    /// let text = "time = 'discrete'\n[parameters]\nK = 0.5\na = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    ///     [[block]]\nname = 'c'\ngain = 'K'\ninput = 'r - y'\noutput = 'u'\n\
    ///     [[block]]\nname = 'p'\ntransfer = 'a/(z - 1)'\ninput = 'u'\noutput = 'y'\n";
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// let range = |hi: i64| Range::between(Some(0.into()), Some(hi.into()));
    /// let request = BoxRequest::new([range(2), range(1)], "1/50".parse()?);
    /// let budget = Budget::unlimited();
    /// let problem = model.ask().free("K").free("a").plane_problem()?;
    /// let MapOrBoxes::Boxes(boxes) = problem.map_by(MapMethod::Boxes, &request, 6, &budget)? else { panic!("asked for") };
    /// let found = boxes.with_requirements(&[Requirement::modulus_margin("1/2".parse()?)?], Some("u"), &budget)?;
    /// // Below the hyperbola a K = 1 the area is 1 + ln 2.
    /// let areas = &found.value().required.as_ref().unwrap().areas;
    /// assert!(areas.met < "1.6932".parse()? && &areas.met + &areas.undecided > "1.6931".parse()?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_requirements(
        self,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Answer<MapBoxes>, Error> {
        let problem = self.problem().clone();
        problem.refuse_complex_requirements(budget)?;
        problem.refuse_undamped(requirements, budget)?;
        let found = budget.enter(|| problem.required_boxes(requirements, at, self.value(), budget))??;
        let mut boxes = self.into_value();
        boxes.required = Some(found);
        Ok(Answer::new(problem, boxes))
    }
}

impl Problem {
    fn required_boxes(
        self: &Arc<Self>,
        requirements: &[Requirement],
        at: Option<&str>,
        found: &MapBoxes,
        budget: &Budget,
    ) -> Result<RequiredBoxes, Error> {
        let BoxMap { window, boxes, .. } = &found.boxes;
        let stable = boxes.iter().filter(|b| b.verdict == BoxVerdict::Stable).map(|b| b.window.clone());
        let stable: Vec<Window> = stable.collect();
        budget.step("boundaries of the requirements");
        let largest = stable.iter().max_by_key(|b| b.area()).unwrap_or(window);
        let near = middle(largest);
        let mut tests = Vec::with_capacity(requirements.len());
        for requirement in requirements {
            let known = RequirementBoxes::of(self, requirement, at, &near, budget)?;
            tests.push(known.ok_or_else(|| not_in_boxes(requirement))?);
        }
        budget.step("requirements in the stable boxes");
        let open: Vec<usize> = (0..requirements.len()).collect();
        let refined = refined(window, &stable, open, &found.goal, budget, |place, open| {
            let seen = look(&tests, &place.window(window), open, budget)?;
            Ok(seen.map_or(Look::Cut(place.wider()), Look::Decided))
        });
        Ok(RequiredBoxes::new(requirements, at, refined))
    }
}

/// The number of a requirement that no point of a stable box meets, or none where all points meet all; the outer one is none where nothing is
/// known of some requirement. What is met everywhere leaves the list.
fn look(
    tests: &[RequirementBoxes],
    window: &Window,
    open: &mut Vec<usize>,
    budget: &Budget,
) -> Result<Option<Option<usize>>, Exhausted> {
    let sides = [window.x.clone(), window.y.clone()];
    let mut rest = Vec::new();
    for &k in open.iter() {
        budget.check()?;
        match tests[k].look(&sides, budget)? {
            OverPoints::All => {}
            OverPoints::None => return Ok(Some(Some(k))),
            OverPoints::Open { .. } => rest.push(k),
        }
    }
    *open = rest;
    Ok(open.is_empty().then_some(None))
}

fn middle(window: &Window) -> Vec<Rational> {
    [&window.x, &window.y].map(|[low, high]| low.midpoint(high)).into()
}

impl RequiredBoxes {
    pub(super) fn new(requirements: &[Requirement], at: Option<&str>, found: Refined<Option<usize>>) -> RequiredBoxes {
        let decided =
            found.decided.into_iter().map(|(window, unmet)| RequiredBox { window, met: Some(unmet.is_none()), unmet });
        let open = found.undecided.into_iter().map(|window| RequiredBox { window, met: None, unmet: None });
        let mut boxes: Vec<RequiredBox> = decided.chain(open).collect();
        boxes.sort_by_cached_key(|b| (b.window.x[0].clone(), b.window.y[0].clone()));
        let area = |met: Option<bool>| {
            boxes.iter().filter(|b| b.met == met).fold(Rational::ZERO, |sum, b| sum + b.window.area())
        };
        let areas = RequiredAreas { met: area(Some(true)), unmet: area(Some(false)), undecided: area(None) };
        RequiredBoxes {
            requirements: requirements.to_vec(),
            at: at.map(str::to_owned),
            boxes,
            areas,
            stopped: found.stopped,
        }
    }
}

fn not_in_boxes(requirement: &Requirement) -> Error {
    let help = "ask 'intervals' for one parameter, or 'verdict' with a value for every parameter";
    NOT_IN_A_PLANE.diagnostic(&[("name", requirement.name()), ("help", help)]).into()
}
