//! How far it is from the nominal value of a parameter to an end of stability.

use super::real;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal};
use jurist_algebra::real::Real;

/// The way from nominal to an end, as a factor and in decibels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Margin {
    /// `end / nominal`: exact (`p/q`) where the end is rational, else a correctly rounded decimal.
    pub factor: String,
    /// `20 log10(end / nominal)`, correctly rounded; `None` for an end at 0.
    pub decibels: Option<String>,
}

/// Decibels are a number in JSON, so more digits than a double has would be lost.
const DECIBEL_DIGITS: usize = 17;

/// The margin of an end; `None` where nominal is 0 or absent, or the end lies beyond 0, where no
/// positive factor leads.
pub fn margin(end: &Real, nominal: Option<&Rational>, digits: usize) -> Option<Margin> {
    let nominal = nominal.filter(|n| !n.is_zero())?;
    if end.sign().is_eq() {
        return Some(Margin { factor: "0".into(), decibels: None });
    }
    if end.sign() != nominal.sign() {
        return None;
    }
    let factor = match end.exact() {
        Some(exact) => (exact / nominal).to_string(),
        None => irrational_factor(end, nominal, digits),
    };
    let decibels = real::enclosed(digits.min(DECIBEL_DIGITS), |bits| {
        let narrow = end.refined_to_digits(bits as usize / 3 + 4);
        // Long rationals would make the logarithm slow; rounding outwards keeps it certain.
        let ratio = ratio(&narrow, nominal).rounded(2 * bits + 64);
        let twenty = Enclosure::from_rational(Rational::from(20));
        let ten = Enclosure::from_rational(Rational::from(10)).ln(bits)?;
        ratio.ln(bits)?.mul(&twenty, bits).div(&ten, bits)
    });
    Some(Margin { factor, decibels })
}

/// The quotient of an end and a nominal value of the same sign.
fn ratio(end: &Real, nominal: &Rational) -> Enclosure {
    let (lo, hi) = end.enclosure();
    let (a, b) = (lo / nominal, hi / nominal);
    if a <= b { Enclosure::new(a, b) } else { Enclosure::new(b, a) }
}

fn irrational_factor(end: &Real, nominal: &Rational, digits: usize) -> String {
    let mut accuracy = digits;
    loop {
        let ratio = ratio(&end.refined_to_digits(accuracy), nominal);
        if let Some(decimal) = enclosed_decimal(ratio.lower(), ratio.upper(), digits) {
            return decimal;
        }
        accuracy = accuracy + accuracy / 2 + 4;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::number::parse_number;
    use jurist_algebra::poly::{SquareFree, UniPoly, isolate_real_roots};

    fn exact(end: &str, nominal: &str) -> Option<(String, Option<String>)> {
        let value = |text| parse_number(text).unwrap();
        let m = margin(&Real::from(value(end)), Some(&value(nominal)), 6)?;
        Some((m.factor, m.decibels))
    }

    #[test]
    fn exact_ends() {
        assert_eq!(exact("2", "1"), Some(("2".into(), Some("6.02060".into()))));
        assert_eq!(exact("1/2", "-3"), None);
        assert_eq!(exact("1", "0"), None);
        assert_eq!(exact("0", "3"), Some(("0".into(), None)));
        assert_eq!(exact("-3", "-3"), Some(("1".into(), Some("0".into()))));
        assert_eq!(exact("1", "10").unwrap().1.unwrap().parse::<f64>(), Ok(-20.0));
        assert_eq!(margin(&Real::from(Rational::ONE), None, 6), None);
    }

    #[test]
    fn irrational_ends() {
        let p = SquareFree::part_of(&UniPoly::from_i64(&[-2, 0, 1])).unwrap();
        let roots = isolate_real_roots(&p, &Budget::unlimited()).unwrap();
        let m = margin(&roots[0].clone().into(), Some(&Rational::from(-10)), 8).unwrap();
        assert_eq!(m.factor, "0.14142136");
        assert_eq!(m.decibels.as_deref(), Some("-16.989700"));
    }
}
