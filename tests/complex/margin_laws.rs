//! Laws of the margins of loops with complex coefficients, and of machines seen from a frame that turns.

use super::margins::Open;
use super::table::{machine, turned};
use crate::helpers::model::read;
use crate::helpers::program::jurist_with_input;
use crate::helpers::thorough::is_thorough;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_engine::answer::Verdict;
use jurist_engine::response::{DelayMargin, Margins, Place};

fn margins(text: &str) -> Margins {
    let answer = read(text).ask().margins(None, &Rational::ZERO, &Budget::unlimited());
    answer.unwrap_or_else(|e| panic!("{e}\n{text}")).into_value()
}

fn printed(arguments: &[&str], text: &str) -> String {
    let run = jurist_with_input(arguments, text.as_bytes());
    assert_eq!(run.status, 0, "{}\n{text}", run.stderr);
    run.stdout
}

fn decimal(e: &Enclosure) -> String {
    e.decimal(12).unwrap()
}

/// All numbers of a stable loop, and the signed angles or frequencies where they bind, times a sign.
fn numbers(margins: &Margins) -> (Vec<String>, Vec<f64>) {
    let stable = margins.stable.as_ref().unwrap();
    let both = stable.one_sided.as_ref().unwrap();
    let rotations = [&both.lag, &both.lead].map(|r| r.as_ref().unwrap());
    let ends = [&stable.gain.upper, &stable.gain.lower].map(|end| end.as_ref().map(|e| e.value.decimal(12)));
    let mut values: Vec<String> = rotations.iter().map(|r| decimal(&r.degrees(60))).collect();
    values.extend(ends.into_iter().flatten());
    values.extend(
        [&stable.modulus, &stable.peak_complementary, stable.disk.alpha.as_ref().unwrap()].map(|x| x.decimal(12)),
    );
    let places = [rotations[0].place.as_ref(), rotations[1].place.as_ref(), stable.modulus_at.place()];
    let angle = |place: &Place| {
        let frequency = margins.frequency(place, 60)?;
        Some(frequency.angle.or(frequency.radians_per_second)?.lower().to_f64_approximate())
    };
    (values, places.into_iter().flatten().filter_map(angle).collect())
}

#[test]
fn a_turned_gain_by_hand() {
    let found = margins(&turned("pi/6"));
    let stable = found.stable.as_ref().unwrap();
    // 2 sin(pi/9)/0.3 at -2 pi/9.
    let upper = stable.gain.upper.as_ref().unwrap();
    assert_eq!(upper.value.decimal(29), "2.2801342888377915536273307645");
    assert_eq!(decimal(&found.frequency_of(upper, 60).unwrap().angle.unwrap()), "-0.698131700798");
    // |z (z - 1)| = 2 sin(theta/2): the modulus is 0.3/(2 sin(theta/2)), the phase -90 - 3 theta/2 degrees, and 30 more.
    let both = stable.one_sided.as_ref().unwrap();
    let theta = 2.0 * 0.15f64.asin();
    for (rotation, expected) in
        [(&both.lag, 120.0 - 1.5 * theta.to_degrees()), (&both.lead, 60.0 - 1.5 * theta.to_degrees())]
    {
        let degrees = rotation.as_ref().unwrap().degrees(60).lower().to_f64_approximate();
        assert!((degrees - expected).abs() < 1e-9, "{degrees} {expected}");
    }
    // The lead of a dead time at -theta comes before the lag at theta.
    assert!(matches!(stable.delay, DelayMargin::Samples(1)), "{:?}", stable.delay);
}

/// Nothing is left of the imaginary unit around the loop.
#[test]
#[ignore = "long: CI runs it"]
fn a_unit_that_cancels_leaves_the_margins_of_the_real_loop() {
    let turned = "time = 'discrete'\nsample_time = 0.1\n[parameters]\nK = 0.5\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'C'\n\
                  input = 'r - y'\noutput = 'u'\ngain = 'K*j'\n[[block]]\ninput = '-j*u'\noutput = 'y'\ntransfer = '1/(s + 1)'\n\
                  discretize = { method = 'zoh', delay = 0.03 }\n";
    let plain = turned.replace("K*j", "K").replace("-j*u", "u");
    for arguments in [
        &["margins", "-"][..],
        &["margins", "-", "--json"],
        &["verdict", "-", "--phase-margin", "45", "--json"],
        &["margins", "-", "--at", "K"],
    ] {
        assert_eq!(printed(arguments, turned), printed(arguments, &plain), "{arguments:?}");
    }
    // A gain of a polynomial.
    let real = "time = 'continuous'\n[parameters]\nK = 2\n[loop]\ncharacteristic = 's^3 + 2*s^2 + 2*s + K'\n";
    let complex = real.replace("+ K", "- j^2*K");
    assert_eq!(printed(&["margins", "-", "--json"], &complex), printed(&["margins", "-", "--json"], real));
}

