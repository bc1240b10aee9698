//! One zero of a function of a parameter and symbols that depend on it, refined to any width.

use super::moving::FIRST_BITS;
use super::{Function, MovingSymbols};
use crate::ball::{Ball, Series};
use crate::limits::checkpoint;
use crate::number::{Enclosure, Integer, Rational};
use crate::real::{Enclosing, Origin};
use std::sync::Arc;

/// The only zero of a function in an interval on which it is monotone.
#[derive(Debug)]
pub(super) struct MovingRoot {
    pub symbols: Arc<MovingSymbols>,
    pub function: Arc<Function>,
    pub place: Enclosure,
}

impl Enclosing for MovingRoot {
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure {
        let known = known.unwrap_or(&self.place);
        let (mut lo, mut hi) = (known.lower().clone(), known.upper().clone());
        let target = Rational::dyadic(&Integer::ONE, bits);
        let half = Rational::dyadic(&Integer::ONE, 1);
        let mut working = bits + 96;
        let rising = self.rises();
        while &hi - &lo > target {
            checkpoint(bits);
            let width = &hi - &lo;
            // A dyadic number in the middle, so that it is exact.
            let middle = Ball::from_rational(&lo.midpoint(&hi), working).lower();
            let point = Ball::from_rational(&middle, working);
            let whole = Ball::between(&lo, &hi, working);
            let at_middle = self.symbols.value(&self.function, &point);
            let one = Ball::from_integer(&Integer::ONE, working);
            let slope = self.symbols.series(&Series::linear(&whole, &one, 2));
            let slope = slope.map(|values| self.function.at_series(&values).coefficients()[1].clone());
            if let (Some(at_middle), Some(slope)) = (&at_middle, slope)
                && let Some(newton) = at_middle.div(&slope).and_then(|step| point.sub(&step).intersection(&whole))
                && (newton.upper() - newton.lower()) <= &width * &half
            {
                (lo, hi) = (newton.lower().max(lo), newton.upper().min(hi));
                continue;
            }
            match at_middle.and_then(|v| v.sign()).filter(|s| s.is_ne()) {
                Some(sign) if middle > lo && middle < hi => {
                    if sign.is_gt() == rising {
                        hi = middle;
                    } else {
                        lo = middle;
                    }
                }
                _ => working *= 2,
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
    /// Whether the function is negative below the zero.
    fn rises(&self) -> bool {
        let mut working = FIRST_BITS;
        loop {
            let below = self.symbols.sign_at(&self.function, self.place.lower(), working);
            let above = self.symbols.sign_at(&self.function, self.place.upper(), working);
            if let (Some(a), Some(b)) = (below, above)
                && a != b
            {
                return b.is_gt();
            }
            working *= 2;
        }
    }
}
