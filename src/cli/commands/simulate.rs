//! `jurist simulate`: time responses of the sampled loop, or of the switched circuit.

use super::{Context, Runs};
use crate::cli::arguments::{ModelOptions, PictureOptions, RunOptions};
use crate::cli::assignments::{in_line, plain_number};
use crate::cli::destinations::Files;
use crate::cli::input::{load, question};
use crate::cli::output::note;
use crate::cli::picture::{Picture, deliver, wanted};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::suite::collect::text;
use crate::cli::table::Table;
use clap::{Args, ValueEnum};
use jurist_algebra::number::parse_number;
use jurist_draw::document::{CircuitAnswer, SimulationAnswer, simulation_json};
use jurist_draw::figures::response_figure;
use jurist_draw::simulate::{Course, Excitation, Pulse, Record, SwitchedModel, excitation, signal_unit};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Problem;
use jurist_show::documents::to_text;
use std::collections::HashMap;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;

/// The built-in drive as blocks, which is what a switched simulation reads.
const DRIVE_BLOCKS: &str = include_str!("../../../examples/drive-blocks.toml");

/// The column of times in a table of inputs.
const TIME: &str = "t";

/// Where in its period a pulse lies.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(in crate::cli) enum PulsePlace {
    /// On from the period's beginning
    Beginning,
    /// On until the period's end
    End,
    /// Around the middle of the period
    Centre,
    /// Halves at the beginning and at the end of the period
    Ends,
}

/// Options of `jurist simulate`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Gives an input a value, from a time on if one is named [repeatable; with none: a unit step of the first]
    #[arg(long, value_name = "NAME=VALUE[@SECONDS]")]
    pub input: Vec<String>,
    /// Inputs over time from a table in CSV: a column t in seconds (in samples without a sample time), and one for each input; a row holds until
    /// the next
    #[arg(long, value_name = "FILE")]
    pub inputs: Option<OsString>,
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
    /// Where the pulse lies in its period [default: where the model's modulator says, else at the beginning]
    #[arg(long, value_enum, requires = "switched")]
    pub pulse: Option<PulsePlace>,
    /// Starts in the periodic steady state instead of the initial state
    #[arg(long, requires = "switched", conflicts_with = "initial")]
    pub steady: bool,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let kind = wanted(&self.picture)?;
        let model = match (&self.model.model, self.switched) {
            (None, true) => Model::from_toml(&Source::new("<built-in drive>", DRIVE_BLOCKS))?.0,
            (path, _) => load(path.as_ref(), &self.model.line, context)?,
        };
        let problem = question(context, &model, &self.model, &Default::default())?.problem()?;
        context.warn(None, problem.warnings());
        let course = course(self, &problem, context)?;
        context.budget.step("simulating");
        let (mut answer, finals) = if self.switched {
            problem.refuse_written_complex()?;
            (switched(self, &problem, &course, context)?, Vec::new())
        } else {
            sampled(&problem, &course, context)?
        };
        answer.trace = answer.trace.with_units(|name| signal_unit(&model, name));
        let verdict = problem.verdict(&context.budget)?.value().verdict;
        context.reporter.finish();
        let figure = response_figure(&problem, &answer, &finals, verdict, course.is_duration_asked());
        let table = || answer.trace.to_csv();
        let document = || to_text(&simulation_json(&problem, &answer));
        let out = Picture { figure: &figure, csv: &table, json: &document, csv_beside: self.picture.csv };
        deliver(&out, kind, self.picture.output.as_ref())?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs.extend(self.inputs.iter().map(|path| ("the table of inputs", path.as_os_str())));
        files.picture(&self.model.model, &self.picture)
    }
}

