//! What two stable sets have in common: those of factors of one polynomial.

use super::stable_set::{End, StableInterval, StableSet, UndecidedBracket};
use super::{Causes, ComplexPair};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};
use std::cmp::Ordering;

/// Digits to which an end inside of a bracket is rounded outward.
const DIGITS: usize = 18;

impl StableSet {
    /// The values that lie in both sets.
    ///
    /// An end of one set that some thousand bits do not tell from one of the other need not be told from it: the lesser, or the greater,
    /// of two numbers is enclosed without that. Where nothing is known of one set, nothing is known where the other one is stable or
    /// undecided.
    ///
    /// Cost: comparisons of `O(n + m)` ends.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn intersection(&self, other: &StableSet, budget: &Budget) -> Result<StableSet, Exhausted> {
        let (a, b) = (self.intervals(), other.intervals());
        let mut open: Vec<UndecidedBracket> = Vec::new();
        let mut intervals = Vec::new();
        let (mut i, mut j) = (0, 0);
        while i < a.len() && j < b.len() {
            let (lower, _) = inner(&a[i].lower, &b[j].lower, Ordering::Greater, budget)?;
            let (upper, first) = inner(&a[i].upper, &b[j].upper, Ordering::Less, budget)?;
            match (&lower, &upper) {
                (Some(l), Some(u)) => match order(&l.value, &u.value, budget)? {
                    Some(Ordering::Less) => intervals.push(StableInterval::new(lower, upper)),
                    Some(_) => {}
                    None => open.push(around(&l.value, &u.value)),
                },
                _ => intervals.push(StableInterval::new(lower, upper)),
            }
            if first != Some(Ordering::Greater) {
                i += 1;
            }
            if first != Some(Ordering::Less) {
                j += 1;
            }
        }
        for (own, of) in [(self, other), (other, self)] {
            let inside = own.undecided().iter().flat_map(|bracket| {
                of.intervals().iter().filter_map(move |interval| within(bracket, &outward(interval), bracket))
            });
            open.extend(inside);
        }
        let both = self.undecided().iter().flat_map(|x| {
            other.undecided().iter().filter_map(move |y| within(x, &(y.lower.clone(), y.upper.clone()), x))
        });
        open.extend(both);
        Ok(StableSet::from_intervals(intervals, joined(open)))
    }
}

/// The end of an intersection, and how the first end compares with the second; `None` where they are not told apart.
fn inner(
    a: &Option<End>,
    b: &Option<End>,
    wanted: Ordering,
    budget: &Budget,
) -> Result<(Option<End>, Option<Ordering>), Exhausted> {
    let (x, y) = match (a, b) {
        (None, None) => return Ok((None, Some(Ordering::Equal))),
        (Some(_), None) => return Ok((a.clone(), Some(wanted))),
        (None, Some(_)) => return Ok((b.clone(), Some(wanted.reverse()))),
        (Some(x), Some(y)) => (x, y),
    };
    let found = order(&x.value, &y.value, budget)?;
    let end = match found {
        Some(Ordering::Equal) => End::new(x.value.clone(), both_causes(x, y), lower_pair(&x.pair, &y.pair)),
        Some(order) => (if order == wanted { x } else { y }).clone(),
        None if x.value.algebraic().is_some() || y.value.algebraic().is_some() => {
            return Err(Exhausted::new(Stop::Separation, "comparing limits of two factors"));
        }
        None => {
            let extreme = Extreme { values: [x.value.clone(), y.value.clone()], is_greater: wanted.is_gt() };
            End::new(Transcendental::new(extreme), both_causes(x, y), lower_pair(&x.pair, &y.pair))
        }
    };
    Ok((Some(end), found))
}

/// The order of two numbers; `None` where some thousand bits do not tell them apart.
fn order(a: &Real, b: &Real, budget: &Budget) -> Result<Option<Ordering>, Exhausted> {
    match a.compare(b, budget) {
        Err(stopped) if stopped.stop.is_precision() => Ok(None),
        found => found.map(Some),
    }
}

