//! Values.

use super::{Monomial, MultiPoly};
use crate::limits::checkpoint;
use crate::number::{Integer, Rational};
use crate::poly::UniPoly;

impl MultiPoly {
    /// Sets variable `i` to `x`: `(p, d)` with the value being `p / d`, where `d` is positive and
    /// a power of the denominator of `x`. Other variables keep their numbers.
    pub fn substitute(&self, i: usize, x: &Rational) -> (MultiPoly, Integer) {
        let degree = self.degree_in(i) as usize;
        if degree == 0 {
            return (self.clone(), Integer::ONE);
        }
        let (a, q) = (powers(&x.numerator(), degree), powers(&x.denominator(), degree));
        checkpoint(8 * self.terms.len() as u64);
        let set = |(m, c): &(Monomial, Integer)| {
            let e = m.exponent(i) as usize;
            (m.with_exponent(i, 0), &(c * &a[e]) * &q[degree - e])
        };
        (MultiPoly::from_unsorted(self.terms.iter().map(set).collect()), q[degree].clone())
    }

    /// Sets variable `i` to `x` in a polynomial of that and variable `kept`: `(p, d)` as with
    /// [`substitute`](Self::substitute), `p` being univariate; `None` when another variable occurs.
    pub fn substitute_univariate(&self, i: usize, x: &Rational, kept: usize) -> Option<(UniPoly, Integer)> {
        let degree = self.degree_in(i) as usize;
        let (a, q) = (powers(&x.numerator(), degree), powers(&x.denominator(), degree));
        let mut coefficients = vec![Integer::ZERO; self.degree_in(kept) as usize + 1];
        checkpoint(8 * self.terms.len() as u64);
        for (m, c) in &self.terms {
            if m.exponents().iter().enumerate().any(|(j, &e)| e > 0 && j != i && j != kept) {
                return None;
            }
            let e = m.exponent(i) as usize;
            let factor = if e == 0 { &q[degree] } else { &(&a[e] * &q[degree - e]) };
            coefficients[m.exponent(kept) as usize].add_mul_assign(c, factor);
        }
        let d = q.into_iter().next_back().expect("the power 0 at least");
        Some((UniPoly::new(coefficients), d))
    }

    /// The value where variable `i` is `point[i]`; a variable beyond the point is an error.
    ///
    /// # Panics
    /// When a variable occurs that the point does not give.
    pub fn eval(&self, point: &[Rational]) -> Rational {
        let degrees = self.degrees();
        assert!(degrees.len() <= point.len(), "the point gives every variable that occurs");
        let numerators: Vec<_> = degrees.iter().zip(point).map(|(&d, x)| powers(&x.numerator(), d as usize)).collect();
        let denominators: Vec<_> =
            degrees.iter().zip(point).map(|(&d, x)| powers(&x.denominator(), d as usize)).collect();
        checkpoint(8 * (self.terms.len() * degrees.len()) as u64);
        let mut sum = Integer::ZERO;
        for (m, c) in &self.terms {
            let mut term = c.clone();
            for (i, &d) in degrees.iter().enumerate() {
                let e = m.exponent(i) as usize;
                term = &(&term * &numerators[i][e]) * &denominators[i][d as usize - e];
            }
            sum += term;
        }
        let denominator = denominators.iter().filter_map(|p| p.last()).fold(Integer::ONE, |product, q| &product * q);
        Rational::new(sum, denominator)
    }

    /// The value at integers.
    ///
    /// # Panics
    /// When a variable occurs that the point does not give.
    pub fn eval_integers(&self, point: &[Integer]) -> Integer {
        let degrees = self.degrees();
        assert!(degrees.len() <= point.len(), "the point gives every variable that occurs");
        let table: Vec<_> = degrees.iter().zip(point).map(|(&d, x)| powers(x, d as usize)).collect();
        checkpoint(8 * (self.terms.len() * degrees.len()) as u64);
        let mut sum = Integer::ZERO;
        for (m, c) in &self.terms {
            let value = m.exponents().iter().enumerate().fold(c.clone(), |v, (i, &e)| &v * &table[i][e as usize]);
            sum += value;
        }
        sum
    }
}

fn powers(x: &Integer, up_to: usize) -> Vec<Integer> {
    let mut out = Vec::with_capacity(up_to + 1);
    checkpoint(4 * up_to as u64);
    let mut power = Integer::ONE;
    for _ in 0..up_to {
        let next = &power * x;
        out.push(power);
        power = next;
    }
    out.push(power);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn substitution_clears_denominators() {
        let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
        let p = &(&(&k * &k) * &t) - &k; // K^2 T - K at K = 2/3: 4/9 T - 2/3
        let (q, d) = p.substitute(0, &Rational::new(2.into(), 3.into()));
        assert_eq!((q.display(&["K", "T"]).to_string(), d), ("4*T - 6".into(), Integer::from(9)));
        for x in ["2/3", "0", "-5"].map(|x| crate::number::parse_number(x).unwrap()) {
            for (i, kept) in [(0, 1), (1, 0)] {
                let (slow, d) = p.substitute(i, &x);
                assert_eq!(p.substitute_univariate(i, &x, kept), Some((slow.to_univariate(kept).unwrap(), d)));
            }
        }
        assert_eq!(p.substitute_univariate(2, &Rational::ONE, 0), None);
        let value = p.eval(&[Rational::new(2.into(), 3.into()), Rational::from(3)]);
        assert_eq!(value, Rational::new(2.into(), 3.into()));
        assert_eq!(p.eval_integers(&[2.into(), 5.into()]), Integer::from(18));
    }
}
