//! Resultants with respect to `y` of polynomials in two parameters, by their values modulo many numbers.

use super::residues::Modulus;
use crate::clock::Clock;
use crate::number::Z;
use crate::univariate::{Uni, gcd_of};
use num_traits::{One, Signed, Zero};

/// Resultants of a higher degree are refused.
const MAX_DEGREE: i64 = 20_000;

/// Resultants of longer coefficients are refused.
const MAX_BITS: u64 = 1 << 22;

/// The resultant of two polynomials in `y`, coefficients from the constant term up, which are polynomials in `x`; up to an integer
/// factor. Neither is constant in `y`.
///
/// Modulo one number it is known by its values at more integers than its degree, where no leading coefficient vanishes. An integer
/// is known by its residues if twice its size is below the product of the moduli; and the sum of the coefficients' sizes is at most the
/// product of those of the rows of the Sylvester matrix.
pub(super) fn resultant(f: &[Uni], g: &[Uni], clock: &Clock) -> Result<Uni, String> {
    let (f, g) = (primitive(f), primitive(g));
    let degree = degree_bound(&f, &g);
    if degree > MAX_DEGREE {
        return Err("a resultant has too high a degree".into());
    }
    let size = |p: &[Uni]| p.iter().flat_map(|c| &c.0).map(Signed::abs).sum::<Z>();
    let [of_f, of_g] = [(&f, &g), (&g, &f)].map(|(p, other)| size(p).bits().saturating_mul(other.len() as u64));
    if of_f.saturating_add(of_g) > MAX_BITS {
        return Err("a resultant is too long".into());
    }
    let bound = Z::from(2) * size(&f).pow(g.len() as u32 - 1) * size(&g).pow(f.len() as u32 - 1);
    let mut known = Residues { moduli: Vec::new(), digits: vec![Vec::new(); degree as usize + 1], product: Z::one() };
    let mut next = 1 << 62;
    while known.product <= bound {
        let modulus = Modulus::below(next).ok_or("a resultant is too long")?;
        next = modulus.value;
        if let Some(residues) = modulo(&f, &g, degree as usize, &modulus, clock)? {
            known.add(modulus, &residues, clock)?;
        }
    }
    known.numbers(clock)
}

/// Without an integer that divides all coefficients.
fn primitive(p: &[Uni]) -> Vec<Uni> {
    let content = gcd_of(p.iter().flat_map(|c| &c.0));
    if content.is_zero() || content.is_one() {
        return p.to_vec();
    }
    p.iter().map(|c| Uni(c.0.iter().map(|c| c / &content).collect())).collect()
}

/// The coefficients of the resultant modulo one number; `None` if this is the wrong number.
fn modulo(f: &[Uni], g: &[Uni], degree: usize, m: &Modulus, clock: &Clock) -> Result<Option<Vec<u64>>, String> {
    let reduced = |p: &[Uni]| p.iter().map(|c| c.0.iter().map(|c| m.of(c)).collect()).collect::<Vec<Vec<u64>>>();
    let (f, g) = (reduced(f), reduced(g));
    let leads = [&f, &g].map(|p| p.last().cloned().unwrap_or_default());
    if leads.iter().any(|lead| lead.iter().all(|c| *c == 0)) {
        return Ok(None);
    }
    let (mut nodes, mut values) = (Vec::with_capacity(degree + 1), Vec::with_capacity(degree + 1));
    for node in 0u64.. {
        if values.len() > degree {
            break;
        }
        clock.spend((f.len() + g.len()) * (f[0].len() + f.len().max(g.len())), 1, 1)?;
        let x = m.of_u64(node);
        if leads.iter().any(|lead| m.value_at(lead, x) == 0) {
            continue;
        }
        let at = |p: &[Vec<u64>]| p.iter().map(|c| m.value_at(c, x)).collect::<Vec<u64>>();
        let Some(value) = m.resultant(at(&f), at(&g)) else { return Ok(None) };
        nodes.push(node);
        values.push(value);
    }
    clock.spend(degree * degree, 1, 1)?;
    Ok(m.interpolated(&nodes, values))
}

/// Integers by their residues.
struct Residues {
    moduli: Vec<Modulus>,
    /// Of each integer: it is the first digit, plus the first modulus times the second digit, and so on.
    digits: Vec<Vec<u64>>,
    product: Z,
}

impl Residues {
    /// One residue more for each of the integers; nothing if the modulus is not coprime to those before.
    fn add(&mut self, m: Modulus, residues: &[u64], clock: &Clock) -> Result<(), String> {
        let Some(inverse) = m.inverse(m.of(&self.product)) else { return Ok(()) };
        let radices: Vec<u64> = self.moduli.iter().map(|other| m.of_u64(other.value)).collect();
        for (digits, residue) in self.digits.iter_mut().zip(residues) {
            clock.spend(1, digits.len() as u64 * 64, 1)?;
            let known = digits.iter().zip(&radices).rev();
            let known = known.fold(0, |sum, (digit, radix)| m.plus(m.times(sum, *radix), m.of_u64(*digit)));
            digits.push(m.number(m.times(m.minus(*residue, known), inverse)));
        }
        self.product *= m.value;
        self.moduli.push(m);
        Ok(())
    }

