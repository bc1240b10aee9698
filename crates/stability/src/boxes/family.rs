//! What the search and the bracket ask of a loop with tolerances, whatever its characteristic function is.

use super::line::{Line, unit};
use super::look::BoxLook;
use super::polynomial::{BoxPolynomial, Bundle};
use super::prove::{Closing, Outcome, closed_by_constant, closed_by_vector, look, not_stable_near, prove, signs_at};
use crate::AtPoint;
use crate::subdivision::BoxPart;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::algebraic::simplest_between;

/// Stretches up to this many binary digits are found by rounded numbers.
pub(super) const ROUGH_BITS: u64 = 40;

/// Growth beyond this factor is not searched.
pub(super) const FARTHEST: u32 = 20;

/// Frequencies that give directions to begin with: `4^scale` times powers of two up to this one.
const OCTAVES: i64 = 5;

/// Constant vectors are given up after so many cells.
const CONSTANT_CELLS: usize = 4000;

/// A loop with tolerances.
pub trait Family {
    /// The loop on a straight line of parameters.
    type Line<'a>: Path
    where
        Self: 'a;

    /// The number of parameters.
    fn parameters(&self) -> usize;

    /// The root count at a point, where the loop alone tells it for certain; else who has the model counts there.
    fn count(&self, point: &[Rational]) -> Option<AtPoint>;

    /// True if the loop is stable at a point, as far as its rounded or enclosed coefficients tell.
    fn is_stable_at(&self, point: &[Rational]) -> bool;

    /// The signs of what must not vanish at a point, and the scale of frequencies there; `None` where one vanishes.
    fn signs_at(&self, point: &[Rational]) -> Option<(Vec<Sign>, i64)>;

    /// The line `base + t step` from a point at which the loop has these signs.
    fn line<'a>(&'a self, base: Vec<Rational>, step: Vec<Rational>, reference: &'a [Sign]) -> Self::Line<'a>;

    /// The gradients at a point of what is to become small where stability is lost.
    fn pulls(&self, point: &[Rational], scale: i64) -> Vec<Vec<Rational>>;

    /// The bracket of a limit is not asked to be narrower than this share of the way to it: near zero the limit itself says little of that.
    fn least_gap(&self) -> Rational {
        Rational::ZERO
    }

    /// Whether the last side is that of a number whose sign does not matter to the roots.
    fn is_mirrored(&self) -> bool {
        false
    }

    /// The polynomial, where it is one in the parameters alone or with narrow sides for constants.
    fn as_polynomial(&self) -> Option<&BoxPolynomial> {
        None
    }

    /// Whether [`Family::told_by_signs`] tells of it.
    fn may_be_told_by_signs(&self) -> bool {
        false
    }

    /// The same loop told by signs of polynomials in the parameters alone, where that is short.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    fn told_by_signs(&self, _budget: &Budget) -> Result<Option<Self>, Exhausted>
    where
        Self: Sized,
    {
        Ok(None)
    }

