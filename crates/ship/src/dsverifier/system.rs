//! From fields to a controller, a plant and a number format.

use super::fields::{Field, Struct};
use super::{DsFile, MAX_COEFFICIENTS, Number, refused};
use jurist_algebra::number::Rational;
use jurist_engine::error::{Diagnostic, Source, Span};
use std::sync::Arc;

/// The coefficients of a numerator or a denominator.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct List {
    /// As many numbers as the size says.
    pub numbers: Vec<Number>,
    /// What each may differ by, in per cent of it; zero where nothing is said.
    pub uncertainty: Vec<Number>,
    /// Where the list stands.
    pub span: Span,
}

impl List {
    /// Whether all numbers are zero.
    pub fn is_zero(&self) -> bool {
        self.numbers.iter().all(|number| number.value.is_zero())
    }

    /// How many zeros stand in front.
    pub fn leading_zeros(&self) -> usize {
        self.numbers.iter().take_while(|number| number.value.is_zero()).count()
    }
}

/// A transfer function.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct System {
    /// The name of the struct.
    pub name: String,
    /// `.b`.
    pub numerator: List,
    /// `.a`.
    pub denominator: List,
    /// `.sample_time`, if it is positive.
    pub sample_time: Option<Number>,
}

/// How numbers are stored.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Implementation {
    /// Bits before the point, the sign among them.
    pub integer: u32,
    /// Bits behind the point.
    pub fraction: u32,
    /// The greatest magnitude of the input, already divided by the scale.
    pub bound: Option<Rational>,
    /// The step of the delta operator, if there is one.
    pub delta: Option<Number>,
    /// Where the format is given.
    pub span: Span,
}

/// The parts of a loop among the structs of a file.
pub(super) fn file(source: &Arc<Source>, structs: &[Struct<'_>], missing: &[String]) -> Result<DsFile, Diagnostic> {
    for (k, one) in structs.iter().enumerate() {
        if structs[..k].iter().any(|other| other.name == one.name) {
            let error = refused(format!("'{}' is given twice", one.name)).at(one.name_span, "again here");
            return Err(error.help("leave one of them; what a condition chooses is said with -D NAME=NUMBER"));
        }
    }
    let of = |kind: &str, names: &[&str]| {
        names.iter().find_map(|name| structs.iter().find(|s| s.kind == kind && s.name == *name))
    };
    let controller = of("digital_system", &["controller", "control"]);
    let plant = of("digital_system", &["plant"]);
    let alone = of("digital_system", &["ds"]).filter(|_| controller.is_none() && plant.is_none());
    let (controller, plant) = match (controller, plant, alone) {
        (Some(controller), Some(plant), _) => (controller, Some(plant)),
        (_, _, Some(alone)) => (alone, None),
        (Some(one), None, _) => return Err(absent("plant", Some(one), missing)),
        (None, Some(one), _) => return Err(absent("controller", Some(one), missing)),
        (None, None, None) => return Err(absent("controller", None, missing)),
    };
    let implementation = of("implementation", &["impl"]).map(implementation).transpose()?;
    let controller = system(controller)?;
    refuse_zero(&controller)?;
    let plant = plant.map(system).transpose()?;
    Ok(DsFile { source: Arc::clone(source), controller, plant, implementation, is_stored: false })
}

fn absent(name: &str, other: Option<&Struct<'_>>, missing: &[String]) -> Diagnostic {
    let error = refused(format!("there is no 'digital_system {name} = {{ .. }}'"));
    let error = match other {
        Some(other) => error.at(other.name_span, "this alone is no loop"),
        None => error,
    };
    error.help(match missing {
        [] => "a file of DSVerifier has a controller and a plant, or 'ds' alone".to_owned(),
        _ => format!("parts of the file stand behind conditions: add -D {}", missing.join(" -D ")),
    })
}

fn system(given: &Struct<'_>) -> Result<System, Diagnostic> {
    let list = |name: &str| list(given, name);
    let sample_time = given.number("sample_time").filter(|time| time.value > Rational::ZERO).cloned();
    Ok(System { name: given.name.to_owned(), numerator: list("b")?, denominator: list("a")?, sample_time })
}

/// A list of the size that is given with it.
fn list(given: &Struct<'_>, name: &str) -> Result<List, Diagnostic> {
    let needed = |name: &str| {
        given.field(name).ok_or_else(|| {
            let error = refused(format!("'{}' has no .{name}, so C takes it for empty", given.name));
            error.at(given.name_span, format!("without .{name}"))
        })
    };
    let (field, sizing) = (needed(name)?, needed(&format!("{name}_size"))?);
    let most = MAX_COEFFICIENTS as u32;
    let size = whole(sizing, 1, most)? as usize;
    let limited = |field: &Field<'_>| match field.numbers.len() {
        0..=MAX_COEFFICIENTS => Ok(()),
        _ => Err(refused(format!("a list of more than {most} numbers")).at(field.span, "too long for DSVerifier")),
    };
    limited(field)?;
    let sized = |numbers: &[Number]| -> Vec<Number> {
        let zeros = std::iter::repeat_with(|| Number::zero(field.span));
        numbers.iter().cloned().chain(zeros).take(size).collect()
    };
    let uncertainty = match given.field(&format!("{name}_uncertainty")) {
        Some(field) => limited(field).map(|()| sized(&field.numbers))?,
        None => sized(&[]),
    };
    Ok(List { numbers: sized(&field.numbers), uncertainty, span: field.span })
}

