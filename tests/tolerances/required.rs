//! Requirements to be met at every point of a box: against the sets of one parameter, and against single points.

use crate::helpers::model::{example, load};
use crate::helpers::number::number;
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::response::{RequiredEnd, Requirement, Requirements};
use jurist_engine::stability::boxes::BoxDecision;

/// `K/(s (a s + 1)(s + 1))` in a loop.
const SERVO: &str = "time = 'continuous'\n[parameters]\nK = { nominal = '1/2', tolerance = '20%' }\n\
    a = { nominal = '1/5', tolerance = '30%' }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'all'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(a*s + 1)*(s + 1))'\n";

fn requirement(model: &Model, name: &str, text: &str) -> Requirement {
    let asked = Requirements::of(model, &[(name, text)], &[], &Budget::unlimited()).unwrap();
    asked.list.into_iter().next().expect("one that is no region")
}

fn request(model: &Model, names: &[&str], requirement: Requirement) -> ToleranceRequest {
    let own = ToleranceRequest::of_model(model).tolerances.into_iter();
    let chosen: Vec<_> = own.filter(|(name, _)| names.contains(&name.as_str())).collect();
    ToleranceRequest::new(chosen).require([requirement], None)
}

fn asked(model: &Model, request: &ToleranceRequest) -> Answer<ToleranceAnswer> {
    model.ask().tolerance(request, &Budget::unlimited()).unwrap()
}

fn is_met(answer: &Answer<ToleranceAnswer>, requirement: &Requirement, point: &[Rational], at: Option<&str>) -> bool {
    let problem = answer.problem();
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().set_all(problem.set().to_vec()).set_all(names.zip(point.iter().cloned()));
    let one = std::slice::from_ref(requirement);
    match question.problem().unwrap().requirements_met(one, at, &Budget::unlimited()) {
        Err(Error::Undefined(_)) => false,
        met => met.unwrap()[0].met,
    }
}

/// The four corners of a box of two sides, and then points of it.
fn points(sides: &[[Rational; 2]], count: usize, random: &mut Random) -> Vec<Vec<Rational>> {
    let mut share = |k: usize, i: usize| match k {
        0..4 => Rational::from(i64::from(k >> i & 1 == 1)),
        _ => Rational::new((random.below(1 << 16) as i64).into(), (1i64 << 16).into()),
    };
    let mut at = |k: usize| (0..2).map(|i| &sides[i][0] + &(&(&sides[i][1] - &sides[i][0]) * &share(k, i))).collect();
    (0..count).map(&mut at).collect()
}

const MARGINS: [(&str, &str); 8] = [
    ("phase_margin", "45 deg"),
    ("phase_margin", "60"),
    ("gain_margin", "6 dB"),
    ("gain_margin", "5"),
    ("modulus_margin", "0.6"),
    ("complementary_peak", "1.3"),
    ("disk_margin", "0.6"),
    ("damping", "0.5"),
];

/// Of one parameter the box grows to the end of the set in which the requirement is met.
#[test]
#[ignore = "long: CI runs it"]
fn the_box_of_one_gain_grows_to_the_end_of_its_required_set() {
    let model = load(SERVO);
    for (name, text) in MARGINS {
        let requirement = requirement(&model, name, text);
        let upwards = ToleranceRequest::new([("K", "-0%..+20%".parse().unwrap())]);
        let answer = asked(&model, &upwards.require([requirement.clone()], None));
        let problem = model.ask().free("K").problem().unwrap();
        let set = problem.required_set(&[requirement], None, &Budget::unlimited()).unwrap();
        let nominal = number("1/2");
        let around = set.value().intervals.iter().find(|interval| {
            let below = interval.lower.as_ref().is_none_or(|end| end.value().compare_rational(&nominal).is_lt());
            below && interval.upper.as_ref().is_none_or(|end| end.value().compare_rational(&nominal).is_gt())
        });
        let upper = around.expect("met at the nominal value").upper.as_ref().expect("a largest gain").value();
        let factor = answer.value().factor.as_ref().unwrap();
        let side = &answer.value().sides[0];
        let (proved, refuted) = (&side.at(&factor.lower)[1], &side.at(factor.upper.as_ref().unwrap())[1]);
        assert!(upper.compare_rational(proved).is_gt(), "{name} {text}: {proved}");
        assert!(upper.compare_rational(refuted).is_le(), "{name} {text}: {refuted}");
        let end = upper.refined_to_digits(20).enclosure().0;
        assert!(refuted - proved <= &end * &number("1e-5"), "{name} {text}: {proved} {refuted}");
        assert_eq!(answer.value().binding, Some(0), "{name} {text}");
    }
}

