//! A polynomial in two variables on a box: its Bernstein coefficients in fixed point with a proved error.

use crate::plane::curves::{X, Y};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{MultiPoly, bernstein_weights};

/// The greatest coefficient of a fresh patch has this many bits; sums of two fit `i128`.
const BITS: u64 = 120;

/// A patch whose coefficients have sunk below this many bits above their error is computed again.
const SPARE_BITS: u32 = 24;

/// The coefficients of a polynomial as rows of powers of `x`, one row for each power of `y`.
#[derive(Clone, Debug)]
pub(super) struct Rows(Vec<Vec<Integer>>);

impl Rows {
    /// Of a polynomial in the variables 0 and 1, not zero.
    pub fn new(f: &MultiPoly) -> Rows {
        let width = f.degree_in(X) as usize + 1;
        let mut rows = vec![vec![Integer::ZERO; width]; f.degree_in(Y) as usize + 1];
        for (m, c) in f.terms() {
            rows[m.exponent(Y) as usize][m.exponent(X) as usize] = c.clone();
        }
        Rows(rows)
    }

    /// The patch over the closed box `[x[0], x[1]] x [y[0], y[1]]`, up to a positive factor.
    pub fn patch(&self, x: &[Rational; 2], y: &[Rational; 2]) -> Patch {
        let width = self.0[0].len();
        let rows: Vec<Vec<Integer>> = self.0.iter().map(|row| bernstein(row, x)).collect();
        let columns: Vec<Vec<Integer>> =
            (0..width).map(|i| bernstein(&rows.iter().map(|row| row[i].clone()).collect::<Vec<_>>(), y)).collect();
        let bits = columns.iter().flatten().map(Integer::bit_length).max().unwrap_or(0);
        let fixed = |v: &Integer| {
            let magnitude = v.abs();
            let scaled = if bits > BITS { &magnitude >> (bits - BITS) } else { &magnitude << (BITS - bits) };
            let value = scaled.to_i128().expect("so many bits fit");
            if v.is_negative() { -value } else { value }
        };
        let values = (0..self.0.len()).flat_map(|j| columns.iter().map(move |c| fixed(&c[j]))).collect();
        Patch { width, values, error: i128::from(bits > BITS) }
    }
}

/// The Bernstein coefficients on an interval of the polynomial with coefficients `c`, read with the
/// degree `c.len() - 1`, times a positive factor that depends on the degree and the interval alone.
fn bernstein(c: &[Integer], [low, high]: &[Rational; 2]) -> Vec<Integer> {
    let d = c.len() - 1;
    let q = low.denominator().lcm(&high.denominator());
    let scaled = |v: &Rational| (v * &Rational::from(&q)).numerator();
    let n = scaled(low);
    let m = &scaled(high) - &n;
    // q^d p((n + m t)/q) by Horner's rule.
    let mut out = vec![c[d].clone()];
    let mut power = Integer::ONE;
    for a in c[..d].iter().rev() {
        power = &power * &q;
        out.push(Integer::ZERO);
        for k in (0..out.len()).rev() {
            let mut value = &out[k] * &n;
            if k > 0 {
                value.add_mul_assign(&out[k - 1], &m);
            }
            out[k] = value;
        }
        out[0].add_mul_assign(a, &power);
    }
    // b_i = sum_(k <= i) C(i, k)/C(d, k) a_k.
    for (a, weight) in out.iter_mut().zip(bernstein_weights(d)) {
        *a = &*a * &weight;
    }
    for r in 1..=d {
        for i in (r..=d).rev() {
            let (below, above) = out.split_at_mut(i);
            above[0] += &below[i - 1];
        }
    }
    out
}

/// What is known of the sign of a polynomial in the interior of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PatchSign {
    /// Positive.
    Positive,
    /// Negative.
    Negative,
    /// Not known: it may vanish.
    Mixed,
    /// Not known because the coefficients have lost too many digits.
    Blurred,
}

/// Bernstein coefficients `values[j width + i]`, each known up to `error`, of a polynomial on a box times an
/// unknown positive factor. The polynomial lies between the least and the greatest ([Farouki2012](jurist_algebra::bibliography#farouki2012)).
#[derive(Clone, Debug)]
pub(super) struct Patch {
    width: usize,
    values: Vec<i128>,
    error: i128,
}

impl Patch {
    /// The sign in the interior.
    pub fn sign(&self) -> PatchSign {
        let (low, high) = self.range();
        if low > self.error || (self.error == 0 && low == 0 && high > 0) {
            PatchSign::Positive
        } else if high < -self.error || (self.error == 0 && high == 0 && low < 0) {
            PatchSign::Negative
        } else if high.max(-low) >> SPARE_BITS < self.error {
            PatchSign::Blurred
        } else {
            PatchSign::Mixed
        }
    }

