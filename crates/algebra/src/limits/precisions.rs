//! Loops that double a number of bits until the numbers show what is asked.

use super::{Exhausted, Stop};

/// The number of bits that a decision begins with, and the one that it does not exceed.
///
/// Bits double from one attempt to the next, so that all attempts together cost about as much as the last one.
///
/// ```
/// use jurist_algebra::limits::{Exhausted, Precisions, Stop};
/// let precisions = Precisions::new(64, 300);
/// assert_eq!(precisions.bits().collect::<Vec<_>>(), [64, 128, 256]);
/// let shown = precisions.decide("an example", |bits| Ok::<_, Exhausted>((bits > 100).then_some(bits)));
/// assert_eq!(shown, Ok(128));
/// let hidden = precisions.decide("an example", |_| Ok::<Option<u64>, Exhausted>(None));
/// assert_eq!(hidden.unwrap_err().stop, Stop::Precision(300));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Precisions {
    /// Bits of the first attempt.
    pub first: u64,
    /// The most bits of an attempt, which messages name.
    pub last: u64,
}

impl Precisions {
    /// From `first` bits to at most `last`.
    ///
    /// # Panics
    /// When `first` is 0 or above `last`.
    pub const fn new(first: u64, last: u64) -> Precisions {
        assert!(0 < first && first <= last, "there is a first attempt");
        Precisions { first, last }
    }

    /// The bits of all attempts: `first`, twice as many, and so on up to `last`.
    pub fn bits(self) -> impl Iterator<Item = u64> {
        doubling(self.first).take_while(move |bits| *bits <= self.last)
    }

    /// The first value that an attempt finds; `None` where no attempt finds one.
    ///
    /// # Errors
    /// The error of an attempt, which ends the loop.
    pub fn find<T, E>(self, mut attempt: impl FnMut(u64) -> Result<Option<T>, E>) -> Result<Option<T>, E> {
        self.bits().find_map(|bits| attempt(bits).transpose()).transpose()
    }

    /// The first value that an attempt finds, for a step of this name.
    ///
    /// # Errors
    /// The error of an attempt, and [`Exhausted`] by [`Stop::Precision`] where no attempt finds a value.
    pub fn decide<T, E: From<Exhausted>>(
        self,
        step: &str,
        attempt: impl FnMut(u64) -> Result<Option<T>, E>,
    ) -> Result<T, E> {
        self.find(attempt)?.ok_or_else(|| self.exhausted(step).into())
    }

    /// No attempt decided the step.
    pub fn exhausted(self, step: impl Into<String>) -> Exhausted {
        Exhausted::new(Stop::Precision(self.last), step)
    }
}

/// `first`, twice as many, four times as many, and so on without end.
///
/// ```
/// use jurist_algebra::limits::doubling;
/// assert_eq!(doubling(48).take(3).collect::<Vec<_>>(), [48, 96, 192]);
/// ```
pub fn doubling(first: u64) -> impl Iterator<Item = u64> {
    std::iter::successors(Some(first), |bits| bits.checked_mul(2))
}

/// The first value that an attempt finds, with as many bits as that takes: for what shows in the end, as the order of two
/// numbers that differ does.
///
/// ```
/// use jurist_algebra::limits::until_shown;
/// assert_eq!(until_shown(8, |bits| (bits > 20).then_some(bits)), 32);
/// ```
pub fn until_shown<T>(first: u64, attempt: impl FnMut(u64) -> Option<T>) -> T {
    doubling(first).find_map(attempt).expect("it shows before bits are too many to count")
}

/// The same for attempts that a budget may end.
///
/// # Errors
/// The error of an attempt.
///
/// ```
/// use jurist_algebra::limits::{Budget, Exhausted, try_until_shown};
/// let budget = Budget::unlimited();
/// let shown = try_until_shown(8, |bits| {
///     budget.check()?;
///     Ok::<_, Exhausted>((bits > 20).then_some(bits))
/// });
/// assert_eq!(shown, Ok(32));
/// ```
pub fn try_until_shown<T, E>(first: u64, mut attempt: impl FnMut(u64) -> Result<Option<T>, E>) -> Result<T, E> {
    until_shown(first, |bits| attempt(bits).transpose())
}
