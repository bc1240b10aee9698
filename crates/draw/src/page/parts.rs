//! Sections, tables and mathematics of a report in HTML that needs nothing from outside.

use super::words::{Token, is_variable, tokens};
use super::{document, escaped};
use crate::figures::{Figure, dark_style};

/// A table of plain text; names such as `K_pwm` in it are set as mathematics.
///
/// ```
/// use jurist_draw::page::Table;
/// let mut table = Table::new("Limits", &["name", "limit"]);
/// table.rows.push(vec!["K_pwm".into(), "550.9 V".into()]);
/// assert!(table.html().contains("<i>K</i><sub>pwm</sub>"));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Column heads.
    pub head: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table.
    pub fn new(caption: &str, head: &[&str]) -> Table {
        Table { caption: caption.to_owned(), head: head.iter().map(|h| (*h).to_owned()).collect(), rows: Vec::new() }
    }

    /// The table in a box of its own that scrolls where the window is narrow.
    pub fn html(&self) -> String {
        let cells = |row: &[String], tag: &str| -> String {
            let short = |c: &str| if c.chars().count() <= 20 { " class=\"s\"" } else { "" };
            row.iter().map(|c| format!("<{tag}{}>{}</{tag}>", short(c), math(c))).collect()
        };
        let rows: String = self.rows.iter().map(|r| format!("<tr>{}</tr>\n", cells(r, "td"))).collect();
        let head = if self.head.is_empty() {
            String::new()
        } else {
            format!("<thead><tr>{}</tr></thead>\n", cells(&self.head, "th"))
        };
        format!(
            "<div class=\"wide\"><table><caption>{}</caption>\n{head}<tbody>\n{rows}</tbody></table></div>\n",
            math(&self.caption)
        )
    }
}

/// Text with names, powers and products set as mathematics: `K_pwm*T^2` with an index and a power. What HTML would
/// read as its own is escaped.
///
/// ```
/// assert_eq!(jurist_draw::page::math("T^2 < 3"), "<i>T</i><sup>2</sup> &lt; 3");
/// ```
pub fn math(text: &str) -> String {
    let piece = |token: Token| match token {
        Token::Word(word) => name(&word),
        Token::Number(digits, None) => digits,
        Token::Number(digits, Some(power)) => format!("{digits}·10<sup>{}</sup>", power.replace('-', "−")),
        Token::Power(power) => format!("<sup>{power}</sup>"),
        Token::Sign('*') => "·".to_owned(),
        Token::Sign('-') => "−".to_owned(),
        Token::Sign(c) => escaped(&c.to_string()),
    };
    tokens(text).into_iter().map(piece).collect()
}

fn name(word: &str) -> String {
    let greek = |part: &str| part.replace("omega", "ω").replace("eps", "ε");
    match word.split_once('_') {
        Some((base, index)) if !base.is_empty() && !index.is_empty() => {
            format!("<i>{}</i><sub>{}</sub>", greek(base), escaped(index))
        }
        _ if is_variable(word) => {
            format!("<i>{}</i>", greek(word))
        }
        _ => escaped(word),
    }
}

/// A figure with its caption, inline; the name belongs to no other figure of the page.
///
/// ```
/// use jurist_draw::figures::Sketch;
/// use jurist_draw::page::figure;
/// let html = figure("fig-1", &Sketch::new(10.0, 10.0).finish(), "Fig. 1: nothing");
/// assert!(html.starts_with("<figure>") && html.contains("<figcaption>"));
/// ```
pub fn figure(name: &str, figure: &Figure, caption: &str) -> String {
    // Narrower than this its words cannot be read; a phone then scrolls the figure, not the page.
    let narrowest = 0.65 * figure.size().0;
    let svg = figure.svg_named(name).replacen("<svg ", &format!("<svg style=\"min-width:{narrowest:.0}px\" "), 1);
    format!("<figure><div class=\"wide\">{svg}</div><figcaption>{}</figcaption></figure>\n", math(caption))
}

/// A paragraph; its text is HTML.
///
/// ```
/// assert_eq!(jurist_draw::page::paragraph("<b>exact</b>"), "<p><b>exact</b></p>\n");
/// ```
pub fn paragraph(html: &str) -> String {
    format!("<p>{html}</p>\n")
}

/// A matrix of expressions in brackets, with its name.
///
/// ```
/// let html = jurist_draw::page::matrix("A", &[vec!["-R/L".to_owned()]]);
/// assert!(html.contains("<td>−<i>R</i>/<i>L</i></td>"));
/// ```
pub fn matrix(name: &str, rows: &[Vec<String>]) -> String {
    let row = |r: &Vec<String>| {
        let cells: String = r.iter().map(|c| format!("<td>{}</td>", math(c))).collect();
        format!("<tr>{cells}</tr>")
    };
    let rows: String = rows.iter().map(row).collect();
    format!("<div class=\"wide eq\"><span>{} =</span><table class=\"matrix\">{rows}</table></div>\n", math(name))
}

