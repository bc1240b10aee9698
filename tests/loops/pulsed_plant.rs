//! A random plant behind a hold or a modulator, and the course of its state under a pulse, in floating point.

use crate::helpers::random::Random;
use nalgebra::DMatrix;

/// The sample time.
pub(super) const T: f64 = 0.25;

/// How many commands before the last one can have an effect in a period.
pub(super) const PAST: usize = 3;

/// The step of a difference quotient by the duty ratio.
const STEP: f64 = 1e-5;

/// A plant and its pulse.
pub(super) struct PulsedPlant {
    a: Vec<Vec<i64>>,
    b: Vec<i64>,
    c: Vec<i64>,
    /// That of the modulator; `hold` for none.
    pub edge: &'static str,
    /// In twentieths of the period.
    duty: usize,
    /// In eighths of the sample time.
    pub delay: usize,
}

impl PulsedPlant {
    /// A plant of order 1 to 3 behind one of these.
    pub fn random(random: &mut Random, edges: &[&'static str]) -> PulsedPlant {
        let n = 1 + random.below(3);
        let mut entry = |bound: usize| random.below(2 * bound + 1) as i64 - bound as i64;
        let a = (0..n).map(|i| (0..n).map(|j| if i == j { entry(3) - 1 } else { entry(2) }).collect()).collect();
        let (b, c) = ((0..n).map(|_| entry(2)).collect(), (0..n).map(|_| entry(2)).collect());
        let edge = edges[random.below(edges.len())];
        PulsedPlant { a, b, c, edge, duty: 1 + random.below(19), delay: [0, 0, 3, 5, 8, 13][random.below(6)] }
    }

    pub fn order(&self) -> usize {
        self.b.len()
    }

    /// The output that a state has.
    pub fn output(&self) -> impl Iterator<Item = f64> {
        self.c.iter().map(|c| *c as f64)
    }

    /// The block, with more keys of its method.
    pub fn text(&self, more: &str) -> String {
        let row = |row: &[i64]| format!("[{}]", row.iter().map(i64::to_string).collect::<Vec<_>>().join(", "));
        let a: Vec<String> = self.a.iter().map(|r| row(r)).collect();
        let b: Vec<String> = self.b.iter().map(|x| format!("[{x}]")).collect();
        let how = match self.edge {
            "hold" => "method = 'zoh'".to_owned(),
            edge => format!("method = 'pwm', edge = '{edge}', duty = '{}/20'", self.duty),
        };
        format!(
            "[[block]]\ninput = 'u'\noutput = 'y'\nA = [{}]\nB = [{}]\nC = [{}]\ndiscretize = {{ {how}, delay = '{}/32'{more} }}\n",
            a.join(", "),
            b.join(", "),
            row(&self.c),
            self.delay
        )
    }

    /// When the pulse is on that a sample of this parity commands, in a period of 1 that begins at the dead time.
    fn on(&self, d: f64, parity: usize) -> Vec<[f64; 2]> {
        match self.edge {
            "hold" => vec![[0.0, 1.0]],
            "alternating" if parity == 1 => vec![[1.0 - d, 1.0]],
            "trailing" | "alternating" => vec![[0.0, d]],
            "leading" => vec![[1.0 - d, 1.0]],
            "double" => vec![[(1.0 - d) / 2.0, (1.0 + d) / 2.0]],
            _ => vec![[0.0, d / 2.0], [1.0 - d / 2.0, 1.0]],
        }
    }

    /// `exp(A t)` and its integral over `B`.
    pub fn flow(&self, t: f64) -> (DMatrix<f64>, DMatrix<f64>) {
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

    fn duty(&self) -> f64 {
        self.duty as f64 / 20.0
    }

    /// What a command of 1 leaves in the state at the end of the period `m` periods behind its own, which has this parity.
    pub fn effect(&self, m: usize, parity: usize) -> DMatrix<f64> {
        let left = |duty| self.left(duty, m, parity);
        match self.edge {
            "hold" => left(1.0),
            _ => (left(self.duty() + STEP) - left(self.duty() - STEP)) / (2.0 * STEP),
        }
    }

    /// Whether a sample stands on an edge that moves: the effect of a command has a jump there.
    pub fn is_sampled_on_an_edge(&self) -> bool {
        let moving = |t: &f64| self.edge != "hold" && *t > 1e-9 && *t < 1.0 - 1e-9;
        let edges = (0..2).flat_map(|parity| self.on(self.duty(), parity)).flatten().filter(moving);
        edges.map(|edge| edge + self.delay as f64 / 8.0).any(|place| (place - place.round()).abs() < 1e-3)
    }
}

/// A controller of one gain as text, and as `w+ = a w + b e`, `u = c w + d e`.
pub(super) fn controller(kind: usize, gain: f64) -> (&'static str, [f64; 4]) {
    match kind {
        0 => ("K", [0.0, 0.0, 0.0, gain]),
        1 => ("K/z", [0.0, 1.0, gain, 0.0]),
        _ => ("K*(z - 1/2)/(z - 1)", [1.0, 1.0, gain / 2.0, gain]),
    }
}
