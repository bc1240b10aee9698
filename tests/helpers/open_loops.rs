//! Loops cut open: models of them, and their margins.

use super::model::load;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::model::Model;
use jurist_engine::response::{Margins, StableMargins};

/// A single loop with this open loop, in lowest terms.
pub fn loop_of(time: &str, numerator: &str, denominator: &str) -> Model {
    load(&format!(
        "time = '{time}'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n\
         num = [{numerator}]\nden = [{denominator}]\n"
    ))
}

/// The margins at a cut, with the balanced disk.
pub fn margins_of(model: &Model, at: Option<&str>) -> Answer<Margins> {
    model.ask().margins(at, &Rational::ZERO, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

/// The margins of a stable loop.
pub fn stable(answer: &Answer<Margins>) -> &StableMargins {
    answer.value().stable.as_ref().expect("a stable loop")
}

/// A PD controller with a sample of computation time on a motor; `K` is its gain.
pub const SERVO: &str = "time = 'discrete'
[parameters]
K = { nominal = 4, min = 0 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'PD'
input = 'r - y'
output = 'u'
transfer = 'K*(11*z - 10)/z'
[[block]]
name = 'motor'
input = 'u'
output = 'y'
transfer = '(1/1000)/((z - 1)*(z - 9/10)*z)'
";

/// Stable for middle gains only.
pub const CONDITIONAL: &str = "time = 'continuous'
[parameters]
K = { nominal = 200 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'L'
input = 'r - y'
output = 'y'
transfer = 'K*(s + 1)^2/(s^3*(s/20 + 1)^2)'
";

/// The damping of a resonance is its parameter.
pub const RESONANT: &str = "time = 'continuous'
[parameters]
a = { nominal = 1, min = 0 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'L'
input = 'r - y'
output = 'y'
transfer = '(s + 2)/(s*(s^2 + a*s + 4))'
";

/// The servo with its motor's pole typed in to sixteen digits.
pub const SERVO_AS_TYPED: &str = "time = 'discrete'
sample_time = 'T'
[constants]
T = 0.002
T_m = 0.05
p = 0.9607894391523232
Kd = 0.02
[parameters]
K = { nominal = 4, min = 0 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'PD'
input = 'r - y'
output = 'u'
transfer = 'K*(1 + Kd*(z-1)/(T*z))'
[[block]]
name = 'computation'
input = 'u'
output = 'v'
delay = 1
[[block]]
name = 'motor'
input = 'v'
output = 'y'
transfer = '20*(T/(z-1) - T_m*(1-p)/(z-p))'
";

/// The same with its motor behind a hold.
pub const SERVO_BEHIND_A_HOLD: &str = "time = 'discrete'
sample_time = 'T'
[constants]
T = 0.002
T_m = 0.05
Kd = 0.02
[parameters]
K = { nominal = 4, min = 0 }
[loop]
inputs = ['r']
outputs = ['y']
[[block]]
name = 'PD'
input = 'r - y'
output = 'u'
transfer = 'K*(1 + Kd*(z-1)/(T*z))'
[[block]]
name = 'computation'
input = 'u'
output = 'v'
delay = 1
[[block]]
name = 'motor'
input = 'v'
output = 'y'
transfer = '20/(s*(T_m*s + 1))'
discretize = 'zoh'
";
