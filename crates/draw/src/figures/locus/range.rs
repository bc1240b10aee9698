//! Over which values a locus is drawn where nobody says.

use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::stability::StableSet;

/// Around every end of the stable set and the nominal value, a third more on both sides, within the domain; `None` where
/// there is neither an end nor a nominal value.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_draw::figures::locus_range;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited())?;
/// let (from, to) = locus_range(&answer).unwrap();
/// assert!(from.is_zero() || from.sign().is_gt());
/// assert!(to > 550.into());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub fn locus_range(answer: &Answer<StableSet>) -> Option<(Rational, Rational)> {
    let free = answer.problem().parameter();
    let mut values: Vec<Rational> = free.nominal.iter().cloned().collect();
    for end in answer.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
        let (lo, hi) = end.value.refined_to_digits(4).enclosure();
        values.extend([lo, hi]);
    }
    values.sort();
    let (low, high) = (values.first().cloned()?, values.last().cloned()?);
    let one = Rational::from(1);
    let third = Rational::new(1.into(), 3.into());
    let width = if low < high {
        &high - &low
    } else if high.is_zero() {
        one
    } else {
        high.abs()
    };
    let (mut from, mut to) = (&low - &(&width * &third), &high + &(&width * &third));
    // A locus of positive values begins where the loop is open.
    let zero = Rational::from(0);
    if from < zero && low >= zero {
        from = zero;
    }
    let domain = &free.domain;
    let inside = |edge: &Rational, direction: i64| edge + &width * Rational::new(direction.into(), 1000.into());
    if let Some(lower) = domain.lower.as_ref().filter(|l| from <= **l) {
        from = inside(lower, 1);
    }
    if let Some(upper) = domain.upper.as_ref().filter(|u| to >= **u) {
        to = inside(upper, -1);
    }
    Some((from, to))
}
