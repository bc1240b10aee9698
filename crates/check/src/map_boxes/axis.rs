//! How many roots are right of the imaginary axis at every point of a box.

use crate::clock::Clock;
use crate::number::Z;
use crate::taylor::{Precision, Taylor};
use crate::univariate::gcd;
use num_traits::{One, ToPrimitive};

/// The axis is cut into no more parts for one box, and halved no more often.
const MAX_PARTS: usize = 2000;
const MAX_HALVINGS: usize = 64;

/// Bits of the numbers of a direction.
const DIRECTION_BITS: u64 = 12;

/// A part of the axis: Bernstein coefficients of `E` and of `O`.
struct Part {
    pair: [Vec<Taylor>; 2],
    halvings: usize,
}

/// The direction of the middle of a half plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Direction([i64; 2]);

/// Those along the axes, by quarters of a turn.
const AXES: [Direction; 4] = [Direction([1, 0]), Direction([0, 1]), Direction([-1, 0]), Direction([0, -1])];

impl Direction {
    /// Across a vector, on the side where another one is; the numbers are shortened.
    fn across([x, y]: [Z; 2], side: [Z; 2]) -> Option<Self> {
        let long = x.bits().max(y.bits()).saturating_sub(DIRECTION_BITS);
        let short = |x: &Z| (x >> long).to_i64();
        let [x, y] = [short(&x)?, short(&y)?];
        let is_beyond = side[1].clone() * x > side[0].clone() * y;
        ([x, y] != [0, 0]).then_some(Direction(if is_beyond { [-y, x] } else { [y, -x] }))
    }

    /// The number of the quarter it is in, which begins with an axis.
    fn quarter(self) -> i64 {
        match self.0 {
            [x, y] if x > 0 && y >= 0 => 0,
            [x, y] if x <= 0 && y > 0 => 1,
            [x, _] if x < 0 => 2,
            _ => 3,
        }
    }

    /// How many quarters further another direction is, by less than half a turn; `None` if that is opposite.
    fn turn_to(self, other: Self) -> Option<i64> {
        let ([a, b], [c, d]) = (self.0, other.0);
        let quarters = other.quarter() - self.quarter();
        match ((a * d - b * c).signum(), a * c + b * d > 0) {
            (0, false) => None,
            (0, true) => Some(0),
            (1, _) => Some(quarters.rem_euclid(4)),
            _ => Some(-(-quarters).rem_euclid(4)),
        }
    }

    /// Whether all values of the pair, given by coefficients, are in the half plane.
    fn holds(self, e: &[Taylor], o: &[Taylor]) -> bool {
        let [a, b] = self.0;
        e.iter().zip(o).all(|(e, o)| match (a, b) {
            (_, 0) => e.sign() == Some(a > 0),
            (0, _) => o.sign() == Some(b > 0),
            _ => e.scaled(&Z::from(a)).plus(&o.scaled(&Z::from(b))).sign() == Some(true),
        })
    }
}

/// A half plane that all values are in: along an axis, or across the ways on which they change most, if one is found.
fn half_plane(last: Option<Direction>, parameters: usize, e: &[Taylor], o: &[Taylor]) -> Option<Direction> {
    let k = e.len() / 2;
    let middle = || [e[k].constant(), o[k].constant()];
    let chord = || {
        let along = |c: &[Taylor]| c[c.len() - 1].constant() - c[0].constant();
        [along(e), along(o)]
    };
    let across = |way: usize| {
        let way = if way < parameters { [e[k].linear(way), o[k].linear(way)] } else { chord() };
        Direction::across(way, middle())
    };
    let mut all = last.into_iter().chain(AXES).chain((0..=parameters).filter_map(across));
    all.find(|direction| direction.holds(e, o))
}

