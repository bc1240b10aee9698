//! The roots of a polynomial as one parameter moves, branch by branch.

use super::assignment::cheapest_assignment;
use super::fixed::rational_from_f64;
use super::roots::roots;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use nalgebra::Complex;

/// How the parameter runs through its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ParameterScale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in its logarithm; needs both ends of the range on the same side of 0.
    Logarithmic,
}

/// Range and fineness of a locus.
#[derive(Clone, Debug)]
pub struct LocusOptions {
    /// First parameter value.
    pub lower: Rational,
    /// Last parameter value.
    pub upper: Rational,
    /// How the parameter runs.
    pub scale: ParameterScale,
    /// Where the picture is magnified (1 in discrete time, 0 in continuous time): near it steps
    /// shrink in proportion to the distance.
    pub focus: Complex<f64>,
    /// Values that must be among the samples, e.g. the exact crossings.
    pub through: Vec<Rational>,
    /// Where the picture ends: roots further from `focus` move in as large steps as they like.
    pub reach: f64,
}

/// The roots at one parameter value, the k-th belonging to the k-th branch.
#[derive(Clone, Debug)]
pub struct LocusSample {
    /// The parameter, exactly.
    pub parameter: Rational,
    /// The roots.
    pub roots: Vec<Complex<f64>>,
}

/// One root's way.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Parameter (rounded) and position.
    pub points: Vec<(f64, Complex<f64>)>,
}

/// A point of the stability boundary, from the certified answer, to be drawn on a locus.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The parameter there, rounded.
    pub parameter: f64,
    /// Points on the boundary (upper half) where roots are: on the unit circle or imaginary axis.
    pub at: Vec<Complex<f64>>,
    /// What the picture says there, e.g. `K_pwm = 550.94, 1664 Hz`.
    pub label: String,
}

/// A root locus: pieces without gaps, each a list of samples in the parameter's order.
///
/// A piece ends where the polynomial is undefined or loses degree.
#[derive(Clone, Debug, Default)]
pub struct RootLocus {
    /// The pieces.
    pub pieces: Vec<Vec<LocusSample>>,
}

/// Intervals of the first, even grid.
const FIRST_INTERVALS: usize = 48;

/// How often an interval of the grid may be halved; a meeting point of two roots is then located
/// to 2^-14 of it, and their exchange there is invisible.
const DEEPEST: u32 = 14;

/// A root may move by this share of its distance to the nearest other root: below one half the
/// pairing of old and new roots is beyond doubt.
const SHARE_OF_SEPARATION: f64 = 0.3;

/// A root may move by this share of its distance from the focus,
const SHARE_OF_DISTANCE: f64 = 0.08;

/// and by this share of the reach at most.
const SHARE_OF_REACH: f64 = 0.02;

/// Steps and separations of this share of the reach are not looked into.
const FINEST_STEP: f64 = 1e-9;

impl RootLocus {
    /// The branches, piece by piece.
    pub fn branches(&self) -> Vec<Branch> {
        let mut branches = Vec::new();
        for piece in &self.pieces {
            let count = piece.first().map_or(0, |s| s.roots.len());
            for k in 0..count {
                let points = piece.iter().map(|s| (s.parameter.to_f64_approximate(), s.roots[k])).collect();
                branches.push(Branch { points });
            }
        }
        branches
    }

    /// All samples, in the parameter's order.
    pub fn samples(&self) -> impl Iterator<Item = &LocusSample> {
        self.pieces.iter().flatten()
    }

    /// A table: the parameter, then real and imaginary part of every branch; pieces follow each other.
    pub fn to_csv(&self, parameter: &str) -> String {
        let count = self.samples().map(|s| s.roots.len()).max().unwrap_or(0);
        let mut out = parameter.to_string();
        for k in 1..=count {
            out.push_str(&format!(",re_{k},im_{k}"));
        }
        out.push('\n');
        for sample in self.samples() {
            out.push_str(&sample.parameter.to_f64_approximate().to_string());
            for root in &sample.roots {
                out.push_str(&format!(",{},{}", root.re, root.im));
            }
            out.push('\n');
        }
        out
    }
}

