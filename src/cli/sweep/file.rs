//! The file of a sweep: JSON lines or CSV, written whole at the end; beside it, while questions are open, the rows that are there.

use super::rows::Row;
use crate::cli::output::{ending, unknown_ending, write_error};
use crate::cli::status::Error;
use serde_json::Value;
use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// How rows are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cli) enum Format {
    /// An object on each line.
    JsonLines,
    /// A table with a head.
    Csv,
}

impl Format {
    /// By the file's ending; standard output gets JSON lines.
    pub fn of(file: Option<&OsString>) -> Result<Format, Error> {
        let Some(file) = file.filter(|file| *file != OsStr::new("-")) else { return Ok(Format::JsonLines) };
        match ending(file).as_deref() {
            Some("jsonl") => Ok(Format::JsonLines),
            Some("csv") => Ok(Format::Csv),
            _ => Err(unknown_ending(file, &["jsonl", "csv"]).into()),
        }
    }

    /// All rows as a text, `names` being the names that are swept over.
    pub fn text(self, rows: &[Row], names: &BTreeSet<String>) -> String {
        match self {
            Format::JsonLines => rows.iter().map(|row| line(row) + "\n").collect(),
            Format::Csv => csv(rows, names),
        }
    }
}

/// A row as JSON with a space behind each comma and colon, as Python writes it.
pub(in crate::cli) fn line(row: &Row) -> String {
    let text = |value: &Value| Value::to_string(value);
    let cell = |value: &Value| match value {
        Value::Array(items) => format!("[{}]", items.iter().map(text).collect::<Vec<_>>().join(", ")),
        Value::Number(number) if number.is_f64() => float(number.as_f64().unwrap_or_default()),
        other => text(other),
    };
    let cells: Vec<String> =
        row.iter().map(|(name, value)| format!("{}: {}", text(&name.as_str().into()), cell(value))).collect();
    format!("{{{}}}", cells.join(", "))
}

/// The shortest decimal that is this float, in Python's notation.
fn float(x: f64) -> String {
    let shortest = format!("{x:e}");
    let Some((digits, exponent)) = shortest.split_once('e') else { return shortest };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..16).contains(&exponent) {
        let plain = format!("{x}");
        return if plain.contains('.') { plain } else { plain + ".0" };
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{digits}e{sign}{:02}", exponent.abs())
}

/// The columns of a table, with the names that are swept over.
fn columns(names: &BTreeSet<String>) -> Vec<String> {
    let mut out = vec!["key".to_owned(), "model".to_owned()];
    out.extend(names.iter().map(|name| format!("p.{name}")));
    out.extend(["parameter", "interval"].map(str::to_owned));
    for side in ["lower", "upper"] {
        let parts = ["", "_decimal", "_exact", "_polynomial", "_enclosure", "_causes", "_closed", "_hz"];
        out.extend(parts.map(|part| format!("{side}{part}")));
    }
    let rest = ["verdict", "degree", "inside", "on", "outside", "infinite", "status", "code", "message"];
    out.extend(rest.map(str::to_owned));
    out
}

fn csv(rows: &[Row], names: &BTreeSet<String>) -> String {
    let columns = columns(names);
    let mut out = String::new();
    let mut write = |cells: Vec<String>| {
        out.push_str(&cells.join(","));
        out.push_str("\r\n");
    };
    write(columns.iter().map(|name| quoted(name)).collect());
    for row in rows {
        write(
            columns
                .iter()
                .map(|name| row.get(name).map_or_else(String::new, |value| quoted(&cell(name, value))))
                .collect(),
        );
    }
    out
}

