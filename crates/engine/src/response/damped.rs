//! The values of a parameter at which a root of a discrete loop enters or leaves the spiral of a damping.

use super::on_roots::Changes;
use super::spiral::{Arc, OnSpiral, Values, is_one_to_one};
use crate::stability::subdivision::{BoxPart, Look, Order, Tally, subdivide};
use crate::stability::{Bracket, Cause, End, StableInterval};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::simplest_between;
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};

/// Bits of the search.
const BITS: u64 = 128;
/// Arcs of a search are halved so often at most, and once more with each halving of the box: all roots may go to 1 with the parameter,
const ARCS: u64 = 24;
/// and only while no more of them are open: beside few roots near the edge.
const MOST_OPEN: usize = 24;
/// A value is enclosed with so many bits after the point at first.
const PLACE_BITS: u64 = 64;
/// Of a number that may be one at which a root is on the edge, above and below the line together.
const SHORT_BITS: u64 = 24;
/// Boxes of the parameter are halved so often at most.
const BOXES: u32 = 24;
/// An interval without end is looked at so many times as far as its other end and the usual value.
const FAR: i64 = 1024;
/// So many of them may be left open,
const MOST_LEFT: usize = 32;
/// and so many boxes are looked at, within this part of the time. What is open then stays so.
const MOST_LOOKS: usize = 4000;
const SEARCH_SHARE: (u32, u32) = (1, 2);

/// The values strictly inside of a stable interval, ascending; they are not algebraic.
///
/// The interval is cut into boxes on which the edge of the spiral is walked for all values at once: either the number of
/// roots inside is the same for all of them, or near one arc the function has independent derivatives, so that it
/// vanishes once at most, and the numbers at both ends of the box tell whether it does.
///
/// Cost: some tens of walks for each value.
///
/// Where boxes get too small a bracket is left: near a double root at 1, and where roots touch the edge. So is what is far away in an
/// interval without end.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn changes(p: &OnSpiral, interval: &StableInterval, budget: &Budget) -> Result<Changes, Exhausted> {
    let far = far_from(interval, p.usual());
    let [lower, upper] = [(&interval.lower, -&far), (&interval.upper, far)]
        .map(|(end, far)| end.clone().unwrap_or_else(|| End::new(far, Cause::Undecided.into(), None)));
    let (a, b) = (lower.value.refined_to_digits(15).enclosure(), upper.value.refined_to_digits(15).enclosure());
    let outer = [a.0.clone(), b.1.clone()];
    let part = budget.share(SEARCH_SHARE.0, SEARCH_SHARE.1);
    let search = Search { p, ends: [&lower, &upper], outer, inner: [a.1, b.0], budget: &part };
    let [from, to] = [a.0, b.1];
    let whole = BoxPart::whole([[from.clone(), to.clone()]]);
    // The parts in which all is known, each with the value in it, if it has one.
    let mut decided: Vec<([Rational; 2], Option<Real>)> = Vec::new();
    let mut left = 0;
    let look = |part: &mut BoxPart, tally: Tally| {
        if tally.looks() >= MOST_LOOKS {
            return Ok(Look::Open(()));
        }
        let Some(seen) = search.look(part)? else {
            left += 1;
            return Ok(if left > MOST_LEFT { Look::Open(()) } else { Look::Decided(()) });
        };
        Ok(match seen {
            Seen::Decided(value) => {
                decided.push((part.sides[0].clone(), value));
                Look::Decided(())
            }
            Seen::Beside(place) => {
                let [from, to] = &part.sides[0];
                decided.push(([from.clone(), place.lower().clone()], None));
                decided.push(([place.upper().clone(), to.clone()], None));
                Look::Decided(())
            }
            Seen::Cut => Look::Cut(0),
        })
    };
    // Large boxes first: what is hard hides nothing else.
    match subdivide([whole], Order::Breadth, &part, look) {
        Err(_) if budget.check().is_ok() => {}
        ended => drop(ended?),
    }
    decided.sort_by(|(a, _), (b, _)| a[0].cmp(&b[0]));
    let (mut out, mut open): (Vec<Real>, Vec<Bracket>) = (Vec::new(), Vec::new());
    let mut reached = from;
    for ([lower, upper], value) in decided {
        if reached < lower {
            open.push((Some(reached), Some(lower)));
        }
        out.extend(value);
        reached = upper;
    }
    if reached < to {
        open.push((Some(reached), Some(to)));
    }
    if interval.lower.is_none() {
        open.insert(0, (None, lower.value.exact()));
    }
    if interval.upper.is_none() {
        open.push((upper.value.exact(), None));
    }
    Ok((out, open))
}

/// How far an interval without end is looked at.
fn far_from(interval: &StableInterval, usual: &Rational) -> Rational {
    let ends = [&interval.lower, &interval.upper].into_iter().flatten();
    let size = |end: &End| {
        let (lo, hi) = end.value.refined_to_digits(2).enclosure();
        lo.abs().max(hi.abs())
    };
    let size = ends.map(size).chain([usual.abs()]).max().expect("the usual value is one");
    Rational::from((size * Rational::from(FAR)).ceil())
}

