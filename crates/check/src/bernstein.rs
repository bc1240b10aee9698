//! Bernstein coefficients over a box, exactly, and trees that halve it until each cell shows what is claimed.

use super::boxes::Ground;
use super::clock::Clock;
use super::multivariate::Multi;
use super::number::{MAX_DIGITS, Q, Z, integer, shorten};
use super::over_box::FIRST;
use super::univariate::{gcd_counted, gcd_of};
use num_traits::{One, Signed, Zero};

/// More coefficients of a polynomial are refused.
const MAX_COEFFICIENTS: usize = 1 << 17;

/// A polynomial in the parameters of a box as far as its coefficients are known: exponents, about what stands there, and by how much that may
/// be off at most; all times one positive number.
pub(super) struct Known(pub Vec<(Vec<u32>, Z, Z)>);

/// The Bernstein coefficients of polynomials over a box, each polynomial times a positive number; the last axis is the frequency and
/// runs fastest.
#[derive(Clone)]
pub(super) struct Tensor {
    counts: Vec<usize>,
    planes: Vec<Vec<Z>>,
    /// By how much the true coefficients of each polynomial may be off at most.
    slack: Vec<Z>,
}

impl Tensor {
    /// Of one polynomial over a box of its parameters.
    pub fn of_one(p: &Multi, sides: &[[Q; 2]], ground: &Ground, clock: &Clock) -> Result<Tensor, String> {
        Tensor::new(&[vec![ground.known(p, clock)?]], sides, &[vec![Z::one()]], clock)
    }

    /// Of `(1 - t)^k E` and `weight (1 - t)^k O` for `v = v0 t/(1 - t)`, where `E(v) + i w O(v)`, `v = w^2`, is the polynomial
    /// with these coefficients at `s = i w`.
    pub fn of_pair(
        p: &[Multi],
        sides: &[[Q; 2]],
        [v0, weight]: [&Q; 2],
        ground: &Ground,
        clock: &Clock,
    ) -> Result<Tensor, String> {
        let k = (p.len() - 1) / 2;
        let part = |odd: usize| -> Result<Vec<Known>, String> {
            let at = |j: usize| p.get(2 * j + odd).cloned().unwrap_or_default();
            (0..=k).map(|j| ground.known(&at(j).scaled(&Z::from(if j % 2 == 1 { -1 } else { 1 })), clock)).collect()
        };
        let ways = binomials(k);
        let common = common_multiple(&ways, clock)?;
        let (top, bottom) = (v0.numer(), v0.denom());
        clock.hold(k + 1, (k as u64) * (2 + top.bits() + bottom.bits()))?;
        clock.spend(4 * k, (k as u64) * (top.bits() + bottom.bits()), k as u64)?;
        let scales = [weight.denom(), weight.numer()].map(|weight| -> Vec<Z> {
            let at = |j: usize| top.pow(j as u32) * bottom.pow((k - j) as u32) * (&common / &ways[j]) * weight;
            (0..=k).map(at).collect()
        });
        Tensor::new(&[part(0)?, part(1)?], sides, &scales, clock)
    }

