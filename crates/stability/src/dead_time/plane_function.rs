//! A function of the frequency and two parameters with its derivatives, and what is decided of boxes.

use super::dyadic::Dyadic;
use super::headings::Right;
use super::plane::DeadTime;
use super::plane_walk::{Known, Walk};
use crate::plane::boxes::{BoxVerdict, Place, Seen};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};

/// A function over the shares `u` (0), `v` (1) of a window, both in `[0, 1]`.
#[derive(Debug)]
pub struct Shares {
    /// The coefficients of the powers of `s` for each dead time.
    pub parts: Vec<Vec<MultiPoly>>,
    /// By how much the coefficient of each power of `s` is off at most, in the first part; none are where it is empty.
    pub slack: Vec<Integer>,
    /// The axis to cut where that is too much.
    pub slack_axis: usize,
    /// The loop is undefined where one of these vanishes, each known up to a bound.
    pub poles: Vec<(MultiPoly, Integer)>,
    /// The dead time of each part; none for the first.
    pub delays: Vec<DeadTime>,
    /// The loop has no meaning where one of these is negative.
    pub times: Vec<DeadTime>,
}

/// The function with its derivatives, also over the frequency (2); those of order `n` are multiplied by `unit^n`.
#[derive(Debug)]
pub struct PlaneFunction {
    pub(super) shares: Shares,
    /// The sum of the moduli of all terms of each part on the axis.
    pub(super) moduli: Vec<MultiPoly>,
    pub(super) slack: UniPoly,
    pub(super) slack_slope: UniPoly,
    /// `f`, then its derivatives by frequency, `u` and `v`: both parts of the factor of the turn of each part.
    pub(super) first: [Vec<[MultiPoly; 2]>; 4],
    /// The second derivatives `ww`, `wu`, `wv`, `uu`, `uv`, `vv`: the sums of the moduli of all terms.
    pub(super) second: [MultiPoly; 6],
    pub(super) unit: Integer,
    pub(super) degrees: [u32; 2],
    pub(super) order: usize,
    pub(super) shortest: [i64; 2],
    pub(super) most_steps: usize,
}

/// A box is given up where steps would be so many halvings shorter than the frequency, or than the bound of all frequencies
/// at zero.
const SHORTEST: [i64; 2] = [24, 256];
/// The same of one point, which no cut brings away from the limit.
const SHORTEST_AT_A_POINT: [i64; 2] = [72, 256];
const MOST_STEPS_AT_A_POINT: usize = 1 << 14;
const OMEGA: usize = 2;

