//! All that is required of a loop: by its model file, and by who asks.

use super::Requirement;
use crate::error::{Code, Diagnostic, Diagnostics, Error, Span};
use crate::model::{Expression, Model, Time};
use crate::problem::{Bound, Region};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// What is required beyond stability: a smaller region for all roots, and requirements on margins at a cut.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// let text = "time = 'continuous'\n[parameters]\nK = 2\n[loop]\ncharacteristic = 's^2 + 4*s + K'\n\
///             [require]\nsettling_time = 8\ndamping = 0.5\n";
/// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
/// let problem = model.ask().problem().unwrap();
/// let asked = model.requirements(&[], problem.set(), &Budget::unlimited()).unwrap();
/// assert_eq!(asked.list[0].name(), "damping");
/// assert_eq!(asked.region.unwrap().decay().unwrap().to_string(), "1/2"); // 4 over the settling time
/// # Ok::<(), jurist_engine::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Requirements {
    /// On margins and damping, in a fixed order.
    pub list: Vec<Requirement>,
    /// The region in which all roots have to lie, if one is asked for.
    pub region: Option<Region>,
    /// Names and texts of the requirements that the region meets.
    pub regional: Vec<(String, String)>,
    /// Where margins are taken.
    pub at: Option<String>,
}

impl Requirements {
    /// Whether nothing is required.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty() && self.region.is_none()
    }
}

/// The keys of requirements on numbers, in the order in which they are listed.
const ORDER: [&str; 8] =
    ["gain_margin", "phase_margin", "modulus_margin", "delay_margin", "damping", "decay", "radius", "settling_time"];

/// One requirement as a text, and where it stands in the model file.
struct Asked<'a> {
    text: &'a str,
    place: Option<Span>,
}

impl Model {
    /// What the section `[require]` and further requirements, by their names and texts, ask for together; of two with the same
    /// name the further one counts. Numbers may be expressions in the model's names, which have these values.
    ///
    /// A settling time is a decay rate of at least 4 over it in continuous time; in discrete time all roots have a modulus
    /// of at most `exp(-4 T/time)`, `T` the sample time.
    ///
    /// Cost: that of [`Model::value`] for each.
    ///
    /// # Errors
    /// `E-require` for a name or a number that is no requirement; as [`Model::value`].
    pub fn requirements(
        &self,
        further: &[(&str, &str)],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Requirements, Error> {
        let of = |name: &str| -> Option<Asked<'_>> {
            let option = further.iter().find(|(n, _)| *n == name).map(|(_, text)| Asked { text, place: None });
            let written = || self.require().iter().find(|r| r.name == name);
            option.or_else(|| written().map(|r| Asked { text: &r.text, place: Some(r.span) }))
        };
        let mut out = Requirements { at: of("at").map(|a| a.text.to_owned()), ..Requirements::default() };
        for name in ORDER {
            let Some(asked) = of(name) else { continue };
            let known = out.list.len();
            self.add(&mut out, name, asked.text, values, budget).map_err(|error| self.placed(error, asked.place))?;
            if out.list.len() == known {
                out.regional.push((name.to_owned(), asked.text.to_owned()));
            }
        }
        Ok(out)
    }

    fn add(
        &self,
        out: &mut Requirements,
        name: &str,
        text: &str,
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<(), Error> {
        let (number, unit) = without_unit(name, text);
        let expression =
            Expression::parse(number).map_err(|_| not_understood(name, "a number with its unit is needed"))?;
        let value = self.value(&expression, values, budget)?;
        match (name, self.time()) {
            ("gain_margin", _) if unit.is_some() => {
                out.list.push(Requirement::gain_margin_in_decibels(&value, budget)?);
            }
            ("gain_margin", _) => out.list.push(Requirement::gain_margin(&value)?),
            ("phase_margin", _) => out.list.push(Requirement::phase_margin(&value)?),
            ("modulus_margin", _) => out.list.push(Requirement::modulus_margin(value)?),
            ("delay_margin", _) => out.list.push(Requirement::delay_margin(value)?),
            ("damping", _) => out.list.push(Requirement::damping(value)?),
            ("radius", Time::Discrete) => out.region = Some(Region::disc(value)?),
            ("decay", Time::Continuous) => out.region = Some(Region::half_plane(value)),
            ("radius", _) => return Err(not_understood(name, "a radius is required of discrete loops")),
            ("decay", _) => return Err(not_understood(name, "a decay rate is required of continuous loops")),
            ("settling_time", time) => {
                if !value.sign().is_gt() {
                    return Err(not_understood(name, "a settling time is above 0"));
                }
                let rate = Rational::from(4).checked_div(&value).expect("positive");
                match time {
                    Time::Continuous => {
                        let least = match out.region.as_ref().map(Region::bound) {
                            Some(Bound::Number(decay)) => decay.clone().max(rate),
                            _ => rate,
                        };
                        out.region = Some(Region::half_plane(least));
                    }
                    Time::Discrete => {
                        let Some(step) = self.sample_time_expression() else {
                            return Err(not_understood(name, "a settling time needs the loop's sample time"));
                        };
                        let step = self.value(step, values, budget)?;
                        out.list.push(Requirement::settling_time(value, &step)?);
                    }
                }
            }
            _ => return Err(not_understood(name, "not known")),
        }
        Ok(())
    }

    /// The error with its place in the model file.
    fn placed(&self, error: Error, place: Option<Span>) -> Error {
        match (error, place) {
            (Error::Refused(refused), Some(span)) => {
                let placed = refused.diagnostics().iter().cloned().map(|d| match d.primary.is_some() {
                    true => d,
                    false => d.at(span, "required here"),
                });
                Diagnostics::new(Some(self.source().clone()), placed.collect()).into()
            }
            (error, _) => error,
        }
    }
}

fn not_understood(name: &str, why: &str) -> Error {
    Diagnostic::error(Code::Require, format!("{name}: {why}")).into()
}

/// The number of a text, and its unit: decibels. Degrees are those of a number without unit.
fn without_unit<'t>(name: &str, text: &'t str) -> (&'t str, Option<&'static str>) {
    let text = text.trim();
    let units: &[&'static str] = match name {
        "gain_margin" => &["dB"],
        "phase_margin" => &["degrees", "deg", "°"],
        _ => &[],
    };
    match units.iter().find_map(|unit| Some((text.strip_suffix(unit)?.trim_end(), *unit))) {
        Some((number, "dB")) => (number, Some("dB")),
        Some((number, _)) => (number, None),
        None => (text, None),
    }
}