    /// Of lists of polynomials in the parameters, each list for the powers of the frequency, times a positive number each.
    fn new(lists: &[Vec<Known>], sides: &[[Q; 2]], scales: &[Vec<Z>], clock: &Clock) -> Result<Tensor, String> {
        let of = |(e, _, _): &(Vec<u32>, Z, Z), i: usize| e.get(FIRST + i).copied().unwrap_or(0) as usize;
        let terms = || lists.iter().flatten().flat_map(|p| &p.0);
        let degree = |i: usize| terms().map(|term| of(term, i)).max().unwrap_or(0);
        let mut counts: Vec<usize> = (0..sides.len()).map(|i| degree(i) + 1).collect();
        counts.push(lists[0].len());
        let size = counts.iter().try_fold(1usize, |n, &c| n.checked_mul(c)).filter(|&n| n <= MAX_COEFFICIENTS);
        let size = size.ok_or_else(|| format!("there are more than {MAX_COEFFICIENTS} coefficients"))?;
        let of_parts = |part: fn(&(Vec<u32>, Z, Z)) -> &Z| -> Tensor {
            let mut planes = vec![vec![Z::zero(); size]; lists.len()];
            for (plane, list) in planes.iter_mut().zip(lists) {
                for (j, p) in list.iter().enumerate() {
                    for term in &p.0 {
                        let place = (0..sides.len()).fold(0, |place, i| place * counts[i] + of(term, i));
                        plane[place * list.len() + j] = part(term).clone();
                    }
                }
            }
            Tensor { counts: counts.clone(), planes, slack: vec![Z::zero(); lists.len()] }
        };
        let mut tensor = of_parts(|(_, about, _)| about);
        tensor.change_all(sides, scales, false, clock)?;
        if terms().any(|(_, _, off)| !off.is_zero()) {
            let mut off = of_parts(|(_, _, off)| off);
            off.change_all(sides, scales, true, clock)?;
            tensor.slack = off.planes.into_iter().map(|plane| plane.into_iter().max().unwrap_or_default()).collect();
        }
        tensor.reduce(clock)?;
        Ok(tensor)
    }

    /// From powers to Bernstein's polynomials along all axes, the frequency's coefficients times these numbers. Of bounds the coefficients
    /// become bounds again.
    fn change_all(&mut self, sides: &[[Q; 2]], scales: &[Vec<Z>], bounds: bool, clock: &Clock) -> Result<(), String> {
        for (i, side) in sides.iter().enumerate() {
            if self.counts[i] > 1 {
                self.change_basis(i, side, bounds, clock)?;
            }
        }
        let longest = scales.iter().flatten().map(Z::bits).max().unwrap_or(0);
        clock.hold(self.planes.len() * self.len(), self.longest() + longest)?;
        clock.spend(self.planes.len() * self.len(), longest, self.longest())?;
        for (plane, scales) in self.planes.iter_mut().zip(scales) {
            for (c, scale) in plane.iter_mut().zip(scales.iter().cycle()) {
                *c *= scale;
            }
        }
        Ok(())
    }

    fn len(&self) -> usize {
        self.planes[0].len()
    }

    fn stride(&self, axis: usize) -> usize {
        self.counts[axis + 1..].iter().product()
    }

    fn longest(&self) -> u64 {
        self.planes.iter().flatten().map(Z::bits).max().unwrap_or(0)
    }

    /// Without integers common to all: a positive factor does not matter. Beside what may be off these mean nothing.
    fn reduce(&mut self, clock: &Clock) -> Result<(), String> {
        if self.slack.iter().any(|off| !off.is_zero()) {
            return Ok(());
        }
        let common = gcd_of(self.planes.iter().flatten(), clock)?;
        if !common.is_zero() && !common.is_one() {
            clock.spend(self.planes.len() * self.len(), self.longest(), common.bits())?;
            self.planes.iter_mut().flatten().for_each(|c| *c /= &common);
        }
        Ok(())
    }

    /// From the powers of a parameter to Bernstein's polynomials over an interval, along an axis.
    fn change_basis(&mut self, axis: usize, side: &[Q; 2], bounds: bool, clock: &Clock) -> Result<(), String> {
        let (stride, count) = (self.stride(axis), self.counts[axis]);
        let mut basis = Basis::new(count - 1, side, clock)?;
        if bounds {
            // All else in it is positive: what is off adds up.
            basis.a = basis.a.abs();
        }
        let bits = self.longest() + basis.bits();
        clock.hold(self.planes.len() * self.len(), bits)?;
        for plane in &mut self.planes {
            for block in plane.chunks_mut(stride * count) {
                for at in 0..stride {
                    let mut lane: Vec<Z> = (0..count).map(|k| std::mem::take(&mut block[at + k * stride])).collect();
                    basis.change(&mut lane, bits, clock)?;
                    lane.into_iter().enumerate().for_each(|(j, c)| block[at + j * stride] = c);
                }
            }
        }
        Ok(())
    }

