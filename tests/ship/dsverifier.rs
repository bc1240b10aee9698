//! The loops of DSVerifier's regression tests, as written and as stored, against Schur and Cohn in rationals.

use crate::helpers::folder::Folder;
use crate::helpers::model::read;
use crate::helpers::schur::{closed, is_schur};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::Verdict;
use jurist_engine::error::Source;
use jurist_engine::response::Requirements;
use jurist_ship::answer::{Beside, ShipAnswer};
use jurist_ship::asked::{Asked, Overrides};
use jurist_ship::dsverifier::{Reading, read as read_loop};
use jurist_ship::format::{Fixed, Rounding};

const LOOPS: &str = include_str!("dsverifier.csv");

/// Loops whose recorded expectation is that the check succeeds, though the loop with the stored lists is not stable.
const WRONG: [&str; 4] = ["helicopter", "pendulum", "satelliteB2", "spgMsDamper"];

/// Loops whose coefficients do not fit: the check fails before it looks at stability. Of the last one only those that are divided.
const OUT_OF_RANGE: [&str; 4] = ["CruiseControl01", "CruiseControl02", "SpringMassDamper", "dcservomotor"];

struct Row {
    name: &'static str,
    /// The lists as they are written: `b`, `a` of the controller, `b`, `a` of the plant.
    lists: [&'static str; 4],
    format: Fixed,
    integer: &'static str,
    is_expected: bool,
    /// The greatest modulus of a root in floating point: as written, and with the controller's lists as stored.
    moduli: [f64; 2],
}

fn rows() -> Vec<Row> {
    let lines = LOOPS.lines().filter(|line| !line.starts_with(['#']) && !line.starts_with("name;"));
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.split(';').collect();
        let [name, _, b, a, plant_b, plant_a, integer, fraction, recorded, exact, stored] = cells[..] else {
            panic!("{line}")
        };
        let fraction: i32 = fraction.parse().unwrap();
        let bits = integer.parse::<u32>().unwrap() + fraction as u32;
        Row {
            name,
            lists: [b, a, plant_b, plant_a],
            format: Fixed { bits, fraction, scale: 0, rounding: Rounding::Floor },
            integer,
            is_expected: recorded == "successful",
            moduli: [exact, stored].map(|text| text.parse().unwrap()),
        }
    };
    lines.map(row).collect()
}

impl Row {
    /// Its last name.
    fn short(&self) -> &str {
        self.name.rsplit('/').next().unwrap()
    }

    /// A file in C that says the same.
    fn file(&self) -> String {
        let system = |name: &str, b: &str, a: &str| {
            let [b_size, a_size] = [b, a].map(|list| list.split(' ').count());
            let [b, a] = [b, a].map(|list| list.replace(' ', ", "));
            format!(
                "digital_system {name} = {{ .b = {{ {b} }}, .b_size = {b_size}, .a = {{ {a} }}, .a_size = {a_size} }};\n"
            )
        };
        let [b, a, plant_b, plant_a] = self.lists;
        let Fixed { fraction, .. } = self.format;
        let format = format!("implementation impl = {{ .int_bits = {}, .frac_bits = {fraction} }};\n", self.integer);
        system("controller", b, a) + &system("plant", plant_b, plant_a) + &format
    }

    /// The exact lists, and those with the controller as DSVerifier stores it: each entry by itself, rounded down.
    fn systems(&self) -> [[[Vec<Rational>; 2]; 2]; 2] {
        let number = |text: &str| parse_number(text).unwrap();
        let [b, a, plant_b, plant_a] = self.lists.map(|list| list.split(' ').map(number).collect::<Vec<_>>());
        let unit = Rational::from(2).pow(i64::from(self.format.fraction)).unwrap();
        let down = |list: &[Rational]| -> Vec<Rational> {
            list.iter().map(|c| Rational::from(&(c * &unit).floor()).checked_div(&unit).unwrap()).collect()
        };
        let stored = [down(&b), down(&a)];
        let plant = [plant_b, plant_a];
        [[[b, a], plant.clone()], [stored, plant]]
    }

    fn shipped(&self) -> Result<ShipAnswer, String> {
        let found = read_loop(&Source::new("loop.c", self.file()), Reading::Z).unwrap();
        let model = read(&found.model);
        let asked = Asked::of(&model, &Overrides::default()).unwrap();
        let problem = model.ask().problem().unwrap();
        let beside = Beside::default();
        ShipAnswer::of(&problem, asked, &Requirements::default(), &beside, &Budget::unlimited())
            .map_err(|error| error.to_string())
    }
}

