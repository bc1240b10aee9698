//! How many roots are inside of the edge of a damping, a logarithmic spiral, for all points of a box of parameters at once.
//!
//! On an arc about the angle `phi` the point `z0 = exp((-c + j) phi)` moves by `z0 (-c + j) t + ...`, and the polynomial is
//! `P(z0; p) + P'(z0; p) z0 (-c + j) t + ...` with coefficients that are nearly linear in the parameters. It keeps to the half plane about its value
//! in the middle where nothing of this moves it as far. The turns of these half planes are those of its argument, for all points of the box.

use super::near_point::{Linear, Shifted, magnitude, modulus};
use super::spiral::{Arc, Complex, Constants, FIRST_LEVEL, Origin, point};
use crate::stability::subdivision::{Halves, Look, Order, Tally, subdivide};
use jurist_algebra::ball::{Ball, MultiTaylorModel};
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use std::sync::OnceLock;

/// So many arcs are looked at.
const MOST_ARCS: usize = 600;

/// An arc is not halved more often.
const MOST_HALVINGS: u64 = 48;

/// Bits after the point.
const BITS: u64 = 256;

/// So far all arcs that are open are halved, however many.
const EVERYWHERE: u64 = 8;

/// The coefficients of the powers of `z - 1`.
pub(super) fn from_one(coefficients: &[MultiPoly]) -> Vec<MultiPoly> {
    let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
    let mut moved = Poly::new(coefficients.to_vec()).compose(&one_more).into_coeffs();
    moved.resize(coefficients.len(), MultiPoly::zero());
    moved
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
        let turns = &self.spiral.level(self.arc.level).turns;
        let mut middles = turns.iter().map(|turn| self.middle.times(turn));
        self.arc.parts().map(|arc| {
            let middle = middles.next().expect("two halves");
            Piece { arc, middle, spiral: self.spiral }
        })
    }
}

/// What arcs of one length have in common.
#[derive(Debug)]
struct Level {
    /// Half of the angle.
    half: Ball,
    /// How far `(-c + j) t` goes at most on half of the arc; beyond a half arcs are too long.
    farthest: Ball,
    /// What brings the middle of an arc to those of its halves.
    turns: [Complex; 2],
}

/// The edge of a damping.
#[derive(Debug)]
pub(super) struct Spiral {
    pub constants: Constants,
    halvings: u64,
    /// The middles of the arcs of the first level.
    first: OnceLock<Vec<Complex>>,
    levels: OnceLock<Vec<Level>>,
}

impl Spiral {
    /// For boxes of parameters.
    pub fn of_boxes(damping: &Rational) -> Spiral {
        Spiral::new(damping, BITS, MOST_HALVINGS)
    }

    /// With so many bits, for arcs that are halved so often at most.
    ///
    /// Cost: when arcs are first asked for exponentials for each arc of the first level and each level.
    pub fn new(damping: &Rational, bits: u64, halvings: u64) -> Spiral {
        let constants = Constants::new(damping, bits);
        Spiral { constants, halvings, first: OnceLock::new(), levels: OnceLock::new() }
    }

    fn first(&self) -> &[Complex] {
        let middle = |k: i64| point(&Rational::dyadic(&Integer::from(2 * k + 1), FIRST_LEVEL + 1), &self.constants);
        self.first.get_or_init(|| (0..1i64 << FIRST_LEVEL).map(middle).collect())
    }

    fn level(&self, level: u64) -> &Level {
        let constants = &self.constants;
        let one = Ball::from_integer(&Integer::ONE, constants.bits);
        let of = |level: u64| {
            let half = constants.pi.shifted(-(level as i64) - 1);
            let farthest = half.mul(&constants.decay.add(&one));
            let quarter = Rational::dyadic(&Integer::ONE, level + 2);
            let turns = [-&quarter, quarter].map(|angle| point(&angle, constants));
            Level { half, farthest, turns }
        };
        let all = self.levels.get_or_init(|| (FIRST_LEVEL..=self.halvings).map(of).collect());
        &all[(level - FIRST_LEVEL) as usize]
    }

    /// `(-c + j) z`, the derivative by the angle.
    fn turned(&self, z: &Complex) -> Complex {
        let one = Ball::from_integer(&Integer::ONE, self.constants.bits);
        Complex { re: self.constants.decay.neg(), im: one }.times(z)
    }

