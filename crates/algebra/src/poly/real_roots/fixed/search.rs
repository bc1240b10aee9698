//! The search for cells with one root: bisection in the Bernstein basis of fixed width, Newton steps
//! on clusters, more bits where a sign is unknown.

use super::limbs::{is_negative, max_bits, rescale, within};
use super::piece::{Bernstein, Cell, Piece};
use super::triangle::{HEADROOM, error_of_halves, fitting_width, split};
use super::variations::{Variations, variations};
use crate::limits::checkpoint;
use crate::number::Integer;

/// Bits kept of the coefficients of a cell with `v` sign variations: `BITS_BASE + BITS_PER_VARIATION v`.
/// More cost time in every triangle, fewer mean that cells are computed anew more often.
const BITS_BASE: u64 = 84;
const BITS_PER_VARIATION: u64 = 3;

/// A cell with fewer certain bits of its largest coefficient is computed anew.
const LEAST_PRECISION: u64 = 12;

/// A Newton step is tried when the variations have not changed for so many halvings.
const HALVINGS_BEFORE_NEWTON: u32 = 10;

/// The first Newton step shrinks a cell by `2^FIRST_ZOOM`.
const FIRST_ZOOM: u64 = 16;

/// Coefficients that lose their bits in fewer halvings than this are computed with twice as many, which are kept as long.
const HALVINGS_TO_LAST: u64 = 8;

/// The unit interval is first computed for so many sign variations.
const FEW_VARIATIONS: usize = 20;

struct Node {
    cell: Cell,
    bernstein: Bernstein,
    variations: Variations,
    /// Whether the polynomial is positive at the lower and the upper end.
    ends: (bool, bool),
    /// Halvings since the variations changed.
    unchanged: u32,
    /// The next Newton step shrinks by `2^zoom`.
    zoom: u64,
    bought: Bought,
}

/// The precision last computed from the polynomial.
#[derive(Clone, Copy)]
struct Bought {
    precision: u64,
    /// The depth of that cell.
    depth: u64,
    /// Whether it was more than the variations ask for, because of that being lost at once.
    more: bool,
}

impl Bought {
    /// The bits to keep of the coefficients of a cell with so many variations.
    fn kept(&self, cell: &Cell, variations: usize) -> u64 {
        let bits = bits_for(variations);
        if self.more && cell.depth() - self.depth < HALVINGS_TO_LAST { bits.max(self.precision) } else { bits }
    }
}

/// A cell with exactly one root, and whether the polynomial is positive at its upper end.
pub struct Found {
    pub cell: Cell,
    pub rising: bool,
}

fn bits_for(variations: usize) -> u64 {
    BITS_BASE + BITS_PER_VARIATION * variations as u64
}

/// The bits of the first coefficients of a polynomial with so many sign variations along the positive axis: most have
/// fewer in the unit interval.
pub fn first_precision(most: usize) -> u64 {
    bits_for(most.min(FEW_VARIATIONS))
}

/// Cells with exactly one root each, ascending, of all roots in the unit interval, given the coefficients there in
/// [`first_precision`].
///
/// A cell whose Bernstein coefficients have no sign variation holds no root, with one it holds
/// exactly one [LaneRiesenfeld1981](crate::bibliography#laneriesenfeld1981). The polynomial must be square-free and without rational roots.
pub fn search(piece: &mut Piece, most: usize, mut bernstein: Bernstein) -> Vec<Found> {
    let mut found = Vec::new();
    let mut stack = Vec::new();
    let cell = Cell::unit();
    let ends = (piece.positive_at(&Integer::ZERO, 0), piece.positive_at(&Integer::ONE, 0));
    let mut precision = first_precision(most);
    let mut variations = counted(&bernstein, ends);
    let wanted = bits_for(variations.most.min(most));
    if variations.most > FEW_VARIATIONS && wanted > precision {
        let hint = bernstein.height as i64 + bernstein.scale;
        precision = wanted;
        bernstein = piece.bernstein(&cell, precision, Some(hint));
        variations = counted(&bernstein, ends);
    }
    let node = Node {
        cell,
        bernstein,
        variations,
        ends,
        unchanged: 0,
        zoom: FIRST_ZOOM,
        bought: Bought { precision, depth: 0, more: false },
    };
    place(node, &mut stack, &mut found);
    while let Some(node) = stack.pop() {
        checkpoint(16);
        step(piece, node, &mut stack, &mut found);
    }
    found.sort_by(|a, b| a.cell.compare(&b.cell));
    found
}

