//! The open loop as functions of parameters, in the form in which it is asked along the circle.

use super::affine::AlongCircle;
use super::along_axis::{AlongAxis, Turn};
use super::along_circle::{Asked, NearlyLinear};
use super::asked_functions::Functions;
use super::family::Quotient;
use super::on_axis::OnAxis;
use super::on_circle::OnCircle;
use super::requirement::Rule;
use super::taylor_along::of_octave;
use crate::coverage::refusals::ONE_FACTOR;
use crate::error::Error;
use crate::model::Symbols;
use crate::stability::Shape;
use jurist_algebra::ball::{Ball, Elementary, MultiTaylorModel};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic};

/// What a requirement asks of an open loop in parameters, as polynomials in these and in symbols.
#[derive(Clone)]
pub(super) struct LoopFunctions {
    /// The coefficients of the denominator and of the numerator without its content, that content, the number that is asked for, and what must
    /// not vanish. In discrete time the coefficients are those in `w = z - 1`: what cancels at `z = 1` is seen in symbols.
    pub all: Vec<MultiPoly>,
    /// How many are the denominator's, and the numerator's.
    sizes: [usize; 2],
    rule: Rule,
    /// Whether the open loop has a dead time: its numerator and denominator are the last functions.
    has_dead_time: bool,
}

/// Values of all functions, in their places.
pub(super) struct Values<'v, C> {
    pub denominator: &'v [C],
    pub numerator: &'v [C],
    pub content: &'v C,
    pub alpha: &'v C,
    undefined: &'v C,
    /// The numerator and the denominator of the dead time.
    pub dead_time: Option<[&'v C; 2]>,
}

impl LoopFunctions {
    /// Of an open loop, which may have a factor with dead time beside the quotient; `alpha` is the number that is asked for.
    pub fn new(
        (quotient, dead_time): (&Quotient<MultiPoly>, Option<&RationalFunction>),
        undefined: &MultiPoly,
        rule: &Rule,
        alpha: MultiPoly,
    ) -> LoopFunctions {
        let content = quotient.numerator.content();
        let numerator = quotient.numerator.map(|c| c.div_exact(&content).expect("the content divides"));
        let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
        let parts = [&quotient.denominator, &numerator].map(|p| match quotient.shape {
            Shape::UnitDisc => p.compose(&one_more).into_coeffs(),
            Shape::LeftHalfPlane => p.coeffs().to_vec(),
        });
        let sizes = [parts[0].len(), parts[1].len()];
        let time = dead_time.into_iter().flat_map(|t| [t.numerator().clone(), t.denominator().clone()]);
        let all = parts.into_iter().flatten().chain([content, alpha, undefined.clone()]).chain(time).collect();
        LoopFunctions { all, sizes, rule: rule.clone(), has_dead_time: dead_time.is_some() }
    }

    /// Whether the open loop has a dead time.
    pub fn has_dead_time(&self) -> bool {
        self.has_dead_time
    }

    /// The coefficients of the denominator.
    pub fn denominator(&self) -> &[MultiPoly] {
        &self.all[..self.sizes[0]]
    }

    /// What is asked along the circle, of all functions' values in a box; `on_circle` brings both polynomials there. `None` where the loop may be
    /// undefined.
    pub fn asked<C: NearlyLinear>(
        &self,
        values: &[C],
        on_circle: impl Fn([&[C]; 2]) -> [Vec<C>; 2],
    ) -> Option<Asked<AlongCircle>> {
        let Values { denominator, numerator, content, alpha, .. } = self.values(values)?;
        let [d, n] = on_circle([denominator, numerator]);
        Some(Asked::of(Functions::of(&self.rule, &OnCircle::new(d, n, content), alpha), OnCircle::along))
    }

    /// Whether the requirement is met at all points of a box, or at none, of an open loop with dead time; `octave` is that of a frequency beyond which the
    /// open loop is small enough in whatever direction it points. Where it is not in this box, a higher one is taken.
    pub fn certain_on_axis(&self, values: &[MultiTaylorModel], octave: i64) -> Option<bool> {
        let (asked, _) = self.asked_on_axis(values, octave)?;
        asked.certain()
    }

    /// The octave of a frequency beyond which the open loop is small enough in a box, from a known one on; `None` where there is none.
    pub fn octave_from(&self, values: &[MultiTaylorModel], octave: i64) -> Option<i64> {
        self.asked_up_to(values, octave, MOST_AT_FIRST).map(|(_, octave)| octave)
    }

