//! All values of a parameter that is inside of functions of a loop with dead time.
//!
//! The range is cut into pieces. On each of them the coefficients are Taylor polynomials in the share of the piece, with a bound of how far they may be off:
//! the factor of the first power that is left out lies between bounds anywhere in the piece, and the derivatives of the rest are as large as those of that
//! power with this factor (Lagrange). So a piece is a loop of enclosed coefficients. Next to its ends it stands for any smooth continuation of the coefficients
//! within the same bounds; zeros that are not strictly inside of the piece are left out.

use super::enclosed::Enclosed;
use super::family::FamilyLoop;
use super::family_function::Line;
use super::fixed_factor::{Known, without_fixed_factor};
use super::gain::{GainCells, NotSolved};
use super::share::Share;
use super::stable_set::{Counted, end_at_point, end_of_domain};
use super::windows::Never;
use crate::{Cause, End, Range, StableSet, UndecidedBracket};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use jurist_algebra::symbols::{DefinedParts, MovingSymbols};
use std::sync::Arc;

/// `sum P_k(s; p) z^k` as [`FamilyLoop`] has it, with coefficients that are polynomials in the parameter and in functions of it.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
/// use jurist_algebra::symbols::{Definition, MovingSymbols};
/// use jurist_stability::Range;
/// use jurist_stability::dead_time::{Line, MovingLoop};
/// // s + exp(p) exp(-s): stable for exp(p) < pi/2
/// let symbols = MovingSymbols::new(vec![("X".into(), Definition::Exponential(RationalFunction::variable(0)))]);
/// let parts = vec![vec![MultiPoly::zero(), MultiPoly::one()], vec![MultiPoly::variable(1)]];
/// let family = MovingLoop::new(parts, Vec::new(), symbols, Line::constant(1.into()), Line::constant(0.into()));
/// let range = Range::between(Some((-1).into()), Some(1.into()));
/// let set = family.stable_set(&range, &Budget::unlimited()).unwrap().unwrap();
/// assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.decimal(10), "0.4515827053");
/// ```
#[derive(Clone, Debug)]
pub struct MovingLoop {
    known: Known,
    coefficients: Vec<Vec<MultiPoly>>,
    /// Where one of them vanishes the loop is undefined.
    poles: Vec<MultiPoly>,
    symbols: MovingSymbols,
    tau: Line,
    decay: Line,
}

/// Bits of the coefficients of a piece.
pub(super) const BITS: u64 = 64;

/// Bits with which a piece is looked at once more.
pub(super) const MORE_BITS: u64 = 256;

/// A piece is short enough where so many terms leave out this part of each coefficient, a power of two.
const TERMS: usize = 16;
const LEFT_OUT: u64 = 36;

/// Pieces that have been halved so often are given up: where a function has no value, and where roots touch the line.
const MOST_HALVINGS: usize = 32;
const MOST_HALVINGS_AT_ROOTS: usize = 10;

/// After so many pieces with roots that touch the line, further ones are halved less often: roots may be on the line everywhere.
const MANY_AT_ROOTS: usize = 16;
const FEWER_HALVINGS_AT_ROOTS: usize = 3;

const WHY_VALUES: &str = "a function has no value there, or no series";
const WHY_ROOTS: &str = "roots stay on the boundary, meet there, or only touch it";

const GUARD: u64 = 16;

impl MovingLoop {
    /// From the coefficient of `z^k s^j` at `[k][j]`, a polynomial in the parameter (0) and in symbols behind it, from what must not vanish, and from the dead
    /// time and the decay, as [`FamilyLoop::new`] takes them. A factor with rational coefficients that divides all parts is left out; where it has a root on
    /// the line or to the right of it, no value is stable.
    ///
    /// # Panics
    /// When all coefficients are zero.
    pub fn new(
        coefficients: Vec<Vec<MultiPoly>>,
        poles: Vec<MultiPoly>,
        symbols: MovingSymbols,
        tau: Line,
        decay: Line,
    ) -> MovingLoop {
        let (factor, coefficients) = without_fixed_factor(coefficients);
        MovingLoop { known: Known::new(&coefficients, &factor), coefficients, poles, symbols, tau, decay }
    }

