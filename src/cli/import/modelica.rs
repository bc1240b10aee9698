//! The linear model that OpenModelica's `linearize` writes, in its old shape (`model linear_Name`, sizes as numbers) and in its new
//! one (`model linearized_model "Name"`, sizes as parameters).

use super::modelica_token::{Kind, Token, tokens};
use super::number::{Number, Unread};
use super::{MAX_SIDE, Shape, Variable, Variables, bad_entry, refused};
use jurist_engine::error::{Diagnostic, Span};
use std::cmp::Ordering;

/// What is known while declarations are read.
#[derive(Default)]
struct Reader<'t> {
    /// Integer parameters with their values.
    sizes: Vec<(&'t str, usize)>,
    found: Variables,
}

pub(super) fn read(text: &str) -> Result<Variables, Diagnostic> {
    let tokens = tokens(text)?;
    let mut reader = Reader::default();
    reader.title(&tokens);
    for statement in statements(&tokens) {
        match statement {
            [parameter, integer, name, equals, value, ..]
                if parameter.is("parameter") && integer.is("Integer") && equals.is("=") =>
            {
                let size = value.text.parse().ok().filter(|size| *size <= MAX_SIDE);
                let size = size.ok_or_else(|| {
                    refused(format!("{} is no size of a system", name.text))
                        .at(value.span, format!("a whole number up to {MAX_SIDE} is expected"))
                })?;
                reader.sizes.push((name.text, size));
            }
            [parameter, real, name, open, rest @ ..]
                if parameter.is("parameter")
                    && real.is("Real")
                    && open.is("[")
                    && ["A", "B", "C", "D"].contains(&name.text) =>
            {
                let variable = reader.matrix(*name, rest)?;
                if let Some(first) = reader.found.list.iter().find(|variable| variable.name == name.text) {
                    let error = refused(format!("{} is declared twice", name.text)).at(name.span, "the second time");
                    return Err(first.span.map_or(error.clone(), |span| error.also(span, "the first time")));
                }
                reader.found.list.push(variable);
            }
            [real, name, equals, vector, open, index, close, ..]
                if real.is("Real") && equals.is("=") && open.is("[") && close.is("]") =>
            {
                reader.signal(name, vector, index);
            }
            _ => {}
        }
    }
    let found = &mut reader.found;
    found.present = found.list.iter().map(|variable| variable.name.clone()).collect();
    if found.list.is_empty() {
        return Err(refused("this is no linear model of OpenModelica: no matrix A is declared")
            .help("'linearize(Model, stopTime=0)' writes linearized_model.mo, with 'parameter Real A[n, n] = ...'"));
    }
    Ok(reader.found)
}

/// The pieces between semicolons outside of brackets; the word `equation` ends what is read.
fn statements<'a, 't>(tokens: &'a [Token<'t>]) -> Vec<&'a [Token<'t>]> {
    let mut out = Vec::new();
    let (mut depth, mut start) = (0usize, 0);
    for (at, token) in tokens.iter().enumerate() {
        if depth == 0 && token.is("equation") {
            break;
        }
        // What stands before the first declaration is the model's name.
        if depth == 0 && token.is("parameter") {
            start = at;
        }
        if ["[", "{", "("].iter().any(|open| token.is(open)) {
            depth += 1;
        } else if ["]", "}", ")"].iter().any(|close| token.is(close)) {
            depth = depth.saturating_sub(1);
        } else if depth == 0 && token.is(";") {
            out.push(&tokens[start..at]);
            start = at + 1;
        }
    }
    if start < tokens.len() && depth > 0 {
        // A matrix that never ends: its reader says where.
        out.push(&tokens[start..]);
    }
    out
}

