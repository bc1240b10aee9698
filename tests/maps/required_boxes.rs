//! Boxes of two parameters in which requirements are met, against decisions at points.

use crate::helpers::model::{keeping, load, read};
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::required::{Known, is_met};
use crate::helpers::thorough::{count, is_thorough, is_tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, BoxRequest, MapBoxes, MapMethod, MapOrBoxes, Verdict};
use jurist_engine::model::Model;
use jurist_engine::problem::Region;
use jurist_engine::response::{OverPoints, RequiredBox, Requirement, RequirementBoxes};
use jurist_engine::stability::Range;

pub(super) fn diagram(time: &str, names: [&str; 2], controller: &str, plant: &str, held: bool) -> Model {
    let [x, y] = names;
    let hold = if held { "discretize = 'zoh'\n" } else { "" };
    read(&format!(
        "time = '{time}'\nsample_time = 'T'\n[constants]\nT = 0.1\n[parameters]\n{x} = 1\n{y} = 1\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ntransfer = '{controller}'\n[[block]]\nname = 'p'\n\
         input = 'u'\noutput = 'y'\ntransfer = '{plant}'\n{hold}"
    ))
}

pub(super) fn boxes(
    model: &Model,
    names: [&str; 2],
    sides: [[&str; 2]; 2],
    undecided: &str,
    requirements: &[Requirement],
) -> Answer<MapBoxes> {
    let budget = Budget::unlimited();
    let range = |[lower, upper]: [&str; 2]| Range::between(Some(number(lower)), Some(number(upper)));
    let request = BoxRequest::new(sides.map(range), number(undecided));
    let problem = keeping(model, &names).plane_problem().unwrap();
    match problem.required_map_by((MapMethod::Boxes, &request), (requirements, Some("u")), 6, &budget) {
        Ok(MapOrBoxes::Boxes(found)) => *found,
        Ok(MapOrBoxes::Exact(_)) => panic!("boxes were asked for"),
        Err(e) => panic!("{e}"),
    }
}

pub(super) fn required(answer: &Answer<MapBoxes>) -> &[RequiredBox] {
    &answer.value().required.as_ref().unwrap().boxes
}

/// A point strictly inside of a box.
fn inside(b: &RequiredBox, random: &mut Random) -> [Rational; 2] {
    [&b.window.x, &b.window.y].map(|[low, high]| {
        let share = ratio(1 + random.below(998) as i64, 1000);
        low + &(&(high - low) * &share)
    })
}

/// Boxes that say something of their points, and how many met and unmet ones were asked at a point.
pub(super) fn agrees(
    answer: &Answer<MapBoxes>,
    random: &mut Random,
    points: usize,
    met: impl Fn(&[Rational; 2]) -> bool,
) -> [usize; 2] {
    let told: Vec<&RequiredBox> = required(answer).iter().filter(|b| b.met.is_some()).collect();
    let mut seen = [0; 2];
    for _ in 0..points.min(told.len()) {
        let b = told[random.below(told.len())];
        let point = inside(b, random);
        let found = met(&point);
        assert_eq!(Some(found), b.met, "{} {}", point[0], point[1]);
        seen[usize::from(found)] += 1;
    }
    seen
}

pub(super) fn decided(model: &Model, names: [&str; 2], point: &[Rational; 2], requirement: &Requirement) -> bool {
    let question = names.iter().zip(point).fold(model.ask(), |q, (name, x)| q.set(*name, x.clone()));
    let problem = question.problem().unwrap();
    problem.requirements_met(std::slice::from_ref(requirement), Some("u"), &Budget::unlimited()).unwrap()[0].met
}

