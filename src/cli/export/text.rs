//! A script as a text.

use super::formula_text::{decimal, formula};
use super::{Block, Body, Diagram, Grid, Matrices, Sampling, Script, Step, System, Target};
use jurist_engine::model::{Expression, Node};

/// Lines longer than this are broken.
const WIDTH: usize = 110;

/// The lines of a script, each with its remark.
struct Lines<'t> {
    target: &'t dyn Target,
    lines: Vec<(String, String)>,
}

/// The text of a script.
pub(super) fn text(script: &Script, target: &dyn Target) -> String {
    let mut body = Lines { target, lines: Vec::new() };
    body.variables(script);
    body.step(&script.step);
    let mut rest = Lines { target, lines: Vec::new() };
    rest.body(&script.body);
    let code: Vec<&str> = body.lines.iter().chain(&rest.lines).map(|(code, _)| code.as_str()).collect();
    let wanted: Vec<&(&str, &[&str])> =
        target.helpers().iter().filter(|(name, _)| code.iter().any(|line| has_word(line, name))).collect();
    let helper_lines = || wanted.iter().flat_map(|(_, lines)| lines.iter().copied());
    let uses = |name: &str| code.iter().copied().chain(helper_lines()).any(|line| has_word(line, name));
    let comment = target.comment();
    let mut out: Vec<String> = script.head.iter().map(|line| format!("{comment} {line}")).collect();
    out.push(String::new());
    out.extend(target.preamble(&uses));
    out.extend(body.text());
    for (_, lines) in &wanted {
        out.push(String::new());
        out.extend(lines.iter().map(|line| (*line).to_owned()));
    }
    // Where two blank lines stand before a function they stand behind the last one, too.
    out.extend(wanted.last().filter(|(_, lines)| lines[0].is_empty()).map(|_| String::new()));
    out.push(String::new());
    out.extend(rest.text());
    out.push(String::new());
    out.extend(target.print_poles(matches!(script.body, Body::Polynomial { .. })));
    out.join("\n") + "\n"
}

/// Whether a name occurs in a line as a whole word.
fn has_word(line: &str, name: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    line.match_indices(name)
        .any(|(at, _)| !line[..at].ends_with(is_part) && !line[at + name.len()..].starts_with(is_part))
}

