//! For which values of a parameter a loop is stable and meets its requirements.

use super::crossings::Crossings;
use super::margins::StableMargins;
use super::open_loop::OpenLoop;
use super::place::{modulus_squared, product};
use super::requirement::{Requirement, sector_in_parameter};
use crate::answer::{Answer, Verdict};
use crate::error::{Diagnostic, Error};
use crate::model::{Cut, Opened};
use crate::problem::Problem;
use crate::stability::{End, Shape, boundary_polynomials};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, SquareFree, UniPoly, discriminant, isolate_real_roots,
    rational_between, resultant,
};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// Polynomials in the frequency's variable over those in the parameter.
type Bivariate = Poly<UniPoly>;

/// The values of one parameter for which a loop is stable and meets all its requirements.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct RequiredSet {
    /// The intervals, ascending.
    pub intervals: Vec<RequiredInterval>,
}

/// An interval; `None` is an infinite end.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequiredInterval {
    /// The lower end.
    pub lower: Option<RequiredEnd>,
    /// The upper end.
    pub upper: Option<RequiredEnd>,
}

/// An end: of stability, or where a requirement binds.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "there are few of them, and most are the large one")]
pub enum RequiredEnd {
    /// Stability ends, or the domain does.
    Stability(End),
    /// A requirement is not met beyond.
    Requirement {
        /// The value.
        value: RealAlgebraic,
        /// The names of all that are not met beyond.
        names: Vec<&'static str>,
        /// Whether they are met at the value itself.
        closed: bool,
    },
}

impl RequiredEnd {
    /// The value.
    pub fn value(&self) -> Real {
        match self {
            RequiredEnd::Stability(end) => end.value.clone(),
            RequiredEnd::Requirement { value, .. } => value.clone().into(),
        }
    }
}

/// The open loop with the parameter left in it.
struct Family {
    denominator: Bivariate,
    numerator: Bivariate,
    shape: Shape,
    sample_time: Option<Rational>,
    cut: Cut,
    /// Where the open loop is undefined.
    undefined: UniPoly,
}

/// A requirement at a point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequirementMet {
    /// What is required.
    pub requirement: Requirement,
    /// The margins of a stable loop, where a requirement is about them.
    pub margins: Option<StableMargins>,
    /// Whether it is met; never by a loop that is not stable.
    pub met: bool,
}

fn no_damping() -> Error {
    let error = Diagnostic::error("E-require", "a damping is required of continuous loops only");
    error.help("in discrete time ask for a radius").into()
}

/// Polynomials in the parameter, at whose zeros a requirement may begin or cease to be met.
struct Boundaries {
    /// All of them.
    zeros: Vec<UniPoly>,
    /// Where a crossing may appear at once: not known by continuity.
    touches: UniPoly,
}

