//! Bernstein coefficients over a box in fixed point, each with a proved error.

use super::polynomial::Bundle;
use super::scores::Scores;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::{Integer, Rational};

/// The greatest coefficient of a fresh tensor has so many bits: a sum of two times 40 bits fits `i128`.
const BITS: u64 = 84;

/// The Bernstein coefficients of one polynomial or a pair over a closed box, each polynomial times an unknown positive power
/// of two. The values lie in the convex hull of the coefficients ([ZettlerGarloff1998](jurist_algebra::bibliography#zettlergarloff1998)).
///
/// The axes are the parameters in their order, then the frequency; the last runs fastest.
#[derive(Clone, Debug)]
pub(super) struct Tensor {
    /// For each axis the number of coefficients along it.
    counts: Vec<usize>,
    /// The coefficients of each polynomial, up to `error`.
    pub planes: Vec<Vec<i128>>,
    /// How far a coefficient may be from the true one.
    pub error: i128,
    /// How much farther, for each polynomial and each place along the frequency axis; none where the polynomials are exact.
    pub slack: Vec<Vec<i128>>,
}

/// How the frequency axis is scaled: `v = 2^scale t / (1 - t)`, `v` the frequency or its square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FrequencyScale(pub i64);

impl Tensor {
    /// Of a pair `E_0, ..., E_k, O_0, ..., O_k` over the box and all frequencies, and by how many powers of two the second
    /// polynomial was made larger relative to the first.
    pub fn of_pair(pair: &Bundle, sides: &[[Rational; 2]], scale: FrequencyScale) -> (Tensor, i64) {
        Tensor::of_pair_within(pair, &[], sides, scale)
    }

    /// The same where each coefficient may be off by so much anywhere in the box.
    pub fn of_pair_within(
        pair: &Bundle,
        slack: &[Integer],
        sides: &[[Rational; 2]],
        FrequencyScale(scale): FrequencyScale,
    ) -> (Tensor, i64) {
        let count = pair.width / 2;
        let k = count - 1;
        let mut binomials = vec![Integer::ONE];
        for j in 0..k {
            let next = &binomials[j] * &Integer::from((k - j) as u64);
            binomials.push(next.div_exact(&Integer::from(j as u64 + 1)));
        }
        let common = binomials.iter().fold(Integer::ONE, |l, b| l.lcm(b));
        let factor = |j: usize| {
            let power = if scale >= 0 { j } else { k - j } as u64;
            &common.div_exact(&binomials[j]) << (scale.unsigned_abs() * power)
        };
        let factors: Vec<Integer> = (0..count).map(factor).collect();
        let scaled = pair.combined(pair.width, |c| c.iter().zip(factors.iter().cycle()).map(|(c, f)| c * f).collect());
        let all = expand(&scaled, sides);
        let plane = |odd: usize| all.chunks(pair.width).flat_map(move |c| c[odd * count..(odd + 1) * count].iter());
        let (even, even_shift) = fixed_point(plane(0));
        let (odd, odd_shift) = fixed_point(plane(1));
        let common = common_factor(pair, sides);
        let off = |odd: usize, shift: i64| {
            let own = slack[odd * count..(odd + 1) * count].iter().zip(&factors);
            fixed_bounds(own.map(|(s, f)| &(s * f) * &common), shift)
        };
        let slack = if slack.is_empty() { Vec::new() } else { vec![off(0, even_shift), off(1, odd_shift)] };
        let counts = pair.degrees.iter().map(|l| l + 1).chain([count]).collect();
        (Tensor { counts, planes: vec![even, odd], error: 1, slack }, odd_shift - even_shift)
    }

    /// Of one polynomial over the box; the frequency axis has one coefficient.
    pub fn of_one(polynomial: &Bundle, sides: &[[Rational; 2]]) -> Tensor {
        Tensor::of_one_within(polynomial, &Integer::ZERO, sides)
    }

    /// The same where the polynomial may be off by so much anywhere in the box.
    pub fn of_one_within(polynomial: &Bundle, slack: &Integer, sides: &[[Rational; 2]]) -> Tensor {
        let all = expand(polynomial, sides);
        let (plane, shift) = fixed_point(all.iter());
        let counts = polynomial.degrees.iter().map(|l| l + 1).chain([1]).collect();
        let slack = match slack.is_zero() {
            true => Vec::new(),
            false => vec![fixed_bounds([slack * &common_factor(polynomial, sides)].into_iter(), shift)],
        };
        Tensor { counts, planes: vec![plane], error: 1, slack }
    }

    /// How far a coefficient of any polynomial may be from the true one.
    pub fn greatest_error(&self) -> i128 {
        self.error + self.slack.iter().flatten().copied().max().unwrap_or(0)
    }

    /// The number of axes; the last is the frequency.
    pub fn axes(&self) -> usize {
        self.counts.len()
    }

    /// The number of coefficients of each polynomial.
    pub fn len(&self) -> usize {
        self.planes[0].len()
    }

