"""What a question takes besides its own arguments."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple, TypedDict

from ._errors import JuristWarning
from ._exact import Exact, text_of
from ._requirements import Requiring

Bounds = tuple["Exact | None", "Exact | None"]
"""An open interval; `None` is no bound."""

Listener = Callable[[str, "float | None"], None]
"""Told the name of a step and the share done."""


class Waiting(TypedDict, total=False):
    """Values, how long a question may take, who is told how far it is, and how many digits decimals have."""

    set: Mapping[str, Exact] | None
    timeout: float | None
    progress: Listener | bool
    digits: int


class Asking(Waiting, Requiring, total=False):
    """What a question of stability takes besides its own arguments, and a keyword for each requirement."""

    radius: Exact | None
    decay: Exact | None
    at: str | None


class AskingWithin(Asking, total=False):
    """The same, where the domains of several parameters matter."""

    domain: Mapping[str, Bounds] | None


class Parameter(NamedTuple):
    """A parameter of a model: `None` where the model says nothing."""

    name: str
    nominal: Fraction | None
    min: Fraction | None
    max: Fraction | None
    unit: str | None
    description: str | None
    formula: str | None = None
    """The nominal value as it is written, where that is a formula."""
    closed: bool = False
    """Whether `min` and `max` themselves belong to the domain."""


def bound(x: Exact | None) -> str | None:
    return None if x is None else text_of(x)


def requirement_text(x: Exact) -> str:
    """A requirement as the program reads it: texts may have a unit."""
    return x if isinstance(x, str) else text_of(x)


def number_text(text: str) -> str:
    return text_of(text.replace("_", ""))


def plain(content: Any) -> Any:
    if isinstance(content, dict):
        return {key: plain(value) for key, value in content.items()}
    if isinstance(content, list):
        return [plain(value) for value in content]
    return content if isinstance(content, (str, bool)) else str(content)


def warn(remarks: Sequence[tuple[str, str]]) -> None:
    for code, text in remarks:
        warnings.warn(JuristWarning(text, code), stacklevel=4)


def listener(progress: Listener | bool | None) -> Listener | None:
    if progress is True:
        return lambda step, share: print(f"jurist: {step}{'' if share is None else f' {share:.0%}'}", file=sys.stderr)
    return None if progress is False or progress is None else progress
