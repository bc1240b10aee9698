//! The remark on a hold between two continuous blocks, where no signal is sampled.
//!
//! A hold samples what its block reads. That is right for a control law: feedback of the block's own outputs, and a comparison with an
//! external signal in a closed loop (`r - y`) are computed once in a sample. It is wrong for what goes from one continuous block
//! to the next, in series or back (an electromotive force): that is continuous, and a hold there changes the loop.

use super::reader::Reader;
use crate::definition::{Block, Diagram};
use crate::error::{Code, Diagnostic};
use crate::text::names::shorten;
use crate::text::{Expression, Node, Sign};
use std::collections::BTreeSet;

/// Reports each block behind a hold that reads a continuous signal of another one behind a hold.
pub(super) fn between_holds(diagram: &Diagram, reader: &mut Reader) {
    for (at, block) in diagram.blocks.iter().enumerate().filter(|(_, b)| is_held(b)) {
        let Some(d) = block.discretization.as_ref() else { continue };
        let Some(source) = block.inputs.iter().find_map(|input| unsampled(diagram, at, input)) else { continue };
        let (name, other) = (shorten(&block.name), shorten(&source.name));
        let message = format!("'{name}' and '{other}' each have a hold, but the signal between them is not sampled");
        let warning = Diagnostic::warning(Code::RuleWarning, message).at(d.span, "a hold where no signal is sampled");
        let warning = warning.also(source.span, "continuous as well");
        reader.report(warning.help("write both as one block: its product, or one A, B, C, D"));
    }
}

pub(super) fn is_held(block: &Block) -> bool {
    block.discretization.as_ref().is_some_and(|d| d.method.is_hold())
}

/// The block behind a hold whose continuous signal an input of another such block reads.
fn unsampled<'a>(diagram: &'a Diagram, at: usize, input: &Expression) -> Option<&'a Block> {
    let read = input.names();
    let drives = |block: &Block| block.outputs.iter().any(|o| read.contains(o.name.as_str()));
    if drives(&diagram.blocks[at]) {
        // State feedback: the block's own outputs come back through its hold only.
        return None;
    }
    let compares = diagram.inputs.iter().any(|i| read.contains(i.name.as_str()));
    let behind = if compares { reached(diagram, at) } else { BTreeSet::new() };
    let is_feedback = |source: &Block| source.outputs.iter().any(|o| behind.contains(o.name.as_str()));
    let is_subtracted = |source: &Block| {
        let is_its = |name: &str| source.outputs.iter().any(|o| o.name == name);
        !has_sign(input, Sign::Plus, &is_its)
    };
    let mut sources = diagram.blocks.iter().filter(|b| is_held(b) && drives(b));
    sources.find(|source| !(compares && is_feedback(source) && is_subtracted(source)))
}

/// Whether one of some names enters a linear expression with that sign, as it is written.
fn has_sign(e: &Expression, sign: Sign, is_one: &impl Fn(&str) -> bool) -> bool {
    let other = match sign {
        Sign::Plus => Sign::Minus,
        Sign::Minus => Sign::Plus,
    };
    match &e.node {
        Node::Number(_) => false,
        Node::Name(name) => sign == Sign::Plus && is_one(name),
        Node::Negative(inner) => has_sign(inner, other, is_one),
        Node::Power(inner, _) | Node::Call(_, inner) => has_sign(inner, sign, is_one),
        Node::Sum(terms) => terms.iter().any(|(s, e)| has_sign(e, if *s == Sign::Plus { sign } else { other }, is_one)),
        Node::Product(factors) => {
            let is_negative = |e: &Expression| matches!(e.node, Node::Negative(_)) && !has_name(e, is_one);
            let negative = factors.iter().filter(|(_, e)| is_negative(e)).count() % 2 == 1;
            factors.iter().any(|(_, e)| has_sign(e, if negative { other } else { sign }, is_one))
        }
    }
}

fn has_name(e: &Expression, is_one: &impl Fn(&str) -> bool) -> bool {
    e.names().into_iter().any(is_one)
}

