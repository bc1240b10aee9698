//! Where the roots of one polynomial in an interval are, given as a list that is only read forward.

use crate::clock::Clock;
use crate::format::Json;
use crate::number::{Q, rational};
use crate::statement::number;
use crate::univariate::Uni;
use num_bigint::Sign;
use std::cell::RefCell;
use std::collections::VecDeque;

/// A root: a rational number, or the only one in an open interval at whose ends the polynomial has no root.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    pub left: Q,
    pub right: Q,
}

impl Place {
    pub fn is_rational(&self) -> bool {
        self.left == self.right
    }
}

/// The roots of a polynomial in the open interval `(lower, upper)`, where `None` is an infinite end.
///
/// Each item is a number that splits a gap, a list of a rational root, or a list of the two ends of an enclosure. They ascend, and
/// between them there is no root by Descartes' rule.
pub(super) fn roots(
    json: &[Json],
    f: &Uni,
    lower: Option<&Q>,
    upper: Option<&Q>,
    clock: &Clock,
) -> Result<Vec<Place>, String> {
    if f.is_zero() {
        return Err("a polynomial is zero everywhere".into());
    }
    let f = Signs { f, known: RefCell::default() };
    let mut found = Vec::new();
    let mut before = lower.cloned();
    for item in json {
        let (left, right) = match item {
            Json::Text(text) => {
                let q = rational(text)?;
                (q.clone(), q)
            }
            Json::List(ends) => match ends.as_slice() {
                [q] => {
                    let q = number(q, "a root")?;
                    (q.clone(), q)
                }
                [a, b] => (number(a, "an enclosure")?, number(b, "an enclosure")?),
                _ => return Err("an item of the roots has more than two numbers".into()),
            },
            _ => return Err("an item of the roots is neither a number nor a list".into()),
        };
        gap(&f, before.as_ref(), Some(&left), clock)?;
        if let Json::List(ends) = item {
            if ends.len() == 1 {
                if !f.vanishes_at(&left, clock)? {
                    return Err(format!("{left} is no root"));
                }
            } else if left >= right
                || f.vanishes_at(&left, clock)?
                || f.vanishes_at(&right, clock)?
                || f.descartes(Some(&left), Some(&right), clock)? != Some(1)
            {
                return Err(format!("there is not shown to be one root in ({left}, {right})"));
            }
            found.push(Place { left, right: right.clone() });
        } else if f.vanishes_at(&left, clock)? {
            return Err(format!("a gap is split at the root {left}"));
        }
        before = Some(right);
    }
    gap(&f, before.as_ref(), upper, clock)?;
    Ok(found)
}

/// So many signs are remembered: those at the ends of an enclosure, which its neighbours need too.
const REMEMBERED: usize = 4;

/// A polynomial with its signs at the last numbers.
struct Signs<'f> {
    f: &'f Uni,
    known: RefCell<VecDeque<(Q, Sign)>>,
}

impl Signs<'_> {
    fn at(&self, x: &Q, clock: &Clock) -> Result<Sign, String> {
        let known =
            self.known.borrow().iter().find(|(q, _)| q.numer() == x.numer() && q.denom() == x.denom()).map(|k| k.1);
        if let Some(sign) = known {
            return Ok(sign);
        }
        let sign = self.f.sign_at(x, clock)?;
        let mut known = self.known.borrow_mut();
        known.truncate(REMEMBERED - 1);
        known.push_front((x.clone(), sign));
        Ok(sign)
    }

    fn vanishes_at(&self, x: &Q, clock: &Clock) -> Result<bool, String> {
        Ok(self.at(x, clock)? == Sign::NoSign)
    }

    fn descartes(&self, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<Option<usize>, String> {
        self.f.descartes_with((a, b), &|x| self.at(x, clock), clock)
    }
}

/// That there is no root in an open interval. An interval that is empty must not be at a root: it is counted elsewhere.
fn gap(f: &Signs<'_>, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<(), String> {
    if let (Some(a), Some(b)) = (a, b)
        && a >= b
    {
        return if a == b && !f.vanishes_at(a, clock)? { Ok(()) } else { Err("the roots are not in order".into()) };
    }
    match f.descartes(a, b, clock)? {
        Some(0) => Ok(()),
        _ => Err("a gap is not shown to have no root".into()),
    }
}

/// The roots of several polynomials in ascending order, each of a place of its own.
pub(super) fn merged(lists: &[Vec<Place>]) -> Result<Vec<Place>, String> {
    let mut all: Vec<Place> = lists.iter().flatten().cloned().collect();
    all.sort_by(|a, b| (&a.left, &a.right).cmp(&(&b.left, &b.right)));
    for pair in all.windows(2) {
        let is_apart = pair[0].right < pair[1].left
            || pair[0].right == pair[1].left && !(pair[0].is_rational() && pair[1].is_rational());
        if !is_apart {
            return Err(format!("the roots near {} are not shown to be different", pair[1].left));
        }
    }
    Ok(all)
}

