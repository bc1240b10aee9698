//! Bodies whose slices are known.

