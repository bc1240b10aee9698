//! Arrays of NumPy in an archive, `.npz`.

use super::number::{Number, Unread};
use super::{DESCRIPTOR, MAX_SIDE, MAX_UNPACKED, Shape, Variable, Variables, bad_entry, is_read, refused, zip};
use jurist_engine::error::Diagnostic;

const HELP: &str = "in Python: numpy.savez(\"system.npz\", A=A, B=B, C=C, D=D, dt=dt)";

pub(super) fn read_archive(bytes: &[u8]) -> Result<Variables, Diagnostic> {
    if bytes.starts_with(b"\x93NUMPY") {
        return Err(refused("this is a single array, not an archive of arrays with names").help(HELP));
    }
    let mut out = Variables::default();
    for member in zip::members(bytes)? {
        let name = member.name.strip_suffix(".npy").unwrap_or(&member.name).to_owned();
        if name == DESCRIPTOR {
            // It may be anything else.
            out.list.extend(member.content(MAX_UNPACKED).and_then(|content| array(&name, &content)).ok());
        } else if is_read(&name) {
            if out.list.iter().any(|variable| variable.name == name) {
                return Err(refused(format!("{name} stands there twice")));
            }
            out.list.push(array(&name, &member.content(MAX_UNPACKED)?)?);
        }
        out.present.push(name);
    }
    Ok(out)
}

/// The header of an array.
struct Header {
    kind: u8,
    big_endian: bool,
    /// Bytes of an entry.
    width: usize,
    by_columns: bool,
    sides: Vec<usize>,
}

/// One array from its file: a header that is a dictionary of Python, and the entries.
fn array(name: &str, bytes: &[u8]) -> Result<Variable, Diagnostic> {
    let broken = || refused(format!("the array {name} is damaged"));
    let (major, rest) = match bytes {
        [0x93, b'N', b'U', b'M', b'P', b'Y', major, _, rest @ ..] => (*major, rest),
        _ => return Err(broken()),
    };
    let (length, rest) = match (major, rest) {
        (1, [a, b, rest @ ..]) => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        (2 | 3, [a, b, c, d, rest @ ..]) => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        _ => return Err(broken()),
    };
    let (text, data) = rest.split_at_checked(length).ok_or_else(broken)?;
    let header = header(name, std::str::from_utf8(text).map_err(|_| broken())?)?;
    let shape = match header.sides.as_slice() {
        [] => Shape::Scalar,
        [length] => Shape::Vector(*length),
        [rows, columns] => Shape::Matrix(*rows, *columns),
        sides => return Err(refused(format!("{name} has {} dimensions, not two", sides.len()))),
    };
    if header.sides.iter().any(|side| *side > MAX_SIDE) {
        let sides: Vec<String> = header.sides.iter().map(ToString::to_string).collect();
        return Err(refused(format!(
            "{name} is {}: at most {MAX_SIDE} states, inputs and outputs are imported",
            sides.join(" by ")
        )));
    }
    let (rows, columns) = match shape {
        Shape::Matrix(rows, columns) => (rows, columns),
        Shape::Vector(length) => (1, length),
        Shape::Scalar => (1, 1),
    };
    if data.len() < rows * columns * header.width {
        return Err(refused(format!(
            "the array {name} is cut off: its entries need {} bytes",
            rows * columns * header.width
        )));
    }
    let mut entries = Vec::new();
    for k in 0..rows * columns {
        let (row, column) = (k / columns, k % columns);
        let place = if header.by_columns { column * rows + row } else { k };
        let entry = &data[place * header.width..][..header.width];
        entries.push(
            number(&header, entry).ok_or_else(|| bad_entry(name, row, column, Unread::NotFinite, "NaN or infinite"))?,
        );
    }
    Ok(Variable { name: name.to_owned(), shape, entries, span: None })
}

