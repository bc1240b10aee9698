//! Number formats of processors, and rounding to them by exact arithmetic.

use jurist_algebra::number::{BinaryFormat, Enclosure, Integer, Rational};

/// How a number is rounded to an integer.
///
/// ```
/// use jurist_algebra::number::parse_number;
/// use jurist_ship::format::Rounding;
/// let half = parse_number("-5/2").unwrap();
/// let rounded: Vec<String> = Rounding::ALL.iter().map(|mode| format!("{} {}", mode.name(), mode.integer(&half))).collect();
/// assert_eq!(rounded, ["nearest -3", "even -2", "half-up -2", "floor -3", "ceil -2", "zero -2"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// To the nearest integer, of two away from zero.
    Nearest,
    /// To the nearest integer, of two the even one.
    Even,
    /// To the nearest integer, of two the greater one.
    HalfUp,
    /// Down.
    Floor,
    /// Up.
    Ceil,
    /// Towards zero.
    Zero,
}

impl Rounding {
    /// All modes.
    pub const ALL: [Rounding; 6] =
        [Rounding::Nearest, Rounding::Even, Rounding::HalfUp, Rounding::Floor, Rounding::Ceil, Rounding::Zero];

    /// The word of model files.
    pub fn name(self) -> &'static str {
        match self {
            Rounding::Nearest => "nearest",
            Rounding::Even => "even",
            Rounding::HalfUp => "half-up",
            Rounding::Floor => "floor",
            Rounding::Ceil => "ceil",
            Rounding::Zero => "zero",
        }
    }

    /// The mode in words.
    pub fn words(self) -> &'static str {
        match self {
            Rounding::Nearest => "to nearest, ties away from zero",
            Rounding::Even => "to nearest, ties to even",
            Rounding::HalfUp => "to nearest, ties up",
            Rounding::Floor => "down",
            Rounding::Ceil => "up",
            Rounding::Zero => "towards zero",
        }
    }

    /// The integer that a number is rounded to.
    ///
    /// Cost: one division.
    pub fn integer(self, value: &Rational) -> Integer {
        let half = Rational::new(1.into(), 2.into());
        match self {
            Rounding::Floor => value.floor(),
            Rounding::Ceil => value.ceil(),
            Rounding::Zero if value.is_negative() => value.ceil(),
            Rounding::Zero => value.floor(),
            Rounding::HalfUp => (value + &half).floor(),
            Rounding::Nearest if value.is_negative() => (value - &half).ceil(),
            Rounding::Nearest => (value + &half).floor(),
            Rounding::Even => {
                let up = (value + &half).floor();
                let is_tie = Rational::from(up.clone()) == value + &half;
                if is_tie && !up.is_even() { up - Integer::ONE } else { up }
            }
        }
    }

    /// Bounds of the error `rounded - value`, in units: the least and the greatest, as halves.
    pub fn error_in_halves(self) -> (i64, i64) {
        match self {
            Rounding::Nearest | Rounding::Even | Rounding::HalfUp => (-1, 1),
            Rounding::Floor => (-2, 0),
            Rounding::Ceil => (0, 2),
            Rounding::Zero => (-2, 2),
        }
    }
}

/// A format of fixed point: a number is an integer of two's complement times a power of two.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_ship::format::{Fixed, Rounding};
/// let q15 = Fixed { bits: 16, fraction: 15, scale: 0, rounding: Rounding::Nearest };
/// let tenth = Rational::new(1.into(), 10.into());
/// assert_eq!(q15.stored(&tenth), Some(3277.into()));
/// assert_eq!(q15.stored(&1.into()), None); // the greatest number is 1 - 2^-15
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed {
    /// All bits, the sign among them: 1 to 64.
    pub bits: u32,
    /// Bits behind the point; negative where the last bits before it are left out.
    pub fraction: i32,
    /// A number is divided by 2 to this power before it is stored.
    pub scale: i32,
    /// How numbers are rounded.
    pub rounding: Rounding,
}

/// Two to a power.
///
/// Cost: linear in the exponent.
///
/// ```
/// assert_eq!(jurist_ship::format::power_of_two(-3).to_string(), "1/8");
/// ```
pub fn power_of_two(exponent: i64) -> Rational {
    Rational::from(2).pow(exponent).expect("two is not zero")
}

impl Fixed {
    /// The value of the last bit.
    pub fn unit(&self) -> Rational {
        power_of_two(i64::from(self.scale) - i64::from(self.fraction))
    }

    /// The least and the greatest integer.
    pub fn integers(&self) -> (Integer, Integer) {
        let half = Integer::from(2).pow(u64::from(self.bits) - 1);
        (-&half, half - Integer::ONE)
    }

    /// The integer that a number is stored as; `None` where it is out of range.
    ///
    /// Cost: one division.
    pub fn stored(&self, value: &Rational) -> Option<Integer> {
        let (least, greatest) = self.integers();
        let rounded = self.rounded(value);
        (least <= rounded && rounded <= greatest).then_some(rounded)
    }

    /// The integer that a number is rounded to, whatever the range is.
    ///
    /// Cost: one division.
    pub fn rounded(&self, value: &Rational) -> Integer {
        let exponent = i64::from(self.fraction) - i64::from(self.scale);
        self.rounding.integer(&(value * &power_of_two(exponent)))
    }

    /// The number that an integer stands for.
    pub fn value(&self, stored: &Integer) -> Rational {
        Rational::from(stored.clone()) * self.unit()
    }
}

