//! The kinds of documents: one list, of which the published schemas are made, and by which a document is read.

use super::{
    Analysis, Body, Charpoly, Check, Intervals, Jury, LeastMargins, Lock, Map, MapBoxes, MarginRanges, Margins, Norm,
    RootLocusForm, Roots, Test, Tolerance, Transfer, Verdict,
};
use serde_json::{Error, Value, from_value, to_value};

/// Makes what follows from the list of types and of what stands under `schema` in them.
macro_rules! documents {
    ($($document:ident: $name:literal,)+) => {
        /// The kinds of the engine's documents, with their versions.
        ///
        /// ```
        /// use jurist_show::documents::NAMES;
        /// assert!(NAMES.contains(&"jurist/intervals/1"));
        /// ```
        pub const NAMES: &[&str] = &[$($name),+];

        /// A document once through the type of its kind: the same again, where nothing in it is unknown. `None` of another kind.
        ///
        /// ```
        /// use jurist_show::documents::through_its_type;
        /// let document = serde_json::json!({ "schema": "jurist/analyze/1", "verdict": null, "parameters": [] });
        /// assert_eq!(through_its_type(&document).unwrap().unwrap(), document);
        /// ```
        pub fn through_its_type(document: &Value) -> Option<Result<Value, Error>> {
            match document["schema"].as_str()? {
                $($name => Some(from_value::<$document>(document.clone()).and_then(to_value)),)+
                _ => None,
            }
        }

        /// The documents of the engine: kind with version, and schema.
        #[cfg(feature = "schema")]
        pub(super) fn schemas() -> Vec<(&'static str, Value)> {
            vec![$(($name, super::schemas::schema_of::<$document>($name))),+]
        }
    };
}

documents! {
    Analysis: "jurist/analyze/1",
    Body: "jurist/body/1",
    Charpoly: "jurist/charpoly/1",
    Check: "jurist/check/1",
    Intervals: "jurist/intervals/1",
    Jury: "jurist/jury/1",
    LeastMargins: "jurist/least-margins/1",
    Lock: "jurist/lock/1",
    Map: "jurist/map/1",
    MapBoxes: "jurist/map-boxes/1",
    MarginRanges: "jurist/margin-ranges/1",
    Margins: "jurist/margins/1",
    Norm: "jurist/norm/1",
    RootLocusForm: "jurist/root-locus-form/1",
    Roots: "jurist/roots/1",
    Test: "jurist/test/1",
    Tolerance: "jurist/tolerance/1",
    Transfer: "jurist/transfer/1",
    Verdict: "jurist/verdict/1",
}
