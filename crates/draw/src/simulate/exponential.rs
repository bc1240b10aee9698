//! `x' = A x + b` over a time span, to the last digits of `f64`, for any length of the span.

use nalgebra::{DMatrix, DVector};

/// Above this value of `|A| t` the dense exponential (scaling and squaring) is used instead of
/// summing the series in pieces: at 32 both cost about the same for 2 to 6 states.
const SERIES_REACH: f64 = 32.0;

/// The flow of `x' = A x + b` with constant `b`.
#[derive(Clone, Debug)]
pub struct Exponential {
    matrix: DMatrix<f64>,
    norm: f64,
}

/// A state and its integral over a span.
#[derive(Clone, Debug)]
pub struct StateIntegral {
    /// The state at the end.
    pub state: DVector<f64>,
    /// The integral of the state over the span.
    pub integral: DVector<f64>,
}

impl Exponential {
    /// The flow of a square matrix.
    pub fn new(matrix: DMatrix<f64>) -> Exponential {
        let norm = (0..matrix.ncols()).map(|j| matrix.column(j).iter().map(|v| v.abs()).sum()).fold(0.0, f64::max);
        Exponential { matrix, norm }
    }

    /// The state after `t >= 0`, starting at `x`, under the constant drive `b`.
    ///
    /// The series of the matrix exponential is summed until its terms no longer change the sum, in
    /// pieces short enough that no digits cancel.
    ///
    /// ```
    /// use jurist_draw::simulate::Exponential;
    /// use nalgebra::{DMatrix, DVector};
    /// let flow = Exponential::new(DMatrix::from_row_slice(1, 1, &[-1.0]));
    /// let x = flow.advance(&DVector::from_vec(vec![1.0]), &DVector::from_vec(vec![0.0]), 1.0);
    /// assert!((x[0] - (-1.0f64).exp()).abs() < 1e-15);
    /// ```
    pub fn advance(&self, x: &DVector<f64>, b: &DVector<f64>, t: f64) -> DVector<f64> {
        let reach = self.norm * t;
        if reach > SERIES_REACH {
            return self.advance_dense(x, b, t);
        }
        let pieces = reach.ceil().max(1.0);
        let h = t / pieces;
        let mut x = x.clone();
        for _ in 0..pieces as usize {
            let mut term = (&self.matrix * &x + b) * h;
            x += &term;
            for k in 2..60 {
                term = &self.matrix * &term * (h / f64::from(k));
                x += &term;
                let settled = |(value, change): (&f64, &f64)| change.abs() <= f64::EPSILON * 0.01 * value.abs();
                if x.iter().zip(term.iter()).all(settled) {
                    break;
                }
            }
        }
        x
    }

    /// The same by one dense exponential of the matrix bordered with `b`.
    pub fn advance_dense(&self, x: &DVector<f64>, b: &DVector<f64>, t: f64) -> DVector<f64> {
        let n = self.matrix.nrows();
        let mut bordered = DMatrix::zeros(n + 1, n + 1);
        bordered.view_mut((0, 0), (n, n)).copy_from(&(&self.matrix * t));
        bordered.view_mut((0, n), (n, 1)).copy_from(&(b * t));
        let e = bordered.exp();
        e.view((0, 0), (n, n)) * x + e.view((0, n), (n, 1))
    }

    /// `e^(A t)`.
    pub fn transition(&self, t: f64) -> DMatrix<f64> {
        let n = self.matrix.nrows();
        let zero = DVector::zeros(n);
        let identity = DMatrix::<f64>::identity(n, n);
        let columns: Vec<_> = (0..n).map(|j| self.advance(&identity.column(j).into_owned(), &zero, t)).collect();
        if columns.is_empty() { identity } else { DMatrix::from_columns(&columns) }
    }

    /// The state after `t` and its integral over the span.
    pub fn advance_with_integral(&self, x: &DVector<f64>, b: &DVector<f64>, t: f64) -> StateIntegral {
        let n = self.matrix.nrows();
        let mut bordered = DMatrix::zeros(2 * n, 2 * n);
        bordered.view_mut((0, 0), (n, n)).copy_from(&self.matrix);
        bordered.view_mut((n, 0), (n, n)).fill_with_identity();
        let pad =
            |v: &DVector<f64>| DVector::from_iterator(2 * n, v.iter().copied().chain(std::iter::repeat_n(0.0, n)));
        let end = Exponential::new(bordered).advance(&pad(x), &pad(b), t);
        StateIntegral { state: end.rows(0, n).into_owned(), integral: end.rows(n, n).into_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn the_series_agrees_with_the_dense_exponential() {
        let flow = Exponential::new(DMatrix::from_row_slice(2, 2, &[-21.7, -11.9, 5.9, -0.086]));
        let (x, b) = (DVector::from_vec(vec![3.0, 80.0]), DVector::from_vec(vec![2391.0, -1.0]));
        for t in [0.0, 1e-9, 1e-4, 0.01, 0.3, 1.0] {
            let (series, dense) = (flow.advance(&x, &b, t), flow.advance_dense(&x, &b, t));
            assert!((&series - &dense).norm() <= 1e-12 * dense.norm(), "t = {t}: {series} {dense}");
        }
    }

    #[test]
    fn a_rotation_comes_back_after_a_turn_and_long_spans_use_the_dense_way() {
        let flow = Exponential::new(DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0]));
        let tau = std::f64::consts::TAU;
        for turns in [1.0, 3.0, 20.0] {
            let x = flow.advance(&DVector::from_vec(vec![1.0, 0.0]), &DVector::from_vec(vec![0.0, 0.0]), turns * tau);
            assert!((x - DVector::from_vec(vec![1.0, 0.0])).norm() < 1e-12);
        }
        assert!((flow.transition(tau / 4.0) - DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0])).norm() < 1e-14);
    }

    #[test]
    fn the_integral_of_a_decay_is_known() {
        let flow = Exponential::new(DMatrix::from_row_slice(1, 1, &[-2.0]));
        let end = flow.advance_with_integral(&DVector::from_vec(vec![1.0]), &DVector::from_vec(vec![0.0]), 1.5);
        assert!((end.state[0] - (-3.0f64).exp()).abs() < 1e-15);
        assert!((end.integral[0] - (1.0 - (-3.0f64).exp()) / 2.0).abs() < 1e-15);
    }

    #[test]
    fn no_state_is_fine() {
        let flow = Exponential::new(DMatrix::zeros(0, 0));
        assert_eq!(flow.transition(1.0).shape(), (0, 0));
    }
}
