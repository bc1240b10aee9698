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


_MOST_NOTES = 4
"""More words than these hide each other: then only margins have some."""


def _noted(notes: list[tuple[float, float, str]]) -> list[tuple[float, float, str]]:
    """The notes that are written: all where they are few, else those that are margins."""
    return notes if len(notes) <= _MOST_NOTES else [note for note in notes if "margin" in note[2]][:_MOST_NOTES]


def _annotate(ax: Axes, notes: list[tuple[float, float, str]], low: float, high: float, is_logarithmic: bool = True) -> None:
    """Words beside points, towards the middle of the axis; those of neighbours one above and one below."""
    last, is_above = None, True
    for x, y, note in sorted(notes):
        share = math.log(x / low) / math.log(high / low) if is_logarithmic else (x - low) / (high - low)
        is_above = not is_above if last is not None and share - last < 0.3 else True
        last = share
        offset = (-7 if share > 0.5 else 7, 7 if is_above else -13)
        side = "right" if share > 0.5 else "left"
        # Lines go on behind the words.
        plate = {"boxstyle": "square,pad=0.1", "facecolor": ax.get_facecolor(), "edgecolor": "none", "alpha": 0.85}
        ax.annotate(note, (x, y), offset, textcoords="offset points", ha=side, fontsize="small", bbox=plate)


def plot_bode(
    response: FrequencyResponse, ax: Axes | Sequence[Axes] | None, exact: bool, kw: dict[str, Any]
) -> tuple[Axes, Axes]:
    """Magnitude above, phase below; the crossings of both lines in both."""
    import numpy
    from matplotlib.ticker import MultipleLocator

    upper, lower = _pair(ax)
    x = response.frequency
    decibels = 20 * numpy.log10(numpy.abs(response.response))
    above = x > 0
    (line,) = upper.semilogx(x[above], decibels[above], **kw)
    lower.semilogx(x[above], response.phase_degrees[above], **{"color": line.get_color(), **kw})
    if not above.all():
        # Of a loop with complex coefficients negative frequencies are no mirror image.
        dashed = {"color": line.get_color(), **kw, "linestyle": "--", "label": "negative frequencies"}
        upper.semilogx(-x[~above], decibels[~above], **dashed)
        lower.semilogx(-x[~above], response.phase_degrees[~above], **dashed)
        upper.legend()
    upper.axhline(0, color="gray", linewidth=0.8)
    found = response.margins() if exact else None
    levels = set()
    if found is not None:
        notes = []
        for phase_crossing in found.phase_crossings:
            place = _place(response, phase_crossing.at)
            if place and phase_crossing.factor:
                notes.append((abs(place), -20 * math.log10(abs(phase_crossing.factor)), _factor_named(phase_crossing.factor, found)))
        angles = []
        for crossing in found.gain_crossings:
            place = _place(response, crossing.at)
            if place:
                # The phase as it is drawn is continued over turns.
                half = above if place > 0 else ~above
                near = float(numpy.interp(place, x[half], response.phase_degrees[half]))
                degrees = crossing.phase_margin_degrees - 180
                degrees += 360 * round((near - degrees) / 360)
                levels.add(360 * round((degrees + 180) / 360) - 180)
                angles.append((abs(place), degrees, _angle_named(crossing.phase_margin_degrees, found)))
        for axis, list_ in ((upper, notes), (lower, angles)):
            axis.plot([n[0] for n in list_], [n[1] for n in list_], "o", color=CROSSING)
            _annotate(axis, _noted(list_), float(numpy.abs(x).min()), float(numpy.abs(x).max()))
            for place, _, _ in (*_noted(notes), *_noted(angles)):
                axis.axvline(place, color="gray", linewidth=0.8, linestyle="--")
    low, high = float(numpy.min(response.phase_degrees)), float(numpy.max(response.phase_degrees))
    highest = 360 * math.floor((high + 180) / 360) - 180
    for level in levels or ({highest} if low <= highest <= high else set()):
        lower.axhline(level, color="gray", linewidth=0.8)
        low, high = min(low, level), max(high, level)
    span = high - low
    lower.yaxis.set_major_locator(MultipleLocator(next((s for s in (5, 10, 15, 30, 45, 90, 180) if span <= 7 * s), 360)))
    for axis in (upper, lower):
        axis.margins(y=0.15)
        axis.grid(True, which="both", alpha=0.3)
    upper.set_ylabel("magnitude (dB)")
    lower.set_ylabel("phase (°)")
    lower.set_xlabel("frequency (Hz)" if response.hertz else "angle (rad per sample)")
    _entitled(upper, response, found)
    return upper, lower


