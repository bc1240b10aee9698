//! Random plants behind a modulator against the pulses themselves: the map over a period by the course of the state under a pulse, and
//! its derivative by the pulse's length as a difference quotient, in floating point.
//!
//! `PWM_CASES=1000 cargo test --release --test it pwm_oracle -- --nocapture` asks for so many.

use crate::helpers::loops::agrees_with_radius;
use crate::helpers::model::read;
use crate::helpers::random::Random;
use jurist_algebra::limits::Budget;
use nalgebra::DMatrix;

/// A plant, its pulse, and the controller's dynamics.
struct Case {
    a: Vec<Vec<i64>>,
    b: Vec<i64>,
    c: Vec<i64>,
    edge: &'static str,
    /// In twentieths of the period.
    duty: usize,
    /// In eighths of the sample time.
    delay: usize,
    controller: &'static str,
}

/// The sample time.
const T: f64 = 0.25;

impl Case {
    fn random(random: &mut Random) -> Case {
        let n = 1 + random.below(3);
        let mut entry = |bound: usize| random.below(2 * bound + 1) as i64 - bound as i64;
        let a = (0..n).map(|i| (0..n).map(|j| if i == j { entry(3) - 1 } else { entry(2) }).collect()).collect();
        let (b, c) = ((0..n).map(|_| entry(2)).collect(), (0..n).map(|_| entry(2)).collect());
        let edge = ["trailing", "leading", "double", "double-ends", "alternating", "alternating"][random.below(6)];
        let controller = ["K", "K/z", "K*(z - 1/2)/(z - 1)"][random.below(3)];
        Case { a, b, c, edge, duty: 1 + random.below(19), delay: [0, 0, 3, 5, 8, 13][random.below(6)], controller }
    }

    fn text(&self) -> String {
        let row = |row: &[i64]| format!("[{}]", row.iter().map(i64::to_string).collect::<Vec<_>>().join(", "));
        let a: Vec<String> = self.a.iter().map(|r| row(r)).collect();
        let b: Vec<String> = self.b.iter().map(|x| format!("[{x}]")).collect();
        format!(
            "time = 'discrete'\nsample_time = '1/4'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'r - y'\noutput = 'u'\n\
             transfer = '{}'\n[[block]]\ninput = 'u'\noutput = 'y'\nA = [{}]\nB = [{}]\nC = [{}]\n\
             discretize = {{ method = 'pwm', edge = '{}', duty = '{}/20', delay = '{}/32' }}\n",
            self.controller,
            a.join(", "),
            b.join(", "),
            row(&self.c),
            self.edge,
            self.duty,
            self.delay
        )
    }

    /// When the pulse is on that a sample of this parity commands, in a period of 1 that begins at the dead time.
    fn on(&self, d: f64, parity: usize) -> Vec<[f64; 2]> {
        match self.edge {
            "alternating" if parity == 1 => vec![[1.0 - d, 1.0]],
            "trailing" | "alternating" => vec![[0.0, d]],
            "leading" => vec![[1.0 - d, 1.0]],
            "double" => vec![[(1.0 - d) / 2.0, (1.0 + d) / 2.0]],
            _ => vec![[0.0, d / 2.0], [1.0 - d / 2.0, 1.0]],
        }
    }

