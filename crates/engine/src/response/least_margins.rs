//! How much of each margin a loop has for all values of some names: between a number that is proved of all values, and what one of them has.
//!
//! A value of the names at which the margin is small is a bound from above. A number that is a little less is required of all values, part by part of
//! their ranges; where a part has less, its middle is the next bound from above.

use super::everywhere::{Everywhere, everywhere};
use super::for_all::{AllOf, MapForAll};
use super::level::Level;
use super::margins::Margins;
use super::requirement::Requirement;
use super::requirement_boxes::RequirementBoxes;
use crate::answer::Answer;
use crate::coverage::refusals::COMPLEX_FOR_ALL;
use crate::error::Error;
use crate::model::Cut;
use crate::problem::{Problem, Question};
use crate::stability::boxes::corners;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational, parse_number, to_decimal};
use std::sync::Arc;

/// The margins that are looked at, each where it belongs to the kind of time.
const MARGINS: [Level; 6] = [
    Level::GainMargin,
    Level::PhaseMargin,
    Level::DelayMargin,
    Level::ModulusMargin,
    Level::ComplementaryPeak,
    Level::DiskMargin,
];

/// More parts of the ranges are not looked at, for one number.
const MOST_PARTS: usize = 1 << 9;

/// What is required of all values is so much less than what one has, as shares; the next one where the one before is not proved.
const GAPS: [(i64, i64); 4] = [(1, 200), (1, 50), (1, 8), (1, 2)];

/// Bounds from above are not made smaller more often.
const MOST_BOUNDS: usize = 24;

/// Bits of what a value has.
const BITS: u64 = 64;

/// A gain margin and a phase margin (in degrees) that no value at hand limits: at least this is proved.
const FAR_FACTOR: i64 = 1000;
const FAR_ANGLE: i64 = 179;

/// Digits of a number that is proved.
const DIGITS: usize = 5;

/// How much of each margin a loop has, whatever the values of some names are.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LeastMargins {
    /// The names with the ranges of their values.
    pub all: Vec<AllOf>,
    /// Where the loop is cut, once margins were looked at.
    pub cut: Option<Cut>,
    /// Whether the loop is stable for all values; the margins are looked at where it is.
    pub stable: Everywhere,
    /// The margins.
    pub margins: Vec<LeastMargin>,
    /// What ended the work before all margins were looked at.
    pub stopped: Option<Exhausted>,
}

/// The least value of a margin; of a peak the greatest one.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LeastMargin {
    /// Which margin: degrees of a phase margin, a factor of a gain margin, units of time of a delay margin.
    pub level: Level,
    /// All values have at least so much; of a peak, at most.
    pub proved: Option<Rational>,
    /// What one value has, and the value of each name; `None` where no value that was looked at limits it.
    pub found: Option<(Enclosure, Vec<Rational>)>,
    /// Why no number is proved.
    pub why: Option<String>,
}

impl MapForAll {
    /// How much of each margin the loop of a question has for all values of the names, the margins being taken at the cut.
    ///
    /// Cost: that of the margins at some values, and of boxes of the ranges for each margin.
    ///
    /// # Errors
    /// As [`MapForAll::boxes`]; as [`Problem::margins`] for a cut that does not exist.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// use jurist_engine::response::{AllOf, Everywhere, MapForAll};
    /// // The phase margin of a/(s (s + 1)) falls with a: atan(1/w) where a = w sqrt(1 + w^2), so 60 degrees at 2/3.
    /// let text = "time = 'continuous'\nparameters = { a = '1/2' }\nloop = { inputs = ['r'], outputs = ['y'] }\n\
    ///     [[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'a/(s*(s + 1))'\n";
    /// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
    /// let all = MapForAll::new(vec![AllOf::new("a", "1/10".parse()?, "2/3".parse()?).unwrap()]);
    /// let answer = all.least_margins(model.ask(), &Budget::unlimited())?;
    /// assert_eq!(answer.value().stable, Everywhere::All);
    /// let phase = answer.value().margins.iter().find(|margin| margin.level.name() == "phase_margin").unwrap();
    /// assert!(phase.proved.clone().unwrap() > "59.5".parse()? && phase.proved.clone().unwrap() <= 60.into());
    /// assert_eq!(phase.found.as_ref().unwrap().1, ["2/3".parse()?]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn least_margins(&self, question: Question, budget: &Budget) -> Result<Answer<LeastMargins>, Error> {
        let middle = |all: &AllOf| (all.name.clone(), all.range[0].midpoint(&all.range[1]));
        let inner = question.clone().set_all(self.all.iter().map(middle)).problem()?;
        match inner.refuse_complex(budget) {
            Err(Error::Refused(_)) => return Err(COMPLEX_FOR_ALL.diagnostic(&[]).into()),
            known => known?,
        }
        let together = self.together(question.clone())?;
        let (stability, _) = self.tests(&together, Vec::new(), budget)?;
        let sides: Vec<[Rational; 2]> = self.all.iter().map(|all| all.range.clone()).collect();
        budget.step("stability for all values");
        let stable = everywhere(&[&stability[0]], sides.clone(), MOST_PARTS, budget)?;
        let mut found = LeastMargins { all: self.all.clone(), cut: None, stable, margins: Vec::new(), stopped: None };
        if found.stable == Everywhere::All {
            let search = Search { names: self, question, together, sides, budget };
            search.margins(&mut found)?;
        }
        Ok(Answer::new(inner.without_values_of(|name| self.all.iter().any(|all| all.name == name)), found))
    }
}

