//! Functions of matrices and numbers against digits from elsewhere (mpmath, 50 digits).

use super::*;
use crate::number::Z;
use num_traits::Zero;
use std::time::Duration;

fn clock() -> Clock {
    Clock::new(Duration::MAX)
}

/// Digits without a point, the last so many of them behind it.
fn decimal(digits: &str, behind: u32) -> Q {
    Q::new(digits.parse().unwrap(), Z::from(10).pow(behind))
}

/// That a number is within the bound, up to 40 decimals, and the bound no more than so many units.
fn is_within(t: &Taylor, exact: &Q, most: u32, p: &Precision) {
    assert!(t.variation() == t.rest && t.rest <= Z::from(most), "{t:?}");
    let off = (Q::from(t.constant()) - exact * Q::from(Z::one() << p.bits)).abs();
    let digits = Q::new(Z::one() << p.bits, Z::from(10).pow(40));
    assert!(off <= Q::from(t.rest.clone()) + digits, "off by {off} units: {t:?}");
}

#[test]
fn the_circle_number_has_its_digits() {
    for bits in [1, 8, 64, 128] {
        let p = Precision::new(2, 1, bits);
        is_within(&pi(&p), &decimal("31415926535897932384626433832795028841971694", 43), 4, &p);
    }
}

/// `exp(x)`, `(exp(x) - 1)/x` and `(exp(x) - 1 - x)/x^2` of a small, a large and a negative number, alone and side by side: it is the
/// larger row that says how often the matrix is halved.
#[test]
fn exponentials_of_numbers_have_their_digits() {
    let p = Precision::new(2, 2, 96);
    let known = [
        (
            Q::new(1.into(), 512.into()),
            [
                decimal("10019550335910028120465188980474772158674", 40),
                decimal("10009771985934397678176758003083345240861", 40),
            ],
        ),
        (
            Q::from(Z::from(8)),
            [
                decimal("29809579870417282747435920994528886737560", 37),
                decimal("3724947483802160343429490124316110842195", 37),
            ],
        ),
        (
            Q::from(Z::from(-3)),
            [
                decimal("497870683678639429793424156500617766317", 40),
                decimal("3167376438773786856735525281166460744561", 40),
            ],
        ),
    ];
    let entry = |x: &Q| Taylor::number(x, &p);
    for (x, [whole, first]) in &known {
        let second = (first - Q::one()) / x;
        let [found, found_first, found_second] = exponential(&vec![vec![entry(x)]], &p, &clock()).unwrap();
        for (found, exact) in [(found, whole), (found_first, first), (found_second, &second)] {
            is_within(&found[0][0], exact, 1 << 30, &p);
        }
    }
    let zero = Taylor::zero;
    for [i, j] in [[0, 1], [1, 0], [1, 2], [2, 0]] {
        let m = vec![vec![entry(&known[i].0), zero()], vec![zero(), entry(&known[j].0)]];
        let [found, found_first, _] = exponential(&m, &p, &clock()).unwrap();
        for (k, which) in [i, j].into_iter().enumerate() {
            let [whole, first] = &known[which].1;
            is_within(&found[k][k], whole, 1 << 30, &p);
            is_within(&found_first[k][k], first, 1 << 30, &p);
        }
    }
}

#[test]
fn sines_cosines_and_roots_have_their_digits() {
    let p = Precision::new(2, 2, 96);
    let two = || Taylor::number(&Q::from(Z::from(2)), &p);
    for (function, exact) in [
        (Function::Sine, decimal("9092974268256816953960198659117448427023", 40)),
        (Function::Cosine, decimal("-4161468365471423869975682295007621897660", 40)),
        (Function::Tangent, decimal("-21850398632615189916433061023136825434320", 40)),
        (Function::Root, decimal("14142135623730950488016887242096980785697", 40)),
        (Function::Exponential, decimal("73890560989306502272304274605750078131803", 40)),
    ] {
        is_within(&function.at(two(), &p, &clock()).unwrap(), &exact, 1 << 20, &p);
    }
}

/// What is left out stays a bound when a negative number divides.
#[test]
fn quotients_by_negative_numbers_keep_their_bound() {
    let p = Precision::new(2, 2, 32);
    let minus_two = Multi::constant(Z::from(-2));
    let x = Multi::variable(super::super::over_box::FIRST);
    let known = Taylor::units(Z::from(3) << 32_usize, Z::from(1000));
    let found = Quotient(x, minus_two).over(&[known], &p, &clock()).unwrap();
    assert!(found.rest >= Z::from(500) && found.rest < Z::from(520), "{found:?}");
    is_within(&found, &Q::new(Z::from(-3), Z::from(2)), 520, &p);
}

#[test]
fn functions_of_the_variable_of_the_loop_are_refused() {
    let clock = clock();
    let (s, a) = (Fraction::variable(0), Fraction::variable(1));
    let reciprocal = Fraction { numerator: Multi::one(), denominator: Multi::variable(0), ..Fraction::variable(0) };
    for wrong in [s.clone(), s.plus(&a, &clock).unwrap(), reciprocal] {
        assert!(Moving::new(9, false).of(Function::Exponential, wrong).is_err());
    }
    assert!(Moving::new(9, false).of(Function::Exponential, a).is_ok());
}

