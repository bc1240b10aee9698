//! What the checker in `proofs/Compute.v` will compute: its conditions, and its tests of signs on an interval. A way along the
//! domain is chosen by trying them here first; nothing of it is believed by Coq.

use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};
use jurist_engine::problem::{Bound, Region};

/// How often the checker may halve an interval.
pub(super) const FUEL: usize = 8;

/// Polynomials in the parameter, all of them positive exactly where the loop is stable; `None` where a division of the table
/// does not come out, which is where an earlier row vanishes identically.
pub(super) fn conditions(coefficients: &[UniPoly], region: &Region) -> Option<Vec<UniPoly>> {
    let row = primitive(to_disc(coefficients, region));
    let n = row.len().checked_sub(1).filter(|n| *n > 0)?;
    let lead = row[n].clone();
    let at_one = row.iter().fold(UniPoly::zero(), |sum, c| sum.plus(c));
    let alternating = row.iter().rev().fold(UniPoly::zero(), |sum, c| c.minus(&sum));
    let alternating = if n % 2 == 1 { alternating.negated() } else { alternating };
    let mut out = vec![lead.times(&at_one), lead.times(&alternating)];
    let (mut row, mut divisor, mut next) = (row, UniPoly::one(), UniPoly::one());
    for _ in 1..n {
        row = divided(&row, &divisor)?;
        let lead = row.last()?.clone();
        divisor = std::mem::replace(&mut next, positive_primitive(&lead));
        out.push(lead);
    }
    Some(out)
}

/// The next row of Jury's table without the known factor and without its content.
fn divided(row: &[UniPoly], divisor: &UniPoly) -> Option<Vec<UniPoly>> {
    let (first, last) = (row.first()?, row.last()?);
    let next = (1..row.len()).map(|i| last.times(&row[i]).minus(&first.times(&row[row.len() - 1 - i])));
    let quotients: Option<Vec<UniPoly>> = next.map(|x| x.div_exact(divisor)).collect();
    quotients.map(primitive).filter(|row| row.iter().any(|c| !c.is_zero()))
}

fn primitive(list: Vec<UniPoly>) -> Vec<UniPoly> {
    let content = list.iter().flat_map(|c| c.coeffs()).fold(Integer::ZERO, |g, c| Integer::gcd(&g, c));
    if content.is_zero() {
        return list;
    }
    list.iter().map(|c| c.div_exact_scalar(&content).expect("the content divides")).collect()
}

/// Divided by the positive integers only.
pub(super) fn positive_primitive(f: &UniPoly) -> UniPoly {
    if f.is_zero() { f.clone() } else { f.div_exact_scalar(&f.content().abs()).expect("the content divides") }
}

/// The polynomial with its roots in the unit disc where those of the given one are in the region.
fn to_disc(coefficients: &[UniPoly], region: &Region) -> Vec<UniPoly> {
    match region {
        Region::Disc(Bound::Number(r)) => {
            mobius(coefficients, [Integer::ZERO, r.numerator(), r.denominator(), Integer::ZERO])
        }
        Region::HalfPlane(Bound::Number(s)) => {
            let (u, v) = (s.numerator(), s.denominator());
            mobius(coefficients, [-(&v + &u), &v - &u, v.clone(), v])
        }
        _ => coefficients.to_vec(),
    }
}

/// The numerator of `p((a + b t)/(c + d t))`.
fn mobius(coefficients: &[UniPoly], [a, b, c, d]: [Integer; 4]) -> Vec<UniPoly> {
    let (mut out, mut power): (Vec<UniPoly>, Vec<Integer>) = (Vec::new(), vec![Integer::ONE]);
    for coefficient in coefficients.iter().rev() {
        let mut next: Vec<UniPoly> = power.iter().map(|w| coefficient.scaled(w)).collect();
        next.resize(next.len().max(out.len() + 1), UniPoly::zero());
        for (i, h) in out.iter().enumerate() {
            next[i] = next[i].plus(&h.scaled(&a));
            next[i + 1] = next[i + 1].plus(&h.scaled(&b));
        }
        out = next;
        out.truncate(power.len());
        let mut larger = vec![Integer::ZERO; power.len() + 1];
        for (i, w) in power.iter().enumerate() {
            larger[i] = &larger[i] + &(w * &c);
            larger[i + 1] = &larger[i + 1] + &(w * &d);
        }
        power = larger;
    }
    out
}

/// An open interval of the parameter, `None` at an end without end.
#[derive(Clone, Copy)]
pub(super) struct Open<'a> {
    pub(super) low: Option<&'a Rational>,
    pub(super) high: Option<&'a Rational>,
}

impl Open<'_> {
    /// Whether the checker takes it: not empty, and not the whole line.
    fn is_proper(self) -> bool {
        match (self.low, self.high) {
            (Some(a), Some(b)) => a < b,
            (None, None) => false,
            _ => true,
        }
    }

    /// The polynomial on the interval, up to a positive factor, as coefficients of one on the ray `t > 0`.
    fn on_ray(self, f: &UniPoly) -> Vec<Integer> {
        let end = |q: Option<&Rational>, infinite: Integer| match q {
            Some(q) => (q.numerator(), q.denominator()),
            None => (infinite, Integer::ZERO),
        };
        let ((a, c), (b, d)) = (end(self.low, -Integer::ONE), end(self.high, Integer::ONE));
        substituted(f.coeffs(), [a, b, c, d])
    }

    /// Positive everywhere inside, and seen to be.
    pub(super) fn is_positive(self, f: &UniPoly) -> bool {
        self.is_proper() && positive_on_ray(FUEL, &self.on_ray(f))
    }

    /// Nowhere positive inside, and seen to be.
    pub(super) fn is_not_positive(self, f: &UniPoly) -> bool {
        self.is_proper() && self.on_ray(f).iter().all(|c| !c.sign().is_gt())
    }
}

fn substituted(f: &[Integer], by: [Integer; 4]) -> Vec<Integer> {
    let constants: Vec<UniPoly> = f.iter().map(|c| UniPoly::constant(c.clone())).collect();
    mobius(&constants, by).iter().map(|c| c.coeff(0)).collect()
}

fn positive_on_ray(fuel: usize, f: &[Integer]) -> bool {
    let used = f.iter().rposition(|c| !c.is_zero()).map_or(0, |i| i + 1);
    let f = &f[..used];
    let (Some(first), Some(last)) = (f.first(), f.last()) else { return false };
    if first.is_negative() || last.is_negative() {
        return false;
    }
    if f.iter().all(|c| !c.is_negative()) {
        return true;
    }
    let number = |k: [i64; 4]| k.map(Integer::from);
    fuel > 0
        && f.iter().fold(Integer::ZERO, |sum, c| &sum + c).sign().is_gt()
        && positive_on_ray(fuel - 1, &substituted(f, number([0, 1, 1, 1])))
        && positive_on_ray(fuel - 1, &substituted(f, number([1, 1, 1, 0])))
}
