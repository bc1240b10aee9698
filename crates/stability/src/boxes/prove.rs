//! The proof that a whole box is stable.

use super::line::{along, rational_zero};
use super::look::{BoxLook, MOST_CORNERS};
use super::multiplier::{Sought, affine_multiplier};
use super::parts::{corners, middle};
use super::polynomial::{BoxPolynomial, Bundle, Excluded};
use super::reason::OpenReason;
use super::separate::separating_vector_within;
use super::tensor::{FrequencyScale, Tensor};
use super::tree::{Node, Tree};
use crate::subdivision::{Halves, Look, Order, Tally, subdivide};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::algebraic::simplest_between;

/// More Bernstein coefficients of a pair than this are refused: 32 bytes each, for each cell that waits.
pub const MOST_COEFFICIENTS: usize = 1 << 20;

/// Cells that wait may take so many bytes together.
const WAITING_BYTES: usize = 1 << 29;

/// After so many cells a point of the present one is tested.
const TESTED_EVERY: usize = 64;

/// After so many nodes vectors that are affine in a cell are tried, in cells halved so often.
const AFFINE_AFTER: (usize, u32) = (48, 6);

/// Where coefficients are off by more than this no such vector is tried: products with it are to fit.
const GREATEST_ERROR: i128 = 1 << 60;

/// Parts of each side in which a cell that stays open is tested.
const PARTS: i64 = 8;

/// Points at which a polynomial is stationary are looked for among so many parameters at most.
const MOST_STATIONARY: usize = 6;

/// A cell is not halved more often than this: the error of the coefficients would swallow them.
const MOST_HALVINGS: u32 = 160;

/// Why a box is stable.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BoxProof {
    /// For each divisor, the constant and the leading coefficient: a tree whose cells have one sign.
    pub certain: Vec<Tree>,
    /// Frequencies are cut on `v = 4^scale t / (1 - t)`, `t` from 0 to 1, `v` the square of the frequency; of a requirement the frequency
    /// itself on `2^scale t / (1 - t)`.
    pub scale: i64,
    /// The second polynomial of the pair counts times two to this.
    pub weight: i64,
    /// Cells of frequency and parameters without a zero of the pair.
    pub pair: Tree,
    /// Cells that are not in the tree: of loops with functions of parameters, with dead time, and of what is told by signs.
    pub beside: usize,
}

impl BoxProof {
    /// A proof by so many cells that are not kept.
    pub fn of_cells(scale: i64, beside: usize) -> BoxProof {
        BoxProof { certain: Vec::new(), scale, weight: 0, pair: Tree::default(), beside }
    }

    /// The proof of a box of one name by the stable set of its line: the box is in one cell.
    pub fn of_line() -> BoxProof {
        BoxProof::of_cells(0, 1)
    }

    /// Whether all cells are in the trees.
    pub fn is_in_trees(&self) -> bool {
        self.beside == 0
    }

    /// The number of cells of frequency and parameters.
    pub fn cells(&self) -> usize {
        self.pair.leaves() + self.beside
    }
}

/// What is known of a box.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// Every point is stable.
    Stable(BoxProof),
    /// On the way from the nominal point to this one stability is lost.
    Refuted(Vec<Rational>),
    /// Not decided with so many cells; the box of the cell that was looked at last.
    Open {
        /// What ran out.
        why: OpenReason,
        /// The cell.
        cell: Vec<[Rational; 2]>,
    },
}

/// A cell of the search.
pub(super) struct Cell {
    pub tensor: Tensor,
    /// The part of each axis, frequency last: the `at`-th of `2^halvings`.
    pub place: Vec<(Integer, u32)>,
}

impl Cell {
    pub fn whole(tensor: Tensor) -> Cell {
        let place = vec![(Integer::ZERO, 0); tensor.axes()];
        Cell { tensor, place }
    }

