//! What a model declares: its time, constants, parameters, and which names are taken.

use super::clock::Clock;
use super::expression::{Scope, UNIT, is_name, names_in, number};
use super::factor::PutIn;
use super::model::{matrix, sized};
use super::moving::Moving;
use super::multivariate::Fraction;
use super::number::{Q, shorten};
use super::tolerance::tolerance;
use super::toml::Toml;
use num_traits::Zero;
use std::collections::{BTreeMap, BTreeSet};

/// The declarations of a model.
pub(super) struct Declarations<'t> {
    pub discrete: bool,
    /// Each after those that it uses.
    constants: Vec<(&'t str, &'t Toml)>,
    /// Constants that are matrices.
    matrices: Vec<(&'t str, &'t Toml)>,
    parameters: Vec<&'t str>,
    taken: BTreeSet<&'t str>,
}

/// What a question makes of constants and parameters.
pub(super) struct Meaning<'q> {
    /// Numbers of variables: 0 is the loop's own, 1 the parameter in question.
    pub variables: BTreeMap<String, usize>,
    /// Values of the variables from 2 on.
    pub values: Vec<Q>,
    /// Constants that have another number: nothing else changes.
    replaced: BTreeMap<&'q str, &'q Q>,
    /// Whether it is about constants, too.
    pub changes_constants: bool,
    /// The variable that is the imaginary unit; it has no value.
    pub unit: usize,
    /// A factor at a cut of the loop, whose own names are the variables behind those of a box.
    pub factor: Option<PutIn>,
}

impl<'t> Declarations<'t> {
    pub fn read(root: &'t Toml, clock: &Clock) -> Result<Self, String> {
        let discrete = match root.get("time").ok_or("the model has no 'time'")?.text()? {
            "discrete" => true,
            "continuous" => false,
            other => return Err(format!("unknown time '{}'", shorten(other))),
        };
        let is_matrix = |(_, value): &&(String, Toml)| matches!(value, Toml::List(_));
        let all = root.section("constants")?;
        let matrices = all.iter().filter(is_matrix).map(|(name, value)| (name.as_str(), value)).collect();
        let constants = in_order(all.iter().filter(|entry| !is_matrix(entry)))?;
        for (_, constant) in root.section("constants")? {
            if let Some(value) = constant.get("tolerance") {
                tolerance(value, clock)?;
                // A formula has none.
                number(value_of(constant), clock)?;
            }
        }
        let mut parameters = Vec::new();
        for (name, parameter) in root.section("parameters")? {
            parameters.push(name.as_str());
            domain(parameter, clock)?;
        }
        let mut declared = Declarations { discrete, constants, matrices, parameters, taken: BTreeSet::new() };
        declared.taken.extend([declared.variable(), "radius", "decay"]);
        let constants = declared.constants.iter().chain(&declared.matrices).map(|(name, _)| *name);
        let names: Vec<&str> = constants.chain(declared.parameters.iter().copied()).collect();
        declared.distinct(&names)?;
        for (_, parameter) in root.section("parameters")? {
            declared.formula(parameter, clock)?;
        }
        declared.taken.extend(names);
        Ok(declared)
    }

    /// Reads a nominal value, a number or a formula in constants and parameters. What it is does not matter here, since a certificate has
    /// all values.
    fn formula(&self, parameter: &Toml, clock: &Clock) -> Result<(), String> {
        let nominal = match parameter {
            Toml::Table(_) => parameter.get("nominal"),
            number => Some(number),
        };
        let Some(nominal) = nominal else { return Ok(()) };
        let used: BTreeSet<&str> = names_in(nominal.expression()?).into_iter().collect();
        let is_known =
            |name: &&str| self.parameters.contains(name) || self.constants.iter().any(|(constant, _)| constant == name);
        let variables: BTreeMap<String, usize> =
            used.into_iter().filter(is_known).zip(1..).map(|(name, i)| (name.to_owned(), i)).collect();
        let next = variables.len() + 1;
        let mut scope = Scope::new(variables, clock);
        scope.moving = Some(Moving::new(next, false));
        scope.scalar(nominal).map(|_| ())
    }

