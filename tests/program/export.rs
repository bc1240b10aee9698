//! Scripts for other programs. What the other programs make of them is looked at in `tests/outside/export.py`.

use crate::helpers::program::{Run, jurist, jurist_with_input, refused};

const TARGETS: [&str; 2] = ["python-control", "matlab"];

/// The script of a model, without warnings.
fn script(model: &str, target: &str, more: &[&str]) -> String {
    let arguments: Vec<&str> = ["export", model, "--to", target, "--quiet"].iter().chain(more).copied().collect();
    let run = jurist(&arguments);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments:?}");
    run.stdout
}

/// What is said of a model on standard input.
fn said(text: &str, target: &str, more: &[&str]) -> Run {
    let arguments: Vec<&str> = ["export", "-", "--to", target, "--quiet"].iter().chain(more).copied().collect();
    jurist_with_input(&arguments, text.as_bytes())
}

/// Lines that occur in this order.
fn assert_lines(text: &str, lines: &[&str]) {
    let mut rest = text.lines();
    for line in lines {
        assert!(rest.any(|found| found == *line), "no line, or not in this order: {line}\n{text}");
    }
}

#[test]
fn a_block_diagram_has_a_system_for_each_block_and_the_connection() {
    let text = script("examples/drive-blocks.toml", "python-control", &[]);
    assert_lines(
        &text,
        &[
            concat!(
                "# Written by jurist ",
                env!("CARGO_PKG_VERSION"),
                " from drive-blocks.toml for python-control 0.10."
            ),
            "# This script computes in floating point. The answers of jurist are exact.",
            "from control import append, feedback, ss",
            "K_pwm = 110.0  # amplitude of the PWM voltage, V",
            "L_a   = 0.046",
            "dt = T  # time from one sample to the next",
            "# speed controller: (K_ps + K_is*T/2*(z + 1)/(z - 1))/z",
            "speed_controller = realise([0, K_ps + K_is*T/2, -K_ps + K_is*T/2], [1, -1, 0], dt)",
            "chopper = gain(np.array([[K_pwm/E_sw]]))",
            "# motor: state space; forward rule",
            "motor = forward(ss(",
            "    np.array([[-R_a/L_a, -K_a/L_a], [K_a/J, -B_v/J]]),",
            "    0), T)",
            "blocks = append(speed_controller, current_controller, chopper, motor)",
            "entries = np.array([[1, 0], [0, 0], [0, 0], [0, 0], [0, 1]])",
            "# Inputs: omega_ref, T_L. Outputs: omega, i_a.",
            "closed_loop = selection*feedback(blocks, connection, 1)*entries",
            "    print(pole)",
        ],
    );
    let text = script("examples/drive-blocks.toml", "matlab", &[]);
    assert_lines(
        &text,
        &[
            "if exist('OCTAVE_VERSION', 'builtin'), pkg load control, end",
            "K_pwm = 110.0;  % amplitude of the PWM voltage, V",
            "motor = forward(ss([-R_a/L_a, -K_a/L_a; K_a/J, -B_v/J], [1/L_a, 0; 0, -1/J], eye(2, 2), zeros(2, 2), 0), T);",
            "blocks = append(speed_controller, current_controller, chopper, motor);",
            "disp(pole(closed_loop))",
        ],
    );
}

#[test]
fn holds_and_rules_that_the_other_program_has_are_its_own() {
    let text = script("examples/dc-servo.toml", "matlab", &[]);
    assert_lines(
        &text,
        &[
            "PD = c2d(realise([K*0.02*500, K*0.02*500*50], [1, 500], 0), dt, 'tustin');",
            "motor = c2d(realise([0, 0, 20], [T_m, 1, 0], 0), dt, 'zoh');",
        ],
    );
    let model =
        "time = 'discrete'\nsample_time = 'T'\nparameters = { T = 0.1, w = 2, c = 3 }\n[loop]\ninputs = ['r']\n";
    for (rule, expected) in [
        ("'foh'", "plant = c2d(realise([0, 1], [1, 1], 0), dt, 'foh')"),
        ("'forward'", "plant = forward(realise([0, 1], [1, 1], 0), T)"),
        ("'backward'", "plant = backward(realise([0, 1], [1, 1], 0), T)"),
        ("{ method = 'tustin', prewarp = 'w' }", "plant = bilinear(realise([0, 1], [1, 1], 0), w/tan(w*T/2))"),
        ("{ method = 'tustin', c = 'c' }", "plant = bilinear(realise([0, 1], [1, 1], 0), c)"),
    ] {
        let block = "[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = '1/(s + 1)'\n";
        let run = said(&format!("{model}{block}discretize = {rule}\n"), "python-control", &[]);
        assert_eq!(run.stderr, "", "{rule}");
        assert_lines(&run.stdout, &[expected]);
    }
}

