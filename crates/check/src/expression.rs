//! Expressions: read and evaluated in one pass.

use super::clock::Clock;
use super::factor::{Cut, PutIn};
use super::moving::{Function, Moving};
use super::multivariate::{Fraction, Multi};
use super::number::{Q, decimal, shorten};
use super::toml::Toml;
use num_traits::{One, ToPrimitive, Zero};
use std::collections::{BTreeMap, BTreeSet};

/// Parentheses, signs and exponents may nest this deep.
pub(super) const MAX_NESTING: usize = 200;

/// Exponents may be this large.
const MAX_POWER: i64 = 1000;

/// The name of the imaginary unit.
pub(super) const UNIT: &str = "j";

/// The dead time of which all others are whole multiples.
#[derive(Clone, Copy)]
pub(super) enum Base<'q> {
    /// This times the parameter in question.
    OfParameter(&'q Q),
    /// A number.
    Number(&'q Q),
}

/// How dead time is read: `exp(-k base s)`, or `exp(-k base p s)` of the parameter `p` in question, is the power `k` of one more
/// variable.
pub(super) struct DeadTime {
    pub base: Q,
    /// The power of the parameter: 0 or 1.
    pub power: usize,
    /// Values of the variables; the one of dead time follows.
    pub values: Vec<Q>,
}

/// Dead times that are greater multiples of the base are refused.
const MAX_MULTIPLE: u32 = 256;

/// What names mean, and everything that was divided by.
pub(super) struct Scope<'c> {
    /// Where it is read.
    pub dead_time: Option<DeadTime>,
    /// The variable that is the imaginary unit, where the name has no other meaning.
    pub unit: Option<usize>,
    /// A factor at a cut of the loop.
    pub factor: Option<PutIn>,
    /// Functions and holds, where they are read as further variables.
    pub moving: Option<Moving>,
    /// Values of constants.
    pub constants: BTreeMap<String, Fraction>,
    /// Constants that are matrices.
    pub matrices: BTreeMap<String, Vec<Vec<Fraction>>>,
    /// Numbers of variables, from 1 on.
    pub parameters: BTreeMap<String, usize>,
    /// Every divisor, as a polynomial: the model is undefined where it vanishes identically in variable 0.
    pub divisors: BTreeSet<Multi>,
    pub clock: &'c Clock,
}

/// A constant part and the coefficients of signals.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    pub constant: Fraction,
    pub signals: BTreeMap<usize, Fraction>,
}

