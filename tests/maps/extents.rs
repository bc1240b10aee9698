//! What was wrong once in maps, by name.

use crate::helpers::model::read;
use crate::helpers::plane::{c, disc, ends, limits, plane, polynomial, said, says, some, square, x, y};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::RationalFunction;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::model::Model;
use jurist_engine::stability::Shape;

/// A plant behind a hold, in a loop with the parameters `K` and `q`.
fn held(controller: &str, plant: &str, rule: &str) -> Model {
    read(&format!(
        "time = 'discrete'\nsample_time = 1\n[parameters]\nK = 0.9\nq = -0.3\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\ninput = 'r - y'\noutput = 'u'\ntransfer = '{controller}'\n\
         [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '{plant}'\ndiscretize = {rule}\n"
    ))
}

fn map_of(model: &Model, x: &str, y: &str) -> Answer<Map> {
    model.ask().free(x).free(y).map(10, &Budget::unlimited()).unwrap()
}

/// The extents of all regions, `K` first, to eight digits.
fn extents(map: &Answer<Map>, is_turned: bool) -> Vec<[(Option<String>, Option<String>); 2]> {
    let regions = map.value().decomposition.regions.iter();
    let mut all: Vec<_> =
        regions.map(|r| if is_turned { [ends(&r.y), ends(&r.x)] } else { [ends(&r.x), ends(&r.y)] }).collect();
    all.sort();
    all
}

/// Of the poles `1/(s^2 + 1)` on the circle `K = 1/3` is a boundary for every `q`. A critical value of `q` was lost: the quotient by the
/// polynomial of double points had as many terms as the dividend.
#[test]
fn an_extent_reaches_as_far_as_there_are_stable_points() {
    let model = held("(K - 1/3)*(z - q)/z", "1/(s^2 + 1)", "{ method = 'zoh', delay = '1/2' }");
    let map = map_of(&model, "K", "q");
    let found = extents(&map, false);
    assert_eq!(found.len(), 2);
    assert!(found.iter().any(|region| region[1].1.as_deref() == Some("0.92540786")), "{found:?}");
    assert_eq!(found, extents(&map_of(&model, "q", "K"), true));
    assert!(map.value().all_limits().all(|end| end.limit.causes.iter().next().is_some()));
}

/// Loops whose poles are on the circle where the gain is zero: that line is a curve with one term, as the polynomial of double points is.
#[test]
#[ignore = "long: CI runs it"]
fn a_line_on_which_poles_are_on_the_circle_is_a_wall() {
    let cases = [
        ("1/(s^2 + 1)", "{ method = 'foh', delay = '1' }"),
        ("1/(s*(s^2 + 1))", "{ method = 'zoh' }"),
        ("1/(s*(s^2 + 1))", "{ method = 'foh' }"),
    ];
    for (plant, rule) in cases {
        let model = held("K*(z - q)/z", plant, rule);
        let found = extents(&map_of(&model, "K", "q"), false);
        assert!(!found.is_empty(), "{plant} {rule}");
        assert_eq!(found, extents(&map_of(&model, "q", "K"), true), "{plant} {rule}");
        assert!(found.iter().all(|[k, _]| k.0.as_deref() == Some("0") || k.1.as_deref() == Some("0")), "{found:?}");
    }
}

/// z^2 - y^2 z + x at x = -1, y = 0: both walls are z = 1, and z = -1 touches the region in that point alone.
#[test]
fn a_curve_that_only_touches_the_extreme_point_is_a_cause() {
    let p = polynomial(vec![x(), RationalFunction::zero() - square(&y()), c("1")]);
    let m = disc(&p);
    let all = limits(&m, &p, &plane(), Shape::UnitDisc);
    assert_eq!((m.regions.len(), ends(&m.regions[0].x)), (1, some("-1", "1")));
    assert_eq!(said(&all[0].x[0]), says("-1", "z=1+z=-1"));
    assert_eq!(said(&all[0].x[1]), says("1", "complex pair"));
}

/// Of `z^2 + (a - 1) z + b + a^2` the greatest `b` is 1, at `a = 0`, with a pair at the angle pi/3. The sample time was taken for a
/// polynomial in both parameters.
#[test]
fn frequencies_of_extents_know_sample_times_that_are_not_rational() {
    let model = read(
        "time = 'discrete'\nsample_time = 'pi/3'\n[parameters]\na = {}\nb = {}\n[loop]\n\
         characteristic = 'z^2 + (a - 1)*z + b + a^2'",
    );
    let map = map_of(&model, "a", "b");
    let [_, greatest] = &map.value().limits()[0].ends[1];
    let greatest = greatest.as_ref().unwrap();
    assert_eq!(
        (greatest.limit.value.decimal(8), greatest.limit.causes.to_string()),
        ("1".into(), "complex pair".into())
    );
    let hertz = greatest.frequency.as_ref().unwrap().hertz.as_ref().unwrap();
    assert_eq!(hertz.decimal(8).unwrap(), "0.15915494");
}

/// No boundary curve has the constant that the sample time has. Walls were asked for as if the loop had none either, which was refused.
#[test]
fn walls_are_known_where_only_the_sample_time_has_constants() {
    let model = read(
        "time = 'discrete'\nsample_time = 'pi/3'\n[parameters]\na = {}\nb = {}\n[loop]\n\
         characteristic = 'z^2 + (a - 1)*z + b'",
    );
    let map = map_of(&model, "a", "b");
    let at = c("1/3").as_constant().unwrap();
    let causes = [1, 2].map(|number| {
        let wall = map.wall(&at, number, 40, &Budget::unlimited()).unwrap();
        wall.unwrap().0.causes.to_string()
    });
    assert_eq!(causes, ["z=1", "complex pair"]);
    assert!(map.fibre(&at, &Budget::unlimited()).unwrap().is_none());
}

/// With r = sqrt(2) the boundary `x y - r x - r y + 2` is `(x - r)(y - r)`, which no common factor over the constant as a variable shows.
#[test]
fn a_line_that_only_the_values_of_constants_show_is_a_wall() {
    let model = |characteristic: &str| {
        read(&format!(
            "time = 'discrete'\n[constants]\nr = 'sqrt(2)'\n[parameters]\na = {{}}\nb = {{}}\n[loop]\n\
             characteristic = '{characteristic}'"
        ))
    };
    let both = ["(z - 1 + (a*b - r*a - r*b + 2)/8)*(z - b)", "(z - 1 + (a - r)*(b - r)/8)*(z - b)"].map(|text| {
        let map = map_of(&model(text), "a", "b");
        let ends = map.value().all_limits().map(|end| {
            let limit = &end.limit;
            (limit.value.decimal(8), limit.causes.to_string(), limit.along_line)
        });
        ends.collect::<Vec<_>>()
    });
    assert_eq!(both[0], both[1]);
    assert!(both[0].contains(&("1.4142136".into(), "z=1".into(), true)), "{both:?}");
    // Nothing else ends there, and the regions on either side part.
    assert_eq!(map_of(&model("z - 1 + a*b - r*a - r*b + 2"), "a", "b").value().decomposition.regions.len(), 2);
}
