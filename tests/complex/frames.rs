//! Plants held in another frame: against the transfer function `exp(ja) G(z exp(jwT))` written out, and against the criterion of Schur and Cohn
//! in floating point on both sides of every end.

use crate::helpers::model::read;
use crate::helpers::random::Random;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Code, Source};
use jurist_engine::model::Model;
use jurist_engine::stability::StableSet;

/// A current loop with a dead time of `m + f` samples.
#[derive(Clone, Debug)]
struct Machine {
    r: f64,
    l: f64,
    gain: f64,
    integral: f64,
    /// From one axis into the other. With it a frame that turns the other way is no mirror image.
    cross: f64,
    speed: f64,
    samples: usize,
    fraction: f64,
    /// In sample times.
    advance: f64,
}

impl Machine {
    fn random(random: &mut Random) -> Machine {
        let mut pick = |list: &[f64]| list[random.below(list.len())];
        Machine {
            r: pick(&[0.25, 0.5, 1.0, 2.0]),
            l: pick(&[0.5, 1.0, 1.5]),
            gain: pick(&[0.25, 0.5, 0.75]),
            integral: pick(&[0.0, 0.0625, 0.125]),
            cross: pick(&[-0.25, 0.0, 0.25]),
            speed: pick(&[-0.75, -0.25, 0.125, 0.5, 1.0, 1.5]),
            samples: random.below(2),
            fraction: [0.0, 0.25, 0.5][random.below(3)],
            advance: [0.0, 1.0, 1.5][random.below(3)],
        }
    }

    /// One sample lasts one unit of time.
    fn text(&self, block: &str) -> String {
        let Machine { r, l, gain, integral, cross, speed, .. } = self;
        format!(
            "time = 'discrete'\nsample_time = 1\n[constants]\nR = {r}\nL = {l}\nI = {integral}\n[parameters]\nK = {{ nominal = {gain}, min = 0, \
             max = 3 }}\nw = {{ nominal = {speed}, min = -3, max = 3 }}\n[loop]\ninputs = ['r']\noutputs = ['i']\n[[block]]\ninput = 'r - i'\n\
             output = 'u'\ntransfer = 'K + I/(z - 1) + j*({cross})'\n[[block]]\ninput = 'u'\noutput = 'i'\n{block}\n"
        )
    }

    fn framed(&self) -> String {
        let delay = self.samples as f64 + self.fraction;
        let advance = self.advance;
        self.text(&format!(
            "transfer = '1/(L*s + R)'\ndiscretize = {{ method = 'zoh', frame = 'w', delay = {delay}, advance = '{advance}*w' }}"
        ))
    }

    fn written_out(&self) -> String {
        let (f, m) = (self.fraction, self.samples);
        let turned = "(z*exp(j*w))";
        let now = format!("(1 - exp(-R/L*{}))/R", 1.0 - f);
        let early = format!("exp(-R/L*{})*(1 - exp(-R/L*{f}))/R", 1.0 - f);
        let above = if f > 0.0 { format!("({now} + {early}/{turned})") } else { now };
        let delay = if m > 0 { format!("/{turned}^{m}") } else { String::new() };
        self.text(&format!("transfer = 'exp(j*{}*w)*{above}{delay}/({turned} - exp(-R/L))'", self.advance))
    }

