//! Loops of which only numbers are asked for: what a block does behind a hold stays whole.
//!
//! The entries of `exp(M t)` are symbols of their own there, and so are longer functions of them. Nothing is expanded, so that the
//! closed loop is as short as its diagram; its symbols have enclosures and no other meaning.

use super::{Meaning, Symbol, Symbols};
use crate::symbols::Definition;
use jurist_algebra::ball::{Ball, BallMatrix, exponential};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Integer;
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::symbols::{FamilyVariables, Step, Symbols as Values, value_at_balls};

/// Functions of more terms become symbols of their own.
const MOST_TERMS: usize = 2;

/// Bits that exponentials are computed with beside those that are asked for.
const GUARD_BITS: u64 = 64;

/// Bits after the point of values that are rounded to floating point.
const ROUNDED_BITS: u64 = 256;

impl Symbols {
    /// The same where exponentials of matrices stay whole.
    pub(crate) fn keeping_flows(self) -> Symbols {
        Symbols { keeps_flows: true, ..self }
    }

    /// The same where long entries of a product of samples become symbols also where a kept name is in them: then a kept name is seen by values only.
    pub(crate) fn shortening_names(self) -> Symbols {
        Symbols { shortens_names: true, ..self }
    }

    /// Whether exponentials of matrices stay whole.
    pub(crate) fn keeps_flows(&self) -> bool {
        self.keeps_flows
    }

    /// Whether an exponential of a matrix has stayed whole.
    pub fn has_flows(&self) -> bool {
        !self.flows.is_empty()
    }

    /// `exp(M t)` with a symbol for each entry that is not that of the identity for every matrix with the zeros of `M`.
    pub(crate) fn flow(&mut self, m: &RationalMatrix, time: &RationalFunction) -> RationalMatrix {
        let n = m.rows();
        let leads = reachable(m);
        let scaled = m.scaled(time);
        let of = self.flows.iter().position(|known| *known == scaled);
        let of = of.unwrap_or_else(|| {
            self.flows.push(scaled);
            self.flows.len() - 1
        });
        let is_moving = self.flows[of].entries().iter().any(|f| self.moves(f));
        RationalMatrix::from_fn(n, n, |row, column| {
            if leads[row * n + column] {
                return self.unnamed(Meaning::Flow { of, row, column }, format!("e{of}_{row}_{column}"), is_moving);
            }
            if row == column { RationalFunction::one() } else { RationalFunction::zero() }
        })
    }

