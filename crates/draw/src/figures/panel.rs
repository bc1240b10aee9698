//! A panel: axes with curves, marks and words; and figures of several panels.

use super::Figure;
use super::clip::Window;
use kuva::plot::annotations::{ReferenceLine, TextAnnotation};
use kuva::plot::legend::LegendPosition;
use kuva::plot::line::LinePlot;
use kuva::plot::scatter::{MarkerShape, ScatterPlot};
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, render_multiple};
use std::sync::Arc;

/// A line through points.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// Its entry in the legend, if it has one.
    pub label: Option<String>,
    /// Colour, as in CSS.
    pub colour: String,
    /// Width in units of the picture.
    pub width: f64,
    /// Whether it is dashed.
    pub dashed: bool,
}

/// Shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// x, where a locus starts.
    Cross,
    /// o, where it ends.
    Circle,
    /// A filled diamond.
    Diamond,
}

/// A mark at a point.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Where.
    pub at: (f64, f64),
    /// What it looks like.
    pub shape: Shape,
    /// Colour, as in CSS.
    pub colour: String,
    /// Its entry in the legend, if it has one.
    pub label: Option<String>,
}

/// Words in the panel, with an arrow to what they are about.
#[derive(Clone, Debug)]
pub struct Text {
    /// The words.
    pub text: String,
    /// Where they stand.
    pub at: (f64, f64),
    /// What they point at.
    pub target: Option<(f64, f64)>,
}

/// Axes with what is drawn between them.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Above the axes.
    pub title: String,
    /// Along x, with the unit.
    pub x_label: String,
    /// Along y, with the unit.
    pub y_label: String,
    /// Ends of the x axis.
    pub x: (f64, f64),
    /// Ends of the y axis.
    pub y: (f64, f64),
    /// The curves, drawn in order.
    pub curves: Vec<Curve>,
    /// The marks, drawn over the curves.
    pub marks: Vec<Mark>,
    /// The words, drawn over all.
    pub texts: Vec<Text>,
    /// Horizontal dashed lines with their labels.
    pub levels: Vec<(f64, String)>,
    /// Whether a unit is as long in x as in y; the ends of the axes then belong to a square.
    pub equal: bool,
    /// Whether x is the decimal logarithm of what the axis tells.
    pub decades: bool,
    /// Where the legend stands; none if `None`.
    pub legend: Option<Corner>,
}

/// A corner of the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Upper right.
    TopRight,
    /// Lower right.
    BottomRight,
    /// Upper left.
    TopLeft,
    /// Lower left.
    BottomLeft,
}

/// A distance between ticks from the series 1, 2, 5 that gives about `count` of them.
pub(super) fn tick_step(range: (f64, f64), count: f64) -> f64 {
    let raw = ((range.1 - range.0) / count).abs().max(f64::MIN_POSITIVE);
    let decade = 10f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * decade >= raw * 0.999).unwrap_or(10.0);
    factor * decade
}

/// `5e33` as people write it: 5·10³³.
pub(super) fn power_of_ten(v: f64) -> String {
    let text = format!("{v:.1e}").replace(".0e", "e").replace('-', "\u{2212}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let raised = |c: char| match c.to_digit(10) {
        Some(d) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][d as usize],
        None => '⁻',
    };
    let exponent: String = exponent.chars().map(raised).collect();
    match mantissa {
        "1" => format!("10{exponent}"),
        "\u{2212}1" => format!("\u{2212}10{exponent}"),
        _ => format!("{mantissa}·10{exponent}"),
    }
}

/// Numbers at ticks: as many decimals as the step needs, powers of ten where they would be long.
fn tick_format(range: (f64, f64), step: f64) -> TickFormat {
    let largest = range.0.abs().max(range.1.abs());
    let decimals = (-step.log10() - 1e-9).ceil().max(0.0) as usize;
    if largest >= 1e6 || (largest < 1e-3 && largest > 0.0) {
        return TickFormat::Custom(Arc::new(|v| if v == 0.0 { "0".into() } else { power_of_ten(v) }));
    }
    TickFormat::Custom(Arc::new(move |v| {
        let text = format!("{v:.decimals$}");
        if text.trim_start_matches(['-', '0', '.']).is_empty() { "0".into() } else { text.replace('-', "\u{2212}") }
    }))
}

