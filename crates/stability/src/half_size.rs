//! The half-size pair: a polynomial's behaviour on the boundary of the stability region, written
//! as two polynomials of half its degree in one real variable.

use super::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, Poly, resultant_formal};

/// Two polynomials `A`, `B` in a real variable `x` that describe `D` on the region's boundary.
///
/// **Unit disc.** With `D#(z) = z^n D(1/z)` and `x = z + 1/z`, which maps the upper half of the unit
/// circle onto `(-2, 2)`:
///
/// * `n = 2k`: `A = z^-k (D + D#)`, `B = z^-(k-1) (D - D#) / (z^2 - 1)`, of formal degrees `k`, `k - 1`;
/// * `n = 2k + 1`: `A = z^-k (D + D#) / (z + 1)`, `B = z^-k (D - D#) / (z - 1)`, of formal degrees `k`, `k`.
///
/// **Left half plane.** With `D(s) = A(s^2) + s B(s^2)` and `x = s^2`, which maps the upper half of
/// the imaginary axis onto `(-inf, 0)`; formal degrees `k`, `k - 1` for `n = 2k` and `k`, `k` for `n = 2k + 1`.
///
/// Common roots of `A` and `B` correspond to pairs of roots of `D` that are mirror images of each
/// other in the boundary: `z_i z_j = 1`, or `s_i + s_j = 0`. The resultant for the formal degrees is,
/// up to a constant, the critical constraint of Jury and Pavlidis
/// `d_n^(n-1) prod_(i<j) (1 - z_i z_j)` ([JuryPavlidis1963](jurist_algebra::bibliography#jurypavlidis1963), [Bistritz2006](jurist_algebra::bibliography#bistritz2006)), or Orlando's
/// `d_n^(n-1) prod_(i<j) (s_i + s_j)` ([Orlando1911](jurist_algebra::bibliography#orlando1911)).
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::{HalfSizePair, Shape};
/// let pair = HalfSizePair::new(&UniPoly::from_i64(&[1, 0, 2]), 2, Shape::UnitDisc); // 2 z^2 + 1
/// assert_eq!((&pair.a, &pair.b), (&UniPoly::from_i64(&[0, 3]), &UniPoly::from_i64(&[1])));
/// let mirrored = UniPoly::from_i64(&[2, -5, 2]); // the roots 2 and 1/2
/// let pair = HalfSizePair::new(&mirrored, 2, Shape::UnitDisc);
/// assert!(pair.critical_constraint(&Budget::unlimited()).unwrap().is_zero());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct HalfSizePair<R: Domain> {
    /// The first polynomial.
    pub a: Poly<R>,
    /// The second polynomial.
    pub b: Poly<R>,
    /// Formal degree of `a`.
    pub degree_a: usize,
    /// Formal degree of `b`.
    pub degree_b: usize,
    /// Which of the two substitutions was made.
    pub region: Shape,
}

impl<R: Domain> HalfSizePair<R> {
    /// The pair of `d`, read with formal degree `n`.
    ///
    /// Cost: `O(n^2)` additions on the unit disc, none on the left half plane.
    ///
    /// # Panics
    /// When `n` is 0 or below the degree of `d`.
    pub fn new(d: &Poly<R>, n: usize, region: Shape) -> Self {
        assert!(n > 0 && d.coeffs().len() <= n + 1, "the formal degree is positive and not below the degree");
        let k = n / 2;
        let degree_a = k;
        let degree_b = if n.is_multiple_of(2) { k - 1 } else { k };
        let (a, b) = match region {
            Shape::LeftHalfPlane => split_even_odd(d),
            Shape::UnitDisc => unit_disc_pair(d, n),
        };
        HalfSizePair { a, b, degree_a, degree_b, region }
    }

    /// The resultant of the pair for its formal degrees: the critical constraint up to a non-zero
    /// integer factor. It vanishes exactly when two roots are mirror images in the boundary or
    /// when degree is lost.
    ///
    /// Its values are those of [JuryPavlidis1963](jurist_algebra::bibliography#jurypavlidis1963) and
    /// [Orlando1911](jurist_algebra::bibliography#orlando1911); it is a determinant of size `n - 1`.
    ///
    /// Cost: over `Z[p]` with coefficients of degree `d`, remainder sequences of `O(n^2)` products of residues at
    /// up to `(n - 1) d + 1` points, modulo as many primes of word size as a bound of the coefficients asks for,
    /// and interpolation, or at low order a determinant expanded by minors; over a domain where
    /// [`Domain::resultant_fast`] knows no such way, one sequence of subresultants: `O(n^2)` operations.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn critical_constraint(&self, budget: &Budget) -> Result<R, Exhausted> {
        resultant_formal(&self.a, self.degree_a, &self.b, self.degree_b, budget)
    }
}

/// `E`, `O` with `d(s) = E(s^2) + s O(s^2)`.
fn split_even_odd<R: Domain>(d: &Poly<R>) -> (Poly<R>, Poly<R>) {
    let part = |from: usize| Poly::new(d.coeffs().iter().skip(from).step_by(2).cloned().collect());
    (part(0), part(1))
}