/// The number of roots to the right of `p_0 + p_1 s + ...`, none of them on the axis and the degree not lost, if that is shown for all points
/// of the box.
///
/// With `P(i w) = E(w^2) + i w O(w^2)` the vector `(E, O)`, in scaled coordinates, turns by as many quarters from `w = 0` to infinity as roots
/// are left less those that are right. Along parts of the axis it is kept within half planes, two in succession with a common point.
pub(super) fn right(p: &[Taylor], precision: &Precision, clock: &Clock) -> Result<Option<usize>, String> {
    let n = p.len() - 1;
    let [Some(first), Some(last)] = [p[0].sign(), p[n].sign()] else { return Ok(None) };
    let mut direction = AXES[if first { 0 } else { 2 }];
    let mut turns = 0;
    let mut parts = vec![Part { pair: scaled_pair(p, scale(p), precision), halvings: 0 }];
    let mut looked_at = 0;
    while let Some(part) = parts.pop() {
        looked_at += 1;
        precision.hold((parts.len() + 3) * (n + 1), clock)?;
        clock.spend(operations(&part, n, precision), precision.bits as u64, 0)?;
        let [e, o] = &part.pair;
        if let Some(next) = half_plane(Some(direction), precision.parameters(), e, o)
            && let Some(turn) = direction.turn_to(next)
        {
            (direction, turns) = (next, turns + turn);
            continue;
        }
        // Where not even one point of the axis is told from a root there is nothing to halve for.
        let is_seen = |k: usize| half_plane(None, precision.parameters(), &e[k..=k], &o[k..=k]).is_some();
        if !is_seen(0) || !is_seen(e.len() - 1) || part.halvings >= MAX_HALVINGS || looked_at >= MAX_PARTS {
            return Ok(None);
        }
        let k = e.len() - 1;
        clock.spend(k * k * precision.terms(), precision.bits as u64, 0)?;
        let [low, high] = halves(part);
        parts.extend([high, low]);
    }
    let end = AXES[(n + if last { 0 } else { 2 }) % 4];
    let twice = direction.turn_to(end).map(|turn| n as i64 - turns - turn);
    Ok(twice.filter(|k| k % 2 == 0).and_then(|k| usize::try_from(k / 2).ok()))
}

/// How many operations are counted for a look at a part. In more than two coordinates most coefficients are zero.
fn operations(part: &Part, n: usize, precision: &Precision) -> usize {
    match precision.parameters() {
        0..=2 => 16 * (n + 1) * precision.terms(),
        _ => 4 * part.pair.iter().flatten().map(Taylor::size).sum::<usize>(),
    }
}

/// The exponent of a power of two that is about the size of the roots.
pub(super) fn scale(p: &[Taylor]) -> i64 {
    let n = p.len() - 1;
    let bits = |x: &Taylor| x.constant().bits() as i64;
    if n == 0 { 0 } else { (bits(&p[0]) - bits(&p[n])).div_euclid(n as i64) }
}

/// The Bernstein coefficients of `(1 - t)^k E(v)` and `w (1 - t)^k O(v)` with `v = w^2 t/(1 - t)` and `w = 2^scale`, together times a positive
/// number.
fn scaled_pair(p: &[Taylor], scale: i64, precision: &Precision) -> [Vec<Taylor>; 2] {
    let k = (p.len() - 1) / 2;
    let mut ways = vec![Z::one()];
    for j in 0..k {
        ways.push(&ways[j] * Z::from(k - j) / Z::from(j + 1));
    }
    let common = ways.iter().fold(Z::one(), |l, b| &l / gcd(&l, b) * b);
    let size = scale.unsigned_abs() as usize;
    let entry = |j: usize, odd: usize| {
        let factor = if j % 2 == 1 { -(&common / &ways[j]) } else { &common / &ways[j] };
        let shift = if scale >= 0 { size * (2 * j + odd) } else { size * (2 * (k - j) + 1 - odd) };
        p.get(2 * j + odd).map_or_else(Taylor::zero, |c| c.scaled(&(factor << shift)))
    };
    let mut pair = [0, 1].map(|odd| (0..=k).map(|j| entry(j, odd)).collect::<Vec<_>>());
    let longest = pair.iter().flatten().map(|c| c.magnitude().bits() as usize).max().unwrap_or(0);
    if longest > precision.bits {
        pair.iter_mut().flatten().for_each(|c| *c = c.halved(longest - precision.bits));
    }
    pair
}

