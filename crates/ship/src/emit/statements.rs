//! Statements that every language has: what a controller becomes before it is written.

use jurist_algebra::number::{BinaryFormat, Integer, Rational};

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Integers of so many bits: 16, 32 or 64.
    Integer(u32),
    /// Binary floating point.
    Float(BinaryFormat),
}

/// Sums of integers are computed in these.
pub(super) const WIDE: Kind = Kind::Integer(64);

/// What is put between two expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Plus,
    Minus,
    Times,
    /// Division of integers that drops the fraction.
    Over,
    /// The rest of that division: it has the sign of the dividend.
    Modulo,
    Less,
    Greater,
    Equal,
    Unequal,
    And,
}

impl Operator {
    /// How strongly it binds.
    pub fn level(self) -> u8 {
        match self {
            Operator::And => 1,
            Operator::Less | Operator::Greater | Operator::Equal | Operator::Unequal => 2,
            Operator::Plus | Operator::Minus => 3,
            Operator::Times | Operator::Over | Operator::Modulo => 4,
        }
    }
}

/// A value.
#[derive(Clone, Debug)]
pub(super) enum Expression {
    /// An integer of 64 bits.
    Whole(Integer),
    /// A number of a format of floating point.
    Real(BinaryFormat, Rational),
    /// An argument, or what `Let` or `Floor` made.
    Name(String),
    /// A stored coefficient.
    Constant(String),
    /// A state.
    State(String),
    /// A number that fits into the other type, as one of that type.
    Converted {
        from: Kind,
        to: Kind,
        of: Box<Expression>,
    },
    Negative(Box<Expression>),
    Binary(Operator, Box<Expression>, Box<Expression>),
    /// A helper's value.
    Call(String, Box<Expression>),
}

impl Expression {
    pub fn name(name: &str) -> Expression {
        Expression::Name(name.to_owned())
    }

    pub fn with(self, operator: Operator, other: Expression) -> Expression {
        Expression::Binary(operator, Box::new(self), Box::new(other))
    }

    pub fn negative(self) -> Expression {
        Expression::Negative(Box::new(self))
    }

    pub fn converted(self, from: Kind, to: Kind) -> Expression {
        if from == to { self } else { Expression::Converted { from, to, of: Box::new(self) } }
    }

    /// A sum, in its order; the first of a pair says whether the other is subtracted.
    pub fn sum(terms: Vec<(bool, Expression)>) -> Option<Expression> {
        let add = |sum: Expression, (is_negative, term): (bool, Expression)| {
            sum.with(if is_negative { Operator::Minus } else { Operator::Plus }, term)
        };
        let mut terms = terms.into_iter();
        let (is_negative, first) = terms.next()?;
        Some(terms.fold(if is_negative { first.negative() } else { first }, add))
    }
}

/// A step.
#[derive(Clone, Debug)]
pub(super) enum Statement {
    /// A value gets a name, which keeps it.
    Let { name: String, kind: Kind, value: Expression },
    /// So does the quotient of the 64 bits of another name and 2 to the power `bits`, rounded down.
    Floor { name: String, of: String, bits: u32 },
    /// A state changes.
    Set { state: String, value: Expression },
    /// One of two lists is run; both end in `Return`.
    If { condition: Expression, then: Vec<Statement>, otherwise: Vec<Statement> },
    /// The value of a helper; nothing follows.
    Return(Expression),
    /// A name that nothing reads.
    Unused(String),
}

/// A function from 64 bits to 64 bits.
#[derive(Clone, Debug)]
pub(super) struct Helper {
    pub name: String,
    /// What it does, as a sentence.
    pub remark: String,
    pub body: Vec<Statement>,
}

/// The name of a helper's argument.
pub(super) const ARGUMENT: &str = "v";

/// A coefficient as it is stored.
#[derive(Clone, Debug)]
pub(super) struct Constant {
    pub name: String,
    pub kind: Kind,
    /// Its value: that of fixed point is an integer.
    pub value: Rational,
    pub remark: String,
}

/// A controller.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// The type of signals.
    pub signal: Kind,
    pub constants: Vec<Constant>,
    pub states: Vec<String>,
    pub inputs: Vec<String>,
    /// Names that the step gives to outputs.
    pub outputs: Vec<String>,
    pub helpers: Vec<Helper>,
    /// From the inputs to the outputs, and then to the next states.
    pub step: Vec<Statement>,
}
