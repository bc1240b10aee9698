//! What compilers make of the code.

use crate::cases::{Case, Dice, Numbers, Signal, inputs, samples};
use crate::{controllers, drawn};
use jurist_algebra::number::Rational;
use jurist_ship::emit::Target;
use std::fmt::Write;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Controllers with their inputs and what the exact run makes of them.
pub struct Run {
    pub case: Case,
    pub inputs: Vec<Vec<i64>>,
    pub rows: Vec<Vec<Rational>>,
}

/// All controllers, each with as many samples.
pub fn runs() -> &'static [Run] {
    static RUNS: OnceLock<Vec<Run>> = OnceLock::new();
    RUNS.get_or_init(|| {
        let pairs = controllers::in_fixed_point();
        let mut cases: Vec<Case> = pairs.into_iter().flatten().collect();
        cases.extend(controllers::in_floating_point());
        cases.extend(controllers::singular());
        cases.extend(drawn::several(30));
        let each = samples().div_ceil(cases.len());
        let run = |(at, case): (usize, Case)| {
            // Pairs that differ in overflow only have the same inputs.
            let inputs = inputs(&case, each, &mut Dice(at as u64 / 2));
            Run { rows: case.run(&inputs), case, inputs }
        };
        cases.into_iter().enumerate().map(run).collect()
    })
}

/// What stands between two texts, the first time it does.
fn between<'t>(text: &'t str, before: &str, behind: &str) -> &'t str {
    let (_, rest) = text.split_once(before).unwrap_or_else(|| panic!("no `{before}` in\n{text}"));
    rest.split_once(behind).unwrap_or_else(|| panic!("no `{behind}` in\n{rest}")).0
}

/// The name of a type of signals: of integers, and of the formats of floating point.
fn signal_type(case: &Case, integers: [&'static str; 3], floats: [&'static str; 2]) -> &'static str {
    match &case.numbers {
        Numbers::Fixed { signal, .. } => integers[usize::from(signal.bits > 16) + usize::from(signal.bits > 32)],
        Numbers::Float { .. } => floats[usize::from(case.signal() == Signal::Double)],
    }
}

/// A function that reads the inputs of a controller, and prints its outputs and states.
fn c_driver(case: &Case, header: &str, run: &str) -> String {
    let name = between(header, "\n} ", "_state;");
    let signal = signal_type(case, ["int16_t", "int32_t", "int64_t"], ["float", "double"]);
    let (make, take) = match case.signal() {
        Signal::Integer => (signal.to_owned(), "int64_t"),
        Signal::Single => ("single".into(), "of_single"),
        Signal::Double => ("of_bits".into(), "bits"),
    };
    let make = if case.signal() == Signal::Integer { format!("({make})") } else { make };
    let take = if case.signal() == Signal::Integer { format!("({take})") } else { take.into() };
    let (inputs, outputs) = (case.program.inputs, case.program.outputs.len());
    let read: String = (0..inputs).map(|k| format!("        const {signal} u{k} = {make}(word());\n")).collect();
    let mut arguments: Vec<String> =
        std::iter::once("&s".to_owned()).chain((0..inputs).map(|k| format!("u{k}"))).collect();
    let call = match outputs {
        0 => String::new(),
        1 => format!("{signal} y[1];\n        y[0] = "),
        _ => {
            arguments.push("y".into());
            format!("{signal} y[{outputs}];\n        ")
        }
    };
    let fields = between(header, "typedef struct {\n", "}").lines();
    let states = fields.filter_map(|line| line.trim().split_once(' ')).filter(|_| !case.program.states.is_empty());
    let states = states.map(|(_, name)| format!("s.{}", name.trim_end_matches(';')));
    let printed = (0..outputs).map(|k| format!("y[{k}]")).chain(states);
    let printed: String = printed.map(|value| format!("        print({take}({value}));\n")).collect();
    format!(
        "static void {run}(void)
{{
    {name}_state s;
    int64_t n = word();
    {name}_init(&s);
    while (n-- > 0) {{
{read}        {call}{name}_step({});
{printed}        putchar('\\n');
    }}
}}
",
        arguments.join(", ")
    )
}

