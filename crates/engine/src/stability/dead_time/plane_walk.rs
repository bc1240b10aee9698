//! A walk along the imaginary axis for a whole box of two parameters at once.

use super::dyadic::{Dyadic, Step};
use super::plane::DeadTime;
use super::turn::{Fixed, turned};
use crate::stability::plane::boxes::{BoxVerdict, Place, Seen};
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};

/// A function over the shares `u` (0), `v` (1) of a window, both in `[0, 1]`.
#[derive(Debug)]
pub(crate) struct Shares {
    /// The coefficients of the powers of `s` for each dead time.
    pub parts: Vec<Vec<MultiPoly>>,
    /// By how much the coefficient of each power of `s` is off at most, in the first part; none are where it is empty.
    pub slack: Vec<Integer>,
    /// The axis to cut where that is too much.
    pub slack_axis: usize,
    /// The loop is undefined where one of these vanishes, each known up to a bound.
    pub poles: Vec<(MultiPoly, Integer)>,
    /// The dead time of each part; none for the first.
    pub delays: Vec<DeadTime>,
    /// The loop has no meaning where one of these is negative.
    pub times: Vec<DeadTime>,
}

/// The function with its derivatives, also over the frequency (2); those of order `n` are multiplied by `unit^n`.
#[derive(Debug)]
pub(crate) struct PlaneFunction {
    shares: Shares,
    slack: UniPoly,
    /// `f`, then its derivatives by frequency, `u` and `v`: both parts of the factor of the turn of each part.
    first: [Vec<[MultiPoly; 2]>; 4],
    /// The second derivatives `ww`, `wu`, `wv`, `uu`, `uv`, `vv`: the sums of the moduli of all terms.
    second: [MultiPoly; 6],
    unit: Integer,
    degrees: [u32; 2],
    order: usize,
    shortest: [i64; 2],
    most_steps: usize,
}

/// A box is given up where steps would be so many halvings shorter than the frequency, or than the bound of all frequencies
/// at zero.
const SHORTEST: [i64; 2] = [24, 256];
/// The same of one point, which no cut brings away from the limit.
const SHORTEST_AT_A_POINT: [i64; 2] = [72, 256];
const MOST_STEPS_AT_A_POINT: usize = 1 << 14;
const SCALE: u64 = 96;

const OMEGA: usize = 2;

impl PlaneFunction {
    /// Cost: a product for each dead time and each term of the derivatives.
    pub fn new(shares: Shares) -> PlaneFunction {
        let Shares { parts, delays, .. } = &shares;
        // What is known of a coefficient may be its bound alone.
        let is_used = |j: usize, c: &MultiPoly| !c.is_zero() || shares.slack.get(j).is_some_and(|x| !x.is_zero());
        let degree = |part: &Vec<MultiPoly>| part.iter().enumerate().rposition(|(j, c)| is_used(j, c));
        let order = parts.iter().filter_map(degree).max().unwrap_or(0);
        let numbers = delays.iter().flat_map(|time| [&time.offset, &time.slopes[0], &time.slopes[1]]);
        let unit = numbers.fold(Integer::ONE, |l, x| l.lcm(&x.denominator()));
        let whole = |x: &Rational| (x * &Rational::from(&unit)).numerator();
        let omega = MultiPoly::variable(OMEGA);
        // The turn exp(-i w tau) has the derivatives -i times these.
        let rates: Vec<[MultiPoly; 3]> = delays
            .iter()
            .map(|DeadTime { offset, slopes: [a, b] }| {
                let delay = &MultiPoly::constant(whole(offset))
                    + &(&MultiPoly::variable(0).scaled_by(&whole(a)) + &MultiPoly::variable(1).scaled_by(&whole(b)));
                [delay, omega.scaled_by(&whole(a)), omega.scaled_by(&whole(b))]
            })
            .collect();
        let variables = [OMEGA, 0, 1];
        let derived = |set: &[[MultiPoly; 2]], which: usize| -> Vec<[MultiPoly; 2]> {
            let one = |([re, im], rates): (&[MultiPoly; 2], &[MultiPoly; 3])| {
                let by = |p: &MultiPoly| p.derivative(variables[which]).scaled_by(&unit);
                [&by(re) + &(&rates[which] * im), &by(im) - &(&rates[which] * re)]
            };
            set.iter().zip(&rates).map(one).collect()
        };
        let zeroth: Vec<[MultiPoly; 2]> = parts.iter().map(|part| on_axis(part)).collect();
        let [w, u, v] = [0, 1, 2].map(|which| derived(&zeroth, which));
        let second = [(&w, 0), (&w, 1), (&w, 2), (&u, 1), (&u, 2), (&v, 2)].map(|(set, which)| {
            let terms = derived(set, which).into_iter().flatten();
            terms.fold(MultiPoly::zero(), |sum, p| &sum + &absolute(&p))
        });
        let first = [zeroth, w, u, v];
        let degrees = [0, 1].map(|axis| {
            let own = first.iter().flatten().flatten().map(|p| p.degree_in(axis)).max().unwrap_or(0);
            second.iter().map(|p| p.degree_in(axis)).max().unwrap_or(0).max(own)
        });
        let slack = UniPoly::new(shares.slack.clone());
        PlaneFunction { shares, slack, first, second, unit, degrees, order, shortest: SHORTEST, most_steps: usize::MAX }
    }

