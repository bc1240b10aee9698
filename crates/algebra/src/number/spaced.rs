//! Numbers at equal distances.

use super::Rational;

/// So many numbers at equal distances from one to another, both included; exact. One alone is the first.
///
/// ```
/// use jurist_algebra::number::evenly_spaced;
/// let thirds: Vec<String> = evenly_spaced(&0.into(), &1.into(), 4).iter().map(ToString::to_string).collect();
/// assert_eq!(thirds, ["0", "1/3", "2/3", "1"]);
/// ```
pub fn evenly_spaced(first: &Rational, last: &Rational, count: usize) -> Vec<Rational> {
    let width = last - first;
    let steps = (count as u64).saturating_sub(1).max(1);
    (0..count as u64).map(|k| first + &(&width * &Rational::new(k.into(), steps.into()))).collect()
}
