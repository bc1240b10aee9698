//! The loop along a straight line of parameters.

use super::polynomial::{BoxPolynomial, Bundle};
use super::rough::{Rough, RoughPoly, is_roughly_hurwitz};
use crate::stability::is_hurwitz_routh;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::real_roots::signed_remainder_sequence;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use std::cmp::Ordering;

/// Stretches up to this many binary digits are found by rounded numbers.
const ROUGH_BITS: u64 = 40;

/// Growth beyond this factor is not searched.
pub(super) const FARTHEST: u32 = 20;

/// The polynomials on the line `base + t step`, as polynomials in `t` up to positive factors.
pub(super) struct Line<'a> {
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
}

/// How the polynomial that vanishes at a crossing depends on the parameters.
pub(super) struct Gradient {
    /// The derivative by each parameter, all times the same number.
    pub by_parameter: Vec<Rational>,
    /// The derivative along the line.
    pub along: Rational,
}

impl<'a> Line<'a> {
    pub fn new(p: &'a BoxPolynomial, base: Vec<Rational>, step: Vec<Rational>, reference: &'a [Sign]) -> Self {
        let coefficients = along(&p.coefficients, &base, &step);
        let one = |f| along(&Bundle::new(&[f], base.len()), &base, &step).remove(0);
        let certain: Vec<UniPoly> = p.certain.iter().map(|(_, f)| one(f)).collect();
        let rough = [&coefficients, &certain].map(|all| all.iter().map(RoughPoly::of).collect());
        Line { p, base, step, coefficients, certain, reference, rough }
    }

