//! The conditions of Jury and of Routh as signs of products of determinants.

use super::SymbolicPolynomial;
use super::jury::Comparison;
use super::minors::Minor;
use crate::{Shape, UNDIVIDED_ORDER, row_name};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Sign};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::symbols::Symbols;

/// When a condition holds: the product of functions is positive, or negative, and others are not zero.
pub(super) struct Rule {
    pub product: Vec<usize>,
    pub is_negative: bool,
    pub other_than_zero: Vec<usize>,
}

/// What a condition says, and when it is so.
pub(super) struct Stated {
    pub name: String,
    pub row: Option<usize>,
    pub comparison: Comparison,
    pub rule: Rule,
}

/// Functions of the parameter, and conditions on their signs.
#[derive(Default)]
pub(super) struct Conditions {
    pub functions: Vec<Minor>,
    pub stated: Vec<Stated>,
    /// Whether the leading coefficient is a positive number, so that conditions need not be multiplied by it.
    pub is_plain: bool,
    /// Rows that the table has.
    pub rows: usize,
    /// For each row by which another row is divided: the functions whose product is its first entry.
    pub divisors: Vec<Vec<usize>>,
}

impl SymbolicPolynomial {
    /// The conditions, and the functions that they are about.
    pub(super) fn stated_conditions(
        &self,
        symbols: &Symbols,
        region: Shape,
        budget: &Budget,
    ) -> Result<Conditions, Exhausted> {
        let n = self.formal_degree;
        let a: Vec<MultiPoly> = (0..=n).map(|k| self.polynomial.coeff(k)).collect();
        let number = |p: &MultiPoly| p.map_variables(|i| i.saturating_sub(1));
        let is_number = |p: &MultiPoly| p.degree_in(0) == 0;
        // Entries are divided by a denominator that is a number.
        let divided_by_negative = is_number(&self.poles[0]) && symbols.sign(&number(&self.poles[0]), budget)?.is_lt();
        let sign = if divided_by_negative { Sign::Less } else { Sign::Greater };
        let is_plain = is_number(&a[n]) && symbols.sign(&number(&a[n]), budget)? == sign;
        let mut out = Conditions { is_plain, rows: 1, ..Conditions::default() };
        if n == 0 {
            return Ok(out);
        }
        match region {
            Shape::UnitDisc => out.jury(&a, divided_by_negative),
            Shape::LeftHalfPlane => out.routh(&a, divided_by_negative, symbols, budget)?,
        }
        Ok(out)
    }
}

impl Conditions {
    fn function(&mut self, minor: Minor) -> usize {
        self.functions.push(minor);
        self.functions.len() - 1
    }

    fn jury(&mut self, a: &[MultiPoly], divided_by_negative: bool) {
        let n = a.len() - 1;
        let lead = (!self.is_plain).then(|| self.function(Minor::of(a[n].clone())));
        for z in [1, -1] {
            let value = a.iter().rev().fold(MultiPoly::zero(), |sum, c| sum.scaled_by(&Integer::from(z)).plus(c));
            let value = self.function(Minor::of(value));
            let name = if z == 1 { "Q(1)".to_owned() } else { format!("(-1)^{n}*Q(-1)") };
            let name = if lead.is_none() { name } else { format!("a_{n}*{name}") };
            let is_odd = z < 0 && n % 2 == 1;
            let rule = Rule {
                product: lead.into_iter().chain([value]).collect(),
                is_negative: is_odd ^ (lead.is_none() && divided_by_negative),
                other_than_zero: Vec::new(),
            };
            self.stated.push(Stated { name: format!("{name} > 0"), row: None, comparison: Comparison::Greater, rule });
        }
        let sizes = 1..n.max(2);
        let inner: Vec<[usize; 2]> =
            sizes.map(|k| [true, false].map(|is_sum| self.function(Minor::inner(a, k, is_sum)))).collect();
        self.rows = n.saturating_sub(1).max(1);
        if n > UNDIVIDED_ORDER {
            self.divisors = std::iter::once(Vec::new()).chain(inner.iter().map(|pair| pair.to_vec())).collect();
        }
        for i in 0..self.rows {
            let (letter, m) = (row_name(i), n - i);
            // The determinants of size i + 1 and of size i - 1.
            let mut product = inner[i].to_vec();
            product.extend(i.checked_sub(2).into_iter().flat_map(|k| inner[k]));
            // Of rows that are not divided the factors of the row before the last one are factors.
            let factors = if n > UNDIVIDED_ORDER { 0 } else { i.saturating_sub(2) };
            let (name, comparison) = match (i, self.is_plain) {
                (0, true) => (format!("|a_0| < a_{n}"), Comparison::SmallerAbsolute),
                (0, false) => (format!("|a_0| < |a_{n}|"), Comparison::SmallerAbsolute),
                _ => (format!("|{letter}_0| > |{letter}_{m}|"), Comparison::GreaterAbsolute),
            };
            let other_than_zero = inner[..factors].iter().flatten().copied().collect();
            let rule = Rule { product, is_negative: i == 0, other_than_zero };
            self.stated.push(Stated { name, row: Some(i), comparison, rule });
        }
    }

    /// The table ends with the first determinant that is zero for every value.
    fn routh(
        &mut self,
        a: &[MultiPoly],
        divided_by_negative: bool,
        symbols: &Symbols,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        let n = a.len() - 1;
        let lead = (!self.is_plain).then(|| self.function(Minor::of(a[n].clone())));
        let mut before = None;
        self.divisors.push(Vec::new());
        for k in 1..=n {
            let mut product = match before {
                // The last one is the constant term times the one before.
                Some(before) if k == n => vec![before, self.function(Minor::of(a[0].clone()))],
                _ => vec![self.function(Minor::hurwitz(a, k))],
            };
            before = product.first().copied();
            if k < n {
                self.divisors.push(vec![self.functions.len() - 1]);
            }
            let name = if self.is_plain || k % 2 == 0 {
                format!("H_{k}")
            } else {
                product.extend(lead);
                format!("a_{n}*H_{k}")
            };
            let is_negative = self.is_plain && divided_by_negative && k % 2 == 1;
            let last = self.functions.len() - 1;
            let vanishes = self.functions[last].vanishes(symbols, budget)?;
            let rule = Rule { product, is_negative, other_than_zero: Vec::new() };
            self.stated.push(Stated {
                name: format!("{name} > 0"),
                row: Some(k),
                comparison: Comparison::Greater,
                rule,
            });
            self.rows = k + 1;
            if vanishes {
                break;
            }
        }
        Ok(())
    }
}
