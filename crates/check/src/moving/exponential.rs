//! Exponentials of matrices, and of numbers, over a box: what holds and functions of angles are made of.

use super::HeldMatrix;
use crate::clock::Clock;
use crate::number::{Q, Z};
use crate::taylor::{Precision, Taylor};
use num_traits::{One, Zero};

pub(super) type Matrix = Vec<Vec<Taylor>>;

/// The circle number by Machin's formula, `16 atan(1/5) - 4 atan(1/239)`.
pub(crate) fn pi(p: &Precision) -> Taylor {
    // 64 bits more than are asked for, so that no rounding is seen in them.
    let one = Z::one() << (p.bits + 64);
    let inverse_tangent = |n: u32| {
        let (mut power, mut sum, mut k) = (&one / n, Z::zero(), 1_u32);
        while !power.is_zero() {
            let term = &power / k;
            sum = if k % 4 == 1 { sum + term } else { sum - term };
            power /= n * n;
            k += 2;
        }
        sum
    };
    Taylor::units((inverse_tangent(5) * 16 - inverse_tangent(239) * 4) >> 64_usize, Z::from(2))
}

fn product(a: &Matrix, b: &Matrix, p: &Precision, clock: &Clock) -> Result<Matrix, String> {
    let n = a.len();
    let mut out = vec![vec![Taylor::zero(); n]; n];
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                clock.tick()?;
                out[i][j] = out[i][j].plus(&a[i][k].times(&b[k][j], p, clock)?);
            }
        }
    }
    Ok(out)
}

fn mapped(a: &Matrix, f: impl Fn(&Taylor) -> Taylor) -> Matrix {
    a.iter().map(|row| row.iter().map(&f).collect()).collect()
}

fn plus(a: &Matrix, b: &Matrix) -> Matrix {
    a.iter().zip(b).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x.plus(y)).collect()).collect()
}

fn minus(a: &Matrix, b: &Matrix) -> Matrix {
    plus(a, &mapped(b, |x| x.scaled(&-Z::one())))
}

fn by(a: &Matrix, factor: &Taylor, p: &Precision, clock: &Clock) -> Result<Matrix, String> {
    a.iter().map(|row| row.iter().map(|x| x.times(factor, p, clock)).collect()).collect()
}

fn by_number(a: &Matrix, q: &Q) -> Matrix {
    mapped(a, |x| x.scaled(q.numer()).over(q.denom()))
}

/// `sum M^k/k!`, `sum M^k/(k + 1)!` and `sum M^k/(k + 2)!`: of `M/2^s`, with rows that add up to at most `2^-8`, then doubled `s` times.
pub(super) fn exponential(m: &Matrix, p: &Precision, clock: &Clock) -> Result<[Matrix; 3], String> {
    let n = m.len();
    p.hold(12 * n * n, clock)?;
    let norm = m.iter().map(|row| row.iter().map(Taylor::magnitude).sum::<Z>()).max().unwrap_or_default();
    let eighth = Z::one() << (p.bits - 8);
    let mut doublings = 0_usize;
    while (&norm >> doublings) >= eighth {
        doublings += 1;
        if doublings > 64 {
            return Err("an exponent is too large to be enclosed".into());
        }
    }
    let m = mapped(m, |x| x.halved(doublings));
    let one = Taylor::number(&Q::one(), p);
    let unit: Matrix =
        (0..n).map(|i| (0..n).map(|j| if i == j { one.clone() } else { Taylor::zero() }).collect()).collect();
    // The terms M^k/k!, and their sums divided by 1, k + 1, and (k + 1)(k + 2).
    let mut term = unit.clone();
    let mut sums = [unit.clone(), unit.clone(), mapped(&unit, |x| x.over(&Z::from(2)))];
    let (mut k, mut bound) = (0_usize, Z::one());
    while bound <= Z::one() << p.bits {
        k += 1;
        bound = (bound * Z::from(k)) << 8;
        term = mapped(&product(&term, &m, p, clock)?, |x| x.over(&Z::from(k)));
        let divisors = [1, k + 1, (k + 1) * (k + 2)];
        for (sum, divisor) in sums.iter_mut().zip(divisors) {
            *sum = plus(sum, &mapped(&term, |x| x.over(&Z::from(divisor))));
        }
    }
    // What is left out is below twice one over the bound, which is less than a unit.
    for x in sums.iter_mut().flatten().flatten() {
        x.rest += 2;
    }
    let [mut whole, mut first, mut second] = sums;
    for _ in 0..doublings {
        second = mapped(&plus(&plus(&second, &first), &product(&whole, &second, p, clock)?), |x| x.halved(2));
        first = mapped(&plus(&first, &product(&whole, &first, p, clock)?), |x| x.halved(1));
        whole = product(&whole, &whole, p, clock)?;
    }
    Ok([whole, first, second])
}

