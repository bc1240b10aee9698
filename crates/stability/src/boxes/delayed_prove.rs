//! The proof that a whole box of a loop with dead time is stable.
//!
//! Where the undelayed highest power of `s` outweighs the delayed ones, and no root comes to the imaginary axis up to the frequency beyond which it
//! outweighs everything, all points of a connected box have as many roots to the right. The box and the axis are cut into parts. In a part
//! real and imaginary part of the function are polynomials in the frequency and the parameters, with a bound of all that is left out of
//! `exp(-i w tau)` ([MakinoBerz2003](jurist_algebra::bibliography#makinoberz2003)); where its argument varies too much, nothing is known of it
//! but its modulus. Their Bernstein coefficients prove cells of a part as those of any other pair do.

use super::delayed::DelayedFunction;
use super::parts::{Known, Local, Term, add_terms, bundle, coordinates, corners, extent, middle, model_degree, pruned};
use super::polynomial::Bundle;
use super::prove::{BoxProof, Closing, Outcome, closed_by_constant, closed_by_vector, keeps_sign, simplest_point};
use super::reason::OpenReason;
use super::tensor::{FrequencyScale, Tensor, common_factor, expand};
use crate::subdivision::{BoxPart, Look, Order, Tally, decided, subdivide};
use jurist_algebra::ball::{Ball, Elementary, MultiTaylorModel, cos_sin};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use std::collections::BTreeMap;

/// Bits after the point of models.
const BITS: u64 = 128;

/// A box is cut into so many parts at most.
const MOST_PARTS: usize = 2500;

/// Taylor models have about so many coefficients.
const MODEL_TERMS: usize = 45;

/// A tensor of a part has at most so many coefficients for each polynomial.
const TENSOR_TERMS: usize = 1 << 13;

/// Terms smaller than the greatest by so many bits are left out; where that leaves too many, by fewer.
const KEPT_BITS: [u64; 9] = [72, 64, 56, 48, 40, 32, 24, 16, 8];

/// Cells in one part.
const CELLS_IN_PART: usize = 300;

/// Nothing is known of `exp(-i w tau)` but its modulus where its argument is farther from that in the middle, in quarters.
const FARTHEST: i64 = 6;

/// A part is not halved more often along one parameter.
const MOST_HALVINGS: u64 = 64;

/// Parts of the parameters alone, cut where the highest power of `s` may not outweigh the others.
const MOST_BOXES: usize = 64;

/// The exponents of two of frequencies beyond which the highest power may outweigh all others.
const BOUNDS: std::ops::Range<i64> = -60..600;

/// What is known of the function in a part; coordinates of what is inside of dead times, and of the frequency, go from -1 to 1.
struct Part {
    pair: Vec<Known>,
    /// For each axis of the part how much halving it helps.
    scores: Vec<Integer>,
    is_vague: bool,
}

/// Real and imaginary part.
type Pair = [MultiTaylorModel; 2];

impl DelayedFunction {
    /// Decides one box with at most so many parts. Points that are not stable are looked for where `refutes` says that stability is to be proved, not
    /// only that no root crosses.
    pub(super) fn proved(
        &self,
        whole: &[[Rational; 2]],
        (reference, scale): (&[Sign], i64),
        (cells, refutes): (usize, bool),
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        for (f, &sign) in self.certain.iter().zip(reference) {
            if let Err(outcome) = keeps_sign(&Bundle::new(&[f], whole.len()), whole, sign, cells, budget)? {
                return Ok(outcome);
            }
        }
        let apart = self.terms.iter().skip(1).map(|(time, _)| time);
        for time in self.times.iter().chain(apart) {
            if let Some(outcome) = self.negative_time(time, whole) {
                return Ok(outcome);
            }
        }
        // A corner is looked at in no time, and is where the limit often is.
        let reference = refutes.then_some(reference);
        if let Some(corner) = corners(whole).find_map(|point| self.refuted(point, reference?)) {
            return Ok(corner);
        }
        match self.bounded(whole, budget)? {
            Ok(parts) => self.parts_proved(parts, whole, (reference, scale), cells.min(MOST_PARTS), budget),
            Err(cell) => {
                let why = OpenReason::HighestPower;
                Ok(Outcome::Open { why, cell })
            }
        }
    }

