//! A delay at the cut of discrete loops, over boxes: dead time at the input of the only plant behind a hold, else whole samples.

use super::delay::delayed;
use super::delay_boxes::{DelayAsked, DelayFamily, DelayedLoops, Delays, shares_of};
use super::family::Quotient;
use super::ground::Ground;
use super::held_delay::{HeldDelay, is_stable_with};
use super::open_loop::OpenLoop;
use super::opened::OpenedLoop;
use super::parts::with_parts;
use super::requirement_boxes::OverPoints;
use crate::answer::SYMBOL_BITS;
use crate::coverage::refusals::{DELAY_OF_NUMBERS, MANY_SAMPLES, NO_SAMPLE_TIME};
use crate::error::Error;
use crate::model::{Cut, MoreDeadTime, Symbols};
use crate::problem::{Ask, Problem, fixed_symbols, parametric_symbols};
use crate::stability::Shape;
use crate::stability::boxes::{BoxPolynomial, Family, MovingPolynomial, same_count};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use std::sync::Arc;

/// Discrete loops with a delay at the cut, in samples.
pub(crate) struct SampledDelay {
    problem: Arc<Problem>,
    cut: Cut,
    /// Each with the delays that it is of: behind a hold they are one parameter more.
    families: Families,
    is_held: bool,
}

/// Loops with the delays of each, which follow each other.
type Families = Vec<(SampledFamily, [Rational; 2])>;

/// The loop with some delays.
enum SampledFamily {
    /// With constants, if there are any, each of which is a parameter more in this range.
    Polynomial(Box<BoxPolynomial>, Vec<[Rational; 2]>),
    /// With functions of parameters.
    Moving(Box<MovingPolynomial>),
}

impl SampledFamily {
    /// In names, the last of which may be the delay, and in symbols.
    fn of(
        p: &CharacteristicPolynomial,
        names: usize,
        symbols: &Symbols,
        budget: &Budget,
    ) -> Result<SampledFamily, Error> {
        let shape = Shape::UnitDisc;
        if symbols.is_moving() {
            let table = parametric_symbols(symbols)?;
            let family = budget.enter(|| MovingPolynomial::new(p, names, table, shape))?;
            return Ok(SampledFamily::Moving(Box::new(family)));
        }
        let table = fixed_symbols(symbols)?;
        let values = budget.enter(|| table.values(SYMBOL_BITS))?;
        let constants: Vec<[Rational; 2]> = values.iter().map(|ball| [ball.lower(), ball.upper()]).collect();
        let family = budget.enter(|| BoxPolynomial::over(p, names + constants.len(), shape))?;
        Ok(SampledFamily::Polynomial(Box::new(family), constants))
    }

    fn seems_stable_at(&self, mut point: Vec<Rational>) -> bool {
        match self {
            SampledFamily::Moving(family) => family.is_stable_at(&point),
            SampledFamily::Polynomial(family, constants) => {
                point.extend(constants.iter().map(|[low, high]| low.midpoint(high)));
                family.is_stable_at(&point)
            }
        }
    }
}

/// How a delay of a discrete loop is counted.
pub(super) enum Counted {
    /// In whole samples, up to this number.
    Whole(u64),
    /// As dead time at the input of the only plant behind a hold, up to so many samples.
    Held(Rational),
}

/// The open loop with its free names, and how its delay is counted.
pub(super) struct SampledLoop<'p> {
    pub opened: OpenedLoop<'p>,
    pub quotient: Quotient<MultiPoly>,
    pub undefined: MultiPoly,
    pub counted: Counted,
}

