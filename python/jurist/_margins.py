"""Margins of a loop, and peak gains."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

from ._answers import Document
from ._ends import End
from ._exact import fraction
from ._real import Real
from ._sets import StableSet


class At(NamedTuple):
    """A frequency, as floats rounded correctly; `None` where it does not exist."""

    hertz: float | None
    omega: float | None
    angle: float | None

    @classmethod
    def _of(cls, document: dict[str, Any]) -> At:
        return cls(document["frequency_hz"], document["radians_per_second"], document["angle"])


class PhaseMargin(NamedTuple):
    """How far the open loop may be turned either way."""

    degrees: float | None
    tangent: Real | None
    at: At
    lag: float | None = None
    """Of a loop with complex coefficients: the smallest turn in the sense of a delay, in degrees; `degrees` is the smaller of both."""
    lead: float | None = None
    """The same in the other sense."""


class DelayMargin(NamedTuple):
    """How much dead time (continuous time) or how many samples (discrete time) at the cut are borne."""

    unbounded: bool
    seconds: float | None
    samples: int | None
    enclosure: tuple[Fraction, Fraction] | None
    at: At


class Peak(NamedTuple):
    """The least or greatest value of a modulus over frequency."""

    value: Real
    attained: bool
    at: At


class DiskMargin(NamedTuple):
    """The disk of complex factors that is borne."""

    skew: Fraction
    alpha: Real | None
    gain: tuple[float, float]
    phase_degrees: float
    at: At


class GainCrossing(NamedTuple):
    """Where the open loop has modulus one."""

    phase_margin_degrees: float
    delay: float | None
    direction: str
    at: At


class PhaseCrossing(NamedTuple):
    """Where the open loop is real and negative: the factor that makes it -1."""

    factor: float
    exact: Fraction | None
    enclosure: tuple[Fraction, Fraction]
    at: At


class Margins(Document):
    """How far a loop is from instability, cut at one signal. Margins are `None` where the loop is not stable as it stands.

    Examples
    --------
    >>> import control, jurist
    >>> m = jurist.margins(control.tf([10], [1, 6, 11, 6]))
    >>> m.stable, str(m.upper), m.phase.degrees
    (True, '6', 90.0)
    >>> m
    <Margins: gain (-0.6, 6), phase 90 deg, modulus 0.702...>
    """

    __slots__ = ()

    @property
    def at(self) -> str:
        """Where the loop is cut."""
        return str(self._document["at"])

    @property
    def stable(self) -> bool:
        """Whether the loop is stable as it stands."""
        return bool(self._document["stable"])

    def _end(self, *path: Any) -> End | None:
        document = self._part(*path)
        return None if document is None else End(document, None, self._narrowed(*path))

    @property
    def gain(self) -> StableSet | None:
        """All factors at the cut for which the loop is stable, the negative ones too; 1 is nominal."""
        found = self._document["gain"]
        if found is None:
            return None
        shared = {key: self._document[key] for key in ("title", "time", "set")}
        whole = {"parameter": "k", "unit": None, "nominal": "1", "domain": {"lower": None, "upper": None}}
        return StableSet({**shared, **whole, "stable": found["stable"]}, refine=lambda k, side: self._narrowed("gain", "stable", k, side))

    @property
    def upper(self) -> End | None:
        """The least factor above 1 at which the loop is not stable."""
        return self._end("gain", "upper")

    @property
    def lower(self) -> End | None:
        """The greatest factor below 1, not below 0, at which it is not."""
        return self._end("gain", "lower")

    @property
    def phase(self) -> PhaseMargin | None:
        """The phase margin; its degrees are `None` where any angle is borne."""
        found = self._document["phase"]
        if found is None:
            return None
        degrees = None if found["degrees"] is None else float(found["degrees"])
        lag, lead = (None if key not in found else float(found[key]) for key in ("lag", "lead"))
        return PhaseMargin(degrees, self._number("phase", "tangent"), At._of(found), lag, lead)

    @property
    def delay(self) -> DelayMargin | None:
        """The delay margin."""
        found = self._document["delay"]
        if found is None:
            return None
        seconds = None if found["seconds"] is None else float(found["seconds"])
        return DelayMargin(found["unbounded"], seconds, found["samples"], _bounds(found["enclosure"]), At._of(found))

    @property
    def modulus(self) -> Peak | None:
        """The least distance of the open loop from -1."""
        return self._peak("modulus", "value")

    @property
    def peak_sensitivity(self) -> Peak | None:
        """Its inverse: the greatest modulus of the sensitivity."""
        return self._peak("modulus", "peak_sensitivity")

    @property
    def peak_complementary(self) -> Peak | None:
        """The greatest modulus of the complementary sensitivity."""
        return self._peak("complementary", "peak")

    def _peak(self, part: str, name: str) -> Peak | None:
        found = self._document[part]
        value = None if found is None else self._number(part, name)
        return None if value is None else Peak(value, found["attained"], At._of(found))

    @property
    def disk(self) -> DiskMargin | None:
        """The disk margin."""
        found = self._document["disk"]
        if found is None:
            return None
        low, high = (math.inf if g is None else float(g) for g in found["gain"])
        skew, degrees = fraction(found["skew"]), float(found["phase_degrees"])
        return DiskMargin(skew, self._number("disk", "alpha"), (low, high), degrees, At._of(found))

    @property
    def gain_crossings(self) -> tuple[GainCrossing, ...]:
        """Where the open loop has modulus one, by ascending frequency."""
        return tuple(
            GainCrossing(float(c["phase_margin_degrees"]), None if c["delay"] is None else float(c["delay"]), c["direction"], At._of(c))
            for c in self._document["crossings"]["gain"]
        )

    @property
    def phase_crossings(self) -> tuple[PhaseCrossing, ...]:
        """Where the open loop is real and negative, by ascending frequency."""
        found = []
        for c in self._document["crossings"]["phase"]:
            low, high = _bounds(c["enclosure"]) or (Fraction(0), Fraction(0))
            own = None if c["exact"] is None else fraction(c["exact"])
            found.append(PhaseCrossing(float(c["factor"]), own, (low, high), At._of(c)))
        return tuple(found)

    def as_control(self) -> tuple[float, float, float, float, float, float]:
        """What ``control.stability_margins`` gives: gain margin, phase margin, modulus margin, and their frequencies in rad/s.

        The gain margin is the end of the stable factors above 1. A loop that is not stable has no margins: all are not-a-number.
        """
        if not self.stable:
            return (math.nan,) * 6
        phase, modulus = self.phase, self.modulus
        assert phase is not None
        assert modulus is not None
        gm = math.inf if self.upper is None else float(self.upper)
        pm = math.inf if phase.degrees is None else phase.degrees
        at = [self.upper.omega if self.upper else None, phase.at.omega, modulus.at.omega]
        wpc, wgc, wms = (math.nan if w is None else w for w in at)
        return gm, pm, float(modulus.value), wpc, wgc, wms

    def __str__(self) -> str:
        return self.text().rstrip()

    def __repr__(self) -> str:
        if not self.stable:
            return f"<Margins: the loop is {self._document['verdict']}>"
        phase, modulus = self.phase, self.modulus
        assert phase is not None
        assert modulus is not None
        degrees = "any" if phase.degrees is None else f"{phase.degrees:.12g} deg"
        return f"<Margins: gain {self.gain}, phase {degrees}, modulus {modulus.value.decimal(3)}...>"

    def _repr_html_(self) -> str:
        from ._html import escaped, set_html, table

        if not self.stable:
            return f"<div>cut at {escaped(self.at)}: the loop is {escaped(self._document['verdict'])}, so it has no margins</div>"
        phase, delay, modulus, gain = self.phase, self.delay, self.modulus, self.gain
        assert phase is not None
        assert delay is not None
        assert modulus is not None
        assert gain is not None
        borne = "any" if delay.unbounded else f"{delay.samples} samples" if delay.seconds is None else f"{delay.seconds:.6g}"
        rows: list[list[Any]] = [
            ["phase margin", "any" if phase.degrees is None else f"{phase.degrees:.6g}°", _hertz(phase.at)],
            ["delay margin", borne, _hertz(delay.at)],
            ["modulus margin", modulus.value, _hertz(modulus.at)],
        ]
        return f"<div>cut at {escaped(self.at)}{set_html(gain)}{table(['margin', 'value', 'frequency'], rows)}</div>"


def _hertz(at: At) -> str:
    return "" if at.hertz is None else f"{at.hertz:.6g} Hz"


def _bounds(pair: list[str] | None) -> tuple[Fraction, Fraction] | None:
    return None if pair is None else (fraction(pair[0]), fraction(pair[1]))


class LeastMargin(NamedTuple):
    """How much of one margin there is for all values of some names."""

    name: str
    """A phase margin is in degrees, a gain margin a factor, a delay margin in units of time."""
    proved: Fraction | None
    """All values have at least so much, of a peak at most; `None` where nothing is proved."""
    found: tuple[Fraction, Fraction] | None
    """Certified bounds of what one value has; `None` where no value that was looked at limits it."""
    at: dict[str, Fraction] | None
    """That value of each name."""


class LeastMargins(Document):
    """How much of each margin a loop has for all values of some names."""

    __slots__ = ()

    @property
    def stable(self) -> bool | None:
        """Whether the loop is stable for all values; `None` where that is not decided."""
        found: bool | None = self._document["stable"]
        return found

    @property
    def margins(self) -> dict[str, LeastMargin]:
        """The margins by name; none unless the loop is stable for all values."""
        return {one["name"]: _least(one) for one in self._document["margins"]}

    def __str__(self) -> str:
        return self.text().rstrip()

    def __repr__(self) -> str:
        told = [f"{one.name} {float(one.proved):g}" for one in self.margins.values() if one.proved is not None]
        return f"<LeastMargins {', '.join(told)}>" if self.stable else f"<LeastMargins stable={self.stable}>"


def _least(one: dict[str, Any]) -> LeastMargin:
    found, proved = one["found"], one["proved"]
    bounds = None if found is None else (fraction(found["enclosure"][0]), fraction(found["enclosure"][1]))
    at = None if found is None else {name: fraction(value) for name, value in found["at"].items()}
    return LeastMargin(one["name"], None if proved is None else fraction(proved), bounds, at)


class Norm(Document):
    """The peak gain of a closed-loop transfer function; `None` where the loop is not stable."""

    __slots__ = ()

    @property
    def stable(self) -> bool:
        """Whether the closed loop is stable."""
        return bool(self._document["stable"])

    @property
    def peak(self) -> Peak | None:
        """The greatest modulus, exactly, and where it is."""
        found = self._document["norm"]
        value = None if found is None else self._number("norm", "value")
        return None if value is None else Peak(value, found["attained"], At._of(found))

    @property
    def value(self) -> Real | None:
        """The greatest modulus."""
        return None if self.peak is None else self.peak.value

    def __float__(self) -> float:
        return math.inf if self.value is None else float(self.value)

    def __str__(self) -> str:
        return self.text().rstrip()

    def __repr__(self) -> str:
        return f"<Norm {self.value}>" if self.stable else f"<Norm: the loop is {self._document['verdict']}>"


class PeakToPeak(Document):
    """The peak-to-peak gain of a closed-loop transfer function; `None` where the loop is not stable.

    From rest the output is at most that times the greatest magnitude of the input.
    """

    __slots__ = ()

    @property
    def stable(self) -> bool:
        """Whether the closed loop is stable."""
        return bool(self._document["stable"])

    @property
    def decimal(self) -> str | None:
        """The gain to the digits asked for."""
        found: str | None = self._l1("decimal")
        return found

    @property
    def exact(self) -> Fraction | None:
        """The gain itself where it is proved to be this rational number."""
        found = self._l1("exact")
        return None if found is None else fraction(found)

    @property
    def lower(self) -> Fraction | None:
        """The gain is not below this."""
        found = self._l1("enclosure")
        return None if found is None else fraction(found[0])

    @property
    def upper(self) -> Fraction | None:
        """The gain is not above this."""
        found = self._l1("enclosure")
        return None if found is None else fraction(found[1])

    def _l1(self, key: str) -> Any:
        # The key is left out where the loop is not stable.
        return self._document.get("l1", {}).get(key)

    def __float__(self) -> float:
        return math.inf if self.decimal is None else float(self.decimal)

    def __str__(self) -> str:
        return self.text().rstrip()

    def __repr__(self) -> str:
        return f"<PeakToPeak {self.decimal}>" if self.stable else f"<PeakToPeak: the loop is {self._document['verdict']}>"
