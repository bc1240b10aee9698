//! Requirements as families of polynomials that stay stable over a box with one side more.
//!
//! *Turned.* Let `A` and `B` be polynomials and `A + j t B` have no root on the imaginary axis for all `t` of an interval that is symmetric and
//! has 0: then no polynomial of the family has fewer stable roots than another. With `A = D0 + N`, `B = N - D0` the roots of
//! `(1 - j t) D0 + (1 + j t) N` are those of the loop turned by `2 atan t`: the phase margin. With `A = D0 + N + m D0`,
//! `B = m D0 - D0 - N`, and the same with `-m`, `|t| <= 1`, those of `D0 + N + m e^(j phi) D0` over all angles: `|1 + L| = m`
//! nowhere, the modulus margin. A root `j w` at `t` is a root `-j w` at `-t`, so `w >= 0` is enough. At a point `A^2 + t^2 B^2`, which is real, counts
//! the roots of both.
//!
//! *Sector.* All roots of a real polynomial stay in the sector of a damping while none is on its upper edge `rho e^(j psi)`,
//! `cos psi = -damping`, nor at 0 or infinity. The imaginary parts of `P` and `P e^(-j psi)` there, over `sin psi`, are
//! `sum p_k u_k rho^k` and `sum p_k u_(k-1) rho^k` with rational `u_k = sin(k psi)/sin psi`.

use super::polynomial::{BoxPolynomial, Bundle, Excluded, in_half_plane, without_squares};
use crate::Shape;
use crate::sector::in_sector;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};

impl BoxPolynomial {
    /// `A + j t B` with `t` as one parameter more, the last, whose side begins at 0; both in `z` or `s`.
    ///
    /// Cost: two squares of polynomials in the parameters.
    pub fn turned(
        [a, b]: [&Poly<MultiPoly>; 2],
        undefined: &[&MultiPoly],
        parameters: usize,
        shape: Shape,
    ) -> BoxPolynomial {
        let n = a.degree().max(b.degree()).unwrap_or(0);
        let [a, b] = [a, b].map(|p| in_half_plane(p, n, shape));
        let t = MultiPoly::variable(parameters);
        let squared = |p: &[MultiPoly]| {
            let p = Poly::new(p.to_vec());
            p.times(&p)
        };
        let both = squared(&a).plus(&squared(&b).scaled(&t.times(&t)));
        let undefined = undefined.iter().copied();
        let mut out = BoxPolynomial::of_parts(both, 2 * n, undefined, parameters + 1, Shape::LeftHalfPlane);
        // At t = 0 these are the ends of the family; elsewhere the ends of the frequency's range are in the cells.
        let count = out.certain.len();
        out.certain[count - 2].1 = without_squares(&a[0]);
        out.certain[count - 1].1 = without_squares(&a[n]);
        // (j w)^k = sign j^(k odd) w^k: real and imaginary part of A + j t B.
        let sign = |k: usize| Integer::from(if (k / 2).is_multiple_of(2) { 1 } else { -1 });
        let minus_t = t.negated();
        let real = |k: usize| if k.is_multiple_of(2) { a[k].clone() } else { b[k].times(&minus_t) };
        let imaginary = |k: usize| if k.is_multiple_of(2) { b[k].times(&t) } else { a[k].clone() };
        let all: Vec<MultiPoly> = (0..=n)
            .map(|k| real(k).scaled_by(&sign(k)))
            .chain((0..=n).map(|k| imaginary(k).scaled_by(&sign(k))))
            .collect();
        out.instead = Some(Excluded {
            pair: Bundle::new(&all.iter().collect::<Vec<_>>(), parameters + 1),
            power: 1,
            mirrored: true,
        });
        out
    }

