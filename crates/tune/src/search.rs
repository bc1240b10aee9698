//! The best value of a scale by halving, where its boundary is not algebraic.

use crate::lines::Lines;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::simplest_between;
use jurist_engine::error::Error;

/// A search for the best value of a scale by halving.
pub(crate) struct Search {
    pub ends: [Rational; 2],
    pub is_rising: bool,
    pub is_without_end: bool,
}

/// Between what is met and what is not.
pub(crate) struct Bracketed<T> {
    /// A value that is met, and with what.
    pub met: Option<(Rational, T)>,
    /// A value that is not met; `None` where there is none.
    pub not: Option<Rational>,
    /// What ended the search before the gap was reached.
    pub stopped: Option<Exhausted>,
}

/// So often the first value is halved or doubled.
const DOUBLINGS: usize = 48;

/// Shares of the room by which a value is moved.
const BESIDE: [(i64, i64); 2] = [(-3, 16), (5, 16)];

impl Search {
    /// A value at a distance from the worst end.
    fn at(&self, distance: &Rational) -> Rational {
        if self.is_rising { &self.ends[0] + distance } else { &self.ends[1] - distance }
    }

    fn distance(&self, value: &Rational) -> Rational {
        if self.is_rising { value - &self.ends[0] } else { &self.ends[1] - value }
    }

    /// A distance that is less than the whole one.
    fn within(&self, distance: Rational, whole: &Rational) -> Rational {
        let half = Rational::new(1.into(), 2.into());
        let most = if self.is_without_end { whole.clone() } else { whole - tiny() * half };
        distance.min(most)
    }

    /// How far a distance may be moved and stay between others.
    fn room(&self, next: &Rational, low: Option<&Rational>, high: &Rational) -> Rational {
        let below = next - low.unwrap_or(&Rational::ZERO);
        below.min((high - next).abs())
    }

    /// Asks about a distance, or about one beside it where the method does not tell: the best value itself is often a short number, at which roots meet.
    fn ask_about<T>(
        &self,
        lines: &Lines<'_>,
        next: Rational,
        room: &Rational,
        met: &dyn Fn(&Rational) -> Result<Option<T>, Error>,
    ) -> (Rational, Result<Option<T>, Error>) {
        let first = lines.part(|| met(&self.at(&next)));
        let is_by_method = |answer: &Result<Option<T>, Error>| matches!(answer, Err(Error::Stopped(stopped)) if !stopped.stop.is_budget());
        if is_by_method(&first) {
            for (a, b) in BESIDE {
                let beside = &next + &(room * &Rational::new(a.into(), b.into()));
                let answer = lines.part(|| met(&self.at(&beside)));
                if !is_by_method(&answer) {
                    return (beside, answer);
                }
            }
        }
        (next, first)
    }

    /// Halves until the gap of the question is reached, or the work ends.
    ///
    /// # Errors
    /// Those of the question that are no end of the work.
    pub fn bracket<T>(
        &self,
        lines: &Lines<'_>,
        seed: Option<(Rational, T)>,
        met: &dyn Fn(&Rational) -> Result<Option<T>, Error>,
    ) -> Result<Bracketed<T>, Error> {
        let half = Rational::new(1.into(), 2.into());
        let whole = &self.ends[1] - &self.ends[0];
        // Distances from the worst end.
        let mut low = seed.as_ref().map(|(value, _)| self.distance(value));
        let mut high: Option<Rational> = None;
        // Beyond a good value by less than the gap at first, then by four times as much.
        let mut step = low.as_ref().map(|low| low * &lines.asked.gap * &half);
        let mut out = Bracketed { met: seed, not: None, stopped: None };
        let mut next = match (&low, &step) {
            (Some(low), Some(step)) => self.within(low + step, &whole),
            _ if self.is_without_end => Rational::ONE,
            _ => &whole * &half,
        };
        for _ in 0..2 * DOUBLINGS {
            lines.budget.step("a bracket of the best value");
            let room = self.room(&next, low.as_ref(), high.as_ref().unwrap_or(&whole));
            let (asked, answer) = self.ask_about(lines, next, &room, met);
            next = asked;
            match answer {
                Ok(Some(found)) => {
                    out.met = Some((self.at(&next), found));
                    low = Some(next.clone());
                }
                Ok(None) => {
                    out.not = Some(self.at(&next));
                    high = Some(next.clone());
                }
                // What was seen is known all the same.
                Err(Error::Stopped(stopped)) => return Ok(Bracketed { stopped: Some(stopped), ..out }),
                Err(error) => return Err(error),
            }
            let between = (low.as_ref(), high.as_ref());
            match self.following(between, &mut step, &lines.asked.gap) {
                Some(following) => next = following,
                None => return Ok(out),
            }
        }
        Ok(out)
    }

    /// The distance to ask about after these were seen: the greatest good one and the least other one; `None` where they are close enough.
    fn following(
        &self,
        between: (Option<&Rational>, Option<&Rational>),
        step: &mut Option<Rational>,
        gap: &Rational,
    ) -> Option<Rational> {
        let half = Rational::new(1.into(), 2.into());
        let whole = &self.ends[1] - &self.ends[0];
        match between {
            (None, Some(high)) => (*high >= tiny()).then(|| high * &half),
            (Some(low), None) if step.is_some() && &whole - low > tiny() => {
                let longer = step.as_ref().expect("it was just seen") * &Rational::from(4);
                let next = self.within(low + &longer, &whole);
                *step = Some(longer);
                Some(next)
            }
            (Some(low), None) if self.is_without_end => (*low < &whole * &half).then(|| low + low),
            (Some(low), None) => (&whole - low >= tiny()).then(|| (low + &whole) * &half),
            (Some(low), Some(high)) => {
                let width = high - low;
                let third = &width * &Rational::new(1.into(), 3.into());
                let middle = || simplest_between(&(low + &third), &(high - &third)).expect("a third is left");
                (width > high * gap).then(middle)
            }
            (None, None) => unreachable!("one of them was just found"),
        }
    }
}

/// Distances below this are not looked for.
fn tiny() -> Rational {
    Rational::new(1.into(), Integer::ONE << 40_u64)
}
