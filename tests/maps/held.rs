//! Exact maps of loops with transcendental constants, such as those of a plant behind a hold.

use crate::helpers::number::number;
use crate::helpers::plane::{coefficient, map, plane};
use crate::helpers::thorough::{count, is_thorough, tried};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, Symbols};
use jurist_engine::answer::{Answer, BoxRequest, Map, MapMethod, MapOrBoxes};
use jurist_engine::error::{Error, Source};
use jurist_engine::model::Model;
use jurist_engine::stability::plane::boxes::BoxVerdict;
use jurist_engine::stability::plane::{Limit, PlanePolynomial, StabilityMap, region_limits, stability_map};
use jurist_engine::stability::{AtPoint, Cause, Range, Shape};
use proptest::collection::vec;
use proptest::prelude::*;
use std::sync::Arc;

fn load(text: &str) -> Model {
    Model::from_toml(&Source::new("model.toml", text)).unwrap().0
}

/// A PI controller and a plant behind a hold of a tenth of a second.
fn held(plant: &str) -> Model {
    load(&format!(
        "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = '1/10'\n[parameters]\nKp = {{ nominal = 1 }}\nKi = {{ nominal = 1 }}\n\
         [loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'PI'\ninput = 'r - y'\noutput = 'u'\ntransfer = 'Kp + Ki*T/(z - 1)'\n\
         [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = 'zoh'\n"
    ))
}

/// One exponential, two, oscillating ones; an integrator; three poles, of which two are a pair.
const PLANTS: [&str; 5] =
    ["1/(s + 1)", "1/((s + 1)*(s + 3))", "1/(s^2 + s + 2)", "1/(s*(s + 2))", "1/((s + 1)*(s^2 + s + 2))"];

fn asked(model: &Model, x: &str, y: &str) -> Answer<Map> {
    model.ask().free(x).free(y).map(6, &Budget::unlimited()).unwrap()
}

