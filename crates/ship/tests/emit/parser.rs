//! Structured text, as far as it is written here, read into trees.

use std::iter::Peekable;
use std::vec::IntoIter;

#[derive(Clone, Debug, PartialEq)]
pub enum Token {
    /// A keyword or a name, in large letters: they do not differ from small ones.
    Word(String),
    /// A number with its type, if it has one: `REAL#1.5`.
    Number(Option<String>, String),
    Sign(&'static str),
}

const SIGNS: [&str; 15] = [":=", "<>", "<", ">", "=", "+", "-", "*", "/", "(", ")", ";", ":", ",", "."];

fn tokens(text: &str) -> Vec<Token> {
    let mut rest = text.trim_start();
    let mut out = Vec::new();
    while let Some(first) = rest.chars().next() {
        if let Some(comment) = rest.strip_prefix("(*") {
            let (inner, behind) = comment.split_once("*)").expect("a comment ends");
            assert!(!inner.contains("(*"), "comments in comments are not allowed everywhere: {inner}");
            rest = behind.trim_start();
            continue;
        }
        let length = |is_part: fn(char) -> bool| rest.find(|c: char| !is_part(c)).unwrap_or(rest.len());
        let length = if first.is_ascii_alphabetic() {
            let length = length(|c| c.is_ascii_alphanumeric() || c == '_');
            let word = rest[..length].to_ascii_uppercase();
            assert!(!word.contains("__") && !word.ends_with('_'), "{word} is no name");
            match rest[length..].strip_prefix('#') {
                Some(number) => {
                    let (number, signed) = number_at(number);
                    out.push(Token::Number(Some(word), number));
                    length + 1 + signed
                }
                None => {
                    out.push(Token::Word(word));
                    length
                }
            }
        } else if first.is_ascii_digit() {
            let (number, length) = number_at(rest);
            out.push(Token::Number(None, number));
            length
        } else {
            let sign = SIGNS.into_iter().find(|sign| rest.starts_with(sign)).unwrap_or_else(|| panic!("{rest:.20}"));
            out.push(Token::Sign(sign));
            sign.len()
        };
        rest = rest[length..].trim_start();
    }
    out
}

/// The number at the beginning of a text, and its length.
fn number_at(text: &str) -> (String, usize) {
    let bytes = text.as_bytes();
    let is_part = |at: &usize| {
        let c = bytes[*at];
        let is_sign = matches!(c, b'-' | b'+') && (*at == 0 || bytes[*at - 1] == b'E');
        c.is_ascii_digit() || c == b'.' || c == b'E' || is_sign
    };
    let length = (0..text.len()).take_while(is_part).count();
    (text[..length].to_owned(), length)
}

#[derive(Clone, Debug)]
pub enum Tree {
    Number(Option<String>, String),
    Name(String),
    Call(String, Box<Tree>),
    Negative(Box<Tree>),
    Binary(String, Box<Tree>, Box<Tree>),
}

#[derive(Clone, Debug)]
pub enum Step {
    Set(String, Tree),
    If(Vec<(Tree, Vec<Step>)>, Vec<Step>),
}

#[derive(Clone, Debug)]
pub struct Variable {
    /// `VAR_INPUT`, `VAR CONSTANT`.
    pub section: String,
    pub name: String,
    pub kind: String,
    pub initial: Option<Tree>,
}

#[derive(Clone, Debug)]
pub struct Unit {
    pub is_block: bool,
    pub name: String,
    /// The type of a function's value.
    pub kind: Option<String>,
    pub variables: Vec<Variable>,
    pub body: Vec<Step>,
}

pub struct Parser(Peekable<IntoIter<Token>>);

impl Parser {
    pub fn units(text: &str) -> Vec<Unit> {
        let mut parser = Parser(tokens(text).into_iter().peekable());
        let mut units = Vec::new();
        while parser.0.peek().is_some() {
            units.push(parser.unit());
        }
        units
    }

