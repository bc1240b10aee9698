//! The line of the parameter, cut into stretches and roots that a checker can verify without search.

use super::cofactors::Identity;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::real_roots::descartes_sign_variations_in;
use jurist_algebra::poly::{Domain, RealAlgebraic, UniPoly, simplest_between};
use jurist_algebra::real::Real;
use jurist_stability::{Cells, Range};

/// Irrational ends are enclosed to this many digits.
const DIGITS: usize = 12;

/// What ends a stretch.
#[derive(Clone, Debug)]
pub(super) enum Separator {
    /// The domain ends, or does not end.
    Outer(Option<Rational>),
    /// A rational root.
    At { value: Rational, touch: Option<(bool, usize)> },
    /// An irrational root.
    Between { root: RealAlgebraic, polynomial: UniPoly, factor: usize, touch: Option<(bool, usize)> },
}

/// A stretch without roots.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub split: Vec<Rational>,
    pub sample: Rational,
    pub stable: bool,
}

/// Separators, one more than stretches.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub separators: Vec<Separator>,
    pub stretches: Vec<Stretch>,
}

impl Separator {
    /// Its left and right limit.
    fn limits(&self) -> (Option<Rational>, Option<Rational>) {
        match self {
            Separator::Outer(q) => (q.clone(), q.clone()),
            Separator::At { value, .. } => (Some(value.clone()), Some(value.clone())),
            Separator::Between { root, .. } => {
                let (a, b) = root.enclosure();
                (Some(a), Some(b))
            }
        }
    }
}

impl Line {
    /// The line of an answer: its zeros, each found among the factors, and its cells.
    pub fn of(
        factors: &[UniPoly],
        domain: &Range,
        cells: &Cells,
        certain: &[UniPoly],
        identity: Option<&Identity<UniPoly>>,
        budget: &Budget,
    ) -> Result<Line, Exhausted> {
        let mut separators = vec![Separator::Outer(domain.lower.clone())];
        let mut verdicts = vec![cells.samples[0].1];
        let zeros = cells.zeros.iter().filter_map(Real::algebraic);
        for (zero, (_, stable)) in zeros.zip(&cells.samples[1..]) {
            let mut factor = None;
            for (i, f) in factors.iter().enumerate() {
                if factor.is_none() && budget.enter(|| zero.sign_of(f))?.is_eq() {
                    factor = Some(i);
                }
            }
            // A common factor of both cofactors was divided out: no root is on the boundary there.
            let Some(factor) = factor else { continue };
            separators.push(match zero.exact() {
                Some(value) => Separator::At { value, touch: None },
                None => {
                    let root = isolated(zero.refined_to_digits(DIGITS), factor, factors, budget)?;
                    Separator::Between { root, polynomial: factors[factor].clone(), factor, touch: None }
                }
            });
            verdicts.push(*stable);
        }
        separators.push(Separator::Outer(domain.upper.clone()));
        separate(&mut separators, budget)?;
        let mut stretches = Vec::new();
        for (pair, stable) in separators.windows(2).zip(verdicts) {
            let sample = between(&pair[0].limits().1, &pair[1].limits().0);
            stretches.push(Stretch { split: Vec::new(), stable, sample });
        }
        for i in 1..stretches.len() {
            if stretches[i - 1].stable && stretches[i].stable {
                touch(&mut separators[i], certain, identity, budget)?;
            }
        }
        budget.step("gaps");
        for (i, stretch) in stretches.iter_mut().enumerate() {
            budget.advance(i as u64, separators.len() as u64);
            let (l, r) = (separators[i].limits().1, separators[i + 1].limits().0);
            if l.is_none() || l != r {
                split(&l, &r, factors, &mut stretch.split, budget)?;
            }
        }
        Ok(Line { separators, stretches })
    }

    /// The separators around each stable stretch.
    pub fn stable_intervals(&self) -> Vec<(Separator, Separator)> {
        let ends = self.separators.windows(2).zip(&self.stretches).filter(|(_, s)| s.stable);
        ends.map(|(pair, _)| (pair[0].clone(), pair[1].clone())).collect()
    }
}

/// Refined until Descartes' rule sees one root of its factor and none of the others.
fn isolated(
    mut root: RealAlgebraic,
    factor: usize,
    factors: &[UniPoly],
    budget: &Budget,
) -> Result<RealAlgebraic, Exhausted> {
    loop {
        budget.check()?;
        let (a, b) = root.enclosure();
        let fits = |(i, f): (usize, &UniPoly)| {
            !f.sign_at(&a).is_eq()
                && !f.sign_at(&b).is_eq()
                && variations(f, &Some(a.clone()), &Some(b.clone())) == Some(usize::from(i == factor))
        };
        if factors.iter().enumerate().all(fits) {
            return Ok(root);
        }
        root = narrower(&root);
    }
}

