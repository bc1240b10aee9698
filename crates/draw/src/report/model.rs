//! What the model says: blocks or matrices, constants, parameters.

use crate::page::{Table, escaped, math, matrix, paragraph};
use jurist_algebra::number::Rational;
use jurist_engine::error::Span;
use jurist_engine::model::{
    Block, Diagram, Discretization, Dynamics, Expression, Form, Matrix, Model, Ports, Rate, Time,
};
use jurist_engine::problem::Question;
use jurist_show::layout::short;

/// A longer model file is not repeated in the report.
const LONGEST_TEXT: usize = 60_000;

pub(super) fn section(question: &Question) -> String {
    let model = question.model();
    let mut html = paragraph(&math(&kind(model)));
    html.push_str(&form(model));
    html.push_str(&constants(question));
    html.push_str(&parameters(question));
    let text = &model.source().text;
    if !text.is_empty() && text.len() <= LONGEST_TEXT {
        html.push_str(&format!(
            "<details><summary>The model file</summary><pre>{}</pre></details>\n",
            text.lines().map(escaped).collect::<Vec<_>>().join("\n")
        ));
    }
    html
}

/// The kind of time, and the sample time.
fn kind(model: &Model) -> String {
    let stable = match model.time() {
        Time::Discrete => "stable where all roots in z are inside the unit circle",
        Time::Continuous => "stable where all roots in s are left of the imaginary axis",
    };
    let sampled = model.sample_time_expression().map(|t| format!(", sample time {}", written(model, t)));
    format!("A loop in {} time{}: {stable}.", model.time().name(), sampled.unwrap_or_default())
}

fn form(model: &Model) -> String {
    match model.form() {
        Form::Characteristic(p) => {
            let what = paragraph("Given is the characteristic polynomial, as it is written:");
            format!("{what}<div class=\"wide eq\"><span>{}</span></div>\n", math(&written(model, p)))
        }
        Form::Matrix { matrix: m, ports } => {
            let names = ports.states.iter().map(|s| s.name.as_str()).collect::<Vec<_>>();
            paragraph(&format!("The matrix of the closed loop{}.", states(&names)))
                + &matrix("A", &entries(model, m))
                + &input_matrix(model, ports)
        }
        Form::OutputFeedback { a, b, c, k, ports } => {
            let names = ports.states.iter().map(|s| s.name.as_str()).collect::<Vec<_>>();
            let equation = "u = -K y, y = C x: the closed loop is A - B K C";
            let mut html = paragraph(&format!("{}{}.", math(equation), states(&names)));
            for (name, m) in [("A", a), ("B", b), ("C", c), ("K", k)] {
                html.push_str(&matrix(name, &entries(model, m)));
            }
            html + &input_matrix(model, ports)
        }
        Form::Blocks(diagram) => blocks(model, diagram),
    }
}

/// `; states: ...`
fn states(names: &[&str]) -> String {
    if names.is_empty() { String::new() } else { format!("; states: {}", math(&names.join(", "))) }
}

/// How the external inputs enter.
fn input_matrix(model: &Model, ports: &Ports) -> String {
    let Some(m) = &ports.input_matrix else { return String::new() };
    let inputs: Vec<&str> = ports.inputs.iter().map(|i| i.name.as_str()).collect();
    paragraph(&format!("The inputs {} enter by", math(&inputs.join(", ")))) + &matrix("E", &entries(model, m))
}

/// An expression as the model's text has it, on one line.
fn written(model: &Model, e: &Expression) -> String {
    text_at(model, e.span).unwrap_or_else(|| e.to_string())
}

fn text_at(model: &Model, span: Span) -> Option<String> {
    let text = model.source().text.get(span.start..span.end)?;
    let bare = text.trim().trim_matches(['"', '\'']);
    let line = bare.split_whitespace().collect::<Vec<_>>().join(" ");
    (!line.is_empty()).then_some(line)
}

/// The entries of a matrix as the model's text has them, each on one line.
///
/// ```
/// use jurist_engine::model::{Form, Model};
/// let drive = Model::drive();
/// let Form::OutputFeedback { k, .. } = drive.form() else { unreachable!() };
/// assert_eq!(jurist_draw::report::entries(&drive, k).len(), k.size().0);
/// ```
pub fn entries(model: &Model, m: &Matrix) -> Vec<Vec<String>> {
    m.rows.iter().map(|row| row.iter().map(|e| written(model, e)).collect()).collect()
}

