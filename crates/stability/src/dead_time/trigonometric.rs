//! Zeros of `sum H_j(w) sin(w h)^j cos(w h)^(d - j)` on the positive axis, isolated and refined with proof.

use super::dyadic::{Dyadic, Step};
use super::turn::{Fixed, turned};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, UniPoly};
use std::sync::Arc;

/// The form of degree `d` in sine and cosine of `w h` with the coefficients `H_0, ..., H_d`.
#[derive(Clone, Debug)]
pub(super) struct Form {
    pub coeffs: Vec<UniPoly>,
    /// `h`.
    pub rate: Rational,
}

impl Form {
    /// The derivative times the denominator of the rate: a form of the same degree.
    fn derivative(&self) -> Form {
        let (a, d) = (self.rate.numerator(), self.rate.denominator());
        let top = self.coeffs.len() - 1;
        let zero = UniPoly::zero();
        let at = |j: usize| self.coeffs.get(j).unwrap_or(&zero);
        let coeffs = (0..=top).map(|j| {
            let up = at(j + 1).scaled(&(&a * &Integer::from(j as i64 + 1)));
            let down = match j {
                0 => UniPoly::zero(),
                _ => at(j - 1).scaled(&(&a * &Integer::from((top - j) as i64 + 1))),
            };
            at(j).derivative().scaled(&d).plus(&up).minus(&down)
        });
        Form { coeffs: coeffs.collect(), rate: self.rate.clone() }
    }

    /// The sum of the moduli of all terms, with sine and cosine at most one.
    fn absolute_at(&self, w: &Rational) -> Rational {
        let absolute = self
            .coeffs
            .iter()
            .fold(UniPoly::zero(), |sum, p| sum.plus(&UniPoly::new(p.coeffs().iter().map(Integer::abs).collect())));
        absolute.eval_rational(w)
    }

    /// The value at `w = 0`: that of the first coefficient.
    fn at_zero(&self) -> Integer {
        self.coeffs[0].coeff(0)
    }

    /// The exact order of the zero at `w = 0` of a form that is not identically zero.
    fn order_at_zero(&self) -> usize {
        let mut form = self.clone();
        let mut order = 0;
        while form.at_zero().is_zero() {
            form = form.derivative();
            order += 1;
        }
        order
    }
}

/// The powers of cosine and sine at a point, in units of `2^-scale`.
fn powers(w: &Dyadic, rate: &Rational, degree: usize, scale: u64) -> Vec<Fixed> {
    let turn = turned(&(w.rational() * rate), scale);
    let real = |x: Integer| Fixed { re: x, im: Integer::ZERO, error: turn.error.clone() };
    let (cos, sin) = (real(turn.re.clone()), real(-&turn.im));
    let list = |x: &Fixed| {
        let mut out = vec![Fixed::one(scale)];
        for i in 0..degree {
            out.push(out[i].times(x, scale));
        }
        out
    };
    let (cosines, sines) = (list(&cos), list(&sin));
    (0..=degree).map(|j| sines[j].times(&cosines[degree - j], scale)).collect()
}

/// A polynomial's value at a point, in units of `2^-scale`.
fn value(p: &UniPoly, w: &Dyadic, scale: u64) -> Fixed {
    let n = p.coeffs().len().max(1) - 1;
    let mut sum = Integer::ZERO;
    let mut power = Integer::ONE;
    for (j, c) in p.coeffs().iter().enumerate() {
        sum += (c * &power) << (w.e * (n - j) as u64);
        power = &power * &w.m;
    }
    let shift = w.e * n as u64;
    let re = if shift >= scale { sum >> (shift - scale) } else { sum << (scale - shift) };
    Fixed { re, im: Integer::ZERO, error: Integer::ONE }
}

/// A form and its first derivatives; the last one only bounds the remainder.
#[derive(Clone, Debug)]
pub(super) struct Jet {
    forms: [Form; 4],
}

impl Jet {
    pub fn new(form: Form) -> Jet {
        let first = form.derivative();
        let second = first.derivative();
        let third = second.derivative();
        Jet { forms: [form, first, second, third] }
    }

