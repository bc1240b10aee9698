//! Loops with dead time whose coefficients are constants that are not rational: enclosed with as many bits as are asked for.
//!
//! What is proved with the bounds of all coefficients holds for the constants themselves.

use super::family::{FamilyLoop, piece, trimmed};
use super::family_function::{Function, Line};
use super::family_zeros::zeros;
use super::fixed_factor::{Known, without_fixed_factor};
use super::gain::{GainCells, GainLoop, NotSolved, gain_cells};
use super::quasi_polynomial::QuasiPolynomial;
use super::windows::Never;
use crate::Range;
use crate::precisions::CONSTANTS_BESIDE_DEAD_TIME;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::symbols::Symbols;
use std::fmt;
use std::sync::Arc;

/// The coefficient of `z^k s^j` at `[k][j]`: a polynomial in a parameter (0) and in constants behind it.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_algebra::symbols::{Definition, Symbols};
/// use jurist_stability::Range;
/// use jurist_stability::dead_time::{ConstantParts, FamilyLoop, Line, family_cells};
/// // s + K pi exp(-s): stable for 0 < K < 1/2
/// let mut symbols = Symbols::new();
/// let pi = symbols.insert("pi", Definition::Pi);
/// let (one, gain) = (MultiPoly::one(), MultiPoly::variable(0));
/// let parts = ConstantParts::new(vec![vec![MultiPoly::zero(), one], vec![gain.times(&MultiPoly::variable(pi + 1))]], symbols);
/// let family = FamilyLoop::enclosed(parts, Line::constant(1.into()), Line::constant(0.into()));
/// let cells = family_cells(&family, &Range::between(Some(0.into()), Some(2.into())), &Budget::unlimited()).unwrap().unwrap();
/// assert_eq!(cells.points[0].value.decimal(10), "0.5000000000");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantParts {
    coefficients: Vec<Vec<MultiPoly>>,
    symbols: Symbols,
}

impl ConstantParts {
    /// From the coefficients, in which symbol `i` is the variable `i + 1`.
    pub fn new(coefficients: Vec<Vec<MultiPoly>>, symbols: Symbols) -> ConstantParts {
        ConstantParts { coefficients, symbols }
    }

    /// Each part, a polynomial in `s`, changed.
    pub(super) fn map_parts(&self, change: impl Fn(&Poly<MultiPoly>) -> Poly<MultiPoly>) -> ConstantParts {
        let all = self.coefficients.iter().map(|part| change(&Poly::new(part.clone())).into_coeffs());
        ConstantParts { coefficients: trimmed(all.collect()), symbols: self.symbols.clone() }
    }

    /// Without the factor whose roots do not depend on the dead time, and this factor.
    pub(super) fn without_fixed_factor(self) -> (UniPoly, ConstantParts) {
        let (factor, coefficients) = without_fixed_factor(self.coefficients);
        (factor, ConstantParts { coefficients, symbols: self.symbols })
    }

    /// The function beside it with so many bits, where no coefficient depends on the parameter, and how far the coefficients may be off at most. A common
    /// divisor of the numbers is left out.
    pub(super) fn at_a_point(&self, bits: u64) -> (QuasiPolynomial, Vec<UniPoly>) {
        let [numbers, errors] = self.rounded(bits).map(|parts| {
            let part = |part: &Vec<UniPoly>| UniPoly::new(part.iter().map(|c| c.coeff(0)).collect());
            parts.iter().map(part).collect::<Vec<UniPoly>>()
        });
        (QuasiPolynomial::new(numbers).expect("the function is not zero"), errors)
    }

    /// Integers beside the coefficients times `2^bits`, and bounds of the differences.
    ///
    /// Cost: an enclosure of each coefficient.
    fn rounded(&self, bits: u64) -> [Vec<Vec<UniPoly>>; 2] {
        let one = |c: &MultiPoly| -> [UniPoly; 2] {
            let in_parameter = c.as_poly_in(0);
            let (numbers, errors) = in_parameter.coeffs().iter().map(|c| self.number(c, bits)).unzip();
            [UniPoly::new(numbers), UniPoly::new(errors)]
        };
        let both: Vec<Vec<[UniPoly; 2]>> =
            self.coefficients.iter().map(|part| part.iter().map(one).collect()).collect();
        [0, 1].map(|i| both.iter().map(|part| part.iter().map(|c| c[i].clone()).collect()).collect())
    }

    /// A number, and how far it may be off.
    fn number(&self, c: &MultiPoly, bits: u64) -> (Integer, Integer) {
        if let Some(c) = c.as_constant() {
            return (c << bits, Integer::ZERO);
        }
        let ball = self.symbols.enclose(&c.map_variables(|i| i - 1), bits + GUARD);
        (ball.middle_units() >> GUARD, (ball.width_units() >> GUARD) + Integer::from(2))
    }
}

