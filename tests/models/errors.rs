//! Whatever is wrong with a model is said with its code and its place, several things in one run.

use crate::helpers::model::characteristic as polynomial_of;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Error, Source};
use jurist_engine::model::{Model, source_from_bytes};
use jurist_show::diagnostics::{render, render_error};

const HEAD: &str = "time = 'discrete'\n[parameters]\nK = { nominal = 1 }\n";

/// Codes and places of all errors, as `code@line:column`.
fn errors(text: &str) -> Vec<String> {
    let source = Source::new("model.toml", text);
    let result = Model::from_toml(&source);
    match &result {
        Ok(_) => Vec::new(),
        Err(error) => {
            let drawn = render_error(error, false);
            assert!(drawn.len() < 50_000, "a long rendering: {} bytes", drawn.len());
            let place = |d: &jurist_engine::error::Diagnostic| match &d.primary {
                Some(label) => {
                    let (line, column) = source.line_column(label.span.start);
                    format!("{}@{line}:{column}", d.code)
                }
                None => d.code.to_string(),
            };
            error.diagnostics().iter().map(place).collect()
        }
    }
}

/// The same for a model with parameter K and this text after it.
fn after_head(text: &str) -> Vec<String> {
    errors(&format!("{HEAD}{text}"))
}

/// The same for a characteristic polynomial, which stands in line 5 from column 19.
fn characteristic(text: &str) -> Vec<String> {
    after_head(&format!("[loop]\ncharacteristic = '{text}'\n"))
}

#[test]
fn expressions() {
    for (text, expected) in [
        ("z + k", "E-unknown-name@5:23"),
        ("z + 2K", "E-number@5:23"),
        ("z K", "E-syntax@5:21"),
        ("z ** 2", "E-syntax@5:21"),
        ("z + (K", "E-syntax@5:25"),
        ("z + K)", "E-syntax@5:24"),
        ("z +", "E-syntax@5:22"),
        ("", "E-syntax@5:18"),
        ("z^0.5", "E-exponent@5:21"),
        ("z^K", "E-exponent@5:21"),
        ("z^9^9^9", "E-exponent@5:23"),
        ("z^1000000000000000000000000", "E-exponent@5:21"),
        ("z^(1/0)", "E-division-by-zero@5:21"),
        ("z + 1/(K - K)", "E-division-by-zero@5:25"),
        ("z + (K - K)^-1", "E-division-by-zero@5:23"),
        ("z + 1/(z - K)", "E-not-polynomial@5:25"),
        ("z + sinh(K)", "E-syntax@5:23"),
        ("z + sin K", "E-syntax@5:27"),
        ("z + sin(K", "E-syntax@5:28"),
        ("z + sqrt(-2)", "E-value@5:23"),
        ("z + sqrt(1 - sqrt(2))", "E-value@5:23"),
        ("z + sqrt(2 - pi)", "E-value@5:23"),
        ("z - K*tan(pi/2)", "E-value@5:25"),
        ("z - tan(pi/2 + 0*K)", "E-value@5:23"),
        ("z - tan(3*pi*K/K/2)", "E-value@5:23"),
        ("z - K/cos(pi/2)", "E-division-by-zero@5:25"),
        ("z - K/(sqrt(2)^2 - 2)", "E-division-by-zero@5:25"),
        ("z^2/(sin(K)^2 + cos(K)^2 - 1) - K", "E-division-by-zero@5:23"),
        ("z - (sqrt(2)^2 - 2)^-1", "E-division-by-zero@5:23"),
        ("z - K*exp(1e300)", "E-too-large@5:25"),
        ("z - K*exp(-exp(exp(10)))", "E-too-large@5:25"),
        ("z + exp(z)", "E-function@5:23"),
        ("z = K", "E-syntax@5:21"),
        ("z − K", "E-syntax@5:21"),
        ("z + Pi", "E-unknown-name@5:23"),
        ("z + e", "E-unknown-name@5:23"),
        ("z + 1e999999999", "E-number@5:23"),
    ] {
        assert_eq!(characteristic(text), [expected], "{text}");
    }
    assert_eq!(characteristic("z^-1 + 1"), ["E-not-polynomial@5:19"]);
    for right in [
        "z^(2^3) - K^2*z^3/7 + 1_000",
        "z - tan(K)",
        "z - 1/cos(K*pi/2)",
        "z - sqrt(K - 9)/(sqrt(2) - 2)",
        "z - tan(pi/2 - 1e-50)",
        "z - exp(-1000)*sqrt(sqrt(2)^2 - 2)",
    ] {
        assert_eq!(characteristic(right), [""; 0], "{right}");
    }
}

