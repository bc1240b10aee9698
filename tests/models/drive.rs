//! The built-in drive: its coefficients, its two forms, its transfer functions.

use crate::helpers::model::{characteristic, example_text, keeping, load, path};
use crate::helpers::number::number;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::faddeev_leverrier;
use jurist_algebra::poly::RationalFunction;
use jurist_engine::error::{Code, Error};
use jurist_engine::model::{DRIVE, Model};
use jurist_engine::problem::Question;

const DRIVE_BLOCKS: &str = include_str!("../../examples/drive-blocks.toml");

/// The coefficients derived by hand from the matrices.
const COEFFICIENTS: [&str; 7] = [
    "K*T^2*(42968750*T^2 - 18906250*T + 687500)/6417",
    "K*T*(85937500*T^3 - 250000*T^2 + 1541250*T - 116250)/6417",
    "42968750/6417*K*T^4 + 18906250/6417*K*T^3 + (-248750/713*K + 2250/31)*T^2 + (1250/23*K - 46684/2139)*T + 1",
    "250000/6417*K*T^3 + (-2896250/6417*K - 4500/31)*T^2 + (-1250/23*K + 46684/713)*T - 4",
    "(31250/69*K + 2250/31)*T^2 + (1250/69*K - 46684/713)*T + 6",
    "46684/2139*T - 4",
    "1",
];

fn expected() -> Vec<RationalFunction> {
    let value = |text: &&str| {
        let model = load(&format!(
            "time = 'discrete'\n[parameters]\nK = {{}}\nT = {{}}\n[loop]\ncharacteristic = '0*K*T + {text}'"
        ));
        let p = characteristic(keeping(&model, &["K", "T"]));
        assert_eq!(p.formal_degree, 0);
        p.coefficients[0].clone()
    };
    COEFFICIENTS.iter().map(value).collect()
}

#[test]
fn models_inside_of_packages_are_the_examples() {
    // A package holds what is in its own folder, so these are there once more.
    let packaged = [
        ("crates/model", vec!["drive"]),
        ("studies/drive", vec!["drive-blocks", "equation-23-as-printed", "equation-37-as-printed"]),
    ];
    for (package, names) in packaged {
        for entry in std::fs::read_dir(path(&format!("{package}/models"))).unwrap() {
            let file = entry.unwrap().file_name().into_string().unwrap();
            assert!(names.contains(&file.trim_end_matches(".toml")), "{package}/models/{file}");
        }
        for name in names {
            let copy = std::fs::read_to_string(path(&format!("{package}/models/{name}.toml"))).unwrap();
            assert_eq!(copy, example_text(name), "{package}/models/{name}.toml is not examples/{name}.toml");
        }
    }
}

#[test]
fn symbolic_coefficients() {
    let p = characteristic(keeping(&Model::drive(), &["K_pwm", "T"]));
    assert_eq!(p.coefficients, expected());
    assert_eq!((p.formal_degree, p.monic, p.poles.len()), (6, true, 0));
    assert_eq!(p.variables, ["K_pwm", "T"]);
}

#[test]
fn block_diagram_has_the_identical_polynomial() {
    let (blocks, drive) = (load(DRIVE_BLOCKS), load(DRIVE));
    for keep in [vec!["K_pwm", "T"], vec!["T", "K_pwm"], vec!["K_pwm"], vec!["T"], vec![], vec!["L_a", "T"]] {
        assert_eq!(characteristic(keeping(&blocks, &keep)), characteristic(keeping(&drive, &keep)));
    }
}

