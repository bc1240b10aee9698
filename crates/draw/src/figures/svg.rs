//! What is done to the plotting library's SVG: names, coordinates, indices.

/// The text with `prefix` and the number behind it replaced by `new` and a number that is counted
/// from 0 in the order of appearance: the plotting library counts through the whole process, and
/// equal data shall give equal bytes.
pub(super) fn renumbered(text: &str, prefix: &str, new: &str) -> String {
    let mut parts = text.split(prefix);
    let mut out = parts.next().unwrap_or_default().to_string();
    let mut seen: Vec<&str> = Vec::new();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (number, rest) = part.split_at(digits);
        let place = seen.iter().position(|s| *s == number).unwrap_or_else(|| {
            seen.push(number);
            seen.len() - 1
        });
        out.push_str(&format!("{new}{place}{rest}"));
    }
    out
}

/// The SVG with names of one letter and an index, such as `K_pwm`, set with the index below.
pub(super) fn indexed(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some(begin) = rest.find("<text ").and_then(|at| Some(at + rest[at..].find('>')? + 1)) {
        let end = rest[begin..].find('<').map_or(rest.len(), |n| begin + n);
        out.push_str(&rest[..begin]);
        out.push_str(&with_indices(&rest[begin..end]));
        rest = &rest[end..];
    }
    out + rest
}

/// The SVG with at most two decimals in the coordinates, which no screen and no printer shows more of.
pub(super) fn rounded(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut inside_tag = false;
    let mut rest = svg;
    while let Some(at) = rest.find(['<', '>', '.']) {
        let (before, mark) = rest.split_at(at);
        out.push_str(before);
        rest = &mark[1..];
        if !mark.starts_with('.') {
            inside_tag = mark.starts_with('<');
            out.push_str(&mark[..1]);
            continue;
        }
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let whole = out.len() - out.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        if !inside_tag || digits <= 2 || whole == 0 {
            out.push('.');
            continue;
        }
        let begin = out.len() - whole;
        let number = format!("{}.{}", &out[begin..], &rest[..digits]);
        out.truncate(begin);
        let short = number.parse::<f64>().map_or(number, |v| format!("{v:.2}"));
        out.push_str(short.trim_end_matches('0').trim_end_matches('.'));
        rest = &rest[digits..];
    }
    out + rest
}

/// Words with their indices lowered: `K_pwm` becomes K and a smaller, lower pwm.
fn with_indices(words: &str) -> String {
    let mut out = String::new();
    let mut lowered = false;
    for word in words.split_inclusive(|c: char| !c.is_alphanumeric() && c != '_') {
        let name = word.trim_end_matches(|c: char| !c.is_alphanumeric() && c != '_');
        let after = &word[name.len()..];
        match name.split_once('_') {
            Some((base, index)) if base.chars().count() == 1 && !index.is_empty() && !index.contains('_') => {
                raised(&mut out, base, lowered);
                out.push_str(&format!("<tspan dy=\"0.25em\" font-size=\"75%\">{index}</tspan>"));
                lowered = true;
                raised(&mut out, after, lowered);
                lowered = after.is_empty();
            }
            _ => {
                raised(&mut out, word, lowered);
                lowered = lowered && word.is_empty();
            }
        }
    }
    out
}

/// Text at the usual height, after an index back up from it (0.25 of 75 % of the size).
fn raised(out: &mut String, text: &str, lowered: bool) {
    if lowered && !text.is_empty() {
        out.push_str(&format!("<tspan dy=\"-0.1875em\">{text}</tspan>"));
    } else {
        out.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clip_paths_are_counted_anew_under_a_new_name() {
        assert_eq!(renumbered("id=c-7 #c-7 id=c-9 #c-7", "c-", "f-"), "id=f-0 #f-0 id=f-1 #f-0");
        assert_eq!(renumbered("nothing", "c-", "f-"), "nothing");
    }

    #[test]
    fn coordinates_are_short_and_words_are_not_touched() {
        let svg = rounded("<line x=\"40.300000000000004\" y=\"-7.99999\" d=\"M1.255,2L3.5\"/><text>0.0381</text>");
        assert_eq!(svg, "<line x=\"40.3\" y=\"-8\" d=\"M1.25,2L3.5\"/><text>0.0381</text>");
    }

    #[test]
    fn indices_stand_below_in_words_and_nowhere_else() {
        let svg = indexed("<g id=\"a_b\"><text x=\"1\">K_pwm = 3</text><text>no_index, my_long_name</text></g>");
        assert!(svg.starts_with("<g id=\"a_b\"><text x=\"1\">K<tspan "), "{svg}");
        assert!(svg.contains(">pwm</tspan><tspan dy=\"-0.1875em\"> </tspan>= 3</text>"), "{svg}");
        assert!(svg.ends_with("<text>no_index, my_long_name</text></g>"), "{svg}");
        assert_eq!(with_indices("T"), "T");
    }
}
