//! The command line as a text that errors point into.

use super::arguments::Arguments;
use super::input::loop_line;
use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source, Span};
use jurist_engine::model::LoopLine;
use std::ffi::OsString;
use std::sync::Arc;

/// The arguments, and one line of text that shows them as a shell would take them.
#[derive(Debug)]
pub(super) struct CommandLine {
    arguments: Vec<OsString>,
    shown: Vec<Shown>,
    source: Arc<Source>,
}

/// Where an argument stands in the text.
#[derive(Debug)]
struct Shown {
    value: String,
    /// Where the value begins and ends, quotes excluded.
    span: Span,
    /// Whether the value stands there byte by byte.
    verbatim: bool,
}

/// Longer arguments are cut in the text.
const SHOWN_BYTES: usize = 4096;

impl CommandLine {
    /// Of a list of arguments, the program's name first.
    pub fn new(arguments: impl IntoIterator<Item = OsString>) -> Self {
        let arguments: Vec<OsString> = arguments.into_iter().collect();
        let mut text = String::from("jurist");
        let mut shown = Vec::new();
        for argument in arguments.iter().skip(1) {
            text.push(' ');
            let value = argument.to_string_lossy().into_owned();
            let mut end = value.len().min(SHOWN_BYTES);
            while !value.is_char_boundary(end) {
                end -= 1;
            }
            let printed = &value[..end];
            let plain = |c: char| c.is_alphanumeric() || "-_=./:,+@%^".contains(c);
            let quoted = printed.is_empty() || !printed.chars().all(plain);
            let readable = !printed.contains(['\'', '\n', '\r', '\t']);
            if quoted {
                text.push('\'');
            }
            let start = text.len();
            if readable {
                text.push_str(printed);
            } else {
                text.extend(printed.chars().map(|c| if c.is_control() { ' ' } else { c }));
            }
            // The replacements above keep the length: ' ' stands for one-byte controls only.
            let span = Span::new(start, text.len());
            if quoted {
                text.push('\'');
            }
            let verbatim = span.end - span.start == printed.len();
            shown.push(Shown { value, span, verbatim });
        }
        CommandLine { arguments, shown, source: Source::new("<command line>", text) }
    }

    /// The arguments, the program's name first, with a command where there is only a model: 'analyze' before a file, as in
    /// `jurist loop.toml`, and before a loop in one line 'intervals', or 'verdict' where all its names have values.
    pub fn arguments(&self) -> Vec<OsString> {
        let mut arguments = self.arguments.clone();
        if arguments.get(1).is_some_and(|first| first == "help") && arguments.len() <= 3 {
            // As other programs take it: 'jurist help verdict' is 'jurist verdict --help'.
            arguments.remove(1);
            arguments.push("--help".into());
            return arguments;
        }
        let is_command = |a: &OsString| Arguments::command().get_subcommands().any(|c| a == c.get_name());
        // An argument that begins with a minus is an option, but for one after '--'.
        let first = match arguments.get(1) {
            Some(mark) if mark == "--" => arguments.get(2),
            first => first.filter(|first| !first.to_string_lossy().starts_with('-') || *first == "-"),
        };
        let Some(first) = first.filter(|first| !is_command(first)) else { return arguments };
        if let Some(line) = loop_line(first) {
            let command = if self.is_point(line) { "verdict" } else { "intervals" };
            arguments.insert(1, command.into());
        } else if is_model_file(first) {
            arguments.insert(1, "analyze".into());
        }
        arguments
    }

    /// True if the options give every name of a loop in one line a value.
    fn is_point(&self, line: &str) -> bool {
        let [hold, delay] = ["--hold", "--delay"].map(|option| self.values(option).next());
        let set: Vec<&str> = self.values("--set").filter_map(|set| Some(set.split_once('=')?.0.trim())).collect();
        let line = LoopLine::read(line, hold, delay);
        self.values("--param").next().is_none() && line.is_ok_and(|l| l.names().iter().all(|name| set.contains(name)))
    }

