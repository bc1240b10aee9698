//! Loops of practice with plants behind a hold, said as they are, every constant that matters free. Limits are those at which
//! the greatest eigenvalue of the sampled loop, assembled by hand with mpmath, has modulus 1.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::{Answer, Verdict};
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;
use jurist_engine::stability::{End, Range, StableSet};
use jurist_show::{Document, Text};

fn read(text: &str) -> Model {
    Model::from_toml(&Source::new("model.toml", text)).unwrap_or_else(|e| panic!("{e}\n{text}")).0
}

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn asked(model: &Model, name: &str, domain: Option<[&str; 2]>) -> Answer<StableSet> {
    let question = model.ask().free(name);
    let question = match domain {
        Some([lo, hi]) => question.domain(name, Range::between(Some(number(lo)), Some(number(hi)))),
        None => question,
    };
    question.stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The ends by their first digits, `oo` where there is none.
fn ends(answer: &Answer<StableSet>, digits: usize) -> Vec<[String; 2]> {
    let shown = |end: &Option<End>| end.as_ref().map_or_else(|| "oo".into(), |e| e.value.decimal(digits));
    answer.value().intervals().iter().map(|i| [shown(&i.lower), shown(&i.upper)]).collect()
}

fn pair(lower: &str, upper: &str) -> [String; 2] {
    [lower.to_owned(), upper.to_owned()]
}

/// That the verdict at these values is what the set says, and that they are decided.
fn agrees(model: &Model, name: &str, answer: &Answer<StableSet>, values: &[&str]) {
    for x in values.iter().map(|x| number(x)) {
        let outside = |b: &jurist_engine::stability::UndecidedBracket| {
            b.lower.as_ref().is_some_and(|lo| x < *lo) || b.upper.as_ref().is_some_and(|hi| *hi < x)
        };
        assert!(answer.value().undecided().iter().all(outside), "{name} = {x} is not decided");
        let verdict = model.ask().set(name, x.clone()).verdict(&Budget::unlimited()).unwrap().into_value().verdict;
        assert_eq!(answer.value().contains(&x), verdict == Verdict::Stable, "{name} = {x}");
    }
}

fn two_mass() -> Model {
    read(include_str!("../../../examples/two-mass-drive.toml"))
}

#[test]
fn a_two_mass_drive_has_its_limits_without_expanded_resultants() {
    let drive = two_mass();
    let answer = asked(&drive, "K_p", None);
    assert_eq!(ends(&answer, 28), [pair("0.01107899804496205409460271440", "4.398098549398780086105704084")]);
    let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
    let frequency = answer.problem().frequency(upper, 80).unwrap();
    assert_eq!(frequency.hertz.unwrap().decimal(6).unwrap(), "736.911");
    let answer = asked(&drive, "K_i", None);
    assert_eq!(ends(&answer, 28), [pair("0", "86.88936220041142519743286688")]);
}

#[test]
fn the_load_the_shaft_and_the_notch_of_a_two_mass_drive_are_questions() {
    let drive = two_mass();
    assert_eq!(ends(&asked(&drive, "J_l", Some(["0.0015", "0.003"])), 6), [pair("0.0015", "0.003")]);
    let stiffness = asked(&drive, "k_s", Some(["10000", "20000"]));
    assert_eq!(ends(&stiffness, 20), [pair("10000", "17528.406587591054279")]);
    let notch = asked(&drive, "w_n", Some(["10", "60"]));
    assert_eq!(ends(&notch, 20), [pair("10", "25.518556409968414531"), pair("35.016425938176934911", "60")]);
}

/// Near half the sampling rate the resonance makes the loop unstable for a while: mpmath's zeros of the greatest
/// eigenvalue's modulus less 1.
#[test]
fn a_resonance_near_half_the_sampling_rate_makes_a_short_unstable_interval() {
    let stiffness = asked(&two_mass(), "k_s", Some(["105000", "107000"]));
    assert_eq!(
        ends(&stiffness, 20),
        [pair("105000", "105322.40396030892005"), pair("106630.56956858969134", "107000")]
    );
}

const SERVO: &str = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nK = { nominal = 4, min = 0 }\n\
    T = { nominal = 0.002, min = 0 }\nT_m = { nominal = 0.05, min = 0 }\nKd = { nominal = 0.02, min = 0 }\n[loop]\n\
    inputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'PD'\ninput = 'r - y'\noutput = 'u'\n\
    transfer = 'K*(1 + Kd*(z - 1)/(T*z))'\n[[block]]\nname = 'computation'\ninput = 'u'\noutput = 'v'\ndelay = 1\n\
    [[block]]\nname = 'motor'\ninput = 'v'\noutput = 'y'\ntransfer = '20/(s*(T_m*s + 1))'\ndiscretize = 'zoh'\n";

#[test]
fn a_servo_is_decided_in_its_gain_its_sample_time_and_its_time_constant() {
    let servo = read(SERVO);
    // python-control at the nominal point: gain margin 11.681 of K = 4.
    assert_eq!(ends(&asked(&servo, "K", None), 28), [pair("0", "46.72545268643256778186599732")]);
    assert_eq!(ends(&asked(&servo, "Kd", None), 28), [pair("0", "0.2657246657952755520184735313")]);
    // The sample time occurs by itself and in the exponential that dies away: decided all the way.
    let times = asked(&servo, "T", None);
    assert!(times.value().undecided().is_empty(), "{:?}", times.value().undecided());
    assert_eq!(ends(&times, 28), [pair("0", "0.01385824887850842509065239085")]);
    let constants = asked(&servo, "T_m", None);
    assert_eq!(ends(&constants, 28), [pair("0.002035468555729002950469554192", "oo")]);
    agrees(&servo, "T_m", &constants, &["0.001", "0.002", "0.003", "1", "1000", "1e6"]);
}

const FOPDT: &str = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nKp = { nominal = 1, min = 0 }\n\
    Ki = { nominal = 0.4 }\nKd = 0.1\nT = { nominal = 0.05, min = 0 }\nL = { nominal = 0.4, min = 0 }\n\
    tau = { nominal = 3, min = 0 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'PID'\ninput = 'r - y'\n\
    output = 'u'\ntransfer = 'Kp + Ki*T*z/(z - 1) + Kd*(z - 1)/(T*z)'\n[[block]]\nname = 'plant'\ninput = 'u'\n\
    output = 'y'\ntransfer = '2/(tau*s + 1)'\ndiscretize = { method = 'zoh', delay = 'L' }\n";

#[test]
fn a_process_with_dead_time_behind_a_hold_is_decided_in_all_its_constants() {
    let process = read(FOPDT);
    assert_eq!(ends(&asked(&process, "Kp", None), 28), [pair("0", "5.964237343157030166455051628")]);
    assert_eq!(ends(&asked(&process, "Ki", None), 28), [pair("0", "3.704202352793592519287199976")]);
    assert_eq!(ends(&asked(&process, "tau", Some(["0.01", "100"])), 24), [pair("0.383194020083395779014545", "100")]);
    // Eight samples at the nominal point; any fraction of a sample in between.
    let delays = asked(&process, "L", Some(["0.33", "0.47"]));
    assert_eq!(ends(&delays, 6), [pair("0.33", "0.47")]);
    agrees(&process, "L", &delays, &["0.34", "0.35", "0.36", "0.4", "0.461"]);
}

fn anti_alias_filter() -> Model {
    let text = include_str!("../../../examples/anti-alias-filter.toml");
    let text = text.replace("T = 1e-4 ", "unused = 1 ").replace("L = 1e-3 ", "spare = 1 ");
    let parameters = "[parameters]\nT = { nominal = 1e-4, min = 0 }\nL = { nominal = 1e-3, min = 0 }";
    read(&text.replace("[parameters]", parameters))
}

#[test]
fn an_anti_alias_filter_is_decided_in_its_controller() {
    let filter = anti_alias_filter();
    assert_eq!(ends(&asked(&filter, "K_p", None), 28), [pair("0", "6.114867829626925016908637849")]);
    assert_eq!(ends(&asked(&filter, "T_i", None), 28), [pair("0.0003795500212897011600696050799", "oo")]);
}

#[test]
fn an_anti_alias_filter_is_decided_in_its_corner_and_the_period() {
    let filter = anti_alias_filter();
    let corner = asked(&filter, "w_f", Some(["3000", "4000"]));
    assert_eq!(ends(&corner, 24), [pair("3425.14023966058718126469", "4000")]);
    let period = asked(&filter, "T", Some(["2e-4", "4e-4"]));
    assert_eq!(ends(&period, 24), [pair("0.0002", "0.000300085417190929061742714")]);
    let inductance = asked(&filter, "L", Some(["3e-4", "1e-3"]));
    assert_eq!(ends(&inductance, 24), [pair("0.000477667319174346523511940", "0.001")]);
}

/// The grid inductance, the sampling period and the gain of an inverter with an undamped filter.
fn inverter(capacitor: &str) -> Model {
    read(&format!(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nL1 = 2e-3\nL2 = 1e-3\nCf = {capacitor}\n[parameters]\n\
         Kp = {{ nominal = 8, min = 0 }}\nLg = {{ nominal = 0.5e-3, min = 0 }}\nT = {{ nominal = 50e-6, min = 0 }}\n[loop]\n\
         inputs = ['i_ref']\noutputs = ['i_g']\n[[block]]\nname = 'controller'\ninput = 'i_ref - i_g'\noutput = 'u'\n\
         gain = 'Kp'\n[[block]]\nname = 'computation'\ninput = 'u'\noutput = 'u_d'\ndelay = 1\n[[block]]\nname = 'filter'\n\
         input = 'u_d'\noutput = 'i_g'\nA = [[0, '-1/L1', 0], ['1/Cf', 0, '-1/Cf'], [0, '1/(L2 + Lg)', 0]]\n\
         B = [['1/L1'], [0], [0]]\nC = [[0, 0, 1]]\ndiscretize = 'zoh'\n"
    ))
}

#[test]
fn an_inverter_is_decided_in_its_gain() {
    // Its resonance is below a sixth of the sampling rate: no gain is stable.
    assert!(ends(&asked(&inverter("10e-6"), "Kp", None), 6).is_empty());
    assert_eq!(ends(&asked(&inverter("2e-6"), "Kp", None), 28), [pair("0", "19.05384847480959333301870470")]);
}

#[test]
fn an_inverter_is_decided_in_the_grid_and_the_period() {
    let slow = asked(&inverter("10e-6"), "T", Some(["1e-4", "1.2e-4"]));
    assert_eq!(ends(&slow, 6)[0][0], "0.000110498");
    let grid = asked(&inverter("2e-6"), "Lg", Some(["2e-4", "1e-3"]));
    agrees(&inverter("2e-6"), "Lg", &grid, &["0.0003", "0.0005", "0.0009"]);
}

const UNDAMPED: &str = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = 0.05, min = 0 }\n[loop]\n\
    inputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'PI'\ninput = 'r - y'\noutput = 'u'\n\
    transfer = '(z - 9/10)/(z - 1)'\n[[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\n\
    transfer = '5/(s^2 + 25)'\ndiscretize = { method = 'zoh', delay = 'T' }\n";

/// At a whole number of periods between two samples the oscillation is not seen: several boundary functions are zero there at once, and
/// no identity says so.
#[test]
fn zeros_that_nothing_tells_apart_leave_a_bracket_and_no_lost_answer() {
    let oscillation = read(UNDAMPED);
    let periods = asked(&oscillation, "T", Some(["0.6", "0.66"]));
    let [bracket] = periods.value().undecided() else { panic!("{:?}", periods.value().undecided()) };
    let (lower, upper) = (bracket.lower.clone().unwrap(), bracket.upper.clone().unwrap());
    let fifth_of_pi = number("0.62831853071795864769252867665590");
    assert!(lower < fifth_of_pi && fifth_of_pi < upper && &upper - &lower < number("1e-15"));
    agrees(&oscillation, "T", &periods, &["0.61", "0.628", "0.629", "0.65"]);
    // The end of a bracket is no limit.
    let [first, _] = periods.value().intervals() else { panic!("{:?}", ends(&periods, 20)) };
    let end = first.upper.as_ref().unwrap();
    assert_eq!((end.causes.to_string().as_str(), end.value.exact()), ("undecided", Some(lower)));
    assert!(!end.causes.is_limit() && end.pair.is_none());
    assert!(periods.text(8).contains("no limit: what lies beyond is undecided"), "{}", periods.text(8));
    let document = serde_json::to_value(periods.json(12)).unwrap();
    let upper = &document["stable"][0]["upper"];
    assert_eq!((&upper["cause"], &upper["margin_factor"]), (&"undecided".into(), &serde_json::Value::Null));
}

/// Where a square root has no value the loop is undefined, also where the root cancels.
#[test]
fn a_square_root_that_cancels_still_has_to_have_a_value() {
    let with = |text: &str| {
        read(&format!("time = 'continuous'\n[parameters]\nK = {{ nominal = 2 }}\n[loop]\ncharacteristic = '{text}'\n"))
    };
    for (text, expected) in [
        ("s + 1 + 0*sqrt(K)", vec![pair("0", "5")]),
        ("s + 1 + sqrt(K - 1) - sqrt(K - 1)", vec![pair("1", "5")]),
        // Defined everywhere: the argument has no change of sign.
        ("s + 1 + 0*sqrt((K - 2)^2)", vec![pair("-3", "5")]),
        // Where it is negative or its denominator is.
        ("s + 1 + 0*sqrt((K + 1)/(K - 2))", vec![pair("-3", "-1"), pair("2", "5")]),
    ] {
        let model = with(text);
        let answer = asked(&model, "K", Some(["-3", "5"]));
        assert_eq!(ends(&answer, 10), expected, "{text}");
        agrees(&model, "K", &answer, &["-2", "-1/2", "1/2", "3/2", "3"]);
    }
}
