//! The check of a certificate against a model, by code that shares nothing with the engine: its own reading of
//! the model, its own arithmetic (`num-bigint`, `num-rational`) and other algorithms.
//!
//! One pass goes through the certificate from front to back; nothing is searched for. What each part means and
//! why the check suffices stands in [the grammar](grammar).

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod bernstein;
mod blocks;
mod boxes;
mod by_enclosures;
mod characteristic;
mod clock;
mod coefficient;
mod complex;
mod crossing;
mod dead_time;
mod declarations;
mod descartes;
mod determinant;
mod digest;
mod enclosed;
mod exponentials;
mod expression;
mod factor;
mod for_all;
pub mod format;
mod frequency;
mod gain;
#[doc = include_str!("grammar.md")]
pub mod grammar {}
mod half_size;
mod held;
mod hold;
mod interval;
mod intervals;
mod keys;
mod map;
mod map_boxes;
mod model;
mod moving;
mod multivariate;
mod number;
mod over;
mod over_box;
mod over_symbols;
mod products;
#[doc = include_str!("proved.md")]
pub mod proved {}
mod region;
mod report;
mod roots;
mod statement;
mod symbols;
mod taylor;
mod tolerance;
mod toml;
mod tuned;
mod univariate;
mod verdict;
mod words;

pub use digest::{loop_alone, sha256};
pub use for_all::{ForAllJudge, Part};
pub use map_boxes::{BoxJudge, JudgedBox};
pub use report::{Names, is_for_another_text, report};
pub use tuned::TuneJudge;

use clock::{Clock, out_of_time};
use format::{
    Json, SCHEMA, SCHEMA_BY_ENCLOSURES, SCHEMA_FOR_ALL, SCHEMA_OF_BOXES, SCHEMA_OF_BOXES_WITH_SYMBOLS, SCHEMA_OF_CELLS,
    SCHEMA_OF_MAPS, SCHEMA_OF_MAPS_BY_BOXES, SCHEMA_OF_TUNING, SCHEMA_WITH_DEAD_TIME, SCHEMA_WITH_SYMBOLS,
};
use number::shorten;
use statement::text;
use std::fmt;
use std::rc::Rc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;
use symbols::Table;
use univariate::Uni;

/// The stack of the thread in which a check runs: expressions may nest deeper than a default stack allows.
const STACK: usize = 64 << 20;

/// A check that does not end by itself is given up this long after its time.
const GRACE: Duration = Duration::from_millis(150);

/// How much work a check may be.
///
/// ```
/// use jurist_check::Limits;
/// use std::time::Duration;
/// assert_eq!(Limits::default(), Limits::within(Duration::from_secs(60)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// The longest time, after which the certificate is rejected.
    pub timeout: Duration,
}

impl Limits {
    /// A check that may take so long.
    pub const fn within(timeout: Duration) -> Self {
        Limits { timeout }
    }
}

impl Default for Limits {
    /// One minute.
    fn default() -> Self {
        Limits { timeout: Duration::from_secs(60) }
    }
}

/// What has been proved.
///
/// ```
/// use jurist_check::{Limits, check};
/// let model = "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - 1 + K'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/1",
///     "statement": {"kind": "verdict", "time": "discrete", "set": {"K": "1"}, "region": {"radius": "1"},
///         "verdict": "stable", "degree": 1, "inside": 1, "on": 0, "outside": 0, "infinite": 0},
///     "characteristic": [[], ["1"]]
/// }"#;
/// let proved = check(model, certificate, &Limits::default()).unwrap();
/// assert_eq!(proved.kind, "verdict");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Proved {
    /// The statement in a sentence or two.
    pub statement: String,
    /// The kind of the statement: `intervals`, `verdict`, `tolerance`, `map`, `boxes`, `cells`, `for_all` or `tune`.
    pub kind: &'static str,
}

