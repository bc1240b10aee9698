//! What a requirement on margins asks along the circle, of coefficients that are known in a box of parameters.
//!
//! Along the circle, `y = 2 - 2 cos(omega T)` from 0 to 4, a crossing of the open loop is a zero of one polynomial, and whether the
//! requirement allows it is told by the signs of others. Pieces of `y` on each of which there is no crossing, or only such as are
//! allowed, prove that the requirement is met, however crossings appear and vanish; a sign that changes where none is allowed proves that
//! it is not. So nothing is cut where a discriminant or a resultant vanishes that means nothing.

use super::affine::{Affine, AlongCircle, Patch};
use super::requirement::Rule;
use crate::stability::subdivision::{BoxPart, Halves, Look, Order, Tally, subdivide};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, UniPoly};

/// A coefficient of the open loop as a function of the parameters in a box.
pub(super) trait Coefficient: Clone {
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, n: &Integer) -> Self;
    /// Whether it is zero in the whole box.
    fn is_zero(&self) -> bool;
    /// Near what linear function of coordinates from -1 to 1 it is.
    fn affine(&self) -> Affine;
}

/// So many pieces of the circle are looked at, of a requirement for one interval of the parameter.
const MOST_PIECES: usize = 240;

/// A piece is halved so often at most: what is slow beside the sample time is near to 0.
const MOST_HALVINGS: u32 = 72;

/// Where it is known that not all points of a box are seen to meet the requirement, so many pieces more are looked at for a crossing that
/// none of them allows.
const MOST_HOPELESS: usize = 96;

/// So many shorter pieces of one on which no crossing is allowed are looked at for one.
const MOST_SHORTER: usize = 48;

/// What a requirement asks along the circle, for one interval of the parameter.
pub(super) struct Asked {
    /// The polynomial in `y` that is zero at a crossing; none where each frequency counts.
    crossing: Option<AlongCircle>,
    /// The polynomials that tell whether a crossing is allowed.
    signs: Vec<AlongCircle>,
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
    /// The polynomial of crossings has this sign.
    None(Sign),
    Allowed,
    Forbidden,
    Unknown,
}

impl Asked {
    /// That a polynomial in `y` is positive.
    pub fn positive<C: Coefficient>(p: &[C]) -> Asked {
        Asked::new(None, vec![p.to_vec()], Allows::Positive)
    }

    /// The polynomials in `y` for which the requirement asks, of the open loop's denominator and of its numerator without a factor, which
    /// comes with it: where a gain is zero all frequencies would be crossings, and none of them matters.
    pub fn of<C: Coefficient>(rule: &Rule, d: &[C], (bare, factor): (&[C], &C), alpha: &C) -> Asked {
        let sum = |p: &[C], q: &[C]| -> Vec<C> {
            let at = |p: &[C], k: usize| p.get(k).cloned();
            let both = |k| match (at(p, k), at(q, k)) {
                (Some(x), Some(y)) => x.plus(&y),
                (Some(x), None) | (None, Some(x)) => x,
                (None, None) => unreachable!("one list is so long"),
            };
            (0..p.len().max(q.len())).map(both).collect()
        };
        let times = |p: &[C], c: &C| -> Vec<C> { p.iter().map(|x| x.times(c)).collect() };
        let scaled = |p: &[C], c: &Integer| -> Vec<C> { p.iter().map(|x| x.scaled(c)).collect() };
        let n = &times(bare, factor)[..];
        let two = Integer::from(2);
        // Twice the squares of the moduli.
        let (below, twice_real) = (twice_real(d, d), twice_real(n, d));
        match rule {
            Rule::Factors(_) => {
                // 2 |D|^2 + k 2 Re(N conj D) at both ends of the factors.
                let signs = [sum(&times(&below, alpha), &twice_real), sum(&below, &times(&twice_real, alpha))];
                // With an integrator the open loop is infinite at y = 0: nothing crosses there.
                let has_integrator = d.first().is_some_and(C::is_zero);
                Asked::new(Some(imaginary(bare, d)), signs.into(), Allows::Same { at_zero: !has_integrator })
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
                Asked::new(None, vec![excess], Allows::Positive)
            }
            _ => {
                let above = self::twice_real(n, n);
                let excess = sum(&above, &scaled(&below, &-Integer::ONE));
                let sign = sum(&scaled(&twice_real, &two), &times(&above, alpha));
                Asked::new(Some(excess), vec![sign], Allows::Positive)
            }
        }
    }

    /// Of polynomials given by coefficients of powers of `y`. They are divided by powers of `y`, which is positive: with integrators they vanish
    /// at 0. Signs that are compared with each other are divided by the same power, so that one that vanishes at 0 alone is seen there.
    fn new<C: Coefficient>(mut crossing: Option<Vec<C>>, mut signs: Vec<Vec<C>>, rule: Allows) -> Asked {
        let zeros = |p: &Vec<C>| p.iter().take_while(|c| c.is_zero()).count().min(p.len() - 1);
        let common = signs.iter().map(zeros).min().unwrap_or(0);
        signs.iter_mut().for_each(|p| drop(p.drain(..common)));
        if let Some(p) = &mut crossing {
            p.drain(..zeros(p));
        }
        // Sums of patches are taken term by term: all have as many coefficients.
        let length = crossing.iter().chain(&signs).map(Vec::len).max().unwrap_or(0);
        let along = |p: Vec<C>| AlongCircle::new(p, length);
        Asked { crossing: crossing.map(along), signs: signs.into_iter().map(along).collect(), rule }
    }
}

