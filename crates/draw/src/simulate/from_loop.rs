//! From a model to its simulations.

use super::sampled::{Excitation, SampledModel, Step, simulation_error};
use super::switched::{Controller, Plant, Pulse, Pwm, SwitchedModel, SwitchedState};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Span};
use jurist_engine::model::{
    Block, ClosedLoop, Diagram, Discretization, Expression, Factor, Form, Model, Name, Node, Output, Symbols, Time,
    value_approximate,
};
use jurist_engine::problem::Problem;
use nalgebra::DMatrix;

/// Entries of a matrix without free names, rounded; `symbols` are the values of its variables.
pub(super) fn rounded(matrix: &RationalMatrix, symbols: &[f64]) -> Result<DMatrix<f64>, Error> {
    let undefined = || Error::Undefined("an entry of the closed loop divides by zero".into());
    let mut values = Vec::with_capacity(matrix.entries().len());
    for entry in matrix.entries() {
        let value = match entry.as_constant() {
            Some(number) => number.to_f64_approximate(),
            None => Some(value_approximate(entry, symbols)).filter(|v| v.is_finite()).ok_or_else(undefined)?,
        };
        values.push(value);
    }
    Ok(DMatrix::from_row_slice(matrix.rows(), matrix.columns(), &values))
}

/// `E-dead-time`: what has no finite number of states.
fn refuse_dead_time(symbols: &Symbols) -> Result<(), Error> {
    if symbols.delays().is_empty() {
        return Ok(());
    }
    Err(Diagnostic::error(Code::DeadTime, "a loop with dead time has no finite number of states").into())
}

impl SampledModel {
    /// The closed loop of a problem at a point, entries rounded to `f64`.
    ///
    /// Discrete loops come with their sample time, or 1 if they have none. A continuous loop is
    /// sampled every `step` seconds, exactly for inputs that are constant in between.
    ///
    /// # Errors
    /// [`Error`] as for the closed loop; `E-simulation` when the step is not positive; `E-dead-time` for a loop with dead
    /// time, which is a [`DelayedModel`](super::DelayedModel).
    pub fn from_loop(problem: &Problem, step: f64, budget: &Budget) -> Result<SampledModel, Error> {
        let (ClosedLoop { a, e, c, d, states, inputs, outputs, .. }, symbols, time) =
            problem.closed_loop_in_numbers(budget)?;
        refuse_dead_time(symbols)?;
        let symbols = symbols.values_approximate(&[]);
        let rounded = |matrix| rounded(matrix, &symbols);
        let (mut transition, mut input) = (rounded(a)?, rounded(e)?);
        let mut sample_time = 1.0;
        if problem.time() == Time::Continuous {
            let (n, m) = (transition.nrows(), input.ncols());
            let mut bordered = DMatrix::zeros(n + m, n + m);
            bordered.view_mut((0, 0), (n, n)).copy_from(&(&transition * step));
            bordered.view_mut((0, n), (n, m)).copy_from(&(&input * step));
            let flow = bordered.exp();
            transition = flow.view((0, 0), (n, n)).into_owned();
            input = flow.view((0, n), (n, m)).into_owned();
            sample_time = step;
        } else if let Some(time) = time {
            sample_time = value_approximate(time, &symbols);
        }
        let model = SampledModel {
            transition,
            input,
            output: rounded(c)?,
            feedthrough: rounded(d)?,
            states: states.clone(),
            inputs: inputs.clone(),
            outputs: outputs.clone(),
            sample_time,
        };
        Ok(model.checked()?)
    }

    /// Which state a name means: a state, or an output that is one state and nothing else.
    pub fn state_named(&self, name: &str) -> Option<usize> {
        self.states.iter().position(|s| s == name).or_else(|| {
            let row = self.outputs.iter().position(|o| o == name)?;
            let direct = self.feedthrough.row(row).iter().all(|v| *v == 0.0);
            unit_position(self.output.row(row).iter().copied()).filter(|_| direct)
        })
    }
}

