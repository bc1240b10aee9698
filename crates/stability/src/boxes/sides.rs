//! Boxes of parameters that grow with a factor.

use jurist_algebra::number::{Rational, Sign};

/// How far one parameter may be from its nominal value: by a fixed width, and by one that grows with a factor.
///
/// ```
/// use jurist_stability::boxes::Side;
/// let resistance = Side::scaled(10.into(), [1.into(), 2.into()]); // 10 - 1 to 10 + 2
/// assert_eq!(resistance.at(&2.into()), [8.into(), 14.into()]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Side {
    nominal: Rational,
    /// Below and above the nominal value, not negative.
    widths: [Rational; 2],
    grows: bool,
}

impl Side {
    /// A tolerance that grows with the factor: so much below and so much above the nominal value.
    pub fn scaled(nominal: Rational, widths: [Rational; 2]) -> Side {
        Side { nominal, widths, grows: true }
    }

    /// A tolerance that stays as it is.
    pub fn fixed(nominal: Rational, widths: [Rational; 2]) -> Side {
        Side { nominal, widths, grows: false }
    }

    /// The range of values that are asked for whatever the factor is: a tolerance that grows is left out, one that stays grows in its place.
    pub fn without_tolerance(&self) -> Side {
        let widths = if self.grows { [Rational::ZERO, Rational::ZERO] } else { self.widths.clone() };
        Side::scaled(self.nominal.clone(), widths)
    }

    /// The tolerance that is the closed interval at a factor.
    pub fn grown(&self, factor: &Rational) -> Side {
        let [low, high] = self.at(factor);
        Side::scaled(self.nominal.clone(), [&self.nominal - &low, &high - &self.nominal])
    }

    /// The nominal value.
    pub fn nominal(&self) -> &Rational {
        &self.nominal
    }

    /// The widths below and above.
    pub fn widths(&self) -> &[Rational; 2] {
        &self.widths
    }

    /// Whether it is more than a point.
    pub fn has_width(&self) -> bool {
        self.widths.iter().any(|width| !width.is_zero())
    }

    /// Whether the widths grow with the factor.
    pub fn grows(&self) -> bool {
        self.grows
    }

    /// The closed interval at a factor.
    pub fn at(&self, factor: &Rational) -> [Rational; 2] {
        let [low, high] = &self.widths;
        if self.grows {
            [&self.nominal - &(low * factor), &self.nominal + &(high * factor)]
        } else {
            [&self.nominal - low, &self.nominal + high]
        }
    }

    /// The width in the direction of a number's sign.
    pub(super) fn width(&self, towards: Sign) -> &Rational {
        &self.widths[usize::from(towards.is_gt())]
    }
}

/// The box of all sides at a factor.
pub(super) fn at_factor(sides: &[Side], factor: &Rational) -> Vec<[Rational; 2]> {
    sides.iter().map(|side| side.at(factor)).collect()
}
