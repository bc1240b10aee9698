//! One zero of a function of a parameter and symbols that depend on it, refined to any width.

use super::horner::Scheme;
use super::moving::FIRST_BITS;
use super::{Function, MovingSymbols};
use crate::ball::{Ball, Series};
use crate::limits::{checkpoint, until_shown};
use crate::number::{Enclosure, Integer, Rational};
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
        let (mut lo, mut hi) = (known.lower().clone(), known.upper().clone());
        let target = Rational::dyadic(&Integer::ONE, bits);
        let mut curvature = Rational::from(FIRST_CURVATURE).checked_div(&self.monotone).unwrap_or(Rational::ONE);
        let mut working = bits + 96;
        while &hi - &lo > target {
            checkpoint(bits);
            let rising = *self.rising.get_or_init(|| self.rises());
            // Dyadic numbers, so that they are exact.
            let dyadic = |x: &Rational| Ball::from_rational(x, working).lower();
            let middle = dyadic(&lo.midpoint(&hi));
            let point = Ball::from_rational(&middle, working);
            let one = Ball::from_integer(&Integer::ONE, working);
            let at_middle = self.symbols.series(&Series::linear(&point, &one, 2)).map(|values| self.scheme.at(&values));
            let at_middle = at_middle.as_ref().map(Series::coefficients);
            let sign = at_middle.and_then(|c| c[0].sign()).filter(|s| s.is_ne());
            let (Some([value, slope]), Some(sign), true) = (at_middle, sign, lo < middle && middle < hi) else {
                // The middle is the zero, or nearly.
                let nearer = at_middle.and_then(|c| self.around_zero(&point, &c[0], &Ball::between(&lo, &hi, working)));
                match nearer.filter(|n| n.upper() - n.lower() <= (&hi - &lo) * Rational::dyadic(&Integer::ONE, 1)) {
                    Some(nearer) => (lo, hi) = (nearer.lower().max(lo), nearer.upper().min(hi)),
                    None => {
                        // Over a wide interval nothing is known of the derivative; points beside the zero have signs all the same.
                        let beside =
                            [3, 5].map(|n| dyadic(&(&lo + &(&(&hi - &lo) * &Rational::dyadic(&Integer::from(n), 3)))));
                        let signs = beside.clone().map(|x| self.symbols.sign_at(&self.scheme, &x, working));
                        for (x, sign) in beside.into_iter().zip(signs) {
                            match sign {
                                Some(sign) if sign.is_gt() == rising => hi = x.min(hi),
                                Some(_) => lo = x.max(lo),
                                None => {}
                            }
                        }
                        if signs.iter().all(Option::is_none) {
                            working *= 2;
                        }
                    }
                }
                continue;
            };
            if sign.is_gt() == rising {
                hi = middle.clone();
            } else {
                lo = middle.clone();
            }
            let Some(step) = value.div(slope) else { continue };
            let guess = &middle - &step.lower().midpoint(&step.upper());
            let square = (&guess - &middle).pow(2).expect("a square");
            let around = &(&square * &curvature)
                + &(&(step.upper() - step.lower()) + &(&target * &Rational::dyadic(&Integer::ONE, 2)));
            let (below, above) = (dyadic(&(&guess - &around)), dyadic(&(&guess + &around)));
            let is_above = |x: &Rational| self.symbols.sign_at(&self.scheme, x, working).map(|s| s.is_gt() == rising);
            let mut is_in = true;
            for x in [below, above] {
                if !(lo < x && x < hi) {
                    continue;
                }
                match is_above(&x) {
                    Some(true) => {
                        is_in &= x > guess;
                        hi = x;
                    }
                    Some(false) => {
                        is_in &= x <= guess;
                        lo = x;
                    }
                    None => is_in = false,
                }
            }
            if !is_in {
                curvature *= Rational::from(16);
            }
        }
        Enclosure::new(lo, hi)
    }

    fn origin(&self) -> Origin {
        let names: Vec<String> =
            std::iter::once("p".to_owned()).chain(self.symbols.table().iter().map(|(n, _)| n.clone())).collect();
        Origin::Function { function: self.function.display(&names), details: Vec::new() }
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
