//! Commands of the program.

use crate::model::read;
use crate::reply::{Reply, refusal};
use crate::told::budget;
use jurist::Model;
use jurist::cli::captured;
use serde_json::{Value, json};

/// What a command would have written, and how it would have ended.
pub(crate) fn run(text: Option<&str>, arguments: Vec<String>) -> Reply {
    let model = match text.map_or_else(|| Ok((Model::drive(), Vec::new())), read) {
        Ok((model, _)) => model,
        Err(refused) => return Reply::answered(refusal(&refused)),
    };
    match captured(arguments, &model, &budget()) {
        Ok(done) => {
            let warning = |(code, text): &(&str, String)| json!({ "code": code, "text": text.trim_end() });
            let warnings: Vec<Value> = done.warnings.iter().map(warning).collect();
            Reply::answered(json!({
                "status": done.status, "output": done.output, "notes": done.notes, "warnings": warnings,
            }))
        }
        Err(error) => Reply::no(&error),
    }
}
