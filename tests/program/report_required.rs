//! What a report says of requirements, of maps by boxes and of tolerances that are long.

use super::report::{CASCADE, check_page, plain, rows, section};
use crate::helpers::program::{jurist, jurist_with_input};

#[test]
fn requirements_are_met_or_not_with_what_is_left_and_certificates_stay() {
    let model = |margin: &str| {
        format!("{CASCADE}[require]\nphase_margin = '{margin} deg'\nat = 'w'\n")
            .replace("time = 'discrete'", "time = 'discrete'")
    };
    for (margin, head, verdict) in [
        ("20", "It meets its requirement, phase margin &gt;= 20 deg (", "met"),
        ("85", "It does not meet phase margin &gt;= 85 deg", "not met"),
    ] {
        let run = jurist_with_input(&["report", "-", "-o", "-", "-q"], model(margin).as_bytes());
        let html = run.stdout;
        check_page(&html, margin);
        let head = head.replace("&gt;", ">");
        assert!(plain(&html).replace("&gt;", ">").contains(&head), "{}", plain(section(&html, "limits")));
        let rows = rows(section(&html, "limits"), "Requirements");
        assert_eq!((rows.len(), rows[0][1].as_str()), (1, verdict), "{rows:?}");
        let found: f64 = rows[0][2].parse().expect("a margin");
        let left: f64 = rows[0][3].trim_end_matches(" %").replace('−', "-").parse().expect("a share");
        let asked: f64 = margin.parse().unwrap();
        assert!((left - 100.0 * (found / asked - 1.0)).abs() < 0.5, "{rows:?}");
        let certificates = section(&html, "certificates");
        assert!(certificates.contains("accepted") && certificates.contains("--no-require"), "{certificates}");
    }
}

#[test]
fn a_certificate_is_of_the_requirements_or_of_stability_alone() {
    let folder = std::env::temp_dir().join(format!("jurist-alone-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    std::fs::write(path("m.toml"), format!("{CASCADE}[require]\nphase_margin = '20 deg'\nat = 'w'\n")).unwrap();
    let (model, proof) = (path("m.toml"), path("c.json"));
    for (options, is_required) in [(&["--certificate"][..], true), (&["--no-require", "--certificate"], false)] {
        let run = jurist(&[&["verdict", &model], options, &[&proof]].concat());
        assert!(run.status == 0 && run.stdout.contains("phase_margin") == is_required, "{}{}", run.stdout, run.stderr);
        let run = jurist(&["verify", &model, &proof]);
        assert!(run.status == 0 && run.stdout.contains("20 degrees") == is_required, "{}", run.stdout);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
#[ignore = "long: CI runs it"]
fn every_loop_with_a_number_beside_its_parameter_has_a_map() {
    let delayed = "time = 'continuous'\n[parameters]\nK = { nominal = 1, min = 0 }\nd = { nominal = 0.2, min = 0 }\n\
        [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(-d*s)/(s + 1)'\n";
    let held = "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = 0.5\n[parameters]\nK = { nominal = 1, min = 0 }\n\
        [loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'\n";
    for model in [delayed, held] {
        let run = jurist_with_input(&["report", "-", "-o", "-", "-q"], model.as_bytes());
        let map = section(&run.stdout, "map");
        assert!(map.contains("<svg") && plain(map).contains("% of the window is undecided"), "{}", plain(map));
    }
    let rational = "time = 'discrete'\n[constants]\na = 0.5\n[parameters]\nK = { nominal = 1, min = 0 }\n\
        [loop]\ncharacteristic = 'z^2 - a*z + K/4'\n";
    let run = jurist_with_input(&["report", "-", "-o", "-", "-q"], rational.as_bytes());
    let map = plain(section(&run.stdout, "map"));
    assert!(map.contains("cells decided exactly"), "{map}");
}

#[test]
#[ignore = "long: CI runs it"]
fn tolerances_that_are_proved_are_told_where_their_greatest_factor_is_long() {
    let plain_model = std::fs::read_to_string("examples/anti-alias-filter.toml").unwrap();
    let with = |text: String, number: &str| {
        text.replace(&format!("= {number} "), &format!("= {{ value = {number}, tolerance = '5%' }} "))
    };
    let model =
        ["1e-4", "0.2", "1e-3"].into_iter().fold(plain_model, with).replace("min = 0,", "min = 0, tolerance = '5%',");
    let run = jurist_with_input(&["report", "-", "-o", "-", "-q"], model.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let part = plain(section(&run.stdout, "tolerance"));
    assert!(part.contains("6 tolerances of 5 %: stable for all values"), "{part}");
    assert!(part.contains("jurist tolerance finds how far they can grow"), "{part}");
}
