//! For which values of two parameters a loop is stable and meets its requirements.

use super::family::{Family, Parameters};
use super::met::AtPoint;
use super::on_roots::OnRoots;
use super::requirement::{Requirement, Rule};
use crate::answer::{Answer, Map};
use crate::coverage::CoefficientRing;
use crate::coverage::refusals::NOT_IN_A_PLANE;
use crate::error::{Code, Diagnostic, Error};
use crate::problem::Problem;
use crate::stability::plane::{Asked, PlanePolynomial, StabilityMap, layers};
use crate::stability::{Shape, SymbolicPolynomial};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, resultant};
use jurist_algebra::symbols::Symbols;
use std::sync::Arc;

/// Where in a plane requirements are met: for each alone, and for all together.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequiredMap {
    /// What is required.
    pub requirements: Vec<Requirement>,
    /// Where margins are taken, as it was asked for.
    pub at: Option<String>,
    /// The regions of each requirement alone in the same order; of two and more then those of all together.
    pub regions: Vec<RequiredRegions>,
}

/// The regions in which some requirements are met.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequiredRegions {
    /// The numbers of the requirements.
    pub requirements: Vec<usize>,
    /// The decomposition in which the cells that meet them are the stable ones. Curves inside a region are no boundaries of it,
    /// and their points are not decided.
    pub map: StabilityMap,
}

impl RequiredMap {
    /// The numbers of the requirements that are met in a cell, given by its strip and its number.
    pub fn met(&self, (strip, cell): (usize, usize)) -> Vec<usize> {
        let meets = |k: &usize| self.regions[*k].map.strips[strip].cells[cell].stable;
        (0..self.requirements.len()).filter(meets).collect()
    }

    /// The regions in which all is met.
    pub fn all(&self) -> &RequiredRegions {
        self.regions.last().expect("something is required")
    }
}

