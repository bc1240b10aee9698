//! How many roots are inside of the edge of a damping, a logarithmic spiral, for all points of a box of parameters at once.
//!
//! On an arc about the angle `phi` the point `z0 = exp((-c + j) phi)` moves by `z0 (-c + j) t + ...`, and the polynomial is
//! `P(z0; p) + P'(z0; p) z0 (-c + j) t + ...` with coefficients that are nearly linear in the parameters. It keeps to the half plane about its value
//! in the middle where nothing of this moves it as far. The turns of these half planes are those of its argument, for all points of the box.

use super::affine::Affine;
use super::along_circle::NearlyLinear;
use super::spiral::{Arc, Complex, Constants, FIRST_LEVEL, Origin, point};
use crate::stability::subdivision::{Halves, Look, Order, Tally, subdivide};
use jurist_algebra::ball::{Ball, MultiTaylorModel};
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};

/// So many arcs are looked at.
const MOST_ARCS: usize = 600;

/// An arc is not halved more often.
const MOST_HALVINGS: u64 = 48;

/// Bits after the point.
const BITS: u64 = 256;

/// A coefficient near a linear function of coordinates from -1 to 1.
struct Linear {
    middle: Ball,
    slopes: Vec<Ball>,
    /// A bound of how far it is off.
    rest: Ball,
    /// A bound of its modulus.
    most: Ball,
}

impl Linear {
    fn of(model: &MultiTaylorModel) -> Linear {
        let Affine { middle, slopes, rest, bits } = model.affine();
        let ball = |n: &Integer| Ball::from_units(n.clone(), n.clone(), bits).with_bits(BITS);
        let most = slopes.iter().fold(&middle.abs() + &rest, |sum, slope| sum + slope.abs());
        Linear {
            middle: ball(&middle),
            slopes: slopes.iter().map(ball).collect(),
            rest: ball(&rest),
            most: ball(&most),
        }
    }
}

/// The coefficients of the powers of `z - 1`.
pub(super) fn from_one(coefficients: &[MultiPoly]) -> Vec<MultiPoly> {
    let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
    let mut moved = Poly::new(coefficients.to_vec()).compose(&one_more).into_coeffs();
    moved.resize(coefficients.len(), MultiPoly::zero());
    moved
}

/// A sum of coefficients times complex numbers.
struct Sum {
    middle: Complex,
    slopes: Vec<Complex>,
    rest: Ball,
}

impl Sum {
    fn of<'c>(terms: impl Iterator<Item = (&'c Linear, Complex)>, parameters: usize) -> Sum {
        let mut sum = Sum {
            middle: Complex::zero(BITS),
            slopes: (0..parameters).map(|_| Complex::zero(BITS)).collect(),
            rest: Ball::zero(BITS),
        };
        for (c, z) in terms {
            sum.middle = sum.middle.plus(&z.scaled(&c.middle));
            for (slope, own) in sum.slopes.iter_mut().zip(&c.slopes) {
                *slope = slope.plus(&z.scaled(own));
            }
            sum.rest = sum.rest.add(&modulus(&z).mul(&c.rest));
        }
        sum
    }
}

/// A bound of the modulus: the sum of those of both parts.
fn modulus(z: &Complex) -> Ball {
    magnitude(&z.re).add(&magnitude(&z.im))
}

fn magnitude(x: &Ball) -> Ball {
    let units = x.magnitude_units();
    Ball::from_units(units.clone(), units, x.bits())
}

/// The part along a direction, times its length.
fn dot(u: &[Ball; 2], v: &Complex) -> Ball {
    u[0].mul(&v.re).add(&u[1].mul(&v.im))
}

/// An arc with its middle.
struct Piece<'s> {
    arc: Arc,
    middle: Complex,
    spiral: &'s Spiral,
}

impl Halves for Piece<'_> {
    fn halves(self, _: usize) -> [Self; 2] {
        let turns = &self.spiral.levels[(self.arc.level - FIRST_LEVEL) as usize].turns;
        let mut middles = turns.iter().map(|turn| self.middle.times(turn));
        self.arc.parts().map(|arc| {
            let middle = middles.next().expect("two halves");
            Piece { arc, middle, spiral: self.spiral }
        })
    }
}

