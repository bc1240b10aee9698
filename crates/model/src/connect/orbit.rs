//! A loop at rest whose plant is behind a pulse-width modulator: one equation for the duty ratio of its periodic orbit.
//!
//! Over a period the plant's state at the samples goes from `x` to `Phi x + h S(D)`: `h` is the height of the pulse, and `S(D)` the integral of
//! `exp(A (T - t)) B` over the times `t` at which it is on. A hold with the same mean has `h D S(1)` in that place. So the loop behind a hold, with
//! `h (S(D) - D S(1))` added to the plant's states in each period, has the same orbit. That loop is linear. At rest it commands
//! `h D = u + r h (S(D) - D S(1))`: `u` is what it commands with nothing added, and the row `r` how the command at rest answers to what is added.

use super::matrices::solve;
use super::modulators::{drivers, periods_agree};
use super::realise::{as_written, realised};
use super::state_space::{Connecting, NotConnected, System, closed};
use crate::definition::{Form, Model};
use crate::discretization::{Edges, Inputs};
use crate::error::{Code, Diagnostic, Span};
use crate::evaluate::values::{BlockValues, DiscretizationValues, Hold, Row, Values, Wiring};
use crate::text::names::{list, shorten};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::RationalFunction;

/// The equation `mean + r (S(D) - D S(1)) - D = 0` of the duty ratio, in kept names and symbols.
pub(crate) struct Orbit {
    /// The block behind the modulator.
    pub block: String,
    /// Where its duty ratio stands.
    pub span: Span,
    /// The duty ratio of the loop behind a hold: `u/h`.
    pub mean: RationalFunction,
    /// `r`, one entry for each state of the plant.
    pub answers: Vec<RationalFunction>,
    /// The plant: its state matrix, n x n, and the column of its pulsed input.
    pub a: RationalMatrix,
    pub b: Vec<RationalFunction>,
    /// The period.
    pub time: RationalFunction,
    /// The share of a period by which the pulse begins behind a sample.
    pub late: Rational,
    pub edges: &'static Edges,
}

/// The input of a block that is pulsed with the duty ratio of the loop at rest: the number of the block and that of its input.
struct Place {
    block: usize,
    input: usize,
    edges: &'static Edges,
    span: Span,
}

/// The equation of a model that asks for the duty ratio of its loop at rest.
///
/// Cost: that of the closed loop behind a hold, and one linear system of its order.
///
/// # Errors
/// Refused where there are several such inputs, or edges that alternate, a direct path, an unknown height of the pulses, a dead time that is no
/// fixed share of the period; and where the loop at rest is not unique.
pub(crate) fn orbit(
    model: &Model,
    wiring: &mut Wiring<'_>,
    values: &mut Values,
    how: &Connecting<'_>,
) -> Result<Orbit, NotConnected> {
    let Values::Blocks { blocks, .. } = values else { unreachable!("a modulator is a block of a diagram") };
    let place = place(blocks)?;
    if wiring.is_complex {
        return Err(refused(&blocks[place.block], &place, "is in a loop with complex coefficients"));
    }
    periods_agree(blocks, how)?;
    let height = height(blocks, &place, how)?;
    let plant = as_written(&blocks[place.block], how.set, &mut Vec::new())?;
    let n = plant.a.rows();
    if (0..plant.d.rows()).any(|i| !plant.d[(i, place.input)].is_zero()) {
        return Err(refused(
            &blocks[place.block],
            &place,
            "passes its pulses on at once: what a sample reads of a pulse is no mean",
        ));
    }
    let (time, late) = behind_a_hold(&mut blocks[place.block], &place, how)?;
    let (mut poles, mut leading) = (Vec::new(), RationalFunction::one());
    let of_samples = realised(blocks, how, &mut poles, &mut leading)?;
    let mut systems: Vec<System> = of_samples.into_iter().map(|mut of_samples| of_samples.swap_remove(0)).collect();
    let command = vec![blocks[place.block].inputs[place.input].clone()];
    let external = wiring.inputs.len();
    add_to_states(&mut systems[place.block], &mut blocks[place.block], wiring, n);
    let (system, _) = closed(wiring, blocks, &systems, &command, how.set, how.budget)?;
    let answers = at_rest(&system, how)?.ok_or_else(|| {
        let why = "has more than one orbit, or none: behind a hold the loop has a root at 1";
        refused(&blocks[place.block], &place, why)
    })?;
    let commanded = commanded(model, &wiring.inputs[..external], &answers)
        .map_err(|without| nothing_commanded(&blocks[place.block], &place, &without))?;
    let mean = commanded.checked_div(&height).ok_or_else(|| {
        let message = format!("the pulses of '{}' have no height", shorten(&blocks[place.block].name));
        super::state_space::undefined(message, place.span)
    })?;
    Ok(Orbit {
        block: blocks[place.block].name.clone(),
        span: place.span,
        mean,
        answers: answers[external..].to_vec(),
        b: (0..n).map(|i| plant.b[(i, place.input)].clone()).collect(),
        a: plant.a,
        time,
        late,
        edges: place.edges,
    })
}

