//! Files written as a whole or not at all.
//!
//! The bytes go to a new file in the same folder, which takes the name over when it is complete and on the
//! disk: whatever fails before leaves the old file as it was. On Linux the new file has no name until then, so that a signal
//! leaves nothing behind. Only a name that is no file (a terminal, a pipe,
//! `/dev/null`) is written as it stands.

use std::ffi::OsStr;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};

/// More symbolic links than this one behind the other lead nowhere.
const MOST_LINKS: usize = 40;

/// Where a name leads, symbolic links followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// The standard output of this process: `/dev/stdout` and its other names.
    StandardOutput,
    /// A file, there already or not.
    File(PathBuf),
    /// A device, a pipe, or an open file of a process: it cannot be replaced.
    Special(PathBuf),
}

impl Destination {
    /// Follows the links of a name.
    ///
    /// # Errors
    /// When the name is a folder's, or cannot be followed.
    pub fn of(path: &Path) -> Result<Destination> {
        let mut path = path.to_owned();
        for _ in 0..MOST_LINKS {
            let found = match std::fs::symlink_metadata(&path) {
                Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Destination::File(path)),
                found => found?,
            };
            let descriptor = descriptor_of(&path);
            if descriptor.as_deref() == Some(OsStr::new("1")) {
                return Ok(Destination::StandardOutput);
            }
            // What the link of an open file says is its name, which may be another file's by now.
            if descriptor.is_some() {
                return Ok(Destination::Special(path));
            }
            if found.is_symlink() {
                let target = std::fs::read_link(&path)?;
                path = path.parent().map_or(target.clone(), |folder| folder.join(&target));
            } else if found.is_dir() {
                return Err(ErrorKind::IsADirectory.into());
            } else if found.is_file() {
                return Ok(Destination::File(path));
            } else {
                return Ok(Destination::Special(path));
            }
        }
        Err(Error::other("too many levels of symbolic links"))
    }
}

/// The number of an open file, where the path is one of the names that the system has for those.
fn descriptor_of(path: &Path) -> Option<std::ffi::OsString> {
    let folder = path.parent()?.canonicalize().ok()?;
    let own = Path::new("/proc").join(std::process::id().to_string()).join("fd");
    let number = path.file_name()?;
    if folder == own || folder == Path::new("/dev/fd") {
        return Some(number.to_owned());
    }
    // Those of another process: nobody's standard output as far as this one is concerned.
    (folder.starts_with("/proc") && folder.ends_with("fd")).then(|| "other".into())
}

/// Makes the bytes the content of the file; a reader of a pipe that stops reading is no error.
///
/// The permissions of a file that is there are kept, and those who may not write it cannot replace it. Where
/// the folder takes no new file, the old one is written over in its place, which is all that is left.
///
/// # Errors
/// What the system says; the old content is there still, but for the exception above.
pub(super) fn replace(destination: &Destination, bytes: &[u8]) -> Result<()> {
    match destination {
        Destination::StandardOutput => super::output::write_to_standard(bytes),
        Destination::Special(path) => {
            let mut file = OpenOptions::new().append(true).open(path)?;
            match file.write_all(bytes) {
                Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(()),
                done => done,
            }
        }
        Destination::File(path) => {
            refuse_beyond_limit(bytes.len() as u64)?;
            let old = match OpenOptions::new().write(true).open(path) {
                Ok(file) => Some(file.metadata()?),
                Err(e) if e.kind() == ErrorKind::NotFound => None,
                Err(e) => return Err(e),
            };
            let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
            match Beside::new(folder, old.as_ref()) {
                Ok(beside) => beside.become_file(path, bytes, old.as_ref()),
                Err(e) if old.is_some() && closed(&e) => std::fs::write(path, bytes),
                Err(e) => Err(e),
            }
        }
    }
}

/// Whether a folder takes no new files.
fn closed(error: &Error) -> bool {
    matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)
}

/// The system ends a process that writes more than it may; this says so instead.
#[cfg(unix)]
fn refuse_beyond_limit(bytes: u64) -> Result<()> {
    let limit = rustix::process::getrlimit(rustix::process::Resource::Fsize).current;
    if limit.is_some_and(|limit| bytes > limit) { Err(ErrorKind::FileTooLarge.into()) } else { Ok(()) }
}

#[cfg(not(unix))]
fn refuse_beyond_limit(_: u64) -> Result<()> {
    Ok(())
}

/// What is created may be read by its owner only.
#[cfg(unix)]
fn hide_from_others(options: &mut OpenOptions) {
    std::os::unix::fs::OpenOptionsExt::mode(options, 0o600);
}

#[cfg(not(unix))]
fn hide_from_others(_: &mut OpenOptions) {}

