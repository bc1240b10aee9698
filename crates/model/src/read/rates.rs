//! `every`, `phase` and `sample_time` of blocks that are slower than the loop.

use super::check_holds::is_held;
use super::reader::Reader;
use crate::definition::{Form, Model, Rate, Time};
use crate::error::{Code, Diagnostic, Span};
use crate::evaluate::scalar::{Scope, Symbol};
use crate::text::Expression;
use crate::text::names::shorten;
use crate::text::toml_value::Table;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// A hyperperiod of more samples is refused.
const MAX_STEPS: u64 = 100_000;

/// Units of work that the comparison of sample times may take.
const COMPARISON_WORK: u64 = 10_000_000;

fn wrong(message: String, span: Span, label: &str) -> Diagnostic {
    Diagnostic::error(Code::Rate, message).at(span, label)
}

/// The rate of a block, and its own sample time where that stands for it.
pub(super) fn rate(table: &Table, name: &str, time: Time, reader: &mut Reader) -> (Rate, Option<Expression>) {
    let keys = ["every", "phase", "sample_time"];
    let Some(first) = keys.iter().find_map(|key| table.entry(key)) else { return Default::default() };
    if time == Time::Continuous {
        reader.report(wrong("a continuous loop has no samples".into(), first.key_span, "time = \"continuous\""));
        return Default::default();
    }
    let own = table.get("sample_time").and_then(|v| reader.expression(v, "'sample_time'"));
    if let (Some(every), Some(own)) = (table.entry("every"), table.entry("sample_time")) {
        let error = wrong(format!("the rate of '{}' is given twice", shorten(name)), own.key_span, "given here");
        reader.report(error.also(every.key_span, "and here").help("leave one of them out"));
    }
    let mut whole = |key: &str, least: i64, what: &str| -> Option<u64> {
        let value = table.get(key)?;
        let number = reader.number(value, &format!("'{key}'"))?;
        let found = number.is_integer().then(|| number.numerator().to_i64()).flatten().filter(|k| *k >= least);
        if found.is_none() {
            let message = format!("'{key}' of '{}' is {what}", shorten(name));
            reader.report(wrong(message, value.span, &format!("this is {}", shorten(&number.to_string()))));
        }
        found.and_then(|k| u64::try_from(k).ok())
    };
    let every = whole("every", 1, "a whole number of samples, from 1");
    let phase = whole("phase", 0, "a whole number of samples, from 0");
    let rate = Rate { every: every.unwrap_or(1), phase: phase.unwrap_or(0) };
    (rate, own)
}

/// Gives blocks with a sample time of their own its multiple of the loop's, and refuses rates that cannot be.
pub(super) fn resolve(model: &Model, form: &mut Form, reader: &mut Reader) {
    let Form::Blocks(diagram) = form else { return };
    let budget = Budget::with_work(COMPARISON_WORK);
    for block in &mut diagram.blocks {
        let name = shorten(&block.name).into_owned();
        if let Some(own) = &block.sample_time {
            let Some(of_loop) = &model.sample_time else {
                let error =
                    wrong(format!("the loop of '{name}' has no sample time"), own.span, "a multiple of no sample time");
                reader.report(error.help("give the loop its sample_time, or the block 'every'"));
                continue;
            };
            let ratio = budget.enter(|| {
                // A constant that is a number may be given another one.
                let is_open = |name: &str| model.constant(name).is_some_and(|c| c.expression.names().is_empty());
                let symbol = |name: &str, constant: bool| (!constant || is_open(name)).then_some(Symbol::Variable);
                let (parameters, constants) = (model.parameters.iter(), model.ordered_constants());
                let mut scope = Scope::new(parameters, constants, symbol, &budget, &mut |_| {});
                let (own, of_loop) = (scope.scalar(own).ok()?, scope.scalar(of_loop).ok()?);
                own.checked_div(&of_loop)?.as_constant()
            });
            let whole = ratio.ok().flatten().filter(|ratio| *ratio >= Rational::ONE && ratio.is_integer());
            match whole.and_then(|ratio| ratio.numerator().to_i64()) {
                Some(every) => block.rate.every = every as u64,
                None => {
                    let error = wrong(
                        format!(
                            "the sample time of '{name}' is no whole multiple of the loop's, whatever parameters and constants are"
                        ),
                        own.span,
                        "not a whole multiple",
                    );
                    reader.report(error.help("make the loop's sample_time the greatest common divisor of all"));
                    continue;
                }
            }
        }
        if block.rate.phase >= block.rate.every {
            let message = format!("'phase' of '{name}' is not below the {} samples of its period", block.rate.every);
            let error = wrong(message, block.span, "this block");
            reader.report(error.help("'every' says how many samples the period has: 1 where it is missing"));
        }
        if block.rate.every > 1 && is_held(block) {
            let error =
                wrong(format!("'{name}' is a continuous plant: it has no rate of its own"), block.span, "this block");
            reader.report(error.help("what drives it may be slower, and holds its output"));
        }
    }
    let steps = diagram.blocks.iter().fold(1, |steps, block| block.rate.with(steps));
    if steps > MAX_STEPS {
        let span =
            diagram.blocks.iter().max_by_key(|block| block.rate.every).map_or(Span::default(), |block| block.span);
        let error = wrong(format!("everything comes again after {steps} samples only"), span, "the slowest block");
        reader.report(
            error.help(format!("at most {MAX_STEPS} are looked at: choose rates with a smaller common multiple")),
        );
    }
}