/// What inputs at rest command together; the names of those without a value that would command something, where nothing is commanded.
fn commanded<'n>(
    model: &Model,
    names: &'n [String],
    answers: &[RationalFunction],
) -> Result<RationalFunction, Vec<&'n str>> {
    let inputs = &model.simulation().inputs;
    let (mut sum, mut without) = (RationalFunction::zero(), Vec::new());
    for (own, answer) in names.iter().zip(answers).filter(|(_, answer)| !answer.is_zero()) {
        match inputs.iter().find(|(name, _)| name.name == *own) {
            Some((_, value)) => sum = &sum + &(answer * &value.clone().into()),
            None => without.push(own.as_str()),
        }
    }
    if sum.is_zero() && !without.is_empty() { Err(without) } else { Ok(sum) }
}

fn refused(block: &BlockValues, place: &Place, why: &str) -> NotConnected {
    let message = format!("the duty ratio of the orbit is not known: '{}' {why}", shorten(&block.name));
    let error = Diagnostic::error(Code::Duty, message).at(place.span, "duty = \"steady\"");
    NotConnected::Refused(Box::new(error.help(
        "write the duty ratio from the mean over a period: A x + B v = 0 at the operating point gives the mean input v, and duty is v over the \
         height of the pulse",
    )))
}

/// The refusal where the loop at rest commands nothing, and these inputs have no value.
fn nothing_commanded(block: &BlockValues, place: &Place, without: &[&str]) -> NotConnected {
    let name = shorten(&block.name);
    let message = format!(
        "the orbit of '{name}' is not known: {} {} no value in [simulation], and without one nothing is commanded",
        list(without.iter().copied()),
        if without.len() == 1 { "has" } else { "have" }
    );
    let error = Diagnostic::error(Code::Duty, message).at(place.span, "the duty ratio of the loop at rest");
    let inputs: Vec<String> = without.iter().map(|name| format!("{name} = 1")).collect();
    let help = format!("say at which inputs the loop rests, such as [simulation] inputs = {{ {} }}", inputs.join(", "));
    NotConnected::Refused(Box::new(error.help(help)))
}

/// The only input that is a pulse.
fn place(blocks: &[BlockValues]) -> Result<Place, NotConnected> {
    let mut found: Vec<Place> = Vec::new();
    let mut pulsed = 0;
    for (block, values) in blocks.iter().enumerate() {
        let Some(DiscretizationValues::Hold(hold)) = &values.discretization else { continue };
        for (input, pulse) in hold.pulses.iter().enumerate().filter_map(|(j, pulse)| Some((j, pulse.as_ref()?))) {
            pulsed += 1;
            found.extend(pulse.steady.map(|(edges, span)| Place { block, input, edges, span }));
        }
    }
    let place = found.swap_remove(0);
    if pulsed > 1 {
        return Err(refused(
            &blocks[place.block],
            &place,
            "is not the only one with pulses, or has several pulsed inputs",
        ));
    }
    if place.edges.alternate() {
        return Err(refused(&blocks[place.block], &place, "has alternating edges: its orbit has two duty ratios"));
    }
    Ok(place)
}

