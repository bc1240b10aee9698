//! The region in which all roots have to lie.

use crate::error::{Code, Diagnostic};
use crate::model::Time;
use crate::stability::Shape;
use jurist_algebra::number::Rational;

/// The name under which the radius of the disc is asked for as a parameter.
pub const RADIUS: &str = "radius";
/// The name under which the decay rate of the half plane is asked for as a parameter.
pub const DECAY: &str = "decay";

/// How far a region reaches: a number, or what the question is about.
///
/// ```
/// use jurist_engine::model::Time;
/// use jurist_engine::problem::{Bound, Region};
/// assert_eq!(*Region::of(Time::Discrete).bound(), Bound::Number(1.into()));
/// assert!(Region::Disc(Bound::Free).is_free());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bound {
    /// A number.
    Number(Rational),
    /// The bound is the free parameter.
    Free,
}

/// An open region of the complex plane in which all roots of a stable loop lie.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::{Ask, Region};
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let within = Region::disc("9/10".parse().unwrap())?; // |z| < 9/10
/// let answer = model.ask().free("K").within(within).stable_set(&Budget::unlimited())?;
/// let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
/// assert_eq!(upper.value.exact().unwrap().to_string(), "81/50");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Region {
    /// `|z| < radius`, discrete time; the unit disc has radius 1.
    Disc(Bound),
    /// `Re s < -decay`, continuous time; the left half plane has decay 0.
    HalfPlane(Bound),
}

impl Region {
    /// The region of plain stability: the unit disc, or the left half plane.
    pub fn of(time: Time) -> Region {
        match time {
            Time::Discrete => Region::Disc(Bound::Number(Rational::ONE)),
            Time::Continuous => Region::HalfPlane(Bound::Number(Rational::ZERO)),
        }
    }

    /// The disc `|z| < radius`.
    ///
    /// # Errors
    /// `E-region` unless the radius is positive.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// use jurist_engine::problem::Region;
    /// assert!(Region::disc(Rational::from(2)).is_ok());
    /// assert!(Region::disc(Rational::ZERO).is_err());
    /// ```
    pub fn disc(radius: Rational) -> Result<Region, Diagnostic> {
        if !radius.sign().is_gt() {
            return Err(Diagnostic::error(Code::Region, "the radius has to be positive"));
        }
        Ok(Region::Disc(Bound::Number(radius)))
    }

    /// The half plane `Re s < -decay`; a negative decay reaches into the right half plane.
    pub fn half_plane(decay: Rational) -> Region {
        Region::HalfPlane(Bound::Number(decay))
    }

    /// Where the roots have to lie once the bound is put into the polynomial: `D(r z)`, `D(s - S)`.
    pub fn shape(&self) -> Shape {
        match self {
            Region::Disc(_) => Shape::UnitDisc,
            Region::HalfPlane(_) => Shape::LeftHalfPlane,
        }
    }

    /// How far it reaches.
    pub fn bound(&self) -> &Bound {
        match self {
            Region::Disc(bound) | Region::HalfPlane(bound) => bound,
        }
    }

    /// The name of its bound: `radius` or `decay`.
    pub fn bound_name(&self) -> &'static str {
        match self {
            Region::Disc(_) => RADIUS,
            Region::HalfPlane(_) => DECAY,
        }
    }

    /// Whether the bound is the free parameter.
    pub fn is_free(&self) -> bool {
        *self.bound() == Bound::Free
    }

    /// The radius, where it is a number other than 1.
    pub fn radius(&self) -> Option<&Rational> {
        match self {
            Region::Disc(Bound::Number(r)) if !r.is_one() => Some(r),
            _ => None,
        }
    }

    /// The decay rate, where it is a number other than 0.
    pub fn decay(&self) -> Option<&Rational> {
        match self {
            Region::HalfPlane(Bound::Number(s)) if !s.is_zero() => Some(s),
            _ => None,
        }
    }

    /// Refuses a region that does not belong to the kind of time.
    pub(super) fn fits(&self, time: Time) -> Result<(), Diagnostic> {
        let free = self.is_free();
        match (self, time) {
            (Region::HalfPlane(_), Time::Discrete) if free => {
                Err(Diagnostic::error(Code::Region, "the decay rate of a discrete loop is not a question")
                    .help("ask for '--param radius'"))
            }
            (Region::Disc(_), Time::Continuous) if free => {
                Err(Diagnostic::error(Code::Region, "the radius of a continuous loop's region is not a question")
                    .help("ask for '--param decay'"))
            }
            (Region::HalfPlane(_), Time::Discrete) => Err(Diagnostic::error(
                Code::Region,
                "a decay rate applies to continuous time, and this loop is discrete",
            )
            .help("ask for '--radius R': all roots in |z| < R")),
            (Region::Disc(_), Time::Continuous) => {
                Err(Diagnostic::error(Code::Region, "a radius applies to discrete time, and this loop is continuous")
                    .help("ask for '--decay S': all roots in Re s < -S"))
            }
            _ => Ok(()),
        }
    }
}
