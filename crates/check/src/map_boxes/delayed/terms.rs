//! The characteristic function of a loop with dead time, sorted by its dead times.

use crate::clock::Clock;
use crate::map_boxes::Sides;
use crate::moving::Sources;
use crate::multivariate::Multi;
use crate::number::{Q, Z};
use crate::over_box::{FIRST, OverBox};
use crate::over_symbols::primitive;
use num_traits::Zero;
use std::collections::BTreeMap;

/// Higher orders are refused.
const MAX_ORDER: usize = 64;

/// Dead times with longer numbers are refused.
const MAX_BITS: u64 = 4096;

/// The offset, and a slope for each parameter of the box.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Time {
    offset: Q,
    slopes: Vec<Q>,
}

impl Time {
    fn zero(parameters: usize) -> Self {
        Time { offset: Q::zero(), slopes: vec![Q::zero(); parameters] }
    }

    /// A quotient that is linear in the parameters of the box.
    fn of((top, below): (&Multi, &Multi), parameters: usize) -> Result<Self, String> {
        let not_linear = || "a dead time is not linear in the parameters of the box".to_owned();
        let over = below.0.get(&Vec::new()).filter(|_| below.is_constant()).ok_or_else(not_linear)?;
        let mut time = Time::zero(parameters);
        for (e, c) in &top.0 {
            let place = match e.get(FIRST..).unwrap_or(&[]) {
                [] => &mut time.offset,
                // No zeros are at the end.
                [others @ .., 1] if others.iter().all(|k| *k == 0) => {
                    time.slopes.get_mut(others.len()).ok_or_else(not_linear)?
                }
                _ => return Err(not_linear()),
            };
            *place = Q::new(c.clone(), over.clone());
            if is_long(place) {
                return Err("a dead time has too many digits".into());
            }
        }
        Ok(time)
    }

    fn plus(&self, other: &Time, times: i64) -> Time {
        let times = Q::from(Z::from(times));
        let slopes = self.slopes.iter().zip(&other.slopes).map(|(own, other)| own + other * &times).collect();
        Time { offset: &self.offset + &other.offset * &times, slopes }
    }

    pub fn is_zero(&self) -> bool {
        self.offset.is_zero() && self.slopes.iter().all(Zero::is_zero)
    }

    /// The least and the greatest value in a box.
    pub fn range(&self, sides: &Sides) -> [Q; 2] {
        let [mut least, mut most] = [self.offset.clone(), self.offset.clone()];
        for (slope, [low, high]) in self.slopes.iter().zip(sides) {
            let (a, b) = (slope * low, slope * high);
            let (low, high) = if a <= b { (a, b) } else { (b, a) };
            least += low;
            most += high;
        }
        [least, most]
    }

    /// The value in the middle of a box, and by how much half of each side changes it, times a number.
    pub fn about_middle(&self, sides: &Sides, factor: &Q) -> (Q, Vec<Q>) {
        let two = Q::from(Z::from(2));
        let by_half = |(slope, [low, high]): (&Q, &[Q; 2])| slope * (high - low) / &two * factor;
        let change = self.slopes.iter().zip(sides).map(by_half).collect();
        let [least, most] = self.range(sides);
        ((least + most) / two * factor, change)
    }
}

pub(crate) fn is_long(q: &Q) -> bool {
    q.numer().bits().max(q.denom().bits()) > MAX_BITS
}

/// `sum P_k(s) exp(-tau_k s)` with polynomials in `s`, the parameters and the functions of them, `tau_0 = 0`.
pub(super) struct Terms {
    /// The coefficients of `s^0, ..., s^n` for each dead time, that of zero first.
    pub terms: Vec<(Time, Vec<Multi>)>,
    /// The dead times of the model.
    pub times: Vec<Time>,
    /// The loop is undefined where all polynomials of one of these lists vanish.
    pub divisors: Vec<Vec<Multi>>,
}

impl Terms {
    /// Of a box of so many parameters.
    pub fn new(own: OverBox, sources: &Sources, parameters: usize, clock: &Clock) -> Result<Self, String> {
        let first = FIRST + parameters;
        let mut places = Vec::new();
        let mut times = Vec::new();
        for (place, top, below) in sources.dead_times()? {
            times.push(Time::of((top, below), parameters)?);
            places.push(first + place);
        }
        if sources.are_inside(&places) {
            return Err("a function of the loop's variable".into());
        }
        let n = own.coefficients.len() - 1;
        let is_delayed = |p: &Multi| places.iter().any(|place| p.degree(*place) > 0);
        let mut divisors = own.divisors;
        if own.has_lead_last {
            // It is looked at where the highest power is to outweigh the rest.
            divisors.pop();
        }
        if divisors.iter().flatten().any(is_delayed) {
            return Err("a divisor depends on the dead time".into());
        }
        let mut sorted: BTreeMap<Time, Vec<Multi>> = BTreeMap::new();
        for (j, coefficient) in primitive(own.coefficients, clock)?.into_iter().enumerate() {
            for (mut own, c) in coefficient.0 {
                clock.tick()?;
                let mut total = Time::zero(parameters);
                for (time, &place) in times.iter().zip(&places) {
                    if let Some(k) = own.get_mut(place) {
                        total = total.plus(time, i64::from(std::mem::take(k)));
                    }
                }
                while own.last() == Some(&0) {
                    own.pop();
                }
                let part = sorted.entry(total).or_insert_with(|| vec![Multi::default(); n + 1]);
                part[j] = part[j].plus(&Multi(BTreeMap::from([(own, c)])));
            }
        }
        let mut terms: Vec<(Time, Vec<Multi>)> =
            sorted.into_iter().filter(|(_, part)| part.iter().any(|c| !c.is_zero())).collect();
        // A dead time that all have in common moves no root: that of the highest power of s is taken for it.
        let leads = |(_, part): &(Time, Vec<Multi>)| !part[n].is_zero();
        let first = terms.iter().position(|term| leads(term) && term.0.is_zero());
        let Some(first) = first.or_else(|| terms.iter().position(leads)).filter(|_| (1..=MAX_ORDER).contains(&n))
        else {
            return Err("the loop is not well posed, or has no fitting order".into());
        };
        terms.swap(0, first);
        let common = terms[0].0.clone();
        terms.iter_mut().for_each(|(time, _)| *time = time.plus(&common, -1));
        Ok(Terms { terms, times, divisors })
    }

    /// The exponent of a power of two that is about the size of the roots: where the highest power begins to outweigh the others, by the
    /// lengths of the largest terms of all coefficients at a point.
    pub fn scale(&self, point: &[Q]) -> i64 {
        let length = |q: &Q| q.numer().bits() as i64 - q.denom().bits() as i64;
        let lengths: Vec<i64> = point.iter().map(length).collect();
        let of_term = |(e, c): (&Vec<u32>, &Z)| {
            let powers = e.iter().skip(FIRST).zip(&lengths);
            c.bits() as i64 + powers.map(|(k, length)| i64::from(*k) * length).sum::<i64>()
        };
        let n = self.terms[0].1.len() - 1;
        let size = |j: usize| self.terms.iter().flat_map(|(_, part)| part[j].0.iter()).map(of_term).max();
        let Some(top) = size(n) else { return 0 };
        let roots = (0..n).filter_map(|j| Some((size(j)? - top).div_euclid((n - j) as i64) + 1));
        roots.max().unwrap_or(0)
    }
}