    /// Over the lower and the upper half of the box along an axis, times a power of two (de Casteljau without divisions).
    fn halves(self, axis: usize, clock: &Clock) -> Result<[Tensor; 2], String> {
        let (stride, count) = (self.stride(axis), self.counts[axis]);
        clock.spend(self.planes.len() * self.len() * count, self.longest(), 64)?;
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for mut right in self.planes {
            let mut left = right.clone();
            for (left, right) in left.chunks_mut(stride * count).zip(right.chunks_mut(stride * count)) {
                left[..stride].iter_mut().for_each(|c| *c <<= count - 1);
                for step in 1..count {
                    for at in 0..(count - step) * stride {
                        let next = std::mem::take(&mut right[at]) + &right[at + stride];
                        right[at] = next;
                    }
                    for at in 0..stride {
                        left[step * stride + at] = &right[at] << (count - 1 - step);
                    }
                }
                // After all steps the coefficient j of the upper half was added j times less than the first one.
                for (j, part) in right.chunks_mut(stride).enumerate().skip(1) {
                    part.iter_mut().for_each(|c| *c <<= j);
                }
            }
            low.push(left);
            high.push(right);
        }
        let slack: Vec<Z> = self.slack.iter().map(|s| s << (count - 1)).collect();
        let make = |planes| Tensor { counts: self.counts.clone(), planes, slack: slack.clone() };
        Ok([make(low), make(high)])
    }

    /// Whether all coefficients of `a` times the first and `b` times the second polynomial are positive.
    fn is_separated(&self, a: &Z, b: &Z, clock: &Clock) -> Result<bool, String> {
        clock.spend(2 * self.len(), self.longest(), a.bits().max(b.bits()))?;
        let off = self.off(a, b);
        Ok(self.planes[0].iter().zip(&self.planes[1]).all(|(x, y)| x * a + y * b > off))
    }

    /// By how much `a` times the first and `b` times the second polynomial may be off.
    fn off(&self, a: &Z, b: &Z) -> Z {
        &self.slack[0] * a.abs() + &self.slack[1] * b.abs()
    }

    /// The same for a vector `(a, b)` plus `(a_k, b_k) (2 u_k - 1)` for some axes, `u_k` from 0 to 1 along each: the product has one degree
    /// more along these axes.
    fn is_separated_affinely(&self, axes: &[usize], vectors: &[[Z; 2]], clock: &Clock) -> Result<bool, String> {
        let mut sum: Vec<Z> = Vec::new();
        // Each axis that is raised makes weights that add up to the number of coefficients along it.
        let weight: Z = axes.iter().map(|axis| Z::from(self.counts[*axis])).product();
        let off: Z = vectors.iter().map(|[a, b]| self.off(a, b)).sum::<Z>() * weight;
        for (n, [a, b]) in vectors.iter().enumerate() {
            clock.spend(4 * self.len() * (axes.len() + 1), self.longest(), a.bits().max(b.bits()))?;
            let mut term: Vec<Z> = self.planes[0].iter().zip(&self.planes[1]).map(|(x, y)| x * a + y * b).collect();
            let mut counts = self.counts.clone();
            for (k, &axis) in axes.iter().enumerate() {
                term = raised(&term, &counts, axis, n == k + 1);
                counts[axis] += 1;
            }
            if sum.is_empty() { sum = term } else { sum.iter_mut().zip(term).for_each(|(s, t)| *s += t) }
        }
        Ok(sum.iter().all(|c| *c > off))
    }

    /// Whether all coefficients have this sign.
    pub fn has_sign(&self, positive: bool) -> bool {
        let off = &self.slack[0];
        self.planes[0].iter().all(|c| c.magnitude() > off.magnitude() && c.is_positive() == positive)
    }
}

