//! Tables at a point, as people read them.

use crate::helpers::program::{jurist, jurist_with_input};

/// A row of the conditions: what stands behind its name, blanks made one.
fn condition(text: &str, name: &str) -> String {
    let line =
        text.lines().find(|line| line.trim_start().starts_with(name)).unwrap_or_else(|| panic!("{name}: {text}"));
    line.trim_start()[name.len()..].split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn conditions_have_their_values_and_the_verdict() {
    for (polynomial, rows, verdict) in [
        (
            "z^2 + z + 1/2",
            &[("Q(1) > 0", "2.5 > 0 holds"), ("(-1)^2*Q(-1) > 0", "0.5 > 0 holds"), ("|a_0| < a_2", "0.5 < 1 holds")][..],
            "stable",
        ),
        // (z - 1)(z^2 - z/10 - 1/5)
        (
            "z^3 - 1.1z^2 - 0.1z + 0.2",
            &[("Q(1) > 0", "0 = 0 does not hold"), ("|b_0| > |b_2|", "0.96 > 0.12 holds")],
            "marginal",
        ),
        ("z^2 + 1", &[("|a_0| < a_2", "1 = 1 does not hold")], "marginal"),
        ("z^2 - 4", &[("Q(1) > 0", "-3 < 0 does not hold"), ("|a_0| < a_2", "4 > 1 does not hold")], "unstable"),
        ("-2z + 3", &[("a_1*Q(1) > 0", "-2 < 0 does not hold"), ("|a_0| < |a_1|", "3 > 2 does not hold")], "unstable"),
        ("s^3 + 2s^2 + 3s + 6", &[("H_1 > 0", "2 > 0 holds"), ("H_2 > 0", "0 = 0 does not hold")], "marginal"),
        ("s^3 + 2s^2 + 3s + 5", &[("H_2 > 0", "1 > 0 holds"), ("H_3 > 0", "5 > 0 holds")], "stable"),
        // Coefficients that are no fractions.
        ("z^2 - sqrt(2)*z + 1/2", &[("Q(1) > 0", "0.0857864376269 > 0 holds")], "stable"),
        ("z - sqrt(2)", &[("Q(1) > 0", "-0.414213562373 < 0 does not hold")], "unstable"),
    ] {
        let text = jurist(&["jury", "--", polynomial]).stdout;
        for (name, expected) in rows {
            assert_eq!(condition(&text, name), *expected, "{polynomial}: {text}");
        }
        assert_eq!(condition(&text, "all together"), verdict, "{polynomial}: {text}");
        let said = jurist(&["verdict", "--", polynomial]).stdout;
        assert!(said.contains(&format!("\n{verdict}: ")), "{said}");
    }
}

#[test]
fn rows_are_numbered_and_the_polynomial_is_named() {
    let text = jurist(&["jury", "z^4 + z/2 + 1/8"]).stdout;
    let numbers: Vec<&str> =
        text.lines().filter_map(|l| l.split_whitespace().next()).filter(|w| w.parse::<u32>().is_ok()).collect();
    assert_eq!(numbers, ["1", "2", "3", "4", "5"], "{text}");
    assert!(text.contains("Q(z) = a_4*z^4 + ... + a_1*z + a_0 is the characteristic polynomial"), "{text}");
    assert!(jurist(&["jury", "z/2 + 1/8"]).stdout.contains("Q(z) = a_1*z + a_0 is"));
    let model = "time = 'discrete'\nparameters.K = 1\nloop.characteristic = 'z^2 + K*z + 1/8'";
    let text = jurist_with_input(&["jury", "-", "--param", "K"], model.as_bytes()).stdout;
    assert!(text.contains("Q(z) = a_2*z^2 + a_1*z + a_0 is"), "{text}");
}
