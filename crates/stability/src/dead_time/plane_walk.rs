//! A walk along the imaginary axis for a whole box of two parameters at once.

use super::dyadic::{Dyadic, Step};
use super::headings::{Headings, LENGTH, Piece, Right, SPAN, TURN, heading, joined, roots_right};
use super::plane::DeadTime;
use super::plane_function::{PlaneFunction, middle, upper};
use super::turn::{Fixed, turned};
use crate::plane::boxes::Place;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{MultiPoly, UniPoly};

const SCALE: u64 = 96;

/// What is known of the way for all points of a box, and so of its parts.
#[derive(Debug)]
pub struct Known {
    /// A power of two beyond which the highest power of `s` without delay outweighs the rest.
    pub(super) bound: u64,
    /// Whether that power has a negative coefficient.
    pub(super) is_negative: bool,
    /// Whether the loop is defined in the whole box.
    pub(super) is_defined: bool,
    pub(super) pieces: Vec<Piece>,
}

/// One box: everything as a function of the frequency.
pub(super) struct Walk<'f> {
    function: &'f PlaneFunction,
    /// In the middle of the box, times `2^middle`.
    first: [Vec<[UniPoly; 2]>; 4],
    middle: u64,
    /// At its upper corner, times `2^upper`: the second derivatives.
    second: [UniPoly; 6],
    upper: u64,
    /// The moduli of the parts, in the middle and at the upper corner.
    moduli: [Vec<UniPoly>; 2],
    /// The dead times in the middle of the box.
    delays: Vec<Rational>,
    /// Half the lengths of the box are two to these powers.
    halves: [i64; 2],
    pieces: Vec<Piece>,
    /// How much either parameter moves the function where it may vanish: where nothing at all is known, and where its slope is.
    votes: [[i128; 2]; 2],
    steps: usize,
    is_lost_before: bool,
}

