//! Leaves `+` of requirements by a disc: what is shown at its edge, and at one point.

use crate::writer::{Asked, LIMITS, written};
use crate::{INPUT, is_thorough, loop_of, other, proof};
use jurist_check::{Step, check};

/// The three proofs over a range of `K`; `None` where the judge does not see one.
fn proofs(model: &str, asked: &Asked) -> Vec<Option<String>> {
    let judge = asked.judge(model);
    judge.proofs(&judge.whole(0), 0).into_iter().map(|part| proof(&judge, 0, part, &mut 300)).collect()
}

/// That a loop shows these parts alone, and that no text stands for the one that is missing.
fn seen(model: &str, asked: &Asked, expected: [bool; 3]) {
    let own = proofs(model, asked);
    assert_eq!(own.iter().map(Option::is_some).collect::<Vec<_>>(), expected, "{own:?}");
    for forged in [".", "b..", "c..", "bb...", "cc...", "bcb....", "a..", ""] {
        let tree: String = own.iter().map(|own| own.as_deref().unwrap_or(forged)).collect();
        assert!(check(model, &asked.certificate(&format!("+{tree}")), &LIMITS).is_err(), "{tree}");
    }
}

const AROUND_TWO: &str = r#"{"name": "K", "between": ["19/10", "21/10"]}"#;

#[test]
#[ignore = "long: CI runs it"]
fn each_half_of_the_edge_is_needed() {
    // At its nearest `1 + L` is to the right of zero.
    let third = loop_of("continuous", "K/(s*(s + 1)*(s + 2))", "parameters.K = {}");
    let asked =
        |bound: &str| Asked::of("continuous").for_all(AROUND_TWO).require(other("modulus_margin", INPUT, bound));
    seen(&third, &asked("3/5"), [false, true, true]);
    assert!(!is_thorough() || proofs(&third, &asked("1/3")).iter().all(Option::is_some));
    // Of K/(s^2 + s + K) the peak is below the frequency at which it is imaginary.
    let second = loop_of("continuous", "K/(s*(s + 1))", "parameters.K = {}");
    let asked =
        |bound: &str| Asked::of("continuous").for_all(AROUND_TWO).require(other("complementary_peak", INPUT, bound));
    seen(&second, &asked("3/2"), [true, false, true]);
    assert!(!is_thorough() || proofs(&second, &asked("8/5")).iter().all(Option::is_some));
}

/// `1 + L` is about a tenth everywhere: no number on the edge of a larger disc is reached, and all inside of it are.
#[test]
fn a_loop_inside_of_the_disc_everywhere_is_not_good() {
    let model = loop_of("discrete", "K*(z + 1/100)/(z + 2/100)", "parameters.K = {}");
    let range = r#"{"name": "K", "between": ["-91/100", "-89/100"]}"#;
    for axes in [true, false] {
        let asked = |bound: &str| {
            let asked = Asked::of("discrete").require(other("modulus_margin", INPUT, bound));
            if axes { asked.axes(range) } else { asked.for_all(range) }
        };
        seen(&model, &asked("1/2"), [true, true, false]);
        let (certificate, tree) = written(&model, &asked("1/20"), 0, 300);
        assert!(tree.starts_with('+') && check(&model, &certificate, &LIMITS).is_ok(), "{tree}");
    }
}

/// A complex loop whose `1 + L` is about a tenth of `j`: real numbers of the disc tell nothing.
#[test]
fn a_complex_loop_is_asked_about_the_whole_disc_at_one_point() {
    let model = loop_of("discrete", "K*(z + 1/100)/(z + 2/100) - 1 + j/10", "parameters.K = {}");
    let range = r#"{"name": "K", "between": ["-1/100", "1/100"]}"#;
    let asked = |bound: &str| Asked::of("discrete").for_all(range).require(other("modulus_margin", INPUT, bound));
    seen(&model, &asked("1/2"), [true, true, false]);
    assert!(proofs(&model, &asked("1/20")).iter().all(Option::is_some));
}

/// Where a divisor has the factor, the edge tells nothing of where it vanishes.
#[test]
fn divisors_with_the_factor_are_asked_about_over_all_of_the_disc() {
    let at = r#"{"parameter": "K"}"#;
    let asked =
        |bound: &str| Asked::of("continuous").for_all(AROUND_TWO).require(other("complementary_peak", at, bound));
    let model = |divisor: &str| {
        loop_of("continuous", "K/(s + 1)", &format!("parameters.K = {{}}\nconstants.unused = '1/({divisor})'"))
    };
    let counts = |divisor: &str| proofs(&model(divisor), &asked("3/2")).len();
    assert_eq!([counts("K - 5/2"), counts("K + 9"), counts("7")], [1, 1, 3]);
    // 5/2 is one of the numbers 2 (1 + 2 d/3).
    assert_eq!(proofs(&model("K - 5/2"), &asked("3/2")), [None]);
    assert!(proofs(&model("K + 9"), &asked("3/2"))[0].is_some());
}

#[test]
fn each_part_has_its_own_sides() {
    let model = loop_of("continuous", "K/(s*(s + 1)*(s + 2))", "parameters.K = {}");
    let asked = Asked::of("continuous").axes(AROUND_TWO).require(other("modulus_margin", INPUT, "1/3"));
    let [Some(plus), Some(minus), Some(across)] = &proofs(&model, &asked)[..] else { panic!("all are shown") };
    let step = |tree: String| check(&model, &asked.certificate(&tree), &LIMITS).map_err(|e| e.step).err();
    assert_eq!(step(format!("+{plus}{minus}{across}")), None);
    assert_eq!(step(format!("+{plus}{minus}")), Some(Step::Line));
    assert_eq!(step(format!("+{plus}{minus}{across}.")), Some(Step::Line));
    // The edge is not halved in the radius, nor the point in anything else.
    for wrong in [
        format!("+b..{minus}{across}"),
        format!("+{plus}b..{across}"),
        format!("+{plus}{minus}a.."),
        format!("+{plus}{minus}c.."),
    ] {
        assert_eq!(step(wrong.clone()), Some(Step::Line), "{wrong}");
    }
    // Without axes and names for all it is one part.
    let one = Asked::of("continuous").set(r#""K": "2""#).require(other("modulus_margin", INPUT, "1/3"));
    let (certificate, tree) = written(&model, &one, 0, 300);
    assert!(check(&model, &certificate, &LIMITS).is_ok());
    let forged = format!("{tree}..");
    assert!(check(&model, &one.certificate(&forged), &LIMITS).is_err());
}
