//! Blocks realised in state space and made discrete.
//!
//! The controllable canonical form of a numerator and a denominator keeps every mode, common
//! factors included: its characteristic polynomial is the denominator.

use super::hold::held;
use super::matrices::solve;
use super::state_space::{Connecting, NotConnected, Substitution, System, substituted, substituted_matrix, undefined};
use crate::complex::{Lift, lifted_system, ports_as_written, realised_ratio, seen_from};
use crate::discretization::Rule;
use crate::error::Span;
use crate::evaluate::values::{BlockValues, DiscretizationValues, DynamicValues, Hold};
use crate::evaluate::zpoly::ZPoly;
use crate::presupposed::{Presupposed, Presupposition};
use crate::text::names::shorten;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Enclosure;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// The controllable canonical form.
fn realise(
    numerator: &ZPoly,
    denominator: &ZPoly,
    block: &BlockValues,
    set: &Substitution<'_>,
    poles: &mut Vec<MultiPoly>,
) -> Result<System, NotConnected> {
    let n = denominator.degree();
    let leading = substituted(&denominator.coefficient(n), set)?;
    let Some(inverse) = leading.recip() else { return Err(loses_order(block)) };
    poles.push(leading.numerator().clone());
    let monic = |p: &ZPoly, k: usize| substituted(&p.coefficient(k), set).map(|c| &c * &inverse);
    let direct = monic(numerator, n)?;
    let mut a = RationalMatrix::zeros(n, n);
    let mut b = RationalMatrix::zeros(n, 1);
    let mut c = RationalMatrix::zeros(1, n);
    for k in 0..n {
        let d = monic(denominator, k)?;
        c[(0, k)] = &monic(numerator, k)? - &(&direct * &d);
        a[(n - 1, k)] = -&d;
        if k + 1 < n {
            a[(k, k + 1)] = RationalFunction::one();
        }
    }
    if n > 0 {
        b[(n - 1, 0)] = RationalFunction::one();
    }
    Ok(System { a, b, c, d: RationalMatrix::from_fn(1, 1, |_, _| direct.clone()) })
}

/// The same of a ratio with complex coefficients.
fn complex_ratio(
    numerator: &[ZPoly; 2],
    denominator: &[ZPoly; 2],
    block: &BlockValues,
    set: &Substitution<'_>,
    poles: &mut Vec<MultiPoly>,
) -> Result<System, NotConnected> {
    let n = denominator.iter().map(ZPoly::degree).max().unwrap_or(0);
    let list = |p: &ZPoly| (0..=n).map(|k| substituted(&p.coefficient(k), set)).collect::<Result<Vec<_>, _>>();
    let numerator = [list(&numerator[0])?, list(&numerator[1])?];
    let denominator = [list(&denominator[0])?, list(&denominator[1])?];
    let Some((system, square)) = realised_ratio(&numerator, &denominator) else { return Err(loses_order(block)) };
    poles.push(square.numerator().clone());
    Ok(system)
}

/// What a block's characteristic polynomial was divided by for its canonical form: where its signals stand in parts, with its conjugate.
fn leading_of(block: &BlockValues, set: &Substitution<'_>) -> Result<RationalFunction, NotConnected> {
    let square = |f: &RationalFunction| f * f;
    Ok(match (&block.dynamics, &block.lift) {
        (DynamicValues::StateSpace { .. }, _) => RationalFunction::one(),
        (DynamicValues::Ratio(ratio), Lift::Done) => substituted(&ratio.denominator.leading(), set)?,
        (DynamicValues::Ratio(ratio), Lift::AfterHold) => square(&substituted(&ratio.denominator.leading(), set)?),
        (DynamicValues::ComplexRatio { denominator, .. }, _) => {
            let n = denominator.iter().map(ZPoly::degree).max().unwrap_or(0);
            let [re, im] = denominator.each_ref().map(|p| substituted(&p.coefficient(n), set));
            &square(&re?) + &square(&im?)
        }
    })
}

fn loses_order(block: &BlockValues) -> NotConnected {
    let name = shorten(&block.name);
    let message = format!("the leading coefficient of the denominator of '{name}' is zero: the block loses its order");
    undefined(message, block.span)
}

