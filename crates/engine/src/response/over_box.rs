//! Whether a requirement is met at all points of a box of parameters at once.
//!
//! What [`OverBoxes`](super::over_boxes::OverBoxes) does for an interval of one parameter, for any number of them: Taylor models in all
//! parameters enclose the coefficients ([MakinoBerz2003](jurist_algebra::bibliography#makinoberz2003)), behind a hold as well as of a
//! rational loop. The half plane is brought to the disc, so that there is one circle to go along.

use super::along_circle::Asked;
use super::axis_end::AxisSystem;
use super::loop_functions::{LoopFunctions, dead_time, number_asked};
use super::on_circle::twice_real;
use super::opened::OpenedLoop;
use super::requirement::{Requirement, Rule};
use super::spiral_over_box::{BoxOnSpiral, Spiral, from_one};
use super::taylor_along::{
    beyond_axis, binomial, combined, combined_to, of_octave, on_ray, on_wider_disc, to_half_plane,
};
use crate::error::Error;
use crate::model::Cut;
use crate::problem::{Problem, exact_or_enclosed, parametric_symbols};
use crate::stability::Shape;
use jurist_algebra::ball::{Ball, Elementary, MultiTaylorModel, exp};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, ParametricSymbols};
use std::cmp::Ordering;
use std::sync::Arc;

/// Bits of coefficients, beside those that the box's size takes away.
const BITS: u64 = 256;

/// The least total degree of the Taylor models, and the greatest number of their coefficients.
const LEAST_DEGREE: usize = 4;
const MOST_TERMS: usize = 60;

/// What a requirement asks of a loop in some parameters.
pub(crate) struct OverBox {
    symbols: ParametricSymbols,
    shape: Shape,
    /// A Taylor model in the parameters, of the degree that all have.
    like: MultiTaylorModel,
    /// In the half plane, a frequency of the loop as a power of two.
    octave: i64,
    asks: Asks,
}

enum Asks {
    /// Of the open loop.
    OpenLoop(LoopFunctions),
    /// All roots in a sector: the coefficients of the closed loop, and the cosine of the sector's edge.
    Sector { coefficients: Vec<MultiPoly>, cosine: Rational },
    /// All roots in a logarithmic spiral: the coefficients of the closed loop in `z` and in `z - 1`.
    Spiral { coefficients: Vec<MultiPoly>, from_one: Vec<MultiPoly>, spiral: Box<Spiral> },
    /// All roots in a smaller disc: the coefficients of the closed loop, and the logarithm of its radius.
    Disc { coefficients: Vec<MultiPoly>, exponent: Rational },
    /// All roots in the region of the question: the coefficients of the closed loop, of the disc in `z - 1`, and what must not vanish where the
    /// loop is defined.
    Stable { coefficients: Vec<MultiPoly>, divisors: Vec<MultiPoly> },
}

/// What is known of all points of a box.
///
/// ```
/// use jurist_engine::response::Certain;
/// assert_ne!(Certain::Met, Certain::Same);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certain {
    /// Each stable point meets the requirement.
    Met,
    /// No point meets the requirement.
    Unmet,
    /// All stable points meet it, or none does: one of them tells.
    Same,
}

