//! The values of a model as they are written, and the model with another text in the place of one.

use super::Model;
use super::text::toml_reader;
use super::text::toml_value::{Kind, Table, Value};
use crate::error::{Diagnostic, Diagnostics, Source, Span};

/// The value of a constant, or the nominal value of a parameter, as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Written {
    /// The name.
    pub name: String,
    /// The value in TOML: `0.1`, `"L/R"`, `[[0, 1]]`.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

impl Model {
    /// The values of constants and the nominal values of parameters, in the order of the text.
    ///
    /// Cost: that of reading the text as TOML.
    ///
    /// ```
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Model;
    /// let text = "time = 'discrete'\n[constants]\nk = 0.50\n[parameters]\nK = { nominal = 'k' }\n[loop]\ncharacteristic = 'z - K'\n";
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// let written: Vec<String> = model.written().into_iter().map(|w| format!("{} = {}", w.name, w.text)).collect();
    /// assert_eq!(written, ["k = 0.50", "K = 'k'"]);
    /// let (other, _) = model.rewritten("k", "2")?;
    /// assert_eq!(other.constant("k").unwrap().number, Some(2.into()));
    /// # Ok::<(), jurist_engine::error::Diagnostics>(())
    /// ```
    pub fn written(&self) -> Vec<Written> {
        let text = &self.source.text;
        let Ok(root) = toml_reader::read(text) else { return Vec::new() };
        let mut out = Vec::new();
        for (section, key) in [("constants", "value"), ("parameters", "nominal")] {
            let Some(Kind::Table(table)) = root.get(section).map(|v| &v.kind) else { continue };
            for entry in table.iter() {
                if let Some(value) = own_value(&entry.value, key) {
                    let span = value.span;
                    out.push(Written { name: entry.key.clone(), text: text[span.start..span.end].to_owned(), span });
                }
            }
        }
        out.sort_by_key(|written| written.span.start);
        out
    }

    /// The model whose text has another value for a name; the model itself where nothing is written for it.
    ///
    /// Cost: that of [`Model::from_toml`].
    ///
    /// # Errors
    /// As [`Model::from_toml`].
    pub fn rewritten(&self, name: &str, text: &str) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
        let mut whole = self.source.text.clone();
        if let Some(written) = self.written().into_iter().find(|w| w.name == name) {
            whole.replace_range(written.span.start..written.span.end, text);
        }
        Model::from_toml(&Source::new(self.source.name.clone(), whole))
    }
}

/// The value alone, or that under a key of its table.
fn own_value<'v>(value: &'v Value, key: &str) -> Option<&'v Value> {
    match &value.kind {
        Kind::Table(table) => Table::get(table, key),
        _ => Some(value),
    }
}