/// Corners and random points of the proved box meet the requirement; the point beyond does not.
#[test]
#[ignore = "long: CI runs it"]
fn points_of_a_proved_box_meet_the_requirement_and_the_point_beyond_does_not() {
    let model = load(SERVO);
    let mut random = Random::new(14);
    for (name, text) in MARGINS {
        let requirement = requirement(&model, name, text);
        let answer = asked(&model, &request(&model, &["K", "a"], requirement.clone()));
        let factor = answer.value().factor.as_ref().unwrap();
        let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
        for point in points(&sides, 10, &mut random) {
            assert!(is_met(&answer, &requirement, &point, None), "{name} {text}: {point:?}");
        }
        let witness = factor.witness.as_ref().expect("a point beyond");
        assert!(!is_met(&answer, &requirement, &witness.point, None), "{name} {text}");
        let upper = factor.upper.as_ref().unwrap();
        assert!(upper - &factor.lower <= upper * &number("1e-6"), "{name} {text}: {} {upper}", factor.lower);
        match &answer.value().decision {
            BoxDecision::Stable(_) => assert!(*upper > Rational::ONE, "{name} {text}"),
            BoxDecision::NotStable { witness } => {
                let point = &witness.as_ref().expect("a point").point;
                assert!(*upper <= Rational::ONE && !is_met(&answer, &requirement, point, None), "{name} {text}");
            }
            other => panic!("{name} {text}: {other:?}"),
        }
    }
}

/// The drive's current loop in discrete time: its phase margin over the tolerances of three components.
#[test]
fn a_phase_margin_of_the_drive_over_its_components() {
    let model = example("drive-blocks");
    let requirement = requirement(&model, "phase_margin", "25 deg");
    let at = Some("e_c".to_owned());
    let names = ["R_a", "L_a", "E_sw"].map(|name| (name, "10%".parse().unwrap()));
    let gap = number("1/1000");
    let answer =
        asked(&model, &ToleranceRequest::new(names).gap(gap.clone()).require([requirement.clone()], at.clone()));
    let factor = answer.value().factor.as_ref().expect("met at the nominal point");
    let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
    for mask in 0..8 {
        let corner: Vec<Rational> = (0..3).map(|i| sides[i][mask >> i & 1].clone()).collect();
        assert!(is_met(&answer, &requirement, &corner, at.as_deref()), "{mask}");
    }
    let (upper, witness) = (factor.upper.as_ref().unwrap(), factor.witness.as_ref().unwrap());
    assert!(upper - &factor.lower <= upper * &gap);
    assert!(!is_met(&answer, &requirement, &witness.point, at.as_deref()));
}

#[test]
fn a_settling_time_in_discrete_time_is_a_smaller_circle() {
    let model = load(
        "time = 'discrete'\nsample_time = 1\n[parameters]\nk = { nominal = '1/2', tolerance = '20%' }\n\
         [loop]\ncharacteristic = 'z - k'\n",
    );
    // |k| <= exp(-4/8) = 0.60653065971...
    let requirement = requirement(&model, "settling_time", "8");
    let answer = asked(&model, &ToleranceRequest::of_model(&model).require([requirement], None));
    let factor = answer.value().factor.as_ref().unwrap();
    let [_, proved] = answer.value().sides[0].at(&factor.lower);
    assert!(answer.value().decision.is_stable());
    assert!(proved < number("0.6065306598") && proved > number("0.60652"), "{proved}");
    assert!(answer.value().sides[0].at(factor.upper.as_ref().unwrap())[1] > number("0.6065306597"));
}

