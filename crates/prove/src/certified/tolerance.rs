//! Certificates of boxes of tolerances: exact ones, and boxes for all values where there are none.

use super::for_all::leaf;
use crate::Certificate;
use crate::ForAllClaim;
use crate::for_all_certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::{Limits, check};
use jurist_engine::answer::{Answer, ToleranceAnswer};
use jurist_engine::problem::{Ask, Problem};
use jurist_engine::response::{AllOf, Requirement};
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_stability::boxes::{BoxDecision, Side, Witness};
use std::time::Duration;

/// The parts of the largest proved factor that are tried: close to it a box touches what is not good.
const SHARES: [(i64, i64); 4] = [(1, 1), (999, 1000), (99, 100), (9, 10)];

/// The point beyond is looked for so many times as far from the nominal one as the known witness, which may be too close to the boundary.
const STEPS_BEYOND: [(i64, i64); 3] = [(1, 1), (1_000_001, 1_000_000), (1001, 1000)];

/// A certificate of the largest box of tolerances that was proved, and how much of it.
///
/// ```
/// use jurist_prove::certified::certify_tolerance;
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::ToleranceRequest;
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// let request = ToleranceRequest::new([("R_a", "20%".parse()?), ("L_a", "20%".parse()?)]);
/// let answer = Model::drive().ask().tolerance(&request, &Budget::unlimited()).unwrap();
/// assert_eq!(certify_tolerance(&answer, None, &Budget::unlimited()).unwrap().factor, None, "an exact one");
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CertifiedTolerance {
    /// The certificate.
    pub text: String,
    /// Where it is of a box that is the tolerances times a factor, all points of which are good, and says of no largest factor: that factor.
    pub factor: Option<Rational>,
}

/// A certificate of an answer about tolerances: of the largest box that was proved, and of a point beyond.
///
/// Where there is no exact one, as with tolerances inside of functions, with dead time, and with requirements, the box is cut into parts until the checkers see
/// of each that it is good. Margins are taken at a cut. Next to the largest factor these are many, so a box that is a little smaller is taken if they are too many.
///
/// Cost: that of [`Certificate::certificate`](crate::Certificate::certificate), else that of the parts.
///
/// ```
/// use jurist_prove::certified::certify_tolerance;
/// use jurist_algebra::limits::Budget;
/// use jurist_check::{Limits, check};
/// use jurist_engine::answer::ToleranceRequest;
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// use jurist_model::error::Source;
/// let text = std::fs::read_to_string("../../examples/dc-servo.toml").unwrap();
/// let (model, _) = Model::from_toml(&Source::new("servo.toml", &text))?;
/// let request = ToleranceRequest::new([("T_m", "20%".parse().unwrap())]);
/// let budget = Budget::unlimited();
/// let certified = certify_tolerance(&model.ask().tolerance(&request, &budget)?, None, &budget)?;
/// assert!(certified.factor.unwrap() > 1.into());
/// assert!(check(&text, &certified.text, &Limits::default()).unwrap().statement.contains("the loop is stable"));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where there is neither.
pub fn certify_tolerance(
    answer: &Answer<ToleranceAnswer>,
    at: Option<&str>,
    budget: &Budget,
) -> Result<CertifiedTolerance, Error> {
    if answer.value().required.is_empty() {
        match answer.certificate(budget) {
            Err(Error::Refused(why)) if why.code() == Code::NoCertificate && answer.value().limit.is_none() => {
                return by_parts(answer, at, budget)?.ok_or(Error::Refused(why));
            }
            text => return Ok(CertifiedTolerance { text: text?, factor: None }),
        }
    }
    for required in &answer.value().required {
        required.requirement.refuse_uncertified(answer.problem().time())?;
    }
    let none = || {
        let (why, help) = match misses_at_nominal(answer.value()) {
            true => (
                "no certificate: the nominal point itself misses what is asked for, so that no box around it has one",
                "'jurist verdict --certificate' proves what the nominal point misses",
            ),
            false => (
                "no certificate: nothing was decided of the box, or the checkers do not see it",
                "the answer is printed without '--certificate'",
            ),
        };
        Diagnostic::error(Code::NoCertificate, why).help(help).into()
    };
    by_parts(answer, at, budget)?.ok_or_else(none)
}

/// Whether the point that is not good is the nominal one.
fn misses_at_nominal(value: &ToleranceAnswer) -> bool {
    let BoxDecision::NotStable { witness: Some(witness) } = &value.decision else { return false };
    value.sides.iter().zip(&witness.point).all(|(side, x)| side.nominal() == x)
}