    /// A point that is not stable.
    fn refuted(&self, point: Vec<Rational>, reference: &[Sign]) -> Option<Outcome> {
        let is_lost = self.seems_lost_at(&point, reference) && self.seen_at(&point) == Some(false);
        is_lost.then_some(Outcome::Refuted(point))
    }

    /// Parts of a box with all frequencies up to which roots may be on the axis; else a part in which that is not known.
    fn bounded(
        &self,
        whole: &[[Rational; 2]],
        budget: &Budget,
    ) -> Result<Result<Vec<BoxPart>, Vec<[Rational; 2]>>, Exhausted> {
        let look = |BoxPart { sides, .. }: &mut BoxPart, tally: Tally| {
            if let Some(bound) = self.bound(sides) {
                let part: Vec<[Rational; 2]> = sides.iter().cloned().chain([[Rational::ZERO, bound]]).collect();
                return Ok(Look::Decided(BoxPart::whole(part)));
            }
            let widest = (0..sides.len()).max_by_key(|&i| (extent(&sides[i]), std::cmp::Reverse(i)));
            let widest = widest.filter(|_| tally.decided + tally.waiting < MOST_BOXES);
            Ok(widest.map_or_else(|| Look::Open(sides.clone()), Look::Cut))
        };
        let steps = subdivide([BoxPart::whole(whole)], Order::Depth, budget, look)?;
        Ok(steps.map(|steps| decided(steps).collect()))
    }

    fn parts_proved(
        &self,
        parts: Vec<BoxPart>,
        whole: &[[Rational; 2]],
        (reference, scale): (Option<&[Sign]>, i64),
        most: usize,
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        let narrowest = Rational::dyadic(&Integer::ONE, MOST_HALVINGS);
        let look = |BoxPart { sides, .. }: &mut BoxPart, tally: Tally| {
            let Some(part) = self.part(sides) else {
                let (why, cell) = (OpenReason::Pole, parameters(sides.clone()));
                return Ok(Look::Open(Outcome::Open { why, cell }));
            };
            let last = match self.part_proved(&part, sides, budget)? {
                Ok(count) => return Ok(Look::Decided(count)),
                Err(cell) => parameters(cell),
            };
            let mut points = [simplest_point(&last), middle(&last)].into_iter().chain(corners(&last));
            let lost = if part.is_vague { None } else { points.find_map(|point| self.refuted(point, reference?)) };
            drop(points);
            if let Some(outcome) = lost {
                return Ok(Look::Open(outcome));
            }
            let why = (tally.cells() + 1 > most).then_some(OpenReason::Cells);
            let width = |[low, high]: &[Rational; 2]| high - low;
            let least = |i: usize| whole.get(i).map_or(Rational::ZERO, |side| width(side) * narrowest.clone());
            let axes = (0..sides.len()).filter(|&i| width(&sides[i]) > least(i));
            let axis = axes.max_by(|&i, &j| (&part.scores[i], j).cmp(&(&part.scores[j], i)));
            let axis = axis.filter(|&i| why.is_none() && !part.scores[i].is_zero());
            let open = || Outcome::Open { why: why.unwrap_or(OpenReason::Small), cell: last };
            Ok(axis.map_or_else(|| Look::Open(open()), Look::Cut))
        };
        Ok(match subdivide(parts, Order::Depth, budget, look)? {
            Ok(steps) => Outcome::Stable(BoxProof::of_cells(scale, decided(steps).sum())),
            Err(outcome) => outcome,
        })
    }

