//! Numbers of C and C++ headers: `#define NAME literal` and `const TYPE NAME = literal;`.
//!
//! This is no preprocessor. One literal is read, perhaps with a sign and in parentheses; what is not certain is refused: a wrong number
//! would go unseen.

use super::c_source::{Line, Source, Standing, word};
use super::c_type::{Type, type_of};
use super::literal::{Format, Literal, literal};
use super::{Found, Refusal};
use jurist_algebra::number::{BinaryFormat, Rational};
use jurist_engine::model::nearest_name;

/// The number of a name.
pub(super) fn number(text: &str, name: &str, as_decimal: bool) -> Result<Found, Refusal> {
    let source = Source::of(text)?;
    let mut definitions = macros(&source, name)?;
    let (constants, other) = constants(&source, name)?;
    definitions.extend(constants);
    let [first, others @ ..] = definitions.as_slice() else {
        return Err(match other {
            Some(at) => Refusal::at(text, at, format!("'{name}' stands there in a form that is not read")),
            None => Refusal::of(missing(&source, name)),
        });
    };
    if let Some(other) = others.iter().find(|other| (other.body, &other.kind) != (first.body, &first.kind)) {
        let [one, two] = [first.at, other.at].map(|at| Refusal::line(text, at));
        let why = format!("'{name}' is defined on line {one} and again on line {two}, differently");
        return Err(Refusal::at(text, other.at, why));
    }
    first.value(text, as_decimal)
}

/// That a name is not there, with the macro that it may be.
fn missing(source: &Source, name: &str) -> String {
    let lines = source.lines();
    let defined =
        lines.iter().filter_map(|line| Source::directive(line.text)).filter(|(directive, _)| *directive == "define");
    let meant = nearest_name(name, defined.map(|(_, rest)| word(rest).0));
    let meant = meant.map(|meant| format!("; did you mean '{meant}'?")).unwrap_or_default();
    format!("there is no '#define {name}' and no constant '{name}'{meant}")
}

/// How a name is defined.
#[derive(Debug, PartialEq)]
enum Kind<'t> {
    Macro,
    /// With the words of its declaration, without storage and qualifiers.
    Constant(Vec<&'t str>),
}

/// A definition of the name.
#[derive(Debug)]
struct Definition<'t> {
    at: usize,
    body: &'t str,
    kind: Kind<'t>,
    /// Whether the compiler may be given another one: it stands in `#ifndef NAME`.
    is_default: bool,
}

impl Definition<'_> {
    fn value(&self, text: &str, as_decimal: bool) -> Result<Found, Refusal> {
        let refuse = |why: String| Refusal::at(text, self.at, why);
        let Literal { written, value, format } = literal(self.body).map_err(refuse)?;
        let of_type = match &self.kind {
            Kind::Macro => Type::OfLiteral,
            Kind::Constant(words) if as_decimal => type_of(words).unwrap_or(Type::OfLiteral),
            Kind::Constant(words) => type_of(words).map_err(refuse)?,
        };
        if let Type::Integer { low, high } = of_type {
            if !value.is_integer() {
                return Err(refuse(format!("C cuts off the fraction of {written}")));
            }
            if value < Rational::from(low) || value > Rational::from(high) {
                let why = format!("{written} may not fit into its type, which compilers make of different sizes");
                return Err(refuse(why));
            }
        }
        let rounded = |value: &Rational, format: BinaryFormat| {
            format.nearest(value).ok_or_else(|| refuse(format!("{written} is infinite in this format")))
        };
        let (number, how) = match (as_decimal, format, of_type) {
            (true, ..) => (value, "as it is written".to_owned()),
            (_, Format::LongDouble, _) => {
                let why = "is a long double, which compilers hold differently; as = \"decimal\" takes it as written";
                return Err(refuse(format!("{written} {why}")));
            }
            (_, Format::Integer, Type::Binary(to)) => (rounded(&value, to)?, format!("as {}", words(to))),
            (_, Format::Integer, _) => (value, "a whole number".to_owned()),
            (_, Format::Binary(own), Type::Binary(to)) if own != to => {
                let first = rounded(&value, own)?;
                (rounded(&first, to)?, format!("as {}, then as {}", words(own), words(to)))
            }
            (_, Format::Binary(own), _) => (rounded(&value, own)?, format!("as {}", words(own))),
        };
        let how = if self.is_default { format!("{how}, unless the compiler is given another") } else { how };
        Ok(Found { number, written: written.to_owned(), how, line: Refusal::line(text, self.at) })
    }
}