/// Rational loops, in both times, against stable sets of factors and rotations.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_rational_loops_agree_with_a_second_decision() {
    let mut random = Random::new(37);
    let loops = [
        ("continuous", "K + L/s", "2/((s + 1)*(s + 2))", [["0", "6"], ["0", "9"]]),
        ("continuous", "K*(s + L)/s", "1000/(s*(s + 200))", [["0", "6"], ["0", "200"]]),
        ("continuous", "K*(s - L)/(s + 3)", "1/(s + 1)", [["-2", "2"], ["-3", "3"]]),
        ("discrete", "K", "(z - L)/(z - 1)^2", [["0", "2"], ["0", "1"]]),
        ("discrete", "K + L/(z - 1)", "0.01/((z - 0.99)*(z - 0.5))", [["0", "50"], ["0", "2"]]),
    ];
    let kinds = [
        (Requirement::gain_margin(&number("3/2")).unwrap(), Known::Gain(number("3/2"))),
        (Requirement::phase_margin(&number("60")).unwrap(), Known::Phase(ratio(1, 3))),
        (Requirement::modulus_margin(number("1/2")).unwrap(), Known::Circle([1, 0], number("1/2"))),
        (Requirement::complementary_peak(number("3/2")).unwrap(), Known::Circle([0, 1], number("2/3"))),
        (Requirement::disk_margin(number("1/2")).unwrap(), Known::Circle([1, -1], number("1/4"))),
    ];
    let mut seen = [0; 2];
    for (i, (time, controller, plant, sides)) in loops.into_iter().enumerate() {
        let model = diagram(time, ["K", "L"], controller, plant, false);
        for (j, (requirement, known)) in kinds.iter().enumerate() {
            if !is_tried(i + j + 4, 5) {
                continue;
            }
            let goal = if is_thorough() { "1/10" } else { "1/5" };
            let answer = boxes(&model, ["K", "L"], sides, goal, std::slice::from_ref(requirement));
            assert!(answer.value().stopped().is_none(), "{controller} {plant} {}", requirement.text());
            let at = |p: &[Rational; 2]| is_met(&model, &[("K", &p[0]), ("L", &p[1])], Some("u"), known);
            let [unmet, met] = agrees(&answer, &mut random, 16, at);
            seen = [seen[0] + unmet, seen[1] + met];
        }
    }
    let enough = count(12, 61);
    assert!(seen[0] >= enough && seen[1] >= enough, "{seen:?}");
}

/// Behind a hold with gains, with a constant of the plant and with the sample time, against crossings at points.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_behind_a_hold_agree_with_decisions_at_points() {
    let mut random = Random::new(38);
    let loops = [
        (["K", "L"], "K + L*T/(z - 1)", "1/(0.5*s + 1)", [["0", "8"], ["0", "20"]]),
        (["K", "L"], "K", "1/(s*(L*s + 1))", [["0", "8"], ["1/10", "2"]]),
        (["K", "T"], "K", "1/((s + 1)*(s + 3))", [["0", "40"], ["1/10", "1"]]),
    ];
    let kinds = [
        Requirement::phase_margin(&number("40")).unwrap(),
        Requirement::gain_margin(&number("2")).unwrap(),
        Requirement::modulus_margin(number("1/2")).unwrap(),
    ];
    let mut seen = [0; 2];
    for (i, (names, controller, plant, sides)) in loops.into_iter().enumerate() {
        let model = match names[1] {
            "T" => load(
                "time = 'discrete'\nsample_time = 'T'\n[parameters]\nK = 1\nT = 0.5\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\n\
                 name = 'c'\ninput = 'r - y'\noutput = 'u'\ntransfer = 'K'\n[[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\n\
                 transfer = '1/((s + 1)*(s + 3))'\ndiscretize = 'zoh'\n",
            ),
            _ => diagram("discrete", names, controller, plant, true),
        };
        for requirement in kinds.iter().enumerate().filter(|(j, _)| is_tried(i + j, 3)).map(|(_, kind)| kind) {
            let answer = boxes(&model, names, sides, "1/12", std::slice::from_ref(requirement));
            let [unmet, met] = agrees(&answer, &mut random, 12, |p| decided(&model, names, p, requirement));
            seen = [seen[0] + unmet, seen[1] + met];
        }
    }
    let enough = count(6, 26);
    assert!(seen[0] >= enough && seen[1] >= enough, "{seen:?}");
}

/// Requirements on roots: damping of continuous loops, settling of discrete ones.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_requirements_on_roots_agree_with_decisions_at_points() {
    let mut random = Random::new(39);
    let damping = Requirement::damping(number("1/2")).unwrap();
    let model = diagram("continuous", ["K", "L"], "K + L/s", "2/((s + 1)*(s + 2))", false);
    let goal = if is_thorough() { "1/10" } else { "1/6" };
    let answer = boxes(&model, ["K", "L"], [["0", "6"], ["0", "9"]], goal, std::slice::from_ref(&damping));
    let seen = agrees(&answer, &mut random, 40, |p| decided(&model, ["K", "L"], p, &damping));
    assert!(seen[0] > 5 && seen[1] > 5, "{seen:?}");
    let model = diagram("discrete", ["K", "L"], "K + L*T/(z - 1)", "1/(0.5*s + 1)", true);
    let settling = [Requirement::settling_time(number("0.8"), &number("0.1")).unwrap()];
    let answer = boxes(&model, ["K", "L"], [["0", "8"], ["0", "20"]], goal, &settling);
    let seen = agrees(&answer, &mut random, 40, |p| decided(&model, ["K", "L"], p, &settling[0]));
    assert!(seen[0] > 5 && seen[1] > 5, "{seen:?}");
}

