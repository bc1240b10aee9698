//! Functions along the imaginary axis of loops with dead time: polynomials in the frequency, and such times a cosine and a sine.
//!
//! Up to a frequency the cosine and the sine are polynomials of degree three on each piece, up to a bound; on long pieces, and beyond that
//! frequency, they are any numbers from -1 to 1. Where the open loop is small that is enough.

use super::affine::{Affine, AlongCircle, Patch};
use super::along_circle::{Along, Coefficient, NearlyLinear, OnPiece};
use super::asked_functions::Function;
use crate::stability::subdivision::Halves;
use jurist_algebra::ball::{Ball, cos_sin};
use jurist_algebra::number::{Integer, Rational};
use std::sync::{Arc, OnceLock};

/// For each radian by which the dead time turns so many pieces more are looked at, up to a number of radians as a power of two. Without them a PID loop
/// that turns by 60 radians was left open over half of its stable gains after 4 s; with them it is decided in 3 s, with twice as many in 4 s.
const PIECES_OF_RADIAN: usize = 8;
const MOST_RADIANS: u64 = 8;

/// Bits of cosines and sines.
const WAVE_BITS: u64 = 44;

/// Bits of the numbers from which they are computed: near to the frequency 0 half of them are lost.
const BITS: u64 = 192;

/// Steps along the axis of which the cosine and the sine are kept.
const STEPS: usize = 96;

/// Of numbers of the whole product so many bits are used.
const PRODUCT_BITS: u32 = 122;

/// Below so many bits of a coefficient nothing is seen.
const LEAST_BITS: u32 = 16;

/// The dead time in a box of parameters, in the unit of time whose frequency is 1.
#[derive(Debug)]
pub(super) struct Turn {
    middle: Ball,
    /// Along each coordinate from -1 to 1.
    slopes: Vec<Ball>,
    /// How far it is from the linear function at most.
    rest: Ball,
    /// The sum of the moduli of the slopes, and of the rest.
    around: Ball,
    /// `|sin(tau omega)/omega|` is not above this power of two.
    exponent: u64,
    /// The cosine and the sine of a quarter of the middle, of half of that, and so on.
    steps: [OnceLock<[Ball; 2]>; STEPS],
}

impl Turn {
    /// Of a dead time that is nearly linear.
    pub fn new(tau: &Affine) -> Turn {
        let ball = |n: &Integer| Ball::from_units(n.clone(), n.clone(), tau.bits).with_bits(BITS);
        let slopes: Vec<Ball> = tau.slopes.iter().map(ball).collect();
        let around = tau.slopes.iter().fold(tau.rest.clone(), |sum, slope| sum + slope.abs());
        let most = &tau.middle.abs() + &around;
        let exponent = most.bit_length().saturating_sub(tau.bits);
        let (rest, around) = (ball(&tau.rest), ball(&around));
        Turn { middle: ball(&tau.middle), slopes, rest, around, exponent, steps: [const { OnceLock::new() }; STEPS] }
    }

    /// The cosine and the sine in the middle of a half of a piece, of those in the middle of the piece, after so many halvings.
    fn beside(&self, [cosine, sine]: &[Ball; 2], halvings: usize, is_above: bool) -> Option<[Ball; 2]> {
        let [c, s] = self.steps.get(halvings)?.get_or_init(|| {
            let (c, s) = cos_sin(&self.middle.shifted(-(halvings as i64) - 2));
            [c, s]
        });
        let s = if is_above { s.clone() } else { s.neg() };
        Some([cosine.mul(c).sub(&sine.mul(&s)), sine.mul(c).add(&cosine.mul(&s))])
    }

