//! Tables of decimals: sections headed by the name of a matrix, or one matrix alone.
//!
//! Every number needs its place in the text, and a cell is never more than a number: no crate for quoted text is needed.

use super::number::{Number, Unread};
use super::{MAX_SIDE, Shape, Variable, Variables, WANTED, bad_entry, refused};
use jurist_engine::error::{Diagnostic, Span};

/// A cell and where it begins.
type Cell<'t> = (usize, &'t str);

/// Longer lines are refused: a table program may add empty cells, but not so many.
const MAX_CELLS: usize = 2000;

pub(super) fn read(text: &str) -> Result<Variables, Diagnostic> {
    let mut variables = Variables::default();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let at = start;
        start += line.len();
        read_line(at, line, &mut variables)?;
    }
    variables.present = variables.list.iter().map(|variable| variable.name.clone()).collect();
    Ok(variables)
}

fn read_line(at: usize, line: &str, variables: &mut Variables) -> Result<(), Diagnostic> {
    let without_mark = line.strip_prefix('\u{feff}').unwrap_or(line);
    let content = without_mark.trim();
    let at = at
        + (without_mark.as_ptr().addr() - line.as_ptr().addr())
        + (without_mark.len() - without_mark.trim_start().len());
    let comment = content.strip_prefix(['#', '%']);
    // NumPy writes a header as a comment.
    let (shift, said) = match comment {
        Some(rest) => (content.len() - rest.trim_start().len(), rest.trim_start()),
        None => (0, content),
    };
    let cells = cells(at + shift, said)?;
    let section =
        cells.first().and_then(|(_, word)| WANTED.iter().find(|name| **name == word.trim_end_matches([':', '=', ' '])));
    match section {
        Some(name) => {
            begin(name, Span::new(at, at + content.len()), variables)?;
            // 'Ts = 0.1' is one line.
            let values: Vec<Cell<'_>> =
                cells[1..].iter().filter(|(_, cell)| !["=", ":"].contains(cell)).copied().collect();
            if values.is_empty() { Ok(()) } else { row(&values, variables) }
        }
        None if comment.is_some() || cells.is_empty() => Ok(()),
        None => {
            if variables.list.is_empty() {
                begin("A", Span::new(at, at), variables)?;
            }
            row(&cells, variables)
        }
    }
}

/// The cells of a line between commas, semicolons, tabs or blanks; empty ones at its end are none.
fn cells(at: usize, line: &str) -> Result<Vec<Cell<'_>>, Diagnostic> {
    let separator = [';', ',', '\t'].into_iter().find(|separator| line.contains(*separator));
    if separator == Some(';')
        && let Some(comma) = line.find(',')
    {
        return Err(refused("a semicolon and a comma stand in one line")
            .at(Span::new(at + comma, at + comma + 1), "a comma")
            .help("decimals are written with a point: 1.5"));
    }
    if line.split(separator.unwrap_or(' ')).nth(MAX_CELLS).is_some() {
        return Err(refused(format!("a line has more than {MAX_CELLS} cells")).at(Span::new(at, at), ""));
    }
    let pieces: Vec<&str> = match separator {
        Some(separator) => line.split(separator).collect(),
        None => line.split(' ').filter(|piece| !piece.is_empty()).collect(),
    };
    let mut cells: Vec<Cell<'_>> = pieces
        .into_iter()
        .map(|piece| {
            let cell = piece.trim().trim_matches('"').trim();
            (at + (cell.as_ptr().addr() - line.as_ptr().addr()), cell)
        })
        .collect();
    while cells.last().is_some_and(|(_, cell)| cell.is_empty()) {
        cells.pop();
    }
    Ok(cells)
}

