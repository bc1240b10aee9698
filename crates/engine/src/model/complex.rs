//! Complex coefficients. In expressions the imaginary unit is one more variable, whose square is -1. Where it is left in the values of a
//! model, or a plant is held in another frame, each signal becomes two, its real and its imaginary part: a block with the matrix `X + jY`
//! has `[[X, -Y], [Y, X]]`, entry by entry. So all that follows is real: the loop has twice as many states, and with each root its conjugate.

use super::connect::state_space::System;
use super::evaluate::symbolic::{
    BlockValues, DiscretizationValues, DynamicValues, Frame, PortValues, Row, Values, Wiring,
};
use super::evaluate::transfer::Fraction;
use super::evaluate::zpoly::ZPoly;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

/// What is added to the name of a signal or state for its real part, and for its imaginary part.
pub(crate) const PARTS: [&str; 2] = [".re", ".im"];

/// A real and an imaginary part.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model) struct Parts {
    pub re: RationalFunction,
    pub im: RationalFunction,
}

/// Whether the imaginary unit is in a value.
pub(in crate::model) fn has_unit(f: &RationalFunction, unit: Option<usize>) -> bool {
    unit.is_some_and(|unit| f.numerator().degree_in(unit) > 0 || f.denominator().degree_in(unit) > 0)
}