    /// Whether the loop is stable, in floating point; `None` where that is not clear.
    fn is_stable(&self, gain: f64, speed: f64) -> Option<bool> {
        type C = nalgebra::Complex<f64>;
        let turn = |angle: f64| C::from_polar(1.0, angle);
        let (phi, f) = ((-self.r / self.l).exp(), self.fraction);
        let part = |t: f64| (1.0 - (-self.r / self.l * t).exp()) / self.r;
        let (now, early) = (part(1.0 - f), (-self.r / self.l * (1.0 - f)).exp() * part(f));
        let m = self.samples + usize::from(f > 0.0);
        // (z - 1) (z e - phi) (z e)^m + exp(ja) (K (z - 1) + I) (now z e + early), or without `early`
        let e = turn(speed);
        let times = |a: &[C], b: &[C]| {
            let mut out = vec![C::default(); a.len() + b.len() - 1];
            for (i, x) in a.iter().enumerate() {
                b.iter().enumerate().for_each(|(k, y)| out[i + k] += x * y);
            }
            out
        };
        let one = C::from(1.0);
        let mut d = times(&[-one, one], &[C::from(-phi), e]);
        (0..m).for_each(|_| d = times(&d, &[C::default(), e]));
        let held = if f > 0.0 { vec![C::from(early), e * now] } else { vec![C::from(now)] };
        let own = C::new(gain, self.cross);
        let controller = [C::from(self.integral) - own, own];
        let n = times(&controller, &held);
        n.iter().enumerate().for_each(|(k, c)| d[k] += turn(self.advance * speed) * c);
        while d.len() > 1 {
            let n = d.len() - 1;
            let (first, last) = (d[0].norm(), d[n].norm());
            if (first - last).abs() < 1e-11 * last {
                return None;
            }
            if first > last {
                return Some(false);
            }
            let next: Vec<C> = (1..=n).map(|k| d[n].conj() * d[k] - d[0] * d[n - k].conj()).collect();
            let size = next.iter().map(|c| c.norm()).fold(0.0, f64::max);
            d = next.iter().map(|c| c / size).collect();
        }
        Some(true)
    }
}

fn set(text: &str, name: &str) -> StableSet {
    let answer = read(text).ask().free(name).stable_set(&Budget::unlimited());
    answer.unwrap_or_else(|e| panic!("{e}\n{text}")).into_value()
}

fn places(set: &StableSet) -> Vec<(String, String)> {
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    ends.map(|end| (end.value.decimal(17), end.causes.to_string())).collect()
}

#[test]
#[ignore = "long: CI runs it"]
fn limits_are_those_of_the_transfer_function_written_out() {
    let mut random = Random::new(2003);
    let (mut ends, mut moving) = (0, 0);
    for _ in 0..16 {
        let machine = Machine::random(&mut random);
        for name in ["K", "w"] {
            let found = set(&machine.framed(), name);
            assert!(found.undecided().is_empty(), "{machine:?} {name}: {:?}", found.undecided());
            let listed = places(&found);
            assert_eq!(listed, places(&set(&machine.written_out(), name)), "{machine:?} {name}");
            for (value, cause) in listed.iter().filter(|(_, cause)| cause != "domain") {
                let value: f64 = value.parse().unwrap();
                let at = |x: f64| match name {
                    "K" => machine.is_stable(x, machine.speed),
                    _ => machine.is_stable(machine.gain, x),
                };
                let sides = [at(value - 1e-6), at(value + 1e-6)];
                let known = [value - 1e-6, value + 1e-6].map(|x| {
                    let x = jurist_algebra::number::Rational::from_f64(x).unwrap();
                    Some(found.contains(&x))
                });
                assert!(
                    sides.iter().zip(known).all(|(s, k)| s.is_none() || *s == k),
                    "{machine:?} {name} = {value} {cause}: {sides:?}"
                );
                ends += 1;
                moving += usize::from(name == "w");
            }
        }
    }
    assert!(ends > 20 && moving > 8, "{ends} ends, {moving} of them speeds");
}

/// A command that is turned by two right angles more has the other sign: both are functions of one angle, whether the turn is written or the sign.
#[test]
fn a_command_turned_by_right_angles_more_has_another_sign() {
    let text = |gain: &str, more: &str| {
        format!(
            "time = 'discrete'\nsample_time = 'T'\n[parameters]\nK = 1\nw = -7\nT = 0.1\n[loop]\ninputs = ['r']\noutputs = ['i']\n[[block]]\n\
             input = 'r - i'\noutput = 'u'\ntransfer = '{gain}'\n[[block]]\ninput = 'u'\noutput = 'i'\ntransfer = '1/(s + 2)'\n\
             discretize = {{ method = 'zoh', frame = 'w', delay = 'T/2', advance = 'w*T{more}' }}\n"
        )
    };
    let ends = |gain: &str, more: &str| {
        let set = read(&text(gain, more)).ask().free("K").problem().unwrap().stable_set(&Budget::unlimited()).unwrap();
        let all = set.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
        all.map(|end| end.value.decimal(20)).collect::<Vec<String>>()
    };
    let known = ends("-K", "");
    assert!(!known.is_empty());
    assert_eq!(ends("K", " + pi"), known);
    assert_eq!(ends("K", " - 3*pi"), known);
    assert_eq!(ends("j*K", " + pi/2"), known);
}

