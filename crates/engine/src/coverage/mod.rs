//! Which question is answered over which coefficient ring, as data: one table.
//!
//! The table says for each question and each ring how the answer is found, or with which words the question is refused and what to ask
//! instead. Code that has to choose reads it, the texts of refusals are in it, `--explain` prints from it, and the page
//! `docs/explanation/coverage.md` is made of it. A test asks the program every question of a loop over each ring.
//!
//! ```
//! use jurist_engine::coverage::{Asked, CoefficientRing};
//! let map = Asked::Map.over(CoefficientRing::DeadTime);
//! assert_eq!(map.name(), "by boxes");
//! assert!(Asked::Jury.over(CoefficientRing::DeadTime).refusal().unwrap().message.contains("dead time"));
//! ```

mod asked;
mod method;
mod page;
pub(crate) mod refusals;
mod ring;
mod table;

pub use crate::error::Refusal;
pub use asked::Asked;
pub use method::Method;
pub use page::page;
pub use refusals::{
    MAP_OF_CONSTANTS, MAP_WITH_DEAD_TIME, NO_CERTIFICATE, NOT_ALGEBRAIC, NOT_FOR_COQ, REQUIREMENT_NOT_CERTIFIED,
    WIDE_DISK,
};
pub use ring::CoefficientRing;
pub use table::{Row, rows};

/// What becomes of a question over a ring.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Coverage {
    /// It is answered, exactly.
    Answered(&'static Method),
    /// It is answered by boxes: proved parts of a window, and a part that stays undecided.
    ByBoxes(&'static Method),
    /// It is answered of some of these loops; of the others it is refused so.
    InPart(&'static Method, &'static Refusal),
    /// It is refused.
    Refused(&'static Refusal),
}

impl Coverage {
    /// `answered`, `by boxes`, `in part` or `refused`.
    pub fn name(&self) -> &'static str {
        match self {
            Coverage::Answered(_) => "answered",
            Coverage::ByBoxes(_) => "by boxes",
            Coverage::InPart(..) => "in part",
            Coverage::Refused(_) => "refused",
        }
    }

    /// How the answer is found; `None` where there is none.
    pub fn method(&self) -> Option<&'static Method> {
        match self {
            Coverage::Answered(method) | Coverage::ByBoxes(method) | Coverage::InPart(method, _) => Some(method),
            Coverage::Refused(_) => None,
        }
    }

    /// How it is refused, if it can be.
    pub fn refusal(&self) -> Option<&'static Refusal> {
        match self {
            Coverage::InPart(_, refusal) | Coverage::Refused(refusal) => Some(refusal),
            Coverage::Answered(_) | Coverage::ByBoxes(_) => None,
        }
    }

    /// True if all such loops are answered exactly.
    pub fn is_answered(&self) -> bool {
        matches!(self, Coverage::Answered(_))
    }
}
