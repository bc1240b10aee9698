//! Cutting curves at the frame, because a picture file is not the place for what is outside.

/// A rectangle in the data's units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub x: (f64, f64),
    pub y: (f64, f64),
}

impl Window {
    pub fn contains(&self, p: (f64, f64)) -> bool {
        p.0 >= self.x.0 && p.0 <= self.x.1 && p.1 >= self.y.0 && p.1 <= self.y.1
    }

    /// The part of a segment inside the window, by the method of Liang and Barsky [LiangBarsky1984](jurist_algebra::bibliography#liangbarsky1984).
    pub fn cut(&self, a: (f64, f64), b: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (direction, room) in
            [(-dx, a.0 - self.x.0), (dx, self.x.1 - a.0), (-dy, a.1 - self.y.0), (dy, self.y.1 - a.1)]
        {
            if direction == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if direction < 0.0 {
                from = from.max(room / direction);
            } else {
                to = to.min(room / direction);
            }
        }
        let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
        (from <= to).then(|| (at(from), at(to)))
    }

    /// The parts of a polyline inside the window.
    pub fn pieces(&self, points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
        let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
        let mut open = false;
        for pair in points.windows(2) {
            let finite = [pair[0], pair[1]].iter().all(|p| p.0.is_finite() && p.1.is_finite());
            let Some((a, b)) = finite.then(|| self.cut(pair[0], pair[1])).flatten() else {
                open = false;
                continue;
            };
            match pieces.last_mut().filter(|_| open) {
                Some(piece) => piece.push(b),
                None => pieces.push(vec![a, b]),
            }
            open = b == pair[1];
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_that_leaves_and_returns_has_two_pieces() {
        let window = Window { x: (0.0, 10.0), y: (-1.0, 1.0) };
        let pieces = window.pieces(&[(0.0, 0.0), (2.0, 2.0), (4.0, 0.0), (20.0, 0.0)]);
        assert_eq!(pieces, vec![vec![(0.0, 0.0), (1.0, 1.0)], vec![(3.0, 1.0), (4.0, 0.0), (10.0, 0.0)]]);
        assert!(window.pieces(&[(0.0, 5.0), (10.0, 5.0)]).is_empty());
        assert!(window.pieces(&[(f64::NAN, 0.0), (1.0, 0.0)]).is_empty());
    }

    #[test]
    fn segments_cross_a_window_or_not() {
        let window = Window { x: (10.0, 30.0), y: (10.0, 20.0) };
        let crosses = |a, b| window.cut(a, b).is_some();
        assert!(crosses((0.0, 0.0), (40.0, 30.0)) && crosses((15.0, 15.0), (16.0, 15.0)));
        assert!(crosses((20.0, -50.0), (20.0, 50.0)));
        assert!(!crosses((0.0, 0.0), (9.0, 40.0)) && !crosses((0.0, 25.0), (40.0, 25.0)));
        assert!(!crosses((0.0, 15.0), (5.0, 15.0)));
    }
}
