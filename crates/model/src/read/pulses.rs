//! `edge` and `duty` of a block behind a pulse-width modulator.

use super::keys::{EDGES, HELD};
use super::reader::{Meant, Reader, count};
use crate::definition::{Block, Dynamics, Pulses};
use crate::discretization::Edges;
use crate::error::{Code, Diagnostic};
use crate::text::names::{did_you_mean, list, shorten};
use crate::text::toml_value::{Entry, Kind, Table, Value};
use crate::text::{Expression, Node, Text};

/// The word for the duty ratio of the loop at rest.
const STEADY: &str = "steady";

/// The pulses that a table with the method `pwm` says.
pub(super) fn pulses(entry: &Entry, table: &Table, meant: &Meant, reader: &mut Reader) -> Option<Pulses> {
    let edges = match table.entry("edge") {
        None if meant.includes("edge") => None,
        None => {
            let error =
                Diagnostic::error(Code::Edge, "the modulator has no 'edge'").at(entry.key_span, "which edge moves?");
            reader.report(error.help(format!("give edge = \"trailing\"; known: {}", list(EDGES))));
            None
        }
        Some(edge) => {
            let words = reader.items(&edge.value);
            let edges: Vec<_> = words.iter().filter_map(|word| one_edge(word, reader)).collect();
            (edges.len() == words.len() && !edges.is_empty()).then_some((edges, edge.value.span))
        }
    };
    let duties = match table.entry("duty") {
        None if meant.includes("duty") => None,
        None => {
            let error =
                Diagnostic::error(Code::Duty, "the modulator has no 'duty'").at(entry.key_span, "how long is a pulse?");
            reader.report(error.help(
                "give the duty ratio of the orbit, between 0 and 1: a number, or an expression such as duty = \"V_0/V_dc\"",
            ));
            None
        }
        Some(duty) => duties(&duty.value, reader),
    };
    let ((edges, span), duties) = (edges?, duties?);
    let is_steady = matches!(duties.as_slice(), [one] if one.node == Node::Name(STEADY.to_owned()));
    Some(Pulses { edges, duties, is_steady, span })
}

fn one_edge(word: &Value, reader: &mut Reader) -> Option<Option<&'static Edges>> {
    let word: &Text = reader.string(word, "'edge'")?;
    let text = word.as_str();
    let edges = Edges::named(text);
    if edges.is_some() || text == HELD {
        return Some(edges);
    }
    let (message, help) = match text {
        "natural" => (
            "naturally sampled pulses are not modelled".to_owned(),
            "a comparator switches when its own input says, not once for each sample; the edges known here are those of pulses that \
             the controller commands once in a period"
                .to_owned(),
        ),
        _ => (
            format!("unknown edge '{}'", shorten(text)),
            did_you_mean(text, EDGES).unwrap_or_else(|| format!("known: {}", list(EDGES))),
        ),
    };
    reader.report(Diagnostic::error(Code::Edge, message).at(word.span(), "not known").help(help));
    None
}

fn duties(value: &Value, reader: &mut Reader) -> Option<Vec<Expression>> {
    if let Kind::String(text) = &value.kind
        && text.as_str() == STEADY
    {
        return Some(vec![Expression { span: text.span(), node: Node::Name(STEADY.to_owned()) }]);
    }
    let before = reader.errors();
    let duties = reader.expressions(value, "'duty'");
    if duties.is_empty() && reader.errors() == before {
        let error = Diagnostic::error(Code::Duty, "'duty' is empty").at(value.span, "no duty ratio");
        reader.report(error.help("one for all inputs, or one for each"));
    }
    (reader.errors() == before).then_some(duties)
}

/// Reports lists that have not one entry for each input.
pub(super) fn fit(block: &Block, reader: &mut Reader) {
    let Some(pulses) = block.discretization.as_ref().and_then(|d| d.pulses.as_ref()) else { return };
    let inputs = block.inputs.len();
    let duties_at = pulses.duties[0].span;
    for (len, code, key, span) in
        [(pulses.edges.len(), Code::Edge, "edge", pulses.span), (pulses.duties.len(), Code::Duty, "duty", duties_at)]
    {
        if len != 1 && len != inputs {
            let message = format!(
                "'{key}' of '{}' has {} for {}",
                shorten(&block.name),
                count(len, "entry", "entries"),
                count(inputs, "input", "inputs")
            );
            reader.report(Diagnostic::error(code, message).at(span, "one for all, or one for each input"));
        }
    }
    let is_zero = |e: &Expression| matches!(&e.node, Node::Number(x) if x.is_zero());
    let direct = match &block.dynamics {
        Dynamics::StateSpace { d: Some(d), .. } | Dynamics::Static(d) if !d.rows.iter().flatten().all(is_zero) => {
            Some(d.span)
        }
        Dynamics::Gain(e) => Some(e.span),
        Dynamics::Ratio { numerator, denominator }
            if numerator.len() == denominator.len() && !is_zero(&numerator[0]) =>
        {
            Some(numerator[0].span)
        }
        _ => None,
    };
    if let Some(span) = direct {
        let message = format!("'{}' passes pulses on at once: that part counts for nothing", shorten(&block.name));
        let warning = Diagnostic::warning(Code::FeedthroughWarning, message).at(span, "the direct part");
        reader.report(warning.help("a longer pulse is the same voltage at the sample"));
    }
    if pulses.edges.iter().all(Option::is_none) {
        let message = format!("no input of '{}' is a pulse", shorten(&block.name));
        let error = Diagnostic::error(Code::Edge, message).at(pulses.span, "all of them are held");
        reader.report(error.help("that is a hold: method = \"zoh\""));
    }
}
