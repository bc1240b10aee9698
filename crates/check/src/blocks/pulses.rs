//! `edge` and `duty` of a block behind a pulse-width modulator.

use super::{Diagram, Row};
use crate::hold::{Pulse, Pulses};
use crate::multivariate::Fraction;
use crate::number::Q;
use crate::toml::Toml;
use num_traits::{One, Signed};

/// Signals from this number on are external.
const EXTERNAL: usize = usize::MAX / 2;

impl Diagram<'_, '_> {
    /// The pulses of inputs; none of another method. With one word for all of them, an input that no signal of the loop is in is held.
    pub(super) fn pulses(&mut self, how: &Toml, method: &str, inputs: &[Row]) -> Result<Pulses<Fraction>, String> {
        let (edges, duties) = (how.get("edge"), how.get("duty"));
        if method != "pwm" {
            return if edges.is_none() && duties.is_none() {
                Ok(Vec::new())
            } else {
                Err("only 'pwm' has an edge and a duty ratio".into())
            };
        }
        if ["T", "c", "prewarp"].iter().any(|key| how.get(key).is_some()) {
            return Err("a modulator has no sample time of its own".into());
        }
        let edges = edges.map(Toml::one_or_more).unwrap_or_default();
        let duties = duties.map(Toml::one_or_more).unwrap_or_default();
        for list in [&edges, &duties] {
            if list.is_empty() || (list.len() != 1 && list.len() != inputs.len()) {
                return Err("a modulator has one edge and one duty ratio, or one for each input".into());
            }
        }
        let mut ratios = Vec::with_capacity(duties.len());
        for duty in duties {
            let duty = self.scope.scalar(duty)?;
            let duty = self.scope.real(duty)?;
            if duty.as_number().is_some_and(|d| !d.is_positive() || d >= Q::one()) {
                return Err("the duty ratio of a modulator is not between 0 and 1".into());
            }
            ratios.push(duty);
        }
        let mut out = Vec::with_capacity(inputs.len());
        for (j, row) in inputs.iter().enumerate() {
            let of = |len: usize| if len == 1 { 0 } else { j };
            let places = places(edges[of(edges.len())].text()?)?;
            let is_external = edges.len() == 1
                && inputs.len() > 1
                && row.iter().all(|(signal, c)| *signal >= EXTERNAL || c.numerator.is_zero());
            if is_external || places.is_empty() {
                out.push(None);
                continue;
            }
            let duty = &ratios[of(ratios.len())];
            let clock = self.scope.clock;
            let place = |(begin, slope): &(i64, i64)| {
                let [begin, slope] = [begin, slope].map(|k| Fraction::number(&Q::new((*k).into(), 2.into())));
                begin.plus(&slope.times(duty, clock)?, clock)
            };
            let edges = places.iter().map(place).collect::<Result<_, _>>()?;
            out.push(Some(Pulse { duty: duty.clone(), edges }));
        }
        if out.iter().all(Option::is_none) {
            return Err("no input of a modulator is a pulse".into());
        }
        Ok(out)
    }
}

/// Twice the places of the edges in a period of 1: what each has without the duty ratio, and its factor; none of an input that is held.
fn places(word: &str) -> Result<&'static [(i64, i64)], String> {
    Ok(match word {
        "hold" => &[],
        "trailing" => &[(0, 2)],
        "leading" => &[(2, -2)],
        "double" => &[(1, -1), (1, 1)],
        "double-ends" => &[(0, 1), (2, -1)],
        _ => return Err("a modulator has an edge that is not known".into()),
    })
}