    /// `exp(A t)` and its integral over `B`.
    fn flow(&self, t: f64) -> (DMatrix<f64>, DMatrix<f64>) {
        let n = self.b.len();
        let whole = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => self.a[i][j] as f64 * t,
            (true, false) => self.b[i] as f64 * t,
            _ => 0.0,
        });
        let flow = whole.exp();
        (flow.view((0, 0), (n, n)).into_owned(), flow.view((0, n), (n, 1)).into_owned())
    }

    /// What a pulse of height 1 leaves in the state at the end of the period `m` periods behind the one in which it was commanded.
    fn left(&self, duty: f64, m: usize, parity: usize) -> DMatrix<f64> {
        let mut sum = DMatrix::zeros(self.b.len(), 1);
        for [begin, end] in self.on(duty, parity) {
            let shift = self.delay as f64 / 8.0 - m as f64;
            let [begin, end] = [begin, end].map(|t| (t + shift).clamp(0.0, 1.0));
            if end > begin {
                let (_, during) = self.flow((end - begin) * T);
                sum += self.flow((1.0 - end) * T).0 * during;
            }
        }
        sum
    }

    /// The largest modulus of an eigenvalue of the map over two samples; `None` where a sample stands on an edge.
    fn radius(&self, gain: f64) -> Option<f64> {
        let duty = self.duty as f64 / 20.0;
        for [begin, end] in (0..2).flat_map(|parity| self.on(duty, parity)) {
            for edge in [begin, end].iter().filter(|t| **t > 1e-9 && **t < 1.0 - 1e-9) {
                let place = edge + self.delay as f64 / 8.0;
                if (place - place.round()).abs() < 1e-3 {
                    return None;
                }
            }
        }
        let both = self.step(gain, 1) * self.step(gain, 0);
        Some(both.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max).sqrt())
    }

    /// The map over a sample of this parity.
    fn step(&self, gain: f64, parity: usize) -> DMatrix<f64> {
        let (n, past) = (self.b.len(), 3);
        let (duty, step) = (self.duty as f64 / 20.0, 1e-5);
        let column = |m: usize| {
            let commanded = (parity + m) % 2;
            (self.left(duty + step, m, commanded) - self.left(duty - step, m, commanded)) / (2.0 * step)
        };
        let columns: Vec<DMatrix<f64>> = (0..=past).map(column).collect();
        // States: the plant, the controller's, past commands.
        let size = n + 1 + past;
        let mut m = DMatrix::zeros(size, size);
        // The controller: u = -(D y + C w), w+ = A w + B y.
        let (ca, cb, cc, cd) = match self.controller {
            "K" => (0.0, 0.0, 0.0, gain),
            "K/z" => (0.0, 1.0, gain, 0.0),
            _ => (1.0, 1.0, gain / 2.0, gain),
        };
        let mut u = DMatrix::zeros(1, size);
        for j in 0..n {
            u[(0, j)] = -cd * self.c[j] as f64;
            m[(n, j)] = cb * self.c[j] as f64;
        }
        u[(0, n)] = -cc;
        m[(n, n)] = ca;
        m.view_mut((0, 0), (n, n)).copy_from(&self.flow(T).0);
        for i in 0..n {
            for j in 0..size {
                m[(i, j)] += columns[0][(i, 0)] * u[(0, j)];
            }
            for k in 1..=past {
                m[(i, n + k)] += columns[k][(i, 0)];
            }
        }
        for k in 1..=past {
            if k == 1 {
                m.view_mut((n + 1, 0), (1, size)).copy_from(&u);
            } else {
                m[(n + k, n + k - 1)] = 1.0;
            }
        }
        m
    }
}

#[test]
fn random_plants_behind_a_modulator_against_their_pulses() {
    let cases = std::env::var("PWM_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(40);
    let (mut random, mut looked_at, mut ends, mut skipped) = (Random::new(38), 0, 0, 0);
    for _ in 0..cases {
        let case = Case::random(&mut random);
        let model = read(&case.text());
        if case.radius(0.5).is_none() {
            skipped += 1;
            continue;
        }
        let set = model.ask().free("K").stable_set(&Budget::with_work(10_000_000));
        let Ok(set) = set.map(|answer| answer.into_value()) else {
            skipped += 1;
            continue;
        };
        let gains = (0..4).map(|_| random.below(4001) as f64 / 200.0 - 10.0).collect();
        let [new_ends, new_gains] = agrees_with_radius(&model, &set, gains, 2e-3, |gain| case.radius(gain).unwrap());
        (ends, looked_at) = (ends + new_ends, looked_at + new_gains);
    }
    println!("{cases} cases, {skipped} left out, {ends} ends, {looked_at} gains");
    assert!(looked_at > cases);
}
