//! `jurist explain`: what an error code or a word of the answers means.

use super::{Context, Runs};
use crate::cli::output::write_answer;
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::error::{Code, Diagnostic, codes};
use jurist_show::words;

/// Options of `jurist explain`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The code in the brackets of an error, such as E-unknown-name, or a word such as 'phase margin'; left out: a list of all
    #[arg(value_name = "CODE")]
    pub code: Vec<String>,
}

impl Runs for Options {
    fn run(&self, _: &Context) -> Outcome {
        run(self)
    }
}

/// Prints the explanation of one code or word, or the list of all.
fn run(options: &Options) -> Outcome {
    if options.code.is_empty() {
        let width = codes().map(|(code, _)| code.as_str().len()).max().unwrap_or(0);
        let line = |(code, text): (Code, String)| format!("{code:width$}  {}", first_sentence(&text));
        let mut lines: Vec<String> = codes().map(line).collect();
        let words: Vec<&str> = words().map(|(word, _)| word).collect();
        lines.push(format!("\nand the words {}", words.join(", ")));
        write_answer(&lines.join("\n"), None)?;
        return Ok(Status::Holds);
    }
    let text = options.code.join(" ");
    let wanted = text.trim().trim_start_matches("error").trim_matches(['[', ']']);
    let found = match explanation(wanted) {
        Some(found) => found,
        // A limit with several causes has their names with plus signs.
        None => {
            let parts: Option<Vec<String>> = wanted.split('+').map(|cause| explanation(cause.trim())).collect();
            parts.ok_or_else(|| unknown(wanted))?.join("\n\n")
        }
    };
    write_answer(&found, None)?;
    Ok(Status::Holds)
}

/// What a code or a word means, below its name: a code as it stands in brackets first, then a word, then a code without its letter.
fn explanation(wanted: &str) -> Option<String> {
    let shown = |known: &str, text: &str| format!("{known}\n\n{}", text.trim_end());
    let code = |same: &dyn Fn(&str) -> bool| {
        codes().find(|(known, _)| same(known.as_str())).map(|(known, text)| shown(known.as_str(), &text))
    };
    let word = || words().find(|(known, _)| known.eq_ignore_ascii_case(wanted)).map(|(w, text)| shown(w, text));
    code(&|known| known.eq_ignore_ascii_case(wanted))
        .or_else(word)
        .or_else(|| code(&|known| known.split_once('-').is_some_and(|(_, name)| name.eq_ignore_ascii_case(wanted))))
}

/// The first sentence of a text, on one line; a colon ends it too, where an example follows.
fn first_sentence(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    let end = paragraph.match_indices(". ").map(|(at, _)| at + 1).next();
    paragraph[..end.unwrap_or(paragraph.len())].trim_end_matches(':').to_owned()
}

fn unknown(wanted: &str) -> Error {
    let shown: String = wanted.chars().take(60).collect();
    let diagnostic = Diagnostic::error(Code::UnknownCode, format!("there is no error code or word '{shown}'"));
    let near = codes().map(|(code, _)| code.as_str()).chain(words().map(|(word, _)| word)).max_by(|a, b| {
        let likeness_for_display = |c: &str| strsim::jaro_winkler(c, &shown);
        likeness_for_display(a).total_cmp(&likeness_for_display(b))
    });
    let help = match near {
        Some(near) if strsim::jaro_winkler(near, &shown) > 0.8 => format!("did you mean '{near}'?"),
        _ => "'jurist explain' lists all codes and words".to_owned(),
    };
    Error::from(diagnostic.help(help))
}