impl<'f> Walk<'f> {
    pub fn new(function: &'f PlaneFunction, place: &Place) -> Walk<'f> {
        let (middle, upper) = ([0, 1].map(|i| middle(place, i)), [0, 1].map(|i| upper(place, i)));
        let first = function.first.each_ref().map(|set| {
            let both = |pair: &[MultiPoly; 2]| pair.each_ref().map(|p| function.collapsed(p, &middle));
            set.iter().map(both).collect::<Vec<_>>()
        });
        let second = function.second.each_ref().map(|p| function.collapsed(p, &upper));
        let moduli = [&middle, &upper].map(|at| function.moduli.iter().map(|p| function.collapsed(p, at)).collect());
        let [u, v] = [0, 1].map(|i| middle[i].rational());
        let delay = |time: &DeadTime| &time.offset + &(&time.slopes[0] * &u) + &time.slopes[1] * &v;
        let delays = function.shares.delays.iter().map(delay).collect();
        let halves = place.halvings.map(|h| -i64::from(h) - 1);
        let (shift, over) = (function.shift(&middle), function.shift(&upper));
        let (pieces, votes) = (Vec::new(), [[0; 2]; 2]);
        Walk {
            function,
            first,
            middle: shift,
            second,
            upper: over,
            moduli,
            delays,
            halves,
            pieces,
            votes,
            steps: 0,
            is_lost_before: false,
        }
    }

    /// From zero to a bound; `None` where that takes too many steps.
    pub fn whole(&mut self, bound: u64) -> Option<()> {
        let end = Dyadic { m: &Integer::ONE << bound, e: 0 };
        self.along(Dyadic::zero(), Step(bound as i64 - 4), &end, bound)
    }

    /// Where a larger box was open.
    pub fn again(&mut self, known: &Known) -> Option<()> {
        for piece in &known.pieces {
            match piece {
                Piece::Open { at, to, step, .. } if !self.is_lost() => {
                    self.along(at.clone(), *step, to, known.bound)?
                }
                _ => self.pieces.push(piece.clone()),
            }
        }
        Some(())
    }

    /// Whether there is a stretch on which nothing is known: then the rest of the way is of no use to this box.
    fn is_lost(&self) -> bool {
        let open = self.pieces.iter().rev().map_while(|piece| match piece {
            Piece::Open { slopes, .. } => Some(slopes),
            Piece::Clear { .. } => None,
        });
        self.is_lost_before || open.fold(Headings::MAX, |all, own| all & own) == 0
    }

    pub fn right(&self, known: &Known) -> Option<Right> {
        roots_right(&self.pieces, self.function.order, known.is_negative)
    }

    pub fn into_pieces(self) -> Vec<Piece> {
        joined(self.pieces)
    }

    /// The axis to cut.
    pub fn wider(&self) -> usize {
        match self.votes.iter().find(|[u, v]| u != v) {
            Some([u, v]) => usize::from(v > u),
            None => usize::from(self.halves[1] > self.halves[0]),
        }
    }

    fn along(&mut self, from: Dyadic, step: Step, end: &Dyadic, bound: u64) -> Option<()> {
        let [shortest, least] = self.function.shortest;
        let (mut at, mut step) = (from, step);
        let last = end.rational();
        while at.rational() < last {
            while at.plus(step, 0).rational() > last {
                step = Step(step.0 - 1);
            }
            self.steps += 1;
            if self.steps > self.function.most_steps {
                return None;
            }
            let local = self.local(&at.plus(step, 1), step);
            let may_be_shorter = step.0 > at.floor_log2().map_or(bound as i64 - least, |e| e - shortest);
            let next = at.plus(step, 0);
            let look = match local.look() {
                Look::Clear(k) => Look::Clear(k),
                other => self.outweighed(&at.plus(step, 1), step).unwrap_or(other),
            };
            match look {
                Look::TooLong if may_be_shorter => {
                    step = Step(step.0 - 1);
                    continue;
                }
                Look::Clear(k) => self.pieces.push(Piece::Clear { first: k, last: k }),
                seen => {
                    let slopes = if let Look::Open(slopes) = seen { slopes } else { local.slopes() };
                    let votes = &mut self.votes[usize::from(slopes != 0)];
                    let own = local.shares(slopes, self.function.shares.slack_axis);
                    *votes = [votes[0] + own[0], votes[1] + own[1]];
                    self.pieces.push(Piece::Open { at, to: next.clone(), step, slopes });
                    if self.is_lost() {
                        if next.rational() < last {
                            self.pieces.push(Piece::Open { at: next, to: end.clone(), step, slopes: 0 });
                        }
                        self.is_lost_before = true;
                        return Some(());
                    }
                }
            }
            at = next;
            // Where the next step is no longer, it is halved.
            step = Step(step.0 + 1);
        }
        Some(())
    }

    /// What is seen of a step where the part without delay outweighs the others, whatever the dead times are.
    fn outweighed(&self, omega: &Dyadic, step: Step) -> Option<Look> {
        if self.first[0].len() < 2 {
            return None;
        }
        let far = omega.plus(step, 1);
        let [inner, outer] = [(0, self.middle), (1, self.upper)].map(|(which, shift)| {
            move |at: &Dyadic| {
                self.moduli[which].iter().map(|p| scaled(p, at, shift)).fold(Integer::ZERO, |sum, x| sum + x)
            }
        });
        let parts = self.first[0].iter().map(|[re, im]| {
            let (re, im) = (scaled(re, omega, self.middle), scaled(im, omega, self.middle));
            Fixed { re, im, error: Integer::ONE }
        });
        let parts: Vec<Fixed> = parts.collect();
        let delayed = parts[1..].iter().fold(Integer::ZERO, |sum, part| sum + part.at_most());
        // A sum of monomials of numbers that are not negative is convex: nowhere is it farther from its middle than at the upper end.
        let (at_middle, roundings) = (inner(omega), Integer::from(2 * parts.len() as i64 + 2));
        let slack = scaled(&self.function.slack, &far, 0) + Integer::ONE;
        let rest = |at: &Dyadic| &delayed + &(outer(at) - &at_middle) + &roundings + &slack;
        let Fixed { re, im, error } = &parts[0];
        let vectors = [[re.clone(), im.clone(), error.clone()], NONE, NONE, NONE];
        let local = |rest: Integer| Local::new(vectors.clone(), [rest, Integer::ZERO, Integer::ZERO, Integer::ZERO]);
        match (local(rest(&far)).look(), local(rest(omega)).look()) {
            (Look::Clear(k), _) => Some(Look::Clear(k)),
            (_, Look::Clear(_)) => Some(Look::TooLong),
            _ => None,
        }
    }

    /// What the function does on a step, for all points of the box.
    pub(super) fn local(&self, omega: &Dyadic, step: Step) -> Local {
        checkpoint(512);
        let guarded = SCALE + 8;
        let omega_exact = omega.rational();
        let turn = |delay: &Rational| match delay.is_zero() {
            true => Fixed::one(guarded),
            false => turned(&(&omega_exact * delay), guarded),
        };
        let turns: Vec<Fixed> = self.delays.iter().map(turn).collect();
        let [value, by_omega, by_u, by_v] = self.first.each_ref().map(|set| {
            let zero = Fixed { re: Integer::ZERO, im: Integer::ZERO, error: Integer::ZERO };
            set.iter().zip(&turns).fold(zero, |sum, ([re, im], turn)| {
                let (re, im) = (scaled(re, omega, self.middle), scaled(im, omega, self.middle));
                sum.plus(&Fixed { re, im, error: Integer::ONE }.times(turn, guarded))
            })
        });
        // f = f(m) + f_w dw + f_u du + f_v dv + half of the second derivatives times products of these; everything times unit^2.
        let (h, [a, b]) = (step.0 - 1, self.halves);
        let far = omega.plus(step, 1);
        let [ww, wu, wv, uu, uv, vv] = self.second.each_ref().map(|p| scaled(p, &far, self.upper) + Integer::ONE);
        let unit = &self.function.unit;
        let square = unit * unit;
        let slack = |p: &UniPoly| (scaled(p, &far, 0) + Integer::ONE) * &square;
        let [bend, by_sides] = [
            shifted_up(&ww, 2 * h),
            shifted_up(&wu, h + a) + shifted_up(&wv, h + b) + shifted_up(&slack(&self.function.slack_slope), h),
        ];
        let sides = shifted_up(&uu, 2 * a - 1) + shifted_up(&uv, a + b) + shifted_up(&vv, 2 * b - 1);
        let vectors =
            [times(&value, &square, 0), times(&by_omega, unit, h), times(&by_u, unit, a), times(&by_v, unit, b)];
        Local::new(vectors, [sides, slack(&self.function.slack), by_sides, bend])
    }
}

const NONE: [Integer; 3] = [Integer::ZERO, Integer::ZERO, Integer::ZERO];

/// The function about the middle of a step and a box, all in one unit.
pub(super) struct Local {
    value: Vector,
    /// The derivatives by frequency and both parameters, times the half lengths.
    slopes: [Vector; 3],
    /// Bounds: of what the parameters' second derivatives do with all that is off, the latter alone, and of the change of the derivative by
    /// frequency through the parameters, and through the frequency. All times half lengths.
    sides: i128,
    slack: i128,
    by_sides: i128,
    bend: i128,
}

struct Vector {
    re: i128,
    im: i128,
    /// Of either part.
    error: i128,
}

/// What is seen of a step.
enum Look {
    /// The function stays in the half plane about a heading.
    Clear(i64),
    /// Shorter steps show more.
    TooLong,
    /// No shorter step would show more than that the derivative stays in half planes about these headings.
    Open(Headings),
}

/// Bits of all that is compared.
const BITS: u64 = 100;
/// A step is halved where more than one part in two to this power of the value in its middle would be left if it were short: else the
/// ends of open stretches would be looked for with steps without end.
const WORTH: u32 = 3;

impl Local {
    fn new(vectors: [[Integer; 3]; 4], bounds: [Integer; 4]) -> Local {
        let longest = vectors.iter().flatten().chain(&bounds).map(Integer::bit_length).max().unwrap_or(0);
        let down = longest.saturating_sub(BITS);
        let floor = |x: &Integer| short(&(x >> down));
        let vector = |[re, im, error]: &[Integer; 3]| Vector { re: floor(re), im: floor(im), error: floor(error) + 2 };
        let [value, slopes @ ..] = vectors.each_ref().map(vector);
        let [sides, slack, by_sides, bend] = bounds.each_ref().map(|x| floor(x) + 1);
        Local { value, slopes, sides: sides + slack, slack, by_sides, bend }
    }