/// `K/(s + a)`: `|1 + L|` is at least 1 for all positive gains, and the distance from -1 of `-K/(s + a)` is `1 - K/a`.
#[test]
#[ignore = "long: CI runs it"]
fn a_requirement_that_is_known_by_hand() {
    let half = Requirement::modulus_margin(number("1/2")).unwrap();
    let model = diagram("continuous", ["K", "L"], "K", "1/(s + L)", false);
    let met = |lower: &str, upper: &str| {
        let answer = boxes(&model, ["K", "L"], [[lower, upper], ["1", "3"]], "1/100", std::slice::from_ref(&half));
        let areas = &answer.value().required.as_ref().unwrap().areas;
        (areas.met.clone(), &areas.met + &areas.undecided)
    };
    // All of it.
    assert_eq!(met("0", "2").0, number("4"));
    // K > -L/2: the triangle between K = -3/2 and K = -1/2 and the rectangle beside it, of the areas 1 and 1.
    let (least, most) = met("-2", "0");
    assert!(least <= number("2") && number("2") <= most && least > number("1.9"), "{least} {most}");
}

/// `K L/s` bears `pi/(2 K L)`: as long as 1 below a hyperbola, of which the window from 0 to 2 holds the area `pi/2 (1 + ln(8/pi))`.
#[test]
#[ignore = "long: CI runs it"]
fn a_delay_margin_below_a_hyperbola() {
    let model = diagram("continuous", ["K", "L"], "K", "L/s", false);
    let found =
        boxes(&model, ["K", "L"], [["0", "2"], ["0", "2"]], "1/20", &[Requirement::delay_margin(1.into()).unwrap()]);
    let areas = &found.value().required.as_ref().unwrap().areas;
    let half = std::f64::consts::FRAC_PI_2;
    let exact = half * (1.0 + (4.0 / half).ln());
    let [met, undecided] = [&areas.met, &areas.undecided].map(Rational::to_f64_approximate);
    assert!(met <= exact && exact <= met + undecided && undecided <= 0.2, "{met} {exact} {undecided}");
    for b in required(&found) {
        let at = |[x, y]: [&Rational; 2]| (x * y).to_f64_approximate() < half;
        let [low, high] = [0, 1].map(|k| at([&b.window.x[k], &b.window.y[k]]));
        match b.met {
            Some(true) => assert!(high, "{b:?}"),
            Some(false) => assert!(!low, "{b:?}"),
            None => {}
        }
    }
}

/// The same in whole samples: `z^2 (z - 1) + K L` is stable for `K L < 2 sin(pi/10)`.
#[test]
fn two_samples_below_a_hyperbola() {
    let model = diagram("discrete", ["K", "L"], "K", "L/(z - 1)", false);
    let (goal, open) = if is_thorough() { ("1/20", 0.2) } else { ("1/10", 0.4) };
    let found =
        boxes(&model, ["K", "L"], [["0", "2"], ["0", "2"]], goal, &[Requirement::delay_margin(number("0.2")).unwrap()]);
    let areas = &found.value().required.as_ref().unwrap().areas;
    let least = 2.0 * (std::f64::consts::PI / 10.0).sin();
    let exact = least * (1.0 + (4.0 / least).ln());
    let [met, undecided] = [&areas.met, &areas.undecided].map(Rational::to_f64_approximate);
    assert!(met <= exact && exact <= met + undecided + open, "{met} {exact} {undecided}");
    assert!(required(&found).iter().all(|b| {
        let product = |k: usize| (&b.window.x[k] * &b.window.y[k]).to_f64_approximate();
        b.met.is_none_or(|met| if met { product(1) < least } else { product(0) > least })
    }));
}

