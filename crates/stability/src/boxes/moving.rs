//! Characteristic polynomials whose coefficients contain functions of the parameters, as behind a hold.
//!
//! At a point they are polynomials with enclosed coefficients: the search works with the middles, and what it finds is counted
//! exactly by who asks. Boxes are proved in [`moving_prove`](super::moving_prove).

use super::family::{Family, Gradient, Path, pulls_of};
use super::line::{on_line, pair_function, rational_zero};
use super::look::BoxLook;
use super::moving_look::MovingLooks;
use super::polynomial::{BoxPolynomial, Bundle};
use super::prove::{Outcome, closed_by_constant, closed_by_vector, scale_of};
use crate::subdivision::BoxPart;
use crate::{AtPoint, Shape, is_hurwitz_routh};
use jurist_algebra::ball::{Ball, Elementary, Series};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::symbols::ParametricSymbols;
use std::collections::BTreeMap;

/// Bits after the point of coefficients at a point.
pub(super) const POINT_BITS: u64 = 256;

/// A box is cut into so many parts at most.
const MOST_PARTS: usize = 2000;

/// A characteristic polynomial in parameters and in symbols that depend on them.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::matrix::CharacteristicPolynomial;
/// use jurist_algebra::poly::RationalFunction;
/// use jurist_algebra::symbols::{Definition, ParametricSymbols};
/// use jurist_stability::Shape;
/// use jurist_stability::boxes::{MovingPolynomial, Side, ToleranceProblem};
/// // z - X + K (1 - X) with X = exp(-a): stable while K < (1 + X)/(1 - X), which is 2.16395... for a = 1
/// let [k, a, x] = [0, 1, 2].map(RationalFunction::variable);
/// let symbols = ParametricSymbols::new(vec![("X".into(), Definition::Exponential(-&a))]);
/// let d = CharacteristicPolynomial {
///     variables: ["K", "a", "X"].map(String::from).to_vec(),
///     coefficients: vec![&k - &(&x + &(&k * &x)), RationalFunction::one()],
///     formal_degree: 1,
///     poles: Vec::new(),
///     monic: true,
/// };
/// let p = MovingPolynomial::new(&d, 2, symbols, Shape::UnitDisc);
/// let sides = ["3/2", "1"].map(|v| v.parse().unwrap()).map(|v| Side::scaled(v, ["1/10", "1/10"].map(|w| w.parse().unwrap())));
/// let boxes = ToleranceProblem::new(&p, sides.to_vec()).unwrap();
/// let budget = Budget::unlimited();
/// assert!(boxes.decide(&1.into(), &budget)?.is_stable());
/// // 3/2 + f/10 = (1 + X)/(1 - X) with X = exp(-1 - f/10): f = 2.75...
/// let factor = boxes.largest_factor(&"1/1000".parse().unwrap(), None, &budget)?;
/// assert!(factor.lower > "2.7".parse().unwrap() && factor.upper.unwrap() < "2.8".parse().unwrap());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MovingPolynomial {
    /// In parameters and symbols.
    polynomial: BoxPolynomial,
    symbols: ParametricSymbols,
    /// Whether values of symbols are those of matrices: then each takes long.
    pub(super) is_of_matrices: bool,
    parameters: usize,
    /// The parameters that symbols depend on.
    pub(super) inside: Vec<usize>,
    /// Those of them that something is divided by.
    pub(super) below: Vec<usize>,
    /// The coefficients in the half plane, then what must not vanish, as polynomials in the other parameters: exponents of these,
    /// with polynomials in what is inside and in symbols.
    pub(super) functions: Vec<Vec<(Vec<u32>, MultiPoly)>>,
    /// The loop has a meaning where these polynomials in the parameters are positive.
    positive: Vec<MultiPoly>,
}

