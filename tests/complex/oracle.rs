//! The criterion of Schur and Cohn for complex polynomials, in rationals, which shares nothing with the engine; and random loops.

use crate::helpers::number::ratio;
use crate::helpers::random::Random;
use jurist_algebra::number::Rational;

/// A complex number: real and imaginary part.
pub type Complex = [Rational; 2];

pub fn times(a: &Complex, b: &Complex) -> Complex {
    [&(&a[0] * &b[0]) - &(&a[1] * &b[1]), &(&a[0] * &b[1]) + &(&a[1] * &b[0])]
}

pub fn plus(a: &Complex, b: &Complex) -> Complex {
    [&a[0] + &b[0], &a[1] + &b[1]]
}

fn conjugate(a: &Complex) -> Complex {
    [a[0].clone(), -&a[1]]
}

fn square(a: &Complex) -> Rational {
    &(&a[0] * &a[0]) + &(&a[1] * &a[1])
}

/// Whether all roots are inside of the unit circle; coefficients from the constant term up, the last one not zero: degree by degree.
pub fn is_schur(polynomial: &[Complex]) -> bool {
    let mut p = polynomial.to_vec();
    while p.len() > 1 {
        let n = p.len() - 1;
        if square(&p[0]) >= square(&p[n]) {
            return false;
        }
        let (first, last) = (p[0].clone(), conjugate(&p[n]));
        let minus = [-&first[0], -&first[1]];
        p = (1..=n).map(|k| plus(&times(&last, &p[k]), &times(&minus, &conjugate(&p[n - k])))).collect();
    }
    true
}

/// Whether all roots are left of the imaginary axis: `s = (z - 1)/(z + 1)` brings them into the unit circle.
pub fn is_hurwitz(polynomial: &[Complex]) -> bool {
    let n = polynomial.len() - 1;
    let mut sum = vec![[Rational::ZERO, Rational::ZERO]; n + 1];
    for (k, c) in polynomial.iter().enumerate() {
        let mut term = vec![c.clone()];
        for i in 0..n {
            // Times z - 1 or z + 1.
            let sign = Rational::from(if i < k { -1 } else { 1 });
            let mut next = vec![[Rational::ZERO, Rational::ZERO]; term.len() + 1];
            for (m, t) in term.iter().enumerate() {
                next[m] = plus(&next[m], &[&t[0] * &sign, &t[1] * &sign]);
                next[m + 1] = plus(&next[m + 1], t);
            }
            term = next;
        }
        sum = sum.iter().zip(&term).map(|(a, b)| plus(a, b)).collect();
    }
    // A degree that is lost is a root at z = infinity.
    !square(&sum[n]).is_zero() && is_schur(&sum)
}

/// A loop with the characteristic polynomial `x^n + sum (a_k + b_k K) x^k`, coefficients from the constant term up.
#[derive(Clone, Debug)]
pub struct Loop {
    pub a: Vec<[i64; 2]>,
    pub b: Vec<[i64; 2]>,
    pub below: i64,
    pub is_discrete: bool,
}

impl Loop {
    pub fn random(random: &mut Random, is_discrete: bool) -> Loop {
        let order = 1 + random.below(4);
        let mut part = |most: i64| random.below(2 * most as usize + 1) as i64 - most;
        // In continuous time the larger coefficients of a stable loop are likelier.
        let shift = if is_discrete { 0 } else { 3 };
        let a = (0..order).map(|_| [part(3) + shift, part(3)]).collect();
        let b = (0..order).map(|_| [part(2), part(2)]).collect();
        Loop { a, b, below: 4, is_discrete }
    }

    fn variable(&self) -> &'static str {
        if self.is_discrete { "z" } else { "s" }
    }

    pub fn head(&self) -> String {
        let time = if self.is_discrete { "discrete" } else { "continuous" };
        format!("time = '{time}'\n[parameters]\nK = {{ nominal = 0.1, min = -4, max = 4 }}\n[loop]\n")
    }

    /// The text with this sign before the imaginary unit.
    pub fn text(&self, sign: i64) -> String {
        let x = self.variable();
        let term = |(k, (a, b)): (usize, (&[i64; 2], &[i64; 2]))| {
            let below = self.below;
            format!("(({} + {}*j) + ({} + {}*j)*K)/{below}*{x}^{k}", a[0], sign * a[1], b[0], sign * b[1])
        };
        let terms: Vec<String> = self.a.iter().zip(&self.b).enumerate().map(term).collect();
        format!("{}characteristic = '{x}^{} + {}'\n", self.head(), self.a.len(), terms.join(" + "))
    }

    /// The same loop in real form: the companion matrix, each entry `x + jy` as `[[x, -y], [y, x]]`.
    pub fn real_text(&self) -> String {
        let n = self.a.len();
        let entry = |i: usize, k: usize, sign: i64, part: usize| match i + 1 < n {
            true => format!("'{}'", i64::from(i + 1 == k && part == 0)),
            false => format!("'-({})*({} + ({})*K)/{}'", sign, self.a[k][part], self.b[k][part], self.below),
        };
        let row = |r: usize| {
            let (i, p) = (r / 2, r % 2);
            let cells: Vec<String> = (0..2 * n)
                .map(|c| match (p, c % 2) {
                    (0, 1) => entry(i, c / 2, -1, 1),
                    (1, 0) => entry(i, c / 2, 1, 1),
                    _ => entry(i, c / 2, 1, 0),
                })
                .collect();
            format!("[{}]", cells.join(", "))
        };
        let rows: Vec<String> = (0..2 * n).map(row).collect();
        format!("{}matrix = [{}]\n", self.head(), rows.join(", "))
    }

    pub fn at(&self, k: &Rational) -> Vec<Complex> {
        let value = |a: i64, b: i64| &ratio(a, self.below) + &(&ratio(b, self.below) * k);
        let pair = |(a, b): (&[i64; 2], &[i64; 2])| [value(a[0], b[0]), value(a[1], b[1])];
        self.a.iter().zip(&self.b).map(pair).chain([[Rational::ONE, Rational::ZERO]]).collect()
    }

    pub fn is_stable_at(&self, k: &Rational) -> bool {
        let polynomial = self.at(k);
        if self.is_discrete { is_schur(&polynomial) } else { is_hurwitz(&polynomial) }
    }
}
