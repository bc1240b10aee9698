//! Polynomials over constants, rounded for pictures.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use jurist_engine::model::{Model, ParameterBuilder, Time};
use jurist_engine::problem::Ask;
use jurist_engine::stability::Rounding;

/// The loop `z - exp(-T) + K/3` with one of its parameters free, the other at its value.
fn rounding(free: &str, others: &[(&str, i64)]) -> Rounding {
    let parameters = ["K", "T"].map(|name| ParameterBuilder::new(name).nominal("1"));
    let builder = Model::builder(Time::Discrete).characteristic("z - exp(-T) + K/3");
    let (model, _) = parameters.into_iter().fold(builder, |b, p| b.parameter(p)).build().unwrap();
    let values = others.iter().map(|(name, value)| ((*name).to_owned(), Rational::from(*value)));
    let problem = model.ask().set_all(values).free(free).problem().unwrap();
    problem.symbolic(&Budget::unlimited()).unwrap().unwrap().rounding()
}

#[test]
fn a_parameter_inside_or_outside_of_functions_gives_the_same_roots() {
    let root = |p: &UniPoly| -p.coeff(0).to_f64_approximate() / p.coeff(1).to_f64_approximate();
    for (k, t) in [(1, 1), (-7, 3), (5, 0)] {
        let expected = (-(t as f64)).exp() - k as f64 / 3.0;
        let of_gain = rounding("K", &[("T", t)]);
        let of_time = rounding("T", &[("K", k)]);
        assert!(of_time.whole().is_none());
        for found in [of_gain.at(&k.into()).unwrap(), of_time.at(&t.into()).unwrap()] {
            assert!((root(&found) - expected).abs() < 1e-15, "{k} {t} {found:?}");
        }
        let whole = of_gain.whole().unwrap();
        let at = UniPoly::new(whole.coeffs().iter().map(|c| c.eval(&k.into())).collect());
        assert!((root(&at) - expected).abs() < 1e-15, "{k} {t} {at:?}");
    }
}
