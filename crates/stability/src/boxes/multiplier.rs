//! Vectors that are affine in the coordinates of a cell, for cells that no constant vector closes.
//!
//! At a worst point inside of an edge or a face the zeros of the pair are tangent to the box: constant vectors need cells as
//! small as the distance. A vector `l0 + sum l_k (2 u_k - 1)`, `u_k` from 0 to 1 along axis `k` of the cell, follows the
//! curvature. The product with the pair is a polynomial of one degree more along these axes, and positive if its Bernstein
//! coefficients are. The vector is a point in the convex hull of the coefficients with a small norm
//! ([MitchellDemyanovMalozemov1974](jurist_algebra::bibliography#mitchelldemyanovmalozemov1974)), rounded; the check is exact.

use super::tensor::Tensor;
use jurist_algebra::limits::checkpoint;

/// More coefficients after the degrees were raised are not worked with.
const MOST_ROWS: usize = 1 << 13;

/// Not more parameters than this enter one vector.
const MOST_PARAMETERS: usize = 3;

/// Coefficients count with so many bits while the vector is sought.
const ROW_BITS: u32 = 30;

/// The weights of the coefficients add up to this power of two.
const WEIGHT_BITS: u32 = 40;

/// Steps towards the point of least norm.
const STEPS: usize = 160;

/// A vector `l0 + sum l_k (2 u_k - 1)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Multiplier {
    /// `l0`.
    pub constant: (i128, i128),
    /// The axes with their `l_k`; the last axis of the tensor is the frequency.
    pub slopes: Vec<(usize, (i128, i128))>,
}

/// The pair times 1 and times `2 u_k - 1`, degrees raised along all these axes.
struct Raised {
    planes: Vec<[Vec<i128>; 2]>,
    error: i128,
}

/// What came of the search for a vector.
pub(super) enum Sought {
    /// A vector on whose positive side the pair is everywhere in the cell.
    Found(Multiplier),
    /// None; the axis along which the product with the best vector bends most.
    Missed(Option<usize>),
}

/// A vector on whose positive side the pair is everywhere in the cell, or along which axis to halve the cell.
///
/// Cost: [`STEPS`] passes over the raised coefficients at most.
pub(super) fn affine_multiplier(tensor: &Tensor) -> Sought {
    sought(tensor).unwrap_or(Sought::Missed(None))
}

fn sought(tensor: &Tensor) -> Option<Sought> {
    let axes = chosen_axes(tensor)?;
    let raised = raise(tensor, &axes);
    checkpoint((raised.planes[0][0].len() * axes.len() * 64) as u64);
    let values = seek(&raised)?;
    let largest = raised.planes.iter().flatten().flatten().map(|v| v.unsigned_abs()).max().unwrap_or(0);
    let room = (i128::BITS - 6).checked_sub(i128::BITS - largest.leading_zeros())?;
    let greatest = values.iter().flat_map(|&(x, y)| [x.abs(), y.abs()]).max()?;
    let bits = i128::BITS - greatest.leading_zeros();
    let rounded = |wanted: u32| -> Vec<(i128, i128)> {
        let shift = bits.saturating_sub(wanted);
        let round = |c: i128| if shift == 0 { c } else { ((c >> (shift - 1)) + 1) >> 1 };
        values.iter().map(|&(x, y)| (round(x), round(y))).collect()
    };
    for wanted in [4, 7, 10, 14, 20, 28, 40].into_iter().filter(|&wanted| wanted <= room) {
        let vector = rounded(wanted);
        if raised.all_positive(&vector) {
            let slopes = axes.into_iter().zip(vector[1..].iter().copied()).collect();
            return Some(Sought::Found(Multiplier { constant: vector[0], slopes }));
        }
    }
    let last = rounded(room.min(40));
    let (product, least) = (raised.product(&last), raised.least(&last));
    let mut counts = tensor.counts().to_vec();
    axes.iter().for_each(|&axis| counts[axis] += 1);
    let bends = axes.into_iter().map(|axis| (bend(&product, &counts, axis), std::cmp::Reverse(axis)));
    // Rounding alone does not say where to halve.
    let most = bends.max().filter(|(bend, _)| *bend > 8 * least);
    Some(Sought::Missed(most.map(|(_, axis)| axis.0)))
}