const C_HEAD: &str = "#include <inttypes.h>\n#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>
static int64_t word(void) { int64_t w; if (scanf(\"%\" SCNd64, &w) != 1) { abort(); } return w; }
static void print(int64_t w) { printf(\"%\" PRId64 \" \", w); }
static float single(int64_t w) { const uint32_t b = (uint32_t)w; float x; memcpy(&x, &b, 4); return x; }
static int64_t of_single(float x) { uint32_t b; memcpy(&b, &x, 4); return (int64_t)b; }
static double of_bits(int64_t w) { double x; memcpy(&x, &w, 8); return x; }
static int64_t bits(double x) { int64_t w; memcpy(&w, &x, 8); return w; }
";

/// A folder of this name for files that are compiled.
pub fn folder(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn words(runs: &[Run]) -> String {
    let mut text = String::new();
    for run in runs {
        writeln!(text, "{}", run.inputs.len()).unwrap();
        for word in run.inputs.iter().flatten() {
            writeln!(text, "{word}").unwrap();
        }
    }
    text
}

/// Runs a program on all inputs, and compares what it prints with the exact run; how many samples were compared.
fn compared(program: &PathBuf, runs: &[Run]) -> usize {
    let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let text = words(runs);
    let writer = std::thread::spawn(move || stdin.write_all(text.as_bytes()));
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{program:?} ends with {}", output.status);
    writer.join().unwrap().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    let mut lines = printed.lines();
    let mut count = 0;
    for run in runs {
        let case = &run.case;
        for (at, sample) in run.inputs.iter().enumerate() {
            let line = lines.next().expect("a line for each sample");
            let Some(expected) = run.rows.get(at) else { continue };
            let found: Vec<i64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            let found: Vec<Rational> = found.into_iter().map(|word| case.value(word)).collect();
            assert_eq!(&found, expected, "{} ({:?}), sample {at}, input {sample:?}", case.name, case.numbers);
            count += 1;
        }
    }
    assert_eq!(lines.next(), None);
    count
}

#[test]
#[ignore = "long: CI runs it"]
fn c_computes_what_the_exact_run_computes() {
    if Command::new("cc").arg("--version").output().is_err() {
        println!("there is no cc: code in C is not compiled");
        return;
    }
    let (runs, folder) = (runs(), folder("emit_c"));
    let (mut main, mut calls) = (C_HEAD.to_owned(), String::new());
    for (at, run) in runs.iter().enumerate() {
        let header = run.case.text(Target::C, &[]).unwrap();
        std::fs::write(folder.join(format!("c{at}.h")), &header).unwrap();
        write!(main, "#include \"c{at}.h\"\n{}", c_driver(&run.case, &header, &format!("run{at}"))).unwrap();
        writeln!(calls, "    run{at}();").unwrap();
    }
    write!(main, "int main(void)\n{{\n{calls}    return 0;\n}}\n").unwrap();
    std::fs::write(folder.join("main.c"), main).unwrap();
    let program = folder.join("main");
    compile(Command::new("cc").args(C_FLAGS).arg(folder.join("main.c")).arg("-o").arg(&program));
    println!("C: {} samples of {} controllers", compared(&program, runs), runs.len());
}

/// All that warns, and stops at what the language leaves undefined.
const C_FLAGS: [&str; 12] = [
    "-std=c99",
    "-O1",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wsign-conversion",
    "-Wshadow",
    "-Werror",
    "-pedantic",
    "-fsanitize=undefined",
    "-fno-sanitize-recover=undefined",
    "-ffp-contract=off",
];

fn compile(command: &mut Command) {
    let done = command.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

fn rust_driver(case: &Case, module: &str, at: usize) -> String {
    let kind = between(module, "pub struct ", " {");
    let signal = signal_type(case, ["i16", "i32", "i64"], ["f32", "f64"]);
    let (make, take) = match case.signal() {
        Signal::Integer => (format!("w as {signal}"), "x as i64"),
        Signal::Single => ("f32::from_bits(w as u32)".into(), "i64::from(x.to_bits())"),
        Signal::Double => ("f64::from_bits(w as u64)".into(), "x.to_bits() as i64"),
    };
    let read = |k: usize| format!("        let w = next();\n        let u{k} = {make};\n");
    let read: String = (0..case.program.inputs).map(read).collect();
    let arguments: Vec<String> = (0..case.program.inputs).map(|k| format!("u{k}")).collect();
    let call = format!("c.step({})", arguments.join(", "));
    let call = if case.program.outputs.len() == 1 { format!("[{call}]") } else { call };
    let fields = between(module, "pub struct ", "}\n").lines().skip(1);
    let states = fields.filter_map(|line| line.trim().strip_prefix("pub ")?.split_once(':'));
    let states: Vec<String> = states.map(|(state, _)| format!("c.{state}")).collect();
    format!(
        "fn run{at}(next: &mut dyn FnMut() -> i64, out: &mut dyn Write) {{
    let mut c = m{at}::{kind}::new();
    for _ in 0..next() {{
{read}        let y = {call};
        let states: [{signal}; {}] = [{}];
        for x in y.into_iter().chain(states) {{
            write!(out, \"{{}} \", {take}).unwrap();
        }}
        writeln!(out).unwrap();
    }}
}}
",
        states.len(),
        states.join(", ")
    )
}

const RUST_MAIN: &str = "fn main() {
    let mut text = std::string::String::new();
    std::io::stdin().read_to_string(&mut text).unwrap();
    let mut words = text.split_ascii_whitespace().map(|word| word.parse::<i64>().unwrap());
    let mut next = || words.next().unwrap();
    let mut out = std::io::BufWriter::new(std::io::stdout());
";

#[test]
#[ignore = "long: CI runs it"]
fn rust_computes_what_the_exact_run_computes() {
    let (runs, folder) = (runs(), folder("emit_rust"));
    // The modules have no standard library.
    let mut main = "#![no_std]\n#![deny(warnings)]\nextern crate std;\nuse std::io::{Read, Write};\n".to_owned();
    let mut calls = String::new();
    for (at, run) in runs.iter().enumerate() {
        let module = run.case.text(Target::Rust, &[]).unwrap();
        std::fs::write(folder.join(format!("m{at}.rs")), &module).unwrap();
        write!(main, "mod m{at};\n{}", rust_driver(&run.case, &module, at)).unwrap();
        writeln!(calls, "    run{at}(&mut next, &mut out);").unwrap();
    }
    writeln!(main, "{RUST_MAIN}{calls}}}").unwrap();
    std::fs::write(folder.join("main.rs"), main).unwrap();
    let program = folder.join("main");
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    // A sum that overflows ends the program.
    let flags = ["--edition=2021", "-Coverflow-checks=on", "-Cdebug-assertions=on"];
    compile(Command::new(compiler).args(flags).arg(folder.join("main.rs")).arg("-o").arg(&program));
    println!("Rust: {} samples of {} controllers", compared(&program, runs), runs.len());
}