impl OverBox {
    /// Of the free parameters of a problem, margins being taken at a cut. `near` is a point that tells how fast the loop is.
    ///
    /// `None` for a requirement that is not asked of boxes.
    pub fn of(
        problem: &Arc<Problem>,
        requirement: &Requirement,
        at: Option<&str>,
        near: &[Rational],
        budget: &Budget,
    ) -> Result<Option<OverBox>, Error> {
        let whole = problem.without_region();
        let shape = problem.shape();
        let (symbols, asks) = match requirement.rule() {
            Rule::DeadTime(_) => return Ok(None),
            Rule::Sector(_) | Rule::Modulus { .. } => {
                let in_boxes = whole.in_boxes(budget)?;
                let algebra = in_boxes.algebra_over_symbols(budget)?;
                let Some(d) = algebra.polynomial().filter(|_| algebra.symbols().delays().is_empty()) else {
                    return Ok(None);
                };
                let (p, _) = budget.enter(|| d.cleared())?;
                let coefficients: Vec<MultiPoly> = (0..=d.formal_degree).map(|k| p.coeff(k)).collect();
                let asks = match requirement.rule() {
                    Rule::Sector(damping) if shape == Shape::UnitDisc => Asks::Spiral {
                        from_one: budget.enter(|| from_one(&coefficients))?,
                        coefficients,
                        spiral: Box::new(Spiral::of_boxes(damping)),
                    },
                    Rule::Sector(cosine) => Asks::Sector { coefficients, cosine: cosine.clone() },
                    Rule::Modulus { exponent } => Asks::Disc { coefficients, exponent: exponent.clone() },
                    _ => unreachable!("about roots"),
                };
                (parametric_symbols(algebra.symbols())?, asks)
            }
            rule => open_loop(&whole, rule, requirement.cut(problem, at)?, budget)?,
        };
        OverBox::new(symbols, shape, asks, near, budget).map(Some)
    }

    fn new(
        symbols: ParametricSymbols,
        shape: Shape,
        asks: Asks,
        near: &[Rational],
        budget: &Budget,
    ) -> Result<OverBox, Error> {
        let mut found = OverBox { symbols, shape, like: model(near.len(), 1), octave: 0, asks };
        // What cancels is seen where no terms of the parameters are left out.
        let own = found.functions().iter().map(|f| degree_in(f, near.len())).max().unwrap_or(0);
        found.like = model(near.len(), model_degree(near.len(), LEAST_DEGREE.max(own)));
        found.octave = budget.enter(|| found.octave_at(near))?;
        if let Asks::OpenLoop(functions) = &found.asks
            && functions.has_dead_time()
        {
            let point: Vec<[Rational; 2]> = near.iter().map(|x| [x.clone(), x.clone()]).collect();
            let at = |values: Vec<MultiTaylorModel>| -> Vec<MultiTaylorModel> {
                functions.all.iter().map(|p| found.symbols.value(p, &values)).collect()
            };
            let values = || found.values(&point, BITS).map(at);
            let known = budget.enter(|| functions.octave_from(&values()?, found.octave))?;
            found.octave = known.unwrap_or(found.octave);
        }
        Ok(found)
    }

    /// Of the stability that a problem asks for, in its own region. `None` for a loop with dead time.
    pub fn of_stability(problem: &Arc<Problem>, near: &[Rational], budget: &Budget) -> Result<Option<OverBox>, Error> {
        let algebra = problem.algebra_over_symbols(budget)?;
        let Some(d) = algebra.polynomial().filter(|_| algebra.symbols().delays().is_empty()) else { return Ok(None) };
        let (p, denominator) = budget.enter(|| d.cleared())?;
        let divisors = problem.divisors(budget)?.into_iter().chain([denominator]).collect();
        let own: Vec<MultiPoly> = (0..=d.formal_degree).map(|k| p.coeff(k)).collect();
        let coefficients = match problem.shape() {
            Shape::UnitDisc => budget.enter(|| from_one(&own))?,
            Shape::LeftHalfPlane => own,
        };
        let symbols = parametric_symbols(algebra.symbols())?;
        OverBox::new(symbols, problem.shape(), Asks::Stable { coefficients, divisors }, near, budget).map(Some)
    }

    /// Whether a distance to a circle is asked of an open loop with dead time.
    pub fn is_distance_with_dead_time(&self) -> bool {
        let Asks::OpenLoop(functions) = &self.asks else { return false };
        functions.has_dead_time() && matches!(functions.rule(), Rule::Circle(_))
    }

    /// What is known of all points of a closed box whose points are stable; `None` where nothing is.
    ///
    /// Cost: Taylor models of the coefficients, and values on some hundred pieces of the circle.
    pub fn certain(&self, sides: &[[Rational; 2]]) -> Option<Certain> {
        self.certain_beyond(sides, None)
    }

    /// By how much the region of stability is wider: a share of the disc's radius, or a distance in the half plane.
    pub fn wider(&self, halvings: u32) -> Rational {
        Rational::from(2).pow(self.octave - i64::from(halvings)).expect("two is not zero")
    }

