//! A block as a system of its own.

use super::forms::grid;
use super::formula::{product, quotient, whole};
use super::fraction::{Fraction, Side, fraction};
use super::head::one_line;
use super::refusals::has_exponential;
use super::{Block, Grid, Matrices, Sampling, Step, System, forms};
use jurist_engine::model::{self, Discretization, Dynamics, Expression, Function, Model, Node};
use jurist_engine::problem::RoundedSystem;

/// The loop's step; where the model names none, the first that a block names.
pub(super) fn step_of(model: &Model, diagram: &model::Diagram) -> Step {
    match forms::step(model) {
        Step::Unknown => {
            let mut times = diagram.blocks.iter().filter_map(|b| b.discretization.as_ref()?.sample_time.as_ref());
            times.next().map_or(Step::Unknown, |time| Step::Time(time.clone()))
        }
        step => step,
    }
}

/// A block; where the other program has no exact form of what it does, its matrices in numbers.
pub(super) fn block(model: &Model, block: &model::Block, numbers: &RoundedSystem, step: &Step) -> Block {
    let variable = if block.discretization.is_some() { "s" } else { model.time().variable() };
    let order = numbers.a.len();
    let mut remark = vec![format!("{}: {}", block.name, described(&block.dynamics))];
    remark.extend(block.discretization.as_ref().map(Discretization::words));
    let written = dynamics(block, variable, order).filter(|system| system.order() == order);
    let written = match &block.discretization {
        // What has no states is the same by each rule and behind each hold, but for pulses and dead time.
        Some(d) if order == 0 && d.delay.is_none() && !d.method.is_modulated() => written,
        Some(d) => written.and_then(|system| {
            let how = sampling(block, d, step)?;
            Some(System::Sampled(Box::new(system), how))
        }),
        None => written,
    };
    let system = written.unwrap_or_else(|| {
        remark.push("jurist computed these matrices at the values above, and they do not follow changes".to_owned());
        in_numbers(numbers, block)
    });
    Block { name: block.name.clone(), remark: one_line(&remark.join("; ")), system }
}

/// What a block is, as the model says it.
fn described(dynamics: &Dynamics) -> String {
    /// Longer expressions are not repeated.
    const LONGEST: usize = 90;
    let text = match dynamics {
        Dynamics::Transfer(e) => e.to_string(),
        Dynamics::Gain(e) => format!("gain {e}"),
        Dynamics::Delay(e) => format!("delay in samples: {e}"),
        Dynamics::DeadTime(e) => format!("dead time {e}"),
        Dynamics::Ratio { .. } => "numerator and denominator".to_owned(),
        Dynamics::StateSpace { .. } => "state space".to_owned(),
        Dynamics::Static(_) => "matrix of gains".to_owned(),
    };
    if text.len() > LONGEST { "transfer function".to_owned() } else { text }
}

fn in_numbers(numbers: &RoundedSystem, block: &model::Block) -> System {
    let (n, inputs, outputs) = (numbers.a.len(), block.inputs.len(), block.outputs.len());
    let d = Grid::of_numbers(&numbers.d, outputs, inputs);
    if n == 0 {
        return System::Gain(d);
    }
    System::StateSpace(Matrices {
        a: Grid::of_numbers(&numbers.a, n, n),
        b: Grid::of_numbers(&numbers.b, n, inputs),
        c: Grid::of_numbers(&numbers.c, outputs, n),
        d,
    })
}

/// The block before it is made discrete, with the formulas of the model; `None` where they cannot be taken as they are.
fn dynamics(block: &model::Block, variable: &str, order: usize) -> Option<System> {
    match &block.dynamics {
        Dynamics::Gain(e) => Some(System::Gain(Grid::from_fn(1, 1, |_, _| e.clone()))),
        Dynamics::Static(matrix) => Some(System::Gain(grid(matrix))),
        Dynamics::Delay(_) => transfer(Fraction {
            numerator: Side { scale: whole(1), power: 0, factors: Vec::new() },
            denominator: Side { scale: whole(1), power: order, factors: Vec::new() },
        }),
        Dynamics::Transfer(e) if has_exponential(e) => None,
        Dynamics::Transfer(e) => transfer(fraction(e, variable)?),
        Dynamics::Ratio { numerator, denominator } => {
            let side = |list: &[Expression]| {
                let first = list.iter().position(|e| !super::formula::is_zero(e)).unwrap_or(list.len());
                let list: Vec<Expression> = list[first..].iter().rev().cloned().collect();
                Side { scale: whole(1), power: 0, factors: if list.is_empty() { Vec::new() } else { vec![list] } }
            };
            let mut numerator_side = side(numerator);
            if numerator_side.factors.is_empty() {
                numerator_side.scale = whole(0);
            }
            transfer(Fraction { numerator: numerator_side, denominator: side(denominator) })
        }
        Dynamics::StateSpace { a, b, c, d } => {
            let (inputs, outputs) = (block.inputs.len(), block.outputs.len());
            let (a, b) = (grid(a), grid(b));
            let c = c.as_ref().map_or_else(|| Grid::identity(order), grid);
            let d = d.as_ref().map_or_else(|| Grid::zeros(outputs, inputs), grid);
            Some(if a.rows == 0 { System::Gain(d) } else { System::StateSpace(Matrices { a, b, c, d }) })
        }
        Dynamics::DeadTime(_) => None,
    }
}

