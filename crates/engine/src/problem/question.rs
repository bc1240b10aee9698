//! What is being asked of a model, step by step.

use super::presupposed::{positive_functions, trimmed};
use super::resolved::{Free, Problem};
use super::{Bound, DECAY, RADIUS, Region};
use crate::error::{Code, Diagnostic, Diagnostics, Error};
use crate::model::{Model, Nominal, Parameter};
use crate::stability::Range;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A question about a model in the making: values, domains, what is free, and the region.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::parse_number;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let drive = Model::drive();
/// let answer = drive.ask().set("T", parse_number("1e-4")?).free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
/// let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
/// assert_eq!(upper.value.decimal(12), "550.941166687");
/// # Ok::<(), jurist_algebra::number::ParseNumberError>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Question {
    model: Arc<Model>,
    set: BTreeMap<String, Rational>,
    /// Values of names that are free around them: formulas of nominal values follow these, too.
    around: BTreeMap<String, Rational>,
    domain: BTreeMap<String, Range>,
    free: Vec<String>,
    region: Option<Region>,
}

/// What can be asked: a model.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let model = Model::builder(Time::Discrete).parameter(ParameterBuilder::new("K").nominal("1"));
/// let (model, _) = model.characteristic("z^2 - z + K/2").build()?;
/// assert_eq!(model.ask().verdict(&Budget::unlimited())?.value().verdict.name(), "stable");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub trait Ask {
    /// Begins a question about this model: everything at its nominal value, plain stability.
    fn ask(&self) -> Question;
}

impl Ask for Model {
    fn ask(&self) -> Question {
        Question {
            model: Arc::new(self.clone()),
            set: BTreeMap::new(),
            around: BTreeMap::new(),
            domain: BTreeMap::new(),
            free: Vec::new(),
            region: None,
        }
    }
}

/// Where the model has a meaning.
const MEANT: &str = "the sample time of a hold is positive, the duty ratio of a modulator between 0 and 1, and the frequency of \
    'prewarp' below half the sampling rate";

impl Question {
    /// Gives a parameter another value than its nominal one, or a constant another number.
    ///
    /// A parameter that is set keeps its part in the degree that counts and in the points of division by zero, which are
    /// those of the model with all parameters symbolic. A constant that is set has another number and nothing else changes:
    /// the answer is that of a model with this number in its text. Only a constant that is left [free](Question::free)
    /// becomes a parameter.
    pub fn set(mut self, name: impl Into<String>, value: impl Into<Rational>) -> Self {
        self.set.insert(name.into(), value.into());
        self
    }

    /// Gives several names their values.
    pub fn set_all<S: Into<String>>(mut self, values: impl IntoIterator<Item = (S, Rational)>) -> Self {
        self.set.extend(values.into_iter().map(|(name, value)| (name.into(), value)));
        self
    }

    /// The question without the value that was set for a name.
    pub fn without_value(mut self, name: &str) -> Self {
        self.set.remove(name);
        self
    }

    /// Takes back a value that was set for a name that is free around it.
    pub(crate) fn take_set(&mut self, name: &str) -> Option<Rational> {
        let value = self.set.remove(name)?;
        self.around.insert(name.to_owned(), value.clone());
        Some(value)
    }

    /// The value that a parameter has when it is left alone: its nominal value, for the values that are set where it is a formula.
    ///
    /// ```
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// use jurist_engine::problem::Ask;
    /// let (model, _) = Model::builder(Time::Discrete)
    ///     .constant("L", "6")
    ///     .parameter(ParameterBuilder::new("K").nominal("L/3"))
    ///     .characteristic("z - 1 + K/10")
    ///     .build()?;
    /// assert_eq!(model.ask().nominal("K")?, Some(2.into()));
    /// assert_eq!(model.ask().set("L", 9).nominal("K")?, Some(3.into()));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Refused`] where the formula has no rational value. A name that is no parameter has no nominal value.
    pub fn nominal(&self, name: &str) -> Result<Option<Rational>, Error> {
        let Some(i) = self.model.parameters().iter().position(|p| p.name == name) else { return Ok(None) };
        match self.nominal_values().swap_remove(i) {
            Nominal::Wrong(error) => {
                Err(Diagnostics::new(Some(self.model.source().clone()), vec![self.because(*error)]).into())
            }
            other => Ok(other.value().cloned()),
        }
    }