    /// The values of a long option.
    fn values<'a>(&'a self, option: &'a str) -> impl Iterator<Item = &'a str> {
        let next = self.shown.iter().skip(1).map(Some).chain([None]);
        self.shown.iter().zip(next).filter_map(move |(shown, next)| match shown.value.strip_prefix(option)? {
            "" => next.map(|next| next.value.as_str()),
            attached => attached.strip_prefix('='),
        })
    }

    /// The text that spans refer to.
    pub fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// Where the value of an option stands: `--name value`, `--name=value`, `-nvalue`, ...
    pub fn option_value(&self, option: &str, value: &str) -> Place {
        for (i, shown) in self.shown.iter().enumerate() {
            if shown.value == value && i > 0 && self.shown[i - 1].value == option {
                return shown.part(0, value.len());
            }
            let attached = shown.value.strip_prefix(option).map(|rest| rest.strip_prefix('=').unwrap_or(rest));
            if attached == Some(value) && !value.is_empty() {
                return shown.part(shown.value.len() - value.len(), shown.value.len());
            }
        }
        Place { span: Span::new(0, self.source.text.len()), verbatim: false }
    }

    /// Where an argument stands, whatever it means.
    pub fn argument(&self, value: &str) -> Option<Span> {
        self.shown.iter().find(|s| s.value == value).map(|s| s.span)
    }

    /// clap's remark on the arguments as a diagnostic of this program.
    pub fn usage_error(&self, error: &clap::Error) -> Diagnostics {
        let rendered = error.render().to_string();
        let mut paragraphs = rendered.split("\n\n").map(str::trim_end);
        let message = paragraphs.next().unwrap_or("the command line is not understood");
        let message = message.strip_prefix("error: ").unwrap_or(message);
        let mut help = Vec::new();
        for paragraph in paragraphs {
            for line in paragraph.lines() {
                let line = line.trim();
                if let Some(tip) = line.strip_prefix("tip: ") {
                    help.push(tip.to_owned());
                } else if let Some(usage) = line.strip_prefix("Usage: ") {
                    help.push(format!("usage: {usage}"));
                } else if line.starts_with("[possible values") {
                    help.push(line.trim_matches(['[', ']']).to_owned());
                }
            }
        }
        if help.is_empty() || error.kind() == ErrorKind::MissingRequiredArgument {
            help.push("'jurist --help' lists the commands, 'jurist COMMAND --help' its options".to_owned());
        }
        let mut lines = message.lines();
        let mut message = lines.next().unwrap_or_default().trim_end_matches(':').to_owned();
        for line in lines {
            let line = line.trim();
            if let Some(values) = line.strip_prefix("[possible values: ").and_then(|l| l.strip_suffix(']')) {
                help.insert(0, format!("possible values: {values}"));
            } else if error.kind() == ErrorKind::MissingRequiredArgument {
                message.push_str(if message.ends_with("provided") { ": " } else { ", " });
                message.push_str(line);
            } else if !line.is_empty() {
                message.push(' ');
                message.push_str(line);
            }
        }
        if let Some(line) = self.negative_line(error) {
            let shown = &self.source.text[line.start..line.end];
            let message = format!("'{shown}' begins with a minus, so it is read as options");
            let help = "a loop that begins with a minus stands behind all options, after '--': \"jurist intervals -- '-K/(s + 1)'\"";
            let diagnostic = Diagnostic::error(Code::Usage, message).help(help).at(line, "");
            return Diagnostics::new(Some(Arc::clone(&self.source)), vec![diagnostic]);
        }
        let written = self.command_meant(error).or_else(|| self.negative_value(error));
        if let Some(written) = written.or_else(|| self.word_alone(error)) {
            help = vec![written];
        }
        let mut diagnostic = Diagnostic::error(Code::Usage, message).help(help.join("; "));
        if let Some(span) = self.place_of(error) {
            diagnostic = diagnostic.at(span, "");
        }
        Diagnostics::new(Some(Arc::clone(&self.source)), vec![diagnostic])
    }

