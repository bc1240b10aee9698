//! Every expression of a model as a value.

use super::linear::linear;
use super::scalar::Scope;
use super::transfer::{Fraction, MAX_ORDER, fraction, held_fraction, polynomial};
use super::walk::{Failure, Meaning, division_by_zero};
use super::zpoly::ZPoly;
use crate::error::{Code, Diagnostic, Span};
use crate::model::complex::{Frame, Lift, lifted, names_of_parts};
use crate::model::definition::{
    Block, Discretization, Dynamics, Form, Matrix, Model, Output, Ports, Pulses, Rate, Time,
};
use crate::model::discretization::{Edges, Inputs, Kind, Rule};
use crate::model::text::names::shorten;
use crate::model::text::{Expression, Function};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::collections::{BTreeMap, HashMap};

/// The coefficients of a linear expression by signal.
pub(in crate::model) type Row = BTreeMap<usize, RationalFunction>;

/// The numbers of signals or states: those that are driven first, then the external ones.
pub(in crate::model) struct Wiring<'m> {
    pub numbers: HashMap<&'m str, usize>,
    /// How many are driven.
    pub driven: usize,
    pub inputs: Vec<String>,
    /// Whether each signal has become two, its real and its imaginary part.
    pub is_complex: bool,
}

impl<'m> Wiring<'m> {
    pub fn of(model: &'m Model) -> Self {
        let own: Vec<&str> = match &model.form {
            Form::Characteristic(_) => Vec::new(),
            Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. } => {
                ports.states.iter().map(|n| n.name.as_str()).collect()
            }
            Form::Blocks(diagram) => diagram.driven().map(|(n, _)| n.name.as_str()).collect(),
        };
        let inputs: Vec<&str> = model.inputs().iter().map(|n| n.name.as_str()).collect();
        let mut numbers: HashMap<&str, usize> = own.iter().enumerate().map(|(i, n)| (*n, i)).collect();
        if matches!(model.form, Form::Blocks(_)) {
            numbers.extend(inputs.iter().enumerate().map(|(i, n)| (*n, own.len() + i)));
        }
        let inputs = inputs.into_iter().map(str::to_owned).collect();
        Wiring { numbers, driven: own.len(), inputs, is_complex: false }
    }

    /// The names of a signal's parts: of a real one only its own.
    pub fn parts_of(&self, name: &str) -> Vec<String> {
        if self.is_complex { names_of_parts([name.to_owned()]) } else { vec![name.to_owned()] }
    }
}

/// The values of everything in a model's form.
pub(in crate::model) enum Values {
    /// The real and the imaginary part.
    Characteristic([ZPoly; 2]),
    Matrix {
        matrix: RationalMatrix,
        ports: PortValues,
    },
    Feedback {
        a: RationalMatrix,
        b: RationalMatrix,
        c: RationalMatrix,
        k: RationalMatrix,
        ports: PortValues,
    },
    Blocks {
        blocks: Vec<BlockValues>,
        outputs: Vec<Row>,
    },
}

pub(in crate::model) struct PortValues {
    pub input_matrix: Option<RationalMatrix>,
    pub outputs: Vec<Row>,
}

pub(in crate::model) struct BlockValues {
    pub name: String,
    pub span: Span,
    pub inputs: Vec<Row>,
    pub outputs: usize,
    pub rate: Rate,
    /// When real and imaginary parts become signals of their own.
    pub lift: Lift,
    pub dynamics: DynamicValues,
    pub discretization: Option<DiscretizationValues>,
    /// What it says of its pulses, where it is a modulator.
    pub modulator: Option<Modulator>,
}

/// What a block says of the pulses that it commands.
pub(in crate::model) struct Modulator {
    /// How high they are.
    pub amplitude: RationalFunction,
    /// How far one begins behind another.
    pub period: RationalFunction,
    /// Where the period stands.
    pub span: Span,
}

/// How a continuous block is made discrete.
pub(in crate::model) enum DiscretizationValues {
    /// By a rule with the sample time, or Tustin's with its factor.
    Rule { rule: Rule, value: RationalFunction, prewarp: Option<Prewarp> },
    /// By what it does behind a hold.
    Hold(Hold),
}

/// A bilinear map that is exact at one frequency.
pub(in crate::model) struct Prewarp {
    /// The angle `w T` of that frequency: below pi.
    pub angle: RationalFunction,
    pub span: Span,
}