impl<'p> SampledLoop<'p> {
    /// Of a dead time that is to be borne.
    ///
    /// # Errors
    /// As [`OpenedLoop::of`] and [`OpenedLoop::quotient`]; `E-require` where the sample time, or the dead time behind the hold, is no number.
    pub fn of(asked: DelayAsked<'p>, budget: &Budget) -> Result<SampledLoop<'p>, Error> {
        let DelayAsked { problem, least, cut, near } = asked;
        let opened = OpenedLoop::of(problem, cut.clone(), budget)?;
        let (quotient, undefined) = opened.quotient(MultiPoly::clone, budget)?;
        let in_samples = |period: &Rational| least.checked_div(period).expect("a sample time is positive");
        let counted = match is_held(problem, (&opened, &quotient), near, budget)? {
            Some(period) => Counted::Held(in_samples(&period)),
            None => {
                let Some(time) = &opened.sample_time else { return Err(NO_SAMPLE_TIME.diagnostic(&[]).into()) };
                let Some(period) = time.as_constant() else { return Err(DELAY_OF_NUMBERS.diagnostic(&[]).into()) };
                let samples = in_samples(&period).ceil().to_i64();
                Counted::Whole(samples.map_or(u64::MAX, |samples| samples.max(0) as u64))
            }
        };
        let is_many = match &counted {
            Counted::Whole(samples) => *samples > MOST_SAMPLES,
            Counted::Held(samples) => *samples > Rational::from(HeldDelay::MOST as i64),
        };
        if is_many {
            let most = if let Counted::Whole(_) = counted { MOST_SAMPLES } else { HeldDelay::MOST };
            return Err(MANY_SAMPLES.diagnostic(&[("most", &most.to_string())]).into());
        }
        Ok(SampledLoop { opened, quotient, undefined, counted })
    }

    /// `z^m D0 + N`.
    pub fn with_samples(&self, names: &[String], samples: u64) -> CharacteristicPolynomial {
        let Quotient { denominator, numerator, .. } = &self.quotient;
        let zeros = std::iter::repeat_n(MultiPoly::zero(), samples as usize);
        let delayed = Poly::new(zeros.chain(denominator.coeffs().iter().cloned()).collect());
        let closed = delayed.plus(numerator);
        let symbols = self.opened.symbols.iter().map(|symbol| symbol.name.clone());
        CharacteristicPolynomial {
            variables: names.iter().cloned().chain(symbols).collect(),
            formal_degree: closed.coeffs().len() - 1,
            coefficients: closed.coeffs().iter().cloned().map(Into::into).collect(),
            poles: vec![self.undefined.clone()],
            monic: false,
        }
    }
}

/// More whole samples are not asked for boxes and intervals: each is a loop of its own.
const MOST_SAMPLES: u64 = 24;

/// The sample time of the only plant behind a hold, if the loop is cut at its input.
fn is_held(
    problem: &Problem,
    (opened, quotient): (&OpenedLoop<'_>, &Quotient<MultiPoly>),
    near: &[Rational],
    budget: &Budget,
) -> Result<Option<Rational>, Error> {
    let names: Vec<String> = problem.free().iter().map(|free| free.name.clone()).collect();
    let mut values = problem.set().to_vec();
    values.extend(names.iter().cloned().zip(near.iter().cloned()));
    let Some(hold) = problem.model().only_hold(&[], &values, budget)? else { return Ok(None) };
    let Ok(at_hold) = problem.model().cut(Some(&hold.block)) else { return Ok(None) };
    let at_hold = OpenedLoop::of(problem, at_hold, budget)?;
    let Ok((other, _)) = at_hold.quotient(MultiPoly::clone, budget) else { return Ok(None) };
    let is_same = || {
        quotient.numerator.times(&other.denominator) == other.numerator.times(&quotient.denominator)
            && opened.symbols == at_hold.symbols
    };
    if !budget.enter(is_same)? {
        return Ok(None);
    }
    match problem.model().only_hold(&names, problem.set(), budget)? {
        Some(hold) => Ok(Some(hold.period)),
        None => Err(DELAY_OF_NUMBERS.diagnostic(&[]).into()),
    }
}

impl SampledDelay {
    /// `None` where no loop bears the time: a sample falls on an edge of the pulse before.
    ///
    /// # Errors
    /// As [`SampledLoop::of`].
    pub fn of(asked: DelayAsked<'_>, budget: &Budget) -> Result<Option<SampledDelay>, Error> {
        let DelayAsked { problem, cut, near, .. } = asked;
        let sampled = SampledLoop::of(asked, budget)?;
        let names: Vec<String> = problem.free().iter().map(|free| free.name.clone()).collect();
        let families = match &sampled.counted {
            Counted::Whole(samples) => {
                let mut families = Vec::new();
                for m in 1..=*samples {
                    let p = sampled.with_samples(&names, m);
                    let family = SampledFamily::of(&p, names.len(), &sampled.opened.symbols, budget)?;
                    families.push((family, [m, m].map(whole)));
                }
                families
            }
            Counted::Held(samples) => match stretches(problem, &names, near, samples, budget)? {
                Some(families) => families,
                None => return Ok(None),
            },
        };
        let is_held = matches!(sampled.counted, Counted::Held(_));
        Ok(Some(SampledDelay { problem: Arc::clone(problem), cut: cut.clone(), families, is_held }))
    }

    /// The families with the delays that are one parameter more.
    pub fn families(&self) -> Vec<DelayFamily<'_>> {
        let mut out = Vec::with_capacity(self.families.len());
        for (family, delays) in &self.families {
            let delays = self.is_held.then(|| delays.clone());
            let (loops, constants): (_, &[[Rational; 2]]) = match family {
                SampledFamily::Moving(p) => (DelayedLoops::Moving(p), &[]),
                SampledFamily::Polynomial(p, constants) => (DelayedLoops::Polynomial(p), constants),
            };
            out.push(DelayFamily { loops, delays, constants });
        }
        out
    }

    /// Whether a point is stable with a delay.
    fn is_stable(&self, point: &[Rational], delay: &Rational, budget: &Budget) -> Result<Option<bool>, Error> {
        let names = self.problem.free().iter().map(|free| free.name.clone());
        let question = self.problem.model().ask().set_all(self.problem.set().to_vec());
        let problem = question.set_all(names.zip(point.iter().cloned())).problem()?;
        if self.is_held {
            return is_stable_with(&problem, delay, budget);
        }
        let open_loop = OpenLoop::of_cut(&problem, self.cut.clone(), budget)?;
        let samples = delay.numerator().to_i64().expect("few samples") as u64;
        let is_stable = with_parts!(open_loop, parts => {
            parts.ground.is_stable(&delayed(parts, samples).with_conjugate(), parts.shape, budget)
        });
        Ok(Some(is_stable?))
    }

    /// The same; `None` where that is not told.
    fn told(&self, point: &[Rational], delay: &Rational, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        match self.is_stable(point, delay, budget) {
            Ok(told) => Ok(told),
            Err(Error::Stopped(stopped)) if !stopped.stop.is_precision() => Err(stopped),
            Err(_) => Ok(None),
        }
    }
}

impl Delays for SampledDelay {
    fn tried(&self) -> Vec<Rational> {
        let greatest = &self.families.last().expect("a delay margin is above 0").1[1];
        let ends = self.families.iter().map(|(_, [_, delay])| delay.clone());
        // Where another loop begins the delay may be borne least.
        let mut all: Vec<Rational> =
            if self.is_held { ends.chain(shares_of(greatest)).collect() } else { ends.collect() };
        all.sort_by(|a, b| b.cmp(a));
        all.dedup();
        all
    }

