//! `exp(M t)` of a matrix, with finitely many symbols in place of the functions that are not rational.
//!
//! Both sides of `exp(M t) = sum_b b(t) Z_b` solve the linear differential equation of a polynomial that annihilates `M`;
//! the functions `b` are a basis of its solutions, and the matrices `Z_b` follow from the derivatives at 0
//! [Leonard1996](https://doi.org/10.1137/S0036144595286488). Powers of `t` are the solutions of a root 0, so integrators
//! stay rational.

use super::factor::factors;
use super::matrices::solve;
use super::state_space::NotConnected;
use crate::symbols::Symbols;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// A polynomial that annihilates a matrix, with what is known of its factors.
pub(crate) struct Modes {
    /// Monic pairwise coprime factors with multiplicities, from the constant term up.
    factors: Vec<(Vec<RationalFunction>, usize)>,
    /// Whether all coefficients are rational numbers.
    is_rational: bool,
}

/// A solution `t^power phi` of the differential equation.
struct Solution<'m> {
    factor: &'m [RationalFunction],
    power: usize,
    index: usize,
}

impl Modes {
    /// The modes of `s^zeros` times the characteristic polynomial of `a`, which annihilates `a` with `zeros` chains of
    /// inputs beside it.
    ///
    /// A matrix of rational numbers has the factors of its polynomial; one with other entries has powers of `s` apart and
    /// the whole polynomial for the rest, so that nothing is divided by.
    pub fn of(a: &RationalMatrix, zeros: usize, budget: &Budget) -> Result<Modes, NotConnected> {
        let polynomial = a.characteristic_polynomial(Vec::new(), budget)?;
        let numbers: Option<Vec<Rational>> =
            polynomial.coefficients.iter().map(RationalFunction::as_constant).collect();
        let zero = || vec![RationalFunction::zero(), RationalFunction::one()];
        let Some(numbers) = numbers else {
            let mut whole = vec![RationalFunction::zero(); zeros];
            whole.extend(polynomial.coefficients);
            return Ok(Modes { factors: vec![(whole, 1)], is_rational: false });
        };
        let mut parts: Vec<(Vec<RationalFunction>, usize)> = Vec::new();
        let mut zeros = zeros;
        for (factor, multiplicity) in factors(&numbers, budget)? {
            if factor.len() == 2 && factor[0].is_zero() {
                zeros += multiplicity;
            } else {
                parts.push((factor.into_iter().map(RationalFunction::from).collect(), multiplicity));
            }
        }
        if zeros > 0 {
            parts.insert(0, (zero(), zeros));
        }
        Ok(Modes { factors: parts, is_rational: true })
    }

    fn solutions(&self) -> Vec<Solution<'_>> {
        let mut out = Vec::new();
        for (factor, multiplicity) in &self.factors {
            for power in 0..*multiplicity {
                out.extend((0..factor.len() - 1).map(|index| Solution { factor, power, index }));
            }
        }
        out
    }

    /// `exp(M t)`, where the polynomial of these modes annihilates `M`.
    ///
    /// Cost: as many products of matrices as the polynomial's degree, and a linear system of that size over the rationals.
    pub fn exponential(
        &self,
        m: &RationalMatrix,
        time: &RationalFunction,
        symbols: &mut Symbols,
        budget: &Budget,
    ) -> Result<RationalMatrix, NotConnected> {
        if self.is_rational {
            self.factors.iter().for_each(|(factor, _)| symbols.note_mode(factor));
        }
        let solutions = self.solutions();
        let order = solutions.len();
        let wronskian = RationalMatrix::from_fn(order, order, |_, _| RationalFunction::zero());
        let mut wronskian = wronskian;
        for (b, solution) in solutions.iter().enumerate() {
            for (l, value) in solution.derivatives(order).into_iter().enumerate() {
                wronskian[(l, b)] = value;
            }
        }
        // The weights of the powers of M in Z_b are row b of the inverse.
        let inverse = match self.factors.as_slice() {
            [(_, 1)] => RationalMatrix::identity(order),
            _ => solve(&wronskian, &RationalMatrix::identity(order), budget)?
                .map(|(inverse, _)| inverse)
                .unwrap_or(wronskian),
        };
        let values: Vec<RationalFunction> = solutions.iter().map(|s| self.value(s, time, symbols)).collect();
        let n = m.rows();
        let (mut sum, mut power) = (RationalMatrix::zeros(n, n), RationalMatrix::identity(n));
        for l in 0..order {
            budget.check()?;
            let mut weight = RationalFunction::zero();
            for (b, value) in values.iter().enumerate().filter(|(b, _)| !inverse[(*b, l)].is_zero()) {
                weight = &weight + &(value * &inverse[(b, l)]);
            }
            sum = &sum + &power.scaled(&weight);
            if l + 1 < order {
                power = &power * m;
            }
        }
        Ok(sum)
    }

    /// The value of a solution at `time`.
    fn value(&self, s: &Solution<'_>, time: &RationalFunction, symbols: &mut Symbols) -> RationalFunction {
        let power = |k: usize| (0..k).fold(RationalFunction::one(), |product, _| &product * time);
        let base = match s.factor {
            [zero, _] if zero.is_zero() => RationalFunction::one(),
            [minus_rate, _] => symbols.exponential(&-minus_rate * time),
            [c, b, _] if self.is_rational && time.as_constant().is_some() => oscillation(b, c, time, s.index, symbols),
            factor => {
                if let Some(turned) = self.turned(factor, time, s.index, symbols) {
                    return &power(s.power) * &turned;
                }
                // The first solutions of a polynomial with the factor s^j are powers of t over factorials.
                let j = factor.iter().take_while(|c| c.is_zero()).count();
                if s.index < j {
                    let factorial = (1..=s.index as i64).fold(Rational::ONE, |f, k| &f * &Rational::from(k));
                    let inverse = factorial.recip().unwrap_or(Rational::ONE);
                    &power(s.index) * &RationalFunction::from(inverse)
                } else {
                    symbols.fundamental(factor.to_vec(), time.clone(), s.index)
                }
            }
        };
        &power(s.power) * &base
    }
}

