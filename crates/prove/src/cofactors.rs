//! Cofactors of a pair of polynomials: `U A + V B = value`.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, Poly, RemainderSequence, Step};
use jurist_stability::{HalfSizePair, Shape};

/// `U A + V B = value`, with `U` and `V` coefficients in `x` from the constant term up.
pub(super) struct Identity<P> {
    pub u: Vec<P>,
    pub v: Vec<P>,
    pub value: P,
}

/// The identity of the half-size pair of a polynomial in `z` or `s` of degree `n`.
pub(super) fn of_half_size_pair<P: Domain>(
    d: &Poly<P>,
    n: usize,
    shape: Shape,
    budget: &Budget,
) -> Result<Identity<P>, Exhausted> {
    let pair = HalfSizePair::new(d, n, shape);
    let (a, b) = (&pair.a, &pair.b);
    let degrees = a.coeffs().len() + b.coeffs().len();
    if (2..=MOST_BY_MINORS + 2).contains(&degrees) && !a.is_zero() && !b.is_zero() {
        let (s, t, value) = budget.enter(|| by_minors(a, b))?;
        // All minors are zero where the polynomials have more than one root in common.
        if !(s.is_zero() && t.is_zero()) {
            return reduced(&s, &t, &value, budget);
        }
    }
    let (s, t, value) = by_subresultants(a, b, budget)?;
    reduced(&s, &t, &value, budget)
}

/// Degrees that add up to so many have few minors: the pair of an LCL filter over its symbols takes a third of the time.
const MOST_BY_MINORS: usize = 7;

/// Both cofactors and the resultant by minors of Sylvester's matrix: its determinant with polynomials for the last column, which are the
/// rows' own.
///
/// Cost: `r 2^r` products, `r` the sum of the degrees.
fn by_minors<P: Domain>(a: &Poly<P>, b: &Poly<P>) -> (Poly<P>, Poly<P>, P) {
    let (m, n) = (a.coeffs().len() - 1, b.coeffs().len() - 1);
    let size = m + n;
    // Row i is x^i A for i < n, else x^(i - n) B; the columns are the powers from the highest down, the last one left out.
    let entry = |row: usize, column: usize| {
        let (of, shift) = if row < n { (a, row) } else { (b, row - n) };
        (size - 1 - column).checked_sub(shift).map_or_else(P::zero, |k| of.coeff(k))
    };
    // By set of rows, the determinant of these rows and as many first columns.
    let mut minors: Vec<P> = vec![P::zero(); 1 << size];
    minors[0] = P::one();
    for rows in 1usize..1 << size {
        let column = rows.count_ones() as usize - 1;
        if column + 1 >= size {
            continue;
        }
        let mut sum = P::zero();
        for row in (0..size).filter(|row| rows >> row & 1 == 1) {
            let x = entry(row, column);
            let minor = &minors[rows & !(1 << row)];
            if x.is_zero() || minor.is_zero() {
                continue;
            }
            let product = x.times(minor);
            // The rows after this one are below it in the last column.
            let is_negative = (rows >> (row + 1)).count_ones() % 2 == 1;
            sum = if is_negative { sum.minus(&product) } else { sum.plus(&product) };
        }
        minors[rows] = sum;
    }
    let all = (1usize << size) - 1;
    let cofactor = |row: usize| {
        let minor = minors[all & !(1 << row)].clone();
        if (size - 1 - row) % 2 == 1 { minor.negated() } else { minor }
    };
    let s = Poly::new((0..n).map(cofactor).collect());
    let t = Poly::new((n..size).map(cofactor).collect());
    // What stands at x^0: s A + t B is a constant.
    let value = s.coeff(0).times(&a.coeff(0)).plus(&t.coeff(0).times(&b.coeff(0)));
    (s, t, value)
}

