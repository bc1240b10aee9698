//! Signals over time, ready to be drawn or written as a table.

/// One signal: a value for every time of its [`Trace`].
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Name, e.g. `omega`.
    pub name: String,
    /// Unit for the axis; empty if unknown.
    pub unit: String,
    /// The values, as many as there are times.
    pub values: Vec<f64>,
}

/// Signals over a common, increasing time (instants may repeat where a signal jumps).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Times in seconds, or sample numbers where the model names no sample time.
    pub time: Vec<f64>,
    /// The signals.
    pub signals: Vec<Signal>,
}

impl Trace {
    /// A trace without instants, with the names of its signals.
    pub fn with_names(names: &[String]) -> Trace {
        let signal = |name: &String| Signal { name: name.clone(), unit: String::new(), values: Vec::new() };
        Trace { time: Vec::new(), signals: names.iter().map(signal).collect() }
    }

    /// The trace with the units that `unit` knows of its signals.
    pub fn with_units(mut self, unit: impl Fn(&str) -> Option<String>) -> Trace {
        for signal in &mut self.signals {
            signal.unit = unit(&signal.name).unwrap_or_default();
        }
        self
    }

    /// Adds one instant; missing values become 0, surplus ones are ignored.
    pub fn push(&mut self, time: f64, values: impl IntoIterator<Item = f64>) {
        self.time.push(time);
        let mut values = values.into_iter();
        for signal in &mut self.signals {
            signal.values.push(values.next().unwrap_or(0.0));
        }
    }

    /// The signal of that name.
    pub fn signal(&self, name: &str) -> Option<&Signal> {
        self.signals.iter().find(|s| s.name == name)
    }

    /// The instants and values of one signal as points.
    pub fn points(&self, name: &str) -> Vec<(f64, f64)> {
        self.signal(name).map_or_else(Vec::new, |s| self.time.iter().copied().zip(s.values.iter().copied()).collect())
    }

    /// The largest magnitude a signal reaches; 0 for an unknown or empty one.
    pub fn peak(&self, name: &str) -> f64 {
        self.signal(name).map_or(0.0, |s| s.values.iter().fold(0.0, |m, v| m.max(v.abs())))
    }

    /// The part between two times, both included.
    pub fn between(&self, from: f64, to: f64) -> Trace {
        let keep: Vec<usize> = (0..self.time.len()).filter(|&i| self.time[i] >= from && self.time[i] <= to).collect();
        let pick = |values: &[f64]| keep.iter().map(|&i| values[i]).collect();
        let signals = self.signals.iter().map(|s| Signal { values: pick(&s.values), ..s.clone() }).collect();
        Trace { time: pick(&self.time), signals }
    }

    /// A table with one row per instant: `t` and the signals, comma separated, a header line first.
    pub fn to_csv(&self) -> String {
        let mut out = String::from("t");
        for signal in &self.signals {
            out.push(',');
            out.push_str(&quote_csv(&signal.name));
        }
        out.push('\n');
        for (i, t) in self.time.iter().enumerate() {
            out.push_str(&t.to_string());
            for signal in &self.signals {
                out.push(',');
                out.push_str(&signal.values[i].to_string());
            }
            out.push('\n');
        }
        out
    }
}

/// A CSV field, quoted where a comma, a quote or a line break asks for it.
fn quote_csv(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_header_and_quotes_only_where_needed() {
        let mut trace = Trace::with_names(&["a".into(), "b, or \"c\"".into()]);
        trace.push(0.5, [1.0, -2.0]);
        assert_eq!(trace.to_csv(), "t,a,\"b, or \"\"c\"\"\"\n0.5,1,-2\n");
    }

    #[test]
    fn a_window_keeps_its_ends() {
        let mut trace = Trace::with_names(&["a".into()]);
        for k in 0..5 {
            trace.push(k as f64, [10.0 * k as f64]);
        }
        let part = trace.between(1.0, 3.0);
        assert_eq!(part.points("a"), vec![(1.0, 10.0), (2.0, 20.0), (3.0, 30.0)]);
        assert_eq!(part.peak("a"), 30.0);
        assert!(part.points("missing").is_empty());
    }
}
