//! The document `jurist/tolerance/1`.

use super::number::{Exact, Named};
use super::plan::Plan;
use super::question::{RegionBound, title};
use super::requirements::RequirementAsked;
use super::{AllValues, Answered, End, FrequencyOfPair, RootsByPlace, Undecided, schema_name};
use crate::bounded::at_most;
use crate::tolerance::sign_name;
use crate::{Document, real};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_engine::answer::{
    Answer, ExactFactor, LimitSide, PointVerdict, RequiredBox, ToleranceAnswer, ToleranceLimit, WorstEnd,
};
use jurist_engine::model::Time;
use jurist_engine::problem::Problem;
use jurist_engine::stability::boxes::{BoxDecision, LargestFactor, OpenReason, Witness};
use serde::{Deserialize, Serialize};

schema_name!(ToleranceName, "jurist/tolerance/1");

/// Whether a loop is stable for all values within tolerances.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tolerance {
    /// The kind of document.
    pub schema: ToleranceName,
    /// The model's title; empty where it has none.
    pub title: String,
    /// The kind of time.
    pub time: Time,
    /// The values of the parameters without a tolerance, and of constants that were replaced.
    pub set: Named<Exact>,
    /// The region in which all roots have to lie, where it is smaller than that of plain stability.
    pub region: RegionBound,
    /// How the question is decided, where that was asked for with `--explain`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Box<Plan>>,
    /// What is known.
    #[serde(flatten)]
    pub answer: Answered<ToleranceFound, ToleranceOpen>,
}

/// What is known of a box of tolerances.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToleranceFound {
    /// The closed box: least and greatest value of each name.
    #[serde(rename = "box")]
    pub bounds: Named<[Exact; 2]>,
    /// The names whose ranges do not grow with the factor, where there are any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub for_all: Vec<AllValues>,
    /// `stable` at every point, `not stable` at some, or `null` where neither was proved.
    pub verdict: Option<ToleranceVerdict>,
    /// By how much all tolerances can be scaled; `null` where the nominal point is not stable.
    pub factor: Option<Factor>,
    /// The worst point that was found; `null` where none was.
    pub worst: Option<WorstPoint>,
    /// A point of the box that is not stable, or, where there is none, one just beyond the largest factor.
    pub witness: Option<WitnessPoint>,
    /// How much of the margin each tolerance uses: rounded shares that add up to 1.
    pub shares: Option<Named<serde_json::Number>>,
    /// The range of one parameter that is safe for all values of the others, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<LimitRange>,
    /// Shares of the box's volume, where they were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<VolumeShares>,
    /// The requirements to be met at every point beside stability, where there are any: `verdict`, `factor` and `worst` are those
    /// of stability and all of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementOverBox>,
    /// The number of cells of frequency and parameters in the proof; `null` without one.
    pub cells: Option<usize>,
    /// What stopped the proof, where the verdict is `null`.
    pub undecided: Option<Undecided>,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToleranceOpen {
    /// Not known.
    pub verdict: (),
    /// Not known.
    pub factor: (),
}

/// The verdict on a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ToleranceVerdict {
    /// Stable at every point.
    #[serde(rename = "stable")]
    Stable,
    /// Not stable at some point.
    #[serde(rename = "not stable")]
    NotStable,
}

/// The largest factor of all tolerances that keeps every point stable.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Factor {
    /// Proved: the box of this factor is stable.
    pub lower: Exact,
    /// Not stable: the box of this factor; `null` where no such factor was found.
    pub upper: Option<Exact>,
    /// The lower bound, rounded down to the digits asked for.
    pub decimal: String,
    /// The factor itself as an exact number, where that was proved, else `null`.
    pub exact: Option<End>,
    /// The factor at which the first parameter reaches the end of its domain; `null` where none does.
    pub domain: Option<Exact>,
    /// What ended the proof of a narrower bracket, and in which part of the box; only where the bracket is wider than was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub open: Option<Undecided>,
}

/// The worst point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorstPoint {
    /// Where each parameter is: at the lower end `-`, at the upper end `+`, or `inside`.
    pub signs: Named<String>,
    /// The point at the upper bound of the factor.
    pub point: Named<Exact>,
    /// What happens there, as at the end of a stable interval; `null` where the time did not allow to tell.
    pub cause: Option<String>,
    /// Where the complex pair is.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
    /// The exact factor at which stability is lost on the line from the nominal point to this one: an upper bound.
    pub on_line: Option<End>,
}

