//! Factors of curves in which one parameter alone occurs.

use super::curves::{X, Y, is_number, without_number};
use super::over_symbols::{OverSymbols, in_one};
use jurist_algebra::ball::{Ball, enclosed_resultant};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, MultiPoly};

/// Bits with which it is tried to see that two coefficients have no common zero.
const BITS: [u64; 3] = [256, 1024, 4096];

/// The factor in `x` alone, the factor in `y` alone, and what is left.
pub(super) fn separated(p: &MultiPoly) -> Vec<MultiPoly> {
    let content = |p: &MultiPoly, main: usize| p.as_poly_in(main).content();
    let exact = |a: &MultiPoly, b: &MultiPoly| a.div_exact(b).expect("the content divides");
    let p = without_number(p);
    let in_x = content(&p, Y);
    let rest = exact(&p, &in_x);
    let in_y = content(&rest, X);
    let rest = exact(&rest, &in_y);
    [in_x, in_y, rest].into_iter().filter(|f| !is_number(f)).collect()
}

/// The same where only the values of the symbols may show a factor: of `x y - r x - r y + 2` with `r = sqrt(2)` they are `x - r` and
/// `y - r`.
pub(super) fn separated_over_numbers(
    ground: &OverSymbols,
    p: &MultiPoly,
    budget: &Budget,
) -> Result<Vec<MultiPoly>, Exhausted> {
    let mut parts = budget.enter(|| separated(p))?;
    let Some(k) = parts.iter().position(|f| f.degree_in(X) > 0 && f.degree_in(Y) > 0) else { return Ok(parts) };
    for own in [X, Y] {
        let Some(content) = content_over_numbers(ground, &parts[k], own, budget)? else { continue };
        // The remainder is zero as a number.
        let divisor = content.as_poly_in(own);
        let (quotient, _) = budget.enter(|| parts[k].as_poly_in(own).pseudo_div_rem(&divisor))?;
        parts[k] = budget.enter(|| without_number(&MultiPoly::from_poly_in(&quotient, own)))?;
        parts.push(content);
    }
    Ok(parts)
}

/// The greatest factor of a polynomial in which one parameter occurs and the other does not, square-free; `None` where there is none.
fn content_over_numbers(
    ground: &OverSymbols,
    p: &MultiPoly,
    own: usize,
    budget: &Budget,
) -> Result<Option<MultiPoly>, Exhausted> {
    let other = if own == X { Y } else { X };
    let coefficients: Vec<MultiPoly> = p.as_poly_in(other).into_coeffs().into_iter().filter(|c| !c.is_zero()).collect();
    let enclosed = |c: &MultiPoly, bits: u64| -> Vec<Ball> {
        c.as_poly_in(own).coeffs().iter().map(|number| ground.constant(number, bits)).collect()
    };
    // Nearly always two coefficients show it.
    let are_apart = |a: &[Ball], b: &[Ball]| match (a, b) {
        ([constant], _) | (_, [constant]) => !constant.contains_zero(),
        _ => !enclosed_resultant(a, b).contains_zero(),
    };
    for bits in BITS {
        let is_seen = budget.enter(|| {
            let balls: Vec<Vec<Ball>> = coefficients.iter().map(|c| enclosed(c, bits)).collect();
            (1..balls.len()).any(|k| are_apart(&balls[k - 1], &balls[k]))
        })?;
        if is_seen {
            return Ok(None);
        }
    }
    let list: Vec<MultiPoly> = coefficients.iter().map(|c| in_one(c, own)).collect();
    let divisor = ground.symbols.greatest_common_divisor(&list, budget)?;
    if divisor.degree_in(0) == 0 {
        return Ok(None);
    }
    let divisor = ground.symbols.square_free_part(&divisor, budget)?;
    Ok(Some(divisor.map_variables(|i| if i == 0 { own } else { i + 1 })))
}
