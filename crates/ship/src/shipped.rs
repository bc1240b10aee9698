//! The controller with its stored coefficients, in the place of the exact one.

use crate::asked::Asked;
use crate::emit::{self, Arithmetic, Target, TooWide, text};
use crate::format::{Fixed, Format};
use crate::program::Coefficient;
use crate::realise::{Entry, Realisation, Realised, delta, direct, parallel, sections, state};
use crate::run::FloatProgram;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_engine::error::{Code, Diagnostic, Error, Source};
use jurist_engine::model::{Model, Time};
use jurist_engine::problem::{Ask, EnclosedBlock, Problem, Question};
use std::sync::Arc;

/// Bits to which coefficients are known that are no rational numbers.
const BITS: u64 = 512;

/// An automatic scale divides or multiplies by no more than two to this power.
const MOST_SCALE: i32 = 1024;

/// A coefficient as it is stored.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Stored {
    /// Its name.
    pub name: String,
    /// Its value before.
    pub exact: Enclosure,
    /// The number that is stored.
    pub value: Rational,
    /// The integer that stands for it in fixed point.
    pub integer: Option<Integer>,
}

/// A loop, and the same loop with the controller as it is stored.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Shipped {
    /// The loop as it is written.
    pub exact: Arc<Problem>,
    /// The loop with the stored coefficients.
    pub rounded: Arc<Problem>,
    /// What was asked; an automatic scale is found.
    pub asked: Asked,
    /// The controller's operations.
    pub realised: Realised,
    /// What is stored.
    pub coefficients: Vec<Stored>,
    /// The controller as it is written.
    pub before: EnclosedBlock,
    /// The controller as it is stored.
    pub after: EnclosedBlock,
}

impl Shipped {
    /// Rounds the controller of a loop in which every name has a value.
    ///
    /// Cost: that of [`Problem::block`], and of roots for second-order sections.
    ///
    /// # Errors
    /// As [`Problem::block`]; `E-ship-block`, `E-ship-continuous`, `E-ship-range`.
    ///
    /// # Panics
    /// When a name is free.
    pub fn new(problem: &Arc<Problem>, mut asked: Asked, budget: &Budget) -> Result<Shipped, Error> {
        if problem.time() == Time::Continuous {
            let error = Diagnostic::error(
                Code::ShipContinuous,
                "the loop runs in continuous time: no processor computes its controller",
            );
            return Err(error
                .help("time = \"discrete\", and discretize = \"tustin\" in the controller's block")
                .into());
        }
        let Some(before) = problem.block(&asked.block, BITS, budget)? else {
            let message = format!("block '{}' changes from sample to sample", asked.block);
            return Err(Diagnostic::error(Code::ShipBlock, message)
                .help("a controller is not behind pulses that alternate")
                .into());
        };
        let realised = realised(&before, &asked, budget)?;
        let coefficients = stored(&realised.program.coefficients, &mut asked)?;
        let values: Vec<Entry> = coefficients.iter().map(|c| Entry::Number(c.value.clone())).collect();
        let stored = with_controller(problem, &asked.block, &realised.keys(&values)).map_err(of_stored_loop)?;
        let rounded = stored.problem()?;
        let Some(after) = rounded.block(&asked.block, BITS, budget).map_err(of_stored_loop)? else {
            return Err(Error::Undefined("the stored controller".into()));
        };
        Ok(Shipped { exact: Arc::clone(problem), rounded, asked, realised, coefficients, before, after })
    }

