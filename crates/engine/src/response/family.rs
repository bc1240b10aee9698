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

/// Polynomials in the frequency's variable over those in the parameter.
pub(crate) type Bivariate = Poly<UniPoly>;

/// The open loop with the parameter left in it.
pub(crate) struct Family {
    denominator: Bivariate,
    numerator: Bivariate,
    shape: Shape,
    sample_time: Option<Rational>,
    cut: Cut,
    /// Where the open loop is undefined.
    pub undefined: UniPoly,
}

/// Polynomials in the parameter, at whose zeros a requirement may begin or cease to be met.
pub(crate) struct Boundaries {
    /// All of them.
    pub zeros: Vec<UniPoly>,
    /// Such values themselves.
    pub values: Vec<Real>,
    /// Where a crossing may appear at once: not known by continuity.
    pub touches: UniPoly,
}

impl Family {
    pub fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<Family, Error> {
        let cut = problem.model().cut(at)?;
        if let Cut::Gain(name) = &cut {
            let message = format!("requirements on margins need a cut at a signal, and '{name}' is a parameter");
            return Err(Diagnostic::error("E-require", message).into());
        }
        let kept = [problem.parameter().name.clone()];
        let Opened { system, sample_time, symbols } = problem.model().opened(&cut, &kept, problem.set(), budget)?;
        if !symbols.is_empty() {
            let message =
                "requirements on margins are decided at points for loops with functions that are not rational";
            let help = "ask 'verdict' or 'margins' with a value for every parameter";
            return Err(Diagnostic::error("E-require", message).help(help).into());
        }
        let column = system.inputs.len().max(system.e.columns()) - 1;
        let transfer = system.transfer_function_at(0, column, budget)?;
        let side = |p: &MultiPoly| p.to_univariate(0).expect("one variable is kept");
        let all: Vec<RationalFunction> =
            transfer.denominator.coefficients.iter().cloned().chain(transfer.numerator.iter().map(|f| -f)).collect();
        let common = all.iter().fold(UniPoly::one(), |l, f| {
            let d = side(f.denominator());
            l.times(&d.div_exact(&l.gcd(&d)).expect("a gcd divides"))
        });
        let cleared = |f: &RationalFunction| {
            side(f.numerator()).times(&common.div_exact(&side(f.denominator())).expect("a common multiple"))
        };
        let split = transfer.denominator.coefficients.len();
        let denominator = Poly::new(all[..split].iter().map(cleared).collect());
        let numerator: Bivariate = Poly::new(all[split..].iter().map(cleared).collect());
        if numerator.is_zero() {
            let message = format!("nothing comes back to '{}': there is no loop through it", cut.name());
            return Err(Diagnostic::error("E-cut", message).into());
        }
        let sample_time = sample_time.and_then(|t| t.as_constant());
        Ok(Family { denominator, numerator, shape: problem.shape(), sample_time, cut, undefined: common })
    }

    /// The open loop at a value of the parameter.
    pub fn at(&self, value: &Rational) -> OpenLoop {
        let part = |p: &Bivariate| p.coeffs().iter().map(|c| c.eval_rational(value)).collect::<Vec<_>>();
        let (denominator, numerator) = super::open_loop::integral(part(&self.denominator), part(&self.numerator));
        OpenLoop::from_parts(self.cut.clone(), denominator, numerator, self.shape, self.sample_time.clone())
    }

