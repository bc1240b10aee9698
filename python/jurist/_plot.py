"""Pictures by matplotlib: on the axes given or the current ones, returned, never shown."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ._exact import exact

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._curves import Locus, Map, Simulation
    from ._sets import StableSet
    from ._tolerance import Tolerance

_STABLE = "#2a7f62"
"""A green that is also told from the crossings by its lightness."""

CROSSING = "#c1440e"


def axes(ax: Axes | None) -> Axes:
    """The axes given, else the current ones."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    found: Axes = plt.gca()
    return found


def entitled(ax: Axes, title: str | None) -> None:
    """A title, unless there is one."""
    if title and not ax.get_title():
        ax.set_title(title, fontsize="medium")


def _named(name: str, unit: str | None) -> str:
    return f"{name} ({unit})" if unit else name


def _is_logarithmic(values: list[float]) -> bool:
    positive = [x for x in values if x > 0]
    return len(positive) == len(values) > 1 and max(positive) / min(positive) > 100


def plot_set(s: StableSet, ax: Axes | None, scale: str, kw: dict[str, Any]) -> Axes:
    """A stable set on a number line."""
    ax = axes(ax)
    ends = [float(end) for i in s for end in (i.lower, i.upper) if end is not None]
    nominal = [] if s.nominal is None else [float(s.nominal)]
    logarithmic = scale == "log" or (scale == "auto" and _is_logarithmic(ends + nominal))
    shown = sorted(x for x in ends + nominal if x > 0 or not logarithmic) or [1.0]
    width = shown[-1] - shown[0] or abs(shown[-1]) or 1.0
    low, high = (shown[0] / 3, shown[-1] * 3) if logarithmic else (shown[0] - width / 4, shown[-1] + width / 4)
    style = {"color": _STABLE, "linewidth": 6, "solid_capstyle": "butt", **kw}
    for k, i in enumerate(s):
        a, b = i
        ax.plot([max(a, low), min(b, high)], [0, 0], **{"label": "" if k else _goal(s), **style})
        for end in (i.lower, i.upper):
            if end is not None:
                face = style["color"] if end.closed else "none"
                ax.plot([float(end)], [0], "o", color=style["color"], markerfacecolor=face, markersize=8)
                note = f"{float(end):.6g}" + (f"\n{str(end.cause).replace('+', ', ')}" if end.cause else "")
                ax.annotate(note, (float(end), 0), (0, 9), textcoords="offset points", ha="center", fontsize="small")
    for x in nominal:
        ax.plot([x], [0], "^", color="gray", label=f"nominal {x:g}")
    if s or nominal:
        ax.legend(loc="lower right", fontsize="small")
    entitled(ax, s.title)
    if logarithmic:
        ax.set_xscale("log")
    ax.set_xlim(low, high)
    ax.set_ylim(-1, 1)
    ax.set_yticks([])
    ax.set_xlabel(_named(s.parameter, s.unit))
    return ax


def _goal(answer: Any) -> str:
    """What is drawn: where the loop is stable, and meets what is required."""
    words = [w[2:].partition("=") for w in getattr(answer, "_words", None) or () if w.startswith("--") and "=" in w]
    asked = [f"{name.replace('-', ' ')} {value}" for name, _, value in words if name not in ("at", "digits", "undecided")]
    return ", ".join(["stable", *asked])


def plot_map(m: Map, ax: Axes | None, x: Any, y: Any, columns: int, kw: dict[str, Any]) -> Axes:
    """A map: boxes as they were proved, or an exact one column by column."""
    ax = axes(ax)
    document = m.to_dict()
    required = document.get("required") if not m.is_exact else None
    label = "stable" if required else _goal(m)
    style = {"facecolor": _STABLE, "edgecolor": "none", "alpha": 0.55, "label": label, **kw}
    if m.is_exact:
        _exact_map(m, ax, x, y, columns, style)
    else:
        _boxes(m, ax, style)
        if required:
            met = [b for b in required["boxes"] if b["met"]]
            _rectangles(ax, met, {"antialiased": False, **style, "label": _goal(m), "alpha": 1.0, **kw})
            open_ = [b for b in required["boxes"] if b["met"] is None]
            _rectangles(ax, open_, {**_UNDECIDED, "label": ""})
    nominal = document["nominal"]
    if nominal["x"] is not None and nominal["y"] is not None:
        place = [float(exact(nominal[side])) for side in ("x", "y")]
        ax.plot(place[:1], place[1:], "o", color="black", markersize=5, label="nominal")
    ax.set_xlabel(_named(m.x, document["unit"]["x"]))
    ax.set_ylabel(_named(m.y, document["unit"]["y"]))
    ax.legend(fontsize="small")
    entitled(ax, m.title)
    return ax


# Neighbours share an edge, which two smoothed ones would show.
_UNDECIDED = {"antialiased": False, "facecolor": "gray", "edgecolor": "none", "alpha": 0.4, "label": "undecided"}


