//! How a controller is stored and run, as it is written: the section `[ship]` of a model file. What it means is found out when it is asked for.

use super::definition::Name;
use crate::error::Span;
use jurist_algebra::number::Rational;

/// The section `[ship]`. Nothing of it changes the loop.
///
/// ```
/// use jurist_model::error::Source;
/// use jurist_model::Model;
/// let text = "
///     time = 'discrete'
///     [loop]
///     [[block]]
///     name = 'controller'
///     input = '-y'
///     output = 'y'
///     transfer = '1/(2*z)'
///     [ship]
///     block = 'controller'
///     format = { bits = 16, fraction = 13 }
/// ";
/// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
/// let shipping = model.shipping().unwrap();
/// assert_eq!(shipping.block.as_ref().unwrap().name, "controller");
/// assert_eq!(shipping.format.as_ref().unwrap().bits, Some(16.into()));
/// # Ok::<(), jurist_model::error::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Shipping {
    /// Where it stands.
    pub span: Span,
    /// The block that is the controller.
    pub block: Option<Name>,
    /// The realisation.
    pub realisation: Option<Name>,
    /// How coefficients are stored.
    pub format: Option<NumberFormat>,
    /// How signals are stored.
    pub signal: Option<NumberFormat>,
    /// Bounds of inputs of the loop.
    pub inputs: Vec<(Name, Rational)>,
    /// Whether signals saturate; they wrap around else.
    pub saturate: bool,
    /// The step of the delta operator, and where it stands.
    pub delta: Option<(Rational, Span)>,
}

/// How numbers are stored, as it is written: a word, or a table of a fixed-point format.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct NumberFormat {
    /// Where it stands.
    pub span: Span,
    /// `Q2.13`, `float32`.
    pub word: Option<String>,
    /// All bits.
    pub bits: Option<Rational>,
    /// The bits before the point, the sign among them.
    pub integer: Option<Rational>,
    /// The bits behind the point.
    pub fraction: Option<Rational>,
    /// The rounding mode.
    pub round: Option<String>,
    /// What numbers are divided by before they are stored is 2 to this power; a number, or `auto`.
    pub scale: Option<String>,
}
