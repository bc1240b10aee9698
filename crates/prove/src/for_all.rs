//! Certificates of what holds for all values of some names, and of requirements: the statement around a tree of boxes.

use super::statement::{about, about_at_rates, number, object, region, set};
use super::text::to_text;
use super::{no_certificate, refuse_free_bound};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::RealAlgebraic;
use jurist_engine::coverage::{REQUIREMENT_NOT_CERTIFIED, WIDE_DISK};
use jurist_engine::problem::{Problem, Region};
use jurist_engine::response::{AllOf, Level, Requirement, Rule, half_tangent, radius_below};
use jurist_model::Cut;
use jurist_model::error::Error;
use serde_json::Value;

/// The schema of these certificates.
const SCHEMA: &str = "jurist/certificate/10";

/// The requirement whose factors are a disc of their own.
const DISK: &str = "disk_margin";

/// The tangent of half of an angle is enclosed to so many bits.
const TURN_BITS: u64 = 48;

/// What the bound of a requirement on roots stands for is enclosed to so many bits.
const AROUND_BITS: u64 = 64;

/// Smaller radii than two to this power have no certificate.
const MOST_ZEROS: u64 = 512;

/// A factor that is not rational is rounded to so many digits.
const FACTOR_DIGITS: usize = 12;

/// Digits of an angle behind the point, and a power of two that is above half of what rounding changes, in radians.
const ANGLE_DIGITS: i64 = 9;
const NEAR_BITS: u64 = 34;

/// What is said of the boxes of a tree, of up to two names: whether the loop is stable, and meets what is required, at all points of a box for all values of
/// further names.
///
/// ```
/// use jurist_prove::ForAllClaim;
/// use jurist_engine::response::AllOf;
/// let claim = ForAllClaim::new(vec![AllOf::new("K", 1.into(), 2.into()).unwrap()], Vec::new());
/// assert!(claim.requirements.is_empty() && claim.beyond.is_none());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ForAllClaim {
    /// The names of the boxes, and their window.
    pub axes: Vec<AllOf>,
    /// Names for all of whose values it is said.
    pub all: Vec<AllOf>,
    /// What is required beside stability.
    pub requirements: Vec<Requirement>,
    /// Where margins are taken.
    pub at: Option<String>,
    /// Without axes: a point that is not good, and how that is shown.
    pub beyond: Option<(Vec<Rational>, String)>,
}

impl ForAllClaim {
    /// Stability alone.
    pub fn new(axes: Vec<AllOf>, all: Vec<AllOf>) -> ForAllClaim {
        ForAllClaim { axes, all, requirements: Vec::new(), at: None, beyond: None }
    }

    /// Requirements as well, margins being taken at a cut.
    pub fn with_requirements(self, requirements: Vec<Requirement>, at: Option<String>) -> ForAllClaim {
        ForAllClaim { requirements, at, ..self }
    }
}

/// A certificate that says of the boxes of a window what a tree says of them. The names of the claim may be free in the problem, or have values there; all
/// others have one. It proves nothing where the tree says more than the checkers see: who makes one asks `jurist_check::ForAllJudge`.
/// [`certify_requirements`](crate::certified::certify_requirements) does that.
///
/// How a tree is written is in `jurist_check::grammar`, *for all values*.
///
/// Cost: that of writing it.
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) for requirements that the checkers do not read, for margins beside a smaller region, and for a region whose bound
/// is free; as [`Model::cut`](jurist_model::Model::cut).
pub fn for_all_certificate(
    problem: &Problem,
    claim: &ForAllClaim,
    tree: &str,
    (order, bits): (usize, usize),
    budget: &Budget,
) -> Result<String, Error> {
    refuse_free_bound(problem)?;
    if !claim.requirements.is_empty() && problem.region() != &Region::of(problem.time()) {
        return Err(no_certificate(
            "no certificate: margins are proved of the loop's stability, not of a smaller region",
        ));
    }
    let requirements = claim.requirements.iter().map(|r| requirement_of(problem, r, claim.at.as_deref(), budget));
    let requirements = requirements.collect::<Result<Vec<_>, Error>>()?;
    let ranges = |list: &[AllOf]| list.iter().map(range).collect::<Vec<_>>();
    let is_named = |name: &str| claim.axes.iter().chain(&claim.all).any(|all| all.name == name);
    let others: Vec<_> = problem.set().iter().filter(|(name, _)| !is_named(name)).cloned().collect();
    let beyond = claim.beyond.as_ref().map_or(Value::Null, |(point, steps)| {
        object([("point", point.iter().map(number).collect()), ("not", steps.as_str().into())])
    });
    let statement = object([
        ("kind", "for_all".into()),
        ("time", problem.time().name().into()),
        ("axes", ranges(&claim.axes).into()),
        ("for_all", ranges(&claim.all).into()),
        ("set", set(&others)),
        ("region", region(problem.region())),
        ("require", requirements.into()),
        ("tree", tree.into()),
        ("beyond", beyond),
    ]);
    let about = if claim.requirements.is_empty() { about_at_rates(problem)? } else { about(problem)? };
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about),
        ("statement", statement),
        ("order", order.into()),
        ("bits", bits.into()),
    ])))
}

