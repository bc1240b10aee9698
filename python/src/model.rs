//! Models and the answers to questions about them.

use crate::errors::{About, raised, warnings};
use crate::question::Asked;
use crate::wait::{Patience, waited};
use jurist::Theorem;
use jurist::cli::captured;
use jurist::documents::{Intervals, Verdict, to_text};
use jurist::{Answer, Budget, Error, PointVerdict, StableSet};
use jurist::{Document, Text};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// Codes and texts of warnings.
type Warnings = Vec<(&'static str, String)>;

/// A parameter as texts: name, nominal value, lower and upper bound, unit, description, the formula of the nominal value;
/// and whether the bounds belong to the domain.
type ParameterParts =
    (String, Option<String>, Option<String>, Option<String>, Option<String>, Option<String>, Option<String>, bool);

/// A model that has been read.
#[pyclass(frozen, module = "jurist._jurist")]
pub(crate) struct Model(Arc<jurist::Model>);

#[pymethods]
impl Model {
    /// Reads a model file; numbers of other files are read below its folder, where it has one.
    #[staticmethod]
    #[pyo3(signature = (name, content, folder = None))]
    fn read(py: Python<'_>, name: String, content: Vec<u8>, folder: Option<PathBuf>) -> PyResult<(Model, Warnings)> {
        let read = move |_: &Budget| {
            Ok(match &folder {
                Some(folder) => jurist::cli::model_in_folder(&name, &content, folder)?,
                None => jurist::Model::from_bytes(&name, &content)?,
            })
        };
        let (model, remarks) =
            waited(py, &Patience::unlimited(), read)?.map_err(|e| raised(py, e, About::Model, None))?;
        let remarks = warnings(&remarks, Some(model.source()));
        Ok((Model(Arc::new(model)), remarks))
    }

    /// The model that a loop in one line means.
    #[staticmethod]
    #[pyo3(signature = (line, hold = None, delay = None))]
    fn from_line(
        py: Python<'_>,
        line: String,
        hold: Option<String>,
        delay: Option<String>,
    ) -> PyResult<(Model, Warnings)> {
        let read = move |_: &Budget| {
            Ok(jurist::LoopLine::read(&line, hold.as_deref(), delay.as_deref()).and_then(|line| line.model())?)
        };
        let (model, remarks) =
            waited(py, &Patience::unlimited(), read)?.map_err(|e| raised(py, e, About::Model, None))?;
        let remarks = warnings(&remarks, Some(model.source()));
        Ok((Model(Arc::new(model)), remarks))
    }

    /// The built-in drive.
    #[staticmethod]
    fn drive() -> Model {
        Model(Arc::new(jurist::Model::drive()))
    }

    /// The text that was read.
    fn text(&self) -> &str {
        &self.0.source().text
    }

    /// The name of that text.
    fn name(&self) -> &str {
        &self.0.source().name
    }

    fn title(&self) -> Option<&str> {
        self.0.title()
    }

    /// `discrete` or `continuous`.
    fn time(&self) -> &'static str {
        self.0.time().name()
    }

    fn parameters(&self) -> Vec<ParameterParts> {
        let text = |value: &Option<jurist::Rational>| value.as_ref().map(ToString::to_string);
        let parts = |p: &jurist::Parameter| {
            let unit = p.unit.clone();
            let formula = p.nominal_formula.as_ref().map(ToString::to_string);
            (
                p.name.clone(),
                text(&p.nominal),
                text(&p.min),
                text(&p.max),
                unit,
                p.description.clone(),
                formula,
                p.closed,
            )
        };
        self.0.parameters().iter().map(parts).collect()
    }

    /// The names of the constants, and whether each is given as a number.
    fn constants(&self) -> Vec<(String, bool)> {
        self.0.constants().iter().map(|c| (c.name.clone(), self.0.free(&c.name).is_ok())).collect()
    }

    fn inputs(&self) -> Vec<String> {
        self.0.inputs().iter().map(|name| name.name.clone()).collect()
    }

    fn outputs(&self) -> Vec<String> {
        self.0.outputs().iter().map(|output| output.name.name.clone()).collect()
    }

    /// The sample time at a point; `None` in continuous time and where the model gives none.
    fn sample_time(&self, py: Python<'_>, mut asked: Asked) -> PyResult<Option<String>> {
        let (model, patience) = (Arc::clone(&self.0), asked.patience());
        let work = move |budget: &Budget| {
            let problem = asked.of(&model)?.problem()?;
            let time = problem.algebra(budget)?.sample_time().and_then(|t| t.as_constant());
            Ok(time.map(|t| t.to_string()))
        };
        waited(py, &patience, work)?.map_err(|e| raised(py, e, About::Question, None))
    }

    /// The stable set of a parameter.
    fn intervals(&self, py: Python<'_>, mut asked: Asked, parameter: String) -> PyResult<(Answered, String, Warnings)> {
        let (model, patience, digits) = (Arc::clone(&self.0), asked.patience(), asked.digits);
        let work = move |budget: &Budget| {
            let question = asked.of(&model)?;
            if parameter != "radius" && parameter != "decay" {
                model.free(&parameter)?;
            }
            let problem = question.free(parameter).problem()?;
            match problem.stable_set(budget) {
                Ok(answer) => {
                    let text = budget.enter(|| to_text(&answer.json(digits)))?;
                    Ok(Ok((text, answer)))
                }
                Err(Error::Stopped(stopped)) => {
                    let document = to_text(&Intervals::new(&problem, Err(&stopped), digits));
                    Ok(Err((Error::Stopped(stopped), document)))
                }
                Err(other) => Err(other),
            }
        };
        let (text, answer) = decided(py, waited(py, &patience, work)?)?;
        let remarks = warnings(answer.problem().warnings(), None);
        Ok((Answered(Arc::new(Kind::Stable(answer))), text, remarks))
    }

    /// The verdict at a point.
    fn verdict(&self, py: Python<'_>, mut asked: Asked) -> PyResult<(Answered, String, Warnings)> {
        let (model, patience) = (Arc::clone(&self.0), asked.patience());
        let work = move |budget: &Budget| {
            let problem = asked.of(&model)?.problem()?;
            match problem.verdict(budget) {
                Ok(answer) => {
                    let text = budget.enter(|| to_text(&Verdict::new(&problem, Ok(answer.value()))))?;
                    Ok(Ok((text, answer)))
                }
                Err(Error::Stopped(stopped)) => {
                    let document = to_text(&Verdict::new(&problem, Err(&stopped)));
                    Ok(Err((Error::Stopped(stopped), document)))
                }
                Err(other) => Err(other),
            }
        };
        let (text, answer) = decided(py, waited(py, &patience, work)?)?;
        let remarks = warnings(answer.problem().warnings(), None);
        Ok((Answered(Arc::new(Kind::Verdict(answer))), text, remarks))
    }

    /// Runs a command of the program about this model (`-`): status, output, notes, warnings.
    #[pyo3(signature = (arguments, timeout = None, progress = None))]
    fn command(
        &self,
        py: Python<'_>,
        arguments: Vec<String>,
        timeout: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(u8, String, Vec<String>, Warnings)> {
        let model = Arc::clone(&self.0);
        let work = move |budget: &Budget| captured(arguments, &model, budget);
        let done = waited(py, &Patience { timeout, progress }, work)?;
        let done = done.map_err(|e| raised(py, e, About::Question, None))?;
        Ok((done.status, done.output, done.notes, done.warnings))
    }
}

/// An answer, or what is known of one that stopped.
fn decided<T>(py: Python<'_>, result: Result<Result<T, (Error, String)>, Error>) -> PyResult<T> {
    match result {
        Ok(Ok(value)) => Ok(value),
        Ok(Err((stopped, document))) => Err(raised(py, stopped, About::Question, Some(document))),
        Err(error) => Err(raised(py, error, About::Question, None)),
    }
}

/// What is known.
enum Kind {
    Stable(Answer<StableSet>),
    Verdict(Answer<PointVerdict>),
}

/// An answer with its problem, for what is made of it later.
#[pyclass(frozen, module = "jurist._jurist")]
pub(crate) struct Answered(Arc<Kind>);

#[pymethods]
impl Answered {
    /// The program's text.
    fn text(&self, py: Python<'_>, digits: usize) -> PyResult<String> {
        self.made(py, None, move |kind, _| {
            Ok(match kind {
                Kind::Stable(answer) => answer.text(digits),
                Kind::Verdict(answer) => answer.text(digits),
            })
        })
    }

    /// The document with another number of digits.
    fn json(&self, py: Python<'_>, digits: usize) -> PyResult<String> {
        self.made(py, None, move |kind, _| {
            Ok(match kind {
                Kind::Stable(answer) => to_text(&answer.json(digits)),
                Kind::Verdict(answer) => to_text(&answer.json(digits)),
            })
        })
    }

    /// A certificate.
    fn certificate(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<String> {
        self.made(py, timeout, |kind, budget| match kind {
            Kind::Stable(answer) => {
                jurist::certified::certify_intervals(answer, budget).map(|certified| certified.text)
            }
            Kind::Verdict(answer) => jurist::certified::certify_verdict(answer, budget),
        })
    }

    /// The statement as SMT-LIB 2; `None` for a verdict.
    fn smt2(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Option<String>> {
        self.made(py, timeout, |kind, budget| match kind {
            Kind::Stable(answer) => jurist::smt2(answer, budget).map(Some),
            Kind::Verdict(_) => Ok(None),
        })
    }

    /// The statement as a theorem for Coq; `None` for a verdict.
    fn coq(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Option<String>> {
        self.made(py, timeout, |kind, budget| match kind {
            Kind::Stable(answer) => answer.coq(budget).map(Some),
            Kind::Verdict(_) => Ok(None),
        })
    }
}

impl Answered {
    fn made<T: Send + 'static>(
        &self,
        py: Python<'_>,
        timeout: Option<f64>,
        make: impl FnOnce(&Kind, &Budget) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let kind = Arc::clone(&self.0);
        let work = move |budget: &Budget| make(&kind, budget);
        waited(py, &Patience { timeout, progress: None }, work)?.map_err(|e| raised(py, e, About::Question, None))
    }
}
