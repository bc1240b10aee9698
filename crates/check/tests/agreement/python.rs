//! `check.py` in one process for many texts.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

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

pub struct Python {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Python {
    /// `None` where there is no Python with `tomllib`, which is said.
    pub fn start() -> Option<Python> {
        let there = Command::new("python3").args(["-c", "import tomllib"]).stderr(Stdio::null()).status();
        if !there.is_ok_and(|status| status.success()) {
            println!("skipped: python3 with tomllib is not there");
            return None;
        }
        let mut command = Command::new("python3");
        command.args(["-c", DRIVER, env!("CARGO_MANIFEST_DIR")]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("python3 is there");
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().expect("piped"));
        Some(Python { child, input, output })
    }

    /// The word, and the statement or the reason.
    pub fn judge(&mut self, model: &str, certificate: &str) -> (String, String) {
        let hex = |text: &str| text.bytes().map(|byte| format!("{byte:02x}")).collect::<String>();
        let input = self.input.as_mut().expect("open");
        writeln!(input, "{}\n{}", hex(model), hex(certificate)).expect("the checker reads");
        let mut answer = String::new();
        self.output.read_line(&mut answer).expect("the checker writes");
        let (word, said) = answer.trim_end().split_once(' ').expect("the checker did not end");
        let byte = |at: usize| u8::from_str_radix(&said[at..at + 2], 16).expect("hexadecimal digits");
        let bytes = (0..said.len()).step_by(2).map(byte).collect();
        (word.to_owned(), String::from_utf8(bytes).expect("UTF-8"))
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        drop(self.input.take());
        let _ = self.child.wait();
    }
}
