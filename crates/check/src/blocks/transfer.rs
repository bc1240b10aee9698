//! Blocks of one transfer function.

use super::hold_rows::is_hold;
use super::{Diagram, Row, Rule, Substitution};
use crate::exponentials::without_exponentials;
use crate::expression::{Names, number};
use crate::moving::Moving;
use crate::multivariate::{Fraction, Multi};
use crate::number::{Q, Z};
use crate::toml::Toml;
use num_traits::{ToPrimitive, Zero};
use std::ops::Range;

/// Delays of more samples are refused.
const MAX_DELAY: u32 = 2000;

/// Transfer functions of higher orders are refused.
const MAX_ORDER: usize = 2000;

impl Diagram<'_, '_> {
    /// The transfer function of a block, if it has one, without the exponentials of a dead time before a hold, and the exponents of these.
    pub(super) fn without_dead_time(&self, block: &Toml) -> Result<(Option<Toml>, Vec<String>), String> {
        let transfer = block.get("transfer");
        if let (Some(Toml::Text(text)), Some(how)) = (transfer, block.get("discretize"))
            && is_hold(how)?
            && !self.scope.knows("exp")
        {
            let (rest, found) = without_exponentials(text);
            return Ok((Some(Toml::Text(rest)), found.iter().map(|e| (*e).to_owned()).collect()));
        }
        Ok((transfer.cloned(), Vec::new()))
    }

    /// Numerator and denominator of what a block with one input says it does.
    pub(super) fn quotient(
        &mut self,
        block: &Toml,
        transfer: Option<&Toml>,
        is_substituted: bool,
    ) -> Result<(Multi, Multi), String> {
        let clock = self.scope.clock;
        let inner = if is_substituted { "s" } else { self.declared.variable() };
        if let (Some(time), true) = (block.get("delay"), self.scope.dead_time.is_some()) {
            let time = self.scope.scalar(time).and_then(|time| self.scope.real(time))?;
            Ok((self.scope.delayed(&time, 0)?.numerator, Multi::one()))
        } else if let Some(time) = block.get("delay")
            && self.scope.moving.as_ref().is_some_and(Moving::is_continuous)
        {
            let time = self.scope.scalar(time).and_then(|time| self.scope.real(time))?;
            let moving = self.scope.moving.as_mut().ok_or("internal: no functions are read")?;
            Ok((moving.delayed(time)?.numerator, Multi::one()))
        } else if let Some(samples) = block.get("delay") {
            let samples = number(samples, clock)?;
            let samples = Some(samples).filter(Q::is_integer).and_then(|q| q.to_integer().to_u32());
            let Some(samples) = samples.filter(|&k| k <= MAX_DELAY && inner == "z") else {
                return Err("a delay is not a number of samples".into());
            };
            Ok((Multi::one(), Multi::variable(0).power(samples, clock)?))
        } else if let (Some(num), Some(den)) = (block.get("num"), block.get("den")) {
            let (num, den) = (self.coefficients(num)?, self.coefficients(den)?);
            // Both over the scalar denominators of both.
            Ok((num.numerator.times(&den.scalar, clock)?, den.numerator.times(&num.scalar, clock)?))
        } else {
            let f = if let Some(text) = transfer {
                // Signals are not known there, constants and parameters are.
                if is_substituted && self.declared.is_taken(inner) {
                    return Err("'s' is the variable of a block and also something else".into());
                }
                self.scope.value(text, Names::Variable(inner))?
            } else {
                self.scope.scalar(block.get("gain").ok_or("a block has no 'num' or no 'den'")?)?
            };
            let den = f.whole_denominator(clock)?;
            Ok((f.numerator, den))
        }
    }