#[test]
fn a_negated_unit_is_the_mirror_image() {
    let (mut checked, mut seed) = (0, crate::helpers::random::Random::new(7));
    while checked < 12 {
        let of = Open::random(&mut seed, checked % 2 == 0);
        let (own, mirrored) = (margins(&of.text(1)), margins(&of.text(-1)));
        let both = own.stable.as_ref().and_then(|s| s.one_sided.as_ref());
        if both.is_none_or(|both| both.lag.is_none()) || own.stable.as_ref().unwrap().disk.alpha.is_none() {
            continue;
        }
        checked += 1;
        let ((mut values, mut places), (other, others)) = (numbers(&own), numbers(&mirrored));
        values.swap(0, 1);
        assert_eq!(values, other, "{of:?}");
        if places.len() == 3 {
            places.swap(0, 1);
            let pairs = places.iter().zip(&others);
            assert!(pairs.into_iter().all(|(a, b)| (a + b).abs() < 1e-9), "{of:?}: {places:?} {others:?}");
        }
        let count = own.crossings.gain.len();
        assert_eq!((count, own.crossings.phase.len()), (mirrored.crossings.gain.len(), mirrored.crossings.phase.len()));
    }
}

/// `L(z exp(j phi))` has the same margins, at frequencies that are less by `phi`, but for the delay.
#[test]
fn a_turned_variable_moves_all_frequencies() {
    let of = |z: &str| {
        let loop_of = format!("K*(3 + 4*j)/5*({z} + 1/4)/({z}^2 - {z}/2 + 1/8)");
        format!(
            "time = 'discrete'\n[parameters]\nK = 0.7\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
             transfer = '{loop_of}'\n"
        )
    };
    let (values, places) = numbers(&margins(&of("z")));
    for (turned, phi) in [("(z*(5 + 12*j)/13)", 12f64.atan2(5.0)), ("(j*z)", 0.5 * std::f64::consts::PI)] {
        let (other, others) = numbers(&margins(&of(turned)));
        assert_eq!(values, other, "{turned}");
        for (a, b) in places.iter().zip(&others) {
            let turn = (a - b - phi) / (2.0 * std::f64::consts::PI);
            assert!((turn - turn.round()).abs() < 1e-9, "{turned}: {a} {b}");
        }
    }
}

/// A command that is turned further leads; by the margin it reaches the boundary. A factor at the cut is one of the controller. A sample more of
/// computing is one of delay.
#[test]
#[ignore = "long: CI runs it"]
fn margins_of_a_machine_are_verdicts_of_machines() {
    let budget = Budget::unlimited();
    let text = machine(", advance = 'omega_e*T + x'").replace("omega_e = {", "x = 0\nF = 1\nomega_e = {");
    let text = text.replace("transfer = 'K_p + K_i*T/(z - 1)'", "transfer = 'F*(K_p + K_i*T/(z - 1))'");
    let verdict = |text: &str, name: &str, value: &Rational, speed: i64| {
        let asked = read(text).ask().set(name, value.clone()).set("omega_e", speed).verdict(&budget);
        asked.unwrap().into_value().verdict == Verdict::Stable
    };
    let near: Rational = "1/100000000".parse().unwrap();
    for speed in [-4000, 0, 5000] {
        let answer = read(&text).ask().set("omega_e", speed).margins(None, &Rational::ZERO, &budget).unwrap();
        let found = answer.value();
        let stable = found.stable.as_ref().unwrap();
        let gain = stable.gain.upper.as_ref().unwrap().value.refined(&near).enclosure();
        assert!(verdict(&text, "F", &(&gain.0 - &near), speed) && !verdict(&text, "F", &(&gain.1 + &near), speed));
        let DelayMargin::Samples(samples) = stable.delay else { panic!("{:?}", stable.delay) };
        let late = |m: u64| text.replace("transfer = 'F*(", &format!("transfer = '1/z^{m}*F*("));
        let one = Rational::ONE;
        assert!(verdict(&late(samples), "F", &one, speed) && !verdict(&late(samples + 1), "F", &one, speed), "{speed}");
        let Some(both) = &stable.one_sided else {
            assert_eq!(speed, 0);
            continue;
        };
        for (rotation, sign) in [(&both.lag, -1), (&both.lead, 1)] {
            let degrees = rotation.as_ref().unwrap().degrees(80);
            let radians = degrees.mul(&Enclosure::pi(80), 80).div(&Enclosure::from_rational(180.into()), 80).unwrap();
            let angle = |more: &Rational| (radians.lower() + more) * Rational::from(sign);
            assert!(verdict(&text, "x", &angle(&-near.clone()), speed), "{speed} {sign}");
            assert!(!verdict(&text, "x", &angle(&near), speed), "{speed} {sign}");
        }
    }
}

