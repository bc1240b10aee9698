//! What a reader sees: a small controller in each language. `UPDATE_GOLDEN=1` writes the files anew.

use crate::controllers::{exactly, fixed, in_fixed, in_floats};
use jurist_algebra::number::BinaryFormat;
use jurist_ship::emit::Target;
use jurist_ship::format::Rounding;
use jurist_ship::realise::{Realisation, direct};
use jurist_ship::run::Overflow;
use std::path::Path;

fn is_as_before(file: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/emit/golden").join(file);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let before = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(before == text, "{file} has changed; UPDATE_GOLDEN=1 writes it anew. It is now\n{text}");
}

#[test]
fn a_pi_controller_is_written_as_it_was() {
    let controller = direct(Realisation::Df1, &exactly(&["0.5", "-0.4999"]), &exactly(&["1", "-1"]));
    let signal = fixed(16, 10, Rounding::Nearest);
    let case = in_fixed("pi".into(), &controller, fixed(16, 13, Rounding::Nearest), signal, Overflow::Saturate);
    let remarks = ["Model: loop.toml, block C. Stable as stored.", "SHA-256 of the model: 0123.."].map(String::from);
    for target in Target::ALL {
        is_as_before(&format!("pi.{}", target.extension()), &case.text(target, &remarks).unwrap());
    }
    let lag = direct(Realisation::Df2t, &exactly(&["0", "1/3"]), &exactly(&["1", "-2/3"]));
    let case = in_floats("lag".into(), &lag, BinaryFormat::Single);
    for target in Target::ALL {
        is_as_before(&format!("lag.{}", target.extension()), &case.text(target, &[]).unwrap());
    }
}