/// A value as it stands in a table; lists are joined by `+`.
fn cell(column: &str, value: &Value) -> String {
    match value {
        Value::Null if column == "lower" => "-inf".to_owned(),
        Value::Null if column == "upper" => "inf".to_owned(),
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().map(|item| cell("", item)).collect::<Vec<_>>().join("+"),
        Value::Number(number) if number.is_f64() => float(number.as_f64().unwrap_or_default()),
        other => other.to_string(),
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\r', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// The rows that are known while questions are open, in a file beside the answer's.
pub(in crate::cli) struct Part {
    path: PathBuf,
    file: Mutex<File>,
}

impl Part {
    /// `FILE.part`; what it holds of whole questions stays where the sweep is resumed.
    pub fn open(answer: &OsStr, resume: bool) -> Result<Part, Error> {
        let path = Self::path_of(answer);
        let whole = if resume { whole(&read(&path)?).len() as u64 } else { 0 };
        let file = OpenOptions::new().create(true).append(true).open(&path);
        let file = file.and_then(|file| file.set_len(whole).map(|()| file));
        let file = file.map_err(|e| write_error(&path.to_string_lossy(), &e))?;
        Ok(Part { path, file: file.into() })
    }

    fn path_of(answer: &OsStr) -> PathBuf {
        let mut name = answer.to_owned();
        name.push(".part");
        name.into()
    }

    /// Adds the rows of a question; an empty line says that they are all.
    pub fn add(&self, rows: &[Row]) -> Result<(), Error> {
        let text: String = rows.iter().map(|row| line(row) + "\n").chain(["\n".to_owned()]).collect();
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(text.as_bytes()).map_err(|e| write_error(&self.path.to_string_lossy(), &e))
    }

    /// Removes the file: everything is in the answer's.
    pub fn done(self) {
        let _ = std::fs::remove_file(self.path);
    }
}

/// What earlier runs left.
pub(in crate::cli) struct Known {
    /// The rows by question: those in `FILE.part`, and those in the file itself where it has JSON lines.
    pub rows: Vec<Vec<Row>>,
    /// The keys of the rows of a table, which is written anew.
    keys: Vec<String>,
    /// Whether the file has content that is no row.
    is_foreign: bool,
}

impl Known {
    /// Reads the file and the one beside it.
    pub fn read(answer: &OsStr, format: Format) -> Result<Known, Error> {
        let text = read(Path::new(answer))?;
        let mut known = Known { rows: Vec::new(), keys: Vec::new(), is_foreign: false };
        match format {
            Format::JsonLines => {
                let rows: Vec<Row> = text.lines().filter_map(row).collect();
                let key = |row: &Row| row.get("key").cloned();
                known.rows.extend(rows.chunk_by(|a, b| key(a) == key(b)).map(<[Row]>::to_vec));
            }
            Format::Csv => {
                let first_cells = text.lines().filter_map(|line| line.split_once(',')).map(|(cell, _)| cell);
                known.keys.extend(first_cells.filter(|cell| is_key(cell)).map(str::to_owned));
            }
        }
        let has_head = format == Format::Csv && text.starts_with("key,");
        known.is_foreign = !text.trim().is_empty() && known.rows.is_empty() && known.keys.is_empty() && !has_head;
        let part = read(&Part::path_of(answer))?;
        known.rows.extend(whole(&part).split_terminator("\n\n").map(|rows| rows.lines().filter_map(row).collect()));
        Ok(known)
    }

    /// Why a sweep with these questions does not go on from here: it would drop rows.
    pub fn of_others(&self, is_asked: impl Fn(&str) -> bool) -> Option<String> {
        if self.is_foreign {
            return Some("it has no rows of a sweep".to_owned());
        }
        let keys = self.rows.iter().filter_map(|rows| rows.first()?.get("key")?.as_str());
        let keys: BTreeSet<&str> = keys.chain(self.keys.iter().map(String::as_str)).collect();
        let others = keys.iter().filter(|key| !is_asked(key)).count();
        (others > 0).then(|| format!("{others} of its {} questions are not asked here", keys.len()))
    }
}

/// Whether a cell is the key of a row.
fn is_key(cell: &str) -> bool {
    cell.len() == 64 && cell.bytes().all(|b| b.is_ascii_hexdigit())
}

/// The questions that were finished: an empty line is behind each.
fn whole(part: &str) -> &str {
    &part[..part.rfind("\n\n").map_or(0, |end| end + 2)]
}

fn read(path: &Path) -> Result<String, Error> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(String::from_utf8_lossy(&bytes).into_owned()),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(String::new()),
        Err(e) => Err(write_error(&path.to_string_lossy(), &e)),
    }
}

/// The row that a line says, its floats as they were written: the reader of JSON rounds them twice.
fn row(line: &str) -> Option<Row> {
    let mut row: Row = serde_json::from_str(line).ok()?;
    for column in ["lower", "upper", "lower_hz", "upper_hz"] {
        // No text holds this: quotes in texts have a backslash before them.
        let Some((_, rest)) = line.split_once(&format!("\"{column}\": ")) else { continue };
        if let Ok(value) = rest.split([',', '}']).next().unwrap_or_default().parse::<f64>() {
            row.insert(column.to_owned(), value.into());
        }
    }
    Some(row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn floats_are_written_as_python_writes_them() {
        let known = [
            (0.1, "0.1"),
            (1.0, "1.0"),
            (1e15, "1000000000000000.0"),
            (1e16, "1e+16"),
            (1.5e300, "1.5e+300"),
            (0.0001, "0.0001"),
            (0.00001, "1e-05"),
            (-1.25e-7, "-1.25e-07"),
            (1663.7, "1663.7"),
            (5e-324, "5e-324"),
        ];
        for (x, text) in known {
            assert_eq!(float(x), text);
        }
    }

    #[test]
    fn floats_are_read_as_they_were_written() {
        for x in [0.1f64, 1.5e308, 550.941166686675, 5e-324, 123456789.12345679] {
            for x in [x, -x, x.next_up(), x.next_down()] {
                let Some(read) = row(&format!("{{\"key\": \"a\", \"lower\": {}, \"upper_hz\": null}}", float(x)))
                else {
                    panic!()
                };
                assert_eq!(read["lower"].as_f64(), Some(x));
            }
        }
        assert!(row("{\"key\": ").is_none());
    }

    #[test]
    fn rows_as_json_and_as_a_table() {
        let row = json!({"key": "k", "model": "a \"b\", c", "interval": 0, "lower": null, "upper": 2.0, "upper_causes": ["z=1", "domain"]});
        let Value::Object(row) = row else { panic!("an object") };
        let text = r#"{"key": "k", "model": "a \"b\", c", "interval": 0, "lower": null, "upper": 2.0, "upper_causes": ["z=1", "domain"]}"#;
        assert_eq!(line(&row), text);
        let table = csv(&[row], &BTreeSet::from(["T".to_owned()]));
        let lines: Vec<&str> = table.split("\r\n").collect();
        assert!(lines[0].starts_with("key,model,p.T,parameter,interval,lower,lower_decimal,"));
        let head: Vec<&str> = lines[0].split(',').collect();
        let cells: Vec<&str> = lines[1].replacen("\"a \"\"b\"\", c\"", "model", 1).leak().split(',').collect();
        let shown: Vec<(&str, &str)> = head.into_iter().zip(cells).filter(|(_, cell)| !cell.is_empty()).collect();
        assert!(lines[1].contains(r#""a ""b"", c""#));
        let expected = [
            ("key", "k"),
            ("model", "model"),
            ("interval", "0"),
            ("lower", "-inf"),
            ("upper", "2.0"),
            ("upper_causes", "z=1+domain"),
        ];
        assert_eq!(shown, expected);
    }
}
