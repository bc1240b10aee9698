//! `jurist-check` as a program.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

const MODEL: &str = "time = \"discrete\"\nparameters.K = {}\nloop.characteristic = \"z - 1 + K\"\n";

const CERTIFICATE: &str = r#"{
  "schema": "jurist/certificate/1",
  "statement": {"kind": "intervals", "time": "discrete", "parameter": "K", "set": {}, "region": {"radius": "1"},
    "domain": {"lower": null, "upper": null}, "stable": [{"lower": "0", "upper": "2"}]},
  "characteristic": [["-1", "1"], ["1"]],
  "boundary": null,
  "factors": [["0", "1"], ["-2", "1"]],
  "line": [{"split": [], "sample": "-1", "stable": false}, {"at": "0"},
           {"split": [], "sample": "1", "stable": true}, {"at": "2"},
           {"split": [], "sample": "3", "stable": false}]
}"#;

/// A file that is removed again.
struct File(PathBuf);

impl File {
    fn new(name: &str, content: &[u8]) -> Self {
        let file = std::env::temp_dir().join(format!("jurist-check-{}-{name}", std::process::id()));
        std::fs::write(&file, content).expect("a file can be written");
        File(file)
    }

    fn path(&self) -> &str {
        self.0.to_str().expect("a path of UTF-8")
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// Status, standard output, standard error.
fn run(arguments: &[&str], input: &str) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jurist-check"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program runs");
    // A program that refuses its arguments does not read.
    let _ = child.stdin.take().expect("piped").write_all(input.as_bytes());
    let Output { status, stdout, stderr } = child.wait_with_output().expect("the program ends");
    let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
    (status.code().expect("no signal"), text(stdout), text(stderr))
}

#[test]
fn a_certificate_is_proved_or_rejected_by_the_status() {
    let model = File::new("model.toml", MODEL.as_bytes());
    let certificate = File::new("certificate.json", CERTIFICATE.as_bytes());
    let of = |model: &str, certificate: &str| {
        let [of_model, of_certificate] = [MODEL, CERTIFICATE].map(jurist_check::sha256);
        let said = format!(
            "proved: For all real K, the loop is stable exactly for 0 < K < 2.\nmodel: {model}, SHA-256 {of_model}\n\
             certificate: {certificate}, SHA-256 {of_certificate}\nchecked by: jurist-check {}\n",
            env!("CARGO_PKG_VERSION")
        );
        (0, said, String::new())
    };
    let (one, other) = (model.path(), certificate.path());
    assert_eq!(run(&[one, other, "--timeout", "inf"], ""), of(one, other));
    assert_eq!(run(&["-", other, "--timeout", "inf"], MODEL), of("standard input", other));
    assert_eq!(run(&[one, "-", "--timeout=inf"], CERTIFICATE), of(one, "standard input"));

    let wrong = CERTIFICATE.replace("\"upper\": \"2\"", "\"upper\": \"3\"");
    let (status, stdout, stderr) = run(&[model.path(), "-", "--timeout=inf"], &wrong);
    assert_eq!((status, stdout.as_str()), (4, ""));
    assert!(stderr.starts_with("the certificate is rejected at the step 'stable'"), "{stderr}");

    let (status, stdout, stderr) = run(&[model.path(), certificate.path(), "--timeout", "0"], "");
    assert_eq!((status, stdout.as_str()), (4, ""), "{stderr}");
    assert!(stderr.contains("takes longer than 0 s"), "{stderr}");

    let latin = File::new("latin.toml", b"# \xE9");
    let (status, stdout, stderr) = run(&[latin.path(), certificate.path()], "");
    assert_eq!((status, stdout.as_str()), (4, ""));
    assert!(stderr.contains("the model is not UTF-8"), "{stderr}");
}

#[test]
fn arguments_and_files_that_cannot_be_used_have_their_own_status() {
    let model = File::new("only-model.toml", MODEL.as_bytes());
    let folder = std::env::temp_dir();
    let folder = folder.to_str().expect("a path of UTF-8");
    let missing = format!("{}.not-there", model.path());
    for arguments in [
        vec![],
        vec![model.path()],
        vec!["-", "-"],
        vec![model.path(), &missing],
        vec![folder, model.path()],
        vec![model.path(), "-", "--fast"],
        vec![model.path(), "-", "--timeout", "soon"],
    ] {
        let (status, stdout, stderr) = run(&arguments, CERTIFICATE);
        assert_eq!((status, stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(stderr.starts_with("error: ") && stderr.lines().count() == 1, "{arguments:?}: {stderr}");
    }
}

#[test]
fn help_and_version_are_answers() {
    let (status, stdout, stderr) = run(&["--help"], "");
    assert_eq!((status, stderr.as_str()), (0, ""));
    assert!(stdout.contains("Usage: jurist-check [OPTIONS] MODEL CERTIFICATE") && stdout.contains("--timeout SECONDS"));
    assert_eq!(run(&["-V"], ""), (0, format!("jurist-check {}\n", env!("CARGO_PKG_VERSION")), String::new()));
}
