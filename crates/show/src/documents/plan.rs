//! How a question is decided, in documents of commands with `--explain`.

use super::number::Named;
use jurist_engine::problem::Problem;
use serde::{Deserialize, Serialize};

/// How a question is decided.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Plan {
    /// The question, as the program is asked.
    pub question: String,
    /// What the coefficients of the characteristic function are made of: `rational`, `constants`, `functions`, `dead time`, `dead time beside
    /// functions` or `varying order`.
    pub ring: String,
    /// The constants, functions and delays in the coefficients, with their definitions.
    pub symbols: Named<String>,
    /// The degree of the characteristic polynomial in all parameters; `null` where it depends on what is free.
    pub order: Option<usize>,
    /// `answered`, `by boxes`, `in part` or `refused`.
    pub outcome: String,
    /// The method; `null` where the question is refused.
    pub method: Option<PlannedMethod>,
    /// Inequalities in the free names that hold where the model has a meaning.
    pub presupposed: Vec<String>,
}

/// A method.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlannedMethod {
    /// Its name.
    pub name: String,
    /// Why its answer is right.
    pub how: String,
    /// Where it is in the code of `jurist_engine`.
    pub place: String,
}

impl Plan {
    /// The plan of a problem that was asked for one.
    pub(super) fn of(problem: &Problem) -> Option<Box<Plan>> {
        let plan = problem.explained()?;
        let method = plan.coverage.method().map(|method| PlannedMethod {
            name: method.name.to_owned(),
            how: method.how.to_owned(),
            place: method.place.to_owned(),
        });
        Some(Box::new(Plan {
            question: plan.asked.row().command.to_owned(),
            ring: plan.ring.name().to_owned(),
            symbols: plan.symbols.iter().cloned().collect(),
            order: plan.order,
            outcome: plan.coverage.name().to_owned(),
            method,
            presupposed: plan.presupposed.clone(),
        }))
    }
}
