//! How the argument of a function turns along the imaginary axis, where on some of the way only its direction is known.

/// Headings are numbered by sixteenths of a turn, which need not be equal: what counts is their order, that a quarter is four of them, and
/// that the one eight further is opposite.
pub(super) const TURN: i64 = 16;

/// Headings in the first quarter, none longer than [`LENGTH`].
const FIRST: [[i128; 2]; 4] = [[17, 0], [15, 8], [12, 12], [8, 15]];
pub(super) const LENGTH: i128 = 17;

/// The direction of a heading.
pub(super) fn heading(k: i64) -> [i128; 2] {
    let [x, y] = FIRST[k.rem_euclid(4) as usize];
    match k.rem_euclid(TURN) / 4 {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

/// Headings, each a bit.
pub(super) type Headings = u16;

/// A piece of the way.
#[derive(Clone, Debug)]
pub(super) enum Piece<Cell> {
    /// The function stays in half planes: from that about the first heading to that about the last one, whole turns counted.
    Clear { first: i64, last: i64 },
    /// It may vanish. Its derivative stays in the half planes about these headings, if there are any.
    Open { cell: Cell, slopes: Headings },
}

/// Adds a stretch in one half plane. `None` where it is opposite to the one before it, with which it has a point in common.
pub(super) fn push_clear<Cell>(pieces: &mut Vec<Piece<Cell>>, to: i64) -> Option<()> {
    match pieces.last_mut() {
        Some(Piece::Clear { last, .. }) => *last += turn(*last, to)?,
        _ => pieces.push(Piece::Clear { first: to, last: to }),
    }
    Some(())
}

/// The way by less than half a turn from one heading to another.
fn turn(from: i64, to: i64) -> Option<i64> {
    match (to - from).rem_euclid(TURN) {
        8 => None,
        k if k < 8 => Some(k),
        k => Some(k - TURN),
    }
}

/// The number of roots to the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Right {
    /// There are at least so many at points that have none on the axis.
    pub least: i64,
    /// There are as many, none on the axis, at every point.
    pub is_exact: bool,
}

/// What the pieces of the axis from 0 up to where the highest power, of this degree and sign, outweighs the rest tell of the number of
/// roots to the right.
pub(super) fn roots_to_the_right<Cell: Clone>(
    pieces: &[Piece<Cell>],
    degree: usize,
    is_negative: bool,
) -> Option<Right> {
    let full = 4 * degree as i64;
    let end = (full + if is_negative { 8 } else { 0 }).rem_euclid(TURN);
    // The value at zero and the heading now, at most so far from it.
    let mut way: Option<(i64, i64)> = None;
    let mut slopes: Option<Headings> = None;
    let mut is_exact = true;
    for piece in pieces.iter().chain([&Piece::Clear { first: end, last: end }]) {
        match piece {
            Piece::Open { slopes: own, .. } => {
                slopes = Some(slopes.unwrap_or(Headings::MAX) & own);
                is_exact = false;
            }
            Piece::Clear { first, last } => {
                let (start, now) = match (way, slopes) {
                    (None, None) => (start(*first)?, *first),
                    (None, Some(slopes)) => start_by_slope(*first, slopes)?,
                    (Some((start, now)), None) => (start, now + turn(now, *first)?),
                    (Some((start, now)), Some(slopes)) => (start, now + largest_change(now, *first, slopes)?),
                };
                way = Some((start, now + last - first));
                slopes = None;
            }
        }
    }
    let (start, now) = way?;
    let eighths = full - (now - start);
    (eighths % 8 == 0).then_some(Right { least: eighths / 8, is_exact })
}

/// The real value at zero, in the half plane about a heading.
fn start(first: i64) -> Option<i64> {
    (first.rem_euclid(8) != 4).then_some((first + 4).div_euclid(8) * 8)
}

/// The heading of the real value at zero that leaves the largest turn, and that of the first half plane beside it: the imaginary part grows,
/// or falls, from zero on.
fn start_by_slope(first: i64, slopes: Headings) -> Option<(i64, i64)> {
    let rises = slopes & 1 << 4 != 0;
    let falls = slopes & 1 << 12 != 0;
    // The argument is between 0 and 8, or between -8 and 0; the heading is less than 4 from it.
    let now = |lowest: i64| Some((first - lowest).rem_euclid(TURN)).filter(|k| *k < 15).map(|k| k + lowest);
    match (rises, falls) {
        (true, _) => Some((0, now(-3)?)),
        (_, true) => Some((-8, now(-11)?)),
        _ => None,
    }
}

/// The largest change of the heading on a stretch on which the derivative stays in the half planes about some headings: at fixed parameters the
/// function goes one way along each of them, and does not vanish.
fn largest_change(from: i64, to: i64, slopes: Headings) -> Option<i64> {
    let changes = (0..TURN).filter(|k| slopes & 1 << k != 0).map(|along| {
        // With the way along 0: values before it have arguments from -4 to 4, behind it from 4 to 12, and their headings are less than 4 from these.
        let before = |k: i64| Some((k - along + 8).rem_euclid(TURN)).filter(|k| *k != 0).map(|k| k - 8);
        let behind = |k: i64| Some((k - along).rem_euclid(TURN)).filter(|k| *k != 0);
        let mut found = Vec::new();
        found.extend(before(from).zip(before(to)).map(|(a, b)| b - a));
        found.extend(behind(from).zip(behind(to)).map(|(a, b)| b - a));
        // It passes zero on one side or on the other.
        found.extend(behind(from).zip(before(to)).into_iter().flat_map(|(a, b)| [b - a, b - a + TURN]));
        found
    });
    changes.reduce(|all, own| all.into_iter().filter(|c| own.contains(c)).collect())?.into_iter().max()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_is_four_headings() {
        for k in -20..20 {
            let ([a, b], [c, d]) = (heading(k), heading(k + 4));
            assert_eq!([c, d], [-b, a]);
            assert!(a * a + b * b <= LENGTH * LENGTH);
            let next = heading(k + 1);
            assert!(a * next[1] - b * next[0] > 0);
        }
    }

    /// Ways of straight steps, all of them along a heading: their turn, followed by steps of less than half a turn, is at most that which is
    /// found from the half planes about its ends.
    #[test]
    fn ways_turn_by_no_more() {
        let mut seed = 1_u64;
        let mut random = |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 33) % n) as i64
        };
        let angle = |[x, y]: [i64; 2]| (y as f64).atan2(x as f64) / std::f64::consts::TAU * 16.0;
        let (mut tight, mut seen) = (0, 0);
        for _ in 0..3000 {
            let along = random(16);
            let [c, s] = heading(along).map(|x| x as i64);
            let mut point = [-random(30), random(60) - 30];
            let mut way = vec![point];
            for _ in 0..1 + random(6) {
                point = [point[0] + 1 + random(12), point[1] + random(60) - 30];
                way.push(point);
            }
            let way: Vec<[i64; 2]> = way.iter().map(|[x, y]| [c * x - s * y, s * x + c * y]).collect();
            let mut turned = 0.0;
            let mut is_off_zero = way[0] != [0, 0];
            for pair in way.windows(2) {
                let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
                let (cross, dot) = (ax * by - ay * bx, ax * bx + ay * by);
                is_off_zero &= cross != 0 || dot > 0;
                turned += (cross as f64).atan2(dot as f64) / std::f64::consts::TAU * 16.0;
            }
            if !is_off_zero {
                continue;
            }
            let is_along = |k: i64| {
                let [c, s] = heading(k).map(|x| x as i64);
                way.windows(2).all(|w| c * (w[1][0] - w[0][0]) + s * (w[1][1] - w[0][1]) > 0)
            };
            let slopes = (0..16).filter(|&k| is_along(k)).fold(0, |all, k| all | 1 << k);
            let near = |point: [i64; 2]| {
                let is_near = move |k: &i64| {
                    let [a, b] = heading(*k).map(|x| x as i64);
                    a * point[0] + b * point[1] > 0
                };
                (0..16).filter(is_near)
            };
            let sixteenth = |k: i64| (angle(heading(k).map(|x| x as i64)) + 16.0).rem_euclid(16.0);
            // By how much a heading is off an argument, less than a quarter.
            let off = |k: i64, point: [i64; 2]| (sixteenth(k) - angle(point) + 24.0).rem_euclid(16.0) - 8.0;
            let (first, last) = (way[0], way[way.len() - 1]);
            for from in near(first) {
                for to in near(last) {
                    let found = largest_change(from, to, slopes).expect("this one");
                    let own = turned + off(to, last) - off(from, first);
                    // That of the headings themselves, which are not quite sixteenths.
                    let headed = found as f64 - (to - from) as f64 + sixteenth(to) - sixteenth(from);
                    let whole = ((headed - own) / 16.0).round();
                    assert!((headed - own - 16.0 * whole).abs() < 1e-6 && whole >= 0.0, "{headed} {own} {way:?}");
                    tight += usize::from(whole == 0.0);
                    seen += 1;
                }
            }
        }
        assert!(tight * 2 > seen && seen > 10_000, "{tight} of {seen}");
    }

    #[test]
    fn ways_begin_at_a_real_value() {
        assert_eq!([start(3), start(-3), start(5), start(4)], [Some(0), Some(0), Some(8), None]);
        assert_eq!(start_by_slope(2, 1 << 4), Some((0, 2)));
        assert_eq!(start_by_slope(14, 1 << 4), Some((0, -2)));
        assert_eq!(start_by_slope(12, 1 << 4), None);
        assert_eq!(start_by_slope(10, 1 << 12), Some((-8, -6)));
        assert_eq!(start_by_slope(2, 1 << 12), Some((-8, 2)));
        assert_eq!(start_by_slope(0, 1 << 3), None);
    }
}