    /// The same of a function that is the same everywhere.
    pub fn of_point(shares: Shares) -> PlaneFunction {
        let (shortest, most_steps) = (SHORTEST_AT_A_POINT, MOST_STEPS_AT_A_POINT);
        PlaneFunction { shortest, most_steps, ..PlaneFunction::new(shares) }
    }

    /// Walks along the axis, or tells where to cut.
    pub fn look(&self, place: &Place) -> Seen {
        let wider = place.wider();
        let ranges = |list: &[DeadTime]| -> Vec<[Rational; 2]> { list.iter().map(|time| range(time, place)).collect() };
        let own = ranges(&self.shares.times);
        if self.shares.parts.is_empty() || own.iter().any(|[_, most]| !most.sign().is_gt()) {
            // No loop has a negative dead time.
            return Seen::Decided(BoxVerdict::Unstable { outside: None });
        }
        if own.iter().chain(&ranges(&self.shares.delays)).any(|[least, _]| least.is_negative()) {
            return Seen::Cut(wider);
        }
        for (pole, slack) in &self.shares.poles {
            let (middle, spread) = self.spread(pole, place);
            if middle.abs() <= spread + Rational::from(slack) {
                return Seen::Cut(wider);
            }
        }
        let Some(bound) = self.bound(place) else { return Seen::Cut(wider) };
        Walk::new(self, place).follow(bound)
    }

    /// The value in the middle of a box, and a bound of how far others in the box are from it: a monomial of numbers that
    /// are not negative is convex.
    fn spread(&self, p: &MultiPoly, place: &Place) -> (Rational, Rational) {
        let (middle, upper) = ([0, 1].map(|i| middle(place, i).rational()), [0, 1].map(|i| upper(place, i).rational()));
        let moduli = absolute(p);
        (p.eval(&middle), moduli.eval(&upper) - moduli.eval(&middle))
    }

    /// A power of two beyond which the highest undelayed power of `s` outweighs all other terms in the whole box.
    fn bound(&self, place: &Place) -> Option<u64> {
        let sizes: Vec<Vec<(Rational, Rational)>> =
            self.shares.parts.iter().map(|part| part.iter().map(|c| self.spread(c, place)).collect()).collect();
        let (top, spread) = sizes[0].get(self.order)?;
        let slack = |j: usize| Rational::from(&self.slack.coeff(j));
        let least = top.abs() - spread - slack(self.order);
        let mut sums: Vec<Rational> = (0..self.order).map(slack).chain([Rational::ZERO]).collect();
        for (k, part) in sizes.iter().enumerate() {
            // Beyond the order all coefficients are zero.
            let own = part.iter().enumerate().take(self.order + 1);
            for (j, (middle, spread)) in own.filter(|(j, _)| (k, *j) != (0, self.order)) {
                sums[j] += middle.abs() + spread;
            }
        }
        if sums[self.order] >= least {
            return None;
        }
        let mut e = 0u64;
        loop {
            let r = Rational::from(&(&Integer::ONE << e));
            let rest = sums.iter().rev().fold(Rational::ZERO, |sum, c| sum * &r + c);
            let power = Rational::from(&(&Integer::ONE << (e * self.order as u64)));
            if rest < &least * &power {
                return Some(e);
            }
            e += 1;
        }
    }

