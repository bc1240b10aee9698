//! Structs with their fields: `digital_system controller = { .b = { 0.1, -0.2 }, .b_size = 2 };`

use super::number::{Number, number};
use super::refused;
use super::token::{Kind, Token};
use jurist_engine::error::{Diagnostic, Span};
use jurist_engine::model::nearest_name;

/// What a field of a struct is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    List,
    Number,
    /// A word or a number that is not needed.
    Ignored,
}

/// The structs that are read, with their fields.
const TYPES: [(&str, &[(&str, Shape)]); 2] = [
    (
        "digital_system",
        &[
            ("a", Shape::List),
            ("a_size", Shape::Number),
            ("b", Shape::List),
            ("b_size", Shape::Number),
            ("sample_time", Shape::Number),
            ("a_uncertainty", Shape::List),
            ("b_uncertainty", Shape::List),
        ],
    ),
    (
        "implementation",
        &[
            ("int_bits", Shape::Number),
            ("frac_bits", Shape::Number),
            ("max", Shape::Number),
            ("min", Shape::Number),
            ("default_realization", Shape::Ignored),
            ("delta", Shape::Number),
            ("scale", Shape::Number),
            ("max_error", Shape::Number),
        ],
    ),
];

/// A field: the numbers of a list, or one number.
#[derive(Clone, Debug)]
pub(super) struct Field<'t> {
    pub name: &'t str,
    pub numbers: Vec<Number>,
    /// What stands behind the equals sign.
    pub span: Span,
}

/// A struct that is given its fields.
#[derive(Clone, Debug)]
pub(super) struct Struct<'t> {
    pub kind: &'t str,
    pub name: &'t str,
    pub name_span: Span,
    pub fields: Vec<Field<'t>>,
}

impl<'t> Struct<'t> {
    pub fn field(&self, name: &str) -> Option<&Field<'t>> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// A number, if it is there.
    pub fn number(&self, name: &str) -> Option<&Number> {
        self.field(name).and_then(|field| field.numbers.first())
    }
}

/// All structs of the known types; everything else of the file is passed over.
pub(super) fn structs<'t>(tokens: &[Token<'t>]) -> Result<Vec<Struct<'t>>, Diagnostic> {
    let mut out = Vec::new();
    let mut at = 0;
    while at + 3 < tokens.len() {
        let [kind, name, equals, open] = [tokens[at], tokens[at + 1], tokens[at + 2], tokens[at + 3]];
        let known = TYPES.iter().find(|(known, _)| kind.is(known));
        let Some((_, fields)) = known.filter(|_| name.kind == Kind::Word && equals.is("=") && open.is("{")) else {
            at += 1;
            continue;
        };
        let mut reader = Reader { tokens, at: at + 4, open };
        let fields = reader.fields(fields)?;
        out.push(Struct { kind: kind.text, name: name.text, name_span: name.span, fields });
        at = reader.at;
    }
    Ok(out)
}

/// Reads on from a place.
pub(super) struct Reader<'a, 't> {
    pub tokens: &'a [Token<'t>],
    pub at: usize,
    /// The brace that is open.
    open: Token<'t>,
}

impl<'t> Reader<'_, 't> {
    /// The next token, which has to be there.
    pub fn next(&mut self) -> Result<Token<'t>, Diagnostic> {
        let token = self.tokens.get(self.at).copied();
        self.at += 1;
        token.ok_or_else(|| refused("a brace is not closed").at(self.open.span, "opened here"))
    }

    /// Whether this comes next; then it is passed.
    pub fn passes(&mut self, text: &str) -> bool {
        let is_next = self.tokens.get(self.at).is_some_and(|token| token.is(text));
        self.at += usize::from(is_next);
        is_next
    }

    /// What follows `{` of a struct, with the brace that closes it.
    fn fields(&mut self, known: &[(&str, Shape)]) -> Result<Vec<Field<'t>>, Diagnostic> {
        let mut out: Vec<Field<'t>> = Vec::new();
        while !self.passes("}") {
            let point = self.next()?;
            if !point.is(".") {
                let error = refused("a field without its name").at(point.span, "'.name = ' is expected");
                return Err(error.help("write .b = { .. }, .b_size = .., .a = { .. }, .a_size = .."));
            }
            let name = self.next()?;
            let Some((_, shape)) = known.iter().find(|(field, _)| *field == name.text) else {
                let near = nearest_name(name.text, known.iter().map(|(field, _)| *field));
                let mut error = refused(format!("unknown field '{}'", name.text)).at(name.span, "not known");
                error.help = near.map(|near| format!("did you mean '{near}'?"));
                return Err(error);
            };
            if out.iter().any(|field| field.name == name.text) {
                return Err(refused(format!("'{}' is given twice", name.text)).at(name.span, "again here"));
            }
            let equals = self.next()?;
            if !equals.is("=") {
                return Err(refused("'=' is missing").at(equals.span, "expected before this"));
            }
            let start = self.at;
            let numbers = self.value(name, *shape)?;
            let span = self.tokens[start].span.to(self.tokens[self.at - 1].span);
            out.push(Field { name: name.text, numbers, span });
            self.separator()?;
        }
        Ok(out)
    }

    fn value(&mut self, name: Token<'t>, shape: Shape) -> Result<Vec<Number>, Diagnostic> {
        let is_list = self.passes("{");
        match shape {
            Shape::Ignored => self.next().map(|_| Vec::new()),
            Shape::Number if !is_list => Ok(vec![number(self)?]),
            Shape::List if is_list => self.list(),
            _ => {
                let expected = if is_list { "one number is expected" } else { "a list in braces is expected" };
                let place = self.tokens.get(self.at).map_or(name.span, |token| token.span);
                Err(refused(format!("'{}' has another form", name.text)).at(place, expected))
            }
        }
    }

    /// What follows `{` of a list.
    fn list(&mut self) -> Result<Vec<Number>, Diagnostic> {
        let mut out = Vec::new();
        while !self.passes("}") {
            out.push(number(self)?);
            self.separator()?;
        }
        Ok(out)
    }

    /// A comma, or the brace that ends it all, which stays.
    fn separator(&mut self) -> Result<(), Diagnostic> {
        let token = self.next()?;
        if token.is("}") {
            self.at -= 1;
        } else if !token.is(",") {
            let error = refused("an expression where a number is expected").at(token.span, "not a comma or a brace");
            return Err(error.help("write the value as one number: nothing is computed here"));
        }
        Ok(())
    }
}