/// The step at which a check failed, in the order in which they are taken.
///
/// ```
/// use jurist_check::{Limits, Step, check};
/// let rejection = check("time = 'discrete'", "no certificate", &Limits::default()).unwrap_err();
/// assert_eq!(rejection.step, Step::Format);
/// assert_eq!(rejection.step.name(), "format");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The text is JSON of the right version with the right parts.
    Format,
    /// The statement is complete.
    Statement,
    /// The model can be read and fits the statement.
    Model,
    /// The characteristic polynomial is that of the model.
    Characteristic,
    /// The identity `U A + V B = value` holds.
    Boundary,
    /// The factors make up all boundary polynomials.
    Factors,
    /// The points, counts and samples on the line.
    Line,
    /// The factors in `x` make up all values where curves may meet, turn, leave or end.
    Projection,
    /// The strips between these values, and the cells of each.
    Strips,
    /// What joins the cells of a region.
    Joins,
    /// The claimed set, or the claimed verdict.
    Stable,
    /// The check was given up in the middle of a step.
    Time,
    /// The check would be more work, or take more memory, than texts of their length may ask for. Nothing is said of the certificate.
    Work,
}

impl Step {
    /// The name of the part of the certificate that is checked.
    pub fn name(self) -> &'static str {
        match self {
            Step::Format => "format",
            Step::Statement => "statement",
            Step::Model => "model",
            Step::Characteristic => "characteristic",
            Step::Boundary => "boundary",
            Step::Factors => "factors",
            Step::Line => "line",
            Step::Projection => "x_factors",
            Step::Strips => "strips",
            Step::Joins => "joins",
            Step::Stable => "stable",
            Step::Time => "time",
            Step::Work => "work",
        }
    }

    fn of<T>(self, result: Result<T, String>) -> Result<T, Rejection> {
        result.map_err(|reason| Rejection { step: self, reason })
    }

    fn fails<T>(self, reason: impl Into<String>) -> Result<T, Rejection> {
        Err(Rejection { step: self, reason: reason.into() })
    }
}

/// Why a certificate proves nothing.
///
/// ```
/// use jurist_check::{Limits, Step, check};
/// let model = "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - 1 + K'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/1",
///     "statement": {"kind": "verdict", "time": "discrete", "set": {"K": "1"}, "region": {"radius": "1"},
///         "verdict": "stable", "degree": 1, "inside": 1, "on": 0, "outside": 0, "infinite": 0},
///     "characteristic": [[], ["1"]]
/// }"#;
/// let lie = certificate.replace("[[], [\"1\"]]", "[[\"1\"], [\"1\"]]");
/// assert_eq!(check(model, &lie, &Limits::default()).unwrap_err().step, Step::Characteristic);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Rejection {
    /// The step that failed.
    pub step: Step,
    /// What is wrong, in a sentence.
    pub reason: String,
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // What is too much to check may still be true.
        let word = if matches!(self.step, Step::Time | Step::Work) { "refused" } else { "rejected" };
        write!(f, "the certificate is {word} at the step '{}': {}", self.step.name(), self.reason)
    }
}

impl std::error::Error for Rejection {}