    /// The matrix with a symbol in the place of each longer entry.
    pub(crate) fn shortened(&mut self, m: &RationalMatrix) -> RationalMatrix {
        let is_long =
            |f: &RationalFunction| f.numerator().terms().len() + f.denominator().terms().len() > MOST_TERMS + 1;
        RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| match &m[(i, j)] {
            f if is_long(f) => {
                let name = format!("v{}", self.table.len());
                let is_moving = self.moves(f);
                self.unnamed(Meaning::Value(f.clone()), name, is_moving)
            }
            f => f.clone(),
        })
    }

    /// The same, but for entries in which a kept name occurs, unless these are shortened as well.
    pub(crate) fn shortened_beside_names(&mut self, m: &RationalMatrix) -> RationalMatrix {
        if self.shortens_names {
            return self.shortened(m);
        }
        let first = self.kept.len();
        let short = self.shortened(&RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| {
            if m[(i, j)].variables().first().is_some_and(|v| *v < first) {
                RationalFunction::zero()
            } else {
                m[(i, j)].clone()
            }
        }));
        RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| {
            if m[(i, j)].variables().first().is_some_and(|v| *v < first) {
                m[(i, j)].clone()
            } else {
                short[(i, j)].clone()
            }
        })
    }

    /// A symbol that nobody sees, without a look for one that means the same.
    fn unnamed(&mut self, meaning: Meaning, name: String, is_moving: bool) -> RationalFunction {
        if let Meaning::Flow { .. } = meaning
            && let Some(known) = self.table.iter().position(|s| s.name == name && s.meaning == meaning)
        {
            return RationalFunction::variable(self.kept.len() + known);
        }
        self.table.push(Symbol { name, meaning, is_moving });
        RationalFunction::variable(self.kept.len() + self.table.len() - 1)
    }

    /// The entry of the exponential of a matrix that a symbol is: the number of the matrix, the row and the column.
    pub fn flow_entry(&self, symbol: usize) -> Option<(usize, usize, usize)> {
        match self.table.get(symbol)?.meaning {
            Meaning::Flow { of, row, column } => Some((of, row, column)),
            _ => None,
        }
    }

    /// The matrix of this number, times time.
    pub fn flow_matrix(&self, of: usize) -> &RationalMatrix {
        &self.flows[of]
    }

    /// For each entry of that matrix, row by row, whether its exponential has a symbol there.
    pub fn flow_leads(&self, of: usize) -> Vec<bool> {
        reachable(&self.flows[of])
    }

    /// The same symbols without the names that are kept; `None` where one of them depends on such a name.
    pub fn without_kept(&self) -> Option<Symbols> {
        let count = self.kept.len();
        let moved = |f: &RationalFunction| beside(f, count);
        let mut table = Vec::with_capacity(self.table.len());
        for symbol in &self.table {
            let meaning = match &symbol.meaning {
                Meaning::Constant(definition) => Meaning::Constant(definition.try_map(moved)?),
                Meaning::Value(f) => Meaning::Value(moved(f)?),
                Meaning::Flow { .. } => symbol.meaning.clone(),
                Meaning::Delay(_) => return None,
            };
            table.push(Symbol { name: symbol.name.clone(), meaning, is_moving: false });
        }
        let flow = |m: &RationalMatrix| {
            let entries = m.entries().iter().map(moved).collect::<Option<Vec<_>>>()?;
            Some(RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| entries[i * m.columns() + j].clone()))
        };
        let flows = self.flows.iter().map(flow).collect::<Option<Vec<_>>>()?;
        Some(Symbols { table, flows, keeps_flows: true, ..Symbols::default() })
    }

    /// The same for functions in which no symbol that depends on a kept name occurs: such a symbol has another meaning here. `None` where what
    /// stays whole depends on a kept name.
    pub(crate) fn of_fixed(&self) -> Option<Symbols> {
        let mut fixed = self.clone();
        let whole = fixed.table.iter().filter_map(|symbol| match &symbol.meaning {
            Meaning::Value(f) => Some(f),
            _ => None,
        });
        if whole.chain(self.flows.iter().flat_map(|m| m.entries())).any(|f| self.moves(f)) {
            return None;
        }
        for symbol in fixed.table.iter_mut().filter(|symbol| symbol.is_moving) {
            symbol.meaning = Definition::Pi.into();
        }
        fixed.without_kept()
    }

    /// Enclosures of all symbols with so many bits after the point; `None` where one has no value, or a divisor may vanish.
    ///
    /// Cost: an exponential of each matrix, and of a small one for each function.
    ///
    /// # Panics
    /// When a name is kept.
    pub fn enclosed(&self, bits: u64) -> Option<Vec<Ball>> {
        assert!(self.kept.is_empty(), "every name has a value");
        let working = bits + GUARD_BITS;
        let mut table = Values::new();
        for symbol in &self.table {
            // Something that costs nothing has to stand in the place of what is no function; no function depends on it.
            let own = match &symbol.meaning {
                Meaning::Constant(definition) => definition.clone(),
                Meaning::Flow { .. } | Meaning::Value(_) => Definition::exponential(0),
                Meaning::Delay(_) => return None,
            };
            table.push(&symbol.name, own);
        }
        let mut values: Vec<Ball> = table.values(working).to_vec();
        let at = |f: &RationalFunction, values: &[Ball]| quotient_at(f, values, working);
        let mut flows = Vec::with_capacity(self.flows.len());
        for m in &self.flows {
            let n = m.rows();
            let entries = m.entries().iter().map(|f| at(f, &values)).collect::<Option<Vec<Ball>>>()?;
            flows.push(exponential(&BallMatrix::from_fn(n, |i, j| entries[i * n + j].clone())));
        }
        for (i, symbol) in self.table.iter().enumerate() {
            match &symbol.meaning {
                Meaning::Flow { of, row, column } => values[i] = flows[*of].at(*row, *column).clone(),
                Meaning::Value(f) => values[i] = at(f, &values)?,
                _ => {}
            }
        }
        Some(values.iter().map(|v| v.with_bits(bits)).collect())
    }

    /// The symbols as the variables of a family of matrices in these kept names, the others having no place there; `None` where a symbol is a dead time.
    /// `place` gives each variable its number.
    pub fn family_variables(
        &self,
        parameters: usize,
        place: impl Fn(&RationalFunction) -> Option<RationalFunction>,
    ) -> Option<FamilyVariables> {
        let step = |symbol: &Symbol| {
            Some(match &symbol.meaning {
                Meaning::Constant(definition) => Step::Function(definition.try_map(&place)?),
                Meaning::Value(f) => Step::Value(place(f)?),
                Meaning::Flow { of, row, column } => Step::Flow { of: *of, row: *row, column: *column },
                Meaning::Delay(_) => return None,
            })
        };
        let flow = |m: &RationalMatrix| {
            let entries = m.entries().iter().map(&place).collect::<Option<Vec<_>>>()?;
            Some(RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| entries[i * m.columns() + j].clone()))
        };
        Some(FamilyVariables {
            parameters,
            steps: self.table.iter().map(step).collect::<Option<_>>()?,
            flows: self.flows.iter().map(flow).collect::<Option<_>>()?,
        })
    }

    /// What exponentials that stay whole and their functions depend on, and what they divide by.
    pub fn arguments(&self) -> impl Iterator<Item = &RationalFunction> {
        let entries = self.flows.iter().flat_map(|m| m.entries());
        self.table.iter().flat_map(|symbol| symbol.meaning.arguments()).chain(entries)
    }

    /// Symbols with these names and definitions beside these kept names.
    pub fn of_definitions(kept: Vec<String>, definitions: Vec<(String, Definition)>) -> Symbols {
        let mut symbols = Symbols { kept, ..Symbols::default() };
        for (name, definition) in definitions {
            let is_moving = definition.arguments().into_iter().any(|f| symbols.moves(f));
            symbols.table.push(Symbol { name, meaning: definition.into(), is_moving });
        }
        symbols
    }

    /// Whether nothing but values is known of some symbols: they are those of a family of matrices.
    pub fn has_families(&self) -> bool {
        self.table.iter().any(|symbol| matches!(symbol.definition(), Some(Definition::Family(_))))
    }

    /// The values of all symbols in floating point, from enclosures.
    pub(super) fn values_of_flows_approximate(&self) -> Vec<f64> {
        let Some(values) = self.enclosed(ROUNDED_BITS) else { return vec![f64::NAN; self.table.len()] };
        let middle = |v: &Ball| v.lower().midpoint(&v.upper()).to_f64_approximate();
        values.iter().map(middle).collect()
    }
}

