//! Units so coarse that roundings are most of what is left out, against exact arithmetic.

use super::*;
use std::time::Duration;

fn clock() -> Clock {
    Clock::new(Duration::MAX)
}

fn q(n: i64, d: i64) -> Q {
    Q::new(n.into(), d.into())
}

/// What a function without coordinates may be: from one number to another.
fn ends(t: &Taylor, p: &Precision) -> [Q; 2] {
    assert!(t.c.iter().skip(1).all(Z::is_zero) && !t.rest.is_negative(), "{t:?}");
    let of = |units: Z| Q::new(units, p.one_unit());
    [of(t.constant() - &t.rest), of(t.constant() + &t.rest)]
}

fn holds([low, high]: &[Q; 2], x: &Q) -> bool {
    low <= x && x <= high
}

/// Numbers from -6 to 6 units, off by up to 3.
fn numbers() -> Vec<Taylor> {
    (-6..=6).flat_map(|c| (0..=3).map(move |rest| Taylor::units(Z::from(c), Z::from(rest)))).collect()
}

#[test]
fn what_is_made_of_numbers_holds_all_that_they_may_be() {
    for bits in [1, 3] {
        let (p, clock) = (Precision::new(2, 2, bits), clock());
        for a in numbers() {
            let own = ends(&a, &p);
            for k in 1..=7 {
                let k_z = Z::from(k);
                let made = [a.over(&k_z), a.halved(k as usize), a.scaled(&k_z), a.scaled(&-&k_z)].map(|t| ends(&t, &p));
                let by = [q(1, k), Q::new(Z::one(), Z::one() << k as usize), q(k, 1), q(-k, 1)];
                for (made, by) in made.iter().zip(by) {
                    assert!(own.iter().all(|x| holds(made, &(x * &by))), "{a:?} {by}");
                }
            }
            if let Some(is_positive) = a.sign() {
                assert!(own.iter().all(|x| x.is_positive() == is_positive && !x.is_zero()), "{a:?}");
            }
            if let Ok(inverse) = a.inverse(&p, &clock) {
                assert!(
                    own.iter().all(|x| !x.is_zero() && holds(&ends(&inverse, &p), &x.recip())),
                    "{a:?} {inverse:?}"
                );
            }
            if let Ok(root) = a.root(&p, &clock) {
                let [low, high] = ends(&root, &p);
                // The root's ends, squared, are on both sides.
                let is_root =
                    |x: &Q| x.is_positive() && &(&high * &high) >= x && (low.is_negative() || &(&low * &low) <= x);
                assert!(high.is_positive() && own.iter().all(is_root), "{a:?} {root:?}");
            }
            for b in numbers() {
                let (sum, difference, product) = (a.plus(&b), a.minus(&b), a.times(&b, &p, &clock).unwrap());
                let mut added = a.clone();
                added.add_scaled(&b, &Z::from(-3));
                let [sum, difference, product, added] = [sum, difference, product, added].map(|t| ends(&t, &p));
                for x in &own {
                    for y in ends(&b, &p) {
                        assert!(holds(&sum, &(x + &y)) && holds(&difference, &(x - &y)), "{a:?} {b:?}");
                        assert!(holds(&product, &(x * &y)), "{a:?} {b:?}");
                        assert!(holds(&added, &(x - &y * q(3, 1))), "{a:?} {b:?}");
                    }
                }
            }
        }
    }
}

/// That no rational point of the box is farther from the function than the bound.
fn encloses(t: &Taylor, p: &Precision, exact: impl Fn(&Q, &Q) -> Q) {
    let places = [q(-1, 1), q(-2, 5), q(0, 1), q(1, 3), q(1, 1)];
    for u in &places {
        for v in &places {
            let power = |x: &Q, n: &usize| (0..*n).fold(q(1, 1), |power, _| power * x);
            let found = t.c.iter().enumerate().fold(q(0, 1), |sum, (place, c)| {
                let [i, j] = [0, 1].map(|axis| p.monomials.exponent(place, axis));
                sum + Q::from(c.clone()) * power(u, &i) * power(v, &j)
            });
            let off = found - exact(u, v) * Q::from(p.one_unit());
            assert!(off.abs() <= Q::from(t.rest.clone()), "({u}, {v}): off by {off} units in {t:?}");
        }
    }
}

