//! The document of expectations that were tried: `jurist/test/1`.

use super::schema_name;
use serde::{Deserialize, Serialize};

schema_name!(TestName, "jurist/test/1");

/// What became of expectations.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Test {
    /// The kind of document.
    pub schema: TestName,
    /// How many hold.
    pub passed: usize,
    /// How many do not hold.
    pub failed: usize,
    /// How many were not decided within the work that was allowed.
    pub undecided: usize,
    /// How many could not be tried: a file, a name or a value is wrong.
    pub errors: usize,
    /// The files, in the order in which they were given or found.
    pub files: Vec<TestedFile>,
}

/// A file with expectations, and a model that has them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TestedFile {
    /// Its name.
    pub file: String,
    /// Its expectations.
    pub tests: Vec<Tested>,
}

/// One expectation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tested {
    /// What is expected, in words; with the name of the entry before it, where it has one.
    pub name: String,
    /// What became of it.
    pub status: TestStatus,
    /// What was found.
    pub text: String,
    /// How far what was found is from failing, as a share of what is expected in percent, rounded; negative where it failed. `null` where
    /// there is no such number.
    pub margin_percent: Option<serde_json::Number>,
    /// Which operating point was the worst, where there are several: the row of the table, counted from 1 without its head.
    pub row: Option<usize>,
    /// The line of the file that says so; `null` where none does.
    pub line: Option<usize>,
}

/// What became of an expectation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum TestStatus {
    /// It holds.
    Passed,
    /// Not decided within the work that was allowed.
    Undecided,
    /// It does not hold.
    Failed,
    /// It could not be tried.
    Error,
}

impl Test {
    /// Of files with their expectations.
    ///
    /// ```
    /// use jurist_show::documents::Test;
    /// assert_eq!(Test::new(Vec::new()).passed, 0);
    /// ```
    pub fn new(files: Vec<TestedFile>) -> Test {
        let count = |status| files.iter().flat_map(|f| &f.tests).filter(|t| t.status == status).count();
        Test {
            schema: TestName::V1,
            passed: count(TestStatus::Passed),
            failed: count(TestStatus::Failed),
            undecided: count(TestStatus::Undecided),
            errors: count(TestStatus::Error),
            files,
        }
    }
}