    /// The integers, from minus half the product of the moduli to half of it.
    fn numbers(&self, clock: &Clock) -> Result<Uni, String> {
        let mut out = Vec::with_capacity(self.digits.len());
        for digits in &self.digits {
            clock.spend(digits.len(), self.product.bits() / 2, 64)?;
            let pairs = digits.iter().zip(&self.moduli).rev();
            let number = pairs.fold(Z::zero(), |sum, (digit, m)| sum * m.value + digit);
            out.push(if &number + &number > self.product { number - &self.product } else { number });
        }
        Ok(Uni::new(out))
    }
}

/// No less than the degree in `x`. With `l` as the weight of `y`, the coefficient of `y^k` has at most the degree `w - l k`, and a product of
/// entries of the Sylvester matrix, one in each row and column, at most `n w_f + m w_g - l m n`.
fn degree_bound(f: &[Uni], g: &[Uni]) -> i64 {
    let (m, n) = (f.len() as i64 - 1, g.len() as i64 - 1);
    let parts = |p: &[Uni]| -> Vec<(i64, i64)> {
        let there = p.iter().zip(0..).filter(|(c, _)| !c.is_zero());
        there.map(|(c, k)| (c.degree() as i64, k)).collect()
    };
    let (f, g) = (parts(f), parts(g));
    let steepest = f.iter().chain(&g).map(|(d, _)| *d).max().unwrap_or(0);
    let weight = |p: &[(i64, i64)], l: i64| p.iter().map(|(d, k)| d + l * k).max().unwrap_or(0);
    let bounds = (-steepest..=steepest).map(|l| n * weight(&f, l) + m * weight(&g, l) - l * m * n);
    // A determinant without a term is zero: its bound may be anything.
    bounds.min().unwrap_or(0).max(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    /// The determinant of the Sylvester matrix, expanded along its first row.
    fn sylvester(f: &[Uni], g: &[Uni]) -> Uni {
        let (m, n) = (f.len() - 1, g.len() - 1);
        let row = |p: &[Uni], shift: usize| -> Vec<Uni> {
            let mut row = vec![Uni::default(); m + n];
            p.iter().rev().enumerate().for_each(|(k, c)| row[shift + k] = c.clone());
            row
        };
        let rows = (0..n).map(|i| row(f, i)).chain((0..m).map(|i| row(g, i))).collect();
        determinant(rows)
    }

    fn determinant(rows: Vec<Vec<Uni>>) -> Uni {
        let Some((first, rest)) = rows.split_first() else { return uni(&[1]) };
        let minor = |j: usize| {
            let without =
                |row: &Vec<Uni>| row.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, c)| c.clone()).collect();
            determinant(rest.iter().map(without).collect())
        };
        first.iter().enumerate().fold(Uni::default(), |sum, (j, c)| {
            let term = if c.is_zero() { Uni::default() } else { c.times(&minor(j)) };
            if j % 2 == 0 { sum.plus(&term) } else { sum.minus(&term) }
        })
    }

    #[test]
    fn it_is_the_determinant_of_the_sylvester_matrix() {
        let long = Z::from(3).pow(200);
        let clock = Clock::new(Duration::MAX);
        let polynomials = [
            vec![uni(&[1, 2]), uni(&[-3]), uni(&[0, 0, 5])],
            vec![uni(&[0, 1]), uni(&[1])],
            vec![uni(&[-7, 0, 1]), uni(&[]), uni(&[2, -1]), uni(&[0, 3])],
            vec![uni(&[4]), uni(&[]), uni(&[]), uni(&[]), uni(&[-1, 1])],
            vec![uni(&[0, 0, 0, 1]), uni(&[-1, 1])],
            // A remainder that loses more than one degree.
            vec![uni(&[1]), uni(&[2]), uni(&[]), uni(&[]), uni(&[1])],
            vec![
                Uni::new(vec![long.clone(), Z::from(-1)]),
                Uni::new(vec![-long, Z::from(0), Z::from(7)]),
                uni(&[-2, 3]),
            ],
        ];
        for f in &polynomials {
            for g in &polynomials {
                assert_eq!(resultant(f, g, &clock).unwrap(), sylvester(f, g), "{f:?} {g:?}");
            }
        }
        // Of y^2 and (x^2 + 1) y^2 no term of the determinant is left, and the bound of the degree is below zero.
        let (f, g) = (vec![uni(&[]), uni(&[]), uni(&[0, 1])], vec![uni(&[]), uni(&[]), uni(&[1, 0, 1])]);
        assert!(resultant(&f, &g, &clock).unwrap().is_zero());
        // A common factor: x y + 1.
        let (f, g) = (vec![uni(&[1]), uni(&[1, 1]), uni(&[0, 1])], vec![uni(&[2]), uni(&[1, 2]), uni(&[0, 1])]);
        assert!(resultant(&f, &g, &clock).unwrap().is_zero());
    }
}
