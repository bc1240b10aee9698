//! Certificates of loops with several rates: both checkers lift the loop themselves, from the equations of its blocks.

use crate::helpers::certificates::checkers::{accept, reject};
use crate::helpers::certificates::{emitted, verdict_emitted};
use crate::helpers::model::{example_text, read};
use crate::helpers::random::Random;
use crate::loops::rates::{Cascade, position};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::Step;
use jurist_engine::error::Code;

/// The drive of the examples with its motor by the forward rule, so that all is rational.
fn drive() -> String {
    example_text("drive-two-rates").replace("discretize = \"zoh\"", "discretize = \"forward\"")
}

#[test]
fn both_checkers_lift_a_loop_and_find_the_same_limits() {
    for rate in ["every = 1", "every = 2", "every = 4\nphase = 3"] {
        let text = position(rate);
        for name in ["K_p", "K_v"] {
            accept(&text, &emitted(&text, name));
        }
        accept(&text, &verdict_emitted(&text, "K_p", "1/2"));
        accept(&text, &verdict_emitted(&text, "K_p", "3"));
    }
    accept(&drive(), &emitted(&drive(), "K_ps"));
}

/// A rule of a slower block has the block's own period, by the loop's sample time.
#[test]
fn a_rule_of_a_slow_block_has_its_own_period_in_the_checkers_too() {
    let text =
        position("every = 3").replace("gain = 'K_p'", "transfer = 'K_p*(s + 1/5)/(s + 2)'\ndiscretize = 'tustin'");
    accept(&text, &emitted(&text, "K_p"));
}

#[test]
#[ignore = "long: CI runs it"]
fn random_rates_and_phases_are_read_alike() {
    let mut random = Random::new(11);
    for _ in 0..25 {
        let text = Cascade::random(&mut random).text();
        accept(&text, &emitted(&text, "K"));
    }
}

#[test]
fn a_certificate_of_other_rates_is_rejected() {
    let text = position("every = 4\nphase = 1");
    let own = emitted(&text, "K_p");
    for other in ["every = 2\nphase = 1", "every = 3\nphase = 1", "every = 1", ""] {
        reject(&position(other), &own, Step::Characteristic);
    }
    // Where one block alone is slow its phase changes nothing.
    accept(&position("every = 4"), &own);
    for wrong in ["every = 0", "every = '5/2'", "every = 4\nphase = 4", "every = 4\nphase = -1", "every = 'K_v'"] {
        reject(&position(wrong), &own, Step::Model);
    }
    let held = text.replace("discretize = 'zoh'", "discretize = 'zoh'\nevery = 2");
    reject(&held, &own, Step::Model);
    // A smaller circle has no meaning that is agreed on.
    reject(&text, &own.replace("\"radius\": \"1\"", "\"radius\": \"1/2\""), Step::Model);
}

#[test]
fn what_the_checkers_do_not_lift_is_refused_before_anything_is_computed() {
    let refused = |text: &str| {
        let answer = read(text).ask().verdict(&Budget::unlimited()).unwrap();
        let Err(jurist_engine::error::Error::Refused(why)) = answer.certificate(&Budget::unlimited()) else {
            panic!("{text}")
        };
        assert_eq!(why.code(), Code::NoCertificate);
        why.to_string()
    };
    assert!(refused(&position("sample_time = 4")).contains("by a sample time"));
    assert!(refused(&position("every = 200")).contains("more equations"));
}