    /// What rounding changed in the structure of the controller, in sentences.
    pub fn changes(&self) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        let vanished = self.coefficients.iter().filter(|c| c.value.is_zero());
        out.extend(vanished.map(|c| format!("{} became 0", c.name)));
        let at_one = |polynomial: &[Enclosure]| polynomial.iter().fold(Rational::ZERO, |sum, c| sum + c.lower());
        let is_exact = |polynomial: &[Enclosure]| polynomial.iter().all(|c| c.lower() == c.upper());
        let (before, after) = (&self.before, &self.after);
        if !is_exact(&before.denominator) || !is_exact(&before.numerator) || before.denominator.is_empty() {
            return out;
        }
        if at_one(&before.denominator).is_zero() && !at_one(&before.numerator).is_zero() {
            if !at_one(&after.denominator).is_zero() {
                out.push("integral action is lost: the pole at z = 1 moved".into());
            } else if at_one(&after.numerator).is_zero() {
                out.push("integral action is lost: the numerator is 0 at z = 1, where the pole is".into());
            }
        }
        out
    }

    /// The controller as source code, with remarks in its comment.
    ///
    /// Cost: linear in the operations.
    ///
    /// # Errors
    /// `E-ship-format` where nothing is said of signals in fixed point, `E-ship-range` where a sum may need more than 64 bits.
    pub fn code(&self, target: Target, remarks: &[String]) -> Result<String, Error> {
        let wide = |wide: TooWide| -> Error {
            Diagnostic::error(Code::ShipRange, wide.to_string())
                .help("take fewer bits for signals or coefficients")
                .into()
        };
        let (fixed, float);
        let arithmetic = match self.asked.format {
            Format::Fixed(_) => {
                let Some(program) = self.fixed_program() else {
                    let error = Diagnostic::error(Code::ShipFormat, "code needs the format of signals");
                    return Err(error
                        .help("add --signal Q5.10, or signal = { bits = 16, fraction = 10 } to [ship]")
                        .into());
                };
                fixed = program;
                Arithmetic::Fixed(&fixed)
            }
            Format::Binary(format) => {
                let values: Vec<Rational> = self.coefficients.iter().map(|c| c.value.clone()).collect();
                let Some(program) = FloatProgram::new(&self.realised.program, &values, format) else {
                    return Err(Diagnostic::error(
                        Code::ShipRange,
                        "a factor of the controller is too large for its format",
                    )
                    .into());
                };
                float = program;
                Arithmetic::Float(&float)
            }
        };
        let realisation = self.asked.realisation;
        text(&emit::Shipped { name: &self.asked.block, realisation, arithmetic, remarks }, target).map_err(wide)
    }

    /// The text of a model with the stored coefficients.
    pub fn rounded_text(&self) -> &str {
        &self.rounded.model().source().text
    }
}

/// An error about the loop with the stored controller, which is no mistake of the model's text.
pub(crate) fn of_stored_loop(error: Error) -> Error {
    let is_loop = |found: &Diagnostic| found.code == Code::AlgebraicLoop;
    match error {
        Error::Refused(found) if found.diagnostics().iter().any(is_loop) => {
            let message = "with the stored coefficients the loop is not well posed: its gain without delay is 1";
            Diagnostic::error(Code::AlgebraicLoop, message)
                .help("take another format or rounding, or a delay in the loop")
                .into()
        }
        error => error,
    }
}

/// The question of a problem, of the model with another dynamic in the controller's place.
pub(crate) fn with_controller(problem: &Problem, block: &str, keys: &[(&str, String)]) -> Result<Question, Error> {
    let text = problem.model().with_block(block, keys);
    let no_block = || Diagnostic::error(Code::ShipBlock, format!("the text of block '{block}' is not found"));
    question_of(problem, text.ok_or_else(no_block)?)
}

/// The question of a problem, of another text of its model.
pub(crate) fn question_of(problem: &Problem, text: String) -> Result<Question, Error> {
    let name = problem.model().source().name.clone();
    let (model, _) = Model::from_toml(&Source::new(name, text))?;
    Ok(model.ask().set_all(problem.set().iter().cloned()).within(problem.region().clone()))
}