/// A hold or a modulator.
pub(in crate::model) struct Hold {
    pub inputs: Inputs,
    /// For each input the edges of its pulses; `None` for one that is held.
    pub pulses: Vec<Option<Pulse>>,
    pub time: RationalFunction,
    /// Dead time of the inputs, in units of time.
    pub delay: RationalFunction,
    /// How the block is seen, where its input is held in another frame.
    pub frame: Option<Box<Frame>>,
    pub span: Span,
}

/// The pulse of an input.
#[derive(Clone)]
pub(in crate::model) struct Pulse {
    pub duty: RationalFunction,
    /// Where the edges stand that commands at even and at odd samples move, in sample times; each moves by the same share of a change of
    /// the duty ratio.
    pub edges: [Vec<RationalFunction>; 2],
    /// Whether these are different.
    pub alternates: bool,
    /// Which edges these are and where that is asked for, where the duty ratio is that of the loop at rest.
    pub steady: Option<(&'static Edges, Span)>,
}

pub(in crate::model) enum DynamicValues {
    /// Numerator and denominator, of which the denominator's degree is the order.
    Ratio(Fraction),
    /// The same with complex coefficients, of which these are the real and the imaginary parts.
    ComplexRatio {
        numerator: [ZPoly; 2],
        denominator: [ZPoly; 2],
    },
    StateSpace {
        a: RationalMatrix,
        b: RationalMatrix,
        c: RationalMatrix,
        d: RationalMatrix,
    },
}

struct Evaluator<'e, 'a> {
    scope: &'e mut Scope<'a>,
    report: &'e mut dyn FnMut(Failure),
}

impl Evaluator<'_, '_> {
    fn keep<T>(&mut self, value: Result<T, Failure>) -> Option<T> {
        value.map_err(&mut *self.report).ok()
    }

    fn scalar(&mut self, e: &Expression) -> Option<RationalFunction> {
        let value = self.scope.scalar(e);
        self.keep(value)
    }

    /// A value that has to be real.
    fn real(&mut self, e: &Expression) -> Option<RationalFunction> {
        let value = self.scope.real(e);
        self.keep(value)
    }

    fn matrix(&mut self, matrix: &Matrix) -> Option<RationalMatrix> {
        let mut rows = Vec::with_capacity(matrix.rows.len());
        let mut complete = true;
        for row in &matrix.rows {
            let values: Vec<Option<RationalFunction>> = row.iter().map(|e| self.scalar(e)).collect();
            match values.into_iter().collect::<Option<Vec<_>>>() {
                Some(row) => rows.push(row),
                None => complete = false,
            }
        }
        if complete { RationalMatrix::from_rows(rows) } else { None }
    }

    fn rows<'x>(&mut self, list: impl Iterator<Item = &'x Expression>, wiring: &Wiring<'_>) -> Option<Vec<Row>> {
        let rows: Vec<Option<Row>> = list
            .map(|e| {
                let row = linear(e, &wiring.numbers, self.scope);
                self.keep(row)
            })
            .collect();
        rows.into_iter().collect()
    }

    fn outputs(&mut self, outputs: &[Output], wiring: &Wiring<'_>) -> Option<Vec<Row>> {
        self.rows(outputs.iter().map(|o| &o.expression), wiring)
    }

    fn ports(&mut self, ports: &Ports, wiring: &Wiring<'_>) -> Option<PortValues> {
        let input_matrix = match &ports.input_matrix {
            Some(e) => Some(self.matrix(e)?),
            None => None,
        };
        Some(PortValues { input_matrix, outputs: self.outputs(&ports.outputs, wiring)? })
    }

    fn block(&mut self, block: &Block, wiring: &Wiring<'_>, variable: &str) -> Option<BlockValues> {
        let inputs = self.rows(block.inputs.iter(), wiring);
        let variable = if block.discretization.is_some() { "s" } else { variable };
        let mut dead_time = RationalFunction::zero();
        let dynamics = self.dynamics(block, variable, &mut dead_time);
        let mut discretization = match &block.discretization {
            None => Some(None),
            Some(d) => self.discretization(d, block.rate).map(Some),
        };
        if let Some(Some(DiscretizationValues::Hold(hold))) = &mut discretization {
            hold.delay = &hold.delay + &dead_time;
            if let (Some(pulses), Some(inputs)) =
                (block.discretization.as_ref().and_then(|d| d.pulses.as_ref()), &inputs)
            {
                let turns = hold.frame.as_ref().is_some_and(|frame| !frame.is_at_rest());
                hold.pulses = self.pulses(pulses, inputs, wiring.driven, turns)?;
            }
        }
        let modulator = match &block.pwm {
            None => Some(None),
            Some(pwm) => {
                // All of them, so that every mistake is reported.
                let [amplitude, _, period] = [&pwm.amplitude, &pwm.carrier, &pwm.period].map(|e| self.real(e));
                let of = |(amplitude, period)| Modulator { amplitude, period, span: pwm.period.span };
                amplitude.zip(period).map(of).map(Some)
            }
        };
        Some(BlockValues {
            name: block.name.clone(),
            span: block.span,
            inputs: inputs?,
            outputs: block.outputs.len(),
            rate: block.rate,
            lift: Lift::Done,
            dynamics: dynamics?,
            discretization: discretization?,
            modulator: modulator?,
        })
    }

