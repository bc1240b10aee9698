//! A page of a map by boxes.

use super::map::escaped;
use crate::figures::Figure;
use jurist_engine::answer::{Answer, MapBoxes};
use jurist_engine::show::layout::called;

/// The picture and the text as a page that stands alone.
pub fn map_boxes_page(answer: &Answer<MapBoxes>, figure: &Figure, digits: usize) -> String {
    let title = escaped(&called(answer.problem().title()));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{title}</title>\
         <style>body{{font-family:sans-serif;max-width:60rem;margin:1rem auto;padding:0 1rem}}svg{{width:100%;height:auto}}\
         pre{{white-space:pre-wrap}}</style></head>\n<body>\n{}\n<pre>{}</pre>\n\
         <p>Every verdict is proved for the whole box; positions in the picture are drawn in floating point.</p>\n\
         </body>\n</html>\n",
        figure.svg(),
        escaped(&answer.text(digits)),
    )
}
