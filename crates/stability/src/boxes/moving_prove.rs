//! The proof that a whole box is stable where functions of parameters are in the coefficients.
//!
//! The box is cut in the parameters that functions depend on. In a part every coefficient is a polynomial of low degree in the
//! part's coordinates and in the other parameters, with a bound of all that is left out
//! ([`MultiTaylorModel`], after [MakinoBerz2003](jurist_algebra::bibliography#makinoberz2003)). The Bernstein coefficients of
//! these polynomials are known up to that bound, and prove cells as those of a polynomial do. A part in which the bound is too
//! wide is halved along the parameter in which the coefficients are farthest from straight.

use super::moving::MovingPolynomial;
use super::parts::{Known, Local, Term, add_terms, bundle, coordinates, corners, extent, middle, model_degree, pruned};
use super::polynomial::Bundle;
use super::prove::{BoxProof, Closing, Outcome, closed_by_sign, simplest_point};
use super::reason::OpenReason;
use super::tensor::{FrequencyScale, Tensor};
use crate::subdivision::{BoxPart, Look, Octaves, Order, Tally, decided, subdivide};
use jurist_algebra::ball::{Elementary, MultiTaylorModel};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Integer, Rational, Sign};

/// Bits after the point of coefficients in a part of the box.
const BITS: u64 = 192;

/// Taylor models have about so many coefficients.
pub(super) const MODEL_TERMS: usize = 130;

/// The greatest degree of a Taylor model.
const MODEL_DEGREE: usize = 12;

/// The same where each value is that of a matrix: a third of the terms takes a tenth of the time, and leaves out little that matters.
const OF_MATRICES: (usize, usize) = (36, 8);

/// A tensor of a part has at most so many coefficients for each polynomial; beyond it terms of higher degree are left out.
const TENSOR_TERMS: usize = 1 << 13;

/// Terms smaller than the greatest by so many bits are left out; where that leaves too many, by fewer.
const KEPT_BITS: [u64; 7] = [48, 40, 32, 24, 16, 8, 3];

/// Cells of frequency and parameters in one part.
const CELLS_IN_PART: usize = 600;

/// A part is not halved more often along one parameter.
const MOST_HALVINGS: u32 = 60;

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
        let (most, highest) = if self.is_of_matrices { OF_MATRICES } else { (MODEL_TERMS, MODEL_DEGREE) };
        let degree = model_degree(self.inside.len(), 2..=highest, most);
        let moving = coordinates(sides, &self.inside, BITS, degree);
        // What is not inside of functions is not looked at here.
        let mut parameters = vec![moving[0].integer(&Integer::ZERO); sides.len()];
        for (&i, model) in self.inside.iter().zip(moving) {
            parameters[i] = model;
        }
        self.parts_at(&parameters)
    }

    /// What is known in a part, from the functions' models.
    fn part_of(&self, sides: &[[Rational; 2]], parts: &[Vec<MultiTaylorModel>]) -> Part {
        let mut curvature = vec![Integer::ZERO; sides.len()];
        let mut slacks: Vec<Integer> = Vec::new();
        let mut sized: Vec<Vec<Term>> = Vec::new();
        for (f, parts) in self.functions.iter().zip(parts) {
            let mut slack = Integer::ZERO;
            let mut own = Vec::new();
            for ((beside, _), model) in f.iter().zip(parts) {
                slack += add_terms(&mut own, (model, beside), &self.inside, sides);
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
        let look = |cell: &mut Octaves, tally: Tally| {
            let Octaves(BoxPart { sides, halvings }) = cell;
            checkpoint(1000);
            let part = self.part(sides);
            let proved = match &part {
                None => Err(sides.clone()),
                Some(part) => {
                    part.proved(sides, &self.inside, self.coefficients(), known, (closing, CELLS_IN_PART), budget)?
                }
            };
            let last = match proved {
                Ok(count) => return Ok(Look::Decided(count)),
                Err(cell) => cell,
            };
            let is_last = tally.cells() + 1 > cells;
            if (tally.halved.is_multiple_of(TESTED_EVERY) || is_last)
                && let Some(outcome) = refuted(simplest_point(&last)).or_else(|| refuted(middle(&last)))
            {
                return Ok(Look::Open(outcome));
            }
            let is_wide = |i: &usize| sides[*i][0] < sides[*i][1] && halvings[*i] < MOST_HALVINGS;
            let axis = self.axis_to_cut(sides, part.as_ref(), is_wide);
            Ok(axis.filter(|_| !is_last).map_or_else(
                || {
                    let why = if is_last { OpenReason::Cells } else { OpenReason::Small };
                    let corner = corners(&last).find_map(refuted);
                    Look::Open(corner.unwrap_or(Outcome::Open { why, cell: last }))
                },
                Look::Cut,
            ))
        };
        let whole = Octaves(BoxPart::whole(whole));
        Ok(match subdivide([whole], Order::Depth, budget, look)? {
            Ok(steps) => Outcome::Stable(BoxProof::of_cells(known.1, decided(steps).sum())),
            Err(outcome) => outcome,
        })
    }

    /// The side along which a part is cut, of those that are inside of functions and wide.
    fn axis_to_cut(
        &self,
        sides: &[[Rational; 2]],
        part: Option<&Part>,
        is_wide: impl Fn(&usize) -> bool,
    ) -> Option<usize> {
        let axes = self.inside.iter().copied().filter(&is_wide);
        match part {
            Some(Part { curvature, .. }) => axes.max_by(|&i, &j| (&curvature[i], j).cmp(&(&curvature[j], i))),
            // Nothing is known of the functions: along the widest side of a divisor, if there is any.
            None => {
                let longest = |a: &usize, b: &usize| (extent(&sides[*a]), b).cmp(&(extent(&sides[*b]), a));
                self.below.iter().copied().filter(&is_wide).max_by(longest).or_else(|| axes.max_by(longest))
            }
        }
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
        let local = Local::new(sides, inside);
        for (f, sign) in self.functions[coefficients..].iter().zip(reference) {
            let bundle = bundle(std::slice::from_ref(f), sides.len());
            let tensor = Tensor::of_one_within(&bundle, &f.slack, &local.sides);
            let signed = closed_by_sign(*sign);
            if let Err(cell) = local.closed(tensor, (&signed, most), budget)? {
                return Ok(Err(cell));
            }
        }
        let own = &self.functions[..coefficients];
        let bounds = own.iter().map(|f| f.slack.clone()).collect();
        let slack = Bundle { width: coefficients, degrees: Vec::new(), terms: vec![(Vec::new(), bounds)] }.pair();
        let slack: Vec<Integer> = slack.terms[0].1.iter().map(Integer::abs).collect();
        let pair = bundle(own, sides.len()).pair();
        let (tensor, _) = Tensor::of_pair_within(&pair, &slack, &local.sides, FrequencyScale(2 * scale));
        local.closed(tensor, (closing, most), budget)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_have_the_degree_that_the_number_of_variables_allows() {
        let degree = |variables| model_degree(variables, 2..=MODEL_DEGREE, MODEL_TERMS);
        assert_eq!([1, 2, 3, 4, 5, 6, 9, 30].map(degree), [12, 12, 7, 5, 4, 3, 2, 2]);
        let (most, highest) = OF_MATRICES;
        assert_eq!([1, 2, 3, 4].map(|n| model_degree(n, 2..=highest, most)), [8, 7, 4, 3]);
    }
}
