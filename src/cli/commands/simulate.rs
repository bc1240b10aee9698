//! `jurist simulate`: time responses of the sampled loop, or of the switched circuit.

use super::Context;
use crate::cli::arguments::{ModelOptions, PictureOptions, RunOptions};
use crate::cli::assignments::{in_line, plain_number};
use crate::cli::input::{load, question};
use crate::cli::output::note;
use crate::cli::picture::{Picture, deliver, wanted};
use crate::cli::status::{Error, Outcome, Status};
use clap::{Args, ValueEnum};
use jurist_algebra::number::parse_number;
use jurist_draw::document::{CircuitAnswer, SimulationAnswer, TimeUnit, simulation_json};
use jurist_draw::figures::{Figure, heading, response_panels, stacked};
use jurist_draw::simulate::{
    Excitation, Pulse, Record, SampledModel, StepMeasures, SwitchedModel, excitation, natural_duration, signal_unit,
};
use jurist_engine::answer::Verdict;
use jurist_engine::error::{Diagnostic, Source};
use jurist_engine::model::{Model, Time};
use jurist_engine::problem::Problem;
use jurist_engine::show::documents::to_text;

/// The built-in drive as blocks, which is what a switched simulation reads.
const DRIVE_BLOCKS: &str = include_str!("../../../examples/drive-blocks.toml");

/// Longer runs are refused: they would fill the memory.
const MOST_SAMPLES: f64 = 2e7;

/// Samples of a continuous loop over the duration.
const CONTINUOUS_SAMPLES: f64 = 2000.0;

/// Samples where the model and the command line name no duration and a second has fewer.
const LEAST_SAMPLES: f64 = 50.0;

/// Where in its period a pulse lies.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(in crate::cli) enum PulsePlace {
    /// On from the period's beginning
    #[default]
    Beginning,
    /// On until the period's end
    End,
    /// Around the middle of the period
    Centre,
}

/// Options of `jurist simulate`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Gives an input a value, from a time on if one is named [repeatable; with none: a unit step of the first]
    #[arg(long, value_name = "NAME=VALUE[@SECONDS]")]
    pub input: Vec<String>,
    /// Gives a state its value at the beginning [repeatable]
    #[arg(long, value_name = "NAME=VALUE")]
    pub initial: Vec<String>,
    /// How long to simulate, in seconds (in samples without a sample time) [default: the model's, else until the
    /// slowest root has died away or the fastest has grown, and at least 50 samples]
    #[arg(long, value_name = "SECONDS")]
    pub duration: Option<String>,
    /// Simulates the switching circuit, for every block with a 'pwm' entry
    #[arg(long)]
    pub switched: bool,
    /// Where the pulse lies in its period
    #[arg(long, value_enum, default_value_t, requires = "switched")]
    pub pulse: PulsePlace,
    /// Starts in the periodic steady state instead of the initial state
    #[arg(long, requires = "switched", conflicts_with = "initial")]
    pub steady: bool,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub run: RunOptions,
}

/// Inputs, initial values and the duration, from the model and the command line.
struct Course {
    /// Name, time, value.
    inputs: Vec<(String, f64, f64)>,
    initial: Vec<(String, f64)>,
    duration: f64,
    /// Fewer samples are too few to see; 1 where a duration was asked for.
    least_samples: f64,
}

/// Draws to a file or on the terminal.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let kind = wanted(&options.picture)?;
    let model = match (&options.model.model, options.switched) {
        (None, true) => Model::from_toml(&Source::new("<built-in drive>", DRIVE_BLOCKS))?.0,
        (path, _) => load(path.as_ref(), context)?,
    };
    let problem = question(context, &model, &options.model, &Default::default())?.problem()?;
    context.warn(None, problem.warnings());
    let course = Course::of(options, &problem, context)?;
    context.budget.step("simulating");
    let (mut answer, finals) = if options.switched {
        (switched(options, &problem, &course, context)?, Vec::new())
    } else {
        sampled(&problem, &course, context)?
    };
    answer.trace = answer.trace.with_units(|name| signal_unit(&model, name));
    let verdict = problem.verdict(&context.budget)?.value().verdict;
    context.reporter.finish();
    let figure = figure(&problem, &answer, if verdict == Verdict::Stable { &finals } else { &[] }, verdict);
    let table = || answer.trace.to_csv();
    let document = || to_text(&simulation_json(&problem, &answer));
    let out = Picture { figure: &figure, csv: &table, json: &document, csv_beside: options.picture.csv };
    deliver(&out, kind, options.picture.output.as_ref())?;
    Ok(Status::Holds)
}

