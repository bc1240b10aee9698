//! What is shown of single boxes by the characteristic polynomial: loops without dead time.

use super::axis::{right, scale, shifted};
use super::functions::Functions;
use super::{Parts, Question, Sides, largest, share_of_window};
use crate::clock::Clock;
use crate::moving::Sources;
use crate::multivariate::Multi;
use crate::number::Z;
use crate::over_box::{OverBox, in_half_plane, in_region, separated};
use crate::over_symbols::primitive;
use crate::taylor::{Precision, Taylor};
use num_traits::{One, Signed, ToPrimitive};
use std::ops::Range;

/// Beyond the axis, by these powers of two relative to the size of the roots, roots of a box are looked for whose boundary runs between
/// parts that are all not stable.
const BEYOND: [i64; 2] = [-3, -1];

/// Bits of a number that floating point holds.
const MOST_OF_FLOAT: u64 = 1000;

/// The characteristic polynomial over the window.
pub(super) struct Polynomial {
    precision: Precision,
    /// See [`Parts`].
    share: usize,
    sources: Sources,
    /// Polynomials in the parameters and what depends on them: the coefficients in the half plane, then lists of divisors.
    functions: Functions,
    /// The number of coefficients of the polynomial, and of the polynomials whose squares add up to it, if it is made of such.
    coefficients: usize,
    squared: Option<usize>,
    /// Places of those divisors that one list has.
    divisors: Vec<Range<usize>>,
    /// Whether one of them depends on the factor.
    pub divides_by_factor: bool,
    /// Whether a divisor, or a coefficient, is zero everywhere: then no point is stable.
    is_nowhere: bool,
}

/// What is known of a box.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// The functions, and whether they were computed for this box and not for a larger one.
    functions: Option<(Vec<Taylor>, bool)>,
    /// Whether that was tried.
    is_tried: bool,
}

impl Polynomial {
    pub fn new(own: OverBox, sources: Sources, of: &Question, parts: &Parts, clock: &Clock) -> Result<Self, String> {
        let mut all = Vec::new();
        for part in [Some(&own.coefficients), own.imaginary.as_ref()].into_iter().flatten() {
            let in_this_region = in_region(part, own.discrete, &of.extent, clock)?;
            all.extend(if own.discrete { in_half_plane(&in_this_region, clock)? } else { in_this_region });
        }
        let mut all = primitive(all, clock)?;
        let n = own.coefficients.len();
        let squared = own.imaginary.map(|_| n);
        let coefficients = if squared.is_some() { 2 * n - 1 } else { n };
        let is_undefined = own.divisors.iter().any(|parts| parts.iter().all(Multi::is_zero));
        let is_zero = |k: usize| all[k..].iter().step_by(n).all(Multi::is_zero);
        // Of squares the first and the last coefficient vanish where both parts do.
        let is_nowhere =
            is_undefined || if squared.is_some() { is_zero(0) || is_zero(n - 1) } else { (0..n).any(is_zero) };
        let mut divisors = Vec::with_capacity(own.divisors.len());
        let lists = separated(own.divisors, &own.positive, clock)?;
        let divides_by_factor = of.has_own_name(&lists);
        for parts in lists {
            // Their places beside the coefficients.
            let first = all.len() + coefficients - n * if squared.is_some() { 2 } else { 1 };
            divisors.push(first..first + parts.len());
            all.extend(primitive(parts, clock)?);
        }
        let functions = Functions::new(&all, of.window.len());
        let precision = Precision::new(of.window.len(), parts.order, parts.bits);
        Ok(Polynomial {
            precision,
            share: parts.share,
            sources,
            functions,
            coefficients,
            squared,
            divisors,
            divides_by_factor,
            is_nowhere,
        })
    }

    /// Makes sure that the halves have something to begin with.
    pub fn prepare(&self, sides: &Sides, known: &mut Known, clock: &Clock) -> Result<(), String> {
        let is_enough = |(known, is_own): &(Vec<Taylor>, bool)| *is_own || self.is_precise(known, self.share);
        if !known.functions.as_ref().is_some_and(is_enough) {
            self.compute(sides, known, clock)?;
        }
        // Halves of functions of two parameters take less than all else.
        let terms = if sides.len() > 2 { self.precision.terms() * self.precision.order } else { 0 };
        clock.spend(terms * known.functions.as_ref().map_or(0, |(own, _)| own.len()), self.precision.bits as u64, 0)
    }

    /// Refuses to keep what is known of so many boxes, where that is too much.
    pub fn keep(&self, boxes: usize, clock: &Clock) -> Result<(), String> {
        let last = self.divisors.last().map_or(self.coefficients, |list| list.end);
        self.precision.hold(boxes.saturating_mul(last), clock)
    }

    pub fn halves(&self, known: &Known, axis: usize) -> [Known; 2] {
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for f in known.functions.iter().flat_map(|(known, _)| known) {
            let [below, above] = f.halves(axis, &self.precision);
            lower.push(below);
            upper.push(above);
        }
        [lower, upper].map(|half| Known { functions: known.functions.as_ref().map(|_| (half, false)), is_tried: false })
    }

    /// Whether what is left out is less than a share of what the box changes.
    fn is_precise(&self, known: &[Taylor], share: usize) -> bool {
        known[..self.coefficients].iter().all(|f| {
            let variation = f.variation();
            (&f.rest << share) <= variation || f.rest.bits() < 8
        })
    }

