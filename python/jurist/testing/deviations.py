"""Where our answers differ from what python-control's tests expect, and why.

Each reason is confirmed at 50 digits, by mpmath and without this package, in ``tests/test_outside.py``.
"""

from __future__ import annotations

DEVIATIONS: dict[str, str] = {}
"""Tests by module and name, and the reason."""