impl Answer<Map> {
    /// The map with the regions inside the stable ones in which requirements are met, margins being taken at a cut.
    ///
    /// What is required changes from met to not met only on curves: where a crossing of the open loop has the required
    /// value, where crossings appear or vanish (a discriminant), where one enters the range of frequencies at its ends, where a root
    /// is on the sector's edge. Together with the boundary curves they cut the plane into cells, and one rational point of
    /// each stable one is decided exactly.
    ///
    /// Cost: that of [`Problem::map`] with these curves, whose degrees are a few times those of the stability boundary,
    /// twice those where the required number is not rational.
    ///
    /// # Errors
    /// [`Error::Refused`] as for [`Problem::required_set`]; [`Error::Stopped`].
    pub fn with_requirements(
        self,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Answer<Map>, Error> {
        let problem = self.problem().clone();
        problem.refuse_complex_requirements(budget)?;
        let found = budget.enter(|| problem.required_map(requirements, at, budget))??;
        let mut map = self.into_value();
        map.required = Some(found);
        Ok(Answer::new(problem, map))
    }
}

fn not_in_a_plane(requirement: &Requirement) -> Error {
    let help = match requirement.rule() {
        Rule::Sector(_) | Rule::Modulus { .. } | Rule::DeadTime(_) => {
            "its curve is not algebraic: ask for boxes, '--method boxes' with windows of both axes"
        }
        _ => "ask 'verdict' with a value for every parameter",
    };
    NOT_IN_A_PLANE.diagnostic(&[("name", requirement.name()), ("help", help)]).into()
}

impl Problem {
    fn required_map(
        self: &Arc<Self>,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<RequiredMap, Error> {
        let mut sets: Vec<Vec<usize>> = (0..requirements.len()).map(|k| vec![k]).collect();
        if requirements.len() > 1 {
            sets.push((0..requirements.len()).collect());
        }
        let found = |maps: Vec<StabilityMap>| RequiredMap {
            requirements: requirements.to_vec(),
            at: at.map(str::to_owned),
            regions: sets
                .iter()
                .cloned()
                .zip(maps)
                .map(|(requirements, map)| RequiredRegions { requirements, map })
                .collect(),
        };
        Requirement::refuse_signals(requirements)?;
        let whole = self.without_region();
        let (Some(p), Some(plain)) = (self.plane_over_symbols(budget)?, whole.plane_over_symbols(budget)?) else {
            return Ok(found(sets.iter().map(|_| StabilityMap::never_stable()).collect()));
        };
        let family: Option<Family<MultiPoly>> = match requirements.iter().any(Requirement::needs_cut) {
            true => Some(Family::of(self, at, budget)?),
            false => None,
        };
        let symbols = Arc::new(self.fixed_symbols(budget)?);
        if family.as_ref().is_some_and(|family| family.symbols != symbols) {
            return Err(CoefficientRing::Constants.not_rational(self.algebra_over_symbols(budget)?.symbols()).into());
        }
        budget.step("boundaries of the requirements");
        let mut curves = Vec::new();
        for requirement in requirements {
            curves.extend(self.curves_of(requirement, family.as_ref(), plain.polynomial(), budget)?);
        }
        let met = |point: &[Rational; 2]| -> Result<Vec<bool>, Exhausted> {
            let open_loop = family.as_ref().map(|f| f.at(point));
            let mut here = open_loop.as_ref().map(AtPoint::new);
            let met = |r: &Requirement| match (&mut here, r.needs_cut()) {
                (Some(here), true) => here.meets(r, budget),
                _ => {
                    let closed = closed_at(plain, &symbols, point);
                    OnRoots::of(r, &closed, self.shape()).expect("all is known").is_met_at(&Rational::ZERO, budget)
                }
            };
            requirements.iter().map(met).collect()
        };
        let asked = Asked { curves, met: &met, sets: &sets };
        let domains = [self.free()[0].domain.clone(), self.free()[1].domain.clone()];
        Ok(found(layers(p, &asked, &domains, self.shape(), budget)?))
    }

    /// The curves on which a requirement may begin or cease to be met.
    fn curves_of(
        &self,
        requirement: &Requirement,
        family: Option<&Family<MultiPoly>>,
        closed: &jurist_algebra::poly::Poly<MultiPoly>,
        budget: &Budget,
    ) -> Result<Vec<MultiPoly>, Error> {
        let mut found = match (requirement.rule(), family) {
            (Rule::Sector(_), _) if self.shape() == Shape::UnitDisc => return Err(not_in_a_plane(requirement)),
            (Rule::Sector(least), _) => {
                let [first, second] = crate::stability::sector::on_sector_edge(closed, least);
                // A root at 0 or at infinity is on the boundary of stability.
                vec![resultant(&first, &second, budget)?]
            }
            (Rule::Factors(_) | Rule::Turned { .. } | Rule::Circle(_), Some(f)) => {
                let mut found = f.boundaries(requirement, budget)?.zeros;
                found.push(f.undefined.clone());
                found
            }
            _ => return Err(not_in_a_plane(requirement)),
        };
        if found.iter().any(Domain::is_zero) {
            let message = format!("the requirement {} is not decided for this loop", requirement.name());
            let error = Diagnostic::error(Code::Require, message);
            return Err(error.help("a polynomial of its boundary vanishes for all values").into());
        }
        found.retain(|f| !f.is_constant());
        Ok(found)
    }
}

/// The closed loop at a point of the plane.
fn closed_at(plane: &PlanePolynomial, symbols: &Arc<Symbols>, point: &[Rational; 2]) -> SymbolicPolynomial {
    let coefficients = <MultiPoly as Parameters>::at_point(plane.polynomial().coeffs(), point);
    let beside = coefficients.into_iter().map(|c| c.map_variables(|i| i + 1)).collect();
    let polynomial = Poly::new(beside);
    let degree = plane.formal_degree();
    SymbolicPolynomial::from_parts(symbols, polynomial.clone(), polynomial.coeff(degree), degree, Vec::new())
}
