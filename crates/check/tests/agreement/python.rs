//! `check.py` in one process for many texts.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Mutex, MutexGuard, OnceLock};

/// Reads two lines of hexadecimal digits, writes two of them: accepted or not, and what is said.
const DRIVER: &str = "import sys
sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
import check
while line := sys.stdin.readline():
    model, certificate = (bytes.fromhex(part).decode() for part in (line, sys.stdin.readline()))
    accepted, said = check.judge(model, certificate)
    word = 'accepted' if accepted else 'refused' if said.startswith('refused: ') else 'rejected'
    print(word, said.encode(errors='backslashreplace').hex(), flush=True)
";

/// A test's turn with the checker in Python. The checker runs on for the next test, because its start takes longer than most checks.
pub struct Python {
    running: Option<Running>,
}

struct Running {
    /// Ends with the test program, which its input ends with.
    _child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

/// As many as tests asked at once.
static IDLE: Mutex<Vec<Running>> = Mutex::new(Vec::new());

fn idle() -> MutexGuard<'static, Vec<Running>> {
    IDLE.lock().unwrap_or_else(|e| e.into_inner())
}

fn is_there() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let there = Command::new("python3").args(["-c", "import tomllib"]).stderr(Stdio::null()).status();
        there.is_ok_and(|status| status.success())
    })
}

impl Running {
    fn start() -> Running {
        let mut command = Command::new("python3");
        command.args(["-c", DRIVER, env!("CARGO_MANIFEST_DIR")]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("python3 is there");
        let input = child.stdin.take().expect("piped");
        let output = BufReader::new(child.stdout.take().expect("piped"));
        Running { _child: child, input, output }
    }
}

impl Python {
    /// `None` where there is no Python with `tomllib`, which is said.
    pub fn start() -> Option<Python> {
        if !is_there() {
            println!("skipped: python3 with tomllib is not there");
            return None;
        }
        let waiting = idle().pop();
        Some(Python { running: Some(waiting.unwrap_or_else(Running::start)) })
    }

    /// The word, and the statement or the reason.
    pub fn judge(&mut self, model: &str, certificate: &str) -> (String, String) {
        let hex = |text: &str| text.bytes().map(|byte| format!("{byte:02x}")).collect::<String>();
        let running = self.running.as_mut().expect("until it is dropped");
        writeln!(running.input, "{}\n{}", hex(model), hex(certificate)).expect("the checker reads");
        let mut answer = String::new();
        running.output.read_line(&mut answer).expect("the checker writes");
        let (word, said) = answer.trim_end().split_once(' ').expect("the checker did not end");
        let byte = |at: usize| u8::from_str_radix(&said[at..at + 2], 16).expect("hexadecimal digits");
        let bytes = (0..said.len()).step_by(2).map(byte).collect();
        (word.to_owned(), String::from_utf8(bytes).expect("UTF-8"))
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        // In the middle of a failed test it may owe an answer.
        if !std::thread::panicking() {
            idle().extend(self.running.take());
        }
    }
}
