//! The largest factor as an algebraic number: that nothing in the box is worse than its corner.
//!
//! Let `r*` be the first zero on the line to a corner, `r1 < r*` proved, `r2 > r*` (below `2 r1`) with no other critical zero of
//! the line between, and let all zeros `(v, p)` of the pair with `p` in the box of `r2` lie in a cell `C` at the corner. Of each
//! zero let `rho` be the least factor whose box holds `p`, and `tau_i >= 0` the distance of `p_i` from that box's corner. Let the
//! determinants `det(P_v, P_(p_i))`, times the corner's signs, have one sign on `C` (zero is allowed), and one of them, of a
//! parameter whose corner moves with the factor, a strict one. Then the Jacobian by `(v, rho)`, their weighted sum, has no zero
//! on `C`, and by the implicit function theorem zeros go along as a `tau_i` shrinks, with `rho` not growing; they stay in `C`. So a
//! zero of least `rho` can be taken on the line, and its factor is `r*`. Of a real root the same follows from the signs of the
//! derivatives alone: towards the corner the polynomial falls.

use super::factor::{LargestFactor, ToleranceProblem};
use super::polynomial::Bundle;
use super::prove::{Cell, Outcome, keeps_sign};
use super::separate::separating_vector;
use super::sides::at_factor;
use super::tensor::{FrequencyScale, Tensor, expand};
use super::tree::{Axis, Node, Tree};
use crate::stability::{Cause, End};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::RealAlgebraic;
use std::collections::BTreeMap;

/// Halvings of the parameters' sides at the corner, tried one after the other.
const DEPTHS: [u32; 7] = [2, 4, 6, 9, 13, 18, 24];

/// How much beyond the end the box is taken: this share of it.
const BEYOND: u64 = 52;

/// Cells of one attempt.
const CELLS: usize = 4000;

/// Why the end of the worst line is the largest factor.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ExactProof {
    /// The box of this factor was proved to be stable.
    pub from: Rational,
    /// Up to the box of this factor there is nothing worse than the corner.
    pub to: Rational,
    /// For each parameter the side of the corner.
    pub corner: Vec<bool>,
    /// All zeros of the pair, or of the polynomial of a real root, are in this cell of the box, which [`Tree`] marks `c`.
    pub cell: CriticalCell,
    /// Cells of frequency and parameters (of parameters alone for a real root) without a zero, but for those in the critical one.
    pub tree: Tree,
}

/// A cell at a corner of the box.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CriticalCell {
    /// Of each parameter's side the share `2^-halvings` at the corner.
    pub halvings: Vec<u32>,
    /// The part of the frequency axis, as `t` in `v = 4^scale t / (1 - t)`.
    pub frequency: [Rational; 2],
}

