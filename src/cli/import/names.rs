//! Names of another program as names of a model file.

use std::collections::HashSet;

/// Names that mean something else in a model file.
const TAKEN: [&str; 14] =
    ["s", "z", "K", "pi", "radius", "decay", "exp", "sqrt", "sin", "cos", "tan", "log", "ln", "abs"];

/// Longer names are cut.
const LONGEST: usize = 60;

/// Gives names that no two things share.
#[derive(Default)]
pub(super) struct Given(HashSet<String>);

impl Given {
    /// The first of the wishes that is still free; else the last one with a number.
    pub fn name(&mut self, wishes: &[String]) -> String {
        let is_free = |name: &str| !name.is_empty() && !is_taken(name) && !self.0.contains(name);
        let free = wishes.iter().find(|wish| is_free(wish)).cloned();
        let last = wishes.last().map_or("signal", String::as_str);
        let name = free.unwrap_or_else(|| {
            (2usize..).map(|k| format!("{last}_{k}")).find(|name| is_free(name)).expect("some number is free")
        });
        self.0.insert(name.clone());
        name
    }
}

/// Whether a name is one of the entries of a matrix, `a_1_2`, or means something else.
fn is_taken(name: &str) -> bool {
    let parts: Vec<&str> = name.split('_').collect();
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    let is_entry = matches!(parts[..], [matrix, row, column] if ["a", "b", "c", "d"].contains(&matrix) && is_number(row) && is_number(column));
    is_entry || TAKEN.contains(&name)
}

/// Letters, digits and underscores: `motor.phi` is `motor_phi`, `d[1].w` is `d_1_w`. Empty where nothing is left.
pub(super) fn plain(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if out.len() >= LONGEST {
            break;
        }
        if c.is_ascii_alphanumeric() {
            out.push(c);
        } else if !out.is_empty() && !out.ends_with('_') {
            out.push('_');
        }
    }
    let out = out.trim_end_matches('_');
    if out.starts_with(|c: char| c.is_ascii_digit()) { format!("n{out}") } else { out.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{Given, plain};

    #[test]
    fn names_of_modelica_become_plain() {
        let cases = [
            ("motor.phi", "motor_phi"),
            ("d[1].d.Vx", "d_1_d_Vx"),
            ("der(x)", "der_x"),
            ("$outputAlias_speed", "outputAlias_speed"),
            ("1st", "n1st"),
            ("Geschwindigkeit in m/s", "Geschwindigkeit_in_m_s"),
            ("\u{3c6}", ""),
            ("__", ""),
        ];
        for (name, expected) in cases {
            assert_eq!(plain(name), expected, "{name}");
        }
        assert_eq!(plain(&"x".repeat(1000)).len(), 60);
    }

    #[test]
    fn no_two_things_share_a_name() {
        let mut given = Given::default();
        let mut name = |wishes: &[&str]| given.name(&wishes.iter().map(|w| w.to_string()).collect::<Vec<_>>());
        assert_eq!(name(&["speed", "u_speed"]), "speed");
        assert_eq!(name(&["speed", "y_speed"]), "y_speed");
        assert_eq!(name(&["speed", "y_speed"]), "y_speed_2");
        assert_eq!(name(&["", "u_1"]), "u_1");
        assert_eq!(name(&["K", "u_K"]), "u_K");
        assert_eq!(name(&["a_1_2", "x_a_1_2"]), "x_a_1_2");
        assert_eq!(name(&["s"]), "s_2");
    }
}
