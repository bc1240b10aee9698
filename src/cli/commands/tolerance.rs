//! `jurist tolerance`: stable for every value within tolerances.

use super::map::ranges;
use super::{Context, Runs, decided};
use crate::certified::certify_tolerance;
use crate::cli::arguments::DecisionOptions;
use crate::cli::assignments::in_line;
use crate::cli::command_line::Place;
use crate::cli::destinations::Files;
use crate::cli::input::{known_name, known_names, load, question};
use crate::cli::output::{ending, note, write_beginning};
use crate::cli::picture::{Kind, Picture, WRITES, deliver};
use crate::cli::requirements::RequirementOptions;
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::certify;
use clap::Args;
use jurist_algebra::limits::{Exhausted, apart};
use jurist_algebra::number::{Rational, to_decimal};
use jurist_draw::figures::tolerance_figure;
use jurist_engine::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use jurist_engine::coverage::Asked;
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::{Model, Tolerance};
use jurist_engine::stability::boxes::BoxDecision;
use jurist_show::documents::{self, to_text};
use jurist_show::layout::visible;
use jurist_show::tolerance_text;
use jurist_show::{Document, Text};
use std::cell::RefCell;
use std::ffi::OsString;
use std::slice::from_ref;

/// Options of `jurist tolerance`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A tolerance: NAME=10%, NAME=-20%..+30%, NAME=0.01 or NAME=LO..HI, ends included; several with commas: R=10%,L=5%, or R,L=10%; it takes the place of the model's for that name, the model's others stay (--fix leaves one out) [repeatable]
    #[arg(long, value_name = "NAME=TOLERANCE")]
    pub tol: Vec<String>,
    /// Gives every number of the model this tolerance
    #[arg(long, value_name = "TOLERANCE", allow_hyphen_values = true)]
    pub all: Option<String>,
    /// Leaves a name without a tolerance; several with commas [repeatable]
    #[arg(long, value_name = "NAME")]
    pub fix: Vec<String>,
    /// Asks for all values of another name as well, whatever the factor of the tolerances is: both ends included; takes the place of its tolerance [repeatable]
    #[arg(long = "for-all", value_name = "NAME=LO..HI")]
    pub for_all: Vec<String>,
    /// Asks for the box alone and not for the largest factor: the fastest answer where the box is stable
    #[arg(long, conflicts_with_all = ["limit", "exact", "volume"])]
    pub only: bool,
    /// Also asks how far this parameter may go while all others have their tolerances
    #[arg(long, value_name = "NAME")]
    pub limit: Option<String>,
    /// Also proves the largest factor as an exact number, where it is one that is known; else it is between what is proved and what is refuted
    #[arg(long)]
    pub exact: bool,
    /// Also says which share of the box is stable, up to 1 % that may stay undecided (at most six parameters)
    #[arg(long)]
    pub volume: bool,
    /// Writes a certificate that 'jurist verify' re-checks: of the largest proved box and a point beyond
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    #[command(flatten)]
    pub decision: DecisionOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
}

/// Digits of the bracket of the largest factor where `--digits` is not given.
const BRACKET_DIGITS: u32 = 6;

/// No bracket is asked to be narrower.
const MOST_DIGITS: u32 = 18;

/// What is said where no number was proved.
const NO_EXACT_NUMBER: &str =
    "the factor is not proved as an exact number; it is in the bracket, which is as narrow as --digits says, up to 18";