/// What arcs of one length have in common.
struct Level {
    /// Half of the angle.
    half: Ball,
    /// How far `(-c + j) t` goes at most on half of the arc; beyond a half arcs are too long.
    farthest: Ball,
    /// What brings the middle of an arc to those of its halves.
    turns: [Complex; 2],
}

/// The edge of a damping.
pub(super) struct Spiral {
    constants: Constants,
    /// The middles of the arcs of the first level.
    first: Vec<Complex>,
    levels: Vec<Level>,
}

impl Spiral {
    /// Cost: exponentials for each arc of the first level and each level.
    pub fn new(damping: &Rational) -> Spiral {
        let constants = Constants::new(damping, BITS);
        let middle = |k: i64| point(&Rational::dyadic(&Integer::from(2 * k + 1), FIRST_LEVEL + 1), &constants);
        let first = (0..1i64 << FIRST_LEVEL).map(middle).collect();
        let one = Ball::from_integer(&Integer::ONE, BITS);
        let level = |level: u64| {
            let half = constants.pi.shifted(-(level as i64) - 1);
            let farthest = half.mul(&constants.decay.add(&one));
            let quarter = Rational::dyadic(&Integer::ONE, level + 2);
            let turns = [-&quarter, quarter].map(|angle| point(&angle, &constants));
            Level { half, farthest, turns }
        };
        let levels = (FIRST_LEVEL..=MOST_HALVINGS).map(level).collect();
        Spiral { constants, first, levels }
    }

    fn pieces(&self) -> impl Iterator<Item = Piece<'_>> {
        let arc = |at: i64| Arc { at: Integer::from(at), level: FIRST_LEVEL };
        let middles = self.first.iter().cloned();
        (0..).map(arc).zip(middles).map(|(arc, middle)| Piece { arc, middle, spiral: self })
    }
}

/// A polynomial with the coefficients of the powers of `z` and of `z - 1`.
pub(super) struct BoxOnSpiral<'s> {
    coefficients: [Vec<Linear>; 2],
    parameters: usize,
    spiral: &'s Spiral,
}

/// What is seen of an arc.
enum Seen {
    /// The polynomial stays in the half plane about this vector.
    Clear([Integer; 2]),
    /// It may vanish in its middle for some point of the box.
    Lost,
    /// Halves of the arc show more.
    TooLong,
}

