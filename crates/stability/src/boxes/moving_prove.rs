//! The proof that a whole box is stable where functions of parameters are in the coefficients.
//!
//! The box is cut in the parameters that functions depend on. In a part every coefficient is a polynomial of low degree in the
//! part's coordinates and in the other parameters, with a bound of all that is left out
//! ([`MultiTaylorModel`], after [MakinoBerz2003](jurist_algebra::bibliography#makinoberz2003)). The Bernstein coefficients of
//! these polynomials are known up to that bound, and prove cells as those of a polynomial do. A part in which the bound is too
//! wide is halved along the parameter in which the coefficients are farthest from straight.

use super::moving::MovingPolynomial;
use super::parts::{Known, Term, bundle, closed, corners, extent, is_blurred, middle, pruned};
use super::polynomial::Bundle;
use super::prove::{BoxProof, Cell, Closing, Outcome, simplest_point};
use super::tensor::{FrequencyScale, Tensor};
use super::tree::Tree;
use jurist_algebra::ball::{Ball, Elementary, MultiTaylorModel};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};

/// Bits after the point of coefficients in a part of the box.
const BITS: u64 = 192;

/// Taylor models have about so many coefficients.
const MODEL_TERMS: usize = 130;

/// The greatest degree of a Taylor model.
const MODEL_DEGREE: usize = 12;

/// A tensor of a part has at most so many coefficients for each polynomial; beyond it terms of higher degree are left out.
const TENSOR_TERMS: usize = 1 << 13;

/// Terms smaller than the greatest by so many bits are left out; where that leaves too many, by fewer.
const KEPT_BITS: [u64; 7] = [48, 40, 32, 24, 16, 8, 3];

/// Cells of frequency and parameters in one part.
const CELLS_IN_PART: usize = 600;

/// A part is not halved more often along one parameter.
const MOST_HALVINGS: u32 = 60;

/// A side whose ends have at least this ratio is cut at the middle of its octaves.
const LEAST_RATIO: i64 = 2;

/// Binary digits of such a cut.
const CUT_BITS: u64 = 8;

/// After so many parts in which nothing was proved a point of the present one is tested.
const TESTED_EVERY: usize = 8;

/// What is known of a loop in a part of a box: coordinates of what is inside of functions go from -1 to 1.
struct Part {
    /// The coefficients in the half plane, then what must not vanish.
    functions: Vec<Known>,
    /// For each parameter how far the functions are from straight in it.
    curvature: Vec<Integer>,
}

impl MovingPolynomial {
    /// What is known in a part; `None` where something may not be defined.
    fn part(&self, sides: &[[Rational; 2]]) -> Option<Part> {
        Some(self.part_of(sides, &self.models(sides)?))
    }

    /// The parts of all functions over sides of what is inside of functions: other sides do not change them.
    pub(super) fn models(&self, sides: &[[Rational; 2]]) -> Option<Vec<Vec<MultiTaylorModel>>> {
        let count = self.inside.len();
        let lines: Vec<(Ball, Ball)> = self
            .inside
            .iter()
            .map(|&i| {
                let [low, high] = &sides[i];
                let middle = low.midpoint(high);
                (Ball::from_rational(&middle, BITS), Ball::from_rational(&(high - &middle), BITS))
            })
            .collect();
        let moving = MultiTaylorModel::linear(&lines, model_degree(count));
        // What is not inside of functions is not looked at here.
        let mut parameters = vec![moving[0].integer(&Integer::ZERO); sides.len()];
        for (&i, model) in self.inside.iter().zip(moving) {
            parameters[i] = model;
        }
        self.parts_at(&parameters)
    }

