//! Resultants with respect to `y` of polynomials in two parameters: which factors they have.

use super::bounds::Frame;
use super::residues::Modulus;
use crate::characteristic::primitive;
use crate::clock::Clock;
use crate::number::Z;
use crate::univariate::Uni;
use num_traits::{One, Signed, Zero};

/// Resultants of a higher degree are refused.
const MAX_DEGREE: usize = 20_000;

/// Resultants of longer coefficients are refused.
const MAX_BITS: u64 = 1 << 22;

/// A resultant that is zero modulo so many numbers of 60 bits counts as zero: nothing is proved by it.
const ZEROS: usize = 3;

/// Whether the resultant of two polynomials in `y`, coefficients from the constant term up, which are polynomials in `x`, is a product of
/// powers of the factors and of a number other than zero. Neither polynomial is constant in `y`; no factor is constant, and each is primitive.
///
/// How often each factor divides is looked up modulo one number. Then the resultant `R` and the product `W` are compared by their values:
/// modulo one number at as many integers as `R` has coefficients, where no leading coefficient vanishes. So `R = c W` modulo
/// the product of all moduli, with `c` known by its residues, and in integers where that product is above the sum of what `R` and `c W` can be.
pub(super) fn is_product(f: &[Uni], g: &[Uni], factors: &[Uni], clock: &Clock) -> Result<bool, String> {
    let pair = Pair { f: primitive(f.to_vec(), clock)?, g: primitive(g.to_vec(), clock)? };
    count_frame(&pair, clock)?;
    let Some(frame) = Frame::of(&pair.f, &pair.g, clock)? else { return Ok(false) };
    if frame.lowest + frame.count > MAX_DEGREE {
        return Err("a resultant has too high a degree".into());
    }
    if frame.bits > MAX_BITS {
        return Err("a resultant is too long".into());
    }
    let mut moduli = Moduli { next: 1 << 60 };
    let Some(powers) = powers_of(&pair, factors, &frame, &mut moduli, clock)? else { return Ok(false) };
    let product = Product::of(factors, powers);
    // Of both a multiple of the same power of `x`, and of no higher degree, there are as many coefficients as values.
    if product.order(factors) < frame.lowest || product.degree(factors) >= frame.lowest + frame.count {
        return Ok(false);
    }
    let largest = Z::one() << frame.bits;
    let mut quotient = Residues::default();
    loop {
        let modulus = moduli.following()?;
        let Some(image) = Image::of(&pair, factors, &modulus) else { continue };
        let residue = match image.ratio(&product, &frame, clock)? {
            Ratio::Unknown => continue,
            Ratio::None => return Ok(false),
            Ratio::Known(residue) => residue,
        };
        let Some(inverse) = modulus.inverse(modulus.of(&frame.divisor)) else { continue };
        quotient.add(&modulus, modulus.times(residue, inverse));
        if quotient.product > &largest + &largest {
            let c = quotient.number().abs();
            // The product is primitive, so that c is an integer no greater than a coefficient of R over its divisor.
            if c > largest {
                return Ok(false);
            }
            if quotient.product > &largest + &c * &product.norm {
                return Ok(!c.is_zero());
            }
        }
    }
}

/// Moduli, descending.
struct Moduli {
    next: u64,
}

impl Moduli {
    fn following(&mut self) -> Result<Modulus, String> {
        let modulus = Modulus::below(self.next).ok_or("a resultant is too long")?;
        self.next = modulus.value;
        Ok(modulus)
    }
}

/// How often each factor divides the resultant, looked up modulo one number; `None` where they do not make it up, or where it counts as zero.
fn powers_of(
    pair: &Pair,
    factors: &[Uni],
    frame: &Frame,
    moduli: &mut Moduli,
    clock: &Clock,
) -> Result<Option<Vec<usize>>, String> {
    let mut zeros = 0;
    while zeros < ZEROS {
        let modulus = moduli.following()?;
        let Some(image) = Image::of(pair, factors, &modulus) else { continue };
        match image.coefficients(frame, clock)? {
            Some(residues) if residues.is_empty() => zeros += 1,
            Some(residues) => return image.powers(residues, clock),
            None => {}
        }
    }
    Ok(None)
}

/// The work of the bounds of a resultant: rows times columns, and a square for each entry.
fn count_frame(pair: &Pair, clock: &Clock) -> Result<(), String> {
    let bits = [&pair.f, &pair.g].map(|p| p.iter().map(Uni::longest).max().unwrap_or(0));
    clock.spend(8 * pair.f.len() * pair.g.len(), bits[0].max(bits[1]), bits[0].max(bits[1]))
}

