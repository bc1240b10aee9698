//! Polynomials whose coefficients are Taylor models, brought to where a requirement looks at them: to a ray, to the circle, to a region that is wider.

use super::affine::Affine;
use super::along_circle::{Coefficient, NearlyLinear};
use jurist_algebra::ball::{Elementary, Enclosed, MultiTaylorModel};
use jurist_algebra::number::{Integer, Rational};

/// The square of the modulus on the ray with an angle of this negative cosine, `s = c t exp(j phi)`, as a polynomial in `y` with
/// `t = y/(4 - y)`, times a power of `4 - y`.
pub(super) fn on_ray(p: &[MultiTaylorModel], cosine: &Rational, octave: i64) -> Vec<MultiTaylorModel> {
    let n = p.len() - 1;
    let scaled = of_octave(p, octave, n);
    // q^m cos(m phi), of cos phi = -p/q.
    let (top, bottom) = (-cosine.numerator(), cosine.denominator());
    let mut cosines = vec![Integer::ONE, top.clone()];
    for m in 2..=n {
        let next = &(&(&top * &cosines[m - 1]) << 1) - &(&(&bottom * &bottom) * &cosines[m - 2]);
        cosines.push(next);
    }
    let mut in_t = vec![p[0].nothing(); 2 * n + 1];
    for (i, x) in scaled.iter().enumerate() {
        for (j, y) in scaled.iter().enumerate() {
            let m = i.abs_diff(j);
            let weight = &cosines[m] * &bottom.pow((n - m) as u64);
            in_t[i + j] = in_t[i + j].add(&x.mul(y).scaled(&weight));
        }
    }
    // t^k (4 - y)^(2n) = y^k (4 - y)^(2n - k)
    let degree = 2 * n;
    combined_to(&in_t, degree + 1, |j, k| match j.checked_sub(k) {
        Some(i) if i <= degree - k => {
            let size = binomial(degree - k, i) << (2 * (degree - k - i)) as u64;
            if i % 2 == 0 { size } else { -size }
        }
        _ => Integer::ZERO,
    })
}

/// The coefficients of `p(c s)` with the frequency `c`, a power of two; where it is small, times `c^-degree`.
pub(super) fn of_octave<C: Coefficient>(p: &[C], octave: i64, degree: usize) -> Vec<C> {
    let power = |k: usize| match octave >= 0 {
        true => octave as u64 * k as u64,
        false => octave.unsigned_abs() * (degree - k) as u64,
    };
    p.iter().enumerate().map(|(k, c)| c.scaled(&(Integer::ONE << power(k)))).collect()
}

/// Of `p` in `w = z - 1` the polynomial `p` at `(1 + h) z`, with `h` that many times half of 1, times a power of two.
pub(super) fn on_wider_disc(p: &[MultiTaylorModel], halvings: u64) -> Vec<MultiTaylorModel> {
    // (1 + h)(1 + w) - 1 = ((2^e + 1) w + 1)/2^e
    let (n, slope) = (p.len() - 1, (Integer::ONE << halvings) + Integer::ONE);
    combined(p, |j, k| &(&binomial(k, j) * &slope.pow(j as u64)) << (halvings * (n - k) as u64))
}

/// The polynomial `p(s + h)`, with `h` that many times half of 1, times a power of two.
pub(super) fn beyond_axis(p: &[MultiTaylorModel], halvings: u64) -> Vec<MultiTaylorModel> {
    let n = p.len() - 1;
    combined(p, |j, k| match k.checked_sub(j) {
        Some(i) => binomial(k, j) << (halvings * (n - i) as u64),
        None => Integer::ZERO,
    })
}

/// Of `p` in `w = z - 1` the polynomial `(1 - s)^n p` at `w = 2 s/(1 - s)`, whose roots are in the left half plane where those of `p` are in the disc.
pub(super) fn to_half_plane(p: &[MultiTaylorModel]) -> Vec<MultiTaylorModel> {
    let n = p.len() - 1;
    // (2 s)^k (1 - s)^(n - k)
    combined(p, |j, k| match j.checked_sub(k) {
        Some(i) if i <= n - k => {
            let size = binomial(n - k, i) << k as u64;
            if i % 2 == 0 { size } else { -size }
        }
        _ => Integer::ZERO,
    })
}

/// Sums of multiples, as many as there are terms.
pub(super) fn combined(p: &[MultiTaylorModel], share: impl Fn(usize, usize) -> Integer) -> Vec<MultiTaylorModel> {
    combined_to(p, p.len(), share)
}

/// Sums of multiples: the first argument of `share` is the number of the sum, the second one that of the term.
pub(super) fn combined_to(
    p: &[MultiTaylorModel],
    count: usize,
    share: impl Fn(usize, usize) -> Integer,
) -> Vec<MultiTaylorModel> {
    let one = |j: usize| {
        p.iter().enumerate().fold(p[0].nothing(), |sum, (k, c)| {
            let by = share(j, k);
            if by.is_zero() { sum } else { sum.add(&c.scaled(&by)) }
        })
    };
    (0..count).map(one).collect()
}

/// The number of ways to choose `k` of `n`.
pub(super) fn binomial(n: usize, k: usize) -> Integer {
    if k > n {
        return Integer::ZERO;
    }
    (0..k).fold(Integer::ONE, |product, i| {
        (&product * &Integer::from((n - i) as u64)).div_mod_floor(&Integer::from(i as u64 + 1)).0
    })
}

impl Coefficient for MultiTaylorModel {
    fn plus(&self, other: &Self) -> Self {
        self.add(other)
    }

    /// A product is rounded, but for that with zero.
    fn times(&self, other: &Self) -> Self {
        if self.is_nothing() || other.is_nothing() { self.nothing() } else { self.mul(other) }
    }

    fn scaled(&self, n: &Integer) -> Self {
        MultiTaylorModel::scaled(self, n)
    }

    fn is_zero(&self) -> bool {
        self.is_nothing()
    }
}

impl NearlyLinear for MultiTaylorModel {
    fn affine(&self) -> Affine {
        let mut terms = self.terms();
        let middle = terms.next().map(|(_, c)| c.clone()).unwrap_or(Integer::ZERO);
        let mut affine = Affine { middle, slopes: Vec::new(), rest: self.rest_units().clone(), bits: self.bits() };
        for (exponents, c) in terms {
            match exponents.iter().sum::<u32>() {
                1 => affine.slopes.push(c.clone()),
                _ => affine.rest += &c.abs(),
            }
        }
        affine
    }
}
