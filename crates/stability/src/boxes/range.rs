//! Between which numbers the values of a polynomial over a box lie.

use super::polynomial::Bundle;
use super::tensor::{common_factor, expand};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;

/// Two numbers between which the values of a polynomial over a closed box lie, which has a side for each variable: its least and its greatest Bernstein
/// coefficient ([ZettlerGarloff1998](jurist_algebra::bibliography#zettlergarloff1998)). They are exact where both stand at corners, as over small boxes.
///
/// Cost: as many coefficients as a dense polynomial of the same degrees has.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_stability::boxes::range_over;
/// let number = |n: i64| Rational::from(n);
/// let [x, y] = [0, 1].map(MultiPoly::variable);
/// let sides = [[number(-1), number(2)], [number(3), number(5)]];
/// assert_eq!(range_over(&x.times(&y), &sides), [number(-5), number(10)]);
/// // The square from 0 to 4 has the coefficients 1, -2, 4.
/// assert_eq!(range_over(&x.times(&x), &sides), [number(-2), number(4)]);
/// ```
pub fn range_over(p: &MultiPoly, sides: &[[Rational; 2]]) -> [Rational; 2] {
    let bundle = Bundle::new(&[p], sides.len());
    let all = expand(&bundle, sides);
    let factor = Rational::from(common_factor(&bundle, sides));
    let ends = [all.iter().min(), all.iter().max()].map(|end| end.cloned().unwrap_or_default());
    ends.map(|end| Rational::from(end).checked_div(&factor).expect("the factor is positive"))
}
