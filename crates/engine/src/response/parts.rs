//! The polynomials of an open loop, and their products along the boundary.

use super::Frequencies;
use super::complex_poly::ComplexPoly;
use super::ground::Ground;
use super::place::{modulus_squared, product};
use crate::stability::{HalfSizePair, Shape};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};

/// Evaluates an expression with the parts of an open loop, whatever their coefficients are.
macro_rules! with_parts {
    ($open_loop:expr, $parts:ident => $value:expr) => {
        match $open_loop.over() {
            crate::response::open_loop::Over::Integers($parts) => $value,
            crate::response::open_loop::Over::Constants($parts) => $value,
        }
    };
}
pub(crate) use with_parts;

/// `D0` and `N`, primitive together; hidden modes stay.
#[derive(Clone, Debug)]
pub(crate) struct Parts<G: Ground> {
    pub ground: G,
    pub denominator: ComplexPoly<G::Number>,
    pub numerator: ComplexPoly<G::Number>,
    /// Polynomials in the factor at whose zeros the model is undefined.
    pub poles: Vec<Poly<G::Number>>,
    pub shape: Shape,
    pub reduced: Reduced<G::Number>,
}

/// The products of `L` in lowest terms on the boundary, in the variable `x` of its frequencies.
#[derive(Clone, Debug)]
pub(crate) struct Reduced<R: Domain> {
    pub frequencies: Frequencies,
    /// `|N|^2`, `|D0|^2`, `|D0 + N|^2`, `|D0 - N|^2`.
    pub numerator_squared: Poly<R>,
    pub denominator_squared: Poly<R>,
    pub sum_squared: Poly<R>,
    pub difference_squared: Poly<R>,
    /// Twice the real part of `N conj(D0)`, and its imaginary part; over `sin theta` or `omega` where frequencies have no sign.
    pub twice_real: Poly<R>,
    pub imaginary: Poly<R>,
    /// The factors of `N` and of `D0` whose zeros are on the boundary and not at its ends, or in pairs mirrored there.
    pub mirrored: Box<[Poly<R>; 2]>,
}

impl<G: Ground> Parts<G> {
    /// With real coefficients.
    pub fn new(
        ground: G,
        denominator: Poly<G::Number>,
        numerator: Poly<G::Number>,
        poles: Vec<Poly<G::Number>>,
        shape: Shape,
    ) -> Parts<G> {
        let reduced = Reduced::of(&numerator, &denominator, shape);
        Parts { ground, denominator: denominator.into(), numerator: numerator.into(), poles, shape, reduced }
    }

    /// With `N` times a number, both polynomials without denominators.
    pub fn times(&self, factor: &Rational) -> Parts<G> {
        let [up, down] = [factor.numerator(), factor.denominator()].map(|n| G::Number::from_integer(&n));
        let scaled = |p: &ComplexPoly<G::Number>, by| ComplexPoly { re: p.re.scaled(by), im: p.im.scaled(by) };
        let r = &self.reduced;
        let both = up.times(&down);
        let squares = [r.numerator_squared.scaled(&up.times(&up)), r.denominator_squared.scaled(&down.times(&down))];
        let products = [&r.twice_real, &r.imaginary].map(|p| p.scaled(&both));
        Parts {
            denominator: scaled(&self.denominator, &down),
            numerator: scaled(&self.numerator, &up),
            reduced: Reduced { mirrored: r.mirrored.clone(), ..Reduced::of_products(squares, products, r.frequencies) },
            ..self.clone()
        }
    }

    /// The variable of frequencies.
    pub fn frequencies(&self) -> Frequencies {
        self.reduced.frequencies
    }

    /// A polynomial in the factor `k` for each power of the variable of the loop: that of `D0 + k N`, or of it with the conjugate roots, by powers of `k`.
    pub fn in_factor(&self) -> Vec<Poly<G::Number>> {
        let (d, n) = (&self.denominator, &self.numerator);
        if d.is_real() && n.is_real() {
            return vec![d.re.clone(), n.re.clone()];
        }
        let two = G::Number::from_integer(&Integer::from(2));
        vec![d.squared(), d.times_conjugate(n)[0].scaled(&two), n.squared()]
    }
}

impl<R: Domain> Reduced<R> {
    pub(super) fn of(numerator: &Poly<R>, denominator: &Poly<R>, shape: Shape) -> Reduced<R> {
        let common = numerator.gcd(denominator);
        let divided = |p: &Poly<R>| p.div_exact(&common).expect("a gcd divides");
        let (numerator, denominator) = (divided(numerator), divided(denominator));
        let degree = numerator.coeffs().len().max(denominator.coeffs().len()) - 1;
        let squares = [&numerator, &denominator].map(|p| modulus_squared(p, degree, shape));
        let products = product(&numerator, &denominator, degree, shape).into();
        let mirrored = Box::new([&numerator, &denominator].map(|p| mirrored_factor(p, shape)));
        Reduced { mirrored, ..Reduced::of_products(squares, products, shape.into()) }
    }

    /// From `|N|^2` and `|D0|^2`, and from twice the real part and the imaginary part of `N conj(D0)`.
    pub(super) fn of_products(
        [numerator_squared, denominator_squared]: [Poly<R>; 2],
        [twice_real, imaginary]: [Poly<R>; 2],
        frequencies: Frequencies,
    ) -> Reduced<R> {
        let sum = numerator_squared.plus(&denominator_squared);
        Reduced {
            sum_squared: sum.plus(&twice_real),
            difference_squared: sum.minus(&twice_real),
            frequencies,
            numerator_squared,
            denominator_squared,
            twice_real,
            imaginary,
            mirrored: Box::new([Poly::one(), Poly::one()]),
        }
    }