/// Twice the real part of `p` times the conjugate of `q` on the circle, both given by their coefficients in `w = z - 1`, as a polynomial
/// in `y`: as `w` and its conjugate have the sum `-y` and the product `y`, the sums of their powers follow from one another.
pub(super) fn twice_real<C: Coefficient>(p: &[C], q: &[C]) -> Vec<C> {
    paired(p, q, [Integer::from(2), Integer::ZERO], [Integer::ZERO, -Integer::ONE], false)
}

/// The imaginary part divided by that of `w`.
fn imaginary<C: Coefficient>(p: &[C], q: &[C]) -> Vec<C> {
    paired(p, q, [Integer::ZERO, Integer::ZERO], [Integer::ONE, Integer::ZERO], true)
}

/// The sum of `p_i q_j y^min(i, j) s_|i - j|`, where `s_0` and `s_1` are linear in `y` and `s_k = -y (s_(k-1) + s_(k-2))`; with the other sign
/// for `i < j` if asked for.
fn paired<C: Coefficient>(p: &[C], q: &[C], zeroth: [Integer; 2], first: [Integer; 2], is_odd: bool) -> Vec<C> {
    let most = p.len().max(q.len());
    let mut sums = vec![UniPoly::new(zeroth.to_vec()), UniPoly::new(first.to_vec())];
    let minus_y = UniPoly::new(vec![Integer::ZERO, -Integer::ONE]);
    for k in 2..most {
        let next = minus_y.times(&sums[k - 1].plus(&sums[k - 2]));
        sums.push(next);
    }
    let mut out = vec![p[0].scaled(&Integer::ZERO); 2 * most];
    // Of a square both products of two different coefficients are the same.
    let is_square = std::ptr::eq(p, q) && !is_odd;
    for (i, x) in p.iter().enumerate() {
        for (j, y) in q.iter().enumerate().filter(|(j, _)| !is_square || *j <= i) {
            let product = x.times(y);
            let product = if is_square && j < i { product.scaled(&Integer::from(2)) } else { product };
            for (k, c) in sums[i.abs_diff(j)].coeffs().iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                let c = if is_odd && i < j { -c.clone() } else { c.clone() };
                let at = i.min(j) + k;
                out[at] = out[at].plus(&product.scaled(&c));
            }
        }
    }
    while out.len() > 1 && out.last().is_some_and(C::is_zero) {
        out.pop();
    }
    out
}

/// The polynomials on a piece of the circle.
struct Cell {
    ends: [Rational; 2],
    halvings: u32,
    crossing: Option<Patch>,
    signs: Vec<Patch>,
}

impl Cell {
    /// The lower end alone.
    fn lower_end(&self) -> Cell {
        let [lower, _] = &self.ends;
        Cell {
            ends: [lower.clone(), lower.clone()],
            halvings: self.halvings,
            crossing: self.crossing.as_ref().map(Patch::first),
            signs: self.signs.iter().map(Patch::first).collect(),
        }
    }

    fn is_blurred(&self) -> bool {
        self.crossing.iter().chain(&self.signs).any(Patch::is_blurred)
    }
}

impl Halves for Cell {
    fn halves(self, axis: usize) -> [Cell; 2] {
        let [lower, upper] = self.ends;
        let middle = lower.midpoint(&upper);
        let crossing = self.crossing.map(|f| f.halves(axis));
        let signs: Vec<[Patch; 2]> = self.signs.into_iter().map(|g| g.halves(axis)).collect();
        [[lower, middle.clone()], [middle, upper]]
            .into_iter()
            .enumerate()
            .map(|(k, ends)| Cell {
                ends,
                halvings: self.halvings + 1,
                crossing: crossing.as_ref().map(|both| both[k].clone()),
                signs: signs.iter().map(|both| both[k].clone()).collect(),
            })
            .collect::<Vec<_>>()
            .try_into()
            .unwrap_or_else(|_| unreachable!("two halves"))
    }
}

/// A piece of the circle on which a crossing is not allowed, or not known to be.
struct Piece {
    lower: Rational,
    upper: Rational,
    crossing: Crossing,
}