impl PlaneFunction {
    /// Cost: a product for each dead time and each term of the derivatives.
    pub fn new(shares: Shares) -> PlaneFunction {
        let Shares { parts, delays, .. } = &shares;
        // What is known of a coefficient may be its bound alone.
        let is_used = |j: usize, c: &MultiPoly| !c.is_zero() || shares.slack.get(j).is_some_and(|x| !x.is_zero());
        let degree = |part: &Vec<MultiPoly>| part.iter().enumerate().rposition(|(j, c)| is_used(j, c));
        let order = parts.iter().filter_map(degree).max().unwrap_or(0);
        let numbers = delays.iter().flat_map(|time| [&time.offset, &time.slopes[0], &time.slopes[1]]);
        let unit = numbers.fold(Integer::ONE, |l, x| l.lcm(&x.denominator()));
        let whole = |x: &Rational| (x * &Rational::from(&unit)).numerator();
        let omega = MultiPoly::variable(OMEGA);
        // The turn exp(-i w tau) has the derivatives -i times these.
        let rates: Vec<[MultiPoly; 3]> = delays
            .iter()
            .map(|DeadTime { offset, slopes: [a, b] }| {
                let delay = &MultiPoly::constant(whole(offset))
                    + &(&MultiPoly::variable(0).scaled_by(&whole(a)) + &MultiPoly::variable(1).scaled_by(&whole(b)));
                [delay, omega.scaled_by(&whole(a)), omega.scaled_by(&whole(b))]
            })
            .collect();
        let variables = [OMEGA, 0, 1];
        let derived = |set: &[[MultiPoly; 2]], which: usize| -> Vec<[MultiPoly; 2]> {
            let one = |([re, im], rates): (&[MultiPoly; 2], &[MultiPoly; 3])| {
                let by = |p: &MultiPoly| p.derivative(variables[which]).scaled_by(&unit);
                [&by(re) + &(&rates[which] * im), &by(im) - &(&rates[which] * re)]
            };
            set.iter().zip(&rates).map(one).collect()
        };
        let zeroth: Vec<[MultiPoly; 2]> = parts.iter().map(|part| on_axis(part)).collect();
        let moduli = zeroth.iter().map(|[re, im]| &absolute(re) + &absolute(im)).collect();
        let [w, u, v] = [0, 1, 2].map(|which| derived(&zeroth, which));
        let second = [(&w, 0), (&w, 1), (&w, 2), (&u, 1), (&u, 2), (&v, 2)].map(|(set, which)| {
            let terms = derived(set, which).into_iter().flatten();
            terms.fold(MultiPoly::zero(), |sum, p| &sum + &absolute(&p))
        });
        let first = [zeroth, w, u, v];
        let degrees = [0, 1].map(|axis| {
            let own = first.iter().flatten().flatten().map(|p| p.degree_in(axis)).max().unwrap_or(0);
            second.iter().map(|p| p.degree_in(axis)).max().unwrap_or(0).max(own)
        });
        let slack = UniPoly::new(shares.slack.clone());
        let (slack_slope, shortest, most_steps) = (slack.derivative(), SHORTEST, usize::MAX);
        PlaneFunction { shares, moduli, slack, slack_slope, first, second, unit, degrees, order, shortest, most_steps }
    }

    /// The same of a function that is the same everywhere.
    pub fn of_point(shares: Shares) -> PlaneFunction {
        let (shortest, most_steps) = (SHORTEST_AT_A_POINT, MOST_STEPS_AT_A_POINT);
        PlaneFunction { shortest, most_steps, ..PlaneFunction::new(shares) }
    }

    /// Walks along the axis where it is not known what the function does, or tells where to cut.
    ///
    /// Where the number of roots to the right is positive for all parameters, no point of the box is stable, however many
    /// curves of further roots pass through it, and though the loop may be undefined at some points.
    pub fn look(&self, place: &Place, known: Option<&Known>) -> (Seen, Option<Known>) {
        let known = match known {
            Some(known) => self.looked(place, known),
            None => self.look_first(place),
        };
        match known {
            Ok((seen, known)) => (seen, Some(known)),
            Err(seen) => (seen, None),
        }
    }

    fn look_first(&self, place: &Place) -> Result<(Seen, Known), Seen> {
        let wider = place.wider();
        let ranges = |list: &[DeadTime]| -> Vec<[Rational; 2]> { list.iter().map(|time| range(time, place)).collect() };
        let own = ranges(&self.shares.times);
        if self.shares.parts.is_empty() || own.iter().any(|[least, most]| least.is_negative() && !most.sign().is_gt()) {
            // No loop has a negative dead time.
            return Err(Seen::Decided(BoxVerdict::Unstable { outside: None }));
        }
        if own.iter().chain(&ranges(&self.shares.delays)).any(|[least, _]| least.is_negative()) {
            return Err(Seen::Cut(wider));
        }
        let Some((bound, is_negative)) = self.bound(place) else {
            return Err(match self.has_chain_on_the_right(place) {
                true => Seen::Decided(BoxVerdict::Unstable { outside: None }),
                false => Seen::Cut(self.axis_of_top().unwrap_or(wider)),
            });
        };
        let mut walk = Walk::new(self, place);
        if walk.whole(bound).is_none() {
            return Err(Seen::Cut(walk.wider()));
        }
        let is_defined = self.is_defined(place);
        Ok(self.seen(walk, place, Known { bound, is_negative, is_defined, pieces: Vec::new() }))
    }

