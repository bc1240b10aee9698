//! A map: the stable region in the plane of two parameters, its exact extents, and points looked up in it.
//!
//! `cargo run --example a_map`

use jurist::{Ask, Budget, Error, Model, Rational, Text};
use std::time::Duration;

fn main() -> Result<(), Error> {
    // A budget ends a computation that takes too long; the answer is never changed by it.
    let budget = Budget::with_timeout(Duration::from_secs(30));
    let answer = Model::drive().ask().free("T").free("K_pwm").map(10, &budget)?;
    print!("{}", answer.text(10));
    let map = &answer.value().decomposition;
    println!("{} strips, {} stable region(s)", map.strips.len(), map.regions.len());
    // On a line through the map: the stable set of the other parameter, exactly.
    let period = Rational::new(1.into(), 20_000.into());
    print!("{}", answer.slice(0, &period, &budget)?.text(10));
    Ok(())
}
