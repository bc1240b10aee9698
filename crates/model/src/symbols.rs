//! Numbers and functions that are not rational, as further variables of the polynomials: exponentials, tangents, roots.
//!
//! A sampled loop with a block behind a hold is rational in the parameters and in finitely many such symbols, each with a
//! definition from which its value can be enclosed. Symbols that are powers or multiple angles of one another are expressed
//! by one of them, so that identities like `exp(-2*T) = exp(-T)^2` and `cos^2 + sin^2 = 1` hold by themselves.

mod approximate;
mod circular;
mod duty;
mod flows;
mod identity;
mod merge;

pub use approximate::value_approximate;
pub use flows::{beside, quotient_at};
pub use jurist_algebra::symbols::Definition;

use super::text::Function;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// What a symbol stands for. Arguments are rational functions of the kept names and of earlier symbols.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Meaning {
    /// A number, once the kept names have values.
    Constant(Definition),
    /// `exp(-x s)` of a dead time, a function of the polynomial's own variable.
    Delay(RationalFunction),
    /// An entry of the exponential of a matrix that stays whole: where only numbers are asked for.
    Flow {
        /// The number of the matrix.
        of: usize,
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
    /// A function of other symbols, beside which it stays whole.
    Value(RationalFunction),
}

/// A symbol: a variable of the polynomials after the kept names.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Symbol {
    /// What it is called in formulas.
    pub name: String,
    /// What it stands for.
    pub meaning: Meaning,
    /// Whether it depends on a kept name.
    pub is_moving: bool,
}

impl Symbol {
    /// What it stands for; `None` of a dead time, and of what stays whole.
    pub fn definition(&self) -> Option<&Definition> {
        match &self.meaning {
            Meaning::Constant(definition) => Some(definition),
            Meaning::Delay(_) | Meaning::Flow { .. } | Meaning::Value(_) => None,
        }
    }

    /// Whether it stands for a dead time.
    pub fn is_delay(&self) -> bool {
        matches!(self.meaning, Meaning::Delay(_))
    }
}

/// The symbols of an evaluated model. Variables `0, 1, ..` are the kept names, then come the symbols.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_model::{BlockBuilder, Model, ParameterBuilder, Time};
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("plant", "K*(r - y)", "y").transfer("1/(s + 1)").held("1/10", "0"))
///     .build()?;
/// let evaluated = model.evaluate(&["K".into()], &[], &Budget::unlimited()).unwrap();
/// assert_eq!(evaluated.symbols.definitions(), [("X1".to_owned(), "exp(-1/10)".to_owned())]);
/// // z - X1 + K (1 - X1)
/// let p = &evaluated.polynomial;
/// assert_eq!(p.coefficients[0].display(&p.variables).to_string(), "-K*X1 + K - X1");
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Symbols {
    kept: Vec<String>,
    table: Vec<Symbol>,
    /// Polynomials in the symbols that have no zero, whatever the symbols' arguments are.
    nonzero: Vec<MultiPoly>,
    /// The modes of the blocks behind holds: monic polynomials without the leading coefficient.
    modes: Vec<Vec<Rational>>,
    /// Whether a function or `pi` is written in the model, beside what holds and rules bring.
    is_written: bool,
    /// Whether a prewarped rule brings a tangent.
    is_prewarped: bool,
    /// Values of the kept names near which dead times are divided into whole samples and a rest.
    near: Vec<Rational>,
    /// Dead times in samples that depend on kept names.
    samples: Vec<RationalFunction>,
    /// Whether exponentials of matrices stay whole.
    keeps_flows: bool,
    /// Whether long entries of a product of samples become symbols also where a kept name is in them.
    shortens_names: bool,
    /// The matrices of these, times time.
    flows: Vec<RationalMatrix>,
}

impl Symbols {
    /// No symbols beside these kept names.
    pub(crate) fn new(kept: &[String]) -> Symbols {
        Symbols { kept: kept.to_vec(), ..Symbols::default() }
    }

