//! The layout of certificates: JSON with line breaks between its parts.

use serde_json::Value;

/// Longer texts are not read by the checkers.
pub(super) const MAX_TEXT: usize = 64 << 20;

/// The text of a certificate: short lists and objects on one line, the items of others on a line each.
pub(super) fn to_text(value: &Value) -> String {
    let mut out = String::new();
    write(value, &mut out, 0);
    out.push('\n');
    out
}

fn is_short(value: &Value) -> bool {
    match value {
        Value::Array(items) => items.len() <= 8 && items.iter().all(|i| !i.is_array() && !i.is_object()),
        Value::Object(pairs) => pairs.len() <= 6 && pairs.values().all(is_short),
        _ => true,
    }
}

fn write(value: &Value, out: &mut String, depth: usize) {
    match value {
        Value::Array(items) => {
            between(value, ['[', ']'], items.iter(), out, depth, |item, out| write(item, out, depth + 1));
        }
        Value::Object(pairs) => between(value, ['{', '}'], pairs.iter(), out, depth, |(key, item), out| {
            out.push_str(&Value::from(key.as_str()).to_string());
            out.push_str(": ");
            write(item, out, depth + 1);
        }),
        other => out.push_str(&other.to_string()),
    }
}

fn between<T>(
    whole: &Value,
    [open, close]: [char; 2],
    items: impl Iterator<Item = T>,
    out: &mut String,
    depth: usize,
    write: impl Fn(T, &mut String),
) {
    out.push(open);
    for (i, item) in items.enumerate() {
        out.push_str(if i > 0 { "," } else { "" });
        if is_short(whole) {
            out.push_str(if i > 0 { " " } else { "" });
        } else {
            out.push('\n');
            out.extend(std::iter::repeat_n(' ', depth + 1));
        }
        write(item, out);
    }
    out.push(close);
}
