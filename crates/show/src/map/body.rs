//! Slices of the stable region in three parameters, for people.

use super::text::{axis_text, mechanism, never_stable_text, place};
use crate::intervals::{extent_line, heading, undecided_text};
use crate::layout::{Columns, short, visible};
use crate::region::goal_or_stable;
use crate::{Text, real};
use jurist_algebra::number::to_decimal;
use jurist_engine::answer::{Answer, Body, BodySlice, Extreme, Extremes, Stretch, StretchEnd};
use jurist_engine::problem::Problem;

/// Digits in the table of slices.
const TABLE_DIGITS: usize = 7;

/// The heads and a row for each slice: its value, the number of its regions, and how far they reach.
pub fn body_rows(answer: &Answer<Body>) -> Vec<Vec<String>> {
    Shown(answer).rows()
}

/// How far the slices reach and where they begin and end, as sentences.
pub fn body_sentences(answer: &Answer<Body>, digits: usize) -> Vec<String> {
    Shown(answer).sentences(digits)
}

impl Text for Answer<Body> {
    /// The answer for people: a row for each slice, how far they reach together, and where they begin and end.
    fn text(&self, digits: usize) -> String {
        Shown(self).text(digits)
    }
}

struct Shown<'a>(&'a Answer<Body>);

impl Shown<'_> {
    fn text(&self, digits: usize) -> String {
        let (problem, body) = (self.0.problem(), self.0.value());
        let [x, y, z] = self.axes();
        let [first, last] = [body.slices.first(), body.slices.last()].map(|s| s.map(|s| short(&s.value)));
        let mut out = format!(
            "{}\n{} against {}, at {} values of {}",
            heading(problem),
            axis_text(x),
            axis_text(y),
            body.slices.len(),
            z.name
        );
        if let Some(unit) = &z.unit {
            out.push_str(&format!(" in {}", visible(unit)));
        }
        out.push_str(&format!(" from {} to {}\n", first.unwrap_or_default(), last.unwrap_or_default()));
        out.push_str(&self.table().to_string());
        match &body.extremes {
            Err(stopped) => out.push_str(&format!("over the slices: {}\n", undecided_text(stopped))),
            Ok(None) => {}
            Ok(Some(extremes)) => out.push_str(&self.extremes_text(extremes, digits)),
        }
        out.push_str(&self.stretches_text());
        out
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let [x, y, z] = self.axes();
        let head = vec![z.name.clone(), "regions".to_owned(), x.name.clone(), y.name.clone()];
        let goal = goal_or_stable(self.0.problem());
        let row = |slice: &BodySlice| {
            let mut cells = vec![short(&slice.value)];
            match &slice.map {
                Err(stopped) => cells.extend(["?".to_owned(), undecided_text(stopped)]),
                Ok(map) => {
                    cells.push(map.value().decomposition.regions.len().to_string());
                    cells.extend(match (&slice.extent, map.value().never_stable_cause) {
                        (Some(extent), _) => [(x, &extent[0]), (y, &extent[1])]
                            .map(|(axis, i)| extent_line(&axis.name, i, TABLE_DIGITS))
                            .to_vec(),
                        (None, Some(cause)) => vec![format!("{goal} nowhere{}", never_stable_text(cause))],
                        (None, None) => vec![format!("{goal} nowhere")],
                    });
                }
            }
            cells
        };
        std::iter::once(head).chain(self.0.value().slices.iter().map(row)).collect()
    }

    fn sentences(&self, digits: usize) -> Vec<String> {
        let extremes = self.0.value().extremes.as_ref().ok().and_then(Option::as_ref);
        let rows = extremes.map(|extremes| self.extreme_rows(extremes, digits)).unwrap_or_default();
        let sentence = |row: Vec<String>| {
            let rest: Vec<String> = row[1..].iter().filter(|cell| !cell.is_empty()).cloned().collect();
            format!("{}: {}", row[0], rest.join(", "))
        };
        let mut out: Vec<String> = rows.into_iter().map(sentence).collect();
        out.extend(self.stretches_text().lines().map(|line| line.trim().to_owned()));
        out
    }

    fn axes(&self) -> [&jurist_engine::problem::Free; 3] {
        let [x, y, z] = self.0.problem().free() else { unreachable!("a body has three free parameters") };
        [x, y, z]
    }

    fn table(&self) -> Columns {
        let mut columns = Columns::new("    ");
        self.rows().into_iter().for_each(|row| columns.row(row));
        columns
    }

    fn extremes_text(&self, extremes: &Extremes, digits: usize) -> String {
        let mut columns = Columns::new("    ");
        self.extreme_rows(extremes, digits).into_iter().for_each(|row| columns.row(row));
        let known = if self.0.value().open_slices().next().is_some() { " that are decided" } else { "" };
        format!("over the slices{known}, not over all {}\n{columns}", self.axes()[2].name)
    }

    fn extreme_rows(&self, extremes: &Extremes, digits: usize) -> Vec<Vec<String>> {
        let axes = self.axes();
        let row = |parameter: usize, side: usize, extreme: &Extreme| {
            let (word, name) = (["least", "greatest"][side], &axes[parameter].name);
            let at = self.reached_at(&extreme.slices);
            let Some(value) = &extreme.value else { return vec![format!("no {word} {name}"), String::new(), at] };
            let decimal = real::rounded(value, digits).decimal;
            let mut cells = vec![format!("{word} {name}"), decimal, at];
            // On several slices the same value has several frequencies and places.
            if let (Some(limit), [_]) = (&extreme.limit, extreme.slices.as_slice()) {
                cells.extend([mechanism(limit, self.0.problem()), place(limit, parameter, [axes[0], axes[1]])]);
            }
            cells
        };
        let ends = |k: usize| extremes.ends[k].iter().enumerate().map(move |(side, extreme)| row(k, side, extreme));
        ends(0).chain(ends(1)).collect()
    }

    /// `at K = 1/2`, or at how many slices.
    fn reached_at(&self, slices: &[usize]) -> String {
        let name = &self.axes()[2].name;
        match slices {
            [one] => format!("at {name} = {}", short(&self.0.value().slices[*one].value)),
            several => format!("on {} slices", several.len()),
        }
    }

    fn stretches_text(&self) -> String {
        let (body, name) = (self.0.value(), &self.axes()[2].name);
        let points = points_text(self.0.problem());
        if body.stretches.is_empty() {
            return match body.open_slices().next() {
                None => format!("no slice has {points}\n"),
                Some(_) => format!("no slice that is decided has {points}\n"),
            };
        }
        let value = |k: usize| short(&body.slices[k].value);
        let mut out = String::new();
        for stretch in &body.stretches {
            let slices = match (stretch.first, stretch.last) {
                (a, b) if a == b => format!("on the slice at {name} = {}", value(a)),
                (a, b) => format!("on the {} slices from {name} = {} to {}", b - a + 1, value(a), value(b)),
            };
            out.push_str(&format!("{points} {slices}\n"));
            for (side, end) in stretch.ends.iter().enumerate() {
                out.push_str(&format!("    {}\n", self.end_text(stretch, side, end)));
            }
        }
        out
    }

    fn end_text(&self, stretch: &Stretch, side: usize, end: &StretchEnd) -> String {
        let (body, name) = (self.0.value(), &self.axes()[2].name);
        let word = ["begin", "end"][side];
        match end {
            StretchEnd::Range => {
                let number = [stretch.first, stretch.last][side];
                let at = short(&body.slices[number].value);
                format!("at {name} = {at} the range that was asked for {word}s")
            }
            StretchEnd::Open => format!("where they {word} is not known: the slice beside is not decided"),
            StretchEnd::Between { stable, none, stopped } => {
                let width = to_decimal(&(stable - none).abs(), 2);
                let mut text = format!(
                    "they {word} between {name} = {}, where there are some, and {name} = {}, where there are none (width {width})",
                    short(stable),
                    short(none)
                );
                if let Some(stopped) = stopped {
                    text.push_str(&format!("; not narrowed further: {stopped}"));
                }
                text
            }
        }
    }
}

