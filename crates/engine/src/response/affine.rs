//! Polynomials along the circle whose coefficients are nearly linear in a box of parameters.

use super::along_circle::{Coefficient, NearlyLinear};
use crate::stability::subdivision::Halves;
use jurist_algebra::ball::Ball;
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::bernstein_weights;

/// A linear function of coordinates from -1 to 1, up to a bound; all in units of the last place.
#[derive(Clone, Debug)]
pub(super) struct Affine {
    pub middle: Integer,
    pub slopes: Vec<Integer>,
    /// How far the function is from the linear one at most.
    pub rest: Integer,
    pub bits: u64,
}

impl Affine {
    /// The sign that it has everywhere, if that is seen and not zero.
    pub fn sign(&self) -> Option<Sign> {
        let around = self.slopes.iter().fold(self.rest.clone(), |sum, slope| sum + slope.abs());
        (self.middle.abs() > around).then(|| self.middle.sign())
    }
}

/// A polynomial on the circle, `y` from 0 to 4, by its Bernstein coefficients times a positive number. Each is a linear function of coordinates
/// from -1 to 1 up to a bound. In that basis the bounds are as small as what they bound: powers of `y` cancel one another.
#[derive(Clone, Debug)]
pub(super) struct AlongCircle {
    /// The linear functions' middles, then what each coordinate is multiplied by.
    columns: Vec<Vec<Ball>>,
    /// How far the coefficients are from linear functions.
    rest: Vec<Ball>,
}

/// The greatest number of a fresh patch has this many bits.
const BITS: u64 = 96;

/// A patch whose numbers have sunk below this many bits above their error is computed again.
const SPARE_BITS: u32 = 16;

/// Bits of a multiple that is added.
const MULTIPLE_BITS: u32 = 24;

impl AlongCircle {
    /// From coefficients of powers of `y`, read with the degree `length - 1`.
    ///
    /// Cost: half the square of the degree, in sums of coefficients.
    pub fn new<C: NearlyLinear>(p: Vec<C>, length: usize) -> AlongCircle {
        AlongCircle::up_to(p, length, 2)
    }

    /// The same for `y` from 0 to a power of two.
    pub fn up_to<C: NearlyLinear>(mut p: Vec<C>, length: usize, exponent: u64) -> AlongCircle {
        let zero = p[0].scaled(&Integer::ZERO);
        p.resize(length, zero);
        let all: Vec<Affine> = bernstein(p, exponent).iter().map(C::affine).collect();
        let bits = all[0].bits;
        let ball = |n: &Integer| Ball::from_units(n.clone(), n.clone(), bits);
        let slopes = (0..all[0].slopes.len()).map(|k| all.iter().map(|f| ball(&f.slopes[k])).collect());
        let middles = all.iter().map(|f| ball(&f.middle)).collect();
        let rest = all.iter().map(|f| ball(&f.rest)).collect();
        AlongCircle { columns: std::iter::once(middles).chain(slopes).collect(), rest }
    }

    /// As a function of what is left of `y` to its end.
    pub fn reversed(mut self) -> AlongCircle {
        self.columns.iter_mut().chain([&mut self.rest]).for_each(|column| column.reverse());
        self
    }

    /// The polynomial on a piece of the circle; at a point where the ends are the same.
    ///
    /// Cost: `d^2` products for the degree `d`, for each coordinate.
    pub fn on(&self, ends: [&Rational; 2]) -> Patch {
        let [patch] = AlongCircle::all_on([self], ends);
        patch
    }

