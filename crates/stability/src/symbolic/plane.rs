//! Two parameters of a loop over symbols: boxes, each proved stable, proved not stable, or left undecided.

use crate::Shape;
use crate::dead_time::{Known, PlaneFunction, Shares, in_shares_of};
use crate::plane::boxes::{BoxMap, BoxVerdict, Place, Seen, Window, subdivided, subdivided_with};
use crate::precisions::PLANE_COEFFICIENTS;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, until_shown};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use jurist_algebra::symbols::{MovingSymbols, Symbols};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A characteristic polynomial in two parameters whose coefficients contain symbols, which may depend on one of the two.
///
/// In its polynomials the parameters are variables 0 and 1, and symbol `i` is variable `i + 2`.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::matrix::CharacteristicPolynomial;
/// use jurist_algebra::poly::RationalFunction;
/// use jurist_algebra::symbols::{Definition, Symbols};
/// use jurist_stability::plane::boxes::Window;
/// use jurist_stability::{Range, Shape, SymbolicPlane};
/// use std::sync::Arc;
/// // z - X + a + b with X = exp(-1): stable for -1 + X < a + b < 1 + X
/// let mut symbols = Symbols::new();
/// symbols.insert("X1", Definition::exponential(-1));
/// let [a, b, x] = [0, 1, 2].map(RationalFunction::variable);
/// let d = CharacteristicPolynomial {
///     variables: vec!["a".into(), "b".into(), "X1".into()],
///     coefficients: vec![&(&a + &b) - &x, RationalFunction::one()],
///     formal_degree: 1,
///     poles: Vec::new(),
///     monic: true,
/// };
/// let plane = SymbolicPlane::new(&d, Shape::UnitDisc, &Arc::new(symbols));
/// let side = Range::between(Some(0.into()), Some(1.into()));
/// let window = Window::new(&side, &side).unwrap();
/// let map = plane.boxes(&window, &"1/10".parse().unwrap(), &Budget::unlimited()).unwrap();
/// // The triangle a + b < 1.3678...
/// assert!(map.areas.stable < "0.801".parse().unwrap() && map.areas.unstable < "0.2".parse().unwrap());
/// ```
#[derive(Clone, Debug)]
pub struct SymbolicPlane {
    /// The coefficients of the powers of `s` of the polynomial whose roots are to lie in the left half plane.
    coefficients: Vec<MultiPoly>,
    poles: Vec<MultiPoly>,
    /// Degree lost, or a root on the boundary, for all values of both parameters.
    is_never_stable: bool,
    table: Table,
}

/// What the symbols stand for.
#[derive(Clone, Debug)]
enum Table {
    /// Numbers.
    Fixed(Arc<Symbols>),
    /// Functions of one of the parameters.
    Moving { symbols: Arc<MovingSymbols>, axis: usize },
}

/// Bits that each coefficient is to have.
const OWN_BITS: u64 = 128;
/// Terms of the Taylor polynomials in a parameter that symbols depend on.
const TERMS: usize = 12;
/// After so many halvings of that parameter there are new Taylor polynomials.
const HALVINGS: u32 = 3;

impl SymbolicPlane {
    /// The polynomial whose first two variables are parameters and whose others are symbols.
    ///
    /// Cost: `O(n)` least common multiples, and `O(n^2)` sums of coefficients.
    pub fn new(d: &CharacteristicPolynomial, region: Shape, symbols: &Arc<Symbols>) -> SymbolicPlane {
        SymbolicPlane::over(d, region, Table::Fixed(Arc::clone(symbols)))
    }

    /// The same where symbols depend on one of the parameters (0 or 1), which is variable 0 of their definitions.
    ///
    /// Cost: as [`SymbolicPlane::new`].
    pub fn with_moving(
        d: &CharacteristicPolynomial,
        region: Shape,
        symbols: &Arc<MovingSymbols>,
        axis: usize,
    ) -> SymbolicPlane {
        SymbolicPlane::over(d, region, Table::Moving { symbols: Arc::clone(symbols), axis })
    }

    fn over(d: &CharacteristicPolynomial, region: Shape, table: Table) -> SymbolicPlane {
        let (polynomial, denominator) = d.cleared();
        let n = d.formal_degree;
        let is_lost = polynomial.degree() != Some(n);
        let own: Vec<MultiPoly> = (0..=n).map(|k| polynomial.coeff(k)).collect();
        // Sums are formed before anything is enclosed: near z = 1 they are small where the coefficients are not.
        let coefficients = match region {
            Shape::LeftHalfPlane => own,
            Shape::UnitDisc => to_half_plane(&own),
        };
        let is_never_stable = is_lost || n > 0 && [0, n].into_iter().any(|k| coefficients[k].is_zero());
        let poles = std::iter::once(&denominator).chain(&d.poles).filter(|p| !p.is_constant()).cloned().collect();
        SymbolicPlane { coefficients, poles, is_never_stable, table }
    }