/// `stable points`, or points with what a radius or a decay rate asks for.
fn points_text(problem: &Problem) -> String {
    match goal_or_stable(problem).as_str() {
        "stable" => "stable points".to_owned(),
        goal => format!("points with {goal}"),
    }
}

#[cfg(test)]
mod tests {
    use crate::Text;
    use jurist_algebra::limits::Budget;
    use jurist_algebra::number::Rational;
    use jurist_engine::answer::{Answer, Body, SliceValues};
    use jurist_engine::model::{Model, ParameterBuilder, Time};
    use jurist_engine::problem::Ask;

    fn slices(characteristic: &str, from: i64, count: usize, budget: &Budget) -> Answer<Body> {
        let parameter = |name: &str| ParameterBuilder::new(name).nominal("0");
        let builder = Model::builder(Time::Discrete).parameter(parameter("a")).parameter(parameter("b"));
        let (model, _) = builder.parameter(parameter("c")).characteristic(characteristic).build().unwrap();
        let values = SliceValues::evenly("c", &from.into(), &Rational::ONE, count).unwrap();
        model.ask().free("a").free("b").body(&values, &Rational::new(1.into(), 100.into()), 8, budget).unwrap()
    }

    #[test]
    fn no_stable_slice_is_said() {
        let text = slices("(z - 2)*(z - a*b*c)", 0, 2, &Budget::unlimited()).text(12);
        assert!(text.contains("no slice has stable points"), "{text}");
    }

    #[test]
    fn what_the_budget_did_not_allow_is_said() {
        let of = |work| slices("(z^2 + a*z + b)*(z - 2*c^2)", -1, 5, &Budget::with_work(work));
        assert!(of(0).text(12).contains("no slice that is decided has stable points"));
        for work in [3, 10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000] {
            let answer = of(work);
            let text = answer.text(12);
            assert!(text.matches("undecided, the budget ran out").count() >= answer.value().open_slices().count());
            assert_eq!(text.contains("ran out"), answer.value().stopped().is_some());
        }
    }
}
