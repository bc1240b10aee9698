//! Model texts of any kind.

use jurist_algebra::limits::Budget;
use jurist_engine::model::{Model, source_from_bytes};
use jurist_engine::problem::Ask;
use std::time::Duration;

/// Reads bytes as a model and asks for its polynomial: whatever they are, nothing panics.
pub fn model_parser(data: &[u8]) {
    let Ok(source) = source_from_bytes("fuzz.toml", data) else { return };
    match Model::from_toml(&source) {
        Ok((model, _)) => {
            let budget = Budget::with_timeout(Duration::from_millis(200));
            let keep = model.parameters().iter().take(2).map(|p| p.name.clone());
            // The answer may be an error; it must not be a panic.
            let free = keep.fold(model.ask(), jurist_engine::problem::Question::free);
            drop(free.problem().map(|problem| problem.algebra(&budget).is_ok()));
            drop(model.ask().problem().map(|problem| problem.closed_loop(&budget).is_ok()));
        }
        Err(error) => {
            let drawn = jurist_show::diagnostics::render_error(&error, false);
            assert!(!drawn.is_empty());
        }
    }
}
