//! Two parameters of a loop with dead time: boxes, each proved stable, proved not stable, or left undecided.

use super::plane_function::{PlaneFunction, Shares};
use crate::plane::boxes::{BoxMap, BoxVerdict, Place, Seen, Window, subdivided_with};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly};
use std::collections::BTreeMap;

/// `offset + slopes[0] x + slopes[1] y`: a dead time in a plane of two parameters.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct DeadTime {
    /// The dead time where both parameters are zero.
    pub offset: Rational,
    /// By either parameter.
    pub slopes: [Rational; 2],
}

impl DeadTime {
    /// Adds a dead time so many times.
    pub fn add(&mut self, other: &DeadTime, times: u32) {
        let times = Rational::from(i64::from(times));
        self.offset += &other.offset * &times;
        self.slopes[0] += &other.slopes[0] * &times;
        self.slopes[1] += &other.slopes[1] * &times;
    }

    fn minus(&self, other: &DeadTime) -> DeadTime {
        let slopes = [0, 1].map(|i| &self.slopes[i] - &other.slopes[i]);
        DeadTime { offset: &self.offset - &other.offset, slopes }
    }

    /// In the shares of a window.
    pub(super) fn in_shares(&self, window: &Window) -> DeadTime {
        let [a, b] = &self.slopes;
        let offset = &self.offset + &(a * &window.x[0]) + b * &window.y[0];
        DeadTime { offset, slopes: [a * &(&window.x[1] - &window.x[0]), b * &(&window.y[1] - &window.y[0])] }
    }
}

/// `sum P(s; x, y) exp(-tau(x, y) s)` over any dead times: a loop with two parameters.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::MultiPoly;
/// use jurist_stability::Range;
/// use jurist_stability::dead_time::{DeadTime, PlaneLoop};
/// use jurist_stability::plane::boxes::Window;
/// // s + x exp(-y s): stable for 0 < x y < pi/2
/// let [x, one] = [MultiPoly::variable(0), MultiPoly::constant(1.into())];
/// let y = DeadTime { offset: 0.into(), slopes: [0.into(), 1.into()] };
/// let terms = [(DeadTime::default(), vec![MultiPoly::constant(0.into()), one]), (y.clone(), vec![x])];
/// let plane = PlaneLoop::new(terms.into(), vec![y], Vec::new());
/// let side = Range::between(Some(0.into()), Some(4.into()));
/// let window = Window::new(&side, &side).unwrap();
/// let map = plane.boxes(&window, &"1/2".parse().unwrap(), &Budget::unlimited()).unwrap();
/// assert!(map.areas.stable > 0.into() && map.areas.unstable > 0.into());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneLoop {
    /// The coefficients of the powers of `s` for each dead time, that of zero first.
    pub(super) terms: Vec<(DeadTime, Vec<MultiPoly>)>,
    /// The loop has no meaning where one of these is negative.
    pub(super) times: Vec<DeadTime>,
    /// The loop is undefined where one of these vanishes.
    pub(super) poles: Vec<MultiPoly>,
}

impl PlaneLoop {
    /// The loop of the coefficients of the powers of `s` for each dead time, the dead times that are not to be negative, and
    /// the polynomials at whose zeros it is undefined.
    pub fn new(terms: BTreeMap<DeadTime, Vec<MultiPoly>>, times: Vec<DeadTime>, poles: Vec<MultiPoly>) -> PlaneLoop {
        let is_used = |part: &Vec<MultiPoly>| part.iter().any(|c| !c.is_zero());
        let mut terms: Vec<(DeadTime, Vec<MultiPoly>)> = terms.into_iter().filter(|(_, part)| is_used(part)).collect();
        // A dead time that all have in common moves no root: that of the highest power of s is taken for it.
        let degree = |part: &Vec<MultiPoly>| part.iter().rposition(|c| !c.is_zero());
        let first = (0..terms.len()).rev().max_by_key(|&k| (degree(&terms[k].1), terms[k].0 == DeadTime::default()));
        if let Some(first) = first {
            terms.swap(0, first);
            let least = terms[0].0.clone();
            terms.iter_mut().for_each(|(time, _)| *time = time.minus(&least));
        }
        PlaneLoop { terms, times, poles }
    }

