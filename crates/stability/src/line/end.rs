//! What happens at the end of a stable cell.

use super::{Common, Held, Place, Ring};
use crate::{Cause, Causes, End, Range};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;

/// The end at a place, with all that happens there; `None` where nothing happens between two stable cells.
pub(crate) fn named_end(
    ring: &dyn Ring,
    range: &Range,
    place: Place<'_>,
    is_between: bool,
) -> Result<Option<End>, Exhausted> {
    let Held { causes: held, has_roots } = ring.held(place)?;
    let mut causes = Causes::default();
    for &cause in &held {
        match cause {
            Cause::ComplexPair => {}
            Cause::RootAtOne | Cause::RootAtMinusOne | Cause::RootAtZero if !has_roots => {}
            cause => causes.insert(cause),
        }
    }
    let mut pair = None;
    if has_roots && held.contains(&Cause::ComplexPair) {
        match ring.common_roots(place)? {
            Common::Pair(found) => {
                pair = Some(found);
                causes.insert(Cause::ComplexPair);
            }
            Common::Beyond => {}
            // A double root at an end of the boundary is named by its own cause.
            Common::Unknown if causes.iter().next().is_some() => {}
            Common::Unknown => causes.insert(Cause::ComplexPair),
        }
    }
    let exact = place.value.exact();
    let is_end = |end: &Option<Rational>| end.is_some() && *end == exact;
    if is_end(&range.lower) || is_end(&range.upper) {
        causes.insert(Cause::Domain);
    }
    let is_nothing = is_between && causes.iter().next().is_none();
    Ok((!is_nothing).then(|| End::new(place.value.clone(), causes, pair)))
}
