//! The map of two parameters of the built-in drive, against answers in one parameter and root counts.

mod program;

use jurist::analysis::{Map, Settings, intervals, map};
use jurist::limits::Budget;
use jurist::model::Loop;
use jurist::number::{Rational, parse_number};
use jurist::stability::AtPoint;
use jurist::stability::plane::StabilityMap;
use program::{json, jurist, refused};

const TIP: &str = "0.0620651373";

fn drive(x: &str, y: &str) -> Map {
    map(&Loop::drive(), &Settings::default(), [x, y], &Budget::unlimited()).unwrap()
}

fn decided(answer: &Map) -> &StabilityMap {
    answer.map.decided().unwrap()
}

fn q(text: &str) -> Rational {
    parse_number(text).unwrap()
}

#[test]
fn the_drive_has_one_region_with_a_tip() {
    let answer = json(&["map", "-x", "T", "-y", "K_pwm", "--json", "--digits", "20"]);
    assert_eq!(answer["schema"], "jurist/map/1");
    assert_eq!((&answer["x"], &answer["y"]), (&"T".into(), &"K_pwm".into()));
    let regions = answer["regions"].as_array().unwrap();
    assert_eq!(regions.len(), 1);
    assert_eq!(regions[0]["x"]["lower"]["decimal"], "0");
    let tip = regions[0]["x"]["upper"]["decimal"].as_str().unwrap();
    assert!(tip.starts_with(TIP), "{tip}");
    for strip in answer["strips"].as_array().unwrap() {
        let cells = strip["cells"].as_array().unwrap();
        assert!(cells[0]["lower"].is_null() && cells[cells.len() - 1]["upper"].is_null());
        for pair in cells.windows(2) {
            assert_eq!(pair[0]["upper"], pair[1]["lower"]);
        }
        for cell in cells {
            let outside = cell["outside"].as_u64().unwrap();
            assert_eq!(cell["verdict"] == "stable", outside == 0);
        }
    }
    let text = jurist(&["map", "-x", "T", "-y", "K_pwm"]);
    assert_eq!(text.status, 0, "{}", text.stderr);
    assert!(text.stdout.contains("1 region") && text.stdout.contains(TIP), "{}", text.stdout);
}

#[test]
fn slices_are_the_stable_sets_of_one_parameter() {
    let budget = Budget::unlimited();
    for (x, y, at) in [("T", "K_pwm", "1e-4"), ("K_pwm", "T", "110")] {
        let answer = drive(x, y);
        let slice = decided(&answer).slice(&q(at), &answer.axes[1].domain, &budget).unwrap().unwrap();
        let one = intervals(&Loop::drive(), &Settings::default(), y, &budget).unwrap();
        assert!(slice.same_as(&one.stable.decided().unwrap().to_interval_set()), "{y} at {x} = {at}");
    }
}

#[test]
fn every_point_has_the_root_count_of_its_cell_in_either_order() {
    let budget = Budget::unlimited();
    let (answer, swapped) = (drive("T", "K_pwm"), drive("K_pwm", "T"));
    let (one, other) = (decided(&answer), decided(&swapped));
    assert_eq!(one.regions.len(), other.regions.len());
    for (a, b) in one.regions.iter().zip(&other.regions) {
        assert_eq!((&a.x.upper, &a.y.upper), (&b.y.upper, &b.x.upper));
        assert_eq!((&a.x.lower, &a.y.lower), (&b.y.lower, &b.x.lower));
    }
    let p = answer.polynomial.as_ref().unwrap();
    let mut seen = [0, 0];
    // A fixed sequence spread over eight decades of either parameter.
    let mut state = 1u64;
    for _ in 0..60 {
        let mut draw = |decades: i64, offset: i64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mantissa = Rational::from((state >> 40) as i64 % 9973 + 1) / Rational::from(997);
            mantissa * Rational::from(10).pow((state >> 33) as i64 % decades + offset).unwrap()
        };
        let (x, y) = (draw(8, -7), draw(8, -4));
        let Some((s, c)) = one.locate(&x, &y, &answer.axes[1].domain, &budget).unwrap() else { continue };
        let cell = &one.strips[s].cells[c];
        let AtPoint::Defined { count, infinite } = p.at(&x, &y, answer.region) else { panic!("defined in a cell") };
        assert_eq!((count.outside + infinite, count.on), (cell.outside, cell.on), "T = {x}, K_pwm = {y}");
        seen[usize::from(cell.stable)] += 1;
        if let Some((s, c)) = other.locate(&y, &x, &swapped.axes[1].domain, &budget).unwrap() {
            assert_eq!(other.strips[s].cells[c].outside, cell.outside, "T = {x}, K_pwm = {y}");
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
}

#[test]
fn wrong_questions_are_refused() {
    refused(&["map", "-x", "T", "-y", "T"], "E-usage");
    refused(&["map", "-x", "T", "-y", "nothing"], "E-unknown-parameter");
    refused(&["map", "-x", "T", "-y", "K_pwm", "--set", "T=1"], "E-kept-and-set");
}
