//! How large signals become inside of a controller, and what the rounding of signals adds.

use crate::emit::numbered;
use crate::program::{LinearSystem, Operand};
use crate::realise::Entry;
use crate::run::FixedProgram;
use crate::shipped::{Shipped, question_of};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_engine::error::Error;
use jurist_engine::model::{Form, Model};
use jurist_engine::problem::Problem;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bounds of signals, from rest and while nothing leaves its range.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Ranges {
    /// The controller's inputs, then its inner signals in the order of the operations.
    pub nodes: Vec<NodeRange>,
    /// By how much rounding can move each output of the loop, in the end and at any time. None where signals are not rounded.
    pub moved: Vec<Moved>,
    /// The loop in which each inner signal is an output, and each rounding error an input.
    pub problem: Arc<Problem>,
}

/// By how much rounding can move an output of the loop: a bound of all limit cycles.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Moved {
    /// The output.
    pub output: String,
    /// By the rounding of the controller's own signals.
    pub by_signals: Rational,
    /// By that, and its inputs rounded to the format of signals as well: a controller in fixed point takes integers.
    pub with_inputs: Rational,
}

/// The range of an inner signal.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NodeRange {
    /// Its name in the controller.
    pub name: String,
    /// Its name as an output of the loop in [`Ranges::problem`].
    pub output: String,
    /// Its greatest magnitude under all inputs within their bounds, between two numbers; `None` without bounds.
    pub greatest: Option<[Rational; 2]>,
    /// What the rounding of the controller's own signals adds at most.
    pub rounding: Rational,
    /// The same with its inputs rounded to the format of signals as well.
    pub with_inputs: Rational,
    /// The greatest number of its format.
    pub limit: Option<Rational>,
    /// Whether it stays within; `None` where that is not said by these bounds.
    pub holds: Option<bool>,
}

/// Inputs that bring an inner signal near to its greatest magnitude, from rest.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct WorstInput {
    /// The inner signal, by its name in the controller.
    pub node: String,
    /// Its name as an output of the loop in [`Ranges::problem`].
    pub output: String,
    /// Each input at each sample; the signal is large at the last one.
    pub inputs: Vec<(String, Vec<Rational>)>,
}

/// The most samples of a worst input.
const MOST_SAMPLES: usize = 50_000;

impl Ranges {
    /// The worst input of the signal that uses most of its range, or is greatest where nothing is said of ranges. `None` without bounds of inputs.
    ///
    /// Cost: that of [`Problem::peak_to_peak`] for each input.
    ///
    /// # Errors
    /// As [`Problem::peak_to_peak`].
    pub fn worst_input(&self, bounds: &[(String, Rational)], budget: &Budget) -> Result<Option<WorstInput>, Error> {
        let share = |node: &NodeRange| {
            let [_, high] = node.greatest.as_ref()?;
            let all = high + &node.with_inputs;
            Some(node.limit.as_ref().and_then(|limit| all.checked_div(limit)).unwrap_or(all))
        };
        let Some(node) = self.nodes.iter().filter(|node| node.greatest.is_some()).max_by_key(|node| share(node)) else {
            return Ok(None);
        };
        let names: Vec<&str> = bounds.iter().map(|(name, _)| name.as_str()).collect();
        let samples = self.samples_that_matter(&names, &node.output, budget)?;
        let mut found = Vec::new();
        for (input, bound) in bounds {
            let gain = self.problem.peak_to_peak(input, &node.output, DIGITS, budget)?.into_value();
            found.push((input.clone(), gain.signs(samples, budget)?, bound));
        }
        let of = |(input, signs, bound): (String, Vec<i8>, &Rational)| {
            let value = |sign: &i8| bound * &Rational::from(i64::from(*sign));
            (input, signs.iter().rev().map(value).collect())
        };
        let inputs = found.into_iter().map(of).collect();
        Ok(Some(WorstInput { node: node.name.clone(), output: node.output.clone(), inputs }))
    }

