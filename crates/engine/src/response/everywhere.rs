//! Whether all points of a box meet tests, by parts that cover it.

use super::requirement_boxes::{OverPoints, RequirementBoxes};
use crate::stability::boxes::corners;
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::Rational;
use std::collections::VecDeque;

/// So many corners of a box are looked at first: a box that is too large most often ends at one of them.
const CORNERS: usize = 16;

/// Work of a part, in units of a budget.
const WORK: u64 = 2000;

/// What is known of all points of a box.
///
/// ```
/// use jurist_engine::response::Everywhere;
/// assert_ne!(Everywhere::All, Everywhere::Open);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Everywhere {
    /// All meet the tests.
    All,
    /// This one does not, it seems.
    NotAt(Vec<Rational>),
    /// Neither is proved with so many parts.
    Open,
}

/// Whether all points of a closed box meet tests, by at most so many parts that cover it; the longest side is halved.
///
/// Cost: that of a look at each part for each test that it is not known to meet.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::{Everywhere, RequirementBoxes, everywhere};
/// let text = "time = 'continuous'\nparameters = { a = 2, b = 1 }\nloop.characteristic = 's^2 + a*s + b - a'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let problem = model.ask().free("a").free("b").problem()?;
/// let budget = Budget::unlimited();
/// let stable = RequirementBoxes::of_stability(&problem, &[1.into(), 2.into()], &budget)?.unwrap();
/// let box_of = |sides: [[i64; 2]; 2]| sides.map(|side| side.map(Rational::from)).to_vec();
/// assert_eq!(everywhere(&[&stable], box_of([[1, 2], [3, 4]]), 100, &budget)?, Everywhere::All);
/// assert!(matches!(everywhere(&[&stable], box_of([[1, 5], [3, 4]]), 100, &budget)?, Everywhere::NotAt(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the budget runs out.
pub fn everywhere(
    tests: &[&RequirementBoxes],
    whole: Vec<[Rational; 2]>,
    most_parts: usize,
    budget: &Budget,
) -> Result<Everywhere, Exhausted> {
    let bad = |point: &OverPoints| matches!(point, OverPoints::None | OverPoints::Open { middle: Some(false) });
    for corner in corners(&whole).take(CORNERS) {
        let point: Vec<[Rational; 2]> = corner.iter().map(|x| [x.clone(), x.clone()]).collect();
        for test in tests {
            if bad(&test.look(&point, budget)?) {
                return Ok(Everywhere::NotAt(corner));
            }
        }
    }
    let mut open: VecDeque<(Vec<[Rational; 2]>, Vec<usize>)> = [(whole.clone(), (0..tests.len()).collect())].into();
    let mut looked = 0;
    while let Some((part, asked)) = open.pop_front() {
        checkpoint(WORK);
        looked += 1;
        let mut left = Vec::new();
        for &k in &asked {
            match tests[k].look(&part, budget)? {
                OverPoints::All => {}
                told if bad(&told) => {
                    return Ok(Everywhere::NotAt(part.iter().map(|[low, high]| low.midpoint(high)).collect()));
                }
                _ => left.push(k),
            }
        }
        if left.is_empty() {
            continue;
        }
        let share = |i: &usize| {
            (&part[*i][1] - &part[*i][0]).checked_div(&(&whole[*i][1] - &whole[*i][0])).unwrap_or(Rational::ZERO)
        };
        let axis = (0..part.len()).filter(|i| part[*i][0] < part[*i][1]).rev().max_by_key(share);
        let (Some(axis), true) = (axis, looked < most_parts) else { return Ok(Everywhere::Open) };
        let at = part[axis][0].midpoint(&part[axis][1]);
        for end in [0, 1] {
            let mut half = part.clone();
            half[axis][end] = at.clone();
            open.push_back((half, left.clone()));
        }
    }
    Ok(Everywhere::All)
}
