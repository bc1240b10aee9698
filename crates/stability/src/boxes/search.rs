//! Looking for the nearest point that is not stable. Whatever is found is exact; that nothing nearer exists, the proof says.

use super::family::{Family, Gradient, Path};
use super::line::{rounded, unit};
use super::sides::Side;
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::algebraic::simplest_between;
use std::cmp::Ordering;

/// While directions are compared, crossings are known to so many binary digits.
const COARSE: u64 = 36;

/// The crossing of the best direction, in the end.
const FINE: u64 = 60;

/// Rounds of improving one direction.
const ROUNDS: usize = 12;

/// Halvings while one coordinate is sought.
const COORDINATE_BITS: u32 = 26;

/// A coordinate whose weight is `2^-LEAST_WEIGHT` of the greatest is not sought on its own.
const LEAST_WEIGHT: u32 = 12;

/// Rounds of turning such coordinates at the end.
const SETTLINGS: usize = 4;

/// Parts of the range of an angle that are tried to begin with.
const ANGLES: i64 = 4;

/// A direction from the nominal point and where stability is lost along it.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    /// For each parameter a number from -1 to 1: the share of its width.
    pub direction: Vec<Rational>,
    /// A factor at which the point of the direction is still good.
    pub lo: Rational,
    /// A factor at or before which a point of the direction is not stable.
    pub hi: Rational,
}

/// The nearest points that are not stable, as far as they are found.
pub struct Search<'a, F: Family> {
    p: &'a F,
    sides: &'a [Side],
    reference: &'a [Sign],
    /// The nearest crossing so far.
    pub(super) best: Option<Crossing>,
}

impl<'a, F: Family> Search<'a, F> {
    pub(super) fn new(p: &'a F, sides: &'a [Side], reference: &'a [Sign]) -> Self {
        Search { p, sides, reference, best: None }
    }