/// Dead time at the plant's input, which the frame turns on in, is one of the hold.
#[test]
fn dead_time_of_a_machine_is_that_of_its_hold() {
    let budget = Budget::unlimited();
    let text = machine(", advance = 'omega_e*T'").replace("omega_e = {", "x = 0\nomega_e = {");
    let text = text.replace("delay = 'T'", "delay = 'T + x'");
    for (speed, is_lower) in [(3000, false), (-4000, true)] {
        let answer = read(&text).ask().set("omega_e", speed).margins(None, &Rational::ZERO, &budget).unwrap();
        let held = answer.value().held_delay.as_ref().unwrap();
        let seconds = held.seconds(80).unwrap();
        for (more, expected) in [("-1/1000000000", true), ("1/1000000000", false)] {
            let x = seconds.lower() + more.parse::<Rational>().unwrap();
            let verdict = read(&text).ask().set("omega_e", speed).set("x", x).verdict(&budget).unwrap().into_value();
            assert_eq!(verdict.verdict == Verdict::Stable, expected, "{speed} {more}");
        }
        let angle = held.frequency(60).unwrap().angle.unwrap();
        assert_eq!(angle.upper().is_negative(), is_lower, "{speed}");
    }
}

/// A plant in another frame is `exp(ja) G(z exp(jwT))`.
#[test]
fn a_frame_is_the_transfer_function_written_out() {
    let framed = "time = 'discrete'\nsample_time = 1\n[parameters]\nK = 0.4\nw = 0.3\n[loop]\ninputs = ['r']\noutputs = ['i']\n[[block]]\nname = 'C'\n\
                  input = 'r - i'\noutput = 'u'\ntransfer = 'K + 1/16/(z - 1)'\n[[block]]\ninput = 'u'\noutput = 'i'\ntransfer = '1/(s + 1/2)'\n\
                  discretize = { method = 'zoh', frame = 'w', delay = 1, advance = 'w' }\n";
    let plant = "transfer = '1/(s + 1/2)'\ndiscretize = { method = 'zoh', frame = 'w', delay = 1, advance = 'w' }";
    let turned = "(z*exp(j*w))";
    let out = format!("transfer = 'exp(j*w)*2*(1 - exp(-1/2))/({turned} - exp(-1/2))/{turned}'");
    assert_eq!(numbers(&margins(framed)), numbers(&margins(&framed.replace(plant, &out))));
    if !is_thorough() {
        return;
    }
    let below_the_heading = |text: &str| {
        let printed = printed(&["margins", "-", "--at", "u"], text);
        // Only the plant behind a hold has a dead time of its own.
        let line = |line: &str| line.split("; less than").next().unwrap_or_default().to_owned();
        printed.lines().skip(1).map(line).collect::<Vec<_>>()
    };
    assert_eq!(below_the_heading(framed), below_the_heading(&framed.replace(plant, &out)));
}

