//! The keys of a model: one that is misspelt may be the one that matters.

use super::number::shorten;
use super::toml::Toml;

const LOOP: [&str; 10] = ["characteristic", "matrix", "A", "B", "C", "K", "states", "inputs", "E", "outputs"];
const BLOCK: [&str; 14] =
    ["name", "input", "output", "discretize", "pwm", "transfer", "num", "den", "gain", "delay", "A", "B", "C", "D"];

/// Refuses unknown keys wherever known ones have a meaning.
pub(super) fn known(model: &Toml) -> Result<(), String> {
    let root = ["title", "time", "sample_time", "constants", "parameters", "loop", "block", "simulation"];
    only(model, &root, "the model")?;
    for (_, parameter) in model.get("parameters").map(Toml::entries).unwrap_or_default() {
        only(parameter, &["nominal", "min", "max", "unit", "description"], "a parameter")?;
    }
    if let Some(table) = model.get("loop") {
        only(table, &LOOP, "[loop]")?;
    }
    if let Some(table) = model.get("simulation") {
        only(table, &["inputs", "initial", "duration", "units"], "[simulation]")?;
    }
    if let (Some(table), Some(_)) = (model.get("loop"), model.get("block"))
        && let Some(key) = ["states", "E"].iter().find(|key| table.get(key).is_some())
    {
        return Err(format!("'{key}' does not go with blocks"));
    }
    for block in model.get("block").map(Toml::one_or_more).unwrap_or_default() {
        only(block, &BLOCK, "a block")?;
        if let Some(table) = block.get("discretize") {
            only(table, &["method", "T", "c"], "'discretize'")?;
        }
        if let Some(table) = block.get("pwm") {
            only(table, &["amplitude", "carrier", "period"], "'pwm'")?;
        }
    }
    Ok(())
}

fn only(table: &Toml, known: &[&str], place: &str) -> Result<(), String> {
    match table.entries().iter().find(|(key, _)| !known.contains(&key.as_str())) {
        Some((key, _)) => Err(format!("'{}' is no key of {place}", shorten(key))),
        None => Ok(()),
    }
}