/// Two polynomials in `y`.
struct Pair {
    f: Vec<Uni>,
    g: Vec<Uni>,
}

/// A product of powers of factors.
struct Product {
    powers: Vec<usize>,
    /// No coefficient of it is greater.
    norm: Z,
}

impl Product {
    fn of(factors: &[Uni], powers: Vec<usize>) -> Product {
        let norm = |p: &Uni| p.0.iter().map(Signed::abs).sum::<Z>();
        let norm = factors.iter().zip(&powers).map(|(f, power)| norm(f).pow(*power as u32)).product();
        Product { powers, norm }
    }

    fn sum(&self, factors: &[Uni], of_factor: impl Fn(&Uni) -> usize) -> usize {
        factors.iter().zip(&self.powers).map(|(f, power)| of_factor(f) * power).sum()
    }

    fn degree(&self, factors: &[Uni]) -> usize {
        self.sum(factors, Uni::degree)
    }

    /// The exponent of the lowest power of `x`.
    fn order(&self, factors: &[Uni]) -> usize {
        self.sum(factors, |f| f.0.iter().take_while(|c| c.is_zero()).count())
    }
}

/// What the values of a resultant and of a product say of their ratio.
enum Ratio {
    /// This modulus tells nothing.
    Unknown,
    /// There is none: one is not a multiple of the other.
    None,
    Known(u64),
}

/// A pair and factors modulo a number.
struct Image<'m> {
    m: &'m Modulus,
    f: Vec<Vec<u64>>,
    g: Vec<Vec<u64>>,
    factors: Vec<Vec<u64>>,
}

