//! One zero of a function of a parameter and symbols that depend on it, refined to any width.

use super::horner::Scheme;
use super::moving::FIRST_BITS;
use super::{Function, MovingSymbols};
use crate::ball::{Ball, Series};
use crate::limits::{checkpoint, until_shown};
use crate::number::{Enclosure, Integer, Rational, Sign};
use crate::real::{Enclosing, Origin};
use std::sync::{Arc, OnceLock};

/// The only zero of a function in an interval on which it is monotone.
#[derive(Debug)]
pub(super) struct MovingRoot {
    pub symbols: Arc<MovingSymbols>,
    pub function: Arc<Function>,
    pub scheme: Arc<Scheme>,
    pub place: Enclosure,
    /// The width of an interval around the place on which the function is monotone.
    pub monotone: Rational,
    /// Whether the function is negative below the zero, once it was asked.
    pub rising: OnceLock<bool>,
}

/// Newton's step errs by about so many times its square over the interval on which the function is monotone, at first.
const FIRST_CURVATURE: i64 = 4;

impl Enclosing for MovingRoot {
    /// Newton's method at points: a step ends in a short interval, and two signs tell whether the zero is in it.
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure {
        let known = known.unwrap_or(&self.place);
        let target = Rational::dyadic(&Integer::ONE, bits);
        let mut curvature = Rational::from(FIRST_CURVATURE).checked_div(&self.monotone).unwrap_or(Rational::ONE);
        let (lo, hi) = (known.lower().clone(), known.upper().clone());
        let mut place = Narrowed { root: self, lo, hi, working: bits + 96 };
        while &place.hi - &place.lo > target {
            checkpoint(bits);
            let middle = place.dyadic(&place.lo.midpoint(&place.hi));
            let point = Ball::from_rational(&middle, place.working);
            let one = Ball::from_integer(&Integer::ONE, place.working);
            let at_middle = self.symbols.series(&Series::linear(&point, &one, 2)).map(|values| self.scheme.at(&values));
            let at_middle = at_middle.as_ref().map(Series::coefficients);
            let sign = at_middle.and_then(|c| c[0].sign()).filter(|s| s.is_ne());
            let (Some([value, slope]), Some(sign), true) = (at_middle, sign, place.holds(&middle)) else {
                // The middle is the zero, or nearly.
                place.without_sign(&point, at_middle);
                continue;
            };
            place.cut(middle.clone(), sign);
            let Some(step) = value.div(slope) else { continue };
            let guess = &middle - &step.lower().midpoint(&step.upper());
            let square = (&guess - &middle).pow(2).expect("a square");
            let around = &(&square * &curvature)
                + &(&(step.upper() - step.lower()) + &(&target * &Rational::dyadic(&Integer::ONE, 2)));
            if !place.narrow_to(&guess, &around) {
                curvature *= Rational::from(16);
            }
        }
        Enclosure::new(place.lo, place.hi)
    }

    fn origin(&self) -> Origin {
        let names: Vec<String> =
            std::iter::once("p".to_owned()).chain(self.symbols.table().iter().map(|(n, _)| n.clone())).collect();
        Origin::Function { function: self.function.display(&names), details: Vec::new() }
    }
}

/// The place of a zero while it is narrowed, with bits to work with.
struct Narrowed<'r> {
    root: &'r MovingRoot,
    lo: Rational,
    hi: Rational,
    working: u64,
}

impl Narrowed<'_> {
    /// A dyadic number close by: such numbers are exact.
    fn dyadic(&self, x: &Rational) -> Rational {
        Ball::from_rational(x, self.working).lower()
    }

    fn holds(&self, x: &Rational) -> bool {
        self.lo < *x && *x < self.hi
    }

    fn sign(&self, x: &Rational) -> Option<Sign> {
        self.root.symbols.sign_at(&self.root.scheme, x, self.working)
    }

    /// Whether a point where the function has this sign is above the zero.
    fn is_above(&self, sign: Sign) -> bool {
        sign.is_gt() == *self.root.rising.get_or_init(|| self.root.rises())
    }

    /// Ends at a point at which the function has this sign.
    fn cut(&mut self, x: Rational, sign: Sign) {
        if self.is_above(sign) {
            self.hi = x;
        } else {
            self.lo = x;
        }
    }

    /// Goes on where the function has no certain sign in the middle.
    fn without_sign(&mut self, point: &Ball, at_middle: Option<&[Ball]>) {
        let whole = Ball::between(&self.lo, &self.hi, self.working);
        let nearer = at_middle.and_then(|c| self.root.around_zero(point, &c[0], &whole));
        let half = (&self.hi - &self.lo) * Rational::dyadic(&Integer::ONE, 1);
        if let Some(nearer) = nearer.filter(|n| n.upper() - n.lower() <= half) {
            self.lo = nearer.lower().max(self.lo.clone());
            self.hi = nearer.upper().min(self.hi.clone());
            return;
        }
        // Over a wide interval nothing is known of the derivative; points beside the zero have signs all the same.
        let width = &self.hi - &self.lo;
        let beside = [3, 5].map(|n| self.dyadic(&(&self.lo + &(&width * &Rational::dyadic(&Integer::from(n), 3)))));
        let signs = beside.each_ref().map(|x| self.sign(x));
        for (x, sign) in beside.into_iter().zip(signs) {
            match sign {
                Some(sign) if self.is_above(sign) => self.hi = x.min(self.hi.clone()),
                Some(_) => self.lo = x.max(self.lo.clone()),
                None => {}
            }
        }
        if signs.iter().all(Option::is_none) {
            self.working *= 2;
        }
    }

    /// Ends at points on both sides of a guess; `false` where the zero is not between them.
    fn narrow_to(&mut self, guess: &Rational, around: &Rational) -> bool {
        let ends = [self.dyadic(&(guess - around)), self.dyadic(&(guess + around))];
        let mut is_in = true;
        for x in ends {
            if !self.holds(&x) {
                continue;
            }
            let Some(sign) = self.sign(&x) else {
                is_in = false;
                continue;
            };
            is_in &= self.is_above(sign) == (x > *guess);
            self.cut(x, sign);
        }
        is_in
    }
}

impl MovingRoot {
    /// Where the zero is by the interval form of Newton's step from a point with this value; `None` where the derivative may vanish between.
    fn around_zero(&self, point: &Ball, value: &Ball, whole: &Ball) -> Option<Ball> {
        let one = Ball::from_integer(&Integer::ONE, whole.bits());
        let values = self.symbols.series(&Series::linear(whole, &one, 2))?;
        let step = value.div(&self.scheme.at(&values).coefficients()[1])?;
        point.sub(&step).intersection(whole)
    }

    /// Whether the function is negative below the zero, which is one end of its place at most.
    fn rises(&self) -> bool {
        until_shown(FIRST_BITS, |working| {
            let sign = |x: &Rational| self.symbols.sign_at(&self.scheme, x, working);
            let below = sign(self.place.lower()).map(|sign| sign.is_lt());
            below.or_else(|| Some(sign(self.place.upper())?.is_gt()))
        })
    }
}
