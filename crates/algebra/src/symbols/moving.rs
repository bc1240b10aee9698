//! Symbols that depend on a parameter, such as `exp(-2*T)` in `T`, and the zeros of polynomials in the parameter and in them.

mod search;

use super::forms::Forms;
use super::function::polynomial_at;
use super::horner::Scheme;
use super::moving_root::MovingRoot;
use super::pieces::{self, Look, Piece};
use super::scales::{between_scales, joined};
use super::values::values_of;
use super::{Definition, Function, Symbols};
use crate::ball::{Ball, Elementary, Known, Series, TaylorModel};
use crate::limits::{Budget, Exhausted};
use crate::number::{Enclosure, Integer, Rational, Sign};
use crate::poly::algebraic::simplest_between;
use crate::poly::real_roots::rational_roots;
use crate::poly::{
    Domain, MultiPoly, RationalFunction, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots, isolate_real_roots_in,
};
use crate::real::{Enclosing, Real, Transcendental};
use search::Search;
use std::sync::{Arc, OnceLock};

/// A table of symbols whose arguments are rational functions of a parameter (variable 0) and of earlier symbols (symbol `i` is
/// variable `i + 1`).
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
/// use jurist_algebra::symbols::{Definition, MovingSymbols};
/// use std::sync::{Arc, OnceLock};
/// // exp(-T) - T = 0
/// let minus = -&RationalFunction::variable(0);
/// let symbols = Arc::new(MovingSymbols::new(vec![("X".into(), Definition::Exponential(minus))]));
/// let p = MultiPoly::variable(1).minus(&MultiPoly::variable(0));
/// let (zero, one) = (Rational::ZERO, Rational::ONE);
/// let found = symbols.zeros_in(&p.into(), &zero, &one, &one, &Budget::unlimited()).unwrap();
/// assert_eq!(found.zeros[0].decimal(20), "0.56714329040978387300");
/// assert!(found.zeros.len() == 1 && found.undecided.is_empty());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MovingSymbols {
    table: Vec<(String, Definition)>,
}

/// The zeros of a function in an interval.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Zeros {
    /// Zeros at which the function changes its sign with a derivative that is not zero, ascending.
    pub zeros: Vec<Real>,
    /// Short intervals that may have zeros, ascending; elsewhere there are no others.
    pub undecided: Vec<(Rational, Rational)>,
}

/// Terms of the Taylor polynomials; halving an interval makes what is left out 2^12 times smaller.
pub(super) const TERMS: usize = 12;

/// Bits of the first attempt, with short numbers.
const FEW_BITS: u64 = 112;

/// Bits of the first attempt with others.
pub(super) const FIRST_BITS: u64 = 192;

/// How often the bits are doubled for one interval.
const MOST_DOUBLINGS: usize = 4;

/// The enclosure of an irrational end of a part is shorter than the range by so many bits.
const GAP_BITS: u64 = 64;

/// Zeros that are fractions with fewer bits are recognised as such, those with few bits first.
const SHORT_BITS: [u64; 2] = [40, 128];

/// An interval this much shorter than the first one is given up.
pub(super) const MOST_HALVINGS: i64 = 56;

/// The parts of a range in which square roots have no negative arguments. Both lists are ascending; each pair is a lower and an upper end.
pub struct DefinedParts {
    /// The parts, with rational ends.
    pub parts: Vec<(Rational, Rational)>,
    /// Enclosures of the irrational numbers at which a part ends.
    pub gaps: Vec<(Rational, Rational)>,
}

/// A factor of the argument of a square root with the zeros at which the argument changes its sign.
pub struct SignUnderRoot {
    /// A polynomial in the parameter, square-free and not constant.
    pub function: UniPoly,
    /// True for a factor of the denominator: the argument has a pole at its zeros. At zeros of the numerator the root is zero.
    pub divides: bool,
}

impl MovingSymbols {
    /// The table of these names and definitions.
    pub fn new(table: Vec<(String, Definition)>) -> Self {
        MovingSymbols { table }
    }

