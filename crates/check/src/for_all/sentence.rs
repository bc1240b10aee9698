//! What a certificate for all values says.

use super::Statement;
use crate::map_boxes::{Walked, percent};
use crate::verdict;
use crate::words::{exact, inward};
use std::fmt::Write;

/// `a`, `a and b`, `a, b and c`.
fn joined(all: &[String]) -> String {
    match all {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

impl Statement {
    pub(super) fn in_words(&self, walked: &Walked) -> String {
        let sides = self.names.iter().zip(&self.window);
        let ranges: Vec<String> = sides
            .map(|(name, [low, high])| {
                let [low, high] = inward(low, high);
                format!("{name} from {low} to {high}")
            })
            .collect();
        let (axes, for_all) = ranges.split_at(self.axes);
        let within = verdict::within(&self.extent, self.discrete);
        let require: Vec<String> = self.require.iter().map(super::Requirement::in_words).collect();
        let with = if require.is_empty() { String::new() } else { format!(" with {}", joined(&require)) };
        let good = format!("stable{within}{with}");
        let letter = walked.pieces.first().map_or('?', |(letter, _)| *letter);
        let mut out = String::new();
        let begin = |out: &mut String, words: &str, what: &[String]| {
            if !what.is_empty() {
                let _ = write!(out, "{}{words} {}", if out.is_empty() { "" } else { ", " }, joined(what));
            }
        };
        begin(&mut out, "for", axes);
        begin(&mut out, if self.axes == 0 && letter == '-' { "for some" } else { "for all" }, for_all);
        let set: Vec<String> = self.set.iter().map(|(name, q)| format!("{name} = {}", exact(q))).collect();
        begin(&mut out, "with", &set);
        if !out.is_empty() {
            out.push_str(", ");
        }
        match self.axes {
            0 => drop(match letter {
                '+' => write!(out, "the loop is {good}"),
                '-' => write!(out, "the loop is not {good}"),
                _ => write!(out, "nothing is said of whether the loop is {good}"),
            }),
            1 => {
                let name = &self.names[0];
                let (yes, no) = (walked.ranges('+', name), walked.ranges('-', name));
                let _ = match yes.is_empty() {
                    true => write!(out, "for no value is the loop shown to be {good}"),
                    false => write!(out, "the loop is {good} for {yes}"),
                };
                if !no.is_empty() {
                    let _ = write!(out, ". For no value in {no} is that so");
                }
                out.push_str(". Nothing is said of the rest");
            }
            _ => {
                let [yes, no, _] = walked.shares.each_ref().map(percent);
                let _ = write!(
                    out,
                    "the loop is {good} in all boxes '+' of the tree. At no point of its boxes '-' is that so. They are at least {yes} % and {no} % of the \
                     window. Nothing is said of the rest"
                );
            }
        }
        out.push('.');
        if let Some(beyond) = &self.beyond {
            let point: Vec<String> =
                self.names.iter().zip(&beyond.point).map(|(name, x)| format!("{name} = {}", exact(x))).collect();
            let _ = write!(out, " For {} the loop is not {good}.", joined(&point));
        }
        let first = out.remove(0).to_ascii_uppercase();
        out.insert(0, first);
        out
    }
}
