//! Margins of known loops, to the digits of other programs and of computations at sixty digits.

use crate::helpers::model::{example, load};
use crate::helpers::number::number;
use crate::helpers::open_loops::{SERVO_AS_TYPED, loop_of, margins_of, stable};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::model::Model;
use jurist_engine::response::{DelayMargin, Direction, Extreme, Margins, PhaseMargin, Place, Value};
use jurist_show::real;

fn degrees(phase: &PhaseMargin, digits: usize) -> Option<String> {
    real::enclosed(digits, |bits| phase.degrees(bits))
}

/// The frequency of a crossing: the angle, or in radians per unit of time.
fn rate(answer: &Answer<Margins>, place: &Place, digits: usize) -> String {
    let at = |bits| answer.value().frequency(place, bits);
    real::enclosed(digits, |bits| at(bits).and_then(|f| f.angle.or(f.radians_per_second))).expect("a frequency")
}

#[test]
fn half_of_a_delay_has_gain_margin_two() {
    let answer = margins_of(&loop_of("discrete", "0.5", "1, 0"), None);
    let margins = stable(&answer);
    let upper = margins.gain.upper.as_ref().unwrap();
    assert_eq!((upper.value.exact(), upper.causes.to_string().as_str()), (Some(number("2")), "z=-1"));
    assert!(margins.gain.lower.is_none());
    assert_eq!(margins.modulus.exact(), Some(number("1/2")));
    assert_eq!(margins.peak_sensitivity.exact(), Some(number("2")));
    assert_eq!(margins.disk.alpha.as_ref().unwrap().exact(), Some(number("2/3")));
    assert!(matches!(margins.phase, PhaseMargin::Unbounded));
    assert!(matches!(margins.delay, DelayMargin::Unbounded));
    let crossing = &answer.value().crossings.phase[0];
    assert!(matches!(crossing.place, Place::Highest));
    assert!(crossing.factor.enclosure(10).contains(&number("2")));
}

/// The values of mpmath at sixty digits, from the zeros of `|N|^2 - |D|^2` on the circle.
#[test]
fn servo_with_one_sample_of_delay() {
    let model = load(SERVO_AS_TYPED);
    let answer = margins_of(&model, None);
    let margins = stable(&answer);
    let upper = margins.gain.upper.as_ref().unwrap();
    assert_eq!(upper.value.decimal(30), "11.6813631716080951130383729787");
    assert_eq!(margins.gain.lower.as_ref().unwrap().value.exact(), Some(Rational::ZERO));
    assert_eq!(degrees(&margins.phase, 30).unwrap(), "57.0653311557805485721778816476");
    let PhaseMargin::Angle { place: Some(place), .. } = &margins.phase else { panic!("a crossing") };
    assert_eq!(rate(&answer, place, 30), "0.0894978514984041807047126697671");
    assert_eq!(margins.modulus.decimal(30), "0.824835438341139537440944410830");
    assert_eq!(margins.disk.alpha.as_ref().unwrap().decimal(30), "1.08604930807080353984551973463");
    assert!(matches!(margins.delay, DelayMargin::Samples(11)));
    // A signal of the same loop is the same cut.
    for at in ["u", "v", "y", "motor", "computation", "K"] {
        let other = margins_of(&model, Some(at));
        assert!(stable(&other).modulus.is_same(&margins.modulus), "{at}");
        assert_eq!(stable(&other).gain.upper.as_ref().unwrap().value.decimal(60), upper.value.decimal(60), "{at}");
    }
}

