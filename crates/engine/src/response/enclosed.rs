//! Real numbers that a computation with balls encloses.

use jurist_algebra::limits::{checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};
use std::fmt;

/// An enclosure computed with so many bits, if that is enough to divide and to take roots.
type Attempt = dyn Fn(u64) -> Option<Enclosure> + Send + Sync;

struct Enclosed {
    name: &'static str,
    attempt: Box<Attempt>,
}

impl fmt::Debug for Enclosed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl Enclosing for Enclosed {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        until_shown(bits + 64, |working| {
            checkpoint(working);
            (self.attempt)(working).filter(|x| x.upper() - x.lower() <= width)
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: self.name.to_owned(), details: Vec::new() }
    }
}

/// The number that the attempts enclose ever more narrowly, which is not zero.
pub(crate) fn enclosed(name: &'static str, attempt: impl Fn(u64) -> Option<Enclosure> + Send + Sync + 'static) -> Real {
    Transcendental::new(Enclosed { name, attempt: Box::new(attempt) }).into()
}

/// An enclosure of a number of width at most `2^-bits`.
pub(crate) fn within(x: &Real, bits: u64) -> Enclosure {
    let (lo, hi) = x.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
    Enclosure::new(lo, hi)
}

/// The greater of two numbers that enclosures do not tell apart.
pub(crate) fn greater(a: Real, b: Real) -> Real {
    enclosed("the greater of two", move |bits| {
        let [a, b] = [within(&a, bits), within(&b, bits)];
        Some(Enclosure::new(a.lower().max(b.lower()).clone(), a.upper().max(b.upper()).clone()))
    })
}