    /// The same where dead times are divided near these values of the kept names.
    pub(crate) fn near(self, near: &[Rational]) -> Symbols {
        Symbols { near: near.to_vec(), ..self }
    }

    /// Without symbols, where none is needed.
    pub(crate) fn cleared(&self) -> Symbols {
        Symbols { table: Vec::new(), nonzero: Vec::new(), ..self.clone() }
    }

    /// A function of the kept names near the values that are known.
    pub(crate) fn near_value(&self, f: &RationalFunction) -> Option<Rational> {
        let known = f.variables().last().is_none_or(|last| *last < self.near.len());
        let value = |f: RationalFunction, (i, x): (usize, &Rational)| f.substitute(i, x);
        known.then(|| self.near.iter().enumerate().try_fold(f.clone(), value)?.as_constant()).flatten()
    }

    /// A dead time in samples that depends on kept names.
    pub(crate) fn note_samples(&mut self, ratio: &RationalFunction) {
        if !self.samples.contains(ratio) {
            self.samples.push(ratio.clone());
        }
    }

    /// Dead times in samples that depend on kept names: from one whole number to the next the loop has another order.
    pub fn varying_samples(&self) -> &[RationalFunction] {
        &self.samples
    }

    /// Whether there are none: everything is rational in the kept names.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// How many kept names there are: the number of the first symbol's variable.
    pub fn first(&self) -> usize {
        self.kept.len()
    }

    /// The symbols, each after those it is defined by.
    pub fn iter(&self) -> impl Iterator<Item = &Symbol> {
        self.table.iter()
    }

    /// Whether a symbol depends on a kept name: then the question has its parameter inside a function.
    pub fn is_moving(&self) -> bool {
        self.table.iter().any(|s| s.is_moving)
    }

    /// The variables of the symbols that depend on a kept name.
    pub fn moving(&self) -> impl Iterator<Item = usize> {
        (self.first()..).zip(&self.table).filter(|(_, s)| s.is_moving).map(|(i, _)| i)
    }

    /// Whether there is a square root of what depends on a kept name: the loop is undefined where that is negative, also where the
    /// root itself cancels.
    pub(crate) fn has_moving_root(&self) -> bool {
        self.table.iter().any(|s| s.is_moving && matches!(s.definition(), Some(Definition::Root(_))))
    }

    /// The names of all variables: kept names, then symbols.
    pub fn variables(&self) -> Vec<String> {
        self.kept.iter().cloned().chain(self.table.iter().map(|s| s.name.clone())).collect()
    }

    /// Names and definitions, as text.
    pub fn definitions(&self) -> Vec<(String, String)> {
        let variables = self.variables();
        self.table.iter().map(|s| (s.name.clone(), s.meaning.text(&variables))).collect()
    }

    /// The symbols where all that is kept has been replaced by functions of one name; `images` are those of all variables. `None` where
    /// an argument divides by zero then.
    pub fn along(&self, name: &str, images: &[RationalFunction]) -> Option<Symbols> {
        let placed = |f: &RationalFunction| f.compose(images);
        let table = self.table.iter().map(|s| Some(Symbol { meaning: s.meaning.try_map(placed)?, ..s.clone() }));
        let polynomial = |p: &MultiPoly| Some(RationalFunction::from(p.clone()).compose(images)?.numerator().clone());
        Some(Symbols {
            kept: vec![name.to_owned()],
            table: table.collect::<Option<_>>()?,
            nonzero: self.nonzero.iter().map(polynomial).collect::<Option<_>>()?,
            near: Vec::new(),
            samples: self.samples.iter().map(placed).collect::<Option<_>>()?,
            ..self.clone()
        })
    }

    /// The polynomials in kept names and symbols that are known to have no zero.
    pub(crate) fn nonzero(&self) -> &[MultiPoly] {
        &self.nonzero
    }

    /// The modes of the blocks behind holds: the factors of their characteristic polynomials, monic and without the leading
    /// coefficient, from the constant term up.
    pub fn modes(&self) -> &[Vec<Rational>] {
        &self.modes
    }