/// Loops of python-control's tests, the digits from mpmath: `type0` has a phase margin of 67.598 degrees, where that test
/// says 67.6058 within 0.01.
#[test]
fn continuous_loops_known_to_others() {
    let answer = margins_of(&loop_of("continuous", "2", "1, 3, 3, 1"), None);
    let margins = stable(&answer);
    assert_eq!(margins.gain.upper.as_ref().unwrap().value.exact(), Some(number("4")));
    assert_eq!(degrees(&margins.phase, 30).unwrap(), "67.5980663671908843864750355567");
    assert_eq!(margins.modulus.exact(), Some(number("3/5")));
    let DelayMargin::DeadTime(i) = margins.delay else { panic!("a dead time") };
    let crossing = &answer.value().crossings.gain[i];
    let shape = answer.value().open_loop.shape();
    let delay = real::enclosed(30, |bits| crossing.delay(shape, bits)).unwrap();
    assert_eq!(delay, "1.53937447405077985478178803503");
    assert_eq!(rate(&answer, &crossing.place, 30), "0.766420936540879913058086502299");

    let answer = margins_of(&loop_of("continuous", "1", "1, 2, 3, 4"), None);
    let margins = stable(&answer);
    assert_eq!(margins.gain.upper.as_ref().unwrap().value.exact(), Some(number("2")));
    assert!(matches!(margins.phase, PhaseMargin::Unbounded));
    assert_eq!(margins.modulus.decimal(30), "0.416976176198776094306123804885");

    let answer = margins_of(&loop_of("continuous", "25", "1, 10, 10, 10"), None);
    let margins = stable(&answer);
    assert_eq!(margins.disk.alpha.as_ref().unwrap().decimal(30), "0.458092547741559691813879871465");
    assert_eq!(degrees(&margins.phase, 25).unwrap(), "29.11036913041572224938403");

    // The gain may not fall below a sixteenth.
    let answer = margins_of(&loop_of("continuous", "1, 0.2, 0.01", "1, 1, 0, 0, 0"), None);
    let margins = stable(&answer);
    assert_eq!(margins.gain.lower.as_ref().unwrap().value.exact(), Some(number("1/16")));
    assert!(margins.gain.upper.is_none());

    // |1 + L| falls to 1 and is never 1.
    let answer = margins_of(&loop_of("continuous", "1, 0.1", "1, 1, 0"), None);
    let margins = stable(&answer);
    assert_eq!(margins.modulus.exact(), Some(Rational::ONE));
    assert!(matches!(margins.modulus_at, Extreme::At { attained: false, place: Place::Highest, .. }));
    assert_eq!(degrees(&margins.phase, 25).unwrap(), "144.9031987724154038712959");
}

/// `example21` of python-control's tests: with gain 1 it is unstable, and its second phase crossing is at the factor
/// 179.40612664632, not 179.2931.
#[test]
fn an_unstable_loop_has_crossings_and_no_margins() {
    let with_gain = |k: &str| {
        load(&format!(
            "time = 'continuous'\n[parameters]\nK = {{ nominal = {k} }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\n\
             name = 'L'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*0.002*(s+0.02)*(s+0.05)*(s+5)*(s+10)/((s-0.0005)*(s+0.0001)\
             *(s+0.01)*(s+0.2)*(s+1)*(s+100)^2)'\n"
        ))
    };
    let answer = margins_of(&with_gain("1"), None);
    assert!(answer.value().stable.is_none());
    assert_eq!(answer.value().verdict.count.unwrap().outside, 2);
    let factors: Vec<String> = answer
        .value()
        .crossings
        .phase
        .iter()
        .map(|c| real::enclosed(14, |bits| Some(c.factor.enclosure(bits))).unwrap())
        .collect();
    assert_eq!(factors[1..], ["179.40612664632", "22798.050075093", "15949598.454272", "724786406.25104"]);
    assert_eq!(answer.value().crossings.gain.len(), 1);
    let answer = margins_of(&with_gain("5000"), None);
    let margins = stable(&answer);
    assert_eq!(margins.gain.upper.as_ref().unwrap().value.decimal(20), "4.5596100150186703677");
    assert_eq!(margins.gain.lower.as_ref().unwrap().value.decimal(20), "0.035881225329264743581");
    assert_eq!(degrees(&margins.phase, 20).unwrap(), "21.210131881545414068");
}

#[test]
fn drive_at_both_errors() {
    let drive = example("drive-blocks");
    let refused = drive.ask().margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap_err().to_string();
    assert!(refused.contains("E-cut") || refused.contains("no single loop"), "{refused}");
    // The current controller's error is in both loops, so the factor there is the chopper's gain.
    let answer = margins_of(&drive, Some("current controller"));
    let upper = stable(&answer).gain.upper.clone().unwrap();
    let limit = drive.ask().free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
    let limit = limit.value().intervals()[0].upper.clone().unwrap();
    assert_eq!(upper.value.decimal(40), limit_over_nominal(&limit.value));
    assert_eq!(upper.causes, limit.causes);
    let by_gain = margins_of(&drive, Some("K_pwm"));
    assert!(stable(&by_gain).modulus.is_same(&stable(&answer).modulus));
    // The speed's error is in the outer loop alone.
    let speed = margins_of(&drive, Some("speed controller"));
    assert_ne!(stable(&speed).gain.upper.as_ref().unwrap().value.decimal(20), upper.value.decimal(20));
    assert!(stable(&margins_of(&drive, Some("i_ref"))).modulus.is_same(&stable(&speed).modulus));
}

