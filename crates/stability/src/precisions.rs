//! The precisions of this crate: bits of the first attempt and most bits, with the reason.
//!
//! What is only ever asked of numbers that differ needs no last precision (`until_shown`) and is not here. The bytes of
//! undecided answers depend on these numbers: a change of one is a change for users.

use jurist_algebra::limits::Precisions;

/// The root count of a polynomial with enclosed coefficients. Roots may be on the boundary.
pub const ROOT_COUNT: Precisions = Precisions::new(128, 1 << 14);

/// Bits of a root count from which on roots on the boundary are looked for as identities.
pub const ROOTS_ON_BOUNDARY: u64 = 512;

/// The sign of a determinant at a number that may be one of its zeros.
pub const SIGN_OF_DETERMINANT: Precisions = Precisions::new(128, 1 << 14);

/// The lowest and the highest coefficient of a determinant or resultant that is not zero, where none is expanded.
pub const ENDS_OF_DETERMINANT: Precisions = Precisions::new(192, 1 << 12);

/// A determinant at a rational number, before it is expanded in the symbols.
pub const DETERMINANT_AT_POINT: Precisions = Precisions::new(192, 1 << 10);

/// The resultant on a face of the Newton polygon, before common roots are looked for exactly.
pub const RESULTANT_OF_FACE: Precisions = Precisions::new(192, 768);

/// The common root of the half-size pair, which need not be the only one.
pub const COMMON_ROOT: Precisions = Precisions::new(64, 1 << 12);

/// The conditions of Jury's table, which may be equalities.
pub const JURY_TABLE: Precisions = Precisions::new(256, 1 << 15);

/// The rows of a table, whose divisors may be zero.
pub const TABLE_ROWS: Precisions = Precisions::new(512, 1 << 14);

/// Coefficients of rows that enclosures with so many bits do not separate from zero stay enclosures of zero, where no row is
/// divided by them.
pub const ENTRIES_AS_ZERO: u64 = 1 << 12;

/// The coefficients over a window. Those that are small even with the last bits are taken as they are.
pub const PLANE_COEFFICIENTS: Precisions = Precisions::new(256, 2048);

/// Bits of nearness to the end of a region. The last ones are taken even if a root is not tracked.
pub const LIMIT_OF_CELL: Precisions = Precisions::new(8, 512);

/// Bits of nearness to a wall that cells may touch at, beyond those of the first trials.
pub const TOUCHING_CELLS: Precisions = Precisions::new(64, 256);

/// A point at which the curve of complex pairs may cross itself.
pub const SINGULAR_POINT: Precisions = Precisions::new(256, 1024);

/// The motion of a root on the axis with the dead time. It may be zero; such a crossing is counted on both sides instead.
pub const MOTION_OF_ROOTS: Precisions = Precisions::new(64, 512);

/// A zero that may be at an end of the range.
pub const ZERO_AT_EDGE: Precisions = Precisions::new(64, 512);

/// Coefficients over constants beside dead time. A root may be on the axis.
pub const CONSTANTS_BESIDE_DEAD_TIME: Precisions = Precisions::new(256, 1024);

/// The order of two dead times with roots on the axis, which no theorem separates.
pub const ORDER_OF_DEAD_TIMES: Precisions = Precisions::new(96, 1 << 12);

/// The argument along the imaginary axis. The function may be zero there.
pub const ARGUMENT_ALONG_AXIS: Precisions = Precisions::new(64, 1 << 14);

/// A root of a loop with dead time. All are simple, but where nothing is near to the approximation no bits show one.
pub const ROOT_OF_QUASI_POLYNOMIAL: Precisions = Precisions::new(128, 1 << 12);

/// The sum of an impulse response beside which the errors of its samples are small: the first bits, and how many beyond those that the digits
/// take. Where all coefficients of the numerator are zero by identities the sum is zero, which no bits show.
pub const IMPULSE_RESPONSE: Precisions = Precisions::new(64, 1 << 12);
