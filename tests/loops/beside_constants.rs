//! Dead time beside constants that are not rational: limits in closed form, and the sets of loops with rational numbers beside the constants.

use crate::helpers::model::{keeping, read};
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes, Verdict};
use jurist_engine::error::{Code, Error};
use jurist_engine::model::Model;
use jurist_engine::response::{Margins, RequiredInterval, Requirement};
use jurist_engine::stability::plane::boxes::BoxVerdict;
use jurist_engine::stability::{Range, StableSet};

/// Unity feedback of `transfer` with a gain `K`, beside a parameter `L`.
fn feedback(transfer: &str) -> Model {
    feedback_with("{ nominal = 1, min = 0 }", transfer)
}

fn feedback_with(gain: &str, transfer: &str) -> Model {
    read(&format!(
        "time = 'continuous'\n[parameters]\nK = {gain}\nL = {{ nominal = 1, min = '1/10' }}\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'plant'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '{transfer}'\n"
    ))
}

fn set(model: &Model, name: &str) -> StableSet {
    keeping(model, &[name]).stable_set(&Budget::unlimited()).unwrap().into_value()
}

fn within(model: &Model, name: &str, [low, high]: [&str; 2]) -> StableSet {
    let question = keeping(model, &[name]).domain(name, Range::between(Some(number(low)), Some(number(high))));
    question.stable_set(&Budget::unlimited()).unwrap().into_value()
}

/// The finite ends of all intervals.
fn ends(set: &StableSet) -> Vec<String> {
    assert!(set.undecided().is_empty());
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    ends.map(|end| end.value.decimal(7)).map(|text| number(&text).to_string()).collect()
}

#[test]
fn an_integrator_with_a_gain_of_pi_has_its_limit_at_a_rational_number() {
    // K pi/s exp(-s/2): stable below pi/(2/2)
    let model = feedback("pi*exp(-s/2)/s");
    let found = set(&model, "K");
    assert_eq!(ends(&found), ["0", "1"]);
    let at = |value: Rational| model.ask().set("K", value).verdict(&Budget::unlimited());
    let near = number("1e-40");
    assert_eq!(at(Rational::ONE - &near).unwrap().value().verdict, Verdict::Stable);
    assert_eq!(at(Rational::ONE + &near).unwrap().value().verdict, Verdict::Unstable);
    // No bits of pi tell that a root is on the axis.
    match at(Rational::ONE) {
        Err(Error::Stopped(stopped)) => assert!(matches!(stopped.stop, Stop::Precision(_))),
        other => panic!("{:?}", other.map(|verdict| verdict.value().verdict)),
    }
}

/// A transfer function with a square root in it, and the same with a number in its place, `L` being a zero or a pole; and whether the gain may grow
/// without end.
fn random_transfer(random: &mut Random) -> ([String; 2], bool) {
    // The roots with eleven digits.
    let (square, value) =
        [(2, "1.4142135624"), (3, "1.7320508076"), (5, "2.2360679775"), (7, "2.6457513111")][random.below(4)];
    let tau = ratio(1 + random.below(12) as i64, 10);
    let (a, b) = (1 + random.below(4), ratio(1 + random.below(8) as i64, 4));
    let (shape, is_open) = match random.below(4) {
        0 => (format!("exp(-{tau}*s)*#/((s + {a})*(s + #))"), true),
        1 => (format!("exp(-{tau}*s)*(s + L)/(s*(s^2 + {b}*#*s + {a}))"), true),
        2 => (format!("(1 + #*exp(-{tau}*s))/((L*s + 1)*(s + {b}))"), false),
        _ => (format!("exp(-{tau}*s)*L/((#*s - 1)*(s/{a} + 3))"), true),
    };
    ([&format!("sqrt({square})"), value].map(|value| shape.replace('#', value)), is_open)
}

#[test]
fn sets_are_those_of_numbers_beside_the_constants() {
    let mut random = Random::new(20_261_128);
    for _ in 0..count(6, 60) {
        let (transfers, is_open) = random_transfer(&mut random);
        let models = transfers.each_ref().map(|transfer| feedback(transfer));
        let gains = models.each_ref().map(|model| match is_open {
            true => set(model, "K"),
            false => within(model, "K", ["1/100", "20"]),
        });
        assert_eq!(ends(&gains[0]), ends(&gains[1]), "{transfers:?}");
        let zeros = models.each_ref().map(|model| within(model, "L", ["1/5", "8"]));
        assert_eq!(ends(&zeros[0]), ends(&zeros[1]), "{transfers:?}");
    }
}