    /// How many samples of the impulse responses have all but a thousandth of the sum of their absolute values, in floating point.
    fn samples_that_matter(&self, inputs: &[&str], output: &str, budget: &Budget) -> Result<usize, Error> {
        let Some(system) = self.problem.rounded_closed_loop(budget)? else { return Ok(1) };
        let model = self.problem.model();
        let row = model.outputs().iter().position(|o| o.name.name == output).unwrap_or(0);
        let columns = model.inputs().iter().enumerate().filter(|(_, name)| inputs.contains(&name.name.as_str()));
        let mut most = 1;
        for (column, _) in columns {
            let mut sums = vec![system.d[row][column].abs()];
            let mut x: Vec<f64> = system.b.iter().map(|b| b[column]).collect();
            let dot = |a: &[f64], x: &[f64]| a.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
            while sums.len() < MOST_SAMPLES {
                budget.check()?;
                sums.push(sums[sums.len() - 1] + dot(&system.c[row], &x).abs());
                x = system.a.iter().map(|a| dot(a, &x)).collect();
            }
            let enough = 0.999 * sums[sums.len() - 1];
            most = most.max(sums.partition_point(|sum| *sum < enough) + 1);
        }
        Ok(most)
    }
}

/// An input and an output of the loop.
type Ends = (String, String);

/// The peak-to-peak gains of a loop, each found once, though several sums have it.
struct Peaks<'p> {
    problem: &'p Arc<Problem>,
    known: RefCell<BTreeMap<Ends, Option<[Rational; 2]>>>,
    budget: &'p Budget,
}

impl Peaks<'_> {
    /// `None` for a loop that is not stable.
    fn gain(&self, input: &str, output: &str) -> Result<Option<[Rational; 2]>, Error> {
        let key = (input.to_owned(), output.to_owned());
        if let Some(found) = self.known.borrow().get(&key) {
            return Ok(found.clone());
        }
        let found = self.problem.peak_to_peak(input, output, DIGITS, self.budget)?;
        let ends = found.value().gain.as_ref().map(|gain| [gain.lower.clone(), gain.upper.clone()]);
        self.known.borrow_mut().insert(key, ends.clone());
        Ok(ends)
    }

    /// How large an output gets by inputs with these bounds.
    fn sum(&self, sources: &[(String, Rational)], output: &str) -> Result<Option<[Rational; 2]>, Error> {
        let mut total = [Rational::ZERO, Rational::ZERO];
        for (input, bound) in sources {
            let Some([low, high]) = self.gain(input, output)? else { return Ok(None) };
            total = [&total[0] + &(&low * bound), &total[1] + &(&high * bound)];
        }
        // Exact sums may be fractions of hundreds of digits.
        let [low, high] = total;
        let short = Enclosure::new(low, high).rounded(BITS);
        Ok(Some([short.lower().clone(), short.upper().clone()]))
    }
}

/// Bits behind the point of bounds, which are rounded outwards.
const BITS: u64 = 96;

/// Digits to which gains are known.
const DIGITS: usize = 9;

