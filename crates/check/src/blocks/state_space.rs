//! Blocks in state space.

#![expect(clippy::needless_range_loop, reason = "matrix indices, as in the formulas")]

use super::{Diagram, Matrices, Row, Rule, Substitution, cleared};
use crate::hold::Held;
use crate::model::{matrix, sized};
use crate::multivariate::{Fraction, Multi};
use crate::number::Q;
use crate::toml::Toml;
use num_traits::{One, Zero};
use std::ops::Range;

impl Diagram<'_, '_> {
    pub(super) fn state_space(
        &mut self,
        block: &Toml,
        inputs: &[Row],
        outputs: Range<usize>,
        rule: Option<Rule>,
    ) -> Result<(), String> {
        let matrices = self.matrices(block, inputs.len(), outputs.len())?;
        match self.behind_hold(&matrices[0], inputs.len(), rule.as_ref())? {
            Some(of) => self.held(matrices, of, inputs, outputs),
            None => self.equations(matrices, inputs, outputs, rule),
        }
    }

    fn matrices(&mut self, block: &Toml, inputs: usize, outputs: usize) -> Result<Matrices, String> {
        let mut get = |key: &str| block.get(key).map(|m| matrix(m, self.scope)).transpose();
        let (a, b, c, d) = (get("A")?, get("B")?, get("C")?, get("D")?);
        let (a, b, c) = match (a, b) {
            (Some(a), Some(b)) => (a, b, c),
            (None, None) if c.is_none() => (Vec::new(), Vec::new(), Some(vec![Vec::new(); outputs])),
            _ => return Err("a state-space block needs A and B".into()),
        };
        let n = a.len();
        sized(&a, n, n)?;
        sized(&b, n, inputs)?;
        let unit = |i: usize, j: usize| Fraction::number(&if i == j { Q::one() } else { Q::zero() });
        let c = c.unwrap_or_else(|| (0..n).map(|i| (0..n).map(|j| unit(i, j)).collect()).collect());
        sized(&c, outputs, n)?;
        let d = d.unwrap_or_else(|| vec![vec![Fraction::number(&Q::zero()); inputs]; outputs]);
        sized(&d, outputs, inputs)?;
        Ok([a, b, c, d])
    }

    /// What a block with this matrix does behind a hold; `None` of another rule.
    pub(super) fn behind_hold(
        &mut self,
        a: &[Vec<Fraction>],
        inputs: usize,
        rule: Option<&Rule>,
    ) -> Result<Option<Held>, String> {
        match rule {
            Some(Rule::Hold(hold)) => self.enclosed(a, inputs, hold).map(Some),
            Some(Rule::Moving(hold)) => self.moving(a, inputs, hold).map(Some),
            _ => Ok(None),
        }
    }

    /// The rows of a block that is not behind a hold.
    fn equations(
        &mut self,
        [a, b, c, d]: Matrices,
        inputs: &[Row],
        outputs: Range<usize>,
        rule: Option<Rule>,
    ) -> Result<(), String> {
        let clock = self.scope.clock;
        let (top, bottom, is_discretised) = match rule {
            Some(Rule::Quotient(Substitution { top, bottom })) => (top, bottom, true),
            _ => (Multi::variable(0), Multi::one(), false),
        };
        let n = a.len();
        let minus_bottom = Fraction::from(bottom).negated();
        let first = self.unknowns;
        self.unknowns += n;
        self.degree += n;
        let mut alone = Vec::new();
        for i in 0..n {
            // top x - bottom (A x + B u) = 0
            let mut row = Row::from([(first + i, top.clone().into())]);
            for j in 0..n {
                self.add(&mut row, first + j, a[i][j].times(&minus_bottom, clock)?)?;
            }
            let states = row.iter().map(|(k, f)| (k - first, f)).collect();
            alone.push(cleared(states, n, clock)?);
            for (j, input) in inputs.iter().enumerate() {
                let factor = b[i][j].times(&minus_bottom, clock)?;
                self.feed(&mut row, &factor, input)?;
            }
            self.rows.push(row);
        }
        if is_discretised {
            self.alone.push((alone, n));
        }
        for (i, output) in outputs.enumerate() {
            // y - C x - D u = 0
            let mut row = Row::from([(output, Fraction::number(&Q::one()))]);
            for j in 0..n {
                self.add(&mut row, first + j, c[i][j].clone().negated())?;
            }
            for (direct, input) in d[i].iter().zip(inputs).filter(|(direct, _)| !direct.numerator.is_zero()) {
                self.feed(&mut row, &direct.clone().negated(), input)?;
            }
            self.rows.push(row);
        }
        Ok(())
    }
}
