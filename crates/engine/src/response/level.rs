//! Numbers of a loop that are to be as good as possible: requirements whose number is not given.

use super::boundaries::Elimination;
use super::disk::degrees;
use super::family::Family;
use super::margins::Margins;
use super::required_set::not_decided;
use super::requirement::{Circle, Found, Requirement, Rule};
use crate::error::Error;
use crate::model::{Between, Time};
use crate::problem::{Ask, DECAY, Problem, RADIUS, Region};
use crate::stability::Shape;
use crate::stability::plane::{PlanePolynomial, boundary_curves};
use crate::stability::sector::{on_edge_of, on_sector_edge};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic, resultant};
use jurist_algebra::real::Real;
use std::cmp::Ordering;
use std::sync::Arc;

/// A number of a stable loop that can be required and made as good as possible.
///
/// It has a *scale*, in which its boundary is algebraic: a factor, a share, a rate, and of the phase margin twice the cosine.
///
/// ```
/// use jurist_engine::response::Level;
/// let names: Vec<&str> = Level::ALL.iter().map(|level| level.name()).collect();
/// assert!(names.contains(&"modulus_margin") && names.contains(&"decay"));
/// assert!(Level::named("phase_margin").unwrap().is_greatest_best());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The decay rate of all roots, in continuous time.
    Decay,
    /// The greatest modulus of a root, in discrete time.
    Radius,
    /// The least damping of a root.
    Damping,
    /// The gain margin both ways, as a factor.
    GainMargin,
    /// The phase margin; its scale is twice the cosine.
    PhaseMargin,
    /// The least `|1 + L|`.
    ModulusMargin,
    /// The greatest `|L/(1 + L)|`; its scale is the inverse.
    ComplementaryPeak,
    /// The balanced disk margin; its scale is half of it.
    DiskMargin,
    /// The delay margin, in continuous time.
    DelayMargin,
    /// The peak gain of a transfer function of the closed loop; its scale is the inverse.
    Norm,
}

/// A level with its number: a smaller region, or a requirement.
#[derive(Clone, Debug)]
pub enum LevelAsked {
    /// All roots lie in it.
    Region(Region),
    /// It is met.
    Requirement(Requirement),
}

impl Level {
    /// All levels that are asked for by their names alone.
    pub const ALL: [Level; 9] = [
        Level::Decay,
        Level::Radius,
        Level::Damping,
        Level::GainMargin,
        Level::PhaseMargin,
        Level::ModulusMargin,
        Level::ComplementaryPeak,
        Level::DiskMargin,
        Level::DelayMargin,
    ];

