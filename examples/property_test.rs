//! Property tests with the generators of the feature `strategies`: polynomials whose roots are known by construction, against
//! a stability test of one's own (here: eigenvalues in floating point).
//!
//! `cargo run --example property_test --features strategies`

use jurist::{Shape, count_roots, is_schur_jury, is_stable, strategies};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

fn main() {
    let mut runner = TestRunner::deterministic();
    let known = strategies::stability::polynomial_with_chosen_roots(5);
    let (mut stable, tried) = (0, 200);
    for _ in 0..tried {
        let (polynomial, factors) = known.new_tree(&mut runner).expect("a case").current();
        let expected = strategies::stability::expected_count(&factors, Shape::UnitDisc);
        assert_eq!(count_roots(&polynomial, Shape::UnitDisc), expected);
        // Here stands the test of your own; this one goes another way than the count.
        let inside = is_stable(&polynomial, Shape::UnitDisc);
        assert_eq!(inside, expected.on + expected.outside == 0);
        assert_eq!(inside, is_schur_jury(&polynomial));
        stable += usize::from(inside);
    }
    println!("{tried} polynomials with known roots, {stable} of them stable: all decided right");
}
