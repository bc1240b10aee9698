//! Whether requirements on margins are met for all values of a parameter in an interval at once.
//!
//! Along the circle, `y = 2 - 2 cos(omega T)` from 0 to 4, a crossing of the open loop is a zero of one polynomial, and whether the
//! requirement allows it is told by the signs of others. Pieces of `y` on each of which there is no crossing, or only such as are
//! allowed, prove that the requirement is met, however crossings appear and vanish; a sign that changes where none is allowed proves that
//! it is not. So nothing is cut where a discriminant or a resultant vanishes that means nothing.

use super::family::Quotient;
use super::requirement::Rule;
use crate::stability::Shape;
use crate::stability::subdivision::{BoxPart, Look, Order, Tally, subdivide};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::symbols::MovingSymbols;

/// Terms of the Taylor polynomials in the parameter.
const TERMS: usize = 3;

/// Bits, beside those that the interval's width takes away.
const BITS: u64 = 256;

/// So many pieces of the circle are looked at, of a requirement for one interval of the parameter.
const MOST_PIECES: usize = 240;

/// A piece is halved so often at most: what is slow beside the sample time is near to 0.
const MOST_HALVINGS: u32 = 72;

/// So many shorter pieces of one on which no crossing is allowed are looked at for one.
const MOST_SHORTER: usize = 48;

/// What a requirement asks along the circle, for one interval of the parameter.
struct Asked {
    /// The polynomial in `y` that is zero at a crossing; none where each frequency counts.
    crossing: Option<Vec<Ball>>,
    /// The polynomials that tell whether a crossing is allowed.
    signs: Vec<Vec<Ball>>,
    rule: Allows,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Allows {
    /// A crossing is allowed where the sign is positive.
    Positive,
    /// It is where both signs are the same; the open loop is real at both ends of the circle, if it is finite at `y = 0`.
    Same { at_zero: bool },
}

/// What is known of a crossing on a piece.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Crossing {
    Allowed,
    Forbidden,
    Unknown,
}

/// One requirement on an open loop over a parameter and symbols.
pub(super) struct OverBoxes {
    symbols: MovingSymbols,
    /// The coefficients of the denominator and of the numerator in `z - 1`, the number that is asked for, and what must not vanish.
    functions: Vec<MultiPoly>,
    /// How many are the denominator's, and the numerator's.
    sizes: [usize; 2],
    asked: Rule,
}

impl OverBoxes {
    /// `None` in continuous time, and for a requirement of another kind. `symbols` has the number that is asked for as the last one.
    pub fn new(
        quotient: &Quotient<MultiPoly>,
        undefined: &MultiPoly,
        asked: &Rule,
        symbols: MovingSymbols,
    ) -> Option<OverBoxes> {
        let is_known = matches!(asked, Rule::Turned { .. } | Rule::Factors(_) | Rule::Circle(_));
        if quotient.shape != Shape::UnitDisc || !is_known {
            return None;
        }
        let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
        let parts = [&quotient.denominator, &quotient.numerator].map(|p| p.compose(&one_more).into_coeffs());
        let sizes = [parts[0].len(), parts[1].len()];
        let mut functions: Vec<MultiPoly> = parts.into_iter().flatten().collect();
        functions.extend([MultiPoly::variable(symbols.len()), undefined.clone()]);
        Some(OverBoxes { symbols, functions, sizes, asked: asked.clone() })
    }

    /// Whether the requirement is met by all stable loops of a closed interval of the parameter, or by none; `None` where that is not
    /// seen.
    ///
    /// Cost: Taylor polynomials of the coefficients, and values on some hundred pieces of the circle.
    pub fn certain(&self, lower: &Rational, upper: &Rational) -> Option<bool> {
        let width = upper - lower;
        let small = width.denominator().bit_length().saturating_sub(width.numerator().bit_length());
        let bits = BITS + small.min(1 << 12);
        let taylor: Vec<Share> = if width.is_zero() {
            let balls = self.symbols.enclose(&self.functions, &Ball::from_rational(lower, bits))?;
            balls.into_iter().map(|c| Share(vec![c])).collect()
        } else {
            let taylor = self.symbols.taylor_from_end(&self.functions, lower, upper, TERMS, bits)?;
            taylor.into_iter().map(Share).collect()
        };
        let (d, rest) = taylor.split_at(self.sizes[0]);
        let (n, rest) = rest.split_at(self.sizes[1]);
        let [alpha, undefined] = rest else { return None };
        if undefined.range().contains_zero() {
            return None;
        }
        self.asked(d, n, alpha).certain(bits)
    }