fn both_causes(a: &End, b: &End) -> Causes {
    let mut causes = a.causes.clone();
    b.causes.iter().for_each(|cause| causes.insert(cause));
    causes
}

/// The pair of lower frequency.
fn lower_pair(a: &Option<ComplexPair>, b: &Option<ComplexPair>) -> Option<ComplexPair> {
    let (Some(x), Some(y)) = (a, b) else { return a.clone().or_else(|| b.clone()) };
    let frequency = |pair: &ComplexPair| pair.angle(64).or_else(|| pair.angular_frequency(64));
    match (frequency(x), frequency(y)) {
        (Some(f), Some(g)) if g.upper() < f.lower() => b.clone(),
        _ => a.clone(),
    }
}

/// The greater or the lesser of two numbers, neither of them rational.
#[derive(Debug)]
struct Extreme {
    values: [Real; 2],
    is_greater: bool,
}

impl Enclosing for Extreme {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        let [(a, b), (c, d)] = [0, 1].map(|k: usize| self.values[k].refined(&width).enclosure());
        if self.is_greater { Enclosure::new(a.max(c), b.max(d)) } else { Enclosure::new(a.min(c), b.min(d)) }
    }

    fn origin(&self) -> Origin {
        let other = || Origin::Function { function: "the nearer of two limits".to_owned(), details: Vec::new() };
        let transcendental = self.values.iter().find_map(|x| match x {
            Real::Transcendental(x) => Some(x.origin()),
            Real::Algebraic(_) => None,
        });
        transcendental.unwrap_or_else(other)
    }
}

/// Between rational ends; none is infinite.
type Bounds = (Option<Rational>, Option<Rational>);

/// An interval with its ends rounded outward.
fn outward(interval: &StableInterval) -> Bounds {
    let end = |end: &Option<End>| end.as_ref().map(|end| end.value.refined_to_digits(DIGITS).enclosure());
    (end(&interval.lower).map(|(lo, _)| lo), end(&interval.upper).map(|(_, hi)| hi))
}

/// The part of a bracket between bounds.
fn within(bracket: &UndecidedBracket, bounds: &Bounds, named: &UndecidedBracket) -> Option<UndecidedBracket> {
    let later = |a: &Option<Rational>, b: &Option<Rational>| match (a, b) {
        (Some(a), Some(b)) => Some(a.clone().max(b.clone())),
        _ => a.clone().or_else(|| b.clone()),
    };
    let earlier = |a: &Option<Rational>, b: &Option<Rational>| match (a, b) {
        (Some(a), Some(b)) => Some(a.clone().min(b.clone())),
        _ => a.clone().or_else(|| b.clone()),
    };
    let (lower, upper) = (later(&bracket.lower, &bounds.0), earlier(&bracket.upper, &bounds.1));
    let is_part = match (&lower, &upper) {
        (Some(lo), Some(hi)) => lo <= hi,
        _ => true,
    };
    is_part.then(|| UndecidedBracket::new(lower, upper, named.why.clone()))
}

/// A bracket around two numbers that are not told apart.
fn around(a: &Real, b: &Real) -> UndecidedBracket {
    let [(lo, hi), (least, most)] = [a, b].map(Real::enclosure);
    UndecidedBracket::new(Some(lo.min(least)), Some(hi.max(most)), "limits that are not told apart")
}

/// Whether two brackets are one: the second begins in the first, or where that ends for the same reason.
fn overlap(first: &UndecidedBracket, second: &UndecidedBracket) -> bool {
    match (&first.upper, &second.lower) {
        (Some(end), Some(begin)) => begin < end || (begin == end && first.why == second.why),
        _ => true,
    }
}

