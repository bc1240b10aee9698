//! One parameter: the parts of an interval in which roots may come to the boundary.

use super::family::Family;
use super::look::BoxLook;
use crate::subdivision::{BoxPart, Look, Octaves, Order, Tally, subdivide};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// Parts are halved until they are this much shorter than the greatest value in them, in bits: then a boundary function is monotone around its zero.
const SHORT_BITS: u64 = 8;

/// After so many looks what is left stays open.
const MOST_LOOKS: usize = 1500;

/// The closed parts of an interval, ascending and apart, in which roots of a loop in one parameter may come to the boundary. At all other values no root
/// is there, and the loop is defined.
///
/// Cost: some tens of looks for each value at which a root crosses.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn open_parts(
    family: &impl Family,
    [from, to]: [&Rational; 2],
    budget: &Budget,
) -> Result<Vec<(Rational, Rational)>, Exhausted> {
    budget.step("looking for values at which roots come to the boundary");
    let see = family.looks();
    let mut open: Vec<(Rational, Rational)> = Vec::new();
    let look = |cell: &mut Octaves, tally: Tally| {
        let part = &cell.0;
        if see(part, budget)? != BoxLook::Open(0) {
            return Ok(Look::Decided(()));
        }
        let [low, high] = &part.sides[0];
        let short = low.abs().max(high.abs()) * Rational::dyadic(&1.into(), SHORT_BITS);
        if high - low > short && tally.looks() < MOST_LOOKS {
            return Ok(Look::Cut(0));
        }
        open.push((low.clone(), high.clone()));
        Ok(Look::<(), ()>::Decided(()))
    };
    let whole = Octaves(BoxPart::whole([[from.clone(), to.clone()]]));
    let _ = subdivide([whole], Order::Breadth, budget, look)?;
    open.sort();
    let mut joined: Vec<(Rational, Rational)> = Vec::new();
    for (low, high) in open {
        match joined.last_mut() {
            Some(last) if last.1 == low => last.1 = high,
            _ => joined.push((low, high)),
        }
    }
    Ok(joined)
}
