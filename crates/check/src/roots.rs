//! Where the roots of one polynomial with integer coefficients lie, exactly.

use super::clock::Clock;
use super::number::Z;
use super::univariate::Uni;
use num_bigint::Sign;
use num_traits::{One, Signed, Zero};

/// Roots by place, with multiplicity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct Places {
    pub inside: usize,
    pub on: usize,
    pub outside: usize,
}

impl Places {
    /// Of the polynomial that was doubled.
    pub fn halved(self) -> Result<Self, String> {
        let Places { inside, on, outside } = self;
        match [inside, on, outside].iter().all(|n| n % 2 == 0) {
            true => Ok(Places { inside: inside / 2, on: on / 2, outside: outside / 2 }),
            false => Err("internal: a doubled polynomial has an odd number of roots".into()),
        }
    }
}

/// Whether all roots lie strictly inside the unit circle, by the Schur-Cohn reduction
/// `D <- (d_n D - d_0 D#)/z`: the roots are inside if and only if `|d_0| < |d_n|` and those of the
/// reduced polynomial are \[Jury1964\]. Constants that are not zero have no roots.
pub(super) fn is_schur(d: &Uni, clock: &Clock) -> Result<bool, String> {
    let mut d = d.primitive(clock)?;
    if d.is_zero() {
        return Ok(false);
    }
    while d.degree() > 0 {
        let bits = d.longest();
        clock.hold(d.0.len(), 2 * bits)?;
        clock.spend(2 * d.0.len(), bits, bits)?;
        let (first, last) = (d.at(0), d.leading());
        if first.abs() >= last.abs() {
            return Ok(false);
        }
        let n = d.degree();
        d = Uni::new((1..=n).map(|k| &last * &d.0[k] - &first * &d.0[n - k]).collect()).primitive(clock)?;
        if d.degree() != n - 1 {
            return Err("internal: the reduced polynomial has the wrong degree".into());
        }
    }
    Ok(true)
}

/// Whether all roots have negative real parts, by Routh's reduction: with `a_n, a_(n-1)` of one sign,
/// `D <- D - (a_n/a_(n-1)) s (a_(n-1) s^(n-1) + a_(n-3) s^(n-3) + ...)` has one root less, and the
/// rest on the same sides \[Routh1877\].
pub(super) fn is_hurwitz(d: &Uni, clock: &Clock) -> Result<bool, String> {
    let mut d = d.primitive(clock)?;
    if d.is_zero() {
        return Ok(false);
    }
    while d.degree() > 0 {
        let bits = d.longest();
        clock.hold(d.0.len(), 2 * bits)?;
        clock.spend(2 * d.0.len(), bits, bits)?;
        let n = d.degree();
        let (last, next) = (d.leading(), d.at(n - 1));
        if next.is_zero() || last.sign() != next.sign() {
            return Ok(false);
        }
        let size = next.abs();
        let last = if next.is_negative() { -last } else { last };
        let mut reduced: Vec<Z> = d.0.iter().map(|c| c * &size).collect();
        for k in (0..n).rev().step_by(2) {
            reduced[k + 1] -= &last * &d.0[k];
        }
        d = Uni::new(reduced).primitive(clock)?;
        if d.degree() != n - 1 {
            return Err("internal: the reduced polynomial has the wrong degree".into());
        }
    }
    Ok(true)
}

/// The exact numbers of roots inside, on and outside the unit circle of a polynomial that is not zero.
///
/// Roots at `-1` are divided out; then `z = (1 + s)/(1 - s)` maps the disc to the left half plane, the
/// circle to the imaginary axis, and no root to infinity.
pub(super) fn places_by_circle(d: &Uni, clock: &Clock) -> Result<Places, String> {
    let mut d = d.clone();
    let mut on = 0;
    let plus = Uni(vec![Z::one(), Z::one()]);
    while let Some(quotient) = d.divided(&plus, clock)? {
        d = quotient;
        on += 1;
    }
    let n = d.degree();
    let minus = Uni(vec![Z::one(), -Z::one()]);
    // Horner's scheme for sum d_k (1 + s)^k (1 - s)^(n-k).
    let mut image = Uni::default();
    let mut weight = Uni::constant(Z::one());
    for c in d.0.iter().rev() {
        clock.spend(4 * (1 + image.0.len()), image.longest(), 1)?;
        clock.spend(1 + weight.0.len(), weight.longest(), c.bits())?;
        image = image.times(&plus).plus(&weight.scaled(c));
        weight = weight.times(&minus);
    }
    if image.degree() != n {
        return Err("internal: a root went to infinity".into());
    }
    let mut places = places_by_axis(&image, clock)?;
    places.on += on;
    Ok(places)
}