impl Problem {
    /// For which values of the one free parameter the loop is stable and meets the requirements, margins being taken at a cut.
    ///
    /// A margin changes from met to not met only where a crossing of the open loop passes the required value, where crossings
    /// appear or vanish (the discriminant), or where one enters the range of frequencies at its ends: zeros of resultants in
    /// the parameter. One rational value between two neighbours is decided exactly.
    ///
    /// Cost: that of [`Problem::stable_set`], a few resultants for each requirement in polynomials of the order's degree, and one
    /// computation of each margin in each cell.
    ///
    /// # Errors
    /// [`Error::Refused`] as [`OpenLoop::of`], and `E-require` for a requirement that is not decided for such a loop; [`Error::Stopped`].
    ///
    /// # Panics
    /// Unless one parameter is free.
    pub fn required_set(
        self: &Arc<Self>,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Answer<RequiredSet>, Error> {
        budget.enter(|| {
            let stable = self.stable_set(budget)?.into_value();
            let family = match requirements.iter().any(Requirement::needs_cut) {
                true => Some(Family::of(self, at, budget)?),
                false => None,
            };
            budget.step("boundaries of the requirements");
            let mut boundaries = Vec::new();
            for requirement in requirements {
                boundaries.push(self.boundaries(requirement, family.as_ref(), budget)?);
            }
            let mut intervals = Vec::new();
            let is_algebraic = |end: &Option<End>| end.as_ref().is_none_or(|end| end.value.algebraic().is_some());
            let all_algebraic = stable.intervals().iter().all(|i| is_algebraic(&i.lower) && is_algebraic(&i.upper));
            if !all_algebraic || !stable.undecided().is_empty() {
                let message = "requirements on margins are decided for loops with algebraic limits only";
                return Err(Diagnostic::error("E-require", message).into());
            }
            for interval in stable.intervals() {
                budget.step("testing a sample of each cell");
                let cells =
                    Cells { problem: self, requirements, boundaries: &boundaries, family: family.as_ref(), budget };
                intervals.extend(cells.within(interval.lower.as_ref(), interval.upper.as_ref())?);
            }
            Ok(Answer::new(Arc::clone(self), RequiredSet { intervals }))
        })?
    }

    /// Whether the loop is stable and meets each requirement, with every parameter at its set or nominal value.
    ///
    /// Cost: that of each margin.
    ///
    /// # Errors
    /// As [`Problem::margins`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn requirements_met(
        self: &Arc<Self>,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Vec<RequirementMet>, Error> {
        if requirements.is_empty() {
            return Ok(Vec::new());
        }
        budget.enter(|| {
            let stable = self.verdict(budget)?.value().verdict == Verdict::Stable;
            let open_loop = match requirements.iter().any(Requirement::needs_cut) {
                true => Some(OpenLoop::of(self, at, budget)?),
                false => None,
            };
            let closed = self.parametric(budget)?.map(|p| p.specialised(&Rational::ZERO)).unwrap_or_else(UniPoly::zero);
            let margins = match &open_loop {
                Some(open_loop) if stable => {
                    let crossings = Crossings::of(open_loop, budget)?;
                    Some(StableMargins::of(open_loop, &crossings, &Rational::ZERO, budget)?)
                }
                _ => None,
            };
            let mut out = Vec::with_capacity(requirements.len());
            for requirement in requirements {
                if matches!(requirement, Requirement::Damping(_)) && self.shape() == Shape::UnitDisc {
                    return Err(no_damping());
                }
                let met = stable && requirement.is_met(open_loop.as_ref(), &closed, self.shape(), budget)?;
                out.push(RequirementMet { requirement: requirement.clone(), margins: margins.clone(), met });
            }
            Ok(out)
        })?
    }

    fn boundaries(
        &self,
        requirement: &Requirement,
        family: Option<&Family>,
        budget: &Budget,
    ) -> Result<Boundaries, Error> {
        let undecided = || {
            let message = format!("the requirement {} is not decided for this loop", requirement.name());
            Error::from(
                Diagnostic::error("E-require", message).help("a polynomial of its boundary vanishes for every value"),
            )
        };
        let found = match (requirement, family) {
            (Requirement::Damping(least), _) => {
                if self.shape() == Shape::UnitDisc {
                    return Err(no_damping());
                }
                let Some(p) = self.parametric(budget)? else { return Err(undecided()) };
                let sector = sector_in_parameter(p, least);
                let Some(found) = boundary_polynomials(&sector, self.shape(), budget)? else { return Err(undecided()) };
                let zeros = found.into_iter().map(|b| b.polynomial.poly().clone()).collect();
                Boundaries { zeros, touches: UniPoly::one() }
            }
            (_, None) => return Err(undecided()),
            (requirement, Some(family)) => {
                let mut found = family.boundaries(requirement, budget)?;
                found.zeros.push(family.undefined.clone());
                found
            }
        };
        if found.zeros.iter().any(UniPoly::is_zero) || found.touches.is_zero() { Err(undecided()) } else { Ok(found) }
    }
}

impl Family {
    fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<Family, Error> {
        let cut = problem.model().cut(at)?;
        if let Cut::Gain(name) = &cut {
            let message = format!("requirements on margins need a cut at a signal, and '{name}' is a parameter");
            return Err(Diagnostic::error("E-require", message).into());
        }
        let kept = [problem.parameter().name.clone()];
        let Opened { system, sample_time } = problem.model().opened(&cut, &kept, problem.set(), budget)?;
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
    fn at(&self, value: &Rational) -> OpenLoop {
        let part = |p: &Bivariate| p.coeffs().iter().map(|c| c.eval_rational(value)).collect::<Vec<_>>();
        let (denominator, numerator) = super::open_loop::integral(part(&self.denominator), part(&self.numerator));
        OpenLoop::from_parts(self.cut.clone(), denominator, numerator, self.shape, self.sample_time.clone())
    }

    fn boundaries(&self, requirement: &Requirement, budget: &Budget) -> Result<Boundaries, Exhausted> {
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
                Boundaries { zeros, touches: UniPoly::one() }
            }
            Requirement::PhaseMargin { twice_cosine, .. } => {
                // Modulus one, and the real part is minus the cosine: twice_real + 2 cos |D0|^2 = 0.
                let excess = squared(&n).minus(&below);
                let excess = without_common(&excess, &[&below, &twice_real], budget)?;
                let mut zeros = self.at_ends(&excess);
                zeros.push(eliminated(&excess, &twice_real, &below, twice_cosine, budget)?);
                let touches = discriminant_of(&excess, budget)?;
                zeros.push(touches.clone());
                Boundaries { zeros, touches }
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
                Boundaries { zeros, touches }
            }
            Requirement::Damping(_) => Boundaries { zeros: Vec::new(), touches: UniPoly::one() },
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

/// What is asked in each cell.
struct Cells<'a> {
    problem: &'a Problem,
    requirements: &'a [Requirement],
    boundaries: &'a [Boundaries],
    family: Option<&'a Family>,
    budget: &'a Budget,
}

impl Cells<'_> {
    /// The names of what is not met at a stable value.
    fn unmet(&self, value: &Rational) -> Result<Vec<&'static str>, Error> {
        let open_loop = self.family.map(|f| f.at(value));
        let closed = self.problem.parametric(self.budget)?.map(|p| p.specialised(value)).unwrap_or_else(UniPoly::zero);
        let mut out = Vec::new();
        for requirement in self.requirements {
            if !requirement.is_met(open_loop.as_ref(), &closed, self.problem.shape(), self.budget)? {
                out.push(requirement.name());
            }
        }
        Ok(out)
    }

