//! Continuous loops with complex coefficients and dead time: limits, sides, roots, and what is refused.

use crate::helpers::model::read;
use crate::helpers::program::jurist_with_input;
use jurist::certified::certify_verdict;
use jurist::{Ask, Limits, check};
use jurist_algebra::limits::Budget;
use jurist_engine::answer::DelayedRoots;
use jurist_engine::problem::Problem;
use jurist_engine::stability::StableSet;

/// A machine's current loop in the frame of the rotor, with the dead time of the inverter, in complex form.
fn machine(speed: &str, turn: &str) -> String {
    format!(
        "time = 'continuous'\n[constants]\nR = 0.5\nL = 5e-3\nK_i = 1000\nw = {speed}\n[parameters]\n\
         K_p = {{ nominal = 10, min = 0, max = 100 }}\nT_d = {{ nominal = 1.5e-4, min = 0, max = 1e-3 }}\n[loop]\ninputs = ['i_ref']\n\
         outputs = ['i']\n[[block]]\ninput = 'i_ref - i'\noutput = 'u'\ntransfer = 'K_p + K_i/s'\n[[block]]\ninput = 'u'\noutput = 'i'\n\
         transfer = '{turn}exp(-T_d*s)/(L*s + R + j*w*L)'\n"
    )
}

/// The same with two real signals for each complex one; the turn is a rotation by minus nine hundredths of a radian.
fn in_real_form(speed: &str, is_turned: bool) -> String {
    let command = match is_turned {
        true => ["cos(0.09)*v_d + sin(0.09)*v_q", "cos(0.09)*v_q - sin(0.09)*v_d"],
        false => ["v_d", "v_q"],
    };
    let axis = |axis: &str| {
        format!(
            "[[block]]\ninput = 'r_{axis} - i_{axis}'\noutput = 'v_{axis}'\ntransfer = 'K_p + K_i/s'\n[[block]]\ninput = 'c_{axis}'\n\
             output = 'u_{axis}'\ntransfer = 'exp(-T_d*s)'\n"
        )
    };
    format!(
        "time = 'continuous'\n[constants]\nR = 0.5\nL = 5e-3\nK_i = 1000\nw = {speed}\n[parameters]\n\
         K_p = {{ nominal = 10, min = 0, max = 100 }}\nT_d = {{ nominal = 1.5e-4, min = 0, max = 1e-3 }}\n[loop]\ninputs = ['r_d', 'r_q']\n\
         outputs = ['i_d', 'i_q']\n{}{}[[block]]\ninput = '{}'\noutput = 'c_d'\ngain = 1\n[[block]]\ninput = '{}'\noutput = 'c_q'\ngain = 1\n\
         [[block]]\ninput = ['u_d', 'u_q']\noutput = ['i_d', 'i_q']\nA = [['-R/L', 'w'], ['-w', '-R/L']]\nB = [['1/L', 0], [0, '1/L']]\n",
        axis("d"),
        axis("q"),
        command[0],
        command[1]
    )
}

fn set(text: &str, name: &str) -> (StableSet, std::sync::Arc<Problem>) {
    let answer = read(text).ask().free(name).stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (answer.value().clone(), answer.problem().clone())
}

fn limits(text: &str, name: &str) -> Vec<String> {
    let (set, _) = set(text, name);
    assert!(set.undecided().is_empty(), "{text}");
    set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().map(|end| end.value.decimal(25)).collect()
}

#[test]
fn limits_of_the_real_form() {
    for (speed, turn) in [("600", ""), ("-2500", ""), ("600", "exp(-0.09*j)*")] {
        let complex = limits(&machine(speed, turn), "K_p");
        assert_eq!(complex.len(), 2, "{speed} {turn}");
        assert_eq!(complex, limits(&in_real_form(speed, !turn.is_empty()), "K_p"), "{speed} {turn}");
    }
    assert_eq!(limits(&machine("600", ""), "T_d"), limits(&in_real_form("600", false), "T_d"));
}

/// Against the turn of the frame, and of the mirrored loop on the other side.
#[test]
fn the_side_of_a_root_with_dead_time() {
    let frequency = |speed: &str, turn: &str| {
        let (set, problem) = set(&machine(speed, turn), "K_p");
        let end = set.intervals()[0].upper.as_ref().unwrap();
        let place = problem.frequency(end, 60).unwrap().radians_per_second.unwrap();
        (end.causes.to_string(), place.decimal(7).unwrap())
    };
    assert_eq!(frequency("600", ""), ("complex root".into(), "-10526.37".into()));
    assert_eq!(frequency("-600", ""), ("complex root".into(), "10526.37".into()));
    assert_eq!(frequency("600", "exp(-0.09*j)*"), ("complex root".into(), "9922.560".into()));
}

