//! The Routh table, without fractions, numeric or symbolic.

use jurist_algebra::poly::{Domain, Poly, UniPoly};

/// The fraction-free Routh table: rows 0 and 1 hold the coefficients of even and odd distance from
/// the leading one; the first entries of rows 1 to n are the Hurwitz determinants.
///
/// The table is that of [Routh1877](jurist_algebra::bibliography#routh1877), each row a positive multiple of his
/// where the first column is positive.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::routh_table;
/// let table = routh_table(&UniPoly::from_i64(&[4, 3, 2, 1]), 3); // s^3 + 2 s^2 + 3 s + 4
/// assert!(table.first_column().eq(&[1.into(), 2.into(), 2.into(), 8.into()]));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RouthTable<R> {
    /// Row `i`, of `floor((n - i)/2) + 1` entries.
    pub rows: Vec<Vec<R>>,
}

impl<R: Domain> RouthTable<R> {
    /// The first column: the leading coefficient, then the Hurwitz determinants as far as the table
    /// was built (a row that begins with zero ends it, unless it is the last).
    pub fn first_column(&self) -> impl Iterator<Item = &R> {
        self.rows.iter().map(|row| &row[0])
    }
}

/// The table of `p` read with formal degree `n`: `n + 1` rows, with
/// `r_k,j = (r_(k-1),0 r_(k-2),j+1 - r_(k-2),0 r_(k-1),j+1) / r_(k-3),0`, the division (from the
/// fourth recursion on) being exact (Bareiss's identity; [Bistritz2013](jurist_algebra::bibliography#bistritz2013)).
///
/// A row whose first entry is (identically) zero ends the table, because the next would divide by it.
/// `O(n^2)` operations.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::routh_table;
/// let table = routh_table(&UniPoly::from_i64(&[4, 3, 2, 1]), 3); // s^3 + 2 s^2 + 3 s + 4
/// assert_eq!(table.rows[..2], [vec![1.into(), 3.into()], vec![2.into(), 4.into()]]);
/// assert_eq!(table.rows[2..], [vec![2.into()], vec![8.into()]]);
/// ```
///
/// # Panics
/// When `n` is below the degree of `p`.
pub fn routh_table<R: Domain>(p: &Poly<R>, n: usize) -> RouthTable<R> {
    assert!(p.coeffs().len() <= n + 1, "the formal degree is below the degree");
    let line = |from: usize| -> Vec<R> { (from..=n).step_by(2).map(|i| p.coeff(n - i)).collect() };
    let mut rows = vec![line(0)];
    if n > 0 {
        rows.push(line(1));
    }
    for k in 2..=n {
        let (up2, up1) = (&rows[k - 2], &rows[k - 1]);
        if up1[0].is_zero() || up2[0].is_zero() {
            break;
        }
        let entry = |row: &Vec<R>, j: usize| row.get(j).cloned().unwrap_or_else(R::zero);
        let length = (n - k) / 2 + 1;
        let divisor = (k >= 4).then(|| &rows[k - 3][0]);
        let mut row: Vec<R> = Vec::with_capacity(length);
        for j in 0..length {
            let entry = up1[0].times(&entry(up2, j + 1)).minus(&up2[0].times(&entry(up1, j + 1)));
            row.push(match divisor {
                Some(divisor) => entry.div_exact(divisor).expect("Bareiss's identity"),
                None => entry,
            });
        }
        rows.push(row);
    }
    RouthTable { rows }
}

/// Whether all roots of `p` lie in the open left half plane, by the Hurwitz determinants.
///
/// An oracle for [`super::count_roots`]; the zero polynomial is not stable, a constant is.
///
/// Cost: that of [`routh_table`] ([Bistritz2013](jurist_algebra::bibliography#bistritz2013)): `O(n^2)` operations
/// on integers that are minors of the matrix of Hurwitz.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::is_hurwitz_routh;
/// assert!(is_hurwitz_routh(&UniPoly::from_i64(&[4, 3, 2, 1])));
/// assert!(!is_hurwitz_routh(&UniPoly::from_i64(&[9, 3, 2, 1])));
/// ```
pub fn is_hurwitz_routh(p: &UniPoly) -> bool {
    let Some(n) = p.degree() else { return false };
    let p = if p.needs_negation() { p.negated() } else { p.clone() };
    let table = routh_table(&p, n);
    table.rows.len() == n + 1 && table.first_column().all(|c| c.sign() == std::cmp::Ordering::Greater)
}
