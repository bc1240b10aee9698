//! What a requirement on margins asks along the circle, of coefficients that are known in a box of parameters.
//!
//! Along the circle, `y = 2 - 2 cos(omega T)` from 0 to 4, a crossing of the open loop is a zero of one polynomial, and whether the
//! requirement allows it is told by the signs of others. Pieces of `y` on each of which there is no crossing, or only such as are
//! allowed, prove that the requirement is met, however crossings appear and vanish; a sign that changes where none is allowed proves that
//! it is not. So nothing is cut where a discriminant or a resultant vanishes that means nothing.

use super::affine::{Affine, AlongCircle, Patch};
use super::asked_functions::{Allows, Function, Functions};
use super::on_circle::OnCircle;
use crate::stability::subdivision::{BoxPart, Halves, Look, Order, Tally, subdivide};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational, Sign};

/// A coefficient of the open loop as a function of the parameters in a box.
pub(super) trait Coefficient: Clone {
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, n: &Integer) -> Self;
    /// Whether it is zero in the whole box.
    fn is_zero(&self) -> bool;
}

/// One that is known to be near a linear function.
pub(super) trait NearlyLinear: Coefficient {
    /// Near what linear function of coordinates from -1 to 1 it is.
    fn affine(&self) -> Affine;
}

/// So many pieces of the circle are looked at, of a requirement for one interval of the parameter.
const MOST_PIECES: usize = 240;

/// A piece is halved so often at most: what is slow beside the sample time is near to 0.
const MOST_HALVINGS: u32 = 72;

/// Pieces on which something changes are halved so often.
const CROSSING_HALVINGS: u32 = 36;
const DISTANCE_HALVINGS: u32 = 18;

/// Far below the frequencies up to which is looked a piece is halved until its frequency is this many times as large as it is wide.
const WIDTHS_OF_FREQUENCY: i64 = 1 << 14;

/// Where it is known that not all points of a box are seen to meet the requirement, so many pieces more are looked at for a crossing that
/// none of them allows.
const MOST_HOPELESS: usize = 96;

/// So many shorter pieces of one on which no crossing is allowed are looked at for one.
const MOST_SHORTER: usize = 48;

/// What a requirement asks along the circle, for one interval of the parameter.
pub(super) struct Asked<A> {
    /// The function that is zero at a crossing; none where each frequency counts.
    crossing: Option<A>,
    /// The functions that tell whether a crossing is allowed.
    signs: Vec<A>,
    /// Where both have the same sign, any modulus is allowed.
    upright: Vec<A>,
    /// Where it is positive all crossings are allowed.
    large: Option<A>,
    rule: Allows,
}

/// A function along the boundary of stability, for `y` from 0 to 4, whose values are nearly linear in a box of parameters.
pub(super) trait Along {
    /// The function on a piece.
    type Piece: OnPiece;

    /// The pieces with which a look begins, ascending.
    fn pieces() -> Vec<[Rational; 2]>;

    /// The function on a piece, or at a point where the ends are the same.
    fn on(&self, ends: [&Rational; 2]) -> Self::Piece;

    /// So many pieces are looked at beside the usual ones.
    fn more_pieces(&self) -> usize {
        0
    }
}

/// A function on a piece.
pub(super) trait OnPiece: Halves + Clone {
    /// Its Bernstein coefficients.
    fn patch(&self) -> &Patch;
    /// The value at the lower end.
    fn first(&self) -> Self;
    /// Whether so many digits are lost that the piece is to be computed again.
    fn is_blurred(&self) -> bool;
    /// Whether the piece is too long for its bounds to say anything, even of its end.
    fn is_coarse(&self) -> bool {
        false
    }
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

impl<A: Along> Asked<A> {
    /// Of functions; `along` brings them into the form in which they are looked at, all with as many coefficients.
    pub fn of<C: Coefficient, const N: usize>(
        functions: Functions<C, N>,
        along: impl FnOnce(Vec<Function<C, N>>) -> Vec<A>,
    ) -> Asked<A> {
        let Functions { crossing, signs, upright, large, rule } = functions;
        let (has_crossing, count, is_large_asked) = (crossing.is_some(), signs.len(), large.is_some());
        let mut all = along(crossing.into_iter().chain(signs).chain(upright).chain(large).collect());
        let crossing = has_crossing.then(|| all.remove(0));
        let large = if is_large_asked { all.pop() } else { None };
        let upright = all.split_off(count);
        Asked { crossing, signs: all, upright, large, rule }
    }
}

impl Asked<AlongCircle> {
    /// That a polynomial in `y` is positive.
    pub fn positive<C: NearlyLinear>(p: &[C]) -> Asked<AlongCircle> {
        Asked::of(Functions::new(None, vec![[p.to_vec()]], Allows::Positive), OnCircle::along)
    }
}

/// The polynomials on a piece of the circle.
struct Cell<P> {
    ends: [Rational; 2],
    halvings: u32,
    crossing: Option<P>,
    signs: Vec<P>,
}

impl<P: OnPiece> Cell<P> {
    /// The lower end alone.
    fn lower_end(&self) -> Cell<P> {
        let [lower, _] = &self.ends;
        Cell {
            ends: [lower.clone(), lower.clone()],
            halvings: self.halvings,
            crossing: self.crossing.as_ref().map(P::first),
            signs: self.signs.iter().map(P::first).collect(),
        }
    }

