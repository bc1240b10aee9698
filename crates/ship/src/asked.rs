//! What is asked: which block, in which realisation and formats. From `[ship]`, or from options in its place.

use crate::format::{Fixed, Format, Rounding};
use crate::realise::Realisation;
use crate::run::Overflow;
use jurist_algebra::number::{BinaryFormat, Rational};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Span};
use jurist_engine::model::{Form, Model, NumberFormat, Shipping, nearest_name};
use std::sync::Arc;

/// A controller, and how it is stored and run.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Asked {
    /// The block.
    pub block: String,
    /// The signals that it drives.
    pub outputs: Vec<String>,
    /// The realisation.
    pub realisation: Realisation,
    /// How coefficients are stored.
    pub format: Format,
    /// Whether the scale of the coefficients is the least that fits.
    pub is_scale_automatic: bool,
    /// How signals are stored, where that is said: floating-point controllers need no format of their own for that.
    pub signal: Option<Fixed>,
    /// What happens to signals that do not fit.
    pub overflow: Overflow,
    /// The step of the delta operator is 2 to the power `-step`.
    pub step: u32,
    /// Bounds of the loop's inputs.
    pub inputs: Vec<(String, Rational)>,
}

/// What stands in the place of what `[ship]` says.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// The block.
    pub block: Option<String>,
    /// The realisation.
    pub realisation: Option<String>,
    /// The format of coefficients.
    pub format: Option<String>,
    /// The format of signals.
    pub signal: Option<String>,
    /// The rounding mode of coefficients.
    pub round: Option<String>,
    /// Bounds of the loop's inputs.
    pub inputs: Vec<(String, Rational)>,
}

/// The step of the delta operator where none is given: 2^-4.
const STEP: u32 = 4;

/// The most bits of a number.
const MOST_BITS: i64 = 64;

impl Asked {
    /// What the model's `[ship]` asks for, and what stands in its place.
    ///
    /// Cost: linear in the texts.
    ///
    /// # Errors
    /// `E-ship-block`, `E-ship-continuous`, `E-ship-format`, with the place in the model where it is its text.
    pub fn of(model: &Model, overrides: &Overrides) -> Result<Asked, Error> {
        let placed = |diagnostic: Box<Diagnostic>| {
            let source = diagnostic.primary.is_some().then(|| Arc::clone(model.source()));
            Error::from(Diagnostics::new(source, vec![*diagnostic]))
        };
        let nothing = Shipping::default();
        let shipping = model.shipping().unwrap_or(&nothing);
        let (block, outputs) = block(model, shipping, overrides).map_err(placed)?;
        let realisation = realisation(shipping, overrides).map_err(placed)?;
        let (mut format, is_scale_automatic) = coefficients(shipping, overrides).map_err(placed)?;
        if let Some(name) = &overrides.round {
            let mode = rounding(name, None).map_err(placed)?;
            match &mut format {
                Format::Fixed(fixed) => fixed.rounding = mode,
                Format::Binary(_) => {
                    let error = Diagnostic::error(
                        Code::ShipFormat,
                        "floating-point numbers are rounded to nearest, ties to even",
                    );
                    return Err(error.help("leave out --round").into());
                }
            }
        }
        let mut inputs = overrides.inputs.clone();
        for (name, bound) in &shipping.inputs {
            if inputs.iter().all(|(known, _)| *known != name.name) {
                inputs.push((name.name.clone(), bound.clone()));
            }
        }
        Ok(Asked {
            block,
            outputs,
            realisation,
            format,
            is_scale_automatic,
            signal: signal(shipping, overrides, &format).map_err(placed)?,
            overflow: if shipping.saturate { Overflow::Saturate } else { Overflow::Wrap },
            step: step(shipping).map_err(placed)?,
            inputs,
        })
    }
}

type Found<T> = Result<T, Box<Diagnostic>>;

fn fail<T>(diagnostic: Diagnostic) -> Found<T> {
    Err(Box::new(diagnostic))
}

