//! Certificates of loops with blocks behind a hold, or of prewarped rules: polynomials over symbols, whose definitions the checkers enclose themselves.

mod line;

use super::cofactors::{Identity, of_half_size_pair};
use super::complex::{has_frames, times};
use super::no_certificate;
use super::over_symbols::{Enclosed, coprime_basis};
use super::statement::{self, about_at_rates, boundary, number, object};
use super::text::to_text;
use crate::precisions::CERTIFICATE_OVER_SYMBOLS;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};
use jurist_algebra::symbols::{Definition, Symbols};
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::problem::Problem;
use jurist_model::error::Error;
use jurist_stability::{Shape, StableSet, SymbolicPolynomial};
use line::{Attempt, zeros};
use serde_json::Value;
use std::sync::Arc;

/// The schema of certificates over symbols.
const SCHEMA: &str = "jurist/certificate/2";

/// The checkers have so many bits more than the signs were certain with here, beside those of the longest coefficient: they take powers of symbols,
/// which may be small, before they multiply.
pub(super) const SPARE_BITS: u64 = 64;

/// And so many times as many: they multiply all divisors of a loop out. Behind a hold with part of a sample of dead time an oscillation has one of degree 84 in
/// its tangent, whose coefficients have 420 bits where the certificate's have 311.
const TIMES_AS_MANY: u64 = 4;

/// They take no more.
pub(super) const MOST_OF_CHECKERS: u64 = 1 << 15;

/// Whether the loop has constants that are not rational, all of them from holds and prewarped rules at fixed times.
pub(super) fn is_held(problem: &Problem, budget: &Budget) -> Result<bool, Error> {
    let algebra = problem.algebra_over_symbols(budget)?;
    let symbols = algebra.symbols();
    let why = if symbols.is_written() {
        Some("the model has pi or a function in it (a sample time of pi/2, a gain of sqrt(2))")
    } else if symbols.is_moving() {
        Some(match symbols.delays().is_empty() {
            false => "the dead time is one of the parameters",
            true => "a parameter is inside of the exponentials of a held block",
        })
    } else if !symbols.delays().is_empty() {
        Some("the loop has dead time beside functions")
    } else {
        None
    };
    if let Some(why) = why {
        return Err(no_certificate(format!("no certificate: {why}, which no checker knows there")));
    }
    if !problem.positive().is_empty() {
        return Err(no_certificate(
            "no certificate: the sample time of a hold, or of a rule, depends on what is asked for",
        ));
    }
    if symbols.is_empty() {
        // The checkers connect the blocks before anything cancels.
        return match symbols.are_brought() {
            true => {
                Err(no_certificate("no certificate: the constants of holds and prewarped rules cancel at these values"))
            }
            false => Ok(false),
        };
    }
    Ok(true)
}

/// Polynomials over the constants of holds are looked at over so many samples. The drive with its speed controller at each third sample has a
/// certificate of 6 MB.
const MOST_SAMPLES: u64 = 2;

/// With more constants resultants take minutes, and memory.
const MOST_SYMBOLS: usize = 4;

/// So much work is done for them.
const WORK_OF_SAMPLES: u64 = 1_000_000_000;

/// Longer certificates are more than the checkers take.
const MOST_BYTES: usize = 1 << 22;

/// The certificate of a stable set at several rates, where it is short; `None` where all is rational. Boxes are the other way.
pub(super) fn of_few_samples(answer: &Answer<StableSet>, budget: &Budget) -> Result<Option<String>, Error> {
    if answer.problem().model().hyperperiod() > MOST_SAMPLES || has_frames(answer.problem()) {
        return Err(is_long());
    }
    of_short_set(answer, budget)
}

/// The same of a loop whose polynomials are twice as long as others, as those of complex loops are.
pub(super) fn of_short_set(answer: &Answer<StableSet>, budget: &Budget) -> Result<Option<String>, Error> {
    let share = budget.clone().within_work(WORK_OF_SAMPLES);
    let problem = answer.problem();
    let found = is_held(problem, &share).and_then(|is_held| {
        let polynomial = problem.symbolic(&share)?;
        let count = polynomial.as_ref().and_then(|p| p.fixed_symbols()).map_or(0, |symbols| symbols.len());
        match is_held {
            true if count > MOST_SYMBOLS => Err(is_long()),
            true => of_set(answer, &share).map(Some),
            false => Ok(None),
        }
    });
    match found {
        Ok(Some(text)) if text.len() > MOST_BYTES => Err(is_long()),
        Err(Error::Stopped(_)) if budget.check().is_ok() => Err(is_long()),
        other => other,
    }
}

fn is_long() -> Error {
    no_certificate(
        "no certificate: at several rates, and with complex coefficients, polynomials over the constants of holds are long; by boxes a parameter is \
         proved that is in no function",
    )
}

