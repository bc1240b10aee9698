//! Random plants behind a modulator against the pulses themselves: the map over a period by the course of the state under a pulse, and
//! its derivative by the pulse's length as a difference quotient, in floating point.
//!
//! `PWM_CASES=1000 cargo test --release --test it pwm_oracle -- --nocapture` asks for so many.

use super::pulsed_plant::{PAST, PulsedPlant, T, controller};
use crate::helpers::loops::agrees_with_radius;
use crate::helpers::model::read;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use nalgebra::DMatrix;

/// A plant, and the controller's kind.
struct Case {
    plant: PulsedPlant,
    controller: usize,
}

impl Case {
    fn random(random: &mut Random) -> Case {
        let edges = ["trailing", "leading", "double", "double-ends", "alternating", "alternating"];
        Case { plant: PulsedPlant::random(random, &edges), controller: random.below(3) }
    }

    fn text(&self) -> String {
        format!(
            "time = 'discrete'\nsample_time = '1/4'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'r - y'\noutput = 'u'\n\
             transfer = '{}'\n{}",
            controller(self.controller, 1.0).0,
            self.plant.text("")
        )
    }

    /// The largest modulus of an eigenvalue of the map over two samples; `None` where a sample stands on an edge.
    fn radius(&self, gain: f64) -> Option<f64> {
        if self.plant.is_sampled_on_an_edge() {
            return None;
        }
        let both = self.step(gain, 1) * self.step(gain, 0);
        Some(both.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max).sqrt())
    }

    /// The map over a sample of this parity.
    fn step(&self, gain: f64, parity: usize) -> DMatrix<f64> {
        let n = self.plant.order();
        let columns: Vec<DMatrix<f64>> = (0..=PAST).map(|m| self.plant.effect(m, (parity + m) % 2)).collect();
        // States: the plant, the controller's, past commands.
        let size = n + 1 + PAST;
        let mut m = DMatrix::zeros(size, size);
        // The controller: u = -(D y + C w), w+ = A w + B y.
        let (_, [ca, cb, cc, cd]) = controller(self.controller, gain);
        let mut u = DMatrix::zeros(1, size);
        for (j, c) in self.plant.output().enumerate() {
            u[(0, j)] = -cd * c;
            m[(n, j)] = cb * c;
        }
        u[(0, n)] = -cc;
        m[(n, n)] = ca;
        m.view_mut((0, 0), (n, n)).copy_from(&self.plant.flow(T).0);
        for i in 0..n {
            for j in 0..size {
                m[(i, j)] += columns[0][(i, 0)] * u[(0, j)];
            }
            for k in 1..=PAST {
                m[(i, n + k)] += columns[k][(i, 0)];
            }
        }
        for k in 1..=PAST {
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
    let cases = std::env::var("PWM_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(count(15, 40));
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
