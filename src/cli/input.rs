//! The model and the settings that a command is given.

use super::arguments::{DecisionOptions, ModelOptions, ReadingOptions, RegionOptions};
use super::assignments::{assignments, domains, in_line, plain_number};
use super::captured;
use super::commands::Context;
#[cfg(feature = "cli")]
use super::destinations::check_read;
#[cfg(feature = "cli")]
use super::output::write_answer;
use super::output::{note, plain};
#[cfg(feature = "cli")]
use crate::references::{Number, Resolved};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Source, Span};
use jurist_engine::model::{LoopLine, Model, source_from_bytes};
use jurist_engine::problem::{Ask, DECAY, Question, RADIUS, Region};
use jurist_engine::stability::Range;
use jurist_show::layout::visible;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::Read;
use std::path::Path;
#[cfg(feature = "cli")]
use std::path::PathBuf;
use std::sync::Arc;

/// Longer model files are refused.
const MAX_MODEL_BYTES: u64 = 64 << 20;

/// Reads the model and shows its warnings.
pub(super) fn load(model: Option<&OsString>, line: &ReadingOptions, context: &Context) -> Result<Model, Error> {
    if model.is_none() && *line == ReadingOptions::default() {
        return Ok(Model::drive());
    }
    if model.is_some_and(|path| path == "-")
        && let Some(model) = captured::model()
    {
        return Ok(model);
    }
    let named = read_model(model, line, context)?;
    let (model, warnings) = named.read?;
    if named.is_open_loop && !context.quiet {
        note("note: the line is taken for an open loop and closed with unity negative feedback");
    }
    if named.is_line && !context.quiet && model.parameter("i").is_some() {
        note("note: 'i' is a parameter; the imaginary unit is written 'j'");
    }
    context.warn(Some(model.source()), &warnings);
    tell_numbers(&named.name, &named.numbers, line, context)?;
    Ok(model)
}

/// Says which numbers came from other files and how they were read; writes the model with them, where that is asked for.
pub(super) fn tell_numbers(
    name: &str,
    numbers: &Numbers,
    options: &ReadingOptions,
    context: &Context,
) -> Result<(), Error> {
    #[cfg(feature = "cli")]
    {
        if let Some(file) = &options.resolved {
            let read: Vec<PathBuf> =
                std::iter::once(PathBuf::from(name)).chain(numbers.files.iter().cloned()).collect();
            check_read(context, [("the copy of the model", file)], &read)?;
            write_answer(&numbers.file, Some(file))?;
        } else if !numbers.said.is_empty() {
            context.note_references();
        }
    }
    #[cfg(not(feature = "cli"))]
    let _ = (name, options);
    if !context.quiet {
        numbers.said.iter().for_each(|said| note(&format!("note: {said}")));
    }
    Ok(())
}

/// What a model takes from other files.
#[derive(Default)]
pub(super) struct Numbers {
    /// A sentence for each number.
    said: Vec<String>,
    /// The model with all of them, as a file.
    #[cfg(feature = "cli")]
    file: String,
    /// The files.
    #[cfg(feature = "cli")]
    pub files: Vec<PathBuf>,
}

/// A model with the name that it was asked for by.
pub(super) struct NamedModel {
    pub name: String,
    /// The model with its warnings, or what is wrong with its text.
    pub read: Result<(Model, Vec<Diagnostic>), Diagnostics>,
    /// True of a line that is the transfer function of an open loop.
    is_open_loop: bool,
    /// True of a loop in one line.
    is_line: bool,
    pub numbers: Numbers,
}