/// The block's name and what it drives.
fn block(model: &Model, shipping: &Shipping, overrides: &Overrides) -> Found<(String, Vec<String>)> {
    let blocks = match model.form() {
        Form::Blocks(diagram) => diagram.blocks.as_slice(),
        _ => {
            let error = Diagnostic::error(
                Code::ShipBlock,
                "the loop is no diagram of blocks, so none of them is the controller",
            );
            return fail(error.help("write the loop with [[block]], the controller as one of them"));
        }
    };
    let names = || blocks.iter().map(|block| block.name.as_str());
    let named = overrides.block.as_deref().or(shipping.block.as_ref().map(|name| name.name.as_str()));
    let Some(name) = named else {
        let error = Diagnostic::error(Code::ShipBlock, "which block is the controller is not said");
        let known: Vec<&str> = names().collect();
        return fail(
            error.help(format!(
                "add --block NAME, or [ship] with block = \"NAME\"; the blocks are {}",
                known.join(", ")
            )),
        );
    };
    let Some(block) = blocks.iter().find(|block| block.name == name) else {
        let mut error = Diagnostic::error(Code::ShipBlock, format!("the loop has no block '{name}'"));
        error.help = match nearest_name(name, names()) {
            Some(near) => Some(format!("did you mean '{near}'?")),
            None => Some(format!("the blocks are {}", names().collect::<Vec<_>>().join(", "))),
        };
        return fail(error);
    };
    Ok((name.to_owned(), block.outputs.iter().map(|output| output.name.clone()).collect()))
}

/// An error about a word, with its place where it stands in the model.
fn unknown(what: &str, word: &str, known: &[&str], span: Option<Span>) -> Diagnostic {
    let mut error = Diagnostic::error(Code::ShipFormat, format!("unknown {what} '{word}'"));
    error.help = Some(match nearest_name(word, known.iter().copied()) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("one of {}", known.join(", ")),
    });
    match span {
        Some(span) => error.at(span, "not known"),
        None => error,
    }
}

fn realisation(shipping: &Shipping, overrides: &Overrides) -> Found<Realisation> {
    let given = overrides.realisation.as_deref().map(|word| (word, None));
    let written = shipping.realisation.as_ref().map(|name| (name.name.as_str(), Some(name.span)));
    let Some((word, span)) = given.or(written) else { return Ok(Realisation::Df1) };
    let names = Realisation::ALL.map(Realisation::name);
    Realisation::named(word).ok_or_else(|| Box::new(unknown("realisation", word, &names, span)))
}

fn rounding(word: &str, span: Option<Span>) -> Found<Rounding> {
    let names = Rounding::ALL.map(Rounding::name);
    let mode = Rounding::ALL.into_iter().find(|mode| mode.name() == word);
    mode.ok_or_else(|| Box::new(unknown("rounding mode", word, &names, span)))
}

fn step(shipping: &Shipping) -> Found<u32> {
    let Some((delta, span)) = &shipping.delta else { return Ok(STEP) };
    let steps = (1..=32).find(|k| *delta == crate::format::power_of_two(-i64::from(*k)));
    let error = Diagnostic::error(Code::ShipFormat, "the step of the delta operator is a power of two below 1");
    steps.ok_or_else(|| Box::new(error.at(*span, "no such power").help("for example delta = \"1/16\"")))
}

/// The format of coefficients, and whether its scale is to be found.
fn coefficients(shipping: &Shipping, overrides: &Overrides) -> Found<(Format, bool)> {
    if let Some(word) = &overrides.format {
        let mut format = word_format(word, None)?;
        // How it is rounded is said by the model, or by --round.
        let written = shipping.format.as_ref().and_then(|text| number_format(text).ok());
        if let (Format::Fixed(fixed), Some((Format::Fixed(own), _))) = (&mut format, written) {
            fixed.rounding = own.rounding;
        }
        return Ok((format, false));
    }
    match &shipping.format {
        Some(text) => number_format(text),
        None => {
            let error = Diagnostic::error(Code::ShipFormat, "how the coefficients are stored is not said");
            fail(error.help("add --format Q2.13 or float32, or [ship] with format = { bits = 16, fraction = 13 }"))
        }
    }
}

fn signal(shipping: &Shipping, overrides: &Overrides, coefficients: &Format) -> Found<Option<Fixed>> {
    let (format, span) = match (&overrides.signal, &shipping.signal) {
        (Some(word), _) => (word_format(word, None)?, None),
        (None, Some(text)) => match number_format(text)? {
            (format, false) => (format, Some(text.span)),
            (_, true) => {
                let error = Diagnostic::error(Code::ShipFormat, "signals have no automatic scale");
                return fail(
                    error.at(text.span, "scale = \"auto\"").help("write the scale, or more bits before the point"),
                );
            }
        },
        (None, None) => return Ok(None),
    };
    match (format, coefficients) {
        (Format::Fixed(fixed), Format::Fixed(_)) => Ok(Some(fixed)),
        (found, other) if found == *other => Ok(None),
        // A format in floating point that stands in the place of the model's says what signals are, too.
        (Format::Fixed(_), Format::Binary(_)) if overrides.format.is_some() && span.is_some() => Ok(None),
        _ => {
            let error = Diagnostic::error(
                Code::ShipFormat,
                "coefficients and signals are of one kind: both in fixed point, or both the same float",
            );
            let error = error.help("write two fixed-point formats, or float32 or float64 for both");
            fail(match span {
                Some(span) => error.at(span, "of another kind"),
                None => error,
            })
        }
    }
}

