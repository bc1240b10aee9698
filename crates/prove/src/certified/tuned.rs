//! Certificates of best gains, and that there are none.

use crate::Certificate;
use crate::tune_certificate;
use jurist_engine::problem::Ask;
mod cells;
mod guess;

use self::cells::{Cells, Written};
use super::for_all::{certify_requirements, precision};
use crate::{BestOf, FoundClaim, TuneClaim};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{MultiPoly, simplest_between};
use jurist_check::{Limits, TuneJudge};
use jurist_engine::response::{AllOf, Level, LevelAsked, Requirement};
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_tune::answer::{Best, Optimum, Outcome, TuneAnswer};
use jurist_tune::asked::Objective;
use std::time::Duration;

/// No gains have a value that is better than the best one by such shares, from the least to the greatest: in a box around gains that have the best one nothing is
/// proved.
const BEYOND: [u64; 3] = [20, 14, 10];

/// The same behind the end of a bracket.
const BEYOND_KNOWN: [u64; 2] = [10, 7];

/// What is found has a level that is worse by such shares.
const BELOW: [u64; 4] = [20, 14, 10, 7];

/// Shares of the way from the gains that are found to those that are typed in.
const TOWARDS_TYPED: [u64; 4] = [10, 7, 4, 0];

/// A certificate of best gains: that no gains of the box meet what is required, or none that are better than a value, and that the gains that are found do.
/// Where nothing is to be best, it is that of these gains alone.
///
/// The value is a little better than the best one, by `2^-20` of it at best: at gains next to it no box is proved.
///
/// Cost: that of the boxes of gains, some hundred to some ten thousand, the more the more gains there are.
///
/// ```
/// use jurist_prove::certified::certify_tune;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// use jurist_engine::response::Requirements;
/// use jurist_tune::{answer::TuneAnswer, asked::{Asked, Gain}};
/// let text = "time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's^3 + 3*s^2 + 2*s + K'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let gain = Gain::new("K").within([Some(0.into()), Some(100.into())]);
/// let asked = Asked::of(&model, vec![gain], "max K", Requirements::default())?;
/// let answer = TuneAnswer::of(&model.ask(), asked, &Budget::unlimited())?;
/// let certificate = certify_tune(&answer, &Budget::unlimited())?;
/// let proved = check(text, &certificate, &Limits::default()).unwrap();
/// assert!(proved.statement.starts_with("For no K from 0 to 100 with K >= 6.00000"), "{}", proved.statement);
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) where a gain has no bounds, where the checkers do not read the model or what is asked, or do not see what is said;
/// [`Error::Stopped`] when the budget runs out.
pub fn certify_tune(answer: &TuneAnswer, budget: &Budget) -> Result<String, Error> {
    budget.step("certificate");
    if !answer.asked.for_all.is_empty() {
        let help = "'--set' gives those names values, and then there is one";
        return Err(refused("there are none of gains that are good for all values of other names", help));
    }
    match &answer.outcome {
        Outcome::Infeasible { conflict, .. } => {
            let all = claim(answer)?;
            let mut few = all.clone();
            few.requirements = excluding(&all.requirements, conflict);
            match written(answer, &few, budget)? {
                None if few.requirements.len() < all.requirements.len() => {
                    written(answer, &all, budget)?.ok_or_else(close)
                }
                found => found.ok_or_else(close),
            }
        }
        Outcome::Optimum(optimum) if answer.asked.objective == Objective::Anything => of_point(answer, optimum, budget),
        Outcome::Optimum(optimum) => of_optimum(answer, &claim(answer)?, optimum, budget),
        Outcome::Open { stopped, .. } => Err(stopped.clone().into()),
    }
}

/// The requirements that exclude each other, where they are known by their names.
fn excluding(all: &[Requirement], conflict: &[String]) -> Vec<Requirement> {
    all.iter().filter(|requirement| conflict.contains(&requirement.text())).cloned().collect()
}

fn close() -> Error {
    let message = "no certificate: the checkers do not see it, gains come too close to what is asked for";
    Diagnostic::error(Code::NoCertificate, message).help("the answer is printed without '--certificate'").into()
}

fn refused(message: impl Into<String>, help: &str) -> Error {
    Diagnostic::error(Code::NoCertificate, format!("no certificate: {}", message.into())).help(help).into()
}

/// The box and what is required.
fn claim(answer: &TuneAnswer) -> Result<TuneClaim, Error> {
    let mut gains = Vec::new();
    for free in answer.problem.free() {
        let ends = free.domain.lower.clone().zip(free.domain.upper.clone());
        let Some(gain) = ends.and_then(|(low, high)| AllOf::new(&free.name, low, high)) else {
            let message = format!("'{}' has no bounds at both ends, and a certificate is of a box of gains", free.name);
            return Err(refused(message, &format!("give it bounds: --bound {}=LO..HI", free.name)));
        };
        gains.push(gain);
    }
    let mut claim = TuneClaim::new(gains);
    claim.requirements.clone_from(&answer.asked.requirements.list);
    claim.at.clone_from(&answer.asked.requirements.at);
    Ok(claim)
}