    /// What is known in a part, from the functions' models.
    fn part_of(&self, sides: &[[Rational; 2]], parts: &[Vec<MultiTaylorModel>]) -> Part {
        let most = |beside: &[u32]| {
            let powers = beside.iter().zip(sides).filter(|(e, _)| **e > 0);
            powers.fold(Rational::ONE, |product, (&e, [low, high])| {
                let largest = low.abs().max(high.abs());
                &product * &largest.pow(i64::from(e)).expect("a positive exponent")
            })
        };
        let mut curvature = vec![Integer::ZERO; sides.len()];
        let mut slacks: Vec<Integer> = Vec::new();
        let mut sized: Vec<Vec<Term>> = Vec::new();
        for (f, parts) in self.functions.iter().zip(parts) {
            let mut slack = Integer::ZERO;
            let mut own = Vec::new();
            for ((beside, _), model) in f.iter().zip(parts) {
                let bound = most(beside);
                let size = |c: &Integer| (&Rational::from(c.abs()) * &bound).ceil();
                slack += &size(model.rest_units());
                for (exponents, c) in model.terms().filter(|(_, c)| !c.is_zero()) {
                    let mut all = beside.clone();
                    for (&i, &e) in self.inside.iter().zip(exponents) {
                        all[i] = e;
                    }
                    own.push(Term { exponents: all, coefficient: c.clone(), size: size(c) });
                }
            }
            let largest = own.iter().map(|term| &term.size).max().cloned().unwrap_or(Integer::ONE);
            for Term { exponents, size, .. } in &own {
                let total: u32 = self.inside.iter().map(|&i| exponents[i]).sum();
                for &i in self.inside.iter().filter(|_| total > 1) {
                    let share = (&(size * &Integer::from(u64::from(exponents[i]))) << BITS).div_mod_floor(&largest).0;
                    curvature[i] += &share;
                }
            }
            sized.push(own);
            slacks.push(slack);
        }
        let functions = pruned(sized, slacks, &self.inside, self.formal_degree() / 2 + 1, (TENSOR_TERMS, &KEPT_BITS));
        Part { functions, curvature }
    }

    /// Whether no root comes to the boundary in a box, taken as one part, and nothing that must not vanish changes its sign.
    pub(super) fn keeps_count(
        &self,
        sides: &[[Rational; 2]],
        models: &[Vec<MultiTaylorModel>],
        known: (&[Sign], i64),
        closing: (Closing, usize),
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let part = self.part_of(sides, models);
        Ok(part.proved(sides, &self.inside, self.coefficients(), known, closing, budget)?.is_ok())
    }

    /// Decides one box with at most so many parts, cells of them closed in this way.
    pub(super) fn proved(
        &self,
        whole: &[[Rational; 2]],
        known: (&[Sign], i64),
        (closing, cells): (Closing, usize),
        budget: &Budget,
    ) -> Result<Outcome, Exhausted> {
        let refuted = |point: Vec<Rational>| (self.seen_at(&point) == Some(false)).then_some(Outcome::Refuted(point));
        let mut stack = vec![(whole.to_vec(), vec![0u32; whole.len()])];
        let (mut parts, mut proved, mut missed) = (0, 0, 0);
        while let Some((sides, halvings)) = stack.pop() {
            budget.check()?;
            parts += 1;
            checkpoint(1000);
            let part = self.part(&sides);
            let mut last = sides.clone();
            let curvature = match &part {
                None => None,
                Some(part) => match part.proved(
                    &sides,
                    &self.inside,
                    self.coefficients(),
                    known,
                    (closing, CELLS_IN_PART),
                    budget,
                )? {
                    Ok(count) => {
                        proved += count;
                        continue;
                    }
                    Err(cell) => {
                        last = cell;
                        Some(&part.curvature)
                    }
                },
            };
            missed += 1;
            let is_last = parts + stack.len() > cells;
            if (missed % TESTED_EVERY == 1 || is_last)
                && let Some(outcome) = refuted(simplest_point(&last)).or_else(|| refuted(middle(&last)))
            {
                return Ok(outcome);
            }
            let wide = |i: &usize| sides[*i][0] < sides[*i][1] && halvings[*i] < MOST_HALVINGS;
            let axes = self.inside.iter().copied().filter(wide);
            let axis = match curvature {
                Some(curvature) => axes.max_by(|&i, &j| (&curvature[i], j).cmp(&(&curvature[j], i))),
                // Nothing is known of the functions: along the widest side of a divisor, if there is any.
                None => {
                    let longest = |a: &usize, b: &usize| (extent(&sides[*a]), b).cmp(&(extent(&sides[*b]), a));
                    self.below.iter().copied().filter(wide).max_by(longest).or_else(|| axes.max_by(longest))
                }
            };
            let Some(axis) = axis.filter(|_| !is_last) else {
                let corners = corners(&last).find_map(refuted);
                let why = if is_last { "too many cells" } else { "a cell too small" };
                return Ok(corners.unwrap_or(Outcome::Open { why, cell: last }));
            };
            let middle = cut(&sides[axis]);
            let (mut low, mut high) = (sides.clone(), sides);
            (low[axis][1], high[axis][0]) = (middle.clone(), middle);
            let mut deeper = halvings;
            deeper[axis] += 1;
            stack.extend([(high, deeper.clone()), (low, deeper)]);
        }
        let pair = Tree::default();
        Ok(Outcome::Stable(BoxProof { certain: Vec::new(), scale: known.1, weight: 0, pair, beside: proved }))
    }
}

