//! Rational roots, exactly: roots modulo a small prime, lifted until only one fraction fits.

use super::bounds::root_bound_bits;
use super::small_residues::{has_no_rational_root, power, residues};
use super::square_free::SquareFree;
use crate::limits::{Budget, Exhausted, checkpoint};
use crate::number::{Integer, Rational};
use crate::poly::UniPoly;

/// How many primes may be looked at in the hope of one with fewer roots; each costs one pass over
/// the coefficients.
const PRIMES_TRIED: usize = 8;

/// The greatest prime below 2^30: products of residues and sums of nine fit `u64`.
const LARGE_PRIME: u64 = 1_073_741_789;

/// So many coefficients are multiplied by powers before a sum is reduced.
const CHUNK: usize = 8;

/// Products of so few linear factors are made one factor after the other.
const FEW_FACTORS: usize = 8;

/// All rational roots, ascending, and the polynomial without their linear factors.
///
/// A rational root is a root modulo every prime that does not divide the leading coefficient `c`;
/// lifted by Newton's iteration (Hensel) to a modulus above `2 |c| B`, with `B` a bound of the
/// roots, it determines the integer `c` times the root. Every candidate is verified by division
/// [Loos1983](crate::bibliography#loos1983).
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn rational_roots(p: &SquareFree, budget: &Budget) -> Result<(Vec<Rational>, SquareFree), Exhausted> {
    budget.enter(|| without_rational_roots(p))
}

/// The same within the budget that holds on the thread.
pub(super) fn without_rational_roots(p: &SquareFree) -> (Vec<Rational>, SquareFree) {
    let mut roots = Vec::new();
    let mut rest = p.poly().clone();
    if rest.coeffs().first().is_some_and(Integer::is_zero) {
        roots.push(Rational::ZERO);
        rest = UniPoly::new(rest.into_coeffs().split_off(1));
    }
    if rest.coeffs().len() > 2 && !has_no_rational_root(&rest) {
        let (prime, residues) = choose_prime(&rest);
        let (small, residues) = small_roots(&rest, prime, residues);
        let product = product_of_linear(&small);
        let residues = match rest.div_exact_poly(&product) {
            Some(quotient) => {
                rest = quotient;
                roots.extend(small);
                residues
            }
            // A residue has misled: one by one.
            None => choose_prime(&rest).1,
        };
        let mut lift = Lift::new(rest.clone(), prime);
        for r in residues {
            if rest.coeffs().len() <= 2 {
                break;
            }
            if let Some((root, quotient)) = lift.rational_root(r, &rest) {
                roots.push(root);
                rest = quotient;
            }
        }
    }
    if let [c0, c1] = rest.coeffs() {
        roots.push(Rational::new(-c0, c1.clone()));
        rest = UniPoly::from_i64(&[1]);
    }
    roots.sort();
    (roots, SquareFree::known(rest))
}

/// Of the simple roots modulo a small prime those that lift to a rational number which is small
/// (determined modulo the square of the prime) and very likely a root, as it is one modulo a larger
/// prime; and the other residues.
fn small_roots(p: &UniPoly, prime: u64, candidates: Vec<u64>) -> (Vec<Rational>, Vec<u64>) {
    if prime >= 1 << 15 {
        // Products of residues would not fit.
        return (Vec::new(), candidates);
    }
    let modulus = prime * prime;
    let big = LARGE_PRIME;
    let lead = p.leading().expect("not zero");
    let (at_lift, at_big) = (residues(p, modulus), residues(p, big));
    if at_big.len() < p.coeffs().len() {
        return (Vec::new(), candidates);
    }
    let lead_lift = lead.mod_u64(modulus);
    let slopes = residues(&p.derivative(), prime);
    let inverse_big = power(lead.mod_u64(big), big - 2, big);
    let (mut roots, mut others) = (Vec::new(), Vec::new());
    for r in candidates {
        // p(r) = 0 and p'(r) != 0 modulo the prime: one step of Newton's.
        let value = value_modulo(&at_lift, r, modulus);
        let inverse = power(value_modulo(&slopes, r, prime), prime - 2, prime);
        let x = (r + modulus - value * inverse % modulus) % modulus;
        let y = x * lead_lift % modulus;
        let y = if 2 * y > modulus { y as i64 - modulus as i64 } else { y as i64 };
        let x = (y.rem_euclid(big as i64) as u64) * inverse_big % big;
        if value_modulo(&at_big, x, big) == 0 {
            roots.push(Rational::new(Integer::from(y), lead.clone()));
        } else {
            others.push(r);
        }
    }
    (roots, others)
}

/// The product of the linear polynomials with given roots, halves first.
fn product_of_linear(roots: &[Rational]) -> UniPoly {
    match roots {
        few if few.len() <= FEW_FACTORS => {
            let mut product = vec![Integer::ONE];
            for x in few {
                let (n, d) = (x.numerator(), x.denominator());
                product.push(Integer::ZERO);
                for k in (0..product.len()).rev() {
                    let below = if k > 0 { &product[k - 1] * &d } else { Integer::ZERO };
                    product[k] = below - &product[k] * &n;
                }
            }
            UniPoly::new(product)
        }
        _ => {
            let (a, b) = roots.split_at(roots.len() / 2);
            &product_of_linear(a) * &product_of_linear(b)
        }
    }
}

/// The primitive linear polynomial with a given root.
pub(crate) fn linear(root: &Rational) -> UniPoly {
    UniPoly::new(vec![-root.numerator(), root.denominator()])
}

