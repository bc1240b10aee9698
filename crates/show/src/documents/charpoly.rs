//! The documents `jurist/charpoly/1`, `jurist/root-locus-form/1` and `jurist/transfer/1`.

use super::schema_name;
use super::{Exact, Named, Open, PointQuestion, to_text};
use crate::notation::{self, PolynomialReport, Terms, plain_number, terms};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, RationalFunction};
use jurist_engine::problem::Problem;
use serde::{Deserialize, Serialize};

schema_name!(CharpolyName, "jurist/charpoly/1");
schema_name!(RootLocusFormName, "jurist/root-locus-form/1");
schema_name!(TransferName, "jurist/transfer/1");

/// The characteristic polynomial.
pub type Charpoly = Polynomials<CharpolyName, Coefficients, CoefficientsOpen>;
/// The characteristic polynomial as `1 + parameter * numerator/denominator`.
pub type RootLocusForm = Polynomials<RootLocusFormName, LocusQuotient, QuotientOpen>;
/// A closed-loop transfer function.
pub type Transfer = Polynomials<TransferName, TransferQuotient, QuotientOpen>;

/// Polynomials whose coefficients are rational functions of parameters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Polynomials<S, P, N> {
    /// The kind of document.
    pub schema: S,
    /// The polynomials, or why there are none.
    #[serde(flatten)]
    pub answer: PolynomialsOrNone<P, N>,
}

/// The polynomials, or why there are none.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum PolynomialsOrNone<P, N> {
    /// The polynomials.
    Known(KnownPolynomials<P>),
    /// The budget did not allow them.
    Undecided(OpenPolynomials<N>),
}

/// The polynomials, and what is needed to understand them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Known{P}"))]
pub struct KnownPolynomials<P> {
    /// The model's title; empty where it has none.
    pub title: String,
    /// The polynomial variable: `z` or `s`.
    pub variable: String,
    /// The parameters that are kept, in the order of a term's powers.
    pub parameters: Vec<String>,
    /// The symbols with their definitions; their powers follow those of the parameters. Left out where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symbols: Option<Named<String>>,
    /// The values of the others, and of constants that were replaced.
    pub set: Named<Exact>,
    /// To how many significant digits the coefficients are rounded; left out where they are exact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounded_to_digits: Option<usize>,
    /// The polynomials.
    #[serde(flatten)]
    pub polynomials: P,
}

/// What is known of the question where the budget ended first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "{N}Polynomials"))]
pub struct OpenPolynomials<N> {
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// Why there is no answer.
    #[serde(flatten)]
    pub open: Open<N>,
    /// The polynomial variable: `z` or `s`.
    pub variable: String,
    /// The parameters that are kept.
    pub parameters: Vec<String>,
}

/// The characteristic polynomial.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficients {
    /// From the constant term up.
    pub coefficients: CoefficientList,
}

/// Real or complex coefficients.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum CoefficientList {
    /// Of a real polynomial.
    Real(Vec<Coefficient>),
    /// Of a polynomial that is not real.
    Complex(Vec<ComplexCoefficient>),
}

/// `1 + parameter * numerator/denominator = 0`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LocusQuotient {
    /// The parameter that stands in front.
    pub parameter: String,
    /// Coefficients from the constant term up.
    pub numerator: Vec<Coefficient>,
    /// Coefficients from the constant term up.
    pub denominator: Vec<Coefficient>,
}

/// `output = numerator/denominator * input`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TransferQuotient {
    /// The external input.
    pub input: String,
    /// The output.
    pub output: String,
    /// Coefficients from the constant term up.
    pub numerator: Vec<Coefficient>,
    /// Coefficients from the constant term up.
    pub denominator: Vec<Coefficient>,
}

/// No polynomial.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientsOpen {
    /// Not known.
    pub coefficients: (),
}

/// No quotient.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct QuotientOpen {
    /// Not known.
    pub numerator: (),
}

/// A rational function of the kept parameters as two sums of terms.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficient {
    /// The numerator; empty for 0.
    pub numerator: Vec<Term>,
    /// The denominator: 1 where it is a number.
    pub denominator: Vec<Term>,
}

/// The powers of the kept parameters, and the number before them: exact (`p/q`), or rounded where `rounded_to_digits` is
/// given.
pub type Term = (Vec<u32>, String);

impl Coefficient {
    fn new(function: &RationalFunction, parameters: usize, digits: Option<usize>) -> Self {
        let c = notation::Coefficient::new(function, parameters);
        let list = |terms: Vec<(Vec<u32>, Rational)>| -> Vec<Term> {
            terms.into_iter().map(|(powers, v)| (powers, plain_number(&v, digits))).collect()
        };
        let one = || vec![(vec![0; parameters], Rational::ONE)];
        Coefficient { numerator: list(c.numerator), denominator: list(c.denominator.unwrap_or_else(one)) }
    }
}

