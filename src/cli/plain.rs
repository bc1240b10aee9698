//! Questions that are put again and again while somebody drags a value, read without building the definition of the whole command line.

use super::arguments::{Arguments, DecisionOptions};
use super::commands::{Command, intervals, verdict};
use std::ffi::OsString;

/// `verdict` or `intervals` of the given model (`-`) with nothing but `--param`, `--set`, `--json` and `--quiet`, each value an
/// argument of its own; `None` for all else, also for what is wrong.
///
/// Cost: linear in the length of the arguments.
pub(super) fn plain(arguments: &[OsString]) -> Option<Arguments> {
    let mut words = arguments.iter().skip(1).map(|a| a.to_str());
    let command = words.next()??;
    let mut param = None;
    let mut decision = DecisionOptions::default();
    while let Some(word) = words.next() {
        let mut value = || words.next().flatten().filter(|v| !v.is_empty() && !v.starts_with('-')).map(str::to_owned);
        let is_first = |already: bool| (!already).then_some(true);
        match word? {
            "-" if decision.model.model.is_none() => decision.model.model = Some("-".into()),
            "--json" => decision.output.json = is_first(decision.output.json)?,
            "--quiet" => decision.output.run.quiet = is_first(decision.output.run.quiet)?,
            "--set" => decision.model.set.push(value()?),
            "--param" if param.is_none() => param = Some(value()?),
            _ => return None,
        }
    }
    decision.model.model.as_ref()?;
    let command = match (command, param) {
        ("verdict", None) => Command::Verdict(verdict::Options { decision, ..Default::default() }),
        ("intervals", param) => Command::Intervals(intervals::Options { decision, param, ..Default::default() }),
        _ => return None,
    };
    Some(Arguments {
        command: Some(command),
        #[cfg(feature = "cli")]
        main_job: Default::default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    fn read(words: &[&str]) -> (Option<String>, Option<String>) {
        let arguments: Vec<OsString> = std::iter::once("jurist").chain(words.iter().copied()).map(Into::into).collect();
        let shown = |a: &Arguments| format!("{a:?}");
        (plain(&arguments).as_ref().map(shown), Arguments::try_parse_from(&arguments).ok().as_ref().map(shown))
    }

    #[test]
    fn the_questions_of_the_page_are_read_as_the_command_line_reads_them() {
        for words in [
            &["verdict", "-", "--json"][..],
            &["verdict", "-", "--json", "--set", "K=1/3", "--set", "T=-1e-4"],
            &["intervals", "-", "--param", "K", "--json", "--set", "a b=2"],
            &["intervals", "--quiet", "-"],
        ] {
            let (plain, clap) = read(words);
            assert!(plain.is_some(), "{words:?}");
            assert_eq!(plain, clap, "{words:?}");
        }
    }

    #[test]
    fn no_other_list_of_words_is_read_otherwise_than_by_the_command_line() {
        let vocabulary = [
            "verdict",
            "intervals",
            "-",
            "--json",
            "--quiet",
            "--set",
            "K=1",
            "",
            "--param",
            "-x",
            "--",
            "--set=K=2",
            "--verbose",
        ];
        let mut plainly = 0;
        // All lists of up to four words after the command.
        for command in ["verdict", "intervals", "locus"] {
            for mut number in 0..13_usize.pow(4) {
                let mut words = vec![command];
                while number > 0 {
                    words.push(vocabulary[number % 13]);
                    number /= 13;
                }
                // The command line takes its time: it is asked only where there is something to compare.
                let arguments: Vec<OsString> =
                    std::iter::once("jurist").chain(words.iter().copied()).map(Into::into).collect();
                if plain(&arguments).is_none() {
                    continue;
                }
                plainly += 1;
                let (plain, clap) = read(&words);
                assert_eq!(plain, clap, "{words:?}");
            }
        }
        assert!(plainly > 50, "only {plainly}");
    }
}
