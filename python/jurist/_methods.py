"""Methods of discretisation, written by a test from the engine's list."""

from __future__ import annotations

from typing import Literal

Method = Literal["zoh", "foh", "pwm", "tustin", "forward", "backward"]
"""By which rule or hold a continuous block is made discrete."""
