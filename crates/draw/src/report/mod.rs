//! One page about one loop: the model, the verdict, every limit with its cause, margins, what moves the limits, the worst
//! corner, pictures, certificates, and what is proved of all that.
//!
//! Every number is that of an answer. A part that is undefined, refused, or takes too long is replaced by one sentence
//! with the reason; no part stops another.

mod best;
mod certificates;
mod for_all;
mod limit;
mod limits;
mod map;
mod margins;
mod model;
mod part;
mod pictures;
mod proved;
mod required;
mod sensitivity;
mod tolerance;

pub use limit::{around_nominal, limit_text, percent_change};
pub use model::{comment_at, entries};

use crate::page::{Section, math, paragraph, report_page};
use certificates::Commands;
use jurist_algebra::limits::{Budget, Exhausted, join, parallel_map};
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::error::Error;
use jurist_engine::problem::Question;
use jurist_engine::response::AllOf;
use jurist_engine::stability::StableSet;
use jurist_show::layout::called;
use part::{Parts, Work};

/// Proves a certificate again by other code; an error is the reason why it was not accepted.
pub type Checker<'a> = &'a (dyn Fn(&str) -> Result<(), String> + Sync);

/// Writes the certificate of the limits of one parameter, and how much it says where that is not everything.
pub type Certifier<'a> = &'a (dyn Fn(&Answer<StableSet>, &Budget) -> Result<(String, Option<String>), Error> + Sync);

/// Writes the certificate of the verdict.
pub type VerdictCertifier<'a> = &'a (dyn Fn(&Answer<PointVerdict>, &Budget) -> Result<String, Error> + Sync);

/// The best gains of the model's section `[tune]` in words.
pub type BestGains<'a> = &'a (dyn Fn(&Budget) -> Result<String, Error> + Sync);

/// What a report is to say beside its answers.
///
/// ```
/// use jurist_draw::report::ReportRequest;
/// let request = ReportRequest { file: Some("loop.toml"), at: Some("u"), ..ReportRequest::default() };
/// assert!(request.certify.is_none() && request.check.is_none());
/// ```
#[derive(Clone, Copy, Default)]
pub struct ReportRequest<'a> {
    /// The model's file in the command lines for certificates; `None` for the built-in drive.
    pub file: Option<&'a str>,
    /// Where the loop is cut for margins and the Bode diagram; `None` where the model's `[require]` says so, or there is one loop only.
    pub at: Option<&'a str>,
    /// Writes the certificates of limits; `None` for [`certificate`](jurist_prove::Certificate::certificate).
    pub certify: Option<Certifier<'a>>,
    /// Writes the certificate of the verdict; `None` for [`certificate`](jurist_prove::Certificate::certificate).
    pub certify_verdict: Option<VerdictCertifier<'a>>,
    /// The independent check of certificates.
    pub check: Option<Checker<'a>>,
    /// Names with ranges: what holds for all of these values has a section of its own.
    pub for_all: &'a [AllOf],
    /// The best gains; `None` for a model that does not ask for them.
    pub best: Option<BestGains<'a>>,
}

/// The page, and whether it is all of it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LoopReport {
    /// A page that needs nothing else.
    pub html: String,
    /// What ended the first part that the budget did not allow; `None` where every part is there or has a reason of its own.
    pub stopped: Option<Exhausted>,
}

/// The report on a question in which no name is free: its parameters are asked about one after the other.
///
/// Cost: that of every answer in it. The verdict ends with the budget only; all other parts are left out, too,
/// when they take more than a fixed amount of work, so that the page is the same on every machine.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_draw::report::{ReportRequest, loop_report};
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let report = loop_report(&model.ask(), &ReportRequest::default(), &Budget::unlimited());
/// assert!(report.html.contains("all 2 roots are inside the unit circle") && report.stopped.is_none());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
///
/// # Panics
/// When a name is free.
pub fn loop_report(question: &Question, request: &ReportRequest<'_>, budget: &Budget) -> LoopReport {
    assert!(question.free_names().is_empty(), "a report frees one parameter after the other");
    let parts = Parts::new(budget);
    let model = question.model();
    let problem = parts.part("the nominal point", Work::Any, |_| question.clone().problem());
    let verdict = problem
        .as_ref()
        .map_err(Clone::clone)
        .and_then(|problem| parts.part("the verdict", Work::Any, |budget| problem.verdict(budget)));
    let required = model.require().iter().find(|r| r.name == "at").map(|r| r.text.as_str());
    let at = request.at.or(required);
    let (limits, margins) = join(|| limits::find(question, &parts), || margins::find(&problem, at, &parts));
    let required = required::find(question, &problem, at, &parts);
    let commands = Commands { file: request.file, question };
    // Parts that need nothing of each other, side by side.
    type Made<'p> = Box<dyn Fn() -> String + Sync + Send + 'p>;
    let sections: Vec<(&'static str, &'static str, Made<'_>)> = vec![
        ("model", "The model", Box::new(|| model::section(question))),
        ("limits", "Verdict and limits", Box::new(|| limits::section(&verdict, &required::html(&required), &limits))),
        ("margins", "Margins of the loop", Box::new(|| margins::section(&margins, &parts))),
        (
            "sensitivity",
            "How the limits depend on each number",
            Box::new(|| sensitivity::section(question, &limits, &parts)),
        ),
        ("for-all", "For all values", Box::new(|| for_all::section(question, request, at, &parts))),
        ("best", "Best gains", Box::new(|| best::section(request, &parts))),
        ("tolerance", "Worst corner of the tolerances", Box::new(|| tolerance::section(question, &parts))),
        ("locus", "Root locus", Box::new(|| pictures::locus(&limits, &parts))),
        ("bode", "Bode and Nyquist diagrams", Box::new(|| margins::bode_section(&margins, &parts))),
        ("response", "Response", Box::new(|| pictures::response(&problem, &verdict, &parts))),
        ("map", "Map of two parameters", Box::new(|| map::section(question, &limits, &parts))),
        (
            "certificates",
            "Certificates",
            Box::new(|| certificates::section(&commands, &verdict, &limits, request, &parts)),
        ),
        ("proved", "What is proved, what is drawn, what is left out", Box::new(|| proved::section(model))),
    ];
    let is_asked = |(id, ..): &(&str, &str, Made<'_>)| match *id {
        "best" => request.best.is_some(),
        "for-all" => !request.for_all.is_empty(),
        _ => true,
    };
    let sections: Vec<_> = sections.into_iter().filter(is_asked).collect();
    let sections: Vec<Section> = parallel_map(sections, |(id, heading, make)| Section { id, heading, html: make() });
    let title = format!("Stability report: {}", called(model.title()));
    let mut lead = format!("At the nominal point <b>{}</b>.", math(&limits::verdict_sentence(&verdict)));
    lead.extend(required::sentence(&required).map(|s| format!(" {}", math(&s))));
    lead.extend(limits::nearest_sentence(&limits).map(|s| format!(" {}", math(&s))));
    lead.push_str(&proved::rules(model));
    let html = report_page(&title, &paragraph(&lead), &sections);
    LoopReport { html, stopped: parts.stopped() }
}
