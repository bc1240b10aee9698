//! Writing certificates of the answers that are shown. Nothing here is trusted: what is wrong is found by the checkers.

use super::cofactors::{Identity, of_half_size_pair};
use super::complex::has_frames;
use super::line::{Line, Separator};
use super::statement::{self, boundary, number, object};
use super::text::to_text;
use super::{dead_time, enclosed, gain, held};
use super::{no_certificate, refuse_transcendental};
use crate::Certificate;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, UniPoly};
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::coverage::CoefficientRing;
use jurist_engine::problem::{DelayedLoop, Problem};
use jurist_model::error::Error;
use jurist_stability::{ParametricPolynomial, Shape, StableSet};
use serde_json::Value;

/// The schema of the certificates that are written.
pub const SCHEMA: &str = "jurist/certificate/1";

impl Certificate for Answer<StableSet> {
    /// A certificate of this answer: it proves these intervals, from these zeros and cells.
    ///
    /// Cost: the identity of the half-size pair with its cofactors takes `O(n^2)` operations on polynomials in the
    /// parameter; then greatest common divisors of the boundary polynomials in pairs, and counts of sign variations
    /// until each gap is covered. No root is counted or isolated again.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_check::{Limits, check};
    /// use jurist_model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_prove::Certificate;
    /// let (drive, budget) = (Model::drive(), Budget::unlimited());
    /// let answer = drive.ask().free("K_pwm").stable_set(&budget).unwrap();
    /// let certificate = answer.certificate(&budget).unwrap();
    /// assert!(check(&drive.source().text, &certificate, &Limits::default()).is_ok());
    /// ```
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where the limits are not
    /// algebraic numbers.
    fn certificate(&self, budget: &Budget) -> Result<String, Error> {
        budget.enter(|| {
            budget.step("certificate");
            let problem = self.problem();
            statement::of_rates(problem)?;
            if problem.model().hyperperiod() > 1
                && statement::has_held_plant(problem)
                && let Some(text) = held::of_few_samples(self, budget)?
            {
                return Ok(text);
            }
            if has_frames(problem) {
                return Err(no_certificate("no certificate: cosines and sines of a frame are proved by boxes alone"));
            }
            if let Some(delayed) = exact_delayed(problem, budget)? {
                return dead_time::of_set(self, delayed, budget);
            }
            if problem.is_written_complex()
                && statement::has_held_plant(problem)
                && let Some(text) = held::of_short_set(self, budget)?
            {
                return Ok(text);
            }
            if held::is_held(problem, budget)? {
                return held::of_set(self, budget);
            }
            refuse_transcendental(self.value(), "no certificate")?;
            let mut proof = Proof::default();
            if let Some(p) = problem.parametric(budget)? {
                let coefficients = primitive(with_content(p), p.formal_degree());
                proof = Proof::of(&coefficients, p, self, budget)?;
                proof.characteristic = coefficients;
            }
            let stable = proof.line.as_ref().map(|line| line.stable_intervals()).unwrap_or_default();
            let stable = stable.iter().map(|(l, u)| object([("lower", end(l)), ("upper", end(u))]));
            let line = proof.line.as_ref().map(line_json).unwrap_or_default();
            let certificate = object([
                ("schema", SCHEMA.into()),
                ("model", statement::about_at_rates(problem)?),
                ("statement", statement::intervals(problem, stable.collect())),
                ("characteristic", polynomials(&proof.characteristic)),
                ("boundary", boundary(proof.identity.as_ref(), polynomial)),
                ("factors", polynomials(&proof.factors)),
                ("line", Value::Array(line)),
            ]);
            Ok(to_text(&certificate))
        })?
    }
}