    /// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1).
    ///
    /// As for [loops with dead time](crate::dead_time::PlaneLoop::boxes), with coefficients that are known up to a
    /// bound: those of constants, or those of Taylor polynomials in the parameter that symbols depend on, with all that is
    /// left out. A budget that runs out leaves more of the window undecided.
    ///
    /// Cost: for each step of each walk an evaluation of the function and its first derivatives.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out before there is a box.
    pub fn boxes(&self, window: &Window, goal: &Rational, budget: &Budget) -> Result<BoxMap, Exhausted> {
        if self.is_never_stable {
            return Ok(subdivided(window, goal, budget, |_| Ok(Seen::Decided(BoxVerdict::Unstable { outside: None }))));
        }
        match &self.table {
            Table::Fixed(symbols) => {
                let function = budget.enter(|| self.over_numbers(window, symbols))?;
                Ok(subdivided_with(window, goal, budget, |place, known| Ok(function.look(place, known))))
            }
            Table::Moving { symbols, axis } => {
                let tiles = budget.enter(|| Tiles::new(self, window, symbols, *axis))?;
                Ok(subdivided_with(window, goal, budget, |place, known| Ok(tiles.look(place, known))))
            }
        }
    }

    /// What is seen of boxes at the lower end of the parameter that symbols depend on, where functions vanish in ways that only
    /// their series from that end tell; nothing of others.
    pub fn at_lower_end(&self, window: &Window) -> impl Fn(&Place) -> Option<Seen> + Sync {
        let tiles = match &self.table {
            Table::Moving { symbols, axis } if !self.is_never_stable => Some(Tiles::new(self, window, symbols, *axis)),
            _ => None,
        };
        move |place| tiles.as_ref().filter(|tiles| place.at[tiles.axis] == 0).map(|tiles| tiles.look(place, None).0)
    }

    /// The function over a window where symbols are numbers.
    fn over_numbers(&self, window: &Window, symbols: &Symbols) -> PlaneFunction {
        let (coefficients, poles) = self.in_shares(window, &[0, 1]);
        until_shown(PLANE_COEFFICIENTS.first, |bits| {
            let one = |p: &MultiPoly| {
                let mut parts: HashMap<[u32; 2], Vec<(Vec<u32>, Integer)>> = HashMap::new();
                for (monomial, c) in p.terms() {
                    let e = monomial.exponents();
                    let own = [monomial.exponent(0), monomial.exponent(1)];
                    parts.entry(own).or_default().push((e.get(2..).unwrap_or_default().to_vec(), c.clone()));
                }
                let mut rounded = Rounded::default();
                for (powers, terms) in parts {
                    rounded.add(powers, &symbols.enclose(&MultiPoly::from_terms(terms), bits));
                }
                rounded
            };
            let rounded: Vec<Rounded> = coefficients.iter().map(one).collect();
            let is_fine = |r: &Rounded| r.largest.bit_length() >= OWN_BITS || r.terms.is_empty();
            // Small coefficients are taken as they are in the end.
            (rounded.iter().all(is_fine) || bits >= PLANE_COEFFICIENTS.last)
                .then(|| PlaneFunction::new(shares(rounded, poles.iter().map(one).collect(), 0)))
        })
    }

    /// Coefficients and poles with these parameters as shares of the window.
    fn in_shares(&self, window: &Window, axes: &[usize]) -> (Vec<MultiPoly>, Vec<MultiPoly>) {
        let sides = [&window.x, &window.y];
        let put =
            |list: &[MultiPoly]| axes.iter().fold(list.to_vec(), |list, &axis| in_shares_of(&list, axis, sides[axis]));
        (put(&self.coefficients), put(&self.poles))
    }
}

/// `sum d_k (1 + s)^k (1 - s)^(n - k)`: what is inside of the unit circle in `z` is left of the imaginary axis in
/// `s = (z - 1)/(z + 1)`.
fn to_half_plane(own: &[MultiPoly]) -> Vec<MultiPoly> {
    let n = own.len() - 1;
    let powers = |base: [i64; 2]| -> Vec<UniPoly> {
        let base = UniPoly::from_i64(&base);
        (0..=n).scan(UniPoly::from_i64(&[1]), |power, _| Some(std::mem::replace(power, &*power * &base))).collect()
    };
    let (plus, minus) = (powers([1, 1]), powers([1, -1]));
    let factors: Vec<UniPoly> = (0..=n).map(|k| &plus[k] * &minus[n - k]).collect();
    let sum = |j: usize| {
        own.iter().zip(&factors).fold(MultiPoly::zero(), |sum, (d, factor)| &sum + &d.scaled_by(&factor.coeff(j)))
    };
    (0..=n).map(sum).collect()
}

/// A polynomial in two shares with integer coefficients, and by how much it is off at most where both are in `[0, 1]`.
#[derive(Default)]
struct Rounded {
    terms: Vec<(Vec<u32>, Integer)>,
    slack: Integer,
    largest: Integer,
}