    /// What stands against a dead time that is nowhere negative in the box.
    fn negative_time(&self, time: &RationalFunction, sides: &[[Rational; 2]]) -> Option<Outcome> {
        let below = time.denominator().eval(&middle(sides)).sign();
        let [least, most] = range_of(time.numerator(), sides);
        if if below.is_gt() { !least.is_negative() } else { !most.sign().is_gt() } {
            return None;
        }
        let is_negative = |point: &Vec<Rational>| time.eval(point).is_some_and(|x| x.is_negative());
        let refuted = corners(sides).find(|point| is_negative(point) && self.seen_at(point) == Some(false));
        let open = || Outcome::Open { why: OpenReason::NegativeTime, cell: sides.to_vec() };
        Some(refuted.map_or_else(open, Outcome::Refuted))
    }

    /// A frequency beyond which the highest undelayed power of `s` outweighs all other terms in the whole box.
    fn bound(&self, sides: &[[Rational; 2]]) -> Option<Rational> {
        let greatest = |c: &MultiPoly| {
            let [least, most] = range_of(c, sides);
            least.abs().max(most.abs())
        };
        let [least, most] = range_of(&self.terms[0].1[self.order], sides);
        let top = match (least.sign(), most.sign()) {
            (Sign::Greater, _) => least,
            (_, Sign::Less) => -most,
            _ => return None,
        };
        let mut sums = vec![Rational::ZERO; self.order + 1];
        for (k, (_, part)) in self.terms.iter().enumerate() {
            for (j, c) in part.iter().enumerate().filter(|(j, _)| (k, *j) != (0, self.order)) {
                sums[j] += greatest(c);
            }
        }
        if sums[self.order] >= top {
            return None;
        }
        let outweighs = |r: &Rational| {
            let power = r.pow(self.order as i64).expect("a power of two is not zero");
            sums.iter().rev().fold(Rational::ZERO, |sum, c| sum * r + c) < &top * &power
        };
        BOUNDS.map(|e| Rational::from(2).pow(e).expect("two is not zero")).find(outweighs)
    }

    /// What is known in a part; `None` where a dead time may not be defined.
    fn part(&self, sides: &[[Rational; 2]]) -> Option<Part> {
        checkpoint(2000);
        let (m, n) = (sides.len() - 1, self.order);
        let axes: Vec<usize> = self.inside.iter().copied().chain([m]).collect();
        let degree = model_degree(axes.len(), 3..=8, MODEL_TERMS).max(n);
        let models = coordinates(sides, &axes, BITS, degree);
        let omega = models.last().expect("the frequency");
        let one = omega.integer(&Integer::ONE);
        let mut values = vec![omega.integer(&Integer::ZERO); m];
        for (&i, model) in self.inside.iter().zip(&models) {
            values[i] = model.clone();
        }
        let mut powers = vec![one.clone()];
        for j in 0..n {
            powers.push(powers[j].mul(omega));
        }
        let mut scores = vec![Integer::ZERO; m + 1];
        let mut is_vague = false;
        let mut sums: BTreeMap<&Vec<u32>, Pair> = BTreeMap::new();
        for ((time, _), split) in self.terms.iter().zip(&self.splits) {
            let turn = if time.is_zero() {
                [one.clone(), omega.integer(&Integer::ZERO)]
            } else {
                let phase = omega.mul(&quotient(time, &values, &one)?);
                let known = turned(&phase);
                if known.is_none() {
                    is_vague = true;
                    for (exponents, c) in phase.terms().skip(1) {
                        axes.iter().zip(exponents).filter(|(_, e)| **e > 0).for_each(|(&i, _)| scores[i] += c.abs());
                    }
                }
                known.unwrap_or_else(|| {
                    let all = Ball::from_units(-(&Integer::ONE << BITS), &Integer::ONE << BITS, BITS);
                    [one.constant(&all), one.constant(&all)]
                })
            };
            for (j, parts) in split.iter().enumerate().filter(|(_, parts)| !parts.is_empty()) {
                let [re, im] = turn.each_ref().map(|x| if j == 0 { x.clone() } else { x.mul(&powers[j]) });
                // (i w)^j.
                let (re, im) = if j % 2 == 0 { (re, im) } else { (im.scaled(&Integer::from(-1)), re) };
                let sign = Integer::from(if j % 4 < 2 { 1 } else { -1 });
                for (beside, inner) in parts {
                    let own = match inner.as_constant() {
                        Some(c) => [&re, &im].map(|x| x.scaled(&(&c * &sign))),
                        None => {
                            let c = value(inner, &values, &one).scaled(&sign);
                            [&re, &im].map(|x| x.mul(&c))
                        }
                    };
                    match sums.get_mut(beside) {
                        Some(sum) => *sum = [sum[0].add(&own[0]), sum[1].add(&own[1])],
                        None => drop(sums.insert(beside, own)),
                    }
                }
            }
        }
        Some(self.part_of(sides, &axes, sums, (scores, is_vague)))
    }

