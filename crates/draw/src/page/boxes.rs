//! A page of a map by boxes.

use super::{document, escaped};
use crate::figures::{Figure, dark_style};
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_show::Text;

const STYLE: &str = "\
:root{color-scheme:light dark}
body{font-family:sans-serif;max-width:60rem;margin:1rem auto;padding:0 1rem}
svg{width:100%;height:auto}
pre{white-space:pre-wrap}
";

/// The picture and the text as a page that stands alone.
pub fn map_boxes_page(answer: &Answer<MapBoxes>, figure: &Figure, digits: usize) -> String {
    let body = format!(
        "<div class=\"figure\">{}</div>\n<pre>{}</pre>\n\
         <p>Every verdict is proved for the whole box; positions in the picture are drawn in floating point.</p>\n",
        figure.svg(),
        answer.text(digits).lines().map(escaped).collect::<Vec<_>>().join("\n"),
    );
    let dark = dark_style(".figure");
    let style = format!(
        "{STYLE}@media screen and (prefers-color-scheme:dark){{\nbody{{background:#15171a;color:#e3e3e3}}\n{dark}}}\n"
    );
    document(answer.problem().title().unwrap_or("the loop"), &style, &body, false)
}
