//! How a language writes statements.

use super::statements::{Code, Expression, Kind, Operator, Statement};
use jurist_algebra::number::{BinaryFormat, Integer, Rational};

/// A language.
pub(super) trait Syntax {
    /// Bits of the smallest type of integers that has so many.
    fn width(&self, bits: u32) -> u32 {
        [16, 32].into_iter().find(|width| bits <= *width).unwrap_or(64)
    }

    /// The name of a type.
    fn kind(&self, kind: Kind) -> &'static str;

    /// An integer of 64 bits that is not negative.
    fn whole(&self, value: &Integer) -> String;

    /// A number of floating point, with its sign.
    fn real(&self, format: BinaryFormat, value: &Rational) -> String;

    /// How a stored coefficient is read.
    fn constant(&self, name: &str) -> String {
        name.to_owned()
    }

    /// How a state is read.
    fn state(&self, name: &str) -> String;

    /// The full name of a helper.
    fn function(&self, name: &str) -> String;

    /// A value that fits as one of another type: `of` binds as strongly as a sign.
    fn converted(&self, from: Kind, to: Kind, of: &Written) -> Written;

    fn operator(&self, operator: Operator) -> &'static str {
        match operator {
            Operator::Plus => "+",
            Operator::Minus => "-",
            Operator::Times => "*",
            Operator::Over => "/",
            Operator::Modulo => "%",
            Operator::Less => "<",
            Operator::Greater => ">",
            Operator::Equal => "==",
            Operator::Unequal => "!=",
            Operator::And => "&&",
        }
    }

    /// A name for a value; the value has several lines where it is long.
    fn declared(&self, name: &str, kind: Kind, value: &[String]) -> Vec<String>;

    /// The name of a quotient by a power of two, rounded down.
    fn floor(&self, name: &str, of: &str, bits: u32) -> Vec<String>;

    fn set(&self, state: &str, value: &str) -> String;

    /// The lines around the branches: before the first, before one with a further condition, before the last, and after it.
    fn branches(&self, condition: &str) -> [String; 4];

    /// The value of a helper.
    fn returned(&self, helper: &str, value: &str) -> String;

    /// A statement that keeps compilers from warning of a name, where they do.
    fn unused(&self, name: &str) -> Option<String>;

    /// The beginning, the middle and the end of a comment of several lines.
    fn comment(&self) -> [&'static str; 3];

    /// What must not stand in a comment, and what stands there instead.
    fn escapes(&self) -> &'static [(&'static str, &'static str)];

    /// A comment behind other text.
    fn remark(&self, text: &str) -> String;

    /// What else the head says.
    fn notes(&self, code: &Code) -> Vec<String>;

    /// The file below its head.
    fn file(&self, code: &Code) -> Vec<String>;
}

/// An expression as text, and how strongly it binds.
pub(super) struct Written {
    pub text: String,
    level: u8,
}

/// A sign binds more strongly than any operator between two numbers.
const SIGN: u8 = 5;
const ATOM: u8 = 6;

impl Written {
    pub fn atom(text: String) -> Written {
        Written { text, level: ATOM }
    }

    pub fn signed(text: String) -> Written {
        Written { text, level: SIGN }
    }

    /// The text as an operand of what binds so strongly.
    fn within(&self, level: u8) -> String {
        if self.level < level { format!("({})", self.text) } else { self.text.clone() }
    }

    /// The text as what a sign stands before.
    pub fn operand(&self) -> String {
        self.within(SIGN)
    }
}

/// An expression in one line.
pub(super) fn expression(syntax: &dyn Syntax, value: &Expression) -> Written {
    let text = |value: &Expression| expression(syntax, value);
    match value {
        Expression::Whole(value) if value.is_negative() => Written::signed(format!("-{}", syntax.whole(&value.abs()))),
        Expression::Whole(value) => Written::atom(syntax.whole(value)),
        Expression::Real(format, value) => Written::signed(syntax.real(*format, value)),
        Expression::Name(name) => Written::atom(name.clone()),
        Expression::Constant(name) => Written::atom(syntax.constant(name)),
        Expression::State(name) => Written::atom(syntax.state(name)),
        Expression::Call(name, of) => Written::atom(format!("{name}({})", text(of).text)),
        Expression::Converted { from, to, of } => syntax.converted(*from, *to, &text(of)),
        // A product in parentheses: languages differ in what a sign before it belongs to.
        Expression::Negative(of) => Written::signed(format!("-{}", text(of).within(ATOM))),
        Expression::Binary(operator, left, right) => {
            let level = operator.level();
            // Comparisons have no order among each other.
            let left_level = if level == Operator::Less.level() { level + 1 } else { level };
            let (left, right) = (text(left).within(left_level), text(right).within(level + 1));
            Written { text: format!("{left} {} {right}", syntax.operator(*operator)), level }
        }
    }
}

