//! The gain margin: stable for all factors at the cut from `1/g` to `g`.

use super::{Found, Meaning, ROUNDED, Requirement, RequirementKind, RequirementOption, Rule, as_written, refused};
use crate::error::Error;
use crate::model::requirements::GAIN_MARGIN;
use crate::response::{Margins, StableMargins};
use jurist_algebra::ball::{Ball, exp};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
use jurist_algebra::real::Real;

pub(super) const KIND: RequirementKind = RequirementKind {
    name: GAIN_MARGIN.name,
    about: GAIN_MARGIN.about,
    option: Some(RequirementOption { value: "MARGIN", help: "Asks for a gain margin both ways: '6 dB' or a factor" }),
    is_listed: true,
    // The loop is stable at the factor itself.
    sense: ">",
    units: &["dB"],
    meaning: |written| {
        Ok(Meaning::Requirement(match written.unit {
            Some(_) => Requirement::gain_margin_in_decibels(&written.value, written.budget)?,
            None => Requirement::gain_margin(&written.value)?,
        }))
    },
    found,
};

fn of(asked: String, factor: RealAlgebraic) -> Requirement {
    Requirement { kind: &KIND, asked, rule: Rule::Factors(factor) }
}

impl Requirement {
    /// By a factor above 1.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn gain_margin(factor: &Rational) -> Result<Requirement, Error> {
        if *factor <= Rational::ONE {
            return Err(refused("a gain margin is a factor above 1, or decibels above 0"));
        }
        Ok(of(factor.to_string(), RealAlgebraic::from_rational(factor.clone())))
    }

    /// By decibels above 0: the factor `10^(d/20)`, an algebraic number. One of a high degree, as of 6.5 dB, is rounded up by less than 1e-30, and the text of
    /// the requirement says so.
    ///
    /// Cost: isolation of the roots of `x^q - 10^p`, `d/20 = p/q`.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn gain_margin_in_decibels(decibels: &Rational, budget: &Budget) -> Result<Requirement, Error> {
        if !decibels.sign().is_gt() {
            return Err(refused("a gain margin is a factor above 1, or decibels above 0"));
        }
        let exponent = decibels / &Rational::from(20);
        let degree = exponent.denominator().to_i64().filter(|d| *d as usize <= super::MOST_DEGREE);
        let above = exponent.numerator().to_i64().filter(|n| *n < 1000);
        let (Some(degree), Some(above)) = (degree, above) else {
            if exponent >= Rational::from(1000) {
                return Err(refused("a gain margin is below 20000 dB"));
            }
            let factor = RealAlgebraic::from_rational(rounded_factor(&exponent));
            return Ok(of(format!("{} dB{ROUNDED}", as_written(decibels)), factor));
        };
        let mut coefficients = vec![Integer::ZERO; degree as usize + 1];
        coefficients[0] = -Integer::from(10).pow(above as u64);
        coefficients[degree as usize] = Integer::ONE;
        let root = greatest_root(&Poly::new(coefficients), budget)?.expect("10 has a positive root");
        Ok(of(format!("{decibels} dB"), root))
    }
}

/// A number just above a power of ten, relative to it.
fn rounded_factor(exponent: &Rational) -> Rational {
    let bits = 128 + 4 * exponent.floor().to_i64().map_or(0, i64::unsigned_abs);
    let logarithm = Enclosure::from_rational(Rational::from(10)).ln(bits).expect("ten is positive");
    exp(&Ball::from_enclosure(&logarithm, bits).mul(&Ball::from_rational(exponent, bits))).upper()
}

/// The factor that is allowed for both ways.
fn found<'a>(_: &'a Margins, stable: &'a StableMargins) -> Option<Found<'a>> {
    let upper = stable.gain.upper.as_ref().map(|end| &end.value);
    let lower = stable.gain.lower.as_ref().map(|end| &end.value).filter(|x| x.sign().is_gt());
    let enclosed = |x: &Real, bits: u64| {
        let (lo, hi) = x.refined_to_digits(bits as usize * 3 / 10 + 4).enclosure();
        Enclosure::new(lo, hi)
    };
    let one = Enclosure::from_rational(Rational::ONE);
    Some(Found::Enclosed(Box::new(move |bits| {
        let below = lower.and_then(|x| one.div(&enclosed(x, bits), bits + 16));
        let ways = [upper.map(|x| enclosed(x, bits)), below];
        ways.into_iter().flatten().min_by(|a, b| a.lower().cmp(b.lower()))
    })))
}

fn greatest_root(p: &UniPoly, budget: &Budget) -> Result<Option<RealAlgebraic>, Exhausted> {
    let Some(p) = SquareFree::part_of(p) else { return Ok(None) };
    Ok(isolate_real_roots(&p, budget)?.pop())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `10^(13/40)`: the number that is decided is above it by less than 1e-30.
    #[test]
    fn other_decibels_are_rounded_up() {
        let asked = "6.5".parse().unwrap();
        let requirement = Requirement::gain_margin_in_decibels(&asked, &Budget::unlimited()).unwrap();
        assert!(requirement.text().ends_with(ROUNDED), "{}", requirement.text());
        let Rule::Factors(factor) = requirement.rule else { panic!("a gain margin") };
        let factor = factor.exact().unwrap();
        let known = Rational::from(10).pow(13).unwrap();
        let less = &factor - &"1e-30".parse::<Rational>().unwrap();
        assert!(factor.pow(40).unwrap() > known && less.pow(40).unwrap() < known);
    }

    #[test]
    fn decibels_are_roots_of_powers_of_ten() {
        let budget = Budget::unlimited();
        let factor = |db: i64| match Requirement::gain_margin_in_decibels(&Rational::from(db), &budget).unwrap().rule {
            Rule::Factors(factor) => factor,
            other => panic!("{other:?}"),
        };
        assert_eq!(factor(6).decimal(12), "1.99526231497");
        assert_eq!(factor(20).exact(), Some(Rational::from(10)));
    }
}