/// Checks that a certificate proves its statement about a model, both given as text.
///
/// Cost: one pass. The model's polynomial is a determinant at as many points as its degrees in `z` and in the
/// parameter ask for, `O(n^3)` operations each; then the identity is multiplied out, and each piece of the line
/// takes `O(d^2)` additions for the sign variations of each factor of degree `d` (\[BasuPollackRoy2006\]) and each
/// sample a reduction of `O(n^2)` operations (\[Jury1964\], \[Routh1877\]).
///
/// ```
/// use jurist_check::{check, Limits};
/// let model = r#"
///     time = "discrete"
///     parameters.K = {}
///     loop.characteristic = "z - 1 + K"
/// "#;
/// let certificate = r#"{
///     "schema": "jurist/certificate/1",
///     "statement": {"kind": "intervals", "time": "discrete", "parameter": "K", "set": {}, "region": {"radius": "1"},
///         "domain": {"lower": null, "upper": null}, "stable": [{"lower": "0", "upper": "2"}]},
///     "characteristic": [["-1", "1"], ["1"]],
///     "boundary": null,
///     "factors": [["0", "1"], ["-2", "1"]],
///     "line": [{"split": [], "sample": "-1", "stable": false}, {"at": "0"},
///              {"split": [], "sample": "1", "stable": true}, {"at": "2"},
///              {"split": [], "sample": "3", "stable": false}]
/// }"#;
/// let proved = check(model, certificate, &Limits::default()).unwrap();
/// assert_eq!(proved.statement, "For all real K, the loop is stable exactly for 0 < K < 2.");
/// let wrong = certificate.replace("\"upper\": \"2\"", "\"upper\": \"3\"");
/// assert!(check(model, &wrong, &Limits::default()).is_err());
/// ```
///
/// The check runs in a thread of its own, so that it can be given up in the middle of an operation; where there are no threads (as in
/// WebAssembly), on the calling thread. Where there is no clock either (`wasm32-unknown-unknown`), operations are counted by
/// the lengths of their numbers and the time is over after as many units as it has nanoseconds. That is the order of what they
/// take, not a promise: additions and products of whole polynomials are not counted one by one.
///
/// # Errors
/// [`Rejection`] with the step that failed. A rejection says nothing about the statement.
pub fn check(model: &str, certificate: &str, limits: &Limits) -> Result<Proved, Rejection> {
    let limits = *limits;
    let (sender, receiver) = channel();
    let texts = (model.to_owned(), certificate.to_owned());
    let work = move || drop(sender.send(checked(&texts.0, &texts.1, &limits)));
    if std::thread::Builder::new().stack_size(STACK).spawn(work).is_err() {
        return checked(model, certificate, &limits);
    }
    // The clock is looked at between operations; one of them on long numbers can take its time.
    receiver.recv_timeout(limits.timeout.saturating_add(GRACE)).unwrap_or_else(|e| {
        Err(match e {
            RecvTimeoutError::Timeout => Rejection { step: Step::Time, reason: out_of_time(limits.timeout) },
            RecvTimeoutError::Disconnected => {
                Rejection { step: Step::Format, reason: "internal: the check broke off".into() }
            }
        })
    })
}

fn checked(model: &str, certificate: &str, limits: &Limits) -> Result<Proved, Rejection> {
    let clock = Clock::of_texts(limits.timeout, model.len() + certificate.len());
    let refusals = clock.refusals();
    // A refusal is told apart, in whatever step it came.
    by_kind(model, certificate, clock)
        .map_err(|e| if refusals.load(Ordering::Relaxed) { Rejection { step: Step::Work, ..e } } else { e })
}

fn by_kind(model: &str, certificate: &str, clock: Clock) -> Result<Proved, Rejection> {
    let json = Step::Format.of(Json::parse(certificate))?;
    // Another version may have other parts, so it is looked at first.
    let schema = Step::Format.of(schema(&json))?;
    let statement =
        Step::Format.of(json.get("statement").ok_or_else(|| "the certificate has no 'statement'".into()))?;
    let kind = Step::Statement.of(statement.get("kind").ok_or_else(|| "the statement has no 'kind'".into()))?;
    if toml::read(model).is_ok_and(|model| blocks::has_several_rates(&model)) {
        Step::Model.of(fits_several_rates(schema, statement))?;
    }
    match Step::Statement.of(text(kind, "'kind'"))? {
        "boxes" if schema == SCHEMA_OF_MAPS_BY_BOXES => map_boxes::check(model, &json, clock),
        "for_all" if schema == SCHEMA_FOR_ALL => for_all::check(model, &json, clock),
        "tune" if schema == SCHEMA_OF_TUNING => tuned::check(model, &json, clock),
        "map" if schema == SCHEMA_OF_MAPS => map::check(model, &json, statement, &clock),
        "tolerance" if [SCHEMA_OF_BOXES, SCHEMA_OF_BOXES_WITH_SYMBOLS].contains(&schema) => {
            boxes::check(model, &json, statement, &clock)
        }
        "cells" if schema == SCHEMA_OF_CELLS => gain::check(model, &json, statement, &clock),
        "verdict" if schema == SCHEMA_OF_CELLS => gain::check_verdict(model, &json, statement, &clock),
        "intervals" if schema == SCHEMA_WITH_DEAD_TIME => dead_time::check(model, &json, statement, &clock),
        "intervals" if [SCHEMA, SCHEMA_WITH_SYMBOLS].contains(&schema) => {
            intervals::check(model, &json, statement, &clock)
        }
        "verdict" if [SCHEMA, SCHEMA_WITH_SYMBOLS, SCHEMA_BY_ENCLOSURES].contains(&schema) => {
            verdict::check(model, &json, statement, &clock)
        }
        other => Step::Statement.fails(format!("unknown kind of statement '{}'", shorten(other))),
    }
}