    /// `cos(tau u)` and `sin(tau u)/u` times `2^-exponent` for `u` between two numbers; what they are of the middle values is used if it is known, and
    /// is known after that if it is needed.
    fn waves(&self, [from, to]: [&Rational; 2], known: &mut Option<[Ball; 2]>) -> [Wave; 2] {
        let bits = self.middle.bits();
        let number = |x: &Rational| Ball::from_rational(x, bits);
        let radius = number(&(&(to - from) * &Rational::dyadic(&Integer::ONE, 1)));
        let (middle, last) = (number(&from.midpoint(to)), number(to));
        let turned = self.middle.mul(&radius);
        let is_long = |x: &Ball| x.magnitude_units() > Integer::ONE << bits;
        if is_long(&turned) || is_long(&self.around.mul(&last)) {
            return [Wave::any(self.slopes.len()), Wave::any(self.slopes.len())];
        }
        let [cosine, sine] = known.get_or_insert_with(|| {
            let (cosine, sine) = cos_sin(&self.middle.mul(&middle));
            [cosine, sine]
        });
        let square = turned.square().divided_by(2);
        let cube = square.mul(&turned).divided_by(3);
        let cosines = [cosine.clone(), sine.mul(&turned).neg(), cosine.mul(&square).neg(), sine.mul(&cube)];
        let sines = [sine.clone(), cosine.mul(&turned), sine.mul(&square).neg(), cosine.mul(&cube).neg()];
        // What the cubic leaves out, what the slopes change by on the piece, and the square of what they do.
        let size = |x: &Ball| Ball::from_units(Integer::ZERO, x.magnitude_units(), bits);
        let fourth = size(&square.square()).divided_by(6);
        let moved = size(&self.around.mul(&last));
        let on_piece = radius.add(&size(&middle.mul(&turned)));
        let left_out = fourth.add(&self.around.mul(&on_piece)).add(&self.rest.mul(&last)).add(&moved.square());
        let slopes = self.slopes.iter().map(|t| t.mul(&middle).mul(sine).neg()).collect::<Vec<Ball>>();
        let first = Wave::new(cosines, &slopes, &left_out, 0);
        let Some(quotients) = over(&sines, &middle, &radius) else {
            return [first, Wave::any(self.slopes.len())];
        };
        // |d^4/du^4 (sin(tau u)/u)| is at most tau^5/5.
        let tau = size(&self.middle);
        let fourth = tau.mul(&fourth).divided_by(5);
        let left_out = fourth.add(&self.around.mul(&size(&turned))).add(&self.rest);
        let left_out = left_out.add(&moved.mul(&self.around));
        let slopes = self.slopes.iter().map(|t| t.mul(cosine)).collect::<Vec<Ball>>();
        [first, Wave::new(quotients, &slopes, &left_out, self.exponent)]
    }
}

/// The first four coefficients in `x` of a series over `middle + radius x`; `None` at `middle = 0`.
fn over(series: &[Ball; 4], middle: &Ball, radius: &Ball) -> Option<[Ball; 4]> {
    let mut last = Ball::zero(middle.bits());
    let mut out = Vec::with_capacity(4);
    for s in series {
        last = s.sub(&radius.mul(&last)).div(middle)?;
        out.push(last.clone());
    }
    out.try_into().ok()
}

/// A cosine or a sine on a piece, in units of `2^-WAVE_BITS`.
struct Wave {
    /// The Bernstein coefficients times 1, 3, 3, 1.
    middle: [i128; 4],
    /// Along each coordinate.
    slopes: Vec<i128>,
    rest: i128,
}

impl Wave {
    /// Any number from -1 to 1, whatever the parameters are.
    fn any(parameters: usize) -> Wave {
        Wave { middle: [0; 4], slopes: vec![0; parameters], rest: 1 << WAVE_BITS }
    }