/// The outputs over time, one panel each; of the circuit all but the duty ratios. Marked is how signals go to their
/// final values, where these are known.
fn figure(problem: &Problem, answer: &SimulationAnswer, finals: &[(String, f64)], verdict: Verdict) -> Figure {
    let model = problem.model();
    let all = || answer.trace.signals.iter().map(|s| s.name.clone());
    let outputs: Vec<String> = model.outputs().iter().map(|o| o.name.name.clone()).collect();
    let (shown, kind) = match &answer.circuit {
        Some(_) => (all().filter(|n| !n.ends_with(".duty")).collect(), "Response of the switched circuit"),
        None if outputs.is_empty() => (all().collect(), "Response"),
        None => (outputs, "Response"),
    };
    let unit = TimeUnit::of(model, answer.sample_time).name();
    let held = model.time() == Time::Discrete && answer.circuit.is_none();
    let panels = response_panels(unit, &answer.trace, &shown, held);
    let measured = panels.into_iter().zip(&shown).map(|(panel, name)| {
        let last = finals.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
        let measures = last.and_then(|last| StepMeasures::of(&answer.trace, name, last));
        let signal_unit = answer.trace.signal(name).map_or("", |s| &s.unit);
        match measures {
            Some(measures) => panel.with_step_measures(&measures, unit, signal_unit),
            None => panel,
        }
    });
    let panels: Vec<_> = measured.collect();
    let mut heading = heading(kind, problem);
    if verdict != Verdict::Stable && answer.circuit.is_none() {
        heading.notes.push(format!("the loop is {}", verdict.name()));
    }
    stacked(&panels, 760.0, 230.0).headed(&heading)
}

impl Course {
    fn of(options: &Options, problem: &Problem, context: &Context) -> Result<Course, Error> {
        let model = problem.model();
        let defaults = model.simulation();
        let duration = match &options.duration {
            Some(text) => plain_number(context.line, "--duration", text)?.to_f64_approximate(),
            None => match &defaults.duration {
                Some(duration) => duration.to_f64_approximate(),
                None => natural_duration(problem, &context.budget)?.unwrap_or(1.0),
            },
        };
        if !(duration.is_finite() && duration > 0.0) {
            return Err(Diagnostic::error("E-simulation", "the duration has to be positive").into());
        }
        let mut inputs: Vec<(String, f64, f64)> =
            defaults.inputs.iter().map(|(n, v)| (n.name.clone(), 0.0, v.to_f64_approximate())).collect();
        for text in &options.input {
            inputs.push(input_step(text, context)?);
        }
        let mut initial: Vec<(String, f64)> =
            defaults.initial.iter().map(|(n, v)| (n.name.clone(), v.to_f64_approximate())).collect();
        for text in &options.initial {
            let (name, value, _) = parsed("--initial", text, context)?;
            initial.push((name, value));
        }
        if inputs.is_empty() && initial.is_empty() && !options.steady {
            let what = match model.inputs().first() {
                Some(first) => {
                    inputs.push((first.name.clone(), 0.0, 1.0));
                    format!(
                        "a unit step of '{}', since no input is given; --input NAME=VALUE or [simulation] gives others",
                        first.name
                    )
                }
                None => {
                    "the loop has no inputs and begins at rest: --initial NAME=VALUE gives a state a value".to_owned()
                }
            };
            if !options.run.quiet {
                note(&what);
            }
        }
        let asked = options.duration.is_some() || defaults.duration.is_some();
        let least_samples = if asked { 1.0 } else { LEAST_SAMPLES };
        Ok(Course { inputs, initial, duration, least_samples })
    }

    /// Inputs as steps at samples `period` apart.
    fn steps(&self, period: f64) -> Vec<(String, usize, f64)> {
        let sample = |t: f64| (t / period - 1e-9).ceil().max(0.0) as usize;
        self.inputs.iter().map(|(name, t, v)| (name.clone(), sample(*t), *v)).collect()
    }

    fn samples(&self, period: f64) -> Result<usize, Error> {
        let count = (self.duration / period).round().max(self.least_samples);
        if count > MOST_SAMPLES {
            let message = format!("{count:e} samples are too many for a simulation");
            return Err(Diagnostic::error("E-simulation", message).help("shorten it with --duration").into());
        }
        Ok(count as usize)
    }
}

fn input_step(text: &str, context: &Context) -> Result<(String, f64, f64), Error> {
    let (name, value, time) = parsed("--input", text, context)?;
    Ok((name, time, value))
}