/// The roots outside of the region at a point, by a problem in which both have values from the start.
fn outside(model: &Model, point: [(&str, &Rational); 2]) -> usize {
    let [(x, at), (y, height)] = point;
    let problem = model.ask().set(x, at.clone()).set(y, height.clone()).problem().unwrap();
    let p = problem.symbolic(&Budget::unlimited()).unwrap().unwrap();
    match p.at(&Rational::ONE, problem.shape(), &Budget::unlimited()).unwrap() {
        AtPoint::Defined { count, infinite } => count.outside + infinite,
        other => panic!("{other:?}"),
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn slices_are_the_stable_sets_of_one_parameter() {
    let budget = Budget::unlimited();
    for plant in tried(PLANTS, 3) {
        let model = held(plant);
        let mut seen = 0;
        for (x, y) in [("Kp", "Ki"), ("Ki", "Kp")] {
            let answer = asked(&model, x, y);
            let found = &answer.value().decomposition;
            assert!(found.has_symbols() && found.regions.len() == 1, "{plant}");
            for strip in &found.strips {
                let set = model.ask().set(x, strip.sample.clone()).free(y).stable_set(&budget).unwrap().into_value();
                let slice = found.slice(&strip.sample, &Range::all(), &budget).unwrap().unwrap();
                let digits = |end: &Option<Real>| end.as_ref().map(|end| end.decimal(20));
                let mut cut: Vec<[Option<String>; 2]> = Vec::new();
                for interval in &slice {
                    let [lower, upper] = [digits(&interval.lower), digits(&interval.upper)];
                    match cut.last_mut().filter(|last| last[1] == lower && !has_end(&set, &lower)) {
                        // A curve on which nothing happens that matters.
                        Some(last) => last[1] = upper,
                        None => cut.push([lower, upper]),
                    }
                }
                let ends = set.intervals().iter();
                let expected: Vec<[Option<String>; 2]> = ends
                    .map(|i| [&i.lower, &i.upper].map(|end| end.as_ref().map(|end| end.value.decimal(20))))
                    .collect();
                assert_eq!(cut, expected, "{plant}: {y} at {x} = {}", strip.sample);
                seen += usize::from(!expected.is_empty());
            }
        }
        assert!(seen >= 2, "{plant}: {seen} lines with stable points");
    }
}

fn has_end(set: &jurist_engine::stability::StableSet, value: &Option<String>) -> bool {
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    ends.map(|end| Some(end.value.decimal(20))).any(|end| end == *value)
}

#[test]
fn roots_are_counted_in_every_cell() {
    for plant in tried(PLANTS, 3) {
        let model = held(plant);
        let answer = asked(&model, "Kp", "Ki");
        let found = &answer.value().decomposition;
        let domain = Range::all();
        let (mut cells, mut seed) = (0, 1u64);
        for (s, strip) in found.strips.iter().enumerate() {
            for (c, cell) in strip.cells.iter().enumerate() {
                // Near the sample, as far as it is the same cell.
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let part = |bits: u32| Rational::new(Integer::from((seed >> bits) as i64 % 97 - 48), Integer::from(31));
                let point = [&strip.sample + &part(20), &cell.sample + &part(40)];
                let at = found.locate(&point[0], &point[1], &domain, &Budget::unlimited()).unwrap();
                let Some((strip_there, cell_there)) = at else { continue };
                let there = &found.strips[strip_there].cells[cell_there];
                assert_eq!(
                    outside(&model, [("Kp", &point[0]), ("Ki", &point[1])]),
                    there.outside,
                    "{plant}: {point:?}"
                );
                assert_eq!(there.stable, there.outside == 0 && there.on == 0);
                let own = [("Kp", &strip.sample), ("Ki", &cell.sample)];
                assert_eq!(outside(&model, own), cell.outside, "{plant}: strip {s}, cell {c}");
                cells += 1;
            }
        }
        assert!(cells > 8, "{plant}: {cells} cells");
    }
}

#[test]
fn either_order_of_the_axes_describes_the_same_regions() {
    for plant in tried(PLANTS, 3) {
        let model = held(plant);
        let (one, other) = (asked(&model, "Kp", "Ki"), asked(&model, "Ki", "Kp"));
        let ends = |answer: &Answer<Map>, turned: bool| -> Vec<[String; 4]> {
            let regions = answer.value().decomposition.regions.iter();
            let text = |end: &Option<Real>| end.as_ref().map_or("none".to_owned(), |end| end.decimal(15));
            regions
                .map(|r| {
                    let [a, b] = if turned { [&r.y, &r.x] } else { [&r.x, &r.y] };
                    [text(&a.lower), text(&a.upper), text(&b.lower), text(&b.upper)]
                })
                .collect()
        };
        assert_eq!(ends(&one, false), ends(&other, true), "{plant}");
        let causes = |answer: &Answer<Map>| {
            let mut all: Vec<String> = answer.value().all_limits().map(|l| l.limit.causes.to_string()).collect();
            all.sort();
            all
        };
        assert_eq!(causes(&one), causes(&other), "{plant}");
        assert_eq!(causes(&one).len(), 4, "{plant}: bounded on all sides");
    }
}

#[test]
fn boxes_never_contradict_the_exact_map() {
    let model = held("1/((s + 1)*(s + 3))");
    let side = |low: &str, high: &str| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new([side("-5", "90"), side("-5", "90")], number("1/10"));
    let problem = model.ask().free("Kp").free("Ki").plane_problem().unwrap();
    let budget = Budget::unlimited();
    let MapOrBoxes::Boxes(boxes) = problem.map_by(MapMethod::Boxes, &request, 6, &budget).unwrap() else {
        panic!("boxes were asked for")
    };
    let MapOrBoxes::Exact(exact) = problem.map_by(MapMethod::Auto, &request, 6, &budget).unwrap() else {
        panic!("there was time enough")
    };
    let found = &exact.value().decomposition;
    let mut seen = [0, 0];
    for b in &boxes.value().boxes.boxes {
        let ([x0, x1], [y0, y1]) = (&b.window.x, &b.window.y);
        for (x, y) in
            [(x0.midpoint(x1), y0.midpoint(y1)), (x0.midpoint(&x0.midpoint(x1)), y1.midpoint(&y0.midpoint(y1)))]
        {
            let Some((s, c)) = found.locate(&x, &y, &Range::all(), &budget).unwrap() else { continue };
            let is_stable = found.strips[s].cells[c].stable;
            match b.verdict {
                BoxVerdict::Stable => assert!(is_stable, "{b:?}"),
                BoxVerdict::Unstable { .. } => assert!(!is_stable, "{b:?}"),
                BoxVerdict::Undecided => continue,
            }
            seen[usize::from(is_stable)] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 20), "{seen:?}");
}

/// The loop in `x/e` and `y/pi`: its map is that of the loop itself with the axes scaled.
fn scaled(coefficients: &[RationalFunction]) -> PlanePolynomial {
    let mut symbols = Symbols::new();
    symbols.insert("X1", Definition::exponential(-1));
    symbols.insert("W", Definition::Pi);
    let [x, y, e, w] = [0, 1, 2, 3].map(RationalFunction::variable);
    let images = [&x * &e, &y * &w];
    let moved: Vec<RationalFunction> = coefficients.iter().map(|c| c.compose(&images).unwrap()).collect();
    PlanePolynomial::over_symbols(&characteristic(moved), &Arc::new(symbols))
}

fn characteristic(coefficients: Vec<RationalFunction>) -> CharacteristicPolynomial {
    let formal_degree = coefficients.len() - 1;
    let poles = coefficients.iter().map(|f| f.denominator().clone()).collect();
    let variables = ["x", "y", "X1", "W"].map(str::to_owned).to_vec();
    CharacteristicPolynomial { variables, coefficients, formal_degree, poles, monic: false }
}

/// What cells say, the cells of regions, and the curves on the walls of strips.
type MapShape = (Vec<Vec<(bool, usize, usize)>>, Vec<Vec<(usize, usize)>>, Vec<[Vec<usize>; 2]>);

/// What does not depend on the scale of the axes.
fn shape(m: &StabilityMap) -> MapShape {
    let cells = m.strips.iter().map(|s| s.cells.iter().map(|c| (c.stable, c.outside, c.on)).collect()).collect();
    let lines = m.strips.iter().map(|s| s.lines.clone()).collect();
    (cells, m.regions.iter().map(|r| r.cells.clone()).collect(), lines)
}

/// The map of a loop is that of the scaled one; the number of its regions. Nothing where it is not found how cells join.
fn is_scaled(
    p: &PlanePolynomial,
    coefficients: &[RationalFunction],
    region: Shape,
    are_all_seen: bool,
) -> Option<usize> {
    let budget = Budget::unlimited();
    let rational = map(p, &plane(), region);
    let scaled = scaled(coefficients);
    let over = match stability_map(&scaled, &plane(), region, &budget) {
        Ok(over) => over,
        // Said, not guessed.
        Err(stopped) => {
            assert!(stopped.stop.is_precision(), "{coefficients:?}: {stopped}");
            return None;
        }
    };
    assert_eq!(over.never_stable, rational.never_stable);
    let (cells, regions, lines) = shape(&rational);
    let (cells_over, regions_over, lines_over) = shape(&over);
    assert_eq!((cells_over, regions_over), (cells, regions), "{coefficients:?}");
    // Curves may be in another order.
    let counted = |lines: Vec<[Vec<usize>; 2]>| lines.into_iter().map(|l| l.map(|l| l.len())).collect::<Vec<_>>();
    assert_eq!(counted(lines_over), counted(lines));
    let limits = |m: &StabilityMap, p: &PlanePolynomial| -> Vec<Option<Limit>> {
        let found = region_limits(m, p, &plane(), region, 6, &budget).unwrap();
        found.into_iter().flat_map(|r| r.x.into_iter().chain(r.y)).collect()
    };
    for (over, exact) in limits(&over, &scaled).iter().zip(&limits(&rational, p)) {
        let counted = |l: &Option<Limit>| l.as_ref().map(|l| (l.at.len(), l.along_line));
        assert_eq!(counted(over), counted(exact), "{coefficients:?}");
        // A curve that touches the region in an extreme point alone is named where that is seen.
        let [over, exact] = [over, exact].map(|l| l.iter().flat_map(|l| l.causes.iter()).collect::<Vec<Cause>>());
        assert!(over.is_empty() == exact.is_empty(), "{coefficients:?}");
        assert!(over.iter().all(|cause| exact.contains(cause)), "{coefficients:?}: {over:?} of {exact:?}");
        assert!(over == exact || !are_all_seen, "{coefficients:?}: {over:?} and {exact:?}");
    }
    // x e^-1 of the one is x of the other.
    let e = number("2.718281828459045235360287471352662498");
    for (a, b) in rational.strips.iter().zip(&over.strips) {
        let (Some(a), Some(b)) = (&a.x.upper, &b.x.upper) else { continue };
        let (lo, hi) = a.refined_to_digits(20).enclosure();
        let middle = lo.midpoint(&hi) * &e;
        let (low, high) = b.refined_to_digits(12).enclosure();
        let room = number("1e-12") * middle.abs().max(Rational::ONE);
        assert!(
            &low - &room <= middle && middle <= &high + &room,
            "{coefficients:?}: {} {}",
            a.decimal(9),
            b.decimal(9)
        );
    }
    Some(rational.regions.len())
}

/// The coefficients of a small loop, which are polynomials over 8.
fn coefficients_of(list: &[&str]) -> Vec<RationalFunction> {
    let parameters = "[parameters]\nx = { nominal = 1 }\ny = { nominal = 1 }\n";
    let power = |(k, text): (usize, &&str)| format!("({text})*z^{k}");
    let sum = list.iter().enumerate().map(power).collect::<Vec<_>>().join(" + ");
    let model = load(&format!("time = 'discrete'\n{parameters}[loop]\ncharacteristic = '{sum}'\n"));
    let problem = model.ask().free("x").free("y").plane_problem().unwrap();
    let algebra = problem.algebra(&Budget::unlimited()).unwrap();
    algebra.polynomial().unwrap().coefficients.clone()
}

#[test]
#[ignore = "long: CI runs it"]
fn singular_maps_are_those_of_the_scaled_loops() {
    let loops: [&[&str]; 15] = [
        // Degree 0 and 1.
        &["x - y"],
        &["x*y", "1"],
        // A leading coefficient that vanishes on a line.
        &["x - 1/2", "y - x"],
        &["1/2", "x", "y"],
        // Curves that are vertical lines, and such that do not depend on x.
        &["x^2 - 2", "1"],
        &["(x - 1)*(y - 2)", "1"],
        &["y^2 - 2", "x/2", "1"],
        // Identical curves: roots at 1 and -1 at once.
        &["x*y", "0", "1"],
        &["x - y", "0", "0", "1"],
        // Regions that touch in a point, curves that cross at a wall.
        &["x^2 - y^2 + 1/2", "x*y", "1"],
        &["x*y + 1/5", "x^2 + y^2 - 1", "1"],
        // A circle, cusps, tangencies.
        &["x^2 + y^2", "1"],
        &["y^2 - x^3", "1"],
        // Branches that run to infinity on both sides of a wall.
        &["x - x^2*y^2", "8"],
        &["1/4 + y/3", "x^3 - 3*x - y", "1"],
    ];
    let mut several = 0;
    for list in tried(loops, 5) {
        let coefficients = coefficients_of(list);
        let p = PlanePolynomial::new(&characteristic(coefficients.clone()));
        for region in [Shape::UnitDisc, Shape::LeftHalfPlane] {
            let regions =
                is_scaled(&p, &coefficients, region, true).unwrap_or_else(|| panic!("{list:?} is not decided"));
            several += usize::from(regions > 1);
        }
    }
    assert!(several >= count(0, 3), "{several} maps of several regions");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(2, 12) as u32))]

    #[test]
    #[ignore = "long: CI runs it"]
    fn maps_over_symbols_are_those_of_the_scaled_loops(low in vec(coefficient(), 1..=3), is_disc in any::<bool>()) {
        let region = if is_disc { Shape::UnitDisc } else { Shape::LeftHalfPlane };
        let eighth = |p: &MultiPoly| RationalFunction::new(p.clone(), MultiPoly::from(8)).unwrap();
        let coefficients: Vec<RationalFunction> = low.iter().map(eighth).chain([RationalFunction::one()]).collect();
        let p = PlanePolynomial::new(&characteristic(coefficients.clone()));
        is_scaled(&p, &coefficients, region, false);
    }
}

