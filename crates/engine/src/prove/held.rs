//! Certificates of loops with blocks behind a hold: polynomials over symbols, whose definitions the checkers enclose themselves.

use super::cofactors::{Identity, identity};
use super::emit::{about, number, object, region, set};
use super::no_certificate;
use super::over_symbols::{Enclosed, coprime_basis};
use super::text::to_text;
use crate::answer::{Answer, PointVerdict};
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::{HalfSizePair, Range, Shape, StableSet, SymbolicPolynomial};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, simplest_between};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, SymbolicPoly, Symbols};
use serde_json::Value;
use std::sync::Arc;

/// The schema of certificates over symbols.
const SCHEMA: &str = "jurist/certificate/2";

/// Bits of the first attempt.
const FIRST_BITS: u64 = 256;

/// Bits after which a certificate is given up.
const MOST_BITS: u64 = 1 << 13;

/// The checkers have so many bits more than the signs were certain with here.
const SPARE_BITS: u64 = 64;

/// Irrational ends are enclosed to this many digits.
const DIGITS: usize = 12;

/// Splits of one gap after which it is given up.
const MOST_SPLITS: usize = 4096;

/// Whether the loop has constants that are not rational, all of them from blocks behind holds at fixed times.
pub(super) fn is_held(problem: &Problem, budget: &Budget) -> Result<bool, Error> {
    let algebra = problem.algebra_over_symbols(budget)?;
    let symbols = algebra.symbols();
    if symbols.is_empty() {
        return Ok(false);
    }
    if symbols.is_moving() || symbols.is_written() || !symbols.delays().is_empty() {
        return Err(no_certificate("no certificate: the loop has functions that no checker knows there"));
    }
    Ok(true)
}

/// A place where a boundary polynomial is zero.
#[derive(Clone)]
enum Zero {
    At(Rational),
    Between { factor: usize, root: Real },
}

impl Zero {
    fn limits(&self) -> (Rational, Rational) {
        match self {
            Zero::At(q) => (q.clone(), q.clone()),
            Zero::Between { root, .. } => root.enclosure(),
        }
    }

    fn narrower(&mut self) {
        if let Zero::Between { root, .. } = self {
            let (a, b) = root.enclosure();
            *root = root.refined(&((b - a) * Rational::new(Integer::ONE, Integer::from(4))));
        }
    }
}

/// What the line is made of.
struct Loop<'l> {
    polynomial: &'l SymbolicPolynomial,
    symbols: &'l Symbols,
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
    let mut proof = Loop { polynomial: &p, symbols: &symbols, factors: Vec::new(), certain, identity: None };
    let mut is_nowhere = proof.certain.iter().any(MultiPoly::is_zero);
    if n >= 2 && !is_nowhere {
        let pair = HalfSizePair::new(&polynomial, n, Shape::UnitDisc);
        let found = identity(&pair.a, &pair.b, budget)?;
        is_nowhere = found.value.is_zero();
        proof.identity = Some(found);
    }
    let mut parts = (Vec::new(), Vec::new());
    let mut bits = FIRST_BITS;
    if !is_nowhere {
        budget.step("factors");
        let mut all = proof.certain.clone();
        all.extend(proof.identity.as_ref().map(|i| i.value.clone()));
        proof.factors = budget.enter(|| coprime_basis(&all))?;
        let domain = &problem.parameter().domain;
        let zeros = zeros(&proof.factors, &symbols, domain, budget)?;
        parts = loop {
            budget.check()?;
            let attempt = Attempt { proof: &proof, enclosed: Enclosed { symbols: &symbols, bits }, domain, budget };
            match attempt.line(zeros.clone())? {
                Some(line) => break line,
                None if bits >= MOST_BITS => {
                    return Err(no_certificate(format!("no certificate: a sign is not certain with {bits} bits")));
                }
                None => bits *= 2,
            }
        };
        if parts.1.len() != answer.value().intervals().len() {
            return Err(no_certificate("no certificate: an end is not told apart"));
        }
    }
    let (line, stable) = parts;
    let bound = |b: &Option<Rational>| b.as_ref().map_or(Value::Null, number);
    let range = &problem.parameter().domain;
    let statement = object([
        ("kind", "intervals".into()),
        ("time", problem.time().name().into()),
        ("parameter", problem.parameter().name.as_str().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("domain", object([("lower", bound(&range.lower)), ("upper", bound(&range.upper))])),
        ("stable", Value::Array(stable)),
    ]);
    let boundary = match &proof.identity {
        None => Value::Null,
        Some(i) => object([("u", polynomials(&i.u)), ("v", polynomials(&i.v)), ("value", terms(&i.value))]),
    };
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about(problem)),
        ("statement", statement),
        ("bits", (bits + SPARE_BITS).into()),
        ("symbols", definitions(&symbols)?),
        ("modes", modes(problem, budget)?),
        ("characteristic", polynomials(&d)),
        ("boundary", boundary),
        ("factors", polynomials(&proof.factors)),
        ("line", Value::Array(line)),
    ])))
}

