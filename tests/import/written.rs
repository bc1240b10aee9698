//! What is written: the same loop from every format, names, forms of the loop, tolerances.

use super::{asked, file, imported, imported_text, is_clean, temporary};
use crate::helpers::program::{jurist, refused};

/// The model without its comments and its title, which name the file.
fn body(model: &str) -> String {
    model.lines().filter(|line| !line.starts_with('#') && !line.starts_with("title")).collect::<Vec<_>>().join("\n")
}

const SERVO_JSON: &str = r#"{"A": [[-21.73913043478261, -11.95652173913043, 0], [5.913978494623656, -0.08602150537634409, 0], [0, 1, 0]],
    "B": [21.73913043478261, 0, 0], "C": [0, 0, 1], "D": 0}"#;

const SERVO_CSV: &str = "A\r\n-21.73913043478261,-11.95652173913043,0\r\n5.913978494623656,-0.08602150537634409,0\r\n0,1,0\r\nB\r\n21.73913043478261\r\n0\r\n0\r\nC\r\n0,0,1\r\n";

#[test]
fn every_format_gives_the_same_loop() {
    let servo = imported("servo.mat", &[]).stdout;
    is_clean(&servo);
    for name in ["servo-packed.mat", "servo.npz"] {
        assert_eq!(body(&imported(name, &[]).stdout), body(&servo), "{name}");
    }
    for text in [SERVO_JSON.to_owned(), format!("{{\"sys\": {SERVO_JSON}}}"), SERVO_CSV.to_owned()] {
        assert_eq!(body(&imported_text(&text, &[]).stdout), body(&servo), "{text}");
    }
    // With A = [[-a, -c, 0], [d, -b, 0], [0, 1, 0]] by hand: (a + b) (a b + c d)/(a d), from Routh's table.
    let answer = asked(&["intervals"], &servo);
    let ends: Vec<&str> = ["lower", "upper"].map(|end| answer["stable"][0][end]["decimal"].as_str().unwrap()).into();
    assert_eq!(ends, ["0", "12.3212903226"]);
}

#[test]
fn a_struct_of_two_channels_in_discrete_time() {
    let sampled = imported("sampled-struct.mat", &[]).stdout;
    is_clean(&sampled);
    assert_eq!(body(&imported("sampled.npz", &[]).stdout), body(&sampled));
    for part in [
        "time = \"discrete\"\nsample_time = 0.1\n",
        "input = \"r_2 - y_2\"\noutput = \"u_2\"\ngain = \"K\"",
        "[0.1, 0],",
    ] {
        assert!(sampled.contains(part), "{part}: {sampled}");
    }
    assert_eq!(asked(&["verdict"], &sampled)["verdict"], "stable");
}

#[test]
fn a_linear_model_of_openmodelica_keeps_its_names() {
    let model = imported("linearized_model.mo", &[]).stdout;
    is_clean(&model);
    for part in ["title = \"Servo.Drive\"", "input = \"r_angle - angle\"", "output = [\"angle\"]", "0],  # motor_i\n"] {
        assert!(model.contains(part), "{part}: {model}");
    }
    let tank = imported("linear_Tank.mo", &[]).stdout;
    is_clean(&tank);
    assert!(tank.contains("states = [\"tank_1_level\", \"tank_2_level\"]"), "{tank}");
    assert_eq!(asked(&["verdict"], &tank)["verdict"], "stable");
    // A state, an input and an output of one name, and one that means something else here.
    let text = std::fs::read_to_string(file("linearized_model.mo")).unwrap();
    let text = text.replace("u_voltage", "u_angle").replace("x_motor.i", "x_K").replace("x_motor.w", "x_angle");
    let model = imported_text(&text, &[]).stdout;
    is_clean(&model);
    assert!(model.contains("input = [\"u_angle\"]\noutput = [\"angle\"]") && model.contains("# x_K\n"), "{model}");
}

