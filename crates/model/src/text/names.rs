//! Names in messages: suggestions, shortening, lists.

use std::borrow::Cow;
use std::collections::HashSet;

/// Names longer than this are cut in messages.
const SHOWN: usize = 60;

/// Names longer than this are not compared for suggestions; the comparison is quadratic.
const COMPARED: usize = 80;

/// At most this many candidates are compared.
const CANDIDATES: usize = 2000;

/// The name, cut where it would flood the message.
pub fn shorten(name: &str) -> Cow<'_, str> {
    match name.char_indices().nth(SHOWN) {
        Some((end, _)) => Cow::Owned(format!("{}...", &name[..end])),
        None => Cow::Borrowed(name),
    }
}

/// The candidate that `name` was probably meant to be.
///
/// ```
/// use jurist_model::nearest_name;
/// assert_eq!(nearest_name("K_pmw", ["T", "K_pwm"]), Some("K_pwm"));
/// assert_eq!(nearest_name("x", ["T", "K_pwm"]), None);
/// ```
pub fn nearest_name<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > COMPARED {
        return None;
    }
    let mut best: Option<(f64, &str)> = None;
    for candidate in candidates.into_iter().filter(|c| c.len() <= COMPARED && *c != name).take(CANDIDATES) {
        // Likeness for display only; nothing is decided by it.
        let folded = candidate.to_lowercase() == name.to_lowercase();
        let transposed = strsim::osa_distance(name, candidate) <= 1 && name.chars().count() > 1;
        let likeness_for_display = if folded || transposed { 1.0 } else { strsim::jaro_winkler(name, candidate) };
        if likeness_for_display >= 0.8 && best.is_none_or(|(b, _)| likeness_for_display > b) {
            best = Some((likeness_for_display, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// The help that goes with a name that is not known.
pub(crate) fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    nearest_name(name, candidates).map(|c| format!("did you mean '{c}'?"))
}

/// `'a', 'b' and 'c'`.
pub(crate) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|n| format!("'{}'", shorten(n))).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((only, [])) => only.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// The names of a list for a message, each once.
pub(crate) fn known_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let mut seen = HashSet::new();
    let names: Vec<&str> = names.into_iter().filter(|n| seen.insert(*n)).take(8).collect();
    (!names.is_empty()).then(|| format!("known here: {}", list(names)))
}
