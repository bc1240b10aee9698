//! `jurist ship`: the controller as it is stored and run.

use super::{Context, Runs, decided};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::{assignments, in_line};
use crate::cli::destinations::Files;
use crate::cli::import::{DsOptions, Words, read_c};
use crate::cli::input::{Wanted, known_names, load, question, read_bytes};
use crate::cli::output::{ending, note, write_answer};
use crate::cli::picture::{Kind, Picture, deliver};
use crate::cli::requirements::RequirementOptions;
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::{certified, check_certificate};
use clap::Args;
use jurist_algebra::limits::{Budget, Exhausted, apart};
use jurist_algebra::number::Rational;
use jurist_check::sha256;
use jurist_draw::figures::ranges_figure;
use jurist_engine::answer::PointVerdict;
use jurist_engine::error::{Code, Diagnostic, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Problem;
use jurist_prove::Certificate;
use jurist_ship::answer::{Beside, Holds, ShipAnswer};
use jurist_ship::asked::{Asked, Overrides};
use jurist_ship::emit::Target;
use jurist_ship::ranges::WorstInput;
use jurist_show::documents;
use jurist_show::layout::short;
use jurist_show::verdict::verdict_line;
use jurist_show::{Text, margin_sentences};
use std::ffi::OsString;
use std::slice::from_ref;

/// Digits of numbers in the comments of code.
const REMARK_DIGITS: usize = 6;

/// Options of `jurist ship`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
    /// The block that is the controller [default: that of [ship]]
    #[arg(long, value_name = "NAME")]
    pub block: Option<String>,
    /// The order of operations: df1, df2, df2t, sos, parallel, delta or state
    #[arg(long, value_name = "NAME")]
    pub realisation: Option<String>,
    /// How coefficients are stored: Q2.13 (sign, 2 bits before and 13 behind the point), float32 or float64
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<String>,
    /// How signals are stored: Q5.10
    #[arg(long, value_name = "FORMAT")]
    pub signal: Option<String>,
    /// How coefficients are rounded: nearest, even, half-up, floor, ceil or zero
    #[arg(long, value_name = "MODE")]
    pub round: Option<String>,
    /// The greatest magnitude of an input, for ranges of signals [repeatable]
    #[arg(long, value_name = "NAME=BOUND")]
    pub input: Vec<String>,
    /// Also says how many bits behind the point are enough
    #[arg(long)]
    pub fewest: bool,
    /// Also gives the limits of this parameter with more and more bits; with -o FILE.svg, .png or .pdf as a picture
    #[arg(long, value_name = "NAME")]
    pub param: Option<String>,
    /// A loop of DSVerifier, a file in C, in the place of MODEL
    #[arg(long, value_name = "FILE.c", conflicts_with = "model")]
    pub from: Option<OsString>,
    #[command(flatten)]
    pub of_c: DsOptions,
    #[command(flatten)]
    pub written: Box<Written>,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Files that are written beside the answer.
#[derive(Args, Debug)]
pub(in crate::cli) struct Written {
    /// Writes the model with the stored coefficients: a model for every other command
    #[arg(long, value_name = "FILE")]
    pub rounded: Option<OsString>,
    /// Writes the model in which each coefficient has the tolerance of its rounding, for 'jurist tolerance'
    #[arg(long, value_name = "FILE")]
    pub every: Option<OsString>,
    /// Writes the model in which the controller's inner signals are outputs, and the errors of their rounding inputs
    #[arg(long, value_name = "FILE")]
    pub signals: Option<OsString>,
    /// Writes the inputs that bring the most critical inner signal near to its greatest value, for 'jurist simulate --inputs' with the model of --signals
    #[arg(long, value_name = "FILE.csv")]
    pub worst: Option<OsString>,
    /// Writes the controller as code in C99: one header
    #[arg(long, value_name = "FILE")]
    pub c: Option<OsString>,
    /// Writes the controller as a function block in structured text (IEC 61131-3)
    #[arg(long, value_name = "FILE")]
    pub st: Option<OsString>,
    /// Writes the controller as a module in Rust (no_std)
    #[arg(long, value_name = "FILE")]
    pub rust: Option<OsString>,
    /// Writes a certificate that 'jurist verify' re-checks: the verdict on the model of --rounded
    #[arg(long, value_name = "FILE", requires = "rounded")]
    pub certificate: Option<OsString>,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.output;
        let picture = picture(self)?;
        if picture.is_none() {
            context.check_output(output)?;
        }
        let model = model(self, context)?;
        if let Some(name) = &self.param {
            known_names(context, &model, "--param", from_ref(name))?;
        }
        let question = question(context, &model, &self.model, &self.region)?;
        let (asked, question) = self.require.asked(&model, question, &self.region, context)?;
        let shipping = Asked::of(&model, &overrides(self, context, model.inputs())?)?;
        let domain_of = |name: &String| question.domains_set().get(name).cloned();
        let limits_of = self.param.as_ref().map(|name| (name.clone(), domain_of(name)));
        let problem = question.problem()?;
        let beside = Beside { fewest: self.fewest, limits_of, worst_input: self.written.worst.is_some() };
        let answer = match decided(ShipAnswer::of(&problem, shipping, &asked, &beside, &context.budget))? {
            Ok(answer) => answer,
            Err(stopped) => return context.undecided(output, &stopped, || None, || no_answer(&problem, &stopped)),
        };
        context.warn(None, problem.warnings());
        let rounded = answer.shipped.rounded_text();
        if let Some(file) = &self.written.rounded {
            write_answer(rounded, Some(file))?;
        }
        if let Some(file) = &self.written.every {
            // It is written also where the work of a part has ended.
            write_answer(&apart(|| answer.shipped.every_text()).0, Some(file))?;
        }
        if !self.model.set.is_empty()
            && !context.quiet
            && (self.written.rounded.is_some() || self.written.every.is_some())
        {
            note(
                "note: the models that are written have the file's own values beside the controller: give --set again with them",
            );
        }
        signals(&answer, self, context)?;
        let digits = output.digits() as usize;
        if let Some(stopped) = answer.stopped() {
            return context.undecided(output, stopped, || Some(answer.text(digits)), || answer.json(digits));
        }
        match picture {
            Some(kind) => draw(&answer, kind, output)?,
            None => context.answer(output, || answer.text(digits), || answer.json(digits))?,
        }
        let proof =
            certified(context, &self.written.certificate, || answer.rounded.verdict.certificate(&context.budget))?;
        if let Some((text, file)) = &proof {
            write_answer(text, Some(file))?;
            check_certificate(context, &output.run, rounded, text, file);
        }
        code(&answer, self, proof.as_ref().map(|(text, _)| text.as_str()))?;
        Ok(match answer.holds() {
            Holds::Yes => Status::Holds,
            Holds::No => Status::DoesNotHold,
            Holds::Open => Status::Undecided,
        })
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output.output);
        files.inputs.extend(self.from.iter().map(|file| ("the loop", file.as_os_str())));
        files.outputs.extend(self.written.rounded.iter().map(|file| ("the rounded model", file.clone())));
        files.outputs.extend(self.written.every.iter().map(|file| ("the model of every rounding", file.clone())));
        let code = [
            ("the code in C", &self.written.c),
            ("the code in structured text", &self.written.st),
            ("the code in Rust", &self.written.rust),
        ];
        files.outputs.extend(code.into_iter().filter_map(|(what, file)| Some((what, file.clone()?))));
        files.outputs.extend(self.written.certificate.iter().map(|file| ("the certificate", file.clone())));
        Ok(())
    }
}