#[test]
fn an_output_of_which_an_input_is_a_part_has_it_at_once() {
    let model = "time = 'discrete'\nparameters.K = 1\n[loop]\ninputs = ['r']\noutputs = ['y', 'r - K*y']\n[[block]]\nname = 'plant'\n\
                 input = 'r - y'\noutput = 'y'\ntransfer = '1/z'\n";
    assert_lines(
        &said(model, "python-control", &[]).stdout,
        &[
            "selection = np.array([[1], [-K]])",
            "direct = np.array([[0], [1]])",
            "closed_loop = selection*feedback(blocks, connection, 1)*entries + gain(direct)",
        ],
    );
}

#[test]
fn what_the_other_program_lacks_is_written_in_numbers() {
    for (model, expected) in [
        ("examples/buck-pwm.toml", "jurist computed these matrices"),
        ("examples/drive-pwm.toml", "jurist computed these matrices"),
        ("examples/lcl-inverter.toml", "jurist computed these matrices"),
        ("examples/drive-two-rates.toml", "from one hyperperiod of 10 samples to the next"),
    ] {
        for target in TARGETS {
            assert!(script(model, target, &[]).contains(expected), "{model}");
        }
    }
    // The pole of the held plant is exp(-1) to the last bit or two.
    let model = "time = 'discrete'\nsample_time = 1\nparameters.K = 1\n[loop]\n[[block]]\nname = 'plant'\ninput = '-K*y'\n\
                 output = 'y'\ntransfer = 'exp(-s/2)/(s + 1)'\ndiscretize = 'zoh'\n";
    let text = said(model, "matlab", &[]).stdout;
    assert!(text.contains("[0.36787944117144233, 0.2386512185411911; 0, 0]"), "{text}");
}

#[test]
fn other_forms_are_matrices_and_lists() {
    let matrices = "time = 'discrete'\nparameters.k = 0.5\n[loop]\nA = [[0, 1], [0, 0]]\nB = [[0], [1]]\nC = [[1, 'k']]\nK = [['k']]\n";
    let text = said(matrices, "python-control", &[]).stdout;
    assert_lines(
        &text,
        &[
            "dt = True  # discrete time; the model names no sample time",
            "A = np.array([[0, 1], [0, 0]])",
            "C = np.array([[1, k]])",
            "closed_loop = ss(A - B @ K @ C, entries, selection, direct, dt)",
        ],
    );
    let text = said(matrices, "matlab", &[]).stdout;
    assert_lines(&text, &["dt = -1;  % discrete time; the model names no sample time", "C = [1, k];"]);
    let polynomial = "time = 'continuous'\nparameters = { a = '1/3', lambda = 2 }\nloop.characteristic = 'a*s^2 + lambda*(s + 1)^2'\n";
    assert_lines(
        &said(polynomial, "python-control", &[]).stdout,
        &[
            "from numpy import roots",
            "a       = 0.3333333333333333  # exactly 1/3",
            "lambda_ = 2.0  # lambda",
            "coefficients = [a + lambda_, lambda_ + lambda_, lambda_]",
            "poles = roots(coefficients)",
        ],
    );
}