    /// Decides one box with at most so many cells; `known` are the signs and the scale at its nominal point.
    fn prove(
        &self,
        sides: &[[Rational; 2]],
        known: (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<Outcome, Exhausted>;

    /// Whether it is proved that no root crosses the boundary in a box, with at most so many cells: then all its points have as many roots outside. The
    /// point of the signs may be stable or not.
    fn has_no_crossing(
        &self,
        sides: &[[Rational; 2]],
        known: (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        Ok(matches!(self.prove(sides, known, cells, budget)?, Outcome::Stable(_)))
    }

    /// Looks at boxes, one after another: what is learned of one may serve the next.
    fn looks(&self) -> impl Fn(&BoxPart, &Budget) -> Result<BoxLook, Exhausted>;
}

/// How what vanishes at a crossing depends on the parameters.
pub struct Gradient {
    /// The derivative by each parameter, all times the same number.
    pub by_parameter: Vec<Rational>,
    /// The derivative along the line.
    pub along: Rational,
}

impl Gradient {
    /// From the derivatives; `None` where nothing changes along the line.
    pub fn new(by_parameter: Vec<Rational>, step: &[Rational]) -> Option<Gradient> {
        let along = by_parameter.iter().zip(step).fold(Rational::ZERO, |sum, (g, s)| sum + g * s);
        (!along.is_zero()).then_some(Gradient { by_parameter, along })
    }

    /// For each parameter the side that brings the crossing nearer.
    pub fn wanted(&self) -> Vec<Rational> {
        let along = self.along.sign();
        let side = |g: &Rational| if along.is_gt() { unit(g.sign()) } else { unit(g.sign().reverse()) };
        self.by_parameter.iter().map(side).collect()
    }
}

/// A loop on a straight line of parameters, stable where the line begins.
pub trait Path {
    /// The point at `t`.
    fn point(&self, t: &Rational) -> Vec<Rational>;

    /// Whether nothing that must not vanish has changed its sign and all roots are in the region: if not, a point between the
    /// stable one and this is not stable.
    fn is_good(&self, t: &Rational) -> bool;

    /// [`Path::is_good`] by rounded numbers, for the search.
    fn seems_good(&self, t: &Rational) -> bool {
        self.is_good(t)
    }

    /// Whether `t` is taken for good where the crossing is to be known to so many bits.
    fn is_good_for(&self, t: &Rational, bits: u64) -> bool {
        if bits <= ROUGH_BITS { self.seems_good(t) } else { self.is_good(t) }
    }

    /// Whether the loop is stable at `t` itself.
    fn is_stable(&self, t: &Rational) -> bool;

    /// What vanishes in a narrow stretch and how it depends on the parameters; `None` where that cannot be told.
    fn gradient(&self, lo: &Rational, hi: &Rational) -> Option<Gradient>;

    /// A rational number in `(lo, hi]` where something vanishes that must not.
    fn rational_zero(&self, _lo: &Rational, _hi: &Rational) -> Option<Rational> {
        None
    }

    /// The first stretch after a good place and up to another in which something vanishes, to so many bits; `None` where only places one by one are told.
    fn first_zero(&self, _from: &Rational, _to: &Rational, _bits: u64) -> Option<Option<(Rational, Rational)>> {
        None
    }

    /// A stretch `(lo, hi)` in which stability is lost, of width at most `hi / 2^bits`: `lo` is good, `hi` is not; up to
    /// 40 by rounded numbers only. Looked for up to `limit`; `None` where nothing is found.
    fn crossing(&self, limit: Option<&Rational>, bits: u64) -> Option<(Rational, Rational)> {
        let farthest = Rational::from(1i64 << FARTHEST);
        if let Some(found) = self.first_zero(&Rational::ZERO, limit.unwrap_or(&farthest), bits) {
            return found;
        }
        let is_good = |t: &Rational| self.is_good_for(t, bits);
        let (mut lo, mut hi) = (Rational::ZERO, None);
        match limit {
            Some(limit) => {
                for part in 1..=4 {
                    let t = limit * &Rational::new(part.into(), 4.into());
                    if !is_good(&t) {
                        hi = Some(t);
                        break;
                    }
                    lo = t;
                }
            }
            None => {
                for power in -12..=FARTHEST as i64 {
                    let t = Rational::from(2).pow(power).expect("two is not zero");
                    if !is_good(&t) {
                        hi = Some(t);
                        break;
                    }
                    lo = t;
                }
            }
        }
        self.narrowed(lo, hi?, bits)
    }

    /// The stretch between a good and another place, narrowed.
    fn narrowed(&self, lo: Rational, hi: Rational, bits: u64) -> Option<(Rational, Rational)> {
        if let Some(Some(found)) = self.first_zero(&lo, &hi, bits) {
            return Some(found);
        }
        let (near, far) = halved(lo.clone(), hi.clone(), bits.min(ROUGH_BITS), |t| self.seems_good(t));
        if bits <= ROUGH_BITS {
            return Some((near, far));
        }
        // A little wider than rounding can be off.
        let room = &far * &Rational::dyadic(&Integer::ONE, ROUGH_BITS - 2);
        let (near, far) = ((&near - &room).max(lo.clone()), (&far + &room).min(hi.clone()));
        let is_right = self.is_good(&near) && !self.is_good(&far);
        let (lo, hi) = if is_right { (near, far) } else { (lo, hi) };
        Some(halved(lo, hi, bits, |t| self.is_good(t)))
    }

    /// A crossing's stretch, narrowed to so large a share of its end, as far as that is told.
    fn sharpened(&self, lo: &Rational, hi: &Rational, _share: &Rational) -> (Rational, Rational) {
        (lo.clone(), hi.clone())
    }

    /// A rational point in `(lo, hi]` that is not stable.
    fn witness(&self, lo: &Rational, hi: &Rational) -> Option<Vec<Rational>> {
        let candidate = |t: &Rational| (!self.is_stable(t)).then(|| self.point(t));
        // A divisor that vanishes: the simplest number is where, if it is a rational one of a few digits.
        let simple = || simplest_between(lo, &(hi + &(hi - lo)));
        candidate(hi)
            .or_else(|| candidate(&self.rational_zero(lo, hi)?))
            .or_else(|| simple().filter(|t| t <= hi).as_ref().and_then(candidate))
    }
}

/// Halves a stretch until its width is at most `hi / 2^bits`.
fn halved(mut lo: Rational, mut hi: Rational, bits: u64, is_good: impl Fn(&Rational) -> bool) -> (Rational, Rational) {
    let share = Rational::dyadic(&Integer::ONE, bits);
    let least = Rational::dyadic(&Integer::ONE, 200);
    while &hi - &lo > &hi * &share && hi > least {
        let middle = lo.midpoint(&hi);
        if is_good(&middle) { lo = middle } else { hi = middle }
    }
    (lo, hi)
}

/// Gradients of what must not vanish, and of the pair's modulus at some frequencies, at a point `a_i / q_i`, each with the sign
/// that the function has.
pub(super) fn pulls_of(
    certain: &[Bundle],
    pair: &Bundle,
    (a, q): (&[Integer], &[Integer]),
    scale: i64,
) -> Vec<Vec<Rational>> {
    let mut functions = Vec::new();
    for bundle in certain {
        let value = bundle.values(a, q).remove(0);
        functions.push(bundle.combined(1, |c| vec![&c[0] * &value]));
    }
    let k = pair.width / 2 - 1;
    let values = pair.values(a, q);
    for octave in -OCTAVES..=OCTAVES {
        let power = 2 * scale + octave;
        let weight = |j: usize| Integer::ONE << (power.unsigned_abs() * (if power >= 0 { j } else { k - j }) as u64);
        let weights: Vec<Integer> = (0..=k).map(weight).collect();
        let at = |c: &[Integer], odd: usize| {
            c[odd * (k + 1)..].iter().zip(&weights).fold(Integer::ZERO, |sum, (c, w)| sum + c * w)
        };
        // omega^2 is the weight of the odd part in the square of the modulus.
        let (mut x, mut y) = (at(&values, 0), at(&values, 1));
        if power >= 0 {
            y = &y << power.unsigned_abs()
        } else {
            x = &x << power.unsigned_abs()
        }
        functions.push(pair.combined(1, |c| vec![&(&at(c, 0) * &x) + &(&at(c, 1) * &y)]));
    }
    functions.iter().map(|f| f.gradient(a, q)).collect()
}

impl Family for BoxPolynomial {
    type Line<'a> = Line<'a>;

    fn parameters(&self) -> usize {
        BoxPolynomial::parameters(self)
    }

    fn count(&self, point: &[Rational]) -> Option<AtPoint> {
        Some(self.at(point))
    }

    fn is_stable_at(&self, point: &[Rational]) -> bool {
        BoxPolynomial::is_stable_at(self, point)
    }

    fn signs_at(&self, point: &[Rational]) -> Option<(Vec<Sign>, i64)> {
        signs_at(self, point)
    }

    fn line<'a>(&'a self, base: Vec<Rational>, step: Vec<Rational>, reference: &'a [Sign]) -> Line<'a> {
        Line::new(self, base, step, reference)
    }

    fn pulls(&self, point: &[Rational], scale: i64) -> Vec<Vec<Rational>> {
        let (a, q): (Vec<Integer>, Vec<Integer>) = point.iter().map(|x| (x.numerator(), x.denominator())).unzip();
        let certain: Vec<Bundle> = self.certain.iter().map(|(_, f)| Bundle::new(&[f], point.len())).collect();
        pulls_of(&certain, &self.pair(), (&a, &q), scale)
    }

    fn is_mirrored(&self) -> bool {
        self.excluded().mirrored
    }

    fn as_polynomial(&self) -> Option<&BoxPolynomial> {
        Some(self)
    }

    fn may_be_told_by_signs(&self) -> bool {
        self.has_short_determinant()
    }

    fn told_by_signs(&self, budget: &Budget) -> Result<Option<Self>, Exhausted> {
        self.by_determinant(budget)
    }

    fn prove(
        &self,
        sides: &[[Rational; 2]],
        known: (&[Sign], i64),
        cells: usize,
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        let by = |closing: Closing, cells: usize| prove(self, sides, known.0, known.1, (closing, cells), budget);
        match by(&closed_by_constant, cells.min(CONSTANT_CELLS))? {
            Outcome::Open { .. } => Ok(match by(&closed_by_vector, cells)? {
                Outcome::Open { why, cell } => match not_stable_near(self, &cell, sides) {
                    Some(point) => Outcome::Refuted(point),
                    None => Outcome::Open { why, cell },
                },
                outcome => outcome,
            }),
            outcome => Ok(outcome),
        }
    }

    fn looks(&self) -> impl Fn(&BoxPart, &Budget) -> Result<BoxLook, Exhausted> {
        |part, budget| budget.enter(|| look(self, &part.sides, budget))?
    }
}
