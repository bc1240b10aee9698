//! Open loops with complex coefficients: over frequencies of either sign.

use super::complex_poly::ComplexPoly;
use super::enclosed::{enclosed, within};
use super::ground::{Constants, Ground, Integers};
use super::open_loop::{Over, constants_of, without_delay};
use super::parts::{Parts, Reduced, without_denominators};
use super::{Frequencies, GainMargin};
use crate::answer::Sides;
use crate::error::Error;
use crate::model::{ComplexPolynomial, Time};
use crate::problem::{Beside, Region, fixed_symbols};
use crate::stability::{ComplexPair, Range, Shape, Side, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};
use jurist_algebra::real::Real;
use std::cmp::Ordering;
use std::sync::Arc;

impl Over {
    /// From the real and the imaginary parts of the denominator's coefficients, and of the numerator's. Their symbols are constants. Where no imaginary part
    /// is left it is a real loop.
    pub(super) fn of_complex(
        lists: [Vec<RationalFunction>; 4],
        poles: Vec<Poly<MultiPoly>>,
        symbols: &crate::model::Symbols,
        shape: Shape,
    ) -> Result<(Over, Option<Rational>), Error> {
        if lists[1].iter().chain(&lists[3]).all(RationalFunction::is_zero) {
            let [denominator, _, numerator, _] = lists;
            return Over::new(denominator, numerator, poles, symbols, shape);
        }
        let [re, im, numerator_re, numerator_im] = without_denominators(lists);
        let (numerator, dead_time) = without_delay([&re, &im], [numerator_re, numerator_im], symbols)?;
        let [numerator_re, numerator_im] = numerator;
        let lists = [re, im, numerator_re, numerator_im];
        let is_rational = |p: &Poly<MultiPoly>| p.coeffs().iter().all(MultiPoly::is_constant);
        let over = if lists.iter().chain(&poles).all(is_rational) {
            let plain = |p: &Poly<MultiPoly>| p.map(|c| c.as_constant().expect("every parameter has a value"));
            let poles = poles.iter().map(plain).collect();
            Over::Integers(Parts::complex(Integers, lists.each_ref().map(plain), poles, shape))
        } else {
            let ground = constants_of(&poles, symbols)?;
            Over::Constants(Parts::complex(ground, lists, poles, shape))
        };
        Ok((over, dead_time))
    }
}

impl<G: Ground> Parts<G> {
    /// From the real and the imaginary parts of the denominator's coefficients, and of the numerator's.
    pub(super) fn complex(
        ground: G,
        [re, im, numerator_re, numerator_im]: [Poly<G::Number>; 4],
        poles: Vec<Poly<G::Number>>,
        shape: Shape,
    ) -> Parts<G> {
        let denominator = ComplexPoly { re, im };
        let numerator = ComplexPoly { re: numerator_re, im: numerator_im };
        let reduced = Reduced::complex(&numerator, &denominator, shape);
        Parts { ground, denominator, numerator, poles, shape, reduced }
    }
}

impl<R: Domain> Reduced<R> {
    /// A common factor of both polynomials is one of all four products, and all that these have in common is its square.
    pub(super) fn complex(numerator: &ComplexPoly<R>, denominator: &ComplexPoly<R>, shape: Shape) -> Reduced<R> {
        let degree = numerator.len().max(denominator.len()) - 1;
        let [n, d] = [numerator, denominator].map(|p| p.along(degree, shape));
        let [real, imaginary] = n.times_conjugate(&d);
        let all = [n.squared(), d.squared(), real, imaginary];
        let common = all.iter().fold(Poly::zero(), |g: Poly<R>, p| g.gcd(p));
        let [above, below, real, imaginary] =
            all.map(|p| if common.is_zero() { p } else { p.div_exact(&common).expect("a gcd divides") });
        let twice_real = real.scaled(&R::from_integer(&Integer::from(2)));
        Reduced::of_products([above, below], [twice_real, imaginary], Frequencies::Signed(shape))
    }
}