    fn discretization(&mut self, d: &Discretization, rate: Rate) -> Option<DiscretizationValues> {
        // All of them, so that every mistake is reported.
        let mut value = |e: &Option<Expression>| e.as_ref().map(|e| (self.real(e), e.span));
        let (time, factor, prewarp, delay) =
            (value(&d.sample_time), value(&d.factor), value(&d.prewarp), value(&d.delay));
        let (speed, advance) = (value(&d.frame), value(&d.advance));
        let by_rule = |rule, value| DiscretizationValues::Rule { rule, value, prewarp: None };
        if let (Kind::Rule(rule), Some((factor, _))) = (&d.method.kind, factor) {
            return Some(by_rule(*rule, factor?));
        }
        let Some((time, time_span)) = time else {
            let error = Diagnostic::error(Code::Discretize, "'discretize' has no sample time");
            (self.report)(error.at(d.span, "how long is a step?").help("give T = \"..\"").into());
            return None;
        };
        // The loop's sample time stands for the period of a block that is slower.
        let own = if d.is_sample_time_of_loop { Rational::from(rate.every as i64) } else { Rational::ONE };
        let time = &time? * &own.into();
        let rule = match d.method.kind {
            Kind::Hold { inputs, .. } => {
                let delay = match delay {
                    Some((delay, _)) => delay?,
                    None => RationalFunction::zero(),
                };
                let frame = match speed {
                    Some((speed, span)) => {
                        let advance = advance.map_or(Some(RationalFunction::zero()), |(advance, _)| advance)?;
                        Some(Box::new(self.frame(&(&speed? * &time), &advance, span)?))
                    }
                    None => None,
                };
                return Some(DiscretizationValues::Hold(Hold {
                    inputs,
                    pulses: Vec::new(),
                    time,
                    delay,
                    frame,
                    span: d.span,
                }));
            }
            Kind::Rule(rule) if !d.method.has_key("c") => return Some(by_rule(rule, time)),
            Kind::Rule(rule) => rule,
        };
        // c = 2/T, or c = w/tan(w T/2): expressions of the model like any other.
        let Some((frequency, span)) = prewarp else {
            let value = self.quotient(2.into(), time, time_span)?;
            return Some(by_rule(rule, value));
        };
        let frequency = frequency?;
        if frequency.is_zero() {
            let error = Diagnostic::error(Code::Discretize, "the frequency of 'prewarp' must be positive");
            let help = "leave 'prewarp' out: the rule as it is has no error at frequency 0";
            (self.report)(error.at(span, "not positive").help(help).into());
            return None;
        }
        let angle = &frequency * &time;
        let half = &angle * &RationalFunction::from(Rational::new(1.into(), 2.into()));
        let tangent = self.scope.tangent_of_a_rule(half);
        let value = self.quotient(frequency, tangent, span)?;
        Some(DiscretizationValues::Rule { rule, value, prewarp: Some(Prewarp { angle, span }) })
    }

    /// A frame that turns by an angle in each sample.
    fn frame(&mut self, angle: &RationalFunction, advance: &RationalFunction, span: Span) -> Option<Frame> {
        let mut rotation = |angle: RationalFunction| {
            let of = [Function::Cos, Function::Sin].map(|f| self.scope.call(f, angle.clone(), span));
            let [cosine, sine] = of.map(|value| self.keep(value));
            Some([cosine?, sine?])
        };
        let [cosine, sine] = rotation(angle.clone())?;
        let (turn, enters) = ([cosine, -sine], rotation(advance - angle)?);
        Some(Frame { turn, enters, direct: rotation(advance.clone())? })
    }

