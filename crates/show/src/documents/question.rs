//! What a document says of the question that it answers.

use super::end::Bounds;
use super::number::{Exact, Named};
use super::plan::Plan;
use jurist_engine::model::Time;
use jurist_engine::problem::{Free, Problem, Region};
use serde::{Deserialize, Serialize};

/// The region in which all roots have to lie, where it is smaller than that of plain stability; and of which step they are roots.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RegionBound {
    /// Discrete time: all |z| below this. Left out for the unit circle, and where the radius is the parameter in question.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<Exact>,
    /// Continuous time: all Re s below minus this, per unit of time. Left out for the imaginary axis, and where the decay
    /// rate is the parameter in question.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decay: Option<Exact>,
    /// Of a loop with several rates: a root is what a state grows by in a hyperperiod. Left out where all blocks run at the loop's samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hyperperiod: Option<Hyperperiod>,
}

/// After how long everything in a loop comes again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hyperperiod {
    /// In samples of the loop.
    pub steps: u64,
}

impl From<&Problem> for RegionBound {
    fn from(problem: &Problem) -> Self {
        let region: &Region = problem.region();
        let steps = Some(problem.model().hyperperiod()).filter(|steps| *steps > 1);
        RegionBound {
            radius: region.radius().map(Exact::from),
            decay: region.decay().map(Exact::from),
            hyperperiod: steps.map(|steps| Hyperperiod { steps }),
        }
    }
}

/// Which ends of a domain belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ClosedEnds {
    /// The lower one.
    pub lower: bool,
    /// The upper one.
    pub upper: bool,
}

impl ClosedEnds {
    fn of(free: &Free) -> Option<ClosedEnds> {
        let [lower, upper] = free.closed;
        (lower || upper).then_some(ClosedEnds { lower, upper })
    }
}

/// A question about one parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ParameterQuestion {
    /// The model's title; empty where it has none.
    pub title: String,
    /// The kind of time.
    pub time: Time,
    /// The name of the parameter in question.
    pub parameter: String,
    /// Its unit; `null` where the model names none.
    pub unit: Option<String>,
    /// Its nominal value in that unit; `null` where it has none.
    pub nominal: Option<Exact>,
    /// The values of all other parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// The interval of values that are asked about, without its ends but for those in `domain_closed`.
    pub domain: Bounds<Exact>,
    /// Which ends of the domain are asked about, too; left out where the domain is open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub domain_closed: Option<ClosedEnds>,
    /// The region.
    #[serde(flatten)]
    pub region: RegionBound,
    /// How the question is decided, where that was asked for with `--explain`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Box<Plan>>,
}

impl ParameterQuestion {
    pub(super) fn new(problem: &Problem) -> Self {
        let free = problem.parameter();
        ParameterQuestion {
            title: title(problem),
            time: problem.time(),
            parameter: free.name.clone(),
            unit: free.unit.clone(),
            nominal: free.nominal.as_ref().map(Exact::from),
            set: problem.set().into(),
            domain: (&free.domain).into(),
            domain_closed: ClosedEnds::of(free),
            region: problem.into(),
            plan: Plan::of(problem),
        }
    }
}

/// A question about a point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PointQuestion {
    /// The model's title; empty where it has none.
    pub title: String,
    /// The kind of time.
    pub time: Time,
    /// The values of the parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// The region.
    #[serde(flatten)]
    pub region: RegionBound,
    /// How the question is decided, where that was asked for with `--explain`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Box<Plan>>,
}

impl PointQuestion {
    /// The question of a problem.
    pub fn new(problem: &Problem) -> Self {
        PointQuestion {
            title: title(problem),
            time: problem.time(),
            set: problem.set().into(),
            region: problem.into(),
            plan: Plan::of(problem),
        }
    }
}

/// The model's title; empty where it has none.
pub(super) fn title(problem: &Problem) -> String {
    problem.title().unwrap_or_default().to_owned()
}
