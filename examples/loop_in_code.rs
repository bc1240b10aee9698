//! A loop built in code, and how far all roots are inside the unit circle.
//!
//! `cargo run --example loop_in_code`

use jurist::{Ask, BlockBuilder, Budget, Error, Model, ParameterBuilder, Rational, Region, Text, Time};

fn main() -> Result<(), Error> {
    let (model, warnings) = Model::builder(Time::Discrete)
        .title("PI current loop, one sample of delay")
        .sample_time("1e-4")
        .constant("a", "0.98")
        .parameter(ParameterBuilder::new("Kp").nominal("0.5").min("0"))
        .parameter(ParameterBuilder::new("Ki").nominal("0.01").min("0"))
        .inputs(["r"])
        .outputs(["i"])
        .block(BlockBuilder::new("controller", "r - i", "v").transfer("(Kp + Ki*z/(z - 1))/z"))
        .block(BlockBuilder::new("plant", "v", "i").transfer("(1 - a)/(z - a)"))
        .build()?;
    assert!(warnings.is_empty());
    let budget = Budget::unlimited();
    let verdict = model.ask().verdict(&budget)?;
    println!("nominal: {}", verdict.text(10).lines().last().unwrap_or_default());
    print!("{}", model.ask().free("Kp").stable_set(&budget)?.text(10));
    // All roots within |z| < 0.99: every transient loses a percent each sample.
    let fast = Region::disc(Rational::new(99.into(), 100.into()))?;
    print!("{}", model.ask().within(fast).free("Kp").stable_set(&budget)?.text(10));
    Ok(())
}
