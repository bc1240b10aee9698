//! The table itself.

use super::Coverage::{Answered as A, ByBoxes as B, InPart as P, Refused as R};
use super::method::*;
use super::refusals::*;
use super::{Asked, Coverage};
use crate::model::Time;

/// A row of the table.
///
/// ```
/// use jurist_engine::coverage::rows;
/// assert!(rows().iter().any(|row| row.command == "jury --param NAME"));
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Row {
    /// The question.
    pub asked: Asked,
    /// How the program is asked, without the model; `..` stands for further options.
    pub command: &'static str,
    /// The kind of time that it is asked in; `None` for either.
    pub time: Option<Time>,
    /// What it is called among the questions that a loop can be asked; `None` where it is no command of its own.
    pub phrase: Option<&'static str>,
    /// What becomes of it over each ring, in the order of [`CoefficientRing::ALL`](super::CoefficientRing::ALL).
    pub coverage: [Coverage; 7],
}

impl Row {
    const fn new(asked: Asked, command: &'static str, coverage: [Coverage; 7]) -> Row {
        Row { asked, command, time: None, phrase: None, coverage }
    }

    const fn called(self, phrase: &'static str) -> Row {
        Row { phrase: Some(phrase), ..self }
    }

    const fn in_time(self, time: Time) -> Row {
        Row { time: Some(time), ..self }
    }
}

/// A row about a point: what depends on a parameter is a constant there.
const fn at_a_point(asked: Asked, command: &'static str, [rational, constants, delay, beside]: [Coverage; 4]) -> Row {
    Row::new(asked, command, [rational, constants, constants, delay, beside, beside, constants])
}

/// The whole table, in the order of [`Asked::ALL`].
pub fn rows() -> &'static [Row] {
    ROWS
}

const BESIDE: Coverage = R(&BESIDE_DEAD_TIME);
const NO_ORDER: Coverage = R(&NO_FIXED_ORDER);
const NO_DELAY: Coverage = R(&DEAD_TIME);
const UNDAMPED: Coverage = R(&NO_DAMPING);
const NO_FUNCTIONS: Coverage = R(&FUNCTIONS);

/// The refusals of certificates and proofs over what is not rational are of the same kind everywhere.
const NO_COQ: Coverage = R(&NOT_FOR_COQ);
const NO_SMT: Coverage = R(&NOT_ALGEBRAIC);
const OPEN_LOOP: Coverage = P(&FREQUENCIES, &ONE_FACTOR);
const BOXES_WITH_DEAD_TIME: Coverage = P(&DELAYED_REQUIRED, &ONE_FACTOR);
const CERTIFIED: Coverage = P(&WITNESSES, &NO_CERTIFICATE);

