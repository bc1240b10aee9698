//! Approximations of the roots of a quasi-polynomial in floating point. Nothing that is found here is certain; discs and counts are.

use super::QuasiPolynomial;
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{UniPoly, complex_roots};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Approximate {
    pub re: f64,
    pub im: f64,
}

impl Approximate {
    const ZERO: Approximate = Approximate { re: 0.0, im: 0.0 };

    fn plus(self, other: Approximate) -> Approximate {
        Approximate { re: self.re + other.re, im: self.im + other.im }
    }

    fn minus(self, other: Approximate) -> Approximate {
        self.plus(other.scaled(-1.0))
    }

    fn times(self, other: Approximate) -> Approximate {
        Approximate { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    fn scaled(self, x: f64) -> Approximate {
        Approximate { re: self.re * x, im: self.im * x }
    }

    /// Not finite for a divisor that is zero.
    fn over(self, other: Approximate) -> Approximate {
        // The divisor's size goes first, so that no square is out of range.
        let size = other.size();
        let other = other.scaled(1.0 / size);
        self.times(other.conjugate()).scaled(1.0 / size)
    }

    fn conjugate(self) -> Approximate {
        Approximate { re: self.re, im: -self.im }
    }

    fn size(self) -> f64 {
        self.re.hypot(self.im)
    }
}

/// The function in `w = s q tau`, the longest dead time being 1, and the roots of it that are known.
#[derive(Debug)]
pub(super) struct Search {
    /// The coefficients of `P_k` in `w`, the largest of all being 1.
    parts: Vec<Vec<f64>>,
    /// `1/(q tau)`.
    pub unit: f64,
    /// How often 0 is a root.
    at_zero: usize,
    /// In `w`; of a pair of conjugates the upper one.
    roots: Vec<Approximate>,
    /// Roots of polynomials that some of the roots are near to.
    near: Vec<Approximate>,
}

/// Roots whose imaginary part is smaller beside them are real ones.
const REAL: f64 = 1e-8;

/// Roots that are nearer to each other, beside their size, are taken for one.
const EQUAL: f64 = 1e-7;

/// Further left powers of `z` are out of the range of numbers.
const MOST_DECAY: f64 = 600.0;

/// Where large terms cancel, steps that are not larger beside the number are rounding.
const ROUNDED: f64 = 1e-5;

/// Steps of Newton's method.
const STEPS: usize = 60;

/// Steps above what is looked at in any case.
const MOST_ABOVE: usize = 4000;

/// Roots after which a search ends.
const MOST_ROOTS: usize = 4000;

impl Search {
    /// Nothing is known but that 0 is a root so many times.
    ///
    /// # Errors
    /// [`Exhausted`].
    pub fn new(p: &QuasiPolynomial, tau: &Rational, at_zero: usize, budget: &Budget) -> Result<Search, Exhausted> {
        let time = Rational::from(p.delays() as i64) * tau;
        let over = |j: usize| time.pow(-(j as i64)).expect("the dead time is positive");
        let scaled = |part: &UniPoly| -> Vec<Rational> {
            part.coeffs().iter().enumerate().map(|(j, c)| Rational::from(c) * over(j)).collect()
        };
        let parts: Vec<Vec<Rational>> = p.parts().iter().map(scaled).collect();
        let largest = parts.iter().flatten().map(Rational::abs).max().expect("the function is not zero");
        let rounded = |c: &Rational| c.checked_div(&largest).map_or(0.0, |c| c.to_f64_approximate());
        let mut near = Vec::new();
        let rough = Rational::dyadic(&1.into(), 24);
        for polynomial in [p.without_delay(), p.parts()[0].clone()] {
            if polynomial.is_constant() {
                continue;
            }
            for disc in complex_roots(&polynomial, &rough, budget)? {
                let [re, im] = [&disc.re, &disc.im].map(|x| (x * &time).to_f64_approximate());
                near.push(Approximate { re, im });
            }
        }
        let parts = parts.iter().map(|part| part.iter().map(rounded).collect()).collect();
        let unit = time.recip().expect("the dead time is positive").to_f64_approximate();
        Ok(Search { parts, unit, at_zero, roots: Vec::new(), near })
    }

    /// The roots that are known but 0, of pairs the upper one; in `s`.
    pub fn found_approximate(&self) -> impl Iterator<Item = Approximate> {
        self.roots.iter().map(|root| root.scaled(self.unit))
    }

    /// Searches for roots, about so many right of a real part, more densely and further in each round.
    ///
    /// # Errors
    /// [`Exhausted`].
    pub fn look_approximate(
        &mut self,
        wanted: usize,
        floor: f64,
        round: u32,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        let mut starts = Vec::new();
        if round == 0 {
            // What is exactly on the axis, or on another root, has no way off it.
            starts.extend(self.near.iter().map(|root| root.plus(Approximate { re: 0.0, im: 1e-3 * root.size() })));
            starts.extend(self.near.iter().map(|root| Approximate { im: 0.0, re: root.re * 1.001 + 1e-9 }));
        }
        self.rings(round, &mut starts);
        let dense = f64::from(1u32 << round);
        let (step, top) = (FRAC_PI_2 / dense, TAU * (wanted as f64 + 4.0) * dense);
        let mut y = step / 3.0;
        while y < top {
            checkpoint(self.parts.len() as u64);
            self.balanced(y, &mut starts);
            y += step;
        }
        let widest = self.near.iter().fold(1.0, |most: f64, root| most.max(root.size()));
        let far = 4.0 * top + 20.0 * widest;
        self.follow_approximate(&starts, far, budget)?;
        // Further up, as long as roots are to be expected that are not left of all that are wanted.
        let end = top.max(2.0 * widest);
        for _ in 0..MOST_ABOVE << round {
            let least = self.least_approximate(wanted).max(floor / self.unit);
            starts.clear();
            checkpoint(self.parts.len() as u64);
            self.balanced(y, &mut starts);
            starts.retain(|start| start.re >= least);
            if starts.is_empty() && y > end {
                break;
            }
            self.follow_approximate(&starts, far + 4.0 * y, budget)?;
            y += step;
        }
        Ok(())
    }

    /// Newton's method from each of these points.
    fn follow_approximate(&mut self, starts: &[Approximate], far: f64, budget: &Budget) -> Result<(), Exhausted> {
        for start in starts {
            budget.check()?;
            if self.roots.len() >= MOST_ROOTS {
                break;
            }
            if let Some(root) = budget.enter(|| self.newton(*start, far))? {
                self.roots.push(root);
            }
        }
        Ok(())
    }

    /// The real part of the last of so many known roots, from the right.
    fn least_approximate(&self, wanted: usize) -> f64 {
        let mut reals: Vec<f64> = self.roots.iter().map(|root| root.re).collect();
        if reals.len() <= wanted {
            return f64::NEG_INFINITY;
        }
        let (_, least, _) = reals.select_nth_unstable_by(wanted, |a, b| b.total_cmp(a));
        *least
    }

    /// Points on rings about 0.
    fn rings(&self, round: u32, out: &mut Vec<Approximate>) {
        let rings = 12 * (round as i32 + 1);
        let points = 4 * (round as usize + 1);
        for j in -4..rings {
            let size = 0.9 * 2f64.powf(-f64::from(j) / f64::from(round + 1) * 2.0 + 2.0);
            for k in 0..=points {
                let angle = PI * k as f64 / points as f64;
                let im = if k % points == 0 { 0.0 } else { size * angle.sin() };
                out.push(Approximate { re: size * angle.cos(), im });
            }
        }
    }

    /// Points of this imaginary part at which two terms are equally large and no other is larger.
    fn balanced(&self, y: f64, out: &mut Vec<Approximate>) {
        let q = (self.parts.len() - 1) as f64;
        let size = |k: usize, x: f64| polynomial(&self.parts[k], Approximate { re: x, im: y })[0].size().ln();
        let hull = |x: f64| {
            let mut hull: Vec<(usize, f64)> = Vec::new();
            for k in 0..self.parts.len() {
                let own = size(k, x);
                if !own.is_finite() {
                    continue;
                }
                while let [.., a, b] = hull.as_slice()
                    && (own - b.1) * (b.0 - a.0) as f64 >= (b.1 - a.1) * (k - b.0) as f64
                {
                    hull.pop();
                }
                hull.push((k, own));
            }
            hull
        };
        for edge in hull(0.0).windows(2) {
            let [(k, _), (l, _)] = [edge[0], edge[1]];
            let mut x = 0.0;
            for _ in 0..3 {
                x = q * (size(l, x) - size(k, x)) / (l - k) as f64;
            }
            if x.is_finite() {
                out.push(Approximate { re: x, im: y });
            }
        }
    }

    /// The value and the derivative, both divided by the size of the largest power of `z`.
    fn values(&self, w: Approximate) -> [Approximate; 2] {
        let q = (self.parts.len() - 1) as f64;
        let shift = w.re.min(0.0);
        let (mut value, mut slope) = (Approximate::ZERO, Approximate::ZERO);
        for (k, part) in self.parts.iter().enumerate().filter(|(_, part)| !part.is_empty()) {
            let share = k as f64 / q;
            let (size, angle) = ((shift - w.re * share).exp(), -w.im * share);
            let z = Approximate { re: size * angle.cos(), im: size * angle.sin() };
            let [own, own_slope] = polynomial(part, w);
            value = value.plus(own.times(z));
            slope = slope.plus(own_slope.minus(own.scaled(share)).times(z));
        }
        [value, slope]
    }

    /// Newton's method for the function divided by what belongs to the known roots.
    fn newton(&self, start: Approximate, far: f64) -> Option<Approximate> {
        checkpoint((STEPS * (self.parts.len() + self.roots.len())) as u64 / 8);
        let mut w = start;
        let mut settled = false;
        for _ in 0..STEPS {
            let [value, slope] = self.values(w);
            let newton = value.over(slope);
            let step = newton.over(Approximate { re: 1.0, im: 0.0 }.minus(newton.times(self.pull(w))));
            w = w.minus(step);
            if !w.re.is_finite() || !w.im.is_finite() || w.size() > far || w.re < -MOST_DECAY {
                return None;
            }
            settled = step.size() <= ROUNDED * w.size();
            if step.size() <= 1e-12 * w.size() {
                break;
            }
        }
        self.polished(w).filter(|_| settled)
    }

    /// Two more steps without division; `None` for what is known.
    fn polished(&self, mut w: Approximate) -> Option<Approximate> {
        for _ in 0..2 {
            let [value, slope] = self.values(w);
            let step = value.over(slope);
            if step.size() <= 1e-9 * w.size() {
                w = w.minus(step);
            }
        }
        w.im = w.im.abs();
        if w.im <= REAL * w.size() {
            w.im = 0.0;
        }
        let is_known = |root: &Approximate| root.minus(w).size() <= EQUAL * w.size();
        let finite = w.re.is_finite() && w.im.is_finite() && w.size() > 0.0;
        (finite && !self.roots.iter().any(is_known)).then_some(w)
    }

    /// The logarithmic derivative of the known linear factors.
    fn pull(&self, w: Approximate) -> Approximate {
        let one = Approximate { re: 1.0, im: 0.0 };
        let mut sum = Approximate::ZERO;
        // What is further away changes the way by little.
        let reach = 30.0 + w.size() / 2.0;
        let mut add = |root: Approximate, times: f64| {
            if (root.re - w.re).abs() > reach || (root.im - w.im).abs() > reach {
                return;
            }
            let term = one.over(w.minus(root)).scaled(times);
            if term.re.is_finite() && term.im.is_finite() {
                sum = sum.plus(term);
            }
        };
        if self.at_zero > 0 {
            add(Approximate::ZERO, self.at_zero as f64);
        }
        for root in &self.roots {
            add(*root, 1.0);
            if root.im != 0.0 {
                add(root.conjugate(), 1.0);
            }
        }
        sum
    }
}

/// The value of a polynomial and of its derivative.
fn polynomial(coefficients: &[f64], w: Approximate) -> [Approximate; 2] {
    let (mut value, mut slope) = (Approximate::ZERO, Approximate::ZERO);
    for c in coefficients.iter().rev() {
        slope = slope.times(w).plus(value);
        value = value.times(w).plus(Approximate { re: *c, im: 0.0 });
    }
    [value, slope]
}
