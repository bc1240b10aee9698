//! The stable codes of diagnostics.

use std::fmt;

/// Makes an enumeration of codes from pairs of a name and a text.
macro_rules! codes {
    ($(#[$attribute:meta])* pub enum $codes:ident { $($name:ident = $text:literal,)+ }) => {
        $(#[$attribute])*
        pub enum $codes {
            $(#[doc = concat!("`", $text, "`: its meaning is in [`code_list`](super::code_list).")] $name,)+
        }

        impl $codes {
            /// All codes, sorted by their text.
            pub const ALL: &[$codes] = &[$($codes::$name),+];

            /// The code as users see it, such as `E-unknown-name`.
            pub const fn as_str(self) -> &'static str {
                match self {
                    $($codes::$name => $text,)+
                }
            }
        }
    };
}

codes! {
/// The stable code of a diagnostic: an error (`E-`) or a warning (`W-`). `Display` writes it as users see it.
///
/// ```
/// use jurist_model::error::Code;
/// assert_eq!(Code::UnknownName.to_string(), "E-unknown-name");
/// assert!(Code::ALL.contains(&Code::UnusedWarning));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Code {
    AlgebraicLoop = "E-algebraic-loop",
    Complex = "E-complex",
    Coq = "E-coq",
    Cut = "E-cut",
    Cycle = "E-cycle",
    DeadTime = "E-dead-time",
    Discretize = "E-discretize",
    DivisionByZero = "E-division-by-zero",
    DuplicateKey = "E-duplicate-key",
    DuplicateName = "E-duplicate-name",
    Duty = "E-duty",
    Edge = "E-edge",
    EmptyDomain = "E-empty-domain",
    Expect = "E-expect",
    Exponent = "E-exponent",
    Export = "E-export",
    Frame = "E-frame",
    From = "E-from",
    Function = "E-function",
    Import = "E-import",
    Improper = "E-improper",
    Internal = "E-internal",
    KeptAndSet = "E-kept-and-set",
    KeptTwice = "E-kept-twice",
    Missing = "E-missing",
    Name = "E-name",
    NoCertificate = "E-no-certificate",
    NoPage = "E-no-page",
    NoRootLocus = "E-no-root-locus",
    NoStates = "E-no-states",
    NoValue = "E-no-value",
    NotANumber = "E-not-a-number",
    NotLinear = "E-not-linear",
    NotPolynomial = "E-not-polynomial",
    Number = "E-number",
    OptionValue = "E-option-value",
    OutputFormat = "E-output-format",
    OutputName = "E-output-name",
    Rate = "E-rate",
    RateMargin = "E-rate-margin",
    Read = "E-read",
    Region = "E-region",
    Require = "E-require",
    ReservedName = "E-reserved-name",
    Resume = "E-resume",
    SetTwice = "E-set-twice",
    ShipBlock = "E-ship-block",
    ShipContinuous = "E-ship-continuous",
    ShipFormat = "E-ship-format",
    ShipParallel = "E-ship-parallel",
    ShipRange = "E-ship-range",
    Simulation = "E-simulation",
    Size = "E-size",
    Syntax = "E-syntax",
    Tolerance = "E-tolerance",
    Toml = "E-toml",
    TooDeep = "E-too-deep",
    TooLarge = "E-too-large",
    TuneBounds = "E-tune-bounds",
    TuneFree = "E-tune-free",
    TuneObjective = "E-tune-objective",
    TwoDrivers = "E-two-drivers",
    TwoForms = "E-two-forms",
    Type = "E-type",
    Undefined = "E-undefined",
    UnknownCode = "E-unknown-code",
    UnknownKey = "E-unknown-key",
    UnknownName = "E-unknown-name",
    UnknownParameter = "E-unknown-parameter",
    UnknownSignal = "E-unknown-signal",
    UnknownTemplate = "E-unknown-template",
    Usage = "E-usage",
    Utf8 = "E-utf8",
    Value = "E-value",
    Write = "E-write",
    CertificateWarning = "W-certificate",
    DomainWarning = "W-domain",
    DsvReadingWarning = "W-dsv-reading",
    ExpectWarning = "W-expect",
    FeedthroughWarning = "W-feedthrough",
    NominalWarning = "W-nominal",
    NotMetWarning = "W-not-met",
    OutsideDomainWarning = "W-outside-domain",
    OwnMeaningWarning = "W-own-meaning",
    RequireWarning = "W-require",
    RuleWarning = "W-rule",
    SampleTimesWarning = "W-sample-times",
    UnusedWarning = "W-unused",
}
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}
