//! Tokens to the syntax tree: a Pratt parser.
//!
//! Powers bind tighter than the minus sign in front (`-a^2` is `-(a^2)`) and group to the right;
//! exponents are integers, known when the text is read.

use super::expression::{Expression, Factor, Node, Sign};
use super::function::{Function, call_hint, is_function_elsewhere};
use super::lexer::{Products, Token, TokenKind, lex};
use super::located::Text;
use crate::error::{Code, Diagnostic, Diagnostics, Source, Span};
use jurist_algebra::number::{Integer, Rational};

/// Parentheses, signs and powers may nest this deep. The parser recurses a few frames per level
/// in a debug build, far from the two megabytes a thread has.
pub const MAX_DEPTH: usize = 200;

/// Exponents may be this large. A loop of order 1000 is far beyond what can be decided.
pub const MAX_EXPONENT: i64 = 1000;

/// Binding powers, weakest first.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const PREFIX: u8 = 3;
const POWER: u8 = 4;

/// Units that are written after numbers by mistake, and their prefixes.
const UNITS: [&str; 14] = ["s", "Hz", "rad", "deg", "V", "A", "Ohm", "H", "F", "N", "Nm", "g", "m", "W"];
const PREFIXES: [&str; 7] = ["", "n", "u", "m", "k", "M", "G"];

impl Expression {
    /// Reads an expression that stands alone, such as one given on the command line.
    ///
    /// Cost: linear in the text, but for the conversion of its numbers.
    ///
    /// # Errors
    /// `E-syntax`, `E-number`, `E-exponent` or `E-too-deep`, pointing into `text`.
    pub fn parse(text: &str) -> Result<Expression, Diagnostics> {
        let source = Source::new("<expression>", text);
        parse(&Text::verbatim(text, 0)).map_err(|d| Diagnostics::new(Some(source), vec![d]))
    }
}

/// Reads an expression out of a file.
pub(crate) fn parse(text: &Text) -> Result<Expression, Diagnostic> {
    parse_with(text, Products::Written).map(|(expression, _)| expression)
}

/// Reads an expression in which products may be written without an operator; gives the places in the source where one is left out.
pub(crate) fn parse_implied(text: &Text) -> Result<(Expression, Vec<usize>), Diagnostic> {
    parse_with(text, Products::Implied)
}

fn parse_with(text: &Text, products: Products) -> Result<(Expression, Vec<usize>), Diagnostic> {
    let tokens = lex(text, products)?;
    if tokens.len() == 1 {
        let error = Diagnostic::error(Code::Syntax, "an expression is missing").at(text.span(), "empty");
        return Err(error.help("write a number, a name, or a formula of them"));
    }
    let mut parser = Parser { tokens: &tokens, position: 0, depth: 0, products, implied: Vec::new() };
    let expression = parser.expression(SUM)?;
    match &parser.peek().kind {
        TokenKind::End => Ok((expression, parser.implied)),
        TokenKind::Close => {
            Err(Diagnostic::error(Code::Syntax, "unmatched ')'").at(parser.peek().span, "nothing to close"))
        }
        other => Err(parser.missing_operator(other)),
    }
}

struct Parser<'t> {
    tokens: &'t [Token],
    position: usize,
    depth: usize,
    products: Products,
    /// Where factors begin that have no operator in front.
    implied: Vec<usize>,
}