    /// The part from the sums for each product of parameters outside.
    fn part_of(
        &self,
        sides: &[[Rational; 2]],
        axes: &[usize],
        sums: BTreeMap<&Vec<u32>, Pair>,
        (mut scores, is_vague): (Vec<Integer>, bool),
    ) -> Part {
        let mut sized: [Vec<Term>; 2] = [Vec::new(), Vec::new()];
        let mut slacks = vec![Integer::ZERO; 2];
        for (beside, models) in &sums {
            for (k, model) in models.iter().enumerate() {
                slacks[k] += add_terms(&mut sized[k], (model, beside), axes, sides);
            }
        }
        for Term { exponents, size, .. } in sized.iter().flatten().filter(|_| !is_vague) {
            let total: u32 = axes.iter().map(|&i| exponents[i]).sum();
            if total > 1 {
                axes.iter().for_each(|&i| scores[i] += size * &Integer::from(u64::from(exponents[i])));
            }
        }
        let pair = pruned(sized.into(), slacks, axes, 1, (TENSOR_TERMS, &KEPT_BITS));
        Part { pair, scores, is_vague }
    }

    /// The number of cells that prove a part; else the cell in which that is not seen.
    fn part_proved(
        &self,
        part: &Part,
        sides: &[[Rational; 2]],
        budget: &Budget,
    ) -> Result<Result<usize, Vec<[Rational; 2]>>, Exhausted> {
        let m = sides.len() - 1;
        let axes: Vec<usize> = self.inside.iter().copied().chain([m]).collect();
        let local = Local::new(sides, &axes);
        let slack: Vec<Integer> = part.pair.iter().map(|known| known.slack.clone()).collect();
        let pair = bundle(&part.pair, sides.len());
        let (tensor, _) = Tensor::of_pair_within(&pair, &slack, &local.sides, FrequencyScale(0));
        let closing: (Closing, usize) =
            if part.is_vague { (&closed_by_constant, 1) } else { (&closed_by_vector, CELLS_IN_PART) };
        local.closed(tensor, closing, budget)
    }
}

/// The sides of the parameters, without the frequencies.
fn parameters(mut sides: Vec<[Rational; 2]>) -> Vec<[Rational; 2]> {
    sides.pop();
    sides
}

/// The range of the Bernstein coefficients, in which that of the values is.
pub(super) fn range_of(p: &MultiPoly, sides: &[[Rational; 2]]) -> [Rational; 2] {
    let bundle = Bundle::new(&[p], sides.len());
    let all = expand(&bundle, sides);
    let over = Rational::from(&common_factor(&bundle, sides));
    [all.iter().min(), all.iter().max()].map(|end| &Rational::from(end.expect("there is one")) / &over)
}

/// A polynomial at models of its variables.
fn value(p: &MultiPoly, at: &[MultiTaylorModel], one: &MultiTaylorModel) -> MultiTaylorModel {
    p.terms().iter().fold(one.integer(&Integer::ZERO), |sum, (monomial, c)| {
        let factors = monomial.exponents().iter().enumerate().flat_map(|(i, &e)| std::iter::repeat_n(i, e as usize));
        sum.add(&factors.fold(one.integer(c), |product, i| at[i].mul(&product)))
    })
}

