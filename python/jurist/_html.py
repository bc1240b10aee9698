"""Answers in notebooks: tables and inline drawings in the page's own colour, without a style element."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._sets import StableSet

_CELL = 'style="text-align:left;padding:2px 10px"'


def escaped(text: object) -> str:
    """Text for a page."""
    return html.escape(str(text))


def table(head: list[str], rows: list[list[Any]]) -> str:
    """A table."""
    top = "".join(f"<th {_CELL}>{escaped(name)}</th>" for name in head)
    body = "".join("<tr>" + "".join(f"<td {_CELL}>{escaped(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def _place(x: float, low: float, high: float, logarithmic: bool) -> float:
    if logarithmic:
        x, low, high = math.log(x), math.log(low), math.log(high)
    return 30 + 540 * (x - low) / (high - low) if high > low else 300


def number_line(s: StableSet) -> str:
    """The set as a drawing."""
    ends = sorted({float(end) for i in s for end in (i.lower, i.upper) if end is not None})
    ends = [x for x in ends if math.isfinite(x)]
    nominal = [float(s.nominal)] if s.nominal is not None else []
    shown = sorted(ends + nominal) or [0.0]
    logarithmic = shown[0] > 0 and shown[-1] / shown[0] > 100
    width = shown[-1] - shown[0] or abs(shown[0]) or 1.0
    low, high = (shown[0] / 3, shown[-1] * 3) if logarithmic else (shown[0] - width / 4, shown[-1] + width / 4)

    def at(x: float) -> float:
        return _place(min(max(x, low), high), low, high, logarithmic)

    parts = ['<line x1="10" y1="20" x2="590" y2="20" stroke="currentColor" stroke-opacity="0.4"/>']
    for i in s:
        a, b = i
        x1, x2 = (at(a) if a > low else 10.0), (at(b) if b < high else 590.0)
        parts.append(f'<line x1="{x1:.1f}" y1="20" x2="{x2:.1f}" y2="20" stroke="currentColor" stroke-width="6"/>')
        for end, x in ((i.lower, x1), (i.upper, x2)):
            if end is not None:
                fill = "currentColor" if end.closed else "none"
                parts.append(f'<circle cx="{x:.1f}" cy="20" r="5" stroke="currentColor" stroke-width="2" fill="{fill}"/>')
                parts.append(
                    f'<text x="{x:.1f}" y="42" text-anchor="middle" font-size="12" fill="currentColor">{float(end):.5g}</text>'
                )
    for x in nominal:
        parts.append(f'<path d="M{at(x):.1f} 13 l-4 -8 h8 z" fill="currentColor"><title>nominal {x:g}</title></path>')
    label = escaped(f"stable values of {s.parameter}: {s}")
    return f'<svg width="600" height="50" viewBox="0 0 600 50" role="img" aria-label="{label}">{"".join(parts)}</svg>'


def set_html(s: StableSet) -> str:
    """A stable set: its drawing and its ends."""
    unit = f" ({s.unit})" if s.unit else ""
    rows: list[list[Any]] = []
    for i in s:
        for side, end in (("from", i.lower), ("to", i.upper)):
            if end is None:
                rows.append([side, "-∞" if side == "from" else "∞", "", ""])
            else:
                hertz = "" if end.frequency_hz is None else f"{end.frequency_hz:.6g} Hz"
                rows.append([side, end, end.cause, hertz])
    if not rows:
        return f"<div><b>{escaped(s.parameter)}{escaped(unit)}</b>: never stable</div>"
    head = [f"{s.parameter}{unit}", "value", "cause", "frequency"]
    return f"<div>{number_line(s)}{table(head, rows)}</div>"