/// What a look at a box tells.
enum Seen {
    /// All is known, with the one value that it may have.
    Decided(Option<Real>),
    /// All is known but for what is in here: a root may be on the edge at a short number, which nothing proves.
    Beside(Enclosure),
    Cut,
}

struct Search<'a> {
    p: &'a OnSpiral,
    ends: [&'a End; 2],
    /// Rational values next to the ends, outside or at them.
    outer: [Rational; 2],
    /// Inside or at them.
    inner: [Rational; 2],
    budget: &'a Budget,
}

impl Search<'_> {
    /// Looks at a box of the parameter, for at most one value; `None` where it is too small to be cut.
    fn look(&self, part: &BoxPart) -> Result<Option<Seen>, Exhausted> {
        let [from, to] = &part.sides[0];
        let values = Values::between(from, to);
        let halvings = u64::from(part.halvings[0]);
        // In steps: points of the edge are remembered with their bits.
        let more = (halvings * (self.p.degree() as u64 + 2)).next_multiple_of(BITS);
        let (bits, arcs) = (BITS + more, ARCS + halvings);
        let spiral = self.p.spiral(bits);
        let Some(own) = self.budget.enter(|| self.p.over(&values, &spiral))? else {
            return Ok((part.halvings[0] < BOXES).then_some(Seen::Cut));
        };
        if self.budget.enter(|| own[0].count())?.is_some() {
            return Ok(Some(Seen::Decided(None)));
        }
        let open = self.budget.enter(|| own[0].open_arcs(arcs, MOST_OPEN))?;
        if open.is_empty() {
            return Ok(Some(Seen::Decided(None)));
        }
        let angles = hull(&open);
        // An arc at 1 is open where 1 is a root at the end of the interval.
        let at_one = angles[0].is_zero();
        let touches_one = at_one && self.is_known_at_one(from, to);
        if (!at_one || touches_one) && self.budget.enter(|| is_one_to_one(&own, &angles))? {
            // The only zero is the one at 1.
            if touches_one {
                return Ok(Some(Seen::Decided(None)));
            }
            let (low, high) = (from.max(&self.inner[0]).clone(), to.min(&self.inner[1]).clone());
            let counts = [self.p.count_at(&low, self.budget)?, self.p.count_at(&high, self.budget)?];
            if counts[0] == counts[1] {
                return Ok(Some(Seen::Decided(None)));
            }
            let change = Change { p: self.p.clone(), angles, within: [low, high], count_below: counts[0] };
            let place = self.budget.enter(|| change.enclose(PLACE_BITS, None))?;
            let is_short = |q: &Rational| q.numerator().bit_length() + q.denominator().bit_length() <= SHORT_BITS;
            if let Some(q) = simplest_between(place.lower(), place.upper()).filter(is_short) {
                match self.p.count_at(&q, self.budget) {
                    Err(stopped) if stopped.stop.is_precision() => return Ok(Some(Seen::Beside(place))),
                    counted => drop(counted?),
                }
            }
            return Ok(Some(Seen::Decided(Some(Transcendental::within(change, place).into()))));
        }
        Ok((part.halvings[0] < BOXES).then_some(Seen::Cut))
    }

    /// Whether the box holds an end at which 1 is a root.
    fn is_known_at_one(&self, from: &Rational, to: &Rational) -> bool {
        let holds = |k: usize| {
            let (low, high) = ((&self.outer[k]).min(&self.inner[k]), (&self.outer[k]).max(&self.inner[k]));
            from <= low && high <= to
        };
        (0..2).any(|k| holds(k) && self.ends[k].causes.contains(Cause::RootAtOne))
    }
}

/// From the first arc to the last, in parts of pi.
fn hull(open: &[Arc]) -> [Rational; 2] {
    let first = open.first().map_or(Rational::ZERO, |arc| arc.ends()[0].clone());
    let last = open.last().map_or(Rational::ONE, |arc| arc.ends()[1].clone());
    [first, last]
}

/// The only value in a box at which a root is on the edge.
#[derive(Debug)]
struct Change {
    p: OnSpiral,
    /// Where on the edge, in parts of pi.
    angles: [Rational; 2],
    within: [Rational; 2],
    /// The number of roots inside at the lower end.
    count_below: usize,
}

impl Change {
    /// Newton's method in angle and value from the middle of the box; what it gives is not proved.
    fn guess(&self, bits: u64) -> Option<Rational> {
        let working = bits + 64;
        let middle = |[a, b]: &[Rational; 2]| a.midpoint(b);
        let (mut t, mut k) = (middle(&self.angles), middle(&self.within));
        let pi = Ball::from_enclosure(&Enclosure::pi(working), working);
        let short = |x: Rational| Rational::dyadic(&Ball::from_rational(&x, working).middle_units(), working);
        let rounds = 8 + (u64::BITS - bits.leading_zeros());
        for _ in 0..rounds {
            checkpoint(working);
            let jet = self.p.at_point(&t, &k, working)?;
            let (f, u, v) = (jet.value, jet.by_angle, jet.by_parameter);
            let determinant = u.re.mul(&v.im).sub(&u.im.mul(&v.re));
            let angle = f.re.mul(&v.im).sub(&f.im.mul(&v.re)).div(&determinant)?;
            let value = u.re.mul(&f.im).sub(&u.im.mul(&f.re)).div(&determinant)?;
            let number = |b: &Ball| Rational::dyadic(&b.middle_units(), working);
            t = short(t - number(&angle.div(&pi)?));
            k = short(k - number(&value));
            let inside = |x: &Rational, [a, b]: &[Rational; 2]| a <= x && x <= b;
            if !inside(&t, &self.angles) || !inside(&k, &self.within) {
                return None;
            }
        }
        Some(k)
    }

