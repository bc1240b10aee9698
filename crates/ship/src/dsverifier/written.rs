//! A loop of DSVerifier as a model file.

use super::{DsFile, List, Number, Reading, System, refused};
use crate::format::{Rounding, power_of_two};
use crate::realise::Realisation;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Diagnostic, Diagnostics};
use jurist_show::layout::visible;
use std::fmt::Write;

/// What is chosen where the file leaves it open.
#[derive(Clone, Copy, Debug)]
pub struct Writing {
    /// What the entries of lists stand at.
    pub reading: Reading,
    /// How coefficients are rounded: DSVerifier rounds down unless its command line says otherwise.
    pub rounding: Rounding,
    /// The realisation, which DSVerifier takes from its command line.
    pub realisation: Realisation,
}

impl Default for Writing {
    /// As DSVerifier checks closed loops.
    fn default() -> Writing {
        Writing { reading: Reading::Z, rounding: Rounding::Floor, realisation: Realisation::Df1 }
    }
}

/// Numerator and denominator with the highest power first, each number with its tolerance in per cent.
type Fraction<'f> = [Vec<(&'f Number, Option<&'f Number>)>; 2];

impl DsFile {
    /// The loop as a model file with the blocks `controller` and `plant` and the section `[ship]`; `file` is the name that its comment and its title
    /// give. Coefficients of the plant with an uncertainty are constants with a tolerance.
    ///
    /// Cost: linear in the file.
    ///
    /// # Errors
    /// `E-import` where a transfer function would read the future: more coefficients in its numerator, or a denominator that begins with zero.
    pub fn model(&self, file: &str, writing: &Writing) -> Result<String, Diagnostics> {
        let of = |system| fraction(system, writing.reading).map_err(|error| self.refuse(error));
        let controller = of(&self.controller)?;
        let plant = self.plant.as_ref().map(of).transpose()?;
        let mut out = self.header(file, writing);
        let _ = write!(out, "\ntitle = \"{}\"\ntime = \"discrete\"\n", quotable(file));
        let times = [Some(&self.controller), self.plant.as_ref()];
        if let Some(time) = times.into_iter().flatten().find_map(|system| system.sample_time.as_ref()) {
            let _ = writeln!(out, "sample_time = {}", time.text);
        }
        let mut constants = String::new();
        let blocks = match &plant {
            None => block("controller", "r", "y", [row(&controller[0]), row(&controller[1])]),
            Some(plant) => {
                let rows = [constant_row(&plant[0], 'b', &mut constants), constant_row(&plant[1], 'a', &mut constants)];
                block("controller", "r - y", "u", [row(&controller[0]), row(&controller[1])])
                    + &block("plant", "u", "y", rows)
            }
        };
        if !constants.is_empty() {
            let _ = write!(out, "\n[constants]\n{constants}");
        }
        let _ = write!(out, "\n[loop]\ninputs = [\"r\"]\noutputs = [\"y\"]\n{blocks}");
        if !self.is_stored {
            out += &self.ship(writing);
        }
        Ok(out)
    }

    fn header(&self, file: &str, writing: &Writing) -> String {
        let what = match (&self.plant, self.is_stored) {
            (Some(_), false) => "its controller and its plant with negative feedback",
            (Some(_), true) => "its plant with negative feedback of its controller as DSVerifier stores it",
            (None, false) => "its controller alone",
            (None, true) => "its controller alone, as DSVerifier stores it",
        };
        let mut out = format!("# Made by 'jurist import' from {}, a file of DSVerifier: {what}.\n", visible(file));
        out += match writing.reading {
            Reading::Z => {
                "# Its lists are read as falling powers of z, the last entry the constant, as DSVerifier's check of closed loops reads them.\n"
            }
            Reading::Delays => {
                "# Its lists are read as powers of z^-1, the first entry the constant, as DSVerifier's simulations read them.\n"
            }
        };
        out += "# The numbers are the decimals of the file; DSVerifier's compiler keeps them as binary numbers of 64 bits.\n";
        for remark in self.remarks() {
            let _ = writeln!(out, "# {remark}.");
        }
        out
    }

    /// What the model leaves out or reads in its own way, in sentences without their points.
    pub fn remarks(&self) -> Vec<String> {
        let mut out = Vec::new();
        let is_uncertain = |list: &List| list.uncertainty.iter().any(|percent| percent.value > Rational::ZERO);
        if self.plant.is_some()
            && [&self.controller.numerator, &self.controller.denominator].into_iter().any(is_uncertain)
        {
            out.push(
                "The controller's uncertainty is left out, as DSVerifier's checks of closed loops leave it out".into(),
            );
        }
        if let Some(delta) = self.implementation.as_ref().and_then(|one| one.delta.as_ref())
            && step(&delta.value).is_none()
        {
            out.push(format!(
                "The step of the delta operator, {}, is no power of two below 1 and left out",
                delta.text
            ));
        }
        out
    }