    /// The polynomials in `y` for which the requirement asks.
    fn asked(&self, d: &[Share], n: &[Share], alpha: &Share) -> Asked {
        let sum = |p: &[Share], q: &[Share]| -> Vec<Share> {
            let at = |p: &[Share], k: usize| p.get(k).cloned();
            let both = |k| match (at(p, k), at(q, k)) {
                (Some(x), Some(y)) => x.plus(&y),
                (Some(x), None) | (None, Some(x)) => x,
                (None, None) => unreachable!("one list is so long"),
            };
            (0..p.len().max(q.len())).map(both).collect()
        };
        let times = |p: &[Share], c: &Share| -> Vec<Share> { p.iter().map(|x| x.times(c)).collect() };
        let scaled = |p: &[Share], c: &Integer| -> Vec<Share> { p.iter().map(|x| x.scaled(c)).collect() };
        let ranges = |p: Vec<Share>| -> Vec<Ball> { p.iter().map(Share::range).collect() };
        let two = Integer::from(2);
        // Twice the squares of the moduli.
        let (below, twice_real) = (twice_real(d, d), twice_real(n, d));
        match &self.asked {
            Rule::Factors(_) => {
                // 2 |D|^2 + k 2 Re(N conj D) at both ends of the factors.
                let signs = [sum(&times(&below, alpha), &twice_real), sum(&below, &times(&twice_real, alpha))];
                // With an integrator the open loop is infinite at y = 0: nothing crosses there, and y divides the imaginary part.
                let has_integrator = d.first().is_some_and(Share::is_zero);
                let mut crossing = imaginary(n, d);
                if has_integrator {
                    let zeros = crossing.iter().take_while(|c| c.is_zero()).count();
                    crossing.drain(..zeros.min(crossing.len() - 1));
                }
                Asked {
                    crossing: Some(ranges(crossing)),
                    signs: signs.map(ranges).into(),
                    rule: Allows::Same { at_zero: !has_integrator },
                }
            }
            Rule::Circle(circle) => {
                let all = sum(d, n);
                let combined = match circle.combined().map(Integer::from) {
                    [u, v] if v.is_zero() => scaled(d, &u),
                    [u, v] if u.is_zero() => scaled(n, &v),
                    [u, v] => sum(&scaled(d, &u), &scaled(n, &v)),
                };
                let [p, q] = [circle.least().numerator(), circle.least().denominator()];
                let [whole, part] = [self::twice_real(&all, &all), self::twice_real(&combined, &combined)];
                let excess = sum(&scaled(&whole, &(&q * &q)), &scaled(&part, &-(&p * &p)));
                Asked { crossing: None, signs: vec![ranges(excess)], rule: Allows::Positive }
            }
            _ => {
                let above = self::twice_real(n, n);
                let excess = sum(&above, &scaled(&below, &-Integer::ONE));
                let sign = sum(&scaled(&twice_real, &two), &times(&above, alpha));
                Asked { crossing: Some(ranges(excess)), signs: vec![ranges(sign)], rule: Allows::Positive }
            }
        }
    }
}

/// So many intervals are asked of all requirements at once.
const MOST_BOXES: usize = 96;

/// Values between two numbers, and whether all requirements are met by all of them, or not all by any; `None` where that is not seen.
pub(super) type Segment = (Rational, Rational, Option<bool>);

/// The whole interval as segments, ascending; neighbours differ in what is known.
pub(super) fn segments(
    boxes: &[OverBoxes],
    lower: &Rational,
    upper: &Rational,
    budget: &Budget,
) -> Result<Vec<Segment>, Exhausted> {
    budget.step("requirements for intervals of the parameter");
    let mut all: Vec<Segment> = Vec::new();
    let look = |part: &mut BoxPart, tally: Tally| {
        budget.advance(tally.looks() as u64, MOST_BOXES as u64);
        let [lo, hi] = &part.sides[0];
        let is_last = tally.looks() >= MOST_BOXES;
        let found = if is_last { None } else { budget.enter(|| certain(boxes, lo, hi))? };
        if found.is_none() && !is_last {
            return Ok(Look::<(), ()>::Cut(0));
        }
        all.push((lo.clone(), hi.clone(), found));
        Ok(Look::Decided(()))
    };
    let whole = BoxPart::whole([[lower.clone(), upper.clone()]]);
    subdivide([whole], Order::Breadth, budget, look)?.ok();
    all.sort_by(|a, b| a.0.cmp(&b.0));
    let mut out: Vec<Segment> = Vec::new();
    for (lo, hi, is_met) in all {
        match out.last_mut().filter(|last| last.2 == is_met) {
            Some(last) => last.1 = hi,
            None => out.push((lo, hi, is_met)),
        }
    }
    Ok(out)
}

