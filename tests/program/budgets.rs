//! Budgets of time and memory: kept by every command, whatever the step, and never by an abort.

use crate::helpers::budget::endless_model;
use crate::helpers::program::{Run, command, jurist, jurist_with_input, within_address_space};
use serde_json::Value;
use std::fmt::Write;
use std::io::Read;
use std::process::Stdio;

/// Two blocks of so many samples of delay each, in a loop.
fn delays(samples: u32) -> String {
    format!(
        "time = 'discrete'\nparameters.K = 1\n[loop]\n[[block]]\ninput = '-K*y'\noutput = 'w'\ndelay = {samples}\n\
         [[block]]\ninput = 'w'\noutput = 'y'\ndelay = {samples}\n"
    )
}

fn is_undecided(run: &Run, budget: &str) {
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stderr.contains(&format!("undecided: the budget ran out: {budget}; reached: ")), "{}", run.stderr);
    assert!(!run.stderr.contains("allocation") && !run.stderr.contains("panicked"), "{}", run.stderr);
}

/// A matrix of 4000 rows is asked for, and refused before it is there.
#[test]
fn too_much_memory_is_refused_before_it_is_taken() {
    let arguments = ["intervals", "-", "--param", "K", "--json", "--memory", "100"];
    let run = jurist_with_input(&arguments, delays(2000).as_bytes());
    is_undecided(&run, "memory (100 MB)");
    // The default limit ends it as well, and the process has not taken much more.
    #[cfg(target_os = "linux")]
    for memory in crate::helpers::thorough::tried([&[][..], &["--memory", "100"]], 2) {
        let arguments = [&["verdict", "-"], memory].concat();
        let run = within_address_space(2_000_000, &arguments, delays(2000).as_bytes());
        is_undecided(&run, if memory.is_empty() { "memory (800 MB)" } else { "memory (100 MB)" });
    }
}