#[test]
fn a_nominal_point_that_does_not_meet_a_requirement_has_no_factor() {
    let model = load(&SERVO.replace("'1/2'", "3"));
    let requirement = requirement(&model, "phase_margin", "60 deg");
    let answer = asked(&model, &request(&model, &["K", "a"], requirement));
    assert!(answer.value().factor.is_none());
    let BoxDecision::NotStable { witness: Some(witness) } = &answer.value().decision else { panic!("a witness") };
    assert_eq!(witness.point, [number("3"), number("1/5")]);
}

/// `0.1/z`: `|1 + L|` is from 0.9 to 1.1, so that the open loop crosses no circle of radius 2, inside of which it lies.
#[test]
fn an_open_loop_inside_of_the_circle_does_not_have_the_modulus_margin() {
    let model = load(
        "time = 'discrete'\n[parameters]\nK = { nominal = '1/10', tolerance = '50%' }\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/z'\n",
    );
    for (least, is_met) in [("1/2", true), ("2", false)] {
        let requirement = requirement(&model, "modulus_margin", least);
        let answer = asked(&model, &request(&model, &["K"], requirement));
        match &answer.value().decision {
            BoxDecision::Stable(_) => assert!(is_met, "{least}"),
            BoxDecision::NotStable { witness } => {
                assert!(!is_met && answer.value().factor.is_none(), "{least}");
                assert_eq!(witness.as_ref().expect("a point").point, [number("1/10")]);
            }
            other => panic!("{least}: {other:?}"),
        }
    }
}

#[test]
fn requirements_beside_a_limit_are_refused_with_the_reason() {
    let model = load(SERVO);
    let refused_for =
        |request: &ToleranceRequest| model.ask().tolerance(request, &Budget::unlimited()).unwrap_err().to_string();
    let phase = || requirement(&model, "phase_margin", "30");
    assert!(refused_for(&request(&model, &["K"], phase()).limit("a")).contains("E-require"));
}

/// `K/s` bears `pi/(2 K)`: at `K = 1` with a tenth more or less a second as long as `1 + f/10 <= pi/2`.
#[test]
fn a_delay_margin_by_hand() {
    let text = |plant: &str, further: &str| {
        load(&format!(
            "time = 'continuous'\n[parameters]\nK = {{ nominal = 1, tolerance = '10%' }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
             [[block]]\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '{plant}'\n{further}"
        ))
    };
    for (plant, further, least, most) in [
        ("1/s", "", "1", 5.707_963_267_948_966),
        // Beside dead time of its own.
        ("exp(-s/5)/s", "", "4/5", 5.707_963_267_948_966),
    ] {
        let model = text(plant, further);
        let found = asked(&model, &request(&model, &["K"], requirement(&model, "delay_margin", least)));
        let own = &found.value().required[0];
        assert!(own.decision.is_stable(), "{own:?}");
        let factor = own.factor.as_ref().unwrap();
        let [low, high] = [&factor.lower, factor.upper.as_ref().unwrap()].map(Rational::to_f64_approximate);
        assert!(low <= most && most <= high && high - low < 1e-2, "{plant}: {low} {high}");
    }
}

/// Points of a box that is proved, and the one that bounds it, against the margins themselves.
#[test]
fn a_delay_margin_over_boxes_against_points() {
    let model = load(SERVO);
    let delay = requirement(&model, "delay_margin", "1");
    let found = asked(&model, &request(&model, &["K", "a"], delay.clone()));
    let own = &found.value().required[0];
    assert!(own.decision.is_stable(), "{own:?}");
    let factor = own.factor.as_ref().unwrap();
    let mut random = Random::new(41);
    for _ in 0..12 {
        let mut within = |side: &jurist_engine::stability::boxes::Side| {
            let [low, high] = side.at(&factor.lower);
            &low + &(&(&high - &low) * &Rational::new((random.below(101) as i64).into(), 100.into()))
        };
        let point: Vec<Rational> = found.value().sides.iter().map(&mut within).collect();
        assert!(is_met(&found, &delay, &point, None), "{point:?}");
    }
    let witness = factor.witness.as_ref().expect("a point beyond");
    assert!(!is_met(&found, &delay, &witness.point, None), "{witness:?}");
}

