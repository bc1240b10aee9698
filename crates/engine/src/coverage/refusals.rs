//! The refusals of the table: each with its code, its words, and what to ask instead.

use crate::error::{Code, Refusal};
pub(super) use crate::model::NO_FIXED_ORDER;

const KNOWN: &str = "what can be asked of it: {known}";
const AT_A_POINT: &str = "ask 'verdict' with a value for every parameter";
const OTHER_CERTIFICATES: &str = "known: loops behind a hold, or with prewarp, at times that are rational numbers, the dead time of a loop with one, a gain beside a fixed one; the answer is printed without it";
const CERTIFIED_MAPS: &str = "exact maps have one where the loop is rational, the bound of its region a number, and stability all that is asked; with constants that are not rational maps by boxes have one: --method boxes";

/// Refuses a question that the program cannot answer for a loop with complex coefficients.
pub(crate) static COMPLEX: Refusal = Refusal::new(
    Code::Complex,
    "this cannot be asked of a loop with complex coefficients",
    "what can be asked of it: {known}, and test and check; in real form, with two signals for each complex one, it can be asked everything",
);
pub(crate) static COMPLEX_REQUIRED: Refusal = Refusal::new(
    Code::Complex,
    "requirements over boxes of values are not known of loops with complex coefficients",
    "of one parameter they are ('intervals --param NAME', a tolerance of one name), and at a point ('verdict'); stability alone has maps and tolerances ('--no-require'); in real form, with two signals for each complex one, the loop has all of them",
);
pub(crate) static COMPLEX_DELAY_MARGIN: Refusal = Refusal::new(
    Code::Complex,
    "a delay margin over values of a parameter is not known of loops with complex coefficients",
    "'jurist verdict' with '--set' decides the delay margin at one point; or write exp(-x*s) at the cut, and 'intervals --param x' finds the dead times x for which the loop is stable",
);
pub(crate) static COMPLEX_REQUIRED_WITH_DELAY: Refusal = Refusal::new(
    Code::Complex,
    "requirements over values of this parameter are not known: they are where one factor of the open loop has the dead time, and numerator and denominator beside it have the parameter to the first power at most",
    "at one point they are: 'jurist verdict' with '--set'; stability alone has a set ('--no-require')",
);
pub(crate) static COMPLEX_FOR_ALL: Refusal = Refusal::new(
    Code::Complex,
    "a map for all values of other names is not known of loops with complex coefficients",
    "'tolerance' proves a box around one point; in real form, with two signals for each complex one, the loop has such a map",
);
pub(crate) static COMPLEX_FACTORS: Refusal = Refusal::new(
    Code::Complex,
    "the greatest stable factor of this loop with complex coefficients and dead time is not found: the modulus of its open loop does not go to 0",
    "ask 'verdict' with further values of a gain; the peak of the complementary sensitivity is a 'norm'",
);
pub(crate) static DEAD_TIME: Refusal =
    Refusal::new(Code::DeadTime, "this cannot be asked of a loop with dead time", KNOWN);
pub(crate) static BESIDE_DEAD_TIME: Refusal = Refusal::new(
    Code::DeadTime,
    "beside dead time the loop contains functions or constants that are not rational: this cannot be asked of it",
    "'intervals' is known of one parameter; else write the values of exp, sqrt, sin, cos, tan and pi as numbers",
);
pub(crate) static ADVANCED: Refusal = Refusal::new(
    Code::DeadTime,
    "infinitely many roots lie right of any line: the highest power of s has no part without delay",
    "no such loop is stable: look for a transfer function with dead time that has more zeros than poles",
);
pub(crate) static FUNCTIONS: Refusal = Refusal::new(
    Code::Function,
    "this question is answered for rational loops only, and this loop has functions, as behind a hold",
    "what can be asked of it: {known}; it contains {symbols}",
);
pub(crate) static INSIDE: Refusal = Refusal::new(
    Code::Function,
    "'{name}' is inside of functions, as behind a hold: there is no exact map",
    "maps with '{name}' are made of boxes: '--method boxes' with windows of both axes",
);
pub(crate) static ONE_FACTOR: Refusal = Refusal::new(
    Code::DeadTime,
    "with dead time this is known where one factor of the open loop has it, and all else is rational",
    "the gain margin is the limit of a gain: 'jurist intervals --param GAIN'",
);
pub(crate) static NO_DAMPING: Refusal = Refusal::new(
    Code::DeadTime,
    "no loop with dead time has a damping: it has infinitely many roots, and theirs goes to 0",
    "ask for '--settling-time' or a decay rate, or read the damping of the rightmost roots in 'jurist roots'",
);
pub(crate) static DECAY: Refusal = Refusal::new(
    Code::DeadTime,
    "a decay rate cannot be asked of {what} in a loop with dead time",
    "ask for one parameter: 'intervals --param NAME --decay S'",
);
const ONE_SLICE: &str = "boxes decide one slice at a time, with windows of both axes: '{slice}'";
pub(crate) static SLICES: Refusal = Refusal::new(
    Code::Function,
    "slices are exact maps, and a parameter is inside of functions of this loop, as behind a hold",
    ONE_SLICE,
);
pub(crate) static SLICES_WITH_DEAD_TIME: Refusal =
    Refusal::new(Code::DeadTime, "slices are exact maps, and this loop has dead time", ONE_SLICE);