    fn ranges(&self) -> Vec<[Rational; 2]> {
        self.families.iter().map(|(_, delays)| delays.clone()).collect()
    }

    fn is_delay(&self, delay: &Rational) -> bool {
        self.is_held || delay.is_integer()
    }

    fn at(&self, point: &[Rational], delay: &Rational, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        let (family, _) = self.family_of(delay);
        let own = self.is_held.then_some(delay);
        let all: Vec<Rational> = point.iter().chain(own).cloned().collect();
        if budget.enter(|| family.seems_stable_at(all))? {
            return Ok(Some(true));
        }
        self.told(point, delay, budget)
    }

    fn over(
        &self,
        sides: &[[Rational; 2]],
        delays: &[Rational; 2],
        cells: usize,
        budget: &Budget,
    ) -> Result<OverPoints, Exhausted> {
        let (family, _) = self.family_of(&delays[0].midpoint(&delays[1]));
        let own = self.is_held.then_some(delays);
        let mut all: Vec<[Rational; 2]> = sides.iter().chain(own).cloned().collect();
        let middle = delays[0].midpoint(&delays[1]);
        let told = |point: &[Rational]| self.told(&point[..sides.len()], &middle, budget);
        Ok(OverPoints::of(match family {
            SampledFamily::Moving(family) => same_count(family.as_ref(), &all, (cells, budget), told)?,
            SampledFamily::Polynomial(family, constants) => {
                all.extend(constants.iter().cloned());
                same_count(family.as_ref(), &all, (cells, budget), told)?
            }
        }))
    }
}

impl SampledDelay {
    /// The family of a delay.
    fn family_of(&self, delay: &Rational) -> &(SampledFamily, [Rational; 2]) {
        let own = self.families.iter().find(|(_, [_, high])| delay <= high);
        own.or(self.families.last()).expect("a delay margin is above 0")
    }
}

fn whole(samples: u64) -> Rational {
    Rational::from(i64::try_from(samples).expect("few samples"))
}

/// The loops with up to so many samples of dead time more at the only hold, from one sample that begins another loop to the next.
fn stretches(
    problem: &Problem,
    names: &[String],
    near: &[Rational],
    samples: &Rational,
    budget: &Budget,
) -> Result<Option<Families>, Error> {
    let hold = problem.model().only_hold(names, problem.set(), budget)?.expect("it was asked");
    let mut values = problem.set().to_vec();
    values.extend(names.iter().cloned().zip(near.iter().cloned()));
    let (mut families, mut from) = (Vec::new(), Rational::ZERO);
    while from < *samples {
        let Some(to) = hold.next_break(&from) else { return Err(DELAY_OF_NUMBERS.diagnostic(&[]).into()) };
        let to = to.min(samples.clone());
        let around = near.iter().cloned().chain([from.midpoint(&to)]).collect();
        let (closed, symbols) =
            problem.model().with_dead_time(&MoreDeadTime::Near(around), names, problem.set(), budget)?;
        let (mut p, _) = closed.real_polynomial(&symbols, budget)?;
        // Where the model is defined at all is asked elsewhere.
        p.poles = Vec::new();
        families.push((SampledFamily::of(&p, names.len() + 1, &symbols, budget)?, [from, to.clone()]));
        if to < *samples {
            let more = MoreDeadTime::Samples(to.clone());
            match problem.model().with_dead_time(&more, &[], &values, budget) {
                Err(Error::Undefined(_)) => return Ok(None),
                known => drop(known?),
            }
        }
        from = to;
    }
    Ok(Some(families))
}