/// A new file beside the old one, which takes over its name.
struct Beside<'f> {
    folder: &'f Path,
    file: File,
    /// The name of its own; `None` where it has none yet.
    name: Option<PathBuf>,
}

impl Beside<'_> {
    /// An empty file in the folder, for nobody else to read before it has the permissions of the old one.
    ///
    /// It has no name where the system knows such files: then nothing is left of it, however the process ends.
    fn new<'f>(folder: &'f Path, old: Option<&Metadata>) -> Result<Beside<'f>> {
        if let Some(file) = nameless(folder, old.is_some()) {
            return Ok(Beside { folder, file, name: None });
        }
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        if old.is_some() {
            hide_from_others(&mut options);
        }
        let (file, name) = with_new_name(folder, |name| options.open(name))?;
        Ok(Beside { folder, file, name: Some(name) })
    }

    /// Writes the bytes and takes over the name.
    fn become_file(mut self, path: &Path, bytes: &[u8], old: Option<&Metadata>) -> Result<()> {
        self.file.write_all(bytes)?;
        if let Some(old) = old {
            #[cfg(unix)]
            {
                use std::os::unix::fs::{MetadataExt, fchown};
                // Only the superuser can give a file away; anybody else's file keeps at least its group.
                if fchown(&self.file, Some(old.uid()), Some(old.gid())).is_err() {
                    let _ = fchown(&self.file, None, Some(old.gid()));
                }
            }
            self.file.set_permissions(old.permissions())?;
        }
        self.file.sync_all()?;
        if self.name.is_none() {
            // Only a name that is free can be taken: that of the old file is taken over from a name beside it.
            match give_name(&self.file, path) {
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {
                    let (file, folder) = (&self.file, self.folder);
                    self.name = Some(with_new_name(folder, |name| give_name(file, name))?.1);
                }
                done => return done,
            }
        }
        self.name.as_ref().map_or(Ok(()), |name| std::fs::rename(name, path))
    }
}

impl Drop for Beside<'_> {
    fn drop(&mut self) {
        // After a rename there is nothing of this name.
        if let Some(name) = &self.name {
            let _ = std::fs::remove_file(name);
        }
    }
}

/// What is done with a name in the folder that is free, and the name.
fn with_new_name<T>(folder: &Path, take: impl Fn(&Path) -> Result<T>) -> Result<(T, PathBuf)> {
    let mut count = 0_u32;
    loop {
        let name = folder.join(format!(".jurist-{}-{count}.tmp", std::process::id()));
        match take(&name) {
            // Left behind by a process of the same number that was ended from outside.
            Err(e) if e.kind() == ErrorKind::AlreadyExists && count < 1000 => count += 1,
            taken => return Ok((taken?, name)),
        }
    }
}

/// An empty file without a name, where the system and the folder have such.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path, hidden: bool) -> Option<File> {
    use rustix::fs::{CWD, Mode, OFlags, openat};
    let mode = Mode::from_raw_mode(if hidden { 0o600 } else { 0o666 });
    let file = File::from(openat(CWD, folder, OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC, mode).ok()?);
    // Its way to a name leads through this folder, which may not be there.
    Path::new("/proc/self/fd").is_dir().then_some(file)
}

/// Gives a file without a name one that is free.
#[cfg(target_os = "linux")]
fn give_name(file: &File, name: &Path) -> Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let open = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, open, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &Path, _: bool) -> Option<File> {
    None
}

#[cfg(not(target_os = "linux"))]
fn give_name(_: &File, _: &Path) -> Result<()> {
    Err(ErrorKind::Unsupported.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Until it takes over the name, a process that is ended from outside leaves nothing.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_file_that_is_being_written_has_no_name() {
        let folder = std::env::temp_dir().join(format!("jurist-nameless-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let names = || {
            let names = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
            let mut names: Vec<_> = names.collect();
            names.sort();
            names
        };
        let path = folder.join("answer");
        for (old, names_then) in [(None, vec![]), (Some("before"), vec!["answer"])] {
            let old = old.map(|text| {
                std::fs::write(&path, text).unwrap();
                std::fs::metadata(&path).unwrap()
            });
            let mut beside = Beside::new(&folder, old.as_ref()).unwrap();
            beside.file.write_all(b"some of ").unwrap();
            // Where the file system has no such files there is nothing to show.
            if beside.name.is_none() {
                assert_eq!(names(), names_then);
            }
            beside.become_file(&path, b"it", old.as_ref()).unwrap();
            assert_eq!(names(), ["answer"]);
            assert_eq!(std::fs::read_to_string(&path).unwrap(), "some of it");
            std::fs::remove_file(&path).unwrap();
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
