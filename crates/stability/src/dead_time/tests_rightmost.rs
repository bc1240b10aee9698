//! The rightmost roots of loops whose roots are known.

use super::*;
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::poly::{Domain, RootDisc, UniPoly, complex_roots};

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn quasi(parts: &[&[i64]]) -> QuasiPolynomial {
    QuasiPolynomial::new(parts.iter().map(|p| UniPoly::from_i64(p)).collect()).unwrap()
}

fn found(p: &QuasiPolynomial, tau: &str, wanted: usize) -> RightmostRoots {
    rightmost_roots(p, &number(tau), wanted, &number("1e-35"), &Budget::unlimited()).unwrap().unwrap()
}

/// Whether a disc holds a number whose decimals are cut or rounded after 28 digits or more.
fn holds(disc: &RootDisc, re: &str, im: &str) -> bool {
    let near = |a: &Rational, b: &str| (a - &number(b)).abs() <= &disc.radius + &number("1e-26");
    near(&disc.re, re) && near(&disc.im, im)
}

/// Expected roots, from the right.
fn are(found: &RightmostRoots, expected: &[(&str, &str)]) {
    assert_eq!(found.list.len(), expected.len(), "{found:?}");
    for (disc, (re, im)) in found.list.iter().zip(expected) {
        assert!(holds(disc, re, im), "{re} {im}: {disc:?}");
        assert_eq!((disc.is_one, disc.is_pair), (true, *im != "0"));
        assert!(&disc.re - &disc.radius > found.others_left_of);
    }
}

/// The parts of a function, the dead time, and real and imaginary parts of roots.
type Case = (&'static [&'static [i64]], &'static str, &'static [(&'static str, &'static str)]);

/// The roots of `s + a + b exp(-tau s)` are `W_k(-b tau exp(a tau))/tau - a` (Corless and others, On the Lambert W function, 1996); the digits are
/// those of mpmath's `lambertw` with 45 digits.
#[test]
fn loops_of_first_order_have_the_branches_of_lamberts_function() {
    let cases: [Case; 4] = [
        (
            &[&[0, 1], &[1]],
            "1",
            &[
                ("-0.318131505204764135312654251588", "1.33723570143068940890116214319"),
                ("-2.06227772959828388497848672001", "7.58863117847251262256892395411"),
                ("-2.65319197403869728660110664332", "13.949208334533214455288918039"),
                ("-3.02023970816450115137724368794", "20.2724576416152218103488559055"),
            ],
        ),
        // a = 1/2, b = 2
        (
            &[&[1, 2], &[4]],
            "3/10",
            &[
                ("-2.39240694186268560023413440735", "3.6365971734711279209574171901"),
                ("-8.60250258413885067174225458402", "25.1406866839149783511004793312"),
                ("-10.5578951526266701246419414272", "46.4125343605432033524302756732"),
                ("-11.7765909372847936431327199621", "67.5161976459376592306148774465"),
            ],
        ),
        // a = 2, b = 1/50: the branches 0 and -1 are real.
        (
            &[&[100, 50], &[1]],
            "1",
            &[
                ("-2.17626686788797904502895005003", "0"),
                ("-5.01593186371085467878197060271", "0"),
                ("-6.038823694993404434265991251", "7.35161525474983045932158031005"),
            ],
        ),
        // a = -1, b = -3
        (
            &[&[-1, 1], &[-3]],
            "2",
            &[
                ("1.24749287896235212754790010238", "0"),
                ("0.12547225525096607657595307236", "2.1641800184124828336449494311"),
                ("-0.306240291357925483268468402539", "5.37866538051686561004905319553"),
            ],
        ),
    ];
    for (parts, tau, expected) in cases {
        are(&found(&quasi(parts), tau, expected.len()), expected);
    }
}

#[test]
fn a_zero_is_exact_and_has_its_exact_order() {
    // s - 1 + exp(-s) has a double zero at 0, s (s + 1 - exp(-s)) too: 1 - exp(-s) - s is -s^2/2 there, and s + 1 - exp(-s) is 2 s.
    for (parts, order) in [
        (&[&[-1i64, 1][..], &[1]][..], 2),
        (&[&[0, 1, 1], &[0, -1]], 2),
        (&[&[0, 0, 0, 1], &[0, 0, 2]], 2),
        (&[&[1, 1], &[-1]], 1),
    ] {
        let found = found(&quasi(parts), "1", 3);
        let zero = found.list.iter().find(|disc| disc.re.is_zero()).unwrap();
        assert_eq!((zero.count, zero.radius.is_zero(), zero.is_one), (order, true, true), "{parts:?}");
        assert_eq!(found.list.iter().filter(|disc| disc.re.abs() <= disc.radius).count(), 1);
    }
}

