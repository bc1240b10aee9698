use crate::error::Source;
use crate::model::{Cut, Model};
use crate::problem::{Ask, EnclosedQuotient};
use crate::response::margins::StableMargins;
use crate::response::{Crossings, OpenLoop};
use crate::stability::Shape;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// Margins by exact polynomials over the constants are those by a symbol for each product.
#[test]
fn products_with_symbols_of_their_own_give_the_margins_of_exact_polynomials() {
    let budget = Budget::unlimited();
    for controller in ["2*(z - 9/10)/(z - 1)", "3/2"] {
        let text = format!(
            "time = 'discrete'\nsample_time = '1/10'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
             [[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ntransfer = '{controller}'\n\
             [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '120/((s + 2)*(s + 3)*(s + 4)*(s + 5))'\ndiscretize = 'zoh'\n"
        );
        let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
        let problem = model.ask().problem().unwrap();
        let cut = Cut::Input("C".to_owned());
        let exact = OpenLoop::exact(&problem, Some("C"), &budget).unwrap();
        let opened = model.opened_in_numbers(&cut, &[], &[], &budget).unwrap();
        let quotient = EnclosedQuotient::of(&opened).expect("a loop of this form");
        let enclosed = OpenLoop::enclosed(cut, quotient, Shape::UnitDisc);
        assert!(enclosed.is_enclosed() && !exact.is_enclosed());
        let [exact, enclosed] = [exact, enclosed].map(|open_loop| {
            let crossings = Crossings::of(&open_loop, &budget).unwrap();
            let margins = StableMargins::of(&open_loop, &crossings, &Rational::ZERO, &budget).unwrap();
            let phase = margins.phase.degrees(60).map(|degrees| degrees.decimal(15));
            let numbers = [&margins.modulus, &margins.peak_complementary, margins.disk.alpha.as_ref().unwrap()];
            let ends =
                [&margins.gain.upper, &margins.gain.lower].map(|end| end.as_ref().map(|end| end.value.decimal(20)));
            let counts = [crossings.gain.len(), crossings.phase.len()];
            (phase, numbers.map(|x| x.decimal(20)), ends, counts)
        });
        assert_eq!(exact, enclosed, "{controller}");
    }
}
