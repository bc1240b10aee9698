//! Maps in which a dead time varies against its sample time, so that the loop has one order here and another there.

use crate::helpers::number::number;
use crate::helpers::program::jurist_with_input;
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{BoxRequest, MapMethod, MapOrBoxes, Verdict};
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::problem::Region;
use jurist_engine::stability::Range;
use jurist_engine::stability::plane::boxes::{BoxMap, BoxVerdict};

/// `K/(s (s + a))` behind a hold of `T` with a dead time of `L` seconds.
const TEXT: &str = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = 0.1, min = 0 }\n\
    L = { nominal = 0.12, min = 0 }\nK = { nominal = 2, min = 0 }\na = { nominal = 1 }\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\n\
    input = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/(s*(s + a))'\ndiscretize = { method = 'zoh', delay = 'L' }\n";

fn servo() -> Model {
    Model::from_toml(&Source::new("model.toml", TEXT)).unwrap().0
}

fn boxes(names: [&str; 2], [x, y]: [[&str; 2]; 2], region: &Region) -> BoxMap {
    let side = |[low, high]: [&str; 2]| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([side(x), side(y)], Rational::new(1.into(), 20.into()));
    let asked = names.into_iter().fold(servo().ask().within(region.clone()), |asked, name| asked.free(name));
    match asked.plane_problem().unwrap().map_by(MapMethod::Auto, &request, 6, &Budget::unlimited()).unwrap() {
        MapOrBoxes::Boxes(answer) => answer.value().boxes.clone(),
        MapOrBoxes::Exact(_) => panic!("there is no exact map"),
    }
}

/// Every box says what the verdict at its middle says, in which both names have values from the start; all boxes tile the window.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_agree_with_verdicts_at_their_middles() {
    let unit = Region::disc(Rational::ONE).unwrap();
    let smaller = Region::disc(number("97/100")).unwrap();
    let cases = [
        (["K", "L"], [["0", "8"], ["1/50", "7/20"]], &unit),
        (["L", "K"], [["0", "1/4"], ["0", "8"]], &smaller),
        (["K", "T"], [["0", "8"], ["1/25", "1/2"]], &unit),
        (["L", "a"], [["0", "4/5"], ["1/2", "2"]], &unit),
    ];
    for (names, window, region) in tried(cases, 3) {
        let found = boxes(names, window, region);
        let whole = found.window.area();
        let areas = &found.areas;
        assert_eq!(&(&areas.stable + &areas.unstable) + &areas.undecided, whole, "{names:?}");
        assert!(&areas.undecided * &Rational::from(20) <= whole && areas.stable.sign().is_gt(), "{names:?}: {areas:?}");
        let mut stable = 0;
        for one in tried(&found.boxes, 7) {
            let point = [&one.window.x, &one.window.y].map(|[low, high]| low.midpoint(high));
            let set = names
                .iter()
                .zip(point)
                .fold(servo().ask().within(region.clone()), |asked, (name, value)| asked.set(*name, value));
            let verdict = set.verdict(&Budget::unlimited()).unwrap().into_value().verdict;
            match one.verdict {
                BoxVerdict::Stable => assert_eq!(verdict, Verdict::Stable, "{names:?} {one:?}"),
                BoxVerdict::Unstable { .. } => assert_ne!(verdict, Verdict::Stable, "{names:?} {one:?}"),
                BoxVerdict::Undecided => {}
            }
            stable += usize::from(one.verdict == BoxVerdict::Stable);
        }
        assert!(stable > 0, "{names:?}");
        // No box lies on both sides of a line on which the dead time is a whole number of samples.
        if names[0] == "L" {
            let samples = [1, 2, 3].map(|k| Rational::new(k.into(), 10.into()));
            assert!(!found.boxes.iter().any(|b| samples.iter().any(|s| b.window.x[0] < *s && *s < b.window.x[1])));
        }
    }
}

/// Of a complex loop each root was counted with its conjugate: the boxes of a window in parts had twice as many roots outside as their points.
#[test]
fn boxes_of_a_complex_loop_count_each_root_once() {
    let text = TEXT.replace("1/(s*(s + a))", "1/(s + a + 3*j)");
    let line = ["map", "-", "-x", "K=0..60", "-y", "L=1/50..7/20", "--undecided", "0.2", "--json"];
    let map = jurist_with_input(&line, text.as_bytes());
    let document: serde_json::Value =
        serde_json::from_str(&map.stdout).unwrap_or_else(|e| panic!("{e} {}", map.stderr));
    let (model, mut seen) = (Model::from_toml(&Source::new("model.toml", &text)).unwrap().0, 0);
    for found in document["boxes"].as_array().unwrap().iter().filter(|found| found["verdict"] == "unstable") {
        let middle = |axis: &str| {
            let [low, high] = [0, 1].map(|k| found[axis][k].as_str().unwrap().parse::<Rational>().unwrap());
            low.midpoint(&high)
        };
        let asked = model.ask().set("K", middle("x")).set("L", middle("y"));
        let verdict = asked.verdict(&Budget::unlimited()).unwrap().into_value();
        let outside = verdict.count.expect("counted").outside;
        assert_eq!(found["outside"].as_u64(), Some(outside as u64), "{found}");
        seen += 1;
    }
    assert!(seen > 3, "{seen}");
}

#[test]
fn windows_that_have_no_such_parts_are_refused_in_words() {
    let negative = TEXT.replace("delay = 'L'", "delay = 'L - 1/10'");
    for (text, axes, word) in [
        (TEXT, ["K=0..10", "L=0..9"], "window of 'L'"),
        (TEXT, ["T=1/20..1", "L=0..1"], "'T' and 'L' decide together"),
        (&negative, ["K=0..10", "L=1/20..1/5"], "dead time is negative"),
        (TEXT, ["a=1/2..1", "L=0..1"], ""),
    ] {
        let run = jurist_with_input(&["map", "-", "-x", axes[0], "-y", axes[1], "--undecided", "0.2"], text.as_bytes());
        assert_eq!(run.status == 2, !word.is_empty(), "{axes:?} {}", run.stderr);
        assert!(run.stderr.contains(word), "{axes:?} {}", run.stderr);
    }
}
