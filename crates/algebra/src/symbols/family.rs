//! Matrices of functions of parameters whose characteristic polynomials are known by their values alone.
//!
//! A loop with several modes behind a hold has a short matrix and a long characteristic polynomial. The matrix is evaluated at enclosures, series or
//! Taylor models of its parameters, exponentials of matrices as a whole, and the coefficients follow by arithmetic: nothing is expanded.

use super::Definition;
use super::tiles::Tiles;
use super::values::{Evaluation, quotient};
use crate::ball::{Ball, Elementary, characteristic_polynomial, exponential_along};
use crate::matrix::RationalMatrix;
use crate::number::{Integer, Rational};
use crate::poly::RationalFunction;
use std::sync::Arc;

/// There are at most so many characteristic polynomials at values of the gains.
const MOST_NODES: usize = 15;

/// What a variable of a [`MatrixFamily`] beyond its parameters stands for, in those before it.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A function of earlier variables.
    Function(Definition),
    /// A rational function of earlier variables.
    Value(RationalFunction),
    /// An entry of the exponential of a matrix.
    Flow {
        /// The number of the matrix.
        of: usize,
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
}

/// The matrices `A + sum K_i B_i` over some gains `K_i`, in parameters and in functions of them.
///
/// Its values are the coefficients of the powers of `w` in `det((w + 1) I - A - sum K_i B_i)`, for each product of powers of gains: near `z = 1` the
/// polynomial in `w = z - 1` has no digits that cancel. Other functions of the same variables come after them.
#[derive(Clone, Debug)]
pub struct MatrixFamily {
    parameters: usize,
    steps: Vec<Step>,
    flows: Vec<RationalMatrix>,
    /// For each of the flows `R` and `f` if its matrix is `R f`, numbers times one function.
    rates: Vec<Option<(Vec<Rational>, RationalFunction)>>,
    constant: RationalMatrix,
    slopes: Vec<RationalMatrix>,
    beside: Vec<RationalFunction>,
    /// Exponents of the gains, those of lower degree first.
    monomials: Vec<Vec<u32>>,
    /// For each monomial the weight of the polynomial at each node: nodes are the exponents as numbers.
    weights: Vec<Vec<Rational>>,
    tiles: Tiles,
}

/// The variables of a [`MatrixFamily`]: parameters, and what follows from them.
#[derive(Clone, Debug, Default)]
pub struct FamilyVariables {
    /// How many parameters come first.
    pub parameters: usize,
    /// The other variables.
    pub steps: Vec<Step>,
    /// The matrices whose exponentials stay whole.
    pub flows: Vec<RationalMatrix>,
}

impl MatrixFamily {
    /// From the matrix, what each gain adds to it, and a bound of the degree of its characteristic polynomial in all gains. `None` where the degree
    /// is large.
    pub fn new(
        variables: FamilyVariables,
        constant: RationalMatrix,
        slopes: Vec<RationalMatrix>,
        degree: usize,
        beside: Vec<RationalFunction>,
    ) -> Option<MatrixFamily> {
        let monomials = monomials(slopes.len(), degree)?;
        let weights = weights(&monomials)?;
        let FamilyVariables { parameters, steps, flows } = variables;
        Some(MatrixFamily {
            parameters,
            steps,
            rates: flows.iter().map(rates).collect(),
            flows,
            constant,
            slopes,
            beside,
            monomials,
            weights,
            tiles: Tiles::default(),
        })
    }

    /// The order of the matrix.
    pub fn order(&self) -> usize {
        self.constant.rows()
    }

    /// The number of parameters.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// The products of powers of gains, by their exponents.
    pub fn monomials(&self) -> &[Vec<u32>] {
        &self.monomials
    }

    /// How many values there are.
    pub(super) fn values_count(&self) -> usize {
        self.monomials.len() * self.order() + self.beside.len()
    }

    /// [`MatrixFamily::values`], of Taylor models over a part of a box that was looked at from those over the box.
    pub(super) fn values_near<S: Elementary>(&self, parameters: &[S], like: &S) -> Option<Vec<S>> {
        if parameters.is_empty() {
            let numbers = self.tiles.numbers(self, like.bits())?;
            return Some(numbers.iter().map(|number| like.constant(number)).collect());
        }
        let found = S::as_models(parameters).and_then(|models| self.tiles.values(self, models));
        found.and_then(S::of_models).or_else(|| self.values(parameters, like))
    }

