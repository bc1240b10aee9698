//! A loop with dead time and one parameter anywhere, on the line `Re s = -decay`: values and derivatives with bounds.

use super::turn::{Fixed, turned};
use jurist_algebra::ball::{Ball, exp};
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use std::fmt;
use std::sync::Arc;

/// A straight line in the parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The slope.
    pub slope: Rational,
    /// The value at zero.
    pub offset: Rational,
}

impl Line {
    /// A number, whatever the parameter is.
    pub fn constant(value: Rational) -> Line {
        Line { slope: Rational::ZERO, offset: value }
    }

    /// The value.
    pub fn at(&self, p: &Rational) -> Rational {
        p * &self.slope + &self.offset
    }

    /// Whether it is zero everywhere.
    pub fn is_zero(&self) -> bool {
        self.slope.is_zero() && self.offset.is_zero()
    }
}

/// `numerator 2^exponent`: a point of a grid that gets finer.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub numerator: Integer,
    pub exponent: i64,
}

impl Grid {
    pub fn rational(&self) -> Rational {
        power_of_two(self.exponent) * Rational::from(&self.numerator)
    }

    /// The greatest multiple of `2^exponent` that is not above a number.
    pub fn below(x: &Rational, exponent: i64) -> Grid {
        Grid { numerator: (x * &power_of_two(-exponent)).floor(), exponent }
    }

    /// Numerator and negated exponent, which is not negative.
    fn parts(&self) -> (Integer, u64) {
        match u64::try_from(self.exponent) {
            Ok(up) => (&self.numerator << up, 0),
            Err(_) => (self.numerator.clone(), self.exponent.unsigned_abs()),
        }
    }
}

pub(super) fn power_of_two(exponent: i64) -> Rational {
    match u64::try_from(exponent) {
        Ok(up) => Rational::from(&(&Integer::ONE << up)),
        Err(_) => Rational::dyadic(&Integer::ONE, exponent.unsigned_abs()),
    }
}

/// A polynomial in the frequency and the parameter, as its terms.
#[derive(Clone, Debug)]
struct Terms {
    list: Vec<(usize, usize, Integer)>,
    degrees: (usize, usize),
}

/// Real and imaginary part of the factor of each exponential, in the frequency (0) and the parameter (1).
type Factors = Vec<[MultiPoly; 2]>;

impl Terms {
    fn of(p: &MultiPoly) -> Terms {
        let list = p.terms().iter().map(|(m, c)| (m.exponent(0) as usize, m.exponent(1) as usize, c.clone())).collect();
        Terms { list, degrees: (p.degree_in(0) as usize, p.degree_in(1) as usize) }
    }
}

/// Powers of both variables at a point.
struct Powers {
    omega: Vec<Integer>,
    p: Vec<Integer>,
    shifts: (u64, u64),
}

impl Powers {
    fn new(omega: &Grid, p: &Grid, degrees: (usize, usize)) -> Powers {
        let list = |(x, shift): (Integer, u64), degree: usize| {
            let mut out = vec![Integer::ONE];
            for i in 0..degree {
                out.push(&out[i] * &x);
            }
            (out, shift)
        };
        let (omega, e) = list(omega.parts(), degrees.0);
        let (p, f) = list(p.parts(), degrees.1);
        Powers { omega, p, shifts: (e, f) }
    }

    /// The value, or the sum of the moduli of all terms, rounded down, in units of `2^-scale`.
    fn value(&self, terms: &Terms, absolute: bool, scale: u64) -> Integer {
        let (e, f) = self.shifts;
        let mut sum = Integer::ZERO;
        for (i, j, c) in &terms.list {
            let term = &(&self.omega[*i] * &self.p[*j]) * c;
            let term = if absolute { term.abs() } else { term };
            sum += term << (e * (terms.degrees.0 - i) as u64 + f * (terms.degrees.1 - j) as u64);
        }
        let shift = e * terms.degrees.0 as u64 + f * terms.degrees.1 as u64;
        if shift >= scale { sum >> (shift - scale) } else { sum << (scale - shift) }
    }
}

