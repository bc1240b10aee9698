//! From model text to a [loop](crate::model).