    /// Value and two derivatives, each times a power of the rate's denominator, in units of `2^-scale`.
    fn values(&self, w: &Dyadic, scale: u64) -> [Fixed; 3] {
        let guarded = scale + 8;
        let degree = self.forms[0].coeffs.len() - 1;
        // Some ten operations for each product of two numbers, and two for each term.
        let terms: usize = self.forms[..3].iter().flat_map(|form| &form.coeffs).map(|p| p.coeffs().len()).sum();
        checkpoint(512 + (scale / 64) * (6 * 64 * (degree as u64 + 1) + 12 * terms as u64));
        let basis = powers(w, &self.forms[0].rate, degree, guarded);
        [0, 1, 2].map(|i| {
            let zero = Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
            self.forms[i].coeffs.iter().zip(&basis).fold(zero, |sum, (p, b)| {
                if p.is_zero() { sum } else { sum.plus(&value(p, w, scale).times(b, guarded)) }
            })
        })
    }

    /// Whether the form is proved to have no zero in an interval.
    pub fn stays_away(&self, lo: &Rational, hi: &Rational) -> bool {
        let half = hi - lo;
        if half.is_zero() {
            return false;
        }
        matches!(self.look(&Dyadic::within(lo, hi), &half), Seen::Nothing)
    }

    /// What the derivatives at a point tell of the interval within a distance from it.
    fn look(&self, middle: &Dyadic, half: &Rational) -> Seen {
        let mut scale = 64;
        while Rational::dyadic(&Integer::ONE, (scale - 64) / 2) > *half {
            scale += 32;
        }
        let [zeroth, first, second] = self.values(middle, scale);
        let ratio = half / &Rational::from(&self.forms[0].rate.denominator());
        let rest = self.forms[3].absolute_at(&(middle.rational() + half))
            * Rational::from(&(&Integer::ONE << scale))
            * &ratio
            * &ratio;
        let at_most = |x: &Fixed| Rational::from(&(x.re.abs() + &x.error));
        let at_least = |x: &Fixed| Rational::from(&(x.re.abs() - &x.error));
        let two = Rational::from(2);
        let curved = at_most(&second) * &ratio;
        // |f(m + h) - f(m)| <= |f'| r + |f''| r^2/2 + max |f'''| r^3/6.
        let moved = (at_most(&first) + &curved / &two + &rest / &Rational::from(6)) * &ratio;
        if at_least(&zeroth) > moved {
            return Seen::Nothing;
        }
        if at_least(&first) > curved + rest / two { Seen::Monotone } else { Seen::TooMuch }
    }

    /// The sign at a point where the form does not vanish.
    fn sign(&self, w: &Dyadic) -> Sign {
        until_shown(64, |scale| {
            let [value, ..] = self.values(w, scale);
            (value.re.abs() > value.error).then(|| value.re.sign())
        })
    }
}

/// A zero of a form, simple and alone in an interval whose ends are no zeros.
#[derive(Clone, Debug)]
pub(super) struct AxisZero {
    jet: Arc<Jet>,
    pub lo: Rational,
    pub hi: Rational,
    rising: bool,
}

/// Walks along the positive axis from zero to zero.
pub(super) struct Zeros {
    jet: Arc<Jet>,
    at: Dyadic,
    step: Step,
}

impl Zeros {
    /// Starts beyond a point up to which the form has no positive zero. The form is not to vanish at an algebraic number
    /// other than zero, and all its positive zeros are to be simple.
    pub fn new(form: Form) -> Zeros {
        let order = form.order_at_zero();
        let mut lowest = form.clone();
        for _ in 0..order {
            lowest = lowest.derivative();
        }
        // f^(m) stays away from zero, the derivatives below it vanish at zero: so does none of them before f^(m) does.
        let value = Rational::from(&(lowest.at_zero().abs() * &form.rate.denominator()));
        let next = lowest.derivative();
        let mut e = 0;
        while next.absolute_at(&Rational::dyadic(&Integer::ONE, e)) * Rational::dyadic(&Integer::ONE, e) >= value {
            e += 1;
        }
        let at = Dyadic { m: Integer::ONE, e };
        Zeros { jet: Arc::new(Jet::new(form)), at, step: Step(-(e as i64)) }
    }