/// An expression with a line for each term of a sum.
fn lines(syntax: &dyn Syntax, value: &Expression) -> Vec<String> {
    match value {
        Expression::Binary(operator @ (Operator::Plus | Operator::Minus), left, right) => {
            let right = expression(syntax, right).within(operator.level() + 1);
            let mut all = lines(syntax, left);
            all.push(format!("{} {right}", syntax.operator(*operator)));
            all
        }
        _ => vec![expression(syntax, value).text],
    }
}

/// The lines of statements within a helper of this name, or within the step.
pub(super) fn statements(syntax: &dyn Syntax, helper: &str, all: &[Statement]) -> Vec<String> {
    all.iter().flat_map(|statement| self::statement(syntax, helper, statement)).collect()
}

fn statement(syntax: &dyn Syntax, helper: &str, statement: &Statement) -> Vec<String> {
    let text = |value: &Expression| expression(syntax, value).text;
    match statement {
        Statement::Let { name, kind, value } => {
            // Sums of a step have a line for each term; helpers are short.
            let value = if helper.is_empty() { lines(syntax, value) } else { vec![text(value)] };
            syntax.declared(name, *kind, &value)
        }
        Statement::Floor { name, of, bits } => syntax.floor(name, of, *bits),
        Statement::Set { state, value } => vec![syntax.set(state, &text(value))],
        Statement::Return(value) => vec![syntax.returned(helper, &text(value))],
        Statement::Unused(name) => syntax.unused(name).into_iter().collect(),
        Statement::If { condition, then, otherwise } => {
            let [first, _, last, end] = syntax.branches(&text(condition));
            let mut all = vec![first];
            all.extend(indented(&statements(syntax, helper, then)));
            match otherwise.as_slice() {
                [Statement::If { condition, .. }] => {
                    let mut further = self::statement(syntax, helper, &otherwise[0]);
                    further[0] = syntax.branches(&text(condition))[1].clone();
                    all.extend(further);
                }
                _ => {
                    all.push(last);
                    all.extend(indented(&statements(syntax, helper, otherwise)));
                    all.push(end);
                }
            }
            all
        }
    }
}

/// Lines one step to the right.
pub(super) fn indented(lines: &[String]) -> Vec<String> {
    lines.iter().map(|line| if line.is_empty() { String::new() } else { format!("    {line}") }).collect()
}

/// A value behind `begin`, in the same line where it has one only.
pub(super) fn assigned(begin: String, value: &[String]) -> Vec<String> {
    match value {
        [one] => vec![format!("{begin} {one};")],
        many => {
            let mut all = vec![begin];
            all.extend(indented(many));
            all.last_mut().expect("there is one").push(';');
            all
        }
    }
}

/// A comment of several lines.
pub(super) fn comment(syntax: &dyn Syntax, text: &[String]) -> Vec<String> {
    let [begin, middle, end] = syntax.comment();
    let inner = text.iter().map(|line| format!("{middle} {}", harmless(syntax, line)));
    let all = std::iter::once(begin.to_owned()).chain(inner).chain(std::iter::once(end.to_owned()));
    all.filter(|line| !line.is_empty()).collect()
}

/// A text that ends no comment, breaks no line and does not reverse its letters.
pub(super) fn harmless(syntax: &dyn Syntax, text: &str) -> String {
    let is_harmful = |c: char| {
        c.is_control()
            || matches!(c, '\u{2028}' | '\u{2029}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let line: String = text.chars().map(|c| if is_harmful(c) { ' ' } else { c }).collect();
    syntax.escapes().iter().fold(line, |line, (from, to)| line.replace(from, to))
}

/// Parts of a file with an empty line before each; parts without lines are left out.
pub(super) fn parts(parts: Vec<Vec<String>>) -> Vec<String> {
    parts.into_iter().filter(|part| !part.is_empty()).flat_map(|part| [vec![String::new()], part].concat()).collect()
}
