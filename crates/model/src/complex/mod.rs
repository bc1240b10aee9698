//! Complex coefficients. In expressions the imaginary unit is one more variable, whose square is -1. Where it is left in the values of a
//! model, or a plant is held in another frame, each signal becomes two, its real and its imaginary part: a block with the matrix `X + jY`
//! has `[[X, -Y], [Y, X]]`, entry by entry. So all that follows is real: the loop has twice as many states, and with each root its conjugate.

mod polynomial;
mod systems;

use super::evaluate::transfer::Fraction;
use super::evaluate::values::{BlockValues, DiscretizationValues, DynamicValues, PortValues, Row, Values, Wiring};
use super::evaluate::zpoly::ZPoly;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
pub use polynomial::ComplexPolynomial;
pub(crate) use systems::{Frame, lifted_system, realised_ratio, seen_from, unlifted};

/// What is added to the name of a signal or state for its real part, and for its imaginary part.
pub(crate) const PARTS: [&str; 2] = [".re", ".im"];

/// A real and an imaginary part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parts {
    pub re: RationalFunction,
    pub im: RationalFunction,
}

/// Whether the imaginary unit is in a value.
pub(crate) fn has_unit(f: &RationalFunction, unit: Option<usize>) -> bool {
    unit.is_some_and(|unit| f.numerator().degree_in(unit) > 0 || f.denominator().degree_in(unit) > 0)
}

/// The parts of a value; `None` where it divides by zero.
pub(crate) fn parts_of(f: &RationalFunction, unit: Option<usize>) -> Option<Parts> {
    let Some(unit) = unit.filter(|_| has_unit(f, unit)) else {
        return Some(Parts { re: f.clone(), im: RationalFunction::zero() });
    };
    let [a, b] = Parts::of_polynomial(f.numerator(), unit);
    let [c, d] = Parts::of_polynomial(f.denominator(), unit);
    // (a + jb)/(c + jd) = (a + jb)(c - jd)/(c^2 + d^2)
    let below = &(&c * &c) + &(&d * &d);
    let re = RationalFunction::new(&(&a * &c) + &(&b * &d), below.clone())?;
    let im = RationalFunction::new(&(&b * &c) - &(&a * &d), below)?;
    Some(Parts { re, im })
}

impl Parts {
    /// The parts of a polynomial in the unit.
    pub fn of_polynomial(p: &MultiPoly, unit: usize) -> [MultiPoly; 2] {
        let mut parts = [MultiPoly::zero(), MultiPoly::zero()];
        for (k, c) in p.as_poly_in(unit).into_coeffs().into_iter().enumerate() {
            let part = &mut parts[k % 2];
            *part = if k % 4 < 2 { &*part + &c } else { &*part - &c };
        }
        parts
    }

    /// The value itself.
    pub fn joined(&self, unit: usize) -> RationalFunction {
        if self.im.is_zero() { self.re.clone() } else { &self.re + &(&RationalFunction::variable(unit) * &self.im) }
    }

    /// Its parts as the columns of a real matrix: of `x + jy` the column is `[x, y]`, and that of `j (x + jy)` is `[-y, x]`.
    fn entry(&self, row: usize, column: usize) -> RationalFunction {
        match (row, column) {
            (0, 1) => -&self.im,
            (1, 0) => self.im.clone(),
            _ => self.re.clone(),
        }
    }
}

/// When the parts of a block's signals become signals of their own.
#[derive(Clone, Debug, Default)]
pub(crate) enum Lift {
    /// They are real as they stand, or its matrices have been made so.
    #[default]
    Done,
    /// After it is made discrete, as it is real: so a hold has half as many modes.
    AfterHold,
}

/// The signals of a block as it stands: its inputs and its outputs.
pub(crate) fn ports_as_written(block: &BlockValues) -> (usize, usize) {
    let share = match block.lift {
        Lift::Done => 1,
        Lift::AfterHold => 2,
    };
    (block.inputs.len() / share, block.outputs / share)
}

/// The parts of values that may contain a unit of this number.
struct Lifting {
    unit: Option<usize>,
}

/// The values with each signal in two parts where the imaginary unit is in one of them or a plant is held in another frame.
pub(crate) fn lifted(values: Values, wiring: &mut Wiring<'_>, unit: Option<usize>) -> Values {
    let lifting = Lifting { unit };
    if !lifting.is_complex(&values) {
        return values;
    }
    wiring.inputs = names_of_parts(std::mem::take(&mut wiring.inputs));
    wiring.driven *= 2;
    wiring.is_complex = true;
    lifting.values(values)
}

impl Lifting {
    fn has_unit(&self, f: &RationalFunction) -> bool {
        has_unit(f, self.unit)
    }

    fn is_complex(&self, values: &Values) -> bool {
        let matrix = |m: &RationalMatrix| m.entries().iter().any(|f| self.has_unit(f));
        let rows = |rows: &[Row]| rows.iter().flat_map(|row| row.values()).any(|f| self.has_unit(f));
        let ports = |p: &PortValues| p.input_matrix.iter().any(matrix) || rows(&p.outputs);
        match values {
            Values::Characteristic(p) => p.iter().flat_map(ZPoly::coefficients).any(|f| self.has_unit(f)),
            Values::Matrix { matrix: m, ports: p } => matrix(m) || ports(p),
            Values::Feedback { a, b, c, k, ports: p } => [a, b, c, k].into_iter().any(matrix) || ports(p),
            Values::Blocks { blocks, outputs } => {
                let turns = |b: &BlockValues| matches!(&b.discretization, Some(DiscretizationValues::Hold(h)) if h.frame.is_some());
                rows(outputs) || blocks.iter().any(|b| rows(&b.inputs) || self.is_complex_inside(b) || turns(b))
            }
        }
    }

