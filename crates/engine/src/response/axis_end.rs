//! Where along a parameter a requirement on margins of a loop with dead time begins or ceases to be met.
//!
//! There a crossing reaches the edge of what is allowed, or the distance to a circle its least value: a common zero of two functions of the
//! frequency and the parameter. An interval Newton step that maps a box into itself proves that the box has one zero
//! ([Moore1966](jurist_algebra::bibliography#moore1966)), and encloses it as narrowly as is asked.

use super::along_circle::Coefficient;
use super::asked_functions::{Function, Functions};
use super::enclosed::enclosed;
use super::loop_functions::LoopFunctions;
use super::on_axis::OnAxis;
use super::requirement::Rule;
use super::taylor_along::of_octave;
use crate::stability::{Range, zeros_in};
use jurist_algebra::ball::{Ball, Series, cos_sin};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::Domain;
use jurist_algebra::real::Real;
use jurist_algebra::symbols::ParametricSymbols;

/// A number with its derivative by the parameter, as the first two terms of a series.
impl Coefficient for Series {
    fn plus(&self, other: &Series) -> Series {
        self.add(other)
    }

    fn times(&self, other: &Series) -> Series {
        self.mul(other)
    }

    fn scaled(&self, n: &Integer) -> Series {
        Series::scaled(self, n)
    }

    fn is_zero(&self) -> bool {
        self.coefficients().iter().all(Ball::is_zero)
    }
}

fn value(x: &Series) -> &Ball {
    &x.coefficients()[0]
}

fn slope(x: &Series) -> &Ball {
    &x.coefficients()[1]
}

/// A function of the frequency: its value, its derivative and half of its second derivative.
type Jet = [Ball; 3];

/// A function of the frequency and the parameter, and its derivative by the parameter.
struct Local {
    own: Jet,
    by_parameter: Jet,
}

/// Two functions of the frequency and the parameter, which is the only free name.
pub(super) struct AxisSystem {
    symbols: ParametricSymbols,
    functions: LoopFunctions,
    /// The unit of the frequency as a power of two.
    octave: i64,
    /// Which of the signs reaches zero.
    sign: usize,
    /// Whether it does so at the frequency 0, which does not move then.
    is_at_zero: bool,
}

/// Ends of the frequency and of the parameter.
pub(super) type Place = [[Rational; 2]; 2];

/// Bits beside those of the box in which a zero is looked for.
const BITS: u64 = 128;

/// What an end is called where its digits are explained.
const NAME: &str = "a value at which a margin is what is required";

/// Bits that the last step loses.
const SPARE_BITS: u64 = 48;

/// A box is narrowed so often at most.
const STEPS: usize = 64;

impl AxisSystem {
    /// Of the functions of a loop with dead time, in units of a frequency.
    pub fn new(symbols: &ParametricSymbols, functions: &LoopFunctions, octave: i64) -> AxisSystem {
        AxisSystem { symbols: symbols.clone(), functions: functions.clone(), octave, sign: 0, is_at_zero: false }
    }

    /// The only value of the parameter in a box at which what is required changes, if it is the only one: on the box, crossings move along the
    /// frequency without turning back, and the edge of what is allowed comes nearer all the time, or goes away. The inner one is `None` where that value
    /// does not lie between two that are given.
    pub fn only_end(mut self, place: &Place, between: [&Rational; 2]) -> Option<Option<Real>> {
        let bits = bits_in(place);
        let balls = place.each_ref().map(|[lower, upper]| Ball::between(lower, upper, bits));
        let (crossing, signs) = self.at(&balls)?;
        self.sign = only_zero(signs.iter().map(|f| &f.own[0]))?;
        let is_steady = match &crossing {
            Some(crossing) => !crossing.own[1].contains_zero(),
            None => !signs[self.sign].by_parameter[0].contains_zero(),
        };
        is_steady.then(|| self.found_in(place, between)).flatten()
    }

    /// The same of what is required at the frequency 0, where the open loop is real.
    pub fn only_end_at_zero(mut self, side: &[Rational; 2], between: [&Rational; 2]) -> Option<Option<Real>> {
        let place = [[Rational::ZERO, Rational::ZERO], side.clone()];
        let signs = self.at_zero(&Ball::between(&side[0], &side[1], bits_in(&place)))?;
        self.sign = only_zero(signs.iter().map(|[value, _]| value))?;
        self.is_at_zero = true;
        // The Newton step divides by the slope, which has no zero then.
        self.found_in(&place, between)
    }