    /// The same of stability in a region that is wider by as much as [`OverBox::wider`] says of so many halvings.
    pub fn certain_beyond(&self, sides: &[[Rational; 2]], halvings: Option<u32>) -> Option<Certain> {
        let bits = bits_of(sides);
        let values = self.values(sides, bits)?;
        let at = |list: &[MultiPoly]| -> Vec<MultiTaylorModel> {
            list.iter().map(|p| self.symbols.value(p, &values)).collect()
        };
        match &self.asks {
            Asks::OpenLoop(functions) if functions.has_dead_time() => {
                let is_met = functions.certain_on_axis(&at(&functions.all), self.octave)?;
                Some(if is_met { Certain::Met } else { Certain::Unmet })
            }
            Asks::OpenLoop(functions) => {
                let asked = functions.asked(&at(&functions.all), |both| self.on_circle(both))?;
                Some(if asked.certain()? { Certain::Met } else { Certain::Unmet })
            }
            Asks::Sector { coefficients, cosine } => {
                let square = on_ray(&at(coefficients), cosine, self.octave);
                Asked::positive(&square).certain()?.then_some(Certain::Same)
            }
            Asks::Spiral { coefficients, from_one, spiral } => {
                let own = BoxOnSpiral::new([&at(coefficients), &at(from_one)], spiral);
                let is_met = own.count()? == coefficients.len() - 1;
                Some(if is_met { Certain::Met } else { Certain::Unmet })
            }
            Asks::Disc { coefficients, exponent } => {
                let radius = exp(&Ball::from_rational(exponent, bits));
                let mut power = Ball::from_integer(&Integer::ONE, bits);
                let mut scaled = Vec::new();
                let d = at(coefficients);
                if Elementary::range(d.last()?).contains_zero() {
                    return None;
                }
                for c in d {
                    scaled.push(c.mul(&c.constant(&power)));
                    power = power.mul(&radius);
                }
                let moved = combined(&scaled, |j, k| binomial(k, j));
                Asked::positive(&twice_real(&moved, &moved)).certain()?.then_some(Certain::Same)
            }
            Asks::Stable { coefficients, .. } => {
                let d = at(coefficients);
                // A root that comes from infinity is none that the count at one point tells of.
                if Elementary::range(d.last()?).contains_zero() {
                    return None;
                }
                let square = self.square_beyond(&d, halvings);
                Asked::positive(&square).certain()?.then_some(Certain::Same)
            }
        }
    }

    /// Of a loop with dead time and one parameter, the only value in a short interval at which the requirement begins or ceases to be met, or that there
    /// is none; `None` where neither is seen.
    pub fn only_end(&self, [lower, upper]: &[Rational; 2]) -> Option<Option<Real>> {
        let Asks::OpenLoop(functions) = &self.asks else { return None };
        let side = [lower.clone(), upper.clone()];
        let values = self.values(std::slice::from_ref(&side), bits_of(std::slice::from_ref(&side)))?;
        let values: Vec<MultiTaylorModel> = functions.all.iter().map(|p| self.symbols.value(p, &values)).collect();
        let (asked, octave) = functions.asked_on_axis(&values, self.octave)?;
        let pieces = asked.open_pieces()?;
        let wider = |[lower, upper]: [Rational; 2]| {
            let width = &upper - &lower;
            [&lower - &width, upper + width]
        };
        let system = AxisSystem::new(&self.symbols, functions, octave);
        let [[from, to]] = match (asked.are_ends_allowed(), &pieces[..]) {
            ([true, true], [[from, to]]) if from.is_zero() => {
                let last = to * &Rational::dyadic(&Integer::ONE, 1);
                return system.only_least_at_zero(&last, &wider(side), [lower, upper]);
            }
            ([true, true], [one]) => [one],
            ([false, true], []) => return system.only_end_at_zero(&wider(side), [lower, upper]),
            _ => return None,
        };
        let two = Rational::from(2);
        if *to > two {
            return None;
        }
        // Frequencies from 0 to 1 are y/2, and a zero at an end of the box is to be inside.
        let half = |y: &Rational| y * &Rational::dyadic(&Integer::ONE, 1);
        let place = [[half(from), half(to)], side].map(wider);
        system.only_end(&place, [lower, upper])
    }

