//! A characteristic polynomial in any number of parameters, in the form that boxes of parameters are decided by.

use super::tensor::expand;
use crate::{AtPoint, Cause, Shape, count_roots};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Monomial, MultiPoly, Poly, UniPoly};
use std::collections::BTreeMap;

/// Repeated factors of a polynomial of more terms are not looked for.
const MOST_TERMS: usize = 64;

/// Several polynomials in the same parameters, gathered by monomial: exponents with one coefficient for each polynomial.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    /// How many polynomials there are.
    pub width: usize,
    /// The greatest exponent of each parameter.
    pub degrees: Vec<usize>,
    /// By exponents, ascending.
    pub terms: Vec<(Vec<u32>, Vec<Integer>)>,
}

impl Bundle {
    /// Of polynomials in so many parameters.
    pub fn new(polynomials: &[&MultiPoly], parameters: usize) -> Bundle {
        let width = polynomials.len();
        let mut terms: BTreeMap<Vec<u32>, Vec<Integer>> = BTreeMap::new();
        let mut degrees = vec![0; parameters];
        for (k, p) in polynomials.iter().enumerate() {
            for (monomial, c) in p.terms() {
                let mut exponents = monomial.exponents().to_vec();
                exponents.resize(parameters, 0);
                for (degree, &e) in degrees.iter_mut().zip(&exponents) {
                    *degree = (*degree).max(e as usize);
                }
                terms.entry(exponents).or_insert_with(|| vec![Integer::ZERO; width])[k] = c.clone();
            }
        }
        Bundle { width, degrees, terms: terms.into_iter().collect() }
    }

    /// The same monomials with other coefficients, each a combination of those that stand there.
    pub fn combined(&self, width: usize, f: impl Fn(&[Integer]) -> Vec<Integer>) -> Bundle {
        let terms = self.terms.iter().map(|(exponents, c)| (exponents.clone(), f(c))).collect();
        Bundle { width, degrees: self.degrees.clone(), terms }
    }

    /// Of the coefficients `c_0, ..., c_n` in the half plane the polynomials `E_0, ..., E_k, O_0, ..., O_k`.
    pub fn pair(&self) -> Bundle {
        let k = (self.width - 1) / 2;
        self.combined(2 * (k + 1), |c| {
            let part = |odd: usize| {
                (0..=k).map(move |j| {
                    let value = c.get(2 * j + odd).cloned().unwrap_or(Integer::ZERO);
                    if j % 2 == 1 { -value } else { value }
                })
            };
            part(0).chain(part(1)).collect()
        })
    }

    /// The values at a point `a_i / q_i`, all times the product of `q_i^degree_i`.
    pub fn values(&self, a: &[Integer], q: &[Integer]) -> Vec<Integer> {
        let tables: Vec<Vec<Integer>> = self.powers(a, q);
        let mut out = vec![Integer::ZERO; self.width];
        for (exponents, coefficients) in &self.terms {
            let factor = exponents.iter().zip(&tables).fold(Integer::ONE, |f, (&e, table)| &f * &table[e as usize]);
            for (value, c) in out.iter_mut().zip(coefficients) {
                value.add_mul_assign(c, &factor);
            }
        }
        out
    }

    /// `a_i^e q_i^(degree_i - e)` for every exponent.
    fn powers(&self, a: &[Integer], q: &[Integer]) -> Vec<Vec<Integer>> {
        let table =
            |(i, &l): (usize, &usize)| (0..=l).map(|e| &a[i].pow(e as u64) * &q[i].pow((l - e) as u64)).collect();
        self.degrees.iter().enumerate().map(table).collect()
    }

    /// The partial derivatives of the first polynomial at a point `a_i / q_i`, all times the same positive number.
    pub fn gradient(&self, a: &[Integer], q: &[Integer]) -> Vec<Rational> {
        let tables = self.powers(a, q);
        let m = self.degrees.len();
        let mut sums = vec![Integer::ZERO; m];
        for (exponents, c) in self.terms.iter().filter(|(_, c)| !c[0].is_zero()) {
            // Products of all factors before and after each parameter.
            let mut after = vec![Integer::ONE; m + 1];
            for i in (0..m).rev() {
                after[i] = &after[i + 1] * &tables[i][exponents[i] as usize];
            }
            let mut before = c[0].clone();
            for i in 0..m {
                let e = exponents[i] as usize;
                if e > 0 {
                    // d/dp (a/q)^e = e (a/q)^(e-1), and one more q below.
                    let own = &a[i].pow(e as u64 - 1) * &q[i].pow((self.degrees[i] - e) as u64);
                    let factor = &(&own * &Integer::from(e as u64)) * &after[i + 1];
                    sums[i].add_mul_assign(&before, &factor);
                }
                before = &before * &tables[i][e];
            }
        }
        sums.into_iter().zip(q).map(|(s, q)| Rational::from(s * q)).collect()
    }
}