impl ToleranceProblem<'_> {
    /// Whether the end of the worst line is the largest factor; `None` where that is not proved.
    ///
    /// `zeros` are the critical factors of the line. Cost: that of a proof of one box for each depth that is tried, and
    /// Bernstein coefficients of the derivatives.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn exact(
        &self,
        factor: &LargestFactor,
        end: &End,
        zeros: &[RealAlgebraic],
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        budget.step("proving the exact factor");
        let from = factor.lower.clone();
        let (Some(direction), Some(shares)) = (&factor.direction, &factor.shares) else { return Ok(None) };
        let Some(corner) = self.corner(direction) else { return Ok(None) };
        let narrow = end.value.refined_to_digits(30);
        let top = narrow.enclosure().1;
        let to = &top + &(&top * &Rational::dyadic(&Integer::ONE, BEYOND));
        let to = super::line::rounded(&to, BEYOND + 8);
        if to <= top || from >= narrow.enclosure().0 || &from + &from <= to || factor.proof.is_none() {
            return Ok(None);
        }
        let between = |z: &&RealAlgebraic| z.compare_rational(&from).is_gt() && z.compare_rational(&to).is_le();
        if zeros.iter().filter(between).count() != 1 {
            return Ok(None);
        }
        let causes: Vec<Cause> = end.causes.iter().collect();
        let [cause] = causes.as_slice() else { return Ok(None) };
        let sides = at_factor(&self.sides, &to);
        let known = Known { from, to, corner };
        budget.enter(|| match cause {
            Cause::ComplexPair => self.exact_pair(known, &sides, shares, factor, budget),
            _ => self.exact_real(known, &sides, *cause, budget),
        })?
    }

    /// The corner that a direction leads to; `None` where a parameter is inside.
    fn corner(&self, direction: &[Rational]) -> Option<Vec<bool>> {
        let pair = self.p.pair();
        direction
            .iter()
            .zip(&self.sides)
            .zip(&pair.degrees)
            .map(|((c, side), &degree)| {
                let [low, high] = side.widths();
                match c.abs() == Rational::ONE {
                    true => Some(!c.is_negative()),
                    // The corner on a side without width is the nominal value.
                    false if low.is_zero() => Some(false),
                    false if high.is_zero() => Some(true),
                    // Without influence any side will do.
                    false => (degree == 0).then_some(true),
                }
            })
            .collect()
    }

    fn exact_pair(
        &self,
        known: Known,
        sides: &[[Rational; 2]],
        shares: &[Rational],
        factor: &LargestFactor,
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        for ((_, f), &sign) in self.p.certain.iter().zip(&self.reference) {
            if keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, CELLS, budget)?.is_err() {
                return Ok(None);
            }
        }
        let Some(crossing) = &factor.crossing else { return Ok(None) };
        let Some(v) = self.search().line(&crossing.direction).frequency(&crossing.lo) else { return Ok(None) };
        let v0 = Rational::from(4).pow(self.scale).expect("four is not zero");
        let Some(t) = v.checked_div(&(&v + &v0)) else { return Ok(None) };
        for depth in DEPTHS {
            let halvings: Vec<u32> = shares
                .iter()
                .map(|share| if *share < Rational::dyadic(&Integer::ONE, u64::from(depth)) { 1 } else { depth })
                .collect();
            let unit = Rational::dyadic(&Integer::ONE, u64::from(depth) + 2);
            let at = t.checked_div(&unit).expect("a unit is not zero").floor();
            let edge =
                |k: i64| (&unit * &Rational::from(&at + &Integer::from(k))).max(Rational::ZERO).min(Rational::ONE);
            let cell = CriticalCell { halvings, frequency: [edge(-2), edge(3)] };
            let [low, high] = &cell.frequency;
            if low.is_zero() || high.is_one() || !self.turns_one_way(&known, sides, &cell, &v0) {
                continue;
            }
            if let Some(tree) = self.cover(sides, &known.corner, &cell, budget)? {
                let Known { from, to, corner } = known;
                return Ok(Some(ExactProof { from, to, corner, cell, tree }));
            }
        }
        Ok(None)
    }

    /// Whether on the cell all determinants of the pair's derivatives by frequency and by a parameter, times the corner's
    /// signs, have the same strict sign.
    fn turns_one_way(&self, known: &Known, sides: &[[Rational; 2]], cell: &CriticalCell, v0: &Rational) -> bool {
        let mut inner: Vec<[Rational; 2]> =
            (0..sides.len()).map(|i| corner_part(&sides[i], known.corner[i], cell.halvings[i])).collect();
        let value = |t: &Rational| (v0 * t).checked_div(&(&Rational::ONE - t)).expect("below 1");
        inner.push(cell.frequency.each_ref().map(value));
        let derivatives = derivatives(&self.p.pair());
        let mut ranges: Vec<(Integer, Integer)> = Vec::new();
        for values in expand(&derivatives, &inner).chunks(derivatives.width) {
            if ranges.is_empty() {
                ranges = values.iter().map(|v| (v.clone(), v.clone())).collect();
            }
            for ((low, high), v) in ranges.iter_mut().zip(values) {
                if v < low {
                    *low = v.clone();
                }
                if v > high {
                    *high = v.clone();
                }
            }
        }
        let (mut common, mut is_strict) = (None, false);
        for (i, &degree) in self.p.pair().degrees.iter().enumerate() {
            if degree == 0 || sides[i][0] == sides[i][1] {
                continue;
            }
            let (x, y) = (&ranges[2 + 2 * i], &ranges[3 + 2 * i]);
            let (a, b) = (product(&ranges[0], y), product(x, &ranges[1]));
            let (low, high) = (&a.0 - &b.1, &a.1 - &b.0);
            let sign = match (low.sign(), high.sign()) {
                // Moving this parameter alone leaves the factor of a zero as it is.
                (Sign::Equal, Sign::Equal) => continue,
                (Sign::Greater | Sign::Equal, _) => Sign::Greater,
                (_, Sign::Less | Sign::Equal) => Sign::Less,
                _ => return false,
            };
            let sign = if known.corner[i] { sign } else { sign.reverse() };
            if *common.get_or_insert(sign) != sign {
                return false;
            }
            let moves = self.sides[i].grows() && !self.sides[i].widths()[usize::from(known.corner[i])].is_zero();
            is_strict |= moves && !low.is_zero() && !high.is_zero();
        }
        is_strict
    }

    /// A tree of cells without a zero of the pair, but for those inside the critical cell.
    fn cover(
        &self,
        sides: &[[Rational; 2]],
        corner: &[bool],
        critical: &CriticalCell,
        budget: &Budget,
    ) -> Result<Option<Tree>, Exhausted> {
        let (tensor, _) = Tensor::of_pair(&self.p.pair(), sides, FrequencyScale(self.scale));
        let closed = |cell: &Tensor| {
            let [x, y] = cell.planes.as_slice() else { unreachable!("a pair") };
            separating_vector(x, y, cell.error).map(|(a, b)| Node::Separated(a, b))
        };
        cover(tensor, corner, critical, &closed, budget)
    }

    /// A real root that reaches the boundary: everything else keeps away from it, and near the corner, outside of which it keeps
    /// its sign, the polynomial that vanishes falls towards the corner in every parameter.
    fn exact_real(
        &self,
        known: Known,
        sides: &[[Rational; 2]],
        cause: Cause,
        budget: &Budget,
    ) -> Result<Option<ExactProof>, Exhausted> {
        let mut falling = None;
        for ((own, f), &sign) in self.p.certain.iter().zip(&self.reference) {
            match keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, CELLS, budget)? {
                Ok(_) => {}
                Err(Outcome::Refuted(_)) if *own == cause && falling.is_none() => falling = Some((f, sign)),
                Err(_) => return Ok(None),
            }
        }
        let Some((f, sign)) = falling else { return Ok(None) };
        let nowhere =
            CriticalCell { halvings: vec![0; sides.len()], frequency: [Rational::from(2), Rational::from(3)] };
        if self.cover(sides, &known.corner, &nowhere, budget)?.is_none() {
            return Ok(None);
        }
        let bundle = Bundle::new(&[f], sides.len());
        let closed = |cell: &Tensor| {
            let (low, high) = cell.range(0);
            let signed = if sign.is_gt() { low > cell.error } else { high < -cell.error };
            signed.then(|| Node::Signed(sign.is_gt()))
        };
        for depth in DEPTHS {
            let halvings = vec![depth; sides.len()];
            let inner: Vec<[Rational; 2]> =
                (0..sides.len()).map(|i| corner_part(&sides[i], known.corner[i], depth)).collect();
            let falls = |(i, &up): (usize, &bool)| {
                let slope = f.derivative(i);
                let rising = if up { sign } else { sign.reverse() };
                expand(&Bundle::new(&[&slope], sides.len()), &inner).iter().all(|v| v.sign() != rising)
            };
            if !known.corner.iter().enumerate().all(falls) {
                continue;
            }
            let cell = CriticalCell { halvings, frequency: [Rational::ZERO, Rational::ONE] };
            if let Some(tree) = cover(Tensor::of_one(&bundle, sides), &known.corner, &cell, &closed, budget)? {
                let Known { from, to, corner } = known;
                return Ok(Some(ExactProof { from, to, corner, cell, tree }));
            }
        }
        Ok(None)
    }
}