    /// The values of a range with both ends for which the loop is stable, or why there is none.
    ///
    /// Cost: that of [`family_cells`](super::family_cells) for each piece, with coefficients of degree 16 and more.
    ///
    /// # Errors
    /// [`NotSolved`], as [`family_cells`](super::family_cells). Where roots meet on the line, and where a function has no value, short brackets stay undecided.
    pub fn stable_set(&self, range: &Range, budget: &Budget) -> Result<Result<StableSet, Never>, NotSolved> {
        let (Some(lower), Some(upper)) = (&range.lower, &range.upper) else { return Err(NotSolved::Unbounded) };
        let mut all = StableSet::from_intervals(Vec::new(), Vec::new());
        if lower >= upper {
            return Ok(Ok(all));
        }
        if let Some(never) = self.known.never(self.decay.is_zero()) {
            return Ok(Err(never));
        }
        let DefinedParts { parts, gaps } = self.symbols.defined_parts(lower, upper, budget)?;
        for (lower, upper) in &parts {
            match self.stable_set_between(lower, upper, budget)? {
                Ok(set) => all = all.followed_by(set, None),
                Err(never) => return Ok(Err(never)),
            }
        }
        // Where an argument of a square root changes its sign.
        let gap = |(lower, upper): (Rational, Rational)| UndecidedBracket::new(Some(lower), Some(upper), WHY_VALUES);
        let mut open: Vec<UndecidedBracket> = gaps.into_iter().map(gap).chain(all.undecided().to_vec()).collect();
        open.sort_by(|a, b| a.lower.cmp(&b.lower));
        Ok(Ok(StableSet::from_intervals(all.intervals().to_vec(), open)))
    }

    /// The same of a range in which no argument of a square root changes its sign.
    fn stable_set_between(
        &self,
        lower: &Rational,
        upper: &Rational,
        budget: &Budget,
    ) -> Result<Result<StableSet, Never>, NotSolved> {
        let mut open = vec![(Share { lower: lower.clone(), length: upper - lower }, [0, 0])];
        let mut run = Run::from(lower);
        let mut found = StableSet::from_intervals(Vec::new(), Vec::new());
        let (mut open_brackets, mut joints): (Vec<UndecidedBracket>, Vec<Rational>) = (Vec::new(), Vec::new());
        let mut at_roots = 0;
        while let Some((share, [long, rooted])) = open.pop() {
            budget.check()?;
            let family = budget.enter(|| self.on(&share, BITS))?;
            let halved = if family.is_none() { [long + 1, rooted] } else { [long, rooted + 1] };
            let cells = match family {
                Some(family) => share.cells(&family, budget)?.map(|cells| (family, cells)),
                None => None,
            };
            match cells {
                Some((family, Ok(cells))) => {
                    let joint = end_of_domain(&family, &Rational::ZERO, budget)?;
                    if !run.is_empty() && joint.causes.iter().next().is_some() {
                        // A root is at s = 0 just where two pieces meet.
                        let run = std::mem::replace(&mut run, Run::from(&share.lower));
                        found = found.followed_by(self.set_of(run, budget)?, None);
                        joints.push(share.lower.clone());
                    }
                    run.take(&share, &family, cells, budget)?;
                }
                Some((_, Err(never))) => return Ok(Err(never)),
                None if halved[0] > MOST_HALVINGS || halved[1] > halvings_at_roots(at_roots) => {
                    at_roots += usize::from(halved[1] > rooted);
                    let end = share.at(&Rational::ONE);
                    let run = std::mem::replace(&mut run, Run::from(&end));
                    found = found.followed_by(self.set_of(run, budget)?, None);
                    let why = if long < MOST_HALVINGS { WHY_ROOTS } else { WHY_VALUES };
                    match open_brackets.last_mut() {
                        Some(last) if last.upper.as_ref() == Some(&share.lower) => last.upper = Some(end),
                        _ => open_brackets.push(UndecidedBracket::new(Some(share.lower), Some(end), why)),
                    }
                }
                None => open.extend(share.halves().map(|half| (half, halved))),
            }
        }
        let mut found = found.followed_by(self.set_of(run, budget)?, None);
        let is_joint = |end: &&mut End| end.value.exact().is_some_and(|value| joints.contains(&value));
        found.ends_mut().filter(is_joint).for_each(|end| end.causes.remove(Cause::Domain));
        Ok(Ok(StableSet::from_intervals(found.intervals().to_vec(), open_brackets)))
    }