    /// The parts of a stable interval in which everything is met.
    fn within(&self, lower: Option<&End>, upper: Option<&End>) -> Result<Vec<RequiredInterval>, Error> {
        let number = |end: Option<&End>| end.and_then(|end| end.value.algebraic()).cloned();
        let (least, most) = (number(lower), number(upper));
        let mut zeros: Vec<RealAlgebraic> = Vec::new();
        for f in self.boundaries.iter().flat_map(|b| &b.zeros) {
            let Some(f) = self.budget.enter(|| SquareFree::part_of(f))? else { continue };
            zeros.extend(isolate_real_roots(&f, self.budget)?);
        }
        self.budget.enter(|| {
            zeros.retain(|x| {
                least.as_ref().is_none_or(|l| x.compare(l).is_gt())
                    && most.as_ref().is_none_or(|u| x.compare(u).is_lt())
            });
            zeros.sort_by(RealAlgebraic::compare);
            zeros.dedup_by(|a, b| a.compare(b).is_eq());
        })?;
        let mut cells = Vec::with_capacity(zeros.len() + 1);
        for i in 0..=zeros.len() {
            self.budget.check()?;
            let below = if i == 0 { least.as_ref() } else { Some(&zeros[i - 1]) };
            let above = zeros.get(i).or(most.as_ref());
            let sample = match (below, above) {
                (Some(a), Some(b)) => rational_between(a, b).expect("they differ"),
                (Some(a), None) => a.rational_above(),
                (None, Some(b)) => b.rational_below(),
                (None, None) => Rational::ZERO,
            };
            cells.push(self.unmet(&sample)?);
        }
        let mut out: Vec<RequiredInterval> = Vec::new();
        let stability = |end: Option<&End>| end.cloned().map(RequiredEnd::Stability);
        let mut begun: Option<Option<RequiredEnd>> = cells[0].is_empty().then(|| stability(lower));
        for (i, zero) in zeros.iter().enumerate() {
            let (before, after) = (&cells[i], &cells[i + 1]);
            match (before.is_empty(), after.is_empty()) {
                (true, false) => {
                    let upper = Some(self.end(zero, after)?);
                    out.push(RequiredInterval { lower: begun.take().expect("an interval has begun"), upper });
                }
                (false, true) => begun = Some(Some(self.end(zero, before)?)),
                (true, true) => {
                    // A rational value between two cells is decided like any other.
                    let unmet = match zero.exact() {
                        Some(value) => self.unmet(&value)?,
                        None => Vec::new(),
                    };
                    if !unmet.is_empty() {
                        let end = RequiredEnd::Requirement { value: zero.clone(), names: unmet, closed: false };
                        let lower = begun.replace(Some(end.clone())).expect("an interval has begun");
                        out.push(RequiredInterval { lower, upper: Some(end) });
                    }
                }
                (false, false) => {}
            }
        }
        if let Some(lower) = begun {
            out.push(RequiredInterval { lower, upper: stability(upper) });
        }
        Ok(out)
    }

    /// The end at a zero beyond which some are not met. A modulus margin and a damping are continuous where the loop is stable,
    /// and so is a phase margin unless a crossing appears; a gain margin asks for stability at its own ends too.
    fn end(&self, zero: &RealAlgebraic, names: &[&'static str]) -> Result<RequiredEnd, Error> {
        let unmet = |r: &Requirement| names.contains(&r.name());
        let mut closed = true;
        for (requirement, boundary) in self.requirements.iter().zip(self.boundaries).filter(|(r, _)| unmet(r)) {
            closed &= match requirement {
                Requirement::GainMargin { .. } => false,
                Requirement::PhaseMargin { .. } => self.budget.enter(|| zero.sign_of(&boundary.touches).is_ne())?,
                Requirement::ModulusMargin(_) | Requirement::Damping(_) => true,
            };
        }
        Ok(RequiredEnd::Requirement { value: zero.clone(), names: names.to_vec(), closed })
    }
}