/// Reads `{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }`.
fn header(name: &str, text: &str) -> Result<Header, Diagnostic> {
    let value =
        |key: &str| text.split_once(key).map(|(_, rest)| rest.trim_start().trim_start_matches(':').trim_start());
    let broken = || refused(format!("the header of the array {name} is damaged"));
    let descr = value("'descr'").ok_or_else(broken)?;
    let kind = descr.strip_prefix('\'').and_then(|rest| rest.split_once('\'')).map_or(descr, |(kind, _)| kind);
    let (order, letter, width) = match kind.as_bytes() {
        [order @ (b'<' | b'>' | b'|' | b'='), letter, width @ ..] => (*order, *letter, std::str::from_utf8(width).ok()),
        _ => (b'|', b'?', None),
    };
    let width = width.and_then(|width| width.parse::<usize>().ok()).unwrap_or(0);
    if !matches!((letter, width), (b'f', 4 | 8) | (b'i' | b'u', 1 | 2 | 4 | 8)) {
        let what = match letter {
            b'c' => "complex".to_owned(),
            b'O' => "made of Python objects, which are never read".to_owned(),
            b'b' => "made of truth values".to_owned(),
            _ => format!("of the type {}", kind.chars().take(20).collect::<String>()),
        };
        return Err(refused(format!("{name} is {what}"))
            .help("arrays of float64, float32 and integers are read: A.astype(float)"));
    }
    let by_columns = value("'fortran_order'").ok_or_else(broken)?.starts_with("True");
    let shape = value("'shape'").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).ok_or_else(broken)?.0;
    let sides =
        shape.split(',').map(str::trim).filter(|side| !side.is_empty()).map(|side| side.trim_end_matches('L').parse());
    let sides = sides.collect::<Result<Vec<usize>, _>>().map_err(|_| broken())?;
    Ok(Header { kind: letter, big_endian: order == b'>', width, by_columns, sides })
}

/// An entry; `None` of one that is not finite.
fn number(header: &Header, bytes: &[u8]) -> Option<Number> {
    let fold = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
    let bits = if header.big_endian { bytes.iter().fold(0, fold) } else { bytes.iter().rev().fold(0, fold) };
    match (header.kind, header.width) {
        (b'f', 8) => Number::double(bits),
        (b'f', _) => Number::single(bits as u32),
        (b'i', width) => {
            // The sign stands in the first of the bits that are used.
            let unused = 64 - 8 * width;
            Some(Number::integer(i128::from((bits << unused) as i64 >> unused)))
        }
        _ => Some(Number::integer(i128::from(bits))),
    }
}

#[cfg(test)]
mod tests {
    use super::{Shape, array};

    fn file(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(data);
        bytes
    }

    #[test]
    fn orders_of_bytes_and_of_entries() {
        let shown = |header: &str, data: &[u8]| {
            let array = array("A", &file(header, data)).unwrap();
            (array.shape, array.entries.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "))
        };
        let header = |descr: &str, order: &str, shape: &str| {
            format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}")
        };
        let (shape, entries) = shown(&header("|i1", "False", "(2, 2)"), &[1, 2, 3, 0xff]);
        assert_eq!((shape, entries.as_str()), (Shape::Matrix(2, 2), "1 2 3 -1"));
        assert_eq!(shown(&header("|u1", "True", "(2, 2)"), &[1, 2, 3, 0xff]).1, "1 3 2 255");
        assert_eq!(shown(&header(">f8", "False", "()"), &0.1f64.to_be_bytes()), (Shape::Scalar, "0.1".to_owned()));
        assert_eq!(shown(&header("<f4", "False", "(1,)"), &0.1f32.to_le_bytes()), (Shape::Vector(1), "0.1".to_owned()));
        assert_eq!(shown(&header("<i8", "False", "(1,)"), &i64::MIN.to_le_bytes()).1, "-9.223372036854775808e18");
        assert_eq!(shown(&header("<f8", "False", "(2, 0)"), &[]).0, Shape::Matrix(2, 0));
    }

    #[test]
    fn what_is_refused() {
        let said = |header: &str| array("A", &file(header, &[0; 8])).unwrap_err().message;
        assert!(said("{'descr': '<c16', 'fortran_order': False, 'shape': (1,), }").contains("complex"));
        assert!(said("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }").contains("objects"));
        assert!(
            said("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 99999999999), }")
                .contains("at most 200")
        );
        assert!(
            said("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999999,), }").contains("damaged")
        );
        assert!(said("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }").contains("cut off"));
        assert!(said("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1), }").contains("3 dimensions"));
        assert!(said("{}").contains("damaged"));
    }
}
