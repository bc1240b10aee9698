//! Laws of plants behind pulses and of loops with several rates, which hold whatever the numbers are; and the headline that names both.

use super::pwm::{ends, set};
use super::rates::position;
use crate::helpers::program::{jurist, jurist_with_input};
use crate::helpers::thorough::is_thorough;
use jurist_algebra::number::Rational;

/// The only interval's upper end, in floating point.
fn upper(text: &str) -> f64 {
    ends(&set(text, "K"), 17)[1].parse().unwrap()
}

/// At an end with a root at -1 the reciprocal of the gain is linear in what a pulse leaves in the state. That of the hold is the mean over all
/// duty ratios, whatever edges move. Gauss and Legendre's rule with five points leaves less than 1e-9 of it.
#[test]
fn the_hold_is_the_mean_over_all_duty_ratios() {
    let text = |how: &str| {
        format!(
            "time = 'discrete'\nsample_time = '1/2'\n[parameters]\nK = {{ nominal = 1, min = 0 }}\n[loop]\ninputs = ['r']\n[[block]]\n\
             input = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/((s + 1)*(s + 3))'\ndiscretize = {how}\n"
        )
    };
    let sum = |how: &str| 1.0 / upper(&text(how).replace("1/((s + 1)*(s + 3))", "1/(s + 3)"));
    let (outer, inner) = (0.906_179_845_938_664, 0.538_469_310_105_683_1);
    let (side, near, middle) = (0.236_926_885_056_189_1, 0.478_628_670_499_366_5, 128.0 / 225.0);
    let points = [(-outer, side), (-inner, near), (0.0, middle), (inner, near), (outer, side)];
    let hold = sum("'zoh'");
    for edge in ["trailing", "leading", "double", "double-ends"] {
        let pulse = |x: f64| format!("{{ method = 'pwm', edge = '{edge}', duty = '{}' }}", (1.0 + x) / 2.0);
        let mean: f64 = points.iter().map(|(x, weight)| weight / 2.0 * sum(&pulse(*x))).sum();
        assert!((mean / hold - 1.0).abs() < 1e-9, "{edge}: {mean}, {hold}");
        if edge == "trailing" {
            assert!((sum(&pulse(outer)) / hold - 1.0).abs() > 0.1, "it depends on the duty ratio");
        }
    }
}

/// The coefficients of the characteristic polynomial, from the constant one on, divided by the leading one.
fn coefficients(text: &str, set: &[&str]) -> Vec<Rational> {
    let mut words = vec!["charpoly", "-"];
    set.iter().for_each(|value| words.extend(["--set", value]));
    let run = jurist_with_input(&words, text.as_bytes());
    assert_eq!(run.status, 0, "{}\n{text}", run.stderr);
    let value = |line: &str| line.strip_prefix("a_").map(|rest| rest.split(" = ").nth(1).unwrap().parse().unwrap());
    let all: Vec<Rational> = run.stdout.lines().filter_map(value).collect();
    all.iter().map(|c| c / all.last().unwrap()).collect()
}

/// Of a chain of three integrators the columns are polynomials of degree 2 in the duty ratio, and so are the coefficients: an open rule of
/// three points is exact.
#[test]
fn the_hold_of_integrators_is_the_mean_exactly() {
    let at = |how: &str| {
        let text = format!(
            "time = 'discrete'\nsample_time = '1/2'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'K*(r - y)'\n\
             output = 'y'\nA = [[0, 1, 0], [0, 0, 1], [0, 0, 0]]\nB = [[0], [0], [1]]\nC = [[5, 2, 1]]\ndiscretize = {how}\n"
        );
        coefficients(&text, &["K=1"])
    };
    let third = |k: i64| Rational::from(k) / Rational::from(3);
    for edge in ["trailing", "leading", "double", "double-ends"] {
        let pulse = |quarters: i64| at(&format!("{{ method = 'pwm', edge = '{edge}', duty = '{quarters}/4' }}"));
        let (a, b, c) = (pulse(1), pulse(2), pulse(3));
        let mean = |i: usize| &a[i] * &third(2) - &b[i] * &third(1) + &c[i] * &third(2);
        assert_eq!((0..a.len()).map(mean).collect::<Vec<_>>(), at("'zoh'"), "{edge}");
        assert_ne!(a, b, "{edge}");
    }
}