    fn range(&self) -> (i128, i128) {
        let least = self.values.iter().copied().min().expect("a patch has coefficients");
        let greatest = self.values.iter().copied().max().expect("a patch has coefficients");
        (least, greatest)
    }

    /// How much the polynomial may change along either axis, relative to its size, in steps of 2^-30.
    pub fn slopes(&self) -> [i128; 2] {
        let (low, high) = self.range();
        let size = (high.max(-low) >> 30).max(1);
        let rows = self.values.len() / self.width;
        let (mut along_x, mut along_y) = (0i128, 0i128);
        for row in self.values.chunks_exact(self.width) {
            along_x = row.windows(2).fold(along_x, |m, w| m.max((w[1] - w[0]).abs()));
        }
        for (a, b) in self.values.iter().zip(&self.values[self.width..]) {
            along_y = along_y.max((b - a).abs());
        }
        [along_x / size * (self.width as i128 - 1), along_y / size * (rows as i128 - 1)]
    }

    /// The patches of both halves, by de Casteljau's algorithm: means of neighbours never grow, and each
    /// rounds by at most half a unit.
    pub fn halves(&self, axis: usize) -> [Patch; 2] {
        let rows = self.values.len() / self.width;
        let mut right = self.values.clone();
        let mut left = self.values.clone();
        let steps = match axis {
            0 => {
                for (low, high) in left.chunks_exact_mut(self.width).zip(right.chunks_exact_mut(self.width)) {
                    for (step, corner) in low.iter_mut().enumerate().skip(1) {
                        for i in 0..self.width - step {
                            high[i] = (high[i] + high[i + 1]) >> 1;
                        }
                        *corner = high[0];
                    }
                }
                self.width
            }
            _ => {
                for step in 1..rows {
                    let end = (rows - step) * self.width;
                    for at in 0..end {
                        right[at] = (right[at] + right[at + self.width]) >> 1;
                    }
                    left[step * self.width..(step + 1) * self.width].copy_from_slice(&right[..self.width]);
                }
                rows
            }
        };
        let error = self.error + steps as i128 / 2;
        [left, right].map(|values| Patch { width: self.width, values, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;
    use jurist_algebra::poly::Domain;

    fn q(text: &str) -> Rational {
        parse_number(text).unwrap()
    }

    /// `x^2 y - 3 x + 2 y^3 - 1/1` and friends, sampled.
    fn example() -> MultiPoly {
        let (x, y) = (MultiPoly::variable(0), MultiPoly::variable(1));
        let cube = y.times(&y).times(&y);
        let one = |n: i64| MultiPoly::constant(Integer::from(n));
        x.times(&x).times(&y).minus(&x.times(&one(3))).plus(&cube.times(&one(2))).minus(&one(1))
    }

    /// At the corners the coefficients are the values; halves agree with patches made afresh.
    #[test]
    fn halves_are_patches_of_the_halves() {
        let f = example();
        let rows = Rows::new(&f);
        let (x, y) = ([q("-1/3"), q("5/2")], [q("1/7"), q("3")]);
        let whole = rows.patch(&x, &y);
        let middle = [x[0].midpoint(&x[1]), y[0].midpoint(&y[1])];
        let parts = [
            (
                whole.halves(0),
                [
                    rows.patch(&[x[0].clone(), middle[0].clone()], &y),
                    rows.patch(&[middle[0].clone(), x[1].clone()], &y),
                ],
            ),
            (
                whole.halves(1),
                [
                    rows.patch(&x, &[y[0].clone(), middle[1].clone()]),
                    rows.patch(&x, &[middle[1].clone(), y[1].clone()]),
                ],
            ),
        ];
        for (halves, fresh) in parts {
            for (a, b) in halves.iter().zip(&fresh) {
                // Equal up to a factor and the error: compare by cross products with the greatest.
                let at = (0..b.values.len()).max_by_key(|&i| b.values[i].abs()).unwrap();
                for i in 0..a.values.len() {
                    let left = Integer::from(a.values[i] >> 20) * Integer::from(b.values[at]);
                    let right = Integer::from(b.values[i]) * Integer::from(a.values[at] >> 20);
                    let bound = Integer::from(b.values[at].abs()) * Integer::from(8);
                    assert!((&left - &right).abs() <= bound, "coefficient {i}");
                }
            }
        }
    }

    #[test]
    fn signs_at_the_edge() {
        let x = MultiPoly::variable(0);
        let rows = Rows::new(&x);
        let y = [q("0"), q("1")];
        assert_eq!(rows.patch(&[q("0"), q("1")], &y).sign(), PatchSign::Positive);
        assert_eq!(rows.patch(&[q("-1"), q("0")], &y).sign(), PatchSign::Negative);
        assert_eq!(rows.patch(&[q("-1"), q("2")], &y).sign(), PatchSign::Mixed);
        assert_eq!(rows.patch(&[q("1"), q("2")], &y).sign(), PatchSign::Positive);
    }
}
