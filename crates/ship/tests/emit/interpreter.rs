//! A processor of structured text.

use crate::cases::{Case, Signal};
use crate::compiled::runs;
use crate::parser::{Parser, Step, Tree, Unit};
use jurist_algebra::number::Rational;
use jurist_ship::emit::Target;
use std::collections::HashMap;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Bool(bool),
    Lint(i64),
    Real(f32),
    Lreal(f64),
}

impl Value {
    fn number(kind: &str, text: &str) -> Value {
        match kind {
            "LINT" => Value::Lint(text.parse().expect("an integer")),
            "REAL" => Value::Real(text.parse().expect("a number")),
            "LREAL" => Value::Lreal(text.parse().expect("a number")),
            _ => panic!("{kind} is no type of numbers"),
        }
    }

    fn kind(self) -> &'static str {
        match self {
            Value::Bool(_) => "BOOL",
            Value::Lint(_) => "LINT",
            Value::Real(_) => "REAL",
            Value::Lreal(_) => "LREAL",
        }
    }

    fn binary(self, operator: &str, other: Value) -> Value {
        fn compare<T: PartialOrd>(operator: &str, a: T, b: T) -> Value {
            Value::Bool(match operator {
                "=" => a == b,
                "<>" => a != b,
                "<" => a < b,
                ">" => a > b,
                _ => panic!("{operator} is none of these numbers"),
            })
        }
        match (self, operator, other) {
            (Value::Bool(a), "AND", Value::Bool(b)) => Value::Bool(a && b),
            (Value::Lint(a), _, Value::Lint(b)) => Value::Lint(match operator {
                "+" => a.checked_add(b).expect("no overflow"),
                "-" => a.checked_sub(b).expect("no overflow"),
                "*" => a.checked_mul(b).expect("no overflow"),
                "/" => a.checked_div(b).expect("no overflow"),
                "MOD" => a.checked_rem(b).expect("no overflow"),
                _ => return compare(operator, a, b),
            }),
            (Value::Real(a), "+", Value::Real(b)) => Value::Real(a + b),
            (Value::Real(a), "-", Value::Real(b)) => Value::Real(a - b),
            (Value::Real(a), "*", Value::Real(b)) => Value::Real(a * b),
            (Value::Lreal(a), "+", Value::Lreal(b)) => Value::Lreal(a + b),
            (Value::Lreal(a), "-", Value::Lreal(b)) => Value::Lreal(a - b),
            (Value::Lreal(a), "*", Value::Lreal(b)) => Value::Lreal(a * b),
            _ => panic!("{self:?} {operator} {other:?}"),
        }
    }
}

/// Variables with their types; one that was not written yet has no value.
type Frame = HashMap<String, (String, Option<Value>)>;

/// A function block with its functions.
pub struct Machine {
    functions: HashMap<String, Unit>,
    block: Unit,
    frame: Frame,
}

impl Machine {
    pub fn new(text: &str) -> Machine {
        let (mut blocks, functions): (Vec<Unit>, Vec<Unit>) =
            Parser::units(text).into_iter().partition(|unit| unit.is_block);
        let block = blocks.pop().expect("a block");
        assert!(blocks.is_empty(), "one block");
        let functions = functions.into_iter().map(|unit| (unit.name.clone(), unit)).collect();
        let mut machine = Machine { functions, frame: HashMap::new(), block };
        machine.frame = machine.fresh(&machine.block);
        machine.frame.insert("RESET".into(), ("BOOL".into(), Some(Value::Bool(false))));
        machine
    }

    fn fresh(&self, unit: &Unit) -> Frame {
        let mut frame = Frame::new();
        for variable in &unit.variables {
            let initial = variable.initial.as_ref().map(|tree| self.value(tree, &frame));
            let before = frame.insert(variable.name.clone(), (variable.kind.clone(), initial));
            assert!(
                before.is_none() && !self.functions.contains_key(&variable.name),
                "{} is there twice",
                variable.name
            );
        }
        assert!(!frame.contains_key(&unit.name), "{} is there twice", unit.name);
        frame
    }

    fn names(&self, is_asked: impl Fn(&str) -> bool) -> Vec<String> {
        self.block.variables.iter().filter(|v| is_asked(&v.section)).map(|v| v.name.clone()).collect()
    }

    /// The outputs and then the states after a sample.
    fn call(&mut self, inputs: &[Value]) -> Vec<Value> {
        let mut frame = std::mem::take(&mut self.frame);
        let names = self.names(|section| section == "VAR_INPUT");
        assert_eq!(names.len(), inputs.len() + 1, "inputs, and the one that resets");
        for (name, value) in names[1..].iter().zip(inputs) {
            set(&mut frame, name, *value);
        }
        for variable in self.block.variables.iter().filter(|v| v.section == "VAR_TEMP") {
            frame.get_mut(&variable.name).expect("it is declared").1 = None;
        }
        self.run(&self.block.body, &mut frame);
        self.frame = frame;
        let asked = [self.names(|section| section == "VAR_OUTPUT"), self.names(|section| section == "VAR")].concat();
        asked.iter().map(|name| self.frame[name].1.expect("it is written")).collect()
    }