impl GainMargin {
    /// The ends of a complex loop's stable factors, named by its own roots.
    pub(super) fn sided<G: Ground>(parts: &Parts<G>, set: &mut StableSet, budget: &Budget) -> Result<(), Exhausted> {
        let powers = |d: &Poly<G::Number>, n: &Poly<G::Number>| {
            let of = |i| parts.ground.in_factor(&Poly::new(vec![d.coeff(i), n.coeff(i)]));
            (0..parts.denominator.len().max(parts.numerator.len())).map(of).collect::<Vec<_>>()
        };
        let (d, n) = (&parts.denominator, &parts.numerator);
        let whole = ComplexPolynomial::new(powers(&d.re, &n.re), powers(&d.im, &n.im));
        let time = match parts.shape {
            Shape::UnitDisc => Time::Discrete,
            Shape::LeftHalfPlane => Time::Continuous,
        };
        let sides = Sides::new(whole, Beside::symbols(parts.ground.beside_factor()), Region::of(time));
        let sides = sides.expect("without dead time nothing divides by a delay");
        for end in set.ends_mut() {
            budget.enter(|| sides.name(end))?;
        }
        Ok(())
    }
}

/// The root of lowest frequency on the boundary, of those that are not real, of a polynomial with complex coefficients in symbols: with the side that it is
/// on. `None` where no identity shows one.
///
/// Cost: Euclid's algorithm and the zeros of one polynomial.
pub(crate) fn root_on_boundary(
    whole: &ComplexPolynomial,
    symbols: &crate::model::Symbols,
    shape: Shape,
    budget: &Budget,
) -> Result<Option<ComplexPair>, Error> {
    let [re, im] = without_denominators([whole.re.clone(), whole.im.clone()]);
    let is_rational = |p: &Poly<MultiPoly>| p.coeffs().iter().all(MultiPoly::is_constant);
    let found = if is_rational(&re) && is_rational(&im) {
        let plain = |p: &Poly<MultiPoly>| p.map(|c| c.as_constant().expect("it is a number"));
        lowest_root(&Integers, ComplexPoly { re: plain(&re), im: plain(&im) }, shape, budget)?
    } else {
        lowest_root(&Constants(Arc::new(fixed_symbols(symbols)?)), ComplexPoly { re, im }, shape, budget)?
    };
    let Some((t, side)) = found else { return Ok(None) };
    let pair = match shape {
        Shape::UnitDisc => ComplexPair::at_half_size_root(
            shape,
            enclosed("twice the cosine of an angle", move |bits| {
                // 2 (1 - t^2)/(1 + t^2)
                let (t, one) = (within(&t, bits), Enclosure::from_rational(Rational::ONE));
                let square = t.mul(&t, bits);
                let cosine = one.sub(&square, bits).div(&one.add(&square, bits), bits)?;
                Some(cosine.mul(&Enclosure::from_rational(Rational::from(2)), bits))
            }),
        ),
        Shape::LeftHalfPlane => ComplexPair::at_angular_frequency(enclosed("the size of a frequency", move |bits| {
            let rate = within(&t, bits);
            Some(if rate.upper().is_negative() { rate.neg() } else { rate })
        })),
    };
    Ok(Some(pair.on_side(side)))
}

fn lowest_root<G: Ground>(
    ground: &G,
    p: ComplexPoly<G::Number>,
    shape: Shape,
    budget: &Budget,
) -> Result<Option<(Real, Side)>, Exhausted> {
    if p.is_zero() {
        return Ok(None);
    }
    let along = p.along(p.len() - 1, shape);
    let common = budget.enter(|| along.re.gcd(&along.im))?;
    lowest_zero(ground, &common, budget)
}

/// The zero of smallest size of a polynomial in the variable of signed frequencies, of those that are not 0, and whether the opposite one is one, too.
pub(super) fn lowest_zero<G: Ground>(
    ground: &G,
    p: &Poly<G::Number>,
    budget: &Budget,
) -> Result<Option<(Real, Side)>, Exhausted> {
    let zeros = ground.zeros(p, &Range::all(), budget)?;
    let size = |t: &Real| {
        let (lo, hi) = t.refined_to_digits(DIGITS).enclosure();
        lo.midpoint(&hi).abs()
    };
    let lowest = budget.enter(|| zeros.into_iter().filter(|t| t.sign().is_ne()).min_by_key(size))?;
    let Some(t) = lowest else { return Ok(None) };
    let both = budget.enter(|| p.gcd(&p.negated_argument()))?;
    let side = match budget.enter(|| t.sign())? {
        _ if ground.sign_at(&both, &t, budget)?.is_eq() => Side::Both,
        Ordering::Less => Side::Lower,
        _ => Side::Upper,
    };
    Ok(Some((t, side)))
}

/// Digits by which two frequencies are told apart; one of them is named.
const DIGITS: usize = 17;