#[rustfmt::skip]
static ROWS: &[Row] = &[
    at_a_point(Asked::Verdict, "verdict", [A(&COUNT), A(&ENCLOSED_COUNT), A(&ARGUMENT), A(&ENCLOSED_ARGUMENT)]).called("verdict"),
    Row::new(Asked::Intervals, "intervals --param NAME", [A(&ZEROS), A(&ENCLOSED_ZEROS), A(&FUNCTION_ZEROS), A(&CROSSINGS), A(&ENCLOSED_CROSSINGS), A(&FUNCTION_CROSSINGS), A(&SAMPLES)])
        .called("intervals of one parameter"),
    Row::new(Asked::Analyze, "analyze", [A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL)]).called("analyze"),
    Row::new(Asked::Charpoly, "charpoly", [A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), NO_ORDER]).called("charpoly"),
    at_a_point(Asked::Margins, "margins", [A(&FREQUENCIES), A(&FREQUENCIES), OPEN_LOOP, OPEN_LOOP]).called("margins"),
    at_a_point(Asked::Norm, "norm", [A(&PEAKS), A(&PEAKS), A(&DELAYED_PEAKS), A(&DELAYED_PEAKS)]).called("norm"),
    at_a_point(Asked::PeakToPeak, "norm --l1", [A(&IMPULSES), A(&ENCLOSED_IMPULSES), NO_DELAY, NO_DELAY]).in_time(Time::Discrete),
    at_a_point(Asked::PeakToPeakContinuous, "norm --l1", [A(&RESPONSE), A(&RESPONSE), NO_DELAY, NO_DELAY]).in_time(Time::Continuous),
    at_a_point(Asked::Bode, "bode", [A(&FREQUENCIES), A(&FREQUENCIES), OPEN_LOOP, OPEN_LOOP]).called("bode"),
    at_a_point(Asked::Nyquist, "nyquist", [A(&FREQUENCIES), A(&FREQUENCIES), OPEN_LOOP, OPEN_LOOP]).called("nyquist"),
    at_a_point(Asked::Simulate, "simulate", [A(&FLOATING), A(&FLOATING), A(&FLOATING), A(&FLOATING)]).called("simulate"),
    Row::new(Asked::Locus, "locus --param NAME", [A(&FLOATING), A(&FLOATING), A(&FLOATING), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).called("locus"),
    Row::new(Asked::Map, "map -x NAME -y NAME", [A(&DECOMPOSITION), A(&DECOMPOSITION), B(&FUNCTION_BOXES), B(&DELAYED_BOXES), B(&DELAYED_FAMILY_BOXES), BESIDE, B(&SAMPLE_BOXES)]).called("map"),
    Row::new(Asked::Tolerance, "tolerance --tol NAME=10%", [A(&TENSOR), A(&TENSOR), A(&FUNCTION_TENSOR), A(&DELAYED_TENSOR), A(&DELAYED_TENSOR), BESIDE, NO_ORDER]).called("tolerance"),
    at_a_point(Asked::Roots, "roots", [A(&DISCS), A(&DISCS), P(&RIGHTMOST, &ADVANCED), A(&RIGHTMOST)]).called("roots"),
    at_a_point(Asked::Jury, "jury", [A(&TABLE), A(&ENCLOSED_TABLE), NO_DELAY, NO_DELAY]).called("jury at a point"),
    Row::new(Asked::JuryInParameter, "jury --param NAME", [A(&TABLE), A(&ENCLOSED_TABLE), NO_FUNCTIONS, NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).called("jury in one parameter"),
    Row::new(Asked::Report, "report", [A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL), A(&SEVERAL)]).called("report"),
    Row::new(Asked::ExactMap, "map -x NAME -y NAME --method exact", [A(&DECOMPOSITION), A(&DECOMPOSITION), R(&INSIDE), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]),
    Row::new(Asked::BoxMap, "map -x NAME -y NAME --method boxes", [B(&PLANE_BOXES), B(&PLANE_BOXES), B(&FUNCTION_BOXES), B(&DELAYED_BOXES), B(&DELAYED_FAMILY_BOXES), BESIDE, B(&SAMPLE_BOXES)]),
    Row::new(Asked::Slices, "map -x NAME -y NAME -z NAME=LO..HI:N", [A(&DECOMPOSITION), A(&DECOMPOSITION), R(&SLICES), R(&SLICES_WITH_DEAD_TIME), R(&SLICES_WITH_DEAD_TIME), NO_DELAY, R(&SLICES)]),
    Row::new(Asked::Sensitivity, "intervals --param NAME --sensitivity", [A(&DIFFERENCES), A(&DIFFERENCES), A(&DIFFERENCES), A(&DIFFERENCES), A(&DIFFERENCES), A(&DIFFERENCES), A(&DIFFERENCES)]),
    Row::new(Asked::RootLocusForm, "charpoly --root-locus-form NAME", [A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), NO_ORDER]),
    Row::new(Asked::Transfer, "charpoly --transfer INPUT OUTPUT", [A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), A(&POLYNOMIAL), NO_ORDER]),
    Row::new(Asked::ToleranceLimit, "tolerance --tol NAME=10% --limit NAME", [A(&TENSOR), A(&TENSOR), A(&FUNCTION_TENSOR), A(&DELAYED_TENSOR), A(&DELAYED_TENSOR), BESIDE, NO_ORDER]),
    Row::new(Asked::ToleranceExact, "tolerance --tol NAME=10% --exact", [A(&TENSOR), A(&TENSOR), A(&FUNCTION_TENSOR), A(&DELAYED_TENSOR), A(&DELAYED_TENSOR), BESIDE, NO_ORDER]),
    Row::new(Asked::ToleranceVolume, "tolerance --tol NAME=10% --volume", [A(&TENSOR), A(&TENSOR), A(&FUNCTION_TENSOR), A(&DELAYED_TENSOR), A(&DELAYED_TENSOR), BESIDE, NO_ORDER]),
    at_a_point(Asked::VerdictInRegion, "verdict REGION", [A(&COUNT), A(&ENCLOSED_COUNT), A(&ARGUMENT), A(&ENCLOSED_ARGUMENT)]),
    Row::new(Asked::IntervalsInRegion, "intervals --param NAME REGION", [A(&ZEROS), A(&ENCLOSED_ZEROS), A(&FUNCTION_ZEROS), A(&CROSSINGS), A(&ENCLOSED_CROSSINGS), A(&FUNCTION_CROSSINGS), A(&SAMPLES)]),
    at_a_point(Asked::RegionBound, "intervals --param BOUND", [A(&ZEROS), A(&ENCLOSED_ZEROS), A(&CROSSINGS), A(&ENCLOSED_CROSSINGS)]),
    Row::new(Asked::MapInRegion, "map -x NAME -y NAME REGION", [A(&DECOMPOSITION), A(&DECOMPOSITION), B(&FUNCTION_BOXES), P(&DELAYED_BOXES, &DECAY), P(&DELAYED_FAMILY_BOXES, &DECAY), BESIDE, B(&SAMPLE_BOXES)]),
    Row::new(Asked::ToleranceInRegion, "tolerance --tol NAME=10% REGION", [A(&TENSOR), A(&TENSOR), A(&FUNCTION_TENSOR), P(&DELAYED_TENSOR, &DECAY), P(&DELAYED_TENSOR, &DECAY), BESIDE, NO_ORDER]),
    at_a_point(Asked::VerdictWithMargins, "verdict --modulus-margin 1/100", [A(&FREQUENCIES), A(&FREQUENCIES), OPEN_LOOP, OPEN_LOOP]),
    Row::new(Asked::IntervalsWithMargins, "intervals --param NAME --modulus-margin 1/100", [A(&RESULTANTS), A(&ENCLOSED_RESULTANTS), A(&ENCLOSED_RESULTANTS), BOXES_WITH_DEAD_TIME, BOXES_WITH_DEAD_TIME, BOXES_WITH_DEAD_TIME, NO_ORDER]),
    Row::new(Asked::MapWithMargins, "map -x NAME -y NAME --modulus-margin 1/100", [A(&RESULTANTS), A(&RESULTANTS), B(&REQUIRED_BOXES), BOXES_WITH_DEAD_TIME, BOXES_WITH_DEAD_TIME, BESIDE, NO_ORDER]),
    Row::new(Asked::ToleranceWithMargins, "tolerance --tol NAME=10% --modulus-margin 1/100", [A(&TENSOR), A(&TENSOR), A(&REQUIRED_BOXES), BOXES_WITH_DEAD_TIME, BOXES_WITH_DEAD_TIME, BESIDE, NO_ORDER]),
    at_a_point(Asked::VerdictWithDamping, "verdict --damping 1/10", [A(&ROOTS), A(&ROOTS), UNDAMPED, UNDAMPED]),
    Row::new(Asked::IntervalsWithDamping, "intervals --param NAME --damping 1/10", [A(&ROOTS), A(&ROOTS), A(&ROOTS), UNDAMPED, UNDAMPED, UNDAMPED, NO_ORDER]),
    Row::new(Asked::MapWithDamping, "map -x NAME -y NAME --damping 1/10", [A(&RESULTANTS), A(&RESULTANTS), B(&REQUIRED_BOXES), UNDAMPED, UNDAMPED, UNDAMPED, NO_ORDER]).in_time(Time::Continuous),
    Row::new(Asked::MapWithDampingDiscrete, "map -x NAME -y NAME --damping 1/10", [B(&SPIRAL_BOXES), B(&SPIRAL_BOXES), B(&SPIRAL_BOXES), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).in_time(Time::Discrete),
    Row::new(Asked::ToleranceWithDamping, "tolerance --tol NAME=10% --damping 1/10", [A(&TENSOR), A(&TENSOR), A(&REQUIRED_BOXES), UNDAMPED, UNDAMPED, UNDAMPED, NO_ORDER]).in_time(Time::Continuous),
    Row::new(Asked::ToleranceWithDampingDiscrete, "tolerance --tol NAME=10% --damping 1/10", [A(&SPIRAL_BOXES), A(&SPIRAL_BOXES), A(&SPIRAL_BOXES), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).in_time(Time::Discrete),
    at_a_point(Asked::VerdictWithDelayMargin, "verdict --delay-margin 1/1000", [A(&FREQUENCIES), A(&FREQUENCIES), OPEN_LOOP, OPEN_LOOP]),
    Row::new(Asked::IntervalsWithDelayMargin, "intervals --param NAME --delay-margin 1/1000", [A(&BORNE), A(&BORNE), R(&DELAY_BESIDE), P(&BORNE, &ONE_FACTOR), P(&BORNE, &ONE_FACTOR), R(&DELAY_BESIDE), NO_ORDER]).in_time(Time::Continuous),
    Row::new(Asked::IntervalsWithDelayMarginDiscrete, "intervals --param NAME --delay-margin 1/1000", [P(&BORNE_SAMPLES, &NO_SAMPLE_TIME), P(&BORNE_SAMPLES, &MANY_SAMPLES), P(&BORNE_SAMPLES, &DELAY_OF_NUMBERS), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).in_time(Time::Discrete),
    Row::new(Asked::MapWithDelayMargin, "map -x NAME -y NAME --delay-margin 1/1000", [B(&BORNE_BOXES), B(&BORNE_BOXES), R(&DELAY_BESIDE), B(&BORNE_BOXES), B(&BORNE_BOXES), BESIDE, NO_ORDER]).in_time(Time::Continuous),
    Row::new(Asked::MapWithDelayMarginDiscrete, "map -x NAME -y NAME --delay-margin 1/1000", [P(&BORNE_BOXES, &NO_SAMPLE_TIME), P(&BORNE_BOXES, &MANY_SAMPLES), P(&BORNE_BOXES, &DELAY_OF_NUMBERS), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).in_time(Time::Discrete),
    Row::new(Asked::ToleranceWithDelayMargin, "tolerance --tol NAME=10% --delay-margin 1/1000", [A(&BORNE_TENSOR), A(&BORNE_TENSOR), R(&DELAY_BESIDE), P(&BORNE_TENSOR, &ONE_FACTOR), P(&BORNE_TENSOR, &ONE_FACTOR), BESIDE, NO_ORDER]).in_time(Time::Continuous),
    Row::new(Asked::ToleranceWithDelayMarginDiscrete, "tolerance --tol NAME=10% --delay-margin 1/1000", [P(&BORNE_TENSOR, &NO_SAMPLE_TIME), P(&BORNE_TENSOR, &MANY_SAMPLES), P(&BORNE_TENSOR, &DELAY_OF_NUMBERS), NO_DELAY, NO_DELAY, NO_DELAY, NO_ORDER]).in_time(Time::Discrete),
    Row::new(Asked::BoxMapWithRequirements, "map -x NAME -y NAME --method boxes --modulus-margin 1/100", [B(&REQUIRED_BOXES), B(&REQUIRED_BOXES), B(&REQUIRED_BOXES), BOXES_WITH_DEAD_TIME, BOXES_WITH_DEAD_TIME, BESIDE, NO_ORDER]),
    Row::new(Asked::SlicesWithRequirements, "map -x NAME -y NAME -z NAME=LO..HI:N --modulus-margin 1/100", [R(&SLICES_ARE_OF_STABILITY); 7]),
    at_a_point(Asked::VerdictCertificate, "verdict --certificate FILE", [A(&WITNESSES), CERTIFIED, A(&WITNESSES), A(&WITNESSES)]),
    Row::new(Asked::IntervalsCertificate, "intervals --param NAME --certificate FILE", [A(&WITNESSES), CERTIFIED, CERTIFIED, CERTIFIED, CERTIFIED, CERTIFIED, NO_ORDER]),
    Row::new(Asked::ExactMapCertificate, "map -x NAME -y NAME --method exact --certificate FILE", [A(&WITNESSES), R(&MAP_OF_CONSTANTS), R(&MAP_OF_CONSTANTS), R(&MAP_WITH_DEAD_TIME), R(&MAP_WITH_DEAD_TIME), R(&MAP_WITH_DEAD_TIME), NO_ORDER]),
    Row::new(Asked::BoxMapCertificate, "map -x NAME -y NAME --method boxes --certificate FILE", [B(&WITNESSES), B(&WITNESSES), B(&WITNESSES), B(&WITNESSES), B(&WITNESSES), BESIDE, NO_ORDER]),
    Row::new(Asked::ToleranceCertificate, "tolerance --tol NAME=10% --certificate FILE", [A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), BESIDE, NO_ORDER]),
    at_a_point(Asked::VerdictWithMarginsCertificate, "verdict --modulus-margin 1/100 --certificate FILE", [A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), A(&WITNESSES)]),
    Row::new(Asked::IntervalsWithMarginsCertificate, "intervals --param NAME --modulus-margin 1/100 --certificate FILE", [A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), A(&WITNESSES), NO_ORDER]),
    Row::new(Asked::BoxMapWithRequirementsCertificate, "map -x NAME -y NAME --method boxes --modulus-margin 1/100 --certificate FILE", [B(&WITNESSES), B(&WITNESSES), B(&WITNESSES), B(&WITNESSES), B(&WITNESSES), BESIDE, NO_ORDER]),
    Row::new(Asked::Smt2, "intervals --param NAME --smt2 FILE", [A(&WITNESSES), NO_SMT, NO_SMT, NO_SMT, NO_SMT, NO_SMT, NO_SMT]),
    Row::new(Asked::IntervalsCoq, "intervals --param NAME --coq FILE", [A(&WITNESSES), NO_COQ, NO_COQ, NO_COQ, NO_COQ, NO_COQ, NO_ORDER]),
    at_a_point(Asked::VerdictCoq, "verdict --coq FILE", [A(&WITNESSES), NO_COQ, NO_COQ, NO_COQ]),
];
