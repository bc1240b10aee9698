//! The characteristic polynomial as a plain value.

use super::rational::least_common_multiple;
use crate::number::{Integer, Rational};
use crate::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};

/// A characteristic polynomial whose coefficients are rational functions of the kept parameters,
/// exactly as the model gives it.
///
/// ```
/// use jurist_algebra::matrix::CharacteristicPolynomial;
/// use jurist_algebra::poly::RationalFunction;
/// let k = RationalFunction::variable(0);
/// let half = k.checked_div(&2.into()).unwrap();
/// // z^2 + z/K + K/2
/// let p = CharacteristicPolynomial {
///     variables: vec!["K".into()],
///     coefficients: vec![half, k.recip().unwrap(), 1.into()],
///     formal_degree: 2,
///     poles: vec![k.denominator().clone(), k.numerator().clone()],
///     monic: true,
/// };
/// let (numerator, denominator) = p.cleared();
/// assert_eq!(denominator.display(&p.variables).to_string(), "2*K");
/// assert_eq!(numerator.coeffs()[0].display(&p.variables).to_string(), "K^2");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CharacteristicPolynomial {
    /// The names of the kept parameters: of variables 0, 1, ... of the coefficients.
    pub variables: Vec<String>,
    /// The coefficients from the constant term up, as they stand: `formal_degree + 1` of them,
    /// zeros at the top included.
    pub coefficients: Vec<RationalFunction>,
    /// The degree while all parameters are symbolic, before any was set.
    pub formal_degree: usize,
    /// The model is undefined where one of these is zero. None is the zero polynomial; they need
    /// be neither square-free nor coprime, and constants are allowed.
    pub poles: Vec<MultiPoly>,
    /// Whether the polynomial is monic by construction (from matrices or blocks) rather than
    /// given as it is.
    pub monic: bool,
}

impl CharacteristicPolynomial {
    /// `(P, d)` with this polynomial equal to `P / d`: `d` is the least common denominator of the
    /// coefficients, with a positive leading coefficient; `P` keeps all its content. The sign of
    /// `d` varies with the parameters unless it is constant: signs of `P` that matter are to be
    /// taken relative to its leading coefficient, from which `d` drops out.
    ///
    /// Cost: a least common multiple and a product of polynomials for each of the `n + 1` coefficients.
    pub fn cleared(&self) -> (Poly<MultiPoly>, MultiPoly) {
        let mut denominator = MultiPoly::one();
        for c in &self.coefficients {
            denominator = least_common_multiple(&denominator, c.denominator());
        }
        let numerator = |c: &RationalFunction| {
            c.numerator().times(&denominator.div_exact(c.denominator()).expect("a common multiple"))
        };
        (Poly::new(self.coefficients.iter().map(numerator).collect()), denominator)
    }

    /// Sets the variable with number `i` to `x` and removes it: later variables move down by one,
    /// in coefficients, poles and names. `None` when the model is undefined for this value, whatever
    /// the others are.
    ///
    /// The formal degree stays.
    pub fn substitute(&self, i: usize, x: &Rational) -> Option<CharacteristicPolynomial> {
        let close_gap = |j: usize| if j > i { j - 1 } else { j };
        let mut poles = Vec::with_capacity(self.poles.len());
        for pole in &self.poles {
            let (value, _) = pole.substitute(i, x);
            if value.is_zero() {
                return None;
            }
            poles.push(value.map_variables(close_gap));
        }
        let coefficients = self
            .coefficients
            .iter()
            .map(|c| c.substitute(i, x)?.map_variables(close_gap))
            .collect::<Option<Vec<RationalFunction>>>()?;
        let names = self.variables.iter().enumerate().filter(|(j, _)| *j != i);
        Some(CharacteristicPolynomial {
            variables: names.map(|(_, name)| name.clone()).collect(),
            coefficients,
            formal_degree: self.formal_degree,
            poles,
            monic: self.monic,
        })
    }

    /// Sets variable `i` of two to `x`: the numerator with coefficients in the other one, and the
    /// denominator. `None` when the model is undefined for this value, or has other variables.
    pub fn on_line(&self, i: usize, x: &Rational) -> Option<(Poly<UniPoly>, UniPoly)> {
        let kept = 1usize.checked_sub(i)?;
        let constants: Option<Vec<Integer>> = self.coefficients.iter().map(|c| c.denominator().as_constant()).collect();
        let Some(constants) = constants else { return self.substitute(i, x)?.univariate() };
        for pole in &self.poles {
            if pole.substitute_univariate(i, x, kept)?.0.is_zero() {
                return None;
            }
        }
        let mut common = Integer::ONE;
        let mut parts = Vec::with_capacity(constants.len());
        for (c, denominator) in self.coefficients.iter().zip(constants) {
            let (numerator, d) = c.numerator().substitute_univariate(i, x, kept)?;
            let denominator = denominator * d;
            // Lowest terms keep the numbers small in all that follows.
            let g = numerator.content().gcd(&denominator);
            let denominator = denominator.div_exact(&g);
            common = common.lcm(&denominator);
            parts.push((numerator, g, denominator));
        }
        let scaled = |(p, g, d): (UniPoly, Integer, Integer)| {
            let factor = common.div_exact(&d);
            Poly::new(p.into_coeffs().iter().map(|c| &c.div_exact(&g) * &factor).collect())
        };
        Some((Poly::new(parts.into_iter().map(scaled).collect()), UniPoly::constant(common)))
    }

    /// The number of the variable with this name.
    pub fn variable(&self, name: &str) -> Option<usize> {
        self.variables.iter().position(|v| v == name)
    }

    /// The values of the coefficients at a point, from the constant term up, `formal_degree + 1`
    /// of them; `None` when the model is undefined there.
    ///
    /// # Panics
    /// When the point has fewer entries than there are variables.
    pub fn at(&self, point: &[Rational]) -> Option<Vec<Rational>> {
        if self.poles.iter().any(|pole| pole.eval(point).is_zero()) {
            return None;
        }
        self.coefficients.iter().map(|c| c.eval(point)).collect()
    }

    /// For one variable, the numerator with coefficients in `Z[K]` and the denominator; `None`
    /// when a variable other than number 0 occurs.
    pub fn univariate(&self) -> Option<(Poly<UniPoly>, UniPoly)> {
        let (numerator, denominator) = self.cleared();
        let coefficients = numerator.coeffs().iter().map(|c| c.to_univariate(0)).collect::<Option<Vec<UniPoly>>>()?;
        Some((Poly::new(coefficients), denominator.to_univariate(0)?))
    }

    /// The poles as polynomials of the one variable; `None` when a variable other than number 0
    /// occurs.
    pub fn univariate_poles(&self) -> Option<Vec<UniPoly>> {
        self.poles.iter().map(|pole| pole.to_univariate(0)).collect()
    }
}