    /// The point at `t`.
    pub fn point(&self, t: &Rational) -> Vec<Rational> {
        self.base.iter().zip(&self.step).map(|(b, s)| b + &(s * t)).collect()
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

    /// Whether no divisor, constant or leading coefficient has changed its sign and all roots are left of the axis: if not, a
    /// point between the stable one and this is not stable.
    pub fn is_good(&self, t: &Rational) -> bool {
        checkpoint(1000);
        let kept = self.certain.iter().zip(self.reference).all(|(f, &sign)| f.sign_at(t) == sign);
        kept && is_hurwitz_routh(&self.coefficients_at(t))
    }

    /// [`Line::is_good`] by rounded numbers, for the search.
    fn seems_good(&self, t: &Rational) -> bool {
        checkpoint(10);
        let t = Rough::of_rational(t);
        let [coefficients, certain] = &self.rough;
        let kept = certain.iter().zip(self.reference).all(|(f, sign)| f.at(t).is_positive() == sign.is_gt());
        kept && is_roughly_hurwitz(&coefficients.iter().map(|c| c.at(t)).collect::<Vec<_>>())
    }

    /// A stretch `(lo, hi)` in which stability is lost, of width at most `hi / 2^bits`: `lo` is good, `hi` is not; up to
    /// [`ROUGH_BITS`] by rounded numbers only. Looked for up to `limit`; `None` where nothing is found.
    pub fn crossing(&self, limit: Option<&Rational>, bits: u64) -> Option<(Rational, Rational)> {
        let is_good = |t: &Rational| if bits <= ROUGH_BITS { self.seems_good(t) } else { self.is_good(t) };
        let (mut lo, mut hi) = (Rational::ZERO, None);
        match limit {
            Some(limit) => {
                for part in 1..=4 {
                    let t = limit * &Rational::new(part.into(), 4.into());
                    if !is_good(&t) {
                        hi = Some(t);
                        break;
                    }
                    lo = t;
                }
            }
            None => {
                for power in -12..=FARTHEST as i64 {
                    let t = Rational::from(2).pow(power).expect("two is not zero");
                    if !is_good(&t) {
                        hi = Some(t);
                        break;
                    }
                    lo = t;
                }
            }
        }
        self.narrowed(lo, hi?, bits)
    }

    /// The stretch between a good and another place, narrowed.
    pub fn narrowed(&self, lo: Rational, hi: Rational, bits: u64) -> Option<(Rational, Rational)> {
        let (near, far) = halved(lo.clone(), hi.clone(), bits.min(ROUGH_BITS), |t| self.seems_good(t));
        if bits <= ROUGH_BITS {
            return Some((near, far));
        }
        // A little wider than rounding can be off.
        let room = &far * &Rational::dyadic(&Integer::ONE, ROUGH_BITS - 2);
        let (near, far) = ((&near - &room).max(lo.clone()), (&far + &room).min(hi.clone()));
        let is_right = self.is_good(&near) && !self.is_good(&far);
        let (lo, hi) = if is_right { (near, far) } else { (lo, hi) };
        Some(halved(lo, hi, bits, |t| self.is_good(t)))
    }

    /// What vanishes in a narrow stretch and how it depends on the parameters; `None` where that cannot be told.
    pub fn gradient(&self, lo: &Rational, hi: &Rational) -> Option<Gradient> {
        let t = lo.midpoint(hi);
        let point = self.point(&t);
        let changed = self.certain.iter().zip(self.reference).position(|(f, &sign)| f.sign_at(hi) != sign);
        let function = match changed {
            Some(k) => Bundle::new(&[&self.p.certain[k].1], point.len()),
            None => self.pair_function(&t)?,
        };
        let (a, q): (Vec<Integer>, Vec<Integer>) = point.iter().map(|x| (x.numerator(), x.denominator())).unzip();
        let by_parameter = function.gradient(&a, &q);
        let along = by_parameter.iter().zip(&self.step).fold(Rational::ZERO, |sum, (g, s)| sum + g * s);
        (!along.is_zero()).then_some(Gradient { by_parameter, along })
    }

    /// The combination of the pair, at the frequency of the pair near `t`, that does not change with the frequency.
    fn pair_function(&self, t: &Rational) -> Option<Bundle> {
        let c = self.coefficients_at(t);
        let v = pair_frequency(&c)?;
        let (even, odd) = even_and_odd(&c);
        // Perpendicular to the derivative by the frequency; only directions matter, so a few digits are enough.
        let slope = |f: &UniPoly| f.derivative().eval_rational(&v);
        let (x, y) = (slope(&odd), -slope(&even));
        let scale = x.abs().max(y.abs());
        let whole = |x: &Rational| x.checked_div(&scale).map(|x| (x * Rational::from(Integer::ONE << 48u64)).floor());
        let (x, y) = (whole(&x)?, whole(&y)?);
        let (a, q) = (v.numerator(), v.denominator());
        let pair = self.p.pair();
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

    /// The frequency, as `omega^2` in the half plane, of the pair that is nearest to crossing at `t`.
    pub fn frequency(&self, t: &Rational) -> Option<Rational> {
        pair_frequency(&self.coefficients_at(t))
    }

    /// A rational point in `(lo, hi]` that is not stable.
    pub fn witness(&self, lo: &Rational, hi: &Rational) -> Option<Vec<Rational>> {
        let candidate = |t: &Rational| Some(self.point(t)).filter(|point| !self.p.is_stable_at(point));
        // A divisor that vanishes: the simplest number is where, if it is a rational one of a few digits.
        let simple = || jurist_algebra::poly::algebraic::simplest_between(lo, &(hi + &(hi - lo)));
        candidate(hi)
            .or_else(|| {
                let zero = self.certain.iter().filter_map(|f| rational_zero(f, lo, hi)).min()?;
                candidate(&zero)
            })
            .or_else(|| simple().filter(|t| t <= hi).as_ref().and_then(candidate))
    }
}

/// Halves a stretch until its width is at most `hi / 2^bits`.
fn halved(mut lo: Rational, mut hi: Rational, bits: u64, is_good: impl Fn(&Rational) -> bool) -> (Rational, Rational) {
    let share = Rational::dyadic(&Integer::ONE, bits);
    let least = Rational::dyadic(&Integer::ONE, 200);
    while &hi - &lo > &hi * &share && hi > least {
        let middle = lo.midpoint(&hi);
        if is_good(&middle) { lo = middle } else { hi = middle }
    }
    (lo, hi)
}

/// The zero of a linear polynomial, or of another that has a rational one, in `(lo, hi]`.
fn rational_zero(f: &UniPoly, lo: &Rational, hi: &Rational) -> Option<Rational> {
    let square_free = jurist_algebra::poly::SquareFree::part_of(f).filter(|f| f.degree() > 0)?;
    let budget = jurist_algebra::limits::Budget::unlimited();
    let (zeros, _) = jurist_algebra::poly::real_roots::rational_roots(&square_free, &budget).ok()?;
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
pub(crate) fn on_line(f: [&MultiPoly; 2], base: &[Rational], step: &[Rational]) -> [UniPoly; 2] {
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
