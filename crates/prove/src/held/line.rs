//! The line of the parameter over symbols, cut into stretches and zeros that a checker can verify without search.

use super::{Loop, coefficients, terms};
use crate::line::{between, middle};
use crate::no_certificate;
use crate::over_symbols::Enclosed;
use crate::statement::{number, object};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{SymbolicPoly, Symbols};
use jurist_model::error::Error;
use jurist_stability::Range;
use serde_json::Value;
use std::sync::Arc;

/// Irrational ends are enclosed to this many digits.
const DIGITS: usize = 12;

/// Splits of one gap after which it is given up.
const MOST_SPLITS: usize = 4096;

/// A place where a boundary polynomial is zero.
#[derive(Clone)]
pub(super) enum Zero {
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

/// All zeros of the factors in the domain, ascending.
pub(super) fn zeros(
    factors: &[MultiPoly],
    symbols: &Arc<Symbols>,
    domain: &Range,
    budget: &Budget,
) -> Result<Vec<Zero>, Error> {
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

/// The line and the stable intervals, as the certificate writes them.
pub(super) type Written = (Vec<Value>, Vec<Value>);

/// One attempt with a number of bits.
pub(super) struct Attempt<'a> {
    pub proof: &'a Loop<'a>,
    pub enclosed: Enclosed<'a>,
    pub domain: &'a Range,
    pub budget: &'a Budget,
}

impl Attempt<'_> {
    /// The line and the stable intervals; `None` where a sign is not certain.
    pub fn line(&self, mut zeros: Vec<Zero>) -> Result<Option<Written>, Error> {
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
