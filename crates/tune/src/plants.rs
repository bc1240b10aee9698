//! The names of the plant with their ranges, for all values of which gains are to be good.

use crate::asked::Gain;
use jurist_engine::answer::ToleranceRequest;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::problem::Question;
use jurist_engine::response::AllOf;

/// The ranges that are given, and behind them those of the names with a tolerance, where that is asked for; gains have none.
///
/// ```
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_tune::{asked::Gain, plants::plants};
/// let text = "time = 'continuous'\nparameters = { K = 1, a = { nominal = 2, tolerance = '10%' } }\nloop.characteristic = 's + a*K'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let all = plants(&model.ask(), &[Gain::new("K")], Vec::new(), true)?;
/// assert_eq!((all[0].name.as_str(), all[0].range[0].to_string()), ("a", "9/5".to_owned()));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
///
/// # Errors
/// `E-no-value` for a tolerance of a name without a value, `E-tolerance` where no name has one.
pub fn plants(question: &Question, gains: &[Gain], given: Vec<AllOf>, robust: bool) -> Result<Vec<AllOf>, Error> {
    let mut all = given;
    if !robust {
        return Ok(all);
    }
    for (name, tolerance) in ToleranceRequest::of_model(question.model()).tolerances {
        if gains.iter().any(|gain| gain.name == name) || all.iter().any(|known| known.name == name) {
            continue;
        }
        let set = question.values_set().get(&name).cloned();
        let number = question.model().constant(&name).and_then(|constant| constant.number.clone());
        let nominal = set.or(number).map_or_else(|| question.nominal(&name), |value| Ok(Some(value)))?;
        let Some(nominal) = nominal else {
            let error = Diagnostic::error(Code::NoValue, format!("'{name}' has a tolerance and no value"));
            return Err(error.help(format!("give it one: --set {name}=VALUE")).into());
        };
        let [below, above] = tolerance.widths(&nominal).map_err(|why| {
            Error::from(Diagnostic::error(Code::Tolerance, format!("the tolerance of '{name}': {why}")))
        })?;
        all.extend(AllOf::new(name, &nominal - below, &nominal + above));
    }
    if all.is_empty() {
        let error = Diagnostic::error(Code::Tolerance, "no name beside the gains has a tolerance");
        return Err(error.help("give tolerances in the model, or ranges: --for-all NAME=LO..HI").into());
    }
    Ok(all)
}

/// The same as the section `[tune]` of the model asks for it.
///
/// # Errors
/// As [`plants`]; `E-tune-bounds` for a range that is no interval.
pub fn plants_of_model(question: &Question, gains: &[Gain]) -> Result<Vec<AllOf>, Error> {
    let Some(tuning) = question.model().tuning() else { return Ok(Vec::new()) };
    let mut given = Vec::new();
    for (name, [low, high]) in &tuning.for_all {
        if gains.iter().any(|gain| gain.name == name.name) {
            continue;
        }
        let Some(all) = AllOf::new(&name.name, low.clone(), high.clone()) else {
            let message = format!("the range of '{}' is no interval: {low} is not below {high}", name.name);
            let error = Diagnostic::error(Code::TuneBounds, message);
            return Err(error.help("write the lower one first").into());
        };
        given.push(all);
    }
    plants(question, gains, given, tuning.robust)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_engine::error::Source;
    use jurist_engine::model::Model;
    use jurist_engine::problem::Ask;

    /// Its value was looked for among the parameters alone.
    #[test]
    fn a_constant_with_a_tolerance_has_a_value() {
        let text = "time = 'continuous'\nconstants = { a = { value = 2, tolerance = '10%' } }\nparameters = { K = 1 }\n\
            loop.characteristic = 's + a*K'\n";
        let (model, _) = Model::from_toml(&Source::new("loop.toml", text)).unwrap();
        let range = |question| {
            let all = plants(&question, &[Gain::new("K")], Vec::new(), true).unwrap();
            all[0].range.each_ref().map(ToString::to_string)
        };
        assert_eq!(range(model.ask()), ["9/5", "11/5"]);
        assert_eq!(range(model.ask().set("a", 20)), ["18", "22"]);
    }
}
