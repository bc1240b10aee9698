//! `max tolerance`: the gains from which all may go farthest.

use crate::helpers::folder::Folder;
use crate::helpers::number::{number, ratio};
use crate::helpers::schema::fits;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::ToleranceRequest;
use jurist_engine::error::Source;
use jurist_engine::model::{Model, Tolerance};
use serde_json::Value;

fn tune(polynomial: &str, names: &[&str], options: &[&str]) -> (String, Value) {
    let values: Vec<String> = names.iter().map(|name| format!("{name} = 1")).collect();
    let model = format!(
        "time = 'continuous'\nparameters = {{ {} }}\nloop.characteristic = '{polynomial}'\n[tune]\nfree = {names:?}\n",
        values.join(", ")
    );
    let folder = Folder::new(&[("loop.toml", &model)]);
    let text = folder.jurist(&[&["tune", "loop.toml"], options].concat());
    let run = folder.jurist(&[&["tune", "loop.toml", "--json", "--digits", "15"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}: {document}"));
    (text.stdout, document)
}

/// The stable gains are those from 1 to 4.
const ONE: &str = "s^2 + s + (K - 1)*(4 - K)";

/// Those from the root of 2 to the root of 3, and the same below zero.
const ROOTS: &str = "s^2 + s + (K^2 - 2)*(3 - K^2)";

#[test]
fn the_middle_of_an_interval() {
    for (objective, value, at) in
        [("max tolerance", "3/5", "5/2"), ("max tolerance absolute", "3/2", "5/2"), ("max tolerance ratio", "2", "2")]
    {
        let (_, found) = tune(ONE, &["K"], &["--objective", objective]);
        let optimum = &found["optimum"];
        let exact = (&optimum["value"]["exact"], &optimum["at"]["K"]["value"]["exact"]);
        assert_eq!(exact, (&value.into(), &at.into()), "{objective}");
        // The gain that is typed in has it but for the loss.
        let typed = number(found["rounded"]["K"].as_str().unwrap());
        assert!((typed - number(at)).abs() < ratio(2, 100), "{found}");
    }
}

#[test]
fn the_middle_between_irrational_ends() {
    for (objective, value, at) in [
        // 5 - 2 sqrt 6, (sqrt 2 + sqrt 3)/2, the fourth roots of 3/2 and 6.
        ("max tolerance", "0.101020514433644", "1.57313218497099"),
        ("max tolerance absolute", "0.158918622597891", "1.57313218497099"),
        ("max tolerance ratio", "1.10668191970032", "1.56508458007329"),
    ] {
        for (bound, sign) in [("K=0..3", ""), ("K=-3..0", "-")] {
            let (_, found) = tune(ROOTS, &["K"], &["--objective", objective, "--bound", bound]);
            let optimum = &found["optimum"];
            let decimals = (&optimum["value"]["decimal"], &optimum["at"]["K"]["value"]["decimal"]);
            assert_eq!(decimals, (&value.into(), &format!("{sign}{at}").into()), "{objective} {bound}");
        }
    }
}

#[test]
fn gains_near_zero_have_any_share_of_themselves() {
    let (text, found) = tune("s^2 + s + (K + 1)*(4 - K)", &["K"], &["--objective", "max tolerance"]);
    assert_eq!(found["optimum"]["value"], Value::Null);
    assert!(text.contains("it has no bound, since gains near to 0 may be multiplied by any factor"), "{text}");
    // Where zero is an end the whole of each smaller gain may be lost.
    let (text, found) = tune("s^2 + s + K*(4 - K)", &["K"], &["--objective", "max tolerance"]);
    assert_eq!(found["optimum"]["value"]["exact"], "1");
    assert!(text.contains("at any K from 0 to 2\n"), "{text}");
    // Far away too.
    let (_, found) = tune("s^2 + s + K - 1", &["K"], &["--objective", "max tolerance"]);
    assert_eq!((&found["optimum"]["value"]["exact"], &found["optimum"]["at"]["K"]), (&"1".into(), &Value::Null));
    let (_, found) = tune("s^2 + s + K - 1", &["K"], &["--objective", "max tolerance ratio"]);
    assert_eq!((&found["feasible"], &found["optimum"]["value"]), (&true.into(), &Value::Null));
}

/// `1 < a < 3` and `2 < b < 3`: of each measure the narrower side counts.
#[test]
#[ignore = "long: CI runs it"]
fn the_middle_of_a_rectangle() {
    let polynomial = "s^2 + (a - 1)*(3 - a)*s + (b - 2)*(3 - b)";
    let bounds = ["--bound", "a=0.5..5", "--bound", "b=0.5..5", "--gap", "2e-2"];
    for (objective, exact) in
        [("max tolerance", "0.2"), ("max tolerance absolute", "0.5"), ("max tolerance ratio", "1.224744871391589")]
    {
        let (_, found) = tune(polynomial, &["a", "b"], &[&bounds[..], &["--objective", objective]].concat());
        let [least, proved] = [&found["found"]["value"], &found["proved"]]
            .map(|x| number(x.as_str().unwrap_or_else(|| panic!("{found}"))));
        let exact = number(exact);
        assert!(
            least < exact && exact <= proved && proved < &least * &ratio(105, 100),
            "{objective}: {least} {proved}"
        );
        if objective != "max tolerance" {
            continue;
        }
        // What is found is proved by 'tolerance' as well.
        let text =
            format!("time = 'continuous'\nparameters = {{ a = 2, b = 2 }}\nloop.characteristic = '{polynomial}'\n");
        let (model, _) = Model::from_toml(&Source::new("loop.toml", &text)).unwrap();
        for (point, share) in [(&found["found"]["point"], Rational::ONE), (&found["rounded"], ratio(98, 100))] {
            let set = ["a", "b"].map(|name| (name.to_owned(), number(point[name].as_str().unwrap())));
            let share = &least * &share;
            let tolerance = Tolerance::Share { below: share.clone(), above: share };
            let request = ToleranceRequest::new([("a", tolerance.clone()), ("b", tolerance)]).box_alone();
            let answer = model.ask().set_all(set).tolerance(&request, &Budget::unlimited()).unwrap();
            assert!(answer.value().decision.is_stable(), "{point}");
        }
    }
}

#[test]
fn tolerances_that_cannot_be_asked() {
    let folder = Folder::new(&[]);
    let line = ["tune", "K*a/(s*(s+1)*(s+2))", "--free", "K", "--set", "a=1", "--objective"];
    for (options, words) in [
        (&["min tolerance"][..], "write 'max tolerance'"),
        (&["max tolerance percent"], "'max tolerance absolute' or 'max tolerance ratio'"),
        (&["max tolerances"], "did you mean 'tolerance'?"),
        (&["max tolerance", "--for-all", "a=1..2"], "leave out --for-all and --robust"),
    ] {
        let run = folder.jurist(&[&line[..], options].concat());
        assert!(run.status == 2 && run.stderr.contains(words), "{options:?}: {}", run.stderr);
    }
}
