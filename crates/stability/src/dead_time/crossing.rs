//! Where roots of a loop with dead time can lie on the imaginary axis, for any dead time at all.

use super::over_root::{eval, gcd, isolate, narrowed, square_free, without_zero_root};
use super::quasi_polynomial::{QuasiPolynomial, even_odd, rekasius};
use crate::precisions::MOTION_OF_ROOTS;
use jurist_algebra::limits::{Budget, Exhausted, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in, resultant_formal};

/// A point of the imaginary axis, `i omega` with `omega > 0`, and a value `z` of modulus one for which it is a root.
///
/// Then it is a root for the dead times `(theta + 2 pi k)/omega`, where `z = exp(-i theta)`, and for no others with this
/// `z`. `omega^2` and `z` are algebraic.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// `-omega^2`.
    pub(super) w: RealAlgebraic,
    pub(super) place: Place,
    /// Whether the root moves right (greater) or left (less) while the dead time grows, at every one of its dead times;
    /// equal where the first derivative does not tell.
    pub(super) motion: Sign,
}

/// The value `z = (1 - s S)/(1 + s S)` at `s = i omega`.
#[derive(Clone, Debug)]
pub(super) enum Place {
    /// `S = numerator/denominator` at `w`; `0/1` is `z = 1`, `1/0` is `z = -1`.
    Quotient { numerator: UniPoly, denominator: UniPoly },
    /// The root of a polynomial in `S` over `w` that lies in an interval.
    Root { polynomial: Poly<UniPoly>, interval: (Rational, Rational) },
}

/// All crossings of a quasi-polynomial without a common factor of its parts whose difference operator is stable, in the
/// order of falling frequency.
///
/// With `z = (1 - s S)/(1 + s S)` the function becomes a polynomial in `s` with a real parameter `S`, and the crossings are
/// the common roots of its half-size pair `E(w, S)`, `O(w, S)`, `w = s^2`: negative zeros of the resultant that eliminates
/// `S` ([Rekasius1980](jurist_algebra::bibliography#rekasius1980)). For one delay it is
/// `|P_0|^2 - |P_1|^2` ([WaltonMarshall1987](jurist_algebra::bibliography#waltonmarshall1987)). The resultant does not vanish
/// identically: two factors that are mirror images of each other would put a zero of the difference operator into the
/// closed unit disc.
///
/// Cost: one resultant in `S` of two polynomials of degree `q` over the integers' polynomials of degree about `n/2`, and the
/// isolation of its roots.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn crossings(p: &QuasiPolynomial, budget: &Budget) -> Result<Vec<Crossing>, Exhausted> {
    let q = p.delays();
    let pair = |on_circle: Vec<UniPoly>| {
        let (even, odd): (Vec<_>, Vec<_>) = on_circle.iter().map(even_odd).unzip();
        (Poly::new(even), Poly::new(odd))
    };
    let (even, odd) = pair(p.on_circle());
    budget.step("crossings of the imaginary axis");
    let eliminated = resultant_formal(&even, q, &odd, q, budget)?;
    let minus = {
        let (e, o) = even_odd(&p.at_sign(true));
        e.gcd(&o)
    };
    let motion = Motion::of(p, pair);
    let zero = Rational::ZERO;
    let mut out = Vec::new();
    let candidates = budget.enter(|| SquareFree::part_of(&eliminated))?;
    let candidates = candidates.expect("the resultant of a loop with a stable difference operator is not zero");
    for w in isolate_real_roots_in(&candidates, None, Some(&zero), budget)? {
        budget.check()?;
        let places = budget.enter(|| {
            let mut places = Vec::new();
            if w.sign_of(&minus).is_eq() {
                places.push(Place::Quotient { numerator: UniPoly::one(), denominator: UniPoly::zero() });
            }
            finite_places(&gcd(&even, &odd, &w), &w, &mut places);
            places
        })?;
        for place in places {
            let motion = budget.enter(|| motion.at(&w, &place))?;
            out.push(Crossing { w: w.clone(), place, motion });
        }
    }
    Ok(out)
}

