//! Real numbers that are known by what encloses them.

use super::Real;
use crate::limits::{checkpoint, until_shown};
use crate::number::{Enclosure, Integer, Rational};
use crate::poly::RealAlgebraic;
use crate::precisions::FIRST_PLACE;
use std::cmp::Ordering;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// What a number is enclosed by.
///
/// The number must not be rational: an implementor proves that first, or gives the rational number as a
/// [`RealAlgebraic`].
pub trait Enclosing: fmt::Debug + Send + Sync {
    /// An enclosure of width at most `2^-bits`. `known` is an earlier one, from which to go on. Long work counts
    /// itself by [`checkpoint`].
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure;

    /// Where the number comes from.
    fn origin(&self) -> Origin;
}

/// What a transcendental number is a root of, for documents.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Origin {
    /// The root of a polynomial over constants.
    Symbols {
        /// Each constant's name and definition.
        symbols: Vec<(String, String)>,
        /// The polynomial's coefficients, from the constant term up, as expressions in the constants.
        polynomial: Vec<String>,
    },
    /// The zero of a function.
    Function {
        /// Its name.
        function: String,
        /// What else there is to say, by name.
        details: Vec<(String, String)>,
    },
    /// A dead time `(theta + 2 pi k)/omega` at which a pair of roots is at `+-i omega`.
    Crossing {
        /// `omega^2`.
        omega_squared: RealAlgebraic,
        /// The angle in `[0, 2 pi)`.
        theta: Enclosure,
        /// The number of turns.
        turns: u64,
        /// Whether the pair leaves the left half plane there; `None` where it only touches the axis.
        leaves: Option<bool>,
    },
}

/// A real number that is not rational, given by enclosures of any width.
///
/// Its enclosure only ever gets narrower; a copy shares what encloses it.
#[derive(Clone, Debug)]
pub struct Transcendental {
    source: Arc<dyn Enclosing>,
    place: OnceLock<Enclosure>,
}

/// One over a number other than 0.
#[derive(Debug)]
pub(super) struct Reciprocal(pub Real);

impl Enclosing for Reciprocal {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let target = Rational::dyadic(&Integer::ONE, bits);
        let mut x = self.0.clone();
        loop {
            checkpoint(bits);
            let (lo, hi) = x.enclosure();
            if lo.sign() == hi.sign()
                && let (Some(above), Some(below)) = (lo.recip(), hi.recip())
                && &above - &below <= target
            {
                return Enclosure::new(below, above);
            }
            x = x.refined_further();
        }
    }

    fn origin(&self) -> Origin {
        match &self.0 {
            Real::Transcendental(x) => x.origin(),
            Real::Algebraic(_) => Origin::Function { function: "reciprocal".to_owned(), details: Vec::new() },
        }
    }
}

/// A number with the other sign.
#[derive(Debug)]
pub(super) struct Negative(pub Transcendental);

impl Enclosing for Negative {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let (lo, hi) = self.0.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        Enclosure::new(-hi, -lo)
    }

    fn origin(&self) -> Origin {
        self.0.origin()
    }
}

impl Transcendental {
    /// The number that `source` encloses.
    pub fn new(source: impl Enclosing + 'static) -> Self {
        Transcendental { source: Arc::new(source), place: OnceLock::new() }
    }

    /// The number that `source` encloses, where an enclosure is known already.
    pub fn within(source: impl Enclosing + 'static, place: Enclosure) -> Self {
        Transcendental { source: Arc::new(source), place: place.into() }
    }

    /// Where it comes from.
    pub fn origin(&self) -> Origin {
        self.source.origin()
    }

    /// Whether the same object encloses both.
    pub fn is_same(&self, other: &Transcendental) -> bool {
        Arc::ptr_eq(&self.source, &other.source)
    }

    fn place(&self) -> &Enclosure {
        self.place.get_or_init(|| self.source.enclose(FIRST_PLACE, None))
    }

    /// Lower and upper end.
    pub fn enclosure(&self) -> (Rational, Rational) {
        (self.place().lower().clone(), self.place().upper().clone())
    }

    /// With an enclosure of width at most `2^-bits`, within the one before.
    fn narrowed(&self, bits: u64) -> Transcendental {
        checkpoint(bits);
        let known = self.place();
        let width = Rational::dyadic(&Integer::ONE, bits);
        if known.upper() - known.lower() <= width {
            return self.clone();
        }
        let found = self.source.enclose(bits, Some(known));
        let lo = found.lower().max(known.lower()).clone();
        let hi = found.upper().min(known.upper()).clone();
        // Two enclosures of one number overlap.
        let place = if lo <= hi { Enclosure::new(lo, hi) } else { found };
        Transcendental { source: Arc::clone(&self.source), place: place.into() }
    }

    /// The same number with an enclosure of at most the given positive width.
    pub fn refined(&self, width: &Rational) -> Transcendental {
        if width.sign().is_le() {
            return self.clone();
        }
        let bits = width.denominator().bit_length() as i64 - width.numerator().bit_length() as i64 + 1;
        self.narrowed(u64::try_from(bits).unwrap_or(0))
    }

    /// The same number with an enclosure of relative width at most `10^-(digits + 2)`.
    pub fn refined_to_digits(&self, digits: usize) -> Transcendental {
        let mut x = self.clone();
        let least = until_shown(2 * FIRST_PLACE, |bits| {
            let (lo, hi) = x.enclosure();
            // The number is not 0, so that its sign shows in the end.
            if lo.sign() == hi.sign() && !lo.is_zero() && !hi.is_zero() {
                let least = lo.abs().min(hi.abs());
                if lo.abs().max(hi.abs()) <= &least + &least {
                    return Some(least);
                }
            }
            x = x.narrowed(bits);
            None
        });
        let tolerance = Rational::new(Integer::ONE, Integer::from(10).pow(digits as u64 + 2));
        x.refined(&(least * tolerance))
    }

    /// Comparison with a rational number. The two are equal only where an enclosure is that number alone: a zero of a function may be a
    /// rational number that nobody knew.
    pub fn compare_rational(&self, value: &Rational) -> Ordering {
        let mut x = self.clone();
        until_shown(2 * FIRST_PLACE, |bits| {
            let place = x.place();
            if value < place.lower() {
                return Some(Ordering::Greater);
            }
            if value > place.upper() {
                return Some(Ordering::Less);
            }
            if place.lower() == place.upper() {
                return Some(Ordering::Equal);
            }
            x = x.narrowed(bits);
            None
        })
    }
}
