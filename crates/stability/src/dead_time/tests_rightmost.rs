//! The rightmost roots of loops whose roots are known.

use super::*;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::poly::{RootDisc, UniPoly};

fn quasi(parts: &[&[i64]]) -> QuasiPolynomial {
    QuasiPolynomial::new(parts.iter().map(|p| UniPoly::from_i64(p)).collect()).unwrap()
}

fn found(p: &QuasiPolynomial, tau: &str, wanted: usize) -> RightmostRoots {
    let small = parse_number("1e-35").unwrap();
    let started = std::time::Instant::now();
    let out = rightmost_roots(p, &parse_number(tau).unwrap(), wanted, &small, &Budget::unlimited()).unwrap().unwrap();
    eprintln!(
        "{:?} {} roots left of {} {:?}",
        started.elapsed(),
        out.list.len(),
        out.others_left_of,
        out.chain.as_ref().map(|c| c.lower().to_f64_approximate())
    );
    for d in &out.list {
        eprintln!(
            "  {} {} x{} r{}",
            d.re.to_f64_approximate(),
            d.im.to_f64_approximate(),
            d.count,
            d.radius.to_f64_approximate()
        );
    }
    out
}

#[test]
fn trial() {
    found(&quasi(&[&[0, 1], &[1]]), "1", 10);
    found(&quasi(&[&[0, 1], &[1]]), "1/1000", 10);
    found(&quasi(&[&[0, 1], &[1]]), "1", 100);
    found(&quasi(&[&[-1, 1], &[1]]), "1", 5);
    found(&quasi(&[&[5, 0, 5], &[-1]]), "3", 10);
    found(&quasi(&[&[1, 2, 3, 1], &[1], &[], &[2, 1]]), "1/2", 10);
    found(&quasi(&[&[0, 0, 1], &[0, 2], &[1]]), "1", 4);
    found(&quasi(&[&[1, 2], &[1, 1]]), "1", 4);
    found(&quasi(&[&[1, 2], &[-1, 1]]), "1", 4);
    found(&quasi(&[&[2, 3, 1], &[1]]), "1/1000000", 10);
}