def _rectangles(ax: Axes, boxes: list[dict[str, Any]], looks: dict[str, Any]) -> None:
    """Boxes as they stand in a document; one of them has the label."""
    from matplotlib.patches import Rectangle

    for k, box in enumerate(boxes):
        (x0, x1), (y0, y1) = ([float(exact(b)) for b in box[side]] for side in ("x", "y"))
        ax.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, **(looks if not k else {**looks, "label": ""})))


def _boxes(m: Map, ax: Axes, style: dict[str, Any]) -> None:
    for verdict, looks in {"stable": {"antialiased": False, **style}, "undecided": _UNDECIDED}.items():
        _rectangles(ax, [b for b in m.boxes if b["verdict"] == verdict], looks)
    window = m.to_dict()["window"]
    ax.set_xlim(*(float(exact(b)) for b in window["x"]))
    ax.set_ylim(*(float(exact(b)) for b in window["y"]))


def _exact_map(m: Map, ax: Axes, x: Any, y: Any, columns: int, style: dict[str, Any]) -> None:
    import numpy
    from matplotlib.collections import PolyCollection

    loop = m._loop
    assert loop is not None
    document = m.to_dict()
    asked = {name: value for name, value in m.point.items()}
    region = loop._region_by(m._words)
    limits = _limits(m, asked, region)
    low, high = _window(document, "x", x, limits["x"])
    logarithmic = low > 0 and high / low > 100
    places = numpy.geomspace(low, high, columns) if logarithmic else numpy.linspace(low, high, columns)
    inner = [0.5 * (a + b) for a, b in zip(places[:-1], places[1:], strict=True)]
    sets = [[tuple(i) for i in loop.intervals(m.y, {**asked, m.x: float(at)}, **region)] for at in inner]
    bottom, top = _window(document, "y", y, limits["y"])
    held = [[(min(max(a, bottom), top), min(max(b, bottom), top)) for a, b in found] for found in sets]
    ax.add_collection(PolyCollection(_bands(inner, held), **style))
    if logarithmic:
        ax.set_xscale("log")
    if bottom > 0 and top / bottom > 100:
        ax.set_yscale("log")
    ax.set_xlim(low, high)
    ax.set_ylim(bottom, top)


def _limits(m: Map, asked: dict[str, Any], region: dict[str, Any]) -> dict[str, list[float]]:
    """The limits of either parameter, the other one being nominal: a window that does not show them hides what is nearest."""
    assert m._loop is not None
    nominal = m.to_dict()["nominal"]
    found: dict[str, list[float]] = {"x": [], "y": []}
    for side, name, other, at in (("x", m.x, m.y, nominal["y"]), ("y", m.y, m.x, nominal["x"])):
        if at is not None:
            ends = [end for i in m._loop.intervals(name, {**asked, other: at}, **region) for end in (i.lower, i.upper)]
            found[side] = [float(end) for end in ends if end is not None]
    return found


def _bands(places: list[float], held: list[list[tuple[float, float]]]) -> list[list[tuple[float, float]]]:
    """Outlines of what columns hold: intervals go on as long as there are as many of them, and end half way where there are not."""
    out: list[list[tuple[float, float]]] = []
    open_bands: list[list[tuple[float, float, float]]] = []

    def close() -> None:
        for band in open_bands:
            out.append([(x, a) for x, a, _ in band] + [(x, b) for x, _, b in reversed(band)])

    for k, (at, found) in enumerate(zip(places, held, strict=True)):
        if k == 0 or len(found) != len(held[k - 1]):
            middle = at if k == 0 else 0.5 * (places[k - 1] + at)
            for band in open_bands:
                band.append((middle, *band[-1][1:]))
            close()
            open_bands = [[(middle, a, b)] for a, b in found]
        for band, (a, b) in zip(open_bands, found, strict=True):
            band.append((at, a, b))
    close()
    return out


def _window(document: dict[str, Any], axis: str, given: Any, limits: list[float]) -> tuple[float, float]:
    """Around the stable regions, the limits and the nominal point."""
    if given is not None:
        return float(exact(given[0])), float(exact(given[1]))
    values = list(limits)
    for region in document["regions"]:
        for end in region[axis].values():
            if end is not None:
                values.append(float(end["decimal"]))
    if document["nominal"][axis] is not None:
        values.append(float(exact(document["nominal"][axis])))
    domain = [None if b is None else float(exact(b)) for b in document["domain"][axis].values()]
    if not values:
        values = [x for x in domain if x is not None] or [0.0]
    if _is_logarithmic(values):
        lower, upper = min(values) / 2, 2 * max(values)
        inside = 0.0
    else:
        low, high = min(values), max(values)
        pad = (high - low) / 8 or abs(high) or 1.0
        inside = pad / 1000
        lower, upper = low - pad, high + pad
    if domain[0] is not None:
        lower = max(lower, domain[0] + inside)
    if domain[1] is not None:
        upper = min(upper, domain[1] - inside)
    return lower, upper