/// Whether each value of a signal holds until the next sample: in a discrete loop all but the responses of continuous plants behind holds.
pub fn is_sampled(model: &Model, name: &str) -> bool {
    let Form::Blocks(diagram) = model.form() else { return model.time() == Time::Discrete };
    let is_held = |discretization: &Discretization| discretization.method.is_hold();
    let mut held = diagram.blocks.iter().filter(|b| b.discretization.as_ref().is_some_and(is_held));
    model.time() == Time::Discrete && !held.any(|b| b.outputs.iter().any(|output| output.name == name))
}

/// The position of the only non-zero entry, if that is 1.
fn unit_position(row: impl Iterator<Item = f64>) -> Option<usize> {
    let mut found = None;
    for (j, v) in row.enumerate().filter(|(_, v)| *v != 0.0) {
        if v != 1.0 || found.is_some() {
            return None;
        }
        found = Some(j);
    }
    found
}

/// Names and values as steps at sample 0 and initial states.
///
/// # Errors
/// `E-simulation` for a name that is no input, or no state.
pub fn excitation(
    states: impl Fn(&str) -> Option<usize>,
    order: usize,
    inputs: &[String],
    initial: &[(String, f64)],
    steps: &[(String, usize, f64)],
) -> Result<Excitation, Diagnostics> {
    let mut out = Excitation { initial: vec![0.0; order], steps: Vec::new() };
    for (name, value) in initial {
        let unknown = || simulation_error(format!("'{name}' is no state that an initial value can be given"));
        // Of a complex signal the real part is meant, and a real one has no other.
        let state =
            states(name).or_else(|| states(&format!("{name}.re"))).or_else(|| states(name.strip_suffix(".re")?));
        out.initial[state.ok_or_else(unknown)?] = *value;
    }
    for (name, sample, value) in steps {
        let unknown = || {
            let error = Diagnostic::error(Code::Simulation, format!("the loop has no input '{name}'"));
            error.help(format!("its inputs: {}", inputs.join(", ")))
        };
        let position = |name: &str| inputs.iter().position(|i| i == name);
        let input =
            position(name).or_else(|| position(&format!("{name}.re"))).or_else(|| position(name.strip_suffix(".re")?));
        let input = input.ok_or_else(unknown)?;
        out.steps.push(Step { sample: *sample, input, value: *value });
    }
    Ok(out)
}

/// The unit of a signal of a simulation, where the model names it: `NAME.control` of a modulator has
/// the unit of the signal that drives it, `NAME.duty` is a number.
pub fn signal_unit(model: &Model, signal: &str) -> Option<String> {
    if let Some(unit) = model.unit(signal) {
        return Some(unit.to_owned());
    }
    let source = signal.strip_suffix(".control")?;
    let Form::Blocks(diagram) = model.form() else { return None };
    let block = diagram.blocks.iter().find(|b| b.pwm.is_some() && b.outputs.iter().any(|o| o.name == source))?;
    let span = block.inputs.first()?.span;
    let driven_by = model.source().text.get(span.start..span.end)?.trim_matches(['"', '\'', ' ']);
    model.unit(driven_by).map(str::to_owned)
}

/// The parts of a diagram that a switched simulation keeps apart.
struct Parts<'m> {
    sources: Vec<&'m Block>,
    continuous: Vec<&'m Block>,
    sampled: Vec<&'m Block>,
}

