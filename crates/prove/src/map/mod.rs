//! Certificates of maps of two parameters: the curves, the walls between strips, the cells, and what joins them.

mod isolation;
mod strips;

use super::cofactors::{Identity, of_half_size_pair};
use super::emit::coprime_basis;
use super::held::{polynomials, terms};
use super::refuse_requirements;
use super::statement::{about, boundary, number, object, region, set};
use super::text::{MAX_TEXT, to_text};
use crate::Certificate;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_engine::answer::{Answer, Map};
use jurist_engine::coverage::{MAP_OF_CONSTANTS, MAP_WITH_DEAD_TIME};
use jurist_engine::problem::{Bound, Problem};
use jurist_model::error::{Code, Diagnostic, Error};
use jurist_stability::Range;
use jurist_stability::plane::{PlanePolynomial, StabilityMap, critical_polynomials, joins};
use serde_json::Value;
use strips::Decomposed;

/// The schema of certificates of maps.
const SCHEMA: &str = "jurist/certificate/5";

/// The parts of the proof, empty where a boundary polynomial vanishes identically.
struct Proof {
    identity: Option<Identity<MultiPoly>>,
    factors: Vec<MultiPoly>,
    x_factors: Value,
    strips: Value,
    joins: Value,
}

impl Certificate for Answer<Map> {
    /// A certificate of this map: it proves that the stable points off the boundary curves and the walls are those of the cells of
    /// its regions, and that the cells of each region are connected.
    ///
    /// Cost: the identity of the half-size pair with its cofactors, `O(n^2)` operations on polynomials in both parameters; the discriminants
    /// and resultants of the map once more, with their multiplicities; for each wall and each cell's branch counts of sign
    /// variations until the gaps are covered. The text grows with the strips and the cells, not with the resultants: the checkers
    /// compute these themselves.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_check::{Limits, check};
    /// use jurist_model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_prove::Certificate;
    /// let (drive, budget) = (Model::drive(), Budget::unlimited());
    /// let map = drive.ask().free("T").free("K_pwm").map(6, &budget).unwrap();
    /// let certificate = map.certificate(&budget).unwrap();
    /// let proved = check(&drive.source().text, &certificate, &Limits::default()).unwrap();
    /// assert_eq!(proved.kind, "map");
    /// ```
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) for maps of requirements, of loops that are
    /// not rational or have dead time, and of a region whose bound is free; and where the certificate would be longer than the
    /// checkers read.
    fn certificate(&self, budget: &Budget) -> Result<String, Error> {
        budget.enter(|| {
            let (problem, map) = (self.problem(), self.value());
            refuse_map_certificate(problem, budget)?;
            if map.required.is_some() {
                return Err(no_certificate("no certificate of a map: nothing proves requirements"));
            }
            budget.step("certificate");
            let (mut characteristic, mut proof) = (Vec::new(), Proof::of_nothing());
            if let Some(p) = problem.plane(budget)? {
                characteristic = coefficients(p);
                proof = Proof::of(p, problem, &map.decomposition, budget)?;
            }
            let certificate = object([
                ("schema", SCHEMA.into()),
                ("model", about(problem)?),
                ("statement", statement(problem, &map.decomposition)),
                ("characteristic", polynomials(&characteristic)),
                ("boundary", boundary(proof.identity.as_ref(), terms)),
                ("factors", polynomials(&proof.factors)),
                ("x_factors", proof.x_factors),
                ("strips", proof.strips),
                ("joins", proof.joins),
            ]);
            let text = to_text(&certificate);
            if text.len() > MAX_TEXT {
                let size = text.len() >> 20;
                return Err(no_certificate(format!(
                    "no certificate: it would be {size} MiB long, and the checkers read {}",
                    MAX_TEXT >> 20
                )));
            }
            Ok(text)
        })?
    }
}