    /// The number of coefficients along each axis.
    pub fn counts(&self) -> &[usize] {
        &self.counts
    }

    /// The number of coefficients along an axis.
    pub fn count(&self, axis: usize) -> usize {
        self.counts[axis]
    }

    /// The differences of neighbours of the pair along an axis.
    pub fn differences(&self, axis: usize, mut f: impl FnMut(i128, i128)) {
        let (stride, count) = (self.stride(axis), self.counts[axis]);
        let [x, y] = self.planes.as_slice() else { unreachable!("a pair") };
        for (x, y) in x.chunks(stride * count).zip(y.chunks(stride * count)) {
            for at in 0..(count - 1) * stride {
                f(x[at + stride] - x[at], y[at + stride] - y[at]);
            }
        }
    }

    /// How far neighbours along an axis are apart in the list of coefficients.
    pub fn stride(&self, axis: usize) -> usize {
        self.counts[axis + 1..].iter().product()
    }

    /// The tensors of the lower and the upper half of the box along an axis (de Casteljau).
    pub fn halves(self, axis: usize) -> [Tensor; 2] {
        checkpoint(2 * (self.len() * self.counts[axis]) as u64);
        let (stride, count) = (self.stride(axis), self.counts[axis]);
        let error = self.error + count as i128;
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for mut right in self.planes {
            let mut left = right.clone();
            for (left, right) in left.chunks_mut(stride * count).zip(right.chunks_mut(stride * count)) {
                for step in 1..count {
                    for at in 0..(count - step) * stride {
                        right[at] = (right[at] + right[at + stride]) >> 1;
                    }
                    left[step * stride..(step + 1) * stride].copy_from_slice(&right[..stride]);
                }
            }
            low.push(left);
            high.push(right);
        }
        let [low_slack, high_slack] = match axis + 1 == self.counts.len() {
            true => halved_bounds(self.slack),
            false => [self.slack.clone(), self.slack],
        };
        let make = |planes, slack| Tensor { counts: self.counts.clone(), planes, error, slack };
        [make(low, low_slack), make(high, high_slack)]
    }

    /// The axis along which halving helps most: frequency by its variation, a parameter by how far the values are from being
    /// affine in it; `None` where no axis has any.
    pub fn best_axis(&self) -> Option<usize> {
        let all: Vec<usize> = (0..self.axes()).collect();
        self.best_axis_of(&all)
    }

    /// [`Tensor::best_axis`] of some axes.
    pub fn best_axis_of(&self, axes: &[usize]) -> Option<usize> {
        Scores::of(self).best_of(axes)
    }

    /// The parameter along which the values change most.
    pub fn steepest_parameter(&self) -> usize {
        let steepness = |axis: usize| {
            let (stride, count) = (self.stride(axis), self.counts[axis]);
            let blocks = self.planes.iter().flat_map(|plane| plane.chunks(stride * count));
            blocks.map(|b| (stride..b.len()).map(|at| (b[at] - b[at - stride]).abs()).max().unwrap_or(0)).max()
        };
        (0..self.axes() - 1).max_by_key(|&axis| (steepness(axis), std::cmp::Reverse(axis))).unwrap_or(0)
    }

    /// The least and the greatest coefficient of a polynomial.
    pub fn range(&self, plane: usize) -> (i128, i128) {
        self.planes[plane].iter().fold((i128::MAX, i128::MIN), |(low, high), &v| (low.min(v), high.max(v)))
    }

    /// The corners of the box of parameters, upper ends marked, with the value of the one polynomial there.
    pub fn corners(&self) -> impl Iterator<Item = (Vec<bool>, i128)> + '_ {
        let axes: Vec<usize> = (0..self.axes()).filter(|&i| self.counts[i] > 1).collect();
        (0..1usize << axes.len()).map(move |mask| {
            let mut upper = vec![false; self.axes()];
            let mut at = 0;
            for (bit, &axis) in axes.iter().enumerate() {
                if mask >> bit & 1 == 1 {
                    upper[axis] = true;
                    at += (self.counts[axis] - 1) * self.stride(axis);
                }
            }
            (upper, self.planes[0][at])
        })
    }
}

/// Bounds along the frequency axis for either half of it, rounded up.
fn halved_bounds(slack: Vec<Vec<i128>>) -> [Vec<Vec<i128>>; 2] {
    let (mut low, mut high) = (Vec::new(), slack);
    for right in &mut high {
        let mut left = right.clone();
        for step in 1..left.len() {
            for at in 0..left.len() - step {
                right[at] = (right[at] + right[at + 1] + 1) >> 1;
            }
            left[step] = right[0];
        }
        low.push(left);
    }
    [low, high]
}

/// The factor of all coefficients that [`expand`] gives.
pub(super) fn common_factor(bundle: &Bundle, sides: &[[Rational; 2]]) -> Integer {
    let one = |(&degree, [low, high]): (&usize, &[Rational; 2])| {
        let q = low.denominator().lcm(&high.denominator());
        &common_binomial(degree) * &q.pow(degree as u64)
    };
    bundle.degrees.iter().zip(sides).map(one).fold(Integer::ONE, |product, factor| &product * &factor)
}