impl SwitchedModel {
    /// The circuit behind a model made of blocks: every block with a `pwm` entry becomes a source
    /// with pulses where the modulator before the plant has them, else at `pulse` or at the beginning of the period; every block with a `discretize` entry the continuous system it was,
    /// all other blocks run once per period.
    ///
    /// # Errors
    /// [`Error`]; `E-simulation` where the model has no such parts, where a continuous block is
    /// driven by a sampled one without a modulator between, where periods differ, or where `pulse` contradicts the model.
    pub fn from_loop(problem: &Problem, pulse: Option<Pulse>, budget: &Budget) -> Result<SwitchedModel, Error> {
        let model = problem.model();
        let Form::Blocks(diagram) = model.form() else {
            return Err(simulation_error("a switched simulation needs a model made of blocks").into());
        };
        if model.hyperperiod() > 1 {
            return Err(simulation_error("the switched simulation has one rate for all blocks").into());
        }
        let parts = Parts::of(diagram)?;
        if let Some(late) =
            parts.continuous.iter().find(|b| b.discretization.as_ref().is_some_and(|d| d.delay.is_some()))
        {
            let message = format!("the switched simulation has no dead time for '{}'", late.name);
            return Err(simulation_error(message).into());
        }
        let (period, sources) = parts.modulators(problem, pulse, budget)?;
        let (r, m) = (diagram.inputs.len(), sources.len());
        let part = |diagram: Diagram, time: Time| {
            let part = model.with_diagram(diagram, time);
            let evaluated = part.evaluate(&[], problem.set(), budget)?;
            let symbols = evaluated.symbols.values_approximate(&[]);
            Ok::<_, Error>((evaluated.closed_loop.ok_or_else(|| part.has_no_states())?, symbols))
        };
        let (plant, in_plant) = part(parts.plant(diagram), Time::Continuous)?;
        let (sampled, in_sampled) = part(parts.controller(diagram), Time::Discrete)?;
        let [a, e, c, d] = [&plant.a, &plant.e, &plant.c, &plant.d].map(|m| rounded(m, &in_plant));
        let (a, e, c, d) = (a?, e?, c?, d?);
        let held = e.ncols() - r - m;
        if e.columns(r + m, held).iter().chain(d.columns(r, m + held).iter()).any(|v| *v != 0.0) {
            let message = "a continuous block has to be driven by external inputs, continuous blocks and modulators, \
                and must not pass a modulator's pulses on at once";
            return Err(simulation_error(message).into());
        }
        let controller = controller(&sampled, &in_sampled, &c, &d.columns(0, r).into_owned())?;
        let mut plant_states = plant.states.clone();
        for (row, name) in plant.outputs.iter().enumerate() {
            if let Some(j) = unit_position(c.row(row).iter().copied()) {
                plant_states[j].clone_from(name);
            }
        }
        let plant = Plant { matrix: a, source: e.columns(r, m).into_owned(), input: e.columns(0, r).into_owned() };
        let inputs = diagram.inputs.iter().map(|n| n.name.clone()).collect();
        let period = period.to_f64_approximate();
        Ok(SwitchedModel::new(period, plant, sources, controller, [plant_states, sampled.states, inputs])?)
    }

    /// Which plant state a name means.
    pub fn state_named(&self, name: &str) -> Option<usize> {
        self.plant_states().iter().position(|s| s == name)
    }

    /// The state an excitation starts from: its initial values are those of the plant.
    pub fn start(&self, excitation: &Excitation) -> SwitchedState {
        let mut state = self.rest();
        for (slot, value) in state.plant.iter_mut().zip(&excitation.initial) {
            *slot = *value;
        }
        state
    }
}

/// The sampled part: `direct` is what passes from the external inputs to the continuous signals at once.
fn controller(
    sampled: &ClosedLoop,
    symbols: &[f64],
    c: &DMatrix<f64>,
    direct: &DMatrix<f64>,
) -> Result<Controller, Error> {
    let [f, g, h, k] = [&sampled.a, &sampled.e, &sampled.c, &sampled.d].map(|m| rounded(m, symbols));
    let (f, g, h, k) = (f?, g?, h?, k?);
    // Inputs of the sampled part: external, the continuous signals.
    let (r, signals) = (direct.ncols(), c.nrows());
    let (gy, ky) = (g.columns(r, signals), k.columns(r, signals));
    Ok(Controller {
        from_plant: gy * c,
        from_input: g.columns(0, r) + gy * direct,
        direct_plant: ky * c,
        direct_input: k.columns(0, r) + ky * direct,
        transition: f,
        output: h,
    })
}

