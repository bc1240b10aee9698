//! Values of a parameter at which an open loop `N/D exp(-tau s)` may begin or cease to meet a requirement, where the parameter is in `N` and `D` to the first
//! power at most.
//!
//! Both conditions of such a value, as that the distance to a circle is zero and so is its derivative by the frequency, are polynomials of degree 2 in the
//! parameter. It is eliminated: what is left is a function of the frequency, its cosine and its sine, whose zeros are isolated as those of the margins are.

use super::any_quotient::AnyQuotient;
use super::complex_poly::{ComplexPoly, take_common};
use super::delayed_axis::{DelayedAxis, without_squares_of_sine};
use super::delayed_peak::{DelayedQuotient, frequencies_of};
use super::enclosed::{enclosed, within};
use super::ground::{Constants, Ground};
use super::loop_functions::number_asked;
use super::requirement::{Circle, Rule};
use crate::coverage::refusals::ONE_FACTOR;
use crate::error::Error;
use crate::model::Symbols;
use crate::stability::{Range, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::Definition;
use std::sync::Arc;

/// A polynomial of degree 2 in the parameter, with functions on the axis as coefficients, from the constant term up.
type Quadratic = [MultiPoly; 3];

/// `D0 + K D1` or `N0 + K N1`.
type Affine = [ComplexPoly<MultiPoly>; 2];

/// The open loop in the parameter.
pub(super) struct DelayedAffine {
    tau: Rational,
    denominator: Affine,
    numerator: Affine,
    symbols: jurist_algebra::symbols::Symbols,
}

/// The open loop beside the number that a rule asks for.
struct OnAxis<'a> {
    axis: DelayedAxis<Constants>,
    of: &'a DelayedAffine,
    /// The number: as one, or as a symbol.
    number: (MultiPoly, Integer),
    /// `|D|^2`, `|N|^2`, and twice the real and the imaginary part of `N conj(D) exp(-j omega tau)`.
    below: Quadratic,
    above: Quadratic,
    twice_real: Quadratic,
    twice_imaginary: Quadratic,
    /// What is zero where `D` or `N` is, whatever the parameter is.
    fixed: Poly<MultiPoly>,
}

impl DelayedAffine {
    /// Of a quotient in the parameter (variable 0) and the symbols behind it; `None` where the parameter is there in another way.
    ///
    /// # Errors
    /// `E-dead-time` where not one factor alone has the dead time, and beside other functions of the parameter.
    pub fn of(quotient: &AnyQuotient<MultiPoly>, symbols: &Symbols) -> Result<Option<DelayedAffine>, Error> {
        let [re, im, above_re, above_im] = quotient.lists();
        let delays = symbols.delays();
        let (mut tau, mut factor) = (Rational::ZERO, MultiPoly::one());
        let numerator = || above_re.iter().chain(above_im);
        for (variable, time) in &delays {
            let powers = numerator().flat_map(MultiPoly::terms).map(|(m, _)| m.exponent(*variable));
            let least = powers.min().unwrap_or(0);
            let Some(time) = time.as_constant() else { return Ok(None) };
            tau += time * Rational::from(i64::from(least));
            factor = factor.times(&MultiPoly::variable(*variable).power(u64::from(least)));
        }
        let without = |list: &[MultiPoly]| -> Vec<MultiPoly> {
            list.iter().map(|c| c.div_exact(&factor).expect("each term has the factor")).collect()
        };
        let lists = [re.to_vec(), im.to_vec(), without(above_re), without(above_im)];
        let has_delay = |p: &MultiPoly| delays.iter().any(|(variable, _)| p.degree_in(*variable) > 0);
        if tau.is_zero() || lists.iter().flatten().any(has_delay) {
            return Err(ONE_FACTOR.diagnostic(&[]).into());
        }
        if lists.iter().flatten().any(|p| p.degree_in(0) > 1) {
            return Ok(None);
        }
        let part = |list: &[MultiPoly], k: usize| {
            Poly::new(list.iter().map(|c| c.as_poly_in(0).coeff(k).map_variables(|i| i - 1)).collect())
        };
        let [denominator, numerator] =
            [0, 2].map(|i| [0, 1].map(|k| ComplexPoly { re: part(&lists[i], k), im: part(&lists[i + 1], k) }));
        let symbols = jurist_algebra::symbols::Symbols::clone(&Constants::beside_delays(symbols)?.0);
        Ok(Some(DelayedAffine { tau, denominator, numerator, symbols }))
    }