fn realised(block: &EnclosedBlock, asked: &Asked, budget: &Budget) -> Result<Realised, Error> {
    if asked.realisation == Realisation::State {
        return Ok(state(&block.a, &block.b, &block.c, &block.d));
    }
    if block.denominator.is_empty() {
        let error =
            Diagnostic::error(Code::ShipBlock, format!("block '{}' has more than one input or output", asked.block));
        return Err(error.help("realisation = \"state\" takes its matrices as they are").into());
    }
    let (b, a) = (&block.numerator, &block.denominator);
    Ok(match asked.realisation {
        Realisation::Sos => sections(b, a, budget)?.ok_or_else(|| {
            let error = Diagnostic::error(
                Code::ShipBlock,
                "poles or zeros of the controller are too near to each other to be told apart",
            );
            error.help("take another realisation, such as df2t")
        })?,
        Realisation::Parallel => parallel(b, a, budget)?.ok_or_else(|| {
            let error = Diagnostic::error(
                Code::ShipParallel,
                "the controller has equal poles, or poles that are not told apart: it has no partial fractions",
            );
            error.help("take another realisation, such as sos")
        })?,
        Realisation::Delta => delta(b, a, asked.step),
        other => direct(other, b, a),
    })
}

/// The stored numbers; an automatic scale is put into what is asked.
fn stored(coefficients: &[Coefficient], asked: &mut Asked) -> Result<Vec<Stored>, Error> {
    let fits = |fixed: &Fixed| {
        coefficients
            .iter()
            .all(|c| [c.exact.lower(), c.exact.upper()].into_iter().all(|end| fixed.stored(end).is_some()))
    };
    if let (Format::Fixed(fixed), true) = (&mut asked.format, asked.is_scale_automatic && !coefficients.is_empty()) {
        let scales = (-MOST_SCALE..=MOST_SCALE).map(|scale| Fixed { scale, ..*fixed });
        *fixed = scales.into_iter().find(fits).unwrap_or(*fixed);
    }
    coefficients.iter().map(|c| one(c, &asked.format, coefficients)).collect()
}

/// The refusal of a coefficient whose enclosure holds the edge between two stored numbers.
pub(crate) fn not_told(name: &str) -> Diagnostic {
    let message = format!("{name} may lie between two stored numbers: {BITS} bits do not tell which is nearer");
    Diagnostic::error(Code::ShipFormat, message)
        .help("take one bit more, or a direct form, whose coefficients are exact")
}

fn one(coefficient: &Coefficient, format: &Format, all: &[Coefficient]) -> Result<Stored, Error> {
    let Coefficient { name, exact } = coefficient;
    let value = format.nearest_of(exact).map_err(|_| not_told(name))?;
    let Some(value) = value else { return Err(out_of_range(coefficient, format, all)) };
    let integer = match format {
        Format::Fixed(fixed) => Some(fixed.rounded(exact.lower())),
        Format::Binary(_) => None,
    };
    Ok(Stored { name: name.clone(), exact: exact.clone(), value, integer })
}

fn out_of_range(coefficient: &Coefficient, format: &Format, all: &[Coefficient]) -> Error {
    let value = jurist_algebra::number::to_decimal(coefficient.exact.lower(), 6);
    let message = format!("{} = {value} does not fit into {}", coefficient.name, format.words());
    let error = Diagnostic::error(Code::ShipRange, message);
    let Format::Fixed(fixed) = format else { return error.help("scale the controller's signals").into() };
    let fits = |bits: &u32| {
        let wider = Fixed { bits: *bits, ..*fixed };
        all.iter().all(|c| [c.exact.lower(), c.exact.upper()].into_iter().all(|end| wider.stored(end).is_some()))
    };
    let help = match (fixed.bits..=64).find(fits) {
        Some(bits) => {
            let fraction = i64::from(fixed.fraction) - i64::from(bits - fixed.bits);
            format!(
                "{bits} bits with {} behind the point hold all coefficients; so do {} bits with {fraction} behind it, or scale = \"auto\"",
                fixed.fraction, fixed.bits
            )
        }
        None => "scale = \"auto\" divides all coefficients by a power of two".to_owned(),
    };
    error.help(help).into()
}
