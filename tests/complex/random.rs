//! Random loops with complex coefficients: their sets against the criterion of Schur and Cohn on both sides of every end, against the same
//! loops in real form, and with the imaginary unit negated.

use super::oracle::{Loop, is_hurwitz, is_schur, plus};
use crate::helpers::model::{load, read};
use crate::helpers::number::ratio;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::answer::{Answer, ToleranceRequest};
use jurist_engine::problem::Region;
use jurist_engine::response::Requirement;
use jurist_engine::stability::boxes::BoxDecision;
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
    let cases = count(80, 320);
    for case in 0..cases {
        let of = Loop::random(&mut random, case % 2 == 0);
        let (limits, lower) = check(&of);
        for (sum, more) in sums.iter_mut().zip([limits, lower, usize::from(limits > 0)]) {
            *sum += more;
        }
    }
    let [limits, lower, loops] = sums;
    assert!(limits * 32 > cases * 15 && loops * 16 > cases * 5, "{limits} ends in {loops} loops");
    assert!(lower * 4 > limits && lower * 4 < limits * 3, "{lower} of {limits} below the real axis");
}

#[test]
fn sets_are_those_of_the_real_form_and_of_the_mirror_image() {
    let mut random = Random::new(1944);
    for case in 0..count(40, 160) {
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
    for case in 0..count(20, 60) {
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

/// Smaller regions are those of a variable that is scaled or shifted, and the least damping of all roots bounds what can be required.
#[test]
fn regions_and_damping() {
    let mut random = Random::new(1875);
    let mut damped = 0;
    for case in 0..count(20, 60) {
        let of = Loop::random(&mut random, case % 2 == 0);
        let text = of.text(1);
        let (option, moved) = match of.is_discrete {
            true => (Region::disc(ratio(4, 5)).unwrap(), text.replace("z^", "(4/5*z)^")),
            false => (Region::half_plane(ratio(1, 3)), text.replace("s^", "(s - 1/3)^")),
        };
        let own = read(&text).ask().within(option).free("K").stable_set(&Budget::unlimited()).unwrap();
        let values = |answer: &Answer<StableSet>| ends(answer.value()).map(|e| e.value.clone()).collect::<Vec<_>>();
        let (a, b) = (values(&own), values(&set(&moved)));
        assert!(a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.is_same(b)), "{of:?}: {a:?} {b:?}");
        let problem = load(&text).ask().set("K", ratio(1, 3)).problem().unwrap();
        let budget = Budget::unlimited();
        if problem.verdict(&budget).unwrap().value().count.unwrap().inside < of.a.len() {
            continue;
        }
        let roots = problem.roots(17, &budget).unwrap().into_value();
        let damping = |root: &jurist_engine::answer::ClosedLoopRoot| {
            let (x, y) = (root.disc.re.to_f64_approximate(), root.disc.im.to_f64_approximate());
            let (x, y) = if of.is_discrete { (x.hypot(y).ln(), y.atan2(x)) } else { (x, y) };
            -x / x.hypot(y)
        };
        let least = roots.list.iter().map(damping).fold(1.0, f64::min);
        for (more, expected) in [(-1e-9, true), (1e-9, false)] {
            let Some(asked) = Rational::from_f64(least + more).filter(|d| d.sign().is_gt() && *d < Rational::ONE)
            else {
                continue;
            };
            let met = problem.requirements_met(&[Requirement::damping(asked).unwrap()], None, &budget).unwrap();
            assert_eq!(met[0].met, expected, "{of:?}: {least}");
            damped += 1;
        }
    }
    assert!(damped > count(4, 20), "{damped}");
}

/// The plane of two parameters: a point of each cell of the exact map against Schur and Cohn.
#[test]
fn maps_agree_with_schur_and_cohn() {
    let mut random = Random::new(1975);
    let (mut stable, mut cells) = (0, 0);
    for case in 0..count(8, 24) {
        let of = Loop::random(&mut random, case % 2 == 0);
        // The second parameter turns the constant term: a_0 + b_0 K + (1 + 2j) L/4.
        let text = of.text(1).replace("K = {", "L = { nominal = 0, min = -3, max = 3 }\nK = {");
        let text = text.replacen("*z^0", "*z^0 + (1 + 2*j)*L/4", 1).replacen("*s^0", "*s^0 + (1 + 2*j)*L/4", 1);
        let problem = read(&text).ask().free("K").free("L").plane_problem().unwrap();
        let map = problem.map(8, &Budget::unlimited()).unwrap().into_value();
        for strip in &map.decomposition.strips {
            for cell in &strip.cells {
                let (k, l) = (&strip.sample, &cell.sample);
                let mut polynomial = of.at(k);
                let quarter = &ratio(1, 4) * l;
                polynomial[0] = plus(&polynomial[0], &[quarter.clone(), &quarter * &ratio(2, 1)]);
                let expected = if of.is_discrete { is_schur(&polynomial) } else { is_hurwitz(&polynomial) };
                assert_eq!(cell.stable, expected, "{of:?} at {k}, {l}");
                assert!(cell.outside <= of.a.len() && (cell.outside == 0) == expected, "{of:?} at {k}, {l}");
                (stable, cells) = (stable + usize::from(expected), cells + 1);
            }
        }
    }
    assert!(stable > count(10, 30) && cells > count(60, 200), "{stable} of {cells}");
}

/// Boxes of two tolerances: what is said of a box holds at all points of a grid, and the witness of a box that is not stable is none.
#[test]
fn boxes_agree_with_schur_and_cohn() {
    let mut random = Random::new(1932);
    let (mut stable, mut unstable) = (0, 0);
    for case in 0..count(60, 160) {
        let of = Loop::random(&mut random, case % 2 == 0);
        let text = of.text(1).replace(
            "K = { nominal = 0.1, min = -4, max = 4 }",
            "L = { nominal = 0.2, tolerance = '200%' }\nK = { nominal = 0.1, tolerance = '300%' }",
        );
        let text = text.replacen("*z^0", "*z^0 + (1 + 2*j)*L/4", 1).replacen("*s^0", "*s^0 + (1 + 2*j)*L/4", 1);
        let model = load(&text);
        let is_stable = |k: &Rational, l: &Rational| {
            let mut polynomial = of.at(k);
            let quarter = &ratio(1, 4) * l;
            polynomial[0] = plus(&polynomial[0], &[quarter.clone(), &quarter * &ratio(2, 1)]);
            if of.is_discrete { is_schur(&polynomial) } else { is_hurwitz(&polynomial) }
        };
        let request = ToleranceRequest::of_model(&model).gap(ratio(1, 100));
        let answer = model.ask().tolerance(&request, &Budget::unlimited()).unwrap();
        let free = answer.problem().free().to_vec();
        let place = |name: &str| free.iter().position(|free| free.name == name).unwrap();
        let answer = answer.into_value();
        let (at_k, at_l) = (place("K"), place("L"));
        match &answer.decision {
            BoxDecision::NotStable { witness } => {
                unstable += 1;
                let point = &witness.as_ref().expect("a point").point;
                assert!(!is_stable(&point[at_k], &point[at_l]), "{of:?} at {point:?}");
            }
            decision => {
                assert!(decision.is_stable(), "{of:?}: {decision:?}");
                stable += 1;
                for (a, b) in (-4..=4).flat_map(|a| (-4..=4).map(move |b| (a, b))) {
                    let (k, l) = (ratio(4 + 3 * a, 40), ratio(4 + 2 * b, 20));
                    assert!(is_stable(&k, &l), "{of:?} at {k}, {l}");
                }
            }
        }
    }
    assert!(stable > count(3, 10) && unstable > count(3, 10), "{stable} stable, {unstable} not");
}