/// A point that is not stable.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WitnessPoint {
    /// The values of the parameters.
    pub point: Named<Exact>,
    /// Where the roots are.
    #[serde(flatten)]
    pub roots: RootsByPlace,
}

/// A requirement over the box.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequirementOverBox {
    /// What is required.
    #[serde(flatten)]
    pub asked: RequirementAsked,
    /// Whether it is met at every point; `null` where that was not decided.
    pub met: Option<bool>,
    /// The box of this factor meets it; `null` where the nominal point does not.
    pub lower: Option<Exact>,
    /// The box of this factor does not; `null` where no such factor was found, which is not looked for beyond that of the others.
    pub upper: Option<Exact>,
    /// Whether it is what bounds the factor of the box.
    pub binds: bool,
}

/// Exact shares of the volume of the box; they add up to 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VolumeShares {
    /// Stable at every point.
    pub stable: Exact,
    /// Stable at no point.
    pub unstable: Exact,
    /// Not decided.
    pub undecided: Exact,
    /// The number of boxes that were decided.
    pub boxes: usize,
    /// What ended the subdivision before at most 1 % was undecided; `null` where nothing did.
    pub stopped: Option<String>,
}

/// The range of one parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LimitRange {
    /// The parameter.
    pub parameter: String,
    /// Not safe and safe value on the lower side; the first is `null` where none was found, both where the others' box is not
    /// stable at the nominal value.
    pub lower: [Option<Exact>; 2],
    /// Safe and not safe value on the upper side.
    pub upper: [Option<Exact>; 2],
    /// What happens at either end.
    pub causes: [Option<String>; 2],
    /// A point just beyond either end.
    pub witnesses: [Option<WitnessPoint>; 2],
}

impl Tolerance {
    /// The document, also of an answer that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, answer: Result<&ToleranceAnswer, &Exhausted>, digits: usize) -> Self {
        Tolerance {
            schema: ToleranceName::V1,
            title: title(problem),
            time: problem.time(),
            set: problem.set().into(),
            region: problem.into(),
            plan: Plan::of(problem),
            answer: Answered::of(answer, |answer| found(problem, answer, digits)),
        }
    }
}

impl Document for Answer<ToleranceAnswer> {
    type Json = Tolerance;

    /// The document `jurist/tolerance/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        Tolerance::new(self.problem(), Ok(self.value()), digits)
    }
}

fn named<T, S>(problem: &Problem, values: impl IntoIterator<Item = T>, f: impl Fn(T) -> S) -> Named<S> {
    problem.free().iter().zip(values).map(|(free, value)| (free.name.clone(), f(value))).collect()
}

fn found(problem: &Problem, answer: &ToleranceAnswer, digits: usize) -> ToleranceFound {
    let factor = answer.factor.as_ref();
    let (verdict, cells, own_witness, undecided) = match &answer.decision {
        BoxDecision::Stable(proof) => (Some(ToleranceVerdict::Stable), Some(proof.cells()), None, None),
        BoxDecision::NotStable { witness } => (Some(ToleranceVerdict::NotStable), None, witness.as_ref(), None),
        BoxDecision::Undecided { why, cell } => (None, None, None, Some(ended(problem, *why, cell))),
    };
    let witness = own_witness.or_else(|| factor.and_then(|f| f.witness.as_ref()));
    ToleranceFound {
        bounds: named(problem, &answer.sides, |side| side.at(&Rational::ONE).each_ref().map(Exact::from)),
        for_all: answer.ranges(problem).iter().map(AllValues::from).collect(),
        verdict,
        factor: factor.map(|f| Factor {
            lower: (&f.lower).into(),
            upper: f.upper.as_ref().map(Exact::from),
            decimal: at_most(&f.lower, digits),
            exact: answer.worst.as_ref().zip(answer.exact.as_ref()).map(|(w, exact)| exact_end(w, exact, digits)),
            domain: answer.domain_factor.as_ref().map(Exact::from),
            open: f.open.as_ref().map(|(why, cell)| ended(problem, *why, cell)),
        }),
        worst: factor.and_then(|f| worst(problem, answer, f, digits)),
        witness: witness.map(|w| witness_point(problem, w)),
        shares: answer.shares().map(|shares| {
            let name = |i: usize| problem.free()[i].name.clone();
            let number = |s: &Rational| real::json_number(&to_decimal(s, 17)).unwrap_or_else(|| 0.into());
            shares.iter().map(|(i, share)| (name(*i), number(share))).collect()
        }),
        limit: answer.limit.as_ref().map(|limit| limit_range(problem, limit)),
        requirements: answer.required.iter().enumerate().map(|(k, r)| required(answer, k, r)).collect(),
        volume: answer.volume.as_ref().map(|v| VolumeShares {
            stable: (&v.stable).into(),
            unstable: (&v.unstable).into(),
            undecided: (&v.undecided).into(),
            boxes: v.boxes,
            stopped: v.stopped.as_ref().map(ToString::to_string),
        }),
        cells,
        undecided,
    }
}