/// Both halves of a part [de Casteljau].
fn halves(part: Part) -> [Part; 2] {
    let halvings = part.halvings + 1;
    let [e, o] = part.pair.map(|mut level| {
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        while let [first, .., last] = level.as_slice() {
            lower.push(first.clone());
            upper.push(last.clone());
            level = level.windows(2).map(|two| two[0].plus(&two[1]).halved(1)).collect();
        }
        lower.extend(level.iter().cloned());
        upper.extend(level);
        upper.reverse();
        [lower, upper]
    });
    let ([e_low, e_high], [o_low, o_high]) = (e, o);
    [Part { pair: [e_low, o_low], halvings }, Part { pair: [e_high, o_high], halvings }]
}

/// `P(s + 2^exponent)`, times a positive number.
pub(super) fn shifted(p: &[Taylor], exponent: i64, of: &Precision, clock: &Clock) -> Result<Vec<Taylor>, String> {
    let mut c = p.to_vec();
    let (n, size) = (p.len() - 1, exponent.unsigned_abs() as usize);
    // P(2^exponent x), or 2^(-n exponent) times it, is shifted by one.
    let power = |k: usize| Z::one() << if exponent >= 0 { size * k } else { size * (n - k) };
    for (k, x) in c.iter_mut().enumerate() {
        *x = x.scaled(&power(k));
    }
    for i in 0..n {
        clock.spend((n - i) * of.terms(), of.bits as u64, 0)?;
        for j in (i..n).rev() {
            c[j] = c[j].plus(&c[j + 1]);
        }
    }
    Ok(c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Q;
    use crate::roots::places_by_axis;
    use crate::univariate::Uni;
    use std::time::Duration;

    fn q(n: i64, d: i64) -> Q {
        Q::new(n.into(), d.into())
    }

    #[test]
    fn polynomials_have_as_many_roots_to_the_right_as_they_have() {
        let (precision, clock) = (Precision::new(1, 2, 128), Clock::new(Duration::MAX));
        let mut seed = 1_u64;
        let mut seen = [0; 5];
        for round in 0..300 {
            let mut c: Vec<i64> = (0..2 + round % 4)
                .map(|_| {
                    seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    (seed >> 40) as i64 % 2000 - 500
                })
                .collect();
            c.push(7);
            let d = Uni::new(c.iter().map(|&c| Z::from(c)).collect());
            let places = places_by_axis(&d, &clock).unwrap();
            let numbers: Vec<Taylor> = c.iter().map(|&c| Taylor::number(&q(c, 1), &precision)).collect();
            let found = right(&numbers, &precision, &clock).unwrap();
            let is_certain = c[0] != 0 && places.on == 0;
            assert_eq!(found, is_certain.then_some(places.outside), "{c:?}");
            seen[found.unwrap_or(4)] += 1;
            // Shifted by far all roots are to the left, of a mirror image to the right.
            assert_eq!(
                right(&shifted(&numbers, 12, &precision, &clock).unwrap(), &precision, &clock).unwrap(),
                Some(0),
                "{c:?}"
            );
        }
        assert!(seen[0] > 5 && seen[1] > 5 && seen[2] > 5, "{seen:?}");
    }

    #[test]
    fn a_box_that_a_boundary_runs_through_has_no_count() {
        let (precision, clock) = (Precision::new(1, 2, 128), Clock::new(Duration::MAX));
        let of = |low: (i64, i64), high: (i64, i64)| {
            let x = Taylor::coordinate(&[q(low.0, low.1), q(high.0, high.1)], 0, &precision);
            // s^2 + x s + 1
            let one = Taylor::number(&q(1, 1), &precision);
            right(&[one.clone(), x, one], &precision, &clock).unwrap()
        };
        assert_eq!(of((1, 10), (3, 1)), Some(0));
        assert_eq!(of((-3, 1), (-1, 10)), Some(2));
        assert_eq!(of((-1, 1), (1, 1)), None);
        assert_eq!(of((0, 1), (1, 1)), None);
    }
}
