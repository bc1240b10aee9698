//! The legend.

use super::super::legend::{Entry, Sample};
use super::super::panel::Shape;
use super::super::{FAINT, INK};
use super::draw::{MapContents, inside, wall_stroke};
use super::labels::words;
use super::lines::{Role, Wall};
use super::{REGION, UNSTABLE};
use crate::scene::Stroke;
use jurist_show::region::goal_or_stable;

impl MapContents<'_> {
    /// Samples of what is drawn with their names.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let contents = self;
        let goal = goal_or_stable(contents.answer.problem());
        let mut entries: Vec<Entry> = Vec::new();
        if !contents.map.regions.is_empty() {
            entries.push((Sample::Area(REGION), format!("{goal} (certified)")));
        }
        entries.extend(self.layer_entries());
        let not = if goal == "stable" { "unstable".to_owned() } else { format!("not {goal}") };
        entries.push((Sample::Area(UNSTABLE), not));
        if contents.leaves_domain() {
            entries.push((Sample::Hatched, "outside the domain".into()));
        }
        let seen = |role: Role| {
            let on_screen = |w: &&Wall| w.points.iter().any(|p| inside(*p));
            contents.walls.iter().filter(move |w| w.role == role).filter(on_screen)
        };
        for wall in seen(Role::Stable) {
            let name = words(contents.answer, contents.map, wall);
            if !entries.iter().any(|e| e.1 == name) {
                entries.push((Sample::Line(wall_stroke(wall, contents.map)), name));
            }
        }
        if seen(Role::Count).next().is_some() {
            entries.push((Sample::Line(Stroke::new(FAINT, 0.9)), "number of unstable roots changes".into()));
        }
        if self.nominal().is_some() {
            entries.push((Sample::Mark(Shape::Diamond, INK), "nominal".into()));
        }
        let windows = &contents.trace.windows;
        if contents.published.iter().any(|p| inside((windows[0].place(p.0), windows[1].place(p.1)))) {
            entries.push((Sample::Mark(Shape::Circle, INK), "published limits".into()));
        }
        entries
    }
}