/// The greatest second difference along an axis.
fn bend(values: &[i128], counts: &[usize], axis: usize) -> i128 {
    let stride: usize = counts[axis + 1..].iter().product();
    let count = counts[axis];
    let in_block = |block: &[i128]| {
        let second = |at: usize| (block[at] + block[at + 2 * stride] - 2 * block[at + stride]).abs();
        (0..count.saturating_sub(2) * stride).map(second).max().unwrap_or(0)
    };
    values.chunks(stride * count).map(in_block).max().unwrap_or(0)
}

impl Raised {
    /// The product's Bernstein coefficients, one degree more along the axes.
    fn product(&self, vector: &[(i128, i128)]) -> Vec<i128> {
        let at = |i: usize| vector.iter().zip(&self.planes).map(|((a, b), [x, y])| a * x[i] + b * y[i]).sum::<i128>();
        (0..self.planes[0][0].len()).map(at).collect()
    }

    fn all_positive(&self, vector: &[(i128, i128)]) -> bool {
        let least = self.least(vector);
        self.product(vector).into_iter().all(|value| value > least)
    }

    /// How far a coefficient of the product may be from the true one.
    fn least(&self, vector: &[(i128, i128)]) -> i128 {
        self.error * vector.iter().map(|(a, b)| a.abs() + b.abs()).sum::<i128>()
    }
}

/// The frequency, and the parameters along which the pair moves to both sides of its main direction.
fn chosen_axes(tensor: &Tensor) -> Option<Vec<usize>> {
    let frequency = tensor.axes() - 1;
    let [x, y] = tensor.planes.as_slice() else { return None };
    let (dx, dy) = main_direction(x, y)?;
    let mut parameters: Vec<(i128, usize)> = (0..frequency)
        .filter(|&axis| tensor.count(axis) > 1)
        .map(|axis| {
            let (mut low, mut high) = (i128::MAX, i128::MIN);
            tensor.differences(axis, |x, y| {
                let across = dx * y - dy * x;
                low = low.min(across);
                high = high.max(across);
            });
            (high.min(-low), axis)
        })
        .collect();
    parameters.sort_by_key(|&(extent, axis)| (std::cmp::Reverse(extent), axis));
    let few = parameters.len() <= 2;
    let chosen = parameters.into_iter().filter(|(extent, _)| few || *extent > 0).take(MOST_PARAMETERS);
    let mut axes: Vec<usize> = chosen.map(|(_, axis)| axis).collect();
    axes.sort_unstable();
    if tensor.count(frequency) > 1 {
        axes.push(frequency);
    }
    let rows = |axes: &[usize]| {
        (0..tensor.axes()).map(|i| tensor.count(i) + usize::from(axes.contains(&i))).product::<usize>()
    };
    while rows(&axes) > MOST_ROWS {
        axes.pop()?;
    }
    (!axes.is_empty()).then_some(axes)
}

/// The longest of some vectors, with 40 bits.
fn main_direction(x: &[i128], y: &[i128]) -> Option<(i128, i128)> {
    let (&x, &y) = x.iter().zip(y).max_by_key(|(x, y)| x.abs().max(y.abs()))?;
    let bits = i128::BITS - x.unsigned_abs().max(y.unsigned_abs()).leading_zeros();
    let shift = bits.saturating_sub(ROW_BITS + 10);
    (bits > 0).then_some((x >> shift, y >> shift))
}

fn raise(tensor: &Tensor, axes: &[usize]) -> Raised {
    let mut error = tensor.greatest_error();
    for &axis in axes {
        error *= tensor.count(axis) as i128;
    }
    let one = |plane: &Vec<i128>, slope: Option<usize>| {
        let mut counts = tensor.counts().to_vec();
        let mut values = plane.clone();
        for &axis in axes {
            values = raised_along(&values, &counts, axis, slope == Some(axis));
            counts[axis] += 1;
        }
        values
    };
    let [x, y] = tensor.planes.as_slice() else { unreachable!("a pair") };
    let slopes = std::iter::once(None).chain(axes.iter().map(|&axis| Some(axis)));
    Raised { planes: slopes.map(|slope| [one(x, slope), one(y, slope)]).collect(), error }
}

