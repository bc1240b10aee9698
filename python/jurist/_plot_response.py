"""Pictures of the open loop over frequency, with the exact crossings on the curves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ._plot import CROSSING, axes

if TYPE_CHECKING:
    from ._margins import At
    from ._response import FrequencyResponse


def _place(response: FrequencyResponse, at: At) -> float | None:
    """Where a frequency is on the axis."""
    return at.hertz if response.hertz else at.angle


def plot_bode(response: FrequencyResponse, ax: Any, exact: bool, kw: dict[str, Any]) -> Any:
    """Modulus above, phase below."""
    import numpy

    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.gcf().subplots(2, 1, sharex=True)
    upper, lower = ax
    x = response.frequency
    decibels = 20 * numpy.log10(numpy.abs(response.response))
    (line,) = upper.semilogx(x, decibels, **kw)
    lower.semilogx(x, response.phase_degrees, **{"color": line.get_color(), **kw})
    upper.axhline(0, color="gray", linewidth=0.8)
    if exact:
        found = response.margins()
        for phase_crossing in found.phase_crossings:
            place = _place(response, phase_crossing.at)
            if place and phase_crossing.factor:
                height = -20 * math.log10(abs(phase_crossing.factor))
                upper.plot([place], [height], "o", color=CROSSING)
                upper.annotate(f"k = {phase_crossing.factor:.5g}", (place, height), (6, 6), textcoords="offset points", fontsize="small")
        for crossing in found.gain_crossings:
            place = _place(response, crossing.at)
            if place:
                # The phase as it is drawn is continued over turns.
                near = float(numpy.interp(place, x, response.phase_degrees))
                degrees = crossing.phase_margin_degrees - 180
                degrees += 360 * round((near - degrees) / 360)
                lower.plot([place], [degrees], "o", color=CROSSING)
                note = f"{crossing.phase_margin_degrees:.5g}°"
                lower.annotate(note, (place, degrees), (5, 5), textcoords="offset points", fontsize="small")
    for axis in (upper, lower):
        axis.margins(y=0.15)
        axis.grid(True, which="both", alpha=0.3)
    upper.set_ylabel("magnitude (dB)")
    lower.set_ylabel("phase (°)")
    lower.set_xlabel("frequency (Hz)" if response.hertz else "angle (rad per sample)")
    return ax


def plot_nyquist(response: FrequencyResponse, ax: Any, exact: bool, kw: dict[str, Any]) -> Any:
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
    if exact:
        found = response.margins()
        for crossing in found.gain_crossings:
            angle = math.radians(crossing.phase_margin_degrees - 180)
            marks.append(complex(math.cos(angle), math.sin(angle)))
            ax.plot([marks[-1].real], [marks[-1].imag], "o", color=CROSSING)
            note = f"{crossing.phase_margin_degrees:.5g}°"
            ax.annotate(note, (marks[-1].real, marks[-1].imag), (6, 6), textcoords="offset points", fontsize="small")
        for phase_crossing in found.phase_crossings:
            if phase_crossing.factor:
                marks.append(complex(-1 / phase_crossing.factor, 0))
                ax.plot([marks[-1].real], [0], "o", color=CROSSING)
                note = f"k = {phase_crossing.factor:.5g}"
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
    return ax