/// Reads a model file, a loop in one line, or the built-in drive.
pub(super) fn read_model(
    model: Option<&OsString>,
    line: &ReadingOptions,
    context: &Context,
) -> Result<NamedModel, Error> {
    if let Some(text) = model.and_then(|text| loop_line(text)) {
        context.budget.step("reading the model");
        let read = LoopLine::read(text, line.hold.as_deref(), line.delay.as_deref());
        let is_open_loop = read.as_ref().is_ok_and(LoopLine::is_open_loop);
        let read = read.and_then(|line| line.model());
        return Ok(NamedModel {
            name: text.to_owned(),
            read,
            is_open_loop,
            is_line: true,
            numbers: Numbers::default(),
        });
    }
    refuse_line_options(line, context)?;
    let (name, bytes) = read_file(model, context)?;
    context.budget.step("reading the model");
    let mut numbers = Numbers::default();
    let read = source_from_bytes(&name, &bytes)
        .and_then(|source| with_numbers(source, model, &mut numbers))
        .and_then(|source| Model::from_toml(&source));
    Ok(NamedModel { name, read, is_open_loop: false, is_line: false, numbers })
}

/// The text with the numbers of files below the model's folder: of the folder that the program runs in, for standard input.
#[cfg(feature = "cli")]
fn with_numbers(
    source: Arc<Source>,
    model: Option<&OsString>,
    numbers: &mut Numbers,
) -> Result<Arc<Source>, Diagnostics> {
    let folder = model.map(Path::new).filter(|path| *path != Path::new("-")).and_then(Path::parent);
    let folder = folder.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let resolved = Resolved::of(&source, folder)?;
    numbers.files = resolved.numbers.iter().map(|number| folder.join(number.file())).collect();
    numbers.said = resolved.numbers.iter().map(Number::text).collect();
    numbers.file = resolved.source.text.clone();
    Ok(resolved.source)
}

#[cfg(not(feature = "cli"))]
fn with_numbers(source: Arc<Source>, _: Option<&OsString>, _: &mut Numbers) -> Result<Arc<Source>, Diagnostics> {
    Ok(source)
}

/// A hold and a delay stand in the model file itself.
fn refuse_line_options(line: &ReadingOptions, context: &Context) -> Result<(), Error> {
    for (option, value) in [("--hold", &line.hold), ("--delay", &line.delay)] {
        if let Some(value) = value {
            let message = format!("{option} goes with a loop in one line, not with a model file");
            let help = "for example: jurist 'K/(s*(s + 1))' --hold 1; in a model file: 'discretize' or 'delay' in the [[block]]";
            let error = Diagnostic::error(Code::Usage, message);
            return Err(in_line(
                context.line,
                vec![error.at(context.line.option_value(option, value).span, "").help(help)],
            )
            .into());
        }
    }
    Ok(())
}

/// The text of an argument that is a loop in one line. An existing file wins; any operator, parenthesis or equals sign makes a
/// line, but for what is written like a path.
pub(super) fn loop_line(argument: &OsStr) -> Option<&str> {
    /// Operators, and what is written for them by mistake.
    const OPERATORS: [char; 14] = [
        '+', '*', '^', '(', ')', '=', '\u{2212}', '\u{2013}', '\u{2014}', '\u{b7}', '\u{d7}', '\u{f7}', '\u{b2}',
        '\u{b3}',
    ];
    let text = argument.to_str()?;
    let is_path = text.to_lowercase().ends_with(".toml")
        || text.starts_with(['/', '~'])
        || text.starts_with("./")
        || text.starts_with("../");
    if is_path || text.contains('\\') || text == "-" || Path::new(text).exists() {
        return None;
    }
    // A file's name may contain these two.
    let is_variable =
        |part: &str| ["s", "z"].contains(&part.trim().trim_start_matches(|c: char| c.is_ascii_digit() || c == '.'));
    let is_difference = || text.contains(['-', '/']) && text.split(['-', '/']).any(is_variable);
    (text.contains(OPERATORS) || is_difference()).then_some(text)
}

/// The name and the bytes of a model file, or of the built-in drive.
fn read_file(model: Option<&OsString>, context: &Context) -> Result<(String, Vec<u8>), Error> {
    let held = |model: Model| Ok((model.source().name.clone(), model.source().text.clone().into_bytes()));
    let Some(path) = model else { return held(Model::drive()) };
    if path == "-"
        && let Some(model) = captured::model()
    {
        return held(model);
    }
    read_bytes(path, &MODEL, context)
}

