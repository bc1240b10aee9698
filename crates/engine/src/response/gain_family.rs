//! An open loop that is a multiple of the one free parameter: `K L`, where `L` does not depend on it.
//!
//! Where a requirement begins or ceases to be met, two conditions on the frequency hold at once. `K` occurs in them to the second power at most, so it is
//! eliminated by hand, and a polynomial in the frequency's variable is left. Its zeros are isolated, and `K` follows from each. The resultants
//! by the frequency that [`SymbolicFamily`](super::over_symbols::SymbolicFamily) takes are determinants with as many rows as twice the order.

use super::candidates::Candidates;
use super::cells::parts_beside;
use super::combined::{Combination, Combined};
use super::enclosed::{enclosed, within};
use super::ground::{Constants, Ground};
use super::margins::GainMargin;
use super::met::AtPoint;
use super::open_loop::{OpenLoop, Over};
use super::parts::Parts;
use super::requirement::{Circle, Requirement, Rule};
use super::value::square_root;
use super::{Frequencies, Place, RequiredSet};
use crate::error::Error;
use crate::model::Cut;
use crate::precisions::SIGN_AT_NUMBER;
use crate::problem::Problem;
use crate::stability::{Range, Shape, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic};
use jurist_algebra::real::Real;

/// The open loop of a discrete loop at `K = 1`.
pub(super) struct GainFamily {
    open_loop: OpenLoop,
}

/// Values at which a requirement may begin or cease to be met, in no order, each with whether a crossing may appear there at once.
type Values = Vec<(Real, bool)>;

impl GainFamily {
    /// `None` where the open loop is no multiple of the parameter, or is rational.
    ///
    /// Cost: that of [`OpenLoop::of`].
    ///
    /// # Errors
    /// As [`OpenLoop::of`].
    pub fn of(problem: &Problem, cut: &Cut, budget: &Budget) -> Result<Option<GainFamily>, Error> {
        let is_signal = matches!(cut, Cut::Signal(_) | Cut::Input(_) | Cut::PlantInput);
        if !is_signal || !problem.model().has_holds() || !is_multiple(problem, cut, budget)? {
            return Ok(None);
        }
        let open_loop = OpenLoop::of_cut(&problem.with_value(&Rational::ONE), cut.clone(), budget)?;
        let is_known = matches!(open_loop.over(), Over::Constants(_))
            && open_loop.frequencies() == Frequencies::Positive(Shape::UnitDisc);
        Ok((is_known && !open_loop.is_zero()).then_some(GainFamily { open_loop }))
    }

    fn parts(&self) -> &Parts<Constants> {
        match self.open_loop.over() {
            Over::Constants(parts) => parts,
            Over::Integers(_) => unreachable!("it is over constants"),
        }
    }

    /// The parts of the stable set in which all requirements are met, none of which is about dead time, and where that is not told.
    ///
    /// Cost: zeros of polynomials of up to four times the order, and each margin in each cell between the values that follow from them.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out, and where something is not told apart.
    pub fn required_set(
        &self,
        requirements: &[Requirement],
        stable: &StableSet,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        let mut values = Vec::with_capacity(requirements.len());
        for requirement in requirements {
            budget.step(requirement.name());
            values.push(self.values(requirement, budget)?);
        }
        for interval in stable.intervals() {
            let mut candidates = Candidates::default();
            for (requirement, values) in requirements.iter().zip(&values) {
                for value in values {
                    candidates.add(requirement, interval, (vec![value.clone()], Vec::new()), budget)?;
                }
            }
            budget.step("testing a sample of each cell");
            let unmet = |value: &Rational| Ok(AtPoint::unmet(&self.open_loop.times(value), requirements, budget)?);
            let cells = |part: &_| candidates.cells(part, requirements, unmet, budget);
            parts_beside(interval, candidates.brackets(), &mut found, cells)?;
        }
        found.sort();
        Ok(found)
    }

    fn values(&self, requirement: &Requirement, budget: &Budget) -> Result<Values, Exhausted> {
        match requirement.rule() {
            Rule::Factors(factor) => self.values_of_factors(factor, budget),
            Rule::Turned { twice_cosine } => self.values_of_turns(twice_cosine, budget),
            Rule::Circle(circle) => self.values_of_circle(circle, budget),
            Rule::Sector(_) | Rule::DeadTime(_) | Rule::Modulus { .. } => Ok(Vec::new()),
        }
    }

