//! Certificates, and their check by code that shares nothing with the engine.

use crate::model::problem;
use crate::reply::Reply;
use crate::told::budget;
use jurist::certified::{certify_intervals, certify_verdict};
use jurist::{Error, Limits};
use serde::Deserialize;
use serde_json::{Value, json};

/// Of what a certificate is wanted.
#[derive(Deserialize)]
pub(crate) struct CertificateRequest {
    model: String,
    /// Names with their values as written.
    set: Vec<(String, String)>,
    /// The parameter whose stable set is certified; the verdict where there is none.
    free: Option<String>,
}

/// The certificate's text.
pub(crate) fn certificate(request: &CertificateRequest) -> Result<Value, Error> {
    let budget = budget();
    let certificate = match &request.free {
        Some(name) => {
            let answer = problem(&request.model, &request.set, &[name])?.stable_set(&budget)?;
            certify_intervals(&answer, &budget)?.text
        }
        None => certify_verdict(&problem(&request.model, &request.set, &[])?.verdict(&budget)?, &budget)?,
    };
    Ok(json!({ "certificate": certificate }))
}

/// The statement that a certificate proves about a text, or the step at which it fails.
pub(crate) fn check(model: &str, certificate: &str) -> Reply {
    Reply::answered(match jurist::check(model, certificate, &Limits::default()) {
        Ok(proved) => json!({ "proved": proved.statement }),
        Err(rejection) => json!({ "rejected": rejection.to_string() }),
    })
}
