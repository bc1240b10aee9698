//! The loop that halves boxes until every part is decided: for proofs of whole boxes, for maps, for intervals.
//!
//! What differs is in the cells, which say how they are halved and what halves know from the whole, and in the look at one cell.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use std::collections::VecDeque;

/// A part of a box.
pub trait Halves: Sized {
    /// The lower and the upper half along an axis.
    fn halves(self, axis: usize) -> [Self; 2];
}

impl<A: Halves, B: Halves> Halves for (A, B) {
    fn halves(self, axis: usize) -> [(A, B); 2] {
        let ([a, b], [of_a, of_b]) = (self.0.halves(axis), self.1.halves(axis));
        [(a, of_a), (b, of_b)]
    }
}

/// What a look at a cell shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look<D, O> {
    /// The cell is decided.
    Decided(D),
    /// Its halves along this axis may show more.
    Cut(usize),
    /// The cell stays open, which ends the subdivision.
    Open(O),
}

/// A step of a subdivision: depth first, the steps are a tree in prefix order, the lower half of a cell first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<D> {
    /// A cell was decided.
    Decided(D),
    /// A cell was halved along this axis.
    Halved(usize),
}

/// What cells were decided by.
pub fn decided<D>(steps: Vec<Step<D>>) -> impl Iterator<Item = D> {
    steps.into_iter().filter_map(|step| match step {
        Step::Decided(found) => Some(found),
        Step::Halved(_) => None,
    })
}

/// Which of the waiting cells is looked at next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The lower half of the cell that was halved last: few cells wait.
    Depth,
    /// The cell that waits longest: the largest one.
    Breadth,
}

/// The cells of a subdivision beside the one that is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cells that were decided.
    pub decided: usize,
    /// Cells that were halved.
    pub halved: usize,
    /// Cells that nobody has looked at.
    pub waiting: usize,
}

impl Tally {
    /// The number of looks before this one.
    pub fn looks(self) -> usize {
        self.decided + self.halved
    }

    /// The number of looks before this one and of cells that wait.
    pub fn cells(self) -> usize {
        self.looks() + self.waiting
    }
}

/// A box that knows how often it was halved along each of its sides.
#[derive(Clone, Debug)]
pub struct BoxPart {
    /// The ends of each side.
    pub sides: Vec<[Rational; 2]>,
    /// For each side how often it was halved.
    pub halvings: Vec<u32>,
}

impl BoxPart {
    /// A box that was not halved.
    pub fn whole(sides: impl Into<Vec<[Rational; 2]>>) -> BoxPart {
        let sides = sides.into();
        let halvings = vec![0; sides.len()];
        BoxPart { sides, halvings }
    }

    /// The parts below and above a value of one parameter.
    pub fn cut_at(self, axis: usize, value: Rational) -> [BoxPart; 2] {
        let (mut low, mut high) = (self.clone(), self);
        low.halvings[axis] += 1;
        high.halvings[axis] += 1;
        (low.sides[axis][1], high.sides[axis][0]) = (value.clone(), value);
        [low, high]
    }
}

impl Halves for BoxPart {
    fn halves(self, axis: usize) -> [BoxPart; 2] {
        let middle = self.sides[axis][0].midpoint(&self.sides[axis][1]);
        self.cut_at(axis, middle)
    }
}

/// A side whose ends have at least this ratio is cut at the middle of its octaves.
const LEAST_RATIO: i64 = 2;

/// Binary digits of such a cut.
const CUT_BITS: u64 = 8;

/// A part of a box that is cut at the middle of the octaves of a side.
///
/// ```
/// use jurist_stability::subdivision::{BoxPart, Halves, Octaves};
/// let side = [1, 16].map(jurist_algebra::number::Rational::from);
/// let [low, _] = Octaves(BoxPart::whole([side])).halves(0);
/// assert_eq!(low.0.sides[0][1], 4.into());
/// ```
pub struct Octaves(pub BoxPart);

impl Halves for Octaves {
    fn halves(self, axis: usize) -> [Octaves; 2] {
        let value = cut(&self.0.sides[axis]);
        self.0.cut_at(axis, value).map(Octaves)
    }
}

/// Where a side is cut: in the middle, of the octaves where it spans several.
fn cut([low, high]: &[Rational; 2]) -> Rational {
    let middle = low.midpoint(high);
    let (near, far) = if low.is_negative() { (high.abs(), low.abs()) } else { (low.clone(), high.clone()) };
    let is_one_sided = low.sign() == high.sign() && !low.is_zero();
    if !is_one_sided || far < &near * &Rational::from(LEAST_RATIO) {
        return middle;
    }
    // A root of the product, to some binary digits.
    let scale = Rational::from(4).pow(size_of(&near)).expect("four is not zero");
    let product = (&near * &far).checked_div(&scale).expect("a power is not zero");
    let root = Rational::dyadic(&(&product * &Rational::from(1 << (2 * CUT_BITS))).floor().sqrt_floor(), CUT_BITS);
    let root = &root * &Rational::from(2).pow(size_of(&near)).expect("two is not zero");
    let root = if low.is_negative() { -root } else { root };
    if *low < root && root < *high { root } else { middle }
}

/// The power of two near a number that is not zero.
fn size_of(x: &Rational) -> i64 {
    x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64
}

