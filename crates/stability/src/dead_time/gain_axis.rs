//! A loop with a gain on the imaginary axis: where `-A/B` is real.

use super::gain::GainLoop;
use super::quasi_polynomial::even_odd;
use super::trigonometric::{AxisZero, Form, Jet};
use super::turn::{Fixed, turned};
use jurist_algebra::limits::{Budget, Exhausted, doubling, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_algebra::real::{Enclosing, Origin};
use std::sync::Arc;

/// What a root on the axis at an algebraic frequency means.
pub(super) enum Fixture {
    /// It is there for every value of the parameter.
    Never,
    /// No value of the parameter puts one there.
    NoGain,
    /// It is there for the value zero, and so many more roots are to the right beyond it.
    Zero(i64),
    /// None of them is proved.
    Unknown,
}

/// `A`, `B` on the imaginary axis.
#[derive(Debug)]
pub(super) struct Axis {
    gain: GainLoop,
    /// `Im(A conj B)`: the coefficients, polynomials in the frequency, of `sin^j cos^(2q - j)` of half the angle.
    pub(super) trace: Vec<UniPoly>,
    /// Upper bounds of the derivatives of `A` and `B` by the frequency come from these: sums of moduli.
    slopes: [UniPoly; 2],
}

impl Axis {
    pub(super) fn new(gain: &GainLoop) -> Axis {
        let mut trace = product(&gain.a, &gain.b, Part::Imaginary);
        if trace.iter().all(UniPoly::is_zero) {
            trace.clear();
        }
        let slopes = [&gain.a, &gain.b].map(|parts| {
            let (t, d) = (gain.tau.numerator(), gain.tau.denominator());
            parts.iter().enumerate().fold(UniPoly::zero(), |sum, (k, p)| {
                let delay = p.scaled(&(&t * &Integer::from(k as i64)));
                let both = absolute(&p.derivative().scaled(&d)).plus(&absolute(&delay));
                sum.plus(&both)
            })
        });
        Axis { gain: gain.clone(), trace, slopes }
    }

    /// The zeros of `Im(A conj B)` by what they mean.
    pub(super) fn forms(&self) -> Forms {
        let content = self.trace.iter().fold(UniPoly::zero(), |g, p| g.gcd(p));
        let divided: Vec<UniPoly> = self.trace.iter().map(|p| p.div_exact(&content).expect("divides")).collect();
        let whole = bivariate(&divided);
        // At tan = infinity the form vanishes where its highest coefficient does: at every odd turn.
        let vanishes_there = |p: &[UniPoly]| p.last().is_some_and(UniPoly::is_zero);
        let (a, b) = (product(&self.gain.a, &self.gain.a, Part::Real), product(&self.gain.b, &self.gain.b, Part::Real));
        let at_infinity = vanishes_there(&self.trace);
        let nothing_there = at_infinity && (vanishes_there(&a) || vanishes_there(&b));
        // Factors that are in |A|^2 or in |B|^2, too: where they vanish, A or B does.
        let part = whole.square_free_part();
        let of_a = part.gcd(&bivariate(&a));
        let rest = part.div_exact(&of_a).expect("a common divisor divides");
        let of_b = rest.gcd(&bivariate(&b));
        let rest = rest.div_exact(&of_b).expect("a common divisor divides");
        let rate = &self.gain.tau * &Rational::dyadic(&Integer::ONE, 1);
        let form = |p: &MultiPoly, at_infinity: bool| {
            let mut coeffs: Vec<UniPoly> =
                p.as_poly_in(1).coeffs().iter().map(|c| c.to_univariate(0).expect("one variable is left")).collect();
            if at_infinity {
                coeffs.push(UniPoly::zero());
            }
            let constant = coeffs.iter().skip(1).all(UniPoly::is_zero) && !at_infinity;
            (!constant).then(|| Form { coeffs, rate: rate.clone() })
        };
        let finite = form(&rest, at_infinity && !nothing_there);
        let other = form(&(&of_a * &of_b), nothing_there);
        Forms { content, finite, other }
    }

    /// By how much the number of roots to the right grows as the parameter grows through the value at a zero: the sign of
    /// `Im(A conj B)` before and behind tells.
    ///
    /// The bracket is narrowed until no other frequency at which `Im(A conj B)` vanishes, too, is in it: an algebraic one,
    /// or one at which `A` or `B` does.
    pub(super) fn change(&self, zero: &AxisZero, fixed: &[RealAlgebraic], other: Option<&Jet>) -> i64 {
        let (mut lo, mut hi) = (zero.lo.clone(), zero.hi.clone());
        for bits in doubling(8) {
            let is_alone = !fixed.iter().any(|w| w.compare_rational(&lo).is_ge() && w.compare_rational(&hi).is_le())
                && other.is_none_or(|jet| jet.stays_away(&lo, &hi));
            if is_alone {
                break;
            }
            (lo, hi) = zero.refined(bits, Some((lo, hi)));
        }
        match (self.sign(&lo), self.sign(&hi)) {
            (Sign::Greater, Sign::Less) => 2,
            (Sign::Less, Sign::Greater) => -2,
            _ => 0,
        }
    }

    /// The sign of `Im(A conj B)` at a rational frequency that is no zero.
    fn sign(&self, omega: &Rational) -> Sign {
        until_shown(64, |scale| {
            let [a, b] = self.values(&Enclosure::from_rational(omega.clone()), scale);
            let product = a.times(&conjugate(&b), scale);
            (product.im.abs() > product.error).then(|| product.im.sign())
        })
    }

    /// `A` and `B` at `i omega`, in units of `2^-scale`.
    fn values(&self, omega: &Enclosure, scale: u64) -> [Fixed; 2] {
        let middle = omega.lower().midpoint(omega.upper());
        let radius = (omega.upper() - omega.lower()) * Rational::dyadic(&Integer::ONE, 1);
        let guarded = scale + 8;
        let z = turned(&(&middle * &self.gain.tau), guarded);
        let mut powers = vec![Fixed::one(guarded)];
        for k in 1..self.gain.a.len() {
            powers.push(powers[k - 1].times(&z, guarded));
        }
        let unit = Rational::from(&Integer::ONE << scale);
        let d = Rational::from(&self.gain.tau.denominator());
        [(&self.gain.a, &self.slopes[0]), (&self.gain.b, &self.slopes[1])].map(|(parts, slope)| {
            let zero = Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
            let mut sum = parts
                .iter()
                .zip(&powers)
                .filter(|(p, _)| !p.is_zero())
                .fold(zero, |sum, (p, power)| sum.plus(&rational_on_axis(p, &middle, scale).times(power, guarded)));
            if !radius.is_zero() {
                let moved = slope.eval_rational(omega.upper()) / &d * &radius * &unit;
                sum.error += moved.ceil();
            }
            sum
        })
    }

    /// `-A/B` at an enclosed frequency at which it is real; `None` where too little is known.
    fn gain_at(&self, omega: &Enclosure, scale: u64) -> Option<Enclosure> {
        let [a, b] = self.values(omega, scale);
        let product = a.times(&conjugate(&b), scale);
        let square = b.times(&conjugate(&b), scale);
        let enclosed =
            |x: &Integer, error: &Integer| Enclosure::new(Rational::from(&(x - error)), Rational::from(&(x + error)));
        enclosed(&product.re, &product.error).neg().div(&enclosed(&square.re, &square.error), scale)
    }

    pub(super) fn fixed_frequency(&self, omega: &RealAlgebraic, budget: &Budget) -> Result<Fixture, Exhausted> {
        // The real and the imaginary part of every coefficient of z vanish.
        let vanish = |parts: &[UniPoly]| {
            parts.iter().all(|p| {
                let (even, odd) = even_odd(p);
                omega.sign_of(&on_axis(&even)).is_eq() && omega.sign_of(&on_axis(&odd)).is_eq()
            })
        };
        let (no_a, no_b) = budget.enter(|| (vanish(&self.gain.a), vanish(&self.gain.b)))?;
        Ok(match (no_a, no_b) {
            (true, true) => Fixture::Never,
            (false, true) => Fixture::NoGain,
            (true, false) => {
                let (lo, hi) = self.around(omega, budget)?;
                Fixture::Zero(match (budget.enter(|| self.sign(&lo))?, budget.enter(|| self.sign(&hi))?) {
                    (Sign::Greater, Sign::Less) => 2,
                    (Sign::Less, Sign::Greater) => -2,
                    _ => 0,
                })
            }
            (false, false) => Fixture::Unknown,
        })
    }

    /// Rational frequencies on both sides of an algebraic one, between which `Im(A conj B)` has no other zero: between them
    /// neither the form nor the other zeros of the content vanish.
    fn around(&self, omega: &RealAlgebraic, budget: &Budget) -> Result<(Rational, Rational), Exhausted> {
        let Forms { content, finite, other } = budget.enter(|| self.forms())?;
        let mut bits = 8;
        loop {
            budget.check()?;
            let (lo, hi) = omega.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
            let unit = Rational::dyadic(&Integer::ONE, bits);
            let (lo, hi) = (lo - &unit, hi + &unit);
            bits += 8;
            if !lo.sign().is_gt() || content.sign_at(&lo).is_eq() || content.sign_at(&hi).is_eq() {
                continue;
            }
            let alone = match budget.enter(|| SquareFree::part_of(&content))? {
                Some(part) => isolate_real_roots_in(&part, Some(&lo), Some(&hi), budget)?.len() == 1,
                None => true,
            };
            let mut quiet = true;
            for form in [&finite, &other].into_iter().flatten() {
                quiet = quiet && budget.enter(|| Jet::new(form.clone()).stays_away(&lo, &hi))?;
            }
            if alone && quiet {
                return Ok((lo, hi));
            }
        }
    }
}

/// The zeros of `Im(A conj B)`: all simple, but those of the content.
pub(super) struct Forms {
    /// The factor in the frequency alone.
    pub content: UniPoly,
    /// Where the parameter is real, finite and not zero; `None` when it is nowhere.
    pub finite: Option<Form>,
    /// Where `A` or `B` vanishes with a whole factor that is its own mirror image in the axis: for no finite value of the
    /// parameter, or for zero only, for which the difference operator is not stable then.
    pub other: Option<Form>,
}

/// The real or the imaginary part.
#[derive(Clone, Copy)]
enum Part {
    Real,
    Imaginary,
}

/// `Re(A conj B)` or `Im(A conj B)` on the axis: the coefficients, polynomials in the frequency, of `sin^j cos^(2q - j)` of
/// half the angle.
fn product(a: &[UniPoly], b: &[UniPoly], part: Part) -> Vec<UniPoly> {
    let q = a.len() - 1;
    // A(s, z) B(-s, 1/z) = sum C_m(s) z^m, of which either part is sum a_m cos(m x) + b_m sin(m x).
    let mut cosines = vec![UniPoly::zero(); q + 1];
    let mut sines = vec![UniPoly::zero(); q + 1];
    for (k, a) in a.iter().enumerate() {
        for (l, b) in b.iter().enumerate() {
            let (even, odd) = even_odd(&a.times(&b.negated_argument()));
            let (even, odd) = (on_axis(&even), on_axis(&odd).shifted_up(1));
            let m = k.abs_diff(l);
            // (even + i odd)(cos((k - l) x) - i sin((k - l) x))
            let (cosine, sine) = match part {
                Part::Real => (even, odd),
                Part::Imaginary => (odd, even.negated()),
            };
            cosines[m] = cosines[m].plus(&cosine);
            sines[m] = if k >= l { sines[m].plus(&sine) } else { sines[m].minus(&sine) };
        }
    }
    let mut form = vec![UniPoly::zero(); 2 * q + 1];
    for m in 0..=q {
        // cos(m x) + i sin(m x) = (c + i s)^(2 m), times (c^2 + s^2)^(q - m).
        let [real, imaginary] = power_of_turn(2 * m);
        let rest = UniPoly::from_i64(&[1, 0, 1]).power((q - m) as u64);
        for (weights, factor) in [(real, &cosines[m]), (imaginary, &sines[m])] {
            for (j, c) in weights.times(&rest).coeffs().iter().enumerate() {
                form[j] = form[j].plus(&factor.scaled(c));
            }
        }
    }
    form
}

/// A polynomial in the frequency (0) and the tangent of half the angle (1).
fn bivariate(coeffs: &[UniPoly]) -> MultiPoly {
    let terms = coeffs.iter().map(|p| MultiPoly::from_univariate(p, 0));
    MultiPoly::from_poly_in(&Poly::new(terms.collect()), 1)
}

/// The positive zeros of a polynomial in the frequency.
pub(super) fn algebraic_frequencies(content: &UniPoly, budget: &Budget) -> Result<Vec<RealAlgebraic>, Exhausted> {
    let Some(part) = budget.enter(|| SquareFree::part_of(content))? else { return Ok(Vec::new()) };
    isolate_real_roots_in(&part, Some(&Rational::ZERO), None, budget)
}

/// `p(-x^2)` of a polynomial in `s^2`.
pub(super) fn on_axis(p: &UniPoly) -> UniPoly {
    p.compose(&UniPoly::from_i64(&[0, 0, -1]))
}

/// Real and imaginary part of `(c + i s)^n` by powers of `s` (and `c` for the rest).
fn power_of_turn(n: usize) -> [UniPoly; 2] {
    let (mut real, mut imaginary) = (vec![Integer::ZERO; n + 1], vec![Integer::ZERO; n + 1]);
    let mut binomial = Integer::ONE;
    for j in 0..=n {
        let signed = if j % 4 < 2 { binomial.clone() } else { -&binomial };
        if j % 2 == 0 {
            real[j] = signed
        } else {
            imaginary[j] = signed
        }
        binomial = (&binomial * &Integer::from((n - j) as i64)).div_mod_floor(&Integer::from(j as i64 + 1)).0;
    }
    [UniPoly::new(real), UniPoly::new(imaginary)]
}

pub(super) fn absolute(p: &UniPoly) -> UniPoly {
    UniPoly::new(p.coeffs().iter().map(Integer::abs).collect())
}

fn conjugate(x: &Fixed) -> Fixed {
    Fixed { re: x.re.clone(), im: -&x.im, error: x.error.clone() }
}

/// `p(i omega)` at a rational frequency, in units of `2^-scale`.
fn rational_on_axis(p: &UniPoly, omega: &Rational, scale: u64) -> Fixed {
    let (even, odd) = even_odd(p);
    let unit = Rational::from(&Integer::ONE << scale);
    let scaled = |x: Rational| (x * &unit).floor();
    let re = scaled(on_axis(&even).eval_rational(omega));
    let im = scaled(on_axis(&odd).eval_rational(omega) * omega);
    Fixed { re, im, error: Integer::ONE }
}

/// The value of the parameter at a zero.
#[derive(Debug)]
pub(super) struct GainAt {
    pub axis: Arc<Axis>,
    pub zero: Arc<AxisZero>,
}

impl Enclosing for GainAt {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let goal = Rational::dyadic(&Integer::ONE, bits);
        let mut working = bits + 32;
        let mut place = (self.zero.lo.clone(), self.zero.hi.clone());
        loop {
            place = self.zero.refined(working, Some(place));
            let omega = Enclosure::new(place.0.clone(), place.1.clone());
            if let Some(value) = self.axis.gain_at(&omega, working)
                && value.upper() - value.lower() <= goal
            {
                return value;
            }
            working += working / 2;
        }
    }

    fn origin(&self) -> Origin {
        let (lo, hi) = self.zero.refined(64, None);
        let omega = jurist_algebra::number::enclosed_decimal(&lo, &hi, 12).unwrap_or_else(|| lo.to_string());
        Origin::Function {
            function: "-A/B at i omega, where it is real".into(),
            details: vec![("tau".into(), self.axis.gain.tau.to_string()), ("omega".into(), omega)],
        }
    }
}

/// The frequency of a zero.
#[derive(Debug)]
pub(super) struct Frequency {
    pub zero: Arc<AxisZero>,
}

impl Enclosing for Frequency {
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure {
        let from = known.map(|k| (k.lower().clone(), k.upper().clone()));
        let (lo, hi) = self.zero.refined(bits, from);
        Enclosure::new(lo, hi)
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "Im(A conj B) at i omega".into(), details: Vec::new() }
    }
}
