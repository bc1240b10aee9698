//! A certificate: written from an answer, checked by code that shares nothing with what wrote it, and refused when its
//! statement is changed.
//!
//! `cargo run --example certificate`

use jurist::{Ask, Budget, Certificate, Error, Limits, Model, check};

fn main() -> Result<(), Error> {
    let drive = Model::drive();
    let budget = Budget::unlimited();
    let answer = drive.ask().free("K_pwm").stable_set(&budget)?;
    let certificate = answer.certificate(&budget)?;
    let model = &drive.source().text;
    match check(model, &certificate, &Limits::default()) {
        Ok(proved) => println!("proved: {}", proved.statement),
        Err(rejection) => println!("{rejection}"),
    }
    // The same proof does not hold for a drive with another resistance.
    let other = model.replacen("R_a  = 1", "R_a  = 2", 1);
    assert_ne!(&other, model);
    match check(&other, &certificate, &Limits::default()) {
        Ok(proved) => println!("proved: {}", proved.statement),
        Err(rejection) => println!("{rejection}"),
    }
    Ok(())
}