impl<'m> Image<'m> {
    /// `None` where a leading coefficient vanishes.
    fn of(pair: &Pair, factors: &[Uni], m: &'m Modulus) -> Option<Image<'m>> {
        let reduced = |p: &[Uni]| p.iter().map(|c| c.0.iter().map(|c| m.of(c)).collect()).collect::<Vec<Vec<u64>>>();
        let (f, g, factors) = (reduced(&pair.f), reduced(&pair.g), reduced(factors));
        let has_lead = |p: &Vec<Vec<u64>>| p.last().is_some_and(|lead| lead.iter().any(|c| *c != 0));
        let keeps_degree = |p: &Vec<u64>| p.last().is_some_and(|lead| *lead != 0);
        (has_lead(&f) && has_lead(&g) && factors.iter().all(keeps_degree)).then_some(Image { m, f, g, factors })
    }

    /// Calls `see` with positive integers, ascending, and the resultant there, as a fraction, so many times; the last of them, and `None` where
    /// this is the wrong modulus.
    fn values(
        &self,
        count: usize,
        clock: &Clock,
        mut see: impl FnMut(u64, &[u64; 16], u64, u64),
    ) -> Result<Option<u64>, String> {
        let m = self.m;
        let work = self.f.iter().chain(&self.g).map(|c| 1 + c.len() / 16).sum::<usize>()
            + self.f.len() * self.g.len() / 8
            + self.factors.iter().map(|f| 1 + f.len() / 16).sum::<usize>();
        let (mut a, mut b) = (Vec::with_capacity(self.f.len()), Vec::with_capacity(self.g.len()));
        let (mut seen, mut node) = (0, 0);
        while seen < count {
            node += 1;
            clock.spend(1 + work / 16, 1, 1)?;
            let powers = m.powers(m.of_u64(node));
            for (values, p) in [(&mut a, &self.f), (&mut b, &self.g)] {
                values.clear();
                values.extend(p.iter().map(|c| m.value_at(c, &powers)));
            }
            if a.last() == Some(&0) || b.last() == Some(&0) {
                continue;
            }
            let Some(value) = m.resultant(&mut a, &mut b) else { return Ok(None) };
            see(node, &powers, value.above, value.below);
            seen += 1;
        }
        Ok(Some(node))
    }

    /// The coefficients of the resultant; `None` if this is the wrong modulus.
    fn coefficients(&self, frame: &Frame, clock: &Clock) -> Result<Option<Vec<u64>>, String> {
        let m = self.m;
        let (mut nodes, mut values) = (Vec::with_capacity(frame.count), Vec::with_capacity(frame.count));
        let last = self.values(frame.count, clock, |node, _, above, below| {
            let power = m.power(m.of_u64(node), frame.lowest as u64);
            nodes.push(node);
            values.push(m.inverse(m.times(below, power)).map(|inverse| m.times(above, inverse)));
        })?;
        clock.spend(frame.count * frame.count, 1, 1)?;
        let values: Option<Vec<u64>> = values.into_iter().collect();
        let (Some(_), Some(values)) = (last, values) else { return Ok(None) };
        let Some(found) = m.interpolated(&nodes, values) else { return Ok(None) };
        let mut out = vec![0; frame.lowest];
        out.extend(found);
        while out.last() == Some(&0) {
            out.pop();
        }
        Ok(Some(out))
    }

    /// How often each factor divides a polynomial other than zero; `None` if something else is left.
    fn powers(&self, mut rest: Vec<u64>, clock: &Clock) -> Result<Option<Vec<usize>>, String> {
        let mut powers = Vec::with_capacity(self.factors.len());
        for f in &self.factors {
            let mut power = 0;
            while rest.len() >= f.len() {
                clock.spend(1 + rest.len() * f.len() / 64, 1, 1)?;
                let Some(quotient) = self.m.divided(&rest, f) else { break };
                rest = quotient;
                power += 1;
            }
            powers.push(power);
        }
        Ok((rest.len() == 1).then_some(powers))
    }

    /// The resultant over the product.
    fn ratio(&self, product: &Product, frame: &Frame, clock: &Clock) -> Result<Ratio, String> {
        let m = self.m;
        let one = m.of_u64(1);
        // The ratio, once it is known; what has to have an inverse; and whether all values are as they should be.
        let (mut ratio, mut units, mut is_ratio) = (None, one, true);
        let last = self.values(frame.count, clock, |_, powers, above, below| {
            let factors = self.factors.iter().zip(&product.powers).filter(|(_, power)| **power > 0);
            let value =
                factors.fold(one, |value, (f, power)| m.times(value, m.power(m.value_at(f, powers), *power as u64)));
            let scaled = m.times(value, below);
            units = m.times(units, below);
            if ratio.is_none() && value != 0 {
                ratio = m.inverse(scaled).map(|inverse| m.times(above, inverse));
            }
            is_ratio &= above == m.times(ratio.unwrap_or(0), scaled);
        })?;
        // Nor may a difference of two of the integers be without one: only then has a polynomial no more zeros than its degree.
        let units = (1..=last.unwrap_or(0)).fold(units, |units, k| m.times(units, m.of_u64(k)));
        let (Some(_), Some(ratio), Some(_)) = (last, ratio, m.inverse(units)) else { return Ok(Ratio::Unknown) };
        Ok(if is_ratio { Ratio::Known(ratio) } else { Ratio::None })
    }
}

/// An integer by its residues: the first digit, plus the first modulus times the second digit, and so on.
struct Residues {
    moduli: Vec<u64>,
    digits: Vec<u64>,
    product: Z,
}

impl Default for Residues {
    fn default() -> Self {
        Residues { moduli: Vec::new(), digits: Vec::new(), product: Z::one() }
    }
}

impl Residues {
    /// One residue more; nothing if the modulus is not coprime to those before.
    fn add(&mut self, m: &Modulus, residue: u64) {
        let Some(inverse) = m.inverse(m.of(&self.product)) else { return };
        let known = self.digits.iter().zip(&self.moduli).rev();
        let known = known.fold(0, |sum, (digit, radix)| m.plus(m.times(sum, m.of_u64(*radix)), m.of_u64(*digit)));
        self.digits.push(m.number(m.times(m.minus(residue, known), inverse)));
        self.product *= m.value;
        self.moduli.push(m.value);
    }

    /// The integer, from minus half the product of the moduli to half of it.
    fn number(&self) -> Z {
        let pairs = self.digits.iter().zip(&self.moduli).rev();
        let number = pairs.fold(Z::zero(), |sum, (digit, m)| sum * m + digit);
        if &number + &number > self.product { number - &self.product } else { number }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    /// The determinant of the Sylvester matrix, expanded along its first row.
    fn sylvester(f: &[Uni], g: &[Uni]) -> Uni {
        let (m, n) = (f.len() - 1, g.len() - 1);
        let row = |p: &[Uni], shift: usize| -> Vec<Uni> {
            let mut row = vec![Uni::default(); m + n];
            p.iter().rev().enumerate().for_each(|(k, c)| row[shift + k] = c.clone());
            row
        };
        let rows = (0..n).map(|i| row(f, i)).chain((0..m).map(|i| row(g, i))).collect();
        determinant(rows)
    }

    fn determinant(rows: Vec<Vec<Uni>>) -> Uni {
        let Some((first, rest)) = rows.split_first() else { return uni(&[1]) };
        let minor = |j: usize| {
            let without =
                |row: &Vec<Uni>| row.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, c)| c.clone()).collect();
            determinant(rest.iter().map(without).collect())
        };
        first.iter().enumerate().fold(Uni::default(), |sum, (j, c)| {
            let term = if c.is_zero() { Uni::default() } else { c.times(&minor(j)) };
            if j % 2 == 0 { sum.plus(&term) } else { sum.minus(&term) }
        })
    }

