//! `[[block]]` entries.

use super::discretize::discretize;
use super::dynamics::dynamics;
use super::keys;
use super::pulses::fit;
use super::rates::rate;
use super::reader::{Meant, Reader, count};
use crate::definition::{Block, Diagram, Discretization, Dynamics, Pwm, Time};
use crate::error::{Code, Diagnostic, Span};
use crate::text::Expression;
use crate::text::names::shorten;
use crate::text::toml_value::{Entry, Kind, Table, Value};
use std::collections::HashMap;

/// The diagram of `[loop]` and its blocks.
pub(super) fn diagram(
    table: &Table,
    blocks: &Entry,
    time: Time,
    sample_time: Option<&Expression>,
    reader: &mut Reader,
) -> Option<Diagram> {
    let inputs = table.get("inputs").map(|v| reader.names(v, "an external signal")).unwrap_or_default();
    let outputs = table.get("outputs").map(|v| reader.outputs(v)).unwrap_or_default();
    for key in ["states", "E"] {
        if let Some(entry) = table.entry(key) {
            let error = Diagnostic::error(Code::UnknownKey, format!("'{key}' does not go with [[block]]"));
            reader.report(error.at(entry.key_span, "blocks have their own states"));
        }
    }
    let Kind::Array(items) = &blocks.value.kind else {
        let error = Diagnostic::error(Code::Type, "a block is an entry of an array of tables");
        reader.report(error.at(blocks.key_span, "not an array of tables").help("write [[block]] with two brackets"));
        return None;
    };
    let before = reader.errors();
    distinct_names(items, reader);
    let named = items.iter().zip(names_of(items));
    let blocks: Vec<Block> = named.filter_map(|(item, name)| block(item, name, time, sample_time, reader)).collect();
    (reader.errors() == before || blocks.len() == items.len()).then_some(Diagram { inputs, outputs, blocks })
}

/// The name that a block is given, and where.
fn given_name(item: &Value) -> Option<(&str, Span)> {
    let Kind::Table(table) = &item.kind else { return None };
    match table.get("name")? {
        Value { kind: Kind::String(text), span } => Some((text.as_str(), *span)),
        _ => None,
    }
}

/// What blocks are called. The first without a name is `block`, if no other has that name; any further one has its place in its name. So no name stands for two blocks,
/// unless it was given: a loop is cut at a name.
fn names_of(items: &[Value]) -> Vec<String> {
    let given: Vec<Option<&str>> = items.iter().map(|item| given_name(item).map(|(name, _)| name)).collect();
    let first = given.iter().position(Option::is_none).filter(|_| !given.contains(&Some("block")));
    let name = |(i, given): (usize, &Option<&str>)| match given {
        Some(name) => (*name).to_owned(),
        None if first == Some(i) => "block".to_owned(),
        None => format!("block {}", i + 1),
    };
    given.iter().enumerate().map(name).collect()
}

/// Reports blocks that have the name of another one.
fn distinct_names(items: &[Value], reader: &mut Reader) {
    let mut seen: HashMap<&str, Span> = HashMap::new();
    for item in items {
        let Some((text, span)) = given_name(item) else { continue };
        if let Some(first) = seen.insert(text, span) {
            let message = format!("two blocks have the name '{}'", shorten(text));
            let error = Diagnostic::error(Code::DuplicateName, message).at(span, "here again");
            reader.report(error.also(first, "first here").help("rename one of them, or leave the name out"));
        }
    }
    for (item, name) in items.iter().zip(names_of(items)).filter(|(item, _)| given_name(item).is_none()) {
        if let Some(first) = seen.get(name.as_str()) {
            let message = format!("the block without a name is called '{name}', and so is another one");
            let error = Diagnostic::error(Code::DuplicateName, message).at(item.span, "without a name");
            reader.report(error.also(*first, "here").help("give it a name, or the other one another"));
        }
    }
}

/// What is known of a block while it is read.
pub(super) struct BlockTable<'t> {
    pub table: &'t Table,
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    pub time: Time,
    /// Whether it is continuous and made discrete.
    pub is_discretised: bool,
    meant: Meant,
}

