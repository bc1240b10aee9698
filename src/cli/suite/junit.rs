//! Expectations as a JUnit report, which test servers read: elements and attributes of Jenkins' schema `junit-10.xsd` alone. The few of them
//! need no library.

use jurist_show::documents::{Test, TestStatus, Tested, TestedFile};

/// The report: a suite for each file. What is undecided or could not be tried is an error there.
pub(in crate::cli) fn report(test: &Test) -> String {
    let total = test.passed + test.failed + test.undecided + test.errors;
    let counts = format!("tests=\"{total}\" failures=\"{}\" errors=\"{}\"", test.failed, test.undecided + test.errors);
    let suites: String = test.files.iter().map(suite).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"jurist\" {counts}>\n{suites}</testsuites>\n"
    )
}

fn suite(file: &TestedFile) -> String {
    let count = |statuses: &[TestStatus]| file.tests.iter().filter(|t| statuses.contains(&t.status)).count();
    let name = escaped(&file.file);
    let cases: String = file.tests.iter().map(|test| case(test, &name)).collect();
    format!(
        "  <testsuite name=\"{name}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">\n{cases}  </testsuite>\n",
        file.tests.len(),
        count(&[TestStatus::Failed]),
        count(&[TestStatus::Undecided, TestStatus::Error]),
    )
}

fn case(test: &Tested, file: &str) -> String {
    let head = format!("    <testcase name=\"{}\" classname=\"{file}\"", escaped(&test.name));
    let line = test.line.map(|line| format!(" (line {line})")).unwrap_or_default();
    let text = escaped(&test.text) + &line;
    let (element, kind) = match test.status {
        TestStatus::Passed => return format!("{head}>\n      <system-out>{text}</system-out>\n    </testcase>\n"),
        TestStatus::Failed => ("failure", "failed"),
        TestStatus::Undecided => ("error", "undecided"),
        TestStatus::Error => ("error", "error"),
    };
    format!("{head}>\n      <{element} type=\"{kind}\" message=\"{text}\"/>\n    </testcase>\n")
}

/// A text inside of XML; characters that XML does not have are left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\r' | '\t' => out.push(' '),
            c if c.is_control() || ['\u{fffe}', '\u{ffff}'].contains(&c) => {}
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_is_inside_of_its_element() {
        let tested = |status, text: &str| Tested {
            name: "a < b & \"c\"\u{1}".to_owned(),
            status,
            text: text.to_owned(),
            margin_percent: None,
            row: None,
            line: Some(3),
        };
        let tests = vec![
            tested(TestStatus::Passed, "x"),
            tested(TestStatus::Failed, "1 > 2"),
            tested(TestStatus::Undecided, ""),
        ];
        let report = report(&Test::new(vec![TestedFile { file: "a&b.toml".to_owned(), tests }]));
        assert!(report.contains("name=\"a &lt; b &amp; &quot;c&quot;\" classname=\"a&amp;b.toml\">"));
        assert!(report.contains("tests=\"3\" failures=\"1\" errors=\"1\""));
        assert!(report.contains("<failure type=\"failed\" message=\"1 &gt; 2 (line 3)\"/>"));
    }
}
