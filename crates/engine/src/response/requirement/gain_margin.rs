//! The gain margin: stable for all factors at the cut from `1/g` to `g`.

use super::{Found, Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::GAIN_MARGIN;
use crate::response::{Margins, StableMargins};
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

    /// By decibels above 0: the factor `10^(d/20)`, an algebraic number.
    ///
    /// Cost: isolation of the roots of `x^q - 10^p`, `d/20 = p/q`.
    ///
    /// # Errors
    /// `E-require` for another number, and where it is a root of too high a degree.
    pub fn gain_margin_in_decibels(decibels: &Rational, budget: &Budget) -> Result<Requirement, Error> {
        if !decibels.sign().is_gt() {
            return Err(refused("a gain margin is a factor above 1, or decibels above 0"));
        }
        let exponent = decibels / &Rational::from(20);
        let degree = exponent.denominator().to_i64().filter(|d| *d as usize <= super::MOST_DEGREE);
        let above = exponent.numerator().to_i64().filter(|n| *n < 1000);
        let (Some(degree), Some(above)) = (degree, above) else {
            return Err(refused("these decibels are no root of a small degree: give them in whole numbers"));
        };
        let mut coefficients = vec![Integer::ZERO; degree as usize + 1];
        coefficients[0] = -Integer::from(10).pow(above as u64);
        coefficients[degree as usize] = Integer::ONE;
        let root = greatest_root(&Poly::new(coefficients), budget)?.expect("10 has a positive root");
        Ok(of(format!("{decibels} dB"), root))
    }
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