/// That the gains that are found are good, where nothing is to be best.
fn of_point(answer: &TuneAnswer, optimum: &Optimum, budget: &Budget) -> Result<String, Error> {
    let (problem, required) = (&answer.problem, &answer.asked.requirements);
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().within(problem.region().clone()).set_all(problem.set().to_vec());
    let point = question.set_all(names.zip(optimum.found.iter().cloned())).problem()?;
    match required.list.as_slice() {
        [] => point.verdict(budget)?.certificate(budget),
        list => certify_requirements(&point, list, required.at.as_deref(), true, budget),
    }
}

/// The value of the optimum, and what it is of.
fn of_optimum(answer: &TuneAnswer, claim: &TuneClaim, optimum: &Optimum, budget: &Budget) -> Result<String, Error> {
    let nothing = || {
        let message = match (&answer.asked.objective, &optimum.value) {
            (Objective::Tolerance(_), _) => "there are none of a tolerance yet",
            (_, Best::Zero | Best::Exact(_)) => {
                "nothing is better than a best value of 0, so there is nothing to prove"
            }
            _ => "there is no best value that is a number",
        };
        refused(message, "the answer is printed without '--certificate'")
    };
    // The best value from the side that is worse, and a value that none have, if it is known.
    let (value, known) = match &optimum.value {
        Best::Exact(value) if answer.asked.level() == Some(Level::Radius) && value.sign().is_eq() => {
            return Err(nothing());
        }
        Best::Exact(value) => {
            let (low, high) = value.refined_to_digits(20).enclosure();
            (low.midpoint(&high), None)
        }
        Best::Between([found, proved]) => (found.clone(), Some(proved.clone())),
        Best::Unbounded | Best::Zero | Best::Nothing => return Err(nothing()),
    };
    let target = Target::of(answer, claim).ok_or_else(nothing)?;
    let from = known.as_ref().unwrap_or(&value);
    let shares = if known.is_some() { &BEYOND_KNOWN[..] } else { &BEYOND[..] };
    let further = shares.iter().map(|bits| target.beyond(from, *bits));
    for proved in known.iter().cloned().chain(further) {
        let Some(best) = target.best(&proved)? else { continue };
        let mut claim = claim.clone();
        claim.best = Some(best);
        claim.found = found(answer, &claim, &target, optimum, budget)?;
        if claim.found.is_none() {
            continue;
        }
        if let Some(text) = written(answer, &claim, budget)? {
            return Ok(text);
        }
    }
    Err(close())
}

/// The gains that are found, where the checkers see that they are good; their level may be a little worse than it is.
fn found(
    answer: &TuneAnswer,
    claim: &TuneClaim,
    target: &Target<'_>,
    optimum: &Optimum,
    budget: &Budget,
) -> Result<Option<FoundClaim>, Error> {
    for found in candidates(target, optimum)? {
        let mut claim = claim.clone();
        claim.found = Some(found.clone());
        let judge = judge(answer, &claim, budget)?.0;
        if let Some(proof) = Cells::new(&judge, budget).proof_of_found() {
            return Ok(Some(FoundClaim { proof, ..found }));
        }
        budget.check()?;
    }
    Ok(None)
}

/// Gains and their levels: those that are found, with worse and worse levels; or, where there is no level, those on the way to the gains that are typed in, which
/// meet requirements by more.
fn candidates(target: &Target<'_>, optimum: &Optimum) -> Result<Vec<FoundClaim>, Error> {
    let point = &optimum.found;
    let of = |point: Vec<Rational>, level| FoundClaim { point, level, proof: String::new() };
    if let Target::Level { .. } = target {
        let Some(value) = &optimum.found_value else { return Ok(Vec::new()) };
        let levels = BELOW.iter().filter_map(|bits| target.found(value, *bits).transpose());
        return levels.map(|level| Ok(of(point.clone(), Some(level?)))).collect();
    }
    let typed = optimum.typed.iter().flat_map(|typed| {
        let way = move |bits: u64| {
            let share = Rational::dyadic(&1.into(), bits);
            point.iter().zip(&typed.values).map(|(a, b)| a + &(&(b - a) * &share)).collect()
        };
        TOWARDS_TYPED.map(way)
    });
    Ok(std::iter::once(point.clone()).chain(typed).map(|point| of(point, None)).collect())
}