/// The verdict of the engine on two blocks.
fn is_stable([controller, plant]: &[[Vec<Rational>; 2]; 2]) -> bool {
    let block = |name: &str, wiring: &str, [b, a]: &[Vec<Rational>; 2]| {
        let list = |list: &[Rational]| {
            let texts: Vec<String> = list.iter().map(|c| format!("\"{c}\"")).collect();
            format!("[{}]", texts.join(", "))
        };
        // Zeros in front are no degree.
        let b = &b[b.iter().position(|c| !c.is_zero()).unwrap_or(b.len() - 1)..];
        format!("[[block]]\nname = '{name}'\n{wiring}\nnum = {}\nden = {}\n", list(b), list(a))
    };
    let text = format!(
        "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n{}{}",
        block("controller", "input = 'r - y'\noutput = 'u'", controller),
        block("plant", "input = 'u'\noutput = 'y'", plant)
    );
    read(&text).ask().problem().unwrap().verdict(&Budget::unlimited()).unwrap().value().verdict == Verdict::Stable
}

#[test]
fn verdicts_are_those_of_schur_and_cohn() {
    let rows = rows();
    assert_eq!(rows.len(), 40);
    let mut wrong = Vec::new();
    for row in &rows {
        let systems = row.systems();
        let stable = [0, 1].map(|k| is_schur(&closed(&systems[k][0], &systems[k][1])));
        for k in 0..2 {
            assert_eq!(is_stable(&systems[k]), stable[k], "{}", row.name);
            // Floating point says the same, but where a root is on the circle or next to it.
            assert!((row.moduli[k] < 1.0) == stable[k], "{} {}", row.name, row.moduli[k]);
        }
        if row.is_expected != stable[1] {
            assert!(row.is_expected, "a failure that is recorded is one: {}", row.name);
            wrong.push(row.short());
        }
        match row.shipped() {
            Ok(answer) => {
                assert_eq!(answer.exact.verdict.value().verdict == Verdict::Stable, stable[0], "{}", row.name);
                let after = &answer.shipped.after;
                let stored = [&after.numerator, &after.denominator]
                    .map(|list| list.iter().map(|c| c.lower().clone()).collect::<Vec<_>>());
                let expected = is_schur(&closed(&stored, &systems[0][1]));
                let found = answer.rounded.verdict.value().verdict == Verdict::Stable;
                assert_eq!(found, expected, "{}", row.name);
                // Coefficients are divided by the first one before they are rounded: without a division both store the same.
                if systems[0][0][1][0].is_one() {
                    assert_eq!(found, stable[1], "{}", row.name);
                }
            }
            Err(error) => {
                assert!(error.contains("does not fit"), "{} {error}", row.name);
                assert!(OUT_OF_RANGE.contains(&row.short()), "{}", row.name);
            }
        }
    }
    wrong.sort_unstable();
    assert_eq!(wrong, WRONG);
}

#[test]
fn a_file_is_shipped_and_imported() {
    let rows = rows();
    let row = rows.iter().find(|row| row.short() == "pendulum").unwrap();
    let zero = row.file().replace(&row.lists[0].replace(' ', ", "), "0");
    let folder = Folder::new(&[("loop.c", &row.file()), ("zero.c", &zero), ("loop.json", "{\"A\": [[1]]}")]);
    let shipped = folder.jurist(&["ship", "--from", "loop.c"]);
    assert_eq!(shipped.status, 1, "{}", shipped.stderr);
    assert!(shipped.stderr.contains("are divided by it before they are rounded"), "{}", shipped.stderr);
    assert_eq!(folder.jurist(&["import", "loop.c", "-o", "loop.toml", "-q"]).status, 0);
    assert_eq!(folder.jurist(&["ship", "loop.toml"]).stdout, shipped.stdout);
    assert_eq!(folder.jurist(&["ship", "--from", "loop.c", "--reading", "z^-1"]).stdout, shipped.stdout);
    for refused in [
        &["ship", "--from", "zero.c"][..],
        &["import", "zero.c"],
        &["import", "loop.c", "--open"],
        &["import", "loop.json", "--reading", "z"],
        &["ship", "loop.toml", "--from", "loop.c"],
        &["ship", "loop.toml", "--reading", "z"],
        &["ship", "--from", "loop.c", "--reading", "s"],
    ] {
        assert_eq!(folder.jurist(refused).status, 2, "{refused:?}");
    }
    let said = folder.jurist(&["ship", "--from", "zero.c"]).stderr;
    assert!(said.contains("E-import") && said.contains("zero.c:1:36"), "{said}");
}