/// The matrix form and a gain of the characteristic polynomial are cut as blocks are.
#[test]
fn other_forms_of_a_loop() {
    let block = turned("pi/6");
    let values = numbers(&margins(&block));
    let head = "time = 'discrete'\n[constants]\nphi = 'pi/6'\n[parameters]\nK = 0.3\n[loop]\n";
    let given = format!("{head}characteristic = 'z^2 - z + K*exp(j*phi)'\n");
    assert_eq!(numbers(&margins(&given)), values);
    let feedback = format!("{head}A = [[0, 1], [0, 1]]\nB = [[0], ['exp(j*phi)']]\nC = [[1, 0]]\nK = [['K']]\n");
    assert_eq!(numbers(&margins(&feedback)), values);
    // At the signal as at the block's input.
    let at = read(&block).ask().margins(Some("y"), &Rational::ZERO, &Budget::unlimited()).unwrap().into_value();
    assert_eq!(numbers(&at), values);
}

fn loop_of(transfer: &str) -> String {
    format!(
        "time = 'discrete'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
         transfer = 'K*({transfer})'\n"
    )
}

/// The angles of both rotations, rounded.
fn angles(margins: &Margins) -> [String; 2] {
    let both = margins.stable.as_ref().unwrap().one_sided.as_ref().unwrap();
    [&both.lag, &both.lead].map(|r| r.as_ref().unwrap().degrees(60).decimal(7).unwrap())
}

/// A modulus that is one at one frequency or at all of them.
#[test]
fn moduli_that_touch_one() {
    // |1 - z|/2 is 1 at z = -1 only, where the open loop is -(3 + 4j)/5: no number of samples makes it -1.
    let touching = margins(&loop_of("(3 + 4*j)/5*(1 - z)/(2*z)"));
    let stable = touching.stable.as_ref().unwrap();
    assert!(matches!(stable.delay, DelayMargin::Unbounded), "{:?}", stable.delay);
    assert!(matches!(touching.crossings.gain[..], [ref only] if matches!(only.place, Place::Highest)));
    assert_eq!(angles(&touching), ["53.13010", "306.8699"]);
    // A constant, with a mode that cancels.
    let constant = margins(&loop_of("(3 + 4*j)/5*(z - j/2)/(z - j/2)"));
    assert!(constant.crossings.gain_everywhere);
    assert_eq!(angles(&constant), ["233.1301", "126.8699"]);
    let stable = constant.stable.as_ref().unwrap();
    assert_eq!(
        (stable.phase.degrees(60).unwrap().decimal(7).unwrap(), stable.modulus.decimal(7)),
        ("126.8699".into(), "1.788854".into())
    );
    assert!(matches!(stable.delay, DelayMargin::Samples(0)), "{:?}", stable.delay);
    // Nowhere one.
    let small = margins(&loop_of("j/(4*z)"));
    assert!(small.stable.as_ref().unwrap().one_sided.as_ref().unwrap().lag.is_none());
    assert!(matches!(small.stable.unwrap().delay, DelayMargin::Unbounded));
}

/// A complex mode that the cut hides changes no margin.
#[test]
fn a_hidden_mode_changes_nothing() {
    let plain = margins(&loop_of("7/10*(3 + 4*j)/5*(z + 1/4)/(z^2 - z/2 + 1/8)"));
    let hidden = margins(&loop_of("7/10*(3 + 4*j)/5*(z + 1/4)*(2*z - j)/((z^2 - z/2 + 1/8)*(2*z - j))"));
    assert_eq!(numbers(&hidden), numbers(&plain));
    assert_eq!((hidden.verdict.degree, plain.verdict.degree), (3, 2));
    // A mode that is not stable leaves no margins.
    assert!(margins(&loop_of("(3 + 4*j)/5*(z - 2*j)/((z + 1/4)*(z - 2*j))")).stable.is_none());
}

/// A pole on the circle that is not real, and a zero there.
#[test]
fn poles_and_zeros_on_the_circle() {
    let found = margins(&loop_of("1/4*(z - 1)/(z - (3 + 4*j)/5)"));
    let stable = found.stable.as_ref().unwrap();
    // (z - p) + k (z - 1)/4 has its root between p and 1, on the chord: inside for all k > 0.
    assert!(stable.gain.upper.is_none(), "{:?}", stable.gain.upper);
    assert_eq!(stable.gain.lower.as_ref().map(|end| end.value.decimal(5)), Some("0".to_owned()));
    assert!(stable.modulus.compare_rational(&0.into()).is_gt());
}
