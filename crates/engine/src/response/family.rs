//! The open loop with a parameter left in it, and where its margins may pass a required value.

use super::open_loop::OpenLoop;
use super::place::{modulus_squared, product};
use super::requirement::Requirement;
use crate::error::{Diagnostic, Error};
use crate::model::{Cut, Opened};
use crate::problem::Problem;
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, UniPoly, discriminant, resultant,
};
use jurist_algebra::real::Real;

/// Polynomials in what is free: in one parameter, or in two.
pub(crate) trait Parameters: Domain {
    /// With the parameters as the first variables.
    fn lifted(&self) -> MultiPoly;
    /// From one in the first variables only.
    fn lowered(p: &MultiPoly) -> Self;
    /// The value at a point.
    fn value(&self, at: &[Rational]) -> Rational;
}

impl Parameters for UniPoly {
    fn lifted(&self) -> MultiPoly {
        MultiPoly::from_univariate(self, 0)
    }
    fn lowered(p: &MultiPoly) -> Self {
        p.to_univariate(0).expect("one variable is left")
    }
    fn value(&self, at: &[Rational]) -> Rational {
        self.eval_rational(&at[0])
    }
}

impl Parameters for MultiPoly {
    fn lifted(&self) -> MultiPoly {
        self.clone()
    }
    fn lowered(p: &MultiPoly) -> Self {
        p.clone()
    }
    fn value(&self, at: &[Rational]) -> Rational {
        self.eval(at)
    }
}

/// The open loop with what is free left in it: polynomials in the frequency's variable over those in the parameters.
pub(crate) struct Family<R> {
    denominator: Poly<R>,
    numerator: Poly<R>,
    shape: Shape,
    sample_time: Option<Rational>,
    cut: Cut,
    /// The number of parameters, and so the variable of a required number that is not rational.
    free: usize,
    /// Where the open loop is undefined.
    pub undefined: R,
}

/// Polynomials in what is free, at whose zeros a requirement may begin or cease to be met.
pub(crate) struct Boundaries<R> {
    /// All of them.
    pub zeros: Vec<R>,
    /// Such values themselves.
    pub values: Vec<Real>,
    /// Where a crossing may appear at once: not known by continuity.
    pub touches: R,
}

impl<R: Parameters> Family<R> {
    pub fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<Family<R>, Error> {
        let cut = problem.model().cut(at)?;
        if let Cut::Gain(name) = &cut {
            let message = format!("requirements on margins need a cut at a signal, and '{name}' is a parameter");
            return Err(Diagnostic::error("E-require", message).into());
        }
        let kept: Vec<String> = problem.free().iter().map(|f| f.name.clone()).collect();
        let Opened { system, sample_time, symbols } = problem.model().opened(&cut, &kept, problem.set(), budget)?;
        if !symbols.is_empty() {
            let message =
                "requirements on margins are decided at points for loops with functions that are not rational";
            let help = "ask 'verdict' or 'margins' with a value for every parameter";
            return Err(Diagnostic::error("E-require", message).help(help).into());
        }
        let column = system.inputs.len().max(system.e.columns()) - 1;
        let transfer = system.transfer_function_at(0, column, budget)?;
        let all: Vec<RationalFunction> =
            transfer.denominator.coefficients.iter().cloned().chain(transfer.numerator.iter().map(|f| -f)).collect();
        let common = all.iter().fold(R::one(), |l, f| {
            let d = R::lowered(f.denominator());
            l.times(&d.div_exact(&l.gcd(&d)).expect("a gcd divides"))
        });
        let cleared = |f: &RationalFunction| {
            let factor = common.div_exact(&R::lowered(f.denominator())).expect("a common multiple");
            R::lowered(f.numerator()).times(&factor)
        };
        let split = transfer.denominator.coefficients.len();
        let denominator = Poly::new(all[..split].iter().map(cleared).collect());
        let numerator: Poly<R> = Poly::new(all[split..].iter().map(cleared).collect());
        if numerator.is_zero() {
            let message = format!("nothing comes back to '{}': there is no loop through it", cut.name());
            return Err(Diagnostic::error("E-cut", message).into());
        }
        let sample_time = sample_time.and_then(|t| t.as_constant());
        Ok(Family {
            denominator,
            numerator,
            shape: problem.shape(),
            sample_time,
            cut,
            free: kept.len(),
            undefined: common,
        })
    }

