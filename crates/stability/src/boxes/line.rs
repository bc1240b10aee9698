//! The loop along a straight line of parameters.

use super::family::{Gradient, Path};
use super::polynomial::{BoxPolynomial, Bundle};
use super::rough::{Rough, RoughPoly, is_roughly_hurwitz};
use crate::is_hurwitz_routh;
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::real_roots::signed_remainder_sequence;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// The polynomials on the line `base + t step`, as polynomials in `t` up to positive factors.
pub struct Line<'a> {
    p: &'a BoxPolynomial,
    base: Vec<Rational>,
    step: Vec<Rational>,
    coefficients: Vec<UniPoly>,
    /// Divisors, then the constant and the leading coefficient.
    certain: Vec<UniPoly>,
    /// The signs of these where the loop is known to be stable.
    reference: &'a [Sign],
    /// The same polynomials, rounded: coefficients and certain ones.
    rough: [Vec<RoughPoly>; 2],
    /// The zeros of the certain polynomials, where these tell of stability.
    zeros: OnceCell<Vec<RealAlgebraic>>,
}

impl<'a> Line<'a> {
    pub fn new(p: &'a BoxPolynomial, base: Vec<Rational>, step: Vec<Rational>, reference: &'a [Sign]) -> Self {
        let coefficients = along(&p.coefficients, &base, &step);
        let one = |f| along(&Bundle::new(&[f], base.len()), &base, &step).remove(0);
        let certain: Vec<UniPoly> = p.certain.iter().map(|(_, f)| one(f)).collect();
        let rough = [&coefficients, &certain].map(|all| all.iter().map(RoughPoly::of).collect());
        Line { p, base, step, coefficients, certain, reference, rough, zeros: OnceCell::new() }
    }

    fn coefficients_at(&self, t: &Rational) -> UniPoly {
        let degree = self.coefficients.iter().map(|c| c.coeffs().len()).max().unwrap_or(1).saturating_sub(1);
        let (a, q) = (t.numerator(), t.denominator());
        let mut scale = vec![Integer::ONE];
        for k in 0..degree {
            scale.push(&scale[k] * &q);
        }
        let value = |f: &UniPoly| {
            let top = f.coeffs().len().saturating_sub(1);
            let mut sum = Integer::ZERO;
            for (i, c) in f.coeffs().iter().enumerate().rev() {
                sum = &sum * &a;
                sum.add_mul_assign(c, &scale[top - i]);
            }
            &sum * &scale[degree - top]
        };
        Poly::new(self.coefficients.iter().map(value).collect())
    }

    fn zeros(&self) -> &[RealAlgebraic] {
        self.zeros.get_or_init(|| {
            let square_free = self.certain.iter().filter_map(SquareFree::part_of);
            // A budget that runs out is noticed by who asks for the line.
            square_free.flat_map(|f| isolate_real_roots(&f, &Budget::unlimited()).unwrap_or_default()).collect()
        })
    }

    /// The frequency, as `omega^2` in the half plane, of the pair that is nearest to crossing at `t`.
    pub fn frequency(&self, t: &Rational) -> Option<Rational> {
        pair_frequency(&self.coefficients_at(t))
    }
}

