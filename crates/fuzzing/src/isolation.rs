//! Isolation of real roots against Sturm's theorem.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::real_roots::{Bound, count_roots_sturm, isolate_real_roots, isolate_real_roots_descartes};
use jurist_algebra::poly::{SquareFree, UniPoly};

/// Reads a polynomial from bytes, isolates its roots and checks number, order and enclosures.
///
/// The first byte chooses how the rest is read: coefficients of one byte or of eight, squared and
/// perturbed (nearly double roots), or in the square of the variable.
///
/// # Panics
/// When the isolation is wrong.
pub fn isolation_against_sturm(data: &[u8]) {
    let Some((&kind, data)) = data.split_first() else { return };
    let p = polynomial(kind, data);
    let Some(square_free) = SquareFree::part_of(&p) else {
        assert!(p.coeffs().is_empty());
        return;
    };
    let budget = Budget::unlimited();
    let never = "the budget is unlimited";
    let roots = isolate_real_roots(&square_free, &budget).expect(never);
    let reference = isolate_real_roots_descartes(&square_free, None, None, &budget).expect(never);
    assert_eq!(roots, reference);
    let count = |lo: Bound, hi: Bound| count_roots_sturm(&p, lo, hi, &budget).expect(never);
    assert_eq!(roots.len(), count(Bound::Unbounded, Bound::Unbounded));
    let mut last: Option<Rational> = None;
    for root in &roots {
        let (lo, hi) = root.enclosure();
        assert!(last.is_none_or(|last| last < lo) && lo <= hi);
        assert_eq!(count(Bound::Closed(&lo), Bound::Closed(&hi)), 1);
        assert_eq!(root.exact().is_some(), lo == hi);
        assert!(root.sign_of(&p).is_eq());
        // Refined, the enclosure still holds the root.
        let (lo, hi) = root.refined_to_digits(30).enclosure();
        assert_eq!(count(Bound::Closed(&lo), Bound::Closed(&hi)), 1);
        last = Some(hi);
    }
}

fn polynomial(kind: u8, data: &[u8]) -> UniPoly {
    let p = if kind & 1 == 0 {
        UniPoly::new(data.iter().take(24).map(|&b| Integer::from(i64::from(b as i8))).collect())
    } else {
        let wide = |c: &[u8]| c.iter().fold(0i64, |acc, &b| acc << 8 | i64::from(b));
        UniPoly::new(data.chunks(8).take(12).map(|c| Integer::from(wide(c))).collect())
    };
    match kind >> 1 & 3 {
        0 | 3 => p,
        1 => {
            let shift = u64::from(kind >> 3);
            &(&p * &p).scaled(&(&Integer::ONE << shift)) - &UniPoly::from_i64(&[1])
        }
        _ => {
            let mut power = vec![0; 3 + usize::from(kind >> 3 & 3)];
            *power.last_mut().expect("not empty") = 1;
            p.compose(&UniPoly::from_i64(&power))
        }
    }
}
