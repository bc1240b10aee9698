//! `--certificate`, `--smt2`, `jurist verify` and `crates/check/check.py` as programs.

use crate::helpers::certificates::python::is_there;
use crate::helpers::model::path;
use crate::helpers::program::{Run, jurist, jurist_with_input};
use crate::helpers::random::Random;
use crate::helpers::thorough::tried;
use std::path::PathBuf;
use std::process::Command;

const DRIVE: &str = "examples/drive.toml";

/// A folder that is removed again.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("jurist-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn file(&self, name: &str, content: &[u8]) -> String {
        std::fs::write(self.path(name), content).unwrap();
        self.path(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// `crates/check/check.py` as a program that takes its time: no test may fail because the machine is busy.
const PATIENT: &str = "import sys
sys.path.insert(0, 'crates/check')
import check
check.SECONDS = 1e9
check.main()
";

/// `crates/check/check.py`, where Python is there; it is compiled once, beside what cargo builds.
fn python(model: &str, certificate: &str) -> Option<Run> {
    is_there().then(|| {
        let mut command = Command::new("python3");
        command.args(["-c", PATIENT, model, certificate]).current_dir(path(""));
        command.env_remove("PYTHONDONTWRITEBYTECODE").env("PYTHONPYCACHEPREFIX", env!("CARGO_TARGET_TMPDIR"));
        let output = command.output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
        Run { status: output.status.code().expect("no signal"), stdout, stderr }
    })
}

fn assert_proved(model: &str, certificate: &str, sentence: &str) {
    let run = jurist(&["verify", model, certificate, "--timeout", "inf"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.starts_with("proved: ") && run.stdout.contains(sentence), "{}", run.stdout);
    let lines: Vec<&str> = run.stdout.lines().collect();
    let begin =
        ["proved: ", &format!("model: {model}, "), &format!("certificate: {certificate}, SHA-256 "), "checked by: "];
    assert!(lines.len() == 4 && lines.iter().zip(begin).all(|(line, begin)| line.starts_with(begin)), "{}", run.stdout);
    if let Some(other) = python(model, certificate) {
        assert_eq!((other.status, other.stderr.as_str()), (0, ""));
        // The same words, names and digests; only who says them is another.
        assert_eq!(other.stdout.lines().take(3).collect::<Vec<_>>(), lines[..3]);
        assert!(
            other.stdout.lines().nth(3).is_some_and(|l| l.starts_with("checked by: check.py ")),
            "{}",
            other.stdout
        );
    }
}

fn assert_rejected(model: &str, certificate: &str, reason: &str) {
    let run = jurist(&["verify", model, certificate, "--timeout", "inf"]);
    assert_eq!((run.status, run.stdout.as_str()), (4, ""), "{certificate}: {}", run.stderr);
    assert!(run.stderr.contains(reason), "{certificate}: {}", run.stderr);
    assert!(run.stderr.len() < 1000 && !run.stderr.contains("panicked"), "{certificate}: {}", run.stderr);
    if let Some(run) = python(model, certificate) {
        assert_eq!((run.status, run.stdout.as_str()), (4, ""), "{certificate}: {}", run.stderr);
        assert!(run.stderr.starts_with("rejected: "), "{certificate}: {}", run.stderr);
    }
}

#[test]
fn the_drives_answers_are_proved() {
    let folder = Folder::new("drive");
    let sets = [("K_pwm", "For all real K_pwm > 0, with T = 1/10000,"), ("T", "with K_pwm = 110,")];
    for (parameter, sentence) in tried(sets, 2) {
        let certificate = folder.path(parameter);
        let run = jurist(&["intervals", DRIVE, "--param", parameter, "--certificate", &certificate]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        println!("{parameter}: {} bytes", std::fs::metadata(&certificate).unwrap().len());
        assert_proved(DRIVE, &certificate, sentence);
    }
    let verdicts = [("K_pwm=1000", "the loop is unstable"), ("K_pwm=110", "the loop is stable")];
    for (value, verdict) in tried(verdicts, 2) {
        let certificate = folder.path(value);
        let run = jurist(&["verdict", DRIVE, "--set", value, "--certificate", &certificate]);
        assert_eq!(run.status, i32::from(value == "K_pwm=1000"), "{}", run.stderr);
        assert_proved(DRIVE, &certificate, verdict);
    }
    // In another region, of a radius, and from standard input.
    let certificate = folder.path("region");
    for arguments in tried([["--param", "T", "--radius", "0.999"], ["--param", "radius", "--set", "T=2e-4"]], 2) {
        let run = jurist(&[&["intervals", DRIVE, "--certificate", &certificate][..], &arguments].concat());
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert_proved(DRIVE, &certificate, "with all |z| < ");
    }
    let run = jurist_with_input(&["verify", "-", &certificate, "--timeout", "inf"], &std::fs::read(DRIVE).unwrap());
    assert_eq!(run.status, 0, "{}", run.stderr);
}

#[test]
fn rejections_name_the_step_that_failed() {
    let folder = Folder::new("steps");
    let path = folder.path("k.json");
    assert_eq!(jurist(&["intervals", DRIVE, "--param", "K_pwm", "--certificate", &path]).status, 0);
    let text = std::fs::read_to_string(&path).unwrap();
    for model in tried(["examples/equation-23-as-printed.toml", "examples/buck-converter.toml"], 2) {
        assert_rejected(model, &path, "at the step 'model'");
    }
    let changes = [
        ("certificate/1", "certificate/2", "format"),
        ("\"kind\": \"intervals\"", "\"kind\": \"regions\"", "statement"),
        ("\"time\": \"discrete\"", "\"time\": \"continuous\"", "statement"),
        ("\"T\": \"1/10000\"", "\"T\": \"1/20000\"", "characteristic"),
        ("\"T\": \"1/10000\"", "\"T\": \"1/0\"", "statement"),
        ("\"radius\": \"1\"", "\"radius\": \"9/10\"", "characteristic"),
        ("\"u\": [", "\"u\": [[\"1\"], ", "boundary"),
        ("\"factors\": [", "\"factors\": [[\"3\"], ", "factors"),
        ("\"stable\": true", "\"stable\": false", "line"),
        ("\"lower\": \"0\", \"upper\": null", "\"lower\": \"1\", \"upper\": null", "line"),
    ];
    for (from, to, step) in tried(changes, 5) {
        assert!(text.contains(from), "{from}");
        let changed = folder.file("changed.json", text.replacen(from, to, 1).as_bytes());
        assert_rejected(DRIVE, &changed, &format!("at the step '{step}'"));
    }
    // Files that are not there are bad usage, not rejections.
    assert_eq!(jurist(&["verify", DRIVE, "no/such/file"]).status, 2);
    assert_eq!(jurist(&["verify", "no/such/file", &path]).status, 2);
    assert_eq!(jurist(&["verify", DRIVE]).status, 2);
}

#[test]
#[ignore = "long: CI runs it"]
fn broken_files_are_rejected() {
    let folder = Folder::new("broken");
    let model =
        folder.file("model.toml", b"time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 + 1 - K^2'");
    let path = folder.path("good.json");
    assert_eq!(jurist(&["intervals", &model, "--param", "K", "--certificate", &path]).status, 0);
    let good = std::fs::read_to_string(&path).unwrap();
    let million = "7".repeat(1_000_000);
    let digits = "7".repeat(99_999);
    let sample = good.split("\"sample\": \"").nth(1).unwrap().split('"').next().unwrap();
    let with_sample =
        |text: String| good.replacen(&format!("\"sample\": \"{sample}\""), &format!("\"sample\": \"{text}\""), 1);
    let texts = [
        ("empty", String::new(), "at the step 'format'"),
        ("truncated", good[..good.len() / 2].to_owned(), "at the step 'format'"),
        ("twice", format!("{good}{good}"), "at the step 'format'"),
        ("deep", "[".repeat(1_000_000), "nested too deep"),
        ("deep objects", "{\"schema\":".repeat(100_000), "nested too deep"),
        (
            "deep model",
            good.replacen("{", &format!("{{\"model\": {}1{}, ", "[".repeat(50), "]".repeat(50)), 1),
            "nested too deep",
        ),
        ("double key", good.replacen("\"line\"", "\"line\": [], \"line\"", 1), "a key occurs twice"),
        ("hidden double key", good.replacen("\"line\"", "\"l\\u0069ne\": [], \"line\"", 1), "a key occurs twice"),
        ("no string", good.replacen("\"schema\"", "\"schema", 1), "at the step 'format'"),
        ("version", good.replace("certificate/1", "certificate/99"), "at the step 'format'"),
        ("million digits", with_sample(million.clone()), "more than 100000 digits"),
        ("million below", with_sample(format!("1/{million}")), "more than 100000 digits"),
        (
            "million as count",
            good.replacen("\"at\": \"", &format!("\"at\": {million}, \"x\": \""), 1),
            "at the step 'format'",
        ),
        ("long sample", with_sample(digits.clone()), "at the step 'line'"),
        ("long fraction", with_sample(format!("{digits}/8{digits}")), "at the step 'line'"),
        ("not JSON", "proved".into(), "at the step 'format'"),
    ];
    for (name, text, reason) in tried(&texts, 4) {
        assert_rejected(&model, &folder.file(name, text.as_bytes()), reason);
    }
    assert_rejected(&model, &folder.file("bytes", b"\xff\xfe{}"), "is not UTF-8");
    let huge = vec![b' '; (64 << 20) + 1];
    assert_rejected(&model, &folder.file("huge", &huge), "is longer than");
    // Models of the same kind.
    for (name, text) in [
        ("empty.toml", String::new()),
        ("deep.toml", format!("time = 'discrete'\nx = {}{}", "[".repeat(100_000), "]".repeat(100_000))),
        (
            "deep expression.toml",
            format!("time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = '{}z'", "(".repeat(100_000)),
        ),
        ("digits.toml", format!("time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = 'z + {million}'")),
        (
            "number.toml",
            format!("time = 'discrete'\nparameters.K = {{}}\nconstants.a = {million}\nloop.characteristic = 'z + K'"),
        ),
        ("exponent.toml", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z + K + 1e999999999'".into()),
        (
            "powers.toml",
            format!("time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = 'z + 9{}'", "^9".repeat(1000)),
        ),
        (
            "circle.toml",
            "time = 'discrete'\nparameters.K = {}\nconstants.a = 'b'\nconstants.b = 'a'\nloop.characteristic = 'z'"
                .into(),
        ),
    ] {
        assert_rejected(&folder.file(name, text.as_bytes()), &path, "at the step 'model'");
    }
}

/// Eliminating in a full matrix of polynomials, which no machine finishes; and no time at all.
#[test]
fn a_check_ends_with_its_time() {
    let folder = Folder::new("time");
    let model = folder.file("model.toml", b"time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z + K'");
    let path = folder.path("good.json");
    assert_eq!(jurist(&["intervals", &model, "--param", "K", "--certificate", &path]).status, 0);
    let mut random = Random::new(11);
    let mut entry =
        || format!("'{} + {}*K + K^3/{}'", random.below(1 << 30), random.below(1 << 30), 1 + random.below(1 << 30));
    let mut row = || format!("[{}]", (0..60).map(|_| entry()).collect::<Vec<_>>().join(", "));
    let matrix = (0..60).map(|_| row()).collect::<Vec<_>>().join(",\n");
    let endless = format!("time = 'discrete'\nparameters.K = {{}}\nloop.matrix = [{matrix}]");
    let endless = folder.file("endless.toml", endless.as_bytes());
    for (model, seconds) in [(&endless, "1"), (&endless, "0"), (&model, "0")] {
        let run = jurist(&["verify", model, &path, "--timeout", seconds]);
        assert_eq!(run.status, 4, "{}", run.stderr);
        assert!(run.stderr.contains(&format!("the check takes longer than {seconds} s")), "{}", run.stderr);
    }
}
