//! Loops of DSVerifier, a checker of digital systems: its files in C as models.
//!
//! Source: <https://github.com/ssvlab/dsverifier> at commit 1daca47. Its closed-loop check of stability reads a list as falling powers of z,
//! the last entry the constant; its functions in time read powers of 1/z, the first entry the one of the present sample. Lists of equal
//! length are the same in both readings.

mod initialiser;
mod number;
mod system;
mod token;
mod write;

use initialiser::{Definition, definitions};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source};
use number::shown;
use std::sync::Arc;
use system::{Implementation, System};

/// How a list of coefficients is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reading {
    /// Falling powers of z, the last entry is the constant: so does DSVerifier's check of closed-loop stability.
    #[default]
    Z,
    /// Powers of 1/z, the first entry is the constant: so do its functions in time.
    InverseZ,
}

impl Reading {
    /// All readings.
    pub const ALL: [Reading; 2] = [Reading::Z, Reading::InverseZ];

    /// `z` or `z^-1`.
    ///
    /// ```
    /// use jurist_ship::dsverifier::Reading;
    /// assert_eq!(Reading::ALL.map(Reading::name), ["z", "z^-1"]);
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Reading::Z => "z",
            Reading::InverseZ => "z^-1",
        }
    }
}

/// A loop of such a file as a model.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Loop {
    /// The text of a model file: the blocks `controller` and `plant` with negative feedback, and `[ship]`.
    pub model: String,
    /// What is to be said of it, in sentences without a full stop.
    pub remarks: Vec<String>,
}

/// The controller's names; the first one that is there is taken.
const CONTROLLERS: [&str; 3] = ["controller", "control", "ds"];

/// Whether a text has a definition of a digital system: a word, not a promise that it can be read.
///
/// ```
/// assert!(jurist_ship::dsverifier::is_one("digital_system plant = {};"));
/// ```
pub fn is_one(text: &str) -> bool {
    text.contains("digital_system")
}

/// Reads a loop: the definitions `digital_system` of a controller (`controller`, `control` or `ds`) and of `plant`, and an
/// `implementation`, the format of the controller's coefficients. Numbers are exact decimals with the digits that are written.
///
/// ```
/// use jurist_engine::error::Source;
/// use jurist_ship::dsverifier::{Reading, read};
/// let text = "digital_system controller = { .b = { 0.5f }, .b_size = 1, .a = { 1 }, .a_size = 1 };
///     digital_system plant = { .b = { 0.1 }, .b_size = 1, .a = { 1, -0.9 }, .a_size = 2, .a_uncertainty = { 0, 5 } };
///     implementation impl = { .int_bits = 3, .frac_bits = 13 };";
/// let found = read(&Source::new("loop.c", text), Reading::Z)?;
/// assert!(found.model.contains("plant_a1 = { value = -0.9, tolerance = \"5%\" }"));
/// assert!(found.model.contains("format = { bits = 16, fraction = 13, round = \"floor\" }"));
/// # Ok::<(), jurist_engine::error::Diagnostics>(())
/// ```
///
/// Cost: linear in the text.
///
/// # Errors
/// `E-import` with the place in the text: a definition is missing or there are several, a value is no literal decimal number, a denominator
/// or the controller is zero, a numerator has a higher degree than its denominator.
pub fn read(source: &Arc<Source>, reading: Reading) -> Result<Loop, Diagnostics> {
    read_text(source, reading).map_err(|error| Diagnostics::from(error).in_source(source))
}

fn read_text(source: &Source, reading: Reading) -> Result<Loop, Diagnostic> {
    let tokens = token::tokens(&source.text);
    let definitions = definitions(&tokens)?;
    let mut remarks = Vec::new();
    let controller = controller(&definitions, &mut remarks)?;
    let plant = one(&definitions, "digital_system", Some("plant"))?.ok_or_else(|| {
        refused("there is no 'digital_system plant = { ... }' in the file")
            .at(controller.span, "a controller without a plant")
            .help("the file is about the controller alone: add the plant for questions about a loop")
    })?;
    let implementation = one(&definitions, "implementation", None)?.map(Implementation::of).transpose()?;
    let (controller, plant) = (System::of(controller)?, System::of(plant)?);
    if controller.b.is_zero() {
        return Err(refused("the controller is zero: it controls nothing")
            .at(controller.b.span, "all its coefficients are 0")
            .help("the plant alone decides; write it as a model of its own"));
    }
    write::write(&write::Parts { source, reading, controller, plant, implementation, remarks })
}

fn controller<'a, 't>(
    definitions: &'a [Definition<'t>],
    remarks: &mut Vec<String>,
) -> Result<&'a Definition<'t>, Diagnostic> {
    let mut found = Vec::new();
    for name in CONTROLLERS {
        found.extend(one(definitions, "digital_system", Some(name))?);
    }
    let Some(first) = found.first() else {
        let error = refused("there is no 'digital_system controller = { ... }' in the file");
        return Err(error.help("its names are 'controller', 'control' and 'ds'; fields are written as .b = { 1, 2 }"));
    };
    if let Some(other) = found.get(1) {
        remarks.push(format!("the controller is '{}'; '{}' is not read", first.name, other.name));
    }
    Ok(first)
}

/// The only definition of a type, or of one of its names.
fn one<'a, 't>(
    definitions: &'a [Definition<'t>],
    kind: &str,
    name: Option<&str>,
) -> Result<Option<&'a Definition<'t>>, Diagnostic> {
    let mut found = definitions.iter().filter(|one| one.kind == kind && name.is_none_or(|name| one.name == name));
    let (first, second) = (found.next(), found.next());
    if let (Some(first), Some(second)) = (first, second) {
        let what = name.map_or(format!("'{kind}'"), |name| format!("'{}'", shown(name)));
        return Err(refused(format!("there are several definitions of {what}"))
            .at(second.span, "the second one")
            .also(first.span, "the first one")
            .help("leave one of them in the file: '#if' and '#endif' are passed over"));
    }
    Ok(first)
}

/// An error about such a file.
fn refused(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(Code::Import, message)
}

#[cfg(test)]
mod tests;
