//! `jurist tune` on loops whose best gains are known.

use crate::helpers::folder::Folder;
use crate::helpers::number::number;
use crate::helpers::schema::fits;
use jurist_algebra::number::Rational;
use serde_json::{Value, json};

const PI: &str = "time = 'continuous'\n[parameters]\nk = { nominal = 0.5, min = 0 }\nki = { nominal = 0.2, min = 0 }\n\
    [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'loop'\ninput = 'r - y'\noutput = 'y'\n\
    transfer = '(k*s + ki)/(s*(s + 1)^3)'\n[tune]\nfree = ['k', 'ki']\nbounds = { k = [0, 5], ki = [0, 5] }\nobjective = 'max ki'\n";

fn tune(model: &str, options: &[&str]) -> (i32, Value) {
    let folder = Folder::new(&[("loop.toml", model)]);
    let run = folder.jurist(&[&["tune", "loop.toml", "--json", "--digits", "20"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}: {document}"));
    (run.status, document)
}

/// A question about a loop in one line.
fn line(text: &str, objective: &str) -> Value {
    let folder = Folder::new(&[]);
    let run = folder.jurist(&["tune", text, "--free", "K", "--objective", objective, "--json", "--digits", "20"]);
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{text}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}"));
    document
}

fn refused(model: &str, options: &[&str]) -> String {
    let folder = Folder::new(&[("loop.toml", model)]);
    let run = folder.jurist(&[&["tune", "loop.toml"], options].concat());
    assert_eq!(run.status, 2, "{options:?}: {}", run.stdout);
    run.stderr
}

fn decimal(text: &Value) -> Rational {
    number(text.as_str().unwrap_or_else(|| panic!("{text}")))
}

#[test]
fn the_largest_decay_is_at_a_double_root() {
    // 1 - 1/sqrt 3, at 2 sqrt 3/9.
    let found = line("K/(s*(s+1)*(s+2))", "max decay");
    let optimum = &found["optimum"];
    assert_eq!(optimum["value"]["decimal"], "0.42264973081037423549");
    assert_eq!(optimum["value"]["polynomial"], json!(["2", "-6", "3"]));
    assert_eq!(optimum["at"]["K"]["value"]["decimal"], "0.38490017945975050967");
    assert_eq!((&optimum["attained"], &found["rounded"]["K"]), (&true.into(), &"2/5".into()));
}

#[test]
fn the_smallest_radius_is_at_a_double_root() {
    let found = line("K/(z*(z-1/2))", "min radius");
    assert_eq!(found["optimum"]["value"]["exact"], "1/4");
    assert_eq!(found["optimum"]["at"]["K"]["value"]["exact"], "1/16");
    // All roots may be at 0.
    let found = line("K/(z-1)", "min radius");
    assert_eq!(
        (&found["optimum"]["value"]["exact"], &found["optimum"]["at"]["K"]["value"]["exact"]),
        (&"0".into(), &"1".into())
    );
}

#[test]
fn the_largest_margins_of_an_unstable_plant() {
    // |D|^2/|Q|^2 is 8.1/12.1 at v = 10.
    let found = line("K/((s-1)*(s/10+1))", "max modulus_margin");
    assert_eq!(
        (&found["optimum"]["value"]["exact"], &found["optimum"]["at"]["K"]["value"]["exact"]),
        (&"9/11".into(), &"2".into())
    );
    // The complementary peak 1/t: t = 9/11 at the same loop turned around.
    let found = line("K/((s-1)*(s/10+1))", "min complementary_peak");
    assert_eq!(found["optimum"]["decimal"], "1.2222222222222222222");
    // Where the crossing is at the frequency sqrt 10 of the largest phase, atan sqrt 10 - atan (1/sqrt 10) = 54.9 degrees.
    let found = line("K/((s-1)*(s/10+1))", "max phase_margin");
    assert_eq!(found["optimum"]["decimal"], "54.903198772415403871");
}

#[test]
fn what_has_no_best_value_says_so() {
    let found = line("K/(s*(s+1)*(s+2))", "max phase_margin");
    assert_eq!(
        (&found["optimum"]["decimal"], &found["optimum"]["attained"]),
        (&"90.000000000000000000".into(), &false.into())
    );
    let found = line("K/(s*(s+1)*(s+2))", "max gain_margin");
    assert_eq!((&found["optimum"]["value"], &found["optimum"]["decimal"]), (&Value::Null, &Value::Null));
    assert_eq!(found["feasible"], true);
    let found = line("K/(s+1)", "max K");
    assert_eq!(found["optimum"]["value"], Value::Null);
    let found = line("K/(s+1)", "min K");
    assert_eq!((&found["optimum"]["value"]["exact"], &found["optimum"]["attained"]), (&"-1".into(), &false.into()));
}

/// On a plateau the best value is had; numbers at the end of their scale are numbers.
#[test]
fn plateaus_and_ends_of_scales() {
    for (text, objective, decimal, attained) in [
        ("K/(s^2+0.2*s+1)", "max decay", "0.1", Some(true)),
        ("K/((s-1)*(s+3))", "max decay", "1", Some(true)),
        // That all roots are real is not asked.
        ("K*s/(s^2+1)", "max damping", "1", None),
        ("K*(s+1)^2/s^3", "max modulus_margin", "1", Some(true)),
        // Two roots stay near -1 and come to it.
        ("K*(s+1)^2/s^3", "max decay", "1", Some(false)),
        ("K/(s+3)", "min complementary_peak", "0", None),
    ] {
        let found = line(text, objective);
        let optimum = &found["optimum"];
        assert_eq!(
            (&optimum["decimal"], &optimum["attained"]),
            (&decimal.into(), &attained.into()),
            "{text} {objective}"
        );
    }
    // The open loop is smaller than 1: no phase limits it.
    assert_eq!(line("K/((s+1)*(s+2))", "max phase_margin")["optimum"]["decimal"], Value::Null);
}

/// A double root at -2e15, beyond any size that a search would begin with.
#[test]
fn a_large_best_value_is_no_missing_bound() {
    let found = line("K/((s+1e15)*(s+3e15))", "max decay");
    assert_eq!(found["optimum"]["value"]["exact"], "2000000000000000");
}

#[test]
fn bounds_belong_to_the_question() {
    let model = "time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's^3 + 3*s^2 + 2*s + K'\n";
    for (objective, bound, value, typed) in
        [("max decay", "K=0.1..0.2", "1/5", "0.2"), ("max K", "K=0..2", "2", "2"), ("min K", "K=1..2", "1", "1")]
    {
        let (status, found) = tune(model, &["--free", "K", "--objective", objective, "--bound", bound]);
        let place = &found["optimum"]["at"]["K"]["value"]["exact"];
        assert_eq!((status, place, &found["optimum"]["attained"]), (0, &value.into(), &true.into()), "{objective}");
        assert_eq!(number(typed), found["rounded"]["K"].as_str().unwrap().parse().unwrap(), "{objective}");
    }
    let said = refused(model, &["--free", "K", "--bound", "K=2..2"]);
    assert!(said.contains("--set K=2"), "{said}");
    let said = refused(model, &["--free", "K", "--set", "K=3", "--objective", "max decay"]);
    assert!(said.contains("'K' is free and has a value"), "{said}");
    let discrete = "time = 'discrete'\nparameters.K = 1\nloop.characteristic = 'z^2 - 1.5*z + 0.5 + K'\n";
    assert!(refused(discrete, &["--free", "K", "--objective", "max damping"]).contains("require it: --damping"));
}

/// The PI controllers with the largest integral gain under a maximum sensitivity (Åström, Panagopoulos, Hägglund 1998), exactly.
#[test]
fn the_largest_integral_gain_under_a_sensitivity() {
    for (least, ki, k, polynomial) in [
        ("5/7", "0.32531741166766740672", "0.63297426943639425136", ["21600", "414207", "-1509984", "100352"]),
        ("1/2", "0.68519019419955363817", "1.22195903483199543", ["108", "4887", "-8064", "1024"]),
    ] {
        let (status, found) = tune(PI, &["--modulus-margin", least]);
        let optimum = &found["optimum"];
        assert_eq!((status, &optimum["value"]["decimal"]), (0, &ki.into()));
        assert_eq!(optimum["value"]["polynomial"], json!(polynomial));
        let enclosure = &optimum["at"]["k"]["enclosure"];
        let [low, high] = [0, 1].map(|i| enclosure[i].as_str().unwrap().parse::<Rational>().unwrap());
        let (k, near) = (number(k), number("1e-17"));
        assert!(low <= &k + &near && &k - &near <= high && &high - &low < number("1e-16"), "{enclosure}");
        assert_eq!((&optimum["attained"], &optimum["binding"]), (&true.into(), &json!(["modulus_margin"])));
        // The gains that are typed in meet what is required.
        let typed = &found["rounded"];
        let set = ["k", "ki"].map(|name| format!("{name}={}", typed[name].as_str().unwrap()));
        let folder = Folder::new(&[("loop.toml", PI)]);
        let check =
            folder.jurist(&["verdict", "loop.toml", "--modulus-margin", least, "--set", &set[0], "--set", &set[1]]);
        assert_eq!(check.status, 0, "{}", check.stdout);
    }
}

#[test]
fn requirements_and_bounds_that_exclude_each_other() {
    let (status, found) = tune(PI, &["--modulus-margin", "5/7", "--bound", "ki=0.3254..5", "--objective", "none"]);
    assert_eq!((status, &found["feasible"]), (1, &false.into()));
    assert_eq!(found["conflict"], json!(["modulus_margin >= 5/7", "ki >= 0.3254"]));
    let (status, found) = tune(PI, &["--modulus-margin", "5/7", "--bound", "ki=0.3253..5", "--objective", "none"]);
    assert_eq!((status, &found["feasible"], &found["conflict"]), (0, &true.into(), &json!([])));
    // One gain, two requirements: each alone can be met.
    let loop_ = "time = 'continuous'\nparameters.K = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'loop'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K/(s*(s + 1)*(s + 2))'\n";
    let (status, found) =
        tune(loop_, &["--free", "K", "--decay", "0.4", "--phase-margin", "75 deg", "--gain-margin", "2"]);
    assert_eq!((status, &found["conflict"]), (1, &json!(["phase_margin >= 75 deg", "decay >= 0.4"])), "{found}");
}

/// The heavy ball on eigenvalues 1 and 10 (Polyak 1964): the radius is (11 - 2 sqrt 10)/9.
#[test]
fn a_level_over_two_gains_is_enclosed() {
    let model = "time = 'discrete'\n[parameters]\nalpha = { nominal = 0.1, min = 0, max = 1 }\nbeta = { nominal = 0.1, min = 0, max = 1 }\n\
        [loop]\ncharacteristic = '(z^2 - (1 + beta - alpha)*z + beta)*(z^2 - (1 + beta - 10*alpha)*z + beta)'\n";
    let (status, found) =
        tune(model, &["--free", "alpha", "--free", "beta", "--objective", "min radius", "--gap", "1e-3"]);
    let [most, least] = [decimal(&found["found"]["value"]), decimal(&found["proved"])];
    let exact = number("0.51949385329591570400");
    assert_eq!(status, 0);
    assert!(least < exact && exact < most && most - least < number("1e-3"), "{found}");
}

/// Behind a hold: the largest gain under a phase margin is an end of 'intervals', and a level is enclosed.
#[test]
fn gains_behind_a_hold() {
    let model = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/dc-servo.toml")).unwrap();
    let (status, found) = tune(&model, &["--free", "K", "--objective", "min radius"]);
    let [most, least] = [decimal(&found["found"]["value"]), decimal(&found["proved"])];
    assert!(status == 0 && least < most && &most - &least < most * number("2e-3"), "{found}");
    let folder = Folder::new(&[("loop.toml", &model)]);
    for (radius, is_empty) in [(&found["found"]["value"], false), (&found["proved"], true)] {
        let run =
            folder.jurist(&["intervals", "loop.toml", "--param", "K", "--radius", radius.as_str().unwrap(), "--json"]);
        let set: Value = serde_json::from_str(&run.stdout).unwrap();
        // The decimal of what is found is rounded, and no proof.
        assert!(set["stable"].as_array().unwrap().is_empty() == is_empty || !is_empty, "{set}");
    }
}

#[test]
fn what_cannot_be_asked_is_refused_with_what_to_do() {
    for (options, code, help) in [
        (&["--objective", "max radius"][..], "E-tune-objective", "did you mean 'max decay'"),
        (&["--objective", "min decay"], "E-tune-objective", "write 'max decay'"),
        (&["--objective", "max kj"], "E-tune-objective", "did you mean 'k'"),
        (&["--objective", "best"], "E-tune-objective", "'max' may be followed by k"),
        (&["--bound", "k=5..1"], "E-tune-bounds", "lower one first"),
        (&["--bound", "T=5..1"], "E-tune-bounds", "add --free T"),
        (&["--free", "k", "--free", "k"], "E-tune-free", "name it once"),
        (&["--free", "kx"], "E-unknown-parameter", "did you mean 'k'"),
        (&["--gap", "2"], "E-option-value", "--gap 1%"),
        (&["--loss", "-1%"], "E-option-value", "--loss 1%"),
    ] {
        let said = refused(PI, options);
        assert!(said.contains(code) && said.contains(help), "{options:?}: {said}");
    }
    let many = ["a", "b", "c", "d", "e", "f"].map(|name| format!("{name} = 1\n")).concat();
    let many = PI.replace("k = {", &format!("{many}k = {{")).replace("['k', 'ki']", "['a', 'b', 'c', 'd', 'e', 'f']");
    assert!(
        refused(&many.replace("{ k = [0, 5], ki = [0, 5] }", "{}").replace("max ki", "none"), &[])
            .contains("E-tune-free")
    );
    let nothing = PI.split("[tune]").next().unwrap();
    assert!(refused(nothing, &[]).contains("name the gains: --free k"));
}