/// A part of a report with its heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// The name that links lead to.
    pub id: &'static str,
    /// The heading, plain text.
    pub heading: &'static str,
    /// What stands below it, HTML.
    pub html: String,
}

/// The whole page: a title (plain text), what comes first (HTML), contents, and sections with anchors.
///
/// ```
/// use jurist_draw::page::{Section, report_page};
/// let html = report_page("a < b", "", &[Section { id: "limits", heading: "Limits", html: "<p>none</p>\n".into() }]);
/// assert!(html.contains("<h1>a &lt; b</h1>") && html.contains("<a href=\"#limits\">Limits</a>"));
/// ```
pub fn report_page(title: &str, lead: &str, sections: &[Section]) -> String {
    let link = |s: &Section| format!("<li><a href=\"#{}\">{}</a></li>", s.id, escaped(s.heading));
    let contents: String = sections.iter().map(link).collect();
    let part =
        |s: &Section| format!("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", s.id, escaped(s.heading), s.html);
    let body: String = sections.iter().map(part).collect();
    let body = format!("<h1>{}</h1>\n{lead}<nav><ol>{contents}</ol></nav>\n{body}", escaped(title));
    let dark = dark_style("figure");
    let style = format!("{STYLE}@media screen and (prefers-color-scheme:dark){{\n{DARK}{dark}}}\n");
    document(title, &style, &body, false)
}

/// What is another colour on dark ground, figures apart.
const DARK: &str = "\
body{color:#e3e3e3;background:#15171a}a{color:#5db8ee}
h2{border-color:#4a4f55}th,td{border-color:#33383d}
";

const STYLE: &str = "\
:root{color-scheme:light dark}
body{font:16px/1.5 Georgia,'DejaVu Serif',serif;color:#222;background:#fff;max-width:68rem;margin:0 auto;padding:0 1rem 3rem}
h1,h2,h3{font-family:Verdana,'DejaVu Sans',sans-serif;line-height:1.25}
h1{font-size:1.5rem}h2{font-size:1.2rem;border-bottom:1px solid #bbb;margin-top:2.5rem}h3{font-size:1rem}
p,li{max-width:44rem;overflow-wrap:anywhere}
.wide{overflow-x:auto;margin:1rem 0}
table{min-width:20rem;border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
caption{text-align:left;font-style:italic;padding-bottom:.3rem}
th,td{padding:.2rem .6rem;text-align:left;vertical-align:top;border-bottom:1px solid #ddd}
.s{white-space:nowrap}
.eq{display:flex;align-items:center;gap:.6rem}.eq span{white-space:nowrap}
.matrix{min-width:0;background:linear-gradient(currentColor,currentColor) 0 0/7px 2px,linear-gradient(currentColor,currentColor) 0 100%/7px 2px,\
linear-gradient(currentColor,currentColor) 100% 0/7px 2px,linear-gradient(currentColor,currentColor) 100% 100%/7px 2px;background-repeat:no-repeat;\
border-left:2px solid currentColor;border-right:2px solid currentColor;print-color-adjust:exact;-webkit-print-color-adjust:exact}
.matrix td{border:0;text-align:center;white-space:nowrap}
figure{margin:1rem 0;break-inside:avoid}figure .wide{margin:0 0 .2rem}figure svg{width:100%;height:auto;max-width:64rem}
figcaption{font-size:.9rem}
.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(17rem,1fr));gap:.5rem}
pre{overflow-x:auto;font-size:.75rem}
sub,sup{line-height:0}
@media screen{table:not(.matrix) td:not(.s){min-width:11rem}}
@media print{table,figcaption{font-size:8pt}body{max-width:none;font-size:10pt;padding:0}nav{display:none}.wide{overflow:visible;break-inside:avoid}figure svg{min-width:0!important}figure{margin:.3rem 0}h2,h3,caption,h3+p{break-after:avoid}tr{break-inside:avoid}p,li{max-width:none;orphans:3;widows:3}pre{white-space:pre-wrap}.grid{grid-template-columns:repeat(3,1fr);break-inside:avoid}.grid.two{grid-template-columns:repeat(2,1fr)}th,td{padding:.15rem .35rem}}
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mathematics() {
        assert_eq!(math("-K_a*T^2/J"), "−<i>K</i><sub>a</sub>·<i>T</i><sup>2</sup>/<i>J</i>");
        assert_eq!(math("1.5e-3 < x"), "1.5·10<sup>−3</sup> &lt; <i>x</i>");
        assert_eq!(math("<script>"), "&lt;script&gt;");
        assert_eq!(math("class-C chopper, -T"), "class-C chopper, −<i>T</i>");
        assert_eq!(math("R_a-T"), "<i>R</i><sub>a</sub>−<i>T</i>");
    }
}