    /// What is asked along the axis, and the octave of the frequency up to which it is asked in full.
    pub fn asked_on_axis(&self, values: &[MultiTaylorModel], octave: i64) -> Option<(Asked<AlongAxis>, i64)> {
        self.asked_up_to(values, octave, MOST_OCTAVES)
    }

    fn asked_up_to(&self, values: &[MultiTaylorModel], octave: i64, most: u64) -> Option<(Asked<AlongAxis>, i64)> {
        let Values { denominator, numerator, content, alpha, dead_time, .. } = self.values(values)?;
        let [above, below] = dead_time?;
        let time = above.div(below)?;
        let degree = denominator.len().max(numerator.len()) - 1;
        let [d, n] = [denominator, numerator].map(|p| of_octave(p, octave, degree));
        let unit = Ball::from_integer(&Integer::ONE, time.bits()).shifted(octave);
        let time = time.mul(&time.constant(&unit));
        let products = OnAxis::new(&d, &n, content);
        (0..most).find_map(|more| {
            let turn = Turn::new(&time.scaled(&(Integer::ONE << more)).affine());
            let functions = Functions::of(&self.rule, &products, alpha);
            let asked = Asked::of(functions, |all| OnAxis::along(all, more, turn));
            asked.is_told_last().then_some((asked, octave + more as i64))
        })
    }

    /// The values in their places; `None` where the loop may be undefined.
    fn values<'v, C: NearlyLinear>(&self, values: &'v [C]) -> Option<Values<'v, C>> {
        let values = self.split(values)?;
        values.undefined.affine().sign()?;
        Some(values)
    }

    /// The values in their places.
    pub fn split<'v, C>(&self, values: &'v [C]) -> Option<Values<'v, C>> {
        let (denominator, rest) = values.split_at(self.sizes[0]);
        let (numerator, rest) = rest.split_at(self.sizes[1]);
        let [content, alpha, undefined, time @ ..] = rest else { return None };
        let dead_time = if let [above, below] = time { Some([above, below]) } else { None };
        Some(Values { denominator, numerator, content, alpha, undefined, dead_time })
    }

    /// What is required.
    pub fn rule(&self) -> &Rule {
        &self.rule
    }
}

/// The frequency beyond which nothing turns that matters is raised by so many octaves at most: at the first point, and from there.
const MOST_AT_FIRST: u64 = 40;
const MOST_OCTAVES: u64 = 12;

/// The number that a rule asks for; zero where that is part of the rule.
pub(super) fn number_asked(rule: &Rule) -> RealAlgebraic {
    match rule {
        Rule::Turned { twice_cosine } => twice_cosine.clone(),
        Rule::Factors(factor) => factor.clone(),
        _ => RealAlgebraic::from_rational(Rational::ZERO),
    }
}

/// The dead time of the one factor of an open loop that has it, which is divided away; `None` of a loop without.
///
/// # Errors
/// Refused where the dead time is elsewhere.
pub(super) fn dead_time(
    quotient: &mut Quotient<MultiPoly>,
    undefined: &MultiPoly,
    symbols: &Symbols,
) -> Result<Option<RationalFunction>, Error> {
    let delays = symbols.delays();
    if delays.is_empty() {
        return Ok(None);
    }
    let mut total = RationalFunction::zero();
    let mut factor = MultiPoly::one();
    for (variable, time) in &delays {
        let powers = quotient.numerator.coeffs().iter().flat_map(MultiPoly::terms).map(|(m, _)| m.exponent(*variable));
        for _ in 0..powers.min().unwrap_or(0) {
            total = &total + time;
            factor = factor.times(&MultiPoly::variable(*variable));
        }
    }
    quotient.numerator = quotient.numerator.map(|c| c.div_exact(&factor).expect("each term has the factor"));
    let all = quotient.numerator.coeffs().iter().chain(quotient.denominator.coeffs()).chain([undefined]);
    let has_delay = |p: &MultiPoly| delays.iter().any(|(variable, _)| p.degree_in(*variable) > 0);
    if all.into_iter().any(has_delay) {
        return Err(ONE_FACTOR.diagnostic(&[]).into());
    }
    Ok(Some(total))
}
