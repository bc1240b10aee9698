//! The document `jurist/tune/1`.

use crate::answer::{Best, Optimum, Outcome, Place, TuneAnswer};
use crate::reading::Reading;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_show::documents::{AllValues, Enclosure, Exact, Named, Number, PointQuestion, RequirementFound, Undecided};
use serde::{Deserialize, Serialize};

/// `jurist/tune/1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum TuneName {
    /// The first version.
    #[default]
    #[serde(rename = "jurist/tune/1")]
    V1,
}

/// The best gains of a loop, or that there are none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tune {
    /// The kind of document.
    pub schema: TuneName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The gains that are free.
    pub free: Vec<String>,
    /// What is to be best: `max ki`, `min radius`, `none`.
    pub objective: String,
    /// What is required, in words.
    pub require: Vec<String>,
    /// Names of the plant for all of whose values, from one to another, gains are to be good.
    pub for_all: Vec<AllValues>,
    /// Whether some gains meet what is required; `null` where it is open.
    pub feasible: Option<bool>,
    /// The best value; `null` where nothing was to be best, and where there are no gains.
    pub optimum: Option<OptimumFound>,
    /// Gains that meet what is required; `null` where there are none.
    pub found: Option<PointFound>,
    /// No gains have this value of the objective, or a better one, rounded away from the best one; where it is open whether there are any gains, none have a
    /// better one. `null` where the optimum is exact or without end.
    pub proved: Option<String>,
    /// So many boxes of gains prove the bracket, or that no gains meet what is required; `null` where sets or maps do.
    pub cells: Option<u64>,
    /// The gains that are typed in; `null` where there are none.
    pub rounded: Option<Named<Exact>>,
    /// What these lose of the best value, in per cent; `null` where it is not a number.
    pub loss_percent: Option<String>,
    /// The requirements at the gains that are typed in.
    pub requirements: Vec<RequirementFound>,
    /// Requirements and bounds that exclude each other.
    pub conflict: Vec<String>,
    /// Why something is not decided; `null` where everything is.
    pub undecided: Option<Undecided>,
}

/// A best value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OptimumFound {
    /// The value, exactly: of a gain, or of the number of the loop in its scale; `null` of a bracket, and where it grows without end.
    pub value: Option<Number>,
    /// The same as a decimal in the unit of the number of the loop: degrees of a phase margin; `null` of a bracket, and where it grows without end.
    pub decimal: Option<String>,
    /// Whether it grows without end, or nothing limits it, as a delay margin of a loop that bears any delay.
    pub unbounded: bool,
    /// The gains there; `null` where one grows without end.
    pub at: Named<Option<PlaceFound>>,
    /// Whether gains have the best value; they come as near as you like else. `null` where that is not known.
    pub attained: Option<bool>,
    /// What binds, in order: names of requirements and of the number that is best, causes of the end of stability, each an entry of its own (`s=0`, `domain`), `bound of NAME`.
    pub binding: Vec<String>,
}

/// The value of a gain at the optimum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlaceFound {
    /// The value, exactly; `null` where it is known between two numbers only.
    pub value: Option<Number>,
    /// Two numbers between which it lies.
    pub enclosure: Enclosure,
}

/// Gains that meet what is required.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PointFound {
    /// The gains.
    pub point: Named<Exact>,
    /// They have at least this of the objective, rounded; `null` where nothing was to be best, and where nothing limits it.
    pub value: Option<String>,
}

impl TuneAnswer {
    /// No gains have this value, or a better one.
    fn proved(&self) -> Option<&Rational> {
        match &self.outcome {
            Outcome::Optimum(optimum) => match &optimum.value {
                Best::Between([_, proved]) => Some(proved),
                _ => None,
            },
            Outcome::Open { proved, .. } => proved.as_ref(),
            Outcome::Infeasible { .. } => None,
        }
    }

    /// The document, with so many digits of decimals.
    pub fn json(&self, digits: usize) -> Tune {
        let asked = &self.asked;
        let optimum = match &self.outcome {
            Outcome::Optimum(optimum) => Some(optimum.as_ref()),
            _ => None,
        };
        let named = |values: &[Rational]| -> Named<Exact> {
            let pairs = asked.gains.iter().map(|gain| gain.name.clone()).zip(values.iter().cloned());
            pairs.collect::<Vec<_>>().as_slice().into()
        };
        let typed = optimum.and_then(|optimum| optimum.typed.as_ref());
        let reading = Reading::of(asked);
        Tune {
            schema: TuneName::V1,
            question: PointQuestion::new(&self.problem),
            free: asked.gains.iter().map(|gain| gain.name.clone()).collect(),
            objective: asked.objective_text(),
            require: self.required(),
            for_all: asked.for_all.iter().map(AllValues::from).collect(),
            feasible: self.is_feasible(),
            optimum: optimum.filter(|o| !matches!(o.value, Best::Nothing)).map(|o| self.optimum(o, digits)),
            found: optimum.map(|optimum| PointFound {
                point: named(&optimum.found),
                value: optimum.found_value.as_ref().map(|x| number_text(&reading, x, digits)),
            }),
            proved: self.proved().map(|x| number_text(&reading, x, digits)),
            cells: self.cells().map(|cells| cells as u64),
            rounded: typed.map(|typed| named(&typed.values)),
            loss_percent: optimum.and_then(|optimum| self.lost(optimum)),
            requirements: typed
                .map(|typed| typed.requirements.iter().map(|found| RequirementFound::new(found, digits)).collect())
                .unwrap_or_default(),
            conflict: match &self.outcome {
                Outcome::Infeasible { conflict, .. } => conflict.clone(),
                _ => Vec::new(),
            },
            undecided: self.stopped().map(Into::into),
        }
    }

    fn optimum(&self, optimum: &Optimum, digits: usize) -> OptimumFound {
        let reading = Reading::of(&self.asked);
        let value = match &optimum.value {
            Best::Exact(value) => Some(value),
            _ => None,
        };
        let place = |place: &Place| match place {
            Place::Exact(x) => {
                let (low, high) = x.refined_to_digits(digits).enclosure();
                Some(PlaceFound { value: Some(Number::new(x, digits)), enclosure: [(&low).into(), (&high).into()] })
            }
            Place::Between([low, high]) => Some(PlaceFound { value: None, enclosure: [low.into(), high.into()] }),
            Place::From((Some(low), Some(high))) => {
                Some(PlaceFound { value: None, enclosure: [low.into(), high.into()] })
            }
            Place::From(_) | Place::Unbounded => None,
        };
        let names = self.asked.gains.iter().map(|gain| gain.name.clone());
        OptimumFound {
            value: value.filter(|_| reading.is_its_own_scale()).map(|value| Number::new(value, digits)),
            decimal: match &optimum.value {
                Best::Zero => Some("0".to_owned()),
                _ => value.map(|value| reading.shown(value, digits)),
            },
            unbounded: matches!(optimum.value, Best::Unbounded),
            at: names.zip(optimum.at.iter().map(place)).collect(),
            attained: optimum.attained,
            binding: optimum.binding.clone(),
        }
    }
}

fn number_text(reading: &Reading, x: &Rational, digits: usize) -> String {
    reading.shown(&Real::from(x.clone()), digits)
}

/// JSON Schemas of these documents: kind with version, and schema.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, serde_json::Value)> {
    use jurist_show::documents::schemas::schema_of;
    let name = "jurist/tune/1";
    vec![(name, schema_of::<Tune>(name))]
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    #[test]
    fn the_schemas_that_are_published_are_those_of_the_types() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema");
        jurist_show::documents::schemas::check_published(&folder, &super::schemas());
    }
}
