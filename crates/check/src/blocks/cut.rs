//! A factor at a signal, or at the input of a block: what is behind it is one more signal.

use super::rates::Rate;
use super::{Diagram, Row};
use crate::factor::Cut;
use crate::multivariate::Fraction;
use crate::number::{Q, shorten};
use crate::toml::Toml;
use num_traits::One;
use std::collections::BTreeSet;

/// What blocks are called. Of those without a name the first is `block`, unless a name is that, and each other one has its place in its name.
pub(super) fn called(blocks: &[Toml]) -> Result<Vec<String>, String> {
    let given: Vec<Option<&str>> = blocks.iter().map(|b| b.get("name").and_then(|name| name.text().ok())).collect();
    let first = given.iter().position(Option::is_none).filter(|_| !given.contains(&Some("block")));
    let name = |(i, given): (usize, &Option<&str>)| match given {
        Some(name) => (*name).to_owned(),
        None if first == Some(i) => "block".to_owned(),
        None => format!("block {}", i + 1),
    };
    let all: Vec<String> = given.iter().enumerate().map(name).collect();
    let mut seen = BTreeSet::new();
    match all.iter().find(|name| !seen.insert(name.as_str())) {
        Some(name) => Err(format!("two blocks are called '{}'", shorten(name))),
        None => Ok(all),
    }
}

impl Diagram<'_, '_> {
    /// Puts the signal behind the factor into the inputs of a block, where it belongs.
    pub(super) fn behind_factor(&mut self, called: &str, inputs: &mut [Row]) -> Result<(), String> {
        let (Some(behind), Some(factor)) = (self.cut, &self.scope.factor) else { return Ok(()) };
        match &factor.cut {
            Cut::Signal(name) => {
                let signal = self.signals.get(name);
                for input in inputs {
                    if let Some(c) = signal.and_then(|signal| input.remove(signal)) {
                        input.insert(behind, c);
                    }
                }
            }
            Cut::Input(name) if name == called => {
                let [input] = inputs else {
                    return Err(format!("the block '{}' has not one input to be cut at", shorten(name)));
                };
                let new = Row::from([(behind, Fraction::number(&Q::one()))]);
                self.cut_input = Some(std::mem::replace(input, new));
            }
            Cut::Input(_) | Cut::Parameter(_) | Cut::Variable => {}
        }
        Ok(())
    }

    /// The equation of the signal behind the factor. The first `driven` unknowns are signals of blocks, the first `signals` are signals.
    pub(super) fn factor(&mut self, driven: usize, signals: usize) -> Result<(), String> {
        let (Some(behind), Some(factor)) = (self.cut, self.scope.factor.clone()) else { return Ok(()) };
        let before = match &factor.cut {
            Cut::Signal(name) => {
                let signal = self.signals.get(name).filter(|signal| **signal < driven);
                let signal =
                    signal.ok_or_else(|| format!("no block has the output '{}' to be cut at", shorten(name)))?;
                Row::from([(*signal, Fraction::number(&Q::one()))])
            }
            Cut::Input(name) => {
                let input = self.cut_input.take();
                input.ok_or_else(|| format!("no block is called '{}' to be cut at", shorten(name)))?
            }
            Cut::Parameter(_) | Cut::Variable => return Ok(()),
        };
        let mut row = Row::from([(behind, Fraction::from(factor.value.scalar.clone()))]);
        let minus = Fraction::from(factor.value.numerator.clone()).negated();
        self.feed(&mut row, &minus, &before)?;
        self.rows.push(row);
        self.rates.note(Rate::ALWAYS, behind..behind + 1, self.rows.len(), self.unknowns - signals);
        Ok(())
    }
}