fn blocks(model: &Model, diagram: &Diagram) -> String {
    let names = |list: Vec<String>| if list.is_empty() { "none".to_owned() } else { list.join(", ") };
    let inputs = names(diagram.inputs.iter().map(|n| n.name.clone()).collect());
    let outputs = names(diagram.outputs.iter().map(|o| o.name.name.clone()).collect());
    let mut html = paragraph(&format!(
        "Blocks wired by the names of their signals. External inputs: {}; outputs: {}.",
        math(&inputs),
        math(&outputs)
    ));
    let discrete = model.time() == Time::Discrete;
    let mut head = vec!["block", "input", "output", "what it does"];
    if discrete {
        head.push("made discrete by");
    }
    let has_rates = diagram.blocks.iter().any(|block| block.rate.every > 1);
    if has_rates {
        head.push("runs");
    }
    let mut table = Table::new("Blocks", &head);
    let mut matrices = String::new();
    for block in &diagram.blocks {
        let input = block.inputs.iter().map(|e| written(model, e)).collect::<Vec<_>>().join("; ");
        let output = block.outputs.iter().map(|o| o.name.clone()).collect::<Vec<_>>().join("; ");
        let mut row = vec![block.name.clone(), input, output, does(model, block)];
        if discrete {
            let rule = block.discretization.as_ref();
            row.push(rule.map_or_else(|| "is discrete".to_owned(), |d| made_discrete(model, d)));
        }
        if has_rates {
            row.push(runs(diagram, block));
        }
        table.rows.push(row);
        matrices.push_str(&state_space(model, block));
    }
    html.push_str(&table.html());
    html + &matrices
}

/// At which samples a block runs, which signals it samples less often than they change, and which of its outputs others read held.
fn runs(diagram: &Diagram, block: &Block) -> String {
    let Rate { every, .. } = block.rate;
    let mut parts = vec![if every == 1 { "each sample".to_owned() } else { block.rate.words() }];
    let reads = |reader: &Block, name: &str| reader.inputs.iter().any(|e| e.names().contains(name));
    let others = || diagram.blocks.iter().filter(|other| other.rate != block.rate);
    let faster = others().filter(|other| other.rate.every < every).flat_map(|other| &other.outputs);
    let sampled: Vec<&str> = faster.map(|o| o.name.as_str()).filter(|name| reads(block, name)).collect();
    let is_held = |name: &&str| every > 1 && others().any(|reader| reads(reader, name));
    let held: Vec<&str> = block.outputs.iter().map(|o| o.name.as_str()).filter(is_held).collect();
    for (what, names) in [("samples", sampled), ("holds", held)] {
        if !names.is_empty() {
            parts.push(format!("{what} {}", names.join(", ")));
        }
    }
    parts.join("; ")
}

fn does(model: &Model, block: &Block) -> String {
    let list = |l: &[Expression]| l.iter().map(|e| written(model, e)).collect::<Vec<_>>().join(", ");
    let mut text = match &block.dynamics {
        Dynamics::Transfer(e) => written(model, e),
        Dynamics::Ratio { numerator, denominator } => {
            format!("num [{}], den [{}], highest power first", list(numerator), list(denominator))
        }
        Dynamics::Gain(e) => format!("gain {}", written(model, e)),
        Dynamics::Delay(e) => match written(model, e).as_str() {
            "1" => "delay of 1 sample".to_owned(),
            samples => format!("delay of {samples} samples"),
        },
        Dynamics::DeadTime(e) => format!("dead time {}", written(model, e)),
        Dynamics::StateSpace { .. } => "state space, matrices below".to_owned(),
        Dynamics::Static(_) => "constant matrix, below".to_owned(),
    };
    if block.pwm.is_some() {
        text.push_str("; a pulse-width modulator, here the mean of its pulses");
    }
    text
}

fn made_discrete(model: &Model, d: &Discretization) -> String {
    let mut text = d.words();
    let mut add = |word: &str, e: &Option<Expression>| {
        if let Some(e) = e {
            text.push_str(&format!(", {word} {}", written(model, e)));
        }
    };
    add("sample time", &d.sample_time);
    add("factor", &d.factor);
    add("exact at", &d.prewarp);
    add("dead time", &d.delay);
    add("commands turned ahead by", &d.advance);
    text
}

fn state_space(model: &Model, block: &Block) -> String {
    let list: Vec<(&str, &Matrix)> = match &block.dynamics {
        Dynamics::StateSpace { a, b, c, d } => {
            let optional = [("C", c.as_ref()), ("D", d.as_ref())];
            let optional = optional.into_iter().filter_map(|(name, m)| Some((name, m?)));
            [("A", a), ("B", b)].into_iter().chain(optional).collect()
        }
        Dynamics::Static(m) => vec![("D", m)],
        _ => return String::new(),
    };
    let matrices: String = list.iter().map(|(name, m)| matrix(name, &entries(model, m))).collect();
    format!("<h3>{}</h3>\n{matrices}", escaped(&block.name))
}

/// What a comment at the end of the line says on which a name is given; empty where there is none.
///
/// ```
/// use jurist_draw::report::comment_at;
/// let drive = jurist_engine::model::Model::drive();
/// assert_eq!(comment_at(&drive, drive.constant("L_a").unwrap().span), "armature inductance, H");
/// ```
pub fn comment_at(model: &Model, span: Span) -> String {
    let line = model.source().text.get(span.start..).and_then(|rest| rest.lines().next()).unwrap_or_default();
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(q), c) if q == c => quote = None,
            (None, '#') => return line[at + 1..].trim().to_owned(),
            _ => {}
        }
    }
    String::new()
}