    /// The row of a transfer function.
    pub(super) fn transfer_function(
        &mut self,
        [num, den]: [Multi; 2],
        rule: Option<Rule>,
        inputs: &[Row],
        outputs: Range<usize>,
    ) -> Result<(), String> {
        if den.is_zero() || num.degree(0) > den.degree(0) || den.degree(0) > MAX_ORDER {
            return Err("a transfer function is improper, or of too high an order".into());
        }
        if rule.is_some() {
            // The order of the continuous block.
            let lead = den.coefficients(0).pop().unwrap_or_default();
            self.alone.push((vec![vec![lead]], 0));
        }
        if let Some(Rule::Hold(_) | Rule::Moving(_)) = rule {
            let matrices = self.realised(&num, &den)?;
            let of = self.behind_hold(&matrices[0], inputs.len(), rule.as_ref())?;
            return self.held(matrices, of.ok_or("internal: no hold")?, inputs, outputs);
        }
        let (num, den, order) = self.substituted(&num, &den, rule)?;
        self.degree += order;
        self.alone.push((vec![vec![den.clone()]], order));
        let mut row = Row::from([(outputs.start, den.into())]);
        let minus = Fraction::from(num).negated();
        self.feed(&mut row, &minus, &inputs[0])?;
        self.rows.push(row);
        Ok(())
    }

    /// A list of coefficients, highest power first, as a polynomial in the variable.
    fn coefficients(&mut self, list: &Toml) -> Result<Fraction, String> {
        let mut sum = Fraction::number(&Q::zero());
        let z = Fraction::variable(0);
        if list.one_or_more().is_empty() {
            return Err("a list has no coefficients".into());
        }
        for c in list.one_or_more() {
            let c = self.scope.scalar(c)?;
            sum = sum.times(&z, self.scope.clock)?.plus(&c, self.scope.clock)?;
        }
        Ok(sum)
    }

    pub(super) fn substitution(
        &mut self,
        method: &str,
        time: Option<Fraction>,
        factor: Option<Fraction>,
    ) -> Result<Substitution, String> {
        let clock = self.scope.clock;
        let whole = |f: &Fraction| Ok::<_, String>((f.numerator.clone(), f.whole_denominator(clock)?));
        let z = Multi::variable(0);
        let (minus, plus) = (z.minus(&Multi::one()), z.plus(&Multi::one()));
        match (method, &time, &factor) {
            ("forward" | "backward", Some(time), None) => {
                let (n, d) = whole(time)?;
                let bottom = if method == "forward" { n } else { n.times(&z, clock)? };
                Ok(Substitution { top: minus.times(&d, clock)?, bottom })
            }
            ("tustin", _, Some(c)) => {
                let (n, d) = whole(c)?;
                Ok(Substitution { top: minus.times(&n, clock)?, bottom: plus.times(&d, clock)? })
            }
            ("tustin", Some(time), None) => {
                // c = 2/T divides by T.
                if time.numerator.is_zero() {
                    return Err("division by a sample time that is zero".into());
                }
                self.scope.divisors.insert(time.numerator.clone());
                let (n, d) = whole(time)?;
                let top = minus.times(&d.scaled(&Z::from(2)), clock)?;
                Ok(Substitution { top, bottom: plus.times(&n, clock)? })
            }
            _ => Err("'discretize' is not complete".into()),
        }
    }

    /// Numerator and denominator after `s = top/bottom`, times `bottom^order`, and the order.
    fn substituted(&self, num: &Multi, den: &Multi, rule: Option<Rule>) -> Result<(Multi, Multi, usize), String> {
        let order = den.degree(0);
        let Some(Rule::Quotient(Substitution { top, bottom })) = rule else {
            return Ok((num.clone(), den.clone(), order));
        };
        let clock = self.scope.clock;
        let replace = |p: &Multi| -> Result<Multi, String> {
            let mut sum = Multi::default();
            for (k, c) in p.coefficients(0).iter().enumerate() {
                let power = top.power(k as u32, clock)?.times(&bottom.power((order - k) as u32, clock)?, clock)?;
                sum = sum.plus(&c.times(&power, clock)?);
            }
            Ok(sum)
        };
        Ok((replace(num)?, replace(den)?, order))
    }
}