/// The characteristic function of a loop with dead time, where its coefficients are rational.
fn exact_delayed<'p>(problem: &'p Problem, budget: &Budget) -> Result<Option<&'p DelayedLoop>, Error> {
    let ring = CoefficientRing::of(problem.algebra_over_symbols(budget)?.symbols());
    if ring == CoefficientRing::DeadTimeBesideFunctions {
        return Err(no_certificate("no certificate: beside dead time functions are proved by boxes alone"));
    }
    match problem.delayed(budget)? {
        Some(delayed) if !delayed.is_exact() => Err(no_certificate(
            "no certificate: beside dead time constants that are not rational are proved by boxes alone",
        )),
        Some(_) if problem.is_complex() => {
            Err(no_certificate("no certificate: with dead time complex coefficients are proved by boxes alone"))
        }
        delayed => Ok(delayed),
    }
}

impl Certificate for Answer<PointVerdict> {
    /// A certificate of this verdict.
    ///
    /// Cost: `O(n)` greatest common divisors of integers; no root is counted again.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where the loop has functions written in
    /// the model, or dead time and roots on the axis.
    fn certificate(&self, budget: &Budget) -> Result<String, Error> {
        budget.enter(|| {
            budget.step("certificate");
            let (problem, verdict) = (self.problem(), self.value());
            statement::of_rates(problem)?;
            if enclosed::is_enclosed(problem, budget)? {
                return enclosed::of_verdict(self);
            }
            if let Some(delayed) = exact_delayed(problem, budget)? {
                return gain::of_verdict(self, delayed);
            }
            if held::is_held(problem, budget)? {
                return held::of_verdict(self, budget);
            }
            let characteristic = match problem.parametric(budget)? {
                None => Vec::new(),
                Some(p) => primitive(with_content(p), p.formal_degree()),
            };
            let certificate = object([
                ("schema", SCHEMA.into()),
                ("model", statement::about_at_rates(problem)?),
                ("statement", statement::verdict(problem, verdict)),
                ("characteristic", polynomials(&characteristic)),
            ]);
            Ok(to_text(&certificate))
        })?
    }
}

/// The coefficients without denominators.
fn with_content(p: &ParametricPolynomial) -> Vec<UniPoly> {
    p.polynomial().coeffs().iter().map(|c| c.times(p.content())).collect()
}

#[derive(Default)]
struct Proof {
    characteristic: Vec<UniPoly>,
    identity: Option<Identity<UniPoly>>,
    factors: Vec<UniPoly>,
    /// `None` when the loop is stable nowhere because a boundary condition holds everywhere.
    line: Option<Line>,
}

impl Proof {
    fn of(
        d: &[UniPoly],
        p: &ParametricPolynomial,
        answer: &Answer<StableSet>,
        budget: &Budget,
    ) -> Result<Proof, Exhausted> {
        let n = d.len() - 1;
        let shape = answer.problem().shape();
        let mut certain: Vec<UniPoly> = p.poles().to_vec();
        certain.push(p.denominator().clone());
        certain.push(d[n].clone());
        if n > 0 {
            let polynomial = jurist_algebra::poly::Poly::new(d.to_vec());
            match shape {
                Shape::UnitDisc => {
                    certain.push(polynomial.eval(&UniPoly::constant(Integer::ONE)));
                    certain.push(polynomial.eval(&UniPoly::constant(-Integer::ONE)));
                }
                Shape::LeftHalfPlane => certain.push(d[0].clone()),
            }
        }
        if certain.iter().any(UniPoly::is_zero) {
            return Ok(Proof::default());
        }
        let mut all = certain.clone();
        let mut proof = Proof::default();
        if n >= 2 {
            let identity = of_half_size_pair(&jurist_algebra::poly::Poly::new(d.to_vec()), n, shape, budget)?;
            let value = identity.value.clone();
            proof.identity = Some(identity);
            if value.is_zero() {
                return Ok(proof);
            }
            all.push(value);
        }
        budget.step("factors");
        proof.factors = coprime_basis(&all, budget)?;
        let Some(cells) = answer.value().cells() else { return Ok(proof) };
        let domain = &answer.problem().parameter().domain;
        let line = Line::of(&proof.factors, domain, cells, &certain, proof.identity.as_ref(), budget)?;
        proof.line = Some(line);
        Ok(proof)
    }
}