/// The parts of a value; `None` where it divides by zero.
pub(in crate::model) fn parts_of(f: &RationalFunction, unit: Option<usize>) -> Option<Parts> {
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
        match self.im.is_zero() {
            true => self.re.clone(),
            false => &self.re + &(&RationalFunction::variable(unit) * &self.im),
        }
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
pub(in crate::model) enum Lift {
    /// They are real as they stand, or its matrices have been made so.
    #[default]
    Done,
    /// After it is made discrete, as it is real: so a hold has half as many modes.
    AfterHold,
}

/// The signals of a block as it stands: its inputs and its outputs.
pub(in crate::model) fn ports_as_written(block: &BlockValues) -> (usize, usize) {
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
pub(in crate::model) fn lifted(values: Values, wiring: &mut Wiring<'_>, unit: Option<usize>) -> Values {
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
fn of_parts<'p>(rows: usize, columns: usize, parts: impl Fn(usize, usize) -> &'p Parts) -> RationalMatrix {
    RationalMatrix::from_fn(2 * rows, 2 * columns, |i, j| parts(i / 2, j / 2).entry(i % 2, j % 2))
}

/// The system that does with real and imaginary parts what a real one does with each signal, its plant held in another frame:
/// `exp(ja) G(z exp(jwT))`.
pub(in crate::model) fn lifted_system(system: &System) -> System {
    let matrix = |m: &RationalMatrix| {
        let parts: Vec<Parts> =
            m.entries().iter().map(|f| Parts { re: f.clone(), im: RationalFunction::zero() }).collect();
        of_parts(m.rows(), m.columns(), |i, j| &parts[i * m.columns() + j])
    };
    let System { a, b, c, d } = system;
    System { a: matrix(a), b: matrix(b), c: matrix(c), d: matrix(d) }
}

/// A system of real and imaginary parts, as it is seen from a frame that turns.
pub(in crate::model) fn seen_from(system: System, frame: &Frame) -> System {
    let turned = |m: &RationalMatrix, [cosine, sine]: &[RationalFunction; 2]| {
        RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| {
            let (x, y) = (&m[(i - i % 2, j)], &m[(i - i % 2 + 1, j)]);
            match i % 2 {
                0 => &(cosine * x) - &(sine * y),
                _ => &(sine * x) + &(cosine * y),
            }
        })
    };
    let System { a, b, c, d } = system;
    System { a: turned(&a, &frame.turn), b: turned(&b, &frame.enters), d: turned(&d, &frame.direct), c }
}

/// The complex ratio's controllable canonical form, in real and imaginary parts, and the square of the modulus of the denominator's leading
/// coefficient; `None` where that is zero.
pub(in crate::model) fn realised_ratio(
    numerator: &[Vec<RationalFunction>; 2],
    denominator: &[Vec<RationalFunction>; 2],
) -> Option<(System, RationalFunction)> {
    let n = denominator[0].len() - 1;
    let at = |p: &[Vec<RationalFunction>; 2], k: usize| Parts { re: p[0][k].clone(), im: p[1][k].clone() };
    let leading = at(denominator, n);
    let square = &(&leading.re * &leading.re) + &(&leading.im * &leading.im);
    let below = square.recip()?;
    let times = |a: &Parts, b: &Parts| Parts {
        re: &(&a.re * &b.re) - &(&a.im * &b.im),
        im: &(&a.re * &b.im) + &(&a.im * &b.re),
    };
    let inverse = Parts { re: &leading.re * &below, im: -(&leading.im * &below) };
    let monic = |p: &[Vec<RationalFunction>; 2], k: usize| times(&at(p, k), &inverse);
    let real = |f: RationalFunction| Parts { re: f, im: RationalFunction::zero() };
    let (zero, one) = (real(RationalFunction::zero()), real(RationalFunction::one()));
    let direct = monic(numerator, n);
    let last: Vec<Parts> = (0..n).map(|k| monic(denominator, k)).collect();
    let negative = |p: &Parts| Parts { re: -&p.re, im: -&p.im };
    let below_diagonal: Vec<Parts> = last.iter().map(negative).collect();
    let c: Vec<Parts> = (0..n)
        .map(|k| {
            let (own, through) = (monic(numerator, k), times(&direct, &last[k]));
            Parts { re: &own.re - &through.re, im: &own.im - &through.im }
        })
        .collect();
    let a = of_parts(n, n, |i, k| match i + 1 {
        next if next == n => &below_diagonal[k],
        next if next == k => &one,
        _ => &zero,
    });
    let b = of_parts(n, 1, |i, _| if i + 1 == n { &one } else { &zero });
    let c = of_parts(1, n, |_, k| &c[k]);
    let d = of_parts(1, 1, |_, _| &direct);
    Some((System { a, b, c, d }, square))
}

/// Whether a matrix of parts is that of a real matrix.
fn is_real(m: &RationalMatrix) -> bool {
    let parts = |i: usize| (0..m.columns()).filter(move |j| i % 2 != j % 2).map(move |j| (i, j));
    (0..m.rows()).flat_map(parts).all(|at| m[at].is_zero())
}

/// The system of real signals, where no imaginary part is left in one of real and imaginary parts.
pub(in crate::model) fn unlifted(system: &System) -> Option<System> {
    let System { a, b, c, d } = system;
    let half =
        |m: &RationalMatrix| RationalMatrix::from_fn(m.rows() / 2, m.columns() / 2, |i, j| m[(2 * i, 2 * j)].clone());
    [a, b, c, d].into_iter().all(is_real).then(|| System { a: half(a), b: half(b), c: half(c), d: half(d) })
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

/// The characteristic polynomial `D` of a complex loop.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ComplexPolynomial {
    /// The real parts of the coefficients, from the constant term up.
    pub re: Vec<RationalFunction>,
    /// The imaginary parts, as many.
    pub im: Vec<RationalFunction>,
}

impl ComplexPolynomial {
    /// From coefficients in which a variable of this number is the imaginary unit; `None` where one divides by zero.
    pub(in crate::model) fn of(coefficients: &[RationalFunction], unit: usize) -> Option<ComplexPolynomial> {
        let parts = coefficients.iter().map(|c| parts_of(c, Some(unit))).collect::<Option<Vec<Parts>>>()?;
        let (re, im) = parts.into_iter().map(|p| (p.re, p.im)).unzip();
        Some(ComplexPolynomial { re, im })
    }

    /// Whether no imaginary part is left.
    pub fn is_real(&self) -> bool {
        self.im.iter().all(RationalFunction::is_zero)
    }

    /// The real polynomial `D conj(D)` of twice the degree, `conj(D)` with conjugated coefficients: its roots are those of `D` and their
    /// conjugates.
    pub fn with_conjugate(&self) -> Vec<RationalFunction> {
        let n = self.re.len();
        let mut out = vec![RationalFunction::zero(); (2 * n).saturating_sub(1)];
        for list in [&self.re, &self.im] {
            for (i, a) in list.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
                for (k, b) in list.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                    out[i + k] = &out[i + k] + &(a * b);
                }
            }
        }
        out
    }

    /// The real polynomial that is asked: the polynomial itself where it is real; else that with the conjugate roots, beside it.
    pub(in crate::model) fn real_or_complex(self) -> (Vec<RationalFunction>, Option<ComplexPolynomial>) {
        match self.is_real() {
            true => (self.re, None),
            false => (self.with_conjugate(), Some(self)),
        }
    }

    /// The polynomial without its greatest factor that has real coefficients; `None` where it has no such factor.
    ///
    /// Cost: Euclid's algorithm over the field of rational functions.
    pub(crate) fn without_real_factor(&self) -> Option<ComplexPolynomial> {
        let (factor, others) = self.real_factor();
        (factor.len() > 1).then_some(others)
    }

    /// The greatest factor with real coefficients, and the other one.
    ///
    /// Cost: Euclid's algorithm over the field of rational functions.
    pub(crate) fn real_factor(&self) -> (Vec<RationalFunction>, ComplexPolynomial) {
        let any = |f: RationalFunction| Some(f);
        let [re, im] = [&self.re, &self.im].map(|list| ZPoly::new(list.clone()));
        let split = || {
            let factor = re.gcd(&im, &any)?;
            let [re, im] = [re.divide(&factor, &any)?.0, im.divide(&factor, &any)?.0];
            let list = |p: &ZPoly| (0..=re.degree().max(im.degree())).map(|k| p.coefficient(k)).collect();
            Some((factor.coefficients().to_vec(), ComplexPolynomial { re: list(&re), im: list(&im) }))
        };
        split().unwrap_or_else(|| (vec![RationalFunction::one()], self.clone()))
    }

    /// The coefficients with images in the place of their parts; `None` where one has none.
    pub(crate) fn try_map(
        &self,
        image: impl Fn(&RationalFunction) -> Option<RationalFunction>,
    ) -> Option<ComplexPolynomial> {
        let [re, im] = [&self.re, &self.im].map(|list| list.iter().map(&image).collect::<Option<Vec<_>>>());
        Some(ComplexPolynomial { re: re?, im: im? })
    }
}
