//! A smaller region, brought back to the unit disc or the left half plane.

use super::clock::Clock;
use super::number::{Q, power};
use super::statement::Extent;
use super::univariate::{Uni, common_denominator};
use num_bigint::BigInt as Z;
use num_traits::One;

/// `D(R z)` or `D(s - S)`, without denominators, and divided by the integers common to all coefficients.
pub(super) fn transformed(d: &[Uni], discrete: bool, extent: &Extent, clock: &Clock) -> Result<Vec<Uni>, String> {
    let n = d.len();
    let out = match (discrete, extent) {
        (true, Extent::Parameter) => d.iter().enumerate().map(|(k, c)| c.shifted_up(k)).collect(),
        (true, Extent::Number(r)) => {
            clock.hold(n, n as u64 * (r.numer().bits() + r.denom().bits()))?;
            let powers: Vec<Q> = (0..n).map(|k| power(r, k as u32)).collect();
            let m = common_denominator(powers.iter());
            d.iter().zip(&powers).map(|(c, p)| c.scaled(&(p.numer() * (&m / p.denom())))).collect()
        }
        (false, extent) => {
            // With S = a/b: b^(n-1) D(s - a/b) through D_k b^(n-1-k) and a shift by -a in b s.
            let (a, b) = match extent {
                Extent::Parameter => (Uni::new(vec![Z::from(0), -Z::one()]), Z::one()),
                Extent::Number(s) => (Uni::constant(-s.numer()), s.denom().clone()),
            };
            let mut c: Vec<Uni> = d.to_vec();
            let mut scale = Z::one();
            for x in c.iter_mut().rev() {
                *x = x.scaled(&scale);
                scale *= &b;
            }
            for i in 0..n {
                let bits = c.iter().map(Uni::longest).max().unwrap_or(0);
                clock.hold(c.iter().map(|c| c.0.len() + 1).sum(), bits + a.longest())?;
                for j in (i..n - 1).rev() {
                    clock.spend(1 + c[j + 1].0.len(), bits, a.longest())?;
                    c[j] = c[j].plus(&c[j + 1].times(&a));
                }
            }
            let mut scale = Z::one();
            for x in &mut c {
                *x = x.scaled(&scale);
                scale *= &b;
            }
            c
        }
    };
    super::characteristic::primitive(out, clock)
}
