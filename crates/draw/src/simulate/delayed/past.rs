//! The course of a loop with dead time up to now.

use super::weights::{NODES, Weights, through};
use super::{DelayedModel, Excitation};
use nalgebra::DVector;
use std::collections::VecDeque;

/// The course up to now, as far back as it still acts.
pub(super) struct Past<'a> {
    model: &'a DelayedModel,
    /// Times from which on the inputs have values, in order.
    inputs: Vec<(f64, DVector<f64>)>,
    rest: [DVector<f64>; 2],
    steps: VecDeque<Course>,
    time: f64,
    x: DVector<f64>,
    weights: Vec<Weights>,
    /// Times that differ by less are the same.
    same: f64,
}

/// A step of the past: a cubic.
struct Course {
    from: f64,
    length: f64,
    ends: [DVector<f64>; 2],
    slopes: [DVector<f64>; 2],
}

/// So many step lengths are remembered.
const REMEMBERED: usize = 16;
/// Step lengths that differ by less are the same.
const SAME_LENGTH: f64 = 1e-10;

impl Past<'_> {
    pub fn new<'a>(model: &'a DelayedModel, drive: &Excitation, same: f64) -> Past<'a> {
        let given = drive.initial.iter().copied().chain(std::iter::repeat(0.0));
        let x = DVector::from_iterator(model.states.len(), given.take(model.states.len()));
        let count = model.inputs.len();
        let changes = std::iter::once(0).chain(drive.changes());
        let inputs = changes.map(|n| (n as f64 * model.step, drive.inputs_at(n, count))).collect();
        let rest = [model.states.len(), count].map(DVector::zeros);
        Past { model, inputs, rest, steps: VecDeque::new(), time: 0.0, x, weights: Vec::new(), same }
    }

    pub fn time(&self) -> f64 {
        self.time
    }

    pub fn last(&self) -> &DVector<f64> {
        &self.x
    }

    /// The inputs from a time on.
    pub fn input(&self, t: f64) -> &DVector<f64> {
        let at = self.inputs.partition_point(|(from, _)| *from <= t + self.same);
        if at == 0 { &self.rest[1] } else { &self.inputs[at - 1].1 }
    }

    /// The state at a time up to now.
    pub fn state(&self, t: f64) -> DVector<f64> {
        if t < -self.same {
            return self.rest[0].clone();
        }
        if t >= self.time - self.same {
            return self.x.clone();
        }
        let at = self.steps.partition_point(|step| step.from <= t).saturating_sub(1);
        let Course { from, length, ends: [p, q], slopes: [first, last] } = &self.steps[at];
        let s = ((t - from) / length).clamp(0.0, 1.0);
        let (s2, s3) = (s * s, s * s * s);
        let mut x = p * (2.0 * s3 - 3.0 * s2 + 1.0);
        x.axpy(3.0 * s2 - 2.0 * s3, q, 1.0);
        x.axpy(length * (s3 - 2.0 * s2 + s), first, 1.0);
        x.axpy(length * (s3 - s2), last, 1.0);
        x
    }

    /// What acts from outside of the step and from the past, at a time inside of the step.
    fn drive(&self, t: f64) -> DVector<f64> {
        let mut g = DVector::zeros(self.x.len());
        for tap in &self.model.taps {
            g.gemv(1.0, &tap.e, self.input(t - tap.delay), 1.0);
            if tap.delay > 0.0 {
                g.gemv(1.0, &tap.a, &self.state(t - tap.delay), 1.0);
            }
        }
        g
    }

    /// One step of a length, at whose end it is so late.
    pub fn advance(&mut self, length: f64, goal: f64) {
        // All looks into the past are inside of the step: on one side of every jump.
        let seen = NODES.map(|share| self.drive(self.time + share * length));
        let a = &self.model.taps[0].a;
        let known = self.weights.iter().position(|w| (w.length - length).abs() <= SAME_LENGTH * length);
        let known = known.unwrap_or_else(|| {
            if self.weights.len() == REMEMBERED {
                self.weights.pop();
            }
            self.weights.push(Weights::new(a, length));
            self.weights.len() - 1
        });
        let weights = &self.weights[known];
        let mut next = &weights.flow * &self.x;
        for (weight, g) in weights.nodes.iter().zip(&seen) {
            next.gemv(1.0, weight, g, 1.0);
        }
        let slope = |x: &DVector<f64>, share: f64| {
            let mut slope = a * x;
            through(share).iter().zip(&seen).for_each(|(factor, g)| slope.axpy(*factor, g, 1.0));
            slope
        };
        let slopes = [slope(&self.x, 0.0), slope(&next, 1.0)];
        let before = std::mem::replace(&mut self.x, next);
        self.steps.push_back(Course { from: self.time, length, ends: [before, self.x.clone()], slopes });
        self.time = goal;
        let needed = goal - self.model.longest_dead_time() - length;
        while self.steps.front().is_some_and(|step| step.from + step.length < needed) {
            self.steps.pop_front();
        }
    }
}
