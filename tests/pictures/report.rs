//! The report on the paper: complete, self-contained, its errata those that are known.

use jurist_algebra::limits::Budget;
use jurist_drive::{PaperReport, errata, paper_report};
use jurist_engine::model::Model;
use std::sync::OnceLock;

fn report() -> &'static PaperReport {
    static REPORT: OnceLock<PaperReport> = OnceLock::new();
    REPORT.get_or_init(|| paper_report(&Budget::unlimited()).expect("nothing limits it"))
}

#[test]
#[ignore = "long: CI runs it"]
fn every_section_is_there() {
    let html = &report().html;
    let sections =
        ["drive", "model", "equations", "errata", "jury", "locus", "responses", "limits", "sensitivity", "proved"];
    for id in sections {
        assert!(html.contains(&format!("<section id=\"{id}\">")), "{id}");
        assert!(html.contains(&format!("href=\"#{id}\"")), "{id}");
    }
    for tag in ["section", "table", "figure", "svg", "div", "details", "ul"] {
        let count = |text: &str| html.matches(text).count();
        let opened = count(&format!("<{tag} ")) + count(&format!("<{tag}>"));
        assert_eq!(opened, count(&format!("</{tag}>")), "{tag}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn nothing_is_fetched_from_outside() {
    let html = &report().html;
    // Names of XML vocabularies are no addresses.
    let bare = html.replace("http://www.w3.org/2000/svg", "").replace("http://www.w3.org/1999/xlink", "");
    for trace in ["http:", "https:", "src=", "<script", "<link", "@import", "url(http"] {
        assert!(!bare.contains(trace), "{trace}");
    }
    assert!(html.contains("name=\"viewport\"") && html.contains("@media print"));
}

#[test]
#[ignore = "long: CI runs it"]
fn no_name_is_given_twice_and_every_reference_has_its_name() {
    // Two clip paths of one name cut both figures by the first: so were halves of the figures lost.
    let html = &report().html;
    let mut names: Vec<&str> = html.split(" id=\"").skip(1).filter_map(|p| p.split('"').next()).collect();
    assert!(names.len() > 3, "{names:?}");
    let referred: Vec<&str> = html.split("url(#").skip(1).filter_map(|p| p.split(')').next()).collect();
    assert!(referred.iter().all(|r| names.contains(r)));
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn the_errata_are_those_known() {
    let rows = errata(&Model::drive(), &Budget::unlimited()).unwrap().rows;
    let found: Vec<(&str, &str)> = rows.iter().map(|r| (r[0].as_str(), r[1].as_str())).collect();
    assert_eq!(
        found,
        [
            ("Eq. 5, entry (1,1)", "(L_a - R_a)/L_a"),
            ("Eq. 13, entry (2,1)", "-K_a*T/J"),
            ("list after Eq. 36, a_1, K_pwm", "1.80919241724e-3"),
            ("Eq. 37, a_0, T^4", "736568.879"),
            ("Eq. 37, a_1, T^2", "26420.0562"),
            ("Eq. 37, a_1, T^3", "-4285.49167"),
            ("Eq. 37, a_2, T", "5956.43571"),
            ("Eq. 37, a_2, T^4", "736568.879"),
            ("Eq. 37, a_3, T^3", "4285.49167"),
            ("Eq. 37, a_4, T", "1927.27816"),
        ]
    );
    assert!(rows[0][3].ends_with("of the 9 numbers of Eq. 23, the exact entry 9"), "{}", rows[0][3]);
    assert!(!rows[1][3].contains("gives 9 of"), "{}", rows[1][3]);
    assert!(rows[6][2].starts_with("5956.43571"), "{}", rows[6][2]);
}

#[test]
#[ignore = "long: CI runs it"]
fn all_figures_are_drawn() {
    let names: Vec<&str> = report().figures.iter().map(|f| f.name.as_str()).collect();
    for k in 1..=6 {
        assert!(names.contains(&format!("fig-{k:02}").as_str()));
    }
    for k in 7..=14 {
        for kind in ["linear", "from-rest", "disturbed"] {
            assert!(names.contains(&format!("fig-{k:02}-{kind}").as_str()), "{k} {kind}");
        }
    }
    for figure in &report().figures {
        assert!(!figure.figure.svg().contains("NaN"), "{}", figure.name);
    }
    // The two panels of the root locus stand apart in the page, so that a phone shows both.
    assert_eq!(report().html.matches("<figure>").count(), names.len() + 1);
}

#[test]
#[ignore = "long: CI runs it"]
fn limits_are_in_the_tables() {
    let html = &report().html;
    for limit in [
        "0.03810053334829916",
        "550.9411666866746",
        "2012.316402232909",
        "2.985319690",
        "551.741",
        "2003.12",
        "551.012",
        "2005.92",
    ] {
        assert!(html.contains(limit), "{limit}");
    }
    for crossing in ["38.101 mV", "0.506 Hz", "550.94 V", "1664 Hz"] {
        assert!(html.contains(crossing), "{crossing}");
    }
    for (name, limit) in [("J", "0.0837"), ("K_is", "5.5")] {
        assert!(html.contains(limit), "{name}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn the_latex_tables_are_balanced_and_plain() {
    let latex = &report().latex;
    for environment in ["table", "tabular"] {
        assert_eq!(latex.matches(&format!("\\begin{{{environment}}}")).count(), 7, "{environment}");
        assert_eq!(latex.matches(&format!("\\end{{{environment}}}")).count(), 7, "{environment}");
    }
    for label in ["limits", "equation-23", "equation-37", "jury", "conditions", "errata", "sensitivity"] {
        assert_eq!(latex.matches(&format!("\\label{{tab:{label}}}")).count(), 1, "{label}");
    }
    // Without packages: no letter that the old encodings lack.
    assert!(latex.is_ascii(), "{:?}", latex.chars().find(|c| !c.is_ascii()));
    for line in latex.lines() {
        let bare = line.replace("\\\\", "").replace("\\{", "").replace("\\}", "").replace("\\$", "").replace("\\&", "");
        assert_eq!(bare.matches('{').count(), bare.matches('}').count(), "{line}");
        assert_eq!(bare.matches('$').count() % 2, 0, "{line}");
    }
    // Every row of a table has as many cells as its head.
    for table in latex.split("\\begin{tabular}").skip(1) {
        let rows: Vec<usize> = table
            .split("\\end{tabular}")
            .next()
            .unwrap()
            .lines()
            .filter(|l| l.ends_with("\\tabularnewline"))
            .map(|l| l.replace("\\&", "").matches('&').count())
            .collect();
        assert!(rows.iter().all(|n| *n <= rows[0]), "{rows:?}");
    }
    for value in ["550.9411666866746", "551.741", "736568.879", "$K_{\\mathrm{pwm}}$"] {
        assert!(latex.contains(value), "{value}");
    }
}