    /// The part of an axis as shares from 0 to 1.
    pub fn part(&self, axis: usize) -> [Rational; 2] {
        let (at, halvings) = &self.place[axis];
        [at.clone(), at + &Integer::ONE].map(|k| Rational::dyadic(&k, u64::from(*halvings)))
    }

    /// The box of the parameters.
    pub fn sides(&self, whole: &[[Rational; 2]]) -> Vec<[Rational; 2]> {
        let side =
            |(i, [low, high]): (usize, &[Rational; 2])| self.part(i).map(|share| low + &(&(high - low) * &share));
        whole.iter().enumerate().map(side).collect()
    }

    pub fn halvings(&self) -> u32 {
        self.place.iter().map(|(_, h)| h).sum()
    }
}

impl Halves for Cell {
    fn halves(self, axis: usize) -> [Cell; 2] {
        let [mut low, mut high] = [self.place.clone(), self.place];
        low[axis] = (&low[axis].0 << 1, low[axis].1 + 1);
        high[axis] = (&(&high[axis].0 << 1) + &Integer::ONE, high[axis].1 + 1);
        let [a, b] = self.tensor.halves(axis);
        [Cell { tensor: a, place: low }, Cell { tensor: b, place: high }]
    }
}

/// The simplest point of a closed box.
pub(super) fn simplest_point(sides: &[[Rational; 2]]) -> Vec<Rational> {
    let simplest = |[low, high]: &[Rational; 2]| {
        let inner = simplest_between(low, high);
        let ends = [low, high].into_iter().cloned();
        ends.chain(inner).min_by_key(|x| (x.denominator(), x.numerator().abs())).expect("two ends")
    };
    sides.iter().map(simplest).collect()
}

/// A point of a box that is not stable, among the simplest ones of it and of its parts along each side, and its corners.
fn not_stable_in(p: &BoxPolynomial, sides: &[[Rational; 2]]) -> Option<Vec<Rational>> {
    let unstable = |sides: &[[Rational; 2]]| Some(simplest_point(sides)).filter(|point| !p.is_stable_at(point));
    let in_parts = || {
        (0..sides.len()).filter(|&i| sides[i][0] < sides[i][1]).find_map(|i| {
            let [low, high] = &sides[i];
            let at = |k: i64| low + &(&(high - low) * &Rational::new(k.into(), PARTS.into()));
            (0..PARTS).find_map(|k| {
                let mut part = sides.to_vec();
                part[i] = [at(k), at(k + 1)];
                unstable(&part)
            })
        })
    };
    let at_corner = || corners(sides).take(MOST_CORNERS).find(|corner| !p.is_stable_at(corner));
    unstable(sides).or_else(in_parts).or_else(at_corner)
}

/// The simplest point of a box in or beside a cell, if it is not stable: a point that is touched keeps the proof of the cells around it open, too.
pub(super) fn not_stable_near(
    p: &BoxPolynomial,
    cell: &[[Rational; 2]],
    sides: &[[Rational; 2]],
) -> Option<Vec<Rational>> {
    let wider = |([low, high], [least, most]): (&[Rational; 2], &[Rational; 2])| {
        let width = high - low;
        let wider = [(low - &width).max(least.clone()), (high + &width).min(most.clone())];
        (wider[0] <= wider[1]).then_some(wider)
    };
    let wider = cell.iter().zip(sides).map(wider).collect::<Option<Vec<_>>>()?;
    let point = simplest_point(&wider);
    (point.len() == sides.len() && !p.is_stable_at(&point)).then_some(point)
}