#[test]
fn a_rate_of_one_is_none() {
    for words in [
        &["intervals", "-", "--param", "K_p", "--json"][..],
        &["verdict", "-"],
        &["charpoly", "-"],
        &["margins", "-", "--at", "u"],
        &["simulate", "-"],
    ] {
        let [plain, one] = ["", "every = 1"].map(|rate| jurist_with_input(words, position(rate).as_bytes()));
        assert_eq!((one.status, one.stdout), (plain.status, plain.stdout), "{words:?}");
    }
}

/// Without the slow loop the roots over a hyperperiod are powers of those of the fast one.
#[test]
fn without_the_slow_loop_fast_roots_are_powers() {
    // The fast loop of the speed: its root is 1 - K_v, and that of the position 1. The register of the slow block adds a root at 0.
    for (rate, n) in [("every = 2", 2), ("every = 3", 3), ("every = 5\nphase = 2", 5)] {
        let root: Rational = (0..n).fold(Rational::ONE, |power, _| power * Rational::from(2) / Rational::from(3));
        let found = coefficients(&position(rate), &["K_p=0", "K_v=1/3"]);
        let zeros = found.len() - 3;
        assert!(found[..zeros].iter().all(Rational::is_zero), "{rate}: {found:?}");
        assert_eq!(found[zeros..], [root.clone(), -(root + Rational::ONE), Rational::ONE], "{rate}");
    }
}

/// The fast loop over all samples of a hyperperiod is one plant for the slow controller: its matrices are summed up here.
#[test]
fn the_fast_loop_over_a_hyperperiod_is_the_plant_of_one_rate() {
    let number = |text: &str| text.parse::<Rational>().unwrap();
    // x+ = F x + g w_ref, with x = (y, w) and K_v = 1/2.
    let f = [["1", "3/4"], ["0", "1/2"]].map(|row| row.map(number));
    let g = ["1/4", "1/2"].map(number);
    let times = |x: &[Rational; 2]| [0, 1].map(|i| &f[i][0] * &x[0] + &f[i][1] * &x[1]);
    for n in [2, 3, 7] {
        let mut power = [["1", "0"], ["0", "1"]].map(|column| column.map(number));
        let (mut term, mut sum) = (g.clone(), [Rational::ZERO, Rational::ZERO]);
        for _ in 0..n {
            sum = [0, 1].map(|i| &sum[i] + &term[i]);
            term = times(&term);
            power = [times(&power[0]), times(&power[1])];
        }
        let entry = |i: usize, j: usize| format!("'{}'", power[j][i]);
        let lifted = format!(
            "time = 'discrete'\n[parameters]\nK_p = {{ nominal = 0.1, min = 0 }}\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'K_p*(r - y)'\n\
             output = 'y'\nA = [[{}, {}], [{}, {}]]\nB = [['{}'], ['{}']]\nC = [[1, 0]]\n",
            entry(0, 0),
            entry(0, 1),
            entry(1, 0),
            entry(1, 1),
            sum[0],
            sum[1]
        );
        let slow = position(&format!("every = {n}")).replace("K_v = 1\n", "K_v = 0.5\n");
        assert_eq!(ends(&set(&slow, "K_p"), 40), ends(&set(&lifted, "K_p"), 40), "{n}");
        let one = coefficients(&slow, &["K_p=1/7", "K_v=1/2"]);
        let other = coefficients(&lifted, &["K_p=1/7"]);
        let zeros = one.len() - other.len();
        assert!(one[..zeros].iter().all(Rational::is_zero) && one[zeros..] == other, "{n}: {one:?}, {other:?}");
    }
}

