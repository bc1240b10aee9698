//! The forms that an answer to the page has.

use jurist::{Diagnostics, Error};
use jurist_show::diagnostics::render_error;
use serde::Serialize;
use serde_json::{Value, json};

/// An answer, or why there is none.
pub(crate) struct Reply(Value);

impl Reply {
    /// What was asked for.
    pub fn answered(value: impl Serialize) -> Reply {
        Reply(serde_json::to_value(value).unwrap_or_else(|error| json!({ "defect": error.to_string() })))
    }

    /// What was asked for, or the engine's one kind of "no".
    pub fn of(result: Result<Value, Error>) -> Reply {
        match result {
            Ok(value) => Reply(value),
            Err(error) => Reply::no(&error),
        }
    }

    /// Why there is no answer, in the program's words.
    pub fn no(error: &Error) -> Reply {
        Reply(match error {
            Error::Refused(refused) => refusal(refused),
            Error::Undefined(why) => json!({ "undefined": why }),
            Error::Stopped(stopped) => json!({ "stopped": stopped.to_string() }),
            other => json!({ "defect": other.to_string() }),
        })
    }

    /// What must not happen.
    pub fn defect(message: String) -> Reply {
        Reply(json!({ "defect": message }))
    }

    /// As JSON.
    pub fn to_text(&self) -> String {
        self.0.to_string()
    }
}

/// Diagnostics as the program draws them, and each for itself.
pub(crate) fn refusal(refused: &Diagnostics) -> Value {
    let one = |d: &jurist::Diagnostic| json!({ "code": d.code.as_str(), "message": d.message, "help": d.help });
    let all: Vec<Value> = refused.diagnostics().iter().map(one).collect();
    json!({ "refused": { "text": render_error(refused, false).trim_end(), "diagnostics": all } })
}
