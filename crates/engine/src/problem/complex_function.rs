//! The characteristic function of a loop with complex coefficients: its value at places that are enclosed, with dead time or without.

use super::beside_dead_time::Beside;
use super::delayed_terms::{DelayedTerms, add_times};
use crate::error::Error;
use crate::model::ComplexPolynomial;
use jurist_algebra::ball::{Ball, cos_sin, exp};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::symbols::MovingSymbols;

/// Real and imaginary part.
type Complex = [Ball; 2];

/// `sum P_k(s) exp(-tau_k s)`, the coefficients functions of one parameter and of symbols.
pub(crate) struct ComplexFunction {
    symbols: MovingSymbols,
    /// The dead times with the real and the imaginary parts of the coefficients.
    terms: Vec<(RationalFunction, [Vec<RationalFunction>; 2])>,
}

impl ComplexFunction {
    /// Of a polynomial whose variables stand for this.
    ///
    /// # Errors
    /// `E-dead-time` where the loop divides by a delay.
    pub fn new(whole: &ComplexPolynomial, beside: &Beside) -> Result<ComplexFunction, Error> {
        let symbols = beside.symbols.clone();
        if beside.delays.is_empty() {
            let parts = [whole.re.clone(), whole.im.clone()];
            return Ok(ComplexFunction { symbols, terms: vec![(RationalFunction::zero(), parts)] });
        }
        let both = CharacteristicPolynomial {
            variables: Vec::new(),
            coefficients: whole.re.iter().chain(&whole.im).cloned().collect(),
            formal_degree: 0,
            poles: Vec::new(),
            monic: false,
        };
        let time_of = |v: usize| beside.delays.iter().find(|(own, _)| *own == v).map(|(_, time)| time);
        let found = DelayedTerms::of(&both, 1 + symbols.len(), time_of, add_times)?;
        let parts = |list: Vec<MultiPoly>| {
            let mut re: Vec<RationalFunction> = list.into_iter().map(RationalFunction::from).collect();
            let im = re.split_off(whole.re.len());
            [re, im]
        };
        Ok(ComplexFunction {
            symbols,
            terms: found.terms.into_iter().map(|(time, list)| (time, parts(list))).collect(),
        })
    }

    /// The value at the place `x + jy`; `None` where something may be divided by zero.
    ///
    /// Cost: enclosures of the coefficients, and an exponential of each dead time.
    pub fn enclose(&self, parameter: &Ball, [x, y]: [&Ball; 2]) -> Option<Complex> {
        let bits = parameter.bits();
        let values = |list: &[RationalFunction]| -> Option<Vec<Ball>> {
            let sides: Vec<MultiPoly> =
                list.iter().flat_map(|f| [f.numerator().clone(), f.denominator().clone()]).collect();
            let values = self.symbols.enclose(&sides, parameter)?;
            values.chunks(2).map(|pair| pair[0].div(&pair[1])).collect()
        };
        let mut sum = [Ball::zero(bits), Ball::zero(bits)];
        for (time, [re, im]) in &self.terms {
            let mut own = [Ball::zero(bits), Ball::zero(bits)];
            for (re, im) in values(re)?.iter().zip(values(im)?).rev() {
                let [u, v] = times(&own, &[x.clone(), y.clone()]);
                own = [u.add(re), v.add(&im)];
            }
            if !time.is_zero() {
                let time = values(std::slice::from_ref(time))?.swap_remove(0);
                let (size, (cosine, sine)) = (exp(&x.mul(&time).neg()), cos_sin(&y.mul(&time)));
                own = times(&own, &[size.mul(&cosine), size.mul(&sine).neg()]);
            }
            sum = [sum[0].add(&own[0]), sum[1].add(&own[1])];
        }
        Some(sum)
    }

    /// Whether it may vanish at a place.
    pub fn may_vanish(&self, parameter: &Ball, place: [&Ball; 2]) -> Option<bool> {
        Some(self.enclose(parameter, place)?.iter().all(Ball::contains_zero))
    }
}

fn times([a, b]: &Complex, [c, d]: &Complex) -> Complex {
    [a.mul(c).sub(&b.mul(d)), a.mul(d).add(&b.mul(c))]
}
