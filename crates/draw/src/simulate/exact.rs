//! The sampled model over the rationals: exact, and longer with every sample.

use jurist_algebra::number::Rational;

/// The states `x(0) .. x(samples)` of `x(n+1) = A x(n) + E r` with constant `r`, exactly.
///
/// `transition` is square, `input` has as many rows and as many columns as `inputs` has entries.
/// The numbers grow by a constant number of digits per sample: meant for short runs, as the oracle
/// of the floating point simulation. Rows that are too short count as continued by zeros.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_draw::simulate::exact_response;
/// let q = |n: i64, d: i64| Rational::new(n.into(), d.into());
/// let run = exact_response(&[vec![q(1, 2)]], &[vec![q(1, 1)]], &[q(0, 1)], &[q(1, 1)], 3);
/// assert_eq!(run[3], vec![q(7, 4)]);
/// ```
pub fn exact_response(
    transition: &[Vec<Rational>],
    input: &[Vec<Rational>],
    initial: &[Rational],
    inputs: &[Rational],
    samples: usize,
) -> Vec<Vec<Rational>> {
    let dot = |row: &[Rational], v: &[Rational]| {
        row.iter().zip(v).fold(Rational::ZERO, |sum, (a, b)| if a.is_zero() || b.is_zero() { sum } else { sum + a * b })
    };
    let forced: Vec<Rational> =
        (0..transition.len()).map(|i| input.get(i).map_or(Rational::ZERO, |row| dot(row, inputs))).collect();
    let mut states = vec![initial.to_vec()];
    for n in 0..samples {
        let next = transition.iter().zip(&forced).map(|(row, f)| dot(row, &states[n]) + f).collect();
        states.push(next);
    }
    states
}