/// A format as a table or a word of the model.
fn number_format(text: &NumberFormat) -> Found<(Format, bool)> {
    if let Some(word) = &text.word {
        return Ok((word_format(word, Some(text.span))?, false));
    }
    let wrong = |message: &str, help: &str| {
        Box::new(Diagnostic::error(Code::ShipFormat, message).at(text.span, "no such format").help(help))
    };
    let whole = |value: &Option<Rational>, what: &str| -> Found<Option<i64>> {
        let Some(value) = value else { return Ok(None) };
        let number = value.is_integer().then(|| value.numerator().to_i64()).flatten().filter(|n| n.abs() <= 1024);
        number.map(Some).ok_or_else(|| {
            wrong(&format!("'{what}' is a whole number of bits"), "for example { bits = 16, fraction = 13 }")
        })
    };
    let (bits, integer) = (whole(&text.bits, "bits")?, whole(&text.integer, "integer")?);
    let Some(fraction) = whole(&text.fraction, "fraction")? else {
        return Err(wrong("how many bits stand behind the point is not said", "add fraction = 13, say"));
    };
    let bits = match (bits, integer) {
        (Some(bits), None) => bits,
        (None, Some(integer)) => integer + fraction,
        (Some(bits), Some(integer)) if bits == integer + fraction => bits,
        (Some(_), Some(_)) => {
            return Err(wrong(
                "'bits' is not 'integer' and 'fraction' together",
                "leave out one of them; 'integer' counts the sign",
            ));
        }
        (None, None) => {
            return Err(wrong(
                "how many bits a number has is not said",
                "add bits = 16, or integer = 3 (the sign among them)",
            ));
        }
    };
    let rounding = match &text.round {
        Some(word) => rounding(word, Some(text.span))?,
        None => Rounding::Nearest,
    };
    let (scale, is_automatic) = match text.scale.as_deref() {
        None => (0, false),
        Some("auto") => (0, true),
        Some(power) => match power.parse::<i32>().ok().filter(|power| power.abs() <= 1024) {
            Some(power) => (power, false),
            None => {
                return Err(wrong(
                    "'scale' is the exponent of a power of two, or \"auto\"",
                    "for example scale = 2 for a division by 4",
                ));
            }
        },
    };
    let fixed = fixed(bits, fraction, rounding).ok_or_else(|| {
        wrong(
            "a number has 1 to 64 bits",
            "the sign is one of them: { bits = 16, fraction = 13 } has 2 bits before the point",
        )
    })?;
    Ok((Format::Fixed(Fixed { scale, ..fixed }), is_automatic))
}

fn fixed(bits: i64, fraction: i64, rounding: Rounding) -> Option<Fixed> {
    let bits = u32::try_from(bits).ok().filter(|bits| (1..=MOST_BITS).contains(&i64::from(*bits)))?;
    Some(Fixed { bits, fraction: i32::try_from(fraction).ok()?, scale: 0, rounding })
}

/// `Q2.13`: a sign, 2 bits before the point and 13 behind it; `float32`, `float64`.
fn word_format(word: &str, span: Option<Span>) -> Found<Format> {
    match word {
        "float32" => return Ok(Format::Binary(BinaryFormat::Single)),
        "float64" => return Ok(Format::Binary(BinaryFormat::Double)),
        _ => {}
    }
    let q = word.strip_prefix(['Q', 'q']).and_then(|rest| rest.split_once('.'));
    let numbers = q.and_then(|(m, n)| Some((m.parse::<u8>().ok()?, n.parse::<u8>().ok()?)));
    let found = numbers.and_then(|(m, n)| fixed(1 + i64::from(m) + i64::from(n), i64::from(n), Rounding::Nearest));
    found.map(Format::Fixed).ok_or_else(|| {
        let error = Diagnostic::error(Code::ShipFormat, format!("unknown number format '{word}'"));
        let digits = word.strip_prefix(['Q', 'q']).unwrap_or(word);
        let error = match digits.parse::<u8>() {
            Ok(bits) if bits >= 7 && digits.len() < word.len() => {
                error.help(format!("for a sign and {bits} bits behind the point write Q0.{bits}"))
            }
            Ok(bits) if digits.len() == word.len() => error.help(format!(
                "how many of {bits} bits stand behind the point? Q2.{} has a sign and 2 before it",
                bits.saturating_sub(3)
            )),
            _ => error.help("Q2.13 is a sign, 2 bits before and 13 behind the point; else float32 or float64"),
        };
        Box::new(match span {
            Some(span) => error.at(span, "not known"),
            None => error,
        })
    })
}