    fn run(&self, steps: &[Step], frame: &mut Frame) {
        for step in steps {
            match step {
                Step::Set(name, tree) => {
                    let value = self.value(tree, frame);
                    set(frame, name, value);
                }
                Step::If(branches, otherwise) => {
                    let taken =
                        branches.iter().find(|(condition, _)| self.value(condition, frame) == Value::Bool(true));
                    self.run(taken.map_or(otherwise, |(_, steps)| steps), frame);
                }
            }
        }
    }

    fn value(&self, tree: &Tree, frame: &Frame) -> Value {
        match tree {
            Tree::Number(Some(kind), text) => Value::number(kind, text),
            // Without a type a literal may have 32 bits.
            Tree::Number(None, text) => Value::Lint(text.parse::<i32>().expect("32 bits").into()),
            Tree::Name(name) => {
                let (_, value) = frame.get(name).unwrap_or_else(|| panic!("{name} is not declared"));
                value.unwrap_or_else(|| panic!("{name} is read before it is written"))
            }
            Tree::Negative(of) => match self.value(of, frame) {
                Value::Lint(value) => Value::Lint(value.checked_neg().expect("no overflow")),
                Value::Real(value) => Value::Real(-value),
                Value::Lreal(value) => Value::Lreal(-value),
                Value::Bool(_) => panic!("a sign before {of:?}"),
            },
            Tree::Binary(operator, left, right) => self.value(left, frame).binary(operator, self.value(right, frame)),
            Tree::Call(name, argument) => {
                let function = self.functions.get(name).unwrap_or_else(|| panic!("no function {name}"));
                let mut inner = self.fresh(function);
                inner.insert(name.clone(), (function.kind.clone().expect("a function has a type"), None));
                let [argument_name] = ["VAR_INPUT"].map(|section| {
                    function.variables.iter().find(|v| v.section == section).expect("an argument").name.clone()
                });
                set(&mut inner, &argument_name, self.value(argument, frame));
                self.run(&function.body, &mut inner);
                inner[name].1.expect("a function has a value")
            }
        }
    }
}

fn set(frame: &mut Frame, name: &str, value: Value) {
    let variable = frame.get_mut(name).unwrap_or_else(|| panic!("{name} is not declared"));
    assert_eq!(variable.0, value.kind(), "{name}");
    variable.1 = Some(value);
}

fn value_of(case: &Case, word: i64) -> Value {
    match case.signal() {
        Signal::Integer => Value::Lint(word),
        Signal::Single => Value::Real(f32::from_bits(word as u32)),
        Signal::Double => Value::Lreal(f64::from_bits(word as u64)),
    }
}

fn rational(value: Value) -> Rational {
    match value {
        Value::Lint(value) => value.into(),
        Value::Real(value) => Rational::from_f64(value.into()).expect("finite"),
        Value::Lreal(value) => Rational::from_f64(value).expect("finite"),
        Value::Bool(_) => panic!("no number"),
    }
}

/// Runs a controller in structured text, and compares it with the exact run; how many samples were compared.
pub fn compare(case: &Case, inputs: &[Vec<i64>], rows: &[Vec<Rational>]) -> usize {
    let mut machine = Machine::new(&case.text(Target::StructuredText, &[]).unwrap());
    for (at, (sample, expected)) in inputs.iter().zip(rows).enumerate() {
        let values: Vec<Value> = sample.iter().map(|word| value_of(case, *word)).collect();
        let found: Vec<Rational> = machine.call(&values).into_iter().map(rational).collect();
        assert_eq!(&found, expected, "{} ({:?}), sample {at}, input {sample:?}", case.name, case.numbers);
    }
    rows.len()
}

#[test]
#[ignore = "long: CI runs it"]
fn structured_text_computes_what_the_exact_run_computes() {
    let runs = runs();
    // A tree that is walked takes longer than a program.
    let part = |run: &crate::compiled::Run| run.rows.len().div_ceil(8);
    let counts = runs.iter().map(|run| compare(&run.case, &run.inputs, &run.rows[..part(run)]));
    println!("structured text: {} samples of {} controllers", counts.sum::<usize>(), runs.len());
}

#[test]
fn a_reset_brings_a_block_to_rest() {
    let run = &runs()[0];
    let mut machine = Machine::new(&run.case.text(Target::StructuredText, &[]).unwrap());
    let call = |machine: &mut Machine, at: usize| {
        machine.call(&run.inputs[at].iter().map(|w| value_of(&run.case, *w)).collect::<Vec<_>>())
    };
    let first = call(&mut machine, 0);
    for at in 1..40 {
        call(&mut machine, at);
    }
    set(&mut machine.frame, "RESET", Value::Bool(true));
    assert_eq!(call(&mut machine, 0), first);
}