    /// Whether it is seen that the loop is defined at all points of a closed box; of a requirement, which is asked of stable points, nothing has to
    /// be seen.
    pub fn is_defined(&self, sides: &[[Rational; 2]]) -> bool {
        let Asks::Stable { divisors, .. } = &self.asks else { return true };
        let Some(values) = self.values(sides, bits_of(sides)) else { return false };
        let is_clear = |p: &MultiPoly| !Elementary::range(&self.symbols.value(p, &values)).contains_zero();
        divisors.iter().all(is_clear)
    }

    /// Whether it is seen from signs that no point of a closed box is stable: brought to the half plane, the coefficients of a stable polynomial have
    /// one sign.
    pub fn is_unstable_by_signs(&self, sides: &[[Rational; 2]]) -> bool {
        let Asks::Stable { coefficients, .. } = &self.asks else { return false };
        let Some(values) = self.values(sides, bits_of(sides)) else { return false };
        let d: Vec<MultiTaylorModel> = coefficients.iter().map(|p| self.symbols.value(p, &values)).collect();
        let d = if self.shape == Shape::UnitDisc { to_half_plane(&d) } else { d };
        let signs: Vec<_> = d.iter().filter_map(|c| Elementary::range(c).sign()).collect();
        signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater)
    }

    /// The parameters and symbols in a box.
    fn values(&self, sides: &[[Rational; 2]], bits: u64) -> Option<Vec<MultiTaylorModel>> {
        let line = |[low, high]: &[Rational; 2]| {
            let middle = low.midpoint(high);
            (Ball::from_rational(&middle, bits), Ball::from_rational(&(high - &middle), bits))
        };
        self.symbols.values(&self.like.lines(&sides.iter().map(line).collect::<Vec<_>>()))
    }

    /// The square of the modulus along the boundary of the region of stability, or of one that is wider.
    fn square_beyond(&self, d: &[MultiTaylorModel], halvings: Option<u32>) -> Vec<MultiTaylorModel> {
        match self.shape {
            Shape::UnitDisc => {
                let moved = halvings.map_or(d.to_vec(), |e| on_wider_disc(d, u64::from(e)));
                twice_real(&moved, &moved)
            }
            Shape::LeftHalfPlane => {
                let scaled = of_octave(d, self.octave, d.len() - 1);
                let moved = halvings.map_or(scaled.clone(), |e| beyond_axis(&scaled, u64::from(e)));
                on_ray(&moved, &Rational::ZERO, 0)
            }
        }
    }

    /// Two polynomials along the circle: in `w = z - 1`. In the half plane `s = c w/(w + 2)`, and both are multiplied by the same power of
    /// `w + 2`.
    fn on_circle(&self, both: [&[MultiTaylorModel]; 2]) -> [Vec<MultiTaylorModel>; 2] {
        let degree = both[0].len().max(both[1].len()) - 1;
        both.map(|p| match self.shape {
            Shape::UnitDisc => p.to_vec(),
            Shape::LeftHalfPlane => {
                let scaled: Vec<MultiTaylorModel> = of_octave(p, self.octave, degree);
                // w^k (w + 2)^(degree - k)
                let share = |j: usize, k: usize| match j.checked_sub(k) {
                    Some(i) if i <= degree - k => binomial(degree - k, i) << (degree - k - i) as u64,
                    _ => Integer::ZERO,
                };
                combined_to(&scaled, degree + 1, share)
            }
        })
    }

    fn functions(&self) -> &[MultiPoly] {
        match &self.asks {
            Asks::OpenLoop(functions) => &functions.all,
            Asks::Sector { coefficients, .. }
            | Asks::Spiral { coefficients, .. }
            | Asks::Disc { coefficients, .. }
            | Asks::Stable { coefficients, .. } => coefficients,
        }
    }

    /// The octave of the geometric mean of the roots' moduli near a point, where that is known.
    fn octave_at(&self, near: &[Rational]) -> i64 {
        if self.shape == Shape::UnitDisc {
            return 0;
        }
        let list = match &self.asks {
            Asks::OpenLoop(functions) => functions.denominator(),
            _ => self.functions(),
        };
        let parameters: Vec<MultiTaylorModel> = {
            let zero = Ball::zero(BITS);
            let lines: Vec<(Ball, Ball)> = near.iter().map(|x| (Ball::from_rational(x, BITS), zero.clone())).collect();
            MultiTaylorModel::linear(&lines, 1)
        };
        let Some(values) = self.symbols.values(&parameters) else { return 0 };
        let sizes: Vec<(usize, i64)> = list
            .iter()
            .map(|p| Elementary::range(&self.symbols.value(p, &values)).magnitude_units().bit_length() as i64)
            .enumerate()
            .filter(|(_, bits)| *bits > 0)
            .collect();
        match (sizes.first(), sizes.last()) {
            (Some((low, small)), Some((high, large))) if low < high => (small - large).div_euclid((high - low) as i64),
            _ => 0,
        }
    }
}

