//! Zeros of a function of the frequency and a parameter, isolated and refined with proof.

use super::family_function::{Function, Grid, Local, power_of_two};
use super::turn::Fixed;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::real::{Enclosing, Origin};
use std::sync::{Arc, Mutex, PoisonError};

/// A box: centre and half widths `2^radius`.
#[derive(Clone, Debug)]
struct Cell {
    centre: [Grid; 2],
    radius: [i64; 2],
}

/// A zero, alone in a box and regular: the derivatives by the frequency and by the parameter are independent there.
#[derive(Debug)]
pub(super) struct FamilyZero {
    /// The function, of finer coefficients where these are enclosed and more digits were asked for.
    function: Mutex<Arc<Function>>,
    /// The zero is the only one in it: lower and upper ends for the frequency and the parameter.
    alone: [(Rational, Rational); 2],
    /// The best enclosure so far.
    known: Mutex<Cell>,
    /// Whether roots move to the right (greater) or left (less) of the line as the parameter grows.
    pub motion: Sign,
}

/// What a box may hold.
enum Look {
    Nothing,
    One(Box<FamilyZero>),
    /// More has to be seen: cut the frequency (0) or the parameter (1).
    Cut(usize),
}

/// Halvings of a box after which it is given up: a zero that is not regular.
const DEEPEST: i64 = 60;

/// All zeros with a frequency from zero up to a bound and the parameter in a closed range, those on the edge and some beyond
/// included; `None` where one of them is not regular.
///
/// A box is dropped when the function's value in the middle is larger than it can change by in the box. A zero is proved to
/// be alone in a box by Newton's method: the simplified Newton step maps three times the box into itself and contracts.
///
/// Cost: one evaluation of the function and its first two derivatives per box.
pub(super) fn zeros(
    function: &Arc<Function>,
    frequency: &Rational,
    lower: &Rational,
    upper: &Rational,
    budget: &Budget,
) -> Result<Option<Vec<FamilyZero>>, Exhausted> {
    budget.step("crossings of the imaginary axis");
    let reach = |x: &Rational| {
        let mut e = -8;
        while power_of_two(e + 1) < *x {
            e += 1;
        }
        while power_of_two(e) >= *x {
            e -= 1;
        }
        e
    };
    let a = reach(frequency);
    let b = reach(&(upper - lower));
    let unit = Rational::from(2) * power_of_two(b);
    let (first, last) = ((lower / &unit).floor(), (upper / &unit).ceil());
    let mut open: Vec<Cell> = Vec::new();
    let mut at = first;
    while at < last {
        let middle = (&at << 1) + Integer::ONE;
        let centre = [Grid { numerator: Integer::ONE, exponent: a }, Grid { numerator: middle, exponent: b }];
        open.push(Cell { centre, radius: [a, b] });
        at += Integer::ONE;
    }
    let mut found: Vec<FamilyZero> = Vec::new();
    while let Some(cell) = open.pop() {
        budget.check()?;
        let (low, high) = cell.side(1);
        if high < *lower || low > *upper || cell.side(0).0 > *frequency {
            continue;
        }
        match budget.enter(|| look(function, &cell))? {
            Look::Nothing => {}
            Look::One(zero) => {
                if !found.iter().any(|known| known.is(&zero)) {
                    found.push(*zero);
                }
            }
            Look::Cut(which) => {
                if cell.radius[which] < [a, b][which] - DEEPEST {
                    return Ok(None);
                }
                open.extend(cell.halves(which));
            }
        }
    }
    Ok(Some(found))
}

impl Cell {
    fn side(&self, which: usize) -> (Rational, Rational) {
        let (centre, radius) = (self.centre[which].rational(), power_of_two(self.radius[which]));
        (&centre - &radius, centre + radius)
    }

    fn halves(&self, which: usize) -> [Cell; 2] {
        let exponent = self.radius[which] - 1;
        let shift = (self.centre[which].exponent - exponent) as u64;
        let middle = &self.centre[which].numerator << shift;
        [middle.clone() - Integer::ONE, middle + Integer::ONE].map(|numerator| {
            let mut half = self.clone();
            half.centre[which] = Grid { numerator, exponent };
            half.radius[which] = exponent;
            half
        })
    }