    pub fn boundaries(&self, requirement: &Requirement, budget: &Budget) -> Result<Boundaries, Exhausted> {
        let common = budget.enter(|| self.denominator.gcd(&self.numerator))?;
        let divided = |p: &Bivariate| p.div_exact(&common).expect("a gcd divides");
        let (d, n) = (divided(&self.denominator), divided(&self.numerator));
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let squared = |p: &Bivariate| modulus_squared(p, degree, self.shape);
        let below = squared(&d);
        let (twice_real, imaginary) = product(&n, &d, degree, self.shape);
        let twice_below = below.scaled(&integer(2));
        Ok(match requirement {
            Requirement::ModulusMargin(least) => {
                let (p, q) = (least.numerator(), least.denominator());
                let excess = squared(&d.plus(&n)).scaled(&UniPoly::constant(&q * &q));
                let excess = excess.minus(&below.scaled(&UniPoly::constant(&p * &p)));
                let excess = budget.enter(|| excess.square_free_part())?;
                let mut zeros = self.at_ends(&excess);
                zeros.push(discriminant_of(&excess, budget)?);
                Boundaries { zeros, values: Vec::new(), touches: UniPoly::one() }
            }
            Requirement::PhaseMargin { twice_cosine, .. } => {
                // Modulus one, and the real part is minus the cosine: twice_real + 2 cos |D0|^2 = 0.
                let excess = squared(&n).minus(&below);
                let excess = without_common(&excess, &[&below, &twice_real], budget)?;
                let mut zeros = self.at_ends(&excess);
                zeros.push(eliminated(&excess, &twice_real, &below, twice_cosine, budget)?);
                let touches = discriminant_of(&excess, budget)?;
                zeros.push(touches.clone());
                Boundaries { zeros, values: Vec::new(), touches }
            }
            Requirement::GainMargin { factor, .. } => {
                // Real, and the factor makes it -1: 2 |D0|^2 + k twice_real = 0.
                let mut zeros = Vec::new();
                let mut touches = UniPoly::one();
                if !imaginary.is_zero() {
                    let imaginary = without_common(&imaginary, &[&below, &twice_real], budget)?;
                    zeros.extend(self.at_ends(&imaginary));
                    zeros.push(eliminated(&imaginary, &twice_below, &twice_real, factor, budget)?);
                    zeros.push(eliminated(&imaginary, &twice_real, &twice_below, factor, budget)?);
                    touches = discriminant_of(&imaginary, budget)?;
                    zeros.push(touches.clone());
                }
                for (a, b) in self.values_at_ends(&d, &n, degree) {
                    for (a, b) in [(&a, &b), (&b, &a)] {
                        zeros.push(norm(a, b, factor, budget)?);
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
    fn at_ends(&self, p: &Bivariate) -> Vec<UniPoly> {
        let mut out: Vec<UniPoly> = match self.shape {
            Shape::UnitDisc => [2, -2].map(|x| p.eval(&integer(x))).to_vec(),
            Shape::LeftHalfPlane => vec![p.coeff(0)],
        };
        out.extend(p.leading().cloned());
        out.retain(|f| !f.is_zero());
        out
    }

    /// `D0` and `N` at the real ends: a root passes there at the factor `-D0/N`.
    fn values_at_ends(&self, d: &Bivariate, n: &Bivariate, degree: usize) -> Vec<(UniPoly, UniPoly)> {
        let at = |x: i64| (d.eval(&integer(x)), n.eval(&integer(x)));
        let mut out = match self.shape {
            Shape::UnitDisc => vec![at(1), at(-1)],
            Shape::LeftHalfPlane => vec![at(0), (d.coeff(degree), n.coeff(degree))],
        };
        out.retain(|(a, b)| !a.is_zero() && !b.is_zero());
        out
    }
}

fn integer(x: i64) -> UniPoly {
    UniPoly::constant(Integer::from(x))
}

/// The polynomial without what it has in common with all others.
fn without_common(p: &Bivariate, others: &[&Bivariate], budget: &Budget) -> Result<Bivariate, Exhausted> {
    budget.enter(|| {
        let common = others.iter().fold(p.clone(), |g, q| g.gcd(q));
        p.div_exact(&common).expect("a gcd divides").square_free_part()
    })
}

/// The discriminant of a square-free polynomial; 1 where it has at most one root.
fn discriminant_of(p: &Bivariate, budget: &Budget) -> Result<UniPoly, Exhausted> {
    if p.degree().is_none_or(|n| n < 2) { Ok(UniPoly::one()) } else { discriminant(p, budget) }
}

/// The values of the parameter at which `p` and `a + alpha b` have a common root, and more.
fn eliminated(
    p: &Bivariate,
    a: &Bivariate,
    b: &Bivariate,
    alpha: &RealAlgebraic,
    budget: &Budget,
) -> Result<UniPoly, Exhausted> {
    if p.is_constant() {
        return Ok(UniPoly::one());
    }
    if let Some(alpha) = alpha.exact() {
        let with =
            a.scaled(&UniPoly::constant(alpha.denominator())).plus(&b.scaled(&UniPoly::constant(alpha.numerator())));
        return resultant(p, &with, budget);
    }
    let lift = |p: &Bivariate| p.map(|c| MultiPoly::from_univariate(c, 0));
    let with = lift(a).plus(&lift(b).scaled(&MultiPoly::variable(1)));
    let value = resultant(&lift(p), &with, budget)?;
    norm_of(&value, alpha, budget)
}

/// The norm of `a + alpha b`.
fn norm(a: &UniPoly, b: &UniPoly, alpha: &RealAlgebraic, budget: &Budget) -> Result<UniPoly, Exhausted> {
    if let Some(alpha) = alpha.exact() {
        return Ok(a.scaled(&alpha.denominator()).plus(&b.scaled(&alpha.numerator())));
    }
    let lift = |p: &UniPoly| MultiPoly::from_univariate(p, 0);
    norm_of(&lift(a).plus(&lift(b).times(&MultiPoly::variable(1))), alpha, budget)
}

/// The resultant with the polynomial of `alpha`, the variable 1.
fn norm_of(value: &MultiPoly, alpha: &RealAlgebraic, budget: &Budget) -> Result<UniPoly, Exhausted> {
    let in_alpha = value.as_poly_in(1);
    let polynomial = alpha.polynomial().map(|c| MultiPoly::constant(c.clone()));
    let left = if in_alpha.is_constant() { in_alpha.coeff(0) } else { resultant(&in_alpha, &polynomial, budget)? };
    Ok(left.to_univariate(0).expect("the parameter is left"))
}

impl Boundaries {
    /// No value at all.
    pub fn none() -> Boundaries {
        Boundaries { zeros: Vec::new(), values: Vec::new(), touches: UniPoly::one() }
    }
}