/// What is said where the file of `--from` cannot be read.
const LOOP: Wanted = Wanted { noun: "loop", help: "--from takes a .c file of DSVerifier, or '-' for standard input" };

/// The model, or that of a loop of DSVerifier.
fn model(options: &Options, context: &Context) -> Result<Model, Error> {
    let Some(file) = &options.from else {
        if let Some(option) = options.of_c.given() {
            let error = Diagnostic::error(Code::Usage, format!("{option} goes with --from FILE.c, not with a model"));
            return Err(error.help("leave it out").into());
        }
        return load(options.model.model.as_ref(), &options.model.line, context);
    };
    let (name, bytes) = read_bytes(file, &LOOP, context)?;
    context.budget.step("reading the loop");
    let words = Words { round: options.round.as_deref(), realisation: options.realisation.as_deref() };
    let (read, writing) = read_c((&name, &bytes), &options.of_c, words, context)?;
    let source = Source::new(format!("the model of {name}"), read.model(&name, &writing)?);
    let (model, warnings) = Model::from_toml(&source)?;
    context.warn(Some(model.source()), &warnings);
    if !context.quiet
        && let Some(text) = read.storing_note(&writing, &context.budget)?
    {
        note(&format!("note: {text}"));
    }
    Ok(model)
}

/// The model of the inner signals, and the worst inputs, where they are asked for.
fn signals(answer: &ShipAnswer, options: &Options, context: &Context) -> Result<(), Error> {
    if options.written.signals.is_none() && options.written.worst.is_none() {
        return Ok(());
    }
    let ranges = match &answer.ranges {
        Some(Ok(ranges)) => ranges,
        Some(Err(error)) => return Err(error.clone()),
        None => {
            let error = Diagnostic::error(
                Code::ShipFormat,
                "nothing is known of the signals: they have no format and no input has a bound, or the loop is not stable",
            );
            return Err(error.help("add --signal Q5.10 or --input NAME=BOUND").into());
        }
    };
    if let Some(file) = &options.written.signals {
        write_answer(&ranges.problem.model().source().text, Some(file))?;
    }
    let Some(file) = &options.written.worst else { return Ok(()) };
    let Some(worst) = &answer.worst_input else {
        let error = Diagnostic::error(Code::ShipFormat, "no input of the loop has a bound");
        return Err(error.help("add --input NAME=BOUND").into());
    };
    write_answer(&table(worst, &answer.shipped.exact, &context.budget), Some(file))
}

