//! Formulas, numbers and names in Coq's notation.

use jurist_algebra::number::{Integer, Rational, parse_number, to_decimal};
use jurist_algebra::poly::UniPoly;
use jurist_model::error::Source;
use jurist_model::{Expression, Factor, Node, Sign};
use std::collections::HashMap;

/// Words of Coq and of mathcomp's notations, and what a file of a loop uses itself.
const TAKEN: &str = "as at cofix do else end exists exists2 fix for forall fun if in is let lib match mod nosimpl of return \
    then using where with by IF Axiom CoFixpoint Definition Fixpoint Hypothesis Parameter Theorem Variable \
    SsrSyntax_is_Imported \
    Prop SProp Set Type R i p z x val expr matrix poly answer region list nil cons Num Par \
    Model checked limits stable_set coefficients only_root eigenvalue map_mx map_poly real_complex root mx qr complex \
    poly_of rcfType true True False";

/// The names of the model as names of Coq's, each of its own.
#[derive(Default)]
pub(super) struct Names {
    given: HashMap<String, String>,
    taken: Vec<String>,
}

impl Names {
    /// With further names that are taken.
    pub(super) fn new(taken: &[&str]) -> Names {
        let taken = TAKEN.split_whitespace().chain(taken.iter().copied()).map(str::to_owned).collect();
        Names { given: HashMap::new(), taken }
    }

    /// The same for the same name.
    pub(super) fn name(&mut self, name: &str) -> String {
        if let Some(known) = self.given.get(name) {
            return known.clone();
        }
        let fresh = self.fresh(name);
        self.given.insert(name.to_owned(), fresh.clone());
        fresh
    }

    /// A name that nothing else has.
    pub(super) fn fresh(&mut self, name: &str) -> String {
        let mut out = String::new();
        for c in name.chars() {
            match c {
                _ if c.is_ascii_alphanumeric() || c == '_' => out.push(c),
                _ => out.push_str(&format!("u{:x}", u32::from(c))),
            }
        }
        if !out.starts_with(|c: char| c.is_ascii_alphabetic()) {
            out.insert(0, 'n');
        }
        while self.taken.contains(&out) {
            out.push('_');
        }
        self.taken.push(out.clone());
        out
    }
}

/// A decimal, where the number is one.
fn decimal(value: &Rational) -> Option<String> {
    let mut rest = value.denominator();
    let mut places = 0_u64;
    for prime in [2, 5] {
        let prime = Integer::from(prime);
        while rest.divisible_by(&prime) {
            rest = rest.div_exact(&prime);
            places += 1;
        }
    }
    let digits = value.numerator().bit_length() + 4 * places + 1;
    let digits = usize::try_from(digits).ok()?;
    rest.is_one().then(|| if value.is_integer() { value.to_string() } else { to_decimal(value, digits) })
}

/// A rational number in Coq's scope `Q`.
pub(super) fn rational(value: &Rational) -> String {
    match decimal(value) {
        Some(text) if value.is_negative() => format!("({text})"),
        Some(text) => text,
        None => format!("({}#{})", value.numerator(), value.denominator()),
    }
}

/// A rational number as a formula.
pub(super) fn number_of(value: &Rational) -> String {
    decimal(value).filter(|text| text.len() < 24).unwrap_or_else(|| value.to_string())
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
    Atom,
}

/// Writes the formulas of a model.
pub(super) struct Formulas<'a> {
    pub(super) source: &'a Source,
    pub(super) names: Names,
}

impl Formulas<'_> {
    pub(super) fn text(&mut self, e: &Expression) -> String {
        self.at(e, Level::Sum)
    }

    fn at(&mut self, e: &Expression, least: Level) -> String {
        let (level, text) = match &e.node {
            Node::Number(value) => {
                let text = self.typed(e, value).unwrap_or_else(|| number_of(value));
                (if text.contains('/') || text.starts_with('-') { Level::Sum } else { Level::Atom }, text)
            }
            Node::Name(name) => (Level::Atom, self.names.name(name)),
            Node::Negative(inner) => (Level::Sum, format!("-{}", self.at(inner, Level::Power))),
            Node::Sum(terms) => (Level::Sum, self.sum(terms)),
            Node::Product(factors) => (Level::Product, self.product(factors)),
            Node::Power(base, k) if *k < 0 => {
                (Level::Product, format!("1/{}^{}", self.at(base, Level::Atom), k.unsigned_abs()))
            }
            Node::Power(base, k) => (Level::Power, format!("{}^{k}", self.at(base, Level::Atom))),
            Node::Call(..) => unreachable!("entries with functions are refused before"),
        };
        if level < least { format!("({text})") } else { text }
    }

    fn sum(&mut self, terms: &[(Sign, Expression)]) -> String {
        let mut out = String::new();
        for (i, (sign, term)) in terms.iter().enumerate() {
            out.push_str(sign.before(i == 0));
            let leading = i == 0 && *sign == Sign::Plus;
            out.push_str(&match &term.node {
                Node::Negative(_) | Node::Number(_) if leading => self.at(term, Level::Sum),
                _ => self.at(term, Level::Product),
            });
        }
        out
    }

    fn product(&mut self, factors: &[(Factor, Expression)]) -> String {
        let mut out = String::new();
        for (i, (factor, e)) in factors.iter().enumerate() {
            out.push_str(factor.before(i == 0));
            let leading = i == 0 && *factor == Factor::Times && matches!(e.node, Node::Negative(_));
            out.push_str(&self.at(e, if leading { Level::Sum } else { Level::Power }));
        }
        out
    }

    /// The number as the model has it, where Coq reads the same.
    fn typed(&self, e: &Expression, value: &Rational) -> Option<String> {
        let text = self.source.text.get(e.span.start..e.span.end)?;
        let plain = text.starts_with(|c: char| c.is_ascii_digit())
            && text.ends_with(|c: char| c.is_ascii_digit())
            && text.chars().all(|c| c.is_ascii_digit() || "eE.+-".contains(c))
            && !text.contains(".e")
            && !text.contains(".E");
        (plain && parse_number(text).ok()? == *value).then(|| text.to_owned())
    }
}

/// A polynomial over a whole number as a formula in one name, highest power first.
pub(super) fn polynomial(f: &UniPoly, over: &Integer, name: &str) -> String {
    let mut out = String::new();
    for (k, c) in f.coeffs().iter().enumerate().rev().filter(|(_, c)| !c.is_zero()) {
        let c = Rational::new(c.clone(), over.clone());
        out.push_str(match (out.is_empty(), c.is_negative()) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        });
        let power = if k == 1 { name.to_owned() } else { format!("{name}^{k}") };
        let size = c.abs();
        out.push_str(&match (k, size.is_one()) {
            (0, _) => number_of(&size),
            (_, true) => power,
            _ => format!("{}*{power}", number_of(&size)),
        });
    }
    if out.is_empty() { "0".to_owned() } else { out }
}