    /// The stable set of a run of pieces.
    fn set_of(&self, mut run: Run, budget: &Budget) -> Result<StableSet, NotSolved> {
        let range = Range::between(Some(run.lower.clone()), Some(run.upper.clone()));
        if run.is_empty() {
            return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
        }
        self.cut_at_poles(&mut run.all, &range, &mut run.bounds, budget)?;
        let ends = run.all.points.iter().map(|point| end_at_point(point, budget)).collect();
        let stable = run.all.right.iter().map(|count| *count == Some(0)).collect();
        Ok(Counted { ends, stable, bounds: run.bounds }.stable_set(&range, budget)?)
    }

    /// Poles that depend on the parameter alone; others vanish nowhere in a piece.
    fn cut_at_poles(
        &self,
        cells: &mut GainCells,
        range: &Range,
        bounds: &mut [End],
        budget: &Budget,
    ) -> Result<(), NotSolved> {
        let poles: Vec<UniPoly> = self.poles.iter().filter_map(|pole| pole.to_univariate(0)).collect();
        for end in bounds {
            let value = end.value.exact().expect("an end of the domain");
            if poles.iter().any(|pole| pole.sign_at(&value).is_eq()) {
                end.causes.insert(Cause::Pole);
            }
        }
        cells.cut_at_poles(&poles, range, budget)?;
        Ok(())
    }

    /// The loop in the share of a piece, its coefficients with so many bits; `None` where a function has no value, a divisor may vanish, a multiple
    /// root is at `s = 0` at an end, or the piece is too long.
    fn on(&self, share: &Share, bits: u64) -> Option<FamilyLoop> {
        let (lo, hi) = (&share.lower, &share.at(&Rational::ONE));
        let moving = self.poles.iter().filter(|pole| pole.to_univariate(0).is_none()).cloned().collect::<Vec<_>>();
        let whole = self.symbols.enclose(&moving, &Ball::between(lo, hi, bits))?;
        if whole.iter().any(Ball::contains_zero) {
            return None;
        }
        let terms = self.terms(share, [TERMS, TERMS], LEFT_OUT)?;
        let family = self.rounded(share, terms, bits);
        let is_regular = [Rational::ZERO, Rational::ONE].iter().all(|end| !family.has_multiple_zero_at(end));
        is_regular.then_some(family)
    }

    /// The Taylor polynomials of the coefficients that are no polynomials in the parameter.
    fn expanded(&self, share: &Share, terms: usize, bits: u64) -> Option<Vec<Vec<Ball>>> {
        checkpoint(64 * (terms * terms) as u64);
        let all = self.coefficients.iter().flatten().filter(|c| c.to_univariate(0).is_none());
        let list: Vec<MultiPoly> = all.cloned().collect();
        self.symbols.taylor_from_end(&list, &share.lower, &share.at(&Rational::ONE), terms, bits)
    }

    /// How many terms, so many at least and at most, leave out no more than such a part of each coefficient, a power of two.
    fn terms(&self, share: &Share, [least, most]: [usize; 2], left_out: u64) -> Option<usize> {
        let mut terms = least;
        while terms <= most {
            let found = self.expanded(share, terms, 2 * left_out)?;
            let is_short = |list: &Vec<Ball>| {
                let size = |ball: &Ball| ball.magnitude_units();
                let (last, others) = list.split_last().expect("there is a rest");
                size(last) << left_out <= others.iter().fold(Integer::ONE << left_out, |sum, c| sum + size(c))
            };
            if found.iter().all(is_short) {
                return Some(terms);
            }
            terms += terms / 4;
        }
        None
    }

