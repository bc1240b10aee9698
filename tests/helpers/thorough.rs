//! How much is tried: some of all cases by default, and all of them where `JURIST_THOROUGH` is set, as in CI.

/// Whether all cases are tried.
pub fn is_thorough() -> bool {
    std::env::var_os("JURIST_THOROUGH").is_some()
}

/// Whether the case with a number is tried: one of `every`, or each.
pub fn is_tried(number: usize, every: usize) -> bool {
    is_thorough() || number.is_multiple_of(every)
}

/// How many cases are tried.
pub fn count(few: usize, all: usize) -> usize {
    if is_thorough() { all } else { few }
}

/// Those of some cases that are tried: one of `every`, or each.
pub fn tried<T>(cases: impl IntoIterator<Item = T>, every: usize) -> impl Iterator<Item = T> {
    cases.into_iter().enumerate().filter(move |(number, _)| is_tried(*number, every)).map(|(_, case)| case)
}