/// Decides one box, with at most so many cells, closed in this way.
///
/// No root crosses the imaginary axis in a connected set on which no divisor, the constant and the leading coefficient and the
/// pair `(E, O)` at no positive frequency vanish: the number of roots on either side is that of the nominal point, which is
/// stable. The Bernstein coefficients of the pair over a cell all on the positive side of one vector prove that it has no zero
/// there, as its values are convex combinations of them.
pub(super) fn prove(
    p: &BoxPolynomial,
    sides: &[[Rational; 2]],
    reference: &[Sign],
    scale: i64,
    (closed, most_cells): (Closing, usize),
    budget: &Budget,
) -> Result<Outcome, Exhausted> {
    let certain = match certain_trees(p, sides, reference, most_cells, budget)? {
        Ok(certain) => certain,
        Err(outcome) => return Ok(outcome),
    };
    if p.by_signs {
        return Ok(Outcome::Stable(BoxProof::of_cells(scale, certain.iter().map(Tree::leaves).sum())));
    }
    let Excluded { pair, power, mirrored } = p.excluded();
    let whole = if mirrored { with_both_signs(sides) } else { sides.to_vec() };
    let refuted = |mut point: Vec<Rational>| {
        if let Some(last) = point.last_mut().filter(|_| mirrored) {
            *last = last.abs();
        }
        Outcome::Refuted(point)
    };
    let (tensor, weight) = Tensor::of_pair(&pair, &whole, FrequencyScale(power * scale));
    let look = |cell: &mut Cell, tally: Tally| {
        let hint = match closed(cell, tally.looks()) {
            Ok(node) => return Ok(Look::Decided(node)),
            Err(hint) => hint,
        };
        let every = if tally.looks() < AFFINE_AFTER.0 { TESTED_EVERY } else { TESTED_EVERY / 4 };
        if (tally.halved + 1).is_multiple_of(every) {
            let point = simplest_point(&cell.sides(&whole));
            if !p.is_stable_at(&point) {
                return Ok(Look::Open(refuted(point)));
            }
        }
        let waiting = tally.waiting * cell.tensor.len() * 32;
        let why = if tally.cells() > most_cells {
            OpenReason::Cells
        } else if waiting > WAITING_BYTES && cell.halvings() < MOST_HALVINGS {
            OpenReason::Memory
        } else if let Some(axis) = hint.or_else(|| cell.tensor.best_axis()).filter(|_| cell.halvings() < MOST_HALVINGS)
        {
            return Ok(Look::Cut(axis));
        } else {
            OpenReason::Small
        };
        let cell = cell.sides(&whole);
        Ok(Look::Open(match not_stable_in(p, &cell) {
            Some(point) => refuted(point),
            None => Outcome::Open { why, cell },
        }))
    };
    Ok(match subdivide([Cell::whole(tensor)], Order::Depth, budget, look)? {
        Ok(steps) => {
            Outcome::Stable(BoxProof { certain, scale, weight, pair: Tree::of(steps, sides.len()), beside: 0 })
        }
        Err(outcome) => outcome,
    })
}

/// The trees that prove that the certain polynomials keep these signs in a box.
fn certain_trees(
    p: &BoxPolynomial,
    sides: &[[Rational; 2]],
    reference: &[Sign],
    most_cells: usize,
    budget: &Budget,
) -> Result<Result<Vec<Tree>, Outcome>, Exhausted> {
    let mut trees = Vec::new();
    for ((_, f), &sign) in p.certain.iter().zip(reference) {
        match keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, most_cells, budget)? {
            Ok(tree) => trees.push(tree),
            Err(outcome) => return Ok(Err(outcome)),
        }
    }
    Ok(Ok(trees))
}

/// Frequencies of one box are halved into so many parts at most, where it is looked at alone.
const FREQUENCIES: usize = 48;

