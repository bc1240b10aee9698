//! Polynomials in the parameters of a box and in what depends on them.

use crate::clock::Clock;
use crate::multivariate::Multi;
use crate::number::{Q, Z};
use crate::over_box::FIRST;
use crate::taylor::{Precision, Taylor};
use num_traits::One;
use std::collections::BTreeMap;

/// Polynomials as sums over the monomials of what depends on the parameters, each times a polynomial in these.
pub(super) struct Functions {
    /// The number of parameters.
    parameters: usize,
    /// The exponents of the variables behind the parameters.
    monomials: Vec<Vec<u32>>,
    /// Exponents of the parameters.
    powers: Vec<Vec<u32>>,
    /// Of each polynomial and each of its monomials the coefficients of powers of the parameters.
    rows: Vec<BTreeMap<usize, Vec<(usize, Z)>>>,
}

impl Functions {
    /// Of polynomials in so many parameters, and in what is behind them.
    pub fn new(all: &[Multi], parameters: usize) -> Self {
        let (mut monomials, mut powers) = (BTreeMap::new(), BTreeMap::new());
        let mut rows = Vec::with_capacity(all.len());
        for p in all {
            let mut row: BTreeMap<usize, Vec<(usize, Z)>> = BTreeMap::new();
            for (e, c) in &p.0 {
                let own = |i: usize| e.get(FIRST + i).copied().unwrap_or(0);
                let of_parameters: Vec<u32> = (0..parameters).map(own).collect();
                let behind = e.get(FIRST + parameters..).unwrap_or(&[]).to_vec();
                let next = monomials.len();
                let monomial = *monomials.entry(behind).or_insert(next);
                let next = powers.len();
                let power = *powers.entry(of_parameters).or_insert(next);
                row.entry(monomial).or_default().push((power, c.clone()));
            }
            rows.push(row);
        }
        Functions { parameters, monomials: in_order(monomials), powers: in_order(powers), rows }
    }

    /// At the values of all variables from [`FIRST`] on.
    pub fn at(&self, values: &[Taylor], p: &Precision, clock: &Clock) -> Result<Vec<Taylor>, String> {
        p.hold(2 * values.len() + self.powers.len() + self.monomials.len() + self.rows.len(), clock)?;
        let mut tables: Vec<Vec<Taylor>> = vec![vec![Taylor::number(&Q::one(), p)]; values.len()];
        let mut product = |exponents: &[u32], first: usize| -> Result<Taylor, String> {
            let mut product: Option<Taylor> = None;
            for (i, &k) in exponents.iter().enumerate().filter(|(_, k)| **k > 0) {
                let table = &mut tables[first + i];
                while table.len() <= k as usize {
                    let next = table[table.len() - 1].times(&values[first + i], p, clock)?;
                    table.push(next);
                }
                let power = &table[k as usize];
                product = Some(match product {
                    Some(known) => known.times(power, p, clock)?,
                    None => power.clone(),
                });
            }
            Ok(product.unwrap_or_else(|| Taylor::number(&Q::one(), p)))
        };
        let powers = self.powers.iter().map(|e| product(e, 0)).collect::<Result<Vec<_>, _>>()?;
        let monomials = self.monomials.iter().map(|e| product(e, self.parameters)).collect::<Result<Vec<_>, _>>()?;
        let mut out = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            let mut sum = Taylor::zero();
            for (&monomial, terms) in row {
                let mut factor = Taylor::zero();
                for (power, c) in terms {
                    clock.spend(p.terms(), c.bits(), p.bits as u64)?;
                    factor.add_scaled(&powers[*power], c);
                }
                let is_one = self.monomials[monomial].iter().all(|k| *k == 0);
                sum = sum.plus(&if is_one { factor } else { factor.times(&monomials[monomial], p, clock)? });
            }
            out.push(sum);
        }
        Ok(out)
    }
}

/// The keys in the order of their numbers.
fn in_order<K>(numbered: BTreeMap<K, usize>) -> Vec<K> {
    let mut all: Vec<(K, usize)> = numbered.into_iter().collect();
    all.sort_by_key(|(_, number)| *number);
    all.into_iter().map(|(key, _)| key).collect()
}
