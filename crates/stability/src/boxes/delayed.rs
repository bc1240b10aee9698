//! Characteristic functions of loops with dead time and tolerances.
//!
//! The search looks along lines in floating point; what it finds is counted exactly by who asks. Boxes are proved in
//! [`delayed_prove`](super::delayed_prove).

use super::delayed_rounded::{RoundedLoop, on_line};
use super::family::{Family, Gradient, Path, ROUGH_BITS};
use super::line::{on_line as polynomials_on_line, rational_zero};
use super::look::BoxLook;
use super::polynomial::without_squares;
use super::prove::Outcome;
use crate::AtPoint;
use crate::dead_time::{DeadTime, PlaneLoop};
use crate::plane::boxes::BoxVerdict;
use crate::subdivision::BoxPart;
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use std::collections::BTreeMap;

/// Binary digits to which floating point tells where a line leaves the stable set.
const DIGITS: u64 = 44;

/// An end that is not counted as lost is moved by these shares of it, powers of two.
const WIDENED: [u64; 5] = [43, 40, 36, 32, 26];

/// The bracket of a limit is not narrower than two to minus this of the way to it.
const LEAST_GAP: u64 = 30;

/// A part of the coefficients of one power of `s` and one dead time: the exponents of parameters outside of dead times, with a polynomial in
/// those inside.
pub(super) type Split = Vec<(Vec<u32>, MultiPoly)>;

/// `sum P_k(s; p) exp(-tau_k(p) s)` with coefficients that are polynomials in the parameters, and dead times that are quotients of such.
///
/// A point is counted by one walk along the imaginary axis. Where that does not tell, as with roots on the axis, who has the model counts
/// there once more.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{MultiPoly, RationalFunction};
/// use jurist_stability::boxes::{DelayedFunction, Side, ToleranceProblem};
/// // s + K exp(-theta s): stable for 0 < K theta < pi/2
/// let [k, one] = [MultiPoly::variable(0), MultiPoly::constant(1.into())];
/// let theta = RationalFunction::variable(1);
/// let terms = vec![(RationalFunction::zero(), vec![MultiPoly::constant(0.into()), one]), (theta.clone(), vec![k])];
/// let p = DelayedFunction::new(terms, vec![theta], Vec::new(), &[1.into(), 1.into()]).unwrap();
/// let sides = [(); 2].map(|()| Side::scaled(1.into(), ["1/10", "1/10"].map(|w| w.parse().unwrap())));
/// let boxes = ToleranceProblem::new(&p, sides.to_vec()).unwrap();
/// let budget = Budget::unlimited();
/// assert!(boxes.decide(&2.into(), &budget)?.is_stable());
/// // (1 + f/10)^2 = pi/2: f = 2.533...
/// let factor = boxes.largest_factor(&"1/1000".parse().unwrap(), None, &budget)?;
/// assert!(factor.lower > "2.53".parse().unwrap() && factor.upper.unwrap() < "2.54".parse().unwrap());
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DelayedFunction {
    parameters: usize,
    /// The dead times with the coefficients of the powers of `s`, that of zero first: a dead time that all have in common moves no root.
    pub(super) terms: Vec<(RationalFunction, Vec<MultiPoly>)>,
    /// The coefficients once more, split.
    pub(super) splits: Vec<Vec<Split>>,
    /// The loop has no meaning where one of these is negative.
    pub(super) times: Vec<RationalFunction>,
    /// What must not vanish: divisors, the value at `s = 0`, and the undelayed coefficient of the highest power of `s`.
    pub(super) certain: Vec<MultiPoly>,
    divisors: usize,
    /// The parameters inside of dead times.
    pub(super) inside: Vec<usize>,
    pub(super) order: usize,
    pub(super) rounded: RoundedLoop,
}

