//! Requirements on margins.

use super::short;
use crate::clock::Clock;
use crate::factor::{Cut, Factor, Family};
use crate::format::Json;
use crate::moving::{pi, turned};
use crate::number::{Q, Z};
use crate::statement::{identifier, list, number, object, text};
use crate::taylor::{Precision, Taylor};
use crate::words::exact;
use num_traits::{One, Signed, Zero};

/// Bits of the enclosures of half an angle.
const ANGLE_BITS: usize = 512;

/// What a loop is to bear: all factors of a family.
pub(super) struct Requirement {
    pub factor: Factor,
    bound: Q,
    /// Of a phase margin: numbers below and above the tangent of half of it, or the tangent.
    turns: Option<[Q; 2]>,
}

impl Requirement {
    pub fn read(json: &Json) -> Result<Self, String> {
        let kind = json.get("kind").ok_or("a requirement has no 'kind'")?;
        let kind = text(kind, "'kind' of a requirement")?;
        let (at, bound, turns) = if kind == "phase_margin" {
            let keys = ["kind", "at", "bound", "turns"];
            let [_, at, bound, turns] = object(json, "a requirement", keys, &[])?;
            (at, bound, Some(turns))
        } else {
            let [_, at, bound] = object(json, "a requirement", ["kind", "at", "bound"], &[])?;
            (at, bound, None)
        };
        let bound = short(number(bound, "'bound'")?)?;
        let between = |low: u32, high: Option<u32>| {
            let of = |n: u32| Q::from(Z::from(n));
            bound > of(low) && high.is_none_or(|high| bound < of(high))
        };
        let (family, is_fit) = match kind {
            "phase_margin" => (Family::Turn, between(0, Some(180))),
            "gain_margin" => (Family::Gain, between(1, None)),
            "modulus_margin" => (Family::Modulus(bound.clone()), between(0, Some(1))),
            "disk_margin" => (Family::Disk(bound.clone()), between(0, Some(2))),
            "complementary_peak" => (Family::Complementary(bound.clone()), between(0, None)),
            other => return Err(format!("unknown requirement '{}'", crate::number::shorten(other))),
        };
        if !is_fit {
            return Err(format!("the bound of a requirement '{kind}' is not one"));
        }
        let turns = turns.map(|turns| self::turns(turns, &bound)).transpose()?;
        Ok(Requirement { factor: Factor { cut: cut(at)?, family }, bound, turns })
    }

    /// The number of its own names.
    pub fn names(&self) -> usize {
        self.factor.family.names()
    }

    /// The ranges of its own names, in which a loop that is stable meets it, or which it is to leave for a loop not to meet it.
    pub fn ranges(&self, is_complex: bool, refute: bool) -> Vec<[Q; 2]> {
        let around = |t: &Q| [if is_complex { -t } else { Q::zero() }, t.clone()];
        match (&self.factor.family, &self.turns) {
            (Family::Gain, _) => vec![[self.bound.recip(), self.bound.clone()]],
            (Family::Turn, Some([below, above])) => vec![around(if refute { below } else { above })],
            _ => vec![[-Q::one(), Q::one()], around(&Q::one())],
        }
    }

    pub fn in_words(&self) -> String {
        let bound = exact(&self.bound);
        let what = match self.factor.family {
            Family::Turn => format!("a phase margin of at least {bound} degrees"),
            Family::Gain => format!("a gain margin of at least {bound} both ways"),
            Family::Modulus(_) => format!("a modulus margin of at least {bound}"),
            Family::Disk(_) => format!("a disk margin of at least {bound}"),
            Family::Complementary(_) => format!("a peak of the complementary sensitivity of at most {bound}"),
        };
        match &self.factor.cut {
            Cut::Signal(name) => format!("{what} at {name}"),
            Cut::Parameter(name) => format!("{what} at the parameter {name}"),
            Cut::Input(name) => format!("{what} at the input of '{}'", name.replace(char::is_control, " ")),
        }
    }
}

fn cut(json: &Json) -> Result<Cut, String> {
    let Json::Object(pairs) = json else { return Err("'at' is not an object".into()) };
    let [(key, name)] = pairs.as_slice() else { return Err("'at' has not one key".into()) };
    let name = text(name, "'at'")?;
    match key.as_str() {
        "signal" => Ok(Cut::Signal(identifier(name)?.to_owned())),
        "parameter" => Ok(Cut::Parameter(identifier(name)?.to_owned())),
        // A block may be called anything.
        "input" => Ok(Cut::Input(name.to_owned())),
        other => Err(format!("'at' has an unknown key '{}'", crate::number::shorten(other))),
    }
}

/// Two numbers around the tangent of half an angle in degrees.
fn turns(json: &Json, angle: &Q) -> Result<[Q; 2], String> {
    let [below, above] = list(json, "'turns'")? else { return Err("'turns' has not two numbers".into()) };
    let (below, above) = (short(number(below, "'turns'")?)?, short(number(above, "'turns'")?)?);
    if !below.is_positive() {
        return Err("'turns' are not positive".into());
    }
    // Of rational angles only that of an eighth of a turn has a rational tangent.
    let is_within = if *angle == Q::from(Z::from(90)) {
        below <= Q::one() && above >= Q::one()
    } else {
        let half = angle / Q::from(Z::from(360));
        is_tangent_above(&half, &below)? && !is_tangent_above(&half, &above)?
    };
    if is_within {
        Ok([below, above])
    } else {
        Err("'turns' are not around the tangent of half the phase margin".into())
    }
}

/// Whether the tangent of a share of half a turn, less than a quarter of it, is above a number.
fn is_tangent_above(share: &Q, t: &Q) -> Result<bool, String> {
    let (p, clock) = (Precision::new(0, 1, ANGLE_BITS), Clock::new(std::time::Duration::MAX));
    let [cosine, sine] = turned(pi(&p).times(&Taylor::number(share, &p), &p, &clock)?, &p, &clock)?;
    // The cosine is positive.
    let difference = sine.minus(&cosine.times(&Taylor::number(t, &p), &p, &clock)?);
    difference.sign().ok_or_else(|| "'turns' are not told from a tangent".into())
}
