//! What a certificate of best gains says.

use super::objective::{Level, Polynomial};
use super::{Objective, Statement};
use crate::for_all::wishes;
use crate::number::Q;
use crate::statement::Extent;
use crate::verdict;
use crate::words::{self, exact};
use num_traits::{One, Signed};

impl Statement {
    /// The statement in words. It gives ranges exactly: a smaller one may leave out gains that are good.
    pub(super) fn in_words(&self) -> String {
        let of = &self.asked;
        let ranges = of.names.iter().zip(&of.window);
        let ranges: Vec<String> =
            ranges.map(|(name, [low, high])| format!("{name} from {} to {}", exact(low), exact(high))).collect();
        let beside = match &self.objective {
            Objective::Formula { is_greatest, proved, .. } => {
                format!(" with {} {} {}", self.best(), if *is_greatest { ">=" } else { "<=" }, exact(proved))
            }
            Objective::None | Objective::Level(_) => String::new(),
        };
        let set = words::values(of.set.iter().map(|(name, q)| (name, q)));
        let set = if set.is_empty() { set } else { format!(", with {set}") };
        let within = verdict::within(&of.each[0].extent, of.discrete);
        let mut wishes = wishes(of);
        wishes.truncate(self.refutable() - 1);
        let wishes = if wishes.is_empty() { String::new() } else { format!(", with {}", wishes.join(" and ")) };
        format!(
            "For no {}{beside}{set}, the loop is stable{within}{wishes}.{}",
            ranges.join(" and "),
            self.found_in_words()
        )
    }

    fn found_in_words(&self) -> String {
        let Some(found) = &self.found else { return String::new() };
        let at = words::values(self.asked.names.iter().zip(&found.point));
        match (&self.objective, &found.level) {
            (Objective::Formula { formula, .. }, _) => {
                let value = formula.at(&found.point).map_or_else(String::new, |value| exact(&value));
                format!(" At {at} it is, and {} is {value} there.", self.best())
            }
            (_, Some(Level::Requirement(own))) => format!(" At {at} it is, with {} instead.", own.in_words()),
            (_, Some(Level::Region(bound))) => {
                let within = verdict::within(&Extent::Number(bound.clone()), self.asked.discrete);
                format!(" At {at} it is,{within} instead.")
            }
            _ => String::new(),
        }
    }

    /// What is to be best.
    fn best(&self) -> String {
        let Objective::Formula { formula, .. } = &self.objective else { return String::new() };
        let [above, below] = [&formula.above, &formula.below].map(|p| self.polynomial(p));
        if formula.below.is_one() { above } else { format!("({above})/({below})") }
    }

    fn polynomial(&self, of: &Polynomial) -> String {
        let mut out = String::new();
        for (c, exponents) in &of.0 {
            let names = self.asked.names.iter().zip(exponents).filter(|(_, k)| **k > 0);
            let powers: Vec<String> =
                names.map(|(name, k)| if *k == 1 { name.clone() } else { format!("{name}^{k}") }).collect();
            let size = c.abs();
            let number = if size.is_one() && !powers.is_empty() { None } else { Some(exact(&Q::from(size))) };
            let sign = match (out.is_empty(), c.is_negative()) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            out += sign;
            out += &number.into_iter().chain(powers).collect::<Vec<_>>().join("*");
        }
        out
    }
}
