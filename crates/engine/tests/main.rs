//! Models and answers together: plants behind a hold, against answers that were found in another way, and zeros that only identities show.

mod enclosed_tables;
mod held;
mod held_limits;
mod held_loops;
mod identities;
mod rounding;