    /// Whether the change is above a value of the box.
    fn is_above(&self, value: &Rational) -> bool {
        // Inside a budget that was entered: what runs out ends there.
        let count = self.p.count_at(value, &Budget::unlimited());
        count.is_ok_and(|n| n == self.count_below)
    }
}

impl Enclosing for Change {
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        let [mut low, mut high] = match known {
            Some(e) => [e.lower().clone(), e.upper().clone()],
            None => self.within.clone(),
        };
        if &high - &low > width
            && let Some(near) = self.guess(bits)
        {
            let half = Rational::dyadic(&Integer::ONE, bits + 1);
            let (below, above) = ((&near - &half).max(low.clone()), (&near + &half).min(high.clone()));
            if below < above && self.is_above(&below) && !self.is_above(&above) {
                return Enclosure::new(below, above);
            }
        }
        while &high - &low > width {
            let middle = low.midpoint(&high);
            if self.is_above(&middle) { low = middle } else { high = middle }
        }
        Enclosure::new(low, high)
    }

    fn origin(&self) -> Origin {
        let details = vec![("count below".to_owned(), self.count_below.to_string())];
        Origin::Function { function: "root on the spiral of a damping".to_owned(), details }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::{ParametricPolynomial, Range, Shape, SymbolicPolynomial, stable_set};
    use jurist_algebra::poly::{MultiPoly, Poly, UniPoly};
    use jurist_algebra::symbols::Symbols;

    /// An integrator, a lag and two samples of delay with a zero: roots at 1 for the gain 0, at the end of the domain. The values are
    /// mpmath's at 50 digits: there a negative root and a pair leave the spiral.
    #[test]
    fn gains_at_which_roots_have_the_damping_of_two_fifths() {
        let budget = Budget::unlimited();
        let polynomial =
            Poly::new([&[0, -10][..], &[0, 11], &[900], &[-1900], &[1000]].map(UniPoly::from_i64).to_vec());
        let p = ParametricPolynomial::from_integral(&polynomial, 4);
        let domain = Range::between(Some(Rational::ZERO), None);
        let set = stable_set(&p, &domain, Shape::UnitDisc, &budget).unwrap();
        let [interval] = set.intervals() else { panic!("{set:?}") };
        let damping = Rational::new(2.into(), 5.into());
        let coefficients = polynomial.map(|c| MultiPoly::from_univariate(c, 0));
        let lead = coefficients.coeff(4);
        let p = SymbolicPolynomial::from_parts(&Symbols::new().into(), coefficients, lead, 4, Vec::new());
        let p = OnSpiral::of(&p, &damping).unwrap();
        let (found, open) = changes(&p, interval, &budget).unwrap();
        assert!(open.is_empty());
        let decimals: Vec<String> = found.iter().map(|x| x.decimal(25)).collect();
        assert_eq!(decimals, ["7.286368919065204252291676", "27.57670552299612977034143"]);
        let count = |k: i64| p.count_at(&Rational::new(k.into(), 10.into()), &budget).unwrap();
        assert_eq!([1, 240, 280].map(count), [4, 3, 1]);
    }

    /// `z^2 - b z + b`: below 0 a real root leaves the spiral where the angle is `pi`, at `b = -e^2/(1 + e)` with `e = exp(-c pi)`. Newton's method may
    /// go beyond, and numbers next to the value are counted.
    #[test]
    fn a_root_leaves_the_spiral_at_its_end() {
        let budget = Budget::unlimited();
        let polynomial = Poly::new([&[0, 1][..], &[0, -1], &[1]].map(UniPoly::from_i64).to_vec());
        let p = ParametricPolynomial::from_integral(&polynomial, 2);
        let set = stable_set(&p, &Range::default(), Shape::UnitDisc, &budget).unwrap();
        let [interval] = set.intervals() else { panic!("{set:?}") };
        let coefficients = polynomial.map(|c| MultiPoly::from_univariate(c, 0));
        let lead = coefficients.coeff(2);
        let p = SymbolicPolynomial::from_parts(&Symbols::new().into(), coefficients, lead, 2, Vec::new());
        let p = OnSpiral::of(&p, &Rational::new(3.into(), 10.into())).unwrap();
        let (found, open) = changes(&p, interval, &budget.within_work(1_000_000_000)).unwrap();
        assert!(open.is_empty());
        let decimals: Vec<String> = found.iter().map(|x| x.decimal(12)).collect();
        assert_eq!(decimals, ["-0.101015879471", "0.463204411814"]);
    }
}
