//! Which files have expectations, and the models that these are about.

use super::{InText, lock};
use crate::cli::status::Error;
use crate::cli::table::{Point, Table};
use crate::references::{COPY, Resolved};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source, Span};
use jurist_engine::model::{Claim, ClaimKind, Expectation, Model, source_from_bytes};
use jurist_show::documents::Lock;
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Longer files are refused.
const MAX_BYTES: u64 = 64 << 20;

/// Folders are not read deeper.
const MAX_DEPTH: usize = 32;

/// A file with what is expected in it.
pub(in crate::cli) struct Suite {
    pub file: String,
    /// What is to be tried, or why nothing can be.
    pub entries: Result<Vec<Entry>, Error>,
    /// The model with the file that holds its limits fast.
    pub lock: Option<Locked>,
}

/// A model with the file that holds its limits fast.
pub(in crate::cli) struct Locked {
    pub model: Arc<Model>,
    /// The file, or why it is none.
    pub lock: Result<Lock, Error>,
}

/// Claims about one model.
pub(in crate::cli) struct Entry {
    /// What the entry is called.
    pub name: Option<String>,
    pub claims: Vec<(ClaimKind, Option<InText>)>,
    pub model: Arc<Model>,
    pub set: Point,
    pub cases: Option<Arc<Table>>,
    /// Where files that it names are.
    pub folder: PathBuf,
}

/// Reads files once, however often they are named.
pub(in crate::cli) struct Collector {
    models: HashMap<PathBuf, Result<Arc<Model>, Error>>,
    /// Operating points of all entries that name none.
    cases: Option<Arc<Table>>,
    /// Sentences about numbers that came from other files.
    pub notes: Vec<String>,
    /// All files that were read.
    pub read: Vec<PathBuf>,
}

impl Collector {
    pub fn new(cases: Option<Arc<Table>>) -> Collector {
        Collector { models: HashMap::new(), cases, notes: Vec::new(), read: Vec::new() }
    }

    /// What is expected in the files, and in those of folders that expect or require something.
    pub fn suites(&mut self, paths: &[OsString]) -> Result<Vec<Suite>, Error> {
        let mut files = Vec::new();
        for path in paths.iter().map(Path::new) {
            if path.is_dir() {
                let before = files.len();
                // Without './' before names: code hosts know files by what follows.
                in_folder(if path == Path::new(".") { Path::new("") } else { path }, 0, &mut files);
                if files.len() == before {
                    let error = Diagnostic::error(Code::Missing, format!("{} has no expectations", path.display()));
                    let help =
                        "a model with [[expect]] or [require], a file jurist-tests.toml, or a lock of 'jurist lock'";
                    return Err(error.help(help).into());
                }
            } else {
                files.push(path.to_owned());
            }
        }
        let mut known = HashSet::new();
        files.retain(|file| known.insert(file.canonicalize().unwrap_or_else(|_| file.clone())));
        self.read.extend(files.iter().flat_map(|file| [file.clone(), lock::file_of(file)]));
        Ok(files.iter().map(|file| self.suite(file)).collect())
    }

    fn suite(&mut self, path: &Path) -> Suite {
        let file = path.display().to_string();
        let is_named = path.file_name().is_some_and(|name| name == "jurist-tests.toml");
        let read = text(path).and_then(|source| match is_named || Expectation::is_a_file_of(&source.text) {
            true => self.of_tests(&source, path).map(|entries| (entries, None)),
            false => self.of_model(path),
        });
        match read {
            Ok((entries, lock)) => Suite { file, entries: Ok(entries), lock },
            Err(error) => Suite { file, entries: Err(error), lock: None },
        }
    }

    /// The entries of a model file, its requirements, and its lock.
    fn of_model(&mut self, path: &Path) -> Result<(Vec<Entry>, Option<Locked>), Error> {
        let model = self.model(path)?;
        let folder = folder(path);
        let lock = lock::of(path).map(|lock| Locked { model: Arc::clone(&model), lock });
        let mut entries = Vec::new();
        for expectation in model.expectations() {
            entries.push(self.entry(expectation, &model, &folder)?);
        }
        let is_required = entries.iter().any(|entry| {
            entry.set.is_empty() && entry.claims.iter().any(|(claim, _)| matches!(claim, ClaimKind::Require(_)))
        });
        let claim = match model.require() {
            [first, ..] if !is_required => {
                Some((ClaimKind::Require(Vec::new()), Some((Arc::clone(model.source()), first.span))))
            }
            [] if entries.is_empty() && lock.is_none() => Some((ClaimKind::Verdict("stable".to_owned()), None)),
            _ => None,
        };
        if let Some(claim) = claim {
            let cases = self.cases.clone();
            if let Some(cases) = &cases {
                cases.check(&model)?;
            }
            let set = Vec::new();
            entries.push(Entry { name: None, claims: vec![claim], model, set, cases, folder });
        }
        Ok((entries, lock))
    }