    fn scale(&self) -> u64 {
        64 + 2 * self.radius.iter().map(|r| (-r).max(0) as u64).max().unwrap_or(0)
    }

    /// The function within `times` the box.
    fn local(&self, function: &Function, times: i64, scale: u64) -> Local {
        let reach = self.radius.map(|r| power_of_two(r) * Rational::from(times));
        function.local((&self.centre[0], &self.centre[1]), (&reach[0], &reach[1]), scale)
    }
}

/// `x 2^exponent`, rounded up.
fn moved_up(x: &Integer, exponent: i64) -> Integer {
    match u64::try_from(exponent) {
        Ok(up) => x << up,
        Err(_) => (x >> exponent.unsigned_abs()) + Integer::ONE,
    }
}

/// `x 2^exponent` with its error.
fn moved(x: &Fixed, exponent: i64) -> Fixed {
    match u64::try_from(exponent) {
        Ok(up) => Fixed { re: &x.re << up, im: &x.im << up, error: &x.error << up },
        Err(_) => {
            let down = exponent.unsigned_abs();
            let error = (&x.error >> down) + Integer::from(2);
            Fixed { re: &x.re >> down, im: &x.im >> down, error }
        }
    }
}

/// The function in units of a box: value, derivatives along its half widths, and how much these change within once the box.
struct Scaled {
    value: Fixed,
    columns: [Fixed; 2],
    /// Bounds of the changes of both columns.
    changes: [Integer; 2],
    /// A bound of what is beyond the linear part.
    rest: Integer,
}

impl Scaled {
    fn new(local: &Local, radius: [i64; 2], unit: &Integer) -> Scaled {
        let square = unit * unit;
        let by =
            |x: &Fixed, factor: &Integer| Fixed { re: &x.re * factor, im: &x.im * factor, error: &x.error * factor };
        let value = by(&local.value, &square);
        let columns = [moved(&by(&local.by_omega, unit), radius[0]), moved(&by(&local.by_p, unit), radius[1])];
        let [ww, wp, pp] = &local.second;
        let (ww, wp, pp) =
            (moved_up(ww, 2 * radius[0]), moved_up(wp, radius[0] + radius[1]), moved_up(pp, 2 * radius[1]));
        let rest = ((&ww + &pp) >> 1) + Integer::ONE + &wp;
        Scaled { value, columns, changes: [&ww + &wp, &wp + &pp], rest }
    }

    /// `Im(x conj y)` and its error.
    fn cross(x: &Fixed, y: &Fixed) -> (Integer, Integer) {
        let value = &x.im * &y.re - &x.re * &y.im;
        let size = |x: &Fixed| x.re.abs() + x.im.abs() + (&x.error << 1);
        let error = &size(x) * &y.error + &size(y) * &x.error;
        (value, error << 1)
    }
}

/// Where all zeros within `times` the box are, in its half widths from its centre, over a denominator.
struct Newton {
    /// Middle and radius for both variables.
    places: [(Integer, Integer); 2],
    /// A lower bound of the modulus of the determinant.
    denominator: Integer,
    /// Whether the step contracts by a half within `times` the box.
    contracts: bool,
    sign: Sign,
}

