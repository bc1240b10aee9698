//! Expressions: read and evaluated in one pass.

use super::multivariate::{Fraction, Multi};
use super::number::{Clock, Q, decimal, shorten};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::collections::{BTreeMap, HashMap};

/// Parentheses, signs, powers and constants that use each other may nest this deep.
const MAX_DEPTH: usize = 1000;

/// Exponents may be this large.
const MAX_POWER: i64 = 1000;

/// A constant of the model.
pub(super) enum Constant {
    /// Not yet evaluated: its text.
    Text(String),
    /// Being evaluated: a use now is a circle.
    Open,
    /// Its value.
    Known(Fraction),
}

/// What names mean, and everything that was divided by.
pub(super) struct Scope<'c> {
    pub constants: HashMap<String, Constant>,
    /// Numbers of variables, from 1 on.
    pub parameters: HashMap<String, usize>,
    /// Every divisor, as a polynomial: the model is undefined where it vanishes identically in variable 0.
    pub divisors: Vec<Multi>,
    pub clock: &'c Clock,
    depth: usize,
}

/// A constant part and the coefficients of signals.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    pub constant: Fraction,
    pub signals: BTreeMap<usize, Fraction>,
}

/// What may occur in an expression beside constants and parameters.
#[derive(Clone, Copy, Default)]
pub(super) struct Names<'n> {
    /// The name of variable 0.
    pub variable: Option<&'n str>,
    /// Signals and their numbers.
    pub signals: Option<&'n HashMap<String, usize>>,
    /// Whether nothing may occur but numbers.
    pub numbers_only: bool,
}

impl<'c> Scope<'c> {
    pub fn new(constants: HashMap<String, Constant>, parameters: HashMap<String, usize>, clock: &'c Clock) -> Self {
        Scope { constants, parameters, divisors: Vec::new(), clock, depth: 0 }
    }

    /// An expression in constants and parameters.
    pub fn scalar(&mut self, text: &str) -> Result<Fraction, String> {
        Ok(self.linear(text, Names::default())?.constant)
    }

    /// An expression in which `names` may occur as well.
    pub fn linear(&mut self, text: &str, names: Names<'_>) -> Result<Linear, String> {
        let depth = self.depth;
        let mut parser = Parser { scope: self, names, rest: text };
        let value = parser.sum().and_then(|value| match parser.next_char() {
            None => Ok(value),
            Some(c) => Err(format!("'{c}' is not expected here")),
        });
        self.depth = depth;
        value.map_err(|e| format!("{e}, in '{}'", shorten(text)))
    }

    /// Whether a text is an expression of numbers only.
    pub fn is_number(&mut self, text: &str) -> bool {
        let names = Names { numbers_only: true, ..Names::default() };
        let known = self.divisors.len();
        let number = self.linear(text, names).is_ok();
        self.divisors.truncate(known);
        number
    }

    pub fn constant(&mut self, name: &str) -> Result<Fraction, String> {
        let Some(entry) = self.constants.get_mut(name) else {
            return Err(format!("unknown name '{}'", shorten(name)));
        };
        match std::mem::replace(entry, Constant::Open) {
            Constant::Open => Err(format!("the constant '{}' uses itself", shorten(name))),
            Constant::Known(value) => {
                *entry = Constant::Known(value.clone());
                Ok(value)
            }
            Constant::Text(text) => {
                self.deeper()?;
                let value = self.scalar(&text)?;
                self.depth -= 1;
                self.constants.insert(name.to_owned(), Constant::Known(value.clone()));
                Ok(value)
            }
        }
    }

    fn deeper(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH { Err("expressions are nested too deep".into()) } else { Ok(()) }
    }

    /// `1/value`, noting the divisor.
    fn inverse(&mut self, value: &Fraction) -> Result<Fraction, String> {
        if value.numerator.is_zero() {
            return Err("division by an expression that is zero everywhere".into());
        }
        if !value.numerator.is_constant() && !self.divisors.contains(&value.numerator) {
            self.divisors.push(value.numerator.clone());
        }
        value.inverse(self.clock)
    }
}

