//! Lines of words with their indices.

use super::font;
use super::{Colour, Point};

/// Which part of a line of words stands at its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    #[default]
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A line of words.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// The words; an index is written `K_pwm`.
    pub text: String,
    /// A point of the base line.
    pub at: Point,
    /// Which point.
    pub anchor: Anchor,
    /// Size of the letters.
    pub size: f64,
    /// Colour.
    pub colour: Colour,
    /// Whether they run upwards.
    pub turned: bool,
    /// A colour around the letters, so that lines below do not strike through them.
    pub halo: Option<Colour>,
}

impl Words {
    /// Words that run to the right from a place.
    pub fn new(text: impl Into<String>, at: Point, size: f64, colour: Colour) -> Words {
        Words { text: text.into(), at, anchor: Anchor::Start, size, colour, turned: false, halo: None }
    }

    /// The same at another anchor.
    pub fn anchored(self, anchor: Anchor) -> Words {
        Words { anchor, ..self }
    }

    /// The same, running upwards.
    pub fn turned(self) -> Words {
        Words { turned: true, ..self }
    }

    /// The same with a colour around the letters.
    pub fn with_halo(self, colour: Colour) -> Words {
        Words { halo: Some(colour), ..self }
    }

    /// How far left of its place the line begins, along its direction.
    #[cfg(any(feature = "pdf", feature = "png"))]
    pub(super) fn before(&self) -> f64 {
        match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width(&self.text, self.size) / 2.0,
            Anchor::End => width(&self.text, self.size),
        }
    }
}

/// Size of an index, as a share of that of its line.
pub(super) const INDEX_SIZE: f64 = 0.75;
/// How far an index stands below, as a share of the size of its line.
pub(super) const INDEX_DROP: f64 = 0.22;

/// Letters of one size and height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run<'a> {
    pub text: &'a str,
    /// Whether it is an index.
    pub lowered: bool,
}

/// The line cut into runs: in a name of one or two letters and an index, such as `K_pwm` or `Kp_i`, the part behind
/// the line is an index; longer names stay as they are.
pub(super) fn runs(text: &str) -> Vec<Run<'_>> {
    let mut out = Vec::new();
    let mut begin = 0;
    let mut at = 0;
    for word in text.split_inclusive(|c: char| !c.is_alphanumeric() && c != '_') {
        let name = word.trim_end_matches(|c: char| !c.is_alphanumeric() && c != '_');
        if let Some((base, index)) = name.split_once('_')
            && (1..=2).contains(&base.chars().count())
            && !index.is_empty()
            && !index.contains('_')
        {
            let from = at + base.len();
            out.push(Run { text: &text[begin..from], lowered: false });
            out.push(Run { text: index, lowered: true });
            begin = at + name.len();
        }
        at += word.len();
    }
    if begin < text.len() || out.is_empty() {
        out.push(Run { text: &text[begin..], lowered: false });
    }
    out
}

/// The width of a line of words in the font of pictures.
///
/// ```
/// use jurist_draw::scene::width;
/// assert!(width("K_pwm", 12.0) < width("Kpwm", 12.0));
/// ```
pub fn width(text: &str, size: f64) -> f64 {
    runs(text).iter().map(|r| font::advance(r.text, if r.lowered { INDEX_SIZE * size } else { size })).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_found_in_short_names_only() {
        let cut = |text| runs(text).iter().map(|r| (r.text, r.lowered)).collect::<Vec<_>>();
        assert_eq!(cut("K_pwm = 3"), [("K", false), ("pwm", true), (" = 3", false)]);
        assert_eq!(cut("no_index, my_long_name"), [("no", false), ("index", true), (", my_long_name", false)]);
        assert_eq!(cut("speed_ref"), [("speed_ref", false)]);
        assert_eq!(cut("a_1b_2"), [("a_1b_2", false)]);
        assert_eq!(cut(""), [("", false)]);
        assert_eq!(cut("(i_a)"), [("(i", false), ("a", true), (")", false)]);
    }
}
