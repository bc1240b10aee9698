//! Maps by boxes against stable sets on lines, verdicts at points, and the map with the axes exchanged.

use super::lines::{Line, between};
use super::loops::Loop;
use crate::helpers::number::number;
use crate::helpers::random::Random;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes, Verdict};
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::stability::plane::boxes::{BoxMap, BoxVerdict, PlaneBox};
use jurist_engine::stability::{Range, StableSet};

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    pub maps: usize,
    pub stable: usize,
    pub unstable: usize,
    pub lines: usize,
    pub points: usize,
    /// Lines and points that ended with an error.
    pub stopped: usize,
}

/// Compares the boxes of a window with everything else that is known of it.
pub fn check(of: &Loop, goal: &str, random: &mut Random, budget: &Budget) -> Result<Seen, Error> {
    let plane = of.plane();
    let side = |[low, high]: [&str; 2]| Range::between(Some(number(low)), Some(number(high)));
    let windows = of.window.map(side);
    let ask = |names: [&str; 2], windows: [Range; 2]| -> Result<BoxMap, Error> {
        let request = BoxRequest::new(windows, number(goal));
        let problem = plane.ask().free(names[0]).free(names[1]).plane_problem()?;
        match problem.map_by(MapMethod::Boxes, &request, 6, budget)? {
            MapOrBoxes::Boxes(answer) => Ok(answer.into_value().boxes),
            MapOrBoxes::Exact(_) => panic!("boxes were asked for"),
        }
    };
    let map = ask(["x", "y"], windows.clone())?;
    let mut seen = Seen { maps: 1, ..Seen::default() };
    let count = |verdict: fn(&BoxVerdict) -> bool| map.boxes.iter().filter(|b| verdict(&b.verdict)).count();
    seen.stable = count(|v| *v == BoxVerdict::Stable);
    seen.unstable = count(|v| matches!(v, BoxVerdict::Unstable { .. }));
    areas_are_those_of_boxes(&map);
    // What one of both needs too long for is no contradiction.
    if let Ok(other) = ask(["y", "x"], [windows[1].clone(), windows[0].clone()]) {
        agrees_with_exchanged(&map, &other);
    }
    for _ in 0..3 {
        let inside = |range: &[Rational; 2], random: &mut Random| {
            &range[0]
                + &(&(&range[1] - &range[0]) * &Rational::new((1 + random.below(1008) as i64).into(), 1009.into()))
        };
        let lines = [Line::Vertical(inside(&map.window.x, random)), Line::Horizontal(inside(&map.window.y, random))];
        for line in lines {
            match line.stable_set(of, &plane, &windows, budget) {
                Ok(set) => agrees_on_line(&map, &line, &set, &mut seen),
                Err(_) => seen.stopped += 1,
            }
        }
    }
    points(&plane, &map, random, budget, &mut seen)?;
    Ok(seen)
}

fn areas_are_those_of_boxes(map: &BoxMap) {
    let of = |wanted: fn(&BoxVerdict) -> bool| {
        let boxes = map.boxes.iter().filter(|b| wanted(&b.verdict));
        boxes.fold(Rational::ZERO, |sum, b| sum + b.window.area())
    };
    assert_eq!(of(|v| *v == BoxVerdict::Stable), map.areas.stable);
    assert_eq!(of(|v| *v == BoxVerdict::Undecided), map.areas.undecided);
    assert_eq!(of(|v| matches!(v, BoxVerdict::Unstable { .. })), map.areas.unstable);
    assert_eq!(of(|_| true), map.window.area());
}

/// The brackets of the area overlap, and no box contradicts another.
fn agrees_with_exchanged(map: &BoxMap, other: &BoxMap) {
    let bracket = |map: &BoxMap| (map.areas.stable.clone(), &map.areas.stable + &map.areas.undecided);
    let (one, two) = (bracket(map), bracket(other));
    assert!(one.0 <= two.1 && two.0 <= one.1, "areas: {one:?} {two:?}");
    for b in map.boxes.iter().step_by(1 + map.boxes.len() / 60) {
        let middle = |[low, high]: &[Rational; 2]| low.midpoint(high);
        let Some(there) = other.locate(&middle(&b.window.y), &middle(&b.window.x)) else { continue };
        let said = [b.verdict, there.verdict];
        let has = |wanted: fn(&BoxVerdict) -> bool| said.iter().any(wanted);
        let contradict = has(|v| *v == BoxVerdict::Stable) && has(|v| matches!(v, BoxVerdict::Unstable { .. }));
        assert!(!contradict, "{b:?} {there:?}");
    }
}

