//! Why stability ends at a parameter value.

use std::fmt;

/// One reason. The order is the order in which several are named.
///
/// ```
/// use jurist_stability::Cause;
/// assert_eq!(Cause::ComplexPair.to_string(), "complex pair");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// A root at `z = 1`.
    RootAtOne,
    /// A root at `z = -1`.
    RootAtMinusOne,
    /// A pair of complex conjugate roots on the boundary.
    ComplexPair,
    /// One complex root on the boundary, without its conjugate: of a loop with complex coefficients.
    ComplexRoot,
    /// A root at `s = 0`.
    RootAtZero,
    /// The leading coefficient vanishes: a root leaves through infinity.
    DegreeLost,
    /// Infinitely many roots come up to the boundary: the difference operator of a neutral loop is no longer stable.
    Neutral,
    /// The loop is undefined there: an expression divides by zero, a block loses its order, or the loop is
    /// not well posed.
    Pole,
    /// The loop has no value beyond: the number under a square root is negative there. At the end itself it is zero.
    SquareRoot,
    /// The loop has no value beyond: the pulses of a modulator fill their period there, or have no length.
    Duty,
    /// The parameter's domain ends there.
    Domain,
    /// Nothing is known beyond: the end of what was decided, not a limit.
    Undecided,
}

impl Cause {
    /// Whether complex roots are on the boundary.
    pub fn is_of_complex_roots(self) -> bool {
        matches!(self, Cause::ComplexPair | Cause::ComplexRoot)
    }

    const ALL: [Cause; 12] = [
        Cause::RootAtOne,
        Cause::RootAtMinusOne,
        Cause::ComplexPair,
        Cause::ComplexRoot,
        Cause::RootAtZero,
        Cause::DegreeLost,
        Cause::Neutral,
        Cause::Pole,
        Cause::SquareRoot,
        Cause::Duty,
        Cause::Domain,
        Cause::Undecided,
    ];

    /// The cause of a name.
    ///
    /// ```
    /// use jurist_stability::Cause;
    /// assert_eq!((Cause::named("z=1"), Cause::named("K")), (Some(Cause::RootAtOne), None));
    /// ```
    pub fn named(name: &str) -> Option<Cause> {
        Cause::ALL.into_iter().find(|cause| cause.name() == name)
    }

    /// The name used in all output.
    pub fn name(self) -> &'static str {
        match self {
            Cause::RootAtOne => "z=1",
            Cause::RootAtMinusOne => "z=-1",
            Cause::ComplexPair => "complex pair",
            Cause::ComplexRoot => "complex root",
            Cause::RootAtZero => "s=0",
            Cause::DegreeLost => "infinity",
            Cause::Neutral => "neutral",
            Cause::Pole => "pole",
            Cause::SquareRoot => "square root",
            Cause::Duty => "duty",
            Cause::Domain => "domain",
            Cause::Undecided => "undecided",
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// All reasons that hold at once, e.g. `z=1+domain`.
///
/// ```
/// use jurist_stability::{Cause, Causes};
/// let mut causes = Causes::default();
/// causes.insert(Cause::Domain);
/// causes.insert(Cause::RootAtOne);
/// assert_eq!(causes.to_string(), "z=1+domain");
/// assert!(causes.contains(Cause::Domain));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct Causes(Vec<Cause>);

impl From<Cause> for Causes {
    fn from(cause: Cause) -> Causes {
        Causes(vec![cause])
    }
}

impl Causes {
    /// Adds a reason, once.
    pub fn insert(&mut self, cause: Cause) {
        if let Err(place) = self.0.binary_search(&cause) {
            self.0.insert(place, cause);
        }
    }

    /// Whether stability ends for a reason of the loop's, and not where the question or what is known ends.
    pub fn is_limit(&self) -> bool {
        self.0.iter().any(|c| !matches!(c, Cause::Domain | Cause::Undecided))
    }

    /// The reasons of a polynomial with each root of a complex loop and its conjugate, as reasons of the loop.
    pub fn of_complex_loop(&mut self) {
        if self.contains(Cause::ComplexPair) {
            self.remove(Cause::ComplexPair);
            self.insert(Cause::ComplexRoot);
        }
    }

    /// Takes a reason back.
    pub fn remove(&mut self, cause: Cause) {
        self.0.retain(|c| *c != cause);
    }

    /// Whether the reason holds.
    pub fn contains(&self, cause: Cause) -> bool {
        self.0.contains(&cause)
    }

    /// The reasons in their fixed order.
    pub fn iter(&self) -> impl Iterator<Item = Cause> {
        self.0.iter().copied()
    }
}

impl fmt::Display for Causes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, cause) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str("+")?;
            }
            f.write_str(cause.name())?;
        }
        Ok(())
    }
}