#[test]
fn the_program_says_which_requirement_binds() {
    let run =
        jurist_with_input(&["tolerance", "-", "--phase-margin", "45 deg", "--gain-margin", "6 dB"], SERVO.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    for part in [
        "and meets all requirements, for all values",
        "phase_margin >= 45 deg: met",
        "gain_margin > 6 dB: met",
        "not met just beyond",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    let json = jurist_with_input(&["tolerance", "-", "--phase-margin", "60 deg", "--json"], SERVO.as_bytes());
    assert_eq!(json.status, 1, "{}", json.stderr);
    let document: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    crate::helpers::schema::fits(&document).unwrap();
    assert_eq!(
        (&document["requirements"][0]["met"], &document["requirements"][0]["binds"]),
        (&false.into(), &true.into())
    );
}

/// Constants that are not rational are sides of the box; the factor of one name is where its own set ends.
#[test]
fn a_requirement_over_constants_ends_where_its_set_does() {
    let held = load(
        "time = 'discrete'\nsample_time = '1/10'\nparameters.K = 2\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'controller'\ninput = 'r - y'\noutput = 'u'\ntransfer = 'K'\n\
         [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = 'zoh'\n",
    );
    let rooted = load("time = 'continuous'\nparameters.K = 2\nloop.characteristic = 's^2 + sqrt(2)*s + K'\n");
    let cases = [
        (&held, Requirement::modulus_margin(number("1/2")).unwrap()),
        (&held, Requirement::gain_margin(&number("3/2")).unwrap()),
        (&held, Requirement::phase_margin(&number("60")).unwrap()),
        (&rooted, Requirement::damping(number("1/4")).unwrap()),
    ];
    for (model, requirement) in cases {
        let list = std::slice::from_ref(&requirement);
        let problem = model.ask().free("K").problem().unwrap();
        let set = problem.required_set(list, None, &Budget::unlimited()).unwrap().into_value();
        let around = set.intervals.iter().find(|i| i.contains(&number("2"))).expect("met at the nominal value");
        let end = around.upper.as_ref().unwrap().value();
        let request = ToleranceRequest::new([("K", "-0%..+10%".parse().unwrap())]).require(list.to_vec(), None);
        let answer = model.ask().tolerance(&request, &Budget::unlimited()).unwrap();
        let factor = answer.value().factor.as_ref().unwrap();
        // K = 2 + factor/5
        let value = |factor: &Rational| number("2") + factor * &number("1/5");
        let upper = value(factor.upper.as_ref().expect("a point that does not meet it"));
        assert!(end.compare_rational(&value(&factor.lower)).is_ge(), "{}", requirement.text());
        assert!(end.compare_rational(&upper).is_le(), "{}", requirement.text());
        assert!(&upper - &value(&factor.lower) < number("1/10000"), "{}", requirement.text());
    }
}

/// A PI controller of a lag behind a hold: constants of the plant and the sample time are inside of functions.
const HELD: &str = "time = 'discrete'\nsample_time = 'T'\n[parameters]\ntau = { nominal = '1/2', tolerance = '20%' }\n\
    T = { nominal = '1/10', tolerance = '10%' }\n[constants]\nL = 2\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ntransfer = '1 + L*T/(z - 1)'\n\
    [[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(tau*s + 1)'\ndiscretize = 'zoh'\n";

/// Corners and random points of the proved box meet the requirement, decided by crossings at each; the point beyond does not.
#[test]
#[ignore = "long: CI runs it"]
fn requirements_behind_a_hold_hold_for_constants_of_the_plant() {
    let model = load(HELD);
    let mut random = Random::new(15);
    for (name, text) in
        [("phase_margin", "70 deg"), ("gain_margin", "5"), ("modulus_margin", "0.6"), ("disk_margin", "1")]
    {
        let requirement = requirement(&model, name, text);
        let answer = asked(&model, &request(&model, &["tau", "T"], requirement.clone()));
        let required = &answer.value().required[0];
        let factor = required.factor.as_ref().unwrap();
        assert!(factor.lower.sign().is_gt(), "{name} {text}");
        let sides: Vec<[Rational; 2]> = answer.value().sides.iter().map(|side| side.at(&factor.lower)).collect();
        for point in points(&sides, 8, &mut random) {
            assert!(is_met(&answer, &requirement, &point, None), "{name} {text}: {point:?}");
        }
        let upper = factor.upper.as_ref().unwrap();
        assert!(upper - &factor.lower <= upper * &number("1e-3"), "{name} {text}: {} {upper}", factor.lower);
        assert!(!is_met(&answer, &requirement, &factor.witness.as_ref().unwrap().point, None), "{name} {text}");
        assert_eq!(required.decision.is_stable(), *upper > Rational::ONE, "{name} {text}");
    }
}

/// Of one constant inside of functions the box grows to the end of the set in which the requirement is met.
#[test]
#[ignore = "long: CI runs it"]
fn a_requirement_in_one_constant_behind_a_hold_ends_where_its_set_does() {
    let model = load(HELD);
    let requirement = requirement(&model, "phase_margin", "70 deg");
    let problem = model.ask().free("tau").problem().unwrap();
    let set =
        problem.required_set(std::slice::from_ref(&requirement), None, &Budget::unlimited()).unwrap().into_value();
    let around = set.intervals.iter().find(|i| i.contains(&number("1/2"))).expect("met at the nominal value");
    let answer = asked(&model, &request(&model, &["tau"], requirement));
    let factor = answer.value().required[0].factor.as_ref().unwrap();
    let reaches = |factor: &Rational| {
        let [low, high] = answer.value().sides[0].at(factor);
        let is_beyond = |end: &Option<RequiredEnd>, x: &Rational, is_lower: bool| {
            let order = end.as_ref().map(|end| end.value().compare_rational(x));
            order.is_some_and(|order| if is_lower { order.is_ge() } else { order.is_le() })
        };
        is_beyond(&around.lower, &low, true) || is_beyond(&around.upper, &high, false)
    };
    assert!(!reaches(&factor.lower) && reaches(factor.upper.as_ref().unwrap()));
}

/// A box that grows to a sample time of zero ends there; it is not refused.
#[test]
fn a_requirement_over_a_sample_time_ends_where_there_is_no_loop() {
    let model = load(
        "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = '1/10', tolerance = '15%' }\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ngain = 3\n\
         [[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\ntransfer = '2/(s + 1)'\ndiscretize = 'zoh'\n",
    );
    let answer = asked(&model, &request(&model, &["T"], requirement(&model, "phase_margin", "25 deg")));
    let factor = answer.value().factor.as_ref().unwrap();
    // T = 0.1 (1 - 0.15 factor) is zero at 20/3.
    let end = number("20/3");
    assert!(factor.lower < end && &end - &factor.lower < number("1/100"), "{}", factor.lower);
    assert!(answer.value().decision.is_stable());
}

/// A gain and a dead time: the factor is told to a part in ten thousand, with a point at which the margin is less.
#[test]
#[ignore = "long: CI runs it"]
fn a_gain_and_a_dead_time_shrink_to_where_a_margin_ends() {
    let model = example("dead-time-pi");
    for (name, text, least) in tried([("phase_margin", "40", "1.2"), ("modulus_margin", "0.5", "0.44")], 2) {
        let request = ToleranceRequest::new(["K_c", "theta"].map(|name| (name, "10%".parse().unwrap())));
        let answer = asked(&model, &request.require([requirement(&model, name, text)], None));
        let factor = answer.value().factor.as_ref().unwrap();
        let upper = factor.upper.as_ref().unwrap();
        assert!(factor.lower > number(least) && *upper < &factor.lower * &number("1.0002"), "{} {upper}", factor.lower);
        assert!(factor.witness.is_some(), "{name}");
    }
}