impl DelayedFunction {
    /// Of dead times with the coefficients of the powers of `s`, the dead times that are not to be negative, what the model divides by, and the
    /// usual point; `None` where it vanishes identically.
    ///
    /// Cost: the square-free parts of what must not vanish.
    pub fn new(
        terms: Vec<(RationalFunction, Vec<MultiPoly>)>,
        times: Vec<RationalFunction>,
        divisors: Vec<MultiPoly>,
        usual: &[Rational],
    ) -> Option<DelayedFunction> {
        let parameters = usual.len();
        let degree = |part: &Vec<MultiPoly>| part.iter().rposition(|c| !c.is_zero());
        let mut terms: Vec<_> = terms.into_iter().filter(|(_, part)| degree(part).is_some()).collect();
        let order = terms.iter().filter_map(|(_, part)| degree(part)).max()?;
        // Of those with the highest power of s the one with the least dead time is taken for undelayed.
        let highest = (0..terms.len()).filter(|&k| degree(&terms[k].1) == Some(order));
        let first = highest.min_by_key(|&k| terms[k].0.eval(usual))?;
        terms.swap(0, first);
        let least = terms[0].0.clone();
        for (time, part) in &mut terms {
            *time = &*time - &least;
            part.resize(order + 1, MultiPoly::zero());
        }
        let mut certain: Vec<MultiPoly> = Vec::new();
        for p in divisors.iter().chain(times.iter().map(RationalFunction::denominator)) {
            let p = without_squares(p);
            if !p.is_constant() && !certain.contains(&p) {
                certain.push(p);
            }
        }
        let divisors = certain.len();
        let at_zero = terms.iter().fold(MultiPoly::zero(), |sum, (_, part)| sum.plus(&part[0]));
        certain.extend([without_squares(&at_zero), without_squares(&terms[0].1[order])]);
        let mut inside: Vec<usize> = terms.iter().flat_map(|(time, _)| time.variables()).collect();
        inside.sort_unstable();
        inside.dedup();
        let split = |c: &MultiPoly| {
            let mut parts: BTreeMap<Vec<u32>, Vec<(Vec<u32>, Integer)>> = BTreeMap::new();
            for (monomial, c) in c.terms() {
                let (mut own, mut beside) = (monomial.exponents().to_vec(), vec![0; parameters]);
                for i in (0..own.len()).filter(|i| !inside.contains(i)) {
                    beside[i] = std::mem::take(&mut own[i]);
                }
                parts.entry(beside).or_default().push((own, c.clone()));
            }
            parts.into_iter().map(|(beside, terms)| (beside, MultiPoly::from_terms(terms))).collect()
        };
        let splits = terms.iter().map(|(_, part)| part.iter().map(split).collect()).collect();
        let rounded = RoundedLoop::of(&terms, &times, &certain);
        Some(DelayedFunction { parameters, terms, splits, times, certain, divisors, inside, order, rounded })
    }

    /// Whether there is a loop at a point: nothing is divided by zero, no dead time is negative.
    fn is_defined_at(&self, point: &[Rational]) -> bool {
        let is_time = |time: &RationalFunction| time.eval(point).is_some_and(|time| !time.is_negative());
        self.certain[..self.divisors].iter().all(|p| !p.eval(point).is_zero()) && self.times.iter().all(is_time)
    }

    /// The roots at a point that is not on the limit, as far as one walk along the imaginary axis tells.
    pub fn counted_at(&self, point: &[Rational]) -> Option<AtPoint> {
        checkpoint(2000);
        if !self.is_defined_at(point) {
            return Some(AtPoint::Undefined);
        }
        let values: Vec<Vec<Rational>> =
            self.terms.iter().map(|(_, part)| part.iter().map(|c| c.eval(point)).collect()).collect();
        let common = values.iter().flatten().fold(Integer::ONE, |l, x| l.lcm(&x.denominator()));
        let whole = |x: &Rational| MultiPoly::constant((x * &Rational::from(&common)).numerator());
        let mut terms: BTreeMap<DeadTime, Vec<MultiPoly>> = BTreeMap::new();
        for ((time, _), part) in self.terms.iter().zip(&values) {
            let time = DeadTime { offset: time.eval(point)?, ..DeadTime::default() };
            let own = terms.entry(time).or_insert_with(|| vec![MultiPoly::zero(); part.len()]);
            own.iter_mut().zip(part).for_each(|(sum, x)| *sum = sum.plus(&whole(x)));
        }
        match PlaneLoop::new(terms, Vec::new(), Vec::new()).verdict()? {
            BoxVerdict::Stable => Some(AtPoint::Delayed { on: 0, right: Some(0) }),
            BoxVerdict::Unstable { outside: Some(right) } => Some(AtPoint::Delayed { on: 0, right: Some(right) }),
            _ => None,
        }
    }

    /// Whether the loop is stable at a point; `None` where that is not seen.
    pub(super) fn seen_at(&self, point: &[Rational]) -> Option<bool> {
        // A root at s = 0.
        if self.certain[self.divisors].eval(point).is_zero() {
            return Some(false);
        }
        self.counted_at(point).map(|at| matches!(at, AtPoint::Delayed { on: 0, right: Some(0) }))
    }