/// What the line is made of.
struct Loop<'l> {
    polynomial: &'l SymbolicPolynomial,
    factors: Vec<MultiPoly>,
    certain: Vec<MultiPoly>,
    identity: Option<Identity<MultiPoly>>,
}

/// The certificate of a stable set.
pub(super) fn of_set(answer: &Answer<StableSet>, budget: &Budget) -> Result<String, Error> {
    let problem = answer.problem();
    let Some(p) = problem.symbolic(budget)? else {
        return Err(no_certificate("no certificate: the loop is undefined everywhere"));
    };
    let symbols = Arc::clone(p.fixed_symbols().ok_or_else(|| no_certificate("no certificate: symbols move"))?);
    let d = coefficients(&p);
    let n = d.len() - 1;
    let polynomial = Poly::new(d.clone());
    let mut certain: Vec<MultiPoly> = p.poles().to_vec();
    certain.push(d[n].clone());
    if n > 0 {
        let one = MultiPoly::one();
        certain.extend([polynomial.eval(&one), polynomial.eval(&one.negated())]);
    }
    let mut proof = Loop { polynomial: &p, factors: Vec::new(), certain, identity: None };
    let mut is_nowhere = proof.certain.iter().any(MultiPoly::is_zero);
    if n >= 2 && !is_nowhere {
        let found = of_half_size_pair(&polynomial, n, Shape::UnitDisc, budget)?;
        is_nowhere = found.value.is_zero();
        proof.identity = Some(found);
    }
    let mut parts = (Vec::new(), Vec::new());
    let mut bits = CERTIFICATE_OVER_SYMBOLS.first;
    if !is_nowhere {
        budget.step("factors");
        let mut all = proof.certain.clone();
        all.extend(proof.identity.as_ref().map(|i| i.value.clone()));
        proof.factors = budget.enter(|| coprime_basis(&all))?;
        let domain = &problem.parameter().domain;
        let zeros = zeros(&proof.factors, &symbols, domain, budget)?;
        let found = CERTIFICATE_OVER_SYMBOLS.find(|bits| {
            budget.check()?;
            let attempt = Attempt { proof: &proof, enclosed: Enclosed { symbols: &symbols, bits }, domain, budget };
            Ok::<_, Error>(attempt.line(zeros.clone())?.map(|line| (line, bits)))
        })?;
        (parts, bits) = found.ok_or_else(|| {
            let most = CERTIFICATE_OVER_SYMBOLS.last;
            no_certificate(format!("no certificate: a sign is not certain with {most} bits"))
        })?;
        if parts.1.len() != answer.value().intervals().len() {
            return Err(no_certificate("no certificate: an end is not told apart"));
        }
    }
    let (line, stable) = parts;
    let steps = [
        ("boundary", boundary(proof.identity.as_ref(), terms)),
        ("factors", polynomials(&proof.factors)),
        ("line", Value::Array(line)),
    ];
    let all = proof.certain.iter().chain(&proof.factors).chain(proof.identity.as_ref().map(|i| &i.value));
    let bits = bits + longest(all.chain(&d));
    certificate(problem, statement::intervals(problem, stable), (bits, &symbols), &d, steps, budget)
}

/// The certificate of a verdict.
pub(super) fn of_verdict(answer: &Answer<PointVerdict>, budget: &Budget) -> Result<String, Error> {
    let (problem, verdict) = (answer.problem(), answer.value());
    let Some(p) = problem.symbolic(budget)? else {
        return Err(no_certificate("no certificate: the loop is undefined there"));
    };
    let symbols = Arc::clone(p.fixed_symbols().ok_or_else(|| no_certificate("no certificate: symbols move"))?);
    let d = coefficients(&p);
    let (rest, on) = without_certain_roots(&d);
    let found = CERTIFICATE_OVER_SYMBOLS.find(|bits| {
        budget.check()?;
        let enclosed = Enclosed { symbols: &symbols, bits };
        let is_defined = p.poles().iter().all(|q| enclosed.coefficients(q).iter().any(|c| !c.contains_zero()));
        let inside = budget.enter(|| enclosed.inside(rest.coeffs(), None, false))?;
        let counts = |inside: usize| (inside, on, d.len() - 1 - on - inside);
        Ok::<_, Error>(inside.filter(|_| is_defined).map(|inside| (counts(inside), bits)))
    })?;
    let Some((counts, bits)) = found else {
        let why = "no certificate: roots are on the circle or mirror images in it, or the degree is lost";
        return Err(no_certificate(why));
    };
    let own = verdict.count.unwrap_or_default();
    let times = times(problem);
    if (times * own.inside, times * own.on, times * own.outside) != counts || verdict.infinite > 0 {
        return Err(no_certificate("no certificate: roots are on the circle"));
    }
    let bits = bits + longest(p.poles().iter().chain(&d));
    certificate(problem, statement::verdict(problem, verdict), (bits, &symbols), &d, [], budget)
}

