//! Division: exact, and pseudo-division.

use super::{Domain, Poly};
use crate::limits::checkpoint;

impl<R: Domain> Poly<R> {
    /// The exact quotient, or `None` when `divisor` is zero or does not divide.
    pub(super) fn div_exact_poly(&self, divisor: &Poly<R>) -> Option<Poly<R>> {
        let lead = divisor.leading()?;
        let m = divisor.coeffs().len();
        if self.is_zero() {
            return Some(Poly::zero());
        }
        let n = self.coeffs().len();
        if n < m {
            return None;
        }
        let mut rest = self.coeffs().to_vec();
        let mut quotient = vec![R::zero(); n - m + 1];
        for k in (0..=n - m).rev() {
            if rest[k + m - 1].is_zero() {
                continue;
            }
            checkpoint(4 * m as u64);
            let q = if lead.is_one() { rest[k + m - 1].clone() } else { rest[k + m - 1].div_exact(lead)? };
            for (j, d) in divisor.coeffs()[..m - 1].iter().enumerate() {
                rest[k + j].sub_times(&q, d);
            }
            quotient[k] = q;
        }
        rest[..m - 1].iter().all(R::is_zero).then(|| Poly::new(quotient))
    }

    /// Every coefficient divided exactly by `c`, or `None` when one is not divisible.
    pub fn div_exact_scalar(&self, c: &R) -> Option<Poly<R>> {
        if c.is_one() {
            return Some(self.clone());
        }
        checkpoint(4 * self.coeffs().len() as u64);
        self.coeffs().iter().map(|a| a.div_exact(c)).collect::<Option<Vec<R>>>().map(Poly::new)
    }

    /// Pseudo-division: `(q, r)` with `lc(b)^(deg a - deg b + 1) a = q b + r`, `deg r < deg b`
    /// (Knuth, The Art of Computer Programming 2, 4.6.1). For `deg a < deg b` it is `(0, a)`.
    ///
    /// # Panics
    /// When `b` is zero.
    pub fn pseudo_div_rem(&self, b: &Poly<R>) -> (Poly<R>, Poly<R>) {
        let lead = b.leading().expect("pseudo-division by zero").clone();
        let m = b.coeffs().len();
        let n = self.coeffs().len();
        if n < m {
            return (Poly::zero(), self.clone());
        }
        let mut rest = self.coeffs().to_vec();
        let mut quotient = vec![R::zero(); n - m + 1];
        for k in (0..=n - m).rev() {
            checkpoint(4 * (k + 2 * m) as u64);
            let top = rest[k + m - 1].clone();
            if !lead.is_one() {
                for q in &mut quotient[k + 1..] {
                    *q = q.times(&lead);
                }
                for r in &mut rest[..k + m - 1] {
                    *r = r.times(&lead);
                }
            }
            for (j, d) in b.coeffs()[..m - 1].iter().enumerate() {
                rest[k + j].sub_times(&top, d);
            }
            quotient[k] = top;
        }
        rest.truncate(m - 1);
        (Poly::new(quotient), Poly::new(rest))
    }

    /// The pseudo-remainder alone.
    pub fn pseudo_rem(&self, b: &Poly<R>) -> Poly<R> {
        let lead = b.leading().expect("pseudo-division by zero").clone();
        let m = b.coeffs().len();
        let n = self.coeffs().len();
        if n < m {
            return self.clone();
        }
        let mut rest = self.coeffs().to_vec();
        for k in (0..=n - m).rev() {
            checkpoint(4 * (k + 2 * m) as u64);
            let top = rest[k + m - 1].clone();
            if !lead.is_one() {
                for r in &mut rest[..k + m - 1] {
                    *r = r.times(&lead);
                }
            }
            if !top.is_zero() {
                for (j, d) in b.coeffs()[..m - 1].iter().enumerate() {
                    rest[k + j].sub_times(&top, d);
                }
            }
        }
        rest.truncate(m - 1);
        Poly::new(rest)
    }
}