    /// The zero in a box that has one at most, where a step proves that there is one.
    fn found_in(self, place: &Place, between: [&Rational; 2]) -> Option<Option<Real>> {
        let bits = bits_in(place);
        let (first, is_inside) = self.step(place, bits)?;
        let near = self.narrowed(first.clone(), bits).filter(|_| is_inside)?;
        if near.upper() < between[0] || near.lower() > between[1] {
            return Some(None);
        }
        if near.lower() < between[0] || near.upper() > between[1] {
            return None;
        }
        let exact = if self.is_at_zero { self.exact_at_zero(between) } else { None };
        let attempt = move |bits: u64| self.narrowed(first.clone(), bits);
        Some(Some(exact.unwrap_or_else(|| enclosed(NAME, attempt))))
    }

    /// The same of a distance to a circle that is least at the frequency 0 among those up to another one.
    pub fn only_least_at_zero(
        self,
        last: &Rational,
        side: &[Rational; 2],
        between: [&Rational; 2],
    ) -> Option<Option<Real>> {
        let is_distance = matches!(self.functions.rule(), Rule::Circle(_));
        (is_distance && self.rises(last, side)?).then(|| self.only_end_at_zero(side, between)).flatten()
    }

    /// Whether the distance rises with the frequency, from 0 to this one: its derivative by the square of the frequency is positive.
    fn rises(&self, last: &Rational, side: &[Rational; 2]) -> Option<bool> {
        let bits = bits_in(&[[Rational::ZERO, last.clone()], side.clone()]);
        let (functions, [tau, _]) = self.functions(&Ball::between(&side[0], &side[1], bits))?;
        let square = Ball::between(&Rational::ZERO, &(last * last), bits);
        let one = Ball::from_integer(&Integer::ONE, bits);
        let angle = tau.mul(&Ball::between(&Rational::ZERO, last, bits));
        // cos x is from 1 - x^2/2 to 1, and sin(x)/x from 1 - x^2/6.
        let below = |n: u64| one.sub(&angle.square().divided_by(n)).union(&one);
        let (cosine, quotient) = (below(2), below(6).mul(&tau));
        // The derivatives of cos(tau u) and sin(tau u)/u by u^2 are -tau/2 sin(tau u)/u, and not beyond tau^3/6.
        let cosine_by = tau.mul(&quotient).divided_by(2).neg();
        let cube = tau.mul(&tau.square()).divided_by(6);
        let quotient_by = cube.neg().union(&cube);
        let [p, c, s] = functions.signs.first()?;
        let even = |list: &[Series]| -> [Ball; 2] {
            let all: Vec<&Ball> = list.iter().step_by(2).map(value).collect();
            let zero = || Ball::zero(bits);
            all.iter().rev().fold([zero(), zero()], |[a, b], x| [a.mul(&square).add(x), b.mul(&square).add(&a)])
        };
        if [p, c, s].iter().any(|list| list.iter().skip(1).step_by(2).any(|x| !Coefficient::is_zero(x))) {
            return None;
        }
        let [[_, p], [c, c_by], [s, s_by]] = [p, c, s].map(|list| even(list));
        let slope = p.add(&c_by.mul(&cosine)).add(&c.mul(&cosine_by));
        let slope = slope.add(&s_by.mul(&quotient)).add(&s.mul(&quotient_by));
        Some(slope.sign().is_some_and(|sign| sign.is_gt()))
    }

    /// That end where what is required is rational. Of a factor `k N(0) = -D(0)` for it or its reciprocal; of a circle `q |D + N| = p |u D + v N|` at 0.
    fn exact_at_zero(&self, [lower, upper]: [&Rational; 2]) -> Option<Real> {
        let parts = self.functions.split(&self.functions.all)?;
        let [d, n] = [&parts.denominator[0], &parts.numerator[0].times(parts.content)].map(|p| p.to_univariate(0));
        let (d, n) = (d?, n?);
        let sum = |a: &Integer, b: &Integer| d.scaled(a).plus(&n.scaled(b));
        let both = match self.functions.rule() {
            Rule::Factors(factor) => {
                let factor = Real::from(factor.clone()).exact()?;
                let (p, q) = (factor.numerator(), factor.denominator());
                [sum(&q, &p), sum(&p, &q)]
            }
            Rule::Circle(circle) => {
                let [u, v] = circle.combined().map(Integer::from);
                let (p, q) = (circle.least().numerator(), circle.least().denominator());
                [&p, &-&p].map(|p| sum(&(&q + &(p * &u)), &(&q + &(p * &v))))
            }
            _ => return None,
        };
        let range = Range::between(Some(lower.clone()), Some(upper.clone()));
        let mut zeros = Vec::new();
        for f in both.iter().filter(|f| !f.is_constant()) {
            zeros.extend(zeros_in(f, &range, &Budget::unlimited()).ok()?);
        }
        zeros.pop().filter(|_| zeros.is_empty()).map(Real::from)
    }

