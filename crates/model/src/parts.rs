//! Parts of a model on their own: for questions that look inside the diagram.

use super::definition::{Diagram, Form, Model, Time};

impl Model {
    /// The same constants and parameters with another diagram, in discrete or continuous time.
    ///
    /// The diagram is taken as it is: signals without a driver among its inputs and blocks are found
    /// when it is asked.
    pub fn with_diagram(&self, diagram: Diagram, time: Time) -> Model {
        Model { form: Form::Blocks(diagram), time, ..self.clone() }
    }
}