fn counted(b: &Bernstein, ends: (bool, bool)) -> Variations {
    variations(&b.flat, b.limbs, b.error, ends.0, ends.1)
}

/// Settles a cell or leaves it for later.
fn place(node: Node, stack: &mut Vec<Node>, found: &mut Vec<Found>) {
    match node.variations.most {
        0 => {}
        1 => found.push(Found { cell: node.cell, rising: node.ends.1 }),
        _ => stack.push(node),
    }
}

fn step(piece: &mut Piece, mut node: Node, stack: &mut Vec<Node>, found: &mut Vec<Found>) {
    if node.bernstein.precision() < LEAST_PRECISION {
        // More bits if the last ones did not last.
        let depth = node.cell.depth();
        let last = node.bought;
        let fresh = bits_for(node.variations.most);
        let more = depth - last.depth < HALVINGS_TO_LAST;
        let kept = if last.more { last.precision } else { 0 };
        let precision = fresh.max(if more { 2 * kept.max(fresh) } else { kept / 2 });
        let hint = node.bernstein.height as i64 + node.bernstein.scale;
        node.bernstein = piece.bernstein(&node.cell, precision, Some(hint));
        node.variations = counted(&node.bernstein, node.ends);
        node.bought = Bought { precision, depth, more };
        place(node, stack, found);
        return;
    }
    let v = node.variations;
    if node.unchanged >= HALVINGS_BEFORE_NEWTON && v.least == v.most {
        if let Some(zoomed) = newton(piece, &node) {
            stack.push(zoomed);
            return;
        }
        node.zoom = (node.zoom / 2).max(FIRST_ZOOM / 2);
        node.unchanged = 0;
    }
    halve(piece, node, stack, found);
}

/// Both halves, from one triangle.
fn halve(piece: &mut Piece, node: Node, stack: &mut Vec<Node>, found: &mut Vec<Found>) {
    let Node { cell, mut bernstein, variations: v, ends, unchanged, zoom, bought } = node;
    let limbs = bernstein.limbs;
    let mut left = vec![0; bernstein.flat.len()];
    let mut right = vec![0; bernstein.flat.len()];
    split(&mut bernstein.flat, limbs, &mut left, &mut right);
    let error = error_of_halves(bernstein.error, piece.degree());
    let (lower, upper) = cell.halves();
    let middle = if within(&right[..limbs], error) {
        piece.positive_at(&upper.lo, upper.bits)
    } else {
        !is_negative(&right[..limbs])
    };
    let halves = [(upper, right, (middle, ends.1)), (lower, left, (ends.0, middle))];
    let counts: Vec<Variations> =
        halves.iter().map(|(_, flat, ends)| variations(flat, limbs, error, ends.0, ends.1)).collect();
    for (k, (cell, flat, ends)) in halves.into_iter().enumerate() {
        let variations = counts[k];
        if variations.most == 0 {
            continue;
        }
        let bernstein = if variations.most == 1 {
            Bernstein { flat: Vec::new(), limbs, error, height: 0, scale: 0 }
        } else {
            trimmed(&flat, limbs, error, bernstein.scale, bought.kept(&cell, variations.most))
        };
        let same = variations.most == v.most && counts[1 - k].most == 0;
        let unchanged = if same { unchanged + 1 } else { 0 };
        place(Node { cell, bernstein, variations, ends, unchanged, zoom, bought }, stack, found);
    }
}