impl Lines<'_> {
    fn text(&self) -> Vec<String> {
        let comment = self.target.comment();
        let line = |(code, remark): &(String, String)| match (code.is_empty(), remark.is_empty()) {
            (_, true) => code.clone(),
            (true, _) => format!("{comment} {remark}"),
            _ => format!("{code}  {comment} {remark}"),
        };
        self.lines.iter().map(line).collect()
    }

    fn remark(&mut self, text: impl Into<String>) {
        let text: String = text.into();
        let mut line = String::new();
        for word in text.split(' ') {
            if !line.is_empty() && line.len() + word.len() > WIDTH {
                self.lines.push((String::new(), std::mem::take(&mut line)));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        self.lines.push((String::new(), line));
    }

    fn blank(&mut self) {
        self.lines.push(Default::default());
    }

    fn set(&mut self, name: &str, value: &str) {
        self.lines.push((format!("{name} = {value}{}", self.target.end()), String::new()));
    }

    fn variables(&mut self, script: &Script) {
        if script.variables.is_empty() {
            return;
        }
        self.blank();
        self.remark("Parameters and constants.");
        let width = script.width();
        for v in &script.variables {
            let value = match &v.value.node {
                // With a point, so that it is no integer in any program.
                Node::Number(value) => decimal(value),
                _ => formula(self.target, &v.value),
            };
            let code = format!("{:width$} = {value}{}", v.name, self.target.end());
            self.lines.push((code, v.remark.clone()));
        }
    }

    fn step(&mut self, step: &Step) {
        self.blank();
        let (value, remark) = match step {
            Step::Continuous => ("0".to_owned(), "continuous time"),
            Step::Unknown => (self.target.unknown_step().to_owned(), "discrete time; the model names no sample time"),
            Step::Time(time) => (formula(self.target, time), "time from one sample to the next"),
        };
        self.set("dt", &value);
        self.lines.last_mut().expect("there is a line").1 = remark.to_owned();
    }

    fn body(&mut self, body: &Body) {
        match body {
            Body::Polynomial { coefficients, remark } => {
                self.remark(remark.clone());
                let list = self.list(coefficients);
                self.set("coefficients", &list);
                self.set("poles", "roots(coefficients)");
            }
            Body::ClosedLoop { system, remark } => {
                self.remark(remark.clone());
                for (name, grid) in ["A", "B", "C", "D"].into_iter().zip(system.grids()) {
                    let grid = self.grid(grid);
                    self.set(name, &grid);
                }
                self.set("closed_loop", "ss(A, B, C, D, dt)");
            }
            Body::OutputFeedback { matrices, entries, outputs } => {
                self.remark("The plant and its feedback u = -K y, y = C x.");
                for (name, grid) in matrices {
                    let grid = self.grid(grid);
                    self.set(name, &grid);
                }
                self.blank();
                self.remark("How inputs enter, and what the outputs are.");
                let direct = Grid::zeros(outputs.rows, entries.columns);
                for (name, grid) in [("entries", entries), ("selection", outputs), ("direct", &direct)] {
                    let grid = self.grid(grid);
                    self.set(name, &grid);
                }
                let times = self.target.times();
                self.set("closed_loop", &format!("ss(A - B{times}K{times}C, entries, selection, direct, dt)"));
            }
            Body::Diagram(diagram) => self.diagram(diagram),
        }
    }

    fn diagram(&mut self, diagram: &Diagram) {
        for Block { name, remark, system } in &diagram.blocks {
            self.remark(remark.clone());
            let system = self.system(system, "dt");
            self.set(name, &system);
        }
        self.blank();
        self.remark("The inputs of all blocks are connection*(outputs of all blocks) + entries*(external inputs).");
        let names: Vec<&str> = diagram.blocks.iter().map(|block| block.name.as_str()).collect();
        match names.as_slice() {
            [only] => self.set("blocks", only),
            all => self.set("blocks", &self.call("append", all.iter().map(|name| (*name).to_owned()).collect())),
        }
        let connection = self.grid(&diagram.connection);
        self.set("connection", &connection);
        let mut closed = "feedback(blocks, connection, 1)".to_owned();
        if let Some(selection) = &diagram.selection {
            let selection = self.grid(selection);
            self.set("selection", &selection);
            closed = format!("selection*{closed}");
        }
        if let Some(entries) = &diagram.entries {
            let entries = self.grid(entries);
            self.set("entries", &entries);
            closed.push_str("*entries");
        }
        if let Some(direct) = &diagram.direct {
            let direct = self.grid(direct);
            self.set("direct", &direct);
            closed.push_str(" + gain(direct)");
        }
        let list = |names: &[String], other: &str| if names.is_empty() { other.to_owned() } else { names.join(", ") };
        self.blank();
        let inputs = list(&diagram.inputs, "those of the blocks");
        self.remark(format!("Inputs: {inputs}. Outputs: {}.", list(&diagram.outputs, "those of the blocks")));
        self.set("closed_loop", &closed);
    }

    fn system(&self, system: &System, step: &str) -> String {
        match system {
            System::Gain(grid) => format!("gain({})", self.grid(grid)),
            System::Transfer { numerator, denominator } => {
                let list = |factors: &[Vec<Expression>]| {
                    let mut lists = factors.iter().map(|list| self.list(list));
                    let first = lists.next().unwrap_or_else(|| "[1]".to_owned());
                    lists.fold(first, |product, list| format!("conv({product}, {list})"))
                };
                self.call("realise", vec![list(numerator), list(denominator), step.to_owned()])
            }
            System::StateSpace(matrices) => self.state_space(matrices, step),
            System::Sampled(inner, how) => {
                let inner = self.system(inner, "0");
                match how {
                    Sampling::Named(word) => format!("c2d({inner}, dt, '{word}')"),
                    Sampling::Forward(time) => format!("forward({inner}, {})", formula(self.target, time)),
                    Sampling::Backward(time) => format!("backward({inner}, {})", formula(self.target, time)),
                    Sampling::Bilinear(factor) => format!("bilinear({inner}, {})", formula(self.target, factor)),
                }
            }
        }
    }

    fn state_space(&self, matrices: &Matrices, step: &str) -> String {
        let grids = matrices.grids().into_iter().map(|grid| self.grid(grid));
        self.call("ss", grids.chain([step.to_owned()]).collect())
    }

    /// A call of a function, its arguments on lines of their own where they are long.
    fn call(&self, function: &str, arguments: Vec<String>) -> String {
        let length: usize = arguments.iter().map(|a| a.len() + 2).sum();
        if length <= WIDTH && arguments.iter().all(|a| !a.contains('\n')) {
            return format!("{function}({})", arguments.join(", "));
        }
        let continued = self.target.continued();
        let arguments: Vec<String> = arguments.iter().map(|a| format!("    {a}")).collect();
        format!("{function}({continued}\n{})", arguments.join(&format!(",{continued}\n")))
    }

    fn list(&self, list: &[Expression]) -> String {
        format!("[{}]", list.iter().map(|e| formula(self.target, e)).collect::<Vec<_>>().join(", "))
    }

    fn grid(&self, grid: &Grid) -> String {
        let is_small = grid.rows * grid.columns <= 1;
        if grid.rows == 0 || grid.columns == 0 || (grid.is_zero() && !is_small) {
            return self.target.of_size("zeros", grid.rows, grid.columns);
        }
        if grid.is_identity() && !is_small {
            return self.target.of_size("eye", grid.rows, grid.columns);
        }
        let rows: Vec<Vec<String>> =
            grid.entries.iter().map(|row| row.iter().map(|e| formula(self.target, e)).collect()).collect();
        self.target.matrix(&rows)
    }
}
