//! All that is required of a loop: by its model file, and by who asks.

use super::requirement::{Meaning, Requirement, RequirementKind, Written, not_understood};
use crate::error::{Code, Diagnostic, Diagnostics, Error, Source, Span};
use crate::model::{Expression, Model, RequirementText};
use crate::problem::Region;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// What is required beyond stability: a smaller region for all roots, and requirements on margins at a cut.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::Requirements;
/// let text = "time = 'continuous'\n[parameters]\nK = 2\n[loop]\ncharacteristic = 's^2 + 4*s + K'\n\
///             [require]\nsettling_time = 8\ndamping = 0.5\n";
/// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
/// let problem = model.ask().problem().unwrap();
/// let asked = Requirements::of(&model, &[], problem.set(), &Budget::unlimited()).unwrap();
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

/// One requirement as a text, and where it stands in the model file.
struct Asked<'a> {
    text: &'a str,
    place: Option<Span>,
}

impl Requirements {
    /// What the section `[require]` and further requirements, by their names and texts, ask for together; of two with the same
    /// name the further one counts. Numbers may be expressions in the model's names, which have these values.
    ///
    /// A settling time is a decay rate of at least 4 over it in continuous time; in discrete time all roots have a modulus
    /// of at most `exp(-4 T/time)`, `T` the sample time.
    ///
    /// Cost: that of [`Model::value`] for each.
    ///
    /// # Errors
    /// `E-require` for each name or number that is no requirement; as [`Model::value`].
    pub fn of(
        model: &Model,
        further: &[(&str, &str)],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Requirements, Error> {
        of_sections(model, model.require(), further, values, budget)
    }

    /// The same without what the section `[require]` asks for.
    ///
    /// Cost: that of [`Requirements::of`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::response::Requirements;
    /// let text = "time = 'continuous'\nparameters.K = 2\nloop.characteristic = 's^2 + 4*s + K'\nrequire.damping = 0.5\n";
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// assert!(Requirements::without_section(&model, &[], &[], &Budget::unlimited())?.is_empty());
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Requirements::of`].
    pub fn without_section(
        model: &Model,
        further: &[(&str, &str)],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Requirements, Error> {
        of_sections(model, &[], further, values, budget)
    }
}

/// The requirements of a section and further ones.
fn of_sections(
    model: &Model,
    section: &[RequirementText],
    further: &[(&str, &str)],
    values: &[(String, Rational)],
    budget: &Budget,
) -> Result<Requirements, Error> {
    let of = |name: &str| -> Option<Asked<'_>> {
        let option = further.iter().find(|(n, _)| *n == name).map(|(_, text)| Asked { text, place: None });
        let written = || section.iter().find(|r| r.name == name);
        option.or_else(|| written().map(|r| Asked { text: &r.text, place: Some(r.span) }))
    };
    let mut out = Requirements { at: of("at").map(|a| a.text.to_owned()), ..Requirements::default() };
    let mut wrong: Vec<Diagnostic> = Vec::new();
    for kind in RequirementKind::all() {
        let Some(asked) = of(kind.name) else { continue };
        let meaning = meaning(model, kind, asked.text, out.region.as_ref(), values, budget);
        // What is wrong with the constants at these values has its place in the model.
        let is_own = || model.value(&Expression::number(0), values, budget).is_ok();
        match meaning.map_err(|error| if is_own() { placed(model, error, kind, &asked) } else { error }) {
            Ok(Meaning::Requirement(requirement)) => out.list.push(requirement),
            Ok(Meaning::Region(region)) => {
                out.region = Some(region);
                out.regional.push((kind.name.to_owned(), asked.text.to_owned()));
            }
            Err(Error::Refused(refused)) if asked.place.is_some() => wrong.extend_from_slice(refused.diagnostics()),
            Err(other) => return Err(other),
        }
    }
    wrong.sort_by_key(|one| one.primary.as_ref().map(|label| label.span.start));
    wrong.dedup();
    match wrong.is_empty() {
        true => Ok(out),
        false => Err(Diagnostics::new(Some(model.source().clone()), wrong).into()),
    }
}

fn meaning(
    model: &Model,
    kind: &RequirementKind,
    text: &str,
    region: Option<&Region>,
    values: &[(String, Rational)],
    budget: &Budget,
) -> Result<Meaning, Error> {
    let (number, unit) = kind.split(text);
    let needed = if kind.needs_unit() { "a number with its unit is needed" } else { "a number is needed" };
    let expression = Expression::parse(number).map_err(|_| {
        let message = format!("{}: {needed}", kind.name);
        Diagnostic::error(Code::Require, message).help(kind.about)
    })?;
    let value = model.value(&expression, values, budget).map_err(|error| match error {
        Error::Undefined(_) => not_understood(kind.name, "a number is needed, without parameters that have no value"),
        other => other,
    })?;
    let sample_time = || model.sample_time_expression().map(|step| model.value(step, values, budget)).transpose();
    kind.meaning(&Written { value, unit, time: model.time(), region, sample_time: &sample_time, budget })
}

/// The error with its place: the value in the model file, or the text of an option.
fn placed(model: &Model, error: Error, kind: &RequirementKind, asked: &Asked<'_>) -> Error {
    let Error::Refused(refused) = error else { return error };
    let diagnostics = refused.diagnostics().iter().cloned();
    let Some(span) = asked.place else {
        let source = Source::new(kind.name, kind.split(asked.text).0);
        return Diagnostics::new(Some(source), diagnostics.collect()).into();
    };
    // Places in the number's own text are not places in the file.
    let placed = diagnostics.map(|d| {
        let label = d.primary.as_ref().map_or_else(|| "required here".to_owned(), |label| label.text.clone());
        d.without_places().at(span, label)
    });
    Diagnostics::new(Some(model.source().clone()), placed.collect()).into()
}