    /// The section `[ship]`. Products of signals are rounded to nearest whatever the mode is (`fxp_mult` of DSVerifier).
    fn ship(&self, writing: &Writing) -> String {
        let Some(one) = &self.implementation else { return String::new() };
        let bits = one.integer + one.fraction;
        let realisation = writing.realisation.name();
        let mut out = format!("\n[ship]\nblock = \"controller\"\nrealisation = \"{realisation}\"\n");
        for (name, round) in [("format", writing.rounding), ("signal", Rounding::Nearest)] {
            let fraction = one.fraction;
            let _ = writeln!(out, "{name} = {{ bits = {bits}, fraction = {fraction}, round = \"{}\" }}", round.name());
        }
        if let Some(bound) = &one.bound {
            let quote = if bound.is_integer() && bound.numerator().bit_length() < 50 { "" } else { "\"" };
            let _ = writeln!(out, "inputs = {{ r = {quote}{bound}{quote} }}");
        }
        if let Some(delta) = one.delta.as_ref().filter(|delta| step(&delta.value).is_some()) {
            let _ = writeln!(out, "delta = {}", delta.text);
        }
        out
    }
}

/// The power of two that a step of the delta operator is.
fn step(delta: &Rational) -> Option<i64> {
    (1..=32).find(|k| *delta == power_of_two(-k))
}

/// The lists with the highest power of z first.
fn fraction(system: &System, reading: Reading) -> Result<Fraction<'_>, Diagnostic> {
    let lists = [&system.numerator, &system.denominator];
    if system.denominator.is_zero() {
        let error = refused(format!("the denominator of '{}' is zero", system.name));
        return Err(error.at(system.denominator.span, "all zero, as far as the size goes"));
    }
    let size = lists.map(|list| list.numbers.len() - list.leading_zeros());
    let is_improper = match reading {
        Reading::Z => size[0] > size[1],
        Reading::Delays => system.denominator.leading_zeros() > 0,
    };
    if is_improper {
        let (list, label, help) = match reading {
            Reading::Z => {
                (lists[0], "a higher power of z than in the denominator", "as powers of z^-1: --reading z^-1")
            }
            Reading::Delays => (lists[1], "begins with 0", "as falling powers of z: --reading z"),
        };
        let message = format!("'{}' would need values of its input that are still to come", system.name);
        return Err(refused(message).at(list.span, label).help(help));
    }
    let longest = lists.map(|list| list.numbers.len()).into_iter().max().unwrap_or(0);
    Ok(lists.map(|list| {
        let entry = |k: usize| (&list.numbers[k], list.uncertainty.get(k).filter(|u| u.value > Rational::ZERO));
        let skipped = if reading == Reading::Z { list.leading_zeros().min(list.numbers.len() - 1) } else { 0 };
        let filled = if reading == Reading::Z { 0 } else { longest - list.numbers.len() };
        (skipped..list.numbers.len()).map(entry).chain((0..filled).map(|_| (&*ZERO, None))).collect()
    }))
}

/// What fills the shorter list of powers of z^-1.
static ZERO: std::sync::LazyLock<Number> = std::sync::LazyLock::new(|| Number::zero(Default::default()));

fn row(list: &[(&Number, Option<&Number>)]) -> Vec<String> {
    list.iter().map(|(number, _)| number.text.clone()).collect()
}

/// The entries of a list of the plant; those with an uncertainty become constants.
fn constant_row(list: &[(&Number, Option<&Number>)], letter: char, constants: &mut String) -> Vec<String> {
    let entry = |(k, (number, uncertainty)): (usize, &(&Number, Option<&Number>))| match uncertainty {
        Some(percent) if !number.value.is_zero() => {
            let name = format!("plant_{letter}{k}");
            let _ = writeln!(
                constants,
                "{name} = {{ value = {}, tolerance = \"{}%\" }}",
                number.text,
                percent.text.trim_matches('"')
            );
            format!("\"{name}\"")
        }
        _ => number.text.clone(),
    };
    list.iter().enumerate().map(entry).collect()
}

fn block(name: &str, input: &str, output: &str, [num, den]: [Vec<String>; 2]) -> String {
    let (num, den) = (num.join(", "), den.join(", "));
    format!(
        "\n[[block]]\nname = \"{name}\"\ninput = \"{input}\"\noutput = \"{output}\"\nnum = [{num}]\nden = [{den}]\n"
    )
}

/// A text between quotes of TOML.
fn quotable(text: &str) -> String {
    visible(text).replace('\\', "\\\\").replace('"', "\\\"")
}