impl Modes {
    /// The fundamental solution of a factor of degree 2 where its angle is a rational multiple of the circle number.
    fn turned(
        &self,
        factor: &[RationalFunction],
        time: &RationalFunction,
        index: usize,
        symbols: &mut Symbols,
    ) -> Option<RationalFunction> {
        let [c, b, _] = factor else { return None };
        let half = RationalFunction::from(Rational::new(1.into(), 2.into()));
        let half_b = b * &half;
        let (sine, cosine) = symbols.turned(&(c - &(&half_b * &half_b)).as_constant()?, time)?;
        let decay = symbols.exponential(-(&half_b * time));
        let sine = &decay * &sine;
        Some(if index == 1 { sine } else { &(&decay * &cosine) + &(&half_b * &sine) })
    }
}

/// The fundamental solutions of `s^2 + b s + c` by `X = exp(-b t/2)` and the tangent of half the angle: then the squares of
/// sine and cosine add up to 1 by themselves.
fn oscillation(
    b: &RationalFunction,
    c: &RationalFunction,
    time: &RationalFunction,
    index: usize,
    symbols: &mut Symbols,
) -> RationalFunction {
    let half = RationalFunction::from(Rational::new(1.into(), 2.into()));
    let half_b = b * &half;
    let w = c - &(&half_b * &half_b);
    let decay = symbols.exponential(-(&half_b * time));
    let t = symbols.tangent(w.clone(), time * &half);
    let one = RationalFunction::one();
    let square = &w * &(&t * &t);
    // No rational number makes 1 + w t^2 the zero function.
    let over = (&one + &square).recip().unwrap_or_default();
    let sine = &(&decay * &(&t + &t)) * &over;
    if index == 1 {
        return sine;
    }
    &(&(&decay * &(&one - &square)) * &over) + &(&half_b * &sine)
}

impl Solution<'_> {
    /// The derivatives at 0, from the function itself up.
    fn derivatives(&self, count: usize) -> Vec<RationalFunction> {
        let d = self.factor.len() - 1;
        let mut phi: Vec<RationalFunction> = Vec::with_capacity(count);
        for l in 0..count {
            phi.push(if l < d {
                if l == self.index { RationalFunction::one() } else { RationalFunction::zero() }
            } else {
                let terms = (0..d).map(|k| &self.factor[k] * &phi[l - d + k]);
                -terms.fold(RationalFunction::zero(), |sum, term| &sum + &term)
            });
        }
        // (t^j phi)^(l) at 0 is l!/(l - j)! phi^(l - j).
        (0..count)
            .map(|l| match l.checked_sub(self.power) {
                None => RationalFunction::zero(),
                Some(rest) => {
                    let falling = (rest + 1..=l).fold(Rational::ONE, |f, k| &f * &Rational::from(k as i64));
                    &phi[rest] * &RationalFunction::from(falling)
                }
            })
            .collect()
    }
}