impl Path for Line<'_> {
    fn point(&self, t: &Rational) -> Vec<Rational> {
        self.base.iter().zip(&self.step).map(|(b, s)| b + &(s * t)).collect()
    }

    fn is_good(&self, t: &Rational) -> bool {
        checkpoint(1000);
        let kept = self.certain.iter().zip(self.reference).all(|(f, &sign)| f.sign_at(t) == sign);
        kept && is_hurwitz_routh(&self.coefficients_at(t))
    }

    fn seems_good(&self, t: &Rational) -> bool {
        checkpoint(10);
        let t = Rough::of_rational(t);
        let [coefficients, certain] = &self.rough;
        let kept = certain.iter().zip(self.reference).all(|(f, sign)| f.at(t).is_positive() == sign.is_gt());
        kept && is_roughly_hurwitz(&coefficients.iter().map(|c| c.at(t)).collect::<Vec<_>>())
    }

    fn is_stable(&self, t: &Rational) -> bool {
        self.p.is_stable_at(&self.point(t))
    }

    fn gradient(&self, lo: &Rational, hi: &Rational) -> Option<Gradient> {
        let t = lo.midpoint(hi);
        let point = self.point(&t);
        let changed = self.certain.iter().zip(self.reference).position(|(f, &sign)| f.sign_at(hi) != sign);
        let function = match changed {
            Some(k) => Bundle::new(&[&self.p.certain[k].1], point.len()),
            None => pair_function(&self.coefficients_at(&t), &self.p.pair())?,
        };
        let (a, q): (Vec<Integer>, Vec<Integer>) = point.iter().map(|x| (x.numerator(), x.denominator())).unzip();
        let by_parameter = function.gradient(&a, &q);
        Gradient::new(by_parameter, &self.step)
    }

    fn first_zero(&self, from: &Rational, to: &Rational, bits: u64) -> Option<Option<(Rational, Rational)>> {
        if !self.p.by_signs {
            return None;
        }
        let is_between =
            |zero: &&RealAlgebraic| zero.compare_rational(from).is_gt() && zero.compare_rational(to).is_le();
        let first = self.zeros().iter().filter(is_between).min_by(|a, b| a.compare(b));
        Some(first.map(|zero| {
            let width = &zero.refined_to_digits(1).enclosure().0 * &Rational::dyadic(&Integer::ONE, bits);
            let (lo, hi) = zero.refined(&width).enclosure();
            let lo = if lo == hi { &lo - &width } else { lo };
            (lo.max(from.clone()), hi.min(to.clone()))
        }))
    }

    fn rational_zero(&self, lo: &Rational, hi: &Rational) -> Option<Rational> {
        self.certain.iter().filter_map(|f| rational_zero(f, lo, hi)).min()
    }
}

/// The zero of a linear polynomial, or of another that has a rational one, in `(lo, hi]`.
pub(super) fn rational_zero(f: &UniPoly, lo: &Rational, hi: &Rational) -> Option<Rational> {
    let square_free = SquareFree::part_of(f).filter(|f| f.degree() > 0)?;
    let (zeros, _) = jurist_algebra::poly::real_roots::rational_roots(&square_free, &Budget::unlimited()).ok()?;
    zeros.into_iter().filter(|z| lo < z && z <= hi).min()
}

/// `E` and `O` in `v` with `P(i w) = E(w^2) + i w O(w^2)`.
fn even_and_odd(c: &UniPoly) -> (UniPoly, UniPoly) {
    let part = |odd: usize| {
        let signed = |(j, c): (usize, &Integer)| if j % 2 == 1 { -c } else { c.clone() };
        Poly::new(c.coeffs().iter().skip(odd).step_by(2).enumerate().map(signed).collect())
    };
    (part(0), part(1))
}

/// The combination of the pair, at the frequency of the pair of a polynomial, that does not change with the frequency.
pub(super) fn pair_function(c: &UniPoly, pair: &Bundle) -> Option<Bundle> {
    let v = pair_frequency(c)?;
    let (even, odd) = even_and_odd(c);
    // Perpendicular to the derivative by the frequency; only directions matter, so a few digits are enough.
    let slope = |f: &UniPoly| f.derivative().eval_rational(&v);
    let (x, y) = (slope(&odd), -slope(&even));
    let scale = x.abs().max(y.abs());
    let whole = |x: &Rational| x.checked_div(&scale).map(|x| (x * Rational::from(Integer::ONE << 48u64)).floor());
    let (x, y) = (whole(&x)?, whole(&y)?);
    let (a, q) = (v.numerator(), v.denominator());
    let k = pair.width / 2 - 1;
    let weights: Vec<Integer> = (0..=k).map(|j| &a.pow(j as u64) * &q.pow((k - j) as u64)).collect();
    Some(pair.combined(1, |c| {
        let part = |odd: usize| {
            let values = c[odd * (k + 1)..].iter().zip(&weights);
            values.fold(Integer::ZERO, |sum, (c, w)| sum + c * w)
        };
        vec![&(&part(0) * &x) + &(&part(1) * &y)]
    }))
}