#[test]
fn functions_of_coordinates_are_enclosed_with_few_bits() {
    let clock = clock();
    for (order, bits) in [(1, 4), (2, 5), (3, 7)] {
        let p = Precision::new(2, order, bits);
        for k in 0..12_i64 {
            // Ends that are no multiples of a unit.
            let (x_ends, y_ends) = ([q(7 + k, 5), q(22 + 5 * k, 13)], [q(-k, 7), q(5 - k, 11)]);
            let at = |[low, high]: &[Q; 2], w: &Q| (low + high + (high - low) * w) / q(2, 1);
            let (x_at, y_at) = (|u: &Q| at(&x_ends, u), |v: &Q| at(&y_ends, v));
            let (x, y) = (Taylor::coordinate(&x_ends, 0, &p), Taylor::coordinate(&y_ends, 1, &p));
            encloses(&x, &p, |u, _| x_at(u));
            encloses(&Taylor::number(&q(k, 9), &p), &p, |_, _| q(k, 9));
            let product = x.times(&y, &p, &clock).unwrap();
            encloses(&product, &p, |u, v| x_at(u) * y_at(v));
            let square = product.times(&product, &p, &clock).unwrap();
            encloses(&square, &p, |u, v| (x_at(u) * y_at(v)).pow(2));
            let third = product.over(&Z::from(3)).minus(&x.halved(2));
            encloses(&third, &p, |u, v| x_at(u) * y_at(v) / q(3, 1) - x_at(u) / q(4, 1));
            if let Ok(inverse) = x.plus(&y.halved(3)).inverse(&p, &clock) {
                encloses(&inverse, &p, |u, v| (x_at(u) + y_at(v) / q(8, 1)).recip());
            }
            for axis in [0, 1] {
                for (half, shift) in square.halves(axis, &p).iter().zip([-1, 1]) {
                    let inner = |w: &Q, k: usize| if k == axis { (w + q(shift, 1)) / q(2, 1) } else { w.clone() };
                    encloses(half, &p, |u, v| (x_at(&inner(u, 0)) * y_at(&inner(v, 1))).pow(2));
                }
            }
        }
    }
}

/// Of a square the root is known exactly: `(x + y)^2` has `x + y`.
#[test]
fn roots_of_squares_are_enclosed_with_few_bits() {
    let clock = clock();
    // In narrow boxes with many bits it is the last term of the series that counts.
    for (order, bits, narrow) in [(1, 6, 1), (2, 8, 1), (4, 12, 1), (1, 40, 10), (2, 40, 10), (4, 60, 99)] {
        let p = Precision::new(2, order, bits);
        for k in 1..10_i64 {
            let (x_ends, y_ends) =
                ([q(9, 7), q(9 * narrow + k, 7 * narrow)], [q(3, 10), q(3 * narrow + k, 10 * narrow)]);
            let sum = Taylor::coordinate(&x_ends, 0, &p).plus(&Taylor::coordinate(&y_ends, 1, &p));
            if let Ok(root) = sum.times(&sum, &p, &clock).unwrap().root(&p, &clock) {
                let at = |[low, high]: &[Q; 2], w: &Q| (low + high + (high - low) * w) / q(2, 1);
                encloses(&root, &p, |u, v| at(&x_ends, u) + at(&y_ends, v));
            }
        }
    }
}