/// The worst inputs as a table, a row for each sample.
fn table(worst: &WorstInput, problem: &Problem, budget: &Budget) -> String {
    let model = problem.model();
    let step = model.sample_time_expression().and_then(|time| model.value(time, problem.set(), budget).ok());
    let step = step.unwrap_or(Rational::ONE);
    let names: Vec<&str> = worst.inputs.iter().map(|(name, _)| name.as_str()).collect();
    let mut out = format!(
        "# these inputs bring {} near to its greatest value at the last sample; as an output it is called {}\nt,{}\n",
        worst.node,
        worst.output,
        names.join(",")
    );
    let samples = worst.inputs.first().map_or(0, |(_, values)| values.len());
    for k in 0..samples {
        let values: Vec<String> = worst.inputs.iter().map(|(_, values)| short(&values[k])).collect();
        out.push_str(&format!("{},{}\n", short(&(&step * &Rational::from(k as i64))), values.join(",")));
    }
    out
}

/// The controller as code in each language that is asked for.
fn code(answer: &ShipAnswer, options: &Options, certificate: Option<&str>) -> Result<(), Error> {
    let files = [
        (Target::C, &options.written.c),
        (Target::StructuredText, &options.written.st),
        (Target::Rust, &options.written.rust),
    ];
    for (target, file) in files {
        let Some(file) = file else { continue };
        let remarks = remarks(answer, certificate);
        write_answer(&answer.shipped.code(target, &remarks)?, Some(file))?;
    }
    Ok(())
}

