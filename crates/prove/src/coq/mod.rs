//! The answer as a theorem for Coq, over the library in `proofs/`.

mod checker;
mod formula;
mod pieces;
mod point;
mod statement;

use crate::Theorem;
use formula::{Formulas, Names, number_of, polynomial};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use jurist_engine::answer::{Answer, PointVerdict, Verdict};
use jurist_engine::coverage::NOT_FOR_COQ;
use jurist_engine::problem::Problem;
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_model::{Form, Matrix, Model};
use jurist_stability::{ParametricPolynomial, StableSet, zeros_in};
use statement::{File, Subject};
use std::collections::BTreeSet;

/// The largest order for which a file is written.
const LARGEST_ORDER: usize = 12;

impl Theorem for Answer<StableSet> {
    /// A file for Coq that states this answer as a theorem and proves it, with the library in `proofs/`: for every value of the
    /// parameter in its domain the loop is stable if and only if the value lies between the limits, each of which is the only
    /// root of a polynomial between two decimals, or a rational number.
    ///
    /// A loop given by matrices is stated by the entries as they are typed and by their eigenvalues; one given by a
    /// polynomial or by blocks by the coefficients of its characteristic polynomial.
    ///
    /// Cost: a table of the conditions, as for [`jury_table`](jurist_stability::jury_table), and for each piece of the domain the
    /// signs of their coefficients; more where a limit needs more digits.
    ///
    /// # Errors
    /// [`Error::Refused`] (`E-coq`) where there is no such file: an order of 0 or above 12, a free bound of the region, a model
    /// that is undefined somewhere on the domain, or signs that the checker does not see. [`Error::Stopped`] when the budget
    /// runs out.
    fn coq(&self, budget: &Budget) -> Result<String, Error> {
        budget.enter(|| {
            budget.step("theorem for Coq");
            let problem = self.problem();
            problem.refuse_complex(budget)?;
            // A loop with exponentials says so itself; what is left are other ways to an answer.
            one_rate(problem)?;
            let loop_ = Loop::of(problem, budget)?;
            if !self.value().is_algebraic() {
                return Err(refused("the answer was not decided by polynomials over the integers", OTHERS));
            }
            let conditions = checker::conditions(&loop_.cleared, problem.region())
                .ok_or_else(|| refused("a row of Jury's table is zero for every value of the parameter", OTHERS))?;
            let way = pieces::way(&conditions, self.value(), &problem.parameter().domain, budget)?;
            let (subject, definitions, mut names) = loop_.model(problem);
            let parameter = names.name(&problem.parameter().name);
            Ok(File { problem, order: loop_.order, subject, definitions, names, parameter, way: &way }.text())
        })?
    }
}

impl Theorem for Answer<PointVerdict> {
    /// A file for Coq that states as a theorem, and proves with the library in `proofs/`, that the loop is stable, or that it
    /// is not: some eigenvalue (or root) lies on the boundary of the region or outside, or the polynomial loses its degree.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_prove::Theorem;
    /// let (drive, budget) = (Model::drive(), Budget::unlimited());
    /// let answer = drive.ask().set("K_pwm", 551).verdict(&budget).unwrap();
    /// assert!(answer.coq(&budget).unwrap().contains("Theorem not_stable (R : rcfType) :\n  exists z : R[i],"));
    /// ```
    ///
    /// Cost: that of evaluating the model once more.
    ///
    /// # Errors
    /// [`Error::Refused`] (`E-coq`) where there is no such file: an order of 0 or above 12, or a model that is undefined at the
    /// point. [`Error::Stopped`] when the budget runs out.
    fn coq(&self, budget: &Budget) -> Result<String, Error> {
        budget.enter(|| {
            budget.step("theorem for Coq");
            let problem = self.problem();
            problem.refuse_complex(budget)?;
            if self.value().verdict == Verdict::Undefined {
                return Err(refused("the model is undefined at the point", "choose another point with '--set'"));
            }
            one_rate(problem)?;
            let loop_ = Loop::of(problem, budget)?;
            let (subject, definitions, _) = loop_.model(problem);
            let stable = self.value().verdict == Verdict::Stable;
            Ok(point::text(problem, loop_.order, subject, &definitions, stable))
        })?
    }
}

/// Refuses loops of several rates: the theorem would be about a matrix that the reader has to trust.
fn one_rate(problem: &Problem) -> Result<(), Error> {
    match problem.model().hyperperiod() {
        1 => Ok(()),
        _ => Err(refused("the loop has several rates", "there is no certificate of such loops")),
    }
}

