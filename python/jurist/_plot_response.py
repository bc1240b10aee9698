"""Pictures of the open loop over frequency, with the exact crossings on the curves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ._plot import CROSSING, axes, entitled

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from ._margins import At, Margins
    from ._response import FrequencyResponse


def _place(response: FrequencyResponse, at: At) -> float | None:
    """Where a frequency is on the axis."""
    return at.hertz if response.hertz else at.angle


def _pair(ax: Axes | Sequence[Axes] | None) -> tuple[Axes, Axes]:
    """Two axes: those given, two in the place of one, or two new ones."""
    from matplotlib.axes import Axes

    if ax is None:
        import matplotlib.pyplot as plt

        upper, lower = plt.gcf().subplots(2, 1, sharex=True)
    elif isinstance(ax, Axes):
        ax.set_axis_off()
        upper, lower = ax.inset_axes((0, 0.54, 1, 0.46)), ax.inset_axes((0, 0, 1, 0.46))
    else:
        upper, lower = ax
    return upper, lower


def _named_margins(found: Margins, hertz: bool) -> str | None:
    """Gain and phase margin in words, with their frequencies."""
    if not found.stable:
        return "the closed loop is not stable"

    def at(place: At | None) -> str:
        number = None if place is None else (place.hertz if hertz else place.angle)
        return "" if number is None else f" at {number:.4g} {'Hz' if hertz else 'rad per sample'}"

    upper, phase = found.upper, found.phase
    crossing = None if upper is None else min(found.phase_crossings, key=lambda c: abs(c.factor - float(upper)), default=None)
    gain = "infinite" if upper is None else f"{20 * math.log10(float(upper)):.4g} dB{at(crossing.at if crossing else None)}"
    degrees = "any" if phase is None or phase.degrees is None else f"{phase.degrees:.4g}°{at(phase.at)}"
    return f"gain margin {gain}, phase margin {degrees}"


def _entitled(ax: Axes, response: FrequencyResponse, found: Margins | None) -> None:
    margins = None if found is None else _named_margins(found, response.hertz)
    entitled(ax, "\n".join(part for part in (response.title, margins) if part))


def _factor_named(factor: float, found: Margins) -> str:
    """The factor at a phase crossing; with its name where it is a gain margin."""
    ends = [float(end) for end in (found.upper, found.lower) if end is not None]
    is_margin = any(math.isclose(factor, end, rel_tol=1e-9) for end in ends)
    return f"{'gain margin' if is_margin else 'k ='} {factor:.5g}"


def _angle_named(degrees: float, found: Margins) -> str:
    """The angle at a gain crossing; with its name where it is the phase margin."""
    least = None if found.phase is None else found.phase.degrees
    is_margin = least is not None and math.isclose(abs(degrees), least, rel_tol=1e-9)
    return f"{'phase margin ' if is_margin else ''}{degrees:.5g}°"


def plot_bode(
    response: FrequencyResponse, ax: Axes | Sequence[Axes] | None, exact: bool, kw: dict[str, Any]
) -> tuple[Axes, Axes]:
    """Magnitude above, phase below."""
    import numpy

    upper, lower = _pair(ax)
    x = response.frequency
    decibels = 20 * numpy.log10(numpy.abs(response.response))
    (line,) = upper.semilogx(x, decibels, **kw)
    lower.semilogx(x, response.phase_degrees, **{"color": line.get_color(), **kw})
    upper.axhline(0, color="gray", linewidth=0.8)
    found = response.margins() if exact else None
    if found is not None:
        for phase_crossing in found.phase_crossings:
            place = _place(response, phase_crossing.at)
            if place and phase_crossing.factor:
                height = -20 * math.log10(abs(phase_crossing.factor))
                upper.plot([place], [height], "o", color=CROSSING)
                # In the right half of the axis the words are on the left.
                is_right = place * place > x[0] * x[-1]
                offset, side = ((-6, 6), "right") if is_right else ((6, 6), "left")
                note = _factor_named(phase_crossing.factor, found)
                upper.annotate(note, (place, height), offset, textcoords="offset points", ha=side, fontsize="small")
        for crossing in found.gain_crossings:
            place = _place(response, crossing.at)
            if place:
                # The phase as it is drawn is continued over turns.
                near = float(numpy.interp(place, x, response.phase_degrees))
                degrees = crossing.phase_margin_degrees - 180
                degrees += 360 * round((near - degrees) / 360)
                lower.plot([place], [degrees], "o", color=CROSSING)
                note = _angle_named(crossing.phase_margin_degrees, found)
                lower.annotate(note, (place, degrees), (5, 5), textcoords="offset points", fontsize="small")
    for axis in (upper, lower):
        axis.margins(y=0.15)
        axis.grid(True, which="both", alpha=0.3)
    upper.set_ylabel("magnitude (dB)")
    lower.set_ylabel("phase (°)")
    lower.set_xlabel("frequency (Hz)" if response.hertz else "angle (rad per sample)")
    _entitled(upper, response, found)
    return upper, lower


def plot_nyquist(response: FrequencyResponse, ax: Axes | None, exact: bool, kw: dict[str, Any]) -> Axes:
    """The curve, its mirror image, the unit circle and -1."""
    import numpy

    ax = axes(ax)
    curve = response.response
    (line,) = ax.plot(curve.real, curve.imag, **{"linewidth": 1.5, **kw})
    ax.plot(curve.real, -curve.imag, "--", color=line.get_color(), linewidth=1)
    turn = numpy.exp(1j * numpy.linspace(0, 2 * math.pi, 361))
    ax.plot(turn.real, turn.imag, color="gray", linewidth=0.8)
    ax.plot([-1], [0], "+", color="black", markersize=10)
    marks = [complex(-1, 0), complex(1, 1), complex(-1, -1)]
    found = response.margins() if exact else None
    if found is not None:
        for crossing in found.gain_crossings:
            angle = math.radians(crossing.phase_margin_degrees - 180)
            marks.append(complex(math.cos(angle), math.sin(angle)))
            ax.plot([marks[-1].real], [marks[-1].imag], "o", color=CROSSING)
            note = _angle_named(crossing.phase_margin_degrees, found)
            ax.annotate(note, (marks[-1].real, marks[-1].imag), (6, 6), textcoords="offset points", fontsize="small")
        for phase_crossing in found.phase_crossings:
            if phase_crossing.factor:
                marks.append(complex(-1 / phase_crossing.factor, 0))
                ax.plot([marks[-1].real], [0], "o", color=CROSSING)
                note = _factor_named(phase_crossing.factor, found)
                if "margin" not in note:
                    # Others are near zero, one above the other.
                    continue
                ax.annotate(note, (marks[-1].real, 0), (6, -12), textcoords="offset points", fontsize="small")
    # A pole on the boundary takes the curve to infinity: shown is what matters, around -1 and the crossings.
    left, right = min(z.real for z in marks), max(z.real for z in marks)
    reach = max(abs(z.imag) for z in marks)
    pad = 0.3 * max(right - left, 2 * reach)
    ax.set_xlim(left - pad, right + pad)
    ax.set_ylim(-reach - pad, reach + pad)
    ax.set_aspect("equal")
    ax.grid(True, alpha=0.3)
    ax.set_xlabel("real")
    ax.set_ylabel("imaginary")
    _entitled(ax, response, found)
    return ax