/// `f(omega, p) = sum P_k(i omega; p) exp(k tau(p) (decay(p) - i omega))` and its derivatives up to the second order, those
/// of order `n` multiplied by `unit^n`.
#[derive(Clone, Debug)]
pub(super) struct Function {
    /// `f`, `f_w`, `f_p`, `f_ww`, `f_wp`, `f_pp`: real and imaginary part of the factor of each exponential.
    sets: [Vec<[Terms; 2]>; 6],
    /// How far these may be off where coefficients are enclosed; empty where they are exact.
    errors: [Vec<[Terms; 2]>; 6],
    degrees: (usize, usize),
    pub unit: Integer,
    tau: Line,
    decay: Line,
    source: Option<Source>,
}

/// Whence a function with enclosed coefficients has them.
#[derive(Clone)]
struct Source {
    bits: u64,
    at: Arc<dyn Fn(u64) -> Function + Send + Sync>,
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "coefficients with {} bits", self.bits)
    }
}

/// What is known of the function about a point.
pub(super) struct Local {
    pub value: Fixed,
    pub by_omega: Fixed,
    pub by_p: Fixed,
    /// Upper bounds of the moduli of the second derivatives.
    pub second: [Integer; 3],
}

/// What the factors of the exponentials are multiplied by where a derivative is taken, over a common unit.
struct Slopes {
    unit: Integer,
    /// The dead time.
    delay: MultiPoly,
    /// The slope of the growth `tau(p) decay(p)`.
    growth: MultiPoly,
    /// The frequency times the slope of the dead time.
    turning: MultiPoly,
    /// Of bounds of moduli: no term is subtracted.
    of_bounds: bool,
}

impl Slopes {
    fn minus(&self, a: MultiPoly, b: MultiPoly) -> MultiPoly {
        if self.of_bounds { &a + &b } else { &a - &b }
    }

    fn by_omega(&self, set: &[[MultiPoly; 2]]) -> Factors {
        let one = |(k, [re, im]): (usize, &[MultiPoly; 2])| {
            let times = self.delay.scaled_by(&Integer::from(k as i64));
            [
                &re.derivative(0).scaled_by(&self.unit) + &(&times * im),
                self.minus(im.derivative(0).scaled_by(&self.unit), &times * re),
            ]
        };
        set.iter().enumerate().map(one).collect()
    }

    fn by_p(&self, set: &[[MultiPoly; 2]]) -> Factors {
        let one = |(k, [re, im]): (usize, &[MultiPoly; 2])| {
            let k = Integer::from(k as i64);
            let (real, imaginary) = (self.growth.scaled_by(&k), self.turning.scaled_by(&k));
            [
                &re.derivative(1).scaled_by(&self.unit) + &(&(&real * re) + &(&imaginary * im)),
                &im.derivative(1).scaled_by(&self.unit) + &self.minus(&real * im, &imaginary * re),
            ]
        };
        set.iter().enumerate().map(one).collect()
    }

    fn all(&self, zeroth: Factors) -> [Vec<[Terms; 2]>; 6] {
        let (w, p) = (self.by_omega(&zeroth), self.by_p(&zeroth));
        let (ww, wp, pp) = (self.by_omega(&w), self.by_p(&w), self.by_p(&p));
        let terms = |[re, im]: &[MultiPoly; 2]| [Terms::of(re), Terms::of(im)];
        [zeroth, w, p, ww, wp, pp].map(|set| set.iter().map(terms).collect())
    }

    /// Those of bounds.
    fn in_moduli(&self) -> Slopes {
        let [delay, growth, turning] = [&self.delay, &self.growth, &self.turning].map(in_moduli);
        Slopes { unit: self.unit.clone(), delay, growth, turning, of_bounds: true }
    }
}