/// Whether all requirements are met by all values of a closed interval, or not all by any.
pub(super) fn certain(boxes: &[OverBoxes], lower: &Rational, upper: &Rational) -> Option<bool> {
    let mut all = !boxes.is_empty();
    for of in boxes {
        match of.certain(lower, upper) {
            Some(false) => return Some(false),
            Some(true) => {}
            None => all = false,
        }
    }
    all.then_some(true)
}

/// A function of the share `u` of an interval, from 0 to 1: a polynomial, whose last coefficient holds what is left out.
#[derive(Clone)]
struct Share(Vec<Ball>);

impl Share {
    fn plus(&self, other: &Share) -> Share {
        Share(self.0.iter().zip(&other.0).map(|(x, y)| x.add(y)).collect())
    }

    fn scaled(&self, n: &Integer) -> Share {
        Share(self.0.iter().map(|c| c.scaled(n)).collect())
    }

    /// Higher powers of the share are numbers from 0 to 1 times the last one.
    fn times(&self, other: &Share) -> Share {
        let last = self.0.len() - 1;
        let bits = self.0[0].bits();
        let less = Ball::between(&Rational::ZERO, &Rational::ONE, bits);
        let mut out = vec![Ball::zero(bits); last + 1];
        for (i, x) in self.0.iter().enumerate() {
            for (j, y) in other.0.iter().enumerate() {
                let product = x.mul(y);
                let product = if i + j > last { product.mul(&less) } else { product };
                let k = (i + j).min(last);
                out[k] = out[k].add(&product);
            }
        }
        Share(out)
    }

    fn is_zero(&self) -> bool {
        self.0.iter().all(|c| c.sign().is_some_and(Sign::is_eq))
    }

    fn range(&self) -> Ball {
        let bits = self.0[0].bits();
        let share = Ball::between(&Rational::ZERO, &Rational::ONE, bits);
        self.0.iter().rev().fold(Ball::zero(bits), |sum, c| sum.mul(&share).add(c))
    }
}

/// Twice the real part of `p` times the conjugate of `q` on the circle, both given by their coefficients in `w = z - 1`, as a polynomial
/// in `y`: as `w` and its conjugate have the sum `-y` and the product `y`, the sums of their powers follow from one another.
fn twice_real(p: &[Share], q: &[Share]) -> Vec<Share> {
    paired(p, q, [Integer::from(2), Integer::ZERO], [Integer::ZERO, -Integer::ONE], false)
}

/// The imaginary part divided by that of `w`.
fn imaginary(p: &[Share], q: &[Share]) -> Vec<Share> {
    paired(p, q, [Integer::ZERO, Integer::ZERO], [Integer::ONE, Integer::ZERO], true)
}

/// The sum of `p_i q_j y^min(i, j) s_|i - j|`, where `s_0` and `s_1` are linear in `y` and `s_k = -y (s_(k-1) + s_(k-2))`; with the other sign
/// for `i < j` if asked for.
fn paired(p: &[Share], q: &[Share], zeroth: [Integer; 2], first: [Integer; 2], is_odd: bool) -> Vec<Share> {
    let most = p.len().max(q.len());
    let mut sums = vec![UniPoly::new(zeroth.to_vec()), UniPoly::new(first.to_vec())];
    let minus_y = UniPoly::new(vec![Integer::ZERO, -Integer::ONE]);
    for k in 2..most {
        let next = minus_y.times(&sums[k - 1].plus(&sums[k - 2]));
        sums.push(next);
    }
    let mut out = vec![p[0].scaled(&Integer::ZERO); 2 * most];
    for (i, x) in p.iter().enumerate() {
        for (j, y) in q.iter().enumerate() {
            let product = x.times(y);
            for (k, c) in sums[i.abs_diff(j)].coeffs().iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                let c = if is_odd && i < j { -c.clone() } else { c.clone() };
                let at = i.min(j) + k;
                out[at] = out[at].plus(&product.scaled(&c));
            }
        }
    }
    while out.len() > 1 && out.last().is_some_and(Share::is_zero) {
        out.pop();
    }
    out
}

/// A piece of the circle.
struct Piece {
    lower: Rational,
    upper: Rational,
    crossing: Crossing,
}

