"""Requirements as keywords, written by a test from the engine's list.

- ``gain_margin``: a factor both ways, or decibels: "6 dB".
- ``phase_margin``: an angle: "45 deg".
- ``modulus_margin``: the least |1 + L|, the inverse of the greatest sensitivity.
- ``complementary_peak``: the greatest |L/(1 + L)|, the peak of the complementary sensitivity.
- ``disk_margin``: the least 2 |1 + L|/|1 - L|, the size of the balanced disk of gains and phases.
- ``delay_margin``: a dead time in units of time.
- ``damping``: the least damping of all roots; in discrete time of ln(z)/T.
- ``settling_time``: a decay of at least 4 over this time.
"""

from __future__ import annotations

from typing import TypedDict

from ._exact import Exact

REQUIREMENTS = (
    "gain_margin",
    "phase_margin",
    "modulus_margin",
    "complementary_peak",
    "disk_margin",
    "delay_margin",
    "damping",
    "settling_time",
)
"""What may be required beyond stability, named as the program's options."""


class Requiring(TypedDict, total=False):
    """A number for each requirement."""

    gain_margin: Exact | None
    phase_margin: Exact | None
    modulus_margin: Exact | None
    complementary_peak: Exact | None
    disk_margin: Exact | None
    delay_margin: Exact | None
    damping: Exact | None
    settling_time: Exact | None