    /// By the determinant and exact division.
    fn is_product_of_all(f: &[Uni], g: &[Uni], factors: &[Uni], clock: &Clock) -> bool {
        let mut rest = sylvester(f, g).primitive(clock).unwrap();
        for factor in factors {
            while rest.degree() > 0
                && let Some(quotient) = rest.divided(factor, clock).unwrap()
            {
                rest = quotient;
            }
        }
        rest.0.len() == 1
    }

    #[test]
    fn its_factors_are_those_of_the_determinant_of_the_sylvester_matrix() {
        let long = Z::from(3).pow(200);
        let clock = Clock::new(Duration::MAX);
        let polynomials = [
            vec![uni(&[1, 2]), uni(&[-3]), uni(&[0, 0, 5])],
            vec![uni(&[0, 1]), uni(&[1])],
            vec![uni(&[-7, 0, 1]), uni(&[]), uni(&[2, -1]), uni(&[0, 3])],
            vec![uni(&[4]), uni(&[]), uni(&[]), uni(&[]), uni(&[-1, 1])],
            vec![uni(&[0, 0, 0, 1]), uni(&[-1, 1])],
            // A remainder that loses more than one degree.
            vec![uni(&[1]), uni(&[2]), uni(&[]), uni(&[]), uni(&[1])],
            vec![
                Uni::new(vec![long.clone(), Z::from(-1)]),
                Uni::new(vec![-long, Z::from(0), Z::from(7)]),
                uni(&[-2, 3]),
            ],
        ];
        let (x, far) = (uni(&[0, 1]), uni(&[17, 0, 0, 0, 0, 0, 1]));
        for f in &polynomials {
            for g in &polynomials {
                let whole = sylvester(f, g).primitive(&clock).unwrap();
                let mut lists = vec![vec![], vec![x.clone()], vec![far.clone(), x.clone()]];
                if whole.degree() > 0 {
                    let near = whole.plus(&uni(&[1])).primitive(&clock).unwrap();
                    lists.extend([vec![far.clone(), whole.clone()], vec![x.clone(), whole.clone()], vec![near]]);
                }
                for factors in lists {
                    let expected = is_product_of_all(f, g, &factors, &clock);
                    assert_eq!(is_product(f, g, &factors, &clock).unwrap(), expected, "{f:?} {g:?} {factors:?}");
                }
            }
        }
        // Of y^2 and (x^2 + 1) y^2 no term of the determinant is left, and the bound of the degree is below zero.
        let (f, g) = (vec![uni(&[]), uni(&[]), uni(&[0, 1])], vec![uni(&[]), uni(&[]), uni(&[1, 0, 1])]);
        assert!(!is_product(&f, &g, std::slice::from_ref(&x), &clock).unwrap());
        // A common factor: x y + 1.
        let (f, g) = (vec![uni(&[1]), uni(&[1, 1]), uni(&[0, 1])], vec![uni(&[2]), uni(&[1, 2]), uni(&[0, 1])]);
        assert!(!is_product(&f, &g, &[x, uni(&[-1, 1])], &clock).unwrap());
    }

    #[test]
    fn powers_of_factors_are_found() {
        let clock = Clock::new(Duration::MAX);
        // The resultant with y - x of a polynomial in y is its value at x: 6 x^3 (x - 1)^2 (2 x + 5).
        let line = vec![uni(&[0, -1]), uni(&[1])];
        let value = [(0, 1), (0, 1), (0, 1), (-1, 1), (-1, 1), (5, 2)]
            .iter()
            .fold(uni(&[6]), |p, (a, b)| p.times(&uni(&[*a, *b])));
        let f: Vec<Uni> = value.0.iter().map(|c| Uni::constant(c.clone())).collect();
        let [x, at_one, third] = [uni(&[0, 1]), uni(&[-1, 1]), uni(&[5, 2])];
        let all = [x.clone(), at_one.clone(), third.clone()];
        assert!(is_product(&f, &line, &all, &clock).unwrap());
        assert!(is_product(&line, &f, &[all.clone().as_slice(), &[uni(&[7, 1])]].concat(), &clock).unwrap());
        for missing in [&all[..2], &all[1..], &[x, third, at_one.times(&at_one).plus(&uni(&[1]))]] {
            assert!(!is_product(&f, &line, missing, &clock).unwrap(), "{missing:?}");
        }
    }
}