pub(crate) static SLICES_ARE_OF_STABILITY: Refusal = Refusal::new(
    Code::Require,
    "the slices of '-z' are of stability alone, without '{option}'",
    "leave out '-z' and give its parameter one value with '--set'",
);
pub(crate) static MARGINS_IN_ONE: Refusal = Refusal::new(
    Code::Require,
    "of this loop requirements on margins are decided in one parameter only",
    "ask 'intervals' for one of the parameters, or 'margins' with a value for each",
);
pub(crate) static DELAY_BESIDE: Refusal = Refusal::new(
    Code::Require,
    "a delay margin of a continuous loop is decided at points only where a free name is inside of a function that is not rational",
    "give that name a value, or ask 'verdict' with a value for every parameter",
);
pub(crate) static DELAY_OF_NUMBERS: Refusal = Refusal::new(
    Code::Require,
    "a delay margin of a discrete loop is decided over values of names that are not in its sample time, or in the dead time behind its hold",
    AT_A_POINT,
);
pub(crate) static NO_SAMPLE_TIME: Refusal = Refusal::new(
    Code::Require,
    "a delay margin of a discrete loop needs its sample time",
    "give the model a 'sample_time': the margin is in its unit",
);
pub(crate) static MANY_SAMPLES: Refusal = Refusal::new(
    Code::Require,
    "a delay margin of more than {most} samples of this loop is not decided over values of parameters",
    "where the delay is not dead time behind a hold, 'verdict' decides it with a value for every parameter",
);
pub(crate) static MANY_HELD_SAMPLES: Refusal = Refusal::new(
    Code::Require,
    "a delay margin of more than {most} samples at the input of a plant behind a hold is not decided",
    "'jurist margins' says how many whole samples the loop bears; the delays between them are not looked at",
);
pub(crate) static NOT_IN_A_PLANE: Refusal =
    Refusal::new(Code::Require, "the requirement {name} is not decided for two parameters", "{help}");
pub(crate) static NOT_FOR_ALL: Refusal = Refusal::new(
    Code::Require,
    "the requirement {name} is not decided for all values of other names",
    "ask 'verdict' with a value for every parameter; phase, gain, modulus, disk and delay margins and the peak of T are decided for all values",
);
pub(crate) static NOT_OVER_A_BOX: Refusal =
    Refusal::new(Code::Require, "the requirement {name} is not decided over a box of tolerances", "{help}");
/// Statements for solvers are made of algebraic numbers.
pub static NOT_ALGEBRAIC: Refusal =
    Refusal::new(Code::NoCertificate, "{what}: the limits are not algebraic numbers", OTHER_CERTIFICATES);
/// There is no certificate of this answer.
pub static NO_CERTIFICATE: Refusal = Refusal::new(Code::NoCertificate, "no certificate{of}: {why}", OTHER_CERTIFICATES);
/// The checkers do not know this requirement.
pub static REQUIREMENT_NOT_CERTIFIED: Refusal = Refusal::new(
    Code::NoCertificate,
    "no certificate of '{asked}': the checkers know margins that are stability for all factors at a cut of the loop",
    "phase, gain, modulus and disk margins and the peak of T are such, at a signal or a block, in continuous time delay margins, too, and dampings; the answer is printed without '--certificate'",
);
/// The checkers do not know disk margins from 2 on.
pub static WIDE_DISK: Refusal = Refusal::new(
    Code::NoCertificate,
    "no certificate of '{asked}': the checkers know disk margins below 2, whose factors fill a disc; from 2 on they fill a half plane",
    "the answer is printed without '--certificate'",
);
/// An exact map has a certificate where its constants are rational.
pub static MAP_OF_CONSTANTS: Refusal = Refusal::new(
    Code::NoCertificate,
    "no certificate of a map: the loop has constants that are not rational",
    CERTIFIED_MAPS,
);
/// An exact map of a loop with dead time has no certificate.
pub static MAP_WITH_DEAD_TIME: Refusal =
    Refusal::new(Code::NoCertificate, "no certificate of a map: the loop has dead time", CERTIFIED_MAPS);
/// Theorems for Coq are about rational loops.
pub static NOT_FOR_COQ: Refusal =
    Refusal::new(Code::Coq, "no file for Coq: the loop is not rational, it contains {what}", "take '--certificate'");
