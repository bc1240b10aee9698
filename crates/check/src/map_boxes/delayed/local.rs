//! The characteristic function on a stretch of the imaginary axis, for all points of a box: its value in the middle, by how much the frequency and
//! the parameters change it, and bounds of the rest.

use super::headings::{Headings, LENGTH, TURN, heading};
use super::turn::Turns;
use crate::number::{Q, Z};
use crate::taylor::Taylor;
use num_traits::{Euclid, One, Signed, ToPrimitive, Zero};

/// Frequencies are in units of two to the minus this power.
pub(super) const FREQUENCY_BITS: usize = 64;

/// More than the roundings of three evaluations of a polynomial, for each coefficient.
const ROUNDED: usize = 8;

/// More than the roundings of all vectors of a delayed part: three each, beside those in proportion to what is rounded.
const ROUNDED_VECTORS: u32 = 64;

/// Bits of what is compared.
const SHORT: u64 = 56;

/// Real and imaginary part.
type Complex = [Z; 2];

/// A polynomial in `s` times `exp(-tau s)`, over a box.
pub(super) struct Part {
    /// The coefficients in the middle, and their changes by half of each side.
    about: Vec<Vec<Z>>,
    /// The coefficients of the derivative by `s`, in the middle.
    derivative: Vec<Z>,
    /// What is left out of each coefficient.
    rest: Vec<Z>,
    /// The first and the second derivative, with the moduli of the coefficients.
    derivatives: [Vec<Z>; 2],
    /// The moduli of all that changes a coefficient over the box, and the derivative with these.
    changes: [Vec<Z>; 2],
    delay: Option<Delay>,
}

/// A dead time over a box.
struct Delay {
    middle: Q,
    /// The middle in units, rounded down, and the changes by half of each side.
    floor: Z,
    changes: Vec<Z>,
    /// A bound of the moduli of all changes together.
    spread: Z,
}

impl Part {
    /// Of the coefficients over a box of so many parameters, and the dead time: its middle and its changes by half of each side.
    pub fn new(coefficients: &[Taylor], parameters: usize, delay: Option<(Q, Vec<Q>)>, bits: usize) -> Self {
        let of = |way: usize| {
            let of = move |c: &Taylor| if way == 0 { c.constant() } else { c.linear(way - 1) };
            coefficients.iter().map(of).collect::<Vec<Z>>()
        };
        let about: Vec<Vec<Z>> = (0..=parameters).map(of).collect();
        let moduli = |j: usize| about[1..].iter().map(|own| own[j].abs()).sum::<Z>();
        let rounded = Z::from((ROUNDED * about.len()).div_ceil(3));
        let n = coefficients.len();
        let rest: Vec<Z> = (0..n).map(|j| coefficients[j].variation() - moduli(j) + &rounded).collect();
        let change: Vec<Z> = (0..n).map(|j| &rest[j] + moduli(j)).collect();
        let derivative = derivative(&about[0]);
        let first: Vec<Z> = derivative.iter().map(Z::abs).collect();
        let second = self::derivative(&first);
        let changes = [change.clone(), self::derivative(&change)];
        let delay = delay.map(|(middle, changes)| {
            let floor = |q: &Q| ((q.numer() << bits) as Z).div_euclid(q.denom());
            let changes: Vec<Z> = changes.iter().map(floor).collect();
            let spread = changes.iter().map(|x| x.abs() + Z::one()).sum();
            Delay { floor: floor(&middle), middle, changes, spread }
        });
        Part { about, derivative, rest, derivatives: [first, second], changes, delay }
    }
}

fn derivative(c: &[Z]) -> Vec<Z> {
    c.iter().enumerate().skip(1).map(|(j, c)| c * Z::from(j)).collect()
}

/// The quotient by `2^bits`, rounded up.
fn up(x: Z, bits: usize) -> Z {
    -((-x) >> bits)
}