/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Fixed point.
    Fixed(Fixed),
    /// Binary floating point, to nearest with ties to even.
    Binary(BinaryFormat),
}

impl Format {
    /// The stored number that a number becomes; `None` where it is out of range.
    ///
    /// Cost: one division.
    pub fn nearest(&self, value: &Rational) -> Option<Rational> {
        match self {
            Format::Fixed(fixed) => Some(fixed.value(&fixed.stored(value)?)),
            Format::Binary(format) => format.nearest(value),
        }
    }

    /// The stored number that an enclosed number becomes: `Ok(None)` where it is out of range, an error where the enclosure does not tell.
    ///
    /// Cost: two divisions.
    ///
    /// # Errors
    /// [`Undecided`] where the ends of the enclosure are rounded to different numbers.
    pub fn nearest_of(&self, value: &Enclosure) -> Result<Option<Rational>, Undecided> {
        let low = self.nearest(value.lower());
        if value.lower() != value.upper() && low != self.nearest(value.upper()) {
            return Err(Undecided);
        }
        Ok(low)
    }

    /// How far a stored number can be from a number near `value` if it is rounded to nearest: half a unit in the last place, of a power of two
    /// that of the larger side.
    ///
    /// Cost: one division.
    pub fn half_unit(&self, value: &Enclosure) -> Rational {
        let half = power_of_two(-1);
        match self {
            Format::Fixed(fixed) => fixed.unit() * half,
            Format::Binary(format) => {
                let size = value.lower().abs().max(value.upper().abs());
                unit_of(*format, &size) * half
            }
        }
    }

    /// The format in words.
    pub fn words(&self) -> String {
        match self {
            Format::Binary(BinaryFormat::Single) => "float32".into(),
            Format::Binary(BinaryFormat::Double) => "float64".into(),
            Format::Fixed(Fixed { bits, fraction, scale, rounding }) => {
                let scale = if *scale == 0 { String::new() } else { format!(", scaled by 2^{scale}") };
                let before = i64::from(*bits) - 1 - i64::from(*fraction);
                let layout = match (before, fraction) {
                    (0.., 0..) => format!("sign, {before} before and {fraction} behind the point"),
                    _ => format!("last bit 2^{}", -i64::from(*fraction)),
                };
                format!("{bits} bits ({layout}{scale}), rounded {}", rounding.words())
            }
        }
    }
}

/// An enclosure does not tell what a number is rounded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Undecided;

/// The unit in the last place of numbers of this size.
fn unit_of(format: BinaryFormat, size: &Rational) -> Rational {
    let (precision, least) = match format {
        BinaryFormat::Single => (24, -149),
        BinaryFormat::Double => (53, -1074),
    };
    if size.is_zero() {
        return power_of_two(least);
    }
    let exponent = size.numerator().bit_length() as i64 - size.denominator().bit_length() as i64;
    let exponent = if *size < power_of_two(exponent) { exponent - 1 } else { exponent };
    power_of_two((exponent + 1 - precision).max(least))
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;
    use proptest::prelude::*;

    #[test]
    fn a_number_at_the_end_of_the_range_is_stored_and_the_next_one_is_not() {
        let fixed = Fixed { bits: 8, fraction: 4, scale: 1, rounding: Rounding::Floor };
        assert_eq!(fixed.unit(), parse_number("1/8").unwrap());
        assert_eq!(fixed.stored(&(-16).into()), Some((-128).into()));
        assert_eq!(fixed.stored(&parse_number("15.99").unwrap()), Some(127.into()));
        assert_eq!(fixed.stored(&16.into()), None);
        assert_eq!(fixed.stored(&parse_number("-16.0001").unwrap()), None);
    }

    #[test]
    fn the_unit_of_floats_doubles_at_powers_of_two() {
        for (size, unit) in [("1", -23), ("1.5", -23), ("2", -22), ("0.99", -24), ("1e-45", -149), ("0", -149)] {
            assert_eq!(unit_of(BinaryFormat::Single, &parse_number(size).unwrap()), power_of_two(unit), "{size}");
        }
    }

    #[test]
    fn an_enclosure_about_a_tie_tells_nothing() {
        let format = Format::Fixed(Fixed { bits: 8, fraction: 0, scale: 0, rounding: Rounding::Nearest });
        let about = |low: &str, high: &str| Enclosure::new(parse_number(low).unwrap(), parse_number(high).unwrap());
        assert_eq!(format.nearest_of(&about("0.4999", "0.5001")), Err(Undecided));
        assert_eq!(format.nearest_of(&about("0.4998", "0.4999")), Ok(Some(0.into())));
        assert_eq!(format.nearest_of(&about("200", "201")), Ok(None));
    }

    proptest! {
        #[test]
        fn errors_keep_to_their_bounds(numerator in -1000i64..1000, denominator in 1i64..60) {
            let value = Rational::new(numerator.into(), denominator.into());
            for mode in Rounding::ALL {
                let error = (Rational::from(mode.integer(&value)) - &value) * Rational::from(2);
                let (least, greatest) = mode.error_in_halves();
                prop_assert!(Rational::from(least) <= error && error <= Rational::from(greatest), "{mode:?}");
                let floor = (numerator.div_euclid(denominator), value.floor());
                prop_assert_eq!(Integer::from(floor.0), floor.1);
            }
        }
    }
}