impl<'t> Reader<'t> {
    /// The name of the model that was made linear.
    fn title(&mut self, tokens: &[Token<'t>]) {
        let Some(at) = tokens.iter().position(|token| token.is("model")) else { return };
        self.found.names.title = match (tokens.get(at + 1), tokens.get(at + 2)) {
            (Some(_), Some(text)) if text.kind == Kind::Text => Some(text.text.to_owned()),
            (Some(name), _) => Some(name.text.strip_prefix("linear_").unwrap_or(name.text).to_owned()),
            _ => None,
        };
    }

    /// `Real 'x_motor.phi' = x[1]`: the name of a state, an input or an output.
    fn signal(&mut self, name: &Token<'_>, vector: &Token<'_>, index: &Token<'_>) {
        let names = &mut self.found.names;
        let list = match vector.text {
            "x" => &mut names.states,
            "u" => &mut names.inputs,
            "y" => &mut names.outputs,
            _ => return,
        };
        let Some(index) = index.text.parse().ok().filter(|index| (1..=MAX_SIDE).contains(index)) else { return };
        let prefix = format!("{}_", vector.text);
        let plain = name.text.strip_prefix(&prefix).unwrap_or(name.text);
        if list.len() < index {
            list.resize(index, String::new());
        }
        list[index - 1] = plain.to_owned();
    }

    /// A size: a number or a parameter.
    fn size(&self, token: &Token<'_>) -> Result<usize, Diagnostic> {
        let known = self.sizes.iter().find(|(name, _)| *name == token.text).map(|(_, size)| *size);
        let size = known.or_else(|| token.text.parse().ok()).filter(|size| *size <= MAX_SIDE);
        size.ok_or_else(|| {
            refused(format!("the size '{}' is not known", token.text))
                .at(token.span, format!("a whole number up to {MAX_SIDE} is expected"))
        })
    }

    /// What follows `parameter Real A[`.
    fn matrix(&self, name: Token<'_>, rest: &[Token<'_>]) -> Result<Variable, Diagnostic> {
        let [rows, comma, columns, close, equals, value @ ..] = rest else { return Err(unread(name)) };
        if !comma.is(",") || !close.is("]") || !equals.is("=") {
            return Err(unread(name));
        }
        let (rows, columns) = (self.size(rows)?, self.size(columns)?);
        let last = value.last().ok_or_else(|| unread(name))?;
        let span = value[0].span.to(last.span);
        let variable = |entries| Variable {
            name: name.text.to_owned(),
            shape: Shape::Matrix(rows, columns),
            entries,
            span: Some(span),
        };
        match value {
            [zeros, open, ..] if zeros.is("zeros") && open.is("(") => {
                Ok(variable(vec![Number::zero(); rows * columns]))
            }
            [open, inner @ .., end] if open.is("[") && end.is("]") || open.is("{") && end.is("}") => {
                let found = entries(name, inner)?;
                let is_empty = found.iter().all(Vec::is_empty);
                let odd = found.iter().position(|row| row.len() != columns);
                if is_empty && rows * columns == 0 {
                    return Ok(variable(Vec::new()));
                }
                if found.len() != rows || odd.is_some() {
                    let what = match odd {
                        Some(row) => format!("row {} has {} numbers", row + 1, found[row].len()),
                        None => format!("there are {} rows", found.len()),
                    };
                    let message = format!("{} is declared {rows} by {columns}, but {what}", name.text);
                    return Err(refused(message).at(span, "another size"));
                }
                Ok(variable(found.into_iter().flatten().collect()))
            }
            _ => Err(unread(name)),
        }
    }
}

fn unread(name: Token<'_>) -> Diagnostic {
    refused(format!("the declaration of {} is not that of a matrix of numbers", name.text))
        .at(name.span, "declared here")
        .help("'linearize' writes 'parameter Real A[n, n] = [1, 2; 3, 4];'")
}

/// The rows of `1, -2; 3, 4` or of `{1, -2}, {3, 4}`.
fn entries(name: Token<'_>, tokens: &[Token<'_>]) -> Result<Vec<Vec<Number>>, Diagnostic> {
    let mut rows: Vec<Vec<Number>> = vec![Vec::new()];
    let mut sign: Option<Token<'_>> = None;
    let mut may_follow = true;
    let (mut depth, is_nested) = (0usize, tokens.first().is_some_and(|token| token.is("{")));
    for token in tokens {
        let row = rows.len() - 1;
        let column = rows[row].len();
        match token.text {
            "-" | "+" if token.kind == Kind::Sign && sign.is_none() && may_follow => sign = Some(*token),
            "," | ";" if token.kind == Kind::Sign && !may_follow => {
                may_follow = true;
                if token.is(";") || is_nested && depth == 0 {
                    rows.push(Vec::new());
                }
            }
            "{" if is_nested && depth == 0 => depth = 1,
            "}" if depth == 1 => depth = 0,
            _ if matches!(token.kind, Kind::Number | Kind::Word) && may_follow => {
                let span = sign.map_or(token.span, |sign| sign.span.to(token.span));
                let minus = if sign.is_some_and(|sign| sign.is("-")) { "-" } else { "" };
                let shown = format!("{minus}{}", token.text);
                let number = Number::decimal(&shown)
                    .map_err(|why| bad_entry(name.text, row, column, why, &shown).at(span, ""))?;
                within(name, &rows, span)?;
                rows[row].push(number);
                (sign, may_follow) = (None, false);
            }
            shown => return Err(bad_entry(name.text, row, column, Unread::NotANumber, shown).at(token.span, "")),
        }
    }
    if may_follow && rows != [Vec::new()] {
        let span = tokens.last().map_or(name.span, |token| token.span);
        return Err(bad_entry(name.text, rows.len() - 1, rows[rows.len() - 1].len(), Unread::NotANumber, "")
            .at(span, "a number is missing"));
    }
    Ok(rows)
}

fn within(name: Token<'_>, rows: &[Vec<Number>], span: Span) -> Result<(), Diagnostic> {
    let longest = rows.len().max(rows.last().map_or(0, Vec::len) + 1);
    match longest.cmp(&MAX_SIDE) {
        Ordering::Greater => {
            Err(refused(format!("{} has more than {MAX_SIDE} rows or columns", name.text)).at(span, "too many"))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
