//! The page of slices: the map of each, and a slider that shows one of them.

use super::map::{SCRIPT, certain, data, fields, style};
use super::{document, escaped};
use crate::figures::map::{MapContents, MapFigure, common_legend, slice_name};
use jurist_algebra::limits::Budget;
use jurist_engine::answer::{Answer, Body, Map};
use jurist_engine::error::Error;
use jurist_show::documents::Exact;
use jurist_show::layout::named_values;
use jurist_show::{body_rows, body_sentences};
use serde_json::{Value, json};

/// What the page has beyond that of one map.
const SLICES_STYLE: &str = "\
.slider{display:grid;grid-template-columns:auto 1fr auto;gap:.6rem;align-items:center;margin:.6rem 0}
.slider input{padding:0;border:0;background:none;accent-color:var(--ink)}.slider output{font-weight:bold;min-width:7rem;text-align:right}
[hidden]{display:none}
.table{overflow-x:auto}table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums}
caption{text-align:left;font-style:italic;padding-bottom:.2rem}
th,td{padding:.15rem .9rem .15rem 0;text-align:left;white-space:nowrap;border-bottom:1px solid var(--rule)}
tr[aria-current=true]{background:var(--card);font-weight:bold}
";

/// Slices as an HTML page that needs nothing from outside: the picture of one slice, for wide and for narrow screens, which a
/// slider chooses; the verdict at the pointer, looked up exactly in that slice; a table of all slices and sentences about how
/// far they reach.
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out.
///
/// # Panics
/// Unless each slice that is decided has its contents, and at least one is.
pub fn body_page(
    answer: &Answer<Body>,
    contents: &[Option<MapContents<'_>>],
    sizes: [(f64, f64); 2],
    digits: usize,
    budget: &Budget,
) -> Result<String, Error> {
    let (problem, slices) = (answer.problem(), &answer.value().slices);
    assert_eq!(slices.len(), contents.len(), "each slice has its place");
    let [x, y, z] = problem.free() else { unreachable!("a body has three free parameters") };
    let title = match problem.title().filter(|t| !t.is_empty()) {
        Some(title) => format!("Stability map in slices: {title}"),
        None => "Stability map in slices".to_owned(),
    };
    let others = match problem.set() {
        [] => "Every other quantity has its value in the model.".to_owned(),
        set => format!("With {}.", named_values(set)),
    };
    let first = first_shown(answer);
    let (pictures, known) = drawn_slices(answer, contents, (sizes, first), budget)?;
    let shown: Vec<String> = slices.iter().map(|slice| slice_name(answer, &slice.value)).collect();
    let axes = known.iter().find_map(|slice| slice.get("axes")).cloned();
    let data = json!({
        "name": z.name,
        "values": slices.iter().map(|slice| Exact::from(&slice.value)).collect::<Vec<_>>(),
        "shown": shown,
        "first": first,
        "axes": axes,
        "slices": known,
    });
    let data = data.to_string().replace('<', "\\u003c");
    let sentences: String =
        body_sentences(answer, digits).iter().map(|text| format!("<li>{}</li>\n", escaped(text))).collect();
    let body = format!(
        "<h1>{title}</h1>\n\
         <p class=\"small\">{x_name} from left to right, {y_name} upwards, {count} values of {z_name}. {others}</p>\n\
         <div class=\"slider screen\"><label for=\"slice\">{z_name}</label>\
         <input type=\"range\" id=\"slice\" min=\"0\" max=\"{last}\" step=\"1\" value=\"{first}\" autocomplete=\"off\">\
         <output id=\"at\" for=\"slice\">{at}</output></div>\n\
         {pictures}{fields}\
         <p class=\"small screen\">Move the slider, also with the arrow keys; move the pointer over the picture, tap, use the arrow keys \
         there (with Shift in larger steps), or enter exact values: 110, 1e-4, 1/3.</p>\n\
         <h2>Slices</h2>\n{table}<ul class=\"small\">\n{sentences}</ul>\n\
         <h2>What is certain</h2>\n<p class=\"small\">Each slice is exact, and so is every limit in the table and below it, rounded. Of \
         values of {z_name} between two slices nothing is said but what stands there. {certain}</p>\n\
         <script type=\"application/json\" id=\"data\">{data}</script>\n<script>\n{SCRIPT}</script>\n",
        title = escaped(&title),
        x_name = escaped(&x.name),
        y_name = escaped(&y.name),
        z_name = escaped(&z.name),
        count = slices.len(),
        last = slices.len() - 1,
        at = escaped(&shown[first]),
        others = escaped(&others),
        fields = fields(x, y),
        table = table(answer, first),
        certain = certain(slices.iter().filter_map(|slice| slice.map.as_ref().ok())),
    );
    Ok(document(&title, &format!("{}{SLICES_STYLE}", style()), &body, true))
}

/// The pictures of all slices and the data of each for the script. The page shows one picture.
fn drawn_slices(
    answer: &Answer<Body>,
    contents: &[Option<MapContents<'_>>],
    (sizes, first): ([(f64, f64); 2], usize),
    budget: &Budget,
) -> Result<(String, Vec<Value>), Error> {
    let legend = common_legend(contents);
    let (mut pictures, mut known) = (String::new(), Vec::new());
    for (k, (slice, contents)) in answer.value().slices.iter().zip(contents).enumerate() {
        let name = slice_name(answer, &slice.value);
        let (inside, data) = match (contents, &slice.map) {
            (Some(contents), Ok(map)) => {
                let figures = sizes.map(|(width, height)| contents.draw_under(width, height, &legend));
                (drawn(&figures, k), slice_data(&name, map, contents, &figures, budget)?)
            }
            (_, Err(stopped)) => {
                (format!("<p>{}</p>", escaped(&format!("{name} is not decided: {stopped}"))), Value::Null)
            }
            (None, Ok(_)) => panic!("a slice that is decided has its contents"),
        };
        let hidden = if k == first { "" } else { " hidden" };
        pictures.push_str(&format!("<div class=\"slice\"{hidden}>{inside}</div>\n"));
        known.push(data);
    }
    Ok((pictures, known))
}

/// The picture of a slice for wide and for narrow screens, with names of its own in the page.
fn drawn(figures: &[MapFigure; 2], number: usize) -> String {
    let picture = |(figure, class): (&MapFigure, &str)| {
        format!("<div class=\"figure {class}\">{}</div>\n", figure.figure.svg_named(&format!("{class}-{number}")))
    };
    figures.iter().zip(["wide", "narrow"]).map(picture).collect()
}

/// The slice nearest to the nominal value, else the middle one of those with stable points.
fn first_shown(answer: &Answer<Body>) -> usize {
    let slices = &answer.value().slices;
    let decided: Vec<usize> = (0..slices.len()).filter(|&k| slices[k].map.is_ok()).collect();
    let nominal = answer.problem().free()[2].nominal.as_ref();
    let nearest = nominal.and_then(|at| decided.iter().copied().min_by_key(|&k| (&slices[k].value - at).abs()));
    let stable: Vec<usize> = decided.iter().copied().filter(|&k| slices[k].has_stable_points() == Some(true)).collect();
    let middle = |list: &[usize]| list.get(list.len() / 2).copied();
    nearest.or_else(|| middle(&stable)).or_else(|| middle(&decided)).unwrap_or(0)
}

/// What the script needs of a slice.
fn slice_data(
    name: &str,
    map: &Answer<Map>,
    contents: &MapContents<'_>,
    figures: &[MapFigure; 2],
    budget: &Budget,
) -> Result<Value, Error> {
    let mut data = data(map, contents, figures, budget)?;
    data["label"] = format!("{} at {name}", data["label"].as_str().unwrap_or_default()).into();
    Ok(data)
}

/// The rows of the text as a table.
fn table(answer: &Answer<Body>, shown: usize) -> String {
    let cells = |row: &[String], tag: &str| -> String {
        let missing = 4usize.saturating_sub(row.len());
        let span = |k: usize| {
            if k + 1 == row.len() && missing > 0 { format!(" colspan=\"{}\"", missing + 1) } else { String::new() }
        };
        row.iter().enumerate().map(|(k, cell)| format!("<{tag}{}>{}</{tag}>", span(k), escaped(cell))).collect()
    };
    let rows = body_rows(answer);
    let row =
        |(k, row): (usize, &Vec<String>)| format!("<tr aria-current=\"{}\">{}</tr>\n", k == shown, cells(row, "td"));
    let body: String = rows[1..].iter().enumerate().map(row).collect();
    format!(
        "<div class=\"table\"><table id=\"slices\"><caption>Stable regions of each slice</caption>\n\
         <thead><tr>{}</tr></thead>\n<tbody>\n{body}</tbody></table></div>\n",
        cells(&rows[0], "th")
    )
}