/// The exact numbers of roots left of, on and right of the imaginary axis of a polynomial that is not zero.
///
/// The greatest common divisor `h` of `p(s)` and `p(-s)` holds the roots that are mirror images of each
/// other. `h = s^m e(s^2)`; each negative root of `e` is a pair on the axis, all other roots of `h` split
/// evenly. The rest, without roots on the axis, is counted by its Cauchy index [Gantmacher1959, XV].
pub(super) fn places_by_axis(p: &Uni, clock: &Clock) -> Result<Places, String> {
    let mirror = Uni(p.0.iter().enumerate().map(|(k, c)| if k % 2 == 1 { -c } else { c.clone() }).collect());
    let h = p.gcd(&mirror, clock)?;
    let rest = p.divided(&h, clock)?.ok_or("internal: a gcd does not divide")?;
    let m = h.0.iter().take_while(|c| c.is_zero()).count();
    let even = Uni::new(h.0.iter().skip(m).step_by(2).cloned().collect());
    if h.0.iter().skip(m + 1).step_by(2).any(|c| !c.is_zero()) {
        return Err("internal: a mirror-symmetric polynomial is not".into());
    }
    let pairs_on = negative_roots(&even, clock)?;
    let mut places = Places { inside: 0, on: m + 2 * pairs_on, outside: 0 };
    let beside = h.degree() - places.on;
    let n = rest.degree();
    let difference = cauchy_difference(&rest, clock)?;
    let inside = n as i64 + difference;
    if beside % 2 == 1 || inside < 0 || inside % 2 == 1 || inside / 2 > n as i64 {
        return Err("internal: root counts do not add up".into());
    }
    places.inside = beside / 2 + inside as usize / 2;
    places.outside = p.degree() - places.on - places.inside;
    Ok(places)
}

/// The number of negative roots, with multiplicity.
fn negative_roots(f: &Uni, clock: &Clock) -> Result<usize, String> {
    let mut f = f.clone();
    let mut count = 0;
    // Roots of multiplicity m are in f and in the next m - 1 greatest common divisors with the derivative.
    while f.degree() > 0 {
        let derivative = f.derivative();
        let chain = sturm_chain(&f, &derivative, clock)?;
        let at_minus_infinity = variations(chain.iter().map(sign_at_minus_infinity));
        let at_zero = variations(chain.iter().map(|g| g.at(0).sign()));
        // f(0) != 0 here, so Sturm's theorem holds on (-infinity, 0).
        count += at_minus_infinity - at_zero;
        f = f.gcd(&derivative, clock)?;
    }
    Ok(count)
}

/// The number of positive roots of a square-free polynomial that is not zero at 0.
pub(super) fn count_of_positive_roots(f: &Uni, clock: &Clock) -> Result<usize, String> {
    if f.degree() == 0 {
        return Ok(0);
    }
    let chain = sturm_chain(f, &f.derivative(), clock)?;
    let at_zero = variations(chain.iter().map(|g| g.at(0).sign()));
    Ok(at_zero - variations(chain.iter().map(|g| g.leading().sign())))
}

/// Roots left minus roots right of the axis, for a polynomial without mirror images of roots:
/// the Cauchy index of `(b_0 w^(n-1) - b_1 w^(n-3) + ...)/(a_0 w^n - a_1 w^(n-2) + ...)` with
/// `p = a_0 s^n + b_0 s^(n-1) + a_1 s^(n-2) + ...`, by Sturm's chain over the whole line.
fn cauchy_difference(p: &Uni, clock: &Clock) -> Result<i64, String> {
    let n = p.degree();
    let part = |first: usize| {
        let mut out = vec![Z::zero(); n + 1];
        for (step, k) in (0..=n - first).rev().step_by(2).enumerate() {
            out[k] = if step % 2 == 1 { -p.at(k) } else { p.at(k) };
        }
        Uni::new(out)
    };
    if n == 0 {
        return Ok(0);
    }
    let chain = sturm_chain(&part(0), &part(1), clock)?;
    let left = variations(chain.iter().map(sign_at_minus_infinity));
    let right = variations(chain.iter().map(|g| g.leading().sign()));
    Ok(left as i64 - right as i64)
}

