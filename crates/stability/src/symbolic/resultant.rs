//! The resultant of the half-size pair as a polynomial in the parameter whose coefficients are enclosed, not expanded in the
//! symbols: they would have too many terms.

use super::basis::Unexpanded;
use super::count::common_roots;
use super::interpolation::{coefficients_of, likely_scale};
use super::pair::Pair;
use crate::precisions::{ENDS_OF_DETERMINANT, RESULTANT_OF_FACE};
use crate::{HalfSizePair, Shape};
use jurist_algebra::ball::{Ball, enclosed_resultant};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::modular::multimodular_resultant::resultant_multimodular_multivariate;
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::real::Origin;
use jurist_algebra::symbols::{EnclosedPoly, Symbols, common_scale};
use std::sync::Arc;

/// The resultant of the pair in the parameter (variable 0), up to the sign and without the coefficients at either end that are
/// zero.
#[derive(Debug)]
pub(super) struct PairResultant {
    /// By degree in the unknown of the pair, then by degree in the parameter.
    a: Vec<Vec<MultiPoly>>,
    b: Vec<Vec<MultiPoly>>,
    pair: Arc<Pair>,
    symbols: Arc<Symbols>,
    /// The orders of the first and the last coefficient that are not zero.
    low: usize,
    high: usize,
    /// The parameter is about a power of two with this exponent where the loop changes.
    scale: i64,
    /// What it is a resultant of.
    name: &'static str,
}

impl PairResultant {
    /// Finds out which coefficients at the ends are zero.
    ///
    /// At the value 0 of the parameter the resultant is zero at least as many times as the pair has common roots there, since
    /// so much less is the rank of Sylvester's matrix. As many coefficients are zero, then; that the next one is not is seen
    /// from its enclosure. The same holds for the coefficients of the highest powers of the parameter, infinity being a root
    /// where both polynomials of the pair lose degree. Other such ends follow from the degrees of the coefficients, if these fall or
    /// rise with the power of the unknown: in each product of the determinant the powers have the same sum.
    ///
    /// Curves that are tangent at an end have more coefficients that are zero: these are seen where the resultant is multiplied out, if it is not too long.
    ///
    /// Where zeros are looked for in a bounded range, the highest powers may have coefficients that are zero for no reason that is known: they stay.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where coefficients seem to be zero for no such reason.
    pub fn new(
        pair: &Arc<Pair>,
        symbols: &Arc<Symbols>,
        is_bounded: bool,
        budget: &Budget,
    ) -> Result<PairResultant, Exhausted> {
        let split = |list: &[MultiPoly]| -> Vec<Vec<MultiPoly>> {
            let part = |c: &MultiPoly| c.map_variables(|i| i.saturating_sub(1));
            list.iter().map(|p| p.as_poly_in(0).coeffs().iter().map(part).collect()).collect()
        };
        let (a, b) = (split(&pair.a), split(&pair.b));
        let [least, greatest] = [false, true].map(|is_high| Face::of(&a, &b, is_high));
        let high = usize::try_from(greatest.bound).unwrap_or(0);
        let (pair, symbols) = (Arc::clone(pair), Arc::clone(symbols));
        let name = "resultant of the half-size pair";
        let mut out = PairResultant { a, b, pair, symbols, low: 0, high, scale: 0, name };
        out.scale =
            budget.enter(|| likely_scale(out.a.iter().chain(&out.b), &out.symbols, ENDS_OF_DETERMINANT.first))?;
        let mut known = None;
        let mut expanded = None;
        let step = "zeros among the coefficients of the resultant";
        let (low, high) = ENDS_OF_DETERMINANT.decide(step, |bits| {
            let all = budget.enter(|| out.coefficients(bits))?;
            let ends = (all.iter().position(|c| !c.contains_zero()), all.iter().rposition(|c| !c.contains_zero()));
            let (Some(first), Some(last)) = ends else { return Ok(None) };
            let last = if is_bounded { high } else { last };
            let is_known = |below: usize, above: usize| {
                let is_last_known = is_bounded || last as i64 + above as i64 == greatest.bound;
                first as i64 == -least.bound + below as i64 && is_last_known
            };
            // Common roots are asked for once it is known that it matters.
            let (below, above) = match known {
                Some(known) => known,
                None if is_known(0, 0) => (0, 0),
                None => {
                    let common = |face: &Face| out.common_on(face, budget);
                    *known.insert((common(&least)?, if is_bounded { 0 } else { common(&greatest)? }))
                }
            };
            if is_known(below, above) {
                return Ok::<_, Exhausted>(Some((first, last)));
            }
            let exact = match &expanded {
                Some(exact) => exact,
                None => expanded.insert(out.expanded_ends(budget)?),
            };
            let is_exact = |(low, high): &(usize, usize)| *low == first && (is_bounded || *high == last);
            Ok(exact.filter(|ends| is_exact(ends)).map(|_| (first, last)))
        })?;
        Ok(PairResultant { low, high, ..out })
    }