impl Parser<'_> {
    fn peek(&self) -> &Token {
        // The last token is `End` and is never passed.
        &self.tokens[self.position]
    }

    fn advance(&mut self) -> Token {
        let token = self.peek().clone();
        self.position = (self.position + 1).min(self.tokens.len() - 1);
        token
    }

    fn missing_operator(&self, found: &TokenKind) -> Diagnostic {
        let after_number = self.position.checked_sub(1).map(|i| &self.tokens[i].kind);
        let is_unit =
            |name: &str| UNITS.iter().any(|unit| name.strip_suffix(unit).is_some_and(|p| PREFIXES.contains(&p)));
        let help = match (after_number, found) {
            (Some(TokenKind::Number(_)), TokenKind::Name(name)) if is_unit(name) => {
                "numbers have no unit, 100 us is 100e-6; multiplication is written out: 'a*b', not 'a b'"
            }
            _ => "multiplication is written out: 'a*b', not 'a b'",
        };
        Diagnostic::error(Code::Syntax, format!("an operator is missing before {}", found.describe()))
            .at(self.peek().span, "expected an operator")
            .help(help)
    }

    fn deeper(&mut self, span: Span) -> Result<(), Diagnostic> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let message = format!("the expression is nested more than {MAX_DEPTH} levels deep");
            return Err(Diagnostic::error(Code::TooDeep, message)
                .at(span, "too deep here")
                .help("give parts of it a name in [constants]"));
        }
        Ok(())
    }

    /// An expression of operators that bind at least as tightly as `least`.
    fn expression(&mut self, least: u8) -> Result<Expression, Diagnostic> {
        let mut left = self.prefix()?;
        loop {
            let operator = &self.peek().kind;
            match operator {
                TokenKind::Plus | TokenKind::Minus if least <= SUM => left = self.sum(left)?,
                TokenKind::Times | TokenKind::Over if least <= PRODUCT => left = self.product(left)?,
                _ if least <= PRODUCT && self.is_implied_factor() => left = self.product(left)?,
                TokenKind::Power if least <= POWER => left = self.power(left)?,
                _ => return Ok(left),
            }
        }
    }

    fn sum(&mut self, first: Expression) -> Result<Expression, Diagnostic> {
        let mut span = first.span;
        let mut terms = vec![(Sign::Plus, first)];
        loop {
            let sign = match self.peek().kind {
                TokenKind::Plus => Sign::Plus,
                TokenKind::Minus => Sign::Minus,
                _ => return Ok(Expression { span, node: Node::Sum(terms) }),
            };
            self.advance();
            let term = self.expression(PRODUCT)?;
            span = span.to(term.span);
            terms.push((sign, term));
        }
    }

    fn product(&mut self, first: Expression) -> Result<Expression, Diagnostic> {
        let mut span = first.span;
        let mut factors = vec![(Factor::Times, first)];
        loop {
            let factor = match self.peek().kind {
                TokenKind::Times => Factor::Times,
                TokenKind::Over => Factor::Over,
                _ if self.is_implied_factor() => {
                    self.implied_factor(factors.last())?;
                    Factor::Times
                }
                _ => return Ok(Expression { span, node: Node::Product(factors) }),
            };
            if self.is_operator() {
                let operator = self.advance();
                if factor == Factor::Times && self.peek().kind == TokenKind::Times {
                    let span = operator.span.to(self.peek().span);
                    let error = Diagnostic::error(Code::Syntax, "unexpected '**'").at(span, "not an operator");
                    return Err(error.help("powers are written with '^'"));
                }
            }
            let operand = self.expression(PREFIX)?;
            span = span.to(operand.span);
            factors.push((factor, operand));
        }
    }

    fn is_operator(&self) -> bool {
        matches!(self.peek().kind, TokenKind::Times | TokenKind::Over)
    }

    /// True if a factor begins here that is written without an operator: a parenthesis, or a name after a number or a parenthesis.
    fn is_implied_factor(&self) -> bool {
        let before = self.position.checked_sub(1).map(|i| &self.tokens[i].kind);
        self.products == Products::Implied
            && match self.peek().kind {
                TokenKind::Open => true,
                TokenKind::Name(_) => matches!(before, Some(TokenKind::Number(_) | TokenKind::Close)),
                _ => false,
            }
    }

    /// Notes a factor without an operator. After a division it could belong to the denominator or not: that is refused.
    fn implied_factor(&mut self, before: Option<&(Factor, Expression)>) -> Result<(), Diagnostic> {
        let here = self.peek().span;
        if let Some((Factor::Over, divisor)) = before {
            let error = Diagnostic::error(Code::Syntax, "this product can be read in two ways")
                .at(here, "in the denominator, or behind the fraction?")
                .also(divisor.span, "divided by this");
            return Err(error.help("write parentheses: 'K/(s*(s + 1))' or '(K/s)*(s + 1)'"));
        }
        self.implied.push(here.start);
        Ok(())
    }

    fn power(&mut self, base: Expression) -> Result<Expression, Diagnostic> {
        let operator = self.advance();
        self.deeper(operator.span)?;
        let exponent = self.expression(PREFIX)?;
        self.depth -= 1;
        let value = integer_exponent(&base, &exponent)?;
        Ok(Expression { span: base.span.to(exponent.span), node: Node::Power(Box::new(base), value) })
    }

    fn prefix(&mut self) -> Result<Expression, Diagnostic> {
        let token = self.advance();
        match token.kind {
            TokenKind::Number(value) => Ok(Expression { span: token.span, node: Node::Number(value) }),
            TokenKind::Name(name) => {
                if self.peek().kind == TokenKind::Open {
                    return self.call(&name, token.span);
                }
                Ok(Expression { span: token.span, node: Node::Name(name) })
            }
            TokenKind::Minus | TokenKind::Plus => {
                self.deeper(token.span)?;
                let inner = self.expression(PREFIX)?;
                self.depth -= 1;
                let span = token.span.to(inner.span);
                if token.kind == TokenKind::Plus {
                    return Ok(Expression { span, node: inner.node });
                }
                Ok(Expression { span, node: Node::Negative(Box::new(inner)) })
            }
            TokenKind::Open => {
                let (inner, span) = self.group(token.span)?;
                Ok(Expression { span, node: inner.node })
            }
            kind => Err(Diagnostic::error(
                Code::Syntax,
                format!("expected a number, a name or '(', found {}", kind.describe()),
            )
            .at(token.span, "unexpected")),
        }
    }

    /// What stands between the parenthesis at `open`, which has been read, and the one that closes it; and the place of both.
    fn group(&mut self, open: Span) -> Result<(Expression, Span), Diagnostic> {
        self.deeper(open)?;
        let inner = self.expression(SUM)?;
        self.depth -= 1;
        let close = self.peek().clone();
        if close.kind != TokenKind::Close {
            if close.kind == TokenKind::End {
                return Err(Diagnostic::error(Code::Syntax, "')' is missing")
                    .at(close.span, "expected ')'")
                    .also(open, "to close this"));
            }
            return Err(self.missing_operator(&close.kind));
        }
        self.advance();
        Ok((inner, open.to(close.span)))
    }

    /// A function of what stands in the parentheses that begin here; a name before them where products may be implied.
    fn call(&mut self, name: &str, place: Span) -> Result<Expression, Diagnostic> {
        let Some(function) = Function::named(name) else {
            if self.products == Products::Implied && !is_function_elsewhere(name) {
                self.refuse_argument(name, place)?;
                return Ok(Expression { span: place, node: Node::Name(name.to_owned()) });
            }
            let open = self.advance().span;
            let message =
                format!("'{}(' looks like a call, but there is no such function", super::names::shorten(name));
            let error =
                Diagnostic::error(Code::Syntax, message).at(place.to(open), "no function, and no operator here");
            return Err(error.help(call_hint(name)));
        };
        let open = self.advance().span;
        let (value, end) = self.group(open)?;
        Ok(Expression { span: place.to(end), node: Node::Call(function, Box::new(value)) })
    }

    /// Refuses `G(s)`: it may be a product or the name of a function.
    fn refuse_argument(&self, name: &str, place: Span) -> Result<(), Diagnostic> {
        let is_variable = |name: &str| name == "s" || name == "z";
        match &self.tokens[self.position..] {
            [_, Token { kind: TokenKind::Name(argument), .. }, close, ..]
                if close.kind == TokenKind::Close && is_variable(argument) && !is_variable(name) =>
            {
                let name = super::names::shorten(name);
                let error = Diagnostic::error(Code::Syntax, format!("'{name}({argument})' can be read in two ways"))
                    .at(place.to(close.span), "a product, or a function's name?");
                Err(error.help(format!("write the product as '{name}*{argument}', and a function as its formula")))
            }
            _ => Ok(()),
        }
    }
}

