//! Requirements on margins, and whether a loop meets them at a point.

use crate::error::{Code, Diagnostic, Error};
use crate::stability::{ParametricPolynomial, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
use jurist_algebra::symbols::{Definition, Symbols};
use std::sync::Arc;

/// What is required of a loop beyond its stability.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_engine::response::Requirement;
/// let half = Requirement::phase_margin(&Rational::from(60)).unwrap();
/// assert_eq!(half.name(), "phase_margin");
/// assert!(Requirement::damping(Rational::from(2)).is_err());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Requirement {
    /// Stable for all factors from `1/g` to `g` at the cut.
    GainMargin {
        /// How it was asked for.
        asked: String,
        /// `g`, above 1.
        factor: RealAlgebraic,
    },
    /// Stable however the open loop is turned by less than an angle.
    PhaseMargin {
        /// How it was asked for.
        asked: String,
        /// Twice the cosine of the angle.
        twice_cosine: RealAlgebraic,
    },
    /// `|1 + L|` is nowhere below this.
    ModulusMargin(Rational),
    /// All roots have at least this damping: `cos` of the angle that they, or in discrete time `ln(z)`, make with the negative real
    /// axis.
    Damping(Rational),
    /// Stable with all less dead time at the cut: at the input of a plant behind a hold, and in continuous time; else with so
    /// much delay in whole samples.
    DelayMargin(Rational),
    /// All roots have a modulus of at most `exp(-4 T/time)`. Discrete time.
    SettlingTime {
        /// The time.
        time: Rational,
        /// `-4 T/time`.
        exponent: Rational,
    },
}

/// Polynomials of greater degree are not made of an angle or of decibels.
const MOST_DEGREE: usize = 24;

impl Requirement {
    /// By a factor above 1.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn gain_margin(factor: &Rational) -> Result<Requirement, Error> {
        if *factor <= Rational::ONE {
            return Err(refused("a gain margin is a factor above 1, or decibels above 0"));
        }
        Ok(Requirement::GainMargin { asked: factor.to_string(), factor: RealAlgebraic::from_rational(factor.clone()) })
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
        let degree = exponent.denominator().to_i64().filter(|d| *d as usize <= MOST_DEGREE);
        let above = exponent.numerator().to_i64().filter(|n| *n < 1000);
        let (Some(degree), Some(above)) = (degree, above) else {
            return Err(refused("these decibels are no root of a small degree: give them in whole numbers"));
        };
        let mut coefficients = vec![Integer::ZERO; degree as usize + 1];
        coefficients[0] = -Integer::from(10).pow(above as u64);
        coefficients[degree as usize] = Integer::ONE;
        let root = greatest_root(&Poly::new(coefficients), budget)?.expect("10 has a positive root");
        Ok(Requirement::GainMargin { asked: format!("{decibels} dB"), factor: root })
    }

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
        let (Some(turns), Some(order)) = (turns, order.filter(|n| *n <= 4 * MOST_DEGREE as i64)) else {
            return Err(refused(
                "the cosine of this angle is of a high degree: give the angle in multiples of 5 degrees",
            ));
        };
        let polynomial = twice_cosines(order as usize);
        if polynomial.coeffs().len() > MOST_DEGREE + 1 {
            return Err(refused(
                "the cosine of this angle is of a high degree: give the angle in multiples of 5 degrees",
            ));
        }
        let roots = isolate_real_roots(&SquareFree::part_of(&polynomial).expect("not zero"), &budget)?;
        // 2 cos(2 pi i/n) for i coprime to n, from the greatest down.
        let coprime = |i: &i64| Integer::from(*i).gcd(&Integer::from(order)).is_one();
        let rank = (1..=turns).filter(coprime).count();
        let twice_cosine = roots[roots.len() - rank].clone();
        Ok(Requirement::PhaseMargin { asked: format!("{degrees} deg"), twice_cosine })
    }

    /// By the least value of `|1 + L|`, above 0.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn modulus_margin(least: Rational) -> Result<Requirement, Error> {
        if !least.sign().is_gt() {
            return Err(refused("a modulus margin is above 0"));
        }
        Ok(Requirement::ModulusMargin(least))
    }

    /// By the damping, above 0 and below 1.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn damping(least: Rational) -> Result<Requirement, Error> {
        if !least.sign().is_gt() || least >= Rational::ONE {
            return Err(refused("a damping is above 0 and below 1"));
        }
        Ok(Requirement::Damping(least))
    }

    /// By a dead time above 0, in units of time.
    ///
    /// # Errors
    /// `E-require` for another number.
    pub fn delay_margin(least: Rational) -> Result<Requirement, Error> {
        if !least.sign().is_gt() {
            return Err(refused("a delay margin is above 0"));
        }
        Ok(Requirement::DelayMargin(least))
    }

    /// By the time, above 0, in which all modes of a discrete loop with this sample time have decayed by `exp(-4)`, to 1.8 %.
    ///
    /// # Errors
    /// `E-require` for other numbers.
    pub fn settling_time(time: Rational, step: &Rational) -> Result<Requirement, Error> {
        if !time.sign().is_gt() || !step.sign().is_gt() {
            return Err(refused("a settling time and its sample time are above 0"));
        }
        let exponent = (&Rational::from(-4) * step).checked_div(&time).expect("positive");
        Ok(Requirement::SettlingTime { time, exponent })
    }

    /// Its name in model files and documents.
    pub fn name(&self) -> &'static str {
        match self {
            Requirement::GainMargin { .. } => "gain_margin",
            Requirement::PhaseMargin { .. } => "phase_margin",
            Requirement::ModulusMargin(_) => "modulus_margin",
            Requirement::Damping(_) => "damping",
            Requirement::DelayMargin(_) => "delay_margin",
            Requirement::SettlingTime { .. } => "settling_time",
        }
    }

    /// What is required, as it was asked for.
    pub fn required(&self) -> String {
        match self {
            Requirement::GainMargin { asked, .. } | Requirement::PhaseMargin { asked, .. } => asked.clone(),
            Requirement::ModulusMargin(least) | Requirement::Damping(least) | Requirement::DelayMargin(least) => {
                least.to_string()
            }
            Requirement::SettlingTime { time, .. } => time.to_string(),
        }
    }

    /// `phase_margin >= 45 deg`.
    pub fn text(&self) -> String {
        let sign = if matches!(self, Requirement::SettlingTime { .. }) { "<=" } else { ">=" };
        format!("{} {sign} {}", self.name(), self.required())
    }

    /// Whether it is about the open loop at a cut.
    pub(crate) fn needs_cut(&self) -> bool {
        !matches!(self, Requirement::Damping(_) | Requirement::SettlingTime { .. })
    }
}