/// A function of the variables after the first `count`, numbered from there; `None` where one of these is in it.
pub fn beside(f: &RationalFunction, count: usize) -> Option<RationalFunction> {
    if f.variables().into_iter().any(|i| i < count) {
        return None;
    }
    f.map_variables(|i| i - count)
}

/// The value of a rational function where its variables have these; `None` where the denominator may vanish.
pub fn quotient_at(f: &RationalFunction, values: &[Ball], bits: u64) -> Option<Ball> {
    let numerator = value_at_balls(f.numerator(), values, bits);
    if f.denominator().is_constant()
        && let Some(c) = f.denominator().as_constant()
        && c == Integer::ONE
    {
        return Some(numerator);
    }
    numerator.div(&value_at_balls(f.denominator(), values, bits))
}

/// For each pair of indices, row by row, whether a chain of entries that are not zero leads from the one to the other.
fn reachable(m: &RationalMatrix) -> Vec<bool> {
    let n = m.rows();
    let mut leads: Vec<bool> = m.entries().iter().map(|f| !f.is_zero()).collect();
    for via in 0..n {
        for from in 0..n {
            if leads[from * n + via] {
                for to in 0..n {
                    leads[from * n + to] |= leads[via * n + to];
                }
            }
        }
    }
    leads
}