/// Near a crossing the pair has nearly a common root: that of the last linear remainder, to some 60 digits of binary.
fn pair_frequency(c: &UniPoly) -> Option<Rational> {
    let (even, odd) = even_and_odd(c);
    if odd.is_zero() {
        return None;
    }
    let sequence = signed_remainder_sequence(&even, &odd);
    let linear = sequence.iter().rev().find(|f| f.coeffs().len() == 2)?;
    let v = Rational::from(-&linear.coeffs()[0]).checked_div(&Rational::from(linear.coeffs()[1].clone()))?;
    v.sign().is_gt().then(|| rounded(&v, 60))
}

/// A positive number to about so many binary digits.
pub(super) fn rounded(v: &Rational, bits: u64) -> Rational {
    let size = v.numerator().bit_length() as i64 - v.denominator().bit_length() as i64;
    let power = Rational::from(2).pow(bits as i64 - size).expect("two is not zero");
    Rational::from((v * &power).floor()).checked_div(&power).expect("a power is not zero")
}

/// The polynomials on the line `base + t step` as polynomials in `t`, all times one positive number.
pub(super) fn along(bundle: &Bundle, base: &[Rational], step: &[Rational]) -> Vec<UniPoly> {
    let tables: Vec<Vec<UniPoly>> = bundle
        .degrees
        .iter()
        .zip(base.iter().zip(step))
        .map(|(&degree, (b, s))| {
            let q = b.denominator().lcm(&s.denominator());
            let whole = |v: &Rational| (v * &Rational::from(&q)).numerator();
            let linear = Poly::new(vec![whole(b), whole(s)]);
            let mut powers = vec![UniPoly::one()];
            for e in 0..degree {
                powers.push(&powers[e] * &linear);
            }
            powers.iter().enumerate().map(|(e, p)| p.scaled(&q.pow((degree - e) as u64))).collect()
        })
        .collect();
    let terms: Vec<(&[u32], &[Integer])> = bundle.terms.iter().map(|(e, c)| (e.as_slice(), c.as_slice())).collect();
    along_from(&terms, &tables, bundle.width)
}

fn along_from(terms: &[(&[u32], &[Integer])], tables: &[Vec<UniPoly>], width: usize) -> Vec<UniPoly> {
    let Some((table, rest)) = tables.split_first() else {
        let constants = terms.first().map_or_else(|| vec![Integer::ZERO; width], |(_, c)| c.to_vec());
        return constants.into_iter().map(UniPoly::constant).collect();
    };
    let mut out = vec![UniPoly::zero(); width];
    for group in terms.chunk_by(|a, b| a.0[0] == b.0[0]) {
        let power = &table[group[0].0[0] as usize];
        let group: Vec<(&[u32], &[Integer])> = group.iter().map(|(e, c)| (&e[1..], *c)).collect();
        for (target, inner) in out.iter_mut().zip(along_from(&group, rest, width)) {
            if !inner.is_zero() {
                *target = target.plus(&inner.times(power));
            }
        }
    }
    out
}

/// Two polynomials on the line `base + t step`, both times the same positive number.
pub fn on_line(f: [&MultiPoly; 2], base: &[Rational], step: &[Rational]) -> [UniPoly; 2] {
    let both = along(&Bundle::new(&f, base.len()), base, step);
    let [first, second]: [UniPoly; 2] = both.try_into().expect("two polynomials");
    [first, second]
}

/// `-1`, `0` or `1`.
pub(super) fn unit(sign: Sign) -> Rational {
    Rational::from(match sign {
        Ordering::Less => -1,
        Ordering::Equal => 0,
        Ordering::Greater => 1,
    })
}
