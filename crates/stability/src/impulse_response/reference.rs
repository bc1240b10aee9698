//! The slow way: samples as rational numbers, and a tail by powers of the matrix as rational numbers.

use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;

/// The first samples.
pub fn samples(numerator: &UniPoly, denominator: &UniPoly, count: usize) -> Vec<Rational> {
    let n = denominator.coeffs().len() - 1;
    let leading = Rational::from(denominator.coeff(n));
    let mut samples: Vec<Rational> = Vec::new();
    for k in 0..count {
        let mut above = if k <= n { Rational::from(numerator.coeff(n - k)) } else { Rational::ZERO };
        for i in 1..=n.min(k) {
            above -= &(&Rational::from(denominator.coeff(n - i)) * &samples[k - i]);
        }
        samples.push(above.checked_div(&leading).unwrap());
    }
    samples
}

/// Two numbers around the sum of absolute values, from so many samples and as many powers of the matrix one after another as have a
/// norm of a half or more.
pub fn bracket(numerator: &UniPoly, denominator: &UniPoly, count: usize) -> [Rational; 2] {
    let n = denominator.coeffs().len() - 1;
    let samples = samples(numerator, denominator, count + n);
    let below: Rational = samples[..count].iter().map(Rational::abs).fold(Rational::ZERO, |a, b| a + b);
    // The columns of a power are the windows of the responses to single numbers in the first window.
    let free: Vec<Vec<Rational>> = (0..n).map(|j| free_response(denominator, j, 4 * count)).collect();
    let norm = |k: usize| {
        let row = |i: usize| free.iter().map(|column| column[k + i].abs()).fold(Rational::ZERO, |a, b| a + b);
        (0..n).map(row).max().unwrap_or(Rational::ZERO)
    };
    let mut all = Rational::ZERO;
    for k in 0.. {
        let norm = norm(k);
        if k > 0 && &norm + &norm <= Rational::ONE {
            let window = samples[count..].iter().map(Rational::abs).max().unwrap_or(Rational::ZERO);
            let tail = (&all * &window).checked_div(&(Rational::ONE - norm)).unwrap();
            return [below.clone(), below + tail];
        }
        all += norm;
    }
    unreachable!("a norm of a stable matrix is small in the end")
}

/// What the recursion makes of a window that is 1 at one place and 0 elsewhere.
fn free_response(denominator: &UniPoly, place: usize, count: usize) -> Vec<Rational> {
    let n = denominator.coeffs().len() - 1;
    let leading = Rational::from(denominator.coeff(n));
    let mut out: Vec<Rational> = (0..n).map(|i| if i == place { Rational::ONE } else { Rational::ZERO }).collect();
    for k in n..count {
        let mut next = Rational::ZERO;
        for i in 1..=n {
            next -= &(&Rational::from(denominator.coeff(n - i)) * &out[k - i]);
        }
        out.push(next.checked_div(&leading).unwrap());
    }
    out
}
