//! Polynomials whose coefficients are rational functions of parameters, in seven notations.

mod code;
mod csv;
mod latex;
mod matlab;
mod python;
mod root_locus;
mod rust;
mod terms;
mod text;

pub use matlab::MATLAB_KEYWORDS;
pub use python::PYTHON_KEYWORDS;

use super::documents::report_text;
use super::layout::is_unseen;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use jurist_engine::model::Symbols;

pub use latex::symbol as latex_symbol;
pub use root_locus::root_locus_form;
pub use terms::Coefficient;
pub(super) use terms::{Terms, plain_number, terms};
pub use text::coefficient_text;

/// How polynomials are written.
///
/// ```
/// use jurist_show::notation::Notation;
/// // `charpoly --format latex` and `--format python`.
/// assert_ne!(Notation::Latex, Notation::Python);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// For people: a line per coefficient.
    Text,
    /// For programs: a schema name, exponents and exact fractions.
    Json,
    /// A row per monomial.
    Csv,
    /// Aligned equations.
    Latex,
    /// A coefficient vector with the highest power first, as MATLAB has it.
    Matlab,
    /// A list of `fractions.Fraction`, constant term first.
    Python,
    /// An array of `f64` expressions, constant term first.
    Rust,
}

/// One polynomial in the polynomial variable.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPolynomial {
    /// `Q`, `num` or `den`.
    pub name: String,
    /// The letter of its coefficients: `a` gives `a_0`, `a_1`, ...
    pub letter: String,
    /// The coefficients from the constant term up.
    pub coefficients: Vec<RationalFunction>,
}

impl NamedPolynomial {
    /// A polynomial with its name and the letter of its coefficients, which are given from the constant
    /// term up.
    pub fn new(name: &str, letter: &str, coefficients: Vec<RationalFunction>) -> Self {
        NamedPolynomial { name: name.to_owned(), letter: letter.to_owned(), coefficients }
    }
}

/// What a set of polynomials says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Relation {
    /// The characteristic polynomial `Q`.
    Characteristic,
    /// The characteristic polynomial `re + j im` of a complex loop.
    Complex,
    /// `1 + NAME num/den = 0`.
    RootLocus {
        /// The parameter that stands in front.
        parameter: String,
    },
    /// `output = num/den input`.
    Transfer {
        /// The external input.
        input: String,
        /// The output.
        output: String,
    },
}

/// Polynomials to be written, with what is needed to understand them.
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialReport {
    /// The model's title.
    pub title: String,
    /// The polynomial variable: `z` or `s`.
    pub variable: String,
    /// The names of the kept parameters and of the symbols: of variables 0, 1, ... of the coefficients.
    pub parameters: Vec<String>,
    /// The symbols, the last of the parameters, with their definitions.
    pub symbols: Vec<(String, String)>,
    /// The values of the others.
    pub set: Vec<(String, Rational)>,
    /// What the polynomials say.
    pub relation: Relation,
    /// `Q`, or `re` and `im`, or `num` and `den`.
    pub polynomials: Vec<NamedPolynomial>,
}

impl PolynomialReport {
    /// Adds symbols as further variables with their definitions.
    pub fn with_symbols(&mut self, symbols: &Symbols) {
        self.symbols = symbols.definitions();
        self.parameters.extend(self.symbols.iter().map(|(name, _)| name.clone()));
    }

    /// The text in the given notation; exact fractions, or decimals of so many significant digits.
    ///
    /// ```
    /// use jurist_algebra::poly::RationalFunction;
    /// use jurist_show::notation::{NamedPolynomial, Notation, PolynomialReport, Relation};
    /// let k = RationalFunction::variable(0);
    /// let third = RationalFunction::from(1).checked_div(&3.into()).unwrap();
    /// let report = PolynomialReport {
    ///     title: "example".into(),
    ///     variable: "z".into(),
    ///     parameters: vec!["K".into()],
    ///     symbols: vec![],
    ///     set: vec![],
    ///     relation: Relation::Characteristic,
    ///     polynomials: vec![NamedPolynomial {
    ///         name: "Q".into(),
    ///         letter: "a".into(),
    ///         coefficients: vec![&(&k * &third) - &1.into(), 1.into()],
    ///     }],
    /// };
    /// assert!(report.write(Notation::Text, None).contains("a_0 = 1/3*K - 1\n"));
    /// assert!(report.write(Notation::Latex, Some(3)).contains("0.333 \\, K - 1"));
    /// ```
    pub fn write(&self, notation: Notation, digits: Option<usize>) -> String {
        match notation {
            Notation::Text => text::write(self, digits),
            Notation::Json => report_text(self, digits),
            Notation::Csv => csv::write(self, digits),
            Notation::Latex => latex::write(self, digits),
            Notation::Matlab => matlab::write(self, digits),
            Notation::Python => python::write(self, digits),
            Notation::Rust => rust::write(self, digits),
        }
    }

    /// The relation in one line, e.g. `1 + K*num(z)/den(z) = 0`.
    fn headline(&self) -> String {
        let v = &self.variable;
        match &self.relation {
            Relation::Characteristic => {
                let degree = self.polynomials.first().map_or(0, |p| p.coefficients.len().saturating_sub(1));
                let sum = match degree {
                    0 => "a_0".to_owned(),
                    1 => format!("a_1*{v} + a_0"),
                    2 => format!("a_2*{v}^2 + a_1*{v} + a_0"),
                    n => format!("a_{n}*{v}^{n} + ... + a_1*{v} + a_0"),
                };
                format!("Q({v}) = {sum}")
            }
            Relation::Complex => format!("Q({v}) = re({v}) + j*im({v})"),
            Relation::RootLocus { parameter } => format!("1 + {parameter}*num({v})/den({v}) = 0"),
            Relation::Transfer { input, output } => format!("{output}/{input} = num({v})/den({v})"),
        }
    }

    /// The lines that explain code: title, relation, values, and whether coefficients are rounded.
    fn remarks(&self, digits: Option<usize>) -> Vec<String> {
        let mut lines = vec![one_line(&self.title), self.headline()];
        if !self.set.is_empty() {
            let values: Vec<String> = self.set.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            lines.push(format!("at {}", values.join(", ")));
        }
        lines.extend(self.symbols.iter().map(|(name, definition)| format!("{name} = {definition}")));
        lines.extend(digits.map(|digits| format!("coefficients rounded to {digits} digits")));
        lines.retain(|line| !line.is_empty());
        lines
    }
}

/// Text on one line, without characters that end comments.
fn one_line(text: &str) -> String {
    let cleaned: String = text.chars().map(|c| if is_unseen(c) { ' ' } else { c }).collect();
    cleaned.replace("\"\"\"", "'''")
}