    /// The name of the loop's variable.
    pub fn variable(&self) -> &'static str {
        if self.discrete { "z" } else { "s" }
    }

    /// Whether a name is a parameter, or a constant given as a number.
    pub fn is_parameter(&self, name: &str, clock: &Clock) -> bool {
        let constant = self.constants.iter().find(|(constant, _)| *constant == name);
        self.parameters.contains(&name) || constant.is_some_and(|(_, value)| number(value, clock).is_ok())
    }

    pub fn is_taken(&self, name: &str) -> bool {
        self.taken.contains(name)
    }

    /// Refuses what is no name, what has another meaning, and what occurs twice.
    pub fn distinct(&self, names: &[&str]) -> Result<(), String> {
        let mut seen = BTreeSet::new();
        for name in names {
            if !is_name(name) {
                return Err(format!("'{}' is not a name", shorten(&name.escape_debug().to_string())));
            }
            if self.is_taken(name) || !seen.insert(*name) {
                return Err(format!("'{}' has two meanings, or one that is reserved", shorten(name)));
            }
        }
        Ok(())
    }

    /// The model as it is written, all parameters symbolic.
    pub fn as_written(&self) -> Meaning<'static> {
        let variables = self.parameters.iter().enumerate().map(|(i, name)| ((*name).to_owned(), i + 1)).collect();
        let unit = self.parameters.len() + 1;
        Meaning {
            variables,
            values: Vec::new(),
            replaced: BTreeMap::new(),
            changes_constants: false,
            unit,
            factor: None,
        }
    }

    /// The model with one name in question, or those of a box, and values for others: all parameters, and constants that are given
    /// as numbers. The names of a box are the variables behind those that have a value.
    pub fn asked<'q>(
        &self,
        kept: Option<&'q str>,
        boxed: &'q [String],
        values: &'q [(String, Q)],
        clock: &Clock,
    ) -> Result<Meaning<'q>, String> {
        let mut meaning = Meaning {
            variables: BTreeMap::new(),
            values: vec![Q::zero(), Q::zero()],
            replaced: BTreeMap::new(),
            changes_constants: false,
            unit: 0,
            factor: None,
        };
        let mut seen = BTreeSet::new();
        let names = kept.into_iter().map(|name| (name, None));
        let names = names.chain(values.iter().map(|(name, value)| (name.as_str(), Some(value))));
        for (name, value) in names.chain(boxed.iter().map(|name| (name.as_str(), None))) {
            if !seen.insert(name) {
                return Err(format!("'{}' has two values", shorten(name)));
            }
            if !self.parameters.contains(&name) {
                let Some((_, constant)) = self.constants.iter().find(|(constant, _)| *constant == name) else {
                    return Err(format!("the model has no parameter '{}'", shorten(name)));
                };
                number(constant, clock)?;
                meaning.changes_constants = true;
                if let Some(value) = value {
                    meaning.replaced.insert(name, value);
                    continue;
                }
            }
            let variable = match value {
                Some(value) => {
                    meaning.values.push(value.clone());
                    meaning.values.len() - 1
                }
                None if kept == Some(name) => 1,
                // All values are there by now.
                None => {
                    let unit = meaning.values.len();
                    unit + 1 + meaning.variables.values().filter(|v| **v > unit).count()
                }
            };
            meaning.variables.insert(name.to_owned(), variable);
        }
        // Before those of a box, as if it had a value.
        meaning.unit = meaning.values.len();
        meaning.values.push(Q::zero());
        match self.parameters.iter().find(|name| !seen.contains(*name)) {
            Some(name) => Err(format!("the parameter '{}' has no value", shorten(name))),
            None => Ok(meaning),
        }
    }

    /// The scope of expressions. All constants are evaluated: one without a value makes the model undefined, used or not.
    pub fn scope<'c>(&self, meaning: &Meaning<'_>, is_moving: bool, clock: &'c Clock) -> Result<Scope<'c>, String> {
        let mut scope = Scope::new(meaning.variables.clone(), clock);
        // Behind all others.
        let mut last = meaning.variables.values().copied().max().unwrap_or(1).max(meaning.unit);
        scope.unit = (!self.is_taken(UNIT)).then_some(meaning.unit);
        if let Some(factor) = &meaning.factor {
            last = last.max(factor.names.end - 1);
            // Where the name has another meaning it keeps that one.
            scope.unit = Some(meaning.unit);
        }
        scope.moving = is_moving.then(|| Moving::new(last + 1, !self.discrete));
        scope.factor = meaning.factor.clone().map(|own| own.with_dead_time(scope.moving.as_mut())).transpose()?;
        for (name, text) in self.constants.iter().filter(|(name, _)| !meaning.variables.contains_key(*name)) {
            let value = match meaning.replaced.get(name) {
                Some(value) => Fraction::number(value),
                None => scope.scalar(text)?,
            };
            scope.constants.insert((*name).to_owned(), value);
        }
        for (name, rows) in &self.matrices {
            let value = matrix(rows, &mut scope)?;
            let columns = value.first().map_or(0, Vec::len);
            sized(&value, value.len(), columns)?;
            scope.matrices.insert((*name).to_owned(), value);
        }
        Ok(scope)
    }
}