fn binomials(n: usize) -> Vec<Z> {
    let mut row = vec![Z::one()];
    for k in 0..n {
        let next = &row[k] * Z::from(n - k) / Z::from(k + 1);
        row.push(next);
    }
    row
}

/// The least common multiple.
fn common_multiple(numbers: &[Z], clock: &Clock) -> Result<Z, String> {
    let mut common = Z::one();
    for n in numbers {
        common = &common / gcd_counted(&common, n, clock)? * n;
    }
    Ok(common)
}

/// From the powers of a parameter to Bernstein's polynomials over an interval, times a positive number: with `p = (a + w u)/q`,
/// `p^f = sum_e C(f, e) a^(f - e) w^e u^e / q^f`, and `u^e = sum_(j >= e) C(j, e)/C(l, e) B_j`.
struct Basis {
    a: Z,
    w: Z,
    q: Z,
    /// The common multiple of the `C(l, e)` divided by each.
    shares: Vec<Z>,
}

impl Basis {
    fn new(l: usize, [low, high]: &[Q; 2], clock: &Clock) -> Result<Self, String> {
        let q = low.denom() / gcd_counted(low.denom(), high.denom(), clock)? * high.denom();
        let (a, b) = (low.numer() * (&q / low.denom()), high.numer() * (&q / high.denom()));
        clock.hold(l + 1, 2 * l as u64)?;
        let ways = binomials(l);
        let common = common_multiple(&ways, clock)?;
        Ok(Basis { w: b - &a, a, q, shares: ways.iter().map(|b| &common / b).collect() })
    }

    /// The bits by which coefficients grow at most.
    fn bits(&self) -> u64 {
        let longest = self.a.bits().max(self.w.bits()).max(self.q.bits());
        self.shares.len() as u64 * (longest + 4)
    }

    /// Of one polynomial, its numbers of so many bits at most in the end.
    fn change(&self, c: &mut [Z], bits: u64, clock: &Clock) -> Result<(), String> {
        let l = c.len() - 1;
        if c.iter().all(Zero::is_zero) {
            return Ok(());
        }
        clock.spend(4 * c.len(), bits, self.q.bits().max(self.w.bits()))?;
        let mut power = Z::one();
        for x in c.iter_mut().rev() {
            *x *= &power;
            power *= &self.q;
        }
        for i in 0..l {
            clock.spend(l - i, bits, self.a.bits())?;
            for j in (i..l).rev() {
                let (lower, upper) = c.split_at_mut(j + 1);
                lower[j] += &upper[0] * &self.a;
            }
        }
        power = Z::one();
        for (x, share) in c.iter_mut().zip(&self.shares) {
            *x *= &power * share;
            power *= &self.w;
        }
        for i in 0..l {
            clock.spend(l - i, bits, 0)?;
            for j in (i + 1..=l).rev() {
                let (lower, upper) = c.split_at_mut(j);
                upper[0] += &lower[j - 1];
            }
        }
        Ok(())
    }
}

/// Coefficients of one degree more along an axis, times that degree: of the same polynomial, or of it times `2 u - 1`.
fn raised(values: &[Z], counts: &[usize], axis: usize, times_share: bool) -> Vec<Z> {
    let stride: usize = counts[axis + 1..].iter().product();
    let count = counts[axis];
    let mut out = Vec::with_capacity(values.len() / count * (count + 1));
    for block in values.chunks(stride * count) {
        for j in 0..=count {
            for at in 0..stride {
                let below = if j > 0 { &block[(j - 1) * stride + at] * Z::from(j) } else { Z::zero() };
                let above = if j < count { &block[j * stride + at] * Z::from(count - j) } else { Z::zero() };
                out.push(if times_share { below - above } else { below + above });
            }
        }
    }
    out
}

/// What the leaves of a tree show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Claim {
    /// That the polynomial has no zero.
    Sign,
    /// That the two polynomials have no common zero.
    Pair,
}