/// The polynomial at `r z`, `r = exp(exponent)`, as variable 0 of the symbols; the coefficients are free of them.
pub(crate) fn scaled_by_exponential(
    coefficients: impl Iterator<Item = MultiPoly>,
    exponent: &Rational,
) -> (Arc<Symbols>, Poly<MultiPoly>) {
    let mut symbols = Symbols::new();
    let radius = symbols.insert("X", Definition::exponential(exponent.clone()));
    let mut power = MultiPoly::one();
    let mut scaled = Vec::new();
    for c in coefficients {
        scaled.push(c.times(&power));
        power = power.times(&MultiPoly::variable(radius));
    }
    (Arc::new(symbols), Poly::new(scaled))
}

/// A rational number of few digits just below `exp(exponent)`, by at most so many binary digits.
pub(crate) fn radius_below(exponent: &Rational, bits: u64) -> Rational {
    let mut symbols = Symbols::new();
    let radius = symbols.insert("X", Definition::exponential(exponent.clone()));
    let low = symbols.values(bits + 8)[radius].lower();
    Rational::dyadic(&(low * Rational::from(Integer::ONE << bits)).floor(), bits)
}

fn refused(message: &str) -> Error {
    Diagnostic::error(Code::Require, message).into()
}

fn greatest_root(p: &UniPoly, budget: &Budget) -> Result<Option<RealAlgebraic>, Exhausted> {
    let Some(p) = SquareFree::part_of(p) else { return Ok(None) };
    Ok(isolate_real_roots(&p, budget)?.pop())
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
    crate::stability::HalfSizePair::new(&cyclotomic, degree, Shape::UnitDisc).a
}

fn cyclotomic(n: usize) -> UniPoly {
    let mut p = UniPoly::monomial(Integer::ONE, n).minus(&UniPoly::one());
    for d in (1..n).filter(|d| n.is_multiple_of(*d)) {
        p = p.div_exact(&cyclotomic(d)).expect("a cyclotomic factor divides");
    }
    p
}

