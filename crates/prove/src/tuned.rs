//! Certificates of best gains: the statement around a tree of cells.

use super::for_all::{range, requirement_of};
use super::statement::{about_at_rates, number, object, region, set};
use super::text::to_text;
use super::{no_certificate, refuse_free_bound};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;
use jurist_engine::problem::Problem;
use jurist_engine::response::{AllOf, LevelAsked, Requirement};
use jurist_model::error::Error;
use serde_json::Value;

/// The schema of these certificates.
const SCHEMA: &str = "jurist/certificate/11";

/// What is said of a box of gains: that none of them meet what is required, or none that are better than a value, and that some do.
///
/// ```
/// use jurist_prove::TuneClaim;
/// use jurist_engine::response::AllOf;
/// let claim = TuneClaim::new(vec![AllOf::new("K", 1.into(), 2.into()).unwrap()]);
/// assert!(claim.requirements.is_empty() && claim.best.is_none() && claim.found.is_none());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TuneClaim {
    /// The gains, and the box.
    pub gains: Vec<AllOf>,
    /// What is required beside stability.
    pub requirements: Vec<Requirement>,
    /// Where margins are taken.
    pub at: Option<String>,
    /// What is to be best.
    pub best: Option<BestOf>,
    /// Gains that are good.
    pub found: Option<FoundClaim>,
}

/// What is to be best, with a value that no gains have, nor a better one.
#[derive(Clone, Debug)]
pub enum BestOf {
    /// A quotient of polynomials of the gains.
    Formula {
        /// The numerator.
        above: MultiPoly,
        /// The denominator.
        below: MultiPoly,
        /// Whether more of it is better.
        is_greatest: bool,
        /// The value.
        proved: Rational,
    },
    /// A number of the loop.
    Level(LevelAsked),
}

/// Gains that are good.
#[derive(Clone, Debug)]
pub struct FoundClaim {
    /// The gains.
    pub point: Vec<Rational>,
    /// The level that they have, if a level is to be best.
    pub level: Option<LevelAsked>,
    /// How that is shown.
    pub proof: String,
}

impl TuneClaim {
    /// Stability alone.
    pub fn new(gains: Vec<AllOf>) -> TuneClaim {
        TuneClaim { gains, requirements: Vec::new(), at: None, best: None, found: None }
    }
}

/// A certificate of best gains. It proves nothing where the tree or the proof say more than the checkers see: who makes one asks `jurist_check::TuneJudge`.
/// `certified::certify_tune` does that.
///
/// How a tree is written is in `jurist_check::grammar`, *best gains*.
///
/// Cost: that of writing it.
///
/// # Errors
/// As [`for_all_certificate`](crate::for_all_certificate).
pub fn tune_certificate(
    problem: &Problem,
    claim: &TuneClaim,
    tree: &str,
    (order, bits): (usize, usize),
    budget: &Budget,
) -> Result<String, Error> {
    refuse_free_bound(problem)?;
    let own = |requirement: &Requirement| requirement_of(problem, requirement, claim.at.as_deref(), budget);
    let level = |level: &LevelAsked| match level {
        LevelAsked::Region(of) => Ok(region(of)),
        LevelAsked::Requirement(requirement) => own(requirement),
    };
    let objective = match &claim.best {
        None => Value::Null,
        Some(BestOf::Level(none)) => object([("level", level(none)?)]),
        Some(BestOf::Formula { above, below, is_greatest, proved }) => object([
            (
                if *is_greatest { "greatest" } else { "least" },
                object([("above", polynomial(above)), ("below", polynomial(below))]),
            ),
            ("proved", number(proved)),
        ]),
    };
    let found = match &claim.found {
        None => Value::Null,
        Some(found) => object([
            ("point", found.point.iter().map(number).collect()),
            ("level", found.level.as_ref().map_or(Ok(Value::Null), level)?),
            ("proof", found.proof.as_str().into()),
        ]),
    };
    let is_gain = |name: &str| claim.gains.iter().any(|gain| gain.name == name);
    let others: Vec<_> = problem.set().iter().filter(|(name, _)| !is_gain(name)).cloned().collect();
    let statement = object([
        ("kind", "tune".into()),
        ("time", problem.time().name().into()),
        ("gains", claim.gains.iter().map(range).collect()),
        ("set", set(&others)),
        ("region", region(problem.region())),
        ("require", claim.requirements.iter().map(own).collect::<Result<Vec<_>, _>>()?.into()),
        ("objective", objective),
        ("found", found),
        ("tree", tree.into()),
    ]);
    if problem.model().hyperperiod() > 1 && problem.region() != &jurist_engine::problem::Region::of(problem.time()) {
        return Err(no_certificate("no certificate: of a loop of several rates stability alone is certified"));
    }
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about_at_rates(problem)?),
        ("statement", statement),
        ("order", order.into()),
        ("bits", bits.into()),
    ])))
}

/// A polynomial as a list of terms: the coefficient, then the exponents.
fn polynomial(p: &MultiPoly) -> Value {
    let term = |(monomial, c): &(jurist_algebra::poly::Monomial, jurist_algebra::number::Integer)| {
        let exponents = monomial.exponents().iter().map(|e| Value::from(*e));
        std::iter::once(Value::from(c.to_string())).chain(exponents).collect::<Value>()
    };
    p.terms().iter().map(term).collect()
}