/// Whether a box is stable everywhere or nowhere: without zeros of the pair and of the certain polynomials it has one number of stable roots,
/// which its middle tells. Frequencies alone are halved.
///
/// Cost: the Bernstein coefficients of the pair.
pub(super) fn look(p: &BoxPolynomial, sides: &[[Rational; 2]], budget: &Budget) -> Result<BoxLook, Exhausted> {
    let middle = middle(sides);
    let known = signs_at(p, &middle);
    let scale = known.as_ref().map_or(0, |(_, scale)| *scale);
    let (tensor, _) = Tensor::of_pair(&p.pair(), sides, FrequencyScale(2 * scale));
    let open = BoxLook::Open(tensor.steepest_parameter());
    let Some((signs, _)) = known else { return Ok(open) };
    for ((_, f), sign) in p.certain.iter().zip(signs) {
        if keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, 1, budget)?.is_err() {
            return Ok(open);
        }
    }
    let frequency = sides.len();
    let look = |cell: &mut Cell, tally: Tally| {
        if closed_by_constant(cell, tally.looks()).is_ok() {
            return Ok(Look::Decided(()));
        }
        let axis = cell.tensor.best_axis_of(&[frequency]).filter(|_| tally.cells() < FREQUENCIES);
        Ok(axis.map_or(Look::Open(()), Look::Cut))
    };
    Ok(match subdivide([Cell::whole(tensor)], Order::Depth, budget, look)? {
        Ok(_) if p.is_stable_at(&middle) => BoxLook::Stable,
        Ok(_) => BoxLook::Unstable,
        Err(()) => open,
    })
}

/// The last side, from 0, with its mirror image.
fn with_both_signs(sides: &[[Rational; 2]]) -> Vec<[Rational; 2]> {
    let mut both = sides.to_vec();
    if let Some([low, high]) = both.last_mut() {
        *low = -&*high;
    }
    both
}

/// The leaf of a cell without a zero of the pair, in a tree of so many nodes so far; where no vector shows it, the axis along
/// which to halve the cell, if that is known.
pub(super) type Closing<'c> = &'c dyn Fn(&Cell, usize) -> Result<Node, Option<usize>>;

/// [`Closing`] by the sign of a polynomial.
pub(super) fn closed_by_sign(sign: Sign) -> impl Fn(&Cell, usize) -> Result<Node, Option<usize>> {
    move |cell, _| {
        let ((low, high), error) = (cell.tensor.range(0), cell.tensor.greatest_error());
        let has_sign = if sign.is_gt() { low > error } else { high < -error };
        if has_sign { Ok(Node::Signed(sign.is_gt())) } else { Err(None) }
    }
}

/// [`Closing`] by vectors that are constant in a cell: enough where the worst point is a corner.
pub(super) fn closed_by_constant(cell: &Cell, _: usize) -> Result<Node, Option<usize>> {
    let [x, y] = cell.tensor.planes.as_slice() else { unreachable!("a pair") };
    let found = separating_vector_within(x, y, cell.tensor.error, &cell.tensor.slack).ok_or(None)?;
    Ok(Node::Separated(found.0, found.1))
}

/// [`Closing`] also by vectors that are affine in a cell.
pub(super) fn closed_by_vector(cell: &Cell, nodes: usize) -> Result<Node, Option<usize>> {
    let constant = closed_by_constant(cell, nodes);
    let is_vague = cell.tensor.greatest_error() > GREATEST_ERROR;
    if constant.is_ok() || nodes < AFFINE_AFTER.0 || cell.halvings() < AFFINE_AFTER.1 || is_vague {
        return constant;
    }
    match affine_multiplier(&cell.tensor) {
        Sought::Found(found) => Ok(Node::affine(found, cell.tensor.axes() - 1)),
        Sought::Missed(axis) => Err(axis),
    }
}