/// Newton's method in floating point, from other places: the rightmost roots, one by one.
#[test]
#[ignore = "long: CI runs it"]
fn the_rightmost_roots_of_a_complex_loop() {
    let mut printed = jurist_with_input(&["roots", "-"], machine("600", "").as_bytes()).stdout;
    for root in
        ["-91.0072988589 + 28.1071518868 j", "-3176.21257167 - 1187.73099402 j", "-22074.9074766 + 49597.7547495 j"]
    {
        assert!(printed.contains(root), "{root}\n{printed}");
    }
    assert!(!printed.contains("+-") && !printed.contains("a pair"), "{printed}");
    printed = jurist_with_input(&["roots", "-"], machine("600", "exp(-0.09*j)*").as_bytes()).stdout;
    for root in
        ["-93.2580421271 + 29.6200605739 j", "-3269.74070401 - 635.674951218 j", "-22001.6803706 + 48975.1881104 j"]
    {
        assert!(printed.contains(root), "{root}\n{printed}");
    }
    // No factor has s = 0 as a root, and the loop has.
    let at_zero = "time = 'continuous'\n[loop]\ncharacteristic = '(s + 1)*(s + 2) - 2 + j*(1 - exp(-s))'\n";
    let printed = jurist_with_input(&["roots", "-"], at_zero.as_bytes()).stdout;
    assert_eq!(printed.lines().filter(|line| line.trim_start().starts_with("0 ")).count(), 1, "{printed}");
    // A factor with real coefficients has pairs, each of them once.
    let factors = "time = 'continuous'\n[loop]\ncharacteristic = '(s + 1/2*exp(-s))*(s + 1 + j + exp(-s)/4)'\n";
    let real = "time = 'continuous'\n[loop]\ncharacteristic = 's + 1/2*exp(-s)'\n";
    let [both, real] = [factors, real].map(|text| jurist_with_input(&["roots", "-"], text.as_bytes()).stdout);
    let pair = real.lines().find(|line| line.contains("+-")).unwrap().trim();
    let pair: Vec<&str> = pair.split("  ").collect();
    assert_eq!(both.matches(pair[0]).count(), 1, "{both}\n{real}");
    assert!(!both.contains("twice") && !both.contains("2 times"), "{both}");
}

/// Of `D conj(D)` the root at `s = 0` is double where the gain begins: `D` itself is looked at.
#[test]
fn a_gain_that_begins_at_zero() {
    let loop_of = |gain: &str| {
        format!(
            "time = 'continuous'\n[parameters]\nK = {{ nominal = 1, min = 0, max = 6 }}\n[loop]\ncharacteristic = 's*(s + 1) + K*{gain}*exp(-s)'\n"
        )
    };
    let (found, _) = set(&loop_of("exp(j/10)"), "K");
    let ([], [interval]) = (found.undecided(), found.intervals()) else { panic!("{found:?}") };
    let [lower, upper] = [&interval.lower, &interval.upper].map(|end| end.as_ref().unwrap());
    assert_eq!((lower.value.exact(), lower.causes.to_string()), (Some(0.into()), "s=0+domain".into()));
    // The modulus of s (s + 1) at s = -0.7975507 j.
    assert_eq!(upper.value.decimal(11), "1.0201440191");
}

/// Of `D conj(D)` there are twice as many: a verdict is about `D`.
#[test]
fn roots_of_a_complex_loop_are_counted_once() {
    let counts = |function: &str| {
        let text = format!("time = 'continuous'\n[loop]\ncharacteristic = '{function}'\n");
        let found = read(&text).ask().verdict(&Budget::unlimited()).unwrap().into_value();
        let DelayedRoots { on, right, .. } = found.delayed.unwrap();
        (found.degree, on, right)
    };
    // Newton's method finds one root right of the axis, 0.0728 - 2.5190 j.
    assert_eq!(counts("s + 1 + j + 2*exp(-j/3)*exp(-s)"), (1, 0, Some(1)));
    assert_eq!(counts("(s - j)*(s - 2 + j)*(s + 1 + exp(-s)/3)"), (3, 1, Some(1)));
    // One root at s = 0, and two.
    assert_eq!(counts("(s + 1)*(s + 2) - 2 + j*(1 - exp(-s))"), (2, 1, Some(0)));
    assert_eq!(counts("s*((s + 1)*(s + 2) - 2 + j*(1 - exp(-s)))"), (3, 2, Some(0)));
    // The gain of s + 3 + j + exp(-s)/8, beyond the only limit.
    let model = "time = 'continuous'\n[parameters]\na = 1\n[loop]\ncharacteristic = 's + 3 + j - a + exp(-s)/8'\n";
    let printed = jurist_with_input(&["tolerance", "-", "--tol", "a=10%"], model.as_bytes()).stdout;
    assert!(printed.contains(", 1 root to the right just beyond"), "{printed}");
}

/// By boxes: a verdict is a box of one point.
#[test]
fn complex_loops_with_dead_time_are_certified() {
    let (text, budget) = (machine("600", ""), Budget::unlimited());
    let model = read(&text);
    let verdict = certify_verdict(&model.ask().verdict(&budget).unwrap(), &budget).unwrap();
    assert_eq!(
        check(&text, &verdict, &Limits::default()).unwrap().statement,
        "At K_p = 10, T_d = 3/20000, the loop is stable."
    );
    // With another gain of the integrator it is another loop.
    let other = text.replace("K_i = 1000", "K_i = 1e7");
    assert!(check(&other, &verdict, &Limits::default()).is_err());
}
