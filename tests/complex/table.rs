//! Loops with complex coefficients whose limits are known to many digits: eigenvalues by mpmath at 45 digits, and the sign of a determinant
//! on both sides of each end.

use crate::helpers::model::read;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::answer::Answer;
use jurist_engine::stability::StableSet;

/// A machine's current loop, the voltage held in the frame of the stator.
pub fn machine(advance: &str) -> String {
    format!(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nR = 0.5\nL = 5e-3\nT = 1e-4\nK_i = 1000\n[parameters]\nK_p = 10\n\
         omega_e = {{ nominal = 600, min = 0, max = 12000 }}\n[loop]\ninputs = ['i_ref']\noutputs = ['i']\n[[block]]\n\
         input = 'i_ref - i'\noutput = 'u'\ntransfer = 'K_p + K_i*T/(z - 1)'\n[[block]]\ninput = 'u'\noutput = 'i'\nnum = [1]\n\
         den = ['L', 'R']\ndiscretize = {{ method = 'zoh', frame = 'omega_e', delay = 'T'{advance} }}\n"
    )
}

/// An integrator with a turned gain, after one sample of delay.
pub fn turned(phi: &str) -> String {
    format!(
        "time = 'discrete'\n[constants]\nphi = '{phi}'\n[parameters]\nK = 0.3\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\n\
         input = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(j*phi)/(z*(z - 1))'\n"
    )
}

fn set(text: &str, name: &str, values: &[(&str, i64)]) -> Answer<StableSet> {
    let model = read(text);
    let question = values.iter().fold(model.ask(), |question, (name, value)| question.set(*name, *value));
    question.free(name).stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

/// The ends of the only interval to so many digits, with their causes, and the signed angle or angular frequency to seven.
fn ends(answer: &Answer<StableSet>, digits: usize) -> Vec<(String, String, Option<String>)> {
    let [interval] = answer.value().intervals() else { panic!("{:?}", answer.value()) };
    assert!(answer.value().undecided().is_empty());
    let end = |end: &Option<jurist_engine::stability::End>| {
        let end = end.as_ref().expect("the interval has two ends");
        let place = answer.problem().frequency(end, 60).and_then(|f| f.angle.or(f.radians_per_second));
        (end.value.decimal(digits), end.causes.to_string(), place.map(|p| p.decimal(7).unwrap()))
    };
    vec![end(&interval.lower), end(&interval.upper)]
}

fn root(value: &str, place: &str) -> (String, String, Option<String>) {
    (value.to_owned(), "complex root".to_owned(), Some(place.to_owned()))
}

#[test]
fn speeds_up_to_which_a_machine_is_stable() {
    for (advance, value, place) in [
        (", advance = 'omega_e*T'", "6501.0459220519795245307223528", "0.003277231"),
        ("", "3772.2083602520767938468108066", "0.006152187"),
        (", advance = '1.5*omega_e*T'", "8758.3920531814371014373012835", "-1.074924"),
    ] {
        let answer = set(&machine(advance), "omega_e", &[]);
        assert_eq!(ends(&answer, 29)[1], root(value, place), "{advance}");
    }
}

#[test]
fn gains_of_a_machine_at_high_speed() {
    let answer = set(&machine(""), "K_p", &[("omega_e", 3000)]);
    let expected =
        [root("6.4099472463587523933114082566", "0.007182285"), root("50.227899690142802558169043241", "0.7512593")];
    assert_eq!(ends(&answer, 29), expected);
}

/// `0 < K < 2 sin(pi/6 - |phi|/3)`.
#[test]
fn a_turned_gain() {
    let answer = set(&turned("pi/6"), "K", &[]);
    let found = ends(&answer, 29);
    assert_eq!((found[0].0.as_str(), found[0].1.as_str()), ("0", "z=1"));
    // 2 sin(pi/9), at -2 pi/9.
    assert_eq!(found[1], root("0.68404028665133746608819922936", "-0.6981317"));
    for phi in [-1.5, -1.0, -0.3, 0.2, 0.7, 1.5] {
        let upper = ends(&set(&turned(&phi.to_string()), "K", &[]), 17).remove(1);
        let expected = 2.0 * (std::f64::consts::PI / 6.0 - f64::abs(phi) / 3.0).sin();
        assert!((upper.0.parse::<f64>().unwrap() - expected).abs() < 1e-14, "{phi}: {upper:?}");
        // The gain leads by phi, so that the root below the axis is the first.
        assert_eq!(upper.2.unwrap().starts_with('-'), phi > 0.0, "{phi}");
    }
}

/// `cos(phi)/sin(phi)^2`.
#[test]
fn a_turned_gain_in_continuous_time() {
    let text = turned("pi/6").replace("discrete", "continuous").replace("(z*(z - 1))", "(s*(s + 1))");
    let found = ends(&set(&text, "K", &[]), 28);
    assert_eq!((found[0].0.as_str(), found[0].1.as_str()), ("0", "s=0"));
    assert_eq!(found[1], root("3.464101615137754587054892683", "-1.732051"));
}

/// All roots are inside on both sides of a value at which one touches the circle: the value is no part of the set.
#[test]
fn a_root_that_touches_the_circle() {
    let text = "time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = 'z - (1 - K^2)*(3 + 4*j)/5'\n";
    let answer = set(text, "K", &[]);
    let values: Vec<[String; 2]> = answer
        .value()
        .intervals()
        .iter()
        .map(|i| [&i.lower, &i.upper].map(|e| e.as_ref().unwrap().value.decimal(6)))
        .collect();
    assert_eq!(values, [["-1.41421", "0"], ["0", "1.41421"]]);
    let touched = answer.value().intervals()[0].upper.as_ref().unwrap();
    assert_eq!(touched.causes.to_string(), "complex root");
    assert!(!answer.value().contains(&0.into()));
}

/// A real factor has its roots in pairs, beside a root that comes alone.
#[test]
fn a_pair_of_a_real_factor() {
    let text = "time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = '(z^2 - z + K)*(z - j*K/3)'\n";
    let found = ends(&set(text, "K", &[]), 6);
    assert_eq!((found[0].0.as_str(), found[0].1.as_str()), ("0", "z=1"));
    assert_eq!(found[1], ("1".to_owned(), "complex pair".to_owned(), Some("1.047198".to_owned())));
    // The root that is alone is the first to leave.
    let found = ends(&set(&text.replace("j*K/3", "j*K*2"), "K", &[]), 6);
    assert_eq!(found[1], ("0.5".to_owned(), "complex root".to_owned(), Some("1.570796".to_owned())));
}

/// Counts are those of the loop's own roots.
#[test]
fn counts_of_roots() {
    let verdict = |text: &str, values: &[(&str, i64)]| {
        let model = read(text);
        let question = values.iter().fold(model.ask(), |question, (name, value)| question.set(*name, *value));
        let found = question.verdict(&Budget::unlimited()).unwrap().into_value();
        let count = found.count.unwrap();
        (found.degree, [count.inside, count.on, count.outside])
    };
    assert_eq!(verdict(&machine(""), &[]), (3, [3, 0, 0]));
    assert_eq!(verdict(&machine(""), &[("omega_e", 4000)]), (3, [2, 0, 1]));
    assert_eq!(verdict(&turned("pi/6"), &[]), (2, [2, 0, 0]));
    assert_eq!(verdict(&turned("pi/6"), &[("K", 0)]), (2, [1, 1, 0]));
    assert_eq!(verdict(&turned("pi/6"), &[("K", 5)]), (2, [0, 0, 2]));
}