    /// All values: for each product of gains the coefficients of `1, w, .., w^(n-1)`, then the other functions. The coefficient of `w^n` is 1, and 0
    /// beside gains. `like` is a number of the kind of all values. `None` where something may not be defined.
    pub(super) fn values<S: Elementary>(&self, parameters: &[S], like: &S) -> Option<Vec<S>> {
        let mut known = Evaluation::new(parameters.to_vec(), like);
        let mut flows: Vec<Option<Vec<S>>> = vec![None; self.flows.len()];
        for step in &self.steps {
            let value = match step {
                Step::Function(definition) => known.value(definition)?,
                Step::Value(f) => quotient(f, known.values(), like)?,
                Step::Flow { of, row, column } => {
                    let n = self.flows[*of].rows();
                    if flows[*of].is_none() {
                        flows[*of] = Some(self.flow(*of, known.values(), like)?);
                    }
                    flows[*of].as_ref().map(|flow| flow[row * n + column].clone())?
                }
            };
            known.push(value);
        }
        let at = |f: &RationalFunction| quotient(f, known.values(), like);
        let matrix = |m: &RationalMatrix| m.entries().iter().map(at).collect::<Option<Vec<S>>>();
        let (n, one) = (self.order(), like.integer(&Integer::ONE));
        let mut first = matrix(&self.constant)?;
        (0..n).for_each(|i| first[i * n + i] = first[i * n + i].minus(&one));
        let slopes = self.slopes.iter().map(matrix).collect::<Option<Vec<Vec<S>>>>()?;
        let at_node = |node: &Vec<u32>| {
            let mut sum = first.clone();
            for (slope, &k) in slopes.iter().zip(node).filter(|(_, k)| **k > 0) {
                let k = like.integer(&Integer::from(u64::from(k)));
                for (s, b) in sum.iter_mut().zip(slope).filter(|(_, b)| !b.is_nothing()) {
                    *s = s.plus(&k.times(b));
                }
            }
            characteristic_polynomial(n, &sum)
        };
        let nodes: Vec<Vec<S>> = self.monomials.iter().map(at_node).collect();
        let mut out = Vec::with_capacity(n * nodes.len() + self.beside.len());
        for weights in &self.weights {
            for k in 0..n {
                let terms = nodes.iter().zip(weights).filter(|(_, w)| !w.is_zero());
                let weighed = terms.map(|(node, w)| match w.is_one() {
                    true => node[k].clone(),
                    false => like.constant(&Ball::from_rational(w, like.bits())).times(&node[k]),
                });
                out.push(weighed.reduce(|s, t| s.plus(&t)).unwrap_or_else(|| like.nothing()));
            }
        }
        out.extend(self.beside.iter().map(at).collect::<Option<Vec<S>>>()?);
        Some(out)
    }
}

impl MatrixFamily {
    /// The exponential of a matrix; `None` where it may have too many bits to be of use.
    fn flow<S: Elementary>(&self, of: usize, known: &[S], like: &S) -> Option<Vec<S>> {
        let n = self.flows[of].rows();
        if let Some((rates, along)) = &self.rates[of]
            && let Some(found) = exponential_along(n, rates, &quotient(along, known, like)?)
        {
            return Some(found);
        }
        let entries = self.flows[of].entries().iter().map(|f| quotient(f, known, like));
        S::exponential_of(n, &entries.collect::<Option<Vec<S>>>()?)
    }
}

/// The matrix `R` of numbers and the function `f` with `m = R f`; `None` of any other matrix, and of zero.
fn rates(m: &RationalMatrix) -> Option<(Vec<Rational>, RationalFunction)> {
    let along = m.entries().iter().find(|f| !f.is_zero())?;
    let over = along.recip()?;
    let numbers = m.entries().iter().map(|f| (f * &over).as_constant()).collect::<Option<Vec<_>>>()?;
    Some((numbers, along.clone()))
}

/// One of the values of a [`MatrixFamily`] at arguments.
#[derive(Clone, Debug)]
pub struct FamilyValue {
    /// The family.
    pub of: Arc<MatrixFamily>,
    /// The number of the value.
    pub index: usize,
    /// The family's parameters.
    pub at: Vec<RationalFunction>,
}

impl PartialEq for FamilyValue {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.of, &other.of) && self.index == other.index && self.at == other.at
    }
}

/// All exponents up to a total degree, lower degrees first; `None` where they are many.
fn monomials(gains: usize, degree: usize) -> Option<Vec<Vec<u32>>> {
    let mut all = vec![vec![0; gains]];
    let mut last = all.clone();
    for _ in 0..if gains == 0 { 0 } else { degree } {
        let raised = |e: &Vec<u32>| {
            // Each is made once: by raising its last variable.
            let first = e.iter().rposition(|e| *e > 0).unwrap_or(0);
            let one = |i: usize| e.iter().enumerate().map(|(j, e)| e + u32::from(i == j)).collect::<Vec<u32>>();
            (first..gains).map(one).collect::<Vec<_>>()
        };
        last = last.iter().flat_map(raised).collect();
        all.extend(last.iter().cloned());
        if all.len() > MOST_NODES {
            return None;
        }
    }
    Some(all)
}

/// The inverse of the matrix of the monomials' values at the nodes, which are the exponents themselves.
fn weights(monomials: &[Vec<u32>]) -> Option<Vec<Vec<Rational>>> {
    let n = monomials.len();
    let value = |node: &[u32], e: &[u32]| {
        let powers = node.iter().zip(e).map(|(x, e)| Integer::from(u64::from(*x)).pow(u64::from(*e)));
        Rational::from(powers.fold(Integer::ONE, |product, p| &product * &p))
    };
    let unit = |i: usize, j: usize| if i == j { Rational::ONE } else { Rational::ZERO };
    let row = |i: usize| {
        monomials.iter().map(|e| value(&monomials[i], e)).chain((0..n).map(|j| unit(i, j))).collect::<Vec<Rational>>()
    };
    let mut rows: Vec<Vec<Rational>> = (0..n).map(row).collect();
    for column in 0..n {
        let pivot = (column..n).find(|&i| !rows[i][column].is_zero())?;
        rows.swap(column, pivot);
        let over = rows[column][column].recip()?;
        rows[column].iter_mut().for_each(|x| *x = &*x * &over);
        let pivot = rows[column].clone();
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, row)| *i != column && !row[column].is_zero()) {
            debug_assert!(i != column);
            let factor = row[column].clone();
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x = &*x - &(&factor * p));
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}

#[cfg(test)]
mod tests;
