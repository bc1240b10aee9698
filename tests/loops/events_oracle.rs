//! Random cascades over a plant behind a hold or a modulator, with rates, phases and frames, against their events, stepped one by one in floating
//! point.
//!
//! `EVENT_CASES=2000 cargo test --release --test it events_oracle -- --nocapture` asks for so many, and `EVENT_SEED=5` for others.

use super::pulsed_plant::{PAST, PulsedPlant, T, controller};
use crate::helpers::loops::agrees_with_radius;
use crate::helpers::model::read;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use nalgebra::{Complex, DMatrix, DVector};

/// What a period does to the plant's state.
type Map = DMatrix<Complex<f64>>;

/// A controller at its own rate: its kind, `every`, `phase`.
struct Controller {
    kind: usize,
    every: usize,
    phase: usize,
}

/// The plane that turns beside the plant: its angular frequency and the command's advance, in tenths.
struct Frame {
    speed: i64,
    advance: i64,
}

/// A slow controller of `r - y` over a fast one of `v - y`.
struct Case {
    plant: PulsedPlant,
    slow: Controller,
    fast: Controller,
    /// Which of the two has the gain; the other's is a quarter.
    gain_is_slow: bool,
    frame: Option<Frame>,
}

impl Case {
    fn random(random: &mut Random) -> Case {
        let edges = ["hold", "hold", "hold", "trailing", "leading", "double", "double-ends", "alternating"];
        let plant = PulsedPlant::random(random, &edges);
        let mut own = |rates: &[usize]| {
            let every = rates[random.below(rates.len())];
            Controller { kind: random.below(3), every, phase: random.below(every) }
        };
        let (slow, fast) = (own(&[2, 3, 4, 6]), own(&[1, 1, 1, 2]));
        let turns = plant.edge == "hold" && random.below(3) == 0;
        let frame = turns.then(|| Frame { speed: 1 + random.below(60) as i64, advance: random.below(30) as i64 - 10 });
        Case { plant, slow, fast, gain_is_slow: random.below(2) == 0, frame }
    }

    fn text(&self) -> String {
        let block = |input: &str, output: &str, of: &Controller, is_free: bool| {
            let transfer = controller(of.kind, 1.0).0;
            let transfer = if is_free { transfer.to_owned() } else { transfer.replace('K', "1/4") };
            let (every, phase) = (of.every, of.phase);
            format!(
                "[[block]]\ninput = '{input}'\noutput = '{output}'\ntransfer = '{transfer}'\nevery = {every}\nphase = {phase}\n"
            )
        };
        let turn = |of: &Frame| format!(", frame = '{}/10', advance = '{}/10'", of.speed, of.advance);
        format!(
            "time = 'discrete'\nsample_time = '1/4'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n{}{}{}",
            block("r - y", "v", &self.slow, self.gain_is_slow),
            block("v - y", "u", &self.fast, !self.gain_is_slow),
            self.plant.text(&self.frame.as_ref().map(turn).unwrap_or_default())
        )
    }

    fn hyperperiod(&self) -> usize {
        let edges = if self.plant.edge == "alternating" { 2 } else { 1 };
        let is_one =
            |n: &usize| n.is_multiple_of(edges) && [&self.slow, &self.fast].iter().all(|c| n.is_multiple_of(c.every));
        (1..).find(is_one).expect("a common multiple")
    }

