//! Sections, tables and mathematics in HTML that needs nothing from outside.

use super::super::figures::Figure;

/// A table of plain text; names such as `K_pwm` in it are set as mathematics.
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
    pub(super) fn new(caption: &str, head: &[&str]) -> Table {
        Table { caption: caption.to_owned(), head: head.iter().map(|h| (*h).to_owned()).collect(), rows: Vec::new() }
    }

    pub(super) fn html(&self) -> String {
        let cells = |row: &[String], tag: &str| -> String {
            row.iter().map(|c| format!("<{tag}>{}</{tag}>", math(c))).collect()
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

    /// The table as a LaTeX `tabular`.
    pub(super) fn latex(&self) -> String {
        let line = |row: &[String]| {
            let cells: Vec<String> = row.iter().map(|c| latex_text(c)).collect();
            format!("{} \\\\\n", cells.join(" & "))
        };
        let columns = self.head.len().max(self.rows.iter().map(Vec::len).max().unwrap_or(1));
        let body: String = self.rows.iter().map(|r| line(r)).collect();
        format!(
            "% {}\n\\begin{{tabular}}{{{}}}\n\\hline\n{}\\hline\n{body}\\hline\n\\end{{tabular}}\n",
            self.caption,
            "l".repeat(columns),
            line(&self.head)
        )
    }
}

fn latex_text(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '_' | '%' | '&' | '#' | '$' | '{' | '}' => out.extend(['\\', c]),
            '^' => out.push_str("\\^{}"),
            '|' => out.push_str("$|$"),
            '<' => out.push_str("$<$"),
            '>' => out.push_str("$>$"),
            _ => out.push(c),
        }
    }
    out
}

/// Text with the characters that mean something in HTML replaced.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Text with names, powers and products set as mathematics: `K_pwm*T^2` with an index and a power.
pub(super) fn math(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut out = String::new();
    let mut i = 0;
    let while_ = |from: usize, test: &dyn Fn(char) -> bool| {
        (from..chars.len()).find(|k| !test(chars[*k])).unwrap_or(chars.len())
    };
    while i < chars.len() {
        let c = chars[i];
        if c.is_alphabetic() {
            let mut end = while_(i, &|c| c.is_alphanumeric() || c == '_');
            // A hyphen between words is no minus: class-C.
            while end > i + 1 && !chars[i..end].contains(&'_') && chars.get(end) == Some(&'-') {
                match chars.get(end + 1) {
                    Some(c) if c.is_alphabetic() => end = while_(end + 1, &|c| c.is_alphanumeric()),
                    _ => break,
                }
            }
            let word: String = chars[i..end].iter().collect();
            out.push_str(&name(&word));
            i = end;
        } else if c.is_ascii_digit() {
            let mut end = while_(i, &|c| c.is_ascii_digit() || c == '.');
            let digits: String = chars[i..end].iter().collect();
            out.push_str(&digits);
            let sign = usize::from(chars.get(end + 1).is_some_and(|c| *c == '-'));
            if chars.get(end) == Some(&'e') && chars.get(end + 1 + sign).is_some_and(char::is_ascii_digit) {
                let last = while_(end + 1 + sign, &|c| c.is_ascii_digit());
                let power: String = chars[end + 1..last].iter().collect();
                out.push_str(&format!("·10<sup>{}</sup>", power.replace('-', "−")));
                end = last;
            }
            i = end;
        } else if c == '^' {
            let end = while_(i + 1, &|c| c.is_ascii_digit());
            let power: String = chars[i + 1..end].iter().collect();
            out.push_str(&format!("<sup>{power}</sup>"));
            i = end;
        } else {
            match c {
                '*' => out.push('·'),
                '-' => out.push('−'),
                _ => out.push_str(&escaped(&c.to_string())),
            }
            i += 1;
        }
    }
    out
}

