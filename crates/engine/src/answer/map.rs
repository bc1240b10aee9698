//! The stable region in two parameters.

use super::{Answer, MapLimit, RegionExtent};
use crate::error::{Code, Diagnostic, Error};
use crate::problem::{Problem, Question};
use crate::response::RequiredMap;
use crate::stability::Causes;
use crate::stability::plane::{StabilityMap, stability_map, vanishing_boundary};
use crate::stability::{Range, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// For which values of two parameters the loop is stable, and what is exactly known beside it.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .characteristic("z^2 + a*z + b")
///     .build()?;
/// let answer = model.ask().free("a").free("b").map(6, &Budget::unlimited())?;
/// let map = answer.value();
/// assert_eq!(map.decomposition.regions.len(), 1); // the triangle of stable z^2 + a z + b
/// let greatest_a = map.limits()[0].ends[0][1].as_ref().unwrap();
/// assert_eq!(greatest_a.limit.value.decimal(6), "2");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Map {
    /// The exact decomposition of the domain.
    pub decomposition: StabilityMap,
    /// What limits each region; stopped where the budget ended before.
    pub limits: Result<Vec<RegionExtent>, Exhausted>,
    /// The stable sets on the lines through the nominal point, with their questions, as far as the budget allowed.
    pub slices: Vec<(Arc<Problem>, StableSet)>,
    /// Why the loop is stable at no point of the plane: `undefined`, or the name of the boundary polynomial that vanishes
    /// identically. `None` where that is not so.
    pub never_stable_cause: Option<&'static str>,
    /// Where requirements are met, if something is required.
    pub required: Option<RequiredMap>,
}

impl Map {
    /// What limits each region; nothing where that was not decided.
    pub fn limits(&self) -> &[RegionExtent] {
        self.limits.as_deref().unwrap_or_default()
    }

    /// The limits of all regions, one after the other.
    pub fn all_limits(&self) -> impl Iterator<Item = &MapLimit> {
        self.limits().iter().flat_map(|extent| extent.ends.iter().flatten().flatten())
    }
}

impl Question {
    /// The exact stable region in the plane of the two free parameters, all others at their set or nominal values.
    /// Places and frequencies of what limits the regions are enclosed to about so many digits.
    ///
    /// Cost: that of [`Problem::map`].
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`], or stopped.
    pub fn map(self, digits: usize, budget: &Budget) -> Result<Answer<Map>, Error> {
        Problem::map(&self.plane_problem()?, digits, budget)
    }

    /// The problem of a map.
    ///
    /// # Errors
    /// As [`Question::problem`]; `E-usage` where the same name is on both axes.
    pub fn plane_problem(self) -> Result<Arc<Problem>, Error> {
        if let [x, y] = self.free_names()
            && x == y
        {
            return Err(Diagnostic::error(Code::Usage, format!("'{x}' is asked for on both axes"))
                .help("name two different parameters with '-x' and '-y'")
                .into());
        }
        self.problem()
    }
}

impl Problem {
    /// The domains of the two free parameters.
    pub(super) fn domains(&self) -> [Range; 2] {
        [self.free()[0].domain.clone(), self.free()[1].domain.clone()]
    }

    /// The exact stable region in the plane of the two free parameters. A loop that is undefined for all values of both is
    /// stable nowhere.
    ///
    /// Cost: with `D` the total degree of the boundary curves, up to `O(D^2)` critical values, the real zeros of
    /// discriminants and resultants of the curves ([Collins1975](jurist_algebra::bibliography#collins1975),
    /// [McCallum1998](jurist_algebra::bibliography#mccallum1998)), whose square-free factors are found without them
    /// ([`resultant_square_free_decomposition`](jurist_algebra::poly::resultant_square_free_decomposition)); in each strip between them the zeros of the
    /// curves on one line are isolated, and one root count decides each of up to `O(D)` cells. Where there is a
    /// stable region all this is done once more with the parameters exchanged, and lines and boxes are narrowed
    /// around each of its extreme values.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out before the decomposition.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn map(self: &Arc<Self>, digits: usize, budget: &Budget) -> Result<Answer<Map>, Error> {
        budget.enter(|| {
            let decomposition = self.decomposed(budget)?;
            self.described(decomposition, digits, budget)
        })?
    }

    /// The exact decomposition alone.
    pub(super) fn decomposed(&self, budget: &Budget) -> Result<StabilityMap, Error> {
        let mut map = match self.plane_over_symbols(budget)? {
            None => StabilityMap::never_stable(),
            Some(p) => stability_map(p, &self.domains(), self.shape(), budget)?,
        };
        if self.is_complex() {
            // Each root was counted with its conjugate.
            map.strips.iter_mut().flat_map(|strip| &mut strip.cells).for_each(|cell| cell.outside /= 2);
        }
        Ok(map)
    }

    /// The answer around a decomposition.
    pub(super) fn described(
        self: &Arc<Self>,
        decomposition: StabilityMap,
        digits: usize,
        budget: &Budget,
    ) -> Result<Answer<Map>, Error> {
        let never_stable_cause = match self.plane_over_symbols(budget)? {
            _ if !decomposition.never_stable => None,
            None => Some("undefined"),
            Some(p) => vanishing_boundary(p, self.shape(), budget)?.map(crate::stability::Cause::name),
        };
        let limits = Ok(Vec::new());
        let map = Map { decomposition, limits, slices: Vec::new(), never_stable_cause, required: None };
        let mut answer = Answer::new(Arc::clone(self), map);
        answer.value.limits = answer.region_extents(digits, budget);
        if self.is_complex() {
            let curves = answer.value.decomposition.curves.iter_mut().map(|curve| &mut curve.causes);
            let extents = answer.value.limits.iter_mut().flatten().flat_map(|extent| &mut extent.ends);
            let limits = extents.flatten().flatten().map(|end| &mut end.limit.causes);
            curves.chain(limits).for_each(Causes::of_complex_loop);
        }
        answer.value.slices = [0, 1].into_iter().filter_map(|fixed| answer.nominal_slice(fixed, budget)).collect();
        Ok(answer)
    }
}

impl Answer<Map> {
    /// The stable set on the line through the nominal value of one parameter; `None` without that or within no budget.
    fn nominal_slice(&self, fixed: usize, budget: &Budget) -> Option<(Arc<Problem>, StableSet)> {
        let value: &Rational = self.problem.free()[fixed].nominal.as_ref()?;
        let answer = self.slice(fixed, value, budget).ok()?;
        Some((Arc::clone(answer.problem()), answer.into_value()))
    }
}