    /// Of the coefficients of powers of `x` from -1 to 1, times `2^-exponent`.
    fn new([c, d, e, f]: [Ball; 4], slopes: &[Ball], rest: &Ball, exponent: u64) -> Wave {
        let bits = c.bits();
        let shift = (bits - WAVE_BITS) + exponent;
        let mut off = Integer::from(8);
        let mut fixed = |x: &Ball| {
            off += &((x.width_units() >> shift) + Integer::ONE);
            (x.middle_units() >> shift).to_i128().expect("a number near one")
        };
        let [c, d, e, f] = [c, d, e, f].map(|x| fixed(&x));
        let slopes = slopes.iter().map(fixed).collect();
        let middle = [c - d + e - f, 3 * c - d - e + 3 * f, 3 * c + d - e - 3 * f, c + d + e + f];
        // The weights of one coefficient are 1/3 of 3 at most.
        let rest = (rest.magnitude_units() >> shift) + (off << 2);
        Wave { middle, slopes, rest: rest.to_i128().unwrap_or(i128::MAX >> 8) }
    }

    fn around(&self) -> i128 {
        self.slopes.iter().map(|s| s.abs()).sum::<i128>().saturating_add(self.rest)
    }
}

/// A function `p + c cos(tau omega) + s sin(tau omega)/omega`. Frequencies up to 1 are `y/2`, for `y` up to 2; the others are `2/(4 - y)`.
pub(super) struct AlongAxis {
    near: [AlongCircle; 3],
    /// Times a power of `4 - y`, and the last one with the sine alone.
    far: [AlongCircle; 3],
    turn: Arc<Turn>,
}

impl AlongAxis {
    /// Functions given by the coefficients of powers of `omega`, in lists of one length.
    pub fn all<C: NearlyLinear>(functions: Vec<Function<C, 3>>, turn: &Arc<Turn>) -> Vec<AlongAxis> {
        let length = functions.iter().flatten().map(Vec::len).max().unwrap_or(0);
        let far: Vec<Function<C, 3>> = functions.iter().map(beyond).collect();
        let far_length = far.iter().flatten().map(Vec::len).max().unwrap_or(0);
        let both = functions.into_iter().zip(far);
        both.map(|(near, far)| {
            let [p, c, s] = near;
            let power = Integer::ONE << turn.exponent;
            let s = s.iter().map(|x| x.scaled(&power)).collect();
            AlongAxis {
                near: [p, c, s].map(|p| AlongCircle::up_to(p, length, 0)),
                far: far.map(|p| AlongCircle::up_to(p, far_length, 0).reversed()),
                turn: Arc::clone(turn),
            }
        })
        .collect()
    }

    fn parts_on(&self, [lower, upper]: [&Rational; 2]) -> [Patch; 3] {
        let two = Rational::from(2);
        match is_near(upper) {
            true => AlongCircle::all_on(self.near.each_ref(), [&(lower * &two), &(upper * &two)]),
            false => AlongCircle::all_on(self.far.each_ref(), [&(&(lower - &two) * &two), &(&(upper - &two) * &two)]),
        }
    }
}

fn is_near(upper: &Rational) -> bool {
    *upper <= Rational::from(2)
}

/// The function times a power of `1/omega`, in powers of it; the last polynomial is divided by `omega` first.
fn beyond<C: Coefficient>(f: &Function<C, 3>) -> Function<C, 3> {
    let degree = |p: &Vec<C>| p.iter().rposition(|c| !c.is_zero());
    let [p, c, s] = f.each_ref().map(degree);
    let power = p.max(c).max(s.map(|s| s.saturating_sub(1))).unwrap_or(0);
    let nothing = f[0][0].scaled(&Integer::ZERO);
    std::array::from_fn(|i| {
        let more = usize::from(i == 2);
        let mut out = vec![nothing.clone(); power + 1 + more];
        for (k, c) in f[i].iter().enumerate().filter(|(_, c)| !c.is_zero()) {
            out[power + more - k] = c.clone();
        }
        out
    })
}

/// The function on a piece.
#[derive(Clone)]
pub(super) struct AxisPiece {
    ends: [Rational; 2],
    parts: [Patch; 3],
    turn: Arc<Turn>,
    /// The cosine and the sine in the middle, for the middle of the box, where they are known before the whole is.
    turned: Option<[Ball; 2]>,
    /// The function, and the cosine and the sine if they were needed for it.
    whole: OnceLock<(Patch, Option<[Ball; 2]>)>,
}

