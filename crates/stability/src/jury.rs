//! The Jury table, numeric or symbolic.

use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use std::cmp::Ordering;

/// Up to this order the table is the textbook's, row by row; above it every row from the fourth on
/// is divided by its known factor, because the textbook's degrees double from row to row.
pub const UNDIVIDED_ORDER: usize = 8;

/// One row of the table and, where the row was divided by its known factor, that factor.
#[derive(Clone, Debug, PartialEq)]
pub struct JuryRow<R> {
    /// The entries, for `z^0` first.
    pub entries: Vec<R>,
    /// What the textbook's 2 by 2 determinants were divided by; `None` for no division.
    pub divisor: Option<R>,
}

/// The odd rows of the Jury table; each even row is the one above it reversed.
///
/// The first row holds the coefficients `a_0 .. a_n`; the next `b_k = a_0 a_k - a_n a_(n-k)`,
/// `k = 0 .. n-1`, and so on down to a row of three entries ([JuryBlanchard1961](jurist_algebra::bibliography#juryblanchard1961); the form of
/// Phillips and Nagle, Digital Control System Analysis and Design, 1984).
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::jury_table;
/// let table = jury_table(&UniPoly::from_i64(&[1, 2, 3, 4]), 3); // 4 z^3 + 3 z^2 + 2 z + 1
/// assert_eq!(table.rows.len(), 2);
/// assert!(!table.is_divided());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct JuryTable<R> {
    /// The rows `a`, `b`, `c`, ...
    pub rows: Vec<JuryRow<R>>,
}

impl<R: Domain> JuryTable<R> {
    /// Whether any row was divided by its known factor.
    pub fn is_divided(&self) -> bool {
        self.rows.iter().any(|row| row.divisor.is_some())
    }

    /// The two entries that each row's condition compares: the first and the last.
    pub fn end_entries(&self) -> impl Iterator<Item = (&R, &R)> {
        self.rows.iter().map(|row| (&row.entries[0], row.entries.last().expect("rows are not empty")))
    }
}

/// The table of `a` read with formal degree `n`.
///
/// Above order [`UNDIVIDED_ORDER`] the row after `c` is divided by `b_0`, the next by `c_0`, and so
/// on: these divisions are exact, since the rows are then minors of the Schur-Cohn matrix. Where
/// the divisor is identically zero the row is left undivided.
///
/// Cost: `O(n^2)` operations ([JuryBlanchard1961](jurist_algebra::bibliography#juryblanchard1961)), on entries whose length (or degree)
/// doubles from row to row where nothing is divided, and grows by addition where it is.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::jury_table;
/// let table = jury_table(&UniPoly::from_i64(&[1, 2, 3, 4]), 3); // 4 z^3 + 3 z^2 + 2 z + 1
/// assert_eq!(table.rows[1].entries, [(-15).into(), (-10).into(), (-5).into()]);
/// ```
///
/// # Panics
/// When `n` is below the degree of `a`.
pub fn jury_table<R: Domain>(a: &Poly<R>, n: usize) -> JuryTable<R> {
    jury_table_with(a, n, n > UNDIVIDED_ORDER)
}

/// The table with or without the division by the known factors, whatever the order.
///
/// # Panics
/// When `n` is below the degree of `a`.
pub fn jury_table_with<R: Domain>(a: &Poly<R>, n: usize, divide: bool) -> JuryTable<R> {
    assert!(a.coeffs().len() <= n + 1, "the formal degree is below the degree");
    let mut rows = vec![JuryRow { entries: (0..=n).map(|k| a.coeff(k)).collect(), divisor: None }];
    while rows[rows.len() - 1].entries.len() > 3 {
        let last = &rows[rows.len() - 1].entries;
        let m = last.len() - 1;
        let mut entries: Vec<R> = Vec::with_capacity(m);
        for k in 0..m {
            entries.push(last[0].times(&last[k]).minus(&last[m].times(&last[m - k])));
        }
        let factor = (divide && rows.len() >= 3).then(|| rows[rows.len() - 2].entries[0].clone());
        rows.push(match factor.filter(|f| !f.is_zero()) {
            None => JuryRow { entries, divisor: None },
            Some(f) => match quotients(&entries, &f) {
                None => JuryRow { entries, divisor: None },
                Some(entries) => JuryRow { entries, divisor: Some(f) },
            },
        });
    }
    JuryTable { rows }
}

/// All entries divided by a factor; `None` where it does not divide one of them.
fn quotients<R: Domain>(entries: &[R], factor: &R) -> Option<Vec<R>> {
    entries.iter().map(|entry| entry.div_exact(factor)).collect()
}

/// Whether all roots of `p` lie in the open unit disc, by the conditions of the Jury table.
///
/// An oracle for [`super::count_roots`]; the zero polynomial is not stable, a constant is.
///
/// Cost: that of [`jury_table`] ([JuryBlanchard1961](jurist_algebra::bibliography#juryblanchard1961)): `O(n^2)`
/// operations on integers.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::is_schur_jury;
/// assert!(is_schur_jury(&UniPoly::from_i64(&[1, 2, 3, 4])));
/// assert!(!is_schur_jury(&UniPoly::from_i64(&[4, 3, 2, 1])));
/// ```
pub fn is_schur_jury(p: &UniPoly) -> bool {
    let Some(n) = p.degree() else { return false };
    if n == 0 {
        return true;
    }
    let lead = p.leading().expect("not zero").sign();
    let at_one = p.eval(&Integer::ONE).sign();
    let at_minus_one = p.eval(&Integer::from(-1)).sign();
    let alternating = if n % 2 == 0 { at_minus_one } else { at_minus_one.reverse() };
    if at_one != lead || alternating != lead {
        return false;
    }
    let table = jury_table(p, n);
    let mut conditions = table.end_entries().map(|(first, last)| first.abs().cmp(&last.abs()));
    conditions.next() == Some(Ordering::Less) && conditions.all(|c| c == Ordering::Greater)
}