/// Walks through a tree over a whole box: `x` halves the frequency, `s` a parameter, and the lower half follows first; the leaves show
/// the claim in their cells.
pub(super) fn walk(text: &str, whole: Tensor, claim: Claim, clock: &Clock) -> Result<(), String> {
    let last = whole.counts.len() - 1;
    let mut rest = text;
    let mut stack = vec![whole];
    while let Some(cell) = stack.pop() {
        clock.tick()?;
        let mut letters = rest.chars();
        let letter = letters.next().ok_or("the tree ends too early")?;
        rest = letters.as_str();
        let shown = match (letter, claim) {
            ('x', Claim::Pair) | ('s', _) => {
                let axis = if letter == 'x' { last } else { axis(until(&mut rest, ',')?, last)? };
                let bits = cell.longest() + cell.counts[axis] as u64;
                clock.hold((stack.len() + 2).saturating_mul(cell.planes.len() * cell.len()), bits)?;
                let [low, high] = cell.halves(axis, clock)?;
                stack.extend([high, low]);
                true
            }
            ('l', Claim::Pair) => match numbers(until(&mut rest, ';')?)?.as_slice() {
                [a, b] => cell.is_separated(a, b, clock)?,
                _ => return Err("a vector has two numbers".into()),
            },
            ('a', Claim::Pair) => {
                let axes: Vec<usize> = until(&mut rest, ':')?
                    .split(',')
                    .map(|text| if text == "x" { Ok(last) } else { axis(text, last) })
                    .collect::<Result<_, _>>()?;
                let all = numbers(until(&mut rest, ';')?)?;
                let vectors: Vec<[Z; 2]> = all.chunks_exact(2).map(|v| [v[0].clone(), v[1].clone()]).collect();
                if !axes.is_sorted_by(|a, b| a < b) || all.len() != 2 * (axes.len() + 1) {
                    return Err("a leaf has not one vector for each axis and one more".into());
                }
                cell.is_separated_affinely(&axes, &vectors, clock)?
            }
            ('+' | '-', Claim::Sign) => cell.has_sign(letter == '+'),
            _ => return Err(format!("'{}' is no part of this tree", letter.escape_debug())),
        };
        if !shown {
            return Err(format!("a leaf '{letter}' does not show what it says"));
        }
    }
    if rest.is_empty() { Ok(()) } else { Err("something follows the tree".into()) }
}

/// What stands before a mark; the text goes on behind it.
fn until<'t>(rest: &mut &'t str, mark: char) -> Result<&'t str, String> {
    let (before, after) = rest.split_once(mark).ok_or("the tree ends too early")?;
    *rest = after;
    Ok(before)
}

/// The number of a parameter.
fn axis(text: &str, parameters: usize) -> Result<usize, String> {
    let plain = text.len() <= 6 && text.bytes().all(|b| b.is_ascii_digit());
    let number = text.parse().ok().filter(|&i: &usize| plain && i < parameters);
    number.ok_or_else(|| format!("'{}' is the number of no parameter", shorten(&text.escape_debug().to_string())))
}