impl AxisPiece {
    fn new(ends: [Rational; 2], parts: [Patch; 3], turn: &Arc<Turn>, turned: Option<[Ball; 2]>) -> AxisPiece {
        AxisPiece { ends, parts, turn: Arc::clone(turn), turned, whole: OnceLock::new() }
    }

    /// Many pieces are halved without a look at this function.
    fn whole(&self) -> &(Patch, Option<[Ball; 2]>) {
        self.whole.get_or_init(|| {
            let any = || Wave::any(self.turn.slopes.len());
            if !is_near(&self.ends[1]) || self.parts[1..].iter().all(Patch::is_nothing) {
                return (sum(&self.parts, &[any(), any()]), self.turned.clone());
            }
            let half = Rational::dyadic(&Integer::ONE, 1);
            let mut turned = self.turned.clone();
            let waves = self.turn.waves([&(&self.ends[0] * &half), &(&self.ends[1] * &half)], &mut turned);
            (sum(&self.parts, &waves), turned)
        })
    }
}

impl Along for AlongAxis {
    type Piece = AxisPiece;

    fn pieces() -> Vec<[Rational; 2]> {
        let [zero, two, four] = [0, 2, 4].map(Rational::from);
        vec![[zero, two.clone()], [two, four]]
    }

    fn on(&self, ends: [&Rational; 2]) -> AxisPiece {
        AxisPiece::new(ends.map(Clone::clone), self.parts_on(ends), &self.turn, None)
    }

    fn more_pieces(&self) -> usize {
        PIECES_OF_RADIAN << self.turn.exponent.min(MOST_RADIANS)
    }
}

impl OnPiece for AxisPiece {
    fn patch(&self) -> &Patch {
        &self.whole().0
    }

    fn first(&self) -> AxisPiece {
        AxisPiece { whole: OnceLock::from((self.patch().first(), None)), ..self.clone() }
    }

    fn is_blurred(&self) -> bool {
        Patch::are_blurred(&self.parts)
    }

    /// On a long piece the cosine and the sine are any numbers.
    fn is_coarse(&self) -> bool {
        is_near(&self.ends[1]) && self.whole().1.is_none() && !self.parts[1..].iter().all(Patch::is_nothing)
    }
}

impl Halves for AxisPiece {
    fn halves(self, axis: usize) -> [AxisPiece; 2] {
        let turned = self.whole.into_inner().map_or(self.turned, |(_, turned)| turned);
        let [lower, upper] = self.ends;
        let middle = lower.midpoint(&upper);
        let [p, c, s] = self.parts.map(|patch| patch.halves(axis));
        let ([p, after_p], [c, after_c], [s, after_s]) = (p, c, s);
        let halvings = halvings_of(&(&upper - &lower));
        let [below, above] = [false, true]
            .map(|is_above| turned.as_ref().and_then(|known| self.turn.beside(known, halvings?, is_above)));
        let low = AxisPiece::new([lower, middle.clone()], [p, c, s], &self.turn, below);
        [low, AxisPiece::new([middle, upper], [after_p, after_c, after_s], &self.turn, above)]
    }
}

/// How often the piece of frequencies up to 1 was halved, of the width of a part in `y`; `None` of one that is no half of halves.
fn halvings_of(width: &Rational) -> Option<usize> {
    let of_one = width * &Rational::dyadic(&Integer::ONE, 1);
    (of_one.numerator() == Integer::ONE).then(|| of_one.denominator().bit_length() as usize - 1)
}

