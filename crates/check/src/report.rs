//! The record of a check: the proved statement, the names and SHA-256 of both texts, and the version of the checker.

use super::Proved;
use super::digest::{loop_alone, sha256};
use super::format::Json;
use super::number::shorten;
use super::toml;

/// The names that two texts have, such as those of their files.
///
/// ```
/// use jurist_check::{Limits, Names, check, report};
/// let model = "title = 'First'\ntime = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - 1 + K'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/1",
///     "statement": {"kind": "verdict", "time": "discrete", "set": {"K": "1"}, "region": {"radius": "1"},
///         "verdict": "stable", "degree": 1, "inside": 1, "on": 0, "outside": 0, "infinite": 0},
///     "characteristic": [[], ["1"]]
/// }"#;
/// let proved = check(model, certificate, &Limits::default()).unwrap();
/// let said = report(&proved, model, certificate, Names { model: "first.toml", certificate: "first.cert" });
/// assert!(said.starts_with("proved: At K = 1, the loop is stable"));
/// assert!(said.contains("\nmodel: first.toml, 'First', SHA-256 "));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Names<'n> {
    /// That of the model.
    pub model: &'n str,
    /// That of the certificate.
    pub certificate: &'n str,
}

/// The statement, and on further lines its texts with their digests, the version, and whether the certificate was written for another text.
pub fn report(proved: &Proved, model: &str, certificate: &str, names: Names<'_>) -> String {
    let title = toml::read(model).ok().and_then(|root| root.get("title").and_then(|t| t.text().ok().map(one_line)));
    let title = title.filter(|title| !title.is_empty()).map_or_else(String::new, |title| format!(", '{title}'"));
    let [of_model, of_certificate] = [model, certificate].map(sha256);
    let mut out = format!(
        "proved: {}\nmodel: {}{title}, SHA-256 {of_model}\ncertificate: {}, SHA-256 {of_certificate}\nchecked by: jurist-check {}\n",
        proved.statement,
        one_line(names.model),
        one_line(names.certificate),
        env!("CARGO_PKG_VERSION")
    );
    if is_for_another_text(model, certificate) {
        out.push_str(
            "note: the certificate was written for another text of a model; what it proves of this one stands above\n",
        );
    }
    out
}

/// Whether a certificate says that it was written for another text of a model, as one of another loop does.
///
/// ```
/// let certificate = r#"{"model": {"title": null, "digest": "sha256:0000"}}"#;
/// assert!(jurist_check::is_for_another_text("loop.characteristic = 's + 1'", certificate));
/// ```
pub fn is_for_another_text(model: &str, certificate: &str) -> bool {
    is_for_another(model, &sha256(&loop_alone(model)), certificate)
}

/// Whether the certificate has the digest of another text than the model's.
fn is_for_another(model: &str, digest: &str, certificate: &str) -> bool {
    let Ok(json) = Json::parse(certificate) else { return false };
    match json.get("model").and_then(|about| about.get("digest")) {
        Some(Json::Text(text)) => match text.split_once(':') {
            Some(("sha256", rest)) => rest != digest,
            Some(("fnv1a64", rest)) => rest != fnv1a64(model),
            _ => false,
        },
        _ => false,
    }
}

/// The digest of certificates up to version 0.2.
fn fnv1a64(text: &str) -> String {
    let step = |h: u64, byte: u8| (h ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", text.bytes().fold(0xcbf2_9ce4_8422_2325, step))
}

/// Without line ends and other control characters, and not longer than a line.
fn one_line(text: &str) -> String {
    let text = text.replace(char::is_control, " ");
    if text.chars().count() > 100 { shorten(&text) } else { text.trim().to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_of_another_text_is_told() {
        let is = |digest: &str| {
            is_for_another("abc", &sha256("abc"), &format!("{{\"model\": {{\"title\": null, \"digest\": {digest}}}}}"))
        };
        assert!(!is(&format!("\"sha256:{}\"", sha256("abc"))) && is(&format!("\"sha256:{}\"", sha256("abd"))));
        assert!(!is("\"fnv1a64:e71fa2190541574b\"") && is("\"fnv1a64:e71fa2190541574c\""));
        assert!(!is("7") && !is("\"crc:1\"") && !is("\"\""));
    }
}
