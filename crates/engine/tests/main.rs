//! Plants behind a hold, against answers that were found in another way.

mod held;
mod held_limits;
mod held_loops;