/// The name and the bytes of a file, or of standard input for `-`.
pub(super) fn read_bytes(path: &OsString, wanted: &Wanted, context: &Context) -> Result<(String, Vec<u8>), Error> {
    let (name, bytes) = if path == "-" {
        ("<stdin>".to_owned(), read_all(std::io::stdin().lock()))
    } else {
        (path.to_string_lossy().into_owned(), File::open(path).and_then(read_all))
    };
    let bytes = bytes.map_err(|e| unreadable(context, path, &name, &e, wanted))?;
    if bytes.len() as u64 > MAX_MODEL_BYTES {
        let message = format!("{name} is longer than {} megabytes", MAX_MODEL_BYTES >> 20);
        return Err(Diagnostic::error(Code::Read, message).into());
    }
    Ok((name, bytes))
}

fn read_all(from: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(MAX_MODEL_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A file that a command reads: what to say where it cannot be read.
pub(super) struct Wanted {
    pub noun: &'static str,
    pub help: &'static str,
}

/// The model of a command that has the built-in drive to fall back on.
const MODEL: Wanted = Wanted {
    noun: "model",
    help: "MODEL is a TOML file, '-' for standard input, or a loop in one line such as 'K/(s*(s + 1))'; left out, it is the built-in drive",
};

/// The model that a certificate is about.
const CERTIFIED_MODEL: Wanted = Wanted {
    noun: "model",
    help: "MODEL is what the certificate is about: a TOML file, '-' for standard input, or a loop in one line",
};

/// The certificate itself.
pub(super) const CERTIFICATE: Wanted = Wanted {
    noun: "certificate",
    help: "CERTIFICATE is a file that '--certificate FILE' of 'jurist intervals', 'verdict', 'tolerance' or 'map' wrote, '-' for standard input",
};

fn unreadable(context: &Context, path: &OsString, name: &str, error: &std::io::Error, wanted: &Wanted) -> Error {
    let shown = if name.is_empty() { "''" } else { name };
    let diagnostic = Diagnostic::error(Code::Read, format!("cannot read {shown}: {}", plain(error)));
    let diagnostic = match context.line.argument(&path.to_string_lossy()) {
        Some(span) => diagnostic.at(span, format!("no {} can be read from here", wanted.noun)),
        None => diagnostic,
    };
    in_line(context.line, vec![diagnostic.help(wanted.help)]).into()
}

/// The model and the question of a command that decides; a wrong file ending is refused before any work.
pub(super) fn decision(options: &DecisionOptions, context: &Context) -> Result<(Model, Question), Error> {
    context.check_output(&options.output)?;
    let model = load(options.model.model.as_ref(), &options.model.line, context)?;
    let question = question(context, &model, &options.model, &options.region)?;
    Ok((model, question))
}

/// A question with the values, domains and regions on the command line, all of whose names the model knows.
pub(super) fn question(
    context: &Context,
    model: &Model,
    options: &ModelOptions,
    region: &RegionOptions,
) -> Result<Question, Error> {
    let mut question = model.ask();
    let mut wrong = Vec::new();
    for assignment in assignments(context.line, "--set", &options.set)? {
        check_name(model, &assignment.name, assignment.name_span, &mut wrong)?;
        question = question.set(assignment.name, assignment.value);
    }
    for change in domains(context.line, &options.domain)? {
        if change.name != RADIUS && change.name != DECAY {
            check_name(model, &change.name, change.name_span, &mut wrong)?;
        }
        question = question.domain(change.name, Range::between(change.lower, change.upper));
    }
    if !wrong.is_empty() {
        return Err(in_line(context.line, wrong).into());
    }
    let number = |option: &str, text: &Option<String>| {
        text.as_ref().map(|text| plain_number(context.line, option, text)).transpose()
    };
    if let Some(radius) = number("--radius", &region.radius)? {
        question = question.within(Region::disc(radius)?);
    }
    if let Some(decay) = number("--decay", &region.decay)? {
        question = question.within(Region::half_plane(decay));
    }
    Ok(question)
}

/// The parameter that is asked about where the command line names none: the model's only one, or the only one without a value.
pub(super) fn only_parameter(model: &Model, options: &ModelOptions) -> Result<String, Error> {
    if let [only] = model.parameters() {
        return Ok(only.name.clone());
    }
    let is_set = |name: &str| options.set.iter().any(|set| set.split_once('=').is_some_and(|(n, _)| n.trim() == name));
    let mut open = model.parameters().iter().filter(|p| p.nominal.is_none() && !is_set(&p.name));
    if let (Some(only), None) = (open.next(), open.next()) {
        return Ok(only.name.clone());
    }
    let names: Vec<String> = model.parameters().iter().map(|p| format!("'--param {}'", visible(&p.name))).collect();
    let help = match names.is_empty() {
        true => "name a constant that is given as a number: '--param NAME'".to_owned(),
        false => format!(
            "the question is about one of them: {}; the others keep their nominal values, or have those of '--set NAME=VALUE'",
            names.join(", ")
        ),
    };
    let message = format!("the model has {} parameters, so one has to be named", names.len());
    Err(Diagnostic::error(Code::Usage, message).help(help).into())
}

/// Refuses names that cannot vary; the caret points into the command line.
pub(super) fn known_names(context: &Context, model: &Model, option: &str, names: &[String]) -> Result<(), Error> {
    let mut wrong = Vec::new();
    for name in names {
        check_name(model, name, context.line.option_value(option, name).span, &mut wrong)?;
    }
    if wrong.is_empty() { Ok(()) } else { Err(in_line(context.line, wrong).into()) }
}

/// Refuses a name that cannot vary; the caret points at its place in the command line.
pub(super) fn known_name(context: &Context, model: &Model, name: &str, span: Span) -> Result<(), Error> {
    let mut wrong = Vec::new();
    check_name(model, name, span, &mut wrong)?;
    if wrong.is_empty() { Ok(()) } else { Err(in_line(context.line, wrong).into()) }
}

/// An unknown name is added to what is wrong with the command line; a name that the model fixes is an
/// error about the model.
fn check_name(model: &Model, name: &str, span: Span, wrong: &mut Vec<Diagnostic>) -> Result<(), Diagnostics> {
    let Err(error) = model.free(name) else { return Ok(()) };
    match error.diagnostics() {
        [diagnostic] if diagnostic.primary.is_none() => {
            wrong.push(diagnostic.clone().at(span, "not in the model"));
            Ok(())
        }
        _ => Err(error),
    }
}

/// The text of a model that a certificate is about: of a file, or of the model that a loop in one line means.
pub(super) fn model_text(
    model: &OsString,
    line: &ReadingOptions,
    context: &Context,
    most: u64,
) -> Result<Result<String, String>, Error> {
    if loop_line(model).is_none() {
        refuse_line_options(line, context)?;
        return read_text(context, model, most, &CERTIFIED_MODEL);
    }
    let (model, _) = read_model(Some(model), line, context)?.read?;
    Ok(Ok(model.source().text.clone()))
}

/// A text file, or standard input for `-`. The inner error says why its content is not a text.
pub(super) fn read_text(
    context: &Context,
    path: &OsString,
    most: u64,
    wanted: &Wanted,
) -> Result<Result<String, String>, Error> {
    let name = path.to_string_lossy().into_owned();
    let mut bytes = Vec::new();
    let read = if path == "-" {
        std::io::stdin().lock().take(most + 1).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes))
    };
    read.map_err(|e| unreadable(context, path, &name, &e, wanted))?;
    if bytes.len() as u64 > most {
        return Ok(Err(format!("{name} is longer than {most} bytes")));
    }
    Ok(String::from_utf8(bytes).map_err(|_| format!("{name} is not UTF-8")))
}
