//! The loop at rest: `D(1; K)` is a number times a rational polynomial, though the rows of plants behind holds are exponentials.
//!
//! Such a row of the loop is that of `exp(M) v`, `v` being the states of the plant and its inputs, which are linear in all states, and
//! the rows of `M` that belong to inputs are zero. As `exp(M) - I = f(M) M` with `f(M) = I + M/2 + ..`, the matrix `I - A(K)` is one in
//! which these rows are those of `-M v`, times a matrix with the determinant of `f` of the plants: no zero, unless a plant has a mode
//! that turns by whole turns in a sample.
//!
//! Dead time of a fraction of a sample adds `exp(N) (u - w)` to such a row; the state `w` is the input `u` of the sample before. The row of `w` in
//! `I - A(K)` is `w - u`. Multiples of a row change no determinant, so the added terms are dropped.

use crate::model::Symbols;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction, UniPoly};
use std::collections::{BTreeMap, BTreeSet};

/// `a + b K`.
type Linear = [Rational; 2];

/// The coefficients of one symbol in a row of the matrix.
pub(super) type Form = Vec<Linear>;

/// A polynomial `d(K)` with `D(1; K) = c d(K)` for a number `c`, which may be 0; `None` where the matrix is not of this form.
///
/// Cost: a determinant of polynomials in `K`.
pub(in crate::problem) fn steady_state(
    constant: &RationalMatrix,
    linear: &RationalMatrix,
    symbols: &Symbols,
) -> Option<UniPoly> {
    determinant(&at_rest(constant, linear, symbols)?)
}

/// Rows that are zero for the states at rest: `I - A(K)` less a factor from the left that is regular for the other states. `None` where the matrix
/// is not of the form above.
pub(super) fn at_rest(constant: &RationalMatrix, linear: &RationalMatrix, symbols: &Symbols) -> Option<Vec<Form>> {
    let n = constant.rows();
    let terms = (0..n).map(|i| Terms::of(constant, linear, i, symbols)).collect::<Option<Vec<Terms>>>()?;
    let balances: Vec<Form> = terms.iter().enumerate().filter_map(|(i, terms)| terms.balance(i)).collect();
    let rows = terms.into_iter().map(|terms| terms.without(&balances)).collect::<Option<Vec<Row>>>()?;
    let flows = Flows::of(&rows)?;
    let zero = || Rational::ZERO;
    let mut at_rest = vec![vec![[zero(), zero()]; n]; n];
    for (i, row) in rows.iter().enumerate() {
        let Some((of, place)) = row.flow else {
            for (j, entry) in at_rest[i].iter_mut().enumerate() {
                let own = if i == j { Rational::ONE } else { zero() };
                *entry = [&own - &row.known[j][0], -&row.known[j][1]];
            }
            continue;
        };
        let (m, leads) = (symbols.flow_matrix(of), symbols.flow_leads(of));
        for (&column, form) in flows.forms.range((of, 0)..(of + 1, 0)).map(|((_, column), form)| (column, form)) {
            let is_state = flows.places.contains_key(&(of, column));
            let is_input = (0..m.columns()).all(|k| m[(column, k)].is_zero());
            let is_seen = row.forms.contains_key(&column) || (column == place && !leads[place * m.columns() + place]);
            if !is_state && !is_input || leads[place * m.columns() + column] && !is_seen {
                return None;
            }
            let weight = m[(place, column)].as_constant()?;
            for (entry, term) in at_rest[i].iter_mut().zip(form) {
                *entry = [&entry[0] - &(&weight * &term[0]), &entry[1] - &(&weight * &term[1])];
            }
        }
    }
    Some(at_rest)
}

/// A row of the matrix: the part without symbols, and the coefficients of the entries of an exponential by their column.
struct Row {
    known: Form,
    forms: BTreeMap<usize, Form>,
    /// The exponential and its row.
    flow: Option<(usize, usize)>,
}

/// A row of the matrix as it is.
struct Terms {
    known: Form,
    /// By exponential, its row and its column.
    forms: BTreeMap<(usize, usize, usize), Form>,
}

impl Terms {
    /// `None` where a symbol is no entry of an exponential, or the row is not linear in them.
    fn of(constant: &RationalMatrix, linear: &RationalMatrix, i: usize, symbols: &Symbols) -> Option<Terms> {
        let n = constant.rows();
        let empty = || vec![[Rational::ZERO, Rational::ZERO]; n];
        let mut row = Terms { known: empty(), forms: BTreeMap::new() };
        for j in 0..n {
            for (power, m) in [constant, linear].into_iter().enumerate() {
                for (symbol, value) in terms(&m[(i, j)])? {
                    match symbol {
                        None => row.known[j][power] = value,
                        Some(symbol) => {
                            let entry = symbols.flow_entry(symbol)?;
                            row.forms.entry(entry).or_insert_with(empty)[j][power] = value;
                        }
                    }
                }
            }
        }
        Some(row)
    }