const GUARD: u64 = 16;

/// How far the coefficients of a loop may be off, and whence those with more bits are.
#[derive(Clone)]
pub(super) struct Enclosed {
    pub errors: Vec<Vec<UniPoly>>,
    /// What is known beside the enclosures.
    pub known: Known,
    bits: u64,
    at: Arc<dyn Fn(u64) -> FamilyLoop + Send + Sync>,
}

impl Enclosed {
    /// Bounds of the errors of coefficients with so many bits, and the loops with more.
    pub fn new(errors: Vec<Vec<UniPoly>>, bits: u64, at: Arc<dyn Fn(u64) -> FamilyLoop + Send + Sync>) -> Enclosed {
        Enclosed { errors, known: Known::default(), bits, at }
    }
}

impl fmt::Debug for Enclosed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Enclosed").field("errors", &self.errors).field("bits", &self.bits).finish()
    }
}

impl PartialEq for Enclosed {
    fn eq(&self, other: &Enclosed) -> bool {
        self.errors == other.errors && self.bits == other.bits
    }
}

impl FamilyLoop {
    /// The loop of coefficients over constants, as [`FamilyLoop::new`] has that of exact ones. A factor with rational coefficients that divides all parts is left
    /// out; counts contain its roots.
    ///
    /// Cost: an enclosure of each coefficient; those with more bits are made when digits are asked for.
    ///
    /// # Panics
    /// When all coefficients are zero.
    pub fn enclosed(parts: ConstantParts, tau: Line, decay: Line) -> FamilyLoop {
        let (factor, parts) = parts.without_fixed_factor();
        let known = Known::new(&parts.coefficients, &factor);
        rounded_loop(&Arc::new(parts), known, [&tau, &decay], CONSTANTS_BESIDE_DEAD_TIME.first)
    }

    /// The same loop with so many bits of its coefficients.
    pub(super) fn with_bits(&self, bits: u64) -> FamilyLoop {
        match &self.enclosed {
            Some(enclosed) if enclosed.bits < bits => (enclosed.at)(bits),
            _ => self.clone(),
        }
    }

    /// The loop of other coefficients, each made of that of a power of `s`, beside another dead time.
    pub(super) fn mapped(
        &self,
        change: impl Fn(usize, &UniPoly) -> UniPoly + Clone + Send + Sync + 'static,
        tau: Line,
    ) -> FamilyLoop {
        let one = |part: &Vec<UniPoly>| part.iter().enumerate().map(|(j, c)| change(j, c)).collect();
        let all = |parts: &[Vec<UniPoly>]| parts.iter().map(one).collect();
        let parts = all(&self.parts);
        let Some(enclosed) = &self.enclosed else { return FamilyLoop::new(parts, tau, self.decay.clone()) };
        let mut errors: Vec<Vec<UniPoly>> = all(&enclosed.errors);
        errors.iter_mut().flatten().for_each(|p| *p = with_sizes(p));
        let (at, own, time) = (Arc::clone(&enclosed.at), change.clone(), tau.clone());
        let at = Arc::new(move |bits| at(bits).mapped(own.clone(), time.clone()));
        let enclosed = Some(Enclosed { errors, at, ..enclosed.clone() });
        FamilyLoop { parts, enclosed, tau, ..self.clone() }
    }

    /// How far the coefficients may be off; none where they are exact.
    pub(super) fn errors(&self) -> &[Vec<UniPoly>] {
        self.enclosed.as_ref().map_or(&[], |enclosed| &enclosed.errors)
    }

    /// Whether the coefficients of `s^0` are exact at a value.
    pub(super) fn is_exact_at_zero(&self, value: &Rational) -> bool {
        self.errors().iter().all(|part| part[0].sign_at(&value.abs()).is_eq())
    }

    /// The characteristic function along the line.
    pub(super) fn function(&self) -> Function {
        let function = Function::new(&self.parts, self.errors(), &self.tau, &self.decay);
        match &self.enclosed {
            None => function,
            Some(Enclosed { bits, at, .. }) => {
                let at = Arc::clone(at);
                function.with_source(*bits, move |bits| {
                    let FamilyLoop { parts, tau, decay, enclosed, .. } = at(bits);
                    Function::new(&parts, enclosed.as_ref().map_or(&[], |e| &e.errors), &tau, &decay)
                })
            }
        }
    }

    /// Of the highest power of `s`, for all values of a range: a lower bound of the modulus of the coefficient without delay, and an upper bound of the sum of
    /// the others.
    fn top(&self, weights: &[Rational], [lower, upper]: [&Rational; 2]) -> [Rational; 2] {
        let n = self.order();
        let most = lower.abs().max(upper.abs());
        let range = Enclosure::new(lower.clone(), upper.clone());
        let top = self.parts[0][n].eval_enclosure(&range, GUARD);
        let error = self.errors().first().map_or(Rational::ZERO, |part| part[n].eval_rational(&most));
        let least = top.lower().clone().max(-top.upper()) - error;
        let others = (1..self.parts.len()).map(|k| self.modulus([k, n], &most) * &weights[k]);
        [least, others.fold(Rational::ZERO, |sum, x| sum + x)]
    }

