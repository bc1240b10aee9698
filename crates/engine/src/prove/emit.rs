//! Writing certificates. Nothing here is trusted: what is wrong is found by the [check](super::check).

use super::cofactors::{Identity, identity};
use super::line::{Line, Separator};
use super::text::to_text;
use crate::analysis::{DECAY, Failure, OneParameter, PointVerdict, RADIUS, Settings};
use crate::model::{Loop, ModelError, Question, Time};
use crate::stability::{HalfSizePair, Region};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};
use serde_json::Value;

/// The schema of the certificates that are written.
pub const SCHEMA: &str = "jurist/certificate/1";

/// A certificate for the stable set of one parameter.
///
/// ```
/// use jurist_engine::analysis::{Settings, one_parameter};
/// use jurist_check::{Limits, check};
/// use jurist_engine::prove::emit::intervals_certificate;
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{DRIVE, Loop};
/// let budget = Budget::unlimited();
/// let question = one_parameter(&Loop::drive(), &Settings::default(), "K_pwm", &budget).unwrap();
/// let certificate = intervals_certificate(DRIVE, &question, &budget).unwrap();
/// assert!(check(DRIVE, &certificate, &Limits::default()).is_ok());
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn intervals_certificate(model: &str, question: &OneParameter, budget: &Budget) -> Result<String, Exhausted> {
    budget.step("certificate");
    let relative = question.parameter == RADIUS && question.time == Time::Discrete
        || question.parameter == DECAY && question.time == Time::Continuous;
    let mut proof = Proof::default();
    if let Some(p) = &question.polynomial {
        let full = p.polynomial().coeffs().iter().map(|c| c.times(p.content())).collect();
        let coefficients = primitive(full, p.formal_degree());
        proof = Proof::of(&coefficients, p.poles(), p.denominator(), question, budget)?;
        proof.characteristic = coefficients;
    }
    let bound = |b: &Option<Rational>| b.as_ref().map_or(Value::Null, number);
    let domain = object([("lower", bound(&question.domain.lower)), ("upper", bound(&question.domain.upper))]);
    let stable = proof.line.as_ref().map(|line| line.stable_intervals()).unwrap_or_default();
    let statement = object([
        ("kind", "intervals".into()),
        ("time", question.time.name().into()),
        ("parameter", question.parameter.as_str().into()),
        ("set", set(&question.set)),
        ("region", region(question.time, &question.radius, &question.decay, relative)),
        ("domain", domain),
        ("stable", Value::Array(stable.iter().map(|(l, u)| object([("lower", end(l)), ("upper", end(u))])).collect())),
    ]);
    let boundary = match &proof.identity {
        None => Value::Null,
        Some(i) => object([("u", polynomials(&i.u)), ("v", polynomials(&i.v)), ("value", polynomial(&i.value))]),
    };
    let line = proof.line.as_ref().map(line_json).unwrap_or_default();
    let certificate = object([
        ("schema", SCHEMA.into()),
        ("model", about(model, question.title.as_deref())),
        ("statement", statement),
        ("characteristic", polynomials(&proof.characteristic)),
        ("boundary", boundary),
        ("factors", polynomials(&proof.factors)),
        ("line", Value::Array(line)),
    ]);
    Ok(to_text(&certificate))
}

/// A certificate for the verdict at one point.
///
/// # Errors
/// [`Failure`] when the question is refused or the budget runs out.
pub fn verdict_certificate(
    lp: &Loop,
    settings: &Settings,
    answer: &PointVerdict,
    budget: &Budget,
) -> Result<String, Failure> {
    budget.step("certificate");
    let question = Question { keep: Vec::new(), set: settings.set.clone() };
    let characteristic = match lp.characteristic_polynomial(&question, budget) {
        Err(ModelError::Undefined(_)) => Vec::new(),
        Err(ModelError::Input(error)) => return Err(error.into()),
        Err(ModelError::Exhausted(exhausted)) => return Err(exhausted.into()),
        Ok(d) => {
            let values = d.coefficients.iter().map(|c| c.as_constant().unwrap_or(Rational::ZERO)).collect();
            let values = in_region(values, &answer.radius, &answer.decay);
            let common = values.iter().fold(Integer::ONE, |l, v| l.lcm(&v.denominator()));
            let scaled = |v: &Rational| (v * &Rational::from(&common)).numerator();
            primitive(values.iter().map(|v| UniPoly::constant(scaled(v))).collect(), answer.degree)
        }
    };
    let counts = answer.count.unwrap_or_default();
    let count = |n: usize| Value::from(n);
    let statement = object([
        ("kind", "verdict".into()),
        ("time", answer.time.name().into()),
        ("set", set(&answer.set)),
        ("region", region(answer.time, &answer.radius, &answer.decay, false)),
        ("verdict", answer.verdict.name().into()),
        ("degree", count(answer.degree)),
        ("inside", count(counts.inside)),
        ("on", count(counts.on)),
        ("outside", count(counts.outside)),
        ("infinite", count(answer.infinite)),
    ]);
    let certificate = object([
        ("schema", SCHEMA.into()),
        ("model", about(&lp.source().text, answer.title.as_deref())),
        ("statement", statement),
        ("characteristic", polynomials(&characteristic)),
    ]);
    Ok(to_text(&certificate))
}