    /// The functions over the box itself, where the series allow it.
    fn compute(&self, sides: &Sides, of: &mut Known, clock: &Clock) -> Result<(), String> {
        if of.is_tried {
            return Ok(());
        }
        of.is_tried = true;
        clock.tick()?;
        let p = &self.precision;
        let parameters = sides.iter().enumerate().map(|(i, side)| Taylor::coordinate(side, i, p)).collect();
        // A box may be too wide for a series; then it is not shown.
        let own = self.sources.values(parameters, p, clock).and_then(|v| self.functions.at(&v, p, clock));
        let own = own.and_then(|own| self.with_squares(own, clock));
        clock.tick()?;
        if let Ok(own) = own {
            of.functions = Some((own, true));
        }
        Ok(())
    }

    /// With the polynomial in the place of those whose squares add up to it.
    fn with_squares(&self, own: Vec<Taylor>, clock: &Clock) -> Result<Vec<Taylor>, String> {
        let Some(n) = self.squared else { return Ok(own) };
        let mut out = vec![Taylor::zero(); self.coefficients];
        for part in own[..2 * n].chunks(n) {
            for i in 0..n {
                for k in i..n {
                    let product = part[i].times(&part[k], &self.precision, clock)?;
                    out[i + k].add_scaled(&product, &Z::from(if i == k { 1 } else { 2 }));
                }
            }
        }
        out.extend_from_slice(&own[2 * n..]);
        Ok(out)
    }

    pub fn shown(&self, sides: &Sides, of: &mut Known, stable: bool, clock: &Clock) -> Result<bool, String> {
        if self.is_nowhere {
            return Ok(!stable);
        }
        if let Some((known, is_own)) = &of.functions {
            if self.decided(known, stable, clock)? {
                return Ok(true);
            }
            if *is_own || self.is_precise(known, 10) {
                return Ok(false);
            }
        }
        self.compute(sides, of, clock)?;
        match &of.functions {
            Some((known, true)) => self.decided(known, stable, clock),
            _ => Ok(false),
        }
    }

    /// Whether roots are to the right of the line that a power of two is right of the axis, at every point of the box.
    pub fn has_root_beyond(&self, sides: &Sides, of: &mut Known, exponent: i64, clock: &Clock) -> Result<bool, String> {
        if self.is_nowhere {
            return Ok(true);
        }
        self.compute(sides, of, clock)?;
        let Some((known, true)) = &of.functions else { return Ok(false) };
        // In between numbers are longer than those of the models.
        let (n, terms) = (self.coefficients, self.precision.terms());
        let bits = self.precision.bits as u64 + exponent.unsigned_abs() * n as u64;
        clock.hold(n * terms, bits)?;
        clock.spend(n * n / 2 * terms, bits, 0)?;
        let moved = shifted(&known[..self.coefficients], exponent, &self.precision, clock)?;
        Ok(right(&moved, &self.precision, clock)?.is_some_and(|count| count > 0))
    }

    /// The coefficients in the middle of a box, times a positive number.
    pub fn coefficients_approximate(&self, sides: &Sides, of: &mut Known, clock: &Clock) -> Option<Vec<f64>> {
        self.compute(sides, of, clock).ok()?;
        let (known, _) = of.functions.as_ref()?;
        let constants: Vec<Z> = known[..self.coefficients].iter().map(Taylor::constant).collect();
        let long = constants.iter().map(Z::bits).max()?.saturating_sub(MOST_OF_FLOAT);
        constants.iter().map(|c| (c >> long).to_f64()).collect()
    }

    fn decided(&self, known: &[Taylor], stable: bool, clock: &Clock) -> Result<bool, String> {
        let p = &known[..self.coefficients];
        let right = |p: &[Taylor]| right(p, &self.precision, clock);
        if stable {
            return Ok(are_defined(&self.divisors, known) && right(p)? == Some(0));
        }
        // All roots to the left make all coefficients of one sign.
        let signs: Vec<bool> = p.iter().filter_map(Taylor::sign).collect();
        if signs.contains(&true) && signs.contains(&false) {
            return Ok(true);
        }
        if right(p)?.is_some_and(|count| count > 0) {
            return Ok(true);
        }
        for beyond in BEYOND {
            if right(&shifted(p, scale(p) + beyond, &self.precision, clock)?)?.is_some_and(|count| count > 0) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The axis along which the functions change most in a box; of one that is not known, the widest in shares of the window.
    pub fn axis(&self, sides: &Sides, window: &Sides, of: &Known) -> usize {
        let Some((known, _)) = &of.functions else { return share_of_window(sides, window) };
        let mut sums = vec![0_u64; sides.len()];
        for f in &known[..self.coefficients] {
            let size = f.magnitude().max(Z::one());
            for (axis, sum) in sums.iter_mut().enumerate() {
                // Shares in thousandths, for a choice and no proof.
                let share = u32::try_from(f.linear(axis).abs() * 1000 / &size).unwrap_or(u32::MAX);
                *sum += u64::from(share);
            }
        }
        largest(sums.into_iter()).unwrap_or(0)
    }
}

/// Whether of each of these lists of functions one has a sign.
pub(super) fn are_defined(divisors: &[Range<usize>], known: &[Taylor]) -> bool {
    divisors.iter().all(|list| known[list.clone()].iter().any(|f| f.sign().is_some()))
}