fn begin(name: &str, span: Span, variables: &mut Variables) -> Result<(), Diagnostic> {
    if let Some(other) = variables.list.iter().find(|variable| variable.name == name) {
        let error = refused(format!("there are two sections {name}")).at(span, "the second one");
        return Err(match other.span {
            Some(first) => error.also(first, "the first one"),
            None => error,
        });
    }
    let name = name.to_owned();
    variables.list.push(Variable { name, shape: Shape::Matrix(0, 0), entries: Vec::new(), span: Some(span) });
    Ok(())
}

/// Adds a row to the last section.
fn row(cells: &[Cell<'_>], variables: &mut Variables) -> Result<(), Diagnostic> {
    let Some(variable) = variables.list.last_mut() else { return Ok(()) };
    let (start, end) = match (cells.first(), cells.last()) {
        (Some((start, _)), Some((end, last))) => (*start, end + last.len()),
        _ => return Ok(()),
    };
    let span = Span::new(start, end);
    let Shape::Matrix(rows, columns) = variable.shape else { return Ok(()) };
    let name = variable.name.clone();
    if rows > 0 && columns != cells.len() {
        let message =
            format!("row {} of {name} has {} numbers, but the rows above have {columns}", rows + 1, cells.len());
        return Err(refused(message).at(span, "another length"));
    }
    if cells.len() > MAX_SIDE || rows == MAX_SIDE {
        return Err(refused(format!("{name} has more than {MAX_SIDE} rows or columns")).at(span, "too many"));
    }
    for (column, (at, cell)) in cells.iter().enumerate() {
        let number = Number::decimal(cell).map_err(|why| {
            let error = bad_entry(&name, rows, column, why, cell).at(Span::new(*at, at + cell.len()), "");
            match why {
                Unread::NotANumber if rows == 0 => error.help("a section begins with a line A, B, C, D or Ts"),
                _ => error,
            }
        })?;
        variable.entries.push(number);
    }
    variable.shape = Shape::Matrix(rows + 1, cells.len());
    variable.span = variable.span.filter(|span| span.end > span.start).or(Some(span));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::read;

    fn shown(text: &str) -> Vec<String> {
        read(text).unwrap().shown()
    }

    #[test]
    fn sections_in_any_spelling() {
        let expected = ["A Matrix(2, 2) 0 1.50 -2 3", "B Matrix(2, 1) 0 1", "Ts Matrix(1, 1) 0.1"];
        assert_eq!(shown("A\n0,1.50\n-2,3\nB\n0\n1\nTs\n0.1\n"), expected);
        assert_eq!(shown("\u{feff}A,\r\n0, 1.50\r\n-2, 3\r\n\r\nB,,\r\n0,\r\n1,\r\nTs,0.1\r\n"), expected);
        assert_eq!(shown("# A\n0 1.50\n-2 3\n% B\n0\n1\n# a remark\nTs = 0.1"), expected);
        assert_eq!(shown("\"A\"\t\n\"0\"\t1.50\n-2\t3\nB:\n0\n1\nTs:,0.1"), expected);
        assert_eq!(shown("0,1.50\n-2,3"), ["A Matrix(2, 2) 0 1.50 -2 3"]);
        assert!(shown("").is_empty() && shown("\n# nothing\n").is_empty());
    }

    #[test]
    fn mistakes_have_their_places() {
        let place = |text: &str| {
            let error = read(text).unwrap_err();
            let span = error.primary.unwrap().span;
            (text[span.start..span.end].to_owned(), error.message)
        };
        assert_eq!(place("A\r\n1,2\r\n3,x4\r\n").0, "x4");
        assert_eq!(place("A\n1,NaN\n3,4").1, "row 1, column 2 of A is NaN: not a finite number");
        assert_eq!(place("\u{feff}A\n1,2\n3\n").0, "3");
        assert_eq!(place("A\n1,,2\n").1, "row 1, column 2 of A is empty");
        assert_eq!(place("1,5;2,5\n").1, "a semicolon and a comma stand in one line");
        assert_eq!(place("A\n1\nB\n1\nA\n2").0, "A");
    }
}