const OTHERS: &str = "take '--certificate' or '--smt2'";

fn refused(why: impl Into<String>, help: impl Into<String>) -> Error {
    Diagnostic::error(Code::Coq, format!("no file for Coq: {}", why.into())).help(help).into()
}

/// The refusal of a loop without polynomials over the integers; a long definition is left out.
fn not_rational(name: &str, definition: &str) -> Error {
    let short = (definition.starts_with("exp(") && definition.len() < 60).then(|| format!("{name} = {definition}"));
    let what = short.as_deref().unwrap_or("exponentials or other functions");
    NOT_FOR_COQ.diagnostic(&[("what", what)]).into()
}

/// A function, or `pi`, in the entries of a model of matrices or in what they are made of.
fn unstated(model: &Model, set: &[(String, Rational)], kept: &[String]) -> Option<&'static str> {
    let matrices = matrices(model);
    let entries = || matrices.iter().flat_map(|(_, m)| m.entries());
    let parameter = kept.first().map(String::as_str);
    let used = used_names(model, set, parameter, entries());
    let is_replaced = |name: &str| parameter == Some(name) || set.iter().any(|(other, _)| other == name);
    let constants = used.iter().filter(|name| !is_replaced(name)).filter_map(|name| model.constant(name));
    if entries().chain(constants.map(|c| &c.expression)).any(|e| e.has_function()) {
        return Some("a function");
    }
    let is_the_number =
        |name: &str| model.constant(name).is_none() && model.parameters().iter().all(|p| p.name != name);
    (used.contains("pi") && is_the_number("pi")).then_some("pi")
}

/// The matrices of a model that is given by them, by their names in the file.
fn matrices(model: &Model) -> Vec<(&'static str, &Matrix)> {
    match model.form() {
        Form::Matrix { matrix, .. } => vec![("A", matrix)],
        Form::OutputFeedback { a, b, c, k, .. } => vec![("A", a), ("B", b), ("K", k), ("C", c)],
        Form::Characteristic(_) | Form::Blocks(_) => Vec::new(),
    }
}

/// The loop without the region.
struct Loop {
    order: usize,
    raw: CharacteristicPolynomial,
    /// The coefficients times a common denominator.
    cleared: Vec<UniPoly>,
}

impl Loop {
    fn of(problem: &Problem, budget: &Budget) -> Result<Loop, Error> {
        if problem.region().is_free() {
            let name = problem.region().bound_name();
            let help = format!("set it, and ask for a parameter: --{name} VALUE --param NAME");
            return Err(refused(format!("'{name}' is the question"), help));
        }
        let kept: Vec<String> = problem.free().iter().map(|f| f.name.clone()).collect();
        let evaluated = problem.model().evaluate(&kept, problem.set(), budget)?;
        if let Some((name, text)) = evaluated.symbols.definitions().into_iter().next() {
            return Err(not_rational(&name, &text));
        }
        if let Some(what) = unstated(problem.model(), problem.set(), &kept) {
            let why = format!("an entry contains {what}, and entries are stated as typed");
            return Err(refused(why, "write its value, where that is a rational number"));
        }
        let raw = evaluated.polynomial;
        let order = raw.formal_degree;
        if order == 0 || order > LARGEST_ORDER {
            return Err(refused(format!("the order is {order}, and has to be 1 to {LARGEST_ORDER}"), OTHERS));
        }
        let side = |p: &MultiPoly| p.to_univariate(0).expect("one variable is kept");
        let coefficients: Vec<_> =
            raw.coefficients.iter().map(|c| (side(c.numerator()), side(c.denominator()))).collect();
        let poles: Vec<UniPoly> = raw.poles.iter().map(side).collect();
        let p = ParametricPolynomial::new(&coefficients, order, Vec::new());
        let denominators = poles.iter().chain(coefficients.iter().map(|(_, d)| d));
        for (parameter, pole) in problem.free().iter().flat_map(|f| denominators.clone().map(move |d| (f, d))) {
            if let Some(x) = zeros_in(pole, &parameter.domain, budget)?.first() {
                let why = format!("the model is undefined at {} = {}", parameter.name, x.decimal(6));
                return Err(refused(
                    why,
                    format!("choose a domain without it: --domain {}=LOWER..UPPER", parameter.name),
                ));
            }
        }
        let mut cleared: Vec<UniPoly> = p.polynomial().coeffs().iter().map(|c| c.times(p.content())).collect();
        cleared.resize(order + 1, UniPoly::zero());
        // The denominator has one sign on the domain; the checker multiplies by it or by a multiple.
        Ok(Loop { order, raw, cleared })
    }