fn name(word: &str) -> String {
    let greek = |part: &str| part.replace("omega", "ω").replace("eps", "ε");
    match word.split_once('_') {
        Some((base, index)) if !base.is_empty() && !index.is_empty() => {
            format!("<i>{}</i><sub>{}</sub>", greek(base), escaped(index))
        }
        // The article, second and volt are no variables.
        _ if word == "omega" || word.chars().count() == 1 && !["a", "s", "V"].contains(&word) => {
            format!("<i>{}</i>", greek(word))
        }
        _ => escaped(word),
    }
}

/// A figure with its caption, inline; the name belongs to no other figure of the page.
pub(super) fn figure(name: &str, figure: &Figure, caption: &str) -> String {
    // Narrower than this its words cannot be read; a phone then scrolls the figure, not the page.
    let narrowest = 0.65 * figure.size().0;
    let svg = figure.svg_named(name).replacen("<svg ", &format!("<svg style=\"min-width:{narrowest:.0}px\" "), 1);
    format!("<figure><div class=\"wide\">{svg}</div><figcaption>{}</figcaption></figure>\n", math(caption))
}

/// A paragraph; its text may contain HTML.
pub(super) fn paragraph(html: &str) -> String {
    format!("<p>{html}</p>\n")
}

/// A matrix of expressions with its name.
pub(super) fn matrix(name: &str, rows: &[Vec<String>]) -> String {
    let row = |r: &Vec<String>| {
        let cells: String = r.iter().map(|c| format!("<td>{}</td>", math(c))).collect();
        format!("<tr>{cells}</tr>")
    };
    let rows: String = rows.iter().map(row).collect();
    format!("<div class=\"wide eq\"><span>{} =</span><table class=\"matrix\">{rows}</table></div>\n", math(name))
}

/// The whole page: sections with anchors, headings and contents.
pub(super) fn page(title: &str, sections: &[(&str, &str, String)]) -> String {
    let contents: String =
        sections.iter().map(|(id, head, _)| format!("<li><a href=\"#{id}\">{head}</a></li>")).collect();
    let body: String = sections
        .iter()
        .map(|(id, head, html)| format!("<section id=\"{id}\">\n<h2>{head}</h2>\n{html}</section>\n"))
        .collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<nav><ol>{contents}</ol></nav>\n{body}</body>\n</html>\n"
    )
}

const STYLE: &str = "\
body{font:16px/1.5 Georgia,'DejaVu Serif',serif;color:#222;background:#fff;max-width:68rem;margin:0 auto;padding:0 1rem 3rem}
h1,h2,h3{font-family:Verdana,'DejaVu Sans',sans-serif;line-height:1.25}
h1{font-size:1.5rem}h2{font-size:1.2rem;border-bottom:1px solid #bbb;margin-top:2.5rem}h3{font-size:1rem}
p,li{max-width:44rem}
.wide{overflow-x:auto;margin:1rem 0}
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
caption{text-align:left;font-style:italic;padding-bottom:.3rem}
th,td{padding:.2rem .6rem;text-align:left;vertical-align:top;border-bottom:1px solid #ddd}
.eq{display:flex;align-items:center;gap:.6rem}.eq span{white-space:nowrap}
.matrix{border-left:2px solid #222;border-right:2px solid #222}
.matrix td{border:0;text-align:center;white-space:nowrap}
figure{margin:1rem 0;break-inside:avoid}figure svg{width:100%;height:auto;max-width:64rem}
figcaption{font-size:.9rem}
.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(18rem,1fr));gap:.5rem}
pre{overflow-x:auto;font-size:.75rem}
sub,sup{line-height:0}
@media print{body{max-width:none;font-size:10pt;padding:0}nav{display:none}.wide{overflow:visible;break-inside:avoid}figure svg{min-width:0!important}figure{margin:.3rem 0}h2,h3,caption{break-after:avoid}tr{break-inside:avoid}p,li{max-width:none;orphans:3;widows:3}pre{white-space:pre-wrap}.grid{grid-template-columns:repeat(3,1fr);break-inside:avoid}.grid.two{grid-template-columns:repeat(2,1fr)}th,td{padding:.15rem .35rem}}
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