impl Shipped {
    /// The ranges of the controller's inner signals. `None` for a loop that is not stable.
    ///
    /// Cost: that of [`Problem::peak_to_peak`] for each inner signal and output, from each input with a bound and each rounding.
    ///
    /// # Errors
    /// As [`Problem::peak_to_peak`].
    pub fn ranges(&self, budget: &Budget) -> Result<Option<Ranges>, Error> {
        let names = Names::of(self);
        let problem = question_of(&self.rounded, self.ranges_text(&names))?.problem()?;
        let unit = self.asked.signal.map(|signal| signal.unit());
        let error = self.asked.signal.map_or(Rational::ZERO, |signal| {
            let (least, greatest) = signal.rounding.error_in_halves();
            Rational::new(least.abs().max(greatest.abs()).into(), 2.into())
        });
        let error = unit.map_or(Rational::ZERO, |unit| unit * error);
        let peaks = Peaks { problem: &problem, known: RefCell::default(), budget };
        let sum = |sources: &[(String, Rational)], output: &str| peaks.sum(sources, output);
        let errors: Vec<(String, Rational)> =
            names.errors.iter().flatten().map(|name| (name.clone(), error.clone())).collect();
        let input_errors: Vec<(String, Rational)> = match self.asked.signal {
            Some(_) => names.input_errors.iter().map(|name| (name.clone(), error.clone())).collect(),
            None => Vec::new(),
        };
        let all: Vec<(String, Rational)> = errors.iter().chain(&input_errors).cloned().collect();
        let mut nodes = Vec::new();
        let own = self.realised.program.nodes.iter().map(|node| node.name.clone());
        let of_code = names.code_inputs.iter().cloned().chain(own);
        for (name, output) in of_code.zip(names.inputs.iter().chain(&names.nodes)) {
            let greatest = sum(&self.asked.inputs, output)?;
            let Some([_, rounding]) = sum(&errors, output)? else { return Ok(None) };
            let Some([_, with_inputs]) = sum(&all, output)? else { return Ok(None) };
            let greatest = greatest.filter(|_| !self.asked.inputs.is_empty());
            let limit = self.asked.signal.map(|signal| signal.value(&signal.integers().1));
            let holds = limit.as_ref().zip(greatest.as_ref()).and_then(|(limit, [low, high])| {
                if high + &with_inputs <= *limit {
                    return Some(true);
                }
                (low - &with_inputs > *limit).then_some(false)
            });
            nodes.push(NodeRange { name, output: output.clone(), greatest, rounding, with_inputs, limit, holds });
        }
        let mut moved = Vec::new();
        for output in self.exact.model().outputs().iter().filter(|_| !all.is_empty()) {
            let output = output.name.name.clone();
            let Some([_, by_signals]) = sum(&errors, &output)? else { return Ok(None) };
            let Some([_, with_inputs]) = sum(&all, &output)? else { return Ok(None) };
            moved.push(Moved { output, by_signals, with_inputs });
        }
        Ok(Some(Ranges { nodes, moved, problem }))
    }

    /// The program in fixed point, where coefficients and signals are.
    pub fn fixed_program(&self) -> Option<FixedProgram<'_>> {
        let crate::format::Format::Fixed(format) = self.asked.format else { return None };
        let stored = self.coefficients.iter().map(|c| c.integer.clone()).collect::<Option<Vec<Integer>>>()?;
        Some(FixedProgram::new(&self.realised.program, stored, &format, self.asked.signal?, self.asked.overflow))
    }

    /// The text of a model in which the controller's inner signals are outputs, and its rounding errors inputs.
    fn ranges_text(&self, names: &Names) -> String {
        let model = self.rounded.model();
        let Form::Blocks(diagram) = model.form() else { return model.source().text.clone() };
        let Some(block) = diagram.blocks.iter().find(|block| block.name == self.asked.block) else {
            return model.source().text.clone();
        };
        let values: Vec<Rational> = self.coefficients.iter().map(|c| c.value.clone()).collect();
        let system = self.realised.program.system(&values);
        let own_errors: Vec<&String> = names.errors.iter().flatten().collect();
        let errors: Vec<&String> = names.input_errors.iter().chain(own_errors.iter().copied()).collect();
        // What reaches the controller is its input and the error of rounding it.
        let taken = block.inputs.iter().zip(&names.input_errors).map(|(input, error)| format!("{input} + {error}"));
        let inputs: Vec<String> = taken.chain(own_errors.iter().map(|e| (*e).clone())).collect();
        let outputs: Vec<String> =
            self.asked.outputs.iter().chain(&names.inputs).chain(&names.nodes).cloned().collect();
        let mut keys = vec![("input", list(&inputs)), ("output", list(&outputs))];
        keys.extend(self.matrices(&system, names));
        let text = model.with_block(&self.asked.block, &keys).unwrap_or_default();
        let all = |own: Vec<String>, more: Vec<String>| list(&own.into_iter().chain(more).collect::<Vec<_>>());
        let loop_inputs = model.inputs().iter().map(|name| name.name.clone()).collect();
        let loop_outputs = model.outputs().iter().map(|output| output.name.name.clone()).collect();
        let ports = [
            ("inputs", all(loop_inputs, errors.into_iter().cloned().collect())),
            ("outputs", all(loop_outputs, names.inputs.iter().chain(&names.nodes).cloned().collect())),
        ];
        Model::with_keys(&text, "loop", &ports)
    }

    /// The keys of the block's matrices: outputs are those of the controller, then its inputs and its nodes; inputs its own, then the errors.
    fn matrices(&self, system: &LinearSystem, names: &Names) -> Vec<(&'static str, String)> {
        let program = &self.realised.program;
        let is_kept = |column: usize| column < program.inputs || names.errors[column - program.inputs].is_some();
        let narrow = |row: &Vec<Rational>| -> Vec<Rational> {
            row.iter().enumerate().filter(|(k, _)| is_kept(*k)).map(|(_, x)| x.clone()).collect()
        };
        let of_output = |rows: &[Vec<Rational>], width: usize, first: usize| -> Vec<Vec<Rational>> {
            let row = |operand: &Operand| match operand {
                Operand::Node(at) => rows[*at].clone(),
                Operand::State(at) | Operand::Input(at) => {
                    let own = matches!(operand, Operand::State(_)) == (first == 0);
                    (0..width).map(|k| if own && k == *at { Rational::ONE } else { Rational::ZERO }).collect()
                }
            };
            let inputs = (0..program.inputs).map(|at| row(&Operand::Input(at)));
            program.outputs.iter().map(row).chain(inputs).chain(rows.iter().cloned()).collect()
        };
        let c = of_output(&system.c, system.a.len(), 0);
        let d: Vec<Vec<Rational>> =
            of_output(&system.d, program.inputs + program.nodes.len(), 1).iter().map(narrow).collect();
        if system.a.is_empty() {
            return vec![("D", rows(&d))];
        }
        let b: Vec<Vec<Rational>> = system.b.iter().map(narrow).collect();
        vec![("A", rows(&system.a)), ("B", rows(&b)), ("C", rows(&c)), ("D", rows(&d))]
    }
}