    /// The open loop at a point.
    pub fn at(&self, point: &[Rational]) -> OpenLoop {
        let part = |p: &Poly<R>| p.coeffs().iter().map(|c| c.value(point)).collect::<Vec<_>>();
        let (denominator, numerator) = super::open_loop::integral(part(&self.denominator), part(&self.numerator));
        OpenLoop::from_parts(self.cut.clone(), denominator, numerator, self.shape, self.sample_time.clone())
    }

    pub fn boundaries(&self, requirement: &Requirement, budget: &Budget) -> Result<Boundaries<R>, Exhausted> {
        let common = budget.enter(|| self.denominator.gcd(&self.numerator))?;
        let divided = |p: &Poly<R>| p.div_exact(&common).expect("a gcd divides");
        let (d, n) = (divided(&self.denominator), divided(&self.numerator));
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let squared = |p: &Poly<R>| modulus_squared(p, degree, self.shape);
        let below = squared(&d);
        let (twice_real, imaginary) = product(&n, &d, degree, self.shape);
        let twice_below = below.scaled(&integer(2));
        Ok(match requirement {
            Requirement::ModulusMargin(least) => {
                let (p, q) = (least.numerator(), least.denominator());
                let excess = squared(&d.plus(&n)).scaled(&R::from_integer(&(&q * &q)));
                let excess = excess.minus(&below.scaled(&R::from_integer(&(&p * &p))));
                let excess = budget.enter(|| excess.square_free_part())?;
                let mut zeros = self.at_ends(&excess);
                zeros.push(discriminant_of(&excess, budget)?);
                Boundaries { zeros, values: Vec::new(), touches: R::one() }
            }
            Requirement::PhaseMargin { twice_cosine, .. } => {
                // Modulus one, and the real part is minus the cosine: twice_real + 2 cos |D0|^2 = 0.
                let excess = squared(&n).minus(&below);
                let excess = without_common(&excess, &[&below, &twice_real], budget)?;
                let mut zeros = self.at_ends(&excess);
                zeros.push(self.eliminated(&excess, &twice_real, &below, twice_cosine, budget)?);
                let touches = discriminant_of(&excess, budget)?;
                zeros.push(touches.clone());
                Boundaries { zeros, values: Vec::new(), touches }
            }
            Requirement::GainMargin { factor, .. } => {
                // Real, and the factor makes it -1: 2 |D0|^2 + k twice_real = 0.
                let mut zeros = Vec::new();
                let mut touches = R::one();
                if !imaginary.is_zero() {
                    let imaginary = without_common(&imaginary, &[&below, &twice_real], budget)?;
                    zeros.extend(self.at_ends(&imaginary));
                    zeros.push(self.eliminated(&imaginary, &twice_below, &twice_real, factor, budget)?);
                    zeros.push(self.eliminated(&imaginary, &twice_real, &twice_below, factor, budget)?);
                    touches = discriminant_of(&imaginary, budget)?;
                    zeros.push(touches.clone());
                }
                for (a, b) in self.values_at_ends(&d, &n, degree) {
                    for (a, b) in [(&a, &b), (&b, &a)] {
                        zeros.push(self.norm(a, b, factor, budget)?);
                    }
                }
                Boundaries { zeros, values: Vec::new(), touches }
            }
            Requirement::Damping(_) | Requirement::DelayMargin(_) | Requirement::SettlingTime { .. } => {
                Boundaries::none()
            }
        })
    }

