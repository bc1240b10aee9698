//! Remarks on how continuous blocks are made discrete: by a rule where nothing is behind a hold, and with sample times that
//! differ.

use super::check_holds::{between_holds, is_held};
use super::reader::Reader;
use crate::definition::{Block, Dynamics, Form, Model, Time};
use crate::error::{Code, Diagnostic, Span};
use crate::evaluate::scalar::{Scope, Symbol};
use crate::text::Expression;
use crate::text::names::shorten;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::RationalFunction;

/// Units of work that the comparison of sample times may take. What is not found within it is not remarked upon.
const COMPARISON_WORK: u64 = 10_000_000;

/// Reports both.
pub(super) fn rules(model: &Model, reader: &mut Reader) {
    let Form::Blocks(diagram) = &model.form else { return };
    if model.time != Time::Discrete {
        return;
    }
    without_hold(&diagram.blocks, reader);
    between_holds(diagram, reader);
    let times: Vec<(&Expression, Span)> = diagram
        .blocks
        .iter()
        .filter_map(|b| b.discretization.as_ref())
        .filter(|d| d.factor.is_none())
        .filter_map(|d| d.sample_time.as_ref().map(|e| (e, d.span)))
        .collect();
    let own = model.sample_time.as_ref().map(|e| (e, e.span));
    let Some((first, place)) = own.or_else(|| times.first().copied()) else { return };
    let budget = Budget::with_work(COMPARISON_WORK);
    let different = budget.enter(|| {
        let symbol = |_: &str, constant: bool| (!constant).then_some(Symbol::Variable);
        let mut scope = Scope::new(model.parameters.iter(), model.ordered_constants(), symbol, &budget, &mut |_| {});
        let reference: RationalFunction = scope.scalar(first).ok()?;
        times.into_iter().find(|(e, _)| scope.scalar(e).is_ok_and(|time| time != reference))
    });
    if let Ok(Some((e, span))) = different {
        let span = if e.span == place { span } else { e.span };
        let message = "two different sample times in one loop";
        let warning =
            Diagnostic::warning(Code::SampleTimesWarning, message).at(span, "one here").also(place, "another one here");
        reader.report(warning.help("z is one step for all blocks: give all the same, by the name of one parameter"));
    }
}

/// That no block is behind a hold although continuous blocks are made discrete, said once.
fn without_hold(blocks: &[Block], reader: &mut Reader) {
    if blocks.iter().any(is_held) {
        return;
    }
    let by_rule = |b: &&Block| !matches!(b.dynamics, Dynamics::Gain(_) | Dynamics::Static(_));
    let Some((block, d)) = blocks.iter().filter(by_rule).find_map(|b| Some((b, b.discretization.as_ref()?))) else {
        return;
    };
    let message = format!("'{}' is made discrete by the {}", shorten(&block.name), d.method.words);
    let message = message.replace("the Tustin's", "Tustin's");
    let warning = Diagnostic::warning(Code::RuleWarning, message).at(d.span, "the answer is about this rule");
    reader.report(warning.help("a plant behind a digital controller sees a hold: method = \"zoh\" is exact for it"));
}

#[cfg(test)]
mod tests {
    use crate::Model;
    use crate::error::{Code, Source};

    /// Messages of all warnings of a loop with a sampled controller and this plant.
    fn warnings(sample_time: &str, plant: &str) -> Vec<(Code, String)> {
        let text = format!(
            "time = 'discrete'\nsample_time = '{sample_time}'\n[parameters]\nT = {{ nominal = 1, min = 0 }}\n[loop]\ninputs = ['r']\n\
             [[block]]\nname = 'controller'\ninput = 'r - y*T'\noutput = 'u'\ngain = 1\n\
             [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'x'\n{plant}\n\
             [[block]]\nname = 'filter'\ninput = 'x'\noutput = 'y'\ntransfer = '1/(s + 2)'\ndiscretize = {{ method = 'tustin', T = 'T' }}\n"
        );
        let (_, warnings) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
        warnings.into_iter().map(|w| (w.code, w.message)).collect()
    }

    #[test]
    fn rules_without_a_hold_are_remarked_upon_once() {
        let by_rule = warnings("T", "transfer = '1/(s + 1)'\ndiscretize = 'forward'");
        assert_eq!(by_rule, [(Code::RuleWarning, "'plant' is made discrete by the forward rule".to_owned())]);
        assert_eq!(warnings("T", "transfer = '1/(s + 1)'\ndiscretize = 'zoh'"), []);
    }

    #[test]
    fn two_sample_times_in_one_loop_are_remarked_upon() {
        let held = |time: &str| format!("transfer = '1/(s + 1)'\ndiscretize = {{ method = 'zoh', T = '{time}' }}");
        let other = [(Code::SampleTimesWarning, "two different sample times in one loop".to_owned())];
        assert_eq!(warnings("T", &held("T")), []);
        assert_eq!(warnings("T", &held("T + T - T")), []);
        assert_eq!(warnings("T", &held("2*T")), other);
        assert_eq!(warnings("1/1000", &held("T")), other);
    }
}
