//! Which gains are to be best, as it is written: the section `[tune]` of a model file. What it means is found out when it is asked for.

use super::definition::Name;
use crate::error::Span;
use jurist_algebra::number::Rational;

/// The section `[tune]`. Nothing of it changes the loop.
///
/// ```
/// use jurist_model::error::Source;
/// use jurist_model::Model;
/// let text = "
///     time = 'continuous'
///     parameters.K = 1
///     loop.characteristic = 's^3 + 3*s^2 + 2*s + K'
///     [tune]
///     free = 'K'
///     bounds = { K = [0, 5] }
///     objective = 'max decay'
/// ";
/// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
/// let tuning = model.tuning().unwrap();
/// assert_eq!((tuning.free[0].name.as_str(), tuning.objective.as_ref().unwrap().name.as_str()), ("K", "max decay"));
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Tuning {
    /// Where it stands.
    pub span: Span,
    /// The gains that are free.
    pub free: Vec<Name>,
    /// Their bounds, both included.
    pub bounds: Vec<(Name, [Rational; 2])>,
    /// What is to be best.
    pub objective: Option<Name>,
    /// How narrow a bracket is to be, as a share.
    pub gap: Option<Rational>,
    /// What may be given up for gains of few digits: a share, or per cent.
    pub loss: Option<Name>,
    /// Names of the plant with ranges, both ends included: gains are to be good for all values in them.
    pub for_all: Vec<(Name, [Rational; 2])>,
    /// Whether gains are to be good for all values within the tolerances of the model.
    pub robust: bool,
}