    /// A bound of the modulus of a coefficient for all values up to a modulus.
    fn modulus(&self, [k, j]: [usize; 2], most: &Rational) -> Rational {
        let own = with_sizes(&self.parts[k][j]).eval_rational(most);
        self.errors().get(k).map_or(own.clone(), |part| own + part[j].eval_rational(most))
    }

    /// A frequency beyond which the highest power of `s` outweighs all else for all values of a range; `None` where it does not.
    pub(super) fn frequency_bound(&self, weights: &[Rational], range: [&Rational; 2]) -> Option<Rational> {
        let [least, others] = self.top(weights, range);
        if least <= others {
            return None;
        }
        let most = range[0].abs().max(range[1].abs());
        let below = (0..self.order()).map(|j| {
            (0..self.parts.len()).fold(Rational::ZERO, |sum, k| sum + self.modulus([k, j], &most) * &weights[k])
        });
        let below: Vec<Rational> = below.collect();
        let (room, mut r) = (least - others, Rational::ONE);
        // sum below_j r^(j - n) < room
        while below.iter().fold(Rational::ZERO, |sum, c| (sum + c) / &r) >= room {
            r = &r + &r;
        }
        Some(r)
    }

    /// The loop with a parameter `p`: all delayed terms are multiplied by `1 + p`. At `p = 0` it is the loop itself. A root that crosses the line has one value
    /// of `p`, and Newton's method encloses this value; where the enclosure does not contain 0 no root is on the line.
    fn with_a_factor(&self) -> FamilyLoop {
        let doubled = |parts: &[Vec<UniPoly>]| -> Vec<Vec<UniPoly>> {
            let factor = |k: usize, c: &UniPoly| if k == 0 { c.clone() } else { c.plus(&c.shifted_up(1)) };
            parts.iter().enumerate().map(|(k, part)| part.iter().map(|c| factor(k, c)).collect()).collect()
        };
        let enclosed = self.enclosed.clone().map(|enclosed| Enclosed { errors: doubled(&enclosed.errors), ..enclosed });
        FamilyLoop { parts: doubled(&self.parts), enclosed, ..self.clone() }
    }

    /// Whether no root is on the line at a value, whatever the constants are within their bounds.
    pub(super) fn keeps_clear_at(&self, value: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        let Some(Enclosed { bits, errors, .. }) = &self.enclosed else { return Ok(true) };
        if self.degree() == 0 && self.tau.slope.is_zero() && self.decay.slope.is_zero() {
            return self.with_a_factor().keeps_clear_at(&Rational::ZERO, budget);
        }
        let function = Arc::new(budget.enter(|| Function::new(&self.parts, errors, &self.tau, &self.decay))?);
        let near = (Rational::ONE + value.abs()) * Rational::dyadic(&Integer::ONE, BITS_OF_VALUE);
        let [lower, upper] = [value - &near, value + &near];
        let weights = budget.enter(|| self.weights([&lower, &upper]))?;
        let Some(frequency) = budget.enter(|| self.frequency_bound(&weights, [&lower, &upper]))? else {
            return Ok(false);
        };
        let Some(found) = zeros(&function, &frequency, &lower, &upper, budget)? else { return Ok(false) };
        budget.enter(|| found.iter().all(|zero| !zero.enclosed_with(2 * bits)[1].contains(value)))
    }
}

/// Zeros are looked for at so many bits around a value.
const BITS_OF_VALUE: u64 = 24;

fn rounded_loop(parts: &Arc<ConstantParts>, known: Known, lines: [&Line; 2], bits: u64) -> FamilyLoop {
    let [numbers, errors] = parts.rounded(bits);
    let (of, own) = (Arc::clone(parts), lines.map(Clone::clone));
    let at = Arc::new(move |bits| rounded_loop(&of, known, own.each_ref(), bits));
    let enclosed = Some(Enclosed { errors, known, bits, at });
    let [tau, decay] = lines.map(Clone::clone);
    FamilyLoop { parts: numbers, enclosed, tau, decay, is_stretched: false }
}

/// A value beyond which nothing happens is looked for so many times, each twice as large.
const TRIALS: usize = 6;

/// A place between negative gains and others; nothing is likely to happen there.
const BETWEEN: [i64; 2] = [-37, 1009];

