//! The syntax tree of expressions.
//!
//! Sums and products are kept flat (`a - b + c` is one node with three terms), so that the depth
//! of the tree is the depth of nesting in the text, which the parser limits; walking the tree by
//! recursion is therefore safe for any input.

use super::function::Function;
use crate::error::Span;
use jurist_algebra::number::Rational;
use std::collections::BTreeSet;
use std::fmt;

/// An expression: names, exact numbers, `+ - * / ^` with integer exponents, parentheses, functions.
///
/// ```
/// use jurist_model::Expression;
/// let e = Expression::parse("-a^2 + 0.5*(b - 1)/c")?;
/// assert_eq!(e.to_string(), "-a^2 + 1/2*(b - 1)/c");
/// assert_eq!(e.names().into_iter().collect::<Vec<_>>(), ["a", "b", "c"]);
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Expression {
    /// Where it stands in the source text.
    pub span: Span,
    /// What it is.
    pub node: Node,
}

/// The forms an [`Expression`] can take.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// An exact number, not negative when it comes from text.
    Number(Rational),
    /// A constant, a parameter, a signal, or the polynomial variable.
    Name(String),
    /// `-x`.
    Negative(Box<Expression>),
    /// A sum of at least two terms.
    Sum(Vec<(Sign, Expression)>),
    /// A product of at least two factors, from left to right.
    Product(Vec<(Factor, Expression)>),
    /// An integer power.
    Power(Box<Expression>, i64),
    /// A function of a value.
    Call(Function, Box<Expression>),
}

/// How a term enters a sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Added.
    Plus,
    /// Subtracted.
    Minus,
}

/// How a factor enters a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// Multiplied.
    Times,
    /// Divided by.
    Over,
}

impl Sign {
    /// What stands before a term of a sum, the first or a later one.
    ///
    /// ```
    /// use jurist_model::Sign;
    /// assert_eq!((Sign::Plus.before(true), Sign::Minus.before(false)), ("", " - "));
    /// ```
    pub fn before(self, is_first: bool) -> &'static str {
        match (is_first, self) {
            (true, Sign::Plus) => "",
            (true, Sign::Minus) => "-",
            (false, Sign::Plus) => " + ",
            (false, Sign::Minus) => " - ",
        }
    }
}

impl Factor {
    /// What stands before a factor of a product, the first or a later one.
    ///
    /// ```
    /// use jurist_model::Factor;
    /// assert_eq!((Factor::Over.before(true), Factor::Times.before(false)), ("1/", "*"));
    /// ```
    pub fn before(self, is_first: bool) -> &'static str {
        match (is_first, self) {
            (true, Factor::Times) => "",
            (true, Factor::Over) => "1/",
            (false, Factor::Times) => "*",
            (false, Factor::Over) => "/",
        }
    }
}

/// Two expressions are equal when they have the same form, wherever they stand.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.node == other.node
    }
}

impl Expression {
    /// An exact number.
    pub fn number(value: impl Into<Rational>) -> Self {
        Expression { span: Span::default(), node: Node::Number(value.into()) }
    }

    /// A name, taken as it is.
    pub fn name(name: impl Into<String>) -> Self {
        Expression { span: Span::default(), node: Node::Name(name.into()) }
    }

    /// The same expression, said to stand at `span`.
    pub fn at(mut self, span: Span) -> Self {
        self.span = span;
        self
    }

    /// The names that occur.
    pub fn names(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.each_name(&mut |name, _| {
            names.insert(name);
        });
        names
    }

    /// Calls `visit` with every occurrence of a name and its place.
    pub fn each_name<'a>(&'a self, visit: &mut impl FnMut(&'a str, Span)) {
        match &self.node {
            Node::Number(_) => {}
            Node::Name(name) => visit(name, self.span),
            Node::Negative(inner) | Node::Power(inner, _) | Node::Call(_, inner) => inner.each_name(visit),
            Node::Sum(terms) => terms.iter().for_each(|(_, e)| e.each_name(visit)),
            Node::Product(factors) => factors.iter().for_each(|(_, e)| e.each_name(visit)),
        }
    }

    /// Whether a function occurs.
    pub fn has_function(&self) -> bool {
        match &self.node {
            Node::Number(_) | Node::Name(_) => false,
            Node::Call(..) => true,
            Node::Negative(inner) | Node::Power(inner, _) => inner.has_function(),
            Node::Sum(terms) => terms.iter().any(|(_, e)| e.has_function()),
            Node::Product(factors) => factors.iter().any(|(_, e)| e.has_function()),
        }
    }

    /// Whether no name and no function occurs, so that the value is a rational number.
    pub fn is_constant(&self) -> bool {
        match &self.node {
            Node::Number(_) => true,
            Node::Name(_) | Node::Call(..) => false,
            Node::Negative(inner) | Node::Power(inner, _) => inner.is_constant(),
            Node::Sum(terms) => terms.iter().all(|(_, e)| e.is_constant()),
            Node::Product(factors) => factors.iter().all(|(_, e)| e.is_constant()),
        }
    }

    /// How tightly the outermost operator binds, for printing.
    pub fn level(&self) -> Level {
        match &self.node {
            Node::Sum(_) => Level::Sum,
            Node::Negative(_) => Level::Negative,
            Node::Product(_) => Level::Product,
            Node::Power(..) => Level::Power,
            Node::Number(r) if r.is_negative() => Level::Negative,
            Node::Number(r) if !r.is_integer() => Level::Product,
            Node::Number(_) | Node::Name(_) | Node::Call(..) => Level::Atom,
        }
    }

    /// Writes the expression, in parentheses if it binds less tightly than `least`.
    fn write(&self, f: &mut fmt::Formatter<'_>, least: Level) -> fmt::Result {
        if self.level() < least {
            f.write_str("(")?;
            self.write(f, Level::Sum)?;
            return f.write_str(")");
        }
        match &self.node {
            Node::Number(value) => write!(f, "{value}"),
            Node::Name(name) => f.write_str(name),
            Node::Negative(inner) => {
                f.write_str("-")?;
                inner.write(f, Level::Power)
            }
            Node::Sum(terms) => {
                for (i, (sign, term)) in terms.iter().enumerate() {
                    f.write_str(sign.before(i == 0))?;
                    term.write(f, if i == 0 { Level::Negative } else { Level::Product })?;
                }
                Ok(())
            }
            Node::Product(factors) => {
                for (i, (factor, e)) in factors.iter().enumerate() {
                    f.write_str(factor.before(i == 0))?;
                    // A leading fraction reads as it was meant; a later one would be torn apart.
                    let leading = i == 0 && *factor == Factor::Times;
                    e.write(f, if leading { Level::Negative } else { Level::Power })?;
                }
                Ok(())
            }
            Node::Power(base, exponent) => {
                base.write(f, Level::Atom)?;
                write!(f, "^{exponent}")
            }
            Node::Call(function, value) => {
                write!(f, "{}(", function.name())?;
                value.write(f, Level::Sum)?;
                f.write_str(")")
            }
        }
    }
}

/// How tightly the outermost operator of an expression binds, weakest first.
///
/// ```
/// use jurist_model::{Expression, Level};
/// assert_eq!(Expression::parse("a*b").unwrap().level(), Level::Product);
/// assert!(Level::Sum < Level::Product);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// A sum or a difference.
    Sum,
    /// A leading minus.
    Negative,
    /// A product or a quotient.
    Product,
    /// A power.
    Power,
    /// A name, a number without sign and without stroke, a call of a function.
    Atom,
}

impl fmt::Display for Expression {
    /// Text that parses to an expression of the same value.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, Level::Sum)
    }
}
