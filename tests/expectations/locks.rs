//! `jurist lock`: limits that moved, and because of which number.

use crate::helpers::folder::{Folder, lines_of};

fn model(c: &str, d: &str, transfer: &str) -> String {
    format!(
        "time = 'discrete'\n[constants]\nc = {c}\nd = {{ value = {d} }}\ne = 'c*d'\n[parameters]\nK = {{ nominal = 0.5 }}\n\
         [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = '{transfer}'\n"
    )
}

#[test]
fn a_limit_that_moved_names_the_number_that_moved_it() {
    let folder = Folder::new(&[("loop.toml", &model("1", "2", "e*K/(z - 1)"))]);
    let run = folder.jurist(&["lock", "loop.toml", "--within", "1%"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let line = |run: &crate::helpers::program::Run| lines_of(run).lines().nth(1).unwrap_or_default().to_owned();
    assert_eq!(line(&folder.jurist(&["test", "loop.toml"])), "  passed    locked limits of K: not moved");
    // 1/(c d): c moves it by a fifth, d does not reach a hundredth.
    folder.write("loop.toml", &model("1.25", "2.01", "e*K/(z - 1)"));
    let run = folder.jurist(&["test", "."]);
    assert_eq!(run.status, 1, "{}", run.stdout);
    assert_eq!(
        line(&run),
        "  FAILED    locked limits of K: the upper limit is 0.796019900, locked 1, moved by 20.4 %; c was 1, is 1.25: with the old value it \
         moved by 0.498 %; d was 2, is 2.01: with the old value it moved by 20 %"
    );
    folder.write("loop.toml", &model("1", "2.01", "e*K/(z - 1)"));
    assert_eq!(
        line(&folder.jurist(&["test", "loop.toml"])),
        "  passed    locked limits of K: the upper limit is 0.995024876, locked 1, moved by 0.498 %"
    );
    // The loop itself.
    folder.write("loop.toml", &model("1", "2", "e*K/(z - 0.5)"));
    let found = line(&folder.jurist(&["test", "loop.toml"]));
    assert!(found.ends_with("no constant and no nominal value changed, so the loop itself did"), "{found}");
    // A formula is a value as well.
    folder.write("loop.toml", &model("1", "2", "e*K/(z - 1)").replace("'c*d'", "'2*c*d'"));
    let found = line(&folder.jurist(&["test", "loop.toml"]));
    assert!(found.contains("e was c*d, is 2*c*d: this alone explains it"), "{found}");
    // The same number in another form is no change, and what is gone is said.
    folder.write(
        "loop.toml",
        &model("'2/2'", "2.0", "e*K/(z - 0.5)")
            .replace("K = { nominal", "Q = 1\nK = { nominal")
            .replace("e*K", "Q*e*K"),
    );
    let found = line(&folder.jurist(&["test", "loop.toml"]));
    assert!(found.ends_with("; new since then: Q"), "{found}");
    folder.write("loop.toml", &model("1", "2", "e*K/(z - 0.5)").replace("e = 'c*d'", "").replace("e*K", "c*d*K"));
    let found = line(&folder.jurist(&["test", "loop.toml"]));
    assert!(found.ends_with("; gone since then: e"), "{found}");
    let lock = folder.read("loop.lock.json");
    for (from, to) in [("\"exact\": \"1\"", "\"exact\": \"abc\""), ("\"within\": \"1/100\"", "\"within\": \"abc\"")] {
        folder.write("loop.lock.json", &lock.replacen(from, to, 1));
        assert_eq!(folder.jurist(&["test", "loop.toml"]).status, 2, "{from}");
    }
    let run = folder.jurist(&["lock", "K/(s + 1)"]);
    assert!(run.status == 2 && run.stderr.contains("this model is not one"), "{}", run.stderr);
    folder.write("loop.lock.json", "{}");
    assert_eq!(folder.jurist(&["test", "loop.toml"]).status, 2);
}

#[test]
fn one_interval_that_became_two_is_a_change() {
    let cubic = |k: &str| {
        format!(
            "time = 'continuous'\n[constants]\nk = {k}\n[parameters]\nK = 1\n[loop]\ncharacteristic = 's + (K - 1)*(K - 2)*(K - 3)*k + 1'\n"
        )
    };
    let folder = Folder::new(&[("loop.toml", &cubic("1"))]);
    assert_eq!(folder.jurist(&["lock", "loop.toml", "--param", "K"]).status, 0);
    folder.write("loop.toml", &cubic("10"));
    let run = folder.jurist(&["test", "loop.toml"]);
    assert_eq!(run.status, 1);
    assert!(
        lines_of(&run).contains("; locked: stable from ")
            && lines_of(&run).contains("k was 1, is 10: this alone explains it"),
        "{}",
        run.stdout
    );
}

/// The example holds as it is, and a gain that is changed in its header fails with what is missing and the culprit.
#[test]
fn the_firmware_of_the_examples_fails_where_a_gain_is_changed() {
    let read = |name: &str| {
        std::fs::read_to_string(format!("{}/examples/firmware/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    };
    let names = ["params.h", "speed.toml", "series.csv", "speed.lock.json"];
    let texts = names.map(read);
    let files: Vec<(&str, &str)> = names.into_iter().zip(texts.iter().map(String::as_str)).collect();
    let folder = Folder::new(&files);
    let run = folder.jurist(&["test", "."]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    folder.write("params.h", &texts[0].replace("0.35f", "1.60f"));
    let run = folder.jurist(&["test", ".", "--only-bad"]);
    assert_eq!(run.status, 1, "{}", run.stdout);
    for part in [
        "FAILED    every drive of the series: phase_margin >= 40 deg: not so at 1 of 4 operating points, the worst is row 1",
        "too little (line 46)",
        "FAILED    locked limits of K_i: the upper limit is ",
        "K_p was 0.349999994, is 1.60000002: this alone explains it",
    ] {
        assert!(lines_of(&run).contains(part), "{part}: {}", run.stdout);
    }
}
