//! Published problems and their largest factors.

use crate::answer::{Answer, ToleranceAnswer, ToleranceRequest};
use crate::error::Source;
use crate::model::Model;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use std::time::Instant;

fn example(name: &str) -> Model {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Model::from_toml(&Source::new(name, std::fs::read_to_string(path).unwrap())).unwrap().0
}

fn answer(model: &Model, request: &ToleranceRequest) -> Answer<ToleranceAnswer> {
    let start = Instant::now();
    let answer = model.ask().tolerance(request, &Budget::unlimited()).unwrap();
    let v = answer.value();
    let f = v.factor.as_ref().unwrap();
    eprintln!(
        "{:?} stable {} lower {} upper {:?} cells {:?} worst {:?} {:?} time {:?}",
        model.title(),
        v.decision.is_stable(),
        to_decimal(&f.lower, 15),
        f.upper.as_ref().map(|u| to_decimal(u, 15)),
        f.proof.as_ref().map(|p| p.cells()),
        v.worst.as_ref().map(|w| (w.end.value.decimal(20), w.end.causes.to_string())),
        f.open.as_ref().map(|o| o.0),
        start.elapsed(),
    );
    answer
}

#[test]
fn figures() {
    for name in ["de-gaston-safonov", "vicino-tesi-milanese", "bus-steering", "fiat-dedra", "unstable-disc"] {
        let model = example(name);
        let a = answer(&model, &ToleranceRequest::of_model(&model).exact());
        eprintln!("exact {:?}", a.value().exact.as_ref().map(|e| (e.tree.leaves(), e.cell.halvings.clone())));
    }
    let drive = Model::drive();
    for names in [
        &["R_a", "L_a", "J", "B_v"][..],
        &["R_a", "L_a", "J", "B_v", "K_a", "k_1", "k_2", "E_sw"],
        &["R_a", "L_a", "J", "B_v", "K_a", "k_1", "k_2", "E_sw", "K_pi", "K_ii", "K_ps", "K_is"],
    ] {
        let t = names.iter().map(|n| (n.to_string(), "20%".parse().unwrap()));
        let a = answer(&drive, &ToleranceRequest::new(t).exact());
        eprintln!("exact {:?}", a.value().exact.as_ref().map(|e| (e.tree.leaves(), e.cell.halvings.clone())));
        let f = a.value().factor.as_ref().unwrap();
        let s: Vec<String> = f.shares.iter().flatten().map(|s: &Rational| to_decimal(s, 4)).collect();
        eprintln!("{s:?} {:?}", f.direction.as_ref().map(|d| d.iter().map(|c| to_decimal(c, 4)).collect::<Vec<_>>()));
    }
}
