//! Requirements on margins: sets of a parameter, against an independent decision at many points.

use crate::helpers::model::{example, load};
use crate::helpers::number::{number, ratio};
use crate::helpers::open_loops::{CONDITIONAL, RESONANT, SERVO};
use crate::helpers::random::Random;
use crate::helpers::required::{Known, is_met};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::answer::Answer;
use jurist_engine::model::Model;
use jurist_engine::response::{RequiredEnd, RequiredSet, Requirement, Requirements};
use jurist_show::documents::Intervals;

fn required(model: &Model, name: &str, at: Option<&str>, requirements: &[Requirement]) -> Answer<RequiredSet> {
    let problem = model.ask().free(name).problem().unwrap();
    problem.required_set(requirements, at, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

fn contains(set: &RequiredSet, x: &Rational) -> bool {
    let inside = |end: &RequiredEnd, above: bool| {
        let order = end.value().compare_rational(x);
        let closed = matches!(end, RequiredEnd::Requirement { closed: true, .. });
        if order.is_eq() { closed } else { order.is_lt() == above }
    };
    set.intervals
        .iter()
        .any(|i| i.lower.as_ref().is_none_or(|l| inside(l, true)) && i.upper.as_ref().is_none_or(|u| inside(u, false)))
}

#[test]
fn sets_of_a_gain_agree_with_a_second_decision_at_random_points() {
    let mut random = Random::new(7);
    for (text, name, scale) in [(SERVO, "K", 12), (CONDITIONAL, "K", 300), (RESONANT, "a", 8)] {
        let model = load(text);
        for (requirement, known) in [
            (Requirement::phase_margin(&number("60")), Known::Phase(ratio(1, 3))),
            (Requirement::phase_margin(&number("90")), Known::Phase(ratio(1, 1))),
            (Requirement::gain_margin(&number("2")), Known::Gain(number("2"))),
            (Requirement::gain_margin(&number("5/4")), Known::Gain(number("5/4"))),
            (Requirement::modulus_margin(number("1/2")), Known::Circle([1, 0], number("1/2"))),
            (Requirement::modulus_margin(number("3/4")), Known::Circle([1, 0], number("3/4"))),
            (Requirement::complementary_peak(number("5/4")), Known::Circle([0, 1], number("4/5"))),
            (Requirement::disk_margin(number("3/4")), Known::Circle([1, -1], number("3/8"))),
            (Requirement::complementary_peak(number("2")), Known::Circle([0, 1], number("1/2"))),
        ] {
            let requirement = requirement.unwrap();
            let answer = required(&model, name, None, &[requirement]);
            for _ in 0..12 {
                let x = ratio(random.below(100_000) as i64 * scale, 100_000);
                assert_eq!(contains(answer.value(), &x), is_met(&model, &[(name, &x)], None, &known), "{text} {x}");
            }
            // On both sides of each end, as near as 1e-20.
            for end in answer.value().intervals.iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
                let RequiredEnd::Requirement { value, .. } = end else { continue };
                let (lo, hi) = value.refined(&number("1e-21")).enclosure();
                let (below, above) = (lo - number("1e-20"), hi + number("1e-20"));
                let met = [&below, &above].map(|x| is_met(&model, &[(name, x)], None, &known));
                assert_eq!(met, [&below, &above].map(|x| contains(answer.value(), x)), "{text} {}", value.decimal(12));
                assert_ne!(met[0], met[1], "{text} {}", value.decimal(12));
            }
        }
    }
}

fn ends(set: &RequiredSet) -> Vec<Option<Real>> {
    set.intervals
        .iter()
        .flat_map(|i| [i.lower.as_ref().map(RequiredEnd::value), i.upper.as_ref().map(RequiredEnd::value)])
        .collect()
}

#[test]
fn angles_and_decibels_that_are_not_rational() {
    let model = load(SERVO);
    let budget = Budget::unlimited();
    let angle = Requirement::phase_margin(&number("45")).unwrap();
    let decibels = Requirement::gain_margin_in_decibels(&number("6"), &budget).unwrap();
    let both = required(&model, "K", None, &[angle.clone(), decibels.clone()]);
    let one = required(&model, "K", None, &[angle]);
    // At the end the phase margin is 45 degrees.
    let end = ends(one.value())[1].clone().unwrap();
    let (lo, hi) = end.refined(&number("1e-30")).enclosure();
    let degrees = |k: Rational| {
        let margins = model.ask().set("K", k).margins(None, &Rational::ZERO, &budget).unwrap();
        let phase = margins.value().stable.as_ref().unwrap().phase.clone();
        jurist_show::real::enclosed(20, |bits| phase.degrees(bits)).unwrap()
    };
    assert_eq!([degrees(lo), degrees(hi)], ["45.000000000000000000", "45.000000000000000000"].map(String::from));
    assert!(ends(both.value())[1].clone().unwrap().compare(&end, &budget).unwrap().is_le());
    // A factor of 10^(6/20) below the limit of stability.
    let gain = required(&model, "K", None, &[decibels]);
    let limit = model.ask().free("K").stable_set(&budget).unwrap();
    let limit = limit.value().intervals()[0].upper.as_ref().unwrap().value.decimal(20);
    let found = ends(gain.value())[1].clone().unwrap().decimal(20);
    let factor = limit.parse::<f64>().unwrap() / found.parse::<f64>().unwrap();
    assert!((factor - 10f64.powf(0.3)).abs() < 1e-12, "{factor}");
}

/// `s^2 + 2 s + K`: with damping 1/2 the natural frequency is 2, so `K` is 4 at most.
#[test]
fn damping_of_a_pair() {
    let model = load(
        "time = 'continuous'\n[parameters]\nK = { nominal = 2, min = 0 }\n[loop]\ncharacteristic = 's^2 + 2*s + K'\n",
    );
    let answer = required(&model, "K", None, &[Requirement::damping(number("1/2")).unwrap()]);
    let [only] = answer.value().intervals.as_slice() else { panic!("{answer:?}") };
    let upper = only.upper.as_ref().unwrap();
    assert_eq!(upper.value().exact(), Some(number("4")));
    assert!(matches!(upper, RequiredEnd::Requirement { closed: true, names, .. } if names == &["damping"]));
    assert!(matches!(only.lower, Some(RequiredEnd::Stability(_))));
}

#[test]
fn the_drive_with_forty_five_degrees_at_its_current_error() {
    let drive = example("drive-blocks");
    let angle = Requirement::phase_margin(&number("45")).unwrap();
    let answer = required(&drive, "K_pwm", Some("current controller"), &[angle]);
    let stable = drive.ask().free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
    let limit = &stable.value().intervals()[0].upper.as_ref().unwrap().value;
    assert!(ends(answer.value()).iter().flatten().all(|end| end.compare(limit, &Budget::unlimited()).unwrap().is_lt()));
    let document = Intervals::of_required(&answer, &[Requirement::phase_margin(&number("45")).unwrap()], 12);
    assert_eq!(document.require[0].required, "45 deg");
}

/// `[require]` with a settling time: in discrete time the radius `exp(-4 T/time)`, which is not algebraic.
#[test]
fn a_settling_time_is_a_radius_that_is_not_algebraic() {
    // z^2 - z/2 + K has roots of modulus sqrt(K) for K > 1/16: K <= exp(-8 T/time).
    let text = "time = 'discrete'\nsample_time = 0.1\n[parameters]\nK = { nominal = 0.1, min = 0 }\n[loop]\n\
                characteristic = 'z^2 - z/2 + K'\n[require]\nsettling_time = 4\n";
    let model = load(text);
    let budget = Budget::unlimited();
    let problem = model.ask().free("K").problem().unwrap();
    let asked = Requirements::of(&model, &[], problem.set(), &budget).unwrap();
    assert_eq!(asked.list[0].text(), "settling_time <= 4");
    let answer = required(&model, "K", None, &asked.list);
    let [only] = answer.value().intervals.as_slice() else { panic!("{answer:?}") };
    let upper = only.upper.as_ref().unwrap();
    // exp(-1/5)
    assert_eq!(upper.value().decimal(30), "0.818730753077981858669935508619");
    assert!(matches!(upper, RequiredEnd::Requirement { names, .. } if names == &["settling_time"]));
    let met = |k: &str| {
        let problem = model.ask().set("K", number(k)).problem().unwrap();
        problem.requirements_met(&asked.list, None, &budget).unwrap()[0].met
    };
    assert!(met("0.8187307530") && !met("0.8187307531"));
    // In continuous time it is a decay rate, and the greater of two counts.
    let text = "time = 'continuous'\n[parameters]\nK = { nominal = 2, min = 0 }\n[loop]\ncharacteristic = 's^2 + 4*s + K'\n\
                [require]\nsettling_time = 4\ndecay = 0.25\n";
    let model = load(text);
    let asked = Requirements::of(&model, &[], &[], &budget).unwrap();
    let set = model.ask().free("K").within(asked.region.unwrap()).stable_set(&budget).unwrap();
    // s = -1: 1 - 4 + K = 0
    assert_eq!(set.value().intervals()[0].lower.as_ref().unwrap().value.exact(), Some(number("3")));
}

/// A pair whose damping falls with its modulus `r`, at a fixed angle.
#[test]
fn the_damping_of_a_sampled_pair() {
    // z^2 - 2 r cos(phi) z + r^2 with cos(phi) = 3/5: phi = 0.9272952180016122, r = exp(-c phi), c = 1/sqrt(3) for damping 1/2.
    let model = load(
        "time = 'discrete'\n[parameters]\nr = { nominal = 0.5, min = 0, max = 1 }\n[loop]\n\
         characteristic = 'z^2 - 6/5*r*z + r^2'\n",
    );
    let requirement = Requirement::damping(number("1/2")).unwrap();
    let answer = required(&model, "r", None, std::slice::from_ref(&requirement));
    let [only] = answer.value().intervals.as_slice() else { panic!("{answer:?}") };
    let upper = only.upper.as_ref().unwrap();
    // exp(-acos(3/5)/sqrt(3)), by mpmath at 50 digits; not algebraic.
    assert_eq!(upper.value().decimal(30), "0.585450206638079748222324676334");
    assert!(matches!(upper, RequiredEnd::Requirement { names, closed: true, .. } if names == &["damping"]));
    assert!(matches!(only.lower, Some(RequiredEnd::Stability(_))));
    let budget = Budget::unlimited();
    for (r, expected) in [("0.585", true), ("0.586", false)] {
        let problem = model.ask().set("r", number(r)).problem().unwrap();
        assert_eq!(
            problem.requirements_met(std::slice::from_ref(&requirement), None, &budget).unwrap()[0].met,
            expected,
            "{r}"
        );
    }
}

/// With direct feedthrough the connection of blocks divides by the gain; cut at the gain or at its output the loop is the same.
#[test]
fn a_cut_at_a_gain_beside_direct_feedthrough_has_the_sets_of_the_cut_at_its_output() {
    for (time, transfer) in [
        ("continuous", "(s^2 + L*s + 3)/((s - 1)*(s + 2))"),
        ("continuous", "(2*s + L)/(s + 1)"),
        ("discrete", "(z^2 + L*z/4 + 1/3)/(2*z*(z - 1/2))"),
    ] {
        let model = load(&format!(
            "time = '{time}'\n[parameters]\nK = {{ nominal = 1, min = '1/10', max = 10 }}\nL = {{ nominal = 1, min = 0, max = 10 }}\n[loop]\n\
             inputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n[[block]]\ninput = 'u'\noutput = 'y'\n\
             transfer = '{transfer}'\n"
        ));
        let mut ends = 0;
        for requirement in [
            Requirement::phase_margin(&number("40")),
            Requirement::gain_margin(&number("5/4")),
            Requirement::modulus_margin(number("1/2")),
            Requirement::disk_margin(number("1/2")),
        ] {
            let requirement = [requirement.unwrap()];
            for name in ["K", "L"] {
                let set = |at: &str| {
                    let answer = required(&model, name, Some(at), &requirement);
                    let end = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().decimal(20));
                    answer.value().intervals.iter().map(|i| [end(&i.lower), end(&i.upper)]).collect::<Vec<_>>()
                };
                let [at_gain, at_signal] = ["K", "u"].map(set);
                assert_eq!(at_gain, at_signal, "{transfer}: {} in {name}", requirement[0].text());
                ends += at_gain.len();
            }
        }
        assert!(ends > 3, "{transfer}: {ends}");
    }
}