/// Refuses an angle `w T` that is a number and not below pi.
fn below_half_the_sampling_rate(angle: &RationalFunction, span: Span) -> Result<(), NotConnected> {
    let Some(angle) = angle.as_constant() else { return Ok(()) };
    // A rational number is no multiple of pi but 0.
    let is_below =
        (1..).map(|k| Enclosure::pi(64 * k)).find(|pi| !pi.contains(&angle)).is_some_and(|pi| angle < *pi.lower());
    if is_below && !angle.is_negative() && !angle.is_zero() {
        return Ok(());
    }
    let angle = Presupposition { of: Presupposed::Angle, function: angle.into(), span };
    let error = if is_below { angle.not_positive() } else { angle.too_fast() };
    Err(NotConnected::Refused(Box::new(error)))
}

/// The discrete system that the rule makes of a continuous one.
fn discretised(
    s: System,
    rule: Rule,
    value: &RationalFunction,
    block: &BlockValues,
    poles: &mut Vec<MultiPoly>,
    budget: &Budget,
) -> Result<System, NotConnected> {
    if s.a.rows() == 0 {
        return Ok(s);
    }
    rule(s, value, &mut |matrix: &RationalMatrix| {
        let Some((inverse, determinant)) = solve(matrix, &RationalMatrix::identity(matrix.rows()), budget)? else {
            let message = format!(
                "the discretisation of '{}' divides by zero: the map meets a pole of the block",
                shorten(&block.name)
            );
            return Err(undefined(message, block.span));
        };
        poles.push(determinant.numerator().clone());
        Ok(inverse)
    })
}

/// A block before it is made discrete.
pub(super) fn as_written(
    block: &BlockValues,
    set: &Substitution<'_>,
    poles: &mut Vec<MultiPoly>,
) -> Result<System, NotConnected> {
    match &block.dynamics {
        DynamicValues::Ratio(ratio) => realise(&ratio.numerator, &ratio.denominator, block, set, poles),
        DynamicValues::ComplexRatio { numerator, denominator } => {
            complex_ratio(numerator, denominator, block, set, poles)
        }
        DynamicValues::StateSpace { a, b, c, d } => {
            let set = |m| substituted_matrix(m, set);
            Ok(System { a: set(a)?, b: set(b)?, c: set(c)?, d: set(d)? })
        }
    }
}

/// The blocks of a diagram, each as a system of its own: one for all samples, or one for the even and one for the odd ones.
pub(crate) fn realised(
    blocks: &[BlockValues],
    how: &Connecting<'_>,
    poles: &mut Vec<MultiPoly>,
    leading: &mut RationalFunction,
) -> Result<Vec<Vec<System>>, NotConnected> {
    let Connecting { set, symbols, budget, .. } = *how;
    let mut systems = Vec::with_capacity(blocks.len());
    for block in blocks {
        budget.check()?;
        *leading = &*leading * &leading_of(block, set)?;
        let mut system = as_written(block, set, poles)?;
        let mut of_samples: Vec<System> = Vec::new();
        match &block.discretization {
            None => {}
            Some(DiscretizationValues::Rule { rule, value, prewarp }) => {
                if let Some(prewarp) = prewarp {
                    below_half_the_sampling_rate(&substituted(&prewarp.angle, set)?, prewarp.span)?;
                }
                system = discretised(system, *rule, &substituted(value, set)?, block, poles, budget)?;
            }
            Some(DiscretizationValues::Hold(hold)) => {
                of_samples = held(system.clone(), hold, block, set, symbols, budget)?
            }
        }
        if of_samples.is_empty() {
            of_samples.push(system);
        }
        with_sizes(&mut of_samples, ports_as_written(block));
        if let Lift::AfterHold = block.lift {
            of_samples = of_samples.iter().map(lifted_system).collect();
        }
        if let Some(DiscretizationValues::Hold(Hold { frame: Some(frame), .. })) = &block.discretization {
            let frame = frame.try_map(&|f| substituted(f, set))?;
            of_samples = of_samples.into_iter().map(|system| seen_from(system, &frame)).collect();
        }
        with_sizes(&mut of_samples, (block.inputs.len(), block.outputs));
        systems.push(of_samples);
    }
    Ok(systems)
}

/// Matrices without rows or columns do not remember their other size.
fn with_sizes(systems: &mut [System], (inputs, outputs): (usize, usize)) {
    for system in systems.iter_mut().filter(|system| system.a.rows() == 0) {
        system.b = RationalMatrix::zeros(0, inputs);
        system.c = RationalMatrix::zeros(outputs, 0);
    }
}