    /// The pulses of inputs, which are these expressions in signals; with one word for all of them, an input that no signal of the
    /// loop is in is held: nothing controls it. In a frame that turns against the block's own they are those of zero voltage.
    fn pulses(&mut self, pulses: &Pulses, inputs: &[Row], driven: usize, turns: bool) -> Option<Vec<Option<Pulse>>> {
        let duties: Vec<RationalFunction> = match pulses.is_steady {
            true => vec![self.scope.duty()],
            false => pulses.duties.iter().map(|e| self.real(e)).collect::<Option<_>>()?,
        };
        let half = RationalFunction::from(Rational::new(1.into(), 2.into()));
        if let Some(at) = duties.iter().position(|duty| *duty != half).filter(|_| turns) {
            let message = "pulses are seen from a frame that turns at the duty ratio 1/2 only, which is the voltage 0";
            let error = Diagnostic::error(Code::Frame, message).at(pulses.duties[at].span, "not 1/2");
            let help = "at another voltage the duty ratios of the legs turn with the angle, and no sample is like the one before: write duty = 0.5, \
                        or hold the voltage: method = \"zoh\"";
            (self.report)(error.help(help).into());
            return None;
        }
        let one_of = |len: usize, i: usize| if len == 1 { 0 } else { i };
        let of = |(i, row): (usize, &Row)| {
            let edges = pulses.edges[one_of(pulses.edges.len(), i)]?;
            let is_external = |row: &Row| row.iter().all(|(signal, c)| *signal >= driven || c.is_zero());
            let is_external = pulses.edges.len() == 1 && inputs.len() > 1 && is_external(row);
            let duty = &duties[one_of(duties.len(), i)];
            let (alternates, steady) = (edges.alternate(), pulses.is_steady.then(|| (edges, pulses.duties[0].span)));
            (!is_external).then(|| Pulse { duty: duty.clone(), edges: edges.places(duty), alternates, steady })
        };
        Some(inputs.iter().enumerate().map(of).collect())
    }

    /// A quotient, by whose divisor the model divides.
    fn quotient(&mut self, a: RationalFunction, b: RationalFunction, span: Span) -> Option<RationalFunction> {
        let value = self.scope.quotient(a, b, span);
        self.keep(value)
    }

    /// A ratio whose degrees count only what is not zero whatever the parameters are.
    fn without_identities(&mut self, ratio: Fraction) -> Option<Fraction> {
        let [numerator, denominator] =
            [ratio.numerator, ratio.denominator].map(|p| self.scope.without_identities(p).map_err(Failure::from));
        Some(Fraction { numerator: self.keep(numerator)?, denominator: self.keep(denominator)? })
    }

    /// What a block does; behind a hold its dead time is added up beside it.
    fn dynamics(&mut self, block: &Block, variable: &str, dead_time: &mut RationalFunction) -> Option<DynamicValues> {
        let is_held = block.discretization.as_ref().is_some_and(|d| d.method.is_hold());
        let (ratio, span) = match &block.dynamics {
            Dynamics::Transfer(e) if is_held => {
                let value = held_fraction(e, self.scope);
                let (ratio, delay) = self.keep(value)?;
                *dead_time = delay;
                (ratio, e.span)
            }
            Dynamics::Transfer(e) => {
                let value = fraction(e, variable, self.scope);
                (self.keep(value)?, e.span)
            }
            Dynamics::Ratio { numerator, denominator } => {
                // Files give the highest power first.
                let mut list = |coefficients: &[Expression]| {
                    let values: Vec<Option<RationalFunction>> =
                        coefficients.iter().rev().map(|e| self.scalar(e)).collect();
                    values.into_iter().collect::<Option<Vec<_>>>().map(ZPoly::new)
                };
                let (numerator, denominator) = (list(numerator), list(denominator));
                let span = block.span;
                (Fraction { numerator: numerator?, denominator: denominator? }, span)
            }
            Dynamics::Gain(e) => (self.constant(e)?, e.span),
            Dynamics::Delay(e) => {
                let samples = self.samples(e)?;
                (Fraction { numerator: ZPoly::one(), denominator: ZPoly::power_of_variable(samples) }, block.span)
            }
            Dynamics::DeadTime(e) => {
                let time = self.real(e)?;
                let value = self.scope.delay(time, e.span);
                let value = self.keep(value)?;
                (Fraction { numerator: ZPoly::constant(value), denominator: ZPoly::one() }, e.span)
            }
            Dynamics::StateSpace { a, b, c, d } => {
                let (n, inputs, outputs) = (a.size().0, block.inputs.len(), block.outputs.len());
                let (a, b) = (self.matrix(a), self.matrix(b));
                let c = match c {
                    Some(c) => self.matrix(c),
                    None => Some(RationalMatrix::identity(n)),
                };
                let d = match d {
                    Some(d) => self.matrix(d),
                    None => Some(RationalMatrix::zeros(outputs, inputs)),
                };
                return Some(DynamicValues::StateSpace { a: a?, b: b?, c: c?, d: d? });
            }
            Dynamics::Static(d) => {
                let (inputs, outputs) = (block.inputs.len(), block.outputs.len());
                let d = self.matrix(d)?;
                return Some(DynamicValues::StateSpace {
                    a: RationalMatrix::zeros(0, 0),
                    b: RationalMatrix::zeros(0, inputs),
                    c: RationalMatrix::zeros(outputs, 0),
                    d,
                });
            }
        };
        let ratio = self.without_identities(ratio)?;
        if ratio.denominator.is_zero() {
            (self.report)(division_by_zero(span));
            return None;
        }
        if ratio.numerator.degree() > ratio.denominator.degree() {
            let (n, d) = (ratio.numerator.degree(), ratio.denominator.degree());
            let message = format!("the transfer function of '{}' is improper", shorten(&block.name));
            let error = Diagnostic::error(Code::Improper, message);
            let error = error.at(span, format!("degree {n} over degree {d}"));
            (self.report)(
                error
                    .help("the numerator's degree must not exceed the denominator's; add a delay or a filter pole")
                    .into(),
            );
            return None;
        }
        Some(DynamicValues::Ratio(ratio))
    }