/// The margins of the loop with each of some values.
type Seen = Vec<(Vec<Rational>, Answer<Margins>)>;

struct Search<'a> {
    names: &'a MapForAll,
    question: Question,
    together: Arc<Problem>,
    sides: Vec<[Rational; 2]>,
    budget: &'a Budget,
}

impl Search<'_> {
    fn margins(&self, found: &mut LeastMargins) -> Result<(), Error> {
        let middle: Vec<Rational> = self.sides.iter().map(|[low, high]| low.midpoint(high)).collect();
        // What is refused in the middle is so of all values.
        let mut seen: Seen = vec![(middle.clone(), self.margins_at(&middle)?)];
        found.cut = Some(seen[0].1.value().open_loop.cut().clone());
        for corner in corners(&self.sides) {
            match self.margins_at(&corner) {
                Ok(margins) => seen.push((corner, margins)),
                // A gain of zero opens the loop: it has no margins there.
                Err(Error::Refused(_)) => {}
                Err(error) => return Err(error),
            }
        }
        for level in MARGINS.into_iter().filter(|level| level.fits(self.together.time())) {
            let mut margin = LeastMargin { level, proved: None, found: None, why: None };
            match self.least(&mut margin, &mut seen) {
                Ok(()) => {}
                Err(Error::Refused(why)) => margin.why = Some(why.diagnostics()[0].message.clone()),
                Err(error) => {
                    found.stopped = Some(error.stopped()?);
                    margin.why = Some("the budget ran out".to_owned());
                }
            }
            found.margins.push(margin);
            if found.stopped.is_some() {
                break;
            }
        }
        Ok(())
    }

    fn margins_at(&self, point: &[Rational]) -> Result<Answer<Margins>, Error> {
        let names = self.names.all.iter().map(|all| all.name.clone());
        let problem = self.question.clone().set_all(names.zip(point.iter().cloned())).problem()?;
        problem.margins(self.names.at.as_deref(), &Rational::ZERO, self.budget)
    }

    /// The least value of one margin, as far as it is found.
    fn least(&self, margin: &mut LeastMargin, seen: &mut Seen) -> Result<(), Error> {
        let level = margin.level;
        self.budget.step(&format!("the least {}", level.name().replace('_', " ")));
        for (point, margins) in seen.iter() {
            margin.lower(point, margins.value());
        }
        let mut gaps = GAPS.into_iter().map(|(a, b)| Rational::new(a.into(), b.into()));
        let mut gap = gaps.next().expect("there are some");
        for _ in 0..MOST_BOUNDS {
            let Some(asked) = margin.asked(&gap)? else { break };
            let near: Vec<Rational> = self.sides.iter().map(|[low, high]| low.midpoint(high)).collect();
            let at = Some(seen[0].1.value().open_loop.cut().name());
            let test = RequirementBoxes::of(&self.together, &asked.requirement, at, &near, self.budget)?;
            let Some(test) = test else {
                margin.why = Some("no way to prove it for all values is known".to_owned());
                return Ok(());
            };
            let is_less = match everywhere(&[&test], self.sides.clone(), MOST_PARTS, self.budget)? {
                Everywhere::All => {
                    margin.proved = Some(asked.proved);
                    return Ok(());
                }
                Everywhere::NotAt(point) => {
                    let margins = self.margins_at(&point)?;
                    let is_less = margin.lower(&point, margins.value());
                    seen.push((point, margins));
                    is_less
                }
                Everywhere::Open => false,
            };
            if !is_less {
                let Some(next) = gaps.next() else { break };
                gap = next;
            }
        }
        margin.why = Some(match margin.found {
            None => "no value that was looked at limits it".to_owned(),
            Some(_) => "too many parts of the ranges are open".to_owned(),
        });
        Ok(())
    }
}

