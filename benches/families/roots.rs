//! Families of polynomials for real root isolation, those of `pari/roots.gp`.

use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, UniPoly};

fn x() -> UniPoly {
    UniPoly::x()
}

/// `a x + b` for `[b, a]`.
fn linear(b: i64, a: i64) -> UniPoly {
    UniPoly::from_i64(&[b, a])
}

/// `f_0 = 1`, `f_1`, and so on by a recurrence that gives `f_{k+1}` from `k`, `f_k`, `f_{k-1}`.
fn recurrence(first: UniPoly, n: i64, next: impl Fn(i64, &UniPoly, &UniPoly) -> UniPoly) -> UniPoly {
    let (mut before, mut now) = (UniPoly::one(), first);
    for k in 1..n {
        let after = next(k, &now, &before);
        before = std::mem::replace(&mut now, after);
    }
    now
}

pub fn chebyshev(n: i64) -> UniPoly {
    recurrence(x(), n, |_, now, before| &(&linear(0, 2) * now) - before)
}

pub fn hermite(n: i64) -> UniPoly {
    recurrence(linear(0, 2), n, |k, now, before| &(&linear(0, 2) * now) - &before.scaled(&Integer::from(2 * k)))
}

/// `n!` times the Laguerre polynomial.
pub fn laguerre(n: i64) -> UniPoly {
    recurrence(linear(1, -1), n, |k, now, before| {
        &(&linear(2 * k + 1, -1) * now) - &before.scaled(&Integer::from(k * k))
    })
}

/// `n!` times the Legendre polynomial: a multiple of PARI's, made primitive like it.
pub fn legendre(n: i64) -> UniPoly {
    recurrence(x(), n, |k, now, before| &(&linear(0, 2 * k + 1) * now) - &before.scaled(&Integer::from(k * k)))
        .primitive_part()
}

pub fn wilkinson(n: i64) -> UniPoly {
    (1..=n).fold(UniPoly::one(), |p, i| &p * &linear(-i, 1))
}

pub fn mignotte(n: usize, a: i64) -> UniPoly {
    let square = &linear(-1, a) * &linear(-1, a);
    &UniPoly::monomial(Integer::ONE, n) - &square.scaled(&Integer::from(2))
}

/// `sum n! / i! x^i`.
pub fn exponential(n: i64) -> UniPoly {
    let mut coeffs = vec![Integer::ONE];
    for i in (1..=n).rev() {
        let next = coeffs.last().expect("not empty") * &Integer::from(i);
        coeffs.push(next);
    }
    coeffs.reverse();
    UniPoly::new(coeffs)
}

/// A line of integers from the constant term up.
fn parsed(line: &str) -> UniPoly {
    UniPoly::new(line.split_whitespace().map(|c| Integer::from_decimal(c).expect("an integer")).collect())
}

/// All of them by name, in the order of the tables.
pub fn all() -> Vec<(&'static str, UniPoly)> {
    let random = include_str!("../data/random.txt");
    let mut random = random.lines().map(parsed);
    let mut next_random = || random.next().expect("three polynomials");
    vec![
        ("chebyshev 50", chebyshev(50)),
        ("chebyshev 200", chebyshev(200)),
        ("chebyshev 400", chebyshev(400)),
        ("wilkinson 50", wilkinson(50)),
        ("wilkinson 200", wilkinson(200)),
        ("wilkinson 200 + 1", &wilkinson(200) + &UniPoly::one()),
        ("laguerre 100", laguerre(100)),
        ("laguerre 300", laguerre(300)),
        ("hermite 200", hermite(200)),
        ("legendre 100", legendre(100)),
        ("mignotte 50", mignotte(50, 1 << 20)),
        ("mignotte 200", mignotte(200, 1 << 20)),
        ("mignotte' 40", mignotte(40, 1_000_003)),
        ("mignotte' 60", mignotte(60, 1_000_003)),
        ("mignotte' 200", mignotte(200, 1_000_003)),
        ("random 100 bit 100", next_random()),
        ("random 100 bit 500", next_random()),
        ("random 1000 bit 200", next_random()),
        ("exp series 200", exponential(200)),
    ]
}
