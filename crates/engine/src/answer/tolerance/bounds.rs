//! What a decision about a box and the bracket of its factor say of each other.

use super::ExactFactor;
use crate::stability::boxes::{BoxDecision, LargestFactor, Side};
use jurist_algebra::number::Rational;

/// The decision about the box itself, where the bracket says more.
pub(super) fn agreed(decision: BoxDecision, factor: &LargestFactor, exact: Option<&ExactFactor>) -> BoxDecision {
    match decision {
        BoxDecision::Stable(_) => decision,
        // The exact factor is in the bracket around 1, and not above 1.
        BoxDecision::Undecided { .. }
            if exact.is_some_and(|exact| exact.value.compare_rational(&Rational::ONE).is_le()) =>
        {
            BoxDecision::NotStable { witness: None }
        }
        _ if factor.upper.as_ref().is_some_and(|upper| *upper <= Rational::ONE) => {
            let known = match decision {
                BoxDecision::NotStable { witness } => witness,
                _ => None,
            };
            BoxDecision::NotStable { witness: factor.witness.clone().or(known) }
        }
        _ => decision,
    }
}

/// The factor of a box that is not stable is 1 at most: where nothing nearer is known, the point that shows it bounds the factor.
pub(super) fn bounded_by(decision: &BoxDecision, mut factor: LargestFactor, sides: &[Side]) -> LargestFactor {
    if let BoxDecision::NotStable { witness: Some(witness) } = decision
        && factor.upper.is_none()
        && factor.lower < Rational::ONE
    {
        let share = |(side, x): (&Side, &Rational)| {
            let offset = x - side.nominal();
            offset.checked_div(&side.widths()[usize::from(offset.sign().is_gt())]).unwrap_or(Rational::ZERO)
        };
        let shares: Vec<Rational> = sides.iter().zip(&witness.point).map(share).collect();
        let growing = sides.iter().zip(&shares).filter(|(side, _)| side.grows());
        let upper = growing.map(|(_, share)| share.abs()).max().filter(|upper| *upper > factor.lower);
        if let Some(upper) = upper.filter(|upper| *upper <= Rational::ONE) {
            let towards = |(side, share): (&Side, &Rational)| match side.grows() {
                true => share.checked_div(&upper).unwrap_or(Rational::ZERO),
                false => share.clone(),
            };
            factor.direction = Some(sides.iter().zip(&shares).map(towards).collect());
            (factor.upper, factor.witness) = (Some(upper), Some(witness.clone()));
        }
    }
    factor
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::boxes::{Witness, ray};

    /// The place in a range that does not grow is no share of the factor, and the line goes through the point.
    #[test]
    fn a_point_bounds_the_factor_by_what_grows() {
        let q = |text: &str| text.parse::<Rational>().unwrap();
        let sides = [Side::scaled(q("10"), [q("4"), q("8")]), Side::fixed(q("1"), [q("1/2"), q("2")])];
        let point = vec![q("12"), q("2")];
        let decision = BoxDecision::NotStable { witness: Some(Witness::uncounted(point.clone())) };
        let found = bounded_by(&decision, LargestFactor::at_least(q("1/8"), &q("1/1000")), &sides);
        let upper = found.upper.expect("the point bounds it");
        assert_eq!(upper, q("1/4"));
        let (base, step) = ray(&sides, &found.direction.unwrap());
        let reached: Vec<Rational> = base.iter().zip(&step).map(|(b, s)| b + &(s * &upper)).collect();
        assert_eq!(reached, point);
    }
}