    /// The values up to a size at which a requirement may begin or cease to be met, each with whether a crossing may appear there at once; `None` where that is
    /// not told.
    ///
    /// Cost: the zeros of one function of the frequency for each condition.
    pub fn values(
        &self,
        rule: &Rule,
        most: &Rational,
        budget: &Budget,
    ) -> Result<Option<Vec<(Real, bool)>>, Exhausted> {
        let Some(least) = least_modulus(rule) else { return Ok(None) };
        let of = budget.enter(|| OnAxis::new(self, &number_asked(rule)))?;
        let end = of.end(&least, most, budget)?;
        let mut out = Vec::new();
        for ([first, second], is_touch) in of.conditions(rule) {
            match budget.enter(|| eliminated(first, second))? {
                Common::At(function, root) => {
                    for omega in of.zeros(&function, &end, budget)? {
                        out.extend(of.roots(&root, &omega, budget)?.into_iter().map(|value| (value, is_touch)));
                    }
                }
                Common::Nowhere => {}
                Common::NotTold => return Ok(None),
            }
        }
        Ok(Some(out))
    }
}

impl DelayedAffine {
    /// Whether the open loop keeps to its side of a circle with a value at which it does not touch it; `None` for another rule, and where that is not told. Its
    /// peak at that value is not needed, which may be one of several that coincide.
    ///
    /// Cost: the zeros of one function of the frequency.
    pub fn keeps_to(&self, rule: &Rule, value: &Rational, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        let (Rule::Circle(circle), Some(least)) = (rule, least_modulus(rule)) else { return Ok(None) };
        let of = budget.enter(|| OnAxis::new(self, &number_asked(rule)))?;
        let [constant, linear, square] = of.excess(circle);
        let [up, down] = [value.numerator(), value.denominator()];
        let at = constant.scaled_by(&(&down * &down)).plus(&linear.scaled_by(&(&up * &down)));
        let at = at.plus(&square.scaled_by(&(&up * &up)));
        let end = of.end(&least, &value.abs(), budget)?;
        Ok(Some(of.zeros(&at, &end, budget)?.is_empty()))
    }
}

/// The least modulus of an open loop that is at the edge of what a rule asks for; `None` where smaller ones may be.
fn least_modulus(rule: &Rule) -> Option<Rational> {
    match rule {
        Rule::Circle(circle) => {
            // |1 + L| >= 1 - |L| and |u + v L| <= |u| + |v| |L|
            let [u, v] = circle.combined().map(|c| Rational::from(c.abs()));
            let room = &Rational::ONE - &(circle.least() * &u);
            (&room / &(&Rational::ONE + &(circle.least() * &v))).into()
        }
        Rule::Turned { .. } => Some(Rational::ONE),
        Rule::Factors(factor) => Real::from(factor.clone()).refined_to_digits(3).enclosure().1.recip(),
        Rule::Sector(_) | Rule::Modulus { .. } | Rule::DeadTime(_) => None,
    }
    .filter(|least: &Rational| least.sign().is_gt())
}