/// `K_pwm / 110` to forty digits.
fn limit_over_nominal(limit: &jurist_algebra::real::Real) -> String {
    let nominal = number("110");
    real::enclosed(40, |bits| {
        let (lo, hi) = limit.refined(&Rational::dyadic(&1.into(), bits)).enclosure();
        Some(jurist_algebra::number::Enclosure::new(lo / &nominal, hi / &nominal))
    })
    .unwrap()
}

/// The model of `matrix` and of `characteristic` is cut at the gain that enters to the first power; `u = -K y` at `u`.
#[test]
fn other_forms_are_cut_at_a_gain() {
    let drive = margins_of(&Model::drive(), None);
    assert_eq!(drive.value().open_loop.cut().name(), "K_pwm");
    let text = "time = 'discrete'\n[parameters]\nk = { nominal = 2 }\n[loop]\ncharacteristic = 'z^2 - z + k/4'\n";
    let answer = margins_of(&load(text), None);
    assert_eq!(stable(&answer).gain.upper.as_ref().unwrap().value.exact(), Some(number("2")));
    let text =
        "time = 'continuous'\n[loop]\nA = [[0, 1], [0, -1]]\nB = [[0], [1]]\nC = [[1, 0], [0, 1]]\nK = [[2, 1]]\n";
    let feedback = margins_of(&load(text), None);
    let same = margins_of(&loop_of("continuous", "1, 2", "1, 1, 0"), None);
    assert!(stable(&feedback).modulus.is_same(&stable(&same).modulus));
    assert_eq!(degrees(&stable(&feedback).phase, 20), degrees(&stable(&same).phase, 20));
    let text = "time = 'discrete'\n[parameters]\nk = { nominal = 2 }\n[loop]\ncharacteristic = 'z^2 - z + k^2/16'\n";
    let error = load(text).ask().margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap_err().to_string();
    assert!(error.contains("is not a gain"), "{error}");
}

#[test]
fn open_loops_at_the_edge_of_what_has_margins() {
    // L = 1: any factor above -1, 180 degrees, no sample of delay more.
    let answer = margins_of(&loop_of("discrete", "1", "1"), None);
    let margins = stable(&answer);
    assert!(margins.gain.upper.is_none() && margins.gain.lower.is_none());
    assert!(answer.value().crossings.gain_everywhere && answer.value().crossings.phase_everywhere);
    assert_eq!(degrees(&margins.phase, 5).unwrap(), "180");
    assert!(matches!(margins.delay, DelayMargin::Samples(0)));
    assert!(matches!(&margins.modulus_at, Extreme::Constant(Value::Number(x)) if x.exact() == Some(number("4"))));
    assert!(margins.disk.alpha.is_none());
    // L = 1 in continuous time bears no dead time; L = 1/2 bears any.
    let answer = margins_of(&loop_of("continuous", "1, 1", "1, 1"), None);
    assert!(matches!(stable(&answer).delay, DelayMargin::Zero));
    let answer = margins_of(&loop_of("continuous", "1, 1", "2, 2"), None);
    assert!(matches!(stable(&answer).delay, DelayMargin::Unbounded));
    // L(oo) = 3 and no crossing at all, as 3 (s + 10)/(s + 2) of python-control's tests.
    let answer = margins_of(&loop_of("continuous", "3, 30", "1, 2"), None);
    assert!(matches!(stable(&answer).delay, DelayMargin::Zero));
    assert!(matches!(stable(&answer).phase, PhaseMargin::Unbounded));
    assert!(answer.value().crossings.gain.is_empty());
    // L = -1 at all frequencies, here beside a hidden mode: the polynomial vanishes.
    let model =
        load("time = 'discrete'\n[parameters]\nk = { nominal = 1 }\n[loop]\ncharacteristic = '(1 - k)*(z + 1/2)'\n");
    let answer = margins_of(&model, None);
    assert!(answer.value().stable.is_none());
    assert!(answer.value().crossings.gain_everywhere && answer.value().crossings.phase_everywhere);
    // An all-pass of modulus 1 that is -1 at high frequencies: 1 + L loses its degree.
    let text = "time = 'continuous'\n[parameters]\nk = { nominal = 1 }\n[loop]\ncharacteristic = 's + 1 + k*(1 - s)'\n";
    let answer = margins_of(&load(text), None);
    assert!(answer.value().crossings.gain_everywhere && answer.value().stable.is_none());
    assert_eq!(answer.value().verdict.infinite, 1);
    // 1/(z - 1) has modulus one at sixty degrees, where it is exp(-j 120 degrees).
    let answer = margins_of(&loop_of("discrete", "1", "1, -1"), None);
    let crossing = &answer.value().crossings.gain[0];
    assert_eq!(crossing.direction, Direction::Falling);
    assert_eq!(degrees(&stable(&answer).phase, 10).unwrap(), "60");
    // One sample of delay leads to z^2 - z + 1, on the circle.
    assert!(matches!(stable(&answer).delay, DelayMargin::Samples(0)));
    // An integrator's gain may be any above 0.
    assert_eq!(stable(&answer).gain.lower.as_ref().unwrap().value.exact(), Some(Rational::ZERO));
}