    /// The question with the value of every parameter that is neither set nor free set to its nominal value: formulas follow no more.
    ///
    /// # Errors
    /// As [`Question::nominal`].
    pub fn with_nominal_values(mut self) -> Result<Self, Error> {
        let open = |p: &&Parameter| !self.free.contains(&p.name) && !self.set.contains_key(&p.name);
        let names: Vec<String> = self.model.parameters().iter().filter(open).map(|p| p.name.clone()).collect();
        let values: Vec<_> = names.iter().map(|name| self.nominal(name)).collect::<Result<_, _>>()?;
        self.set.extend(names.into_iter().zip(values).filter_map(|(name, value)| Some((name, value?))));
        Ok(self)
    }

    /// The nominal values of the model's parameters, in their order.
    fn nominal_values(&self) -> Vec<Nominal> {
        self.model.nominal_values(&|name| self.set.get(name).or_else(|| self.around.get(name)).cloned())
    }

    /// What is wrong with a formula, with the values that are set and that it depends on.
    fn because(&self, error: Diagnostic) -> Diagnostic {
        if error.help.is_some() || self.set.is_empty() {
            return error;
        }
        let set: Vec<String> = self.set.iter().take(8).map(|(name, value)| format!("{name} = {value}")).collect();
        error.help(format!("here {}; set the parameter itself, too", set.join(", ")))
    }

    /// Replaces the domain of a parameter by an open one; of `radius` and `decay`, too.
    pub fn domain(mut self, name: impl Into<String>, range: Range) -> Self {
        self.domain.insert(name.into(), range);
        self
    }

    /// The same about all values of a constant where no domain is given for it: a tolerance says itself how far it goes.
    pub(crate) fn all_values_of(mut self, name: &str) -> Self {
        if self.model.constant(name).is_some() && !self.domain.contains_key(name) {
            self.domain.insert(name.to_owned(), Range::all());
        }
        self
    }

    /// Leaves a parameter or a constant free: it is what the answer is about, next to those already free. A constant that is
    /// alone has the values of its sign as its domain, unless it is given [another](Question::domain). `radius` (discrete time) and
    /// `decay` (continuous time) free the bound of the region.
    pub fn free(mut self, name: impl Into<String>) -> Self {
        self.free.push(name.into());
        self
    }

    /// Asks for all roots in another region than that of plain stability.
    pub fn within(mut self, region: Region) -> Self {
        self.region = Some(region);
        self
    }

    /// The model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The names that are free so far.
    pub fn free_names(&self) -> &[String] {
        &self.free
    }

    /// The values set so far.
    pub fn values_set(&self) -> &BTreeMap<String, Rational> {
        &self.set
    }

    /// The domains given so far.
    pub fn domains_set(&self) -> &BTreeMap<String, Range> {
        &self.domain
    }

    /// The question with every name known and every value in its place.
    ///
    /// Domains end where the model has no meaning beyond: where the sample time of a hold would not be positive, or the frequency of
    /// `prewarp` not below half the sampling rate.
    ///
    /// Cost: that of looking up each name, and of the expressions of sample times where there is a hold or `prewarp`.
    ///
    /// # Errors
    /// [`Error::Refused`] for names the model does not know or that cannot vary, values that are missing, a region that
    /// does not fit the kind of time, an empty domain, a name that is both free and set; all that apply. Then for times and
    /// frequencies that have no meaning.
    pub fn problem(self) -> Result<Arc<Problem>, Error> {
        let (free, region) = self.region_and_free()?;
        let is_unit = |region: &Region| matches!(region.bound(), Bound::Number(r) if r.is_one());
        if self.model.hyperperiod() > 1 && !is_unit(&region) {
            let error = Diagnostic::error(Code::Rate, "a radius is not asked of a loop with several rates");
            return Err(error.help("a settling time is, and means the same (--settling-time)").into());
        }
        let nominal = self.nominal_values();
        let set = self.resolve(&free, &nominal)?;
        let mut described = Vec::with_capacity(free.len() + 1);
        if region.is_free() {
            let name = region.bound_name();
            // No root is nearer to 0 than by a negative radius.
            let least = (name == RADIUS).then_some(Rational::ZERO);
            let domain = match self.domain.get(name) {
                Some(range) => Range { lower: range.lower.clone().max(least), upper: range.upper.clone() },
                None => Range::between(Some(Rational::ZERO), None),
            };
            described.push(Free::of(name, domain));
        }
        // Axes of maps have windows, and tolerances ranges of their own.
        let is_alone = free.len() == 1 && !region.is_free();
        for name in &free {
            let mut parameter = self.model.free(name)?;
            if parameter.nominal_formula.is_some()
                && let Some(i) = self.model.parameters().iter().position(|p| p.name == *name)
            {
                parameter.nominal = nominal[i].value().cloned();
            }
            let (domain, closed) = match self.domain.get(name) {
                Some(range) => (range.clone(), [false; 2]),
                None if is_alone && self.model.constant(name).is_some() => {
                    (of_its_sign(parameter.nominal.as_ref()), [false; 2])
                }
                None => {
                    let closed = [&parameter.min, &parameter.max].map(|end| parameter.closed && end.is_some());
                    (Range::between(parameter.min, parameter.max), closed)
                }
            };
            described.push(Free {
                name: name.clone(),
                unit: parameter.unit,
                nominal: parameter.nominal,
                domain,
                closed,
                is_duty: [false; 2],
            });
        }
        for one in &described {
            if one.domain.is_empty() {
                return Err(Diagnostic::error(Code::EmptyDomain, format!("the domain of '{}' is empty", one.name))
                    .help("the lower bound has to be below the upper one; both are excluded")
                    .into());
            }
        }
        let mut warnings = self.warnings(&free, &set);
        let positive = self.presuppose(&free, &set, &mut described, &mut warnings)?;
        Ok(Arc::new(Problem::new(self.model, set, described, region, warnings).with_positive(positive)))
    }