/// `p + c w + s v` of polynomials on a piece and two waves there.
fn sum(parts: &[Patch; 3], waves: &[Wave; 2]) -> Patch {
    let degree = parts[0].rest.len() - 1;
    let (own, raised) = (choices(degree), choices(degree + 3));
    let greatest = |patch: &Patch| patch.columns.iter().flatten().chain(&patch.rest).map(|v| v.abs()).max();
    let size = |n: i128| 128 - n.unsigned_abs().leading_zeros();
    let bits = size(parts.iter().filter_map(greatest).max().unwrap_or(0));
    let room = PRODUCT_BITS.saturating_sub(WAVE_BITS as u32 + 6 + size(own[degree / 2]));
    let columns = parts[0].columns.len();
    if room < LEAST_BITS {
        let column = vec![0; degree + 4];
        return Patch { columns: vec![column; columns], rest: vec![1; degree + 4], error: 0 };
    }
    let shift = bits.saturating_sub(room);
    let reduced = |column: &[i128]| -> Vec<i128> { column.iter().map(|v| v >> shift).collect() };
    let product = |p: &[i128], wave: &[i128; 4], down: u64| with_cubic((p, &own), wave, &raised, down);
    let even = [1, 3, 3, 1];
    let mut out = Patch {
        columns: parts[0].columns.iter().map(|column| product(&reduced(column), &even, 0)).collect(),
        rest: vec![0; degree + 4],
        // Each number is rounded down twice in each product.
        error: 6 * columns as i128 + 6,
    };
    // What rounding takes away before the products.
    let lost = |patch: &Patch| (patch.error >> shift) + 1 + columns as i128;
    let plain: Vec<i128> = parts[0].rest.iter().map(|r| (r >> shift) + lost(&parts[0])).collect();
    let mut rests = vec![(plain, even, 0)];
    for (patch, wave) in parts[1..].iter().zip(waves) {
        let all: Vec<Vec<i128>> = patch.columns.iter().map(|column| reduced(column)).collect();
        for (k, column) in all.iter().enumerate() {
            for (at, v) in out.columns[k].iter_mut().zip(product(column, &wave.middle, WAVE_BITS)) {
                *at += v;
            }
        }
        for (k, slope) in wave.slopes.iter().enumerate() {
            for (at, v) in out.columns[k + 1].iter_mut().zip(product(&all[0], &even.map(|c| c * slope), WAVE_BITS)) {
                *at += v;
            }
        }
        let most = wave.middle.iter().map(|v| v.abs()).max().unwrap_or(0);
        let around = wave.around().min(1 << (WAVE_BITS + 2));
        let size = |i: usize| {
            let across: i128 = all[1..].iter().map(|column| column[i].abs()).sum();
            let own = (patch.rest[i] >> shift) + lost(patch);
            // The middle times the wave's rest, the slopes times all but the wave's middle, and the rest times all.
            [(all[0][i].abs(), wave.rest.min(1 << (WAVE_BITS + 2))), (across, around), (own, most + around)]
        };
        for pair in 0..3 {
            let (numbers, factors): (Vec<i128>, Vec<i128>) = (0..=degree).map(|i| size(i)[pair]).unzip();
            rests.push((numbers, even.map(|c| c * factors[0]), WAVE_BITS));
        }
    }
    for (numbers, wave, down) in rests {
        for (at, v) in out.rest.iter_mut().zip(product(&numbers, &wave, down)) {
            *at += v + 2;
        }
    }
    out
}

/// A polynomial in Bernstein's basis, whose binomials are known, times a cubic, over a power of two; `raised` are the binomials of the product.
fn with_cubic((p, own): (&[i128], &[i128]), wave: &[i128; 4], raised: &[i128], down: u64) -> Vec<i128> {
    let one = |k: usize| {
        let pairs = (0..4).filter_map(|j| Some((j, k.checked_sub(j).filter(|i| *i < own.len())?)));
        let sum: i128 = pairs.map(|(j, i)| own[i] * p[i] * wave[j]).sum();
        sum.div_euclid(raised[k]) >> down
    };
    (0..raised.len()).map(one).collect()
}

/// How many ways there are to choose some of so many.
fn choices(n: usize) -> Vec<i128> {
    let mut out: Vec<i128> = vec![1];
    for k in 0..n as i128 {
        let next = out[k as usize].checked_mul(n as i128 - k).map_or(i128::MAX, |c| c / (k + 1));
        out.push(next);
    }
    out
}

#[cfg(test)]
mod tests;