    fn is_blurred(&self) -> bool {
        self.crossing.iter().chain(&self.signs).any(P::is_blurred)
    }

    fn is_coarse(&self) -> bool {
        self.crossing.iter().chain(&self.signs).any(P::is_coarse)
    }
}

impl<P: OnPiece> Halves for Cell<P> {
    fn halves(self, axis: usize) -> [Cell<P>; 2] {
        let [lower, upper] = self.ends;
        let middle = lower.midpoint(&upper);
        let crossing = self.crossing.map(|f| f.halves(axis));
        let signs: Vec<[P; 2]> = self.signs.into_iter().map(|g| g.halves(axis)).collect();
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

impl<A: Along> Asked<A> {
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
        // The steady state is often the same for all gains, and pieces near to it are small.
        let whole = A::pieces();
        let mut ends = whole.first().map(|ends| &ends[0]).into_iter().chain(whole.last().map(|ends| &ends[1]));
        let is_forbidden =
            |end: &Rational| self.told(&self.cell(&[end.clone(), end.clone()], 0)) == Crossing::Forbidden;
        if self.crossing.is_none() && ends.any(is_forbidden) {
            return Some(false);
        }
        let mut pieces: Vec<Piece> = Vec::new();
        // The number of the look that showed that not all points of the box meet the requirement, or that this is not seen.
        let mut hopeless = None;
        let (more, all) = (self.more_pieces(), MOST_PIECES + self.more_pieces());
        let look = |cell: &mut Cell<A::Piece>, tally: Tally| {
            let most = hopeless.map_or(all, |first| all.min(first + MOST_HOPELESS + more));
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
                let is_hopeless = || !cell.is_coarse() && self.told(&cell.lower_end()) == Crossing::Unknown;
                if hopeless.is_none() && is_hopeless() {
                    hopeless = Some(tally.looks());
                }
                return Ok(Look::Cut(0));
            }
            let [lower, upper] = cell.ends.clone();
            pieces.push(Piece { lower, upper, crossing: here });
            Ok(Look::Decided(()))
        };
        let whole: Vec<_> = whole.iter().map(|ends| self.cell(ends, 0)).collect();
        let all = subdivide(whole, Order::Breadth, &Budget::unlimited(), look);
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

    /// Whether the last of the pieces with which a look begins is told as a whole.
    pub fn is_told_last(&self) -> bool {
        A::pieces().last().is_none_or(|ends| self.told(&self.cell(ends, 0)) != Crossing::Unknown)
    }

    /// Where the open loop is real at the lowest and at the highest frequency: whether it is allowed there. Both are, where that is not asked.
    pub fn are_ends_allowed(&self) -> [bool; 2] {
        let Allows::Same { at_zero } = self.rule else { return [true; 2] };
        let is_allowed = |y: Rational| {
            let point = self.cell(&[y.clone(), y], 0);
            self.allowed(&Cell { crossing: None, ..point }) == Crossing::Allowed
        };
        [!at_zero || is_allowed(Rational::ZERO), is_allowed(Rational::from(4))]
    }

    /// The pieces, ascending and not touching, on which a crossing that is not allowed may be; `None` where there are too many.
    pub fn open_pieces(&self) -> Option<Vec<[Rational; 2]>> {
        // The least distance to a circle is looked for where it hardly changes.
        let halvings = if self.crossing.is_some() { CROSSING_HALVINGS } else { DISTANCE_HALVINGS };
        let mut open: Vec<[Rational; 2]> = Vec::new();
        let most = 4 * (MOST_PIECES + self.more_pieces());
        let widths = Rational::from(WIDTHS_OF_FREQUENCY);
        let look = |cell: &mut Cell<A::Piece>, tally: Tally| {
            if tally.looks() >= most {
                return Ok(Look::Open(()));
            }
            if cell.is_blurred() {
                *cell = self.cell(&cell.ends, cell.halvings);
            }
            if !matches!(self.told(cell), Crossing::Unknown | Crossing::Forbidden) {
                return Ok(Look::Decided(()));
            }
            let [lower, upper] = &cell.ends;
            let is_wide = cell.halvings < CROSSING_HALVINGS && &(upper - lower) * &widths > *lower;
            if cell.halvings < halvings || is_wide && !lower.is_zero() {
                return Ok(Look::Cut(0));
            }
            open.push(cell.ends.clone());
            Ok(Look::Decided(()))
        };
        let whole: Vec<_> = A::pieces().iter().map(|ends| self.cell(ends, 0)).collect();
        subdivide(whole, Order::Breadth, &Budget::unlimited(), look).ok()?.ok()?;
        open.sort();
        let mut out: Vec<[Rational; 2]> = Vec::new();
        for [lower, upper] in open {
            match out.last_mut().filter(|last| last[1] == lower) {
                Some(last) => last[1] = upper,
                None => out.push([lower, upper]),
            }
        }
        Some(out)
    }

    /// So many pieces are looked at beside the usual ones.
    fn more_pieces(&self) -> usize {
        self.crossing.iter().chain(&self.signs).map(A::more_pieces).max().unwrap_or(0)
    }

    fn cell(&self, ends: &[Rational; 2], halvings: u32) -> Cell<A::Piece> {
        let on = |p: &A| p.on(ends.each_ref());
        let (crossing, signs) = (self.crossing.as_ref().map(on), self.signs.iter().map(on).collect());
        Cell { ends: ends.clone(), halvings, crossing, signs }
    }

    /// What is known of crossings on a piece.
    fn told(&self, cell: &Cell<A::Piece>) -> Crossing {
        match cell.crossing.as_ref().and_then(|f| f.patch().sign()) {
            Some(sign) => Crossing::None(sign),
            None => match self.allowed(cell) {
                Crossing::Unknown if self.is_upright(&cell.ends) || self.is_large(&cell.ends) => Crossing::Allowed,
                told => told,
            },
        }
    }

    /// Whether on a piece of the lowest frequencies, where the open loop may be large, it is near to a right angle.
    fn is_upright(&self, [lower, upper]: &[Rational; 2]) -> bool {
        let sign = |f: &A| f.on([lower, upper]).patch().sign();
        lower.is_zero() && matches!(self.upright[..], [ref a, ref b] if sign(a).is_some_and(|s| sign(b) == Some(s)))
    }

    /// Whether on a piece the open loop is so large that all crossings are allowed.
    fn is_large(&self, [lower, upper]: &[Rational; 2]) -> bool {
        self.large.as_ref().is_some_and(|f| f.on([lower, upper]).patch().sign().is_some_and(Sign::is_gt))
    }

    /// Whether a sign of the polynomial of crossings changes over neighbouring pieces that all forbid one.
    fn is_forbidden(&self, pieces: &[Piece]) -> bool {
        let Some(crossing) = &self.crossing else { return false };
        let at = |y: &Rational| crossing.on([y, y]).patch().sign();
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
    fn allowed(&self, cell: &Cell<A::Piece>) -> Crossing {
        let zero = cell.crossing.as_ref().map(A::Piece::patch);
        let sign = |g: &A::Piece| g.patch().sign_beside(zero);
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
            Ok(match crossing.on([lower, upper]).patch().sign() {
                _ if tally.looks() >= MOST_SHORTER => Look::Open(()),
                Some(_) => Look::Decided(()),
                None => Look::Cut(0),
            })
        };
        let whole = BoxPart::whole([[piece.lower.clone(), piece.upper.clone()]]);
        matches!(subdivide([whole], Order::Depth, &Budget::unlimited(), look), Ok(Ok(_)))
    }
}