    /// Whether holds and rules bring constants that are not rational, be it that they cancel in the end.
    pub fn are_brought(&self) -> bool {
        self.is_prewarped || self.modes.iter().flatten().any(|c| !c.is_zero())
    }

    /// Whether a function or `pi` is written in the model, beside what holds and rules bring.
    pub fn is_written(&self) -> bool {
        self.is_written
    }

    /// Notes a factor of a held block's characteristic polynomial.
    pub(crate) fn note_mode(&mut self, monic: &[RationalFunction]) {
        let below = monic.split_last().map_or(&[][..], |(_, below)| below);
        let mode: Option<Vec<Rational>> = below.iter().map(RationalFunction::as_constant).collect();
        if let Some(mode) = mode.filter(|m| !m.is_empty() && !self.modes.contains(m)) {
            self.modes.push(mode);
        }
    }

    /// Whether a value depends on a kept name, be it by way of a symbol.
    pub(crate) fn moves(&self, f: &RationalFunction) -> bool {
        let moving = |i: usize| i < self.kept.len() || self.table[i - self.kept.len()].is_moving;
        f.variables().into_iter().any(moving)
    }

    /// The variable of a symbol, the same each time.
    fn intern(&mut self, meaning: impl Into<Meaning>) -> RationalFunction {
        let meaning = meaning.into();
        if let Some(i) = self.table.iter().position(|s| s.meaning == meaning) {
            return RationalFunction::variable(self.kept.len() + i);
        }
        let is_moving = meaning.arguments().into_iter().any(|f| self.moves(f));
        let letter = meaning.letter();
        let name = (1..)
            .map(|k| if letter == "pi" && k == 1 { letter.into() } else { format!("{letter}{k}") })
            .find(|name| !self.kept.contains(name) && self.table.iter().all(|s| s.name != *name))
            .unwrap_or_default();
        self.table.push(Symbol { name, meaning, is_moving });
        RationalFunction::variable(self.kept.len() + self.table.len() - 1)
    }

    /// The circle number.
    pub fn pi(&mut self) -> RationalFunction {
        self.is_written = true;
        self.intern(Definition::Pi)
    }

    /// `exp(-x s)` of a dead time other than zero.
    pub(crate) fn delay(&mut self, x: RationalFunction) -> RationalFunction {
        self.intern(Meaning::Delay(x))
    }

    /// The variables that stand for dead time, and the dead times.
    pub fn delays(&self) -> Vec<(usize, RationalFunction)> {
        let delay = |(i, symbol): (usize, &Symbol)| match &symbol.meaning {
            Meaning::Delay(x) => Some((self.first() + i, x.clone())),
            _ => None,
        };
        self.table.iter().enumerate().filter_map(delay).collect()
    }

    /// `exp(x)`.
    pub(crate) fn exponential(&mut self, x: RationalFunction) -> RationalFunction {
        if x.is_zero() { RationalFunction::one() } else { self.intern(Definition::Exponential(x)) }
    }

    /// The square root; `None` of a negative number.
    fn root(&mut self, x: RationalFunction) -> Option<RationalFunction> {
        let Some(number) = x.as_constant() else { return Some(self.intern(Definition::Root(x))) };
        if let Some(root) = number.checked_sqrt() {
            return Some(root.into());
        }
        if number.is_negative() {
            return None;
        }
        // Of two numbers whose ratio is a square, one root is enough.
        for (i, symbol) in self.table.iter().enumerate() {
            if let Some(Definition::Root(other)) = symbol.definition()
                && let Some(ratio) = other.as_constant().and_then(|other| number.checked_div(&other))
                && let Some(factor) = ratio.checked_sqrt()
            {
                return Some(&RationalFunction::variable(self.kept.len() + i) * &RationalFunction::from(factor));
            }
        }
        Some(self.intern(Definition::Root(x)))
    }

