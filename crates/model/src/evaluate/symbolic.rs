//! Every expression of a model as a value.

use super::linear::linear;
use super::scalar::Scope;
use super::transfer::{Fraction, MAX_ORDER, fraction, held_fraction, polynomial};
use super::values::{
    BlockValues, DiscretizationValues, DynamicValues, Hold, Modulator, PortValues, Prewarp, Pulse, Row, Values, Wiring,
};
use super::walk::{Failure, Meaning, division_by_zero};
use super::zpoly::ZPoly;
use crate::complex::{Frame, Lift, lifted};
use crate::definition::{Block, Discretization, Dynamics, Form, Matrix, Model, Output, Ports, Pulses, Rate, Time};
use crate::discretization::Kind;
use crate::error::{Code, Diagnostic, Span};
use crate::text::names::shorten;
use crate::text::{Expression, Function};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

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
        let (inputs, outputs) = (block.inputs.len(), block.outputs.len());
        match &block.dynamics {
            Dynamics::StateSpace { a, b, c, d } => {
                let n = a.size().0;
                let (a, b) = (self.matrix(a), self.matrix(b));
                let c = c.as_ref().map_or_else(|| Some(RationalMatrix::identity(n)), |c| self.matrix(c));
                let d = d.as_ref().map_or_else(|| Some(RationalMatrix::zeros(outputs, inputs)), |d| self.matrix(d));
                Some(DynamicValues::StateSpace { a: a?, b: b?, c: c?, d: d? })
            }
            Dynamics::Static(d) => Some(DynamicValues::StateSpace {
                d: self.matrix(d)?,
                a: RationalMatrix::zeros(0, 0),
                b: RationalMatrix::zeros(0, inputs),
                c: RationalMatrix::zeros(outputs, 0),
            }),
            _ => {
                let (ratio, span) = self.ratio(block, variable, dead_time)?;
                self.proper(ratio, block, span).map(DynamicValues::Ratio)
            }
        }
    }

    /// Numerator and denominator of a block that is not in state space, and where they stand.
    fn ratio(&mut self, block: &Block, variable: &str, dead_time: &mut RationalFunction) -> Option<(Fraction, Span)> {
        let is_held = block.discretization.as_ref().is_some_and(|d| d.method.is_hold());
        Some(match &block.dynamics {
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
            Dynamics::Gain(e) => (constant(self.scalar(e)?), e.span),
            Dynamics::Delay(e) => {
                let samples = self.samples(e)?;
                (Fraction { numerator: ZPoly::one(), denominator: ZPoly::power_of_variable(samples) }, block.span)
            }
            Dynamics::DeadTime(e) => {
                let time = self.real(e)?;
                let value = self.scope.delay(time, e.span);
                let value = self.keep(value)?;
                (constant(value), e.span)
            }
            Dynamics::StateSpace { .. } | Dynamics::Static(_) => return None,
        })
    }

    /// The ratio, where it is proper.
    fn proper(&mut self, ratio: Fraction, block: &Block, span: Span) -> Option<Fraction> {
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
        Some(ratio)
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
}

fn constant(value: RationalFunction) -> Fraction {
    Fraction { numerator: ZPoly::constant(value), denominator: ZPoly::one() }
}

/// Evaluates the form; `None` when something was reported. Where it is complex each signal becomes two.
pub(crate) fn symbolic(
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