/// The value at `i omega`.
fn on_axis(c: &[Z], omega: &Z) -> Complex {
    let square = omega * omega;
    let part = |odd: usize| {
        let mut sum = Z::zero();
        for c in c.iter().skip(odd).step_by(2).rev() {
            sum = c - ((sum * &square) >> (2 * FREQUENCY_BITS));
        }
        sum
    };
    [part(0), (part(1) * omega) >> FREQUENCY_BITS]
}

/// A bound of the value at a frequency, or below, of a polynomial whose coefficients are not negative.
fn at_most(c: &[Z], omega: &Z) -> Z {
    c.iter().rev().fold(Z::zero(), |sum, c| up(sum * omega, FREQUENCY_BITS) + c)
}

/// A bound of the modulus: `sqrt(a^2 + b^2) <= a + b/2` for `a >= b`.
fn modulus([re, im]: &Complex) -> Z {
    let (a, b) = (re.abs(), im.abs());
    let (large, small) = if a >= b { (a, b) } else { (b, a) };
    large + ((small + 1_u32) >> 1)
}

fn add(sum: &mut Complex, [re, im]: Complex) {
    sum[0] += re;
    sum[1] += im;
}

/// Times a number and `-i`.
fn turned_back([re, im]: &Complex, by: &Z, bits: usize) -> Complex {
    [(im * by) >> bits, -((re * by) >> bits)]
}

/// Times `exp(-i angle)` with this cosine and sine.
fn times([re, im]: &Complex, [c, s]: &[Z; 2], bits: usize) -> Complex {
    [(re * c + im * s) >> bits, (im * c - re * s) >> bits]
}

/// A stretch of the axis: half its length about a frequency, with turns of vectors of so many bits.
pub(super) struct Stretch<'s> {
    pub middle: &'s Z,
    pub half: &'s Z,
    pub turns: &'s Turns,
    pub bits: usize,
}

impl Stretch<'_> {
    /// The highest frequency.
    fn far(&self) -> Z {
        self.middle + self.half
    }

    fn by_half(&self, x: Z) -> Z {
        up(x * self.half, FREQUENCY_BITS)
    }
}

/// The polynomial of a part about the middle of a stretch.
struct About {
    value: Complex,
    of_sides: Vec<Complex>,
    /// The derivative by the frequency.
    slope: Complex,
    /// How far the polynomial and its derivative are off their values in the middle, and the former off its linear part.
    off: Z,
    slope_off: Z,
    bent: Z,
}

impl Part {
    fn on(&self, on: &Stretch<'_>) -> About {
        let (far, half) = (on.far(), on.half);
        let [re, im] = on_axis(&self.derivative, on.middle);
        let [change, change_slope] = self.changes.each_ref().map(|c| at_most(c, &far));
        let [first, second] = self.derivatives.each_ref().map(|c| at_most(c, &far));
        let curved = up(second.clone() * half * half, 2 * FREQUENCY_BITS + 1);
        About {
            value: on_axis(&self.about[0], on.middle),
            of_sides: self.about[1..].iter().map(|c| on_axis(c, on.middle)).collect(),
            slope: [-im, re],
            off: change + on.by_half(first),
            slope_off: &change_slope + on.by_half(second),
            bent: at_most(&self.rest, &far) + on.by_half(change_slope) + curved,
        }
    }
}

/// The sum of parts, without the change by half of the stretch.
impl Local<Z> {
    fn add(&mut self, own: About) {
        add(&mut self.value, own.value);
        self.changes.iter_mut().zip(own.of_sides).for_each(|(sum, own)| add(sum, own));
        add(&mut self.slope, own.slope);
        self.rest += own.bent;
        self.slope_rest += own.slope_off;
    }

    fn add_delayed(&mut self, own: About, delay: &Delay, on: &Stretch<'_>) {
        let longest: Z = &delay.floor + 1_u32;
        // How far the angle is off that in the middle.
        let angle = up(on.far() * &delay.spread, FREQUENCY_BITS) + on.by_half(longest.clone());
        let is_short = angle < Z::one() << on.bits;
        match if is_short { on.turns.of(&delay.middle, on.middle, FREQUENCY_BITS) } else { None } {
            Some(turn) => self.add_turned(own, delay, &turn, &angle, on),
            None => self.add_unknown(&own, delay, &longest, on),
        }
    }