fn newton(scaled: &Scaled, times: i64) -> Option<Newton> {
    let [a, b] = &scaled.columns;
    let (determinant, error) = Scaled::cross(a, b);
    let least = determinant.abs() - &error;
    if !least.sign().is_gt() {
        return None;
    }
    let sign = determinant.sign();
    // u det = -Im(f conj b), v det = Im(f conj a), up to the rest.
    let (u, u_error) = Scaled::cross(&scaled.value, b);
    let (v, v_error) = Scaled::cross(&scaled.value, a);
    let (u, v) = if sign.is_gt() { (-u, v) } else { (u, -v) };
    let t = Integer::from(times);
    let rest = &(&scaled.rest * &t) * &t;
    let (na, nb) = (a.at_most(), b.at_most());
    // The quotient by the determinant is off by its relative error, too.
    let off = |x: &Integer, x_error: Integer, other: &Integer| {
        let relative = (x.abs() * &(&error << 1)).div_mod_floor(&least).0 + Integer::ONE;
        x_error + other * &rest + relative
    };
    let places = [(u.clone(), off(&u, u_error, &nb)), (v.clone(), off(&v, v_error, &na))];
    let slack = &(&scaled.changes[0] + &scaled.changes[1]) * &t;
    let contracts = [na, nb].iter().all(|n| (&(n * &slack) << 1) <= least);
    Some(Newton { places, denominator: least, contracts, sign })
}

fn real(x: &Fixed) -> &Integer {
    &x.re
}

fn imaginary(x: &Fixed) -> &Integer {
    &x.im
}

/// Times the box in which a zero is proved to be alone.
const WIDER: i64 = 3;

fn look(function: &Arc<Function>, cell: &Cell) -> Look {
    let scale = cell.scale();
    let local = cell.local(function, WIDER, scale);
    let scaled = Scaled::new(&local, cell.radius, &function.unit);
    let sizes = scaled.columns.each_ref().map(Fixed::at_most);
    let change = &(&sizes[0] + &sizes[1]) + &scaled.rest;
    if scaled.value.at_least() > change {
        return Look::Nothing;
    }
    // Either part by itself.
    let [a, b] = &scaled.columns;
    for part in [real as fn(&Fixed) -> &Integer, imaginary] {
        let linear = part(a).abs() + part(b).abs() + &a.error + &b.error;
        if part(&scaled.value).abs() - &scaled.value.error > linear + &scaled.rest {
            return Look::Nothing;
        }
    }
    let which = usize::from(sizes[1] > sizes[0]);
    let Some(newton) = newton(&scaled, WIDER).filter(|n| n.contracts) else { return Look::Cut(which) };
    // Outside of the box?
    if newton.places.iter().any(|(x, r)| x.abs() - r > newton.denominator) {
        return Look::Nothing;
    }
    // |T(0)| + |T(x) - T(0)| <= |T(0)| + 3/2 <= 3.
    if newton.places.iter().any(|(x, r)| (x.abs() + r) << 1 > &newton.denominator * &Integer::from(WIDER)) {
        return Look::Cut(which);
    }
    let alone = [0, 1].map(|i| {
        let (centre, reach) = (cell.centre[i].rational(), power_of_two(cell.radius[i]) * Rational::from(WIDER));
        (&centre - &reach, centre + reach)
    });
    // ds/dp = -f_p/f_s has the sign of -Im(f_w conj f_p) as its real part.
    let motion = newton.sign.reverse();
    let mut known = cell.clone();
    known.radius = known.radius.map(|r| r + 1);
    let function = Mutex::new(Arc::clone(function));
    Look::One(Box::new(FamilyZero { function, alone, known: Mutex::new(known), motion }))
}

impl FamilyZero {
    /// Enclosures of the frequency and of the parameter, neither wider than `2^-bits`.
    pub fn enclosures(&self, bits: u64) -> [Enclosure; 2] {
        self.enclosed(-(bits as i64) - 1, u64::MAX)
    }

    /// Enclosures of both that are as narrow as this precision, and the coefficients, tell.
    pub fn enclosed_with(&self, scale: u64) -> [Enclosure; 2] {
        self.enclosed(i64::MIN, scale)
    }

