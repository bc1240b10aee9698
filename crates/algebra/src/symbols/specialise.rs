//! Proofs that polynomials in several variables have no repeated and no common factor, from their values on lines.
//!
//! A factor in which variable `j` occurs keeps its degree in `j` on a line on which the polynomial keeps its own. So one line
//! on which a polynomial is square-free, or two are coprime, shows that no such factor is repeated or common. Lines nearly
//! always show it, where a greatest common divisor in several variables would take long.

use crate::number::Integer;
use crate::poly::{Domain, MultiPoly, SquareFree, UniPoly};

/// Lines that are tried.
const LINES: u64 = 3;

/// The polynomial in variable `j` on a line; `None` where its degree in `j` falls.
fn on_line(p: &MultiPoly, j: usize, line: u64) -> Option<UniPoly> {
    let count = p.degrees().len();
    // Small numbers that are neither zero nor one, different for each variable and line.
    let point: Vec<Integer> =
        (0..count as u64).map(|i| Integer::from(3 + (i * 7 + line * 11) % 23 + (i * i + line) % 5)).collect();
    let parts = p.as_poly_in(j);
    let values = parts.coeffs().iter().map(|c| {
        let mut at = point.clone();
        at.resize(c.degrees().len().max(count), Integer::ONE);
        c.eval_integers(&at)
    });
    let line = UniPoly::new(values.collect());
    (line.degree() == parts.degree()).then_some(line)
}

/// Whether it is shown that no factor in which variable `j` occurs is repeated.
pub fn is_square_free_in(p: &MultiPoly, j: usize) -> bool {
    (0..LINES).any(|line| on_line(p, j, line).is_some_and(|u| SquareFree::new(u).is_some()))
}

/// Whether it is shown that no factor in which variable `j` occurs is common.
pub fn are_coprime_in(a: &MultiPoly, b: &MultiPoly, j: usize) -> bool {
    if a.degree_in(j) == 0 || b.degree_in(j) == 0 {
        return true;
    }
    let on = |line| Some(on_line(a, j, line)?.gcd(&on_line(b, j, line)?).is_constant());
    (0..LINES).any(|line| on(line) == Some(true))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_and_common_factors_are_never_missed() {
        let [x, y, z] = [0, 1, 2].map(MultiPoly::variable);
        let f = x.times(&y).plus(&z);
        let g = x.times(&x).plus(&y.times(&z)).plus(&MultiPoly::one());
        assert!((0..3).all(|j| is_square_free_in(&f.times(&g), j)));
        assert!((0..3).all(|j| !is_square_free_in(&f.times(&f).times(&g), j)));
        assert!((0..3).all(|j| are_coprime_in(&f, &g, j)));
        assert!((0..3).all(|j| !are_coprime_in(&f.times(&x), &f.times(&g), j)));
        // A factor in which a variable does not occur is of no concern for it.
        let only_y = y.plus(&MultiPoly::one());
        assert!(is_square_free_in(&f.times(&only_y).times(&only_y), 0));
        assert!(are_coprime_in(&f.times(&only_y), &g.times(&only_y), 0));
    }
}