fn words(format: BinaryFormat) -> &'static str {
    match format {
        BinaryFormat::Single => "float32",
        BinaryFormat::Double => "double",
    }
}

/// Whether a definition that stands like this is a default; `None` where it is never compiled.
fn is_default(standing: &Standing<'_>, source: &Source, name: &str, at: usize) -> Result<Option<bool>, Refusal> {
    match standing {
        Standing::Dead => Ok(None),
        Standing::Compiled => Ok(Some(false)),
        Standing::Unless(defined) if *defined == name => Ok(Some(true)),
        Standing::Unless(_) | Standing::Unknown => {
            let why = format!("'{name}' is defined under a condition, which is not evaluated here");
            Err(Refusal::at(&source.code, at, why))
        }
    }
}

/// The macros of this name.
fn macros<'t>(source: &'t Source, name: &str) -> Result<Vec<Definition<'t>>, Refusal> {
    let mut found = Vec::new();
    for Line { at, text, standing } in source.lines() {
        let Some((directive, rest)) = Source::directive(text) else { continue };
        match directive {
            "undef" if word(rest).0 == name && standing != Standing::Dead => {
                return Err(Refusal::at(&source.code, at, format!("'{name}' is taken back by #undef")));
            }
            "define" => {
                let (defined, body) = word(rest);
                if defined != name {
                    continue;
                }
                let Some(is_default) = is_default(&standing, source, name, at)? else { continue };
                if body.starts_with('(') {
                    return Err(Refusal::at(&source.code, at, format!("'{name}' is a macro with arguments")));
                }
                found.push(Definition { at, body: body.trim(), kind: Kind::Macro, is_default });
            }
            _ => {}
        }
    }
    Ok(found)
}

/// Words of a declaration that change neither its type nor that its value is fixed.
const QUALIFIERS: [&str; 8] = ["const", "constexpr", "static", "inline", "extern", "volatile", "register", "constinit"];

/// The constants of this name: statements `.. const .. NAME = body;`. Beside them, where the name stands in another form.
fn constants<'t>(source: &'t Source, name: &str) -> Result<(Vec<Definition<'t>>, Option<usize>), Refusal> {
    let code = &source.code;
    let (mut found, mut other) = (Vec::new(), None);
    for at in source.places_of(name) {
        let standing = source.standing_at(at);
        if standing == Standing::Dead {
            continue;
        }
        let start = code[..at].rfind([';', '{', '}']).map_or(0, |k| k + 1);
        // A directive before the declaration ends with its line.
        let declaration = code[start..at].lines().filter(|line| !line.trim_start().starts_with('#'));
        let words: Vec<&str> = declaration.flat_map(str::split_whitespace).collect();
        let behind = code[at + name.len()..].trim_start();
        let is_plain = |word: &&str| word.chars().all(|c| c.is_alphanumeric() || "_:<>".contains(c));
        let is_declared = !words.is_empty() && words.iter().all(is_plain);
        let is_array = behind.starts_with('[') || behind.starts_with('{');
        if !is_declared || !(behind.starts_with('=') && !behind.starts_with("==") || is_array) {
            other = other.or(Some(at).filter(|_| !behind.starts_with(';') && !behind.starts_with(')')));
            continue;
        }
        let refuse = |why: &str| Err(Refusal::at(code, at, format!("'{name}' {why}")));
        if is_array {
            return refuse("is not a single number with '='");
        }
        if !words.iter().any(|w| ["const", "constexpr"].contains(w)) {
            return refuse("is a variable: without 'const' it may have another value");
        }
        if source.is_inside_braces(at) {
            return refuse("belongs to a function or a class");
        }
        let body = behind[1..].split_once(';').map_or(&behind[1..], |(body, _)| body);
        let words = words.into_iter().filter(|w| !QUALIFIERS.contains(w)).collect();
        let Some(is_default) = is_default(&standing, source, name, at)? else { continue };
        found.push(Definition { at, body: body.trim(), kind: Kind::Constant(words), is_default });
    }
    Ok((found, other))
}