/// What is asked of all values, and what is proved where they have it.
struct AskedOfAll {
    requirement: Requirement,
    proved: Rational,
}

impl LeastMargin {
    /// Takes what a value has, if that is less than what is known; whether it is.
    fn lower(&mut self, point: &[Rational], margins: &Margins) -> bool {
        let Some(value) = self.level.among(margins, BITS) else { return false };
        let is_less = |known: &Enclosure| match self.level.is_greatest_best() {
            true => value.upper() < known.lower(),
            false => value.lower() > known.upper(),
        };
        let is_less = self.found.as_ref().is_none_or(|(known, _)| is_less(known));
        if is_less {
            self.found = Some((value, point.to_vec()));
        }
        is_less
    }

    /// A little less than what is found, by a share; `None` where nothing is found that limits it, but for gain and phase margins.
    fn asked(&self, gap: &Rational) -> Result<Option<AskedOfAll>, Error> {
        let level = self.level;
        let value = match (&self.found, level) {
            (Some((value, _)), _) if level.is_greatest_best() => value.lower().clone(),
            (Some((value, _)), _) => value.upper().clone(),
            (None, Level::GainMargin) => Rational::from(FAR_FACTOR),
            (None, Level::PhaseMargin) => Rational::from(FAR_ANGLE),
            (None, _) => return Ok(None),
        };
        let worst = if level == Level::GainMargin { Rational::ONE } else { Rational::ZERO };
        let size = (&value - &worst) * gap;
        if !size.sign().is_gt() {
            return Ok(None);
        }
        let size = if level.is_greatest_best() { -size } else { size };
        let half = Rational::new(1.into(), 2.into());
        let [far, near] = [&value + &size, &value + &(&size * &half)];
        let [low, high] = if far < near { [far, near] } else { [near, far] };
        let goal = short_between(&low, &high);
        Ok(Some(match level {
            Level::PhaseMargin => {
                let cosine = twice_cosine([&low, &high]);
                let degrees = level.enclosure(&Enclosure::from_rational(cosine.clone()), BITS).expect("an angle");
                AskedOfAll {
                    requirement: Requirement::phase_margin_by_cosine(&cosine)?,
                    proved: short_below(degrees.lower()),
                }
            }
            Level::GainMargin => AskedOfAll { requirement: Requirement::gain_margin(&goal)?, proved: goal },
            Level::DelayMargin => AskedOfAll { requirement: Requirement::delay_margin(goal.clone())?, proved: goal },
            Level::ModulusMargin => {
                AskedOfAll { requirement: Requirement::modulus_margin(goal.clone())?, proved: goal }
            }
            Level::ComplementaryPeak => {
                AskedOfAll { requirement: Requirement::complementary_peak(goal.clone())?, proved: goal }
            }
            Level::DiskMargin => AskedOfAll { requirement: Requirement::disk_margin(goal.clone())?, proved: goal },
            Level::Decay | Level::Radius | Level::Damping | Level::Norm => return Ok(None),
        }))
    }
}

/// Twice the cosine of an angle between two others, in degrees.
fn twice_cosine([least, greatest]: [&Rational; 2]) -> Rational {
    let [mut low, mut high] = Level::PhaseMargin.scale();
    loop {
        let middle = low.midpoint(&high);
        let degrees =
            Level::PhaseMargin.enclosure(&Enclosure::from_rational(middle.clone()), BITS).expect("an angle is finite");
        // The angle falls with its cosine.
        if degrees.lower() > greatest {
            low = middle;
        } else if degrees.upper() < least {
            high = middle;
        } else {
            return middle;
        }
    }
}

/// A number of few digits between two others.
fn short_between(low: &Rational, high: &Rational) -> Rational {
    let middle = low.midpoint(high);
    let rounded = (1..).map(|digits| parse_number(&to_decimal(&middle, digits)).expect("a decimal"));
    rounded.into_iter().find(|x| low < x && x < high).expect("it is nearer to the middle with each digit")
}

/// A number of few digits that is a little less than a positive one.
fn short_below(x: &Rational) -> Rational {
    // By more than what rounding to so many digits adds.
    let share = Rational::new(9_999.into(), 10_000.into());
    parse_number(&to_decimal(&(x * &share), DIGITS)).expect("a decimal")
}
