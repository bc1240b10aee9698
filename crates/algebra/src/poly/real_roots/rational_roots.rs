//! Rational roots, exactly: roots modulo a small prime, lifted until only one fraction fits.

use super::all_values::AllResidues;
use super::bounds::root_bound_bits;
use super::linear_factors::without_linear_factors;
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
    let coeffs = p.poly().coeffs();
    let at_zero = coeffs.first().is_some_and(Integer::is_zero);
    if !at_zero && (coeffs.len() < 2 || (coeffs.len() > 2 && has_no_rational_root(p.poly()))) {
        return (Vec::new(), p.clone());
    }
    let mut roots = Vec::new();
    let mut rest = UniPoly::new(coeffs[usize::from(at_zero)..].to_vec());
    roots.extend(at_zero.then_some(Rational::ZERO));
    if rest.coeffs().len() > 2 && !(at_zero && has_no_rational_root(&rest)) {
        let (prime, candidates) = choose_prime(&rest);
        let (small, mut others) = small_roots(&rest, prime, candidates);
        if !small.is_empty() {
            let numbers: Vec<Rational> = small.iter().map(|(x, _)| x.clone()).collect();
            let (quotient, is_root) = without_linear_factors(&rest, &numbers);
            rest = quotient;
            for ((x, candidate), is_root) in small.into_iter().zip(is_root) {
                // A residue may have misled.
                if is_root { roots.push(x) } else { others.push(candidate) }
            }
        }
        if !others.is_empty() && rest.coeffs().len() > 2 {
            let mut lift = Lift::new(rest.clone(), prime);
            for candidate in others {
                if rest.coeffs().len() <= 2 {
                    break;
                }
                if let Some((root, quotient)) = lift.rational_root(candidate.residue, &rest) {
                    roots.push(root);
                    rest = quotient;
                }
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

/// A simple root modulo a prime, and the value of the derivative there.
#[derive(Clone, Copy)]
struct Candidate {
    residue: u64,
    slope: u64,
}

/// Of the simple roots modulo a small prime those that lift to a rational number which is small
/// (determined modulo the square of the prime) and very likely a root, as it is one modulo a larger
/// prime; and the others.
fn small_roots(p: &UniPoly, prime: u64, candidates: Vec<Candidate>) -> (Vec<(Rational, Candidate)>, Vec<Candidate>) {
    if candidates.is_empty() || prime >= 1 << 15 {
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
    let inverse_big = power(lead.mod_u64(big), big - 2, big);
    let (mut roots, mut others) = (Vec::new(), Vec::new());
    for candidate in candidates {
        // p(r) = 0 and p'(r) != 0 modulo the prime: one step of Newton's.
        let r = candidate.residue;
        let value = value_modulo(&at_lift, r, modulus);
        let inverse = power(candidate.slope, prime - 2, prime);
        let x = (r + modulus - value * inverse % modulus) % modulus;
        let y = x * lead_lift % modulus;
        let y = if 2 * y > modulus { y as i64 - modulus as i64 } else { y as i64 };
        let x = (y.rem_euclid(big as i64) as u64) * inverse_big % big;
        if value_modulo(&at_big, x, big) == 0 {
            roots.push((Rational::new(Integer::from(y), lead.clone()), candidate));
        } else {
            others.push(candidate);
        }
    }
    (roots, others)
}

/// The primitive linear polynomial with a given root.
pub(crate) fn linear(root: &Rational) -> UniPoly {
    UniPoly::new(vec![-root.numerator(), root.denominator()])
}

/// A prime not dividing the leading coefficient modulo which all roots are simple, and those
/// roots: the best of a few.
fn choose_prime(p: &UniPoly) -> (u64, Vec<Candidate>) {
    let mut best: Option<(u64, Vec<Candidate>)> = None;
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
        let Some(roots) = simple_roots(&f, prime) else { continue };
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

/// The roots modulo a prime, given the residues of the coefficients; `None` if one is not simple.
fn simple_roots(f: &[u64], prime: u64) -> Option<Vec<Candidate>> {
    let slopes = || f.iter().zip(0..).skip(1).map(|(c, k)| c * (k % prime) % prime).collect::<Vec<u64>>();
    let candidates: Vec<Candidate> = match AllResidues::new(prime) {
        Some(all) => {
            let values = all.values(f);
            if values.iter().all(|&value| value != 0) {
                return Some(Vec::new());
            }
            let pairs = all.residues().zip(all.values(&slopes())).zip(values).filter(|(_, value)| *value == 0);
            pairs.map(|((residue, slope), _)| Candidate { residue, slope: slope.into() }).collect()
        }
        None => {
            let slopes = slopes();
            let is_root = |x: &u64| {
                checkpoint(f.len() as u64 / 4 + 1);
                value_modulo(f, *x, prime) == 0
            };
            let slope = |x: u64| Candidate { residue: x, slope: value_modulo(&slopes, x, prime) };
            (0..prime).filter(is_root).map(slope).collect()
        }
    };
    candidates.iter().all(|c| c.slope != 0).then_some(candidates)
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
    /// Its derivative modulo the prime.
    derivative: Vec<u64>,
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
        let derivative = residues(&original.derivative(), prime);
        Lift { enough: &lead << (bound + 1), original, derivative, prime, levels: Vec::new() }
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

    /// The rational root of `rest`, if there is one, that is the residue modulo the prime.
    fn rational_root(&mut self, residue: u64, rest: &UniPoly) -> Option<(Rational, UniPoly)> {
        let lead = self.original.leading().expect("not zero").clone();
        let (enough, prime) = (self.enough.clone(), self.prime);
        let slope = self.derivative.iter().rev().fold(0, |acc, c| (acc * residue + c) % prime);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The long ones are lifted when the short ones have been divided out.
    #[test]
    fn short_and_long_roots_together() {
        let long = Integer::from(10).pow(15);
        let mut roots = vec![
            Rational::from(-3),
            Rational::ZERO,
            Rational::new(2.into(), 7.into()),
            Rational::from(&long + &Integer::ONE),
            Rational::new(long, 7.into()),
            Rational::new(Integer::ONE, Integer::from(10).pow(25)),
        ];
        roots.sort();
        let irrational = UniPoly::from_i64(&[-2, 0, 1]);
        let p = roots.iter().fold(irrational.clone(), |p, x| &p * &linear(x));
        let p = SquareFree::new(p).expect("the roots are simple");
        assert_eq!(rational_roots(&p, &Budget::unlimited()).unwrap(), (roots, SquareFree::known(irrational)));
    }
}
