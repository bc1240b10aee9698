//! Whether a loop meets a requirement at a point, decided by other means than crossings.

use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, Poly, UniPoly};
use jurist_engine::model::Model;
use jurist_engine::response::OpenLoop;
use jurist_engine::stability::{ParametricPolynomial, Range, count_roots, is_stable, stable_set};

/// Requirements with rational numbers.
pub enum Known {
    /// A factor.
    Gain(Rational),
    /// `tan(phi/2)^2`.
    Phase(Rational),
    /// The least `|1 + L|/|u + v L|`, with `u` and `v`.
    Circle([i64; 2], Rational),
}

/// What the open loop is at a point, decided by stable sets of factors and rotations and by counts on the boundary; the
/// production code goes by crossings.
pub fn is_met(model: &Model, values: &[(&str, &Rational)], at: Option<&str>, requirement: &Known) -> bool {
    let budget = Budget::unlimited();
    let problem = model.ask().set_all(values.iter().map(|(name, x)| (*name, (*x).clone()))).problem().unwrap();
    let Ok(open_loop) = OpenLoop::of(&problem, at, &budget) else { return false };
    let (d, n, shape) = (open_loop.denominator().unwrap(), open_loop.numerator().unwrap(), open_loop.shape());
    if !is_stable(&d.plus(n), shape) {
        return false;
    }
    let whole = |a: &UniPoly, b: &UniPoly, from: Rational, to: Rational| {
        let degree = a.coeffs().len().max(b.coeffs().len()) - 1;
        let coefficients: Vec<_> =
            (0..=degree).map(|i| (Poly::new(vec![a.coeff(i), b.coeff(i)]), UniPoly::one())).collect();
        let p = ParametricPolynomial::new(&coefficients, degree, Vec::new());
        let set = stable_set(&p, &Range::between(Some(from.clone()), Some(to.clone())), shape, &budget).unwrap();
        let [only] = set.intervals() else { return false };
        let is = |end: &Option<jurist_engine::stability::End>, x: &Rational| {
            end.as_ref().is_some_and(|e| e.value.compare_rational(x).is_eq())
        };
        is(&only.lower, &from) && is(&only.upper, &to)
    };
    match requirement {
        Known::Gain(g) => {
            let at_ends = [g.clone(), g.recip().unwrap()]
                .iter()
                .all(|k| is_stable(&d.scaled(&k.denominator()).plus(&n.scaled(&k.numerator())), shape));
            at_ends && whole(d, n, g.recip().unwrap(), g.clone())
        }
        Known::Phase(square) => {
            let (sum, difference) = (d.plus(n), d.minus(n));
            whole(&sum.times(&sum), &difference.times(&difference), Rational::ZERO, square.clone())
        }
        Known::Circle([u, v], m) => {
            let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
            let squared = |p: &UniPoly| match shape {
                jurist_engine::stability::Shape::UnitDisc => p.times(&p.reversed(degree)),
                jurist_engine::stability::Shape::LeftHalfPlane => p.times(&p.negated_argument()),
            };
            let (p, q) = (m.numerator(), m.denominator());
            let combined = d.scaled(&(*u).into()).plus(&n.scaled(&(*v).into()));
            let excess = squared(&d.plus(n)).scaled(&(&q * &q)).minus(&squared(&combined).scaled(&(&p * &p)));
            // Somewhere above: at frequency 0, unless both vanish there.
            let x = Rational::from(i64::from(matches!(shape, jurist_engine::stability::Shape::UnitDisc)));
            count_roots(&excess, shape).on == 0 && excess.eval_rational(&x).sign().is_gt()
        }
    }
}