/// Each is looked at by itself: enclosing functions of functions of functions takes twice as long with each.
#[test]
fn a_constant_without_a_value_is_found_behind_many_others() {
    let mut text = String::from("time = 'discrete'\n[constants]\nc0 = 'sqrt(2)'\n");
    for i in 0..60 {
        let next = ["exp(#/10)", "sqrt(# + 1)", "1/(sqrt(7) + #)"][i % 3].replace('#', &format!("c{i}"));
        text += &format!("c{} = '{next}'\n", i + 1);
    }
    text += "last = 'tan(pi/2)'\n[parameters]\nK = {}\n[loop]\ncharacteristic = 'z - K*c60*last'\n";
    let Err(error) = Model::from_toml(&Source::new("chain.toml", text.as_str())) else { panic!("a tangent of pi/2") };
    let found = render_error(&error, false);
    assert!(found.contains("E-value") && found.contains("chain.toml:64:9"), "{found}");
}

#[test]
fn three_typos_in_one_run() {
    let text = "time = 'discrete'\n[constants]\ng = '1/(L_b*12)'\nL_a = 46e-3\n[parameters]\nK_pwm = { nominal = 110, mim = 0 }\n\
        [loop]\ncharacteristic = 'z^2 + K_pmw*z + g*L_a'\n";
    let error = Model::from_toml(&Source::new("drive.toml", text)).unwrap_err();
    insta::assert_snapshot!(render_error(&error, false), @r"
    error[E-unknown-name]: unknown name 'L_b'
     --> drive.toml:3:9
      |
    3 | g = '1/(L_b*12)'
      |         ^^^ not defined
      |
      = help: did you mean 'L_a'?

    error[E-unknown-key]: unknown key 'mim' in a parameter
     --> drive.toml:6:26
      |
    6 | K_pwm = { nominal = 110, mim = 0 }
      |                          ^^^ not known here
      |
      = help: did you mean 'min'?

    error[E-unknown-name]: unknown name 'K_pmw'
     --> drive.toml:8:25
      |
    8 | characteristic = 'z^2 + K_pmw*z + g*L_a'
      |                         ^^^^^ not defined
      |
      = help: did you mean 'K_pwm'?
    ");
}

#[test]
fn second_places() {
    let twice = format!("{HEAD}K = 3\n[loop]\ncharacteristic = 'z - K'\n");
    let error = Model::from_toml(&Source::new("m.toml", twice)).unwrap_err();
    insta::assert_snapshot!(render_error(&error, false), @r"
    error[E-duplicate-key]: 'K' is defined twice
     --> m.toml:4:1
      |
    3 | K = { nominal = 1 }
      | - first defined here
    4 | K = 3
      | ^ defined again here
      |
      = help: keep one of the two
    ");
    let cycle = "time = 'discrete'\n[constants]\na = 'b + 1'\nb = '2*c'\nc = 'a'\n[loop]\ncharacteristic = 'z - a'\n";
    let error = Model::from_toml(&Source::new("m.toml", cycle)).unwrap_err();
    insta::assert_snapshot!(render_error(&error, false), @r"
    error[E-cycle]: constants are defined by each other: a -> b -> c -> a
     --> m.toml:3:1
      |
    3 | a = 'b + 1'
      | ^ depends on itself
    4 | b = '2*c'
      | - by way of this
    5 | c = 'a'
      | - by way of this
      |
      = help: give one of them a value of its own
    ");
}

#[test]
fn structure() {
    for (text, expected) in [
        ("[loop]\n", "E-missing@4:2"),
        ("", "E-missing"),
        ("[loop]\ncharacteristic = 'z'\nmatrix = [[1]]\n", "E-two-forms@6:1"),
        ("[loop]\nmatrix = [[1, 2]]\n", "E-size@5:10"),
        ("[loop]\nmatrix = [[1, 2], [3]]\n", "E-size@5:19"),
        ("[loop]\nmatrix = [[1, 'K'], [2, 3]]\nstates = ['x']\n", "E-size@6:10"),
        ("[loop]\nmatrix = [[1, 'K'], [2, 3]]\nstates = 'x'\n", "E-size@6:10"),
        ("[loop]\nmatrix = 5\n", "E-type@5:10"),
        ("[loop]\nmatrix = [[true]]\n", "E-type@5:12"),
        ("[loop]\nmatrix = [[1979-05-27]]\n", "E-type@5:12"),
        ("[loop]\nmatrix = [[inf]]\n", "E-number@5:12"),
        ("[loop]\nmatrix = [[0x10]]\n", "E-number@5:12"),
        ("[loop]\nA = [[1]]\nB = [[1], [2]]\nC = [[1]]\nK = [['K']]\n", "E-size@6:5"),
        ("[loop]\nA = [[1]]\nB = [[1]]\nC = [[1]]\nK = [['K', 2]]\n", "E-size@8:5"),
        ("[loop]\nA = [[1]]\nB = [[1]]\nC = [[1]]\n", "E-missing@5:1"),
        ("[loop]\ncharacteristic = 'z - K'\n[loop]\n", "E-duplicate-key@6:2"),
        ("[loop]\ncharacteristc = 'z - K'\n", "E-unknown-key@5:1"),
        ("[constants]\nz = 1\n[loop]\ncharacteristic = 'z - K'\n", "E-reserved-name@5:1"),
        ("[constants]\nradius = 1\n[loop]\ncharacteristic = 'z - K'\n", "E-reserved-name@5:1"),
        ("[constants]\nK = 1\n[loop]\ncharacteristic = 'z - K'\n", "E-duplicate-name@3:1"),
        ("[constants]\n'2x' = 1\n[loop]\ncharacteristic = 'z - K'\n", "E-name@5:1"),
        ("[constants]\n\"\u{3164}\" = 1\n[loop]\ncharacteristic = 'z - K'\n", "E-name@5:1"),
        ("[constants]\n\"c\u{ffa0}\" = 1\n[loop]\ncharacteristic = 'z - K'\n", "E-name@5:1"),
        ("[loop]\ncharacteristic = 'z - K\u{115f}'\n", "E-syntax@5:24"),
        ("[loop]\ncharacteristic = 'z - K\n", "E-toml@5:24"),
        ("[loop]\nmatrix = [['K']]\n[simulation]\ninputs = { r = 1 }\n", "E-unknown-name@7:12"),
        ("[loop]\nmatrix = [['K']]\nstates = ['x']\n[simulation]\nunits = { y = 'A' }\n", "E-unknown-name@8:11"),
        ("[loop]\nmatrix = [['K']]\nstates = ['x']\n[simulation]\nunits = { x = 1 }\n", "E-type@8:15"),
    ] {
        let found = after_head(text);
        assert!(found.iter().any(|f| f == expected), "{text}: {found:?}");
    }
    assert_eq!(errors("time = 'discret'\nloop.characteristic = 'z'\n"), ["E-value@1:8"]);
    assert_eq!(errors("loop.characteristic = 'z'\n"), ["E-missing"]);
    let domain = "time = 'discrete'\nparameters.K = { min = 2, max = 2 }\nloop.characteristic = 'z - K'\n";
    assert_eq!(errors(domain), ["E-empty-domain@2:33"]);
    let nominal = "time = 'discrete'\nparameters.K = { nominal = 'x' }\nloop.characteristic = 'z - K'\n";
    assert_eq!(errors(nominal), ["E-unknown-name@2:29"]);
}

#[test]
fn blocks() {
    let model = |blocks: &str| after_head(&format!("[loop]\ninputs = ['r']\noutputs = ['y']\n{blocks}"));
    let block =
        |input: &str, output: &str, rest: &str| format!("[[block]]\ninput = '{input}'\noutput = '{output}'\n{rest}\n");
    assert_eq!(model(&block("r - K*y", "y", "transfer = '1/(z-1)'")), [""; 0]);
    for (blocks, expected) in [
        (block("r - K*x", "y", "gain = 'K'"), "E-unknown-name@8:16"),
        (block("r - K*y*y", "y", "gain = 'K'"), "E-not-linear@8:18"),
        (block("r - K*y + 1", "y", "gain = 'K'"), "E-not-linear@8:10"),
        (block("r - K*y", "y", "transfer = 'z^2/(z-1)'"), "E-improper@10:13"),
        (block("r + K*y", "y", "gain = '1/K'"), "E-algebraic-loop@7:3"),
        (block("r - K*y", "y", "delay = 1.5"), "E-value@10:9"),
        (block("r - K*y", "y", "delay = -1"), "E-value@10:9"),
        (block("r - K*y", "y", "num = [1]"), "E-missing@10:1"),
        (block("r - K*y", "y", "gain = 1\ndelay = 1"), "E-two-forms@11:1"),
        (block("r - K*y", "r", "gain = 1"), "E-two-drivers@9:11"),
        (block("r - K*y", "K", "gain = 1"), "E-duplicate-name@9:11"),
        (block("r - K*y", "y", ""), "E-missing@7:3"),
        (block("r", "y", "transfer = 'K/s'\ndiscretize = { method = 'zho', T = 1 }"), "E-discretize@11:25"),
        (
            block("r", "y", "transfer = 'K/s'\ndiscretize = { method = 'tustin', T = 1, prewarp = 3.2 }"),
            "E-discretize@11:52",
        ),
        (
            block("r", "y", "transfer = 'K/s'\ndiscretize = { method = 'tustin', T = 1, prewarp = 0 }"),
            "E-discretize@11:52",
        ),
        (block("r", "y", "transfer = 'K/s'\ndiscretize = { method = 'tustn', T = 1 }"), "E-discretize@11:25"),
        (block("r", "y", "transfer = 'K/s'\ndiscretize = { method = 'forward' }"), "E-discretize@11:1"),
        (block("r", "y", "A = [[1]]\nB = [[1, 2]]"), "E-size@11:5"),
        (block("r", "y", "A = [[1, 0], [0, 'K']]\nB = [[1], [2]]"), "E-size@9:10"),
    ] {
        let found = model(&blocks);
        assert!(found.iter().any(|f| f == expected), "{blocks}: {found:?}");
    }
}

/// It was said too that a sample time is missing, which cannot be right as well.
#[test]
fn a_hold_in_a_continuous_loop_is_one_error() {
    let head = "time = 'continuous'\n[parameters]\nK = { nominal = 1 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n";
    let block = "[[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/s'\ndiscretize = 'zoh'\n";
    assert_eq!(errors(&format!("{head}{block}")), ["E-discretize@12:1"]);
}

#[test]
fn huge_and_broken_texts() {
    let long = count(1 << 14, 1 << 17);
    let digits = "7".repeat(long);
    assert_eq!(after_head(&format!("[loop]\nmatrix = [[{digits}, 'K'], [1, \"{digits}\"]]\n")), [""; 0]);
    assert_eq!(after_head("[loop]\nmatrix = [[1e400, 'K'], [1, 99999999999999999999]]\n"), [""; 0]);
    let open = "(".repeat(long);
    assert_eq!(characteristic(&open)[0], format!("E-too-deep@5:{}", 19 + jurist_engine::model::MAX_DEPTH));
    assert!(characteristic(&format!("z{}", "^2".repeat(long)))[0].starts_with("E-too-deep"));
    assert!(characteristic(&format!("z{}", "-".repeat(long)))[0].starts_with("E-too-deep"));
    assert!(after_head(&format!("[loop]\nmatrix = {open}", open = "[".repeat(long)))[0].starts_with("E-"));
    assert_eq!(characteristic(&format!("z{}", "+K".repeat(long / 4))), [""; 0]);
    assert_eq!(characteristic(&"x".repeat(long)), ["E-unknown-name@5:19"]);
    assert_eq!(characteristic("z + ((((((K+1)^1000)^1000)^1000)^1000)^1000)"), ["E-too-large@5:27"]);
    let chain: String = (1..20_000).map(|i| format!("c{i} = 'c{} + 1'\n", i - 1)).collect();
    let text = format!("{HEAD}[constants]\nc0 = 'K'\n{chain}[loop]\ncharacteristic = 'z - c19999'\n");
    assert_eq!(errors(&text), [""; 0]);
    let error = source_from_bytes("m.toml", b"time = 'discrete'\n\xff = 3\n").unwrap_err();
    assert_eq!(error.to_string(), "m.toml:2:1: error[E-utf8]: byte 19 is not valid UTF-8");
    assert_eq!(errors(&format!("\u{feff}{HEAD}[loop]\r\ncharacteristic = 'z - K'\r\n")), [""; 0]);
}

#[test]
fn warnings_come_with_the_loop() {
    let text = "time = 'discrete'\n[constants]\nc = 1\n[parameters]\nK = { nominal = 3, min = 0, max = 2 }\n\
        [loop]\ncharacteristic = 'z - K'\n";
    let source = Source::new("m.toml", text);
    let (_, warnings) = Model::from_toml(&source).unwrap();
    let codes: Vec<&str> = warnings.iter().map(|w| w.code.as_str()).collect();
    assert_eq!(codes, ["W-unused", "W-outside-domain"]);
    insta::assert_snapshot!(render(&warnings, Some(&source), false), @r"
    warning[W-unused]: the constant 'c' is not used
     --> m.toml:3:1
      |
    3 | c = 1
      | ^ not used

    warning[W-outside-domain]: the nominal value of 'K' is outside its domain
     --> m.toml:5:17
      |
    5 | K = { nominal = 3, min = 0, max = 2 }
      |                 ^                 - which ends here
      |                 |
      |                 not in the open domain
    ");
}

#[test]
fn undefined_is_no_error_of_the_text() {
    let text = "time = 'discrete'\n[parameters]\na = { nominal = 1 }\nb = { nominal = 1 }\n[loop]\ncharacteristic = 'z - 1/(a - b)'\n";
    let (model, _) = Model::from_toml(&Source::new("m.toml", text)).unwrap();
    let budget = Budget::unlimited();
    let nominal = model.ask().problem().unwrap();
    let algebra = nominal.algebra(&budget).unwrap();
    assert!(algebra.polynomial().is_none() && algebra.undefined().is_some());
    assert!(matches!(nominal.closed_loop(&budget), Err(Error::Undefined(_))));
    let p = polynomial_of(model.ask().free("a"));
    assert_eq!(p.poles[0].display(&p.variables).to_string(), "a - 1");
}