/// The entries of the matrices of a hold.
pub(super) fn held(
    a: &Matrix,
    time: &Taylor,
    share: &Q,
    matrices: &[HeldMatrix],
    p: &Precision,
    clock: &Clock,
) -> Result<Vec<Taylor>, String> {
    // F, G and H over a share of the sample time.
    let over = |share: &Q| -> Result<[Matrix; 3], String> {
        let span = time.scaled(share.numer()).over(share.denom());
        let [whole, first, second] = exponential(&by(a, &span, p, clock)?, p, clock)?;
        Ok([whole, by(&first, &span, p, clock)?, by_number(&by(&second, &span, p, clock)?, share)])
    };
    let rest = Q::one() - share;
    let ([s0, s1, s2], late) = (over(&rest)?, if share.is_zero() { None } else { Some(over(share)?) });
    let then = |late: &Matrix| product(&s0, late, p, clock);
    let mut out = Vec::new();
    for kind in matrices {
        let matrix = match (kind, &late) {
            (HeldMatrix::State, None) => s0.clone(),
            (HeldMatrix::State, Some([r0, ..])) => then(r0)?,
            (HeldMatrix::Now, _) => s1.clone(),
            (HeldMatrix::LateOfRamp, _) => s2.clone(),
            (HeldMatrix::NowOfRamp, None) => minus(&s1, &s2),
            (HeldMatrix::NowOfRamp, Some([_, r1, r2])) => {
                plus(&then(&plus(&by_number(r1, &rest), r2))?, &minus(&s1, &s2))
            }
            (HeldMatrix::Early, Some([_, r1, _])) => then(r1)?,
            (HeldMatrix::EarlyOfRamp, Some([_, r1, r2])) => then(&minus(&by_number(r1, share), r2))?,
            (HeldMatrix::Early | HeldMatrix::EarlyOfRamp, None) => return Err("internal: nothing is late".into()),
        };
        out.extend(matrix.into_iter().flatten());
    }
    Ok(out)
}

/// The entries of `exp(A t)`.
pub(super) fn flow(a: &Matrix, span: &Taylor, p: &Precision, clock: &Clock) -> Result<Vec<Taylor>, String> {
    let [whole, ..] = exponential(&by(a, span, p, clock)?, p, clock)?;
    Ok(whole.into_iter().flatten().collect())
}

/// The factor `c = w/tan(w T/2)` of Tustin's rule that is exact at `w`, as `w cos(w T/2)/sin(w T/2)`; an error unless `w > 0`, `T > 0` and
/// `w T < pi` are seen at all points of the box.
pub(super) fn prewarped(w: &Taylor, time: &Taylor, p: &Precision, clock: &Clock) -> Result<Taylor, String> {
    let angle = w.times(time, p, clock)?;
    let is_positive = |x: &Taylor| x.sign() == Some(true);
    if !is_positive(w) || !is_positive(time) || !is_positive(&pi(p).minus(&angle)) {
        return Err("a frequency is not shown to be positive and below half the sampling rate".into());
    }
    let [cosine, sine] = turned(angle.halved(1), p, clock)?;
    w.times(&cosine, p, clock)?.times(&sine.inverse(p, clock)?, p, clock)
}

/// Cosine and sine.
pub(crate) fn turned(x: Taylor, p: &Precision, clock: &Clock) -> Result<[Taylor; 2], String> {
    let m = vec![vec![Taylor::zero(), x.clone()], vec![x.scaled(&-Z::one()), Taylor::zero()]];
    let [mut whole, ..] = exponential(&m, p, clock)?;
    let mut first = whole.swap_remove(0);
    let sine = first.pop().unwrap_or_else(Taylor::zero);
    Ok([first.pop().unwrap_or_else(Taylor::zero), sine])
}
