//! Controllers as source code: C99, structured text of IEC 61131-3, Rust.
//!
//! A controller is walked once and becomes statements; a language is the way in which statements are written. So no language knows a
//! realisation, and no realisation a language. What is printed computes what [`run`](crate::run) computes, bit for bit.
//!
//! C is one header of `static inline` functions and not a header with a source file: it needs no line in a build system, the compiler sees
//! the constants where they are used (in an interrupt that is the difference between a multiplication and a call), and one file has one hash.

mod c;
mod helpers;
mod lower;
mod names;
mod numbers;
mod remarks;
mod rust;
mod statements;
mod structured_text;
mod syntax;

pub(crate) use lower::numbered;

use crate::program::Program;
use crate::realise::Realisation;
use crate::run::{FixedProgram, FloatProgram};
use std::fmt;

/// A language.
///
/// ```
/// use jurist_ship::emit::Target;
/// assert_eq!(Target::ALL.map(Target::extension), ["h", "st", "rs"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// C99: a header.
    C,
    /// Structured text of IEC 61131-3: a function block.
    StructuredText,
    /// Rust without the standard library: a module.
    Rust,
}

impl Target {
    /// All languages.
    pub const ALL: [Target; 3] = [Target::C, Target::StructuredText, Target::Rust];

    /// What names of its files end in.
    pub fn extension(self) -> &'static str {
        match self {
            Target::C => "h",
            Target::StructuredText => "st",
            Target::Rust => "rs",
        }
    }
}

/// How a controller computes.
#[derive(Clone, Copy, Debug)]
pub enum Arithmetic<'p> {
    /// In integers.
    Fixed(&'p FixedProgram<'p>),
    /// In binary floating point.
    Float(&'p FloatProgram<'p>),
}

impl<'p> Arithmetic<'p> {
    /// What is computed.
    pub fn program(&self) -> &'p Program {
        match self {
            Arithmetic::Fixed(fixed) => fixed.program,
            Arithmetic::Float(float) => float.program,
        }
    }
}

/// A controller to be written.
#[derive(Clone, Copy, Debug)]
pub struct Shipped<'p> {
    /// Its name; what no language takes for a name becomes one.
    pub name: &'p str,
    /// In which order it computes, for the comment.
    pub realisation: Realisation,
    /// What it computes.
    pub arithmetic: Arithmetic<'p>,
    /// Lines of the comment at the head: where the controller is from, what was proved of it. They may hold any characters.
    pub remarks: &'p [String],
}

/// A number does not fit into the 64 bits that sums are computed in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooWide {
    /// The sum; `None` where it is the signals themselves that have too many bits.
    pub node: Option<String>,
    /// How many bits it takes. A sum may take 64, a signal 63.
    pub bits: u64,
}

impl fmt::Display for TooWide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.node {
            Some(node) => write!(f, "the sum `{node}` takes {} bits, and code computes in 64", self.bits),
            None => write!(f, "signals have {} bits, and code has at most 63 for them", self.bits),
        }
    }
}

impl std::error::Error for TooWide {}

/// The text of a file with this controller.
///
/// Cost: linear in the terms.
///
/// ```
/// use jurist_algebra::number::{BinaryFormat, Enclosure, parse_number};
/// use jurist_ship::emit::{Arithmetic, Shipped, Target, text};
/// use jurist_ship::realise::{Realisation, direct};
/// use jurist_ship::run::FloatProgram;
/// let exact = |texts: &[&str]| texts.iter().map(|t| Enclosure::from_rational(parse_number(t).unwrap())).collect::<Vec<_>>();
/// // 0.4/(z - 0.6)
/// let lag = direct(Realisation::Df1, &exact(&["0", "0.4"]), &exact(&["1", "-0.6"]));
/// let stored: Vec<_> = lag.program.coefficients.iter().map(|c| c.exact.lower().clone()).collect();
/// let float = FloatProgram::new(&lag.program, &stored, BinaryFormat::Single).unwrap();
/// let shipped =
///     Shipped { name: "lag", realisation: lag.realisation, arithmetic: Arithmetic::Float(&float), remarks: &["From a page.".into()] };
/// let text = text(&shipped, Target::C)?;
/// assert!(text.contains("static inline float lag_step(lag_state *s, float u)"));
/// assert!(text.contains("static const float LAG_B1 = 0x1.99999ap-2f; /* b1 = 0.4 */"));
/// # Ok::<(), jurist_ship::emit::TooWide>(())
/// ```
///
/// # Errors
/// [`TooWide`] where some inputs and states could make a sum overflow the 64 bits in which it is computed, or signals have more than 63.
pub fn text(shipped: &Shipped<'_>, target: Target) -> Result<String, TooWide> {
    let name = names::legal(shipped.name);
    let syntax: Box<dyn syntax::Syntax> = match target {
        Target::C => Box::new(c::C::new(&name)),
        Target::StructuredText => Box::new(structured_text::StructuredText::new(&name)),
        Target::Rust => Box::new(rust::Rust::new(&name)),
    };
    let code = lower::code(shipped, &name, &*syntax)?;
    let mut head = remarks::head(shipped, &name);
    head.extend(syntax.notes(&code));
    let lines = [syntax::comment(&*syntax, &head), syntax.file(&code)].concat();
    Ok(lines.iter().map(|line| format!("{}\n", line.trim_end())).collect())
}