/// `P(a s) P(b s)` with `a, b = c (c +- j damping)`, `c^2 = 1 - damping^2`, times powers of the denominator: all its roots are in the
/// left half plane just when those of `P` are in the sector of at least this damping.
pub(crate) fn in_sector<R: Domain>(p: &Poly<R>, damping: &Rational) -> Poly<R> {
    let n = p.coeffs().len().saturating_sub(1);
    let square = Rational::ONE - damping * damping;
    // t_k = a^k + b^k, and a b = c^2.
    let mut sums = vec![Rational::from(2), &square + &square];
    for k in 2..=n {
        let next = &(&square + &square) * &sums[k - 1] - &square * &sums[k - 2];
        sums.push(next);
    }
    let mut powers = vec![Rational::ONE];
    for k in 1..=n {
        let next = &powers[k - 1] * &square;
        powers.push(next);
    }
    // Twice the product, cleared of denominators.
    let weight = |i: usize, j: usize| &powers[i.min(j)] * &sums[i.abs_diff(j)];
    let mut clear = Integer::ONE;
    for i in 0..=n {
        for j in 0..=n {
            clear = clear.lcm(&weight(i, j).denominator());
        }
    }
    let mut out = vec![R::zero(); 2 * n + 1];
    for i in 0..=n {
        for j in 0..=n {
            let w = weight(i, j) * Rational::from(&clear);
            out[i + j] = out[i + j].plus(&p.coeff(i).times(&p.coeff(j)).times(&R::from_integer(&w.numerator())));
        }
    }
    Poly::new(out)
}

/// Polynomials in `rho`, up to factors, whose common zeros are the roots `s = rho exp(j psi)`, `cos psi = -damping`: those on the
/// sector's edge for `rho > 0`. They are the imaginary parts of `P` and of `P exp(-j psi)`, over `sin psi`, the first over `rho` too.
pub(crate) fn on_sector_edge<R: Domain>(p: &Poly<R>, damping: &Rational) -> [Poly<R>; 2] {
    let n = p.coeffs().len().saturating_sub(1);
    // u_k = sin(k psi)/sin psi.
    let twice_cosine = -(damping + damping);
    let mut sines = vec![Rational::ZERO, Rational::ONE];
    for k in 2..=n {
        let next = &twice_cosine * &sines[k - 1] - &sines[k - 2];
        sines.push(next);
    }
    let clear = sines.iter().fold(Integer::ONE, |l, u| l.lcm(&u.denominator()));
    let weight = |u: &Rational| R::from_integer(&(u * &Rational::from(&clear)).numerator());
    let first = (1..=n).map(|k| p.coeff(k).times(&weight(&sines[k]))).collect();
    let before = |k: usize| if k == 0 { -Rational::ONE } else { sines[k - 1].clone() };
    let second = (0..=n).map(|k| p.coeff(k).times(&weight(&before(k)))).collect();
    [Poly::new(first), Poly::new(second)]
}

/// The sector's polynomial in the parameter that is free.
pub(crate) fn sector_in_parameter(p: &ParametricPolynomial, damping: &Rational) -> ParametricPolynomial {
    let product = in_sector(p.polynomial(), damping);
    let coefficients: Vec<_> = (0..=2 * p.formal_degree()).map(|i| (product.coeff(i), UniPoly::one())).collect();
    ParametricPolynomial::new(&coefficients, 2 * p.formal_degree(), Vec::new())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosines_of_known_angles() {
        for (degrees, decimal) in
            [(60, "1"), (90, "0"), (120, "-1"), (45, "1.4142135624"), (36, "1.6180339887"), (5, "1.9923893962")]
        {
            let Requirement::PhaseMargin { twice_cosine, .. } =
                Requirement::phase_margin(&Rational::from(degrees)).unwrap()
            else {
                panic!("a phase margin")
            };
            assert_eq!(twice_cosine.decimal(11), decimal, "{degrees}");
        }
    }

    #[test]
    fn decibels_are_roots_of_powers_of_ten() {
        let budget = Budget::unlimited();
        let factor = |db: i64| match Requirement::gain_margin_in_decibels(&Rational::from(db), &budget).unwrap() {
            Requirement::GainMargin { factor, .. } => factor,
            other => panic!("{other:?}"),
        };
        assert_eq!(factor(6).decimal(12), "1.99526231497");
        assert_eq!(factor(20).exact(), Some(Rational::from(10)));
    }

    #[test]
    fn the_sector_of_a_damped_pair() {
        // s^2 + 2 d s + 1 with d = 3/5 is on the edge of damping 3/5.
        let p = UniPoly::from_i64(&[5, 6, 5]);
        let counted = |tenths: i64| {
            let sector = in_sector(&p, &Rational::new(tenths.into(), 10.into()));
            let count = crate::stability::count_roots(&sector, Shape::LeftHalfPlane);
            (count.inside, count.on, count.outside)
        };
        assert_eq!(counted(5), (4, 0, 0));
        assert_eq!(counted(6), (2, 2, 0));
        assert_eq!(counted(7), (2, 0, 2));
        // rho = 1 on the edge, and nowhere else.
        let edge = |tenths: i64| on_sector_edge(&p, &Rational::new(tenths.into(), 10.into()));
        let common = |tenths: i64| edge(tenths)[0].gcd(&edge(tenths)[1]);
        assert_eq!([5, 6, 7].map(common), [&[1][..], &[-5, 5], &[5]].map(UniPoly::from_i64));
    }
}