/// The value of an exponent, which must be an integer of moderate size.
fn integer_exponent(base: &Expression, exponent: &Expression) -> Result<i64, Diagnostic> {
    if !exponent.is_constant() {
        let help = match &base.node {
            Node::Name(name) if name == "e" => "the exponential of x is written 'exp(x)'",
            _ => "exponents fix the order of the loop: write its value as a number, such as 'z^3'",
        };
        return Err(Diagnostic::error(Code::Exponent, "an exponent must be a whole number, written as a number")
            .at(exponent.span, "contains a name or a function")
            .help(help));
    }
    let too_large = || {
        Diagnostic::error(Code::Exponent, "the exponent is too large")
            .at(exponent.span, format!("beyond {MAX_EXPONENT}"))
            .help(format!("exponents from -{MAX_EXPONENT} to {MAX_EXPONENT} are accepted"))
    };
    let value = small_value(exponent).ok_or_else(too_large)?;
    let Some(value) = value else {
        let error = Diagnostic::error(Code::DivisionByZero, "division by zero in an exponent");
        return Err(error.at(exponent.span, "has no value"));
    };
    if !value.is_integer() {
        return Err(Diagnostic::error(Code::Exponent, "an exponent must be a whole number")
            .at(exponent.span, "not a whole number")
            .help("the square root is written sqrt(..)"));
    }
    let value = value.numerator();
    if value.abs() > Integer::from(MAX_EXPONENT) {
        return Err(too_large());
    }
    value.to_i64().ok_or_else(too_large)
}