#[test]
fn boxes_and_tolerances_agree_with_decisions_at_points() {
    let model = feedback("2*pi*exp(-s/4)/(s*(s/(2*pi*L) + 1))");
    let side = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([side("1/10", "2"), side("1/2", "3")], ratio(1, 5));
    let problem = keeping(&model, &["K", "L"]).plane_problem().unwrap();
    let MapOrBoxes::Boxes(map) = problem.map_by(MapMethod::Auto, &request, 6, &Budget::unlimited()).unwrap() else {
        panic!("boxes were expected")
    };
    let mut seen = [0, 0];
    for cell in &map.value().boxes.boxes {
        let middle = [&cell.window.x, &cell.window.y].map(|[low, high]| low.midpoint(high));
        let verdict = model.ask().set("K", middle[0].clone()).set("L", middle[1].clone()).verdict(&Budget::unlimited());
        let stable = verdict.unwrap().value().verdict == Verdict::Stable;
        match cell.verdict {
            BoxVerdict::Stable => assert!(stable, "{middle:?}"),
            BoxVerdict::Unstable { .. } => assert!(!stable, "{middle:?}"),
            _ => continue,
        }
        seen[usize::from(stable)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 2), "{seen:?}");
}

#[test]
fn a_corner_frequency_may_be_the_parameter() {
    // The filter divides by 2 pi L.
    let transfers = ["exp(-s/50)/((s/(2*#*L) + 1)*(3*s/10 + 1)*s)", "exp(-s/50)/(s*(s/(2*#*(L - 2)) + 1))"];
    for (transfer, domain) in transfers.into_iter().zip([["1/10", "30"], ["3", "30"]]) {
        let [own, known] = ["pi", "3.14159265358979"].map(|pi| feedback(&transfer.replace('#', pi)));
        let found = [&own, &known].map(|model| ends(&within(model, "L", domain)));
        assert_eq!(found[0], found[1], "{transfer}");
        assert!(found[0].len() == 2);
    }
}

#[test]
fn functions_of_a_free_name_are_refused() {
    let model = feedback("exp(-s/2)/(s + sqrt(L + 1))");
    let budget = Budget::unlimited();
    match keeping(&model, &["L"]).stable_set(&budget) {
        Err(Error::Refused(refused)) => assert_eq!(refused.code(), Code::DeadTime),
        other => panic!("{:?}", other.map(|_| ())),
    }
    assert!(keeping(&model, &["K"]).stable_set(&budget).is_ok());
}

/// The margins at a gain.
fn margins(model: &Model, gain: &str) -> Margins {
    model.ask().set("K", number(gain)).margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap().into_value()
}

/// All margins, each within a short interval: factors, phase, delay, and the greatest moduli.
fn enclosures(margins: &Margins) -> Vec<Option<Enclosure>> {
    let stable = margins.stable.as_ref().expect("a stable loop");
    let of = |value: &Real| {
        let (low, high) = value.refined_to_digits(20).enclosure();
        Enclosure::new(low, high)
    };
    let mut out: Vec<Option<Enclosure>> =
        [&stable.gain.lower, &stable.gain.upper].map(|end| end.as_ref().map(|end| of(&end.value))).into();
    out.push(stable.phase.degrees(80));
    out.push(margins.delay_seconds(80));
    out.extend(
        [Some(&stable.modulus), Some(&stable.peak_complementary), stable.disk.alpha.as_ref()].map(|v| v.map(of)),
    );
    out
}

#[test]
fn margins_of_an_integrator_with_a_gain_of_pi_are_those_in_closed_form() {
    // Modulus one at pi/2, where the dead time turns by 45 degrees.
    let found = enclosures(&margins(&feedback("pi*exp(-s/2)/s"), "1/2"));
    let known = ["2", "45", "1/2"].map(number);
    for (value, known) in found[1..4].iter().zip(known) {
        let value = value.as_ref().unwrap();
        assert!(value.contains(&known) && value.upper() - value.lower() < number("1e-18"), "{known}");
    }
}