#[test]
fn loops_that_are_not_closed() {
    let open = imported("servo.mat", &["--open"]).stdout;
    is_clean(&open);
    assert!(open.contains("inputs = [\"u\"]") && !open.contains("K"), "{open}");
    let wide = imported_text("A\n-1,0\n0,-2\nB\n1\n1\n", &[]);
    is_clean(&wide.stdout);
    assert!(wide.stderr.contains("note: the file has no C: the outputs are the states"), "{}", wide.stderr);
    assert!(wide.stderr.contains("with 1 input and 2 outputs no loop is closed around it"), "{}", wide.stderr);
    assert_eq!(asked(&["verdict"], &wide.stdout)["verdict"], "stable");
    let alone = imported_text("-1,0\n0,-2\n", &[]).stdout;
    is_clean(&alone);
    assert_eq!(asked(&["verdict"], &alone)["verdict"], "stable");
    assert!(imported_text("{\"A\": [[-1]], \"B\": [[]], \"C\": 1, \"D\": [[]]}", &[]).stdout.contains("matrix = "));
}

#[test]
fn times() {
    let time = |text: &str, options: &[&str]| {
        let model = imported_text(text, options).stdout;
        is_clean(&model);
        model
            .lines()
            .filter(|line| line.starts_with("time") || line.starts_with("sample"))
            .collect::<Vec<_>>()
            .join("; ")
    };
    let continuous = "time = \"continuous\"";
    assert_eq!(time("0.5", &[]), continuous);
    assert_eq!(time("A\n0.5\nTs\n0", &[]), continuous);
    assert_eq!(time("A\n0.5\nTs\n0.1", &["--sample-time", "0"]), continuous);
    assert_eq!(time("A\n0.5\nTs\n0.10", &[]), "time = \"discrete\"; sample_time = 0.10");
    assert_eq!(time("A\n0.5\nTs\n-1", &[]), "time = \"discrete\"");
    assert_eq!(time("A\n0.5\ndt = 1e-3", &[]), "time = \"discrete\"; sample_time = 0.001");
    assert_eq!(time("A\n0.5", &["--sample-time", "1/3"]), "time = \"discrete\"; sample_time = \"1/3\"");
    let single = imported("single.mat", &[]).stdout;
    assert!(
        single.contains("[0.1, 0.5],\n    [-0.25, 0.7],") && single.contains("time = \"discrete\"\n\n"),
        "{single}"
    );
    let run = refused(&["import", &file("servo.mat"), "--sample-time", "-1"], "E-option-value");
    assert!(run.stderr.contains("a sample time is not negative"), "{}", run.stderr);
}

#[test]
fn last_places_are_tolerances() {
    let run = imported("servo.mat", &["--last-place"]);
    is_clean(&run.stdout);
    assert!(run.stderr.contains("half a unit in the last place"), "{}", run.stderr);
    assert!(run.stdout.contains("a_1_1 = { value = -21.73913043478261, tolerance = "), "{}", run.stdout);
    assert!(run.stdout.contains("[0, 1, 0],") && run.stdout.contains("[\"b_1_1\"],\n    [0],"), "{}", run.stdout);
    let answer = asked(&["tolerance", "--only"], &run.stdout);
    assert_eq!(answer["verdict"], "stable", "{answer}");
    // Half of a hundredth of what is written as 0.50.
    let text = "A\n0.50\nB\n1\nC\n1\nTs\n1\n";
    let model = imported_text(text, &["--last-place"]).stdout;
    assert!(model.contains("a_1_1 = { value = 0.50, tolerance = 0.005 }\n\n"), "{model}");
    let whole = imported_text("A\n2,0\n1,3.0", &["--last-place"]);
    assert!(
        whole.stderr.contains("taken for exact") && whole.stdout.contains("[1, 3],"),
        "{}{}",
        whole.stdout,
        whole.stderr
    );
}

#[test]
fn files_are_written_and_the_input_is_kept() {
    let (from, to) = (temporary("plant.csv"), temporary("plant.toml"));
    std::fs::write(&from, SERVO_CSV).unwrap();
    let (from_name, to_name) = (from.to_str().unwrap(), to.to_str().unwrap());
    let run = jurist(&["import", from_name, "-o", to_name]);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
    assert_eq!(std::fs::read_to_string(&to).unwrap(), jurist(&["import", from_name]).stdout);
    let run = refused(&["import", from_name, "-o", from_name], "E-output-name");
    assert!(run.stderr.contains("the system itself"), "{}", run.stderr);
    assert_eq!(std::fs::read_to_string(&from).unwrap(), SERVO_CSV);
    assert_eq!(jurist(&["import", from_name, "-q"]).stderr, "");
    for path in [from, to] {
        std::fs::remove_file(path).unwrap();
    }
}