    /// The place of a loop in one line that was taken for options, as it begins with a minus.
    fn negative_line(&self, error: &clap::Error) -> Option<Span> {
        let (ErrorKind::UnknownArgument, Some(ContextValue::String(option))) =
            (error.kind(), error.get(ContextKind::InvalidArg))
        else {
            return None;
        };
        let is_meant = |value: &str| {
            value.starts_with('-')
                && value.starts_with(option)
                && !value.starts_with("--")
                && LoopLine::read(value, None, None).is_ok()
        };
        let found = self.shown.iter().take_while(|shown| shown.value != "--").find(|shown| is_meant(&shown.value));
        found.filter(|shown| shown.value.contains(['/', '*', '(', '^'])).map(|shown| shown.span)
    }

    /// How the value of an option is written that was taken for an option, as it is a negative number.
    fn negative_value(&self, error: &clap::Error) -> Option<String> {
        let unknown = |(kind, value)| (kind == ContextKind::InvalidArg).then_some(value);
        let Some(ContextValue::String(taken)) = error.context().find_map(unknown) else { return None };
        let texts: Vec<_> = self.arguments.iter().map(|argument| argument.to_string_lossy()).collect();
        let is_meant = |pair: &&[std::borrow::Cow<'_, str>]| {
            let begins = pair[1]
                .strip_prefix('-')
                .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || c == '.'));
            pair[0].starts_with("--") && pair[0].len() > 2 && begins && pair[1].starts_with(taken.as_str())
        };
        let pair = texts.windows(2).find(is_meant)?;
        Some(format!("a value that begins with a minus stands behind '=': '{}={}'", pair[0], pair[1]))
    }

    /// The option that a name, or a name with a value, was meant for that stands alone behind the model.
    fn word_alone(&self, error: &clap::Error) -> Option<String> {
        let (ErrorKind::UnknownArgument, Some(ContextValue::String(word))) =
            (error.kind(), error.get(ContextKind::InvalidArg))
        else {
            return None;
        };
        let options: &[&str] = if word.contains('=') { &["tol", "set"] } else { &["param"] };
        let definition = Arguments::command();
        let command = definition.find_subcommand(self.arguments.get(1)?)?;
        let is_known = |option: &&&str| command.get_arguments().any(|own| own.get_long() == Some(**option));
        let option = options.iter().find(is_known).filter(|_| !word.starts_with('-'))?;
        Some(format!("an option says what it is: '--{option} {word}'"))
    }

    /// Which commands take what was given without one: an option of theirs, or a model file.
    fn command_meant(&self, error: &clap::Error) -> Option<String> {
        let text = |kind| match error.get(kind) {
            Some(ContextValue::String(s)) => Some(s.as_str()),
            _ => None,
        };
        if let (ErrorKind::ArgumentConflict, Some(command), Some(option)) =
            (error.kind(), text(ContextKind::InvalidSubcommand), text(ContextKind::PriorArg))
        {
            let option = option.split(' ').next().unwrap_or(option);
            return Some(format!("options stand behind their command: 'jurist {command} {option} ...'"));
        }
        let definition = Arguments::command();
        let named = |a: &OsString| definition.get_subcommands().any(|c| a == c.get_name());
        if self.arguments.iter().skip(1).any(named) {
            return None;
        }
        if let Some(word) = text(ContextKind::InvalidSubcommand) {
            return meant(word).map(str::to_owned);
        }
        let option = text(ContextKind::InvalidArg)?.split([' ', '=']).next()?;
        let takes = |c: &&clap::Command| {
            let long = |a: &clap::Arg| a.get_long().is_some_and(|l| option.strip_prefix("--") == Some(l));
            let short = |a: &clap::Arg| a.get_short().is_some_and(|s| option.strip_prefix('-') == Some(&s.to_string()));
            c.get_arguments().any(|a| long(a) || short(a))
        };
        let commands: Vec<String> = definition
            .get_subcommands()
            .filter(takes)
            .map(|c| format!("'jurist {} {option} ...'", c.get_name()))
            .collect();
        let (last, others) = commands.split_last()?;
        Some(if others.is_empty() {
            format!("'{option}' goes with a command: {last}")
        } else {
            format!("'{option}' goes with a command: {} or {last}", others.join(", "))
        })
    }

    fn place_of(&self, error: &clap::Error) -> Option<Span> {
        let text = |kind| match error.get(kind) {
            Some(ContextValue::String(s)) => Some(s.as_str()),
            _ => None,
        };
        let value = text(ContextKind::InvalidValue).filter(|v| !v.is_empty());
        let argument = text(ContextKind::InvalidArg);
        let subcommand = text(ContextKind::InvalidSubcommand);
        if let (Some(argument), Some(value)) = (argument, value) {
            let option = argument.split([' ', '=']).next().unwrap_or(argument);
            let place = self.option_value(option, value);
            if place.verbatim {
                return Some(place.span);
            }
        }
        value.or(subcommand).or(argument).and_then(|v| {
            let option = v.split([' ', '=']).next().unwrap_or(v);
            self.argument(v).or_else(|| self.argument(option))
        })
    }
}