impl<'m> Parts<'m> {
    /// The period of all modulators, which is the sample time, and what they do.
    fn modulators(
        &self,
        problem: &Problem,
        pulse: Option<Pulse>,
        budget: &Budget,
    ) -> Result<(Rational, Vec<Pwm>), Error> {
        let model = problem.model();
        let value = |e: &Expression| model.value(e, problem.set(), budget);
        let (mut period, mut sources): (Option<Rational>, Vec<Pwm>) = (None, Vec::new());
        for block in &self.sources {
            let Some(pwm) = &block.pwm else { continue };
            let this = value(&pwm.period)?;
            if period.as_ref().is_some_and(|p| *p != this) {
                return Err(simulation_error("all modulators need the same period").into());
            }
            period = Some(this);
            let amplitude = value(&pwm.amplitude)?;
            if amplitude.is_zero() {
                return Err(simulation_error(format!("the pulses of '{}' have no height", block.name)).into());
            }
            sources.push(Pwm {
                name: block.outputs[0].name.clone(),
                amplitude: amplitude.to_f64_approximate(),
                carrier: value(&pwm.carrier)?.to_f64_approximate(),
                pulse: self.pulse(&block.outputs[0].name, pulse)?,
            });
        }
        let period = period.ok_or_else(|| Error::from(simulation_error("no block has a 'pwm' entry")))?;
        if let Some(time) = model.sample_time_expression().map(value).transpose()?
            && time != period
        {
            return Err(simulation_error("the modulators' period is not the sample time").into());
        }
        Ok((period, sources))
    }

    fn of(diagram: &'m Diagram) -> Result<Self, Diagnostics> {
        let mut parts = Parts { sources: Vec::new(), continuous: Vec::new(), sampled: Vec::new() };
        for block in &diagram.blocks {
            if block.pwm.is_some() {
                if block.inputs.len() != 1 || block.outputs.len() != 1 {
                    return Err(simulation_error(format!(
                        "the modulator '{}' needs one input and one output",
                        block.name
                    )));
                }
                parts.sources.push(block);
            } else if block.discretization.is_some() {
                parts.continuous.push(block);
            } else {
                parts.sampled.push(block);
            }
        }
        if parts.continuous.is_empty() {
            return Err(simulation_error("no block has a 'discretize' entry, so nothing is continuous"));
        }
        let pulses: Vec<&str> = parts.sources.iter().map(|b| b.outputs[0].name.as_str()).collect();
        let reads = |b: &&&Block| b.inputs.iter().any(|e| pulses.iter().any(|pulse| e.names().contains(pulse)));
        if parts.sampled.iter().chain(&parts.sources).any(|b| reads(&b)) {
            return Err(simulation_error("a sampled block must not read a modulator's pulses"));
        }
        Ok(parts)
    }

    /// Where the pulses of a source lie: as the modulator before the plant says, else as is asked, else at the beginning of the period.
    fn pulse(&self, source: &str, asked: Option<Pulse>) -> Result<Pulse, Diagnostics> {
        let mut said = Vec::new();
        for block in &self.continuous {
            let Some(pulses) = block.discretization.as_ref().and_then(|d| d.pulses.as_ref()) else { continue };
            let reads = |e: &Expression| e.names().contains(source);
            for (j, _) in block.inputs.iter().enumerate().filter(|(_, e)| reads(e)) {
                let edges = pulses.edges[if pulses.edges.len() == 1 { 0 } else { j }];
                said.extend(edges.map(|edges| (edges.name, pulse_of(edges.name))));
            }
        }
        let Some((edge, pulse)) = said.first().copied() else { return Ok(asked.unwrap_or_default()) };
        let contradicts = |other: Option<Pulse>| other.is_some_and(|other| other != pulse);
        if contradicts(asked) || said.iter().any(|(_, other)| contradicts(Some(*other))) {
            let message =
                format!("the pulses of '{source}' have edge = \"{edge}\" in the model, and another place here");
            return Err(simulation_error(message));
        }
        Ok(pulse)
    }

