"""python-control's own tests with this package's answers in place of its own: a plugin of pytest.

    pytest --pyargs control.tests.nyquist_test -p jurist.testing.control

Where a test asks for what has no exact answer (frequency data, several inputs), it is skipped and says so. Where the answers differ,
`DEVIATIONS` says why.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import pytest

import jurist
from jurist import JuristWarning

DEVIATIONS: dict[str, str] = {}
"""Tests that our answers do not pass, and why."""


def _quietly(ask: Callable[[], Any]) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", JuristWarning)
        return ask()


def _siso(system: Any) -> None:
    if isinstance(system, tuple) or not (hasattr(system, "num") or hasattr(system, "A")):
        pytest.skip("frequency data: there is no model to be exact about")
    if (getattr(system, "ninputs", 1), getattr(system, "noutputs", 1)) != (1, 1):
        from control import ControlMIMONotImplemented

        raise ControlMIMONotImplemented("one input and one output")


def closed_loop_roots_not_inside(system: Any) -> int:
    """How many roots of the loop closed around a system are on the boundary or outside: ``_Z`` of the Nyquist tests."""
    _siso(system)
    found = _quietly(lambda: jurist.from_control(system, gain="loop_gain").verdict())
    return int(found.on + found.outside + found.infinite)


REPLACED: dict[str, dict[str, Any]] = {"nyquist_test": {"_Z": closed_loop_roots_not_inside}}
"""By test module, what stands in for functions of that name."""


def pytest_collection_modifyitems(items: list[Any]) -> None:
    """Puts our answers into the modules, and marks what is known to differ."""
    for item in items:
        for name, value in REPLACED.get(item.module.__name__.rpartition(".")[2], {}).items():
            setattr(item.module, name, value)
        for name, reason in DEVIATIONS.items():
            if item.nodeid.endswith(name):
                item.add_marker(pytest.mark.xfail(reason=reason, strict=True))


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """The table: passed, deviating with reason, not applicable."""
    kinds = {"passed": "passed", "xfailed": "deviating", "skipped": "not applicable", "failed": "failed"}
    terminalreporter.section("python-control's tests with jurist's answers")
    for kind, words in kinds.items():
        terminalreporter.write_line(f"{words}: {len(terminalreporter.stats.get(kind, []))}")
    for report in terminalreporter.stats.get("xfailed", []):
        terminalreporter.write_line(f"  {report.nodeid.rpartition('::')[2]}: {report.wasxfail}")