#[test]
fn transfer_functions_agree_with_the_adjugate_and_between_the_forms() {
    let budget = Budget::unlimited();
    let [drive, blocks] = [Model::drive(), load(DRIVE_BLOCKS)].map(|lp| lp.ask().free("K_pwm").problem().unwrap());
    let (drive, blocks) = (drive.closed_loop(&budget).unwrap(), blocks.closed_loop(&budget).unwrap());
    for input in ["omega_ref", "T_L"] {
        for output in ["omega", "i_a"] {
            let g = drive.transfer_function(input, output, &budget).unwrap();
            assert_eq!(blocks.transfer_function(input, output, &budget).unwrap(), g);
        }
    }
    // c adj(zI - N/q) e, with adj(zI - N/q) = adj(q z I - N)/q^(n-1).
    let cleared = drive.a.cleared();
    let fl = faddeev_leverrier(&cleared.numerators, &budget).unwrap();
    let q = RationalFunction::from(cleared.denominator.clone());
    let g = drive.transfer_function_at(0, 0, &budget).unwrap();
    for (k, coefficient) in g.numerator.iter().enumerate() {
        let mut sum = RationalFunction::zero();
        for i in 0..6 {
            for j in 0..6 {
                let entry = RationalFunction::from(fl.adjugate_entry(i, j).coeff(k));
                let scaled = &entry * &q.pow(k as i64 - 5).unwrap();
                sum = &sum + &(&(&drive.c[(0, i)] * &scaled) * &drive.e[(j, 0)]);
            }
        }
        assert_eq!(*coefficient, sum, "coefficient {k}");
    }
    // At z = 1 the speed follows its reference: numerator and denominator have equal sums.
    let at_one = |c: &[RationalFunction]| c.iter().fold(RationalFunction::zero(), |s, c| &s + c);
    assert_eq!(at_one(&g.numerator), at_one(&g.denominator.coefficients));
    let torque = drive.transfer_function("T_L", "omega", &budget).unwrap();
    assert!(at_one(&torque.numerator).is_zero());
}

#[test]
fn discretised_motor_is_equation_4() {
    let text = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = {}\nR = {}\nL = {}\nJ = {}\nB = {}\nk = {}\n\
        [loop]\ninputs = ['V', 'M']\noutputs = ['i', 'w']\n[[block]]\nname = 'motor'\ninput = ['V', 'M']\noutput = ['i', 'w']\n\
        A = [['-R/L', '-k/L'], ['k/J', '-B/J']]\nB = [['1/L', 0], [0, '-1/J']]\ndiscretize = { method = 'forward', T = 'T' }";
    let model = load(text);
    let problem = keeping(&model, &["T", "R", "L", "J", "B", "k"]).problem().unwrap();
    let closed = problem.closed_loop(&Budget::unlimited()).unwrap();
    let shown = |f: &RationalFunction| f.display(&closed.variables).to_string();
    let a: Vec<String> = closed.a.entries().iter().map(shown).collect();
    assert_eq!(a, ["(-T*R + L)/L", "-T*k/L", "T*k/J", "(-T*B + J)/J"]);
    let e: Vec<String> = closed.e.entries().iter().map(shown).collect();
    assert_eq!(e, ["T/L", "0", "0", "-T/J"]);
    assert_eq!(closed.states, ["i", "w"]);
}

#[test]
fn questions() {
    let drive = Model::drive();
    let set = drive.ask().free("T").set("K_pwm", 555).problem().unwrap();
    assert_eq!(set.set(), [("K_pwm".to_owned(), number("555"))]);
    let p = characteristic(drive.ask().free("J").set("L_a", number("1/20")));
    assert_eq!(p.poles.len(), 1);
    assert_eq!(p.poles[0].display(&p.variables).to_string(), "J");
    let code = |question: Question| match question.problem() {
        Err(Error::Refused(error)) => error.code(),
        other => panic!("{other:?}"),
    };
    assert_eq!(code(drive.ask().free("T").set("T", 1)), Code::KeptAndSet);
    assert_eq!(code(drive.ask().free("K_pmw")), Code::UnknownParameter);
    assert_eq!(code(drive.ask().free("T").free("T")), Code::KeptTwice);
    let outside = drive.ask().set("T", -1).problem().unwrap();
    assert_eq!(outside.warnings()[0].code, Code::OutsideDomainWarning);
    let period = drive.ask().free("T").problem().unwrap();
    let time = period.algebra(&Budget::unlimited()).unwrap().sample_time();
    assert_eq!(time, Some(&RationalFunction::variable(0)));
}