    /// Polynomials of one degree on a piece, in the same unit.
    pub fn all_on<const N: usize>(all: [&AlongCircle; N], [lower, upper]: [&Rational; 2]) -> [Patch; N] {
        let quarter = |y: &Rational| y * &Rational::dyadic(&Integer::ONE, 2);
        let (from, to) = (quarter(lower), quarter(upper));
        let coefficients = |p: &Vec<Ball>| match from == to {
            true => vec![split(p, &from)[1][0].clone()],
            false => {
                let beyond = &split(p, &from)[1];
                let share =
                    (&to - &from).checked_div(&(&Rational::ONE - &from)).expect("a piece begins before its end");
                split(beyond, &share)[0].clone()
            }
        };
        let pieces = all.map(|p| {
            let columns: Vec<Vec<Ball>> = p.columns.iter().map(coefficients).collect();
            let rest: Vec<Integer> = coefficients(&p.rest).iter().map(Ball::magnitude_units).collect();
            (columns, rest)
        });
        let size = |(columns, rest): &(Vec<Vec<Ball>>, Vec<Integer>)| {
            let sizes = columns.iter().flatten().map(|b| b.magnitude_units().bit_length());
            sizes.chain(rest.iter().map(Integer::bit_length)).max().unwrap_or(0)
        };
        let shift = pieces.iter().map(size).max().unwrap_or(0).saturating_sub(BITS);
        let fixed = |n: &Integer| (n >> shift).to_i128().expect("so many bits fit");
        pieces.map(|(columns, rest)| {
            // What the columns are off together.
            let width =
                |k: usize| columns.iter().fold(Integer::ZERO, |sum, c| sum + (c[k].width_units() + Integer::ONE));
            Patch {
                rest: rest.iter().enumerate().map(|(k, rest)| fixed(&(rest + &width(k))) + 1).collect(),
                error: if shift > 0 { columns.len() as i128 } else { 0 },
                columns: columns.iter().map(|c| c.iter().map(|b| fixed(&b.middle_units())).collect()).collect(),
            }
        })
    }
}

/// The Bernstein coefficients for `y` from 0 to a power of two, times a positive number that depends on the degree alone.
fn bernstein<C: Coefficient>(p: Vec<C>, exponent: u64) -> Vec<C> {
    let d = p.len() - 1;
    let weights = bernstein_weights(d);
    let scale = |(k, c): (usize, C)| c.scaled(&(&weights[k] << (exponent * k as u64)));
    let mut c: Vec<C> = p.into_iter().enumerate().map(scale).collect();
    for r in 1..=d {
        for k in (r..=d).rev() {
            c[k] = c[k].plus(&c[k - 1]);
        }
    }
    c
}

/// The Bernstein coefficients below and above a share, from 0 to 1, of where they are known (de Casteljau).
fn split(c: &[Ball], share: &Rational) -> [Vec<Ball>; 2] {
    if share.is_zero() {
        return [vec![c[0].clone(); c.len()], c.to_vec()];
    }
    let bits = c[0].bits();
    let [below, above] = [&Rational::ONE - share, share.clone()].map(|x| Ball::from_rational(&x, bits));
    let (mut lower, mut upper) = (Vec::with_capacity(c.len()), c.to_vec());
    for k in (1..=c.len()).rev() {
        lower.push(upper[0].clone());
        for i in 0..k - 1 {
            upper[i] = upper[i].mul(&below).add(&upper[i + 1].mul(&above));
        }
    }
    [lower, upper]
}

/// Bernstein coefficients of a polynomial on a piece of the circle, times an unknown positive factor: each is a linear function of
/// coordinates from -1 to 1, up to a bound.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    /// Middles, then the factors of each coordinate.
    pub(super) columns: Vec<Vec<i128>>,
    /// A bound for each coefficient.
    pub(super) rest: Vec<i128>,
    /// What rounding adds to each bound.
    pub(super) error: i128,
}

impl Patch {
    /// The sign on the whole piece and in the whole box, if that is seen and not zero.
    pub fn sign(&self) -> Option<Sign> {
        let is = |k: usize| self.sign_of(k);
        let first = is(0)?;
        (1..self.rest.len()).all(|k| is(k) == Some(first)).then_some(first)
    }

    fn sign_of(&self, k: usize) -> Option<Sign> {
        let around = self.columns[1..].iter().fold(self.rest[k] + self.error, |sum, column| sum + column[k].abs());
        let middle = self.columns[0][k];
        (middle.abs() > around).then_some(if middle > 0 { Sign::Greater } else { Sign::Less })
    }