/// The same where no point is known that bounds the factor.
const NO_END: &str = "the factor is not proved as an exact number: no point was found that bounds it";

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.decision.output;
        let picture = picture(output.output.as_ref());
        if picture.is_none() {
            context.check_output(output)?;
        }
        let model = load(self.decision.model.model.as_ref(), &self.decision.model.line, context)?;
        let question = question(context, &model, &self.decision.model, &self.decision.region)?;
        let (asked, question) = self.require.asked(&model, question, &self.decision.region, context)?;
        let request = request(self, &model, context)?.require(asked.list, asked.at);
        let digits = output.digits() as usize;
        let begun = Begun::new(self, picture, context);
        let told = |answer: &Answer<ToleranceAnswer>| begun.tell(answer, context);
        let answer = match decided(question.clone().tolerance_told(&request, &told, &context.budget))? {
            Ok(answer) => answer,
            Err(stopped) if picture.is_some() => return Ok(context.say_undecided(&stopped)),
            Err(stopped) => {
                let mut open = question;
                let ranges = request.for_all.iter().map(|all| &all.name);
                for name in request.tolerances.iter().map(|(name, _)| name).chain(ranges) {
                    open = open.without_value(name).free(name);
                }
                let problem = apart(|| open.problem())?;
                let text = || Some(begun.rest_of(tolerance_text(&problem, Err(&stopped), digits)));
                return context
                    .undecided(output, &stopped, text, || documents::Tolerance::new(&problem, Err(&stopped), digits));
            }
        };
        context.warn(None, answer.problem().warnings());
        if let (Some(name), None, false) = (&self.limit, &answer.value().limit, context.quiet) {
            note(&format!(
                "note: --limit begins at a nominal point that is stable: 'jurist intervals --param {}' finds one",
                visible(name)
            ));
        }
        if let (true, Some(factor), None, false) =
            (self.exact, &answer.value().factor, &answer.value().exact, context.quiet)
        {
            let why = if factor.upper.is_some() { NO_EXACT_NUMBER } else { NO_END };
            note(&format!("note: {why}"));
        }
        let question = request
            .requirements
            .iter()
            .fold(Asked::Tolerance, |question, r| question.with_requirement(r, answer.problem().time()));
        context.explain(&self.decision.explain, output, answer.problem(), question)?;
        let status = shown(&answer, picture, &begun, self, context)?;
        let model = &answer.problem().model().source().text;
        let at = request.at.as_deref();
        certify(context, &output.run, model, &self.certificate, || {
            let certified = certify_tolerance(&answer, at, &context.budget)?;
            if let Some(factor) = certified.factor.as_ref().filter(|_| !context.quiet) {
                note(&format!("note: the certificate is of the box with the factor {}", to_decimal(factor, 9)));
            }
            Ok(certified.text)
        })?;
        Ok(status)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.decision.model.model, &self.decision.output.output);
        Ok(())
    }
}

/// The beginning of the text on standard output: a proof is printed as soon as it stands.
struct Begun {
    /// Digits of the text, where it goes to standard output.
    digits: Option<usize>,
    text: RefCell<String>,
}

impl Begun {
    fn new(options: &Options, picture: Option<Kind>, context: &Context) -> Begun {
        let output = &options.decision.output;
        let is_text = picture.is_none() && !output.json && output.output.as_ref().is_none_or(|file| file == "-");
        // Whoever captures a command reads it when it has ended.
        let digits = (is_text && !context.is_captured()).then(|| text_digits(options));
        Begun { digits, text: RefCell::default() }
    }

    fn tell(&self, answer: &Answer<ToleranceAnswer>, context: &Context) {
        let Some(digits) = self.digits else { return };
        let text = answer.text(digits);
        if context.reporter.aside(|| write_beginning(&text)) {
            *self.text.borrow_mut() = text;
        }
    }

    /// What is not printed yet: all of it where nothing is; of a text that goes on otherwise all but its heading.
    fn rest_of(&self, text: String) -> String {
        let begun = self.text.borrow();
        if begun.is_empty() {
            return text;
        }
        let rest = text.strip_prefix(begun.as_str()).or_else(|| text.split_once('\n').map(|(_, rest)| rest));
        rest.unwrap_or(&text).to_owned()
    }
}

/// Digits of the text.
fn text_digits(options: &Options) -> usize {
    options.decision.output.digits.unwrap_or(BRACKET_DIGITS + 3) as usize
}

/// The answer where it is wanted.
fn shown(
    answer: &Answer<ToleranceAnswer>,
    picture: Option<Kind>,
    begun: &Begun,
    options: &Options,
    context: &Context,
) -> Outcome {
    let (output, value) = (&options.decision.output, answer.value());
    let digits = output.digits() as usize;
    if value.domain_factor.as_ref().is_some_and(|factor| *factor <= Rational::ONE) {
        let warning = Diagnostic::warning(
            Code::OutsideDomainWarning,
            "the box of tolerances reaches the end of a parameter's domain",
        );
        context.warn(None, &[warning]);
    }
    if let Some(kind) = picture.filter(|_| WRITES) {
        let figure = tolerance_figure(answer, &context.budget)?;
        context.reporter.finish();
        let table = || shares_table(answer);
        let document = || to_text(&answer.json(digits));
        let out = Picture { figure: &figure, csv: &table, json: &document, csv_beside: false };
        deliver(&out, kind, output.output.as_ref())?;
        return Ok(match &value.decision {
            BoxDecision::Stable(_) => Status::Holds,
            BoxDecision::Undecided { .. } => Status::Undecided,
            _ => Status::DoesNotHold,
        });
    }
    let text = || begun.rest_of(answer.text(text_digits(options)));
    match &value.decision {
        BoxDecision::Undecided { why, .. } => {
            let stopped = Exhausted::by_method(why.to_string(), "proving the box");
            context.undecided(output, &stopped, || Some(text()), || answer.json(digits))
        }
        decision => {
            context.answer(output, text, || answer.json(digits))?;
            Ok(if decision.is_stable() { Status::Holds } else { Status::DoesNotHold })
        }
    }
}