/// A matrix as a value in TOML.
fn rows(matrix: &[Vec<Rational>]) -> String {
    let row = |row: &Vec<Rational>| {
        let entries: Vec<String> = row.iter().map(|x| Entry::Number(x.clone()).toml()).collect();
        format!("[{}]", entries.join(", "))
    };
    format!("[{}]", matrix.iter().map(row).collect::<Vec<_>>().join(", "))
}

/// Texts as a value in TOML.
fn list(texts: &[String]) -> String {
    let texts: Vec<String> =
        texts.iter().map(|text| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))).collect();
    format!("[{}]", texts.join(", "))
}

/// Names of the signals that the loop gets.
struct Names {
    /// Of each input in the code.
    code_inputs: Vec<String>,
    /// Of each input as an output of the loop, and of the error of its rounding.
    inputs: Vec<String>,
    input_errors: Vec<String>,
    /// Of each node.
    nodes: Vec<String>,
    /// Of the error of each node that is rounded.
    errors: Vec<Option<String>>,
}

impl Names {
    fn of(shipped: &Shipped) -> Names {
        let text = &shipped.rounded.model().source().text;
        let unused = |name: String| {
            let mut name = name;
            while text.contains(&name) {
                name.push('x');
            }
            name
        };
        let rounded: Vec<bool> = match shipped.fixed_program() {
            Some(program) => program.sums.iter().map(|sum| sum.right > 0).collect(),
            None => vec![false; shipped.realised.program.nodes.len()],
        };
        let nodes = &shipped.realised.program.nodes;
        let code_inputs = numbered("u", shipped.realised.program.inputs);
        Names {
            inputs: code_inputs.iter().map(|name| unused(format!("ship_{name}"))).collect(),
            input_errors: code_inputs.iter().map(|name| unused(format!("ship_error_{name}"))).collect(),
            code_inputs,
            nodes: nodes.iter().map(|node| unused(format!("ship_{}", node.name))).collect(),
            errors: nodes
                .iter()
                .zip(rounded)
                .map(|(node, is)| is.then(|| unused(format!("ship_error_{}", node.name))))
                .collect(),
        }
    }
}