impl Panel {
    fn render(&self, width: f64, height: f64) -> Scene {
        let window = Window { x: self.x, y: self.y };
        let mut plots: Vec<Plot> = Vec::new();
        // Curves may share an entry of the legend; one that is not to be seen brings none.
        let mut entered: Vec<&str> = Vec::new();
        for curve in &self.curves {
            for piece in window.pieces(&curve.points) {
                let mut line =
                    LinePlot::new().with_data(piece).with_color(&curve.colour).with_stroke_width(curve.width);
                if curve.dashed {
                    line = line.with_dashed();
                }
                if let Some(label) = curve.label.as_deref().filter(|l| !entered.contains(l)) {
                    entered.push(label);
                    line = line.with_legend(label);
                }
                plots.push(line.into());
            }
        }
        for mark in self.marks.iter().filter(|m| window.contains(m.at)) {
            let (shape, size) = match mark.shape {
                Shape::Cross => (MarkerShape::Cross, 4.5),
                Shape::Circle => (MarkerShape::Circle, 4.0),
                Shape::Diamond => (MarkerShape::Diamond, 5.0),
            };
            let mut plot =
                ScatterPlot::new().with_data(vec![mark.at]).with_color(&mark.colour).with_marker(shape).with_size(size);
            if mark.shape == Shape::Circle {
                plot = plot.with_marker_opacity(0.15).with_marker_stroke_width(1.4);
            }
            if let Some(label) = &mark.label {
                plot = plot.with_legend(label.clone());
            }
            plots.push(plot.into());
        }
        let (x_step, y_step) = (tick_step(self.x, width / 70.0), tick_step(self.y, height / 45.0));
        let y_step = if self.equal { x_step } else { y_step };
        let x_step = if self.decades { x_step.max(1.0) } else { x_step };
        let x_format = if self.decades {
            TickFormat::Custom(Arc::new(|v: f64| {
                let value = 10f64.powf(v);
                if (-3.5..4.5).contains(&v) {
                    format!("{value:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
                } else {
                    power_of_ten(value)
                }
            }))
        } else {
            tick_format(self.x, x_step)
        };
        let mut layout = Layout::new(self.x, self.y)
            .with_width(width)
            .with_height(height)
            .with_x_axis_min(self.x.0)
            .with_x_axis_max(self.x.1)
            .with_y_axis_min(self.y.0)
            .with_y_axis_max(self.y.1)
            .with_x_tick_step(x_step)
            .with_y_tick_step(y_step)
            .with_x_tick_format(x_format)
            .with_y_tick_format(tick_format(self.y, y_step))
            .with_x_label(&self.x_label)
            .with_y_label(&self.y_label)
            .with_title_size(14)
            .with_label_size(12)
            .with_tick_size(11)
            .with_body_size(11)
            .with_box_axes();
        if !self.title.is_empty() {
            layout = layout.with_title(&self.title);
        }
        layout = match self.legend {
            Some(corner) => layout.with_legend_position(match corner {
                Corner::TopRight => LegendPosition::InsideTopRight,
                Corner::BottomRight => LegendPosition::InsideBottomRight,
                Corner::TopLeft => LegendPosition::InsideTopLeft,
                Corner::BottomLeft => LegendPosition::InsideBottomLeft,
            }),
            None => layout,
        };
        if self.legend.is_some() && self.curves.iter().any(|c| c.label.is_some()) {
            layout.show_legend = true;
            let curves = self.curves.iter().filter_map(|c| c.label.as_ref());
            let widest =
                curves.chain(self.marks.iter().filter_map(|m| m.label.as_ref())).map(|l| l.chars().count()).max();
            layout = layout.with_legend_width(52.0 + 7.2 * widest.unwrap_or(0) as f64);
        }
        for text in &self.texts {
            let mut annotation = TextAnnotation::new(&text.text, text.at.0, text.at.1).with_font_size(11);
            if let Some((x, y)) = text.target {
                annotation = annotation.with_arrow(x, y);
            }
            layout = layout.with_annotation(annotation);
        }
        for (level, label) in &self.levels {
            let line = ReferenceLine::horizontal(*level).with_color("#888888").with_stroke_width(1.0);
            layout = layout.with_reference_line(if label.is_empty() { line } else { line.with_label(label) });
        }
        if plots.is_empty() {
            plots.push(LinePlot::new().with_data(vec![(self.x.0, self.y.0)]).with_color("none").into());
        }
        if self.equal {
            layout = layout.with_equal_aspect();
        }
        render_multiple(plots, layout)
    }

    /// The panel alone as a figure.
    pub fn figure(&self, width: f64, height: f64) -> Figure {
        Figure::new(self.render(width, height))
    }
}

/// Panels one below the other, each `width` by `height`.
pub fn stacked(panels: &[Panel], width: f64, height: f64) -> Figure {
    let cells = panels.iter().enumerate().map(|(k, p)| (0.0, k as f64 * height, p.render(width, height)));
    composed(cells, width, height * panels.len().max(1) as f64)
}

/// Panels side by side, each `width` by `height`.
pub fn side_by_side(panels: &[Panel], width: f64, height: f64) -> Figure {
    let cells = panels.iter().enumerate().map(|(k, p)| (k as f64 * width, 0.0, p.render(width, height)));
    composed(cells, width * panels.len().max(1) as f64, height)
}

fn composed(cells: impl Iterator<Item = (f64, f64, Scene)>, width: f64, height: f64) -> Figure {
    let mut whole = Scene::new(width, height);
    for (x, y, scene) in cells {
        whole.add(Primitive::GroupStart {
            transform: Some(format!("translate({x},{y})")),
            title: None,
            extra_attrs: None,
        });
        whole.elements.extend(scene.elements);
        whole.defs.extend(scene.defs);
        whole.add(Primitive::GroupEnd);
    }
    Figure::new(whole)
}

#[cfg(test)]
mod tests {
    use super::power_of_ten;

    #[test]
    fn large_numbers_are_powers_of_ten() {
        assert_eq!(power_of_ten(5e33), "5·10³³");
        assert_eq!(power_of_ten(-1e-4), "\u{2212}10⁻⁴");
        assert_eq!(power_of_ten(2.5e6), "2.5·10⁶");
    }
}