    /// The continuous blocks as they are, open: external inputs, pulses, sampled signals go in, all
    /// their own signals come out.
    fn plant(&self, diagram: &Diagram) -> Diagram {
        let blocks = self.continuous.iter().map(|b| Block { discretization: None::<Discretization>, ..(*b).clone() });
        let inputs = diagram.inputs.iter().cloned().chain(outputs_of(&self.sources)).chain(outputs_of(&self.sampled));
        Diagram {
            inputs: inputs.collect(),
            outputs: as_outputs(outputs_of(&self.continuous)),
            blocks: blocks.collect(),
        }
    }

    /// The sampled blocks and the modulators, open: external inputs and continuous signals go in. What comes out is compared with the
    /// carriers: a modulator commands the mean of its pulses, which is its share of their height.
    fn controller(&self, diagram: &Diagram) -> Diagram {
        let inputs = diagram.inputs.iter().cloned().chain(outputs_of(&self.continuous));
        let compared = |b: &&&Block| {
            let pwm = b.pwm.as_ref()?;
            let mean = Expression::name(b.outputs[0].name.clone());
            let mut expression = pwm.carrier.clone();
            let share =
                [(Factor::Times, mean), (Factor::Over, pwm.amplitude.clone()), (Factor::Times, pwm.carrier.clone())];
            expression.node = Node::Product(share.to_vec());
            Some(Output { name: Name { name: b.name.clone(), span: Span::default() }, expression })
        };
        let read = self.sources.iter().filter_map(|b| compared(&b));
        let blocks = self.sampled.iter().chain(&self.sources).map(|b| (*b).clone()).collect();
        Diagram { inputs: inputs.collect(), outputs: read.collect(), blocks }
    }
}

/// The pulse whose edges are called so in a model.
fn pulse_of(edge: &str) -> Pulse {
    match edge {
        "leading" => Pulse::End,
        "double" => Pulse::Centre,
        "double-ends" => Pulse::Ends,
        _ => Pulse::Beginning,
    }
}

fn outputs_of<'b>(blocks: &'b [&Block]) -> impl Iterator<Item = Name> + 'b {
    blocks.iter().flat_map(|b| b.outputs.iter().cloned())
}

fn as_outputs(names: impl Iterator<Item = Name>) -> Vec<Output> {
    names.map(|n| Output { expression: Expression::name(n.name.clone()), name: n }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_engine::error::Source;
    use jurist_engine::problem::Ask;
    use nalgebra::DVector;

    /// Its characteristic polynomial over the constants of its modes takes a thousand times this work.
    #[test]
    fn a_simulation_does_not_wait_for_the_characteristic_polynomial() {
        let text = "time = 'discrete'\nsample_time = 0.1\n[parameters]\nK = 286\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
            [[block]]\ninput = 'K*(r - y)'\noutput = 'y'\n\
            transfer = '1/((s+1)*(s^2+0.4*s+4)*(s^2+0.66*s+11)*(s^2+s+26))'\ndiscretize = 'zoh'\n";
        let model = Model::from_toml(&Source::new("model.toml", text)).unwrap().0;
        let problem = model.ask().problem().unwrap();
        let system = SampledModel::from_loop(&problem, 1.0, &Budget::with_work(100_000_000)).unwrap();
        assert_eq!((system.states.len(), system.sample_time), (7, 0.1));
        // 286 times the gain 1/1144 of the plant at rest is 1/4.
        let values = system.final_values(&DVector::from_element(1, 1.0));
        assert!((values.last().unwrap().1 - 0.2).abs() < 1e-9, "{values:?}");
    }
}
