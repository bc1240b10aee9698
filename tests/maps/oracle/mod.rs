//! Random maps against stable sets on lines: regions, extents, causes and areas, over every ring of coefficients, with the axes in
//! either order.
//!
//! `MAP_CASES=500 cargo test --release --test it maps::oracle -- --nocapture` asks for so many of each ring, `MAP_FIRST=1000` begins
//! later, `MAP_WORK=40000000` leaves out fewer.

mod boxes;
mod exact;
mod lines;
mod loops;

use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::error::Error;
use jurist_engine::stability::Range;
use loops::Loop;
use std::ops::Range as Cases;

/// The most work for one map and all that it is compared with: a loop that needs more is left out, and counted.
const WORK: u64 = 3_000_000;

/// A number from the environment.
fn asked(name: &str) -> Option<usize> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// The numbers of the cases: as many as are said here, unless the environment asks for more.
fn cases(usual: usize) -> Cases<usize> {
    let first = asked("MAP_FIRST").unwrap_or(0);
    first..first + asked("MAP_CASES").unwrap_or(usual)
}

fn budget() -> Budget {
    Budget::with_work(asked("MAP_WORK").map_or(WORK, |units| units as u64))
}

fn domain(random: &mut Random) -> [Range; 2] {
    [0; 2].map(|_| match random.below(6) {
        0 => Range::between(Some(Rational::ZERO), None),
        1 => Range::between(Some(Rational::new((-3).into(), 2.into())), Some(Rational::from(2))),
        _ => Range::all(),
    })
}

/// Compares exact maps; the loop is printed where that fails.
fn exact_maps(usual: usize, loops: fn(&mut Random) -> Loop) -> exact::Seen {
    let mut all = exact::Seen::default();
    for case in cases(usual) {
        let mut random = Random::new(case as u64 + 1);
        let (of, domain) = (loops(&mut random), domain(&mut random));
        let found = reported(case, &of, || exact::check(&of, &domain, &mut random, &budget()));
        match found {
            Ok(seen) => {
                all.maps += seen.maps;
                all.regions += seen.regions;
                all.lines += seen.lines;
                all.points += seen.points;
                all.ends += seen.ends;
                all.unconnected += seen.unconnected;
            }
            Err(_) => all.stopped += 1,
        }
    }
    println!("{all:?}");
    all
}

/// Compares maps by boxes.
fn maps_by_boxes(usual: usize, goal: &str, loops: fn(&mut Random) -> Loop) -> boxes::Seen {
    let mut all = boxes::Seen::default();
    for case in cases(usual) {
        let mut random = Random::new(case as u64 + 1);
        let of = loops(&mut random);
        match reported(case, &of, || boxes::check(&of, goal, &mut random, &budget())) {
            Ok(seen) => {
                all.maps += seen.maps;
                all.stable += seen.stable;
                all.unstable += seen.unstable;
                all.lines += seen.lines;
                all.points += seen.points;
                all.stopped += seen.stopped;
            }
            Err(_) => all.stopped += 1,
        }
    }
    println!("{all:?}");
    all
}

fn reported<T>(case: usize, of: &Loop, check: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    struct OnPanic<'a>(usize, &'a Loop);
    impl Drop for OnPanic<'_> {
        fn drop(&mut self) {
            if std::thread::panicking() {
                eprintln!("case {}:\n{}", self.0, self.1.text());
            }
        }
    }
    let _told = OnPanic(case, of);
    check()
}

#[test]
fn maps_over_the_integers() {
    let seen = exact_maps(count(5, 12), loops::rational);
    assert!(seen.regions > 0 && seen.points > count(20, 50), "{seen:?}");
}

#[test]
fn maps_over_constants() {
    let seen = exact_maps(count(3, 8), loops::over_constants);
    assert!(seen.regions > 0 && seen.points > count(20, 50), "{seen:?}");
}

#[test]
fn maps_of_held_plants() {
    let seen = exact_maps(6, loops::held);
    assert!(seen.regions > 0 && seen.points > 50, "{seen:?}");
}

#[test]
fn boxes_over_the_integers() {
    let seen = maps_by_boxes(3, "1/10", loops::rational);
    assert!(seen.lines > 0 && seen.points > 50, "{seen:?}");
}

#[test]
fn boxes_of_held_plants() {
    let seen = maps_by_boxes(3, "1/4", loops::held);
    assert!(seen.lines > 0 && seen.points > 20, "{seen:?}");
}

#[test]
fn boxes_with_parameters_inside_of_functions() {
    let seen = maps_by_boxes(3, "1/3", loops::inside_of_functions);
    assert!(seen.lines > 0 && seen.points > 50, "{seen:?}");
}

#[test]
fn boxes_with_dead_time() {
    let seen = maps_by_boxes(4, "1/3", loops::with_dead_time);
    assert!(seen.lines > 0 && seen.points > 50, "{seen:?}");
}