impl Rounded {
    fn add(&mut self, powers: [u32; 2], value: &Ball) {
        let middle = value.middle_units();
        self.slack += value.width_units() + Integer::ONE;
        self.largest = self.largest.clone().max(middle.abs());
        self.terms.push((powers.to_vec(), middle));
    }
}

fn shares(coefficients: Vec<Rounded>, poles: Vec<Rounded>, slack_axis: usize) -> Shares {
    let polynomial = |r: Rounded| (MultiPoly::from_terms(r.terms), r.slack);
    let (part, slack) = coefficients.into_iter().map(polynomial).unzip();
    let poles = poles.into_iter().map(polynomial).collect();
    Shares { parts: vec![part], slack, slack_axis, poles, delays: vec![Default::default()], times: Vec::new() }
}

/// The function over a part of a window; `None` where it may be undefined.
type Tile = Option<Arc<PlaneFunction>>;

/// The function over parts of a window in one parameter, on which it depends through symbols as well.
struct Tiles<'a> {
    symbols: &'a MovingSymbols,
    axis: usize,
    side: [Rational; 2],
    /// The coefficients of the powers of the other parameter's share in each coefficient, then in each pole.
    lists: [Vec<Vec<MultiPoly>>; 2],
    /// By halvings and place.
    known: Mutex<HashMap<(u32, u64), Tile>>,
}

impl<'a> Tiles<'a> {
    fn new(plane: &SymbolicPlane, window: &Window, symbols: &'a MovingSymbols, axis: usize) -> Tiles<'a> {
        let (coefficients, poles) = plane.in_shares(window, &[1 - axis]);
        // The parameter is variable 0, symbol i variable i + 1.
        let place = |p: &MultiPoly| p.map_variables(|i| if i == axis { 0 } else { i - 1 });
        let split = |p: &MultiPoly| p.as_poly_in(1 - axis).coeffs().iter().map(place).collect();
        let lists = [coefficients, poles].map(|list| list.iter().map(split).collect());
        let side = if axis == 0 { window.x.clone() } else { window.y.clone() };
        Tiles { symbols, axis, side, lists, known: Mutex::default() }
    }

    /// What is known of a box is told only for the same tile.
    fn look(&self, place: &Place, known: Option<&(u32, Known)>) -> (Seen, Option<(u32, Known)>) {
        let (at, halvings) = (place.at[self.axis], place.halvings[self.axis]);
        let level = halvings - halvings % HALVINGS;
        let tile = at >> (halvings - level);
        let tiles = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let found = tiles().get(&(level, tile)).cloned();
        let function = found.unwrap_or_else(|| {
            let built = self.tile(level, tile).map(Arc::new);
            tiles().insert((level, tile), built.clone());
            built
        });
        let Some(function) = function else { return (Seen::Cut(self.axis), None) };
        let mut inner = *place;
        inner.halvings[self.axis] = halvings - level;
        inner.at[self.axis] = at - (tile << (halvings - level));
        let known = known.filter(|(own, _)| *own == level).map(|(_, known)| known);
        let (seen, known) = function.look(&inner, known);
        (seen, known.map(|known| (level, known)))
    }

    fn tile(&self, level: u32, at: u64) -> Option<PlaneFunction> {
        let [low, high] = &self.side;
        let end = |k: u64| low + &((high - low) * Rational::dyadic(&Integer::from(k), u64::from(level)));
        let flat: Vec<MultiPoly> = self.lists.iter().flatten().flatten().cloned().collect();
        let found =
            self.symbols.taylor_from_end(&flat, &end(at), &end(at + 1), TERMS, PLANE_COEFFICIENTS.first + OWN_BITS)?;
        let mut found = found.into_iter();
        let mut rounded = |list: &Vec<Vec<MultiPoly>>| -> Vec<Rounded> {
            let one = |parts: &Vec<MultiPoly>| {
                let mut rounded = Rounded::default();
                for (k, series) in found.by_ref().take(parts.len()).enumerate() {
                    let (rest, series) = series.split_last().expect("there is a rest");
                    rounded.slack += rest.magnitude_units();
                    for (i, c) in series.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                        let mut powers = [0, 0];
                        powers[self.axis] = i as u32;
                        powers[1 - self.axis] = k as u32;
                        rounded.add(powers, c);
                    }
                }
                // Terms that are smaller than what is unknown anyway are left to it.
                let unknown = rounded.slack.clone();
                let (kept, small) =
                    std::mem::take(&mut rounded.terms).into_iter().partition(|(_, c)| c.abs() > unknown);
                rounded.terms = kept;
                let small: Vec<(Vec<u32>, Integer)> = small;
                small.iter().for_each(|(_, c)| rounded.slack += c.abs());
                rounded
            };
            list.iter().map(one).collect()
        };
        let [coefficients, poles] = [0, 1].map(|which| rounded(&self.lists[which]));
        Some(PlaneFunction::new(shares(coefficients, poles, self.axis)))
    }
}

#[cfg(test)]
#[path = "tests_plane.rs"]
mod tests;