    fn is_complex_inside(&self, block: &BlockValues) -> bool {
        let of_ratio = |p: &Fraction| {
            [&p.numerator, &p.denominator].into_iter().flat_map(ZPoly::coefficients).any(|f| self.has_unit(f))
        };
        match &block.dynamics {
            DynamicValues::Ratio(ratio) => of_ratio(ratio),
            DynamicValues::ComplexRatio { .. } => true,
            DynamicValues::StateSpace { a, b, c, d } => {
                [a, b, c, d].into_iter().flat_map(RationalMatrix::entries).any(|f| self.has_unit(f))
            }
        }
    }

    fn values(&self, values: Values) -> Values {
        match values {
            Values::Characteristic([p, _]) => Values::Characteristic(self.polynomial(&p)),
            Values::Matrix { matrix, ports } => {
                Values::Matrix { matrix: self.matrix(&matrix), ports: self.ports(ports) }
            }
            Values::Feedback { a, b, c, k, ports } => {
                let [a, b, c, k] = [a, b, c, k].map(|m| self.matrix(&m));
                Values::Feedback { a, b, c, k, ports: self.ports(ports) }
            }
            Values::Blocks { blocks, outputs } => {
                let blocks = blocks.into_iter().map(|b| self.block(b)).collect();
                Values::Blocks { blocks, outputs: self.rows(&outputs) }
            }
        }
    }

    fn block(&self, block: BlockValues) -> BlockValues {
        let is_complex = self.is_complex_inside(&block);
        let lift = if is_complex { Lift::Done } else { Lift::AfterHold };
        let dynamics = match block.dynamics {
            DynamicValues::Ratio(ratio) if is_complex => {
                let [numerator, denominator] = [ratio.numerator, ratio.denominator].map(|p| self.polynomial(&p));
                DynamicValues::ComplexRatio { numerator, denominator }
            }
            DynamicValues::StateSpace { a, b, c, d } if is_complex => {
                let [a, b, c, d] = [a, b, c, d].map(|m| self.matrix(&m));
                DynamicValues::StateSpace { a, b, c, d }
            }
            real => real,
        };
        let discretization = block.discretization.map(|mut own| {
            if let DiscretizationValues::Hold(hold) = &mut own
                && is_complex
            {
                hold.pulses = std::mem::take(&mut hold.pulses).into_iter().flat_map(|p| [p.clone(), p]).collect();
            }
            own
        });
        BlockValues {
            inputs: self.rows(&block.inputs),
            outputs: 2 * block.outputs,
            dynamics,
            discretization,
            lift,
            ..block
        }
    }

    fn parts(&self, f: &RationalFunction) -> Parts {
        parts_of(f, self.unit).expect("values divide by nothing that is zero")
    }

    fn polynomial(&self, p: &ZPoly) -> [ZPoly; 2] {
        let parts: Vec<Parts> = p.coefficients().iter().map(|c| self.parts(c)).collect();
        [|p: &Parts| p.re.clone(), |p: &Parts| p.im.clone()].map(|part| ZPoly::new(parts.iter().map(part).collect()))
    }

    fn matrix(&self, m: &RationalMatrix) -> RationalMatrix {
        let parts: Vec<Parts> = m.entries().iter().map(|f| self.parts(f)).collect();
        of_parts(m.rows(), m.columns(), |i, j| &parts[i * m.columns() + j])
    }

    fn rows(&self, rows: &[Row]) -> Vec<Row> {
        let of = |row: &Row| {
            let parts: Vec<(usize, Parts)> = row.iter().map(|(signal, c)| (*signal, self.parts(c))).collect();
            [0, 1].map(|i| {
                let entry = |(signal, c): &(usize, Parts)| [0, 1].map(|j| (2 * signal + j, c.entry(i, j)));
                parts.iter().flat_map(entry).collect::<Row>()
            })
        };
        rows.iter().flat_map(of).collect()
    }

    fn ports(&self, ports: PortValues) -> PortValues {
        let input_matrix = ports.input_matrix.map(|e| self.matrix(&e));
        PortValues { input_matrix, outputs: self.rows(&ports.outputs) }
    }
}

/// The real matrix of a complex one of this size: entry by entry.
pub(super) fn of_parts<'p>(rows: usize, columns: usize, parts: impl Fn(usize, usize) -> &'p Parts) -> RationalMatrix {
    RationalMatrix::from_fn(2 * rows, 2 * columns, |i, j| parts(i / 2, j / 2).entry(i % 2, j % 2))
}

/// The names of the parts of signals.
pub(crate) fn names_of_parts(names: impl IntoIterator<Item = String>) -> Vec<String> {
    names.into_iter().flat_map(|name| PARTS.map(|part| format!("{name}{part}"))).collect()
}

/// The names of the signals that have these parts.
pub(crate) fn names_of_wholes(names: &[String]) -> Vec<String> {
    let whole = |name: &String| name.strip_suffix(PARTS[0]).map(str::to_owned);
    names.iter().filter_map(whole).collect()
}