    /// A polynomial in the frequency alone, times `2^shift`, at shares of the window.
    fn collapsed(&self, p: &MultiPoly, at: &[Dyadic; 2]) -> UniPoly {
        let mut coefficients = vec![Integer::ZERO; p.degree_in(OMEGA) as usize + 1];
        for (monomial, c) in p.terms() {
            let mut term = c.clone();
            for (axis, share) in at.iter().enumerate() {
                let e = monomial.exponent(axis);
                term = (term * share.m.pow(u64::from(e))) << (share.e * u64::from(self.degrees[axis] - e));
            }
            coefficients[monomial.exponent(OMEGA) as usize] += term;
        }
        UniPoly::new(coefficients)
    }

    fn shift(&self, at: &[Dyadic; 2]) -> u64 {
        (0..2).map(|axis| at[axis].e * u64::from(self.degrees[axis])).sum()
    }
}

/// One box: everything as a function of the frequency.
struct Walk<'f> {
    function: &'f PlaneFunction,
    /// In the middle of the box, times `2^middle`.
    first: [Vec<[UniPoly; 2]>; 4],
    middle: u64,
    /// At its upper corner, times `2^upper`: the second derivatives.
    second: [UniPoly; 6],
    upper: u64,
    /// The dead times in the middle of the box.
    delays: Vec<Rational>,
    /// Half the lengths of the box are two to these powers.
    halves: [i64; 2],
}

