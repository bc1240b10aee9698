//! A page of a map by boxes.

use super::{document, escaped};
use crate::figures::Figure;
use jurist_engine::answer::{Answer, MapBoxes};

const STYLE: &str = "\
body{font-family:sans-serif;max-width:60rem;margin:1rem auto;padding:0 1rem}
svg{width:100%;height:auto}
pre{white-space:pre-wrap}
";

/// The picture and the text as a page that stands alone.
pub fn map_boxes_page(answer: &Answer<MapBoxes>, figure: &Figure, digits: usize) -> String {
    let body = format!(
        "{}\n<pre>{}</pre>\n\
         <p>Every verdict is proved for the whole box; positions in the picture are drawn in floating point.</p>\n",
        figure.svg(),
        escaped(&answer.text(digits)),
    );
    document(answer.problem().title().unwrap_or("the loop"), STYLE, &body, false)
}