/// A tree of cells that are closed, but for those inside the critical cell; `None` where it takes too many.
fn cover(
    tensor: Tensor,
    corner: &[bool],
    critical: &CriticalCell,
    closed: &dyn Fn(&Tensor) -> Option<Node>,
    budget: &Budget,
) -> Result<Option<Tree>, Exhausted> {
    let frequency = corner.len();
    let unit = [Rational::ZERO, Rational::ONE];
    let part = |axis: usize| {
        if axis == frequency {
            critical.frequency.clone()
        } else {
            corner_part(&unit, corner[axis], critical.halvings[axis])
        }
    };
    let parts: Vec<[Rational; 2]> = (0..=frequency).map(part).collect();
    let mut stack = vec![Cell::whole(tensor)];
    let mut nodes = Vec::new();
    while let Some(cell) = stack.pop() {
        budget.check()?;
        if let Some(node) = closed(&cell.tensor) {
            nodes.push(node);
            continue;
        }
        let own: Vec<[Rational; 2]> = (0..=frequency).map(|axis| cell.part(axis)).collect();
        let beyond: Vec<usize> =
            (0..=frequency).filter(|&i| own[i][0] < parts[i][0] || own[i][1] > parts[i][1]).collect();
        if beyond.is_empty() {
            nodes.push(Node::Critical);
            continue;
        }
        let meets = (0..=frequency).all(|i| own[i][0] < parts[i][1] && own[i][1] > parts[i][0]);
        if nodes.len() + stack.len() > CELLS {
            return Ok(None);
        }
        let axis = if meets { cell.tensor.best_axis_of(&beyond) } else { cell.tensor.best_axis() };
        let Some(axis) = axis.or_else(|| meets.then(|| beyond[0])) else { return Ok(None) };
        nodes.push(Node::Halved(if axis == frequency { Axis::Frequency } else { Axis::Parameter(axis) }));
        let [low, high] = cell.halves(axis);
        stack.extend([high, low]);
    }
    Ok(Some(Tree(nodes)))
}

