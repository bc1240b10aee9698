//! What is said: explanations, files that were written, tolerances in one option.

use crate::helpers::program::{jurist, jurist_with_input, refused};

#[test]
fn the_list_of_explanations_has_whole_sentences() {
    let list = jurist(&["explain"]).stdout;
    for line in list.lines().filter(|line| line.starts_with("E-") || line.starts_with("W-")) {
        let text = line.split_once("  ").expect("a code and a sentence").1.trim();
        assert!(text.len() > 20 && text.ends_with(['.', ')', '`']) || !text.contains(". "), "{line}");
        assert!(!text.ends_with([',', ';']) && !text.ends_with(" and") && !text.ends_with(" a"), "{line}");
    }
    assert!(list.contains("phase margin") && list.contains("zoh"), "{list}");
}

#[test]
fn terms_of_the_field_are_explained() {
    for (word, text) in [
        ("phase margin", "The angle by which"),
        ("ZOH", "A hold whose output stays"),
        ("zero-order hold", "A hold whose output stays"),
        ("jury", "The test of a discrete loop"),
        ("Hurwitz", "The test of a continuous loop"),
        ("falling", "Of a crossing"),
        ("disk margin", "The greatest `alpha`"),
    ] {
        let said = jurist(&["explain", word]);
        assert_eq!(said.status, 0, "{word}");
        assert!(
            said.stdout.to_lowercase().starts_with(&word.to_lowercase()) && said.stdout.contains(text),
            "{}",
            said.stdout
        );
    }
    assert!(refused(&["explain", "phase", "margn"], "E-unknown-code").stderr.contains("did you mean 'phase margin'?"));
}

#[test]
fn commands_say_what_they_wrote() {
    let folder = std::env::temp_dir().join(format!("jurist-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (json, proof, svg) = (file("a.json"), file("c.json"), file("b.svg"));
    for (arguments, said) in [
        (&["verdict", "-o", &json][..], format!("wrote {json}\n")),
        (
            &["intervals", "--param", "K_pwm", "-o", &json, "--certificate", &proof],
            format!("wrote {json} and {proof}\n"),
        ),
        (&["bode", "examples/dc-servo.toml", "-o", &svg], format!("wrote {svg}\n")),
        (&["charpoly", "--format", "matlab", "-o", &json, "-q"], String::new()),
        (&["verdict"], String::new()),
    ] {
        let run = jurist(arguments);
        assert!(
            run.stderr.ends_with(&said) && run.stderr.matches("wrote").count() == usize::from(!said.is_empty()),
            "{}",
            run.stderr
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn several_tolerances_stand_in_one_option() {
    let model = "time = 'continuous'\n[parameters]\na = 1\nb = 1\nc = 1\n[loop]\ncharacteristic = 's^2 + a*s + b*c'";
    let ask = |tolerances: &[&str]| {
        let options = tolerances.iter().flat_map(|t| ["--tol", t]);
        jurist_with_input(&[&["tolerance", "-", "--json"][..], &options.collect::<Vec<_>>()].concat(), model.as_bytes())
            .stdout
    };
    let apart = ask(&["a,b=10%", "c=-20%..+5%"]);
    assert!(apart.contains("jurist/tolerance/1"), "{apart}");
    assert_eq!(ask(&["a,b=10%,c=-20%..+5%"]), apart);
    assert_eq!(ask(&["a=10%,b=10%, c=-20%..+5%"]), apart);
    for wrong in ["a", "a=10%,", "a=10%,b", "a=1,5%", "a=,b=1%"] {
        let run = jurist_with_input(&["tolerance", "-", "--tol", wrong], model.as_bytes());
        assert_eq!(run.status, 2, "{wrong}");
        assert!(
            run.stderr.contains("for example --tol") || run.stderr.contains("tolerances look like"),
            "{}",
            run.stderr
        );
    }
}

/// It has no roots to count: all numbers are.
#[test]
fn a_polynomial_that_is_zero_has_every_number_as_a_root() {
    let run = jurist(&["verdict", "0*s"]);
    assert!(run.stdout.contains("unstable: the characteristic polynomial is zero"), "{}", run.stdout);
}