/// The cells of a gain in a range that lacks an end.
///
/// # Errors
/// [`NotSolved::Unbounded`] where nothing is known of large gains.
pub(super) fn enclosed_gains(
    family: &FamilyLoop,
    range: &Range,
    budget: &Budget,
) -> Result<Result<GainCells, Never>, NotSolved> {
    let between = Rational::new(BETWEEN[0].into(), BETWEEN[1].into());
    let negative = |upper: &Rational| -> Result<Result<GainCells, Never>, NotSolved> {
        let reflected = family.mapped(|_, c| c.negated_argument(), family.tau.clone());
        let mut found = gains_from(&reflected, &-upper, budget)?;
        if let Ok(cells) = &mut found {
            cells.negate();
        }
        Ok(found)
    };
    match (&range.lower, &range.upper) {
        (Some(lower), _) => gains_from(family, lower, budget),
        (None, Some(upper)) => negative(upper),
        (None, None) => Ok(match (negative(&between)?, gains_from(family, &between, budget)?) {
            (Ok(mut below), Ok(above)) => {
                below.points.extend(above.points);
                // The cell about the joint is one.
                below.right.extend(above.right.into_iter().skip(1));
                Ok(below)
            }
            (Err(never), _) | (_, Err(never)) => Err(never),
        }),
    }
}

impl GainCells {
    /// The same in the parameter with the other sign.
    fn negate(&mut self) {
        self.points.reverse();
        self.right.reverse();
        for point in &mut self.points {
            point.value = point.value.negated();
            point.inverse = point.inverse.take().map(|inverse| inverse.negated());
            point.change = point.change.map(|change| -change);
        }
    }
}

/// The polynomial with the absolute values of the coefficients.
fn with_sizes(p: &UniPoly) -> UniPoly {
    UniPoly::new(p.coeffs().iter().map(Integer::abs).collect())
}

/// The cells of a gain in a range that has a lower end only.
///
/// Beyond some frequency all roots that cross the axis go to the right as the gain grows. Where no root crosses below that frequency beyond some gain, and a root
/// is to the right at this gain, the loop is unstable from there on.
///
/// # Errors
/// [`NotSolved::Unbounded`] where this is not seen.
fn gains_from(family: &FamilyLoop, lower: &Rational, budget: &Budget) -> Result<Result<GainCells, Never>, NotSolved> {
    let Some(gain) = family.middle_gain() else { return Err(NotSolved::Unbounded) };
    let Some(turns) = gain.single_delay() else { return Err(NotSolved::Unbounded) };
    let errors = [0, 1].map(|i| {
        let in_s = |part: &Vec<UniPoly>| UniPoly::new(part.iter().map(|c| c.coeff(i)).collect());
        family.errors().iter().map(in_s).collect::<Vec<UniPoly>>()
    });
    let Some(growing) = gain.growing_beyond(turns, Some(&errors)) else { return Err(NotSolved::Unbounded) };
    let domain = Range { lower: Some(lower.clone()), upper: None };
    let at_middle = match gain_cells(&gain, &domain, budget) {
        Ok(Ok(cells)) => cells,
        Err(NotSolved::NotCounted(reason)) => return Err(NotSolved::NotCounted(reason)),
        _ => return Err(NotSolved::Unbounded),
    };
    let last = at_middle.points.last().map(|point| point.value.rational_above());
    let mut most = last.unwrap_or(Rational::ONE).max(lower.abs()) + Rational::ONE;
    let reversed = family.reversed();
    let function = Arc::new(budget.enter(|| reversed.function())?);
    for _ in 0..TRIALS {
        most = &most + &most;
        let least = most.recip().expect("positive");
        if !zeros(&function, &growing, &Rational::ZERO, &least, budget)?.is_some_and(|found| found.is_empty()) {
            continue;
        }
        let mut cells = match piece(family, &Range { lower: Some(lower.clone()), upper: Some(most.clone()) }, budget)? {
            Ok(cells) => cells,
            Err(never) => return Ok(Err(never)),
        };
        if matches!(cells.right.last(), Some(Some(0))) {
            continue;
        }
        *cells.right.last_mut().expect("one cell more than points") = None;
        return Ok(Ok(cells));
    }
    Err(NotSolved::Unbounded)
}

impl FamilyLoop {
    /// The loop with the numbers beside its constants as that of a gain; `None` unless the parameter enters affinely, the dead time is a number, and
    /// the line is the axis.
    fn middle_gain(&self) -> Option<GainLoop> {
        if !self.is_from_axis() || !self.tau.slope.is_zero() || !self.tau.offset.sign().is_gt() || self.degree() > 1 {
            return None;
        }
        let [a, b] = [0, 1].map(|i| {
            let in_s = |part: &Vec<UniPoly>| UniPoly::new(part.iter().map(|c| c.coeff(i)).collect());
            self.parts.iter().map(in_s).collect::<Vec<UniPoly>>()
        });
        Some(GainLoop { a, b, tau: self.tau.offset.clone() })
    }
}