    /// A polynomial in `s` whose roots shall stay in the sector of a damping.
    ///
    /// Cost: a square of a polynomial in the parameters.
    pub fn in_sector(
        p: &Poly<MultiPoly>,
        n: usize,
        undefined: &[&MultiPoly],
        parameters: usize,
        damping: &Rational,
    ) -> BoxPolynomial {
        let undefined = undefined.iter().copied();
        let mut out =
            BoxPolynomial::of_parts(in_sector(p, damping), 2 * n, undefined, parameters, Shape::LeftHalfPlane);
        let count = out.certain.len();
        out.certain[count - 2].1 = without_squares(&p.coeff(0));
        out.certain[count - 1].1 = without_squares(&p.coeff(n));
        // u_(-1), u_0, ..., u_n.
        let twice_cosine = -(damping + damping);
        let mut sines = vec![-Rational::ONE, Rational::ZERO];
        for k in 1..=n {
            let next = &twice_cosine * &sines[k] - &sines[k - 1];
            sines.push(next);
        }
        let clear = Rational::from(sines.iter().fold(Integer::ONE, |l, u| l.lcm(&u.denominator())));
        let weighted = |k: usize, u: &Rational| p.coeff(k).scaled_by(&(u * &clear).numerator());
        let all: Vec<MultiPoly> =
            (0..=n).map(|k| weighted(k, &sines[k + 1])).chain((0..=n).map(|k| weighted(k, &sines[k]))).collect();
        out.instead = Some(Excluded {
            pair: Bundle::new(&all.iter().collect::<Vec<_>>(), parameters),
            power: 1,
            mirrored: false,
        });
        out
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Side, ToleranceProblem};
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::number::parse_number;

    fn q(text: &str) -> Rational {
        parse_number(text).unwrap()
    }

    /// The pair over the values of a box vanishes just where the squared polynomial has a root on the axis: `A = s^2 + s + p`, `B = 1`.
    #[test]
    fn a_turned_family_is_decided_like_its_squares() {
        let p = MultiPoly::variable(0);
        let one = MultiPoly::one;
        let a = Poly::new(vec![p.clone(), one(), one()]);
        let b = Poly::new(vec![one(), MultiPoly::zero(), MultiPoly::zero()]);
        let family = BoxPolynomial::turned([&a, &b], &[], 1, Shape::LeftHalfPlane);
        // s = j w: p - w^2 = 0 and w + t = 0: a root on the axis just where t^2 = p.
        for (value, t, is_stable) in [("4", "1", true), ("4", "2", false), ("1/4", "-1/2", false), ("1/4", "1/3", true)]
        {
            assert_eq!(family.is_stable_at(&[q(value), q(t)]), is_stable, "{value} {t}");
        }
        let decided = |room: &str| {
            let sides = vec![Side::scaled(q("4"), [q("1"), q("1")]), Side::fixed(q(room), [q(room), q("0")])];
            let boxes = ToleranceProblem::new(&family, sides).unwrap();
            let decision = boxes.decide(&Rational::ONE, &Budget::unlimited()).unwrap();
            let factor = boxes.largest_factor(&q("1e-9"), None, &Budget::unlimited()).unwrap();
            (decision.is_stable(), factor)
        };
        // p from 4 - r down to t^2.
        let (is_stable, factor) = decided("3/2");
        assert!(is_stable);
        assert!(factor.lower <= q("7/4") && factor.upper.as_ref().is_some_and(|upper| q("7/4") <= *upper));
        assert!(q("7/4") - factor.lower < q("1e-8"));
        assert!(!decided("7/4").0);
    }

    /// `s^2 + 2 d s + 1` has the damping `d`.
    #[test]
    fn a_sector_is_kept_where_the_damping_is() {
        let d = MultiPoly::variable(0);
        let p = Poly::new(vec![MultiPoly::one(), d.scaled_by(&2.into()), MultiPoly::one()]);
        let family = BoxPolynomial::in_sector(&p, 2, &[], 1, &q("3/5"));
        let boxes = ToleranceProblem::new(&family, vec![Side::scaled(q("4/5"), [q("1/10"), q("1/10")])]).unwrap();
        let budget = Budget::unlimited();
        assert!(boxes.decide(&q("19/10"), &budget).unwrap().is_stable());
        assert!(!boxes.decide(&q("21/10"), &budget).unwrap().is_stable());
        let factor = boxes.largest_factor(&q("1e-9"), None, &budget).unwrap();
        assert!(factor.lower <= q("2") && factor.upper.is_some_and(|upper| q("2") <= upper && upper < q("2.0000001")));
    }
}
