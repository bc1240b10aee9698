//! What requirements ask of an open loop with dead time along the imaginary axis.

use super::along_axis::{AlongAxis, Turn};
use super::along_circle::{Coefficient, NearlyLinear};
use super::asked_functions::{Function, Products, scaled, sum};
use jurist_algebra::number::Integer;
use std::sync::Arc;

/// The open loop `N/D exp(-tau s)`, where `s` is counted in a unit of the frequency. A function is a polynomial in `omega`, one that is multiplied
/// by `cos(tau omega)`, and one that is multiplied by `sin(tau omega)/omega`: together all are even or odd, and what vanishes at 0 is seen.
pub(super) struct OnAxis<C> {
    /// `|D|^2` and `|N|^2`, with what these are at a frequency.
    moduli: [Vec<C>; 2],
    /// The real and the imaginary part of `N conj(D)`, and of the numerator without its factor.
    real: Vec<C>,
    imaginary: Vec<C>,
    bare: [Vec<C>; 2],
    has_integrator: bool,
}

impl<C: Coefficient> OnAxis<C> {
    /// Of the coefficients of the denominator, and of the numerator without a factor, which comes with it.
    pub fn new(d: &[C], bare: &[C], factor: &C) -> OnAxis<C> {
        let n: Vec<C> = bare.iter().map(|x| x.times(factor)).collect();
        let [real, imaginary] = times_conjugate(&n, d);
        let [below, _] = times_conjugate(d, d);
        let [above, _] = times_conjugate(&n, &n);
        OnAxis {
            moduli: [below, above],
            real,
            imaginary,
            bare: times_conjugate(bare, d),
            has_integrator: d.first().is_some_and(C::is_zero),
        }
    }

    /// With frequencies up to so many octaves above the unit; the dead time is in the unit of time that belongs to them.
    pub fn along(functions: Vec<Function<C, 3>>, octaves: u64, turn: Turn) -> Vec<AlongAxis>
    where
        C: NearlyLinear,
    {
        let scaled = |(i, p): (usize, Vec<C>)| -> Vec<C> {
            // The last one is multiplied by sin(tau omega)/omega.
            let more = if i < 2 { octaves } else { 0 };
            let power = |k: usize| Integer::ONE << (octaves * k as u64 + more);
            p.iter().enumerate().map(|(k, c)| c.scaled(&power(k))).collect()
        };
        let near = functions.into_iter().map(|f| {
            let mut all = f.into_iter().enumerate().map(scaled);
            std::array::from_fn(|_| all.next().expect("three polynomials"))
        });
        AlongAxis::all(near.collect(), &Arc::new(turn))
    }
}

impl<C: Coefficient> Products<C, 3> for OnAxis<C> {
    fn moduli(&self) -> [Function<C, 3>; 2] {
        self.moduli.each_ref().map(|p| {
            let nothing = vec![p[0].scaled(&Integer::ZERO)];
            [doubled(p), nothing.clone(), nothing]
        })
    }

    /// `Re((R + jI)(cos - j sin)) = R cos + I sin`.
    fn twice_real(&self) -> Function<C, 3> {
        let nothing = vec![self.real[0].scaled(&Integer::ZERO)];
        [nothing, doubled(&self.real), doubled(&up(&self.imaginary))]
    }

    /// `I cos - R sin`.
    fn imaginary(&self) -> Function<C, 3> {
        let [real, imaginary] = &self.bare;
        let negative = up(real).iter().map(|x| x.scaled(&-Integer::ONE)).collect();
        [vec![real[0].scaled(&Integer::ZERO)], imaginary.clone(), negative]
    }

    /// `R cos + I sin`.
    fn real(&self) -> Option<Function<C, 3>> {
        let [real, imaginary] = &self.bare;
        Some([vec![real[0].scaled(&Integer::ZERO)], real.clone(), up(imaginary)])
    }

    fn combined(&self, u: &Integer, v: &Integer) -> Function<C, 3> {
        let [below, above] = self.moduli();
        let squares = sum(&scaled(&below, &(u * u)), &scaled(&above, &(v * v)));
        sum(&squares, &scaled(&self.twice_real(), &(&(u * v) << 1)))
    }

    fn has_integrator(&self) -> bool {
        self.has_integrator
    }
}

/// The real and the imaginary part of `p(j omega)` times the conjugate of `q(j omega)`.
fn times_conjugate<C: Coefficient>(p: &[C], q: &[C]) -> [Vec<C>; 2] {
    let nothing = p[0].scaled(&Integer::ZERO);
    let mut parts = [vec![nothing; p.len() + q.len() - 1], Vec::new()];
    parts[1] = parts[0].clone();
    for (i, x) in p.iter().enumerate() {
        for (k, y) in q.iter().enumerate() {
            // j^i (-j)^k = j^(i - k)
            let turns = (i + 3 * k) % 4;
            let product = x.times(y);
            let product = if turns >= 2 { product.scaled(&-Integer::ONE) } else { product };
            let sum = &mut parts[turns % 2][i + k];
            *sum = sum.plus(&product);
        }
    }
    parts
}

fn doubled<C: Coefficient>(p: &[C]) -> Vec<C> {
    p.iter().map(|x| x.scaled(&Integer::from(2))).collect()
}

/// Times `omega`.
fn up<C: Coefficient>(p: &[C]) -> Vec<C> {
    std::iter::once(p[0].scaled(&Integer::ZERO)).chain(p.iter().cloned()).collect()
}
