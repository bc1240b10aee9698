//! What requirements ask of an open loop along the circle.

use super::affine::{AlongCircle, Patch};
use super::along_circle::{Along, Coefficient, NearlyLinear, OnPiece};
use super::asked_functions::{Function, Products, sum_of};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};

/// The open loop as polynomials in `w = z - 1`.
pub(super) struct OnCircle<C> {
    denominator: Vec<C>,
    /// The numerator without its content.
    bare: Vec<C>,
    numerator: Vec<C>,
}

impl<C: Coefficient> OnCircle<C> {
    /// Of the coefficients of the denominator, and of the numerator without a factor, which comes with it.
    pub fn new(denominator: Vec<C>, bare: Vec<C>, factor: &C) -> OnCircle<C> {
        let numerator = bare.iter().map(|x| x.times(factor)).collect();
        OnCircle { denominator, bare, numerator }
    }

    /// Polynomials in `y`. Sums of patches are taken term by term: all have as many coefficients.
    pub fn along(functions: Vec<Function<C, 1>>) -> Vec<AlongCircle>
    where
        C: NearlyLinear,
    {
        let length = functions.iter().map(|[p]| p.len()).max().unwrap_or(0);
        functions.into_iter().map(|[p]| AlongCircle::new(p, length)).collect()
    }
}

impl<C: Coefficient> Products<C, 1> for OnCircle<C> {
    fn moduli(&self) -> [Function<C, 1>; 2] {
        [&self.denominator, &self.numerator].map(|p| [twice_real(p, p)])
    }

    fn twice_real(&self) -> Function<C, 1> {
        [twice_real(&self.numerator, &self.denominator)]
    }

    fn imaginary(&self) -> Function<C, 1> {
        [imaginary(&self.bare, &self.denominator)]
    }

    fn combined(&self, u: &Integer, v: &Integer) -> Function<C, 1> {
        let scaled = |p: &[C], c: &Integer| -> Vec<C> {
            if *c == Integer::ONE { p.to_vec() } else { p.iter().map(|x| x.scaled(c)).collect() }
        };
        let (d, n) = (scaled(&self.denominator, u), scaled(&self.numerator, v));
        let all = match (u.is_zero(), v.is_zero()) {
            (_, true) => d,
            (true, _) => n,
            _ => sum_of(&d, &n),
        };
        [twice_real(&all, &all)]
    }

    fn has_integrator(&self) -> bool {
        self.denominator.first().is_some_and(C::is_zero)
    }
}

impl Along for AlongCircle {
    type Piece = Patch;

    fn pieces() -> Vec<[Rational; 2]> {
        vec![[Rational::ZERO, Rational::from(4)]]
    }

    fn on(&self, ends: [&Rational; 2]) -> Patch {
        AlongCircle::on(self, ends)
    }
}

impl OnPiece for Patch {
    fn patch(&self) -> &Patch {
        self
    }

    fn first(&self) -> Patch {
        Patch::first(self)
    }

    fn is_blurred(&self) -> bool {
        Patch::is_blurred(self)
    }
}

/// Twice the real part of `p` times the conjugate of `q` on the circle, both given by their coefficients in `w = z - 1`, as a polynomial
/// in `y`: as `w` and its conjugate have the sum `-y` and the product `y`, the sums of their powers follow from one another.
pub(super) fn twice_real<C: Coefficient>(p: &[C], q: &[C]) -> Vec<C> {
    paired(p, q, [Integer::from(2), Integer::ZERO], [Integer::ZERO, -Integer::ONE], false)
}

/// The imaginary part divided by that of `w`.
fn imaginary<C: Coefficient>(p: &[C], q: &[C]) -> Vec<C> {
    paired(p, q, [Integer::ZERO, Integer::ZERO], [Integer::ONE, Integer::ZERO], true)
}

/// The sum of `p_i q_j y^min(i, j) s_|i - j|`, where `s_0` and `s_1` are linear in `y` and `s_k = -y (s_(k-1) + s_(k-2))`; with the other sign
/// for `i < j` if asked for.
fn paired<C: Coefficient>(p: &[C], q: &[C], zeroth: [Integer; 2], first: [Integer; 2], is_odd: bool) -> Vec<C> {
    let most = p.len().max(q.len());
    let mut sums = vec![UniPoly::new(zeroth.to_vec()), UniPoly::new(first.to_vec())];
    let minus_y = UniPoly::new(vec![Integer::ZERO, -Integer::ONE]);
    for k in 2..most {
        let next = minus_y.times(&sums[k - 1].plus(&sums[k - 2]));
        sums.push(next);
    }
    let mut out = vec![p[0].scaled(&Integer::ZERO); 2 * most];
    // Of a square both products of two different coefficients are the same.
    let is_square = std::ptr::eq(p, q) && !is_odd;
    for (i, x) in p.iter().enumerate() {
        for (j, y) in q.iter().enumerate().filter(|(j, _)| !is_square || *j <= i) {
            let product = x.times(y);
            let product = if is_square && j < i { product.scaled(&Integer::from(2)) } else { product };
            for (k, c) in sums[i.abs_diff(j)].coeffs().iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                let c = if is_odd && i < j { -c.clone() } else { c.clone() };
                let at = i.min(j) + k;
                out[at] = out[at].plus(&product.scaled(&c));
            }
        }
    }
    while out.len() > 1 && out.last().is_some_and(C::is_zero) {
        out.pop();
    }
    out
}