/// The real values of `S` at which the common divisor vanishes.
fn finite_places(common: &Poly<UniPoly>, w: &RealAlgebraic, places: &mut Vec<Place>) {
    if common.is_constant() {
        return;
    }
    let mut rest = square_free(common, w);
    if w.sign_of(&rest.coeff(0)).is_eq() {
        places.push(Place::Quotient { numerator: UniPoly::zero(), denominator: UniPoly::one() });
        rest = without_zero_root(&rest);
    }
    match rest.coeffs() {
        [] | [_] => {}
        [c0, c1] => places.push(Place::Quotient { numerator: c0.negated(), denominator: c1.clone() }),
        _ => {
            for interval in isolate(&rest, w) {
                places.push(Place::Root { polynomial: rest.clone(), interval });
            }
        }
    }
}

/// `Re(Pi_s conj(s z Pi_z))` on the axis as a polynomial in `w` and `S`, up to a positive factor: its sign is that of the
/// derivative of `log |z|` along the axis, and of the root's motion while the dead time grows.
struct Motion {
    polynomial: Poly<UniPoly>,
    /// Its formal degree in `S`.
    degree: usize,
}

impl Motion {
    fn of(p: &QuasiPolynomial, pair: impl Fn(Vec<UniPoly>) -> (Poly<UniPoly>, Poly<UniPoly>)) -> Motion {
        let q = p.delays();
        let by_s: Vec<UniPoly> = p.parts().iter().map(UniPoly::derivative).collect();
        let by_z: Vec<UniPoly> =
            p.parts().iter().enumerate().map(|(k, part)| part.scaled(&Integer::from(k as i64)).shifted_up(1)).collect();
        let (xe, xo) = pair(rekasius(&by_s, q));
        let (ve, vo) = pair(rekasius(&by_z, q));
        // (Xe + s Xo)(Ve - s Vo) has the real part Xe Ve - w Xo Vo.
        let w = Poly::constant(UniPoly::x());
        let polynomial = xe.times(&ve).minus(&xo.times(&vo).times(&w));
        Motion { polynomial, degree: 2 * q }
    }

    fn at(&self, w: &RealAlgebraic, place: &Place) -> Sign {
        match place {
            Place::Quotient { numerator, denominator } => {
                let mut sum = UniPoly::zero();
                for (k, c) in self.polynomial.coeffs().iter().enumerate() {
                    let power = numerator.power(k as u64).times(&denominator.power((self.degree - k) as u64));
                    sum = sum.plus(&c.times(&power));
                }
                w.sign_of(&sum)
            }
            Place::Root { polynomial, interval } => {
                // Equal here only means that it is not known to be otherwise.
                let sign = |bits: u64| {
                    let at = enclosed(w, bits);
                    let (lo, hi) = narrowed(polynomial, w, interval.clone(), bits);
                    let value = eval(&self.polynomial, &at, &Enclosure::new(lo, hi), bits);
                    let is_certain = value.lower().sign().is_gt() || value.upper().is_negative();
                    is_certain.then(|| value.lower().sign())
                };
                MOTION_OF_ROOTS.bits().find_map(sign).unwrap_or(Sign::Equal)
            }
        }
    }
}

/// An enclosure of relative width about `2^-bits` of a number that is not zero.
fn enclosed(x: &RealAlgebraic, bits: u64) -> Enclosure {
    until_shown(bits, |width| {
        let (lo, hi) = x.refined(&Rational::dyadic(&Integer::ONE, width)).enclosure();
        let least = lo.abs().min(hi.abs());
        let is_narrow =
            lo == hi || lo.sign() == hi.sign() && (&hi - &lo) * Rational::from(&Integer::ONE << bits) <= least;
        is_narrow.then(|| Enclosure::new(lo, hi))
    })
}

impl Crossing {
    /// `-omega^2`.
    pub fn half_size_root(&self) -> &RealAlgebraic {
        &self.w
    }

    /// `omega^2`.
    pub fn omega_squared(&self) -> RealAlgebraic {
        self.w.negated()
    }

    /// Whether the root moves right (greater) or left (less) while the dead time grows; equal where the first derivative
    /// does not tell.
    pub fn motion(&self) -> Sign {
        self.motion
    }

