//! Certificates of boxes of tolerances: the tree of cells, and a point beyond.

use crate::Certificate;
use jurist_engine::problem::Ask;
mod held;

use super::complex::times;
use super::held::{is_held, polynomials, terms};
use super::statement::{about, number, object, region, set};
use super::text::to_text;
use super::{no_certificate, refuse_requirements};
use held::Held;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::MultiPoly;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceLimit, Truth};
use jurist_engine::problem::Problem;
use jurist_model::error::Error;
use jurist_stability::boxes::{BoxDecision, BoxPolynomial, BoxProof, Side, ToleranceProblem, Witness};
use jurist_stability::{AtPoint, RootCount};
use serde_json::Value;
use std::sync::Arc;

/// The schema of certificates of boxes.
const SCHEMA: &str = "jurist/certificate/4";

/// The parts of the largest proved factor that are tried where it is known by signs.
const SHARES: [(i64, i64); 4] = [(1, 1), (999, 1000), (99, 100), (9, 10)];

/// The schema of those over symbols.
const SCHEMA_WITH_SYMBOLS: &str = "jurist/certificate/8";

impl Certificate for Answer<ToleranceAnswer> {
    /// A certificate of the largest box that was proved, with the point beyond it that was found: both together prove the bracket
    /// of the largest factor, exact factors included. Where the range of one parameter was asked for, of the box of the others with that whole range, with a
    /// point beyond either end. Where no box was proved, of the verdict at a point that is not stable.
    ///
    /// Cost: that of writing the polynomials and trees of the proof; the box with the range of one parameter is proved as one.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_check::{Limits, check};
    /// use jurist_engine::answer::ToleranceRequest;
    /// use jurist_model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_prove::Certificate;
    /// let (drive, budget) = (Model::drive(), Budget::unlimited());
    /// let request = ToleranceRequest::new([("R_a", "20%".parse()?), ("L_a", "20%".parse()?)]);
    /// let certificate = drive.ask().tolerance(&request, &budget).unwrap().certificate(&budget).unwrap();
    /// let proved = check(&drive.source().text, &certificate, &Limits::default()).unwrap();
    /// assert_eq!(proved.kind, "tolerance");
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where nothing was decided, a parameter is inside of
    /// a function, or the loop has other functions than those of holds and prewarped rules.
    fn certificate(&self, budget: &Budget) -> Result<String, Error> {
        budget.step("certificate");
        let (problem, value) = (self.problem(), self.value());
        refuse_requirements(problem)?;
        let is_held = is_held(problem, budget)?;
        let witness = value.factor.as_ref().and_then(|factor| factor.witness.as_ref()).or(match &value.decision {
            BoxDecision::NotStable { witness } => witness.as_ref(),
            _ => None,
        });
        if value.limit.is_none() && proved(value).is_none() {
            return match witness {
                Some(witness) => of_point(problem, &witness.point, budget),
                None => Err(no_certificate("no certificate: the box was not decided")),
            };
        }
        let Some(d) = problem.algebra_over_symbols(budget)?.polynomial() else {
            return Err(no_certificate("no certificate: the loop is undefined everywhere"));
        };
        let truth = Truth::of(problem, budget)?;
        let variables = truth.beside(&value.sides).len();
        let p = &budget.enter(|| BoxPolynomial::over(d, variables, problem.shape()))?;
        let held = if is_held { Some(Held::of(problem, budget)?) } else { None };
        let of = Loop { problem, p, held, budget };
        match (&value.limit, proved(value)) {
            (Some(limit), _) => of.limit(&value.sides, &truth, limit),
            (None, Some((factor, proof))) => {
                let (factor, proof) = &in_trees(p, truth.beside(&value.sides), (factor, proof), budget)?;
                let factor = factor.clone();
                let (sides, factor) = match value.sides.iter().all(Side::grows) {
                    true => (value.sides.clone(), factor),
                    // In a certificate all sides grow: it is of the box itself.
                    false => (value.sides.iter().map(|side| side.grown(&factor)).collect(), Rational::ONE),
                };
                of.box_of_sides(&sides, (factor, proof), None, witness.map(|w| (w, &sides[..])))
            }
            (None, None) => unreachable!("something was proved"),
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

/// A proof as the checkers read it: a box that is known by signs, or a little smaller one, is proved once more by cells of frequency.
fn in_trees(
    p: &BoxPolynomial,
    sides: Vec<Side>,
    (factor, proof): (Rational, &BoxProof),
    budget: &Budget,
) -> Result<(Rational, BoxProof), Error> {
    if proof.is_in_trees() {
        return Ok((factor, proof.clone()));
    }
    let boxes = ToleranceProblem::new(p, sides).expect("stable at the nominal point");
    for (n, d) in SHARES {
        let factor = &factor * &Rational::new(n.into(), d.into());
        if let Some(proof) = boxes.proof_in_trees(&factor, budget)? {
            return Ok((factor, proof));
        }
    }
    Err(no_certificate("no certificate: the proof of the box by cells of frequency takes too many"))
}

/// What boxes are certified of.
struct Loop<'a> {
    problem: &'a Arc<Problem>,
    p: &'a BoxPolynomial,
    /// The symbols, if there are any.
    held: Option<Held>,
    budget: &'a Budget,
}

impl Loop<'_> {
    /// The certificate of a box, which is the tolerances times a factor, and of points outside of it. Each point has a factor for its sides. The certificate leaves
    /// out a point whose roots the checkers cannot count.
    fn box_of_sides<'w>(
        &self,
        sides: &[Side],
        (factor, proof): (Rational, &BoxProof),
        limit: Option<&str>,
        points: impl IntoIterator<Item = (&'w Witness, &'w [Side])>,
    ) -> Result<String, Error> {
        let Loop { problem, p, held, budget } = self;
        let (mut found, mut bits) = (Vec::new(), 0);
        for (witness, sides) in points {
            if let Some(held) = held {
                let Some(of_point) = held.bits_beyond(p, witness, budget)? else { continue };
                bits = bits.max(of_point);
            }
            found.push(beyond(witness, sides, (p.formal_degree(), times(problem))));
        }
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
            ("limit", limit.map_or(Value::Null, Value::from)),
            ("beyond", Value::Array(found)),
        ]);
        let mut parts = vec![("model", about(problem)?), ("statement", statement)];
        if let Some(held) = held {
            let nominal: Vec<Rational> = sides.iter().map(|side| side.nominal().clone()).collect();
            let inside = held.bits_inside(p, &nominal, budget)?;
            let inside = inside.ok_or_else(|| no_certificate("no certificate: a root count is not certain"))?;
            let all = p.in_half_plane();
            let all = all.iter().chain(p.certain().iter().map(|(_, f)| f));
            parts.extend(held.parts(problem, bits.max(inside), all, budget)?);
        }
        parts.extend(self.proof(proof));
        let schema = if held.is_some() { SCHEMA_WITH_SYMBOLS } else { SCHEMA };
        let parts = [("schema", schema.into())].into_iter().chain(parts);
        Ok(to_text(&Value::Object(parts.map(|(key, value)| (key.to_owned(), value)).collect())))
    }

    /// The parts of a certificate that prove its box.
    fn proof(&self, proof: &BoxProof) -> [(&'static str, Value); 3] {
        let Loop { problem, p, held, .. } = self;
        let parameters = problem.free().len();
        let certain = p.certain().iter().zip(&proof.certain).filter_map(|((_, f), tree)| {
            let f = match held {
                None => Some(f.clone()).filter(|f| !f.is_constant()),
                Some(held) => held.in_parameters(f),
            }?;
            Some((f, tree))
        });
        let factors = certain.map(|(f, tree)| {
            object([("polynomial", terms(&f)), ("tree", tree.of_first(parameters).to_string().into())])
        });
        let power = |exponent: i64| Rational::from(2).pow(exponent).expect("two is not zero");
        let pair = object([
            ("v0", number(&power(2 * proof.scale))),
            ("weight", number(&power(proof.weight))),
            ("tree", proof.pair.of_first(parameters).to_string().into()),
        ]);
        [
            ("characteristic", polynomials(&primitive(&p.coefficients_in_region()))),
            ("factors", factors.collect()),
            ("pair", pair),
        ]
    }

    /// The box of the others' tolerances and the whole range of one parameter, proved as one, and what was found beyond its ends.
    fn limit(&self, sides: &[Side], truth: &Truth, limit: &ToleranceLimit) -> Result<String, Error> {
        let [Some(lower), Some(upper)] = &limit.sides else {
            return Err(no_certificate("no certificate: the box of the others is not stable"));
        };
        let names = self.problem.free().iter();
        let at = names.clone().position(|free| free.name == limit.parameter).expect("the limit's parameter is free");
        let mut own = sides.to_vec();
        own[at] = Side::scaled(limit.nominal.clone(), [&limit.nominal - &lower.safe, &upper.safe - &limit.nominal]);
        let boxes = ToleranceProblem::new(self.p, truth.beside(&own)).expect("stable at the nominal point");
        let none = || no_certificate("no certificate: the proof of the whole range at once takes too many cells");
        let BoxDecision::Stable(proof) = boxes.decide(&Rational::ONE, self.budget)? else { return Err(none()) };
        if !proof.is_in_trees() {
            return Err(none());
        }
        // Only the limit's own side grows with the factor of a point beyond.
        let alone: Vec<Side> =
            own.iter().enumerate().map(|(i, side)| if i == at { side.clone() } else { still(side) }).collect();
        let found = [lower, upper].into_iter().filter_map(|side| side.factor.witness.as_ref());
        let found = found.filter(|w| !alone[at].widths()[usize::from(w.point[at] > limit.nominal)].is_zero());
        let points = found.map(|witness| (witness, &alone[..]));
        self.box_of_sides(&own, (Rational::ONE, &proof), Some(&limit.parameter), points)
    }
}

/// The side as a place that does not grow.
fn still(side: &Side) -> Side {
    Side::fixed(side.nominal().clone(), side.widths().clone())
}

/// A point that is not stable, and the least factor whose box holds it.
fn beyond(witness: &Witness, sides: &[Side], (degree, times): (usize, usize)) -> Value {
    let (count, infinite) = match &witness.at {
        None | Some(AtPoint::Undefined | AtPoint::Delayed { .. }) => (RootCount::default(), 0),
        Some(AtPoint::Zero) => (RootCount::default(), degree),
        Some(AtPoint::Defined { count, infinite }) => (*count, *infinite),
    };
    let growing = sides.iter().zip(&witness.point).filter(|(side, _)| side.grows());
    let shares = growing.filter_map(|(side, x)| {
        let offset = x - side.nominal();
        offset.abs().checked_div(&side.widths()[usize::from(offset.sign().is_gt())])
    });
    object([
        ("factor", number(&shares.max().unwrap_or(Rational::ZERO))),
        ("point", witness.point.iter().map(number).collect()),
        ("degree", (degree / times).into()),
        ("inside", (count.inside / times).into()),
        ("on", (count.on / times).into()),
        ("outside", (count.outside / times).into()),
        ("infinite", (infinite / times).into()),
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
