//! Where the roots of a sampled loop are whose coefficients are only enclosed.

use super::clock::Clock;
use super::model::{Boxed, Functions};
use super::moving::value;
use super::multivariate::Multi;
use super::number::Q;
use super::over::inside;
use super::over_box::{By, in_region, with_sources};
use super::roots::Places;
use super::statement::Extent;
use super::taylor::{Precision, Taylor};
use super::{Rejection, Step, is_same_time};

/// The degree, and where so many roots are: none on the boundary, none at infinity.
pub(super) fn places(
    model: &str,
    set: &[(String, Q)],
    extent: &Extent,
    bits: usize,
    clock: &Clock,
) -> Result<(usize, Places), Rejection> {
    let boxed = Boxed { names: &[], set, factor: None };
    let by = By::Enclosures { window: &[], bits };
    let (own, sources) = Step::Model.of(with_sources(model, boxed, Functions::Moving, by, clock))?;
    Step::Model.of(is_same_time(own.discrete && !sources.have_dead_time(), true))?;
    Step::Stable.of((|| {
        let p = Precision::new(0, 1, bits);
        let known = sources.values(Vec::new(), &p, clock)?;
        let number = |f: &Multi| -> Result<Taylor, String> { value(f, &known, &p, clock) };
        for parts in &own.divisors {
            let signs = parts.iter().map(|f| Ok(number(f)?.sign())).collect::<Result<Vec<_>, String>>()?;
            if signs.iter().all(Option::is_none) {
                return Err("a divisor is not shown to be other than zero".into());
            }
        }
        let d = in_region(&own.coefficients, true, extent, clock)?;
        let d = d.iter().map(|c| Ok(number(c)?.range())).collect::<Result<Vec<_>, String>>()?;
        let degree = d.len() - 1;
        let inside = inside(d, false, bits, clock)?;
        let places = Places { inside, on: 0, outside: degree - inside };
        if own.is_doubled { Ok((degree / 2, places.halved()?)) } else { Ok((degree, places)) }
    })())
}
