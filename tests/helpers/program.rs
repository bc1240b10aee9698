//! Running the built program.

use super::number::number;
use super::schema::fits;
use jurist_algebra::number::Rational;
use serde_json::Value;
use std::io::Write;
use std::process::{Command, Output, Stdio};

/// What a run gave.
pub struct Run {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
}

/// The program with arguments, away from any terminal.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jurist"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).env_remove("NO_COLOR");
    command
}

fn finished(output: Output) -> Run {
    let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
    Run { status: output.status.code().expect("no signal"), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// Runs the program.
pub fn jurist(arguments: &[&str]) -> Run {
    finished(command(arguments).stdin(Stdio::null()).output().expect("the program runs"))
}

/// Runs the program with a model on standard input.
pub fn jurist_with_input(arguments: &[&str], input: &[u8]) -> Run {
    finished(output_with_input(&mut command(arguments), input))
}

/// Runs the program with a model on standard input and no more address space than so many kilobytes, on one thread; where it ends for
/// want of memory the status is that of the shell.
#[cfg(target_os = "linux")]
pub fn within_address_space(kilobytes: usize, arguments: &[&str], input: &[u8]) -> Run {
    let mut shell = Command::new("sh");
    let script = format!("ulimit -v {kilobytes} && \"$0\" \"$@\"; exit $?");
    shell.args(["-c", &script, env!("CARGO_BIN_EXE_jurist")]).args(arguments).env("RAYON_NUM_THREADS", "1");
    finished(output_with_input(&mut shell, input))
}

fn output_with_input(command: &mut Command, input: &[u8]) -> Output {
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program runs");
    // A program that refuses its arguments does not read.
    let _ = child.stdin.take().expect("piped").write_all(input);
    child.wait_with_output().expect("the program ends")
}

/// The first answer from `run`, given an eighth of a second, then twice as much and so on: a machine may be as slow as it likes, and where there
/// is never an answer, the test never ends.
pub fn given_time<T>(run: impl Fn(&str) -> Option<T>) -> T {
    (0..).find_map(|doublings| run(&(f64::from(1u32 << doublings) / 8.0).to_string())).expect("at some time")
}

/// Runs the program and reads its JSON, which fits its schema.
pub fn json(arguments: &[&str]) -> Value {
    let run = jurist(arguments);
    assert_eq!(run.status, 0, "{arguments:?}: {}", run.stderr);
    let document = serde_json::from_str(&run.stdout).expect("the program writes JSON");
    fits(&document).unwrap_or_else(|why| panic!("{arguments:?}: {why}"));
    document
}

/// Runs the program on arguments that it refuses: status 2, an error with this code, no panic.
pub fn refused(arguments: &[&str], code: &str) -> Run {
    let run = jurist(arguments);
    check_refused(&run, code, &format!("{arguments:?}"));
    run
}

/// Runs the program on a model that it refuses.
pub fn refused_model(model: &[u8], code: &str) -> Run {
    let run = jurist_with_input(&["analyze", "-"], model);
    check_refused(&run, code, &String::from_utf8_lossy(&model[..model.len().min(200)]));
    run
}

fn check_refused(run: &Run, code: &str, what: &str) {
    assert_eq!(run.status, 2, "{what}: {}", run.stderr);
    assert!(run.stderr.contains(&format!("error[{code}]")), "{what}: expected {code}: {}", run.stderr);
    assert!(!run.stderr.contains("panicked") && !run.stderr.contains("E-internal"), "{what}: {}", run.stderr);
    assert_eq!(run.stdout, "", "{what}");
}

/// The number that a text in JSON says.
pub fn number_in(value: &Value) -> Rational {
    number(value.as_str().expect("a number as text"))
}
