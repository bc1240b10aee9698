//! The model that is being asked about, read once, and the questions that are asked of it again and again.

use jurist::{Ask, Code, Diagnostic, Diagnostics, Error, Model, Problem, Question, Rational, parse_number};
use std::cell::RefCell;
use std::sync::Arc;

/// The name that the page's text has in messages.
pub(crate) const NAME: &str = "model.toml";

/// Problems that are kept: the free parameters of a model, and a map.
const KEPT: usize = 12;

/// The model that was read last, and problems of it.
struct Kept {
    text: String,
    model: Model,
    warnings: Vec<Diagnostic>,
    problems: Vec<(String, Arc<Problem>)>,
}

thread_local! {
    static KEPT_MODEL: RefCell<Option<Kept>> = const { RefCell::new(None) };
}

/// The model of a text, and the remarks on it.
pub(crate) fn read(text: &str) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
    let known = KEPT_MODEL.with_borrow(|kept| {
        kept.as_ref().filter(|kept| kept.text == text).map(|kept| (kept.model.clone(), kept.warnings.clone()))
    });
    if let Some(known) = known {
        return Ok(known);
    }
    let (model, warnings) = Model::from_bytes(NAME, text.as_bytes())?;
    let kept = Kept { text: text.to_owned(), model: model.clone(), warnings: warnings.clone(), problems: Vec::new() };
    KEPT_MODEL.set(Some(kept));
    Ok((model, warnings))
}

/// A question about a text: names with their values as they are written, what is free.
pub(crate) fn problem(text: &str, set: &[(String, String)], free: &[&str]) -> Result<Arc<Problem>, Error> {
    let (model, _) = read(text)?;
    let key = format!("{free:?} {set:?}");
    let known = KEPT_MODEL.with_borrow(|kept| {
        let kept = kept.as_ref()?;
        kept.problems.iter().find(|(k, _)| *k == key).map(|(_, problem)| Arc::clone(problem))
    });
    if let Some(known) = known {
        return Ok(known);
    }
    let mut question: Question = model.ask();
    for (name, value) in set.iter().filter(|(name, _)| !free.contains(&name.as_str())) {
        question = question.set(name, number(value)?);
    }
    for name in free {
        question = question.free(*name);
    }
    let problem = if free.len() == 2 { question.plane_problem()? } else { question.problem()? };
    KEPT_MODEL.with_borrow_mut(|kept| {
        if let Some(kept) = kept {
            kept.problems.truncate(KEPT - 1);
            kept.problems.insert(0, (key, Arc::clone(&problem)));
        }
    });
    Ok(problem)
}

/// A number as it is written in a box: `110`, `1e-4`, `1/3`.
pub(crate) fn number(text: &str) -> Result<Rational, Error> {
    parse_number(text.trim()).map_err(|error| {
        let message = format!("'{}' is not a number: {error}", text.chars().take(40).collect::<String>());
        Diagnostic::error(Code::Number, message).help("a number such as 110, 1e-4 or 1/3").into()
    })
}