/// `L(0)` is -2 whatever the parameters are: with half the gain a root is at 0, so a gain margin of more than 2 is met nowhere.
#[test]
#[ignore = "long: CI runs it"]
fn a_gain_margin_that_is_reached_at_frequency_zero_everywhere_is_met_nowhere() {
    let two = Requirement::gain_margin(&number("2")).unwrap();
    let model = diagram("continuous", ["K", "L"], "2", "(K*s + 1)/((s - 1)*(L*s + 1))", false);
    let answer = boxes(&model, ["K", "L"], [["1", "2"], ["1/2", "1"]], "1/4", std::slice::from_ref(&two));
    assert!(!decided(&model, ["K", "L"], &[number("3/2"), number("3/4")], &two));
    assert!(!required(&answer).is_empty() && required(&answer).iter().all(|b| b.met != Some(true)));
    // With a little less it is met everywhere.
    let less = Requirement::gain_margin(&number("1.99")).unwrap();
    let answer = boxes(&model, ["K", "L"], [["1", "2"], ["1/2", "1"]], "1/10", std::slice::from_ref(&less));
    assert!(required(&answer).iter().any(|b| b.met == Some(true)));
}

/// Where a divisor of the model vanishes inside of a box not all points are stable, though no root crosses.
#[test]
fn a_box_with_a_pole_of_the_model_is_not_stable_everywhere() {
    let model = diagram("continuous", ["K", "L"], "K/(L - 1)", "(L - 1)/(s + 1)", false);
    let problem = keeping(&model, &["K", "L"]).plane_problem().unwrap();
    let budget = Budget::unlimited();
    let near = [number("1"), number("3")];
    let stable = RequirementBoxes::of_stability(&problem, &near, &budget).unwrap().unwrap();
    let look = |low: &str, high: &str| {
        let sides = [[number("1"), number("2")], [number(low), number(high)]];
        stable.look(&sides, &budget).unwrap()
    };
    assert_eq!(look("2", "4"), OverPoints::All);
    assert_eq!(look("0", "4"), OverPoints::Open { middle: Some(true) });
}

/// Boxes of random loops, rational and behind a hold, within a smaller region too: where a look says that no point is stable, or all are, so it is.
#[test]
fn looks_at_stability_agree_with_points() {
    let mut random = Random::new(11);
    let mut seen = [0, 0];
    for case in 0..24 {
        let mut number = |bound: usize| Rational::from(random.below(2 * bound + 1) as i64 - bound as i64);
        let half = ratio(1, 2);
        let (time, plant) = match case % 3 {
            0 => ("continuous", format!("1/((s + {})*(s + {})*(s + 4))", number(3), number(3))),
            1 => ("discrete", format!("1/10/((z - {})*(z + {}))", number(2) * &half, number(2) * &half)),
            _ => ("discrete", "2/(s^2 + s + 1/5)".to_owned()),
        };
        let controller = if time == "continuous" { "(K*s + L)/s" } else { "K + L/(z - 1)" };
        let model = diagram(time, ["K", "L"], controller, &plant, case % 3 == 2);
        let bound = number(3).abs() * ratio(1, 8);
        let region =
            if time == "continuous" { Region::half_plane(bound) } else { Region::disc(ratio(1, 1) - bound).unwrap() };
        let budget = Budget::unlimited();
        let question = model.ask().free("K").free("L").within(region.clone());
        let problem = question.problem().unwrap();
        let near = [ratio(1, 1), ratio(1, 1)];
        let stable = RequirementBoxes::of_stability(&problem, &near, &budget).unwrap().unwrap();
        for _ in 0..6 {
            let sides = [(); 2].map(|()| {
                let low = ratio(random.below(64) as i64 - 32, 8);
                [low.clone(), low + ratio(1 + random.below(24) as i64, 8)]
            });
            let expected = match stable.look(&sides, &budget).unwrap() {
                OverPoints::All => Verdict::Stable,
                OverPoints::None => Verdict::Unstable,
                OverPoints::Open { .. } => continue,
            };
            for _ in 0..4 {
                let point =
                    sides.each_ref().map(|[low, high]| low + &((high - low) * ratio(random.below(1001) as i64, 1000)));
                let question = model.ask().set("K", point[0].clone()).set("L", point[1].clone()).within(region.clone());
                let verdict = question.verdict(&budget).unwrap().value().verdict;
                assert!(
                    (verdict == Verdict::Stable) == (expected == Verdict::Stable),
                    "{point:?} in {sides:?}: {verdict:?}"
                );
                seen[usize::from(expected == Verdict::Stable)] += 1;
            }
        }
    }
    assert!(seen[0] > 100 && seen[1] > 3, "{seen:?}");
}