impl BlockTable<'_> {
    /// Whether a key was probably meant by a misspelt one.
    pub fn may_have(&self, key: &str) -> bool {
        self.meant.includes(key)
    }

    /// Reports that a key is missing.
    fn missing(&self, key: &str, reader: &mut Reader) {
        if !self.may_have(key) {
            let error = Diagnostic::error(Code::Missing, format!("the block '{}' has no '{key}'", shorten(&self.name)));
            reader.report(error.at(self.span, "this block"));
        }
    }

    fn discretization(&self, sample_time: Option<&Expression>, reader: &mut Reader) -> Option<Discretization> {
        let entry = self.table.entry("discretize")?;
        if self.time == Time::Discrete {
            return discretize(entry, sample_time, reader);
        }
        let error = Diagnostic::error(Code::Discretize, "a continuous loop has nothing to discretise");
        let help = "a loop with a hold is sampled: time = \"discrete\" and a sample_time; else leave 'discretize' out";
        reader.report(error.at(entry.key_span, "time = \"continuous\"").help(help));
        None
    }
}

fn block(
    value: &Value,
    name: String,
    time: Time,
    sample_time: Option<&Expression>,
    reader: &mut Reader,
) -> Option<Block> {
    let Kind::Table(table) = &value.kind else {
        reader.wrong_type(value, "a block", "a table");
        return None;
    };
    let meant = reader.unknown_keys(table, &keys::BLOCK, "a block");
    let name = reader.plain_string(table, "name").unwrap_or(name);
    if table.iter().next().is_none() {
        let error = Diagnostic::error(Code::Missing, "the block is empty").at(value.span, "nothing follows");
        reader.report(error.help("give it 'input', 'output' and what it does, such as 'transfer'"));
        return None;
    }
    let before = reader.errors();
    let is_discretised = table.entry("discretize").is_some();
    let of = BlockTable { table, name, span: value.span, time, is_discretised, meant };
    let inputs = table.get("input").map(|v| reader.expressions(v, "an input"));
    if inputs.is_none() {
        of.missing("input", reader);
    }
    let outputs = table.get("output").map(|v| reader.names(v, "a signal"));
    if outputs.is_none() {
        of.missing("output", reader);
    }
    let discretization = of.discretization(sample_time, reader);
    let dynamics = dynamics(&of, reader);
    let (rate, own) = rate(table, &of.name, time, reader);
    let pwm = table.entry("pwm").and_then(|entry| pwm(entry, reader));
    let (inputs, outputs, dynamics) = (inputs?, outputs?, dynamics?);
    if reader.errors() > before || (is_discretised && discretization.is_none()) {
        return None;
    }
    if let Some(entry) = table.entry("discretize")
        && matches!(dynamics, Dynamics::Gain(_) | Dynamics::Static(_))
        && discretization.as_ref().is_none_or(|d| d.delay.is_none())
    {
        let message = format!("the block '{}' has no states: there is nothing to discretise", shorten(&of.name));
        reader.unused(message, entry.key_span);
    }
    let place = |key: &str| table.get(key).map_or(value.span, |v| v.span);
    let (span, name) = (place("name"), of.name);
    let block = Block { name, span, inputs, outputs, dynamics, discretization, rate, sample_time: own, pwm };
    fit(&block, reader);
    sizes(&block, place("input"), place("output"), reader).then_some(block)
}

