//! The conditions of Schur and Cohn, and of Hermite, of loops with complex coefficients.

use super::oracle::{Loop, is_hurwitz, is_schur};
use super::table::{machine, turned};
use crate::helpers::model::read;
use crate::helpers::number::ratio;
use crate::helpers::program::jurist_with_input;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, Sign};
use jurist_engine::answer::Verdict;
use jurist_engine::stability::{Inequality, Table};

fn printed(arguments: &[&str], text: &str) -> String {
    let run = jurist_with_input(arguments, text.as_bytes());
    assert_eq!(run.status, 0, "{}\n{text}", run.stderr);
    run.stdout
}

/// The signs of the minors tell how many roots are inside and how many are not (Jacobi), and all are positive where all roots are inside.
#[test]
fn minors_agree_with_counts_and_with_the_criterion_degree_by_degree() {
    let mut random = Random::new(1914);
    let (mut stable, mut counted, mut solved) = (0, 0, 0);
    for case in 0..count(40, 120) {
        let of = Loop::random(&mut random, case % 2 == 0);
        let model = read(&of.text(1));
        let budget = Budget::unlimited();
        for k in [ratio(1, 3), ratio(-5, 4), Rational::ZERO] {
            let problem = model.ask().set("K", k.clone()).problem().unwrap();
            let answer = problem.point_table(&budget).unwrap().into_value();
            let test = answer.test.as_ref().unwrap();
            if test.table != Table::Hermitian(of.a.len()) {
                // No imaginary part is left.
                continue;
            }
            let polynomial = of.at(&k);
            let expected = if of.is_discrete { is_schur(&polynomial) } else { is_hurwitz(&polynomial) };
            assert_eq!(answer.holds(), expected, "{of:?} at {k}");
            stable += usize::from(expected);
            let sign = |inequality: &Inequality| match inequality {
                Inequality::Positive(minor) => minor.polynomial.coeff(0).sign(),
                Inequality::Dominates { .. } => unreachable!("minors are compared with zero"),
            };
            let signs: Vec<Sign> = test.conditions.iter().map(|c| sign(&c.inequality)).collect();
            if signs.iter().all(|s| s.is_ne()) {
                let before = std::iter::once(Sign::Greater).chain(signs.iter().copied());
                let changes = signs.iter().zip(before).filter(|(a, b)| **a != *b).count();
                let count = problem.verdict(&budget).unwrap().into_value().count.unwrap();
                assert_eq!((count.outside, count.on), (changes, 0), "{of:?} at {k}: {signs:?}");
                counted += 1;
            }
        }
        // The conditions together are the stable set, or the question is refused as a defect.
        let table =
            model.ask().free("K").parametric_table(&budget).unwrap_or_else(|e| panic!("{e}\n{of:?}")).into_value();
        solved += usize::from(!table.stable.intervals().is_empty());
    }
    assert!(
        stable > count(15, 60) && counted > count(60, 200) && solved > count(10, 40),
        "{stable} {counted} {solved}"
    );
}

#[test]
fn a_turned_gain_in_words_and_in_the_document() {
    let text = printed(&["jury", "-", "--param", "K", "--digits", "6"], &turned("pi/6"));
    for line in [
        "Schur-Cohn conditions of the loop in K",
        "H_1 = -K^2 + 1",
        "H_2 = K^4 - 3*K^2 + 1.73205*K",
        "all together        0 < K < 0.684040",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let given = "time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = 'z^2 - z + K*(3 + 4*j)/5'\n";
    let document: serde_json::Value = serde_json::from_str(&printed(&["jury", "-", "--json"], given)).unwrap();
    assert_eq!((&document["table"], &document["holds"]), (&"Schur-Cohn".into(), &true.into()));
    assert_eq!(document["rows"], serde_json::json!([]));
    assert_eq!(document["conditions"][0]["name"], "H_1 > 0");
    assert_eq!(
        (&document["conditions"][0]["left"], &document["conditions"][0]["right"]),
        (&"91/100".into(), &"0".into())
    );
    let continuous = turned("pi/6").replace("discrete", "continuous").replace("(z*(z - 1))", "(s*(s + 1))");
    assert!(printed(&["jury", "-"], &continuous).starts_with("Hermite conditions of the loop, K = 0.3"));
}

/// At a marginal point, where no leading minor but the last is zero; behind a hold; in a smaller region.
#[test]
fn verdicts_of_the_conditions() {
    let budget = Budget::unlimited();
    let marginal = "time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = '(z - (3 + 4*j)/5)*(z - j/2)'\n";
    let answer = read(marginal).ask().point_table(&budget).unwrap().into_value();
    assert!(!answer.holds() && answer.verdict == Some(Verdict::Marginal));
    for (speed, expected) in [(600, true), (3700, true), (4000, false)] {
        let answer = read(&machine("")).ask().set("omega_e", speed).point_table(&budget).unwrap().into_value();
        assert_eq!(answer.holds(), expected, "{speed}");
    }
    let table =
        read(&machine("")).ask().set("omega_e", 3000).free("K_p").parametric_table(&budget).unwrap().into_value();
    let ends: Vec<String> = table
        .stable
        .intervals()
        .iter()
        .flat_map(|i| [&i.lower, &i.upper])
        .flatten()
        .map(|e| e.value.decimal(20))
        .collect();
    assert_eq!(ends, ["6.4099472463587523933", "50.227899690142802558"]);
    assert!(table.enclosed.is_some_and(|test| test.conditions.len() == 3));
    // The roots 3/4 exp(+-j pi/3), turned.
    let roots = "time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = '(z*(3 + 4*j)/5)^2 - 3/4*z*(3 + 4*j)/5 + 9/16'\n";
    let radius = printed(&["jury", "-", "--param", "radius", "--digits", "6"], roots);
    assert!(radius.contains("all together        radius > 0.75\n"), "{radius}");
    assert!(printed(&["jury", "-", "--radius", "4/5"], roots).contains("stable"));
    assert!(printed(&["jury", "-", "--radius", "7/10"], roots).contains("does not hold"));
}