    fn look(&self) -> Look {
        // Of the headings with the value in their half plane the one that leaves most.
        let (mut best, mut is_point_clear) = ((0, i128::MIN), false);
        for k in 0..TURN {
            let value = self.value.at_least(k);
            if value <= 0 {
                continue;
            }
            let [w, u, v] = self.slopes.each_ref().map(|slope| slope.at_most(k));
            let at_middle = value - u - v - LENGTH * self.sides;
            is_point_clear |= at_middle << WORTH > value;
            let left = at_middle - w - LENGTH * (self.by_sides + self.bend / 2 + 1);
            if left > best.1 {
                best = (k, left);
            }
        }
        if best.1 > 0 {
            return Look::Clear(best.0);
        }
        if is_point_clear {
            return Look::TooLong;
        }
        let slopes = self.slopes();
        // A step so short that it is straight.
        let straight = (0..TURN).any(|k| {
            let along = self.slopes[0].at_least(k);
            (along - LENGTH * self.by_sides) << WORTH > along.max(0)
        });
        if slopes == 0 && straight { Look::TooLong } else { Look::Open(slopes) }
    }

    /// The headings about which the derivative by frequency stays in a half plane.
    fn slopes(&self) -> Headings {
        let is_along = |k: &i64| self.slopes[0].at_least(*k) > LENGTH * (self.by_sides + self.bend);
        (0..TURN).filter(is_along).fold(0, |all, k| all | 1 << k)
    }