/// Follows the roots of `polynomial(value)` over the range.
///
/// The polynomial is taken exactly at every sample, so the roots are right to plotting accuracy also
/// where they cluster. `None` from `polynomial` (undefined there) and a degree below the largest one
/// seen make a gap. Steps are halved until the pairing of neighbours is unambiguous and the moves are
/// smooth in the picture. The pairing minimises the sum of squared distances.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::{Integer, Rational};
/// use jurist_algebra::poly::UniPoly;
/// use jurist_draw::simulate::{LocusOptions, ParameterScale, trace_root_locus};
/// let options = LocusOptions {
///     lower: Rational::from(0),
///     upper: Rational::from(4),
///     scale: ParameterScale::Linear,
///     focus: nalgebra::Complex::new(0.0, 0.0),
///     through: vec![],
///     reach: 3.0,
/// };
/// // z^2 + 2 z + k: two real roots meet at -1 for k = 1.
/// let of = |k: &Rational| Some(UniPoly::new(vec![k.numerator(), Integer::from(2) * k.denominator(), k.denominator()]));
/// let locus = trace_root_locus(of, &options, &Budget::unlimited()).unwrap();
/// let end = locus.samples().last().unwrap();
/// assert!((end.roots[0].im.abs() - 3f64.sqrt()).abs() < 1e-12);
/// ```
pub fn trace_root_locus(
    polynomial: impl Fn(&Rational) -> Option<UniPoly>,
    options: &LocusOptions,
    budget: &Budget,
) -> Result<RootLocus, Exhausted> {
    let mut grid: Vec<Rational> = (0..=FIRST_INTERVALS).map(|i| options.value_at(i)).collect();
    grid.extend(options.through.iter().filter(|v| **v >= options.lower && **v <= options.upper).cloned());
    grid.sort();
    grid.dedup();
    let polynomials: Vec<Option<UniPoly>> = grid.iter().map(&polynomial).collect();
    let degree = polynomials.iter().flatten().filter_map(UniPoly::degree).max().unwrap_or(0);
    let tracer = Tracer { polynomial: &polynomial, options, degree, budget };
    let mut locus = RootLocus::default();
    let mut piece: Vec<LocusSample> = Vec::new();
    budget.step("following the roots");
    for (i, (value, p)) in grid.iter().zip(&polynomials).enumerate() {
        budget.advance(i as u64, grid.len() as u64);
        let Some(sample) = p.as_ref().and_then(|p| tracer.sample(value, p)) else {
            locus.pieces.extend((!piece.is_empty()).then(|| std::mem::take(&mut piece)));
            continue;
        };
        if piece.is_empty() {
            piece.push(sample);
        } else if !tracer.bridge(&mut piece, sample.clone(), 0)? {
            locus.pieces.push(std::mem::replace(&mut piece, vec![sample]));
        }
    }
    locus.pieces.extend((!piece.is_empty()).then_some(piece));
    Ok(locus)
}

impl LocusOptions {
    /// The i-th value of the first grid.
    fn value_at(&self, i: usize) -> Rational {
        match i {
            0 => return self.lower.clone(),
            FIRST_INTERVALS => return self.upper.clone(),
            _ => {}
        }
        let share = Rational::new((i as u64).into(), (FIRST_INTERVALS as u64).into());
        let (a, b) = (self.lower.to_f64_approximate(), self.upper.to_f64_approximate());
        if self.is_logarithmic() {
            let position = i as f64 / FIRST_INTERVALS as f64;
            let magnitude = (a.abs().ln() * (1.0 - position) + b.abs().ln() * position).exp();
            return rational_from_f64(magnitude * a.signum(), 24);
        }
        &self.lower + &((&self.upper - &self.lower) * share)
    }