    /// The value at the lower end of the piece.
    pub fn first(&self) -> Patch {
        Patch {
            columns: self.columns.iter().map(|c| vec![c[0]]).collect(),
            rest: vec![self.rest[0]],
            error: self.error,
        }
    }

    /// Whether it is 0 up to the last digit of what it stands beside.
    pub fn is_nothing(&self) -> bool {
        self.columns.iter().flatten().all(|c| *c == 0) && self.rest.iter().all(|c| *c <= self.columns.len() as i128 + 1)
    }

    /// Whether so many digits are lost that the patch is to be computed again.
    pub fn is_blurred(&self) -> bool {
        Patch::are_blurred(std::slice::from_ref(self))
    }

    /// The same of the largest of several in one unit.
    pub fn are_blurred(all: &[Patch]) -> bool {
        let greatest = all.iter().flat_map(|p| p.columns.iter().flatten()).map(|v| v.abs()).max().unwrap_or(0);
        all.iter().any(|p| greatest >> SPARE_BITS < p.error)
    }

    /// The sign wherever another polynomial is zero: that of a sum with a multiple of the other one. With a good multiple both have the
    /// same slope along some coordinate, or along the piece.
    ///
    /// # Panics
    /// When the polynomials have not as many coefficients.
    pub fn sign_beside(&self, zero: Option<&Patch>) -> Option<Sign> {
        self.sign().or_else(|| {
            let zero = zero?;
            assert_eq!(self.rest.len(), zero.rest.len(), "as many coefficients");
            let middle = self.rest.len() / 2;
            let ends = |p: &Patch| p.columns[0][p.rest.len() - 1] - p.columns[0][0];
            let along = std::iter::once((ends(self), ends(zero)));
            let across = self.columns[1..].iter().zip(&zero.columns[1..]).map(|(a, b)| (a[middle], b[middle]));
            along.chain(across).find_map(|(own, theirs)| {
                let (by, shift) = multiple(own, theirs)?;
                self.plus(zero, by, shift).sign()
            })
        })
    }

    /// `2^-shift` times the patch, or times the other one where the shift is negative, and the other one times an integer.
    fn plus(&self, other: &Patch, by: i128, shift: i32) -> Patch {
        let (own, theirs) = if shift > 0 { (shift as u32, 0) } else { (0, shift.unsigned_abs()) };
        let sum = |a: &i128, b: &i128| (a >> own.min(127)) + ((b * by) >> theirs.min(127));
        let bound = |a: &i128, b: &i128| (a >> own.min(127)) + ((b * by.abs()) >> theirs.min(127)) + 2;
        let columns = self.columns.iter().zip(&other.columns);
        Patch {
            columns: columns.map(|(a, b)| a.iter().zip(b).map(|(a, b)| sum(a, b)).collect()).collect(),
            rest: self.rest.iter().zip(&other.rest).map(|(a, b)| bound(a, b)).collect(),
            // Each number of each column is rounded twice.
            error: bound(&self.error, &other.error) + 2 * self.columns.len() as i128,
        }
    }
}

/// An integer of few bits and a shift with which `own 2^-shift + theirs by`, or `own + theirs by 2^shift` for a negative shift, is near to
/// zero.
fn multiple(own: i128, theirs: i128) -> Option<(i128, i32)> {
    if theirs == 0 || own == 0 {
        return None;
    }
    let size = |n: i128| 128 - n.unsigned_abs().leading_zeros() as i32;
    // own/theirs times 2^-shift has the bits of a multiple.
    let shift = size(own) - size(theirs) - MULTIPLE_BITS as i32 + 1;
    let down = |n: i128| {
        let more = size(n) - 2 * MULTIPLE_BITS as i32;
        if more > 0 { (n >> more, more) } else { (n, 0) }
    };
    let ((a, a_shift), (b, b_shift)) = (down(own), down(theirs));
    let by = a_shift - b_shift - shift;
    let scaled = if by >= 0 { a.checked_shl(by as u32)? } else { a >> by.unsigned_abs().min(127) };
    let quotient = -scaled.checked_div(b)?;
    (quotient != 0).then_some((quotient, shift))
}

