//! MATLAB files of level 5, also with compressed elements ("v7").

use super::mat_element::{Bytes, COMPRESSED, Element, MATRIX, cut_off};
use super::number::Unread;
use super::{DESCRIPTOR, MAX_SIDE, MAX_UNPACKED, Shape, Variable, Variables, bad_entry, is_read, refused};
use jurist_engine::error::Diagnostic;

/// What stands before the first element.
const HEADER: usize = 128;

const SAVE: &str = "in MATLAB: save -v7 FILE A B C D Ts; in Python: scipy.io.savemat(FILE, {\"A\": A, ...})";

/// Names longer than this are no names of MATLAB.
const MAX_NAME: usize = 1024;

/// Fields of a struct that are looked at.
const MAX_FIELDS: usize = 10_000;

/// Classes of arrays.
mod class {
    pub const STRUCT: u32 = 2;
    pub const OBJECT: u32 = 3;
    pub const SPARSE: u32 = 5;
    pub const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;
    pub const OPAQUE: u32 = 17;
}

pub(super) fn read(bytes: &[u8]) -> Result<Variables, Diagnostic> {
    let big_endian = check_header(bytes)?;
    let mut file = Bytes { rest: &bytes[HEADER..], big_endian };
    let mut found = Found::default();
    let mut unpacked = 0;
    while let Some(element) = file.next()? {
        if element.kind != COMPRESSED {
            found.add(element)?;
            continue;
        }
        let left = MAX_UNPACKED - unpacked;
        let content =
            miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(element.data, left).map_err(|error| match error
                .status
            {
                miniz_oxide::inflate::TINFLStatus::HasMoreOutput => {
                    refused(format!("the file unpacks to more than {} megabytes", MAX_UNPACKED >> 20))
                }
                _ => cut_off(),
            })?;
        unpacked += content.len();
        let mut inner = Bytes { rest: &content, big_endian };
        found.add(inner.element()?)?;
    }
    found.chosen()
}

/// Whether numbers begin with their highest byte.
fn check_header(bytes: &[u8]) -> Result<bool, Diagnostic> {
    let is_hdf = bytes.starts_with(b"\x89HDF") || bytes.get(512..).is_some_and(|rest| rest.starts_with(b"\x89HDF"));
    if is_hdf || bytes.starts_with(b"MATLAB 7.3") {
        return Err(refused("this is a MATLAB file of version 7.3 (HDF5), which is not read").help(SAVE));
    }
    // A file of level 4 begins with a small number, a file of level 5 with a text.
    if bytes.get(..4).is_some_and(|first| first.contains(&0)) {
        return Err(refused("this is no MATLAB file of level 5; perhaps one of level 4, which is not read").help(SAVE));
    }
    match bytes.get(124..HEADER) {
        Some([0, 1, b'I', b'M']) => Ok(false),
        Some([1, 0, b'M', b'I']) => Ok(true),
        None => Err(cut_off()),
        Some(_) => Err(refused("this is no MATLAB file of level 5").help(SAVE)),
    }
}

/// What the file holds.
#[derive(Default)]
struct Found {
    top: Variables,
    /// Structs with their fields.
    structs: Vec<(String, Variables)>,
    /// The name of an object.
    object: Option<String>,
}

impl Found {
    /// Adds a variable of the file to what it belongs to.
    fn add(&mut self, element: Element<'_>) -> Result<(), Diagnostic> {
        let Some(array) = Array::read(element)? else { return Ok(()) };
        let name = array.name.clone();
        if is_read(&name) {
            add(numbers(array, &name)?, &mut self.top)?;
        } else if name == DESCRIPTOR && class::NUMERIC.contains(&array.class) {
            // It may be anything else.
            if let Ok(matrix) = numbers(array, &name) {
                add(matrix, &mut self.top)?;
            }
        } else if array.class == class::STRUCT && array.sides.iter().all(|side| *side == 1) {
            self.structs.push((name.clone(), fields(array)?));
        } else if array.class == class::OBJECT || array.class == class::OPAQUE {
            self.object = Some(name.clone());
        }
        if !name.is_empty() && self.top.present.len() < MAX_FIELDS {
            self.top.present.push(name);
        }
        Ok(())
    }

    /// The variables themselves, or the fields of the only struct that is a system.
    fn chosen(self) -> Result<Variables, Diagnostic> {
        let has_state_matrix = |variables: &Variables| variables.list.iter().any(|variable| variable.name == "A");
        if has_state_matrix(&self.top) {
            return Ok(self.top);
        }
        let mut systems = self.structs.into_iter().filter(|(_, fields)| has_state_matrix(fields));
        match (systems.next(), systems.next(), self.object) {
            (Some((_, fields)), None, _) => Ok(fields),
            (Some((first, _)), Some((second, _)), _) => {
                let message = format!("there are several systems, such as '{first}' and '{second}'");
                Err(refused(message).help("save one of them alone"))
            }
            (None, _, Some(object)) => {
                let message =
                    format!("'{object}' is an object, such as ss makes, whose content MATLAB keeps for itself");
                let help = "in MATLAB: [A,B,C,D] = ssdata(sys); Ts = sys.Ts; save -v7 FILE A B C D Ts";
                Err(refused(message).help(help))
            }
            (None, _, None) => Ok(self.top),
        }
    }
}

