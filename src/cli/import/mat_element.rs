//! The elements of a MATLAB file of level 5: a tag with a type and a length, and what it says.

use super::number::Number;
use super::refused;
use jurist_engine::error::Diagnostic;

/// Types of elements.
pub(super) const MATRIX: u32 = 14;
pub(super) const COMPRESSED: u32 = 15;

/// Bytes that are read from front to back.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub rest: &'a [u8],
    pub big_endian: bool,
}

/// An element of a file or of an array.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    pub kind: u32,
    pub data: &'a [u8],
    big_endian: bool,
}

pub(super) fn cut_off() -> Diagnostic {
    refused("the file is cut off or damaged").help("save it once more; in MATLAB: save -v7 FILE A B C D Ts")
}

fn u32_of(bytes: [u8; 4], big_endian: bool) -> u32 {
    if big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Diagnostic> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(cut_off)?;
        self.rest = rest;
        Ok(taken)
    }

    fn word(&mut self) -> Result<u32, Diagnostic> {
        let bytes = self.take(4)?;
        Ok(u32_of([bytes[0], bytes[1], bytes[2], bytes[3]], self.big_endian))
    }

    /// The next element; none at the end.
    pub fn next(&mut self) -> Result<Option<Element<'a>>, Diagnostic> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        let tag = self.word()?;
        let big_endian = self.big_endian;
        // A length in the upper half: the data stand in the tag.
        if tag >> 16 != 0 {
            let data = self.take(4)?.get(..(tag >> 16) as usize).ok_or_else(cut_off)?;
            return Ok(Some(Element { kind: tag & 0xffff, data, big_endian }));
        }
        let length = self.word()? as usize;
        let data = self.take(length)?;
        if tag != COMPRESSED {
            // The last padding of a file may be missing.
            let padding = (8 - length % 8) % 8;
            self.rest = &self.rest[padding.min(self.rest.len())..];
        }
        Ok(Some(Element { kind: tag, data, big_endian }))
    }

    /// The next element, which has to be there.
    pub fn element(&mut self) -> Result<Element<'a>, Diagnostic> {
        self.next()?.ok_or_else(cut_off)
    }
}

impl<'a> Element<'a> {
    /// What is in it, as elements.
    pub fn inside(&self) -> Bytes<'a> {
        Bytes { rest: self.data, big_endian: self.big_endian }
    }

    /// Its 32-bit words.
    pub fn words(&self) -> Vec<u32> {
        self.data.chunks_exact(4).map(|b| u32_of([b[0], b[1], b[2], b[3]], self.big_endian)).collect()
    }

    /// Its characters, up to the first that is none.
    pub fn text(&self) -> String {
        let end = self.data.iter().position(|byte| *byte == 0).unwrap_or(self.data.len());
        String::from_utf8_lossy(&self.data[..end]).into_owned()
    }

    /// Bytes of a number; none of an element of something else.
    pub fn width(&self) -> Option<usize> {
        match self.kind {
            1 | 2 => Some(1),
            3 | 4 => Some(2),
            5..=7 => Some(4),
            9 | 12 | 13 => Some(8),
            _ => None,
        }
    }

    /// The number at an index; the inner `None` is one that is not finite.
    pub fn number(&self, index: usize) -> Option<Option<Number>> {
        let width = self.width()?;
        let bytes = self.data.get(index.checked_mul(width)?..)?.get(..width)?;
        let fold = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        let bits = if self.big_endian { bytes.iter().fold(0, fold) } else { bytes.iter().rev().fold(0, fold) };
        Some(match self.kind {
            9 => Number::double(bits),
            7 => Number::single(bits as u32),
            1 | 3 | 5 | 12 => {
                // The sign stands in the first of the bits that are used.
                let unused = 64 - 8 * width;
                Some(Number::integer(i128::from((bits << unused) as i64 >> unused)))
            }
            _ => Some(Number::integer(i128::from(bits))),
        })
    }
}