/// The region reaches to `y = -sqrt(1/2)` and `y = sqrt(1/2)` at `x = 0`, where the roots are the cubic ones of -1 and of 1: a real one beside
/// the pair at both ends, on the same two curves.
#[test]
fn causes_at_both_ends_of_a_mirrored_region_are_named() {
    let [x, y] = [0, 1].map(RationalFunction::variable);
    let quarter = RationalFunction::from(number("1/4"));
    let constant = &(&(&(&y * &y) * &RationalFunction::from(2)) + &RationalFunction::from(3)) * &quarter;
    let linear = -(&(&(&x * &x) * &y) * &quarter);
    let coefficients = vec![constant, linear, RationalFunction::from(0), RationalFunction::one()];
    let p = PlanePolynomial::new(&characteristic(coefficients.clone()));
    is_scaled(&p, &coefficients, Shape::UnitDisc, true);
}

#[test]
fn constants_that_are_algebraic_are_known_by_their_norms() {
    // The triangle of z^2 + a z + b with a times sqrt(2), and one that sqrt(2) is part of in several ways.
    let text =
        |d: &str| format!("time = 'discrete'\n[parameters]\na = {{}}\nb = {{}}\n[loop]\ncharacteristic = '{d}'\n");
    let ends = |d: &str| {
        let map = asked(&load(&text(d)), "a", "b").into_value().decomposition;
        let end = |end: &Option<Real>| end.as_ref().unwrap().decimal(9);
        let [region] = map.regions.as_slice() else { panic!("one region") };
        [&region.x, &region.y].map(|i| (end(&i.lower), end(&i.upper)))
    };
    let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
    assert_eq!(ends("z^2 + sqrt(2)*a*z + b"), [pair("-1.41421356", "1.41421356"), pair("-1", "1")]);
    assert_eq!(ends("z^2 + sqrt(2)*a*z + sqrt(2)*b")[1], pair("-0.707106781", "0.707106781"));
    if is_thorough() {
        assert_eq!(ends("z^2 + sqrt(2)*a*z + sqrt(2)*b + a^2/4")[0], ends("z^2 + sqrt(2)*a*z + b + a^2/4")[0]);
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn the_held_drive_has_an_exact_map() {
    let model = load(include_str!("../../examples/drive-hold.toml"));
    let answer = asked(&model, "K_pwm", "K_is");
    let region = &answer.value().decomposition.regions[..];
    assert_eq!(region.len(), 1);
    // At K_is = 5 the limit is that of 'intervals', as in the corpus.
    let (line, set) = &answer.value().slices[1];
    let end = set.intervals()[0].upper.as_ref().unwrap().value.decimal(15);
    assert_eq!((line.parameter().name.as_str(), end.as_str()), ("K_pwm", "551.376621507159"));
}

#[test]
fn a_parameter_inside_of_functions_has_no_exact_map() {
    let model = load(include_str!("../../examples/dc-servo.toml"));
    let refused = model.ask().free("K").free("T_m").map(6, &Budget::unlimited()).unwrap_err();
    let Error::Refused(list) = refused else { panic!("{refused:?}") };
    assert_eq!(list.diagnostics()[0].message, "'T_m' is inside of functions, as behind a hold: there is no exact map");
}