/// A read that never ends does not look at the clock; the program ends all the same, after three seconds. In them another one works: a common
/// divisor of polynomials in so many variables takes more memory than any machine has. It is that of the period map of a converter written by
/// hand, over four functions of the duty cycle and an inverse.
#[test]
fn what_does_not_look_at_its_budget_and_a_common_divisor_in_many_variables_are_ended() {
    let mut child = command(&["verdict", "-", "--timeout", "0.1"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let held = child.stdin.take();
    let model = "time = 'discrete'\n[constants]\nV = 24\nL = 47e-6\nC = 22e-6\nR = 4\nT = 1e-5\na = '-1/(2*R*C)'\nb = 'sqrt(1/(L*C) - a^2)'\n\
        eT = 'exp(a*T)'\nc = 'eT*cos(b*T)'\ns = 'eT*sin(b*T)/b'\nE11 = 'c - s*a'\nE12 = '-s/L'\nE21 = 's/C'\nE22 = 'c + s*a'\n\
        ed = 'exp(a*(1-D)*T)'\ncd = 'ed*cos(b*(1-D)*T)'\nsd = 'ed*sin(b*(1-D)*T)/b'\nF11 = 'cd - sd*a'\nF12 = '-sd/L'\nF21 = 'sd/C'\n\
        F22 = 'cd + sd*a'\nn = 'F11*F22 - F12*F21'\nh1 = '(F22*V/R - F12*V)/n'\nh2 = '(-F21*V/R + F11*V)/n'\nr1 = 'V/R - E11*h1 - E12*h2'\n\
        r2 = 'V - E21*h1 - E22*h2'\nd0 = '(1-E11)*(1-E22) - E12*E21'\nv = '(E21*r1 + (1-E11)*r2)/d0'\nk = '-V/L/((V-v)/L)'\n\
        [parameters]\nD = { nominal = 0.3, min = 0, max = 1 }\n[loop]\nmatrix = [['E11*(1+k)', 'E12'], ['E21*(1+k)', 'E22']]\n";
    let run = jurist_with_input(&["intervals", "-", "--param", "D", "--memory", "30", "-q"], model.as_bytes());
    is_undecided(&run, "memory (30 MB)");
    let mut said = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
    assert_eq!(child.wait().expect("it ends").code(), Some(3), "{said}");
    assert!(said.contains("undecided: the budget ran out: time (0.1 s)"), "{said}");
    drop(held);
}

/// A limit that is passed already: each command says so, with all that is known of the question.
#[test]
fn a_limit_of_memory_ends_every_question() {
    let all = [
        &["analyze"][..],
        &["intervals", "--param", "K_pwm"],
        &["verdict"],
        &["charpoly"],
        &["jury", "--param", "T"],
        &["map", "-x", "T", "-y", "K_pwm", "--json"],
        &["locus", "--param", "T"],
        &["margins", "--at", "e_c"],
        &["bode", "--at", "e_c"],
        &["norm", "omega_ref", "omega"],
        &["norm", "omega_ref", "omega", "--l1"],
        &["simulate"],
        &["tolerance", "--tol", "R_a=10%"],
        &["sweep", "--over", "T=1e-4,2e-4"],
    ];
    for arguments in all {
        let run = jurist(&[arguments, &["--memory", "0"]].concat());
        assert_eq!(run.status, 3, "{arguments:?}: {}", run.stderr);
        let is_said = run.stderr.contains("the budget ran out: memory (0 MB)") || arguments[0] == "sweep";
        assert!(is_said, "{arguments:?}: {}", run.stderr);
    }
    let run = jurist(&["intervals", "--param", "K_pwm", "--json", "--memory", "0"]);
    let document: Value = serde_json::from_str(&run.stdout).expect("a document");
    assert_eq!((&document["stable"], &document["undecided"]["budget"]), (&Value::Null, &"memory (0 MB)".into()));
    assert_eq!(jurist(&["verdict", "--memory", "1000000"]).status, 0);
    assert_eq!(jurist(&["verdict", "--memory", "-1"]).status, 2);
}

/// `--timeout` ends the questions of a sweep, however long each of them may take; those that were begun stay open.
#[test]
fn a_sweep_ends_with_its_time() {
    let model = endless_model().replace("parameters.K = 1", "parameters.K = 1\nparameters.L = 1");
    let arguments = ["sweep", "-", "--param", "K", "--over", "L=1,2,3", "--each", "1000000", "--timeout", "0.25"];
    let run = jurist_with_input(&arguments, model.as_bytes());
    assert_eq!((run.status, run.stdout.as_str()), (3, ""), "{}", run.stderr);
    assert!(run.stderr.contains("undecided: the budget ran out: time (0.25 s)"), "{}", run.stderr);
}

/// A limit of a hundred thousand digits, and as many digits of a third: pieces are longer than a format can be wide.
#[test]
fn very_many_digits_within_a_budget() {
    let model =
        |number: &str| format!("time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = 'z - {number}*K'\n");
    let arguments = ["intervals", "-", "--param", "K", "--digits", "80000", "--timeout", "1000000"];
    let run = jurist_with_input(&arguments, model("3").as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains(&"3".repeat(80_000)) && !run.stdout.contains(&"3".repeat(80_001)));
    let run = jurist_with_input(&arguments[..4], model("3e99999").as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let arguments = [&arguments[..4], &["--timeout", "1000000", "--json"]].concat();
    let run = jurist_with_input(&arguments, model("3e99999").as_bytes());
    let document: Value = serde_json::from_str(&run.stdout).expect("a document");
    let expected = format!("1/3{}", "0".repeat(99_999));
    assert_eq!(document["stable"][0]["upper"]["exact"].as_str(), Some(expected.as_str()));
}

/// Warnings are counted, so that writing them takes no time.
#[test]
fn thousands_of_warnings_are_counted() {
    let mut model = "time = 'discrete'\nparameters.K = {}\n[constants]\n".to_owned();
    for i in 0..40_000 {
        writeln!(model, "c{i} = {i}").unwrap();
    }
    model += "[loop]\ncharacteristic = 'z - K'\n";
    let run = jurist_with_input(&["intervals", "-", "--param", "K"], model.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(run.stderr.matches("warning[W-unused]").count(), 21);
    assert!(run.stderr.contains("39980 more warnings of this kind are not shown"), "{}", run.stderr);
}

/// The certificate asks for exact polynomials over all constants, which are not to be had with ten times the work; the limits are.
#[test]
#[ignore = "long: CI runs it"]
fn an_answer_is_not_lost_where_its_certificate_takes_too_much_work() {
    let model = "time = 'discrete'\nsample_time = 0.1\n[parameters]\nK = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/((s+1)*(s+2)*(s^2+0.4*s+4)*(s^2+0.66*s+11))'\ndiscretize = 'zoh'\n";
    let folder = std::env::temp_dir().join(format!("jurist-late-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("certificate.json").to_str().unwrap().to_owned();
    let asked = ["intervals", "-", "--param", "K", "--work", "400000000", "--certificate", &file];
    let run = jurist_with_input(&asked, model.as_bytes());
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stdout.contains("0 < K < 38.7676542687"), "{}", run.stdout);
    assert!(run.stderr.contains("undecided: the budget ran out: work (400000000 units)"), "{}", run.stderr);
    std::fs::remove_dir_all(&folder).unwrap();
}