/// The Bernstein coefficients of all polynomials of a bundle over a box, times one positive factor; of each multi-index those
/// of all polynomials stand side by side.
pub(super) fn expand(bundle: &Bundle, sides: &[[Rational; 2]]) -> Vec<Integer> {
    let tables: Vec<Vec<Vec<Integer>>> =
        bundle.degrees.iter().zip(sides).map(|(&degree, side)| monomials(degree, side)).collect();
    let terms: Vec<(&[u32], &[Integer])> = bundle.terms.iter().map(|(e, c)| (e.as_slice(), c.as_slice())).collect();
    expand_from(&terms, &tables, bundle.width)
}

/// Terms with the exponents that are left, which are sorted, and the tables of these parameters.
fn expand_from(terms: &[(&[u32], &[Integer])], tables: &[Vec<Vec<Integer>>], width: usize) -> Vec<Integer> {
    let Some((table, rest)) = tables.split_first() else {
        return terms.first().map_or_else(|| vec![Integer::ZERO; width], |(_, c)| c.to_vec());
    };
    let size = width * rest.iter().map(Vec::len).product::<usize>();
    checkpoint((8 * size * table.len()) as u64);
    let mut out = vec![Integer::ZERO; size * table.len()];
    for group in terms.chunk_by(|a, b| a.0[0] == b.0[0]) {
        let exponent = group[0].0[0] as usize;
        let group: Vec<(&[u32], &[Integer])> = group.iter().map(|(e, c)| (&e[1..], *c)).collect();
        let inner = expand_from(&group, rest, width);
        for (block, factor) in out.chunks_mut(size).zip(&table[exponent]) {
            for (target, value) in block.iter_mut().zip(&inner) {
                target.add_mul_assign(value, factor);
            }
        }
    }
    out
}

/// For each exponent the Bernstein coefficients, of the given degree, of that power of the parameter over an interval; all
/// times one positive factor.
fn monomials(degree: usize, [low, high]: &[Rational; 2]) -> Vec<Vec<Integer>> {
    let q = low.denominator().lcm(&high.denominator());
    let whole = |v: &Rational| (v * &Rational::from(&q)).numerator();
    let ends = [whole(low), whole(high)];
    let common = common_binomial(degree);
    let coefficient = |e: usize, j: usize| {
        // The polar form: of the e factors, i are taken at the upper end.
        let mut sum = Integer::ZERO;
        for i in e.saturating_sub(degree - j)..=e.min(j) {
            let ways = &binomial(j, i) * &binomial(degree - j, e - i);
            sum += &ways * &(&ends[1].pow(i as u64) * &ends[0].pow((e - i) as u64));
        }
        &(&sum * &common.div_exact(&binomial(degree, e))) * &q.pow((degree - e) as u64)
    };
    (0..=degree).map(|e| (0..=degree).map(|j| coefficient(e, j)).collect()).collect()
}

fn binomial(n: usize, k: usize) -> Integer {
    (0..k).fold(Integer::ONE, |b, i| (&b * &Integer::from((n - i) as u64)).div_exact(&Integer::from(i as u64 + 1)))
}

/// The least common multiple of the binomial coefficients of a degree.
fn common_binomial(degree: usize) -> Integer {
    (0..=degree).fold(Integer::ONE, |l, e| l.lcm(&binomial(degree, e)))
}

/// Bounds times two to this power, rounded up. Where one is beyond all coefficients, nothing is known, also not of halves.
fn fixed_bounds(bounds: impl Iterator<Item = Integer>, shift: i64) -> Vec<i128> {
    let by = shift.unsigned_abs();
    let scaled: Vec<Integer> = bounds.map(|b| if shift >= 0 { b << by } else { -(-b >> by) }).collect();
    let is_beyond = scaled.iter().any(|b| b.bit_length() > BITS);
    scaled.iter().map(|b| if is_beyond { 1 << BITS } else { small(b) }).collect()
}

/// A number that is not negative and has few bits.
fn small(n: &Integer) -> i128 {
    let limbs = n.as_limbs();
    let limb = |i: usize| i128::from(limbs.get(i).copied().unwrap_or(0));
    limb(0) | limb(1) << 64
}

/// The numbers times a power of two, truncated so that the greatest has [`BITS`] bits, and the exponent of that power.
fn fixed_point<'a>(values: impl Iterator<Item = &'a Integer> + Clone) -> (Vec<i128>, i64) {
    let bits = values.clone().map(Integer::bit_length).max().unwrap_or(0);
    let fixed = |v: &Integer| {
        let magnitude = v.abs();
        let scaled = if bits > BITS { &magnitude >> (bits - BITS) } else { &magnitude << (BITS - bits) };
        let value = small(&scaled);
        if v.is_negative() { -value } else { value }
    };
    (values.map(fixed).collect(), BITS as i64 - bits as i64)
}

#[cfg(test)]
mod tests;
