//! What is proved, what is only drawn, and what the model leaves out.

use crate::page::{escaped, math};
use jurist_engine::model::{Block, Form, Model, Time};

pub(super) fn section(model: &Model) -> String {
    let mut html = String::from(
        "<ul><li><b>Proved</b>, by exact arithmetic from the model's text on: the verdict and the number of roots, every limit \
         with its cause and frequency (all decimals are correctly rounded), the margins and crossings of the open loop, the \
         table of what moves the limits, the box of tolerances, the cells of the map and the crossings marked on pictures. \
         A certificate, where there is one, lets independent code prove it again.</li>\n<li><b>Only drawn</b>, in floating \
         point: the curves of the root locus between crossings, the curves of the Bode diagram, the response with its \
         overshoot and settling time, and where the lines of the map lie between the points that are isolated.</li>\n\
         <li><b>Assumed</b>: the model itself. What it leaves out, no proof can see:<ul>\n",
    );
    for line in left_out(model) {
        html.push_str(&format!("<li>{}</li>\n", math(&line)));
    }
    html.push_str("</ul></li></ul>\n");
    html
}

/// What the model does not say about the thing it is a model of.
fn left_out(model: &Model) -> Vec<String> {
    let mut out = Vec::new();
    if let Form::Blocks(diagram) = model.form() {
        for block in &diagram.blocks {
            let Some(method) = block.discretization.as_ref().map(|d| d.method) else { continue };
            out.push(format!("{}: {}", block.name, method.caveat()));
        }
        let modulated = |b: &Block| b.discretization.as_ref().is_some_and(|d| d.method.is_modulated());
        if diagram.blocks.iter().any(|b| b.pwm.is_some()) && !diagram.blocks.iter().any(modulated) {
            out.push(
                "Modulators act by their mean value: no ripple, no switching instants (a run of the circuit: simulate, with \
                 the option switched)."
                    .to_owned(),
            );
        }
    } else if model.time() == Time::Discrete {
        out.push(
            "How the discrete matrices or coefficients follow from a continuous plant: they are taken as given."
                .to_owned(),
        );
    }
    out.push(
        "Everything that is not linear or changes with time: saturation, quantisation, dead zones, jitter of the sampling, \
         drift of a parameter while the loop runs."
            .to_owned(),
    );
    out.push(
        "Other values of the other parameters: a limit holds with all others at the values of this page.".to_owned(),
    );
    out
}

/// The rules by which continuous blocks were made discrete, for the head of the page; empty where there are none.
pub(super) fn rules(model: &Model) -> String {
    match model.rules() {
        rules if rules.is_empty() => rules,
        rules => format!(" Made discrete by: {}.", escaped(&rules)),
    }
}