/// Refuses problems whose map has no certificate, before it is made.
///
/// Cost: that of [`Problem::algebra_over_symbols`].
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`).
pub fn refuse_map_certificate(problem: &Problem, budget: &Budget) -> Result<(), Error> {
    refuse_requirements(problem)?;
    if *problem.region().bound() == Bound::Free {
        return Err(no_certificate("no certificate of a map on which the bound of the region is free"));
    }
    let symbols = problem.algebra_over_symbols(budget)?.symbols();
    if !symbols.delays().is_empty() {
        return Err(MAP_WITH_DEAD_TIME.diagnostic(&[]).into());
    }
    if !problem.positive().is_empty() || !symbols.is_empty() || symbols.are_brought() {
        return Err(MAP_OF_CONSTANTS.diagnostic(&[]).into());
    }
    Ok(())
}

fn no_certificate(why: impl Into<String>) -> Error {
    Diagnostic::error(Code::NoCertificate, why).help(MAP_OF_CONSTANTS.help).into()
}

/// That the stable points are in these cells.
fn statement(problem: &Problem, map: &StabilityMap) -> Value {
    let end = |b: &Option<jurist_algebra::number::Rational>| b.as_ref().map_or(Value::Null, number);
    let range = |r: &Range| object([("lower", end(&r.lower)), ("upper", end(&r.upper))]);
    let [x, y] = problem.free() else { unreachable!("two parameters are free") };
    let cells = |cells: &[(usize, usize)]| -> Value { cells.iter().map(|(s, c)| Value::from(vec![*s, *c])).collect() };
    object([
        ("kind", "map".into()),
        ("time", problem.time().name().into()),
        ("x", x.name.as_str().into()),
        ("y", y.name.as_str().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("domain", object([("x", range(&x.domain)), ("y", range(&y.domain))])),
        ("regions", map.regions.iter().map(|r| cells(&r.cells)).collect()),
    ])
}

/// The coefficients without denominators and without an integer common to all of them.
fn coefficients(p: &PlanePolynomial) -> Vec<MultiPoly> {
    let all: Vec<MultiPoly> = (0..=p.formal_degree()).map(|k| p.polynomial().coeff(k)).collect();
    let content = all.iter().fold(Integer::ZERO, |g, c| g.gcd(&c.integer_content()));
    if content.is_zero() {
        return all;
    }
    all.iter().map(|c| c.div_exact_integer(&content).expect("a content")).collect()
}

impl Proof {
    fn of_nothing() -> Proof {
        let empty = || Value::Array(Vec::new());
        Proof { identity: None, factors: Vec::new(), x_factors: empty(), strips: empty(), joins: empty() }
    }

    fn of(p: &PlanePolynomial, problem: &Problem, map: &StabilityMap, budget: &Budget) -> Result<Proof, Exhausted> {
        let shape = problem.shape();
        let mut all = p.certain(shape);
        let mut proof = Proof::of_nothing();
        if all.iter().any(MultiPoly::is_zero) {
            return Ok(proof);
        }
        if p.formal_degree() >= 2 {
            budget.step("the identity of the half-size pair");
            // Of what the characteristic part says, without common integers.
            let d = jurist_algebra::poly::Poly::new(coefficients(p));
            let identity = of_half_size_pair(&d, p.formal_degree(), shape, budget)?;
            let value = identity.value.clone();
            proof.identity = Some(identity);
            if value.is_zero() {
                return Ok(proof);
            }
            all.push(value);
        }
        let known = map.curves.iter().map(|curve| curve.polynomial.primitive_over_integers()).collect();
        proof.factors = factors(known, &all, budget)?;
        budget.step("factors of the walls");
        let [x, y] = problem.free() else { unreachable!("two parameters are free") };
        let critical = critical_polynomials(&proof.factors, &y.domain, budget)?;
        let x_factors = coprime_basis(&critical, budget)?;
        budget.step("the segments that join cells");
        let joins = joins(&map.curves, &map.strips, &y.domain, budget)?;
        let decomposed = Decomposed {
            factors: &proof.factors,
            x_factors: &x_factors,
            strips: &map.strips,
            joins: &joins,
            domain: [&x.domain, &y.domain],
        };
        budget.step("walls");
        proof.x_factors = decomposed.walls(budget)?;
        budget.step("strips");
        proof.strips = decomposed.strips(budget)?;
        proof.joins = decomposed.joins(budget)?;
        Ok(proof)
    }
}

/// The curves, cut further where that is needed for all polynomials to be products of them: parts of different multiplicity in one of
/// these are told apart.
fn factors(mut curves: Vec<MultiPoly>, all: &[MultiPoly], budget: &Budget) -> Result<Vec<MultiPoly>, Exhausted> {
    for p in all {
        let mut rest = p.primitive_over_integers();
        while !rest.is_constant() {
            budget.check()?;
            if let Some(quotient) = curves.iter().find_map(|f| rest.div_exact(f)) {
                rest = quotient;
                continue;
            }
            let common = |f: &MultiPoly| f.gcd(&rest).primitive_over_integers();
            let shared = curves.iter().map(common).enumerate().find(|(_, g)| !g.is_constant());
            let (i, g) = shared.expect("the curves are all zeros of the boundary polynomials");
            curves[i] = curves[i].div_exact(&g).expect("a common divisor").primitive_over_integers();
            curves.push(g);
        }
    }
    Ok(curves)
}