    /// The next zero that begins below a bound; `None` once the walk has come to the bound.
    pub fn next_below(&mut self, bound: &Rational, budget: &Budget) -> Result<Option<AxisZero>, Exhausted> {
        while self.at.rational() < *bound {
            budget.check()?;
            match budget.enter(|| self.look())? {
                Seen::Nothing => {
                    self.at = self.at.plus(self.step, 0);
                    self.step = Step(self.step.0 + 1);
                }
                Seen::TooMuch => self.step = Step(self.step.0 - 1),
                Seen::Monotone => {
                    let from = self.at.clone();
                    self.at = self.at.plus(self.step, 0);
                    let zero = budget.enter(|| {
                        let (before, after) = (self.jet.sign(&from), self.jet.sign(&self.at));
                        (before != after).then(|| after.is_gt())
                    })?;
                    if let Some(rising) = zero {
                        let (lo, hi) = (from.rational(), self.at.rational());
                        return Ok(Some(AxisZero { jet: Arc::clone(&self.jet), lo, hi, rising }));
                    }
                }
            }
        }
        Ok(None)
    }

    fn look(&self) -> Seen {
        self.jet.look(&self.at.plus(self.step, 1), &self.step.half())
    }
}

enum Seen {
    Nothing,
    Monotone,
    TooMuch,
}

impl AxisZero {
    /// The zero in an interval of width at most `2^-bits`: Newton's method with intervals, halving where it does not gain.
    pub fn refined(&self, bits: u64, from: Option<(Rational, Rational)>) -> (Rational, Rational) {
        let (mut lo, mut hi) = from.unwrap_or((self.lo.clone(), self.hi.clone()));
        let goal = Rational::dyadic(&Integer::ONE, bits);
        while &hi - &lo > goal {
            let width = &hi - &lo;
            let middle = Dyadic::within(&lo, &hi);
            let m = middle.rational();
            let mut scale = 64;
            while Rational::dyadic(&Integer::ONE, scale / 4) > width {
                scale *= 2;
            }
            let [zeroth, first, second] = self.jet.values(&middle, scale);
            if zeroth.re.abs() > zeroth.error {
                // Known on which side it is.
                if zeroth.re.sign().is_gt() == self.rising { hi = m.clone() } else { lo = m.clone() }
            }
            let d = Rational::from(&self.jet.forms[0].rate.denominator());
            let unit = Rational::dyadic(&Integer::ONE, scale);
            let enclosed = |x: &Fixed, factor: &Rational| {
                let at = |y: Integer| Rational::from(&y) * &unit / factor;
                Enclosure::new(at(&x.re - &x.error), at(&x.re + &x.error))
            };
            let one = Rational::ONE;
            let third = self.jet.forms[3].absolute_at(&hi) / (&d * &d * &d);
            let spread = {
                let second = enclosed(&second, &(&d * &d));
                let bend = second.lower().abs().max(second.upper().abs());
                &bend * &width + third * &width * &width
            };
            let slope = enclosed(&first, &d);
            let slope = Enclosure::new(slope.lower() - &spread, slope.upper() + &spread);
            if let Some(quotient) = enclosed(&zeroth, &one).div(&slope, scale) {
                lo = lo.max(&m - quotient.upper());
                hi = hi.min(&m - quotient.lower());
            }
            // Short ends: the numbers are to have as many bits as they tell.
            let mut keep = 16;
            while Rational::dyadic(&Integer::ONE, keep) > (&hi - &lo) * Rational::dyadic(&Integer::ONE, 6) {
                keep += 16;
                if keep > 4 * bits + 256 {
                    break;
                }
            }
            let grid = Rational::from(&Integer::ONE << keep);
            let (outer_lo, outer_hi) = ((&lo * &grid).floor(), (&hi * &grid).ceil());
            lo = Rational::from(&outer_lo) / &grid;
            hi = Rational::from(&outer_hi) / &grid;
        }
        (lo, hi)
    }
}
