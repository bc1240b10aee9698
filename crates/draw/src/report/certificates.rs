//! How to write the certificates of what the report says, and what they are.

use super::ReportRequest;
use super::limits::Limits;
use super::part::{Part, Parts, Work};
use crate::page::{Table, escaped, paragraph};
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::problem::Question;
use jurist_prove::Certificate as _;

/// Work of all certificates of limits together, which they share evenly, and of the verdict's: about a second of one core.
const WORK: u64 = 60_000_000;

/// The words of a shell for the model, its settings, and files to write.
pub(super) struct Commands<'a> {
    /// The model's file; `None` for the built-in drive.
    pub file: Option<&'a str>,
    /// The values that are set.
    pub question: &'a Question,
}

/// A word that a shell takes as it is.
fn word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

impl Commands<'_> {
    /// `jurist COMMAND MODEL OPTIONS`
    pub fn line(&self, command: &str, options: &[&str]) -> String {
        let mut words = vec!["jurist".to_owned(), command.to_owned()];
        words.extend(self.file.map(word));
        words.extend(self.question.values_set().iter().map(|(n, v)| format!("--set {}", word(&format!("{n}={v}")))));
        words.extend(options.iter().map(|o| word(o)));
        words.join(" ")
    }

    /// `jurist verify MODEL FILE`, of the built-in drive with its text from a pipe.
    fn verify(&self, certificate: &str) -> String {
        match self.file {
            Some(file) => format!("jurist verify {} {}", word(file), word(certificate)),
            None => format!("jurist verify examples/drive.toml {}", word(certificate)),
        }
    }
}

/// What leaves out the model's requirements.
fn alone(is_required: bool) -> &'static [&'static str] {
    if is_required { &["--no-require"] } else { &[] }
}

pub(super) fn section(
    commands: &Commands<'_>,
    verdict: &Part<Answer<PointVerdict>>,
    limits: &[Limits],
    request: &ReportRequest<'_>,
    parts: &Parts<'_>,
) -> String {
    let mut html = paragraph(
        "A certificate is a file from which independent code proves an answer again: it reads the model itself and shares \
         nothing with the code that found the answer.",
    );
    let is_required = !commands.question.model().require().is_empty();
    if is_required {
        html.push_str(&paragraph("These are of stability; nothing certifies what <code>[require]</code> asks for."));
    }
    let mut listed = Listed::new(commands, request);
    if let Ok(answer) = verdict {
        let text =
            parts.part("certificate of the verdict", Work::Units(WORK), |budget| match request.certify_verdict {
                Some(certify) => Ok((certify(answer, budget)?, None)),
                None => Ok((answer.certificate(budget)?, None)),
            });
        let file = "verdict.json".to_owned();
        let line = commands.line("verdict", &[alone(is_required), &["--certificate", &file]].concat());
        listed.add("the verdict".to_owned(), file, line, text);
    }
    let share = Work::Units(WORK / limits.len().max(1) as u64);
    for one in limits {
        let Ok(answer) = &one.set else { continue };
        let text = parts.part(&format!("certificate of {}", one.name), share, |budget| match request.certify {
            Some(certify) => certify(answer, budget),
            None => Ok((answer.certificate(budget)?, None)),
        });
        let file = format!("{}.json", one.name);
        let options = ["--param", &one.name, "--certificate", &file];
        let line = commands.line("intervals", &[alone(is_required), &options].concat());
        listed.add(format!("all limits of {}", one.name), file, line, text);
    }
    html + &listed.html()
}

/// The text of a certificate, and how much it speaks of where that is not all.
type Certificate = (String, Option<String>);

/// A table of certificates, and the lines that write and check them.
struct Listed<'a> {
    commands: &'a Commands<'a>,
    request: &'a ReportRequest<'a>,
    table: Table,
    lines: Vec<String>,
}

impl<'a> Listed<'a> {
    fn new(commands: &'a Commands<'a>, request: &'a ReportRequest<'a>) -> Self {
        let mut head = vec!["certificate", "size"];
        head.extend(request.check.is_some().then_some("the independent check says"));
        let table = Table::new("Certificates of this report's answers", &head);
        Listed { commands, request, table, lines: Vec::new() }
    }

    fn add(&mut self, what: String, file: String, line: String, text: Part<Certificate>) {
        let mut row = vec![what];
        match text {
            Err(missing) => {
                row.extend([missing.sentence()].into_iter().chain(self.request.check.map(|_| String::new())))
            }
            Ok((text, share)) => {
                self.lines.extend([line, self.commands.verify(&file)]);
                let share = share.map(|share| format!("; {share}")).unwrap_or_default();
                row.push(format!("{} bytes{share}", text.len()));
                row.extend(self.request.check.map(|check| match check(&text) {
                    Ok(()) => "accepted".to_owned(),
                    Err(why) => format!("not accepted: {why}"),
                }));
            }
        }
        self.table.rows.push(row);
    }

    fn html(&self) -> String {
        let mut html = String::new();
        if !self.table.rows.is_empty() {
            html.push_str(&self.table.html());
        }
        if !self.lines.is_empty() {
            let shown: Vec<String> = self.lines.iter().map(|line| escaped(line)).collect();
            html.push_str(&format!("<pre>{}</pre>\n", shown.join("\n")));
        }
        html
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_engine::model::Model;
    use jurist_engine::problem::Ask;

    #[test]
    fn names_that_a_shell_would_read_are_quoted() {
        let question = Model::drive().ask().set("T", jurist_algebra::number::Rational::new(1.into(), 2000.into()));
        let commands = Commands { file: Some("my loop's $(model).toml"), question: &question };
        let line = commands.line("intervals", &["--param", "K_pwm"]);
        assert_eq!(line, "jurist intervals 'my loop'\\''s $(model).toml' --set T=1/2000 --param K_pwm");
    }
}