impl<'a> OnAxis<'a> {
    fn new(of: &'a DelayedAffine, number: &RealAlgebraic) -> OnAxis<'a> {
        let mut symbols = of.symbols.clone();
        let number = match number.exact() {
            Some(x) => (MultiPoly::constant(x.numerator()), x.denominator()),
            None => {
                symbols.push("alpha", Definition::Algebraic(number.clone()));
                (MultiPoly::variable(BEFORE + symbols.len() - 1), Integer::ONE)
            }
        };
        let along = |affine: &Affine| affine.each_ref().map(|p| p.along(0, Shape::LeftHalfPlane));
        let (d, n) = (along(&of.denominator), along(&of.numerator));
        let frequencies = frequencies_of(of.denominator.iter().chain(&of.numerator));
        let axis = DelayedAxis::new(&Constants(Arc::new(symbols)), of.tau.clone(), frequencies);
        let products = |a: &Affine, b: &Affine| {
            let [ab, ba] = [a[1].times_conjugate(&b[0]), a[0].times_conjugate(&b[1])];
            let mixed = [ab[0].plus(&ba[0]), ab[1].plus(&ba[1])];
            [a[0].times_conjugate(&b[0]), mixed, a[1].times_conjugate(&b[1])]
        };
        let square = |p: &Affine| products(p, p).map(|[re, _]| axis.of_omega(&re));
        let turned = products(&n, &d).map(|p| axis.turned(&p, 1).map(|p| p.scaled_by(&Integer::from(2))));
        let [twice_real, twice_imaginary] = [0, 1].map(|i| turned.each_ref().map(|p| p[i].clone()));
        let fixed = [&d, &n].map(|p| take_common(&mut p.to_vec()));
        let fixed = fixed[0].times(&fixed[1]);
        OnAxis { below: square(&d), above: square(&n), twice_real, twice_imaginary, axis, of, number, fixed }
    }

    /// Pairs of polynomials in the parameter that have a common root where a requirement may begin or cease to be met, and whether a crossing appears there.
    fn conditions(&self, rule: &Rule) -> Vec<([Quadratic; 2], bool)> {
        let (up, down) = &self.number;
        let down = MultiPoly::constant(down.clone());
        let slope = |p: &Quadratic| p.each_ref().map(|c| self.axis.derivative(c));
        let two = MultiPoly::from(2);
        match rule {
            Rule::Circle(circle) => {
                let excess = self.excess(circle);
                let slope = slope(&excess);
                vec![([excess, slope], false)]
            }
            Rule::Turned { .. } => {
                let modulus = sum(&self.above, &scaled(&self.below, &MultiPoly::from(-1)));
                let angle = sum(&scaled(&self.twice_real, &down), &scaled(&self.below, up));
                let slope = slope(&modulus);
                vec![([modulus.clone(), angle], false), ([modulus, slope], true)]
            }
            Rule::Factors(_) => {
                let real = self.twice_imaginary.clone();
                let twice_below = scaled(&self.below, &two);
                let crossing =
                    |a: &MultiPoly, b: &MultiPoly| sum(&scaled(&twice_below, a), &scaled(&self.twice_real, b));
                let slope = slope(&real);
                vec![
                    ([real.clone(), crossing(&down, up)], false),
                    ([real.clone(), crossing(up, &down)], false),
                    ([real, slope], true),
                ]
            }
            Rule::Sector(_) | Rule::Modulus { .. } | Rule::DeadTime(_) => Vec::new(),
        }
    }

    /// What is negative where the condition of a circle is violated.
    fn excess(&self, circle: &Circle) -> Quadratic {
        let [a, b, c] = circle.coefficients().map(MultiPoly::constant);
        sum(&sum(&scaled(&self.above, &a), &scaled(&self.twice_real, &b)), &scaled(&self.below, &c))
    }

    /// A frequency beyond which the modulus of the open loop is below a number, for all values of the parameter up to a size.
    fn end(&self, least: &Rational, most: &Rational, budget: &Budget) -> Result<Rational, Exhausted> {
        let [up, down] = [most.numerator(), most.denominator()].map(MultiPoly::constant);
        let sizes = |[fixed, moving]: &Affine| vec![fixed.scaled(&down), moving.scaled(&up)];
        let (above, below) = (sizes(&self.of.numerator), sizes(&self.of.denominator));
        DelayedQuotient::new(self.axis.ground(), self.of.tau.clone(), above, below).end(least, budget)
    }

    /// The zeros of a function up to a frequency, without those that `D` or `N` has whatever the parameter is.
    fn zeros(&self, function: &MultiPoly, end: &Rational, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        let [function, rest] = budget.enter(|| self.split(&without_squares_of_sine(function)))?;
        let in_frequency = rest.as_poly_in(0).map(|c| c.map_variables(|i| i - BEFORE));
        let mut zeros = self.axis.ground().zeros(&in_frequency, &Range::all(), budget)?;
        let own = |exponents: &[u32]| exponents.get(BEFORE..).unwrap_or(&[]).to_vec();
        let at_rest = function.terms().iter().filter(|(m, _)| m.exponent(0) == 0 && m.exponent(2) == 0);
        let at_rest = MultiPoly::from_terms(at_rest.map(|(m, c)| (own(m.exponents()), c.clone())));
        if self.axis.ground().sign(&at_rest, budget)?.is_eq() {
            zeros.push(Real::from(Rational::ZERO));
        }
        zeros.extend(self.axis.zeros(&function, end, budget)?);
        Ok(zeros)
    }

    /// A function as a product of one without factors in the frequency alone, and of such a factor without multiple zeros, without those of `D` or `N`.
    fn split(&self, function: &MultiPoly) -> [MultiPoly; 2] {
        type Terms = Vec<(Vec<u32>, Integer)>;
        let mut groups: Vec<([u32; 2], Terms)> = Vec::new();
        for (monomial, c) in function.terms() {
            let key = [monomial.exponent(1), monomial.exponent(2)];
            let mut own = monomial.exponents().to_vec();
            own.iter_mut().take(BEFORE).skip(1).for_each(|e| *e = 0);
            match groups.iter_mut().find(|(known, _)| *known == key) {
                Some((_, terms)) => terms.push((own, c.clone())),
                None => groups.push((key, vec![(own, c.clone())])),
            }
        }
        let parts = groups.into_iter().map(|(_, terms)| MultiPoly::from_terms(terms));
        let content = parts.fold(MultiPoly::zero(), |g, p| g.gcd(&p));
        if content.degree_in(0) == 0 {
            return [function.clone(), MultiPoly::one()];
        }
        let mut rest = content.as_poly_in(0).square_free_part();
        let fixed = self.fixed.map(|c| c.map_variables(|i| i + BEFORE));
        loop {
            let common = rest.gcd(&fixed);
            if common.is_constant() {
                break;
            }
            rest = rest.div_exact(&common).expect("a gcd divides");
        }
        [function.div_exact(&content).expect("the content divides"), MultiPoly::from_poly_in(&rest, 0)]
    }

    /// The values at a frequency.
    fn roots(&self, root: &Root, omega: &Real, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        match root {
            Root::Quotient([above, below]) => Ok(vec![self.axis.quotient(above, below, omega)]),
            Root::Both([c, b, a]) => {
                let discriminant = b.times(b).minus(&a.times(c).scaled_by(&Integer::from(4)));
                let discriminant = self.axis.quotient(&discriminant, &MultiPoly::one(), omega);
                if budget.enter(|| discriminant.sign())?.is_lt() {
                    return Ok(Vec::new());
                }
                let two = MultiPoly::from(2);
                let middle = self.axis.quotient(&b.negated(), &a.times(&two), omega);
                let below = self.axis.quotient(&MultiPoly::one(), &a.times(&two), omega);
                let root = |sign: i64| {
                    let (discriminant, middle, below) = (discriminant.clone(), middle.clone(), below.clone());
                    enclosed("value at a frequency", move |bits| {
                        let root = within(&discriminant, bits).sqrt(bits);
                        let root = if sign < 0 { root.neg() } else { root };
                        Some(within(&middle, bits).add(&root.mul(&within(&below, bits), bits), bits))
                    })
                };
                Ok(vec![root(-1), root(1)])
            }
        }
    }
}

/// Variables before the symbols: the frequency, its cosine and its sine.
const BEFORE: usize = 3;

fn sum(a: &Quadratic, b: &Quadratic) -> Quadratic {
    [0, 1, 2].map(|i| a[i].plus(&b[i]))
}

fn scaled(a: &Quadratic, by: &MultiPoly) -> Quadratic {
    a.each_ref().map(|c| c.times(by))
}

/// A common root of two polynomials in the parameter.
enum Root {
    /// A quotient.
    Quotient([MultiPoly; 2]),
    /// Both roots of a polynomial of degree 2.
    Both(Quadratic),
}

/// Where two polynomials in the parameter have a common root other than 0.
enum Common {
    /// Where a function of the frequency is zero.
    At(MultiPoly, Root),
    Nowhere,
    NotTold,
}

/// The common root of two polynomials in the parameter.
fn eliminated(first: Quadratic, second: Quadratic) -> Common {
    let [first, second] = [first, second].map(without_zero);
    let degree = |p: &Quadratic| p.iter().rposition(|c| !c.is_zero());
    let (Some(m), Some(n)) = (degree(&first), degree(&second)) else { return Common::NotTold };
    let (low, high) = if m <= n { (first, second) } else { (second, first) };
    let ([c, b, a], [f, e, d]) = (&low, &high);
    let times = |x: &MultiPoly, y: &MultiPoly| x.times(y);
    let quotient = |above: &MultiPoly, below: &MultiPoly| Root::Quotient([above.negated(), below.clone()]);
    match (m.min(n), m.max(n)) {
        (0, 0) => Common::Nowhere,
        (0, 1) => Common::At(c.clone(), quotient(f, e)),
        (0, _) => Common::At(c.clone(), Root::Both(high)),
        (1, 1) => Common::At(times(b, f).minus(&times(e, c)), quotient(c, b)),
        (1, _) => {
            // d c^2 - e b c + f b^2
            let value = times(d, &times(c, c)).minus(&times(e, &times(b, c))).plus(&times(f, &times(b, b)));
            Common::At(value, quotient(c, b))
        }
        _ => {
            let outer = times(a, f).minus(&times(d, c));
            // In the square of the parameter.
            if b.is_zero() && e.is_zero() {
                return Common::At(outer, Root::Both(low));
            }
            let [upper, lower] = [times(a, e).minus(&times(d, b)), times(b, f).minus(&times(e, c))];
            let value = times(&outer, &outer).minus(&times(&upper, &lower));
            Common::At(value, quotient(&outer, &upper))
        }
    }
}

/// A polynomial without the root 0.
fn without_zero(mut p: Quadratic) -> Quadratic {
    while p[0].is_zero() && !(p[1].is_zero() && p[2].is_zero()) {
        p.rotate_left(1);
    }
    p
}