/// The signals that depend on a block's outputs.
fn reached(diagram: &Diagram, at: usize) -> BTreeSet<&str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![&diagram.blocks[at]];
    while let Some(block) = open.pop() {
        let new: BTreeSet<&str> =
            block.outputs.iter().map(|o| o.name.as_str()).filter(|o| reached.insert(*o)).collect();
        let reads = |b: &&Block| b.inputs.iter().any(|e| e.names().iter().any(|n| new.contains(n)));
        open.extend(diagram.blocks.iter().filter(reads));
    }
    reached
}

#[cfg(test)]
mod tests {
    use crate::Model;
    use crate::error::{Code, Source};

    /// The blocks that a remark is about, of a loop of blocks `name: input -> output`; those in capitals are behind a hold.
    fn remarked(inputs: &str, blocks: &[(&str, &str, &str)]) -> Vec<String> {
        let head = format!(
            "time = 'discrete'\nsample_time = 1\n[parameters]\nk = {{ nominal = 1 }}\n[loop]\ninputs = [{inputs}]\n"
        );
        let block = |(name, input, output): &(&str, &str, &str)| {
            let list = |text: &str| text.split("; ").map(|e| format!("'{e}'")).collect::<Vec<_>>().join(", ");
            let outputs = output.split("; ").count();
            let held = match (name.to_uppercase() == **name, outputs) {
                (true, 1) => "transfer = '1/(s + k)'\ndiscretize = 'zoh'",
                (true, _) => "A = [[0, 'k'], [-1, -2]]\nB = [[0], [1]]\ndiscretize = 'zoh'",
                (false, _) => "gain = 'k'",
            };
            format!("[[block]]\nname = '{name}'\ninput = [{}]\noutput = [{}]\n{held}\n", list(input), list(output))
        };
        let text = head + &blocks.iter().map(block).collect::<String>();
        let (_, warnings) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
        let rules = warnings.iter().filter(|w| w.code == Code::RuleWarning);
        rules.map(|w| w.message.split('\'').nth(1).unwrap().to_owned()).collect()
    }

    const NONE: [&str; 0] = [];

    #[test]
    fn sampled_feedback_of_a_block_behind_a_hold_is_right() {
        assert_eq!(remarked("'r'", &[("G", "r - y", "y")]), NONE, "unity feedback");
        assert_eq!(remarked("'r'", &[("G", "k*(r - y)", "y")]), NONE);
        assert_eq!(remarked("'r'", &[("G", "y - r", "y")]), NONE);
        assert_eq!(remarked("", &[("G", "-k*x - 2*v", "x; v")]), NONE, "state feedback");
        assert_eq!(remarked("'r'", &[("c", "r - y", "u"), ("G", "u", "y")]), NONE);
        let both = [("G", "-k*x - 2*y", "x"), ("H", "-x - k*y", "y")];
        assert_eq!(remarked("", &both), NONE, "one law for two plants");
    }

    #[test]
    fn a_hold_between_continuous_blocks_is_remarked_upon() {
        let series = [("G", "r - y", "x"), ("H", "2*x", "y")];
        assert_eq!(remarked("'r'", &series), ["H"], "the comparison is sampled, the series is not");
        assert_eq!(remarked("'r', 'd'", &[("H", "x + d", "y"), ("G", "r - y", "x")]), ["H"]);
        assert_eq!(remarked("'r'", &[("c", "r - y", "u"), ("G", "u", "x"), ("H", "x", "y")]), ["H"]);
        let motor = [("c", "r - w", "u"), ("G", "u - k*w", "i"), ("H", "i", "w")];
        assert_eq!(remarked("'r'", &motor), ["G", "H"], "the electromotive force is continuous, too");
        let state = [("G", "-k*i - 2*w", "i"), ("H", "i", "w")];
        assert_eq!(remarked("", &state), ["H"]);
        assert_eq!(remarked("'r'", &[("G", "r", "x"), ("H", "r - x", "y"), ("c", "y", "u")]), ["H"], "no loop");
    }
}