fn unit_disc_pair<R: Domain>(d: &Poly<R>, n: usize) -> (Poly<R>, Poly<R>) {
    let k = n / 2;
    let zero = R::zero();
    let c = |i: usize| d.coeffs().get(i).unwrap_or(&zero);
    // Symmetric polynomials are given by their upper half: the coefficients from the middle one up.
    let sum = |i: usize| c(i).plus(c(n - i));
    let difference = |i: usize| c(i).minus(c(n - i));
    let upper = k + 1..=n;
    if n.is_multiple_of(2) {
        let mut a: Vec<R> = vec![sum(k)];
        a.extend(upper.clone().map(sum));
        (in_x(a), in_x(divide_by_binomial(upper.map(difference).collect(), 2, true)))
    } else {
        let a = divide_by_binomial(upper.clone().map(sum).collect(), 1, false);
        (in_x(a), in_x(divide_by_binomial(upper.map(difference).collect(), 1, true)))
    }
}

/// The upper half of the quotient by `z^step - 1` (`minus`) or `z^step + 1`, known to be exact, from the
/// upper part of the dividend.
fn divide_by_binomial<R: Domain>(mut p: Vec<R>, step: usize, minus: bool) -> Vec<R> {
    for i in (step..p.len()).rev() {
        p[i - step] = if minus { p[i - step].plus(&p[i]) } else { p[i - step].minus(&p[i]) };
    }
    p
}

/// A symmetric polynomial of even formal degree `2m` as a polynomial in `x = z + 1/z`, from its
/// coefficients `c_m, ..., c_2m`: the sum of `c_m` and all `c_(m+j) V_j` with `V_j(x) = z^j + z^-j`.
fn in_x<R: Domain>(mut c: Vec<R>) -> Poly<R> {
    let last = c.len();
    // V_j = S_j - S_(j-2), where x S_j = S_(j+1) + S_(j-1), S_0 = 1, S_1 = x.
    for j in 2..last {
        c[j - 2] = c[j - 2].minus(&c[j]);
    }
    // The constant is split off and x taken out of the rest, again and again.
    for low in 2..last {
        for j in (low..last).rev() {
            c[j - 2] = c[j - 2].minus(&c[j]);
        }
    }
    Poly::new(c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::Integer;
    use jurist_algebra::poly::UniPoly;

    #[test]
    fn order_six_by_hand() {
        let d = UniPoly::from_i64(&[3, -5, 7, 11, -13, 17, 19]);
        let pair = HalfSizePair::new(&d, 6, Shape::UnitDisc);
        assert_eq!(pair.a, UniPoly::from_i64(&[2 * (11 + 5 - 17), 7 - 13 - 9 - 57, -5 + 17, 3 + 19]));
        assert_eq!(pair.b, UniPoly::from_i64(&[3 - 7 - 13 - 19, 17 + 5, 19 - 3]));
    }

    #[test]
    fn square_of_the_modulus_on_the_circle() {
        // 4 D(z) D(1/z) = A^2 + (4 - x^2) B^2 for even n, (2 + x) A^2 + (2 - x) B^2 for odd n.
        for coeffs in [&[3i64, -5, 7, 11, -13][..], &[1, 2, -3, 4], &[5, 7], &[2, -9, 4]] {
            let d = UniPoly::from_i64(coeffs);
            let n = coeffs.len() - 1;
            let pair = HalfSizePair::new(&d, n, Shape::UnitDisc);
            let product = &d * &d.reversed(n);
            let left = in_x(product.coeffs()[n..].to_vec()).scaled(&Integer::from(4));
            let (p, q): (&[i64], &[i64]) = if n % 2 == 0 { (&[1], &[4, 0, -1]) } else { (&[2, 1], &[2, -1]) };
            let right =
                &(&UniPoly::from_i64(p) * &(&pair.a * &pair.a)) + &(&UniPoly::from_i64(q) * &(&pair.b * &pair.b));
            assert_eq!(left, right, "{coeffs:?}");
        }
    }

    #[test]
    fn resultant_is_the_critical_constraint_of_chosen_roots() {
        // Res(A, B) = +-2^floor((n-1)/2) d_n^(n-1) prod (1 - z_i z_j), with z_i = p_i / q_i cleared.
        let roots = [(1i64, 2i64), (-2, 3), (3, 5), (5, 2), (-1, 7)];
        for n in 1..=roots.len() {
            let mut d = UniPoly::one();
            let mut expected = Integer::ONE;
            for (i, &(p, q)) in roots[..n].iter().enumerate() {
                d = &d * &UniPoly::from_i64(&[-p, q]);
                for &(r, s) in &roots[..i] {
                    expected *= Integer::from(q * s - p * r);
                }
            }
            expected *= Integer::from(1i64 << ((n - 1) / 2));
            let got = HalfSizePair::new(&d, n, Shape::UnitDisc).critical_constraint(&Budget::unlimited()).unwrap();
            assert_eq!(got.abs(), expected.abs(), "n = {n}");
        }
    }
}
