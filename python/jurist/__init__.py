"""Exact stability limits of control loops.

For which parameter values is a loop stable, and how far is it from not being so? Answers are exact: numbers in, certified
ends out, without a tolerance in between.

>>> import jurist
>>> jurist.Loop.drive().intervals("K_pwm")
<StableSet K_pwm: (0.0381005333483, 550.941166687)>
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _jurist
from ._answers import (
    Analysis,
    Condition,
    Document,
    PointVerdict,
    Proved,
    Table,
    Verdict,
)
from ._builder import LoopBuilder
from ._check import verify
from ._curves import Body, Locus, Map, Simulation
from ._ends import Cause, End, Interval
from ._errors import (
    CertificateRejected,
    Diagnostic,
    InternalError,
    JuristError,
    JuristWarning,
    Label,
    ModelError,
    QuestionError,
    Undecided,
)
from ._exact import exact
from ._loop import Loop
from ._polynomial import Polynomial
from ._question import Parameter
from ._real import Real
from ._sets import StableSet

if TYPE_CHECKING:
    from ._control import from_control, margins
    from ._margins import (
        At,
        DelayMargin,
        DiskMargin,
        GainCrossing,
        LeastMargin,
        LeastMargins,
        Margins,
        Norm,
        Peak,
        PeakToPeak,
        PhaseCrossing,
        PhaseMargin,
    )
    from ._report import Report
    from ._response import Bode, FrequencyResponse, Nyquist
    from ._roots import Root, Roots
    from ._ship import Coefficient, Fewest, NumberFormat, Required, Ship, SignalRange
    from ._tolerance import Factor, Tolerance, Worst
    from ._tune import Tune
    from ._rows import SweepResult
    from ._sweep import ray_executor, sweep, sweep_batches
    from ._sympy import from_sympy

__version__: str = _jurist.__version__

_LATER = {
    **dict.fromkeys(("At", "DelayMargin", "DiskMargin", "GainCrossing", "Margins", "Norm"), "_margins"),
    **dict.fromkeys(("LeastMargin", "LeastMargins", "Peak", "PeakToPeak", "PhaseCrossing", "PhaseMargin"), "_margins"),
    **dict.fromkeys(("Bode", "FrequencyResponse", "Nyquist"), "_response"),
    "Report": "_report",
    **dict.fromkeys(("Root", "Roots"), "_roots"),
    **dict.fromkeys(("Coefficient", "Fewest", "NumberFormat", "Required", "Ship", "SignalRange"), "_ship"),
    **dict.fromkeys(("Factor", "Tolerance", "Worst"), "_tolerance"),
    "Tune": "_tune",
    "from_control": "_control",
    "margins": "_control",
    "from_sympy": "_sympy",
    "SweepResult": "_rows",
    "ray_executor": "_sweep",
    "sweep": "_sweep",
    "sweep_batches": "_sweep",
}

__all__ = [
    "Analysis",
    "At",
    "Bode",
    "Body",
    "Cause",
    "CertificateRejected",
    "Coefficient",
    "Condition",
    "DelayMargin",
    "Diagnostic",
    "DiskMargin",
    "Document",
    "End",
    "Factor",
    "Fewest",
    "FrequencyResponse",
    "GainCrossing",
    "InternalError",
    "Interval",
    "JuristError",
    "JuristWarning",
    "Label",
    "LeastMargin",
    "LeastMargins",
    "Locus",
    "Loop",
    "LoopBuilder",
    "Map",
    "Margins",
    "ModelError",
    "Norm",
    "NumberFormat",
    "Nyquist",
    "Parameter",
    "Peak",
    "PeakToPeak",
    "PhaseCrossing",
    "PhaseMargin",
    "PointVerdict",
    "Polynomial",
    "Proved",
    "QuestionError",
    "Real",
    "Report",
    "Required",
    "Root",
    "Roots",
    "Ship",
    "SignalRange",
    "Simulation",
    "StableSet",
    "SweepResult",
    "Table",
    "Tolerance",
    "Tune",
    "Undecided",
    "Verdict",
    "Worst",
    "exact",
    "explain",
    "from_control",
    "from_sympy",
    "margins",
    "ray_executor",
    "set_threads",
    "sweep",
    "sweep_batches",
    "threads",
    "verify",
]

for _name in __all__:
    _object = globals().get(_name)
    if isinstance(_object, type):
        # Pickles and pages name the public place.
        _object.__module__ = __name__
del _name, _object


def __getattr__(name: str) -> Any:
    """What other libraries have a part in, and what few ask for, is imported when it is first used."""
    if name in _LATER:
        import importlib

        value = getattr(importlib.import_module(f"{__name__}.{_LATER[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})


def set_threads(count: int | None) -> None:
    """How many threads answer questions; `None` for as many as there are cores.

    The answers are the same for any number. The environment variable ``JURIST_NUM_THREADS`` says it beforehand.
    """
    if count is not None and count < 1:
        raise ValueError("at least one thread")
    _jurist.set_threads(count or 0)


def threads() -> int:
    """How many threads answer questions."""
    return _jurist.threads()


def explain(code: str) -> str:
    """What an error code means, or a word of the answers.

    Examples
    --------
    >>> import jurist
    >>> jurist.explain("E-cycle").splitlines()[0][:33]
    'Constants are defined by each oth'
    >>> jurist.explain("phase margin")[:19]
    'The angle by which '
    """
    known = {**dict(_jurist.words()), **dict(_jurist.codes())}
    if code not in known:
        raise KeyError(code)
    return known[code]


if os.environ.get("JURIST_NUM_THREADS", "").isdigit():
    _jurist.set_threads(int(os.environ["JURIST_NUM_THREADS"]))
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_jurist.renew_threads)
