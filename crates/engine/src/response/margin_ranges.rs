//! How much of each margin a loop has, by the value of one parameter.

use super::Requirements;
use super::required_set::RequiredSet;
use super::requirement::Requirement;
use crate::answer::Answer;
use crate::error::{Code, Error};
use crate::model::{Form, Model};
use crate::problem::Problem;
use crate::stability::StableSet;
use jurist_algebra::limits::Budget;
use std::sync::Arc;

/// The margins that are looked at where nothing else is said: names of requirements with what they ask for.
///
/// ```
/// use jurist_engine::response::USUAL_MARGINS;
/// assert!(USUAL_MARGINS.contains(&("phase_margin", "45 deg")));
/// ```
pub const USUAL_MARGINS: &[(&str, &str)] = &[
    ("gain_margin", "6 dB"),
    ("gain_margin", "10 dB"),
    ("phase_margin", "30 deg"),
    ("phase_margin", "45 deg"),
    ("phase_margin", "60 deg"),
    ("modulus_margin", "1/2"),
    ("modulus_margin", "7/10"),
];

/// The values of one parameter for which a loop is stable, and those for which it has margins of at least some sizes.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MarginRanges {
    /// Where the loop is stable.
    pub stable: StableSet,
    /// The margins, in the order in which they were asked for.
    pub levels: Vec<MarginLevel>,
}

/// A margin of at least some size.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MarginLevel {
    /// What is asked for.
    pub requirement: Requirement,
    /// The values for which the loop has it, or why that is not decided.
    pub found: Result<RequiredSet, String>,
}

impl Requirement {
    /// The usual margins as requirements.
    ///
    /// Cost: that of isolating the roots of a few polynomials of small degree.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub fn usual_margins(model: &Model, budget: &Budget) -> Result<Vec<Requirement>, Error> {
        let one =
            |&(name, text): &(&str, &str)| Ok(Requirements::without_section(model, &[(name, text)], &[], budget)?.list);
        let lists: Vec<Vec<Requirement>> = USUAL_MARGINS.iter().map(one).collect::<Result<_, Error>>()?;
        Ok(lists.into_iter().flatten().collect())
    }
}

impl Problem {
    /// For which values of the free parameter the loop has each of some margins, taken at a cut.
    ///
    /// Each is decided by itself, as [`Problem::required_set`] decides it; the stable set is computed once.
    ///
    /// Cost: that of the stable set, and of one requirement for each margin.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::response::Requirement;
    /// let text = "time = 'continuous'\nparameters.K = 1\nloop = { inputs = ['r'], outputs = ['y'] }\n\
    ///     [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(s + 1))'\n";
    /// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
    /// let budget = Budget::unlimited();
    /// let ranges = model.ask().free("K").problem()?.margin_ranges(&Requirement::usual_margins(&model, &budget)?, None, &budget)?;
    /// // tan(60 deg) = 1/w and K = w sqrt(1 + w^2) at the crossing: up to K = 2/3.
    /// let level = ranges.value().levels.iter().find(|level| level.requirement.required() == "60 deg").unwrap();
    /// let end = level.found.as_ref().unwrap().intervals[0].upper.as_ref().unwrap().value();
    /// assert_eq!(end.exact(), Some("2/3".parse()?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Problem::stable_set`]; [`Error::Refused`] for a cut that does not exist.
    ///
    /// # Panics
    /// Unless one parameter is free.
    pub fn margin_ranges(
        self: &Arc<Self>,
        margins: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Answer<MarginRanges>, Error> {
        self.refuse_complex_requirements(budget)?;
        // Where there are no signals the parameter itself is the gain.
        let own = || (!matches!(self.model().form(), Form::Blocks(_))).then_some(self.parameter().name.as_str());
        let at = match self.model().cut(at) {
            Ok(_) => at,
            Err(refused) => Some(own().filter(|_| at.is_none()).ok_or(refused)?),
        };
        let stable = self.stable_set(budget)?.into_value();
        let level = |requirement: &Requirement| {
            budget.step(&requirement.text());
            let found = match self.with_margins(std::slice::from_ref(requirement), &stable, at, budget) {
                Ok(set) => Ok(set),
                // Where the first is refused for the cut all are.
                Err(Error::Refused(why)) if why.code() == Code::Cut => return Err(Error::Refused(why)),
                Err(Error::Refused(why)) => Err(why.diagnostics()[0].message.clone()),
                Err(other) => return Err(other),
            };
            Ok(MarginLevel { requirement: requirement.clone(), found })
        };
        let levels = margins.iter().map(level).collect::<Result<_, Error>>()?;
        Ok(Answer::new(Arc::clone(self), MarginRanges { stable, levels }))
    }
}
