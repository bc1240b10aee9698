//! What a certificate for all values says.

use super::{Loops, Requirement, Told};
use crate::map_boxes::{Walked, percent};
use crate::number::Q;
use crate::verdict;
use crate::words::{self, exact, inward};

/// A phrase for each requirement.
pub(crate) fn wishes(of: &Loops) -> Vec<String> {
    of.each.iter().filter_map(|own| own.requirement.as_ref()).map(Requirement::in_words).collect()
}

impl Loops {
    /// The statement in words. It gives the ranges of names for all exactly: a smaller range may leave out the value that breaks the loop.
    pub(super) fn in_words(&self, told: &Told, walked: &Walked) -> String {
        let require = wishes(self);
        let within = verdict::within(&self.each[0].extent, self.discrete);
        let joint = if require.is_empty() { " " } else { ", " };
        let good = |with: &str| match require.is_empty() {
            true => format!("stable{within}"),
            false => format!("stable{within}{with}{}", require.join(" and ")),
        };
        let (axes, for_all) = self.window.split_at(self.axes);
        let inner = || self.names[self.axes..].iter().zip(for_all);
        let ranges = inner().filter(|(_, [low, high])| low < high);
        let every: Vec<String> =
            ranges.map(|(name, [low, high])| format!("{name} from {} to {}", exact(low), exact(high))).collect();
        let every = if every.is_empty() { String::new() } else { format!("or all {}", every.join(" and ")) };
        let fixed = inner().filter(|(_, [low, high])| low == high).map(|(name, [low, _])| (name, low));
        let values = words::values(fixed.chain(self.set.iter().map(|(name, q)| (name, q))));
        let with_values = if values.is_empty() { String::new() } else { format!(", with {values}") };
        let yes = good(", with ");
        if axes.is_empty() {
            return self.of_one_point(told, walked, [&every, &values, &with_values], [&yes, &good(" with ")]);
        }
        let axes: Vec<String> = self.names.iter().zip(axes).map(of_axis).collect();
        let axes = axes.join(" and ");
        let every = if every.is_empty() { String::new() } else { format!(", f{every}") };
        let begin = format!("For {axes}{every}{with_values}");
        let said = if self.axes == 2 {
            let [more, less, _] = walked.shares.each_ref().map(percent);
            format!(
                "the loop is {yes}{joint}in all boxes '+' of the tree, and nowhere in its boxes '-': at least {more} % and {less} % of the window."
            )
        } else {
            let (more, less) = (walked.ranges('+', &self.names[0]), walked.ranges('-', &self.names[0]));
            match (more.is_empty(), less.is_empty()) {
                (false, false) => {
                    format!("the loop is {yes}{joint}for {more}, and not so for any value in {less}.")
                }
                (false, true) => format!("the loop is {yes}{joint}for {more}."),
                (true, false) => format!("the loop is not {}{}for any value in {less}.", good(" with "), joint),
                (true, true) => "nothing is said of the loop.".into(),
            }
        };
        format!("{begin}, {said} Nothing is said of the rest.")
    }

    /// Where there are no axes: of names for all, of the values of others, and of what is good, or not.
    fn of_one_point(
        &self,
        told: &Told,
        walked: &Walked,
        [every, values, with_values]: [&str; 3],
        [yes, no]: [&str; 2],
    ) -> String {
        let letter = walked.pieces.first().map_or('?', |(letter, _)| *letter);
        let mut out = if letter == '-' && !every.is_empty() {
            format!("Not f{every}{with_values}, the loop is {yes}.")
        } else {
            let begin = match (every.is_empty(), values.is_empty()) {
                (false, _) => format!("F{every}{with_values}, the"),
                (true, false) => format!("At {values}, the"),
                (true, true) => "The".into(),
            };
            match letter {
                '+' => format!("{begin} loop is {yes}."),
                '-' => format!("{begin} loop is not {no}."),
                _ => format!("{begin} loop is stable or not: nothing is said of it."),
            }
        };
        if let Some(beyond) = &told.beyond {
            let at = words::values(self.names.iter().zip(&beyond.point));
            out += &if at.is_empty() { " It is not.".to_owned() } else { format!(" At {at}, it is not.") };
        }
        out
    }
}

fn of_axis((name, [low, high]): (&String, &[Q; 2])) -> String {
    let [low, high] = inward(low, high);
    format!("{name} from {low} to {high}")
}