    /// The loop of enclosed coefficients, from which those with more bits are made.
    fn rounded(&self, share: &Share, terms: usize, bits: u64) -> FamilyLoop {
        let unit = share.lower.denominator().lcm(&share.length.denominator());
        let plain = |c: &MultiPoly| c.to_univariate(0);
        let degrees = self.coefficients.iter().flatten().filter_map(|c| plain(c)?.degree());
        let unit = unit.pow(degrees.max().unwrap_or(0) as u64);
        let working = bits + GUARD + unit.bit_length();
        let expanded = self.expanded(share, terms, working).expect("fewer bits told as much");
        let mut expanded = expanded.into_iter();
        let mut one = |c: &MultiPoly| -> [UniPoly; 2] {
            if let Some(c) = plain(c) {
                let moved = share.moved(&c).into_iter().map(|c| (c * Rational::from(&unit)).numerator() << bits);
                return [UniPoly::new(moved.collect()), UniPoly::zero()];
            }
            let number = |ball: &Ball| {
                let ball = ball.scaled(&unit);
                (ball.middle_units() >> (working - bits), (ball.width_units() >> (working - bits)) + Integer::from(2))
            };
            let balls = expanded.next().expect("as many");
            let (mut numbers, mut errors): (Vec<Integer>, Vec<Integer>) = balls.iter().map(number).unzip();
            // A root may be at s = 0 where the domain begins.
            let vanishes = || self.symbols.vanishes_at(&c.clone().into(), &share.lower, &Budget::unlimited());
            if balls[0].contains_zero() && vanishes().unwrap_or(false) {
                (numbers[0], errors[0]) = (Integer::ZERO, Integer::ZERO);
            }
            [UniPoly::new(numbers), UniPoly::new(errors)]
        };
        let both: Vec<Vec<[UniPoly; 2]>> =
            self.coefficients.iter().map(|part| part.iter().map(&mut one).collect()).collect();
        let [parts, errors] =
            [0, 1].map(|i| both.iter().map(|part| part.iter().map(|c| c[i].clone()).collect()).collect());
        let (own, of) = (self.clone(), share.clone());
        let at = Arc::new(move |bits: u64| {
            // As many bits for each term as at first, or at least one.
            let [least, most] = [bits * TERMS as u64 / LEFT_OUT, bits + TERMS as u64].map(|terms| terms as usize);
            let terms = own.terms(&of, [least.max(TERMS), most], bits).unwrap_or(most);
            own.rounded(&of, terms, bits)
        });
        let [tau, decay] = [&self.tau, &self.decay].map(|line| share.line(line));
        FamilyLoop { parts, enclosed: Some(Enclosed::new(errors, bits, at)), tau, decay, is_stretched: false }
    }
}

/// How often a piece with roots that touch the line is halved, where so many of them were given up.
fn halvings_at_roots(given_up: usize) -> usize {
    if given_up < MANY_AT_ROOTS { MOST_HALVINGS_AT_ROOTS } else { FEWER_HALVINGS_AT_ROOTS }
}

/// Neighbouring pieces that are decided.
struct Run {
    lower: Rational,
    upper: Rational,
    all: GainCells,
    bounds: Vec<End>,
}

impl Run {
    fn from(value: &Rational) -> Run {
        let mut all = GainCells::constant(false);
        all.right.clear();
        Run { lower: value.clone(), upper: value.clone(), all, bounds: Vec::new() }
    }

    fn is_empty(&self) -> bool {
        self.all.right.is_empty()
    }

    /// Takes the piece above.
    fn take(&mut self, share: &Share, family: &FamilyLoop, cells: GainCells, budget: &Budget) -> Result<(), NotSolved> {
        let end = |at: Rational| -> Result<End, NotSolved> {
            let end = end_of_domain(family, &at, budget)?;
            Ok(End { value: share.at(&at).into(), ..end })
        };
        match self.bounds.is_empty() {
            true => self.bounds = vec![end(Rational::ZERO)?, end(Rational::ONE)?],
            false => self.bounds[1] = end(Rational::ONE)?,
        }
        self.upper = share.at(&Rational::ONE);
        self.all.points.extend(cells.points);
        // The cell about a joint is one.
        self.all.right.extend(cells.right.into_iter().skip(usize::from(!self.all.right.is_empty())));
        Ok(())
    }
}