/// Both cofactors and their value by subresultants [BrownTraub1971](jurist_algebra::bibliography#browntraub1971); the value is zero if and only
/// if the polynomials have a common factor.
fn by_subresultants<P: Domain>(a: &Poly<P>, b: &Poly<P>, budget: &Budget) -> Result<(Poly<P>, Poly<P>, P), Exhausted> {
    let swapped = a.coeffs().len() < b.coeffs().len();
    let (first, second) = if swapped { (b, a) } else { (a, b) };
    // The last members are s0 first + t0 second and s1 first + t1 second.
    let (mut s0, mut t0, mut s1, mut t1) = (Poly::one(), Poly::zero(), Poly::zero(), Poly::one());
    let mut value = P::zero();
    let mut sequence = (!second.is_zero()).then(|| RemainderSequence::new(first.clone(), second.clone()));
    while let Some(members) = &mut sequence {
        budget.check()?;
        if members.last().is_constant() {
            value = members.last().coeff(0);
            break;
        }
        let Step { factor, quotient, divisor, is_end, .. } = members.advance_with_quotient();
        let next = |x0: &Poly<P>, x1: &Poly<P>| {
            let combined = x0.scaled(&factor).minus(&quotient.times(x1));
            combined.div_exact_scalar(&divisor).expect("the subresultant theorem")
        };
        (s0, s1, t0, t1) = (s1.clone(), next(&s0, &s1), t1.clone(), next(&t0, &t1));
        if is_end {
            break;
        }
    }
    Ok(if swapped { (t1, s1, value) } else { (s1, t1, value) })
}

/// The identity divided by all that `U` and `V` have in common.
fn reduced<P: Domain>(s: &Poly<P>, t: &Poly<P>, value: &P, budget: &Budget) -> Result<Identity<P>, Exhausted> {
    let mut common = P::zero();
    for c in s.coeffs().iter().chain(t.coeffs()) {
        if common.is_one() {
            break;
        }
        common = budget.enter(|| common.gcd(c))?;
    }
    let reduced = |p: &Poly<P>| p.div_exact_scalar(&common).expect("a common divisor").into_coeffs();
    let value = value.div_exact(&common).expect("a common divisor of both cofactors");
    Ok(Identity { u: reduced(s), v: reduced(t), value })
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::Integer;
    use proptest::prelude::*;

    fn polynomial() -> impl Strategy<Value = Poly<Poly<Integer>>> {
        let coefficient =
            prop::collection::vec(-3i64..4, 0..3).prop_map(|c| Poly::new(c.into_iter().map(Integer::from).collect()));
        prop::collection::vec(coefficient, 1..4).prop_map(Poly::new)
    }

    proptest! {
        /// Both ways give `U A + V B = value`, and the same value up to the sign where nothing is lost.
        #[test]
        fn cofactors_by_minors_are_those_by_subresultants(a in polynomial(), b in polynomial()) {
            prop_assume!(!a.is_zero() && !b.is_zero() && a.coeffs().len() + b.coeffs().len() > 2);
            let budget = Budget::unlimited();
            let is_identity = |i: &Identity<Poly<Integer>>| {
                let sum = Poly::new(i.u.clone()).times(&a).plus(&Poly::new(i.v.clone()).times(&b));
                sum == Poly::new(vec![i.value.clone()])
            };
            let (s, t, value) = by_minors(&a, &b);
            let by_minors = (!value.is_zero()).then(|| reduced(&s, &t, &value, &budget).unwrap());
            let (s, t, value) = by_subresultants(&a, &b, &budget).unwrap();
            let by_subresultants = (!value.is_zero()).then(|| reduced(&s, &t, &value, &budget).unwrap());
            prop_assert_eq!(by_minors.is_some(), by_subresultants.is_some());
            if let (Some(x), Some(y)) = (by_minors, by_subresultants) {
                prop_assert!(is_identity(&x) && is_identity(&y), "{:?} {:?}", x.value, y.value);
                prop_assert!(x.value == y.value || x.value == y.value.negated(), "{:?} {:?}", x.value, y.value);
            }
        }
    }
}
