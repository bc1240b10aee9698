//! The sector of at least a damping in the left half plane, `cos` of the angle with the negative real axis: its polynomials.

use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly};

/// `P(a s) P(b s)` with `a, b = c (c +- j damping)`, `c^2 = 1 - damping^2`, times powers of the denominator: all its roots are in the
/// left half plane just when those of `P` are in the sector of at least this damping.
pub fn in_sector<R: Domain>(p: &Poly<R>, damping: &Rational) -> Poly<R> {
    let n = p.coeffs().len().saturating_sub(1);
    let square = Rational::ONE - damping * damping;
    // t_k = a^k + b^k, and a b = c^2.
    let mut sums = vec![Rational::from(2), &square + &square];
    for k in 2..=n {
        let next = &(&square + &square) * &sums[k - 1] - &square * &sums[k - 2];
        sums.push(next);
    }
    let mut powers = vec![Rational::ONE];
    for k in 1..=n {
        let next = &powers[k - 1] * &square;
        powers.push(next);
    }
    // Twice the product, cleared of denominators.
    let weight = |i: usize, j: usize| &powers[i.min(j)] * &sums[i.abs_diff(j)];
    let mut clear = Integer::ONE;
    for i in 0..=n {
        for j in 0..=n {
            clear = clear.lcm(&weight(i, j).denominator());
        }
    }
    let mut out = vec![R::zero(); 2 * n + 1];
    for i in 0..=n {
        for j in 0..=n {
            let w = weight(i, j) * Rational::from(&clear);
            out[i + j] = out[i + j].plus(&p.coeff(i).times(&p.coeff(j)).times(&R::from_integer(&w.numerator())));
        }
    }
    Poly::new(out)
}

/// Polynomials in `rho`, up to factors, whose common zeros are the roots `s = rho exp(j psi)`, `cos psi = -damping`: those on the
/// sector's edge for `rho > 0`. They are the imaginary parts of `P` and of `P exp(-j psi)`, over `sin psi`, the first over `rho` too.
pub fn on_sector_edge<R: Domain>(p: &Poly<R>, damping: &Rational) -> [Poly<R>; 2] {
    on_edge_of(p, [&R::from_integer(&damping.numerator()), &R::from_integer(&damping.denominator())])
}

/// The same with a damping of the coefficients' ring: its numerator and its denominator.
pub fn on_edge_of<R: Domain>(p: &Poly<R>, [above, below]: [&R; 2]) -> [Poly<R>; 2] {
    let n = p.coeffs().len().saturating_sub(1);
    let twice_cosine = above.plus(above).negated();
    // u_k = sin(k psi)/sin psi, times the (k - 1)-th power of the denominator.
    let mut sines = vec![R::zero(), R::one()];
    let mut powers = vec![R::one()];
    for k in 2..=n {
        let before = sines[k - 2].times(&below.times(below));
        sines.push(twice_cosine.times(&sines[k - 1]).minus(&before));
    }
    for k in 1..=n + 1 {
        powers.push(powers[k - 1].times(below));
    }
    let weight = |k: usize| sines[k].times(&powers[n - k]);
    let first = (1..=n).map(|k| p.coeff(k).times(&weight(k))).collect();
    let before = |k: usize| if k == 0 { powers[n].negated() } else { sines[k - 1].times(&powers[n + 2 - k]) };
    let second = (0..=n).map(|k| p.coeff(k).times(&before(k))).collect();
    [Poly::new(first), Poly::new(second)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, count_roots};
    use jurist_algebra::poly::UniPoly;

    #[test]
    fn the_sector_of_a_damped_pair() {
        // s^2 + 2 d s + 1 with d = 3/5 is on the edge of damping 3/5.
        let p = UniPoly::from_i64(&[5, 6, 5]);
        let counted = |tenths: i64| {
            let sector = in_sector(&p, &Rational::new(tenths.into(), 10.into()));
            let count = count_roots(&sector, Shape::LeftHalfPlane);
            (count.inside, count.on, count.outside)
        };
        assert_eq!(counted(5), (4, 0, 0));
        assert_eq!(counted(6), (2, 2, 0));
        assert_eq!(counted(7), (2, 0, 2));
        // rho = 1 on the edge, and nowhere else.
        let edge = |tenths: i64| on_sector_edge(&p, &Rational::new(tenths.into(), 10.into()));
        let common = |tenths: i64| edge(tenths)[0].gcd(&edge(tenths)[1]).primitive_part();
        assert_eq!([5, 6, 7].map(common), [&[1][..], &[-1, 1], &[1]].map(UniPoly::from_i64));
    }
}
