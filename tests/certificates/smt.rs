//! The statements for SMT solvers: their form, and the answers of Z3 and cvc5 where they are there.

use crate::helpers::certificates::MODELS;
use crate::helpers::model::{example_text, read};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use std::process::{Command, Stdio};

fn script(model: &str, parameter: &str) -> String {
    let budget = Budget::unlimited();
    jurist::smt2(&read(model).ask().free(parameter).stable_set(&budget).unwrap(), &budget).unwrap()
}

/// The same script with a claimed set that holds another interval too.
fn widened(script: &str, interval: (&str, &str)) -> String {
    let (before, rest) = script.split_once("(define-fun claimed () Bool ").unwrap();
    let (claimed, after) = rest.split_once('\n').unwrap();
    let claimed = claimed.strip_suffix(')').unwrap();
    let (lower, upper) = interval;
    format!("{before}(define-fun claimed () Bool (or {claimed} (and (< {lower} p) (< p {upper}))))\n{after}")
}

/// cvc5 as Python's package brings it, without a program of its own.
const CVC5: &str = "import sys, cvc5
manager = cvc5.TermManager()
solver = cvc5.Solver(manager)
symbols = cvc5.SymbolManager(manager)
parser = cvc5.InputParser(solver, symbols)
parser.setFileInput(cvc5.InputLanguage.SMT_LIB_2_6, sys.argv[1])
while not (command := parser.nextCommand()).isNull():
    print(command.invoke(solver, symbols), end='')
";

/// Program and first arguments of a solver, if it is there.
fn solver(name: &str) -> Option<Vec<String>> {
    let runs = |arguments: &[&str]| {
        let mut command = Command::new(arguments[0]);
        command.args(&arguments[1..]).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|s| s.success())
    };
    if runs(&[name, "--version"]) {
        return Some(vec![name.into()]);
    }
    if name == "cvc5" && runs(&["python3", "-c", "import cvc5; cvc5.InputParser"]) {
        return Some(vec!["python3".into(), "-c".into(), CVC5.into()]);
    }
    println!("skipped: {name} is not there");
    None
}

fn answer(solver: &[String], what: &str, script: &str) -> String {
    let thread = std::thread::current().id();
    let file = std::env::temp_dir().join(format!("jurist-{}-{thread:?}.smt2", std::process::id()));
    std::fs::write(&file, script).unwrap();
    let output = Command::new(&solver[0]).args(&solver[1..]).arg(&file).output().unwrap();
    let _ = std::fs::remove_file(&file);
    println!("{}: {what}", solver[0]);
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

/// `z - 1 + K` by hand: Jury's conditions are K > 0, 2 - K > 0 and |K - 1| < 1.
#[test]
fn a_script_by_hand() {
    let text = script("time = 'discrete'\nparameters.K = { min = -3 }\nloop.characteristic = 'z - 1 + K'", "K");
    let expected = "\
; p is the parameter 'K'
; unsat: the loop is stable exactly on the claimed set
(set-logic QF_NRA)
(declare-const p Real)
(assert (< (- 3.0) p))
(define-fun stable () Bool (and (> (+ 0.0 (* p 1.0)) 0.0) (> (+ 2.0 (* p (- 1.0))) 0.0) \
(or (and (> (+ 2.0 (* p (- 1.0))) 0.0) (> (+ 0.0 (* p 1.0)) 0.0)) \
(and (< (+ 2.0 (* p (- 1.0))) 0.0) (< (+ 0.0 (* p 1.0)) 0.0)))))
(define-fun claimed () Bool (and (< 0.0 p) (< p 2.0)))
(assert (distinct stable claimed))
(check-sat)
";
    assert_eq!(text, expected);
}

/// Each statement is `unsat`; with an interval too many it is `sat`.
fn prove(name: &str, left_out: &[(&str, &str)]) {
    let Some(solver) = solver(name) else { return };
    for (what, model, parameter) in MODELS {
        let script = script(model, parameter);
        assert_eq!(answer(&solver, what, &script), "unsat", "{script}");
    }
    for (file, parameter, unstable) in [
        ("drive", "K_pwm", ("600.0", "601.0")),
        ("drive", "T", ("0.1", "0.2")),
        ("equation-23-as-printed", "K_pwm", ("600.0", "601.0")),
        ("equation-37-as-printed", "T", ("0.1", "0.2")),
        ("buck-converter", "K_p", ("1.0", "2.0")),
        ("pmsm-current-loop", "K_p", ("1000.0", "1001.0")),
        ("pmsm-current-loop", "omega_e", ("5000.0", "6000.0")),
        ("lcl-active-damping", "k", ("2.0", "3.0")),
        ("lcl-grid-current", "K_p", ("40.0", "41.0")),
        ("lcl-grid-current", "K_ad", ("0.0", "1.0")),
        ("digital-pll", "K_i", ("5.0", "6.0")),
        ("heavy-ball", "alpha", ("1.0", "2.0")),
        ("adams-bashforth-3", "q", ("1.0", "2.0")),
        ("bdf-3", "q", ("1.0", "2.0")),
        ("ogata-jury", "K", ("3.0", "4.0")),
        ("ogata-hurwitz", "K", ("2.0", "3.0")),
        ("franklin-hurwitz", "K", ("1.0", "2.0")),
    ] {
        if left_out.contains(&(file, parameter)) {
            println!("left out: {file} {parameter} takes {name} too long for a test");
            continue;
        }
        let script = script(&example_text(file), parameter);
        let what = format!("{file} {parameter}");
        assert_eq!(answer(&solver, &what, &script), "unsat", "{script}");
        assert_eq!(answer(&solver, &format!("{what}, widened"), &widened(&script, unstable)), "sat", "{what}");
    }
}

#[test]
fn z3_agrees() {
    prove("z3", &[]);
}

#[test]
fn cvc5_agrees() {
    // 18 s and 49 s on a machine on which Z3 takes 1 s and 2 s.
    prove("cvc5", &[("drive", "T"), ("equation-37-as-printed", "T")]);
}