#[test]
fn a_signal_without_a_loop_and_an_unknown_one_are_refused() {
    let model = load(SERVO_AS_TYPED);
    let refused =
        |at: &str| model.ask().margins(Some(at), &Rational::ZERO, &Budget::unlimited()).unwrap_err().to_string();
    assert!(refused("w").contains("no signal 'w'"), "{}", refused("w"));
    assert!(refused("T").contains("is not a gain"), "{}", refused("T"));
    let open = load(
        "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r'\noutput = 'y'\ntransfer = '1/z'\n",
    );
    let error = open.ask().margins(Some("y"), &Rational::ZERO, &Budget::unlimited()).unwrap_err().to_string();
    assert!(error.contains("nothing comes back"), "{error}");
}

/// The largest modulus of `T = L/(1 + L)`, from mpmath at sixty digits.
#[test]
fn peak_gains() {
    let budget = Budget::unlimited();
    let peak = |model: &Model| model.ask().norm("r", "y", &budget).unwrap();
    let servo = peak(&load(SERVO_AS_TYPED));
    assert_eq!(servo.value().peak.as_ref().unwrap().value.decimal(30), "1.16393389170524949752779299434");
    let angle = real::enclosed(20, |bits| servo.value().frequency(bits)?.angle).unwrap();
    assert_eq!(angle, "0.061497963235524403124");
    let third = peak(&loop_of("continuous", "25", "1, 10, 10, 10"));
    assert_eq!(third.value().peak.as_ref().unwrap().value.decimal(30), "2.05605852392508170418891511678");
    // (s + 1)/(2 s + 4) grows to 1/2 and does not reach it.
    let approached = peak(&loop_of("continuous", "1, 1", "1, 3"));
    assert!(matches!(approached.value().peak.as_ref().unwrap().extreme, Extreme::At { attained: false, .. }));
    assert_eq!(approached.value().peak.as_ref().unwrap().value.exact(), Some(number("1/2")));
    assert!(peak(&loop_of("discrete", "3", "1, 0")).value().peak.is_none());
}

/// A resonant controller in an outer loop makes the inner open loop zero at the frequency of its poles: twice there, so that the greatest
/// complementary sensitivity was looked for at it, and no enclosures tell zero. The digits are those of the cosine with twenty digits.
#[test]
fn an_inner_loop_beside_a_resonant_controller_of_an_irrational_frequency() {
    let text = |cosine: &str| {
        format!(
            r#"
            time = "discrete"
            [constants]
            c = "{cosine}"
            [loop]
            inputs = ["r"]
            outputs = ["y"]
            [[block]]
            input = "r - y"
            output = "v"
            transfer = "1/5 + 1/20*(z*c - 1)/(z^2 - 2*c*z + 1)"
            [[block]]
            input = "v - x/10"
            output = ["x", "y"]
            A = [["1/2", "1/5"], ["1/3", "1/4"]]
            B = [[1], ["1/2"]]
            "#
        )
    };
    let of = |cosine: &str| margins_of(&load(&text(cosine)), Some("x"));
    let (near, root) = (of("70710678118654752440/100000000000000000000"), of("sqrt(2)/2"));
    let (near, root) = (stable(&near), stable(&root));
    assert_eq!(root.peak_complementary.decimal(15), near.peak_complementary.decimal(15));
    assert_eq!(root.modulus.decimal(15), near.modulus.decimal(15));
}
