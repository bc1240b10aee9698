//! One limit: a model as text, the stable set of a gain, and what happens at its end.
//!
//! `cargo run --example one_limit`

use jurist::{Ask, Budget, Error, Model, Source, documents};
use jurist::{Document, Text};

const MODEL: &str = r#"
title = "first-order plant, proportional controller, one sample of delay"
time = "discrete"
sample_time = "1e-3"

[parameters]
K = { nominal = 0.3, min = 0 }

[loop]
inputs = ["r"]
outputs = ["y"]

[[block]]
name = "controller"
input = "r - y"
output = "u"
transfer = "K/z"

[[block]]
name = "plant"
input = "u"
output = "y"
transfer = "0.1/(z - 0.9)"
"#;

fn main() -> Result<(), Error> {
    let (model, warnings) = Model::from_toml(&Source::new("loop.toml", MODEL))?;
    assert!(warnings.is_empty());
    let answer = model.ask().free("K").stable_set(&Budget::unlimited())?;
    for interval in answer.value().intervals() {
        for end in [&interval.lower, &interval.upper].into_iter().flatten() {
            // Any number of digits, each of them right.
            println!("K = {}   because of: {}", end.value.decimal(40), end.causes);
            if let Some(hertz) = answer.problem().frequency(end, 80).and_then(|f| f.hertz) {
                println!("    at {} Hz", hertz.decimal(12).unwrap_or_default());
            }
        }
    }
    // The same for people, and for programs.
    print!("{}", answer.text(12));
    print!("{}", documents::to_text(&answer.json(12)));
    Ok(())
}
