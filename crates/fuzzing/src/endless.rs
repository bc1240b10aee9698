//! Work that would take hours in the middle of one kernel each: what a budget must be able to end.

use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{Matrix, determinant_bareiss};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::real_roots::{Bound, SquareFree};
use jurist_algebra::poly::real_roots::{count_roots_sturm, isolate_real_roots_descartes};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly, isolate_real_roots, resultant};

/// The kernel that is busy, and the work. The inner budgets do not end: the one around has to.
pub type Job = (&'static str, fn());

/// All of them.
pub const JOBS: [Job; 14] = [
    ("product over the rationals", || {
        let p = Poly::new((0..1i64 << 17).map(|k| Rational::new(Integer::ONE, Integer::from(k % 97 + 2))).collect());
        p.times(&p);
    }),
    ("product in several variables", || {
        let p = linear_form([3, -1, 4, 1, -5]).power(9).plus(&MultiPoly::variable(7));
        p.power(30);
    }),
    ("greatest common divisor in several variables", || {
        let (a, b) = (linear_form([1, 2, 3, 4, 5]).power(9), linear_form([2, -1, 3, -1, 1]).power(9));
        // With a common factor, which no line rules out.
        let common = linear_form([1, -1, 2, 1, 2]).plus(&MultiPoly::one());
        let (a, b) = (a.plus(&MultiPoly::variable(0)), b.plus(&MultiPoly::variable(1)));
        a.times(&common).gcd(&b.times(&common));
    }),
    ("greatest common divisor by primes", || {
        let long = Integer::from(3).pow(2_600_000);
        let mut coefficients = vec![Integer::ONE; 3000];
        coefficients[7] = long;
        let common = UniPoly::new(coefficients);
        common.times(&UniPoly::from_i64(&[1, 1])).gcd(&common.times(&UniPoly::from_i64(&[2, 3, 1])));
    }),
    ("greatest common divisor of integers", || {
        let mut sum = Integer::ZERO;
        for k in 0..1_000_000u64 {
            sum += Integer::from(3).pow(3_000_000 + k).gcd(&Integer::from(7).pow(2_000_000));
        }
    }),
    ("exact division", || {
        let p = UniPoly::new((0..1i64 << 18).map(|k| Integer::from(k % 10 + 1)).collect());
        (&p * &p).div_exact(&p);
    }),
    ("resultant", || {
        let dense = |seed: u64| {
            let inner = |i: u64| UniPoly::new((0..200).map(|j| Integer::from(seed + i * j).pow(150)).collect());
            Poly::new((0..200).map(inner).collect())
        };
        let _ = resultant(&dense(3), &dense(5), &Budget::unlimited());
    }),
    ("determinant", || {
        let m = Matrix::from_fn(200, 200, |i, j| Integer::from(i * 31 + j * j + 2).pow(1000));
        let _ = determinant_bareiss(&m, &Budget::unlimited());
    }),
    ("Taylor shift", || {
        UniPoly::new(vec![Integer::ONE; 1 << 17]).taylor_shift(&Integer::from(3));
    }),
    ("isolation", || {
        let p = SquareFree::part_of(&legendre(3000)).expect("not zero");
        let _ = isolate_real_roots(&p, &Budget::unlimited());
    }),
    ("isolation by bisection", || {
        let p = SquareFree::part_of(&legendre(1500)).expect("not zero");
        let _ = isolate_real_roots_descartes(&p, None, None, &Budget::unlimited());
    }),
    ("count by Sturm", || {
        let _ = count_roots_sturm(&legendre(2500), Bound::Unbounded, Bound::Unbounded, &Budget::unlimited());
    }),
    ("digits of a root", || {
        let p = SquareFree::part_of(&UniPoly::from_i64(&[-2, 0, 0, 0, 0, 1])).expect("not zero");
        if let Ok(roots) = isolate_real_roots(&p, &Budget::unlimited()) {
            roots[0].decimal(50_000_000);
        }
    }),
    ("digits of pi", || {
        Enclosure::pi(1 << 24);
    }),
];

/// `c_0 x_0 + ... + c_3 x_3 + c_4`.
fn linear_form(c: [i64; 5]) -> MultiPoly {
    let term = |i: usize| MultiPoly::variable(i).scaled_by(&Integer::from(c[i]));
    (0..4).fold(MultiPoly::from(c[4]), |sum, i| sum.plus(&term(i)))
}

/// The polynomial of Legendre on the unit interval, all of whose roots are real: `sum (-1)^k C(n, k) C(n + k, k) x^k`.
fn legendre(n: u64) -> UniPoly {
    let mut c = Integer::ONE;
    let mut coefficients = vec![c.clone()];
    for k in 0..n {
        c = -(c * Integer::from((n - k) * (n + k + 1))).div_exact(&Integer::from((k + 1) * (k + 1)));
        coefficients.push(c.clone());
    }
    UniPoly::new(coefficients)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legendre_on_the_unit_interval() {
        assert_eq!(legendre(2), UniPoly::from_i64(&[1, -6, 6]));
        assert_eq!(legendre(3), UniPoly::from_i64(&[1, -12, 30, -20]));
    }
}
