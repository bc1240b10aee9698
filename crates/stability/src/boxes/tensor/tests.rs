//! Bernstein coefficients, against values and fresh expansions.

use super::*;
use jurist_algebra::number::parse_number;
use jurist_algebra::poly::{Domain, MultiPoly};

fn q(text: &str) -> Rational {
    parse_number(text).unwrap()
}

/// `2 x^2 y - 3 x + 5 y + 7`
fn example() -> MultiPoly {
    let (x, y) = (MultiPoly::variable(0), MultiPoly::variable(1));
    let n = |n: i64| MultiPoly::constant(Integer::from(n));
    x.times(&x).times(&y).times(&n(2)).minus(&x.times(&n(3))).plus(&y.times(&n(5))).plus(&n(7))
}

#[test]
fn coefficients_at_corners_are_values_and_halves_are_those_of_the_halves() {
    let f = example();
    let bundle = Bundle::new(&[&f], 2);
    let sides = [[q("-1/3"), q("5/2")], [q("1/7"), q("3")]];
    let all = expand(&bundle, &sides);
    let corner = |x: usize, y: usize| f.eval(&[sides[0][x].clone(), sides[1][y].clone()]);
    // Indices: 3 along x, 2 along y.
    let ratio = corner(1, 1).checked_div(&Rational::from(all[5].clone())).unwrap();
    for (at, value) in [(0, corner(0, 0)), (1, corner(0, 1)), (4, corner(1, 0))] {
        assert_eq!(&Rational::from(all[at].clone()) * &ratio, value);
    }
    let middle = sides[0][0].midpoint(&sides[0][1]);
    let [low, _] = Tensor::of_one(&bundle, &sides).halves(0);
    let fresh = expand(&bundle, &[[sides[0][0].clone(), middle], sides[1].clone()]);
    for i in 0..6 {
        let (left, right) = (Integer::from(low.planes[0][i]) * &fresh[5], &fresh[i] * &Integer::from(low.planes[0][5]));
        assert!((&left - &right).abs() <= fresh[5].abs() * Integer::from(64));
    }
}

/// A monomial that several coefficients of a pair have is one term of the bundle, and each plane is that of its polynomial alone.
#[test]
fn monomials_in_common_are_one_term_of_the_pair() {
    let (x, y) = (MultiPoly::variable(0), MultiPoly::variable(1));
    let n = |n: i64| MultiPoly::constant(Integer::from(n));
    // x y and 1 in all four, x^2 in the last: E_0, E_1, O_0, O_1.
    let xy = x.times(&y);
    let polynomials =
        [xy.plus(&n(3)), xy.times(&n(-2)).plus(&n(5)), xy.times(&n(7)).minus(&n(4)), xy.plus(&x.times(&x)).plus(&n(1))];
    let pair = Bundle::new(&polynomials.iter().collect::<Vec<_>>(), 2);
    assert_eq!(pair.terms.len(), 3);
    assert_eq!(pair.degrees, [2, 1]);
    let sides = [[q("-1/2"), q("3")], [q("1/5"), q("2")]];
    let all = expand(&pair, &sides);
    let (tensor, weight) = Tensor::of_pair(&pair, &sides, FrequencyScale(0));
    for (k, p) in polynomials.iter().enumerate() {
        let alone = Bundle { degrees: pair.degrees.clone(), ..Bundle::new(&[p], 2) };
        let own = expand(&alone, &sides);
        let together: Vec<&Integer> = all.iter().skip(k).step_by(4).collect();
        assert!(together.into_iter().eq(&own), "{k}");
        // The planes are the same numbers in fixed point, frequency last: up to one factor for each plane.
        let plane = &tensor.planes[k / 2];
        let fixed = |i: usize| Integer::from(plane[2 * i + k % 2]);
        for i in 0..own.len() {
            let (left, right) = (&fixed(i) * &own[0], &fixed(0) * &own[i]);
            assert!((&left - &right).abs() <= (own[0].abs() + own[i].abs()) * Integer::from(2), "{k} {i}");
        }
    }
    assert!(weight.abs() < 8);
}
/// Coefficients of `example() + t` with a bound that holds `t` are within it of those of `example()`, also in halves.
#[test]
fn what_coefficients_are_off_by_is_kept_in_halves() {
    let f = example();
    let zero = MultiPoly::zero();
    let sides = [[q("-1/3"), q("5/2")], [q("1/7"), q("3")]];
    let exact = Bundle::new(&[&f, &zero, &zero, &f], 2);
    let slack = [3, 0, 0, 5].map(|n: i64| Integer::from(n));
    let (tensor, _) = Tensor::of_pair_within(&exact, &slack, &sides, FrequencyScale(2));
    let (off, _) = Tensor::of_pair(
        &Bundle::new(
            &[&f.plus(&MultiPoly::constant(3.into())), &zero, &zero, &f.minus(&MultiPoly::constant(5.into()))],
            2,
        ),
        &sides,
        FrequencyScale(2),
    );
    assert_eq!(tensor.slack.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    // The planes of both have their own powers of two: they differ by less than a factor of two here.
    let scale = |a: &Tensor, plane: usize| a.planes[plane].iter().map(|v| v.unsigned_abs()).max().unwrap();
    for plane in 0..2 {
        let (a, b) = (scale(&tensor, plane), scale(&off, plane));
        assert!(a < 2 * b && b < 2 * a);
    }
    let mut pairs = vec![(tensor, off)];
    for axis in [2, 0, 2, 1] {
        pairs = pairs.into_iter().flat_map(|(a, b)| a.halves(axis).into_iter().zip(b.halves(axis))).collect();
        for (a, b) in &pairs {
            let error = a.error + b.error;
            for plane in 0..2 {
                for (i, (x, y)) in a.planes[plane].iter().zip(&b.planes[plane]).enumerate() {
                    assert!((x - y).abs() <= a.slack[plane][i % 2] + error, "axis {axis}, plane {plane}");
                }
            }
        }
    }
    // Twice as far along the frequency the bound of the first coefficient counts half.
    assert!(pairs.iter().any(|(a, _)| a.slack[0][0] > a.slack[0][1] && a.slack[0][1] > 0));
    let nothing_known = fixed_bounds([Integer::ONE << 90u64, Integer::ZERO].into_iter(), 0);
    assert_eq!(nothing_known, [1 << BITS, 1 << BITS]);
}