#[test]
fn long_formulas_are_numbers() {
    let polynomial = "time = 'discrete'\nparameters.K = 0.5\nloop.characteristic = '(z + K)^40 - z^40 + z^41 - K'\n";
    let text = said(polynomial, "python-control", &[]).stdout;
    assert!(text.contains("jurist computed its coefficients at the values above"), "{text}");
    assert!(text.contains("coefficients = [1, 0, 20, 195, 1235,"), "{text}");
    let block = "time = 'discrete'\nparameters.K = 0.5\n[loop]\ninputs = ['r']\n[[block]]\nname = 'b'\ninput = 'r - y'\noutput = 'y'\n\
                 transfer = '1/((z + K)^40 + 1)'\n";
    assert!(said(block, "matlab", &[]).stdout.contains("jurist computed these matrices"));
}

#[test]
fn formulas_stay_and_values_that_are_set_are_numbers() {
    let model = "time = 'continuous'\nconstants = { R = 2, tau = 'L/R', w = '2*pi*sqrt(tau^-1)' }\nparameters = { L = 0.1 }\n\
                 loop.characteristic = 's^2 + w*s + tau'\n";
    let text = said(model, "python-control", &[]).stdout;
    assert_lines(
        &text,
        &["from math import pi, sqrt", "L   = 0.1", "R   = 2.0", "tau = L/R", "w   = 2*pi*sqrt(tau**(-1))"],
    );
    let text = said(model, "matlab", &["--set", "L=1/7"]).stdout;
    assert_lines(&text, &["L   = 0.14285714285714285;  % exactly 1/7", "w   = 2*pi*sqrt(tau^(-1));"]);
}

#[test]
fn what_has_no_exact_form_is_refused_with_its_place() {
    for target in TARGETS {
        let run = refused(&["export", "examples/dead-time-pi.toml", "--to", target], "E-export");
        assert!(run.stderr.contains("the dead time of 'process' has no exact form in the other program"));
        assert!(run.stderr.contains("examples/dead-time-pi.toml:33:13"), "{}", run.stderr);
        let run = refused(&["export", "s + 1 + exp(-s) = 0", "--to", target], "E-export");
        assert!(run.stderr.contains("a characteristic function with dead time"), "{}", run.stderr);
    }
    let run = said("time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - K'\n", "matlab", &[]);
    assert!(
        run.status == 2 && run.stderr.contains("error[E-no-value]") && run.stderr.contains(":2:12"),
        "{}",
        run.stderr
    );
    for (model, place) in [
        ("parameters.K = 1e400\nloop.characteristic = 'z - K'", ":2:12"),
        ("loop.characteristic = 'z - 1e-400'", ":2:24"),
    ] {
        let run = said(&format!("time = 'discrete'\n{model}\n"), "matlab", &[]);
        assert!(
            run.status == 2 && run.stderr.contains("error[E-export]") && run.stderr.contains(place),
            "{}",
            run.stderr
        );
    }
    refused(&["export", "examples/drive-blocks.toml"], "E-usage");
    refused(&["export", "examples/drive-blocks.toml", "--to", "simulink"], "E-usage");
}

#[test]
fn names_are_those_of_the_other_language_and_each_is_used_once() {
    let model = "time = 'discrete'\nparameters = { plant = 1, end = 2 }\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\n\
                 input = 'r - y'\noutput = 'y'\ntransfer = 'plant/(z*end)'\n[[block]]\nname = 'Ω 2'\ninput = 'y'\noutput = 'q'\ngain = 1\n";
    let text = said(model, "matlab", &[]).stdout;
    assert_lines(
        &text,
        &[
            "plant = 1.0;",
            "end_  = 2.0;  % end",
            "plant_block = realise([0, plant/end_], [1, 0], dt);",
            "x__2 = gain([1]);",
        ],
    );
}

#[test]
fn a_line_and_the_drive_are_exported_too() {
    assert!(jurist(&["export", "--to", "matlab"]).stdout.contains("from built-in drive"));
    let run = jurist(&["export", "K/(s*(s+1)*(s+2))", "--to", "python-control", "--set", "K=3", "--quiet"]);
    assert_lines(
        &run.stdout,
        &["K = 3.0", "open_loop = realise([0, 0, 0, K], conv([1, 1, 0], [1, 2]), dt)", "blocks = open_loop"],
    );
}