    /// The row of `A - I`, which is zero at rest; `None` where the row contains an exponential.
    fn balance(&self, i: usize) -> Option<Form> {
        let mut form = self.known.clone();
        form[i][0] = &form[i][0] - &Rational::ONE;
        self.forms.is_empty().then_some(form)
    }

    /// The row without the exponentials all of whose factors are zero at rest; `None` where two exponentials are left.
    fn without(mut self, balances: &[Form]) -> Option<Row> {
        let of = |entry: &(usize, usize, usize)| (entry.0, entry.1);
        let stays = |(entry, form): (&(usize, usize, usize), &Form)| (!balances.contains(form)).then(|| of(entry));
        let left: BTreeSet<(usize, usize)> = self.forms.iter().filter_map(stays).collect();
        self.forms.retain(|entry, _| left.contains(&of(entry)));
        if left.len() > 1 {
            return None;
        }
        let forms = self.forms.into_iter().map(|((_, _, column), form)| (column, form)).collect();
        Some(Row { known: self.known, forms, flow: left.first().copied() })
    }
}

/// A function that is linear in its variables: each with its coefficient, `None` being the constant.
fn terms(f: &RationalFunction) -> Option<Vec<(Option<usize>, Rational)>> {
    let below = Rational::from(&f.denominator().as_constant()?).recip()?;
    let mut out = Vec::new();
    for (monomial, c) in f.numerator().terms() {
        let mut variables = monomial.exponents().iter().enumerate().filter(|(_, e)| **e > 0);
        let symbol = match (variables.next(), variables.next()) {
            (None, _) => None,
            (Some((i, 1)), None) => Some(i),
            _ => return None,
        };
        out.push((symbol, Rational::from(c) * below.clone()));
    }
    Some(out)
}

/// What the columns of each exponential are multiplied by, the same in all rows.
struct Flows {
    /// By exponential and column.
    forms: BTreeMap<(usize, usize), Form>,
    /// The row of the loop that has this row of the exponential.
    places: BTreeMap<(usize, usize), usize>,
}

impl Flows {
    /// `None` where rows differ, or a state is not multiplied by itself alone.
    fn of(rows: &[Row]) -> Option<Flows> {
        let mut flows = Flows { forms: BTreeMap::new(), places: BTreeMap::new() };
        for (i, row) in rows.iter().enumerate() {
            let Some((of, place)) = row.flow else { continue };
            if flows.places.insert((of, place), i).is_some() {
                return None;
            }
            for (&column, form) in &row.forms {
                if flows.forms.entry((of, column)).or_insert_with(|| form.clone()) != form {
                    return None;
                }
            }
            // Where an exponential has a 1 on its diagonal, it is no symbol.
            let is_whole = row.forms.contains_key(&place);
            let known = if is_whole { row.known.iter().all(is_nothing) } else { is_unit(&row.known, i) };
            if !known {
                return None;
            }
            if !is_whole && !is_unit(flows.forms.entry((of, place)).or_insert_with(|| row.known.clone()), i) {
                return None;
            }
        }
        let is_own =
            |(place, &i): (&(usize, usize), &usize)| flows.forms.get(place).is_none_or(|form| is_unit(form, i));
        flows.places.iter().all(is_own).then_some(flows)
    }
}

fn is_nothing(entry: &Linear) -> bool {
    entry.iter().all(Rational::is_zero)
}

fn is_unit(form: &Form, i: usize) -> bool {
    form.iter().enumerate().all(|(j, [a, b])| b.is_zero() && if i == j { a.is_one() } else { a.is_zero() })
}

/// The determinant of a matrix of linear functions, up to a positive factor.
fn determinant(rows: &[Vec<Linear>]) -> Option<UniPoly> {
    let n = rows.len();
    let k = RationalFunction::variable(0);
    let entry = |[a, b]: &Linear| &RationalFunction::from(a.clone()) + &(&RationalFunction::from(b.clone()) * &k);
    let matrix = RationalMatrix::from_fn(n, n, |i, j| entry(&rows[i][j]));
    let d = matrix.characteristic_polynomial(vec!["K".to_owned()], &Budget::unlimited()).ok()?;
    let lowest: &MultiPoly = d.coefficients.first()?.numerator();
    let p = lowest.to_univariate(0)?;
    Some(if n.is_multiple_of(2) { p } else { p.times(&UniPoly::constant(Integer::from(-1))) })
}