#[derive(Default)]
struct Proof {
    characteristic: Vec<UniPoly>,
    identity: Option<Identity>,
    factors: Vec<UniPoly>,
    /// `None` when the loop is stable nowhere because a boundary condition holds everywhere.
    line: Option<Line>,
}

impl Proof {
    fn of(
        d: &[UniPoly],
        poles: &[UniPoly],
        denominator: &UniPoly,
        question: &OneParameter,
        budget: &Budget,
    ) -> Result<Proof, Exhausted> {
        let n = d.len() - 1;
        let mut certain: Vec<UniPoly> = poles.to_vec();
        certain.push(denominator.clone());
        certain.push(d[n].clone());
        if n > 0 {
            let polynomial = jurist_algebra::poly::Poly::new(d.to_vec());
            match question.region {
                Region::UnitDisc => {
                    certain.push(polynomial.eval(&UniPoly::constant(Integer::ONE)));
                    certain.push(polynomial.eval(&UniPoly::constant(-Integer::ONE)));
                }
                Region::LeftHalfPlane => certain.push(d[0].clone()),
            }
        }
        if certain.iter().any(UniPoly::is_zero) {
            return Ok(Proof::default());
        }
        let mut all = certain.clone();
        let mut proof = Proof::default();
        if n >= 2 {
            let pair = HalfSizePair::new(&jurist_algebra::poly::Poly::new(d.to_vec()), n, question.region);
            let identity = identity(&pair.a, &pair.b, budget)?;
            let value = identity.value.clone();
            proof.identity = Some(identity);
            if value.is_zero() {
                return Ok(proof);
            }
            all.push(value);
        }
        budget.step("factors");
        proof.factors = coprime_basis(&all, budget)?;
        let p = question.polynomial.as_ref().expect("it has a polynomial");
        let stable = |sample: &Rational| p.is_stable_at(sample, question.region);
        let line = Line::of(&proof.factors, &question.domain, &certain, proof.identity.as_ref(), stable, budget)?;
        proof.line = Some(line);
        Ok(proof)
    }
}

/// Square-free, pairwise coprime polynomials of which all given ones are products.
fn coprime_basis(polynomials: &[UniPoly], budget: &Budget) -> Result<Vec<UniPoly>, Exhausted> {
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

fn in_region(mut c: Vec<Rational>, radius: &Option<Rational>, decay: &Option<Rational>) -> Vec<Rational> {
    if let Some(r) = radius {
        let mut power = Rational::ONE;
        for x in &mut c {
            *x = &*x * &power;
            power = &power * r;
        }
    }
    if let Some(s) = decay {
        for i in 0..c.len() {
            for j in (i..c.len() - 1).rev() {
                c[j] = &c[j] - &(&c[j + 1] * s);
            }
        }
    }
    c
}

fn object<const N: usize>(pairs: [(&str, Value); N]) -> Value {
    Value::Object(pairs.into_iter().map(|(k, v)| (k.to_owned(), v)).collect())
}

fn number(value: &Rational) -> Value {
    value.to_string().into()
}

fn polynomial(p: &UniPoly) -> Value {
    Value::Array(p.coeffs().iter().map(|c| c.to_string().into()).collect())
}

fn polynomials(list: &[UniPoly]) -> Value {
    Value::Array(list.iter().map(polynomial).collect())
}

fn set(values: &[(String, Rational)]) -> Value {
    Value::Object(values.iter().map(|(n, v)| (n.clone(), number(v))).collect())
}

fn region(time: Time, radius: &Option<Rational>, decay: &Option<Rational>, relative: bool) -> Value {
    let (key, value, usual) = match time {
        Time::Discrete => ("radius", radius, Rational::ONE),
        Time::Continuous => ("decay", decay, Rational::ZERO),
    };
    let value = if relative { "parameter".into() } else { number(value.as_ref().unwrap_or(&usual)) };
    object([(key, value)])
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

/// Title and digest of the model, for people: the check reads the model itself.
fn about(model: &str, title: Option<&str>) -> Value {
    let digest =
        model.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    object([("title", title.map_or(Value::Null, Value::from)), ("digest", format!("fnv1a64:{digest:016x}").into())])
}