    /// The signs at the frequency 0, and their slopes.
    fn at_zero(&self, parameter: &Ball) -> Option<Vec<[Ball; 2]>> {
        let (functions, tau) = self.functions(parameter)?;
        let tau = Series::new(tau.into());
        let value = |f: &Function<Series, 3>| {
            let [p, c, s] = f.each_ref().map(|list| &list[0]);
            let sum = p.add(c).add(&s.mul(&tau));
            [value(&sum).clone(), slope(&sum).clone()]
        };
        Some(functions.signs.iter().map(value).collect())
    }

    /// An enclosure of the parameter of a zero, with about so many bits; `None` where they are too few.
    fn narrowed(&self, mut place: Place, bits: u64) -> Option<Enclosure> {
        let goal = Rational::dyadic(&Integer::ONE, bits.saturating_sub(SPARE_BITS));
        for _ in 0..STEPS {
            let [lower, upper] = &place[1];
            if upper - lower <= goal {
                return Some(Enclosure::new(lower.clone(), upper.clone()));
            }
            place = self.step(&place, bits + BITS)?.0;
        }
        None
    }

    /// A Newton step of a box with at most one zero, and whether all of it is inside of the box: then there is one.
    fn step(&self, place: &Place, bits: u64) -> Option<(Place, bool)> {
        let over = place.each_ref().map(|[lower, upper]| Ball::between(lower, upper, bits));
        let middles = place.each_ref().map(|[lower, upper]| lower.midpoint(upper));
        let moves = self.moves(&over, &middles.each_ref().map(|x| Ball::from_rational(x, bits)))?;
        let mut is_inside = true;
        let mut next = place.clone();
        for ((side, by), middle) in next.iter_mut().zip(&moves).zip(&middles).skip(usize::from(self.is_at_zero)) {
            let (lower, upper) = (middle - &by.upper(), middle - &by.lower());
            is_inside &= lower > side[0] && upper < side[1];
            *side = [lower.max(side[0].clone()), upper.min(side[1].clone())];
            if side[0] > side[1] {
                return None;
            }
        }
        Some((next, is_inside))
    }

    /// How far the middle of a box is from the zero, in the frequency and in the parameter: the values there over the slopes in the box.
    fn moves(&self, over: &[Ball; 2], at: &[Ball; 2]) -> Option<[Ball; 2]> {
        if self.is_at_zero {
            let [_, slope] = self.at_zero(&over[1])?.swap_remove(self.sign);
            let [value, _] = self.at_zero(&at[1])?.swap_remove(self.sign);
            return Some([Ball::zero(value.bits()), value.div(&slope)?]);
        }
        let [[_, a, b], [_, c, d]] = self.system(over)?;
        let [[f, ..], [g, ..]] = self.system(at)?;
        let determinant = a.mul(&d).sub(&b.mul(&c));
        Some([d.mul(&f).sub(&b.mul(&g)).div(&determinant)?, a.mul(&g).sub(&c.mul(&f)).div(&determinant)?])
    }

    /// Both functions with their derivatives by the frequency and by the parameter.
    fn system(&self, place: &[Ball; 2]) -> Option<[[Ball; 3]; 2]> {
        let (crossing, mut signs) = self.at(place)?;
        let sign = signs.swap_remove(self.sign);
        let row = |f: Local| {
            let [value, slope, _] = f.own;
            let [by_parameter, ..] = f.by_parameter;
            [value, slope, by_parameter]
        };
        Some(match crossing {
            Some(crossing) => [row(crossing), row(sign)],
            None => {
                let slope = [sign.own[1].clone(), sign.own[2].scaled(&Integer::from(2)), sign.by_parameter[1].clone()];
                [row(sign), slope]
            }
        })
    }

    /// The function of crossings and those that tell whether they are allowed.
    fn at(&self, [omega, parameter]: &[Ball; 2]) -> Option<(Option<Local>, Vec<Local>)> {
        let (functions, tau) = self.functions(parameter)?;
        let waves = Waves::at(&tau, omega)?;
        let local = |f: &Function<Series, 3>| waves.local(f, omega);
        Some((functions.crossing.as_ref().map(local), functions.signs.iter().map(local).collect()))
    }