    /// Its name: that of the requirement.
    pub fn name(self) -> &'static str {
        match self {
            Level::Decay => DECAY,
            Level::Radius => RADIUS,
            Level::Damping => "damping",
            Level::GainMargin => "gain_margin",
            Level::PhaseMargin => "phase_margin",
            Level::ModulusMargin => "modulus_margin",
            Level::ComplementaryPeak => "complementary_peak",
            Level::DiskMargin => "disk_margin",
            Level::DelayMargin => "delay_margin",
            Level::Norm => "norm",
        }
    }

    /// The level of a name.
    pub fn named(name: &str) -> Option<Level> {
        Level::ALL.into_iter().find(|level| level.name() == name)
    }

    /// Whether more of it is better.
    pub fn is_greatest_best(self) -> bool {
        !matches!(self, Level::Radius | Level::ComplementaryPeak | Level::Norm)
    }

    /// Whether it is better where its scale is greater.
    pub fn is_rising(self) -> bool {
        !matches!(self, Level::Radius | Level::PhaseMargin)
    }

    /// Whether it belongs to loops of this kind of time.
    pub fn fits(self, time: Time) -> bool {
        match self {
            Level::Decay => time == Time::Continuous,
            Level::Radius => time == Time::Discrete,
            // In discrete time its boundary is not algebraic, and nothing bounds the search.
            Level::Damping => time == Time::Continuous,
            // There it is counted in samples.
            Level::DelayMargin => time == Time::Continuous,
            _ => true,
        }
    }

    /// Between which values of its scale it lies; `None` is infinity.
    pub fn scale(self) -> [Rational; 2] {
        let far = || Rational::from(FAR);
        match self {
            Level::Decay => [Rational::ZERO, far()],
            Level::Radius | Level::Damping => [Rational::ZERO, Rational::ONE],
            Level::GainMargin => [Rational::ONE, far()],
            Level::PhaseMargin => [Rational::from(-2), Rational::from(2)],
            Level::ModulusMargin | Level::ComplementaryPeak | Level::DiskMargin | Level::DelayMargin | Level::Norm => {
                [Rational::ZERO, far()]
            }
        }
    }

    /// What asks for at least this value of the scale, strictly between its ends.
    ///
    /// # Errors
    /// `E-require` for a value that is not strictly between them.
    pub fn asked(self, scale: &Rational) -> Result<LevelAsked, Error> {
        self.asked_between(scale, None)
    }

    /// The same of a level that is between two signals.
    ///
    /// # Errors
    /// As [`Level::asked`], and of a peak gain without signals.
    pub fn asked_between(self, scale: &Rational, between: Option<&Between>) -> Result<LevelAsked, Error> {
        let not_above_zero = || super::requirement::not_understood(self.name(), "above 0");
        Ok(match self {
            Level::Decay => LevelAsked::Region(Region::half_plane(scale.clone())),
            Level::Radius => LevelAsked::Region(Region::disc(scale.clone())?),
            Level::Damping => LevelAsked::Requirement(Requirement::damping(scale.clone())?),
            Level::GainMargin => LevelAsked::Requirement(Requirement::gain_margin(scale)?),
            Level::PhaseMargin => LevelAsked::Requirement(Requirement::phase_margin_by_cosine(scale)?),
            Level::ModulusMargin => LevelAsked::Requirement(Requirement::modulus_margin(scale.clone())?),
            Level::ComplementaryPeak => {
                LevelAsked::Requirement(Requirement::complementary_peak(scale.recip().ok_or_else(not_above_zero)?)?)
            }
            Level::Norm => {
                let needs = || super::requirement::not_understood(self.name(), "needs an input and an output");
                let between = between.ok_or_else(needs)?;
                let peak = scale.recip().ok_or_else(not_above_zero)?;
                LevelAsked::Requirement(Requirement::norm(between.clone(), peak)?)
            }
            Level::DiskMargin => LevelAsked::Requirement(Requirement::disk_margin(scale + scale)?),
            Level::DelayMargin => LevelAsked::Requirement(Requirement::delay_margin(scale.clone())?),
        })
    }

    /// The level that a value of its scale is, enclosed: degrees of a phase margin; `None` where it is not finite.
    pub fn enclosure(self, scale: &Enclosure, bits: u64) -> Option<Enclosure> {
        let half = || Enclosure::from_rational(Rational::new(1.into(), 2.into()));
        match self {
            Level::PhaseMargin => Some(degrees(&scale.mul(&half(), bits + 8).acos(bits + 8), bits)),
            Level::ComplementaryPeak | Level::Norm => Enclosure::from_rational(Rational::ONE).div(scale, bits),
            Level::DiskMargin => Some(scale.mul(&Enclosure::from_rational(Rational::from(2)), bits)),
            _ => Some(scale.clone()),
        }
    }
}

/// Levels beyond this are not looked for.
const FAR: i64 = 1 << 40;

/// A required number that is a variable: the first one, the parameter being the second.
struct ByLevel;

impl Elimination<MultiPoly> for ByLevel {
    type Left = MultiPoly;

    fn function(&self, f: MultiPoly) -> MultiPoly {
        f
    }