/// A motor with an integrating controller at once and twice its period: eigenvalues of events stepped one by one, with 45 digits.
#[test]
fn a_controller_at_half_the_rate_of_its_filter() {
    for (rate, end) in [("", "101.66640558580195283384837"), ("every = 2", "89.050828191757871620437022")] {
        let text = format!(
            "time = 'discrete'\nsample_time = 1e-3\n[parameters]\nK = {{ nominal = 1, min = 0 }}\n[loop]\ninputs = ['r']\n[[block]]\n\
             input = 'r - m'\noutput = 'u'\ntransfer = 'K*(1 + 0.005*z/(z - 1))'\n{rate}\n[[block]]\ninput = 'u'\noutput = 'y'\n\
             transfer = '100/(s*(s + 20))'\ndiscretize = 'zoh'\n[[block]]\ninput = 'y'\noutput = 'm'\ntransfer = '0.5*z/(z - 0.5)'\n"
        );
        assert_eq!(ends(&set(&text, "K"), 26)[1], end, "{rate}");
    }
}

/// The place of the ends, beside their values.
#[test]
fn limits_of_the_drive_have_their_frequencies() {
    let upper = |arguments: &[&str], text: &str| {
        let run = jurist_with_input(arguments, text.as_bytes());
        let document: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let ends = document["stable"][0].clone();
        [&ends["lower"], &ends["upper"]].map(|end| (end["frequency_hz"].as_f64(), end["angle"].as_f64()))
    };
    if is_thorough() {
        let drive = crate::helpers::model::example_text("drive-pwm");
        let [_, (hz, _)] = upper(&["intervals", "-", "--param", "K_pwm", "--json"], &drive);
        assert!((hz.unwrap() - 1663.56).abs() < 5e-3, "{hz:?}");
    }
    let slow = crate::helpers::model::example_text("drive-two-rates");
    let slow =
        slow.replace("K_pwm = 110 ", "").replace("[parameters]", "[parameters]\nK_pwm = { nominal = 110, min = 0 }");
    for (angle, found) in
        [0.003218394, 2.111250332].iter().zip(upper(&["intervals", "-", "--param", "K_pwm", "--json"], &slow))
    {
        assert!((found.1.unwrap() - angle).abs() < 1e-9, "{found:?}");
    }
}

/// A buck converter a thousandth below its limit and a thousandth above, at two duty ratios: the largest multiplier of the switched
/// circuit, linearised in floating point by the place of its edges.
#[test]
fn a_switched_converter_is_on_the_two_sides_of_its_limit() {
    for (duty, limit, volts) in [("0.5", 0.086_448_066_379, 6.0), ("0.9", 0.065_633_129_143, 10.8)] {
        for (factor, is_stable) in [(0.999, true), (1.001, false)] {
            let (gain, mean) = (format!("K_p={}", limit * factor), format!("v_ref={volts}"));
            let run = jurist(&[
                "simulate",
                "examples/buck-pwm.toml",
                "--switched",
                "--steady",
                "--duration",
                "1e-4",
                "--set",
                &gain,
                "--set",
                &format!("D={duty}"),
                "--input",
                &mean,
            ]);
            let multiplier = run.stderr.split("largest multiplier ").nth(1).and_then(|rest| rest.split(' ').next());
            let multiplier: f64 = multiplier.unwrap_or_else(|| panic!("{}", run.stderr)).parse().unwrap();
            assert_eq!(multiplier < 1.0, is_stable, "D = {duty}, {gain}: {multiplier}");
        }
    }
}

/// By what a plant is made discrete is in the first line of every answer: the frame, the pulses, the rate.
#[test]
fn the_headline_names_frames_pulses_and_rates() {
    for (model, words) in [
        ("pmsm-frame", "motor: zero-order hold in the frame of omega_e"),
        ("drive-pwm", "motor: PWM, trailing edge, duty V_0/K_pwm"),
        ("drive-two-rates", "speed controller: every 10; z is one step of 10 samples"),
    ] {
        let run = jurist(&["verdict", &format!("examples/{model}.toml")]);
        assert!(run.stdout.lines().next().unwrap().contains(words), "{}", run.stdout);
    }
    let number = crate::helpers::model::example_text("buck-pwm").replace("duty = \"D\"", "duty = 0.41");
    let run = jurist_with_input(&["verdict", "-"], number.as_bytes());
    assert!(run.stdout.contains("power stage: PWM, trailing edge, duty 0.41"), "{}", run.stdout);
}