/// With two integrators a double root is at `s = 0` for the factor 0: the set of stable factors is that of the crossings.
#[test]
#[ignore = "long: CI runs it"]
fn margins_with_two_integrators_are_those_of_numbers_beside_the_constants() {
    let near = number("1e-7");
    for (shape, gain) in [
        ("(1 + 2/(5*s))*exp(-7/11*s)/(s*(s + 3/2*#))", "1/7"),
        ("(s + 1/9)*exp(-s/5)/(s^2*(s/#/4 + 1))", "1"),
        ("-(s + 1/9)*exp(-s/5)/(s^2*(s/#/4 + 1))", "-1"),
    ] {
        let [own, known] =
            ["sqrt(2)", "1.4142135624"].map(|root| margins(&feedback_with("1", &shape.replace('#', root)), gain));
        let factors = [&own, &known].map(|margins| ends(&margins.stable.as_ref().unwrap().gain.set));
        assert!(factors[0] == factors[1] && factors[0].len() == 2, "{shape} {factors:?}");
        for (a, b) in enclosures(&own).iter().zip(&enclosures(&known)) {
            let [a, b] = [a, b].map(|e| e.as_ref().expect("a value").lower());
            assert!((a - b).abs() < &near * &(Rational::ONE + a.abs()), "{shape} {a} {b}");
        }
    }
}

#[test]
fn margins_and_peaks_are_those_of_numbers_beside_the_constants() {
    let mut random = Random::new(20_261_129);
    let near = number("1e-7");
    let is_near =
        |a: &Enclosure, b: &Enclosure| (a.lower() - b.lower()).abs() < &near * &(Rational::ONE + a.lower().abs());
    let mut seen = 0;
    for _ in 0..count(4, 80) {
        let (transfers, _) = random_transfer(&mut random);
        let models = transfers.each_ref().map(|transfer| feedback(transfer));
        let gain = ["1/10", "1/3", "1"][random.below(3)];
        let found = models.each_ref().map(|model| {
            let question = model.ask().set("K", number(gain));
            question.margins(None, &Rational::ZERO, &Budget::unlimited()).map(|answer| answer.into_value())
        });
        let [Ok(own), Ok(known)] = found else {
            assert!(found.iter().all(Result::is_err), "{transfers:?}");
            continue;
        };
        let phases = [&own, &known].map(|margins| margins.crossings.phase.len());
        assert!(phases[0] == phases[1] && own.stable.is_some() == known.stable.is_some(), "{transfers:?}");
        if own.stable.is_none() {
            continue;
        }
        seen += 1;
        let peak = |model: &Model| {
            let answer = model.ask().set("K", number(gain)).norm("r", "y", &Budget::unlimited()).unwrap();
            let (low, high) = answer.value().peak.as_ref().unwrap().value.refined_to_digits(20).enclosure();
            Some(Enclosure::new(low, high))
        };
        let both = [(&own, &models[0]), (&known, &models[1])].map(|(margins, model)| {
            let mut all = enclosures(margins);
            all.push(peak(model));
            all
        });
        let factors = [&own, &known].map(|margins| ends(&margins.stable.as_ref().unwrap().gain.set));
        assert_eq!(factors[0], factors[1], "{transfers:?} {gain}");
        for (a, b) in both[0].iter().zip(&both[1]) {
            match (a, b) {
                (Some(a), Some(b)) => assert!(is_near(a, b), "{transfers:?} {gain} {a:?} {b:?}"),
                (None, None) => {}
                _ => panic!("{transfers:?} {gain}"),
            }
        }
    }
    assert!(seen > count(4, 80) / 4, "{seen}");
}

#[test]
#[ignore = "long: CI runs it"]
fn sets_with_requirements_are_those_of_numbers_beside_the_constants() {
    let transfers = ["2*sqrt(3)*exp(-s/5)/(s*(s/sqrt(3) + 1))", "2*1.73205080757*exp(-s/5)/(s*(s/1.73205080757 + 1))"];
    let models = transfers.map(feedback);
    let required = [
        Requirement::modulus_margin(ratio(1, 2)).unwrap(),
        Requirement::phase_margin(&Rational::from(40)).unwrap(),
        Requirement::delay_margin(ratio(1, 10)).unwrap(),
    ];
    for requirement in &required {
        let found = models.each_ref().map(|model| {
            let problem = keeping(model, &["K"]).problem().unwrap();
            let set = problem.required_set(std::slice::from_ref(requirement), None, &Budget::unlimited()).unwrap();
            let ends = |interval: &RequiredInterval| {
                [&interval.lower, &interval.upper].map(|end| end.as_ref().map(|end| end.value().decimal(7)))
            };
            set.value().intervals.iter().map(ends).collect::<Vec<_>>()
        });
        assert!(!found[0].is_empty() && found[0] == found[1], "{} {found:?}", requirement.name());
    }
}

