//! The questions of the table.

use super::refusals::COMPLEX;
use super::table::rows;
use super::{CoefficientRing, Coverage, Refusal};
use crate::error::Diagnostic;
use crate::model::Time;
use crate::response::{Requirement, Rule};

/// Makes an enumeration of questions in the order of the table.
macro_rules! questions {
    ($($(#[$about:meta])* $name:ident,)+) => {
        /// A question, as the table of what is answered has it.
        ///
        /// ```
        /// use jurist_engine::coverage::{Asked, CoefficientRing};
        /// assert_eq!(Asked::Slices.row().command, "map -x NAME -y NAME -z NAME=LO..HI:N");
        /// assert!(Asked::Verdict.over(CoefficientRing::DeadTime).is_answered());
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Asked {
            $($(#[$about])* $name,)+
        }

        impl Asked {
            /// All of them, in the order of the table.
            pub const ALL: &[Asked] = &[$(Asked::$name),+];
        }
    };
}

questions! {
    /// One point.
    Verdict,
    /// The stable set of one parameter.
    Intervals,
    /// A point, and the stable set of each parameter.
    Analyze,
    /// The characteristic polynomial.
    Charpoly,
    /// Margins at a cut.
    Margins,
    /// The peak gain of a transfer function.
    Norm,
    /// The peak-to-peak gain of a transfer function, discrete time.
    PeakToPeak,
    /// The same in continuous time.
    PeakToPeakContinuous,
    /// Modulus and phase of the open loop over frequency.
    Bode,
    /// The curve of the open loop.
    Nyquist,
    /// A time response, in floating point.
    Simulate,
    /// The root locus, with exact crossings.
    Locus,
    /// The stable region in two parameters, by the method that there is.
    Map,
    /// A box of tolerances, and how far it can grow.
    Tolerance,
    /// The roots of the closed loop.
    Roots,
    /// The classical table at a point.
    Jury,
    /// The classical table in one parameter.
    JuryInParameter,
    /// A page about one loop.
    Report,
    /// The exact decomposition of the plane of two parameters.
    ExactMap,
    /// Boxes of a window of two parameters.
    BoxMap,
    /// Exact maps at values of a third parameter.
    Slices,
    /// How limits move with other names.
    Sensitivity,
    /// `1 + NAME num/den`.
    RootLocusForm,
    /// A transfer function of the closed loop.
    Transfer,
    /// How far one parameter may go while others have tolerances.
    ToleranceLimit,
    /// The largest factor of a box as an algebraic number.
    ToleranceExact,
    /// The stable share of a box.
    ToleranceVolume,
    /// One point in a smaller region.
    VerdictInRegion,
    /// One parameter in a smaller region.
    IntervalsInRegion,
    /// The bound of the region as the parameter.
    RegionBound,
    /// Two parameters in a smaller region.
    MapInRegion,
    /// A box of tolerances in a smaller region.
    ToleranceInRegion,
    /// Requirements on margins at a point.
    VerdictWithMargins,
    /// Requirements on margins in one parameter.
    IntervalsWithMargins,
    /// Requirements on margins in two parameters.
    MapWithMargins,
    /// Requirements on margins over a box.
    ToleranceWithMargins,
    /// A damping at a point.
    VerdictWithDamping,
    /// A damping in one parameter.
    IntervalsWithDamping,
    /// A damping in two parameters, continuous time.
    MapWithDamping,
    /// The same in discrete time.
    MapWithDampingDiscrete,
    /// A damping over a box, continuous time.
    ToleranceWithDamping,
    /// The same in discrete time.
    ToleranceWithDampingDiscrete,
    /// A delay margin at a point.
    VerdictWithDelayMargin,
    /// A delay margin in one parameter, continuous time.
    IntervalsWithDelayMargin,
    /// The same in discrete time.
    IntervalsWithDelayMarginDiscrete,
    /// A delay margin in two parameters, continuous time.
    MapWithDelayMargin,
    /// The same in discrete time.
    MapWithDelayMarginDiscrete,
    /// A delay margin over a box, continuous time.
    ToleranceWithDelayMargin,
    /// The same in discrete time.
    ToleranceWithDelayMarginDiscrete,
    /// Boxes of two parameters with requirements.
    BoxMapWithRequirements,
    /// Slices with requirements.
    SlicesWithRequirements,
    /// A certificate of a verdict.
    VerdictCertificate,
    /// A certificate of a stable set.
    IntervalsCertificate,
    /// A certificate of an exact map.
    ExactMapCertificate,
    /// A certificate of a map by boxes.
    BoxMapCertificate,
    /// A certificate of a box of tolerances.
    ToleranceCertificate,
    /// A certificate of requirements at a point.
    VerdictWithMarginsCertificate,
    /// A certificate of requirements in one parameter.
    IntervalsWithMarginsCertificate,
    /// A certificate of requirements in a map by boxes.
    BoxMapWithRequirementsCertificate,
    /// A statement for SMT solvers.
    Smt2,
    /// A theorem for Coq about one parameter.
    IntervalsCoq,
    /// A theorem for Coq about a point.
    VerdictCoq,
}

impl Asked {
    /// Its row of the table.
    pub fn row(self) -> &'static super::Row {
        // The table has a row for each, in this order; a test sees to that.
        &rows()[self as usize]
    }

    /// What becomes of it over a ring.
    pub fn over(self, ring: CoefficientRing) -> &'static Coverage {
        &self.row().coverage[ring as usize]
    }

    /// The same question about a smaller region.
    pub(crate) fn in_region(self) -> Asked {
        match self {
            Asked::Verdict => Asked::VerdictInRegion,
            Asked::Intervals => Asked::IntervalsInRegion,
            Asked::Map => Asked::MapInRegion,
            Asked::Tolerance => Asked::ToleranceInRegion,
            other => other,
        }
    }

    /// The same question with a requirement.
    ///
    /// ```
    /// use jurist_engine::coverage::Asked;
    /// use jurist_engine::model::Time;
    /// use jurist_engine::response::Requirement;
    /// let damping = Requirement::damping("1/2".parse().unwrap()).unwrap();
    /// assert_eq!(Asked::Map.with_requirement(&damping, Time::Discrete), Asked::MapWithDampingDiscrete);
    /// ```
    pub fn with_requirement(self, requirement: &Requirement, time: Time) -> Asked {
        let is_discrete = time == Time::Discrete;
        // In continuous time, and in discrete time.
        let of = |margins: Asked, damping: [Asked; 2], delay: [Asked; 2]| match requirement.rule() {
            Rule::DeadTime(_) => delay[usize::from(is_discrete)],
            Rule::Sector(_) | Rule::Modulus { .. } => damping[usize::from(is_discrete)],
            Rule::Factors(_) | Rule::Turned { .. } | Rule::Circle(_) => margins,
        };
        use Asked::*;
        match self {
            Verdict => of(VerdictWithMargins, [VerdictWithDamping; 2], [VerdictWithDelayMargin; 2]),
            Intervals => of(
                IntervalsWithMargins,
                [IntervalsWithDamping; 2],
                [IntervalsWithDelayMargin, IntervalsWithDelayMarginDiscrete],
            ),
            Map => of(
                MapWithMargins,
                [MapWithDamping, MapWithDampingDiscrete],
                [MapWithDelayMargin, MapWithDelayMarginDiscrete],
            ),
            Tolerance => of(
                ToleranceWithMargins,
                [ToleranceWithDamping, ToleranceWithDampingDiscrete],
                [ToleranceWithDelayMargin, ToleranceWithDelayMarginDiscrete],
            ),
            other => other,
        }
    }

    /// The refusal of what no loop is asked, whatever its ring.
    ///
    /// ```
    /// use jurist_engine::coverage::Asked;
    /// assert!(Asked::SlicesWithRequirements.never().is_some() && Asked::Jury.never().is_none());
    /// ```
    pub fn never(self) -> Option<&'static Refusal> {
        let refusals = self.row().coverage.iter().map(|coverage| match coverage {
            Coverage::Refused(refusal) => Some(*refusal),
            _ => None,
        });
        refusals.reduce(|a, b| a.zip(b).filter(|(a, b)| std::ptr::eq(*a, *b)).map(|(a, _)| a)).flatten()
    }

    /// The refusal of the question where the loop's coefficients are complex, over whichever ring their parts are; `None` where it is answered
    /// as of a real loop.
    ///
    /// ```
    /// use jurist_engine::coverage::Asked;
    /// assert!(Asked::Roots.of_complex_loop().is_none() && Asked::Locus.of_complex_loop().is_some());
    /// ```
    pub fn of_complex_loop(self) -> Option<&'static Refusal> {
        use Asked::*;
        const KNOWN: [Asked; 41] = [
            Verdict,
            VerdictInRegion,
            Intervals,
            IntervalsInRegion,
            RegionBound,
            Map,
            ExactMap,
            BoxMap,
            Slices,
            MapInRegion,
            Tolerance,
            ToleranceLimit,
            ToleranceExact,
            ToleranceVolume,
            ToleranceInRegion,
            Roots,
            Simulate,
            Charpoly,
            Analyze,
            Report,
            Jury,
            JuryInParameter,
            Margins,
            Norm,
            Bode,
            Nyquist,
            VerdictWithMargins,
            VerdictWithDelayMargin,
            VerdictWithDamping,
            VerdictCertificate,
            IntervalsCertificate,
            ExactMapCertificate,
            BoxMapCertificate,
            ToleranceCertificate,
            VerdictWithMarginsCertificate,
            IntervalsWithMargins,
            IntervalsWithDamping,
            IntervalsWithMarginsCertificate,
            ToleranceWithMargins,
            ToleranceWithDamping,
            ToleranceWithDampingDiscrete,
        ];
        (!KNOWN.contains(&self)).then_some(&COMPLEX)
    }

    /// The refusal of a question about a loop whose coefficients are complex.
    pub(crate) fn refused_of_complex_loops() -> Diagnostic {
        let known = rows().iter().filter(|row| row.asked.of_complex_loop().is_none()).filter_map(|row| row.phrase);
        COMPLEX.diagnostic(&[("known", &known.collect::<Vec<_>>().join(", "))])
    }

    /// The questions that are answered over a ring, as a list in words: those that are a command of their own.
    pub(crate) fn known_over(ring: CoefficientRing) -> String {
        let own = rows().iter().filter_map(|row| Some((row.phrase?, &row.coverage[ring as usize])));
        let known = own.filter_map(|(phrase, coverage)| match coverage {
            Coverage::Answered(_) | Coverage::InPart(..) => Some(phrase.to_owned()),
            Coverage::ByBoxes(_) => Some(format!("{phrase} by boxes")),
            Coverage::Refused(_) => None,
        });
        known.collect::<Vec<_>>().join(", ")
    }
}
