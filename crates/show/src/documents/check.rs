//! The documents of a model that is only read: `jurist/check/1`, and SARIF for programs that show findings of any tool.

use super::schema_name;
use jurist_engine::error::{Code, Diagnostic, Label, Severity, Source, codes};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeSet;

schema_name!(CheckName, "jurist/check/1");

/// Every remark on a model file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Check {
    /// The kind of document.
    pub schema: CheckName,
    /// The name of the file.
    pub file: String,
    /// Whether the model can be asked questions: nothing below is an error.
    pub accepted: bool,
    /// What is wrong, and what is only remarked upon, in the order of the text.
    pub diagnostics: Vec<Finding>,
}

/// One remark.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Finding {
    /// Whether the model is refused for it.
    pub severity: FindingSeverity,
    /// The stable code, which `jurist explain` explains.
    pub code: String,
    /// One sentence.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
    /// The place, where there is one.
    pub place: Option<FindingPlace>,
    /// Other places that matter.
    pub related: Vec<FindingPlace>,
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum FindingSeverity {
    /// The model is refused.
    Error,
    /// The model is accepted.
    Warning,
}

/// Where, in lines and columns of characters counted from 1; the end is excluded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FindingPlace {
    /// The line it begins on.
    pub line: usize,
    /// The column it begins at.
    pub column: usize,
    /// The line it ends on.
    pub end_line: usize,
    /// The column after its last character.
    pub end_column: usize,
    /// A few words about this place; may be empty.
    pub text: String,
}

impl Check {
    /// Of all remarks on a text; without a text they have no places.
    ///
    /// ```
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// use jurist_show::documents::Check;
    /// let source = Source::new("model.toml", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - k'");
    /// let error = Model::from_toml(&source).unwrap_err();
    /// let check = Check::new("model.toml", Some(&source), error.diagnostics());
    /// assert!(!check.accepted);
    /// let place = check.diagnostics[0].place.as_ref().unwrap();
    /// assert_eq!((place.line, place.column, place.end_column), (3, 28, 29));
    /// ```
    pub fn new(file: &str, source: Option<&Source>, diagnostics: &[Diagnostic]) -> Check {
        let place = |label: &Label| {
            let source = source?;
            let (line, column) = source.line_column(label.span.start);
            let (end_line, end_column) = source.line_column(label.span.end);
            Some(FindingPlace { line, column, end_line, end_column, text: label.text.clone() })
        };
        let finding = |d: &Diagnostic| Finding {
            severity: match d.severity {
                Severity::Error => FindingSeverity::Error,
                Severity::Warning => FindingSeverity::Warning,
            },
            code: d.code.to_string(),
            message: d.message.clone(),
            help: d.help.clone(),
            place: d.primary.as_ref().and_then(place),
            related: d.secondary.iter().filter_map(place).collect(),
        };
        let mut diagnostics: Vec<Finding> = diagnostics.iter().map(finding).collect();
        diagnostics.sort_by_key(|d| d.place.as_ref().map(|p| (p.line, p.column)));
        let accepted = diagnostics.iter().all(|d| d.severity == FindingSeverity::Warning);
        Check { schema: CheckName::V1, file: file.to_owned(), accepted, diagnostics }
    }

    /// The same as a log of SARIF 2.1.0 (OASIS 2020), with a rule for each code that occurs.
    ///
    /// ```
    /// use jurist_show::documents::Check;
    /// let log = Check::new("model.toml", None, &[]).sarif();
    /// assert_eq!(log["version"], "2.1.0");
    /// assert_eq!(log["runs"][0]["results"].as_array().unwrap().len(), 0);
    /// ```
    pub fn sarif(&self) -> Value {
        Check::sarif_of(std::slice::from_ref(self))
    }

    /// The remarks on several files as one log.
    pub fn sarif_of(checks: &[Check]) -> Value {
        let used: BTreeSet<&str> = checks.iter().flat_map(|c| &c.diagnostics).map(|d| d.code.as_str()).collect();
        let rule = |(code, text): (Code, String)| {
            let short = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
            json!({ "id": code.as_str(), "shortDescription": { "text": short }, "fullDescription": { "text": text } })
        };
        let rules: Vec<Value> = codes().filter(|(code, _)| used.contains(code.as_str())).map(rule).collect();
        let results: Vec<Value> =
            checks.iter().flat_map(|check| check.diagnostics.iter().map(|d| check.sarif_result(d))).collect();
        json!({
            "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
            "version": "2.1.0",
            "runs": [{
                "tool": { "driver": {
                    "name": "jurist",
                    "version": env!("CARGO_PKG_VERSION"),
                    "rules": rules,
                } },
                "columnKind": "unicodeCodePoints",
                "results": results,
            }],
        })
    }

    fn sarif_result(&self, finding: &Finding) -> Value {
        let location = |place: Option<&FindingPlace>| {
            let mut physical = json!({ "artifactLocation": { "uri": uri(&self.file) } });
            if let Some(p) = place {
                physical["region"] = json!({
                    "startLine": p.line, "startColumn": p.column, "endLine": p.end_line, "endColumn": p.end_column,
                });
            }
            let mut location = json!({ "physicalLocation": physical });
            if let Some(p) = place.filter(|p| !p.text.is_empty()) {
                location["message"] = json!({ "text": p.text });
            }
            location
        };
        let message = match &finding.help {
            Some(help) => format!("{}; {help}", finding.message),
            None => finding.message.clone(),
        };
        let related: Vec<Value> = finding.related.iter().map(|p| location(Some(p))).collect();
        json!({
            "ruleId": finding.code,
            "level": finding.severity,
            "message": { "text": message },
            "locations": [location(finding.place.as_ref())],
            "relatedLocations": related,
        })
    }
}

/// A file name as a relative reference: bytes that have a meaning there are written as numbers.
fn uri(file: &str) -> String {
    let mut out = String::new();
    for byte in file.bytes() {
        if byte.is_ascii_alphanumeric() || b"/._-~".contains(&byte) {
            out.push(byte as char);
        } else {
            out.push_str(&format!("%{byte:02X}"));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_engine::model::Model;

    #[test]
    fn places_are_in_characters_and_findings_in_the_order_of_the_text() {
        let text =
            "title = 'Größe'\ntime = 'discrete'\n[parameters]\nK = {}\nñ = {}\n[loop]\ncharacteristic = 'z - Q'\n";
        let source = Source::new("größe 1.toml", text);
        let error = Model::from_toml(&source).unwrap_err();
        let check = Check::new(&source.name, Some(&source), error.diagnostics());
        assert!(!check.accepted);
        let places: Vec<_> =
            check.diagnostics.iter().filter_map(|d| d.place.as_ref()).map(|p| (p.line, p.column)).collect();
        assert!(places.is_sorted() && !places.is_empty(), "{places:?}");
        let log = check.sarif();
        let uri = &log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"];
        assert_eq!(uri, "gr%C3%B6%C3%9Fe%201.toml");
        let rules = log["runs"][0]["tool"]["driver"]["rules"].as_array().unwrap();
        assert!(check.diagnostics.iter().all(|d| rules.iter().any(|r| r["id"] == d.code.as_str())));
    }
}
