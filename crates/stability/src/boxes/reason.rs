//! Why a box stays undecided.

use std::fmt;

/// What ended the proof of a box that is neither proved nor refuted. `Display` writes it as every message does.
///
/// ```
/// use jurist_stability::boxes::OpenReason;
/// assert_eq!(OpenReason::Cells.to_string(), "too many cells");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OpenReason {
    /// Many cells were looked at, and there were more.
    Cells,
    /// A cell was so small, or varied so little, that halves of it show no more.
    Small,
    /// The cells that waited took much memory.
    Memory,
    /// The budget ran out.
    Time,
    /// Each of many boxes was refuted by a point.
    Refutations,
    /// A point is not stable, and on the line to it nothing seems to be lost.
    Unreached,
    /// A divisor, the constant or the leading coefficient may vanish.
    Vanishing,
    /// Roots may come from infinity.
    HighestPower,
    /// A dead time may not be defined.
    Pole,
    /// A dead time may be negative, or another order of dead times begins.
    NegativeTime,
    /// Enclosed constants do not tell.
    Constants,
    /// A point meets the requirement just so.
    Edge,
    /// The nominal point meets the requirement just so.
    NoRoom,
    /// Nothing was tried.
    Untried,
}

impl fmt::Display for OpenReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            OpenReason::Cells => "too many cells",
            OpenReason::Small => "a cell too small",
            OpenReason::Memory => "too much memory",
            OpenReason::Time => "the time that it was given is over",
            OpenReason::Refutations => "too many points that are not stable",
            OpenReason::Unreached => "a point that no line from the nominal one shows",
            OpenReason::Vanishing => "a divisor or a real root near zero",
            OpenReason::HighestPower => "the highest power of s may not outweigh its delayed part",
            OpenReason::Pole => "a dead time near a pole",
            OpenReason::NegativeTime => "a dead time that may be negative, or less than that of the highest power of s",
            OpenReason::Constants => "constants that are not told from their limits",
            OpenReason::Edge => "a point at the edge of the requirement",
            OpenReason::NoRoom => "no room at the nominal point",
            OpenReason::Untried => "nothing was tried",
        })
    }
}