/// A pair of polynomials in the frequency, or its square, that has no common zero where no root is on the boundary.
#[derive(Clone, Debug)]
pub(super) struct Excluded {
    /// The coefficients of the first, then those of the second.
    pub pair: Bundle,
    /// Of the frequency: 2 where the polynomials are in its square.
    pub power: i64,
    /// The last side is that of a number whose sign does not matter to the roots: the pair is excluded for both signs.
    pub mirrored: bool,
}

/// A characteristic polynomial with any number of parameters, brought to the left half plane.
///
/// In discrete time `(1 - s)^n D((1 + s)/(1 - s))` takes the place of `D`: its roots are left of the imaginary axis where those
/// of `D` are in the unit disc, and a lost degree of `D` is a root `s = 1`.
#[derive(Clone, Debug)]
pub struct BoxPolynomial {
    /// In `z` or `s`, denominators cleared.
    original: Poly<MultiPoly>,
    /// What must not vanish in a stable box, each with what happens where it does: divisors of the model, the constant and
    /// the leading coefficient of the polynomial in the half plane.
    pub(super) certain: Vec<(Cause, MultiPoly)>,
    /// The coefficients `c_0, ..., c_n` in the half plane.
    pub(super) coefficients: Bundle,
    pub(super) divisors: usize,
    parameters: usize,
    formal_degree: usize,
    shape: Shape,
    /// What to exclude instead of the pair of the polynomial itself.
    pub(super) instead: Option<Excluded>,
    /// Where none of the certain polynomials vanishes, no pair is on the axis.
    pub(super) by_signs: bool,
}

impl BoxPolynomial {
    /// Of a characteristic polynomial and the region of its roots.
    ///
    /// Cost: clearing denominators, and `O(n^2)` additions of polynomials in the parameters in discrete time.
    pub fn new(d: &CharacteristicPolynomial, shape: Shape) -> Self {
        BoxPolynomial::over(d, d.variables.len(), shape)
    }

    /// The same with so many variables: parameters, and what else occurs in the coefficients.
    ///
    /// Cost: that of [`BoxPolynomial::new`].
    pub fn over(d: &CharacteristicPolynomial, parameters: usize, shape: Shape) -> Self {
        let (original, denominator) = d.cleared();
        let divisors = d.poles.iter().chain([&denominator]);
        BoxPolynomial::of_parts(original, d.formal_degree, divisors, parameters, shape)
    }