/// What ended a proof, and in which cell.
fn ended(problem: &Problem, why: OpenReason, cell: &[[Rational; 2]]) -> Undecided {
    let side = |[low, high]: &[Rational; 2]| format!("{} to {}", to_decimal(low, 6), to_decimal(high, 6));
    let names = problem.free().iter().map(|free| &free.name);
    let reached: Vec<String> = names.zip(cell).map(|(name, c)| format!("{name} from {}", side(c))).collect();
    Undecided { budget: why.to_string(), reached: reached.join(", ") }
}

fn required(answer: &ToleranceAnswer, number: usize, found: &RequiredBox) -> RequirementOverBox {
    RequirementOverBox {
        asked: (&found.requirement).into(),
        met: match &found.decision {
            BoxDecision::Stable(_) => Some(true),
            BoxDecision::NotStable { .. } => Some(false),
            BoxDecision::Undecided { .. } => None,
        },
        lower: found.factor.as_ref().map(|f| Exact::from(&f.lower)),
        upper: found.factor.as_ref().and_then(|f| f.upper.as_ref()).map(Exact::from),
        binds: answer.binding == Some(number),
    }
}

fn end_of(worst: &WorstEnd, digits: usize) -> End {
    End::new(&worst.end, &worst.problem, digits)
}

/// The end of the worst line, or where a parameter is inside of its side the factor at which zeros meet, which is not above it.
fn exact_end(worst: &WorstEnd, exact: &ExactFactor, digits: usize) -> End {
    if worst.end.value.is_same(&exact.value) {
        return end_of(worst, digits);
    }
    let end = jurist_engine::stability::End::new(exact.value.clone(), worst.end.causes.clone(), None);
    End::new(&end, &worst.problem, digits)
}

fn worst(problem: &Problem, answer: &ToleranceAnswer, factor: &LargestFactor, digits: usize) -> Option<WorstPoint> {
    let (direction, upper) = (factor.direction.as_ref()?, factor.upper.as_ref()?);
    let (base, step) = jurist_engine::stability::boxes::ray(&answer.sides, direction);
    let end = answer.worst.as_ref();
    Some(WorstPoint {
        signs: named(problem, direction, |c| sign_name(c).to_owned()),
        point: named(problem, base.iter().zip(&step), |(b, s)| Exact::from(&(b + &(s * upper)))),
        cause: end.map(|w| w.end.causes.to_string()),
        frequency: match end {
            None => FrequencyOfPair::default(),
            Some(w) => FrequencyOfPair::new(digits, |bits| w.problem.frequency(&w.end, bits)),
        },
        on_line: end.map(|w| end_of(w, digits)),
    })
}

fn witness_point(problem: &Problem, witness: &Witness) -> WitnessPoint {
    WitnessPoint {
        point: named(problem, &witness.point, Exact::from),
        roots: RootsByPlace::from(&PointVerdict::of_witness(witness, problem)),
    }
}

fn limit_range(problem: &Problem, limit: &ToleranceLimit) -> LimitRange {
    let [lower, upper] = &limit.sides;
    let safe = |side: &Option<LimitSide>| side.as_ref().map(|s| Exact::from(&s.safe));
    let not_safe = |side: &Option<LimitSide>| side.as_ref().and_then(|s| s.unsafe_at.as_ref().map(Exact::from));
    let cause = |side: &Option<LimitSide>| Some(side.as_ref()?.worst.as_ref()?.end.causes.to_string());
    let witness = |side: &Option<LimitSide>| Some(witness_point(problem, side.as_ref()?.factor.witness.as_ref()?));
    LimitRange {
        parameter: limit.parameter.clone(),
        lower: [not_safe(lower), safe(lower)],
        upper: [safe(upper), not_safe(upper)],
        causes: [cause(lower), cause(upper)],
        witnesses: [witness(lower), witness(upper)],
    }
}