    /// A number of samples, on which the order of the loop depends.
    fn samples(&mut self, e: &Expression) -> Option<usize> {
        let value = self.scalar(e)?.as_constant();
        let samples = value.as_ref().filter(|v| v.is_integer()).and_then(|v| v.numerator().to_i64());
        let samples = samples.and_then(|n| usize::try_from(n).ok()).filter(|&n| n <= MAX_ORDER);
        if samples.is_none() {
            let message = format!("a delay is a whole number of samples from 0 to {MAX_ORDER}");
            let error = Diagnostic::error(Code::Value, message);
            (self.report)(
                match value {
                    None => error
                        .at(e.span, "not a number of samples")
                        .help("the order of the loop depends on it: it is made of numbers and constants only"),
                    Some(value) => error.at(e.span, format!("this is {}", shorten(&value.to_string()))).help(
                        "fractions of a sample go with a held block: discretize = { method = \"zoh\", T = \"T\", \
                         delay = \"1.5*T\" }",
                    ),
                }
                .into(),
            );
        }
        samples
    }

    fn constant(&mut self, e: &Expression) -> Option<Fraction> {
        let value = self.scalar(e)?;
        Some(Fraction { numerator: ZPoly::constant(value), denominator: ZPoly::one() })
    }
}

/// Evaluates the form; `None` when something was reported. Where it is complex each signal becomes two.
pub(in crate::model) fn symbolic(
    model: &Model,
    wiring: &mut Wiring<'_>,
    scope: &mut Scope<'_>,
    report: &mut dyn FnMut(Failure),
) -> Option<Values> {
    let values = as_written(model, wiring, scope, report)?;
    Some(lifted(values, wiring, scope.unit))
}

/// Evaluates the form as it is written; `None` when something was reported.
fn as_written(
    model: &Model,
    wiring: &Wiring<'_>,
    scope: &mut Scope<'_>,
    report: &mut dyn FnMut(Failure),
) -> Option<Values> {
    scope.is_continuous = model.time == Time::Continuous;
    let mut evaluator = Evaluator { scope, report };
    if let Some(e) = &model.sample_time {
        evaluator.real(e);
    }
    match &model.form {
        Form::Characteristic(e) => {
            let value = polynomial(e, model.time.variable(), evaluator.scope);
            let value = value.and_then(|p| Ok(evaluator.scope.without_identities(p)?));
            evaluator.keep(value).map(|p| Values::Characteristic([p, ZPoly::new(Vec::new())]))
        }
        Form::Matrix { matrix, ports } => {
            let (matrix, ports) = (evaluator.matrix(matrix), evaluator.ports(ports, wiring));
            Some(Values::Matrix { matrix: matrix?, ports: ports? })
        }
        Form::OutputFeedback { a, b, c, k, ports } => {
            let [a, b, c, k] = [a, b, c, k].map(|m| evaluator.matrix(m));
            let ports = evaluator.ports(ports, wiring);
            Some(Values::Feedback { a: a?, b: b?, c: c?, k: k?, ports: ports? })
        }
        Form::Blocks(diagram) => {
            let variable = model.time.variable();
            let blocks: Vec<Option<BlockValues>> =
                diagram.blocks.iter().map(|b| evaluator.block(b, wiring, variable)).collect();
            let outputs = evaluator.outputs(&diagram.outputs, wiring);
            Some(Values::Blocks { blocks: blocks.into_iter().collect::<Option<_>>()?, outputs: outputs? })
        }
    }
}