#[test]
fn multiplicities_are_those_of_factors() {
    // (s + z)^2 (s + 1)^3 (s + 2 z)
    let c = |c: &[i64]| UniPoly::from_i64(c);
    let mut parts = vec![c(&[1, 1]).power(3)];
    for factor in [[c(&[0, 1]), c(&[1])], [c(&[0, 1]), c(&[1])], [c(&[0, 1]), c(&[2])]] {
        let mut next = vec![UniPoly::zero(); parts.len() + 1];
        for (i, part) in parts.iter().enumerate() {
            for (j, other) in factor.iter().enumerate() {
                next[i + j] = next[i + j].plus(&part.times(other));
            }
        }
        parts = next;
    }
    let p = QuasiPolynomial::new(parts).unwrap();
    let found = found(&p, "1", 4);
    let counts: Vec<(usize, bool)> = found.list.iter().map(|disc| (disc.count, disc.is_pair)).collect();
    assert_eq!(counts, [(1, true), (2, true), (3, false), (1, true)]);
    assert!(holds(&found.list[1], "-0.318131505204764135312654251588", "1.33723570143068940890116214319"));
    assert_eq!((found.list[2].re.clone(), found.list[2].radius.is_zero()), (Rational::from(-1), true));
}

#[test]
fn two_real_roots_that_nearly_meet_are_told_apart() {
    // s + b exp(-s) has a double root at -1 for b = 1/e = 0.367879441171442...
    for (numerator, reals) in [(367_879_441_171i64, 2), (367_879_441_172, 0)] {
        let found = found(&quasi(&[&[0, 1_000_000_000_000], &[numerator]]), "1", 2);
        assert_eq!(found.list.iter().filter(|disc| !disc.is_pair).count(), reals, "{found:?}");
    }
}

#[test]
fn a_short_dead_time_moves_the_roots_of_the_polynomial_by_little() {
    // s^3 + 4 s^2 + 5 s + 3 with the last two coefficients delayed
    let p = quasi(&[&[0, 0, 4, 1], &[3, 5]]);
    let roots = complex_roots(&p.without_delay(), &number("1e-12"), &Budget::unlimited()).unwrap();
    for tau in ["1e-6", "1e-9"] {
        let found = found(&p, tau, 4);
        for root in &roots {
            let near = |a: &Rational, b: &Rational| (a - b).abs() < number(tau) * Rational::from(100);
            assert!(found.list.iter().any(|disc| near(&disc.re, &root.re) && near(&disc.im, &root.im)), "{tau}");
        }
        // The others are beyond 1/tau.
        assert!(found.list[2..].iter().all(|disc| disc.re < -number(tau).recip().unwrap()), "{tau}");
    }
}

#[test]
fn neutral_loops_are_listed_to_the_line_of_the_chain() {
    // 2 s + (s + 3) z: roots approach Re s = -ln 2
    let budget = Budget::unlimited();
    let p = quasi(&[&[0, 2], &[3, 1]]);
    let some = found(&p, "1", 100);
    let chain = some.chain.as_ref().unwrap();
    assert!(*chain.lower() <= number("-0.6931471805599453") && *chain.upper() >= number("-0.6931471805599454"));
    assert!((1..100).contains(&some.list.len()));
    assert!(some.others_left_of > *chain.upper() && some.others_left_of < number("-0.68"));
    let right = count_delayed_roots(&p, &Rational::ONE, &budget).unwrap().right.unwrap();
    let listed = some.list.iter().filter(|disc| disc.re.sign().is_gt()).map(|disc| 1 + usize::from(disc.is_pair));
    assert_eq!(right, listed.sum::<usize>());
    // No root is right of the chain of 2 s + 1 + (s + 1) z.
    let none = found(&quasi(&[&[1, 2], &[1, 1]]), "1", 3);
    assert!(none.list.is_empty() && none.others_left_of < number("-0.6"));
    // All roots of (z + 3) (s + 2) but -2 are on the line of the chain.
    let on_it = found(&quasi(&[&[6, 3], &[2, 1]]), "1", 3);
    assert!(on_it.list.is_empty() && on_it.others_left_of < number("-1"), "{on_it:?}");
    // Infinitely many roots lie right of any line.
    let advanced = rightmost_roots(&quasi(&[&[1], &[0, 1]]), &Rational::ONE, 3, &number("1e-9"), &budget).unwrap();
    assert_eq!(advanced, None);
}

#[test]
fn long_dead_times_and_high_orders_are_searched_as_others() {
    // s + exp(-10^6 s), and (s + 1)^20 + exp(-s), whose expanded powers cancel to ten digits
    let long = found(&quasi(&[&[0, 1], &[1]]), "1000000", 3);
    assert!(long.list.iter().all(|disc| disc.is_pair && disc.re > number("1e-5") && disc.re < number("2e-5")));
    let power = UniPoly::from_i64(&[1, 1]).power(20);
    let high = found(&QuasiPolynomial::new(vec![power, UniPoly::one()]).unwrap(), "1", 10);
    assert!(high.list.len() == 10 && high.list.iter().all(|disc| disc.re > number("-2.1")));
}

#[test]
fn a_budget_ends_the_search() {
    let p = quasi(&[&[1, 3, 1], &[2, 1]]);
    for work in [0, 1000, 30_000, 100_000] {
        let budget = Budget::unlimited().within_work(work);
        match rightmost_roots(&p, &Rational::ONE, 20, &number("1e-20"), &budget) {
            Err(NotCounted::Stopped(stopped)) => assert!(matches!(stopped.stop, Stop::Work(_)), "{stopped:?}"),
            other => panic!("{work}: {other:?}"),
        }
    }
}