/// Pulses of zero voltage, commanded before their period begins: by hand, edge by edge. With the edge at `t` behind the sample the
/// column `exp(-(1 - phi)/2)` acts on the command of `m` samples before, `t = m + phi`.
#[test]
#[ignore = "long: CI runs it"]
fn pulses_of_zero_voltage_in_a_turning_frame() {
    let text = |block: &str| {
        format!(
            "time = 'discrete'\nsample_time = 1\n[parameters]\nK = {{ nominal = 0.4, min = 0, max = 4 }}\nw = {{ nominal = 0.3, min = -3, max = 3 }}\n\
             [loop]\ninputs = ['r']\noutputs = ['i']\n[[block]]\nname = 'C'\ninput = 'r - i'\noutput = 'u'\ntransfer = 'K + 1/16/(z - 1)'\n\
             [[block]]\nname = 'P'\ninput = 'u'\noutput = 'i'\n{block}\n"
        )
    };
    let turned = "(z*exp(j*w))";
    for (edge, delay, column) in [
        // One edge at 5/4.
        ("trailing", "0.75", format!("exp(-3/8)/{turned}")),
        ("leading", "0.75", format!("exp(-3/8)/{turned}")),
        // Edges at 1/4 and at 3/4 of the period that begins at 1/2.
        ("double", "0.5", format!("(exp(-1/8) + exp(-3/8)/{turned})/2")),
    ] {
        let pulsed = text(&format!(
            "transfer = '1/(s + 1/2)'\ndiscretize = {{ method = 'pwm', edge = '{edge}', duty = '1/2', frame = 'w', delay = {delay}, advance = 'w' }}"
        ));
        let by_hand = text(&format!("transfer = 'exp(j*w)*{column}/({turned} - exp(-1/2))'"));
        for name in ["K", "w"] {
            let found = places(&set(&pulsed, name));
            assert!(!found.is_empty() && found == places(&set(&by_hand, name)), "{edge} {name}: {found:?}");
        }
        let margins = |text: &str| {
            let answer = read(text).ask().margins(None, &0.into(), &Budget::unlimited()).unwrap().into_value();
            let stable = answer.stable.unwrap();
            let both = stable.one_sided.unwrap();
            [both.lag, both.lead].map(|r| r.unwrap().degrees(60).decimal(12).unwrap())
        };
        assert_eq!(margins(&pulsed), margins(&by_hand), "{edge}");
    }
}

#[test]
fn pulses_of_another_voltage_are_refused_in_a_turning_frame() {
    let text = |duty: &str, frame: &str| {
        format!(
            "time = 'discrete'\nsample_time = 1\n[constants]\nhalf = '3/6'\n[parameters]\nK = 0.4\nw = 0.3\n[loop]\ninputs = ['r']\noutputs = ['i']\n\
             [[block]]\ninput = 'r - i'\noutput = 'u'\ngain = 'K'\n[[block]]\ninput = 'u'\noutput = 'i'\ntransfer = '1/(s + 1/2)'\n\
             discretize = {{ method = 'pwm', edge = 'trailing', duty = {duty}, frame = {frame} }}\n"
        )
    };
    let load = |text: &str| Model::from_toml(&Source::new("model.toml", text));
    for duty in ["0.4", "'K'", "'steady'"] {
        let text = text(duty, "'w'");
        let error = load(&text).map(|_| ()).unwrap_err();
        let [only] = error.diagnostics() else { panic!("{error}") };
        assert_eq!(only.code, Code::Frame, "{error}");
        let place = only.primary.as_ref().unwrap().span;
        assert!(text[place.start..place.end].contains(duty.trim_matches('\'')), "{error}");
        assert!(only.help.as_ref().unwrap().contains("duty = 0.5"));
    }
    assert!(load(&text("'half'", "'w'")).is_ok() && load(&text("0.4", "0")).is_ok());
}