    /// The largest modulus of a root of a hyperperiod: each column is the course from a unit vector.
    fn radius(&self, gain: f64) -> f64 {
        // States: the plant, the controllers' states, their held outputs, past commands.
        let size = self.plant.order() + 4 + PAST;
        let effects: Vec<[Map; 2]> = (0..=PAST)
            .map(|m| {
                [0, 1].map(|parity| self.plant.effect(m, parity).map(|x| Complex::from(x) * self.turn_of_command(m)))
            })
            .collect();
        let flow = self.plant.flow(T).0.map(|x| Complex::from(x) * self.turn(-1.0, 0.0));
        let columns: Vec<DVector<Complex<f64>>> = (0..size)
            .map(|start| {
                let mut state = DVector::zeros(size);
                state[start] = Complex::from(1.0);
                (0..self.hyperperiod()).for_each(|k| self.step(&mut state, k, gain, (&flow, &effects)));
                state
            })
            .collect();
        // The real form has the same roots and their conjugates.
        let real = DMatrix::from_fn(2 * size, 2 * size, |i, j| {
            let entry = columns[j % size][i % size];
            match (i < size, j < size) {
                (true, false) => -entry.im,
                (false, true) => entry.im,
                _ => entry.re,
            }
        });
        real.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
    }

    /// `exp(j (periods w T + share a))`.
    fn turn(&self, periods: f64, share: f64) -> Complex<f64> {
        let angle = |of: &Frame| periods * of.speed as f64 / 10.0 * T + share * of.advance as f64 / 10.0;
        Complex::cis(self.frame.as_ref().map_or(0.0, angle))
    }

    /// A command's turn against the frame at the end of the period `m` periods behind its own.
    fn turn_of_command(&self, m: usize) -> Complex<f64> {
        self.turn(-1.0 - m as f64, 1.0)
    }

    fn step(&self, state: &mut DVector<Complex<f64>>, k: usize, gain: f64, (flow, effects): (&Map, &[[Map; 2]])) {
        let n = self.plant.order();
        let y: Complex<f64> = self.plant.output().zip(state.iter()).map(|(c, x)| x * c).sum();
        let run = |of: &Controller, own: f64, error: Complex<f64>, at: usize, state: &mut DVector<Complex<f64>>| {
            if k % of.every == of.phase {
                let (_, [a, b, c, d]) = controller(of.kind, own);
                state[at + 2] = state[at] * c + error * d;
                state[at] = state[at] * a + error * b;
            }
            state[at + 2]
        };
        let gains = if self.gain_is_slow { [gain, 0.25] } else { [0.25, gain] };
        let v = run(&self.slow, gains[0], -y, n, state);
        let u = run(&self.fast, gains[1], v - y, n + 1, state);
        let mut commands = vec![u];
        commands.extend(state.iter().skip(n + 4));
        let mut x = flow * state.rows(0, n);
        for (m, command) in commands.iter().enumerate() {
            let parity = (k + PAST * 2 - m) % 2;
            x += effects[m][parity].column(0) * *command;
        }
        state.rows_mut(0, n).copy_from(&x);
        for (m, command) in commands.iter().take(PAST).enumerate() {
            state[n + 4 + m] = *command;
        }
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn random_cascades_against_events_stepped_one_by_one() {
    let asked = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<usize>().ok());
    let cases = asked("EVENT_CASES").unwrap_or(count(9, 24));
    let mut random = Random::new(asked("EVENT_SEED").unwrap_or(2026) as u64);
    let (mut looked_at, mut ends, mut skipped, mut undecided) = (0, 0, 0, 0);
    for _ in 0..cases {
        let case = Case::random(&mut random);
        if case.plant.is_sampled_on_an_edge() {
            skipped += 1;
            continue;
        }
        let model = read(&case.text());
        let set = model.ask().free("K").stable_set(&Budget::with_work(10_000_000));
        let Ok(set) = set.map(|answer| answer.into_value()) else {
            undecided += 1;
            continue;
        };
        let gains = (0..4).map(|_| random.below(4001) as f64 / 400.0 - 5.0).collect();
        let [new_ends, new_gains] = agrees_with_radius(&model, &set, gains, 2e-3, |gain| case.radius(gain));
        (ends, looked_at) = (ends + new_ends, looked_at + new_gains);
    }
    println!("{cases} cases, {skipped} left out, {undecided} undecided, {ends} ends, {looked_at} gains");
    assert!(looked_at > cases && undecided * 4 < cases);
}
