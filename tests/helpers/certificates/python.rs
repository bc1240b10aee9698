//! `crates/check/check.py` in one process for many certificates.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::OnceLock;

/// Reads one JSON list `[model, certificate]` per line, writes `[accepted, sentence]`.
const DRIVER: &str = "import sys, json
sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
import check
for line in sys.stdin:
    print(json.dumps(check.judge(*json.loads(line))), flush=True)
";

/// Whether there is a Python with `tomllib`; where there is none, a line says so.
pub fn is_there() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let there = Command::new("python3").args(["-c", "import tomllib"]).stderr(Stdio::null()).status();
        let there = there.is_ok_and(|s| s.success());
        if !there {
            println!("skipped: python3 with tomllib is not there");
        }
        there
    })
}

/// A running checker.
pub struct Python {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Python {
    pub fn start() -> Python {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/crates/check");
        let mut command = Command::new("python3");
        command.args(["-c", DRIVER, folder]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("python3 is there");
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().expect("piped"));
        Python { child, input, output }
    }

    /// The proved statement, or why the certificate is rejected.
    pub fn check(&mut self, model: &str, certificate: &str) -> Result<String, String> {
        let line = serde_json::to_string(&(model, certificate)).expect("two texts");
        writeln!(self.input.as_mut().expect("open"), "{line}").expect("the checker reads");
        let mut answer = String::new();
        self.output.read_line(&mut answer).expect("the checker writes");
        let (accepted, sentence): (bool, String) = serde_json::from_str(&answer).expect("the checker did not end");
        if accepted { Ok(sentence) } else { Err(sentence) }
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        drop(self.input.take());
        let _ = self.child.wait();
    }
}