/// A quarter as wide.
fn narrower(root: &RealAlgebraic) -> RealAlgebraic {
    let (a, b) = root.enclosure();
    root.refined(&((b - a) * Rational::new(Integer::ONE, Integer::from(4))))
}

/// Refines neighbours until their limits are in order.
fn separate(separators: &mut [Separator], budget: &Budget) -> Result<(), Exhausted> {
    for i in 1..separators.len() {
        loop {
            budget.check()?;
            let (left, right) = (separators[i - 1].limits().1, separators[i].limits().0);
            let both =
                matches!((&separators[i - 1], &separators[i]), (Separator::Between { .. }, Separator::Between { .. }));
            let in_order = match (&left, &right) {
                (Some(l), Some(r)) => l < r || (both && l == r),
                _ => true,
            };
            if in_order {
                break;
            }
            for k in [i - 1, i] {
                if let Separator::Between { root, .. } = &mut separators[k] {
                    *root = narrower(root);
                }
            }
        }
    }
    Ok(())
}

/// Finds a cofactor that does not vanish where two stable stretches touch, unless a root at a fixed place or a pole
/// is there.
fn touch(
    separator: &mut Separator,
    certain: &[UniPoly],
    identity: Option<&Identity<UniPoly>>,
    budget: &Budget,
) -> Result<(), Exhausted> {
    let point = match separator {
        Separator::At { value, .. } => RealAlgebraic::from_rational(value.clone()),
        Separator::Between { root, .. } => root.clone(),
        Separator::Outer(_) => return Ok(()),
    };
    let Some(identity) = identity else { return Ok(()) };
    if certain.iter().any(|c| point.sign_of(c).is_eq()) {
        return Ok(());
    }
    let all = identity.u.iter().enumerate().map(|(k, w)| ((true, k), w));
    let all = all.chain(identity.v.iter().enumerate().map(|(k, w)| ((false, k), w)));
    let Some((found, w)) = all.into_iter().find(|(_, w)| !w.is_zero() && !point.sign_of(w).is_eq()) else {
        return Ok(());
    };
    match separator {
        Separator::At { touch, .. } => *touch = Some(found),
        Separator::Between { root, touch, .. } => {
            *touch = Some(found);
            loop {
                budget.check()?;
                let (a, b) = root.enclosure();
                if variations(w, &Some(a), &Some(b)) == Some(0) {
                    break;
                }
                *root = narrower(root);
            }
        }
        Separator::Outer(_) => {}
    }
    Ok(())
}

/// A simple number in an interval that may be unbounded or a single point.
pub(super) fn between(l: &Option<Rational>, r: &Option<Rational>) -> Rational {
    match (l, r) {
        (None, None) => Rational::ZERO,
        (Some(l), None) => Rational::from(l.floor()) + Rational::ONE,
        (None, Some(r)) => Rational::from(r.ceil()) - Rational::ONE,
        (Some(l), Some(r)) => simplest_between(l, r).unwrap_or_else(|| l.clone()),
    }
}

/// A simple number about the middle; further and further out of an end that is not there.
pub(super) fn middle(l: &Option<Rational>, r: &Option<Rational>) -> Rational {
    let two = Rational::from(2);
    let beyond =
        |x: &Rational| if x.is_negative() { Rational::ONE } else { Rational::from((x * &two).ceil() + Integer::ONE) };
    match (l, r) {
        (None, None) => Rational::ZERO,
        (Some(l), None) => beyond(l),
        (None, Some(r)) => -beyond(&-r),
        (Some(l), Some(r)) => {
            let quarter = &(r - l) * &Rational::new(Integer::ONE, Integer::from(4));
            simplest_between(&(l + &quarter), &(r - &quarter)).unwrap_or_else(|| l.midpoint(r))
        }
    }
}

/// Splits an interval without roots until Descartes' rule sees none in any piece.
pub(super) fn split(
    l: &Option<Rational>,
    r: &Option<Rational>,
    factors: &[UniPoly],
    out: &mut Vec<Rational>,
    budget: &Budget,
) -> Result<(), Exhausted> {
    let mut pieces = vec![(l.clone(), r.clone())];
    while let Some((l, r)) = pieces.pop() {
        budget.check()?;
        if factors.iter().all(|f| variations(f, &l, &r) == Some(0)) {
            if let Some(r) = r.filter(|_| !pieces.is_empty()) {
                out.push(r);
            }
            continue;
        }
        let m = middle(&l, &r);
        // The left piece is looked at first.
        pieces.push((Some(m.clone()), r));
        pieces.push((l, Some(m)));
    }
    Ok(())
}

/// Descartes' bound for an open interval, `None` for the whole line and a polynomial that is not constant.
pub(super) fn variations(f: &UniPoly, l: &Option<Rational>, r: &Option<Rational>) -> Option<usize> {
    if f.is_constant() {
        return Some(0);
    }
    (l.is_some() || r.is_some()).then(|| descartes_sign_variations_in(f, l.as_ref(), r.as_ref()))
}