/// Name, value, time of `NAME=VALUE[@TIME]`.
fn parsed(option: &str, text: &str, context: &Context) -> Result<(String, f64, f64), Error> {
    let wrong = |what: &str| {
        let place = context.line.option_value(option, text).span;
        let error = Diagnostic::error("E-option-value", format!("{option} expects NAME=VALUE"));
        Error::from(in_line(context.line, vec![error.at(place, what).help("for example T_L=5@1 after one second")]))
    };
    let (name, rest) = text.split_once('=').ok_or_else(|| wrong("there is no '='"))?;
    let (value, time) = rest.split_once('@').unwrap_or((rest, "0"));
    let number = |part: &str| parse_number(part.trim()).map(|v| v.to_f64_approximate());
    match (number(value), number(time)) {
        (Ok(value), Ok(time)) if value.is_finite() && time >= 0.0 => Ok((name.trim().to_owned(), value, time)),
        _ => Err(wrong("not a number")),
    }
}

/// The run, and where its signals go if the loop is stable and the inputs stay as they are at the beginning.
fn sampled(
    problem: &Problem,
    course: &Course,
    context: &Context,
) -> Result<(SimulationAnswer, Vec<(String, f64)>), Error> {
    let step = course.duration / CONTINUOUS_SAMPLES;
    let system = SampledModel::from_loop(problem, step, &context.budget)?;
    let at = |name: &str| system.state_named(name);
    let steps = course.steps(system.sample_time);
    let drive = excitation(at, system.states.len(), &system.inputs, &course.initial, &steps)?;
    let samples = course.samples(system.sample_time)?;
    let trace = system.simulate_within(&drive, samples, &context.budget)?;
    if trace.time.len() <= samples {
        let last = trace.time.last().copied().unwrap_or(0.0);
        note(&format!("the response leaves the range of floating point after t = {last} s"));
    }
    let sampled = problem.algebra_over_symbols(&context.budget)?.sample_time().is_some();
    let constant = drive.steps.iter().all(|s| s.sample == 0);
    let finals = if constant { system.final_values(&drive.inputs_at(0, system.inputs.len())) } else { Vec::new() };
    Ok((SimulationAnswer { trace, sample_time: sampled.then_some(system.sample_time), circuit: None }, finals))
}

fn switched(
    options: &Options,
    problem: &Problem,
    course: &Course,
    context: &Context,
) -> Result<SimulationAnswer, Error> {
    let pulse = match options.pulse {
        PulsePlace::Beginning => Pulse::Beginning,
        PulsePlace::End => Pulse::End,
        PulsePlace::Centre => Pulse::Centre,
    };
    let system = SwitchedModel::from_loop(problem, pulse, &context.budget)?;
    let at = |name: &str| system.state_named(name);
    let steps = course.steps(system.period());
    let initial: &[(String, f64)] = if options.steady { &[] } else { &course.initial };
    let drive: Excitation = excitation(at, system.plant_states().len(), system.inputs(), initial, &steps)?;
    let periods = course.samples(system.period())?;
    let mut circuit = CircuitAnswer::around(&system, &drive.inputs_at(0, system.inputs().len()));
    match &circuit.operating {
        Some(operating) => {
            let duty: Vec<String> = operating.duty.iter().map(|d| format!("{d:.6}")).collect();
            let largest = circuit.multipliers.first().map(|z| z.norm());
            let largest = largest.map_or_else(String::new, |m| format!(", largest multiplier {m:.6} per period"));
            note(&format!("periodic steady state (floating point): on {} of the period{largest}", duty.join(", ")));
        }
        None => note("no periodic steady state without clamping (floating point)"),
    }
    let start = match (options.steady, &circuit.operating) {
        (true, Some(operating)) => operating.state.clone(),
        (true, None) => {
            return Err(Diagnostic::error("E-simulation", "there is no periodic steady state to start from").into());
        }
        (false, _) => system.start(&drive),
    };
    // The ripple in full for as long as its file stays small, and round where it can be seen.
    let record = Record::Waveform(match periods {
        0..=200 => 15,
        201..=2000 => 3,
        _ => 0,
    });
    let run = system.simulate_within(&start, &drive, periods, record, &context.budget)?;
    circuit.clamped = run.clamped;
    if run.clamped > 0 {
        note(&format!("a modulator was at its limit in {} of {periods} periods", run.clamped));
    }
    Ok(SimulationAnswer { trace: run.trace, sample_time: Some(system.period()), circuit: Some(circuit) })
}