fn sign_at_minus_infinity(g: &Uni) -> Sign {
    let sign = g.leading().sign();
    if g.degree() % 2 == 1 { -sign } else { sign }
}

/// `f, g`, then minus the remainder each time.
fn sturm_chain(f: &Uni, g: &Uni, clock: &Clock) -> Result<Vec<Uni>, String> {
    let mut chain = vec![f.primitive(clock)?, g.primitive(clock)?];
    while let [.., a, b] = chain.as_slice() {
        if b.is_zero() {
            chain.pop();
            break;
        }
        let next = a.pseudo_remainder(b, clock)?.primitive(clock)?.scaled(&-Z::one());
        chain.push(next);
    }
    Ok(chain)
}

fn variations(signs: impl Iterator<Item = Sign>) -> usize {
    let mut last = Sign::NoSign;
    let mut count = 0;
    for sign in signs.filter(|s| *s != Sign::NoSign) {
        count += usize::from(last != Sign::NoSign && last != sign);
        last = sign;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    /// Factors with the places of their roots: by the circle, and by the axis.
    fn factors() -> Vec<(Uni, Places, Places)> {
        let at = |inside, on, outside| Places { inside, on, outside };
        vec![
            (uni(&[0, 1]), at(1, 0, 0), at(0, 1, 0)),
            (uni(&[-1, 1]), at(0, 1, 0), at(0, 0, 1)),
            (uni(&[1, 1]), at(0, 1, 0), at(1, 0, 0)),
            (uni(&[-1, 2]), at(1, 0, 0), at(0, 0, 1)),
            (uni(&[2, 1]), at(0, 0, 1), at(1, 0, 0)),
            (uni(&[-2, 1]), at(0, 0, 1), at(0, 0, 1)),
            (uni(&[1, 0, 1]), at(0, 2, 0), at(0, 2, 0)),
            (uni(&[5, -6, 5]), at(0, 2, 0), at(0, 0, 2)),
            (uni(&[2, 2, 1]), at(0, 0, 2), at(2, 0, 0)),
            (uni(&[1, 2, 2]), at(2, 0, 0), at(2, 0, 0)),
            (uni(&[1, -1, 3]), at(2, 0, 0), at(0, 0, 2)),
            (uni(&[4, 0, 1]), at(0, 0, 2), at(0, 2, 0)),
        ]
    }

    #[test]
    fn all_products_of_three_are_counted() {
        let clock = Clock::new(Duration::MAX);
        let f = factors();
        let add = |x: Places, y: Places| Places {
            inside: x.inside + y.inside,
            on: x.on + y.on,
            outside: x.outside + y.outside,
        };
        for (i, a) in f.iter().enumerate() {
            for (j, b) in f.iter().enumerate().skip(i) {
                for c in f.iter().skip(j) {
                    let p = a.0.times(&b.0).times(&c.0).scaled(&Z::from(-3));
                    let (circle, axis) = (add(add(a.1, b.1), c.1), add(add(a.2, b.2), c.2));
                    assert_eq!(places_by_circle(&p, &clock).unwrap(), circle, "{p:?}");
                    assert_eq!(places_by_axis(&p, &clock).unwrap(), axis, "{p:?}");
                    assert_eq!(is_schur(&p, &clock).unwrap(), circle.inside == p.degree(), "{p:?}");
                    assert_eq!(is_hurwitz(&p, &clock).unwrap(), axis.inside == p.degree(), "{p:?}");
                }
            }
        }
        assert_eq!(places_by_circle(&uni(&[7]), &clock).unwrap(), Places::default());
        assert!(!is_schur(&uni(&[]), &clock).unwrap() && is_schur(&uni(&[-2]), &clock).unwrap());
    }
}