/// Inputs over time: name, time from which on, value.
fn table_of_inputs(file: &OsString, model: &Model) -> Result<Vec<(String, f64, f64)>, Error> {
    let table = Table::read(&text(Path::new(file))?)?;
    let known = |name: &str| name == TIME || model.inputs().iter().any(|input| input.name == name);
    let wrong = |message: String, span| {
        let error = Diagnostic::error(Code::UnknownName, message).at(span, "this column");
        let names: Vec<&str> = model.inputs().iter().map(|name| name.name.as_str()).collect();
        let error = error.help(format!("columns are t and the inputs of the loop: {}", names.join(", ")));
        Diagnostics::new(Some(Arc::clone(&table.source)), vec![error])
    };
    if let Some((name, span)) = table.names.iter().find(|(name, _)| !known(name)) {
        return Err(wrong(format!("the loop has no input '{name}'"), *span).into());
    }
    if table.names.iter().all(|(name, _)| name != TIME) {
        return Err(wrong("the table says nothing of time".into(), table.names[0].1).into());
    }
    let (mut out, mut last) = (Vec::new(), HashMap::new());
    for row in &table.points {
        let time = row.iter().find(|(name, _)| name == TIME).map_or(0.0, |(_, t)| t.to_f64_approximate());
        for (name, value) in row.iter().filter(|(name, _)| name != TIME) {
            let value = value.to_f64_approximate();
            // Only what changes is a step.
            if last.insert(name.clone(), value) != Some(value) {
                out.push((name.clone(), time, value));
            }
        }
    }
    Ok(out)
}

/// Inputs, initial values and the duration, from the model and the command line.
fn course(options: &Options, problem: &Problem, context: &Context) -> Result<Course, Error> {
    let model = problem.model();
    let duration = options.duration.as_ref().map(|text| plain_number(context.line, "--duration", text)).transpose()?;
    let mut course = Course::of(problem, duration.map(|d| d.to_f64_approximate()), &context.budget)?;
    for text in &options.input {
        course.inputs.push(input_step(text, context)?);
    }
    if let Some(file) = &options.inputs {
        course.inputs.extend(table_of_inputs(file, problem.model())?);
    }
    for text in &options.initial {
        let (name, value, _) = parsed("--initial", text, context)?;
        course.initial.push((name, value));
    }
    if course.is_at_rest() && !options.steady {
        let what = match course.step_first_input(model) {
            Some(first) => format!(
                "a unit step of '{first}', since no input is given; --input NAME=VALUE or [simulation] gives others"
            ),
            None => "the loop has no inputs and begins at rest: --initial NAME=VALUE gives a state a value".to_owned(),
        };
        if !options.run.quiet {
            note(&what);
        }
    }
    Ok(course)
}

fn input_step(text: &str, context: &Context) -> Result<(String, f64, f64), Error> {
    let (name, value, time) = parsed("--input", text, context)?;
    Ok((name, time, value))
}

/// Name, value, time of `NAME=VALUE[@TIME]`.
fn parsed(option: &str, text: &str, context: &Context) -> Result<(String, f64, f64), Error> {
    let wrong = |what: &str| {
        let place = context.line.option_value(option, text).span;
        let error = Diagnostic::error(Code::OptionValue, format!("{option} expects NAME=VALUE"));
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
    let run = course.run(problem, &context.budget)?;
    if !run.is_complete {
        let last = run.trace.time.last().copied().unwrap_or(0.0);
        note(&format!("the response leaves the range of floating point after t = {last} s"));
    }
    Ok((SimulationAnswer { trace: run.trace, sample_time: run.sample_time, circuit: None }, run.finals))
}

fn switched(
    options: &Options,
    problem: &Problem,
    course: &Course,
    context: &Context,
) -> Result<SimulationAnswer, Error> {
    let pulse = options.pulse.map(|pulse| match pulse {
        PulsePlace::Beginning => Pulse::Beginning,
        PulsePlace::End => Pulse::End,
        PulsePlace::Centre => Pulse::Centre,
        PulsePlace::Ends => Pulse::Ends,
    });
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
            return Err(Diagnostic::error(Code::Simulation, "there is no periodic steady state to start from").into());
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