    /// The ends of the stable factors, times the required one and divided by it.
    fn values_of_factors(&self, factor: &RealAlgebraic, budget: &Budget) -> Result<Values, Exhausted> {
        let set = GainMargin::of(&self.open_loop, budget)?.set;
        let factor = Real::from(factor.clone());
        let mut out = Vec::new();
        for end in set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            if end.value.exact().is_none_or(|x| !x.is_zero()) {
                out.extend([product(&end.value, &factor), product(&end.value, &factor.recip())].map(|k| (k, false)));
            }
        }
        if !set.undecided().is_empty() {
            // What is not told there is not told of the gain either.
            return Err(SIGN_AT_NUMBER.exhausted("the stable factors"));
        }
        Ok(out)
    }

    /// With `|K L| = 1` the real part is minus the cosine: `T = -alpha K |N|^2` and `K^2 |N|^2 = |D0|^2`, where `T` is twice the real part of `N conj(D0)`. So
    /// `T^2 = alpha^2 |N|^2 |D0|^2`.
    fn values_of_turns(&self, alpha: &RealAlgebraic, budget: &Budget) -> Result<Values, Exhausted> {
        let (parts, r) = (self.parts(), &self.parts().reduced);
        let (ground, range) = (&parts.ground, parts.frequencies().inner());
        let (above, below, real) = (&r.numerator_squared, &r.denominator_squared, &r.twice_real);
        let mut out = Vec::new();
        let is_right = alpha.exact().is_some_and(|x| x.is_zero());
        if is_right {
            for x in ground.zeros(real, &range, budget)? {
                out.extend(self.of_modulus_one(&Place::Inside(x), budget)?.map(|k| (k, false)));
            }
        } else if !real.is_zero() {
            let square = combined(ground, &[above, real, below], Combination::Square(alpha.clone()))?;
            for x in square.zeros(&range, budget)? {
                ground.sign_at(real, &x, budget)?;
                ground.sign_at(above, &x, budget)?;
                let (over, alpha, real, above) =
                    (ground.clone(), Real::from(alpha.clone()), real.clone(), above.clone());
                out.push((
                    enclosed("gain at a required angle", move |bits| {
                        let below = over.at_real(&above, &x, bits).to_enclosure().mul(&within(&alpha, bits), bits);
                        over.at_real(&real, &x, bits).neg().to_enclosure().div(&below, bits)
                    }),
                    false,
                ));
            }
        }
        // Crossings appear at the extremes of the modulus, and at the ends of the range of frequencies.
        let extremes = match above.is_constant() && below.is_constant() {
            true => Vec::new(),
            false => combined(ground, &[below, above], Combination::Slope)?.zeros(&range, budget)?,
        };
        for x in extremes {
            out.extend(self.of_modulus_one(&Place::Inside(x), budget)?.map(|k| (k, true)));
        }
        // At an end the open loop is 1: where it is -1 there, stability ends.
        for end in [1, -1].map(MultiPoly::from) {
            let [below, above] = [&parts.denominator, &parts.numerator].map(|p| p.re.eval(&end));
            if ground.sign(&below, budget)?.is_ne() && ground.sign(&above, budget)?.is_ne() {
                out.push((ground.quotient(&below, &above, budget)?.number(budget)?, false));
            }
        }
        Ok(out)
    }

    /// Both values for which the modulus is one at a frequency; those of an infinite or vanishing open loop are none.
    fn of_modulus_one(&self, place: &Place, budget: &Budget) -> Result<impl Iterator<Item = Real>, Exhausted> {
        let (parts, r) = (self.parts(), &self.parts().reduced);
        let square =
            parts.ground.value(&r.denominator_squared, &r.numerator_squared, place, parts.frequencies(), budget)?;
        let root = match square {
            Some(square) => Some(square_root(&square.number(budget)?, budget)?),
            None => None,
        };
        let root = root.filter(|root| root.exact().is_none_or(|x| !x.is_zero()));
        Ok(root.into_iter().flat_map(|root| [product(&root, &Real::from(-Rational::ONE)), root]))
    }

    /// The excess over a circle is `a K^2 + b K + c` with polynomials in the frequency's variable. It touches zero where its derivative is zero too, or is
    /// zero at an end of the range of frequencies.
    fn values_of_circle(&self, circle: &Circle, budget: &Budget) -> Result<Values, Exhausted> {
        let (parts, r) = (self.parts(), &self.parts().reduced);
        let (ground, range) = (&parts.ground, parts.frequencies().inner());
        let excess = circle.coefficients();
        let [a, b, c] = [(0, &r.numerator_squared), (1, &r.twice_real), (2, &r.denominator_squared)]
            .map(|(i, p)| p.scaled(&MultiPoly::from_integer(&excess[i])));
        let mut out = Vec::new();
        for end in [2, -2] {
            let at = |p: &Poly<MultiPoly>| p.eval(&MultiPoly::from(end));
            let in_gain = Poly::new(vec![at(&c), at(&b), at(&a)]);
            out.extend(ground.zeros(&in_gain, &Range::all(), budget)?);
        }
        let [is_a, is_b, is_c] = [&a, &b, &c].map(|p| !p.is_zero());
        let combined = |list: &[&Poly<MultiPoly>], how| combined(ground, list, how);
        // The polynomial whose zeros are the frequencies, and K as minus the quotient of two.
        let (zeros, above, below) = match (is_a, is_b, is_c) {
            (true, true, true) => {
                let eliminated = combined(&[&a, &b, &c], Combination::Eliminated)?;
                (eliminated, combined(&[&a, &c], Combination::Slope)?, combined(&[&a, &b], Combination::Slope)?)
            }
            // One power less: the quotient of two has an extreme.
            (false, true, true) => (
                combined(&[&b, &c], Combination::Slope)?,
                combined(&[&c], Combination::First)?,
                combined(&[&b], Combination::First)?,
            ),
            (true, true, false) => (
                combined(&[&a, &b], Combination::Slope)?,
                combined(&[&b], Combination::First)?,
                combined(&[&a], Combination::First)?,
            ),
            _ => return Ok(out.into_iter().map(|k| (k, false)).collect()),
        };
        for x in zeros.zeros(&range, budget)? {
            above.sign_at(&x, budget)?;
            below.sign_at(&x, budget)?;
            let (above, below) = (above.clone(), below.clone());
            out.push(enclosed("gain at a required distance", move |bits| {
                Some(above.at_real(&x, bits).neg().div(&below.at_real(&x, bits))?.to_enclosure())
            }));
        }
        Ok(out.into_iter().map(|k| (k, false)).collect())
    }
}