impl Asked {
    fn certain(&self, bits: u64) -> Option<bool> {
        let crossing = self.crossing.as_deref();
        let signs: Vec<&[Ball]> = self.signs.iter().map(Vec::as_slice).collect();
        let four = Rational::from(4);
        if let Allows::Same { at_zero } = self.rule {
            for end in [Some(&Rational::ZERO).filter(|_| at_zero), Some(&four)].into_iter().flatten() {
                match self.allowed(&signs, &Ball::from_rational(end, bits)) {
                    Crossing::Allowed => {}
                    Crossing::Forbidden => return Some(false),
                    Crossing::Unknown => return None,
                }
            }
        }
        let mut pieces: Vec<Piece> = Vec::new();
        let look = |part: &mut BoxPart, tally: Tally| {
            if tally.looks() >= MOST_PIECES {
                return Ok(Look::Open(()));
            }
            let [lower, upper] = &part.sides[0];
            let y = Ball::between(lower, upper, bits);
            if crossing.is_some_and(|c| sign_on(c, &y).is_some()) {
                return Ok(Look::Decided(()));
            }
            let here = self.allowed(&signs, &y);
            if here == Crossing::Unknown && part.halvings[0] < MOST_HALVINGS {
                return Ok(Look::Cut(0));
            }
            if here != Crossing::Allowed {
                pieces.push(Piece { lower: lower.clone(), upper: upper.clone(), crossing: here });
            }
            Ok(Look::Decided(()))
        };
        let whole = BoxPart::whole([[Rational::ZERO, four]]);
        let all = subdivide([whole], Order::Depth, &Budget::unlimited(), look);
        let is_open = !matches!(all, Ok(Ok(_))) || pieces.iter().any(|piece| piece.crossing == Crossing::Unknown);
        let is_met = !is_open && pieces.iter().all(|piece| has_no_zero(crossing, piece, bits));
        if is_met {
            return Some(true);
        }
        self.is_forbidden(crossing, pieces, bits).then_some(false)
    }

    /// Whether somewhere on pieces of which each forbids a crossing there is one.
    fn is_forbidden(&self, crossing: Option<&[Ball]>, pieces: Vec<Piece>, bits: u64) -> bool {
        let mut run: Option<(Rational, Rational)> = None;
        let mut runs = Vec::new();
        for piece in pieces.into_iter().filter(|piece| piece.crossing == Crossing::Forbidden) {
            match &mut run {
                Some((_, end)) if *end == piece.lower => *end = piece.upper,
                _ => runs.extend(run.replace((piece.lower, piece.upper))),
            }
        }
        runs.extend(run);
        let Some(crossing) = crossing else { return !runs.is_empty() };
        let sign = |x: &Rational| sign_on(crossing, &Ball::from_rational(x, bits));
        runs.iter().any(|(lo, hi)| matches!((sign(lo), sign(hi)), (Some(a), Some(b)) if a != b))
    }

    fn allowed(&self, signs: &[&[Ball]], y: &Ball) -> Crossing {
        let signs: Option<Vec<Sign>> = signs.iter().map(|p| sign_on(p, y)).collect();
        match (signs.as_deref(), self.rule) {
            (None | Some([]), _) => Crossing::Unknown,
            (Some([first, ..]), Allows::Positive) if first.is_gt() => Crossing::Allowed,
            (Some([first, rest @ ..]), Allows::Same { .. }) if rest.iter().all(|s| s == first) => Crossing::Allowed,
            _ => Crossing::Forbidden,
        }
    }
}

/// Whether shorter pieces show that there is no crossing; where each frequency counts, there is one.
fn has_no_zero(crossing: Option<&[Ball]>, piece: &Piece, bits: u64) -> bool {
    let Some(crossing) = crossing else { return false };
    let look = |part: &mut BoxPart, tally: Tally| {
        let [lower, upper] = &part.sides[0];
        Ok(match sign_on(crossing, &Ball::between(lower, upper, bits)) {
            _ if tally.looks() >= MOST_SHORTER => Look::Open(()),
            Some(_) => Look::Decided(()),
            None => Look::Cut(0),
        })
    };
    let whole = BoxPart::whole([[piece.lower.clone(), piece.upper.clone()]]);
    matches!(subdivide([whole], Order::Depth, &Budget::unlimited(), look), Ok(Ok(_)))
}

/// The sign of a polynomial on an interval, from its Taylor polynomial in the middle.
fn sign_on(p: &[Ball], y: &Ball) -> Option<Sign> {
    let bits = y.bits();
    let (middle, radius) =
        (y.lower().midpoint(&y.upper()), (y.upper() - y.lower()) * Rational::dyadic(&Integer::ONE, 1));
    let (middle, radius) = (Ball::from_rational(&middle, bits), Ball::from_rational(&radius, bits));
    let mut c = p.to_vec();
    for i in 0..c.len() {
        for j in (i..c.len().saturating_sub(1)).rev() {
            c[j] = c[j].add(&c[j + 1].mul(&middle));
        }
    }
    let share = Ball::between(&-Rational::ONE, &Rational::ONE, bits);
    let mut power = radius.clone();
    let mut sum = c.first()?.clone();
    for c in &c[1..] {
        sum = sum.add(&c.mul(&power).mul(&share));
        power = power.mul(&radius);
    }
    sum.sign().filter(|s| s.is_ne())
}