/// Integers alone, whose halves are none.
#[test]
#[ignore = "long: CI runs it"]
fn halves_of_polynomials_without_error_are_enclosed() {
    for order in 1..=4 {
        let p = Precision::new(2, order, 8);
        for seed in 1..20_i64 {
            let c: Vec<Z> = (0..p.terms() as i64).map(|k| Z::from((seed * (7 * k + 3) + k * k) % 17 - 8)).collect();
            let f = Taylor { c, rest: Z::zero() };
            let at = |u: &Q, v: &Q| {
                let power = |x: &Q, n: &usize| (0..*n).fold(q(1, 1), |power, _| power * x);
                f.c.iter().enumerate().fold(q(0, 1), |sum, (place, c)| {
                    let [i, j] = [0, 1].map(|axis| p.monomials.exponent(place, axis));
                    sum + Q::new(c.clone(), p.one_unit()) * power(u, &i) * power(v, &j)
                })
            };
            for axis in [0, 1] {
                for (half, shift) in f.halves(axis, &p).iter().zip([-1, 1]) {
                    let inner = |w: &Q, k: usize| if k == axis { (w + q(shift, 1)) / q(2, 1) } else { w.clone() };
                    encloses(half, &p, |u, v| at(&inner(u, 0), &inner(v, 1)));
                }
            }
        }
    }
}

/// The same with any number of coordinates: products, quotients and halves of sums of all of them.
#[test]
#[ignore = "long: CI runs it"]
fn functions_of_many_coordinates_are_enclosed_with_few_bits() {
    let clock = clock();
    let places = [q(-1, 1), q(-2, 5), q(1, 3), q(1, 1)];
    for (names, order, bits) in [(0, 2, 5), (1, 3, 6), (3, 2, 6), (4, 3, 7), (6, 1, 5), (8, 2, 9)] {
        let p = Precision::new(names, order, bits);
        let sides: Vec<[Q; 2]> = (0..names as i64).map(|k| [q(1 + k, 5), q(9 + 2 * k, 13 - k)]).collect();
        let all: Vec<Taylor> = sides.iter().enumerate().map(|(k, side)| Taylor::coordinate(side, k, &p)).collect();
        // What is made of the coordinates, and the same of numbers.
        let one = Taylor::number(&q(1, 1), &p);
        let sum = all.iter().enumerate().fold(one.clone(), |sum, (k, x)| sum.plus(&x.scaled(&Z::from(k + 1))));
        let product = all.iter().fold(one, |product, x| product.times(x, &p, &clock).unwrap());
        let made = sum.times(&product, &p, &clock).unwrap().minus(&sum.halved(2));
        let inverse = sum.inverse(&p, &clock);
        let exact = |x: &[Q]| {
            let sum = x.iter().zip(1..).fold(q(1, 1), |sum, (x, k)| sum + x * q(k, 1));
            let product = x.iter().fold(q(1, 1), |product, x| product * x);
            (&sum * product - &sum / q(4, 1), sum.recip())
        };
        let value = |t: &Taylor, at: &[Q]| {
            t.c.iter().enumerate().fold(q(0, 1), |total, (place, c)| {
                let powers = at.iter().enumerate().map(|(v, x)| x.pow(p.monomials.exponent(place, v) as i32));
                total + powers.fold(Q::from(c.clone()), |all, own| all * own)
            })
        };
        let is_near = |t: &Taylor, at: &[Q], exact: &Q| {
            let off = value(t, at) - exact * Q::from(p.one_unit());
            assert!(off.abs() <= Q::from(t.rest.clone()), "{names} {order}: off by {off} in {t:?}");
        };
        for k in 0..40_usize {
            let at: Vec<Q> = (0..names).map(|v| places[(k * (v + 3) + k / (v + 2) + v) % 4].clone()).collect();
            let point = |at: &[Q]| -> Vec<Q> {
                sides.iter().zip(at).map(|([low, high], w)| (low + high + (high - low) * w) / q(2, 1)).collect()
            };
            let (wanted, wanted_inverse) = exact(&point(&at));
            is_near(&made, &at, &wanted);
            if let Ok(inverse) = &inverse {
                is_near(inverse, &at, &wanted_inverse);
            }
            for axis in 0..names {
                for (half, shift) in made.halves(axis, &p).iter().zip([-1, 1]) {
                    let mut inner = at.clone();
                    inner[axis] = (&at[axis] + q(shift, 1)) / q(2, 1);
                    is_near(half, &at, &exact(&point(&inner)).0);
                }
            }
        }
    }
}