    /// Trims the domains to where holds and rules have a meaning; the functions of what is free that have to be positive there.
    fn presuppose(
        &self,
        kept: &[String],
        set: &[(String, Rational)],
        free: &mut [Free],
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Vec<RationalFunction>, Error> {
        let first = free.len() - kept.len();
        let sourced = |d: Diagnostic| Error::from(Diagnostics::new(Some(self.model.source().clone()), vec![d]));
        let (positive, duties) = positive_functions(&self.model, kept, set, first).map_err(sourced)?;
        for (i, one) in free.iter_mut().enumerate() {
            let Some((domain, has_others)) = trimmed(one, i, &positive).map_err(sourced)? else {
                let message = format!("nowhere in the domain of '{}' has the model a meaning", one.name);
                return Err(Diagnostic::error(Code::EmptyDomain, message).help(MEANT).into());
            };
            let is_cut = |asked: &Option<Rational>, left: &Option<Rational>| asked.is_some() && asked != left;
            if has_others || is_cut(&one.domain.lower, &domain.lower) || is_cut(&one.domain.upper, &domain.upper) {
                let message =
                    format!("the domain of '{}' is larger than the values for which the model has a meaning", one.name);
                let help = format!("{MEANT}; the answer is about these");
                warnings.push(Diagnostic::warning(Code::DomainWarning, message).help(help));
            }
            // Where the model has a meaning up to a value, that is no value of it.
            one.closed[0] &= one.domain.lower == domain.lower;
            one.closed[1] &= one.domain.upper == domain.upper;
            one.domain = domain;
            one.is_duty = [&one.domain.lower, &one.domain.upper].map(|end| {
                let is_zero = |f: &RationalFunction| match end {
                    Some(x) if f.variables() == [i] => f.substitute(i, x).is_some_and(|y| y.is_zero()),
                    _ => false,
                };
                duties.iter().any(is_zero)
            });
        }
        Ok(positive)
    }

    /// The region with its bound freed where `radius` or `decay` is asked for, and the other free names.
    fn region_and_free(&self) -> Result<(Vec<String>, Region), Error> {
        let time = self.model.time();
        let mut region = self.region.clone().unwrap_or_else(|| Region::of(time));
        region.fits(time)?;
        let mut free = self.free.clone();
        if let Some(i) = free.iter().position(|name| name == RADIUS || name == DECAY) {
            let name = free.remove(i);
            let freed = if name == RADIUS { Region::Disc(Bound::Free) } else { Region::HalfPlane(Bound::Free) };
            freed.fits(time)?;
            if self.region.is_some() {
                return Err(Diagnostic::error(Code::KeptAndSet, format!("'{name}' is the question and is also set"))
                    .help(format!("leave out either '--param {name}' or '--{name}'"))
                    .into());
            }
            region = freed;
        }
        Ok((free, region))
    }

    /// Values that lie outside their domains, those of the question before those of the model; and formulas that do not follow what is
    /// free.
    ///
    /// A nominal value outside the model's own domain is remarked upon when the model is read.
    fn warnings(&self, free: &[String], values: &[(String, Rational)]) -> Vec<Diagnostic> {
        let model = &self.model;
        let value = |name: &String| values.iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
        let parameters = model.parameters().iter().map(|p| &p.name);
        let names = parameters.chain(model.constants().iter().map(|c| &c.name)).filter(|name| !free.contains(name));
        let mut warnings = Vec::new();
        for name in names {
            let set = self.set.get(name).cloned();
            let constant = || model.constant(name).and_then(|c| c.number.clone());
            let follows =
                || value(name).filter(|v| model.parameter(name).is_some_and(|p| p.nominal.as_ref() != Some(v)));
            let outside = match self.domain.get(name) {
                Some(range) => value(name).or_else(constant).filter(|v| !range.contains(v)),
                None => set.or_else(follows).filter(|v| model.parameter(name).is_some_and(|p| !p.contains(v))),
            };
            if let Some(value) = outside {
                let message = format!("{name} = {value} is outside its domain");
                warnings.push(Diagnostic::warning(Code::OutsideDomainWarning, message));
            }
        }
        for parameter in
            model.parameters().iter().filter(|p| !free.contains(&p.name) && !self.set.contains_key(&p.name))
        {
            let needed = model.needed_by(parameter.nominal_formula.iter());
            let follows = free.iter().find(|name| needed.contains(name.as_str()));
            if let (Some(moving), Some(value)) = (follows, value(&parameter.name)) {
                let name = &parameter.name;
                let message = format!("{name} keeps its nominal value {value} while {moving} varies");
                let help = format!("for a '{name}' that follows, define it in [constants]");
                warnings.push(Diagnostic::warning(Code::NominalWarning, message).help(help));
            }
        }
        warnings
    }

    /// The value of every parameter that is not free, and of every constant that was set, in the order of the model.
    fn resolve(&self, free: &[String], nominal: &[Nominal]) -> Result<Vec<(String, Rational)>, Diagnostics> {
        let (model, set) = (&self.model, &self.set);
        let mut errors = Vec::new();
        for name in free.iter().chain(set.keys()) {
            errors.extend(model.not_free(name));
        }
        for (i, name) in free.iter().enumerate() {
            let shown = crate::model::shorten(name);
            if free[..i].contains(name) {
                errors.push(Diagnostic::error(Code::KeptTwice, format!("'{shown}' is asked for twice")));
            } else if set.contains_key(name) {
                let error = Diagnostic::error(Code::KeptAndSet, format!("'{shown}' is both kept symbolic and set"));
                errors.push(error.help("leave out one of the two"));
            }
        }
        let mut values = Vec::new();
        for (parameter, nominal) in model.parameters().iter().zip(nominal).filter(|(p, _)| !free.contains(&p.name)) {
            match nominal {
                Nominal::Value(value) => values.push((parameter.name.clone(), value.clone())),
                Nominal::Missing => errors.push(no_value(parameter)),
                Nominal::Needs(other) => {
                    let span = parameter.nominal_formula.as_ref().map_or(parameter.span, |formula| formula.span);
                    let mut error = no_value(parameter);
                    error = error.at(span, format!("needs the nominal value of '{}'", crate::model::shorten(other)));
                    errors.push(error);
                }
                Nominal::Wrong(error) => errors.push(self.because((**error).clone())),
            }
        }
        for constant in model.constants() {
            if let Some(value) = set.get(&constant.name) {
                values.push((constant.name.clone(), value.clone()));
            }
        }
        if errors.is_empty() { Ok(values) } else { Err(Diagnostics::new(Some(model.source().clone()), errors)) }
    }
}

/// The domain of a constant that is asked about without one: the values of its sign. An inductance or a time constant that is
/// negative is no answer, and `--domain` asks about it all the same.
fn of_its_sign(value: Option<&Rational>) -> Range {
    match value.map(|x| x.sign()) {
        Some(Ordering::Greater) => Range::between(Some(Rational::ZERO), None),
        Some(Ordering::Less) => Range::between(None, Some(Rational::ZERO)),
        Some(Ordering::Equal) | None => Range::all(),
    }
}

fn no_value(parameter: &Parameter) -> Diagnostic {
    let name = crate::model::shorten(&parameter.name);
    Diagnostic::error(Code::NoValue, format!("the parameter '{name}' has no value"))
        .at(parameter.span, "no value here")
        .help(format!("set it: --set {name}=..., or give it a nominal value in the model file"))
}
