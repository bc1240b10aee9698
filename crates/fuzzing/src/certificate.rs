//! The check of certificates on arbitrary bytes.

use jurist_algebra::limits::Budget;
use jurist_check::{Limits, check};
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;
use jurist_prove::Certificate;
use std::time::Duration;

/// Small models with their true certificates are mutated by the bytes, or the bytes are the certificate.
const MODELS: [&str; 4] = [
    "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - 1 + K'",
    "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 + (K^2 - 1)*z + 1 - K/3'",
    "time = 'continuous'\nparameters.K = {}\nloop.characteristic = 's^3 + 2*s^2 + 3*s + K'",
    "time = 'continuous'\nparameters.K = {}\nloop.matrix = [['-1/(K - 1)', 'K'], [1, -2]]",
];

/// Checks a certificate made from bytes. An accepted mutation must state what the engine's own answer states.
///
/// # Panics
/// When the check panics, runs out of its time by far, or accepts a wrong statement.
pub fn certificate_check(data: &[u8]) {
    let Some((&kind, data)) = data.split_first() else { return };
    let model = MODELS[usize::from(kind & 3)];
    let limits = Limits::within(Duration::from_secs(5));
    // A true certificate has all the time it needs: a busy machine is no finding.
    let patient = Limits::within(Duration::MAX);
    if kind & 4 == 0 {
        let text = String::from_utf8_lossy(data);
        let _ = check(model, &text, &limits);
        let _ = check(&text, &true_certificate(model), &limits);
        return;
    }
    let certificate = if kind & 8 == 0 { true_certificate(model) } else { true_verdict(model) };
    let original = check(model, &certificate, &patient).expect("a true certificate");
    let mut bytes = certificate.into_bytes();
    for edit in data.chunks_exact(3) {
        let place = (usize::from(edit[0]) << 8 | usize::from(edit[1])) % bytes.len();
        bytes[place] = edit[2] & 0x7f;
    }
    let text = String::from_utf8_lossy(&bytes);
    if let Ok(proved) = check(model, &text, &limits) {
        let same_domain = proved.statement.split("the loop").next() == original.statement.split("the loop").next();
        let algebraic = proved.statement.contains('[');
        assert!(!same_domain || algebraic || proved.statement == original.statement, "{}", proved.statement);
    }
}

fn true_certificate(model: &str) -> String {
    let budget = Budget::unlimited();
    let answer = read(model).ask().free("K").stable_set(&budget).expect("a good question");
    answer.certificate(&budget).expect("no limit")
}

fn true_verdict(model: &str) -> String {
    let budget = Budget::unlimited();
    let answer = read(model).ask().set("K", 1).verdict(&budget).expect("a good question");
    answer.certificate(&budget).expect("no limit")
}

fn read(model: &str) -> Model {
    Model::from_toml(&Source::new("model", model)).expect("a correct model").0
}