/// DSVerifier refuses a controller that is zero, or divides by zero.
pub(super) fn refuse_zero(controller: &System) -> Result<(), Diagnostic> {
    let lists = [(&controller.numerator, "numerator"), (&controller.denominator, "denominator")];
    match lists.into_iter().find(|(list, _)| list.is_zero()) {
        Some((list, what)) => {
            let error = refused(format!("the {what} of '{}' is zero", controller.name));
            Err(error.at(list.span, "all zero, as far as the size goes").help("DSVerifier refuses it too"))
        }
        None => Ok(()),
    }
}

fn implementation(given: &Struct<'_>) -> Result<Implementation, Diagnostic> {
    let bits = |name: &str, least: u32| match given.field(name) {
        Some(field) => whole(field, least, 64),
        None => {
            Err(refused(format!("'{}' has no .{name}", given.name)).at(given.name_span, format!("without .{name}")))
        }
    };
    let (integer, fraction) = (bits("int_bits", 1)?, bits("frac_bits", 0)?);
    if integer + fraction > 64 {
        let error = refused(format!("a number of {} bits", integer + fraction)).at(given.name_span, "more than 64");
        return Err(error.help("DSVerifier demands less than 32 bits: .int_bits counts the sign"));
    }
    let scale = given.number("scale").map(|scale| scale.value.abs()).filter(|scale| !scale.is_zero());
    let bound = ["min", "max"].into_iter().filter_map(|name| given.number(name)).map(|end| end.value.abs()).max();
    let bound = bound.filter(|bound| !bound.is_zero()).and_then(|bound| match &scale {
        Some(scale) => bound.checked_div(scale),
        None => Some(bound),
    });
    let delta = given.number("delta").filter(|delta| !delta.value.is_zero()).cloned();
    Ok(Implementation { integer, fraction, bound, delta, span: given.name_span })
}

/// A whole number between two bounds.
fn whole(field: &Field<'_>, least: u32, most: u32) -> Result<u32, Diagnostic> {
    let number = field.numbers.first().filter(|number| number.value.is_integer());
    let value = number.and_then(|number| number.value.numerator().to_i64()).and_then(|n| u32::try_from(n).ok());
    value.filter(|value| (least..=most).contains(value)).ok_or_else(|| {
        let error = refused(format!("'{}' is no whole number from {least} to {most}", field.name));
        error.at(field.span, "out of range")
    })
}