/// Looks at cells, the first one first, and at their halves until all are decided: the steps, or why a cell stays open.
///
/// Cost: that of the looks; the budget is asked before each of them.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_stability::subdivision::{BoxPart, Look, Order, decided, subdivide};
/// // Parts of an interval that do not hold 1/3, down to an eighth of it.
/// let third = Rational::new(1.into(), 3.into());
/// let steps = subdivide([BoxPart::whole([[0.into(), 1.into()]])], Order::Depth, &Budget::unlimited(), |part, _| {
///     let [low, high] = &part.sides[0];
///     Ok(match *low <= third && third <= *high {
///         false => Look::Decided(true),
///         true if part.halvings[0] == 3 => Look::Decided(false),
///         true => Look::<bool, ()>::Cut(0),
///     })
/// });
/// let found: Vec<bool> = decided(steps.unwrap().unwrap()).collect();
/// assert_eq!(found, [true, false, true, true]);
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out, or a look does not end.
pub fn subdivide<C: Halves, D, O>(
    first: impl IntoIterator<Item = C>,
    order: Order,
    budget: &Budget,
    mut look: impl FnMut(&mut C, Tally) -> Result<Look<D, O>, Exhausted>,
) -> Result<Result<Vec<Step<D>>, O>, Exhausted> {
    let mut waiting: VecDeque<C> = first.into_iter().collect();
    let mut steps = Vec::new();
    let mut decided = 0;
    while let Some(mut cell) = waiting.pop_front() {
        let tally = Tally { decided, halved: steps.len() - decided, waiting: waiting.len() };
        budget.check()?;
        match look(&mut cell, tally)? {
            Look::Decided(found) => {
                decided += 1;
                steps.push(Step::Decided(found));
            }
            Look::Cut(axis) => {
                steps.push(Step::Halved(axis));
                let [low, high] = cell.halves(axis);
                match order {
                    Order::Depth => [high, low].into_iter().for_each(|half| waiting.push_front(half)),
                    Order::Breadth => waiting.extend([low, high]),
                }
            }
            Look::Open(why) => return Ok(Err(why)),
        }
    }
    Ok(Ok(steps))
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::limits::Stop;
    use jurist_algebra::number::parse_number;

    fn unit() -> BoxPart {
        BoxPart::whole([[Rational::ZERO, Rational::ONE]])
    }

    /// The lower ends of the parts that hold no third, which are halved twice at most.
    fn beside_a_third(order: Order, budget: &Budget) -> Result<Result<Vec<Step<String>>, String>, Exhausted> {
        let third = Rational::new(1.into(), 3.into());
        subdivide([unit()], order, budget, |part, _| {
            let [low, high] = &part.sides[0];
            Ok(match (*low < third && third < *high, part.halvings[0]) {
                (false, _) => Look::Decided(low.to_string()),
                (true, 2) => Look::Open(low.to_string()),
                (true, _) => Look::Cut(0),
            })
        })
    }

    #[test]
    fn an_open_cell_ends_a_subdivision() {
        let unlimited = Budget::unlimited();
        assert_eq!(beside_a_third(Order::Depth, &unlimited).unwrap(), Err("1/4".to_owned()));
        assert_eq!(beside_a_third(Order::Breadth, &unlimited).unwrap(), Err("1/4".to_owned()));
        assert_eq!(beside_a_third(Order::Depth, &Budget::with_work(2)).unwrap_err().stop, Stop::Work(2));
    }

    /// Every cell counts once: as decided, as halved, or as one that waits.
    #[test]
    fn steps_follow_the_order_and_looks_are_told_how_many_there_were() {
        let steps = |order| {
            let mut tallies = Vec::new();
            let steps = subdivide([unit()], order, &Budget::unlimited(), |part, tally| {
                tallies.push((tally.looks(), tally.waiting));
                Ok::<Look<String, ()>, Exhausted>(match part.halvings[0] {
                    2 => Look::Decided(part.sides[0][0].to_string()),
                    _ => Look::Cut(0),
                })
            });
            (steps.unwrap().unwrap(), tallies)
        };
        let leaf = |text: &str| Step::Decided(text.to_owned());
        let halved = Step::Halved(0);
        let (tree, tallies) = steps(Order::Depth);
        let [a, b, c, d] = ["0", "1/4", "1/2", "3/4"].map(leaf);
        let all = [halved.clone(), halved.clone(), a, b, halved.clone(), c, d];
        assert_eq!((tree, tallies[2]), (all.to_vec(), (2, 2)));
        let (levels, tallies) = steps(Order::Breadth);
        assert_eq!((&levels[..3], tallies[2]), (&[halved.clone(), halved.clone(), halved][..], (2, 2)));
        assert_eq!(decided(levels).collect::<Vec<_>>(), ["0", "1/4", "1/2", "3/4"]);
    }

    #[test]
    fn sides_of_several_octaves_are_cut_between_these() {
        let at = |low: &str, high: &str| cut(&[low, high].map(|x| parse_number(x).unwrap())).to_string();
        assert_eq!([at("1", "16"), at("-16", "-1"), at("1/1024", "1/64")], ["4", "-4", "1/256"]);
        assert_eq!([at("-1", "3"), at("0", "4"), at("3", "5")], ["1", "2", "4"]);
    }
}