    fn is_logarithmic(&self) -> bool {
        let (a, b) = (self.lower.to_f64_approximate(), self.upper.to_f64_approximate());
        self.scale == ParameterScale::Logarithmic && a * b > 0.0 && (a / b).is_finite()
    }

    /// Between two values: their mean, geometric on a logarithmic scale; always strictly between.
    fn between(&self, a: &Rational, b: &Rational) -> Rational {
        if self.is_logarithmic() {
            let (x, y) = (a.to_f64_approximate(), b.to_f64_approximate());
            let middle = rational_from_f64((x * y).sqrt() * x.signum(), 40);
            if &middle > a && &middle < b {
                return middle;
            }
        }
        a.midpoint(b)
    }
}

struct Tracer<'a, F> {
    polynomial: &'a F,
    options: &'a LocusOptions,
    degree: usize,
    budget: &'a Budget,
}

impl<F: Fn(&Rational) -> Option<UniPoly>> Tracer<'_, F> {
    /// The roots at a value; `None` where the degree is not full.
    fn sample(&self, value: &Rational, p: &UniPoly) -> Option<LocusSample> {
        if p.degree() != Some(self.degree) {
            return None;
        }
        let mut list = Vec::with_capacity(self.degree);
        for root in roots(p) {
            list.extend(std::iter::repeat_n(root.value, root.multiplicity));
        }
        list.iter().all(|z| z.is_finite()).then(|| LocusSample { parameter: value.clone(), roots: list })
    }

    /// Appends samples up to and including `next` to the piece, in branch order; `false` at a gap.
    fn bridge(&self, piece: &mut Vec<LocusSample>, next: LocusSample, depth: u32) -> Result<bool, Exhausted> {
        self.budget.check()?;
        let Some(last) = piece.last() else { return Ok(false) };
        let ordered = follow(&last.roots, &next.roots);
        if depth >= DEEPEST || self.is_smooth(&last.roots, &ordered) {
            piece.push(LocusSample { parameter: next.parameter, roots: ordered });
            return Ok(true);
        }
        let middle = self.options.between(&last.parameter, &next.parameter);
        match (self.polynomial)(&middle).and_then(|p| self.sample(&middle, &p)) {
            Some(sample) => Ok(self.bridge(piece, sample, depth + 1)? && self.bridge(piece, next, depth + 1)?),
            None => Ok(false),
        }
    }

    fn is_smooth(&self, old: &[Complex<f64>], new: &[Complex<f64>]) -> bool {
        let o = self.options;
        let finest = FINEST_STEP * o.reach;
        (0..old.len()).all(|i| {
            let moved = (new[i] - old[i]).norm();
            // Roots that go together may be exchanged: nobody sees it.
            let is_other = |&j: &usize| j != i && [old, new].iter().any(|list| (list[j] - list[i]).norm() > finest);
            let others = |list: &[Complex<f64>]| {
                (0..list.len()).filter(is_other).map(|j| (list[j] - list[i]).norm()).fold(f64::INFINITY, f64::min)
            };
            let separation = others(old).min(others(new));
            let distance = (old[i] - o.focus).norm().min((new[i] - o.focus).norm());
            if distance > 2.0 * o.reach {
                return moved <= 0.5 * distance;
            }
            moved <= (SHARE_OF_SEPARATION * separation).max(finest)
                && moved <= (SHARE_OF_DISTANCE * distance).min(SHARE_OF_REACH * o.reach).max(1e-6 * o.reach)
        })
    }
}

/// `new` in the order that continues `old`.
fn follow(old: &[Complex<f64>], new: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let cost: Vec<Vec<f64>> =
        old.iter().map(|a| new.iter().map(|b| (a - b).norm_sqr().min(f64::MAX.sqrt())).collect()).collect();
    cheapest_assignment(&cost).into_iter().map(|j| new[j]).collect()
}