impl MovingPolynomial {
    /// Of a characteristic polynomial whose first variables are so many parameters, and whose others are symbols.
    ///
    /// Cost: that of [`BoxPolynomial::new`].
    pub fn new(
        d: &CharacteristicPolynomial,
        parameters: usize,
        symbols: ParametricSymbols,
        shape: Shape,
    ) -> MovingPolynomial {
        let polynomial = BoxPolynomial::over(d, d.variables.len(), shape);
        let mut inside = symbols.parameters_inside(parameters);
        if inside.is_empty() && parameters > 0 {
            // Taylor models have a variable.
            inside.push(0);
        }
        let split = |p: &MultiPoly| {
            let mut parts: BTreeMap<Vec<u32>, Vec<(Vec<u32>, Integer)>> = BTreeMap::new();
            for (monomial, c) in p.terms() {
                let (mut own, mut beside) = (monomial.exponents().to_vec(), vec![0; parameters]);
                for i in (0..parameters.min(own.len())).filter(|i| !inside.contains(i)) {
                    beside[i] = std::mem::take(&mut own[i]);
                }
                parts.entry(beside).or_default().push((own, c.clone()));
            }
            parts.into_iter().map(|(beside, terms)| (beside, MultiPoly::from_terms(terms))).collect()
        };
        let coefficients = polynomial.in_half_plane();
        let all = coefficients.iter().chain(polynomial.certain().iter().map(|(_, f)| f));
        let functions = all.map(split).collect();
        let below = symbols.parameters_below(parameters);
        let is_of_matrices = symbols.has_families();
        MovingPolynomial {
            polynomial,
            symbols,
            is_of_matrices,
            parameters,
            inside,
            below,
            functions,
            positive: Vec::new(),
        }
    }

    /// The same where the loop has a meaning only where these polynomials in the parameters, which are among the poles, are positive.
    pub fn defined_where_positive(self, positive: Vec<MultiPoly>) -> MovingPolynomial {
        MovingPolynomial { positive, ..self }
    }

    /// Whether the loop is seen to have a meaning at no point of a box.
    pub(super) fn has_no_meaning_in(&self, sides: &[[Rational; 2]]) -> bool {
        let zero = || Enclosure::from_rational(Rational::ZERO);
        let sides: Vec<Enclosure> = sides.iter().map(|[low, high]| Enclosure::new(low.clone(), high.clone())).collect();
        let value = |p: &MultiPoly| {
            p.terms().iter().fold(zero(), |sum, (monomial, c)| {
                let powers = monomial.exponents().iter().zip(&sides);
                let factors = powers.flat_map(|(&e, side)| std::iter::repeat_n(side, e as usize));
                let c = Enclosure::from_rational(c.clone().into());
                sum.add(&factors.fold(c, |product, side| product.mul(side, POINT_BITS)), POINT_BITS)
            })
        };
        self.positive.iter().any(|p| !value(p).upper().sign().is_gt())
    }

    pub(super) fn has_a_meaning_at(&self, point: &[Rational]) -> bool {
        self.positive.iter().all(|p| p.eval(point).sign().is_gt())
    }

    /// The degree the polynomial is meant to have.
    pub fn formal_degree(&self) -> usize {
        self.polynomial.formal_degree()
    }

    /// The number of coefficients in the half plane: the functions after them must not vanish.
    pub(super) fn coefficients(&self) -> usize {
        self.formal_degree() + 1
    }

    /// The functions of what is inside and of the symbols at enclosures of all parameters, in the order of their parts; `None`
    /// where something may not be defined.
    pub(super) fn parts_at<S: Elementary>(&self, parameters: &[S]) -> Option<Vec<Vec<S>>> {
        let values = self.symbols.values(parameters)?;
        let parts = |f: &Vec<(Vec<u32>, MultiPoly)>| f.iter().map(|(_, p)| self.symbols.value(p, &values)).collect();
        Some(self.functions.iter().map(parts).collect())
    }

    /// All functions at series of the parameters.
    fn series_at(&self, parameters: &[Series]) -> Option<Vec<Series>> {
        Some(self.series_of(parameters, &self.parts_at(parameters)?))
    }

    /// The functions from their parts.
    fn series_of(&self, parameters: &[Series], parts: &[Vec<Series>]) -> Vec<Series> {
        let whole = |(f, parts): (&Vec<(Vec<u32>, MultiPoly)>, &Vec<Series>)| {
            let zero = Series::constant(&Ball::zero(POINT_BITS), parameters[0].terms());
            f.iter().zip(parts).fold(zero, |sum, ((beside, _), part)| {
                let powers = beside.iter().zip(parameters).filter(|(e, _)| **e > 0);
                sum.add(&powers.fold(part.clone(), |product, (&e, x)| product.mul(&x.power(u64::from(e)))))
            })
        };
        self.functions.iter().zip(parts).map(whole).collect()
    }