impl Part {
    /// The number of cells, of at most so many, that prove the part; else the cell in which that is not seen.
    fn proved(
        &self,
        sides: &[[Rational; 2]],
        inside: &[usize],
        coefficients: usize,
        (reference, scale): (&[Sign], i64),
        (closing, most): (Closing, usize),
        budget: &Budget,
    ) -> Result<Result<usize, Vec<[Rational; 2]>>, Exhausted> {
        let mut local = sides.to_vec();
        for &i in inside {
            local[i] = [-Rational::ONE, Rational::ONE];
        }
        // From the coordinates of the part back to the parameters.
        let back = |cell: Vec<[Rational; 2]>| {
            let mut out = cell;
            for &i in inside {
                let [low, high] = &sides[i];
                let half = Rational::new(1.into(), 2.into());
                out[i] = out[i].each_ref().map(|u| low + &(&(&(high - low) * &half) * &(u + &Rational::ONE)));
            }
            out
        };
        for (f, sign) in self.functions[coefficients..].iter().zip(reference) {
            let bundle = bundle(std::slice::from_ref(f), sides.len());
            let tensor = Tensor::of_one_within(&bundle, &f.slack, &local);
            let mut stack = vec![Cell::whole(tensor)];
            let mut cells = 0;
            while let Some(cell) = stack.pop() {
                budget.check()?;
                cells += 1;
                let ((low, high), error) = (cell.tensor.range(0), cell.tensor.greatest_error());
                if if sign.is_gt() { low > error } else { high < -error } {
                    continue;
                }
                let axis = cell.tensor.best_axis().filter(|_| !is_blurred(&cell) && cells < most);
                let Some(axis) = axis else { return Ok(Err(back(cell.sides(&local)))) };
                stack.extend(cell.halves(axis));
            }
        }
        let own = &self.functions[..coefficients];
        let bounds = own.iter().map(|f| f.slack.clone()).collect();
        let slack = Bundle { width: coefficients, degrees: Vec::new(), terms: vec![(Vec::new(), bounds)] }.pair();
        let slack: Vec<Integer> = slack.terms[0].1.iter().map(Integer::abs).collect();
        let pair = bundle(own, sides.len()).pair();
        let (tensor, _) = Tensor::of_pair_within(&pair, &slack, &local, FrequencyScale(2 * scale));
        Ok(closed(tensor, closing, most, budget)?.map_err(|cell| back(cell.sides(&local))))
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

/// The degree of Taylor models in so many variables.
fn model_degree(variables: usize) -> usize {
    let terms = |degree: usize| (1..=variables).fold(1, |n, i| n * (degree + i) / i);
    (2..=MODEL_DEGREE).rev().find(|&degree| terms(degree) <= MODEL_TERMS).unwrap_or(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;

    #[test]
    fn sides_of_several_octaves_are_cut_between_these() {
        let at = |low: &str, high: &str| cut(&[low, high].map(|x| parse_number(x).unwrap())).to_string();
        assert_eq!([at("1", "16"), at("-16", "-1"), at("1/1024", "1/64")], ["4", "-4", "1/256"]);
        assert_eq!([at("-1", "3"), at("0", "4"), at("3", "5")], ["1", "2", "4"]);
    }

    #[test]
    fn models_have_the_degree_that_the_number_of_variables_allows() {
        assert_eq!([1, 2, 3, 4, 5, 6, 9, 30].map(model_degree), [12, 12, 7, 5, 4, 3, 2, 2]);
    }
}