pub(super) fn requirement_of(
    problem: &Problem,
    requirement: &Requirement,
    at: Option<&str>,
    budget: &Budget,
) -> Result<Value, Error> {
    requirement.refuse_uncertified(problem.time())?;
    if let Some(of_roots) = of_roots(requirement.rule()) {
        return Ok(of_roots);
    }
    let mut bound = match requirement.rule() {
        Rule::Factors(factor) => vec![("bound", number(&above(factor)))],
        Rule::Turned { twice_cosine } => {
            let turns = turns(twice_cosine, budget)?;
            let (degrees, turns) = match requirement.required_number(0) {
                Some(degrees) => (degrees, turns),
                None => (rounded_degrees(twice_cosine), around_rounded(turns)),
            };
            vec![("bound", number(&degrees)), ("turns", turns.iter().map(number).collect())]
        }
        // From 2 on the factors of a disk margin fill a half plane or more.
        Rule::Circle(circle) if requirement.name() == DISK && *circle.asked() >= Rational::from(2) => {
            return Err(WIDE_DISK.diagnostic(&[("asked", &requirement.text())]).into());
        }
        Rule::Circle(circle) => vec![("bound", number(circle.asked()))],
        Rule::DeadTime(least) => vec![("bound", number(least))],
        Rule::Sector(_) | Rule::Modulus { .. } => unreachable!("it is one about roots"),
    };
    let cut = match problem.model().cut(at)? {
        Cut::Signal(name) => object([("signal", name.into())]),
        Cut::Input(name) => object([("input", name.into())]),
        Cut::Gain(name) => object([("parameter", name.into())]),
        Cut::PlantInput | Cut::Between(_) => {
            return Err(REQUIREMENT_NOT_CERTIFIED.diagnostic(&[("asked", &requirement.text())]).into());
        }
    };
    let mut all = vec![("kind", requirement.name().into()), ("at", cut)];
    all.append(&mut bound);
    Ok(Value::Object(all.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()))
}

/// A requirement on where the roots are; `None` of one at a cut.
fn of_roots(rule: &Rule) -> Option<Value> {
    let (kind, bound, key, around) = match rule {
        Rule::Sector(least) => {
            let square = least * least;
            let square = square.checked_div(&(Rational::ONE - &square)).expect("a damping is below 1");
            let slope = Enclosure::from_rational(square).sqrt(AROUND_BITS);
            ("damping", least, "slopes", [slope.lower().clone(), slope.upper().clone()])
        }
        Rule::Modulus { exponent } => {
            // As many bits behind the first one that is not zero, unless that is very far.
            let zeros = exponent.floor().to_i64().map_or(MOST_ZEROS, i64::unsigned_abs).min(MOST_ZEROS);
            let bits = AROUND_BITS + 2 * zeros;
            let below = radius_below(exponent, bits);
            ("log_radius", exponent, "radii", [below.clone(), below + Rational::dyadic(&1.into(), bits)])
        }
        Rule::Factors(_) | Rule::Turned { .. } | Rule::Circle(_) | Rule::DeadTime(_) => return None,
    };
    Some(object([("kind", kind.into()), ("bound", number(bound)), (key, around.iter().map(number).collect())]))
}

pub(super) fn range(of: &AllOf) -> Value {
    object([("name", of.name.as_str().into()), ("between", of.range.iter().map(number).collect())])
}

/// A factor, rounded up to some digits where it is not rational.
fn above(factor: &RealAlgebraic) -> Rational {
    factor.exact().unwrap_or_else(|| {
        let upper = factor.refined_to_digits(2 * FACTOR_DIGITS).enclosure().1;
        let unit = Rational::from(10).pow(-(FACTOR_DIGITS as i64)).expect("ten is not zero");
        rounded_down(&upper, &unit) + unit
    })
}

/// Two numbers around the tangent of half of an angle, of which twice the cosine is given.
fn turns(twice_cosine: &RealAlgebraic, budget: &Budget) -> Result<[Rational; 2], Exhausted> {
    let tangent = half_tangent(twice_cosine, budget)?;
    let (low, high) = tangent.refined_to_digits(TURN_BITS as usize).enclosure();
    let unit = Rational::dyadic(&1.into(), TURN_BITS);
    Ok([rounded_down(&low, &unit), rounded_down(&high, &unit) + unit])
}

/// An angle of which twice the cosine is given, rounded down to some digits: a level that is asked for.
fn rounded_degrees(twice_cosine: &RealAlgebraic) -> Rational {
    let (low, high) = twice_cosine.refined_to_digits(2 * FACTOR_DIGITS).enclosure();
    let degrees = Level::PhaseMargin.enclosure(&Enclosure::new(low, high), 2 * TURN_BITS).expect("an angle is finite");
    let unit = Rational::from(10).pow(-ANGLE_DIGITS).expect("ten is not zero");
    rounded_down(degrees.lower(), &unit)
}

/// A wider pair of numbers. The given numbers enclose the tangent `t` of half an angle. The wider pair encloses this tangent for all angles close by: the
/// tangent changes by half of `1 + t^2` times the change of the angle.
fn around_rounded([below, above]: [Rational; 2]) -> [Rational; 2] {
    let by = |t: &Rational| (t * t + Rational::ONE) * Rational::dyadic(&1.into(), NEAR_BITS);
    let (less, more) = (&below - &by(&below), &above + &by(&above));
    [if less.sign().is_gt() { less } else { below * Rational::dyadic(&1.into(), 1) }, more]
}

fn rounded_down(x: &Rational, unit: &Rational) -> Rational {
    &Rational::from((x / unit).floor()) * unit
}
