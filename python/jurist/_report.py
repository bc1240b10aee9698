"""The page about a loop."""

from __future__ import annotations

import html as escaping
import os
from pathlib import Path
from typing import Any


class Report:
    """One page about a loop, as the program writes it: verdict, limits and causes, margins, what moves them, figures.

    In a notebook it shows itself in a frame, so that its style stays inside.

    Examples
    --------
    >>> import jurist
    >>> page = jurist.Loop.drive().report()
    >>> page
    <Report of 'PWM DC motor drive (Gürbüz and Akpınar 2002)'>
    >>> page.html.startswith("<!DOCTYPE html>")
    True
    """

    __slots__ = ("_html", "_title")

    def __init__(self, html: str, title: str) -> None:
        self._html, self._title = html, title

    @property
    def html(self) -> str:
        """The page; it needs no other file."""
        return self._html

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the page, and gives its path."""
        place = Path(path)
        place.write_text(self._html, encoding="utf-8")
        return place

    def __eq__(self, other: object) -> bool:
        return self._html == other._html if isinstance(other, Report) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._html)

    def __reduce__(self) -> tuple[Any, ...]:
        return Report, (self._html, self._title)

    def __repr__(self) -> str:
        return f"<Report of {self._title!r}>"

    def _repr_html_(self) -> str:
        title = escaping.escape(self._title, quote=True)
        page = escaping.escape(self._html, quote=True)
        return f'<iframe title="report of {title}" sandbox srcdoc="{page}" width="100%" height="640"></iframe>'