    /// The middles of all functions at a point, in units of the last place.
    fn numbers(&self, point: &[Rational]) -> Option<Vec<Integer>> {
        checkpoint(1000);
        Some(self.series_at(&constants(point))?.iter().map(|s| s.coefficients()[0].middle_units()).collect())
    }

    /// What the functions have at a point that is inside of functions: parts that other parameters do not change.
    pub(super) fn parts_at_point(&self, point: &[Rational]) -> Option<Vec<Vec<Series>>> {
        checkpoint(1000);
        self.parts_at(&constants(point))
    }

    /// All functions at a point, enclosed, from these parts.
    pub(super) fn enclosed(&self, point: &[Rational], parts: &[Vec<Series>]) -> Vec<Ball> {
        let found = self.series_of(&constants(point), parts);
        found.iter().map(|s| s.coefficients()[0].clone()).collect()
    }

    /// Whether the loop is stable at a point; `None` where that is not seen, as where exponents are very large.
    pub(super) fn seen_at(&self, point: &[Rational]) -> Option<bool> {
        if !self.has_a_meaning_at(point) {
            return Some(false);
        }
        match self.numbers(point) {
            Some(numbers) => {
                let defined = numbers[self.coefficients()..].iter().all(|c| !c.is_zero());
                Some(defined && is_hurwitz_routh(&self.half_plane(&numbers)))
            }
            None => self.rational_divisors().any(|(_, p)| p.eval(point).is_zero()).then_some(false),
        }
    }

    /// What must not vanish, of that what is a polynomial in the parameters alone, with its place.
    fn rational_divisors(&self) -> impl Iterator<Item = (usize, &MultiPoly)> {
        let is_rational = |(_, p): &(usize, &MultiPoly)| p.variables().iter().all(|v| *v < self.parameters);
        self.polynomial.certain().iter().map(|(_, p)| p).enumerate().filter(is_rational)
    }

    fn half_plane(&self, numbers: &[Integer]) -> UniPoly {
        Poly::new(numbers[..self.coefficients()].to_vec())
    }

    /// All functions to first order around a point, in the differences from it.
    fn near(&self, point: &[Rational]) -> Option<Vec<Bundle>> {
        let ball = |x: &Rational| Ball::from_rational(x, POINT_BITS);
        let one = Ball::from_integer(&Integer::ONE, POINT_BITS);
        let zero = vec![0; self.parameters];
        let mut terms: Vec<Vec<(Vec<u32>, Integer)>> = vec![Vec::new(); self.functions.len()];
        for i in 0..self.parameters {
            let at = |(k, x): (usize, &Rational)| match k == i {
                true => Series::linear(&ball(x), &one, 2),
                false => Series::constant(&ball(x), 2),
            };
            let series: Vec<Series> = point.iter().enumerate().map(at).collect();
            for (own, s) in terms.iter_mut().zip(self.series_at(&series)?) {
                if i == 0 {
                    own.push((zero.clone(), s.coefficients()[0].middle_units()));
                }
                let mut exponents = zero.clone();
                exponents[i] = 1;
                own.push((exponents, s.coefficients()[1].middle_units()));
            }
        }
        let polynomials = terms.into_iter().map(MultiPoly::from_terms);
        let parameters = self.parameters;
        Some(polynomials.map(|p| Bundle { degrees: vec![1; parameters], ..Bundle::new(&[&p], parameters) }).collect())
    }

    /// The pair of functions to first order.
    fn pair_of(&self, near: &[Bundle]) -> Bundle {
        let n = self.coefficients();
        let mut terms: BTreeMap<Vec<u32>, Vec<Integer>> = BTreeMap::new();
        for (k, bundle) in near[..n].iter().enumerate() {
            for (exponents, c) in &bundle.terms {
                terms.entry(exponents.clone()).or_insert_with(|| vec![Integer::ZERO; n])[k] = c[0].clone();
            }
        }
        Bundle { width: n, degrees: vec![1; self.parameters], terms: terms.into_iter().collect() }.pair()
    }
}

fn constants(point: &[Rational]) -> Vec<Series> {
    point.iter().map(|x| Series::constant(&Ball::from_rational(x, POINT_BITS), 1)).collect()
}

impl Family for MovingPolynomial {
    type Line<'a> = MovingLine<'a>;

    fn parameters(&self) -> usize {
        self.parameters
    }

