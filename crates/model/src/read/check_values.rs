//! Whether the values of a model make sense: divisors that are identically zero, algebraic loops, a
//! sample time that is not positive.

use super::reader::Reader;
use crate::connect::state_space::{Connecting, assemble};
use crate::definition::Model;
use crate::error::{Code, Diagnostic};
use crate::evaluate::scalar::{Scope, Symbol};
use crate::evaluate::symbolic::symbolic;
use crate::evaluate::values::Wiring;
use crate::evaluate::walk::Failure;
use crate::text::names::shorten;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::RationalFunction;
use std::collections::HashSet;

/// Units of work that one evaluation for the check may take: about a second on an idle machine. It is counted, not
/// timed, so that the same text is accepted or refused everywhere; what is not found within it shows when a question
/// is asked.
const CHECK_WORK: u64 = 100_000_000;

/// Evaluates everything with numbers for the parameters. What is not zero at one point is not
/// identically zero, so this acquits; what looks wrong there is evaluated again with symbols.
pub(super) fn values(model: &Model, reader: &mut Reader) {
    for attempt in 0..3u64 {
        let mut position = 0;
        let mut symbol = |_: &str, constant: bool| {
            position += 1;
            (!constant).then(|| Symbol::Value(probe(attempt, position)))
        };
        let Some(found) = problems(model, &mut symbol) else { return };
        if found.is_empty() {
            return;
        }
    }
    let found = problems(model, &mut |_, constant| (!constant).then_some(Symbol::Variable));
    found.into_iter().flatten().for_each(|d| reader.report(d));
}

/// Refuses a sample time that is not positive whatever the parameters are.
pub(super) fn sample_time(model: &Model, reader: &mut Reader) {
    let Some(e) = &model.sample_time else { return };
    let mut needed: HashSet<&str> = e.names().into_iter().collect();
    for constant in model.ordered_constants().collect::<Vec<_>>().into_iter().rev() {
        if needed.contains(constant.name.as_str()) {
            needed.extend(constant.expression.names());
        }
    }
    if model.parameters.iter().any(|p| needed.contains(p.name.as_str())) {
        return;
    }
    let budget = Budget::with_work(CHECK_WORK);
    let constants = model.ordered_constants().filter(|c| needed.contains(c.name.as_str()));
    let value = budget.enter(|| {
        let mut scope = Scope::new(std::iter::empty(), constants, |_, _| None, &budget, &mut |_| {});
        scope.scalar(e).ok()?.as_constant()
    });
    // Whatever else is wrong with it has been reported with the other values.
    if let Ok(Some(value)) = value
        && !value.sign().is_gt()
    {
        let error = Diagnostic::error(Code::Value, "the sample time must be positive");
        reader.report(error.at(e.span, format!("this is {}", shorten(&value.to_string()))));
    }
}

/// A number that no formula expects.
fn probe(attempt: u64, position: u64) -> Rational {
    let mixed = (attempt * 1_000_003 + position).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
    Rational::new(Integer::from(mixed + 1009), Integer::from(7919 + 2 * attempt))
}

/// Everything that is wrong with the values; `None` when that takes too much work to find.
fn problems(model: &Model, symbol: &mut dyn FnMut(&str, bool) -> Option<Symbol>) -> Option<Vec<Diagnostic>> {
    let budget = Budget::with_work(CHECK_WORK);
    let mut found = Vec::new();
    let mut is_exhausted = false;
    let mut report = |failure| match failure {
        // A time of the loop is looked at once for each block that uses it.
        Failure::Wrong(diagnostic) if found.contains(&*diagnostic) => {}
        Failure::Wrong(diagnostic) => found.push(*diagnostic),
        Failure::Exhausted(_) => is_exhausted = true,
        Failure::Poisoned => {}
    };
    let left = budget.enter(|| {
        let mut scope = Scope::new(model.parameters.iter(), model.ordered_constants(), symbol, &budget, &mut report);
        let mut wiring = Wiring::of(model);
        let form = symbolic(model, &mut wiring, &mut scope, &mut report);
        let set = |f: &RationalFunction| Some(f.clone());
        let how = Connecting { set: &set, symbols: None, start: None, budget: &budget };
        if let Some(form) = form
            && let Err(stop) = assemble(model, &wiring, &form, &how)
        {
            report(stop.into());
        }
    });
    let is_exhausted = is_exhausted || left.is_err() || budget.check().is_err();
    if is_exhausted && found.is_empty() { None } else { Some(found) }
}