/// The beginning of an array: what it is, and what follows.
struct Array<'a> {
    class: u32,
    is_complex: bool,
    sides: Vec<u32>,
    name: String,
    content: Bytes<'a>,
}

impl<'a> Array<'a> {
    /// `None` of what has no such beginning.
    fn read(element: Element<'a>) -> Result<Option<Array<'a>>, Diagnostic> {
        if element.kind != MATRIX || element.data.is_empty() {
            return Ok(None);
        }
        let mut content = element.inside();
        let flags = *content.element()?.words().first().ok_or_else(cut_off)?;
        let class = flags & 0xff;
        if class == class::OPAQUE {
            let name = content.element()?.text();
            return Ok(Some(Array { class, is_complex: false, sides: Vec::new(), name, content }));
        }
        let sides = content.element()?.inside_words(32)?;
        let name = content.element()?;
        if name.data.len() > MAX_NAME {
            return Err(cut_off());
        }
        Ok(Some(Array { class, is_complex: flags & 0x800 != 0, sides, name: name.text(), content }))
    }

    fn shown(&self) -> String {
        self.sides.iter().map(ToString::to_string).collect::<Vec<_>>().join(" by ")
    }
}

impl Element<'_> {
    /// Its words, if they are no more than so many.
    fn inside_words(&self, most: usize) -> Result<Vec<u32>, Diagnostic> {
        if self.data.len() > 4 * most { Err(cut_off()) } else { Ok(self.words()) }
    }
}

fn add(variable: Variable, to: &mut Variables) -> Result<(), Diagnostic> {
    if to.list.iter().any(|other| other.name == variable.name) {
        return Err(refused(format!("{} stands there twice", variable.name)));
    }
    to.list.push(variable);
    Ok(())
}

/// The fields of a struct that are read; those of structs inside are not.
fn fields(mut array: Array<'_>) -> Result<Variables, Diagnostic> {
    let mut out = Variables::default();
    let length = array.content.element()?.inside_words(1)?.first().map_or(0, |length| *length as usize);
    let names = array.content.element()?;
    if length == 0 || length > MAX_NAME || names.data.len() / length > MAX_FIELDS {
        return if names.data.is_empty() { Ok(out) } else { Err(cut_off()) };
    }
    for name in names.data.chunks_exact(length) {
        let end = name.iter().position(|byte| *byte == 0).unwrap_or(length);
        let name = String::from_utf8_lossy(&name[..end]).into_owned();
        let element = array.content.element()?;
        if (is_read(&name) || name == DESCRIPTOR)
            && let Some(field) = Array::read(element)?
        {
            add(numbers(field, &name)?, &mut out)?;
        }
        out.present.push(name);
    }
    Ok(out)
}

/// An array of real numbers.
fn numbers(mut array: Array<'_>, name: &str) -> Result<Variable, Diagnostic> {
    let what = match array.class {
        class::SPARSE => Some("sparse, and sparse arrays are not read: full(..)"),
        _ if !class::NUMERIC.contains(&array.class) => Some("no array of numbers"),
        _ if array.is_complex => Some("complex, and the matrices of a system are real: real(..)"),
        _ => None,
    };
    if let Some(what) = what {
        return Err(refused(format!("{name} is {what}")));
    }
    let [rows, columns] = array.sides[..] else {
        return Err(refused(format!("{name} is {}: not of two dimensions", array.shown())));
    };
    let (rows, columns) = (rows as usize, columns as usize);
    if rows > MAX_SIDE || columns > MAX_SIDE {
        let message =
            format!("{name} is {}: at most {MAX_SIDE} states, inputs and outputs are imported", array.shown());
        return Err(refused(message));
    }
    let shape = if (rows, columns) == (1, 1) { Shape::Scalar } else { Shape::Matrix(rows, columns) };
    let mut entries = Vec::new();
    if rows * columns > 0 {
        let data = array.content.element()?;
        for k in 0..rows * columns {
            let (row, column) = (k / columns, k % columns);
            // It stands there column by column.
            let number = data.number(column * rows + row).ok_or_else(cut_off)?;
            entries.push(number.ok_or_else(|| bad_entry(name, row, column, Unread::NotFinite, "NaN or infinite"))?);
        }
    }
    Ok(Variable { name: name.to_owned(), shape, entries, span: None })
}