    /// The table with another symbol at its end.
    pub fn with(&self, name: &str, definition: Definition) -> MovingSymbols {
        let mut table = self.table.clone();
        table.push((name.to_owned(), definition));
        MovingSymbols { table }
    }

    /// The number of symbols.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    pub(super) fn table(&self) -> &[(String, Definition)] {
        &self.table
    }

    /// Whether a symbol is an exponential, which is never zero.
    pub fn is_exponential(&self, i: usize) -> bool {
        matches!(self.table[i].1, Definition::Exponential(_))
    }

    /// The table in the reciprocal of the parameter; `None` where an argument divides by zero for every value.
    pub fn inverted(&self) -> Option<MovingSymbols> {
        let one_over = RationalFunction::variable(0).recip()?;
        let images: Vec<RationalFunction> =
            std::iter::once(one_over).chain((1..=self.table.len()).map(RationalFunction::variable)).collect();
        let table = self.table.iter().map(|(name, d)| Some((name.clone(), d.try_map(|f| f.compose(&images))?)));
        Some(MovingSymbols { table: table.collect::<Option<_>>()? })
    }

    /// The symbols where the parameter has a value; `None` where an argument divides by zero, or is negative under a root.
    pub fn at(&self, value: &Rational) -> Option<Symbols> {
        let put = |f: &RationalFunction| f.substitute(0, value)?.map_variables(|i| i.saturating_sub(1));
        let mut symbols = Symbols::new();
        for (name, definition) in &self.table {
            let definition = definition.try_map(put)?;
            if let Definition::Root(x) = &definition
                && symbols.quotient_at(x, FIRST_BITS).is_some_and(|x| x.upper().is_negative())
            {
                return None;
            }
            symbols.push(name, definition);
        }
        Some(symbols)
    }

    /// The factors with odd multiplicity of the arguments of square roots. An argument changes its sign at their zeros, and where it is
    /// negative the root has no value. Arguments that contain other symbols are left out.
    ///
    /// Cost: a square-free decomposition for each.
    pub fn signs_under_roots(&self) -> Vec<SignUnderRoot> {
        let odd = |p: UniPoly| {
            let parts = p.square_free_decomposition().into_iter().filter(|(_, multiplicity)| multiplicity % 2 == 1);
            parts.fold(UniPoly::one(), |product, (part, _)| product.times(&part))
        };
        let of = |(n, d): (UniPoly, UniPoly)| {
            [(n, false), (d, true)].map(|(p, divides)| SignUnderRoot { function: odd(p), divides })
        };
        self.arguments_of_roots().into_iter().flat_map(of).filter(|sign| !sign.function.is_constant()).collect()
    }

    /// The factors with even multiplicity of the arguments of square roots. An argument keeps its sign around their zeros: where it is
    /// negative on both sides, the root has a value at the zero alone.
    ///
    /// Cost: a square-free decomposition for each.
    pub fn touched_under_roots(&self) -> Vec<UniPoly> {
        let even = |p: UniPoly| {
            let parts = p.square_free_decomposition().into_iter().filter(|(_, multiplicity)| multiplicity % 2 == 0);
            parts.fold(UniPoly::one(), |product, (part, _)| product.times(&part))
        };
        let arguments = self.arguments_of_roots().into_iter();
        arguments.map(|(n, d)| even(n.times(&d))).filter(|p| !p.is_constant()).collect()
    }

    /// The numerators and denominators of the arguments of square roots that are rational functions of the parameter.
    fn arguments_of_roots(&self) -> Vec<(UniPoly, UniPoly)> {
        (0..self.table.len()).filter_map(|symbol| self.under_root(symbol)).collect()
    }

    /// The numerator and the denominator of the argument of a square root. `None` for another symbol, and for an argument that contains
    /// other symbols.
    pub fn under_root(&self, symbol: usize) -> Option<(UniPoly, UniPoly)> {
        match &self.table[symbol].1 {
            Definition::Root(x) => Some((x.numerator().to_univariate(0)?, x.denominator().to_univariate(0)?)),
            _ => None,
        }
    }

    /// Splits a range at the zeros of the arguments of square roots, and keeps the parts in which no argument is negative. Arguments that
    /// contain other symbols are left out.
    ///
    /// Cost: the real roots of the product of the arguments.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn defined_parts(&self, from: &Rational, to: &Rational, budget: &Budget) -> Result<DefinedParts, Exhausted> {
        let products: Vec<UniPoly> = self.arguments_of_roots().iter().map(|(n, d)| n.times(d)).collect();
        let all = products.iter().fold(UniPoly::one(), |all, p| all.times(p));
        let roots = match SquareFree::part_of(&all) {
            Some(p) if p.degree() > 0 => isolate_real_roots_in(&p, Some(from), Some(to), budget)?,
            _ => Vec::new(),
        };
        let width = (to - from) * Rational::dyadic(&Integer::ONE, GAP_BITS);
        let gaps: Vec<(Rational, Rational)> = roots.iter().map(|root| root.refined(&width).enclosure()).collect();
        let lowers = std::iter::once(from).chain(gaps.iter().map(|(_, hi)| hi));
        let uppers = gaps.iter().map(|(lo, _)| lo).chain([to]);
        let is_defined = |lo: &Rational, hi: &Rational| {
            let middle = lo.midpoint(hi);
            products.iter().all(|p| p.sign_at(&middle).is_ge())
        };
        let parts = lowers.zip(uppers).filter(|(lo, hi)| lo < hi && is_defined(lo, hi));
        let parts = parts.map(|(lo, hi)| (lo.clone(), hi.clone())).collect();
        Ok(DefinedParts { parts, gaps: gaps.into_iter().filter(|(lo, hi)| lo < hi).collect() })
    }

    /// A lower and an upper bound of the parameter beyond which an argument of a square root is negative; `None` on a side where no
    /// argument stays negative. A bound is the integer beyond the outermost root of the argument.
    ///
    /// Cost: the real roots of each argument.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn defined_between(&self, budget: &Budget) -> Result<(Option<Rational>, Option<Rational>), Exhausted> {
        let (mut lower, mut upper): (Option<Rational>, Option<Rational>) = (None, None);
        for (n, d) in self.arguments_of_roots() {
            let product = n.times(&d);
            let Some(square_free) = SquareFree::part_of(&product) else { continue };
            let roots = isolate_real_roots(&square_free, budget)?;
            let is_negative_above = product.leading().is_some_and(Integer::is_negative);
            let is_odd = product.degree().is_some_and(|degree| degree % 2 == 1);
            if is_negative_above {
                let end = roots.last().map_or(Rational::ZERO, RealAlgebraic::rational_above);
                upper = Some(upper.map_or(end.clone(), |known| known.min(end)));
            }
            if is_negative_above != is_odd {
                let end = roots.first().map_or(Rational::ZERO, RealAlgebraic::rational_below);
                lower = Some(lower.map_or(end.clone(), |known| known.max(end)));
            }
        }
        Ok((lower, upper))
    }

    /// The rational numbers at which an argument that is a rational function of the parameter alone divides by zero, ascending.
    ///
    /// Cost: the rational roots of the denominators.
    pub fn undefined_at(&self) -> Vec<Rational> {
        let arguments = self.table.iter().flat_map(|(_, definition)| definition.arguments());
        let below = arguments.filter_map(|x| SquareFree::part_of(&x.denominator().to_univariate(0)?));
        let roots =
            |p: SquareFree| rational_roots(&p, &Budget::unlimited()).map(|(roots, _)| roots).unwrap_or_default();
        let mut found: Vec<Rational> = below.filter(|p| p.degree() > 0).flat_map(roots).collect();
        found.sort();
        found.dedup();
        found
    }

    /// The parameter and all symbols as series or models, from the parameter's; `None` where a divisor may vanish.
    pub fn series<S: Elementary>(&self, parameter: &S) -> Option<Vec<S>> {
        values_of(&self.table, vec![parameter.clone()])
    }

    /// The values of polynomials in the parameter and symbols, the parameter anywhere in a ball; `None` where a divisor may
    /// vanish.
    pub fn enclose(&self, list: &[MultiPoly], parameter: &Ball) -> Option<Vec<Ball>> {
        let values = self.series(&Series::constant(parameter, 1))?;
        Some(list.iter().map(|p| polynomial_at(p, &values).coefficients()[0].clone()).collect())
    }

    /// The values of polynomials in the parameter and symbols and their derivatives by the parameter, the parameter anywhere in a ball;
    /// `None` where a divisor may vanish.
    ///
    /// ```
    /// use jurist_algebra::ball::Ball;
    /// use jurist_algebra::poly::{MultiPoly, RationalFunction};
    /// use jurist_algebra::symbols::{Definition, MovingSymbols};
    /// // 3 exp(p) at 0
    /// let symbols = MovingSymbols::new(vec![("X".into(), Definition::Exponential(RationalFunction::variable(0)))]);
    /// let p = MultiPoly::variable(1).scaled_by(&3.into());
    /// let [value, slope] = &symbols.jets(&[p], &Ball::zero(64)).unwrap()[0];
    /// assert!(value.contains(&3.into()) && slope.contains(&3.into()));
    /// ```
    ///
    /// Cost: that of [`MovingSymbols::series`] with two terms, and a product for each factor of each term.
    pub fn jets(&self, list: &[MultiPoly], parameter: &Ball) -> Option<Vec<[Ball; 2]>> {
        let one = Ball::from_integer(&Integer::ONE, parameter.bits());
        let values = self.series(&Series::linear(parameter, &one, 2))?;
        let jet = |p: &MultiPoly| {
            let series = polynomial_at(p, &values);
            let [value, slope] = series.coefficients() else { unreachable!("two terms") };
            [value.clone(), slope.clone()]
        };
        Some(list.iter().map(jet).collect())
    }

    /// The value of a function, the parameter anywhere in a ball.
    pub(super) fn value(&self, f: &Scheme, parameter: &Ball) -> Option<Ball> {
        let values = self.series(&Series::constant(parameter, 1))?;
        Some(f.at(&values).coefficients()[0].clone())
    }

    /// The parameter and all symbols on a disc of the parameter somewhat larger than one around the interval.
    fn models(&self, lo: &Rational, hi: &Rational, terms: usize, bits: u64) -> Option<Vec<TaylorModel>> {
        let radius = Ball::from_rational(&(&(hi - lo) * &pieces::disc_radius()), bits);
        self.series(&TaylorModel::linear(&Ball::from_rational(&lo.midpoint(hi), bits), &radius, terms))
    }

    /// The zeros of a polynomial in the parameter and symbols strictly between two numbers, looked for first on the scale of the
    /// number `near`.
    ///
    /// On each of the intervals that the range is divided into, a Taylor polynomial with a bound of its rest shows that the
    /// function has no zero, or that it is monotone. At the lower end the function may have a zero of any order that its
    /// exact series shows.
    ///
    /// Cost: for each interval the series of the symbols, exponentials of small matrices, and a product for each factor of
    /// each term of the polynomial.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn zeros_in(
        self: &Arc<Self>,
        f: &Function,
        lower: &Rational,
        upper: &Rational,
        near: &Rational,
        budget: &Budget,
    ) -> Result<Zeros, Exhausted> {
        let mut found = Zeros::default();
        let (start, end) = self.beside_ends(f, [lower, upper], &mut found.undecided, budget)?;
        let usual = if lower < near && near < upper { near.clone() } else { lower.midpoint(upper) };
        let scheme = Arc::new(Scheme::of(f));
        let forms = budget.enter(|| Forms::of(self, f).best_around(self, &usual, TERMS))?;
        let search = Search { symbols: self, scheme: &scheme, forms: &forms, near, is_open: start.is_zero() };
        let mut brackets = search.brackets(start, end, &mut found.undecided, budget)?;
        // Next to its zero a square root has enclosures, but no series.
        let may_vanish = |(lo, hi): &(Rational, Rational)| {
            self.value(&scheme, &Ball::between(lo, hi, FIRST_BITS)).is_none_or(|value| value.contains_zero())
        };
        budget.enter(|| found.undecided.retain(may_vanish))?;
        brackets.sort();
        found.undecided.sort();
        found.undecided = joined(found.undecided);
        let shared = Arc::new(f.clone());
        for (lo, hi, halvings) in brackets {
            let monotone = (&hi - &lo) * Rational::from(2).pow(halvings.into()).expect("two is not zero");
            let root = MovingRoot {
                symbols: Arc::clone(self),
                function: Arc::clone(&shared),
                scheme: Arc::clone(&scheme),
                place: Enclosure::new(lo, hi),
                monotone,
                rising: OnceLock::new(),
            };
            found.zeros.push(self.known(root, f, budget)?);
        }
        Ok(found)
    }

    /// Numbers beside the ends of an interval between which and them there is no zero, or it is not known.
    fn beside_ends(
        self: &Arc<Self>,
        f: &Function,
        [lower, upper]: [&Rational; 2],
        undecided: &mut Vec<(Rational, Rational)>,
        budget: &Budget,
    ) -> Result<(Rational, Rational), Exhausted> {
        let width = || (upper - lower) * Rational::dyadic(&Integer::ONE, 40);
        let mut start = lower.clone();
        let at_lower = self.vanishing(f, lower, budget)?;
        if at_lower != Some(false) {
            match budget.enter(|| self.clear_above(f, lower, upper, at_lower == Some(true)))? {
                Some(end) => start = end,
                None => {
                    start = lower + &width();
                    undecided.push((lower.clone(), start.clone()));
                }
            }
        }
        let mut end = upper.clone();
        if self.may_vanish_at(f, upper, budget)? {
            end = upper - &width();
            undecided.push((end.clone(), upper.clone()));
        }
        Ok((start, end))
    }

    /// Whether the function is zero at a rational value of the parameter, or that is neither proved nor disproved by some thousand bits.
    ///
    /// Cost: as of [`MovingSymbols::vanishes_at`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn may_vanish_at(&self, f: &Function, value: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(self.vanishing(f, value, budget)? != Some(false))
    }

    /// Whether the function is zero at a rational value of the parameter; `None` where that is neither proved nor disproved.
    fn vanishing(&self, f: &Function, value: &Rational, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        // A sign that is certain spares a table of exact arguments.
        if budget.enter(|| self.is_clear(&Scheme::of(f), value))? {
            return Ok(Some(false));
        }
        match self.vanishes_at(f, value, budget) {
            Err(stopped) if stopped.stop.is_precision() => Ok(None),
            found => found.map(Some),
        }
    }

    /// The zero as a number: a rational one where it is a short fraction, and that is proved.
    fn known(&self, root: MovingRoot, f: &Function, budget: &Budget) -> Result<Real, Exhausted> {
        let width = &root.monotone;
        let spare = 8 + width.denominator().bit_length().saturating_sub(width.numerator().bit_length());
        let mut first = None;
        for short_bits in SHORT_BITS {
            let bits = short_bits + spare;
            let place = budget.enter(|| root.enclose(bits, first.as_ref()))?;
            // The zero may be an end of its place, or all of it.
            let around = Rational::dyadic(&Integer::ONE, bits);
            if let Some(short) = simplest_between(&(place.lower() - &around), &(place.upper() + &around))
                && short.numerator().bit_length() + short.denominator().bit_length() < short_bits
                && self.vanishing(f, &short, budget)? == Some(true)
            {
                return Ok(Real::from(short));
            }
            first.get_or_insert(place);
        }
        Ok(Real::from(Transcendental::within(root, first.expect("two places"))))
    }

    pub(super) fn sign_at(&self, f: &Scheme, at: &Rational, bits: u64) -> Option<Sign> {
        self.value(f, &Ball::from_rational(at, bits))?.sign().filter(|s| s.is_ne())
    }

    /// Whether the function is certainly not zero at a number, by short numbers or else a few bits more.
    fn is_clear(&self, f: &Scheme, at: &Rational) -> bool {
        let point = TaylorModel::linear(&Ball::from_rational(at, FEW_BITS), &Ball::zero(FEW_BITS), 2);
        let known = self.series(&point).and_then(|values| f.at_short(&values));
        let is_apart = |k: Known| k.coefficients[0].least_magnitude_units() > k.rest;
        known.is_some_and(is_apart) || self.sign_at(f, at, FEW_BITS).is_some()
    }

    /// A number about in the middle, between far ends by their scale, at which the function is certainly not zero.
    fn split_point(&self, f: &Scheme, lo: &Rational, hi: &Rational, near: &Rational) -> Rational {
        if let Some(middle) = between_scales(lo, hi, near).filter(|x| self.is_clear(f, x)) {
            return middle;
        }
        let at = |n: i64| lo + &(&(hi - lo) * &Rational::new(Integer::from(n), Integer::from(64)));
        [32, 31, 33, 29, 35].into_iter().map(at).find(|x| self.is_clear(f, x)).unwrap_or(at(32))
    }

    /// What the function's Taylor polynomial says of pieces of an interval.
    fn look(&self, forms: &Forms, lo: &Rational, hi: &Rational) -> Vec<(Rational, Rational, Look)> {
        // Twice the bits that the interval's width takes away.
        let width = hi - lo;
        let small = width.denominator().bit_length().saturating_sub(width.numerator().bit_length());
        let form = forms.best(self, lo, hi, TERMS);
        let mut bits = FEW_BITS + (small * 4).min(64);
        for attempt in 0..=MOST_DOUBLINGS {
            let at_point = |x: &Rational| self.series(&Series::constant(&Ball::from_rational(x, bits), 1));
            let Some(values) = self.models(lo, hi, TERMS, bits) else {
                // Without a value in the middle and at both ends there is little hope for what is between: it stays undecided.
                let is_lost = [lo.clone(), lo.midpoint(hi), hi.clone()].iter().all(|x| at_point(x).is_none());
                return vec![(lo.clone(), hi.clone(), if is_lost { Look::Hopeless } else { Look::Unknown })];
            };
            let sign_at = |x: &Rational| form.at_series(&at_point(x)?).coefficients()[0].sign().filter(|s| s.is_ne());
            let judged = if attempt == 0 {
                let short = form.at_short(&values);
                short.and_then(|k| judged(&Piece::new(k.coefficients, k.rest, lo, hi), &k.noise, &sign_at))
            } else {
                let mut taylor = form.at_series(&values).coefficients();
                let rest = taylor.pop().expect("a model has a rest").magnitude_units();
                let noise = taylor[..2].iter().map(Ball::width_units).max().unwrap_or(Integer::ZERO);
                judged(&Piece::new(taylor, rest, lo, hi), &noise, &sign_at)
            };
            if let Some(found) = judged {
                return found;
            }
            bits = if attempt == 0 { FIRST_BITS + small * 4 } else { 2 * bits };
        }
        vec![(lo.clone(), hi.clone(), Look::Hopeless)]
    }
}

/// What a polynomial that is known but for some noise says; `None` where more bits may tell more than a shorter interval.
fn judged(
    piece: &Piece,
    noise: &Integer,
    sign_at: &dyn Fn(&Rational) -> Option<Sign>,
) -> Option<Vec<(Rational, Rational, Look)>> {
    let found = piece.judged(sign_at);
    let is_decided = found.iter().any(|(_, _, look)| !matches!(look, Look::Unknown));
    // Where the function varies by more than is noise, a shorter interval tells more than more bits do.
    (is_decided || *noise < (piece.variation() >> 8)).then_some(found)
}
