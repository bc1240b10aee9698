//! Forgeries: a line that is changed, with the claim that the changed line shows.

use jurist_check::format::Json;

fn object(pairs: Vec<(&str, Json)>) -> Json {
    Json::Object(pairs.into_iter().map(|(k, v)| (k.to_owned(), v)).collect())
}

fn with(json: &Json, key: &str, value: Json) -> Json {
    let Json::Object(pairs) = json else { return json.clone() };
    let pairs = pairs.iter().map(|(k, v)| (k.clone(), if k == key { value.clone() } else { v.clone() }));
    Json::Object(pairs.collect())
}

/// The end that a point of the line is.
fn end(point: &Json, factors: &[Json]) -> Json {
    match (point.get("at"), point.get("between"), point.get("factor")) {
        (Some(q), _, _) => q.clone(),
        (_, Some(between), Some(Json::Count(k))) => {
            let factor = factors.get(*k as usize).cloned().unwrap_or(Json::Null);
            object(vec![("polynomial", factor), ("between", between.clone())])
        }
        _ => Json::Null,
    }
}

/// The certificate with another line, and the claim of that line.
fn with_line(certificate: &Json, line: Vec<Json>) -> Option<Json> {
    let statement = certificate.get("statement")?;
    let domain = statement.get("domain")?;
    let Some(Json::List(factors)) = certificate.get("factors") else { return None };
    let ends: Vec<Json> = std::iter::once(domain.get("lower")?.clone())
        .chain(line.iter().skip(1).step_by(2).map(|point| end(point, factors)))
        .chain([domain.get("upper")?.clone()])
        .collect();
    let stable =
        line.iter().step_by(2).zip(ends.windows(2)).filter(|(s, _)| s.get("stable") == Some(&Json::Bool(true)));
    let claim = stable.map(|(_, ends)| object(vec![("lower", ends[0].clone()), ("upper", ends[1].clone())])).collect();
    let statement = with(statement, "stable", Json::List(claim));
    Some(with(&with(certificate, "statement", statement), "line", Json::List(line)))
}

/// All forgeries by one change of the line: a label turned; a point left out with one of the two stretches beside it, their split
/// points joined or not; a point and a stretch twice; a sample taken from another stretch, with its label.
pub fn forgeries(certificate: &Json) -> Vec<Json> {
    let Some(Json::List(line)) = certificate.get("line") else { return Vec::new() };
    let mut lines = Vec::new();
    let turned = |stretch: &Json| match stretch.get("stable") {
        Some(Json::Bool(b)) => with(stretch, "stable", Json::Bool(!b)),
        _ => stretch.clone(),
    };
    let splits = |stretch: &Json| match stretch.get("split") {
        Some(Json::List(points)) => points.clone(),
        _ => Vec::new(),
    };
    for i in (0..line.len()).step_by(2) {
        let mut changed = line.clone();
        changed[i] = turned(&line[i]);
        lines.push(changed);
        for j in (0..line.len()).step_by(2).filter(|j| *j != i) {
            let mut changed = line.clone();
            changed[i] = with(&line[j], "split", Json::List(splits(&line[i])));
            lines.push(changed);
        }
    }
    for i in (1..line.len()).step_by(2) {
        let at = line[i].get("at").cloned().into_iter();
        let joined: Vec<Json> = splits(&line[i - 1]).into_iter().chain(splits(&line[i + 1])).collect();
        let at_point: Vec<Json> = splits(&line[i - 1]).into_iter().chain(at).chain(splits(&line[i + 1])).collect();
        for (keep, drop) in [(i - 1, i + 1), (i + 1, i - 1)] {
            for split in [splits(&line[keep]), joined.clone(), at_point.clone()] {
                let mut changed = line.clone();
                changed[keep] = with(&line[keep], "split", Json::List(split));
                let (first, last) = (drop.min(i), drop.max(i));
                changed.drain(first..=last);
                lines.push(changed);
            }
        }
        let mut doubled = line.clone();
        doubled.splice(i..i, [line[i].clone(), line[i + 1].clone()]);
        lines.push(doubled);
    }
    lines.into_iter().filter_map(|line| with_line(certificate, line)).collect()
}