    /// What the theorem is about, the definitions before it, and the names in them.
    fn model(&self, problem: &Problem) -> (Subject, String, Names) {
        let model = problem.model();
        let parameter = problem.free().first().map(|f| f.name.as_str());
        let matrices = matrices(model);
        let taken: Vec<&str> = matrices.iter().map(|(name, _)| *name).collect();
        let mut formulas = Formulas { source: model.source(), names: Names::new(&taken) };
        let own = parameter.map(|name| formulas.names.name(name)).unwrap_or_default();
        let mut out = String::new();
        if matrices.is_empty() {
            let list: Vec<String> = self
                .raw
                .coefficients
                .iter()
                .map(|c| {
                    let side = |p: &MultiPoly| p.to_univariate(0).expect("one variable is kept");
                    let (numerator, denominator) = (side(c.numerator()), side(c.denominator()));
                    if denominator.is_constant() {
                        polynomial(&numerator, &denominator.coeff(0), &own)
                    } else {
                        let whole = |f: &UniPoly| polynomial(f, &Integer::ONE, &own);
                        format!("({})/({})", whole(&numerator), whole(&denominator))
                    }
                })
                .collect();
            if parameter.is_some() {
                out.push_str(&format!("Definition {own} : expr := Par.\n\n"));
            }
            out.push_str("(** The characteristic polynomial, lowest power first. *)\n");
            out.push_str(&format!("Definition coefficients : list expr := [\n  {}].\n", list.join(";\n  ")));
            let blocks = matches!(model.form(), Form::Blocks(_));
            return (Subject::Coefficients { blocks }, out, formulas.names);
        }
        let mut defined =
            Definitions { model, set: problem.set(), parameter, seen: BTreeSet::new(), out: String::new() };
        let entries = || matrices.iter().flat_map(|(_, m)| m.entries());
        let used = used_names(model, problem.set(), parameter, entries());
        for name in model.constants().iter().map(|c| &c.name).chain(model.parameters().iter().map(|p| &p.name)) {
            if used.contains(name.as_str()) {
                defined.define(name, &mut formulas);
            }
        }
        out.push_str(&defined.out);
        for (name, matrix) in &matrices {
            let rows: Vec<String> = matrix
                .rows
                .iter()
                .map(|row| {
                    let row: Vec<String> = row.iter().map(|e| formulas.text(e)).collect();
                    format!("  [{}]", row.join("; "))
                })
                .collect();
            out.push_str(&format!("\nDefinition {name} : matrix := [\n{}].\n", rows.join(";\n")));
        }
        let subject = match model.form() {
            Form::OutputFeedback { k, .. } => Subject::Feedback { inputs: k.size().0, outputs: k.size().1 },
            _ => Subject::Matrix,
        };
        (subject, out.trim_start().to_owned(), formulas.names)
    }
}

/// The names that the entries depend on, with the parameter.
fn used_names<'a>(
    model: &'a Model,
    set: &[(String, Rational)],
    parameter: Option<&'a str>,
    entries: impl Iterator<Item = &'a jurist_model::Expression>,
) -> BTreeSet<&'a str> {
    let mut used = BTreeSet::from_iter(parameter);
    let mut open: Vec<&str> = entries.flat_map(|e| e.names()).collect();
    while let Some(name) = open.pop() {
        let replaced = Some(name) == parameter || set.iter().any(|(other, _)| other == name);
        if used.insert(name) && !replaced {
            open.extend(model.constant(name).iter().flat_map(|c| c.expression.names()));
        }
    }
    used
}

/// Constants and parameters in an order in which each is defined before it is used.
struct Definitions<'a> {
    model: &'a Model,
    set: &'a [(String, Rational)],
    parameter: Option<&'a str>,
    seen: BTreeSet<String>,
    out: String,
}

impl Definitions<'_> {
    fn define(&mut self, name: &str, formulas: &mut Formulas) {
        if !self.seen.insert(name.to_owned()) {
            return;
        }
        let value = if Some(name) == self.parameter {
            "Par".to_owned()
        } else if let Some((_, value)) = self.set.iter().find(|(other, _)| other == name) {
            number_of(value)
        } else if let Some(constant) = self.model.constant(name) {
            for other in constant.expression.names() {
                self.define(other, formulas);
            }
            formulas.text(&constant.expression)
        } else {
            return;
        };
        self.out.push_str(&format!("Definition {} : expr := {value}.\n", formulas.names.name(name)));
    }
}