/// A transfer function with its coefficients; `None` where the numerator's degree is written above the denominator's.
fn transfer(of: Fraction) -> Option<System> {
    let (above, below) = (of.numerator.degree(), of.denominator.degree());
    if above > below {
        return None;
    }
    if below == 0 {
        let value = quotient(of.numerator.scale, of.denominator.scale);
        return Some(System::Gain(Grid::from_fn(1, 1, |_, _| value.clone())));
    }
    let mut numerator = lists(&of.numerator);
    let padding = (above..below).map(|_| whole(0));
    let first: Vec<Expression> = padding.chain(std::mem::take(&mut numerator[0])).collect();
    numerator[0] = first;
    Some(System::Transfer { numerator, denominator: lists(&of.denominator) })
}

/// The factors of a product as lists, the highest power first; the scale and the power of the variable are put into the first.
fn lists(side: &Side) -> Vec<Vec<Expression>> {
    let mut lists: Vec<Vec<Expression>> =
        side.factors.iter().map(|factor| factor.iter().rev().cloned().collect()).collect();
    if lists.is_empty() {
        lists.push(vec![whole(1)]);
    }
    let first = std::mem::take(&mut lists[0]);
    lists[0] = first.into_iter().map(|c| product(side.scale.clone(), c)).collect();
    lists[0].extend((0..side.power).map(|_| whole(0)));
    lists
}

/// How the other program makes the block discrete; `None` where it does not do what the model says.
fn sampling(block: &model::Block, d: &Discretization, step: &Step) -> Option<Sampling> {
    if let Some(factor) = &d.factor {
        return Some(Sampling::Bilinear(factor.clone()));
    }
    let Step::Time(own) = step else { return None };
    let time = d.sample_time.as_ref().unwrap_or(own);
    let is_own = d.sample_time.as_ref().is_none_or(|time| time == own);
    let has_dead_time = matches!(&block.dynamics, Dynamics::Transfer(e) if has_exponential(e)) || d.delay.is_some();
    match (d.method.name, &d.prewarp) {
        (word @ ("zoh" | "foh"), _) => (is_own && !has_dead_time).then_some(Sampling::Named(word)),
        ("forward", _) => Some(Sampling::Forward(time.clone())),
        ("backward", _) => Some(Sampling::Backward(time.clone())),
        ("tustin", Some(frequency)) => {
            // The factor w/tan(w T/2) is exact at the frequency w.
            let angle = quotient(product(frequency.clone(), time.clone()), whole(2));
            let tangent = super::formula::of_node(Node::Call(Function::Tan, Box::new(angle)));
            Some(Sampling::Bilinear(quotient(frequency.clone(), tangent)))
        }
        ("tustin", None) if is_own => Some(Sampling::Named("tustin")),
        ("tustin", None) => Some(Sampling::Bilinear(quotient(whole(2), time.clone()))),
        _ => None,
    }
}

impl System {
    /// How many states it has.
    fn order(&self) -> usize {
        match self {
            System::Gain(_) => 0,
            System::Transfer { denominator, .. } => denominator.iter().map(|list| list.len() - 1).sum(),
            System::StateSpace(matrices) => matrices.a.rows,
            System::Sampled(inner, _) => inner.order(),
        }
    }

    /// All formulas.
    pub(super) fn expressions(&self) -> Box<dyn Iterator<Item = &Expression> + '_> {
        match self {
            System::Gain(grid) => Box::new(grid.entries.iter().flatten()),
            System::Transfer { numerator, denominator } => Box::new(numerator.iter().chain(denominator).flatten()),
            System::StateSpace(m) => Box::new(m.grids().into_iter().flat_map(|grid| grid.entries.iter().flatten())),
            System::Sampled(inner, how) => {
                let own = match how {
                    Sampling::Named(_) => None,
                    Sampling::Forward(e) | Sampling::Backward(e) | Sampling::Bilinear(e) => Some(e),
                };
                Box::new(inner.expressions().chain(own))
            }
        }
    }
}
