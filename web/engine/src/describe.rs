//! What a text says: the document of `jurist check --json`, and what a page shows of the model beside its answers.

use crate::model::{NAME, read};
use crate::reply::Reply;
use jurist::documents::Check;
use jurist::{Diagnostics, Expression, Model};
use jurist_engine::model::{Block, Dynamics, Form, Matrix};
use jurist_show::diagnostics::render_error;
use serde_json::{Value, json};

/// Every remark, and the model where it is one.
pub(crate) fn describe(text: &str) -> Reply {
    Reply::answered(match read(text) {
        Ok((model, warnings)) => {
            let check = Check::new(NAME, Some(model.source()), &warnings);
            let text = match warnings.is_empty() {
                true => String::new(),
                false => render_error(&Diagnostics::new(Some(model.source().clone()), warnings), false),
            };
            json!({ "check": check, "text": text.trim_end(), "model": said(&model) })
        }
        Err(refused) => {
            let check = Check::new(NAME, refused.source_text().map(AsRef::as_ref), refused.diagnostics());
            json!({ "check": check, "text": render_error(&refused, false).trim_end(), "model": null })
        }
    })
}

fn said(model: &Model) -> Value {
    let parameter = |p: &jurist::Parameter| {
        let text = |value: &Option<jurist::Rational>| value.as_ref().map(ToString::to_string);
        json!({
            "name": p.name, "nominal": text(&p.nominal), "min": text(&p.min), "max": text(&p.max), "closed": p.closed,
            "unit": p.unit, "description": p.description, "formula": p.nominal_formula.as_ref().map(ToString::to_string),
        })
    };
    let constant = |c: &jurist::Constant| {
        let number = c.number.as_ref().map(ToString::to_string);
        json!({ "name": c.name, "value": c.expression.to_string(), "number": number })
    };
    json!({
        "title": model.title(),
        "time": model.time().name(),
        "rules": model.rules(),
        "parameters": model.parameters().iter().map(parameter).collect::<Vec<_>>(),
        "constants": model.constants().iter().map(constant).collect::<Vec<_>>(),
        "inputs": model.inputs().iter().map(|name| &name.name).collect::<Vec<_>>(),
        "outputs": model.outputs().iter().map(|output| &output.name.name).collect::<Vec<_>>(),
        "blocks": blocks(model),
        "cut": model.first_cut(),
        "tolerances": model.parameters().iter().any(|p| p.tolerance.is_some())
            || model.constants().iter().any(|c| c.tolerance.is_some()),
    })
}

fn blocks(model: &Model) -> Value {
    let matrix = |what: &str, m: &Matrix| format!("{what} ({} x {})", m.size().0, m.size().1);
    let row = |name: &str, inputs: String, outputs: String, does: String| json!([name, inputs, outputs, does]);
    let rows = match model.form() {
        Form::Characteristic(e) => vec![row("characteristic polynomial", String::new(), String::new(), e.to_string())],
        Form::Matrix { matrix: m, .. } => {
            vec![row("closed loop", String::new(), String::new(), matrix("matrix", m))]
        }
        Form::OutputFeedback { a, b, c, k, .. } => vec![
            row("plant", "u".into(), "y".into(), [matrix("A", a), matrix("B", b), matrix("C", c)].join(", ")),
            row("feedback", "y".into(), "u".into(), matrix("-K", k)),
        ],
        Form::Blocks(diagram) => diagram.blocks.iter().map(block).collect(),
    };
    Value::Array(rows)
}

fn block(block: &Block) -> Value {
    let list = |all: &[Expression]| all.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let mut does = match &block.dynamics {
        Dynamics::Transfer(e) => e.to_string(),
        Dynamics::Ratio { numerator, denominator } => format!("[{}] / [{}]", list(numerator), list(denominator)),
        Dynamics::Gain(e) => format!("gain {e}"),
        Dynamics::Delay(e) => format!("delay of {e} samples"),
        Dynamics::DeadTime(e) => format!("dead time {e}"),
        Dynamics::StateSpace { a, .. } => format!("state space of order {}", a.size().0),
        Dynamics::Static(m) => format!("matrix {} x {}", m.size().0, m.size().1),
    };
    if let Some(rule) = &block.discretization {
        does.push_str(&format!(", {}", rule.words()));
        if let Some(delay) = &rule.delay {
            does.push_str(&format!(", dead time {delay}"));
        }
    }
    if block.rate.every > 1 {
        does.push_str(&format!(", {}: outputs are held in between", block.rate.words()));
    }
    let outputs: Vec<&str> = block.outputs.iter().map(|o| o.name.as_str()).collect();
    json!([block.name, list(&block.inputs), outputs.join(", "), does])
}