    /// The functions over the frequency, and the dead time with its derivative.
    fn functions(&self, parameter: &Ball) -> Option<(Functions<Series, 3>, [Ball; 2])> {
        let one = Ball::from_integer(&Integer::ONE, parameter.bits());
        let values = self.symbols.values(&[Series::linear(parameter, &one, 2)])?;
        let all: Vec<Series> = self.functions.all.iter().map(|p| self.symbols.value(p, &values)).collect();
        let parts = self.functions.split(&all)?;
        let [above, below] = parts.dead_time?;
        let time = above.div(below)?;
        let tau = [value(&time), slope(&time)].map(|t| t.shifted(self.octave));
        let degree = parts.denominator.len().max(parts.numerator.len()) - 1;
        let [d, n] = [parts.denominator, parts.numerator].map(|p| of_octave(p, self.octave, degree));
        let functions = Functions::of(self.functions.rule(), &OnAxis::new(&d, &n, parts.content), parts.alpha);
        Some((functions, tau))
    }
}

/// The bits with which a zero in a box is looked for.
fn bits_in(place: &Place) -> u64 {
    BITS + place.iter().map(|[lower, upper]| (upper - lower).denominator().bit_length()).max().unwrap_or(0)
}

/// The number of the only enclosure that contains zero.
fn only_zero<'b>(values: impl Iterator<Item = &'b Ball>) -> Option<usize> {
    let mut zeros = values.enumerate().filter(|(_, value)| value.contains_zero()).map(|(k, _)| k);
    zeros.next().filter(|_| zeros.next().is_none())
}

/// `cos(tau omega)`, `sin(tau omega)/omega` and their derivatives by the parameter.
struct Waves([Local; 2]);

impl Waves {
    fn at([tau, by_parameter]: &[Ball; 2], omega: &Ball) -> Option<Waves> {
        let (c, s) = cos_sin(&tau.mul(omega));
        let (first, second) = (tau, tau.square().divided_by(2));
        let cosine = [c.clone(), s.mul(first).neg(), c.mul(&second).neg()];
        let sine = [s.clone(), c.mul(first), s.mul(&second).neg()];
        let q = sine[0].div(omega)?;
        let r = sine[1].sub(&q).div(omega)?;
        let quotient = [q, r.clone(), sine[2].sub(&r).div(omega)?];
        // The derivative of the cosine by tau is -omega sin, that of sin(tau omega)/omega is the cosine.
        let turned = [omega.mul(&s), s.add(&omega.mul(&sine[1])), sine[1].add(&omega.mul(&sine[2]))];
        let by = |jet: &Jet, factor: &Ball| jet.each_ref().map(|x| x.mul(factor));
        let cosine_by = by(&turned, &by_parameter.neg());
        let quotient_by = by(&cosine, by_parameter);
        Some(Waves([
            Local { own: cosine, by_parameter: cosine_by },
            Local { own: quotient, by_parameter: quotient_by },
        ]))
    }

    /// The function `p + c cos(tau omega) + s sin(tau omega)/omega` at a frequency.
    fn local(&self, [p, c, s]: &Function<Series, 3>, omega: &Ball) -> Local {
        let mut out = polynomial(p, omega);
        for (list, wave) in [c, s].into_iter().zip(&self.0) {
            let factor = polynomial(list, omega);
            let both = [(&factor.own, &wave.by_parameter), (&factor.by_parameter, &wave.own)];
            out.own = sum(&out.own, &product(&factor.own, &wave.own));
            for (a, b) in both {
                out.by_parameter = sum(&out.by_parameter, &product(a, b));
            }
        }
        out
    }
}

/// A polynomial in the frequency.
fn polynomial(p: &[Series], omega: &Ball) -> Local {
    let horner = |of: fn(&Series) -> &Ball| {
        let zero = Ball::zero(omega.bits());
        p.iter().rev().fold([zero.clone(), zero.clone(), zero], |[a, b, c]: Jet, x| {
            [a.mul(omega).add(of(x)), b.mul(omega).add(&a), c.mul(omega).add(&b)]
        })
    };
    Local { own: horner(value), by_parameter: horner(slope) }
}

fn sum(a: &Jet, b: &Jet) -> Jet {
    std::array::from_fn(|k| a[k].add(&b[k]))
}

fn product(a: &Jet, b: &Jet) -> Jet {
    let second = a[0].mul(&b[2]).add(&a[1].mul(&b[1])).add(&a[2].mul(&b[0]));
    [a[0].mul(&b[0]), a[0].mul(&b[1]).add(&a[1].mul(&b[0])), second]
}