impl<'f> Walk<'f> {
    fn new(function: &'f PlaneFunction, place: &Place) -> Walk<'f> {
        let (middle, upper) = ([0, 1].map(|i| middle(place, i)), [0, 1].map(|i| upper(place, i)));
        let first = function.first.each_ref().map(|set| {
            let both = |pair: &[MultiPoly; 2]| pair.each_ref().map(|p| function.collapsed(p, &middle));
            set.iter().map(both).collect::<Vec<_>>()
        });
        let second = function.second.each_ref().map(|p| function.collapsed(p, &upper));
        let [u, v] = [0, 1].map(|i| middle[i].rational());
        let delay = |time: &DeadTime| &time.offset + &(&time.slopes[0] * &u) + &time.slopes[1] * &v;
        let delays = function.shares.delays.iter().map(delay).collect();
        let halves = place.halvings.map(|h| -i64::from(h) - 1);
        let (shift, over) = (function.shift(&middle), function.shift(&upper));
        Walk { function, first, middle: shift, second, upper: over, delays, halves }
    }

    fn follow(&self, bound: u64) -> Seen {
        let end = Rational::from(&(&Integer::ONE << bound));
        let [shortest, least] = self.function.shortest;
        let mut at = Dyadic::zero();
        let mut step = Step(bound as i64 - 4);
        let mut direction: Option<(i64, i64)> = None;
        let mut steps = 0;
        while at.rational() < end {
            steps += 1;
            if steps > self.function.most_steps {
                return Seen::Cut(self.longer());
            }
            match self.cone(&at.plus(step, 1), step) {
                Cone::Turned(next) => {
                    let (first, last) = direction.unwrap_or((next, next));
                    let Some(turned) = nearer(last, next) else { return Seen::Cut(self.longer()) };
                    direction = Some((first, turned));
                    at = at.plus(step, 0);
                    step = Step(step.0 + 1);
                }
                Cone::TooLong if step.0 > at.floor_log2().map_or(bound as i64 - least, |e| e - shortest) => {
                    step = Step(step.0 - 1);
                }
                Cone::TooLong => return Seen::Cut(self.longer()),
                Cone::TooWide(axis) => return Seen::Cut(axis),
            }
        }
        let (first, last) = direction.expect("there is a first step");
        let n = self.function.order as i64;
        // The value at zero is real: 0 or 2 quarter turns.
        let value = self.value_at_zero();
        let Some(first) = nearer(first, value) else { return Seen::Cut(self.longer()) };
        let top = &self.first[0][0][if n % 2 == 0 { 0 } else { 1 }];
        let negative = top.coeff(n as usize).is_negative() != (n % 4 >= 2);
        let highest = (n + if negative { 2 } else { 0 }).rem_euclid(4);
        let Some(last) = nearer(last, highest) else { return Seen::Cut(self.longer()) };
        let twice = n - (last - first);
        assert!(twice >= 0 && twice % 2 == 0, "the argument grows by whole half turns");
        Seen::Decided(match twice / 2 {
            0 => BoxVerdict::Stable,
            right => BoxVerdict::Unstable { outside: Some(right as usize) },
        })
    }

    fn longer(&self) -> usize {
        usize::from(self.halves[1] > self.halves[0])
    }

    /// The direction of the function at zero.
    fn value_at_zero(&self) -> i64 {
        let value = self.first[0].iter().fold(Integer::ZERO, |sum, [re, _]| sum + re.coeff(0));
        if value.is_negative() { 2 } else { 0 }
    }

    /// What the function does on a step, for all points of the box: where it stays within 41.9 degrees of its value in the
    /// middle of both, the quarter turn that is within 47 degrees of that. Neighbouring steps are then less than half a turn apart.
    fn cone(&self, omega: &Dyadic, step: Step) -> Cone {
        checkpoint(512);
        let guarded = SCALE + 8;
        let omega_exact = omega.rational();
        let turn = |delay: &Rational| match delay.is_zero() {
            true => Fixed::one(guarded),
            false => turned(&(&omega_exact * delay), guarded),
        };
        let turns: Vec<Fixed> = self.delays.iter().map(turn).collect();
        let [value, by_omega, by_u, by_v] = self.first.each_ref().map(|set| {
            let zero = Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
            set.iter().zip(&turns).fold(zero, |sum, ([re, im], turn)| {
                let (re, im) = (scaled(re, omega, self.middle), scaled(im, omega, self.middle));
                sum.plus(&Fixed { re, im, error: Integer::ONE }.times(turn, guarded))
            })
        });
        // |f - f(m)| <= |f_w| h + |f_u| a + |f_v| b + half of the second derivatives times h, a, b; everything times unit^2.
        let (h, [a, b]) = (step.0 - 1, self.halves);
        let far = omega.plus(step, 1);
        let [ww, wu, wv, uu, uv, vv] = self.second.each_ref().map(|p| scaled(p, &far, self.upper) + Integer::ONE);
        let unit = &self.function.unit;
        let first = |x: &Fixed, power: i64| shifted_up(&x.at_most(), power) * unit;
        let (u_part, v_part) = (first(&by_u, a), first(&by_v, b));
        let sides =
            &(&u_part + &v_part) + &(shifted_up(&uu, 2 * a - 1) + shifted_up(&uv, a + b) + shifted_up(&vv, 2 * b - 1));
        let slack = (scaled(&self.function.slack, &far, 0) + Integer::ONE) * unit * unit;
        let along = first(&by_omega, h) + shifted_up(&ww, 2 * h - 1) + shifted_up(&wu, h + a) + shifted_up(&wv, h + b);
        let two_thirds = &(value.at_least() * unit * unit) << 1;
        let three = Integer::from(3);
        if &slack * &three >= two_thirds {
            return Cone::TooWide(self.function.shares.slack_axis);
        }
        let sides = sides + slack;
        if &sides * &three >= two_thirds {
            // The step may be long, but no shorter one will do about its middle.
            return Cone::TooWide(usize::from(v_part > u_part));
        }
        if (sides + along) * three >= two_thirds {
            return Cone::TooLong;
        }
        let (wide, high) = (value.re.abs(), value.im.abs());
        let largest = if wide > high { &wide } else { &high };
        if (&value.error << 5) > *largest {
            // The quarter turn next to the value may be more than 47 degrees away from it.
            return Cone::TooWide(self.longer());
        }
        Cone::Turned(match (wide > high, value.re.is_negative(), value.im.is_negative()) {
            (true, false, _) => 0,
            (false, _, false) => 1,
            (true, true, _) => 2,
            (false, _, true) => 3,
        })
    }
}

enum Cone {
    /// The quarter turn next to the value.
    Turned(i64),
    TooLong,
    /// The function is too near to zero, or the box too wide along an axis.
    TooWide(usize),
}

/// The representative of a quarter turn that is next to another one; `None` where they are opposite.
fn nearer(last: i64, next: i64) -> Option<i64> {
    match (next - last).rem_euclid(4) {
        0 => Some(last),
        1 => Some(last + 1),
        3 => Some(last - 1),
        _ => None,
    }
}

/// The least and the greatest value of a dead time in a box.
fn range(time: &DeadTime, place: &Place) -> [Rational; 2] {
    let mut ends = [time.offset.clone(), time.offset.clone()];
    for axis in 0..2 {
        let (upper, slope) = (upper(place, axis).rational(), &time.slopes[axis]);
        let lower = &upper - &Rational::dyadic(&Integer::ONE, u64::from(place.halvings[axis]));
        let (a, b) = (lower * slope, upper * slope);
        let (least, most) = if a <= b { (a, b) } else { (b, a) };
        ends[0] += least;
        ends[1] += most;
    }
    ends
}

/// The middle of a box on an axis, as a share of the window.
fn middle(place: &Place, axis: usize) -> Dyadic {
    Dyadic { m: Integer::from(2 * place.at[axis] + 1), e: u64::from(place.halvings[axis]) + 1 }
}

/// The upper end of a box on an axis, as a share of the window.
fn upper(place: &Place, axis: usize) -> Dyadic {
    Dyadic { m: Integer::from(place.at[axis] + 1), e: u64::from(place.halvings[axis]) }
}

/// The value of a polynomial times `2^shift`, in units of `2^-SCALE`, rounded down.
fn scaled(p: &UniPoly, omega: &Dyadic, shift: u64) -> Integer {
    let n = p.coeffs().len().max(1) - 1;
    let mut sum = Integer::ZERO;
    let mut power = Integer::ONE;
    for (j, c) in p.coeffs().iter().enumerate() {
        sum += (c * &power) << (omega.e * (n - j) as u64);
        power = &power * &omega.m;
    }
    let down = omega.e * n as u64 + shift;
    if down >= SCALE { sum >> (down - SCALE) } else { sum << (SCALE - down) }
}

/// `x 2^power`, rounded up.
fn shifted_up(x: &Integer, power: i64) -> Integer {
    let by = power.unsigned_abs();
    if power >= 0 { x << by } else { -(-x >> by) }
}

fn absolute(p: &MultiPoly) -> MultiPoly {
    let terms = p.terms().iter().map(|(m, c)| (m.exponents().to_vec(), c.abs()));
    MultiPoly::from_terms(terms)
}

/// `P(i omega)` as real and imaginary part.
fn on_axis(coefficients: &[MultiPoly]) -> [MultiPoly; 2] {
    let (mut re, mut im) = (MultiPoly::zero(), MultiPoly::zero());
    let mut power = MultiPoly::one();
    for (j, c) in coefficients.iter().enumerate() {
        let term = c * &power;
        match j % 4 {
            0 => re = &re + &term,
            1 => im = &im + &term,
            2 => re = &re - &term,
            _ => im = &im - &term,
        }
        power = &power * &MultiPoly::variable(OMEGA);
    }
    [re, im]
}
