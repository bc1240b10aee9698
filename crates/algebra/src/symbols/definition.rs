//! What a symbol stands for.

use super::{DutyRatio, FamilyValue};
use crate::ball::Ball;
use crate::number::{Enclosure, Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction, RealAlgebraic};
use crate::real::Transcendental;

/// What a symbol stands for. Arguments are rational functions of earlier symbols, numbered as in the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Definition {
    /// The circle number.
    Pi,
    /// A real algebraic number.
    Algebraic(RealAlgebraic),
    /// A real number that is known by enclosures alone: no identity shows that an expression with it is zero.
    Enclosed(EnclosedNumber),
    /// The square root that is not negative.
    Root(RationalFunction),
    /// `exp(x)`.
    Exponential(RationalFunction),
    /// `tan(sqrt(w) t)/sqrt(w)`; for negative `w` that is `tanh(sqrt(-w) t)/sqrt(-w)`. With `X = exp(-b t)` the solutions of
    /// `y'' + b y' + c y = 0`, `w = c - b^2/4`, at the time `2 t` are rational functions of it.
    Tangent {
        /// `w`.
        square: RationalFunction,
        /// `t`.
        time: RationalFunction,
    },
    /// The solution of the linear differential equation with this characteristic polynomial whose derivative of order `index`
    /// is 1 at 0 and whose other derivatives below the order of the equation are 0 there, at a time: entry `(0, index)` of
    /// `exp(companion * time)`.
    Fundamental {
        /// The monic polynomial's coefficients from the constant term up, the leading 1 last.
        polynomial: Vec<RationalFunction>,
        /// Which of the solutions.
        index: usize,
        /// The time.
        time: RationalFunction,
    },
    /// The duty ratio of a periodic orbit.
    Duty(Box<DutyRatio>),
    /// A coefficient of the characteristic polynomial of a matrix of functions. Its values are known, its form is not.
    Family(FamilyValue),
}

/// A real number that is known by enclosures alone, with the words for it.
///
/// Two of them are equal if the same object encloses both.
#[derive(Clone, Debug)]
pub struct EnclosedNumber {
    /// What the number is, in words.
    pub words: String,
    /// Its enclosures.
    pub value: Transcendental,
}

impl PartialEq for EnclosedNumber {
    fn eq(&self, other: &Self) -> bool {
        self.value.is_same(&other.value)
    }
}

impl EnclosedNumber {
    /// The number with that many bits.
    pub(super) fn at(&self, bits: u64) -> Ball {
        let (lo, hi) = self.value.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        Ball::between(&lo, &hi, bits)
    }
}

impl Definition {
    /// The exponential of a rational number.
    pub fn exponential(x: impl Into<Rational>) -> Definition {
        Definition::Exponential(x.into().into())
    }

    /// The square root of a rational number.
    pub fn root(x: impl Into<Rational>) -> Definition {
        Definition::Root(x.into().into())
    }

    /// The tangent of a rational number.
    pub fn tangent(x: impl Into<Rational>) -> Definition {
        Definition::Tangent { square: RationalFunction::one(), time: x.into().into() }
    }

    /// An algebraic number with that many bits.
    pub(super) fn enclosed(x: &RealAlgebraic, bits: u64) -> Ball {
        let (lo, hi) = x.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        Ball::between(&lo, &hi, bits)
    }

    /// The functions it is made of.
    pub fn arguments(&self) -> Vec<&RationalFunction> {
        match self {
            Definition::Pi | Definition::Algebraic(_) | Definition::Enclosed(_) => Vec::new(),
            Definition::Root(x) | Definition::Exponential(x) => vec![x],
            Definition::Tangent { square, time } => vec![square, time],
            Definition::Fundamental { polynomial, time, .. } => polynomial.iter().chain([time]).collect(),
            Definition::Duty(duty) => duty.arguments().collect(),
            Definition::Family(value) => value.at.iter().collect(),
        }
    }

    /// The same with other arguments; `None` where one of them has none.
    pub fn try_map(&self, mut f: impl FnMut(&RationalFunction) -> Option<RationalFunction>) -> Option<Definition> {
        Some(match self {
            Definition::Pi | Definition::Algebraic(_) | Definition::Enclosed(_) => self.clone(),
            Definition::Root(x) => Definition::Root(f(x)?),
            Definition::Exponential(x) => Definition::Exponential(f(x)?),
            Definition::Tangent { square, time } => Definition::Tangent { square: f(square)?, time: f(time)? },
            Definition::Fundamental { polynomial, index, time } => Definition::Fundamental {
                polynomial: polynomial.iter().map(&mut f).collect::<Option<_>>()?,
                index: *index,
                time: f(time)?,
            },
            Definition::Duty(duty) => Definition::Duty(Box::new(duty.with(f)?)),
            Definition::Family(value) => {
                let at = value.at.iter().map(f).collect::<Option<_>>()?;
                Definition::Family(FamilyValue { at, ..value.clone() })
            }
        })
    }

    /// The definition as a formula in these variables: `exp(-1/2)`.
    pub fn text(&self, variables: &[String]) -> String {
        let shown = |f: &RationalFunction| f.display(variables).to_string();
        match self {
            Definition::Pi => "pi".into(),
            Definition::Algebraic(x) => {
                let p = MultiPoly::from_univariate(x.polynomial(), 0);
                let p = p.display(&["x".to_owned()]).to_string();
                let (lo, hi) = x.refined_to_digits(12).enclosure();
                let decimal = Enclosure::new(lo, hi).decimal(12).unwrap_or_else(|| "a number".into());
                format!("the root {decimal} of {p}")
            }
            Definition::Enclosed(x) => x.words.clone(),
            Definition::Root(x) => format!("sqrt({})", shown(x)),
            Definition::Exponential(x) => format!("exp({})", shown(x)),
            Definition::Tangent { square, time } if square.is_one() => format!("tan({})", shown(time)),
            Definition::Tangent { square, time } => {
                let hyperbolic = square.as_constant().is_some_and(|w| w.is_negative());
                let (name, w) = if hyperbolic { ("tanh", -square) } else { ("tan", square.clone()) };
                match w.as_constant().and_then(|w| w.checked_sqrt()) {
                    Some(root) => {
                        let angle = shown(&(time * &RationalFunction::from(root.clone())));
                        format!("{name}({angle})/({root})")
                    }
                    None => format!("{name}(({})*sqrt({}))/sqrt({1})", shown(time), shown(&w)),
                }
            }
            Definition::Family(value) => {
                let at: Vec<String> = value.at.iter().map(shown).collect();
                format!("value {} of the closed loop's matrix at [{}]", value.index, at.join(", "))
            }
            Definition::Duty(duty) => format!("the duty ratio of the orbit with the mean {}", shown(&duty.mean)),
            Definition::Fundamental { polynomial, index, time } => {
                let list: Vec<String> = polynomial.iter().map(shown).collect();
                format!("fundamental solution {index} of [{}] at {}", list.join(", "), shown(time))
            }
        }
    }
}