fn constants(question: &Question) -> String {
    let model = question.model();
    if model.constants().is_empty() {
        return String::new();
    }
    let mut table = Table::new("Constants", &["name", "value", "meaning, unit"]);
    for c in model.constants() {
        let value = match (question.values_set().get(&c.name), &c.number) {
            (Some(set), Some(number)) => format!("{} (set; in the model {})", short(set), short(number)),
            (Some(set), None) => format!("{} (set)", short(set)),
            (None, Some(number)) => short(number),
            (None, None) => written(model, &c.expression),
        };
        let tolerance = c.tolerance.as_ref().map(|t| format!(", tolerance {t}")).unwrap_or_default();
        table.rows.push(vec![c.name.clone(), value + &tolerance, comment_at(model, c.span)]);
    }
    table.html()
}

fn parameters(question: &Question) -> String {
    let model = question.model();
    if model.parameters().is_empty() {
        return paragraph("The model has no parameters.");
    }
    let mut table = Table::new("Parameters", &["name", "nominal", "domain", "meaning"]);
    for p in model.parameters() {
        let unit = p.unit.as_deref().map(|u| format!(" {u}")).unwrap_or_default();
        let with_unit = |value: &Rational| format!("{}{unit}", short(value));
        let value = question.nominal(&p.name).ok().flatten();
        let nominal = match (question.values_set().get(&p.name), value, &p.nominal_formula) {
            (Some(set), ..) => format!("{} (set)", with_unit(set)),
            (None, Some(nominal), None) => with_unit(&nominal),
            (None, Some(nominal), Some(formula)) => format!("{} = {}", with_unit(&nominal), written(model, formula)),
            (None, None, Some(formula)) => format!("none: {}", written(model, formula)),
            (None, None, None) => "none".to_owned(),
        };
        let tolerance = p.tolerance.as_ref().map(|t| format!(", tolerance {t}")).unwrap_or_default();
        let domain = match (&p.min, &p.max) {
            (None, None) => "all".to_owned(),
            (Some(low), None) => format!("{} {}", if p.closed { ">=" } else { ">" }, short(low)),
            (None, Some(high)) => format!("{} {}", if p.closed { "<=" } else { "<" }, short(high)),
            (Some(low), Some(high)) => {
                format!("{} .. {}{}", short(low), short(high), if p.closed { ", ends included" } else { "" })
            }
        };
        let said = p.description.clone().filter(|d| !d.is_empty());
        let meaning = said.unwrap_or_else(|| comment_at(model, p.span));
        table.rows.push(vec![p.name.clone(), nominal + &tolerance, domain, meaning]);
    }
    table.html()
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_engine::error::Source;
    use jurist_engine::problem::Ask;

    #[test]
    fn comments_are_read_from_the_line_and_not_from_a_string() {
        let text = "title = 'a'\ntime = 'discrete'\n[constants]\na = 1 # one, V\nb = \"2\" # '#' two\n[parameters]\n\
                    K = { nominal = 1, description = \"gain # 1\" }\n[loop]\ncharacteristic = 'z - K*a/b'\n";
        let (model, _) = Model::from_toml(&Source::new("m.toml", text)).unwrap();
        let said: Vec<String> = model.constants().iter().map(|c| comment_at(&model, c.span)).collect();
        assert_eq!(said, ["one, V", "'#' two"]);
        assert_eq!(comment_at(&model, model.parameters()[0].span), "");
        let html = section(&model.ask());
        assert!(html.contains("gain # 1") && html.contains("'#' two"), "{html}");
    }

    #[test]
    fn a_frame_and_its_angle_are_in_the_table() {
        let text = "time = 'discrete'\nsample_time = 1\n[parameters]\nw = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\n\
                    name = 'motor'\ninput = 'r - y'\noutput = 'y'\ntransfer = '1/(s + 1)'\n\
                    discretize = { method = 'zoh', frame = 'w', delay = 1, advance = '2*w' }\n";
        let html = section(&Model::from_toml(&Source::new("m.toml", text)).unwrap().0.ask());
        assert!(
            html.contains("in the frame of <i>w</i>, sample time 1, dead time 1, commands turned ahead by 2"),
            "{html}"
        );
        let still = text.replace("frame = 'w'", "frame = 0");
        assert!(!section(&Model::from_toml(&Source::new("m.toml", still)).unwrap().0.ask()).contains("in the frame"));
    }

    #[test]
    fn rates_change_where_the_table_says_so() {
        let text = "time = 'discrete'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'slow'\n\
                    input = 'r - y'\noutput = 'u'\ngain = 'K'\nevery = 10\nphase = 3\n[[block]]\nname = 'fast'\ninput = 'u'\noutput = 'y'\n\
                    transfer = '1/(2*z - 1)'\n";
        let model = |text: &str| Model::from_toml(&Source::new("m.toml", text)).unwrap().0;
        let html = section(&model(text).ask());
        assert!(
            html.contains("every 10, phase 3; samples <i>y</i>; holds <i>u</i>") && html.contains("each sample"),
            "{html}"
        );
        assert!(!section(&model(&text.replace("every = 10\nphase = 3\n", "")).ask()).contains("each sample"));
    }
}