def plot_locus(locus: Locus, ax: Axes | None, grid: bool, kw: dict[str, Any]) -> Axes:
    """Branches, thin outside of the range, the boundary, poles and zeros, and the crossings."""
    import numpy

    ax = axes(ax)
    document = locus.to_dict()
    if document["time"] == "discrete":
        turn = numpy.exp(1j * numpy.linspace(0, 2 * math.pi, 361))
        ax.plot(turn.real, turn.imag, color="gray", linewidth=0.8, label="unit circle")
        ax.set_aspect("equal", "datalim")
    else:
        ax.axvline(0, color="gray", linewidth=0.8, label="imaginary axis")
    colours = []
    for _, roots in locus.branches:
        (line,) = ax.plot(roots.real, roots.imag, **{"linewidth": 1.5, **kw})
        colours.append(line.get_color())
    for k, (_, roots) in enumerate(locus.beyond):
        ax.plot(roots.real, roots.imag, **{"color": colours[k % len(colours)], **kw, "linewidth": 0.7})
    for name, marker, points in (("poles", "x", locus.poles), ("zeros", "o", locus.zeros)):
        if points is not None and len(points):
            label = f"{name} of the open loop"
            ax.plot(points.real, points.imag, marker, color="black", markersize=7, fillstyle="none", label=label)
    label = "crossing, exact"
    for crossing in locus.crossings:
        for re, im in crossing["at"]:
            signs = (1, -1) if im else (1,)
            ax.plot([re] * len(signs), [s * im for s in signs], "o", color=CROSSING, markersize=6, label=label)
            label = ""
        if crossing["at"]:
            is_right = crossing["at"][0][0] > 0
            offset, side = ((-7, 7), "right") if is_right else ((7, 7), "left")
            # Lines go on behind the words.
            plate = {"boxstyle": "square,pad=0.1", "facecolor": ax.get_facecolor(), "edgecolor": "none", "alpha": 0.85}
            ax.annotate(crossing["label"], crossing["at"][0], offset, textcoords="offset points", ha=side, fontsize="small", bbox=plate)
    _around(ax, locus)
    ax.grid(grid, alpha=0.3)
    ax.set_xlabel("real")
    ax.set_ylabel("imaginary")
    ax.legend(fontsize="small")
    entitled(ax, f"{locus.title}: root locus of {document['parameter']}" if locus.title else f"root locus of {document['parameter']}")
    return ax


def _around(ax: Axes, locus: Locus) -> None:
    """The window: poles, zeros and crossings well inside, and what is not too far from them of the branches."""
    import numpy

    points = [complex(re, im) for c in locus.crossings for re, im in c["at"]]
    scale = max((abs(z) for z in points), default=0.0)
    for found in (locus.poles, locus.zeros):
        points.extend(z for z in (() if found is None else found) if not scale or abs(z) <= 8 * scale)
    reach = max((abs(z) for z in points), default=0.0)
    if not reach:
        return
    if locus.to_dict()["time"] == "discrete":
        reach = max(reach, 1.0)
        points.extend((complex(-1, 1), complex(1, -1)))
    points.append(0j)
    left, right, top = min(z.real for z in points), max(z.real for z in points), max(abs(z.imag) for z in points)
    room = 0.25 * max(right - left, 2 * top)
    left, right, top = left - room, right + room, top + room
    for _, roots in locus.branches:
        shown = roots[numpy.abs(roots) <= (1.6 if locus.to_dict()["time"] == "discrete" else 3.3) * reach]
        if len(shown):
            left, right = min(left, shown.real.min()), max(right, shown.real.max())
            top = max(top, numpy.abs(shown.imag).max())
    ax.set_xlim(left, right)
    ax.set_ylim(-top, top)


def plot_simulation(r: Simulation, ax: Axes | None, signals: list[str] | None, kw: dict[str, Any]) -> Axes:
    """Signals over time, sampled ones in stairs: without a word the outputs, beside which states may be large."""
    ax = axes(ax)
    if signals is None:
        outputs = () if r._loop is None else r._loop.outputs
        signals = [name for name in r.names if name in outputs] or r.names
    for name in signals:
        style = {"drawstyle": "steps-post", **kw} if r.is_sampled(name) else kw
        ax.plot(r.time, r[name], label=_named(name, r.unit(name)), **style)
    ax.set_xlabel("time (s)" if r.to_dict()["time_unit"] == "s" else "samples")
    ax.legend()
    entitled(ax, r.title)
    return ax


def plot_shares(t: Tolerance, ax: Axes | None, kw: dict[str, Any]) -> Axes:
    """How much of the margin each tolerance uses, the largest above."""
    ax = axes(ax)
    shares = sorted(t.shares.items(), key=lambda item: item[1])
    bars = ax.barh([name for name, _ in shares], [share for _, share in shares], **{"color": _STABLE, **kw})
    worst = t.worst
    if worst is not None:
        ax.bar_label(bars, [f"{share:.1%} {worst.signs.get(name, '')}" for name, share in shares], padding=3, fontsize="small")
    ax.set_xlim(0, 1.15 * max([share for _, share in shares], default=1.0))
    ax.set_xlabel("share of the margin" + ("" if t.factor is None else f"; stable up to {float(t.factor.lower):.5g} times the tolerances"))
    entitled(ax, t.title)
    return ax
