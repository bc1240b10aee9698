"""How far a loop is from instability: margins and peak gains."""

from __future__ import annotations

import math
from typing import Any

from ._answers import Document
from ._exact import Exact, Floats, text_of
from ._loop import Loop
from ._real import Real
from ._sets import End, Interval


class Margins(Document):
    """Margins of the loop cut at one signal, exact. They are `None` for a loop that is not stable; crossings are given all the same.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.LoopBuilder("continuous").block("plant", "r - y", "y", "4/(s*(s + 1)*(s + 2))").build(inputs=["r"], outputs=["y"])
    >>> m = jurist.margins(loop)
    >>> m.stable, m.gain_factors, round(m.phase_degrees, 6)
    (True, (0.0, 1.5), 11.430639)
    """

    __slots__ = ()

    @property
    def at(self) -> str:
        """Where the loop is cut."""
        return str(self._document["at"])

    @property
    def stable(self) -> bool:
        """Whether the closed loop is stable."""
        return bool(self._document["stable"])

    @property
    def gain(self) -> tuple[Interval, ...]:
        """All factors at the cut for which the loop is stable; 1 is nominal."""
        found = self._document["gain"]
        ends = [[None if i[side] is None else End(i[side]) for side in ("lower", "upper")] for i in found["stable"]] if found else []
        return tuple(Interval(lower, upper) for lower, upper in ends)

    def _end(self, side: str) -> End | None:
        found = self._document["gain"]
        return None if found is None or found[side] is None else End(found[side])

    @property
    def upper(self) -> End | None:
        """The least factor above 1 at which the loop is not stable."""
        return self._end("upper")

    @property
    def lower(self) -> End | None:
        """The greatest factor below 1 at which the loop is not stable."""
        return self._end("lower")

    @property
    def gain_factors(self) -> tuple[float, float]:
        """Both as floats, infinite where there is none above."""
        return float(self.lower) if self.lower else 0.0, float(self.upper) if self.upper else math.inf

    @property
    def phase_degrees(self) -> float | None:
        """The phase margin; infinite where any angle is borne."""
        found = self._document["phase"]
        if found is None:
            return None
        return math.inf if found["degrees"] is None else float(found["degrees"])

    @property
    def phase_tangent(self) -> Real | None:
        """Of half the phase margin, exactly."""
        found = self._document["phase"]
        return None if found is None or found["tangent"] is None else Real._from_document(found["tangent"])

    @property
    def modulus(self) -> Real | None:
        """The least distance of the open loop from -1."""
        found = self._document["modulus"]
        return None if found is None else Real._from_document(found["value"])

    @property
    def peak_sensitivity(self) -> Real | None:
        """The inverse of the modulus margin."""
        found = self._document["modulus"]
        return None if found is None else Real._from_document(found["peak_sensitivity"])

    @property
    def delay(self) -> dict[str, Any] | None:
        """How much delay at the cut is borne, as it stands in the document."""
        return self._document["delay"]

    @property
    def disk(self) -> dict[str, Any] | None:
        """The disk margin, as it stands in the document."""
        return self._document["disk"]

    @property
    def crossings(self) -> dict[str, Any]:
        """Where the open loop has modulus one, and where it is real and negative."""
        return dict(self._document["crossings"])

    def as_control(self) -> tuple[float, float, float, float, float, float]:
        """As python-control's ``stability_margins``: gm, pm, sm, wpc, wgc, wms; infinite and not-a-number where there is none."""

        def omega(found: dict[str, Any] | None) -> float:
            key = "angle" if self._document["time"] == "discrete" else "radians_per_second"
            value = None if found is None else found.get("radians_per_second", found.get(key))
            return math.nan if value is None else float(value)

        upper = self._document["gain"]["upper"] if self._document["gain"] else None
        phase, modulus = self._document["phase"], self._document["modulus"]
        degrees = self.phase_degrees
        return (
            math.inf if upper is None else float(upper["decimal"]),
            math.inf if degrees is None else degrees,
            math.inf if modulus is None else float(modulus["value"]["decimal"]),
            omega(upper),
            omega(phase),
            omega(modulus),
        )

    def __repr__(self) -> str:
        if not self.stable:
            return f"<Margins at {self.at}: not stable>"
        low, high = self.gain_factors
        return f"<Margins at {self.at}: factors ({low:.6g}, {high:.6g}), phase {self.phase_degrees:.6g} degrees>"


class Norm(Document):
    """The peak gain of a closed-loop transfer function, exact; `None` for a loop that is not stable.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.LoopBuilder("continuous").block("plant", "r - y", "y", "1/(s*(s + 1))").build(inputs=["r"], outputs=["y"])
    >>> print(jurist.norm(loop, "r", "y").peak)
    1.15470053838
    """

    __slots__ = ()

    @property
    def peak(self) -> Real | None:
        """The greatest gain over all frequencies."""
        found = self._document["peak"]
        return None if found is None else Real._from_document(found.get("value", found))


def margins(
    system: Any, values: Any = None, *, at: str | None = None, skew: Exact = 0, floats: Floats = "shortest", timeout: float | None = None
) -> Margins:
    """Gain, phase, delay, modulus and disk margins.

    Parameters
    ----------
    system : Loop, or an open loop of python-control or SciPy
        Around an open loop negative feedback is closed.
    values : mapping, optional
        Of parameters; the rest is nominal.
    at : str, optional
        Where the loop is cut: a signal, a block, a parameter that is the loop's gain.
    skew : exact number
        Of the disk margin.
    floats : {"shortest", "binary", "refuse"}
    timeout : float, optional
    """
    if isinstance(system, Loop):
        loop = system
    else:
        from ._control import from_control

        loop = from_control(system, gain="loop_gain", floats=floats)
        at = at or "loop_gain"
    asked = loop._asked(values, timeout=timeout)
    words = loop._words("margins", asked)
    words += ([] if at is None else ["--at", at]) + [f"--skew={text_of(skew)}"]
    text, _, _ = loop._command([*words, "--json", "--digits", "17"], asked)
    return Margins(text, loop, tuple(words))


def norm(loop: Loop, input: str, output: str, values: Any = None, *, timeout: float | None = None) -> Norm:
    """The peak gain (H-infinity norm) of the closed loop from an input to an output."""
    asked = loop._asked(values, timeout=timeout)
    command, model, *options = loop._words("norm", asked)
    words = [command, model, input, output, *options]
    text, _, _ = loop._command([*words, "--json"], asked)
    return Norm(text, loop, tuple(words))
