//! Limits of loops with plants behind a hold, against values that were found in another way: with 90 digits, from the
//! eigenvalues of the sampled loop on either side of each limit.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::{Answer, Verdict};
use jurist_engine::error::{Code, Error, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::{Ask, Question};
use jurist_engine::stability::{End, Range, StableSet};
use jurist_prove::{Certificate, Theorem, smt2};
use jurist_show::{Document, Text};

fn read(text: &str) -> Model {
    Model::from_toml(&Source::new("model.toml", text)).unwrap_or_else(|e| panic!("{e}\n{text}")).0
}

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn solved(question: Question) -> Answer<StableSet> {
    question.stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

fn shown(end: &Option<End>, digits: usize) -> String {
    end.as_ref().map_or_else(|| "none".into(), |e| format!("{} {}", e.value.decimal(digits), e.causes))
}

fn ends(answer: &Answer<StableSet>, digits: usize) -> Vec<[String; 2]> {
    answer.value().intervals().iter().map(|i| [shown(&i.lower, digits), shown(&i.upper, digits)]).collect()
}

fn pair(lower: &str, upper: &str) -> [String; 2] {
    [lower.to_owned(), upper.to_owned()]
}

/// One block behind a hold with the gain `K` in negative feedback.
fn unity(block: &str) -> Model {
    read(&format!(
        "time = 'discrete'\nsample_time = 1\n[parameters]\nK = {{ nominal = 1 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'plant'\ninput = 'K*(r - y)'\noutput = 'y'\n{block}\n"
    ))
}

fn drive() -> Model {
    read(include_str!("../../../examples/drive-hold.toml"))
}

#[test]
fn the_held_drive_has_two_limits_of_the_amplitude() {
    let answer = solved(drive().ask().free("K_pwm"));
    let expected =
        pair("0.038114430517689891928183804626597 complex pair", "551.37662150715876981225860647781 complex pair");
    assert_eq!(ends(&answer, 32), [expected]);
    let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
    let frequency = answer.problem().frequency(upper, 80).unwrap();
    assert_eq!(frequency.hertz.unwrap().decimal(11).unwrap(), "1663.7912782");
    assert!(upper.value.exact().is_none() && upper.value.algebraic().is_none());
}

#[test]
fn a_double_integrating_motor_has_its_textbook_limit() {
    let answer = solved(unity("transfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'").domain_of_gain());
    assert_eq!(ends(&answer, 32), [pair("0 z=1+domain", "2.3922111911773328143765528784798 complex pair")]);
}

trait PositiveGain {
    fn domain_of_gain(&self) -> Question;
}

impl PositiveGain for Model {
    fn domain_of_gain(&self) -> Question {
        self.ask().free("K").domain("K", Range::between(Some(Rational::ZERO), None))
    }
}

#[test]
fn a_double_integrator_is_rational() {
    // (1/2)(z + 1)/(z - 1)^2: never stable with a gain alone; with a lead it is, up to a rational number.
    let answer = solved(unity("transfer = '1/s^2'\ndiscretize = 'zoh'").domain_of_gain());
    assert!(answer.value().is_empty() && answer.value().is_algebraic());
}

#[test]
fn a_filter_with_a_sample_and_a_half_of_delay_is_limited_at_an_eighth_of_the_sampling_rate() {
    // cos^2 + sin^2 = 1 makes coefficients vanish that are no zero polynomials in cosine and sine.
    let model = read(
        "time = 'discrete'\nsample_time = 1e-4\n[parameters]\nK = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'filter'\ninput = 'K*(r - y)'\noutput = 'y'\n\
         transfer = '4e9/(s*(s^2 + 1.2e8))'\ndiscretize = { method = 'zoh', T = 1e-4, delay = 1.5e-4 }\n",
    );
    let answer = solved(model.ask().free("K"));
    let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
    assert_eq!(upper.value.decimal(32), "117.43545663898864748214433879009");
    let frequency = answer.problem().frequency(upper, 80).unwrap();
    assert_eq!(frequency.hertz.unwrap().decimal(12).unwrap(), "1250.00000000");
}

#[test]
fn the_held_drive_is_stable_for_all_short_periods() {
    let domain = Range::between(Some(Rational::ZERO), Some(Rational::ONE));
    let answer = solved(drive().ask().free("T").domain("T", domain));
    assert!(answer.value().undecided().is_empty(), "{:?}", answer.value().undecided());
    assert_eq!(ends(&answer, 32), [pair("0 z=1+domain", "0.00049887020373592031868489198586674 complex pair")]);
    let upper = answer.value().intervals()[0].upper.as_ref().unwrap();
    let frequency = answer.problem().frequency(upper, 80).unwrap();
    assert_eq!(frequency.hertz.unwrap().decimal(11).unwrap(), "331.18558930");
}

#[test]
fn the_armature_resistance_has_two_limits_behind_the_hold() {
    let domain = Range::between(Some(Rational::ZERO), Some(Rational::from(6000)));
    let answer = solved(drive().ask().set("K_pwm", 551).free("R_a").domain("R_a", domain));
    assert!(answer.value().undecided().is_empty(), "{:?}", answer.value().undecided());
    let expected = pair("0.37780623452617555913800557560115 complex pair", "5366.5724864320336557 complex pair");
    let [lower, _] = &ends(&answer, 32)[0];
    let [_, upper] = &ends(&answer, 20)[0];
    assert_eq!([lower.clone(), upper.clone()], expected);
}

#[test]
fn verdicts_on_either_side_of_a_limit_differ() {
    let at = |k: &str| drive().ask().set("K_pwm", number(k)).verdict(&Budget::unlimited()).unwrap().into_value();
    assert_eq!(at("551.37662150715876981225860647").verdict, Verdict::Stable);
    let beyond = at("551.37662150715876981225860648");
    assert_eq!((beyond.verdict, beyond.count.unwrap().outside), (Verdict::Unstable, 2));
}

#[test]
fn an_undamped_mode_without_gain_is_marginal() {
    let model = unity("transfer = '1/(s^2 + 1)'\ndiscretize = 'zoh'");
    let verdict = model.ask().set("K", 0).verdict(&Budget::unlimited()).unwrap().into_value();
    assert_eq!((verdict.verdict, verdict.count.unwrap().on), (Verdict::Marginal, 2));
}

#[test]
fn a_gain_behind_a_first_order_hold_loses_the_degree_in_the_end() {
    // G(z) = (b_1 z + b_0)/(z - X): 1 + K b_1 is the leading coefficient.
    let answer = solved(unity("transfer = '1/(s + 1)'\ndiscretize = 'foh'").ask().free("K"));
    let found = ends(&answer, 12);
    assert!(found.iter().flatten().all(|end| !end.is_empty()));
    for interval in answer.value().intervals() {
        for (end, is_lower) in [(&interval.lower, true), (&interval.upper, false)] {
            let Some(end) = end else { continue };
            let step = number("1e-9");
            let (lo, hi) = end.value.refined(&number("1e-20")).enclosure();
            let (below, above) = (lo - &step, hi + &step);
            let is_stable = |k: Rational| {
                let model = unity("transfer = '1/(s + 1)'\ndiscretize = 'foh'");
                model.ask().set("K", k).verdict(&Budget::unlimited()).unwrap().into_value().verdict == Verdict::Stable
            };
            assert_eq!((is_stable(below), is_stable(above)), (!is_lower, is_lower), "{found:?}");
        }
    }
}

#[test]
fn documents_and_refusals_of_transcendental_limits() {
    let answer = solved(unity("transfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'").domain_of_gain());
    let text = serde_json::to_value(answer.json(12)).unwrap();
    let upper = &text["stable"][0]["upper"];
    assert_eq!(
        (upper["kind"].as_str(), upper["exact"].is_null(), upper["polynomial"].is_null()),
        (Some("transcendental"), true, true)
    );
    assert_eq!(upper["decimal"], "2.39221119118");
    let symbols = upper["over"]["symbols"].as_object().unwrap();
    assert_eq!(symbols.values().collect::<Vec<_>>(), ["exp(-1)"]);
    assert_eq!(text["stable"][0]["lower"]["kind"], "algebraic");
    let code = |refused: Error| match refused {
        Error::Refused(why) => why.code(),
        other => panic!("{other}"),
    };
    let budget = Budget::unlimited();
    assert!(answer.certificate(&budget).unwrap().contains("jurist/certificate/2"));
    assert_eq!(code(smt2(&answer, &budget).unwrap_err()), Code::NoCertificate);
    assert_eq!(code(answer.coq(&budget).unwrap_err()), Code::Coq);
    let verdict = unity("transfer = '1/(s + 1)'\ndiscretize = 'zoh'").ask().verdict(&budget).unwrap();
    assert!(verdict.certificate(&budget).unwrap().contains("jurist/certificate/2"));
    assert!(answer.text(12).contains("0 < K < 2.39221119118"));
}

#[test]
fn an_unbounded_sample_time_that_occurs_by_itself_is_decided_all_the_way() {
    // The integrators of the controllers have the factor T; the motor's exponentials die away.
    let answer = solved(drive().ask().free("T"));
    assert!(answer.value().undecided().is_empty(), "{:?}", answer.value().undecided());
    assert_eq!(ends(&answer, 32), [pair("0 z=1+domain", "0.00049887020373592031868489198586674 complex pair")]);
}

#[test]
#[ignore = "long: CI runs it"]
fn a_resonance_with_computation_delay_has_windows_in_the_sample_time_out_to_infinity() {
    for delay in ["0", "T", "2*T"] {
        let model = read(&format!(
            "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = {{ nominal = 1, min = 0 }}\n[loop]\ninputs = ['r']\n\
             outputs = ['y']\n[[block]]\nname = 'plant'\ninput = '(r - y)/2'\noutput = 'y'\ntransfer = '1/(s^2 + s/5 + 1)'\n\
             discretize = {{ method = 'zoh', delay = '{delay}' }}\n"
        ));
        let answer = solved(model.ask().free("T"));
        let set = answer.value();
        assert!(set.undecided().is_empty(), "{delay}: {:?}", set.undecided());
        assert!(set.intervals().last().unwrap().upper.is_none(), "{delay}: a gain of 1/2 is stable in the end");
        for k in 1..120 {
            let t = number(&format!("{k}/4"));
            let verdict = model.ask().set("T", t.clone()).verdict(&Budget::unlimited()).unwrap().into_value();
            assert_eq!(set.contains(&t), verdict.verdict == Verdict::Stable, "delay {delay}, T = {t}");
        }
    }
}