    /// The values at the ends of the range of frequencies, and the leading coefficient.
    fn at_ends(&self, p: &Poly<R>) -> Vec<R> {
        let mut out: Vec<R> = match self.shape {
            Shape::UnitDisc => [2, -2].map(|x| p.eval(&integer(x))).to_vec(),
            Shape::LeftHalfPlane => vec![p.coeff(0)],
        };
        out.extend(p.leading().cloned());
        out.retain(|f| !f.is_zero());
        out
    }

    /// `D0` and `N` at the real ends: a root passes there at the factor `-D0/N`.
    fn values_at_ends(&self, d: &Poly<R>, n: &Poly<R>, degree: usize) -> Vec<(R, R)> {
        let at = |x: i64| (d.eval(&integer(x)), n.eval(&integer(x)));
        let mut out = match self.shape {
            Shape::UnitDisc => vec![at(1), at(-1)],
            Shape::LeftHalfPlane => vec![at(0), (d.coeff(degree), n.coeff(degree))],
        };
        out.retain(|(a, b)| !a.is_zero() && !b.is_zero());
        out
    }

    /// Where `p` and `a + alpha b` have a common root, and more.
    fn eliminated(
        &self,
        p: &Poly<R>,
        a: &Poly<R>,
        b: &Poly<R>,
        alpha: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<R, Exhausted> {
        if p.is_constant() {
            return Ok(R::one());
        }
        if let Some(alpha) = alpha.exact() {
            let scaled = |p: &Poly<R>, by: &Integer| p.scaled(&R::from_integer(by));
            return resultant(p, &scaled(a, &alpha.denominator()).plus(&scaled(b, &alpha.numerator())), budget);
        }
        let lift = |p: &Poly<R>| p.map(R::lifted);
        let with = lift(a).plus(&lift(b).scaled(&MultiPoly::variable(self.free)));
        let value = resultant(&lift(p), &with, budget)?;
        self.norm_of(&value, alpha, budget)
    }

    /// The norm of `a + alpha b`.
    fn norm(&self, a: &R, b: &R, alpha: &RealAlgebraic, budget: &Budget) -> Result<R, Exhausted> {
        if let Some(alpha) = alpha.exact() {
            let scaled = |p: &R, by: &Integer| p.times(&R::from_integer(by));
            return Ok(scaled(a, &alpha.denominator()).plus(&scaled(b, &alpha.numerator())));
        }
        self.norm_of(&a.lifted().plus(&b.lifted().times(&MultiPoly::variable(self.free))), alpha, budget)
    }

    /// The resultant with the polynomial of `alpha`, the variable after those that are free.
    fn norm_of(&self, value: &MultiPoly, alpha: &RealAlgebraic, budget: &Budget) -> Result<R, Exhausted> {
        let in_alpha = value.as_poly_in(self.free);
        let polynomial = alpha.polynomial().map(|c| MultiPoly::constant(c.clone()));
        let left = if in_alpha.is_constant() { in_alpha.coeff(0) } else { resultant(&in_alpha, &polynomial, budget)? };
        Ok(R::lowered(&left))
    }
}

fn integer<R: Domain>(x: i64) -> R {
    R::from_integer(&Integer::from(x))
}

/// The polynomial without what it has in common with all others.
fn without_common<R: Domain>(p: &Poly<R>, others: &[&Poly<R>], budget: &Budget) -> Result<Poly<R>, Exhausted> {
    budget.enter(|| {
        let common = others.iter().fold(p.clone(), |g, q| g.gcd(q));
        p.div_exact(&common).expect("a gcd divides").square_free_part()
    })
}

/// The discriminant of a square-free polynomial; 1 where it has at most one root.
fn discriminant_of<R: Domain>(p: &Poly<R>, budget: &Budget) -> Result<R, Exhausted> {
    if p.degree().is_none_or(|n| n < 2) { Ok(R::one()) } else { discriminant(p, budget) }
}

impl<R: Domain> Boundaries<R> {
    /// No value at all.
    pub fn none() -> Boundaries<R> {
        Boundaries { zeros: Vec::new(), values: Vec::new(), touches: R::one() }
    }
}