    /// Anything of the size of a part.
    fn add_unknown(&mut self, own: &About, delay: &Delay, longest: &Z, on: &Stretch<'_>) {
        let (bits, far, one) = (on.bits, on.far(), Z::one() << on.bits);
        let all = modulus(&own.value) + &own.off;
        for (sum, time) in self.blame.iter_mut().zip(&delay.changes) {
            let angle: Z = (&far * time.abs()) >> FREQUENCY_BITS;
            *sum += (&all * angle.min(one.clone())) >> bits;
        }
        self.slope_rest += modulus(&own.slope) + &own.slope_off + up((longest + &delay.spread) * &all, bits);
        self.rest += all;
    }

    fn add_turned(&mut self, own: About, delay: &Delay, turn: &Complex, angle: &Z, on: &Stretch<'_>) {
        let About { value: p, of_sides, slope: mut d, off, slope_off, bent } = own;
        let (bits, size) = (on.bits, modulus(&p));
        add(&mut d, turned_back(&p, &delay.floor, bits));
        // The frequency, rounded up to a whole number, and one.
        let above: Z = (on.far() >> FREQUENCY_BITS) + 2_u32;
        let (mut rounded, d_size) = (&size * above * self.changes.len().max(2), modulus(&d));
        for ((sum, mut own), time) in self.changes.iter_mut().zip(of_sides).zip(&delay.changes) {
            add(&mut own, turned_back(&p, &((on.middle * time) >> FREQUENCY_BITS), bits));
            rounded += modulus(&own);
            add(sum, times(&own, turn, bits));
        }
        add(&mut self.value, times(&p, turn, bits));
        add(&mut self.slope, times(&d, turn, bits));
        // exp(-i x) is off 1 - i x by at most x^2/2, and off 1 by at most x.
        let square = on.by_half(delay.spread.clone()) + up(angle * angle, bits + 1);
        self.rest += bent + up(&size * square + &off * angle, bits) + (rounded >> (bits - 3)) + ROUNDED_VECTORS;
        let slope_rounded: Z = ((&size + &d_size) >> (bits - 3)) + ROUNDED_VECTORS;
        self.rest += on.by_half(slope_rounded.clone());
        let longest: Z = &delay.floor + 1_u32;
        self.slope_rest +=
            slope_off + up(longest * &off + &delay.spread * (size + off) + d_size * angle, bits) + slope_rounded;
    }

    /// With as many bits as are of use. The slope has a unit of its own.
    fn short(self, half: &Z) -> Local {
        let Local { value, slope, mut changes, rest, slope_rest, blame } = self;
        changes.push(slope.each_ref().map(|x| (x * half) >> FREQUENCY_BITS));
        let down = |numbers: &[Complex], own: &Complex, rest: &Z| {
            let longest = numbers.iter().chain([own]).flatten().chain([rest]).map(Z::bits).max().unwrap_or(0);
            longest.saturating_sub(SHORT)
        };
        let (far, own) = (down(&changes, &value, &rest), down(&[], &slope, &slope_rest));
        // Numbers of so few bits always fit.
        let floor = |x: &Z, by: u64| (x >> by).to_i128().unwrap_or(i128::MAX >> 32);
        let shorter = |vector: &Complex| vector.each_ref().map(|x| floor(x, far));
        Local {
            value: shorter(&value),
            changes: changes.iter().map(shorter).collect(),
            // Each vector is rounded by less than 3/2, the rest by less than 1.
            rest: floor(&rest, far) + 2 * (1 + changes.len()) as i128,
            slope: slope.each_ref().map(|x| floor(x, own)),
            slope_rest: floor(&slope_rest, own) + 4,
            blame: blame.iter().map(|x| floor(x, far)).collect(),
        }
    }
}

