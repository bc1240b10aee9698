//! From a polynomial to an answer about stability.
