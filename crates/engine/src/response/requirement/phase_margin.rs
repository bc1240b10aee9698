//! The phase margin: stable however the open loop is turned by less than an angle.

use super::{Found, Meaning, ROUNDED, Requirement, RequirementKind, RequirementOption, Rule, as_written, refused};
use crate::error::Error;
use crate::model::requirements::PHASE_MARGIN;
use crate::stability::{HalfSizePair, Shape};
use jurist_algebra::ball::{Ball, cos_sin};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational};
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
    /// By an angle in degrees, above 0 and below 180. The cosine of an angle such as 45 degrees is an algebraic number of a small degree. Another angle is
    /// rounded up by less than 1e-30 degrees, so that its cosine is rational, and the text of the requirement says so.
    ///
    /// # Errors
    /// `E-require` for another angle.
    pub fn phase_margin(degrees: &Rational) -> Result<Requirement, Error> {
        if !degrees.sign().is_gt() || *degrees >= Rational::from(180) {
            return Err(refused("a phase margin is above 0 and below 180 degrees"));
        }
        let (twice_cosine, asked) = match exact_twice_cosine(degrees)? {
            Some(exact) => (exact, format!("{degrees} deg")),
            None => {
                let rounded = RealAlgebraic::from_rational(rounded_twice_cosine(degrees));
                (rounded, format!("{} deg{ROUNDED}", as_written(degrees)))
            }
        };
        Ok(Requirement { kind: &KIND, asked, rule: Rule::Turned { twice_cosine } })
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

/// Twice the cosine of an angle in degrees; `None` where it is of too high a degree.
fn exact_twice_cosine(degrees: &Rational) -> Result<Option<RealAlgebraic>, Error> {
    // exp(j phi) is a primitive root of unity of this order.
    let turn = degrees / &Rational::from(360);
    let (turns, order) = (turn.numerator().to_i64(), turn.denominator().to_i64());
    let (Some(turns), Some(order)) = (turns, order.filter(|n| *n <= 4 * super::MOST_DEGREE as i64)) else {
        return Ok(None);
    };
    let polynomial = twice_cosines(order as usize);
    if polynomial.coeffs().len() > super::MOST_DEGREE + 1 {
        return Ok(None);
    }
    let roots = isolate_real_roots(&SquareFree::part_of(&polynomial).expect("not zero"), &Budget::unlimited())?;
    // 2 cos(2 pi i/n) for i coprime to n, from the greatest down.
    let coprime = |i: &i64| Integer::from(*i).gcd(&Integer::from(order)).is_one();
    let rank = (1..=turns).filter(coprime).count();
    Ok(Some(roots[roots.len() - rank].clone()))
}

/// A rational number just below twice the cosine of an angle in degrees. The sine of the angle is at least a sixtieth of the inverse of its denominator, so
/// that its angle is greater by less than 1e-30 degrees.
fn rounded_twice_cosine(degrees: &Rational) -> Rational {
    let bits = 128 + 4 * degrees.denominator().bit_length();
    let half_turn = Ball::from_enclosure(&Enclosure::pi(bits), bits);
    let angle = half_turn.mul(&Ball::from_rational(&(degrees / &Rational::from(180)), bits));
    let (cosine, _) = cos_sin(&angle);
    cosine.lower() * Rational::from(2)
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

    /// The angle that is decided is the one that is asked or greater by less than 1e-30 degrees, also close to 0 and to 180 degrees.
    #[test]
    fn other_angles_are_rounded_up() {
        for asked in ["47.3", "47", "1", "179", "0.001", "179.999", "89.99999999999", "0.00000000000000001"] {
            let degrees: Rational = asked.parse().unwrap();
            let requirement = Requirement::phase_margin(&degrees).unwrap();
            assert_eq!(requirement.required_number(0).unwrap(), degrees);
            assert!(requirement.text().ends_with(ROUNDED), "{}", requirement.text());
            let Rule::Turned { twice_cosine } = requirement.rule else { panic!("a phase margin") };
            let half = Enclosure::from_rational(twice_cosine.exact().unwrap() * Rational::new(1.into(), 2.into()));
            let turned = half.acos(600).mul(&Enclosure::from_rational(180.into()), 600);
            let turned = turned.div(&Enclosure::pi(600), 600).unwrap();
            let more: Rational = "1e-30".parse().unwrap();
            assert!(*turned.lower() >= degrees && *turned.upper() < &degrees + &more, "{asked}");
        }
    }

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