/// What a check sees, with the degree and the bits of its models.
fn judge(answer: &TuneAnswer, claim: &TuneClaim, budget: &Budget) -> Result<(TuneJudge, (usize, usize)), Error> {
    let problem = &answer.problem;
    let mut asked = claim.requirements.clone();
    if let Some(BestOf::Level(LevelAsked::Requirement(level))) = &claim.best {
        asked.push(level.clone());
    }
    let own = if asked.is_empty() { 0 } else { 2 };
    let precision = precision(problem, &asked, claim.gains.len() + own, budget)?;
    let draft = tune_certificate(problem, claim, "", precision, budget)?;
    let judge = TuneJudge::new(&problem.model().source().text, &draft, &Limits::within(Duration::MAX));
    let judge = judge.map_err(|rejection| {
        refused(
            rejection.reason,
            "the checkers read the model themselves; the answer is printed without '--certificate'",
        )
    })?;
    Ok((judge, precision))
}

/// The certificate; `None` where the checkers do not see that no gains of the box are good.
fn written(answer: &TuneAnswer, claim: &TuneClaim, budget: &Budget) -> Result<Option<String>, Error> {
    let (judge, precision) = judge(answer, claim, budget)?;
    let bytes = answer.problem.model().source().text.len();
    let found = Cells::new(&judge, budget).tree(bytes);
    budget.check()?;
    match found {
        Written::Tree(tree) => tune_certificate(&answer.problem, claim, &tree, precision, budget).map(Some),
        Written::TooClose => Ok(None),
    }
}

/// What is to be best.
enum Target<'a> {
    Formula { parts: [MultiPoly; 2], is_greatest: bool, width: Rational },
    Level { level: Level, between: Option<&'a jurist_model::Between> },
}

impl<'a> Target<'a> {
    fn of(answer: &'a TuneAnswer, claim: &TuneClaim) -> Option<Target<'a>> {
        let gain = |k: usize, is_greatest: bool| {
            let [low, high] = &claim.gains[k].range;
            let parts = [MultiPoly::variable(k), MultiPoly::constant(Integer::ONE)];
            Target::Formula { parts, is_greatest, width: high - low }
        };
        Some(match &answer.asked.objective {
            Objective::Greatest(k) => gain(*k, true),
            Objective::Least(k) => gain(*k, false),
            Objective::Formula { is_greatest, .. } => {
                Target::Formula { parts: answer.formula.clone()?, is_greatest: *is_greatest, width: Rational::ONE }
            }
            _ => Target::Level { level: answer.asked.level()?, between: answer.asked.between() },
        })
    }

    fn is_rising(&self) -> bool {
        match self {
            Target::Formula { is_greatest, .. } => *is_greatest,
            Target::Level { level, .. } => level.is_rising(),
        }
    }

    /// A value that is better by about a share.
    fn beyond(&self, value: &Rational, bits: u64) -> Rational {
        let size = match self {
            Target::Formula { width, .. } if value.is_zero() => width.clone(),
            Target::Formula { .. } => value.abs(),
            Target::Level { level, .. } => self.distance(value, *level),
        };
        let share = size * Rational::dyadic(&1.into(), bits);
        let [near, far] = match self.is_rising() {
            true => [value + &(&share * &Rational::dyadic(&1.into(), 1)), value + &share],
            false => [value - &share, value - &(&share * &Rational::dyadic(&1.into(), 1))],
        };
        simplest_between(&near, &far).unwrap_or(far)
    }

    /// How far a value of a level is from the worst one.
    fn distance(&self, value: &Rational, level: Level) -> Rational {
        let [low, high] = level.scale();
        (value - if level.is_rising() { &low } else { &high }).abs()
    }

    /// What says that none have a value; `None` where no such value can be asked for.
    fn best(&self, proved: &Rational) -> Result<Option<BestOf>, Error> {
        Ok(match self {
            Target::Formula { parts: [above, below], is_greatest, .. } => Some(BestOf::Formula {
                above: above.clone(),
                below: below.clone(),
                is_greatest: *is_greatest,
                proved: proved.clone(),
            }),
            Target::Level { .. } => self.asked(proved)?.map(BestOf::Level),
        })
    }

    /// A level that gains have with this value: worse by a share.
    fn found(&self, value: &Rational, bits: u64) -> Result<Option<LevelAsked>, Error> {
        let Target::Level { level, .. } = self else { return Ok(None) };
        let share = self.distance(value, *level) * Rational::dyadic(&1.into(), bits);
        let [near, far] = match level.is_rising() {
            true => [value - &share, value - &(&share * &Rational::dyadic(&1.into(), 1))],
            false => [value + &(&share * &Rational::dyadic(&1.into(), 1)), value + &share],
        };
        self.asked(&simplest_between(&near, &far).unwrap_or(far))
    }

    /// The level with its number; `None` where it is at an end of what it may be.
    fn asked(&self, scale: &Rational) -> Result<Option<LevelAsked>, Error> {
        let Target::Level { level, between } = self else { return Ok(None) };
        let [low, high] = level.scale();
        if *scale <= low || *scale >= high {
            return Ok(None);
        }
        level.asked_between(scale, *between).map(Some)
    }
}