/// A combination of polynomials; where it is none, that way does not tell.
fn combined(ground: &Constants, parts: &[&Poly<MultiPoly>], how: Combination) -> Result<Combined, Exhausted> {
    Combined::new(ground, parts, how)
        .ok_or_else(|| SIGN_AT_NUMBER.exhausted("zeros on the boundary that are algebraic"))
}

/// The product of two numbers that are not zero.
fn product(a: &Real, b: &Real) -> Real {
    if let (Some(a), Some(b)) = (a.exact(), b.exact()) {
        return Real::from(a * b);
    }
    let (a, b) = (a.clone(), b.clone());
    enclosed("product of two numbers", move |bits| Some(within(&a, bits).mul(&within(&b, bits), bits)))
}

/// Whether what comes back to the cut is a multiple of the one free parameter, which is in no function: with powers of the parameter as units of the
/// states each entry of the system has that power which its place asks for.
fn is_multiple(problem: &Problem, cut: &Cut, budget: &Budget) -> Result<bool, Error> {
    let kept = [problem.parameter().name.clone()];
    let opened = match problem.model().opened_in_numbers(cut, &kept, problem.set(), budget) {
        Err(stopped @ Error::Stopped(_)) => return Err(stopped),
        Err(_) => return Ok(false),
        Ok(opened) => opened,
    };
    let system = &opened.system;
    let is_elsewhere = opened.symbols.is_moving()
        || opened.sample_time.as_ref().is_some_and(|t| power_of(t) != Some(0))
        || system.poles.iter().any(|p| p.degree_in(0) > 0);
    if is_elsewhere || system.is_complex || opened.is_closed {
        return Ok(false);
    }
    let Some(column) = system.inputs.len().max(system.e.columns()).checked_sub(1) else { return Ok(false) };
    // Entry `(i, j)` makes a signal of another one. The last place is the cut's: its input has the power 0, its output the power 1.
    let n = system.a.rows();
    let entry = |i: usize, j: usize| match (i == n, j == n) {
        (false, false) => &system.a[(i, j)],
        (false, true) => &system.e[(i, column)],
        (true, false) => &system.c[(0, j)],
        (true, true) => &system.d[(0, column)],
    };
    let places = || (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))).filter(|&(i, j)| !entry(i, j).is_zero());
    let mut powers: Vec<Option<i64>> = vec![None; n];
    loop {
        let mut has_changed = false;
        for (i, j) in places() {
            let Some(power) = power_of(entry(i, j)) else { return Ok(false) };
            let to = if i == n { Some(1) } else { powers[i] };
            let from = if j == n { Some(0) } else { powers[j] };
            match (to, from) {
                (Some(to), Some(from)) if to != from + power => return Ok(false),
                (None, Some(from)) => powers[i] = Some(from + power),
                (Some(to), None) => powers[j] = Some(to - power),
                _ => continue,
            }
            has_changed |= to.is_none() || from.is_none();
        }
        if !has_changed {
            return Ok(true);
        }
    }
}

/// The power of the first variable that a function that is not zero is a multiple of, the rest being free of it.
fn power_of(f: &RationalFunction) -> Option<i64> {
    let power = |p: &MultiPoly| {
        let mut all = p.terms().iter().map(|(monomial, _)| i64::from(monomial.exponent(0)));
        let first = all.next()?;
        all.all(|other| other == first).then_some(first)
    };
    Some(power(f.numerator())? - power(f.denominator())?)
}

#[cfg(test)]
mod tests;