/// The version of a certificate, if it is known.
fn schema(json: &Json) -> Result<&str, String> {
    let schema = text(json.get("schema").ok_or("the certificate has no 'schema'")?, "'schema'")?;
    let known = [
        SCHEMA,
        SCHEMA_WITH_SYMBOLS,
        SCHEMA_WITH_DEAD_TIME,
        SCHEMA_OF_BOXES,
        SCHEMA_OF_MAPS,
        SCHEMA_OF_CELLS,
        SCHEMA_OF_MAPS_BY_BOXES,
        SCHEMA_OF_BOXES_WITH_SYMBOLS,
        SCHEMA_BY_ENCLOSURES,
        SCHEMA_FOR_ALL,
        SCHEMA_OF_TUNING,
    ];
    if known.contains(&schema) {
        return Ok(schema);
    }
    let [rest @ .., last] = known.map(|name| format!("'{name}'"));
    Err(format!("the schema is '{}', not {} or {last}", shorten(schema), rest.join(", ")))
}

/// Certificates of a loop with several rates prove stability in the unit disc.
fn fits_several_rates(schema: &str, statement: &Json) -> Result<(), String> {
    let region = statement.get("region").and_then(|region| region.get("radius"));
    let of_rates =
        [SCHEMA, SCHEMA_WITH_SYMBOLS, SCHEMA_OF_MAPS_BY_BOXES, SCHEMA_BY_ENCLOSURES, SCHEMA_FOR_ALL, SCHEMA_OF_TUNING];
    match of_rates.contains(&schema) && matches!(region, Some(Json::Text(one)) if one == "1") {
        true => Ok(()),
        false => Err("a loop of several rates has certificates of stability without further wishes alone".into()),
    }
}

/// Whether the model's time is that of the statement.
fn is_same_time(model: bool, statement: bool) -> Result<(), String> {
    if model == statement { Ok(()) } else { Err("the model's time is not that of the statement".into()) }
}

/// `time` of a statement.
fn is_discrete(json: &Json) -> Result<bool, String> {
    match text(json, "'time'")? {
        "discrete" => Ok(true),
        "continuous" => Ok(false),
        other => Err(format!("unknown time '{}'", shorten(other))),
    }
}

/// The table of symbols of a certificate that has one.
fn table(json: &Json) -> Result<Option<Rc<Table>>, Rejection> {
    let part = |key: &str| json.get(key).ok_or_else(|| format!("the certificate has no '{key}'"));
    if ![SCHEMA_WITH_SYMBOLS, SCHEMA_OF_BOXES_WITH_SYMBOLS]
        .map(|s| Some(s.into()))
        .contains(&json.get("schema").cloned())
    {
        return Ok(None);
    }
    let [bits, symbols, modes] = ["bits", "symbols", "modes"].map(part);
    let table = Step::Format.of((|| Table::read(bits?, symbols?, modes?))())?;
    Ok(Some(Rc::new(table)))
}

/// The keys of a certificate that may be there beside those of its kind.
fn further_keys(table: Option<&Rc<Table>>) -> &'static [&'static str] {
    if table.is_some() { &["model", "bits", "symbols", "modes"] } else { &["model"] }
}

fn same_characteristic(given: &[Uni], own: &[Uni]) -> Result<(), String> {
    if given.len() != own.len() {
        return Err(format!("there are {} coefficients, but the model's polynomial has {}", given.len(), own.len()));
    }
    match given.iter().zip(own).position(|(g, o)| g != o) {
        Some(k) => Err(format!("coefficient {k} is not that of the model")),
        None => Ok(()),
    }
}