/// The certificate of a verdict.
pub(super) fn of_verdict(answer: &Answer<PointVerdict>, budget: &Budget) -> Result<String, Error> {
    let (problem, verdict) = (answer.problem(), answer.value());
    let Some(p) = problem.symbolic(budget)? else {
        return Err(no_certificate("no certificate: the loop is undefined there"));
    };
    let symbols = Arc::clone(p.fixed_symbols().ok_or_else(|| no_certificate("no certificate: symbols move"))?);
    let d = coefficients(&p);
    // Roots at 1 and -1 that are there by an identity are divided out.
    let (mut rest, mut on) = (Poly::new(d.clone()), 0);
    for root in [1, -1] {
        let root = MultiPoly::from(root);
        while rest.coeffs().len() > 1 && rest.eval(&root).is_zero() {
            let line = Poly::new(vec![root.negated(), MultiPoly::one()]);
            rest = rest.pseudo_div_rem(&line).0;
            on += 1;
        }
    }
    let mut bits = FIRST_BITS;
    let counts = loop {
        budget.check()?;
        let enclosed = Enclosed { symbols: &symbols, bits };
        let is_defined = p.poles().iter().all(|q| enclosed.coefficients(q).iter().any(|c| !c.contains_zero()));
        let inside = budget.enter(|| enclosed.inside(rest.coeffs(), None, false))?;
        match inside {
            Some(inside) if is_defined => break (inside, on, d.len() - 1 - on - inside),
            _ if bits >= MOST_BITS => {
                let why = "no certificate: roots are on the circle or mirror images in it, or the degree is lost";
                return Err(no_certificate(why));
            }
            _ => bits *= 2,
        }
    };
    let own = verdict.count.unwrap_or_default();
    if (own.inside, own.on, own.outside) != counts || verdict.infinite > 0 {
        return Err(no_certificate("no certificate: roots are on the circle"));
    }
    let statement = object([
        ("kind", "verdict".into()),
        ("time", problem.time().name().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("verdict", verdict.verdict.name().into()),
        ("degree", verdict.degree.into()),
        ("inside", own.inside.into()),
        ("on", own.on.into()),
        ("outside", own.outside.into()),
        ("infinite", 0.into()),
    ]);
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about(problem)),
        ("statement", statement),
        ("bits", (bits + SPARE_BITS).into()),
        ("symbols", definitions(&symbols)?),
        ("modes", modes(problem, budget)?),
        ("characteristic", polynomials(&d)),
    ])))
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

/// All zeros of the factors in the domain, ascending.
fn zeros(factors: &[MultiPoly], symbols: &Arc<Symbols>, domain: &Range, budget: &Budget) -> Result<Vec<Zero>, Error> {
    let mut all: Vec<(Real, usize)> = Vec::new();
    for (k, factor) in factors.iter().enumerate() {
        let Some(p) = SymbolicPoly::new(factor, symbols, budget)? else {
            return Err(no_certificate("no certificate: a factor vanishes"));
        };
        for root in p.real_roots_in(domain.lower.as_ref(), domain.upper.as_ref(), budget)? {
            let mut at = all.len();
            while at > 0 && root.compare(&all[at - 1].0, budget)?.is_lt() {
                at -= 1;
            }
            all.insert(at, (root, k));
        }
    }
    let zero = |(root, factor): (Real, usize)| match root.exact() {
        Some(q) => Zero::At(q),
        None => Zero::Between { factor, root: root.refined_to_digits(DIGITS) },
    };
    Ok(all.into_iter().map(zero).collect())
}

/// One attempt with a number of bits.
struct Attempt<'a> {
    proof: &'a Loop<'a>,
    enclosed: Enclosed<'a>,
    domain: &'a Range,
    budget: &'a Budget,
}