/// The function about the middle of a stretch and of a box.
#[derive(Default)]
pub(super) struct Local<N = i128> {
    value: [N; 2],
    /// The changes by half of each side of the box, and by half of the stretch.
    changes: Vec<[N; 2]>,
    rest: N,
    /// The derivative by the frequency, and how far it is off anywhere.
    slope: [N; 2],
    slope_rest: N,
    /// How much of the rest is there because of each side of the box, for a choice and no proof.
    blame: Vec<N>,
}

impl Local {
    pub fn new(parts: &[Part], on: &Stretch<'_>) -> Self {
        let parameters = parts.first().map_or(0, |part| part.about.len() - 1);
        let (changes, blame) = (vec![Complex::default(); parameters], vec![Z::zero(); parameters]);
        let mut sums = Local { changes, blame, ..Local::<Z>::default() };
        for part in parts {
            let own = part.on(on);
            match &part.delay {
                None => sums.add(own),
                Some(delay) => sums.add_delayed(own, delay, on),
            }
        }
        sums.short(on.half)
    }

    /// The first heading, a given one before all others, about which the function is in the half plane, at least a share `1/2^margin` of its
    /// value in the middle being left, if a margin is asked for.
    pub fn clear(&self, before: Option<i64>, margin: Option<u32>) -> Option<i64> {
        let is_clear = |k: &i64| {
            let value = along(*k, &self.value);
            let changes = self.changes.iter().map(|x| along(*k, x).abs()).sum::<i128>();
            let left = value - changes - LENGTH * self.rest;
            left > 0 && margin.is_none_or(|margin| left << margin > value)
        };
        before.into_iter().chain(0..TURN).find(is_clear)
    }

    /// The headings about which the derivative by the frequency is in the half plane.
    pub fn slopes(&self, margin: Option<u32>) -> Headings {
        let is_along = |k: &i64| {
            let slope = along(*k, &self.slope);
            let left = slope - LENGTH * self.slope_rest;
            left > 0 && margin.is_none_or(|margin| left << margin > slope)
        };
        (0..TURN).filter(is_along).fold(0, |all, k| all | 1 << k)
    }

    /// By how much half of each side moves the function, in parts of 1024 of all together: across its way where that is known.
    pub fn shares(&self, slopes: Headings) -> Vec<u64> {
        let of_side = |(change, blame): (&[i128; 2], &i128)| {
            let size = |k: i64| along(k, change).abs();
            let own = match (0..TURN).filter(|k| slopes & 1 << k != 0).max_by_key(|k| along(*k, &self.slope)) {
                Some(k) => size(k + 4),
                None => size(0).max(size(4)),
            };
            own + LENGTH * blame
        };
        // The last change is that by the stretch.
        let all: Vec<i128> = self.changes.iter().zip(&self.blame).map(of_side).collect();
        let sum = all.iter().sum::<i128>() + 1;
        all.iter().map(|x| u64::try_from((x << 10) / sum).unwrap_or(0)).collect()
    }
}