/// What may occur in an expression beside constants and parameters.
#[derive(Clone, Copy)]
pub(super) enum Names<'n> {
    /// Nothing.
    Scalar,
    /// Variable 0 by its name.
    Variable(&'n str),
    /// Variable 0, by which nothing is divided.
    Polynomial(&'n str),
    /// Signals and their numbers.
    Signals(&'n BTreeMap<String, usize>),
    /// Nothing, not even constants and parameters.
    Numbers,
}

impl<'c> Scope<'c> {
    pub fn new(parameters: BTreeMap<String, usize>, clock: &'c Clock) -> Self {
        Scope {
            dead_time: None,
            unit: None,
            factor: None,
            moving: None,
            constants: BTreeMap::new(),
            matrices: BTreeMap::new(),
            parameters,
            divisors: BTreeSet::new(),
            clock,
        }
    }

    /// A number, or an expression in constants and parameters.
    pub fn scalar(&mut self, value: &Toml) -> Result<Fraction, String> {
        self.value(value, Names::Scalar)
    }

    /// A number, or an expression without signals.
    pub fn value(&mut self, value: &Toml, names: Names<'_>) -> Result<Fraction, String> {
        Ok(self.evaluate(value.expression()?, names)?.constant)
    }

    /// The coefficients of signals in an expression that is linear in them, without a constant term.
    pub fn linear(
        &mut self,
        value: &Toml,
        signals: &BTreeMap<String, usize>,
    ) -> Result<BTreeMap<usize, Fraction>, String> {
        let value = self.evaluate(value.expression()?, Names::Signals(signals))?;
        if !value.constant.numerator.is_zero() {
            return Err("an input or output has a constant term".into());
        }
        Ok(value.signals)
    }

    /// The power of the variable of dead time for `tau` times a power of the loop's variable.
    pub fn delayed(&self, tau: &Fraction, power: usize) -> Result<Fraction, String> {
        let of = self.dead_time.as_ref().ok_or("there is no dead time here")?;
        self.real(tau.clone())?;
        let top = tau.numerator.specialised(1, &of.values, self.clock)?;
        let bottom = tau.whole_denominator(self.clock)?.specialised(1, &of.values, self.clock)?;
        let (mut coefficient, mut divisor) = (Q::zero(), Q::zero());
        for (rows, at, number) in [(&top, (power, of.power), &mut coefficient), (&bottom, (0, 0), &mut divisor)] {
            for (i, row) in rows.iter().enumerate() {
                for (j, c) in row.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                    if (i, j) != at {
                        return Err("a dead time is no number, or not a multiple of the parameter".into());
                    }
                    number.clone_from(c);
                }
            }
        }
        let multiple = Some(divisor).filter(|d| !d.is_zero()).map(|d| coefficient / d / &of.base);
        let k = multiple.filter(Q::is_integer).and_then(|k| k.to_integer().to_u32());
        let k = k.filter(|k| (1..=MAX_MULTIPLE).contains(k)).ok_or("a dead time is not a multiple of the base")?;
        Fraction::variable(of.values.len()).power(k, self.clock)
    }

    /// Whether a constant or a parameter has this name.
    pub fn knows(&self, name: &str) -> bool {
        self.parameters.contains_key(name) || self.constants.contains_key(name)
    }

    /// The `tau` of `-tau*s`.
    pub fn time_of_exponent(&mut self, text: &str) -> Result<Fraction, String> {
        let Fraction { numerator, denominator, scalar } = self.evaluate(text, Names::Variable("s"))?.constant;
        match numerator.coefficients(0).as_slice() {
            [constant, of_s] if constant.is_zero() && denominator.degree(0) == 0 => {
                Ok(Fraction { numerator: of_s.clone(), denominator, scalar }.negated())
            }
            _ => Err(format!("the exponent '{}' is no dead time times s", shorten(text))),
        }
    }

    fn evaluate(&mut self, text: &str, names: Names<'_>) -> Result<Linear, String> {
        let mut parser = Parser { scope: self, names, rest: text, nesting: 0 };
        let value = parser.sum().and_then(|value| match parser.next_char() {
            None => Ok(value),
            Some(c) => Err(format!("'{}' is not expected here", c.escape_debug())),
        });
        value.map_err(|e| format!("{e}, in '{}'", shorten(text)))
    }

    /// The value of a name, with the factor if the loop is cut there.
    fn with_factor(&self, name: &str, value: Fraction) -> Result<Fraction, String> {
        match &self.factor {
            Some(PutIn { cut: Cut::Parameter(cut), value: factor, .. }) if cut == name => {
                value.times(factor, self.clock)
            }
            _ => Ok(value),
        }
    }

    /// `1/value`, noting the divisor.
    fn inverse(&mut self, value: &Fraction, names: Names<'_>) -> Result<Fraction, String> {
        if value.numerator.is_zero() {
            return Err("division by an expression that is zero everywhere".into());
        }
        if matches!(names, Names::Polynomial(_)) && value.numerator.degree(0) > 0 {
            return Err("the characteristic polynomial divides by its variable".into());
        }
        if !value.numerator.is_constant() {
            self.divisors.insert(value.numerator.clone());
        }
        value.inverse(self.clock)
    }
}

/// The value of a number or of an expression of numbers.
pub(super) fn number(value: &Toml, clock: &Clock) -> Result<Q, String> {
    let value = Scope::new(BTreeMap::new(), clock).value(value, Names::Numbers)?;
    value.as_number().ok_or_else(|| "internal: a number has variables".into())
}

/// Whether a text is a name.
pub(super) fn is_name(text: &str) -> bool {
    name_length(text) == text.len() && !text.is_empty()
}

/// How long the name is with which a text begins; 0 if it begins with none.
pub(super) fn name_length(text: &str) -> usize {
    // Letters that are drawn as nothing: in a name they would hide what is meant.
    let is_blank = |c: char| matches!(c, '\u{115f}' | '\u{1160}' | '\u{3164}' | '\u{ffa0}');
    if text.starts_with(|c: char| c == '_' || (c.is_alphabetic() && !is_blank(c))) {
        text.find(|c: char| !(c == '_' || (c.is_alphanumeric() && !is_blank(c)))).unwrap_or(text.len())
    } else {
        0
    }
}

/// How long the number is with which a text begins.
pub(super) fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    let digits = |mut i: usize| {
        while digit(i) || (bytes.get(i) == Some(&b'_') && i > 0 && digit(i - 1) && digit(i + 1)) {
            i += 1;
        }
        i
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if digit(end + 1 + sign) {
            end = digits(end + 1 + sign);
        }
    }
    end
}