    /// The same of a part of a box of which something is known.
    fn looked(&self, place: &Place, known: &Known) -> Result<(Seen, Known), Seen> {
        let mut walk = Walk::new(self, place);
        if walk.again(known).is_none() {
            return Err(Seen::Cut(walk.wider()));
        }
        let is_defined = known.is_defined || self.is_defined(place);
        Ok(self.seen(walk, place, Known { is_defined, pieces: Vec::new(), ..*known }))
    }

    fn seen(&self, walk: Walk, place: &Place, known: Known) -> (Seen, Known) {
        let right = walk.right(&known);
        let axis = walk.wider();
        let seen = match right {
            Some(Right { least, most }) if least > 0 => {
                let outside = (least == most && known.is_defined).then_some(least as usize);
                Seen::Decided(BoxVerdict::Unstable { outside })
            }
            Some(Right { least: 0, most: 0 }) if known.is_defined => Seen::Decided(BoxVerdict::Stable),
            Some(Right { least: 0, most: 0 }) => Seen::Cut(place.wider()),
            _ => Seen::Cut(axis),
        };
        (seen, Known { pieces: walk.into_pieces(), ..known })
    }

    /// Whether one delayed highest power of `s`, the only one, outweighs that without delay, which is not zero: infinitely many roots are near the
    /// line `Re s = log |P_k/P_0|/tau` on the right for all parameters of the box
    /// ([BellmanCooke1963](jurist_algebra::bibliography#bellmancooke1963), chapter 12).
    fn has_chain_on_the_right(&self, place: &Place) -> bool {
        let mut delayed = self.shares.parts.iter().zip(&self.shares.delays).skip(1);
        let mut tops = delayed.by_ref().filter_map(|(part, time)| Some((part.get(self.order)?, time)));
        let (Some((top, time)), None, Some(own)) = (
            tops.find(|(top, _)| !top.is_zero()),
            tops.find(|(top, _)| !top.is_zero()),
            self.shares.parts[0].get(self.order),
        ) else {
            return false;
        };
        let ((middle, spread), (own_middle, own_spread)) = (self.spread(top, place), self.spread(own, place));
        let is_delayed = range(time, place)[0].sign().is_gt();
        let is_there = own_middle.abs() > own_spread;
        is_delayed && is_there && middle.abs() - spread > own_middle.abs() + own_spread
    }

    /// The axis on which the coefficients of the highest power of `s` depend, where it is one.
    fn axis_of_top(&self) -> Option<usize> {
        let tops = || self.shares.parts.iter().filter_map(|part| part.get(self.order));
        let depends = [0, 1].map(|axis| tops().any(|top| top.degree_in(axis) > 0));
        (depends[0] != depends[1]).then_some(usize::from(depends[1]))
    }

    fn is_defined(&self, place: &Place) -> bool {
        self.shares.poles.iter().all(|(pole, slack)| {
            let (middle, spread) = self.spread(pole, place);
            middle.abs() > spread + Rational::from(slack)
        })
    }

    /// The value in the middle of a box, and a bound of how far others in the box are from it: a monomial of numbers that
    /// are not negative is convex.
    fn spread(&self, p: &MultiPoly, place: &Place) -> (Rational, Rational) {
        let (middle, upper) = ([0, 1].map(|i| middle(place, i).rational()), [0, 1].map(|i| upper(place, i).rational()));
        let moduli = absolute(p);
        (p.eval(&middle), moduli.eval(&upper) - moduli.eval(&middle))
    }

