//! What a definition says: two lists, or a format.

use super::initialiser::{Definition, Field, entries};
use super::number::{Number, shown, whole};
use super::refused;
use jurist_engine::error::{Diagnostic, Span};

/// Longer lists are refused.
const MOST: i64 = 200;

/// The most bits of a number.
const MOST_BITS: i64 = 64;

/// A coefficient with its uncertainty in per cent, where it has one.
#[derive(Clone, Debug)]
pub(super) struct Coefficient {
    pub number: Number,
    pub uncertainty: Option<Number>,
}

/// A list of coefficients with its place.
#[derive(Clone, Debug)]
pub(super) struct List {
    pub entries: Vec<Coefficient>,
    pub span: Span,
}

impl List {
    /// Whether all of its numbers are 0.
    pub fn is_zero(&self) -> bool {
        self.entries.iter().all(|entry| entry.number.value.is_zero())
    }
}

/// A `digital_system`.
#[derive(Clone, Debug)]
pub(super) struct System {
    pub b: List,
    pub a: List,
    pub sample_time: Option<Number>,
    /// What is to be said of it.
    pub remarks: Vec<String>,
}

impl System {
    pub fn of(definition: &Definition<'_>) -> Result<System, Diagnostic> {
        let mut remarks = Vec::new();
        let b = list(definition, "b", &mut remarks)?;
        let a = list(definition, "a", &mut remarks)?;
        if a.is_zero() {
            let error = refused(format!("the denominator of '{}' is zero", shown(definition.name)))
                .at(a.span, "all its coefficients are 0");
            return Err(match b.is_zero() {
                true => error.help("nothing is said of this system yet: write its coefficients into both lists"),
                false => error.help("write its coefficients, the highest power of z first"),
            });
        }
        let sample_time = scalar(definition, "sample_time")?.filter(|time| !time.value.is_zero());
        if let Some(time) = sample_time.as_ref().filter(|time| time.value.is_negative()) {
            return Err(refused("a sample time is not negative").at(time.span, "negative"));
        }
        Ok(System { b, a, sample_time, remarks })
    }
}

/// An `implementation`.
#[derive(Clone, Debug)]
pub(super) struct Implementation {
    pub bits: i64,
    pub fraction: i64,
    /// The greatest magnitude of the input, divided by the scale.
    pub bound: Option<String>,
    pub delta: Option<Number>,
}

impl Implementation {
    pub fn of(definition: &Definition<'_>) -> Result<Implementation, Diagnostic> {
        let required = |name: &str| {
            scalar(definition, name)?.ok_or_else(|| {
                refused(format!("'{}' has no .{name}", shown(definition.name))).at(definition.span, "not complete")
            })
        };
        let (integer, fraction) = (required("int_bits")?, required("frac_bits")?);
        let bits = integer.whole(".int_bits", 0, MOST_BITS)? + fraction.whole(".frac_bits", 0, MOST_BITS)?;
        if !(1..=MOST_BITS).contains(&bits) {
            return Err(refused(format!("a number has 1 to {MOST_BITS} bits, not {bits}"))
                .at(fraction.span, "bits behind the point")
                .also(integer.span, "bits before it, the sign among them"));
        }
        let delta = scalar(definition, "delta")?.filter(is_step);
        Ok(Implementation {
            bits,
            fraction: fraction.whole(".frac_bits", 0, MOST_BITS)?,
            bound: bound(definition)?,
            delta,
        })
    }
}

/// Whether the delta operator of `[ship]` takes this step: a power of two below 1.
fn is_step(delta: &Number) -> bool {
    (1..=32).any(|k| delta.value == crate::format::power_of_two(-k))
}

/// The greater magnitude of `.min` and `.max`, over the scale.
fn bound(definition: &Definition<'_>) -> Result<Option<String>, Diagnostic> {
    let [least, greatest, scale] = ["min", "max", "scale"].map(|name| scalar(definition, name));
    let (least, greatest, scale) = (least?, greatest?, scale?);
    let (Some(least), Some(greatest)) = (least, greatest) else { return Ok(None) };
    if greatest.value < least.value {
        return Err(refused(".max is below .min").at(greatest.span, "the greatest").also(least.span, "the least"));
    }
    let most = if greatest.value.abs() < least.value.abs() { &least } else { &greatest };
    let scale = scale.filter(|scale| !scale.value.is_zero());
    Ok(match scale.and_then(|scale| most.value.abs().checked_div(&scale.value.abs())) {
        Some(quotient) => Some(format!("\"{quotient}\"")),
        None => Some(most.text.trim_start_matches('-').to_owned()),
    })
}

fn scalar(definition: &Definition<'_>, name: &str) -> Result<Option<Number>, Diagnostic> {
    let Some(field) = definition.field(name) else { return Ok(None) };
    if field.value.is_empty() {
        return Err(no_value(field));
    }
    Number::of(&field.value).map(Some)
}

fn no_value(field: &Field<'_>) -> Diagnostic {
    refused(format!("'.{}' has no value", shown(field.name))).at(field.span, "nothing behind '='")
}

/// The numbers of a field in braces; of one number without braces, C makes the first entry.
fn numbers(field: &Field<'_>) -> Result<(Vec<Number>, Span), Diagnostic> {
    let inner = match field.value.as_slice() {
        [] => return Err(no_value(field)),
        [open, inner @ .., close] if open.is("{") && close.is("}") => inner,
        all => all,
    };
    let mut out = Vec::new();
    for entry in entries(inner) {
        if entry.is_empty() {
            return Err(refused("there is no number between two commas").at(whole(inner), "in this list"));
        }
        if out.len() as i64 >= MOST {
            return Err(refused(format!("a list has at most {MOST} numbers")).at(whole(entry), "one more"));
        }
        out.push(Number::of(entry)?);
    }
    Ok((out, whole(&field.value)))
}

/// `.b` or `.a`, filled with zeros or cut to its size.
fn list(definition: &Definition<'_>, name: &str, remarks: &mut Vec<String>) -> Result<List, Diagnostic> {
    let Some(field) = definition.field(name) else {
        return Err(refused(format!("'{}' has no .{name}", shown(definition.name))).at(definition.span, "not complete"));
    };
    let (mut found, span) = numbers(field)?;
    let size = match scalar(definition, &format!("{name}_size"))? {
        Some(size) => size.whole(&format!(".{name}_size"), 1, MOST)? as usize,
        None => {
            remarks.push(format!("'{}' has no .{name}_size: the list .{name} is taken whole", definition.name));
            found.len().max(1)
        }
    };
    if found.len() != size {
        let done = if found.len() < size { "filled with zeros at its end" } else { "cut at its end" };
        remarks.push(format!("the list .{name} of '{}' is {done}, to .{name}_size = {size}", definition.name));
    }
    found.resize_with(size, || Number::zero(span));
    let uncertain = match definition.field(&format!("{name}_uncertainty")) {
        Some(field) => numbers(field)?.0,
        None => Vec::new(),
    };
    let mut uncertain = uncertain.into_iter();
    let entries = found.into_iter().map(|number| {
        let percent = uncertain
            .next()
            .filter(|percent| !(percent.value.is_negative() || percent.value.is_zero() || number.value.is_zero()));
        Coefficient { number, uncertainty: percent }
    });
    Ok(List { entries: entries.collect(), span })
}