/// What the exact proof begins with.
struct Known {
    from: Rational,
    to: Rational,
    corner: Vec<bool>,
}

/// The share `2^-halvings` of a side at its corner.
fn corner_part([low, high]: &[Rational; 2], upper: bool, halvings: u32) -> [Rational; 2] {
    let part = &(high - low) * &Rational::dyadic(&Integer::ONE, u64::from(halvings));
    if upper { [high - &part, high.clone()] } else { [low.clone(), low + &part] }
}

/// The derivatives of the pair by the frequency, which is one more variable, and by each parameter: `E_v, O_v, E_1, O_1, ...`.
fn derivatives(pair: &Bundle) -> Bundle {
    let count = pair.width / 2;
    let parameters = pair.degrees.len();
    let width = 2 + 2 * parameters;
    let mut terms: BTreeMap<Vec<u32>, Vec<Integer>> = BTreeMap::new();
    let mut add = |exponents: Vec<u32>, which: usize, c: Integer| {
        terms.entry(exponents).or_insert_with(|| vec![Integer::ZERO; width])[which] += &c;
    };
    for (exponents, coefficients) in &pair.terms {
        for (at, c) in coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
            let (odd, j) = (at / count, at % count);
            let with = |power: usize| exponents.iter().copied().chain([power as u32]).collect::<Vec<u32>>();
            if j > 0 {
                add(with(j - 1), odd, c * &Integer::from(j as u64));
            }
            for (i, &e) in exponents.iter().enumerate().filter(|(_, e)| **e > 0) {
                let mut lower = with(j);
                lower[i] -= 1;
                add(lower, 2 + 2 * i + odd, c * &Integer::from(u64::from(e)));
            }
        }
    }
    let mut degrees = pair.degrees.clone();
    degrees.push(count - 1);
    Bundle { width, degrees, terms: terms.into_iter().collect() }
}

/// The range of a product of two ranges.
fn product(a: &(Integer, Integer), b: &(Integer, Integer)) -> (Integer, Integer) {
    let all = [&a.0 * &b.0, &a.0 * &b.1, &a.1 * &b.0, &a.1 * &b.1];
    let least = all.iter().min().expect("four").clone();
    let greatest = all.iter().max().expect("four").clone();
    (least, greatest)
}
