//! Every output has a name of its own, and none of them is an input's: looked at before any work.

use super::arguments::{Arguments, PictureOptions};
use super::assignments::in_line;
use super::commands::Context;
use super::output::{ending, write_error};
use super::picture::WRITES;
use super::replace::Destination;
use super::status::Error;
use jurist_engine::error::{Code, Diagnostic};
use std::ffi::{OsStr, OsString};
use std::fs::{Metadata, OpenOptions};
use std::path::{Path, PathBuf};

/// What a command reads and writes, each with the word that says what it is.
#[derive(Default)]
pub(super) struct Files<'a> {
    pub inputs: Vec<(&'static str, &'a OsStr)>,
    pub outputs: Vec<(&'static str, OsString)>,
}

/// Refuses two outputs with one name, an output that would replace an input, and names that cannot be written.
pub(super) fn check(arguments: &Arguments, context: &Context) -> Result<(), Error> {
    let mut names = Files::default();
    arguments.asked().files(&mut names)?;
    let refuse = |diagnostic: Diagnostic, name: &OsStr| -> Error {
        let place = context.line.argument(&name.to_string_lossy()).filter(|_| !is_standard(name));
        let diagnostic = match place {
            Some(span) => diagnostic.at(span, ""),
            None => diagnostic,
        };
        in_line(context.line, vec![diagnostic]).into()
    };
    let inputs: Vec<_> = names.inputs.iter().map(|(what, name)| (what, name, Identity::of_input(name))).collect();
    let mut outputs: Vec<(&str, Identity)> = Vec::new();
    for (what, name) in &names.outputs {
        if !WRITES && name != "-" {
            let error = Diagnostic::error(Code::Write, format!("{what} goes to standard output here, not to a file"));
            return Err(refuse(error.help("the program 'jurist' writes files"), name));
        }
        let identity = Identity::of_output(name)?;
        if let Some((input, path, _)) = inputs.iter().find(|(_, _, input)| identity.is_some() && *input == identity) {
            let shown = if **path == "-" { "standard input".into() } else { path.to_string_lossy() };
            let message = format!("{what} would replace {input} itself, {shown}");
            return Err(refuse(Diagnostic::error(Code::OutputName, message).help("give it another name"), name));
        }
        let Some(identity) = identity else { continue };
        if let Some((other, _)) = outputs.iter().find(|(_, other)| *other == identity) {
            let (place, help) = if is_standard(name) {
                ("standard output".into(), "write one of them to a file: -o FILE, or a name instead of '-'")
            } else {
                (name.to_string_lossy(), "give each of them a name of its own")
            };
            let message = format!("{other} and {what} would both be written to {place}");
            return Err(refuse(Diagnostic::error(Code::OutputName, message).help(help), name));
        }
        outputs.push((what, identity));
    }
    Ok(())
}

/// Refuses outputs that would replace a file of which it is known only now that it is read: one of a folder, or one that another file names.
#[cfg(feature = "cli")]
pub(super) fn check_read<'n>(
    context: &Context,
    outputs: impl IntoIterator<Item = (&'static str, &'n OsString)>,
    read: &[PathBuf],
) -> Result<(), Error> {
    for (what, name) in outputs {
        let Some(identity) = Identity::of_output(name)? else { continue };
        if let Some(path) = read.iter().find(|path| Identity::of_input(path.as_os_str()).is_some_and(|i| i == identity))
        {
            let message = format!("{what} would replace {}, which is read", path.display());
            let mut error = Diagnostic::error(Code::OutputName, message).help("give it another name");
            if let Some(span) = context.line.argument(&name.to_string_lossy()) {
                error = error.at(span, "");
            }
            return Err(in_line(context.line, vec![error]).into());
        }
    }
    Ok(())
}

fn is_standard(name: &OsStr) -> bool {
    name == "-" || matches!(Destination::of(Path::new(name)), Ok(Destination::StandardOutput))
}

impl<'a> Files<'a> {
    /// The answer, in a file or on standard output.
    pub fn answer(&mut self, file: Option<&OsString>) {
        self.outputs.push(("the answer", file.cloned().unwrap_or_else(|| "-".into())));
    }

    /// A model, and the answer about it.
    pub fn question(&mut self, model: &'a Option<OsString>, file: &Option<OsString>) {
        self.inputs.extend(model.iter().map(|model| ("the model", model.as_os_str())));
        self.answer(file.as_ref());
    }

    /// A model, and a picture with the table that is written beside it.
    pub fn picture(&mut self, model: &'a Option<OsString>, options: &PictureOptions) -> Result<(), Error> {
        self.question(model, &options.output);
        if !options.csv {
            return Ok(());
        }
        let Some(file) = options.output.as_ref().filter(|file| *file != "-") else {
            let help = "name the picture's file: -o FILE.svg; without '--csv' a table goes to a pipe";
            return Err(Diagnostic::error(Code::Usage, "'--csv' writes beside a picture, and there is none")
                .help(help)
                .into());
        };
        // Of a table alone there is no second one.
        if options.json || ending(file).as_deref() != Some("csv") {
            self.outputs.push(("the table of '--csv'", Path::new(file).with_extension("csv").into()));
        }
        Ok(())
    }
}

/// What makes two names the same: links and spellings apart, a file is one file.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Identity {
    /// Standard output where it is no file.
    StandardOutput,
    /// A file that is there: device and number.
    #[cfg(unix)]
    Number(u64, u64),
    /// The whole path: of a file that is not there yet, or on systems without numbers.
    Path(PathBuf),
}

impl Identity {
    /// Of a name to be written; `None` for what takes any number of outputs, such as `/dev/null`.
    fn of_output(name: &OsStr) -> Result<Option<Identity>, Error> {
        if name.is_empty() {
            return Err(Diagnostic::error(Code::Write, "the name of an output file is empty")
                .help("name a file, or '-' for standard output")
                .into());
        }
        let path = Path::new(name);
        let wrong = |e: std::io::Error| write_error(&name.to_string_lossy(), &e);
        let destination =
            if name == "-" { Destination::StandardOutput } else { Destination::of(path).map_err(wrong)? };
        let file = match destination {
            Destination::StandardOutput => {
                let redirected = std::fs::metadata("/dev/stdout").ok().and_then(|found| Identity::of_file(&found));
                return Ok(Some(redirected.unwrap_or(Identity::StandardOutput)));
            }
            Destination::Special(_) => return Ok(None),
            Destination::File(file) => file,
        };
        if let Ok(found) = std::fs::metadata(&file) {
            OpenOptions::new().write(true).open(&file).map_err(wrong)?;
            if let Some(identity) = Identity::of_file(&found) {
                return Ok(Some(identity));
            }
        }
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().map_err(wrong)?;
        Ok(Some(Identity::Path(file.file_name().map_or(folder.clone(), |name| folder.join(name)))))
    }

    /// Of a name to be read; `None` for what is no file.
    fn of_input(name: &OsStr) -> Option<Identity> {
        let path = Path::new(if name == "-" { OsStr::new("/dev/stdin") } else { name });
        Identity::of_file(&std::fs::metadata(path).ok()?).or_else(|| path.canonicalize().ok().map(Identity::Path))
    }

    #[cfg(unix)]
    fn of_file(found: &Metadata) -> Option<Identity> {
        use std::os::unix::fs::MetadataExt;
        found.is_file().then(|| Identity::Number(found.dev(), found.ino()))
    }

    #[cfg(not(unix))]
    fn of_file(_: &Metadata) -> Option<Identity> {
        None
    }
}