/// The Bernstein coefficients of a polynomial of degree `n` along an axis, or of its product with `2 u - 1`, in degree `n + 1`,
/// times `n + 1`.
fn raised_along(values: &[i128], counts: &[usize], axis: usize, slope: bool) -> Vec<i128> {
    let stride: usize = counts[axis + 1..].iter().product();
    let count = counts[axis];
    let mut out = Vec::with_capacity(values.len() / count * (count + 1));
    for block in values.chunks(stride * count) {
        for j in 0..=count {
            for at in 0..stride {
                let before = if j > 0 { j as i128 * block[(j - 1) * stride + at] } else { 0 };
                let here = if j < count { (count - j) as i128 * block[j * stride + at] } else { 0 };
                out.push(if slope { before - here } else { before + here });
            }
        }
    }
    out
}

/// Vectors whose sum of products with all rows is positive if there are any, found on rows of few bits.
fn seek(raised: &Raised) -> Option<Vec<(i128, i128)>> {
    let bits_of = |v: i128| i128::BITS - v.unsigned_abs().leading_zeros();
    let largest = raised.planes.iter().flatten().flatten().map(|&v| bits_of(v)).max()?;
    let shift = largest.saturating_sub(60);
    let [x, y] = &raised.planes[0];
    let (dx, dy) = main_direction(x, y)?;
    // Along the main direction and across it; what is across is made as large as what is along.
    let along = |x: i128, y: i128| dx * (x >> shift) + dy * (y >> shift);
    let across = |x: i128, y: i128| dx * (y >> shift) - dy * (x >> shift);
    let largest_of = |f: &dyn Fn(i128, i128) -> i128| {
        let pairs = raised.planes.iter().flat_map(|[x, y]| x.iter().zip(y));
        pairs.map(|(&x, &y)| bits_of(f(x, y))).max().unwrap_or(0)
    };
    let lift = largest_of(&along).saturating_sub(largest_of(&across)).min(36);
    let count = x.len();
    let width = 2 * raised.planes.len();
    let mut rows = Vec::with_capacity(count * width);
    for i in 0..count {
        let wide: Vec<i128> =
            raised.planes.iter().flat_map(|[x, y]| [along(x[i], y[i]), across(x[i], y[i]) << lift]).collect();
        let bits = wide.iter().map(|&v| bits_of(v)).max()?;
        let own = bits.saturating_sub(ROW_BITS);
        rows.extend(wide.iter().map(|v| (v >> own) as i64));
    }
    let nearest = small_norm(&rows, width);
    let back = |pair: &[i128]| {
        // At most 30 + 40 bits, and 40 more of the direction.
        let (p, q) = (pair[0] >> 34, pair[1] >> 34);
        (p * dx - ((q * dy) << lift), p * dy + ((q * dx) << lift))
    };
    Some(nearest.chunks(2).map(back).collect())
}