    /// The entries of a file of expectations.
    fn of_tests(&mut self, source: &Arc<Source>, path: &Path) -> Result<Vec<Entry>, Error> {
        let folder = folder(path);
        let mut entries = Vec::new();
        let mut unknown = Vec::new();
        for expectation in Expectation::from_toml(source)? {
            let Some((file, span)) = &expectation.model else { continue };
            let model = self.model(&folder.join(file)).map_err(|error| match error {
                // A file that cannot be read is shown where it is named; what is wrong inside of one there.
                Error::Refused(refused) if refused.code() == Code::Read => {
                    let said = refused.diagnostics().first().map(|d| d.message.clone()).unwrap_or_default();
                    let error = Diagnostic::error(Code::Read, said).at(*span, "the model");
                    Diagnostics::new(Some(Arc::clone(source)), vec![error]).into()
                }
                other => other,
            })?;
            unknown.extend(expectation.unknown_names(&model));
            entries.push(self.entry(&expectation, &model, &folder)?);
        }
        if !unknown.is_empty() {
            return Err(Diagnostics::new(Some(Arc::clone(source)), unknown).into());
        }
        Ok(entries)
    }

    fn entry(&mut self, expectation: &Expectation, model: &Arc<Model>, folder: &Path) -> Result<Entry, Error> {
        let certificate = |claim: &Claim| match &claim.kind {
            ClaimKind::Certificate(file) => Some(folder.join(file)),
            _ => None,
        };
        self.read.extend(expectation.claims.iter().filter_map(certificate));
        self.read.extend(expectation.cases.iter().map(|(file, _)| folder.join(file)));
        let cases = match &expectation.cases {
            Some((file, span)) => {
                let table = text(&folder.join(file)).map_err(|error| placed(error, expectation, *span))?;
                Some(Arc::new(Table::read(&table)?))
            }
            None => self.cases.clone(),
        };
        if let Some(cases) = &cases {
            cases.check(model)?;
        }
        let place = |claim: &Claim| (claim.kind.clone(), Some((Arc::clone(&expectation.source), claim.span)));
        Ok(Entry {
            name: expectation.name.clone(),
            claims: expectation.claims.iter().map(place).collect(),
            model: Arc::clone(model),
            set: expectation.set.iter().map(|(name, value)| (name.name.clone(), value.clone())).collect(),
            cases,
            folder: folder.to_owned(),
        })
    }

    fn model(&mut self, path: &Path) -> Result<Arc<Model>, Error> {
        if let Some(known) = self.models.get(path) {
            return known.clone();
        }
        self.read.push(path.to_owned());
        let read = text(path).and_then(|source| {
            let resolved = Resolved::of(&source, &folder(path))?;
            self.read.extend(resolved.numbers.iter().map(|number| folder(path).join(number.file())));
            self.notes.extend(resolved.numbers.iter().map(|number| format!("{}: {}", path.display(), number.text())));
            let (model, _) = Model::from_toml(&resolved.source)?;
            Ok(Arc::new(model))
        });
        self.models.insert(path.to_owned(), read.clone());
        read
    }
}

/// The error of a file that is named by an entry.
fn placed(error: Error, expectation: &Expectation, span: Span) -> Error {
    match error {
        Error::Refused(refused) => {
            let said = refused.diagnostics().first().map(|d| d.message.clone()).unwrap_or_default();
            let error = Diagnostic::error(Code::Read, said).at(span, "named here");
            Diagnostics::new(Some(Arc::clone(&expectation.source)), vec![error]).into()
        }
        other => other,
    }
}

fn folder(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// The text of a file.
pub(in crate::cli) fn text(path: &Path) -> Result<Arc<Source>, Error> {
    let name = path.display().to_string();
    let cannot = |why: String| Error::from(Diagnostic::error(Code::Read, format!("cannot read {name}: {why}")));
    let length = std::fs::metadata(path).map_err(|e| cannot(crate::cli::output::plain(&e)))?.len();
    if length > MAX_BYTES {
        return Err(cannot(format!("it is longer than {} megabytes", MAX_BYTES >> 20)));
    }
    let bytes = std::fs::read(path).map_err(|e| cannot(crate::cli::output::plain(&e)))?;
    Ok(source_from_bytes(&name, &bytes)?)
}

/// The files below a folder that expect something, in the order of their names.
fn in_folder(folder: &Path, depth: usize, files: &mut Vec<PathBuf>) {
    let read = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = std::fs::read_dir(read) else { return };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| folder.join(entry.file_name())).collect();
    paths.sort();
    for path in paths {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let is_kept = !name.starts_with('.') && !["target", "node_modules"].contains(&name.as_str());
        if path.is_dir() && !path.is_symlink() && is_kept && depth < MAX_DEPTH {
            in_folder(&path, depth + 1, files);
        } else if name.ends_with(".toml") && path.is_file() && expects(&path) {
            files.push(path);
        }
    }
}

/// Whether a file expects or requires something, or is locked, or cannot be read, which is an error of its own. A copy of a model that
/// holds numbers of other files is not the model.
fn expects(path: &Path) -> bool {
    let is_copy = |text: &str| text.lines().any(|line| line.starts_with(COPY));
    let says = |source: &Source| Expectation::are_in(&source.text) && !is_copy(&source.text);
    lock::file_of(path).is_file() || text(path).map_or(true, |source| says(&source))
}