    /// Of a polynomial of this degree in `z` or `s`, and of what must not vanish.
    pub fn of_parts<'d>(
        original: Poly<MultiPoly>,
        n: usize,
        undefined: impl IntoIterator<Item = &'d MultiPoly>,
        parameters: usize,
        shape: Shape,
    ) -> Self {
        let mut divisors: Vec<MultiPoly> = Vec::new();
        for p in undefined {
            let p = without_squares(p);
            if !p.is_constant() && !divisors.contains(&p) {
                divisors.push(p);
            }
        }
        let in_half_plane = in_half_plane(&original, n, shape);
        let [at_zero, at_infinity] = match shape {
            Shape::LeftHalfPlane => [Cause::RootAtZero, Cause::DegreeLost],
            Shape::UnitDisc => [Cause::RootAtOne, Cause::RootAtMinusOne],
        };
        let count = divisors.len();
        let mut certain: Vec<(Cause, MultiPoly)> = divisors.into_iter().map(|p| (Cause::Pole, p)).collect();
        certain.push((at_zero, without_squares(&in_half_plane[0])));
        certain.push((at_infinity, without_squares(&in_half_plane[n])));
        let coefficients = Bundle::new(&in_half_plane.iter().collect::<Vec<_>>(), parameters);
        let (formal_degree, divisors) = (n, count);
        let instead = None;
        BoxPolynomial {
            original,
            certain,
            coefficients,
            divisors,
            parameters,
            formal_degree,
            shape,
            instead,
            by_signs: false,
        }
    }

    /// What a proof excludes.
    pub(super) fn excluded(&self) -> Excluded {
        self.instead.clone().unwrap_or_else(|| Excluded { pair: self.pair(), power: 2, mirrored: false })
    }

    /// The number of parameters.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// The degree the polynomial is meant to have.
    pub fn formal_degree(&self) -> usize {
        self.formal_degree
    }

    /// The coefficients `c_0, ..., c_n` of the polynomial in the half plane, in the parameters.
    pub fn in_half_plane(&self) -> Vec<MultiPoly> {
        let part = |k: usize| {
            let terms = self.coefficients.terms.iter().filter(|(_, c)| !c[k].is_zero());
            MultiPoly::from_terms(terms.map(|(exponents, c)| (exponents.clone(), c[k].clone())))
        };
        (0..=self.formal_degree).map(part).collect()
    }

    /// The coefficients of `1, z, ..., z^n` or `1, s, ..., s^n`, denominators cleared, in the parameters.
    pub fn coefficients_in_region(&self) -> Vec<MultiPoly> {
        (0..=self.formal_degree).map(|i| self.original.coeff(i)).collect()
    }

    /// What must not vanish in a stable box, each with what happens where it does, in the order of the trees of a proof.
    pub fn certain(&self) -> &[(Cause, MultiPoly)] {
        &self.certain
    }

    /// The exact root count at a point.
    ///
    /// Cost: the values of the coefficients, and one [`count_roots`].
    pub fn at(&self, point: &[Rational]) -> AtPoint {
        let value = |p: &MultiPoly| p.eval(point);
        if self.certain[..self.divisors].iter().any(|(_, p)| value(p).is_zero()) {
            return AtPoint::Undefined;
        }
        let special = UniPoly::from_rational_poly(&self.original.map(value)).1;
        if special.is_zero() {
            return AtPoint::Zero;
        }
        let count = count_roots(&special, self.shape);
        AtPoint::Defined { count, infinite: self.formal_degree - count.total() }
    }

    /// Whether the loop is stable at a point: defined, of full degree, all roots inside.
    pub fn is_stable_at(&self, point: &[Rational]) -> bool {
        self.at(point).is_stable(self.formal_degree)
    }

    /// Whether it is seen from signs that no point of a closed box is stable: the coefficients in the half plane of a stable polynomial have one sign.
    ///
    /// Where roots coincide at the boundary of the region, counts of roots tell in small boxes only, and signs in wide ones.
    ///
    /// Cost: the Bernstein coefficients of all coefficients.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// use jurist_algebra::poly::{Domain, MultiPoly, Poly};
    /// use jurist_stability::Shape;
    /// use jurist_stability::boxes::BoxPolynomial;
    /// // s^2 + (a - 3) s + b
    /// let [a, b] = [0, 1].map(MultiPoly::variable);
    /// let p = Poly::new(vec![b, a.minus(&MultiPoly::constant(3.into())), MultiPoly::one()]);
    /// let p = BoxPolynomial::of_parts(p, 2, [], 2, Shape::LeftHalfPlane);
    /// let side = |low: i64, high: i64| [low, high].map(Rational::from);
    /// assert!(p.is_unstable_by_signs(&[side(0, 2), side(-9, 9)]));
    /// assert!(!p.is_unstable_by_signs(&[side(0, 4), side(-9, 9)]));
    /// ```
    pub fn is_unstable_by_signs(&self, sides: &[[Rational; 2]]) -> bool {
        let all = expand(&self.coefficients, sides);
        let (mut is_positive, mut is_negative) = (false, false);
        for k in 0..self.coefficients.width {
            let mut of_one = all.iter().skip(k).step_by(self.coefficients.width);
            is_positive |= of_one.clone().all(|c| c.sign().is_gt());
            is_negative |= of_one.all(Integer::is_negative);
        }
        is_positive && is_negative
    }

    /// `E_0, ..., E_k, O_0, ..., O_k` with `P(i w) = E(w^2) + i w O(w^2)`.
    pub(super) fn pair(&self) -> Bundle {
        self.coefficients.pair()
    }
}

/// The coefficients of a polynomial of this degree, brought to the half plane.
pub(super) fn in_half_plane(p: &Poly<MultiPoly>, n: usize, shape: Shape) -> Vec<MultiPoly> {
    match shape {
        Shape::LeftHalfPlane => (0..=n).map(|i| p.coeff(i)).collect(),
        Shape::UnitDisc => to_half_plane(p, n),
    }
}

/// A polynomial with the same zeros that, where it has only simple factors, changes its sign there; of many terms only where
/// these have a common factor.
pub(super) fn without_squares(p: &MultiPoly) -> MultiPoly {
    let p = p.primitive_over_integers();
    let is_linear = p.degrees().iter().all(|&degree| degree <= 1);
    if is_linear || p.is_zero() {
        return p;
    }
    let content = p.monomial_content();
    if p.terms().len() > MOST_TERMS {
        let once: Vec<u32> = content.exponents().iter().map(|&e| e.saturating_sub(1)).collect();
        return p.div_exact_monomial(&Monomial::new(&once)).unwrap_or(p);
    }
    p.square_free_part().primitive_over_integers()
}

/// The coefficients of `(1 - s)^n D((1 + s)/(1 - s))`.
fn to_half_plane(d: &Poly<MultiPoly>, n: usize) -> Vec<MultiPoly> {
    let mut out = vec![MultiPoly::zero(); n + 1];
    for (i, c) in d.coeffs().iter().enumerate() {
        // (1 + s)^i (1 - s)^(n - i)
        let mut factor = UniPoly::one();
        for k in 0..n {
            factor = &factor * &UniPoly::from_i64(if k < i { &[1, 1] } else { &[1, -1] });
        }
        for (target, a) in out.iter_mut().zip(factor.coeffs()) {
            if !a.is_zero() {
                *target = target.plus(&c.scaled_by(a));
            }
        }
    }
    out
}