/// Where a value stands in the command line's text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The whole value.
    pub span: Span,
    /// Whether parts of the value have places of their own.
    pub verbatim: bool,
}

impl Place {
    /// The place of the bytes `start..end` of the value.
    pub fn part(self, start: usize, end: usize) -> Span {
        if !self.verbatim {
            return self.span;
        }
        let clip = |offset: usize| (self.span.start + offset).min(self.span.end);
        Span::new(clip(start), clip(end))
    }
}

impl Shown {
    fn part(&self, start: usize, end: usize) -> Place {
        if !self.verbatim {
            return Place { span: self.span, verbatim: false };
        }
        let clip = |offset: usize| (self.span.start + offset).min(self.span.end);
        Place { span: Span::new(clip(start), clip(end)), verbatim: true }
    }
}

/// Whether an argument can only be the name of a model file: standard input, a path, or a file in TOML.
fn is_model_file(argument: &OsString) -> bool {
    let text = argument.to_string_lossy();
    text == "-" || (!text.starts_with('-') && (text.ends_with(".toml") || text.contains(['/', '\\'])))
}

/// What does the work of a command of another program.
fn meant(word: &str) -> Option<&'static str> {
    Some(match word.to_ascii_lowercase().as_str() {
        "margin" | "allmargin" | "gain-margin" | "gm" | "pm" | "stability_margins" => {
            "all margins of a loop: 'jurist margins MODEL'"
        }
        "hinfnorm" | "norminf" | "getpeakgain" => "the peak gain: 'jurist norm MODEL INPUT OUTPUT'",
        "bodeplot" | "bode_plot" | "freqresp" => "the frequency response: 'jurist bode MODEL -o bode.svg'",
        "rlocus" | "root_locus" | "root-locus" => "the root locus: 'jurist locus MODEL --param NAME -o locus.svg'",
        "step" | "impulse" | "lsim" | "stepinfo" | "response" => {
            "a time response: 'jurist simulate MODEL -o response.svg'"
        }
        "c2d" | "zoh" | "tustin" | "discretize" => {
            "a continuous block is made discrete in the model: 'discretize = { method = ..., T = ... }' in its [[block]]"
        }
        "poles" | "pole" | "eig" | "pzmap" | "damp" => "the roots of the closed loop: 'jurist roots MODEL'",
        "hurwitz" | "routh" => "the Routh table of a continuous loop: 'jurist jury MODEL'",
        "stable" | "isstable" => "one point: 'jurist verdict MODEL'; all values: 'jurist intervals MODEL --param NAME'",
        "tf" | "transfer" | "feedback" => {
            "a closed-loop transfer function: 'jurist charpoly MODEL --transfer INPUT OUTPUT'"
        }
        "interval" | "limits" | "range" => "the stable set of one parameter: 'jurist intervals MODEL --param NAME'",
        "help" => "'jurist --help' lists the commands, 'jurist COMMAND --help' its options",
        "init" | "template" | "example" => "a model file to begin with: 'jurist new'",
        "lint" | "validate" => "every mistake of a model: 'jurist check MODEL'",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_alone_is_analysed() {
        for (arguments, analysed) in [
            (&["loop.toml"][..], true),
            (&["-", "--json"], true),
            (&["./analyze"], true),
            (&["verdict", "loop.toml"], false),
            (&["loop"], false),
            (&["--json"], false),
            (&[], false),
        ] {
            let whole = line(arguments).arguments();
            assert_eq!(whole.get(1).is_some_and(|a| a == "analyze") && whole.len() == arguments.len() + 2, analysed);
        }
    }

    #[test]
    fn help_of_a_command_is_asked_as_of_other_programs() {
        for (arguments, asked) in [
            (&["help"][..], &["jurist", "--help"][..]),
            (&["help", "verdict"], &["jurist", "verdict", "--help"]),
            (&["help", "verdict", "-q"], &["jurist", "help", "verdict", "-q"]),
        ] {
            assert_eq!(line(arguments).arguments(), asked.iter().map(OsString::from).collect::<Vec<_>>());
        }
    }

    /// `--set=K=1` has operators and is no loop.
    #[test]
    fn a_loop_in_one_line_alone_is_asked_about() {
        for (arguments, command) in [
            (&["K/(s + 1)"][..], Some("intervals")),
            (&["K/(s + 1)", "--set", "K=1"], Some("verdict")),
            (&["K/(s + 1)", "--set=K=1", "--hold", "T"], Some("intervals")),
            (&["K/(s + 1)", "--set=K=1", "--hold=T", "--set", "T = 1"], Some("verdict")),
            (&["1/(s + 1)"], Some("verdict")),
            (&["1/(s + 1)", "--param", "K"], Some("intervals")),
            (&["--", "-K/(s + 1)"], Some("intervals")),
            (&["-K/(s + 1)"], None),
            (&["--set=K=1"], None),
            (&["-s"], None),
            (&["--"], None),
        ] {
            let whole = line(arguments).arguments();
            let inserted = (whole.len() > arguments.len() + 1).then(|| whole[1].to_str().unwrap());
            assert_eq!(inserted, command, "{arguments:?}");
        }
    }

    #[test]
    fn no_command_of_other_programs_is_one_of_ours() {
        for command in Arguments::command().get_subcommands() {
            assert_eq!(meant(command.get_name()), None, "{}", command.get_name());
        }
    }

    fn line(arguments: &[&str]) -> CommandLine {
        CommandLine::new(std::iter::once("jurist").chain(arguments.iter().copied()).map(OsString::from))
    }

    fn text_at(line: &CommandLine, span: Span) -> &str {
        &line.source().text[span.start..span.end]
    }

    #[test]
    fn values_are_found_in_every_notation() {
        for arguments in [&["--set", "K=1 "][..], &["--set=K=1 "], &["-sK=1 "], &["x", "-s", "K=1 "]] {
            let line = line(arguments);
            let option = if arguments.concat().contains("--set") { "--set" } else { "-s" };
            let place = line.option_value(option, "K=1 ");
            assert!(place.verbatim);
            assert_eq!(text_at(&line, place.span), "K=1 ");
            assert_eq!(text_at(&line, place.part(2, 3)), "1");
        }
    }

    #[test]
    fn strange_arguments_are_shown_on_one_line() {
        let long = "x".repeat(100_000);
        let line = line(&["a\nb'c", "", &long, "é\u{9f}"]);
        assert_eq!(line.source().text.lines().count(), 1);
        assert!(line.source().text.len() < 10_000);
        assert_eq!(line.argument(""), Some(Span::new(16, 16)));
    }
}
