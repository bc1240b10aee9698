//! Constants that are not rational, beside dead time.

use crate::coverage::refusals::BESIDE_DEAD_TIME;
use crate::error::Error;
use crate::model;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::symbols::Symbols;

/// Constants are enclosed with so many bits after the point.
pub(super) const CONSTANT_BITS: u64 = 160;

/// The symbols of a loop that are no dead times, each with the variable of the polynomial that stands for it.
pub(super) struct Constants {
    variables: Vec<usize>,
    pub table: Symbols,
}

/// The refusal of other functions beside dead time.
pub(super) fn refused_beside() -> Error {
    BESIDE_DEAD_TIME.diagnostic(&[]).into()
}

impl Constants {
    /// Those of a loop whose polynomial has so many further variables before its symbols.
    ///
    /// # Errors
    /// `E-dead-time` where one depends on a free name.
    pub fn of(symbols: &model::Symbols, room: usize) -> Result<Constants, Error> {
        let mut constants = Constants { variables: Vec::new(), table: Symbols::new() };
        let delays: Vec<usize> = symbols.delays().into_iter().map(|(variable, _)| variable).collect();
        for (variable, symbol) in (symbols.first()..).zip(symbols.iter()).filter(|(v, _)| !delays.contains(v)) {
            let place =
                |f: &RationalFunction| match f.variables().iter().all(|v| constants.position(v + room).is_some()) {
                    true => f.map_variables(|v| constants.position(v + room).expect("a constant")),
                    false => None,
                };
            let placed = symbol.definition().and_then(|definition| definition.try_map(place));
            constants.table.push(&symbol.name, placed.ok_or_else(refused_beside)?);
            constants.variables.push(variable + room);
        }
        Ok(constants)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.variables.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.variables.len()
    }

    /// The number of the constant that a variable stands for.
    pub fn position(&self, variable: usize) -> Option<usize> {
        self.variables.iter().position(|own| *own == variable)
    }

    /// Bounds of all of them.
    pub fn bounds(&self) -> Vec<[Rational; 2]> {
        self.table.values(CONSTANT_BITS).iter().map(|value| [value.lower(), value.upper()]).collect()
    }

    /// The variable in the place of one, where constants come after so many names, and then the delays.
    pub fn place(&self, variable: usize, names: usize, delays: &[(usize, RationalFunction)]) -> usize {
        match (self.position(variable), delays.iter().position(|(own, _)| *own == variable)) {
            (Some(constant), _) => names + constant,
            (None, Some(delay)) => names + self.len() + delay,
            (None, None) => variable,
        }
    }
}