    /// The same of two other polynomials in an unknown, given by all coefficients for their formal degrees: numbers over the parameter
    /// and the symbols, as in [`Pair`].
    ///
    /// # Errors
    /// As [`PairResultant::new`].
    pub fn of_curves(
        a: Vec<MultiPoly>,
        b: Vec<MultiPoly>,
        symbols: &Arc<Symbols>,
        budget: &Budget,
    ) -> Result<PairResultant, Exhausted> {
        // Whether 0 is a common root is asked first, which it often is.
        let pair = Arc::new(Pair { a, b, region: Shape::LeftHalfPlane });
        Ok(PairResultant { name: "resultant of boundary curves", ..PairResultant::new(&pair, symbols, false, budget)? })
    }

    /// The orders of the first and the last coefficient that are not zero whatever the symbols are, from the resultant that is multiplied out; `None` where it is
    /// too long.
    fn expanded_ends(&self, budget: &Budget) -> Result<Option<(usize, usize)>, Exhausted> {
        let [a, b] = [&self.pair.a, &self.pair.b].map(|list| Poly::new(list.clone()));
        let (m, n) = (self.a.len() - 1, self.b.len() - 1);
        let degree = |list: &[MultiPoly], v: usize| list.iter().map(|c| c.degree_in(v)).max().unwrap_or(0) as usize;
        let points = (0..=self.symbols.len()).try_fold(1_usize, |points, v| {
            points.checked_mul(n * degree(&self.pair.a, v) + m * degree(&self.pair.b, v) + 1)
        });
        if points.is_none_or(|points| points > MOST_POINTS) {
            return Ok(None);
        }
        let found = budget.enter(|| resultant_multimodular_multivariate(&a, m, &b, n))?;
        let orders = |f: &MultiPoly| {
            let all = || f.terms().iter().map(|(monomial, _)| monomial.exponent(0) as usize);
            Some((all().min()?, all().max()?))
        };
        Ok(found.as_ref().and_then(orders))
    }

    /// How many roots the polynomials of a face have in common: so many coefficients of the resultant are zero at its end.
    fn common_on(&self, face: &Face, budget: &Budget) -> Result<usize, Exhausted> {
        let [a, b] = [(&self.a, face.ends[0]), (&self.b, face.ends[1])].map(|(list, end)| face.polynomial(list, end));
        common_degree(a, b, &self.symbols, self.pair.region, budget)
    }

    /// All coefficients.
    fn coefficients(&self, bits: u64) -> Vec<Ball> {
        let entries = self.a.iter().chain(&self.b);
        coefficients_of(entries, &self.symbols, (self.scale, self.high + 1, bits), |values| {
            let (a, b) = values.split_at(self.a.len());
            enclosed_resultant(a, b)
        })
    }
}

impl Unexpanded for PairResultant {
    fn vanishes_at_zero(&self) -> bool {
        self.low > 0
    }
}

impl EnclosedPoly for PairResultant {
    fn enclose(&self, bits: u64) -> Vec<Ball> {
        self.coefficients(bits).drain(self.low..=self.high).map(|c| c.with_bits(bits)).collect()
    }

    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        let (a, b) = (common_scale(&self.pair.a, x), common_scale(&self.pair.b, x));
        Ok(common_degree(a, b, &self.symbols, self.pair.region, budget)? > 0)
    }

    fn origin(&self) -> Origin {
        let symbols =
            (0..self.symbols.len()).map(|i| (self.symbols.names()[i].clone(), self.symbols.definition_text(i)));
        Origin::Function { function: self.name.to_owned(), details: symbols.collect() }
    }
}

/// A resultant is multiplied out from so many values at most.
const MOST_POINTS: usize = 1 << 18;

/// The slopes with which the degrees of coefficients may fall with the power of the unknown.
const SLOPES: std::ops::RangeInclusive<i64> = -4..=4;