fn quotient(f: &RationalFunction, at: &[MultiTaylorModel], one: &MultiTaylorModel) -> Option<MultiTaylorModel> {
    let above = value(f.numerator(), at, one);
    match f.denominator().as_constant() {
        Some(c) if c.is_one() => Some(above),
        _ => above.div(&value(f.denominator(), at, one)),
    }
}

/// `exp(-i x)` of a phase that varies little; `None` where it varies much.
///
/// With `x = c + g` it is `exp(-i c)` times the first terms of the series of `exp(-i g)`, which differ from it by at most
/// `|g|^(n + 1)/(n + 1)!` for real `g`.
fn turned(phase: &MultiTaylorModel) -> Option<Pair> {
    let first = phase.terms().next().expect("the constant term").1;
    let first = Ball::from_units(first.clone(), first.clone(), BITS);
    let g = phase.sub(&phase.constant(&first));
    let farthest = g.range().magnitude_units();
    if &farthest * &Integer::from(4) > &Integer::from(FARTHEST) << BITS {
        return None;
    }
    let (one, degree) = (phase.integer(&Integer::ONE), phase.terms().map(|(e, _)| e.iter().sum::<u32>()).max()?);
    let over = |k: u32| {
        let share = Ball::from_integer(&Integer::ONE, BITS).divided_by(u64::from(k));
        phase.constant(&share)
    };
    let (mut re, mut im) = (one.clone(), phase.integer(&Integer::ZERO));
    for k in (1..=degree).rev() {
        // 1 - i g (re + i im)/k.
        let own = g.mul(&over(k));
        let turned = im.mul(&own);
        im = re.mul(&own).scaled(&Integer::from(-1));
        re = one.add(&turned);
    }
    let mut rest = Integer::ONE << BITS;
    for k in 1..=degree + 1 {
        rest = -(-((rest * &farthest) >> BITS) - Integer::ONE).div_mod_floor(&Integer::from(u64::from(k))).0;
    }
    let off = phase.constant(&Ball::from_units(-&rest, rest, BITS));
    let (re, im) = (re.add(&off), im.add(&off));
    let (cos, sin) = cos_sin(&first);
    let [cos, sin] = [cos, sin].map(|x| phase.constant(&x));
    // (re + i im)(cos - i sin).
    Some([re.mul(&cos).add(&im.mul(&sin)), im.mul(&cos).sub(&re.mul(&sin))])
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;

    /// Of `exp(-i x)` over an interval: the enclosure holds the digits of cosine and sine, and is narrow.
    #[test]
    fn turns_are_enclosed_over_an_interval() {
        let number = |x: &str| parse_number(x).unwrap();
        let ball = |x: &str| Ball::from_rational(&number(x), BITS);
        let model = MultiTaylorModel::linear(&[(ball("10"), ball("0.25"))], 8).remove(0);
        let [re, im] = turned(&model).expect("it varies little");
        // At x = 10.25: all powers of the coordinate are one.
        let end = |model: &MultiTaylorModel| model.terms().fold(Integer::ZERO, |sum, (_, c)| sum + c);
        let holds = |model: &MultiTaylorModel, digits: &str| {
            let off = (Rational::dyadic(&end(model), BITS) - number(digits)).abs();
            off <= Rational::dyadic(model.rest_units(), BITS) + number("1e-15")
        };
        assert!(holds(&re, "-0.678393850473845") && holds(&im, "0.734698430404795"), "{}", end(&re));
        assert!(Rational::dyadic(re.rest_units(), BITS) < number("1e-10"));
        assert!(turned(&MultiTaylorModel::linear(&[(ball("10"), ball("2"))], 8).remove(0)).is_none());
    }
}