/// What the code's comment says of the loop.
fn remarks(answer: &ShipAnswer, certificate: Option<&str>) -> Vec<String> {
    let shipped = &answer.shipped;
    let model = shipped.exact.model();
    let verdict = &answer.rounded.verdict;
    let mut out = vec![
        format!("Block '{}' of the model {}.", shipped.asked.block, model.source().name),
        format!("Coefficients: {}.", shipped.asked.format.words()),
        format!("The loop with these coefficients is {}.", verdict_line(verdict.problem(), verdict.value())),
    ];
    if let Ok(margins) = &answer.rounded.margins {
        out.extend(margin_sentences(margins, REMARK_DIGITS).into_iter().map(|(name, said)| format!("{name}: {said}.")));
    }
    out.extend(answer.rounded.requirements.iter().map(|found| format!("{}.", found.text(REMARK_DIGITS))));
    out.extend(answer.bounds());
    out.push(format!("SHA-256 of the model with these coefficients: {}", sha256(shipped.rounded_text())));
    out.extend(certificate.map(|text| format!("SHA-256 of the certificate of its verdict: {}", sha256(text))));
    out
}

/// What picture is asked for, by the ending of the output's name.
fn picture(options: &Options) -> Result<Option<Kind>, Error> {
    let file = options.output.output.as_ref();
    let kind = match file.and_then(|file| ending(file)).as_deref() {
        Some("svg") => Kind::Svg,
        Some("png") => Kind::Png,
        Some("pdf") => Kind::Pdf,
        _ => return Ok(None),
    };
    if options.param.is_none() {
        let error = Diagnostic::error(Code::Usage, "a picture shows how the limits of a parameter move with the bits");
        return Err(error.help("add --param NAME").into());
    }
    Ok(Some(kind))
}

/// The limits by bits as a picture.
fn draw(answer: &ShipAnswer, kind: Kind, output: &OutputOptions) -> Result<(), Error> {
    let limits = match &answer.limits {
        Some(Ok(limits)) => limits,
        Some(Err(error)) => return Err(error.clone()),
        None => return Ok(()),
    };
    let rows: Vec<_> = limits.rows.iter().filter_map(|(bits, set)| Some(((*bits)?, set.value()))).collect();
    let what = format!("Stable {} by the bits of '{}'", limits.parameter, answer.shipped.asked.block);
    let figure = ranges_figure(&what, "bits behind the point", &limits.exact, &rows);
    let nothing = String::new;
    let picture = Picture { figure: &figure, csv: &nothing, json: &nothing, csv_beside: false };
    deliver(&picture, kind, output.output.as_ref())
}

/// The document where even the verdicts are not decided.
fn no_answer(problem: &Problem, stopped: &Exhausted) -> documents::Verdict {
    documents::Verdict::new(problem, Err::<&PointVerdict, _>(stopped))
}

/// What options say in the place of `[ship]`.
fn overrides(options: &Options, context: &Context, inputs: &[jurist_engine::model::Name]) -> Result<Overrides, Error> {
    let mut bounds = Vec::new();
    for (given, text) in assignments(context.line, "--input", &options.input)?.into_iter().zip(&options.input) {
        let place = || context.line.option_value("--input", text).span;
        if inputs.iter().all(|name| name.name != given.name) {
            let error = Diagnostic::error(Code::UnknownName, format!("the loop has no input '{}'", given.name));
            return Err(in_line(context.line, vec![error.at(place(), "not known")]).into());
        }
        if given.value.is_negative() {
            let error = Diagnostic::error(Code::Value, "the bound of an input must not be negative");
            return Err(in_line(context.line, vec![error.at(place(), "negative")]).into());
        }
        bounds.push((given.name, given.value));
    }
    Ok(Overrides {
        block: options.block.clone(),
        realisation: options.realisation.clone(),
        format: options.format.clone(),
        signal: options.signal.clone(),
        round: options.round.clone(),
        inputs: bounds,
    })
}
