//! A criterion of Schur and Cohn in rationals that shares nothing with the engine.

use jurist_algebra::number::Rational;

/// Whether all roots of a polynomial, highest power first, are inside of the unit circle: degree by degree.
pub fn is_schur(polynomial: &[Rational]) -> bool {
    let leading = polynomial.iter().position(|c| !c.is_zero());
    let Some(leading) = leading else { return false };
    // A degree that is lost is a root at infinity.
    if leading > 0 {
        return false;
    }
    let mut p = polynomial.to_vec();
    while p.len() > 1 {
        let (first, last) = (p[0].clone(), p[p.len() - 1].clone());
        if last.abs() >= first.abs() {
            return false;
        }
        let n = p.len() - 1;
        p = (0..n).map(|k| &(&first * &p[k]) - &(&last * &p[n - k])).collect();
    }
    true
}

/// The product of two polynomials.
pub fn product(a: &[Rational], b: &[Rational]) -> Vec<Rational> {
    let mut out = vec![Rational::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = &out[i + j] + &(x * y);
        }
    }
    out
}

/// `a_c a_p + b_c b_p` of two fractions `[b, a]`, aligned at the end: highest power first.
pub fn closed(controller: &[Vec<Rational>; 2], plant: &[Vec<Rational>; 2]) -> Vec<Rational> {
    let [above, below] = [0, 1].map(|k| product(&controller[k], &plant[k]));
    let length = above.len().max(below.len());
    let filled = |list: Vec<Rational>| [vec![Rational::ZERO; length - list.len()], list].concat();
    filled(above).iter().zip(&filled(below)).map(|(x, y)| x + y).collect()
}