    /// Whether a point seems not to be stable, in floating point.
    pub(super) fn seems_lost_at(&self, point: &[Rational], signs: &[Sign]) -> bool {
        let point: Vec<f64> = point.iter().map(Rational::to_f64_approximate).collect();
        !self.rounded.stable_approximate(&point, signs).0
    }

    fn signs(&self, point: &[Rational]) -> Vec<Sign> {
        self.certain.iter().map(|p| p.eval(point).sign()).collect()
    }
}

fn rational(numbers: Vec<f64>) -> Option<Vec<Rational>> {
    numbers.into_iter().map(Rational::from_f64).collect()
}

impl Family for DelayedFunction {
    type Line<'a> = DelayedLine<'a>;

    fn parameters(&self) -> usize {
        self.parameters
    }

    fn count(&self, point: &[Rational]) -> Option<AtPoint> {
        self.counted_at(point)
    }

    fn is_stable_at(&self, point: &[Rational]) -> bool {
        self.seen_at(point) == Some(true)
    }

    fn least_gap(&self) -> Rational {
        Rational::dyadic(&Integer::ONE, LEAST_GAP)
    }

    fn signs_at(&self, point: &[Rational]) -> Option<(Vec<Sign>, i64)> {
        let signs = self.signs(point);
        (!signs.contains(&Sign::Equal)).then_some((signs, 0))
    }

    fn line<'a>(&'a self, base: Vec<Rational>, step: Vec<Rational>, reference: &'a [Sign]) -> DelayedLine<'a> {
        let rounded = [&base, &step].map(|list| list.iter().map(Rational::to_f64_approximate).collect());
        DelayedLine { p: self, base, step, rounded, reference }
    }

    fn pulls(&self, point: &[Rational], _scale: i64) -> Vec<Vec<Rational>> {
        let signs = self.signs(point);
        let point: Vec<f64> = point.iter().map(Rational::to_f64_approximate).collect();
        let certain = signs.iter().enumerate().map(|(k, sign)| {
            let towards = if sign.is_gt() { 1.0 } else { -1.0 };
            self.rounded.gradient_approximate(&point, k).into_iter().map(|g| g * towards).collect()
        });
        certain.chain(self.rounded.pulls_approximate(&point)).filter_map(rational).collect()
    }

    fn prove(
        &self,
        sides: &[[Rational; 2]],
        (reference, scale): (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        self.proved(sides, (reference, scale), (cells, true), budget)
    }

    fn has_no_crossing(
        &self,
        sides: &[[Rational; 2]],
        known: (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        Ok(matches!(self.proved(sides, known, (cells, false), budget)?, Outcome::Stable(_)))
    }

    fn looks(&self) -> impl Fn(&BoxPart, &Budget) -> Result<BoxLook, Exhausted> {
        |part, budget| self.look(&part.sides, budget)
    }
}

/// The loop on the line `base + t step`.
pub struct DelayedLine<'a> {
    p: &'a DelayedFunction,
    base: Vec<Rational>,
    step: Vec<Rational>,
    rounded: [Vec<f64>; 2],
    reference: &'a [Sign],
}

impl DelayedLine<'_> {
    fn at_approximate(&self, t: f64) -> (bool, f64) {
        let [base, step] = &self.rounded;
        self.p.rounded.stable_approximate(&on_line(base, step, t), self.reference)
    }

    /// The stretch between a place that seems good and one that does not, narrowed to at most so many binary digits.
    fn narrowed_approximate(&self, [mut lo, mut hi]: [f64; 2], bits: u64) -> [f64; 2] {
        let [base, step] = &self.rounded;
        // Where the line moves little, its places are told apart less well.
        let moved = base.iter().zip(step).map(|(b, s)| (s * hi).abs() / (b + s * hi).abs().max((s * hi).abs()));
        let moved = moved.fold(0.0, f64::max).max(0.5f64.powi(DIGITS as i32 / 2));
        let share = 0.5f64.powi(bits as i32).max(0.5f64.powi(DIGITS as i32) / moved);
        let mut halvings = 0;
        while hi - lo > hi * share && hi > f64::MIN_POSITIVE {
            if halvings % 6 == 4 {
                // A root on the axis nearby is met at once.
                for from in [hi, lo] {
                    let near = (self.at_approximate(from).1, from);
                    let Some((_, t)) = self.p.rounded.crossing_approximate(base, step, near) else { continue };
                    let [below, above] = [t * (1.0 - share / 2.0), t * (1.0 + share / 2.0)];
                    if lo <= below && above <= hi && self.at_approximate(below).0 && !self.at_approximate(above).0 {
                        return [below, above];
                    }
                }
            }
            let middle = lo + (hi - lo) / 2.0;
            if middle <= lo || middle >= hi {
                break;
            }
            if self.at_approximate(middle).0 {
                lo = middle
            } else {
                hi = middle
            }
            halvings += 1;
        }
        [lo, hi]
    }
}