/// Bits of coefficients in a box: more in a small one.
fn bits_of(sides: &[[Rational; 2]]) -> u64 {
    let width = sides.iter().map(|[low, high]| high - low).filter(|w| !w.is_zero()).min().unwrap_or(Rational::ONE);
    BITS + width.denominator().bit_length().saturating_sub(width.numerator().bit_length()).min(1 << 12)
}

/// The open loop in the free parameters and symbols, and the number that a rule asks for as the last of them.
fn open_loop(problem: &Problem, rule: &Rule, cut: Cut, budget: &Budget) -> Result<(ParametricSymbols, Asks), Error> {
    let exact = |budget: &Budget| asked_of(problem, &OpenedLoop::of(problem, cut.clone(), budget)?, rule, budget);
    if !problem.model().has_holds() {
        return exact(budget);
    }
    exact_or_enclosed(budget, exact, |budget| {
        let opened = OpenedLoop::by_values(problem, cut.clone(), budget)?;
        opened.map(|opened| asked_of(problem, &opened, rule, budget)).transpose()
    })
}

fn asked_of(
    problem: &Problem,
    opened: &OpenedLoop,
    rule: &Rule,
    budget: &Budget,
) -> Result<(ParametricSymbols, Asks), Error> {
    let (mut quotient, undefined) = opened.quotient(MultiPoly::clone, budget)?;
    let dead_time = dead_time(&mut quotient, &undefined, &opened.symbols)?;
    let table = parametric_symbols(&opened.symbols)?;
    let alpha = MultiPoly::variable(problem.free().len() + table.len());
    let parts = (&quotient, dead_time.as_ref());
    let functions = budget.enter(|| LoopFunctions::new(parts, &undefined, rule, alpha))?;
    Ok((table.with("alpha", Definition::Algebraic(number_asked(rule))), Asks::OpenLoop(functions)))
}

/// The total degree in the first variables.
fn degree_in(f: &MultiPoly, variables: usize) -> usize {
    let total = |exponents: &[u32]| exponents.iter().take(variables).sum::<u32>() as usize;
    f.terms().iter().map(|(monomial, _)| total(monomial.exponents())).max().unwrap_or(0)
}

/// A Taylor model in so many parameters up to this degree.
fn model(parameters: usize, degree: usize) -> MultiTaylorModel {
    let zero = || (Ball::zero(BITS), Ball::zero(BITS));
    let lines: Vec<(Ball, Ball)> = (0..parameters).map(|_| zero()).collect();
    MultiTaylorModel::linear(&lines, degree).swap_remove(0)
}

/// A degree up to this one with which a Taylor model has not too many coefficients.
fn model_degree(variables: usize, most: usize) -> usize {
    let terms = |degree: usize| (1..=variables).fold(1, |n, i| n * (degree + i) / i);
    (1..=most).rev().find(|&degree| terms(degree) <= MOST_TERMS).unwrap_or(1)
}