impl Halves for Patch {
    fn halves(self, _axis: usize) -> [Patch; 2] {
        let d = self.rest.len() as i128 - 1;
        // Middles of pairs are rounded down in each of d steps; bounds are rounded up.
        let error = self.error + (self.columns.len() as i128) * (d / 2 + 1);
        let split = |column: &[i128], up: i128| {
            let (mut lower, mut upper) = (Vec::with_capacity(column.len()), column.to_vec());
            for k in (1..=column.len()).rev() {
                lower.push(upper[0]);
                for i in 0..k - 1 {
                    upper[i] = (upper[i] + upper[i + 1] + up) >> 1;
                }
            }
            (lower, upper)
        };
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for column in &self.columns {
            let (lower, upper) = split(column, 0);
            low.push(lower);
            high.push(upper);
        }
        let (low_rest, high_rest) = split(&self.rest, 1);
        [Patch { columns: low, rest: low_rest, error }, Patch { columns: high, rest: high_rest, error }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn patch(middle: &[i128], slopes: &[&[i128]], rest: i128) -> Patch {
        let columns = std::iter::once(middle).chain(slopes.iter().copied()).map(<[i128]>::to_vec).collect();
        Patch { columns, rest: vec![rest; middle.len()], error: 0 }
    }

    /// Where y is 1/2 + x/2 the function 10 + 30 (y - 1/2) - 14 x is 10 + x, though it changes its sign in the square.
    #[test]
    fn a_function_keeps_its_sign_where_another_one_vanishes() {
        let scale = 1_000_000;
        let f = patch(&[-5 * scale, 25 * scale], &[&[-14 * scale; 2]], 1);
        let zero = patch(&[-scale, scale], &[&[-scale; 2]], 1);
        assert_eq!((f.sign(), f.sign_beside(Some(&zero))), (None, Some(Sign::Greater)));
        // The same function has both signs where y is 1/2 - x/2.
        let other = patch(&[-scale, scale], &[&[scale; 2]], 1);
        assert_eq!((f.sign_beside(Some(&other)), f.sign_beside(None)), (None, None));
        let negative = patch(&[-1000, -999], &[&[10, 10]], 1);
        assert_eq!(negative.sign_beside(None), Some(Sign::Less));
    }

    proptest! {
        /// A sign that is claimed where another polynomial vanishes is that at each point where it does.
        #[test]
        fn signs_beside_zeros_are_those_at_points(
            f in prop::array::uniform6(-1000i128..1000), g in prop::array::uniform6(-1000i128..1000), halvings in 0usize..4, path in 0usize..16
        ) {
            let of = |c: &[i128; 6]| {
                let c = c.map(|c| c << 40);
                patch(&c[..3], &[&c[3..]], 0)
            };
            let (mut f_part, mut g_part) = (of(&f), of(&g));
            let (mut low, mut length) = (0.0f64, 1.0f64);
            for bit in 0..halvings {
                let upper = path >> bit & 1;
                f_part = f_part.halves(0)[upper].clone();
                g_part = g_part.halves(0)[upper].clone();
                length /= 2.0;
                low += length * upper as f64;
            }
            let at = |c: &[i128], t: f64| {
                let c: Vec<f64> = c.iter().map(|c| *c as f64).collect();
                c[0] * (1.0 - t).powi(2) + c[1] * 2.0 * t * (1.0 - t) + c[2] * t * t
            };
            if let Some(sign) = f_part.sign_beside(Some(&g_part)) {
                for k in 0..=64 {
                    let t = low + length * f64::from(k) / 64.0;
                    let x = -at(&g[..3], t) / at(&g[3..], t);
                    if x.abs() <= 1.0 {
                        let value = at(&f[..3], t) + at(&f[3..], t) * x;
                        prop_assert!(value.abs() < 1e-6 || (value > 0.0) == sign.is_gt());
                    }
                }
            }
        }
    }
}
