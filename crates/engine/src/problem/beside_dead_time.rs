//! Constants that are not rational, beside dead time.

use super::delayed::refused;
use super::over_symbols::definition;
use crate::coverage::refusals::BESIDE_DEAD_TIME;
use crate::error::Error;
use crate::model;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::symbols::{MovingSymbols, Symbols};

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

/// The refusal of a dead time that is no rational number, and no rational function of the free name.
pub(super) fn refused_in_delay() -> Error {
    let help = "write each dead time as a rational number, such as 2.22144 for pi/sqrt(2); a tolerance around it, 'tolerance --tol NAME=0.01%', proves the number between";
    refused("a dead time is a function, or a constant, that is not rational", help)
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

    /// Whether a dead time depends on one, in variables that so many others come before in the polynomial.
    pub fn are_in(&self, delays: &[(usize, RationalFunction)], room: usize) -> bool {
        delays.iter().flat_map(|(_, time)| time.variables()).any(|variable| self.position(variable + room).is_some())
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

/// What the variables beside at most one free name (0) stand for: symbols, which may be functions of it, and delays behind them.
#[derive(Clone)]
pub(crate) struct Beside {
    pub symbols: MovingSymbols,
    /// The variables that stand for delays, and the dead times in the parameter and the symbols.
    pub delays: Vec<(usize, RationalFunction)>,
    /// The variables of the polynomial that come first here, then second, and so on.
    own: Vec<usize>,
}

impl Beside {
    /// Symbols alone.
    pub fn symbols(symbols: MovingSymbols) -> Beside {
        Beside { own: (1..=symbols.len()).collect(), symbols, delays: Vec::new() }
    }

    /// The symbols of a problem with so many free names, one at most. Where the bound of the region is free, the polynomial has a variable for it before the
    /// symbols.
    ///
    /// Cost: none but that of the names.
    ///
    /// # Errors
    /// [`Error::Undefined`] for a symbol without a value.
    pub fn of(symbols: &model::Symbols, free: usize) -> Result<Beside, Error> {
        let (delays, room) = (symbols.delays(), free.saturating_sub(symbols.first()));
        let is_delay = |v: &usize| delays.iter().any(|(variable, _)| variable == v);
        let all = symbols.first()..symbols.first() + symbols.iter().count();
        let own: Vec<usize> = all.filter(|v| !is_delay(v)).chain(delays.iter().map(|(v, _)| *v)).collect();
        let moved = |f: &RationalFunction| f.map_variables(|v| place(&own, v)).expect("variables stay apart");
        let table = symbols.iter().filter(|symbol| !symbol.is_delay());
        let table = table.map(|s| Ok((s.name.clone(), definition(s, |f| Some(moved(f)))?)));
        let symbols = MovingSymbols::new(table.collect::<Result<_, Error>>()?);
        let delays = delays.iter().map(|(variable, time)| (place(&own, *variable), moved(time))).collect();
        Ok(Beside { symbols, delays, own: own.iter().map(|v| v + room).collect() })
    }

    /// A function of the polynomial's variables.
    pub fn placed(&self, f: &RationalFunction) -> RationalFunction {
        f.map_variables(|v| place(&self.own, v)).expect("variables stay apart")
    }

    /// A polynomial in these variables, without delays.
    pub fn placed_polynomial(&self, p: &MultiPoly) -> MultiPoly {
        p.map_variables(|v| place(&self.own, v))
    }
}

fn place(own: &[usize], variable: usize) -> usize {
    own.iter().position(|v| *v == variable).map_or(variable, |i| i + 1)
}