    /// The angular frequency, with about `bits` significant bits.
    pub fn omega(&self, bits: u64) -> Enclosure {
        enclosed(&self.w, bits + 8).neg().sqrt(bits + 8).rounded(bits + 4)
    }

    /// Whether `z = 1`, so that a dead time of zero is among its dead times.
    pub fn at_zero_delay(&self) -> bool {
        matches!(&self.place, Place::Quotient { numerator, .. } if numerator.is_zero())
    }

    /// The angle `theta` in `[0, 2 pi)` with `z = exp(-i theta)`: exactly zero for `z = 1`.
    pub fn theta(&self, bits: u64) -> Enclosure {
        let working = bits + 16;
        let two = Enclosure::from_rational(Rational::from(2));
        match &self.place {
            Place::Quotient { numerator, .. } if numerator.is_zero() => Enclosure::from_rational(Rational::ZERO),
            Place::Quotient { denominator, .. } if denominator.is_zero() => Enclosure::pi(bits),
            place => {
                let tangent = self.half_tangent(place, working);
                let angle = tangent.atan(working).mul(&two, working);
                let turn = Enclosure::pi(working).mul(&two, working);
                if tangent.upper().is_negative() { angle.add(&turn, bits) } else { angle.rounded(bits) }
            }
        }
    }

    /// `omega S = tan(theta/2)`, neither zero nor infinite, so that its sign shows.
    fn half_tangent(&self, place: &Place, bits: u64) -> Enclosure {
        until_shown(bits + 8, |working| {
            let w = enclosed(&self.w, working);
            let omega = w.neg().sqrt(working);
            let s = match place {
                Place::Quotient { numerator, denominator } => {
                    let value = |p: &UniPoly| p.eval_enclosure(&w, working);
                    value(numerator).div(&value(denominator), working)
                }
                Place::Root { polynomial, interval } => {
                    let (lo, hi) = narrowed(polynomial, &self.w, interval.clone(), working);
                    Some(Enclosure::new(lo, hi))
                }
            };
            s.map(|s| s.mul(&omega, working)).filter(|t| {
                let width = (t.upper() - t.lower()) * Rational::from(&Integer::ONE << bits);
                (t.lower().sign().is_gt() || t.upper().is_negative()) && width <= t.lower().abs().min(t.upper().abs())
            })
        })
    }

    /// The dead time `(theta + 2 pi k)/omega`, with about `bits` bits of the angle.
    pub fn dead_time(&self, k: u64, bits: u64) -> Enclosure {
        let working = bits + 16;
        let turns = Enclosure::pi(working)
            .mul(&Enclosure::from_rational(Rational::from(&Integer::from(2) * &Integer::from(k as i64))), working);
        let angle = self.theta(working).add(&turns, working);
        angle.div(&self.omega(working), bits).expect("the frequency is positive")
    }
}

/// Whether two crossings of different frequency can have dead times in common: then these differ by multiples of
/// `2 pi/(b omega_1)`, zero among them, with the integer `b` that is returned. `None` where their places are not rational in
/// the frequency, so that it is not decided.
///
/// By Baker's theorem ([Baker1975](jurist_algebra::bibliography#baker1975)) `(theta_1 + 2 pi k)/omega_1 = (theta_2 + 2 pi l)/omega_2`
/// needs `omega_1/omega_2 = a/b` rational, and then `z_1^b = z_2^a`, which is an identity between algebraic numbers; with
/// both, `b (theta_1 + 2 pi k) - a (theta_2 + 2 pi l)` is a multiple of `2 pi`.
pub(super) fn commensurate(
    one: &Crossing,
    two: &Crossing,
    budget: &Budget,
) -> Result<Option<Option<Integer>>, Exhausted> {
    /// Greater multiples are not looked at.
    const LARGEST: u64 = 1 << 10;
    budget.enter(|| {
        let Some((a, b)) = frequency_ratio(&one.w, &two.w) else { return Some(None) };
        let (Some((n1, d1)), Some((n2, d2))) = (quotient(&one.place), quotient(&two.place)) else { return None };
        let (up, down) = (a.to_i64()? as u64, b.to_i64()? as u64);
        if up.max(down) > LARGEST {
            return None;
        }
        // 1 + s S has the argument theta/2 up to half turns; s_2 = (b/a) s_1, and the second angle is taken negative. The
        // product of the powers is real where b theta_1/2 - a theta_2/2 is a multiple of pi.
        let terms = n2.coeffs().len().max(d2.coeffs().len());
        let scale = |p: &UniPoly| at_scaled(p, terms, &a, &b);
        let first = Line { real: d1.clone(), imaginary: n1.clone() };
        let second = Line { real: scale(d2).scaled(&a), imaginary: scale(n2).scaled(&b).negated() };
        let product = first.power(down).times(&second.power(up));
        Some(one.w.sign_of(&product.imaginary).is_eq().then_some(b))
    })
}