/// Whether a number is in a stretch: behind so many of the roots and before the next one, within the interval.
pub(super) fn is_in_stretch(q: &Q, places: &[Place], stretch: usize, lower: Option<&Q>, upper: Option<&Q>) -> bool {
    let before = stretch.checked_sub(1).and_then(|k| places.get(k));
    let above = before.is_none_or(|p| p.right < *q || (p.right == *q && !p.is_rational()));
    let below = places.get(stretch).is_none_or(|p| *q < p.left || (p.left == *q && !p.is_rational()));
    stretch <= places.len() && above && below && lower.is_none_or(|l| l < q) && upper.is_none_or(|u| q < u)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Z;
    use std::time::Duration;

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    fn found(text: &str, f: &Uni, lower: Option<i64>, upper: Option<i64>) -> Result<usize, String> {
        let Json::List(items) = Json::parse(text).unwrap() else { panic!("a list") };
        let end = |e: Option<i64>| e.map(|e| Q::from(Z::from(e)));
        roots(&items, f, end(lower).as_ref(), end(upper).as_ref(), &Clock::new(Duration::MAX)).map(|found| found.len())
    }

    #[test]
    fn lists_are_complete_or_refused() {
        let f = uni(&[0, -18, 9, -2, 1]); // x (x - 2) (x^2 + 9)
        for (text, lower, upper, count) in [
            (r#"[["0"], ["2"]]"#, None, None, 2),
            (r#"[["-1", "1"], "1", ["3/2", "3"]]"#, None, None, 2),
            (r#"[["-1", "1"], ["1", "3"]]"#, None, Some(3), 2),
            (r#"["1"]"#, Some(0), Some(2), 0),
            (r#"[["2"]]"#, Some(0), None, 1),
            (r#"["-1"]"#, None, Some(0), 0),
        ] {
            assert_eq!(found(text, &f, lower, upper), Ok(count), "{text}");
        }
        for (text, lower, upper) in [
            // A root is missing, twice there, at an end, or no root.
            (r#"[["0"]]"#, None, None),
            (r#"[["0"], ["0"], ["2"]]"#, None, None),
            (r#"[["0"], ["0", "1"], ["2"]]"#, None, None),
            (r#"[["0"], ["2"]]"#, Some(0), None),
            (r#"[["0"], ["2"]]"#, None, Some(2)),
            (r#"[["-1", "1"], ["2"]]"#, Some(0), None),
            (r#"[["0"], ["1", "3"]]"#, None, Some(2)),
            (r#"[["0"], ["1"], ["2"]]"#, None, None),
            // Out of order, an enclosure of none or of two, a split at a root, no list of numbers.
            (r#"[["2"], ["0"]]"#, None, None),
            (r#"[["0"], ["1", "3/2"], ["2"]]"#, None, None),
            (r#"[["-1", "3"]]"#, None, None),
            (r#"["0", ["2"]]"#, None, None),
            (r#"[["-1", "1", "1"], ["2"]]"#, None, None),
            (r#"[[], ["0"], ["2"]]"#, None, None),
            (r#"[0, ["0"], ["2"]]"#, None, None),
            (r#"[]"#, None, None),
        ] {
            assert!(found(text, &f, lower, upper).is_err(), "{text}");
        }
        assert!(found("[]", &Uni::default(), Some(0), Some(1)).is_err());
        assert_eq!(found("[]", &uni(&[7]), None, None), Ok(0));
    }

    #[test]
    fn different_roots_have_different_places() {
        let place = |a: i64, b: i64| Place { left: Q::from(Z::from(a)), right: Q::from(Z::from(b)) };
        let q = |n: i64| Q::from(Z::from(n));
        let all = merged(&[vec![place(0, 1), place(2, 2)], vec![place(1, 1), place(1, 2), place(2, 4)]]).unwrap();
        assert_eq!(all.len(), 5);
        assert!(merged(&[vec![place(1, 1)], vec![place(1, 1)]]).is_err());
        assert!(merged(&[vec![place(0, 2)], vec![place(1, 3)]]).is_err());
        assert!(is_in_stretch(&q(0), &all, 0, None, None) && !is_in_stretch(&q(1), &all, 0, None, None));
        assert!(!is_in_stretch(&q(1), &all, 1, None, None) && !is_in_stretch(&q(2), &all, 3, None, None));
        assert!(is_in_stretch(&q(4), &all, 5, None, Some(&q(5))) && !is_in_stretch(&q(5), &all, 5, None, Some(&q(5))));
        assert!(!is_in_stretch(&q(9), &all, 6, None, None));
    }
}