/// Ascending, those that overlap as one.
fn joined(mut brackets: Vec<UndecidedBracket>) -> Vec<UndecidedBracket> {
    brackets.sort_by(|a, b| (&a.lower, &a.upper).cmp(&(&b.lower, &b.upper)));
    let mut out: Vec<UndecidedBracket> = Vec::new();
    for bracket in brackets {
        match out.last_mut() {
            Some(last) if overlap(last, &bracket) => {
                let is_open = last.upper.is_none() || bracket.upper.is_none();
                last.upper = if is_open { None } else { bracket.upper.max(last.upper.clone()) };
            }
            _ => out.push(bracket),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cause;

    fn end(x: i64) -> Option<End> {
        Some(End::new(Rational::from(x), Cause::RootAtOne.into(), None))
    }

    fn set(intervals: &[(i64, i64)], open: &[(i64, i64)]) -> StableSet {
        let intervals = intervals.iter().map(|&(a, b)| StableInterval::new(end(a), end(b))).collect();
        let bracket = |&(a, b): &(i64, i64)| UndecidedBracket::new(Some(a.into()), Some(b.into()), "not known");
        StableSet::from_intervals(intervals, open.iter().map(bracket).collect())
    }

    type Ranges = Vec<(i64, i64)>;

    fn shown(set: &StableSet) -> (Ranges, Ranges) {
        let whole = |x: Rational| x.floor().to_i64().unwrap();
        let value = |end: &Option<End>| whole(end.as_ref().unwrap().value.exact().unwrap());
        let stable = set.intervals().iter().map(|i| (value(&i.lower), value(&i.upper))).collect();
        let bracket = |b: &UndecidedBracket| (whole(b.lower.clone().unwrap()), whole(b.upper.clone().unwrap()));
        (stable, set.undecided().iter().map(bracket).collect())
    }

    #[test]
    fn cells_of_two_sets_are_cut_by_both_and_what_one_does_not_know_is_open_only_where_the_other_may_be_stable() {
        let budget = Budget::unlimited();
        let a = set(&[(0, 4), (4, 10), (20, 30)], &[(10, 12)]);
        let b = set(&[(2, 11), (22, 24), (25, 40)], &[(40, 50)]);
        let expected = (vec![(2, 4), (4, 10), (22, 24), (25, 30)], vec![(10, 11)]);
        assert_eq!(shown(&a.intersection(&b, &budget).unwrap()), expected);
        assert_eq!(shown(&b.intersection(&a, &budget).unwrap()), expected);
        // Each value, counted one by one.
        let both = a.intersection(&b, &budget).unwrap();
        for twice in 0..120i64 {
            let x = Rational::new(twice.into(), 2.into());
            assert_eq!(both.contains(&x), a.contains(&x) && b.contains(&x), "{x}");
        }
        let nothing = a.intersection(&set(&[], &[]), &budget).unwrap();
        assert!(nothing.is_empty() && nothing.undecided().is_empty());
    }

    #[derive(Debug)]
    struct Logarithm;

    impl Enclosing for Logarithm {
        fn enclose(&self, bits: u64, _: Option<&Enclosure>) -> Enclosure {
            Enclosure::from_rational(Rational::from(2)).ln(bits + 8).expect("positive")
        }
        fn origin(&self) -> Origin {
            Origin::Function { function: "ln 2".into(), details: Vec::new() }
        }
    }

    #[test]
    #[ignore = "long: CI runs it"]
    fn ends_that_are_not_told_apart_need_not_be() {
        let budget = Budget::unlimited();
        let one = || {
            let upper = End::new(Transcendental::new(Logarithm), Cause::ComplexPair.into(), None);
            StableSet::from_intervals(vec![StableInterval::new(end(0), Some(upper))], Vec::new())
        };
        let both = one().intersection(&one(), &budget).unwrap();
        assert_eq!(both.intervals()[0].upper.as_ref().unwrap().value.decimal(12), "0.693147180560");
        assert!(both.undecided().is_empty());
    }
}
