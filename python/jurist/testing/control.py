"""python-control's own tests with this package's answers in place of its own: a plugin of pytest.

    pytest -p jurist.testing.control --pyargs control.tests.margin_test

What is replaced: margins and phase crossovers, poles of systems (roots of the exact polynomial, by python-flint), closed loops of transfer
functions, the count of unstable closed-loop roots. A test in which none of that is asked for is not applicable and skipped. Where the answers
differ, `DEVIATIONS` says why.
"""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import pytest

import jurist
from jurist import JuristWarning

from .deviations import DEVIATIONS

MODULES = tuple(f"control.tests.{name}_test" for name in ("margin", "nyquist", "rlocus", "discrete", "delay", "bdalg", "statefbk"))
"""The modules whose tests are run."""

_asked: list[str] = []
"""Which of our answers the test that runs has asked for."""


def _quietly(ask: Callable[[], Any]) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", JuristWarning)
        return ask()


def _is_ours(system: Any) -> bool:
    """Whether it is a system with one input and one output of which the model is known."""
    import control

    known = isinstance(system, (control.TransferFunction, control.StateSpace))
    return known and (system.ninputs, system.noutputs) == (1, 1)


def _replacing(theirs: Callable[..., Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Ours for systems that are ours, theirs for others."""

    def decorate(ours: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(theirs)
        def asked(system: Any, *arguments: Any, **keys: Any) -> Any:
            found = _quietly(lambda: ours(system, *arguments, **keys)) if _is_ours(system) else NotImplemented
            if found is NotImplemented:
                return theirs(system, *arguments, **keys)
            _asked.append(theirs.__name__)
            return found

        return asked

    return decorate


def _loop(system: Any, gain: str | None = None) -> jurist.Loop:
    return jurist.from_control(system, gain=gain, floats="binary", time="continuous" if system.dt is None else None)


def closed_loop_roots_not_inside(system: Any) -> int:
    """How many roots of the loop closed around a system are on the boundary or outside: ``_Z`` of the Nyquist tests."""
    found = _loop(system, "k").verdict()
    return sum(count or 0 for count in (found.on, found.outside, found.infinite))


def poles(system: Any) -> Any:
    """The roots of the exact characteristic polynomial, each as often as it is one."""
    import flint
    import numpy

    found = _loop(system).charpoly().coefficients() if _order(system) else []
    coefficients = [n.get((), Fraction(0)) / d[()] for n, d in found] or [Fraction(1)]
    common = math.lcm(*(c.denominator for c in coefficients))
    polynomial = flint.fmpz_poly([int(c * common) for c in coefficients])
    roots = [root for root, count in polynomial.complex_roots() for _ in range(count)]
    return numpy.array([complex(float(r.real.mid()), float(r.imag.mid())) for r in roots])


def _order(system: Any) -> int:
    return len(system.A) if hasattr(system, "A") else len(system.den[0][0]) - 1


def margins(system: Any, returnall: bool = False, epsw: float = 0.0, method: str = "best") -> Any:
    """What ``stability_margins`` gives, from the exact crossings: stable or not, the nearest of each kind."""
    import numpy

    found = jurist.margins(system, floats="binary")
    phase = [c for c in found.phase_crossings if c.factor > 0 and _omega(c.at, system) is not None]
    gain = [c for c in found.gain_crossings if _omega(c.at, system) is not None]
    gm, wpc = [c.factor for c in phase], [_omega(c.at, system) for c in phase]
    pm, wgc = [c.phase_margin_degrees for c in gain], [_omega(c.at, system) for c in gain]
    modulus = found.modulus
    sm, wms = ([float(modulus.value)], [_omega(modulus.at, system)]) if modulus and modulus.attained else ([], [])
    if returnall:
        return tuple(numpy.array(column, dtype=float) for column in (gm, pm, sm, wpc, wgc, wms))

    def nearest(values: list[float], at: list[Any], distance: Callable[[float], float]) -> tuple[float, float]:
        best = min(range(len(values)), key=lambda i: distance(values[i]), default=None)
        return (math.inf, math.nan) if best is None else (values[best], at[best])

    (g, wg), (p, wp), (s, ws) = nearest(gm, wpc, lambda x: abs(math.log(x))), nearest(pm, wgc, abs), nearest(sm, wms, abs)
    return g, p, s, wg, wp, ws


def _omega(at: Any, system: Any) -> float | None:
    """In radians per unit of time; the ends of the range have no pair."""
    if at.omega is not None:
        return float(at.omega)
    return float(at.angle) if at.angle is not None and system.dt is True else None


def margin(system: Any) -> Any:
    """What ``margin`` gives."""
    g, p, _, wg, wp, _ = margins(system)
    return g, p, wg, wp


def disk_margins(system: Any, omega: Any, skew: float = 0.0, returnall: bool = False) -> Any:
    """What ``disk_margins`` gives: the size of the disk, its gain in decibels, its phase."""
    if returnall:
        return NotImplemented
    loop = _loop(system, "k")
    disk = loop.margins("k", skew=jurist.exact(float(skew))).disk
    if disk is None or disk.alpha is None:
        return NotImplemented
    return float(disk.alpha), 20 * math.log10(disk.gain[1]), disk.phase_degrees


def feedback(first: Any, second: Any = 1, sign: Any = -1, **names: Any) -> Any:
    """The closed loop of two transfer functions, or of one and a number, connected as blocks of a model."""
    import control

    both = (first, second)
    if names or not all(isinstance(s, (int, float, control.TransferFunction)) for s in both):
        return NotImplemented
    systems = [s for s in both if isinstance(s, control.TransferFunction)]
    times = {s.dt for s in systems}
    if len(times) != 1 or not all(_is_ours(s) for s in systems) or times & {None, True}:
        return NotImplemented
    dt = times.pop()
    builder = jurist.LoopBuilder("continuous" if dt == 0 else "discrete", sample_time=dt or None, floats="binary")
    builder.block("first", f"r {'+' if sign > 0 else '-'} b", "y", first).block("second", "y", "b", second)
    return builder.build(inputs=["r"], outputs=["y"]).to_control("r", "y")


def _replacements() -> Iterator[tuple[Any, str, Any]]:
    """Objects, their attributes, and what stands in."""
    import importlib

    import control

    kinds: list[Any] = [control.TransferFunction, control.StateSpace]
    for kind in kinds:
        yield kind, "poles", _replacing(kind.poles)(poles)
    module = {name.rpartition(".")[2]: importlib.import_module(name) for name in MODULES}
    yield module["nyquist_test"], "_Z", _replacing(module["nyquist_test"]._Z)(closed_loop_roots_not_inside)
    ours: dict[str, Callable[..., Any]] = {"stability_margins": margins, "margin": margin, "disk_margins": disk_margins}
    for name, function in ours.items():
        yield module["margin_test"], name, _replacing(getattr(control, name))(function)
    theirs: Callable[..., Any] = control.feedback
    closed = _replacing(theirs)(feedback)
    for name in ("rlocus_test", "discrete_test", "bdalg_test"):
        yield module[name], "feedback", closed


def _is_outside(item: Any) -> bool:
    return getattr(item, "module", None) is not None and item.module.__name__ in MODULES


def _name(item: Any) -> str:
    """The module and the test, wherever the tests are run."""
    return f"{item.module.__name__.rpartition('.')[2]}::{item.nodeid.partition('::')[2]}"


def pytest_configure(config: Any) -> None:
    """Marks that those tests use without their own plugins."""
    config.addinivalue_line("markers", "timeout: the time that a test may take")


def pytest_collection_modifyitems(items: list[Any]) -> None:
    """Marks what is known to differ."""
    for item in filter(_is_outside, items):
        reason = DEVIATIONS.get(_name(item))
        if reason is not None:
            item.add_marker(pytest.mark.xfail(reason=reason, strict=True))


@pytest.fixture(autouse=True)
def _our_answers(request: Any, monkeypatch: Any) -> None:
    """Puts our answers in place while a test runs."""
    _asked.clear()
    if _is_outside(request.node):
        for thing, name, ours in _replacements():
            monkeypatch.setattr(thing, name, ours)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: Any, call: Any) -> Any:
    """A test that asked for none of our answers says nothing about them."""
    outcome = yield
    report = outcome.get_result()
    if not _is_outside(item):
        return
    report.outside = _name(item)
    if report.when == "call" and report.passed and not _asked:
        report.outcome = "skipped"
        report.longrepr = (str(item.path), 0, "not applicable: it asks for nothing that we answer")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """The table: passed, deviating with reason, not applicable, by module."""
    terminalreporter.section("python-control's tests with jurist's answers")
    counts = {module.rpartition(".")[2]: dict.fromkeys(("passed", "deviating", "not applicable", "failed"), 0) for module in MODULES}
    reasons = []
    for kind, reports in terminalreporter.stats.items():
        for report in reports:
            name = getattr(report, "outside", None)
            if name is None or kind not in _KINDS:
                continue
            deviates = kind == "xfailed" and name in DEVIATIONS
            counts[name.partition("::")[0]]["deviating" if deviates else _KINDS[kind]] += 1
            if deviates:
                reasons.append(f"{name}: {DEVIATIONS[name]}")
    columns = next(iter(counts.values()))
    terminalreporter.write_line(f"{'module':16}" + "".join(f"{words:>16}" for words in columns))
    for module, found in counts.items():
        terminalreporter.write_line(f"{module:16}" + "".join(f"{count:>16}" for count in found.values()))
    for reason in sorted(reasons):
        terminalreporter.write_line(f"  {reason}")


_KINDS = {"passed": "passed", "skipped": "not applicable", "failed": "failed", "xfailed": "not applicable", "xpassed": "passed"}
"""What pytest's outcomes are called; expected failures of python-control's own say nothing about our answers."""