/// What picture a file is, by its ending.
fn picture(file: Option<&OsString>) -> Option<Kind> {
    match ending(file?).as_deref() {
        Some("svg") => Some(Kind::Svg),
        Some("png") => Some(Kind::Png),
        Some("pdf") => Some(Kind::Pdf),
        _ => None,
    }
}

/// The shares, one a line.
fn shares_table(answer: &Answer<ToleranceAnswer>) -> String {
    let shares = answer.value().shares().unwrap_or_default();
    let lines = shares.iter().map(|(i, share)| {
        let name = &answer.problem().free()[*i].name;
        format!("{name},{}\n", to_decimal(share, 12))
    });
    std::iter::once("name,share\n".to_owned()).chain(lines).collect()
}

/// The tolerances of the model, of `--all` and of `--tol`, the later ones instead of the earlier.
fn request(options: &Options, model: &Model, context: &Context) -> Result<ToleranceRequest, Error> {
    let mut request = ToleranceRequest::of_model(model);
    let mut asked: Vec<&str> = options.limit.iter().map(String::as_str).collect();
    let mut put = |name: &str, tolerance: &Tolerance| {
        request.tolerances.retain(|(known, _)| known != name);
        request.tolerances.push((name.to_owned(), tolerance.clone()));
    };
    if let Some(text) = &options.all {
        let tolerance = read(text, "--all", text, 0, context)?;
        let constants = model.constants().iter().filter(|c| c.number.is_some()).map(|c| &c.name);
        for name in constants.chain(model.parameters().iter().map(|p| &p.name)) {
            put(name, &tolerance);
        }
    }
    for text in &options.tol {
        let place = context.line.option_value("--tol", text);
        for (at, names, value) in groups(text, place, context)? {
            let tolerance = read(text, "--tol", value, at + names.len() + 1, context)?;
            let mut start = at;
            for name in names.split(',') {
                let trimmed = name.trim();
                known_name(context, model, trimmed, place.part(start, start + name.len()))?;
                put(trimmed, &tolerance);
                asked.push(trimmed);
                start += name.len() + 1;
            }
        }
    }
    for text in &options.fix {
        let place = context.line.option_value("--fix", text);
        let mut start = 0;
        for name in text.split(',') {
            known_name(context, model, name.trim(), place.part(start, start + name.len()))?;
            request.tolerances.retain(|(known, _)| known != name.trim());
            start += name.len() + 1;
        }
    }
    request = request.for_all(ranges(&options.for_all, &asked, model, context)?);
    if let Some(name) = &options.limit {
        known_names(context, model, "--limit", from_ref(name))?;
        request.tolerances.retain(|(known, _)| known != name);
        request = request.limit(name);
    }
    if options.volume {
        request = request.volume(Rational::new(1.into(), 100.into()));
    }
    if options.exact {
        request = request.exact();
    }
    if options.only {
        request = request.box_alone();
    }
    let digits = options.decision.output.digits.unwrap_or(BRACKET_DIGITS).min(MOST_DIGITS);
    Ok(request.gap(Rational::from(10).pow(-i64::from(digits)).expect("ten is not zero")))
}

/// The parts of `R,L=10%,C=5%`: where each begins, its names, and their tolerance.
fn groups<'t>(text: &'t str, place: Place, context: &Context) -> Result<Vec<(usize, &'t str, &'t str)>, Error> {
    let mut groups = Vec::new();
    let mut start = 0;
    loop {
        let Some((names, rest)) = text[start..].split_once('=') else {
            let error = Diagnostic::error(Code::OptionValue, "--tol expects NAME=TOLERANCE")
                .at(place.part(start, text.len()), "there is no '='")
                .help("for example --tol R=10%, --tol R,L=-20%..+30% or --tol R=10%,L=5%");
            return Err(in_line(context.line, vec![error]).into());
        };
        // A tolerance ends at the comma after it, and names follow.
        let value = rest.split(',').next().unwrap_or_default();
        groups.push((start, names, value));
        start += names.len() + 1 + value.len();
        if start == text.len() {
            return Ok(groups);
        }
        // The comma.
        start += 1;
    }
}

/// A tolerance that begins at `start` of an option's value.
fn read(text: &str, option: &str, value: &str, start: usize, context: &Context) -> Result<Tolerance, Error> {
    value.parse().map_err(|why: String| {
        let place = context.line.option_value(option, text);
        let error = Diagnostic::error(Code::Tolerance, format!("this is no tolerance: {why}"))
            .at(place.part(start, start + value.len()), "not accepted")
            .help("tolerances look like 10%, -20%..+30%, 0.01 or 0.4..0.7");
        in_line(context.line, vec![error]).into()
    })
}