    /// The line in a direction; the factor is its parameter.
    pub(super) fn line(&self, direction: &[Rational]) -> F::Line<'a> {
        let (base, step) = ray(self.sides, direction);
        self.p.line(base, step, self.reference)
    }

    /// The direction through a point, if it has any.
    pub(super) fn towards(&self, point: &[Rational]) -> Option<Vec<Rational>> {
        let shares = self.sides.iter().zip(point).map(|(side, x)| {
            let offset = x - side.nominal();
            offset.checked_div(side.width(offset.sign())).unwrap_or(Rational::ZERO)
        });
        self.normalised(shares.collect())
    }

    /// The least factor whose box holds a point.
    pub(super) fn factor_of(&self, point: &[Rational]) -> Rational {
        let shares = self.sides.iter().zip(point).filter(|(side, _)| side.grows()).map(|(side, x)| {
            let offset = x - side.nominal();
            offset.abs().checked_div(side.width(offset.sign())).unwrap_or(Rational::ZERO)
        });
        shares.max().unwrap_or(Rational::ZERO)
    }

    /// The greatest share of a growing side is 1; where a side has no width on that side, its share is 0.
    fn normalised(&self, mut direction: Vec<Rational>) -> Option<Vec<Rational>> {
        for (c, side) in direction.iter_mut().zip(self.sides) {
            if side.width(c.sign()).is_zero() {
                *c = Rational::ZERO;
            }
        }
        let growing: Vec<usize> = (0..self.sides.len()).filter(|&i| self.sides[i].grows()).collect();
        let greatest = growing.iter().map(|&i| direction[i].abs()).max()?;
        if greatest.is_zero() {
            // One parameter that can only go one way goes that way.
            let [only] = growing.as_slice() else { return None };
            let towards = if self.sides[*only].width(Ordering::Greater).is_zero() { -1 } else { 1 };
            direction[*only] = Rational::from(towards);
            return Some(direction);
        }
        for &i in &growing {
            direction[i] = direction[i].checked_div(&greatest)?;
        }
        Some(direction)
    }

    /// Directions to begin with: those that move each certain polynomial, and the pair at some frequencies, towards zero.
    fn starts(&self, scale: i64) -> Vec<Vec<Rational>> {
        let nominal: Vec<Rational> = self.sides.iter().map(|s| s.nominal().clone()).collect();
        let mut starts: Vec<Vec<Rational>> = Vec::new();
        for gradient in self.p.pulls(&nominal, scale) {
            let direction = gradient.iter().map(|g| unit(g.sign().reverse())).collect();
            if let Some(direction) = self.normalised(direction)
                && !starts.contains(&direction)
            {
                starts.push(direction);
            }
        }
        if self.p.is_mirrored() {
            // The worst angle may be any.
            let last = self.sides.len() - 1;
            for direction in starts.clone() {
                starts.extend((1..ANGLES).map(|part| {
                    let mut direction = direction.clone();
                    direction[last] = Rational::new((-part).into(), ANGLES.into());
                    direction
                }));
            }
        }
        starts
    }

    /// Begins from directions of its own.
    pub(super) fn run(&mut self, scale: i64) {
        for start in self.starts(scale) {
            self.improve(start, None);
        }
        self.refine();
    }

    /// Begins from a point that is not stable; whether a crossing before the known one was found. That the known one became narrower tells nothing new.
    pub(super) fn run_from(&mut self, point: &[Rational]) -> bool {
        let before = self.best.as_ref().map(|b| b.lo.clone());
        if let Some(direction) = self.towards(point) {
            self.improve(direction, Some(self.factor_of(point)));
        }
        self.refine();
        match (&self.best, before) {
            (Some(best), Some(before)) => best.hi <= before,
            (best, _) => best.is_some(),
        }
    }

    /// The crossing in a direction, if it is nearer than the best.
    fn nearer(&self, direction: &[Rational], than: Option<&Rational>) -> Option<(Crossing, F::Line<'a>)> {
        let line = self.line(direction);
        let (lo, hi) = line.crossing(than, COARSE)?;
        Some((Crossing { direction: direction.to_vec(), lo, hi }, line))
    }

    /// Turns each coordinate to the side that brings the crossing nearer, until none helps. On the line there may be a crossing before `near`.
    fn improve(&mut self, start: Vec<Rational>, near: Option<Rational>) {
        let best = self.best.as_ref().map(|b| b.hi.clone());
        let near = near.filter(|near| !near.is_zero() && best.as_ref().is_none_or(|best| near < best));
        let found = near.and_then(|near| self.nearer(&start, Some(&near)));
        let Some((mut current, mut line)) = found.or_else(|| self.nearer(&start, best.as_ref())) else { return };
        for _ in 0..ROUNDS {
            let closer = || {
                let (lo, hi) = line.crossing(Some(&(&current.hi + &current.hi)), FINE)?;
                line.gradient(&lo, &hi)
            };
            let Some(gradient) = line.gradient(&current.lo, &current.hi).or_else(closer) else { break };
            let wanted: Vec<Rational> = gradient.wanted();
            let Some(turned) = self.normalised(wanted.clone()) else { break };
            if turned == current.direction {
                break;
            }
            if let Some((better, its_line)) = self.nearer(&turned, Some(&current.hi))
                && better.hi < current.hi
            {
                (current, line) = (better, its_line);
                continue;
            }
            let before = current.hi.clone();
            let weights = self.weights(&gradient, &wanted);
            let most = weights.iter().max().cloned().unwrap_or_default();
            for (i, towards) in wanted.iter().enumerate() {
                let matters = &weights[i] * &Rational::from(1 << LEAST_WEIGHT) >= most;
                if *towards != current.direction[i] && matters && !weights[i].is_zero() {
                    current = self.along_coordinate(current, i, towards.clone());
                }
            }
            let gained = &before - &current.hi;
            if gained <= &before * &Rational::dyadic(&Integer::ONE, 30) {
                break;
            }
            line = self.line(&current.direction);
        }
        if self.best.as_ref().is_none_or(|best| current.hi < best.hi) {
            self.best = Some(current);
        }
    }

    /// How much each parameter moves the polynomial that vanishes, over its width on the side of a direction.
    fn weights(&self, gradient: &Gradient, direction: &[Rational]) -> Vec<Rational> {
        let parts = gradient.by_parameter.iter().zip(self.sides.iter().zip(direction));
        parts.map(|(g, (side, c))| (g * side.width(c.sign())).abs()).collect()
    }

    /// Turns the coordinates that hardly matter to their sides, where that brings the crossing no farther.
    fn settle(&mut self) {
        for _ in 0..SETTLINGS {
            let Some(best) = &self.best else { return };
            let Some(gradient) = self.line(&best.direction).gradient(&best.lo, &best.hi) else { return };
            let weights = self.weights(&gradient, &best.direction);
            let most = weights.iter().max().cloned().unwrap_or_default();
            let turn = |((new, old), weight): ((Rational, &Rational), &Rational)| {
                if weight * &Rational::from(1 << LEAST_WEIGHT) < most || old.abs() == Rational::ONE {
                    new
                } else {
                    old.clone()
                }
            };
            let turned = gradient.wanted().into_iter().zip(&best.direction).zip(&weights).map(turn).collect();
            let Some(turned) = self.normalised(turned).filter(|turned| *turned != best.direction) else { return };
            let Some((lo, hi)) = self.line(&turned).crossing(Some(&best.hi), FINE) else { return };
            self.best = Some(Crossing { direction: turned, lo, hi });
        }
    }

    /// The best crossing along one coordinate towards an end: halved by which way the crossing moves.
    fn along_coordinate(&self, start: Crossing, i: usize, end: Rational) -> Crossing {
        let mut best = start;
        let mut far = end;
        for k in 0..COORDINATE_BITS {
            let here = best.direction[i].clone();
            let middle = if k == 0 { far.clone() } else { here.midpoint(&far) };
            let mut direction = best.direction.clone();
            direction[i] = middle.clone();
            let Some(direction) = self.normalised(direction) else { break };
            let line = self.line(&direction);
            // Crossings are compared to more digits than they are found with elsewhere.
            let found = line.crossing(Some(&best.hi), 2 * u64::from(COORDINATE_BITS));
            let Some((lo, hi)) = found.filter(|(_, hi)| *hi < best.hi) else {
                far = middle;
                continue;
            };
            let goes_on = line.gradient(&lo, &hi).is_some_and(|g| {
                let sign = g.wanted()[i].sign();
                sign == (&far - &here).sign()
            });
            if goes_on {
                best = Crossing { direction, lo, hi };
                if k == 0 {
                    break;
                }
            } else {
                // The best is between: remember this one and look from there.
                far = here;
                best = Crossing { direction, lo, hi };
            }
        }
        best
    }

    /// Narrows the stretch of the best crossing.
    pub(super) fn refine(&mut self) {
        // What rounded numbers found is tested exactly.
        if let Some(Crossing { direction, lo, hi }) = self.best.take() {
            let line = self.line(&direction);
            let lo = if line.is_good(&lo) { lo } else { Rational::ZERO };
            let found = if line.is_good(&hi) { line.crossing(None, FINE) } else { line.narrowed(lo, hi, FINE) };
            self.best = found.map(|(lo, hi)| Crossing { direction, lo, hi });
        }
        self.settle();
        self.simplify();
    }

    /// Narrows the stretch of the best crossing to a share of its end.
    pub(super) fn sharpen(&mut self, share: &Rational) {
        let Some(best) = &self.best else { return };
        let (lo, hi) = self.line(&best.direction).sharpened(&best.lo, &best.hi, share);
        self.best = Some(Crossing { direction: best.direction.clone(), lo, hi });
    }

    /// Takes simple numbers where they serve as well: for coordinates inside, and for the factor itself.
    fn simplify(&mut self) {
        let Some(best) = self.best.clone() else { return };
        let near = Rational::dyadic(&Integer::ONE, u64::from(COORDINATE_BITS) - 5);
        let simple = |c: &Rational| {
            let is_inside = !c.is_zero() && c.abs() != Rational::ONE;
            let simplest = if is_inside { simplest_between(&(c - &near), &(c + &near)) } else { None };
            simplest.unwrap_or_else(|| c.clone())
        };
        let direction: Vec<Rational> = best.direction.iter().map(simple).collect();
        if direction != best.direction {
            let noise = &best.hi * &Rational::dyadic(&Integer::ONE, FINE - 2);
            let limit = &best.hi + &noise;
            if let Some((lo, hi)) = self.line(&direction).crossing(Some(&limit), FINE) {
                self.best = Some(Crossing { direction, lo, hi });
            }
        }
        let Some(best) = &mut self.best else { return };
        let line = Search::new(self.p, self.sides, self.reference).line(&best.direction);
        if let Some(t) = simplest_between(&best.lo, &best.hi)
            && !line.is_stable(&t)
        {
            best.hi = t;
        }
    }

    /// The derivative of what crosses by each parameter times its width, as shares that sum to 1.
    pub(super) fn shares(&self, crossing: &Crossing) -> Option<Vec<Rational>> {
        let line = self.line(&crossing.direction);
        let gradient = line.gradient(&crossing.lo, &crossing.hi)?;
        let weights: Vec<Rational> = self
            .weights(&gradient, &crossing.direction)
            .iter()
            .zip(&crossing.direction)
            .map(|(w, c)| w * &c.abs())
            .collect();
        let sum = weights.iter().fold(Rational::ZERO, |a, b| a + b);
        weights.iter().map(|w| Some(rounded_share(&w.checked_div(&sum)?))).collect()
    }
}

/// The line `base + factor step` in a direction.
pub fn ray(sides: &[Side], direction: &[Rational]) -> (Vec<Rational>, Vec<Rational>) {
    let parts = sides.iter().zip(direction).map(|(side, c)| {
        let offset = c * side.width(c.sign());
        if side.grows() { (side.nominal().clone(), offset) } else { (side.nominal() + &offset, Rational::ZERO) }
    });
    parts.unzip()
}

/// To some 60 binary digits.
fn rounded_share(share: &Rational) -> Rational {
    if share.is_zero() { Rational::ZERO } else { rounded(share, 60) }
}
