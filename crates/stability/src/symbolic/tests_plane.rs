use super::*;
use crate::count_roots;

#[test]
fn the_unit_circle_becomes_the_imaginary_axis() {
    // (z - 1/2)(z + 3): one root inside, one outside; times two.
    let own: Vec<MultiPoly> = [-3i64, 5, 2].map(|c| MultiPoly::constant(c.into())).to_vec();
    let moved: Vec<Integer> = to_half_plane(&own).iter().map(|c| c.as_constant().unwrap()).collect();
    let count = count_roots(&UniPoly::new(moved), Shape::LeftHalfPlane);
    assert_eq!((count.inside, count.on, count.outside), (1, 0, 1));
}
