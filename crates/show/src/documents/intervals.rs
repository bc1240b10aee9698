//! The document `jurist/intervals/1`.

use super::number::{Exact, Number};
use super::schema_name;
use super::{AllValues, Answered, Bounds, End, ParameterQuestion, RequirementAsked};
use crate::{Document, real};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, Sensitivities, Sensitivity};
use jurist_engine::problem::Problem;
use jurist_engine::stability::{StableSet, UndecidedBracket};
use serde::{Deserialize, Serialize};

schema_name!(IntervalsName, "jurist/intervals/1");

/// The exact stable set of one parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Intervals {
    /// The kind of document.
    pub schema: IntervalsName,
    /// What was asked.
    #[serde(flatten)]
    pub question: ParameterQuestion,
    /// What is required beyond stability; left out where nothing is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub require: Vec<RequirementAsked>,
    /// The set.
    #[serde(flatten)]
    pub answer: Answered<Stable, IntervalsOpen>,
    /// Other names, for all of whose values in these ranges it holds; left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub for_all: Vec<AllValues>,
    /// How the limits move with the other names, where it was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<SensitivityFound>,
}

/// How one limit moves with one name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SensitivityFound {
    /// The limit, rounded as in `stable`.
    pub limit: String,
    /// The parameter or constant.
    pub name: String,
    /// Its value.
    pub value: Exact,
    /// The derivative of the limit; `null` where it has none, or the name is inside of a function.
    pub derivative: Option<Number>,
    /// The derivative times the value over the limit; `null` also at a limit of 0.
    pub relative: Option<Number>,
}

impl SensitivityFound {
    fn new(row: &Sensitivity, digits: usize) -> Self {
        let number = |x: &Option<Real>| x.as_ref().map(|x| Number::new(x, digits));
        SensitivityFound {
            limit: real::rounded(&row.limit, digits).decimal,
            name: row.name.clone(),
            value: Exact::from(&row.value),
            derivative: number(&row.derivative),
            relative: number(&row.relative),
        }
    }
}

/// The answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Stable {
    /// The stable set as intervals in ascending order; two that touch share an end that is not stable. Empty: never stable.
    pub stable: Vec<Bounds<End>>,
    /// Where nothing is known, in ascending order; what lies between is decided.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undecided: Vec<UndecidedEnclosure>,
}

/// A bracket in which nothing is known.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UndecidedEnclosure {
    /// Its ends; null where there is none.
    pub enclosure: [Option<Exact>; 2],
    /// What could not be told.
    pub why: String,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct IntervalsOpen {
    /// Not known.
    pub stable: (),
}

impl Intervals {
    /// Of a set that meets requirements.
    pub(super) fn of_bounds(
        question: ParameterQuestion,
        stable: Vec<Bounds<End>>,
        undecided: &[UndecidedBracket],
        require: Vec<RequirementAsked>,
    ) -> Self {
        let undecided = undecided.iter().map(UndecidedEnclosure::from).collect();
        let answer = Answered::Known(Stable { stable, undecided });
        Intervals { schema: IntervalsName::V1, question, require, answer, for_all: Vec::new(), sensitivity: Vec::new() }
    }

    /// The document, also of an answer that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, set: Result<&StableSet, &Exhausted>, digits: usize) -> Self {
        Intervals {
            schema: IntervalsName::V1,
            question: ParameterQuestion::new(problem),
            require: Vec::new(),
            answer: Answered::of(set, |set| Stable {
                stable: End::intervals(set, problem, digits),
                undecided: set.undecided().iter().map(UndecidedEnclosure::from).collect(),
            }),
            for_all: Vec::new(),
            sensitivity: Vec::new(),
        }
    }

    /// With how the limits move.
    pub fn with_sensitivities(mut self, table: &Sensitivities, digits: usize) -> Self {
        self.sensitivity = table.rows.iter().map(|row| SensitivityFound::new(row, digits)).collect();
        self
    }
}

impl From<&UndecidedBracket> for UndecidedEnclosure {
    fn from(bracket: &UndecidedBracket) -> Self {
        let end = |x: &Option<Rational>| x.as_ref().map(Exact::from);
        UndecidedEnclosure { enclosure: [end(&bracket.lower), end(&bracket.upper)], why: bracket.why.clone() }
    }
}

impl Document for Answer<StableSet> {
    type Json = Intervals;

    /// The document `jurist/intervals/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        Intervals::new(self.problem(), Ok(self.value()), digits)
    }
}