    fn pieces(&self) -> impl Iterator<Item = Piece<'_>> {
        let arc = |at: i64| Arc { at: Integer::from(at), level: FIRST_LEVEL };
        let middles = self.first().iter().cloned();
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
    pub fn new(both: [&[MultiTaylorModel]; 2], spiral: &'s Spiral) -> BoxOnSpiral<'s> {
        BoxOnSpiral::of(both.map(|list| list.iter().map(|c| Linear::of(c, BITS)).collect::<Vec<_>>()), spiral)
    }

    /// The same of coefficients near linear functions.
    pub fn of(coefficients: [Vec<Linear>; 2], spiral: &'s Spiral) -> BoxOnSpiral<'s> {
        let parameters = coefficients[0].first().map_or(0, |c| c.slopes.len());
        BoxOnSpiral { coefficients, parameters, spiral }
    }

    /// The number of roots inside of the edge that all points of the box have; `None` where a root may be on it for some of them.
    ///
    /// Cost: values on some dozen arcs, where the box is small beside the distance of the roots.
    pub fn count(&self) -> Option<usize> {
        self.count_by(MOST_ARCS)
    }

    /// The same by so many arcs at most.
    pub fn count_by(&self, most: usize) -> Option<usize> {
        let mut found: Vec<(Rational, [Integer; 2])> = Vec::new();
        let look = |piece: &mut Piece, tally: Tally| {
            Ok(match self.seen(piece) {
                Seen::Clear(towards) => {
                    let [from, _] = piece.arc.ends();
                    found.push((from, towards));
                    Look::Decided(())
                }
                Seen::TooLong if tally.looks() < most && piece.arc.level < self.spiral.halvings => Look::Cut(0),
                Seen::TooLong | Seen::Lost => Look::Open(()),
            })
        };
        let ended = subdivide(self.spiral.pieces(), Order::Breadth, &Budget::unlimited(), look);
        ended.ok()?.ok()?;
        found.sort_by(|a, b| a.0.cmp(&b.0));
        half_turns(found.into_iter().map(|(_, towards)| towards))
    }

    /// The arcs, from the first on, on which the polynomial is not told from zero: halved so often at most, and only while no more of them are open.
    pub fn open_arcs(&self, halvings: u64, most: usize) -> Vec<Arc> {
        let mut open: Vec<Arc> = Vec::new();
        // How many arcs of the last level and of this one were halved.
        let (mut level, mut before, mut here) = (FIRST_LEVEL, 0, 0);
        let look = |piece: &mut Piece, _: Tally| {
            if piece.arc.level > level {
                (level, before, here) = (piece.arc.level, here, 0);
            }
            if level > EVERYWHERE && before > most {
                open.push(piece.arc.clone());
                return Ok(Look::<(), ()>::Decided(()));
            }
            if !matches!(self.seen(piece), Seen::Clear(_)) {
                if level < halvings.min(self.spiral.halvings) {
                    here += 1;
                    return Ok(Look::Cut(0));
                }
                open.push(piece.arc.clone());
            }
            Ok(Look::Decided(()))
        };
        // Nothing of this ends the work but what was entered.
        subdivide(self.spiral.pieces(), Order::Breadth, &Budget::unlimited(), look).ok();
        open.sort_by_cached_key(|arc| arc.ends()[0].clone());
        open
    }

    /// The value on all of an arc about an angle, and the derivative by the angle there.
    pub fn on_arc(&self, angles: &[Rational; 2]) -> [Complex; 2] {
        let with = &self.spiral.constants;
        let middle = point(&angles[0].midpoint(&angles[1]), with);
        // |dz/dphi| = |z| |-c + j| <= 1 + c.
        let half = Ball::from_rational(&(&angles[1] - &angles[0]), with.bits).mul(&with.pi).shifted(-1);
        let radius = magnitude(&half.mul(&with.decay.add(&Ball::from_integer(&Integer::ONE, with.bits))));
        let origin = Origin::of(angles);
        let list = &self.coefficients[origin as usize];
        let [value, slope] = Shifted::new(list, &origin.to(&middle), self.parameters, with.bits).within(&radius);
        let units = radius.magnitude_units();
        let z = Complex { re: middle.re.widened(&units), im: middle.im.widened(&units) };
        [value, slope.times(&self.spiral.turned(&z))]
    }

    fn seen(&self, piece: &Piece) -> Seen {
        let bits = self.spiral.constants.bits;
        checkpoint(bits * self.coefficients[0].len() as u64);
        let origin = Origin::of(&piece.arc.ends());
        let list = &self.coefficients[origin as usize];
        let near = Shifted::new(list, &origin.to(&piece.middle), self.parameters, bits);
        // The direction of the value in the middle, in whose half plane all is to be: of a length about one, since numbers have bits after the point.
        let middle = [near.middles[0].re.middle_units(), near.middles[0].im.middle_units()];
        let size = middle.iter().map(Integer::bit_length).max().unwrap_or(0);
        let longer = bits.saturating_sub(size);
        let towards = middle.map(|x| x << longer).map(|x| Ball::from_units(x.clone(), x, bits));
        let length = magnitude(&towards[0]).add(&magnitude(&towards[1]));
        let across = near.slopes.iter().map(|slopes| magnitude(&dot(&towards, &slopes[0])));
        let across = across.fold(length.mul(&near.rests[0]), |sum, x| sum.add(&x));
        let left = dot(&towards, &near.middles[0]).sub(&across);
        if !is_positive(&left) {
            return Seen::Lost;
        }
        match self.moved(&near, piece, (&towards, &length)) {
            Some(moved) if is_positive(&left.sub(&moved)) => Seen::Clear(towards.each_ref().map(Ball::middle_units)),
            _ => Seen::TooLong,
        }
    }

    /// How far in a direction, times its length, the polynomial moves on the arc at most; `None` where the arc is long.
    fn moved(&self, near: &Shifted, piece: &Piece, (towards, length): (&[Ball; 2], &Ball)) -> Option<Ball> {
        let Level { half, farthest, .. } = self.spiral.level(piece.arc.level);
        if farthest.upper() > Rational::dyadic(&Integer::ONE, 1) {
            return None;
        }
        let Some(slope) = near.middles.get(1) else { return Some(Ball::zero(half.bits())) };
        let along = slope.times(&self.spiral.turned(&piece.middle)).scaled(half);
        // |exp(x) - 1 - x| <= |x|^2 exp(|x|)/2 and exp(|x|) <= 2.
        let straight = modulus(&piece.middle).mul(farthest);
        let bend = straight.mul(farthest);
        let radius = straight.add(&bend);
        let beside = near.off(1).mul(&radius).add(&modulus(slope).mul(&bend));
        let others = near.beyond(2, false, &radius);
        Some(magnitude(&dot(towards, &along)).add(&length.mul(&beside.add(&others))))
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
        let spiral = Spiral::of_boxes(&q(damping));
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
