//! A vector on whose positive side all of a set of points in the plane lie.

/// Components of a separating vector stay below this.
const LARGEST: i128 = 1 << 40;

/// Points are directions of so many bits while the vector is sought.
const DIRECTION_BITS: u32 = 60;

/// A small integer vector `(a, b)` with `a x + b y > error (|a| + |b|)` for all points; `None` where none is found, which is
/// always so where the points are not in an open half plane.
///
/// The cone that the points span is kept by its two extreme rays; the vector is taken from the middle of its dual cone and
/// proved on all points. One pass over the points, and one for each vector that is tried.
pub(super) fn separating_vector(x: &[i128], y: &[i128], error: i128) -> Option<(i128, i128)> {
    separating_vector_within(x, y, error, &[])
}

/// The same where the components of the points are off by so much more, in turns of as many points as there are bounds.
pub(super) fn separating_vector_within(
    x: &[i128],
    y: &[i128],
    error: i128,
    slack: &[Vec<i128>],
) -> Option<(i128, i128)> {
    let [first, last] = cone(x, y)?;
    let [f, l] = [unit(first), unit(last)];
    // The middle of the cone; where it is nearly a half plane, the sum of both rays says little.
    let middle = if f.0 * l.0 + f.1 * l.1 >= 0 { (f.0 + l.0, f.1 + l.1) } else { (l.1 - f.1, f.0 - l.0) };
    let longest = middle.0.abs().max(middle.1.abs());
    if longest == 0 {
        return None;
    }
    let rounded = |c: i128, q: i128| (2 * q * c + longest).div_euclid(2 * longest);
    let mut q = 1;
    while q < LARGEST {
        let v = (rounded(middle.0, q), rounded(middle.1, q));
        let is_positive = |ray: (i128, i128)| v.0 * ray.0 + v.1 * ray.1 > 0;
        if is_positive(first) && is_positive(last) && holds(v, x, y, error, slack) {
            return Some(v);
        }
        q = if q < 4 { q + 1 } else { q + q / 2 };
    }
    None
}

fn holds((a, b): (i128, i128), x: &[i128], y: &[i128], error: i128, slack: &[Vec<i128>]) -> bool {
    let least = error * (a.abs() + b.abs());
    let [own_x, own_y] = slack else { return x.iter().zip(y).all(|(x, y)| a * x + b * y > least) };
    let bounds: Vec<i128> = own_x.iter().zip(own_y).map(|(x, y)| least + a.abs() * x + b.abs() * y).collect();
    x.iter().zip(y).zip(bounds.iter().cycle()).all(|((x, y), least)| a * x + b * y > *least)
}

/// The extreme rays of the cone that points span, the second counterclockwise of the first; `None` unless they lie in an
/// open half plane.
fn cone(x: &[i128], y: &[i128]) -> Option<[(i128, i128); 2]> {
    // Words and not double words: one multiplication each.
    let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
    let cross = |v: (i64, i64), w: (i64, i64)| product(v.0, w.1) - product(v.1, w.0);
    let mut rays: Option<[(i64, i64); 2]> = None;
    for (&x, &y) in x.iter().zip(y) {
        let bits = i128::BITS - x.unsigned_abs().max(y.unsigned_abs()).leading_zeros();
        if bits == 0 {
            return None;
        }
        let shift = bits.saturating_sub(DIRECTION_BITS);
        let p = ((x >> shift) as i64, (y >> shift) as i64);
        let Some([first, last]) = &mut rays else {
            rays = Some([p, p]);
            continue;
        };
        let (after, before) = (cross(*first, p), cross(p, *last));
        if after >= 0 && before >= 0 {
            // Within, or on the line of both rays: then it must not point the other way.
            if after == 0 && before == 0 && product(first.0, p.0) + product(first.1, p.1) < 0 {
                return None;
            }
        } else if after < 0 && before > 0 {
            *first = p;
        } else if before < 0 && after > 0 {
            *last = p;
        } else {
            return None;
        }
    }
    rays.map(|both| both.map(|(x, y)| (i128::from(x), i128::from(y))))
}

/// The direction of a vector, of length about `2^40`.
fn unit((x, y): (i128, i128)) -> (i128, i128) {
    let length = (x * x + y * y).isqrt().max(1);
    ((x << 40) / length, (y << 40) / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn points_all_around_have_no_vector() {
        assert_eq!(separating_vector(&[1, -1, 0], &[0, 0, 1], 0), None);
        assert_eq!(separating_vector(&[1, -1], &[1, -1], 0), None);
        assert_eq!(separating_vector(&[1, 0], &[1, 0], 0), None);
        assert_eq!(separating_vector(&[1 << 90, -(1 << 90), 1 << 90], &[1, 1, -1], 0), None);
    }

    #[test]
    fn small_vectors_are_preferred() {
        assert_eq!(separating_vector(&[5, 7], &[1, -1], 0), Some((1, 0)));
        assert_eq!(separating_vector(&[-100, -90], &[3, 99], 0).map(|v| v.0 < 0), Some(true));
    }

    proptest! {
        #[test]
        fn a_half_plane_is_found_if_and_only_if_there_is_one(
            points in prop::collection::vec((-30i128..=30, -30i128..=30), 1..8),
        ) {
            let (x, y): (Vec<i128>, Vec<i128>) = points.iter().copied().unzip();
            // Any vector that separates small points can be taken with entries up to 2 * 30.
            let candidates = (-61..=61).flat_map(|a| (-61..=61).map(move |b| (a, b)));
            let exists = candidates.into_iter().any(|v| holds(v, &x, &y, 0, &[]));
            let found = separating_vector(&x, &y, 0);
            prop_assert_eq!(found.is_some(), exists);
            prop_assert!(found.is_none_or(|v| holds(v, &x, &y, 0, &[])));
        }
    }
}