    /// The greatest common divisor of two products, or of one and its derivative: what is mirrored is in both, and without it the
    /// rest is short.
    pub fn common(&self, a: &Poly<R>, b: &Poly<R>) -> Poly<R> {
        let (mut a, mut b, mut known) = (a.clone(), b.clone(), Poly::one());
        for factor in self.mirrored.iter().filter(|factor| !factor.is_constant()) {
            while let (false, Some(x), Some(y)) = (b.is_zero(), a.div_exact(factor), b.div_exact(factor)) {
                (a, b, known) = (x, y, known.times(factor));
            }
        }
        known.times(&a.gcd(&b))
    }

    /// `|u D0 + v N|^2`.
    pub fn combined_squared(&self, u: &Integer, v: &Integer) -> Poly<R> {
        let scaled = |p: &Poly<R>, c: &Integer| p.scaled(&R::from_integer(c));
        scaled(&self.denominator_squared, &(u * u))
            .plus(&scaled(&self.twice_real, &(u * v)))
            .plus(&scaled(&self.numerator_squared, &(v * v)))
    }
}

/// The factor of a polynomial whose zeros are mirrored by others in the boundary, but for those at the ends of the range of `x`, as a polynomial in `x`.
fn mirrored_factor<R: Domain>(p: &Poly<R>, shape: Shape) -> Poly<R> {
    let at_zero = p.coeffs().iter().take_while(|c| c.is_zero()).count();
    let p = Poly::new(p.coeffs()[at_zero..].to_vec()).primitive_part();
    let mirror = match (p.degree(), shape) {
        (None, _) => return Poly::one(),
        (Some(degree), Shape::UnitDisc) => p.reversed(degree),
        (Some(_), Shape::LeftHalfPlane) => p.negated_argument(),
    };
    let mut factor = if mirror == p || mirror == p.negated() { p } else { p.gcd(&mirror).primitive_part() };
    let ends = [1, -1].map(|end| Poly::new(vec![R::from_integer(&Integer::from(-end)), R::one()]));
    for end in ends.iter().filter(|_| shape == Shape::UnitDisc) {
        while let Some(quotient) = factor.div_exact(end) {
            factor = quotient;
        }
    }
    match factor.degree() {
        Some(degree) if degree > 0 => HalfSizePair::new(&factor, degree, shape).a.primitive_part(),
        _ => Poly::one(),
    }
}

/// Polynomials without denominators, primitive together over the integers.
pub(super) fn without_denominators<const N: usize>(lists: [Vec<RationalFunction>; N]) -> [Poly<MultiPoly>; N] {
    let all = || lists.iter().flatten();
    let common = all().fold(MultiPoly::one(), |l, f| {
        let d = f.denominator();
        l.times(&d.div_exact(&l.gcd(d)).expect("a gcd divides"))
    });
    let cleared =
        |f: &RationalFunction| f.numerator().times(&common.div_exact(f.denominator()).expect("a common multiple"));
    let lists = lists.each_ref().map(|list| list.iter().map(cleared).collect::<Vec<_>>());
    let content = lists.iter().flatten().fold(Integer::ZERO, |g, c| g.gcd(&c.integer_content()));
    let divided = |c: &MultiPoly| c.div_exact_integer(&content).expect("the content divides");
    lists.map(|list| Poly::new(if content.is_zero() { list } else { list.iter().map(divided).collect() }))
}

/// Polynomials with integer coefficients, primitive together.
pub(crate) fn integral<const N: usize>(lists: [Vec<Rational>; N]) -> [UniPoly; N] {
    let all = || lists.iter().flatten();
    let denominator = all().fold(Integer::ONE, |l, c| l.lcm(&c.denominator()));
    let cleared = |c: &Rational| c.numerator() * denominator.div_exact(&c.denominator());
    let content = all().fold(Integer::ZERO, |g, c| g.gcd(&cleared(c)));
    let divided = |c: &Rational| if content.is_zero() { Integer::ZERO } else { cleared(c).div_exact(&content) };
    lists.each_ref().map(|list| Poly::new(list.iter().map(divided).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Poles and zeros on the circle and the axis, at its ends, repeated, and mirrored in them, against the plain divisor.
    #[test]
    fn common_factors_of_products_are_greatest_common_divisors() {
        let p = UniPoly::from_i64;
        let discrete = [
            [p(&[5, -8, 5]), p(&[-1, 1])],
            [p(&[5, -8, 5]).times(&p(&[5, -8, 5])), p(&[1, 1])],
            [p(&[2, -5, 2]), p(&[0, 0, 1])],
        ];
        let continuous = [
            [p(&[4, 0, 1]), p(&[0, 1])],
            [p(&[4, 0, 1]).times(&p(&[9, 0, 1])), p(&[-1, 0, 1])],
            [p(&[3]), p(&[0, 0, 1])],
        ];
        for (shape, cases) in [(Shape::UnitDisc, discrete), (Shape::LeftHalfPlane, continuous)] {
            for [special, other] in cases.iter().flat_map(|[a, b]| [[a, b], [b, a]]) {
                let denominator = special.times(other).times(&p(&[1, 3]));
                let r = Reduced::of(&p(&[2, 1]).times(other), &denominator, shape);
                let squares = [&r.numerator_squared, &r.denominator_squared];
                let pairs = squares.map(|s| [s.derivative(), s.clone()]);
                for [a, b] in pairs.into_iter().chain([[r.imaginary.clone(), r.twice_real.clone()]]) {
                    assert_eq!(r.common(&a, &b).primitive_part(), a.gcd(&b).primitive_part());
                }
            }
        }
        let r = Reduced::of(&p(&[1]), &p(&[-5, 13, -13, 5]), Shape::UnitDisc);
        assert_eq!(r.mirrored[1], p(&[-8, 5]));
    }
}
