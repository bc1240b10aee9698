//! Whether slightly perturbed runs of the circuit grow or die, and where the change is.

use super::{SwitchedModel, SwitchedState};
use nalgebra::DVector;

/// Size of the perturbation relative to the steady state: far above the rounding of a step (1e-16),
/// small enough for the quadratic terms (1e-14) to stay below it by seven digits.
const PERTURBATION: f64 = 1e-7;

/// Periods between two rescalings of a perturbed run.
const BLOCK: usize = 64;

/// How a slightly perturbed run behaved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Factor per period by which the deviation from the steady state grew.
    pub factor: f64,
}

impl SwitchedModel {
    /// Runs the circuit from a periodic steady state that a short extra pulse of the sources has
    /// disturbed slightly, and measures the growth of the plant's deviation over the last `measured` periods, `settling` periods before that.
    ///
    /// Every period is a run of the circuit itself, not of its linearisation; the deviation is only
    /// scaled back to its first size every 64 periods, so that the run stays near the steady state.
    /// `None` where there is no steady state without clamping.
    pub fn perturbed_growth(&self, inputs: &DVector<f64>, settling: usize, measured: usize) -> Option<Growth> {
        let operating = self.periodic_steady_state(inputs)?;
        let base = operating.state.stacked();
        let n = self.plant_states.len();
        let scale = base.rows(0, n).norm().max(1.0);
        let size = |d: &DVector<f64>| d.rows(0, n).norm() / scale;
        // The disturbance of a short extra pulse of every source.
        let pulse = self.sources.iter().enumerate().map(|(k, s)| self.plant.source.column(k) * s.amplitude);
        let kick = pulse.fold(DVector::zeros(n), |sum, v| sum + v);
        let mut deviation = DVector::zeros(base.len());
        deviation.rows_mut(0, n).copy_from(&kick);
        if size(&deviation) == 0.0 {
            deviation.fill(1.0);
        }
        let (mut log, mut sum, mut moment, mut points) = (0.0, 0.0, 0.0, 0usize);
        let total = measured.max(BLOCK);
        let middle = (total as f64 + 1.0) / 2.0;
        let mut k = 0;
        while k < settling + total {
            deviation *= PERTURBATION / size(&deviation);
            let mut z = &base + &deviation;
            // The steady state is known to rounding; where it drifts to in a block is subtracted.
            let mut reference = base.clone();
            for _ in 0..BLOCK {
                z = self.next_period(&SwitchedState::unstacked(&z, n), inputs).stacked();
                reference = self.next_period(&SwitchedState::unstacked(&reference, n), inputs).stacked();
                deviation = &z - &reference;
                k += 1;
                let now = log + (size(&deviation) / PERTURBATION).ln();
                if k > settling && k <= settling + total {
                    let t = (k - settling) as f64 - middle;
                    sum += t * now;
                    moment += t * t;
                    points += 1;
                }
            }
            log += (size(&deviation) / PERTURBATION).ln();
            if !log.is_finite() {
                return None;
            }
        }
        (points > 1).then(|| Growth { factor: (sum / moment).exp() })
    }
}

/// The parameter value between `stable` and `unstable` at which perturbed runs change from dying to
/// growing, by bisection of `growth` (the factor per period) until the bracket is as narrow as
/// `width`. `None` when an end behaves otherwise than its name says or a run has no answer.
///
/// ```
/// use jurist_draw::simulate::growth_limit;
/// let limit = growth_limit(1.0, 3.0, 1e-6, |k| Some(k / 2.0)).unwrap();
/// assert!((limit - 2.0).abs() < 1e-6);
/// ```
pub fn growth_limit(stable: f64, unstable: f64, width: f64, mut growth: impl FnMut(f64) -> Option<f64>) -> Option<f64> {
    if growth(stable)? >= 1.0 || growth(unstable)? <= 1.0 {
        return None;
    }
    let (mut inside, mut outside) = (stable, unstable);
    while (outside - inside).abs() > width {
        let middle = f64::midpoint(inside, outside);
        if middle == inside || middle == outside {
            break;
        }
        if growth(middle)? < 1.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Some(f64::midpoint(inside, outside))
}