#[test]
fn a_delay_margin_of_an_integrator_with_a_gain_of_pi_is_required_up_to_a_rational_gain() {
    // pi K/s has the delay margin 1/(2 K), with dead time of 1/20 less by it.
    let least = [Requirement::delay_margin(ratio(1, 4)).unwrap()];
    for (transfer, end) in [("pi/s", "2.00000000000"), ("pi*exp(-s/20)/s", "1.66666666667")] {
        let problem = keeping(&feedback(transfer), &["K"]).problem().unwrap();
        let set = problem.required_set(&least, None, &Budget::unlimited()).unwrap();
        let [interval] = set.value().intervals.as_slice() else { panic!("{:?}", set.value()) };
        assert_eq!(interval.upper.as_ref().unwrap().value().decimal(12), end);
        assert!(interval.upper.as_ref().unwrap().is_closed());
    }
}

#[test]
fn roots_are_those_of_numbers_beside_the_constants() {
    let mut random = Random::new(20_261_130);
    let budget = Budget::unlimited();
    for _ in 0..count(6, 60) {
        let (transfers, _) = random_transfer(&mut random);
        let found = transfers.each_ref().map(|transfer| {
            let answer = feedback(transfer).ask().problem().unwrap().rightmost_roots(5, 12, &budget);
            answer.unwrap_or_else(|why| panic!("{transfer} {why}")).into_value().list
        });
        let near = number("1e-7");
        for (a, b) in found[0].iter().zip(&found[1]).take(5) {
            let size = Rational::ONE + a.disc.re.abs() + &a.disc.im;
            let apart = (&a.disc.re - &b.disc.re).abs() + (&a.disc.im - &b.disc.im).abs();
            assert!(apart < &size * &near && a.disc.is_pair == b.disc.is_pair, "{transfers:?}");
        }
    }
}

#[test]
fn a_root_at_zero_beside_constants_is_told_exactly() {
    let model = feedback("pi*s*exp(-s/5)/(s*(s + sqrt(2)))");
    let roots = model.ask().problem().unwrap().rightmost_roots(3, 12, &Budget::unlimited()).unwrap().into_value().list;
    assert!(roots[0].disc.re.is_zero() && roots[0].disc.im.is_zero() && roots[0].disc.radius.is_zero());
    assert!(roots.len() > 2 && roots[1].disc.re.is_negative());
}

/// The program counts the roots of a factor with rational coefficients exactly, on the axis as well.
#[test]
fn a_factor_without_constants_is_judged_exactly() {
    let loop_of = |factor: &str| {
        let function = format!("({factor})*(s + K*pi*exp(-s))");
        read(&format!("time = 'continuous'\n[parameters]\nK = '1/4'\n[loop]\ncharacteristic = '{function}'\n"))
    };
    for (factor, [on, outside]) in
        [("1", [0, 0]), ("s^2 + 4", [2, 0]), ("(s - 1)*(s + 1)*s^2", [2, 1]), ("s + 1", [0, 0])]
    {
        let model = loop_of(factor);
        let roots = model.ask().verdict(&Budget::unlimited()).unwrap().into_value().delayed.unwrap();
        assert_eq!((roots.on, roots.right), (on, Some(outside)), "{factor}");
        let set = within(&model, "K", ["1/100", "1"]);
        assert!(set.undecided().is_empty(), "{factor}");
        assert_eq!(set.contains(&number("1/4")), on + outside == 0, "{factor}");
        assert!(!set.contains(&number("3/4")), "{factor}");
    }
    let roots = loop_of("s^2 + 4").ask().problem().unwrap().rightmost_roots(2, 12, &Budget::unlimited()).unwrap();
    let first = &roots.into_value().list[0].disc;
    assert!(first.is_pair && first.re.abs() < number("1e-20") && (&first.im - &number("2")).abs() < number("1e-20"));
}

/// The modulus of the open loop goes to pi/10 from below: where stability ends is not known, and no word is of complex loops.
#[test]
fn margins_of_a_neutral_loop_stay_undecided_in_their_own_words() {
    let model = feedback("s*pi/10*exp(-s)/(s + 1)");
    let found = model.ask().set("K", Rational::ONE).margins(None, &Rational::ZERO, &Budget::unlimited());
    assert!(matches!(found, Err(Error::Stopped(_))), "{found:?}");
}