    pub(super) fn in_shares(&self, window: &Window) -> Shares {
        let flat: Vec<MultiPoly> = self.terms.iter().flat_map(|(_, part)| part).cloned().collect();
        let mut shares = in_shares(&flat, window).into_iter();
        let exact = |p: MultiPoly| (p, Integer::ZERO);
        Shares {
            parts: self.terms.iter().map(|(_, part)| shares.by_ref().take(part.len()).collect()).collect(),
            slack: Vec::new(),
            slack_axis: 0,
            poles: in_shares(&self.poles, window).into_iter().map(exact).collect(),
            delays: self.terms.iter().map(|(time, _)| time.in_shares(window)).collect(),
            times: self.times.iter().map(|time| time.in_shares(window)).collect(),
        }
    }

    /// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1).
    ///
    /// A box is walked over along the imaginary axis, for all values of both parameters. Where the function stays in half planes
    /// no root is on the axis. Where it may be zero, but its derivative by frequency stays in one, the number of roots to the right is
    /// known up to a pair. The box is stable where that number is zero, unstable where it is positive for certain: curves of further roots
    /// may pass through it. A budget that runs out leaves more of the window undecided.
    ///
    /// Cost: an evaluation of the function and its first derivatives for each step of each walk; of a half only steps about the frequencies
    /// that were open for the whole.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out before there is a box.
    pub fn boxes(&self, window: &Window, goal: &Rational, budget: &Budget) -> Result<BoxMap, Exhausted> {
        let function = budget.enter(|| PlaneFunction::new(self.in_shares(window)))?;
        Ok(subdivided_with(window, goal, budget, |place, known| Ok(function.look(place, known))))
    }

    /// The verdict on a loop that depends on neither parameter, by one walk along the imaginary axis; `None` where that does not tell.
    pub fn verdict(&self) -> Option<BoxVerdict> {
        let side = [Rational::ZERO, Rational::ONE];
        let shares = self.in_shares(&Window { x: side.clone(), y: side });
        match PlaneFunction::of_point(shares).look(&Place::whole(), None) {
            (Seen::Decided(verdict), _) => Some(verdict),
            (Seen::Cut(_), _) => None,
        }
    }
}

/// Polynomials in the shares of a window, `x = x_0 + w_x u`, `y = y_0 + w_y v`, all multiplied by the same positive number.
fn in_shares(list: &[MultiPoly], window: &Window) -> Vec<MultiPoly> {
    in_shares_of(&in_shares_of(list, 0, &window.x), 1, &window.y)
}

/// Polynomials in the share of one parameter's range, all multiplied by the same positive number.
pub fn in_shares_of(list: &[MultiPoly], axis: usize, [low, high]: &[Rational; 2]) -> Vec<MultiPoly> {
    let degree = list.iter().map(|p| p.degree_in(axis)).max().unwrap_or(0) as usize;
    let length = high - low;
    let common = low.denominator().lcm(&length.denominator());
    let whole = |x: &Rational| (x * &Rational::from(&common)).numerator();
    let shifted = &MultiPoly::variable(axis).scaled_by(&whole(&length)) + &MultiPoly::constant(whole(low));
    let mut powers = vec![MultiPoly::one()];
    for i in 0..degree {
        powers.push(&powers[i] * &shifted);
    }
    let one = |p: &MultiPoly| {
        p.as_poly_in(axis).coeffs().iter().enumerate().fold(MultiPoly::zero(), |sum, (i, c)| {
            &sum + &(&powers[i] * &c.scaled_by(&common.pow((degree - i) as u64)))
        })
    };
    list.iter().map(one).collect()
}
