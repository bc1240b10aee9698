//! How answers are found, for `--explain` and the documentation.

/// A way to an answer.
///
/// ```
/// use jurist_engine::coverage::{Asked, CoefficientRing};
/// let method = Asked::Intervals.over(CoefficientRing::Rational).method().unwrap();
/// assert_eq!(method.name, "zeros of boundary polynomials");
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Method {
    /// Its name.
    pub name: &'static str,
    /// Why its answer is right, in one or two sentences.
    pub how: &'static str,
    /// Where it is in the code, below `jurist_engine`.
    pub place: &'static str,
}

impl Method {
    const fn new(name: &'static str, how: &'static str, place: &'static str) -> Method {
        Method { name, how, place }
    }
}

pub(super) static COUNT: Method = Method::new(
    "root count of the half-size pair",
    "Enclosures of the closed loop count the roots where none can be on the boundary; else a remainder sequence of the half-size pair counts them exactly.",
    "stability::count_roots",
);
pub(super) static ENCLOSED_COUNT: Method = Method::new(
    "root count with enclosed constants",
    "The constants are enclosed with more bits until every sign of the remainder sequence is certain; only an identity in symbols proves a zero.",
    "stability::SymbolicPolynomial::at",
);
pub(super) static DISCS: Method = Method::new(
    "discs around approximations",
    "The iteration of Aberth and Ehrlich gives approximations of all roots. Discs around them are proved to hold the roots (Smith); with more bits they are apart and small. Multiplicities of a rational loop come from its square-free factors.",
    "answer::roots",
);
pub(super) static RIGHTMOST: Method = Method::new(
    "discs right of a line",
    "There are infinitely many roots. Newton's method gives approximations of the rightmost ones, discs around them are proved to hold one root each (Rouché), and a count of the argument's quarter turns along a line shows that no other root is right of it.",
    "stability::dead_time::rightmost_roots",
);
pub(super) static ARGUMENT: Method = Method::new(
    "argument principle along the imaginary axis",
    "The argument of the characteristic function turns by a quarter for each root left of the axis; the turns are counted between certified frequencies (Mikhailov).",
    "stability::dead_time::count_delayed_roots",
);
pub(super) static ENCLOSED_ARGUMENT: Method = Method::new(
    "argument principle with enclosed constants",
    "The turns are counted with rational numbers beside the constants. No root is on the axis for any constants within their bounds: so the count is that of the constants themselves.",
    "stability::dead_time::FamilyLoop::count",
);
pub(super) static ZEROS: Method = Method::new(
    "zeros of boundary polynomials",
    "The number of stable roots changes only at real zeros of D(1), D(-1) (or D(0)), of the resultant of the half-size pair, where the degree is lost, and at poles. They are isolated exactly, and one rational number between two neighbours is decided.",
    "stability::stable_set",
);
pub(super) static ENCLOSED_ZEROS: Method = Method::new(
    "zeros of boundary polynomials over constants",
    "The same boundary polynomials with enclosed coefficients: each zero is bracketed where a derivative keeps its sign, and one rational number between two neighbours is decided.",
    "stability::symbolic_stable_set",
);
pub(super) static FUNCTION_ZEROS: Method = Method::new(
    "zeros of boundary functions",
    "The boundary functions have functions of the parameter as coefficients. Taylor models enclose them on pieces of the domain. Each piece is halved until it has at most one zero; a piece that stays open is an undecided bracket.",
    "stability::symbolic_stable_set",
);
pub(super) static CROSSINGS: Method = Method::new(
    "crossings of the imaginary axis",
    "Of a free dead time all crossings are algebraic and repeat, so all windows follow by addition (Walton and Marshall). Of another parameter, values with a root on the axis are zeros of one function of the frequency, isolated with proved bounds; a count between two neighbours decides the gap.",
    "stability::dead_time",
);
pub(super) static ENCLOSED_CROSSINGS: Method = Method::new(
    "crossings of the imaginary axis with enclosed constants",
    "Roots on the axis are zeros of one complex function of the frequency and the parameter. Newton's method isolates them with bounds of the constants, which get narrower as digits are asked for; a count between two neighbours decides the gap.",
    "stability::dead_time::family_cells",
);
pub(super) static FUNCTION_CROSSINGS: Method = Method::new(
    "crossings of the imaginary axis on pieces of the domain",
    "On short pieces of the domain Taylor polynomials with bounds of their rests stand for the functions. On each piece roots on the axis are isolated as beside enclosed constants, and counts between two neighbours decide the gaps.",
    "stability::dead_time::MovingLoop",
);
pub(super) static SAMPLES: Method = Method::new(
    "one order after another",
    "The domain is divided where the dead time is a whole number of samples; between two such values the order is fixed, and the loop is one with functions of the parameter.",
    "problem::Problem::stable_set_by_samples",
);
pub(super) static SAMPLE_BOXES: Method = Method::new(
    "boxes of one order after another",
    "The window is divided where the dead time is a whole number of samples; between two such lines the order is fixed, and the part is cut into boxes as that of a loop with functions of the parameters.",
    "answer::Problem::map_by",
);
pub(super) static TABLE: Method = Method::new(
    "Jury's or Routh's table",
    "The classical table, and its conditions solved; the answer is compared with the zeros of the boundary polynomials.",
    "stability::classical_test",
);
pub(super) static ENCLOSED_TABLE: Method = Method::new(
    "Jury's or Routh's table over constants",
    "The classical table with enclosed entries; the answer is compared with the zeros of the boundary polynomials.",
    "stability::SymbolicPolynomial::classical_test",
);
pub(super) static DECOMPOSITION: Method = Method::new(
    "cylindrical decomposition of the plane",
    "The plane is cut at the critical values of the boundary curves (Collins, McCallum), and one rational point of each cell is decided.",
    "stability::plane::stability_map",
);
pub(super) static PLANE_BOXES: Method = Method::new(
    "boxes by Bernstein coefficients",
    "A box that no boundary curve meets has one number of roots outside, counted at its middle; Bernstein coefficients, enclosed where there are constants, show that a curve does not meet it (Zettler and Garloff). Others are halved.",
    "answer::Problem::map_by",
);
pub(super) static FUNCTION_BOXES: Method = Method::new(
    "boxes by Taylor models",
    "Functions of the parameters are enclosed by Taylor models in each box; one that no boundary function meets has one number of roots outside. Others are halved.",
    "stability::boxes::MovingPolynomial",
);
pub(super) static DELAYED_BOXES: Method = Method::new(
    "boxes by argument counts",
    "The characteristic function is walked along the imaginary axis for all points of a box at once: where it cannot vanish, the turns of its argument count the roots of all of them. Other boxes are halved.",
    "stability::dead_time::PlaneLoop::boxes",
);
pub(super) static DELAYED_FAMILY_BOXES: Method = Method::new(
    "boxes by Bernstein tensors with Taylor models of the delays",
    "A box whose corners have one number of roots right of the axis is cut in frequency and parameters, beside which constants are as wide as their bounds: where no root is on the axis, all points have that number. Other boxes are halved.",
    "stability::boxes::DelayedFunction::boxes",
);
pub(super) static TENSOR: Method = Method::new(
    "Bernstein tensor in frequency and parameters",
    "The polynomial on the boundary is a pair of polynomials in frequency and parameters. Their tensor of Bernstein coefficients is halved until zero lies outside of each cell: no root crosses anywhere in the box.",
    "stability::boxes::ToleranceProblem",
);
pub(super) static FUNCTION_TENSOR: Method = Method::new(
    "Bernstein tensor with Taylor models",
    "As the Bernstein tensor. In each part of the box a Taylor model encloses each function of the parameters; the tensor takes its polynomial and a bound of its rest. One name alone is decided by its stable set.",
    "stability::boxes::MovingPolynomial",
);
pub(super) static DELAYED_TENSOR: Method = Method::new(
    "Bernstein tensor with Taylor models of the delays",
    "The box is cut in frequency and parameters; exp(-i w tau) is a Taylor model in both, and beyond a bound of the frequency no root is on the axis. One name alone is decided by its stable set.",
    "stability::boxes::DelayedFunction",
);
pub(super) static REQUIRED_BOXES: Method = Method::new(
    "pieces of the circle by Taylor models in the parameters",
    "Taylor models of the open loop's coefficients in a box of the parameters tell on which pieces of the frequency a crossing may be, and whether the \
     requirement allows it there. A box where all are allowed meets the requirement, one where a sign changes among forbidden ones does not; others are halved.",
    "answer::MapBoxes",
);
pub(super) static SPIRAL_BOXES: Method = Method::new(
    "arcs of the spiral by Taylor models in the parameters",
    "The damping of a discrete loop asks for roots inside of a logarithmic spiral. On arcs of it the characteristic polynomial keeps to half planes for all points      of a box: then all have as many roots inside, which one point tells. Other boxes are halved.",
    "answer::MapBoxes",
);
pub(super) static DELAYED_REQUIRED: Method = Method::new(
    "pieces of the imaginary axis by Taylor models in the parameters",
    "Taylor models of the coefficients of the open loop's rational factor in a box of the parameters, times the cosine and the sine of the dead time: cubics \
     with a bound on each piece of the frequency, any numbers from -1 to 1 where the open loop is small. They tell on which pieces a crossing may be, and \
     whether the requirement allows it there.",
    "answer::MapBoxes",
);
pub(super) static BORNE: Method = Method::new(
    "crossings with all of the dead time",
    "A delay margin begins or ceases to be met where the loop with the whole dead time has a root on the axis, or where the modulus of the open loop touches \
     one, at some frequency or in the limit of high ones. Between two such values a first crossing is compared with the dead time.",
    "problem::Problem::required_set",
);
pub(super) static BORNE_SAMPLES: Method = Method::new(
    "the loop with one sample more, with two, and so on",
    "Each number of whole samples makes a loop, whose stable set is found as any other; all of them have to be stable. Dead time at the input of the only plant \
     behind a hold is one parameter more of boxes, from one sample to the next.",
    "problem::Problem::required_set",
);
pub(super) static BORNE_BOXES: Method = Method::new(
    "boxes with the delay as one parameter more",
    "A box meets a delay margin where the loop is stable with all less delay, which is one parameter more. It does not where one delay is found with \
     which none of its points is stable. Others are halved.",
    "answer::MapBoxes",
);
pub(super) static BORNE_TENSOR: Method = Method::new(
    "tolerances with the delay as one side more",
    "The loop with a delay at the cut is asked over the box with one side more, which holds all delays up to the one that is required. A point that is not \
     stable with one of them is confirmed by its first crossing.",
    "stability::boxes::ToleranceProblem",
);
pub(super) static POLYNOMIAL: Method = Method::new(
    "characteristic polynomial",
    "The determinant of the closed loop by the multimodular Hessenberg form; constants and functions that are not rational are further variables.",
    "problem::Problem::algebra_over_symbols",
);
pub(super) static DIFFERENCES: Method = Method::new(
    "implicit derivatives of the limits",
    "Each limit is a zero of a boundary polynomial; its derivative by another name is a quotient of partial derivatives there.",
    "answer::Sensitivities",
);
pub(super) static IMPULSES: Method = Method::new(
    "sum of the absolute impulse response",
    "Samples are computed in fixed point, with a proved bound of all errors. A power of the companion matrix has a norm below a half, which bounds what follows after a block of samples. Where the signs of all samples are proved the sum is a rational number.",
    "stability::ImpulseResponse",
);
pub(super) static ENCLOSED_IMPULSES: Method = Method::new(
    "sum of the absolute impulse response with enclosed coefficients",
    "Samples are computed in fixed point from coefficients that are enclosed with more bits until the digits are certain; the bound of all errors has theirs. A power of the companion matrix has a norm below a half, which bounds what follows after a block of samples.",
    "stability::ImpulseResponse",
);
pub(super) static RESPONSE: Method = Method::new(
    "integral of the absolute impulse response",
    "The response and its derivatives are followed in short steps, in fixed point with a proved bound of all errors. Where Taylor's polynomial and its rest show one sign, the integral is a difference of the step response; other pieces are halved. A power of the step has a norm below a half, which bounds what follows.",
    "stability::ImpulseResponse",
);
pub(super) static PEAKS: Method = Method::new(
    "greatest modulus on the boundary",
    "The square of the modulus is a rational function of the half-size variable; the zeros of its derivative are isolated exactly or with enclosed constants, and the greatest of its values is taken.",
    "response::Norm",
);
pub(super) static DELAYED_PEAKS: Method = Method::new(
    "greatest modulus on the axis with dead time",
    "The square of the modulus is a function of the frequency, its cosine and its sine times the dead time; the zeros of its slope are isolated with enclosures up to a frequency beyond which a bound shows the modulus to be smaller.",
    "response::Norm",
);
pub(super) static FREQUENCIES: Method = Method::new(
    "crossings of the open loop",
    "Frequencies at which the open loop has modulus one, is real, or is nearest to -1 are real zeros of polynomials in the half-size variable, isolated exactly or with enclosed constants.",
    "response::Margins",
);
pub(super) static RESULTANTS: Method = Method::new(
    "resultants of the open loop with the requirement",
    "A requirement begins or ceases to be met where a resultant in the free names vanishes; one rational point between is decided.",
    "problem::Problem::required_set",
);
pub(super) static ENCLOSED_RESULTANTS: Method = Method::new(
    "enclosed resultants of the open loop with the requirement",
    "The same resultants, enclosed and not expanded; what they leave open stays as a bracket.",
    "problem::Problem::required_set",
);
pub(super) static ROOTS: Method = Method::new(
    "roots on the edge of the required region",
    "The damping of a discrete loop asks for roots inside of a spiral: turns of the argument along it count them for all values of short intervals at once. \
     Other regions are brought back to the disc or the half plane, where boundary polynomials tell.",
    "problem::Problem::required_set",
);
pub(super) static FLOATING: Method = Method::new(
    "floating point",
    "A picture or a course of signals, rounded; crossings and margins that are marked on it are exact.",
    "jurist_draw",
);
pub(super) static SEVERAL: Method = Method::new(
    "several questions",
    "Each part is a question of its own; a part that is refused or undecided says so.",
    "answer::Analysis",
);
pub(super) static WITNESSES: Method = Method::new(
    "a certificate of the answer",
    "The zeros, counts and cells that decided the answer are written down; checkers that share no code with the engine read the model themselves and test them.",
    "prove",
);