    fn common_root(
        &self,
        p: &Poly<MultiPoly>,
        a: &Poly<MultiPoly>,
        b: &Poly<MultiPoly>,
        _: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<MultiPoly, Exhausted> {
        resultant(p, &a.plus(&b.scaled(&MultiPoly::variable(0))), budget)
    }

    fn sum(&self, a: &MultiPoly, b: &MultiPoly, _: &RealAlgebraic, _: &Budget) -> Result<MultiPoly, Exhausted> {
        Ok(a.plus(&b.times(&MultiPoly::variable(0))))
    }

    fn excess(&self, _: &Circle, sum_squared: &Poly<MultiPoly>, combined_squared: &Poly<MultiPoly>) -> Poly<MultiPoly> {
        let square = MultiPoly::variable(0).times(&MultiPoly::variable(0));
        sum_squared.minus(&combined_squared.scaled(&square))
    }

    fn discriminant(&self, p: &Poly<MultiPoly>, budget: &Budget) -> Result<MultiPoly, Exhausted> {
        jurist_algebra::poly::discriminant(p, budget)
    }
}

/// A polynomial in the parameter as one beside a level's scale.
fn beside(p: &MultiPoly) -> MultiPoly {
    p.map_variables(|_| 1)
}

impl Problem {
    /// Polynomials in a level's scale and in the one free parameter, in this order, on whose zeros alone it may change whether a loop is
    /// stable, has the level and meets the requirements. `None` where the loop is not rational in its parameter, and where a polynomial
    /// vanishes for all values.
    ///
    /// Cost: that of the boundary of a map, and a resultant and a discriminant by the frequency for each requirement and the level.
    ///
    /// # Errors
    /// As [`Problem::required_set`].
    ///
    /// # Panics
    /// Unless one parameter is free.
    pub fn boundary_in_level(
        self: &Arc<Self>,
        (level, between): (Level, Option<&Between>),
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Option<Vec<MultiPoly>>, Error> {
        if !self.algebra_over_symbols(budget)?.symbols().is_empty() {
            return Ok(None);
        }
        budget.enter(|| {
            let mut found = match level.asked_of_roots() {
                true => self.boundary_of_region(level, budget)?,
                false => self.boundary_of_stability(budget)?.map(|list| list.iter().map(beside).collect()),
            };
            let Some(all) = &mut found else { return Ok(None) };
            let asked = match level.asked_between(&level.inside(), between)? {
                LevelAsked::Requirement(requirement) => Some(requirement),
                LevelAsked::Region(_) => None,
            };
            Requirement::refuse_signals(requirements)?;
            let family = self.family_of(requirements.iter().collect(), at, budget)?;
            for requirement in requirements {
                let Some(own) = self.boundaries_of((requirement, false), family.as_ref(), budget)? else {
                    return Ok(None);
                };
                all.extend(own);
            }
            if let Some(asked) = &asked {
                let family = self.family_of(vec![asked], at, budget)?;
                let Some(own) = self.boundaries_of((asked, true), family.as_ref(), budget)? else { return Ok(None) };
                all.extend(own);
            }
            if all.iter().any(Domain::is_zero) {
                return match asked.as_ref().or(requirements.first()) {
                    Some(requirement) => Err(not_decided(requirement)),
                    None => Ok(None),
                };
            }
            all.retain(|p| !p.is_constant());
            Ok(found)
        })?
    }

    /// The open loop at the cut of the first requirement that needs one.
    fn family_of(
        self: &Arc<Self>,
        mut list: Vec<&Requirement>,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Option<Family<MultiPoly>>, Error> {
        list.retain(|requirement| requirement.needs_cut());
        let Some(first) = list.first() else { return Ok(None) };
        Family::of_cut(&self.without_region(), first.cut(self, at)?, budget).map(Some)
    }

    /// The characteristic polynomial, its parameter beside the level's scale.
    fn beside_level(self: &Arc<Self>, budget: &Budget) -> Result<Option<Poly<MultiPoly>>, Error> {
        let plain = self.without_region();
        let polynomial = plain.algebra(budget)?.polynomial().map(PlanePolynomial::new);
        Ok(polynomial.map(|p| p.polynomial().map(beside)))
    }

    /// The boundary of a requirement, or of the level itself, whose scale is the first variable; `None` where there is none of this kind.
    fn boundaries_of(
        self: &Arc<Self>,
        (requirement, is_level): (&Requirement, bool),
        family: Option<&Family<MultiPoly>>,
        budget: &Budget,
    ) -> Result<Option<Vec<MultiPoly>>, Error> {
        match (requirement.rule(), family) {
            (Rule::Sector(least), _) if self.shape() == Shape::LeftHalfPlane => {
                let Some(closed) = self.beside_level(budget)? else { return Ok(None) };
                let [first, second] = match is_level {
                    true => on_edge_of(&closed, [&MultiPoly::variable(0), &MultiPoly::one()]),
                    false => on_sector_edge(&closed, least),
                };
                Ok(Some(vec![resultant(&first, &second, budget)?]))
            }
            (Rule::Factors(_) | Rule::Turned { .. } | Rule::Circle(_), Some(f)) => {
                let mut zeros = match is_level {
                    true => f.quotient().map(beside).boundaries(&ByLevel, requirement, budget)?.zeros,
                    false => f.boundaries(requirement, budget)?.zeros.iter().map(beside).collect(),
                };
                zeros.push(beside(&f.undefined));
                Ok(Some(zeros))
            }
            _ => Ok(None),
        }
    }

    /// The level of a loop in which every parameter has its value, enclosed by so many bits: degrees of a phase margin. `None` where it has no bound,
    /// of a loop that is not stable, and of numbers that are not margins.
    ///
    /// Cost: that of the margins.
    ///
    /// # Errors
    /// As [`Problem::margins`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn level_at(
        self: &Arc<Self>,
        (level, between): (Level, Option<&Between>),
        at: Option<&str>,
        bits: u64,
        budget: &Budget,
    ) -> Result<Option<Enclosure>, Error> {
        if let (Level::Norm, Some(between)) = (level, between) {
            let norm = self.norm(&between.input, &between.output, budget)?.into_value();
            return Ok(budget.enter(|| norm.peak.map(|peak| enclosed(&peak.value, bits)))?);
        }
        let LevelAsked::Requirement(requirement) = level.asked(&level.inside())? else { return Ok(None) };
        if !requirement.needs_cut() {
            return Ok(None);
        }
        let margins = self.margins_with(at, &Rational::ZERO, false, budget)?;
        Ok(budget.enter(|| enclosed_among(&requirement, margins.value(), bits))?)
    }

    /// Where stability may change, in the one free parameter.
    fn boundary_of_stability(self: &Arc<Self>, budget: &Budget) -> Result<Option<Vec<MultiPoly>>, Error> {
        let Some(polynomial) = self.algebra(budget)?.polynomial() else { return Ok(None) };
        let curves = boundary_curves(&PlanePolynomial::new(polynomial), self.shape(), budget)?;
        Ok(curves.map(|curves| curves.into_iter().map(|curve| curve.polynomial).collect()))
    }

    /// Where roots are on the edge of a region whose bound is the first variable.
    fn boundary_of_region(self: &Arc<Self>, level: Level, budget: &Budget) -> Result<Option<Vec<MultiPoly>>, Error> {
        let name = self.parameter().name.clone();
        let question = self.model().ask().set_all(self.set().iter().cloned()).free(name.clone());
        let problem = question.free(level.name()).domain(name, self.parameter().domain.clone()).problem()?;
        let Some(plane) = problem.plane_over_symbols(budget)? else { return Ok(None) };
        let curves = boundary_curves(plane, self.shape(), budget)?;
        // The bound is the first name of such a problem.
        Ok(curves.map(|curves| curves.into_iter().map(|curve| curve.polynomial).collect()))
    }
}

fn enclosed(number: &Real, bits: u64) -> Enclosure {
    let (low, high) = number.refined_to_digits(bits as usize * 3 / 10 + 2).enclosure();
    Enclosure::new(low, high)
}

/// What a requirement is about among the margins of a loop.
fn enclosed_among(requirement: &Requirement, margins: &Margins, bits: u64) -> Option<Enclosure> {
    match requirement.found(margins, margins.stable.as_ref()?)? {
        Found::Number(number) => Some(enclosed(&number, bits)),
        Found::Enclosed(enclose) => enclose(bits),
    }
}

impl Level {
    /// The level among the margins of a loop, enclosed by so many bits: degrees of a phase margin. `None` where it has no bound, of a loop that is not
    /// stable, and of numbers that are not margins.
    pub(super) fn among(self, margins: &Margins, bits: u64) -> Option<Enclosure> {
        let LevelAsked::Requirement(requirement) = self.asked(&self.inside()).ok()? else { return None };
        requirement.needs_cut().then(|| enclosed_among(&requirement, margins, bits))?
    }

    /// Whether it is a bound of the region in which roots lie.
    fn asked_of_roots(self) -> bool {
        matches!(self, Level::Decay | Level::Radius)
    }

    /// A value of the scale strictly between its ends.
    fn inside(self) -> Rational {
        let [low, high] = self.scale();
        let half = Rational::new(1.into(), 2.into());
        match high.cmp(&Rational::from(FAR)) {
            Ordering::Less => (low + high) * half,
            _ => low + Rational::ONE,
        }
    }
}