/// The same with complex numbers in the numerator.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComplexCoefficient {
    /// The numerator; empty for 0.
    pub numerator: Vec<ComplexTerm>,
    /// The denominator, which is real: 1 where it is a number.
    pub denominator: Vec<Term>,
}

/// The powers of the kept parameters, and the number before them: its real and its imaginary part.
pub type ComplexTerm = (Vec<u32>, [String; 2]);

impl ComplexCoefficient {
    fn new(re: &RationalFunction, im: &RationalFunction, parameters: usize, digits: Option<usize>) -> Self {
        let (a, b) = (re.denominator(), im.denominator());
        let common = a.times(&b.div_exact(&a.gcd(b)).expect("a gcd divides"));
        let divisor = common.as_constant().map_or(Rational::ONE, Rational::from);
        let over = |f: &RationalFunction| {
            let factor = common.div_exact(f.denominator()).expect("a common multiple");
            terms(&f.numerator().times(&factor), parameters, &divisor)
        };
        let parts = [over(re), over(im)];
        let mut powers: Vec<&Vec<u32>> = parts.iter().flatten().map(|(powers, _)| powers).collect();
        powers.sort_by(|a, b| b.cmp(a));
        powers.dedup();
        let number = |part: &Terms, powers: &Vec<u32>| {
            let found = part.iter().find(|(p, _)| p == powers).map_or(Rational::ZERO, |(_, value)| value.clone());
            plain_number(&found, digits)
        };
        let numerator = powers.into_iter().map(|p| (p.clone(), parts.each_ref().map(|part| number(part, p)))).collect();
        let denominator = match common.as_constant() {
            Some(_) => vec![(vec![0; parameters], Rational::ONE)],
            None => terms(&common, parameters, &Rational::ONE),
        };
        let denominator = denominator.into_iter().map(|(powers, v)| (powers, plain_number(&v, digits))).collect();
        ComplexCoefficient { numerator, denominator }
    }
}

impl<S: Default, P, N> Polynomials<S, P, N> {
    fn known(report: &PolynomialReport, digits: Option<usize>, polynomials: P) -> Self {
        Polynomials {
            schema: S::default(),
            answer: PolynomialsOrNone::Known(KnownPolynomials {
                title: report.title.clone(),
                variable: report.variable.clone(),
                parameters: report.parameters[..report.parameters.len() - report.symbols.len()].to_vec(),
                symbols: (!report.symbols.is_empty()).then(|| report.symbols.iter().cloned().collect()),
                set: report.set.as_slice().into(),
                rounded_to_digits: digits,
                polynomials,
            }),
        }
    }

    /// The document of polynomials that the budget did not allow.
    pub fn undecided(problem: &Problem, stopped: &Exhausted) -> Self
    where
        N: Default,
    {
        Polynomials {
            schema: S::default(),
            answer: PolynomialsOrNone::Undecided(OpenPolynomials {
                question: PointQuestion::new(problem),
                open: stopped.into(),
                variable: problem.time().variable().to_owned(),
                parameters: problem.free().iter().map(|f| f.name.clone()).collect(),
            }),
        }
    }
}

/// The document that a report is, as text; exact, or with numbers of so many significant digits.
pub(crate) fn report_text(report: &PolynomialReport, digits: Option<usize>) -> String {
    let parameters = report.parameters.len();
    let functions = |name: &str| {
        let polynomial = report.polynomials.iter().find(|p| p.name == name);
        polynomial.map(|p| p.coefficients.as_slice()).unwrap_or_default()
    };
    let list = |name: &str| functions(name).iter().map(|c| Coefficient::new(c, parameters, digits)).collect();
    match &report.relation {
        notation::Relation::Characteristic => {
            let polynomial = Coefficients { coefficients: CoefficientList::Real(list("Q")) };
            to_text(&Charpoly::known(report, digits, polynomial))
        }
        notation::Relation::Complex => {
            let pairs = functions("re").iter().zip(functions("im"));
            let list = pairs.map(|(re, im)| ComplexCoefficient::new(re, im, parameters, digits)).collect();
            let polynomial = Coefficients { coefficients: CoefficientList::Complex(list) };
            to_text(&Charpoly::known(report, digits, polynomial))
        }
        notation::Relation::RootLocus { parameter } => {
            let (numerator, denominator) = (list("num"), list("den"));
            let quotient = LocusQuotient { parameter: parameter.clone(), numerator, denominator };
            to_text(&RootLocusForm::known(report, digits, quotient))
        }
        notation::Relation::Transfer { input, output } => {
            let (numerator, denominator) = (list("num"), list("den"));
            let (input, output) = (input.clone(), output.clone());
            to_text(&Transfer::known(report, digits, TransferQuotient { input, output, numerator, denominator }))
        }
    }
}