/// A point of the convex hull of rows, near to zero: by moving weight from the row farthest along it to the one least so, until
/// its products with all rows are positive, or for some steps.
fn small_norm(rows: &[i64], width: usize) -> Vec<i128> {
    let count = rows.len() / width;
    let row = |i: usize| &rows[i * width..(i + 1) * width];
    let dot = |a: &[i64], x: &[i128]| a.iter().zip(x).map(|(&a, &x)| i128::from(a) * x).sum::<i128>();
    let mut weights = vec![0i128; count];
    weights[0] = 1 << WEIGHT_BITS;
    let mut x: Vec<i128> = row(0).iter().map(|&a| i128::from(a) << WEIGHT_BITS).collect();
    for step in 0..=STEPS {
        let (mut least, mut greatest) = ((i128::MAX, 0), (i128::MIN, 0));
        for (i, &weight) in weights.iter().enumerate() {
            let product = dot(row(i), &x);
            if product < least.0 {
                least = (product, i);
            }
            if weight > 0 && product > greatest.0 {
                greatest = (product, i);
            }
        }
        // The products of the weighted rows are the square of the norm on average.
        if least.0 > 0 && (step == STEPS || greatest.0 < 4 * least.0) {
            break;
        }
        let (from, to) = (greatest.1, least.1);
        let difference: Vec<i64> = row(to).iter().zip(row(from)).map(|(a, b)| a - b).collect();
        let square: i128 = difference.iter().map(|&d| i128::from(d) * i128::from(d)).sum();
        if square == 0 {
            break;
        }
        let moved = ((greatest.0 - least.0) / square).min(weights[from]);
        if moved == 0 {
            break;
        }
        weights[from] -= moved;
        weights[to] += moved;
        for (x, d) in x.iter_mut().zip(&difference) {
            *x += moved * i128::from(*d);
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boxes::polynomial::Bundle;
    use crate::boxes::separate::separating_vector;
    use crate::boxes::tensor::FrequencyScale;
    use jurist_algebra::number::parse_number;
    use jurist_algebra::poly::{Domain, MultiPoly};

    /// `E = 1 - v + q` and `O = q^2 + gap + 4 q E`: where `E` vanishes, `O` is `q^2 + gap`.
    fn parabola(gap: &str, side: &str) -> Tensor {
        let q = MultiPoly::variable(0);
        let n = |n: i64| MultiPoly::constant(n.into());
        let gap = parse_number(gap).unwrap();
        let scaled = |p: MultiPoly| p.scaled_by(&gap.denominator());
        let bend = scaled(q.scaled_by(&4.into()).plus(&q.times(&q).scaled_by(&5.into())));
        let o = [bend.plus(&MultiPoly::constant(gap.numerator())), scaled(q.scaled_by(&(-4).into()))];
        let e = [scaled(n(1).plus(&q)), scaled(n(-1))];
        let half = parse_number(side).unwrap();
        let sides = [[-&half, half]];
        Tensor::of_pair(&Bundle::new(&[&e[0], &e[1], &o[0], &o[1]], 1), &sides, FrequencyScale(0)).0
    }

    #[test]
    fn a_pair_that_turns_within_the_cell_is_closed_by_an_affine_vector_only() {
        let tensor = parabola("1/5", "1/4");
        assert_eq!(separating_vector(&tensor.planes[0], &tensor.planes[1], tensor.error), None);
        let Sought::Found(found) = affine_multiplier(&tensor) else { panic!("a vector") };
        // About (-4 q, 1).
        let (a, _) = found.slopes[0].1;
        assert!(found.constant.1 > 0 && a < 0, "{found:?}");
    }

    #[test]
    fn a_zero_in_the_cell_is_never_closed() {
        for (gap, side) in [("0", "1/10"), ("0", "1/1000"), ("-1/10000", "1/10")] {
            assert!(matches!(affine_multiplier(&parabola(gap, side)), Sought::Missed(_)), "{gap} {side}");
        }
    }

    #[test]
    fn the_product_with_a_slope_is_that_of_the_polynomials() {
        // 3 + 2 u in degree 1: coefficients 3, 5; times 2 u - 1: -3 + 4 u + 4 u^2, in degree 2: -3, -1, 5.
        assert_eq!(raised_along(&[3, 5], &[2], 0, true), [-6, -2, 10]);
        assert_eq!(raised_along(&[3, 5], &[2], 0, false), [6, 8, 10]);
        assert_eq!(raised_along(&[1, 2, 3, 4], &[2, 2], 0, false), [2, 4, 4, 6, 6, 8]);
    }

    #[test]
    fn points_around_zero_leave_nothing() {
        let around = [[3, 1], [-2, 1], [0, -4]].concat();
        let x = small_norm(&around, 2);
        assert!((0..3).any(|i| i128::from(around[2 * i]) * x[0] + i128::from(around[2 * i + 1]) * x[1] <= 0));
        let aside = [[3, 1], [-2, 1], [0, 4]].concat();
        let x = small_norm(&aside, 2);
        assert!((0..3).all(|i| i128::from(aside[2 * i]) * x[0] + i128::from(aside[2 * i + 1]) * x[1] > 0));
    }
}