/// Of two integrators in a row everything is a power of the time: with `T = 2`, `F(t) = [1, t; 0, 1]`, `G(t) = [t, t^2/2; 0, t]` and
/// `H(t) = [t^2/4, t^3/12; 0, t^2/4]`.
#[test]
fn holds_of_two_integrators_are_powers_of_the_time() {
    let p = Precision::new(2, 2, 64);
    let (zero, one) = (Taylor::zero, || Taylor::number(&Q::one(), &p));
    let a = vec![vec![zero(), one()], vec![zero(), zero()]];
    let time = Taylor::number(&Q::from(Z::from(2)), &p);
    let all = [
        HeldMatrix::State,
        HeldMatrix::Now,
        HeldMatrix::NowOfRamp,
        HeldMatrix::LateOfRamp,
        HeldMatrix::Early,
        HeldMatrix::EarlyOfRamp,
    ];
    let is = |share: (i64, i64), kinds: &[HeldMatrix], exact: &[[(i64, i64); 2]]| {
        let share = Q::new(share.0.into(), share.1.into());
        let found = held(&a, &time, &share, kinds, &p, &clock()).unwrap();
        for (found, [corner, above]) in found.chunks(4).zip(exact) {
            let of = |(n, d): &(i64, i64)| Q::new((*n).into(), (*d).into());
            for (entry, exact) in found.iter().zip([of(corner), of(above), Q::zero(), of(corner)]) {
                is_within(entry, &exact, 1 << 16, &p);
            }
        }
    };
    // At once: F(2), G(2), G(2) - H(2), H(2).
    is((0, 1), &all[..4], &[[(1, 1), (2, 1)], [(2, 1), (2, 1)], [(1, 1), (4, 3)], [(1, 1), (2, 3)]]);
    // A quarter late: F(2); G(3/2); of the ramp; H(3/2); F(3/2) G(1/2); F(3/2) (G(1/2)/4 - H(1/2)).
    is(
        (1, 4),
        &all,
        &[
            [(1, 1), (2, 1)],
            [(3, 2), (9, 8)],
            [(11, 8), (77, 48)],
            [(9, 16), (9, 32)],
            [(1, 2), (7, 8)],
            [(1, 16), (11, 96)],
        ],
    );
}

/// `w/tan(w T/2)` of an angle below and one above a right angle, and the limit of small ones, `2/T`.
#[test]
fn factors_of_prewarped_rules_have_their_digits() {
    let p = Precision::new(2, 2, 160);
    let number = |q: Q| Taylor::number(&q, &p);
    for (w, time, exact) in [
        (
            Q::from(Z::from(700)),
            Q::new(Z::one(), Z::from(4000)),
            decimal("797957290472191577213338191912092755463263740", 41),
        ),
        (Q::from(Z::from(3)), Q::one(), decimal("2127445329079573463669426788044098672200106", 43)),
        (Q::new(Z::one(), Z::from(8)), Q::from(Z::from(2)), decimal("9947862332333763972342150559357484815249376", 43)),
    ] {
        is_within(&prewarped(&number(w), &number(time), &p, &clock()).unwrap(), &exact, 1 << 30, &p);
    }
    let found = prewarped(&number(Q::new(Z::one(), Z::one() << 40_usize)), &number(Q::one()), &p, &clock()).unwrap();
    assert!(
        (Q::from(found.constant()) / Q::from(Z::one() << 160_usize) - Q::from(Z::from(2))).abs()
            < Q::new(Z::one(), Z::one() << 80_usize)
    );
}

/// A box has a factor only if the frequency, the sample time and the way to half the sampling rate are positive in all of it.
#[test]
fn factors_of_prewarped_rules_are_of_angles_between_zero_and_pi() {
    let p = Precision::new(2, 4, 128);
    let side = |low: (i64, i64), high: (i64, i64), axis: usize| {
        Taylor::coordinate(&[low, high].map(|(n, d)| Q::new(n.into(), d.into())), axis, &p)
    };
    let is_read = |w: [(i64, i64); 2], time: [(i64, i64); 2]| {
        prewarped(&side(w[0], w[1], 0), &side(time[0], time[1], 1), &p, &clock()).is_ok()
    };
    let around_one = [(9, 10), (11, 10)];
    assert!(is_read(around_one, around_one));
    assert!(is_read([(3, 1), (31, 10)], [(99, 100), (101, 100)]), "up to 3.131");
    // Pi in the box, at its corner, and above all of it; a whole turn, where the tangent is that of a small angle.
    for w in [[(31, 10), (32, 10)], [(3, 1), (315, 100)], [(33, 10), (34, 10)], [(7, 1), (71, 10)]] {
        assert!(!is_read(w, [(1, 1), (1001, 1000)]), "{w:?}");
        assert!(!is_read([(1, 1), (1001, 1000)], w), "{w:?}");
    }
    assert!(!is_read([(3, 1), (31, 10)], [(99, 100), (102, 100)]), "the angle passes pi in a corner");
    // Either sign, both negative, zero in the box or on its edge.
    let negative = [(-11, 10), (-9, 10)];
    for wrong in [negative, [(-1, 10), (11, 10)], [(0, 1), (1, 1)], [(-1, 1), (0, 1)]] {
        assert!(!is_read(wrong, around_one) && !is_read(around_one, wrong) && !is_read(wrong, negative), "{wrong:?}");
    }
}
