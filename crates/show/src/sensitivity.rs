//! How limits move, for people.

use super::layout::{Columns, short, visible};
use super::real;
use crate::Text;
use jurist_algebra::real::Real;
use jurist_engine::answer::Sensitivities;

/// Digits of derivatives.
const PLACES: usize = 7;

impl Text for Sensitivities {
    /// A table: for each limit what a small change of each name does to it.
    fn text(&self, digits: usize) -> String {
        if self.rows.is_empty() {
            return "no limit moves with another name\n".to_owned();
        }
        let mut columns = Columns::new("    ");
        columns.row(["limit", "name", "value", "derivative", "percent for a percent"].map(str::to_owned));
        let number = |x: &Option<Real>| x.as_ref().map_or("none".to_owned(), |x| real::rounded(x, PLACES).decimal);
        for row in &self.rows {
            columns.row([
                real::rounded(&row.limit, digits).decimal,
                visible(&row.name).into_owned(),
                short(&row.value),
                number(&row.derivative),
                number(&row.relative),
            ]);
        }
        format!("how the limits move\n{columns}")
    }
}