/// The coefficients shifted and shortened to the bits that are certain and wanted.
fn trimmed(flat: &[u64], limbs: usize, error: u64, scale: i64, wanted: u64) -> Bernstein {
    let height = max_bits(flat, limbs);
    let doubt = u64::from(64 - error.leading_zeros());
    let bits = height.saturating_sub(doubt).min(wanted) + 8;
    let to = fitting_width((bits + HEADROOM).div_ceil(64) as usize).min(limbs);
    // At most as many bits as there is room for, and the error small enough for its type.
    let target = (64 * to as u64 - HEADROOM).min(bits + 24);
    let shift = height as i64 - target as i64;
    let error = if shift >= 0 { (error >> shift.min(63)) + 2 } else { error << shift.unsigned_abs() };
    let flat = rescale(flat, limbs, to, shift);
    Bernstein { flat, limbs: to, error, height: target.min(height.saturating_add_signed(-shift)), scale: scale + shift }
}

/// A Newton step for a cluster of `v` roots: a cell `2^zoom` times smaller with as many sign
/// variations, so that there is none in the rest (subdivision never increases their number
/// [Schoenberg1934](crate::bibliography#schoenberg1934)). `None` if the guess is wrong. The zoom is squared for the next step.
/// The idea is that of [Sagraloff2012](crate::bibliography#sagraloff2012).
fn newton(piece: &mut Piece, node: &Node) -> Option<Node> {
    let b = &node.bernstein;
    let v = node.variations.most;
    // The guess is no better than the coefficients.
    let zoom = node.zoom.min(b.precision().saturating_sub(v as u64 + 8));
    if zoom < FIRST_ZOOM / 2 {
        return None;
    }
    let guess = cluster(b, v, zoom + 1)?;
    let last = &(&Integer::ONE << (zoom + 1)) - &Integer::from(2);
    let j = (&guess - &Integer::ONE).max(Integer::ZERO).min(last);
    let cell = if node.cell.lo.is_zero() && j.is_one() {
        node.cell.zoomed(&Integer::ZERO, zoom)
    } else {
        node.cell.zoomed(&j, zoom + 1)
    };
    let low = piece.positive_at(&cell.lo, cell.bits);
    let high = piece.positive_at(&cell.hi(), cell.bits);
    // For the next step twice the zoom.
    let precision = 4 * zoom + bits_for(v);
    let hint = b.height as i64 + b.scale - (zoom * v as u64) as i64;
    let bernstein = piece.bernstein(&cell, precision, Some(hint));
    let variations = counted(&bernstein, (low, high));
    if variations.least < v {
        return None;
    }
    let bought = Bought { precision, depth: cell.depth(), more: false };
    let unchanged = node.unchanged;
    Some(Node { cell, bernstein, variations, ends: (low, high), unchanged, zoom: 2 * zoom, bought })
}

/// The place of a cluster of `v` roots in the cell, times `2^bits`, seen from both ends alike: a
/// polynomial near `(t - r)^v` has `v p / p' = t - r`.
fn cluster(b: &Bernstein, v: usize, bits: u64) -> Option<Integer> {
    let n = b.flat.len() / b.limbs - 1;
    let at = |i: usize| Integer::from_twos_complement(&b.flat[i * b.limbs..(i + 1) * b.limbs]);
    let distance = |end: Integer, next: Integer| {
        let slope = &(&end - &next) * &Integer::from(n);
        let scaled = &(&end * &Integer::from(v)) << bits;
        (!slope.is_zero()).then(|| scaled.div_mod_floor(&slope).0)
    };
    let one = &Integer::ONE << bits;
    let from_left = distance(at(0), at(1))?;
    let from_right = distance(at(n), at(n - 1))?;
    let disagreement = (&(&from_left + &from_right) - &one).abs();
    if from_left.is_negative() || from_right.is_negative() || &disagreement << 6 > one {
        return None;
    }
    Some(if from_left < from_right { from_left } else { one - from_right })
}
