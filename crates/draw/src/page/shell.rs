//! What every page begins and ends with.

use jurist_show::layout::visible;

/// An HTML page that loads nothing from anywhere: a title (plain text), its style, and the body. With `script_allowed` the
/// page's own script may run, else none.
///
/// ```
/// let page = jurist_draw::page::document("a < b", "p{color:red}", "<p>text</p>\n", false);
/// assert!(page.contains("<title>a &lt; b</title>") && page.ends_with("<p>text</p>\n</body>\n</html>\n"));
/// ```
pub fn document(title: &str, style: &str, body: &str, script_allowed: bool) -> String {
    let script = if script_allowed { "; script-src 'unsafe-inline'" } else { "" };
    let title = escaped(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'{script}\">\n\
         <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )
}

/// Text as HTML shows it: marks of HTML as entities, control characters made visible.
pub fn escaped(text: &str) -> String {
    visible(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
