//! Parts of a model on their own: for questions that look inside the diagram.

use super::definition::{Diagram, Form, Loop, Time};
use super::question::{ModelError, Question};
use super::text::Expression;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

impl Loop {
    /// The same constants and parameters with another diagram, in discrete or continuous time.
    ///
    /// The diagram is taken as it is: signals without a driver among its inputs and blocks are found
    /// when it is asked.
    pub fn with_diagram(&self, diagram: Diagram, time: Time) -> Loop {
        Loop { form: Form::Blocks(diagram), time, ..self.clone() }
    }

    /// The value of an expression in constants and parameters, which all are set or nominal.
    ///
    /// # Errors
    /// As [`Loop::characteristic_polynomial`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Expression, Loop, Question};
    /// let inductance = Expression::parse("1/L_a").unwrap();
    /// let value = Loop::drive().value(&inductance, &Question::default(), &Budget::unlimited()).unwrap();
    /// assert_eq!(value.to_string(), "500/23");
    /// ```
    pub fn value(&self, expression: &Expression, question: &Question, budget: &Budget) -> Result<Rational, ModelError> {
        let question = Question { keep: Vec::new(), set: question.set.clone() };
        let carrier = Loop { sample_time: Some(expression.clone()), ..self.clone() };
        let value = carrier.sample_time(&question, budget)?.and_then(|f| f.as_constant());
        value.ok_or_else(|| ModelError::Undefined("an expression divides by zero".into()))
    }
}