impl Attempt<'_> {
    /// The line and the stable intervals; `None` where a sign is not certain.
    fn line(&self, mut zeros: Vec<Zero>) -> Result<Option<(Vec<Value>, Vec<Value>)>, Error> {
        for zero in &mut zeros {
            if !self.isolate(zero)? {
                return Ok(None);
            }
        }
        for i in 1..zeros.len() {
            while zeros[i - 1].limits().1 > zeros[i].limits().0
                || (zeros[i - 1].limits().1 == zeros[i].limits().0
                    && matches!((&zeros[i - 1], &zeros[i]), (Zero::At(_), _) | (_, Zero::At(_))))
            {
                self.budget.check()?;
                zeros[i - 1].narrower();
                zeros[i].narrower();
            }
        }
        let ends: Vec<Option<Rational>> = std::iter::once(self.domain.lower.clone())
            .chain(zeros.iter().flat_map(|z| [Some(z.limits().0), Some(z.limits().1)]))
            .chain([self.domain.upper.clone()])
            .collect();
        let (mut line, mut stable) = (Vec::new(), Vec::new());
        let mut verdicts = Vec::new();
        for i in 0..=zeros.len() {
            let (l, r) = (&ends[2 * i], &ends[2 * i + 1]);
            let Some(split) = self.split(l, r)? else { return Ok(None) };
            let sample = between(l, r);
            let d = coefficients(self.proof.polynomial);
            let Some(inside) = self.budget.enter(|| self.enclosed.inside(&d, Some(&sample), true))? else {
                return Ok(None);
            };
            verdicts.push((split, sample, inside + 1 == d.len()));
        }
        for (i, (split, sample, is_stable)) in verdicts.iter().enumerate() {
            if i > 0 {
                let touches = verdicts[i - 1].2 && *is_stable;
                let Some(separator) = self.separator(&zeros[i - 1], touches) else { return Ok(None) };
                line.push(separator);
            }
            line.push(object([
                ("split", split.iter().map(number).collect()),
                ("sample", number(sample)),
                ("stable", (*is_stable).into()),
            ]));
            if *is_stable {
                let lower = if i == 0 { bound(&self.domain.lower) } else { self.end(&zeros[i - 1]) };
                let upper = zeros.get(i).map_or_else(|| bound(&self.domain.upper), |z| self.end(z));
                stable.push(object([("lower", lower), ("upper", upper)]));
            }
        }
        Ok(Some((line, stable)))
    }

    /// Refines until Descartes' rule sees one root of its factor and none of the others.
    fn isolate(&self, zero: &mut Zero) -> Result<bool, Error> {
        let Zero::Between { factor, .. } = &*zero else { return Ok(true) };
        let factor = *factor;
        loop {
            self.budget.check()?;
            let (a, b) = zero.limits();
            let mut fits = true;
            for (i, f) in self.proof.factors.iter().enumerate() {
                let signs = [self.enclosed.sign_at(f, &a), self.enclosed.sign_at(f, &b)];
                let count = self.enclosed.variations(f, Some(&a), Some(&b));
                let ([Some(s), Some(t)], Some(count)) = (signs, count) else { return Ok(false) };
                fits = fits && !s.is_eq() && !t.is_eq() && count == usize::from(i == factor);
            }
            if fits {
                return Ok(true);
            }
            zero.narrower();
        }
    }

    /// Points between which Descartes' rule sees no root of any factor; `None` where a sign is not certain.
    fn split(&self, l: &Option<Rational>, r: &Option<Rational>) -> Result<Option<Vec<Rational>>, Error> {
        let mut out = Vec::new();
        if l.is_some() && l == r {
            return Ok(Some(out));
        }
        let mut pieces = vec![(l.clone(), r.clone())];
        while let Some((l, r)) = pieces.pop() {
            self.budget.check()?;
            let is_whole = l.is_none() && r.is_none();
            let counts: Vec<Option<usize>> = match is_whole {
                true => self.proof.factors.iter().map(|_| Some(1)).collect(),
                false => {
                    self.proof.factors.iter().map(|f| self.enclosed.variations(f, l.as_ref(), r.as_ref())).collect()
                }
            };
            if counts.iter().any(Option::is_none) {
                return Ok(None);
            }
            if counts.iter().all(|c| *c == Some(0)) {
                if let Some(r) = r.filter(|_| !pieces.is_empty()) {
                    out.push(r);
                }
                continue;
            }
            if out.len() + pieces.len() > MOST_SPLITS {
                return Ok(None);
            }
            let m = middle(&l, &r);
            for f in &self.proof.factors {
                match self.enclosed.sign_at(f, &m) {
                    Some(sign) if !sign.is_eq() => {}
                    _ => return Ok(None),
                }
            }
            pieces.push((Some(m.clone()), r));
            pieces.push((l, Some(m)));
        }
        Ok(Some(out))
    }

    fn end(&self, zero: &Zero) -> Value {
        match zero {
            Zero::At(q) => number(q),
            Zero::Between { factor, .. } => {
                object([("polynomial", terms(&self.proof.factors[*factor])), ("between", pair(zero))])
            }
        }
    }

    /// A point of the line; between two stable stretches with what shows that it is not stable itself.
    fn separator(&self, zero: &Zero, touches: bool) -> Option<Value> {
        let mut json = match zero {
            Zero::At(q) => object([("at", number(q))]),
            Zero::Between { factor, .. } => object([("between", pair(zero)), ("factor", (*factor).into())]),
        };
        let vanishes = |p: &MultiPoly| match zero {
            Zero::At(q) => self.enclosed.sign_at(p, q).is_some_and(|s| s.is_eq()),
            Zero::Between { factor, .. } => p.div_exact(&self.proof.factors[*factor]).is_some(),
        };
        let identity = match &self.proof.identity {
            Some(identity) if touches && !self.proof.certain.iter().any(vanishes) => identity,
            _ => return Some(json),
        };
        let differs = |p: &MultiPoly| match zero {
            Zero::At(q) => self.enclosed.sign_at(p, q).is_some_and(|s| !s.is_eq()),
            Zero::Between { .. } => {
                let (a, b) = zero.limits();
                !p.is_zero() && self.enclosed.variations(p, Some(&a), Some(&b)) == Some(0)
            }
        };
        let in_u = identity.u.iter().position(differs).map(|k| ("u", k));
        let (which, k) = in_u.or_else(|| identity.v.iter().position(differs).map(|k| ("v", k)))?;
        if let Value::Object(pairs) = &mut json {
            pairs.insert("touch".to_owned(), Value::Array(vec![which.into(), k.into()]));
        }
        Some(json)
    }
}

