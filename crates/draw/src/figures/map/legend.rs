//! The legend.

use super::draw::{CHARACTER, Drawing, FAINT, INK, REGION};
use super::labels::words;
use super::lines::{Role, Wall, mechanism_colour};
use super::shapes::dashed;
use jurist_engine::show::region::goal_or_stable;
use kuva::render::color::Color;
use kuva::render::render::{Primitive, TextAnchor};

/// What stands before a name of the legend.
enum Entry {
    Region,
    Line(&'static str, Option<&'static str>, f64),
    Nominal,
    Published,
}

impl Drawing<'_> {
    /// Samples of what is drawn with their names; returns where the next line of text would stand.
    pub(super) fn legend(&mut self, from: f64) -> f64 {
        let contents = self.contents;
        let mut entries: Vec<(Entry, String)> = Vec::new();
        if !contents.map.regions.is_empty() {
            entries.push((Entry::Region, format!("{} (certified)", goal_or_stable(contents.answer.problem()))));
        }
        let seen = |role: Role| {
            let on_screen =
                |w: &&Wall| w.points.iter().any(|p| (0.0..=1.0).contains(&p.0) && (0.0..=1.0).contains(&p.1));
            contents.walls.iter().filter(move |w| w.role == role).filter(on_screen)
        };
        for wall in seen(Role::Stable) {
            let causes = &contents.map.curves[wall.curve].causes;
            let name = words(contents.answer, contents.map, wall);
            if !entries.iter().any(|e| e.1 == name) {
                let (colour, dashes) = mechanism_colour(causes);
                entries.push((Entry::Line(colour, dashes, 2.2), name));
            }
        }
        if seen(Role::Count).next().is_some() {
            entries.push((Entry::Line(FAINT, None, 0.9), "other changes of the root count".into()));
        }
        if self.nominal().is_some() {
            entries.push((Entry::Nominal, "nominal".into()));
        }
        let windows = &contents.trace.windows;
        let on_screen =
            |p: &(f64, f64)| [(0, p.0), (1, p.1)].into_iter().all(|(k, v)| (0.0..=1.0).contains(&windows[k].place(v)));
        if contents.published.iter().any(on_screen) {
            entries.push((Entry::Published, "published limits".into()));
        }
        let (start, end) = (14.0, self.left + self.width + 10.0);
        let (mut x, mut y) = (start, from);
        for (entry, name) in entries {
            let length = 30.0 + name.chars().count() as f64 * CHARACTER + 16.0;
            if x > start && x + length > end + 14.0 {
                (x, y) = (start, y + 17.0);
            }
            let middle = (x + 12.0, y - 4.0);
            match entry {
                Entry::Region => self.scene.add(Primitive::Rect {
                    x,
                    y: y - 10.0,
                    width: 24.0,
                    height: 12.0,
                    fill: Color::from(REGION),
                    stroke: None,
                    stroke_width: None,
                    opacity: None,
                }),
                Entry::Line(colour, dashes, width) => {
                    for dash in dashed(vec![(x, y - 4.0), (x + 24.0, y - 4.0)], dashes) {
                        self.line(dash[0], dash[1], colour, width, None);
                    }
                }
                Entry::Nominal => self.diamond(middle),
                Entry::Published => self.circle(middle),
            }
            self.text((x + 30.0, y), &name, 11, TextAnchor::Start, INK);
            x += length;
        }
        y
    }
}
