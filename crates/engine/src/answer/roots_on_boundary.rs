//! Which of the roots that are listed are on the boundary: the exact count of those that are tells it.

use super::roots::ClosedLoopRoot;
use crate::model::Time;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RootDisc;

/// How many roots a disc stands for.
pub(super) fn number(disc: &RootDisc) -> usize {
    if disc.is_pair { 2 * disc.count } else { disc.count }
}

/// Marks the roots that are on the boundary, where as many are on it as have a disc that meets it.
pub(super) fn tell_boundary(
    list: &mut [ClosedLoopRoot],
    on_boundary: impl FnOnce() -> Result<usize, Exhausted>,
) -> Result<(), Exhausted> {
    let mut near: Vec<&mut ClosedLoopRoot> = list.iter_mut().filter(|root| may_be_on_boundary(root)).collect();
    let count: usize = near.iter().map(|root| number(&root.disc)).sum();
    if count > 0 && on_boundary()? == count {
        near.iter_mut().for_each(|root| root.is_on_boundary = true);
    }
    Ok(())
}

/// Whether its disc meets the boundary.
fn may_be_on_boundary(root: &ClosedLoopRoot) -> bool {
    let (re, radius) = (&root.disc.re, &root.disc.radius);
    if root.time == Time::Continuous {
        return re.abs() <= *radius;
    }
    let square = re * re + &root.disc.im * &root.disc.im;
    let inner = (&Rational::ONE - radius).max(Rational::ZERO);
    let outer = &Rational::ONE + radius;
    (&inner * &inner..=&outer * &outer).contains(&square)
}