/// The names that occur in an expression, in the order of the text.
pub(super) fn names_in(text: &str) -> Vec<&str> {
    let (mut names, mut rest) = (Vec::new(), text);
    while let Some(c) = rest.chars().next() {
        let length = name_length(rest);
        if length > 0 {
            names.push(&rest[..length]);
        }
        rest = &rest[length.max(number_length(rest)).max(c.len_utf8())..];
    }
    names
}

struct Parser<'s, 'c, 't> {
    scope: &'s mut Scope<'c>,
    names: Names<'t>,
    rest: &'t str,
    nesting: usize,
}

impl<'t> Parser<'_, '_, 't> {
    fn next_char(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    fn eat(&mut self, c: char) -> bool {
        let found = self.next_char() == Some(c);
        if found {
            self.rest = &self.rest[c.len_utf8()..];
        }
        found
    }

    /// A part of an expression, one level deeper.
    fn nested(&mut self, part: impl FnOnce(&mut Self) -> Result<Linear, String>) -> Result<Linear, String> {
        self.nesting += 1;
        if self.nesting > MAX_NESTING {
            return Err("an expression is nested too deep".into());
        }
        let value = part(self)?;
        self.nesting -= 1;
        Ok(value)
    }

    fn sum(&mut self) -> Result<Linear, String> {
        let mut sum = self.product()?;
        loop {
            let minus = match self.next_char() {
                Some('+') => false,
                Some('-') => true,
                _ => return Ok(sum),
            };
            self.rest = &self.rest[1..];
            let mut term = self.product()?;
            if minus {
                term = negated(term);
            }
            sum.constant = self.scope.short(sum.constant.plus(&term.constant, self.scope.clock)?)?;
            for (i, c) in term.signals {
                let joined = match sum.signals.remove(&i) {
                    Some(old) => self.scope.short(old.plus(&c, self.scope.clock)?)?,
                    None => c,
                };
                sum.signals.insert(i, joined);
            }
        }
    }

    fn product(&mut self) -> Result<Linear, String> {
        let mut product = self.prefix()?;
        loop {
            let divide = match self.next_char() {
                Some('*') => false,
                Some('/') => true,
                _ => return Ok(product),
            };
            self.rest = &self.rest[1..];
            let mut factor = self.prefix()?;
            if divide {
                if !factor.signals.is_empty() {
                    return Err("division by a signal".into());
                }
                factor.constant = self.scope.inverse(&factor.constant, self.names)?;
            }
            let (mut signals, scale) = match (product.signals.is_empty(), factor.signals.is_empty()) {
                (false, false) => return Err("a product of signals".into()),
                (true, _) => (factor, product.constant),
                (false, true) => (product, factor.constant),
            };
            signals.constant = self.scope.short(signals.constant.times(&scale, self.scope.clock)?)?;
            for c in signals.signals.values_mut() {
                *c = self.scope.short(c.times(&scale, self.scope.clock)?)?;
            }
            product = signals;
        }
    }

    /// Signs bind more weakly than powers.
    fn prefix(&mut self) -> Result<Linear, String> {
        self.scope.clock.tick()?;
        if self.eat('-') {
            return self.nested(Self::prefix).map(negated);
        }
        if self.eat('+') {
            return self.nested(Self::prefix);
        }
        let base = self.atom()?;
        if self.eat('^') { self.power(base) } else { Ok(base) }
    }

    fn power(&mut self, base: Linear) -> Result<Linear, String> {
        let names = std::mem::replace(&mut self.names, Names::Numbers);
        let exponent = self.nested(Self::prefix)?;
        self.names = names;
        let e = exponent.constant.as_number().filter(Q::is_integer).and_then(|q| q.to_integer().to_i64());
        let Some(e) = e.filter(|e| e.abs() <= MAX_POWER) else {
            return Err(format!("an exponent is not an integer of at most {MAX_POWER}"));
        };
        if !base.signals.is_empty() {
            return if e == 1 { Ok(base) } else { Err("a power of a signal".into()) };
        }
        let value = if e < 0 { self.scope.inverse(&base.constant, self.names)? } else { base.constant };
        let constant = self.scope.short(value.power(e.unsigned_abs() as u32, self.scope.clock)?)?;
        Ok(Linear { constant, signals: BTreeMap::new() })
    }

    fn atom(&mut self) -> Result<Linear, String> {
        let Some(c) = self.next_char() else { return Err("an expression ends too early".into()) };
        if self.eat('(') {
            let value = self.nested(Self::sum)?;
            return if self.eat(')') { Ok(value) } else { Err("')' is missing".into()) };
        }
        if c.is_ascii_digit() || c == '.' {
            return self.number();
        }
        let (name, rest) = self.rest.split_at(name_length(self.rest));
        if name.is_empty() {
            return Err(format!("'{}' is not expected here", c.escape_debug()));
        }
        self.rest = rest;
        let plain = |constant| Linear { constant, signals: BTreeMap::new() };
        if matches!(self.names, Names::Numbers) {
            return Err(format!("the name '{}' where only numbers may stand", shorten(name)));
        }
        let is_known = self.scope.knows(name);
        if name == "exp" && !is_known && self.scope.dead_time.is_some() && self.eat('(') {
            let argument = self.argument()?;
            return Ok(plain(self.scope.delayed(&argument.negated(), 1)?));
        }
        if matches!(self.names, Names::Variable(variable) | Names::Polynomial(variable) if variable == name) {
            return Ok(plain(Fraction::variable(0)));
        }
        if let (Some(function), false, true) = (Function::named(name), is_known, self.scope.moving.is_some())
            && self.eat('(')
        {
            let argument = self.argument()?;
            return Ok(plain(self.scope.of_function(function, argument)?));
        }
        if matches!(name, "conj" | "re" | "im") && !is_known && self.eat('(') {
            let argument = self.argument()?;
            return Ok(plain(self.scope.of_complex(name, &argument)?));
        }
        if let Names::Signals(signals) = self.names
            && let Some(&i) = signals.get(name)
        {
            let signals = BTreeMap::from([(i, Fraction::number(&Q::one()))]);
            return Ok(Linear { constant: Fraction::number(&Q::zero()), signals });
        }
        if let Some(&i) = self.scope.parameters.get(name) {
            return Ok(plain(self.scope.with_factor(name, Fraction::variable(i))?));
        }
        if let ("pi", false, Some(moving)) = (name, is_known, self.scope.moving.as_mut()) {
            return Ok(plain(moving.pi()));
        }
        if let (UNIT, false, Some(unit)) = (name, is_known, self.scope.unit) {
            return Ok(plain(Fraction::variable(unit)));
        }
        let constant = self.scope.constants.get(name).cloned();
        let constant = constant.ok_or_else(|| format!("unknown name '{}'", shorten(name)))?;
        Ok(plain(self.scope.with_factor(name, constant)?))
    }

    /// What a function is taken of, behind its opening bracket.
    fn argument(&mut self) -> Result<Fraction, String> {
        let argument = self.nested(Self::sum)?;
        if !self.eat(')') {
            return Err("')' is missing".into());
        }
        if argument.signals.is_empty() { Ok(argument.constant) } else { Err("a function of a signal".into()) }
    }

    fn number(&mut self) -> Result<Linear, String> {
        let (text, rest) = self.rest.split_at(number_length(self.rest));
        if rest.starts_with(|c: char| c == '.' || c == '_' || c.is_alphanumeric()) {
            return Err("a number is followed by a letter".into());
        }
        self.rest = rest;
        let constant = Fraction::number(&decimal(&text.replace('_', ""))?);
        Ok(Linear { constant, signals: BTreeMap::new() })
    }
}

fn negated(value: Linear) -> Linear {
    Linear {
        constant: value.constant.negated(),
        signals: value.signals.into_iter().map(|(i, c)| (i, c.negated())).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn value(text: &str) -> Option<String> {
        let clock = Clock::new(Duration::MAX);
        number(&Toml::Text(text.to_owned()), &clock).ok().map(|q| q.to_string())
    }

    #[test]
    fn precedence_and_exactness() {
        for (text, expected) in [
            ("1 + 2*3", "7"),
            ("-2^2", "-4"),
            ("2^-1", "1/2"),
            ("2^3^2", "512"),
            ("2^-1^2", "1/2"),
            ("8/2/2", "2"),
            ("2*-3", "-6"),
            ("1 - -1", "2"),
            ("46e-3", "23/500"),
            (".5", "1/2"),
            ("5.", "5"),
            ("1_000", "1000"),
            ("0^0", "1"),
            ("(1 + 1)^(3 - 1)", "4"),
            ("10^20 + 1e-20*10^40", "200000000000000000000"),
        ] {
            assert_eq!(value(text).as_deref(), Some(expected), "{text}");
        }
        for text in
            ["", "1 +", "2e", "1..2", "a", "1/0", "0^-1", "2^(1/2)", "2^2000", "(1", "1)", "2 3", "1__0", "1e999999"]
        {
            assert_eq!(value(text), None, "{text}");
        }
        assert_eq!(value(&vec!["1"; 50_000].join("+")).as_deref(), Some("50000"));
    }

    /// On a stack of the size that a check has: without optimisation the levels need more than a test's own.
    #[test]
    fn nesting_has_a_limit() {
        let test = || {
            for (text, is_read) in [("(", true), ("-", true), ("2^", false)] {
                let nested = |n: usize| format!("{}1{}", text.repeat(n), ")".repeat(if text == "(" { n } else { 0 }));
                assert!(value(&nested(200)).is_some() || !is_read, "{text}");
                assert_eq!(value(&nested(201)), None, "{text}");
                assert_eq!(value(&nested(100_000)), None, "{text}");
            }
        };
        let thread = std::thread::Builder::new().stack_size(crate::STACK);
        thread.spawn(test).expect("a thread").join().expect("no panic");
    }

    #[test]
    fn powers_of_powers_are_counted_before_they_are_computed() {
        assert!(value("(9^999)^100").is_some());
        for text in ["(((9^999)^999)^999)^999", "(1 + (9^999)^999)^999", "((1/9^999)^999)^999"] {
            assert_eq!(value(text), None, "{text}");
        }
    }

    #[test]
    fn names_are_found_beside_numbers() {
        assert_eq!(names_in("1e5*a + 2e + .5e-3b_1(ω²^-c"), ["a", "e", "b_1", "ω²", "c"]);
        assert!(is_name("_") && is_name("ω_e²") && !is_name("") && !is_name("²d") && !is_name("1d") && !is_name("d e"));
    }
}