fn quotient(place: &Place) -> Option<(&UniPoly, &UniPoly)> {
    match place {
        Place::Quotient { numerator, denominator } => Some((numerator, denominator)),
        Place::Root { .. } => None,
    }
}

/// `real + s imaginary` at `s = i omega`, `s^2 = w`.
struct Line {
    real: UniPoly,
    imaginary: UniPoly,
}

impl Line {
    fn times(&self, other: &Line) -> Line {
        let w = UniPoly::x();
        let real = self.real.times(&other.real).plus(&self.imaginary.times(&other.imaginary).times(&w));
        let imaginary = self.real.times(&other.imaginary).plus(&self.imaginary.times(&other.real));
        Line { real, imaginary }
    }

    fn power(&self, exponent: u64) -> Line {
        let mut out = Line { real: UniPoly::one(), imaginary: UniPoly::zero() };
        for _ in 0..exponent {
            out = out.times(self);
        }
        out
    }
}

/// `a^(2 terms - 2) p(b^2 w / a^2)` for a polynomial of so many terms: its value at `w_2` in terms of `w_1`.
fn at_scaled(p: &UniPoly, terms: usize, a: &Integer, b: &Integer) -> UniPoly {
    let n = terms;
    let coefficient = |(k, c): (usize, &Integer)| {
        let up = (b * b).pow(k as u64);
        let down = (a * a).pow((n - 1 - k) as u64);
        c * &(up * down)
    };
    UniPoly::new(p.coeffs().iter().enumerate().map(coefficient).collect())
}

/// `omega_1/omega_2` as `a/b` in lowest terms, if it is rational.
///
/// The ratio of the squares is a root of the resultant of `f_1(r w)` and `f_2(w)`, whose first and last coefficients bound
/// numerator and denominator of a rational root; so one candidate is left on a narrow enclosure, and it is tested exactly.
fn frequency_ratio(one: &RealAlgebraic, two: &RealAlgebraic) -> Option<(Integer, Integer)> {
    let (f, g) = (one.polynomial(), two.polynomial());
    let (m, n) = (f.degree()? as u64, g.degree()? as u64);
    let last = |p: &UniPoly| p.coeffs().iter().find(|c| !c.is_zero()).map_or(1, Integer::bit_length);
    let lead = |p: &UniPoly| p.leading().map_or(1, Integer::bit_length);
    let bound = n * last(f).max(lead(f)) + m * last(g).max(lead(g)) + 2;
    let bits = 2 * bound + 8;
    let ratio = enclosed(one, bits).div(&enclosed(two, bits), bits)?;
    let candidate = if ratio.lower() == ratio.upper() {
        ratio.lower().clone()
    } else {
        jurist_algebra::poly::simplest_between(ratio.lower(), ratio.upper())?
    };
    let root = |n: &Integer| Some(n.sqrt_floor()).filter(|r| r * r == *n);
    let (a, b) = (root(&candidate.numerator())?, root(&candidate.denominator())?);
    // w_1 = (a/b)^2 w_2 exactly: w_1 is a root of g(b^2 w/a^2) and the only one near.
    let scaled = at_scaled(g, g.coeffs().len(), &a, &b);
    if !one.sign_of(&scaled).is_eq() {
        return None;
    }
    let back = |x: &Rational| x * &candidate;
    let (lo, hi) = two.enclosure();
    let inside = if lo == hi {
        one.compare_rational(&back(&lo)).is_eq()
    } else {
        one.compare_rational(&back(&lo)).is_gt() && one.compare_rational(&back(&hi)).is_lt()
    };
    inside.then_some((a, b))
}