_WHOLE, _PART, _FARTHEST = 5.0, 2.4, 8.0
"""A curve that stays so near to 0 is shown whole, of another this part; crossings of the real axis farther away are not shown."""


def _nyquist_window(curve: Any, marks: list[complex]) -> tuple[float, float, float]:
    """Left, right and upper end: around the unit circle and -1, the crossings, and the part of the curve near to them."""
    import numpy

    sizes = numpy.abs(curve)
    shown = curve[sizes <= (_WHOLE if sizes.max(initial=0) <= _WHOLE else _PART)]
    points = [*shown, *(z for z in marks if abs(z) <= _FARTHEST), complex(-1, 1), complex(1, -1)]
    left, right = min(z.real for z in points), max(z.real for z in points)
    half = 1.15 * max((right - left) / 2, max(abs(z.imag) for z in points))
    middle = (left + right) / 2
    return middle - half, middle + half, half


def _arrows(ax: Axes, curve: Any, color: Any, window: tuple[float, float, float]) -> None:
    """Heads along the part of the curve that is shown."""
    import numpy

    left, right, top = window
    inside = (curve.real > left) & (curve.real < right) & (numpy.abs(curve.imag) < top)
    steps = numpy.where(inside[1:] & inside[:-1], numpy.abs(numpy.diff(curve)), 0.0)
    passed = numpy.cumsum(steps)
    if not len(passed) or passed[-1] < 0.1 * top:
        return
    for share in (0.25, 0.75) if passed[-1] > top else (0.5,):
        k = int(numpy.searchsorted(passed, share * passed[-1]))
        a, b = curve[k], curve[k + 1]
        if a != b:
            tip = a + (b - a) / abs(b - a) * 0.02 * top
            ax.annotate("", (tip.real, tip.imag), (a.real, a.imag), arrowprops={"arrowstyle": "-|>", "color": color, "shrinkA": 0, "shrinkB": 0})


def plot_nyquist(response: FrequencyResponse, ax: Axes | None, exact: bool, kw: dict[str, Any]) -> Axes:
    """The curve towards higher frequencies, that of negative ones dashed, the unit circle and -1."""
    import numpy

    ax = axes(ax)
    whole, above = response.response, response.frequency > 0
    curve = whole[above]
    # Of a loop with real coefficients that is the mirror image.
    negative = numpy.conj(curve[::-1]) if above.all() else whole[~above]
    (line,) = ax.plot(curve.real, curve.imag, **{"linewidth": 1.5, **kw})
    ax.plot(negative.real, negative.imag, "--", color=line.get_color(), linewidth=1, alpha=0.6)
    turn = numpy.exp(1j * numpy.linspace(0, 2 * math.pi, 361))
    ax.plot(turn.real, turn.imag, color="gray", linewidth=0.8, linestyle=":")
    ax.plot([-1], [0], "+", color="black", markersize=10)
    found = response.margins() if exact else None
    marks, notes = [], []
    if found is not None:
        for crossing in found.gain_crossings:
            angle = math.radians(crossing.phase_margin_degrees - 180)
            marks.append(complex(math.cos(angle), math.sin(angle)))
            notes.append((marks[-1].real, marks[-1].imag, _angle_named(crossing.phase_margin_degrees, found)))
        for phase_crossing in found.phase_crossings:
            if phase_crossing.factor:
                note = _factor_named(phase_crossing.factor, found)
                is_margin = "margin" in note
                # Others are near zero, one above the other.
                ax.plot([-1 / phase_crossing.factor], [0], "o", color=CROSSING)
                if is_margin:
                    marks.append(complex(-1 / phase_crossing.factor, 0))
                    notes.append((marks[-1].real, 0.0, note))
    window = _nyquist_window(numpy.concatenate((negative, curve)), marks)
    left, right, top = window
    inside = [note for note in _noted(notes) if left < note[0] < right]
    ax.plot([n[0] for n in notes], [n[1] for n in notes], "o", color=CROSSING)
    _annotate(ax, inside, left, right, is_logarithmic=False)
    _arrows(ax, curve, line.get_color(), window)
    _arrows(ax, negative, line.get_color(), window)
    ax.set_xlim(left, right)
    ax.set_ylim(-top, top)
    ax.set_aspect("equal")
    ax.grid(True, alpha=0.3)
    ax.set_xlabel("real")
    ax.set_ylabel("imaginary")
    _entitled(ax, response, found)
    return ax
