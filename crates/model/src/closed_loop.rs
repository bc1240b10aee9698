//! Closed loops in state space.

use super::complex::names_of_wholes;
use super::definition::Time;
use super::evaluated::add_pole;
use super::text::names::{did_you_mean, known_names, shorten};
use crate::error::{Code, Diagnostic, Error};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// A closed loop in state space: `x' = A x + E r`, `y = C x + D r`, where `x'` is the next sample
/// or the derivative.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::{BlockBuilder, Model, Time};
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/(z - 1)"))
///     .build()?;
/// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
/// let closed_loop = problem.closed_loop(&budget)?;
/// assert_eq!(closed_loop.a[(0, 0)].as_constant().unwrap().to_string(), "1/2");
/// assert_eq!((closed_loop.inputs[0].as_str(), closed_loop.outputs[0].as_str()), ("r", "y"));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ClosedLoop {
    /// The kept parameters: variables 0, 1, ... of all entries.
    pub variables: Vec<String>,
    /// Discrete or continuous.
    pub time: Time,
    /// The closed-loop matrix A, n x n.
    pub a: RationalMatrix,
    /// How the inputs enter: E, n x inputs.
    pub e: RationalMatrix,
    /// The outputs: C, outputs x n.
    pub c: RationalMatrix,
    /// From inputs to outputs at once: D, outputs x inputs.
    pub d: RationalMatrix,
    /// Names of the states.
    pub states: Vec<String>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// The loop is undefined where one of these is zero.
    pub poles: Vec<MultiPoly>,
    /// What the characteristic function has been divided by to be monic, where the entries contain `exp(-tau s)`: without
    /// dead time a factor without meaning.
    pub leading: RationalFunction,
    /// Whether coefficients of the loop are complex. Then each signal and each state stands here as two, its real and its imaginary part,
    /// called `y.re` and `y.im`; with each root of the loop the matrix has its conjugate.
    pub is_complex: bool,
}

/// A transfer function of the closed loop as it stands: nothing is cancelled.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::{BlockBuilder, Model, Time};
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/(z - 1)"))
///     .build()?;
/// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
/// let closed_loop = problem.closed_loop(&budget)?;
/// let transfer = closed_loop.transfer_function("r", "y", &budget)?; // (1/2) / (z - 1/2)
/// assert_eq!(transfer.numerator[0].as_constant().unwrap().to_string(), "1/2");
/// assert_eq!(transfer.denominator.coefficients[0].as_constant().unwrap().to_string(), "-1/2");
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TransferFunction {
    /// Coefficients of the numerator from the constant term up, as many as the denominator has.
    pub numerator: Vec<RationalFunction>,
    /// The characteristic polynomial.
    pub denominator: CharacteristicPolynomial,
}

impl ClosedLoop {
    /// Of the matrices `A`, `E`, `C` and `D`, real and without names of states, inputs and outputs.
    pub fn of_matrices([a, e, c, d]: [RationalMatrix; 4], variables: Vec<String>, time: Time) -> ClosedLoop {
        let names = Vec::new;
        ClosedLoop {
            variables,
            time,
            a,
            e,
            c,
            d,
            states: names(),
            inputs: names(),
            outputs: names(),
            poles: Vec::new(),
            leading: RationalFunction::one(),
            is_complex: false,
        }
    }

    /// `det(zI - A)`.
    ///
    /// Cost: that of [`RationalMatrix::characteristic_polynomial`].
    ///
    /// # Errors
    /// [`Error::Stopped`].
    pub fn characteristic_polynomial(&self, budget: &Budget) -> Result<CharacteristicPolynomial, Error> {
        let mut p = self.a.characteristic_polynomial(self.variables.clone(), budget)?;
        let mut poles = self.poles.clone();
        p.poles.iter().for_each(|pole| add_pole(&mut poles, pole));
        p.poles = poles;
        Ok(p)
    }

    /// The transfer function from an input to an output of the closed loop, nothing cancelled.
    ///
    /// Cost: two characteristic polynomials.
    ///
    /// # Errors
    /// `E-unknown-signal`; [`Error::Stopped`].
    pub fn transfer_function(&self, input: &str, output: &str, budget: &Budget) -> Result<TransferFunction, Error> {
        let (i, j) = self.ports(input, output)?;
        self.transfer_function_at(i, j, budget)
    }

    /// The row of an output and the column of an input.
    ///
    /// # Errors
    /// `E-unknown-signal`.
    pub fn ports(&self, input: &str, output: &str) -> Result<(usize, usize), Error> {
        ports((&self.inputs, input), (&self.outputs, output))
    }

