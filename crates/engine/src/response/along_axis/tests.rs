//! Cosines, sines and signs on pieces of the axis against values at points.

use super::*;
use proptest::prelude::*;

/// A linear function of one coordinate, in thousandths.
#[derive(Clone, Copy, Debug)]
struct Line([i64; 2]);

impl Coefficient for Line {
    fn plus(&self, other: &Line) -> Line {
        Line([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }

    fn times(&self, _: &Line) -> Line {
        unreachable!("functions are given as they are")
    }

    fn scaled(&self, n: &Integer) -> Line {
        let n = n.to_i64().expect("a small number");
        Line(self.0.map(|c| c * n))
    }

    fn is_zero(&self) -> bool {
        self.0 == [0, 0]
    }
}

impl NearlyLinear for Line {
    fn affine(&self) -> Affine {
        let units = |c: i64| (Integer::from(c) << 256).div_mod_floor(&Integer::from(1000)).0;
        let [middle, slope] = self.0;
        Affine { middle: units(middle), slopes: vec![units(slope)], rest: Integer::ONE, bits: 256 }
    }
}

fn value(f: &[Vec<Line>; 3], tau: Line, u: f64, x: f64) -> f64 {
    let at = |c: &Line| (c.0[0] as f64 + c.0[1] as f64 * x) / 1000.0;
    let p = |k: usize| f[k].iter().rev().fold(0.0, |sum, c| sum * u + at(c));
    let angle = at(&tau) * u;
    let quotient = if u == 0.0 { at(&tau) } else { angle.sin() / u };
    p(0) + p(1) * angle.cos() + p(2) * quotient
}

fn frequency(y: f64) -> f64 {
    if y <= 2.0 { y / 2.0 } else { 2.0 / (4.0 - y) }
}

fn lines(count: usize) -> impl Strategy<Value = Vec<Line>> {
    prop::collection::vec((-3000i64..3000, -900i64..900).prop_map(|(a, b)| Line([a, b])), 1..=count)
}

proptest! {
    /// Cosines and sines over the frequency are in their bounds, for all dead times of a box.
    #[test]
    fn waves_hold_the_cosine_and_the_sine(tau in 0i64..9000, slope in 0i64..400, from in 0i64..1024, length in 1i64..256) {
        let turn = Turn::new(&Line([tau, slope.min(tau)]).affine());
        let ends = [from, (from + length).min(1024)].map(|u| Rational::new(u.into(), 1024.into()));
        let waves = turn.waves(ends.each_ref(), &mut None);
        let unit = f64::from(2).powi(WAVE_BITS as i32);
        for i in 0..=16 {
            let t = f64::from(i) / 16.0;
            let u = (from as f64 + ((from + length).min(1024) - from) as f64 * t) / 1024.0;
            for x in [-1.0, -0.5, 0.0, 1.0] {
                let angle = (tau as f64 + slope.min(tau) as f64 * x) / 1000.0 * u;
                let time = (tau as f64 + slope.min(tau) as f64 * x) / 1000.0;
                let quotient = if u == 0.0 { time } else { angle.sin() / u };
                let quotient = quotient / f64::from(2).powi(turn.exponent as i32);
                for (wave, known) in waves.iter().zip([angle.cos(), quotient]) {
                    let weights = [(1.0 - t).powi(3), (1.0 - t).powi(2) * t, (1.0 - t) * t * t, t.powi(3)];
                    let middle: f64 = wave.middle.iter().zip(weights).map(|(c, w)| *c as f64 * w).sum();
                    let value = middle + wave.slopes[0] as f64 * x;
                    prop_assert!((known * unit - value).abs() <= wave.rest as f64 + 64.0, "{known} {}", value / unit);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    /// A sign that is claimed on a piece and in a box is that at each point of both; on a short piece and in a small box one is claimed.
    #[test]
    fn signs_on_pieces_are_those_at_points(
        p in lines(4), c in lines(4), s in lines(4), tau in (0i64..9000, 0i64..400), halvings in 0usize..7, path in 0usize..128, small in any::<bool>()
    ) {
        let small = |line: Line| if small { Line([line.0[0], 0]) } else { line };
        let f = [p, c, s].map(|list| list.into_iter().map(small).collect::<Vec<Line>>());
        let tau = small(Line([tau.0, tau.1.min(tau.0)]));
        let turn = Arc::new(Turn::new(&tau.affine()));
        let along = AlongAxis::all(vec![f.clone()], &turn).remove(0);
        let mut ends = AlongAxis::pieces()[path & 1].clone();
        let mut piece = along.on(ends.each_ref());
        for k in 0..halvings {
            // Some pieces are looked at before they are halved, and know the cosine then.
            if path >> k & 3 == 1 {
                piece.patch();
            }
            let upper = path >> (k + 1) & 1;
            let middle = ends[0].midpoint(&ends[1]);
            ends[1 - upper] = middle;
            piece = piece.halves(0)[upper].clone();
        }
        let [from, to] = ends.each_ref().map(|y| y.numerator().to_i64().unwrap() as f64 / y.denominator().to_i64().unwrap() as f64);
        let again = along.on(ends.each_ref());
        for known in [piece.patch().sign(), again.patch().sign()].into_iter().flatten() {
            for i in 0..=8 {
                let u = frequency(from + (to - from) * f64::from(i) / 8.0);
                for x in [-1.0, -0.4, 0.0, 0.7, 1.0] {
                    let value = if u.is_finite() { value(&f, tau, u, x) } else { 0.0 };
                    prop_assert!(value.abs() < 1e-9 || (value > 0.0) == known.is_gt(), "{value} at {u}");
                }
            }
        }
        // What is far from zero on a short piece is seen.
        if halvings == 6 && to <= 2.0 && tau.0[0] < 4000 {
            let slopes = f.iter().flatten().chain([&tau]).map(|c| c.0[1].abs()).max().unwrap_or(0);
            let least = (0..=8).map(|i| value(&f, tau, frequency(from + (to - from) * f64::from(i) / 8.0), 0.0).abs());
            if slopes == 0 && least.fold(f64::INFINITY, f64::min) > 3.0 {
                prop_assert!(again.patch().sign().is_some());
            }
        }
    }
}