/// A bound of the degree of the resultant in the parameter, and how it follows: where the degrees of the coefficients of the powers `i` and
/// `j` of both polynomials, of formal degrees `m` and `n`, are at most `A - w i` and `B - w j`, it is `n A + m B - w m n`, and the
/// coefficient of that power is the resultant of the polynomials made of the extreme coefficients. The same with the signs of all
/// degrees changed for the least power.
struct Face {
    is_high: bool,
    slope: i64,
    /// `A` and `B`.
    ends: [i64; 2],
    bound: i64,
}

impl Face {
    /// The one with the least bound.
    fn of(a: &[Vec<MultiPoly>], b: &[Vec<MultiPoly>], is_high: bool) -> Face {
        let (m, n) = (a.len() as i64 - 1, b.len() as i64 - 1);
        let own = |c: &Vec<MultiPoly>| match is_high {
            true => c.iter().rposition(|p| !p.is_zero()).map(|k| k as i64),
            false => c.iter().position(|p| !p.is_zero()).map(|k| -(k as i64)),
        };
        let with = |slope: i64| {
            let end = |list: &[Vec<MultiPoly>]| {
                let all = list.iter().enumerate().filter_map(|(i, c)| Some(own(c)? + slope * i as i64));
                all.max().unwrap_or(0)
            };
            let ends = [end(a), end(b)];
            Face { is_high, slope, ends, bound: n * ends[0] + m * ends[1] - slope * m * n }
        };
        // That without a slope where others are no better.
        let all = std::iter::once(0).chain(SLOPES).map(with);
        all.reduce(|best, face| if face.bound < best.bound { face } else { best }).expect("there are slopes")
    }

    /// The extreme coefficients.
    fn polynomial(&self, list: &[Vec<MultiPoly>], end: i64) -> Vec<MultiPoly> {
        let coefficient = |(i, c): (usize, &Vec<MultiPoly>)| {
            let power = end - self.slope * i as i64;
            let power = usize::try_from(if self.is_high { power } else { -power });
            power.ok().and_then(|power| c.get(power).cloned()).unwrap_or_default()
        };
        list.iter().enumerate().map(coefficient).collect()
    }
}

/// How many roots, infinity among them, two polynomials have in common, given by their coefficients for the formal degrees.
fn common_degree(
    mut a: Vec<MultiPoly>,
    mut b: Vec<MultiPoly>,
    symbols: &Arc<Symbols>,
    region: Shape,
    budget: &Budget,
) -> Result<usize, Exhausted> {
    let mut found = 0;
    let is_zero = |p: Option<&MultiPoly>| p.map_or(Ok(true), |p| symbols.is_zero(p, budget));
    while a.len() + b.len() > 2 && is_zero(a.last())? && is_zero(b.last())? {
        // A root at infinity, as long as neither has become constant.
        if a.len() == 1 || b.len() == 1 {
            return Ok(found + a.len().max(b.len()) - 1);
        }
        a.pop();
        b.pop();
        found += 1;
    }
    let ends: &[i64] = match region {
        Shape::UnitDisc => &[2, -2],
        Shape::LeftHalfPlane => &[0],
    };
    for &end in ends {
        let at = MultiPoly::constant(Integer::from(end));
        let value = |p: &[MultiPoly]| Poly::new(p.to_vec()).eval(&at);
        while a.len() > 1
            && b.len() > 1
            && symbols.is_zero(&value(&a), budget)?
            && symbols.is_zero(&value(&b), budget)?
        {
            (a, b) = (without_root(&a, &at), without_root(&b, &at));
            found += 1;
        }
    }
    if a.len() + b.len() == 2 {
        return Ok(found);
    }
    for bits in RESULTANT_OF_FACE.bits() {
        let at = |list: &[MultiPoly]| list.iter().map(|p| symbols.enclose(p, bits)).collect::<Vec<Ball>>();
        if !budget.enter(|| enclosed_resultant(&at(&a), &at(&b)))?.contains_zero() {
            return Ok(found);
        }
    }
    let (degree_a, degree_b) = (a.len() - 1, b.len() - 1);
    let pair = HalfSizePair { a: Poly::new(a), b: Poly::new(b), degree_a, degree_b, region };
    let rest = common_roots(&pair, symbols, budget)?.map_or(0, |common| common.coeffs().len() - 1);
    Ok(found + rest)
}

/// The quotient by `x - r`, of a polynomial with the root `r`, its formal degree less by one.
fn without_root(p: &[MultiPoly], r: &MultiPoly) -> Vec<MultiPoly> {
    let mut out = p.to_vec();
    for i in (1..out.len()).rev() {
        out[i - 1] = out[i - 1].plus(&out[i].times(r));
    }
    out.remove(0);
    out
}