fn numbers(text: &str) -> Result<Vec<Z>, String> {
    if text.len() > MAX_DIGITS {
        return Err("a leaf is too long".into());
    }
    text.split(',').map(integer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use std::time::Duration;

    /// `2 x^2 y - 3 x + 5 y + 7` in variables 2 and 3.
    fn example() -> Multi {
        let terms = [(vec![0, 0, 2, 1], 2), (vec![0, 0, 1], -3), (vec![0, 0, 0, 1], 5), (vec![], 7)];
        Multi(terms.into_iter().map(|(e, c)| (e, Z::from(c))).collect::<BTreeMap<_, _>>())
    }

    fn q(a: i64, b: i64) -> Q {
        Q::new(Z::from(a), Z::from(b))
    }

    fn value(x: &Q, y: &Q) -> Q {
        q(2, 1) * x * x * y - q(3, 1) * x + q(5, 1) * y + q(7, 1)
    }

    #[test]
    fn corners_are_values_and_halves_are_those_of_the_halves() {
        let clock = Clock::new(Duration::MAX);
        let sides = [[q(-1, 3), q(5, 2)], [q(1, 7), q(3, 1)]];
        let whole = Tensor::of_one(&example(), &sides, &Ground::integers(2), &clock).unwrap();
        let corners = |t: &Tensor, sides: &[[Q; 2]; 2]| {
            let all = &t.planes[0];
            let ratio = value(&sides[0][0], &sides[1][0]) / Q::from(all[0].clone());
            for (at, x, y) in [(1, 0, 1), (4, 1, 0), (5, 1, 1)] {
                assert_eq!(&ratio * Q::from(all[at].clone()), value(&sides[0][x], &sides[1][y]));
            }
        };
        corners(&whole, &sides);
        let middle = (&sides[0][0] + &sides[0][1]) / q(2, 1);
        let [low, high] = whole.halves(0, &clock).unwrap();
        let lower = [[sides[0][0].clone(), middle.clone()], sides[1].clone()];
        let upper = [[middle, sides[0][1].clone()], sides[1].clone()];
        for (mut half, sides) in [(low, lower), (high, upper)] {
            corners(&half, &sides);
            half.reduce(&clock).unwrap();
            assert_eq!(half.planes, Tensor::of_one(&example(), &sides, &Ground::integers(2), &clock).unwrap().planes);
        }
    }

    #[test]
    fn a_raised_polynomial_is_the_same_and_its_product_is_that() {
        // 1 + u and (1 + u)(2 u - 1) = -1 + u + 2 u^2, all times 2.
        let values = [1, 2].map(Z::from);
        assert_eq!(raised(&values, &[2], 0, false), [2, 3, 4].map(Z::from));
        assert_eq!(raised(&values, &[2], 0, true), [-2, -1, 4].map(Z::from));
    }

    #[test]
    fn a_tree_shows_what_its_leaves_show() {
        let clock = Clock::new(Duration::MAX);
        let sides = [[q(0, 1), q(1, 1)], [q(0, 1), q(1, 1)]];
        let one = || Tensor::of_one(&example(), &sides, &Ground::integers(2), &clock).unwrap();
        for (tree, is_right) in [
            ("+", true),
            ("s0,++", true),
            ("s1,+s0,++", true),
            ("-", false),
            ("s0,+-", false),
            ("s0,+", false),
            ("++", false),
            ("", false),
            ("s2,++", false),
            ("s,++", false),
            ("s+0,++", false),
            ("x++", false),
            ("l1,0;", false),
            ("é", false),
        ] {
            assert_eq!(walk(tree, one(), Claim::Sign, &clock).is_ok(), is_right, "{tree}");
        }
        // s^2 + a s + b with a, b in [1, 2]: E = b - v, O = a.
        let variable = |k: usize| Multi::variable(FIRST + k);
        let p = [variable(1), variable(0), Multi::one()];
        let sides = [[q(1, 1), q(2, 1)], [q(1, 1), q(2, 1)]];
        let pair = || Tensor::of_pair(&p, &sides, [&q(4, 1), &q(1, 2)], &Ground::integers(2), &clock).unwrap();
        for (tree, is_right) in [
            ("l-1,5;", true),
            ("xl0,1;l-1,5;", true),
            ("a0,x:-1,5,0,0,0,0;", true),
            ("s1,l-1,5;a1:-2,10,0,1;", true),
            ("l1,0;", false),
            ("l0,1;", false),
            ("l-1,4;", false),
            ("l-1;", false),
            ("l-1,5", false),
            ("l-1,5,2;", false),
            ("a0:-1,5;", false),
            ("a0:-1,5,0,9;", false),
            ("ax,0:-1,5,0,0,0,0;", false),
            ("a0,0:-1,5,0,0,0,0;", false),
            ("+", false),
            ("c", false),
        ] {
            assert_eq!(walk(tree, pair(), Claim::Pair, &clock).is_ok(), is_right, "{tree}");
        }
    }
}