/// Square-free, pairwise coprime polynomials of which all given ones are products.
pub(super) fn coprime_basis(polynomials: &[UniPoly], budget: &Budget) -> Result<Vec<UniPoly>, Exhausted> {
    let mut basis: Vec<UniPoly> = Vec::new();
    for p in polynomials {
        // Roots of different multiplicities belong to different factors: p is a product of the parts' powers.
        let mut parts: Vec<UniPoly> = p.square_free_decomposition().into_iter().map(|(part, _)| part).collect();
        while let Some(mut part) = parts.pop() {
            budget.check()?;
            let mut k = 0;
            while k < basis.len() && !part.is_constant() {
                let g = part.gcd(&basis[k]).primitive_part();
                if !g.is_constant() {
                    let rest = basis[k].div_exact(&g).expect("a gcd divides").primitive_part();
                    part = part.div_exact(&g).expect("a gcd divides").primitive_part();
                    if rest.is_constant() {
                        basis[k] = g;
                    } else {
                        basis[k] = rest;
                        basis.insert(k, g);
                        k += 1;
                    }
                }
                k += 1;
            }
            if !part.is_constant() {
                basis.push(part);
            }
        }
    }
    Ok(basis)
}

/// `n + 1` coefficients divided by the integers common to all of them.
fn primitive(mut coefficients: Vec<UniPoly>, n: usize) -> Vec<UniPoly> {
    coefficients.resize(n + 1, UniPoly::zero());
    let mut content = Integer::ZERO;
    for c in coefficients.iter().flat_map(|c| c.coeffs()) {
        content = content.gcd(c);
    }
    if content.is_zero() {
        return coefficients;
    }
    coefficients.iter().map(|c| c.div_exact_scalar(&content).expect("the content divides")).collect()
}

fn polynomial(p: &UniPoly) -> Value {
    Value::Array(p.coeffs().iter().map(|c| c.to_string().into()).collect())
}

pub(super) fn polynomials(list: &[UniPoly]) -> Value {
    Value::Array(list.iter().map(polynomial).collect())
}

fn end(separator: &Separator) -> Value {
    match separator {
        Separator::Outer(None) => Value::Null,
        Separator::Outer(Some(q)) | Separator::At { value: q, .. } => number(q),
        Separator::Between { root, polynomial: p, .. } => {
            let (a, b) = root.enclosure();
            object([("polynomial", polynomial(p)), ("between", Value::Array(vec![number(&a), number(&b)]))])
        }
    }
}

fn line_json(line: &Line) -> Vec<Value> {
    let count = |n: usize| Value::from(n);
    let mut out = Vec::new();
    for (i, stretch) in line.stretches.iter().enumerate() {
        if i > 0 {
            let (mut json, touch) = match &line.separators[i] {
                Separator::Outer(_) => (object([]), &None),
                Separator::At { value, touch } => (object([("at", number(value))]), touch),
                Separator::Between { root, factor, touch, .. } => {
                    let (a, b) = root.enclosure();
                    let between = Value::Array(vec![number(&a), number(&b)]);
                    (object([("between", between), ("factor", count(*factor))]), touch)
                }
            };
            if let (Value::Object(pairs), Some((in_u, k))) = (&mut json, touch) {
                let which = if *in_u { "u" } else { "v" };
                pairs.insert("touch".to_owned(), Value::Array(vec![which.into(), count(*k)]));
            }
            out.push(json);
        }
        out.push(object([
            ("split", Value::Array(stretch.split.iter().map(number).collect())),
            ("sample", number(&stretch.sample)),
            ("stable", Value::Bool(stretch.stable)),
        ]));
    }
    out
}
