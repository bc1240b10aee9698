//! The characteristic function of a loop with dead time: a polynomial in `s` and `z = exp(-tau s)`.

use crate::{Shape, is_stable};
use jurist_algebra::poly::{Domain, UniPoly};

/// `P_0(s) + P_1(s) z + ... + P_q(s) z^q` with `z = exp(-tau s)`, over the integers.
///
/// `P_0` and `P_q` are not zero: a power of `z` has no zeros and is divided out. Common factors of all `P_k` stay, they
/// are modes of the loop that no dead time touches.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::dead_time::{Kind, QuasiPolynomial};
/// // s + 1 + 2 z
/// let p = QuasiPolynomial::new(vec![UniPoly::from_i64(&[1, 1]), UniPoly::from_i64(&[2])]).unwrap();
/// assert_eq!((p.order(), p.delays(), p.kind()), (1, 1, Kind::Retarded));
/// assert_eq!(p.without_delay(), UniPoly::from_i64(&[3, 1]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct QuasiPolynomial {
    parts: Vec<UniPoly>,
}

/// How the highest power of `s` is delayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Only the part without delay has the highest power: finitely many roots lie right of any line.
    Retarded,
    /// A delayed part has the highest power, too: chains of roots approach vertical lines.
    Neutral,
    /// The part without delay lacks the highest power: for any dead time infinitely many roots lie far to the right.
    Advanced,
}

impl QuasiPolynomial {
    /// The function of the parts `P_0, P_1, ...`; `None` when all are zero.
    pub fn new(mut parts: Vec<UniPoly>) -> Option<QuasiPolynomial> {
        while parts.last().is_some_and(UniPoly::is_zero) {
            parts.pop();
        }
        let first = parts.iter().position(|p| !p.is_zero())?;
        parts.drain(..first);
        let content = parts.iter().flat_map(|p| p.coeffs()).fold(None, |g: Option<_>, c| match g {
            None => Some(c.abs()),
            Some(g) => Some(g.gcd(c)),
        });
        if let Some(content) = content.filter(|c| !c.is_zero() && !c.is_one()) {
            parts = parts.iter().map(|p| p.div_exact_scalar(&content).expect("the content divides")).collect();
        }
        Some(QuasiPolynomial { parts })
    }

    /// The parts `P_0, ..., P_q`.
    pub fn parts(&self) -> &[UniPoly] {
        &self.parts
    }

    /// `q`, the greatest number of delays; 0 for a polynomial.
    pub fn delays(&self) -> usize {
        self.parts.len() - 1
    }

    /// The highest power of `s`.
    pub fn order(&self) -> usize {
        self.parts.iter().filter_map(UniPoly::degree).max().unwrap_or(0)
    }

    /// How the highest power of `s` is delayed.
    pub fn kind(&self) -> Kind {
        let top = self.difference();
        match (top.degree(), top.coeff(0).is_zero()) {
            (_, true) => Kind::Advanced,
            (Some(0), false) => Kind::Retarded,
            _ => Kind::Neutral,
        }
    }

    /// The coefficients of the highest power of `s`, a polynomial in `z`: the difference operator.
    pub fn difference(&self) -> UniPoly {
        let n = self.order();
        UniPoly::new(self.parts.iter().map(|p| p.coeff(n)).collect())
    }

    /// Whether all zeros of the [difference operator](QuasiPolynomial::difference) lie outside of the closed unit disc.
    ///
    /// Without that no dead time lets the loop be exponentially stable: a chain of infinitely many roots lies to the right
    /// of the imaginary axis, or approaches it.
    pub fn has_stable_difference(&self) -> bool {
        let top = self.difference();
        let Some(q) = top.degree().filter(|_| !top.coeff(0).is_zero()) else { return false };
        is_stable(&top.reversed(q), Shape::UnitDisc)
    }

    /// Whether the coefficient without delay outweighs the sum of the others in the difference operator.
    pub(super) fn is_dominated(&self) -> bool {
        let top = self.difference();
        let rest = top.coeffs().iter().skip(1).fold(jurist_algebra::number::Integer::ZERO, |sum, c| sum + c.abs());
        rest < top.coeff(0).abs()
    }

    /// The polynomial that is left for `tau = 0`.
    pub fn without_delay(&self) -> UniPoly {
        self.at_sign(false)
    }

    /// The polynomial for `z = 1`, or for `z = -1`.
    pub(super) fn at_sign(&self, minus: bool) -> UniPoly {
        self.parts
            .iter()
            .enumerate()
            .fold(UniPoly::zero(), |sum, (k, p)| if minus && k % 2 == 1 { sum.minus(p) } else { sum.plus(p) })
    }

    /// The common factor of all parts: roots that do not depend on the dead time.
    pub fn content(&self) -> UniPoly {
        self.parts.iter().fold(UniPoly::zero(), |g, p| g.gcd(p))
    }

    /// The same without its [content](QuasiPolynomial::content).
    pub fn primitive(&self) -> QuasiPolynomial {
        let content = self.content();
        let divide = |p: &UniPoly| p.div_exact(&content).expect("the content divides");
        QuasiPolynomial { parts: self.parts.iter().map(divide).collect() }
    }

    /// `sum P_k(s) (1 - x)^k (1 + x)^(q - k)` at `x = s S`: the coefficient of each power of `S`, a polynomial in `s`.
    ///
    /// On the imaginary axis `z = (1 - s S)/(1 + s S)` runs through the unit circle while `S` runs through the real line
    /// ([Rekasius1980](jurist_algebra::bibliography#rekasius1980)).
    pub(super) fn on_circle(&self) -> Vec<UniPoly> {
        rekasius(&self.parts, self.delays())
    }
}

/// [`QuasiPolynomial::on_circle`] of any parts, read with the degree `q` in `z`.
pub(super) fn rekasius(parts: &[UniPoly], q: usize) -> Vec<UniPoly> {
    let (down, up) = (UniPoly::from_i64(&[1, -1]), UniPoly::from_i64(&[1, 1]));
    let mut out = vec![UniPoly::zero(); q + 1];
    for (k, p) in parts.iter().enumerate() {
        let weights = down.power(k as u64).times(&up.power((q - k) as u64));
        for (j, c) in weights.coeffs().iter().enumerate() {
            out[j] = out[j].plus(&p.scaled(c).shifted_up(j));
        }
    }
    out
}

/// `E`, `O` with `p(s) = E(s^2) + s O(s^2)`.
pub(super) fn even_odd(p: &UniPoly) -> (UniPoly, UniPoly) {
    let part = |from: usize| UniPoly::new(p.coeffs().iter().skip(from).step_by(2).cloned().collect());
    (part(0), part(1))
}