impl Path for DelayedLine<'_> {
    fn point(&self, t: &Rational) -> Vec<Rational> {
        self.base.iter().zip(&self.step).map(|(b, s)| b + &(s * t)).collect()
    }

    fn is_good(&self, t: &Rational) -> bool {
        let point = self.point(t);
        self.p.signs(&point) == self.reference && self.p.seen_at(&point) != Some(false)
    }

    fn seems_good(&self, t: &Rational) -> bool {
        self.at_approximate(t.to_f64_approximate()).0
    }

    fn is_stable(&self, t: &Rational) -> bool {
        self.p.seen_at(&self.point(t)) != Some(false)
    }

    /// What is found in floating point is counted in the end.
    fn is_good_for(&self, t: &Rational, _bits: u64) -> bool {
        self.seems_good(t)
    }

    fn narrowed(&self, lo: Rational, hi: Rational, bits: u64) -> Option<(Rational, Rational)> {
        let [near, far] = self.narrowed_approximate([&lo, &hi].map(Rational::to_f64_approximate), bits);
        let (near, far) = (Rational::from_f64(near)?.max(lo), Rational::from_f64(far)?.min(hi));
        if bits <= ROUGH_BITS {
            return Some((near, far));
        }
        // A dead time may be zero: the line is good up to there.
        let times = self.p.times.iter().filter_map(|time| {
            let [f, _] = polynomials_on_line([time.numerator(), &MultiPoly::one()], &self.base, &self.step);
            rational_zero(&f, &near, &far)
        });
        let near = times.min().filter(|t| self.is_good(t)).unwrap_or(near);
        // As much farther as rounding was off.
        let beyond = std::iter::once(far.clone())
            .chain(WIDENED.iter().map(|&bits| &far * &(&Rational::ONE + &Rational::dyadic(&Integer::ONE, bits))));
        let counted = beyond.clone().find(|t| self.p.seen_at(&self.point(t)) == Some(false));
        Some((near, counted.unwrap_or(far)))
    }

    /// By counts, which tell more than floating point.
    fn sharpened(&self, lo: &Rational, hi: &Rational, share: &Rational) -> (Rational, Rational) {
        let (mut lo, mut hi) = (lo.clone(), hi.clone());
        while &hi - &lo > &hi * share {
            let middle = lo.midpoint(&hi);
            match self.p.seen_at(&self.point(&middle)) {
                Some(true) => lo = middle,
                Some(false) => hi = middle,
                None => break,
            }
        }
        (lo, hi)
    }

    fn gradient(&self, lo: &Rational, hi: &Rational) -> Option<Gradient> {
        let [base, step] = &self.rounded;
        let [near, far] = [lo, hi].map(Rational::to_f64_approximate);
        let beyond = on_line(base, step, far);
        let by_parameter = match self.p.rounded.changed_approximate(&beyond, self.reference) {
            Some(k) => self.p.rounded.gradient_approximate(&beyond, k),
            None => {
                let (_, w) = self.at_approximate(far);
                let t = near + (far - near) / 2.0;
                let (w, t) = self.p.rounded.crossing_approximate(base, step, (w, t)).unwrap_or((w, t));
                self.p.rounded.motion_approximate(&on_line(base, step, t), w)
            }
        };
        Gradient::new(rational(by_parameter)?, &self.step)
    }

    /// Where what must not vanish does is often a simple number; beyond it the count tells.
    fn witness(&self, lo: &Rational, hi: &Rational) -> Option<Vec<Rational>> {
        let is_lost = |t: &Rational| self.p.seen_at(&self.point(t)) == Some(false);
        let zero = |f: &MultiPoly| {
            let [f, _] = polynomials_on_line([f, &MultiPoly::one()], &self.base, &self.step);
            rational_zero(&f, lo, hi)
        };
        let zeros = self.p.certain.iter().filter_map(zero).min().filter(is_lost);
        zeros.or_else(|| Some(hi.clone()).filter(is_lost)).map(|at| self.point(&at))
    }
}