impl Asked {
    /// Whether the requirement is met throughout, or nowhere; `None` where that is not seen.
    pub fn certain(&self) -> Option<bool> {
        let four = Rational::from(4);
        if let Allows::Same { at_zero } = self.rule {
            for end in [Some(&Rational::ZERO).filter(|_| at_zero), Some(&four)].into_iter().flatten() {
                match self.allowed(&Cell { crossing: None, ..self.cell(&[end.clone(), end.clone()], 0) }) {
                    Crossing::Allowed => {}
                    Crossing::Forbidden => return Some(false),
                    Crossing::None(_) | Crossing::Unknown => return None,
                }
            }
        }
        let mut pieces: Vec<Piece> = Vec::new();
        // The number of the look that showed that not all points of the box meet the requirement, or that this is not seen.
        let mut hopeless = None;
        let look = |cell: &mut Cell, tally: Tally| {
            let most = hopeless.map_or(MOST_PIECES, |first| MOST_PIECES.min(first + MOST_HOPELESS));
            if tally.looks() >= most {
                return Ok(Look::Open(None));
            }
            if cell.is_blurred() {
                *cell = self.cell(&cell.ends, cell.halvings);
            }
            let here = self.told(cell);
            if here == Crossing::Forbidden && self.crossing.is_none() {
                return Ok(Look::Open(Some(false)));
            }
            if here == Crossing::Unknown && cell.halvings < MOST_HALVINGS {
                if hopeless.is_none() && self.told(&cell.lower_end()) == Crossing::Unknown {
                    hopeless = Some(tally.looks());
                }
                return Ok(Look::Cut(0));
            }
            let [lower, upper] = cell.ends.clone();
            pieces.push(Piece { lower, upper, crossing: here });
            Ok(Look::Decided(()))
        };
        let whole = self.cell(&[Rational::ZERO, four], 0);
        let all = subdivide([whole], Order::Breadth, &Budget::unlimited(), look);
        if let Ok(Err(Some(is_met))) = all {
            return Some(is_met);
        }
        pieces.sort_by(|a, b| a.lower.cmp(&b.lower));
        if self.is_forbidden(&pieces) {
            return Some(false);
        }
        let is_allowed = |piece: &Piece| match piece.crossing {
            Crossing::None(_) | Crossing::Allowed => true,
            Crossing::Forbidden => self.has_no_zero(piece),
            Crossing::Unknown => false,
        };
        (matches!(all, Ok(Ok(_))) && pieces.iter().all(is_allowed)).then_some(true)
    }

    fn cell(&self, ends: &[Rational; 2], halvings: u32) -> Cell {
        let on = |p: &AlongCircle| p.on(ends.each_ref());
        let (crossing, signs) = (self.crossing.as_ref().map(on), self.signs.iter().map(on).collect());
        Cell { ends: ends.clone(), halvings, crossing, signs }
    }

    /// What is known of crossings on a piece.
    fn told(&self, cell: &Cell) -> Crossing {
        match cell.crossing.as_ref().and_then(Patch::sign) {
            Some(sign) => Crossing::None(sign),
            None => self.allowed(cell),
        }
    }

    /// Whether a sign of the polynomial of crossings changes over neighbouring pieces that all forbid one.
    fn is_forbidden(&self, pieces: &[Piece]) -> bool {
        let Some(crossing) = &self.crossing else { return false };
        let at = |y: &Rational| crossing.on([y, y]).sign();
        // The sign on one side of pieces that forbid a crossing, and where they end.
        let mut before: Option<(Sign, &Rational)> = None;
        for piece in pieces {
            let here = before.filter(|(_, end)| *end == &piece.lower).map(|(sign, _)| sign);
            before = match piece.crossing {
                Crossing::None(sign) if here.is_some_and(|before| before != sign) => return true,
                Crossing::None(sign) => Some((sign, &piece.upper)),
                Crossing::Forbidden => {
                    let sign = here.or_else(|| at(&piece.lower));
                    if sign.is_some() && at(&piece.upper).is_some_and(|after| Some(after) != sign) {
                        return true;
                    }
                    sign.map(|sign| (sign, &piece.upper))
                }
                Crossing::Allowed | Crossing::Unknown => None,
            };
        }
        false
    }

    /// Whether a crossing is allowed on a piece, if there is one; without a polynomial of crossings, whether all is.
    fn allowed(&self, cell: &Cell) -> Crossing {
        let sign = |g: &Patch| g.sign_beside(cell.crossing.as_ref());
        let signs = cell.signs.iter().map(sign).collect::<Option<Vec<Sign>>>();
        match (signs.as_deref(), self.rule) {
            (None | Some([]), _) => Crossing::Unknown,
            (Some([first, ..]), Allows::Positive) if first.is_gt() => Crossing::Allowed,
            (Some([first, rest @ ..]), Allows::Same { .. }) if rest.iter().all(|s| s == first) => Crossing::Allowed,
            _ => Crossing::Forbidden,
        }
    }

    /// Whether shorter pieces show that there is no crossing; where each frequency counts, there is one.
    fn has_no_zero(&self, piece: &Piece) -> bool {
        let Some(crossing) = &self.crossing else { return false };
        let look = |part: &mut BoxPart, tally: Tally| {
            let [lower, upper] = &part.sides[0];
            Ok(match crossing.on([lower, upper]).sign() {
                _ if tally.looks() >= MOST_SHORTER => Look::Open(()),
                Some(_) => Look::Decided(()),
                None => Look::Cut(0),
            })
        };
        let whole = BoxPart::whole([[piece.lower.clone(), piece.upper.clone()]]);
        matches!(subdivide([whole], Order::Depth, &Budget::unlimited(), look), Ok(Ok(_)))
    }
}