/// The part of a vector along a heading.
fn along(k: i64, [x, y]: &[i128; 2]) -> i128 {
    let [a, b] = heading(k);
    a * x + b * y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::Clock;
    use crate::taylor::Precision;
    use std::time::Duration;

    /// Of `P_0 = x y + (1 + x) s + s^2` and `P_1 = y + (x - 2 y) s` with the dead time `1 + x/2 - y/4`, at many stretches of many boxes: where a
    /// half plane is found the function in floating point is in it, on a grid of points that has all corners; so is its derivative.
    /// How often either was found.
    fn seen_half_planes(bits: usize) -> [usize; 2] {
        let (p, clock, turns) = (Precision::new(2, 1, bits), Clock::new(Duration::MAX), Turns::new(bits));
        let mut seed = 7_u64;
        let mut random = |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 33) % n) as i64
        };
        let (mut clear, mut directed) = (0, 0);
        for _ in 0..2000 {
            let over = |k: i64, n: i64| Q::new(k.into(), n.into());
            let widest = 1 << random(5);
            // At points where coefficients are whole numbers nothing is left out but roundings.
            let is_point = random(3) == 0;
            let mut radius = |most: u64| if is_point { 0 } else { random(most) };
            let (rx, ry) = (radius(widest), radius(widest));
            let mut center = || if is_point { 50 * random(4) - 50 } else { random(200) - 50 };
            let (cx, cy) = (center(), center());
            let side = |c: i64, r: i64| [over(c - r, 50), over(c + r, 50)];
            let x = Taylor::coordinate(&side(cx, rx), 0, &p);
            let y = Taylor::coordinate(&side(cy, ry), 1, &p);
            let (zero, one) = (Taylor::zero(), Taylor::number(&Q::one(), &p));
            let first = [x.times(&y, &p, &clock).unwrap(), one.plus(&x), one];
            let second = [y.clone(), x.minus(&y.scaled(&2.into())), zero];
            let time = over(50, 50) + over(cx, 100) - over(cy, 200);
            if time.is_negative() {
                continue;
            }
            let changes = vec![over(rx, 100), over(-ry, 200)];
            let parts = [Part::new(&first, 2, None, bits), Part::new(&second, 2, Some((time, changes)), bits)];
            // Short and long stretches, of small and of large boxes.
            let longest = [20, 200][random(2) as usize];
            let half = if is_point { 0 } else { random(longest) };
            let middle = half + random(600);
            let unit = |k: i64| (Z::from(k) << FREQUENCY_BITS) / 200;
            let on = Stretch { middle: &unit(middle), half: &unit(half), turns: &turns, bits };
            let local = Local::new(&parts, &on);
            let value = |[t, u, v]: [f64; 3]| {
                let (x, y) = ((cx as f64 + rx as f64 * u) / 50.0, (cy as f64 + ry as f64 * v) / 50.0);
                let (w, tau) = ((middle as f64 + half as f64 * t) / 200.0, 1.0 + x / 2.0 - y / 4.0);
                let (c, s) = ((w * tau).cos(), -(w * tau).sin());
                let ([a, b], [da, db]) = ([y, (x - 2.0 * y) * w], [0.0, x - 2.0 * y]);
                let [f, g] = [x * y - w * w + a * c - b * s, (1.0 + x) * w + a * s + b * c];
                // The derivative of the delayed part: (P' - i tau P) exp(-i w tau).
                let [a, b] = [da + tau * b, db - tau * a];
                ([f, g], [-2.0 * w + a * c - b * s, 1.0 + x + a * s + b * c])
            };
            let steps = [-1.0, -0.4, 0.1, 0.7, 1.0];
            let grid: Vec<[f64; 3]> = (0..125).map(|k| [steps[k % 5], steps[k / 5 % 5], steps[k / 25]]).collect();
            let is_in = |k: i64, [re, im]: [f64; 2]| {
                let [a, b] = heading(k).map(|x| x as f64);
                a * re + b * im > -1e-9
            };
            let slopes = local.slopes(None);
            for k in 0..TURN {
                if local.clear(Some(k), None) == Some(k) {
                    assert!(grid.iter().all(|at| is_in(k, value(*at).0)), "{k} {cx} {cy} {rx} {ry} {middle} {half}");
                    clear += 1;
                }
                if slopes & 1 << k != 0 {
                    assert!(grid.iter().all(|at| is_in(k, value(*at).1)), "{k} {cx} {cy} {rx} {ry} {middle} {half}");
                    directed += 1;
                }
            }
        }
        [clear, directed]
    }

    #[test]
    fn half_planes_hold_the_function_and_its_derivative() {
        let [clear, directed] = seen_half_planes(96);
        assert!(clear > 2000 && directed > 1000, "{clear} {directed}");
    }

    /// Units so coarse that most of what is left out is rounding.
    #[test]
    #[ignore = "long: CI runs it"]
    fn half_planes_hold_them_with_few_bits() {
        for bits in [5, 6, 7, 8] {
            let [clear, directed] = seen_half_planes(bits);
            assert!(bits < 6 || clear > 500 && directed > 1000, "{bits}: {clear} {directed}");
        }
    }
}