/// A prime not dividing the leading coefficient modulo which all roots are simple, and those
/// roots: the best of a few.
fn choose_prime(p: &UniPoly) -> (u64, Vec<u64>) {
    let derivative = p.derivative();
    let mut best: Option<(u64, Vec<u64>)> = None;
    let mut good = 0;
    let mut prime = (p.coeffs().len() as u64).max(40);
    // A square-free polynomial has simple roots modulo all primes but the divisors of its
    // discriminant, so that the search ends.
    loop {
        prime = next_prime(prime);
        let f = residues(p, prime);
        if f.len() < p.coeffs().len() {
            continue;
        }
        let value = |f: &[u64], x: u64| value_modulo(f, x, prime);
        let is_root = |x: &u64| {
            checkpoint(f.len() as u64 / 4 + 1);
            value(&f, *x) == 0
        };
        let roots: Vec<u64> = (0..prime).filter(is_root).collect();
        let df = residues(&derivative, prime);
        if roots.iter().any(|&x| value(&df, x) == 0) {
            continue;
        }
        good += 1;
        if best.as_ref().is_none_or(|(_, b)| roots.len() < b.len()) {
            best = Some((prime, roots));
        }
        if let Some(found) = best.take_if(|(_, roots)| {
            // Many roots modulo a prime are most likely rational ones.
            roots.is_empty() || good == PRIMES_TRIED || 2 * roots.len() >= p.coeffs().len()
        }) {
            return found;
        }
    }
}

/// The value modulo a number below 2^30.
fn value_modulo(f: &[u64], x: u64, modulus: u64) -> u64 {
    let mut powers = [1; CHUNK];
    for k in 1..CHUNK {
        powers[k] = powers[k - 1] * x % modulus;
    }
    let whole = powers[CHUNK - 1] * x % modulus;
    let sum = |c: &[u64]| c.iter().zip(&powers).map(|(c, power)| c * power).sum::<u64>();
    let (chunks, top) = f.as_chunks::<CHUNK>();
    chunks.iter().rev().fold(sum(top) % modulus, |acc, c| (acc * whole + sum(c)) % modulus)
}

/// The least prime above `n`, which is small.
fn next_prime(mut n: u64) -> u64 {
    loop {
        n += 1;
        if n > 2 && n % 2 == 1 && (3..).step_by(2).take_while(|d| d * d <= n).all(|d| !n.is_multiple_of(d)) {
            return n;
        }
    }
}

/// The state of the lifting: the polynomial modulo the prime squared again and again.
struct Lift {
    original: UniPoly,
    prime: u64,
    /// Above `2 |c| B`.
    enough: Integer,
    levels: Vec<Level>,
}

struct Level {
    modulus: Integer,
    coeffs: Vec<Integer>,
}

impl Lift {
    fn new(original: UniPoly, prime: u64) -> Lift {
        let lead = original.leading().expect("not zero").abs();
        let bound = root_bound_bits(&original).max(0).unsigned_abs();
        Lift { enough: &lead << (bound + 1), original, prime, levels: Vec::new() }
    }

    fn level(&mut self, k: usize) -> &Level {
        while self.levels.len() <= k {
            let modulus = match self.levels.last() {
                Some(last) => &last.modulus * &last.modulus,
                None => Integer::from(self.prime) * Integer::from(self.prime),
            };
            let coeffs = self.original.coeffs().iter().map(|c| reduce(c, &modulus)).collect();
            self.levels.push(Level { modulus, coeffs });
        }
        &self.levels[k]
    }

    /// The rational root of `rest`, if there is one, that is `residue` modulo the prime.
    fn rational_root(&mut self, residue: u64, rest: &UniPoly) -> Option<(Rational, UniPoly)> {
        let lead = self.original.leading().expect("not zero").clone();
        let (enough, prime) = (self.enough.clone(), self.prime);
        let slope = self
            .original
            .derivative()
            .coeffs()
            .iter()
            .rev()
            .fold(0, |acc, c| (acc * residue + c.mod_u64(prime)) % prime);
        let mut x = Integer::from(residue);
        // The inverse of the derivative at the previous x; right for the present one modulo the
        // modulus before the last, so that one step of Newton's makes it good enough.
        let mut inverse = Integer::from(power(slope, prime - 2, prime));
        for k in 0.. {
            let level = self.level(k);
            let m = &level.modulus;
            let (value, slope) = value_and_slope(&level.coeffs, &x, m);
            inverse = reduce(&(&inverse * &(Integer::from(2) - &slope * &inverse)), m);
            x = reduce(&(&x - &(&value * &inverse)), m);
            let done = *m > enough;
            // Small roots show early: what is found is verified, so that an early try is safe.
            let mut y = reduce(&(&lead * &x), m);
            if &(&y << 1) > m {
                y -= m;
            }
            let root = Rational::new(y, lead.clone());
            if let Some(quotient) = divide_out(rest, &root) {
                return Some((root, quotient));
            }
            if done {
                return None;
            }
        }
        None
    }
}

fn reduce(a: &Integer, m: &Integer) -> Integer {
    a.div_mod_floor(m).1
}

/// The value and the derivative of a polynomial at `x`, modulo `m`.
fn value_and_slope(coeffs: &[Integer], x: &Integer, m: &Integer) -> (Integer, Integer) {
    let mut value = Integer::ZERO;
    let mut slope = Integer::ZERO;
    for c in coeffs.iter().rev() {
        checkpoint(32);
        slope = reduce(&(&(&slope * x) + &value), m);
        value = reduce(&(&(&value * x) + c), m);
    }
    (value, slope)
}

/// The quotient by the linear factor of `root`, if it is a root.
fn divide_out(p: &UniPoly, root: &Rational) -> Option<UniPoly> {
    let (constant, lead) = (p.coeffs().first()?, p.leading()?);
    let plausible = lead.divisible_by(&root.denominator()) && constant.divisible_by(&root.numerator());
    if plausible { p.div_exact_poly(&linear(root)) } else { None }
}