/// Points of a box, in or beside a cell, at which a polynomial is stationary along all parameters but one, as far as one after the other tells: where it is zero
/// without a change of its sign, it is so.
fn stationary_points<'p>(
    f: &'p Bundle,
    cell: &'p [[Rational; 2]],
    sides: &'p [[Rational; 2]],
) -> impl Iterator<Item = Vec<Rational>> + 'p {
    let count = if cell.len() <= MOST_STATIONARY { cell.len() } else { 0 };
    (0..count).map(move |kept| {
        let mut point = simplest_point(cell);
        for i in (kept + 1..kept + cell.len()).map(|i| i % cell.len()) {
            let [low, high] = &cell[i];
            let width = high - low;
            let mut step = vec![Rational::ZERO; cell.len()];
            step[i] = Rational::ONE;
            point[i] = Rational::ZERO;
            let slope = along(f, &point, &step).remove(0).derivative();
            let place = rational_zero(&slope, &(low - &width), &(high + &width));
            point[i] = place.filter(|x| sides[i][0] <= *x && *x <= sides[i][1]).unwrap_or_else(|| low.midpoint(high));
        }
        point
    })
}

/// The tree that proves that a polynomial keeps its sign in a box, or why that is not so or not known.
pub(super) fn keeps_sign(
    f: &Bundle,
    sides: &[[Rational; 2]],
    sign: Sign,
    most_cells: usize,
    budget: &Budget,
) -> Result<Result<Tree, Outcome>, Exhausted> {
    let closed = closed_by_sign(sign);
    let has_other_sign = |point: &Vec<Rational>| {
        let (a, q): (Vec<_>, Vec<_>) = point.iter().map(|x| (x.numerator(), x.denominator())).unzip();
        f.values(&a, &q)[0].sign() != sign
    };
    let look = |cell: &mut Cell, tally: Tally| {
        if let Ok(node) = closed(cell, tally.looks()) {
            return Ok(Look::Decided(node));
        }
        let (inner, error) = (cell.sides(sides), cell.tensor.error);
        // A corner with another sign, or exactly zero.
        let may_differ = |value: i128| if sign.is_gt() { value <= error } else { value >= -error };
        let at = |upper: Vec<bool>| inner.iter().zip(&upper).map(|(side, &up)| side[usize::from(up)].clone()).collect();
        let mut corners = cell.tensor.corners().filter(|(_, value)| may_differ(*value)).map(|(upper, _)| at(upper));
        if let Some(corner) = corners.find(has_other_sign) {
            return Ok(Look::Open(Outcome::Refuted(corner)));
        }
        let may_cut = tally.cells() <= most_cells && cell.halvings() < MOST_HALVINGS;
        if let Some(axis) = cell.tensor.best_axis().filter(|_| may_cut) {
            return Ok(Look::Cut(axis));
        }
        let simplest = Some(simplest_point(&inner)).filter(has_other_sign);
        Ok(Look::Open(match simplest.or_else(|| stationary_points(f, &inner, sides).find(has_other_sign)) {
            Some(point) => Outcome::Refuted(point),
            None => Outcome::Open { why: OpenReason::Vanishing, cell: inner },
        }))
    };
    let steps = subdivide([Cell::whole(Tensor::of_one(f, sides))], Order::Depth, budget, look)?;
    Ok(steps.map(|steps| Tree::of(steps, sides.len())))
}

/// The scale of frequencies of a polynomial: the geometric mean of its roots' moduli is about two to this.
pub(super) fn scale_of(values: &[Integer]) -> i64 {
    let size = |c: &Integer| c.bit_length() as i64;
    let n = values.len() - 1;
    if n == 0 { 0 } else { (size(&values[0]) - size(&values[n])).div_euclid(n as i64) }
}

/// The signs of the certain polynomials at a point, and the scale of frequencies there; `None` where one vanishes.
pub(super) fn signs_at(p: &BoxPolynomial, point: &[Rational]) -> Option<(Vec<Sign>, i64)> {
    let (a, q): (Vec<_>, Vec<_>) = point.iter().map(|x| (x.numerator(), x.denominator())).unzip();
    let signs: Vec<Sign> =
        p.certain.iter().map(|(_, f)| Bundle::new(&[f], point.len()).values(&a, &q)[0].sign()).collect();
    if signs.contains(&Sign::Equal) {
        return None;
    }
    let scale = scale_of(&p.coefficients.values(&a, &q));
    Some((signs, scale))
}