    /// `tan(sqrt(w) t)/sqrt(w)` where `1 + w x^2` has no zero: for fixed `w`, `t`.
    pub(crate) fn tangent(&mut self, square: RationalFunction, time: RationalFunction) -> RationalFunction {
        if time.is_zero() {
            return RationalFunction::zero();
        }
        let x = self.intern(Definition::Tangent { square: square.clone(), time });
        let one = &RationalFunction::one() + &(&square * &(&x * &x));
        let polynomial = one.numerator().primitive_over_integers();
        if !self.nonzero.contains(&polynomial) {
            self.nonzero.push(polynomial);
        }
        x
    }

    /// A fundamental solution.
    pub(crate) fn fundamental(
        &mut self,
        polynomial: Vec<RationalFunction>,
        time: RationalFunction,
        index: usize,
    ) -> RationalFunction {
        self.intern(Definition::Fundamental { polynomial, time, index })
    }

    /// The value of a function; `None` where it has none.
    pub(crate) fn call(&mut self, function: Function, x: RationalFunction) -> Option<RationalFunction> {
        self.is_written = true;
        match function {
            Function::Sqrt => self.root(x),
            Function::Exp => Some(self.exponential(x)),
            Function::Sin | Function::Cos | Function::Tan => self.circular(function, x),
            // Functions of complex values are none of symbols.
            Function::Conj | Function::Re => Some(x),
            Function::Im => Some(RationalFunction::zero()),
        }
    }

    /// The tangent that a prewarped rule brings.
    pub(crate) fn tangent_of_a_rule(&mut self, x: RationalFunction) -> Option<RationalFunction> {
        self.is_prewarped = true;
        self.circular(Function::Tan, x)
    }
}

impl From<Definition> for Meaning {
    fn from(definition: Definition) -> Self {
        Meaning::Constant(definition)
    }
}

impl Meaning {
    /// The functions it is made of.
    pub fn arguments(&self) -> Vec<&RationalFunction> {
        match self {
            Meaning::Constant(definition) => definition.arguments(),
            Meaning::Delay(x) | Meaning::Value(x) => vec![x],
            Meaning::Flow { .. } => Vec::new(),
        }
    }

    /// The same with other arguments.
    fn try_map(&self, mut f: impl FnMut(&RationalFunction) -> Option<RationalFunction>) -> Option<Meaning> {
        Some(match self {
            Meaning::Constant(definition) => definition.try_map(f)?.into(),
            Meaning::Delay(x) => Meaning::Delay(f(x)?),
            Meaning::Value(x) => Meaning::Value(f(x)?),
            Meaning::Flow { .. } => self.clone(),
        })
    }

    fn letter(&self) -> &'static str {
        match self {
            Meaning::Constant(Definition::Pi) => "pi",
            Meaning::Constant(Definition::Algebraic(_)) => "a",
            Meaning::Constant(Definition::Root(_)) => "r",
            Meaning::Constant(Definition::Exponential(_)) => "X",
            Meaning::Constant(Definition::Tangent { .. }) => "t",
            Meaning::Constant(Definition::Enclosed(_) | Definition::Family(_)) => "c",
            Meaning::Constant(Definition::Fundamental { .. }) => "f",
            Meaning::Constant(Definition::Duty(_)) => "d",
            Meaning::Delay(_) => "z",
            Meaning::Flow { .. } => "e",
            Meaning::Value(_) => "v",
        }
    }

    /// What it stands for as a formula in these variables.
    pub fn text(&self, variables: &[String]) -> String {
        match self {
            Meaning::Constant(definition) => definition.text(variables),
            Meaning::Delay(x) if x.is_polynomial() && x.numerator().terms().len() == 1 => {
                format!("exp(-{}*s)", x.display(variables))
            }
            Meaning::Delay(x) => format!("exp(-({})*s)", x.display(variables)),
            Meaning::Flow { of, row, column } => format!("entry ({row}, {column}) of exponential {of}"),
            Meaning::Value(x) => x.display(variables).to_string(),
        }
    }
}