fn bound(b: &Option<Rational>) -> Value {
    b.as_ref().map_or(Value::Null, number)
}

fn pair(zero: &Zero) -> Value {
    let (a, b) = zero.limits();
    Value::Array(vec![number(&a), number(&b)])
}

/// A simple number in an interval that may be unbounded or a single point.
fn between(l: &Option<Rational>, r: &Option<Rational>) -> Rational {
    match (l, r) {
        (None, None) => Rational::ZERO,
        (Some(l), None) => Rational::from(l.floor()) + Rational::ONE,
        (None, Some(r)) => Rational::from(r.ceil()) - Rational::ONE,
        (Some(l), Some(r)) => simplest_between(l, r).unwrap_or_else(|| l.clone()),
    }
}

/// A simple number about the middle; further and further out of an end that is not there.
fn middle(l: &Option<Rational>, r: &Option<Rational>) -> Rational {
    let two = Rational::from(2);
    let beyond =
        |x: &Rational| if x.is_negative() { Rational::ONE } else { Rational::from((x * &two).ceil() + Integer::ONE) };
    match (l, r) {
        (None, None) => Rational::ZERO,
        (Some(l), None) => beyond(l),
        (None, Some(r)) => -beyond(&-r),
        (Some(l), Some(r)) => {
            let quarter = &(r - l) * &Rational::new(Integer::ONE, Integer::from(4));
            simplest_between(&(l + &quarter), &(r - &quarter)).unwrap_or_else(|| l.midpoint(r))
        }
    }
}

/// Terms by ascending exponents of the parameter and the symbols.
fn terms(p: &MultiPoly) -> Value {
    let term = |(monomial, c): &(jurist_algebra::poly::Monomial, Integer)| {
        let mut exponents = monomial.exponents().to_vec();
        while exponents.last() == Some(&0) {
            exponents.pop();
        }
        Value::Array(std::iter::once(c.to_string().into()).chain(exponents.into_iter().map(Value::from)).collect())
    };
    Value::Array(p.terms().iter().rev().map(term).collect())
}

fn polynomials(list: &[MultiPoly]) -> Value {
    Value::Array(list.iter().map(terms).collect())
}

/// What the symbols stand for.
fn definitions(symbols: &Symbols) -> Result<Value, Error> {
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
fn modes(problem: &Problem, budget: &Budget) -> Result<Value, Error> {
    let algebra = problem.algebra_over_symbols(budget)?;
    let mode = |m: &Vec<Rational>| Value::Array(m.iter().map(number).collect());
    Ok(Value::Array(algebra.symbols().modes().iter().map(mode).collect()))
}