impl Function {
    /// From the coefficients of `z^k s^j` at `[k][j]`, `s` being counted from the line, and bounds of their errors in the same places, none where they are
    /// exact.
    pub fn new(parts: &[Vec<UniPoly>], errors: &[Vec<UniPoly>], tau: &Line, decay: &Line) -> Function {
        // tau(p), its slope, and the slope of the growth tau(p) decay(p), over one denominator.
        let growth_slope =
            [&tau.slope * &decay.offset + &tau.offset * &decay.slope, &tau.slope * &decay.slope * Rational::from(2)];
        let numbers = [&tau.slope, &tau.offset, &growth_slope[0], &growth_slope[1]];
        let unit = numbers.iter().fold(Integer::ONE, |l, x| l.lcm(&x.denominator()));
        let whole = |x: &Rational| (x * &Rational::from(&unit)).numerator();
        let line = |offset: &Rational, slope: &Rational| {
            MultiPoly::from_univariate(&UniPoly::new(vec![whole(offset), whole(slope)]), 1)
        };
        let slopes = Slopes {
            delay: line(&tau.offset, &tau.slope),
            growth: line(&growth_slope[0], &growth_slope[1]),
            turning: MultiPoly::variable(0).scaled_by(&whole(&tau.slope)),
            unit: unit.clone(),
            of_bounds: false,
        };
        let sets = slopes.all(parts.iter().map(|part| on_line(part)).collect());
        let bounds = |part: &Vec<UniPoly>| on_line(part).map(|p| in_moduli(&p));
        let errors = slopes.in_moduli().all(errors.iter().map(bounds).collect());
        let all = || sets.iter().chain(&errors).flatten().flatten();
        let degrees = (all().map(|t| t.degrees.0).max().unwrap_or(0), all().map(|t| t.degrees.1).max().unwrap_or(0));
        Function { degrees, sets, errors, unit, tau: tau.clone(), decay: decay.clone(), source: None }
    }

    /// The same with coefficients of so many bits, from which those with more are made.
    pub fn with_source(self, bits: u64, at: impl Fn(u64) -> Function + Send + Sync + 'static) -> Function {
        Function { source: Some(Source { bits, at: Arc::new(at) }), ..self }
    }

    /// The function with coefficients of so many bits; `None` where they are exact, or have as many.
    pub fn finer(&self, bits: u64) -> Option<Function> {
        let source = self.source.as_ref().filter(|source| source.bits < bits)?;
        Some(Function { source: Some(Source { bits, ..source.clone() }), ..(source.at)(bits) })
    }

    /// Value and first derivatives at a point, and bounds of the second ones within distances from it, all in units of
    /// `2^-scale`.
    pub fn local(&self, at: (&Grid, &Grid), within: (&Rational, &Rational), scale: u64) -> Local {
        checkpoint(512);
        let (omega, p) = (at.0.rational(), at.1.rational());
        let guarded = scale + 8;
        let mut turn = turned(&(&omega * &self.tau.at(&p)), guarded);
        if !self.decay.is_zero() {
            turn = turn.times(&exponential(&(self.tau.at(&p) * self.decay.at(&p)), guarded), guarded);
        }
        let mut exponentials = vec![Fixed::one(guarded)];
        for k in 1..self.sets[0].len() {
            exponentials.push(exponentials[k - 1].times(&turn, guarded));
        }
        let powers = Powers::new(at.0, at.1, self.degrees);
        let [value, by_omega, by_p] = [0, 1, 2].map(|i| {
            let zero = Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
            self.sets[i].iter().zip(&exponentials).enumerate().fold(zero, |sum, (k, ([re, im], e))| {
                let error = self.error(&powers, [i, k], scale);
                if re.list.is_empty() && im.list.is_empty() && error.is_zero() {
                    return sum;
                }
                let (re, im) = (powers.value(re, false, scale), powers.value(im, false, scale));
                sum.plus(&Fixed { re, im, error: error + Integer::ONE }.times(e, guarded))
            })
        });
        let far = |x: &Rational, within: &Rational| {
            let x = x.abs() + within;
            Grid::below(&x, BOUND_GRID.min(floor_log(&x) - 16)).above()
        };
        let (far_omega, far_p) = (far(&omega, within.0), far(&p, within.1));
        let outer = Powers::new(&far_omega, &far_p, self.degrees);
        let largest = self.largest_exponential(&p, within.1);
        let second = [3, 4, 5].map(|i| {
            let mut weight = Rational::ONE;
            let mut sum = Integer::ZERO;
            for (k, [re, im]) in self.sets[i].iter().enumerate() {
                let both = outer.value(re, true, scale) + outer.value(im, true, scale) + Integer::from(2);
                let both = both + (self.error(&outer, [i, k], scale) << 1);
                sum += (Rational::from(&both) * &weight).ceil();
                weight = &weight * &largest;
            }
            sum
        });
        Local { value, by_omega, by_p, second }
    }

