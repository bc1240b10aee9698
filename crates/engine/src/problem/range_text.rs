//! Ranges in words.

use crate::stability::Range;
use jurist_algebra::number::Rational;

/// `K > 0`, `0 < K <= 3`, `all`: a range of values of a name, its ends written by `number`; `closed` says which ends belong to it.
///
/// ```
/// use jurist_engine::problem::range_text;
/// use jurist_engine::stability::Range;
/// let range = Range::between(Some(0.into()), Some(3.into()));
/// assert_eq!(range_text("K", &range, [false, true], |value| value.to_string()), "0 < K <= 3");
/// ```
pub fn range_text(name: &str, range: &Range, closed: [bool; 2], number: impl Fn(&Rational) -> String) -> String {
    let [from, to] = closed;
    let less = |closed: bool| if closed { "<=" } else { "<" };
    match (&range.lower, &range.upper) {
        (None, None) => "all".to_owned(),
        (Some(l), None) => format!("{name} {} {}", if from { ">=" } else { ">" }, number(l)),
        (None, Some(u)) => format!("{name} {} {}", less(to), number(u)),
        (Some(l), Some(u)) => format!("{} {} {name} {} {}", number(l), less(from), less(to), number(u)),
    }
}
