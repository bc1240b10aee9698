//! Better gains near to ones that are known: short steps, each of them decided exactly.

use crate::parts::Parts;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::error::Error;

/// So many points are asked at most.
const MOST_POINTS: usize = 90;

/// After so many points in a row that are no better the steps become half as long.
const PATIENCE: usize = 5;

/// A step begins as a share of the bounds, and is halved so often at most.
const FIRST: Halvings = 3;
const LAST: Halvings = 12;

/// Points lie on a grid: the bounds halved so often.
const GRID: u64 = 24;

type Halvings = u64;

/// Numbers that look like chance and are the same in each run: they choose only where to look.
struct Chance(u64);

impl Chance {
    /// From -128 to 127.
    fn next(&mut self) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 56) as i64) - 128
    }
}

/// Goes from a point to better ones as long as there are some; `is_better` decides whether one is taken, and remembers it.
///
/// # Errors
/// Those of `is_better`.
pub(crate) fn climb(
    parts: &Parts<'_, '_>,
    start: Vec<Rational>,
    is_better: &mut dyn FnMut(&[Rational]) -> Result<bool, Error>,
) -> Result<(), Error> {
    let mut chance = Chance(start.len() as u64);
    let (mut here, mut halvings, mut misses) = (start, FIRST, 0);
    let mut last: Option<Vec<i64>> = None;
    for _ in 0..MOST_POINTS {
        // A direction that was good is gone on in.
        let way = last.take().unwrap_or_else(|| here.iter().map(|_| chance.next()).collect());
        let there = moved(parts, &here, &way, halvings);
        if there != here && is_better(&there)? {
            (here, misses, last) = (there, 0, Some(way));
            continue;
        }
        misses += 1;
        if misses >= PATIENCE {
            (halvings, misses) = (halvings + 1, 0);
            if halvings > LAST {
                break;
            }
        }
    }
    Ok(())
}

/// A point beside another one, within the bounds.
fn moved(parts: &Parts<'_, '_>, here: &[Rational], way: &[i64], halvings: Halvings) -> Vec<Rational> {
    let step = |((x, way), [low, high]): ((&Rational, &i64), &[Rational; 2])| {
        let width = high - low;
        let by = &width * &Rational::dyadic(&Integer::from(*way), 7 + halvings);
        let share = (x + &by - low).checked_div(&width).unwrap_or(Rational::ZERO);
        let place = (share * Rational::dyadic(&(Integer::ONE << GRID), 0)).floor();
        (low + &(&width * &Rational::dyadic(&place, GRID))).max(low.clone()).min(high.clone())
    };
    here.iter().zip(way).zip(&parts.whole).map(step).collect()
}
