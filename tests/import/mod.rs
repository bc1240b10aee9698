//! Systems in files of other programs: every format, what is written of it, and what is refused.

mod c_files;
mod refused;
mod written;

use crate::helpers::program::{Run, json, jurist, jurist_with_input};
use serde_json::Value;
use std::path::PathBuf;

/// A file beside these tests.
fn file(name: &str) -> String {
    format!("tests/import/files/{name}")
}

/// What is made of a file.
fn imported(name: &str, options: &[&str]) -> Run {
    let run = jurist(&[&["import", &file(name)], options].concat());
    assert_eq!(run.status, 0, "{name}: {}", run.stderr);
    run
}

/// What is made of a text on standard input.
fn imported_text(text: &str, options: &[&str]) -> Run {
    let run = jurist_with_input(&[&["import", "-"], options].concat(), text.as_bytes());
    assert_eq!(run.status, 0, "{text}: {}", run.stderr);
    run
}

/// The document that a command gives of a model.
fn asked(command: &[&str], model: &str) -> Value {
    let path = temporary("model.toml");
    std::fs::write(&path, model).unwrap();
    let document = json(&[command, &[path.to_str().unwrap(), "--json"]].concat());
    std::fs::remove_file(path).unwrap();
    document
}

/// Whether a model is read without a remark.
fn is_clean(model: &str) {
    let run = jurist_with_input(&["check", "-"], model.as_bytes());
    assert_eq!((run.status, run.stdout.trim_end()), (0, "<stdin>: no mistakes found"), "{model}\n{}", run.stderr);
}

/// A name in the folder of temporary files that nobody else has.
fn temporary(name: &str) -> PathBuf {
    use std::sync::atomic::{AtomicU64, Ordering};
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    std::env::temp_dir().join(format!("jurist-import-{}-{count}-{name}", std::process::id()))
}
