//! A question is evaluated once, its boundaries are isolated once, and all that is written comes of one answer.

use jurist::Certificate;
use jurist::{Ask, Document, Text};
use jurist_algebra::limits::{Budget, Progress};
use jurist_check::{Limits, check};
use jurist_engine::model::Model;
use jurist_show::documents;
use std::sync::{Arc, Mutex};

/// Remembers every step that begins.
#[derive(Default)]
struct Steps(Mutex<Vec<String>>);

impl Progress for Steps {
    fn step(&self, name: &str) {
        self.0.lock().unwrap().push(name.to_owned());
    }

    fn advance(&self, _: u64, _: u64) {}
}

impl Steps {
    fn count(&self, name: &str) -> usize {
        self.0.lock().unwrap().iter().filter(|step| *step == name).count()
    }
}

fn counted() -> (Arc<Steps>, Budget) {
    let steps = Arc::new(Steps::default());
    (Arc::clone(&steps), Budget::unlimited().reporting_to(steps))
}

#[test]
fn certificate_document_and_statement_of_a_stable_set_come_of_one_answer() {
    for parameter in ["K_pwm", "T"] {
        let (steps, budget) = counted();
        let model = Model::drive();
        let answer = model.ask().free(parameter).stable_set(&budget).unwrap();
        let certificate = answer.certificate(&budget).unwrap();
        let _ = (jurist::smt2(&answer, &budget).unwrap(), answer.json(12), answer.text(12));
        assert_eq!(steps.count("characteristic polynomial"), 1, "{parameter}");
        assert_eq!(steps.count("boundary polynomials"), 1, "{parameter}");
        assert_eq!(steps.count("isolating the boundaries' zeros"), 1, "{parameter}");
        assert_eq!(steps.count("testing a sample of each cell"), 1, "{parameter}");
        assert!(check(&model.source().text, &certificate, &Limits::default()).is_ok());
        // The end that is printed lies in the enclosure that is proved.
        let end = answer.value().intervals()[0].upper.as_ref().unwrap();
        let (low, high) = end.value.refined_to_digits(12).enclosure();
        assert!(certificate.contains(&low.to_string()) && certificate.contains(&high.to_string()), "{certificate}");
    }
}

#[test]
fn a_verdict_and_its_certificate_evaluate_the_model_once() {
    let (steps, budget) = counted();
    let answer = Model::drive().ask().set("K_pwm", 551).verdict(&budget).unwrap();
    let _ = (answer.certificate(&budget).unwrap(), answer.json(12), answer.text(12));
    assert_eq!(steps.count("characteristic polynomial"), 1);
    assert_eq!(steps.count("counting the roots"), 1);
}

#[test]
fn document_and_text_of_a_map_come_of_one_decomposition() {
    let (steps, budget) = counted();
    let answer = Model::drive().ask().free("T").free("K_pwm").map(12, &budget).unwrap();
    let _ = (answer.json(12), answer.text(12));
    assert_eq!(steps.count("characteristic polynomial"), 1);
    // Once in the direction of either axis: the extents of the regions need both.
    assert_eq!(steps.count("projecting the curves"), 2);
    assert_eq!(steps.count("isolating critical values"), 2);
}

/// What the program does for the page, whose document is that of `--json`.
#[test]
fn the_page_of_a_map_decomposes_nothing_again() {
    use jurist_draw::figures::map::{MapContents, WindowRequest, choose_windows, trace_map};
    let (steps, budget) = counted();
    let answer = Model::drive().ask().free("T").free("K_pwm").map(12, &budget).unwrap();
    let open = || WindowRequest { lower: None, upper: None, logarithmic: None };
    let trace = trace_map(&answer, choose_windows(&answer, &[], &[open(), open()]), &budget).unwrap();
    let contents = MapContents::new(&answer, &trace, Vec::new(), &budget).unwrap();
    let figures = [contents.draw(860.0, 600.0, false), contents.draw(400.0, 470.0, false)];
    let page = jurist_draw::page::map_page(&answer, &contents, &figures, "", &budget).unwrap();
    assert!(page.contains("<svg") && !documents::to_text(&answer.json(12)).is_empty());
    assert_eq!(steps.count("characteristic polynomial"), 1);
    // Once in the direction of either axis: the extents of the regions need both.
    assert_eq!(steps.count("projecting the curves"), 2);
    assert_eq!(steps.count("isolating critical values"), 2);
}