    /// The indices of two complex signals. A real and an imaginary part together count as one signal.
    ///
    /// # Errors
    /// `E-unknown-signal`.
    pub fn complex_ports(&self, input: &str, output: &str) -> Result<(usize, usize), Error> {
        let [inputs, outputs] = [&self.inputs, &self.outputs].map(|names| names_of_wholes(names));
        ports((&inputs, input), (&outputs, output))
    }

    /// The transfer function from input `j` to output `i`, nothing cancelled.
    ///
    /// By the matrix determinant lemma the numerator is `det(zI - A + e c) - det(zI - A) + d det(zI - A)`
    /// with `e` the column of the input and `c`, `d` the row of the output: it equals
    /// `c adj(zI - A) e + d det(zI - A)`.
    ///
    /// Cost: two characteristic polynomials.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    ///
    /// # Panics
    /// When there is no such input or output.
    pub fn transfer_function_at(&self, i: usize, j: usize, budget: &Budget) -> Result<TransferFunction, Error> {
        let denominator = self.characteristic_polynomial(budget)?;
        let numerator = self.numerator_at(i, j, &denominator.coefficients, budget)?;
        Ok(TransferFunction { numerator, denominator })
    }

    /// The part of the loop between an input and an output: without states that the input does not reach and without those that do not reach
    /// the output. They are no part of the transfer function, and no factor that would have to be cancelled.
    ///
    /// Cost: `n^2` entries compared with zero for each path's length.
    pub fn between(&self, output: usize, input: usize) -> ClosedLoop {
        let n = self.a.rows();
        let reached = closure(n, |r| !self.e[(r, input)].is_zero(), |k, r| !self.a[(r, k)].is_zero());
        let reaching = closure(n, |k| !self.c[(output, k)].is_zero(), |r, k| !self.a[(r, k)].is_zero());
        let kept: Vec<usize> = (0..n).filter(|&k| reached[k] && reaching[k]).collect();
        let m = kept.len();
        let (inputs, outputs) = (self.e.columns(), self.c.rows());
        ClosedLoop {
            a: RationalMatrix::from_fn(m, m, |r, k| self.a[(kept[r], kept[k])].clone()),
            e: RationalMatrix::from_fn(m, inputs, |r, j| self.e[(kept[r], j)].clone()),
            c: RationalMatrix::from_fn(outputs, m, |i, k| self.c[(i, kept[k])].clone()),
            states: kept.iter().map(|&k| self.states[k].clone()).collect(),
            ..self.clone()
        }
    }

    /// The numerator over the characteristic polynomial, whose coefficients are known.
    ///
    /// Cost: one characteristic polynomial.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    pub fn numerator_at(
        &self,
        i: usize,
        j: usize,
        denominator: &[RationalFunction],
        budget: &Budget,
    ) -> Result<Vec<RationalFunction>, Error> {
        let n = self.a.rows();
        let changed = RationalMatrix::from_fn(n, n, |r, k| &self.a[(r, k)] - &(&self.e[(r, j)] * &self.c[(i, k)]));
        let other = changed.characteristic_polynomial(self.variables.clone(), budget)?;
        let direct = &self.d[(i, j)];
        let pairs = other.coefficients.iter().zip(denominator);
        Ok(pairs.map(|(b, a)| &(b - a) + &(direct * a)).collect())
    }
}

/// The places of an input and of an output in their lists: first that of the output.
fn ports((inputs, input): (&[String], &str), (outputs, output): (&[String], &str)) -> Result<(usize, usize), Error> {
    let find = |names: &[String], name: &str, what: &str| {
        names.iter().position(|n| n == name).ok_or_else(|| {
            let message = format!("the loop has no {what} '{}'", shorten(name));
            let mut error = Diagnostic::error(Code::UnknownSignal, message);
            let names = || names.iter().map(String::as_str);
            error.help = did_you_mean(name, names()).or_else(|| known_names(names()));
            Error::from(error)
        })
    };
    let j = find(inputs, input, "input")?;
    let i = find(outputs, output, "output")?;
    Ok((i, j))
}

/// All numbers below `n` that steps lead to from those to begin with.
fn closure(n: usize, is_first: impl Fn(usize) -> bool, leads: impl Fn(usize, usize) -> bool) -> Vec<bool> {
    let mut known: Vec<bool> = (0..n).map(is_first).collect();
    let mut waiting: Vec<usize> = (0..n).filter(|&k| known[k]).collect();
    while let Some(k) = waiting.pop() {
        for next in (0..n).filter(|&next| leads(k, next)) {
            if !known[next] {
                known[next] = true;
                waiting.push(next);
            }
        }
    }
    known
}
