//! Random loops with complex coefficients: their sets against the criterion of Schur and Cohn on both sides of every end, against the same
//! loops in real form, and with the imaginary unit negated.

use super::oracle::Loop;
use crate::helpers::model::{load, read};
use crate::helpers::number::ratio;
use crate::helpers::random::Random;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::answer::Answer;
use jurist_engine::stability::{Cause, End, StableSet};

fn set(text: &str) -> Answer<StableSet> {
    read(text).ask().free("K").stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn ends(set: &StableSet) -> impl Iterator<Item = &End> {
    set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten()
}

/// The signed angle or angular frequency at an end, rounded.
fn place(answer: &Answer<StableSet>, end: &End) -> Option<f64> {
    let frequency = answer.problem().frequency(end, 60)?;
    let found = frequency.angle.or(frequency.radians_per_second)?;
    Some(found.lower().to_f64_approximate())
}

/// `|D|` at the angle or frequency, relative to the size of its terms.
fn residue(of: &Loop, k: f64, place: f64) -> f64 {
    let (x, y) = if of.is_discrete { (place.cos(), place.sin()) } else { (0.0, place) };
    let (mut re, mut im, mut size) = (1.0, 0.0, 1.0);
    for (a, b) in of.a.iter().zip(&of.b).rev() {
        let value = |part: usize| (a[part] as f64 + b[part] as f64 * k) / of.below as f64;
        (re, im) = (re * x - im * y + value(0), re * y + im * x + value(1));
        size = size * x.hypot(y) + value(0).hypot(value(1));
    }
    re.hypot(im) / size
}

fn check(of: &Loop) -> (usize, usize) {
    let answer = set(&of.text(1));
    let found = answer.value();
    assert!(found.undecided().is_empty(), "{of:?}: {:?}", found.undecided());
    let near = Rational::dyadic(&Integer::ONE, 40);
    let (mut limits, mut lower) = (0, 0);
    for end in ends(found) {
        let (lo, hi) = end.value.refined(&near).enclosure();
        for k in [&lo - &near, &hi + &near] {
            let inside = k > (-4).into() && k < 4.into();
            assert!(!inside || found.contains(&k) == of.is_stable_at(&k), "{of:?} at {k}");
        }
        if end.causes.contains(Cause::ComplexRoot) || end.causes.contains(Cause::ComplexPair) {
            limits += 1;
            let place = place(&answer, end).unwrap_or_else(|| panic!("{of:?} at {lo}: no side"));
            lower += usize::from(place < 0.0);
            let k = lo.to_f64_approximate();
            assert!(residue(of, k, place) < 1e-7, "{of:?} at {k}: {place}");
            if end.causes.contains(Cause::ComplexPair) {
                assert!(residue(of, k, -place) < 1e-7, "{of:?} at {k}: no pair at {place}");
            }
        }
    }
    for k in -31..=31 {
        let k = &ratio(k, 8) + &ratio(1, 1009);
        assert_eq!(found.contains(&k), of.is_stable_at(&k), "{of:?} at {k}");
    }
    (limits, lower)
}

#[test]
fn sets_agree_with_schur_and_cohn_on_both_sides_of_every_end() {
    let mut random = Random::new(20_020_326);
    let mut sums = [0; 3];
    for case in 0..320 {
        let of = Loop::random(&mut random, case % 2 == 0);
        let (limits, lower) = check(&of);
        for (sum, more) in sums.iter_mut().zip([limits, lower, usize::from(limits > 0)]) {
            *sum += more;
        }
    }
    let [limits, lower, loops] = sums;
    assert!(limits > 150 && loops > 100, "{limits} ends in {loops} loops");
    assert!(lower > 50 && lower < limits - 50, "{lower} of {limits} below the real axis");
}

#[test]
fn sets_are_those_of_the_real_form_and_of_the_mirror_image() {
    let mut random = Random::new(1944);
    for case in 0..160 {
        let of = Loop::random(&mut random, case % 2 == 0);
        let (own, real, mirrored) = (set(&of.text(1)), set(&of.real_text()), set(&of.text(-1)));
        let values = |answer: &Answer<StableSet>| ends(answer.value()).map(|e| e.value.clone()).collect::<Vec<_>>();
        for other in [&real, &mirrored] {
            let (a, b) = (values(&own), values(other));
            assert!(a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.is_same(b)), "{of:?}: {a:?} {b:?}");
        }
        for (a, b) in ends(own.value()).zip(ends(mirrored.value())) {
            assert_eq!(a.causes, b.causes, "{of:?}");
            if let (Some(x), Some(y)) = (place(&own, a), place(&mirrored, b)) {
                let expected = if a.causes.contains(Cause::ComplexRoot) { -y } else { y };
                assert!((x - expected).abs() < 1e-9, "{of:?}: {x} {y}");
            }
        }
    }
}

/// The roots at a point are as many as the order, each in a disc, and a count by place agrees with them.
#[test]
fn roots_and_verdicts_agree() {
    let mut random = Random::new(1922);
    for case in 0..60 {
        let of = Loop::random(&mut random, case % 2 == 0);
        let model = load(&of.text(1));
        let problem = model.ask().set("K", ratio(1, 3)).problem().unwrap();
        let (budget, order) = (Budget::unlimited(), of.a.len());
        let verdict = problem.verdict(&budget).unwrap().into_value();
        let roots = problem.roots(12, &budget).unwrap().into_value();
        let count = |disc: &jurist_algebra::poly::RootDisc| disc.count * (1 + usize::from(disc.is_pair));
        assert_eq!((verdict.degree, roots.degree), (order, order), "{of:?}");
        assert_eq!(roots.list.iter().map(|root| count(&root.disc)).sum::<usize>(), order, "{of:?}");
        let is_inside = |root: &&jurist_engine::answer::ClosedLoopRoot| match of.is_discrete {
            true => root.magnitude(60).upper() < &Rational::ONE,
            false => root.disc.re.is_negative(),
        };
        let inside: usize = roots.list.iter().filter(is_inside).map(|root| count(&root.disc)).sum();
        assert_eq!(verdict.count.map(|c| c.inside), Some(inside), "{of:?}");
        for root in &roots.list {
            let (x, y) = (root.disc.re.to_f64_approximate(), root.disc.im.to_f64_approximate());
            let (mut re, mut im) = (0.0, 0.0);
            for [a, b] in of.at(&ratio(1, 3)).iter().rev() {
                (re, im) = (re * x - im * y + a.to_f64_approximate(), re * y + im * x + b.to_f64_approximate());
            }
            assert!(f64::hypot(re, im) < 1e-4, "{of:?}: {x} + {y} j is no root");
        }
    }
}
