//! The keys of a model and their types: a key that is misspelt may be the one that matters.

use super::number::shorten;
use super::toml::Toml;

// What is required or expected of the loop, and how its controller is stored, change nothing of it and are not read: what is proved is stability.
const ROOT: [&str; 12] = [
    "title",
    "time",
    "sample_time",
    "constants",
    "parameters",
    "loop",
    "block",
    "simulation",
    "require",
    "expect",
    "ship",
    "tune",
];
const PARAMETER: [&str; 8] = ["nominal", "min", "max", "closed", "domain", "unit", "description", "tolerance"];
const CONSTANT: [&str; 4] = ["value", "unit", "description", "tolerance"];
const LOOP: [&str; 10] = ["characteristic", "matrix", "A", "B", "C", "K", "states", "inputs", "E", "outputs"];
const SIMULATION: [&str; 4] = ["inputs", "initial", "duration", "units"];
const BLOCK: [&str; 16] = [
    "name",
    "input",
    "output",
    "discretize",
    "pwm",
    "every",
    "phase",
    "transfer",
    "num",
    "den",
    "gain",
    "delay",
    "A",
    "B",
    "C",
    "D",
];
const DISCRETIZE: [&str; 9] = ["method", "T", "c", "prewarp", "delay", "edge", "duty", "frame", "advance"];
const PWM: [&str; 3] = ["amplitude", "carrier", "period"];

/// Refuses unknown keys wherever known ones have a meaning, missing ones, and what is no table or no text where one must be.
pub(super) fn known(model: &Toml) -> Result<(), String> {
    only(model, &ROOT, "the model")?;
    model.get("title").map(Toml::text).transpose()?;
    for (_, constant) in model.section("constants")? {
        if let Toml::Table(_) = constant {
            only(constant, &CONSTANT, "a constant")?;
            all(constant, &["value"], "a constant")?;
        }
        for key in ["unit", "description"] {
            constant.get(key).map(Toml::text).transpose()?;
        }
    }
    for (_, parameter) in model.section("parameters")? {
        if parameter.expression().is_err() {
            only(parameter, &PARAMETER, "a parameter")?;
        }
        for key in ["unit", "description"] {
            parameter.get(key).map(Toml::text).transpose()?;
        }
    }
    if let Some(table) = model.get("simulation") {
        only(table, &SIMULATION, "[simulation]")?;
    }
    let table = model.get("loop").ok_or("the model has no [loop]")?;
    only(table, &LOOP, "[loop]")?;
    let Some(blocks) = model.get("block") else { return Ok(()) };
    if let Some(key) = ["states", "E"].iter().find(|key| table.get(key).is_some()) {
        return Err(format!("'{key}' does not go with blocks"));
    }
    blocks.list()?.iter().try_for_each(block)
}

fn block(block: &Toml) -> Result<(), String> {
    only(block, &BLOCK, "a block")?;
    block.get("name").map(Toml::text).transpose()?;
    all(block, &["input", "output"], "a block")?;
    if let Some(table) = block.get("discretize").filter(|how| !matches!(how, Toml::Text(_))) {
        only(table, &DISCRETIZE, "'discretize'")?;
    }
    if let Some(table) = block.get("pwm") {
        only(table, &PWM, "'pwm'")?;
        all(table, &PWM, "'pwm'")?;
    }
    Ok(())
}

fn only(table: &Toml, known: &[&str], place: &str) -> Result<(), String> {
    let Toml::Table(entries) = table else { return Err(format!("{place} is not a table")) };
    match entries.iter().find(|(key, _)| !known.contains(&key.as_str())) {
        Some((key, _)) => Err(format!("'{}' is no key of {place}", shorten(key))),
        None => Ok(()),
    }
}

fn all(table: &Toml, needed: &[&str], place: &str) -> Result<(), String> {
    match needed.iter().find(|key| table.get(key).is_none()) {
        Some(key) => Err(format!("{place} has no '{key}'")),
        None => Ok(()),
    }
}