    /// Enclosures whose widths are not above `2^(goal + 1)`, or that are found with this precision.
    fn enclosed(&self, goal: i64, most: u64) -> [Enclosure; 2] {
        let mut function = self.function.lock().unwrap_or_else(PoisonError::into_inner);
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let mut scale = known.scale();
        while scale <= most && known.radius.iter().any(|&r| r > goal) {
            match closer(&function, &known, scale) {
                Some(next) => {
                    *known = next;
                    scale = scale.max(known.scale());
                }
                None => {
                    scale = scale.saturating_mul(2);
                    if let Some(finer) = function.finer(scale) {
                        *function = Arc::new(finer);
                    }
                }
            }
        }
        [0, 1].map(|i| {
            let (lo, hi) = known.side(i);
            // The first box may reach further than where the zero is alone.
            let lo = lo.max(self.alone[i].0.clone());
            Enclosure::new(lo, hi.min(self.alone[i].1.clone()))
        })
    }

    /// Whether both are the same zero.
    fn is(&self, other: &FamilyZero) -> bool {
        let inside = |one: &FamilyZero, two: &FamilyZero| {
            let place = two.enclosures(FIRST_BITS);
            (0..2).all(|i| place[i].lower() >= &one.alone[i].0 && place[i].upper() <= &one.alone[i].1)
        };
        inside(self, other) || inside(other, self)
    }

    /// Whether the frequency is zero: a zero that is alone in a box is its own mirror image when that lies there, too.
    pub fn is_real(&self) -> bool {
        let omega = &self.enclosures(REAL_BITS)[0];
        let mirrored = -omega.upper();
        omega.contains(&Rational::ZERO) && mirrored > self.alone[0].0 && *omega.lower() > -&self.alone[0].1
    }
}

/// A box of at most half the widths; `None` where the scale is too small for one.
fn closer(function: &Function, known: &Cell, scale: u64) -> Option<Cell> {
    let local = known.local(function, 1, scale);
    let scaled = Scaled::new(&local, known.radius, &function.unit);
    let newton = newton(&scaled, 1)?;
    let denominator = Rational::from(&newton.denominator);
    let mut next = known.clone();
    for (i, (x, r)) in newton.places.iter().enumerate() {
        let radius = power_of_two(known.radius[i]);
        let relative = Rational::from(r) / &denominator;
        let mut exponent = known.radius[i] - 1;
        if &relative + &power_of_two(-3) > power_of_two(-1) {
            return None;
        }
        // The new half width: that of the enclosure and of rounding the centre to a quarter of it.
        while exponent > known.radius[i] - MOST_AT_ONCE && power_of_two(exponent - known.radius[i] - 2) > relative {
            exponent -= 1;
        }
        let centre = known.centre[i].rational() + Rational::from(x) / &denominator * &radius;
        let grid = exponent - 2;
        next.centre[i] = Grid::below(&centre, grid);
        next.radius[i] = exponent;
    }
    Some(next)
}

/// Bits to which a box is narrowed at once at most.
const MOST_AT_ONCE: i64 = 1 << 12;
const FIRST_BITS: u64 = 48;
const REAL_BITS: u64 = 128;

/// A number that belongs to a zero.
#[derive(Clone, Copy, Debug)]
pub(super) enum Coordinate {
    Frequency,
    Parameter,
    /// The reciprocal of the parameter.
    Reciprocal,
    /// The frequency times the parameter.
    Product,
}

/// It, to be enclosed.
#[derive(Debug)]
pub(super) struct CoordinateOf {
    pub zero: Arc<FamilyZero>,
    pub which: Coordinate,
}

impl Enclosing for CoordinateOf {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let goal = Rational::dyadic(&Integer::ONE, bits);
        let mut working = bits + 4;
        loop {
            let [omega, p] = self.zero.enclosures(working);
            let value = match self.which {
                Coordinate::Frequency => Some(omega),
                Coordinate::Parameter => Some(p),
                Coordinate::Reciprocal => Enclosure::from_rational(Rational::ONE).div(&p, 2 * working),
                Coordinate::Product => Some(omega.mul(&p, 2 * working)),
            };
            if let Some(value) = value.filter(|value| value.upper() - value.lower() <= goal) {
                return value;
            }
            working += working / 2 + 16;
        }
    }

    fn origin(&self) -> Origin {
        let function = "the characteristic function at i omega".into();
        Origin::Function { function, details: Vec::new() }
    }
}