/// A polynomial without its roots at 1 and -1 that are there by an identity, and how many these are.
pub(super) fn without_certain_roots(d: &[MultiPoly]) -> (Poly<MultiPoly>, usize) {
    let (mut rest, mut on) = (Poly::new(d.to_vec()), 0);
    for root in [1, -1] {
        let root = MultiPoly::from(root);
        while rest.coeffs().len() > 1 && rest.eval(&root).is_zero() {
            let line = Poly::new(vec![root.negated(), MultiPoly::one()]);
            rest = rest.pseudo_div_rem(&line).0;
            on += 1;
        }
    }
    (rest, on)
}

/// A certificate over symbols: what it says, what the symbols are, and the steps that prove it.
fn certificate<const N: usize>(
    problem: &Problem,
    statement: Value,
    (bits, symbols): (u64, &Symbols),
    characteristic: &[MultiPoly],
    steps: [(&str, Value); N],
    budget: &Budget,
) -> Result<String, Error> {
    let mut certificate = object([
        ("schema", SCHEMA.into()),
        ("model", about_at_rates(problem)?),
        ("statement", statement),
        ("bits", (TIMES_AS_MANY * bits + SPARE_BITS).min(MOST_OF_CHECKERS).into()),
        ("symbols", definitions(symbols)?),
        ("modes", modes(problem, budget)?),
        ("characteristic", polynomials(characteristic)),
    ]);
    if let Value::Object(pairs) = &mut certificate {
        pairs.extend(steps.map(|(name, value)| (name.to_owned(), value)));
    }
    Ok(to_text(&certificate))
}

/// As many coefficients as the degree and one, without an integer common to all of them.
fn coefficients(p: &SymbolicPolynomial) -> Vec<MultiPoly> {
    let mut d = p.polynomial().coeffs().to_vec();
    d.resize(p.formal_degree() + 1, MultiPoly::zero());
    let mut content = Integer::ZERO;
    for c in &d {
        content = content.gcd(&c.integer_content());
    }
    if content.is_zero() { d } else { d.iter().map(|c| c.div_exact_integer(&content).expect("a content")).collect() }
}

/// The bits of the longest coefficient.
pub(super) fn longest<'p>(polynomials: impl Iterator<Item = &'p MultiPoly>) -> u64 {
    polynomials.map(MultiPoly::height_bits).max().unwrap_or(0)
}

/// Terms by ascending exponents of the parameter and the symbols.
pub(super) fn terms(p: &MultiPoly) -> Value {
    let term = |(monomial, c): &(jurist_algebra::poly::Monomial, Integer)| {
        let mut exponents = monomial.exponents().to_vec();
        while exponents.last() == Some(&0) {
            exponents.pop();
        }
        Value::Array(std::iter::once(c.to_string().into()).chain(exponents.into_iter().map(Value::from)).collect())
    };
    Value::Array(p.terms().iter().rev().map(term).collect())
}

pub(super) fn polynomials(list: &[MultiPoly]) -> Value {
    Value::Array(list.iter().map(terms).collect())
}

/// What the symbols stand for.
pub(super) fn definitions(symbols: &Symbols) -> Result<Value, Error> {
    let constant = |f: &RationalFunction| f.as_constant().map(|q| number(&q));
    let define = |definition: &Definition| -> Option<Value> {
        Some(match definition {
            Definition::Exponential(x) => object([("exp", constant(x)?)]),
            Definition::Tangent { square, time } => {
                object([("tan", Value::Array(vec![constant(square)?, constant(time)?]))])
            }
            Definition::Fundamental { polynomial, index, time } => {
                let (_, below) = polynomial.split_last()?;
                let below = below.iter().map(constant).collect::<Option<Vec<_>>>()?;
                object([("solution", Value::Array(below)), ("time", constant(time)?), ("index", (*index).into())])
            }
            _ => return None,
        })
    };
    let all: Option<Vec<Value>> = (0..symbols.len()).map(|i| define(symbols.definition(i))).collect();
    all.map(Value::Array).ok_or_else(|| no_certificate("no certificate: a function that no checker knows"))
}

/// The factors of the characteristic polynomials of the held blocks.
pub(super) fn modes(problem: &Problem, budget: &Budget) -> Result<Value, Error> {
    let algebra = problem.algebra_over_symbols(budget)?;
    let mode = |m: &Vec<Rational>| Value::Array(m.iter().map(number).collect());
    Ok(Value::Array(algebra.symbols().modes().iter().map(mode).collect()))
}
