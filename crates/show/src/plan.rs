//! How a question is decided, as text.

use jurist_engine::coverage::Coverage;
use jurist_engine::problem::{Plan, Problem};

/// How a question is decided, for people; empty where nobody asked for it.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::coverage::Asked;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_show::plan_text;
/// let problem = Model::drive().ask().free("K_pwm").problem()?;
/// assert_eq!(plan_text(&problem), "");
/// problem.explain(Asked::Intervals, &Budget::unlimited())?;
/// assert!(plan_text(&problem).contains("order         6\n"));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub fn plan_text(problem: &Problem) -> String {
    problem.explained().map(|plan| text(plan, problem)).unwrap_or_default()
}

fn text(plan: &Plan, problem: &Problem) -> String {
    let names: Vec<&str> = problem.free().iter().map(|free| free.name.as_str()).collect();
    let mut out = "\nhow it is decided\n".to_owned();
    let mut line = |head: &str, text: &str| out += &format!("    {head:<13} {text}\n");
    line("question", plan.asked.row().command);
    if !names.is_empty() {
        line("free", &names.join(", "));
    }
    line("coefficients", &format!("{}: {}", plan.ring.name(), plan.ring.words()));
    for (name, definition) in &plan.symbols {
        line("", &format!("{name} = {definition}"));
    }
    if let Some(order) = plan.order {
        line("order", &order.to_string());
    }
    if let Some(method) = plan.coverage.method() {
        let by_boxes = if matches!(plan.coverage, Coverage::ByBoxes(_)) { ", by boxes" } else { "" };
        line("method", &format!("{}{by_boxes} ({})", method.name, method.place));
        line("", method.how);
    }
    if let Some(refusal) = plan.coverage.refusal() {
        let head = if plan.coverage.method().is_some() { "or refused" } else { "refused" };
        line(head, &format!("{}: {}", refusal.code, refusal.in_general()));
    }
    line("presupposed", "every expression has a value, and the degree is that in all parameters");
    for inequality in &plan.presupposed {
        line("", inequality);
    }
    out
}
