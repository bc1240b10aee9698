//! Blocks that command pulses, and the plants behind them.

use super::state_space::{Connecting, NotConnected, substituted};
use crate::error::{Code, Diagnostic};
use crate::evaluate::values::{BlockValues, DiscretizationValues, Row};
use crate::text::names::shorten;
use jurist_algebra::poly::RationalFunction;

/// The blocks whose outputs an input reads, each with the coefficient of the output.
pub(super) fn drivers<'b>(
    blocks: &'b [BlockValues],
    input: &'b Row,
) -> impl Iterator<Item = (&'b BlockValues, &'b RationalFunction)> {
    // Signals are numbered block by block, and external ones come last.
    let block = |signal: usize| {
        let mut next = 0;
        blocks.iter().find(|block| {
            next += block.outputs;
            signal < next
        })
    };
    let read = input.iter().filter(|(_, c)| !c.is_zero());
    read.filter_map(move |(signal, c)| Some((block(*signal)?, c)))
}

/// Refuses pulses whose modulator has another period than the plant behind it, which has one pulse in each sample time.
pub(super) fn periods_agree(blocks: &[BlockValues], how: &Connecting<'_>) -> Result<(), NotConnected> {
    for block in blocks {
        let Some(DiscretizationValues::Hold(hold)) = &block.discretization else { continue };
        let pulsed = block.inputs.iter().zip(&hold.pulses).filter(|(_, pulse)| pulse.is_some());
        for (driver, _) in pulsed.flat_map(|(input, _)| drivers(blocks, input)) {
            let Some(modulator) = &driver.modulator else { continue };
            if substituted(&modulator.period, how.set)? != substituted(&hold.time, how.set)? {
                let (name, plant) = (shorten(&driver.name), shorten(&block.name));
                let message = format!("the pulses of '{name}' have another period than the sample time of '{plant}'");
                let error = Diagnostic::error(Code::Discretize, message).at(modulator.span, "not the sample time");
                let help = "there is one pulse in each sample time of the loop: write that as the 'period' of 'pwm'";
                return Err(NotConnected::Refused(Box::new(error.also(hold.span, "behind these pulses").help(help))));
            }
        }
    }
    Ok(())
}