    /// By how much either parameter moves the function, in parts of 1024: across its way, where that is known. What is off whatever they
    /// are is the part of one of them.
    fn shares(&self, slopes: Headings, slack_axis: usize) -> [i128; 2] {
        let along = (0..TURN).max_by_key(|&k| self.slopes[0].along(k)).unwrap_or(0);
        let [u, v] = [1, 2].map(|i| match slopes {
            0 => self.slopes[i].at_most(0).max(self.slopes[i].at_most(TURN / 4)),
            _ => self.slopes[i].at_most(along + TURN / 4),
        });
        if LENGTH * self.slack > u + v {
            return [0, 1].map(|axis| if axis == slack_axis { 1 << 10 } else { 0 });
        }
        let share = |x: i128| (x << 10) / (u + v + 1);
        [share(u), share(v)]
    }
}

impl Vector {
    fn along(&self, k: i64) -> i128 {
        let [re, im] = heading(k);
        re * self.re + im * self.im
    }

    fn at_least(&self, k: i64) -> i128 {
        self.along(k) - SPAN * self.error
    }

    fn at_most(&self, k: i64) -> i128 {
        self.along(k).abs() + SPAN * self.error
    }
}

/// A vector times `unit 2^power`, with the error of its parts.
fn times(x: &Fixed, unit: &Integer, power: i64) -> [Integer; 3] {
    let by = power.unsigned_abs();
    let floor = |x: &Integer| if power >= 0 { (x * unit) << by } else { (x * unit) >> by };
    [floor(&x.re), floor(&x.im), floor(&x.error) + Integer::from(2)]
}

/// An integer of less than 128 bits.
fn short(x: &Integer) -> i128 {
    let modulus = match x.as_limbs() {
        [] => 0,
        [low] => i128::from(*low),
        [low, high, ..] => i128::from(*low) | i128::from(*high) << 64,
    };
    if x.is_negative() { -modulus } else { modulus }
}

/// The value of a polynomial times `2^shift`, in units of `2^-SCALE`, rounded down.
fn scaled(p: &UniPoly, omega: &Dyadic, shift: u64) -> Integer {
    let n = p.coeffs().len().max(1) - 1;
    let mut sum = Integer::ZERO;
    let mut power = Integer::ONE;
    for (j, c) in p.coeffs().iter().enumerate() {
        sum += (c * &power) << (omega.e * (n - j) as u64);
        power = &power * &omega.m;
    }
    let down = omega.e * n as u64 + shift;
    if down >= SCALE { sum >> (down - SCALE) } else { sum << (SCALE - down) }
}

/// `x 2^power`, rounded up.
fn shifted_up(x: &Integer, power: i64) -> Integer {
    let by = power.unsigned_abs();
    if power >= 0 { x << by } else { -(-x >> by) }
}

#[cfg(test)]
impl Local {
    /// The quarter turn that is within 47 degrees of the value in the middle, where the function stays within 41.9 degrees of that.
    pub(super) fn quarter(&self) -> Option<i64> {
        let modulus = |x: &Vector| Integer::from(x.re.abs() + x.im.abs()) + Integer::from(2 * x.error);
        let rest =
            self.slopes.iter().fold(Integer::from(self.sides + self.by_sides + self.bend), |sum, x| sum + modulus(x));
        let Vector { re, im, error } = self.value;
        let largest = re.abs().max(im.abs());
        // Moduli are at most the sums of those of the parts, and at least the larger of them.
        if rest * Integer::from(3) >= Integer::from(2 * (largest - error)) || largest < error << 5 {
            return None;
        }
        Some(match (re.abs() > im.abs(), re < 0, im < 0) {
            (true, false, _) => 0,
            (false, _, false) => 1,
            (true, true, _) => 2,
            (false, _, true) => 3,
        })
    }
}

#[cfg(test)]
impl Walk<'_> {
    /// Whether the value at zero is negative in the middle of the box.
    pub(super) fn starts_below(&self) -> bool {
        self.first[0].iter().fold(Integer::ZERO, |sum, [re, _]| sum + re.coeff(0)).is_negative()
    }
}

#[cfg(test)]
mod tests;