    /// A bound of the errors of both parts of a factor that come from its coefficients.
    fn error(&self, powers: &Powers, [set, k]: [usize; 2], scale: u64) -> Integer {
        let Some([re, im]) = self.errors[set].get(k) else { return Integer::ZERO };
        let bound = |terms: &Terms| match terms.list.is_empty() {
            true => Integer::ZERO,
            false => powers.value(terms, true, scale) + Integer::ONE,
        };
        bound(re) + bound(im)
    }

    /// A bound of `exp(tau decay)` within a distance from a value of the parameter.
    fn largest_exponential(&self, p: &Rational, within: &Rational) -> Rational {
        if self.decay.is_zero() {
            return Rational::ONE;
        }
        let ends = [p - within, p + within];
        let most = |line: &Line| ends.iter().map(|x| line.at(x).abs()).max().expect("two ends");
        upper_exponential(&(most(&self.tau) * most(&self.decay)))
    }
}

const BOUND_GRID: i64 = -8;

fn floor_log(x: &Rational) -> i64 {
    x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64 - 1
}

impl Grid {
    /// The next multiple.
    fn above(mut self) -> Grid {
        self.numerator += Integer::ONE;
        self
    }
}

/// A bound of the modulus at the moduli of both variables.
fn in_moduli(p: &MultiPoly) -> MultiPoly {
    MultiPoly::from_terms(p.terms().iter().map(|(m, c)| (m.exponents().to_vec(), c.abs())))
}

/// `P(i omega)` as real and imaginary part in the frequency (0) and the parameter (1).
fn on_line(coefficients: &[UniPoly]) -> [MultiPoly; 2] {
    let (mut re, mut im) = (vec![MultiPoly::zero(); coefficients.len()], vec![MultiPoly::zero(); coefficients.len()]);
    for (j, c) in coefficients.iter().enumerate() {
        let c = MultiPoly::from_univariate(c, 1);
        match j % 4 {
            0 => re[j] = c,
            1 => im[j] = c,
            2 => re[j] = c.negated(),
            _ => im[j] = c.negated(),
        }
    }
    [re, im].map(|list| MultiPoly::from_poly_in(&Poly::new(list), 0))
}

/// `exp(x)` as a number in units of `2^-scale`.
pub(super) fn exponential(x: &Rational, scale: u64) -> Fixed {
    let ball = exp(&Ball::from_rational(x, scale + 8));
    let re = ball.middle_units() >> 8;
    Fixed { re, im: Integer::ZERO, error: (ball.width_units() >> 8) + Integer::from(2) }
}

/// A number of few bits that is not below `exp(x)`.
pub(super) fn upper_exponential(x: &Rational) -> Rational {
    let value = exponential(x, 24);
    Rational::dyadic(&(value.re + value.error), 24)
}