/// By parts of the box; `None` where nothing was proved, or is seen.
fn by_parts(
    answer: &Answer<ToleranceAnswer>,
    at: Option<&str>,
    budget: &Budget,
) -> Result<Option<CertifiedTolerance>, Error> {
    budget.step("certificate");
    let (problem, value) = (answer.problem(), answer.value());
    let whole = matches!(value.decision, BoxDecision::Stable(_)).then_some(Rational::ONE);
    let proved = value.factor.iter().map(|factor| factor.lower.clone()).chain(whole).max();
    let requirements: Vec<Requirement> = value.required.iter().map(|r| r.requirement.clone()).collect();
    let none = ForAllClaim::new(Vec::new(), Vec::new()).with_requirements(requirements, at.map(str::to_owned));
    let shares = proved.filter(|factor| factor.sign().is_gt()).into_iter();
    for factor in shares.flat_map(|factor| SHARES.map(|(n, d)| &factor * &Rational::new(n.into(), d.into()))) {
        let names = problem.free().iter().zip(&value.sides).map(|(free, side)| (&free.name, side.at(&factor)));
        let all = names.filter_map(|(name, [low, high])| AllOf::new(name, low, high)).collect();
        let mut claim = none.clone();
        claim.all = all;
        let Some((tree, precision)) = seen(leaf(problem, &claim, true, budget))? else { continue };
        let plain = for_all_certificate(problem, &claim, &tree, precision, budget)?;
        for point in beyond(value) {
            let Some(steps) = refuted(problem, &point, &none, budget)? else { continue };
            claim.beyond = Some((point, steps));
            let text = for_all_certificate(problem, &claim, &tree, precision, budget)?;
            // Of a point next to the boundary the checkers may see nothing.
            if check(&problem.model().source().text, &text, &Limits::within(Duration::MAX)).is_ok() {
                return Ok(Some(CertifiedTolerance { text, factor: Some(factor) }));
            }
        }
        return Ok(Some(CertifiedTolerance { text: plain, factor: Some(factor) }));
    }
    Ok(None)
}

/// Points that are not good, the known witness and further ones behind it.
fn beyond(value: &ToleranceAnswer) -> Vec<Vec<Rational>> {
    let witness = value.factor.as_ref().and_then(|factor| factor.witness.as_ref()).or(match &value.decision {
        BoxDecision::NotStable { witness } => witness.as_ref(),
        _ => None,
    });
    let further = |witness: &Witness, (n, d): (i64, i64)| -> Vec<Rational> {
        let at = |(side, x): (&Side, &Rational)| {
            side.nominal() + &(&(x - side.nominal()) * &Rational::new(n.into(), d.into()))
        };
        value.sides.iter().zip(&witness.point).map(at).collect()
    };
    witness.into_iter().flat_map(|witness| STEPS_BEYOND.map(|step| further(witness, step))).collect()
}

/// How it is written that a point is not good; `None` where the checkers do not see it.
fn refuted(
    problem: &Problem,
    point: &[Rational],
    claim: &ForAllClaim,
    budget: &Budget,
) -> Result<Option<String>, Error> {
    if claim.requirements.is_empty() {
        return Ok(Some("0.".to_owned()));
    }
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().within(problem.region().clone()).set_all(problem.set().to_vec());
    // A value may be none that the model allows.
    let Some(here) = seen(question.set_all(names.zip(point.iter().cloned())).problem())? else { return Ok(None) };
    let Some((steps, _)) = seen(leaf(&here, claim, false, budget))? else { return Ok(None) };
    // In the statement the letters of the names of the box come before those of the factor, each of which follows the letter of a step.
    let behind = |letter: char| char::from_u32(letter as u32 + point.len() as u32).unwrap_or(letter);
    let mut is_name = false;
    let written = steps.trim_start_matches('-').chars().map(|letter| {
        let own = if is_name { behind(letter) } else { letter };
        is_name = !is_name && !letter.is_ascii_digit();
        own
    });
    Ok(Some(written.collect()))
}

/// What the checkers see; `None` where they do not.
fn seen<T>(found: Result<T, Error>) -> Result<Option<T>, Error> {
    match found {
        Ok(found) => Ok(Some(found)),
        Err(Error::Refused(_)) => Ok(None),
        Err(other) => Err(other),
    }
}
