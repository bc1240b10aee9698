//! Answers computed where there is no clock and no thread; `run.mjs` asks and compares.

use jurist::{Ask, Budget, Model, Source};
use std::fmt::Write;
use std::time::Duration;

const MODEL: &str = r#"
    time = "discrete"
    [parameters]
    K = { nominal = 1, min = 0 }
    a = { nominal = "1/2", min = 0, max = 1 }
    [loop]
    characteristic = "z^2 - z + K*a"
"#;

/// Lines of answers.
fn answers() -> Result<String, jurist::Error> {
    let mut out = String::new();
    let (model, _) = Model::from_toml(&Source::new("model.toml", MODEL))?;
    for budget in [Budget::unlimited(), Budget::with_timeout(Duration::from_secs(60)), Budget::with_work(1 << 30)] {
        let answer = model.ask().free("K").stable_set(&budget)?;
        let limits = answer.value().intervals().iter().filter_map(|i| i.upper.as_ref());
        let limits: Vec<String> = limits.map(|end| format!("{} by a {}", end.value.decimal(12), end.causes)).collect();
        let _ = writeln!(out, "K below {}", limits.join(", "));
    }
    // Work that is distributed over threads where there are any.
    let map = model.ask().free("K").free("a").map(12, &Budget::unlimited());
    let _ = writeln!(out, "map {}", if map.is_ok() { "decided" } else { "not decided" });
    let stopped = model.ask().free("K").stable_set(&Budget::with_work(3));
    let _ = writeln!(out, "three units of work: {}", if stopped.is_err() { "stopped" } else { "enough" });
    Ok(out)
}

/// The answers as UTF-8, their length in four bytes before them.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    let text = answers().unwrap_or_else(|failure| format!("failed: {failure}"));
    let mut bytes = (text.len() as u32).to_le_bytes().to_vec();
    bytes.extend(text.into_bytes());
    Box::leak(bytes.into_boxed_slice()).as_ptr()
}
