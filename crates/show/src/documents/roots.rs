//! The document `jurist/roots/1`.

use super::number::{Enclosure, enclosure};
use super::schema_name;
use super::{Answered, PointQuestion};
use crate::roots::{bits_of, certain_digits, hertz};
use crate::{Document, real};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number;
use jurist_engine::answer::{self, Answer, ClosedLoopRoot};
use jurist_engine::problem::Problem;
use serde::{Deserialize, Serialize};

schema_name!(RootsName, "jurist/roots/1");

/// The roots of the characteristic polynomial at a point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Roots {
    /// The kind of document.
    pub schema: RootsName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The roots.
    #[serde(flatten)]
    pub answer: Answered<RootsFound, RootsOpen>,
}

/// The roots.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RootsFound {
    /// The slowest first; of a pair of conjugate roots the upper one.
    pub roots: Vec<RootFound>,
    /// The degree of the characteristic polynomial in all parameters.
    pub degree: usize,
    /// Roots at infinity: by how much the degree drops at this point.
    pub infinite: usize,
    /// Of a loop with dead time, which has infinitely many roots: how many of the rightmost were asked for. More are listed where real
    /// parts are nearly the same, fewer where infinitely many come near to the line `chain`. Without this key all roots are listed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rightmost: Option<usize>,
    /// With `rightmost`: no root that is not listed has this real part or a greater one; a rational number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub others_left_of: Option<String>,
    /// Of a loop of neutral type: certified bounds of the real part of a line that infinitely many roots come as near to as one likes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<Enclosure>,
}

/// A root or a pair, or several that are not told apart.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RootFound {
    /// The real part, with as many digits as were asked for and are certain; 0 where the enclosure holds 0.
    pub re: String,
    /// The imaginary part; positive of a pair. One complex root, of a loop with complex coefficients, has it of either sign.
    pub im: String,
    /// Certified bounds of the real part.
    pub re_enclosure: Enclosure,
    /// Certified bounds of the imaginary part; both are 0 of a real root.
    pub im_enclosure: Enclosure,
    /// Whether the conjugate number is a root as well, which is not listed.
    pub pair: bool,
    /// How often it is a root; of several that are not told apart how many they are.
    pub multiplicity: usize,
    /// Whether it is one root. If not, all of them lie in a disc that the enclosures hold.
    pub one: bool,
    /// `|s|` or `|z|`, rounded.
    pub magnitude: Option<serde_json::Number>,
    /// The damping ratio of `s`, or of `ln(z)`, rounded; `null` of a root at 0, and of several.
    pub damping: Option<serde_json::Number>,
    /// The natural frequency in radians per second, rounded; `null` also in discrete time without a sample time.
    pub natural_frequency: Option<serde_json::Number>,
    /// The same in hertz.
    pub natural_frequency_hz: Option<serde_json::Number>,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RootsOpen {
    /// Not known.
    pub roots: (),
}

impl RootFound {
    fn new(root: &ClosedLoopRoot, digits: usize) -> RootFound {
        let bits = bits_of(digits);
        let places = digits.min(real::JSON_NUMBER_DIGITS);
        let number = |x: Option<number::Enclosure>| real::json_number(&certain_digits(&x?, places));
        let (re, im) = (root.real(), root.imaginary());
        let rate = root.natural_frequency(bits);
        RootFound {
            re: certain_digits(&re, digits),
            im: certain_digits(&im, digits),
            re_enclosure: enclosure(re.lower(), re.upper()),
            im_enclosure: enclosure(im.lower(), im.upper()),
            pair: root.disc.is_pair,
            multiplicity: root.disc.count,
            one: root.disc.is_one,
            magnitude: number(Some(root.magnitude(bits))),
            damping: number(root.damping(bits)),
            natural_frequency_hz: number(rate.as_ref().and_then(|rate| hertz(rate, bits))),
            natural_frequency: number(rate),
        }
    }
}

impl Roots {
    /// The document, also of roots that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, roots: Result<&answer::Roots, &Exhausted>, digits: usize) -> Self {
        let found = |roots: &answer::Roots| RootsFound {
            roots: roots.list.iter().map(|root| RootFound::new(root, digits)).collect(),
            degree: roots.degree,
            infinite: roots.infinite,
            rightmost: roots.beyond.as_ref().map(|beyond| beyond.wanted),
            others_left_of: roots.beyond.as_ref().map(|beyond| beyond.others_left_of.to_string()),
            chain: roots
                .beyond
                .as_ref()
                .and_then(|beyond| beyond.chain.as_ref())
                .map(|x| enclosure(x.lower(), x.upper())),
        };
        Roots { schema: RootsName::V1, question: PointQuestion::new(problem), answer: Answered::of(roots, found) }
    }
}

impl Document for Answer<answer::Roots> {
    type Json = Roots;

    /// The document `jurist/roots/1`.
    fn json(&self, digits: usize) -> Self::Json {
        Roots::new(self.problem(), Ok(self.value()), digits)
    }
}
