//! Verdicts on a file's loops: under both readings, and as DSVerifier stores the controller.

use super::{DsFile, Reading, Writing};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{PointVerdict, Verdict};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;

impl DsFile {
    /// The verdict on the loop that a file is, under a reading.
    ///
    /// Cost: that of [`jurist_engine::problem::Problem::verdict`].
    ///
    /// # Errors
    /// Those of [`DsFile::model`] and of the question.
    pub fn verdict(&self, writing: &Writing, budget: &Budget) -> Result<PointVerdict, Error> {
        let name = &self.source.name;
        let (model, _) = Model::from_toml(&Source::new(name.clone(), self.model(name, writing)?))?;
        Ok(model.ask().problem()?.verdict(budget)?.value().clone())
    }

    /// The warning `W-dsv-reading`, where one reading gives a stable loop and the other does not: of the loop as it is printed, or as it is stored.
    ///
    /// Cost: four verdicts at most, none where both readings are the same loop.
    ///
    /// # Errors
    /// Where the work was stopped. A reading that is refused has no verdict.
    pub fn reading_warning(&self, writing: &Writing, budget: &Budget) -> Result<Option<Diagnostic>, Error> {
        let Some(plant) = self.plant.as_ref().filter(|_| !self.is_same_read_in_both_ways()) else { return Ok(None) };
        let stored = self.stored(writing.rounding).ok();
        for (file, how) in [(Some(self), ""), (stored.as_ref(), " as DSVerifier stores it")] {
            let Some(file) = file else { continue };
            let mut found = Vec::new();
            for reading in Reading::ALL {
                match file.verdict(&Writing { reading, ..*writing }, budget) {
                    Ok(verdict) => found.push(verdict.verdict == Verdict::Stable),
                    Err(stopped @ Error::Stopped(_)) => return Err(stopped),
                    Err(_) => {}
                }
            }
            let stable = match found[..] {
                [true, false] => Reading::Z,
                [false, true] => Reading::Delays,
                _ => continue,
            };
            let powers = |reading| if reading == Reading::Z { "falling powers of z" } else { "powers of z^-1" };
            let other = if stable == Reading::Z { Reading::Delays } else { Reading::Z };
            let message = format!(
                "the lists have different lengths: read as {} the loop is stable{how}, read as {} it is not",
                powers(stable),
                powers(other)
            );
            let uneven = [&self.controller, plant]
                .into_iter()
                .find(|s| s.numerator.numbers.len() != s.denominator.numbers.len());
            let span = uneven.map(|system| system.numerator.span).unwrap_or_default();
            let help =
                format!("taken are {}; --reading z or --reading z^-1 says which is meant", powers(writing.reading));
            let warning = Diagnostic::warning(Code::DsvReadingWarning, message);
            return Ok(Some(warning.at(span, "shorter or longer than the denominator").help(help)));
        }
        Ok(None)
    }

    /// Whether the lists are so long that both readings have the same roots other than zero.
    fn is_same_read_in_both_ways(&self) -> bool {
        let systems = [Some(&self.controller), self.plant.as_ref()];
        let sizes = |system: &super::System| [system.numerator.numbers.len(), system.denominator.numbers.len()];
        let sums =
            systems.into_iter().flatten().map(sizes).fold([0, 0], |sum, size| [sum[0] + size[0], sum[1] + size[1]]);
        sums[0] == sums[1]
    }

    /// Where the leading coefficient of the controller's denominator is not 1: what DSVerifier stores, and the verdict on that.
    ///
    /// Cost: one verdict.
    ///
    /// # Errors
    /// Where the work was stopped.
    pub fn storing_note(&self, writing: &Writing, budget: &Budget) -> Result<Option<String>, Error> {
        let list = &self.controller.denominator;
        let leading = &list.numbers[list.leading_zeros()];
        if leading.value == Rational::ONE || self.implementation.is_none() || self.plant.is_none() {
            return Ok(None);
        }
        let stored = self.stored(writing.rounding).map_err(Error::from);
        let then = match stored.and_then(|stored| Ok((stored.verdict(writing, budget)?, stored))) {
            Ok((verdict, stored)) => {
                let value = &stored.controller.denominator.numbers[list.leading_zeros()].value;
                let is = if verdict.verdict == Verdict::Stable { "stable" } else { "not stable" };
                format!("DSVerifier stores it as {value} and divides by it at each sample: so stored, the loop is {is}")
            }
            Err(stopped @ Error::Stopped(_)) => return Err(stopped),
            Err(error) => format!("DSVerifier does not store it so: {}", first_line(&error)),
        };
        let text = &leading.text;
        Ok(Some(format!(
            "all coefficients are divided by the leading one of the denominator, {text}, before they are rounded; {then} (jurist import --stored)"
        )))
    }
}

fn first_line(error: &Error) -> String {
    let diagnostics: Option<&Diagnostics> = match error {
        Error::Refused(diagnostics) => Some(diagnostics),
        _ => None,
    };
    match diagnostics.and_then(|d| d.diagnostics().first()) {
        Some(first) => first.message.clone(),
        None => error.to_string(),
    }
}
