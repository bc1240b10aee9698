//! The phase margin: stable however the open loop is turned by less than an angle.

use super::{Found, Meaning, Requirement, RequirementKind, RequirementOption, Rule, refused};
use crate::error::Error;
use crate::model::requirements::PHASE_MARGIN;
use crate::stability::{HalfSizePair, Shape};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};

pub(super) const KIND: RequirementKind = RequirementKind {
    name: PHASE_MARGIN.name,
    about: PHASE_MARGIN.about,
    option: Some(RequirementOption { value: "ANGLE", help: "Asks for a phase margin: '45 deg'" }),
    is_listed: true,
    sense: ">=",
    units: &["degrees", "deg", "°"],
    meaning: |written| Ok(Meaning::Requirement(Requirement::phase_margin(&written.value)?)),
    found: |_, stable| Some(Found::Enclosed(Box::new(|bits| stable.phase.degrees(bits)))),
};

impl Requirement {
    /// By an angle in degrees, above 0 and below 180. Its cosine is an algebraic number.
    ///
    /// # Errors
    /// `E-require` for another angle, and where the cosine is of too high a degree.
    pub fn phase_margin(degrees: &Rational) -> Result<Requirement, Error> {
        let budget = Budget::unlimited();
        if !degrees.sign().is_gt() || *degrees >= Rational::from(180) {
            return Err(refused("a phase margin is above 0 and below 180 degrees"));
        }
        // exp(j phi) is a primitive root of unity of this order.
        let turn = degrees / &Rational::from(360);
        let (turns, order) = (turn.numerator().to_i64(), turn.denominator().to_i64());
        let (Some(turns), Some(order)) = (turns, order.filter(|n| *n <= 4 * super::MOST_DEGREE as i64)) else {
            return Err(refused(
                "the cosine of this angle is of a high degree: give the angle in multiples of 5 degrees",
            ));
        };
        let polynomial = twice_cosines(order as usize);
        if polynomial.coeffs().len() > super::MOST_DEGREE + 1 {
            return Err(refused(
                "the cosine of this angle is of a high degree: give the angle in multiples of 5 degrees",
            ));
        }
        let roots = isolate_real_roots(&SquareFree::part_of(&polynomial).expect("not zero"), &budget)?;
        // 2 cos(2 pi i/n) for i coprime to n, from the greatest down.
        let coprime = |i: &i64| Integer::from(*i).gcd(&Integer::from(order)).is_one();
        let rank = (1..=turns).filter(coprime).count();
        let twice_cosine = roots[roots.len() - rank].clone();
        Ok(Requirement { kind: &KIND, asked: format!("{degrees} deg"), rule: Rule::Turned { twice_cosine } })
    }

    /// By twice the cosine of the angle, above -2 and below 2.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// use jurist_engine::response::Requirement;
    /// assert_eq!(Requirement::phase_margin_by_cosine(&Rational::ONE)?.required(), "acos(1/2)"); // 60 degrees
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn phase_margin_by_cosine(twice_cosine: &Rational) -> Result<Requirement, Error> {
        if *twice_cosine <= Rational::from(-2) || *twice_cosine >= Rational::from(2) {
            return Err(refused("a phase margin is above 0 and below 180 degrees"));
        }
        let cosine = twice_cosine * &Rational::new(1.into(), 2.into());
        let twice_cosine = RealAlgebraic::from_rational(twice_cosine.clone());
        Ok(Requirement { kind: &KIND, asked: format!("acos({cosine})"), rule: Rule::Turned { twice_cosine } })
    }
}

/// The polynomial whose roots are `2 cos(2 pi i/n)`, `i` coprime to `n`: of the cyclotomic polynomial, in `z + 1/z`.
fn twice_cosines(n: usize) -> UniPoly {
    let cyclotomic = cyclotomic(n);
    let degree = cyclotomic.degree().unwrap_or(0);
    if degree < 2 {
        // z = 1 and z = -1.
        return UniPoly::from_i64(if n == 1 { &[-2, 1] } else { &[2, 1] });
    }
    // A polynomial that mirrors itself is half of the sum of itself and its mirror image.
    HalfSizePair::new(&cyclotomic, degree, Shape::UnitDisc).a
}

fn cyclotomic(n: usize) -> UniPoly {
    let mut p = UniPoly::monomial(Integer::ONE, n).minus(&UniPoly::one());
    for d in (1..n).filter(|d| n.is_multiple_of(*d)) {
        p = p.div_exact(&cyclotomic(d)).expect("a cyclotomic factor divides");
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosines_of_known_angles() {
        for (degrees, decimal) in
            [(60, "1"), (90, "0"), (120, "-1"), (45, "1.4142135624"), (36, "1.6180339887"), (5, "1.9923893962")]
        {
            let Rule::Turned { twice_cosine } = Requirement::phase_margin(&Rational::from(degrees)).unwrap().rule
            else {
                panic!("a phase margin")
            };
            assert_eq!(twice_cosine.decimal(11), decimal, "{degrees}");
        }
    }
}
