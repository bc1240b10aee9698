//! Certificates of boxes of tolerances: the tree of cells, and a point beyond.

use super::held::{is_held, polynomials, terms};
use super::statement::{about, number, object, region, set};
use super::text::to_text;
use super::{no_certificate, refuse_requirements};
use crate::answer::{Answer, ToleranceAnswer};
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::boxes::{BoxDecision, BoxPolynomial, BoxProof, Side, Witness};
use crate::stability::{AtPoint, RootCount};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::MultiPoly;
use serde_json::Value;
use std::sync::Arc;

/// The schema of certificates of boxes.
const SCHEMA: &str = "jurist/certificate/4";

impl Answer<ToleranceAnswer> {
    /// A certificate of the largest box that was proved, with the point beyond it that was found; where no box was, of the
    /// verdict at a point that is not stable.
    ///
    /// Cost: that of writing the polynomials and trees of the proof. Nothing is proved again.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_check::{Limits, check};
    /// use jurist_engine::answer::ToleranceRequest;
    /// use jurist_engine::model::Model;
    /// let (drive, budget) = (Model::drive(), Budget::unlimited());
    /// let request = ToleranceRequest::new([("R_a", "20%".parse()?), ("L_a", "20%".parse()?)]);
    /// let certificate = drive.ask().tolerance(&request, &budget).unwrap().certificate(&budget).unwrap();
    /// let proved = check(&drive.source().text, &certificate, &Limits::default()).unwrap();
    /// assert_eq!(proved.kind, "tolerance");
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where nothing was decided, or the loop is
    /// not rational.
    pub fn certificate(&self, budget: &Budget) -> Result<String, Error> {
        budget.step("certificate");
        let (problem, value) = (self.problem(), self.value());
        refuse_requirements(problem)?;
        if problem.delayed(budget)?.is_some() || is_held(problem, budget)? {
            return Err(no_certificate("no certificate of a box: the loop has constants that are not rational"));
        }
        let witness = value.factor.as_ref().and_then(|factor| factor.witness.as_ref()).or(match &value.decision {
            BoxDecision::NotStable { witness } => witness.as_ref(),
            _ => None,
        });
        match (proved(value), witness) {
            (Some((factor, proof)), witness) => {
                let Some(d) = problem.algebra(budget)?.polynomial() else {
                    return Err(no_certificate("no certificate: the loop is undefined everywhere"));
                };
                let p = budget.enter(|| BoxPolynomial::new(d, problem.shape()))?;
                of_box(problem, &p, &value.sides, (factor, proof), witness)
            }
            (None, Some(witness)) => of_point(problem, &witness.point, budget),
            (None, None) => Err(no_certificate("no certificate: the box was not decided")),
        }
    }
}

/// The largest factor whose box was proved, with the proof.
fn proved(value: &ToleranceAnswer) -> Option<(Rational, &BoxProof)> {
    let bracket = value.factor.as_ref().and_then(|f| f.proof.as_ref().map(|proof| (f.lower.clone(), proof)));
    match &value.decision {
        BoxDecision::Stable(proof) if bracket.as_ref().is_none_or(|(lower, _)| *lower < Rational::ONE) => {
            Some((Rational::ONE, proof))
        }
        _ => bracket,
    }
}

fn of_box(
    problem: &Arc<Problem>,
    p: &BoxPolynomial,
    sides: &[Side],
    (factor, proof): (Rational, &BoxProof),
    witness: Option<&Witness>,
) -> Result<String, Error> {
    let tolerances = problem.free().iter().zip(sides).map(|(free, side)| {
        object([
            ("name", free.name.as_str().into()),
            ("nominal", number(side.nominal())),
            ("between", side.at(&Rational::ONE).iter().map(number).collect()),
        ])
    });
    let statement = object([
        ("kind", "tolerance".into()),
        ("time", problem.time().name().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("tolerances", tolerances.collect()),
        ("factor", number(&factor)),
        ("beyond", witness.map_or(Value::Null, |witness| beyond(witness, sides, p.formal_degree()))),
    ]);
    let certain = p.certain().iter().zip(&proof.certain).filter(|((_, f), _)| !f.is_constant());
    let factors = certain.map(|((_, f), tree)| object([("polynomial", terms(f)), ("tree", tree.to_string().into())]));
    let power = |exponent: i64| Rational::from(2).pow(exponent).expect("two is not zero");
    let pair = object([
        ("v0", number(&power(2 * proof.scale))),
        ("weight", number(&power(proof.weight))),
        ("tree", proof.pair.to_string().into()),
    ]);
    let certificate = object([
        ("schema", SCHEMA.into()),
        ("model", about(problem)),
        ("statement", statement),
        ("characteristic", polynomials(&primitive(&p.coefficients_in_region()))),
        ("factors", factors.collect()),
        ("pair", pair),
    ]);
    Ok(to_text(&certificate))
}

/// A point that is not stable, and the least factor whose box holds it.
fn beyond(witness: &Witness, sides: &[Side], degree: usize) -> Value {
    let (count, infinite) = match &witness.at {
        AtPoint::Undefined => (RootCount::default(), 0),
        AtPoint::Zero => (RootCount::default(), degree),
        AtPoint::Defined { count, infinite } => (*count, *infinite),
    };
    let shares = sides.iter().zip(&witness.point).filter_map(|(side, x)| {
        let offset = x - side.nominal();
        offset.abs().checked_div(&side.widths()[usize::from(offset.sign().is_gt())])
    });
    object([
        ("factor", number(&shares.max().unwrap_or(Rational::ZERO))),
        ("point", witness.point.iter().map(number).collect()),
        ("degree", degree.into()),
        ("inside", count.inside.into()),
        ("on", count.on.into()),
        ("outside", count.outside.into()),
        ("infinite", infinite.into()),
    ])
}

/// The certificate of the verdict at a point.
fn of_point(problem: &Arc<Problem>, point: &[Rational], budget: &Budget) -> Result<String, Error> {
    let names = problem.free().iter().map(|free| free.name.clone());
    let question = problem.model().ask().within(problem.region().clone()).set_all(problem.set().to_vec());
    question.set_all(names.zip(point.iter().cloned())).verdict(budget)?.certificate(budget)
}

/// Without the integers common to all.
fn primitive(list: &[MultiPoly]) -> Vec<MultiPoly> {
    let content = list.iter().fold(Integer::ZERO, |g, p| g.gcd(&p.integer_content()));
    if content.is_zero() {
        return list.to_vec();
    }
    list.iter().map(|p| p.div_exact_integer(&content).expect("a content")).collect()
}
