//! The names of parameters, constants and blocks in a script.

use super::formula::of_node;
use super::{Block, Body, Diagram, Grid, Matrices, Sampling, Script, Step, System, Target, Variable};
use jurist_engine::model::{Expression, Form, Model, Node};
use std::collections::{BTreeMap, BTreeSet};

/// What each name of a model is called in a script.
pub(super) struct Names {
    variables: BTreeMap<String, String>,
    blocks: Vec<String>,
}

/// Names that every script has itself.
const OWN: [&str; 20] = [
    "blocks",
    "connection",
    "entries",
    "selection",
    "direct",
    "closed_loop",
    "dt",
    "gain",
    "realise",
    "forward",
    "backward",
    "bilinear",
    "A",
    "B",
    "C",
    "K",
    "D",
    "coefficients",
    "poles",
    "pole",
];

impl Names {
    pub fn of(model: &Model, target: &dyn Target) -> Names {
        let mut used: BTreeSet<String> = target.reserved().concat().iter().map(|name| (*name).to_owned()).collect();
        // A diagram has no matrices of the whole loop beside its blocks.
        let is_diagram = matches!(model.form(), Form::Blocks(_)) && model.hyperperiod() == 1;
        used.extend(OWN.iter().filter(|name| !is_diagram || name.len() > 1).map(|name| (*name).to_owned()));
        let mut variables = BTreeMap::new();
        let own = model.parameters().iter().map(|p| &p.name).chain(model.constants().iter().map(|c| &c.name));
        for name in own {
            variables.insert(name.clone(), free(name, "_", &mut used));
        }
        let diagram = match model.form() {
            Form::Blocks(diagram) => diagram.blocks.as_slice(),
            _ => &[],
        };
        let blocks = diagram.iter().map(|block| free(&block.name, "_block", &mut used)).collect();
        Names { variables, blocks }
    }

    fn expression(&self, e: &Expression) -> Expression {
        let inner = |e: &Expression| Box::new(self.expression(e));
        of_node(match &e.node {
            Node::Number(value) => Node::Number(value.clone()),
            Node::Name(name) => Node::Name(self.variables.get(name).unwrap_or(name).clone()),
            Node::Negative(e) => Node::Negative(inner(e)),
            Node::Sum(terms) => Node::Sum(terms.iter().map(|(sign, e)| (*sign, self.expression(e))).collect()),
            Node::Product(factors) => {
                Node::Product(factors.iter().map(|(factor, e)| (*factor, self.expression(e))).collect())
            }
            Node::Power(e, exponent) => Node::Power(inner(e), *exponent),
            Node::Call(function, e) => Node::Call(*function, inner(e)),
        })
    }

    fn list(&self, list: Vec<Expression>) -> Vec<Expression> {
        list.iter().map(|e| self.expression(e)).collect()
    }

    fn grid(&self, grid: Grid) -> Grid {
        Grid { entries: grid.entries.into_iter().map(|row| self.list(row)).collect(), ..grid }
    }

    fn matrices(&self, m: Matrices) -> Matrices {
        Matrices { a: self.grid(m.a), b: self.grid(m.b), c: self.grid(m.c), d: self.grid(m.d) }
    }

    fn system(&self, system: System) -> System {
        let lists = |all: Vec<Vec<Expression>>| all.into_iter().map(|list| self.list(list)).collect();
        match system {
            System::Gain(grid) => System::Gain(self.grid(grid)),
            System::Transfer { numerator, denominator } => {
                System::Transfer { numerator: lists(numerator), denominator: lists(denominator) }
            }
            System::StateSpace(matrices) => System::StateSpace(self.matrices(matrices)),
            System::Sampled(inner, how) => {
                let how = match how {
                    Sampling::Named(word) => Sampling::Named(word),
                    Sampling::Forward(time) => Sampling::Forward(self.expression(&time)),
                    Sampling::Backward(time) => Sampling::Backward(self.expression(&time)),
                    Sampling::Bilinear(factor) => Sampling::Bilinear(self.expression(&factor)),
                };
                System::Sampled(Box::new(self.system(*inner)), how)
            }
        }
    }

    fn body(&self, body: Body) -> Body {
        match body {
            Body::Polynomial { coefficients, remark } => {
                Body::Polynomial { coefficients: self.list(coefficients), remark }
            }
            Body::ClosedLoop { system, remark } => Body::ClosedLoop { system: self.matrices(system), remark },
            Body::OutputFeedback { matrices, entries, outputs } => Body::OutputFeedback {
                matrices: matrices.map(|(name, grid)| (name, self.grid(grid))),
                entries: self.grid(entries),
                outputs: self.grid(outputs),
            },
            Body::Diagram(diagram) => {
                let named = |(block, name): (Block, &String)| Block {
                    name: name.clone(),
                    system: self.system(block.system),
                    remark: block.remark,
                };
                Body::Diagram(Diagram {
                    blocks: diagram.blocks.into_iter().zip(&self.blocks).map(named).collect(),
                    connection: self.grid(diagram.connection),
                    entries: diagram.entries.map(|grid| self.grid(grid)),
                    selection: diagram.selection.map(|grid| self.grid(grid)),
                    direct: diagram.direct.map(|grid| self.grid(grid)),
                    ..diagram
                })
            }
        }
    }

    /// The script with its names, each variable with the name that it has in the model where that is another one.
    pub fn renamed(&self, script: Script) -> Script {
        let variable = |v: Variable| {
            let name = self.variables.get(&v.name).unwrap_or(&v.name).clone();
            let remark = match (name == v.name, v.remark.is_empty()) {
                (true, _) => v.remark,
                (false, true) => v.name,
                (false, false) => format!("{}: {}", v.name, v.remark),
            };
            Variable { value: self.expression(&v.value), name, remark }
        };
        let step = match script.step {
            Step::Time(time) => Step::Time(self.expression(&time)),
            step => step,
        };
        Script {
            variables: script.variables.into_iter().map(variable).collect(),
            step,
            body: self.body(script.body),
            head: script.head,
        }
    }
}

/// A name that is not used yet: ASCII letters, digits and underscores, a letter first.
fn free(name: &str, suffix: &str, used: &mut BTreeSet<String>) -> String {
    /// Longer names are cut: MATLAB knows 63 letters.
    const LONGEST: usize = 48;
    let plain = name.chars().take(LONGEST).map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let plain: String = plain.collect();
    let plain = if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("x{plain}") };
    let more = (2..).map(|k| format!("{plain}{suffix}{k}"));
    let mut all = [plain.clone(), format!("{plain}{suffix}")].into_iter().chain(more);
    let found = all.find(|name| !used.contains(name)).expect("there is no end of names");
    used.insert(found.clone());
    found
}
