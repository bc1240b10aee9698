//! Replays the committed corpora of the fuzz targets.

use std::path::Path;

fn replay(target: &str, harness: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "no corpus in {}", folder.display());
    for file in files {
        harness(&std::fs::read(file).unwrap());
    }
}

#[test]
fn number_parser() {
    replay("number_parser", jurist_fuzzing::number_parser);
}

#[test]
fn model_parser() {
    replay("model_parser", jurist_fuzzing::model_parser);
}

#[test]
fn isolation_against_sturm() {
    replay("isolation_against_sturm", jurist_fuzzing::isolation_against_sturm);
}

#[test]
fn jury_against_count() {
    replay("jury_against_count", jurist_fuzzing::jury_against_count);
}

#[test]
fn interval_answer() {
    replay("interval_answer", jurist_fuzzing::interval_answer);
}

#[test]
fn certificate_check() {
    replay("certificate_check", jurist_fuzzing::certificate_check);
}

#[test]
fn sampled_against_float_roots() {
    replay("sampled_against_float_roots", jurist_fuzzing::sampled_against_float_roots);
}
