//! Certificates of maps by boxes: the statement around a tree of boxes.

use super::statement::{about_at_rates, number, object, region, set};
use super::text::to_text;
use super::{refuse_free_bound, refuse_requirements};
use jurist_algebra::number::Rational;
use jurist_engine::problem::Problem;
use jurist_model::error::Error;
use jurist_stability::plane::boxes::Window;

/// The schema of certificates of maps by boxes.
const SCHEMA: &str = "jurist/certificate/7";

/// A certificate that says of a window what a tree says of its boxes; the checkers show each of them by Taylor models of a total degree
/// `order`, in fixed point with so many bits. It proves nothing where the tree says more than they see: who makes one asks
/// `jurist_check::BoxJudge`. [`certify_boxes`](crate::certified::certify_boxes) does that.
///
/// `x` and `y` halve a box in one parameter, the lower half follows first; `+` and `-` are boxes that are stable everywhere and nowhere,
/// `?` says nothing.
///
/// Cost: that of writing it.
///
/// ```
/// use jurist_check::{Limits, check};
/// use jurist_model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_stability::Range;
/// use jurist_stability::plane::boxes::Window;
/// use jurist_prove::boxes_certificate;
/// let drive = Model::drive();
/// let side = |low: &str, high: &str| Range::between(low.parse().ok(), high.parse().ok());
/// let window = Window::new(&side("1/12000", "1/10000"), &side("100", "110")).unwrap();
/// let problem = drive.ask().free("T").free("K_pwm").plane_problem()?;
/// let certificate = |tree: &str| boxes_certificate(&problem, &window, tree, 6, 256).unwrap();
/// let proves = |tree: &str| check(&drive.source().text, &certificate(tree), &Limits::default()).is_ok();
/// assert!(proves("y++") && proves("x?+") && !proves("-") && !proves("x+-"));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] (`E-no-certificate`) for models with requirements, and a region whose bound is free.
///
/// # Panics
/// Unless two parameters are free.
pub fn boxes_certificate(
    problem: &Problem,
    window: &Window,
    tree: &str,
    order: usize,
    bits: usize,
) -> Result<String, Error> {
    refuse_requirements(problem)?;
    refuse_free_bound(problem)?;
    let [x, y] = problem.free() else { panic!("a map is of two parameters") };
    let side = |ends: &[Rational; 2]| ends.iter().map(number).collect();
    let statement = object([
        ("kind", "boxes".into()),
        ("time", problem.time().name().into()),
        ("x", x.name.as_str().into()),
        ("y", y.name.as_str().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("window", object([("x", side(&window.x)), ("y", side(&window.y))])),
        ("tree", tree.into()),
    ]);
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about_at_rates(problem)?),
        ("statement", statement),
        ("order", order.into()),
        ("bits", bits.into()),
    ])))
}
