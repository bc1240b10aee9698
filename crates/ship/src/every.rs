//! Every rounding: the box of all numbers that a coefficient may be stored as.

use crate::asked::Asked;
use crate::format::{Fixed, Format};
use crate::program::Coefficient;
use crate::realise::Entry;
use crate::shipped::{Shipped, question_of};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::error::Error;
use jurist_engine::model::{Model, Tolerance};
use jurist_engine::response::Requirement;
use jurist_engine::stability::boxes::BoxDecision;

/// The relative width of the bracket of the largest factor.
const GAP: i64 = 10_000;

impl Shipped {
    /// The text of a model in which each coefficient is a parameter, and its tolerance all that it may be rounded to; and their names, in the order
    /// of the coefficients.
    ///
    /// Cost: that of reading the text as TOML for each coefficient.
    pub fn every_text(&self) -> (String, Vec<String>) {
        let model = self.exact.model();
        let names: Vec<String> = self.coefficients.iter().map(|c| unused(&format!("ship_{}", c.name), model)).collect();
        let entries: Vec<Entry> = names.iter().cloned().map(Entry::Formula).collect();
        let keys = self.realised.keys(&entries);
        let text = model.with_block(&self.asked.block, &keys).unwrap_or_else(|| model.source().text.clone());
        let mut text = text;
        for (coefficient, name) in self.realised.program.coefficients.iter().zip(&names) {
            let (low, high) = bounds(coefficient, &self.asked.format);
            let nominal = coefficient.exact.lower().midpoint(coefficient.exact.upper());
            let table = format!("{{ nominal = \"{nominal}\", tolerance = {{ low = \"{low}\", high = \"{high}\" }} }}");
            text = Model::with_keys(&text, "parameters", &[(name, table)]);
        }
        (text, names)
    }

    /// Whether the loop is stable, and meets requirements, whatever the coefficients are rounded to within half a unit of the last place (of
    /// directed rounding, a unit), and by how much that may be scaled. `None` where nothing is rounded.
    ///
    /// Cost: that of [`Question::tolerance`](jurist_engine::problem::Question::tolerance).
    ///
    /// # Errors
    /// As [`Question::tolerance`](jurist_engine::problem::Question::tolerance).
    pub fn every_rounding(
        &self,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Option<Answer<ToleranceAnswer>>, Error> {
        self.box_of_roundings(requirements, at, false, budget)
    }

    fn box_of_roundings(
        &self,
        requirements: &[Requirement],
        at: Option<&str>,
        is_box_alone: bool,
        budget: &Budget,
    ) -> Result<Option<Answer<ToleranceAnswer>>, Error> {
        if self.coefficients.is_empty() {
            return Ok(None);
        }
        let (text, names) = self.every_text();
        let question = question_of(&self.exact, text)?;
        let tolerance = |coefficient: &Coefficient| {
            let (low, high) = bounds(coefficient, &self.asked.format);
            Tolerance::Range { low, high }
        };
        let tolerances = names.into_iter().zip(self.realised.program.coefficients.iter().map(tolerance));
        let gap = Rational::new(1.into(), GAP.into());
        let request = ToleranceRequest::new(tolerances).gap(gap).require(requirements.to_vec(), at.map(str::to_owned));
        let request = if is_box_alone { request.box_alone() } else { request };
        question.tolerance(&request, budget).map(Some)
    }

    /// Whether it is so with another number of bits behind the point; `None` where that is not decided.
    ///
    /// # Errors
    /// As [`Shipped::every_rounding`].
    pub(crate) fn every_rounding_with(
        &self,
        fixed: &Fixed,
        bits: i64,
        (requirements, at): (&[Requirement], Option<&str>),
        budget: &Budget,
    ) -> Result<Option<bool>, Error> {
        let format = Format::Fixed(Fixed { bits: 64, fraction: bits as i32, ..*fixed });
        let asked = Asked { format, ..self.asked.clone() };
        let shipped = Shipped { asked, ..self.clone() };
        let Some(answer) = shipped.box_of_roundings(requirements, at, true, budget)? else { return Ok(Some(true)) };
        Ok(match answer.value().decision {
            BoxDecision::Stable(_) => Some(true),
            BoxDecision::NotStable { .. } => Some(false),
            BoxDecision::Undecided { .. } => None,
        })
    }
}

/// The least and the greatest number that a coefficient may be rounded to.
fn bounds(coefficient: &Coefficient, format: &Format) -> (Rational, Rational) {
    let half = format.half_unit(&coefficient.exact);
    let (least, greatest) = match format {
        Format::Fixed(fixed) => fixed.rounding.error_in_halves(),
        Format::Binary(_) => (-1, 1),
    };
    let end = |of: &Rational, halves: i64| of + &(&half * &Rational::from(halves));
    (end(coefficient.exact.lower(), least), end(coefficient.exact.upper(), greatest))
}

/// The name, with more letters where the model has it.
fn unused(name: &str, model: &Model) -> String {
    let mut name = name.to_owned();
    while model.source().text.contains(&name) {
        name.push('x');
    }
    name
}
