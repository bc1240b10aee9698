//! Requirements on margins.

use super::short;
use crate::clock::Clock;
use crate::factor::{Cut, Factor, Family};
use crate::format::Json;
use crate::moving::{exponential_of, pi, turned};
use crate::number::{Q, Z};
use crate::statement::{identifier, list, number, object, text};
use crate::taylor::{Precision, Taylor};
use crate::words::exact;
use num_traits::{One, Signed, Zero};

/// Bits of the enclosures of half an angle.
const ANGLE_BITS: usize = 512;

/// What a loop is to bear: all factors of a family.
#[derive(Clone)]
pub(crate) struct Requirement {
    pub factor: Factor,
    bound: Q,
    /// Numbers below and above what the bound stands for, where that is not rational, or that number: of a phase margin the tangent of half of it, of a
    /// damping the tangent of the angle from the imaginary axis to the edge of the sector, of the logarithm of a radius that radius.
    around: Option<[Q; 2]>,
}

/// The key of the numbers around what a bound of this kind stands for.
fn key_around(kind: &str) -> Option<&'static str> {
    match kind {
        "phase_margin" => Some("turns"),
        "damping" => Some("slopes"),
        "log_radius" => Some("radii"),
        _ => None,
    }
}

impl Requirement {
    pub fn read(json: &Json, discrete: bool) -> Result<Self, String> {
        let kind = json.get("kind").ok_or("a requirement has no 'kind'")?;
        let kind = text(kind, "'kind' of a requirement")?;
        let is_of_roots = matches!(kind, "damping" | "log_radius");
        let (cut, bound, around) = match key_around(kind) {
            Some(key) if is_of_roots => {
                let [_, bound, around] = object(json, "a requirement", ["kind", "bound", key], &[])?;
                (Cut::Variable, bound, Some(around))
            }
            Some(key) => {
                let [_, at, bound, around] = object(json, "a requirement", ["kind", "at", "bound", key], &[])?;
                (cut(at)?, bound, Some(around))
            }
            None => {
                let [_, at, bound] = object(json, "a requirement", ["kind", "at", "bound"], &[])?;
                (cut(at)?, bound, None)
            }
        };
        let is_of_time = match kind {
            "damping" | "delay_margin" => !discrete,
            "log_radius" => discrete,
            _ => true,
        };
        if !is_of_time {
            return Err(format!("a requirement '{kind}' is not one of this time"));
        }
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
            "delay_margin" => (Family::Delay, between(0, None)),
            "damping" => (Family::Sector, between(0, Some(1))),
            "log_radius" => (Family::Disc, bound.is_negative()),
            other => return Err(format!("unknown requirement '{}'", crate::number::shorten(other))),
        };
        if !is_fit {
            return Err(format!("the bound of a requirement '{kind}' is not one"));
        }
        let around = around.map(|around| self::around(around, &family, &bound)).transpose()?;
        Ok(Requirement { factor: Factor { cut, family }, bound, around })
    }

    /// The number of its own names.
    pub fn names(&self) -> usize {
        self.factor.family.names()
    }

    /// Whether both are of the same kind at the same cut, and this one asks for more.
    pub fn asks_for_more_than(&self, other: &Requirement) -> bool {
        let is_alike = std::mem::discriminant(&self.factor.family) == std::mem::discriminant(&other.factor.family)
            && self.factor.cut == other.factor.cut;
        is_alike
            && match self.factor.family {
                Family::Complementary(_) | Family::Disc => self.bound < other.bound,
                _ => self.bound > other.bound,
            }
    }

    /// The ranges of its own names, in which a loop that is stable meets it, or which it is to leave for a loop not to meet it.
    pub fn ranges(&self, is_complex: bool, refute: bool) -> Vec<[Q; 2]> {
        let around = |t: &Q| [if is_complex { -t } else { Q::zero() }, t.clone()];
        match (&self.factor.family, &self.around) {
            (Family::Gain, _) => vec![[self.bound.recip(), self.bound.clone()]],
            (Family::Delay, _) => vec![[Q::zero(), self.bound.clone()]],
            (Family::Turn | Family::Sector, Some([below, above])) => vec![around(if refute { below } else { above })],
            (Family::Disc, Some([below, above])) => {
                let r = if refute { above } else { below };
                vec![[r.clone(), r.clone()]]
            }
            _ => vec![[-Q::one(), Q::one()], around(&Q::one())],
        }
    }

    /// The parts of these ranges that are to be proved: all of them, or of a sector its edges.
    pub fn proofs(&self, is_complex: bool) -> Vec<Vec<[Q; 2]>> {
        let all = self.ranges(is_complex, false);
        match (&self.factor.family, all.as_slice()) {
            (Family::Sector, [[low, high]]) => {
                let edges = if is_complex { vec![high, low] } else { vec![high] };
                edges.into_iter().map(|t| vec![[t.clone(), t.clone()]]).collect()
            }
            _ => vec![all],
        }
    }

    /// Of factors by a disc three parts of these ranges: both halves of its edge, and what is enough of it at one point of the other names.
    pub fn parts_of_disc(&self, is_complex: bool) -> Option<[Vec<[Q; 2]>; 3]> {
        let [_, t] = self.ranges(is_complex, false).try_into().ok()?;
        let [minus, zero, plus] = [-Q::one(), Q::zero(), Q::one()];
        let at = |r: &Q| vec![[r.clone(), r.clone()], t.clone()];
        let across = if is_complex { t.clone() } else { [zero.clone(), zero] };
        Some([at(&plus), at(&minus), vec![[minus, plus], across]])
    }

    pub fn in_words(&self) -> String {
        let bound = exact(&self.bound);
        let what = match self.factor.family {
            Family::Turn => format!("a phase margin of at least {bound} degrees"),
            Family::Gain => format!("a gain margin of at least {bound} both ways"),
            Family::Modulus(_) => format!("a modulus margin of at least {bound}"),
            Family::Disk(_) => format!("a disk margin of at least {bound}"),
            Family::Complementary(_) => format!("a peak of the complementary sensitivity of at most {bound}"),
            Family::Delay => format!("a delay margin of at least {bound}"),
            Family::Sector => format!("a damping of all roots of at least {bound}"),
            Family::Disc => format!("a radius of all roots of at most exp({bound})"),
        };
        match &self.factor.cut {
            Cut::Signal(name) => format!("{what} at {name}"),
            Cut::Parameter(name) => format!("{what} at the parameter {name}"),
            Cut::Input(name) => format!("{what} at the input of '{}'", name.replace(char::is_control, " ")),
            Cut::Variable => what,
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

/// Two positive numbers around what the bound of a family stands for.
fn around(json: &Json, family: &Family, bound: &Q) -> Result<[Q; 2], String> {
    let what = "the numbers around that of a bound";
    let [below, above] = list(json, what)? else { return Err(format!("{what} are not two")) };
    let (below, above) = (short(number(below, what)?)?, short(number(above, what)?)?);
    if !below.is_positive() {
        return Err(format!("{what} are not positive"));
    }
    let is_within = match family {
        Family::Sector => {
            let square = |t: &Q| t * t * (Q::one() - bound * bound);
            square(&below) <= bound * bound && above.is_positive() && square(&above) >= bound * bound
        }
        Family::Disc => is_exponential_above(bound, &below)? && !is_exponential_above(bound, &above)?,
        // Of rational angles only that of an eighth of a turn has a rational tangent.
        _ if *bound == Q::from(Z::from(90)) => below <= Q::one() && above >= Q::one(),
        _ => {
            let half = bound / Q::from(Z::from(360));
            is_tangent_above(&half, &below)? && !is_tangent_above(&half, &above)?
        }
    };
    if is_within { Ok([below, above]) } else { Err(format!("{what} are not around it")) }
}

/// Whether the exponential of a number is above another one.
fn is_exponential_above(x: &Q, r: &Q) -> Result<bool, String> {
    let (p, clock) = (Precision::new(0, 1, ANGLE_BITS), Clock::new(std::time::Duration::MAX));
    let difference = exponential_of(x, &p, &clock)?.minus(&Taylor::number(r, &p));
    difference.sign().ok_or_else(|| "a radius is not told from an exponential".into())
}

/// Whether the tangent of a share of half a turn, less than a quarter of it, is above a number.
fn is_tangent_above(share: &Q, t: &Q) -> Result<bool, String> {
    let (p, clock) = (Precision::new(0, 1, ANGLE_BITS), Clock::new(std::time::Duration::MAX));
    let [cosine, sine] = turned(pi(&p).times(&Taylor::number(share, &p), &p, &clock)?, &p, &clock)?;
    // The cosine is positive.
    let difference = sine.minus(&cosine.times(&Taylor::number(t, &p), &p, &clock)?);
    difference.sign().ok_or_else(|| "'turns' are not told from a tangent".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bound: &str, turns: [&str; 2]) -> Result<Requirement, String> {
        let text = format!(
            r#"{{"kind": "phase_margin", "at": {{"signal": "u"}}, "bound": "{bound}", "turns": ["{}", "{}"]}}"#,
            turns[0], turns[1]
        );
        Requirement::read(&Json::parse(&text).expect("it is JSON"), false)
    }

    #[test]
    #[ignore = "long: CI runs it"]
    fn turns_are_told_from_tangents() {
        for tenths in (1..1800).step_by(29) {
            let tangent = (f64::from(tenths) / 20.0).to_radians().tan();
            let scale = (1e13 / tangent.max(1.0)).floor();
            let at = |x: f64| format!("{}/{}", x as u64, scale as u64);
            let [below, above] = [at((tangent * scale).floor() - 2.0), at((tangent * scale).ceil() + 2.0)];
            let bound = format!("{tenths}/10");
            let is_known = tenths == 900;
            assert!(read(&bound, [&below, &above]).is_ok(), "{tenths}");
            for wrong in [[&above, &above], [&below, &below], [&above, &below]] {
                assert!(read(&bound, wrong.map(String::as_str)).is_err(), "{tenths}");
            }
            assert_eq!(read(&bound, ["1", "1"]).is_ok(), is_known);
        }
        // tan(30 degrees) is 1/sqrt(3): 40 digits, and one more or less.
        let digits = "5773502691896257645091487805019574556476";
        let [below, above] =
            [digits.to_owned(), digits.replace("6476", "6477")].map(|d| format!("{d}/1{}", "0".repeat(40)));
        assert!(read("60", [&below, &above]).is_ok());
        assert!(read("60", [&above, &above]).is_err() && read("60", [&below, &below]).is_err());
        for wrong in ["0", "180", "-45", "200"] {
            assert!(read(wrong, ["1/1000", "1000"]).is_err(), "{wrong}");
        }
        assert!(read("45", ["0", "1"]).is_err() && read("45", ["-1", "1"]).is_err());
    }

    #[test]
    fn slopes_and_radii_are_told_from_what_they_are_around() {
        let of = |kind: &str, key: &str, bound: &str, [below, above]: [&str; 2]| {
            let text = format!(r#"{{"kind": "{kind}", "bound": "{bound}", "{key}": ["{below}", "{above}"]}}"#);
            Requirement::read(&Json::parse(&text).expect("it is JSON"), kind == "log_radius")
        };
        let slopes = |around| of("damping", "slopes", "3/5", around);
        assert!(slopes(["3/4", "3/4"]).is_ok() && slopes(["1/2", "1"]).is_ok());
        for wrong in [["3/4", "749/1000"], ["751/1000", "1"], ["-3/4", "3/4"], ["0", "3/4"]] {
            assert!(slopes(wrong).is_err(), "{wrong:?}");
        }
        // exp(-1/2), 20 digits.
        let radii = |around| of("log_radius", "radii", "-1/2", around);
        let [below, above] =
            ["60653065971263342360/100000000000000000000", "60653065971263342361/100000000000000000000"];
        assert!(radii([below, above]).is_ok());
        for wrong in [[above, above], [below, below], [above, below]] {
            assert!(radii(wrong).is_err(), "{wrong:?}");
        }
        assert!(
            of("log_radius", "radii", "1/2", ["1", "2"]).is_err() && of("damping", "slopes", "1", ["1", "9"]).is_err()
        );
        let (sector, disc) = (slopes(["1/2", "1"]).unwrap(), radii(["1/2", "2/3"]).unwrap());
        let q = |n: i64, d: i64| Q::new(n.into(), d.into());
        assert_eq!(sector.proofs(false), [[[q(1, 1), q(1, 1)]]]);
        assert_eq!(sector.proofs(true), [[[q(1, 1), q(1, 1)]], [[q(-1, 1), q(-1, 1)]]]);
        assert_eq!(sector.ranges(true, true), [[q(-1, 2), q(1, 2)]]);
        assert_eq!(
            (disc.proofs(false), disc.ranges(false, true)),
            (vec![vec![[q(1, 2), q(1, 2)]]], vec![[q(2, 3), q(2, 3)]])
        );
    }

    #[test]
    fn ranges_go_through_the_family() {
        let of = |kind: &str, bound: &str| {
            let text = format!(r#"{{"kind": "{kind}", "at": {{"input": "a b"}}, "bound": "{bound}"}}"#);
            Requirement::read(&Json::parse(&text).expect("it is JSON"), false)
        };
        let q = |n: i64, d: i64| Q::new(n.into(), d.into());
        let gain = of("gain_margin", "5/2").unwrap();
        assert_eq!(gain.ranges(true, false), [[q(2, 5), q(5, 2)]]);
        let disc = of("disk_margin", "1").unwrap();
        assert_eq!(disc.ranges(false, true), [[q(-1, 1), q(1, 1)], [q(0, 1), q(1, 1)]]);
        assert_eq!(disc.ranges(true, true), [[q(-1, 1), q(1, 1)], [q(-1, 1), q(1, 1)]]);
        let [all, half, one, zero] = [[-1, 1], [0, 1], [1, 1], [0, 0]].map(|side| side.map(|n| q(n, 1)));
        let minus = [-1, -1].map(|n| q(n, 1));
        let parts = |of: [&[Q; 2]; 6]| [0, 2, 4].map(|i| vec![of[i].clone(), of[i + 1].clone()]);
        assert_eq!(disc.parts_of_disc(false), Some(parts([&one, &half, &minus, &half, &all, &zero])));
        assert_eq!(disc.parts_of_disc(true), Some(parts([&one, &all, &minus, &all, &all, &all])));
        assert!(gain.parts_of_disc(false).is_none());
        let phase = read("90", ["9/10", "11/10"]).unwrap();
        assert_eq!(phase.ranges(false, false), [[q(0, 1), q(11, 10)]]);
        assert_eq!(phase.ranges(true, true), [[q(-9, 10), q(9, 10)]]);
        for (kind, bound) in [
            ("gain_margin", "1"),
            ("gain_margin", "1/2"),
            ("modulus_margin", "1"),
            ("modulus_margin", "0"),
            ("disk_margin", "2"),
            ("disk_margin", "-1"),
            ("complementary_peak", "0"),
            ("phase_margin", "45"),
            ("delay_margin", "0"),
            ("damping", "1/2"),
            ("log_radius", "-1"),
        ] {
            assert!(of(kind, bound).is_err(), "{kind} {bound}");
        }
    }
}