/// The height of the pulses, in the unit of the plant's input: what the modulator that drives it says.
fn height(blocks: &[BlockValues], place: &Place, how: &Connecting<'_>) -> Result<RationalFunction, NotConnected> {
    let row: &Row = &blocks[place.block].inputs[place.input];
    let is_one = row.values().filter(|c| !c.is_zero()).count() == 1;
    let driver = drivers(blocks, row).next().filter(|_| is_one);
    let height = driver.and_then(|(block, c)| Some(&block.modulator.as_ref()?.amplitude * c));
    let height = height.ok_or_else(|| {
        let why = "is not driven by one block with 'pwm' alone, which says how high the pulses are";
        match refused(&blocks[place.block], place, why) {
            NotConnected::Refused(error) => NotConnected::Refused(Box::new(error.help(
                "give the block that drives it pwm = { amplitude = .., carrier = .., period = .. }; where its output is a duty ratio, the \
                 amplitude is 1",
            ))),
            other => other,
        }
    })?;
    super::state_space::substituted(&height, how.set)
}

/// Replaces the pulses by a hold; the period, and the share of it by which the pulse begins behind a sample.
fn behind_a_hold(
    block: &mut BlockValues,
    place: &Place,
    how: &Connecting<'_>,
) -> Result<(RationalFunction, Rational), NotConnected> {
    let Some(DiscretizationValues::Hold(Hold { inputs, pulses, time, delay, .. })) = &mut block.discretization else {
        unreachable!("the block is behind a modulator")
    };
    (*inputs, *pulses) = (Inputs::Constant, Vec::new());
    let [time, delay] = [&*time, &*delay].map(|f| super::state_space::substituted(f, how.set));
    let (time, delay) = (time?, delay?);
    let share = delay.checked_div(&time).and_then(|ratio| ratio.as_constant());
    let share = share.ok_or_else(|| refused(block, place, "has a dead time that is no fixed share of the period"))?;
    Ok((time, &share - &Rational::from(share.floor())))
}

/// Gives a block one more external input for each of its first states, which adds to it in each period.
fn add_to_states(system: &mut System, block: &mut BlockValues, wiring: &mut Wiring<'_>, states: usize) {
    let (rows, inputs, outputs) = (system.a.rows(), block.inputs.len(), block.outputs);
    let unit = |is: bool| if is { RationalFunction::one() } else { RationalFunction::zero() };
    let widened = |m: &RationalMatrix, rows: usize, adds: bool| {
        RationalMatrix::from_fn(rows, inputs + states, |i, j| match j.checked_sub(inputs) {
            None => m[(i, j)].clone(),
            Some(k) => unit(adds && i == k),
        })
    };
    (system.b, system.d) = (widened(&system.b, rows, true), widened(&system.d, outputs, false));
    for _ in 0..states {
        let new = wiring.driven + wiring.inputs.len();
        block.inputs.push(Row::from([(new, RationalFunction::one())]));
        wiring.inputs.push("added to a state".to_owned());
    }
}

/// How the only output at rest answers to constant inputs; `None` where the loop at rest is not unique.
fn at_rest(system: &System, how: &Connecting<'_>) -> Result<Option<Vec<RationalFunction>>, NotConnected> {
    let (n, inputs) = (system.a.rows(), system.b.columns());
    let rest = RationalMatrix::from_fn(n, n, |i, j| {
        let own = RationalFunction::from(Rational::from(Integer::from(i64::from(i == j))));
        &own - &system.a[(j, i)]
    });
    let output = RationalMatrix::from_fn(n, 1, |i, _| system.c[(0, i)].clone());
    let Some((row, _)) = solve(&rest, &output, how.budget)? else { return Ok(None) };
    let entry = |k: usize| {
        let through = (0..n).map(|i| &row[(i, 0)] * &system.b[(i, k)]);
        through.fold(system.d[(0, k)].clone(), |sum, term| &sum + &term)
    };
    Ok(Some((0..inputs).map(entry).collect()))
}

impl Model {
    /// True if certificates by boxes can be about the loop: no duty ratio of an orbit is asked for.
    ///
    /// ```
    /// assert!(jurist_model::Model::drive().is_read_by_boxes());
    /// ```
    pub fn is_read_by_boxes(&self) -> bool {
        !self.has_steady_duty()
    }

    /// Whether a block has pulses with the duty ratio of the loop at rest.
    pub fn has_steady_duty(&self) -> bool {
        let Form::Blocks(diagram) = self.form() else { return false };
        let pulses = |block: &crate::Block| block.discretization.as_ref().and_then(|d| d.pulses.clone());
        diagram.blocks.iter().filter_map(pulses).any(|pulses| pulses.is_steady)
    }
}
