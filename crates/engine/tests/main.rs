//! Plants behind a hold, against answers that were found in another way.

mod enclosed_tables;
mod held;
mod held_limits;
mod held_loops;
mod rounding;