impl<'s> BoxOnSpiral<'s> {
    /// Of the coefficients of the powers of `z` and of `z - 1` in a box.
    pub fn new([from_zero, from_one]: [&[MultiTaylorModel]; 2], spiral: &'s Spiral) -> BoxOnSpiral<'s> {
        let coefficients = [from_zero, from_one].map(|list| list.iter().map(Linear::of).collect::<Vec<_>>());
        let parameters = coefficients[0].first().map_or(0, |c| c.slopes.len());
        BoxOnSpiral { coefficients, parameters, spiral }
    }

    /// The number of roots inside of the edge that all points of the box have; `None` where a root may be on it for some of them.
    ///
    /// Cost: values on some dozen arcs, where the box is small beside the distance of the roots.
    pub fn count(&self) -> Option<usize> {
        let mut found: Vec<(Rational, [Integer; 2])> = Vec::new();
        let look = |piece: &mut Piece, tally: Tally| {
            checkpoint(BITS * self.coefficients[0].len() as u64);
            Ok(match self.seen(piece) {
                Seen::Clear(towards) => {
                    let [from, _] = piece.arc.ends();
                    found.push((from, towards));
                    Look::Decided(())
                }
                Seen::TooLong if tally.looks() < MOST_ARCS && piece.arc.level < MOST_HALVINGS => Look::Cut(0),
                Seen::TooLong | Seen::Lost => Look::Open(()),
            })
        };
        let ended = subdivide(self.spiral.pieces(), Order::Breadth, &Budget::unlimited(), look);
        ended.ok()?.ok()?;
        found.sort_by(|a, b| a.0.cmp(&b.0));
        half_turns(found.into_iter().map(|(_, towards)| towards))
    }

    fn seen(&self, piece: &Piece) -> Seen {
        let origin = Origin::of(&piece.arc.ends());
        let list = &self.coefficients[origin as usize];
        let w = origin.to(&piece.middle);
        let mut powers = vec![Complex { re: Ball::from_integer(&Integer::ONE, BITS), im: Ball::zero(BITS) }];
        for k in 1..list.len() {
            powers.push(powers[k - 1].times(&w));
        }
        let value = Sum::of(list.iter().zip(powers.iter().cloned()), self.parameters);
        // The direction of the value in the middle, in whose half plane all is to be.
        let units = |x: &Ball| Ball::from_units(x.middle_units(), x.middle_units(), BITS);
        let towards = [units(&value.middle.re), units(&value.middle.im)];
        let length = magnitude(&towards[0]).add(&magnitude(&towards[1]));
        let across = value.slopes.iter().map(|slope| magnitude(&dot(&towards, slope)));
        let across = across.fold(length.mul(&value.rest), |sum, x| sum.add(&x));
        let left = dot(&towards, &value.middle).sub(&across);
        if !is_positive(&left) {
            return Seen::Lost;
        }
        match self.moved(list, (&powers, &w), piece, (&towards, &length)) {
            Some(moved) if is_positive(&left.sub(&moved)) => Seen::Clear(towards.each_ref().map(Ball::middle_units)),
            _ => Seen::TooLong,
        }
    }

    /// How far in a direction, times its length, the polynomial moves on the arc at most; `None` where the arc is long.
    fn moved(
        &self,
        list: &[Linear],
        (powers, w): (&[Complex], &Complex),
        piece: &Piece,
        (towards, length): (&[Ball; 2], &Ball),
    ) -> Option<Ball> {
        let with = &self.spiral.constants;
        let Level { half, farthest, .. } = &self.spiral.levels[(piece.arc.level - FIRST_LEVEL) as usize];
        if farthest.upper() > Rational::dyadic(&Integer::ONE, 1) {
            return None;
        }
        let times = |k: usize| Integer::from(k as u64);
        let slope = list.iter().enumerate().skip(1).map(|(k, c)| {
            let power = &powers[k - 1];
            (c, Complex { re: power.re.scaled(&times(k)), im: power.im.scaled(&times(k)) })
        });
        let Sum { middle, slopes, rest } = Sum::of(slope, self.parameters);
        let turn = Complex { re: with.decay.neg(), im: Ball::from_integer(&Integer::ONE, BITS) };
        let along = middle.times(&piece.middle).times(&turn).scaled(half);
        let size = modulus(&piece.middle);
        let off = slopes.iter().map(modulus).fold(rest, |sum, slope| sum.add(&slope));
        // |exp(x) - 1 - x| <= |x|^2 exp(|x|)/2, |exp(x) - 1| <= |x| exp(|x|), and exp(|x|) <= 2.
        let bend = size.mul(farthest).mul(farthest);
        let radius = size.mul(farthest).shifted(1);
        let outermost = modulus(w).add(&radius);
        let mut power = Ball::from_integer(&Integer::ONE, BITS);
        let mut second = Ball::zero(BITS);
        for (k, c) in list.iter().enumerate().skip(2) {
            second = second.add(&c.most.mul(&power).scaled(&times(k * (k - 1))));
            power = power.mul(&outermost);
        }
        let beside = off.mul(&size).mul(farthest);
        let bent = modulus(&middle).add(&off).mul(&bend).add(&second.mul(&radius).mul(&radius).shifted(-1));
        Some(magnitude(&dot(towards, &along)).add(&length.mul(&beside.add(&bent))))
    }
}

/// By how many half turns a function turns that is real at both ends and stays in the half planes about these vectors, one after the other: of
/// neighbours it is in both at once, so that less than half a turn is between them.
fn half_turns(vectors: impl Iterator<Item = [Integer; 2]>) -> Option<usize> {
    let mut all: Vec<[Integer; 2]> = vectors.collect();
    // At the ends the function is on the side of the real axis that is in the half plane.
    let along = |v: &[Integer; 2]| (!v[0].is_zero()).then(|| [v[0].clone(), Integer::ZERO]);
    let (first, last) = (along(all.first()?)?, along(all.last()?)?);
    all.insert(0, first);
    all.push(last);
    let is_below = |[re, im]: &[Integer; 2]| im.is_negative() || (im.is_zero() && re.is_negative());
    let step = |pair: &[[Integer; 2]]| {
        let [a, b] = [&pair[0], &pair[1]];
        let across = &(&a[0] * &b[1]) - &(&a[1] * &b[0]);
        match (across.sign().is_gt(), across.is_negative(), is_below(a), is_below(b)) {
            (true, _, true, false) => 1,
            (_, true, false, true) => -1,
            _ => 0i64,
        }
    };
    let turns: i64 = all.windows(2).map(step).sum();
    let half = |v: &[Integer; 2]| i64::from(is_below(v));
    usize::try_from(2 * turns + half(all.last()?) - half(all.first()?)).ok()
}

fn is_positive(x: &Ball) -> bool {
    x.sign().is_some_and(|sign| sign.is_gt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::ball::Elementary;
    use jurist_algebra::number::parse_number;

    fn q(text: &str) -> Rational {
        parse_number(text).unwrap()
    }

    /// The roots inside of `z^3 + ... ` with the roots `r` and `x +- j y`, each within a box.
    fn count([r, x, y]: [&str; 3], width: &str, damping: &str) -> Option<usize> {
        let line = |at: &str| (Ball::from_rational(&q(at), BITS), Ball::from_rational(&q(width), BITS));
        let own = |origin: &str| {
            let [r, x, y] = <[_; 3]>::try_from(MultiTaylorModel::linear(&[r, x, y].map(line), 4)).expect("three");
            let one = r.constant(&Ball::from_integer(&Integer::ONE, BITS));
            let shift = r.constant(&Ball::from_rational(&q(origin), BITS));
            let (r, x) = (r.sub(&shift), x.sub(&shift));
            // (z - r)(z^2 - 2 x z + x^2 + y^2)
            let (sum, square) = (x.scaled(&2.into()), x.mul(&x).add(&y.mul(&y)));
            let minus = Integer::from(-1);
            vec![r.mul(&square).scaled(&minus), square.add(&r.mul(&sum)), r.add(&sum).scaled(&minus), one]
        };
        let spiral = Spiral::new(&q(damping));
        BoxOnSpiral::new([&own("0"), &own("1")], &spiral).count()
    }

    /// With the damping of 3/5 `c = 3/4`: a negative root has it down to `-exp(-3 pi/4) = -0.0947`, a root with the argument `pi/2` up to
    /// `exp(-3 pi/8) = 0.3079`.
    #[test]
    fn roots_of_a_box_are_counted_beside_the_spiral() {
        for (roots, width, inside) in [
            (["-0.09", "0", "0.3"], "0.001", Some(3)),
            (["-0.1", "0", "0.3"], "0.001", Some(2)),
            (["-0.09", "0", "0.32"], "0.001", Some(1)),
            (["-0.1", "0", "0.32"], "0.001", Some(0)),
            (["0.99", "0", "0.3"], "0.001", Some(3)),
            (["1.01", "0", "0.3"], "0.001", Some(2)),
            (["0.5", "0", "0.3"], "0.01", None),
            (["0.999999", "0.999999", "0.0000001"], "0.0000001", Some(3)),
            (["0.999999", "0.999999", "0.00001"], "0.0000001", Some(1)),
            (["-0.09478", "0", "0.3"], "0.0001", None),
        ] {
            assert_eq!(count(roots, width, "3/5"), inside, "{roots:?}");
        }
        assert_eq!(count(["-0.1", "0", "0.3"], "0", "99/100"), Some(0));
        assert_eq!(count(["-0.1", "0", "0.3"], "0", "1/100000"), Some(3));
    }
}