    fn count(&self, _point: &[Rational]) -> Option<AtPoint> {
        None
    }

    fn is_stable_at(&self, point: &[Rational]) -> bool {
        self.seen_at(point) == Some(true)
    }

    fn signs_at(&self, point: &[Rational]) -> Option<(Vec<Sign>, i64)> {
        let numbers = self.numbers(point)?;
        let signs: Vec<Sign> = numbers[self.coefficients()..].iter().map(Integer::sign).collect();
        (!signs.contains(&Sign::Equal)).then(|| (signs, scale_of(&numbers[..self.coefficients()])))
    }

    fn line<'a>(&'a self, base: Vec<Rational>, step: Vec<Rational>, reference: &'a [Sign]) -> MovingLine<'a> {
        MovingLine { p: self, base, step, reference }
    }

    fn pulls(&self, point: &[Rational], scale: i64) -> Vec<Vec<Rational>> {
        let Some(near) = self.near(point) else { return Vec::new() };
        let [zero, one] = [Integer::ZERO, Integer::ONE].map(|n| vec![n; self.parameters]);
        pulls_of(&near[self.coefficients()..], &self.pair_of(&near), (&zero, &one), scale)
    }

    fn prove(
        &self,
        sides: &[[Rational; 2]],
        known: (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        let cells = cells.min(MOST_PARTS);
        match self.proved(sides, known, (&closed_by_constant, cells), budget)? {
            Outcome::Open { .. } => self.proved(sides, known, (&closed_by_vector, cells), budget),
            outcome => Ok(outcome),
        }
    }

    fn looks(&self) -> impl Fn(&BoxPart, &Budget) -> Result<BoxLook, Exhausted> {
        let known = MovingLooks::of(self);
        move |part, budget| budget.enter(|| known.look(&part.sides, budget))?
    }
}

/// The loop on the line `base + t step`.
pub struct MovingLine<'a> {
    p: &'a MovingPolynomial,
    base: Vec<Rational>,
    step: Vec<Rational>,
    reference: &'a [Sign],
}

impl Path for MovingLine<'_> {
    fn point(&self, t: &Rational) -> Vec<Rational> {
        self.base.iter().zip(&self.step).map(|(b, s)| b + &(s * t)).collect()
    }

    fn is_good(&self, t: &Rational) -> bool {
        let point = self.point(t);
        let Some(numbers) = self.p.numbers(&point) else {
            // Not seen: as far as the divisors tell.
            let mut divisors = self.p.rational_divisors();
            return divisors.all(|(k, p)| p.eval(&point).sign() == self.reference[k]);
        };
        let certain = numbers[self.p.coefficients()..].iter().zip(self.reference);
        certain.into_iter().all(|(c, sign)| c.sign() == *sign) && is_hurwitz_routh(&self.p.half_plane(&numbers))
    }

    fn is_stable(&self, t: &Rational) -> bool {
        self.p.is_stable_at(&self.point(t))
    }

    /// A point at which a divisor vanishes is taken before one beyond it, where exponents may be very large.
    fn witness(&self, lo: &Rational, hi: &Rational) -> Option<Vec<Rational>> {
        let candidate = |t: &Rational| Some(self.point(t)).filter(|point| self.p.seen_at(point) == Some(false));
        let divisors = self.p.rational_divisors().map(|(_, f)| {
            let [f, _] = on_line([f, &MultiPoly::one()], &self.base, &self.step);
            rational_zero(&f, lo, hi)
        });
        divisors.flatten().min().as_ref().and_then(candidate).or_else(|| candidate(hi))
    }

    fn gradient(&self, lo: &Rational, hi: &Rational) -> Option<Gradient> {
        let point = self.point(&lo.midpoint(hi));
        let near = self.p.near(&point)?;
        let n = self.p.coefficients();
        let beyond = self.p.numbers(&self.point(hi))?;
        let changed = beyond[n..].iter().zip(self.reference).position(|(c, sign)| c.sign() != *sign);
        let function = match changed {
            Some(k) => near[n + k].clone(),
            None => pair_function(&self.p.half_plane(&self.p.numbers(&point)?), &self.p.pair_of(&near))?,
        };
        let [zero, one] = [Integer::ZERO, Integer::ONE].map(|n| vec![n; point.len()]);
        Gradient::new(function.gradient(&zero, &one), &self.step)
    }
}