    /// A power of two beyond which the highest power of `s` without delay outweighs all that may point against it on the axis, in
    /// the whole box, and whether its coefficient is negative.
    ///
    /// Terms of its own part two powers apart are in line with it, those one power apart across. Over its power of the frequency
    /// what is compared rises on its side, and falls on the other: one look at a frequency is for all beyond.
    pub(super) fn bound(&self, place: &Place) -> Option<(u64, bool)> {
        let sizes: Vec<Vec<(Rational, Rational)>> =
            self.shares.parts.iter().map(|part| part.iter().map(|c| self.spread(c, place)).collect()).collect();
        let n = self.order;
        let (top, spread) = sizes[0].get(n)?;
        let slack = |j: usize| Rational::from(&self.slack.coeff(j));
        let least = top.abs() - spread - slack(n);
        let most =
            |k: usize, j: usize| sizes[k].get(j).map_or(Rational::ZERO, |(middle, spread)| middle.abs() + spread);
        let delayed_tops = (1..sizes.len()).fold(Rational::ZERO, |sum, k| sum + most(k, n));
        if delayed_tops >= least {
            return None;
        }
        let outweighs = |e: u64| {
            let power = |j: usize| Rational::from(&(&Integer::ONE << (e * j as u64)));
            let in_line = (0..n).filter(|j| j % 2 == n % 2);
            let own = in_line.fold(&least * &power(n), |left, j| left - (most(0, j) + slack(j)) * power(j));
            let modulus = |k: usize| {
                let part = |parity: usize| {
                    let terms = (0..=n).filter(|j| j % 2 == parity);
                    terms.fold(Rational::ZERO, |sum, j| sum + most(k, j) * power(j))
                };
                let (long, short) = (part(0).max(part(1)), part(0).min(part(1)));
                if long.is_zero() { long } else { &long + &short * &short / (&long + &long) }
            };
            (1..sizes.len()).fold(Rational::ZERO, |sum, k| sum + modulus(k)) < own
        };
        (0..).find(|e| outweighs(*e)).map(|e| (e, top.is_negative()))
    }

    /// A polynomial in the frequency alone, times `2^shift`, at shares of the window.
    pub(super) fn collapsed(&self, p: &MultiPoly, at: &[Dyadic; 2]) -> UniPoly {
        let mut coefficients = vec![Integer::ZERO; p.degree_in(OMEGA) as usize + 1];
        for (monomial, c) in p.terms() {
            let mut term = c.clone();
            for (axis, share) in at.iter().enumerate() {
                let e = monomial.exponent(axis);
                term = (term * share.m.pow(u64::from(e))) << (share.e * u64::from(self.degrees[axis] - e));
            }
            coefficients[monomial.exponent(OMEGA) as usize] += term;
        }
        UniPoly::new(coefficients)
    }

    pub(super) fn shift(&self, at: &[Dyadic; 2]) -> u64 {
        (0..2).map(|axis| at[axis].e * u64::from(self.degrees[axis])).sum()
    }
}

/// The least and the greatest value of a dead time in a box.
fn range(time: &DeadTime, place: &Place) -> [Rational; 2] {
    let mut ends = [time.offset.clone(), time.offset.clone()];
    for axis in 0..2 {
        let (upper, slope) = (upper(place, axis).rational(), &time.slopes[axis]);
        let lower = &upper - &Rational::dyadic(&Integer::ONE, u64::from(place.halvings[axis]));
        let (a, b) = (lower * slope, upper * slope);
        let (least, most) = if a <= b { (a, b) } else { (b, a) };
        ends[0] += least;
        ends[1] += most;
    }
    ends
}

/// The middle of a box on an axis, as a share of the window.
pub(super) fn middle(place: &Place, axis: usize) -> Dyadic {
    Dyadic { m: Integer::from(2 * place.at[axis] + 1), e: u64::from(place.halvings[axis]) + 1 }
}

/// The upper end of a box on an axis, as a share of the window.
pub(super) fn upper(place: &Place, axis: usize) -> Dyadic {
    Dyadic { m: Integer::from(place.at[axis] + 1), e: u64::from(place.halvings[axis]) }
}

fn absolute(p: &MultiPoly) -> MultiPoly {
    let terms = p.terms().iter().map(|(m, c)| (m.exponents().to_vec(), c.abs()));
    MultiPoly::from_terms(terms)
}

/// `P(i omega)` as real and imaginary part.
fn on_axis(coefficients: &[MultiPoly]) -> [MultiPoly; 2] {
    let (mut re, mut im) = (MultiPoly::zero(), MultiPoly::zero());
    let mut power = MultiPoly::one();
    for (j, c) in coefficients.iter().enumerate() {
        let term = c * &power;
        match j % 4 {
            0 => re = &re + &term,
            1 => im = &im + &term,
            2 => re = &re - &term,
            _ => im = &im - &term,
        }
        power = &power * &MultiPoly::variable(OMEGA);
    }
    [re, im]
}