/// No box contradicts the stable set on the line, and the length of that is between those of the boxes.
fn agrees_on_line(map: &BoxMap, line: &Line, set: &StableSet, seen: &mut Seen) {
    seen.lines += 1;
    type Side = fn(&PlaneBox) -> &[Rational; 2];
    let (across, along): (Side, Side) = match line {
        Line::Vertical(_) => (|b| &b.window.x, |b| &b.window.y),
        _ => (|b| &b.window.y, |b| &b.window.x),
    };
    let (Line::Vertical(at) | Line::Horizontal(at)) = line else { panic!("a line along an axis") };
    let is_open = |t: &Rational| {
        let within = |u: &jurist_engine::stability::UndecidedBracket| {
            u.lower.as_ref().is_none_or(|l| l <= t) && u.upper.as_ref().is_none_or(|h| t <= h)
        };
        set.undecided().iter().any(within)
    };
    let mut lengths = [Rational::ZERO, Rational::ZERO];
    for b in map.boxes.iter().filter(|b| across(b)[0] < *at && *at < across(b)[1]) {
        let [low, high] = along(b);
        match b.verdict {
            BoxVerdict::Stable => lengths[0] += &(high - low),
            BoxVerdict::Undecided => lengths[1] += &(high - low),
            BoxVerdict::Unstable { .. } => {}
        }
        if b.verdict == BoxVerdict::Undecided {
            continue;
        }
        for t in between(Some(&low.clone().into()), Some(&high.clone().into())).into_iter().filter(|t| !is_open(t)) {
            assert_eq!(set.contains(&t), b.verdict == BoxVerdict::Stable, "{line:?} at {t}: {b:?}");
            seen.points += 1;
        }
    }
    let width = Rational::dyadic(&Integer::ONE, 80);
    let place = |end: &Real| end.refined(&width).enclosure();
    let mut length = [Rational::ZERO, Rational::ZERO];
    for interval in set.intervals() {
        let (Some(lower), Some(upper)) = (&interval.lower, &interval.upper) else { panic!("within the window") };
        let (lower, upper) = (place(&lower.value), place(&upper.value));
        length[0] += &(&upper.0 - &lower.1);
        length[1] += &(&upper.1 - &lower.0);
    }
    let whole = if let Line::Vertical(_) = line { &map.window.y } else { &map.window.x };
    for open in set.undecided() {
        let low = open.lower.clone().unwrap_or_else(|| whole[0].clone()).max(whole[0].clone());
        let high = open.upper.clone().unwrap_or_else(|| whole[1].clone()).min(whole[1].clone());
        length[1] += &(&high - &low).max(Rational::ZERO);
    }
    assert!(lengths[0] <= length[1], "{line:?}: proved stable {} of {}", lengths[0], length[1]);
    assert!(length[0] <= &lengths[0] + &lengths[1], "{line:?}: {} of {lengths:?}", length[0]);
}

/// Verdicts at points of some decided boxes.
fn points(plane: &Model, map: &BoxMap, random: &mut Random, budget: &Budget, seen: &mut Seen) -> Result<(), Error> {
    let decided: Vec<&PlaneBox> = map.boxes.iter().filter(|b| b.verdict != BoxVerdict::Undecided).collect();
    for b in decided.iter().step_by(1 + decided.len() / 8) {
        let inner = |[low, high]: &[Rational; 2], share: usize| {
            low + &(&(high - low) * &Rational::new((1 + share as i64).into(), 102.into()))
        };
        let point = [inner(&b.window.x, random.below(101)), inner(&b.window.y, random.below(101))];
        let question = plane.ask().set("x", point[0].clone()).set("y", point[1].clone());
        match question.verdict(budget) {
            Ok(found) => {
                let is_stable = found.value().verdict == Verdict::Stable;
                assert_eq!(is_stable, b.verdict == BoxVerdict::Stable, "{point:?} {b:?}");
                seen.points += 1;
            }
            Err(Error::Stopped(_)) => seen.stopped += 1,
            Err(refused) => return Err(refused),
        }
    }
    Ok(())
}
