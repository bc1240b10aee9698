//! What is seen of a step, against exact values at its corners: polynomials without delay, with coefficients that are off.

use super::*;
use crate::dead_time::plane_function::Shares;
use jurist_algebra::poly::Domain;

/// `c (i w)^j + 2 u^k v^l (i w)^m`, with bounds of how far the coefficients of the powers may be off.
struct Case {
    own: (i64, usize),
    /// `m`, `k`, `l`.
    term: (usize, u32, u32),
    slack: [i64; 4],
}

impl Case {
    fn function(&self) -> PlaneFunction {
        let mut part = vec![MultiPoly::zero(); 4];
        part[self.own.1] = MultiPoly::constant(self.own.0.into());
        let (m, k, l) = self.term;
        part[m] = &part[m] + &MultiPoly::from_terms([(vec![k, l], Integer::from(2))]);
        let slack = self.slack.map(Integer::from).to_vec();
        let delays = vec![DeadTime::default()];
        PlaneFunction::new(Shares {
            parts: vec![part],
            slack,
            slack_axis: 0,
            poles: Vec::new(),
            delays,
            times: Vec::new(),
        })
    }

    /// The coefficients at a point, and the least part of the function, or its derivative, along a heading there.
    fn along(&self, k: i64, [w, u, v]: [i64; 3], order: usize) -> i64 {
        let [re, im] = heading(k).map(|x| x as i64);
        let (m, p, q) = self.term;
        let coefficient = |j: usize| {
            let own = if j == self.own.1 { self.own.0 } else { 0 };
            own + if j == m { 2 * u.pow(p) * v.pow(q) } else { 0 }
        };
        (order..4).fold(0, |sum, j| {
            // The power of w, or its derivative.
            let power = if order == 0 { w.pow(j as u32) } else { j as i64 * w.pow(j as u32 - 1) };
            let along = [re, im, -re, -im][j];
            sum + (coefficient(j) * along - self.slack[j] * along.abs()) * power
        })
    }
}

/// Frequencies and shares from 0 to 2 and from 0 to 1, and from 2 to 4.
#[test]
fn what_is_seen_of_a_step_is_so_at_its_corners() {
    let (mut clear, mut sloped) = (0, 0);
    for slack in [[0, 0, 0, 0], [3, 0, 0, 0], [0, 2, 1, 0]] {
        for own in 0..3 {
            for term in (0..4).flat_map(|m| [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)].map(|(k, l)| (m, k, l))) {
                for c in (-30..=30).step_by(3) {
                    let case = Case { own: (c, own), term, slack };
                    let function = case.function();
                    let walk = Walk::new(&function, &Place::whole());
                    for low in [0, 2] {
                        let local = walk.local(&Dyadic { m: Integer::from(low + 1), e: 0 }, Step(1));
                        let corners: Vec<[i64; 3]> = [low, low + 1, low + 2]
                            .into_iter()
                            .flat_map(|w| [[w, 0, 0], [w, 0, 1], [w, 1, 0], [w, 1, 1]])
                            .collect();
                        let is_along = |k: i64, order: usize| corners.iter().all(|at| case.along(k, *at, order) > 0);
                        if let Look::Clear(k) = local.look() {
                            assert!(is_along(k, 0), "{c} (i w)^{own} + {term:?}, slack {slack:?}, from {low}: {k}");
                            clear += 1;
                        }
                        for k in (0..TURN).filter(|k| local.slopes() & (1 << k) != 0) {
                            assert!(
                                is_along(k, 1),
                                "{c} (i w)^{own} + {term:?}, slack {slack:?}, from {low}: slope {k}"
                            );
                            sloped += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(clear > 1000 && sloped > 1000, "{clear} {sloped}");
}
