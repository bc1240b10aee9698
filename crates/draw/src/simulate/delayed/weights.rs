//! One step of `x' = A x + g(t)` for a cubic `g`, exactly.

use nalgebra::DMatrix;

/// Where `g` is looked at, as shares of the step.
pub(super) const NODES: [f64; 4] = [0.125, 0.375, 0.625, 0.875];

/// What a step of a length makes of the state and of the values of `g` at the nodes.
pub(super) struct Weights {
    pub length: f64,
    /// `exp(A h)`.
    pub flow: DMatrix<f64>,
    /// The matrix for each node.
    pub nodes: [DMatrix<f64>; 4],
}

impl Weights {
    /// `x(h) = exp(A h) x(0) + sum_i h^(i+1) phi_(i+1)(A h) g^(i)(0)`, the blocks read from one exponential
    /// ([VanLoan1978](jurist_algebra::bibliography#vanloan1978)).
    pub fn new(a: &DMatrix<f64>, length: f64) -> Weights {
        let n = a.nrows();
        let mut blocks = DMatrix::zeros(5 * n, 5 * n);
        blocks.view_mut((0, 0), (n, n)).copy_from(&(a * length));
        for k in 0..4 {
            blocks.view_mut((k * n, (k + 1) * n), (n, n)).fill_with_identity();
        }
        let exponential = blocks.exp();
        let phi = |k: usize| exponential.view((0, k * n), (n, n)).into_owned();
        // g(h s) = sum_i d_i s^i/i!, where d_i = i! times the coefficient of s^i.
        let coefficients = coefficients();
        let factorial = [1.0, 1.0, 2.0, 6.0];
        let nodes = [0, 1, 2, 3].map(|node| {
            (0..4)
                .fold(DMatrix::zeros(n, n), |sum, i| sum + phi(i + 1) * (length * factorial[i] * coefficients[node][i]))
        });
        Weights { length, flow: phi(0), nodes }
    }
}

/// The coefficients of `s^i` of the cubic that is 1 at one node and 0 at the others.
fn coefficients() -> [[f64; 4]; 4] {
    [0, 1, 2, 3].map(|node| {
        let mut c = [1.0, 0.0, 0.0, 0.0];
        for other in (0..4).filter(|other| *other != node) {
            let bottom = NODES[node] - NODES[other];
            let lower = [0.0, c[0], c[1], c[2]];
            c = [0, 1, 2, 3].map(|i| (lower[i] - NODES[other] * c[i]) / bottom);
        }
        c
    })
}

/// The factors of the values at the nodes in the value of the cubic at a share of the step.
pub(super) fn through(share: f64) -> [f64; 4] {
    coefficients().map(|c| c.iter().rev().fold(0.0, |sum, x| sum * share + x))
}