/// Whether the numbers of inputs and outputs fit the dynamics.
fn sizes(block: &Block, in_span: Span, out_span: Span, reader: &mut Reader) -> bool {
    let before = reader.diagnostics.len();
    let (inputs, outputs) = (block.inputs.len(), block.outputs.len());
    let (in_text, out_text) = (count(inputs, "input", "inputs"), count(outputs, "output", "outputs"));
    match &block.dynamics {
        Dynamics::StateSpace { a, b, c, d } => {
            let n = a.size().0;
            let order = (a.span, format!("A has {}", count(n, "row", "rows")));
            reader.size(a, "A", n, n, (a.span, "A must be square"));
            reader.size(b, "B", n, b.size().1, (order.0, &order.1));
            reader.size(b, "B", n, inputs, (in_span, &in_text));
            match c {
                Some(c) => {
                    reader.size(
                        c,
                        "C",
                        outputs,
                        n,
                        if c.size().0 == outputs { (order.0, &order.1) } else { (out_span, &out_text) },
                    );
                }
                None if outputs != n => {
                    let message = format!("without 'C' the outputs are the {}", count(n, "state", "states"));
                    let error = Diagnostic::error(Code::Size, message).at(out_span, out_text.clone());
                    reader.report(error.also(order.0, order.1.clone()));
                }
                None => {}
            }
            if let Some(d) = d {
                let because = if d.size().0 == outputs { (in_span, &in_text) } else { (out_span, &out_text) };
                reader.size(d, "D", outputs, inputs, (because.0, because.1));
            }
        }
        Dynamics::Static(d) => {
            let because = if d.size().0 == outputs { (in_span, &in_text) } else { (out_span, &out_text) };
            reader.size(d, "D", outputs, inputs, (because.0, because.1));
        }
        _ => {
            for (n, span, what) in [(inputs, in_span, "input"), (outputs, out_span, "output")] {
                if n != 1 {
                    let message = format!("the block '{}' has one {what}, but {n} are given", shorten(&block.name));
                    let error = Diagnostic::error(Code::Size, message).at(span, format!("must be one {what}"));
                    reader.report(error.help("blocks with several signals are given by A, B, C, D"));
                }
            }
        }
    }
    // The same mistake in B is found twice when it concerns rows and columns.
    let mut seen = Vec::new();
    let mut position = 0;
    reader.diagnostics.retain(|d| {
        position += 1;
        let key = (d.code, d.message.clone(), d.primary.clone());
        position <= before
            || (!seen.contains(&key) && {
                seen.push(key);
                true
            })
    });
    reader.diagnostics.len() == before
}

fn pwm(entry: &Entry, reader: &mut Reader) -> Option<Pwm> {
    let table = reader.table(entry)?;
    let meant = reader.unknown_keys(table, &keys::PWM, "'pwm'");
    let mut part = |key: &str| {
        let Some(value) = table.get(key) else {
            if !meant.includes(key) {
                let error = Diagnostic::error(Code::Missing, format!("'pwm' has no '{key}'"));
                reader.report(error.at(entry.key_span, "incomplete"));
            }
            return None;
        };
        reader.expression(value, &format!("'{key}'"))
    };
    let (amplitude, carrier, period) = (part("amplitude"), part("carrier"), part("period"));
    Some(Pwm { amplitude: amplitude?, carrier: carrier?, period: period? })
}

#[cfg(test)]
mod tests {
    use crate::Model;
    use crate::error::{Code, Source};

    /// Code and source text of all warnings of a discrete loop whose plant has this line.
    fn warnings(plant: &str) -> Vec<(Code, String)> {
        let text = format!(
            "time = 'discrete'\n[parameters]\nT = {{ nominal = 1, min = 0 }}\nc = {{ nominal = 2 }}\n[loop]\ninputs = ['r']\n\
             [[block]]\ninput = 'r - T*c*y'\noutput = 'e'\ngain = 1\n[[block]]\ninput = 'e'\noutput = 'y'\n{plant}\n"
        );
        let (_, warnings) = Model::from_toml(&Source::new("model.toml", text.as_str())).unwrap();
        let place = |span: crate::error::Span| text[span.start..span.end].to_owned();
        let warnings = warnings.iter().filter(|w| w.code != Code::RuleWarning);
        warnings.map(|w| (w.code, w.primary.as_ref().map_or(String::new(), |l| place(l.span)))).collect()
    }

    #[test]
    fn keys_without_effect_are_warned_about() {
        let unused = |key: &str| vec![(Code::UnusedWarning, key.to_owned())];
        let continuous = |rule: &str| format!("transfer = '1/(s + 1)'\ndiscretize = {rule}");
        assert_eq!(warnings(&continuous("{ method = 'tustin', T = 'T', c = '2/T' }")), unused("T"));
        assert_eq!(warnings(&continuous("{ method = 'tustin', c = '2/T' }")), []);
        assert_eq!(warnings(&continuous("{ method = 'tustin', T = 'T' }")), []);
        assert_eq!(warnings("gain = 1\ndiscretize = { method = 'forward', T = 'T' }"), unused("discretize"));
        assert_eq!(warnings("D = [[1]]\ndiscretize = { method = 'forward', T = 'T' }"), unused("discretize"));
        assert_eq!(warnings("A = [[0]]\nB = [[1]]\ndiscretize = { method = 'forward', T = 'T' }"), []);
    }
}
