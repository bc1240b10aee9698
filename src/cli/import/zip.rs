//! The members of a zip archive that are stored or deflated: what NumPy writes.

use super::refused;
use jurist_engine::error::Diagnostic;

/// More members than so many are not looked at.
const MAX_MEMBERS: usize = 10_000;

/// A member, still packed.
pub(super) struct Member<'a> {
    pub name: String,
    method: u16,
    checksum: u32,
    packed: &'a [u8],
    size: usize,
}

fn broken(what: &str) -> Diagnostic {
    refused(format!("the archive is damaged: {what}"))
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(bytes.get(at..at.checked_add(2)?)?.try_into().ok()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
}

fn size_at(bytes: &[u8], at: usize) -> Option<usize> {
    usize::try_from(u32_at(bytes, at)?).ok()
}

/// What the directory at the end of the archive lists.
pub(super) fn members(bytes: &[u8]) -> Result<Vec<Member<'_>>, Diagnostic> {
    // A comment of up to 65535 bytes may stand behind the record of the directory, of 22 bytes.
    let from = bytes.len().saturating_sub(22 + 65535);
    let record = (from..=bytes.len().saturating_sub(22)).rev().find(|at| bytes[*at..].starts_with(b"PK\x05\x06"));
    let record = record.ok_or_else(|| broken("it has no directory, perhaps its end is missing"))?;
    let cut = || broken("its directory is cut off");
    let count = usize::from(u16_at(bytes, record + 10).ok_or_else(cut)?);
    let mut at = size_at(bytes, record + 16).ok_or_else(cut)?;
    if count > MAX_MEMBERS {
        return Err(refused(format!("the archive has more than {MAX_MEMBERS} members")));
    }
    let mut out = Vec::new();
    for _ in 0..count {
        let (member, next) = member(bytes, at).ok_or_else(cut)??;
        out.push(member);
        at = next;
    }
    Ok(out)
}

/// A member by its entry in the directory, and where the next entry begins; `None` where the archive ends before.
fn member(bytes: &[u8], at: usize) -> Option<Result<(Member<'_>, usize), Diagnostic>> {
    if !bytes.get(at..)?.starts_with(b"PK\x01\x02") {
        return Some(Err(broken("an entry of its directory is none")));
    }
    let [name, extra, comment] = [28, 30, 32].map(|offset| u16_at(bytes, at + offset).map(usize::from));
    let (name, extra, comment) = (name?, extra?, comment?);
    let (flags, method, checksum) = (u16_at(bytes, at + 8)?, u16_at(bytes, at + 10)?, u32_at(bytes, at + 16)?);
    let [packed_size, size, local] = [20, 24, 42].map(|offset| size_at(bytes, at + offset));
    let (packed_size, size, local) = (packed_size?, size?, local?);
    let next = at + 46 + name + extra + comment;
    let name = String::from_utf8_lossy(bytes.get(at + 46..at + 46 + name)?).into_owned();
    if flags & 1 != 0 {
        return Some(Err(refused(format!("{name} is encrypted"))));
    }
    if !bytes.get(local..)?.starts_with(b"PK\x03\x04") {
        return Some(Err(broken(&format!("{name} is not where the directory says"))));
    }
    let [name_length, extra_length] = [26, 28].map(|offset| u16_at(bytes, local + offset).map(usize::from));
    let start = local + 30 + name_length? + extra_length?;
    let packed = bytes.get(start..start.checked_add(packed_size)?)?;
    Some(Ok((Member { name, method, checksum, packed, size }, next)))
}

impl Member<'_> {
    /// Its content, of at most so many bytes.
    pub fn content(&self, most: usize) -> Result<Vec<u8>, Diagnostic> {
        let name = &self.name;
        if self.size > most {
            return Err(refused(format!("{name} unpacks to more than {} megabytes", most >> 20)));
        }
        let content = match self.method {
            0 => self.packed.to_vec(),
            8 => miniz_oxide::inflate::decompress_to_vec_with_limit(self.packed, self.size)
                .map_err(|_| broken(&format!("{name} cannot be unpacked")))?,
            method => {
                return Err(refused(format!("{name} is packed by method {method}; stored and deflated are read")));
            }
        };
        if content.len() != self.size || checksum(&content) != self.checksum {
            return Err(broken(&format!("{name} is not what was packed")));
        }
        Ok(content)
    }
}

/// The CRC-32 of zip archives.
fn checksum(bytes: &[u8]) -> u32 {
    let table: [u32; 256] =
        std::array::from_fn(|k| (0..8).fold(k as u32, |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 }));
    !bytes.iter().fold(!0u32, |sum, byte| table[usize::from(sum as u8 ^ byte)] ^ sum >> 8)
}

#[cfg(test)]
mod tests {
    use super::checksum;

    #[test]
    fn the_checksum_of_the_standard_example() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
        assert_eq!(checksum(b""), 0);
    }
}