/// Reads the domain of a parameter, if it is a table.
fn domain(parameter: &Toml, clock: &Clock) -> Result<(), String> {
    if !matches!(parameter, Toml::Table(_)) {
        return Ok(());
    }
    let read = |key: &str| parameter.get(key).map(|value| number(value, clock)).transpose();
    parameter.get("tolerance").map(|value| tolerance(value, clock)).transpose()?;
    let (mut min, mut max) = (read("min")?, read("max")?);
    if let Some(closed) = parameter.get("closed") {
        if !matches!(closed, Toml::Boolean) {
            return Err("'closed' is not true or false".into());
        }
        if min.is_none() && max.is_none() {
            return Err("'closed' without 'min' and 'max'".into());
        }
    }
    if let Some(both) = parameter.get("domain") {
        if ["min", "max", "closed"].iter().any(|key| parameter.get(key).is_some()) {
            return Err("a domain is given twice".into());
        }
        let [low, high] = both.list()? else { return Err("a domain has not two ends".into()) };
        (min, max) = (Some(number(low, clock)?), Some(number(high, clock)?));
    }
    match (min, max) {
        (Some(min), Some(max)) if min >= max => Err("the domain of a parameter is empty".into()),
        _ => Ok(()),
    }
}

/// The value of a constant, which may stand in a table.
fn value_of(constant: &Toml) -> &Toml {
    constant.get("value").unwrap_or(constant)
}

/// The constants, each after those that it uses; depth first with a stack of its own, since chains may be long.
fn in_order<'t>(entries: impl Iterator<Item = &'t (String, Toml)>) -> Result<Vec<(&'t str, &'t Toml)>, String> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let entries: Vec<&(String, Toml)> = entries.collect();
    let index: BTreeMap<&str, usize> = entries.iter().enumerate().map(|(i, (name, _))| (name.as_str(), i)).collect();
    let uses = |value: &Toml| -> Result<Vec<usize>, String> {
        Ok(names_in(value.expression()?).into_iter().filter_map(|name| index.get(name).copied()).collect())
    };
    let uses = entries.iter().map(|(_, value)| uses(value_of(value))).collect::<Result<Vec<_>, _>>()?;
    let mut state = vec![State::New; entries.len()];
    let mut order = Vec::with_capacity(entries.len());
    for root in 0..entries.len() {
        let mut stack = if state[root] == State::New { vec![(root, 0)] } else { Vec::new() };
        while let Some((current, next)) = stack.pop() {
            state[current] = State::Open;
            let Some(&used) = uses[current].get(next) else {
                state[current] = State::Done;
                order.push((entries[current].0.as_str(), value_of(&entries[current].1)));
                continue;
            };
            stack.push((current, next + 1));
            match state[used] {
                State::New => stack.push((used, 0)),
                State::Open => return Err(format!("the constant '{}' uses itself", shorten(&entries[used].0))),
                State::Done => {}
            }
        }
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toml::read;
    use std::time::Duration;

    #[test]
    fn constants_come_after_those_they_use() {
        let order = |text: &str| -> Result<String, String> {
            Ok(in_order(read(text).unwrap().entries().iter())?.iter().map(|(name, _)| *name).collect())
        };
        assert_eq!(order("a = 'b + c'\nb = 'c'\nd = 'a'\nc = 2e5").unwrap(), "cbad");
        assert!(order("a = 'b'\nb = 'c'\nc = 'a'").is_err() && order("a = '0*a'").is_err());
        // A circle of exponents of ten is none.
        assert_eq!(order("e1 = '1e1*b'\nb = '1e1'").unwrap(), "be1");
    }

    #[test]
    fn a_constant_that_is_set_is_a_number_and_no_variable() {
        let (clock, root) =
            (Clock::new(Duration::MAX), read("time = 'discrete'\nconstants.c = '1/2'\nparameters.K = {}"));
        let root = root.unwrap();
        let declared = Declarations::read(&root, &clock).unwrap();
        let two = [("c".to_owned(), Q::from(num_bigint::BigInt::from(2)))];
        let meaning = declared.asked(Some("K"), &[], &two, &clock).unwrap();
        assert_eq!(meaning.variables, BTreeMap::from([("K".to_owned(), 1)]));
        assert_eq!(declared.scope(&meaning, false, &clock).unwrap().constants["c"].numerator.degree(1), 0);
        for wrong in [declared.asked(Some("c"), &[], &two, &clock), declared.asked(None, &[], &two, &clock)] {
            assert!(wrong.is_err());
        }
    }
}