struct Parser<'s, 'c, 't> {
    scope: &'s mut Scope<'c>,
    names: Names<'t>,
    rest: &'t str,
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
            sum.constant = sum.constant.plus(&term.constant, self.scope.clock)?;
            for (i, c) in term.signals {
                let joined = match sum.signals.remove(&i) {
                    Some(old) => old.plus(&c, self.scope.clock)?,
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
                factor.constant = self.scope.inverse(&factor.constant)?;
            }
            let (mut signals, scale) = match (product.signals.is_empty(), factor.signals.is_empty()) {
                (false, false) => return Err("a product of signals".into()),
                (true, _) => (factor, product.constant),
                (false, true) => (product, factor.constant),
            };
            signals.constant = signals.constant.times(&scale, self.scope.clock)?;
            for c in signals.signals.values_mut() {
                *c = c.times(&scale, self.scope.clock)?;
            }
            product = signals;
        }
    }

    /// Signs bind more weakly than powers.
    fn prefix(&mut self) -> Result<Linear, String> {
        self.scope.clock.tick()?;
        self.scope.deeper()?;
        let value = if self.eat('-') {
            negated(self.prefix()?)
        } else if self.eat('+') {
            self.prefix()?
        } else {
            let base = self.atom()?;
            if self.eat('^') { self.power(base)? } else { base }
        };
        self.scope.depth -= 1;
        Ok(value)
    }

    fn power(&mut self, base: Linear) -> Result<Linear, String> {
        let names = std::mem::replace(&mut self.names, Names { numbers_only: true, ..Names::default() });
        let exponent = self.prefix()?;
        self.names = names;
        let e = as_number(&exponent.constant).filter(Q::is_integer).and_then(|q| q.to_integer().to_i64());
        let Some(e) = e.filter(|e| e.abs() <= MAX_POWER) else {
            return Err(format!("an exponent is not an integer of at most {MAX_POWER}"));
        };
        if !base.signals.is_empty() {
            return if e == 1 { Ok(base) } else { Err("a power of a signal".into()) };
        }
        let value = if e < 0 { self.scope.inverse(&base.constant)? } else { base.constant };
        let constant = value.power(e.unsigned_abs() as u32, self.scope.clock)?;
        Ok(Linear { constant, signals: BTreeMap::new() })
    }

    fn atom(&mut self) -> Result<Linear, String> {
        let Some(c) = self.next_char() else { return Err("an expression ends too early".into()) };
        if self.eat('(') {
            let value = self.sum()?;
            return if self.eat(')') { Ok(value) } else { Err("')' is missing".into()) };
        }
        if c.is_ascii_digit() || c == '.' {
            return self.number();
        }
        if !(c == '_' || c.is_alphabetic()) {
            return Err(format!("'{c}' is not expected here"));
        }
        let length = self.rest.find(|c: char| !(c == '_' || c.is_alphanumeric())).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(length);
        self.rest = rest;
        let plain = |constant| Linear { constant, signals: BTreeMap::new() };
        if self.names.numbers_only {
            return Err(format!("the name '{}' where only numbers may stand", shorten(name)));
        }
        if self.names.variable == Some(name) {
            return Ok(plain(Fraction::variable(0)));
        }
        if let Some(&i) = self.names.signals.and_then(|s| s.get(name)) {
            let signals = BTreeMap::from([(i, Fraction::number(&Q::one()))]);
            return Ok(Linear { constant: Fraction::number(&Q::zero()), signals });
        }
        if let Some(&i) = self.scope.parameters.get(name) {
            return Ok(plain(Fraction::variable(i)));
        }
        self.scope.constant(name).map(plain)
    }

    fn number(&mut self) -> Result<Linear, String> {
        let bytes = self.rest.as_bytes();
        let digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
        let mut end = 0;
        let digits = |mut i: usize| {
            while digit(i) || (bytes.get(i) == Some(&b'_') && i > 0 && digit(i - 1) && digit(i + 1)) {
                i += 1;
            }
            i
        };
        end = digits(end);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            if digit(end + 1 + sign) {
                end = digits(end + 1 + sign);
            }
        }
        let (text, rest) = self.rest.split_at(end);
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

/// The value of a fraction without variables.
fn as_number(f: &Fraction) -> Option<Q> {
    if !(f.numerator.is_constant() && f.denominator.is_constant() && f.scalar.is_constant()) {
        return None;
    }
    let value = |m: &Multi| m.0.values().next().cloned().unwrap_or_default();
    let below = value(&f.scalar) * value(&f.denominator);
    if below.is_zero() { None } else { Some(Q::new(value(&f.numerator), below)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn value(text: &str) -> Option<String> {
        let clock = Clock::new(Duration::MAX);
        let mut scope = Scope::new(HashMap::new(), HashMap::new(), &clock);
        scope.scalar(text).ok().and_then(|f| as_number(&f)).map(|q| q.to_string())
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
        // The check runs on a stack of this size; that of a test is smaller.
        let deep = std::thread::Builder::new().stack_size(64 << 20).spawn(|| {
            assert_eq!(value(&"(".repeat(100_000)), None);
            assert_eq!(value(&"-".repeat(100_000)), None);
            assert_eq!(value(&"1+".repeat(50_000)), None);
        });
        deep.expect("a thread").join().expect("no overflow");
        assert!(!num_traits::Zero::is_zero(&Q::one().abs()));
    }
}