    fn word(&mut self) -> String {
        match self.0.next() {
            Some(Token::Word(word)) => word,
            other => panic!("{other:?} instead of a word"),
        }
    }

    fn is_next(&mut self, text: &str) -> bool {
        let is = match self.0.peek() {
            Some(Token::Word(word)) => word == text,
            Some(Token::Sign(sign)) => *sign == text,
            _ => false,
        };
        if is {
            self.0.next();
        }
        is
    }

    fn expect(&mut self, text: &str) {
        assert!(self.is_next(text), "{:?} instead of {text}", self.0.peek());
    }

    fn unit(&mut self) -> Unit {
        let keyword = self.word();
        assert!(matches!(keyword.as_str(), "FUNCTION" | "FUNCTION_BLOCK"), "{keyword}");
        let name = self.word();
        let kind = self.is_next(":").then(|| self.word());
        let mut variables = Vec::new();
        loop {
            let section = ["VAR_INPUT", "VAR_OUTPUT", "VAR_TEMP", "VAR"].into_iter().find(|word| self.is_next(word));
            let Some(section) = section else { break };
            let section = if self.is_next("CONSTANT") { format!("{section} CONSTANT") } else { section.to_owned() };
            while !self.is_next("END_VAR") {
                let name = self.word();
                self.expect(":");
                let kind = self.word();
                let initial = self.is_next(":=").then(|| self.expression(0));
                self.expect(";");
                variables.push(Variable { section: section.clone(), name, kind, initial });
            }
        }
        let end = format!("END_{keyword}");
        let body = self.steps(&[&end]);
        self.expect(&end);
        Unit { is_block: keyword == "FUNCTION_BLOCK", name, kind, variables, body }
    }

    fn steps(&mut self, ends: &[&str]) -> Vec<Step> {
        let mut steps = Vec::new();
        while !matches!(self.0.peek(), Some(Token::Word(word)) if ends.contains(&word.as_str())) {
            let step = self.step();
            self.expect(";");
            steps.push(step);
        }
        steps
    }

    fn step(&mut self) -> Step {
        if !self.is_next("IF") {
            let name = self.word();
            self.expect(":=");
            return Step::Set(name, self.expression(0));
        }
        let mut branches = Vec::new();
        loop {
            let condition = self.expression(0);
            self.expect("THEN");
            branches.push((condition, self.steps(&["ELSIF", "ELSE", "END_IF"])));
            if !self.is_next("ELSIF") {
                break;
            }
        }
        let otherwise = if self.is_next("ELSE") { self.steps(&["END_IF"]) } else { Vec::new() };
        self.expect("END_IF");
        Step::If(branches, otherwise)
    }

    /// Operators by how strongly they bind, as the norm has it.
    fn expression(&mut self, level: usize) -> Tree {
        const LEVELS: [&[&str]; 5] = [&["AND"], &["=", "<>"], &["<", ">"], &["+", "-"], &["*", "/", "MOD"]];
        let Some(operators) = LEVELS.get(level) else { return self.unary() };
        let mut left = self.expression(level + 1);
        while let Some(operator) = operators.iter().find(|operator| self.is_next(operator)) {
            left = Tree::Binary((*operator).to_owned(), Box::new(left), Box::new(self.expression(level + 1)));
        }
        left
    }

    fn unary(&mut self) -> Tree {
        if self.is_next("-") {
            return Tree::Negative(Box::new(self.unary()));
        }
        if self.is_next("(") {
            let inner = self.expression(0);
            self.expect(")");
            return inner;
        }
        if let Some(Token::Number(..)) = self.0.peek() {
            let Some(Token::Number(kind, text)) = self.0.next() else { unreachable!("it was there") };
            return Tree::Number(kind, text);
        }
        let name = self.word();
        if !self.is_next("(") {
            return Tree::Name(name);
        }
        let argument = self.expression(0);
        self.expect(")");
        Tree::Call(name, Box::new(argument))
    }
}