/// The value of a constant expression: `None` when it grows too large on the way, `Some(None)`
/// when it divides by zero.
fn small_value(e: &Expression) -> Option<Option<Rational>> {
    /// Intermediate results beyond this are no sensible exponent.
    const MAX_BITS: u64 = 4096;
    macro_rules! value {
        ($e:expr) => {
            match small_value($e)? {
                Some(value) => value,
                None => return Some(None),
            }
        };
    }
    let result = match &e.node {
        Node::Number(value) => value.clone(),
        Node::Name(_) | Node::Call(..) => return Some(None),
        Node::Negative(inner) => -value!(inner),
        Node::Sum(terms) => {
            let mut sum = Rational::ZERO;
            for (sign, term) in terms {
                let term = value!(term);
                sum = if *sign == Sign::Plus { sum + term } else { sum - term };
            }
            sum
        }
        Node::Product(factors) => {
            let mut product = Rational::ONE;
            for (factor, e) in factors {
                let value = value!(e);
                product = match factor {
                    Factor::Times => product * value,
                    Factor::Over => match product.checked_div(&value) {
                        Some(quotient) => quotient,
                        None => return Some(None),
                    },
                };
                if product.numerator().bit_length() + product.denominator().bit_length() > MAX_BITS {
                    return None;
                }
            }
            product
        }
        Node::Power(base, exponent) => {
            let base = value!(base);
            let bits = base.numerator().bit_length().max(base.denominator().bit_length());
            if bits > 1 && bits.saturating_mul(exponent.unsigned_abs()) > MAX_BITS {
                return None;
            }
            match base.pow(*exponent) {
                Some(power) => power,
                None => return Some(None),
            }
        }
    };
    let small = result.numerator().bit_length() + result.denominator().bit_length() <= MAX_BITS;
    small.then_some(Some(result))
}
